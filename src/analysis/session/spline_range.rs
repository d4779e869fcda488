//! Splines that are read outside their data, where what they yield is extrapolated: their arguments
//! are evaluated at the ends of steps and at the rows of results.

use super::Session;
use crate::analysis::system::System;
use crate::analysis::time::counting::Counting;
use crate::analysis::warning::RunWarning;
use crate::expr::ast::{Callee, Node};
use crate::expr::interpolation::Interpolation;
use crate::expr::program::{Program, Work};
use crate::model::{ElementId, ElementKind, Family, Formula, Model, Text};
use crate::scene::layout::Layout;
use crate::scene::programs::record_with_complaints;
use crate::scene::recorder::{self, Recorder};

/// Distance outside the data, relative to their range, that rounding makes.
const ROUNDING: f64 = 1e-9;
/// Times at which arguments that time alone decides are looked at before a run.
const LOOKS_AHEAD: usize = 256;

/// A call that reads a spline of the dataset.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SplineCall {
    /// whose function it is
    element: ElementId,
    /// user's number of the SPLINE
    spline: u32,
    /// its first argument
    at: Text,
    /// first and last X of the data
    range: [f64; 2],
}

impl SplineCall {
    /// Returns the argument as an expression to be compiled with a scene, and its name.
    pub fn extra(&self) -> (String, Text) {
        let name = format!("{} {}", self.element, ElementKind::Spline.id(self.spline));
        (name, self.at.clone())
    }
}

/// Collects the calls of splines in the functions that move the model, each argument once.
pub(super) fn spline_calls(model: &Model) -> Vec<SplineCall> {
    let mut all: Vec<SplineCall> = Vec::new();
    if model.splines.is_empty() {
        return all;
    }
    for owned in model.formulas() {
        let moves = owned.element.kind.family() != Family::Output && model.is_active(owned.element);
        let Formula::Expression { text, .. } = owned.formula else {
            continue;
        };
        let Some(ast) = text.ast().ok().filter(|_| moves) else {
            continue;
        };
        for node in &ast.nodes {
            let Node::Call {
                callee:
                    callee @ Callee::Interpolation(
                        Interpolation::Akispl | Interpolation::Cubspl | Interpolation::Interp,
                    ),
                args,
            } = node
            else {
                continue;
            };
            let [x, method, id, ..] = args[..] else {
                continue;
            };
            if holds(ast.node(method), *callee) {
                continue;
            }
            let Node::Number { literal, .. } = *ast.node(id) else {
                continue;
            };
            let data = model.splines.get(&(literal as u32));
            let ends = data.and_then(|s| Some([*s.x.first()?, *s.x.last()?]));
            let Some(range) = ends else { continue };
            let call = SplineCall {
                element: owned.element,
                spline: literal as u32,
                at: Text::from(ast.written(x)),
                range,
            };
            if !all.contains(&call) {
                all.push(call);
            }
        }
    }
    all
}

/// Returns whether a call holds the ends of its data beyond them: INTERP by method 0.
fn holds(method: &Node, callee: Callee) -> bool {
    let is_zero = matches!(method, Node::Number { literal, .. } if *literal == 0.0);
    is_zero && callee == Callee::Interpolation(Interpolation::Interp)
}

/// The arguments of splines over the rows of a simulation.
#[derive(Default)]
pub(super) struct Readings {
    calls: Vec<SplineCall>,
    /// the arguments; `None`: nothing reads a spline
    program: Option<Program>,
    /// by call: the first time outside, and the value that is farthest from the data
    outside: Vec<Option<(f64, f64)>>,
    work: Work,
    values: Vec<f64>,
}

impl Readings {
    /// Evaluates the arguments at all numbers of a state.
    pub fn see(&mut self, numbers: &[f64]) {
        let Some(program) = &self.program else {
            return;
        };
        self.values.resize(self.calls.len(), 0.0);
        program.run(numbers, &mut self.work, &mut self.values);
        let calls = self.calls.iter().zip(&self.values);
        for ((call, &value), seen) in calls.zip(&mut self.outside) {
            note(seen, call, numbers[Layout::TIME], value);
        }
    }

    /// Looks at the arguments that time alone decides, as markers that motions move do, until
    /// `end`; angles count their turns on the way.
    pub fn see_driven(&mut self, system: &System, formulas: &[usize], end: f64) {
        if formulas.is_empty() {
            return;
        }
        let mut system = system.clone();
        let l = system.scene.layout;
        let is_known = |program: &Program| {
            let mut places = (0..system.numbers.len()).filter(|&place| program.reads(place));
            places.all(|place| place == Layout::TIME || l.turns().contains(&place))
        };
        // all of one instant, which is recorded once
        let builder = recorder::builder();
        let recorder = Recorder::new(system.configured(), &builder);
        let program = |value| recorder.program_with_complaints(&[value]).0;
        // angles that follow from time and from their own turns
        let mut driven: Vec<Option<bool>> = vec![None; l.turns().len()];
        let mut is_driven = |k: usize| {
            let angle = || program(recorder.at().turned_angle(k).angle);
            *driven[k].get_or_insert_with(|| is_known(&angle()))
        };
        let programs = (formulas.iter().enumerate()).filter_map(|(call, &formula)| {
            let program = program(recorder.at().formula(formula));
            let mut turns = l.turns().enumerate();
            let all_driven =
                is_known(&program) && turns.all(|(k, place)| !program.reads(place) || is_driven(k));
            all_driven.then_some((call, program))
        });
        let programs: Vec<(usize, Program)> = programs.collect();
        if programs.is_empty() {
            return;
        }
        let start = system.numbers[Layout::TIME];
        let y = system.numbers[l.y()].to_vec();
        let mut counting = Counting::default();
        counting.begin(&mut system, start, &y);
        for k in 1..=LOOKS_AHEAD {
            let t = start + (end - start) * k as f64 / LOOKS_AHEAD as f64;
            counting.count(&mut system, t, &mut |_, _, _| true);
            system.set(t, &y);
            for (call, program) in &programs {
                let value = program.value(&system.numbers, &mut self.work);
                note(&mut self.outside[*call], &self.calls[*call], t, value);
            }
        }
    }
}

/// Takes note of the value of an argument outside the data of its spline.
fn note(seen: &mut Option<(f64, f64)>, call: &SplineCall, t: f64, value: f64) {
    let beyond = |x: f64| (call.range[0] - x).max(x - call.range[1]);
    if beyond(value) > ROUNDING * (call.range[1] - call.range[0]) {
        let (since, worst) = seen.unwrap_or((t, value));
        let farther = beyond(value) > beyond(worst);
        *seen = Some((since.min(t), if farther { value } else { worst }));
    }
}

impl Session {
    /// Returns the calls of splines, and the formulas of their arguments in a scene.
    fn calls_in<'s>(&self, system: &'s System) -> (Vec<SplineCall>, &'s [usize]) {
        let calls = spline_calls(&self.model);
        let first = self.columns.extra.len();
        let formulas = system.scene.extra.get(first..first + calls.len());
        (calls, formulas.unwrap_or_default())
    }

    /// Looks at the arguments of splines at the start, and until `end` where time alone decides
    /// them.
    pub(super) fn readings_ahead(&self, system: &System, end: f64) -> Readings {
        let mut readings = self.readings(system);
        readings.see(&system.numbers);
        readings.see_driven(system, self.calls_in(system).1, end);
        readings
    }

    /// Prepares to watch the arguments of splines.
    pub(super) fn readings(&self, system: &System) -> Readings {
        let (calls, formulas) = self.calls_in(system);
        if formulas.is_empty() {
            return Readings::default();
        }
        let (program, _) = record_with_complaints(system.configured(), |at| {
            formulas.iter().map(|&f| at.formula(f)).collect()
        });
        Readings {
            outside: vec![None; calls.len()],
            program: Some(program),
            calls,
            ..Readings::default()
        }
    }

    /// Warns of splines that were read outside their data.
    pub(super) fn warn_of_splines(&mut self, readings: Readings) {
        for (call, seen) in readings.calls.into_iter().zip(readings.outside) {
            let Some((since, value)) = seen else { continue };
            self.warn(RunWarning::OutsideData {
                element: call.element,
                spline: call.spline,
                range: call.range,
                value,
                since,
            });
        }
    }
}
