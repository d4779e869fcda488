//! Places and sizes: the only file with index arithmetic over what a program of the scene reads.
//!
//! A program of the scene reads one flat row of numbers: `t | q | v | x | turns | loops |
//! external`. The integrator's unknowns y are its middle part `q | v | x` without the states
//! downstream of the mechanism, which are the last of x. Both stay plain slices, so that programs
//! and methods read and write them as they are; [`Layout`] says where a number stands, [`State`] is
//! y by its blocks, and [`Instant`] is all of the row by its blocks.
//!
//! Some programs read more, after these numbers, as with branches held: [`LongRow`] says where that
//! stands.

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
    /// of these the last: states downstream of the mechanism, which are no unknowns of its method
    pub n_downstream: usize,
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
    /// further states that are unknowns of the integrator   (n_upstream)
    pub x: B,
}

/// The numbers of one instant by their blocks.
#[derive(Clone, Debug)]
pub struct Instant<S> {
    /// time
    pub t: S,
    /// positions of the forest   (n_q)
    pub q: Vec<S>,
    /// velocities of the forest   (n_v)
    pub v: Vec<S>,
    /// further states   (n_x)
    pub x: Vec<S>,
    /// last accepted values of counted angles   (n_turns)
    pub turns: Vec<S>,
    /// unknowns of algebraic loops that are solved beside the programs   (n_loops)
    pub loops: Vec<S>,
    /// external inputs   (n_external)
    pub external: Vec<S>,
}

/// A longer row: `numbers | more | sides`.
///
/// With branches held, `more` are the unknowns of all loops. Programs that hold no branches read
/// the row without its sides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LongRow {
    /// sizes of the blocks of the numbers
    pub numbers: Layout,
    /// further numbers
    pub n_more: usize,
    /// sides of switches on which branches are held
    pub n_sides: usize,
}

/// Returns the `N` numbers from a place on, such as the four of a quaternion.
pub fn several<S: Copy, const N: usize>(row: &[S], first: usize) -> [S; N] {
    std::array::from_fn(|k| row[first + k])
}

/// Replaces the `N` numbers from a place on.
pub fn replace<S: Copy, const N: usize>(row: &mut [S], first: usize, by: [S; N]) {
    row[first..first + N].copy_from_slice(&by);
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
    /// Returns the places of the states downstream of the mechanism.
    pub fn downstream(&self) -> Range<usize> {
        self.y().end..self.x().end
    }
    /// Returns the places of the integrator's unknowns: `q | v | x` but what is downstream.
    pub fn y(&self) -> Range<usize> {
        Self::STATE..self.x().end - self.n_downstream
    }
    /// Returns the places of all states: `q | v | x`.
    pub fn states(&self) -> Range<usize> {
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

    /// Returns the places of `n` external inputs from the `k`-th on.
    pub fn externals_at(&self, k: usize, n: usize) -> Range<usize> {
        self.external_at(k)..self.external_at(k + n)
    }

    /// Returns how many unknowns the integrator has.
    pub fn n_y(&self) -> usize {
        self.n_q + self.n_v + self.n_upstream()
    }
    /// Returns how many further states are unknowns of the integrator.
    pub fn n_upstream(&self) -> usize {
        self.n_x - self.n_downstream
    }
    /// Returns y without the states downstream, which may stand after it.
    pub fn upstream<'y, T>(&self, y: &'y [T]) -> &'y [T] {
        &y[..self.n_y()]
    }
    /// Splits y, or what stands in its order, into its blocks; further numbers after these are left
    /// aside.
    pub fn state<'y, T>(&self, y: &'y [T]) -> State<&'y [T]> {
        let (q, rest) = y.split_at(self.n_q);
        let (v, rest) = rest.split_at(self.n_v);
        State {
            q,
            v,
            x: &rest[..self.n_upstream()],
        }
    }
    /// Splits y as [`state`](Self::state), to be written.
    pub fn state_mut<'y, T>(&self, y: &'y mut [T]) -> State<&'y mut [T]> {
        let (q, rest) = y.split_at_mut(self.n_q);
        let (v, rest) = rest.split_at_mut(self.n_v);
        State {
            q,
            v,
            x: &mut rest[..self.n_upstream()],
        }
    }
    /// Returns the number of outputs of a rate program: ẏ, then the strength of the rows.
    pub fn n_rates(&self) -> usize {
        self.n_y() + 1
    }
    /// Splits the numbers of an instant into their blocks.
    pub fn instant<S: Copy>(&self, numbers: &[S]) -> Instant<S> {
        Instant {
            t: numbers[Self::TIME],
            q: numbers[self.q()].to_vec(),
            v: numbers[self.v()].to_vec(),
            x: numbers[self.x()].to_vec(),
            turns: numbers[self.turns()].to_vec(),
            loops: numbers[self.loops()].to_vec(),
            external: numbers[self.external()].to_vec(),
        }
    }
    /// Puts time and state into a row of numbers.
    pub fn set_state(&self, numbers: &mut [f64], t: f64, y: &[f64]) {
        numbers[Self::TIME] = t;
        numbers[self.y()].copy_from_slice(self.upstream(y));
    }
    /// Splits what a projection changes: positions by a tangent (n_v), velocities (n_v), then
    /// states of contacts on curves.
    pub fn change<'c>(&self, change: &'c [f64]) -> State<&'c [f64]> {
        let (q, rest) = change.split_at(self.n_v);
        let (v, x) = rest.split_at(self.n_v);
        State { q, v, x }
    }
}

impl LongRow {
    /// Returns the places of the further numbers.
    pub fn more(&self) -> Range<usize> {
        self.numbers.len()..self.numbers.len() + self.n_more
    }
    /// Returns the places of the sides.
    pub fn sides(&self) -> Range<usize> {
        self.more().end..self.more().end + self.n_sides
    }
    /// Returns the place of the side of the `k`-th switch.
    pub fn side_at(&self, k: usize) -> usize {
        self.sides().start + k
    }
    /// Returns how many numbers the row has.
    pub fn len(&self) -> usize {
        self.sides().end
    }
    /// Returns false: there is always time.
    pub fn is_empty(&self) -> bool {
        false
    }
    /// Puts the numbers of a state and sides into the row.
    #[inline]
    pub fn put(&self, row: &mut [f64], numbers: &[f64], sides: &[f64]) {
        row[..self.numbers.len()].copy_from_slice(numbers);
        if self.n_sides > 0 {
            row[self.sides()].copy_from_slice(sides);
        }
    }
    /// Splits a row that may lack sides into its numbers and the further ones.
    pub fn split<'r, S>(&self, row: &'r [S]) -> (&'r [S], &'r [S]) {
        (&row[..self.numbers.len()], &row[self.more()])
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
            n_x: 3,
            n_downstream: 1,
            n_turns: 1,
            n_loops: 1,
            n_external: 2,
        };
        let mut row: Vec<usize> = (0..layout.len()).collect();
        assert_eq!(row[layout.y()].len(), layout.n_y());
        let state = layout.state(&row[layout.y()]);
        assert_eq!(state.q, &row[layout.q()]);
        assert_eq!(state.v, &row[layout.v()]);
        assert_eq!(
            [state.x, &row[layout.downstream()]].concat(),
            row[layout.x()]
        );
        assert_eq!(layout.states().end, layout.turns().start);
        // numbers after the state are left aside
        assert_eq!(layout.state(&row[layout.y().start..]), state);
        assert_eq!(row[layout.v_at(1)], state.v[1]);
        let y = layout.y();
        layout.state_mut(&mut row[y]).v[1] = 99;
        assert_eq!(row[layout.v_at(1)], 99);
    }
}
