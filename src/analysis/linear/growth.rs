//! The small motion that grows fastest.
//!
//! ```text
//! |δλ| ≤ κ ‖δA‖,  κ = |y||x|/|yᴴx|      A x = λ x,  yᴴA = λ yᴴ                         (1)
//! ```
//!
//! An eigenvalue counts as one that grows where its real part is larger than (1) makes of rounding:
//! a direction in which nothing happens has two eigenvalues of zero that depend on each other, and
//! rounding parts them by its root.

use super::modes::{eigenvalues, eigenvector};
use super::{Small, directions, slopes, state_rows};
use crate::analysis::system::System;
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix};

/// Rounding of the entries of A, relative to its norm and the root of its size: they come out of a
/// factorization of masses.
const ROUNDING: f64 = 1e3 * f64::EPSILON;
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
    values.sort_by(|a, b| b.re.total_cmp(&a.re));
    let grows = values.into_iter().find(|&v| is_sure(&balanced, v));
    Some(grows.map(|v| Growth {
        rate: v.re,
        frequency: v.im / std::f64::consts::TAU,
    }))
}

/// Returns whether the real part of an eigenvalue is more than rounding (1).
fn is_sure(a: &DMatrix<f64>, value: Complex<f64>) -> bool {
    let norm = a.norm();
    let rounding = ROUNDING * norm;
    if value.re <= rounding {
        return false;
    }
    let right = eigenvector(a, value, norm, &[]);
    let left = eigenvector(&a.transpose(), value.conj(), norm, &[]);
    let (Some(right), Some(left)) = (right, left) else {
        return false;
    };
    // both are of length one
    value.re * left.dotc(&right).norm() > rounding
}
