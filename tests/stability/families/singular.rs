//! Dead points, open chains stretched out, loops that fold.

use crate::laws::free_body;
use crate::scene::{Scene, scene};
use std::f64::consts::TAU;

/// The scenes of this family.
pub fn singular() -> Vec<Scene> {
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
    // a rod hardly longer than its crank: the slider stays at the middle while the crank goes round behind it, and does not go through;
    // hardly shorter: the crank gets no further
    for (power, steps) in [(-9, 1), (-6, 3), (-6, 40), (-3, 7)] {
        let longer = 10f64.powi(power);
        let rod = 1.0 + longer;
        let text = crank_and_rod(rod) + "MOTION/1, JOINT=1, ROTATION, FUNCTION=2*PI*TIME\n";
        let exact = move |t: f64| {
            let a = TAU * t;
            // 1 + ε − |sin| without cancellation
            let near = (2.0 * longer + longer * longer + a.cos().powi(2)).sqrt();
            a.cos() + near
        };
        let name = format!("a rod longer than its crank by 1e{power}, {steps} outputs");
        all.push((scene(f, name, text).kinematic().steps(steps)).follows("DX(40,1)", exact, 1e-7));
        let text =
            crank_and_rod(1.0 - longer) + "MOTION/1, JOINT=1, ROTATION, FUNCTION=2*PI*TIME\n";
        let name = format!("a rod shorter than its crank by 1e{power}, {steps} outputs");
        all.push((scene(f, name, text).kinematic().steps(steps)).ends("MOTION/1 drives it past"));
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

/// A crank of length one on JOINT/1 along x, a rod, and a slider on the x axis with MARKER/40.
fn crank_and_rod(rod: f64) -> String {
    let x = 1.0 + rod;
    format!(
        "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=1,0,0\n\
         PART/3, MASS=1, CM=30, IP=1,1,1, QG=1,0,0\nMARKER/30, PART=3\nMARKER/31, PART=3, QP={rod:?},0,0\n\
         PART/4, MASS=1, CM=40, IP=1,1,1, QG={x:?},0,0\nMARKER/40, PART=4\nMARKER/41, PART=4, REULER=90D,90D,0\n\
         MARKER/11, PART=1, REULER=90D,90D,0\n\
         JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, REVOLUTE, I=30, J=21\n\
         JOINT/3, REVOLUTE, I=31, J=40\nJOINT/4, TRANSLATIONAL, I=41, J=11\n"
    )
}
