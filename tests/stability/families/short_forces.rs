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
    all.extend(on_a_way());
    all
}

/// Forces on a short part of the way: work of one half on a mass of one that passes at speed one.
fn on_a_way() -> Vec<Scene> {
    let f = "short forces";
    let mut all = Vec::new();
    for width in [1e-3, 1e-6, 1e-9] {
        for (name, force) in [
            (
                "bell",
                format!(
                    "EXP(-((DX(20,1)-0.4)/{width:e})**2)/{width:e}/{:?}",
                    2.0 * PI.sqrt()
                ),
            ),
            (
                "pair of TANH",
                format!(
                    "(TANH((DX(20,1)-0.4)/{width:e}+1)-TANH((DX(20,1)-0.4)/{width:e}-1))/{:e}",
                    8.0 * width
                ),
            ),
            (
                "wall by IF",
                format!("IF(ABS(DX(20,1)-0.4)-{width:e}: {:e},0,0)", 0.25 / width),
            ),
            (
                "parabola by MAX",
                format!("MAX(0,1-((DX(20,1)-0.4)/{width:e})**2)*{:e}", 0.375 / width),
            ),
        ] {
            for method in ["AUTO", "RADAU5"] {
                for error in [1e-6, 1e-4, 1e-3, 1e-2, 1e-1] {
                    let text = slider(1.0, 0.0, 1.0) + &push(&force);
                    // less than what the force adds to the speed
                    let permitted = f64::min(100.0 * error, 0.2);
                    all.push(
                        scene(f, format!("a {name} of {width:e} on the way"), text)
                            .method(method)
                            .error(error)
                            .steps(1)
                            .follows(
                                "VX(20,1)",
                                |t| if t > 0.5 { 2f64.sqrt() } else { 1.0 },
                                permitted,
                            ),
                    );
                }
            }
        }
    }
    all
}
