//! The state at which rows were last found to be the right ones: near it they need not be judged
//! again.
//!
//! The part of a row beyond others changes by about as much as its gradient, whose derivatives are
//! about one where coordinates and rows count as in projections:
//!
//! ```text
//! Σᵢ |Δqᵢ|/√wᵢ ≤ κ σ        σ: the least that any row determined beyond the others
//! ```

use super::System;
use crate::scene::RowKind;
use crate::scene::programs::weights;

/// κ: change of what rows determine, as a part of it, that decides nothing.
const SAME: f64 = 0.01;

/// A state at which the rows that take part were found to be the right ones.
#[derive(Clone, Debug)]
pub(super) struct Judged {
    /// rows that take part   (n_rows)
    active: Vec<bool>,
    /// all numbers of the state
    numbers: Vec<f64>,
    /// largest change of positions, in the metric of projections
    reach: f64,
}

impl System {
    /// Takes note that the rows that take part are the right ones at the present numbers.
    /// `least`: what any of them determines beyond the others, at least.
    pub fn note_right_rows(&mut self, least: f64) {
        let is_smooth =
            |kind: &RowKind| matches!(kind, RowKind::Markers { .. } | RowKind::Displacements(_));
        let are_smooth = self.scene.rows.iter().all(|row| is_smooth(&row.kind));
        self.judged = are_smooth.then(|| Judged {
            active: self.configuration.active.clone(),
            numbers: self.numbers.clone(),
            reach: SAME * least,
        });
    }

    /// Returns whether the rows were the right ones so near to a state that they are there.
    pub fn has_right_rows(&mut self, t: f64, y: &[f64]) -> bool {
        self.set(t, y);
        let Some(judged) = &self.judged else {
            return false;
        };
        let (l, values) = (self.scene.layout, self.row_values());
        if judged.active != self.configuration.active {
            return false;
        }
        let both = judged.numbers.iter().zip(&self.numbers).enumerate();
        let mut others = both.filter(|(k, (there, here))| there != here && !l.q().contains(k));
        if others.any(|(k, _)| values.reads(k)) {
            return false;
        }
        let [there, here] = [&judged.numbers, &self.numbers].map(|numbers| &numbers[l.q()]);
        let change: Vec<f64> = here.iter().zip(there).map(|(b, a)| b - a).collect();
        let tangent = self.mover.tangent(there, &change, l.n_v);
        let ways = tangent.iter().zip(weights(&self.scene));
        ways.map(|(way, w)| way.abs() / w.sqrt()).sum::<f64>() <= judged.reach
    }
}
