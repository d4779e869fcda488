//! Mechanisms that nothing couples are integrated each by itself once all have begun anew at the events of each for long enough: the answers
//! are those of each alone, whatever the outputs and the threads, and nothing ends otherwise.

use crate::running;
use cognate::analysis::watch::Watch;
use cognate::numeric::Stats;
use cognate::results::{Event, Status};
use running::{Analysis, Options, Session, begin, go, last, model, try_to, values};
use std::fmt::Write as _;

/// A ball that falls on a plane, `k` of many, each from another height.
fn ball(k: usize) -> String {
    let (p, m, height) = (
        10 + k,
        1000 + 10 * k,
        0.2 + 0.3 * (0.618 * k as f64).fract(),
    );
    format!(
        "PART/{p}, MASS=1, CM={m}, IP=0.004,0.004,0.004, QG={k},0,{height}, VX=0.1, WY=3\nMARKER/{m}, PART={p}\n\
         MARKER/{g}, PART=1, QP={k},0,0\nMARKER/{f}, PART=1, FLOATING\n\
         GFORCE/{k}, I={m}, JFLOAT={f}, RM=1, FX=-2*VX({m},{g},1)\\ FY=0\\ \
         FZ=IMPACT(DZ({m},{g},1),VZ({m},{g},1),0.1,1E5,1.5,20,1E-4)\\ TX=0\\ TY=0\\ TZ=0\n",
        g = m + 1,
        f = m + 2
    )
}

/// A four-bar linkage that swings against a stop.
fn four_bar(k: usize) -> String {
    let (p, m, x) = (10 + 10 * k, 1000 + 20 * k, 2 * k);
    let mut text = String::new();
    for (n, (qx, qz, mass)) in [(0.0, 0.25, 1.0), (0.6, 0.5, 1.5), (1.2, 0.3, 1.0)]
        .into_iter()
        .enumerate()
    {
        let (p, m, qx) = (p + n, m + n, x as f64 + qx);
        let speed = if n == 0 { 1.0 + 0.1 * k as f64 } else { 0.0 };
        writeln!(
            text,
            "PART/{p}, MASS={mass}, CM={m}, IP=0.02,0.02,0.02, QG={qx},0,{qz}, WY={speed}\nMARKER/{m}, PART={p}"
        )
        .expect("text");
    }
    // pivots: ground, crank and coupler, coupler and rocker, ground
    let [a, b, c] = [p, p + 1, p + 2];
    for (n, (i, j, at)) in [
        (a, 1, [0.0, 0.0]),
        (b, a, [0.0, 0.5]),
        (c, b, [1.2, 0.6]),
        (1, c, [1.2, 0.0]),
    ]
    .into_iter()
    .enumerate()
    {
        let joint = 10 * k + n + 1;
        for (side, owner) in [i, j].into_iter().enumerate() {
            let own = match owner - p.min(owner) {
                _ if owner == 1 => [0.0, 0.0],
                0 => [x as f64, 0.25],
                1 => [x as f64 + 0.6, 0.5],
                _ => [x as f64 + 1.2, 0.3],
            };
            let (qx, qz) = (x as f64 + at[0] - own[0], at[1] - own[1]);
            let marker = m + 4 + 2 * n + side;
            writeln!(
                text,
                "MARKER/{marker}, PART={owner}, QP={qx},0,{qz}, REULER=0,90D,0"
            )
            .expect("text");
        }
        writeln!(
            text,
            "JOINT/{joint}, REVOLUTE, I={}, J={}",
            m + 4 + 2 * n,
            m + 5 + 2 * n
        )
        .expect("text");
    }
    write!(
        text,
        "MARKER/{g}, PART=1, QP={x},0,0\nSFORCE/{k}, I={cm}, J={g}, TRANSLATION, ACTIONONLY, \
         FUNCTION=BISTOP(DX({cm},{g},{g}),VX({cm},{g},{g}),0.3,0.8,1E4,1.5,10,1E-3)\n",
        g = m + 15,
        cm = m + 1
    )
    .expect("text");
    text
}

fn balls(n: usize) -> String {
    let all: String = (1..=n).map(ball).collect();
    format!("ACCGRAV/KGRAV=-9.81\n{all}")
}

/// Something that speaks of all, so that nothing is taken apart: a SENSOR that is never triggered.
const TOGETHER: &str = "SENSOR/1, FUNCTION=TIME, VALUE=1E9, GE, HALT, ERROR=1E-3\n";

fn session(text: &str, columns: &[String], threads: Option<usize>, error: f64) -> Session {
    let options = Options {
        columns: columns.to_vec(),
        error: Some(error),
        threads,
        ..Options::default()
    };
    begin(model(text), "test", options)
}

/// How many mechanisms went on by themselves.
fn apart(session: &Session) -> Option<usize> {
    let told = session.run.log.iter().find_map(|event| match event {
        Event::Info(text) => text.split_once(" mechanisms that nothing couples"),
        _ => None,
    });
    told.map(|(n, _)| n.parse().expect("a number"))
}

/// How far a column of two sessions differs, at most.
fn difference(a: &Session, b: &Session, column: &str) -> f64 {
    let both = values(a, column).iter().zip(values(b, column));
    both.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn heights(n: usize) -> Vec<String> {
    (1..=n)
        .map(|k| format!("DZ({},1)", 1000 + 10 * k))
        .collect()
}

#[test]
fn each_mechanism_has_the_answer_that_it_has_alone() {
    let n = 24;
    let columns = heights(n);
    let mut all = session(&balls(n), &columns, None, 1e-8);
    go(&mut all, Analysis::Dynamic, 1.5, 60);
    assert_eq!(apart(&all), Some(n));
    for k in [1, 7, 24] {
        let text = format!("ACCGRAV/KGRAV=-9.81\n{}", ball(k));
        let column = &columns[k - 1];
        let mut alone = session(&text, std::slice::from_ref(column), None, 1e-8);
        go(&mut alone, Analysis::Dynamic, 1.5, 60);
        assert_eq!(apart(&alone), None);
        let off = difference(&all, &alone, column);
        assert!(off < 1e-6, "ball {k} is off by {off:e}");
    }
}

#[test]
fn neither_threads_nor_outputs_change_a_bit() {
    let n = 20;
    let columns = heights(n);
    let run = |threads, outputs| {
        let mut all = session(&balls(n), &columns, threads, 1e-6);
        go(&mut all, Analysis::Dynamic, 1.0, outputs);
        assert_eq!(apart(&all), Some(n));
        all
    };
    let one = run(None, 64);
    for (threads, outputs) in [(2, 64), (5, 64), (1, 8), (3, 1024)] {
        let other = run(Some(threads), outputs);
        for column in &columns {
            let (a, b) = (values(&one, column), values(&other, column));
            for k in 0..=8 {
                let (a, b) = (a[8 * k], b[k * outputs / 8]);
                assert_eq!(
                    a.to_bits(),
                    b.to_bits(),
                    "{threads} threads, {outputs} outputs"
                );
            }
        }
    }
}

#[test]
fn closed_loops_against_stops_go_on_apart_with_the_energy_of_the_whole() {
    let n = 6;
    let text: String = (1..=n).map(four_bar).collect();
    let text = format!("ACCGRAV/KGRAV=-9.81\n{text}");
    let columns: Vec<String> = (1..=n)
        .map(|k| format!("DX({},1)", 1001 + 20 * k))
        .collect();
    let run = |text: &str| {
        let mut all = session(text, &columns, Some(2), 1e-8);
        go(&mut all, Analysis::Dynamic, 2.0, 25);
        all
    };
    let (parted, whole) = (run(&text), run(&format!("{text}{TOGETHER}")));
    assert_eq!(apart(&parted), Some(n));
    assert_eq!(apart(&whole), None);
    for column in &columns {
        let off = difference(&parted, &whole, column);
        assert!(off < 1e-5, "{column} is off by {off:e}");
    }
    let [a, b] = [&parted, &whole].map(|s| s.run.record.energy);
    let scale = a.potential[0].abs();
    for (a, b) in [
        (a.kinetic[1], b.kinetic[1]),
        (a.potential[1], b.potential[1]),
        (a.dissipated, b.dissipated),
        (a.by_functions, b.by_functions),
    ] {
        assert!((a - b).abs() < 1e-5 * scale, "{a} and {b} of {scale}");
    }
    assert!(a.error() < 1e-5, "{}", a.error());
}

#[test]
fn what_stops_one_mechanism_stops_the_whole_with_its_reason() {
    let n = 20;
    let mut text = balls(n);
    // a slider whose force has no value from 0.8 on
    text += "PART/3, MASS=1, CM=30, IP=1,1,1\nMARKER/30, PART=3, REULER=90D,90D,0\nMARKER/31, PART=1, REULER=90D,90D,0\n\
             JOINT/3, TRANSLATIONAL, I=30, J=31\nSFORCE/300, I=30, J=31, TRANSLATION, ACTIONONLY, FUNCTION=SQRT(0.8-TIME-0*DX(30,31))\n";
    let columns = heights(n);
    let run = |text: &str| {
        let mut all = session(text, &columns, Some(2), 1e-6);
        let status = try_to(&mut all, Analysis::Dynamic, 1.0, 50);
        assert_eq!(status, Status::Stopped);
        all
    };
    let (parted, whole) = (run(&text), run(&format!("{text}{TOGETHER}")));
    assert_eq!(apart(&parted), Some(n + 1));
    let [a, b] = [&parted, &whole].map(|s| s.run.record.stop_reason.clone());
    assert!(a.contains("SFORCE/300"), "{a}");
    assert_eq!(a.split(':').next_back(), b.split(':').next_back());
    assert!((last(&parted, "time") - 0.8).abs() < 1e-3);
    let found = values(&parted, &columns[3]).len();
    assert!(found.abs_diff(values(&whole, &columns[3]).len()) <= 1);
}

/// Ends a run once it has come to a time.
struct Until(f64, bool);
impl Watch for Until {
    fn interrupted(&mut self) -> bool {
        self.1
    }
    fn progress(&mut self, t: f64, _h: f64, _stats: &Stats) {
        self.1 |= t >= self.0;
    }
}

#[test]
fn an_interrupted_run_keeps_what_it_has() {
    let columns = heights(20);
    for threads in [1, 3] {
        let mut all = session(&balls(20), &columns, Some(threads), 1e-6);
        let status = all.simulate(Analysis::Dynamic, 1.0, 100, &mut Until(0.6, false));
        assert_eq!(status, Ok(Status::Interrupted));
        assert_eq!(apart(&all), Some(20));
        let reached = last(&all, "time");
        assert!((0.55..0.75).contains(&reached), "{reached}");
    }
}

#[test]
fn a_simulation_that_follows_goes_on_from_where_all_are() {
    let columns = heights(20);
    let mut once = session(&balls(20), &columns, Some(2), 1e-8);
    go(&mut once, Analysis::Dynamic, 1.0, 10);
    let mut twice = session(&balls(20), &columns, Some(2), 1e-8);
    go(&mut twice, Analysis::Dynamic, 0.7, 7);
    assert_eq!(apart(&twice), Some(20));
    go(&mut twice, Analysis::Dynamic, 1.0, 3);
    for column in &columns {
        let (a, b) = (last(&once, column), last(&twice, column));
        assert!((a - b).abs() < 1e-6, "{column}: {a} and {b}");
    }
}

#[test]
fn a_limit_of_steps_counts_those_of_all() {
    let options = Options {
        max_steps: Some(3000),
        error: Some(1e-6),
        ..Options::default()
    };
    let mut all = begin(model(&balls(30)), "test", options);
    let status = try_to(&mut all, Analysis::Dynamic, 5.0, 50);
    assert_eq!(status, Status::Limit);
    assert_eq!(apart(&all), Some(30));
    let counts = &all.run.record.counts;
    let attempted = counts.steps + counts.rejected_steps;
    assert!((1000..=3001).contains(&attempted), "{attempted}");
}

#[test]
fn friction_that_holds_is_followed_together() {
    let block = |k: usize| {
        let m = 1000 + 10 * k;
        format!(
            "PART/{p}, MASS=1, CM={m}, IP=1,1,1, VX=1\nMARKER/{m}, PART={p}, REULER=90D,90D,0\nMARKER/{g}, PART=1, REULER=90D,90D,0\n\
             JOINT/{k}, TRANSLATIONAL, I={m}, J={g}\nSFORCE/{k}, TRANSLATION, ACTIONONLY, I={m}, J={g}, \
             FUNCTION=-2*SIGN(1,VX({m},{g}))+3*SIN({w}*TIME)\n",
            p = 10 + k,
            g = m + 1,
            w = 4.0 + 0.37 * k as f64
        )
    };
    let text: String = (1..=30).map(block).collect();
    let columns: Vec<String> = (1..=30)
        .map(|k| format!("DX({},1)", 1000 + 10 * k))
        .collect();
    let run = |text: &str| {
        let mut all = session(text, &columns, Some(2), 1e-7);
        go(&mut all, Analysis::Dynamic, 4.0, 50);
        all
    };
    let (parted, whole) = (run(&text), run(&format!("{text}{TOGETHER}")));
    assert_eq!(apart(&parted), Some(30));
    for column in &columns {
        let off = difference(&parted, &whole, column);
        assert!(off < 1e-5, "{column} is off by {off:e}");
    }
}
