//! What the functions of the language promise whatever their arguments are: bounds, signs, monotony, symmetry, linearity.
//!
//! Every law runs on the compiled program of a text with random literals, which is the code that hosts run, at random places,
//! exact break points among them.

use cognate::expr::Expr;
use cognate::expr::interpolation::Bindings;
use cognate::expr::program::{Input, Program, Work};
use cognate::scalar::{Jet, Scalar};
use proptest::prelude::*;

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 200,
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// A number as an argument; signs in parentheses are not needed there.
fn n(x: f64) -> String {
    format!("{x:?}")
}

fn list(numbers: &[f64]) -> String {
    numbers.iter().map(|&x| n(x)).collect::<Vec<_>>().join(",")
}

/// A function of TIME, compiled.
struct Curve(Program);

impl Curve {
    fn new(text: &str) -> Self {
        let expr = Expr::parse(text).unwrap_or_else(|e| panic!("{text}: {e}"));
        Self(
            expr.compile(&Bindings::default())
                .unwrap_or_else(|e| panic!("{text}: {e}")),
        )
    }
    fn at(&self, x: f64) -> f64 {
        // what was folded to a constant reads nothing
        let inputs = &[x][..self.0.inputs().len()];
        let mut out = [f64::NAN];
        self.0.run(inputs, &mut Default::default(), &mut out);
        out[0]
    }
}

fn value(text: &str) -> f64 {
    Curve::new(text).at(0.0)
}

/// Places from some lengths before the first to some after the last of these, the given ones and their neighbours among them.
fn places(marks: &[f64], parts: &[f64]) -> Vec<f64> {
    let (least, most) = marks
        .iter()
        .fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
    let length = most - least;
    let mut all: Vec<f64> = parts
        .iter()
        .map(|p| least + (3.0 * p - 1.0) * length)
        .collect();
    all.extend(marks.iter().flat_map(|&x| [x.next_down(), x, x.next_up()]));
    all.sort_by(f64::total_cmp);
    all
}

fn parts() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(0.0..1.0, 20)
}

/// A few roundings of numbers of this size.
fn rounding(size: f64) -> f64 {
    4.0 * f64::EPSILON * size
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn steps_stay_between_their_levels_and_never_turn_back(
        x0 in -10.0..10.0, length in 1e-3..20.0, h0 in -5.0..5.0, h1 in -5.0..5.0, parts in parts(),
    ) {
        let x1 = x0 + length;
        for name in ["STEP", "STEP5", "HAVSIN"] {
            let f = Curve::new(&format!("{name}(TIME,{})", list(&[x0, h0, x1, h1])));
            // h0 + (h1 − h0) s rounds three times, and s of the quintic is 10 − 15 + 6 near the upper end
            let slack = 8.0 * rounding(h0.abs() + h1.abs());
            let (low, high) = (h0.min(h1) - slack, h0.max(h1) + slack);
            let up = if h1 < h0 { -1.0 } else { 1.0 };
            let mut before = h0;
            for x in places(&[x0, x1], &parts) {
                let y = f.at(x);
                prop_assert!(low <= y && y <= high, "{name} at {x}: {y}");
                prop_assert!(up * (y - before) >= -slack, "{name} at {x}: {y} after {before}");
                if x <= x0 { prop_assert_eq!(y, h0, "{} at {}", name, x) }
                if x1 <= x { prop_assert_eq!(y, h1, "{} at {}", name, x) }
                before = y;
            }
        }
    }

    /// s(u) + s(1 − u) = 1
    #[test]
    fn steps_are_symmetric_about_their_middle(
        x0 in -10.0..10.0, length in 0.1..20.0, h0 in -5.0..5.0, h1 in -5.0..5.0, u in 0.0..1.0,
    ) {
        let x1 = x0 + length;
        for name in ["STEP", "STEP5", "HAVSIN"] {
            let f = Curve::new(&format!("{name}(TIME,{})", list(&[x0, h0, x1, h1])));
            let sum = f.at(x0 + u * length) + f.at(x1 - u * length);
            // places are off by a rounding of themselves, times a slope of at most 1.875 (h1 − h0)/length
            let slack = 8.0 * rounding(h0.abs() + h1.abs()) * (1.0 + 2.0 * (x0.abs() + x1.abs()) / length);
            prop_assert!((sum - (h0 + h1)).abs() <= slack, "{name}: {sum}, {}", h0 + h1);
        }
    }

    #[test]
    fn impact_never_pulls_and_is_what_its_formula_says_clipped_at_zero(
        x1 in -2.0..2.0, k in 0.0..1e5, e in 0.3..3.5, c in 0.0..500.0, d in 1e-3..1.0, v in -20.0..20.0, parts in parts(),
    ) {
        let law = list(&[x1, k, e, c, d]);
        let f = Curve::new(&format!("IMPACT(TIME,{},{law})", n(v)));
        let damping = Curve::new(&format!("STEP(TIME,{},{},{},0)", n(x1 - d), n(c), n(x1)));
        for x in places(&[x1 - d, x1], &parts) {
            let y = f.at(x);
            prop_assert!(y >= 0.0, "it pulls at {x}: {y}");
            if x1 <= x {
                prop_assert_eq!(y, 0.0, "outside at {}", x);
                continue;
            }
            let elastic = k * (x1 - x).powf(e);
            let plain = elastic - damping.at(x) * v;
            // the depth of a STEP is that of IMPACT but for the rounding of x1 − d
            let slack = 1e-12 * (elastic + c * v.abs()) + 6.0 * c * v.abs() * rounding(2.0 + d) / d;
            prop_assert!((y - plain.max(0.0)).abs() <= slack, "at {x}: {y}, {plain}");
        }
    }

    #[test]
    fn contacts_at_rest_push_harder_the_deeper_they_are(
        x1 in -2.0..2.0, gap in 0.01..3.0, k in 0.0..1e5, e in 0.3..3.5, c in 0.0..500.0, d in 1e-3..1.0, parts in parts(),
    ) {
        let x2 = x1 + gap;
        let law = list(&[k, e, c, d]);
        let impact = Curve::new(&format!("IMPACT(TIME,0,{},{law})", n(x1)));
        let stops = Curve::new(&format!("BISTOP(TIME,0,{},{},{law})", n(x1), n(x2)));
        let (mut before, mut between) = (f64::INFINITY, f64::INFINITY);
        for x in places(&[x1, x2], &parts) {
            let (y, z) = (impact.at(x), stops.at(x));
            // falls with x: from pushing up at x1 through nothing to pushing down at x2
            prop_assert!(y <= before * (1.0 + 1e-14), "IMPACT at {x}: {y} after {before}");
            prop_assert!(z <= between + 1e-14 * z.abs().max(between.abs()), "BISTOP at {x}: {z} after {between}");
            (before, between) = (y, z);
        }
    }

    #[test]
    fn stops_push_inwards_and_do_nothing_between(
        x1 in -2.0..2.0, gap in 0.01..3.0, k in 0.0..1e5, e in 0.3..3.5, c in 0.0..500.0, d in 1e-3..1.0, v in -20.0..20.0,
        parts in parts(),
    ) {
        let x2 = x1 + gap;
        let law = list(&[k, e, c, d]);
        let f = Curve::new(&format!("BISTOP(TIME,{},{},{},{law})", n(v), n(x1), n(x2)));
        let mirrored = Curve::new(&format!("BISTOP(-TIME,{},{},{},{law})", n(-v), n(-x2), n(-x1)));
        let lower = Curve::new(&format!("IMPACT(TIME,{},{},{law})", n(v), n(x1)));
        for x in places(&[x1, x2], &parts) {
            let y = f.at(x);
            if x < x1 {
                prop_assert!(y >= 0.0, "lower stop at {x}: {y}");
                prop_assert_eq!(y, lower.at(x), "IMPACT at {}", x);
            } else if x <= x2 {
                prop_assert_eq!(y, 0.0, "between at {}", x);
            } else {
                prop_assert!(y <= 0.0, "upper stop at {x}: {y}");
            }
            prop_assert_eq!(y, -mirrored.at(x), "mirrored at {}", x);
        }
    }

    #[test]
    fn approaching_pushes_no_less_than_resting_and_leaving_no_more(
        k in 0.0..1e5, e in 0.3..3.5, c in 0.0..500.0, d in 1e-3..1.0, p in 0.0..2.0f64, v in 0.0..20.0f64,
    ) {
        let at = |v: f64| value(&format!("IMPACT({},{},{})", n(-p), n(v), list(&[0.0, k, e, c, d])));
        let (approaching, rest, leaving) = (at(-v), at(0.0), at(v));
        prop_assert!(approaching >= rest && rest >= leaving, "{approaching}, {rest}, {leaving}");
    }

    #[test]
    fn series_are_linear_in_their_coefficients(
        a in prop::collection::vec(-3.0..3.0f64, 31), b in prop::collection::vec(-3.0..3.0f64, 31), count in 1usize..=31,
        (s, t) in (-2.0..2.0f64, -2.0..2.0f64), x in -1.0..1.0f64, x0 in -0.5..0.5f64, w in -4.0..4.0,
    ) {
        let (a, b) = (&a[..count], &b[..count]);
        let sum: Vec<f64> = a.iter().zip(b).map(|(a, b)| s * a + t * b).collect();
        let size: f64 = a.iter().zip(b).map(|(a, b)| (s * a).abs() + (t * b).abs()).sum();
        for head in [format!("POLY({},{}", n(x), n(x0)), format!("CHEBY({},{}", n(x), n(x0)),
                     format!("FORCOS({},{},{}", n(x), n(x0), n(w)), format!("FORSIN({},{},{}", n(x), n(x0), n(w))] {
            let f = |c: &[f64]| value(&format!("{head},{})", list(c)));
            // the largest term: powers and Chebyshev polynomials of y with |y| ≤ 1.5
            let y = (x - x0).abs().max(1.0);
            let largest = match &head[..4] {
                "POLY" => y.powi(count as i32 - 1),
                "CHEB" => (y + (y * y - 1.0).sqrt()).powi(count as i32 - 1),
                _ => 1.0,
            };
            let (got, want) = (f(&sum), s * f(a) + t * f(b));
            let slack = 31.0 * rounding(size * largest);
            prop_assert!((got - want).abs() <= slack, "{head}: {got}, {want}, {slack:e}");
        }
    }

    #[test]
    fn series_have_the_values_they_must_have(a in prop::collection::vec(-3.0..3.0f64, 1..=31), x0 in -5.0..5.0f64, turn in 0.0..6.0f64) {
        let c = list(&a);
        let size: f64 = a.iter().map(|a| a.abs()).sum();
        let close = |got: f64, want: f64| (got - want).abs() <= 31.0 * rounding(size) * (1.0 + x0.abs());
        // at the shift
        prop_assert_eq!(value(&format!("POLY({x0:?},{x0:?},{c})")), a[0]);
        prop_assert_eq!(value(&format!("FORSIN({x0:?},{x0:?},3,{c})")), a[0]);
        let sum = value(&format!("FORCOS({x0:?},{x0:?},3,{c})"));
        prop_assert!(close(sum, a.iter().sum()), "{sum}");
        // T_j(1) = 1, and T_j(cos θ) = cos jθ, of which each is between −1 and 1
        let sum = value(&format!("CHEBY(1,0,{c})"));
        prop_assert!(close(sum, a.iter().sum()), "{sum}");
        let series = value(&format!("CHEBY(COS({turn:?}),0,{c})"));
        let harmonic = value(&format!("FORCOS({turn:?},0,1,{c})"));
        // T_j' = j² at the ends of [−1, 1] magnifies the rounding of the cosine
        prop_assert!((series - harmonic).abs() <= 1000.0 * rounding(size), "{series}, {harmonic}");
        prop_assert!(series.abs() <= size * (1.0 + 1e-12));
    }

    #[test]
    fn an_if_is_the_branch_it_says_and_the_others_are_not_evaluated(
        s in prop_oneof![-2.0..2.0f64, Just(0.0), Just(-0.0)], x in 0.1..3.0f64,
    ) {
        // each branch has a value only where it is taken, but for the middle one
        let f = Curve::new(&format!("IF(TIME: SQRT(-TIME)*{0}, {0}, LOG(TIME)+{0})", n(x)));
        let want = match s {
            s if s < 0.0 => (-s).sqrt() * x,
            s if s > 0.0 => s.ln() + x,
            _ => x,
        };
        prop_assert_eq!(f.at(s), want);
        // and it is so inside selector and branches of others
        let g = Curve::new("IF(IF(TIME: 1, 0, -1): IF(TIME-1: 10, 20, 30), 40, IF(TIME+1: 50, 60, 70))");
        let want = if s > 0.0 { if s < 1.0 { 10.0 } else if s > 1.0 { 30.0 } else { 20.0 } }
            else if s < 0.0 { if s < -1.0 { 50.0 } else if s > -1.0 { 70.0 } else { 60.0 } } else { 40.0 };
        prop_assert_eq!(g.at(s), want);
    }

    #[test]
    fn a_sweep_stays_within_its_amplitude_and_is_silent_before_it_fades_in(
        a in -5.0..5.0, x0 in -2.0..2.0, f0 in 0.0..5.0, length in 0.1..5.0, f1 in 0.0..9.0, dx in 1e-3..1.0, parts in parts(),
    ) {
        let f = Curve::new(&format!("SWEEP(TIME,{})", list(&[a, x0, f0, x0 + length, f1, dx])));
        for x in places(&[x0, x0 + length], &parts) {
            let y = f.at(x);
            prop_assert!(y.abs() <= a.abs() * (1.0 + 1e-14), "at {x}: {y}");
            if x <= 0.0 { prop_assert_eq!(y, 0.0, "at {}", x) }
        }
    }

    #[test]
    fn the_intrinsics_keep_the_laws_of_fortran(a in -50.0..50.0f64, b in prop_oneof![-50.0..-0.01f64, 0.01..50.0f64]) {
        let of = |name: &str| value(&format!("{name}({},{})", n(a), n(b)));
        let one = |name: &str| value(&format!("{name}({})", n(a)));
        let remainder = of("MOD");
        prop_assert!(remainder.abs() < b.abs() && remainder * a >= 0.0, "{remainder}");
        let quotient = (a - remainder) / b;
        prop_assert!((quotient - quotient.round()).abs() <= rounding(quotient.abs() + 1.0));
        prop_assert_eq!(of("MAX") + of("MIN"), a + b);
        prop_assert_eq!(of("DIM"), of("MAX") - b);
        prop_assert_eq!(of("SIGN").abs(), one("ABS"));
        prop_assert!(of("SIGN") * b >= 0.0);
        prop_assert!((one("AINT") - a).abs() < 1.0 && one("AINT").abs() <= a.abs());
        prop_assert!((one("ANINT") - a).abs() <= 0.5);
        prop_assert_eq!(one("NINT"), one("ANINT"));
        let angle = of("ATAN2");
        prop_assert!(angle.abs() <= std::f64::consts::PI);
        let (s, c) = angle.sin_cos();
        let length = f64::hypot(a, b);
        prop_assert!((length * s - a).abs() <= rounding(length) && (length * c - b).abs() <= rounding(length));
    }
}

/// Exactly at a break the first of two equal numbers counts, and nothing else.
#[test]
fn ties_and_zeros_go_where_the_reference_sends_them() {
    for (text, want) in [
        ("SIGN(3,0)", 3.0),
        ("SIGN(3,-0.0)", 3.0),
        ("ATAN2(-0.0,-1)", std::f64::consts::PI),
        ("IF(-0.0: 1, 2, 3)", 2.0),
        ("DIM(4,4)", 0.0),
        ("0**0", 1.0),
        ("ANINT(-2.5)", -3.0),
        ("ANINT(0.49999999999999994)", 0.0),
    ] {
        assert_eq!(value(text), want, "{text}");
    }
}

/// Value, first and second derivative over time, and the partial derivative by one sweep from the value back.
fn rates(text: &str, time: f64) -> ([f64; 3], f64) {
    let program = Curve::new(text).0;
    let mut jet = [Jet::constant(f64::NAN)];
    program.eval(&[Jet::variable(time)], &mut Work::default(), &mut jet);
    let mut out = [f64::NAN; 2];
    let swept = program.with_gradient(&[Input::Time]);
    swept.run(&[time], &mut Work::default(), &mut out);
    ([jet[0].value, jet[0].first, jet[0].second], out[1])
}

/// `b aᵇ⁻¹` is finite at a = 0 where b ≥ 1; that `a**2.5` is computed as `a*a*SQRT(a)` must not show.
#[test]
fn powers_have_their_derivatives_at_zero() {
    for (text, first, second) in [
        ("TIME**1.5", 0.0, f64::INFINITY),
        ("TIME**2.5", 0.0, 0.0),
        ("TIME**3.5", 0.0, 0.0),
        ("TIME**4.5", 0.0, 0.0),
        ("TIME**1.7", 0.0, f64::INFINITY),
        ("TIME**2.2", 0.0, 0.0),
        ("TIME*SQRT(TIME)", 0.0, f64::INFINITY),
        ("3*TIME**2.5+TIME", 1.0, 0.0),
        ("TIME**2", 0.0, 2.0),
        ("TIME**1", 1.0, 0.0),
        ("TIME**0", 0.0, 0.0),
        ("(2*TIME)**3", 0.0, 0.0),
    ] {
        let (jet, swept) = rates(text, 0.0);
        assert_eq!((jet[1], jet[2], swept), (first, second, first), "{text}");
        // and nearby they are what the rule says
        if let Some(b) = text
            .strip_prefix("TIME**")
            .and_then(|b| b.parse::<f64>().ok())
        {
            let (jet, swept) = rates(text, 0.3);
            let want = [
                0.3f64.powf(b),
                b * 0.3f64.powf(b - 1.0),
                b * (b - 1.0) * 0.3f64.powf(b - 2.0),
            ];
            for (got, want) in jet
                .into_iter()
                .chain([swept])
                .zip(want.into_iter().chain([want[1]]))
            {
                assert!(
                    (got - want).abs() <= 4.0 * f64::EPSILON * want.abs(),
                    "{text}: {got}, {want}"
                );
            }
        }
    }
}
