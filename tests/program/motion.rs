//! Motion of markers and joints relative to a marker after a run: the same numbers as requests solved for, from the
//! record alone, and refused where the record or its model does not suffice.

use super::command::{Done, cognate, path, scratch};
use cognate::results::{self, Run};
use std::path::{Path, PathBuf};

/// A double pendulum in space, its second bar on a ball, with requests of every kind of motion of its end.
const SWING: &str = "\
SWING
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
ACCGRAV/KGRAV=-9.81
PART/1, GROUND
MARKER/10, PART=1, QP=.2,0,1, REULER=30D,40D,10D
PART/2, QG=.5,0,0, MASS=2, CM=20, IP=.1,.1,.02, WX=1
MARKER/20, PART=2, QP=.1,.2,0, REULER=20D,0,0
MARKER/21, PART=2, QP=-.5,0,0, REULER=0,90D,0
MARKER/22, PART=2, QP=.5,0,0
PART/3, QG=1.4,0,0, MASS=1, CM=30, IP=.05,.05,.01, WZ=2
MARKER/30, PART=3, REULER=0,30D,70D
MARKER/31, PART=3, QP=-.4,0,0
MARKER/11, PART=1, REULER=0,90D,0
JOINT/1, REVOLUTE, I=21, J=11
JOINT/2, SPHERICAL, I=31, J=22
REQUEST/1, RESULTS_NAME=seen, F1=DX(30,20,20)\\F2=DM(30,20)\\F3=PSI(30,20)\\F4=VX(30,20,20,20)\\F5=VM(30,20,20)\\F6=WY(30,20,20)\\F7=ACCZ(30,20,20,20)\\F8=WDTX(30,20,20,20)
REQUEST/2, RESULTS_NAME=ground, F1=DX(31,10)\\F2=VX(31,10)\\F3=ACCX(31,10)\\F4=ACCM(31,10)\\F5=WDTZ(31,10)\\F6=AX(31,10)
RESULTS/XRF
END
";

fn ran(test: &str, text: &str) -> PathBuf {
    let model = scratch(test, "swing.adm", text);
    let out = model.with_file_name("out");
    let done = cognate(&[
        "run",
        path(&model),
        "--end",
        "0.5",
        "--steps",
        "20",
        "--error",
        "1e-9",
        "--out",
        path(&out),
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    out.join("swing.res")
}

fn motion(results: &Path, more: &[&str]) -> (Done, Option<Run>) {
    let out = results.with_file_name("motion.csv");
    let mut all = vec!["motion", path(results), "--out", path(&out)];
    all.extend(more);
    let done = cognate(&all);
    let run = (done.code == 0).then(|| results::read(&out).unwrap());
    (done, run)
}

fn same(a: &Run, name: &str, b: &Run, other: &str) {
    let column = |run: &Run, name: &str| {
        run.column(name)
            .unwrap_or_else(|| panic!("{name}"))
            .to_vec()
    };
    let (a, b) = (column(a, name), column(b, other));
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(&b) {
        assert!((a - b).abs() < 1e-9 * (1.0 + b.abs()), "{name}: {a} {b}");
    }
}

#[test]
fn motions_from_the_record_are_those_that_requests_solve_for() {
    let results = ran("motion_same", SWING);
    let solved = results::read(&results).unwrap();
    let relative = ["--of", "MARKER/30", "--relative-to", "MARKER/20"];
    let (done, run) = motion(&results, &relative);
    let run = run.unwrap_or_else(|| panic!("{}", done.err));
    let names = ["DX", "DM", "PSI", "VX", "VM", "WY", "ACCZ", "WDTX"];
    for (name, k) in names.into_iter().zip(1..) {
        same(
            &run,
            &format!("MARKER_30_TO_MARKER_20.{name}"),
            &solved,
            &format!("seen.F{k}"),
        );
    }
    // a joint moves with its I marker; rates and axes of ground, as REQUEST has them
    let relative = [
        "--of",
        "JOINT/2",
        "--relative-to",
        "10",
        "--in",
        "ground",
        "--seen-from",
        "ground",
    ];
    let run = motion(&results, &relative).1.unwrap();
    for (name, k) in ["DX", "VX", "ACCX", "ACCM", "WDTZ"].into_iter().zip(1..) {
        same(
            &run,
            &format!("JOINT_2_TO_MARKER_10.{name}"),
            &solved,
            &format!("ground.F{k}"),
        );
    }
}

#[test]
fn a_measure_of_markers_is_a_column_of_a_plot() {
    let results = ran("motion_plot", SWING);
    let last = |column: &str| {
        let done = cognate(&[
            "plot",
            path(&results),
            "--y",
            column,
            "--statistics",
            "--json",
        ]);
        assert_eq!(done.code, 0, "{}", done.err);
        let all: serde_json::Value = serde_json::from_str(&done.out).unwrap();
        (all[0]["last"].as_f64().unwrap(), all[0]["unit"].clone())
    };
    let (found, unit) = last("AX(31,10)");
    assert!(
        (found - last("ground.F6").0).abs() < 1e-9 && unit == "rad",
        "{unit}"
    );
    let missing = cognate(&["plot", path(&results), "--y", "VX(31,99)"]);
    assert!(
        missing.code == 3 && missing.err.contains("MARKER/99 does not exist"),
        "{}",
        missing.err
    );
}

#[test]
fn motions_that_the_record_does_not_tell_are_refused_with_a_reason() {
    let of_markers = ["--of", "MARKER/30", "--relative-to", "MARKER/20"];
    let without = ran(
        "motion_none",
        &SWING.replace("RESULTS/XRF", "RESULTS/NOACCELERATIONS"),
    );
    let some = motion(&without, &of_markers).1.unwrap();
    assert!(some.column("MARKER_30_TO_MARKER_20.WM").is_some());
    assert!(some.column("MARKER_30_TO_MARKER_20.ACCX").is_none());
    let asked = [&of_markers[..], &["--as", "acceleration"]].concat();
    let refused = motion(&without, &asked).0;
    assert_eq!(refused.code, 3);
    assert!(
        refused.err.contains("no_motion_set")
            && refused.err.contains("ACCX")
            && refused.err.contains("PART/3"),
        "{}",
        refused.err
    );
    for (more, said) in [
        (
            ["--of", "MARKER/77", "--relative-to", "20"],
            "MARKER/77 does not exist",
        ),
        (
            ["--of", "PART/3", "--relative-to", "20"],
            "neither a marker nor a joint",
        ),
        (
            ["--of", "JOINT/9", "--relative-to", "20"],
            "JOINT/9 does not exist",
        ),
    ] {
        let refused = motion(&without, &more).0;
        assert!(
            refused.code == 3 && refused.err.contains(said),
            "{more:?}: {}",
            refused.err
        );
    }
    // markers that have moved since
    let model = without.with_file_name("../swing.adm");
    let moved = SWING.replace("QP=.1,.2,0", "QP=.1,.3,0");
    std::fs::write(&model, moved).unwrap();
    let refused = motion(&without, &of_markers).0;
    assert!(
        refused.code == 3 && refused.err.contains("other_model"),
        "{}",
        refused.err
    );
    std::fs::remove_file(&model).unwrap();
    assert_eq!(motion(&without, &of_markers).0.code, 3);
}
