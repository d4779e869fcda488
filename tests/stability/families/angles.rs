//! Angles that are asked for a quarter turn or a half turn away from where the parts are drawn.

use crate::scene::{Scene, scene};
use std::f64::consts::PI;

/// The scenes of this family.
pub fn angles() -> Vec<Scene> {
    let f = "angles";
    let mut all = Vec::new();
    // a rotor about z of ground, about which nothing is asked but its angle
    let rotor = |start: f64, asked: &str| {
        format!(
            "PART/2, MASS=2, CM=20, IP=1,1,2, REULER={start}D,0,0\nMARKER/20, PART=2\n\
             JOINT/1, REVOLUTE, I=20, J=1\nMOTION/1, I=20, J=1, B3, FUNCTION={asked}\n"
        )
    };
    for (start, asked) in [
        (0, 170),
        (120, 0),
        (-90, 90),
        (90, -90),
        (0, 180),
        (45, 135),
    ] {
        let turned = |scene: Scene| {
            let angle = f64::from(asked).to_radians();
            // a half turn has no sign
            let wrapped = scene.follows("SIN(AZ(20,1))", move |_| angle.sin(), 1e-9);
            wrapped
                .follows("COS(AZ(20,1))", move |_| angle.cos(), 1e-9)
                .tells("PART/2 is turned by")
        };
        let named = |how: &str| {
            let name = format!("B3 of {asked} deg from {start} deg, {how}");
            scene(f, name, rotor(f64::from(start), &format!("{asked}D")))
        };
        all.push(turned(named("at rest").at_rest()));
        all.push(turned(named("kinematic").kinematic()));
    }
    all.push(
        scene(f, "B3 over four turns", rotor(0.0, "8*PI*TIME"))
            .kinematic()
            .steps(50)
            .follows("AZ(20,1)", |t| 8.0 * PI * t, 1e-9),
    );
    // a ball joint and a condition of its orientation
    for (drawn, condition, column, value) in [
        ("90D,0,0", "ORIENTATION", "AZ(21,1)", 0.0),
        ("150D,0,0", "ORIENTATION", "AZ(21,1)", 0.0),
        ("180D,0,0", "ORIENTATION", "COS(AZ(21,1))", 1.0),
        ("0,180D,0", "ORIENTATION", "THETA(21,1)", 0.0),
        ("0,180D,0", "PARALLEL_AXES", "THETA(21,1)", 0.0),
        ("0,120D,0", "PARALLEL_AXES", "THETA(21,1)", 0.0),
        ("0,0,0", "PERPENDICULAR", "THETA(21,1)", 0.5 * PI),
        ("0,180D,0", "PERPENDICULAR", "THETA(21,1)", 0.5 * PI),
    ] {
        let text = format!(
            "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, REULER={drawn}\n\
             JOINT/1, SPHERICAL, I=20, J=1\nJPRIM/1, {condition}, I=21, J=1\n"
        );
        all.push(
            scene(f, format!("{condition} drawn at {drawn}"), text)
                .follows(column, move |_| value, 1e-8)
                .tells("PART/2 is turned by"),
        );
    }
    all
}
