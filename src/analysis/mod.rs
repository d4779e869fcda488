//! Analyses of a scene: assemble, move, balance, integrate, linearize, verify.
//!
//! Each folder is a room that knows only the rooms below it:
//!
//! ```text
//! session      one simulation after another; commands; columns of results
//! verify       freedoms, redundancy; what becomes of a model
//! time         the loop over time: kinematics and dynamics
//! statics      rest       linear      eigenvalues, state matrices
//! system       a scene as ẏ = f(t, y) and as F(t, y, ẏ) = 0; everything its programs read
//! start        assembly, placement, initial conditions
//! ```

pub mod linear;
pub mod session;
pub mod start;
pub mod statics;
pub mod system;
pub mod time;
pub mod verify;
pub mod watch;
