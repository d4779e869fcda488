//! Dependence of rows near a position: it is looked at again where the
//! mechanism stands a little differently.
//!
//! A step along random free directions, with all motions at slightly different values, is closed
//! again; rows that are independent there were dependent in passing only (a folded parallelogram, a
//! four-bar at its dead point). When no other position can be reached, what was found stands.

use crate::analysis::look::Look;
use crate::analysis::start::assemble::{self, CLOSED, Redundant};
use crate::diagnostic::Diagnostic;
use crate::numeric::connected::{SparseRow, connected};
use crate::numeric::rank::Rank;
use crate::scene::Scene;
use crate::scene::configuration::{Configuration, Configured};
use crate::scene::equations::Equations;
use crate::scene::mover::Mover;
use crate::scene::programs::weights;

/// Another position: values of the motions and positions of the forest there.
#[derive(Clone, Debug, Default)]
pub struct Place {
    /// displacements that the motions prescribe there   (n_motions)
    pub motions: Vec<f64>,
    /// positions   (n_q)
    pub q: Vec<f64>,
}

/// The rank of the rows at another position.
#[derive(Clone, Debug)]
pub struct Around {
    /// rows that are independent near here
    pub independent: Vec<usize>,
    /// rows that depend on others here and there
    pub redundant: Vec<Redundant>,
    /// that position
    pub q: Place,
}

/// Sizes of steps that are tried: angles, and lengths relative to the mechanism; whether motions
/// take part.
const STEPS: [(f64, bool); 9] = [
    (0.05, true),
    (0.05, true),
    (0.03, false),
    (0.01, true),
    (0.01, true),
    (0.01, false),
    (0.002, true),
    (0.002, true),
    (0.002, false),
];

/// Finds the rank near a position, by the place among those tried where it is largest; `None`: no
/// other position was found.
///
/// `here`: rows that are independent at `q`; they are preferred.
///
/// # Errors
/// The answer of `go_on`, which is asked between the places.
pub(super) fn look(
    scene: Configured<'_>,
    t: f64,
    q: &[f64],
    x: &[f64],
    here: &[usize],
    go_on: Look<'_>,
) -> Result<Option<Around>, Vec<Diagnostic>> {
    let Some(mut around) = Surroundings::new(scene, t, q, x) else {
        return Ok(None);
    };
    let mut best: Option<Around> = None;
    let mut seen = 0;
    for step in STEPS {
        go_on()?;
        let Some((place, there)) = around.step(step) else {
            continue;
        };
        go_on()?;
        let (_, gradient) = assemble::rows_at_rest(scene.within(&there), t, &place.q, x);
        let (independent, redundant) = assemble::rank_of_rows(&scene, &gradient, here, go_on)?;
        if best
            .as_ref()
            .is_none_or(|b| b.independent.len() < independent.len())
        {
            best = Some(Around {
                independent,
                redundant,
                q: place,
            });
        }
        seen += 1;
        if seen == 3 {
            break;
        }
    }
    Ok(best.filter(|b| b.independent.len() >= here.len()))
}

/// Positions near another, along random free directions.
pub(super) struct Surroundings<'s> {
    scene: Configured<'s>,
    t: f64,
    q: &'s [f64],
    x: &'s [f64],
    /// metric of the velocities   (n_v)
    w: Vec<f64>,
    /// directions that the rows leave free, scaled by √w
    free: Vec<SparseRow>,
    /// displacements that the motions prescribe at `q`   (n_motions)
    values: Vec<f64>,
    mover: Mover,
    draw: Draw,
}

impl<'s> Surroundings<'s> {
    /// Finds what is free at a position; `None`: nothing is, and nothing is driven.
    pub fn new(scene: Configured<'s>, t: f64, q: &'s [f64], x: &'s [f64]) -> Option<Self> {
        let w = weights(&scene);
        let (_, mut gradient) = assemble::rows_at_rest(scene, t, q, x);
        assemble::clear_rows_of_velocities(&scene, &mut gradient);
        let free = free_directions(&gradient, &w);
        let at = assemble::numbers(scene, t, q, &vec![0.0; scene.layout.n_v], x);
        let at = Equations::new(scene, &at);
        let values: Vec<f64> = (0..scene.motions.len())
            .map(|m| at.prescribed(m).value)
            .collect();
        if free.is_empty() && values.is_empty() {
            return None;
        }
        let mover = Mover::new(&scene);
        let draw = Draw(1);
        Some(Self {
            scene,
            t,
            q,
            x,
            w,
            free,
            values,
            mover,
            draw,
        })
    }

    /// Makes a step of this size, motions at other values or not; returns where it leads, and the
    /// configuration there, or `None` where the rows cannot be closed.
    pub fn step(&mut self, (step, drives): (f64, bool)) -> Option<(Place, Configuration)> {
        let (scene, w, draw) = (self.scene, &self.w, &mut self.draw);
        let motions: Vec<f64> = self
            .values
            .iter()
            .enumerate()
            .map(|(m, value)| {
                let by = step * scene.unit_of_motion(m) * draw.next();
                if drives { value + by } else { *value }
            })
            .collect();
        let mut change = vec![0.0; w.len()];
        for direction in &self.free {
            let share = draw.next();
            for &(v, d) in direction {
                change[v] += share * d;
            }
        }
        let longest = change.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        if longest > 0.0 {
            for (c, w) in change.iter_mut().zip(w) {
                *c *= step / longest * w.sqrt();
            }
        } else if !drives {
            return None;
        }
        let mut there = scene.configuration.with_motions_at(&motions);
        let mut q1 = self.q.to_vec();
        self.mover.displace(&mut q1, &change);
        let closed = assemble::close(&scene, &mut there, self.t, &mut q1, self.x, |_, _| false);
        let far = distance(&scene, w, self.q, &q1);
        let moved = far > 0.1 * step || drives && !motions.is_empty();
        let arrived = closed.size <= CLOSED && moved && far < 20.0 * step;
        arrived.then_some((Place { motions, q: q1 }, there))
    }
}

/// Returns the directions that rows leave free, columns scaled by √w.
fn free_directions(gradient: &[SparseRow], w: &[f64]) -> Vec<SparseRow> {
    let mut free = Vec::new();
    let mut held = vec![false; w.len()];
    for part in connected(gradient, w.len()) {
        let rows = assemble::scaled_part(&part, gradient, w);
        let n = part.columns.len();
        let rank = Rank::of_rows(rows, n, assemble::DEPENDENT);
        let places = |d: Vec<f64>| part.columns.iter().copied().zip(d).collect();
        free.extend(rank.free_directions().into_iter().map(places));
        part.columns.iter().for_each(|&v| held[v] = true);
    }
    // velocities in no row
    let alone = (0..w.len()).filter(|&v| !held[v]);
    free.extend(alone.map(|v| vec![(v, 1.0)]));
    free
}

/// Returns the largest difference of a coordinate, lengths relative to the mechanism.
fn distance(scene: &Scene, w: &[f64], a: &[f64], b: &[f64]) -> f64 {
    let change: Vec<f64> = a.iter().zip(b).map(|(a, b)| b - a).collect();
    let tangent = Mover::new(scene).tangent(a, &change, w.len());
    tangent
        .iter()
        .zip(w)
        .map(|(x, w)| x.abs() / w.sqrt())
        .fold(0.0, f64::max)
}

/// Draws numbers in (−1, 1), the same on every run.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
