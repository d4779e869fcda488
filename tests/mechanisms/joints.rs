//! Joints, couplers and gears against closed forms; what does not depend on place, orientation and units; motions that are not smooth.

use crate::running;
use cognate::results::Quantity;
use running::{
    Analysis, Options, Session, begin, go, mistakes, model, off, options, values, whole,
};

fn session(text: &str, columns: &[&str], piecewise: bool) -> Session {
    let options = Options {
        piecewise,
        ..options(columns, 1e-10)
    };
    begin(model(text), "test", options)
}

fn run_as(text: &str, columns: &[&str], end: f64, piecewise: bool) -> Session {
    let mut s = session(text, columns, piecewise);
    go(&mut s, Analysis::Transient, end, 50);
    s
}

fn run(text: &str, columns: &[&str], end: f64) -> Session {
    run_as(text, columns, end, false)
}

/// A part at a place with a centre of mass marker `10 id`.
fn part(id: u32, place: &str) -> String {
    format!(
        "PART/{id}, MASS=1, CM={0}, IP=1,1,1, QG={place}\nMARKER/{0}, PART={id}\n",
        10 * id
    )
}

const BEND: f64 = 0.6;

/// Two shafts that meet at an angle of 0.6: the second turns as far as the first over a turn, but unevenly, by tan ψ = tan φ cos β where the
/// pin of the driving shaft stands on the plane of both at φ = 0.
#[test]
fn a_hooke_joint_turns_unevenly_and_a_constant_velocity_joint_does_not() {
    let (sin, cos) = BEND.sin_cos();
    // both shafts in the plane of x and z; the second leans by β about y
    for (joint, i, j) in [
        // cross-pin axes: x of I, y of J
        ("HOOKE", "", ""),
        // cross-pin axes: the z axes themselves
        ("UNIVERSAL", ", REULER=90D,90D,0", ", REULER=0,-90D,0"),
        ("CONVEL", "", ""),
    ] {
        let text = format!(
            "{}{}MARKER/31, PART=3{i}\nMARKER/21, PART=2{j}\n\
             MARKER/29, PART=2, QP=0,0,-1\nMARKER/19, PART=1, QP=0,0,-1\nMARKER/38, PART=3, QP=0,0,1\n\
             MARKER/18, PART=1, QP={sin},0,{cos}, ZP={},0,{}, XP={},0,{}\n\
             JOINT/1, REVOLUTE, I=29, J=19\nJOINT/2, {joint}, I=31, J=21\nJPRIM/1, INLINE, I=38, J=18\n\
             MOTION/1, JOINT=1, FUNCTION=TIME\n",
            part(2, "0,0,0"),
            // x of the second shaft in ground: (cos β, 0, −sin β)
            part(3, "0,0,0").replace(
                "QG=0,0,0",
                &format!("QG=0,0,0, ZG={sin},0,{cos}, XG={cos},0,-{sin}")
            ),
            2.0 * sin,
            2.0 * cos,
            sin + cos,
            cos - sin,
        );
        let s = run(&text, &["AZ(38,18)", "WZ(38,18,18)", "WDTZ(38,18,18)"], 7.0);
        let even = joint == "CONVEL";
        // ψ with ψ = φ at multiples of 90°, and its rates
        let angle = |t: f64| {
            use cognate::scalar::{Jet, Scalar};
            let t = Jet::variable(t);
            if even {
                return t;
            }
            let (s, c) = t.sin_cos();
            // the pin of the driving shaft stands on the plane of the shafts at φ = 0: the driven one lags first
            let b = Jet::constant(cos);
            let turned = (s * b).atan2(c);
            let turns = ((t - turned).value / std::f64::consts::TAU).round();
            turned + Jet::constant(turns * std::f64::consts::TAU)
        };
        for (k, column) in ["AZ(38,18)", "WZ(38,18,18)", "WDTZ(38,18,18)"]
            .iter()
            .enumerate()
        {
            let error = off(&s, column, |t| {
                [angle(t).value, angle(t).first, angle(t).second][k]
            });
            assert!(error < 1e-9, "{joint} {column}: {error}");
        }
        if !even {
            // over a turn the ratio goes from cos β to 1/cos β
            let ratio = values(&s, "WZ(38,18,18)");
            let (least, most) = ratio
                .iter()
                .fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
            assert!(least >= cos - 1e-9 && most <= 1.0 / cos + 1e-9 && most - least > 0.3);
        }
    }
}

#[test]
fn a_screw_advances_by_its_pitch_per_turn_and_a_rack_by_its_circumference() {
    for pitch in [0.25, -0.25] {
        let text = format!(
            "{}MARKER/2, PART=1\nJOINT/1, CYLINDRICAL, I=20, J=1\nJOINT/2, SCREW, I=20, J=2, PITCH={pitch}\n\
             MOTION/1, JOINT=1, ROTATION, FUNCTION=360D*TIME\n",
            part(2, "0,0,0")
        );
        let s = run(&text, &["DZ(20,1)"], 5.0);
        assert!(off(&s, "DZ(20,1)", |t| pitch * t) < 1e-10);
    }
    // the pinion rolls on a rack of ground: z of J along x, x of J along z
    let rack = |diameter: f64| {
        format!(
            "{}{}MARKER/2, PART=1, REULER=90D,90D,90D\nMARKER/22, PART=2, REULER=90D,90D,0\nMARKER/12, PART=1, QP=0,0.3,0, REULER=90D,90D,0\n\
             JOINT/1, TRANSLATIONAL, I=22, J=12\nJOINT/2, REVOLUTE, I=30, J=20\n\
             JOINT/3, RACKPIN, I=30, J=2, PD={diameter}\nMOTION/1, JOINT=2, FUNCTION=-90D*TIME\n",
            part(2, "0,0.3,0"),
            part(3, "0,0.3,0")
        )
    };
    // y of J points down: a pinion above the rack has a negative diameter, and clockwise it rolls along +x
    let travel = 0.3 * std::f64::consts::FRAC_PI_2;
    for (diameter, speed) in [(-0.6, travel), (0.6, -travel)] {
        let s = run(&rack(diameter), &["DX(30,1)"], 8.0);
        assert!(off(&s, "DX(30,1)", |t| speed * t) < 1e-9, "{diameter}");
    }
}

/// Sun 20 teeth, planet 20, ring 60 (fixed): the carrier turns by a quarter of the sun; with a fixed carrier a planet turns oppositely.
#[test]
fn gear_trains_turn_by_their_teeth_with_a_carrier_that_stands_or_goes() {
    let wheels = |drive: &str| {
        format!(
            "{}{}{}MARKER/41, PART=4\nMARKER/42, PART=4, QP=2,0,0\n\
             MARKER/45, PART=4, QP=1,0,0, REULER=180D,90D,0\nMARKER/46, PART=4, QP=3,0,0, REULER=180D,90D,0\nMARKER/11, PART=1\n\
             JOINT/1, REVOLUTE, I=20, J=41\nJOINT/2, REVOLUTE, I=30, J=42\nJOINT/3, REVOLUTE, I=11, J=41\n\
             GEAR/1, JOINTS=1,2, CV=45\n{drive}",
            part(2, "0,0,0"),
            part(3, "2,0,0"),
            part(4, "0,0,0"),
        )
    };
    let planetary = wheels("GEAR/2, JOINTS=2,3, CV=46\nMOTION/1, I=20, J=11, B3, FUNCTION=TIME\n");
    let s = run(&planetary, &["AZ(40,1)", "AZ(30,1)", "WZ(30,40)"], 9.0);
    assert!(off(&s, "AZ(40,1)", |t| t / 4.0) < 1e-9);
    // against the carrier the planet turns as far back as the sun turns on: 3/4
    assert!(off(&s, "AZ(30,1)", |t| t / 4.0 - 0.75 * t) < 1e-9);
    assert!(off(&s, "WZ(30,40)", |_| -0.75) < 1e-9);
    let fixed = wheels("MOTION/1, JOINT=1, FUNCTION=TIME\nMOTION/2, JOINT=3, FUNCTION=0\n");
    let s = run(&fixed, &["AZ(30,1)"], 9.0);
    assert!(off(&s, "AZ(30,1)", |t| -t) < 1e-9);
}

/// Two turns and a way, in degrees and in length: r₁ q₁ + r₂ q₂ + r₃ q₃ keeps its value.
#[test]
fn a_coupler_adds_up_three_joints_of_both_kinds() {
    let text = format!(
        "{}{}{}MARKER/12, PART=1, QP=3,0,0\nMARKER/13, PART=1, QP=6,0,0\n\
         JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, REVOLUTE, I=30, J=12\nJOINT/3, TRANSLATIONAL, I=40, J=13\n\
         COUPLER/1, JOINTS=1,2,3, TYPE=R:R:T, SCALES=2,-0.5,4\n\
         MOTION/1, JOINT=1, FUNCTION=90D*TIME\nMOTION/2, JOINT=2, FUNCTION=SIN(TIME)\n",
        part(2, "0,0,0"),
        part(3, "3,0,0"),
        part(4, "6,0,1")
    );
    let s = run(&text, &["DZ(40,13)"], 9.0);
    let way = |t: f64| 1.0 - (2.0 * std::f64::consts::FRAC_PI_2 * t - 0.5 * t.sin()) / 4.0;
    assert!(off(&s, "DZ(40,13)", way) < 1e-9);
}

/// IC, ICTRAN and ICROT begin where and as fast as they say.
#[test]
fn joints_begin_as_their_ic_says() {
    let text = format!(
        "{}{}MARKER/12, PART=1, QP=3,0,0\nJOINT/1, REVOLUTE, I=20, J=1, IC=30D,2\n\
         JOINT/2, CYLINDRICAL, I=30, J=12, ICTRAN=0.5,-1, ICROT=-40D,3\n",
        part(2, "0,0,0"),
        part(3, "3,0,0")
    );
    let s = run(&text, &["AZ(20,1)", "DZ(30,12)", "AZ(30,12)"], 1.0);
    assert!(off(&s, "AZ(20,1)", |t| 30_f64.to_radians() + 2.0 * t) < 1e-9);
    assert!(off(&s, "DZ(30,12)", |t| 0.5 - t) < 1e-9);
    assert!(off(&s, "AZ(30,12)", |t| -40_f64.to_radians() + 3.0 * t) < 1e-9);
}

/// A slider-crank of which everything may be moved, turned and measured in other units.
fn slider_crank(place: [f64; 3], euler: [f64; 3], length: f64) -> String {
    use cognate::internals::space::{Vec3, rotation};
    let r = rotation::from_313(euler[0], euler[1], euler[2]);
    let put = |x: f64, y: f64, z: f64| {
        let p = Vec3(place) + r.apply(Vec3([x, y, z]));
        let [x, y, z] = p.0.map(|x| x * length);
        format!("{x},{y},{z}")
    };
    let angles = format!("REULER={},{},{}", euler[0], euler[1], euler[2]);
    let (sin, cos) = 0.5_f64.sin_cos();
    let reach = cos + (9.0 - sin * sin).sqrt();
    let own = |x: f64, y: f64| format!("{},{},0", x * length, y * length);
    let gravity = r.apply(Vec3([0.0, -9.81 * length, 0.0])).0;
    let inertia = 0.1 * length * length;
    // a unit of force is mass times length/time² everywhere
    format!(
        "PART/2, MASS=1, CM=20, IP={inertia},{inertia},{inertia}, QG={}, {angles}\nMARKER/20, PART=2\n\
         MARKER/21, PART=2, QP={}\nMARKER/11, PART=1, QP={}, {angles}\n\
         PART/3, MASS=2, CM=30, IP={inertia},{inertia},{inertia}, QG={}, {angles}\nMARKER/30, PART=3\n\
         MARKER/31, PART=3, QP={}\nMARKER/32, PART=3, QP={}\n\
         PART/4, MASS=3, CM=40, IP={inertia},{inertia},{inertia}, QG={}, {angles}\nMARKER/40, PART=4\n\
         MARKER/41, PART=4, REULER=90D,90D,0\nMARKER/13, PART=1, QP={}, ZP={}, XP={}\n\
         JOINT/1, REVOLUTE, I=20, J=11\nJOINT/2, REVOLUTE, I=31, J=21\nJPRIM/1, INLINE, I=32, J=41\n\
         JOINT/4, TRANSLATIONAL, I=41, J=13\nGCON/1, I=32, FUNCTION=DX(32,40,40)\n\
         ACCGRAV/IGRAV={},JGRAV={},KGRAV={}\n",
        put(0.0, 0.0, 0.0),
        own(cos, sin),
        put(0.0, 0.0, 0.0),
        put(0.5 * (cos + reach), 0.5 * sin, 0.0),
        own(0.5 * (cos - reach), 0.5 * sin),
        own(0.5 * (reach - cos), -0.5 * sin),
        put(reach, 0.0, 0.0),
        put(0.0, 0.0, 0.0),
        put(1.0, 0.0, 0.0),
        put(0.0, 1.0, 0.0),
        gravity[0],
        gravity[1],
        gravity[2]
    )
}

#[test]
fn nothing_depends_on_where_a_mechanism_stands_or_in_which_units() {
    let columns = [
        "WZ(20,11,11)",
        "DX(40,11,11)",
        "JOINT(1,0,2,11)",
        "JOINT(1,0,3,11)",
        "JOINT(4,0,2,13)",
    ];
    let here = run(&slider_crank([0.0; 3], [0.0; 3], 1.0), &columns, 1.0);
    // powers of the unit of length in what is compared
    let powers = [0, 1, 1, 1, 1];
    for (place, euler, length) in [
        ([3.0, -2.0, 5.0], [0.4, 1.1, -2.0], 1.0),
        ([0.0; 3], [0.0; 3], 1000.0),
        ([-1.0, 0.5, 2.0], [-1.0, 0.3, 0.8], 0.01),
    ] {
        let there = run(&slider_crank(place, euler, length), &columns, 1.0);
        for (column, power) in columns.iter().zip(powers) {
            let size = values(&here, column)
                .iter()
                .fold(0.0, |m: f64, x| m.max(x.abs()));
            let unit = length.powi(power);
            for (a, b) in values(&here, column).iter().zip(values(&there, column)) {
                assert!(
                    (a - b / unit).abs() < 1e-7 * size,
                    "{column} {length}: {a} {b}"
                );
            }
        }
    }
}

/// A part on a slide that a MOTION drives.
fn driven(function: &str) -> String {
    format!(
        "{}JOINT/1, TRANSLATIONAL, I=20, J=1\nMOTION/1, JOINT=1, {function}\n",
        part(2, "0,0,0")
    )
}

#[test]
fn motions_that_jump_are_refused_with_their_times() {
    for (function, what, at) in [
        ("FUNCTION=IF(TIME-1: 0, 0, 0.5)", "displacement", 1.0),
        ("FUNCTION=MAX(0, TIME-0.75)", "velocity", 0.75),
        ("VELOCITY, FUNCTION=IF(TIME-1.5: 1, 1, 2)", "velocity", 1.5),
        (
            "FUNCTION=VARVAL(1)\nVARIABLE/1, FUNCTION=ABS(TIME-0.5)",
            "velocity",
            0.5,
        ),
    ] {
        let mut s = session(&driven(function), &["DZ(20,1)"], false);
        let errors = mistakes(&mut s, Analysis::Transient);
        assert_eq!(errors[0].code, "motion_jumps");
        assert_eq!(errors[0].element.as_deref(), Some("MOTION/1"));
        let message = &errors[0].message;
        assert!(
            message.contains(what) && message.contains(&format!("time {at} ")),
            "{message}"
        );
        // not within a run that ends before
        let mut s = session(&driven(function), &["DZ(20,1)"], false);
        go(&mut s, Analysis::Transient, at - 0.1, 5);
    }
}

#[test]
fn motions_whose_acceleration_jumps_run_with_a_warning() {
    for (function, times) in [
        ("FUNCTION=STEP(TIME, 0.5, 0, 1.5, 1)", ["0.5", "1.5"]),
        (
            "VELOCITY, FUNCTION=MAX(0, MIN(TIME-0.5, 1))",
            ["0.5", "1.5"],
        ),
    ] {
        let s = run(&driven(function), &["DZ(20,1)"], 2.0);
        let warned = s.run.record.warned();
        let told = warned.iter().find(|w| w.contains("MOTION/1")).unwrap();
        assert!(
            told.contains("acceleration") && times.iter().all(|t| told.contains(t)),
            "{told}"
        );
        assert!(s.run.record.piecewise.is_empty());
    }
    let s = run(
        &driven("FUNCTION=STEP5(TIME, 0.5, 0, 1.5, 1)"),
        &["DZ(20,1)"],
        2.0,
    );
    assert!(
        s.run.record.warned().is_empty(),
        "{:?}",
        s.run.record.warned()
    );
}

#[test]
fn motions_that_jump_run_piecewise_when_somebody_insists() {
    let s = run_as(
        &driven("FUNCTION=MAX(0, TIME-0.75)"),
        &["DZ(20,1)", "VZ(20,1)"],
        2.0,
        true,
    );
    assert!(off(&s, "DZ(20,1)", |t| (t - 0.75).max(0.0)) < 1e-10);
    assert!(off(&s, "VZ(20,1)", |t| f64::from(u8::from(t > 0.75))) < 1e-10);
    let jump = &s.run.record.piecewise[0];
    assert_eq!(
        (jump.motion, jump.at, jump.of),
        (1, 0.75, Quantity::Velocity)
    );
    assert!((jump.by - 1.0).abs() < 1e-12);
    // beside it a part that is free to move: its spring is not disturbed
    let text = driven("FUNCTION=IF(TIME-1: 0, 0, 0.5)")
        + &format!(
            "{}MARKER/13, PART=1, QP=3,0,0\nJOINT/2, TRANSLATIONAL, I=30, J=13\nSFORCE/1, TRANSLATIONAL, ACTIONONLY, I=30, J=13, FUNCTION=-4*DZ(30,13)\n",
            part(3, "3,0,1")
        );
    let s = run_as(&text, &["DZ(20,1)", "DZ(30,13)"], 2.0, true);
    assert!(off(&s, "DZ(30,13)", |t| (2.0 * t).cos()) < 1e-8);
    assert!(off(&s, "DZ(20,1)", |t| if t > 1.0 { 0.5 } else { 0.0 }) < 1e-12);
    assert_eq!(s.run.record.piecewise.len(), 1);
}

/// Variables of a joint as result columns: markers 20 of part 2 against 1 of ground, which stands askew.
fn variables(joint: &str, place: &str, more: &str, end: f64) -> Session {
    let text = format!(
        "TEST\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\nPART/1, GROUND\nMARKER/1, PART=1\n\
         PART/2, MASS=1, CM=20, IP=1,1,1{place}\nMARKER/20, PART=2\nJOINT/1, {joint}, I=20, J=1\n{more}END\n"
    );
    let options = Options {
        full: true,
        error: Some(1e-9),
        ..Options::default()
    };
    let mut s = begin(whole(&text), "test", options);
    go(&mut s, Analysis::Transient, end, 40);
    s
}

/// Names and units of the variables that are shown.
fn shown(s: &Session) -> Vec<(String, String)> {
    let columns = s.run.columns.iter();
    columns
        .filter_map(|c| {
            let name = c.name.strip_prefix("JOINT_1_VARIABLES.")?;
            Some((name.to_string(), c.unit.clone()))
        })
        .collect()
}

#[test]
fn every_joint_shows_its_variables_with_their_units() {
    for (joint, place, expected) in [
        ("FIXED", "", vec![]),
        ("SPHERICAL", "", vec!["angle X", "angle Y", "angle Z"]),
        ("CONVEL", "", vec!["angle X", "angle Y", "angle Z"]),
        ("REVOLUTE", "", vec!["ANGLE"]),
        ("TRANSLATIONAL", "", vec!["DISTANCE"]),
        ("CYLINDRICAL", "", vec!["DISTANCE", "ANGLE"]),
        ("SCREW, PITCH=0.5", "", vec!["DISTANCE", "ANGLE"]),
        (
            "RACKPIN, PD=0.4",
            ", REULER=90D,90D,0",
            vec!["DISTANCE", "ANGLE"],
        ),
        ("PLANAR", "", vec!["X", "Y", "ANGLE"]),
        ("HOOKE", "", vec!["ANGLE_1", "ANGLE_2"]),
        ("UNIVERSAL", ", REULER=0,90D,0", vec!["ANGLE_1", "ANGLE_2"]),
    ] {
        let s = variables(joint, place, "", 0.01);
        let expected: Vec<(String, String)> = (expected.iter())
            .map(|v| {
                // those of a ball are angles between axes, whatever they are called
                let unit = match v.to_uppercase().starts_with("ANGLE") {
                    true => "deg",
                    false => "meter",
                };
                (v.trim_start_matches("angle ").to_string(), unit.to_string())
            })
            .collect();
        assert_eq!(shown(&s), expected, "{joint}");
    }
}

/// Degrees of an angle in radians.
fn deg(angle: f64) -> f64 {
    angle.to_degrees()
}

/// Driven variables are what their motions prescribe, of I against J along and about the axes of J; angles, in degrees, count their turns.
#[test]
fn variables_of_joints_are_what_motions_prescribe() {
    let turn = "MOTION/1, JOINT=1, ROTATION, FUNCTION=-0.3+7*TIME\n";
    let slide = "MOTION/2, JOINT=1, TRANSLATION, FUNCTION=0.2-TIME\n";
    let angle = |t: f64| deg(-0.3 + 7.0 * t);
    let check = |s: &Session, variable: &str, expected: &dyn Fn(f64) -> f64| {
        let error = off(s, &format!("JOINT_1_VARIABLES.{variable}"), expected);
        // in degrees errors are 57 times those in radians
        let permitted = if variable == "ANGLE" { deg(1e-8) } else { 1e-8 };
        assert!(error < permitted, "{variable}: {error}");
    };
    let s = variables("REVOLUTE", "", turn, 2.0);
    check(&s, "ANGLE", &angle);
    let s = variables("TRANSLATIONAL", "", slide, 2.0);
    check(&s, "DISTANCE", &|t| 0.2 - t);
    let s = variables("CYLINDRICAL", "", &format!("{turn}{slide}"), 2.0);
    check(&s, "ANGLE", &angle);
    check(&s, "DISTANCE", &|t| 0.2 - t);
    let plane = "MOTION/1, I=20, J=1, X, FUNCTION=0.5*TIME\nMOTION/2, I=20, J=1, Y, FUNCTION=-TIME\nMOTION/3, I=20, J=1, B3, FUNCTION=7*TIME\n";
    let s = variables("PLANAR", "", plane, 2.0);
    check(&s, "X", &|t| 0.5 * t);
    check(&s, "Y", &|t| -t);
    check(&s, "ANGLE", &|t| deg(7.0 * t));
}

/// A right-hand thread advances along +z as it turns about +z; a negative PITCH is a left-hand one.
#[test]
fn variables_of_a_screw_advance_with_the_sign_of_its_pitch() {
    for pitch in [0.5, -0.5] {
        let more =
            "JOINT/2, CYLINDRICAL, I=20, J=1\nMOTION/1, JOINT=2, ROTATION, FUNCTION=7*TIME\n";
        let s = variables(&format!("SCREW, PITCH={pitch}"), "", more, 2.0);
        assert!(off(&s, "JOINT_1_VARIABLES.ANGLE", |t| deg(7.0 * t)) < deg(1e-8));
        let advance = |t: f64| pitch * 7.0 * t / std::f64::consts::TAU;
        assert!(
            off(&s, "JOINT_1_VARIABLES.DISTANCE", advance) < 1e-8,
            "{pitch}"
        );
    }
}

/// A pinion that rolls on a rack in ground: z of the rack along ground z, its x along the pinion's axis.
#[test]
fn variables_of_a_rack_and_pinion_roll_with_the_sign_of_pd() {
    // the pinion's z along ground x; it turns about ground x and slides along ground z
    let place = ", ZG=1,0,0, XG=0,1,0";
    let more = "JPRIM/1, INLINE, I=20, J=1\nJPRIM/2, PARALLEL_AXES, I=20, J=11\nMARKER/11, PART=1, ZP=1,0,0, XP=0,1,0\n\
                MOTION/1, I=20, J=1, Z, FUNCTION=0.7*TIME\n";
    for pd in [0.4, -0.4] {
        let s = variables(&format!("RACKPIN, PD={pd}"), place, more, 2.0);
        assert!(off(&s, "JOINT_1_VARIABLES.DISTANCE", |t| 0.7 * t) < 1e-8);
        let angle = values(&s, "JOINT_1_VARIABLES.ANGLE");
        let turned: Vec<f64> = angle.iter().map(|a| a - angle[0]).collect();
        for (t, a) in values(&s, "time").iter().zip(&turned) {
            assert!(
                (a - deg(0.7 * t / (0.5 * pd))).abs() < deg(1e-8),
                "{pd}: {t} {a}"
            );
        }
    }
}

/// Between each pair of axes of the markers, in degrees; sizes do not depend on which marker is I.
#[test]
fn variables_of_a_ball_are_the_angles_between_the_axes_of_its_markers() {
    use cognate::internals::space::rotation::about_axis;
    let r = about_axis(2, 0.4) * about_axis(0, 1.1);
    let [x, _, z] = [0, 1, 2].map(|k| r.column(k).0);
    let [xs, zs] = [x, z].map(|v| format!("{},{},{}", v[0], v[1], v[2]));
    let s = variables("SPHERICAL", &format!(", ZG={zs}, XG={xs}"), "", 0.01);
    for (k, name) in ["X", "Y", "Z"].into_iter().enumerate() {
        let expected = deg(r.0[k][k].acos());
        let found = values(&s, &format!("JOINT_1_VARIABLES.{name}"))[0];
        assert!(
            (found - expected).abs() < 1e-7,
            "{name}: {found} {expected}"
        );
    }
}

/// First about the pin of J, then about that of I: y of J and x of I for HOOKE, z of both for UNIVERSAL.
#[test]
fn variables_of_universal_joints_are_turns_about_their_pins() {
    use cognate::internals::space::rotation::about_axis;
    let quarter = about_axis(0, std::f64::consts::FRAC_PI_2);
    for (a, b) in [(0.3, -0.5), (-1.1, 0.4), (0.0, 0.7)] {
        for (joint, r) in [
            ("HOOKE", about_axis(1, a) * about_axis(0, b)),
            ("UNIVERSAL", about_axis(2, a) * quarter * about_axis(2, b)),
        ] {
            let [x, _, z] = [0, 1, 2].map(|k| r.column(k).0);
            let place = format!(
                ", ZG={},{},{}, XG={},{},{}",
                z[0], z[1], z[2], x[0], x[1], x[2]
            );
            let s = variables(joint, &place, "", 0.01);
            let found =
                ["ANGLE_1", "ANGLE_2"].map(|v| values(&s, &format!("JOINT_1_VARIABLES.{v}"))[0]);
            assert!(
                (found[0] - deg(a)).abs() < deg(1e-9) && (found[1] - deg(b)).abs() < deg(1e-9),
                "{joint} {a} {b}: {found:?}"
            );
        }
    }
}
