//! The course of time: the loop of kinematics and dynamics, branches, ranks, output times.

pub mod drives;
pub mod dynamics;
pub mod kinematics;
pub mod output;
pub mod ranks;
pub mod switches;
pub(super) mod valueless;
