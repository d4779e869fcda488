//! Models of many parts: what makes them quick changes nothing of what comes out.

use crate::running;

use cognate::analysis::verify::outline::outline;
use cognate::model::Model;
use running::{Analysis, Options, Session, begin, go, values, whole};
use std::fmt::Write;

/// A cantilever of `n` free parts in a row along x, each tied to the one before by a BEAM, under its weight and a spin about its axis.
fn cantilever(n: usize) -> Model {
    let mut text =
        "CANTILEVER\nPART/1, GROUND\nMARKER/1, PART=1\nACCGRAV/KGRAV=-9.81\n".to_string();
    for k in 0..n {
        let (part, left, right, before) = (2 + k, 100 + k, 300 + k, 299 + k);
        let before = if k == 0 { 1 } else { before };
        writeln!(
            text,
            "PART/{part}, QG={:?},0,0, MASS=1.5, CM={left}, IP=0.01,0.02,0.02, WX={:?}\n\
             MARKER/{left}, PART={part}\nMARKER/{right}, PART={part}\n\
             BEAM/{part}, I={left}, J={before}, LENGTH=0.5, IXX=2E-7, IYY=1E-7, IZZ=1E-7, AREA=1E-4, EMODULUS=2E10, GMODULUS=8E9, CRATIO=2E-4",
            0.5 * (k + 1) as f64,
            0.3 * (k + 1) as f64,
        )
        .unwrap();
    }
    whole(&format!("{text}END\n"))
}

fn run(model: &Model, method: &str, error: f64, columns: &[String]) -> Session {
    let options = Options {
        columns: columns.to_vec(),
        error: Some(error),
        method: Some(method.into()),
        ..Options::default()
    };
    let mut s = begin(model.clone(), "large", options);
    go(&mut s, Analysis::Dynamic, 0.1, 10);
    s
}

/// The implicit methods factor sparse matrices whose entries were found by groups of columns; the explicit one knows of no Jacobian.
#[test]
fn a_cantilever_of_twelve_parts_swings_alike_by_every_method() {
    let model = cantilever(12);
    let columns: Vec<String> = ["DZ(311,1)", "AX(311,1)", "VZ(305,1)", "FZ(100,1)"]
        .map(String::from)
        .to_vec();
    let explicit = run(&model, "DOP853", 1e-8, &columns);
    // second order alone: BDF is as exact as it is asked to be, RADAU5 more so
    for (method, error, bound) in [("RADAU5", 1e-7, 1e-5), ("BDF", 1e-5, 1e-2)] {
        let implicit = run(&model, method, error, &columns);
        for column in &columns {
            let (a, b) = (values(&explicit, column), values(&implicit, column));
            let size = a.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
            let off = off.fold(0.0, f64::max) / size;
            println!("{method} {column}: {off:.1e}");
            assert!(off < bound, "{method} {column}: {off:.1e}");
        }
    }
}

/// The angles of a bushing, a field or a beam pass zero with every swing; their half turn alone is a place where something changes.
#[test]
fn angles_that_pass_zero_are_no_switches() {
    assert_eq!(outline(&cantilever(3)).unwrap().switches, 0);
}
