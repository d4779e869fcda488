//! System elements: linear systems, transfer functions and differential equations agree with each other and with closed forms; sensors
//! act where and when they should; values of the past; closures of the user's.

use crate::running;

use cognate::analysis::session::state::Saved;
use cognate::dataset::command::Script;
use cognate::results::{self, Status};
use running::{
    Analysis, GROUND, Options, Session, begin, last, mistakes, obeys, options_by, rest, session_by,
    try_to, values, whole,
};

/// A unit mass that may move along x; MARKER/2 on it, MARKER/3 on ground.
const BODY: &str = "PART/2, MASS=1, CM=2\nMARKER/2, PART=2, REULER=90D,90D,0\nMARKER/3, PART=1, REULER=90D,90D,0\n\
                    JOINT/1, TRANSLATIONAL, I=2, J=3\n";

fn session(text: &str, columns: &[&str], method: &str) -> Session {
    session_by(&format!("{BODY}{text}"), columns, method, 1e-10)
}

fn go(s: &mut Session, end: f64, steps: usize) {
    running::go(s, Analysis::Dynamic, end, steps);
}

/// The refusal of a model.
fn refused(text: &str) -> String {
    let mut s = session(text, &[], "AUTO");
    let errors = mistakes(&mut s, Analysis::Dynamic);
    errors.iter().map(|e| format!("{e}\n")).collect()
}

/// y/u = (2 + 3 s)/(5 + 0.6 s + s²) in three ways: TFSISO/1 → ARRAY/13, LSE/1 → ARRAY/23, DIFF/1, 2 → VARIABLE/9.
fn three_ways(input: &str) -> String {
    format!(
        "VARIABLE/1, FUNCTION={input}\nARRAY/10, U, VARIABLES=1\n\
         ARRAY/11, X\nARRAY/13, Y\n\
         TFSISO/1, X=11, U=10, Y=13, NUMERATOR=2,3, DENOMINATOR=5,0.6,1\n\
         ARRAY/21, X, SIZE=2\nARRAY/23, Y, SIZE=1\nARRAY/24, IC, NUMBERS=0,0\n\
         MATRIX/1, FULL=RORDER, ROWS=2, COLUMNS=2, VALUES=0,1,-5,-0.6\n\
         MATRIX/2, FULL=RORDER, ROWS=2, COLUMNS=1, VALUES=0,1\n\
         MATRIX/3, FULL=RORDER, ROWS=1, COLUMNS=2, VALUES=2,3\n\
         LSE/1, X=21, U=10, Y=23, IC=24, A=1, B=2, C=3\n\
         DIFF/1, IC=0, FUNCTION=DIF(2)\nDIFF/2, IC=0, FUNCTION=VARVAL(1)-5*DIF(1)-0.6*DIF(2)\n\
         VARIABLE/9, FUNCTION=2*DIF(1)+3*DIF(2)\n"
    )
}

const WAYS: [&str; 3] = ["ARYVAL(13,1)", "ARYVAL(23,1)", "VARVAL(9)"];

#[test]
fn transfer_functions_linear_systems_and_differential_equations_agree() {
    // step response: y = 2/5 (1 − e^(−0.3 t)(cos ω t + 0.3/ω sin ω t)) + 3/ω e^(−0.3 t) sin ω t,  ω² = 5 − 0.09
    let omega = (5.0_f64 - 0.09).sqrt();
    for method in ["DOP853", "RADAU5"] {
        let mut s = session(&three_ways("1"), &WAYS, method);
        go(&mut s, 4.0, 16);
        for (row, &t) in values(&s, "time").iter().enumerate() {
            let decay = (-0.3 * t).exp();
            let (sin, cos) = (omega * t).sin_cos();
            let exact = 0.4 * (1.0 - decay * (cos + 0.3 / omega * sin)) + 3.0 / omega * decay * sin;
            for way in WAYS {
                let y = values(&s, way)[row];
                assert!(
                    (y - exact).abs() < 1e-8,
                    "{method} {way} at {t}: {y}, {exact}"
                );
            }
        }
    }
}

#[test]
fn systems_start_from_rest_where_statics_has_put_them() {
    let mut s = session(
        &format!(
            "{}SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=-DZ(2,3,3)+ARYVAL(13,1)-VZ(2,3,3)\n",
            three_ways("3")
        ),
        &[
            "ARYVAL(13,1)",
            "ARYVAL(23,1)",
            "VARVAL(9)",
            "ARYVAL(11,1)",
            "DZ(2,3,3)",
        ],
        "AUTO",
    );
    rest(&mut s);
    for way in WAYS {
        assert!((last(&s, way) - 1.2).abs() < 1e-12, "{way}");
    }
    assert!((last(&s, "ARYVAL(11,1)") - 0.6).abs() < 1e-12);
    assert!((last(&s, "DZ(2,3,3)") - 1.2).abs() < 1e-12);
    go(&mut s, 2.0, 4);
    for way in WAYS {
        assert!(
            values(&s, way)[1..].iter().all(|y| (y - 1.2).abs() < 1e-9),
            "{way}"
        );
    }
}

#[test]
fn a_held_system_keeps_its_states_in_statics() {
    let text = three_ways("3")
        .replace("C=3", "C=3, STATIC_HOLD")
        .replace("NUMBERS=0,0", "NUMBERS=0.25,0.5");
    let force = "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=-DZ(2,3,3)\n";
    let mut s = session(&format!("{text}{force}"), &WAYS, "AUTO");
    rest(&mut s);
    assert!((last(&s, WAYS[0]) - 1.2).abs() < 1e-12);
    assert_eq!(last(&s, WAYS[1]), 2.0);
}

#[test]
fn what_feeds_an_output_through_is_solved_in_a_circle() {
    // y = u + x, ẋ = −x, u = 1 − y/2: y = (1 + x)/1.5
    let text = "VARIABLE/1, FUNCTION=1-0.5*ARYVAL(13,1)\nARRAY/10, U, VARIABLES=1\nARRAY/11, X\nARRAY/13, Y\n\
                ARRAY/14, IC, NUMBERS=2\nMATRIX/1, FULL=RORDER, ROWS=1, COLUMNS=1, VALUES=-1\n\
                MATRIX/2, FULL=RORDER, ROWS=1, COLUMNS=1, VALUES=1\n\
                LSE/1, X=11, U=10, Y=13, IC=14, A=1, C=2, D=2\n";
    let mut s = session(text, &["ARYVAL(13,1)"], "AUTO");
    go(&mut s, 2.0, 4);
    for (y, t) in values(&s, "ARYVAL(13,1)").iter().zip(values(&s, "time")) {
        let exact = (1.0 + 2.0 * (-t).exp()) / 1.5;
        assert!((y - exact).abs() < 1e-8, "{y} at {t}");
    }
}

#[test]
fn a_gain_is_a_transfer_function_without_states_and_plants_read_variables() {
    let text = "VARIABLE/1, FUNCTION=TIME\nARRAY/10, U, VARIABLES=1\nARRAY/11, X\nARRAY/13, Y\n\
                TFSISO/1, X=11, U=10, Y=13, NUMERATOR=6, DENOMINATOR=4\n\
                VARIABLE/2, FUNCTION=ARYVAL(13,1)\nPINPUT/3, VARIABLES=1\nPOUTPUT/4, VARIABLES=2,1\n";
    let mut s = session(text, &["POUVAL(4,1)", "POUVAL(4,2)", "PINVAL(3,1)"], "AUTO");
    go(&mut s, 2.0, 2);
    assert_eq!(values(&s, "POUVAL(4,1)")[1..], [1.5, 3.0]);
    assert_eq!(values(&s, "POUVAL(4,2)"), values(&s, "PINVAL(3,1)"));
}

#[test]
fn systems_that_do_not_fit_together_are_refused_with_their_names() {
    let base = three_ways("1");
    for (from, to, says) in [
        ("SIZE=2", "SIZE=3", "ARRAY/21 has SIZE = 3, but 2 entries"),
        (
            "NUMBERS=0,0",
            "NUMBERS=0,0,0",
            "ARRAY/24 gives 3 initial values for 2 states",
        ),
        (
            "ROWS=1, COLUMNS=2, VALUES=2,3",
            "ROWS=1, COLUMNS=3, VALUES=2,3,4",
            "MATRIX/3 is 1 by 3",
        ),
    ] {
        let text = base.replace(from, to);
        assert_ne!(text, base);
        let said = refused(&text);
        assert!(said.contains(says), "{said}");
    }
}

#[test]
fn a_sensor_ends_the_simulation_where_its_expression_passes_its_value() {
    // x = t²/2 reaches 2 at t = 2
    let push = "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=1\n";
    for (sensor, time) in [
        ("VALUE=2, GE, RETURN", 2.0),
        ("VALUE=2, EQ, HALT", 2.0),
        ("VALUE=4.5, GE, ERROR=1E-8, RETURN", 3.0),
    ] {
        for method in ["DOP853", "RADAU5"] {
            let text = format!("{push}SENSOR/7, FUNCTION=DZ(2,3,3)\\, {sensor}\n");
            let mut s = session(&text, &["DZ(2,3,3)"], method);
            go(&mut s, 10.0, 4);
            assert!(
                (s.time() - time).abs() < 1e-7,
                "{method} {sensor}: {}",
                s.time()
            );
            assert!((last(&s, "time") - time).abs() < 1e-7);
            assert!(s.run.record.stop_reason.contains("SENSOR/7"));
            assert_eq!(s.halted(), sensor.contains("HALT"));
        }
    }
}

#[test]
fn a_sensor_that_holds_at_the_start_waits_until_it_has_not_held() {
    // cos t: at least 0.5 until π/3, again from 5π/3
    let text = "SENSOR/1, FUNCTION=COS(TIME)\\, VALUE=0.5, GE, RETURN\n";
    let mut s = session(text, &[], "AUTO");
    go(&mut s, 10.0, 10);
    assert!(
        (s.time() - 5.0 * std::f64::consts::PI / 3.0).abs() < 1e-9,
        "{}",
        s.time()
    );
    // an angle modulo a turn
    let text = "SENSOR/1, FUNCTION=2*TIME+7\\, VALUE=1, EQ, ANGULAR, ERROR=1E-9, RETURN\n";
    let mut s = session(text, &[], "AUTO");
    go(&mut s, 10.0, 10);
    let due = (std::f64::consts::TAU - 6.0) / 2.0;
    assert!((s.time() - due).abs() < 1e-8, "{}", s.time());
}

#[test]
fn a_sensor_evaluates_what_a_force_then_reads() {
    // from t = 1 on the force is what the velocity was then
    let text = "SENSOR/1, FUNCTION=TIME\\, VALUE=1, GE, EVALUATE=2*VZ(2,3,3)\\\n\
                SENSOR/2, FUNCTION=TIME\\, VALUE=0, EQ, EVALUATE=DZ(2,3,3)+5\\\n\
                SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=IF(TIME-1: 3, SENVAL(1), SENVAL(1))\n";
    let mut s = session(text, &["SENVAL(1)", "SENVAL(2)", "VZ(2,3,3)"], "AUTO");
    go(&mut s, 2.0, 2);
    assert_eq!(values(&s, "SENVAL(2)")[1..], [5.0, 5.0]);
    assert!((last(&s, "SENVAL(1)") - 6.0).abs() < 1e-8);
    assert!(
        (last(&s, "VZ(2,3,3)") - 9.0).abs() < 1e-8,
        "{}",
        last(&s, "VZ(2,3,3)")
    );
}

#[test]
fn a_sensor_changes_the_distance_of_outputs_and_prints() {
    let text = "SENSOR/1, FUNCTION=TIME\\, VALUE=0.75, GE, DT=0.1, PRINT\n";
    let mut s = session(text, &[], "AUTO");
    go(&mut s, 1.0, 2);
    let expected = [0.0, 0.5, 0.75, 0.85, 0.95, 1.0];
    let found = values(&s, "time");
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 1e-9, "{found:?}");
    }
}

#[test]
fn commands_go_on_after_a_return_and_end_after_a_halt() {
    for (action, rows) in [("RETURN", 3), ("HALT", 2)] {
        let text =
            format!("{GROUND}{BODY}SENSOR/1, FUNCTION=TIME\\, VALUE=0.5, GE, {action}\nEND\n");
        let model = whole(&text);
        let script = Script::from_text(
            "\nFILE/MODEL=x\nSIMULATE/DYNAMIC, END=1, STEPS=1\nDEACTIVATE/SENSOR, ID=1\nSIMULATE/DYNAMIC, END=3, STEPS=1\nSTOP\n",
        )
        .unwrap_or_else(|e| panic!("{e}"));
        let mut s = begin(model, "test", Options::default());
        obeys(&mut s, &script);
        assert_eq!(
            values(&s, "time").len(),
            rows,
            "{action}: {:?}",
            values(&s, "time")
        );
    }
}

/// Where a sensor returns, what it watches may be short of VALUE by rounding. It waits for the next swing all the same, by
/// every method, and in a session that goes on from a saved state.
#[test]
fn a_sensor_returns_once_for_each_time_that_it_is_reached() {
    let swing = "SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=2, J=3, FUNCTION=-69*DZ(2,3,3)\n";
    let omega = 69.0_f64.sqrt();
    for (method, error) in [("DOP853", 1e-8), ("RADAU5", 1e-8)] {
        for k in 0..12 {
            // the part begins at rest at 0.415; it passes below x once in each swing
            let x = 0.4 * (0.5 * f64::from(k) - 2.9) / 3.0;
            let sensor =
                format!("SENSOR/1, FUNCTION=DZ(2,3,3)\\, VALUE={x:?}, LE, RETURN, EVALUATE=TIME\n");
            let text = format!("{BODY}{swing}{sensor}").replacen("CM=2", "CM=2, QG=0.415,0,0", 1);
            let mut s = session_by(&text, &["SENVAL(1)"], method, error);
            for n in 0..5 {
                if n == 3 {
                    let saved = s.save();
                    let saved = Saved::read(saved.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
                    s.reload(saved).unwrap_or_else(|e| panic!("{e}"));
                }
                try_to(&mut s, Analysis::Dynamic, 9.0, 7);
                let due = ((x / 0.415).acos() + f64::from(n) * std::f64::consts::TAU) / omega;
                let found = last(&s, "SENVAL(1)");
                assert!(
                    (found - due).abs() < 1e-4,
                    "{method} {x} {n}: {found} {due}"
                );
            }
        }
    }
}

#[test]
fn values_of_the_past_follow_what_was() {
    // ẏ = −y(t − 1), y = 1 before: pieces of polynomials, y = 1 − t, then 1 − t + (t − 1)²/2, then − (t − 2)³/6 more
    let text = "DIFF/1, IC=1, FUNCTION=-DELAY(DIF(1),1,1)\n\
                VARIABLE/2, FUNCTION=DELAY(SIN(TIME),0.3+0.1*TIME,TIME**2)\n";
    for (method, bound) in [("DOP853", 1e-9), ("RADAU5", 1e-8)] {
        let mut s = session(text, &["DIF(1)", "VARVAL(2)"], method);
        go(&mut s, 3.0, 12);
        for (row, &t) in values(&s, "time").iter().enumerate() {
            let mut y = 1.0 - t;
            y += if t > 1.0 {
                (t - 1.0).powi(2) / 2.0
            } else {
                0.0
            };
            y -= if t > 2.0 {
                (t - 2.0).powi(3) / 6.0
            } else {
                0.0
            };
            let found = values(&s, "DIF(1)")[row];
            assert!((found - y).abs() < bound, "{method}: {found} at {t}, {y}");
            let then = t - 0.3 - 0.1 * t;
            let past = if then < 0.0 { then * then } else { then.sin() };
            let found = values(&s, "VARVAL(2)")[row];
            assert!(
                (found - past).abs() < 1e-6,
                "{method}: {found} at {t}, {past}"
            );
        }
    }
}

#[test]
fn the_past_of_one_simulation_is_known_in_the_next() {
    let mut s = session(
        "DIFF/1, IC=1, FUNCTION=-DELAY(DIF(1),1,1)\n",
        &["DIF(1)"],
        "AUTO",
    );
    for end in [0.75, 1.5, 3.0] {
        go(&mut s, end, 2);
    }
    let exact = 1.0 - 3.0 + 2.0 - 1.0 / 6.0;
    assert!(
        (last(&s, "DIF(1)") - exact).abs() < 1e-8,
        "{}",
        last(&s, "DIF(1)")
    );
}

/// A column that is missing is told, with the reason, also of an expression that stands where USER is meant.
#[test]
fn a_request_that_nobody_computes_is_told() {
    for (request, told) in [
        ("FUNCTION=USER(1,2)", "REQUEST/1 FUNCTION"),
        ("F2=TIME\\F3=USER(1)\\", "REQUEST/1 F3"),
        ("FUNCTION=DZ(2,3,3)", "REQUEST/1 FUNCTION"),
        ("F2=TIME\\F3=2*TIME\\", ""),
    ] {
        let text = format!("REQUEST/1, {request}\n");
        let mut s = session(&text, &["DZ(2,3,3)"], "DOP853");
        go(&mut s, 1.0, 2);
        let warnings = &s.run.record.warnings;
        let about: Vec<String> = warnings.iter().map(results::Warning::sentence).collect();
        let about: Vec<&String> = about.iter().filter(|w| w.contains("REQUEST/1")).collect();
        assert_eq!(
            about.len(),
            usize::from(!told.is_empty()),
            "{request}: {about:?}"
        );
        assert!(
            about.iter().all(|w| w.contains(told)),
            "{request}: {about:?}"
        );
    }
}

#[test]
fn closures_compute_what_user_stands_for() {
    let text = "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=USER(100, 4, 0.2)\n\
                VARIABLE/1, FUNCTION=USER(7)\\, ROUTINE=mylib::twice\n\
                REQUEST/1, FUNCTION=USER(1,2)\n";
    let reference =
        "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=1-4*DZ(2,3,3)-0.2*VZ(2,3,3)\n";
    for method in ["DOP853", "RADAU5"] {
        let mut s = session(text, &["DZ(2,3,3)", "VARVAL(1)"], method);
        s.register("100", &["DZ(2,3,3)", "VZ(2,3,3)"], |call, out| {
            let [_, k, c] = call.constants else { return };
            out[0] = 1.0 - k * call.values[0] - c * call.values[1];
        });
        s.register("mylib::twice", &["TIME"], |call, out| {
            out[0] = 2.0 * call.values[0]
        });
        s.register("REQUEST/1", &["VARVAL(1)"], |call, out| {
            out[0] = call.values[0] + 1.0;
            out[7] = call.time;
        });
        go(&mut s, 3.0, 6);
        let mut plain = session(reference, &["DZ(2,3,3)"], method);
        go(&mut plain, 3.0, 6);
        for (a, b) in values(&s, "DZ(2,3,3)")
            .iter()
            .zip(values(&plain, "DZ(2,3,3)"))
        {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
        assert_eq!(last(&s, "VARVAL(1)"), 6.0);
        assert_eq!(
            (last(&s, "REQUEST_1.F1"), last(&s, "REQUEST_1.F8")),
            (7.0, 3.0)
        );
    }
}

#[test]
fn a_closure_may_drive_a_motion_and_be_a_general_system() {
    let text = "MOTION/1, JOINT=1, TRANSLATION, FUNCTION=USER(5)\n\
                VARIABLE/1, FUNCTION=1\nARRAY/10, U, VARIABLES=1\nARRAY/11, X\nARRAY/12, Y\nARRAY/13, IC, NUMBERS=2\n\
                GSE/1, NS=1, NO=1, X=11, U=10, Y=12, IC=13, FUNCTION=USER(9)\n";
    let mut s = session(
        text,
        &["DZ(2,3,3)", "ACCZ(2,3,3)", "ARYVAL(11,1)", "ARYVAL(12,1)"],
        "AUTO",
    );
    s.register("5", &["TIME"], |call, out| {
        let (sin, cos) = call.values[0].sin_cos();
        out.copy_from_slice(&[sin, cos, -sin]);
    });
    // ẋ = u − x, y = 3 x
    s.register("GSE/1", &[], |call, out| {
        let [x, u] = call.values else { return };
        out.copy_from_slice(&[u - x, 3.0 * x]);
    });
    go(&mut s, 2.0, 4);
    for (row, &t) in values(&s, "time").iter().enumerate() {
        assert!((values(&s, "DZ(2,3,3)")[row] - t.sin()).abs() < 1e-9);
        assert!((values(&s, "ACCZ(2,3,3)")[row] + t.sin()).abs() < 1e-9);
        let x = 1.0 + (-t).exp();
        assert!((values(&s, "ARYVAL(11,1)")[row] - x).abs() < 1e-8);
        assert!((values(&s, "ARYVAL(12,1)")[row] - 3.0 * x).abs() < 1e-8);
    }
}

#[test]
fn without_its_closure_user_is_refused_or_zero_as_asked() {
    let text = "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=USER(100)\n\
                ARRAY/12, Y\nGSE/1, NO=1, Y=12, FUNCTION=USER(1)\n";
    let said = refused(text);
    assert!(
        said.contains("SFORCE/1") && said.contains("GSE/1"),
        "{said}"
    );
    let mut s = session(text, &["DZ(2,3,3)", "ARYVAL(12,1)"], "AUTO");
    s.register("100", &["ACCZ(2,3,3)"], |_, _| ());
    let said = mistakes(&mut s, Analysis::Dynamic);
    assert!(said.len() == 1, "{said:?}");
    let model = s.model.clone();
    let options = Options {
        zero_user: true,
        columns: vec!["DZ(2,3,3)".into(), "ARYVAL(12,1)".into()],
        ..Options::default()
    };
    let mut s = begin(model, "test", options);
    go(&mut s, 1.0, 1);
    assert_eq!(
        (last(&s, "DZ(2,3,3)"), last(&s, "ARYVAL(12,1)")),
        (0.0, 0.0)
    );
}

#[test]
fn a_closure_that_reads_its_own_result_is_refused() {
    let text = "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=USER(100)\n";
    let mut s = session(text, &[], "AUTO");
    s.register("100", &["ACCZ(2,3,3)"], |_, out| out[0] = 1.0);
    let said = mistakes(&mut s, Analysis::Dynamic);
    assert!(said[0].to_string().contains("SFORCE/1"), "{said:?}");
}

#[test]
fn a_motion_may_follow_a_differential_equation_of_time() {
    // DIF(1) = sin t, so the body moves like it, its acceleration too
    let text =
        "DIFF/1, IC=0, FUNCTION=COS(TIME)\nMOTION/1, JOINT=1, TRANSLATION, FUNCTION=2*DIF(1)\n";
    let mut s = session(text, &["DZ(2,3,3)", "VZ(2,3,3)", "ACCZ(2,3,3)"], "AUTO");
    go(&mut s, 2.0, 4);
    for (row, &t) in values(&s, "time").iter().enumerate() {
        assert!(
            (values(&s, "DZ(2,3,3)")[row] - 2.0 * t.sin()).abs() < 1e-8,
            "{t}"
        );
        assert!((values(&s, "VZ(2,3,3)")[row] - 2.0 * t.cos()).abs() < 1e-8);
        assert!((values(&s, "ACCZ(2,3,3)")[row] + 2.0 * t.sin()).abs() < 1e-8);
    }
}

/// A free unit mass with MARKER/2, and MARKER/5 on ground that follows it as a floating marker.
const FREE: &str = "TEST\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=2, IP=1,2,3, QG=1,0,0, VX=0.5, WY=0.3\nMARKER/2, PART=2\n\
                    MARKER/5, PART=1, FLOATING\nMARKER/7, PART=1, FLOATING\nMARKER/6, PART=1, REULER=90D,90D,0\n";

fn free(text: &str, columns: &[&str], method: &str) -> Session {
    let model = whole(&format!(
        "{FREE}{text}END
"
    ));
    begin(model, "test", options_by(columns, method, 1e-10))
}

#[test]
fn closures_give_all_components_of_vector_forces() {
    let columns = [
        "DX(2,1)", "DY(2,1)", "DZ(2,1)", "WX(2,1)", "WY(2,1)", "WZ(2,1)",
    ];
    let laws = [
        ["-3*DX(2,1)-0.1*VX(2,1)", "COS(TIME)", "0.2*DX(2,1)"],
        ["-0.5*WX(2,1)", "-0.5*WY(2,1)+0.1*SIN(TIME)", "0.3"],
    ];
    let forces = |kind: &str, names: [&str; 3], law: &[&str; 3]| {
        let parts = names.iter().zip(law).map(|(n, f)| format!(", {n}={f}"));
        let parts = parts.collect::<Vec<_>>().join("\\");
        format!("{kind}, I=2, JFLOAT=5, RM=6{parts}\n")
    };
    let (f, t) = (["FX", "FY", "FZ"], ["TX", "TY", "TZ"]);
    let plain = forces("VFORCE/1", f, &laws[0])
        + &forces("VTORQUE/1", t, &laws[1]).replace("JFLOAT=5", "JFLOAT=7");
    let reads = ["DX(2,1)", "VX(2,1)", "WX(2,1)", "WY(2,1)"];
    let force = |call: &cognate::internals::system::closures::Call<'_>| {
        let [x, v, ..] = *call.values else {
            return [f64::NAN; 3];
        };
        [-3.0 * x - 0.1 * v, call.time.cos(), 0.2 * x]
    };
    let torque = |call: &cognate::internals::system::closures::Call<'_>| {
        let [_, _, wx, wy] = *call.values else {
            return [f64::NAN; 3];
        };
        [-0.5 * wx, -0.5 * wy + 0.1 * call.time.sin(), 0.3]
    };
    for method in ["DOP853", "RADAU5"] {
        let mut reference = free(&plain, &columns, method);
        go(&mut reference, 2.0, 4);
        let mut apart = free(
            "VFORCE/1, I=2, JFLOAT=5, RM=6, FUNCTION=USER(1)\nVTORQUE/1, I=2, JFLOAT=7, RM=6, FUNCTION=USER(2)\n",
            &columns,
            method,
        );
        apart.register("VFORCE/1", &reads, move |call, out| {
            out.copy_from_slice(&force(call))
        });
        apart.register("2", &reads, move |call, out| {
            out.copy_from_slice(&torque(call))
        });
        let mut together = free(
            "GFORCE/1, I=2, JFLOAT=5, RM=6, FUNCTION=USER(9,8)\n",
            &columns,
            method,
        );
        together.register("9", &reads, move |call, out| {
            assert_eq!(
                (call.element.to_string().as_str(), call.constants),
                ("GFORCE/1", &[9.0, 8.0][..])
            );
            out[..3].copy_from_slice(&force(call));
            out[3..].copy_from_slice(&torque(call));
        });
        for s in [&mut apart, &mut together] {
            go(s, 2.0, 4);
            for c in columns {
                for (a, b) in values(s, c).iter().zip(values(&reference, c)) {
                    // both within the request of 1e-10, grown over two seconds
                    assert!((a - b).abs() < 1e-8, "{method} {c}: {a} {b}");
                }
            }
        }
        assert!(
            columns
                .iter()
                .all(|c| (last(&reference, c) - values(&reference, c)[0]).abs() > 1e-2)
        );
    }
}

#[test]
fn what_a_closure_exerts_is_reported_and_reacts() {
    let text = "GFORCE/1, I=2, JFLOAT=5, RM=6, FUNCTION=USER(9)\nREQUEST/1, FORCE, I=2, J=5\n";
    let columns = ["GFORCE(1,0,2,1)", "GFORCE(1,1,2,1)", "GFORCE(1,0,8,6)"];
    let mut s = free(text, &columns, "AUTO");
    s.register("9", &[], |call, out| {
        // x of MARKER/6 is y of ground
        out[0] = 1.0 + call.time;
        out[5] = 2.0;
    });
    go(&mut s, 1.0, 2);
    assert_eq!(last(&s, "GFORCE(1,0,8,6)"), 2.0);
    assert_eq!(last(&s, "GFORCE(1,0,2,1)"), -last(&s, "GFORCE(1,1,2,1)"));
}

#[test]
fn a_closure_that_yields_no_number_is_named() {
    let mut s = free(
        "GFORCE/1, I=2, JFLOAT=5, RM=6, FUNCTION=USER(9)\n",
        &[],
        "AUTO",
    );
    s.register("9", &[], |call, out| {
        out[0] = if call.time < 0.5 { 1.0 } else { f64::NAN };
    });
    let status = try_to(&mut s, Analysis::Dynamic, 1.0, 2);
    assert_ne!(status, Status::Completed);
    assert!((s.time() - 0.5).abs() < 1e-6, "{}", s.time());
    assert!(
        s.run.record.stop_reason.contains("PART/2")
            || s.run.record.stop_reason.contains("GFORCE/1"),
        "{}",
        s.run.record.stop_reason
    );
}

#[test]
fn a_sensor_with_le_waits_for_a_fall() {
    // from below: x = t²/2 − 1 is less than 1 at once, so it waits; cos t falls to 0.5 at π/3
    for (function, value, due) in [
        ("COS(TIME)", "0.5", std::f64::consts::FRAC_PI_3),
        ("2-DZ(2,3,3)", "0", 2.0),
    ] {
        for method in ["DOP853", "RADAU5"] {
            let text = format!(
                "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=1\nSENSOR/1, FUNCTION={function}\\, VALUE={value}, LE, RETURN\n"
            );
            let mut s = session(&text, &[], method);
            go(&mut s, 10.0, 3);
            assert!(
                (s.time() - due).abs() < 1e-7,
                "{method} {function}: {}",
                s.time()
            );
        }
    }
}

#[test]
fn a_sensor_shortens_the_next_step_or_begins_anew() {
    let push = "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=-DZ(2,3,3)+1\n";
    let steps = |method: &str, more: &str| {
        let mut s = session(&format!("{push}{more}"), &["DZ(2,3,3)"], method);
        go(&mut s, 1.0, 1);
        assert!(
            (last(&s, "DZ(2,3,3)") - (1.0 - 1f64.cos())).abs() < 1e-9,
            "{more}"
        );
        s.run.record.counts.steps
    };
    let sensor = "SENSOR/1, FUNCTION=TIME\\, VALUE=0.5, GE";
    for method in ["DOP853", "RADAU5"] {
        let plain = steps(method, "");
        let anew = steps(method, &format!("{sensor}, RESTART\n"));
        let short = steps(method, &format!("{sensor}, STEPSIZE=1E-6\n"));
        // a step ends at the sensor and one begins there; a short one has to grow again, at most tenfold each time
        // (implicit methods grow their steps so slowly that beginning anew may even save some)
        assert!(anew > plain || method != "DOP853", "{plain} {anew}");
        assert!(short >= plain + 3, "{method}: {plain} {short}");
        assert!(short >= anew + 3, "{method}: {anew} {short}");
    }
}

/// In a mechanism without freedom, too, the step after a sensor is as short as it asks for, and grows from there.
#[test]
fn a_sensor_shortens_the_next_step_of_a_driven_mechanism() {
    let crank = "MARKER/11, PART=1, QP=4,0,0\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=1,0,0\n\
                 PART/3, MASS=1, CM=30, IP=1,1,1\nMARKER/30, PART=3, QP=1,0,0\nMARKER/31, PART=3, QP=4,3,0\n\
                 PART/4, MASS=1, CM=40, IP=1,1,1\nMARKER/40, PART=4, QP=4,3,0\nMARKER/41, PART=4, QP=4,0,0\n\
                 JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, REVOLUTE, I=30, J=21\nJOINT/3, REVOLUTE, I=40, J=31\n\
                 JOINT/4, REVOLUTE, I=41, J=11\nMOTION/1, JOINT=1, ROTATION, FUNCTION=TIME\n";
    let run = |more: &str| {
        let column = ["AZ(40,11)"];
        let mut s = running::session(&format!("{crank}{more}"), &column, 1e-6);
        running::go(&mut s, running::Analysis::Kinematic, 1.0, 1);
        (s.run.record.counts.steps, running::last(&s, column[0]))
    };
    let (plain, place) = run("");
    let sensor = "SENSOR/1, FUNCTION=AZ(20,1), VALUE=0.5, GE, ERROR=1E-6";
    let (short, there) = run(&format!("{sensor}, STEPSIZE=1E-6\n"));
    let (shorter, _) = run(&format!("{sensor}, STEPSIZE=1E-9\n"));
    assert!(
        short >= plain + 3 && shorter > short,
        "{plain} {short} {shorter}"
    );
    assert!((place - there).abs() < 1e-9, "{place} {there}");
}

/// Before a run it is told where a motion takes the argument of a spline beyond its data, and how far; not where the run
/// ends before.
#[test]
fn a_spline_whose_data_end_before_its_motion_does_is_told_without_a_run() {
    let model = |motion: &str| {
        format!(
            "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nJOINT/1, TRANSLATIONAL, I=20, J=1\n\
             MOTION/1, JOINT=1, TRANSLATION, FUNCTION={motion}\nSPLINE/7, X=-1,0,1,2, Y=1,0,1,4\n\
             SFORCE/3, TRANSLATION, ACTIONONLY, I=20, J=1, FUNCTION=CUBSPL(DZ(20,1),0,7,0)\n"
        )
    };
    for (motion, told) in [
        ("TIME", Some("3")),
        ("0.5*TIME", None),
        ("-0.5*TIME", Some("-1.5")),
        ("1.9*SIN(PI*TIME)", Some("-1.9")),
        ("STEP(TIME,1,0,2,2)", None),
    ] {
        let session = running::session(&model(motion), &["TIME"], 1e-6);
        let found = session.preview(running::Analysis::Transient, 3.0);
        let outside = found.iter().find(|d| d.code == "outside_data");
        match (told, outside) {
            (None, None) => {}
            (Some(worst), Some(d)) => {
                assert_eq!(d.element.as_deref(), Some("SFORCE/3"), "{motion}: {d}");
                let part = format!("SPLINE/7 at {worst}");
                assert!(d.message.contains(&part), "{motion}: {d}");
            }
            _ => panic!("{motion}: {found:?}"),
        }
    }
}

/// dₖ₊₁ = 0.8 dₖ + u(tₖ), y = 2 d + 0.5 u, sampled every 0.1; beside it what reads them.
const SAMPLED: &str = "VARIABLE/1, FUNCTION=1+TIME\nARRAY/10, U, VARIABLES=1\nARRAY/12, Y\nARRAY/14, X\nARRAY/15, IC, NUMBERS=3\n\
    GSE/1, NO=1, U=10, Y=12, ND=1, XD=14, ICD=15, SAMPLE_PERIOD=0.1, FUNCTION=USER(1)\n";

/// d and y by the recursion itself, at a time that is no sample.
fn recursion(t: f64) -> [f64; 2] {
    let (mut d, mut k) = (3.0, 0);
    while f64::from(k + 1) * 0.1 < t + 1e-9 {
        d = 0.8 * d + 1.0 + 0.1 * f64::from(k);
        k += 1;
    }
    [d, 2.0 * d + 0.5 * (1.0 + t)]
}

fn sampled(columns: &[&str]) -> Session {
    let text = format!("{SAMPLED}DIFF/1, IC=0, FUNCTION=ARYVAL(14,1)\n");
    let mut s = session(&text, columns, "AUTO");
    s.register("1", &[], |call, out| {
        let [u, d] = call.values else { return };
        out.copy_from_slice(&[2.0 * d + 0.5 * u, 0.8 * d + u]);
    });
    s
}

#[test]
fn discrete_states_change_at_their_samples_and_hold_in_between() {
    let columns = ["ARYVAL(14,1)", "ARYVAL(12,1)", "DIF(1)"];
    let mut s = sampled(&columns);
    // outputs at samples and between them
    go(&mut s, 1.0, 40);
    for (row, &t) in values(&s, "time").iter().enumerate() {
        let [d, y] = recursion(t);
        assert!((values(&s, columns[0])[row] - d).abs() < 1e-12, "{t}");
        assert!((values(&s, columns[1])[row] - y).abs() < 1e-12, "{t}");
    }
    // the integral of a staircase is a sum
    let sum: f64 = (0..10)
        .map(|k| 0.1 * recursion(0.1 * f64::from(k) + 0.05)[0])
        .sum();
    assert!(
        (last(&s, "DIF(1)") - sum).abs() < 1e-9,
        "{}",
        last(&s, "DIF(1)")
    );
}

#[test]
fn samples_go_on_from_one_simulation_to_the_next() {
    let columns = ["ARYVAL(14,1)", "DIF(1)"];
    let (mut whole, mut pieces) = (sampled(&columns), sampled(&columns));
    go(&mut whole, 1.0, 10);
    for end in [0.03, 0.1, 0.25, 0.4, 1.0] {
        go(&mut pieces, end, 3);
    }
    for c in columns {
        assert!((last(&whole, c) - last(&pieces, c)).abs() < 1e-9, "{c}");
    }
}

#[test]
fn linear_systems_are_closures_sampled_and_continuous() {
    use cognate::internals::system::samples::LinearSystem;
    let system = |a: f64| LinearSystem::new([1, 1, 1], &[a], &[1.0], &[2.0], &[0.5]).unwrap();
    assert!(LinearSystem::new([2, 1, 1], &[1.0], &[1.0], &[2.0], &[0.5]).is_none());
    let columns = ["ARYVAL(14,1)", "ARYVAL(12,1)"];
    let mut s = session(SAMPLED, &columns, "AUTO");
    s.register("GSE/1", &[], system(0.8).sampled());
    go(&mut s, 0.95, 19);
    for (row, &t) in values(&s, "time").iter().enumerate() {
        let [d, y] = recursion(t);
        assert!((values(&s, columns[0])[row] - d).abs() < 1e-12, "{t}");
        assert!((values(&s, columns[1])[row] - y).abs() < 1e-12, "{t}");
    }
    // ẋ = −x + 1 from 0, y = 2 x + 0.5
    let text = "VARIABLE/1, FUNCTION=1\nARRAY/10, U, VARIABLES=1\nARRAY/11, X\nARRAY/12, Y\n\
        GSE/1, NS=1, NO=1, U=10, Y=12, X=11, FUNCTION=USER(1)\n";
    let mut s = session(text, &["ARYVAL(12,1)"], "AUTO");
    s.register("GSE/1", &[], system(-1.0).continuous());
    go(&mut s, 2.0, 4);
    let y = 2.0 * (1.0 - (-2.0f64).exp()) + 0.5;
    assert!((last(&s, "ARYVAL(12,1)") - y).abs() < 1e-8);
}

#[test]
fn a_sampled_controller_holds_a_body_and_a_model_without_unknowns_samples_too() {
    // a velocity control that is sampled: v̇ = F, F = −2 vₖ, so vₖ₊₁ = (1 − 2 T) vₖ, seen one sample late
    let text = "VARIABLE/1, FUNCTION=VZ(2,3,3)\nARRAY/10, U, VARIABLES=1\nARRAY/14, X\n\
        GSE/1, NO=0, U=10, ND=1, XD=14, SAMPLE_PERIOD=0.05, FUNCTION=USER(1)\n\
        SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=ARYVAL(14,1)+1\n";
    let mut s = session(text, &["VZ(2,3,3)"], "AUTO");
    s.register("1", &[], |call, out| out[0] = -2.0 * call.values[0]);
    go(&mut s, 1.0, 4);
    let (mut v, mut d) = (0.0, 0.0);
    for _ in 0..20 {
        let next = -2.0 * v;
        v += 0.05 * (d + 1.0);
        d = next;
    }
    assert!((last(&s, "VZ(2,3,3)") - v).abs() < 1e-9, "{v}");
    let model = whole(&format!("{GROUND}{SAMPLED}END\n"));
    let options = Options {
        columns: vec!["ARYVAL(14,1)".into()],
        ..Options::default()
    };
    let mut s = begin(model, "test", options);
    s.register("1", &[], |call, out| {
        let [u, d] = call.values else { return };
        out.copy_from_slice(&[2.0 * d + 0.5 * u, 0.8 * d + u]);
    });
    go(&mut s, 1.05, 7);
    assert!((last(&s, "ARYVAL(14,1)") - recursion(1.05)[0]).abs() < 1e-12);
}

#[test]
fn sampling_without_a_period_is_refused() {
    let text = SAMPLED.replace("SAMPLE_PERIOD=0.1, ", "");
    let with_law = |text: &str| {
        let mut s = session(text, &[], "AUTO");
        s.register("1", &[], |_, _| ());
        let errors = mistakes(&mut s, Analysis::Dynamic);
        errors.iter().map(|e| format!("{e}\n")).collect::<String>()
    };
    assert!(with_law(&text).contains("SAMPLE_PERIOD"));
    let none = with_law(&SAMPLED.replace("PERIOD=0.1", "PERIOD=-0.1"));
    assert!(none.contains("GSE/1") && none.contains("-0.1"), "{none}");
}

/// Numbers that commands change, obeyed from a script, which knows them beforehand, and one after the other, where every model is a new one.
#[test]
fn numbers_that_commands_change_do_what_new_models_would() {
    let model = "VARIABLE/1, FUNCTION=2\nVARIABLE/2, FUNCTION=0.5*VARVAL(1)\nDIFF/1, IC=0, FUNCTION=VARVAL(2)-DIF(1)\n\
                 SENSOR/1, FUNCTION=DX(2,1,1), GE, VALUE=0.3, ERROR=1E-9, EVALUATE=TIME, RESTART\n\
                 SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=2, J=3, FUNCTION=VARVAL(1)-DZ(2,3,3)+SENVAL(1)\n";
    let commands = "\nSIM/DYN, END=0.5, STEPS=2\nVAR/1, FUN=-1.5\nSIM/DYN, END=1, STEPS=2\nVAR/1, FUN=3.0E-01\n\
                    SIM/DYN, END=1.5, STEPS=2\nVAR/1, FUN=TIME**2\nSIM/DYN, END=2, STEPS=2\nVAR/1, FUN=1\n\
                    SIM/DYN, END=2.5, STEPS=2\nDEACT/SFORCE, ID=1\nSIM/DYN, END=3, STEPS=2\n";
    for method in ["AUTO", "RADAU5"] {
        let columns = ["DX(2,1,1)", "VX(2,1,1)", "DIF(1)", "VARVAL(2)"];
        let mut known = session(model, &columns, method);
        let script = Script::from_text(commands).unwrap();
        obeys(&mut known, &script);
        let mut new = session(model, &columns, method);
        for step in &script.steps {
            match &step.command {
                cognate::dataset::command::Command::Simulate(s) => go(&mut new, s.end.unwrap(), 2),
                other => new.model.apply(other).unwrap(),
            }
        }
        for c in columns {
            assert_eq!(values(&known, c).len(), values(&new, c).len());
            for (a, b) in values(&known, c).iter().zip(values(&new, c)) {
                // different programs round differently, and differ where a step chosen by rounding does
                assert!((a - b).abs() < 1e-7, "{method} {c}: {a} {b}");
            }
        }
    }
}

#[test]
fn a_motion_may_read_a_number_that_commands_change() {
    let model =
        "VARIABLE/1, FUNCTION=2\nMOTION/1, JOINT=1, TRANSLATION, FUNCTION=VARVAL(1)*TIME**3\n";
    let mut s = session(model, &["DZ(2,3,3)"], "AUTO");
    let script = Script::from_text(
        "\nSIM/TRANSIENT, END=1, STEPS=2\nVAR/1, FUN=3\nSIM/TRANSIENT, END=2, STEPS=2\n",
    )
    .unwrap();
    obeys(&mut s, &script);
    let z = values(&s, "DZ(2,3,3)");
    assert!((z.last().unwrap() - 24.0).abs() < 1e-9, "{z:?}");
}

/// The past of a delayed value goes on in the next simulation by what it is of: not by how many
/// others there are.
#[test]
fn the_past_goes_on_where_other_delays_come_and_go() {
    use cognate::model::ElementKind;
    let text = "DIFF/1, IC=0, FUNCTION=1\n\
                VARIABLE/1, FUNCTION=DELAY(DIF(1),0.5,0)\n\
                VARIABLE/2, FUNCTION=DELAY(2*DIF(1),0.25,0)\n\
                VARIABLE/3, FUNCTION=DELAY(-DIF(1),0.25,7)\n";
    let [first, third] = [1, 3].map(|id| ElementKind::Variable.id(id));
    // another number of delays, and as many of which one is another
    for comes in [None, Some(third)] {
        let mut s = session(text, &["VARVAL(2)"], "AUTO");
        s.model.inactive.insert(third);
        go(&mut s, 1.0, 4);
        s.model.inactive.insert(first);
        if let Some(comes) = comes {
            s.model.inactive.remove(&comes);
        }
        go(&mut s, 1.2, 4);
        let exact = |t: f64| 2.0 * (t - 0.25).max(0.0);
        assert!(running::off(&s, "VARVAL(2)", exact) < 1e-8, "{comes:?}");
    }
}

/// A fall with sensors; the times at which they were triggered, and the last time of the run.
fn triggered(statements: &str, (method, error, outputs): (&str, f64, usize)) -> f64 {
    let text = format!(
        "PART/2, MASS=1, CM=20, IP=1,1,1, QG=0,0,10, WZ=2\nMARKER/20, PART=2\nMARKER/21, PART=1\n\
         ACCGRAV/KGRAV=-9.81\n{statements}"
    );
    let mut s = session_by(&text, &["DZ(20,1)"], method, error);
    let status = try_to(&mut s, Analysis::Dynamic, 2.0, outputs);
    assert_eq!(status, Status::Completed, "{statements}");
    last(&s, "time")
}

/// Whatever the method, the request, the number of outputs and ERROR, a sensor ends the run where its expression passes its
/// value: beside another one, at an output, by a jump, and where the branch on which the motion goes on begins beyond it.
#[test]
fn sensors_act_at_the_instant_at_which_they_are_passed() {
    let fallen = |z: f64| (2.0 * z / 9.81_f64).sqrt();
    let cases: [(&str, f64); 12] = [
        (
            "SENSOR/1, FUNCTION=TIME, VALUE=0.5, GE, HALT, ERROR=0\n",
            0.5,
        ),
        (
            "SENSOR/1, FUNCTION=TIME, VALUE=0.5, EQ, HALT, ERROR=0\n",
            0.5,
        ),
        (
            "SENSOR/1, FUNCTION=-TIME, VALUE=-0.5, LE, HALT, ERROR=0\n",
            0.5,
        ),
        (
            "SENSOR/2, FUNCTION=TIME, VALUE=0.5, GE, PRINT, ERROR=0\nSENSOR/1, FUNCTION=TIME, VALUE=0.5, GE, HALT, ERROR=0\n",
            0.5,
        ),
        (
            "SENSOR/2, FUNCTION=TIME, VALUE=0.5, GE, PRINT, ERROR=0\n\
             SENSOR/1, FUNCTION=TIME, VALUE=0.500000001, GE, HALT, ERROR=0\n",
            0.500000001,
        ),
        (
            "SENSOR/1, FUNCTION=IF(TIME-0.7:0,0,30), VALUE=1, GE, HALT\n",
            0.7,
        ),
        (
            "SENSOR/1, FUNCTION=IF(TIME-0.7:30,0,0), VALUE=1, LE, HALT\n",
            0.7,
        ),
        (
            "SENSOR/1, FUNCTION=IF(TIME-0.7:-30,0,30), VALUE=1, EQ, HALT\n",
            0.7,
        ),
        (
            "SENSOR/1, FUNCTION=IF(DZ(20,1)-9:30,0,0), VALUE=1, GE, HALT\n",
            fallen(1.0),
        ),
        (
            "SFORCE/1, I=20, J=21, ACTIONONLY, TRANSLATION, FUNCTION=IF(TIME-0.7:0,0,30)\n\
             SENSOR/1, FUNCTION=ACCZ(20,1), VALUE=1, GE, HALT, ERROR=1E-9\n",
            0.7,
        ),
        (
            "SENSOR/1, FUNCTION=VZ(20,1)**2, VALUE=4, GE, HALT, ERROR=0\n",
            2.0 / 9.81,
        ),
        // an angle passes half a turn without passing its value
        (
            "SENSOR/1, FUNCTION=AZ(20,1), VALUE=3, EQ, ANGULAR, HALT, ERROR=0\n",
            1.5,
        ),
    ];
    for (statements, expected) in cases {
        for method in ["AUTO", "DOP853", "RADAU5"] {
            for outputs in [3, 200] {
                let at = triggered(statements, (method, 1e-6, outputs));
                let off = (at - expected).abs();
                assert!(off < 1e-5, "{statements} by {method}: {at} for {expected}");
                let by_time = statements.contains("TIME") && !statements.contains("DZ");
                assert!(
                    off < 1e-9 || !by_time,
                    "{statements} by {method}: {at} for {expected}"
                );
            }
        }
    }
}

/// The same for a mechanism that its motions move alone.
#[test]
fn sensors_of_driven_mechanisms_act_where_they_are_passed() {
    let driven = "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nJOINT/1, REVOLUTE, I=20, J=1\n\
                  MOTION/1, JOINT=1, ROTATION, FUNCTION=2*TIME\n";
    for (sensor, expected) in [
        ("FUNCTION=TIME, VALUE=0.5, GE", 0.5),
        ("FUNCTION=TIME, VALUE=0.5, EQ", 0.5),
        ("FUNCTION=-TIME, VALUE=-0.5, LE", 0.5),
        ("FUNCTION=IF(TIME-0.7:0,0,30), VALUE=1, GE", 0.7),
        ("FUNCTION=IF(TIME-0.7:-30,0,30), VALUE=1, EQ", 0.7),
        ("FUNCTION=AZ(20,1), VALUE=3, EQ, ANGULAR", 1.5),
    ] {
        for outputs in [3, 50, 200] {
            let text = format!("{driven}SENSOR/1, {sensor}, HALT, ERROR=0\n");
            let mut s = session_by(&text, &["AZ(20,1)"], "AUTO", 1e-6);
            let status = try_to(&mut s, Analysis::Kinematic, 2.0, outputs);
            assert_eq!(status, Status::Completed, "{sensor}");
            let at = last(&s, "time");
            assert!(
                (at - expected).abs() < 1e-12,
                "{sensor} with {outputs} outputs: {at}"
            );
        }
    }
}
