//! Dependence of rows near a position: it is looked at again where the
//! mechanism stands a little differently.
//!
//! A step along random free directions, with all motions at slightly different values, is closed
//! again; rows that are independent there were dependent in passing only (a folded parallelogram, a
//! four-bar at its dead point). When no other position can be reached, what was found stands.

use crate::analysis::start::assemble::{self, CLOSED, Redundant};
use crate::numeric::rank::Rank;
use crate::scene::Scene;
use crate::scene::configuration::Configured;
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
pub fn look(scene: Configured<'_>, t: f64, q: &[f64], x: &[f64], here: &[usize]) -> Option<Around> {
    let w = weights(&scene);
    let (_, gradient, _) = assemble::rows_at(scene, t, q, x);
    let rows = assemble::scaled_rows(&gradient, &w);
    let rank = Rank::of(rows.iter().map(Vec::as_slice), w.len(), assemble::DEPENDENT);
    let free = rank.free_directions();
    let at = assemble::numbers(scene, t, q, &vec![0.0; scene.layout.n_v], x);
    let at = Equations::new(scene, &at);
    let values: Vec<f64> = (0..scene.motions.len())
        .map(|m| at.prescribed(m).value)
        .collect();
    if free.is_empty() && values.is_empty() {
        return None;
    }
    let mover = Mover::new(&scene);
    let mut draw = Draw(1);
    let mut best: Option<Around> = None;
    let mut seen = 0;
    for (step, drives) in STEPS {
        let motions: Vec<f64> = values
            .iter()
            .enumerate()
            .map(|(m, value)| {
                let one = if scene.drives_an_angle(m) {
                    1.0
                } else {
                    scene.length
                };
                let by = step * one * draw.next();
                if drives { value + by } else { *value }
            })
            .collect();
        let mut change = vec![0.0; w.len()];
        for direction in &free {
            let share = draw.next();
            for (c, d) in change.iter_mut().zip(direction) {
                *c += share * d;
            }
        }
        let longest = change.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        if longest > 0.0 {
            for (c, w) in change.iter_mut().zip(&w) {
                *c *= step / longest * w.sqrt();
            }
        } else if !drives {
            continue;
        }
        let mut there = scene.configuration.with_motions_at(&motions);
        let mut q1 = q.to_vec();
        mover.displace(&mut q1, &change);
        let closed = assemble::close(&scene, &mut there, t, &mut q1, x, |_, _| false);
        let far = distance(&scene, &w, q, &q1);
        let moved = far > 0.1 * step || drives && !motions.is_empty();
        if !(closed.size <= CLOSED && moved && far < 20.0 * step) {
            continue;
        }
        let (_, gradient, _) = assemble::rows_at(scene.within(&there), t, &q1, x);
        let (independent, redundant) = assemble::rank(&scene, &gradient, here);
        if best
            .as_ref()
            .is_none_or(|b| b.independent.len() < independent.len())
        {
            let q = Place { motions, q: q1 };
            best = Some(Around {
                independent,
                redundant,
                q,
            });
        }
        seen += 1;
        if seen == 3 {
            break;
        }
    }
    best.filter(|b| b.independent.len() >= here.len())
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
