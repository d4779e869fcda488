//! Where both branches of a function lead back to where it changes, the motion stays there: friction by SIGN or IF holds what it brings to rest, and lets it
//! go when the load has grown.
#![cfg(feature = "solver")]

#[path = "common/running.rs"]
mod running;

use running::{Analysis, Session, go, last, session_by};

const METHODS: [&str; 6] = ["AUTO", "DOP853", "RADAU5", "BDF", "HHT", "NEWMARK"];

/// Masses that slide along z of ground, `speeds` at first, with forces between markers 1 (ground), 2 and 3.
fn blocks(masses: &[f64], speeds: &[f64], forces: &str, method: &str) -> Session {
    let mut text = String::new();
    for (k, (m, v)) in (2..).zip(masses.iter().zip(speeds)) {
        text += &format!(
            "PART/{k}, MASS={m}, CM={k}, IP=1,1,1, VZ={v}\nMARKER/{k}, PART={k}\nJOINT/{k}, TRANSLATIONAL, I={k}, J=1\n"
        );
    }
    session_by(
        &(text + forces),
        &["DZ(2,1)", "VZ(2,1)", "DZ(3,1)", "VZ(3,1)"][..2 * masses.len()],
        method,
        1e-7,
    )
}

/// The error per step is 1e-7, of BDF and its like one of several hundred.
const NEAR: f64 = 2e-5;

fn near(s: &Session, column: &str, expected: f64, what: &str) {
    let got = last(s, column);
    assert!(
        (got - expected).abs() < NEAR,
        "{what}: {column} = {got}, not {expected}"
    );
}

#[test]
fn dry_friction_brings_to_rest_and_holds() {
    for function in ["-SIGN(3,VZ(2,1))+1", "IF(VZ(2,1):4,1,-2)"] {
        for method in METHODS {
            let what = format!("{function} by {method}");
            let force =
                format!("SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=1, FUNCTION={function}\n");
            // 1 − 2 t until t = 0.5
            let mut s = blocks(&[1.0], &[1.0], &force, method);
            go(&mut s, Analysis::Dynamic, 20.0, 10);
            near(&s, "VZ(2,1)", 0.0, &what);
            near(&s, "DZ(2,1)", 0.25, &what);
        }
    }
}

#[test]
fn what_rests_stays_until_the_load_has_grown() {
    for method in METHODS {
        let force =
            "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=1, FUNCTION=4*TIME-SIGN(2,VZ(2,1))\n";
        let mut s = blocks(&[1.0], &[0.0], force, method);
        go(&mut s, Analysis::Dynamic, 2.0, 10);
        // from t = 0.5 on v = 2 (t − 0.5)²
        near(&s, "VZ(2,1)", 4.5, method);
        near(&s, "DZ(2,1)", 2.25, method);
    }
}

#[test]
fn friction_of_one_body_on_another_that_rubs_on_the_ground_ends_in_rest_of_both() {
    let forces = "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=1, FUNCTION=-SIGN(1,VZ(2,1))+SIGN(3,VZ(3,1)-VZ(2,1))\n\
                  SFORCE/2, TRANSLATION, ACTIONONLY, I=3, J=1, FUNCTION=-SIGN(3,VZ(3,1)-VZ(2,1))\n";
    for method in METHODS {
        // together from t = 0.5 on at speed 0.5, at rest from t = 2 on
        let mut s = blocks(&[2.0, 1.0], &[0.0, 2.0], forces, method);
        go(&mut s, Analysis::Dynamic, 5.0, 10);
        for (column, expected) in [
            ("VZ(2,1)", 0.0),
            ("VZ(3,1)", 0.0),
            ("DZ(2,1)", 0.5),
            ("DZ(3,1)", 1.0),
        ] {
            near(&s, column, expected, method);
        }
    }
}

#[test]
fn an_oscillation_loses_four_friction_lengths_a_cycle_and_ends_within_one() {
    let force =
        "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=1, FUNCTION=100*(1-DZ(2,1))-SIGN(7,VZ(2,1))\n";
    for method in METHODS {
        // about 1, from −1: turns at ±(1 − 0.14 k), stops in the seventh, at −0.02 beyond
        let mut s = blocks(&[1.0], &[0.0], force, method);
        go(&mut s, Analysis::Dynamic, 4.0, 10);
        near(&s, "VZ(2,1)", 0.0, method);
        near(&s, "DZ(2,1)", 1.02, method);
    }
}

#[test]
fn a_wheel_has_turned_as_far_as_it_did_before_it_came_to_rest_within_a_step() {
    let wheel =
        "PART/2, MASS=1, CM=2, IP=1,1,1, WZ=1000\nMARKER/2, PART=2\nJOINT/1, REVOLUTE, I=2, J=1\n";
    for (function, angle) in [
        ("-SIGN(100,WZ(2,1))", 5000.0),
        // swings about 0 with an amplitude of 1000 rad
        ("-AZ(2,1)", 1000.0 * 20f64.sin()),
    ] {
        for method in METHODS {
            let text = format!("{wheel}SFORCE/1, ROTATION, I=2, J=1, FUNCTION={function}\n");
            let mut s = session_by(&text, &["AZ(2,1)"], method, 1e-7);
            go(&mut s, Analysis::Dynamic, 20.0, 2);
            let got = last(&s, "AZ(2,1)");
            assert!(
                (got - angle).abs() < 1e-4 * 1000.0,
                "{function} by {method}: {got}, not {angle}"
            );
        }
    }
}
