//! The splines and curves of an expression by number, and the calls that read them.
//!
//! [`Bindings::bind`] turns a call into a [`Bound`], which has its curve and evaluates over any
//! number; walker and compiler both use it. INVPSD becomes a sum of sines ([`Signal`]).

use super::{Curve, Interpolation, Spline, Surface};
use crate::diagnostic::{Cause, Diagnostic};
use crate::expr::spline::Piecewise;
use crate::random::Random;
use crate::scalar::{Scalar, Table};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Most frequencies of INVPSD.
const MOST_WAVES: f64 = 100_000.0;

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
                let surface = match whole(1) {
                    0 => spline.steps(),
                    1 => spline.linear(),
                    _ => spline.cubic(),
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
                .map(|v| if logarithmic { Scalar::ln(*v) } else { *v })
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
                Scalar::exp(density.at(Scalar::ln(f), 0))
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

fn unknown<'a>(kind: &str, id: u32, known: impl Iterator<Item = &'a u32>) -> Diagnostic {
    let known: Vec<String> = known.take(8).map(u32::to_string).collect();
    let advice = match known.len() {
        0 => format!("no {kind} is given"),
        _ => format!("there are: {}", known.join(", ")),
    };
    Diagnostic::error(Cause::UnknownElement, format!("there is no {kind} {id}")).help(advice)
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
        let mut random = Random(seed as u64);
        let waves = (0..n)
            .map(|k| {
                let f = f0 + (k as f64 + 0.5) * width;
                (
                    TAU * f,
                    (2.0 * density(f) * width).sqrt(),
                    TAU * random.unit(),
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
                a * Scalar::sin(w * x + phase + quarter_turns)
            })
            .sum()
    }
}
