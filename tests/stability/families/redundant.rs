//! More conditions than freedoms.

use crate::laws::{free_body, slider};
use crate::scene::{Scene, scene};
use std::f64::consts::TAU;

/// The scenes of this family.
pub fn redundant() -> Vec<Scene> {
    let f = "redundant";
    let mut all = Vec::new();
    // a planar four-bar of revolutes, crank 1, coupler 4, rocker 3, ground 4
    let bars = |drive: &str| {
        // crank along x: rocker pin by intersection of circles about (1,0) r 4 and (4,0) r 3
        let (d, r, s) = (3.0f64, 4.0f64, 3.0f64);
        let a = (d * d + r * r - s * s) / (2.0 * d);
        let h = (r * r - a * a).sqrt();
        let (x, y) = (1.0 + a, h);
        format!(
            "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=1,0,0\n\
             PART/3, MASS=1, CM=30, IP=1,1,1, QG=1,0,0\nMARKER/30, PART=3\nMARKER/31, PART=3, QP={:?},{y:?},0\n\
             PART/4, MASS=1, CM=40, IP=1,1,1, QG=4,0,0\nMARKER/40, PART=4\nMARKER/41, PART=4, QP={:?},{y:?},0\n\
             MARKER/12, PART=1, QP=4,0,0\n\
             JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, REVOLUTE, I=30, J=21\n\
             JOINT/3, REVOLUTE, I=31, J=41\nJOINT/4, REVOLUTE, I=40, J=12\n{drive}",
            x - 1.0,
            x - 4.0
        )
    };
    // closed form of the rocker's pin
    let pin = |t: f64| {
        let a = TAU * t;
        let (px, py) = (a.cos(), a.sin());
        let (dx, dy) = (4.0 - px, -py);
        let d = (dx * dx + dy * dy).sqrt();
        let along = (d * d + 16.0 - 9.0) / (2.0 * d);
        let h = (16.0 - along * along).sqrt();
        [
            px + (along * dx - h * dy) / d,
            py + (along * dy + h * dx) / d,
        ]
    };
    for steps in [12, 40] {
        all.push(
            scene(
                f,
                format!("a planar four-bar of revolutes, {steps} outputs"),
                bars("MOTION/1, JOINT=1, ROTATION, FUNCTION=2*PI*TIME\n"),
            )
            .kinematic()
            .steps(steps)
            .follows("DX(31,1)", move |t| pin(t)[0], 1e-9)
            .follows("DY(31,1)", move |t| pin(t)[1], 1e-9),
        );
    }
    // a door on n hinges
    for n in [2, 3, 5] {
        let mut text = "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2, QP=1,0,0\n".to_string();
        for k in 0..n {
            text += &format!(
                "MARKER/2{}, PART=2, QP=0,0,{k}\nMARKER/1{}, PART=1, QP=0,0,{k}\nJOINT/{}, REVOLUTE, I=2{}, J=1{}\n",
                k + 1,
                k + 1,
                k + 1,
                k + 1,
                k + 1
            );
        }
        text += "SFORCE/1, ROTATION, I=21, J=11, FUNCTION=2\n";
        // inertia about the hinge: 1 + 1
        all.push(scene(f, format!("a door on {n} hinges"), text).follows(
            "AZ(21,11)",
            |t| t * t / 2.0,
            1e-7,
        ));
    }
    // a table carried by three and by four legs of one guide: forces add up to its weight
    for n in [2, 4] {
        let mut text =
            "PART/2, MASS=4, CM=20, IP=1,1,1\nMARKER/20, PART=2\nACCGRAV/KGRAV=-10\n".to_string();
        let mut sum = Vec::new();
        for k in 0..n {
            let angle = TAU * f64::from(k) / f64::from(n);
            text += &format!(
                "MARKER/2{}, PART=2, QP={:?},{:?},0\nMARKER/1{}, PART=1, QP={:?},{:?},0\nJOINT/{}, FIXED, I=2{}, J=1{}\n",
                k + 1,
                angle.cos(),
                angle.sin(),
                k + 1,
                angle.cos(),
                angle.sin(),
                k + 1,
                k + 1,
                k + 1
            );
            sum.push(format!("JOINT({},0,4,1)", k + 1));
        }
        all.push(
            scene(f, format!("a table fixed by {n} legs"), text)
                .kinematic()
                .follows(sum.join("+"), |_| 40.0, 1e-9),
        );
    }
    // two constraints that say the same of a free body
    let text = free_body(1.0, [1.0; 3], [1.0, 0.0, 0.0], [0.0; 3])
        + "JPRIM/1, INPLANE, I=20, J=1\nJPRIM/2, INPLANE, I=20, J=1\nACCGRAV/KGRAV=-10\n";
    all.push(
        scene(f, "a plane twice", text)
            .follows("DX(20,1)", |t| t, 1e-9)
            .follows("DZ(20,1)", |_| 0.0, 1e-12),
    );
    // contradictions are refused
    let text = slider(1.0, 0.0, 0.0)
        + "MOTION/1, JOINT=1, TRANSLATION, FUNCTION=TIME\nMARKER/12, PART=1, QP=0,0,0\nMOTION/2, I=20, J=1, X, FUNCTION=2*TIME+1\n";
    all.push(scene(f, "two motions that contradict", text).ends("MOTION"));
    all
}
