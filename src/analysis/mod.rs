//! Analyses of a scene: assemble, move, balance, integrate, linearize, verify.
//!
//! Each folder is a room; its files name those of the rooms below it, and of none above:
//!
//! ```text
//! work_precision   a model at many requests by all methods: error against time
//! session      one simulation after another; commands; columns of results
//! verify       freedoms, redundancy; what becomes of a model
//! time         kinematics and dynamics: the loop over steps, switches, ranks
//! statics      rest                      linear   eigenvalues, state matrices
//! watch        the hooks of a caller     trajectory   states at output times
//! runaway      motions that grow without bound, whose run would not end
//! work_limit   processor time that may be used
//! system       a scene as ẏ = f(t, y) and as F(t, y, ẏ) = 0; everything its programs read
//! start        assembly, placement, initial conditions
//! look         whether a long phase of setting up is to go on
//! ```

pub(crate) mod accuracy;
pub(crate) mod direction;
#[cfg(feature = "geometry")]
pub(crate) mod interference;
pub mod linear;
mod look;
pub(crate) mod motion;
pub(in crate::analysis) mod quantity;
mod runaway;
pub mod session;
pub(crate) mod stack;
pub(crate) mod start;
pub(crate) mod statics;
pub mod sweep;
pub(crate) mod system;
pub(crate) mod time;
pub(crate) mod trajectory;
pub mod verify;
pub(crate) mod warning;
pub mod watch;
pub mod work_limit;
pub(crate) mod work_precision;
