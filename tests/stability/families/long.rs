//! Long runs.

use crate::laws::{free_body, push, slider};
use crate::scene::{Scene, scene};
use std::f64::consts::TAU;

/// The scenes of this family.
pub fn long() -> Vec<Scene> {
    let f = "long";
    let text = slider(1.0, 1.0, 0.0) + &push("-DX(20,1)");
    vec![
        scene(f, "a thousand periods", text)
            .end(1000.0 * TAU)
            .steps(4)
            .error(1e-11)
            .follows("DX(20,1)", f64::cos, 1e-5),
        scene(f, "a decay to nothing", "DIFF/1, IC=1, FUNCTION=-DIF(1)\n")
            .end(1e4)
            .steps(5)
            .follows("DIF(1)", |t| (-t).exp(), 1e-6),
        scene(
            f,
            "a million seconds of a constant rate",
            "DIFF/1, IC=0, FUNCTION=1\n",
        )
        .end(1e6)
        .follows("DIF(1)", |t| t, 1e-6),
        scene(
            f,
            "free flight for a year",
            free_body(1.0, [1.0; 3], [1.0, 2.0, 3.0], [0.0; 3]),
        )
        .end(3.156e7)
        .follows("DZ(20,1)", |t| 3.0 * t, 1e-3),
        scene(
            f,
            "a spinning ball for an hour",
            free_body(1.0, [1.0; 3], [0.0; 3], [0.0, 0.0, 1.0]),
        )
        .end(3600.0)
        .steps(4)
        .error(1e-10)
        .follows("DX(21,20)", f64::cos, 1e-4),
    ]
}
