//! Forces of time that act for a short while are not stepped over, by whatever formula they come and go.
#![cfg(feature = "solver")]

#[path = "common/running.rs"]
mod running;

use running::{Analysis, Session, go, last, model, options};

/// A unit mass that slides along z, pushed by a function of time.
fn pushed(function: &str, method: &str, error: f64, end: f64) -> Session {
    let text = format!(
        "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nMARKER/3, PART=1\nJOINT/1, TRANSLATIONAL, I=2, J=3\n\
         VARIABLE/7, FUNCTION={function}\nSFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=VARVAL(7)\n"
    );
    let mut options = options(&["VZ(2)"], error);
    options.method = Some(method.into());
    let mut s = Session::new(model(&text), "test", options);
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
        ("1/COSH((TIME-3)/0.01)**2", 10.0, 0.02),
    ] {
        for (method, error) in [
            ("AUTO", 1e-6),
            ("AUTO", 1e-3),
            ("RADAU5", 1e-6),
            ("BDF", 1e-5),
        ] {
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
