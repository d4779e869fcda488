//! Where contacts of curves begin, and the floating markers that go with them.

use crate::running;

use curves::{circle, curve, line};
use running::{Analysis, Session, refused, values};
use std::f64::consts::{FRAC_PI_2, PI};

use crate::curve_shapes as curves;

fn run(text: &str, columns: &[&str], analysis: Analysis, end: f64) -> Session {
    running::run(text, columns, analysis, (end, 20), 1e-10)
}

const R: f64 = 0.5;
/// The spline through 200 points of a circle is off by R (2π/200)⁴/384 in places,
const PLACE: f64 = 1e-8;
/// and its curvature by (2π/200)²/12 = 8.2e-5 of itself: speeds of contacts, and how far a disc rolls.
const ROLLING: f64 = 5e-4;

/// What columns begin with.
fn first(text: &str, columns: &[&str], analysis: Analysis) -> (Vec<f64>, Vec<String>) {
    let s = run(text, columns, analysis, 0.01);
    let values = columns.iter().map(|c| values(&s, c)[0]).collect();
    (values, s.run.record.warned())
}

fn near(found: &[f64], expected: &[f64], tolerance: f64) {
    assert!(
        (found.iter().zip(expected)).all(|(a, b)| (a - b).abs() < tolerance)
            && found.len() == expected.len(),
        "{found:?} {expected:?}"
    );
}

/// A bead on a ring about ground, which stands at (x, y) in the dataset and does not turn.
fn bead(place: [f64; 2], more: &str) -> String {
    format!(
        "PART/3, MASS=0.5, CM=30, IP=1,1,1, QG={},{},0, VY=2\nMARKER/30, PART=3\n\
         MARKER/12, PART=1, FLOATING\nMARKER/13, PART=1, QP=1,0,0, REULER=90D,0,0\n\
         JPRIM/1, ORIENTATION, I=30, J=1\nPTCV/1, CURVE=1, I=30, RM=1, JFLOAT=12{more}\n{}",
        place[0],
        place[1],
        curve(1, "CLOSED", &circle(R, 200))
    )
}

#[test]
fn a_bead_begins_at_the_point_next_to_disp() {
    let columns = ["DX(30,1)", "DY(30,1)"];
    for analysis in [Analysis::Dynamic, Analysis::InitialConditions] {
        for (place, more, expected) in [
            // nothing said: the point of the ring next to the bead
            ([0.7, 0.0], "", [R, 0.0]),
            // a quarter turn away; the other side of the ring
            ([0.5, 0.0], ", DISP=0,0.5,0", [0.0, R]),
            ([0.5, 0.0], ", DISP=-0.5,0,0", [-R, 0.0]),
            // beside the ring: the point of it next to that
            ([0.5, 0.0], ", DISP=0.6,0.8,0.3", [0.3, 0.4]),
            // in coordinates of a marker at (1, 0) with x along ground y: (1 − 1, 0 + 1)
            ([0.5, 0.0], ", DISP=1,1,0, ICM=13", [0.0, R]),
            ([0.02, -0.01], ", DISP=0.3,-0.4,0", [0.3, -0.4]),
        ] {
            let (found, warnings) = first(&bead(place, more), &columns, analysis);
            near(&found, &expected, PLACE);
            assert!(warnings.iter().all(|w| !w.contains("DISP")), "{warnings:?}");
        }
    }
}

/// The curve runs counterclockwise; VEL is along it, and goes before the velocities of parts.
#[test]
fn a_bead_begins_with_its_velocity_along_the_curve() {
    let columns = ["VX(30,1)", "VY(30,1)"];
    // the part's own VY = 2, square to the ring at the top
    let begins = |more: &str| first(&bead([R, 0.0], more), &columns, Analysis::Dynamic).0;
    near(&begins(""), &[0.0, 2.0], 1e-6);
    near(&begins(", VEL=3"), &[0.0, 3.0], 1e-6);
    near(&begins(", VEL=-3, DISP=0,0.5,0"), &[3.0, 0.0], 1e-6);
    near(&begins(", DISP=0,0.5,0"), &[0.0, 0.0], 1e-6);
}

/// An eccentric disc under a follower above its axis: the disc is turned until the point asked for is under the follower.
fn cam(more: &str, ties: &str) -> String {
    format!(
        "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=0.2,0,0\n\
         MARKER/22, PART=2, FLOATING\nMARKER/23, PART=3, FLOATING\n\
         PART/3, MASS=0.5, CM=30, IP=1,1,1, QG=0,0.4,0\nMARKER/30, PART=3\n\
         MARKER/31, PART=3, REULER=0,-90D,0\nMARKER/11, PART=1, REULER=0,-90D,0\n\
         JOINT/1, REVOLUTE, I=20, J=1{more}\nJOINT/2, TRANSLATIONAL, I=31, J=11\n{ties}{}",
        curve(1, "CLOSED", &circle(R, 200))
    )
}

#[test]
fn a_disc_is_turned_to_where_its_follower_is_to_begin() {
    let columns = ["DX(30,21,21)", "DY(30,21,21)", "DX(30,1)", "DX(22,21,21)"];
    for analysis in [
        Analysis::Dynamic,
        Analysis::InitialConditions,
        Analysis::Static,
    ] {
        for angle in [-0.7_f64, 0.3, 1.2, 2.0] {
            let (x, y) = (R * angle.cos(), R * angle.sin());
            let tie = format!("PTCV/1, CURVE=1, I=30, RM=21, JFLOAT=22, DISP={x},{y},0\n");
            // where nothing loads it, an equilibrium is where it begins
            let (found, _) = first(&cam("", &tie), &columns, analysis);
            near(&found, &[x, y, 0.0, x], PLACE);
        }
    }
}

/// What the constraints do not permit is told, with the distance.
#[test]
fn a_beginning_that_constraints_forbid_is_told() {
    let tie = "MOTION/1, JOINT=1, FUNCTION=TIME\nPTCV/1, CURVE=1, I=30, RM=21, DISP=0,0.5,0\n";
    let (found, warnings) = first(&cam("", tie), &["DY(30,1)"], Analysis::Kinematic);
    let above = (R * R - 0.04).sqrt();
    near(&found, &[above], PLACE);
    // from (0, 0.5) to (−0.2, above) of the disc
    let off = 0.2_f64.hypot(0.5 - above);
    let told = warnings
        .iter()
        .find(|w| w.contains("PTCV/1 DISP cannot be met"));
    let told = told.unwrap_or_else(|| panic!("{warnings:?}"));
    assert!(
        told.contains(&format!("{off:.4}")) && told.contains("CURVE/1"),
        "{told} {off}"
    );
}

/// A disc in the plane on a line along ground x.
fn disc(more: &str) -> String {
    format!(
        "PART/2, MASS=1, CM=20, IP=1,1,1, QG=0,0.8,0\nMARKER/20, PART=2\nMARKER/22, PART=2, FLOATING\n\
         MARKER/12, PART=1, FLOATING\nJOINT/1, PLANAR, I=20, J=1\n\
         CVCV/1, ICURVE=1, IRM=20, IFLOAT=22, JCURVE=2, JRM=1, JFLOAT=12{more}\n{}{}",
        curve(1, "CLOSED", &circle(R, 200)),
        curve(2, "OPEN", &line(-3.0, 3.0))
    )
}

#[test]
fn two_curves_begin_to_touch_where_idisp_and_jdisp_say() {
    let columns = ["DX(20,1)", "DY(20,1)", "AZ(20,1)", "DX(22,1)", "DY(12,1)"];
    let begins = |more: &str| first(&disc(more), &columns, Analysis::Dynamic).0;
    // the lowest point of the disc, where the line is next to it
    near(&begins(""), &[0.0, R, 0.0, 0.0, 0.0], PLACE);
    let there = begins(", JDISP=1.2,0,0");
    near(&there, &[1.2, R, 0.0, 1.2, 0.0], ROLLING);
    near(&there[3..], &[1.2, 0.0], PLACE);
    // (0.5, 0) of the disc comes down by a quarter turn backwards; least changes of a turn alone
    let down = begins(", IDISP=0.5,0,0");
    near(&[down[1], down[2], down[4]], &[R, -FRAC_PI_2, 0.0], PLACE);
    near(
        &begins(", IDISP=-0.5,0,0, JDISP=-0.7,0,0"),
        &[-0.7, R, FRAC_PI_2, -0.7, 0.0],
        PLACE,
    );
}

/// Places at which the curves touch move along the disc with IVEL and along the line with JVEL.
#[test]
fn two_curves_begin_with_ivel_and_jvel() {
    let columns = ["VX(20,1)", "VY(20,1)", "WZ(20,1)", "VX(12,1)", "VX(22,1)"];
    let begins = |more: &str| first(&disc(more), &columns, Analysis::Dynamic).0;
    // the contact runs forward along the line, and counterclockwise along the disc: the disc turns backwards by IVEL/R
    near(
        &begins(", IVEL=1, JVEL=2"),
        &[2.0, 0.0, -2.0, 2.0, 2.0],
        ROLLING,
    );
    // rolling without sliding: both run alike
    near(
        &begins(", IVEL=2, JVEL=2"),
        &[2.0, 0.0, -4.0, 2.0, 2.0],
        ROLLING,
    );
}

/// On a ring at the angle φ: origin on the bead, x along the ring, y outwards, and what turns with them.
#[test]
fn the_floating_marker_goes_with_the_bead() {
    let columns = [
        "AZ(12,1)",
        "DX(12,30)",
        "DY(12,30)",
        "WZ(12,1)",
        "WDTZ(12,1)",
        "VX(12,1)-VX(30,1)",
        "VY(12,1)-VY(30,1)",
        "ACCX(12,1)-ACCX(30,1)",
        "ACCY(12,1)-ACCY(30,1)",
        "PTCV(1,0,2,12)",
        "PTCV(1,0,3,12)",
        "DX(30,1)",
        "DY(30,1)",
        "VX(30,1,12)",
        "FY(30,12,12)",
        "DX(1,12,12)",
        "DY(1,12,12)",
    ];
    let text = format!("{}ACCGRAV/JGRAV=-9.81\n", bead([R, 0.0], ""));
    let s = run(&text, &columns, Analysis::Dynamic, 1.0);
    for k in 0..21 {
        let at = |c: &str| values(&s, c)[k];
        let (x, y) = (at("DX(30,1)"), at("DY(30,1)"));
        let phi = y.atan2(x);
        // tangent counterclockwise: φ + 90°; y outwards is then to the right of it, so that z is against ground z
        let speed = at("VX(30,1,12)");
        near(&[at("DX(12,30)"), at("DY(12,30)")], &[0.0, 0.0], 1e-9);
        for rate in &columns[5..9] {
            near(&[at(rate)], &[0.0], 1e-6 * (1.0 + speed * speed));
        }
        // the curvature of the spline wavers by (2π/200)²/12 of itself
        near(&[at("WZ(12,1)")], &[speed / R], 1e-3 * (1.0 + speed.abs()));
        near(&[at("DX(1,12,12)"), at("DY(1,12,12)")], &[0.0, -R], 1e-6);
        let push = -0.5 * (speed * speed / R) + 0.5 * 9.81 * phi.sin();
        near(&[at("PTCV(1,0,2,12)")], &[0.0], 1e-9);
        near(
            &[at("PTCV(1,0,3,12)"), at("FY(30,12,12)")],
            &[push, push],
            2e-2,
        );
    }
}

/// Floating markers of two curves lie on each other with a common tangent; what they exert is along their normal.
#[test]
fn floating_markers_of_two_curves_touch() {
    let ties = format!(
        "MOTION/1, JOINT=1, FUNCTION=TIME\nACCGRAV/JGRAV=-9.81\n\
         CVCV/1, ICURVE=2, IRM=30, IFLOAT=23, JCURVE=1, JRM=21, JFLOAT=22\n{}",
        curve(2, "OPEN", &line(-1.0, 1.0))
    );
    let columns = [
        "DM(23,22)",
        "DX(23,1)",
        "DY(23,1)",
        "VX(23,1)",
        "AZ(23,1)",
        "WZ(22,1)",
        "CVCV(1,0,2,23)",
        "CVCV(1,0,3,23)",
        "CVCV(1,0,3,0)",
    ];
    let s = run(&cam("", &ties), &columns, Analysis::Kinematic, 2.0);
    for (k, &t) in values(&s, "time").iter().enumerate() {
        let at = |c: &str| values(&s, c)[k];
        // under the centre of the disc, which runs on a circle of 0.2; tangents of the spline are off by some 1e-7
        near(&[at("DM(23,22)")], &[0.0], 1e-9);
        near(
            &[at("DX(23,1)"), at("DY(23,1)"), at("AZ(23,1)")],
            &[0.2 * t.cos(), R + 0.2 * t.sin(), 0.0],
            1e-6,
        );
        near(&[at("VX(23,1)")], &[-0.2 * t.sin()], ROLLING);
        // the tangent of the disc stays level while the disc turns
        near(&[at("WZ(22,1)"), at("CVCV(1,0,2,23)")], &[0.0, 0.0], 1e-9);
        near(&[at("CVCV(1,0,3,23)")], &[at("CVCV(1,0,3,0)")], 1e-9);
    }
}

/// On a straight piece there is no centre of curvature: the normal is square to the tangent all the same.
#[test]
fn a_floating_marker_has_axes_on_a_straight_curve() {
    let text = format!(
        "PART/3, MASS=1, CM=30, IP=1,1,1, VX=0.2\nMARKER/30, PART=3\nMARKER/12, PART=1, FLOATING\n\
         JPRIM/1, ORIENTATION, I=30, J=1\nPTCV/1, CURVE=1, I=30, RM=1, JFLOAT=12\n{}",
        curve(1, "OPEN", &line(-1.0, 1.0))
    );
    let columns = [
        "DX(12,1)",
        "VX(12,1)",
        "WM(12,1)",
        "INCANG(12,1,30)",
        "AZ(12,1)",
        "AX(12,1)",
    ];
    let s = run(&text, &columns[..3], Analysis::Dynamic, 1.0);
    for (k, &t) in values(&s, "time").iter().enumerate() {
        let at = |c: &str| values(&s, c)[k];
        near(
            &[at("DX(12,1)"), at("VX(12,1)"), at("WM(12,1)")],
            &[0.2 * t, 0.2, 0.0],
            1e-9,
        );
    }
    let s = run(&text, &columns[4..], Analysis::Dynamic, 0.1);
    // y to the right of the tangent, so that z points against ground z
    near(&[values(&s, "AZ(12,1)")[0]], &[0.0], 1e-12);
    near(&[values(&s, "AX(12,1)")[0].abs()], &[PI], 1e-12);
}

/// What a floating marker is depends on constraints: a GCON may not read it.
#[test]
fn a_gcon_may_not_read_a_floating_marker() {
    let text = format!("{}GCON/1, I=30, FUNCTION=DX(12,1)\n", bead([R, 0.0], ""));
    let told = refused(&text, Analysis::Dynamic);
    assert_eq!(told.code, "gcon_reads");
    assert!(told.message.contains("DX(12,1)") && told.message.contains("floating"));
}

/// A bead on a ring, a disc on a line, a rod that is a GCON: where they stand and in which unit of length.
fn placed(place: [f64; 3], euler: [f64; 3], length: f64) -> String {
    use cognate::internals::space::{Vec3, rotation};
    let r = rotation::from_313(euler[0], euler[1], euler[2]);
    let put = |p: [f64; 3]| {
        let [x, y, z] = (Vec3(place) + r.apply(Vec3(p))).0.map(|x| x * length);
        format!("{x:.17},{y:.17},{z:.17}")
    };
    let angles = format!("REULER={:?}", euler).replace(['[', ']', ' '], "");
    let speed = |v: [f64; 3]| {
        let [x, y, z] = r.apply(Vec3(v)).0.map(|x| x * length);
        format!("VX={x:.17}, VY={y:.17}, VZ={z:.17}")
    };
    let [gx, gy, gz] = r.apply(Vec3([0.0, -9.81, 0.0])).0.map(|x| x * length);
    let inertia = 0.1 * length * length;
    let part = |id: u32, p: [f64; 3], v: [f64; 3]| {
        format!(
            "PART/{id}, MASS=2, CM={id}0, IP={inertia},{inertia},{inertia}, QG={}, {angles}, {}\nMARKER/{id}0, PART={id}\n",
            put(p),
            speed(v)
        )
    };
    let scaled = |points: Vec<[f64; 2]>| -> Vec<[f64; 2]> {
        points.iter().map(|p| p.map(|x| x * length)).collect()
    };
    format!(
        "MARKER/2, PART=1, QP={}, {angles}\nACCGRAV/IGRAV={gx:.17},JGRAV={gy:.17},KGRAV={gz:.17}\n{}{}{}\
         JPRIM/1, ORIENTATION, I=20, J=2\nPTCV/1, CURVE=1, I=20, RM=2\n\
         JOINT/1, PLANAR, I=30, J=2\nCVCV/1, ICURVE=1, IRM=30, JCURVE=2, JRM=2\n\
         JOINT/2, PLANAR, I=40, J=2\nGCON/1, I=40, FUNCTION=DM(40,2)-{}\n{}{}",
        put([0.0; 3]),
        part(2, [0.0, R, 0.0], [1.0, 0.0, 0.0]),
        part(3, [0.1, R, 0.0], [0.5, 0.0, 0.0]),
        part(4, [1.2, -1.6, 0.0], [0.8, 0.6, 0.0]),
        2.0 * length,
        curve(1, "CLOSED", &scaled(circle(R, 200))),
        curve(2, "OPEN", &scaled(line(-3.0, 3.0))),
    )
}

#[test]
fn contacts_and_general_constraints_depend_neither_on_place_nor_on_units() {
    let columns = [
        ("DX(20,2,2)", 1),
        ("PTCV(1,0,2,2)", 1),
        ("PTCV(1,0,3,2)", 1),
        ("DX(30,2,2)", 1),
        ("WZ(30,2,2)", 0),
        ("CVCV(1,0,3,2)", 1),
        ("DX(40,2,2)", 1),
        ("FY(40,2,2)", 1),
    ];
    let names: Vec<&str> = columns.iter().map(|c| c.0).collect();
    let here = run(
        &placed([0.0; 3], [0.0; 3], 1.0),
        &names,
        Analysis::Dynamic,
        0.5,
    );
    for (place, euler, length) in [
        ([3.0, -2.0, 5.0], [0.4, 1.1, -2.0], 1.0),
        ([0.0; 3], [0.0; 3], 1000.0),
        ([-1.0, 0.5, 2.0], [-1.0, 0.3, 0.8], 0.01),
    ] {
        let there = run(
            &placed(place, euler, length),
            &names,
            Analysis::Dynamic,
            0.5,
        );
        for (name, power) in columns {
            let (a, b) = (values(&here, name), values(&there, name));
            let size = a.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
            for (a, b) in a.iter().zip(b) {
                // curvature of the spline wavers by 8e-5 from piece to piece: its jumps cost steps their last digits
                let b = b / length.powi(power);
                assert!((a - b).abs() < 1e-6 * size, "{name} {length}: {a} {b}");
            }
        }
    }
}

/// With the curves exchanged the motion is the same and the reaction on I reversed; what acts on J is what acts on I reversed.
#[test]
fn exchanging_the_curves_reverses_the_reaction() {
    let columns = [
        "DX(20,1)",
        "WZ(20,1)",
        "CVCV(1,0,2,0)",
        "CVCV(1,0,3,0)",
        "CVCV(1,1,3,0)",
        "VY(20,1)",
    ];
    let one = disc("").replace("QG=0,0.8,0", "QG=0,0.5,0, VX=1, WZ=2");
    let one = format!("{one}ACCGRAV/IGRAV=2, JGRAV=-9.81\n");
    let other = one.replace(
        "ICURVE=1, IRM=20, IFLOAT=22, JCURVE=2, JRM=1, JFLOAT=12",
        "ICURVE=2, IRM=1, IFLOAT=12, JCURVE=1, JRM=20, JFLOAT=22",
    );
    assert_ne!(one, other);
    let (one, other) = (
        run(&one, &columns, Analysis::Dynamic, 0.5),
        run(&other, &columns, Analysis::Dynamic, 0.5),
    );
    for name in columns {
        let sign = if name.starts_with("CVCV") { -1.0 } else { 1.0 };
        for (a, b) in values(&one, name).iter().zip(values(&other, name)) {
            assert!(
                (a - sign * b).abs() < 1e-6 * (1.0 + a.abs()),
                "{name}: {a} {b}"
            );
        }
    }
    for (a, b) in values(&one, "CVCV(1,0,3,0)")
        .iter()
        .zip(values(&one, "CVCV(1,1,3,0)"))
    {
        assert!(
            (a + b).abs() < 1e-12 * (1.0 + a.abs()) && *a > 0.0,
            "{a} {b}"
        );
    }
}

/// What a constraint exerts does no work on what it permits: forces times velocities, torques times spins of I and J add up to nothing.
#[test]
fn reactions_of_contacts_and_general_constraints_do_no_work() {
    let power = |force: &str, i: &str| {
        let on = |c: &str, v: &str, k: usize| {
            format!(
                "{}*{v}({i},2,2)",
                force.replace('@', &k.to_string()).replace('#', c)
            )
        };
        format!(
            "{}+{}+{}",
            on("X", "VX", 2),
            on("Y", "VY", 3),
            on("Z", "VZ", 4)
        )
    };
    let bead = power("PTCV(1,0,@,2)", "20");
    let rod = power("F#(40,2,2)", "40");
    // about the contact, which on the disc of I has the velocity of its centre and that of its turning
    let disc = "CVCV(1,0,2,2)*(VX(30,2,2)+WZ(30,2,2)*DY(30,2,2))+CVCV(1,0,3,2)*VY(30,2,2)+CVCV(1,0,8,2)*WZ(30,2,2)";
    let columns = [bead.as_str(), rod.as_str(), disc];
    let s = run(
        &placed([3.0, -2.0, 5.0], [0.4, 1.1, -2.0], 1.0),
        &columns,
        Analysis::Dynamic,
        0.5,
    );
    for name in columns {
        for p in values(&s, name) {
            assert!(p.abs() < 1e-7, "{name}: {p}");
        }
    }
}

#[test]
fn numbers_of_a_matrix_count_where_a_file_is_named_as_well() {
    let text = bead([0.7, 0.0], "");
    let named = text.replacen("MATRIX/1,", "MATRIX/1, FILE=points.txt, NAME=ring,", 1);
    assert_ne!(text, named);
    let column = ["DX(30,1)"];
    let (plain, _) = first(&text, &column, Analysis::Dynamic);
    let (with_file, _) = first(&named, &column, Analysis::Dynamic);
    assert_eq!(plain, with_file);
    let told = running::model(&named).check();
    let told = told
        .iter()
        .any(|d| d.element.as_deref() == Some("MATRIX/1"));
    assert!(told, "that FILE is not read");
}

/// A contact point does not jump between outputs, however far apart these are.
#[test]
fn a_contact_point_is_where_it_is_however_few_outputs_there_are() {
    let tie = "MOTION/1, JOINT=1, FUNCTION=4*TIME\nPTCV/1, CURVE=1, I=30, RM=21, DISP=0,0.5,0\n";
    let columns = ["DX(30,21,21)", "DY(30,21,21)", "DY(30,1)"];
    for (analysis, text) in [
        (Analysis::Kinematic, cam("", tie)),
        (Analysis::Dynamic, bead([0.5, 0.0], ", DISP=0.5,0,0")),
    ] {
        let columns = match analysis {
            Analysis::Kinematic => &columns[..],
            _ => &columns[2..],
        };
        let at_end = |outputs: usize| -> Vec<f64> {
            let s = running::run(&text, columns, analysis, (3.0, outputs), 1e-8);
            columns.iter().map(|c| running::last(&s, c)).collect()
        };
        let few = at_end(1);
        assert_eq!(few, at_end(7));
        assert_eq!(few, at_end(500));
    }
}
