//! CONTACT statements: which solids touch where, with which force; balance of what acts on both; what cannot be solved.

use crate::running;
use cognate::model::ElementKind;
use running::{Analysis, Session, go, last, mistakes, run, session, values};

fn solve(text: &str, columns: &[&str], analysis: Analysis, end: f64) -> Session {
    run(text, columns, analysis, (end, 20), 1e-9)
}

/// What a contact does, force and torque about the marker of its I solid, where the bodies stand.
fn force(text: &str) -> [f64; 6] {
    let columns = [2, 3, 4, 6, 7, 8].map(|k| format!("CONTACT(1,0,{k},0)"));
    let names: Vec<&str> = columns.iter().map(String::as_str).collect();
    let s = solve(text, &names, Analysis::Dynamic, 1e-9);
    columns.map(|c| values(&s, &c)[0])
}

const LAW: &str = "IMPACT, STIFFNESS=1000, EXPONENT=1.5, DAMPING=7, DMAX=0.02";

/// A body of mass 1 whose solid stands at marker 2, over a plane at height 0 that is GRAPHICS/1.
fn over_plane(z: f64, angles: &str, more: &str, solid: &str) -> String {
    format!(
        "PART/2, MASS=1, CM=3, IP=1,1,1, QG=0.3,0.2,{z:?}, REULER={angles}{more}\nMARKER/2, PART=2\nMARKER/3, PART=2\n\
         GRAPHICS/1, PLANE, RM=1\nGRAPHICS/2, {solid}\nCONTACT/1, IGEOM=2, JGEOM=1, {LAW}\n"
    )
}

fn close(a: [f64; 6], b: [f64; 6]) {
    for (a, b) in a.iter().zip(b) {
        // rounding of forces of some ten
        assert!((a - b).abs() < 1e-11, "{a} instead of {b}");
    }
}

/// IMPACT with the numbers of [`LAW`], at rest.
fn elastic(depth: f64) -> f64 {
    1000.0 * depth.max(0.0).powf(1.5)
}

#[test]
fn a_sphere_on_a_plane_feels_impact() {
    let sphere = "ELLIPSOID, CM=2, XSCALE=1, YSCALE=1, ZSCALE=1";
    close(
        force(&over_plane(0.49, "0.3,0.4,0.5", "", sphere)),
        [0.0, 0.0, elastic(0.01), 0.0, 0.0, 0.0],
    );
    close(
        force(&over_plane(0.51, "0.3,0.4,0.5", "", sphere)),
        [0.0; 6],
    );
    // half of the depth at which all the damping is there: STEP is one half
    let moving = force(&over_plane(0.49, "0,0,0", ", VZ=-2", sphere));
    close(moving, [0.0, 0.0, elastic(0.01) + 3.5 * 2.0, 0.0, 0.0, 0.0]);
    // the same law written as an expression
    let text = over_plane(0.47, "0,0,0", ", VZ=-0.2", sphere)
        + "VARIABLE/1, FUNCTION=IMPACT(DZ(2,1,1),VZ(2,1,1),0.5,1000,1.5,7,0.02)-CONTACT(1,0,4,0)\n";
    let s = solve(
        &text,
        &["VARVAL(1)", "CONTACT(1,0,4,0)"],
        Analysis::Dynamic,
        0.5,
    );
    assert!(values(&s, "VARVAL(1)").iter().all(|x| x.abs() < 1e-11));
    assert!(values(&s, "CONTACT(1,0,4,0)")[0] > 1.0);
}

#[test]
fn a_box_stands_on_its_corners() {
    let cuboid = "BOX, CORNER=2, X=1, Y=2, Z=3";
    let n = elastic(0.01);
    // four corners at (0, 0), (1, 0), (0, 2), (1, 2) from the marker
    close(
        force(&over_plane(-0.01, "0,0,0", "", cuboid)),
        [0.0, 0.0, 4.0 * n, 4.0 * n, -2.0 * n, 0.0],
    );
    // a negative extent goes the other way
    let hanging = "BOX, CORNER=2, X=1, Y=2, Z=-3";
    close(
        force(&over_plane(2.99, "0,0,0", "", hanging)),
        [0.0, 0.0, 4.0 * n, 4.0 * n, -2.0 * n, 0.0],
    );
    // on one edge: turned by 45 degrees about y of ground
    let edge = force(&over_plane(-0.01, "90D,-45D,-90D", "", cuboid));
    close(edge, [0.0, 0.0, 2.0 * n, 2.0 * n, 0.0, 0.0]);
}

#[test]
fn a_cylinder_stands_on_its_rim_and_lies_on_a_line() {
    let cylinder = "CYLINDER, CM=2, LENGTH=3, RADIUS=0.5";
    let n = elastic(0.01);
    close(
        force(&over_plane(-0.01, "0,0,0", "", cylinder)),
        [0.0, 0.0, 4.0 * n, 0.0, 0.0, 0.0],
    );
    // z of the body along −y of ground
    let lying = force(&over_plane(0.49, "0,90D,0", "", cylinder));
    close(lying, [0.0, 0.0, 2.0 * n, -3.0 * n, 0.0, 0.0]);
    // a cone on its tip, and on its side: half angle 45 degrees
    let cone = "FRUSTUM, CM=2, LENGTH=1, TOP=1, BOTTOM=0";
    close(
        force(&over_plane(-0.01, "0.2,0.3,0.1", "", cone)),
        [0.0, 0.0, n, 0.0, 0.0, 0.0],
    );
    let side = force(&over_plane(-0.01, "0,45D,0", "", cone));
    close(side, [0.0, 0.0, 2.0 * n, -2f64.sqrt() * n, 0.0, 0.0]);
}

#[test]
fn an_ellipsoid_and_a_torus_touch_at_their_deepest_points() {
    let ellipsoid = "ELLIPSOID, CM=2, XSCALE=1, YSCALE=2, ZSCALE=4";
    close(
        force(&over_plane(1.99, "0,0,0", "", ellipsoid)),
        [0.0, 0.0, elastic(0.01), 0.0, 0.0, 0.0],
    );
    // about x by 45 degrees: √(a² + b²)/√2 is its height
    let height = (2.5f64).sqrt();
    let tilted = force(&over_plane(height - 0.01, "0,45D,0", "", ellipsoid));
    assert!((tilted[2] - elastic(0.01)).abs() < 1e-10 && tilted[3].abs() > 1e-3);
    let torus = "TORUS, CM=2, MAJOR_RADIUS=1, MINOR_RADIUS=0.2";
    close(
        force(&over_plane(0.19, "0,0,0", "", torus)),
        [0.0, 0.0, 4.0 * elastic(0.01), 0.0, 0.0, 0.0],
    );
    close(
        force(&over_plane(1.19, "0,90D,0", "", torus)),
        [0.0, 0.0, elastic(0.01), 0.0, 0.0, 0.0],
    );
}

#[test]
fn a_plane_ends_at_its_bounds() {
    let text = over_plane(-0.01, "0,0,0", "", "BOX, CORNER=2, X=1, Y=2, Z=3")
        .replace("RM=1", "RM=1, XMIN=-1, XMAX=1, YMIN=-9");
    let n = elastic(0.01);
    close(force(&text), [0.0, 0.0, 2.0 * n, 2.0 * n, 0.0, 0.0]);
    // a sphere beside the edge is pushed away from it
    let sphere = over_plane(
        0.3,
        "0,0,0",
        "",
        "ELLIPSOID, CM=2, XSCALE=1, YSCALE=1, ZSCALE=1",
    )
    .replace("RM=1", "RM=1, XMAX=-0.08");
    // 0.38 beside and 0.3 above the edge
    let away = 0.38f64.hypot(0.3);
    let f = elastic(0.5 - away);
    close(
        force(&sphere),
        [f * 0.38 / away, 0.0, f * 0.3 / away, 0.0, 0.0, 0.0],
    );
}

#[test]
fn a_sphere_touches_every_solid_from_every_side_alike() {
    // between a sphere at marker 2 and a solid at marker 1, as I and as J
    for solid in [
        "BOX, CORNER=1, X=1, Y=1, Z=1",
        "CYLINDER, CM=1, LENGTH=1, RADIUS=0.7",
        "FRUSTUM, CM=1, LENGTH=1, TOP=0.5, BOTTOM=0.8",
        "TORUS, CM=1, MAJOR_RADIUS=0.7, MINOR_RADIUS=0.3",
        "ELLIPSOID, CM=1, XSCALE=2, YSCALE=2, ZSCALE=2",
        "PLANE, RM=1",
    ] {
        let text = |pair: &str| {
            format!(
                "PART/2, MASS=1, CM=2, IP=1,1,1, QG=0.8,0.3,0.5, VX=1, VZ=-2\nMARKER/2, PART=2\n\
                 GRAPHICS/1, {solid}\nGRAPHICS/2, ELLIPSOID, CM=2, XSCALE=1.5, YSCALE=1.5, ZSCALE=1.5\n\
                 CONTACT/1, {pair}, {LAW}, COULOMB_FRICTION=ON, MU_STATIC=0.3, MU_DYNAMIC=0.1\n\
                 , STICTION_TRANSITION_VELOCITY=0.1, FRICTION_TRANSITION_VELOCITY=1\n"
            )
        };
        let columns: Vec<String> = (0..2)
            .flat_map(|j| (1..9).map(move |k| format!("CONTACT(1,{j},{k},0)")))
            .collect();
        let names: Vec<&str> = columns.iter().map(String::as_str).collect();
        let mut first = Vec::new();
        for pair in ["IGEOM=2, JGEOM=1", "IGEOM=1, JGEOM=2"] {
            let s = solve(&text(pair), &names, Analysis::Dynamic, 1e-9);
            let mut now: Vec<f64> = columns.iter().map(|c| values(&s, c)[0]).collect();
            if pair.starts_with("IGEOM=1") {
                now.rotate_left(8);
            }
            assert!(now[0] > 1.0, "{solid} {now:?}");
            // equal and opposite
            for k in 1..4 {
                assert!((now[k] + now[k + 8]).abs() < 1e-11 * now[0], "{solid}");
            }
            if first.is_empty() {
                first = now;
            } else {
                // as I and as J the same
                assert!(
                    first
                        .iter()
                        .zip(&now)
                        .all(|(a, b)| (a - b).abs() < 1e-9 * now[0]),
                    "{solid} {first:?} {now:?}"
                );
            }
        }
    }
}

#[test]
fn a_contact_of_several_solids_is_the_sum_of_its_pairs() {
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1, QG=0,0,0.49, VX=3, WY=1\nMARKER/2, PART=2\nMARKER/3, PART=2, QP=2,0,0\n\
                GRAPHICS/1, PLANE, RM=1\nGRAPHICS/2, ELLIPSOID, CM=2, XSCALE=1, YSCALE=1, ZSCALE=1\n\
                GRAPHICS/3, ELLIPSOID, CM=3, XSCALE=1.02, YSCALE=1.02, ZSCALE=1.02\n\
                CONTACT/1, IGEOM=2,3, JGEOM=1, IMPACT, STIFFNESS=1000, EXPONENT=1, DAMPING=0, DMAX=0.1\n";
    close(force(text), [0.0, 0.0, 30.0, 0.0, -40.0, 0.0]);
}

#[test]
fn a_deactivated_contact_does_nothing_and_an_activated_one_does() {
    let text = over_plane(
        0.6,
        "0,0,0",
        "",
        "ELLIPSOID, CM=2, XSCALE=1, YSCALE=1, ZSCALE=1",
    ) + "ACCGRAV/KGRAV=-10\n";
    let mut s = session(&text, &["DZ(2,1)"], 1e-9);
    s.model.inactive.insert(ElementKind::Contact.id(1));
    go(&mut s, Analysis::Dynamic, 0.1, 4);
    // free fall through where the contact would be
    assert!((last(&s, "DZ(2,1)") - 0.55).abs() < 1e-9);
    s.model.inactive.clear();
    go(&mut s, Analysis::Dynamic, 0.4, 50);
    assert!(last(&s, "DZ(2,1)") > 0.4);
}

#[test]
fn a_body_settles_by_its_contact_in_statics() {
    let sphere = "ELLIPSOID, CM=2, XSCALE=1, YSCALE=1, ZSCALE=1";
    let text = over_plane(0.6, "0,0,0", "", sphere) + "ACCGRAV/KGRAV=-10\n";
    let s = solve(&text, &["DZ(2,1)"], Analysis::Static, 0.0);
    // k gᵉ = m |g|
    let depth = (10.0f64 / 1000.0).powf(1.0 / 1.5);
    assert!((last(&s, "DZ(2,1)") - (0.5 - depth)).abs() < 1e-9);
}

#[test]
fn poisson_gives_back_its_part_of_the_speed() {
    for r in [0.0, 0.3, 0.7, 1.0] {
        for speed in [0.5, 5.0] {
            let text = format!(
                "PART/2, MASS=2, CM=2, IP=1,1,1, QG=0,0,0.6, VZ=-{speed:?}\nMARKER/2, PART=2\nGRAPHICS/1, PLANE, RM=1\n\
                 GRAPHICS/2, ELLIPSOID, CM=2, XSCALE=1, YSCALE=1, ZSCALE=1\n\
                 CONTACT/1, IGEOM=2, JGEOM=1, POISSON, PENALTY=1E6, RESTITUTION_COEFFICIENT={r:?}\n"
            );
            let s = solve(&text, &["VZ(2,1)"], Analysis::Dynamic, 1.0);
            // the smoothing speed is 6e-4; with r = 0 the body creeps out at about that speed
            assert!(
                (last(&s, "VZ(2,1)") - r * speed).abs() < 2e-3,
                "{r} {speed}: {}",
                last(&s, "VZ(2,1)")
            );
            assert!(
                s.run.record.warned().iter().any(|w| w.contains("POISSON")),
                "{:?}",
                s.run.record.warned()
            );
        }
    }
}

#[test]
fn energy_of_a_bounce_is_accounted_for() {
    let text = "PART/2, MASS=1, CM=2, IP=0.1,0.1,0.1, QG=0,0,1, VX=1\nMARKER/2, PART=2\nGRAPHICS/1, PLANE, RM=1\nACCGRAV/KGRAV=-10\n\
                GRAPHICS/2, ELLIPSOID, CM=2, XSCALE=1, YSCALE=1, ZSCALE=1\nMARKER/3, PART=1\n\
                CONTACT/1, IGEOM=2, JGEOM=1, IMPACT, STIFFNESS=1E4, EXPONENT=1, DAMPING=10, DMAX=1E-3\n\
                , COULOMB_FRICTION=ON, MU_STATIC=0.3, MU_DYNAMIC=0.2, STICTION_TRANSITION_VELOCITY=0.01, FRICTION_TRANSITION_VELOCITY=0.1\n\
                DIFF/1, FUNCTION=CONTACT(1,0,2,0)*VX(2)+CONTACT(1,0,4,0)*VZ(2)+CONTACT(1,0,7,0)*WY(2)\n";
    let energy = "0.5*VM(2)**2+0.05*WM(2)**2+10*DZ(2)";
    let s = solve(text, &[energy, "DIF(1)", "WY(2)"], Analysis::Dynamic, 2.0);
    let (e, work) = (values(&s, energy), values(&s, "DIF(1)"));
    for (e1, w) in e.iter().zip(work) {
        assert!((e1 - e[0] - w).abs() < 1e-6, "{e1} {w}");
    }
    assert!(last(&s, "DIF(1)") < -0.5 && last(&s, "WY(2)") > 0.1);
}

#[test]
fn what_cannot_be_solved_is_named_with_its_reason() {
    let text = over_plane(
        0.6,
        "0,0,0",
        "",
        "EXTERNAL, RM=2, FILE=gear.xmt_txt, ELEMENT=SOLID1",
    );
    let mut s = session(&text, &[], 1e-6);
    let errors = mistakes(&mut s, Analysis::Dynamic);
    let told = format!("{:?}", errors[0]);
    assert!(
        errors[0].code == "unsupported"
            && told.contains("gear.xmt_txt")
            && told.contains("CONTACT/1"),
        "{told}"
    );
    let text = over_plane(0.6, "0,0,0", "", "BOX, CORNER=2, X=1, Y=0, Z=1");
    let errors = mistakes(&mut session(&text, &[], 1e-6), Analysis::Dynamic);
    assert!(
        errors[0].message.contains("GRAPHICS/2 has no size"),
        "{errors:?}"
    );
}

#[test]
fn corners_in_the_air_cost_no_steps() {
    // a box that slides with friction: its upper corners are far from the plane, whatever their damping would be there
    let text = "PART/2, MASS=1, CM=3, IP=0.02,0.02,0.03, QG=0,0,0.1, VX=0.5\nMARKER/2, PART=2, QP=-0.2,-0.2,-0.1\nMARKER/3, PART=2\n\
                GRAPHICS/1, PLANE, RM=1\nGRAPHICS/2, BOX, CORNER=2, X=0.4, Y=0.4, Z=0.2\nACCGRAV/IGRAV=3, KGRAV=-9.4\n\
                CONTACT/1, IGEOM=2, JGEOM=1, IMPACT, STIFFNESS=1E6, EXPONENT=1, DAMPING=600, DMAX=1E-12\n\
                , COULOMB_FRICTION=ON, MU_STATIC=0.3, MU_DYNAMIC=0.3, STICTION_TRANSITION_VELOCITY=1E-3, FRICTION_TRANSITION_VELOCITY=2E-3\n";
    let s = solve(text, &["VX(3)"], Analysis::Dynamic, 0.5);
    let expected = 0.5 + 0.5 * (3.0 - 0.3 * 9.4);
    assert!((last(&s, "VX(3)") - expected).abs() < 1e-3);
    // there were some 60 000 per tenth of a second when the sign of a force that does not act counted
    let counts = s.run.record.counts;
    assert!(counts.steps + counts.rejected_steps < 1500, "{counts:?}");
}

#[cfg(not(feature = "geometry"))]
#[test]
fn boxes_on_boxes_name_the_feature_they_need() {
    let text = over_plane(0.6, "0,0,0", "", "BOX, CORNER=2, X=1, Y=1, Z=1")
        .replace("PLANE, RM=1", "BOX, CORNER=1, X=1, Y=1, Z=1");
    let errors = mistakes(&mut session(&text, &[], 1e-6), Analysis::Dynamic);
    assert!(errors[0].message.contains("feature geometry"), "{errors:?}");
}
