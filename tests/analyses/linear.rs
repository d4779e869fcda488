//! Linearized models against closed forms: frequencies far apart, chains, pendulums with and without loops, damping, and the
//! matrices between plant inputs and outputs.

use crate::running;

use cognate::analysis::linear::{Linearization, Rate, Wanted};
use cognate::dataset::command::Script;
use running::{Options, Session, begin, model, obeys, rest};
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

fn session(text: &str) -> Session {
    begin(model(text), "test", Options::default())
}

fn linear(s: &mut Session, wanted: &Wanted) -> Linearization {
    s.linearize(wanted).unwrap_or_else(|e| panic!("{e:?}"))
}

/// Masses along x, each on a translational joint of its own: PART/k at k, MARKER/k on it, MARKER/100+k on ground.
fn masses(n: usize) -> String {
    let mut text = String::new();
    for k in 2..n + 2 {
        let _ = write!(
            text,
            "PART/{k}, MASS=1, CM={k}, QG={k},0,0\nMARKER/{k}, PART={k}, REULER=90D,90D,0\n\
             MARKER/{g}, PART=1, QP={k},0,0, REULER=90D,90D,0\nJOINT/{k}, TRANSLATIONAL, I={k}, J={g}\n",
            g = 100 + k
        );
    }
    text
}

fn close(a: f64, b: f64, within: f64) {
    assert!(
        (a - b).abs() <= within * b.abs().max(1e-300),
        "{a} instead of {b}"
    );
}

#[test]
fn one_hertz_beside_ten_thousand_keeps_its_digits() {
    let k = |f: f64| format!("{:?}", (TAU * f).powi(2));
    let text = format!(
        "{}SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=102, FUNCTION=-{}*DZ(2,102,102)\n\
         SFORCE/2, TRANSLATION, ACTIONONLY, I=3, J=103, FUNCTION=-{}*DZ(3,103,103)\n",
        masses(2),
        k(1.0),
        k(1e4)
    );
    let found = linear(&mut session(&text), &Wanted::default());
    assert_eq!(found.modes.len(), 2);
    println!("{}", found.table());
    for (mode, f) in found.modes.iter().zip([1.0, 1e4]) {
        close(mode.frequency(), f, 1e-12);
        assert!(mode.damping_ratio().abs() < 1e-12);
    }
    // each mode moves its own mass along x
    for (mode, moving) in found.modes.iter().zip([0, 1]) {
        assert!((mode.parts[moving].translation[0][0] - 1.0).abs() < 1e-12);
        assert!(mode.parts[1 - moving].translation[0][0].abs() < 1e-9);
    }
}

#[test]
fn ten_masses_in_a_chain_have_the_frequencies_and_shapes_of_theory() {
    let n = 10;
    let mut text = masses(n);
    let z = |k: usize| format!("DZ({k},{g},{g})", g = 100 + k);
    for k in 2..n + 2 {
        let left = if k > 2 {
            format!("+400*{}", z(k - 1))
        } else {
            String::new()
        };
        let right = if k < n + 1 {
            format!("+400*{}", z(k + 1))
        } else {
            String::new()
        };
        let _ = writeln!(
            text,
            "SFORCE/{k}, TRANSLATION, ACTIONONLY, I={k}, J={}, FUNCTION=-800*{}{left}{right}",
            100 + k,
            z(k)
        );
    }
    let found = linear(&mut session(&text), &Wanted::default());
    assert_eq!(found.modes.len(), n);
    for (j, mode) in (1..).zip(&found.modes) {
        let angle = j as f64 * PI / (2.0 * (n + 1) as f64);
        close(mode.im, 40.0 * angle.sin(), 1e-12);
        let shape: Vec<f64> = (1..=n).map(|k| (2.0 * angle * k as f64).sin()).collect();
        let largest = shape
            .iter()
            .fold(0.0_f64, |m, x| if x.abs() > m.abs() { *x } else { m });
        // the largest may be reached twice, once with each sign
        let sign = mode.parts[0].translation[0][0].signum() * (shape[0] / largest).signum();
        for (part, x) in mode.parts.iter().zip(&shape) {
            let found = part.translation[0][0];
            assert!(
                (found - sign * x / largest).abs() < 1e-9,
                "mode {j}: {found} {}",
                x / largest
            );
        }
    }
}

fn pendulum(joint: &str) -> String {
    format!(
        "PART/2, MASS=2, CM=2, IP=0.1,0.1,0.1, REULER=30D,0,0\nMARKER/2, PART=2, QP=0,-1.5,0\n\
         MARKER/3, PART=2\n{joint}ACCGRAV/JGRAV=-9.81\n"
    )
}

#[test]
fn a_pendulum_swings_about_its_equilibrium_whatever_its_joint_is_made_of() {
    let omega = (2.0 * 9.81 * 1.5 / (0.1 + 2.0 * 1.5_f64.powi(2))).sqrt();
    for joint in [
        "JOINT/1, REVOLUTE, I=3, J=1\n",
        "JPRIM/1, ATPOINT, I=3, J=1\nJPRIM/2, PARALLEL_AXES, I=3, J=1\n",
    ] {
        let mut s = session(&pendulum(joint));
        rest(&mut s);
        let found = linear(&mut s, &Wanted::default());
        assert_eq!(found.modes.len(), 1, "{}", found.table());
        close(found.modes[0].im, omega, 1e-10);
        assert!(found.modes[0].re.abs() < 1e-9);
        let shape = &found.modes[0].parts[0];
        close(shape.translation[0][0], 1.0, 1e-12);
        close(shape.rotation[2][0], 1.0 / 1.5, 1e-9);
        assert!(shape.translation[1][0].abs() < 1e-9);
    }
}

#[test]
fn a_pendulum_upside_down_has_a_mode_that_grows() {
    let mut s = session(&pendulum("JOINT/1, REVOLUTE, I=3, J=1\n").replace("30D", "180D"));
    let found = linear(&mut s, &Wanted::default());
    let omega = (2.0 * 9.81 * 1.5 / (0.1 + 2.0 * 1.5_f64.powi(2))).sqrt();
    let mut real: Vec<f64> = found.modes.iter().map(|m| m.re).collect();
    real.sort_by(f64::total_cmp);
    assert_eq!(real.len(), 2);
    close(real[0], -omega, 1e-10);
    close(real[1], omega, 1e-10);
}

/// A mass with spring 25 and damper 2; its force has the input VARIABLE/1 (which is 3 already), the outputs are its place and force.
fn plant() -> String {
    format!(
        "{}VARIABLE/1, FUNCTION=3\nVARIABLE/2, FUNCTION=DZ(2,102,102)\nVARIABLE/3, FUNCTION=SFORCE(1,0,2,0)\n\
         SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=102, FUNCTION=-25*DZ(2,102,102)-2*VZ(2,102,102)+VARVAL(1)\n\
         PINPUT/1, VARIABLES=1\nPOUTPUT/1, VARIABLES=2,3\n",
        masses(1)
    )
}

#[test]
fn a_damped_mass_has_its_matrices_and_its_damping_ratio() {
    let found = linear(&mut session(&plant()), &Wanted::default());
    assert_eq!(found.a, [[0.0, 1.0], [-25.0, -2.0]]);
    assert_eq!(found.b, [[0.0], [1.0]]);
    assert_eq!(found.c, [[1.0, 0.0], [-25.0, -2.0]]);
    assert_eq!(found.d, [[0.0], [1.0]]);
    close(found.modes[0].frequency(), 5.0 / TAU, 1e-13);
    close(found.modes[0].damping_ratio(), 0.2, 1e-13);
    assert_eq!(found.inputs, ["VARIABLE/1"]);
    let undamped = Wanted {
        no_damping: true,
        ..Wanted::default()
    };
    let found = linear(&mut session(&plant()), &undamped);
    assert_eq!(found.a, [[0.0, 1.0], [-25.0, 0.0]]);
}

#[test]
fn a_linear_system_in_a_model_comes_out_as_it_went_in() {
    let text = "VARIABLE/1, FUNCTION=0\nARRAY/10, U, VARIABLES=1\nARRAY/11, X\nARRAY/12, Y\n\
                MATRIX/1, FULL=RORDER, ROWS=2, COLUMNS=2, VALUES=0,1,-5,-0.6\n\
                MATRIX/2, FULL=RORDER, ROWS=2, COLUMNS=1, VALUES=0,1\n\
                MATRIX/3, FULL=RORDER, ROWS=1, COLUMNS=2, VALUES=2,3\nMATRIX/4, FULL=RORDER, ROWS=1, COLUMNS=1, VALUES=7\n\
                LSE/1, X=11, U=10, Y=12, A=1, B=2, C=3, D=4\nVARIABLE/2, FUNCTION=ARYVAL(12,1)\n\
                PINPUT/1, VARIABLES=1\nPOUTPUT/1, VARIABLES=2\n";
    let found = linear(&mut session(text), &Wanted::default());
    assert_eq!(found.a, [[0.0, 1.0], [-5.0, -0.6]]);
    assert_eq!(found.b, [[0.0], [1.0]]);
    assert_eq!(found.c, [[2.0, 3.0]]);
    assert_eq!(found.d, [[7.0]]);
    assert_eq!(found.states, ["LSE/1 state 1", "LSE/1 state 2"]);
}

#[test]
fn a_command_file_settles_then_linearizes() {
    let text = pendulum("JOINT/1, REVOLUTE, I=3, J=1\n");
    let script = Script::from_text(
        "\nFILE/MODEL=x\nSIMULATE/STATIC\nLINEAR/EIGENSOL\nLINEAR/STATEMAT, FILE=plant\nSTOP\n",
    )
    .unwrap_or_else(|e| panic!("{e}"));
    let mut s = session(&text);
    obeys(&mut s, &script);
    assert_eq!(s.linear.len(), 2);
    assert!(!s.linear[0].1 && s.linear[1].1);
    assert_eq!(s.linear[1].0.as_deref(), Some("plant"));
    let text = s.linear[1].2.matlab();
    assert!(text.contains("A = [\n0e0 1e0\n-6."), "{text}");
    assert!(text.contains("B = zeros(2,0);"));
    assert_eq!(
        s.linear[0].2.json()["modes"][0]["parts"][0]["part"],
        "PART/2"
    );
}

#[test]
fn equal_frequencies_have_shapes_of_their_own() {
    let text = format!(
        "{}SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=102, FUNCTION=-4*DZ(2,102,102)\n\
         SFORCE/2, TRANSLATION, ACTIONONLY, I=3, J=103, FUNCTION=-4*DZ(3,103,103)\n",
        masses(2)
    );
    let found = linear(&mut session(&text), &Wanted::default());
    let shape = |m: usize, p: usize| found.modes[m].parts[p].translation[0][0];
    let determinant = shape(0, 0) * shape(1, 1) - shape(0, 1) * shape(1, 0);
    assert!(determinant.abs() > 1e-3, "{determinant}");
}

/// Code and sentence of what is told of the state about which a model was linearized.
/// Free motions have two eigenvalues of zero each, and neither swing nor grow, whatever their parts are tied by.
#[test]
fn free_motions_have_eigenvalues_of_zero_and_slow_swings_have_not() {
    let free = |found: &Linearization| {
        let zeros = found.modes.iter().filter(|m| (m.re, m.im) == (0.0, 0.0));
        zeros.count()
    };
    for n in [2, 3, 5] {
        for stiffness in [1e-6, 1.0, 2e4, 1e11] {
            let mut text = masses(n);
            for k in 2..n + 1 {
                let _ = writeln!(
                    text,
                    "SFORCE/{k}, TRANSLATION, I={}, J={k}, FUNCTION=-{stiffness:?}*(DZ({},{k},{k})-1)",
                    k + 1,
                    k + 1
                );
            }
            let found = linear(&mut session(&text), &Wanted::default());
            assert_eq!(free(&found), 2, "{n} {stiffness}: {}", found.table());
            assert_eq!(found.modes.len(), 2 + (n - 1), "{n}: {}", found.table());
            let swings = found.modes.iter().filter(|m| m.im > 0.0);
            assert!(swings.clone().all(|m| m.damping_ratio().abs() < 1e-9));
            assert_eq!(swings.count(), n - 1);
        }
    }
    // bodies in space: six free motions, however they are tied to each other
    for gravity in ["", "ACCGRAV/JGRAV=-9.81\n"] {
        let body = |id: u32, place: &str| {
            format!(
                "PART/{id}, MASS=1.3, CM={id}0, IP=0.1,0.2,0.25, QG={place}, REULER=0.3,0.4,0.5\n\
                 MARKER/{id}0, PART={id}, QP=0.1,0.2,0.3\nMARKER/{id}1, PART={id}\n"
            )
        };
        let one = body(2, "0.7,0.1,0");
        let found = linear(&mut session(&format!("{one}{gravity}")), &Wanted::default());
        assert_eq!(
            (free(&found), found.modes.len()),
            (12, 12),
            "{}",
            found.table()
        );
        let two = format!(
            "{one}{}BUSHING/1, I=21, J=31, K=1E4,2E4,3E4, KT=100,200,300\n{gravity}",
            body(3, "0.7,0.1,0")
        );
        let found = linear(&mut session(&two), &Wanted::default());
        assert_eq!(
            (free(&found), found.modes.len()),
            (12, 18),
            "{}",
            found.table()
        );
        assert!(
            found.modes.iter().skip(12).all(|m| m.im > 0.0),
            "{}",
            found.table()
        );
    }
    // a swing of three hours beside one of a hundred kilohertz, and a slow fall
    let slow = |f: f64| format!("{:?}", (TAU * f).powi(2));
    let text = format!(
        "{}SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=102, FUNCTION=-{}*DZ(2,102,102)\n\
         SFORCE/2, TRANSLATION, ACTIONONLY, I=3, J=103, FUNCTION=-{}*DZ(3,103,103)\n",
        masses(2),
        slow(1e-4),
        slow(1e5)
    );
    let found = linear(&mut session(&text), &Wanted::default());
    assert_eq!(free(&found), 0, "{}", found.table());
    close(found.modes[0].frequency(), 1e-4, 1e-9);
}

fn told(s: &Session) -> Vec<String> {
    let all = s.run.record.warnings.iter();
    let all = all.filter(|w| w.code == "not_at_rest");
    all.map(|w| w.sentence()).collect()
}

#[test]
fn a_state_that_moves_or_is_no_equilibrium_is_told_once_with_its_worst_element() {
    let tilted = pendulum("JOINT/1, REVOLUTE, I=3, J=1\n");
    let falling = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nACCGRAV/JGRAV=-9.81\n";
    let beside = format!(
        "{}PART/12, MASS=1, CM=12, IP=1,1,1\nMARKER/12, PART=12\nACCGRAV/JGRAV=-9.81\n\
         SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=102, FUNCTION=-1E10*DZ(2,102,102)\n",
        masses(1)
    );
    let coasting = falling
        .replace("JGRAV=-9.81", "JGRAV=0")
        .replace("IP=", "VX=1E-3, IP=");
    let spinning = coasting.replace("VX=1E-3", "WZ=5");
    let driven = format!(
        "{}MOTION/1, JOINT=2, TRANSLATION, FUNCTION=TIME\n{}",
        masses(2),
        "SFORCE/2, TRANSLATION, ACTIONONLY, I=3, J=103, FUNCTION=-5*DZ(3,103,103)\n"
    );
    let state = format!("{}DIFF/1, FUNCTION=1-DIF(1)\n", masses(1));
    let angular = 9.81 * 1.5 * 0.5 * 2.0 / (0.1 + 2.0 * 1.5_f64.powi(2));
    for (text, subject, rate, value) in [
        (&tilted, "PART/2", Rate::AngularAcceleration, angular),
        (&falling.to_owned(), "PART/2", Rate::Acceleration, 9.81),
        (&beside, "PART/12", Rate::Acceleration, 9.81),
        (&coasting, "PART/2", Rate::Velocity, 1e-3),
        (&spinning, "PART/2", Rate::AngularVelocity, 5.0),
        (&driven, "PART/2", Rate::Velocity, 1.0),
        (&state, "DIFF/1", Rate::StateRate, 1.0),
    ] {
        let mut s = session(text);
        let found = linear(&mut s, &Wanted::default());
        let unrest = found.unrest.as_ref().unwrap_or_else(|| panic!("{text}"));
        assert_eq!(
            (unrest.subject.to_string().as_str(), unrest.rate),
            (subject, rate),
            "{text}"
        );
        close(unrest.value, value, 1e-9);
        assert_eq!(found.json()["not_at_rest"]["element"], subject);
        linear(&mut s, &Wanted::default());
        let told = told(&s);
        assert!(told.len() == 1 && told[0].starts_with(subject), "{told:?}");
    }
}

#[test]
fn an_equilibrium_is_at_rest_however_it_was_found_and_in_any_units() {
    let spring = "SPRINGDAMPER/1, TRANSLATION, I=3, J=1, K=50, C=20, LENGTH=0.2\n";
    for scale in [1e-3, 1.0, 1e3] {
        let length = |x: f64| format!("{:?}", x * scale);
        let hanging = format!(
            "PART/2, MASS=2, CM=2, IP=0.1,0.1,0.1, QG={},0,0\nMARKER/2, PART=2\nMARKER/3, PART=2\n\
             MARKER/4, PART=2, REULER=90D,90D,0\nMARKER/5, PART=1, REULER=90D,90D,0\n\
             JOINT/1, TRANSLATIONAL, I=4, J=5\nACCGRAV/IGRAV={}\n{}",
            length(0.3),
            length(9.81),
            spring.replace("LENGTH=0.2", &format!("LENGTH={}", length(0.2)))
        );
        // found at once, reached by damping, and not yet there
        let mut settled = session(&hanging);
        rest(&mut settled);
        let mut damped = session(&hanging);
        running::go(&mut damped, running::Analysis::Dynamic, 12.0, 10);
        let mut begun = session(&hanging);
        for s in [&mut settled, &mut damped] {
            let found = linear(s, &Wanted::default());
            assert_eq!(found.unrest, None, "{scale}");
            assert_eq!(told(s), [""; 0]);
            assert!(found.json()["not_at_rest"].is_null());
        }
        assert!(linear(&mut begun, &Wanted::default()).unrest.is_some());
    }
}

/// An upright top that spins at any speed: small tilts z = x + i y of its axis are exp(μ t) with
///
/// ```text
/// A μ² − i C Ω μ − m g l = 0
/// ```
#[test]
fn a_top_has_its_eigenvalues_at_any_spin() {
    for k in 0..60 {
        let spin = 0.01 * 10f64.powf(f64::from(k) / 12.0);
        let text = format!(
            "PART/2, MASS=1, CM=2, IP=0.1,0.1,0.05, WZ={spin}\nMARKER/2, PART=2, QP=0,0,0.5\nMARKER/3, PART=2\n\
             JOINT/1, SPHERICAL, I=3, J=1\nACCGRAV/KGRAV=-9.81\n"
        );
        let found = linear(&mut session(&text), &Wanted::default());
        let middle = 0.5 * 0.05 * spin / 0.35;
        let inner = 0.5 * 9.81 / 0.35 - middle * middle;
        let (re, im) = match inner > 0.0 {
            true => (inner.sqrt(), [middle; 2]),
            false => (0.0, [1.0, -1.0].map(|s| middle + s * (-inner).sqrt())),
        };
        for im in im {
            let near = found.modes.iter().any(|mode| {
                let off = (mode.re.abs() - re)
                    .abs()
                    .max((mode.im.abs() - im.abs()).abs());
                off < 1e-7 * (1.0 + spin)
            });
            let all: Vec<_> = found.modes.iter().map(|m| (m.re, m.im)).collect();
            assert!(near, "{spin}: {re} {im} is not among {all:?}");
        }
    }
}
