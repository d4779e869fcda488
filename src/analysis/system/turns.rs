//! Angles whose turns no coordinate knows, counted from one look at them to the next.
//!
//! ```text
//! angle(t₁) = the value nearest to angle(t₀)         where markers have turned by little, and
//!             angle(t₀) + ½ h (rate₀ + rate₁)        agrees with it to a quarter turn
//! ```
//!
//! Looks stand as close together as that takes, whatever the steps of the method and the outputs
//! are. Where the angle decides forces, steps themselves are no longer than the nearest value is
//! the right one.

use super::complaints;
use super::recording::Recording;
use crate::diagnostic::Diagnostic;
use crate::expr::program::Program;
use crate::scene::configuration::Configured;
use crate::scene::equations::TurnedAngle;
use crate::scene::programs::record;
use std::f64::consts::FRAC_PI_2;

/// Turn of the markers between looks, rad: it must not be half a turn.
const TURN_BETWEEN_LOOKS: f64 = 1.5;
/// Turn of the markers within a step in which an angle decides forces, rad: it must not be half a
/// turn.
const TURN_WITHIN_STEP: f64 = 2.5;
/// Difference between the turn of an angle and what its rates say of it, rad, up to which they
/// agree.
const AGREEMENT: f64 = FRAC_PI_2;

/// The counted angles at an instant.
#[derive(Clone, Debug, Default)]
pub struct Look {
    /// when
    pub t: f64,
    /// angles with their turns   (n)   [rad]
    angles: Vec<f64>,
    /// their rates   (n)   [rad/time]
    rates: Vec<f64>,
    /// bound of the speed at which any of the pairs of markers turn   [rad/time]
    pub speed: f64,
    /// bound of the rate of that as far as motions prescribe it   [rad/time²]
    pub driven_acceleration: f64,
}

/// The angles of a configuration whose turns no coordinate knows.
#[derive(Clone, Debug)]
pub(super) struct Turns {
    /// angle, rate, speed and prescribed acceleration of each   (4 n)
    recording: Recording,
    /// places of the angles in the row of numbers   (n)
    places: Vec<usize>,
    /// whether rates or switches read any of them
    pub decide: bool,
}

impl Turns {
    /// Records the angles of a scene; `None` where coordinates know them all. `readers`: programs
    /// of the rates and of the switches.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub fn new(
        scene: Configured<'_>,
        readers: &[&Program],
    ) -> Result<Option<Self>, Vec<Diagnostic>> {
        let starts = scene.configuration.turns.iter().enumerate();
        let unknown = starts.filter(|(_, start)| start.offset.is_none());
        let angles: Vec<usize> = unknown.map(|(k, _)| k).collect();
        if angles.is_empty() {
            return Ok(None);
        }
        let program = record(scene, |at| {
            let all = angles.iter().map(|&k| at.turned_angle(k));
            let numbers = |a: TurnedAngle<_>| [a.angle, a.rate, a.speed, a.driven_acceleration];
            all.flat_map(numbers).collect()
        });
        let places = scene.layout.turns();
        let places: Vec<usize> = angles.iter().map(|k| places.start + k).collect();
        let read = |p: &&Program| places.iter().any(|&place| p.reads(place));
        Ok(Some(Self {
            recording: Recording::new(program.map_err(complaints)?),
            decide: readers.iter().any(read),
            places,
        }))
    }

    /// Looks at the angles at a row of numbers; they count from the last ones taken over.
    pub fn look(&mut self, t: f64, numbers: &[f64], look: &mut Look) {
        look.t = t;
        look.angles.clear();
        look.rates.clear();
        (look.speed, look.driven_acceleration) = (0.0, 0.0);
        for angle in self.recording.run(numbers).chunks_exact(4) {
            look.angles.push(angle[0]);
            look.rates.push(angle[1]);
            look.speed = look.speed.max(angle[2]);
            look.driven_acceleration = look.driven_acceleration.max(angle[3]);
        }
    }

    /// Takes the angles of a look over.
    pub fn take_over(&self, look: &Look, numbers: &mut [f64]) {
        for (&place, &angle) in self.places.iter().zip(&look.angles) {
            if angle.is_finite() {
                numbers[place] = angle;
            }
        }
    }
}

impl Look {
    /// Returns whether the turns of the next look follow from this one.
    pub fn leads_to(&self, next: &Look) -> bool {
        let h = next.t - self.t;
        let turn = self.speed.max(next.speed) * h.abs();
        if turn > TURN_BETWEEN_LOOKS {
            return false;
        }
        let ends = self.angles.iter().zip(&next.angles);
        let rates = self.rates.iter().zip(&next.rates);
        ends.zip(rates).all(|((a, b), (before, after))| {
            let expected = 0.5 * h * (before + after);
            let off = (b - a - expected).abs();
            // an angle without value has no turns
            off.is_nan() || off <= AGREEMENT
        })
    }

    /// Returns how many looks a step takes whose markers turn no faster than this.
    pub fn intervals(turn: f64) -> usize {
        // those that are too few are halved
        (turn / TURN_BETWEEN_LOOKS).ceil().clamp(1.0, 1e6) as usize
    }

    /// Returns how long a step from here may be so that the nearest angles are the right ones.
    pub fn longest_step(&self) -> f64 {
        TURN_WITHIN_STEP / self.speed
    }

    /// Returns the part of a step in which markers turn by so little that the nearest angles are
    /// the right ones; `None`: the whole step. `turn`: a bound of their turn within it, rad.
    pub fn part_of_step(turn: f64) -> Option<f64> {
        // a step is as long as foreseen, but for what accelerates
        (turn > 1.2 * TURN_WITHIN_STEP).then(|| TURN_WITHIN_STEP / turn)
    }
}
