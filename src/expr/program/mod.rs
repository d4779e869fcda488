//! Straight-line code: constants, inputs, operations, outputs; the builder that records it and the
//! machines that run it.
//!
//! Two makers share it: the compiler of expressions, and the scene, which records its own equations
//! as they run over the recording scalar [`Sym`].
//!
//! ```text
//! builder (nodes) → schedule (order, registers) → program (straight code)
//!         → machine (steps): interpreter, or code of the processor
//! ```
//!
//! ```
//! use cognate::expr::program::{BinaryOp, Builder, Folding, Input, Work};
//! let mut builder = Builder::new(Folding::Strict);
//! let t = builder.input(Input::Time);
//! let square = builder.binary(BinaryOp::Mul, t, t);
//! let program = builder.finish(&[square]);
//! let mut out = [0.0];
//! program.run(&[3.0], &mut Work::default(), &mut out);
//! assert_eq!(out, [9.0]);
//! ```

mod batch;
mod breaks;
mod builder;
mod code;
mod components;
mod compose;
mod dependence;
mod display;
mod expand;
mod follow;
mod general;
mod gradient;
mod guard;
mod hashing;
mod input;
mod known;
mod machine;
mod node;
mod operation;
mod order;
#[cfg(feature = "solver")]
mod parting;
#[cfg(feature = "solver")]
mod peaks;
#[cfg(test)]
mod random;
#[cfg(feature = "solver")]
mod rate;
mod record;
mod reduction;
mod replay;
mod run;
mod schedule;
#[cfg_attr(
    not(feature = "solver"),
    allow(dead_code, reason = "sessions look for structures")
)]
mod structure;
mod switching;
#[cfg(feature = "solver")]
mod tangent;
mod tape;
#[cfg(test)]
mod tests;
#[cfg(feature = "solver")]
mod timed;

pub use batch::Batch;
pub(crate) use breaks::{Break, Levels};
pub use builder::{Builder, Folding};
#[cfg(feature = "solver")]
pub(crate) use general::Share;
pub use input::Input;
pub use machine::{Engine, translation_time};
pub use node::Value;
pub use operation::{BinaryOp, Comparison, UnaryOp};
#[cfg(feature = "solver")]
pub(crate) use parting::Parted;
pub use record::{Condition, Sym};
pub(super) use run::too_few;
pub use run::{Program, Work};
#[cfg(feature = "solver")]
pub(crate) use structure::Structures;
#[cfg(feature = "solver")]
pub(crate) use tangent::{LANES, Lane, Tangent};
