//! Many bodies.

use crate::scene::{Scene, scene};
use std::f64::consts::{PI, TAU};

/// The scenes of this family.
pub fn large() -> Vec<Scene> {
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
