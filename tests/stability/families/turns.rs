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
    for method in ["RADAU5", "BDF"] {
        all.push(
            scene(f, "coasting at 50 rad/s", rotor(1.0, 50.0))
                .method(method)
                .end(10.0)
                .steps(2)
                .follows("AZ(20,1)", |t| 50.0 * t, 1e-2),
        );
    }
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
