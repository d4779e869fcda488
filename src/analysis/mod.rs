//! What to do with a scene: assemble, move, balance, integrate, linearize, verify.

pub mod assemble;
pub mod columns;
pub mod drives;
pub mod dynamics;
pub mod implicit;
pub mod kinematics;
pub mod linear;
pub mod misalignment;
pub mod nearby;
pub mod outline;
pub mod output;
pub mod outside;
mod passage;
pub mod placement;
pub mod ranks;
mod reach;
pub mod samples;
pub mod script;
pub mod sensors;
pub mod session;
mod slopes;
pub mod statics;
pub mod switches;
pub mod system;
mod unknowns;
pub mod verify;
mod wishes;
