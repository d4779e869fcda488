//! Stiff scenes: springs, dampers and bushings far stiffer than what is looked at.

use crate::laws::{push, slider};
use crate::scene::{Scene, scene};
use std::f64::consts::TAU;

/// The scenes of this family.
pub fn stiffness() -> Vec<Scene> {
    let f = "stiffness";
    let mut all = Vec::new();
    for k in [1.0, 1e3, 1e6, 1e9, 1e12] {
        let w = f64::sqrt(k);
        let text = slider(1.0, 1.0, 0.0) + &push(&format!("-{k:e}*DX(20,1)"));
        all.push(
            scene(f, format!("spring {k:e} for five periods"), text)
                .end(5.0 * TAU / w)
                .follows("DX(20,1)", move |t| (w * t).cos(), 1e-4),
        );
    }
    for c in [1e3, 1e5, 1e7] {
        // m = 1, k = 1: x = (a e^{bt} − b e^{at})/(a − b)
        let root = f64::sqrt(c * c / 4.0 - 1.0);
        let slow = -1.0 / (c / 2.0 + root);
        let fast = -c / 2.0 - root;
        let text = slider(1.0, 1.0, 0.0) + &push(&format!("-DX(20,1)-{c:e}*VX(20,1)"));
        all.push(scene(f, format!("damper {c:e}"), text).follows(
            "DX(20,1)",
            move |t| (fast * (slow * t).exp() - slow * (fast * t).exp()) / (fast - slow),
            1e-6,
        ));
    }
    for l in [1e2, 1e4, 1e6, 1e8] {
        // y' = −λ (y − cos t), y(0) = 1
        let exact = move |t: f64| {
            let d = l * l + 1.0;
            (l * l * t.cos() + l * t.sin()) / d + (1.0 - l * l / d) * (-l * t).exp()
        };
        let text = format!("DIFF/1, IC=1, FUNCTION=-{l:e}*(DIF(1)-COS(TIME))\n");
        for method in [None, Some("RADAU5"), Some("BDF")] {
            let one = scene(f, format!("decay {l:e} towards a cosine"), text.clone())
                .end(3.0)
                .follows("DIF(1)", exact, 1e-6);
            all.push(match method {
                Some(m) => one.method(m),
                None => one,
            });
        }
    }
    for k in [1e4, 1e8, 1e12] {
        // a bushing in the way of a driven base: I follows J
        let text = format!(
            "{}BUSHING/1, I=20, J=11, K={k:e},{k:e},{k:e}, C={:e},{:e},{:e}\nACCGRAV/IGRAV=-10\n",
            slider(1.0, 0.0, 0.0),
            2.0 * f64::sqrt(k),
            2.0 * f64::sqrt(k),
            2.0 * f64::sqrt(k)
        );
        all.push(
            // critically damped fall onto −g/k
            scene(f, format!("bushing {k:e} under weight"), text).follows(
                "DX(20,1)",
                move |t| {
                    let w = f64::sqrt(k);
                    -10.0 / k * (1.0 - (1.0 + w * t) * (-w * t).exp())
                },
                1e-3 * 10.0 / k + 1e-12,
            ),
        );
    }
    all
}
