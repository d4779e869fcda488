//! CONTACT of curves and points in a plane: the same as of spheres and planes, several touches, sides, corners, and the limit of stiff
//! contact, which is PTCV and CVCV.
#![cfg(feature = "solver")]

#[path = "common/curves.rs"]
mod curves;

use cognate::analysis::dynamics::Unwatched;
use cognate::analysis::session::{Analysis, Options, Session};
use cognate::model::Model;
use cognate::results::Status;
use curves::{circle, curve, line};

fn session(text: &str, columns: &[&str], error: f64) -> Session {
    let text = format!("TEST\nPART/1, GROUND\nMARKER/1, PART=1\n{text}END\n");
    let model = Model::from_text(&text).unwrap_or_else(|e| panic!("{e}"));
    let options = Options {
        columns: columns.iter().map(ToString::to_string).collect(),
        error: Some(error),
        ..Options::default()
    };
    Session::new(model, "test", options)
}

fn run(text: &str, columns: &[&str], analysis: Analysis, end: f64, error: f64) -> Session {
    let mut s = session(text, columns, error);
    let status = s
        .simulate(analysis, end, 40, &mut Unwatched)
        .unwrap_or_else(|e| panic!("{e:?}"));
    assert_eq!(status, Status::Completed, "{}", s.run.record.stop_reason);
    s
}

fn values<'s>(s: &'s Session, column: &str) -> &'s [f64] {
    s.run.column(column).unwrap()
}

fn last(s: &Session, column: &str) -> f64 {
    *values(s, column).last().unwrap()
}

/// Nothing leaves the x–y plane: part 2 with three freedoms.
const PLANAR: &str = "JOINT/1, PLANAR, I=2, J=1\n";
const IMPACT: &str = "IMPACT, STIFFNESS=1E4, EXPONENT=1.5, DAMPING=20, DMAX=1E-3";
const POISSON: &str = "POISSON, PENALTY=1E5, RESTITUTION_COEFFICIENT=0.5";
const FRICTION: &str = "COULOMB_FRICTION=ON, MU_STATIC=0.3, MU_DYNAMIC=0.2, STICTION_TRANSITION_VELOCITY=0.01, FRICTION_TRANSITION_VELOCITY=0.1";
const COLUMNS: [&str; 6] = ["DX(2)", "DY(2)", "VX(2)", "VY(2)", "WZ(2)", "CONTACT(1,0,3,0)"];

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
