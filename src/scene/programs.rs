//! The equations of a scene as straight-line programs: run once over recording numbers, then as
//! often as needed.

use super::Scene;
use super::configuration::Configured;
use super::equations::{Equations, STATIC, Unsupported};
use super::layout::{Layout, LongRow};
use super::loops;
use super::recorder::Recorder;
use super::solve::{SymmetricFactor, gram};
use crate::arrange::Arrange;
use crate::expr::program::{Builder, Folding, Input, Levels, Program, Sym, Value};
use crate::model::ElementId;
use crate::scalar::Scalar;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

/// Records what `f` computes from the instant it is given. The program reads the row of numbers
/// that [`Layout`] describes.
///
/// # Errors
/// Functions ask for what the equations cannot supply.
pub fn record<F>(scene: Configured<'_>, f: F) -> Result<Program, Vec<Unsupported>>
where
    F: for<'b> FnOnce(&Equations<'_, Sym<'b>>) -> Vec<Sym<'b>>,
{
    let (program, complaints) = record_with_complaints(scene, f);
    if complaints.is_empty() {
        Ok(program)
    } else {
        Err(complaints)
    }
}

/// As [`record`]; what could not be computed is NaN in the program, and told.
pub fn record_with_complaints<F>(scene: Configured<'_>, f: F) -> (Program, Vec<Unsupported>)
where
    F: for<'b> FnOnce(&Equations<'_, Sym<'b>>) -> Vec<Sym<'b>>,
{
    record_more(scene, 0, |at, _| f(at))
}

/// As [`record_with_complaints`], for programs that read `n_more` further numbers after those of
/// the layout.
pub fn record_more<F>(scene: Configured<'_>, n_more: usize, f: F) -> (Program, Vec<Unsupported>)
where
    F: for<'b> FnOnce(&Equations<'_, Sym<'b>>, &[Sym<'b>]) -> Vec<Sym<'b>>,
{
    let (mut programs, complaints) =
        recorded(scene, n_more, false, false, f, |_, values| vec![values]);
    (programs.remove(0), complaints)
}

/// As [`record_with_complaints`], with velocities that are read at rest as well: what would change
/// if it moved.
pub fn record_moving<F>(scene: Configured<'_>, f: F) -> Program
where
    F: for<'b> FnOnce(&Equations<'_, Sym<'b>>) -> Vec<Sym<'b>>,
{
    let (mut programs, _) = recorded(
        scene,
        0,
        false,
        true,
        |at, _| f(at),
        |_, values| vec![values],
    );
    programs.remove(0)
}

/// Records what `f` computes, and what `end` makes of the values: a program for each of its lists.
/// The unknowns of linear loops are eliminated; where `known`, those of all loops are read after
/// the numbers of the layout. `moving`: velocities are not taken as zero at rest.
fn recorded<F, E>(
    scene: Configured<'_>,
    n_more: usize,
    known: bool,
    moving: bool,
    f: F,
    end: E,
) -> (Vec<Program>, Vec<Unsupported>)
where
    F: for<'b> FnOnce(&Equations<'_, Sym<'b>>, &[Sym<'b>]) -> Vec<Sym<'b>>,
    E: FnOnce(&mut Builder, Vec<Value>) -> Vec<Vec<Value>>,
{
    let (mut f, mut end) = (Some(f), Some(end));
    recorded_by(
        scene,
        n_more,
        known,
        moving,
        &mut |equations, more| match f.take() {
            Some(f) => f(equations, more),
            None => unreachable!("what is recorded is computed once"),
        },
        &mut |builder, values| match end.take() {
            Some(end) => end(builder, values),
            None => unreachable!("what is recorded ends once"),
        },
    )
}

/// A computation that is recorded, over the symbols of any recorder.
type Recorded<'f> = dyn for<'b> FnMut(&Equations<'_, Sym<'b>>, &[Sym<'b>]) -> Vec<Sym<'b>> + 'f;

/// An end of a recording, which makes lists of the values.
type End<'f> = dyn FnMut(&mut Builder, Vec<Value>) -> Vec<Vec<Value>> + 'f;

/// As [`recorded`]; compiled once.
fn recorded_by(
    scene: Configured<'_>,
    n_more: usize,
    known: bool,
    moving: bool,
    f: &mut Recorded<'_>,
    end: &mut End<'_>,
) -> (Vec<Program>, Vec<Unsupported>) {
    let builder = RefCell::new(Builder::again_or_new(Folding::Structural));
    let row = LongRow {
        numbers: scene.layout,
        n_more,
        n_sides: 0,
    };
    let layout = inputs_of(row);
    let mut numbers: Vec<Sym<'_>> = layout
        .iter()
        .map(|&input| Sym::input(input, &builder))
        .collect();
    if scene.mode == STATIC && !moving {
        numbers[scene.layout.v()].fill(Sym::Constant(0.0));
    }
    let mut solved = numbers[scene.layout.loops()].to_vec();
    let (of_state, more) = row.split(&numbers);
    if known {
        solved = more[..scene.loops.len()].to_vec();
    } else if scene.layout.n_loops == 0 && !scene.loops.is_empty() {
        solved = loops::eliminated(scene, &numbers, &builder);
    }
    let equations = Equations::with_unknowns(scene, of_state, solved, false);
    let out = f(&equations, more);
    let recorder = &mut *builder.borrow_mut();
    let values: Vec<_> = out.iter().map(|s| s.value(recorder)).collect();
    let lists = end(recorder, values);
    let finish = |values: &Vec<Value>| recorder.finish_with_inputs(values, &layout);
    (lists.iter().map(finish).collect(), equations.complaints())
}

/// Returns the inputs of a program that reads a row.
fn inputs_of(row: LongRow) -> Vec<Input> {
    (0..row.len()).map(|k| Input::Slot(k as u32)).collect()
}

/// Returns how many operations each force, equation and row adds to the rates, the most first. An
/// operation that several need counts for the first of them: forces, then equations, then rows.
pub fn costs(scene: Configured<'_>) -> Vec<(ElementId, usize)> {
    let builder = RefCell::new(Builder::new(Folding::Structural));
    let inputs = (0..scene.layout.len()).map(|k| Input::Slot(k as u32));
    let numbers: Vec<Sym<'_>> = inputs.map(|input| Sym::input(input, &builder)).collect();
    let at = Equations::new(scene, &numbers);
    let mut costs: BTreeMap<ElementId, usize> = BTreeMap::new();
    let mut count = |element: ElementId, record: &dyn Fn()| {
        let before = builder.borrow().len();
        record();
        *costs.entry(element).or_default() += builder.borrow().len() - before;
    };
    for force in &scene.forces {
        count(force.id, &|| {
            force.action(&at);
        });
    }
    let is_upstream = |state: usize| state < scene.layout.n_upstream();
    let equations = scene.differentials.iter();
    for equation in equations.filter(|d| d.state.is_none_or(is_upstream)) {
        count(equation.id.element, &|| {
            at.formula(equation.formula);
        });
    }
    for r in (0..scene.rows.len()).filter(|&r| at.is_active(r)) {
        count(scene.rows[r].element, &|| {
            at.row(r);
        });
    }
    let mut costs: Vec<(ElementId, usize)> = costs.into_iter().collect();
    costs.arrange_by_key(|cost| std::cmp::Reverse(cost.1));
    costs
}

/// Where loads, differential equations and motions change branch.
#[derive(Clone, Debug)]
pub struct Switching {
    /// one value per switch, changing sign there; reads what the held rates read
    pub switches: Program,
    /// the unknowns of linear loops, as the state says
    pub unknowns: Option<Program>,
    /// the rates with every branch as the sign of its switch says: reads the unknowns of all loops,
    /// then one sign per switch (−1, 0, 1) after the layout's numbers
    pub held: Option<Program>,
    /// residuals of the loops with branches held; reads the same
    pub held_loops: Option<Program>,
    /// for each sensor, whether what it watches is beyond its value with branches held (0, 1);
    /// reads the same
    pub held_sensors: Option<Program>,
}

/// Returns the numbers that loads and differential equations are made of: where these change
/// branch, so do the rates.
pub(super) fn sources<S: Scalar>(at: &Equations<'_, S>, scene: &Scene) -> Vec<S> {
    let mut sources = at.state_rates();
    for force in &scene.forces {
        let action = force.action(at);
        sources.extend(action.force.0.into_iter().chain(action.torque.0));
    }
    sources.extend(at.loop_formulas());
    for m in 0..scene.motions.len() {
        let drive = at.prescribed(m);
        sources.extend([drive.value, drive.first, drive.second]);
    }
    sources.extend(scene.sensors.iter().map(|s| at.formula(s.formula)));
    // a sensor is triggered where what it watches passes its value
    sources.extend(scene.sensors.iter().map(|s| {
        let beyond = at.formula(s.formula) - S::constant(s.value);
        let beyond = if s.angular { beyond.sin() } else { beyond };
        S::select(beyond.lt(S::zero()), S::zero(), S::one())
    }));
    sources
}

/// The parts of loads, differential equations and motions that depend on time alone. They read
/// nothing but the time among the layout's numbers.
#[derive(Debug)]
pub(crate) struct Timed {
    /// values at whose levels they may break
    pub values: Program,
    /// at which levels each of them breaks
    pub levels: Vec<Levels>,
    /// values through which time acts on them
    pub clocks: Program,
}

/// Finds what of loads, differential equations and motions depends on time alone: where they may
/// break at times that are fixed beforehand, and through what time acts on them.
///
/// # Errors
/// Functions ask for what the equations cannot supply.
pub(crate) fn timed(recorder: &Recorder<'_, '_>) -> Result<Timed, Vec<Unsupported>> {
    let scene = recorder.scene();
    let time = Input::Slot(Layout::TIME as u32);
    let inputs = scene.layout.inputs();
    let timed = |builder: &mut Builder, values: &[Value]| {
        let found = builder.timed(values, time);
        let (values, levels): (Vec<_>, _) = (found.breaks.into_iter())
            .map(|b| (b.value, b.levels))
            .unzip();
        (values, levels, found.clocks)
    };
    if scene.loops_linear && !scene.loops.is_empty() {
        let mut levels = Vec::new();
        let (mut programs, complaints) = recorded(
            scene,
            scene.loops.len(),
            true,
            false,
            |at, _| sources(at, &scene),
            |builder, all| {
                let (values, of_values, clocks) = timed(builder, &all);
                levels = of_values;
                vec![values, clocks]
            },
        );
        if !complaints.is_empty() {
            return Err(complaints);
        }
        let clocks = programs.remove(1);
        let values = programs.remove(0);
        return Ok(Timed {
            values,
            levels,
            clocks,
        });
    }
    recorder.end(recorder.sources(), |builder, all| {
        let (values, levels, clocks) = timed(builder, &all);
        let [values, clocks] =
            [values, clocks].map(|list| builder.finish_with_inputs(&list, &inputs));
        Timed {
            values,
            levels,
            clocks,
        }
    })
}

/// Where loads, differential equations and motions change branch. `None`: nowhere.
///
/// # Errors
/// Functions ask for what the equations cannot supply.
pub fn switching(recorder: &Recorder<'_, '_>) -> Result<Option<Switching>, Vec<Unsupported>> {
    let scene = recorder.scene();
    if !scene.loops.is_empty() {
        return switching_of_loops(scene);
    }
    let n_switches = recorder.end(recorder.sources(), |builder, values| {
        builder.switching(&values).len()
    })?;
    if n_switches == 0 {
        return Ok(None);
    }
    let row = LongRow {
        numbers: scene.layout,
        n_more: 0,
        n_sides: n_switches,
    };
    let n_rates = scene.layout.n_rates();
    let n_sensors = scene.sensors.len();
    let mut values = rate(recorder.at());
    let sources = recorder.sources();
    // the last of them
    values.extend(&sources[sources.len() - n_sensors..]);
    values.extend(sources);
    let [held, switches, sensors] = recorder.end(&values, |builder, values| {
        let layout = inputs_of(row);
        // inputs stand in the order in which they are asked for
        for &input in &layout {
            builder.input(input);
        }
        let (wanted, sources) = values.split_at(n_rates + n_sensors);
        let side = |k: usize| Input::Slot(row.side_at(k) as u32);
        let (mut held, switches) = builder.held(wanted, sources, side);
        let sensors = held.split_off(n_rates);
        [held, switches, sensors].map(|values| builder.finish_with_inputs(&values, &layout))
    })?;
    Ok(Some(Switching {
        switches,
        unknowns: None,
        held: Some(held),
        held_loops: None,
        held_sensors: (n_sensors > 0).then_some(sensors),
    }))
}

/// As [`switching`] where there are algebraic loops. Their unknowns are known here, so that their
/// elimination does not count as a switch.
fn switching_of_loops(scene: Configured<'_>) -> Result<Option<Switching>, Vec<Unsupported>> {
    let n_loops = scene.loops.len();
    let (mut switches, complaints) = recorded(
        scene,
        n_loops,
        true,
        false,
        |at, _| sources(at, &scene),
        |builder, values| vec![builder.switching(&values)],
    );
    if !complaints.is_empty() {
        return Err(complaints);
    }
    let n_switches = switches.remove(0).n_outputs();
    if n_switches == 0 {
        return Ok(None);
    }
    let unknowns = match scene.loops_linear {
        true => Some(record(scene, |at| at.unknowns(n_loops))?),
        false => None,
    };
    let row = LongRow {
        numbers: scene.layout,
        n_more: n_loops,
        n_sides: n_switches,
    };
    let n_sensors = scene.sensors.len();
    let n_rates = scene.layout.n_rates();
    let (mut all, _) = recorded(
        scene,
        n_loops + n_switches,
        true,
        false,
        |at, _| {
            let mut out = rate(at);
            out.extend(at.loop_residuals());
            let sources = sources(at, &scene);
            // the last of them
            out.extend(&sources[sources.len() - n_sensors..]);
            out.extend(sources);
            out
        },
        |builder, values| {
            let (wanted, sources) = values.split_at(n_rates + n_loops + n_sensors);
            let side = |k: usize| Input::Slot(row.side_at(k) as u32);
            let (mut held, switches) = builder.held(wanted, sources, side);
            let sensors = held.split_off(n_rates + n_loops);
            let residuals = held.split_off(n_rates);
            vec![switches, sensors, residuals, held]
        },
    );
    let held = all.pop();
    let held_loops = all.pop();
    let held_sensors = all.pop().filter(|_| n_sensors > 0);
    Ok(all.pop().map(|switches| Switching {
        switches,
        unknowns,
        held,
        held_loops,
        held_sensors,
    }))
}

/// Records what `f` computes from the instant, and `n_further` numbers, with every branch as the
/// sign of its switch says; returns with it the row that it reads: the numbers of the layout, the
/// unknowns of loops, the further numbers, one sign per switch. `None`: branches cannot be held.
/// The switches are those of [`switching`], in their order, because the same is recorded before
/// anything else.
pub fn held_with<F>(
    scene: Configured<'_>,
    switching: &Switching,
    n_further: usize,
    f: F,
) -> Option<(Program, LongRow)>
where
    F: for<'b> FnOnce(&Equations<'_, Sym<'b>>, &[Sym<'b>]) -> Vec<Sym<'b>>,
{
    switching.held.as_ref()?;
    let n_loops = scene.loops.len();
    let row = LongRow {
        numbers: scene.layout,
        n_more: n_loops + n_further,
        n_sides: switching.switches.n_outputs(),
    };
    let (n_known, same) = (Cell::new(0..0), Cell::new(false));
    let (mut programs, complaints) = recorded(
        scene,
        row.n_more + row.n_sides,
        n_loops > 0,
        false,
        |at, more| {
            let mut out = rate(at);
            if n_loops > 0 {
                out.extend(at.loop_residuals());
            }
            let first = out.len();
            out.extend(sources(at, &scene));
            n_known.set(first..out.len());
            out.extend(f(at, &more[n_loops..row.n_more]));
            out
        },
        |builder, values| {
            let known = n_known.take();
            let wanted = &values[known.end..];
            let side = |k: usize| Input::Slot(row.side_at(k) as u32);
            let (held, switches) = builder.held(wanted, &values[known], side);
            same.set(switches.len() == row.n_sides);
            vec![held]
        },
    );
    if !same.get() || !complaints.is_empty() {
        return None;
    }
    programs.pop().map(|program| (program, row))
}

/// Records the rates of the states downstream of the mechanism; then, where they change branch with
/// forces that they read, the same with the branches of `switching` held, which reads its sides
/// after the numbers.
///
/// # Errors
/// Functions ask for what the equations cannot supply.
pub fn downstream(
    recorder: &Recorder<'_, '_>,
    switching: Option<&Switching>,
) -> Result<(Program, Option<Program>), Vec<Unsupported>> {
    let rates = recorder.at().downstream_rates();
    let has_branches = recorder.end(&rates, |builder, values| {
        !builder.switching(&values).is_empty()
    })?;
    let held = switching.filter(|_| has_branches && recorder.scene().loops.is_empty());
    let held = held.and_then(|switching| {
        held_with(recorder.scene(), switching, 0, |at, _| {
            at.downstream_rates()
        })
    });
    Ok((recorder.program(&rates)?, held.map(|(program, _)| program)))
}

/// The rates, and how strong the weakest pivot of the rows is.
pub fn rate<S: Scalar>(at: &Equations<'_, S>) -> Vec<S> {
    let mut out = at.rates();
    out.push(at.solved().strength);
    out
}

/// The rates as far as they are found without eliminating: loads along the free coordinates stand
/// in the place of accelerations, and the strength of rows is that of all.
pub fn loads<S: Scalar>(at: &Equations<'_, S>) -> Vec<S> {
    let mut out = at.position_rates();
    out.extend(at.balance(&[]));
    out.extend(at.state_rates());
    out.push(S::one());
    out
}

/// Weight of a coordinate's change in a projection: angles count as such, lengths against the reach
/// of its mechanism.
pub fn weights(scene: &Scene) -> Vec<f64> {
    let mut w = vec![1.0; scene.layout.n_v];
    for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
        if let (Some(v), false) = (f.v, c.angular) {
            w[v] = scene.memberships[f.link].reach.powi(2);
        }
    }
    w
}

/// Least changes that satisfy the active rows to first order: of the positions (as a tangent, n_v),
/// then of the velocities; then those of the places of contacts on curves.
///
/// ```text
/// Δq = −A Gᵀ (G A Gᵀ)⁻¹ g        Δv = −A Gᵀ (G A Gᵀ)⁻¹ (G v + ġ₀)
/// ```
///
/// with `A = M⁻¹`: what is taken away is orthogonal in kinetic energy to all motions that the rows
/// allow, so that noise normal to the rows, however large where they are nearly dependent, leaves
/// those motions alone. In kinematics, where masses may be zero, A is a diagonal matrix of
/// [`weights`]. An equation of velocities has g = 0: positions are put right along motions that it
/// permits.
pub fn projection<S: Scalar>(scene: &Scene, at: &Equations<'_, S>, velocities: &[S]) -> Vec<S> {
    let rows: Vec<_> = (at.rows_in_order())
        .into_iter()
        .map(|r| at.row(r))
        .collect();
    let n = scene.layout.n_v;
    let position: Vec<S> = rows.iter().map(|r| -r.value).collect();
    let velocity: Vec<S> = rows
        .iter()
        .map(|r| {
            r.gradient
                .iter()
                .fold(-r.drift, |s, &(v, g)| s - g * velocities[v])
        })
        .collect();
    let g: Vec<Vec<(usize, S)>> = rows.iter().map(|r| r.gradient.clone()).collect();
    if let Some(factor) = at.loop_factor(&g, &[]) {
        let changes = [position, velocity].map(|rhs| {
            let mut change = vec![S::zero(); n];
            factor.solve(&mut change, &rhs);
            change
        });
        let mut out = changes.concat();
        out.extend(at.cam_corrections());
        return out;
    }
    let factor = at.mass_factor();
    let w = weights(scene);
    // u with uᵀ D⁻¹ u = G A Gᵀ, and D⁻¹
    let inverse_d = match &factor {
        Some(factor) => factor.inverse_d(),
        None => w.iter().map(|&w| S::constant(w)).collect(),
    };
    let u: Vec<Vec<(usize, S)>> = match &factor {
        Some(factor) => g.iter().map(|row| factor.half_row(row)).collect(),
        None => g,
    };
    let gram = SymmetricFactor::new(gram(&u, &inverse_d), &[]);
    let mut out = Vec::with_capacity(2 * n);
    for rhs in [position, velocity] {
        let lambda = gram.solve(rhs);
        let mut change = vec![S::zero(); n];
        for (row, &l) in u.iter().zip(&lambda) {
            for &(v, x) in row {
                change[v] += x * l;
            }
        }
        match &factor {
            Some(factor) => factor.finish(&mut change),
            None => {
                for (x, &a) in change.iter_mut().zip(&inverse_d) {
                    *x = *x * a;
                }
            }
        }
        out.extend(change);
    }
    out.extend(at.cam_corrections());
    out
}
