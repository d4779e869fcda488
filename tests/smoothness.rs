//! Continuity classes and breakpoints: as the functions are defined, and as differences see them.

use cognate::expr::Expr;
use cognate::expr::functions::Continuity::{self, C0, C1, C2, Jump, Smooth};
use cognate::expr::interpolation::{Bindings, Spline};
use cognate::expr::smoothness::Smoothness;
use cognate::expr::spline::{Ends, Extrapolation};
use std::sync::Arc;

/// Spline 1: knots 0, 1, 2, 3, 5, not a parabola anywhere.
fn bindings() -> Bindings {
    let spline = Spline::new(
        vec![0.0, 1.0, 2.0, 3.0, 5.0],
        vec![],
        vec![vec![0.0, 1.0, 0.5, 2.0, -1.0]],
        Ends::Natural,
        Extrapolation::Linear,
    );
    let mut bindings = Bindings::default();
    bindings.splines.insert(1, Arc::new(spline.unwrap()));
    bindings
}

fn of(text: &str) -> Smoothness {
    let f = Expr::parse(text).unwrap_or_else(|e| panic!("{text}: {e}"));
    f.smoothness(&bindings(), -10.0..=10.0)
        .unwrap_or_else(|e| panic!("{text}: {e}"))
}

/// Class, and (time, order) of the breakpoints.
fn assert_breaks(text: &str, class: Continuity, breaks: &[(f64, usize)]) {
    let found = of(text);
    let got: Vec<(f64, usize)> = found.breakpoints.iter().map(|b| (b.at, b.order)).collect();
    let near = |(a, b): (&(f64, usize), &(f64, usize))| {
        (a.0 - b.0).abs() < 1e-14 * (1.0 + b.0.abs()) && a.1 == b.1
    };
    assert!(
        got.len() == breaks.len() && got.iter().zip(breaks).all(near),
        "{text}: {got:?}, not {breaks:?}"
    );
    assert_eq!(found.class, class, "{text}");
    assert!(found.complete && found.surfaces.is_empty(), "{text}");
}

#[test]
fn every_function_breaks_where_its_definition_says() {
    assert_breaks("SIN(TIME)*EXP(TIME)", Smooth, &[]);
    assert_breaks("STEP(TIME,1,0,2,1)", C1, &[(1.0, 2), (2.0, 2)]);
    assert_breaks("STEP5(TIME,0.1,0,0.3,1)", C2, &[(0.1, 3), (0.3, 3)]);
    assert_breaks("HAVSIN(TIME,-1,2,3,1)", C1, &[(-1.0, 2), (3.0, 2)]);
    assert_breaks("IF(TIME-2:0,0,1)", Jump, &[(2.0, 0)]);
    assert_breaks("IF(TIME-2:0,5,0)", Jump, &[(2.0, 0)]);
    assert_breaks("IF(TIME-2:2,2,TIME)", C0, &[(2.0, 1)]);
    assert_breaks("ABS(TIME-1)", C0, &[(1.0, 1)]);
    assert_breaks("ABS(TIME)**3", C2, &[(0.0, 3)]);
    assert_breaks("MAX(TIME,1)", C0, &[(1.0, 1)]);
    assert_breaks("MIN(TIME,1,2-TIME)", C0, &[(1.0, 1)]);
    assert_breaks("MAX(0,TIME-1)**2", C1, &[(1.0, 2)]);
    assert_breaks("DIM(TIME,3)", C0, &[(3.0, 1)]);
    assert_breaks("SIGN(2,TIME-1)", Jump, &[(1.0, 0)]);
    assert_breaks("SIGN(TIME-1,TIME-1)", Smooth, &[]);
    assert_breaks(
        "MOD(TIME,4)",
        Jump,
        &[(-8.0, 0), (-4.0, 0), (4.0, 0), (8.0, 0)],
    );
    assert_breaks(
        "AINT(TIME/4)",
        Jump,
        &[(-8.0, 0), (-4.0, 0), (4.0, 0), (8.0, 0)],
    );
    assert_breaks(
        "NINT(TIME/4)",
        Jump,
        &[(-6.0, 0), (-2.0, 0), (2.0, 0), (6.0, 0)],
    );
    assert_breaks(
        "POLY(TIME,1,2,3,4)+CHEBY(TIME,0,1,1)+FORCOS(TIME,0,1,1,1)+FORSIN(TIME,0,1,1,1)",
        Smooth,
        &[],
    );
    assert_breaks("SHF(TIME,0,1,2,3,4)", Smooth, &[]);
    // the fade begins with a third derivative times sin(0): the fourth; the frequency bends at x0 and x1
    assert_breaks(
        "SWEEP(TIME,1,1,2,5,6,0.3)",
        C1,
        &[(0.0, 4), (0.3, 3), (1.0, 2), (5.0, 2)],
    );
    assert_breaks("IMPACT(TIME,-1,1,100,1.5,0,0.1)", C1, &[(1.0, 2)]);
    assert_breaks("IMPACT(TIME,-1,1,100,1,0,0.1)", C0, &[(1.0, 1)]);
    assert_breaks(
        "IMPACT(TIME,-1,1,100,2.2,10,0.5)",
        C1,
        &[(0.5, 2), (1.0, 2)],
    );
    assert_breaks(
        "BISTOP(TIME,1,-1,2,100,1,0,0.1)",
        C0,
        &[(-1.0, 1), (2.0, 1)],
    );
    // beyond the data runs the line through two points, which is not the tangent
    assert_breaks(
        "CUBSPL(TIME,0,1,0)",
        C0,
        &[(0.0, 1), (1.0, 3), (2.0, 3), (3.0, 3), (5.0, 1)],
    );
    assert_breaks("INTERP(TIME,1,1)", C0, &[(1.0, 1), (2.0, 1), (3.0, 1)]);
    assert_eq!(of("AKISPL(TIME,0,1,0)").breakpoints[1].order, 2);
    assert_breaks("ATAN2(TIME,-1)", Jump, &[(0.0, 0)]);
    assert_breaks("ATAN2(TIME,1)", Smooth, &[]);
    assert_breaks("1/(TIME-1)", Jump, &[(1.0, 0)]);
    assert_breaks(
        "TAN(TIME/3)",
        Jump,
        &[
            (-1.5 * std::f64::consts::PI, 0),
            (1.5 * std::f64::consts::PI, 0),
        ],
    );
    assert_breaks("SQRT(ABS(TIME-4))", C0, &[(4.0, 1)]);
    assert_breaks("ASIN(MIN(TIME,1)*MAX(TIME,-1)*0+0.5)", Smooth, &[]);
}

#[test]
fn jumps_say_how_much() {
    let step = &of("STEP(TIME,1,0,2,1)").breakpoints[0];
    assert_eq!((step.jump(0), step.jump(1), step.jump(2)), (0.0, 0.0, 6.0));
    let kink = &of("3*ABS(TIME-1)").breakpoints[0];
    assert_eq!((kink.before[1], kink.after[1]), (-3.0, 3.0));
    let jump = &of("IF(TIME-2:1,1,4)").breakpoints[0];
    assert_eq!((jump.at, jump.jump(0)), (2.0, 3.0));
    assert_eq!(of("1/TIME").breakpoints[0].after[0], f64::INFINITY);
}

#[test]
fn breaks_that_cancel_are_none() {
    assert_breaks("ABS(TIME)*ABS(TIME)", Smooth, &[]);
    assert_breaks("MAX(TIME,1)+MIN(TIME,1)", Smooth, &[]);
    assert_breaks("STEP(TIME,1,0,2,1)+STEP(TIME,1,1,2,0)", Smooth, &[]);
    assert_breaks("IF(TIME-1:TIME,1,1+LOG(TIME))", C1, &[(1.0, 2)]);
    assert_breaks("SIN(TIME)/TIME*0+1", Jump, &[(0.0, 0)]);
}

#[test]
fn crossings_are_found_where_the_argument_bends_too() {
    let pi = std::f64::consts::PI;
    assert_breaks("ABS(COS(TIME/4))", C0, &[(-2.0 * pi, 1), (2.0 * pi, 1)]);
    // two roots 2e-4 apart, far inside one cell
    let found = of("ABS((TIME-1)**2-1E-8)");
    assert_eq!(found.breakpoints.len(), 2, "{found:?}");
    assert!((found.breakpoints[1].at - 1.0001).abs() < 1e-12);
    // touching is no crossing
    assert_breaks("ABS((TIME-1)**2)", Smooth, &[]);
    let many = of("SIGN(1,SIN(5*PI*TIME))");
    assert_eq!(many.breakpoints.len(), 99);
    let endless = of("MOD(TIME,1E-5)");
    assert!(!endless.complete && endless.class == Jump);
}

#[test]
fn other_inputs_break_on_surfaces() {
    let class = |text: &str| of(text).class;
    assert_eq!(class("DX(1,2)*SIN(TIME)"), Smooth);
    assert_eq!(class("ABS(DX(1,2)-3)"), C0);
    assert_eq!(class("STEP(DX(1,2),0,0,1,1)"), C1);
    assert_eq!(class("STEP5(DX(1,2)+VX(1,2),0,0,1,1)"), C2);
    assert_eq!(class("IF(DX(1,2)-TIME:0,0,1)"), Jump);
    assert_eq!(class("MAX(0,DX(1,2))**4"), C2);
    assert_eq!(class("IMPACT(DX(1,2),VX(1,2),1,100,1.5,10,0.1)"), C0);
    assert_eq!(class("-IMPACT(DX(1,2),0,1,100,2.5,0,0.1)"), C2);
    assert_eq!(class("DELAY(TIME,0.1,TIME)"), Jump);
    let found = of("STEP(DX(1,2),0.5,0,1,1)*STEP5(TIME,1,0,2,1)");
    let switches: Vec<&str> = found.surfaces.iter().map(|s| s.switch.as_str()).collect();
    assert_eq!(switches, ["DX(1, 2) - 0.5", "1 - DX(1, 2)"]);
    assert_eq!(found.breakpoints.len(), 2);
    assert_eq!(found.class, C1);
}
