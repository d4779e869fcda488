//! What a mechanism costs beside the program that somebody would write by hand for it.
//!
//! The hand-written right-hand sides have minimal coordinates and are compiled with full optimization; they run under the same
//! explicit method (DOP853) over the same requests. For each true error the least time that reaches it is taken, medians of runs that
//! alternate; the ratio is what generality costs. Contacts are written by hand one branch after the other, from event to event on
//! the interpolant. Then chains: the time of one evaluation against the number of links. Then grids of bodies on bushings: the time of
//! one step of RADAU5 against the number of freedoms.
//!
//! `cargo bench --bench solve`, or `cargo bench --bench solve -- four table`: only problems whose names contain a word; `table` shows every request.

use cognate::analysis::session::script::obey;
use cognate::analysis::session::{Analysis, Options, Session};
use cognate::analysis::watch::Unwatched;
use cognate::dataset::command::Script;
use cognate::model::Model;
use cognate::numeric::{self, Dop853, Failure, Method, Ode};
use cognate::results::{Run, csv};
use cognate::scalar::{Jet, Scalar};
use requests::expressions;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[path = "../tests/common/requests.rs"]
mod requests;

/// A mechanism written by hand.
trait Hand {
    /// state at the start
    fn start(&self) -> Vec<f64>;
    /// its rate
    fn rate(&self, y: &[f64], ydot: &mut [f64]);
    /// the columns that the dataset asks for, in its order
    fn columns(&self, y: &[f64]) -> Vec<f64>;
}

/// `θ'' = −9.81 sin`: point mass on a massless rod, from the horizontal.
struct Pendulum;
impl Hand for Pendulum {
    fn start(&self) -> Vec<f64> {
        vec![0.0, 0.0]
    }
    fn rate(&self, y: &[f64], ydot: &mut [f64]) {
        // angle from −x, turning towards −y
        ydot[0] = y[1];
        ydot[1] = 9.81 * y[0].cos();
    }
    fn columns(&self, y: &[f64]) -> Vec<f64> {
        let (s, c) = y[0].sin_cos();
        vec![-c, -s, s * y[1], -c * y[1]]
    }
}

/// Two uniform rods, absolute angles from x.
struct DoublePendulum;
impl Hand for DoublePendulum {
    fn start(&self) -> Vec<f64> {
        vec![0.0; 4]
    }
    fn rate(&self, y: &[f64], ydot: &mut [f64]) {
        let (a, b, u, v) = (y[0], y[1], y[2], y[3]);
        let (s, c) = (a - b).sin_cos();
        // M = [4/3, c/2; c/2, 1/3]
        let f1 = -9.81 * 1.5 * a.cos() - 0.5 * s * v * v;
        let f2 = -9.81 * 0.5 * b.cos() + 0.5 * s * u * u;
        let (m11, m12, m22) = (4.0 / 3.0, 0.5 * c, 1.0 / 3.0);
        let d = 1.0 / (m11 * m22 - m12 * m12);
        ydot[0] = u;
        ydot[1] = v;
        ydot[2] = (m22 * f1 - m12 * f2) * d;
        ydot[3] = (m11 * f2 - m12 * f1) * d;
    }
    fn columns(&self, y: &[f64]) -> Vec<f64> {
        let (x1, y1) = (y[0].cos(), y[0].sin());
        vec![x1, y1, x1 + y[1].cos(), y1 + y[1].sin(), y[2], y[3]]
    }
}

/// Two four-bars of unit rods: all cranks turn together, the couplers only shift.
struct FourBars;
impl Hand for FourBars {
    fn start(&self) -> Vec<f64> {
        vec![std::f64::consts::FRAC_PI_2, -1.0]
    }
    fn rate(&self, y: &[f64], ydot: &mut [f64]) {
        // 3 cranks of inertia 1/3 and weight at 1/2, 2 couplers of mass 1 at 1
        ydot[0] = y[1];
        ydot[1] = -9.81 * (1.5 + 2.0) / (1.0 + 2.0) * y[0].cos();
    }
    fn columns(&self, y: &[f64]) -> Vec<f64> {
        let (s, c) = y[0].sin_cos();
        vec![c, s, -s * y[1], c * y[1]]
    }
}

type Point = [Jet<f64>; 2];

fn fixed(p: [f64; 2]) -> Point {
    p.map(Jet::constant)
}

fn length(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Andrews' squeezer: everything is a function of the crank's angle, found by intersecting circles, with its first and second
/// derivatives along the angle.
struct Squeezer {
    crank: f64,
    dyads: [Dyad; 3],
    bodies: [Body; 7],
    /// point of the spring in the frame of body 2
    spring: [f64; 2],
}

/// A joint at given distances from two others, on one side of the line through them.
struct Dyad {
    lengths: [f64; 2],
    side: f64,
}

/// A rigid body between two joints: mass, inertia, and the place of its mass centre in the frame of the line from one to the other.
struct Body {
    mass: f64,
    inertia: f64,
    centre: [f64; 2],
    length: f64,
}

const A: [f64; 2] = [-0.06934, -0.00227];
const B: [f64; 2] = [-0.03635, 0.03273];
const C: [f64; 2] = [0.014, 0.072];
const F: [f64; 2] = [0.006986674115451445, -0.0004317230645688955];
const E: [f64; 2] = [-0.020960022346354336, 0.0012951691937066884];
const G: [f64; 2] = [-0.03399720388583998, 0.01646197167499768];
const H: [f64; 2] = [-0.03163313450740889, -0.015618868668304536];
const D: [f64; 2] = [-0.010472393888814624, 0.025357788530275253];

impl Dyad {
    fn new(a: [f64; 2], b: [f64; 2], p: [f64; 2]) -> Self {
        let cross = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        Dyad {
            lengths: [length(a, p), length(b, p)],
            side: cross.signum(),
        }
    }
    fn point(&self, a: Point, b: Point) -> Point {
        let d = [b[0] - a[0], b[1] - a[1]];
        let d2 = d[0] * d[0] + d[1] * d[1];
        let [r, s] = self.lengths.map(|l| Jet::constant(l * l));
        // along the line, and across it, in parts of d
        let along = (d2 + r - s).scale(0.5) / d2;
        let across = (r / d2 - along * along).sqrt().scale(self.side);
        [
            a[0] + along * d[0] - across * d[1],
            a[1] + along * d[1] + across * d[0],
        ]
    }
}

impl Body {
    fn new(mass: f64, inertia: f64, centre: [f64; 2], a: [f64; 2], b: [f64; 2]) -> Self {
        let length = length(a, b);
        let u = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
        let c = [centre[0] - a[0], centre[1] - a[1]];
        Body {
            mass,
            inertia,
            length,
            centre: [c[0] * u[0] + c[1] * u[1], c[1] * u[0] - c[0] * u[1]],
        }
    }
    fn at(&self, a: Point, b: Point, p: [f64; 2]) -> Point {
        let u = [b[0] - a[0], b[1] - a[1]].map(|x| x.scale(1.0 / self.length));
        [
            a[0] + u[0].scale(p[0]) - u[1].scale(p[1]),
            a[1] + u[1].scale(p[0]) + u[0].scale(p[1]),
        ]
    }
    /// Adds what it contributes to the reduced inertia M(β) and to M′(β)/2.
    fn add(&self, a: Point, b: Point, sum: &mut [f64; 2]) {
        let c = self.at(a, b, self.centre);
        for x in c {
            sum[0] += self.mass * x.first * x.first;
            sum[1] += self.mass * x.first * x.second;
        }
        // θ′ = u × u′, θ″ = u × u″
        let u = [b[0] - a[0], b[1] - a[1]];
        let l2 = 1.0 / (self.length * self.length);
        let first = (u[0].value * u[1].first - u[1].value * u[0].first) * l2;
        let second = (u[0].value * u[1].second - u[1].value * u[0].second) * l2;
        sum[0] += self.inertia * first * first;
        sum[1] += self.inertia * first * second;
    }
}

impl Squeezer {
    fn new() -> Self {
        let origin = [0.0; 2];
        let body2 = Body::new(
            0.02373,
            5.255e-6,
            [-0.01874218667031546, 0.02048510678907393],
            B,
            E,
        );
        let u = [(E[0] - B[0]) / body2.length, (E[1] - B[1]) / body2.length];
        let d = [D[0] - B[0], D[1] - B[1]];
        Squeezer {
            crank: length(origin, F),
            dyads: [Dyad::new(F, B, E), Dyad::new(E, A, G), Dyad::new(E, A, H)],
            spring: [d[0] * u[0] + d[1] * u[1], d[1] * u[0] - d[0] * u[1]],
            bodies: [
                Body::new(
                    0.04325,
                    2.194e-6,
                    [0.0009182485980307613, -5.674074562905484e-5],
                    origin,
                    F,
                ),
                Body::new(
                    0.00365,
                    4.41e-7,
                    [-0.004491433359933071, 0.00027753625579429074],
                    F,
                    E,
                ),
                body2,
                Body::new(
                    0.00706,
                    5.667e-7,
                    [-0.030222939830158887, 0.01207118235666394],
                    E,
                    G,
                ),
                Body::new(
                    0.0705,
                    1.169e-5,
                    [-0.05323682815570414, 0.016631847966616306],
                    A,
                    G,
                ),
                Body::new(
                    0.00706,
                    5.667e-7,
                    [-0.0285432685367836, -0.010722254707252288],
                    E,
                    H,
                ),
                Body::new(
                    0.05498,
                    1.912e-5,
                    [-0.05626558178575735, -0.002135507029626142],
                    A,
                    H,
                ),
            ],
        }
    }
    /// F, E, G, H
    fn joints(&self, beta: f64) -> [Point; 4] {
        let angle = Jet::variable(beta);
        let f = [angle.cos().scale(self.crank), angle.sin().scale(self.crank)];
        let (a, b) = (fixed(A), fixed(B));
        let e = self.dyads[0].point(f, b);
        [f, e, self.dyads[1].point(e, a), self.dyads[2].point(e, a)]
    }
}

impl Hand for Squeezer {
    fn start(&self) -> Vec<f64> {
        vec![F[1].atan2(F[0]), 0.0]
    }
    fn rate(&self, y: &[f64], ydot: &mut [f64]) {
        let [f, e, g, h] = self.joints(y[0]);
        let (o, a, b) = (fixed([0.0; 2]), fixed(A), fixed(B));
        let ends = [(o, f), (f, e), (b, e), (e, g), (a, g), (e, h), (a, h)];
        let mut sum = [0.0; 2];
        for (body, (p, q)) in self.bodies.iter().zip(ends) {
            body.add(p, q, &mut sum);
        }
        let d = self.bodies[2].at(b, e, self.spring);
        let s = [d[0] - Jet::constant(C[0]), d[1] - Jet::constant(C[1])];
        let stretched = (s[0] * s[0] + s[1] * s[1]).sqrt();
        let force = -4530.0 * (stretched.value - 0.07785) * stretched.first + 0.033;
        ydot[0] = y[1];
        ydot[1] = (force - sum[1] * y[1] * y[1]) / sum[0];
    }
    fn columns(&self, y: &[f64]) -> Vec<f64> {
        self.joints(y[0])
            .iter()
            .flat_map(|p| p.map(|x| x.value))
            .collect()
    }
}

/// A mass on a line between stops: what holds between two events is smooth.
struct Bouncer {
    start: [f64; 2],
    gravity: f64,
    /// where each stop begins, and to which side it pushes
    stops: &'static [[f64; 2]],
    stiffness: f64,
    exponent: f64,
    damping: f64,
    /// penetration of full damping
    full: f64,
}

/// What holds of a mass between stops: the number of the stop.
#[derive(Clone, Copy, PartialEq)]
enum Phase {
    Flight,
    /// damping grows with the penetration
    Shallow(usize),
    Deep(usize),
    /// the stop would pull
    Loose(usize),
}

/// A phase of a mass between stops as the methods want it.
struct Within<'a>(&'a Bouncer, Phase);

impl Bouncer {
    const fn ball(height: f64, stiffness: f64, damping: f64, full: f64) -> Self {
        Bouncer {
            start: [height, 0.0],
            gravity: 9.81,
            stops: &[[0.05, 1.0]],
            stiffness,
            exponent: 1.5,
            damping,
            full,
        }
    }
    fn depth(&self, stop: usize, y: &[f64]) -> f64 {
        let [at, side] = self.stops[stop];
        side * (at - y[0])
    }
    /// What a stop would push with, were it to pull as well.
    fn push(&self, stop: usize, is_deep: bool, y: &[f64]) -> f64 {
        let p = self.depth(stop, y);
        let u = (p / self.full).max(0.0);
        let part = if is_deep {
            1.0
        } else {
            u * u * (3.0 - 2.0 * u)
        };
        // beyond its end a phase has to have a value, too
        self.stiffness * p.max(0.0).powf(self.exponent)
            - self.damping * part * self.stops[stop][1] * y[1]
    }
    /// Functions that are negative as long as a phase lasts, and the phases that follow.
    fn ends(&self, phase: Phase, y: &[f64], found: &mut Vec<(f64, Phase)>) {
        found.clear();
        match phase {
            Phase::Flight => {
                let touches = (0..self.stops.len()).map(|k| (self.depth(k, y), Phase::Shallow(k)));
                found.extend(touches);
            }
            Phase::Shallow(k) => {
                let p = self.depth(k, y);
                found.push((-p, Phase::Flight));
                found.push((p - self.full, Phase::Deep(k)));
                found.push((-self.push(k, false, y), Phase::Loose(k)));
            }
            Phase::Deep(k) => {
                found.push((self.full - self.depth(k, y), Phase::Shallow(k)));
                found.push((-self.push(k, true, y), Phase::Loose(k)));
            }
            Phase::Loose(k) => {
                let p = self.depth(k, y);
                let is_deep = p > self.full;
                let back = if is_deep {
                    Phase::Deep(k)
                } else {
                    Phase::Shallow(k)
                };
                found.push((-p, Phase::Flight));
                found.push((self.push(k, is_deep, y), back));
            }
        }
    }
}

impl Ode for Within<'_> {
    fn size(&self) -> usize {
        2
    }
    fn rate(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let Within(mass, phase) = *self;
        ydot[0] = y[1];
        ydot[1] = -mass.gravity;
        if let Phase::Shallow(k) | Phase::Deep(k) = phase {
            ydot[1] += mass.stops[k][1] * mass.push(k, phase == Phase::Deep(k), y);
        }
        Ok(())
    }
    fn jacobian(&mut self, _: f64, _: &[f64], _: &mut [f64], _: &mut [f64]) -> Result<(), Failure> {
        unreachable!("an explicit method asks for no Jacobian")
    }
    fn typical(&self, typical: &mut [f64]) {
        typical.fill(1.0);
    }
}

/// A hand-written mechanism as the methods want it.
struct Written<'a>(&'a dyn Hand, usize);
impl Ode for Written<'_> {
    fn size(&self) -> usize {
        self.1
    }
    fn rate(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.0.rate(y, ydot);
        Ok(())
    }
    fn jacobian(&mut self, _: f64, _: &[f64], _: &mut [f64], _: &mut [f64]) -> Result<(), Failure> {
        unreachable!("an explicit method asks for no Jacobian")
    }
    fn typical(&self, typical: &mut [f64]) {
        typical.fill(1.0);
    }
}

/// Two to a decade, so that the least time for a true error does not hang on which of two requests just reaches it.
const REQUESTS: [f64; 17] = [
    1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9, 1e-9, 3e-10, 1e-10,
    3e-11, 1e-11,
];
const TARGETS: [f64; 3] = [1e-3, 1e-6, 1e-9];
const ROUNDS: usize = 9;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/references")
}

/// A solution: the times, and the columns with the expressions for their names.
fn reference(problem: &str) -> Run {
    let bytes = std::fs::read(folder().join(format!("{problem}.csv"))).expect("a reference");
    csv::read(&bytes).expect("a table")
}

/// Largest difference of columns from those of the reference with the same names, relative to magnitudes.
fn true_error(reference: &Run, names: &[String], columns: &[Vec<f64>]) -> f64 {
    let distance = |(name, x): (&String, &Vec<f64>)| {
        let r = reference.column(name).expect("a column of this name");
        let scale = r.iter().fold(1e-300, |m: f64, v| m.max(v.abs()));
        r.iter()
            .zip(x)
            .map(|(a, b)| (a - b).abs() / scale)
            .fold(0.0, f64::max)
    };
    assert_eq!(names.len(), columns.len());
    names.iter().zip(columns).map(distance).fold(0.0, f64::max)
}

/// The dataset of a problem.
fn dataset(problem: &str) -> (Script, Model) {
    let script = Script::read(folder().join(format!("{problem}.acf"))).expect("a command file");
    let model = Model::read(script.model_file().expect("a model")).expect("a dataset");
    (script, model)
}

/// Seconds, columns and evaluations of a hand-written mechanism.
fn by_hand(hand: &dyn Hand, times: &[f64], error: f64) -> (f64, Vec<Vec<f64>>, usize) {
    let start = hand.start();
    let n = start.len();
    let begun = Instant::now();
    let options = numeric::Options {
        tolerance: error,
        ..numeric::Options::default()
    };
    let mut problem = Written(hand, n);
    let mut method = Dop853::new(n, &options);
    let mut y = start.clone();
    let mut states = vec![start.clone()];
    let end = times[times.len() - 1];
    Method::<Written>::start(&mut method, &mut problem, times[0], &start).expect("a start");
    while Method::<Written>::t(&method) < end {
        let step = method.step(&mut problem, end).expect("a step");
        while states.len() < times.len() && times[states.len()] <= step.t1 {
            method
                .interpolate(&mut problem, times[states.len()], &mut y)
                .expect("a value");
            states.push(y.clone());
        }
    }
    let seconds = begun.elapsed().as_secs_f64();
    let rows: Vec<Vec<f64>> = states.iter().map(|y| hand.columns(y)).collect();
    let columns = (0..rows[0].len())
        .map(|k| rows.iter().map(|r| r[k]).collect())
        .collect();
    let evaluations = Method::<Written>::stats(&method).evaluations;
    (seconds, columns, evaluations)
}

/// Returns a time just behind the place where a function that was negative is zero, by secants of
/// which the end that stays counts half.
fn crossing(ends: [(f64, f64); 2], end: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let [mut a, mut b] = ends;
    let mut behind = b.0;
    while behind - a.0 > 1e-15 * end {
        let t = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
        let t = t.clamp(a.0 + 5e-16 * end, behind - 5e-16 * end);
        let value = f(t);
        if value > 0.0 {
            (b, behind, a.1) = ((t, value), t, 0.5 * a.1);
        } else {
            (a, b.1) = ((t, value), 0.5 * b.1);
        }
    }
    behind
}

/// Seconds, columns and evaluations of a hand-written mass between stops.
fn between_stops(mass: &Bouncer, times: &[f64], error: f64) -> (f64, Vec<Vec<f64>>, usize) {
    let begun = Instant::now();
    let options = numeric::Options {
        tolerance: error,
        ..numeric::Options::default()
    };
    let mut method = Dop853::new(2, &options);
    let (mut phase, mut y) = (Phase::Flight, mass.start);
    let mut columns = vec![vec![y[0]], vec![y[1]]];
    let (mut ends, mut there) = (Vec::new(), Vec::new());
    let end = times[times.len() - 1];
    Method::<Within>::start(&mut method, &mut Within(mass, phase), times[0], &y).expect("a start");
    while Method::<Within>::t(&method) < end {
        let mut problem = Within(mass, phase);
        let step = method.step(&mut problem, end).expect("a step");
        // an end may come and go within a step, but hardly where nothing touches
        let samples = if phase == Phase::Flight { 1 } else { 5 };
        let (mut from, mut looked) = (step.t0, step.t0);
        ends.clear();
        for k in 1..=samples {
            if ends.iter().any(|e: &(f64, Phase)| e.0 > 0.0) {
                break;
            }
            (from, looked) = (looked, step.t0 + step.h * f64::from(k) / f64::from(samples));
            if k == samples {
                looked = step.t1;
            }
            let within = method.interpolate(&mut problem, looked, &mut y);
            within.expect("a value");
            mass.ends(phase, &y, &mut ends);
        }
        let mut first: Option<(f64, Phase)> = None;
        for (k, &(after, next)) in ends.iter().enumerate().filter(|e| e.1.0 > 0.0) {
            let mut off = |t: f64| {
                let within = method.interpolate(&mut problem, t, &mut y);
                within.expect("a value");
                mass.ends(phase, &y, &mut there);
                there[k].0
            };
            let behind = crossing([(from, off(from)), (looked, after)], end, off);
            if first.is_none_or(|f| behind < f.0) {
                first = Some((behind, next));
            }
        }
        let until = first.map_or(step.t1, |f| f.0);
        while columns[0].len() < times.len() && times[columns[0].len()] <= until {
            let t = times[columns[0].len()];
            let within = method.interpolate(&mut problem, t, &mut y);
            within.expect("a value");
            (columns.iter_mut().zip(y)).for_each(|(column, y)| column.push(y));
        }
        if let Some((t, next)) = first {
            let within = method.interpolate(&mut problem, t, &mut y);
            within.expect("a value");
            phase = next;
            let anew = method.reinitialize(&mut Within(mass, phase), t, &y);
            anew.expect("a start");
        }
    }
    let evaluations = Method::<Within>::stats(&method).evaluations;
    (begun.elapsed().as_secs_f64(), columns, evaluations)
}

/// A run of the dataset.
fn by_us(problem: &str, error: f64, method: Option<&str>) -> (Session, Vec<Vec<f64>>) {
    let (script, model) = dataset(problem);
    let columns = expressions(&model);
    let options = Options {
        error: Some(error),
        columns: columns.clone(),
        method: method.map(str::to_string),
        // the median of some runs: the program for hand-written mechanisms is warm as well
        repeat: 5,
        ..Options::default()
    };
    let mut session = Session::new(model, problem, options);
    obey(&mut session, &script.steps, |_, _| (), &mut Unwatched).expect("a run");
    let columns = columns
        .iter()
        .map(|c| session.run.column(c).expect("a column").to_vec())
        .collect();
    (session, columns)
}

fn median(mut x: Vec<f64>) -> f64 {
    x.sort_by(f64::total_cmp);
    x[x.len() / 2]
}

/// Least time for each target, from (true error, seconds) over all requests.
fn least(runs: &[(f64, f64)]) -> [Option<f64>; 3] {
    TARGETS.map(|target| {
        let reached = runs.iter().filter(|r| r.0 <= target).map(|r| r.1);
        reached.fold(None, |m: Option<f64>, s| Some(m.map_or(s, |m| m.min(s))))
    })
}

/// A program by hand.
enum Hands<'a> {
    Smooth(&'a dyn Hand),
    Between(Bouncer),
}

fn beside_hand_written(chosen: &dyn Fn(&str) -> bool, table: bool) {
    let squeezer = Squeezer::new();
    use Hands::{Between, Smooth};
    let problems: [(&str, Hands); 7] = [
        ("a01_pendulum", Smooth(&Pendulum)),
        ("double_pendulum", Smooth(&DoublePendulum)),
        ("a02_nfourbar_2", Smooth(&FourBars)),
        ("a03_andrews", Smooth(&squeezer)),
        ("bounce_k1e5", Between(Bouncer::ball(1.0, 1e5, 20.0, 1e-3))),
        ("bounce_k1e8", Between(Bouncer::ball(1.0, 1e8, 20.0, 1e-3))),
        (
            "settle_sphere",
            Between(Bouncer::ball(0.0501, 1e8, 2000.0, 1e-4)),
        ),
    ];
    println!(
        "{:18} {:>8} {:>12} {:>12} {:>7}",
        "problem", "error", "ours", "by hand", "ratio"
    );
    let mut logs = [(0.0, 0); 3];
    for (problem, hand) in problems.into_iter().filter(|p| chosen(p.0)) {
        let (reference, names) = (reference(problem), expressions(&dataset(problem).1));
        let times = reference.column("t").expect("times");
        let (mut ours, mut theirs) = (Vec::new(), Vec::new());
        for error in REQUESTS {
            let (mut a, mut b) = (Vec::new(), Vec::new());
            let (mut ea, mut eb) = (0.0, 0.0);
            let mut evaluations = (0, 0);
            for _ in 0..ROUNDS {
                let (session, columns) = by_us(problem, error, None);
                a.push(session.run.record.seconds.solve);
                ea = true_error(&reference, &names, &columns);
                let (seconds, columns, n) = match &hand {
                    Smooth(hand) => by_hand(*hand, times, error),
                    Between(mass) => between_stops(mass, times, error),
                };
                evaluations = (session.run.record.counts.evaluations, n);
                b.push(seconds);
                eb = true_error(&reference, &names, &columns);
            }
            ours.push((ea, median(a)));
            theirs.push((eb, median(b)));
            if table {
                let [(ea, a), (eb, b)] = [ours[ours.len() - 1], theirs[theirs.len() - 1]];
                let [a, b] = [a * 1e3, b * 1e3];
                let (n, m) = evaluations;
                println!(
                    "  request {error:.0e}: true error {ea:.1e} in {a:.4} ms, {n} evaluations, by hand {eb:.1e} in {b:.4} ms, {m} evaluations"
                );
            }
        }
        for (k, (a, b)) in least(&ours).into_iter().zip(least(&theirs)).enumerate() {
            let ms = |s: Option<f64>| s.map_or("-".into(), |s| format!("{:.4} ms", s * 1e3));
            let ratio = a.zip(b).map(|(a, b)| a / b);
            if let Some(ratio) = ratio {
                logs[k].0 += ratio.ln();
                logs[k].1 += 1;
            }
            let ratio = ratio.map_or("-".into(), |r| format!("{r:.2}"));
            println!(
                "{problem:18} {:>8.0e} {:>12} {:>12} {ratio:>7}",
                TARGETS[k],
                ms(a),
                ms(b)
            );
        }
    }
    for (k, (sum, count)) in logs.into_iter().enumerate() {
        let mean = (sum / f64::from(count.max(1))).exp();
        println!(
            "geometric mean at {:.0e}: {mean:.2} ({count} problems; goal 6)",
            TARGETS[k]
        );
    }
}

fn chains(chosen: &dyn Fn(&str) -> bool) {
    println!(
        "\n{:18} {:>12} {:>16}",
        "chain", "evaluations", "ns per link"
    );
    for links in [10, 40, 160] {
        let problem = format!("chain_{links}");
        if !chosen(&problem) {
            continue;
        }
        let runs = (0..3).map(|_| {
            let record = by_us(&problem, 1e-3, Some("DOP853")).0.run.record;
            (record.seconds.solve, record.counts.evaluations)
        });
        let runs: Vec<_> = runs.collect();
        let seconds = median(runs.iter().map(|r| r.0).collect());
        let each = seconds / runs[0].1 as f64 / f64::from(links) * 1e9;
        println!("{problem:18} {:>12} {each:>16.1}", runs[0].1);
    }
}

/// The dataset of `n` by `n` bodies on bushings, those at two edges on ground, under their weight; `k`: stiffness in N/m.
fn grid(n: usize, k: f64) -> String {
    let mut text = "GRID\nUNITS/SYSTEM=MKS\nACCGRAV/KGRAV=-9.80665\nPART/1, GROUND\n".to_string();
    let part = |i: usize, j: usize| 2 + i * n + j;
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let (p, x, y) = (part(i, j), 0.5 * i as f64, 0.5 * j as f64);
        text += &format!("PART/{p}, QG={x},{y},0, MASS=1, CM={p}0, IP=0.01,0.01,0.015\n");
        text += &format!("MARKER/{p}0, PART={p}\n");
        for (side, [x, y]) in [[0.25, 0.0], [-0.25, 0.0], [0.0, 0.25], [0.0, -0.25]]
            .iter()
            .enumerate()
        {
            text += &format!("MARKER/{p}{}, PART={p}, QP={x},{y},0\n", side + 1);
        }
    }
    let mut bushings = Vec::new();
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let p = part(i, j);
        if i + 1 < n {
            bushings.push((format!("{p}1"), format!("{}2", part(i + 1, j))));
        }
        if j + 1 < n {
            bushings.push((format!("{p}3"), format!("{}4", part(i, j + 1))));
        }
        for (side, is_edge, x) in [(2, i == 0, -0.25), (1, i + 1 == n, 0.5 * n as f64 - 0.25)] {
            if is_edge {
                let marker = format!("{p}{}", side + 4);
                text += &format!("MARKER/{marker}, PART=1, QP={x},{},0\n", 0.5 * j as f64);
                bushings.push((format!("{p}{side}"), marker));
            }
        }
    }
    let three = |x: f64| format!("{x},{x},{x}");
    let (kt, ct) = (three(1e-2 * k), three(1e-5 * k));
    let (k, c) = (three(k), three(1e-3 * k));
    for (b, (one, other)) in bushings.iter().enumerate() {
        text += &format!(
            "BUSHING/{}, I={one}, J={other}, K={k}, C={c}\n, KT={kt}, CT={ct}\n",
            b + 1
        );
    }
    text + "END\n"
}

/// Prints the time of a step of RADAU5 for grids of bodies, and the power of the freedoms that it grows with.
fn grids(chosen: &dyn Fn(&str) -> bool) {
    println!(
        "\n{:18} {:>8} {:>8} {:>12} {:>8}",
        "grid", "freedoms", "steps", "ms per step", "power"
    );
    for stiffness in [1e5, 1e8] {
        let mut before: Option<(f64, f64)> = None;
        for n in [5, 9, 13, 18] {
            let problem = format!("grid_{n}_{stiffness:e}");
            if !chosen(&problem) {
                continue;
            }
            let model = Model::from_text(&grid(n, stiffness)).expect("a model");
            let options = Options {
                error: Some(1e-4),
                method: Some("RADAU5".to_string()),
                ..Options::default()
            };
            let mut session = Session::new(model, "grid", options);
            session.run_to(Analysis::Dynamic, 1.0, 20).expect("a run");
            let record = &session.run.record;
            let ms = 1e3 * record.seconds.solve / record.counts.steps as f64;
            let freedoms = (6 * n * n) as f64;
            let power = before.map_or("-".into(), |(m, f)| {
                format!("{:.2}", (ms / m).ln() / (freedoms / f).ln())
            });
            println!(
                "{problem:18} {freedoms:>8} {:>8} {ms:>12.2} {power:>8}",
                record.counts.steps
            );
            before = Some((ms, freedoms));
        }
    }
}

fn main() {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with('-'))
        .collect();
    let table = words.iter().any(|w| w == "table");
    let names: Vec<&String> = words.iter().filter(|w| *w != "table").collect();
    let chosen = |name: &str| names.is_empty() || names.iter().any(|n| name.contains(n.as_str()));
    beside_hand_written(&chosen, table);
    chains(&chosen);
    grids(&chosen);
}
