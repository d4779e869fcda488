//! Forces that jump: in time, in position, in speed.

use crate::laws::{push, slider};
use crate::scene::{Scene, scene};
use std::f64::consts::{PI, TAU};

/// The scenes of this family.
pub fn jumps() -> Vec<Scene> {
    let f = "jumps";
    let mut all = Vec::new();
    for at in [0.3, 0.5, 0.987_654_321] {
        let text = slider(1.0, 0.0, 0.0) + &push(&format!("IF(TIME-{at}: 0, 1, 1)"));
        all.push(scene(f, format!("a force begins at {at}"), text).follows(
            "DX(20,1)",
            move |t| (t - at).max(0.0).powi(2) / 2.0,
            1e-9,
        ));
    }
    for x in [1e-3, 1.0, 1e3] {
        // x'' = −sign x: parabolas of quarter period √(2x)
        let text = slider(1.0, x, 0.0) + &push("IF(DX(20,1): 1, 0, -1)");
        all.push(
            scene(f, format!("a force that changes sides from {x}"), text)
                .end(4.0 * (2.0 * x).sqrt())
                .steps(8)
                .follows(
                    "DX(20,1)",
                    move |t| {
                        let quarter = (2.0 * x).sqrt();
                        let s = (t / quarter) % 4.0;
                        let half = |u: f64| x - (u * quarter).powi(2) / 2.0;
                        if s <= 1.0 {
                            half(s)
                        } else if s <= 3.0 {
                            -half(s - 2.0)
                        } else {
                            half(4.0 - s)
                        }
                    },
                    1e-5 * x,
                ),
        );
    }
    for k in [1e3, 1e6, 1e9] {
        // a ball dropped on a linear stop without damping returns to its height
        let text = slider(1.0, 1.0, 0.0)
            + &push(&format!("-10+IMPACT(DX(20,1),VX(20,1),0,{k:e},1,0,1E-6)"));
        let w = f64::sqrt(k);
        let v = 20f64.sqrt();
        // time in contact: w t = π + 2 atan(g/(w v))
        let contact = (PI + 2.0 * (10.0 / (w * v)).atan()) / w;
        let fall = 0.2f64.sqrt();
        let period = 2.0 * fall + contact;
        all.push(
            scene(f, format!("a ball on a stop of {k:e}"), text)
                .end(3.0 * period)
                .steps(3)
                .follows("DX(20,1)", |_| 1.0, 1e-4),
        );
    }
    let text = slider(1.0, 0.0, 0.0) + &push("STEP(TIME,0.2,0,0.2001,1)");
    all.push(scene(f, "a step in a ten-thousandth", text).follows(
        "VX(20,1)",
        |t| {
            if t < 0.2 {
                0.0
            } else {
                (t - 0.200_05).max(0.0)
            }
        },
        1e-6,
    ));
    let text = "DIFF/1, IC=0, FUNCTION=SIGN(1,SIN(10*PI*TIME+0.1))\n";
    all.push(
        scene(f, "a square wave integrated", text)
            .end(2.0)
            .steps(10)
            .follows(
                "DIF(1)",
                |t| {
                    let fold = |x: f64| {
                        let u = x.rem_euclid(TAU);
                        if u < PI { u } else { TAU - u }
                    };
                    (fold(10.0 * PI * t + 0.1) - 0.1) / (10.0 * PI)
                },
                1e-8,
            ),
    );
    for method in ["DOP853", "RADAU5"] {
        let text = "DIFF/1, IC=0, FUNCTION=ABS(COS(TIME))\n";
        all.push(
            scene(f, "a rectified cosine", text)
                .method(method)
                .end(10.0)
                .follows(
                    "DIF(1)",
                    |t| {
                        let n = (t / PI + 0.5).floor();
                        2.0 * n + (t - n * PI).sin()
                    },
                    1e-5,
                ),
        );
    }
    all
}
