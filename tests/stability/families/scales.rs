//! The same mechanism in other units, sizes and times.

use crate::laws::{pendulum, push, slider};
use crate::scene::{Scene, scene};
use std::f64::consts::FRAC_PI_2;

/// The scenes of this family.
pub fn scales() -> Vec<Scene> {
    let f = "scales";
    let mut all = Vec::new();
    for size in [1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9] {
        let text = format!(
            "PART/2, MASS=1, CM=20, QG={size:e},0,0\nMARKER/20, PART=2\nMARKER/21, PART=2, QP={:e},0,0\n\
             JOINT/1, REVOLUTE, I=21, J=1\nACCGRAV/JGRAV={:e}\n",
            -size,
            -9.81 * size
        );
        all.push(
            scene(f, format!("pendulum of length {size:e}"), text)
                .end(2.0)
                .follows(
                    "DY(20,1)",
                    move |t| -size * pendulum(t, 9.81f64.sqrt(), FRAC_PI_2).cos(),
                    1e-6 * size,
                ),
        );
    }
    for time in [1e-6, 1e-3, 1e3, 1e6] {
        let w = 1.0 / time;
        let text = slider(1.0, 1.0, 0.0) + &push(&format!("-{:e}*DX(20,1)", w * w));
        all.push(
            scene(f, format!("oscillator with a time of {time:e}"), text)
                .end(10.0 * time)
                .follows("DX(20,1)", move |t| (w * t).cos(), 1e-6),
        );
    }
    for (units, length, force) in [
        (
            "FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND",
            1e3,
            1.0,
        ),
        (
            "FORCE=NEWTON, MASS=TONNE, LENGTH=MILLIMETER, TIME=SECOND",
            1e3,
            1e3,
        ),
        (
            "FORCE=KNEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND",
            1.0,
            1e-3,
        ),
        (
            "FORCE=DYNE, MASS=GRAM, LENGTH=CENTIMETER, TIME=SECOND",
            1e2,
            1e5 * 1e-3,
        ),
        (
            "FORCE=NEWTON, MASS=KILOGRAM, LENGTH=KILOMETER, TIME=SECOND",
            1e-3,
            1.0,
        ),
    ] {
        let text = format!(
            "UNITS/{units}\n{}",
            slider(1.0, 0.0, 0.0) + &push(&format!("{force:e}"))
        );
        let name = units.split("LENGTH=").nth(1).unwrap_or(units);
        all.push(scene(f, format!("units {name} {force:e}"), text).follows(
            "DX(20,1)",
            move |t| length * t * t / 2.0,
            1e-9 * length,
        ));
    }
    let text = format!(
        "UNITS/FORCE=POUND_FORCE, MASS=POUND_MASS, LENGTH=INCH, TIME=SECOND\n{}",
        slider(1.0, 0.0, 0.0) + &push("1")
    );
    all.push(scene(f, "a pound pushed by its weight", text).follows(
        "DX(20,1)",
        |t| 386.088_582_677_165_3 * t * t / 2.0,
        1e-5,
    ));
    let text = format!(
        "UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=MILLISECONDS\n{}",
        slider(1.0, 0.0, 0.0) + &push("1")
    );
    all.push(scene(f, "milliseconds", text).end(1000.0).follows(
        "DX(20,1)",
        |t| 1e-6 * t * t / 2.0,
        1e-9,
    ));
    all
}
