//! What is said where a simulation cannot begin or go on, or a column loses its value: the element, the operation, the command.

use crate::running;

use cognate::analysis::watch::Unwatched;
use cognate::dataset::{self, command::Script};
use cognate::diagnostic::Diagnostic;
use cognate::model::IntegratorSettings;
use cognate::results::Status;
use running::{
    Analysis, begin, go, mistakes, mistakes_of, model, options, refused, session, try_to,
};

const HINGE: &str = "PART/2, MASS=2, CM=2, IP=0.3,0.3,0.5\nMARKER/2, PART=2\nMARKER/3, PART=1\nJOINT/1, REVOLUTE, I=2, J=3\n";

#[test]
fn a_function_that_loses_its_value_is_named_with_its_operation() {
    for (function, said) in [
        ("SQRT(0.5-TIME)", "SQRT of -"),
        ("SQRT(0.3+AZ(2,3))-2", "SQRT of -"),
        ("ACOS(1.2*COS(TIME))", "ACOS of 1.2"),
    ] {
        let text = format!(
            "{HINGE}SFORCE/7, ROTATION, I=2, J=3, FUNCTION=0.5\nVARIABLE/9, FUNCTION={function}\nSFORCE/8, ROTATION, I=2, J=3, FUNCTION=VARVAL(9)\n"
        );
        for method in ["DOP853", "RADAU5"] {
            let mut s = session(&text, &[], 1e-6);
            s.model.integrator.method = Some(method.into());
            let status = try_to(&mut s, Analysis::Dynamic, 3.0, 3);
            let record = &s.run.record;
            assert_ne!(status, Status::Completed);
            assert!(
                record.stop_reason.contains(said) && record.stop_reason.contains("VARIABLE/9"),
                "{method}: {}",
                record.stop_reason
            );
            assert!(record.stop_reason.contains("stopped at time"));
        }
    }
}

#[test]
fn an_operand_without_value_stops_a_run_although_its_operation_would_lose_it() {
    for function in [
        "MIN(5,1/TIME)",
        "ATAN2(1/TIME,1/TIME)",
        "1/(1/TIME)",
        "SQRT(TIME-5)**0",
        "POLY(LOG(TIME-5),0,7)",
        "0/TIME",
        "TIME/TIME",
        "0*(1/TIME)",
        "1/TIME-1/TIME",
        "0/AZ(2,3)",
        "MIN(5,1/AZ(2,3))",
    ] {
        let text = format!("{HINGE}SFORCE/7, ROTATION, I=2, J=3, FUNCTION={function}\n");
        for method in ["AUTO", "DOP853", "RADAU5"] {
            let mut s = session(&text, &[], 1e-6);
            s.model.integrator.method = Some(method.into());
            let outcome = s.simulate(Analysis::Dynamic, 1.0, 3, &mut Unwatched);
            let said = match &outcome {
                Ok(_) => s.run.record.stop_reason.clone(),
                Err(errors) => (errors.diagnostics().iter())
                    .map(ToString::to_string)
                    .collect(),
            };
            assert!(
                !matches!(outcome, Ok(Status::Completed)) && said.contains("SFORCE/7"),
                "{function}, {method}: {said}"
            );
        }
    }
    // a side that is not taken may be without value
    let function = "IF(TIME+1: 1/(1/(TIME-TIME)), 0, MIN(5,2+TIME))";
    let text = format!("{HINGE}SFORCE/7, ROTATION, I=2, J=3, FUNCTION={function}\n");
    let mut s = session(&text, &[], 1e-6);
    go(&mut s, Analysis::Dynamic, 1.0, 3);
}

#[test]
fn a_column_that_loses_its_value_is_told_once_with_its_time() {
    let text = format!("{HINGE}REQUEST/1, F2=LOG(0.5-TIME)\\F3=TIME\n");
    let mut s = session(&text, &["SQRT(0.7-TIME)"], 1e-6);
    go(&mut s, Analysis::Dynamic, 1.0, 4);
    go(&mut s, Analysis::Dynamic, 2.0, 4);
    let told = |name: &str| -> Vec<String> {
        let all = s.run.record.warned().into_iter();
        all.filter(|w| w.starts_with(name) && w.contains("no finite value"))
            .collect()
    };
    assert_eq!(
        told("REQUEST_1.F2"),
        ["REQUEST_1.F2 has no finite value at time 0.5"]
    );
    assert_eq!(told("SQRT").len(), 1);
    assert_eq!(told("REQUEST_1.F3").len(), 0);
}

#[test]
fn settings_that_no_integration_can_keep_are_refused() {
    // as a program may set them: a dataset with such a number is refused when it is read
    type Set = fn(&mut IntegratorSettings);
    let all: [(Set, &str); 7] = [
        (|i| i.error = Some(0.0), "ERROR"),
        (|i| i.error = Some(-1e-3), "ERROR"),
        (|i| i.hmax = Some(0.0), "HMAX"),
        (|i| i.hinit = Some(-1.0), "HINIT"),
        (|i| i.kmax = Some(0), "KMAX"),
        (|i| i.maxit = Some(0), "MAXIT"),
        (|i| (i.hmin, i.hmax) = (Some(1.0), Some(0.1)), "HMIN"),
    ];
    for (set, name) in all {
        let mut model = model(HINGE);
        set(&mut model.integrator);
        let mut s = begin(model, "test", options(&[], 1e-6));
        let d = mistakes(&mut s, Analysis::Dynamic).remove(0);
        assert_eq!(
            (d.code, d.element.as_deref()),
            ("unfit_value", Some("INTEGRATOR"))
        );
        assert!(d.message.contains(name), "{}", d.message);
    }
    for error in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut s = session(HINGE, &[], error);
        let d = mistakes(&mut s, Analysis::Dynamic);
        assert_eq!(d[0].element.as_deref(), Some("--error"), "{error}");
    }
}

#[test]
fn a_contact_without_stiffness_is_refused() {
    let text = |law: &str| {
        format!(
            "PART/2, MASS=2, CM=2, IP=0.3,0.3,0.5, QG=0,0,1\nMARKER/2, PART=2\nGRAPHICS/1, PLANE, RM=1\n\
             GRAPHICS/2, ELLIPSOID, CM=2, XSCALE=1, YSCALE=1, ZSCALE=1\nCONTACT/1, IGEOM=2, JGEOM=1, {law}\n"
        )
    };
    // what the statement itself lacks is found when it is read
    let dataset = format!(
        "title\nPART/1, GROUND\nMARKER/1, PART=1\n{}END\n",
        text("IMPACT")
    );
    let read = dataset::read_text(&dataset).diagnostics;
    let lacks = |d: &Diagnostic| d.message.contains("STIFFNESS");
    let d = read.iter().find(|d| lacks(d)).unwrap();
    assert_eq!(d.element.as_deref(), Some("CONTACT/1"));
    let d = refused(
        &text("POISSON, RESTITUTION_COEFFICIENT=0.5"),
        Analysis::Dynamic,
    );
    assert_eq!(d.element.as_deref(), Some("CONTACT/1"));
    assert!(d.message.contains("PENALTY"), "{}", d.message);
}

/// What is said of a command, after one that is right.
fn command(wrong: &str) -> Diagnostic {
    let mut s = session(HINGE, &[], 1e-6);
    let script = Script::from_text(&format!("\nSIM/DYN, END=1, STEPS=2\n{wrong}\n")).unwrap();
    mistakes_of(&mut s, &script).remove(0)
}

#[test]
fn what_is_wrong_with_a_command_has_its_line() {
    for (wrong, code) in [
        ("DEACTIVATE/JOINT, ID=7", "unknown_element"),
        ("VARIABLE/9, FUNCTION=3", "unknown_element"),
        ("SIM/DYN, END=0.5, STEPS=2", "no_end"),
        ("RELOAD/SYSTEM=nowhere", "cannot_open"),
    ] {
        let d = command(wrong);
        assert_eq!((d.code, d.line), (code, 3), "{wrong}: {d}");
    }
}

#[test]
fn a_spring_between_markers_that_coincide_is_named() {
    let spring = |rest: &str| {
        format!(
            "PART/2, MASS=2, CM=2, IP=0.3,0.3,0.5\nMARKER/2, PART=2\nMARKER/3, PART=1\nACCGRAV/KGRAV=-9.81\n{rest}"
        )
    };
    // zero there whatever its direction: it hangs itself up
    for soft in [
        "SPRINGDAMPER/7, TRANSLATION, I=2, J=3, K=100, C=1\n",
        "SFORCE/7, TRANSLATION, I=2, J=3, FUNCTION=-100*DM(2,3)\n",
    ] {
        let mut s = session(&spring(soft), &["DZ(2)"], 1e-6);
        go(&mut s, Analysis::Dynamic, 0.1, 4);
        let told = &s.run.record.warned();
        assert!(
            told.iter()
                .any(|w| w.contains("/7: its markers MARKER/2 and MARKER/3 coincide")),
            "{told:?}"
        );
        assert!(*s.run.column("DZ(2)").unwrap().last().unwrap() < -0.02);
    }
    for pushing in [
        "SPRINGDAMPER/7, TRANSLATION, I=2, J=3, K=100, LENGTH=0.5\n",
        "SPRINGDAMPER/7, TRANSLATION, I=2, J=3, FORCE=3\n",
        "SFORCE/7, TRANSLATION, I=2, J=3, FUNCTION=3\n",
    ] {
        for analysis in [Analysis::Dynamic, Analysis::Static] {
            let said = refused(&spring(pushing), analysis);
            assert_eq!(said.code, "coincident");
            assert!(said.to_string().contains("/7"), "{said}");
        }
    }
    // what turns, or acts along an axis, needs no line; what is apart has one
    for fine in [
        "SPRINGDAMPER/7, ROTATION, I=2, J=3, KT=100, ANGLE=0.5\n",
        "SFORCE/7, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=3\n",
        "MARKER/4, PART=1, QP=0,0,1E-3\nSPRINGDAMPER/7, TRANSLATION, I=2, J=4, K=1, LENGTH=0.5\n",
    ] {
        let mut s = session(&spring(fine), &[], 1e-6);
        go(&mut s, Analysis::Dynamic, 0.01, 1);
        let told = &s.run.record.warned();
        assert!(!told.iter().any(|w| w.contains("coincide")), "{told:?}");
    }
}
