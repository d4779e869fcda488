//! Many runs of one model: each row is what the run alone gives, to the bit, whatever ran before it and on whichever thread; tables are gone on with, or refused.

use crate::running::{Analysis, Options, begin, sweep, whole};

use cognate::analysis::sweep::{Row, Sweep, Table, design};
use cognate::model::Formula;
use cognate::results::Status;
use std::path::PathBuf;

/// A pendulum with a number, and a formula that reads itself.
const PENDULUM: &str = pendulum!(
    "VARIABLE/3, FUNCTION=0.2
VARIABLE/4, IC=0.5, FUNCTION=0.5*COS(VARVAL(4))+VARVAL(3)
SFORCE/3, ROTATION, I=21, J=1, FUNCTION=-VARVAL(4)*WZ(21,1)
END
"
);
const MEASURES: [&str; 3] = ["max(abs(WZ(21,1)))", "last(AZ(21,1))", "mean(FX(21,1))"];

fn pendulum() -> Sweep {
    of(PENDULUM)
}

/// The same without the formula that reads itself.
fn direct() -> String {
    PENDULUM.replace("-VARVAL(4)*", "-VARVAL(3)*")
}

fn of(text: &str) -> Sweep {
    let mut s = sweep(text, 1.0, 20);
    for name in ["PART/2.MASS", "MARKER/20.QP(1)", "ACCGRAV.JGRAV", "VAR/3"] {
        s.parameter(name).expect("a number of the model");
    }
    for measure in MEASURES {
        s.measure(measure).expect("a measure");
    }
    s
}

fn points() -> Vec<Vec<f64>> {
    let values = [
        vec![2.0, 3.0],
        vec![1.0, 1.5],
        vec![-9.81],
        vec![0.2, 0.9, -0.4],
    ];
    design::grid(&values).expect("twelve points")
}

fn bits(row: &Row) -> Vec<u64> {
    row.measures.iter().map(|x| x.to_bits()).collect()
}

#[test]
fn rows_are_the_same_on_any_number_of_threads() {
    let (sweep, points) = (pendulum(), points());
    let names: Vec<&str> = sweep.parameters().iter().map(|p| p.name()).collect();
    let expected = [
        "PART/2.MASS",
        "MARKER/20.QP(1)",
        "ACCGRAV.JGRAV",
        "VARIABLE/3",
    ];
    assert_eq!(names, expected);
    let rows = sweep.rows(&points, 1).expect("rows");
    for threads in [2, 3, 20] {
        let again = sweep.rows(&points, threads).expect("rows");
        assert!(rows == again, "{threads} threads");
    }
}

#[test]
fn a_row_is_that_of_its_dataset_alone_to_the_bit() {
    for dataset in [PENDULUM, &direct()] {
        let sweep = of(dataset);
        for row in &sweep.rows(&points(), 1).expect("rows") {
            assert_eq!((row.status, row.reason.as_str()), (Status::Completed, ""));
            let [mass, length, g, damping] = row.values[..] else {
                panic!("four parameters")
            };
            let text = dataset
                .replace("FUNCTION=0.2", &format!("FUNCTION={damping}"))
                .replace("MASS=2", &format!("MASS={mass}"))
                .replace("QP=1", &format!("QP={length}"))
                .replace("JGRAV=-9.81", &format!("JGRAV={g}"));
            let options = Options {
                columns: ["WZ(21,1)", "AZ(21,1)", "FX(21,1)"]
                    .map(String::from)
                    .to_vec(),
                ..Options::default()
            };
            let mut alone = begin(whole(&text), "alone", options);
            let done = alone.run_to(Analysis::Transient, 1.0, 20);
            assert_eq!(done, Ok(Status::Completed));
            let measures = sweep.measures().iter();
            let expected: Vec<u64> = measures.map(|m| m.of(&alone.run).to_bits()).collect();
            assert_eq!(bits(row), expected, "{:?}", row.values);
        }
    }
}

/// A crank whose load reads a number, driven or free.
fn crank(drive: &str) -> String {
    let more = "VARIABLE/3, FUNCTION=0.2
SFORCE/3, ROTATION, I=21, J=1, FUNCTION=-VARVAL(3)*WZ(21,1)
SPRINGDAMPER/4, ROTATION, I=21, J=1, CT=0.4, KT=3
";
    PENDULUM[..PENDULUM.find("VARIABLE/3").expect("a pendulum")].to_string()
        + more
        + drive
        + "END\n"
}

#[test]
fn rows_of_every_method_are_those_of_a_run_alone_to_the_bit() {
    let driven = crank("MOTION/1, JOINT=1, ROTATION, FUNCTION=TIME**2\n");
    let free = crank("");
    let methods = ["AUTO", "DOP853", "RADAU5"];
    let cases = methods.map(|method| (&free, method)).into_iter();
    for (text, method) in cases.chain([(&driven, "AUTO")]) {
        let mut s = sweep(text, 0.5, 10);
        s.options.method = Some(method.into());
        for name in ["PART/2.MASS", "VARIABLE/3"] {
            s.parameter(name).expect("a number of the model");
        }
        s.measure("last(MOTION(1,0,8,0))").unwrap_or_else(|_| {
            s.measure("last(AZ(21,1))").expect("a measure");
        });
        let points = design::grid(&[vec![2.0, 3.0], vec![0.1, 0.5, 0.3]]).expect("six points");
        for row in &s.rows(&points, 1).expect("rows") {
            let alone = s.clone().rows(std::slice::from_ref(&row.values), 1);
            let alone = alone.expect("a row");
            assert_eq!(row.reason, "", "{method}");
            assert_eq!(bits(row), bits(&alone[0]), "{method} {:?}", row.values);
            assert_eq!(row.warnings, alone[0].warnings, "{method}");
        }
    }
}

#[test]
fn nothing_is_compiled_for_rows_that_differ_by_variables() {
    for drive in ["", "MOTION/1, JOINT=1, ROTATION, FUNCTION=TIME**2\n"] {
        let options = Options {
            keep_start: true,
            ..Options::default()
        };
        let mut session = begin(whole(&crank(drive)), "again", options);
        session.will_change([3]);
        for k in 0..3 {
            session.reset();
            let variable = session.model.variables.get_mut(&3).expect("VARIABLE/3");
            variable.function = Formula::text(format!("0.{k}"));
            let done = session.run_to(Analysis::Transient, 0.5, 10);
            assert_eq!(done, Ok(Status::Completed));
            let seconds = &session.run.record.seconds;
            assert_eq!(seconds.compile == 0.0, k > 0, "{drive:?} {k}");
            assert_eq!(seconds.assemble == 0.0, k > 0, "{drive:?} {k}");
        }
    }
}

#[test]
fn rows_come_in_groups_of_what_is_compiled_once() {
    let mut s = sweep(&crank(""), 0.1, 2);
    for name in ["VARIABLE/3", "PART/2.MASS"] {
        s.parameter(name).expect("a number of the model");
    }
    s.measure("last(AZ(21,1))").expect("a measure");
    let points = design::grid(&[vec![0.1, 0.2], vec![2.0, 3.0]]).expect("four points");
    let all: Vec<usize> = (0..4).collect();
    let mut order = Vec::new();
    let each = |row: Row| {
        order.push(row.run);
        Ok(())
    };
    let nobody = cognate::analysis::sweep::Unfollowed;
    s.run(&points, &all, 1, &nobody, each).expect("rows");
    assert_eq!(order, [0, 2, 1, 3]);
}

#[test]
fn a_run_that_fails_is_a_row_with_its_reason_and_leaves_the_others_alone() {
    let mut s = sweep(PENDULUM, 1.0, 20);
    s.parameter("PART/2.MASS").unwrap();
    s.measure("last(AZ(21,1))").unwrap();
    let rows = s.rows(&[vec![2.0], vec![-1.0], vec![3.0]], 1).unwrap();
    assert_eq!(rows[1].status, Status::Model);
    assert!(rows[1].reason.contains("PART/2"), "{}", rows[1].reason);
    assert!(rows[1].measures[0].is_nan());
    let alone = s.rows(&[vec![3.0]], 1).unwrap();
    assert_eq!(bits(&rows[2]), bits(&alone[0]));
    // a limit of steps is an outcome
    s.options.max_steps = Some(3);
    let limited = s.rows(&[vec![2.0]], 1).unwrap();
    assert_eq!(limited[0].status, Status::Limit);
    assert!(!limited[0].reason.is_empty());
}

#[test]
fn names_that_mean_nothing_are_refused_with_near_ones() {
    let mut s = sweep(PENDULUM, 1.0, 20);
    for (name, code, said) in [
        ("PRT/2.MASS", "unknown_statement", "PART"),
        ("PART/2.MAS5", "unknown_argument", "MASS"),
        ("VARIABLE/33", "unknown_element", "did you mean 3"),
        ("PART/2", "unknown_argument", "cognate statements PART"),
        ("PART/2.CM", "bad_sweep", "numbers and functions"),
        ("MARKER/20.QP", "bad_sweep", "QP(1)"),
        ("MARKER/20.QP(4)", "bad_sweep", "3 numbers"),
        ("MARKER/21.QP(1)", "bad_sweep", "0 numbers"),
        ("PART.MASS", "bad_sweep", "number of its element"),
        ("", "unknown_statement", ""),
    ] {
        let error = s.parameter(name).expect_err(name);
        assert_eq!(error.code(), code, "{error}");
        assert!(error.to_string().contains(said), "{error}");
    }
    for (text, code, said) in [
        ("mux(AZ(21,1))", "bad_sweep", "max"),
        ("AZ(21,1)", "bad_sweep", "max(AZ(21,1))"),
        ("max(AZ(21,17))", "unknown_element", "MARKER/17"),
        ("max(AZZ(21,1))", "unknown_name", "AZ"),
        ("max()", "unexpected_end", ""),
    ] {
        let error = s.measure(text).expect_err(text);
        assert_eq!(error.code(), code, "{error}");
        assert!(error.to_string().contains(said), "{error}");
    }
    assert_eq!(s.measure("max(AZ(21,17))").unwrap_err().first().column, 11);
    s.parameter("VARIABLE/3").unwrap();
    assert!(s.parameter("VAR/3.FUN").is_err(), "it is set twice");
    assert!(s.rows(&[vec![0.1]], 1).is_err(), "there is no measure");
    s.measure("max(AZ(21,1))").unwrap();
    assert!(s.rows(&[vec![f64::NAN]], 1).is_err());
    assert!(s.rows(&[vec![1.0, 2.0]], 1).is_err());
    let nobody = cognate::analysis::sweep::Unfollowed;
    let beyond = s.run(&[vec![1.0]], &[0, 1], 1, &nobody, |_| Ok(()));
    assert!(
        beyond
            .unwrap_err()
            .to_string()
            .contains("no run 1 among 1 point")
    );
}

fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs what a table lacks; returns how many runs that were.
fn go_on(file: &std::path::Path, sweep: &Sweep, points: &[Vec<f64>]) -> usize {
    let mut table = Table::open(file, sweep, points).unwrap();
    let missing = table.missing();
    let each = |row| table.push(row);
    sweep
        .run(
            points,
            &missing,
            2,
            &cognate::analysis::sweep::Unfollowed,
            each,
        )
        .unwrap();
    table.complete().unwrap();
    missing.len()
}

#[test]
fn a_table_that_was_cut_off_anywhere_is_completed_to_the_same_bytes() {
    let (sweep, points) = (pendulum(), points());
    let file = folder("sweep_cut").join("table.csv");
    assert_eq!(go_on(&file, &sweep, &points), 12);
    let whole = std::fs::read(&file).unwrap();
    assert_eq!(go_on(&file, &sweep, &points), 0);
    let lines = |bytes: &[u8]| bytes.iter().filter(|&&b| b == b'\n').count();
    for cut in [0, 7, whole.len() / 3, whole.len() / 2, whole.len() - 1] {
        std::fs::write(&file, &whole[..cut]).unwrap();
        let kept = lines(&whole[..cut]).saturating_sub(2);
        assert_eq!(go_on(&file, &sweep, &points), 12 - kept, "cut at {cut}");
        assert!(std::fs::read(&file).unwrap() == whole, "cut at {cut}");
    }
    // a design with more points keeps the rows that it has in common
    let more: Vec<Vec<f64>> = [vec![2.0, 1.0, -9.81, 0.3]]
        .into_iter()
        .chain(points.clone())
        .collect();
    assert_eq!(go_on(&file, &sweep, &more), 1);
    // the words of the table are no numbers; the numbers read back
    let read = cognate::results::read(&file).unwrap();
    assert_eq!((read.rows(), read.column("reason")), (13, None));
    assert_eq!(read.column("PART/2.MASS").unwrap()[0], 2.0);
}

#[test]
fn the_table_of_another_sweep_is_refused_and_kept() {
    let (sweep, points) = (pendulum(), points());
    let file = folder("sweep_other").join("table.csv");
    go_on(&file, &sweep, &points[..2]);
    let whole = std::fs::read(&file).unwrap();
    let refused = |sweep: &Sweep, points: &[Vec<f64>]| {
        let Err(error) = Table::open(&file, sweep, points) else {
            panic!("not refused")
        };
        assert_eq!(error.code(), "other_sweep", "{error}");
        assert!(std::fs::read(&file).unwrap() == whole);
    };
    let mut other = pendulum();
    other.measure("min(AZ(21,1))").unwrap();
    refused(&other, &points);
    let mut other = pendulum();
    other.options.error = Some(1e-5);
    refused(&other, &points);
    refused(&sweep, &points[1..]);
    // a limit decides whether there is a row, not which
    let mut other = pendulum();
    other.options.limit = Some(60.0);
    assert!(Table::open(&file, &other, &points).is_ok());
}
