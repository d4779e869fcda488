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
    for method in ["DOP853", "RADAU5", "BDF", "HHT"] {
        for mu in [0.5, 5.0] {
            let text = slider(1.0, 0.0, 1.0) + &push(&format!("-SIGN({mu},VX(20,1))"));
            let (error, tolerance) = if method == "HHT" {
                (1e-5, 1e-3)
            } else {
                (1e-8, 1e-4)
            };
            all.push(
                scene(f, format!("a block is stopped by {mu}"), text)
                    .method(method)
                    .end(3.0)
                    .error(error)
                    .follows("DX(20,1)", stops(1.0, mu), tolerance),
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
    // a belt carries a block: constant friction until it has the belt's speed
    let text = slider(1.0, 0.0, 0.0) + &push("SIGN(2,1-VX(20,1))");
    all.push(scene(f, "a belt carries a block", text).end(2.0).follows(
        "VX(20,1)",
        |t| (2.0 * t).min(1.0),
        1e-5,
    ));
    all
}
