//! Dry friction: holding, sliding, coming to rest.

use crate::laws::{push, slider};
use crate::scene::{Scene, scene};
use std::f64::consts::PI;

/// The scenes of this family.
pub fn friction() -> Vec<Scene> {
    let f = "friction";
    let mut all = Vec::new();
    let stops = |v: f64, mu: f64| {
        move |t: f64| {
            let t = t.min(v / mu);
            v * t - mu * t * t / 2.0
        }
    };
    for method in ["DOP853", "RADAU5"] {
        for mu in [0.5, 5.0] {
            let text = slider(1.0, 0.0, 1.0) + &push(&format!("-SIGN({mu},VX(20,1))"));
            all.push(
                scene(f, format!("a block is stopped by {mu}"), text)
                    .method(method)
                    .end(3.0)
                    .error(1e-8)
                    .follows("DX(20,1)", stops(1.0, mu), 1e-4),
            );
        }
    }
    for pull in [0.5, 0.99] {
        let text = slider(1.0, 0.0, 0.0) + &push(&format!("{pull}-SIGN(1,VX(20,1))"));
        all.push(
            scene(f, format!("held against {pull} of its friction"), text).follows(
                "DX(20,1)",
                |_| 0.0,
                1e-9,
            ),
        );
    }
    let text = slider(1.0, 0.0, 0.0) + &push("TIME-SIGN(1,VX(20,1))");
    all.push(
        scene(f, "breaks away when the pull exceeds friction", text)
            .end(3.0)
            .follows("DX(20,1)", |t| (t - 1.0).max(0.0).powi(3) / 6.0, 1e-5),
    );
    // an oscillator loses four friction lengths a cycle
    let text = slider(1.0, 1.05, 0.0) + &push("-DX(20,1)-SIGN(0.1,VX(20,1))");
    all.push(
        scene(f, "an oscillator loses four friction lengths a cycle", text)
            .end(5.0 * PI)
            .steps(5)
            .follows(
                "DX(20,1)",
                |t| {
                    let n = (t / PI).round() as i32;
                    let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
                    sign * (1.05 - 0.2 * f64::from(n))
                },
                1e-4,
            ),
    );
    held_by_their_reaction(&mut all);
    // a belt carries a block: constant friction until it has the belt's speed
    let text = slider(1.0, 0.0, 0.0) + &push("SIGN(2,1-VX(20,1))");
    all.push(scene(f, "a belt carries a block", text).end(2.0).follows(
        "VX(20,1)",
        |t| (2.0 * t).min(1.0),
        1e-5,
    ));
    all
}

/// Scenes in which friction reads the reaction that presses the surfaces together.
fn held_by_their_reaction(all: &mut Vec<Scene>) {
    let f = "friction";
    // on a slope of 0.2, pressed by the cosine of the weight: friction by its own reaction, and FRICTION
    let slope: f64 = 0.2;
    let (sine, cosine) = (9.81 * slope.sin(), 9.81 * slope.cos());
    let block = format!(
        "PART/2, MASS=2, CM=20, IP=1,1,1\nMARKER/20, PART=2, REULER=90D,90D,0\nMARKER/40, PART=1, REULER=90D,90D,0\n\
         JOINT/1, TRANSLATIONAL, I=20, J=40\nACCGRAV/IGRAV={sine:?}, KGRAV={:?}\n",
        -cosine
    );
    for mu in [0.1, 0.3] {
        let sign = format!(
            "SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=40, FUNCTION=-{mu:?}*ABS(FM(20,40))*SIGN(1,VZ(20,40,40))\n"
        );
        let friction = format!(
            "FRICTION/1, JOINT=1, MU_STATIC={mu:?}, MU_DYNAMIC={mu:?}, STICTION_TRANSITION_VELOCITY=1E-5, MAX_STICTION_DEFORMATION=1E-7\n"
        );
        let slides = (sine - mu * cosine).max(0.0);
        for method in ["AUTO", "RADAU5"] {
            for (name, law) in [("SIGN", &sign), ("FRICTION", &friction)] {
                let name = format!("{name} of {mu} on a slope of 0.2 by {method}");
                all.push(
                    scene(f, name, block.clone() + law)
                        .method(method)
                        .end(3.0)
                        .error(1e-8)
                        .follows("DX(20,1)", move |t| slides * t * t / 2.0, 1e-4),
                );
            }
        }
    }
}
