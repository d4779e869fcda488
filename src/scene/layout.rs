//! Places and sizes: the only file with index arithmetic over what a program of the scene reads.
//!
//! A program of the scene reads one flat row of numbers: `t | q | v | x | turns | loops | supplied`. The integrator's y is
//! its middle part `q | v | x`.

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
    /// values that come from outside: hooks, delayed values, sensors
    pub n_external: usize,
}

impl Layout {
    /// Place of time.
    pub const TIME: usize = 0;
    /// Places of q.
    pub fn q(&self) -> Range<usize> {
        1..1 + self.n_q
    }
    /// Places of v.
    pub fn v(&self) -> Range<usize> {
        self.q().end..self.q().end + self.n_v
    }
    /// Places of x.
    pub fn x(&self) -> Range<usize> {
        self.v().end..self.v().end + self.n_x
    }
    /// Places of the integrator's unknowns `q | v | x`.
    pub fn y(&self) -> Range<usize> {
        1..self.x().end
    }
    /// Places of the counted angles.
    pub fn turns(&self) -> Range<usize> {
        self.x().end..self.x().end + self.n_turns
    }
    /// Places of the unknowns of algebraic loops.
    pub fn loops(&self) -> Range<usize> {
        self.turns().end..self.turns().end + self.n_loops
    }
    /// Places of what comes from outside.
    pub fn external(&self) -> Range<usize> {
        self.loops().end..self.loops().end + self.n_external
    }
    /// How many numbers a program reads.
    pub fn len(&self) -> usize {
        self.external().end
    }
    /// Never: there is always time.
    pub fn is_empty(&self) -> bool {
        false
    }
    /// The inputs of a program in their order.
    pub fn inputs(&self) -> Vec<Input> {
        (0..self.len()).map(|k| Input::Slot(k as u32)).collect()
    }
}
