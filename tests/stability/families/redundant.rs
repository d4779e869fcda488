//! More conditions than freedoms.

use crate::laws::{free_body, slider};
use crate::scene::{Scene, scene};
use std::f64::consts::TAU;

/// The scenes of this family.
pub fn redundant() -> Vec<Scene> {
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
    all.extend(misaligned());
    // contradictions are refused
    let text = slider(1.0, 0.0, 0.0)
        + "MOTION/1, JOINT=1, TRANSLATION, FUNCTION=TIME\nMARKER/12, PART=1, QP=0,0,0\nMOTION/2, I=20, J=1, X, FUNCTION=2*TIME+1\n";
    all.push(scene(f, "two motions that contradict", text).ends("MOTION"));
    all
}

/// Doors on two hinges and three parallel legs, one axis of which is off: by little they move as if it were not, by more
/// they are refused.
fn misaligned() -> Vec<Scene> {
    let f = "redundant";
    let mut all = Vec::new();
    let door = |tilt: f64, shift: f64, both: bool| {
        let own = if both {
            format!("QP={shift:?},0,1, REULER=0,{tilt:?},0")
        } else {
            "QP=0,0,1".into()
        };
        format!(
            "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2, QP=1,0,0\nMARKER/21, PART=2\nMARKER/22, PART=2, {own}\n\
             MARKER/12, PART=1, QP={shift:?},0,1, REULER=0,{tilt:?},0\nJOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=22, J=12\n\
             SFORCE/1, ROTATION, I=21, J=1, FUNCTION=2\n"
        )
    };
    for both in [false, true] {
        for off in [1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5] {
            let name = |what: &str| {
                format!("a door, {what} of a hinge off by {off:e}, both markers {both}")
            };
            let moves = |name: String, text: String| {
                let s = scene(f, name, text).follows("AZ(21,1)", |t| t * t / 2.0, 1e-7);
                if off > 1e-9 {
                    s.tells("redundant but for a misalignment")
                } else {
                    s
                }
            };
            all.push(moves(name("the axis"), door(off, 0.0, both)));
            all.push(moves(name("the place"), door(0.0, off, both)));
        }
        for off in [1e-3, 1e-2] {
            all.push(
                scene(
                    f,
                    format!("a door, an axis off by {off:e}, both markers {both}"),
                    door(off, 0.0, both),
                )
                .ends("JOINT/2"),
            );
            all.push(
                scene(
                    f,
                    format!("a door, a place off by {off:e}, both markers {both}"),
                    door(0.0, off, both),
                )
                .ends("JOINT/2"),
            );
        }
    }
    // a plate on three parallel legs of 1, which swings as a pendulum does: φ̈ = −g sin φ / l, all mass in the plate
    let legs = |tilt: f64| {
        let mut text = String::from(
            "ACCGRAV/KGRAV=-9.81\nPART/9, MASS=2, CM=90, IP=1,1,1\nMARKER/90, PART=9, QP=0.5,0.4,-1\n",
        );
        for (k, (x, y)) in [(0.0, 0.0), (1.0, 0.0), (0.2, 1.0)].into_iter().enumerate() {
            let p = k + 2;
            let across = |tilt: f64| format!("REULER=0,{:?},0", std::f64::consts::FRAC_PI_2 + tilt);
            let last = if k == 2 { tilt } else { 0.0 };
            text += &format!(
                "PART/{p}, QG={x:?},{y:?},0\nMARKER/{p}1, PART={p}, {}\nMARKER/1{p}, PART=1, QP={x:?},{y:?},0, {}\n\
                 MARKER/{p}2, PART={p}, QP=0,0,-1, {}\nMARKER/9{p}, PART=9, QP={x:?},{y:?},-1, {}\n\
                 JOINT/{p}, REVOLUTE, I={p}1, J=1{p}\nJOINT/1{p}, REVOLUTE, I={p}2, J=9{p}\n",
                across(0.0),
                across(0.0),
                across(0.0),
                across(last)
            );
        }
        text + "SFORCE/1, ROTATION, I=21, J=12, FUNCTION=2*COS(AZ(21,12))+2*9.81*SIN(AZ(21,12))\n"
    };
    // the torque holds the weight and pushes by 2 cos φ: φ̈ = cos φ, so φ̇² = 2 sin φ
    for tilt in [0.0, 1e-8, 1e-6, 1e-5] {
        all.push(
            scene(
                f,
                format!("a plate on three legs, an axis tilted by {tilt:e}"),
                legs(tilt),
            )
            .balances("WZ(21,12,12)**2-2*SIN(AZ(21,12))", 2.0, 1e-4),
        );
    }
    for tilt in [1e-3, 1e-2] {
        all.push(
            scene(
                f,
                format!("a plate on three legs, an axis tilted by {tilt:e}"),
                legs(tilt),
            )
            .ends("JOINT/"),
        );
    }
    all
}
