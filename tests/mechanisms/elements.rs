//! Constraints as elements: general constraints, motions between markers, joints against closed forms, cams.

use crate::running;

use cognate::results::Status;
use curves::{circle, curve};
use running::{Analysis, Session, go, last, off, rest, session, session_by, try_to, values};

use crate::curve_shapes as curves;

fn run(text: &str, columns: &[&str], end: f64, steps: usize) -> Session {
    running::run(text, columns, Analysis::Transient, (end, steps), 1e-10)
}

/// Code and words of the refusal of a model.
fn refused(text: &str) -> (String, String) {
    let e = running::refused(text, Analysis::Transient);
    let element = e.element.unwrap_or_default();
    (e.code.to_string(), format!("{element}: {}", e.message))
}

/// A point mass body that swings about ground, held at a distance by different means.
fn swing(tie: &str) -> String {
    format!(
        "PART/2, QG=1,0,0, MASS=2, CM=20, IP=0.1,0.1,0.1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=-1,0,0\n\
         JPRIM/1, INPLANE, I=20, J=1\nJPRIM/2, PARALLEL_AXES, I=20, J=1\n{tie}ACCGRAV/JGRAV=-9.81\n"
    )
}

/// A rod of length 1 as a distance, and as the point at its other end.
#[test]
fn a_distance_written_as_gcon_is_a_rod() {
    let columns = ["DX(20,1)", "DY(20,1)", "FX(1,20)", "FY(1,20)", "FX(20,1)"];
    let gcon = run(
        &swing("GCON/1, I=1, FUNCTION=DM(20,1)-1\nMOTION/9, I=20, J=1, B3, FUNCTION=0\n"),
        &columns,
        2.0,
        40,
    );
    // the same without friction at its ends: a pendulum of a point mass
    let length = |k: usize| values(&gcon, "DX(20,1)")[k].hypot(values(&gcon, "DY(20,1)")[k]);
    for k in 0..41 {
        assert!((length(k) - 1.0).abs() < 1e-11);
        let (x, y) = (values(&gcon, "DX(20,1)")[k], values(&gcon, "DY(20,1)")[k]);
        // v² = −2 g y, the rod pulls by m (v² − g y) towards ground: on ground it pulls along (x, y)
        let pull = 2.0 * 9.81 * -3.0 * y;
        let (fx, fy) = (values(&gcon, "FX(1,20)")[k], values(&gcon, "FY(1,20)")[k]);
        assert!((fx - pull * x).abs() < 1e-6 && (fy - pull * y).abs() < 1e-6);
        assert!((values(&gcon, "FX(20,1)")[k] + fx).abs() < 1e-12);
    }
}

/// A law of places and time: a bead on a line that is lifted.
#[test]
fn a_gcon_of_time_moves_what_it_holds() {
    let text = "PART/2, QG=0.5,0.25,0, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\n\
                JOINT/1, PLANAR, I=20, J=1\nMOTION/1, I=20, J=1, X, FUNCTION=0.5+TIME\n\
                MOTION/2, I=20, J=1, B3, FUNCTION=0\n\
                VARIABLE/1, FUNCTION=DX(20,1)**2\nGCON/1, I=20, FUNCTION=DY(20,1)-VARVAL(1)-SIN(TIME)\n";
    let s = run(
        text,
        &["DY(20,1)", "VY(20,1)", "ACCY(20,1)", "FY(20,1)"],
        1.0,
        10,
    );
    let x = |t: f64| 0.5 + t;
    assert!(off(&s, "DY(20,1)", |t| x(t).powi(2) + t.sin()) < 1e-11);
    assert!(off(&s, "VY(20,1)", |t| 2.0 * x(t) + t.cos()) < 1e-9);
    assert!(off(&s, "ACCY(20,1)", |t| 2.0 - t.sin()) < 1e-9);
}

/// A wheel that rolls, its angle read by a GCON, which begins at zero: there a quotient of the angle's derivatives is
/// infinite on the side that is not taken.
#[test]
fn an_angle_that_a_gcon_reads_may_be_any_by_every_method() {
    for angle in [0, 37, 90, 120] {
        for method in ["AUTO", "DOP853", "RADAU5"] {
            for read in ["AZ(20,1)", "ATAN2(DY(21,20), DX(21,20))"] {
                let text = format!(
                    "PART/2, MASS=2, CM=20, IP=1,1,0.25, REULER={angle}D,0,0\nMARKER/20, PART=2\n\
                     MARKER/21, PART=2, QP=1,0,0\nJOINT/1, PLANAR, I=20, J=1\nMARKER/4, PART=1, REULER=90D,90D,0\n\
                     GCON/1, FUNCTION=DX(20)+0.5*{read}\nSFORCE/1, TRANSLATIONAL, ACTIONONLY, I=20, J=4, FUNCTION=6\n"
                );
                let mut s = session_by(&text, &["VX(20)", "WZ(20)"], method, 1e-6);
                go(&mut s, Analysis::Dynamic, 0.25, 2);
                for (column, rate) in [("VX(20)", 2.0), ("WZ(20)", -4.0)] {
                    let off = off(&s, column, |t| rate * t);
                    assert!(off < 1e-5, "{column} {angle} {method} {read}: {off:e}");
                }
            }
        }
    }
}

#[test]
fn a_gcon_of_accelerations_or_forces_is_refused_by_name() {
    let with = |function: &str| refused(&swing(&format!("GCON/1, I=20, FUNCTION={function}\n")));
    let (code, what) = with("ACCX(20,1)-WZ(20,1)");
    assert_eq!(code, "gcon_reads");
    assert!(
        what.contains("GCON/1") && what.contains("ACCX(20,1)") && what.contains("accelerations"),
        "{what}"
    );
    let (_, what) = with("DX(20,1)-FX(20,1)");
    assert!(
        what.contains("FX(20,1)") && what.contains("forces"),
        "{what}"
    );
    let (_, what) = with("VARVAL(1)\nVARIABLE/1, FUNCTION=WDTZ(20)");
    assert!(what.contains("WDTZ(20) (in VARIABLE/1)"), "{what}");
}

#[test]
fn a_motion_reads_time_alone() {
    let driven = |function: &str, more: &str| {
        swing(&format!(
            "MOTION/1, I=20, J=1, X, FUNCTION={function}\n{more}"
        ))
    };
    let (code, what) = refused(&driven("1-DY(20,1)", ""));
    assert_eq!(code, "motion_reads");
    assert!(
        what.contains("MOTION/1")
            && what.contains("DY(20,1)")
            && what.contains("where the parts are"),
        "{what}"
    );
    let (_, what) = refused(&driven(
        "VARVAL(1)",
        "VARIABLE/1, FUNCTION=TIME*VARVAL(2)\nVARIABLE/2, FUNCTION=VX(20)\n",
    ));
    assert!(what.contains("VX(20) (in VARIABLE/2)"), "{what}");
    // a state is a function of time where its equation reads nothing else
    let (_, what) = refused(&driven(
        "DIF(1)",
        "DIFF/1, IC=1, FUNCTION=-DIF(1)+DZ(20,1)\n",
    ));
    assert!(what.contains("DZ(20,1)"), "{what}");
    // VARIABLEs of time, numbers of arrays and splines are functions of time
    let s = run(
        &driven(
            "VARVAL(1)+ARYVAL(1,2)*TIME+CUBSPL(TIME,0,1,0)",
            "VARIABLE/1, FUNCTION=COS(TIME)\nARRAY/1, IC, SIZE=2, NUMBERS=4,0.25\nSPLINE/1, X=-1,0,1,2,3, Y=0,0,0,0,0\n",
        ),
        &["DX(20,1)"],
        1.0,
        5,
    );
    assert!(off(&s, "DX(20,1)", |t| t.cos() + 0.25 * t) < 1e-10);
}

/// A free body whose six places are driven one by one, and what they should be.
const COMPONENTS: [(&str, &str); 6] = [
    ("X", "DX(20,1,1)"),
    ("Y", "DY(20,1,1)"),
    ("Z", "DZ(20,1,1)"),
    ("B1", "ORIENT(1,1,20,1)"),
    ("B2", "ORIENT(1,2,20,1)"),
    ("B3", "ORIENT(1,3,20,1)"),
];

fn place(k: usize, t: f64) -> f64 {
    0.1 * (k as f64) + 0.3 * (t * (1.0 + 0.2 * k as f64)).sin()
}

#[test]
fn motions_between_markers_at_all_levels_lead_to_the_same_places() {
    let columns: Vec<&str> = COMPONENTS.iter().map(|c| c.1).collect();
    // B1 = 0.3, B2 = 0.4, B3 = 0.5 of the start, as the 3-1-3 angles of the dataset
    let r = {
        use cognate::internals::space::rotation::about_axis;
        about_axis(0, 0.3) * about_axis(1, 0.4) * about_axis(2, 0.5)
    };
    let (z, x) = (r.column(2).0, r.column(0).0);
    for level in ["DISPLACEMENT", "VELOCITY", "ACCELERATION"] {
        for given in [false, true] {
            let mut text = String::from("MARKER/2, PART=1, QP=1,-2,3, REULER=20D,40D,-70D\n");
            // without ICDISP it begins where the dataset has it
            let start = if given {
                "QG=0.3,-0.2,0.1".to_string()
            } else {
                format!(
                    "QG=0,0.1,0.2, ZG={},{},{}, XG={},{},{}",
                    z[0],
                    0.1 + z[1],
                    0.2 + z[2],
                    x[0],
                    0.1 + x[1],
                    0.2 + x[2]
                )
            };
            text += &format!("PART/2, MASS=1, CM=20, IP=1,2,3, {start}\nMARKER/20, PART=2\n");
            for (k, (component, _)) in COMPONENTS.iter().enumerate() {
                let w = 1.0 + 0.2 * k as f64;
                let (start, amplitude) = (0.1 * k as f64, 0.3);
                let function = match level {
                    "DISPLACEMENT" => format!("{start}+{amplitude}*SIN({w}*TIME)"),
                    "VELOCITY" => format!("{amplitude}*{w}*COS({w}*TIME)"),
                    _ => format!("-{amplitude}*{w}**2*SIN({w}*TIME)"),
                };
                let mut begin = String::new();
                if given && level != "DISPLACEMENT" {
                    begin += &format!(", ICDISP={start}");
                }
                if level == "ACCELERATION" {
                    begin += &format!(", ICVEL={}", amplitude * w);
                }
                text += &format!(
                    "MOTION/{}, I=20, J=1, {component}, {level}{begin}\n, FUNCTION={function}\n",
                    k + 1
                );
            }
            let s = run(&text, &columns, 2.0, 20);
            for (k, column) in columns.iter().enumerate() {
                let error = off(&s, column, |t| place(k, t));
                assert!(error < 1e-8, "{level} {given} {column}: {error}");
            }
        }
    }
}

/// What drives one coordinate does not depend on whether it is a joint of the forest or a pair of markers.
#[test]
fn a_driven_joint_is_a_driven_pair_of_markers() {
    let body = "PART/2, MASS=2, CM=20, IP=1,1,1, QG=1,0,0\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=-1,0,0\n\
                JOINT/1, REVOLUTE, I=21, J=1\nACCGRAV/JGRAV=-9.81\n";
    let by = |motion: &str| {
        let columns = [
            "AZ(21,1)",
            "WZ(21,1)",
            "WDTZ(21,1)",
            "MOTION(1,0,8,0)",
            "JOINT(1,0,2,0)",
        ];
        let s = run(&format!("{body}{motion}\n"), &columns, 1.0, 10);
        columns.map(|c| values(&s, c).to_vec())
    };
    let joint = by("MOTION/1, JOINT=1, ROTATION, FUNCTION=0.2+TIME**2");
    for other in [
        "MOTION/1, I=21, J=1, B3, FUNCTION=0.2+TIME**2",
        "MOTION/1, JOINT=1, ROTATION, VELOCITY, ICDISP=0.2, FUNCTION=2*TIME",
        "MOTION/1, I=21, J=1, B3, VELOCITY, ICDISP=0.2, FUNCTION=2*TIME",
        "MOTION/1, JOINT=1, ROTATION, ACCELERATION, ICDISP=0.2, ICVEL=0, FUNCTION=2",
        "MOTION/1, I=21, J=1, B3, ACCELERATION, ICDISP=0.2, FUNCTION=2",
    ] {
        for (a, b) in joint.iter().flatten().zip(by(other).iter().flatten()) {
            assert!((a - b).abs() < 1e-7 * (1.0 + a.abs()), "{other}: {a} {b}");
        }
    }
}

#[test]
fn a_gcon_between_markers_of_one_body_moves_nothing() {
    let mut random = 0.5_f64;
    let mut draw = move || {
        random = (random * 997.3 + 0.137).fract();
        4000.0 * random - 2000.0
    };
    for _ in 0..24 {
        let [x, y, z, a, b, c] = std::array::from_fn(|_| draw());
        let (alpha, beta, gamma) = (a / 1000.0, b.abs() / 700.0, c / 1000.0);
        let text = format!(
            "UNITS/SYSTEM=MKS\nPART/2, MASS=1, CM=20, IP=1,2,3, QG={x},{y},{z}, REULER={alpha},{beta},{gamma}\n\
             MARKER/20, PART=2\nMARKER/21, PART=2, QP={a},{b},{c}, REULER={gamma},{alpha},{beta}\n\
             PART/3, MASS=1, CM=30, IP=1,2,3, QG={x},{y},{z}, REULER={alpha},{beta},{gamma}\nMARKER/30, PART=3\n\
             MARKER/31, PART=3, QP={y},{z},{a}\nMARKER/11, PART=1, QP={x},{y},{z}\nJOINT/1, HOOKE, I=20, J=12\n\
             MARKER/12, PART=1, QP={x},{y},{z}, REULER={alpha},{beta},{gamma}\nJOINT/2, FIXED, I=30, J=20\n"
        );
        let distance = (a - y).hypot(b - z).hypot(c - a);
        let text = text + &format!("GCON/1, I=21, FUNCTION=DM(21,31)-{distance}\n");
        let s = run(&text, &["PSI(20,12)", "THETA(20,12)"], 1e-3, 1);
        let told = s.run.record.warned();
        assert!(
            told.iter().all(|w| !w.contains("is turned")),
            "{told:?}\n{text}"
        );
        assert!(off(&s, "THETA(20,12)", |_| 0.0) < 1e-6, "{text}");
    }
}

#[test]
fn a_motion_given_by_its_acceleration_begins_with_the_velocities_of_the_parts() {
    let bodies = "PART/2, MASS=2, CM=20, IP=1,1,1, QG=1,0,0, WZ=W1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=-1,0,0\n\
                  MARKER/22, PART=2, QP=1,0,0\nPART/3, MASS=1, CM=30, IP=1,1,1, QG=3,0,0, WZ=W2\nMARKER/30, PART=3\n\
                  MARKER/31, PART=3, QP=-1,0,0\nJOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=22\n\
                  PART/4, MASS=1, CM=40, IP=1,1,1, QG=0,5,0, VX=V\nMARKER/40, PART=4\nMARKER/41, PART=4, REULER=90D, 90D, 0\n\
                  MARKER/14, PART=1, QP=0,5,0, REULER=90D, 90D, 0\nJOINT/3, TRANSLATIONAL, I=41, J=14\nACCGRAV/JGRAV=-9.81\n";
    let columns = ["AZ(31,22)", "DX(40,1)", "AZ(21,1)"];
    for (w1, w2, v) in [(2.0, -3.0, 0.5), (0.0, 1.5, -4.0), (-1.0, -1.0, 0.0)] {
        let bodies = (bodies
            .replace("W1", &format!("{w1}"))
            .replace("W2", &format!("{w2}")))
        .replace("VX=V", &format!("VX={v}"));
        for motions in [
            "MOTION/2, JOINT=2, ROTATION, ACCELERATION, FUNCTION=2\nMOTION/3, JOINT=3, TRANSLATION, ACCELERATION, FUNCTION=-3\n",
            "MOTION/2, I=31, J=22, B3, ACCELERATION, FUNCTION=2\nMOTION/3, I=40, J=1, X, ACCELERATION, FUNCTION=-3\n",
            "MOTION/1, JOINT=1, ACCELERATION, FUNCTION=1\nMOTION/2, JOINT=2, ACCELERATION, FUNCTION=2\n\
             MOTION/3, JOINT=3, ACCELERATION, FUNCTION=-3\n",
        ] {
            let s = run(&format!("{bodies}{motions}"), &columns, 1.0, 10);
            let told = s.run.record.warned();
            assert!(
                told.iter().all(|w| !w.contains("cannot be met")),
                "{told:?}"
            );
            assert!(
                off(&s, "AZ(31,22)", |t| (w2 - w1) * t + t * t) < 1e-6,
                "{motions}"
            );
            assert!(
                off(&s, "DX(40,1)", |t| v * t - 1.5 * t * t) < 1e-6,
                "{motions}"
            );
            if motions.contains("MOTION/1") {
                assert!(
                    off(&s, "AZ(21,1)", |t| w1 * t + 0.5 * t * t) < 1e-6,
                    "{motions}"
                );
            }
        }
    }
}

const R: f64 = 0.05;
const ECCENTRIC: f64 = 0.02;

/// A disc that turns about a point beside its centre under a follower that goes up and down above that point.
fn cam_and_follower(height: f64, tie: &str) -> String {
    format!(
        "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP={ECCENTRIC},0,0\n\
         MARKER/22, PART=2, FLOATING\n\
         PART/3, MASS=0.5, CM=30, IP=1,1,1, QG=0,{height},0\nMARKER/30, PART=3\n\
         MARKER/31, PART=3, REULER=0,-90D,0\nMARKER/11, PART=1, REULER=0,-90D,0\n\
         JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, TRANSLATIONAL, I=31, J=11\n{tie}ACCGRAV/JGRAV=-9.81\n{}",
        curve(1, "CLOSED", &circle(R, 200))
    )
}

/// Height, velocity and acceleration of what stays at a distance from the centre of the disc while it turns by t.
fn lift(distance: f64, t: f64) -> [f64; 3] {
    use cognate::scalar::{Jet, Scalar};
    let t = Jet::variable(t);
    let (s, c) = t.sin_cos();
    let e = Jet::constant(ECCENTRIC);
    let y = e * s + (Jet::constant(distance).square() - (e * c).square()).sqrt();
    [y.value, y.first, y.second]
}

#[test]
fn a_point_rides_on_a_disc_as_the_triangle_says() {
    let columns = [
        "DY(30,1)",
        "VY(30,1)",
        "ACCY(30,1)",
        "PTCV(1,0,3,0)",
        "PTCV(1,0,2,0)",
        "PTCV(1,1,3,0)",
        "PTCV(1,0,5,0)",
        "FY(30,22)",
    ];
    let turns = 3.0 * std::f64::consts::TAU;
    let drive = "PTCV/1, CURVE=1, I=30, JFLOAT=22, RM=21\nMOTION/1, JOINT=1, FUNCTION=TIME\n";
    let s = run(&cam_and_follower(0.045, drive), &columns, turns, 300);
    for k in 0..3 {
        // each derivative of the spline is two orders worse than the one before
        let tolerance = [1e-9, 1e-6, 1e-4][k];
        let error = off(&s, columns[k], |t| lift(R, t)[k]);
        assert!(error < tolerance, "{}: {error}", columns[k]);
    }
    let t = values(&s, "time");
    for (k, &t) in t.iter().enumerate() {
        // the contact pushes along the line from the centre to the follower
        let (x, y) = (-ECCENTRIC * t.cos(), lift(R, t)[0] - ECCENTRIC * t.sin());
        let up = 0.5 * (lift(R, t)[2] + 9.81);
        let (fy, fx) = (
            values(&s, "PTCV(1,0,3,0)")[k],
            values(&s, "PTCV(1,0,2,0)")[k],
        );
        assert!((fy - up).abs() < 1e-4, "{fy} {up}");
        assert!((fx - up * x / y).abs() < 1e-4);
        assert!((values(&s, "PTCV(1,1,3,0)")[k] + fy).abs() < 1e-12);
        assert!(values(&s, "PTCV(1,0,5,0)")[k].abs() < 1e-12);
        assert!((values(&s, "FY(30,22)")[k] - fy).abs() < 1e-12);
    }
}

#[test]
fn a_flat_and_a_roller_ride_on_a_disc() {
    let line: Vec<[f64; 2]> = (0..5).map(|k| [0.05 * f64::from(k) - 0.1, 0.0]).collect();
    let roller = 0.015;
    for (follower, kind, points, height) in [
        ("flat", "OPEN", line, 0.08),
        ("roller", "CLOSED", circle(roller, 200), 0.07),
    ] {
        let columns = [
            "DY(30,1)",
            "VY(30,1)",
            "ACCY(30,1)",
            "CVCV(1,0,3,0)",
            "CVCV(1,1,3,0)",
            "CVCV(1,0,5,0)",
        ];
        let tie = format!(
            "CVCV/1, ICURVE=2, IRM=30, JCURVE=1, JRM=21\nMOTION/1, JOINT=1, FUNCTION=TIME\n{}",
            curve(2, kind, &points)
        );
        let s = run(&cam_and_follower(height, &tie), &columns, 7.0, 70);
        let expected = |t: f64| match follower {
            "flat" => [
                ECCENTRIC * t.sin() + R,
                ECCENTRIC * t.cos(),
                -ECCENTRIC * t.sin(),
            ],
            _ => lift(R + roller, t),
        };
        for k in 0..3 {
            let tolerance = [1e-9, 1e-6, 1e-4][k];
            let error = off(&s, columns[k], |t| expected(t)[k]);
            assert!(error < tolerance, "{follower} {}: {error}", columns[k]);
        }
        assert!(off(&s, "CVCV(1,0,3,0)", |t| 0.5 * (expected(t)[2] + 9.81)) < 1e-4);
        assert!(off(&s, "CVCV(1,1,3,0)", |t| -0.5 * (expected(t)[2] + 9.81)) < 1e-4);
        assert!(off(&s, "CVCV(1,0,5,0)", |_| 0.0) < 1e-12);
    }
}

/// Contact forces of a cam do no work, so that a bead on a wire keeps its energy; it comes round many times.
#[test]
fn a_bead_on_a_closed_wire_keeps_its_energy() {
    let text = format!(
        "PART/3, MASS=0.5, CM=30, IP=1,1,1, QG={R},0,0, VY=2\nMARKER/30, PART=3\n\
         JPRIM/1, PARALLEL_AXES, I=30, J=1\nMOTION/1, I=30, J=1, B3, FUNCTION=0\n\
         PTCV/1, CURVE=1, I=30, RM=1\nACCGRAV/JGRAV=-9.81\n{}",
        curve(1, "CLOSED", &circle(R, 200))
    );
    let s = run(
        &text,
        &[
            "DX(30,1)",
            "DY(30,1)",
            "VM(30,1)",
            "PTCV(1,0,2,0)",
            "PTCV(1,0,3,0)",
        ],
        2.0,
        200,
    );
    for k in 0..201 {
        let [x, y, v] = ["DX(30,1)", "DY(30,1)", "VM(30,1)"].map(|c| values(&s, c)[k]);
        assert!((x.hypot(y) - R).abs() < 1e-9);
        let energy = 0.5 * v * v + 9.81 * y;
        assert!((energy - 2.0).abs() < 1e-7, "{energy}");
        // towards the centre: m v²/R and what carries the weight
        let push = 0.5 * (v * v / R - 9.81 * y / R);
        let (fx, fy) = (
            values(&s, "PTCV(1,0,2,0)")[k],
            values(&s, "PTCV(1,0,3,0)")[k],
        );
        // the curvature of the spline is off by (2π/200)²/12
        assert!(
            (fx + push * x / R).abs() < 5e-3 && (fy + push * y / R).abs() < 5e-3,
            "{fx} {fy}"
        );
    }
}

#[test]
fn a_bead_rests_at_the_bottom_of_its_wire() {
    // a parabola along the valley of which a spring pulls: y = x²/2 a, bottom where m g x/a = k (l − x)
    let points: Vec<[f64; 2]> = (0..161)
        .map(|k| {
            let x = 0.025 * f64::from(k) - 2.0;
            [x, 0.5 * x * x]
        })
        .collect();
    let text = format!(
        "PART/3, MASS=2, CM=30, IP=1,1,1, QG=-1,0.8,0\nMARKER/30, PART=3\nJPRIM/1, ORIENTATION, I=30, J=1\n\
         PTCV/1, CURVE=1, I=30, RM=1\nACCGRAV/JGRAV=-9.81\n\
         VFORCE/1, I=30, JFLOAT=12, RM=1, FX=5*(1-DX(30,1))\\FY=0\\FZ=0\nMARKER/12, PART=1, FLOATING\n{}",
        curve(1, "OPEN", &points)
    );
    let mut s = session(&text, &["DX(30,1)", "DY(30,1)"], 1e-8);
    rest(&mut s);
    let x = 5.0 / (5.0 + 2.0 * 9.81);
    let last = |c: &str| last(&s, c);
    assert!(
        (last("DX(30,1)") - x).abs() < 1e-6,
        "{} {x}",
        last("DX(30,1)")
    );
    assert!((last("DY(30,1)") - 0.5 * x * x).abs() < 1e-6);
}

/// A cam that lifts by a cycloid, stays up, comes down, stays down: a point above its axis.
#[test]
fn a_cam_with_dwells_leaves_its_follower_alone() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let rise = |u: f64| u - (std::f64::consts::TAU * u).sin() / std::f64::consts::TAU;
    let radius = move |angle: f64| {
        let a = angle.rem_euclid(std::f64::consts::TAU) / quarter;
        let up = match a {
            a if a < 1.0 => rise(a),
            a if a < 2.0 => 1.0,
            a if a < 3.0 => rise(3.0 - a),
            _ => 0.0,
        };
        0.05 + 0.02 * up
    };
    let n = 720;
    let mut points: Vec<[f64; 2]> = (0..n)
        .map(|k| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(n);
            [radius(angle) * angle.cos(), radius(angle) * angle.sin()]
        })
        .collect();
    points.push(points[0]);
    let text = format!(
        "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\n\
         PART/3, MASS=0.5, CM=30, IP=1,1,1, QG=0,0.06,0\nMARKER/30, PART=3\n\
         MARKER/31, PART=3, REULER=0,-90D,0\nMARKER/11, PART=1, REULER=0,-90D,0\n\
         JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, TRANSLATIONAL, I=31, J=11\n\
         MOTION/1, JOINT=1, FUNCTION=TIME\nPTCV/1, CURVE=1, I=30, RM=20\n{}",
        curve(1, "CLOSED", &points)
    );
    let s = run(
        &text,
        &["DY(30,1)", "VY(30,1)"],
        2.0 * std::f64::consts::TAU,
        400,
    );
    // above the axis the cam shows its radius at 90° − t; the spline is off by 0.02 (2π/720)⁴ f⁗/384
    let shown = |t: f64| radius(quarter - t);
    assert!(
        off(&s, "DY(30,1)", shown) < 1e-7,
        "{}",
        off(&s, "DY(30,1)", shown)
    );
    for (&t, &v) in values(&s, "time").iter().zip(values(&s, "VY(30,1)")) {
        let a = (quarter - t).rem_euclid(std::f64::consts::TAU) / quarter;
        let dwells = (1.05..1.95).contains(&a) || (3.05..3.95).contains(&a);
        assert!(!dwells || v.abs() < 1e-6, "{t}: {v}");
    }
}

/// A pin that drives a wheel through a slot in it, and leaves the slot at its end.
#[test]
fn a_geneva_wheel_turns_while_the_pin_is_in_its_slot() {
    let crank = 1.0;
    let centres = 2.0_f64.sqrt();
    let slot: Vec<[f64; 2]> = (0..5)
        .map(|k| [-(0.35 + 0.165 * f64::from(k)), 0.0])
        .collect();
    let text = format!(
        "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP={crank},0,0\n\
         PART/3, MASS=2, CM=30, IP=1,1,3, QG={centres},0,0\nMARKER/30, PART=3\nMARKER/10, PART=1, QP={centres},0,0\n\
         JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, REVOLUTE, I=30, J=10\n\
         MOTION/1, JOINT=1, FUNCTION=TIME-0.7\nPTCV/1, CURVE=1, I=21, RM=30\n{}",
        curve(1, "OPEN", &slot)
    );
    let columns = [
        "AZ(30,10)",
        "WZ(30,10)",
        "JOINT(2,0,1,0)",
        "JOINT(2,0,8,0)",
        "MOTION(1,0,8,0)",
    ];
    let wheel = |t: f64| {
        use cognate::scalar::{Jet, Scalar};
        let a = Jet::variable(t) - Jet::constant(0.7);
        let (s, c) = a.sin_cos();
        let d = Jet::constant(centres);
        -(s.atan2(d - c))
    };
    let s = run(&text, &columns, 1.4, 140);
    assert!(off(&s, "AZ(30,10)", |t| wheel(t).value) < 1e-11);
    assert!(off(&s, "WZ(30,10)", |t| wheel(t).first) < 1e-9);
    // what drives the crank is what the wheel's inertia takes, by the ratio of speeds
    let torque = |t: f64| 3.0 * wheel(t).second * wheel(t).first;
    assert!(
        off(&s, "MOTION(1,0,8,0)", torque) < 1e-7,
        "{}",
        off(&s, "MOTION(1,0,8,0)", torque)
    );
    // the wheel's hinge holds what the pin exerts across the slot, and takes no torque about its axis
    let across = |t: f64| {
        let reach = (1.0 + centres * centres - 2.0 * centres * (t - 0.7).cos()).sqrt();
        (3.0 * wheel(t).second / reach).abs()
    };
    assert!(off(&s, "JOINT(2,0,1,0)", across) < 1e-7);
    assert!(off(&s, "JOINT(2,0,8,0)", |_| 0.0) < 1e-9);
    // on and on: the pin leaves the slot where its distance from the wheel's centre is 1.01
    let mut s = session(&text, &columns, 1e-8);
    let status = try_to(&mut s, Analysis::Transient, 3.0, 300);
    assert_eq!(status, Status::Stopped);
    let angle = ((1.0 + 2.0 - 1.01_f64.powi(2)) / (2.0 * centres)).acos();
    let when = 0.7 + angle;
    let why = &s.run.record.stop_reason;
    let told: f64 = why["stopped at time ".len()..]
        .split(':')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!((told - when).abs() < 1e-9, "{why} {when}");
    assert!(
        why.contains("CURVE/1") && why.contains("(-1.010000, 0.000000") && why.contains("extend"),
        "{why}"
    );
    assert_eq!(s.run.record.simulations[0].worst, ["PTCV/1"]);
    assert!(values(&s, "time").last().unwrap() <= &when);
}

/// A body of mass 3 whose centre is beside the axis of its joint, driven along that axis while gravity pulls askew. The
/// MOTION exerts what the body needs along the drive and the JOINT all the rest, both on I, whichever part I stands on.
#[test]
fn a_motion_exerts_what_its_drive_needs_and_the_joint_the_rest() {
    let slide = "0.4*SIN(2*TIME)";
    let turn = "0.5*TIME+TIME**3";
    for (joint, motions) in [
        ("REVOLUTE", vec![("ROTATION", "B3", turn)]),
        ("TRANSLATIONAL", vec![("TRANSLATION", "Z", slide)]),
        (
            "CYLINDRICAL",
            vec![("TRANSLATION", "Z", slide), ("ROTATION", "B3", turn)],
        ),
    ] {
        for (i, j) in [(20, 10), (10, 20)] {
            for by_markers in [false, true] {
                let mut text = format!(
                    "PART/2, MASS=3, CM=21, IP=1,1,2\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=0.5,0.2,0\nMARKER/10, PART=1\n\
                     JOINT/1, {joint}, I={i}, J={j}\nACCGRAV/IGRAV=3, JGRAV=-4, KGRAV=-12\n"
                );
                for (k, (kind, component, function)) in motions.iter().enumerate() {
                    text += &if by_markers {
                        format!(
                            "MOTION/{}, I={i}, J={j}, {component}, FUNCTION={function}\n",
                            k + 1
                        )
                    } else {
                        format!("MOTION/{}, JOINT=1, {kind}, FUNCTION={function}\n", k + 1)
                    };
                }
                // on the part by Newton and Euler, about the part's marker of the joint
                let a = ["3*(ACCX(21,1)-3)", "3*(ACCY(21,1)+4)", "3*(ACCZ(21,1)+12)"];
                let about_z = format!("(2*WDTZ(21,1)+DX(21,20)*{}-DY(21,20)*{})", a[1], a[0]);
                let sign = if i == 20 { "" } else { "-" };
                let drives: Vec<String> = (1..=motions.len())
                    .map(|k| format!("MOTION({k},0,"))
                    .collect();
                let sum = |c: usize| {
                    let parts = drives.iter().map(|m| format!("+{m}{c},0)"));
                    parts.collect::<String>()
                };
                let slides = joint != "REVOLUTE";
                let turns = joint != "TRANSLATIONAL";
                let mut zero = vec![
                    format!("JOINT(1,0,2,0)-({sign}{})", a[0]),
                    format!("JOINT(1,0,3,0)-({sign}{})", a[1]),
                    // all of it is on I, and its opposite on J
                    format!("FZ({i},{j})-JOINT(1,0,4,0){}", sum(4).replace('+', "-")),
                    format!("TZ({i},{j})-JOINT(1,0,8,0){}", sum(8).replace('+', "-")),
                    format!("FZ({i},{j})-({sign}{})", a[2]),
                    format!("TZ({i},{j})-({sign}{about_z})"),
                    format!("{}4,0)+{}4,0)", drives[0], drives[0].replace(",0,", ",1,")),
                    format!("{}8,0)+{}8,0)", drives[0], drives[0].replace(",0,", ",1,")),
                ];
                let mut some = Vec::new();
                for (drives, component) in [(slides, 4), (turns, 8)] {
                    let (joint, motion) = (format!("JOINT(1,0,{component},0)"), sum(component));
                    zero.push(if drives {
                        joint.clone()
                    } else {
                        motion.clone()
                    });
                    some.push(if drives { motion } else { joint });
                }
                let columns: Vec<&str> = zero.iter().chain(&some).map(String::as_str).collect();
                let s = running::run(&text, &columns, Analysis::Kinematic, (1.0, 10), 1e-8);
                for c in &zero {
                    let off = off(&s, c, |_| 0.0);
                    assert!(
                        off < 1e-9,
                        "{joint} I={i}, by markers: {by_markers}: {c} = {off:e}"
                    );
                }
                for c in &some {
                    assert!(off(&s, c, |_| 0.0) > 1.0, "nothing to exert: {joint} {c}");
                }
            }
        }
    }
}

#[test]
fn what_is_wrong_with_curves_is_said() {
    let line: Vec<[f64; 2]> = (0..5).map(|k| [0.05 * f64::from(k) - 0.1, 0.0]).collect();
    let drive = "MOTION/1, JOINT=1, FUNCTION=TIME\n";
    // a follower that begins beside the end of its line
    let beside = |x: f64, line: &[[f64; 2]], more: &str| {
        cam_and_follower(
            0.07,
            &format!(
                "{drive}MARKER/39, PART=3, QP={x},0,0{more}\nCVCV/1, ICURVE=2, IRM=39, JCURVE=1, JRM=21\n{}",
                curve(2, "OPEN", line)
            ),
        )
    };
    let (code, what) = refused(&beside(1.0, &line, ""));
    assert_eq!(code, "curve_left", "{what}");
    assert!(
        what.contains("CVCV/1") && what.contains("CURVE/2") && what.contains("first point (-0.1"),
        "{what}"
    );
    let (code, what) = refused(&beside(0.0, &line, ", REULER=0,10D,0"));
    assert_eq!(code, "curves_not_coplanar", "{what}");
    // two straight lines
    let text = beside(0.0, &line, "").replace("JCURVE=1, JRM=21", "JCURVE=2, JRM=20");
    assert_eq!(refused(&text).0, "no_common_tangent");
    let user = cam_and_follower(
        0.045,
        &format!("{drive}PTCV/1, CURVE=3, I=30, RM=21\nCURVE/3, CLOSED, FUNCTION=USER(1)\n"),
    );
    let (code, what) = refused(&user);
    assert_eq!(code, "curve_data");
    assert!(what.contains("CURVE/3") && what.contains("USER"), "{what}");
}
