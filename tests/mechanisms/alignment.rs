//! Axes that elements need aligned, laws and kinds that must be said: told by the check, with numbers.

use crate::running;
use cognate::dataset::read_text;
use cognate::diagnostic::{Diagnostic, Severity};
use running::{Analysis, first, go, session};

/// Findings of the check about a dataset of a few statements.
fn found(text: &str) -> Vec<Diagnostic> {
    read_text(&format!("{}{text}END\n", running::GROUND)).diagnostics
}

/// The finding with a code, if there is one.
fn told(text: &str, code: &str) -> Option<Diagnostic> {
    found(text).into_iter().find(|d| d.code == code)
}

/// A part at the origin with a marker that is turned, and a statement about it.
fn turned(reuler: &str, statement: &str) -> String {
    format!(
        "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, REULER={reuler}\n{statement}\n"
    )
}

const CODE: &str = "axes_not_aligned";

#[test]
fn pins_that_do_not_cross_are_told_with_their_angle() {
    for (statement, aligned, parallel, off) in [
        (
            "JOINT/1, UNIVERSAL, I=21, J=1",
            "0,90D,0",
            "0,0,0",
            "0,60D,0",
        ),
        ("JOINT/1, HOOKE, I=21, J=1", "0,0,0", "90D,0,0", "30D,0,0"),
    ] {
        assert_eq!(told(&turned(aligned, statement), CODE), None, "{statement}");
        let mistake = told(&turned(parallel, statement), CODE).expect(statement);
        assert_eq!(mistake.severity, Severity::Error);
        assert!(
            mistake.message.contains("are 0 deg apart"),
            "{}",
            mistake.message
        );
        let doubt = told(&turned(off, statement), CODE).expect(statement);
        assert_eq!(doubt.severity, Severity::Warning);
        assert!(
            doubt.message.contains("are 60 deg apart"),
            "{}",
            doubt.message
        );
    }
}

#[test]
fn torques_and_threads_between_axes_that_are_not_parallel_are_told_with_their_angle() {
    for statement in [
        "SPRINGDAMPER/1, ROTATION, I=21, J=1, KT=8",
        "SFORCE/1, ROTATION, I=21, J=1, FUNCTION=3",
        "JOINT/1, SCREW, I=21, J=1, PITCH=2",
    ] {
        for (reuler, degrees) in [
            ("0,60D,0", "60"),
            ("20D,2.5D,0", "2.5"),
            ("0,180D,0", "180"),
        ] {
            let doubt = told(&turned(reuler, statement), CODE).expect(statement);
            let words = format!("are {degrees} deg apart");
            assert!(doubt.message.contains(&words), "{}", doubt.message);
        }
        for reuler in ["0,0,0", "77D,0,0", "0,0.5D,0"] {
            assert_eq!(
                told(&turned(reuler, statement), CODE),
                None,
                "{statement}, {reuler}"
            );
        }
    }
    let alone = "SFORCE/1, ROTATION, ACTIONONLY, I=21, J=1, FUNCTION=3";
    assert_eq!(told(&turned("0,60D,0", alone), CODE), None);
}

/// A rack that slides along x, a pinion that turns about z, and the markers between them.
fn rack(markers: &str, ends: &str) -> String {
    format!(
        "MARKER/12, PART=1, REULER=90D,90D,0\nMARKER/13, PART=1, QP=0,0.1,0\n\
         PART/2, MASS=2, CM=20, IP=1,1,1\nMARKER/20, PART=2, REULER=90D,90D,0\n\
         PART/3, MASS=3, CM=30, IP=.5,.5,.5, QG=0,0.1,0\nMARKER/30, PART=3\n{markers}\
         JOINT/1, REVOLUTE, I=30, J=13\nJOINT/2, TRANSLATIONAL, I=20, J=12\nJOINT/3, RACKPIN, {ends}, PD=.2\n"
    )
}

#[test]
fn a_rack_along_the_axis_of_its_pinion_or_in_its_place_is_a_mistake() {
    let good = "MARKER/21, PART=2, ZP=1,0,0, XP=0,0,1\nMARKER/31, PART=3\n";
    assert_eq!(told(&rack(good, "I=31, J=21"), CODE), None);
    let exchanged = told(&rack(good, "I=21, J=31"), CODE).expect("told");
    assert_eq!(exchanged.severity, Severity::Error);
    assert!(
        exchanged.message.contains("the rack is given as I"),
        "{}",
        exchanged.message
    );
    let across = good.replace("XP=0,0,1", "XP=0,1,0");
    let across = told(&rack(&across, "I=31, J=21"), CODE).expect("told");
    assert_eq!(across.severity, Severity::Error);
    assert!(
        across
            .message
            .contains("is 90 deg off the axis of the pinion"),
        "{}",
        across.message
    );
}

#[test]
fn a_rack_moves_with_the_rim_of_its_pinion_and_the_other_side_is_told() {
    const SIDE: &str = "pinion_on_other_side";
    // the pinion stands above the rack; y of MARKER/21 points up, or down
    let up = "MARKER/21, PART=2, ZP=-1,0,0, XP=0,0,1\nMARKER/31, PART=3\n";
    let down = "MARKER/21, PART=2, ZP=1,0,0, XP=0,0,1\nMARKER/31, PART=3\n";
    let middle = up.replace("PART=2,", "PART=2, QP=0,0.099,0,");
    let middle = middle.replace("ZP=-1,0,0, XP=0,0,1", "ZP=-1,0.099,0, XP=0,0.099,1");
    let with = |markers: &str, pd: &str| rack(markers, "I=31, J=21").replace("PD=.2", pd);
    for (markers, pd, is_right) in [
        (up, "PD=.2", true),
        (up, "PD=-.2", false),
        (down, "PD=-.2", true),
        (down, "PD=.2", false),
        // a marker of the rack at the height of the axis says nothing of the side
        (middle.as_str(), "PD=-.2", true),
    ] {
        let model = with(markers, pd);
        let found = told(&model, SIDE);
        assert_eq!(found.is_none(), is_right, "{markers} {pd}: {found:?}");
        if let Some(found) = found {
            assert_eq!(found.severity, Severity::Warning);
            let other = if pd == "PD=.2" { "PD=-0.2" } else { "PD=0.2" };
            assert!(found.help[0].contains(other), "{:?}", found.help);
        }
    }
}

#[test]
fn the_pitch_point_of_a_gear_has_its_line_along_the_motion_there() {
    let gear = |line: &str| {
        format!(
            "MARKER/12, PART=1, QP=4,0,0\nMARKER/13, PART=1, QP=1,0,0, REULER={line}\n\
             PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\n\
             PART/3, MASS=1, CM=30, IP=1,1,1, QG=4,0,0\nMARKER/30, PART=3\n\
             JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, REVOLUTE, I=30, J=12\nGEAR/1, JOINTS=1,2, CV=13\n"
        )
    };
    assert_eq!(told(&gear("0,90D,0"), CODE), None);
    assert_eq!(told(&gear("0,-90D,0"), CODE), None);
    let off = told(&gear("0,70D,0"), CODE).expect("told");
    assert!(
        off.message.contains("is 20 deg off the way"),
        "{}",
        off.message
    );
}

#[test]
fn a_contact_says_how_its_force_grows() {
    let contact = |law: &str| {
        turned(
            "0,0,0",
            &format!(
                "GRAPHICS/1, ELLIPSOID, CM=20, XSCALE=.2, YSCALE=.2, ZSCALE=.2\n\
                 GRAPHICS/2, PLANE, RM=1, XMIN=-1, XMAX=1, YMIN=-1, YMAX=1\nCONTACT/1, IGEOM=1, JGEOM=2, IMPACT, {law}"
            ),
        )
    };
    let whole = "STIFFNESS=1E5, DAMPING=10, DMAX=0.001, EXPONENT=1.5";
    assert!(
        found(&contact(whole))
            .iter()
            .all(|d| d.severity != Severity::Error)
    );
    assert_eq!(
        told(&contact("STIFFNESS=1E5, EXPONENT=1.5"), "missing_argument"),
        None
    );
    for (law, argument) in [
        ("STIFFNESS=1E5, DAMPING=10, DMAX=0.001", "EXPONENT"),
        ("STIFFNESS=1E5, DAMPING=10, EXPONENT=1.5", "DMAX"),
        ("DAMPING=10, DMAX=0.001, EXPONENT=1.5", "STIFFNESS"),
    ] {
        let mistake = told(&contact(law), "missing_argument").expect(argument);
        assert!(mistake.message.contains(argument), "{}", mistake.message);
        assert!(
            mistake.help.iter().any(|h| h.contains(argument)),
            "{:?}",
            mistake.help
        );
    }
}

#[test]
fn a_curve_says_what_its_points_are_and_closes_within_rounding() {
    let curve = |kind: &str, last: &str| {
        format!(
            "MATRIX/1, FULL=RORDER, ROWS=5, COLUMNS=3, VALUES=1,0,0, 0,1,0, -1,0,0, 0,-1,0, {last}\n\
             CURVE/1, CLOSED, MATRIX=1{kind}\n"
        )
    };
    assert_eq!(found(&curve(", CURVE_POINTS", "1,0,0")), []);
    assert_eq!(found(&curve(", CONTROL_POINTS", "1,0,0")), []);
    assert_eq!(found(&curve(", CURVE_POINTS", "1,1E-15,0")), []);
    let said = told(&curve("", "1,0,0"), "control_points").expect("told");
    assert_eq!(said.severity, Severity::Warning);
    let open = told(&curve(", CURVE_POINTS", "1,0.001,0"), "open_ends").expect("told");
    assert_eq!(open.severity, Severity::Error);
    assert!(open.message.contains("0.001"), "{}", open.message);
}

#[test]
fn an_action_only_force_has_no_reaction() {
    let text = turned(
        "0,0,0",
        "SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=1, FUNCTION=7",
    );
    let columns = ["SFORCE(1,0,4,0)", "SFORCE(1,1,4,0)", "SFORCE(1,1,1,0)"];
    let mut s = session(&text, &columns, 1e-6);
    go(&mut s, Analysis::Dynamic, 0.1, 1);
    assert_eq!(columns.map(|c| first(&s, c)), [7.0, 0.0, 0.0]);
}

#[test]
fn a_contact_in_a_kinematic_run_is_told() {
    let text = turned(
        "0,0,0",
        "GRAPHICS/1, ELLIPSOID, CM=20, XSCALE=.2, YSCALE=.2, ZSCALE=.2\n\
         GRAPHICS/2, PLANE, RM=1, XMIN=-1, XMAX=1, YMIN=-1, YMAX=1\n\
         CONTACT/1, IGEOM=1, JGEOM=2, IMPACT, STIFFNESS=1E5, DAMPING=10, DMAX=0.001, EXPONENT=1.5\n\
         JOINT/1, TRANSLATIONAL, I=20, J=1\nMOTION/1, JOINT=1, TRANSLATION, FUNCTION=1-TIME",
    );
    for analysis in [Analysis::Kinematic, Analysis::Dynamic] {
        let mut s = session(&text, &[], 1e-6);
        go(&mut s, analysis, 1.0, 2);
        let warned = s.run.record.warned();
        let told = warned
            .iter()
            .filter(|w| w.starts_with("CONTACT/1: in a kinematic run"));
        assert_eq!(told.count(), 1, "{warned:?}");
    }
}
