//! TABLE of functions that look data up by identifier: AKISPL, CUBSPL, INTERP, CURVE, INVPSD; and
//! the data they read.
//!
//! [`Bindings`] holds the splines and curves by number. [`Bindings::bind`] turns a call into a
//! [`Bound`], which has its curve and evaluates over any number; walker and compiler both use it.

use super::ast::Dialect;
use super::functions::Continuity;
use super::signature::{self, Argument, Choice, Element, Kind};
use super::spline::{Ends, Extrapolation, Piecewise, UnfitData, check};
use crate::diagnostic::Diagnostic;
use crate::scalar::{Scalar, Table};
use Kind::Number;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::ops::RangeInclusive;
use std::sync::{Arc, OnceLock};

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
    Interp "INTERP" (x: Number => "place at which the curve is read", method: one_of(&[1, 3]) => "1 straight lines, 3 cubics", id: SPLINE_ID => "data"; iord: DERIVATIVE => "order of the derivative over x") C0
    "straight lines, or the curve of CUBSPL"

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

/// The data of a spline: one curve, or a family of curves over z.
///
/// ```
/// use cognate::expr::interpolation::Spline;
/// use cognate::expr::spline::{Ends, Extrapolation};
/// let y = vec![vec![0.0, 2.0, 1.0, 3.0]];
/// let x = vec![1.0, 2.0, 3.0, 4.0];
/// let spline = Spline::new(x, vec![], y, Ends::Natural, Extrapolation::Parabolic)?;
/// assert_eq!(spline.cubic().at(1.25, 0.0, 0), 0.734375);
/// # Ok::<(), cognate::expr::spline::UnfitData>(())
/// ```
#[derive(Debug)]
pub struct Spline {
    /// abscissae, increasing   (n)
    x: Vec<f64>,
    /// parameters of a family of curves, increasing; empty for a single curve
    z: Vec<f64>,
    /// values of each curve   (curves × n)
    y: Vec<Vec<f64>>,
    ends: Ends,
    extrapolation: Extrapolation,
    /// Akima's curve, once it has been fitted
    akima: OnceLock<Arc<Surface>>,
    /// cubic spline, once it has been fitted
    cubic: OnceLock<Arc<Surface>>,
    /// straight lines, once they have been fitted
    linear: OnceLock<Arc<Surface>>,
}

impl Spline {
    /// Creates it from x (at least 4, increasing), z (empty for a single curve, else increasing)
    /// and the values of each curve.
    ///
    /// # Errors
    ///
    /// When the counts differ, points do not increase, something is not a number, or the ends do
    /// not fit the data.
    pub fn new(
        x: Vec<f64>,
        z: Vec<f64>,
        y: Vec<Vec<f64>>,
        ends: Ends,
        extrapolation: Extrapolation,
    ) -> Result<Self, UnfitData> {
        if y.len() != z.len().max(1) {
            return Err(UnfitData(format!(
                "{} curves for {} values of z",
                y.len(),
                z.len()
            )));
        }
        if z.iter().any(|z| !z.is_finite()) || z.windows(2).any(|w| w[0] >= w[1]) {
            return Err(UnfitData("z must increase".to_string()));
        }
        for curve in &y {
            check(&x, curve, 4)?;
            Piecewise::cubic(&x, curve, ends, extrapolation)?;
        }
        let (akima, cubic, linear) = Default::default();
        Ok(Self {
            x,
            z,
            y,
            ends,
            extrapolation,
            akima,
            cubic,
            linear,
        })
    }

    /// Returns whether it is a single curve.
    pub fn is_single(&self) -> bool {
        self.y.len() == 1
    }
    /// Returns local cubics with Akima's slopes, fitted at the first call.
    pub fn akima(&self) -> &Arc<Surface> {
        self.akima
            .get_or_init(|| self.fit(|y| Piecewise::akima(&self.x, y, self.extrapolation)))
    }
    /// Returns the cubic spline, fitted at the first call.
    pub fn cubic(&self) -> &Arc<Surface> {
        self.cubic.get_or_init(|| {
            self.fit(|y| Piecewise::cubic(&self.x, y, self.ends, self.extrapolation))
        })
    }
    /// Returns straight lines from point to point, fitted at the first call.
    pub fn linear(&self) -> &Arc<Surface> {
        self.linear
            .get_or_init(|| self.fit(|y| Piecewise::linear(&self.x, y)))
    }

    /// Fits each curve of the family.
    fn fit(&self, curve: impl Fn(&[f64]) -> Result<Piecewise, UnfitData>) -> Arc<Surface> {
        let curves = self
            .y
            .iter()
            .filter_map(|y| curve(y).ok())
            .map(|c| Arc::new(c) as Arc<dyn Table>)
            .collect();
        Arc::new(Surface {
            z: self.z.clone(),
            curves,
        })
    }
}

/// One curve, or curves between which values run linearly in z.
#[derive(Debug)]
pub struct Surface {
    /// parameters of the curves, increasing; empty for a single curve
    z: Vec<f64>,
    curves: Vec<Arc<dyn Table>>,
}

impl Surface {
    /// Returns the value, or a derivative with respect to x, at (x, z); beyond the first and last z
    /// the nearest two curves continue.
    pub fn at<S: Scalar>(&self, x: S, z: S, order: u32) -> S {
        if self.curves.len() == 1 {
            return x.lookup(&self.curves[0], order);
        }
        self.between(x, z, order, 0, self.curves.len() - 1)
    }

    /// Interpolates linearly in z between two neighbours of the curves `first` to `last`.
    fn between<S: Scalar>(&self, x: S, z: S, order: u32, first: usize, last: usize) -> S {
        if last - first > 1 {
            let middle = (first + last) / 2;
            return S::choose(
                z.lt(S::constant(self.z[middle])),
                || self.between(x, z, order, first, middle),
                || self.between(x, z, order, middle, last),
            );
        }
        let (low, high) = (
            x.lookup(&self.curves[first], order),
            x.lookup(&self.curves[last], order),
        );
        let w = (z - S::constant(self.z[first])).scale(1.0 / (self.z[last] - self.z[first]));
        low + (high - low) * w
    }
}

/// The meaning of the points of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurvePoints {
    /// the curve goes through them
    OnCurve,
    /// they are the control points of a B-spline
    Control,
}

/// A curve in space over a parameter from −1 to 1; outside it has no value.
///
/// A curve through its points is a cubic spline over the length of the polygon of the points,
/// natural or (closed) periodic.
#[derive(Debug)]
pub struct Curve {
    /// x, y and z over the parameter
    components: [Arc<dyn Table>; 3],
    /// whether it returns to its beginning
    closed: bool,
    /// parameters between which it is one polynomial
    knots: Vec<f64>,
}

impl Curve {
    /// Creates it from at least 4 points; a closed curve ends with its first point. `order` is that
    /// of the polynomials plus one.
    ///
    /// # Errors
    ///
    /// When there are too few points, neighbouring points coincide, a closed curve is not closed,
    /// or the order is unknown (through points: 2 or 4).
    pub fn new(
        points: &[[f64; 3]],
        closed: bool,
        order: usize,
        kind: CurvePoints,
    ) -> Result<Self, UnfitData> {
        let (Some(first), Some(last)) = (points.first(), points.last()) else {
            return Err(UnfitData("a curve without points".to_string()));
        };
        if points.len() < 4 {
            return Err(UnfitData(format!(
                "{} points, but at least 4 are needed",
                points.len()
            )));
        }
        if closed && first != last {
            return Err(UnfitData(
                "the last point of a closed curve must repeat the first".to_string(),
            ));
        }
        let mut lengths = vec![0.0];
        for pair in points.windows(2) {
            let chord = (0..3)
                .map(|k| (pair[1][k] - pair[0][k]).powi(2))
                .sum::<f64>()
                .sqrt();
            lengths.push(lengths[lengths.len() - 1] + chord);
        }
        let total = lengths[lengths.len() - 1];
        let mut alpha: Vec<f64> = lengths.iter().map(|l| 2.0 * l / total - 1.0).collect();
        if let Some(end) = alpha.last_mut() {
            *end = 1.0;
        }
        let component = |k: usize| -> Result<Piecewise, UnfitData> {
            let y: Vec<f64> = points.iter().map(|p| p[k]).collect();
            let ends = if closed {
                Ends::Periodic
            } else {
                Ends::Natural
            };
            Ok(match (kind, order) {
                (CurvePoints::Control, _) => Piecewise::b_spline(&y, order, closed, -1.0, 1.0)?,
                (CurvePoints::OnCurve, 4) => {
                    Piecewise::cubic(&alpha, &y, ends, Extrapolation::None)?
                }
                (CurvePoints::OnCurve, 2) => Piecewise::linear(&alpha, &y)?.without_extrapolation(),
                _ => {
                    return Err(UnfitData(format!(
                        "a curve of order {order} through points; use 2 or 4"
                    )));
                }
            })
        };
        let x = component(0)?;
        let knots = x.knots().to_vec();
        Ok(Self {
            components: [
                Arc::new(x),
                Arc::new(component(1)?),
                Arc::new(component(2)?),
            ],
            closed,
            knots,
        })
    }

    /// Returns the parameters, ascending from −1 to 1, between which it is one polynomial.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Returns x, y and z over the parameter.
    pub fn components(&self) -> &[Arc<dyn Table>; 3] {
        &self.components
    }
    /// Returns whether it returns to its beginning.
    pub fn is_closed(&self) -> bool {
        self.closed
    }
}

/// A sum of sines with pseudo-random phases and amplitudes from a spectrum.
#[derive(Debug)]
struct Signal {
    /// angular frequency, amplitude, phase
    waves: Vec<(f64, f64, f64)>,
}

impl Signal {
    /// Divides the range between two frequencies into `n` bands of equal width, each with the
    /// density of its middle.
    fn new(density: impl Fn(f64) -> f64, f0: f64, f1: f64, n: usize, seed: i64) -> Self {
        let width = (f1 - f0) / n as f64;
        let mut state = seed as u64;
        let waves = (0..n)
            .map(|k| {
                let f = f0 + (k as f64 + 0.5) * width;
                (
                    TAU * f,
                    (2.0 * density(f) * width).sqrt(),
                    TAU * uniform(&mut state),
                )
            })
            .collect();
        Self { waves }
    }
}

impl Table for Signal {
    fn at(&self, x: f64, order: u32) -> f64 {
        let quarter_turns = f64::from(order) * std::f64::consts::FRAC_PI_2;
        self.waves
            .iter()
            .map(|&(w, a, phase)| {
                let a = if order == 0 {
                    a
                } else {
                    a * Scalar::powi(w, order as i32)
                };
                a * (w * x + phase + quarter_turns).sin()
            })
            .sum()
    }
}

/// Returns the next of a sequence of numbers between 0 and 1 (SplitMix64).
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ z >> 31) >> 11) as f64 / (1u64 << 53) as f64
}

/// The splines and curves that an expression may name.
#[derive(Clone, Debug, Default)]
pub struct Bindings {
    /// splines by identifier
    pub splines: BTreeMap<u32, Arc<Spline>>,
    /// curves by identifier
    pub curves: BTreeMap<u32, Arc<Curve>>,
}

/// A call together with its data.
#[derive(Clone, Debug)]
pub enum Bound {
    /// a curve or a family of curves, and the order of the derivative
    Surface(Arc<Surface>, u32),
    /// a curve, and the order of the derivative
    Table(Arc<dyn Table>, u32),
}

impl Bound {
    /// Evaluates the call for its arguments as written; identifiers among them are ignored.
    pub fn eval<S: Scalar>(&self, args: &[S]) -> S {
        let Some(&x) = args.first() else {
            return S::constant(f64::NAN);
        };
        match self {
            Bound::Surface(surface, order) => {
                surface.at(x, args.get(1).copied().unwrap_or(x), *order)
            }
            Bound::Table(table, order) => x.lookup(table, *order),
        }
    }
}

impl Bindings {
    /// Finds the data of a call. `args` are the arguments as written: literals and other constants;
    /// NaN for the rest.
    ///
    /// # Errors
    ///
    /// `unknown_element` when there is no such spline or curve; `out_of_range` for an order on a
    /// family of curves and for arguments of INVPSD that are not constant or make no signal.
    pub fn bind(&self, function: Interpolation, args: &[f64]) -> Result<Bound, Diagnostic> {
        // the check has found the literals to be integers in their range; `as` saturates for the
        // rest
        let whole = |k: usize| args.get(k).map_or(0, |&x| x as u32);
        let order = |spline: &Spline, k: usize| match whole(k) {
            0 => Ok(0),
            _ if !spline.is_single() => Err(Diagnostic::error(
                "out_of_range",
                "the derivative of a family of curves is not defined",
            )
            .help("an order needs a spline with a single curve")),
            n @ 1..=2 => Ok(n),
            n => Err(Diagnostic::error(
                "out_of_range",
                format!("the order is 0, 1 or 2, not {n}"),
            )),
        };
        match function {
            Interpolation::Akispl => {
                let spline = self.spline(whole(2))?;
                Ok(Bound::Surface(spline.akima().clone(), order(spline, 3)?))
            }
            Interpolation::Cubspl => {
                let spline = self.spline(whole(2))?;
                Ok(Bound::Surface(spline.cubic().clone(), order(spline, 3)?))
            }
            Interpolation::Interp => {
                let spline = self.spline(whole(2))?;
                if !spline.is_single() {
                    return Err(Diagnostic::error(
                        "out_of_range",
                        "INTERP needs a spline with a single curve",
                    ));
                }
                let surface = if whole(1) == 1 {
                    spline.linear()
                } else {
                    spline.cubic()
                };
                Ok(Bound::Table(surface.curves[0].clone(), order(spline, 3)?))
            }
            Interpolation::Curve => {
                let id = whole(3);
                let curve = self
                    .curves
                    .get(&id)
                    .ok_or_else(|| unknown("curve", id, self.curves.keys()))?;
                match curve.components.get((whole(2) as usize).wrapping_sub(1)) {
                    Some(component) => Ok(Bound::Table(component.clone(), whole(1).min(2))),
                    None => Err(Diagnostic::error(
                        "out_of_range",
                        "the component is 1 (x), 2 (y) or 3 (z)",
                    )),
                }
            }
            Interpolation::Invpsd => self.signal(args),
        }
    }

    fn spline(&self, id: u32) -> Result<&Arc<Spline>, Diagnostic> {
        self.splines
            .get(&id)
            .ok_or_else(|| unknown("spline", id, self.splines.keys()))
    }

    /// Binds INVPSD(x, id, f0, f1, nf, linlog, seed).
    fn signal(&self, args: &[f64]) -> Result<Bound, Diagnostic> {
        let refuse = |message: &str| Err(Diagnostic::error("out_of_range", message));
        let &[_, id, f0, f1, nf, linlog, seed] = args else {
            return refuse("INVPSD takes seven arguments");
        };
        if [f0, f1, nf, seed].iter().any(|x| !x.is_finite()) {
            return refuse("f0, f1, nf and seed of INVPSD must be constant");
        }
        if f0 < 0.0 || f1 <= f0 {
            return refuse("the frequencies of INVPSD must satisfy 0 <= f0 < f1");
        }
        if !(2.0..=MOST_WAVES).contains(&nf.round()) {
            return refuse("the number of frequencies of INVPSD is 2 to 100000");
        }
        let spline = self.spline(id as u32)?;
        if !spline.is_single() {
            return refuse("the spectrum of INVPSD is a spline with a single curve");
        }
        let (x, y) = (&spline.x, &spline.y[0]);
        let logarithmic = linlog == 1.0;
        if y.iter().any(|&y| y < 0.0) || logarithmic && x.iter().chain(y).any(|&v| v <= 0.0) {
            return refuse(
                "a spectrum is not negative, and positive for logarithmic interpolation",
            );
        }
        let scale = |v: &Vec<f64>| {
            v.iter()
                .map(|v| if logarithmic { v.ln() } else { *v })
                .collect::<Vec<f64>>()
        };
        let density = match Piecewise::linear(&scale(x), &scale(y)) {
            Ok(density) => density,
            Err(reason) => return refuse(&reason.0),
        };
        let at = |f: f64| {
            // outside the data the end value holds
            let f = f.clamp(x[0], x[x.len() - 1]);
            if logarithmic {
                density.at(f.ln(), 0).exp()
            } else {
                density.at(f, 0).max(0.0)
            }
        };
        Ok(Bound::Table(
            Arc::new(Signal::new(
                at,
                f0,
                f1,
                nf.round() as usize,
                seed.round() as i64,
            )),
            0,
        ))
    }
}

/// Most frequencies of INVPSD.
const MOST_WAVES: f64 = 100_000.0;

fn unknown<'a>(kind: &str, id: u32, known: impl Iterator<Item = &'a u32>) -> Diagnostic {
    let known: Vec<String> = known.take(8).map(u32::to_string).collect();
    let advice = match known.len() {
        0 => format!("no {kind} is given"),
        _ => format!("there are: {}", known.join(", ")),
    };
    Diagnostic::error("unknown_element", format!("there is no {kind} {id}")).help(advice)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::{Dual, Jet};
    use approx::assert_relative_eq;

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
