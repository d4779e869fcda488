//! TABLE of functions that look data up by identifier: AKISPL, CUBSPL, INTERP, CURVE, INVPSD.

use super::ast::Dialect;
use super::functions::{Continuity, Parameter, ParameterKind};
use ParameterKind::{Integer, Number, OneOf};
use std::ops::RangeInclusive;

/// Identifiers that may be given.
const ID: ParameterKind = Integer(1, u32::MAX);

/// Generates the enum and the rows from the table.
macro_rules! interpolations {
    ($(
        $(#[doc = $doc:literal])+
        $variant:ident $name:literal ($($arg:ident: $kind:expr),+ $(; $optional:ident: $optional_kind:expr)?) $continuity:ident $equation:literal
    )+) => {
        /// A function over data.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Interpolation {
            $($(#[doc = $doc])+ $variant,)+
        }

        impl Interpolation {
            /// All of them, in the order of the table.
            pub const ALL: &'static [Interpolation] = &[$(Interpolation::$variant,)+];

            /// What the table says about this function.
            pub fn row(self) -> &'static InterpolationRow {
                static ROWS: &[InterpolationRow] = &[$(InterpolationRow {
                    interpolation: Interpolation::$variant,
                    name: $name,
                    parameters: &[
                        $(Parameter { name: stringify!($arg), kind: $kind, optional: false },)+
                        $(Parameter { name: stringify!($optional), kind: $optional_kind, optional: true },)?
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

/// What the table says about one function over data.
#[derive(Clone, Copy, Debug)]
pub struct InterpolationRow {
    /// the function itself
    pub interpolation: Interpolation,
    /// name as users write it
    pub name: &'static str,
    /// its parameters; `ParameterKind` tells which are literals
    pub parameters: &'static [Parameter],
    /// how smooth the function is in its first argument
    pub continuity: Continuity,
    /// sentence that says what it is, then remarks
    pub doc: &'static str,
    /// equation, in plain text
    pub equation: &'static str,
}

interpolations! {
    /// Akima spline through the points of spline `id`, or its derivative of order `iord`.
    ///
    /// `z` selects between the curves of a family (linearly); 0 for a single curve, the only kind that takes an order.
    Akispl "AKISPL" (x: Number, z: Number, id: ID; iord: Integer(0, 2)) C1
    "cubics with slopes weighted by the neighbouring changes of slope (Akima 1970)"

    /// Cubic spline through the points of spline `id`, or its derivative of order `iord`.
    ///
    /// `z` selects between the curves of a family (linearly); 0 for a single curve, the only kind that takes an order.
    Cubspl "CUBSPL" (x: Number, z: Number, id: ID; iord: Integer(0, 2)) C2
    "cubics with continuous curvature, zero at the ends"

    /// Time series: linear (method 1) or cubic (method 3) interpolation of spline `id`, or its derivative of order `iord`.
    Interp "INTERP" (x: Number, method: OneOf(&[1, 3]), id: ID; iord: Integer(0, 2)) C0
    "straight lines, or the curve of CUBSPL"

    /// Component (1 x, 2 y, 3 z) of curve `id` at parameter `alpha`, or its derivative of order `iord`.
    Curve "CURVE" (alpha: Number, iord: Integer(0, 2), comp: Integer(1, 3), id: ID) C2
    "cubic B-spline through the points of the curve, alpha from -1 to 1"

    /// Random signal whose power spectral density is spline `id`, between the frequencies f0 and f1.
    ///
    /// The same seed gives the same signal. All arguments but x must be constant.
    Invpsd "INVPSD" (x: Number, id: ID, f0: Number, f1: Number, nf: Number, linlog: OneOf(&[0, 1]), seed: Number) Smooth
    "sum sqrt(2 PSD(f_i) df_i) sin(2 pi f_i x + phi_i) over nf frequencies"
}

impl Interpolation {
    /// The function of this name in this language; AKIMA is another name of AKISPL.
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
    /// Name as users write it.
    pub fn name(self) -> &'static str {
        self.row().name
    }
    /// How many arguments may be written.
    pub fn arity(self) -> RangeInclusive<usize> {
        let parameters = self.row().parameters;
        parameters.iter().filter(|p| !p.optional).count()..=parameters.len()
    }
    /// What the `k`-th argument may be (`k` from 0).
    pub fn parameter_kind(self, k: usize) -> ParameterKind {
        self.row().parameters.get(k).map_or(Number, |p| p.kind)
    }
    /// The signature as help shows it.
    pub fn signature(self) -> String {
        let names: Vec<String> = self
            .row()
            .parameters
            .iter()
            .enumerate()
            .map(|(k, p)| match (k, p.optional) {
                (0, _) => p.name.to_string(),
                (_, false) => format!(", {}", p.name),
                (_, true) => format!("[, {}]", p.name),
            })
            .collect();
        format!("{}({})", self.name(), names.concat())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_say_how_they_are_written() {
        assert_eq!(
            Interpolation::Akispl.signature(),
            "AKISPL(x, z, id[, iord])"
        );
        assert_eq!(Interpolation::Akispl.arity(), 3..=4);
        assert_eq!(Interpolation::Curve.arity(), 4..=4);
        assert_eq!(Interpolation::Curve.parameter_kind(2), Integer(1, 3));
        assert_eq!(
            Interpolation::from_name("akima", Dialect::Function),
            Some(Interpolation::Akispl)
        );
        assert_eq!(
            Interpolation::from_name("akispl", Dialect::Expression),
            None
        );
    }
}
