//! The TABLE of functions that look data up by identifier: AKISPL, CUBSPL, INTERP, CURVE, INVPSD.
//!
//! `data.rs` holds the splines and curves that they read, `computed.rs` curves of code that is no
//! formula, `bindings.rs` finds them for a call.

mod bindings;
pub(crate) mod computed;
mod data;

pub use bindings::{Bindings, Bound};
pub use data::{CLOSING_TOLERANCE, Curve, CurvePoints, Spline, Surface};

use super::ast::Dialect;
use super::functions::Continuity;
use super::signature::{self, Argument, Choice, Element, Kind};
use Kind::Number;
use std::ops::RangeInclusive;

/// The identifier of a spline.
const SPLINE_ID: Kind = identifier(Element::Spline);
/// The identifier of a curve.
const CURVE_ID: Kind = identifier(Element::Curve);
/// The order of a derivative.
const DERIVATIVE: Kind = Kind::Selector(Choice::Range(0, 2));

const fn identifier(element: Element) -> Kind {
    Kind::Identifier {
        element,
        zero: false,
    }
}

const fn one_of(list: &'static [u32]) -> Kind {
    Kind::Selector(Choice::OneOf(list))
}

/// Generates the enum and the rows from the table.
macro_rules! interpolations {
    ($(
        $(#[doc = $doc:literal])+
        $variant:ident $name:literal (
            $($arg:ident: $kind:expr => $meaning:literal),+
            $(; $optional:ident: $optional_kind:expr => $optional_meaning:literal)?
        ) $continuity:ident $equation:literal
    )+) => {
        /// A function over data.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Interpolation {
            $($(#[doc = $doc])+ $variant,)+
        }

        impl Interpolation {
            /// All functions over data, in the order of the table.
            pub const ALL: &'static [Interpolation] = &[$(Interpolation::$variant,)+];

            /// Returns the row of this function in the table.
            pub fn row(self) -> &'static InterpolationRow {
                static ROWS: &[InterpolationRow] = &[$(InterpolationRow {
                    interpolation: Interpolation::$variant,
                    name: $name,
                    parameters: &[
                        $(Argument { name: stringify!($arg), kind: $kind, default: None, meaning: $meaning },)+
                        $(Argument {
                            name: stringify!($optional),
                            kind: $optional_kind,
                            default: Some("0"),
                            meaning: $optional_meaning,
                        },)?
                    ],
                    continuity: Continuity::$continuity,
                    doc: concat!($($doc, "\n"),+),
                    equation: $equation,
                },)+];
                &ROWS[self as usize]
            }
        }
    };
}

/// A row of the table of functions over data.
#[derive(Clone, Copy, Debug)]
pub struct InterpolationRow {
    /// the function itself
    pub interpolation: Interpolation,
    /// name as users write it
    pub name: &'static str,
    /// its arguments
    pub parameters: &'static [Argument],
    /// smoothness of the function in its first argument
    pub continuity: Continuity,
    /// one sentence that describes it, then remarks
    pub doc: &'static str,
    /// equation, in plain text
    pub equation: &'static str,
}

interpolations! {
    /// Akima spline through the points of spline `id`, or its derivative of order `iord`.
    ///
    /// `z` selects between the curves of a family (linearly); 0 for a single curve, the only kind
    /// that takes an order.
    Akispl "AKISPL" (x: Number => "place at which the curve is read", z: Number => "curve of a family; 0 for a single one", id: SPLINE_ID => "data"; iord: DERIVATIVE => "order of the derivative over x") C1
    "cubics with slopes weighted by the neighbouring changes of slope (Akima 1970)"

    /// Cubic spline through the points of spline `id`, or its derivative of order `iord`.
    ///
    /// `z` selects between the curves of a family (linearly); 0 for a single curve, the only kind
    /// that takes an order.
    Cubspl "CUBSPL" (x: Number => "place at which the curve is read", z: Number => "curve of a family; 0 for a single one", id: SPLINE_ID => "data"; iord: DERIVATIVE => "order of the derivative over x") C2
    "cubics with continuous curvature, zero at the ends"

    /// Time series: linear (method 1) or cubic (method 3) interpolation of spline `id`, or its
    /// derivative of order `iord`.
    ///
    /// Method 0, which other programs do not have, holds each value until the next point.
    Interp "INTERP" (x: Number => "place at which the curve is read", method: one_of(&[0, 1, 3]) => "0 steps, 1 straight lines, 3 cubics", id: SPLINE_ID => "data"; iord: DERIVATIVE => "order of the derivative over x") C0
    "steps, straight lines, or the curve of CUBSPL"

    /// Component (1 x, 2 y, 3 z) of curve `id` at parameter `alpha`, or its derivative of order
    /// `iord`.
    Curve "CURVE" (
        alpha: Number => "place on the curve, -1 at its beginning, 1 at its end",
        iord: DERIVATIVE => "order of the derivative over alpha",
        comp: Kind::Selector(Choice::Range(1, 3)) => "1 x, 2 y, 3 z",
        id: CURVE_ID => "curve"
    ) C2
    "cubic B-spline through the points of the curve, alpha from -1 to 1"

    /// Random signal whose power spectral density is spline `id`, between the frequencies f0 and
    /// f1.
    ///
    /// The same seed gives the same signal. All arguments but x must be constant.
    Invpsd "INVPSD" (
        x: Number => "argument, often TIME",
        id: SPLINE_ID => "density over frequency",
        f0: Number => "lowest frequency, cycles for each unit of x",
        f1: Number => "highest frequency",
        nf: Number => "number of frequencies",
        linlog: one_of(&[0, 1]) => "0 linear, 1 logarithmic interpolation of the density",
        seed: Number => "number from which the phases are drawn"
    ) Smooth
    "sum sqrt(2 PSD(f_i) df_i) sin(2 pi f_i x + phi_i) over nf frequencies"
}

impl Interpolation {
    /// Finds the function of this name in this language; AKIMA is another name of AKISPL.
    pub fn from_name(name: &str, dialect: Dialect) -> Option<Interpolation> {
        if dialect == Dialect::Expression {
            return None;
        }
        if name.eq_ignore_ascii_case("AKIMA") {
            return Some(Interpolation::Akispl);
        }
        Self::ALL
            .iter()
            .copied()
            .find(|f| f.name().eq_ignore_ascii_case(name))
    }
    /// Returns the name as users write it.
    pub fn name(self) -> &'static str {
        self.row().name
    }
    /// Returns the fewest and the most arguments.
    pub fn arity(self) -> RangeInclusive<usize> {
        let (least, most) = signature::arity(self.row().parameters);
        least..=most
    }
    /// Prints the signature as help shows it.
    pub fn signature(self) -> String {
        signature::signature(self.name(), self.row().parameters)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::spline::{Ends, Extrapolation};
    use crate::scalar::{Dual, Jet, Scalar};
    use approx::assert_relative_eq;
    use std::collections::BTreeMap;
    use std::f64::consts::TAU;
    use std::sync::Arc;

    fn family() -> Bindings {
        let x = vec![0.0, 1.0, 2.0, 3.0];
        let y = vec![
            vec![0.0, 1.0, 2.0, 3.0],
            vec![5.0, 7.0, 6.0, 5.0],
            vec![-1.0, 0.0, 4.0, 9.0],
        ];
        let z = vec![0.0, 10.0, 40.0];
        let (ends, outside) = (Ends::Natural, Extrapolation::Parabolic);
        let single = Spline::new(x.clone(), vec![], vec![y[1].clone()], ends, outside).unwrap();
        let spline = Spline::new(x, z, y, ends, outside).unwrap();
        let circle: Vec<[f64; 3]> = (0..=16)
            .map(|k| {
                let (s, c) = (TAU * f64::from(k % 16) / 16.0).sin_cos();
                [c, s, 1.0]
            })
            .collect();
        let circle = Curve::new(&circle, true, 4, CurvePoints::OnCurve).unwrap();
        Bindings {
            splines: [(1, Arc::new(spline)), (2, Arc::new(single))].into(),
            curves: [(8, Arc::new(circle))].into(),
        }
    }

    #[test]
    fn rows_say_how_they_are_written() {
        assert_eq!(
            Interpolation::Akispl.signature(),
            "AKISPL(x, z, id[, iord])"
        );
        assert_eq!(Interpolation::Akispl.arity(), 3..=4);
        assert_eq!(Interpolation::Curve.arity(), 4..=4);
        assert_eq!(
            Interpolation::from_name("akima", Dialect::Function),
            Some(Interpolation::Akispl)
        );
        assert_eq!(
            Interpolation::from_name("akispl", Dialect::Expression),
            None
        );
    }

    #[test]
    fn families_run_linearly_between_their_curves() {
        let bound = family()
            .bind(Interpolation::Akispl, &[f64::NAN, f64::NAN, 1.0])
            .unwrap();
        for (x, z, want) in [(1.5, 10.0, 6.5), (1.5, 5.0, 4.0), (2.0, -5.0, 0.0)] {
            assert_relative_eq!(bound.eval(&[x, z]), want, epsilon = 1e-12);
        }
        // the slope in z is that of the two neighbouring curves
        let dual = bound.eval(&[Dual::<2>::variable(1.5, 0), Dual::variable(5.0, 1)]);
        assert_relative_eq!(dual.eps[1], (6.5 - 1.5) / 10.0, epsilon = 1e-12);
    }

    #[test]
    fn orders_and_jets_agree() {
        let data = family();
        let at = |order: f64| {
            data.bind(Interpolation::Cubspl, &[f64::NAN, 0.0, 2.0, order])
                .unwrap()
        };
        let jet = at(0.0).eval(&[Jet::variable(1.3), Jet::constant(0.0)]);
        assert_eq!(jet.value, at(0.0).eval(&[1.3, 0.0]));
        assert_eq!(jet.first, at(1.0).eval(&[1.3, 0.0]));
        assert_eq!(jet.second, at(2.0).eval(&[1.3, 0.0]));
        assert_eq!(
            data.bind(Interpolation::Cubspl, &[f64::NAN, 0.0, 1.0, 1.0])
                .unwrap_err()
                .code,
            "out_of_range"
        );
        assert_eq!(
            data.bind(Interpolation::Cubspl, &[f64::NAN, 0.0, 3.0])
                .unwrap_err()
                .code,
            "unknown_element"
        );
    }

    #[test]
    fn a_closed_curve_through_a_circle_is_nearly_one() {
        let data = family();
        let at = |order: f64, component: f64, alpha: f64| {
            data.bind(Interpolation::Curve, &[f64::NAN, order, component, 8.0])
                .unwrap()
                .eval(&[alpha])
        };
        for k in 0..50 {
            let alpha = -1.0 + f64::from(k) / 25.0;
            let (x, y, z) = (
                at(0.0, 1.0, alpha),
                at(0.0, 2.0, alpha),
                at(0.0, 3.0, alpha),
            );
            assert_relative_eq!(x.hypot(y), 1.0, epsilon = 1e-4);
            assert_relative_eq!(z, 1.0);
            let speed = at(1.0, 1.0, alpha).hypot(at(1.0, 2.0, alpha));
            assert_relative_eq!(speed, std::f64::consts::PI, epsilon = 1e-2);
        }
        assert!(at(0.0, 1.0, 1.001).is_nan());
        assert!(at(0.0, 1.0, 1.0).is_finite());
    }

    #[test]
    fn signals_have_the_power_of_their_spectrum() {
        let x = vec![1.0, 5.0, 10.0, 20.0];
        let y = vec![vec![0.5; 4]];
        let spline = Spline::new(x, vec![], y, Ends::Natural, Extrapolation::Parabolic).unwrap();
        let data = Bindings {
            splines: [(3, Arc::new(spline))].into(),
            curves: BTreeMap::new(),
        };
        let bind = |seed: f64| {
            data.bind(
                Interpolation::Invpsd,
                &[f64::NAN, 3.0, 2.0, 12.0, 50.0, 0.0, seed],
            )
            .unwrap()
        };
        let (a, again, other) = (bind(7.0), bind(7.2), bind(8.0));
        assert_eq!(a.eval(&[0.3]), again.eval(&[0.3]));
        assert_ne!(a.eval(&[0.3]), other.eval(&[0.3]));
        // mean square over one common period (5 s: bands of 0.2 cycles per unit, centred on odd
        // multiples of 0.1)
        let n = 20_000;
        let mean: f64 = (0..n)
            .map(|k| a.eval(&[10.0 * f64::from(k) / f64::from(n)]).powi(2))
            .sum::<f64>()
            / f64::from(n);
        assert_relative_eq!(mean, 0.5 * 10.0, max_relative = 1e-9);
        let jet = a.eval(&[Jet::variable(0.4)]);
        let h = 1e-5;
        assert_relative_eq!(
            jet.first,
            (a.eval(&[0.4 + h]) - a.eval(&[0.4 - h])) / (2.0 * h),
            max_relative = 1e-5
        );
        assert!(
            data.bind(Interpolation::Invpsd, &[0.0, 3.0, 2.0, 1.0, 50.0, 0.0, 1.0])
                .is_err()
        );
        assert!(
            data.bind(
                Interpolation::Invpsd,
                &[0.0, 3.0, 2.0, 12.0, f64::NAN, 0.0, 1.0]
            )
            .is_err()
        );
        assert!(
            data.bind(
                Interpolation::Invpsd,
                &[0.0, 3.0, 2.0, 12.0, 1e12, 0.0, 1.0]
            )
            .is_err()
        );
    }
}
