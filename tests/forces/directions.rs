//! Directions and signs of forces and torques: which way they push, and that the way turns with its marker.

use crate::running;
use running::{Analysis, go, off, session};

/// Two free bodies on the x axis, a metre apart.
const TWO: &str = "PART/2, MASS=1, CM=20, IP=1,1,2, QG=1,0,0\nMARKER/20, PART=2\n\
    PART/3, MASS=3, CM=30, IP=1,1,1\nMARKER/30, PART=3\n";

#[test]
fn a_positive_force_repels_along_the_line_and_a_negative_one_attracts() {
    for force in [6.0, -1.5] {
        let text = format!("{TWO}SFORCE/1, TRANSLATION, I=20, J=30, FUNCTION={force}\n");
        let columns = ["VX(20,1)", "VX(30,1)", "VY(20,1)"];
        let mut s = session(&text, &columns, 1e-9);
        go(&mut s, Analysis::Dynamic, 0.5, 10);
        let exact: [f64; 3] = [force, -force / 3.0, 0.0];
        for (column, slope) in columns.iter().zip(exact) {
            assert!(off(&s, column, |t| slope * t) < 1e-9, "{force}: {column}");
        }
    }
}

/// Whether a force along the line between two bodies, `apart` from each other, is said to feed energy; a third body makes
/// the mechanism long beside that.
fn is_said_to_feed(function: &str, apart: f64) -> bool {
    let text = format!(
        "PART/2, MASS=1, CM=20, IP=1,1,2, QG={apart:?},0,0\nMARKER/20, PART=2\n\
         PART/3, MASS=3, CM=30, IP=1,1,1\nMARKER/30, PART=3\n\
         PART/4, MASS=1, CM=40, IP=1,1,1, QG=3,0,0\nMARKER/40, PART=4\n\
         SFORCE/1, TRANSLATION, I=20, J=30, FUNCTION={function}\n"
    );
    let mut s = session(&text, &["VX(20,1)"], 1e-6);
    go(&mut s, Analysis::Dynamic, 1e-3, 1);
    let warnings = &s.run.record.warnings;
    warnings.iter().any(|w| w.code == "negative_damping")
}

#[test]
fn a_contact_along_a_line_is_no_damper_that_feeds_energy_however_near_its_bodies_are() {
    for apart in [0.21, 0.4, 0.7, 0.75, 0.8, 0.85, 1.0, 3.0] {
        let contact =
            |damping: f64| format!("IMPACT(DM(20,30),VR(20,30),0.2,1E5,1.5,{damping:?},1E-3)");
        assert!(!is_said_to_feed(&contact(20.0), apart), "{apart}");
        let feeds = format!("{}+2*VR(20,30)", contact(0.0));
        assert!(is_said_to_feed(&feeds, apart), "{apart}");
    }
}

#[test]
fn a_force_on_a_body_alone_follows_the_z_axis_of_its_turning_marker() {
    // z of MARKER/31 is along x of its part, which turns about z of ground
    let text = format!(
        "{TWO}MARKER/31, PART=3, REULER=90D,90D,0\nJOINT/1, REVOLUTE, I=30, J=1\n\
         MOTION/1, JOINT=1, ROTATION, FUNCTION=2*TIME\n\
         SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=31, FUNCTION=3\n"
    );
    let mut s = session(&text, &["VX(20,1)", "VY(20,1)"], 1e-9);
    go(&mut s, Analysis::Dynamic, 2.0, 40);
    assert!(off(&s, "VX(20,1)", |t| 1.5 * (2.0 * t).sin()) < 1e-7);
    assert!(off(&s, "VY(20,1)", |t| 1.5 * (1.0 - (2.0 * t).cos())) < 1e-7);
}

#[test]
fn a_positive_torque_turns_by_the_right_hand_rule_about_z_of_its_marker() {
    for (reuler, axis) in [("0,0,0", "WZ(20,1)"), ("90D,90D,0", "WX(20,1)")] {
        let text = format!(
            "PART/2, MASS=1, CM=20, IP=2,2,2\nMARKER/20, PART=2\nMARKER/9, PART=1, REULER={reuler}\n\
             SFORCE/1, ROTATION, I=20, J=9, FUNCTION=4\n"
        );
        let mut s = session(&text, &[axis], 1e-9);
        go(&mut s, Analysis::Dynamic, 0.5, 10);
        assert!(off(&s, axis, |t| 2.0 * t) < 1e-9, "{axis}");
    }
}
