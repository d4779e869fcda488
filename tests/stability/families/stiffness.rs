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
        for method in [None, Some("RADAU5")] {
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
    for error in [1e-2, 1e-3, 1e-4, 1e-6, 1e-8] {
        // a ball that bounces and settles on a stiff plane: the spring carries its weight
        let text = "PART/2, MASS=1, CM=20, QG=0,0,0.06\nMARKER/20, PART=2\nJOINT/1, TRANSLATIONAL, I=20, J=1\n\
                    SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=1, FUNCTION=IMPACT(DZ(20,1),VZ(20,1),0.05,1E8,1.5,2000,1E-4)\n\
                    ACCGRAV/KGRAV=-10\n";
        all.push(
            scene(f, format!("ball that settles, request {error:e}"), text)
                .end(2.0)
                .error(error)
                .follows(
                    "IF(TIME-1.9: 0,0,DZ(20,1))",
                    |t| {
                        if t > 1.9 {
                            0.05 - 1e-7f64.powf(2.0 / 3.0)
                        } else {
                            0.0
                        }
                    },
                    0.05 * error,
                ),
        );
    }
    for error in [1e-1, 1e-3, 1e-6, 1e-11, 1e-13] {
        // by an explicit method: a fast transient, then a slow swing, which lags by 1e-6 s
        let text = format!(
            "{}BUSHING/1, I=20, J=11, K=0,0,40, C=0,0,1E6\nSFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=1E6*SIN(TIME)\n",
            slider(1.0, 0.0, 0.0)
        );
        all.push(
            scene(
                f,
                format!("damper 1e6 by an explicit method at {error:e}"),
                text,
            )
            .method("DOP853")
            .error(error)
            .end(0.1)
            .tells("the model is stiff")
            .follows("DX(20,1)", |t| 1.0 - t.cos(), f64::max(10.0 * error, 2e-7)),
        );
    }
    all
}
