//! What the programs read but do not compute, the past and closures for USER, with every method: the same answers within what was asked for.

use crate::running;

use running::{Analysis, go, off, session_by};

const METHODS: [&str; 5] = ["DOP853", "RADAU5", "BDF", "HHT", "NEWMARK"];
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
