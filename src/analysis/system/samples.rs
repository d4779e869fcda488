//! Sampled systems: the discrete states of a GSE, which change at their samples and hold in
//! between.
//!
//! ```text
//! at the sample tₖ:   d ← dₖ,   dₖ₊₁ = f(x, u, dₖ) at tₖ   (waits for the next sample)
//!                     tₖ₊₁ = tₖ + SAMPLE_PERIOD
//! ```
//!
//! The first sample is the first instant of the first simulation, where d is as ICD says. A sample
//! ends a step, so that no step leads over one, and the method begins anew where the states have
//! changed. Several systems that are sampled at one instant see each other's states of before it.

use super::closures::Law;
use super::recording::Recording;
use crate::diagnostic::Diagnostic;
use crate::model::ElementId;
use crate::scene::Scene;
use crate::scene::configuration::Configured;
use crate::scene::equations::Unsupported;
use crate::scene::external_inputs::ExternalInput;
use crate::scene::layout::Layout;
use crate::scene::programs::record;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;
use std::ops::Range;

/// Distance of samples that count as one, as a part of a period.
const SAME_SAMPLE: f64 = 1e-9;

/// The present state of a sampled system, and the next one.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// the states now
    pub states: Vec<f64>,
    /// the states from the next sample on
    pub next: Vec<f64>,
    /// time of the next sample; infinite: never
    pub due: f64,
}

#[derive(Clone, Debug)]
struct Sampled {
    id: ElementId,
    /// places of the states, and of the results that they become next, in the row of numbers
    states: Range<usize>,
    results: Range<usize>,
    period: Recording,
    next: Vec<f64>,
    due: f64,
    /// length of the period that is under way
    length: f64,
    /// the state in which the simulation began
    begun: Option<Held>,
}

impl Sampled {
    fn is_due(&self, t: f64) -> bool {
        t >= self.due - SAME_SAMPLE * self.length
    }
}

/// The sampled systems of a scene.
#[derive(Clone, Debug, Default)]
pub struct Samples {
    all: Vec<Sampled>,
}

impl Samples {
    /// Records the sampled systems of a scene.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub fn new(scene: Configured<'_>) -> Result<Self, Vec<Unsupported>> {
        let l = scene.layout;
        let mut all = Vec::new();
        for s in &scene.samplers {
            all.push(Sampled {
                id: s.id,
                states: l.externals_at(s.states, s.n),
                results: l.externals_at(s.results, s.n),
                period: Recording::new(record(scene, |at| vec![at.formula(s.period)])?),
                next: vec![0.0; s.n],
                due: f64::INFINITY,
                length: 0.0,
                begun: None,
            });
        }
        Ok(Self { all })
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Returns the time of the next sample.
    pub fn due(&self) -> f64 {
        self.all.iter().fold(f64::INFINITY, |t, s| t.min(s.due))
    }

    /// Returns the state of each system, by the number of its GSE.
    pub fn held(&self, numbers: &[f64]) -> BTreeMap<u32, Held> {
        let one = |s: &Sampled| {
            let held = Held {
                states: numbers[s.states.clone()].to_vec(),
                next: s.next.clone(),
                due: s.due,
            };
            (s.id.number, held)
        };
        self.all.iter().map(one).collect()
    }
}

/// Returns a discrete state before the first step: as the last simulation left it, else as the
/// dataset says; `None` for other numbers.
pub fn before(scene: &Scene, supplied: ExternalInput, held: &BTreeMap<u32, Held>) -> Option<f64> {
    let ExternalInput::Sample(sampler, k) = supplied else {
        return None;
    };
    let s = scene.samplers.get(sampler)?;
    let kept = held.get(&s.id.number).filter(|h| h.states.len() == s.n);
    kept.map_or(s.initial.get(k), |h| h.states.get(k)).copied()
}

impl Samples {
    /// Goes on as the last simulation left the samples, or takes the first ones here.
    ///
    /// # Errors
    /// A period that is not positive.
    pub(super) fn begin(
        &mut self,
        numbers: &mut [f64],
        held: &BTreeMap<u32, Held>,
    ) -> Result<(), Diagnostic> {
        let t = numbers[Layout::TIME];
        for s in &mut self.all {
            let length = s.period.run(numbers)[0];
            if !(length > 0.0 && length.is_finite()) {
                let what =
                    format!("its SAMPLE_PERIOD is {length}, which is no time between samples");
                return Err(Diagnostic::error("unfit_value", what).element(s.id));
            }
            let kept = held
                .get(&s.id.number)
                .filter(|h| h.next.len() == s.next.len());
            let begun = kept.cloned().unwrap_or_else(|| Held {
                states: numbers[s.states.clone()].to_vec(),
                next: numbers[s.results.clone()].to_vec(),
                due: t + length,
            });
            s.length = length;
            s.begun = Some(begun);
        }
        self.restart(numbers);
        Ok(())
    }

    /// Goes on from the samples of the same systems, recorded for other rows.
    pub(super) fn carry_on(&mut self, before: Self) {
        for (s, before) in self.all.iter_mut().zip(before.all) {
            (s.next, s.begun) = (before.next, before.begun);
            (s.due, s.length) = (before.due, before.length);
        }
    }

    /// Sets the samples back to where the simulation begins.
    pub(super) fn restart(&mut self, numbers: &mut [f64]) {
        for s in &mut self.all {
            if let Some(begun) = &s.begun {
                s.next.clone_from(&begun.next);
                s.due = begun.due;
                numbers[s.states.clone()].copy_from_slice(&begun.states);
            }
        }
    }

    /// Returns whether a sample is due at this instant.
    pub fn is_due(&self, t: f64) -> bool {
        self.all.iter().any(|s| s.is_due(t))
    }

    /// Returns whether two instants are one beside the times between samples: an output time and a
    /// sample that were rounded apart.
    pub fn is_together(&self, a: f64, b: f64) -> bool {
        let shortest = (self.all.iter()).fold(f64::INFINITY, |h, s| h.min(s.length));
        (a - b).abs() <= SAME_SAMPLE * shortest
    }

    /// Returns the systems whose samples are due at an instant.
    pub(super) fn due_at(&self, t: f64) -> Vec<usize> {
        (0..self.all.len())
            .filter(|&k| self.all[k].is_due(t))
            .collect()
    }

    /// Puts the states that were prepared into the numbers; returns whether one has changed.
    pub(super) fn take(&self, due: &[usize], numbers: &mut [f64]) -> bool {
        let mut changed = false;
        for &k in due {
            let s = &self.all[k];
            let states = &mut numbers[s.states.clone()];
            changed |= *states != s.next[..];
            states.copy_from_slice(&s.next);
        }
        changed
    }

    /// Prepares the next states, and the times at which they are taken.
    pub(super) fn prepare_next(&mut self, due: &[usize], numbers: &[f64]) {
        for &k in due {
            let s = &mut self.all[k];
            let length = s.period.run(numbers)[0];
            s.next.copy_from_slice(&numbers[s.results.clone()]);
            // a period that is not positive was the last
            s.length = length;
            s.due = if length > 0.0 {
                s.due + length
            } else {
                f64::INFINITY
            };
        }
    }
}

/// A linear system as a closure for a GSE.
///
/// ```text
/// continuous   ẋ = A x + B u            y = C x + D u        NS = rows of A, ND = 0
/// sampled      dₖ₊₁ = A dₖ + B uₖ        y = C d + D u        NS = 0, ND = rows of A
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LinearSystem {
    /// (n × n)
    pub a: DMatrix<f64>,
    /// (n × m)
    pub b: DMatrix<f64>,
    /// (p × n)
    pub c: DMatrix<f64>,
    /// (p × m)
    pub d: DMatrix<f64>,
}

impl LinearSystem {
    /// Builds a system of n states, m inputs, p outputs from its matrices, row after row; `None`
    /// where their sizes do not fit.
    pub fn new([n, m, p]: [usize; 3], a: &[f64], b: &[f64], c: &[f64], d: &[f64]) -> Option<Self> {
        let fits = a.len() == n * n && b.len() == n * m && c.len() == p * n && d.len() == p * m;
        fits.then(|| Self {
            a: DMatrix::from_row_slice(n, n, a),
            b: DMatrix::from_row_slice(n, m, b),
            c: DMatrix::from_row_slice(p, n, c),
            d: DMatrix::from_row_slice(p, m, d),
        })
    }

    /// Returns the change (or rate) of the states, and the outputs; `None` where the GSE has other
    /// numbers of states or inputs.
    fn applied(&self, states: &[f64], inputs: &[f64]) -> Option<(DVector<f64>, DVector<f64>)> {
        if states.len() != self.a.nrows() || inputs.len() != self.b.ncols() {
            return None;
        }
        let (x, u) = (
            DVector::from_column_slice(states),
            DVector::from_column_slice(inputs),
        );
        Some((&self.a * &x + &self.b * &u, &self.c * &x + &self.d * &u))
    }

    /// Returns the closure of a GSE with NS states. Where its sizes do not fit the results are NaN.
    pub fn continuous(self) -> Box<Law> {
        let n = self.a.nrows();
        Box::new(move |call, out| {
            let Some((x, u)) = call.values.split_at_checked(n) else {
                return out.fill(f64::NAN);
            };
            match self.applied(x, u) {
                Some((rates, y)) if out.len() == n + y.len() => {
                    out[..n].copy_from_slice(rates.as_slice());
                    out[n..].copy_from_slice(y.as_slice());
                }
                _ => out.fill(f64::NAN),
            }
        })
    }

    /// Returns the closure of a GSE with ND discrete states. Where its sizes do not fit the results
    /// are NaN.
    pub fn sampled(self) -> Box<Law> {
        let n = self.a.nrows();
        Box::new(move |call, out| {
            let m = call.values.len().saturating_sub(n);
            let (u, d) = call.values.split_at(m);
            match self.applied(d, u) {
                Some((next, y)) if out.len() == n + y.len() => {
                    let p = y.len();
                    out[..p].copy_from_slice(y.as_slice());
                    out[p..].copy_from_slice(next.as_slice());
                }
                _ => out.fill(f64::NAN),
            }
        })
    }
}
