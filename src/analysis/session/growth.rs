//! Motions that grow without bound, and the force that feeds them: a damper of the wrong sign, a
//! controller that overshoots further each time.
//!
//! ```text
//! K₁, K₂, K₃, K₄      largest kinetic energy in each quarter of the time
//! Kₙ₊₁ > 50 Kₙ        it grows exponentially all the way, and
//! K₄ > 10⁶ E₁         beyond all energy that there was in the first quarter
//! ```
//!
//! Where the run stops before its end, it is enough that the kinetic energy there is beyond 10⁶
//! times all energy at the looks before: some motions reach infinity in a finite time.
//!
//! A body that falls or is driven grows as a power of time: from one quarter to the next by 16 at
//! most if its speed does as t². The force that feeds it has the largest power in the end, springs
//! aside: with all velocities reversed their power is the opposite.

use crate::analysis::system::System;
use crate::analysis::warning::Within;
use crate::model::ElementId;
use crate::scene::equations::Equations;
use crate::scene::forces::ForceElement;
use crate::scene::layout::Layout;
use crate::space::MarkerState;

/// Growth of the kinetic energy from one quarter of the time to the next.
const GROWTH_PER_QUARTER: f64 = 50.0;
/// Kinetic energy in the last quarter over all energy in the first.
const BEYOND_ALL: f64 = 1e6;
/// Growth of a velocity from the first quarter to the last without which the energy does not grow
/// by [`BEYOND_ALL`]: a thousand would be its root, and masses change along a motion.
const LEAST_GROWTH: f64 = 10.0;
/// States looked at, at most.
const LOOKS: usize = 160;

/// States at the ends of steps, about equally far apart in time: outputs change nothing.
#[derive(Debug, Default)]
pub(super) struct Looks {
    rows: Vec<Vec<f64>>,
    /// the state at the end of the last step, which may be among them
    last: Vec<f64>,
    /// time from which on the next state is kept, and the distance of such times
    due: f64,
    distance: f64,
}

impl Looks {
    /// Begins at the state of a system, for a run to a time.
    pub fn begin(system: &System, end: f64) -> Self {
        let first = system.numbers.clone();
        let (t, distance) = (
            first[Layout::TIME],
            (end - first[Layout::TIME]) / LOOKS as f64,
        );
        Self {
            last: first.clone(),
            rows: vec![first],
            due: t + distance,
            distance,
        }
    }

    /// Returns the states so far.
    pub fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    /// Looks at all numbers of a state.
    pub fn see(&mut self, numbers: &[f64]) {
        self.last.copy_from_slice(numbers);
        let t = numbers[Layout::TIME];
        if t >= self.due {
            self.rows.push(numbers.to_vec());
            self.due = t + self.distance;
        }
    }

    /// Returns how the motion of a simulation grows, if it does so without bound; without forces it
    /// does not. `stops`: it could not go on.
    pub fn growth(&self, system: &System, stops: bool) -> Option<Growth> {
        if system.scene.forces.is_empty() {
            return None;
        }
        let (first, last) = (self.rows.first()?, &self.last);
        let looked = || self.rows.iter().chain([last]).map(Vec::as_slice);
        // what nobody has looked at in some quarter does not grow there
        let is_seen = |q: usize| looked().any(|row| quarter(row, [first, last]) == q);
        let is_seen = (1..4).all(is_seen);
        let speeds_grow = is_seen && speeds_grow(&system.scene.layout, looked(), [first, last]);
        let grown = speeds_grow.then(|| of(system, looked(), [first, last]));
        (grown.flatten()).or_else(|| stops.then(|| self.burst(system))?)
    }

    /// Returns how the energy has grown since the last look, if it is beyond all that there was.
    fn burst(&self, system: &System) -> Option<Growth> {
        let scene = system.configured();
        let energy = |row: &[f64]| Equations::new(scene, row).energy();
        let all = self.rows.iter().filter(|row| **row != self.last);
        let before = all.fold(0.0_f64, |most, row| {
            let [kinetic, potential] = energy(row);
            most.max(kinetic).max(potential.abs())
        });
        let [kinetic, _] = energy(&self.last);
        (before > 0.0 && kinetic > BEYOND_ALL * before).then(|| Growth {
            factor: kinetic / before,
            within: Within::Moments,
            fed_by: fed_by(system, &self.last),
        })
    }
}

/// Returns the quarter of the time between two states in which a state lies, 0 … 3.
fn quarter(row: &[f64], [first, last]: [&[f64]; 2]) -> usize {
    let (t0, t1) = (first[Layout::TIME], last[Layout::TIME]);
    let part = 4.0 * (row[Layout::TIME] - t0) / (t1 - t0);
    (part.ceil() as usize).clamp(1, 4) - 1
}

/// Returns whether any velocity grows so much that the energy might: a look at the numbers, before
/// energies are evaluated.
fn speeds_grow<'a>(
    layout: &Layout,
    looked: impl Iterator<Item = &'a [f64]>,
    ends: [&[f64]; 2],
) -> bool {
    let mut largest = [vec![0.0_f64; layout.n_v], vec![0.0; layout.n_v]];
    for row in looked {
        let of_quarter = match quarter(row, ends) {
            0 => &mut largest[0],
            3 => &mut largest[1],
            _ => continue,
        };
        for (most, v) in of_quarter.iter_mut().zip(&row[layout.v()]) {
            *most = most.max(v.abs());
        }
    }
    let [early, late] = largest;
    let mut both = early.iter().zip(&late);
    both.any(|(early, late)| *late > LEAST_GROWTH * early)
}

/// A motion that grows without bound.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Growth {
    /// largest kinetic energy in the end over all energy before
    pub factor: f64,
    /// how long before
    pub within: Within,
    /// the force that feeds it in the end
    pub fed_by: Option<ElementId>,
}

/// Returns how the motion grows over some states, if it does so without bound.
fn of<'a>(
    system: &System,
    looked: impl Iterator<Item = &'a [f64]>,
    [first, last]: [&[f64]; 2],
) -> Option<Growth> {
    let scene = system.configured();
    let mut largest = [0.0_f64; 4];
    let mut energy = 0.0_f64;
    for row in looked {
        let quarter = quarter(row, [first, last]);
        let [kinetic, potential] = Equations::new(scene, row).energy();
        largest[quarter] = largest[quarter].max(kinetic);
        if quarter == 0 {
            energy = energy.max(kinetic).max(potential.abs());
        }
    }
    let grows = |w: &[f64]| w[1] > GROWTH_PER_QUARTER * w[0];
    if !largest.windows(2).all(grows) || largest[3] <= BEYOND_ALL * energy {
        return None;
    }
    Some(Growth {
        factor: largest[3] / energy,
        within: Within::Quarters,
        fed_by: fed_by(system, last),
    })
}

/// Returns the force that feeds a motion at a state: that with the largest power of what changes
/// its sign with the velocities, which springs have none of; where there is none, that with the
/// largest power.
pub(super) fn fed_by(system: &System, numbers: &[f64]) -> Option<ElementId> {
    let scene = system.configured();
    let mut back = numbers.to_vec();
    back[scene.layout.v()].iter_mut().for_each(|v| *v = -*v);
    let [forth, back] = [numbers, &back].map(|row| Equations::new(scene, row));
    let largest = |of: &dyn Fn(&ForceElement) -> f64| {
        let powers = scene.forces.iter().map(|f| (of(f), f.id));
        let fed = powers.filter(|(power, _)| *power > 0.0);
        fed.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, id)| id)
    };
    let damped = |f: &ForceElement| 0.5 * (power(f, &forth) + power(f, &back));
    largest(&damped).or_else(|| largest(&|f| power(f, &forth)))
}

/// Returns the power of a force, and of its reaction on J.
fn power(force: &ForceElement, at: &Equations<'_, f64>) -> f64 {
    let action = force.action(at);
    let i = at.marker(force.i);
    let reacts = force.reaction.is_some();
    let j = force.j.filter(|_| reacts);
    let j = j.map_or_else(MarkerState::ground, |j| at.marker(j));
    let velocity = i.v_GM - j.v_GM - j.w_GM.cross(i.p_GM - j.p_GM);
    action.force.dot(velocity) + action.torque.dot(i.w_GM - j.w_GM)
}
