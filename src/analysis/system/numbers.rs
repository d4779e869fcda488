//! The numbers of an instant: time and state put into them, and what follows from these filled in.

use super::System;
use crate::numeric::Ode;
use crate::scalar::Dual;
use crate::scene::configuration::Configured;
use crate::scene::layout::Layout;
use crate::scene::slopes::WIDTH;

impl System {
    /// Returns all numbers at a state, projected onto the rows.
    pub fn row(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut on_rows = std::mem::take(&mut self.stage);
        on_rows.clear();
        on_rows.extend_from_slice(y);
        if self.put_on_rows(t, &mut on_rows).is_err() {
            on_rows.copy_from_slice(y);
        }
        let row = self.row_of(t, &on_rows);
        self.stage = on_rows;
        row
    }

    /// Returns all numbers at a state that is on the rows.
    pub fn row_of(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        self.set(t, y);
        if !self.recorded.external.is_empty() {
            self.recorded.external.evaluate(&mut self.numbers, true);
        }
        self.numbers.clone()
    }

    /// Returns, for a state whose numbers are `row`, the numbers on the branches between which the
    /// motion stays, and the part of each in the mean that is what happens: dry friction at rest is
    /// between its values on both sides. Empty: nothing slides.
    pub fn rows_of_branches(&mut self, row: &[f64]) -> Vec<(f64, Vec<f64>)> {
        if !self.recorded.branches.is_sliding() {
            return Vec::new();
        }
        let y = &row[self.scene.layout.y()];
        let mut sizes = vec![1.0; y.len()];
        Ode::typical(self, &mut sizes);
        (sizes.iter_mut().zip(y)).for_each(|(size, y)| *size = size.max(y.abs()));
        let found = self.recorded.branches.between(row, &sizes);
        let mut rows = Vec::with_capacity(found.len());
        for mut branch in found {
            let mut state = y.to_vec();
            (state.iter_mut().zip(&branch.shift)).for_each(|(y, shift)| *y += shift);
            (self.recorded.branches).exchange_sides(&mut branch.sides);
            self.set(row[Layout::TIME], &state);
            (self.recorded.branches).exchange_sides(&mut branch.sides);
            if !self.recorded.external.is_empty() {
                self.recorded.external.evaluate(&mut self.numbers, true);
            }
            rows.push((branch.part, self.numbers.clone()));
        }
        self.numbers.copy_from_slice(row);
        rows
    }

    /// Returns all numbers with time and state put into them.
    pub(in crate::analysis) fn numbers_at(&self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut numbers = self.numbers.clone();
        self.scene.layout.set_state(&mut numbers, t, y);
        numbers
    }

    /// Takes over time and state, and solves the loops there.
    #[inline]
    pub(in crate::analysis) fn set(&mut self, t: f64, y: &[f64]) {
        self.scene.layout.set_state(&mut self.numbers, t, y);
        if !self.follows_from_state() {
            self.fill(false);
        }
    }

    /// Returns whether there is nothing to fill in at an instant but time and state.
    #[inline]
    pub(super) fn follows_from_state(&self) -> bool {
        self.recorded.external.is_empty() && self.recorded.loops.is_none()
    }

    /// Solves the loops at the present numbers, after some of them have been changed.
    ///
    /// # Errors
    /// The index of a loop without a solution near, in `Scene::loops`.
    pub fn resolve(&mut self) -> Result<(), usize> {
        self.fill(true);
        self.unsolved.map_or(Ok(()), Err)
    }

    /// Fills in the numbers that follow from time and state; `output`: also those that only results
    /// show.
    fn fill(&mut self, output: bool) {
        if !self.recorded.external.is_empty() {
            self.recorded.external.evaluate(&mut self.numbers, output);
        }
        if let Some(loops) = &mut self.recorded.loops {
            // where branches are held, the branch that the state says may have no solution
            let held = self.recorded.branches.fill_loops(&mut self.numbers);
            self.unsolved = if held {
                None
            } else {
                loops.solve(&mut self.numbers).err()
            };
        }
    }

    /// Puts in along which directions closures' results and loops' unknowns change, where `along`
    /// says it of the other numbers.
    pub fn depend_along(&self, along: &mut [Vec<u32>]) {
        self.recorded.external.closures.depend(along);
        if let Some(loops) = &self.recorded.loops {
            loops.depend(along);
        }
    }

    /// Puts the derivatives of closures' results and loops' unknowns along the directions of a row
    /// of numbers into their places; `first`: at new numbers. A longer row is that of the held
    /// programs.
    ///
    /// # Errors
    /// The index of a loop that nothing determines, in `Scene::loops`.
    pub fn follow_along(&mut self, numbers: &mut [Dual<WIDTH>], first: bool) -> Result<(), usize> {
        self.recorded.external.closures.follow(numbers, first);
        let recorded = &mut self.recorded;
        let held = recorded.branches.is_holding() && numbers.len() > self.scene.layout.len();
        let loops = if held {
            &mut recorded.branches.loops
        } else {
            &mut recorded.loops
        };
        match loops {
            Some(loops) => loops.follow(numbers, first),
            None => Ok(()),
        }
    }
}

/// Returns the numbers before the first step: angles, guesses of loops, and external inputs.
pub(super) fn first_numbers(scene: Configured<'_>) -> Vec<f64> {
    let l = scene.layout;
    let mut numbers = vec![0.0; l.len()];
    for (z, unknown) in numbers[l.loops()].iter_mut().zip(&scene.loops) {
        *z = unknown.guess;
    }
    let angles = numbers[l.turns()].iter_mut();
    for (x, angle) in angles.zip(scene.configuration.angles()) {
        *x = angle;
    }
    let external = numbers[l.external()].iter_mut();
    for (x, value) in external.zip(&scene.configuration.external) {
        *x = *value;
    }
    numbers
}
