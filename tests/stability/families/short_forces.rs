//! Forces that are short beside the run.

use crate::laws::{push, slider};
use crate::scene::{Scene, scene};
use std::f64::consts::PI;

/// The scenes of this family.
pub fn short_forces() -> Vec<Scene> {
    let f = "short forces";
    let mut all = Vec::new();
    for width in [1e-2, 1e-4, 1e-6, 1e-9] {
        let end = 0.5 + width;
        let text = slider(1.0, 0.0, 0.0)
            + &push(&format!(
                "IF(TIME-0.5: 0, 1, IF(TIME-{end:?}: 1, 0, 0))*{:e}",
                1.0 / width
            ));
        all.push(
            scene(f, format!("a pulse of {width:e}"), text)
                .steps(2)
                .follows(
                    "VX(20,1)",
                    move |t| ((t - 0.5) / width).clamp(0.0, 1.0),
                    1e-5,
                ),
        );
        let text = slider(1.0, 0.0, 0.0)
            + &push(&format!(
                "(STEP(TIME,0.3,0,{:?},1)-STEP(TIME,{:?},0,{:?},1))*{:e}",
                0.3 + width,
                0.3 + width,
                0.3 + 2.0 * width,
                1.0 / width
            ));
        all.push(
            scene(f, format!("a hump of steps of {width:e}"), text)
                .steps(1)
                .follows("VX(20,1)", |t| if t > 0.5 { 1.0 } else { 0.0 }, 1e-4),
        );
    }
    for width in [1e-2, 1e-3] {
        let text = slider(1.0, 0.0, 0.0)
            + &push(&format!(
                "EXP(-((TIME-0.4)/{width})**2)/{width}/{:?}",
                PI.sqrt()
            ));
        all.push(
            scene(f, format!("a bell of {width:e}"), text)
                .steps(1)
                .follows("VX(20,1)", |t| if t > 0.5 { 1.0 } else { 0.0 }, 1e-5),
        );
    }
    all
}
