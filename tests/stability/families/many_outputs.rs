//! The number of outputs changes nothing.

use crate::laws::{free_body, push, slider};
use crate::scene::{Scene, scene};
use std::f64::consts::PI;

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
        let text = four_bar() + "MOTION/1, JOINT=1, ROTATION, FUNCTION=12*PI*TIME\n";
        all.push(
            scene(
                f,
                format!("six turns of a crank with {steps} outputs"),
                text,
            )
            .kinematic()
            .steps(steps)
            .follows("DX(32,1)", |t| rocker(12.0 * PI * t)[0], 1e-9)
            .follows("DY(32,1)", |t| rocker(12.0 * PI * t)[1], 1e-9),
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

/// The end of the rocker of [`four_bar`] when its crank has turned from upright: circles of 2.06 about the crank's end and of 1 about
/// (2, 0) meet on the left of the line between them.
fn rocker(turned: f64) -> [f64; 2] {
    let a = [-0.5 * turned.sin(), 0.5 * turned.cos()];
    let d = [2.0 - a[0], -a[1]];
    let d2 = d[0] * d[0] + d[1] * d[1];
    let along = (2.06 * 2.06 - 1.0 + d2) / (2.0 * d2);
    let aside = (2.06 * 2.06 / d2 - along * along).sqrt();
    [
        a[0] + along * d[0] - aside * d[1],
        a[1] + along * d[1] + aside * d[0],
    ]
}

/// A four-bar: crank 0.5 on JOINT/1, coupler 2.06, rocker 1 with MARKER/42 at its end, base 2.
fn four_bar() -> String {
    let [x, y] = rocker(0.0);
    format!(
        "MARKER/12, PART=1, QP=2,0,0\nPART/2, MASS=1, CM=21, IP=1,1,1\nMARKER/21, PART=2\nMARKER/22, PART=2, QP=0,0.5,0\n\
         PART/3, MASS=1, CM=31, IP=1,1,1\nMARKER/31, PART=3, QP=0,0.5,0\nMARKER/32, PART=3, QP={x:?},{y:?},0\n\
         PART/4, MASS=1, CM=41, IP=1,1,1\nMARKER/41, PART=4, QP=2,0,0\nMARKER/42, PART=4, QP={x:?},{y:?},0\n\
         JOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=22\nJOINT/3, REVOLUTE, I=32, J=42\nJOINT/4, REVOLUTE, I=41, J=12\n"
    )
}
