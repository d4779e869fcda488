//! The smoothness of motions over a run.
//!
//! A displacement that jumps asks for an infinite velocity, a slope that jumps for an infinite
//! force; neither is a simulation. A curvature that jumps is one, with accelerations and forces
//! that jump. A function given as a velocity is one derivative smoother as a displacement, one
//! given as an acceleration two.

use crate::analysis::system::System;
use crate::analysis::warning::{self, RunWarning};
use crate::diagnostic::Diagnostic;
use crate::expr::program::Input;
use crate::expr::smoothness::{Breakpoint, smoothness};
use crate::model::{ElementKind, Level};
use crate::results::{Jump, Quantity};
use crate::scene::layout::Layout;

/// A time at which a motion is not smooth.
#[derive(Clone, Debug, PartialEq)]
pub struct Break {
    /// user's number of the MOTION
    pub motion: u32,
    /// when
    pub at: f64,
    /// the lowest derivative of its displacement that jumps there: 0 the displacement, 1 the
    /// velocity, 2 the acceleration
    pub order: usize,
    /// by how much; infinite or NaN where there is no limit on a side
    pub by: f64,
}

impl From<Break> for Jump {
    fn from(b: Break) -> Self {
        Jump {
            motion: b.motion,
            at: b.at,
            of: quantity(b.order),
            by: b.by,
        }
    }
}

/// Returns the derivative of a displacement of this order.
fn quantity(order: usize) -> Quantity {
    match order {
        0 => Quantity::Displacement,
        1 => Quantity::Velocity,
        _ => Quantity::Acceleration,
    }
}

/// Finds the jumps of displacements, velocities or accelerations that motions prescribe between
/// two times.
///
/// # Errors
/// Functions that cannot be evaluated.
pub fn breaks(system: &System, start: f64, end: f64) -> Result<Vec<Break>, Vec<Diagnostic>> {
    let (scene, mut found) = (&system.scene, Vec::new());
    if scene.motions.is_empty() || end.partial_cmp(&start) != Some(std::cmp::Ordering::Greater) {
        return Ok(found);
    }
    let program = system.drives()?;
    let time = Input::Slot(Layout::TIME as u32);
    for (m, motion) in scene.motions.iter().enumerate() {
        let higher = match motion.level {
            Level::Displacement => 0,
            Level::Velocity => 1,
            Level::Acceleration => 2,
        };
        let all = smoothness(program, m, time, start..=end).breakpoints;
        let shown = |b: Breakpoint| Break {
            motion: motion.id,
            at: b.at,
            order: b.order + higher,
            by: b.jump(b.order),
        };
        found.extend(all.into_iter().map(shown).filter(|b| b.order <= 2));
    }
    Ok(found)
}

/// Returns errors for the motions that cannot be run because the displacement that they prescribe,
/// or its rate, jumps.
pub fn refused(breaks: &[Break]) -> Vec<Diagnostic> {
    let all = by_motion(breaks, |b| b.order < 2).into_iter();
    let error = |(motion, quantity, times): Jumps| {
        Diagnostic::error("motion_jumps", warning::jumps(quantity, &times))
            .element(ElementKind::Motion.id(motion))
            .help("join its pieces by STEP5, or insist on it with --piecewise")
    };
    all.map(error).collect()
}

/// Warns of motions whose acceleration jumps, and of all that jump when somebody insists.
pub fn warnings(breaks: &[Break], piecewise: bool) -> Vec<RunWarning> {
    let insisted = by_motion(breaks, |b| piecewise && b.order < 2).into_iter();
    let mild = by_motion(breaks, |b| b.order == 2);
    let warning = |(motion, quantity, jumps)| RunWarning::MotionJumps {
        motion,
        quantity,
        jumps,
    };
    insisted.chain(mild).map(warning).collect()
}

/// User's number of a MOTION, what of it jumps, and when and by how much.
type Jumps = (u32, Quantity, Vec<(f64, f64)>);

/// Sorts some breaks by their motions: the lowest derivative that jumps, and when and by how much
/// any does.
fn by_motion(breaks: &[Break], which: impl Fn(&Break) -> bool) -> Vec<Jumps> {
    let mut motions: Vec<u32> = breaks.iter().map(|b| b.motion).collect();
    motions.dedup();
    let of = |m: u32| {
        let own = breaks.iter().filter(|b| b.motion == m && which(b));
        let worst = own.clone().map(|b| b.order).min()?;
        Some((m, quantity(worst), own.map(|b| (b.at, b.by)).collect()))
    };
    motions.into_iter().filter_map(of).collect()
}
