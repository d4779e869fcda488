//! Requests that rounding does not let any step meet: runs end in a bounded number of steps, say so, and are right.

use crate::running;

use running::{Analysis, begin, go, off, options_by, whole};

/// A light mass in the middle of a pendulum of length 2 whose heavy mass is `ratio` times as large; the joint between
/// hums, and rounding of the heavy mass shakes it.
fn double_pendulum(ratio: f64) -> String {
    format!(
        "TEST\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=20\nMARKER/20, PART=2, QP=1,0,0\n\
         MARKER/21, PART=2\nPART/3, MASS={ratio:e}, CM=30\nMARKER/30, PART=3, QP=2,0,0\n\
         MARKER/31, PART=3, QP=1,0,0\nJOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=20\n\
         ACCGRAV/JGRAV=-9.81\nEND\n"
    )
}

/// How far a pendulum of length 2 has fallen, from the level: three terms of the series are good to 1e-13 until 0.1 s.
fn fallen(t: f64) -> f64 {
    // φ̈ = r cos φ with r = g/2
    let r: f64 = 9.81 / 2.0;
    let fifth = (1.0 / 480.0 + 1.0 / 384.0) / 90.0;
    let phi = r * t * t / 2.0 - r.powi(3) * t.powi(6) / 240.0 + fifth * r.powi(5) * t.powi(10);
    -2.0 * phi.sin()
}

#[test]
fn mass_ratios_up_to_1e10_take_few_steps_at_any_request() {
    for exponent in 6..=10 {
        let ratio = 10f64.powi(exponent);
        for error in [1e-8, 1e-9, 1e-10, 1e-11, 1e-12] {
            for method in ["AUTO", "DOP853"] {
                let mut options = options_by(&["DY(30,1)", "DY(20,1)"], method, error);
                options.max_steps = Some(30_000);
                let mut s = begin(whole(&double_pendulum(ratio)), "test", options);
                go(&mut s, Analysis::Dynamic, 0.1, 4);
                let wrong = off(&s, "DY(30,1)", fallen);
                // the light mass changes the fall by about 0.01 of the ratio
                let allowed = 0.05 / ratio + 1e-11;
                assert!(wrong < allowed, "{ratio:e} at {error:e}: {wrong:e}");
                let told = (s.run.record.warned().iter()).any(|w| is_rounding(w));
                let in_vain = exponent >= 8;
                assert!(told || !in_vain, "{ratio:e} at {error:e}");
            }
        }
    }
}

/// Returns whether a warning says that rounding keeps a run from its request.
fn is_rounding(warning: &str) -> bool {
    warning.contains("below rounding") || warning.contains("cannot be reached: rounding")
}

/// An implicit method follows the hum in more steps than rounding would need, so that none is asked for in vain; what
/// rounding adds up to is more than the request all the same.
#[test]
fn an_implicit_method_takes_a_bounded_number_of_steps_and_tells_what_rounding_adds_up_to() {
    {
        let method = "RADAU5";
        for (ratio, error, tells) in [
            (1e10, 1e-8, None),
            (1e10, 1e-10, None),
            (1e10, 1e-12, Some(true)),
            (1e8, 1e-6, Some(false)),
            (1e8, 1e-12, Some(true)),
            (1e2, 1e-8, Some(false)),
            (1.0, 1e-8, Some(false)),
            (1.0, 1e-10, Some(false)),
        ] {
            let mut options = options_by(&["DY(30,1)"], method, error);
            options.max_steps = Some(60_000);
            let mut s = begin(whole(&double_pendulum(ratio)), "test", options);
            go(&mut s, Analysis::Dynamic, 0.01, 4);
            let told = s.run.record.warned();
            println!("{method} {ratio:e} {error:e}: {told:?}");
            let told = told.iter().any(|w| is_rounding(w));
            assert!(
                tells.is_none_or(|tells| tells == told),
                "{method} {ratio:e} at {error:e}"
            );
            if ratio >= 1e8 {
                let wrong = off(&s, "DY(30,1)", fallen);
                // of the largest way that the mechanism makes, 2
                assert!(
                    wrong < 2.0 * error + 1e-9,
                    "{method} {ratio:e} at {error:e}: {wrong:e}"
                );
            }
        }
    }
}

/// A free part on springs, with all its places moved by `x` along x.
fn free_part(x: f64) -> String {
    format!(
        "MARKER/9, PART=1, QP={x:e},0,0\nMARKER/8, PART=1, FLOATING\n\
         PART/2, MASS=1, CM=2, IP=0.1,0.2,0.3, QG={x:e},0,0, VX=1\nMARKER/2, PART=2\n\
         GFORCE/1, I=2, JFLOAT=8, RM=9, FX=-20*DX(2,9)\\FY=-30*DY(2,9)+SIN(TIME)\\FZ=-15*DZ(2,9)\\\
         TX=0\\TY=0\\TZ=0\n"
    )
}

/// The request is relative to the motion, not to coordinates that only the choice of an origin
/// makes large: velocities were wrong by up to 3000 requests at 10⁶.
#[test]
fn moving_a_whole_model_changes_no_answer_beyond_rounding() {
    for method in ["AUTO", "DOP853", "RADAU5"] {
        for request in [1e-2, 1e-6] {
            let columns = ["DX(2,9)", "VX(2,9)", "VY(2,9)"];
            let go_at = |x: f64| {
                let mut s = running::session_by(&free_part(x), &columns, method, request);
                go(&mut s, Analysis::Dynamic, 5.0, 50);
                let warned = s.run.record.warned();
                let values = columns.map(|column| running::values(&s, column).to_vec());
                (values, warned)
            };
            let (here, warned) = go_at(0.0);
            for x in [-1e3, 1e6] {
                let (there, warned_there) = go_at(x);
                assert_eq!(warned, warned_there, "{method} {request:e} {x:e}");
                for (column, pair) in columns.iter().zip(here.iter().zip(&there)) {
                    let largest = pair.0.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
                    let off = pair.0.iter().zip(pair.1).map(|(a, b)| (a - b).abs());
                    let off = off.fold(0.0, f64::max) / largest;
                    assert!(
                        off < 10.0 * request,
                        "{method} {request:e} {x:e} {column}: {off:e}"
                    );
                }
            }
        }
    }
}

/// A slider-crank in millimetres on the move, its loop closed to the last digits: coordinates of
/// 180 that move by little at first.
const SLIDER_CRANK: &str = "SLIDER-CRANK\n\
    UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND\nPART/1, GROUND\n\
    MARKER/1, PART=1\nMARKER/2, PART=1, REULER=90D,90D,0\n\
    PART/2, MASS=0.5, CM=20, IP=0,0,400, REULER=50D,0,0, WZ=30\n\
    MARKER/20, PART=2, QP=25,0,0\nMARKER/21, PART=2\nMARKER/22, PART=2, QP=50,0,0\n\
    PART/3, MASS=0.5, CM=30, IP=0,0,1000, QG=32.13938048432697,38.3022221559489,0, \
    REULER=-14.79327D,0,0\nMARKER/30, PART=3, QP=75,0,0\nMARKER/31, PART=3\n\
    MARKER/32, PART=3, QP=150,0,0\nPART/4, MASS=1, CM=40, QG=177.167,0,0\nMARKER/40, PART=4\n\
    MARKER/41, PART=4, REULER=90D,90D,0\nJOINT/1, REVOLUTE, I=21, J=1\n\
    JOINT/2, REVOLUTE, I=31, J=22\nJOINT/3, REVOLUTE, I=40, J=32\n\
    JOINT/4, TRANSLATIONAL, I=41, J=2\nEND\n";

/// What is permitted in a step is no less than the last digit of a coordinate: else steps become ever shorter and the run
/// stops. And Newton's iteration must not leave more than is permitted: what it left at once as rounding, 1e-13, added up
/// to 7e-9.
#[test]
fn no_method_asks_for_less_than_the_digits_of_a_coordinate_have() {
    let last = |method: &str, error: f64| {
        let mut options = options_by(&["DX(40,1)", "VX(40,1)", "WZ(20)"], method, error);
        options.max_steps = Some(50_000);
        let mut s = begin(whole(SLIDER_CRANK), method, options);
        go(&mut s, Analysis::Dynamic, 0.002, 2);
        let n_steps = s.run.record.counts.steps;
        let ends = ["DX(40,1)", "VX(40,1)", "WZ(20)"].map(|column| running::last(&s, column));
        (ends, n_steps)
    };
    let (expected, _) = last("DOP853", 1e-11);
    for error in [1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12] {
        let (ends, n_steps) = last("RADAU5", error);
        assert!(n_steps < 100, "{error:e}: {n_steps} steps");
        for (end, expected) in ends.iter().zip(&expected) {
            let off = ((end - expected) / expected).abs();
            assert!(off < error.max(1e-11), "{error:e}: {off:e}");
        }
    }
}

/// A part on a bushing, its marker off its mass, drawn 0.2 m from where the bushing is without load.
fn on_a_bushing(mass: f64, [stiffness, damping]: [f64; 2]) -> String {
    let [turning, slowing] = [stiffness, damping].map(|x| 1e-3 * x);
    let inertia = 0.1 * mass;
    format!(
        "TEST\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS={mass:e}, CM=20, IP={inertia:e},{inertia:e},{inertia:e}\n\
         MARKER/20, PART=2, QP=0.1,0.1,0.1\nMARKER/21, PART=2, QP=0.12,0.08,0.1\n\
         BUSHING/1, I=21, J=1, K={stiffness:e},{stiffness:e},{stiffness:e}, C={damping:e},{damping:e},{damping:e}, \
         KT={turning:e},{turning:e},{turning:e}, CT={slowing:e},{slowing:e},{slowing:e}\n\
         ACCGRAV/KGRAV=-9.81\nEND\n"
    )
}

/// A step far shorter than the coordinates are rounded moves by differences that no coordinate shows: methods must not
/// take these differences from rounded coordinates.
#[test]
fn short_runs_take_few_steps_however_far_from_the_origin() {
    const MOST_STEPS: usize = 5_000;
    let text = on_a_bushing(1.0, [1e5, 10.0]);
    for method in ["AUTO", "DOP853", "RADAU5"] {
        for error in [1e-3, 1e-6, 1e-8, 1e-9] {
            for end in [1e-12, 1e-9, 1e-7, 1e-6] {
                let mut options = options_by(&["VX(20)"], method, error);
                options.max_steps = Some(MOST_STEPS);
                let mut s = begin(whole(&text), method, options);
                go(&mut s, Analysis::Dynamic, end, 3);
                // from rest by -K x/m, and by the turn that the same force begins
                let wrong = off(&s, "VX(20)", begun_speed);
                let size = begun_speed(end).abs();
                assert!(
                    wrong < size * (1e-4 + 10.0 * error),
                    "{method} at {error:e} to {end:e}: {wrong:e} of {size:e}"
                );
            }
        }
    }
}

/// The speed along x that the bushing gives the mass in a time so short that nothing has moved.
fn begun_speed(t: f64) -> f64 {
    -1e5 * 0.12 * t
}

/// However much longer a run is than its first transient, the transient is followed and the rest reached.
#[test]
fn runs_end_at_rest_whatever_their_duration() {
    for (mass, law) in [(1.0, [1e5, 1e3]), (1e-3, [1e9, 1e5])] {
        let text = on_a_bushing(mass, law);
        for method in ["AUTO", "RADAU5"] {
            for error in [1e-3, 1e-5] {
                for end in [1e3, 1e6, 1e9] {
                    let mut s = begin(
                        whole(&text),
                        method,
                        options_by(&["VX(20)", "FZ(21,1,1)"], method, error),
                    );
                    go(&mut s, Analysis::Dynamic, end, 2);
                    let weight = 9.81 * mass;
                    let (speed, load) =
                        (running::last(&s, "VX(20)"), running::last(&s, "FZ(21,1,1)"));
                    let told = format!("{method} at {error:e} to {end:e}: {speed:e}, {load:e}");
                    assert!(speed.abs() < 1e-6, "{told}");
                    assert!((load - weight).abs() < 0.05 * weight, "{told}");
                }
            }
        }
    }
}

/// Corrections of stiff forces get no smaller than the rounding of positions makes them: steps grow in number as the order says,
/// and not as rounding does. (A step more than 2.5 times for each hundredth of the request; it was 5.7.)
#[test]
fn steps_of_a_stiff_bushing_are_not_shortened_for_the_rounding_of_its_force() {
    let path = format!(
        "{}/tests/data/references/stiff_bushing.adm",
        env!("CARGO_MANIFEST_DIR")
    );
    let model = cognate::model::Model::read(&path).unwrap_or_else(|e| panic!("{e}"));
    let steps = [1e-8, 1e-10].map(|error| {
        let mut s = begin(model.clone(), "bushing", options_by(&[], "RADAU5", error));
        go(&mut s, Analysis::Dynamic, 1.0, 10);
        s.run.record.counts.steps + s.run.record.counts.rejected_steps
    });
    assert!(steps[1] < 4 * steps[0], "{steps:?}");
}
