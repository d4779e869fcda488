//! Quantities that functions read too early: finding them, and their equations.

use super::{Equations, Lack};
use crate::scalar::Scalar;
use crate::scene::asker::Asker;
use crate::scene::loops::Key;

impl<S: Scalar> Equations<'_, S> {
    /// Returns what was asked for too early.
    pub(in crate::scene) fn discovered(self) -> Vec<Key> {
        self.scratch.discovered.into_inner()
    }

    /// Value of an unknown of the loops; `None`: it is none.
    pub(super) fn unknown(&self, key: Key) -> Option<S> {
        let &k = self.scene.loop_of.get(&key)?;
        match self.now.loops.get(k) {
            Some(&value) => Some(value),
            None => Some(self.complain(&self.scene.loops[k].asker, Lack::OutsideLoop)),
        }
    }

    /// The first `count` unknowns of the loops.
    pub(in crate::scene) fn unknowns(&self, count: usize) -> Vec<S> {
        self.now.loops[..count].to_vec()
    }

    /// Something is asked for that depends on who asks.
    pub(super) fn too_early(&self, key: Key, asked_by: &Asker, lack: Lack) -> S {
        if !self.discovering {
            return self.complain(asked_by, lack);
        }
        if self.scratch.early.borrow_mut().insert(key) {
            self.scratch.discovered.borrow_mut().push(key);
        }
        S::zero()
    }

    /// Asks for all that loads, rates and functions ask for, without solving anything.
    pub(in crate::scene) fn discover(&self) {
        self.scratch.while_solving(|| self.loads());
        self.state_rates();
        for f in 0..self.scene.formulas.len() {
            self.formula(f);
        }
        for unknown in &self.scene.loops {
            if let Key::Formula(f) = unknown.key {
                self.evaluate(f);
            }
        }
    }

    /// ρ of the loops: zero at their solution.
    pub(in crate::scene) fn loop_residuals(&self) -> Vec<S> {
        let keys = self.scene.loops.iter().zip(&self.now.loops);
        keys.map(|(unknown, &z)| match unknown.key {
            Key::Formula(f) => self.evaluate(f) - z,
            Key::Measure(m, ids) => self.measure_itself(m, ids, &unknown.asker) - z,
            Key::Rate(d) | Key::Value(d) => self.formula(self.scene.differentials[d].formula),
        })
        .collect()
    }

    /// Values of the formulas that close loops, where they change branch.
    pub(in crate::scene) fn loop_formulas(&self) -> Vec<S> {
        let formulas = self.scene.loops.iter().filter_map(|u| match u.key {
            Key::Formula(f) => Some(self.evaluate(f)),
            Key::Rate(d) | Key::Value(d) => Some(self.formula(self.scene.differentials[d].formula)),
            Key::Measure(..) => None,
        });
        formulas.collect()
    }
}
