//! Forces that change branch with the state, by every method: a step ends where the branch does, so that all agree with the exact motion.

use crate::running;

use running::{Analysis, Session, go, off, session_by, values};

const METHODS: [&str; 2] = ["DOP853", "RADAU5"];
const REQUESTS: [f64; 2] = [1e-4, 1e-6];

/// A unit mass that slides along z from `start`, pushed by a function.
fn slider(start: f64, function: &str) -> String {
    format!(
        "PART/2, MASS=1, CM=2, IP=1,1,1, QG=0,0,{start}\nMARKER/2, PART=2\nMARKER/3, PART=1\n\
         JOINT/1, TRANSLATIONAL, I=2, J=3\nSFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION={function}\n"
    )
}

fn run(text: &str, column: &str, method: &str, error: f64, end: f64) -> Session {
    let mut s = session_by(text, &[column], method, error);
    go(&mut s, Analysis::Dynamic, end, 50);
    s
}

/// Every method at every request against a motion, whose size is about one.
fn all_follow(text: &str, column: &str, end: f64, exact: impl Fn(usize, f64) -> f64) {
    for method in METHODS {
        for error in REQUESTS {
            let s = run(text, column, method, error, end);
            let rows = values(&s, "time").iter().zip(values(&s, column));
            let off = rows
                .enumerate()
                .map(|(k, (&t, x))| (x - exact(k, t)).abs())
                .fold(0.0, f64::max);
            let counts = &s.run.record.counts;
            println!(
                "{method} {error:e}: {off:.1e}, {} steps, {} rejected",
                counts.steps, counts.rejected_steps
            );
            // the request is of the error per step; a run has up to ten smooth pieces
            assert!(off < 10.0 * error, "{method} {error:e}: {off:e}");
        }
    }
}

/// Pulled down by 30 above 0.1, pushed up by `push` below, from rest at 0.3.
fn between_two_fields(t: f64, push: f64) -> f64 {
    let speed = 12.0_f64.sqrt();
    let (fall, below) = (speed / 30.0, 2.0 * speed / push);
    let t = t.rem_euclid(2.0 * fall + below);
    if t < fall {
        0.3 - 15.0 * t * t
    } else if t < fall + below {
        let t = t - fall;
        0.1 - speed * t + 0.5 * push * t * t
    } else {
        let t = t - 2.0 * fall - below;
        0.3 - 15.0 * t * t
    }
}

#[test]
fn a_force_that_jumps_with_the_position_gives_its_parabolas() {
    // contacts as long as the flights, and a thousand times shorter
    for push in [20.0, 2e4] {
        let text = slider(0.3, &format!("IF(DZ(2)-0.1:{push},0,-30)"));
        all_follow(&text, "DZ(2)", 1.0, |_, t| between_two_fields(t, push));
    }
}

#[test]
fn friction_by_a_sign_shortens_every_swing_by_the_same_amount() {
    let text = slider(0.3, "-100*DZ(2)-SIGN(1.5,VZ(2))");
    // about the place where spring and friction balance, half a period at a time
    let exact = |_: usize, t: f64| {
        let half = std::f64::consts::PI / 10.0;
        let swing = (t / half).floor();
        let sign = if swing % 2.0 == 0.0 { 1.0 } else { -1.0 };
        let amplitude = 0.3 - 0.015 * (2.0 * swing + 1.0);
        sign * (0.015 + amplitude * (10.0 * (t - swing * half)).cos())
    };
    all_follow(&text, "DZ(2)", 1.0, exact);
}

#[test]
fn a_ball_bounces_on_a_stiff_floor_as_steps_of_a_microsecond_say() {
    let text = slider(0.5, "-9.81+IMPACT(DZ(2),VZ(2),0.1,1E6,1.5,100,1E-4)");
    let rate = |x: f64, v: f64| {
        let depth = (0.1 - x).max(0.0);
        let u = (depth / 1e-4).min(1.0);
        let damper = 100.0 * u * u * (3.0 - 2.0 * u);
        -9.81 + (1e6 * depth.powf(1.5) - damper * v).max(0.0)
    };
    // the classical method of fourth order; output every 0.02
    let (h, mut x, mut v) = (1e-6, 0.5, 0.0);
    let mut exact = vec![x];
    for step in 1..=1_000_000 {
        let (a1, v1) = (rate(x, v), v);
        let (a2, v2) = (rate(x + 0.5 * h * v1, v + 0.5 * h * a1), v + 0.5 * h * a1);
        let (a3, v3) = (rate(x + 0.5 * h * v2, v + 0.5 * h * a2), v + 0.5 * h * a2);
        let (a4, v4) = (rate(x + h * v3, v + h * a3), v + h * a3);
        x += h / 6.0 * (v1 + 2.0 * (v2 + v3) + v4);
        v += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
        if step % 20_000 == 0 {
            exact.push(x);
        }
    }
    let lowest = exact.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(lowest < 0.11 && exact[23] > 0.24, "it bounces: {exact:?}");
    all_follow(&text, "DZ(2)", 1.0, |k, _| exact[k]);
}

#[test]
fn a_four_bar_is_thrown_back_alike_by_every_method() {
    // rows with multipliers, which jump with the force
    let text = "PART/2, MASS=1, CM=20, IP=0.1,0.1,0.1\nMARKER/20, PART=2, QP=0.5,0,0\nMARKER/21, PART=2\nMARKER/22, PART=2, QP=1,0,0\n\
                PART/3, MASS=2, CM=30, IP=0.2,0.2,0.2\nMARKER/30, PART=3, QP=2,0,0\nMARKER/31, PART=3, QP=1,0,0\nMARKER/32, PART=3, QP=3,0,0\n\
                PART/4, MASS=1, CM=40, IP=0.1,0.1,0.1\nMARKER/40, PART=4, QP=3,1,0\nMARKER/41, PART=4, QP=3,0,0\nMARKER/42, PART=4, QP=3,2,0\n\
                MARKER/2, PART=1\nMARKER/3, PART=1, QP=3,2,0\n\
                JOINT/1, REVOLUTE, I=21, J=2\nJOINT/2, REVOLUTE, I=31, J=22\nJOINT/3, REVOLUTE, I=41, J=32\nJOINT/4, REVOLUTE, I=42, J=3\n\
                SFORCE/1, ROTATION, ACTIONONLY, I=21, J=2, FUNCTION=IF(AZ(20,1)-0.3:40,0,-20)\n";
    let reference = run(text, "DY(20)", "DOP853", 1e-11, 1.0);
    // the torque has a potential with a bend at 0.3, on both sides of which the crank is seen
    let energy = "0.5*VM(20)**2+0.05*WZ(20)**2+VM(30)**2+0.1*WZ(30)**2+0.5*VM(40)**2+0.05*WZ(40)**2\
                  +IF(AZ(20,1)-0.3:-40*AZ(20,1),-12,20*AZ(20,1)-18)";
    let mut kept = session_by(text, &[energy, "AZ(20,1)"], "DOP853", 1e-10);
    go(&mut kept, Analysis::Dynamic, 1.0, 50);
    assert!(off(&kept, energy, |_| 0.0) < 1e-7);
    let turned = values(&kept, "AZ(20,1)");
    assert!(turned.iter().any(|a| *a > 0.31) && turned.iter().any(|a| *a < 0.29));
    let exact = values(&reference, "DY(20)");
    all_follow(text, "DY(20)", 1.0, |k, _| exact[k]);
}
