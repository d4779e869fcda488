//! Weight: fall, swing and flight.

use crate::laws::{free_body, pendulum};
use crate::scene::{Scene, scene};

/// The scenes of this family.
pub fn gravity() -> Vec<Scene> {
    let f = "gravity";
    let mut all = Vec::new();
    for g in [1e-12, 1e-6, 1.0, 1e6, 1e12] {
        let text = format!(
            "{}ACCGRAV/KGRAV={:e}\n",
            free_body(1.0, [1.0; 3], [1.0, 0.0, 0.0], [0.0; 3]),
            -g
        );
        all.push(
            scene(f, format!("free fall with {g:e}"), text)
                .follows("DZ(20,1)", move |t| -g * t * t / 2.0, 1e-9 * g)
                .follows("DX(20,1)", |t| t, 1e-9),
        );
    }
    for (axis, name) in [(0, "IGRAV"), (1, "JGRAV"), (2, "KGRAV")] {
        let text = format!(
            "{}ACCGRAV/{name}=3\n",
            free_body(5.0, [1.0; 3], [0.0; 3], [0.3, -0.2, 0.1])
        );
        let column = ["DX(20,1)", "DY(20,1)", "DZ(20,1)"][axis];
        all.push(
            scene(f, format!("{name} acts along its axis"), text).follows(
                column,
                |t| 1.5 * t * t,
                1e-9,
            ),
        );
    }
    for amplitude in [1e-6, 0.5, 2.0, 3.0, 3.1] {
        let (x, y) = (f64::sin(amplitude), -f64::cos(amplitude));
        let text = format!(
            "PART/2, MASS=1, CM=20, QG={x:e},{y:e},0\nMARKER/20, PART=2\nMARKER/21, PART=2, QP={:e},{:e},0\n\
             JOINT/1, REVOLUTE, I=21, J=1\nACCGRAV/JGRAV=-9.81\n",
            -x, -y
        );
        all.push(
            scene(f, format!("pendulum from {amplitude} rad"), text)
                .end(3.0)
                .follows(
                    "DX(20,1)",
                    move |t| pendulum(t, 9.81f64.sqrt(), amplitude).sin(),
                    // near the top errors grow as e^{ωt}
                    if amplitude > 2.5 {
                        1e-3
                    } else {
                        1e-6 * amplitude.max(1e-2)
                    },
                ),
        );
    }
    all
}
