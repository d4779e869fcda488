//! CONTACT of curves and points in a plane: the same as of spheres and planes, several touches, sides, corners, and the limit of stiff
//! contact, which is PTCV and CVCV.

use crate::running;

use crate::curves;

use curves::{circle, curve, line};
use running::{Analysis, Session, last, mistakes, session, values};

fn run(text: &str, columns: &[&str], analysis: Analysis, end: f64, error: f64) -> Session {
    running::run(text, columns, analysis, (end, 40), error)
}

/// Nothing leaves the x–y plane: part 2 with three freedoms.
const PLANAR: &str = "JOINT/1, PLANAR, I=2, J=1\n";
const IMPACT: &str = "IMPACT, STIFFNESS=1E4, EXPONENT=1.5, DAMPING=20, DMAX=1E-3";
const POISSON: &str = "POISSON, PENALTY=1E5, RESTITUTION_COEFFICIENT=0.5";
const FRICTION: &str = "COULOMB_FRICTION=ON, MU_STATIC=0.3, MU_DYNAMIC=0.2, STICTION_TRANSITION_VELOCITY=0.01, FRICTION_TRANSITION_VELOCITY=0.1";
const COLUMNS: [&str; 6] = [
    "DX(2)",
    "DY(2)",
    "VX(2)",
    "VY(2)",
    "WZ(2)",
    "CONTACT(1,0,3,0)",
];

/// However far away they begin, and however long a step is, two outlines do not pass through each other unseen.
#[test]
fn outlines_that_meet_within_a_step_bounce_by_every_method_and_request() {
    let (mut seen, stiff) = (0, "IMPACT, STIFFNESS=2000, EXPONENT=1.5");
    for other in ["CIRCLE, CM=4, RADIUS=0.4", "POINT, RM=4"] {
        let touching = if other.starts_with("POINT") { 0.4 } else { 0.8 };
        for method in ["DOP853", "RADAU5"] {
            for error in [1e-4, 1e-6, 1e-8] {
                for k in 0..8 {
                    let way = 0.5 + 0.25 * f64::from(k);
                    let text = format!(
                        "PART/2, QG={:?},0,0, MASS=1, CM=2, IP=1,1,1, VX=-2\nMARKER/2, PART=2, REULER=90D,90D,0\nMARKER/4, PART=2\n\
                         MARKER/3, PART=1, REULER=90D,90D,0\nJOINT/1, TRANSLATIONAL, I=2, J=3\nGRAPHICS/1, CIRCLE, CM=1, RADIUS=0.4\n\
                         GRAPHICS/2, {other}\nCONTACT/1, IGEOM=2, JGEOM=1, {stiff}\n",
                        touching + way
                    );
                    let mut s = running::session_by(&text, &["VX(2)"], method, error);
                    running::go(&mut s, Analysis::Dynamic, way + 0.5, 4);
                    let speed = last(&s, "VX(2)");
                    let off = (speed - 2.0).abs();
                    assert!(
                        off < 30.0 * error,
                        "{other}, {method} at {error}, {way} away: {speed}"
                    );
                    seen += 1;
                }
            }
        }
    }
    assert_eq!(seen, 96);
}

/// A disc of radius 0.2 that falls, slides and rolls over the x axis.
fn disc(at: &str) -> String {
    format!(
        "PART/2, MASS=1, CM=2, IP=0.02,0.02,0.02, QG={at}\nMARKER/2, PART=2\nMARKER/3, PART=1, REULER=0,-90D,0\nACCGRAV/JGRAV=-10\n{PLANAR}"
    )
}

#[test]
fn a_circle_on_a_line_is_a_sphere_on_a_plane() {
    let ground = curve(1, "OPEN", &line(-3.0, 5.0));
    let outline = curve(2, "CLOSED", &circle(0.2, 400));
    for law in [IMPACT, POISSON] {
        let base = disc("0,0.3,0, VX=1");
        let sphere = format!(
            "{base}GRAPHICS/1, PLANE, RM=3\nGRAPHICS/2, ELLIPSOID, CM=2, XSCALE=0.4, YSCALE=0.4, ZSCALE=0.4\nCONTACT/1, IGEOM=2, JGEOM=1, {law}, {FRICTION}\n"
        );
        let expected = run(&sphere, &COLUMNS, Analysis::Dynamic, 0.8, 1e-9);
        assert!(last(&expected, "WZ(2)") < -1.0);
        let bounces = values(&expected, COLUMNS[5]);
        assert!(bounces.iter().filter(|f| **f > 0.0).count() > 2);
        // the circle of GRAPHICS is exact; the spline through 400 points is off by 2e-9·0.2/16, which bounces multiply
        for (geometry, within) in [
            ("GRAPHICS/2, CIRCLE, CM=2, RADIUS=0.2\n".to_string(), 1e-6),
            (format!("{outline}GRAPHICS/2, CURVE, CID=2, CRM=2\n"), 1e-6),
        ] {
            for pair in ["IGEOM=2, JGEOM=1", "IGEOM=1, JGEOM=2"] {
                let text = format!(
                    "{base}{ground}{geometry}GRAPHICS/1, CURVE, CID=1, CRM=1\nCONTACT/1, {pair}, {law}, {FRICTION}\n"
                );
                let s = run(&text, &COLUMNS, Analysis::Dynamic, 0.8, 1e-9);
                for column in &COLUMNS[..5] {
                    for (a, b) in values(&s, column).iter().zip(values(&expected, column)) {
                        assert!((a - b).abs() < within, "{law} {pair} {column}: {a} {b}");
                    }
                }
            }
        }
    }
}

/// What a contact does to the body at marker 2, about it, at the start.
fn force(text: &str) -> [f64; 3] {
    let columns = ["CONTACT(1,0,2,0)", "CONTACT(1,0,3,0)", "CONTACT(1,0,8,0)"];
    let s = run(text, &columns, Analysis::Dynamic, 1e-9, 1e-6);
    columns.map(|c| values(&s, c)[0])
}

fn close(a: [f64; 3], b: [f64; 3]) {
    for (x, y) in a.iter().zip(b) {
        // rounding of forces of some hundred
        assert!((x - y).abs() < 1e-9, "{a:?} instead of {b:?}");
    }
}

const LINEAR: &str = "IMPACT, STIFFNESS=1000, EXPONENT=1, DAMPING=0, DMAX=1E-3";

/// A body with an outline at marker 2 and another outline at marker 1.
fn pair(at: &str, i: &str, j: &str, more: &str) -> String {
    format!(
        "PART/2, MASS=1, CM=2, IP=1,1,1, QG={at}\nMARKER/2, PART=2\n{PLANAR}{i}{j}CONTACT/1, IGEOM=2, JGEOM=1, {LINEAR}{more}\n"
    )
}

/// A closed polygon as GRAPHICS/n at marker n.
fn polygon(n: u32, points: &[[f64; 2]]) -> String {
    let mut points = points.to_vec();
    points.push(points[0]);
    polyline(n, "CLOSED", &points)
}

fn polyline(n: u32, kind: &str, points: &[[f64; 2]]) -> String {
    curve(n, &format!("{kind}, ORDER=2"), points)
        + &format!("GRAPHICS/{n}, CURVE, CID={n}, CRM={n}\n")
}

#[test]
fn a_hole_is_a_circle_turned_over() {
    let circles = |at: &str, flip: &str| {
        let i = "GRAPHICS/2, CIRCLE, CM=2, RADIUS=0.2\n";
        force(&pair(at, i, "GRAPHICS/1, CIRCLE, CM=1, RADIUS=1\n", flip))
    };
    // outside of a disc, and at the rim of a hole
    close(circles("1.19,0,0", ""), [10.0, 0.0, 0.0]);
    close(circles("0.81,0,0", ", JFLIP"), [-10.0, 0.0, 0.0]);
    close(circles("0,-0.81,0", ", JFLIP"), [0.0, 10.0, 0.0]);
    close(circles("0.3,0.2,0", ", JFLIP"), [0.0; 3]);
    // the same hole as a curve, whichever way it is drawn
    for turned in [false, true] {
        let mut points = circle(1.0, 400);
        if turned {
            points.reverse();
        }
        let hole = curve(1, "CLOSED", &points) + "GRAPHICS/1, CURVE, CID=1, CRM=1\n";
        let i = "GRAPHICS/2, CIRCLE, CM=2, RADIUS=0.2\n";
        let f = force(&pair("0.486,0.648,0", i, &hole, ", JFLIP"));
        // splined circles are off by 2e-10, and so is their direction by 1e-8
        for (x, y) in f.iter().zip([-6.0, -8.0, 0.0]) {
            assert!((x - y).abs() < 1e-5, "{f:?}");
        }
    }
}

#[test]
fn a_point_is_pushed_to_the_nearest_side() {
    let square = polygon(1, &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]);
    let point = "GRAPHICS/2, POINT, RM=2\n";
    let at = |x: f64, y: f64| force(&pair(&format!("{x:?},{y:?},0"), point, &square, ""));
    close(at(0.98, 0.3), [20.0, 0.0, 0.0]);
    close(at(-0.97, 0.9), [-30.0, 0.0, 0.0]);
    close(at(0.2, -0.99), [0.0, -10.0, 0.0]);
    // next to a corner the nearest is the deepest that it needs to be
    close(at(0.98, 0.99), [0.0, 10.0, 0.0]);
    close(at(1.02, 1.01), [0.0; 3]);
    // below an open profile, above it, beside its end
    let ground = curve(1, "OPEN", &line(-1.0, 1.0)) + "GRAPHICS/1, CURVE, CID=1, CRM=1\n";
    let on = |x: f64, y: f64| force(&pair(&format!("{x:?},{y:?},0"), point, &ground, ""));
    close(on(0.3, -0.02), [0.0, 20.0, 0.0]);
    close(on(0.3, 0.02), [0.0; 3]);
    close(on(1.01, -0.02), [0.0; 3]);
}

#[test]
fn a_disc_in_a_groove_touches_both_sides() {
    // sides at 45 degrees; the disc's centre above the middle, 0.01 lower than where it would just touch
    let groove = polyline(
        1,
        "OPEN",
        &[[-2.0, 2.0], [-1.0, 1.0], [0.0, 0.0], [2.0, 2.0]],
    );
    let i = "GRAPHICS/2, CIRCLE, CM=2, RADIUS=0.5\n";
    let height = 0.5 * 2f64.sqrt() - 0.01;
    let n = 1000.0 * 0.01 / 2f64.sqrt();
    close(
        force(&pair(&format!("0,{height:?},0"), i, &groove, "")),
        [0.0, 2.0 * n / 2f64.sqrt(), 0.0],
    );
    // it settles there under its weight: each side carries mg/√2
    let text = pair("0.02,0.8,0", i, &groove, "").replace("DAMPING=0", "DAMPING=10")
        + "ACCGRAV/JGRAV=-10\n";
    let s = run(&text, &["DX(2)", "DY(2)"], Analysis::Static, 0.0, 1e-8);
    let depth = 10.0 / 2f64.sqrt() / 1000.0;
    let expected = (0.5 - depth) * 2f64.sqrt();
    assert!(last(&s, "DX(2)").abs() < 1e-7 && (last(&s, "DY(2)") - expected).abs() < 1e-7);
}

#[test]
fn a_box_stands_on_its_lower_corners_and_tips_over_an_edge() {
    let cuboid = polygon(2, &[[-0.3, -0.2], [0.3, -0.2], [0.3, 0.2], [-0.3, 0.2]]);
    let ground = curve(1, "OPEN", &line(-3.0, 3.0)) + "GRAPHICS/1, CURVE, CID=1, CRM=1\n";
    let on = |at: &str| force(&pair(at, &cuboid, &ground, ""));
    // two corners, also when it is tilted by a little: 0.01 deep in the middle, 0.3 sin 0.01 more or less at the corners
    close(on("0,0.19,0"), [0.0, 20.0, 0.0]);
    let (sin, cos) = 0.01f64.sin_cos();
    let [a, b] = [1.0, -1.0].map(|side: f64| 0.01 + 0.2 * (cos - 1.0) + side * 0.3 * sin);
    let tilted = on("0,0.19,0, REULER=0.01,0,0");
    let arms = [-0.3 * cos + 0.2 * sin, 0.3 * cos + 0.2 * sin];
    let expected = [0.0, 1000.0 * (a + b), 1000.0 * (a * arms[0] + b * arms[1])];
    for (x, y) in tilted.iter().zip(expected) {
        // the higher corner has faded by (0.01/0.35)² twice
        assert!((x - y).abs() < 2e-2, "{tilted:?} {expected:?}");
    }
    // beyond the edge of a table: one corner of the box, the end of the table
    let table = curve(1, "OPEN", &line(-3.0, 0.0)) + "GRAPHICS/1, CURVE, CID=1, CRM=1\n";
    close(
        force(&pair("0.1,0.19,0", &cuboid, &table, "")),
        [0.0, 20.0, 10.0 * (-0.3) + 10.0 * (-0.1)],
    );
}

#[test]
fn a_bounce_returns_after_the_time_of_fall_and_half_an_oscillation() {
    // fall through h to the first touch, half a period and a little of a spring with weight, and back: all closed forms
    let (k, g, h): (f64, f64, f64) = (1e5, 10.0, 0.45);
    let w = k.sqrt();
    let v = (2.0 * g * h).sqrt();
    // x'' = −k x + g from x = 0 with v: back at x = 0 after (2/w)(π − atan(w v/g))
    let contact = 2.0 / w * (std::f64::consts::PI - (w * v / g).atan());
    let ground = curve(1, "OPEN", &line(-1.0, 1.0)) + "GRAPHICS/1, CURVE, CID=1, CRM=1\n";
    for (i, at) in [
        ("GRAPHICS/2, CIRCLE, CM=2, RADIUS=0.2\n".to_string(), 0.2),
        ("GRAPHICS/2, POINT, RM=2\n".to_string(), 0.0),
        // on a corner
        (
            polygon(2, &[[0.0, -0.3], [0.3, 0.0], [0.0, 0.3], [-0.3, 0.0]]),
            0.3,
        ),
        (
            curve(2, "CLOSED", &circle(0.2, 60)) + "GRAPHICS/2, CURVE, CID=2, CRM=2\n",
            0.2,
        ),
    ] {
        let text = pair(&format!("0,{:?},0", at + h), &i, &ground, "")
            .replace("STIFFNESS=1000", &format!("STIFFNESS={k:?}"))
            + "ACCGRAV/JGRAV=-10\n";
        let end = 2.0 * v / g + contact;
        let s = run(&text, &["DY(2)", "VY(2)"], Analysis::Dynamic, end, 1e-10);
        // one oscillation of 0.01 s is a tenth of the time: a touch that is stepped over would be seen in every digit
        assert!(
            (last(&s, "DY(2)") - at - h).abs() < 1e-8,
            "{i} {}",
            last(&s, "DY(2)") - at - h
        );
        assert!(last(&s, "VY(2)").abs() < 1e-6, "{i} {}", last(&s, "VY(2)"));
    }
}

/// A cam about the origin that turns by a motion, and a follower that slides along y above it.
fn cam(outline: &str, tip: &str, what: &str) -> String {
    format!(
        "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nMARKER/11, PART=1\nJOINT/1, REVOLUTE, I=2, J=11\nMOTION/1, JOINT=1, ROTATION, FUNCTION=3*TIME\n\
         PART/3, MASS=0.5, CM=3, IP=1,1,1, QG=0,{tip},0\nMARKER/3, PART=3\nMARKER/13, PART=3, REULER=0,-90D,0\nMARKER/31, PART=1, REULER=0,-90D,0\n\
         JOINT/2, TRANSLATIONAL, I=13, J=31\nSPRINGDAMPER/1, TRANSLATION, I=3, J=5, K=50, C=0, LENGTH=4\nMARKER/5, PART=1, QP=0,4,0\nACCGRAV/JGRAV=-10\n\
         {outline}{what}"
    )
}

/// Points of a cam whose radius is 1 + 0.1 cos 2φ, about the origin.
fn oval() -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = (0..200)
        .map(|k| {
            let phi = std::f64::consts::TAU * f64::from(k) / 200.0;
            let r = 1.0 + 0.1 * (2.0 * phi).cos();
            [r * phi.cos(), r * phi.sin()]
        })
        .collect();
    points.push(points[0]);
    points
}

#[test]
fn stiff_contact_of_a_follower_is_ptcv_and_of_a_roller_cvcv() {
    let outline = curve(1, "CLOSED", &oval());
    let point = cam(
        &outline,
        "0.9",
        "PTCV/1, CURVE=1, I=3, JFLOAT=40, RM=2\nMARKER/40, PART=2, FLOATING\n",
    );
    let roller_curve = curve(3, "CLOSED", &circle(0.3, 400));
    let roller = cam(
        &format!("{outline}{roller_curve}"),
        "1.2",
        "CVCV/1, ICURVE=1, IRM=2, IFLOAT=40, JCURVE=3, JRM=3, JFLOAT=41\nMARKER/40, PART=2, FLOATING\nMARKER/41, PART=3, FLOATING\n\
         JDISP=0,-0.3,0\n",
    );
    let roller = roller
        .replace("\nJDISP=0,-0.3,0", "")
        .replace("JFLOAT=41", "JFLOAT=41, JDISP=0,-0.3,0, JICM=3");
    for (constraint, tip, graphics, start) in [
        (&point, "0.9", "GRAPHICS/3, POINT, RM=3\n", 0.9),
        (
            &roller,
            "1.2",
            "GRAPHICS/3, CIRCLE, CM=3, RADIUS=0.3\n",
            1.2,
        ),
    ] {
        let rigid = run(constraint, &["DY(3)"], Analysis::Dynamic, 2.0, 1e-9);
        let press = 50.0 * start + 5.0;
        let off = [1e5, 1e7].map(|k: f64| {
            // as deep at the start as the spring and the weight press it, so that it does not bounce; damped critically
            let contact = format!(
                "{graphics}GRAPHICS/2, CURVE, CID=1, CRM=2\nCONTACT/1, IGEOM=3, JGEOM=2, IMPACT, STIFFNESS={k:?}, EXPONENT=1, DAMPING={:?}, DMAX=1E-12\n",
                (2.0 * k).sqrt()
            );
            let text = cam(&outline, tip, &contact);
            let text = text.replace(&format!("QG=0,{tip},0"), &format!("QG=0,{:?},0", start - press / k));
            let s = run(&text, &["DY(3)"], Analysis::Dynamic, 2.0, 1e-8);
            let pairs = values(&s, "DY(3)").iter().zip(values(&rigid, "DY(3)"));
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        });
        // spring and weight at the start, 10 more of the spring at the top, inertia: that over k, and nothing else
        assert!(
            off[0] < (press + 15.0) / 1e5 && off[1] < 0.011 * off[0],
            "{off:?}"
        );
    }
}

#[test]
fn a_disc_rolls_off_the_end_of_a_ramp_and_keeps_its_energy() {
    let ramp = curve(1, "OPEN", &line(-1.0, 0.0)) + "GRAPHICS/1, CURVE, CID=1, CRM=1\n";
    let text = pair(
        "-0.1,0.1999,0, VX=0.3",
        "GRAPHICS/2, CIRCLE, CM=2, RADIUS=0.2\n",
        &ramp,
        "",
    )
    .replace("STIFFNESS=1000", "STIFFNESS=1E5")
        + "ACCGRAV/JGRAV=-10\n";
    let energy = "0.5*VM(2)**2+0.5*WM(2)**2+10*DY(2)";
    let s = run(
        &text,
        &["DX(2)", "DY(2)", energy],
        Analysis::Dynamic,
        1.2,
        1e-9,
    );
    // round the end and down; the spring of the beginning held 5e-4
    assert!(last(&s, "DY(2)") < -1.0 && last(&s, "DX(2)") > 0.2);
    let e = values(&s, energy);
    assert!(
        (e[e.len() - 1] - e[0] - 0.5 * 1e5 * 1e-8).abs() < 1e-6,
        "{e:?}"
    );
}

#[test]
fn what_curves_cannot_touch_is_named() {
    let refused = |i: &str, j: &str, more: &str| {
        let errors = mistakes(
            &mut session(&pair("0,0.3,0", i, j, more), &[], 1e-6),
            Analysis::Dynamic,
        );
        errors[0].to_string()
    };
    let circle = "GRAPHICS/2, CIRCLE, CM=2, RADIUS=0.2\n";
    let told = refused(
        "GRAPHICS/2, CIRCLE, CM=2, RADIUS=0\n",
        circle.replace('2', "1").as_str(),
        "",
    );
    assert!(told.contains("GRAPHICS/2 has no size"), "{told}");
    let ball = "GRAPHICS/2, ELLIPSOID, CM=2, XSCALE=1, YSCALE=1, ZSCALE=1\n";
    let told = refused(ball, "GRAPHICS/1, PLANE, RM=1\n", ", IFLIP");
    assert!(told.contains("GRAPHICS/2 is a solid"), "{told}");
    let tilted = pair(
        "0,0.3,0",
        circle,
        "GRAPHICS/1, CIRCLE, CM=5, RADIUS=1\nMARKER/5, PART=1, REULER=0,3D,0\n",
        "",
    );
    let errors = mistakes(&mut session(&tilted, &[], 1e-6), Analysis::Dynamic);
    assert!(errors[0].code == "curves_not_coplanar" && errors[0].message.contains("3.0000 deg"));
}
