//! Analyses over time, with and without freedom.
//!
//! ```text
//! dynamics     one method after another       options, trajectory: the question and the answer
//! leg          the loop over the steps of one method; leg_rows, leg_output: its rows, its results
//! switches     branches: held within a step, changed where they end; chatter: without end
//! trial        which method costs less
//! ranks        positions where rows become dependent; better rows; why a mechanism is locked
//! kinematics   mechanisms without freedom; continuation: their steps along a branch;
//!              kinematic_sensors: what is watched on the way
//! downstream   states that read the mechanism and are not read by it, beside it
//! counting     turns of angles, within the steps of all these
//! states       states on the way, and those between
//! drives       motions that jump              valueless   functions that lose their value
//! output       output times
//! ```

mod bounded_switches;
mod chatter;
pub mod continuation;
pub(super) mod counting;
mod downstream;
pub mod drives;
pub mod dynamics;
pub mod energy;
mod kinematic_sensors;
pub mod kinematics;
mod leg;
mod leg_output;
mod leg_peaks;
mod leg_rows;
pub mod options;
pub mod output;
pub mod ranks;
pub mod states;
pub mod switches;
mod trial;
pub(super) mod valueless;
