//! What the programs read but do not compute, the past and closures for USER, with every method: the same answers within what was asked for.

use crate::running;

use running::{Analysis, begin, go, model, off, options_by, session_by};

const METHODS: [&str; 2] = ["DOP853", "RADAU5"];
const REQUESTS: [f64; 2] = [1e-3, 1e-5];

const SLIDER: &str = "PART/2, MASS=1, CM=2\nMARKER/2, PART=2, REULER=90D,90D,0\nMARKER/3, PART=1, REULER=90D,90D,0\n\
                      JOINT/1, TRANSLATIONAL, I=2, J=3\n";

#[test]
fn a_closure_that_pulls_like_a_spring_gives_its_oscillation() {
    let text =
        format!("{SLIDER}SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=USER(1, 4)\n");
    for method in METHODS {
        for error in REQUESTS {
            let mut s = session_by(&text, &["DZ(2,3,3)"], method, error);
            s.register("1", &["DZ(2,3,3)", "VZ(2,3,3)"], |call, out| {
                let k = call.constants[1];
                out[0] = k * (1.0 - call.values[0]) - 0.4 * call.values[1];
            });
            go(&mut s, Analysis::Dynamic, 4.0, 40);
            // m ẍ + c ẋ + k (x − 1) = 0 from rest at 0
            let (a, w) = (0.2, (4.0_f64 - 0.04).sqrt());
            let exact = |t: f64| 1.0 - (-a * t).exp() * ((w * t).cos() + a / w * (w * t).sin());
            let off = off(&s, "DZ(2,3,3)", exact);
            println!(
                "{method} {error:e}: {off:.1e}, {} steps",
                s.run.record.counts.steps
            );
            assert!(off < 100.0 * error, "{method} {error:e}: {off:e}");
        }
    }
}

#[test]
fn a_closure_in_a_differential_equation_decays() {
    for method in METHODS {
        for error in REQUESTS {
            let text = "VARIABLE/1, FUNCTION=USER(7)\nDIFF/1, IC=2, FUNCTION=VARVAL(1)\n";
            let mut s = session_by(text, &["DIF(1)"], method, error);
            s.register("7", &["DIF(1)"], |call, out| out[0] = -3.0 * call.values[0]);
            go(&mut s, Analysis::Dynamic, 2.0, 20);
            let off = off(&s, "DIF(1)", |t| 2.0 * (-3.0 * t).exp());
            assert!(off < 100.0 * error, "{method} {error:e}: {off:e}");
        }
    }
}

#[test]
fn an_equation_with_delay_follows_its_polynomials() {
    for method in METHODS {
        for error in REQUESTS {
            let text = "DIFF/1, IC=1, FUNCTION=-DELAY(DIF(1),1,1)\n";
            let mut s = session_by(text, &["DIF(1)"], method, error);
            go(&mut s, Analysis::Dynamic, 3.0, 30);
            let piece = |t: f64, from: f64, n: i32, by: f64| (t - from).max(0.0).powi(n) / by;
            let exact = |t: f64| 1.0 - t + piece(t, 1.0, 2, 2.0) - piece(t, 2.0, 3, 6.0);
            let off = off(&s, "DIF(1)", exact);
            println!(
                "{method} {error:e}: {off:.1e}, {} steps",
                s.run.record.counts.steps
            );
            assert!(off < 100.0 * error, "{method} {error:e}: {off:e}");
        }
    }
}

#[test]
fn a_force_that_reads_the_past_of_a_body_pushes_it_later() {
    // ẍ = 1 for x(t − 0.5), which was 0 before: F = 1 + 2 x(t − 0.5)
    let text = format!(
        "{SLIDER}SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=1+2*DELAY(DZ(2,3,3),0.5,0)\n"
    );
    for method in METHODS {
        for error in REQUESTS {
            let mut s = session_by(&text, &["DZ(2,3,3)"], method, error);
            go(&mut s, Analysis::Dynamic, 1.5, 15);
            // pieces: t²/2, then 2 (t − ½)⁴/4!, then 4 (t − 1)⁶/6! more
            let exact = |t: f64| {
                let late = |by: f64| (t - by).max(0.0);
                t * t / 2.0 + late(0.5).powi(4) / 12.0 + late(1.0).powi(6) / 180.0
            };
            let off = off(&s, "DZ(2,3,3)", exact);
            assert!(off < 100.0 * error, "{method} {error:e}: {off:e}");
        }
    }
}

/// A crank, a rod and a slider under gravity, with lengths in a unit of which a metre has `scale`.
fn crank_rod_and_slider(scale: f64) -> String {
    let (crank, rod, both) = (0.05 * scale, 0.15 * scale, 0.2 * scale);
    let [small, large] = [1e-3, 1e-2].map(|inertia| inertia * scale * scale);
    let gravity = -9.80665 * scale;
    format!(
        "PART/2, MASS=2, CM=20, IP={small:?},{small:?},{small:?}, WZ=30\nMARKER/20, PART=2\nMARKER/21, PART=2, QP={crank:?},0,0\n\
         PART/3, MASS=0.5, CM=30, IP={large:?},{large:?},{large:?}, QG={crank:?},0,0\nMARKER/30, PART=3\nMARKER/31, PART=3, QP={rod:?},0,0\n\
         PART/4, MASS=1, CM=40, IP={small:?},{small:?},{small:?}, QG={both:?},0,0\nMARKER/40, PART=4\nMARKER/41, PART=4, REULER=90D,90D,0\n\
         MARKER/11, PART=1, REULER=90D,90D,0\nACCGRAV/JGRAV={gravity:?}\nJOINT/1, REVOLUTE, I=20, J=1\n\
         JOINT/2, SPHERICAL, I=30, J=21\nJOINT/3, CYLINDRICAL, I=31, J=40\nJOINT/4, TRANSLATIONAL, I=41, J=11\n"
    )
}

#[test]
fn the_unit_of_length_hardly_changes_the_steps_of_the_implicit_method() {
    let steps = [1.0, 1e3, 1e-3].map(|scale| {
        let options = options_by(&[], "RADAU5", 1e-5);
        let mut s = begin(model(&crank_rod_and_slider(scale)), "crank", options);
        go(&mut s, Analysis::Dynamic, 0.5, 50);
        s.run.record.counts.steps as f64
    });
    for other in steps {
        let ratio = other / steps[0];
        assert!((0.8..1.25).contains(&ratio), "{steps:?}");
    }
}
