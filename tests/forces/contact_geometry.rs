//! CONTACT of boxes, cylinders, frustums and ellipsoids with each other: closed forms, the same solids on planes, and laws.
#![cfg(feature = "geometry")]

use crate::running;

use cognate::internals::physics::contact::query::Query;
use cognate::internals::physics::contact::{Solid, TOUCH_NUMBERS, TOUCHES};
use running::{Analysis, Session, first, last, run, values};

fn solve(text: &str, columns: &[&str], analysis: Analysis, end: f64, error: f64) -> Session {
    run(text, columns, analysis, (end, 20), error)
}

const ELASTIC: &str = "IMPACT, STIFFNESS=1E4, EXPONENT=1.5, DAMPING=0, DMAX=1E-3";
const DAMPED: &str = "IMPACT, STIFFNESS=1E4, EXPONENT=1.5, DAMPING=20, DMAX=1E-3";
const FRICTION: &str = "COULOMB_FRICTION=ON, MU_STATIC=0.5, MU_DYNAMIC=0.5, STICTION_TRANSITION_VELOCITY=1E-3, FRICTION_TRANSITION_VELOCITY=2E-3";

/// IMPACT at rest with these numbers.
fn elastic(depth: f64) -> f64 {
    1e4 * depth.powf(1.5)
}

/// The depth at which it carries a force.
fn depth(force: f64) -> f64 {
    (force / 1e4).powf(1.0 / 1.5)
}

/// What a contact does to a solid at marker 2, about it, where both stand; the other solid stands at marker 1.
fn force(i: &str, at: &str, j: &str) -> [f64; 6] {
    let text = format!(
        "PART/2, MASS=1, CM=2, IP=1,1,1, {at}\nMARKER/2, PART=2\nMARKER/4, PART=1, QP=-3,-3,0\nGRAPHICS/1, {j}\nGRAPHICS/2, {i}\n\
         CONTACT/1, IGEOM=2, JGEOM=1, {ELASTIC}\n"
    );
    let columns = [2, 3, 4, 6, 7, 8].map(|k| format!("CONTACT(1,0,{k},0)"));
    let names: Vec<&str> = columns.iter().map(String::as_str).collect();
    let s = solve(&text, &names, Analysis::Dynamic, 1e-9, 1e-6);
    columns.map(|c| first(&s, &c))
}

fn close(a: [f64; 6], b: [f64; 6]) {
    for (k, x) in b.iter().enumerate() {
        // overlaps of a few hundredths, rounded a few times
        assert!((a[k] - x).abs() < 1e-9, "{a:?} instead of {b:?}");
    }
}

/// A body of mass 1 whose solid stands over a wide box (or a plane) of ground with its upper face at height 0.
fn over(ground: &str, solid: &str, at: &str, law: &str, analysis: Analysis, end: f64) -> Session {
    let text = format!(
        "PART/2, MASS=1, CM=3, IP=0.01,0.02,0.03, {at}\nMARKER/2, PART=2, QP=-0.1,-0.15,-0.2\nMARKER/3, PART=2\n\
         MARKER/4, PART=1, QP=-3,-3,-1\nMARKER/5, PART=2, QP=0,0,-0.2\nGRAPHICS/1, {ground}\nGRAPHICS/2, {solid}\nACCGRAV/KGRAV=-10\n\
         CONTACT/1, IGEOM=2, JGEOM=1, {law}\n"
    );
    solve(&text, &COLUMNS, analysis, end, 1e-8)
}

const COLUMNS: [&str; 4] = ["DX(3)", "DZ(3)", "WY(3)", "CONTACT(1,0,4,0)"];
const WIDE: &str = "BOX, CORNER=4, X=6, Y=6, Z=1";
const CUBOID: &str = "BOX, CORNER=2, X=0.2, Y=0.3, Z=0.4";

#[test]
fn a_box_falls_on_a_box_as_on_a_plane() {
    // onto a corner, sliding and turning over: the same corners touch, so every bounce begins at the same time
    let at = "QG=0,0,0.4, REULER=0.4,0.5,0.3, VX=1, WY=2";
    let law = format!("{DAMPED}, {FRICTION}");
    let [plane, boxes] = ["PLANE, RM=1", WIDE].map(|ground| {
        let s = over(ground, CUBOID, at, &law, Analysis::Dynamic, 0.35);
        COLUMNS.map(|c| last(&s, c))
    });
    assert!(plane[0].abs() > 0.1);
    for k in 0..3 {
        // the request, grown by the bounces
        assert!((plane[k] - boxes[k]).abs() < 1e-5, "{plane:?} {boxes:?}");
    }
}

#[test]
fn solids_rest_on_a_box_at_the_depth_of_their_points() {
    for (solid, points) in [
        (CUBOID, 4.0),
        ("CYLINDER, CM=5, LENGTH=0.4, RADIUS=0.1", 4.0),
        ("FRUSTUM, CM=5, LENGTH=0.4, BOTTOM=0.1, TOP=0.05", 4.0),
    ] {
        let s = over(WIDE, solid, "QG=0,0,0.21", DAMPED, Analysis::Static, 0.0);
        let (z, n) = (last(&s, "DZ(3)"), last(&s, "CONTACT(1,0,4,0)"));
        let expected = 0.2 - depth(10.0 / points);
        assert!(
            (z - expected).abs() < 1e-9 && (n - 10.0).abs() < 1e-7,
            "{solid}: {z} {expected} {n}"
        );
    }
}

#[test]
fn a_box_slides_on_a_tilted_box_as_on_an_incline() {
    // ground turned about y by θ; the body in its axes at the depth of rest
    let tilt = 0.3f64;
    for mu in [0.0, 0.2] {
        let law = if mu > 0.0 {
            format!("{ELASTIC}, {}", FRICTION.replace("0.5", "0.2"))
        } else {
            ELASTIC.to_string()
        };
        let (normal, along) = (10.0 * tilt.cos(), 10.0 * tilt.sin());
        let text = format!(
            "PART/2, MASS=1, CM=3, IP=0.01,0.02,0.03, QG=0,0,{:?}, VX=0.1\nMARKER/2, PART=2, QP=-0.1,-0.15,-0.2\nMARKER/3, PART=2\n\
             MARKER/4, PART=1, QP=-3,-3,-1\nGRAPHICS/1, {WIDE}\nGRAPHICS/2, {CUBOID}\nACCGRAV/IGRAV={along:?}, KGRAV={:?}\n\
             CONTACT/1, IGEOM=2, JGEOM=1, {law}\n",
            0.2 - depth(0.25 * normal),
            -normal,
        );
        let s = solve(&text, &["DX(3)", "DZ(3)"], Analysis::Dynamic, 0.4, 1e-9);
        let expected = 0.04 + 0.5 * (along - mu * normal) * 0.16;
        // friction presses the front corners, which are then deeper: the mean force is the same, the body nods by 1e-4
        let within = if mu > 0.0 { 1e-3 } else { 1e-7 };
        assert!(
            (last(&s, "DX(3)") - expected).abs() < within,
            "{} {expected}",
            last(&s, "DX(3)")
        );
    }
}

#[test]
fn a_cylinder_rolls_down_a_tilted_box() {
    // axis along y: REULER turns z of the body into −y; a = 2/3 g sin θ for a full cylinder, J = m r²/2
    let (tilt, r) = (0.2f64, 0.1);
    let (normal, along) = (10.0 * tilt.cos(), 10.0 * tilt.sin());
    let text = format!(
        "PART/2, MASS=1, CM=3, IP=0.02,0.02,{:?}, QG=0,0,{:?}, REULER=0,90D,0\nMARKER/5, PART=2, QP=0,0,-0.2\nMARKER/3, PART=2\n\
         MARKER/4, PART=1, QP=-3,-3,-1\nGRAPHICS/1, {WIDE}\nGRAPHICS/2, CYLINDER, CM=5, LENGTH=0.4, RADIUS={r:?}\n\
         ACCGRAV/IGRAV={along:?}, KGRAV={:?}\nCONTACT/1, IGEOM=2, JGEOM=1, {ELASTIC}, {FRICTION}\n",
        0.5 * r * r,
        r - depth(0.5 * normal),
        -normal,
    );
    let s = solve(
        &text,
        &["DX(3)", "WY(3)", "VX(3)"],
        Analysis::Dynamic,
        0.5,
        1e-8,
    );
    // they act on each other in the middle of the overlap: that much is the arm of friction shorter than the radius
    let arm = r - 0.5 * depth(0.5 * normal);
    let expected = 0.5 * along / (1.0 + 0.5 * (r / arm).powi(2)) * 0.25;
    // what sticks creeps: a slip of some 1e-4 m/s for half a second
    assert!(
        (last(&s, "DX(3)") - expected).abs() < 1e-4,
        "{} {expected}",
        last(&s, "DX(3)")
    );
    assert!((last(&s, "WY(3)") * arm - last(&s, "VX(3)")).abs() < 1e-3 * last(&s, "VX(3)"));
}

#[test]
fn a_sphere_and_a_cylinder_settle_between_two_steep_boxes() {
    // a trough of two faces at right angles, each 45 degrees steep: each carries m g/√2
    for solid in [
        "ELLIPSOID, CM=3, XSCALE=0.2, YSCALE=0.2, ZSCALE=0.2",
        "CYLINDER, CM=5, LENGTH=0.4, RADIUS=0.1",
    ] {
        let points = if solid.starts_with("CYL") { 2.0 } else { 1.0 };
        let text = format!(
            "PART/2, MASS=1, CM=3, IP=0.01,0.01,0.01, QG=0.01,0,0.15, REULER=0,90D,0\nMARKER/3, PART=2\nMARKER/5, PART=2, QP=0,0,-0.2\n\
             MARKER/8, PART=1, QP=0,-2,0, REULER=90D,45D,-90D\nMARKER/9, PART=1, QP=0,-2,0, REULER=90D,-45D,-90D\n\
             GRAPHICS/1, BOX, CORNER=9, X=2, Y=4, Z=-1\nGRAPHICS/3, BOX, CORNER=8, X=-2, Y=4, Z=-1\n\
             GRAPHICS/2, {solid}\nACCGRAV/KGRAV=-10\nCONTACT/1, IGEOM=2, JGEOM=1,3, {DAMPED}\n"
        );
        let s = solve(&text, &["DX(3)", "DZ(3)"], Analysis::Static, 0.0, 1e-8);
        let expected = (0.1 - depth(10.0 / 2f64.sqrt() / points)) * 2f64.sqrt();
        assert!(
            last(&s, "DX(3)").abs() < 1e-7 && (last(&s, "DZ(3)") - expected).abs() < 1e-7,
            "{solid} {} {} {expected}",
            last(&s, "DX(3)"),
            last(&s, "DZ(3)")
        );
    }
}

#[test]
fn edges_that_cross_push_across_both() {
    // one edge along y at height 0 below, one along x above: two bars, each turned by 45 degrees about its edge
    let below = "BOX, CORNER=6, X=1, Y=4, Z=1";
    let text = |swap: bool| {
        let (i, j) = if swap { (1, 2) } else { (2, 1) };
        format!(
            "MARKER/6, PART=1, QP=0,-2,0, REULER=90D,135D,-90D\nPART/2, MASS=1, CM=2, IP=1,1,1, QG=-2,0,-0.01\n\
             MARKER/2, PART=2, REULER=0,45D,0\nGRAPHICS/1, {below}\nGRAPHICS/2, BOX, CORNER=2, X=4, Y=1, Z=1\n\
             CONTACT/1, IGEOM={i}, JGEOM={j}, {ELASTIC}\n"
        )
    };
    let names = [2, 3, 4, 6, 7, 8].map(|k| format!("CONTACT(1,0,{k},0)"));
    let columns: Vec<&str> = names.iter().map(String::as_str).collect();
    let found = [false, true].map(|swap| {
        let s = solve(&text(swap), &columns, Analysis::Dynamic, 1e-9, 1e-6);
        names.clone().map(|c| first(&s, &c))
    });
    // the edge of the upper bar begins at its marker, 2 to the left of the crossing
    let f = elastic(0.01);
    close(found[0], [0.0, 0.0, f, 0.0, -2.0 * f, 0.0]);
    assert!((found[1][2] + f).abs() < 1e-9, "{found:?}");
}

#[test]
fn cylinders_touch_at_a_point_or_along_a_line() {
    let upright = "CYLINDER, CM=1, LENGTH=2, RADIUS=0.5";
    let other = "CYLINDER, CM=2, LENGTH=2, RADIUS=0.3";
    // side by side, half as high: from 1 to 2 above
    let n = elastic(0.01);
    close(
        force(other, "QG=0.79,0,1", upright),
        [2.0 * n, 0.0, 0.0, 0.0, n, 0.0],
    );
    // crossed at right angles, the crossing in the middle: z of the body along −y
    close(
        force(other, "QG=0.79,1,1, REULER=0,90D,0", upright),
        [n, 0.0, 0.0, 0.0, 0.0, n],
    );
    // end to end: four points of the smaller rim
    let [x, y, z, ..] = force(other, "QG=0,0.1,1.99", upright);
    assert!(
        x.abs() < 1e-9 && y.abs() < 1e-9 && (z - 4.0 * n).abs() < 1e-9,
        "{x} {y} {z}"
    );
}

#[test]
fn ellipsoids_touch_where_their_normals_meet() {
    // tip on tip, then on a box as on a plane
    let e = "ELLIPSOID, CM=1, XSCALE=1, YSCALE=2, ZSCALE=4";
    let f = "ELLIPSOID, CM=2, XSCALE=2, YSCALE=2, ZSCALE=1";
    let n = elastic(0.01);
    close(force(f, "QG=0,0,2.49", e), [0.0, 0.0, n, 0.0, 0.0, 0.0]);
    close(force(f, "QG=0,1.99,0", e), [0.0, n, 0.0, 0.0, 0.0, 0.0]);
    let at = "QG=0.2,0.3,0.68, REULER=0.3,0.7,0.5";
    let plane = force(f, at, "PLANE, RM=1");
    let wide = "BOX, CORNER=4, X=6, Y=6, Z=-1";
    assert!(plane[2] > 1.0);
    close(force(f, at, wide), plane);
    // a ball that is written as an ellipsoid of three equal axes: the distance of centres
    let (x, z) = (0.6f64, 2.1f64);
    let ball = "ELLIPSOID, CM=2, XSCALE=1, YSCALE=1, ZSCALE=1";
    let [fx, fy, fz, tx, ty, tz] = force(ball, &format!("QG={x:?},0,{z:?}"), e);
    // central: no torque about the ball's centre, and in the plane of the axes
    assert!(fx > 0.0 && fz > 0.0 && fy.abs() < 1e-9);
    assert!(
        tx.abs() < 1e-8 && ty.abs() < 1e-7 && tz.abs() < 1e-8,
        "{tx} {ty} {tz}"
    );
}

#[test]
fn action_is_reaction_and_i_and_j_are_alike() {
    let solids = [
        ("BOX, CORNER=#, X=1, Y=0.8, Z=0.6", "QG=0.2,0.3,0.4"),
        ("CYLINDER, CM=#, LENGTH=1, RADIUS=0.4", "QG=0.5,0.4,0.3"),
        (
            "FRUSTUM, CM=#, LENGTH=1, BOTTOM=0.5, TOP=0.2",
            "QG=0.4,0.3,0.4",
        ),
        (
            "ELLIPSOID, CM=#, XSCALE=1.4, YSCALE=1, ZSCALE=1.2",
            "QG=0.6,0.5,0.4",
        ),
    ];
    let columns: Vec<String> = (0..2)
        .flat_map(|j| (1..9).map(move |k| format!("CONTACT(1,{j},{k},1)")))
        .collect();
    let names: Vec<&str> = columns.iter().map(String::as_str).collect();
    for (a, _) in solids {
        for (b, place) in solids {
            let text = |pair: &str| {
                format!(
                    "PART/2, MASS=1, CM=2, IP=1,1,1, {place}, REULER=0.7,0.9,0.4, VX=1, VZ=-2, WY=3\nMARKER/2, PART=2\nGRAPHICS/1, {}\n\
                     GRAPHICS/2, {}\nCONTACT/1, {pair}, {DAMPED}, {FRICTION}\n",
                    a.replace('#', "1"),
                    b.replace('#', "2"),
                )
            };
            let [one, two] = ["IGEOM=2, JGEOM=1", "IGEOM=1, JGEOM=2"].map(|pair| {
                let s = solve(&text(pair), &names, Analysis::Dynamic, 1e-9, 1e-6);
                columns.iter().map(|c| first(&s, c)).collect::<Vec<f64>>()
            });
            let size = one[0];
            assert!(size > 1.0, "{a} {b} {one:?}");
            for k in 1..4 {
                assert!((one[k] + one[k + 8]).abs() < 1e-11 * size, "{a} {b}");
            }
            for k in 0..16 {
                // directions between curved solids are found to 1e-7
                assert!(
                    (one[k] - two[(k + 8) % 16]).abs() < 1e-5 * size,
                    "{a} {b} {one:?} {two:?}"
                );
            }
        }
    }
}

#[test]
fn momentum_survives_a_collision_of_free_boxes() {
    let law = format!("{DAMPED}, {FRICTION}");
    let text = format!(
        "PART/2, MASS=1, CM=3, IP=0.01,0.02,0.03, QG=0,0,0.5, REULER=0.4,0.5,0.3, VZ=-2, WX=3\nMARKER/2, PART=2, QP=-0.1,-0.15,-0.2\nMARKER/3, PART=2\n\
         PART/3, MASS=2, CM=5, IP=0.04,0.05,0.06, VX=0.1\nMARKER/4, PART=3, QP=-0.3,-0.3,-0.1\nMARKER/5, PART=3\n\
         GRAPHICS/2, {CUBOID}\nGRAPHICS/3, BOX, CORNER=4, X=0.6, Y=0.6, Z=0.2\nCONTACT/1, IGEOM=2, JGEOM=3, {law}\n"
    );
    let px = "VX(3)+2*VX(5)";
    let pz = "VZ(3)+2*VZ(5)";
    let energy = "0.5*VM(3)**2+VM(5)**2+0.5*(0.01*WX(3,1,3)**2+0.02*WY(3,1,3)**2+0.03*WZ(3,1,3)**2+0.04*WX(5,1,5)**2+0.05*WY(5,1,5)**2+0.06*WZ(5,1,5)**2)";
    let s = solve(
        &text,
        &[px, pz, energy, "VZ(5)"],
        Analysis::Dynamic,
        0.4,
        1e-8,
    );
    assert!(last(&s, "VZ(5)") < -0.1);
    for p in [px, pz] {
        assert!((last(&s, p) - first(&s, p)).abs() < 1e-7, "{p}");
    }
    assert!(last(&s, energy) < first(&s, energy));
}

#[test]
fn a_hull_of_the_corners_of_a_box_is_that_box() {
    let (low, high) = ([-1.0, -0.5, -0.2], [1.0, 0.5, 0.2]);
    let cuboid = Solid::Box { low, high };
    let corners = (0..8).map(|c| [0, 1, 2].map(|k| if c >> k & 1 == 0 { low[k] } else { high[k] }));
    let hull = Solid::Hull(corners.collect());
    // lying across each other, overlapping by 0.01
    let pose = [0.1, 0.2, 0.39, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let mut depths = Vec::new();
    for (i, j) in [
        (&cuboid, &cuboid),
        (&hull, &cuboid),
        (&cuboid, &hull),
        (&hull, &hull),
    ] {
        let mut out = [0.0; TOUCHES * TOUCH_NUMBERS];
        Query::new(i, j)
            .expect("they have hulls")
            .ask(&pose, &mut out);
        let touches: Vec<&[f64]> = out.chunks(TOUCH_NUMBERS).filter(|t| t[10] > 0.0).collect();
        assert_eq!(touches.len(), 4);
        for t in touches {
            assert!(
                (t[8] - 1.0).abs() < 1e-12 && (t[10] - 1.0).abs() < 1e-12,
                "{t:?}"
            );
            // both points at the same place of the plane across z
            depths.push(t[5] - (t[2] + pose[2]));
        }
    }
    assert!(
        depths.iter().all(|d| (d - 0.01).abs() < 1e-12),
        "{depths:?}"
    );
}

#[test]
fn a_force_does_not_jump_where_a_corner_of_the_overlap_becomes_two() {
    // two equal squares turned against each other: four common corners become eight
    let cube = Solid::Box {
        low: [-0.5; 3],
        high: [0.5; 3],
    };
    let query = Query::new(&cube, &cube).expect("they have hulls");
    let total = |angle: f64| {
        let (s, c) = angle.sin_cos();
        let mut out = [0.0; TOUCHES * TOUCH_NUMBERS];
        query.ask(
            &[0.0, 0.0, 0.99, c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0],
            &mut out,
        );
        out.chunks(TOUCH_NUMBERS).map(|t| t[10]).sum::<f64>()
    };
    assert!((total(0.0) - 4.0).abs() < 1e-12 && (total(0.5) - 8.0).abs() < 1e-12);
    let mut before = total(0.0);
    for k in 1..=500 {
        let now = total(1e-3 * f64::from(k) * 0.1);
        assert!((now - before).abs() < 0.1, "at {k}: {before} {now}");
        before = now;
    }
}

#[test]
fn nothing_that_can_be_asked_has_no_answer() {
    let solids = [
        Solid::Box {
            low: [0.0; 3],
            high: [1.0, 1e-9, 1e9],
        },
        Solid::Frustum {
            z: [0.0, 1.0],
            radius: [0.0, 1.0],
        },
        Solid::Frustum {
            z: [0.0, 1e-6],
            radius: [1.0, 1.0],
        },
        Solid::Ellipsoid {
            semi: [1.0, 1e-6, 1e3],
        },
        Solid::Ball { radius: 1.0 },
        Solid::Hull(vec![[0.0; 3]; 5]),
        Solid::Hull(vec![
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
        ]),
    ];
    let one = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    for i in &solids {
        for j in &solids {
            let Some(query) = Query::new(i, j) else {
                continue;
            };
            for place in [
                [0.0; 3],
                [1.0, 0.0, 0.0],
                [1e-300, 0.0, 0.0],
                [f64::NAN; 3],
                [1e300; 3],
                [0.3, 0.2, -0.1],
            ] {
                let mut pose = place.to_vec();
                pose.extend(one);
                let mut out = [0.0; TOUCHES * TOUCH_NUMBERS];
                query.ask(&pose, &mut out);
                assert!(out.iter().all(|x| x.is_finite()), "{i:?} {j:?} {place:?}");
            }
        }
    }
}

#[test]
fn a_torus_that_begins_within_a_cylinder_is_pushed_out_of_it() {
    // one place of the tube overlaps the upper rim; a switch of what it rubs there lies at time 0, to rounding
    let text = "ACCGRAV/KGRAV=-10\nPART/2, MASS=1, CM=2, IP=1,1,1, QG=0.1,0.2,1.3\nMARKER/2, PART=2\n\
         GRAPHICS/1, CYLINDER, CM=1, LENGTH=1, RADIUS=0.5\nGRAPHICS/2, TORUS, CM=2, MAJOR_RADIUS=1, MINOR_RADIUS=0.5\n\
         CONTACT/1, IGEOM=2, JGEOM=1, IMPACT, STIFFNESS=1E5, EXPONENT=1.5, DAMPING=100, DMAX=1E-3, COULOMB_FRICTION=ON, MU_STATIC=0.3,\
         MU_DYNAMIC=0.2, STICTION_TRANSITION_VELOCITY=0.01, FRICTION_TRANSITION_VELOCITY=0.1\n";
    let s = run(text, &["DM(2)"], Analysis::Dynamic, (1.0, 10), 1e-6);
    let far = values(&s, "DM(2)");
    // the ring passes the rim at √((1 − 0.2236 − 0.5)² + 0.3²) = 0.408, an overlap of 0.092: k δ^2.5/2.5 is 100 J, for a mass of 1 kg; nothing else
    // than the ground of gravity holds it, so that it is out, and off by more than tube and ring together
    let farthest = far.iter().copied().fold(0.0, f64::max);
    assert!(farthest > 2.5 && farthest < 15.0, "{far:?}");
    // 128 when this was written; thousands of steps of 1e-163 before
    assert!(
        s.run.record.counts.steps < 2000,
        "{}",
        s.run.record.counts.steps
    );
}
