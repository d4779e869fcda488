//! Long runs: how energy and phase drift over thousands of periods, against the request.

use crate::laws::{elliptic_k, free_body, jacobi, pendulum, rotor};
use crate::running::{self, Analysis, Options, Session};
use cognate::analysis::watch::Unwatched;
use cognate::analysis::work_limit::ProcessorClock;
use cognate::results::Status;
use std::f64::consts::TAU;
use std::fmt::Write as _;

const METHODS: [&str; 2] = ["DOP853", "RADAU5"];
const REQUESTS: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];
/// Processor time of one run, in s.
const LIMIT: f64 = 3.0;
/// Output steps.
const OUTPUTS: usize = 100;

/// A long run with its invariant and its closed form.
struct LongRun {
    name: &'static str,
    text: String,
    end: f64,
    columns: Vec<&'static str>,
    /// what should stay: the energy, or what stands for it
    invariant: fn(&[f64]) -> f64,
    /// the first columns as functions of time
    exact: fn(f64) -> Vec<f64>,
}

/// Moments of inertia of the body that tumbles, and its angular velocity at the start.
const INERTIA: [f64; 3] = [3.0, 2.0, 1.0];
const SPIN: [f64; 3] = [1.0, 0.0, 0.2];
/// Amplitude of the pendulum, in rad.
const AMPLITUDE: f64 = 1.0;

/// The angular velocity of the body that tumbles, about its own axes: Euler's equations in Jacobi's functions, for L² > 2 T B.
fn tumbling(t: f64) -> Vec<f64> {
    let [a, b, c] = INERTIA;
    let [w1, _, w3] = SPIN;
    let energy = a * w1 * w1 + c * w3 * w3;
    let momentum = a * a * w1 * w1 + c * c * w3 * w3;
    let (m, n) = (momentum - energy * c, energy * a - momentum);
    let rate = (m * (a - b) / (a * b * c)).sqrt();
    let parameter = n * (b - c) / (m * (a - b));
    // the period of sn, so that large arguments keep their digits
    let period = 4.0 * elliptic_k(parameter);
    let [_, cn, dn] = jacobi((rate * t) % period, parameter);
    vec![w1 * dn, w3 * cn]
}

fn pendulum_place(t: f64) -> Vec<f64> {
    let k = (AMPLITUDE / 2.0).sin();
    let period = 4.0 * elliptic_k(k * k);
    let (sine, cosine) = pendulum(t % period, 1.0, AMPLITUDE).sin_cos();
    vec![sine, -cosine]
}

fn runs() -> Vec<LongRun> {
    let (sine, cosine) = AMPLITUDE.sin_cos();
    let swinging = format!(
        "ACCGRAV/JGRAV=-1\nPART/2, MASS=1, CM=20, IP=1E-9,1E-9,1E-9\n\
         MARKER/20, PART=2, QP={sine:e},{:e},0\nMARKER/22, PART=2\nJOINT/1, REVOLUTE, I=22, J=1\n",
        -cosine
    );
    vec![
        LongRun {
            name: "a pendulum of amplitude 1 rad for 1e5 s (15 000 periods)",
            text: swinging,
            end: 1e5,
            columns: vec!["DX(20,1)", "DY(20,1)", "VX(20,1)", "VY(20,1)"],
            invariant: |x| 0.5 * (x[2] * x[2] + x[3] * x[3]) + x[1] + 1.0,
            exact: pendulum_place,
        },
        LongRun {
            name: "a rotor for a million revolutions",
            text: rotor(1.0, TAU),
            end: 1e6,
            columns: vec!["DX(21,20)", "DY(21,20)", "WZ(20,1)"],
            invariant: |x| 0.5 * x[2] * x[2],
            // outputs are at whole revolutions
            exact: |t| vec![(TAU * t.fract()).cos(), (TAU * t.fract()).sin()],
        },
        LongRun {
            name: "an asymmetric body that tumbles for an hour",
            text: free_body(1.0, INERTIA, [0.0; 3], SPIN),
            end: 3600.0,
            columns: vec!["WX(20,1,20)", "WZ(20,1,20)", "WY(20,1,20)"],
            invariant: |x| 3.0 * x[0] * x[0] + x[1] * x[1] + 2.0 * x[2] * x[2],
            exact: tumbling,
        },
    ]
}

/// The table of all long runs.
pub fn table() -> String {
    let mut text = "| run | method | request | energy, relative | motion, over its swing | steps | processor time |\n|---|---|---:|---:|---:|---:|---:|\n".to_string();
    for run in runs() {
        for method in METHODS {
            for request in REQUESTS {
                let line = run.line(method, request);
                println!("{line}");
                let _ = writeln!(text, "{line}");
            }
        }
    }
    text
}

impl LongRun {
    /// Runs it once: a line of the table.
    fn line(&self, method: &str, request: f64) -> String {
        let options = Options {
            limit: Some(LIMIT),
            ..running::options_by(&self.columns, method, request)
        };
        let clock = ProcessorClock::start();
        let mut session = Session::new(running::model(&self.text), "long", options);
        let status = session.simulate(Analysis::Dynamic, self.end, OUTPUTS, &mut Unwatched);
        let seconds = clock.seconds();
        let steps = session.run.record.counts.steps;
        let [energy, motion] = self.errors(&session);
        let reached = running::values(&session, "time").last().copied();
        let how = match status {
            Ok(Status::Completed) => format!("{energy:.1e} | {motion:.1e}"),
            Ok(_) => format!(
                "{energy:.1e} | {motion:.1e} up to {:.0} s",
                reached.unwrap_or(0.0)
            ),
            Err(error) => format!("- | {}", error.first()),
        };
        format!(
            "| {} | {method} | {request:.0e} | {how} | {steps} | {seconds:.2} s |",
            self.name
        )
    }

    /// The largest error of the invariant, relative to it, and of the motion, over its largest size.
    fn errors(&self, session: &Session) -> [f64; 2] {
        let times = running::values(session, "time");
        let columns: Vec<&[f64]> = self
            .columns
            .iter()
            .map(|c| running::values(session, c))
            .collect();
        let row = |k: usize| -> Vec<f64> { columns.iter().map(|c| c[k]).collect() };
        let (mut energy, mut off, mut size) = (0.0_f64, 0.0_f64, 0.0_f64);
        let first = (self.invariant)(&row(0));
        for (k, &t) in times.iter().enumerate() {
            let here = row(k);
            energy = energy.max((((self.invariant)(&here) - first) / first).abs());
            for (x, exact) in here.iter().zip((self.exact)(t)) {
                off = off.max((x - exact).abs());
                size = size.max(exact.abs());
            }
        }
        [energy, off / size]
    }
}
