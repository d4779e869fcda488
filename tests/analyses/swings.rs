//! How far off a run is: what it measures of itself, beside what is known to be right, in the motions in which errors
//! add up. Long swings, free and excited by themselves, orbits, rotors, belts.

use crate::running;

use cognate::analysis::session::{Accuracy, Options};
use cognate::results::{ChannelAccuracy, Status};
use running::{Analysis, Session, begin, go, model, session_by, try_to};
use std::f64::consts::TAU;

const METHODS: [&str; 3] = ["AUTO", "DOP853", "RADAU5"];

/// A mass of 2 at x = 0.5 along x with ω = 5, and what acts besides.
fn oscillator(force: &str) -> String {
    format!(
        "PART/2, MASS=2, CM=2, IP=1,1,1, QG=0.5,0,0\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=3, J=4\n\
         MARKER/3, PART=2, REULER=90D,90D,0\nMARKER/4, PART=1, REULER=90D,90D,0\n\
         SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=3, J=4, FUNCTION=-50*DX(2,1){force}\n"
    )
}

/// A session that measures how far off it is.
fn measuring(text: &str, column: &str, method: &str, error: f64) -> Session {
    let options = Options {
        columns: vec![column.to_string()],
        method: Some(method.into()),
        error: Some(error),
        max_steps: Some(300_000),
        accuracy: Accuracy::Digits,
        ..Options::default()
    };
    begin(model(text), "test", options)
}

/// What a run says of its column.
fn said(s: &Session) -> &ChannelAccuracy {
    let accuracy = s.run.record.accuracy.as_ref();
    let channel = accuracy.and_then(|a| a.channels.first());
    channel.unwrap_or_else(|| panic!("nothing is said: {:?}", s.run.record.warned()))
}

/// The error that 19 of 20 values have at most.
fn usual_error(values: &[f64], exact: &[f64]) -> f64 {
    let pairs = values.iter().rev().zip(exact.iter().rev());
    let mut errors: Vec<f64> = pairs.map(|(a, b)| (a - b).abs()).collect();
    errors.sort_by(f64::total_cmp);
    errors[(0.95 * errors.len() as f64).ceil() as usize - 1]
}

/// What is said of many runs beside what is right.
#[derive(Default)]
struct Said {
    /// error over what is said, and what is said over the error
    over: Vec<f64>,
    wide: Vec<f64>,
}

impl Said {
    /// Takes a run; `size`: of its values. What is larger than all that the column does is no error any more.
    fn take(&mut self, s: &Session, (error, size): (f64, f64), what: &str) {
        let channel = said(s);
        let bar = channel.usual_bar;
        let is_lost = channel.lost_from.is_some() || bar >= size;
        let over = if is_lost { 0.0 } else { error / bar };
        println!(
            "{what}: error {error:.1e}, said {bar:.1e} of {size:.1e}, lost {:?}",
            channel.lost_from
        );
        self.over.push(over);
        if !(is_lost && error > 0.1 * size) {
            self.wide.push(bar.min(size) / error.max(1e-12 * size));
        }
    }

    /// Claims that nearly all is within what is said, the rest by little, and that it is not said too wide.
    fn holds(mut self) {
        let all = self.over.len();
        let within = self.over.iter().filter(|over| **over <= 1.0).count();
        self.over.sort_by(f64::total_cmp);
        self.wide.sort_by(f64::total_cmp);
        let (worst, width) = (self.over[all - 1], self.wide[self.wide.len() / 2]);
        println!("{within} of {all} within, the worst {worst:.2}, {width:.1} times as wide");
        assert!(within as f64 >= 0.95 * all as f64, "{within} of {all}");
        assert!(worst < 5.0, "{worst}");
        assert!(width < 30.0, "{width}");
    }
}

#[test]
fn long_swings_say_how_far_off_they_are_by_every_method() {
    let mut found = Said::default();
    for method in METHODS {
        for exponent in [1, 2, 3, 5] {
            for swings in [30.0, 300.0] {
                let error = 10f64.powi(-exponent);
                let mut s = measuring(&oscillator(""), "DX(2,1)", method, error);
                let end = swings * TAU / 5.0;
                if try_to(&mut s, Analysis::Dynamic, end, 300) == Status::Limit {
                    continue;
                }
                let exact: Vec<f64> = (0..=300)
                    .map(|k| 0.5 * (5.0 * end * f64::from(k) / 300.0).cos())
                    .collect();
                let lost = usual_error(running::values(&s, "DX(2,1)"), &exact);
                found.take(&s, (lost, 1.0), &format!("{method} {error:e} {swings}"));
            }
        }
    }
    found.holds();
}

/// A problem whose right values are those of one at a much smaller request.
fn against_itself(text: &str, column: &str, end: f64, exponents: &[i32]) -> Said {
    let run = |method: &str, error: f64| {
        let mut s = measuring(text, column, method, error);
        let status = try_to(&mut s, Analysis::Dynamic, end, 500);
        (s, status)
    };
    let (exact, _) = run("AUTO", 1e-11);
    let exact = running::values(&exact, column).to_vec();
    let (low, high) = exact
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
            (l.min(*x), h.max(*x))
        });
    let mut found = Said::default();
    for method in METHODS {
        for exponent in exponents {
            let error = 10f64.powi(-exponent);
            let (s, status) = run(method, error);
            // beside one that came to no end nothing is measured, and that is told
            let unknown = |w: &String| w.contains("ends otherwise");
            if status == Status::Completed && !s.run.record.warned().iter().any(unknown) {
                let lost = usual_error(running::values(&s, column), &exact);
                found.take(
                    &s,
                    (lost, high - low),
                    &format!("{column} {method} {error:e}"),
                );
            }
        }
    }
    found
}

#[test]
fn wide_swings_of_a_pendulum_say_how_far_off_they_are() {
    // from the level: the time of a swing depends on its width
    let text = "PART/2, MASS=1, CM=2\nMARKER/2, PART=2, QP=1,0,0\nMARKER/3, PART=2\n\
                JOINT/1, REVOLUTE, I=3, J=1\nACCGRAV/JGRAV=-9.81\n";
    against_itself(text, "AZ(3,1)", 100.0, &[2, 4, 7]).holds();
}

/// Swings of van der Pol's equation excite themselves, come back to their width, and keep what a push did to their phase.
#[test]
fn swings_that_excite_themselves_say_how_far_off_they_are() {
    for (force, end) in [
        ("+20*(1-DX(2,1)**2)*VX(2,1)", 20.0),
        ("+4*(1-DX(2,1)**2)*VX(2,1)", 60.0),
    ] {
        against_itself(&oscillator(force), "DX(2,1)", end, &[2, 4]).holds();
    }
}

/// A body round a mass: an error of its energy moves it along its orbit ever farther, as the square of time.
#[test]
fn orbits_say_how_far_off_they_are() {
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1, QG=1,0,0, VY=1.1\nMARKER/2, PART=2\n\
                JPRIM/1, INPLANE, I=2, J=1\nJPRIM/2, ORIENTATION, I=2, J=1\n\
                SFORCE/1, TRANSLATION, I=2, J=1, FUNCTION=-1/DM(2,1)**2\n";
    against_itself(text, "DX(2,1)", 60.0, &[3, 5, 8]).holds();
}

/// A rotor that turns about the axis of the middle moment, and turns over again and again.
#[test]
fn rotors_that_turn_over_say_how_far_off_they_are() {
    let text = "PART/2, MASS=1, CM=2, IP=1,2,3, WX=1E-3, WY=2\nMARKER/2, PART=2\n";
    against_itself(text, "WX(2,1,2)", 30.0, &[3, 5, 8]).holds();
}

#[test]
fn what_is_damped_or_driven_against_damping_is_said_to_be_near() {
    for force in ["-2*VX(2,1)", "-2*VX(2,1)+10*SIN(3*TIME)"] {
        for method in METHODS {
            let mut s = measuring(&oscillator(force), "DX(2,1)", method, 1e-3);
            go(&mut s, Analysis::Dynamic, 300.0, 200);
            let warned = s.run.record.warned();
            assert!(
                warned.iter().all(|w| !w.contains("added up")),
                "{force} {method}: {warned:?}"
            );
            assert!(said(&s).usual < 0.1, "{force} {method}: {:?}", said(&s));
        }
    }
}

/// Masses that a belt takes along until a spring tears them off, by laws of friction far steeper
/// than the speed of the belt: implicit methods took the steep slope of sticking for that of what
/// slips already, and broke away late without a word.
#[test]
fn masses_on_belts_say_how_far_off_they_are() {
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
    let mut all = Said::default();
    for (force, end) in belts {
        let text = oscillator("").replace("MASS=2", "MASS=1");
        let text = text.replace("QG=0.5,0,0", "QG=0.05,0,0");
        let text = text.replace("-50*DX(2,1)", force);
        let said = against_itself(&text, "DX(2,1)", end, &[2, 4]);
        all.over.extend(said.over);
        all.wide.extend(said.wide);
    }
    all.holds();
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

#[test]
fn swings_with_several_frequencies_say_how_far_off_they_are() {
    let rows = [
        (1, 30.0, vec![0.7]),
        (3, 400.0, vec![1.0, -0.3, 0.2]),
        (8, 7.0, vec![0.0, 0.4, 0.0, 0.0, -1.0, 0.3, 0.0, 0.2]),
    ];
    let mut found = Said::default();
    for (n, stiffness, velocities) in rows {
        let row = Row {
            n,
            stiffness,
            velocities,
        };
        for method in METHODS {
            for swings in [10.0, 100.0] {
                for error in [1e-2, 1e-4] {
                    let column = "DX(10,1)";
                    let mut s = measuring(&row.text(), column, method, error);
                    // no output meets the beginning of a swing again and again
                    let end = (swings + 0.37) * TAU / row.frequency(n);
                    if try_to(&mut s, Analysis::Dynamic, end, 500) == Status::Limit {
                        continue;
                    }
                    let times = (0..=500).map(|k| end * f64::from(k) / 500.0);
                    let exact: Vec<f64> = times.map(|t| row.at(1, t)).collect();
                    let widest = exact.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                    let lost = usual_error(running::values(&s, column), &exact);
                    found.take(
                        &s,
                        (lost, 2.0 * widest),
                        &format!("{n} {swings} {method} {error:e}"),
                    );
                }
            }
        }
    }
    found.holds();
}

#[test]
fn swings_that_are_small_beside_their_model_say_how_far_off_they_are() {
    let omega = 5.0;
    let mut found = Said::default();
    for (at, share) in [(0.6, 1e-3), (0.6, 2e-7), (30.0, 1e-4), (100.0, 1e-7)] {
        let width = at * share;
        let text = format!(
            "PART/2, MASS=2, CM=2, IP=1,1,1, QG={},0,0\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=3, J=4\n\
             MARKER/3, PART=2, REULER=90D,90D,0\nMARKER/4, PART=1, REULER=90D,90D,0\nMARKER/5, PART=1, QP={at},0,0\n\
             SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=3, J=4, FUNCTION=-50*DX(2,5)\n",
            at + width
        );
        for error in [1e-2, 1e-4, 1e-6] {
            for method in ["AUTO", "RADAU5"] {
                let mut s = measuring(&text, "VX(2,1)", method, error);
                go(&mut s, Analysis::Dynamic, 3.0, 40);
                let times = (0..=40).map(|k| 3.0 * f64::from(k) / 40.0);
                let exact: Vec<f64> = times.map(|t| -width * omega * (omega * t).sin()).collect();
                let lost = usual_error(running::values(&s, "VX(2,1)"), &exact);
                let what = format!("{at} {share:e} {error:e} {method}");
                found.take(&s, (lost, 2.0 * width * omega), &what);
            }
        }
    }
    found.holds();
}

#[test]
fn what_an_equilibrium_has_left_to_settle_is_not_measured() {
    // a hanging mass, found to the tolerance of statics; then a hum that is small, and matters
    let text = |more: &str| {
        format!(
            "PART/2, MASS=2, CM=2, IP=1,1,1, QG=0,0,-1.2\nMARKER/2, PART=2\nJPRIM/1, ORIENTATION, I=2, J=1\n\
             SPRINGDAMPER/1, TRANSLATION, I=2, J=1, K=300, C=0.1, LENGTH=1\nACCGRAV/KGRAV=-9.81\n\
             BUSHING/1, I=2, J=1, K=20,20,1, KT=0,0,0\n\
             SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=1, FUNCTION={more}\n"
        )
    };
    let is_measured = |text: &str| {
        let mut s = measuring(text, "VZ(2,1)", "AUTO", 1e-3);
        s.model.equilibrium.error = Some(1e-3);
        s.model.equilibrium.imbalance = Some(1e-2);
        go(&mut s, Analysis::Static, 0.0, 1);
        go(&mut s, Analysis::Dynamic, 3.0, 40);
        s.run.record.accuracy.is_some()
    };
    assert!(!is_measured(&text("0")));
    assert!(is_measured(&text("1E-5*SIN(20*TIME)")));
}

/// The second integration is made beside the results and changes none of them.
#[test]
fn measuring_changes_no_bit_of_the_results() {
    let text = oscillator("+20*(1-DX(2,1)**2)*VX(2,1)");
    for method in METHODS {
        let rows = |measure: bool| {
            let mut s = measuring(&text, "DX(2,1)", method, 1e-4);
            if !measure {
                s = session_by(&text, &["DX(2,1)"], method, 1e-4);
            }
            for end in [1.0, 3.0] {
                go(&mut s, Analysis::Dynamic, end, 40);
            }
            running::values(&s, "DX(2,1)").to_vec()
        };
        assert_eq!(rows(true), rows(false), "{method}");
    }
}

/// What a run is off by at the end of a simulation it is off by in the next one, which may be short and easy.
#[test]
fn errors_of_a_simulation_stay_in_the_next() {
    let mut s = measuring(&oscillator(""), "DX(2,1)", "AUTO", 1e-3);
    go(&mut s, Analysis::Dynamic, 200.0, 100);
    let before = said(&s).usual_bar;
    let mut short = measuring(&oscillator(""), "DX(2,1)", "AUTO", 1e-3);
    go(&mut short, Analysis::Dynamic, 1.0, 100);
    assert!(said(&short).usual_bar < 0.1 * before);
    // of both simulations the larger counts, so the second one is asked by itself
    s.run.record.accuracy = None;
    go(&mut s, Analysis::Dynamic, 201.0, 100);
    let after = said(&s).usual_bar;
    assert!(after > 0.5 * before, "{before:e} {after:e}");
}

/// What comes to rest is small at the only output that is asked for: its errors are measured beside all that it has done on the way,
/// so that nothing is said which many outputs would not say.
#[test]
fn what_is_at_rest_at_the_only_output_has_errors_of_its_whole_way() {
    for method in METHODS {
        for error in [1e-3, 1e-5] {
            for outputs in [1, 5, 40] {
                let mut s = measuring(&oscillator("-12*VX(2,1)"), "VX(2,1)", method, error);
                try_to(&mut s, Analysis::Dynamic, 6.0, outputs);
                let told = s.run.record.warned();
                assert!(told.is_empty(), "{method} {error:e} {outputs}: {told:?}");
            }
        }
    }
}
