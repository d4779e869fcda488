//! The small motion that grows fastest.
//!
//! An eigenvalue counts as one that grows where its real part is larger than rounding makes it
//! ([`Part::is_rounding`](super::modes::Part::is_rounding)).

use super::modes::parts;
use super::{Small, directions, slopes, state_rows};
use crate::analysis::system::System;
use crate::arrange::Arrange;

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
    let a = state_rows(system, &small, &slopes, false);
    let mut values = Vec::new();
    let parts = parts(&a);
    for part in &parts {
        let found = part.eigenvalues()?.into_iter();
        let grows = found.filter(|v| v.im >= 0.0 && v.re > LEAST_GROWTH * v.norm());
        values.extend(grows.map(|v| (v, part)));
    }
    values.arrange_by(|(a, _), (b, _)| b.re.total_cmp(&a.re));
    let grows = values
        .into_iter()
        .find(|(v, part)| !part.is_rounding(*v, v.re));
    Some(grows.map(|(v, _)| Growth {
        rate: v.re,
        frequency: v.im / std::f64::consts::TAU,
    }))
}
