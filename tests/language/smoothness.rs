//! Continuity classes and breakpoints: as the functions are defined, and as differences see them.

use cognate::expr::Expr;
use cognate::expr::functions::Continuity::{self, C0, C1, C2, Jump, Smooth};
use cognate::expr::interpolation::{Bindings, Spline};
use cognate::expr::program::{Input, Work};
use cognate::expr::smoothness::Smoothness;
use cognate::expr::spline::{Ends, Extrapolation, Piecewise};
use cognate::expr::walk::Host;
use cognate::scalar::{Germ, Jet, Scalar, Table};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
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
    assert_breaks(
        "INTERP(TIME,0,1)",
        Jump,
        &[(1.0, 0), (2.0, 0), (3.0, 0), (5.0, 0)],
    );
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
    assert_breaks("AINT(SIN(0.3*TIME))", Smooth, &[]);
    assert_breaks("ABS((TIME-1)**2)", Smooth, &[]);
    let many = of("SIGN(1,SIN(5*PI*TIME))");
    assert_eq!(many.breakpoints.len(), 99);
    let endless = of("MOD(TIME,1E-5)");
    assert!(!endless.complete && endless.class == Jump);
}

#[test]
fn values_that_touch_a_level_break_there_as_those_that_cross_it_do() {
    for at in [1.0, 0.7, -1.0 / 3.0, 2.123456789] {
        let t = format!("(TIME-({at:?}))");
        assert_breaks(&format!("SQRT({t}**2)"), C0, &[(at, 1)]);
        assert_breaks(&format!("({t}**2)**0.75"), C1, &[(at, 2)]);
        assert_breaks(&format!("({t}**2)**1.5"), C2, &[(at, 3)]);
        assert_breaks(&format!("1/{t}**2"), Jump, &[(at, 0)]);
        assert_breaks(&format!("LOG{t}"), Jump, &[(at, 0)]);
        assert_breaks(&format!("LOG10(2*{t})"), Jump, &[(at, 0)]);
        // what only comes near does not
        assert_breaks(&format!("SQRT({t}**2+1E-3)"), Smooth, &[]);
        assert_breaks(&format!("{t}**2"), Smooth, &[]);
    }
}

#[test]
fn rounding_that_leaves_a_domain_is_no_break_of_its_own() {
    let turns = |first: f64, n: i32| -> Vec<(f64, usize)> {
        (0..n)
            .map(|k| (first + f64::from(k) * std::f64::consts::PI, 1))
            .collect()
    };
    for (text, kinks) in [
        (
            "ACOS(COS(TIME-1))",
            turns(1.0 - 3.0 * std::f64::consts::PI, 6),
        ),
        ("ASIN(SIN(TIME))", turns(-2.5 * std::f64::consts::PI, 6)),
        ("SQRT(1-2*TIME+TIME**2)", vec![(1.0, 1)]),
    ] {
        let found = of(text);
        let got: Vec<(f64, usize)> = found.breakpoints.iter().map(|b| (b.at, b.order)).collect();
        let near = |(a, b): (&(f64, usize), &(f64, usize))| (a.0 - b.0).abs() < 1e-7 && a.1 == b.1;
        assert!(
            got.len() == kinks.len() && got.iter().zip(&kinks).all(near),
            "{text}: {got:?}, not {kinks:?}"
        );
    }
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

/// Texts of one variable, gentle enough for differences: kinks and jumps of all kinds, nested and combined.
fn gentle() -> impl Strategy<Value = String> {
    let number = (-20i32..20).prop_map(|k| format!("({})", f64::from(k) / 8.0));
    let line = (1i32..6, -12i32..12, any::<bool>()).prop_map(|(a, b, down)| {
        let sign = if down { "-" } else { "" };
        format!(
            "({sign}{}*TIME+({}))",
            f64::from(a) / 2.0,
            f64::from(b) / 7.0
        )
    });
    let leaf = prop_oneof![3 => line, 1 => number, 1 => Just("TIME".to_string())];
    leaf.prop_recursive(4, 24, 3, |inner| {
        let one = inner.clone().prop_flat_map(|x| {
            prop::sample::select(vec![
                "1.1*SIN(#)",
                "1.1*COS(#)",
                "ABS(#)",
                "MAX(#,0.3)",
                "MIN(#,1)",
                "DIM(#,0.5)",
                "SIGN(1,#)",
                "AINT(#)",
                "ANINT(#)",
                "MOD(#,1.5)",
                "STEP(#,-0.5,0,1,1)",
                "STEP5(#,0.25,1,1.5,2)",
                "HAVSIN(#,0,-1,2,1)",
                "ATAN(#)",
                "EXP(SIN(#))",
                "IMPACT(#,-1,0.5,2,1.5,1,0.25)",
                "BISTOP(#,1,-1,1,2,1.2,0.5,0.5)",
                "CUBSPL(#,0,1,0)",
                "AKISPL(#,0,1,0)",
                "INTERP(#,1,1)",
                "INTERP(#,0,1)",
                "POLY(#,0.5,1,-0.5,0.25)",
                "CHEBY(SIN(#),0,1,2,0.4)",
                "FORCOS(#,0,1,1,0.5,0.25)",
                "IF(#:-1,0,1)",
                "IF(#-0.7:#,0.7,1.4-(#))",
                "SWEEP(#,1.1,0.5,0.3,1.5,0.6,0.4)",
                "ABS(#)**2.5",
                "(#)**2",
                "SQRT(1+(#)**2)",
            ])
            .prop_map(move |form| form.replace('#', &x))
        });
        let two = (inner.clone(), inner, 0..4usize).prop_map(|(a, b, op)| match op {
            0 => format!("({a}+{b})"),
            1 => format!("({a}-{b})"),
            2 => format!("1.1*SIN({a})*COS({b})"),
            _ => format!("MAX({a},{b})"),
        });
        prop_oneof![3 => one, 2 => two]
    })
}

proptest! {
    // always the same texts: where a function touches a level to fourth order, differences drown in rounding
    #![proptest_config(ProptestConfig { cases: 250, failure_persistence: None, rng_seed: RngSeed::Fixed(5), ..ProptestConfig::default() })]

    /// At every breakpoint differences see the jump that is told; between them value and slope are the integrals of slope and
    /// curvature, so that nothing jumps there.
    #[test]
    fn differences_see_the_breaks_that_are_told_and_no_others(text in gentle()) {
        let f = Expr::parse(&text).unwrap();
        let found = f.smoothness(&bindings(), -2.0..=2.0).unwrap();
        let program = f.compile(&bindings()).unwrap();
        let mut work = Work::default();
        let mut at = |t: f64| {
            let mut out = [Jet::constant(0.0)];
            let inputs = [Jet::variable(t)];
            program.eval(&inputs[..program.inputs().len()], &mut work, &mut out);
            (out[0].value, out[0].first, out[0].second)
        };
        prop_assert!(found.complete);
        for b in &found.breakpoints {
            // what jumps, just before and just after; the next derivative says how far it moves on the way
            let h = 1e-6;
            let mut seen_at = |h: f64| {
                let (before, after) = (at(b.at - h), at(b.at + h));
                [after.0 - before.0, after.1 - before.1, after.2 - before.2]
            };
            let (wide, narrow) = (seen_at(h), seen_at(h / 1e3));
            for k in 0..=b.order.min(2) {
                let seen = wide[k];
                let told = b.jump(k);
                if !told.is_finite() {
                    // where the argument only touches the end of a step, differences do not reach that far
                    prop_assert!(k == b.order, "{text}: at {} {told} and {seen}", b.at);
                    continue;
                }
                let next = [b.before[k + 1], b.after[k + 1]].map(f64::abs);
                let size = b.before[k].abs().max(b.after[k].abs()).max(1.0);
                let off = (seen - told).abs();
                if next[0].is_finite() && next[1].is_finite() {
                    let steep = next[0].max(next[1]) * h;
                    prop_assert!(off < 4.0 * steep + 1e-5 * size, "{text}: at {} order {k}: {told}, seen {seen}", b.at);
                } else {
                    // `p**1.2` has a slope that goes to zero like `p**0.2`
                    let closer = (narrow[k] - told).abs();
                    prop_assert!(closer < 0.6 * off + 1e-6 * size, "{text}: at {} order {k}: {told}, seen {seen}, closer {}", b.at, narrow[k]);
                }
            }
        }
        let cells = 800;
        let width = 4.0 / f64::from(cells);
        for k in 0..cells {
            let (a, b) = (-2.0 + width * f64::from(k), -2.0 + width * f64::from(k + 1));
            // breaks at the ends spoil derivatives there
            if found.breakpoints.iter().any(|p| a - 1e-9 < p.at && p.at < b + 1e-9) || k == 0 || k == cells - 1 {
                continue;
            }
            let samples: Vec<_> = (0..=8).map(|j| at(a + width * f64::from(j) / 8.0)).collect();
            // the rule of Boole over eight intervals
            let weights = [7.0, 32.0, 12.0, 32.0, 14.0, 32.0, 12.0, 32.0, 7.0];
            let integral = |part: fn(&(f64, f64, f64)) -> f64| {
                samples.iter().zip(weights).map(|(s, w)| part(s) * w).sum::<f64>() * width / 8.0 * 2.0 / 45.0
            };
            let (value, slope) = (integral(|s| s.1), integral(|s| s.2));
            let bend = samples.iter().map(|s| s.1.abs() + s.2.abs()).fold(1.0, f64::max);
            let jumps = [samples[8].0 - samples[0].0 - value, samples[8].1 - samples[0].1 - slope];
            prop_assert!(jumps[0].abs() < 1e-7 * bend, "{text}: the value jumps by {} in {a}..{b}: {found:?}", jumps[0]);
            prop_assert!(jumps[1].abs() < 1e-4 * bend, "{text}: the slope jumps by {} in {a}..{b}: {found:?}", jumps[1]);
        }
    }

    /// One-sided derivatives from germs are those of differences of the walker.
    #[test]
    fn just_beside_any_point_the_germ_is_what_differences_see(text in gentle(), t in -2.0..2.0) {
        let f = Expr::parse(&text).unwrap();
        let value = |t: f64| f.eval_with(&At(t, bindings())).unwrap();
        let program = f.compile(&bindings()).unwrap();
        let mut out = [Germ::constant(0.0)];
        let inputs = [Germ::line(t, 1.0)];
        program.eval(&inputs[..program.inputs().len()], &mut Work::default(), &mut out);
        let h = 1e-4;
        let d = |k| out[0].derivative_at(k).0;
        prop_assert!((d(0) - value(t)).abs() < 1e-9 * (1.0 + d(0).abs()));
        // without a break on the way, what is left of the Taylor series is small
        let found = f.smoothness(&bindings(), t - h..=t + 2.0 * h).unwrap();
        if found.breakpoints.is_empty() {
            let taylor = d(0) + h * (d(1) + h / 2.0 * (d(2) + h / 3.0 * d(3)));
            let size = 1.0 + (0..5).map(|k| d(k).abs()).sum::<f64>();
            prop_assert!((value(t + h) - taylor).abs() < 1e-11 * size, "{text} at {t}: {taylor}, {}", value(t + h));
        }
    }
}

struct At(f64, Bindings);

impl Host for At {
    fn input(&self, input: Input) -> Option<f64> {
        (input == Input::Time).then_some(self.0)
    }
    fn bindings(&self) -> Option<&Bindings> {
        Some(&self.1)
    }
}

#[test]
fn steps_hold_each_value_until_the_next_point_and_lines_have_corners_where_they_bend() {
    let (x, y) = ([-1.0, 0.5, 2.0], [3.0, -4.0, 7.0]);
    let steps = Piecewise::steps(&x, &y).unwrap();
    for (at, value) in [
        (-9.0, 3.0),
        (-1.0, 3.0),
        (0.5f64.next_down(), 3.0),
        (0.5, -4.0),
        (2.0f64.next_down(), -4.0),
        (2.0, 7.0),
        (1e9, 7.0),
    ] {
        assert_eq!((steps.at(at, 0), steps.at(at, 1)), (value, 0.0), "{at}");
    }
    assert_eq!(
        (steps.beside(2.0, false, 0), steps.beside(2.0, true, 0)),
        (-4.0, 7.0)
    );
    assert!(steps.at(f64::NAN, 0).is_nan());
    assert!(Piecewise::steps(&x[..1], &y[..1]).is_err());

    // noise has corners, a sine that is drawn finely has none that a step must heed
    let lines = |n: i32, f: &dyn Fn(i32) -> f64| {
        let x: Vec<f64> = (0..n).map(|k| f64::from(k) / f64::from(n)).collect();
        Piecewise::linear(&x, &(0..n).map(f).collect::<Vec<f64>>()).unwrap()
    };
    let sine = |n: i32| lines(n, &|k| (6.0 * f64::from(k) / f64::from(n)).sin());
    assert!(
        steps.is_sharp() && sine(100).is_sharp() && lines(900, &|k| f64::from(k % 7)).is_sharp()
    );
    assert!(!sine(20_000).is_sharp() && !lines(900, &|k| 3.0 * f64::from(k)).is_sharp());
    assert!(!lines(900, &|_| 1.0).is_sharp());
    let smooth = Piecewise::akima(&x, &y, Extrapolation::Linear).unwrap();
    assert!(!smooth.is_sharp());
}
