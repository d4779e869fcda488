//! Measures, which the functions of the model read: displacements, velocities, accelerations,
//! angles with their turns, values of system elements.

use super::{Equations, Lack};
use crate::expr::measures::{Family, Measure, orientation_components};
use crate::model::ElementKind;
use crate::physics::kinematic;
use crate::scalar::Scalar;
use crate::scene::Entry;
use crate::scene::asker::Asker;
use crate::scene::history::AngleId;
use crate::scene::loops::Key;

impl<S: Scalar> Equations<'_, S> {
    /// Value of a measure.
    pub fn measure(&self, measure: Measure, ids: [u32; 4], asked_by: &Asker) -> S {
        self.unknown(Key::Measure(measure, ids))
            .unwrap_or_else(|| self.measure_itself(measure, ids, asked_by))
    }

    /// Evaluates a measure, also where a load reads it.
    pub(super) fn measure_itself(&self, measure: Measure, ids: [u32; 4], asked_by: &Asker) -> S {
        if self.scene.gone(measure, &ids).is_some() {
            return S::zero();
        }
        let row = measure.row();
        match row.family {
            Family::Displacement | Family::Velocity => {
                let state = |id: u32| self.marker_by_id(id, false);
                match kinematic::kinematic_of(measure, ids, state) {
                    Some(value) if measure.counts_turns() => {
                        self.turned(AngleId::Measure(measure, ids), value)
                    }
                    Some(value) => value,
                    None => self.complain(asked_by, without_value(measure, ids)),
                }
            }
            Family::Acceleration => {
                if self.scratch.solving.get() {
                    let key = Key::Measure(measure, ids);
                    return self.too_early(key, asked_by, Lack::OwnAcceleration(measure));
                }
                if self.discovering {
                    return S::zero();
                }
                let state = |id: u32| self.marker_by_id(id, true);
                kinematic::kinematic_of(measure, ids, state)
                    .unwrap_or_else(|| self.complain(asked_by, Lack::Marker(measure)))
            }
            Family::GenericForce => self.generic_force(measure, ids, asked_by),
            Family::ElementForce => self.element_force(measure, ids, asked_by),
            Family::System => self.system(measure, ids, asked_by),
        }
    }

    /// Value of a variable of a joint: its index in
    /// [`Scene::joint_variables`](crate::scene::Scene::joint_variables).
    pub fn joint_variable(&self, k: usize) -> S {
        let variable = &self.scene.joint_variables[k];
        self.displacement(&variable.displacement).value
    }

    pub(super) fn system(&self, measure: Measure, [id, k, ..]: [u32; 4], asked_by: &Asker) -> S {
        let scene = self.scene;
        match measure {
            Measure::Varval => match scene.variables.get(&id) {
                Some(&f) => self.formula(f),
                None => self.complain(asked_by, Lack::Element(ElementKind::Variable.id(id))),
            },
            Measure::Aryval => match self.entry(id, k) {
                Some(Entry::Number(x)) => S::constant(x),
                Some(Entry::State(d)) => self.state_of(d),
                Some(Entry::Formula(f)) => self.formula(f),
                None => {
                    let element = ElementKind::Array.id(id);
                    self.complain(asked_by, Lack::Entry { element, entry: k })
                }
            },
            Measure::Pinval | Measure::Pouval => {
                let element = match measure {
                    Measure::Pouval => ElementKind::Poutput.id(id),
                    _ => ElementKind::Pinput.id(id),
                };
                match scene.plant_formula(measure, id, k) {
                    Some(f) => self.formula(f),
                    None => self.complain(asked_by, Lack::Entry { element, entry: k }),
                }
            }
            Measure::Senval => match scene.sensor_place(id) {
                Some(place) => self.now.external[place],
                None => self.complain(asked_by, Lack::Element(ElementKind::Sensor.id(id))),
            },
            Measure::Dif | Measure::Dif1 => match scene.differential(id) {
                Some(d) if measure == Measure::Dif => self.state_of(d),
                Some(d) => self.rate_of(d),
                None => self.complain(asked_by, Lack::Element(ElementKind::Diff.id(id))),
            },
            _ => self.complain(asked_by, Lack::Measure(measure)),
        }
    }

    /// Value of a differential equation.
    pub(super) fn state_of(&self, d: usize) -> S {
        let unknown = || self.unknown(Key::Value(d)).unwrap_or_else(S::zero);
        self.scene.differentials[d]
            .state
            .map_or_else(unknown, |s| self.now.x[s])
    }

    /// Rate of a differential equation.
    pub(super) fn rate_of(&self, d: usize) -> S {
        let equation = &self.scene.differentials[d];
        match (equation.implicit, equation.state) {
            (false, _) => self.formula(equation.formula),
            (true, None) => self.algebraic_rate(d),
            // at rest there is no rate
            (true, Some(_)) => self.unknown(Key::Rate(d)).unwrap_or_else(S::zero),
        }
    }
}

/// Names what a measure of markers lacks: a marker, or ORIENT a meaning of what it is asked for.
fn without_value(measure: Measure, ids: [u32; 4]) -> Lack {
    match (measure, ids) {
        (Measure::Orient, [system @ (25 | 26), component, ..]) => {
            Lack::Orientation { system, component }
        }
        (Measure::Orient, [system, component, ..])
            if component > orientation_components(system) =>
        {
            Lack::OrientationComponent { system, component }
        }
        _ => Lack::Marker(measure),
    }
}
