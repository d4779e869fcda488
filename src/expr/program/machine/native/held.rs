//! Registers of the processor that hold values of slots.

use super::assembler::{Jump, Xmm};

/// Registers that hold values of slots; the two behind them are for what lies between two
/// instructions.
pub(super) const N_HOLDING: usize = 14;
pub(super) const ONE: Xmm = 14;
pub(super) const OTHER: Xmm = 15;

/// A value in a register, and nowhere else.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held {
    pub(super) slot: u32,
    /// when it is needed again
    pub(super) next: u32,
}

/// The values of all registers.
pub(super) type Holding = [Option<Held>; N_HOLDING];

/// The jumps to a step so far, and the registers in which it finds values.
pub(super) struct Landing {
    pub(super) jumps: Vec<Jump>,
    pub(super) held: Holding,
}
