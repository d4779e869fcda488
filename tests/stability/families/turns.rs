//! Angles beyond a turn.

use crate::laws::rotor;
use crate::scene::{Scene, scene};
use std::f64::consts::PI;

/// The scenes of this family.
pub fn turns() -> Vec<Scene> {
    let f = "turns";
    let mut all = Vec::new();
    for steps in [1, 3, 100] {
        for speed in [1.0, 20.0, 300.0] {
            all.push(
                scene(
                    f,
                    format!("coasting at {speed} rad/s, {steps} outputs"),
                    rotor(1.0, speed),
                )
                .end(10.0)
                .steps(steps)
                .follows("AZ(20,1)", move |t| speed * t, 1e-5 * speed),
            );
        }
        all.push(
            scene(
                f,
                format!("speeding up, {steps} outputs"),
                rotor(1.0, 0.0) + "SFORCE/1, ROTATION, I=20, J=1, FUNCTION=30\n",
            )
            .end(10.0)
            .steps(steps)
            .follows("AZ(20,1)", |t| 15.0 * t * t, 1e-3),
        );
        // a spring that is wound up: θ'' = −k(θ − θ₀)
        all.push(
            scene(
                f,
                format!("wound up by a torque, {steps} outputs"),
                rotor(1.0, 100.0) + "SPRINGDAMPER/1, ROTATION, I=20, J=1, KT=1\n",
            )
            .end(10.0)
            .steps(steps)
            .follows("AZ(20,1)", |t| 100.0 * t.sin(), 1e-4),
        );
    }
    all.push(
        scene(f, "coasting at 50 rad/s", rotor(1.0, 50.0))
            .method("RADAU5")
            .end(10.0)
            .steps(2)
            .follows("AZ(20,1)", |t| 50.0 * t, 1e-2),
    );
    // an IF that reads turns: the torque is switched off after ten turns
    all.push(
        scene(
            f,
            "a torque ends after ten turns",
            rotor(1.0, 0.0)
                + "SFORCE/1, ROTATION, I=20, J=1, FUNCTION=IF(AZ(20,1)-20*PI: 10, 0, 0)\n",
        )
        .end(8.0)
        .steps(4)
        .follows("WZ(20,1)", |t| 10.0 * t.min((4.0 * PI).sqrt()), 1e-4),
    );
    driven(&mut all);
    for_a_day(&mut all);
    elsewhere(&mut all);
    all.push(
        scene(
            f,
            "a driven rotor without freedom",
            rotor(1.0, 0.0) + "MOTION/1, JOINT=1, ROTATION, FUNCTION=4*TIME\n",
        )
        .follows("AZ(20,1)", |t| 4.0 * t, 1e-9)
        .tells("moved by its motions alone"),
    );
    all
}

/// A rotor driven at 40 rad/s by each level of MOTION, between joints and between markers; outputs
/// are few and many.
fn driven(all: &mut Vec<Scene>) {
    let f = "turns";
    let motions = [
        (
            "displacement",
            "MOTION/1, JOINT=1, ROTATION, FUNCTION=40*TIME\n",
        ),
        (
            "velocity",
            "MOTION/1, JOINT=1, ROTATION, VELOCITY, FUNCTION=40\n",
        ),
        (
            "acceleration",
            "MOTION/1, JOINT=1, ROTATION, ACCELERATION, ICVEL=40, FUNCTION=0\n",
        ),
        ("markers", "MOTION/1, I=20, J=1, B3, FUNCTION=40*TIME\n"),
    ];
    let read = "SPRINGDAMPER/1, ROTATION, I=21, J=1, KT=3\n\
                REQUEST/1, F2=AZ(20,1)\n";
    for (level, motion) in motions {
        for steps in [1, 10, 333] {
            all.push(
                scene(
                    f,
                    format!("driven by {level} at 40 rad/s, {steps} outputs"),
                    rotor(1.0, 0.0) + motion + read,
                )
                .steps(steps)
                .follows("AZ(20,1)", |t| 40.0 * t, 1e-5)
                .follows("SPDP(1,0,8,0)", |t| -120.0 * t, 1e-4),
            );
        }
    }
    // a sensor, and a force that an IF switches on after 100 rad, while the drive goes on
    let slider = "PART/3, MASS=1, CM=30, IP=1,1,1\n\
                  MARKER/30, PART=3\n\
                  JOINT/2, TRANSLATIONAL, I=30, J=1\n\
                  SFORCE/2, TRANSLATIONAL, ACTIONONLY, I=30, J=1, FUNCTION=IF(AZ(20,1)-100:0,0,1)\n";
    let since = |t: f64| (t - 2.5).max(0.0);
    for (level, motion) in &motions[..3] {
        for steps in [1, 10, 100] {
            all.push(
                scene(
                    f,
                    format!("a force after 100 rad, driven by {level}, {steps} outputs"),
                    rotor(1.0, 0.0) + motion + slider,
                )
                .end(10.0)
                .steps(steps)
                .follows("DZ(30,1)", move |t| since(t).powi(2) / 2.0, 1e-6),
            );
        }
    }
}

/// Rotors that coast for a day at 3000 rpm.
fn for_a_day(all: &mut Vec<Scene>) {
    let (f, speed, day) = ("turns", 100.0 * PI, 86_400.0);
    let shaft = || rotor(1.0, speed);
    for steps in [1, 7] {
        all.push(
            scene(f, format!("coasting for a day, {steps} outputs"), shaft())
                .end(day)
                .steps(steps)
                .follows("AZ(20,1)", move |t| speed * t, 1e-3),
        );
        all.push(
            scene(
                f,
                format!("driven for a day, {steps} outputs"),
                rotor(1.0, 0.0) + "MOTION/1, JOINT=1, ROTATION, VELOCITY, FUNCTION=100*PI\n",
            )
            .end(day)
            .steps(steps)
            .follows("AZ(20,1)", move |t| speed * t, 1e-3),
        );
    }
    // what a counter of turns switches off at noon
    let counter = "DIFF/1, IC=0, FUNCTION=IF(AZ(20,1)-4.32E6*PI: 1, 1, 0)\n";
    all.push(
        scene(f, "a counter of turns for a day", shaft() + counter)
            .end(day)
            .steps(2)
            .follows("DIF(1)", |t| t.min(43_200.0), 1e-3),
    );
}

/// Angles that no joint of the tree knows by itself.
fn elsewhere(all: &mut Vec<Scene>) {
    let f = "turns";
    // a crank, a rod and a slider: one of the hinges closes the loop
    let crank = "PART/2, MASS=1, CM=20, IP=1,1,1\n\
                 MARKER/20, PART=2\nMARKER/22, PART=2, QP=1,0,0\n\
                 PART/3, MASS=1, CM=30, IP=1,1,1, QG=1,0,0\n\
                 MARKER/30, PART=3\nMARKER/33, PART=3, QP=3,0,0\n\
                 PART/4, MASS=1, CM=40, IP=1,1,1, QG=4,0,0\n\
                 MARKER/40, PART=4\nMARKER/44, PART=4, REULER=90D,90D,0\n\
                 MARKER/4, PART=1, REULER=90D,90D,0\n\
                 JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, REVOLUTE, I=30, J=22\n\
                 JOINT/3, REVOLUTE, I=33, J=40\nJOINT/4, TRANSLATIONAL, I=44, J=4\n\
                 MOTION/1, JOINT=1, ROTATION, FUNCTION=40*TIME\n";
    let rod = |t: f64| -((40.0 * t).sin() / 3.0).asin();
    for steps in [1, 10] {
        all.push(
            scene(f, format!("hinges of a loop, {steps} outputs"), crank)
                .steps(steps)
                .follows("AZ(20,1)", |t| 40.0 * t, 1e-6)
                .follows("AZ(30,22)", move |t| rod(t) - 40.0 * t, 1e-6)
                .follows("AZ(40,22)", |t| -40.0 * t, 1e-6)
                .follows("AZ(33,40)", rod, 1e-6),
        );
    }
    // a ball is carried by a spherical joint: no coordinate knows its turns
    let ball = "PART/2, MASS=1, CM=20, IP=1,1,1, WZ=50\n\
                MARKER/20, PART=2\n\
                JOINT/1, SPHERICAL, I=20, J=1\n";
    for method in ["AUTO", "RADAU5"] {
        all.push(
            scene(f, "a ball that spins, 2 outputs", ball)
                .method(method)
                .end(10.0)
                .steps(2)
                .follows("AZ(20,1)", |t| 50.0 * t, 1e-3),
        );
    }
    // θ'' = −(k + k₀) θ: the spring of a spherical joint's spin is wound up by several turns
    all.push(
        scene(
            f,
            "a ball that winds a spring up, 3 outputs",
            ball.to_owned() + "SPRINGDAMPER/1, ROTATION, I=20, J=1, KT=1\n",
        )
        .end(10.0)
        .steps(3)
        .follows("AZ(20,1)", |t| 50.0 * t.sin(), 1e-3),
    );
    // at rest a spring holds a load after many turns: 500 N·mm of 2 N·mm/rad
    all.push(
        scene(
            f,
            "a spring that holds a load after forty turns",
            rotor(1.0, 0.0)
                + "SPRINGDAMPER/1, ROTATION, I=20, J=1, KT=2\n\
                   SFORCE/1, ROTATION, ACTIONONLY, I=20, J=1, FUNCTION=500\n",
        )
        .at_rest()
        .follows("AZ(20,1)", |_| 250.0, 1e-6),
    );
}
