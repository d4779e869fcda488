//! The number of outputs changes nothing.

use crate::laws::{free_body, push, slider};
use crate::scene::{Scene, scene};

/// The scenes of this family.
pub fn many_outputs() -> Vec<Scene> {
    let f = "many outputs";
    let mut all = Vec::new();
    for steps in [1, 10, 1000, 20_000] {
        let text =
            free_body(1.0, [1.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]) + "ACCGRAV/KGRAV=-10\n";
        all.push(
            scene(f, format!("a throw with {steps} outputs"), text)
                .steps(steps)
                .follows("DZ(20,1)", |t| -5.0 * t * t, 1e-7)
                .follows("DX(21,20)", f64::cos, 1e-6),
        );
        let text = slider(1.0, 1.0, 0.0) + &push("-100*DX(20,1)");
        all.push(
            scene(f, format!("an oscillator with {steps} outputs"), text)
                .steps(steps)
                .follows("DX(20,1)", |t| (10.0 * t).cos(), 1e-5),
        );
    }
    all
}
