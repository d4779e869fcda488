//! COUPLER and CURVE that closures compute, against GCONs that say the same as expressions.

use crate::running;

use cognate::internals::system::closures::Call;
use cognate::model::Model;
use cognate::scalar::Scalar;
use running::{Analysis, Session, begin, go, mistakes, model, options, options_by, values};

/// Two pendulums beside each other, at angles of 0.3 and where `relation` puts the second.
fn pendulums(relation: &str) -> Model {
    model(&format!(
        "PART/2, QG=0,0,0, REULER=0.3,0,0, MASS=1, CM=20, IP=0.1,0.1,0.1, WZ=0.5\nMARKER/20, PART=2, QP=0,-1,0\nMARKER/21, PART=2\n\
         PART/3, QG=3,0,0, MASS=2, CM=30, IP=0.1,0.1,0.1\nMARKER/30, PART=3, QP=0,-1,0\nMARKER/31, PART=3\nMARKER/13, PART=1, QP=3,0,0\n\
         JOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=13\nACCGRAV/JGRAV=-9.81\n{relation}\n"
    ))
}

const ANGLES: [&str; 4] = ["AZ(21,1)", "AZ(31,13)", "WZ(31,13)", "WDTZ(31,13)"];

/// What couples the angles: q2 + q1 q2 / 2 − 0.4 sin q1, no sum of functions of each.
fn relation(q: &[f64]) -> f64 {
    q[1] + 0.5 * q[0] * q[1] - 0.4 * Scalar::sin(q[0])
}

fn coupled(session: &mut Session, partials: usize) {
    session.register("COUPLER/1", &[], move |call: &Call<'_>, out: &mut [f64]| {
        let q = call.values;
        out[0] = relation(q);
        let all = [
            0.5 * q[1] - 0.4 * Scalar::cos(q[0]),
            1.0 + 0.5 * q[0],
            0.4 * Scalar::sin(q[0]),
            0.5,
            0.0,
        ];
        out[1..=partials].copy_from_slice(&all[..partials]);
    });
}

fn most(a: &Session, b: &Session, columns: &[&str]) -> f64 {
    let mut most: f64 = 0.0;
    for column in columns {
        for (x, y) in values(a, column).iter().zip(values(b, column)) {
            most = most.max((x - y).abs());
        }
    }
    most
}

/// Forces of a coupler are those of its scales, and work that time does through it is known.
#[test]
fn forces_and_works_of_a_coupler_by_a_closure_are_those_of_scales_and_of_a_gcon() {
    let columns = ["COUPLER_1.F1", "COUPLER_1.F2", "ENERGY.KINETIC"];
    let run = |relation: &str, columns: &[&str], law: Option<fn(&[f64], f64) -> f64>| {
        let mut session = begin(pendulums(relation), "coupled", options(columns, 1e-9));
        if let Some(law) = law {
            session.register("COUPLER/1", &[], move |call: &Call<'_>, out: &mut [f64]| {
                out[0] = law(call.values, call.time);
            });
        }
        go(&mut session, Analysis::Dynamic, 2.0, 20);
        session
    };
    let scales = run(
        "COUPLER/1, JOINTS=1,2, TYPE=R:R, SCALES=1,-2",
        &columns,
        None,
    );
    let by_user = "COUPLER/1, JOINTS=1,2, TYPE=R:R, FUNCTION=USER()";
    // scales hold the angles that are drawn
    let found = run(by_user, &columns, Some(|q, _| q[0] - 2.0 * q[1] - 0.3));
    let most_off = most(&scales, &found, &columns);
    assert!(most_off < 1e-6, "{most_off:e}");
    let gcon = run(
        "GCON/1, FUNCTION=AZ(21,1)-2*AZ(31,13)-TIME**2",
        &["ENERGY.KINETIC"],
        None,
    );
    let driven = run(
        by_user,
        &["ENERGY.KINETIC"],
        Some(|q, t| q[0] - 2.0 * q[1] - t * t),
    );
    let works = [&gcon, &driven].map(|s| s.run.record.energy.by_motions);
    assert!(
        works[0].abs() > 0.01 && (works[0] - works[1]).abs() < 1e-6,
        "{works:?}"
    );
}

#[test]
fn a_coupler_by_a_closure_holds_what_a_gcon_does() {
    let gcon = "GCON/1, FUNCTION=AZ(31,13)+0.5*AZ(21,1)*AZ(31,13)-0.4*SIN(AZ(21,1))";
    let coupler = "COUPLER/1, JOINTS=1,2, TYPE=R:R, FUNCTION=USER()";
    for (analysis, method) in [
        (Analysis::Dynamic, "DOP853"),
        (Analysis::Dynamic, "RADAU5"),
        (Analysis::Static, "DOP853"),
    ] {
        let run = |relation: &str, partials: Option<usize>| {
            let options = options_by(&ANGLES, method, 1e-10);
            let mut session = begin(pendulums(relation), "coupled", options);
            if let Some(partials) = partials {
                coupled(&mut session, partials);
            }
            go(&mut session, analysis, 2.0, 50);
            session
        };
        let known = run(gcon, None);
        // without partial derivatives, with the first, with all
        for partials in [0, 2, 5] {
            let found = run(coupler, Some(partials));
            let most = most(&known, &found, &ANGLES);
            assert!(most < 1e-7, "{analysis:?} {method:?} {partials}: {most:e}");
        }
    }
}

#[test]
fn a_partial_derivative_that_is_not_that_of_the_coupler_is_told() {
    let coupler = "COUPLER/1, JOINTS=1,2, TYPE=R:R, FUNCTION=USER()";
    let mut session = begin(pendulums(coupler), "coupled", options(&ANGLES, 1e-8));
    session.register("COUPLER/1", &[], |call, out| {
        out[0] = relation(call.values);
        out[1] = 7.0;
    });
    let said = mistakes(&mut session, Analysis::Dynamic);
    assert!(
        said.iter().any(|d| d
            .message
            .contains("partial derivative along displacement 1,")),
        "{said:?}"
    );
}

/// A circle of radius 0.5 about a centre, over parameters from 0 to 2π.
fn circle(centre: [f64; 2]) -> impl Fn(&Call<'_>, &mut [f64]) + Send + Sync {
    move |call, out| {
        let (sin, cos) = Scalar::sin_cos(call.values[0]);
        let r = 0.5;
        match call.values[1] as u32 {
            0 => out[..2].copy_from_slice(&[centre[0] + r * cos, centre[1] + r * sin]),
            1 => out[..2].copy_from_slice(&[-r * sin, r * cos]),
            _ => out[..2].copy_from_slice(&[-r * cos, -r * sin]),
        }
    }
}

const ROUND: &str = "CLOSED, FUNCTION=USER(), MINPAR=0, MAXPAR=6.283185307179586";

#[test]
fn a_bead_on_a_curve_by_a_closure_moves_as_on_a_circle() {
    let columns = ["DX(30,1)", "DY(30,1)", "VX(30,1)", "ACCY(30)"];
    let of = |rows: &str| {
        model(&format!(
            "PART/3, MASS=0.5, CM=30, IP=1,1,1, QG=0.5,0,0, VY=2\nMARKER/30, PART=3\nMARKER/12, PART=1, FLOATING\n\
             JPRIM/1, ORIENTATION, I=30, J=1\nACCGRAV/JGRAV=-9.81\n{rows}\n"
        ))
    };
    let run = |rows: &str, by: bool| {
        let mut session = begin(of(rows), "bead", options(&columns, 1e-11));
        if by {
            session.register("CURVE/1", &[], circle([0.0; 2]));
        }
        go(&mut session, Analysis::Dynamic, 2.0, 50);
        session
    };
    let gcon = "GCON/1, FUNCTION=DM(30,1)-0.5\nGCON/2, FUNCTION=DZ(30,1)";
    let known = run(gcon, false);
    let found = run(
        &format!("CURVE/1, {ROUND}\nPTCV/1, CURVE=1, I=30, RM=1, JFLOAT=12"),
        true,
    );
    let most = most(&known, &found, &columns);
    assert!(most < 1e-7, "{most:e}");
}

#[test]
fn discs_by_closures_roll_over_each_other_at_the_distance_of_their_centres() {
    let columns = ["DX(30,1)", "DY(30,1)", "WZ(30,1)"];
    let of = |rows: &str| {
        model(&format!(
            "PART/3, MASS=0.5, CM=30, IP=1,1,1, QG=0.2,0.9797958971132712,0, VX=0.1, WZ=1\nMARKER/30, PART=3\n\
             JPRIM/1, INPLANE, I=30, J=1\nJPRIM/2, PARALLEL, I=30, J=1\nACCGRAV/JGRAV=-9.81\n{rows}\n"
        ))
    };
    let run = |rows: &str, by: bool| {
        let mut session = begin(of(rows), "discs", options(&columns, 1e-11));
        if by {
            session.register("CURVE/1", &[], circle([0.0; 2]));
            session.register("CURVE/2", &[], circle([0.0; 2]));
        }
        go(&mut session, Analysis::Dynamic, 0.5, 20);
        session
    };
    let known = run("GCON/1, FUNCTION=DM(30,1)-1", false);
    let found = run(
        &format!("CURVE/1, {ROUND}\nCURVE/2, {ROUND}\nCVCV/1, ICURVE=2, IRM=30, JCURVE=1, JRM=1"),
        true,
    );
    let most = most(&known, &found, &columns);
    assert!(most < 1e-7, "{most:e}");
}

#[test]
fn a_curve_by_a_closure_is_read_by_functions() {
    let text = model(&format!(
        "CURVE/1, {ROUND}\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nJOINT/1, FIXED, I=20, J=1\nVARIABLE/1, FUNCTION=CURVE(1+TIME,0,1,1)+CURVE(1,1,2,1)\n"
    ));
    let mut session = begin(text, "curve", options(&["VARVAL(1)"], 1e-8));
    session.register("CURVE/1", &[], circle([2.0, 0.0]));
    go(&mut session, Analysis::Dynamic, 1.0, 4);
    for (k, x) in values(&session, "VARVAL(1)").iter().enumerate() {
        let t = 0.25 * k as f64;
        assert!((x - (2.0 + 0.5 * (1.0 + t).cos() + 0.5 * 1f64.cos())).abs() < 1e-14);
    }
}
