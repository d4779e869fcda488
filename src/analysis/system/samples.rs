//! Sampled systems: the discrete states of a GSE, which change at their samples and hold in between.
//!
//! ```text
//! at the sample tₖ:   d ← dₖ,   dₖ₊₁ = f(x, u, dₖ) at tₖ      (waits for the next sample)      tₖ₊₁ = tₖ + SAMPLE_PERIOD
//! ```
//!
//! The first sample is the first instant of the first simulation, where d is what ICD says. A sample ends a step, so that no step leads over one, and
//! the method begins anew where the states have changed. Several systems that are sampled at one instant see each other's states of
//! before it.

use crate::analysis::system::System;
use crate::analysis::system::external_inputs::Law;
use crate::diagnostic::Diagnostic;
use crate::expr::program::{Program, Work};
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

/// Samples nearer to each other than this part of a period are one.
const TOGETHER: f64 = 1e-9;

/// Where a sampled system stands: its states, what they are next, and when.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// the states now
    pub states: Vec<f64>,
    /// the states from the next sample on
    pub next: Vec<f64>,
    /// when that is; infinite: never
    pub due: f64,
}

#[derive(Debug)]
struct Sampled {
    id: ElementId,
    /// places of the states, and of what computes them, in the row of numbers
    states: Range<usize>,
    results: Range<usize>,
    period: Program,
    next: Vec<f64>,
    due: f64,
    /// length of the period that is under way
    length: f64,
    /// where the simulation began
    begun: Option<Held>,
}

/// The sampled systems of a scene.
#[derive(Debug, Default)]
pub struct Samples {
    all: Vec<Sampled>,
    work: Work,
}

impl Samples {
    /// Of a scene.
    ///
    /// # Errors
    /// What the equations cannot supply.
    pub fn new(scene: Configured<'_>) -> Result<Self, Vec<Unsupported>> {
        let l = scene.layout;
        let mut all = Vec::new();
        for s in &scene.samplers {
            all.push(Sampled {
                id: s.id,
                states: l.external_at(s.states)..l.external_at(s.states + s.n),
                results: l.external_at(s.results)..l.external_at(s.results + s.n),
                period: record(scene, |at| vec![at.formula(s.period)])?,
                next: vec![0.0; s.n],
                due: f64::INFINITY,
                length: 0.0,
                begun: None,
            });
        }
        Ok(Self {
            all,
            work: Work::default(),
        })
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// When the next sample is.
    pub fn due(&self) -> f64 {
        self.all.iter().fold(f64::INFINITY, |t, s| t.min(s.due))
    }

    /// Where each system stands, by the number of its GSE.
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

/// What discrete states are before the first step: as the last simulation left them, else as the dataset says.
pub fn before(scene: &Scene, supplied: ExternalInput, held: &BTreeMap<u32, Held>) -> Option<f64> {
    let ExternalInput::Sample(sampler, k) = supplied else {
        return None;
    };
    let s = scene.samplers.get(sampler)?;
    let kept = held.get(&s.id.number).filter(|h| h.states.len() == s.n);
    kept.map_or(s.initial.get(k), |h| h.states.get(k)).copied()
}

impl System {
    /// Goes on as the last simulation left the samples, or takes the first ones here.
    ///
    /// # Errors
    /// A period that is none.
    pub fn begin_sampling(&mut self, held: &BTreeMap<u32, Held>) -> Result<(), Diagnostic> {
        let t = self.numbers[Layout::TIME];
        for k in 0..self.samples.all.len() {
            let Samples { all, work } = &mut self.samples;
            let s = &mut all[k];
            let mut out = [0.0];
            s.period.run(&self.numbers, work, &mut out);
            let length = out[0];
            if !(length > 0.0 && length.is_finite()) {
                let what =
                    format!("its SAMPLE_PERIOD is {length}, which is no time between samples");
                return Err(Diagnostic::error("unfit_value", what).element(s.id));
            }
            let kept = held
                .get(&s.id.number)
                .filter(|h| h.next.len() == s.next.len());
            let begun = kept.cloned().unwrap_or_else(|| Held {
                states: self.numbers[s.states.clone()].to_vec(),
                next: self.numbers[s.results.clone()].to_vec(),
                due: t + length,
            });
            s.length = length;
            s.begun = Some(begun);
        }
        self.restart_sampling();
        Ok(())
    }

    /// Sets the samples back to where the simulation begins.
    pub fn restart_sampling(&mut self) {
        for s in &mut self.samples.all {
            if let Some(begun) = &s.begun {
                s.next.clone_from(&begun.next);
                s.due = begun.due;
                self.numbers[s.states.clone()].copy_from_slice(&begun.states);
            }
        }
    }

    /// Whether a sample is due at this instant.
    pub fn is_sampled(&self, t: f64) -> bool {
        let due = |s: &Sampled| t >= s.due - TOGETHER * s.length;
        self.samples.all.iter().any(due)
    }

    /// Whether two instants are one beside the times between samples: an output time and a sample that were rounded apart.
    pub fn is_together(&self, a: f64, b: f64) -> bool {
        let shortest = self
            .samples
            .all
            .iter()
            .fold(f64::INFINITY, |h, s| h.min(s.length));
        (a - b).abs() <= TOGETHER * shortest
    }

    /// Takes the samples that are due at an accepted state; whether a state has changed.
    pub fn sample(&mut self, t: f64, y: &[f64]) -> bool {
        let due: Vec<usize> = (0..self.samples.all.len())
            .filter(|&k| t >= self.samples.all[k].due - TOGETHER * self.samples.all[k].length)
            .collect();
        let mut changed = false;
        for &k in &due {
            let s = &self.samples.all[k];
            let states = &mut self.numbers[s.states.clone()];
            changed |= *states != s.next[..];
            states.copy_from_slice(&s.next);
        }
        self.set(t, y);
        for &k in &due {
            let Samples { all, work } = &mut self.samples;
            let s = &mut all[k];
            let mut out = [0.0];
            s.period.run(&self.numbers, work, &mut out);
            s.next.copy_from_slice(&self.numbers[s.results.clone()]);
            // a period that comes to nothing was the last
            s.length = out[0];
            s.due = if out[0] > 0.0 {
                s.due + out[0]
            } else {
                f64::INFINITY
            };
        }
        changed
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
    /// From its matrices, row after row; n states, m inputs, p outputs. `None`: these are other numbers of numbers.
    pub fn new([n, m, p]: [usize; 3], a: &[f64], b: &[f64], c: &[f64], d: &[f64]) -> Option<Self> {
        let fits = a.len() == n * n && b.len() == n * m && c.len() == p * n && d.len() == p * m;
        fits.then(|| Self {
            a: DMatrix::from_row_slice(n, n, a),
            b: DMatrix::from_row_slice(n, m, b),
            c: DMatrix::from_row_slice(p, n, c),
            d: DMatrix::from_row_slice(p, m, d),
        })
    }

    /// Change (or rate) of the states, and the outputs; `None`: the GSE has other numbers of states, inputs or outputs.
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

    /// The closure of a GSE with NS states. Where its sizes do not fit the results are not a number.
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

    /// The closure of a GSE with ND discrete states. Where its sizes do not fit the results are not a number.
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
