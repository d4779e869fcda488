//! Where errors of many swings have added up to a part of a swing, a run says so; and nowhere else.

use crate::running;

use cognate::results::Status;
use running::{Analysis, go, off, session_by, try_to};
use std::f64::consts::TAU;

const METHODS: [&str; 6] = ["AUTO", "DOP853", "RADAU5", "BDF", "HHT", "NEWMARK"];

/// A mass of 2 at x = 0.5 along x with ω = 5, and what acts besides.
fn oscillator(force: &str) -> String {
    format!(
        "PART/2, MASS=2, CM=2, IP=1,1,1, QG=0.5,0,0\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=3, J=4\n\
         MARKER/3, PART=2, REULER=90D,90D,0\nMARKER/4, PART=1, REULER=90D,90D,0\n\
         SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=3, J=4, FUNCTION=-50*DX(2,1){force}\n"
    )
}

fn is_told(s: &running::Session) -> bool {
    let said = s.run.record.warned();
    let words = ["the phase of about", "the balance of energy"];
    said.iter().any(|s| words.iter().any(|w| s.contains(w)))
}

#[test]
fn swings_that_are_no_longer_in_phase_say_so_by_every_method() {
    let mut found = [0, 0];
    for method in METHODS {
        for exponent in 1..=4 {
            for swings in [30.0, 1000.0] {
                let error = 10f64.powi(-exponent);
                let mut s = session_by(&oscillator(""), &["DX(2,1)"], method, error);
                let end = swings * TAU / 5.0;
                if try_to(&mut s, Analysis::Dynamic, end, 64) == Status::Limit {
                    continue;
                }
                // over the amplitude: an error of the phase of as many rad
                let lost = off(&s, "DX(2,1)", |t| 0.5 * (5.0 * t).cos()) / 0.5;
                let told = is_told(&s);
                println!("{method} {error:e} {swings}: {lost:.1e} {told}");
                assert!(told || lost < 0.8, "{method} {error:e}: {lost}");
                assert!(!told || lost > 0.05, "{method} {error:e}: {lost}");
                found[usize::from(told)] += 1;
            }
        }
    }
    assert!(found[0] > 10 && found[1] > 2, "{found:?}");
}

#[test]
fn wide_swings_lose_their_phase_by_their_energy() {
    // from the level: the time of a swing depends on its width
    let text = "PART/2, MASS=1, CM=2\nMARKER/2, PART=2, QP=1,0,0\nMARKER/3, PART=2\n\
                JOINT/1, REVOLUTE, I=3, J=1\nACCGRAV/JGRAV=-9.81\n";
    let end = 1000.0;
    for method in ["AUTO", "RADAU5"] {
        for exponent in [2, 4, 6] {
            let place = |method: &str, error: f64| {
                let mut s = session_by(text, &["AZ(3,1)"], method, error);
                go(&mut s, Analysis::Dynamic, end, 3);
                (running::last(&s, "AZ(3,1)"), is_told(&s))
            };
            let error = 10f64.powi(-exponent);
            let ((at, told), (exact, _)) = (place(method, error), place("AUTO", 1e-11));
            let lost = (at - exact).abs();
            println!("{method} {error:e}: {lost:.1e} {told}");
            assert!(told || lost < 1.0, "{method} {error:e}: {lost}");
            assert!(!told || lost > 0.05, "{method} {error:e}: {lost}");
        }
    }
}

#[test]
fn what_is_damped_or_driven_against_damping_loses_no_phase() {
    for force in ["-2*VX(2,1)", "-2*VX(2,1)+10*SIN(3*TIME)"] {
        for method in METHODS {
            let mut s = session_by(&oscillator(force), &[], method, 1e-3);
            go(&mut s, Analysis::Dynamic, 1000.0, 10);
            assert!(!is_told(&s), "{force} {method}");
        }
    }
}

/// Swings of van der Pol's equation, wide and narrow: they excite themselves, come back
/// to their width, and keep what a push did to their phase.
#[test]
fn swings_of_van_der_pol_that_are_no_longer_in_phase_say_so() {
    let mut found = [0, 0];
    let cases: [(&str, f64); 2] = [
        ("+20*(1-DX(2,1)**2)*VX(2,1)", 40.0),
        ("+4*(1-DX(2,1)**2)*VX(2,1)", 150.0),
    ];
    for (force, end) in cases {
        let place = |method: &str, error: f64| {
            let mut s = session_by(&oscillator(force), &["DX(2,1)"], method, error);
            let status = try_to(&mut s, Analysis::Dynamic, end, 2000);
            let told = is_told(&s);
            (running::values(&s, "DX(2,1)").to_vec(), told, status)
        };
        let (exact, ..) = place("AUTO", 1e-11);
        let widest = exact.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        for method in METHODS {
            for exponent in [1, 2, 3] {
                let (found_at, told, status) = place(method, 10f64.powi(-exponent));
                if status == Status::Limit {
                    continue;
                }
                let pairs = found_at.iter().zip(&exact).rev().take(40);
                let lost = pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / widest;
                println!("{method} 1e-{exponent} {end}: {lost:.1e} {told}");
                assert!(told || lost < 0.8, "{method} 1e-{exponent} {force}: {lost}");
                assert!(
                    !told || lost > 0.02,
                    "{method} 1e-{exponent} {force}: {lost}"
                );
                found[usize::from(told)] += 1;
            }
        }
    }
    assert!(found[0] > 10 && found[1] > 2, "{found:?}");
}

/// Masses that a belt takes along until a spring tears them off, by laws of friction far steeper
/// than the speed of the belt: implicit methods took the steep slope of sticking for that of what
/// slips already, and broke away late without a word.
#[test]
fn masses_on_belts_break_away_in_time_or_say_that_they_may_not() {
    let belts: [(&str, f64); 4] = [
        (
            "-134.93*DX(2,1)-165.02*MAX(-1,MIN(1,(VX(2,1)-1.1321)/2.485e-05))\
             *(1-0.3627*STEP(ABS(VX(2,1)-1.1321),2.485e-05,0,0.2435,1))",
            16.0,
        ),
        (
            "-186.35*DX(2,1)-0.273*VX(2,1)-119.57*TANH((VX(2,1)-0.64992)/0.000101)\
             *(1-0.4214*STEP(ABS(VX(2,1)-0.64992),0.000101,0,0.3204,1))",
            7.0,
        ),
        (
            "-57.91*DX(2,1)-0.1522*VX(2,1)-57.978*STEP((VX(2,1)-0.54306),-3.431e-05,-1,3.431e-05,1)\
             *(0.3128+0.6872*EXP(-ABS(VX(2,1)-0.54306)/0.5782))",
            50.0,
        ),
        // a clock: what drives it jumps as the pendulum turns back
        ("-25*DX(2,1)-0.5*VX(2,1)+0.5*TANH(VX(2,1)/0.001)", 60.0),
    ];
    let mut found = [0, 0];
    for (force, end) in belts {
        let text = oscillator("").replace("MASS=2", "MASS=1");
        let text = text.replace("QG=0.5,0,0", "QG=0.05,0,0");
        let text = text.replace("-50*DX(2,1)", force);
        let place = |method: &str, error: f64| {
            let mut s = session_by(&text, &["DX(2,1)"], method, error);
            let status = try_to(&mut s, Analysis::Dynamic, end, 1000);
            let told = is_told(&s);
            (running::values(&s, "DX(2,1)").to_vec(), told, status)
        };
        let (exact, ..) = place("AUTO", 1e-10);
        let widest = exact.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        for method in METHODS {
            for exponent in [2, 3, 4, 5] {
                let request = 10f64.powi(-exponent);
                let (found_at, told, status) = place(method, request);
                if status != Status::Completed {
                    continue;
                }
                let pairs = found_at.iter().zip(&exact).rev().take(100);
                let lost = pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / widest;
                println!("{method} {request:e} {end}: {lost:.1e} {told}");
                let permitted = (400.0 * request).min(0.8);
                assert!(
                    told || lost < permitted,
                    "{method} {request:e} {force}: {lost}"
                );
                found[usize::from(told)] += 1;
            }
        }
    }
    assert!(found[0] > 30 && found[1] > 10, "{found:?}");
}

#[test]
fn outputs_change_nothing_about_it() {
    for steps in [1, 50, 700] {
        let mut s = session_by(&oscillator(""), &[], "HHT", 1e-2);
        go(&mut s, Analysis::Dynamic, 1000.0, steps);
        assert!(is_told(&s), "{steps}");
    }
}

/// Equal masses in a row between walls, on equal springs, with any velocities: the modes are known.
struct Row {
    n: usize,
    stiffness: f64,
    velocities: Vec<f64>,
}

impl Row {
    fn text(&self) -> String {
        let mut text = String::from("MARKER/4, PART=1, REULER=90D,90D,0\n");
        for (k, v) in (10..).zip(&self.velocities) {
            text += &format!(
                "PART/{k}, MASS=1, CM={k}, IP=1,1,1, VX={v}\nMARKER/{k}, PART={k}\nMARKER/{k}0, PART={k}, REULER=90D,90D,0\n\
                 JOINT/{k}, TRANSLATIONAL, I={k}0, J=4\n"
            );
        }
        let last = 9 + self.n;
        for k in 10..=last {
            let place = |k: usize| {
                if (10..=last).contains(&k) {
                    format!("DX({k},1)")
                } else {
                    "0".into()
                }
            };
            text += &format!(
                "SFORCE/{k}, TRANSLATIONAL, ACTIONONLY, I={k}0, J=4, FUNCTION={:?}*({}-2*{}+{})\n",
                self.stiffness,
                place(k - 1),
                place(k),
                place(k + 1)
            );
        }
        text
    }

    /// Frequency of a mode, rad/s.
    fn frequency(&self, mode: usize) -> f64 {
        2.0 * self.stiffness.sqrt() * (self.angle(1, mode) / 2.0).sin()
    }

    fn angle(&self, k: usize, mode: usize) -> f64 {
        (k * mode) as f64 * std::f64::consts::PI / (self.n + 1) as f64
    }

    /// Where mass `k` (from 1) is.
    fn at(&self, k: usize, t: f64) -> f64 {
        let modes = (1..=self.n).map(|mode| {
            let share: f64 = (1..)
                .zip(&self.velocities)
                .map(|(j, v)| v * self.angle(j, mode).sin())
                .sum();
            let w = self.frequency(mode);
            2.0 / (self.n + 1) as f64 * share * self.angle(k, mode).sin() * (w * t).sin() / w
        });
        modes.sum()
    }
}

/// The error that undamped swings add up is in proportion to their number and to the request: beyond a hundred requests a run says so
/// by every method, and none that is off by few says it.
#[test]
fn errors_of_swings_with_several_frequencies_that_add_up_are_told() {
    let rows = [
        (1, 30.0, vec![0.7]),
        (3, 400.0, vec![1.0, -0.3, 0.2]),
        (8, 7.0, vec![0.0, 0.4, 0.0, 0.0, -1.0, 0.3, 0.0, 0.2]),
    ];
    let mut found = [0, 0];
    for (n, stiffness, velocities) in rows {
        let row = Row {
            n,
            stiffness,
            velocities,
        };
        for method in METHODS {
            let many = match method {
                "HHT" | "NEWMARK" => [10.0, 100.0],
                "BDF" => [10.0, 300.0],
                _ => [100.0, 3000.0],
            };
            for swings in many {
                for error in [1e-2, 1e-3] {
                    let column = "DX(10,1)";
                    let mut s = session_by(&row.text(), &[column], method, error);
                    // no output meets the beginning of a swing again and again
                    let end = (swings + 0.37) * TAU / row.frequency(n);
                    if try_to(&mut s, Analysis::Dynamic, end, 500) == Status::Limit {
                        continue;
                    }
                    let at = running::values(&s, column);
                    let times = (0..at.len()).map(|k| end * k as f64 / 500.0);
                    let exact: Vec<f64> = times.map(|t| row.at(1, t)).collect();
                    let widest = exact.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                    let pairs = at.iter().zip(&exact);
                    let lost = pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
                    let requests = lost / widest / error;
                    let adds_up = s
                        .run
                        .record
                        .warned()
                        .iter()
                        .any(|w| w.contains("errors add up"));
                    println!("{n} {swings} {method} {error:e}: {requests:.1} {adds_up}");
                    assert!(
                        adds_up || is_told(&s) || requests < 100.0,
                        "{n} {swings} {method} {error:e}: {requests}"
                    );
                    assert!(
                        !adds_up || requests > 5.0,
                        "{n} {swings} {method} {error:e}: {requests}"
                    );
                    found[usize::from(adds_up)] += 1;
                }
            }
        }
    }
    assert!(found[0] >= 10 && found[1] >= 8, "{found:?}");
}

#[test]
fn errors_of_swings_that_are_damped_do_not_add_up() {
    for force in ["-0.5*VX(2,1)", "-0.5*VX(2,1)+10*SIN(3*TIME)"] {
        for method in METHODS {
            let mut s = session_by(&oscillator(force), &[], method, 1e-3);
            go(&mut s, Analysis::Dynamic, 400.0, 10);
            let said = s.run.record.warned();
            assert!(
                !said.iter().any(|w| w.contains("errors add up")),
                "{method} {force}"
            );
        }
    }
}

#[test]
fn swings_that_are_small_beside_their_model_say_what_that_makes_of_their_errors() {
    let omega = 5.0;
    let mut found = [0, 0];
    for (at, share) in [(0.6, 1e-3), (0.6, 2e-7), (30.0, 1e-4), (100.0, 1e-7)] {
        let width = at * share;
        let text = format!(
            "PART/2, MASS=2, CM=2, IP=1,1,1, QG={},0,0\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=3, J=4\n\
             MARKER/3, PART=2, REULER=90D,90D,0\nMARKER/4, PART=1, REULER=90D,90D,0\nMARKER/5, PART=1, QP={at},0,0\n\
             SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=3, J=4, FUNCTION=-50*DX(2,5)\n",
            at + width
        );
        for error in [1e-2, 1e-4, 1e-6] {
            for method in ["AUTO", "RADAU5", "BDF"] {
                let mut s = session_by(&text, &["VX(2,1)"], method, error);
                go(&mut s, Analysis::Dynamic, 3.0, 40);
                let exact = |t: f64| -width * omega * (omega * t).sin();
                let off = off(&s, "VX(2,1)", exact) / (width * omega * error);
                let said = s.run.record.warned();
                let told = said
                    .iter()
                    .any(|w| w.starts_with("nothing moves by more than"));
                println!("{at} {share:e} {error:e} {method}: {off:.1} requests, {told}");
                assert!(
                    told || off < 100.0,
                    "{at} {share:e} {error:e} {method}: {off}"
                );
                assert!(
                    !told || share < 1e-4,
                    "{at} {share:e} {error:e} {method}: {said:?}"
                );
                found[usize::from(told)] += 1;
            }
        }
    }
    assert!(found.iter().all(|&n| n >= 9), "{found:?}");
}

#[test]
fn what_an_equilibrium_has_left_to_settle_is_no_small_motion() {
    // a hanging mass, found to the tolerance of statics; then a hum that is small, and matters
    let text = |more: &str| {
        format!(
            "PART/2, MASS=2, CM=2, IP=1,1,1, QG=0,0,-1.2\nMARKER/2, PART=2\nJPRIM/1, ORIENTATION, I=2, J=1\n\
             SPRINGDAMPER/1, TRANSLATION, I=2, J=1, K=300, C=0.1, LENGTH=1\nACCGRAV/KGRAV=-9.81\n\
             BUSHING/1, I=2, J=1, K=20,20,1, KT=0,0,0\n\
             SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=1, FUNCTION={more}\n"
        )
    };
    let told = |text: &str, rest_first: bool| {
        let mut s = session_by(text, &["VZ(2,1)"], "AUTO", 1e-3);
        s.model.equilibrium.error = Some(1e-3);
        s.model.equilibrium.imbalance = Some(1e-2);
        if rest_first {
            go(&mut s, Analysis::Static, 0.0, 1);
        }
        go(&mut s, Analysis::Dynamic, 3.0, 40);
        let said = s.run.record.warned();
        said.iter()
            .any(|w| w.starts_with("nothing moves by more than"))
    };
    assert!(!told(&text("0"), true));
    assert!(told(&text("1E-5*SIN(20*TIME)"), true));
}
