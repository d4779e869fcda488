//! Motions that begin elsewhere than where their joints are drawn: the mechanism is driven there,
//! as a motor would, so that it stays on the branch on which it is drawn.
//!
//! ```text
//! δ = f(t) − δ_drawn, angles the short way        stages at f − δ, …, f − δ (n − k)/n, …, f
//! ```
//!
//! Each stage is the position nearest to the one before that satisfies the rows. Where one cannot
//! be reached, the drive does not lead there, and the position is sought from the drawing alone.

use crate::analysis::look::Look;
use crate::analysis::start::alignment;
use crate::analysis::start::assemble::{self, CLOSED};
use crate::analysis::start::branch::short_way;
use crate::analysis::start::initial_conditions::{InitialCondition, Wanted};
use crate::analysis::start::mechanisms::{mechanisms, sizes_by_links};
use crate::analysis::start::nearest::{Origin, nearest};
use crate::model::Model;
use crate::physics::row::Law;
use crate::scene::configuration::{Configuration, Configured};
use crate::scene::equations::Equations;
use crate::scene::{RowKind, Scene};
use crate::space::Frame;

/// Longest way of a motion from one stage to the next, rad or parts of the size of its mechanism.
const STAGE: f64 = 0.1;

/// The way of a motion from where its joint is drawn to where it begins.
#[derive(Clone, Copy, Debug)]
pub(in crate::analysis) struct DrivenWay {
    /// index of the motion
    pub motion: usize,
    /// where it begins   [rad, length]
    pub begins: f64,
    /// how far that is from where its joint is drawn   [rad, length]
    pub by: f64,
}

/// Returns the ways of the motions of joints at time `t` and states `x`. `q`: as it is drawn.
pub(in crate::analysis) fn ways(
    scene: &Scene,
    configuration: &Configuration,
    (t, q, x): (f64, &[f64], &[f64]),
) -> Vec<DrivenWay> {
    let here = scene.within(configuration);
    let numbers = assemble::numbers(here, t, q, &vec![0.0; scene.layout.n_v], x);
    let at = Equations::<f64>::new(here, &numbers);
    let drawn_by_row = |motion: usize| {
        scene
            .rows
            .iter()
            .enumerate()
            .find_map(|(r, row)| match row.kind {
                RowKind::Markers {
                    law: law @ (Law::Angle | Law::Along(_)),
                    i,
                    j,
                    motion: Some(m),
                } if m == motion && !here.is_held(r) => {
                    let frame = |m: usize| -> Frame<f64> { scene.drawn(m) };
                    Some(law.shown(&frame(i), &frame(j), at.row_drive(m).map(|x| x.value)))
                }
                _ => None,
            })
    };
    let way = |motion: usize| {
        let begins = at.prescribed(motion).value;
        let drawn = (scene.initial_displacement(motion)).or_else(|| drawn_by_row(motion))?;
        let by = begins - drawn;
        let by = if scene.drives_an_angle(motion) {
            short_way(by)
        } else {
            by
        };
        by.is_finite().then_some(DrivenWay { motion, begins, by })
    };
    (0..scene.motions.len()).filter_map(way).collect()
}

/// Drives `q` from where it is drawn to where motions begin, if that is far, and meets what is
/// wanted on the way; returns whether all stages were reached.
pub(super) fn drive(
    (scene, configuration): (&Scene, &mut Configuration),
    (model, conditions): (&Model, &[InitialCondition]),
    t: f64,
    q: &mut [f64],
    x: &[f64],
    look: Look<'_>,
) -> bool {
    let ways = ways(scene, configuration, (t, q, x));
    let n_stages = stages(scene, configuration, &ways, (t, q, x));
    let most = n_stages.iter().copied().fold(0.0, f64::max);
    if most <= 1.0 {
        return false;
    }
    let here = scene.within(configuration);
    let numbers = assemble::numbers(here, t, q, &vec![0.0; scene.layout.n_v], x);
    let wanted = Wanted::new(here, conditions, &numbers);
    let mut origin = Origin::Drawn;
    let mut k = 0.0;
    while k <= most {
        for (way, n) in ways.iter().zip(&n_stages) {
            let left = if *n > 0.0 { (n - k).max(0.0) / n } else { 0.0 };
            let stands_at = way.begins - way.by * left;
            configuration.motions[way.motion].stands_at = Some(stands_at);
        }
        let place = (scene, &mut *configuration);
        if k == 0.0 && alignment::leave_out(place.0, place.1, t, q, x, look).is_err() {
            return false;
        }
        let place = (scene, &mut *configuration);
        nearest(place, (Some(model), &wanted), t, q, x, origin);
        let held = |scene: Configured<'_>, r: usize| scene.is_held(r);
        let closed = assemble::close(scene, configuration, t, q, x, held);
        if closed.size.is_nan() || closed.size > CLOSED || look().is_err() {
            return false;
        }
        origin = Origin::EachStep;
        k += 1.0;
    }
    for way in &ways {
        configuration.motions[way.motion].stands_at = None;
    }
    true
}

/// Returns how many stages each way has.
fn stages(
    scene: &Scene,
    configuration: &Configuration,
    ways: &[DrivenWay],
    (t, q, x): (f64, &[f64], &[f64]),
) -> Vec<f64> {
    if ways.iter().all(|way| way.by == 0.0) {
        return vec![0.0; ways.len()];
    }
    let (_, gradient) = assemble::rows_at_rest(scene.within(configuration), t, q, x);
    let all = mechanisms(scene, gradient.iter());
    let sizes = sizes_by_links(&all, scene.links.len());
    let of_row = |motion: usize| {
        let marker = scene.rows.iter().find_map(|row| match row.kind {
            RowKind::Markers {
                i, j, motion: m, ..
            } if m == Some(motion) => Some([i, j]),
            _ => None,
        });
        marker?.into_iter().find_map(|m| scene.markers[m].link)
    };
    let one = |motion: usize| {
        let coordinate = scene.motions[motion].coordinate;
        let link = match coordinate {
            Some(c) => Some(scene.coordinates[c].link),
            None => of_row(motion),
        };
        let size = link.map_or(1.0, |l| sizes[l]);
        if scene.drives_an_angle(motion) {
            1.0
        } else {
            size
        }
    };
    let n = |way: &DrivenWay| (way.by / one(way.motion) / STAGE).abs().ceil();
    ways.iter().map(n).collect()
}
