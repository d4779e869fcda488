//! Bars of error hold, and are not much wider than the errors: against the reference solutions, by every method.
//!
//! The short form of `benches/accuracy`, which prints both for all references and requests.

use crate::{requests, running};

use cognate::analysis::session::{Accuracy, Session};
use cognate::dataset::command::Script;
use cognate::model::Model;
use cognate::results::{self, csv, format::Style, res};
use requests::expressions;
use running::{Analysis, Options, begin, go, obeys, session, values};
use std::path::Path;

/// Errors of all samples of a problem, each with its bar.
fn samples(problem: &str, method: &str, error: f64) -> Vec<(f64, f64)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/references");
    let script = Script::read(folder.join(format!("{problem}.acf"))).unwrap();
    let model = Model::read(script.model_file().unwrap()).unwrap();
    let reference =
        csv::read(&std::fs::read(folder.join(format!("{problem}.csv"))).unwrap()).unwrap();
    let asked = expressions(&model);
    let options = Options {
        error: Some(error),
        columns: asked.clone(),
        method: Some(method.into()),
        accuracy: Accuracy::Bars,
        ..Options::default()
    };
    let mut s = begin(model, problem, options);
    obeys(&mut s, &script);
    let mut found = Vec::new();
    for column in &asked {
        let bars = values(&s, &format!("{column}±"));
        let exact = reference.column(column).expect(column);
        let all = values(&s, column).iter().zip(exact).zip(bars);
        found.extend(all.map(|((y, exact), bar)| ((y - exact).abs(), *bar)));
    }
    found
}

#[test]
fn errors_lie_within_their_bars_which_are_not_much_wider() {
    let problems = [
        "a01_pendulum",
        "double_pendulum",
        "dzhanibekov",
        "gear_pair",
        "rack_pinion",
        "bounce_k1e6",
    ];
    for (method, requests) in [
        ("AUTO", vec![1e-3, 1e-6, 1e-9]),
        ("DOP853", vec![1e-4, 1e-8]),
        ("RADAU5", vec![1e-4, 1e-7]),
    ] {
        let mut all = Vec::new();
        for problem in problems {
            for &request in &requests {
                all.extend(samples(problem, method, request));
            }
        }
        let held = all.iter().filter(|(error, bar)| error <= bar).count();
        let coverage = held as f64 / all.len() as f64;
        let mut widths: Vec<f64> = all.iter().map(|(e, bar)| bar / e.max(1e-300)).collect();
        widths.sort_by(f64::total_cmp);
        let width = widths[widths.len() / 2];
        println!(
            "{method}: {coverage:.4} of {} held, bars {width:.1} times the error",
            all.len()
        );
        assert!(coverage >= 0.99, "{method}: {coverage}");
        assert!(width <= 30.0, "{method}: {width}");
        assert!(
            all.iter().all(|(_, bar)| *bar > 0.0),
            "{method}: a bar of zero"
        );
    }
}

const PENDULUM: &str = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2, QP=1,0,0\nMARKER/3, PART=2\n\
     JOINT/1, REVOLUTE, I=3, J=1\nACCGRAV/JGRAV=-9.81\n";

fn judged(text: &str, columns: &[&str], analysis: Analysis, end: f64, error: f64) -> Session {
    let mut options = running::options(columns, error);
    options.accuracy = Accuracy::Bars;
    let mut s = begin(running::model(text), "test", options);
    go(&mut s, analysis, end, 50);
    s
}

#[test]
fn bars_change_no_number_of_the_run() {
    let columns = ["DX(2,1)", "VY(2,1)"];
    let mut plain = session(PENDULUM, &columns, 1e-5);
    go(&mut plain, Analysis::Dynamic, 3.0, 50);
    let s = judged(PENDULUM, &columns, Analysis::Dynamic, 3.0, 1e-5);
    for column in columns {
        assert_eq!(values(&plain, column), values(&s, column));
    }
    assert_eq!(plain.run.record.counts, s.run.record.counts);
    let written = csv::write(&s.run, false);
    assert_eq!(
        written.lines().next(),
        Some("time,\"DX(2,1)\",\"DX(2,1)±\",\"VY(2,1)\",\"VY(2,1)±\"")
    );
}

/// `.res` is for programs that know of no bars, and stays as it is without them.
#[test]
fn bars_stand_in_parquet_and_not_in_res() {
    let columns = ["DX(2,1)", "VY(2,1)"];
    let s = judged(PENDULUM, &columns, Analysis::Dynamic, 3.0, 1e-5);
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bars.parquet");
    results::write(&s.run, &file, Style::default()).unwrap();
    let read = results::read(&file).unwrap();
    for column in columns {
        let bar = format!("{column}±");
        assert_eq!(
            read.column(&bar),
            s.run.column(&bar),
            "{bar} is in the run, and is read as it was written"
        );
        assert!(
            read.column(&bar)
                .is_some_and(|b| b.iter().all(|b| *b > 0.0))
        );
    }
    let mut plain = session(PENDULUM, &columns, 1e-5);
    go(&mut plain, Analysis::Dynamic, 3.0, 50);
    assert_eq!(res::write(&s.run), res::write(&plain.run));
}

#[test]
fn bars_grow_with_time_and_with_the_request() {
    let largest = |error: f64| {
        let s = judged(PENDULUM, &["DX(2,1)"], Analysis::Dynamic, 20.0, error);
        let bars = values(&s, "DX(2,1)±");
        let most = |bars: &[f64]| bars.iter().fold(0.0_f64, |m, b| m.max(*b));
        assert!(most(&bars[40..]) > 2.0 * most(&bars[..10]), "{bars:?}");
        most(bars)
    };
    assert!(largest(1e-4) > 100.0 * largest(1e-8));
}

#[test]
fn a_chaotic_run_says_from_when_its_phase_is_lost() {
    let double = format!(
        "{PENDULUM}PART/3, MASS=1, CM=4, IP=1,1,1\nMARKER/4, PART=3, QP=2,0,0\nMARKER/5, PART=3, QP=1,0,0\nMARKER/6, PART=2, QP=1,0,0\n\
         JOINT/2, REVOLUTE, I=5, J=6\n"
    );
    let s = judged(&double, &["DX(4,1)"], Analysis::Dynamic, 200.0, 1e-3);
    let accuracy = s.run.record.accuracy.as_ref().expect("bars");
    let lost = accuracy.channels[0].lost_from.expect("a lost phase");
    assert!(lost > 5.0 && lost < 190.0, "{lost}");
}

#[test]
fn what_is_prescribed_is_known_to_rounding() {
    let driven = format!("{PENDULUM}MOTION/1, JOINT=1, ROTATION, FUNCTION=TIME\n");
    let s = judged(
        &driven,
        &["DX(2,1)", "MOTION(1,0,8,0)"],
        Analysis::Kinematic,
        3.0,
        1e-3,
    );
    for (k, (x, bar)) in values(&s, "DX(2,1)")
        .iter()
        .zip(values(&s, "DX(2,1)±"))
        .enumerate()
    {
        let t = values(&s, "time")[k];
        assert!(
            (x - t.cos()).abs() <= *bar && *bar < 1e-10,
            "{t}: {x} ± {bar}"
        );
    }
}

/// The further run goes there by other steps: the same steps would have the same rounding.
#[test]
fn bars_of_kinematics_are_those_of_rounding() {
    let all = samples("slider_crank_kin", "AUTO", 1e-3);
    let missed: Vec<_> = all.iter().filter(|(error, bar)| error > bar).collect();
    assert!(100 * missed.len() <= all.len(), "{missed:?}");
    let mut widths: Vec<f64> = all.iter().map(|(e, bar)| bar / e.max(1e-16)).collect();
    widths.sort_by(f64::total_cmp);
    assert!(widths[widths.len() / 2] <= 30.0);
}

#[test]
fn bars_of_an_equilibrium_hold_whatever_tolerance_is_asked_for() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/references");
    let text = std::fs::read_to_string(file.join("static_hanging_chain.adm")).unwrap();
    let table = csv::read(&std::fs::read(file.join("static_hanging_chain.csv")).unwrap()).unwrap();
    let columns: Vec<String> = (1..20).map(|k| format!("DY({},1)", 22 + 2 * k)).collect();
    let exact = &table.column("y").unwrap()[1..20];
    for request in [1e-2, 1e-6, 1e-10] {
        let mut model = Model::from_text(&text).unwrap();
        (model.equilibrium.error, model.equilibrium.imbalance) = (Some(request), Some(request));
        let options = Options {
            columns: columns.clone(),
            accuracy: Accuracy::Bars,
            ..Options::default()
        };
        let mut s = begin(model, "chain", options);
        go(&mut s, Analysis::Static, 0.0, 1);
        for (column, exact) in columns.iter().zip(exact) {
            let last = |name: &str| values(&s, name).last().copied().unwrap();
            let (y, bar) = (last(column), last(&format!("{column}±")));
            assert!((y - exact).abs() <= bar, "{column}: {y} ± {bar}, {exact}");
            assert!(bar < 1e-9, "{column}: {bar}");
        }
    }
}

/// Where the further run stops, another one is made at a larger request.
#[test]
fn numbers_have_bars_where_a_smaller_request_is_too_small() {
    let all = samples("a02_nfourbar_2", "RADAU5", 1e-7);
    assert!(all.iter().all(|(error, bar)| error <= bar));
}

/// A companion that stops on its way knows nothing of what follows: another one that began where the run is would take the errors so
/// far for none. Numbers that follow have no bar, and that is told.
#[test]
fn what_follows_a_companion_that_strayed_has_no_bar() {
    let mut options = running::options_by(&["AZ(3,1)"], "DOP853", 1e-6);
    // more than the long simulation takes, less than its companion does
    let mut plain = begin(running::model(PENDULUM), "plain", options.clone());
    go(&mut plain, Analysis::Dynamic, 40.0, 40);
    options.accuracy = Accuracy::Bars;
    let tried = plain.run.record.counts.steps + plain.run.record.counts.rejected_steps;
    options.max_steps = Some(tried as usize * 11 / 10);
    let mut s = begin(running::model(PENDULUM), "test", options);
    for end in [1.0, 40.0, 41.0] {
        go(&mut s, Analysis::Dynamic, end, 20);
    }
    let (time, bars) = (values(&s, "time"), values(&s, "AZ(3,1)±"));
    assert!(
        time.iter()
            .zip(bars)
            .all(|(t, bar)| *t > 1.0 || bar.is_finite())
    );
    assert!(
        time.iter()
            .zip(bars)
            .all(|(t, bar)| *t <= 40.0 || bar.is_nan()),
        "{bars:?}"
    );
    let told = |w: &results::Warning| w.sentence().contains("ends otherwise");
    assert_eq!(s.run.record.warnings.iter().filter(|w| told(w)).count(), 1);
}
