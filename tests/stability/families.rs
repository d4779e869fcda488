//! The scenes, by family: each has a closed form, a law, or a reason for which it must stop.

use crate::laws::*;
use crate::scene::{Scene, scene};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// All scenes.
pub fn all() -> Vec<Scene> {
    [
        stiffness(),
        mass_ratio(),
        scales(),
        gravity(),
        singular(),
        turns(),
        tumbling(),
        friction(),
        jumps(),
        short_forces(),
        no_value(),
        redundant(),
        long(),
        many_outputs(),
        large(),
        circular(),
        rest(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn stiffness() -> Vec<Scene> {
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

fn mass_ratio() -> Vec<Scene> {
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
                .follows("DX(30,1)", |t| t * t / 2.0, 1e-6)
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
    all
}

fn scales() -> Vec<Scene> {
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

fn gravity() -> Vec<Scene> {
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

fn singular() -> Vec<Scene> {
    let f = "singular";
    let mut all = Vec::new();
    // a slider crank with equal arms: the slider passes the middle at its dead point, held by a second guide
    for steps in [7, 10, 40] {
        let text = "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=1,0,0\n\
             PART/3, MASS=1, CM=30, IP=1,1,1, QG=1,0,0\nMARKER/30, PART=3\nMARKER/31, PART=3, QP=2,0,0\n\
             PART/4, MASS=1, CM=40, IP=1,1,1, QG=3,0,0\nMARKER/40, PART=4\nMARKER/41, PART=4, REULER=90D,90D,0\n\
             MARKER/11, PART=1, REULER=90D,90D,0\n\
             JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, REVOLUTE, I=30, J=21\n\
             JOINT/3, REVOLUTE, I=31, J=40\nJOINT/4, TRANSLATIONAL, I=41, J=11\n\
             MOTION/1, JOINT=1, ROTATION, FUNCTION=2*PI*TIME\n";
        all.push(
            scene(
                f,
                format!("slider crank through its dead points, {steps} outputs"),
                text,
            )
            .kinematic()
            .steps(steps)
            .follows(
                "DX(40,1)",
                |t| {
                    let a = TAU * t;
                    a.cos() + (4.0 - a.sin().powi(2)).sqrt()
                },
                1e-9,
            ),
        );
    }
    // angles of a free body pass through their singular positions while it turns about a fixed axis
    for (k, w) in [
        [3.0, 0.0, 0.0],
        [0.0, 4.0, 0.0],
        [1.0, 2.0, 2.0],
        [2.0, -1.0, 0.5],
    ]
    .into_iter()
    .enumerate()
    {
        let text = free_body(1.0, [2.0; 3], [0.0; 3], w);
        let size = (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]).sqrt();
        let n = w.map(|x| x / size);
        // Rodrigues: x axis of the body
        let x = move |t: f64| {
            let (s, c) = (size * t).sin_cos();
            [
                c + n[0] * n[0] * (1.0 - c),
                n[2] * s + n[0] * n[1] * (1.0 - c),
                -n[1] * s + n[0] * n[2] * (1.0 - c),
            ]
        };
        all.push(
            scene(f, format!("a ball spins about a fixed axis {k}"), text)
                .end(5.0)
                .follows("DX(21,20)", move |t| x(t)[0], 1e-6)
                .follows("DY(21,20)", move |t| x(t)[1], 1e-6)
                .follows("DZ(21,20)", move |t| x(t)[2], 1e-6),
        );
    }
    // a four-bar of equal sides, folded flat in the beginning, pulled by its own weight onto one side
    for method in ["DOP853", "RADAU5"] {
        let text = "PART/2, MASS=1, CM=20\nMARKER/20, PART=2, QP=0,-1,0\nMARKER/21, PART=2\n\
             JOINT/1, REVOLUTE, I=21, J=1\nMARKER/22, PART=2\nJPRIM/1, INPLANE, I=22, J=1\n\
             SFORCE/1, ROTATION, I=21, J=1, FUNCTION=1\n";
        all.push(
            scene(f, "a plane that a revolute keeps anyway", text)
                .method(method)
                .follows("AZ(21,1)", |t| t * t / 2.0, 1e-6),
        );
    }
    // a dead point cannot be driven through: a rod of length one, pulled beyond
    let text = "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=1,0,0\n\
         PART/3, MASS=1, CM=30, QG=1,0,0\nMARKER/30, PART=3\nMARKER/31, PART=3, REULER=90D,90D,0\n\
         MARKER/11, PART=1, REULER=90D,90D,0\nJOINT/1, SPHERICAL, I=20, J=1\nJOINT/2, SPHERICAL, I=21, J=30\n\
         JOINT/3, TRANSLATIONAL, I=31, J=11\nMOTION/1, JOINT=3, TRANSLATION, FUNCTION=1+0.5*TIME\n";
    all.push(scene(f, "a rod is pulled longer than it is", text).ends("MOTION/1"));
    all
}

fn turns() -> Vec<Scene> {
    let f = "turns";
    let mut all = Vec::new();
    for steps in [1, 3, 100] {
        for speed in [1.0, 20.0, 300.0] {
            all.push(
                scene(
                    f,
                    format!("coasting at {speed} rad/s, {steps} outputs"),
                    rotor(1.0, speed),
                )
                .end(10.0)
                .steps(steps)
                .follows("AZ(20,1)", move |t| speed * t, 1e-5 * speed),
            );
        }
        all.push(
            scene(
                f,
                format!("speeding up, {steps} outputs"),
                rotor(1.0, 0.0) + "SFORCE/1, ROTATION, I=20, J=1, FUNCTION=30\n",
            )
            .end(10.0)
            .steps(steps)
            .follows("AZ(20,1)", |t| 15.0 * t * t, 1e-3),
        );
        // a spring that is wound up: θ'' = −k(θ − θ₀)
        all.push(
            scene(
                f,
                format!("wound up by a torque, {steps} outputs"),
                rotor(1.0, 100.0) + "SPRINGDAMPER/1, ROTATION, I=20, J=1, KT=1\n",
            )
            .end(10.0)
            .steps(steps)
            .follows("AZ(20,1)", |t| 100.0 * t.sin(), 1e-4),
        );
    }
    for method in ["RADAU5", "BDF"] {
        all.push(
            scene(f, "coasting at 50 rad/s", rotor(1.0, 50.0))
                .method(method)
                .end(10.0)
                .steps(2)
                .follows("AZ(20,1)", |t| 50.0 * t, 1e-2),
        );
    }
    // an IF that reads turns: the torque is switched off after ten turns
    all.push(
        scene(
            f,
            "a torque ends after ten turns",
            rotor(1.0, 0.0)
                + "SFORCE/1, ROTATION, I=20, J=1, FUNCTION=IF(AZ(20,1)-20*PI: 10, 0, 0)\n",
        )
        .end(8.0)
        .steps(4)
        .follows("WZ(20,1)", |t| 10.0 * t.min((4.0 * PI).sqrt()), 1e-4),
    );
    all
}

fn tumbling() -> Vec<Scene> {
    let f = "tumbling";
    let mut all = Vec::new();
    for (a, c, spin) in [(1.0f64, 2.0, 3.0), (1.0, 0.01, 50.0), (1.0, 1.999, 0.1)] {
        // symmetric: ω about the figure axis stays, the rest turns at (C − A)/A ω₃
        let rate = (c - a) / a * spin;
        let text = free_body(1.0, [a, a, c], [0.0; 3], [0.5, 0.0, spin]);
        all.push(
            scene(f, format!("symmetric top {a}:{c} at {spin}"), text)
                .end(5.0)
                .follows("WX(20,1,20)", move |t| 0.5 * (rate * t).cos(), 1e-5)
                .follows("WY(20,1,20)", move |t| 0.5 * (rate * t).sin(), 1e-5)
                .follows("WZ(20,1,20)", move |_| spin, 1e-6 * spin),
        );
    }
    // asymmetric: A ω₁ ω₁' …: with A > B > C and energy beyond the separatrix about the largest axis
    let inertia = [3.0f64, 2.0, 1.0];
    for (k, w) in [[1.0, 0.0, 0.2], [1.0, 0.0, 0.9], [0.3, 0.0, 2.0]]
        .into_iter()
        .enumerate()
    {
        let [a, b, c] = inertia;
        let energy = a * w[0] * w[0] + c * w[2] * w[2];
        let momentum = a * a * w[0] * w[0] + c * c * w[2] * w[2];
        // L² > 2 T B: the body turns round its axis of largest inertia
        let about_largest = momentum > energy * b;
        let (i, k1) = if about_largest { (0, 2) } else { (2, 0) };
        let (p, q) = (inertia[i], inertia[k1]);
        let w1 = w[i];
        let w3 = w[k1];
        let m = (momentum - energy * q).abs();
        let n = (energy * p - momentum).abs();
        let rate = (m * (p - b).abs() / (a * b * c)).sqrt();
        let parameter = n * (b - q).abs() / (m * (p - b).abs());
        let text = free_body(1.0, inertia, [0.0; 3], w);
        let columns = ["WX(20,1,20)", "WY(20,1,20)", "WZ(20,1,20)"];
        all.push(
            scene(f, format!("asymmetric body {k}"), text)
                .end(10.0)
                .error(1e-10)
                .follows(
                    columns[i],
                    move |t| w1 * jacobi(rate * t, parameter)[2],
                    1e-6,
                )
                .follows(
                    columns[k1],
                    move |t| w3 * jacobi(rate * t, parameter)[1],
                    1e-6,
                ),
        );
    }
    all
}

fn friction() -> Vec<Scene> {
    let f = "friction";
    let mut all = Vec::new();
    let stops = |v: f64, mu: f64| {
        move |t: f64| {
            let t = t.min(v / mu);
            v * t - mu * t * t / 2.0
        }
    };
    for method in ["DOP853", "RADAU5", "BDF", "HHT"] {
        for mu in [0.5, 5.0] {
            let text = slider(1.0, 0.0, 1.0) + &push(&format!("-SIGN({mu},VX(20,1))"));
            let (error, tolerance) = if method == "HHT" {
                (1e-5, 1e-3)
            } else {
                (1e-8, 1e-4)
            };
            all.push(
                scene(f, format!("a block is stopped by {mu}"), text)
                    .method(method)
                    .end(3.0)
                    .error(error)
                    .follows("DX(20,1)", stops(1.0, mu), tolerance),
            );
        }
    }
    for pull in [0.5, 0.99] {
        let text = slider(1.0, 0.0, 0.0) + &push(&format!("{pull}-SIGN(1,VX(20,1))"));
        all.push(
            scene(f, format!("held against {pull} of its friction"), text).follows(
                "DX(20,1)",
                |_| 0.0,
                1e-9,
            ),
        );
    }
    let text = slider(1.0, 0.0, 0.0) + &push("TIME-SIGN(1,VX(20,1))");
    all.push(
        scene(f, "breaks away when the pull exceeds friction", text)
            .end(3.0)
            .follows("DX(20,1)", |t| (t - 1.0).max(0.0).powi(3) / 6.0, 1e-5),
    );
    // an oscillator loses four friction lengths a cycle
    let text = slider(1.0, 1.05, 0.0) + &push("-DX(20,1)-SIGN(0.1,VX(20,1))");
    all.push(
        scene(f, "an oscillator loses four friction lengths a cycle", text)
            .end(5.0 * PI)
            .steps(5)
            .follows(
                "DX(20,1)",
                |t| {
                    let n = (t / PI).round() as i32;
                    let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
                    sign * (1.05 - 0.2 * f64::from(n))
                },
                1e-4,
            ),
    );
    // a belt carries a block: constant friction until it has the belt's speed
    let text = slider(1.0, 0.0, 0.0) + &push("SIGN(2,1-VX(20,1))");
    all.push(scene(f, "a belt carries a block", text).end(2.0).follows(
        "VX(20,1)",
        |t| (2.0 * t).min(1.0),
        1e-5,
    ));
    all
}

fn jumps() -> Vec<Scene> {
    let f = "jumps";
    let mut all = Vec::new();
    for at in [0.3, 0.5, 0.987_654_321] {
        let text = slider(1.0, 0.0, 0.0) + &push(&format!("IF(TIME-{at}: 0, 1, 1)"));
        all.push(scene(f, format!("a force begins at {at}"), text).follows(
            "DX(20,1)",
            move |t| (t - at).max(0.0).powi(2) / 2.0,
            1e-9,
        ));
    }
    for x in [1e-3, 1.0, 1e3] {
        // x'' = −sign x: parabolas of quarter period √(2x)
        let text = slider(1.0, x, 0.0) + &push("IF(DX(20,1): 1, 0, -1)");
        all.push(
            scene(f, format!("a force that changes sides from {x}"), text)
                .end(4.0 * (2.0 * x).sqrt())
                .steps(8)
                .follows(
                    "DX(20,1)",
                    move |t| {
                        let quarter = (2.0 * x).sqrt();
                        let s = (t / quarter) % 4.0;
                        let half = |u: f64| x - (u * quarter).powi(2) / 2.0;
                        if s <= 1.0 {
                            half(s)
                        } else if s <= 3.0 {
                            -half(s - 2.0)
                        } else {
                            half(4.0 - s)
                        }
                    },
                    1e-5 * x,
                ),
        );
    }
    for k in [1e3, 1e6, 1e9] {
        // a ball dropped on a linear stop without damping returns to its height
        let text = slider(1.0, 1.0, 0.0)
            + &push(&format!("-10+IMPACT(DX(20,1),VX(20,1),0,{k:e},1,0,1E-6)"));
        let w = f64::sqrt(k);
        let v = 20f64.sqrt();
        // time in contact: w t = π + 2 atan(g/(w v))
        let contact = (PI + 2.0 * (10.0 / (w * v)).atan()) / w;
        let fall = 0.2f64.sqrt();
        let period = 2.0 * fall + contact;
        all.push(
            scene(f, format!("a ball on a stop of {k:e}"), text)
                .end(3.0 * period)
                .steps(3)
                .follows("DX(20,1)", |_| 1.0, 1e-4),
        );
    }
    let text = slider(1.0, 0.0, 0.0) + &push("STEP(TIME,0.2,0,0.2001,1)");
    all.push(scene(f, "a step in a ten-thousandth", text).follows(
        "VX(20,1)",
        |t| {
            if t < 0.2 {
                0.0
            } else {
                (t - 0.200_05).max(0.0)
            }
        },
        1e-6,
    ));
    let text = "DIFF/1, IC=0, FUNCTION=SIGN(1,SIN(10*PI*TIME+0.1))\n";
    all.push(
        scene(f, "a square wave integrated", text)
            .end(2.0)
            .steps(10)
            .follows(
                "DIF(1)",
                |t| {
                    let fold = |x: f64| {
                        let u = x.rem_euclid(TAU);
                        if u < PI { u } else { TAU - u }
                    };
                    (fold(10.0 * PI * t + 0.1) - 0.1) / (10.0 * PI)
                },
                1e-8,
            ),
    );
    for method in ["DOP853", "RADAU5", "BDF"] {
        let text = "DIFF/1, IC=0, FUNCTION=ABS(COS(TIME))\n";
        all.push(
            scene(f, "a rectified cosine", text)
                .method(method)
                .end(10.0)
                .follows(
                    "DIF(1)",
                    |t| {
                        let n = (t / PI + 0.5).floor();
                        2.0 * n + (t - n * PI).sin()
                    },
                    1e-5,
                ),
        );
    }
    all
}

fn short_forces() -> Vec<Scene> {
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

fn no_value() -> Vec<Scene> {
    let f = "no value";
    let one = |name: &str, function: &str, words: &'static str| {
        scene(f, name, slider(1.0, 0.0, 0.0) + &push(function)).ends(words)
    };
    vec![
        one("a root of what becomes negative", "SQRT(0.5-TIME)", "SQRT"),
        one(
            "a logarithm of what becomes negative",
            "LOG(0.5-TIME)",
            "LOG",
        ),
        one("an arc sine beyond one", "ASIN(2*TIME)", "ASIN"),
        one("a pole", "1/(TIME-0.5)", "SFORCE/1"),
        one("a tangent", "TAN(PI*TIME)", "SFORCE/1"),
        one("a power of what becomes negative", "(0.5-TIME)**1.5", "**"),
        one("a root of its own position", "SQRT(0.1-DX(20,1))", "SQRT"),
        one("an overflow", "EXP(2000*TIME)", "no finite value"),
        scene(
            f,
            "a side that is not taken has no value",
            slider(1.0, 0.0, 0.0) + &push("IF(TIME-2: 1, SQRT(TIME-2), SQRT(TIME-2))"),
        )
        .follows("DX(20,1)", |t| t * t / 2.0, 1e-9),
        scene(
            f,
            "a differential equation explodes",
            "DIFF/1, IC=1, FUNCTION=DIF(1)**2\n",
        )
        .end(2.0)
        .ends("DIFF/1"),
    ]
}

fn redundant() -> Vec<Scene> {
    let f = "redundant";
    let mut all = Vec::new();
    // a planar four-bar of revolutes, crank 1, coupler 4, rocker 3, ground 4
    let bars = |drive: &str| {
        // crank along x: rocker pin by intersection of circles about (1,0) r 4 and (4,0) r 3
        let (d, r, s) = (3.0f64, 4.0f64, 3.0f64);
        let a = (d * d + r * r - s * s) / (2.0 * d);
        let h = (r * r - a * a).sqrt();
        let (x, y) = (1.0 + a, h);
        format!(
            "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=1,0,0\n\
             PART/3, MASS=1, CM=30, IP=1,1,1, QG=1,0,0\nMARKER/30, PART=3\nMARKER/31, PART=3, QP={:?},{y:?},0\n\
             PART/4, MASS=1, CM=40, IP=1,1,1, QG=4,0,0\nMARKER/40, PART=4\nMARKER/41, PART=4, QP={:?},{y:?},0\n\
             MARKER/12, PART=1, QP=4,0,0\n\
             JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, REVOLUTE, I=30, J=21\n\
             JOINT/3, REVOLUTE, I=31, J=41\nJOINT/4, REVOLUTE, I=40, J=12\n{drive}",
            x - 1.0,
            x - 4.0
        )
    };
    // closed form of the rocker's pin
    let pin = |t: f64| {
        let a = TAU * t;
        let (px, py) = (a.cos(), a.sin());
        let (dx, dy) = (4.0 - px, -py);
        let d = (dx * dx + dy * dy).sqrt();
        let along = (d * d + 16.0 - 9.0) / (2.0 * d);
        let h = (16.0 - along * along).sqrt();
        [
            px + (along * dx - h * dy) / d,
            py + (along * dy + h * dx) / d,
        ]
    };
    for steps in [12, 40] {
        all.push(
            scene(
                f,
                format!("a planar four-bar of revolutes, {steps} outputs"),
                bars("MOTION/1, JOINT=1, ROTATION, FUNCTION=2*PI*TIME\n"),
            )
            .kinematic()
            .steps(steps)
            .follows("DX(31,1)", move |t| pin(t)[0], 1e-9)
            .follows("DY(31,1)", move |t| pin(t)[1], 1e-9),
        );
    }
    // a door on n hinges
    for n in [2, 3, 5] {
        let mut text = "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2, QP=1,0,0\n".to_string();
        for k in 0..n {
            text += &format!(
                "MARKER/2{}, PART=2, QP=0,0,{k}\nMARKER/1{}, PART=1, QP=0,0,{k}\nJOINT/{}, REVOLUTE, I=2{}, J=1{}\n",
                k + 1,
                k + 1,
                k + 1,
                k + 1,
                k + 1
            );
        }
        text += "SFORCE/1, ROTATION, I=21, J=11, FUNCTION=2\n";
        // inertia about the hinge: 1 + 1
        all.push(scene(f, format!("a door on {n} hinges"), text).follows(
            "AZ(21,11)",
            |t| t * t / 2.0,
            1e-7,
        ));
    }
    // a table carried by three and by four legs of one guide: forces add up to its weight
    for n in [2, 4] {
        let mut text =
            "PART/2, MASS=4, CM=20, IP=1,1,1\nMARKER/20, PART=2\nACCGRAV/KGRAV=-10\n".to_string();
        let mut sum = Vec::new();
        for k in 0..n {
            let angle = TAU * f64::from(k) / f64::from(n);
            text += &format!(
                "MARKER/2{}, PART=2, QP={:?},{:?},0\nMARKER/1{}, PART=1, QP={:?},{:?},0\nJOINT/{}, FIXED, I=2{}, J=1{}\n",
                k + 1,
                angle.cos(),
                angle.sin(),
                k + 1,
                angle.cos(),
                angle.sin(),
                k + 1,
                k + 1,
                k + 1
            );
            sum.push(format!("JOINT({},0,4,1)", k + 1));
        }
        all.push(
            scene(f, format!("a table fixed by {n} legs"), text)
                .kinematic()
                .follows(sum.join("+"), |_| 40.0, 1e-9),
        );
    }
    // two constraints that say the same of a free body
    let text = free_body(1.0, [1.0; 3], [1.0, 0.0, 0.0], [0.0; 3])
        + "JPRIM/1, INPLANE, I=20, J=1\nJPRIM/2, INPLANE, I=20, J=1\nACCGRAV/KGRAV=-10\n";
    all.push(
        scene(f, "a plane twice", text)
            .follows("DX(20,1)", |t| t, 1e-9)
            .follows("DZ(20,1)", |_| 0.0, 1e-12),
    );
    // contradictions are refused
    let text = slider(1.0, 0.0, 0.0)
        + "MOTION/1, JOINT=1, TRANSLATION, FUNCTION=TIME\nMARKER/12, PART=1, QP=0,0,0\nMOTION/2, I=20, J=1, X, FUNCTION=2*TIME+1\n";
    all.push(scene(f, "two motions that contradict", text).ends("MOTION"));
    all
}

fn long() -> Vec<Scene> {
    let f = "long";
    let text = slider(1.0, 1.0, 0.0) + &push("-DX(20,1)");
    vec![
        scene(f, "a thousand periods", text)
            .end(1000.0 * TAU)
            .steps(4)
            .error(1e-11)
            .follows("DX(20,1)", f64::cos, 1e-5),
        scene(f, "a decay to nothing", "DIFF/1, IC=1, FUNCTION=-DIF(1)\n")
            .end(1e4)
            .steps(5)
            .follows("DIF(1)", |t| (-t).exp(), 1e-6),
        scene(
            f,
            "a million seconds of a constant rate",
            "DIFF/1, IC=0, FUNCTION=1\n",
        )
        .end(1e6)
        .follows("DIF(1)", |t| t, 1e-6),
        scene(
            f,
            "free flight for a year",
            free_body(1.0, [1.0; 3], [1.0, 2.0, 3.0], [0.0; 3]),
        )
        .end(3.156e7)
        .follows("DZ(20,1)", |t| 3.0 * t, 1e-3),
        scene(
            f,
            "a spinning ball for an hour",
            free_body(1.0, [1.0; 3], [0.0; 3], [0.0, 0.0, 1.0]),
        )
        .end(3600.0)
        .steps(4)
        .error(1e-10)
        .follows("DX(21,20)", f64::cos, 1e-4),
    ]
}

fn many_outputs() -> Vec<Scene> {
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
        let text = slider(1.0, 1.0, 0.0) + &push("-100*DX(20,1)");
        all.push(
            scene(f, format!("an oscillator with {steps} outputs"), text)
                .steps(steps)
                .follows("DX(20,1)", |t| (10.0 * t).cos(), 1e-5),
        );
    }
    all
}

fn large() -> Vec<Scene> {
    let f = "large";
    let mut all = Vec::new();
    for n in [5usize, 20, 60] {
        // n masses on a rail between n + 1 springs, in their first mode
        let mut text = "MARKER/11, PART=1, REULER=90D,90D,0\n".to_string();
        let shape = move |i: usize| ((i as f64) * PI / (n as f64 + 1.0)).sin();
        for i in 1..=n {
            text += &format!(
                "PART/{0}, MASS=1, CM={1}, QG={2:?},0,0\nMARKER/{1}, PART={0}, REULER=90D,90D,0\nJOINT/{0}, TRANSLATIONAL, I={1}, J=11\n",
                i + 1,
                1000 + i,
                i as f64 + 0.1 * shape(i)
            );
        }
        text += &format!(
            "MARKER/1000, PART=1\nMARKER/{}, PART=1, QP={},0,0\n",
            1001 + n,
            n + 1
        );
        for i in 0..=n {
            text += &format!(
                "SPRINGDAMPER/{}, TRANSLATION, I={}, J={}, K=100, LENGTH=1\n",
                i + 1,
                1001 + i,
                1000 + i
            );
        }
        let w = 20.0 * (PI / (2.0 * (n as f64 + 1.0))).sin();
        let i = n.div_ceil(2);
        all.push(
            scene(f, format!("{n} masses in their first mode"), text)
                .end(TAU / w)
                .follows(
                    format!("DX({},1000)", 1000 + i),
                    move |t| i as f64 + 0.1 * shape(i) * (w * t).cos(),
                    1e-6,
                ),
        );
    }
    let mut text = "ACCGRAV/KGRAV=-10\n".to_string();
    for i in 2..60 {
        text +=
            &format!("PART/{i}, MASS={i}, CM={i}, QG={i},0,0, IP=1,1,1\nMARKER/{i}, PART={i}\n");
    }
    all.push(
        scene(f, "58 bodies fall alike", text)
            .follows("DZ(2,1)", |t| -5.0 * t * t, 1e-9)
            .follows("DZ(59,2)", |_| 0.0, 1e-12),
    );
    all
}

fn circular() -> Vec<Scene> {
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

fn rest() -> Vec<Scene> {
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
