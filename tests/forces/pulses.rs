//! Forces of time that act for a short while are not stepped over, by whatever formula they come and go.

use crate::running;

use cognate::results::Status;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use running::{Analysis, Session, go, last, session_by, try_to};

/// A unit mass that slides along z, pushed by a function of time.
fn pushed(function: &str, method: &str, error: f64, end: f64) -> Session {
    let text = format!(
        "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nMARKER/3, PART=1\nJOINT/1, TRANSLATIONAL, I=2, J=3\n\
         VARIABLE/7, FUNCTION={function}\nSFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=VARVAL(7)\n"
    );
    let mut s = session_by(&text, &["VZ(2)"], method, error);
    go(&mut s, Analysis::Dynamic, end, 5);
    s
}

#[test]
fn a_pulse_gives_its_momentum_however_long_the_run() {
    for (function, end, momentum) in [
        ("EXP(-((TIME-5)/0.01)**2)/(0.01*SQRT(PI))", 10.0, 1.0),
        (
            "EXP(-((TIME-5)/0.01)**2)/(0.01*SQRT(PI))+SIN(TIME)",
            10.0,
            2.0 - 10f64.cos(),
        ),
        ("IF(TIME-5:0,0,IF(TIME-5.001:1000,1000,0))", 10.0, 1.0),
        ("IF(MOD(TIME,1)-0.99:0,0,100)", 10.0, 10.0),
        ("IF(MOD(TIME,1)-0.99:0,0,100)", 100.0, 100.0),
        ("IF(ABS(TIME-70)-0.05:10,0,0)", 100.0, 1.0),
        (
            "STEP(TIME,5,0,5.001,1000)-STEP(TIME,5.001,0,5.002,1000)",
            10.0,
            1.0,
        ),
        ("1/COSH((TIME-3)/0.02)**2", 10.0, 0.04),
    ] {
        for (method, error) in [("AUTO", 1e-6), ("AUTO", 1e-3), ("RADAU5", 1e-6)] {
            let s = pushed(function, method, error, end);
            let off = (last(&s, "VZ(2)") - momentum).abs() / momentum;
            // the request is of the error per step; there are some hundred steps
            assert!(
                off < 100.0 * error,
                "{function} {method} {error:e}: {off:e}"
            );
        }
    }
}

#[test]
fn what_goes_on_smoothly_takes_no_more_steps_for_it() {
    for function in [
        "SIN(3*TIME)",
        "TIME**2",
        "STEP(TIME,2,0,4,1)",
        "IF(TIME-5:0,0,1)",
    ] {
        let s = pushed(function, "DOP853", 1e-6, 10.0);
        assert!(
            s.run.record.counts.steps < 40,
            "{function}: {}",
            s.run.record.counts.steps
        );
    }
}

/// The velocity after ten seconds of a mass of one under a force over time, with steps as long as the method likes.
fn velocity(force: &str, method: &str) -> f64 {
    let text = format!(
        "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=2, J=1\n\
         SPLINE/1, X=0,4,4.001,4.002,4.003,10, Y=0,0,1000,1000,0,0\n\
         SFORCE/1, I=2, J=1, TRANSLATIONAL, ACTIONONLY, FUNCTION={force}\n"
    );
    let mut s = session_by(&text, &["VZ(2,1)"], method, 1e-6);
    go(&mut s, Analysis::Dynamic, 10.0, 2);
    last(&s, "VZ(2,1)")
}

#[test]
fn pulses_over_time_are_felt_by_every_method_whatever_their_length() {
    // the part of a turn in which the sine is above 0.9999, and the area between
    let angle = 0.9999f64.acos();
    let high = angle / std::f64::consts::PI;
    let area = (angle.sin() - 0.9999 * angle) / std::f64::consts::PI;
    for (force, expected) in [
        ("IF(MOD(TIME,1)-0.001: 1000,0,0)", 10.0),
        ("IF(SIN(2*PI*TIME)-0.9999: 0,0,100)", 1000.0 * high),
        ("MAX(0,SIN(2*PI*TIME)-0.9999)*1E5", 1e6 * area),
        ("IF(ABS(TIME-5)-1E-5: 1E5,0,0)", 2.0),
        ("IF(ABS(MOD(TIME,0.5)-0.05)-1E-4: 1000,0,0)", 4.0),
        (
            "STEP(TIME,3,0,3.0001,1E4)*STEP(TIME,3.0002,1,3.0003,0)",
            2.0,
        ),
        (
            "STEP5(TIME,3,0,3.001,1E4)-STEP5(TIME,3.002,0,3.003,1E4)",
            20.0,
        ),
        ("SIGN(1,SIN(7*PI*TIME))", 0.0),
        ("MOD(TIME,1)**50", 10.0 / 51.0),
    ] {
        for method in ["DOP853", "RADAU5"] {
            let v = velocity(force, method);
            let room = if method == "DOP853" { 1e-6 } else { 1e-3 };
            assert!(
                (v - expected).abs() < room * (1.0 + expected),
                "{force} by {method}: {v}, not {expected}"
            );
        }
    }
}

#[test]
fn a_short_pulse_drawn_by_a_few_points_is_felt() {
    // straight lines between the points: half a millisecond up, one at the top, half a millisecond down
    for method in ["DOP853", "RADAU5"] {
        let v = velocity("INTERP(TIME,1,1)", method);
        assert!((v - 2.0).abs() < 1e-6, "{v}");
    }
}

#[test]
fn a_branch_that_comes_and_goes_in_every_turn_of_a_free_wheel_is_seen_in_each() {
    let part = 0.99f64.acos() / std::f64::consts::PI;
    for method in ["DOP853", "RADAU5"] {
        for wheel in [
            "PART/2, MASS=1, CM=2, IP=1,1,1, WZ=62.83185307179586\n",
            "PART/2, MASS=1, CM=2, IP=1,1,1, WZ=62.83185307179586\nJOINT/2, REVOLUTE, I=2, J=1\n",
        ] {
            let text = format!(
                "{wheel}MARKER/2, PART=2\nPART/3, MASS=1, CM=3, IP=1,1,1\nMARKER/3, PART=3\nJOINT/1, TRANSLATIONAL, I=3, J=1\n\
                 SFORCE/1, I=3, J=1, TRANSLATIONAL, ACTIONONLY, FUNCTION=IF(SIN(AZ(2,1))-0.99: 0,0,100)\n"
            );
            let mut s = session_by(&text, &["VZ(3,1)"], method, 1e-6);
            go(&mut s, Analysis::Dynamic, 10.0, 2);
            let v = last(&s, "VZ(3,1)");
            assert!((v - 1000.0 * part).abs() < 1e-3, "{method} {wheel}: {v}");
        }
    }
}

#[test]
fn a_pole_that_stops_a_run_is_named_with_its_place() {
    for (function, pole) in [
        ("2+1/(TIME-0.5)", "1/(TIME - 0.5)"),
        ("TAN(PI*TIME)", "TAN(PI*TIME)"),
        ("SIN(TIME)+(TIME-0.5)**(-2)", "(TIME - 0.5)**-2"),
    ] {
        for method in ["AUTO", "RADAU5"] {
            let text = format!(
                "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nMARKER/3, PART=1\nJOINT/1, TRANSLATIONAL, I=2, J=3\n\
                 SFORCE/3, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION={function}\n"
            );
            let mut s = session_by(&text, &["VZ(2)"], method, 1e-4);
            let status = try_to(&mut s, Analysis::Dynamic, 1.0, 5);
            assert_eq!(status, Status::Stopped, "{function} {method}");
            let reason = &s.run.record.stop_reason;
            let said = format!("SFORCE/3 FUNCTION: {pole} grows without bound");
            assert!(reason.contains(&said), "{function} {method}: {reason}");
        }
    }
}

/// A pulse: its area is one, its middle at `x0`, its width `w`; `x` is what it depends on.
fn pulse(kind: usize, x: &str, x0: f64, w: f64) -> String {
    let u = format!("(({x}-{x0:?})/{w:e})");
    match kind {
        0 => format!("EXP(-{u}**2)/({w:e}*SQRT(PI))"),
        1 => format!("2*EXP(-2*{u})/(1+EXP(-2*{u}))**2/{w:e}"),
        2 => format!("(TANH({u}+1)-TANH({u}-1))/{:e}", 4.0 * w),
        3 => format!("MAX(0,1-{u}**2)*{:e}", 0.75 / w),
        4 => format!("IF(ABS({u})-1: {:e},0,0)", 0.5 / w),
        5 => format!("IF({u}**2-1: {:e},0,0)", 0.5 / w),
        _ => format!("(STEP({u},-2,0,0,1)-STEP({u},0,0,2,1))*{:e}", 0.5 / w),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(7), cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_random_pulse_gives_its_impulse_in_time_and_on_a_way(
        kind in 0usize..7,
        digits in 2.0f64..6.0,
        middle in 0.25f64..0.75,
        of_time in any::<bool>(),
        by in prop::sample::select(vec![
            ("AUTO", 1e-6), ("AUTO", 1e-4), ("DOP853", 1e-8), ("RADAU5", 1e-6),
        ]),
        outputs in 1usize..40,
    ) {
        let (method, error) = by;
        // exponential functions of kind 1 have values within 300 widths only
        let width = if kind == 1 { 10f64.powf(-digits).max(5e-3) } else { 10f64.powf(-digits) };
        let (x, speed) = if of_time { ("TIME", 0.0) } else { ("DX(20,1)", 1.0) };
        let text = format!(
            "PART/2, MASS=1, CM=20, IP=1,1,1, VX={speed}\nMARKER/20, PART=2, REULER=90D,90D,0\nMARKER/11, PART=1, REULER=90D,90D,0\n\
             JOINT/1, TRANSLATIONAL, I=20, J=11\nSFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION={}\n",
            pulse(kind, x, middle, width)
        );
        let mut s = session_by(&text, &["VX(20,1)"], method, error);
        // what passes the middle goes on far beyond it
        go(&mut s, Analysis::Dynamic, if of_time { 1.0 } else { 2.0 }, outputs);
        let v = last(&s, "VX(20,1)");
        // work: v² = 1 + 2; momentum: v = 1; tails that the run cuts off are below 1e-5
        let expected = if of_time { 1.0 } else { 3f64.sqrt() };
        let off = (v - expected).abs();
        prop_assert!(off < 100.0 * error, "{} {x} {method} {error:e} {outputs} outputs: {off:e}", pulse(kind, x, middle, width));
    }
}

#[test]
fn a_bump_of_a_curve_over_a_way_is_felt_however_short_it_is() {
    // a sledge at 1 m/s over a bump of a few millimetres and one of micrometres
    for width in [1e-3, 1e-6] {
        let knots: Vec<String> = (0..5)
            .map(|k| format!("{:?}", 0.4 + f64::from(k) * width))
            .collect();
        for read in ["AKISPL(DX(2,1),0,1)", "INTERP(DX(2,1),1,1)"] {
            let text = format!(
                "PART/2, MASS=1, CM=2, IP=1,1,1, VX=1\nMARKER/2, PART=2\nMARKER/3, PART=2, REULER=90D,90D,0\n\
                 MARKER/4, PART=1, REULER=90D,90D,0\nJOINT/1, TRANSLATIONAL, I=3, J=4\n\
                 SPLINE/1, X=-9,-8,-7,{},8,9, Y=0,0,0,0,0,1,0,0,0,0, LINEAR_EXTRAPOLATE\n\
                 SFORCE/1, TRANSLATION, ACTIONONLY, I=3, J=4, FUNCTION=0.2/{width:e}*{read}\n",
                knots.join(",")
            );
            for method in ["AUTO", "RADAU5"] {
                let mut s = session_by(&text, &["VX(2,1)"], method, 1e-6);
                go(&mut s, Analysis::Dynamic, 1.0, 2);
                // the area of its triangle
                let work = 0.5 * (last(&s, "VX(2,1)").powi(2) - 1.0);
                assert!(
                    (work - 0.2).abs() < 1e-4,
                    "{read} {width:e} {method}: {work}"
                );
            }
        }
    }
}
