//! Chatter: a switch that goes to and fro while positions move by less than the error asked for.
//!
//! A damped motion about a displacement at which a force changes its sign swings ever less and ever
//! more quickly. Once a swing is shorter than the error of a method, nothing of it can be told any
//! more, but each still takes steps of its own:
//!
//! ```text
//! the rate jumps at the switch, which is the one of the event before, to the other side
//! |Δqᵢ| < error · sizeᵢ        since the event before, for all coordinates
//! ```
//!
//! A thousand such events in a row, and more than [`MOST_EVENTS`] to come at their pace, are the
//! end of a run. A body that bounces is none of them: at touch its forces do not jump.

use crate::analysis::system::System;
use crate::numeric::Ode;

/// Swings in a row from which on a switch chatters.
const LEAST_SWINGS: usize = 1000;
/// Events still to come at the pace of the swings that are not waited for.
const MOST_EVENTS: f64 = 2e4;

/// The last events of one switch that went to and fro.
#[derive(Clone, Debug, Default)]
pub(super) struct Chatter {
    /// the switch, and the side to which it went
    last: Option<(usize, i8)>,
    /// its swings in a row, and when they began
    swings: usize,
    since: f64,
    /// coordinates at the last event   (n_q)
    q: Vec<f64>,
    /// sizes of the unknowns   (n)
    sizes: Vec<f64>,
}

impl Chatter {
    /// Takes note of a switch that goes over to a side at a state.
    pub fn see(&mut self, system: &mut System, (t, y): (f64, &[f64]), k: usize, side: i8) {
        let n_q = system.scene.layout.n_q;
        if self.sizes.is_empty() {
            self.sizes = vec![1.0; Ode::size(system)];
            Ode::typical(system, &mut self.sizes);
        }
        let near = |((a, b), size): ((&f64, &f64), &f64)| (a - b).abs() < system.precision * size;
        let stays = self.q.len() == n_q && y.iter().zip(&self.q).zip(&self.sizes).all(near);
        let returns = self
            .last
            .is_some_and(|(last, from)| last == k && from != side);
        if stays && returns && (self.swings > 0 || system.rate_jumps(t, y, k)) {
            self.swings += 1;
        } else {
            (self.swings, self.since) = (0, t);
        }
        self.last = Some((k, side));
        self.q.clear();
        self.q.extend_from_slice(&y[..n_q]);
    }

    /// Returns whether there are many swings.
    pub fn is_long(&self) -> bool {
        self.swings >= LEAST_SWINGS
    }

    /// Returns whether there are many swings, and would be far more until the `end` of a run.
    pub fn is_endless(&self, t: f64, end: f64) -> bool {
        let pace = self.swings as f64 / (t - self.since);
        self.is_long() && pace * (end - t) > MOST_EVENTS
    }
}
