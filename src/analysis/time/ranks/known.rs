//! Known meetings: positions of a loop at which branches have been found to meet.
//!
//! A loop of one freedom, such as a parallelogram that goes round, comes through the same positions
//! again and again. One that is known is only a guess: it counts if the motion leads past it, if it
//! is on the rows and they are dependent there, and if the loop has turned neither before it nor
//! behind it (`sides.rs`). Loops with more freedoms come through another position each time.

use super::selection::Rows;
use super::sides::Loop;
use super::turning::Beginning;
use crate::analysis::time::states::{Cubic, Node};
use crate::scene::layout::Layout;
use crate::scene::mover::Mover;
use crate::scene::{Scene, Source};
use std::f64::consts::TAU;

/// Distance of a position from the motion, at most, as a part of the longest way of a coordinate of
/// its kind.
const NEAR_THE_WAY: f64 = 0.01;
/// Positions known of a loop, at most.
const MAX_KNOWN: usize = 16;

/// The known meetings of a loop.
#[derive(Clone, Debug)]
pub(super) struct Meetings {
    /// places in q of its coordinates, and whether they are angles; `None`: it has more freedoms
    /// than one, or a ball
    places: Option<Vec<(usize, bool)>>,
    known: Vec<Meeting>,
}

/// A position at which branches meet, and the rows before and behind it.
#[derive(Clone, Debug)]
pub(super) struct Meeting {
    /// by coordinates of the loop
    q: Vec<f64>,
    ends: [Rows; 2],
}

impl Meetings {
    /// Prepares a loop, of which no meeting is known yet.
    pub fn of(scene: &Scene, of: &Loop) -> Self {
        let mut places = vec![None; scene.layout.n_v];
        for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
            if let (Source::Free { q, v }, false) = (c.source, f.in_ball) {
                places[v] = Some((q, c.angular));
            }
        }
        let has_one_freedom = of.coordinates.len() == of.rows.len() + 1;
        let places = of.coordinates.iter().map(|&v| places[v]);
        Self {
            places: places.collect::<Option<_>>().filter(|_| has_one_freedom),
            known: Vec::new(),
        }
    }

    /// Returns whether a further meeting would be of use.
    pub fn may_learn(&self) -> bool {
        self.places.is_some() && self.known.len() < MAX_KNOWN
    }

    /// Takes up a meeting at positions `q`, with the rows before and behind it.
    pub fn learn(&mut self, q: &[f64], ends: [&Rows; 2]) {
        if let Some(places) = &self.places {
            self.known.push(Meeting {
                q: places.iter().map(|p| q[p.0]).collect(),
                ends: ends.map(Rows::clone),
            });
        }
    }

    /// Returns the known meetings past which a motion between two states leads: the state of the
    /// mechanism there, with the positions of the loop where branches met.
    pub fn passed<'a>(
        &'a self,
        (mover, l): (&'a Mover, Layout),
        ends: [&'a Node; 2],
    ) -> impl Iterator<Item = (Node, &'a Meeting)> + 'a {
        let places = self.places.as_deref().filter(|_| !self.known.is_empty());
        let cubic = places.map(|places| (places, Cubic::new(mover, l, ends)));
        cubic.into_iter().flat_map(move |(places, cubic)| {
            let at = move |meeting: &'a Meeting| {
                let node = meeting.on_the_way(places, (mover, l), (&cubic, ends))?;
                Some((node, meeting))
            };
            self.known.iter().filter_map(at)
        })
    }
}

impl Meeting {
    /// Returns the state between two others at which the motion passes the position, put there;
    /// `None`: it does not.
    fn on_the_way(
        &self,
        places: &[(usize, bool)],
        (mover, l): (&Mover, Layout),
        (cubic, [a, b]): (&Cubic, [&Node; 2]),
    ) -> Option<Node> {
        let [before, after] = [a, b].map(|node| l.state(&node.y[..]).q);
        let way = |k: usize| (after[k] - before[k]).abs();
        // angles are the same after a whole turn
        let near = |is_angle: bool, q: f64, there: f64| match is_angle {
            true => q + ((there - q) / TAU).round() * TAU,
            false => q,
        };
        let longest = (places.iter().zip(&self.q)).max_by(|a, b| way(a.0.0).total_cmp(&way(b.0.0)));
        let (&(k, is_angle), &q) = longest?;
        let target = near(is_angle, q, 0.5 * (before[k] + after[k]));
        let t = cubic.reaches(k, target)?;
        let mut y = a.y.clone();
        cubic.at(mover, t, &mut y);
        let state = l.state_mut(&mut y[..]);
        for (&(k, is_angle), &q) in places.iter().zip(&self.q) {
            let of_kind = places.iter().filter(|other| other.1 == is_angle);
            let longest = of_kind.map(|other| way(other.0)).fold(0.0, f64::max);
            let there = &mut state.q[k];
            let q = near(is_angle, q, *there);
            if (q - *there).abs() > NEAR_THE_WAY * longest {
                return None;
            }
            *there = q;
        }
        Some(Node { t, y })
    }

    /// Returns whether a loop whose rows are known at two states turns between them at this
    /// position alone, in either direction.
    pub fn is_all_between(&self, from: &Rows, to: &Rows) -> bool {
        let [a, b] = &self.ends;
        let leads = |first: &Rows, last: &Rows| {
            !Beginning::at(from).has_turned(first) && !Beginning::at(last).has_turned(to)
        };
        leads(a, b) || leads(b, a)
    }
}
