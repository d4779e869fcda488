//! Equilibria.

use crate::laws::{push, slider};
use crate::scene::{Scene, scene};

/// The scenes of this family.
pub fn rest() -> Vec<Scene> {
    let f = "rest";
    let mut all = Vec::new();
    for k in [1e-3, 1.0, 1e3, 1e6, 1e9, 1e12] {
        let text = slider(1.0, 0.0, 0.0) + &push(&format!("-{k:e}*DX(20,1)+10"));
        all.push(
            scene(f, format!("weight on a spring of {k:e}"), text)
                .at_rest()
                .follows("DX(20,1)", move |_| 10.0 / k, 1e-4 * 10.0 / k + 1e-12),
        );
    }
    let text = "PART/2, MASS=1, CM=20, QG=1,0,0\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=-1,0,0\n\
         JOINT/1, REVOLUTE, I=21, J=1\nACCGRAV/JGRAV=-9.81\n";
    all.push(
        scene(f, "a pendulum hangs", text)
            .at_rest()
            .follows("DX(20,1)", |_| 0.0, 1e-4),
    );
    let text = slider(1.0, 0.0, 0.0) + &push("1");
    all.push(
        scene(f, "nothing carries a load", text)
            .at_rest()
            .ends("nothing carries"),
    );
    all
}
