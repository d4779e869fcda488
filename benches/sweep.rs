//! What a row of a sweep costs beside the bare solution of its model.
//!
//! A number of the model is set to a new value and the model is run (a row); then the same run is made once more from the kept
//! start, for which nothing is compiled, assembled or recorded (the bare solution). Rows and bare solutions alternate; the ratio is
//! that of their medians. Beside it stand the medians of the phases of a row, as the record of the run has them, in microseconds.
//!
//! `cargo bench --bench sweep`, or `cargo bench --bench sweep -- andrews 101`: models whose names contain a word, so many rows.

use cognate::analysis::session::{Options, Session};
use cognate::analysis::sweep::Parameter;
use cognate::analysis::watch::Unwatched;
use cognate::results::{Seconds, Status};
use cognate::{Analysis, Model};
use std::time::Instant;

/// A model, its run, and numbers of it with the values that they have.
struct Case {
    name: &'static str,
    text: String,
    end: f64,
    steps: usize,
    parameters: &'static [(&'static str, f64)],
}

const PENDULUM: &str = "pendulum\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=2, CM=20, IP=0.1,0.1,0.1\n\
    MARKER/20, PART=2, QP=1,0,0\nMARKER/21, PART=2\nMARKER/23, PART=2, QP=0.5,0,0\nMARKER/3, PART=1, QP=0,1,0\n\
    JOINT/1, REVOLUTE, I=21, J=1\nSPRINGDAMPER/1, TRANSLATION, I=23, J=3, K=10, C=0.1, L=0.5\nACCGRAV/JGRAV=-9.81\n\
    VARIABLE/1, FUNCTION=0.1\nSFORCE/1, ROTATION, I=21, J=1, FUNCTION=VARVAL(1)\n\
    REQUEST/1, F2=AZ(21,1)\\F3=WZ(21,1)\nEND\n";

fn cases() -> Vec<Case> {
    vec![
        Case {
            name: "pendulum",
            text: PENDULUM.into(),
            end: 1.0,
            steps: 20,
            parameters: &[
                ("VARIABLE/1", 0.1),
                ("PART/2.MASS", 2.0),
                ("MARKER/20.QP(1)", 1.0),
                ("SPRINGDAMPER/1.K", 10.0),
            ],
        },
        Case {
            name: "slider-crank",
            text: include_str!("../examples/slider_crank.adm").into(),
            end: 0.5,
            steps: 100,
            parameters: &[
                ("PART/4.MASS", 1.0),
                ("MARKER/30.QP(1)", 75.0),
                ("ACCGRAV.JGRAV", -9806.65),
            ],
        },
        Case {
            name: "andrews",
            text: include_str!("../tests/data/references/a03_andrews.adm").into(),
            end: 0.05,
            steps: 100,
            parameters: &[
                ("PART/4.MASS", 0.02373),
                ("MARKER/30.QP(1)", 0.014),
                ("SPRINGDAMPER/1.K", 4530.0),
            ],
        },
    ]
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2] * 1e6
}

/// Runs from the start; returns its time and its phases.
fn run(session: &mut Session, case: &Case, begun: Instant) -> (f64, Seconds) {
    session.reset();
    let done = session.simulate(Analysis::Transient, case.end, case.steps, &mut Unwatched);
    let seconds = begun.elapsed().as_secs_f64();
    assert_eq!(done, Ok(Status::Completed), "{}", case.name);
    (seconds, session.run.record.seconds)
}

fn main() {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with('-'))
        .collect();
    let rows = words.iter().find_map(|w| w.parse().ok()).unwrap_or(51usize);
    let named: Vec<&String> = words
        .iter()
        .filter(|w| w.parse::<usize>().is_err())
        .collect();
    println!("{:13} {:17}  row/bare", "", "number");
    for case in cases() {
        if !named.is_empty() && !named.iter().any(|w| case.name.contains(w.as_str())) {
            continue;
        }
        for &(name, given) in case.parameters {
            measure(&case, name, given, rows);
        }
    }
}

fn measure(case: &Case, name: &str, given: f64, rows: usize) {
    let model = Model::from_text(&case.text).expect("a model of ours");
    let parameter = Parameter::new(&model, name).expect("a number of the model");
    let options = Options {
        keep_start: true,
        ..Options::default()
    };
    let mut session = Session::new(model, "sweep", options);
    if let Some(id) = name.strip_prefix("VARIABLE/") {
        session.will_change(id.parse::<u32>());
    }
    let (mut row, mut bare) = (Vec::new(), Vec::new());
    let mut phases = vec![Vec::new(); 6];
    // the first rows make what the others find
    for k in 0..rows + 3 {
        let begun = Instant::now();
        let x = given * (1.0 + 0.001 * k as f64);
        parameter
            .set(&mut session.model, x)
            .expect("a number that may stand there");
        let (seconds, s) = run(&mut session, case, begun);
        let (alone, _) = run(&mut session, case, Instant::now());
        if k >= 3 {
            row.push(seconds);
            bare.push(alone);
            let own = [
                s.compile,
                s.assemble,
                s.record,
                s.translate,
                s.solve,
                s.evaluate,
            ];
            phases.iter_mut().zip(own).for_each(|(all, x)| all.push(x));
        }
    }
    let (row, bare) = (median(&mut row), median(&mut bare));
    let ms: Vec<f64> = phases.iter_mut().map(|all| median(all)).collect();
    println!(
        "{:13} {name:17} {:9.3}  row {row:.0} bare {bare:.0}: compile {:.0} assemble {:.0} record {:.0} translate {:.0} \
         solve {:.0} evaluate {:.0}",
        case.name,
        row / bare,
        ms[0],
        ms[1],
        ms[2],
        ms[3],
        ms[4],
        ms[5]
    );
}
