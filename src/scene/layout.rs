//! Places and sizes: the only file with index arithmetic over what a program of the scene reads.
//!
//! A program of the scene reads one flat row of numbers: `t | q | v | x | turns | loops |
//! external`. The integrator's unknowns y are its middle part `q | v | x`. Both stay plain slices,
//! so that programs and methods read and write them as they are; [`Layout`] says where a number
//! stands, and [`State`] is y by its blocks.

use crate::expr::program::Input;
use std::ops::Range;

/// Sizes of the blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// positions of the forest (a ball has four)
    pub n_q: usize,
    /// velocities of the forest
    pub n_v: usize,
    /// states of differential equations and of motions given by their rate
    pub n_x: usize,
    /// last accepted values of angles whose turns are counted
    pub n_turns: usize,
    /// unknowns of algebraic loops that are solved beside the programs
    pub n_loops: usize,
    /// external inputs: results of closures, delayed values, what sensors evaluated
    pub n_external: usize,
}

/// Blocks of the integrator's unknowns y, of their rates, or of anything else that stands in their
/// order; `B` is a slice or a list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct State<B> {
    /// positions of the forest   (n_q)
    pub q: B,
    /// velocities of the forest   (n_v)
    pub v: B,
    /// further states   (n_x)
    pub x: B,
}

impl Layout {
    /// Place of time.
    pub const TIME: usize = 0;
    /// Place of the first of the integrator's unknowns.
    pub const STATE: usize = 1;

    /// Returns the places of q.
    pub fn q(&self) -> Range<usize> {
        Self::STATE..Self::STATE + self.n_q
    }
    /// Returns the places of v.
    pub fn v(&self) -> Range<usize> {
        self.q().end..self.q().end + self.n_v
    }
    /// Returns the places of x.
    pub fn x(&self) -> Range<usize> {
        self.v().end..self.v().end + self.n_x
    }
    /// Returns the places of the integrator's unknowns `q | v | x`.
    pub fn y(&self) -> Range<usize> {
        Self::STATE..self.x().end
    }
    /// Returns the places of the counted angles.
    pub fn turns(&self) -> Range<usize> {
        self.x().end..self.x().end + self.n_turns
    }
    /// Returns the places of the unknowns of algebraic loops.
    pub fn loops(&self) -> Range<usize> {
        self.turns().end..self.turns().end + self.n_loops
    }
    /// Returns the places of the external inputs.
    pub fn external(&self) -> Range<usize> {
        self.loops().end..self.loops().end + self.n_external
    }
    /// Returns how many numbers a program reads.
    pub fn len(&self) -> usize {
        self.external().end
    }
    /// Returns false: there is always time.
    pub fn is_empty(&self) -> bool {
        false
    }
    /// Returns the inputs of a program in their order.
    pub fn inputs(&self) -> Vec<Input> {
        (0..self.len()).map(|k| Input::Slot(k as u32)).collect()
    }

    /// Returns the place of the `k`-th position.
    pub fn q_at(&self, k: usize) -> usize {
        self.q().start + k
    }
    /// Returns the place of the `k`-th velocity.
    pub fn v_at(&self, k: usize) -> usize {
        self.v().start + k
    }
    /// Returns the place of the `k`-th further state.
    pub fn x_at(&self, k: usize) -> usize {
        self.x().start + k
    }
    /// Returns the place of the `k`-th of the integrator's unknowns.
    pub fn y_at(&self, k: usize) -> usize {
        Self::STATE + k
    }
    /// Returns the place of the `k`-th external input.
    pub fn external_at(&self, k: usize) -> usize {
        self.external().start + k
    }

    /// Returns how many unknowns the integrator has.
    pub fn n_y(&self) -> usize {
        self.n_q + self.n_v + self.n_x
    }
    /// Splits y, or what stands in its order, into its blocks; further numbers after these, such as
    /// multipliers, are left aside.
    pub fn state<'y, T>(&self, y: &'y [T]) -> State<&'y [T]> {
        let (q, rest) = y.split_at(self.n_q);
        let (v, rest) = rest.split_at(self.n_v);
        State {
            q,
            v,
            x: &rest[..self.n_x],
        }
    }
    /// Splits y as [`state`](Self::state), to be written.
    pub fn state_mut<'y, T>(&self, y: &'y mut [T]) -> State<&'y mut [T]> {
        let (q, rest) = y.split_at_mut(self.n_q);
        let (v, rest) = rest.split_at_mut(self.n_v);
        State {
            q,
            v,
            x: &mut rest[..self.n_x],
        }
    }
    /// Splits what a projection changes: positions by a tangent (n_v), velocities (n_v), then
    /// states of contacts on curves.
    pub fn change<'c>(&self, change: &'c [f64]) -> State<&'c [f64]> {
        let (q, rest) = change.split_at(self.n_v);
        let (v, x) = rest.split_at(self.n_v);
        State { q, v, x }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_the_state_are_the_blocks_of_the_row() {
        let layout = Layout {
            n_q: 4,
            n_v: 3,
            n_x: 2,
            n_turns: 1,
            n_loops: 1,
            n_external: 2,
        };
        let mut row: Vec<usize> = (0..layout.len()).collect();
        assert_eq!(row[layout.y()].len(), layout.n_y());
        let state = layout.state(&row[layout.y()]);
        assert_eq!(state.q, &row[layout.q()]);
        assert_eq!(state.v, &row[layout.v()]);
        assert_eq!(state.x, &row[layout.x()]);
        // numbers after the state are left aside
        assert_eq!(layout.state(&row[layout.y().start..]), state);
        assert_eq!(row[layout.v_at(1)], state.v[1]);
        let y = layout.y();
        layout.state_mut(&mut row[y]).v[1] = 99;
        assert_eq!(row[layout.v_at(1)], 99);
    }
}
