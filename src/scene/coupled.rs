//! COUPLER by a routine: a constraint of displacements that is known by calls alone.
//!
//! Programs need a formula. At every instant this is the expansion of second degree about the
//! displacements x₀ of that instant, time among them:
//!
//! ```text
//! φ(x) = φ₀ + Σ gₖ dₖ + ½ ΣΣ Hₖₗ dₖ dₗ,   d = x − x₀                            (1)
//! ```
//!
//! d is zero whenever (1) is evaluated, so that its value is exact, and so are its first two
//! derivatives along anything that moves. φ₀, g, H and x₀ come from outside, as results of a
//! closure; where numbers are plain (assembly) the routine is asked on the spot.
//!
//! Partial derivatives that a routine does not give are found by differences of fourth order.

use super::Displacement;
use super::external_inputs::{Call, Law};
use crate::expr::interpolation::computed;
use crate::model::ElementId;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// Numbers of a constraint of `n` displacements: its value, its first partial derivatives, and the
/// second, row by row from the diagonal on. A closure leaves NaN where it does not give one.
#[derive(Clone, Copy, Debug)]
pub struct Partials(pub usize);

impl Partials {
    /// Returns how many numbers there are.
    pub fn count(self) -> usize {
        1 + self.0 + self.0 * (self.0 + 1) / 2
    }

    /// Returns the place of a first partial derivative.
    pub fn first(self, k: usize) -> usize {
        1 + k
    }

    /// Returns the place of a second one.
    pub fn second(self, k: usize, l: usize) -> usize {
        let (k, l) = (k.min(l), k.max(l));
        1 + self.0 + k * self.0 - k * (k + 1) / 2 + l
    }
}

/// A constraint of displacements that a closure computes.
#[derive(Clone)]
pub struct Coupled {
    /// the COUPLER
    pub element: ElementId,
    /// the numbers of USER
    pub constants: Vec<f64>,
    /// what it relates
    pub displacements: Vec<Displacement>,
    /// what counts as one, per displacement
    pub units: Vec<f64>,
    /// places of the numbers of [`Coupled::expand`] among those from outside
    pub places: Range<usize>,
    /// what counts as one of its value
    pub scale: f64,
    /// computes its value
    pub law: Arc<Law>,
}

impl fmt::Debug for Coupled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Coupled({}, {:?})", self.element, self.displacements)
    }
}

impl Coupled {
    /// Returns how many variables the expansion has: displacements, and time.
    pub fn n(&self) -> usize {
        self.displacements.len() + 1
    }

    /// Returns the partial derivatives along the variables.
    pub fn partials(&self) -> Partials {
        Partials(self.n())
    }

    /// Returns how many numbers [`Coupled::expand`] fills in.
    pub fn numbers(&self) -> usize {
        self.n() + self.partials().count()
    }

    /// Calls the closure at displacements and time.
    fn call(&self, x: &[f64]) -> Vec<f64> {
        let (time, values) = x.split_last().unwrap_or((&0.0, &[]));
        let mut out = vec![f64::NAN; Partials(values.len()).count()];
        let call = Call {
            time: *time,
            element: self.element,
            constants: &self.constants,
            values,
        };
        (self.law)(&call, &mut out);
        out
    }

    /// Fills in the variables, the value there, and its partial derivatives along them.
    pub fn expand(&self, x: &[f64], out: &mut [f64]) {
        let n = self.n();
        let (place, rest) = out.split_at_mut(n);
        place.copy_from_slice(x);
        let (all, given) = (self.partials(), Partials(n - 1));
        let here = self.call(x);
        rest[0] = here[0];
        for k in 0..n {
            let known = (k < n - 1).then(|| here[given.first(k)]);
            rest[all.first(k)] = known
                .filter(|g| !g.is_nan())
                .unwrap_or_else(|| self.slope(x, k, 0));
        }
        for k in 0..n {
            for l in k..n {
                let known = (l < n - 1).then(|| here[given.second(k, l)]);
                // of a first derivative that is given, else of the value
                let slope = (k < n - 1 && !here[given.first(k)].is_nan()).then(|| given.first(k));
                rest[all.second(k, l)] = match (known.filter(|h| !h.is_nan()), slope) {
                    (Some(h), _) => h,
                    (None, Some(slope)) => self.slope(x, l, slope),
                    (None, None) => self.curvature(x, k, l),
                };
            }
        }
    }

    fn step(&self, k: usize) -> f64 {
        computed::STEP * self.units.get(k).copied().unwrap_or(1.0)
    }

    /// Returns one of the closure's numbers at displacements and time that are moved along some.
    fn moved(&self, x: &[f64], along: [(usize, f64); 2], number: usize) -> f64 {
        let mut moved = x.to_vec();
        along.iter().for_each(|&(k, by)| moved[k] += by);
        self.call(&moved)[number]
    }

    /// Returns the derivative of one of the closure's numbers along a variable.
    fn slope(&self, x: &[f64], k: usize, number: usize) -> f64 {
        let at = |by: f64| self.moved(x, [(k, by), (k, 0.0)], number);
        computed::slope(&at, self.step(k))
    }

    /// Returns the second derivative of the value along two variables.
    fn curvature(&self, x: &[f64], k: usize, l: usize) -> f64 {
        // wider, as rounding is divided by the square
        let [h, g] = [k, l].map(|k| 10.0 * self.step(k));
        if k == l {
            return computed::curvature(&|by| self.moved(x, [(k, by), (k, 0.0)], 0), h);
        }
        let slope = |to: f64| computed::slope(&|by| self.moved(x, [(k, by), (l, to)], 0), h);
        computed::slope(&slope, g)
    }

    /// Returns a partial derivative that the closure gives and that differences contradict: along
    /// which displacements, what it gives and what they find.
    pub fn contradicted(&self, x: &[f64]) -> Option<(Vec<usize>, [f64; 2])> {
        let m = self.n() - 1;
        let (given, here) = (Partials(m), self.call(x));
        let first = (0..m).map(|k| (vec![k], given.first(k), self.slope(x, k, 0)));
        let pairs = (0..m).flat_map(|k| (k..m).map(move |l| (k, l)));
        let second = pairs.map(|(k, l)| {
            let found = self.curvature(x, k, l);
            (vec![k, l], given.second(k, l), found)
        });
        let all: Vec<_> = first.chain(second).collect();
        let per = |along: &[usize]| along.iter().map(|&k| self.units[k]).product::<f64>();
        let sizes = all.iter().map(|(along, _, found)| found.abs() * per(along));
        let size = sizes.fold(f64::MIN_POSITIVE, f64::max);
        all.into_iter().find_map(|(along, place, found)| {
            let told = here[place];
            let off = (told - found).abs() * per(&along);
            (off > computed::DISAGREEMENT * size).then_some((along, [told, found]))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::ElementKind;
    use crate::physics::coupler::Gauge;
    use crate::scalar::Scalar;

    fn coupled(law: impl Fn(&Call<'_>, &mut [f64]) + Send + Sync + 'static) -> Coupled {
        let displacement = Displacement {
            gauge: Gauge::Distance,
            i: 0,
            j: 0,
            coordinates: None,
        };
        Coupled {
            element: ElementKind::Coupler.id(1),
            constants: Vec::new(),
            displacements: vec![displacement.clone(), displacement],
            units: vec![1.0; 2],
            places: 0..0,
            scale: 1.0,
            law: Arc::new(law),
        }
    }

    #[test]
    fn partial_derivatives_are_those_of_the_function() {
        let value = |x: &[f64], t: f64| x[0] * x[0] * x[1] + Scalar::sin(x[1]) + t * x[0];
        let (x, t) = ([0.7, -0.4], 0.3);
        let exact = [
            value(&x, t),
            2.0 * x[0] * x[1] + t,
            x[0] * x[0] + Scalar::cos(x[1]),
            x[0],
            2.0 * x[1],
            2.0 * x[0],
            1.0,
            -Scalar::sin(x[1]),
            0.0,
            0.0,
        ];
        let found = |gives: bool| {
            let this = coupled(move |call, out| {
                let (x, t) = (call.values, call.time);
                out[0] = value(x, t);
                if gives {
                    out[1] = 2.0 * x[0] * x[1] + t;
                    out[2] = x[0] * x[0] + Scalar::cos(x[1]);
                }
            });
            let mut out = vec![0.0; this.numbers()];
            this.expand(&[x[0], x[1], t], &mut out);
            assert_eq!(this.contradicted(&[x[0], x[1], t]), None);
            out[3..].to_vec()
        };
        for (gives, tolerance) in [(false, 1e-9), (true, 1e-10)] {
            for (a, b) in found(gives).iter().zip(exact) {
                assert!((a - b).abs() < tolerance, "{gives} {a} {b}");
            }
        }
    }

    #[test]
    fn a_partial_derivative_that_is_wrong_is_found() {
        let this = coupled(|call, out| {
            out[0] = call.values[0] * call.values[1];
            out[1] = call.values[1];
            out[2] = 2.0 * call.values[0];
        });
        let (along, [told, found]) = this.contradicted(&[0.5, 0.25, 0.0]).expect("it is");
        assert_eq!((along, told), (vec![1], 1.0));
        assert!((found - 0.5).abs() < 1e-10);
    }
}
