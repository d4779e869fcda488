//! Definitions that need each other.

use crate::laws::{push, slider};
use crate::scene::{Scene, scene};

/// The scenes of this family.
pub fn circular() -> Vec<Scene> {
    let f = "circular";
    let moving = slider(1.0, 0.0, 0.0);
    vec![
        scene(f, "a variable that reads itself", moving.clone() + "VARIABLE/1, FUNCTION=0.5*VARVAL(1)+1+TIME\n")
            .follows("VARVAL(1)", |t| 2.0 + 2.0 * t, 1e-9),
        scene(f, "a fixed point of the cosine", moving.clone() + "VARIABLE/1, IC=1, FUNCTION=COS(VARVAL(1))\n")
            .follows("VARVAL(1)", |_| 0.739_085_133_215_160_6, 1e-9),
        scene(f, "two variables that read each other", moving.clone() + "VARIABLE/1, FUNCTION=0.5*VARVAL(2)+TIME\nVARIABLE/2, FUNCTION=0.5*VARVAL(1)\n")
            .follows("VARVAL(1)", |t| 4.0 / 3.0 * t, 1e-9),
        scene(f, "a force that reads its own acceleration", moving.clone() + &push("1-0.5*ACCX(20,1)"))
            .follows("DX(20,1)", |t| t * t / 3.0, 1e-8),
        scene(f, "a loop without solution", moving.clone() + "VARIABLE/1, FUNCTION=VARVAL(1)+1\n" + &push("VARVAL(1)"))
            .ends("VARIABLE/1"),
        scene(f, "a loop whose solution ends", moving.clone() + "VARIABLE/1, IC=0.5, FUNCTION=VARVAL(1)-VARVAL(1)**2-TIME+0.25\n" + &push("VARVAL(1)"))
            .ends("VARIABLE/1"),
        scene(f, "an implicit differential equation", "DIFF/1, IC=1,-1, IMPLICIT, FUNCTION=2*DIF1(1)+2*DIF(1)\n")
            .follows("DIF(1)", |t| (-t).exp(), 1e-6),
        scene(f, "friction that reads the reaction it loads", format!(
            "{moving}ACCGRAV/KGRAV=-10\nSFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=5-0.2*ABS(JOINT(1,0,4,1))\n"
        )).follows("DX(20,1)", |t| 3.0 * t * t / 2.0, 1e-7),
    ]
}
