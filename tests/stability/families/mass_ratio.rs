//! Masses of very different size beside each other.

use crate::laws::{pendulum, slider};
use crate::scene::{Scene, scene};
use std::f64::consts::FRAC_PI_2;

/// The scenes of this family.
pub fn mass_ratio() -> Vec<Scene> {
    let f = "mass ratio";
    let mut all = Vec::new();
    for ratio in [1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9] {
        // two blocks on one rail, one pushed, a spring between: relative frequency √(k/μ)
        let (m, n) = (1.0, ratio);
        let k = 100.0 * m * n / (m + n);
        let text = format!(
            "{}PART/3, MASS={n:e}, CM=30, QG=3,0,0\nMARKER/30, PART=3, REULER=90D,90D,0\n\
             JOINT/2, TRANSLATIONAL, I=30, J=11\n\
             SFORCE/2, TRANSLATION, I=30, J=20, FUNCTION=-{k:e}*(DM(30,20)-2)\n",
            slider(m, 0.0, 0.0)
        );
        all.push(
            scene(f, format!("two blocks 1 : {ratio:e}"), text)
                .follows("DX(30,20)", |t| 2.0 + (10.0 * t).cos(), 1e-5)
                .follows(
                    format!("DX(20,1)+{ratio:e}*DX(30,1)"),
                    move |_| 3.0 * n,
                    1e-6 * (1.0 + n),
                ),
        );
    }
    for ratio in [1e-9, 1e-4, 1e4, 1e9] {
        // a cart on a cart: the upper one is pushed against the lower one
        let text = format!(
            "{}PART/3, MASS={ratio:e}, CM=30\nMARKER/30, PART=3, REULER=90D,90D,0\n\
             JOINT/2, TRANSLATIONAL, I=30, J=20\n\
             SFORCE/2, TRANSLATION, ACTIONONLY, I=30, J=11, FUNCTION={ratio:e}\n\
             SFORCE/3, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=-{ratio:e}+2\n",
            slider(1.0, 0.0, 0.0)
        );
        all.push(
            scene(f, format!("a cart of {ratio:e} on a cart of 1"), text)
                // a sum of two coordinates of this size, which each of some twenty steps rounds: runs are 0.3 to 1.7e-6 off
                // at any request where the ratio is 1e9
                .follows(
                    "DX(30,1)",
                    |t| t * t / 2.0,
                    1e-6 + 16.0 * f64::EPSILON * ratio / 2.0,
                )
                .follows(
                    "DX(20,1)",
                    move |t| (2.0 - ratio) * t * t / 2.0,
                    1e-6 * (1.0 + ratio),
                ),
        );
    }
    for mass in [1e-12, 1e12] {
        let text = format!(
            "PART/2, MASS={mass:e}, CM=20, QG=1,0,0\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=-1,0,0\n\
             JOINT/1, REVOLUTE, I=21, J=1\nACCGRAV/JGRAV=-9.81\n"
        );
        all.push(
            scene(f, format!("pendulum of {mass:e}"), text)
                .end(2.0)
                .follows(
                    "DY(20,1)",
                    |t| -pendulum(t, 9.81f64.sqrt(), FRAC_PI_2).cos(),
                    1e-6,
                ),
        );
    }
    /// Kinetic energy of a mass of 1 after a fall of 0.02.
    const FALLEN: f64 = 0.02;
    for error in [1e-6, 1e-7, 1e-9] {
        // falls from the level; the light joint between hums, and rounding of the heavy end shakes it
        let text = "PART/2, MASS=1, CM=20\nMARKER/20, PART=2, QP=1,0,0\nMARKER/21, PART=2\n\
                    PART/3, MASS=1E9, CM=30\nMARKER/30, PART=3, QP=2,0,0\nMARKER/31, PART=3, QP=1,0,0\n\
                    JOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=20\nACCGRAV/JGRAV=-9.81\n";
        all.push(
            scene(f, format!("double pendulum 1 : 1e9 at {error:e}"), text)
                .end(0.02)
                .error(error)
                .balances("9.81*DY(30,1)+VM(30,1)**2/2", FALLEN, 1e-8),
        );
    }
    all
}
