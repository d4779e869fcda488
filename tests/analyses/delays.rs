//! Values of the past (DELAY) where nothing moves but time.

use crate::running::{self, Analysis, Session};

const COLUMNS: [&str; 5] = [
    "VARVAL(1)",
    "VARVAL(2)",
    "VARVAL(3)",
    "VARVAL(4)",
    "VARVAL(5)",
];
const IDLE: &str = "DIFF/9, IC=0, FUNCTION=0\n";

fn ran(text: &str, analysis: Analysis, end: f64, steps: usize) -> Session {
    let mut s = running::session(text, &COLUMNS, 1e-9);
    s.register("VARIABLE/4", &["VARVAL(2)"], |call, out| {
        out[0] = call.values[0].powi(2);
    });
    running::go(&mut s, analysis, end, steps);
    s
}

/// An arm that is driven, with a force that reads what its pin carried before.
fn driven_arm() -> String {
    "PART/2, MASS=1, CM=20, IP=0.1,0.1,0.1\nMARKER/20, PART=2, QP=1,0,0\nMARKER/21, PART=2\n\
     JOINT/1, REVOLUTE, I=21, J=1\nMOTION/1, JOINT=1, ROTATION, FUNCTION=STEP(TIME,0,0,1,-PI/2)\n\
     ACCGRAV/JGRAV=-9.81\nSFORCE/1, I=20, J=1, TRANSLATIONAL, FUNCTION=0.1*VARVAL(1)\n\
     VARIABLE/1, FUNCTION=DELAY(FY(21,1),0.1,0)\nVARIABLE/2, FUNCTION=DELAY(VARVAL(1),0.07,1)\n\
     VARIABLE/3, FUNCTION=DELAY(DELAY(FX(21,1),0.11,0),0.05,2)\nVARIABLE/4, FUNCTION=USER(1)\n\
     VARIABLE/5, FUNCTION=DELAY(VARVAL(4),0.03+0.01*TIME,3)\n"
        .into()
}

const ANALYSES: [Analysis; 3] = [Analysis::Kinematic, Analysis::Dynamic, Analysis::Transient];

/// `DELAY(DELAY(…))` of a sine is the sine of before, by whatever way it is asked for.
#[test]
fn chains_of_delays_add_up_without_freedom() {
    let text = "VARIABLE/1, FUNCTION=DELAY(SIN(30*TIME),0.4,SIN(30*TIME))\n\
                VARIABLE/2, FUNCTION=DELAY(VARVAL(1),0.3,SIN(30*(TIME-0.4)))\n\
                VARIABLE/3, FUNCTION=DELAY(DELAY(VARVAL(2),0.2,SIN(30*(TIME-0.7))),0.1,SIN(30*(TIME-0.9)))\n\
                VARIABLE/4, FUNCTION=USER(1)\n\
                VARIABLE/5, FUNCTION=DELAY(VARVAL(4),1,SIN(30*(TIME-0.7))**2)\n";
    for analysis in ANALYSES {
        for steps in [1, 10, 100] {
            let s = ran(text, analysis, 3.0, steps);
            let sine = |late: f64| move |t: f64| (30.0 * (t - late)).sin();
            for (column, late) in [("VARVAL(1)", 0.4), ("VARVAL(2)", 0.7), ("VARVAL(3)", 1.0)] {
                let off = running::off(&s, column, sine(late));
                assert!(off < 1e-7, "{column} at {steps} outputs: {off}");
            }
            let off = running::off(&s, "VARVAL(5)", |t| sine(1.7)(t).powi(2));
            assert!(off < 1e-7, "VARVAL(5) at {steps} outputs: {off}");
        }
    }
}

#[test]
fn a_past_is_the_same_with_and_without_an_idle_state() {
    let alone = driven_arm();
    let beside = format!("{alone}{IDLE}");
    let finest = ran(&beside, Analysis::Dynamic, 1.2, 100);
    for analysis in ANALYSES {
        for steps in [1, 10, 100] {
            for text in [&alone, &beside] {
                let s = ran(text, analysis, 1.2, steps);
                let every = 100 / steps;
                for column in COLUMNS {
                    let expected = running::values(&finest, column).iter().step_by(every);
                    for (k, (a, b)) in running::values(&s, column).iter().zip(expected).enumerate()
                    {
                        assert!(
                            (a - b).abs() < 1e-6 * (1.0 + b.abs()),
                            "{column} at {k} of {steps}: {a} {b}"
                        );
                    }
                }
            }
        }
    }
}

/// A discrete state is remembered as it was during a step, not as the sample at its end made it.
#[test]
fn a_discrete_state_is_remembered_as_it_was() {
    let text = "VARIABLE/1, FUNCTION=0\nARRAY/1, U, VARIABLES=1\nARRAY/2, X\n\
                GSE/1, NO=0, U=1, ND=1, XD=2, SAMPLE_PERIOD=0.25, FUNCTION=USER(1)\n\
                VARIABLE/2, FUNCTION=ARYVAL(2,1)\nVARIABLE/3, FUNCTION=DELAY(VARVAL(2),0.3,0)\n";
    for text in [text.to_string(), format!("{text}{IDLE}")] {
        let mut s = running::session(&text, &["VARVAL(2)", "VARVAL(3)"], 1e-9);
        s.register("GSE/1", &[], |call, out| out[0] = call.values[1] + 1.0);
        running::go(&mut s, Analysis::Dynamic, 2.0, 37);
        // between the samples at 0.3, 0.55, 0.8 … of the state of before
        let off = running::off(&s, "VARVAL(3)", |t| ((t - 0.3) / 0.25).floor().max(0.0));
        assert!(off < 1e-9, "{off}");
    }
}
