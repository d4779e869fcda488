//! Configurations written as datasets: the rest of a run that begins there is the rest of the run.

use super::command::{cognate, path, scratch};
use cognate::results::{self, Run};
use std::path::{Path, PathBuf};

/// Largest difference of the two motions, as a part of the range of a request: both are solved to 1e-10.
const SAME_MOTION: f64 = 1e-7;

const HEAD: &str = "\
CONFIGURATION
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
PART/1, GROUND
MARKER/1, PART=1
";

/// A double pendulum in space: a hook and a ball, turned markers, a centre of mass with axes of its own.
const PENDULUM: &str = "\
MARKER/10, PART=1, QP=0.1,0.2,0.3, REULER=20D,30D,40D
PART/2, MASS=2, CM=20, IP=0.02,0.03,0.04, QG=0.1,0.2,0.3, REULER=20D,30D,40D
MARKER/20, PART=2, QP=0.1,0,-0.4, REULER=10D,20D,30D
MARKER/21, PART=2
MARKER/22, PART=2, QP=0,0,-0.8
PART/3, MASS=1, CM=30, IP=0.01,0.01,0.02, QG=0.5,0.2,-0.4, WX=1, WZ=2
MARKER/30, PART=3, QP=0,0.1,-0.3
MARKER/31, PART=3
JOINT/1, HOOKE, I=21, J=10
JOINT/2, SPHERICAL, I=31, J=22
ACCGRAV/KGRAV=-9.81
VFORCE/1, I=30, JFLOAT=11, RM=1, FX=3*SIN(5*TIME)\\FY=TIME**2\\FZ=STEP(TIME,0.2,0,0.5,2)
MARKER/11, PART=1, FLOATING
REQUEST/1, F2=DX(30,1)\\F3=DY(30,1)\\F4=DZ(30,1)\\F6=WX(30,1)\\F7=VY(30,1)\\F8=TIME
";

/// All that holds states: equations, systems, motions given by rates, variables that read themselves.
const STATES: &str = "\
MARKER/10, PART=1, REULER=90D,90D,90D
MARKER/12, PART=1, QP=0,1,0
PART/2, MASS=2, CM=20, IP=1,1,1
MARKER/20, PART=2
MARKER/21, PART=2, REULER=90D,90D,90D
PART/3, MASS=2, CM=30, IP=1,1,1, QG=0,1,0
MARKER/30, PART=3
JOINT/1, TRANSLATIONAL, I=21, J=10
JOINT/2, REVOLUTE, I=30, J=12
MOTION/1, JOINT=2, VELOCITY, FUNCTION=2+COS(3*TIME), ICDISP=0.2
SFORCE/1, TRANSLATION, I=20, J=10, ACTIONONLY, FUNCTION=ARYVAL(6,1)+ARYVAL(3,1)+VARVAL(2)-DIF(1)
DIFF/1, IC=0.5, FUNCTION=DX(20,1)-DIF(1)+TIME
VARIABLE/1, FUNCTION=SIN(4*TIME)
VARIABLE/2, IC=1, FUNCTION=0.3*COS(VARVAL(2))+TIME
ARRAY/1, U, VARIABLES=1
ARRAY/2, X
ARRAY/3, Y
ARRAY/4, IC, SIZE=2, NUMBERS=0.1,0.2
MATRIX/1, FULL=RORDER, ROWS=2, COLUMNS=2, VALUES=0,1,-9,-0.5
MATRIX/2, FULL=RORDER, ROWS=2, COLUMNS=1, VALUES=0,1
MATRIX/3, FULL=RORDER, ROWS=1, COLUMNS=2, VALUES=1,0
LSE/1, X=2, U=1, Y=3, IC=4, A=1, B=2, C=3
ARRAY/5, X
ARRAY/6, Y
TFSISO/1, X=5, U=1, Y=6, NUMERATOR=1,2,0.5, DENOMINATOR=4,0.6,1
REQUEST/1, F2=DX(20,1)\\F3=VX(20,1)\\F4=DIF(1)\\F6=ARYVAL(3,1)\\F7=ARYVAL(6,1)\\F8=VARVAL(2)
REQUEST/2, F2=AZ(30,1)\\F3=WZ(30,1)\\F4=ARYVAL(2,2)\\F6=ARYVAL(5,2)
";

fn ran(model: &Path, end: &str, steps: &str) -> Run {
    let out = model.with_extension("out");
    let _ = std::fs::remove_dir_all(&out);
    let args = [
        "run",
        path(model),
        "--end",
        end,
        "--steps",
        steps,
        "--error",
        "1e-10",
        "--out",
        path(&out),
    ];
    let done = cognate(&args);
    assert_eq!(done.code, 0, "{}", done.err);
    let name = model.with_extension("csv");
    results::read(&out.join(name.file_name().unwrap())).unwrap()
}

/// Writes the configuration of a model at a time; returns the dataset and all that was said.
fn configured(model: &Path, at: &str) -> (PathBuf, String) {
    let later = model.with_file_name("later.adm");
    let done = cognate(&[
        "configuration",
        path(model),
        "--at",
        at,
        "--error",
        "1e-11",
        "-o",
        path(&later),
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    (later, done.err)
}

/// Asserts that the last rows of a run are the rows of another.
fn assert_same_rest(whole: &Run, rest: &Run) {
    let skipped = whole.rows() - rest.rows();
    for (c, column) in whole.columns.iter().enumerate().skip(1) {
        let other = &rest.columns[c];
        assert_eq!(column.name, other.name);
        let size = column
            .values
            .iter()
            .fold(0.0_f64, |m, x| m.max(x.abs()))
            .max(1e-3);
        for (k, (a, b)) in column.values[skipped..]
            .iter()
            .zip(&other.values)
            .enumerate()
        {
            assert!(
                (a - b).abs() < SAME_MOTION * size,
                "{} in row {k}: {a} {b}",
                column.name
            );
        }
    }
}

#[test]
fn the_rest_of_a_run_from_a_configuration_is_the_rest_of_the_run() {
    for (name, model) in [("pendulum", PENDULUM), ("states", STATES)] {
        let model = scratch(
            &format!("configuration_{name}"),
            "whole.adm",
            &format!("{HEAD}{model}END\n"),
        );
        let whole = ran(&model, "1", "50");
        let (later, _) = configured(&model, "0.3");
        assert_same_rest(&whole, &ran(&later, "0.7", "35"));
    }
}

#[test]
fn a_transfer_function_is_written_as_the_system_that_it_is_and_told() {
    let model = scratch(
        "configuration_told",
        "whole.adm",
        &format!("{HEAD}{STATES}END\n"),
    );
    let (later, said) = configured(&model, "0.3");
    assert!(said.contains("TFSISO/1 is written as LSE/2"), "{said}");
    let text = std::fs::read_to_string(later).unwrap();
    assert!(
        text.contains("(TIME+0.3)") && !text.contains("TFSISO"),
        "{text}"
    );
}

#[test]
fn a_driven_crank_goes_on_after_more_than_a_turn_and_turns_are_told() {
    let crank = "\
MARKER/10, PART=1
PART/2, MASS=1, CM=20, IP=1,1,1, QG=0,0,0
MARKER/20, PART=2, QP=0.5,0,0
MARKER/21, PART=2
JOINT/1, REVOLUTE, I=21, J=10
MOTION/1, JOINT=1, FUNCTION=720D*TIME
REQUEST/1, F2=DX(20,1)\\F3=DY(20,1)\\F4=TZ(10,21)\\F6=SIN(AZ(20,1))
";
    let model = scratch(
        "configuration_turns",
        "whole.adm",
        &format!("{HEAD}{crank}END\n"),
    );
    let whole = ran(&model, "2", "40");
    let (later, said) = configured(&model, "1.2");
    assert_same_rest(&whole, &ran(&later, "0.8", "16"));
    assert!(
        said.contains("AZ(20,1,0,0) begins within half a turn of zero: 2 turns"),
        "{said}"
    );
}

#[test]
fn a_configuration_after_statics_moves_with_the_velocities_of_the_dataset() {
    let spring = "\
MARKER/10, PART=1, REULER=90D,90D,90D
PART/2, MASS=1, CM=20, IP=1,1,1, VX=0.5, QG=0.3,0,0
MARKER/20, PART=2
MARKER/21, PART=2, REULER=90D,90D,90D
JOINT/1, TRANSLATIONAL, I=21, J=10, IC=0.3
SFORCE/1, TRANSLATION, I=20, J=10, ACTIONONLY, FUNCTION=4*(1-DX(20,1))
REQUEST/1, F2=DX(20,1)\\F3=VX(20,1)
";
    let model = scratch(
        "configuration_statics",
        "whole.adm",
        &format!("{HEAD}{spring}END\n"),
    );
    let acf = model.with_extension("acf");
    let script = "FILE/MODEL=whole\nSIMULATE/STATIC\nSIMULATE/DYNAMIC, END=1, STEPS=10\n";
    std::fs::write(&acf, script).unwrap();
    let (later, said) = configured(&acf, "0");
    assert!(
        said.contains("JOINT/1: its initial conditions are left out"),
        "{said}"
    );
    // about its rest at 1 with angular velocity 2: x = 1 + 0.5/2 sin 2t
    let rest = ran(&later, "1", "10");
    let x = rest.columns[1].values.last().unwrap();
    assert!((x - (1.0 + 0.25 * 2.0_f64.sin())).abs() < 1e-7, "{x}");
}

#[test]
fn the_creep_of_friction_which_a_dataset_has_no_words_for_is_told() {
    let block = "\
MARKER/10, PART=1, REULER=90D,90D,90D
PART/2, MASS=1, CM=20, IP=1,1,1, VX=1
MARKER/20, PART=2
MARKER/21, PART=2, REULER=90D,90D,90D
JOINT/1, TRANSLATIONAL, I=21, J=10
FRICTION/1, JOINT=1, MU_STATIC=0.3, MU_DYNAMIC=0.2
DIFF/1, IC=5, FUNCTION=0
ACCGRAV/KGRAV=-9.81
REQUEST/1, F2=DX(20,1)
";
    let model = scratch(
        "configuration_creep",
        "whole.adm",
        &format!("{HEAD}{block}END\n"),
    );
    let (later, said) = configured(&model, "0.7");
    let text = std::fs::read_to_string(later).unwrap();
    assert!(text.contains(", IC = 5\n"), "{text}");
    assert!(said.contains("FRICTION/1: its states begin anew"), "{said}");
}

#[test]
fn commands_that_are_left_go_on_with_the_dataset() {
    let model = scratch(
        "configuration_commands",
        "whole.adm",
        &format!("{HEAD}{PENDULUM}END\n"),
    );
    let script = "FILE/MODEL=whole\nSIMULATE/DYNAMIC, END=0.2, STEPS=10\nDEACTIVATE/VFORCE, ID=1\nSIMULATE/DYNAMIC, END=0.6, STEPS=20\nSIMULATE/DYNAMIC, DURATION=0.2, STEPS=10\n";
    let acf = model.with_extension("acf");
    std::fs::write(&acf, script).unwrap();
    let (adm, later) = (
        model.with_file_name("later.adm"),
        model.with_file_name("later.acf"),
    );
    let args = [
        "configuration",
        path(&acf),
        "--at",
        "0.4",
        "--error",
        "1e-11",
        "-o",
        path(&adm),
    ];
    let done = cognate(&args);
    assert!(
        done.code == 0 && done.err.contains("VFORCE/1"),
        "{}",
        done.err
    );
    let done = cognate(&[&args[..], &["--commands", path(&later)]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let commands = std::fs::read_to_string(&later).unwrap();
    assert!(commands.contains("DEACTIVATE/VFORCE, ID=1"), "{commands}");
    let run = |acf: &Path, name: &str| {
        let out = model.with_file_name(name);
        let done = cognate(&["run", path(acf), "--error", "1e-10", "--out", path(&out)]);
        assert_eq!(done.code, 0, "{}", done.err);
        let csv = acf.with_extension("csv");
        results::read(&out.join(csv.file_name().unwrap())).unwrap()
    };
    let (whole, rest) = (run(&acf, "whole_out"), run(&later, "rest_out"));
    let last = |run: &Run| {
        run.columns
            .iter()
            .map(|c| *c.values.last().unwrap())
            .collect::<Vec<f64>>()
    };
    let (a, b) = (last(&whole), last(&rest));
    assert!((a[0] - 0.8).abs() < 1e-12 && (b[0] - 0.4).abs() < 1e-12);
    for k in 1..6 {
        assert!(
            (a[k] - b[k]).abs() < 1e-6 * (1.0 + a[k].abs()),
            "{k}: {} {}",
            a[k],
            b[k]
        );
    }
}

#[test]
fn a_configuration_of_a_recorded_run_is_that_of_its_model() {
    let model = scratch(
        "configuration_of_run",
        "whole.adm",
        &format!("{HEAD}{PENDULUM}END\n"),
    );
    let whole = ran(&model, "1", "50");
    let later = model.with_file_name("later.adm");
    let results = model.with_extension("out").join("whole.csv");
    let done = cognate(&[
        "configuration",
        path(&results),
        "--at",
        "0.3",
        "-o",
        path(&later),
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert_same_rest(&whole, &ran(&later, "0.7", "35"));
}

#[test]
fn a_time_after_the_end_of_a_run_is_refused() {
    let model = scratch(
        "configuration_after",
        "whole.adm",
        &format!("{HEAD}{PENDULUM}END\n"),
    );
    let acf = model.with_extension("acf");
    std::fs::write(
        &acf,
        "FILE/MODEL=whole\nSIMULATE/DYNAMIC, END=0.2, STEPS=10\n",
    )
    .unwrap();
    let later = model.with_file_name("later.adm");
    let _ = std::fs::remove_file(&later);
    let done = cognate(&[
        "configuration",
        path(&acf),
        "--at",
        "0.4",
        "-o",
        path(&later),
    ]);
    assert!(
        done.code == 2 && done.err.contains("ends at 0.2") && !later.exists(),
        "{}",
        done.err
    );
    let done = cognate(&[
        "configuration",
        path(&model),
        "--at",
        "0.1",
        "-o",
        path(&model),
    ]);
    assert!(
        done.code == 2 && done.err.contains("never overwritten"),
        "{}",
        done.err
    );
}
