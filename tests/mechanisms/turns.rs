//! Angles know their turns: whatever drives them, however many outputs there are, by every method.

use crate::running;

use proptest::prelude::*;
use running::*;
use std::f64::consts::{PI, TAU};

/// A rotor on JOINT/1, whose markers may be given the other way round; MARKER/21 stands askew on it.
fn rotor(reversed: bool) -> String {
    let (i, j) = if reversed { (1, 20) } else { (20, 1) };
    format!(
        "PART/2, MASS=1, CM=20, IP=1,1,1\n\
         MARKER/20, PART=2\n\
         MARKER/21, PART=2, REULER=70D,0,0\n\
         JOINT/1, REVOLUTE, I={i}, J={j}\n"
    )
}

/// A smooth drive `a t + b sin(c t)` with its two rates, as texts.
fn drive([a, b, c]: [f64; 3]) -> [String; 3] {
    [
        format!("{a:?}*TIME+{b:?}*SIN({c:?}*TIME)"),
        format!("{a:?}+{:?}*COS({c:?}*TIME)", b * c),
        format!("{:?}*SIN({c:?}*TIME)", -b * c * c),
    ]
}

/// An angle taken to the half turn on either side of zero.
fn principal(angle: f64) -> f64 {
    PI - (PI - angle).rem_euclid(TAU)
}

/// The values of a principal angle at ascending times, its turns counted by looking closely.
fn unwrapped(times: &[f64], fastest: f64, angle: impl Fn(f64) -> f64) -> Vec<f64> {
    let (mut now, mut at) = (angle(times[0]), times[0]);
    let step = 0.05 / fastest;
    let mut all = Vec::new();
    for &t in times {
        let n = ((t - at) / step).ceil().max(1.0);
        let start = at;
        for k in 1..=n as usize {
            at = start + (t - start) * k as f64 / n;
            now += principal(angle(at) - now);
        }
        all.push(now);
    }
    all
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, max_shrink_iters: 20, failure_persistence: None, ..ProptestConfig::default() })]

    /// A drive by displacement, velocity or acceleration; a DIFF beside it makes the run dynamic.
    #[test]
    fn a_driven_angle_is_the_integral_of_its_rate(
        a in -300.0..300.0f64,
        b in -5.0..5.0f64,
        c in 0.1..20.0f64,
        level in 0usize..3,
        steps in 1usize..12,
        reversed: bool,
        with_state: bool,
        method in 0usize..3,
    ) {
        let [value, rate, second] = drive([a, b, c]);
        // the joint turns backward where its markers are exchanged
        let motion = match level {
            0 => format!("MOTION/1, JOINT=1, ROTATION, FUNCTION={value}\n"),
            1 => format!("MOTION/1, JOINT=1, ROTATION, VELOCITY, FUNCTION={rate}\n"),
            _ => format!("MOTION/1, JOINT=1, ROTATION, ACCELERATION, ICVEL={:?}, FUNCTION={second}\n", a + b * c),
        };
        let state = if with_state { "DIFF/1, IC=0, FUNCTION=WZ(20,1)\n" } else { "" };
        let text = rotor(reversed) + &motion + state + "SPRINGDAMPER/1, ROTATION, I=21, J=1, KT=2\n";
        let columns = ["AZ(20,1)", "AZ(1,20)", "AZ(21,1)", "SPDP(1,0,8,0)", "MOTION(1,0,8,0)"];
        let mut options = options(&columns, 1e-9);
        if with_state || level > 0 {
            options.method = Some(["AUTO", "DOP853", "RADAU5"][method].into());
        }
        let mut s = begin(model(&text), "driven", options);
        go(&mut s, Analysis::Dynamic, 2.0, steps);
        let sign = if reversed { -1.0 } else { 1.0 };
        let exact = |t: f64| sign * (a * t + b * (c * t).sin());
        let tolerance = 1e-5 * (1.0 + a.abs() + b.abs() * c);
        let ways: [(&str, &dyn Fn(f64) -> f64); 4] = [
            ("AZ(20,1)", &exact),
            ("AZ(1,20)", &|t| -exact(t)),
            ("AZ(21,1)", &|t| exact(t) + 70f64.to_radians()),
            ("SPDP(1,0,8,0)", &|t| -2.0 * (exact(t) + 70f64.to_radians())),
        ];
        for (column, expected) in ways {
            let off = off(&s, column, expected);
            prop_assert!(off < tolerance, "{column} is off by {off}\n{text}");
        }
    }

    /// A torque turns the rotor; nothing else limits steps, and outputs are few.
    #[test]
    fn a_turning_angle_is_the_integral_of_its_rate(
        speed in -2000.0..2000.0f64,
        torque in -50.0..50.0f64,
        frequency in 0.0..3.0f64,
        steps in 1usize..8,
        reversed: bool,
        method in 0usize..2,
    ) {
        let (i, j) = if reversed { (1, 20) } else { (20, 1) };
        let text = format!(
            "PART/2, MASS=1, CM=20, IP=1,1,1, WZ={speed:?}\n\
             MARKER/20, PART=2\n\
             JOINT/1, REVOLUTE, I={i}, J={j}\n\
             SFORCE/1, ROTATION, I=20, J=1, FUNCTION={torque:?}*COS({frequency:?}*TIME)\n\
             DIFF/1, IC=0, FUNCTION=WZ(20,1)\n"
        );
        let method = ["AUTO", "RADAU5"][method];
        let mut s = begin(model(&text), "turning", options_by(&["AZ(20,1)", "DIF(1)"], method, 1e-9));
        go(&mut s, Analysis::Dynamic, 30.0, steps);
        let (angles, integrals) = (values(&s, "AZ(20,1)"), values(&s, "DIF(1)"));
        for (angle, integral) in angles.iter().zip(integrals) {
            prop_assert!((angle - integral).abs() < 1e-6 * (1.0 + speed.abs() + torque.abs()), "{angle} {integral}");
        }
    }

    /// Two rotors about axes askew: the angle between them is no sum of their own.
    #[test]
    fn angles_between_axes_askew_lose_no_turn(
        a in 1.0..60.0f64,
        b in -60.0..60.0f64,
        tilt in 0.2..1.3f64,
        steps in 1usize..10,
        with_state: bool,
    ) {
        let text = format!(
            "PART/2, MASS=1, CM=20, IP=1,1,1\n\
             MARKER/20, PART=2\n\
             JOINT/1, REVOLUTE, I=20, J=1\n\
             MOTION/1, JOINT=1, ROTATION, FUNCTION={a:?}*TIME\n\
             MARKER/2, PART=1, REULER=0,{tilt:?},0\n\
             PART/3, MASS=1, CM=30, IP=1,1,1, REULER=0,{tilt:?},0\n\
             MARKER/30, PART=3\n\
             JOINT/2, REVOLUTE, I=30, J=2\n\
             MOTION/2, JOINT=2, ROTATION, FUNCTION={b:?}*TIME\n"
        );
        let state = if with_state { "DIFF/1, IC=0, FUNCTION=1\n" } else { "" };
        let mut s = session(&(text + state), &["AZ(30,20)"], 1e-6);
        go(&mut s, Analysis::Dynamic, 2.0, steps);
        // x of 30 in the axes of 20: Rz(−at) Rx(tilt) (cos bt, sin bt, 0)
        let angle = |t: f64| {
            let ((sa, ca), (sb, cb)) = ((a * t).sin_cos(), (b * t).sin_cos());
            let (x, y) = (cb, sb * tilt.cos());
            (ca * y - sa * x).atan2(ca * x + sa * y)
        };
        let times = values(&s, "time").to_vec();
        let exact = unwrapped(&times, a + b.abs(), angle);
        for (t, (found, exact)) in times.iter().zip(values(&s, "AZ(30,20)").iter().zip(exact)) {
            prop_assert!((found - exact).abs() < 1e-6, "{found} for {exact} at {t}");
        }
    }
}

/// The first value lies within half a turn of zero; what is counted goes on from there.
#[test]
fn the_first_angle_is_a_principal_value() {
    let text = rotor(false) + "MOTION/1, JOINT=1, ROTATION, FUNCTION=10+TIME\n";
    let s = run(&text, &["AZ(20,1)"], Analysis::Kinematic, (7.0, 3), 1e-6);
    assert!(off(&s, "AZ(20,1)", |t| principal(10.0) + t) < 1e-12);
    let half = rotor(false) + "MOTION/1, JOINT=1, ROTATION, FUNCTION=180D+TIME\n";
    let s = run(&half, &["AZ(20,1)"], Analysis::Kinematic, (7.0, 3), 1e-6);
    assert!(off(&s, "AZ(20,1)", |t| PI + t) < 1e-12);
}

/// Turns are carried from one simulation to the next, also where a command makes another
/// mechanism of it and where the state is saved in between.
#[test]
fn turns_go_on_in_the_next_simulation() {
    let text = rotor(false)
        + "MOTION/1, JOINT=1, ROTATION, FUNCTION=20*TIME\n\
           BUSHING/1, I=21, J=1, K=0,0,0, KT=0,0,0\n";
    let mut s = session(&text, &["AZ(20,1)", "AZ(21,1)"], 1e-9);
    go(&mut s, Analysis::Kinematic, 1.0, 1);
    go(&mut s, Analysis::Dynamic, 2.0, 1);
    // the motion is switched off: the rotor coasts, and its angle is an unknown now
    let motion = cognate::model::ElementKind::Motion.id(1);
    s.model.inactive.insert(motion);
    go(&mut s, Analysis::Dynamic, 3.0, 2);
    assert!(off(&s, "AZ(20,1)", |t| 20.0 * t) < 1e-6);
    let saved = s.save();
    let mut next = session(&text, &["AZ(20,1)", "AZ(21,1)"], 1e-9);
    let saved = cognate::analysis::session::state::Saved::read(saved.as_bytes()).expect("a state");
    next.reload(saved).expect("the same model");
    go(&mut next, Analysis::Dynamic, 4.0, 2);
    assert!(off(&next, "AZ(20,1)", |t| 20.0 * t) < 1e-6);
    let askew = 70f64.to_radians();
    assert!(off(&next, "AZ(21,1)", |t| 20.0 * t + askew) < 1e-6);
}

/// Between equilibria drives may turn by many turns, about axes askew too.
#[test]
fn turns_are_counted_between_equilibria() {
    let text = "PART/2, MASS=1, CM=20, IP=1,1,1\n\
                MARKER/20, PART=2\n\
                JOINT/1, REVOLUTE, I=20, J=1\n\
                MOTION/1, JOINT=1, ROTATION, FUNCTION=40*TIME\n\
                MARKER/2, PART=1, REULER=0,0.5,0\n";
    for steps in [1, 4] {
        let mut s = session(text, &["AZ(20,1)", "AZ(20,2)"], 1e-6);
        go(&mut s, Analysis::Static, 2.0, steps);
        assert!(off(&s, "AZ(20,1)", |t| 40.0 * t) < 1e-9);
        // x of 20 against axes that are inclined by 0.5
        let inclined = |t: f64| {
            let (sine, cosine) = (40.0 * t).sin_cos();
            (sine * 0.5f64.cos()).atan2(cosine)
        };
        let times = values(&s, "time").to_vec();
        let exact = unwrapped(&times, 50.0, inclined);
        for (found, exact) in values(&s, "AZ(20,2)").iter().zip(exact) {
            assert!((found - exact).abs() < 1e-9, "{found} for {exact}");
        }
    }
}

/// A sensor is triggered where its expression passes VALUE, not at the next output.
#[test]
fn sensors_of_mechanisms_without_freedom_are_located() {
    let rotor = rotor(false)
        + "MARKER/22, PART=2, QP=1,0,0\n\
           MOTION/1, JOINT=1, ROTATION, FUNCTION=62.83185307179586*TIME\n";
    let sensors = [
        ("AZ(20,1)\\, GE, VALUE=62", 62.0 / (20.0 * PI)),
        ("AZ(20,1)\\, EQ, VALUE=31", 31.0 / (20.0 * PI)),
        (
            "-AZ(21,1)\\, LE, VALUE=-20",
            (20.0 - 70f64.to_radians()) / (20.0 * PI),
        ),
        // within the first of the turns between two outputs
        ("DX(22,1)\\, LE, VALUE=0", 0.025),
        // again and again the same angle
        ("AZ(20,1)\\, ANGULAR, EQ, VALUE=3", 3.0 / (20.0 * PI)),
    ];
    for (sensor, at) in sensors {
        for steps in [3, 50] {
            let text = format!("{rotor}SENSOR/1, FUNCTION={sensor}, ERROR=1E-6, RETURN\n");
            let mut s = session(&text, &["AZ(20,1)"], 1e-6);
            let status = try_to(&mut s, Analysis::Kinematic, 10.0, steps);
            println!("{sensor}: {status:?}");
            let end = *values(&s, "time").last().expect("a row");
            assert!(
                (end - at).abs() < 1e-9,
                "{sensor}: {end} for {at}, {steps} outputs"
            );
        }
    }
}

/// A crank and a slider whose rod is carried by a ball: no coordinate knows the turns of its hinge.
#[test]
fn hinges_of_a_loop_count_with_kinematics() {
    let text = "PART/2, MASS=1, CM=20, IP=1,1,1\n\
                MARKER/20, PART=2\nMARKER/22, PART=2, QP=1,0,0\n\
                PART/3, MASS=1, CM=30, IP=1,1,1, QG=1,0,0\n\
                MARKER/30, PART=3\nMARKER/33, PART=3, QP=3,0,0\n\
                PART/4, MASS=1, CM=40, IP=1,1,1, QG=4,0,0\n\
                MARKER/40, PART=4\nMARKER/44, PART=4, REULER=90D,90D,0\n\
                MARKER/4, PART=1, REULER=90D,90D,0\nMARKER/5, PART=1, REULER=0,0.5,0\n\
                JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, SPHERICAL, I=30, J=22\n\
                JOINT/3, UNIVERSAL, I=41, J=34\nJOINT/4, TRANSLATIONAL, I=44, J=4\n\
                MARKER/41, PART=4, REULER=0,90D,0\nMARKER/34, PART=3, QP=3,0,0\n\
                MOTION/1, JOINT=1, ROTATION, FUNCTION=40*TIME\n";
    let rod = |t: f64| -((40.0 * t).sin() / 3.0).asin();
    for steps in [1, 7] {
        let columns = ["AZ(30,22)", "AZ(20,5)"];
        let s = run(text, &columns, Analysis::Kinematic, (2.0, steps), 1e-6);
        assert!(off(&s, "AZ(30,22)", |t| rod(t) - 40.0 * t) < 1e-6);
        let inclined = |t: f64| {
            let (sine, cosine) = (40.0 * t).sin_cos();
            (sine * 0.5f64.cos()).atan2(cosine)
        };
        let times = values(&s, "time").to_vec();
        let exact = unwrapped(&times, 50.0, inclined);
        for (found, exact) in values(&s, "AZ(20,5)").iter().zip(exact) {
            assert!((found - exact).abs() < 1e-9, "{found} for {exact}");
        }
    }
}
