//! Leaps between simulations: commands that put parts elsewhere or strike them are told, and no others.

use crate::running;

use cognate::dataset::command::Script;
use running::{begin, last, obeys, options, whole};

/// A slider along x that moves at 1, and a rotor that turns at 4 about z beside another one at rest.
const MOVING: &str = "TEST\nUNITS/SYSTEM=MKS\nPART/1, GROUND\nMARKER/1, PART=1\nMARKER/5, PART=1, REULER=90D,90D,0\n\
    PART/2, MASS=2, CM=20, IP=1,1,1, VX=1\nMARKER/20, PART=2, REULER=90D,90D,0\nMARKER/21, PART=2\n\
    JOINT/2, TRANSLATIONAL, I=20, J=5\nJPRIM/2, INPLANE, I=21, J=6\nMARKER/6, PART=1, QP=0.25,0,0, REULER=90D,90D,0\n\
    PART/3, MASS=1, CM=30, IP=1,1,2, QG=5,0,0, WZ=4\nMARKER/30, PART=3\nMARKER/7, PART=1, QP=5,0,0\n\
    JOINT/3, REVOLUTE, I=30, J=7\n\
    PART/4, MASS=1, CM=40, IP=1,1,2, QG=8,0,0\nMARKER/40, PART=4\nMARKER/8, PART=1, QP=8,0,0\n\
    JOINT/4, REVOLUTE, I=40, J=8\n\
    COUPLER/1, JOINTS=3,4, SCALES=1,-1\n\
    SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=5, FUNCTION=VARVAL(1)\nVARIABLE/1, FUNCTION=0\n\
    MOTION/2, JOINT=2, TRANSLATION, VELOCITY, FUNCTION=5\n\
    MOTION/3, JOINT=3, ROTATION, VELOCITY, FUNCTION=4\n\
    MOTION/4, JOINT=4, ROTATION, FUNCTION=2\n\
    END\n";

/// Everything that would hold the slider and the rotors is off at first.
const OFF: &str = "DEACTIVATE/JPRIM, ID=2\nDEACTIVATE/COUPLER, ID=1\nDEACTIVATE/MOTION, ID=2,3,4\n";

/// Obeys commands between two simulations of 2 s each; returns where the slider and the first rotor come to, and the
/// leaps that are told.
fn after(commands: &str) -> ([f64; 2], Vec<String>) {
    let columns = ["DX(20,1)", "AZ(30,7)"];
    let mut s = begin(whole(MOVING), "leaps", options(&columns, 1e-8));
    let text = format!(
        "leaps\nleaps\n{OFF}SIMULATE/DYNAMIC, END=2, STEPS=2\n{commands}SIMULATE/DYNAMIC, END=4, STEPS=2\nSTOP\n"
    );
    obeys(&mut s, &Script::from_text(&text).expect("commands"));
    let told = s.run.record.warned().into_iter();
    let leaps = told.filter(|w| w.contains("between two simulations"));
    (columns.map(|c| last(&s, c)), leaps.collect())
}

#[test]
fn constraints_that_hold_where_parts_are_not_are_told_with_the_leap() {
    for (commands, said) in [
        // the slider is at 2, the plane at 0.25
        ("ACTIVATE/JPRIM, ID=2\n", "moved by 1.75 meter"),
        // the rotor is at rest and at zero
        ("ACTIVATE/MOTION, ID=4\n", "turned by 114.6 deg"),
        ("ACTIVATE/MOTION, ID=2\n", "jumps by 4 meter"),
        // the two rotors share their momentum
        ("ACTIVATE/COUPLER, ID=1\n", "jumps by 2 rad"),
    ] {
        let (_, told) = after(commands);
        assert!(
            told.len() == 1 && told[0].contains(said),
            "{commands}: {told:?}"
        );
    }
}

#[test]
fn commands_that_leave_parts_where_they_are_are_not_told_as_leaps() {
    for (commands, slider, rotor) in [
        ("", 4.0, 16.0),
        ("VARIABLE/1, FUNCTION=2\n", 6.0, 16.0),
        ("DEACTIVATE/SFORCE, ID=1\n", 4.0, 16.0),
        ("ACCGRAV/JGRAV=-9.81\n", 4.0, 16.0),
        ("SAVE/SYSTEM=leaps\nRELOAD/SYSTEM=leaps\n", 4.0, 16.0),
        // a velocity that is prescribed goes on from where the rotor is, turns and all
        ("ACTIVATE/MOTION, ID=3\n", 4.0, 16.0),
        ("PART/2, MASS=7\n", 4.0, 16.0),
    ] {
        let ([x, angle], told) = after(commands);
        assert_eq!(told, Vec::<String>::new(), "{commands}");
        assert!(
            (x - slider).abs() < 1e-6 && (angle - rotor).abs() < 1e-6,
            "{commands}: {x} {angle}"
        );
    }
}

#[test]
fn prescribed_velocities_go_on_from_where_their_joints_are() {
    // a velocity of 5 for 1 is a blow, but the slider goes on from 2
    let ([x, _], _) = after("ACTIVATE/MOTION, ID=2\n");
    assert!((x - 12.0).abs() < 1e-8, "{x}");
    // and an acceleration from the velocity that is there
    let ([x, _], told) = after("MOTION/2, ACCELERATION, FUNCTION=3\nACTIVATE/MOTION, ID=2\n");
    assert!((x - (2.0 + 2.0 + 6.0)).abs() < 1e-8, "{x}");
    assert_eq!(told, Vec::<String>::new());
}
