//! Parts without mass or inertia: where they are told, and where they do no harm.

use crate::running;

use cognate::analysis::verify::verify;
use cognate::diagnostic::Diagnostic;
use cognate::model::Model;
use running::{Analysis, Session, begin, go, last, mistakes, options, values, whole};

fn model(text: &str) -> Model {
    whole(&format!(
        "TEST\nPART/1, GROUND\nMARKER/10, PART=1\n{text}END\n"
    ))
}

fn session(text: &str, columns: &[&str]) -> Session {
    begin(model(text), "test", options(columns, 1e-9))
}

fn run(text: &str, columns: &[&str], end: f64) -> Session {
    let mut s = session(text, columns);
    go(&mut s, Analysis::Dynamic, end, 20);
    s
}

/// What is said instead of a simulation: one error.
fn refused(text: &str) -> Diagnostic {
    let said = mistakes(&mut session(text, &[]), Analysis::Dynamic);
    assert_eq!(said.len(), 1, "{said:?}");
    let found = verify(&model(text)).unwrap_or_else(|e| panic!("{e:?}"));
    let element = said[0].element.as_deref().unwrap();
    assert!(
        found.warned().iter().any(|w| w.contains(element)),
        "verify says it too: {:?}",
        found.warned()
    );
    said[0].clone()
}

const HINGE: &str = "JOINT/1, REVOLUTE, I=20, J=10\nACCGRAV/JGRAV=-9.81\n";

#[test]
fn a_pendulum_without_mass_is_refused_before_the_first_step() {
    let d = refused(&format!("PART/2\nMARKER/20, PART=2\n{HINGE}"));
    assert_eq!((d.code, d.element.as_deref()), ("no_mass", Some("PART/2")));
    assert!(d.message.contains("MASS or inertia"), "{}", d.message);
    assert!(d.message.contains("turns about"), "{}", d.message);
    assert!(d.help[0].contains("IP"));
}

#[test]
fn a_mass_on_the_axis_of_its_hinge_lacks_inertia() {
    let d = refused(&format!(
        "PART/2, MASS=2, CM=20, QG=3,4,5, REULER=0.3,0.4,0.5\nMARKER/20, PART=2\nMARKER/11, PART=1, QP=3,4,5, REULER=0.3,0.4,0.5\n{}",
        HINGE.replace("J=10", "J=11")
    ));
    assert_eq!(d.element.as_deref(), Some("PART/2"));
    assert!(d.message.contains("no inertia (IP)"), "{}", d.message);
}

/// A spring holds a mass that has no inertia: at rest that does not matter, and then it begins to move.
#[test]
fn what_lacks_inertia_is_named_after_statics_and_where_a_joint_is_switched_off() {
    let text = "PART/2, QG=0,0,-1, MASS=1, CM=20\nMARKER/20, PART=2\n\
                SPRINGDAMPER/1, TRANSLATIONAL, I=20, J=10, K=100, LENGTH=1\nACCGRAV/KGRAV=-9.81\n";
    let mut s = session(text, &["DZ(20,10)"]);
    running::rest(&mut s);
    let said = mistakes(&mut s, Analysis::Dynamic);
    assert!(said.iter().all(|d| d.code == "no_mass"), "{said:?}");
    let held = format!("{text}MARKER/21, PART=2\nJOINT/1, TRANSLATIONAL, I=21, J=10\n");
    let mut s = session(&held, &[]);
    go(&mut s, Analysis::Dynamic, 0.1, 1);
    s.model
        .inactive
        .insert(cognate::model::ElementKind::Joint.id(1));
    let said = mistakes(&mut s, Analysis::Dynamic);
    assert!(said.iter().all(|d| d.code == "no_mass"), "{said:?}");
}

#[test]
fn arms_without_mass_stretched_towards_a_ball_are_refused() {
    // two arms in line with the point mass at their end: turning them against each other moves nothing
    let d = refused(&format!(
        "PART/2\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=1,0,0\nPART/3, QG=1,0,0, MASS=1, CM=31\nMARKER/30, PART=3\nMARKER/31, PART=3, QP=0,0,0\n\
         JOINT/2, REVOLUTE, I=30, J=21\n{HINGE}"
    ));
    assert_eq!(d.code, "no_mass");
}

#[test]
fn an_arm_without_mass_that_carries_a_mass_swings_like_any_pendulum() {
    let s = run(
        &format!(
            "PART/2\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=1,0,0\nPART/3, QG=1,0,0, MASS=2, CM=30\nMARKER/30, PART=3\n\
             JOINT/2, FIXED, I=30, J=21\n{HINGE}"
        ),
        &["VM(30,10)**2/2+9.81*DY(30,10)"],
        2.0,
    );
    for e in values(&s, "VM(30,10)**2/2+9.81*DY(30,10)") {
        // the run asks for 1e-9 of energies of some ten
        assert!(e.abs() < 1e-6, "{e}");
    }
}

/// A four-bar that falls; its coupler has this mass and inertia.
fn four_bar(coupler: &str) -> String {
    format!(
        "PART/2, MASS=1, CM=22, IP=0.1,0.1,0.1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=0,1,0\nMARKER/22, PART=2, QP=0,0.5,0\n\
         PART/3, QG=0,1,0{coupler}\nMARKER/30, PART=3\nMARKER/31, PART=3, QP=3,1,0\n\
         PART/4, QG=3,0,0, MASS=1, CM=42, IP=0.1,0.1,0.1\nMARKER/40, PART=4\nMARKER/41, PART=4, QP=0,2,0\nMARKER/42, PART=4, QP=0,1,0\n\
         MARKER/11, PART=1, QP=3,0,0\n\
         JOINT/1, REVOLUTE, I=20, J=10\nJOINT/2, REVOLUTE, I=30, J=21\nJOINT/3, REVOLUTE, I=31, J=41\nJOINT/4, REVOLUTE, I=40, J=11\n\
         ACCGRAV/IGRAV=3, JGRAV=-9.81\n"
    )
}

const ANGLE: &str = "AZ(20,10)";

#[test]
fn a_coupler_without_mass_is_the_limit_of_lighter_and_lighter_ones() {
    let end = |text: &str| {
        let s = run(text, &[ANGLE, "JOINT(3,0,2,0)", "JOINT(3,0,3,0)"], 0.8);
        let last = |c: &str| last(&s, c);
        [last(ANGLE), last("JOINT(3,0,2,0)"), last("JOINT(3,0,3,0)")]
    };
    let none = end(&four_bar(""));
    let light = |m: f64| {
        end(&four_bar(&format!(
            ", MASS={m:e}, CM=30, IP={m:e},{m:e},{m:e}"
        )))
    };
    let (light, lighter) = (light(1e-4), light(1e-6));
    for k in 0..3 {
        let (far, near) = ((light[k] - none[k]).abs(), (lighter[k] - none[k]).abs());
        // the difference is linear in the mass; what is left is the error that was asked for
        assert!(near < 0.02 * far + 1e-6, "{k}: {far:e} {near:e}");
    }
}

const ENERGY: &str = "VM(22,10)**2/2+0.05*WZ(20,10)**2+VM(42,10)**2/2+0.05*WZ(40,10)**2-3*(DX(22)+DX(42))+9.81*(DY(22)+DY(42))";

#[test]
fn a_coupler_without_mass_pulls_along_its_length_only() {
    let s = run(
        &four_bar(""),
        &["JOINT(3,0,2,0)*DY(31,30)-JOINT(3,0,3,0)*DX(31,30)", ENERGY],
        0.8,
    );
    for x in values(&s, "JOINT(3,0,2,0)*DY(31,30)-JOINT(3,0,3,0)*DX(31,30)") {
        assert!(x.abs() < 1e-8, "{x}");
    }
    let energy = values(&s, ENERGY);
    for e in energy {
        assert!((e - energy[0]).abs() < 1e-6, "{e} {}", energy[0]);
    }
}
