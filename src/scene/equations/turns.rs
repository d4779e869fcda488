//! Angles with their turns.

use super::Equations;
use crate::expr::measures::Measure;
use crate::expr::program::Input;
use crate::scalar::{Jet, Scalar};
use crate::scene::asker::Asker;
use crate::scene::history::AngleId;
use crate::scene::{CoordinateSum, Source};

/// An angle whose turns are counted, and how fast it changes.
#[derive(Clone, Copy, Debug)]
pub struct TurnedAngle<S> {
    /// the angle with its turns   \[rad\]
    pub angle: S,
    /// its rate   [rad/time]
    pub rate: S,
    /// bound of the speed at which its markers turn against each other   [rad/time]
    pub speed: S,
    /// bound of the rate of that speed as far as motions prescribe it   [rad/time²]
    pub driven_acceleration: S,
}

impl<S: Scalar> Equations<'_, S> {
    /// Returns an angle with its turns: from the coordinates that know them, else the value
    /// nearest to the one last accepted.
    pub(super) fn turned(&self, angle: AngleId, principal: S) -> S {
        let Some(k) = self.scene.counted.iter().position(|c| c.id == angle) else {
            return principal;
        };
        if let (Some(sum), Some(offset)) = (
            &self.scene.counted[k].coordinates,
            self.configuration.turns[k].offset,
        ) {
            return self.sum_of_coordinates(sum) + S::constant(offset);
        }
        let turn = std::f64::consts::TAU;
        let turns = (self.now.turns[k] - principal).scale(1.0 / turn).round();
        principal + turns.scale(turn)
    }

    /// Returns the value of a sum of coordinates.
    pub fn sum_of_coordinates(&self, sum: &CoordinateSum) -> S {
        let constant = S::constant(sum.constant);
        let terms = sum.terms.iter();
        terms.fold(constant, |value, &(c, factor)| {
            value + self.coordinate(c).value.scale(factor)
        })
    }

    /// Returns an angle whose turns are counted by its index in
    /// [`Scene::counted`](crate::scene::Scene::counted), with what bounds its change.
    pub fn turned_angle(&self, k: usize) -> TurnedAngle<S> {
        let counted = &self.scene.counted[k];
        let (mut speed, mut driven_acceleration) = (S::zero(), S::zero());
        for &c in &counted.between {
            match self.scene.coordinates[c].source {
                Source::Free { v, .. } => speed += self.now.v[v].abs(),
                Source::Driven(m) => {
                    speed += self.driven[m].first.abs();
                    driven_acceleration += self.driven[m].second.abs();
                }
            }
        }
        TurnedAngle {
            angle: self.counted(counted.id),
            rate: self
                .angle_in_time(counted.id)
                .map_or(S::zero(), |jet| jet.first),
            speed,
            driven_acceleration,
        }
    }

    /// Returns the value of an angle whose turns are counted.
    pub fn counted(&self, angle: AngleId) -> S {
        match angle {
            AngleId::Measure(measure, ids) => {
                let asks = Input::Measure(measure, ids);
                let mut formulas = self.scene.formulas.iter();
                let asked_by = formulas.find(|f| f.program.inputs().contains(&asks));
                let equations = Asker::Measure(measure);
                self.measure(measure, ids, asked_by.map_or(&equations, |f| &f.owner))
            }
            AngleId::Gauge { .. } => {
                let jet = self.angle_in_time(angle);
                jet.map_or(S::constant(f64::NAN), |jet| jet.value)
            }
        }
    }

    /// Returns an angle with its rate; `None`: a marker floats along a curve.
    fn angle_in_time(&self, angle: AngleId) -> Option<Jet<S>> {
        match angle {
            AngleId::Measure(measure, ids) => self.place_in_time(measure, ids),
            AngleId::Gauge { gauge, markers } => {
                let marker = |id: u32| self.scene.marker_of.get(&id).map(|&m| self.marker(m));
                let [i, j] = markers.map(marker);
                let mut jet = gauge.value(&i?.in_time(), &j?.in_time());
                jet.value = self.turned(angle, jet.value);
                Some(jet)
            }
        }
    }

    /// AX, AY or AZ of one marker against another, with its turns.
    pub fn angle_between(&self, measure: Measure, i: usize, j: Option<usize>) -> S {
        let id = |m: usize| self.scene.markers[m].id;
        self.measure(
            measure,
            [id(i), j.map_or(0, id), 0, 0],
            &Asker::Measure(measure),
        )
    }
}
