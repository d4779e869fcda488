//! What is not solved and left out on demand: what hangs on it goes with it, functions read zero of it, and everything says so.
//! Beside that, what is kept: values of sensors that are switched off, rates of equations that have none of their own, frames of floating
//! markers.

use crate::running;

use cognate::dataset::command::Script;
use running::{Analysis, Options, Session, begin, last, mistakes, obeys, options, whole};

/// A unit mass that may move along x; MARKER/2 on it, MARKER/3 on ground.
const BODY: &str = "TEST\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=2\n\
                    MARKER/2, PART=2, REULER=90D,90D,0\nMARKER/3, PART=1, REULER=90D,90D,0\n\
                    JOINT/1, TRANSLATIONAL, I=2, J=3\n";

fn session(text: &str, columns: &[&str], skip: &[&str], zero_user: bool) -> Session {
    let options = Options {
        skip: skip.iter().map(|k| k.parse().unwrap()).collect(),
        zero_user,
        ..options(columns, 1e-10)
    };
    begin(whole(&format!("{BODY}{text}END\n")), "test", options)
}

fn go(s: &mut Session, end: f64) {
    running::go(s, Analysis::Dynamic, end, 10);
}

fn warns(s: &Session, parts: &[&str]) -> bool {
    let all = s.run.record.warned();
    all.iter().any(|w| parts.iter().all(|p| w.contains(p)))
}

/// A contact of a solid that only its own kernel knows, and everything that may read it.
const CONTACT: &str = "GRAPHICS/1, PLANE, RM=3\nGRAPHICS/2, EXTERNAL, RM=2, FILE=gear.xmt_txt, ELEMENT=a\n\
    CONTACT/5, IGEOM=2, JGEOM=1, IMPACT, STIFFNESS=1E4, EXPONENT=1, DAMPING=0, DMAX=1E-3\n\
    SENSOR/1, FUNCTION=CONTACT(5,0,1,0)\\, VALUE=1, GE, HALT\n\
    VARIABLE/1, FUNCTION=CONTACT(5,0,4,0)+1\n\
    DIFF/1, IC=2, FUNCTION=CONTACT(5,1,2,0)\n\
    SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=CONTACT(5,0,2,0)+3\n";

#[test]
fn of_a_contact_that_is_left_out_everything_reads_zero() {
    let columns = ["VARVAL(1)", "DIF(1)", "CONTACT(5,0,1,0)", "VX(2,1)"];
    let mut s = session(CONTACT, &columns, &["CONTACT"], false);
    go(&mut s, 1.0);
    let found = [0, 1, 2].map(|k| last(&s, columns[k]));
    assert_eq!(found, [1.0, 2.0, 0.0]);
    // a constant force is integrated exactly
    assert!((last(&s, "VX(2,1)").abs() - 3.0).abs() < 1e-12);
    assert!(warns(&s, &["CONTACT/5", "left out", "gear.xmt_txt"]));
    for reader in ["SENSOR/1", "VARIABLE/1", "DIFF/1", "SFORCE/1"] {
        assert!(warns(&s, &[reader, "CONTACT/5", "zero"]), "{reader}");
    }
    // it is not left out by itself
    let error = mistakes(&mut session(CONTACT, &[], &[], false), Analysis::Dynamic);
    assert_eq!(error[0].code, "unsupported");
}

#[test]
fn a_body_that_is_left_out_takes_with_it_what_is_attached() {
    let text = "FLEX_BODY/9, QG=0,0,0\nMARKER/91, FLEX_BODY=9\n\
        JOINT/7, REVOLUTE, I=91, J=1\nMOTION/7, JOINT=7, ROTATION, FUNCTION=TIME\n\
        SFORCE/7, TRANSLATION, I=2, J=91, FUNCTION=100\n\
        SFORCE/8, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=2+DX(91,1)+JOINT(7,0,2,0)\n";
    let mut s = session(text, &["VX(2,1)"], &["FLEX_BODY"], false);
    go(&mut s, 1.0);
    assert!((last(&s, "VX(2,1)").abs() - 2.0).abs() < 1e-12);
    for gone in ["FLEX_BODY/9", "JOINT/7", "MOTION/7", "SFORCE/7"] {
        assert!(warns(&s, &[gone, "left out"]), "{gone}");
    }
    assert!(warns(&s, &["SFORCE/8", "MARKER/91", "zero"]));
}

#[test]
fn a_curve_that_a_routine_computes_holds_nothing_when_routines_are_zero() {
    let text = "CURVE/1, OPEN, FUNCTION=USER(1)\\\nMARKER/31, PART=1, FLOATING\n\
        PTCV/1, CURVE=1, I=2, JFLOAT=31, RM=3\n\
        SFORCE/8, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=2+PTCV(1,0,1,0)+DX(31,1)\n";
    let mut s = session(text, &["VX(2,1)"], &[], true);
    go(&mut s, 1.0);
    assert!((last(&s, "VX(2,1)").abs() - 2.0).abs() < 1e-12);
    assert!(warns(&s, &["PTCV/1", "left out", "CURVE/1"]));
    assert!(warns(&s, &["SFORCE/8", "MARKER/31", "zero"]));
    let error = mistakes(&mut session(text, &[], &[], false), Analysis::Dynamic);
    assert!(error.iter().any(|d| d.code == "curve_data"), "{error:?}");
}

#[test]
fn a_sensor_that_is_switched_off_keeps_what_it_has_seen() {
    let text = "SENSOR/1, FUNCTION=TIME\\, VALUE=0.25, GE, EVALUATE=3*TIME\n\
        SENSOR/2, FUNCTION=TIME\\, VALUE=0.75, GE, EVALUATE=5*TIME\n\
        VARIABLE/1, FUNCTION=SENVAL(1)+SENVAL(2)\n";
    let mut s = session(text, &["VARVAL(1)"], &[], false);
    let script = "\nsim/dyn, end=0.5, steps=2\ndeactivate/sensor, id=1\nsim/dyn, end=1, steps=2\nactivate/sensor, id=1\n\
        sim/dyn, end=1.5, steps=2\n";
    let script = Script::from_text(script).unwrap();
    obeys(&mut s, &script);
    let seen = s.run.column("VARVAL(1)").unwrap();
    let time = s.run.column("TIME").unwrap();
    let at = |t: f64| seen[time.iter().rposition(|x| (x - t).abs() < 1e-12).unwrap()];
    // the instants are located to rounding
    assert!((at(0.5) - 0.75).abs() < 1e-9, "{}", at(0.5));
    assert!((at(1.0) - 0.75 - 3.75).abs() < 1e-9, "{}", at(1.0));
    // switched on again it holds already, which evaluates anew where the simulation begins
    assert!((at(1.5) - 3.0 - 5.0).abs() < 1e-9, "{}", at(1.5));
}

#[test]
fn a_simulation_up_to_now_is_passed_over() {
    let mut s = session("", &["TIME"], &[], false);
    let script =
        "\nsim/dyn, end=0.5, steps=2\nsim/dyn, end=0.5, steps=2\nsim/dyn, end=1, steps=2\n";
    let script = Script::from_text(script).unwrap();
    obeys(&mut s, &script);
    assert_eq!(s.time(), 1.0);
    assert_eq!(s.run.record.simulations.len(), 2);
    assert!(warns(
        &s,
        &["sim/dyn, end=0.5, steps=2", "nothing to simulate"]
    ));
}

#[test]
fn the_rate_of_an_equation_without_one_is_that_of_its_solution() {
    // y = sin t, z³ + z = y² + DX: differentiated by hand below
    let text = "DIFF/1, IMPLICIT, FUNCTION=DIF(1)-SIN(TIME)\n\
        DIFF/2, IC=0.5, IMPLICIT, FUNCTION=DIF(2)**3+DIF(2)-VARVAL(1)-DX(2,1)\n\
        VARIABLE/1, FUNCTION=DIF(1)**2\n\
        DIFF/3, IC=0.5, FUNCTION=-DIF(3)\nDIFF/4, IMPLICIT, FUNCTION=DIF(4)-DIF(3)\n\
        SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=1\n";
    let columns = ["DIF1(1)", "DIF(2)", "DIF1(2)", "VX(2,1)", "DIF1(4)"];
    let mut s = session(text, &columns, &[], false);
    go(&mut s, 1.3);
    let t: f64 = 1.3;
    assert!((last(&s, "DIF1(1)") - t.cos()).abs() < 1e-12);
    let z = last(&s, "DIF(2)");
    let rate = (2.0 * t.sin() * t.cos() + last(&s, "VX(2,1)")) / (3.0 * z * z + 1.0);
    // the loop is solved to 1e-12 or so, the states to 1e-10
    assert!((last(&s, "DIF1(2)") - rate).abs() < 1e-9);
    assert!((last(&s, "DIF1(4)") + 0.5 * (-t).exp()).abs() < 1e-8);
}

#[test]
fn the_floating_marker_of_a_force_is_where_i_is() {
    let text = "MARKER/31, PART=1, FLOATING\nMARKER/32, PART=1, FLOATING\n\
        VFORCE/1, I=2, JFLOAT=31, RM=1, FX=2\\FY=0\\FZ=0\n\
        GFORCE/2, I=2, JFLOAT=32, RM=1, FX=1\\FY=0\\FZ=0\\TX=0\\TY=0\\TZ=0\n";
    let columns = [
        "DX(31,1)-DX(2,1)",
        "DM(2,31)",
        "AZ(31,2)",
        "VX(32,1)",
        "FX(2,31)",
        "FX(31,2)",
        "FX(2,32)",
    ];
    let mut s = session(text, &columns, &[], false);
    go(&mut s, 1.0);
    let found = columns.map(|c| last(&s, c));
    for (x, expected) in found.iter().zip([0.0, 0.0, 0.0, 3.0, 2.0, -2.0, 1.0]) {
        assert!((x - expected).abs() < 1e-12, "{found:?}");
    }
}

#[test]
fn a_contact_that_is_left_out_is_not_said_to_be_approximate() {
    let poisson = CONTACT.replace(
        "IMPACT, STIFFNESS=1E4, EXPONENT=1, DAMPING=0, DMAX=1E-3",
        "POISSON, PENALTY=1E4, RESTITUTION_COEFFICIENT=0.5",
    );
    let mut s = session(&poisson, &[], &["CONTACT"], false);
    go(&mut s, 1.0);
    assert!(warns(&s, &["CONTACT/5", "left out"]));
    assert!(!warns(&s, &["POISSON"]), "{:?}", s.run.record.warned());
}

#[test]
fn what_takes_part_in_motion_and_is_not_solved_is_refused_or_left_out_in_words() {
    let moving = [
        "FLEX_BODY",
        "FE_PART",
        "UCON",
        "PTSF",
        "CVSF",
        "SFSF",
        "FE_LOAD",
        "MFORCE",
        "TIRE",
        "WHEEL",
    ];
    for &kind in cognate::model::ElementKind::ALL
        .iter()
        .filter(|k| !k.is_solved())
    {
        let (keyword, text) = (kind.keyword(), format!("{kind}/7, IRM=3, JRM=2\n"));
        let plain = &mut session(&text, &["TIME"], &[], false);
        if !moving.contains(&keyword) {
            go(plain, 0.1);
            continue;
        }
        let errors = mistakes(plain, Analysis::Dynamic);
        let told = |d: &&cognate::diagnostic::Diagnostic| {
            d.code == "unsupported" && d.element.as_deref() == Some(&format!("{keyword}/7"))
        };
        assert_eq!(
            errors.iter().filter(told).count(),
            1,
            "{keyword}: {errors:?}"
        );
        let mut s = session(&text, &["TIME"], &[keyword], false);
        go(&mut s, 0.1);
        assert!(
            warns(&s, &[&format!("{keyword}/7"), "left out"]),
            "{keyword}"
        );
    }
}

#[test]
fn friction_that_a_joint_states_itself_is_refused_unless_it_is_off() {
    let joint = |friction: &str| {
        format!(
            "PART/4, MASS=1, CM=4, IP=1,1,1\nMARKER/4, PART=4\nMARKER/5, PART=1\n\
                 JOINT/2, REVOLUTE, I=4, J=5{friction}, MU_DYN_ROT=0.3\n"
        )
    };
    for quiet in ["", ", FRICTION=OFF"] {
        go(&mut session(&joint(quiet), &["TIME"], &[], false), 0.1);
    }
    for friction in ["ON", "PRELOAD_ONLY"] {
        let text = joint(&format!(", FRICTION={friction}"));
        let errors = mistakes(&mut session(&text, &[], &[], false), Analysis::Dynamic);
        assert_eq!(
            (errors[0].code, errors[0].element.as_deref()),
            ("unsupported", Some("JOINT/2"))
        );
        let mut s = session(&text, &["TIME"], &["FRICTION"], false);
        go(&mut s, 0.1);
        assert!(warns(&s, &["JOINT/2", "without the friction"]));
    }
}
