//! The small motion that grows fastest.
//!
//! An eigenvalue counts as one that grows where its real part is larger than rounding makes it
//! ([`is_rounding`]).

use super::modes::{eigenvalues, is_rounding};
use super::{Small, directions, slopes, state_rows};
use crate::analysis::system::System;
use crate::arrange::Arrange;
use nalgebra::linalg::balancing::balance_parlett_reinsch;

/// Part of |λ| below which a real part counts as none: a push that grows to e times its size in
/// 160 000 swings.
const LEAST_GROWTH: f64 = 1e-6;

/// A small motion that grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::analysis) struct Growth {
    /// real part of its eigenvalue, per time
    pub rate: f64,
    /// imaginary part over 2π, cycles per time; 0: it leaves without swinging
    pub frequency: f64,
}

/// Finds the small motion about the state of a system that grows fastest: `Some(None)` where none
/// grows, `None` where the equations have no eigenvalues.
pub(in crate::analysis) fn growth(system: &mut System) -> Option<Option<Growth>> {
    let small = Small::at(system).ok()?;
    let directions = directions(system, &small, &[], false);
    if directions.is_empty() {
        return Some(None);
    }
    let slopes = slopes(system, &[], &directions).ok()?;
    let mut balanced = state_rows(system, &small, &slopes, false);
    balance_parlett_reinsch(&mut balanced);
    let mut values = eigenvalues(&balanced)?;
    values.retain(|v| v.im >= 0.0 && v.re > LEAST_GROWTH * v.norm());
    values.arrange_by(|a, b| b.re.total_cmp(&a.re));
    let grows = values
        .into_iter()
        .find(|&v| !is_rounding(&balanced, v, v.re));
    Some(grows.map(|v| Growth {
        rate: v.re,
        frequency: v.im / std::f64::consts::TAU,
    }))
}
