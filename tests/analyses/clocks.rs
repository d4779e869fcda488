//! What time shakes faster than the mechanism moves is met when it is, whatever the method, its request, the outputs and the end.

use crate::running;

use cognate::results::{Event, Status};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use running::{Analysis, begin, go, last, model, options_by, try_to};

const METHODS: [&str; 3] = ["AUTO", "DOP853", "RADAU5"];

/// A part of one kilogram at `z`, with a velocity along z.
fn drifts(z: f64, v: f64) -> String {
    format!(
        "PART/2, MASS=1, CM=2, IP=1,1,1, VZ={v:?}\nMARKER/2, PART=2, QP=0,0,{z:?}\n\
         JOINT/1, TRANSLATIONAL, I=2, J=1\n"
    )
}

/// The first time after 0 at which a wave of a frequency reaches what drifts towards it.
///
/// ```text
/// sin(ω t) ≥ z + v t
/// ```
fn first_touch(omega: f64, z: f64, v: f64) -> f64 {
    let above = |t: f64| (omega * t).sin() - z - v * t;
    // the wave rises above its least distance once in each period
    let mut crest = (v / omega).acos() / omega;
    while above(crest) < 0.0 {
        crest += std::f64::consts::TAU / omega;
    }
    let (mut a, mut b) = (crest - std::f64::consts::PI / omega, crest);
    for _ in 0..200 {
        let middle = 0.5 * (a + b);
        if above(middle) < 0.0 {
            a = middle;
        } else {
            b = middle;
        }
    }
    b
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 40,
        rng_seed: RngSeed::Fixed(33),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Clocks up to 3000 times as fast as the mechanism.
    #[test]
    fn a_wall_that_shakes_is_met_when_it_is(
        decades in 0.5f64..3.5,
        z in 1.5f64..3.0,
        v in -2.0f64..-0.2,
        method in prop::sample::select(&METHODS[..]),
        digits in 3i32..9,
        steps in prop::sample::select(&[1usize, 7, 100][..]),
        longer in 1.2f64..30.0,
        form in 0usize..4,
    ) {
        let omega = 10f64.powf(decades);
        let touch = first_touch(omega, z, v);
        let wall = format!("SIN({omega:?}*TIME)");
        let watched = match form {
            0 => format!("SENSOR/1, FUNCTION={wall}-DZ(2,1)\\, VALUE=0, GE, ERROR=0, HALT\n"),
            1 => format!("SENSOR/1, FUNCTION=DZ(2,1)-{wall}\\, VALUE=0, LE, ERROR=0, HALT\n"),
            2 => format!("SENSOR/1, FUNCTION=(DZ(2,1)-{wall})/(1+DZ(2,1)**2)\\, VALUE=0, LE, ERROR=0, HALT\n"),
            _ => format!("VARIABLE/1, FUNCTION={wall}\nSENSOR/1, FUNCTION=VARVAL(1)-DZ(2,1)\\, VALUE=0, EQ, ERROR=0, HALT\n"),
        };
        let text = format!("{}{watched}", drifts(z, v));
        let options = options_by(&["DZ(2,1)"], method, 10f64.powi(-digits));
        let mut s = begin(model(&text), "test", options);
        let status = try_to(&mut s, Analysis::Dynamic, longer * touch, steps);
        let off = (s.time() - touch).abs() * omega;
        prop_assert!(off < 1e-3, "{method} 1e-{digits}: {} instead of {touch}, {status:?}\n{text}", s.time());
    }
}

#[test]
fn a_force_of_a_wall_that_shakes_acts_by_every_method_and_request() {
    // told by steps of 0.1 s at most
    let (z, v) = (0.430953351, 0.194162159);
    let wall = "SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=2, J=1, FUNCTION=MAX(0,1E3*(0.2*SIN(60*TIME)-DZ(2,1)))\n";
    for method in METHODS {
        for error in [1e-3, 1e-5, 1e-7] {
            let text = format!("{}{wall}", drifts(0.5, -0.2));
            let mut s = begin(
                model(&text),
                "test",
                options_by(&["DZ(2,1)", "VZ(2,1)"], method, error),
            );
            go(&mut s, Analysis::Dynamic, 3.0, 40);
            let off = (last(&s, "DZ(2,1)") - z)
                .abs()
                .max((last(&s, "VZ(2,1)") - v).abs());
            // an impact by a wall that moves sixty times as fast magnifies
            assert!(off < 2000.0 * error, "{method} {error:e}: {off:e}");
        }
    }
}

#[test]
fn what_sticks_is_torn_loose_by_every_method_and_request() {
    let text = "PART/2, MASS=1, CM=20, IP=1,1,1, VZ=1\nMARKER/20, PART=2\nJOINT/2, TRANSLATIONAL, I=20, J=1\n\
                SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=20, J=1, FUNCTION=8*SIN(3*TIME)-5*SIGN(1,VZ(20,1))\n";
    for method in METHODS {
        for error in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8] {
            for steps in [1, 60] {
                let mut s = begin(
                    model(text),
                    "test",
                    options_by(&["DZ(20,1)"], method, error),
                );
                go(&mut s, Analysis::Dynamic, 6.0, steps);
                let off = (last(&s, "DZ(20,1)") - 0.910).abs();
                assert!(
                    off < 1e-3 + 100.0 * error,
                    "{method} {error:e} {steps}: {off:e}"
                );
            }
        }
    }
}

#[test]
fn a_sensor_of_kinematics_acts_at_its_first_instant() {
    let text = "PART/3, MASS=5, CM=3, IP=1,1,1\nMARKER/3, PART=3\nJOINT/2, TRANSLATIONAL, I=3, J=1\n\
                MOTION/1, JOINT=2, TRANSLATIONAL, FUNCTION=0.2*SIN(60*TIME)+0.001*TIME\n";
    for error in ["ERROR=1E-9", ""] {
        let sensor = format!("SENSOR/1, FUNCTION=DZ(3,1)\\, VALUE=0.2012, GE, HALT, {error}");
        let sensor = sensor.trim_end_matches([',', ' ']);
        for steps in [1, 7, 50, 400] {
            for analysis in [Analysis::Kinematic, Analysis::Dynamic] {
                let options = options_by(&["DZ(3,1)"], "AUTO", 1e-6);
                let mut s = begin(model(&format!("{text}{sensor}\n")), "test", options);
                let status = try_to(&mut s, analysis, 2.0, steps);
                assert!(
                    (s.time() - 1.282339).abs() < 1e-5,
                    "{steps} {error}: {} {status:?}",
                    s.time()
                );
                assert_ne!(status, Status::Stopped);
            }
        }
    }
}

/// What is said beside a run of a model to a time.
fn said(text: &str, method: &str, end: f64) -> Vec<String> {
    let mut s = begin(model(text), "test", options_by(&[], method, 1e-6));
    go(&mut s, Analysis::Dynamic, end, 20);
    let warning = |event: &Event| match event {
        Event::Warning(told) => Some(told.clone()),
        _ => None,
    };
    let told = s.run.log.iter().filter_map(warning);
    // the plate is not drawn where its motion begins
    told.filter(|text| !text.contains("from where its joint is drawn"))
        .collect()
}

#[test]
fn nothing_is_said_of_the_energy_of_a_motion_that_shakes_nor_of_swings_of_a_fall() {
    let falls = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=2, J=1\nACCGRAV/KGRAV=-9.81\n";
    // fast, and so slow that few nodes of a long step lie in a swing
    let shaken = [60.0, 3.9, 0.9].map(|w| {
        format!(
            "PART/3, MASS=5, CM=3, IP=1,1,1\nMARKER/3, PART=3\nJOINT/2, TRANSLATIONAL, I=3, J=1\n\
             MOTION/1, JOINT=2, TRANSLATIONAL, FUNCTION=0.2*SIN({w:?}*TIME+4)\n"
        )
    });
    let pushed = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n\
                  SFORCE/2, TRANSLATIONAL, ACTIONONLY, I=2, J=1, FUNCTION=1\n";
    let beside = |rest: &str| shaken.clone().map(|shaken| format!("{shaken}{rest}"));
    let all = [beside(falls), beside(pushed)].concat();
    for method in METHODS {
        for text in all.iter().map(String::as_str).chain([falls]) {
            for end in [0.93, 2.0] {
                let said = said(text, method, end);
                assert_eq!(said, Vec::<String>::new(), "{method} to {end}\n{text}");
            }
        }
    }
}

/// A ball of radius 0.1 that falls onto a plate which a MOTION shakes, with something that pushes them apart, as the rest of
/// the model; where it is in the end, and how fast.
fn bounced(push: &str, more: &str, method: &str, error: f64) -> [f64; 2] {
    let text = format!(
        "PART/3, MASS=5, CM=3, IP=1,1,1\nMARKER/3, PART=3\nJOINT/2, TRANSLATIONAL, I=3, J=1\n\
         MOTION/1, JOINT=2, TRANSLATIONAL, FUNCTION=0.2*SIN(60*TIME)\n{}{push}{more}",
        drifts(0.6, -0.2)
    );
    let mut s = begin(
        model(&text),
        "test",
        options_by(&["DZ(2,1)", "VZ(2,1)"], method, error),
    );
    go(&mut s, Analysis::Dynamic, 3.0, 3);
    [last(&s, "DZ(2,1)"), last(&s, "VZ(2,1)")]
}

#[test]
fn a_plate_that_shakes_is_met_by_every_law_of_contact_and_every_method() {
    let ball = "GRAPHICS/1, ELLIPSOID, CM=2, XSCALE=0.2, YSCALE=0.2, ZSCALE=0.2\n";
    let law = "IMPACT, STIFFNESS=1E3, EXPONENT=1.5, DAMPING=1, DMAX=1E-3\n";
    for push in [
        "SFORCE/1, TRANSLATIONAL, I=2, J=3, FUNCTION=IMPACT(DZ(2,3),VZ(2,3),0.1,1E3,1.5,1,1E-3)\n".to_string(),
        "SFORCE/1, TRANSLATIONAL, I=2, J=3, FUNCTION=BISTOP(DZ(2,3),VZ(2,3),0.1,5,1E3,1.5,1,1E-3)\n".to_string(),
        "SFORCE/1, TRANSLATIONAL, I=2, J=3, FUNCTION=IF(DZ(2,3)-0.1:1E3*(0.1-DZ(2,3)),0,0)\n".to_string(),
        format!("{ball}GRAPHICS/2, PLANE, RM=3, XMIN=-1, XMAX=1, YMIN=-1, YMAX=1\nCONTACT/1, IGEOM=1, JGEOM=2, {law}"),
        format!("{ball}GRAPHICS/2, BOX, CORNER=4, X=2, Y=2, Z=0.02\nMARKER/4, PART=3, QP=-1,-1,-0.02\n\
                 CONTACT/1, IGEOM=1, JGEOM=2, {law}"),
    ] {
        // steps that see each swing of the plate
        let [z, v] = bounced(&push, "INTEGRATOR/GSTIFF, HMAX=0.002\n", "DOP853", 1e-8);
        assert!(v > 0.1, "it bounces: {z} {v}");
        for method in METHODS {
            let [there, fast] = bounced(&push, "", method, 1e-4);
            let off = (there - z).abs().max((fast - v).abs());
            assert!(off < 2e-3, "{method} {push}: {off:e}");
        }
    }
}
