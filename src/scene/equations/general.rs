//! Rows that are written as expressions: what a function of places does when its markers move.
//!
//! ```text
//! e = e(m₁ … m_k)     δe = Σ ∂e/∂mᵢ δmᵢ      δmᵢ = wrenchᵢ · twists of its markers
//! ```
//!
//! The partial derivatives come from the gradient of the function's program, the wrenches from each
//! measure over duals along the twists of the markers it reads, the rates from both over jets.
//!
//! Where an equation reads velocities mᵢ may be one of these, and δ its change with the velocities
//! of the markers, wherever they are: the force of such a row is λ ∂e/∂(velocity).

use super::rows::{seed, twist};
use super::{Equations, RowValue, formulas};
use crate::expr::measures::{Family, Measure};
use crate::expr::program::{Input, Work};
use crate::physics::action::Action;
use crate::physics::kinematic;
use crate::scalar::{Dual, Jet, Scalar};
use crate::scene::Entry;
use crate::scene::history::AngleId;
use crate::space::{Frame, MarkerState, Mat3, Vec3};
use std::collections::HashMap;

/// Most markers that one measure reads: a velocity does, a displacement or an angle one fewer.
const MAX_MARKERS: usize = 4;

/// A function of places or velocities: its value with rates in time, and what a unit multiplier on
/// it exerts.
#[derive(Clone)]
struct Traced<S> {
    jet: Jet<S>,
    actions: Vec<(usize, Action<S>)>,
}

impl<S: Scalar> Traced<S> {
    fn nothing() -> Self {
        Self::of_time(formulas::nothing())
    }
    fn of_time(jet: Jet<S>) -> Self {
        Self {
            jet,
            actions: Vec::new(),
        }
    }
}

impl<S: Scalar> Equations<'_, S> {
    /// A row that says that a formula of places, or one of velocities, is zero.
    pub(super) fn formula_row(&self, formula: usize, of_velocities: bool) -> RowValue<S> {
        let Traced { jet, actions } = self.traced(formula, of_velocities);
        let gradient = self.gradient_of(&actions);
        if of_velocities {
            return RowValue {
                value: S::zero(),
                drift: jet.value - self.along(&gradient),
                gradient,
                gamma: -jet.first,
                actions,
            };
        }
        RowValue {
            value: jet.value,
            drift: jet.first - self.along(&gradient),
            gradient,
            gamma: -jet.second,
            actions,
        }
    }

    fn traced(&self, formula: usize, of_velocities: bool) -> Traced<S> {
        let found = self.found_in_order(formula, |formula, read: &HashMap<usize, Traced<S>>| {
            let program = &self.scene.formulas[formula].program;
            let inputs = program.inputs().iter();
            let inputs: Vec<Traced<S>> = inputs
                .map(|&input| match self.written_as(input) {
                    Some(formula) => read.get(&formula).cloned(),
                    None => self.traced_input(input, of_velocities),
                })
                .map(|traced| traced.unwrap_or_else(Traced::nothing))
                .collect();
            let jets: Vec<Jet<S>> = inputs.iter().map(|i| i.jet).collect();
            let mut out = [Jet::zero()];
            program.eval(&jets, &mut Work::default(), &mut out);
            Traced {
                jet: out[0],
                actions: self.chained(formula, &inputs),
            }
        });
        found.unwrap_or_else(Traced::nothing)
    }

    /// An input that is no formula; `None`: it is no function of places or velocities.
    fn traced_input(&self, input: Input, of_velocities: bool) -> Option<Traced<S>> {
        match input {
            Input::Time => Some(Traced::of_time(Jet::variable(self.now.t))),
            Input::Mode => Some(Traced::of_time(Jet::constant(self.scene.mode))),
            Input::Measure(Measure::Aryval, [id, k, ..]) => match self.entry(id, k)? {
                Entry::Number(x) => Some(Traced::of_time(Jet::constant(x))),
                Entry::State(_) | Entry::Formula(_) => None,
            },
            Input::Measure(measure, ids) if of_velocities => match measure.row().family {
                Family::Displacement => self.place_in_time(measure, ids).map(Traced::of_time),
                _ => self.traced_velocity(measure, ids),
            },
            Input::Measure(measure, ids) => self.traced_measure(measure, ids),
            Input::Delayed(_) | Input::Slot(_) => None,
        }
    }

    /// `Σ ∂e/∂mᵢ wrenchᵢ`, by markers.
    fn chained(&self, formula: usize, inputs: &[Traced<S>]) -> Vec<(usize, Action<S>)> {
        let Some(program) = &self.scene.formulas[formula].gradient else {
            return Vec::new();
        };
        let values: Vec<S> = inputs.iter().map(|i| i.jet.value).collect();
        let mut out = vec![S::zero(); 1 + inputs.len()];
        program.eval(&values, &mut Work::default(), &mut out);
        let mut sum: Vec<(usize, Action<S>)> = Vec::new();
        for (input, &partial) in inputs.iter().zip(&out[1..]) {
            for (m, action) in &input.actions {
                let part = Action {
                    force: action.force.times(partial),
                    torque: action.torque.times(partial),
                };
                match sum.iter_mut().find(|s| s.0 == *m) {
                    Some(entry) => entry.1 = entry.1.plus(&part),
                    None => sum.push((*m, part)),
                }
            }
        }
        sum
    }

    /// A displacement or an angle with its rates; `None`: a marker is missing, or it is no function
    /// of places.
    pub(super) fn place_in_time(&self, measure: Measure, ids: [u32; 4]) -> Option<Jet<S>> {
        let index = |id: u32| self.scene.marker_of.get(&id).copied();
        let mut jet = kinematic::kinematic_of(measure, ids, |id| {
            Some(MarkerState::at_rest(self.marker(index(id)?).in_time()))
        })?;
        if measure.counts_turns() {
            jet.value = self.turned(AngleId::Measure(measure, ids), jet.value);
        }
        Some(jet)
    }

    /// A displacement or an angle; `None`: a marker is missing, or it is no function of places.
    fn traced_measure(&self, measure: Measure, ids: [u32; 4]) -> Option<Traced<S>> {
        let index = |id: u32| self.scene.marker_of.get(&id).copied();
        let jet = self.place_in_time(measure, ids)?;
        let mut read: Vec<usize> = Vec::new();
        let seeded = kinematic::kinematic_of(measure, ids, |id| {
            let m = index(id)?;
            let k = read.iter().position(|&r| r == m).unwrap_or_else(|| {
                read.push(m);
                read.len() - 1
            });
            (k < MAX_MARKERS - 1).then(|| {
                MarkerState::at_rest(seed::<{ 6 * (MAX_MARKERS - 1) }, S>(&self.marker(m), 6 * k))
            })
        })?;
        let actions = read
            .iter()
            .enumerate()
            .map(|(k, &m)| (m, twist(&seeded, 6 * k)))
            .collect();
        Some(Traced { jet, actions })
    }

    /// A velocity, its rate without v̇, and what it changes by with the velocities of its markers;
    /// `None`: a marker is missing.
    fn traced_velocity(&self, measure: Measure, ids: [u32; 4]) -> Option<Traced<S>> {
        let index = |id: u32| self.scene.marker_of.get(&id).copied();
        let jet = kinematic::kinematic_of(measure, ids, |id| {
            Some(self.marker(index(id)?).moving_in_time())
        })?;
        let mut read: Vec<usize> = Vec::new();
        let seeded = kinematic::kinematic_of(measure, ids, |id| {
            let m = index(id)?;
            let k = read.iter().position(|&r| r == m).unwrap_or_else(|| {
                read.push(m);
                read.len() - 1
            });
            (k < MAX_MARKERS)
                .then(|| seed_of_velocity::<{ 6 * MAX_MARKERS }, S>(&self.marker(m), 6 * k))
        })?;
        let actions = (read.iter().enumerate()).map(|(k, &m)| (m, twist(&seeded, 6 * k)));
        Some(Traced {
            jet,
            actions: actions.collect(),
        })
    }
}

/// A marker that stays where it is and moves otherwise along six directions, the first of which is
/// direction `first`: angular velocities, then velocities.
fn seed_of_velocity<const N: usize, S: Scalar>(
    m: &MarkerState<S>,
    first: usize,
) -> MarkerState<Dual<N, S>> {
    let lift = |x: S| Dual {
        re: x,
        eps: [S::zero(); N],
    };
    let seeded = |x: Vec3<S>, first: usize| {
        let mut x = Vec3(x.0.map(lift));
        (0..3).for_each(|k| x.0[k].eps[first + k] = S::one());
        x
    };
    MarkerState {
        w_GM: seeded(m.w_GM, first),
        v_GM: seeded(m.v_GM, first + 3),
        ..MarkerState::at_rest(Frame {
            rotation: Mat3(m.R_GM.0.map(|r| r.map(lift))),
            position: Vec3(m.p_GM.0.map(lift)),
        })
    }
}
