//! Locked mechanisms: positions beyond which a drive cannot go.

use super::{active, gradients, norm, place, weakest};
use crate::analysis::start::assemble;
use crate::scene::configuration::Configured;
use crate::scene::equations::{Equations, row_name};
use crate::scene::layout::Layout;
use nalgebra::DVector;

/// Length of a combination of rows, against the longest row, below which a mechanism counts as
/// locked: near the end of a reach it falls with the square root of the way left.
const NEARLY_DEPENDENT: f64 = 0.02;
/// Displacement of a motion by which its push is measured, rad or parts of the length of the scene.
const DISPLACEMENT: f64 = 1e-6;
/// Change of the combination over that displacement, below which a motion drives elsewhere.
const LEAST_PUSH: f64 = 1e-9;

/// The reason why the rows can be kept no longer near a state: the worst row, and the motion that
/// drives against it.
#[derive(Clone, Debug, PartialEq)]
pub struct Lock {
    /// "JOINT/4 D.Xg"
    pub row: String,
    /// user's number of the MOTION that drives against the rows, where one does
    pub motion: Option<u32>,
    /// coordinates there
    pub place: Vec<(String, f64)>,
}

/// Finds out whether a mechanism is (nearly) locked at a state: rows are nearly dependent there,
/// and drives ask for a motion that they forbid.
pub fn locked(scene: Configured<'_>, numbers: &[f64]) -> Option<Lock> {
    let rows = active(scene);
    let all = gradients(scene, numbers);
    let m = rows.len();
    // rows that have become short here are compared with the longest
    let longest = rows.iter().map(|&r| norm(&all[r])).fold(0.0, f64::max);
    if m == 0 || longest == 0.0 {
        return None;
    }
    let usual = vec![longest; scene.rows.len()];
    let weakest = weakest(&scene, &all, &rows, &usual)?;
    if weakest.size > NEARLY_DEPENDENT {
        return None;
    }
    let u = &weakest.unit;
    let worst = (0..m).max_by(|&i, &j| u[i].abs().total_cmp(&u[j].abs()))?;
    let motion = driver(scene, numbers, &rows, u);
    Some(Lock {
        row: row_name(&scene.rows[rows[worst]]),
        motion,
        place: place(&scene, numbers, &weakest.touched),
    })
}

/// Returns the number of the motion that pushes most along a combination of rows, if any does.
fn driver(scene: Configured<'_>, numbers: &[f64], rows: &[usize], factors: &[f64]) -> Option<u32> {
    let l = scene.layout;
    let (t, q, x) = (numbers[Layout::TIME], &numbers[l.q()], &numbers[l.x()]);
    let at = Equations::new(scene, numbers);
    let values: Vec<f64> = (0..scene.motions.len())
        .map(|k| at.prescribed(k).value)
        .collect();
    let along = |g: &DVector<f64>| -> f64 {
        (rows.iter().zip(factors))
            .map(|(&r, u)| u * g[r] / scene.row_scale(r))
            .sum()
    };
    let at_motions = |displacements: &[f64]| {
        let there = scene.configuration.with_motions_at(displacements);
        assemble::rows_at_rest(scene.within(&there), t, q, x)
    };
    let (still, _) = at_motions(&values);
    let push = |k: usize| {
        let unit = scene.unit_of_motion(k);
        let mut other = values.clone();
        other[k] += DISPLACEMENT * unit;
        let (g, _) = at_motions(&other);
        let push = (along(&g) - along(&still)) / DISPLACEMENT;
        if push.abs() > LEAST_PUSH {
            (push * at.prescribed(k).first / unit).abs()
        } else {
            0.0
        }
    };
    let pushes: Vec<f64> = (0..values.len()).map(push).collect();
    (0..values.len())
        .max_by(|&i, &j| pushes[i].total_cmp(&pushes[j]))
        .filter(|&k| pushes[k] > 0.0)
        .map(|k| scene.motions[k].id)
}
