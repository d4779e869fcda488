//! Angles that constraints ask for: assembly finds them from any start, told from their opposites, and motions follow them
//! over turns.

use crate::running;
use cognate::dataset::read_text;
use proptest::prelude::*;
use running::{Analysis, first, go, session, values};
use std::f64::consts::{PI, TAU};

type Matrix = [[f64; 3]; 3];

/// The rotation about an axis: 0 x, 1 y, 2 z.
fn about(axis: usize, angle: f64) -> Matrix {
    let (s, c) = angle.sin_cos();
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut m = [[0.0; 3]; 3];
    m[axis][axis] = 1.0;
    (m[i][i], m[j][j], m[i][j], m[j][i]) = (c, c, -s, s);
    m
}

fn product(all: &[Matrix]) -> Matrix {
    let pair = |a: Matrix, b: &Matrix| {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
    };
    all[1..].iter().fold(all[0], pair)
}

fn transposed(m: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

fn column(m: &Matrix, k: usize) -> [f64; 3] {
    m.map(|row| row[k])
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter()
        .zip(b)
        .fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()))
}

/// The columns from which the orientation of MARKER/21 in MARKER/11 follows.
const EULER: [&str; 3] = ["PSI(21,11)", "THETA(21,11)", "PHI(21,11)"];

fn from_313(angles: [f64; 3]) -> Matrix {
    product(&[
        about(2, angles[0]),
        about(0, angles[1]),
        about(2, angles[2]),
    ])
}

/// The orientation of MARKER/21 in MARKER/11 at the beginning, and the warnings.
fn assembled(text: &str) -> (Matrix, Vec<String>) {
    // a check refuses pins that are parallel; assembly turns them all the same
    let model = read_text(&format!("{}{text}END\n", running::GROUND)).model;
    let mut s = running::begin(model, "test", running::options(&EULER, 1e-6));
    go(&mut s, Analysis::Dynamic, 1e-6, 1);
    (from_313(EULER.map(|c| first(&s, c))), s.run.record.warned())
}

fn reuler(angles: [f64; 3]) -> String {
    format!("REULER={}, {}, {}", angles[0], angles[1], angles[2])
}

/// A part whose MARKER/20 is held at MARKER/1 by a ball, and whose MARKER/21 is turned.
fn ball(part: [f64; 3], marker: [f64; 3], ground: [f64; 3]) -> String {
    format!(
        "MARKER/11, PART=1, {}\nPART/2, MASS=1, CM=20, IP=1,2,3, {}\nMARKER/20, PART=2\nMARKER/21, PART=2, {}\n\
         JOINT/1, SPHERICAL, I=20, J=1\n",
        reuler(ground),
        reuler(part),
        reuler(marker)
    )
}

/// Quarters of a turn, and any angle.
fn angle() -> impl Strategy<Value = f64> {
    prop_oneof![(-2i32..=2).prop_map(|k| 0.5 * PI * f64::from(k)), -PI..PI]
}

fn angles() -> impl Strategy<Value = [f64; 3]> {
    [angle(), angle(), angle()]
}

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// REULER of a marker whose z axis is an axis of its part, and of a part turned about that axis.
fn hinge(axis: usize, start: f64) -> (&'static str, String) {
    match axis {
        0 => ("90D, 90D, 0", format!("0, {start}, 0")),
        1 => ("180D, 90D, 0", format!("90D, {start}, -90D")),
        _ => ("0, 0, 0", format!("{start}, 0, 0")),
    }
}

/// A rotor about an axis of ground, drawn turned, with a motion of its body angle.
fn driven_rotor(axis: usize, start: f64, motion: &str) -> String {
    let (z, drawn) = hinge(axis, start);
    format!(
        "MARKER/11, PART=1\nMARKER/12, PART=1, REULER={z}\nPART/2, MASS=1, CM=21, IP=1,2,3, REULER={drawn}\n\
         MARKER/21, PART=2\nMARKER/22, PART=2, REULER={z}\nJOINT/1, REVOLUTE, I=22, J=12\n\
         MOTION/1, I=21, J=11, B{}, {motion}\n",
        axis + 1
    )
}

const MEASURES: [&str; 3] = ["AX(21,11)", "AY(21,11)", "AZ(21,11)"];

proptest! {
    #![proptest_config(config(64))]

    #[test]
    fn a_rotor_is_driven_to_any_angle_from_any_start(axis in 0usize..3, start in angle(), wanted in angle()) {
        let text = driven_rotor(axis, start, &format!("FUNCTION={wanted}"));
        for analysis in [Analysis::Kinematic, Analysis::Dynamic, Analysis::Static] {
            let mut s = session(&text, &MEASURES, 1e-6);
            go(&mut s, analysis, 1e-3, 1);
            let off = first(&s, MEASURES[axis]) - wanted;
            prop_assert!((off - TAU * (off / TAU).round()).abs() < 1e-6, "{analysis:?}: off by {off}\n{text}");
            let turned = wanted - start;
            let turned = (turned - TAU * (turned / TAU).round()).abs().to_degrees();
            let told = s.run.record.warned().iter().any(|w| w.contains("PART/2 is turned by"));
            prop_assert!(told || turned < 1.001, "nothing told of {turned} deg\n{text}");
        }
    }

    #[test]
    fn body_angles_are_those_of_their_motions_from_any_start(
        which in 1usize..8, wanted in angles(), part in angles(), marker in angles(), ground in angles()
    ) {
        let mut text = ball(part, marker, ground);
        for k in (0..3).filter(|k| which >> k & 1 == 1) {
            text += &format!("MOTION/{}, I=21, J=11, B{}, FUNCTION={}\n", k + 1, k + 1, wanted[k]);
        }
        let (r, _) = assembled(&text);
        let [a, b, c] = [0, 1, 2].map(|k| about(k, wanted[k]));
        let off = match which {
            0b111 => {
                let whole = product(&[a, b, c]);
                (0..3).map(|k| distance(&column(&r, k), &column(&whole, k))).fold(0.0, f64::max)
            }
            0b011 => distance(&column(&r, 2), &column(&product(&[a, b]), 2)),
            0b110 => distance(&r[0], &product(&[b, c])[0]),
            0b101 => distance(&column(&product(&[r, transposed(&c)]), 1), &column(&a, 1)),
            0b010 => (r[0][2] - wanted[1].sin()).abs(),
            one => {
                let (k, y, x) = if one == 1 { (0, -r[1][2], r[2][2]) } else { (2, -r[0][1], r[0][0]) };
                let (s, c) = wanted[k].sin_cos();
                let opposite = y * s + x * c < -1e-9;
                (y * c - x * s).abs() + f64::from(u8::from(opposite))
            }
        };
        prop_assert!(off < 1e-6, "off by {off}\n{text}{r:?}");
    }

    #[test]
    fn primitives_and_joints_are_assembled_the_right_way_round(
        which in 0usize..10, part in angles(), marker in angles(), ground in angles()
    ) {
        let kind = [
            "JPRIM/2, ORIENTATION", "JPRIM/2, PARALLEL_AXES", "JPRIM/2, PERPENDICULAR",
            "JOINT/2, FIXED", "JOINT/2, TRANSLATIONAL", "JOINT/2, REVOLUTE", "JOINT/2, CYLINDRICAL",
            "JOINT/2, PLANAR", "JOINT/2, HOOKE", "JOINT/2, CONVEL",
        ][which];
        let first = product(&[transposed(&from_313(ground)), from_313(part), from_313(marker)]);
        // pins of a HOOKE that are parallel are refused, as nothing says which way to turn them
        prop_assume!(which != 8 || first[1][0].abs() < 0.9998);
        let text = ball(part, marker, ground) + kind + ", I=21, J=11\n";
        let (r, warnings) = assembled(&text);
        let off = match which {
            0 | 3 | 4 => (0..3).map(|k| (r[k][k] - 1.0).abs()).fold(0.0, f64::max),
            1 | 5..=7 => (r[2][2] - 1.0).abs(),
            2 => r[2][2].abs(),
            8 => r[1][0].abs(),
            _ => (r[1][0] - r[0][1]).abs() + f64::from(u8::from(r[0][0] + r[1][1] < -1e-6)),
        };
        prop_assert!(off < 1e-6, "off by {off}\n{text}{r:?}");
        let turn = product(&[r, transposed(&first)]);
        let turned = (0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0)).clamp(-1.0, 1.0).acos();
        let told = warnings.iter().any(|w| w.contains("PART/2 is turned by"));
        prop_assert!(told == (turned.to_degrees() > 1.0), "{warnings:?} of {} deg\n{text}", turned.to_degrees());
    }
}

/// Two pins that cross: MARKER/20 turned by `a` about z of MARKER/1, a quarter turn about x, and `b` about its own z.
const CROSSED_PINS: [&str; 3] = [
    "JOINT/1, UNIVERSAL, I=20, J=1\n",
    "MARKER/22, PART=2, REULER=180D, 90D, 90D\nMARKER/12, PART=1, REULER=90D, 90D, 0\nJOINT/1, HOOKE, I=22, J=12\n",
    "PART/3, MASS=1, CM=30, IP=1,1,1, REULER=START\nMARKER/30, PART=3\nMARKER/31, PART=3, REULER=0, 90D, 0\n\
     JOINT/1, REVOLUTE, I=30, J=1\nJOINT/2, REVOLUTE, I=20, J=31\n",
];

proptest! {
    #![proptest_config(config(32))]

    #[test]
    fn angles_across_two_pins_are_those_of_the_axes(which in 0usize..3, a in -PI..PI, b in -PI..PI, spin in [-3.0..3.0f64, -3.0..3.0f64, -3.0..3.0f64]) {
        let [x, y, z] = spin;
        let text = format!(
            "PART/2, MASS=1, CM=20, IP=1,2,3, REULER={a}, 90D, {b}, WX={x}, WY={y}, WZ={z}\nMARKER/20, PART=2\n{}",
            CROSSED_PINS[which].replace("START", &format!("{a}, 0, 0"))
        );
        let columns = ["AX(20,1)", "AY(20,1)", "AZ(20,1)", "PSI(20,1)", "THETA(20,1)", "PHI(20,1)"];
        let mut s = session(&text, &columns, 1e-8);
        go(&mut s, Analysis::Dynamic, 2.0, 40);
        let all = columns.map(|c| values(&s, c));
        for row in 0..all[0].len() {
            let [.., psi, theta, phi] = all.map(|c| c[row]);
            let r = from_313([psi, theta, phi]);
            let read = [(-r[1][2], r[2][2]), (r[0][2], r[2][2]), (r[1][0], r[0][0])];
            for (k, (s, c)) in read.into_iter().enumerate() {
                let off = all[k][row] - s.atan2(c);
                let off = off - TAU * (off / TAU).round();
                prop_assert!(off.abs() * s.hypot(c) < 1e-6, "{}: off by {off} in row {row}\n{text}", columns[k]);
            }
        }
    }

    #[test]
    fn a_second_body_angle_begins_where_it_is_drawn(
        part in angles(), marker in angles(), ground in angles(), speed in -2.0..2.0f64
    ) {
        let r = product(&[transposed(&from_313(ground)), from_313(part), from_313(marker)]);
        let (angle, cosine) = (r[0][2].asin(), r[1][2].hypot(r[2][2]));
        prop_assume!(cosine > 0.1);
        // the other triple turns about y alone where it hardly turns about x and z
        let others = r[1][2].atan2(-r[2][2]).abs() + r[0][1].atan2(-r[0][0]).abs();
        prop_assume!(others > 0.3 * PI);
        for motion in [
            format!("FUNCTION={angle}+{speed}*TIME"),
            format!("VELOCITY, FUNCTION={speed}"),
            format!("ACCELERATION, ICVEL={speed}, FUNCTION=0"),
        ] {
            let text = ball(part, marker, ground) + &format!("MOTION/1, I=21, J=11, B2, {motion}\n");
            let columns = ["WY(21,11,11)", "WZ(21,11,11)", EULER[0], EULER[1], EULER[2]];
            let mut s = session(&text, &columns, 1e-6);
            go(&mut s, Analysis::Dynamic, 1e-6, 1);
            let begun = from_313(EULER.map(|c| first(&s, c)));
            let moved = (0..3).map(|k| distance(&begun[k], &r[k])).fold(0.0, f64::max);
            prop_assert!(moved < 1e-6, "turned by {moved}\n{text}");
            // of sin B2 = x of z of I
            let rate = first(&s, "WY(21,11,11)") * r[2][2] - first(&s, "WZ(21,11,11)") * r[1][2];
            prop_assert!((rate - cosine * speed).abs() < 1e-6, "{rate} for {}\n{text}", cosine * speed);
        }
    }
}

/// A pendulum on the part, so that the mechanism has a freedom.
const PENDULUM: &str = "PART/3, MASS=0.001, CM=30, IP=1E-3,1E-3,1E-3\nMARKER/30, PART=3\nMARKER/23, PART=2\n\
                        JOINT/3, REVOLUTE, I=30, J=23\n";

#[test]
fn a_motion_of_a_body_angle_goes_through_turns() {
    for (axis, measure) in MEASURES.iter().enumerate() {
        for speed in [TAU, -2.5] {
            for (analysis, more) in [
                (Analysis::Kinematic, ""),
                (Analysis::Dynamic, ""),
                (Analysis::Dynamic, PENDULUM),
            ] {
                for steps in [16, 70] {
                    let motion = format!("FUNCTION=3+{speed}*TIME");
                    let text = driven_rotor(axis, 2.0, &motion) + more;
                    let mut s = session(&text, &MEASURES, 1e-6);
                    go(&mut s, analysis, 4.0, steps);
                    let times = values(&s, "time").iter();
                    for (t, found) in times.zip(values(&s, measure)) {
                        let off = found - 3.0 - speed * t;
                        assert!(
                            off.abs() < 1e-5,
                            "{analysis:?}, axis {axis}, speed {speed}, {steps} steps: off by {off} at {t}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn three_motions_of_body_angles_go_through_the_singular_position_of_the_angles() {
    let text = ball([0.0; 3], [0.0; 3], [0.0; 3])
        + "MOTION/1, I=21, J=11, B1, FUNCTION=0.3+TIME\nMOTION/2, I=21, J=11, B2, FUNCTION=PI*TIME\n\
           MOTION/3, I=21, J=11, B3, FUNCTION=2-3*TIME\n";
    for (analysis, more) in [(Analysis::Kinematic, ""), (Analysis::Dynamic, PENDULUM)] {
        let mut s = session(&(text.clone() + more), &EULER, 1e-6);
        go(&mut s, analysis, 4.0, 80);
        for (row, t) in values(&s, "time").iter().enumerate() {
            let found = from_313(EULER.map(|c| values(&s, c)[row]));
            let wanted = product(&[about(0, 0.3 + t), about(1, PI * t), about(2, 2.0 - 3.0 * t)]);
            for k in 0..3 {
                let off = distance(&column(&found, k), &column(&wanted, k));
                assert!(off < 1e-5, "{analysis:?}: off by {off} at {t}");
            }
        }
    }
}
