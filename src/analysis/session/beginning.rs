//! The dataset that begins where a simulation has led: parts stand and move as they do there,
//! states of equations and motions have their values, the clock is counted from there.
//!
//! Every program that reads datasets can go on from it. What a dataset has no words for is told.

use super::carried::Carried;
use super::carried::moved;
use super::state::Saved;
use crate::model::{
    Array, ArrayKind, ById, ElementId, ElementKind, LinearSystem, Matrix, Model, TransferFunction,
};
use crate::scene::history::AngleId;
use crate::scene::unknown::{DifferentialId, MotionState, UnknownId};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::fmt;

/// Part of a turn by which rounding puts half a turn beyond itself.
pub(super) const ROUNDING_OF_A_TURN: f64 = 1e-9;

/// A model that begins where a simulation has led.
#[derive(Clone, Debug)]
pub struct Beginning {
    /// the model
    pub model: Model,
    /// the time at which it begins, which its functions read when the clock shows zero
    pub time: f64,
    /// what it does not tell or tells otherwise
    pub changes: Vec<Change>,
}

/// Something of a state that a dataset does not tell, or tells in another way.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// initial conditions of a joint or of a contact on a curve, which were those of another place
    InitialConditions(ElementId),
    /// an angle begins within half a turn of zero: its name, the turns that are left out
    Turns(String, f64),
    /// a TFSISO, which has no initial states, is written as this LSE
    TransferFunction(ElementId, ElementId),
    /// states for which a dataset has no initial values, as the creep of FRICTION
    States(ElementId),
    /// DELAY begins without a past
    Past(String),
    /// a SENSOR has not evaluated anything
    Sensor(ElementId),
    /// discrete states are sampled from the beginning on
    Samples(ElementId),
    /// a routine is told the clock, which begins at zero
    Clock(ElementId),
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Change::InitialConditions(id) => write!(
                f,
                "{id}: its initial conditions are left out, parts have places and velocities"
            ),
            Change::Turns(angle, turns) => {
                write!(
                    f,
                    "{angle} begins within half a turn of zero: {turns} turns are not counted"
                )
            }
            Change::TransferFunction(was, is) => write!(
                f,
                "{was} is written as {is} of the same states, which can begin with their values"
            ),
            Change::States(id) => write!(
                f,
                "{id}: its states begin anew, a dataset has no initial values for them"
            ),
            Change::Past(owner) => write!(f, "{owner}: DELAY begins without its past"),
            Change::Sensor(id) => write!(f, "{id}: the value that it evaluated is not kept"),
            Change::Samples(id) => write!(f, "{id}: it is sampled from the beginning on"),
            Change::Clock(id) => write!(
                f,
                "{id}: its routine is told a clock that begins at zero, if it reads it"
            ),
        }
    }
}

impl Saved {
    /// Returns the model that begins where this state stands; `None` before the first simulation.
    ///
    /// After statics parts have the velocities of the dataset, with which dynamics then begin.
    /// Initial conditions of joints and of contacts on curves, which were those of another place,
    /// are left out. Elements that are switched off stay so in [`Model::inactive`], which a dataset
    /// does not tell.
    ///
    /// # Examples
    /// ```
    /// use cognate::{Analysis, Model, Options, Session};
    /// let model = Model::read("examples/slider_crank.adm")?;
    /// let mut session = Session::new(model, "crank", Options::default());
    /// session.run_to(Analysis::Dynamic, 0.3, 3)?;
    /// let there = session.state().beginning().expect("a simulation has been run");
    /// let mut rest = Session::new(there.model, "rest", Options::default());
    /// rest.run_to(Analysis::Dynamic, 0.7, 7)?;
    /// # Ok::<(), cognate::Error>(())
    /// ```
    pub fn beginning(&self) -> Option<Beginning> {
        let carried = self.carried.as_ref()?;
        let mut changes = left_out(&self.model, carried.at_rest);
        let mut model = moved(&self.model, carried);
        if carried.at_rest {
            begin_from_rest(&mut model, &self.model);
        }
        for contact in model.points_on_curves.values_mut() {
            (contact.start, contact.velocity, contact.start_marker) = (None, None, None);
        }
        for contact in model.curves_on_curves.values_mut() {
            for side in [&mut contact.i, &mut contact.j] {
                (side.start, side.velocity, side.start_marker) = (None, None, None);
            }
        }
        begin_motions(&mut model, carried);
        begin_equations(&mut model, carried, &mut changes);
        changes.extend(turns(carried));
        let past = carried.past.keys();
        changes.extend(past.map(|id| Change::Past(id.owner.clone())));
        let sensors = carried.sensors.iter().filter(|(_, value)| **value != 0.0);
        changes.extend(sensors.map(|(id, _)| Change::Sensor(ElementKind::Sensor.id(*id))));
        let clocks = model.begin_at(carried.t);
        changes.extend(clocks.into_iter().map(Change::Clock));
        Some(Beginning {
            model,
            time: carried.t,
            changes,
        })
    }
}

/// Returns the joints and contacts whose initial conditions, which were those of another place, are
/// left out. After statics the rates of joints stay.
fn left_out(model: &Model, at_rest: bool) -> Vec<Change> {
    let of_joint = |[place, rate]: [Option<f64>; 2]| place.is_some() || rate.is_some() && !at_rest;
    let joints = model.joints.iter();
    let joints = joints.filter(|(_, j)| of_joint(j.ic_translation) || of_joint(j.ic_rotation));
    let points = (model.points_on_curves.iter()).filter(|(_, contact)| contact.start.is_some());
    let curves = model.curves_on_curves.iter();
    let curves = curves.filter(|(_, c)| c.i.start.is_some() || c.j.start.is_some());
    let joints = joints.map(|(&id, _)| ElementKind::Joint.id(id));
    let points = points.map(|(&id, _)| ElementKind::Ptcv.id(id));
    let curves = curves.map(|(&id, _)| ElementKind::Cvcv.id(id));
    let lines = model.beginnings.iter();
    let lines = lines.filter(|(_, values)| values.keys().any(|q| !(at_rest && q.is_rate())));
    let lines = lines.map(|(&id, _)| id);
    let all = joints.chain(points).chain(curves).chain(lines);
    all.map(Change::InitialConditions).collect()
}

/// Lets parts move as the dataset says: a simulation after statics begins with these velocities.
fn begin_from_rest(model: &mut Model, dataset: &Model) {
    let bodies = model.parts.iter_mut().zip(dataset.parts.values());
    let points = model.point_masses.iter_mut();
    let points = points.zip(dataset.point_masses.values());
    for ((_, part), given) in bodies.chain(points) {
        (part.vm, part.wm) = (given.vm, given.wm);
        (part.velocity, part.angular_velocity) = (given.velocity, given.angular_velocity);
    }
    for (joint, given) in model.joints.values_mut().zip(dataset.joints.values()) {
        joint.ic_translation[1] = given.ic_translation[1];
        joint.ic_rotation[1] = given.ic_rotation[1];
    }
    model.beginnings.clone_from(&dataset.beginnings);
    for values in model.beginnings.values_mut() {
        values.retain(|quantity, _| quantity.is_rate());
    }
    model.beginnings.retain(|_, values| !values.is_empty());
}

/// Returns the angles that have turned by more than half a turn.
fn turns(carried: &Carried) -> Vec<Change> {
    let beyond = |angle: f64| angle.abs() > PI + TAU * ROUNDING_OF_A_TURN;
    let all = carried.turns.iter().filter(|(_, angle)| beyond(**angle));
    all.map(|(id, angle): (&AngleId, &f64)| Change::Turns(id.to_string(), (angle / TAU).round()))
        .collect()
}

/// Lets motions given by their rates begin with their displacements and velocities.
fn begin_motions(model: &mut Model, carried: &Carried) {
    for (unknown, value) in carried.values() {
        let UnknownId::Motion { motion, state } = unknown else {
            continue;
        };
        let Some(found) = model.motions.get_mut(&motion.number) else {
            continue;
        };
        match state {
            MotionState::Displacement => found.ic_displacement = Some(value),
            MotionState::Velocity => found.ic_velocity = Some(value),
        }
    }
}

/// Lets differential equations begin with their values.
fn begin_equations(model: &mut Model, carried: &Carried, changes: &mut Vec<Change>) {
    let mut systems: BTreeMap<ElementId, Vec<f64>> = BTreeMap::new();
    for (unknown, value) in carried.values() {
        let UnknownId::Differential(DifferentialId { element, number }) = unknown else {
            continue;
        };
        let is_diff = element.kind == ElementKind::Diff && number.is_none();
        let equation = model.differentials.get_mut(&element.number);
        match equation.filter(|_| is_diff) {
            Some(equation) => equation.ic[0] = Some(value),
            // states come in their order
            None => systems.entry(element).or_default().push(value),
        }
    }
    for (variable, &value) in &carried.guesses {
        if let Some(variable) = model.variables.get_mut(variable) {
            variable.ic = Some(value);
        }
    }
    for (element, states) in systems {
        match element.kind {
            ElementKind::Lse => {
                let ic = initial_array(model, &states);
                if let Some(system) = model.linear_systems.get_mut(&element.number) {
                    system.ic = Some(ic);
                }
            }
            ElementKind::Gse => {
                let ic = initial_array(model, &states);
                if let Some(system) = model.general_systems.get_mut(&element.number) {
                    system.ic = Some(ic);
                }
            }
            ElementKind::Tfsiso if states.iter().any(|x| *x != 0.0) => {
                if let Some(system) = model.transfer_functions.remove(&element.number) {
                    let is = as_linear_system(model, element, system, &states);
                    changes.push(Change::TransferFunction(element, is));
                }
            }
            _ if states.iter().any(|x| *x != 0.0) => changes.push(Change::States(element)),
            _ => {}
        }
    }
    for (&id, held) in &carried.samples {
        let icd = initial_array(model, &held.states);
        if let Some(system) = model.general_systems.get_mut(&id) {
            system.icd = Some(icd);
        }
        changes.push(Change::Samples(ElementKind::Gse.id(id)));
    }
}

/// Adds an array of initial values and returns its number.
fn initial_array(model: &mut Model, values: &[f64]) -> u32 {
    let array = Array {
        size: Some(values.len()),
        kind: ArrayKind::Ic(values.to_vec()),
        ..Array::default()
    };
    add(&mut model.arrays, array)
}

/// Adds an element with the number after the largest, and returns that.
fn add<T>(all: &mut ById<T>, element: T) -> u32 {
    let number = all
        .last_key_value()
        .map_or(1, |(last, _)| last.saturating_add(1));
    all.insert(number, element);
    number
}

/// Writes a transfer function as the linear system of the same states:
///
/// ```text
/// ẋ_k = x_{k+1}      ẋ_n = (u − a0 x1 − a1 x2 …)/a_n
/// y = Σ (b_k − a_k d) x_{k+1} + d u                   d = b_n/a_n
/// ```
///
/// Arrays keep their numbers, so that all that reads them stays as it is.
fn as_linear_system(
    model: &mut Model,
    was: ElementId,
    system: TransferFunction,
    states: &[f64],
) -> ElementId {
    let n = states.len();
    let at = |all: &[f64], k: usize| all.get(k).copied().unwrap_or(0.0);
    let (a, b) = (&system.denominator, &system.numerator);
    let last = at(a, n);
    let through = at(b, n) / last;
    let mut rates = vec![0.0; n * n];
    for k in 1..n {
        rates[(k - 1) * n + k] = 1.0;
    }
    for k in 0..n {
        rates[(n - 1) * n + k] = -at(a, k) / last;
    }
    let mut inputs = vec![0.0; n];
    inputs[n - 1] = 1.0 / last;
    let outputs = (0..n).map(|k| at(b, k) - at(a, k) * through).collect();
    let mut matrix = |rows: usize, columns: usize, values: Vec<f64>| {
        let matrix = Matrix {
            rows,
            columns,
            values,
            ..Matrix::default()
        };
        add(&mut model.matrices, matrix)
    };
    let (a, b) = (matrix(n, n, rates), matrix(n, 1, inputs));
    let (c, d) = (matrix(1, n, outputs), matrix(1, 1, vec![through]));
    let linear = LinearSystem {
        place: system.place,
        x: system.x,
        u: Some(system.u),
        y: Some(system.y),
        ic: Some(initial_array(model, states)),
        a,
        b: Some(b),
        c: Some(c),
        d: Some(d),
        static_hold: system.static_hold,
    };
    let number = match model.linear_systems.contains_key(&was.number) {
        false => {
            model.linear_systems.insert(was.number, linear);
            was.number
        }
        true => add(&mut model.linear_systems, linear),
    };
    let is = ElementKind::Lse.id(number);
    if model.inactive.remove(&was) {
        model.inactive.insert(is);
    }
    is
}
