//! A scene as a system of ordinary differential equations: what the methods of `numeric` see.
//!
//! y = (q, v, x): positions and velocities of the forest and states of differential equations. The rate is one recorded
//! program; rows that close loops hold at acceleration level within a step, and each accepted step is projected back onto
//! them in position and velocity.

pub(super) mod algebraic_loops;
pub mod external_inputs;
pub mod implicit;
mod jacobian;
pub(super) mod pulses;
pub mod samples;
pub mod sensors;
mod singular_step;
mod sliding;
pub(super) mod slopes;
pub(super) mod time_events;
mod tunnelling;

use crate::diagnostic::Diagnostic;
use crate::expr::program::{Program, Work};
use crate::numeric::control::worst;
use crate::numeric::pattern::Pattern;
use crate::numeric::{Failure, Ode, Relation};
use crate::scalar::{Dual, Scalar};
use crate::scene::cams::{self, Broken, Cam};
use crate::scene::configuration::{Configuration, Configured, Elimination};
use crate::scene::equations::{Equations, KINEMATIC, STATIC, Unsupported};
use crate::scene::layout::Layout;
use crate::scene::programs::{self, Switching, record};
use crate::scene::solve::{self, NEAR_SINGULAR_PIVOT};
use crate::scene::{Scene, Source};

use crate::analysis::start::assemble::{Mover, natural};
use algebraic_loops::{AlgebraicLoops, WIDTH};
use external_inputs::{ExternalInputs, Hook};
use implicit::Implicit;
use jacobian::Gradient;
use pulses::Pulses;
use samples::Samples;
use sensors::Sensors;
use singular_step::SingularSteps;
use sliding::Slides;
use std::sync::Arc;
use time_events::TimeEvents;
use tunnelling::ThicknessBounds;

/// A scene with its programs, ready to be integrated.
#[derive(Debug)]
pub struct System {
    /// what is computed
    pub scene: Arc<Scene>,
    /// what has been decided about it
    pub configuration: Configuration,
    rate: Program,
    projection: Option<Program>,
    /// what violates the rows, and how fast, as parts of what counts as one
    violation: Option<Program>,
    /// violations, and the scale of each velocity   (2 rows, n_v)
    violations: Vec<f64>,
    scales: Vec<f64>,
    /// the last state that was to be projected was on the rows
    clean: bool,
    /// the permitted local error: evaluations need not be much better
    pub precision: f64,
    /// values that change sign where a force or a differential equation changes branch
    pub(super) switching: Option<Switching>,
    /// places in v of the angles that decide a branch
    watched_angles: Vec<usize>,
    /// what time alone does
    pulses: Pulses,
    /// the numbers, then what the switches read after them: unknowns of linear loops, or sides
    switch_numbers: Vec<f64>,
    /// whether branches are held
    pub(super) holding: bool,
    /// sides of the switches, as the held rate reads them   (n_switches)
    pub(super) sides: Vec<f64>,
    /// switches at which the motion stays while branches are held
    slides: Slides,
    /// unknowns of loops that are not linear
    unknowns: Option<AlgebraicLoops>,
    /// values of the past, results of closures
    pub external: ExternalInputs,
    /// what is watched
    pub sensors: Sensors,
    /// what is sampled
    pub samples: Samples,
    /// what could pass through what
    thickness_bounds: ThicknessBounds,
    /// what breaks at times that are fixed beforehand
    pub(super) time_events: TimeEvents,
    /// the loop that had no solution at the last numbers
    unsolved: Option<usize>,
    /// angles whose turns are counted
    counted: Option<Program>,
    /// derivatives of the rate, of the one with branches held, once they have been asked for
    gradients: [Option<Gradient>; 2],
    /// where their Jacobian has entries, if it is mostly empty, once that has been asked for
    pattern: Option<Option<Arc<Pattern>>>,
    /// the same as an implicit system, when a method asks for it
    pub(super) implicit: Option<Box<Implicit>>,
    /// what the programs read: t | q | v | x | turns | loops | supplied
    pub numbers: Vec<f64>,
    work: Work,
    project_work: Work,
    violation_work: Work,
    switch_work: Work,
    held_work: Work,
    unknown_work: Work,
    count_work: Work,
    dual_work: Work<Dual<WIDTH>>,
    dual_numbers: Vec<Dual<WIDTH>>,
    dual_out: Vec<Dual<WIDTH>>,
    change: Vec<f64>,
    /// places in x of contacts on curves
    contacts: Vec<usize>,
    /// rates and the strength of the rows   (n + 1)
    rates: Vec<f64>,
    /// rows have nearly been dependent since the last accepted step
    was_weak: bool,
    /// the same, since somebody last asked
    weak_seen: bool,
    /// instants near which rows were dependent in the present step
    singular_steps: SingularSteps,
    /// rows that are left out and may not follow from the others wherever the mechanism goes, and their values
    left_out: Option<(Vec<usize>, Program)>,
    /// a stage of a method on the rows   (n)
    stage: Vec<f64>,
    mover: Mover,
}

/// Violations of rows, relative to what counts as one, that are rounding.
const ROUNDED: f64 = 1e-14;
/// Errors of the rates that rows magnify may be this part of the permitted local error.
const FELT: f64 = 1e-3;
/// Rounding of an evaluation where the strength is one, over the part of the permitted local error that it may be: a pivot σ² is rounded like one
/// of size one, so that rates are off by rounding/σ².
const HARMFUL: f64 = 1e-13;

/// Part of the largest angle (or length) that a small one is measured against: measured, chains of 160 links take a fifth fewer
/// steps and are still a thousand times more exact than asked for.
const SHARE: f64 = 0.1;
/// The same for speeds, which may differ more: a wheel on a slow arm.
const SHARE_OF_SPEED: f64 = 0.02;
/// Angle by which what decides a branch may turn within a step: a quarter of a turn, in which a step is looked at several times.
const FOLLOWED: f64 = std::f64::consts::FRAC_PI_2;

/// Makes errors of what the equations cannot supply.
pub fn complaints(what: Vec<Unsupported>) -> Vec<Diagnostic> {
    what.iter().map(Unsupported::error).collect()
}

/// Chooses the elimination that takes fewer operations and records the rate with it; deep forests are
/// not tried the quadratic way.
fn shortest_rate(
    scene: &Scene,
    configuration: &mut Configuration,
) -> Result<Program, Vec<Diagnostic>> {
    configuration.elimination.articulated = true;
    let articulated = rate_program(scene.within(configuration))?;
    if scene.depth() > 40 {
        return Ok(articulated);
    }
    configuration.elimination.articulated = false;
    let matrix = rate_program(scene.within(configuration))?;
    if matrix.n_operations() <= articulated.n_operations() {
        return Ok(matrix);
    }
    configuration.elimination.articulated = true;
    Ok(articulated)
}

/// Returns the inertia to lend to freedoms that have none although rows determine their motion
/// (n_v; empty: none).
fn lent_inertia(scene: Configured<'_>) -> Vec<f64> {
    if scene.rows.is_empty() || scene.mode == KINEMATIC || scene.mode == STATIC {
        return Vec::new();
    }
    let mut numbers = vec![0.0; scene.layout.len()];
    numbers[scene.layout.q()].copy_from_slice(&scene.initial_q);
    let rows = Equations::new(scene, &numbers).mass_rows();
    let free = scene.freedoms.iter().filter(|f| f.v.is_some());
    let turns: Vec<bool> = free.map(|f| f.turn).collect();
    solve::lent_inertia(rows, &turns, scene.length)
}

/// Returns the diagonal of `G M⁻¹ Gᵀ` at the positions `q`, against which pivots are measured
/// (n_active).
fn usual_pivots(scene: Configured<'_>, q: &[f64]) -> Vec<f64> {
    if scene.rows.is_empty() {
        return Vec::new();
    }
    let mut numbers = vec![0.0; scene.layout.len()];
    numbers[scene.layout.q()].copy_from_slice(q);
    // contacts on curves are sought there
    let mut there = scene.configuration.clone();
    there.elimination.usual_pivots.clear();
    there.contacts.iter_mut().for_each(|c| c.begun = false);
    cams::track(scene.scene, &mut there, &numbers);
    let at = Equations::new(scene.within(&there), &numbers);
    let diagonal = at.solved().diagonal.clone();
    // rows that happen to vanish there are taken to be like the others
    let largest = diagonal
        .iter()
        .fold(0.0, |m: f64, &d| if d.is_finite() { m.max(d) } else { m });
    diagonal
        .iter()
        .map(|&d| {
            if d > 0.01 * largest {
                d
            } else {
                0.01 * largest
            }
        })
        .collect()
}

/// Places in x of the contacts on curves, in their order.
fn contact_states(scene: &Scene) -> Vec<usize> {
    let states = |cam: &Cam| cam.state..cam.state + cam.contact.n_parameters();
    scene.cams.iter().flat_map(states).collect()
}

/// The least changes onto the rows; `None` when none takes part.
fn projection_program(scene: Configured<'_>) -> Result<Option<Program>, Vec<Diagnostic>> {
    if scene.configuration.active_rows().next().is_none() {
        return Ok(None);
    }
    let program = record(scene, |at| {
        programs::projection(&scene, at, at.velocities())
    });
    program.map(Some).map_err(complaints)
}

/// What violates the rows that take part, and its rate; `None` when none does.
fn violation_program(scene: Configured<'_>) -> Result<Option<Program>, Vec<Diagnostic>> {
    let active: Vec<usize> = scene.configuration.active_rows().collect();
    if active.is_empty() {
        return Ok(None);
    }
    let program = record(scene, |at| {
        let v = at.velocities();
        let both = |&r: &usize| {
            let row = at.row(r);
            let along = row.gradient.iter();
            let rate = along.fold(row.drift, |s, &(k, g)| s + g * v[k]);
            let one = 1.0 / natural(&scene, r);
            [row.value.scale(one), rate.scale(one)]
        };
        active.iter().flat_map(both).collect()
    });
    program.map(Some).map_err(complaints)
}

/// Rows that are left out without being zero whatever happens, and the program of their values.
fn left_out(scene: Configured<'_>) -> Result<Option<(Vec<usize>, Program)>, Vec<Diagnostic>> {
    let idle = |r: &usize| !scene.configuration.active[*r];
    let idle: Vec<usize> = (0..scene.rows.len()).filter(idle).collect();
    if idle.is_empty() {
        return Ok(None);
    }
    let mut rows = Vec::new();
    let program = record(scene, |at| {
        let values = idle.iter().map(|&r| (r, at.row(r).value));
        let changing: Vec<_> = values.filter(|(_, x)| x.known().is_none()).collect();
        rows = changing.iter().map(|c| c.0).collect();
        changing.into_iter().map(|c| c.1).collect()
    })
    .map_err(complaints)?;
    Ok((!rows.is_empty()).then_some((rows, program)))
}

// a function item would be of one lifetime
#[allow(clippy::redundant_closure)]
fn rate_program(scene: Configured<'_>) -> Result<Program, Vec<Diagnostic>> {
    record(scene, |at| programs::rate(at)).map_err(complaints)
}

/// Places in v of the angles that a switch reads; of those of a ball all three.
fn watched_angles(scene: &Scene, switching: Option<&Switching>) -> Vec<usize> {
    let Some(Switching { switches, .. }) = switching else {
        return Vec::new();
    };
    let angular = scene.coordinates.iter().filter(|c| c.angular);
    let free = angular.filter_map(|c| match c.source {
        Source::Free { q, v } if switches.reads(scene.layout.q_at(q)) => Some(v),
        _ => None,
    });
    free.collect()
}

impl System {
    /// Records the programs of a scene.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub fn new(scene: Arc<Scene>, configuration: Configuration) -> Result<Self, Vec<Diagnostic>> {
        Self::with_hooks(scene, configuration, &[])
    }

    /// As [`System::new`], with the closures that the scene's hooks refer to.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub fn with_hooks(
        scene: Arc<Scene>,
        mut configuration: Configuration,
        hooks: &[Hook],
    ) -> Result<Self, Vec<Diagnostic>> {
        let lent_inertia = lent_inertia(scene.within(&configuration));
        configuration.elimination = Elimination {
            lent_inertia,
            ..Elimination::default()
        };
        configuration.elimination.usual_pivots =
            usual_pivots(scene.within(&configuration), &scene.initial_q);
        let rate = shortest_rate(&scene, &mut configuration)?;
        let here = scene.within(&configuration);
        let projection = projection_program(here)?;
        let violation = violation_program(here)?;
        let left_out = left_out(here)?;
        let switching = programs::switching(here).map_err(complaints)?;
        let pulses = Pulses::new(here)?;
        let n_switches = switching.as_ref().map_or(0, |s| s.switches.n_outputs());
        let unknowns = AlgebraicLoops::new(here).map_err(complaints)?;
        let external = ExternalInputs::new(here, hooks).map_err(complaints)?;
        let sensors = Sensors::new(here).map_err(complaints)?;
        let samples = Samples::new(here).map_err(complaints)?;
        let thickness_bounds =
            ThicknessBounds::new(here, scene.layout.n_y()).map_err(complaints)?;
        let time_events = TimeEvents::new(here).map_err(complaints)?;
        let counted = if scene.counted.is_empty() {
            None
        } else {
            let counted = &scene.counted;
            let program = record(here, |at| {
                counted.iter().map(|&angle| at.counted(angle)).collect()
            });
            Some(program.map_err(complaints)?)
        };
        let l = scene.layout;
        let mover = Mover::new(&scene);
        let mut numbers = vec![0.0; l.len()];
        for (z, u) in numbers[l.loops()].iter_mut().zip(&scene.loops) {
            *z = u.guess;
        }
        for (x, value) in numbers[l.external()]
            .iter_mut()
            .zip(&configuration.external)
        {
            *x = *value;
        }
        Ok(Self {
            rate,
            projection,
            violations: vec![0.0; violation.as_ref().map_or(0, Program::n_outputs)],
            violation,
            scales: programs::weights(&scene)
                .iter()
                .map(|w| w.sqrt().recip())
                .collect(),
            clean: false,
            precision: 1e-6,
            watched_angles: watched_angles(&scene, switching.as_ref()),
            switching,
            pulses,
            switch_numbers: Vec::new(),
            holding: false,
            sides: vec![0.0; n_switches],
            slides: Slides::default(),
            unknowns,
            external,
            sensors,
            samples,
            thickness_bounds,
            time_events,
            unsolved: None,
            counted,
            gradients: [None, None],
            pattern: None,
            implicit: None,
            numbers,
            work: Work::default(),
            project_work: Work::default(),
            violation_work: Work::default(),
            switch_work: Work::default(),
            held_work: Work::default(),
            unknown_work: Work::default(),
            count_work: Work::default(),
            dual_work: Work::default(),
            dual_numbers: Vec::new(),
            dual_out: Vec::new(),
            change: vec![0.0; 2 * l.n_v + contact_states(&scene).len()],
            rates: vec![0.0; l.n_y() + 1],
            was_weak: false,
            contacts: contact_states(&scene),
            weak_seen: false,
            singular_steps: SingularSteps::default(),
            left_out,
            stage: Vec::with_capacity(l.n_y()),
            mover,
            scene,
            configuration,
        })
    }

    /// Returns the scene in its present configuration.
    pub fn configured(&self) -> Configured<'_> {
        self.scene.within(&self.configuration)
    }

    /// Number of operations of one evaluation of the rate.
    pub fn operations(&self) -> usize {
        self.rate.n_operations()
    }

    /// Number of operations of one projection.
    pub fn projection_operations(&self) -> Option<usize> {
        self.projection.as_ref().map(Program::n_operations)
    }

    /// Moves positions along tangents.
    pub fn mover(&self) -> &Mover {
        &self.mover
    }

    /// The first contact of curves that is none at a state. `until`: when the run was to end.
    pub fn broken(&mut self, t: f64, y: &[f64], until: f64) -> Option<Broken> {
        if self.scene.cams.is_empty() {
            return None;
        }
        self.set(t, y);
        cams::broken(self.configured(), &self.numbers, Some(until))
    }

    /// How many switching functions there are.
    pub fn n_switches(&self) -> usize {
        self.switching
            .as_ref()
            .map_or(0, |s| s.switches.n_outputs())
    }

    /// Their values, the branches of others held where branches are held   (n_switches)
    pub fn switches(&mut self, t: f64, y: &[f64], values: &mut [f64]) {
        self.set(t, y);
        let Some(switching) = &self.switching else {
            return;
        };
        let n = self.numbers.len();
        let all = &mut self.switch_numbers;
        if let Some(unknowns) = &switching.unknowns {
            all.resize(n + unknowns.n_outputs(), 0.0);
            all[..n].copy_from_slice(&self.numbers);
            unknowns.run(&self.numbers, &mut self.unknown_work, &mut all[n..]);
        } else if switching.held.is_some() {
            all.resize(n + values.len(), 0.0);
            all[..n].copy_from_slice(&self.numbers);
            all[n..].copy_from_slice(&self.sides);
        } else {
            switching
                .switches
                .run(&self.numbers, &mut self.switch_work, values);
            return;
        }
        switching.switches.run(all, &mut self.switch_work, values);
        if self.is_sliding() {
            self.sliding_values(values);
        }
    }

    /// Whether branches can be held.
    pub fn can_hold(&self) -> bool {
        self.switching.as_ref().is_some_and(|s| s.held.is_some())
    }

    /// From now on rates are those of the branches on these sides of the switches (−1, 0, 1), wherever the state goes; nothing slides.
    pub fn hold(&mut self, sides: &[i8]) {
        self.slide([]);
        self.sides.clear();
        self.sides.extend(sides.iter().map(|&s| f64::from(s)));
        self.holding = self.can_hold();
    }

    /// From now on rates take the branch that the state says.
    pub fn release(&mut self) {
        self.holding = false;
    }

    /// The rates at the present numbers, and how strong the rows are.
    fn run_rate(&mut self) {
        if self.is_sliding() && self.run_sliding() {
            return;
        }
        if let (
            true,
            Some(Switching {
                held: Some(held), ..
            }),
        ) = (self.holding, &self.switching)
        {
            let n = self.numbers.len();
            let all = &mut self.switch_numbers;
            all.resize(n + self.sides.len(), 0.0);
            all[..n].copy_from_slice(&self.numbers);
            all[n..].copy_from_slice(&self.sides);
            held.run(all, &mut self.held_work, &mut self.rates);
            // beyond its end a branch may have no value
            if self.rates.iter().map(|x| x * 0.0).sum::<f64>() == 0.0 {
                return;
            }
        }
        self.rate
            .run(&self.numbers, &mut self.work, &mut self.rates);
    }

    /// How long a step from here may be so that no body of a contact passes unseen through another.
    pub(super) fn longest_unseen(&mut self, t: f64, y: &[f64]) -> f64 {
        if self.thickness_bounds.is_empty() {
            return f64::INFINITY;
        }
        // accelerations read what loops and the outside yield here
        let mut rates = std::mem::take(&mut self.thickness_bounds.rates);
        let done = self.rate(t, y, &mut rates);
        self.thickness_bounds.rates = rates;
        match done {
            Ok(()) => self.thickness_bounds.time(&self.scene, &self.numbers),
            // the step itself will say so
            Err(_) => f64::INFINITY,
        }
    }

    /// The largest violation of a row at the present numbers, in position or velocity, relative to what counts as one and to how fast it moves.
    fn violation(&mut self) -> f64 {
        let Some(program) = &self.violation else {
            return 0.0;
        };
        program.run(
            &self.numbers,
            &mut self.violation_work,
            &mut self.violations,
        );
        let v = &self.numbers[self.scene.layout.v()];
        let speeds = v.iter().zip(&self.scales).map(|(v, s)| v.abs() * s);
        let slow = 1.0 / speeds.fold(1.0, f64::max);
        let pairs = self.violations.chunks_exact(2);
        worst(pairs.flat_map(|p| [p[0], p[1] * slow]))
    }

    /// Whether rows have nearly been dependent since this was last asked.
    pub fn take_weak(&mut self) -> bool {
        std::mem::take(&mut self.weak_seen)
    }

    /// Whether rows that are left out have to be watched: they say something that changes.
    pub fn watches_rows(&self) -> bool {
        self.left_out.is_some()
    }

    /// The row among those left out that is violated most at a state, and by how much, relative to what counts as one.
    pub fn worst_left_out(&mut self, t: f64, y: &[f64]) -> Option<(usize, f64)> {
        self.left_out.as_ref()?;
        self.set(t, y);
        let (rows, program) = self.left_out.as_ref()?;
        let mut values = vec![0.0; rows.len()];
        program.run(&self.numbers, &mut self.project_work, &mut values);
        crate::analysis::time::ranks::worst_left_out(&self.scene, rows, &values)
    }

    /// Goes on with other rows.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub fn reselect(&mut self, active: Vec<bool>) -> Result<(), Vec<Diagnostic>> {
        let scene = Arc::clone(&self.scene);
        let mut configuration = self.configuration.clone();
        configuration.active = active;
        // Pivot sizes are measured where other rows are chosen.
        configuration.elimination.usual_pivots = usual_pivots(
            scene.within(&configuration),
            &self.numbers[scene.layout.q()],
        );
        self.rate = shortest_rate(&scene, &mut configuration)?;
        let here = scene.within(&configuration);
        self.projection = projection_program(here)?;
        self.thickness_bounds =
            ThicknessBounds::new(here, scene.layout.n_y()).map_err(complaints)?;
        self.violation = violation_program(here)?;
        let n_violations = self.violation.as_ref().map_or(0, Program::n_outputs);
        self.violations.resize(n_violations, 0.0);
        self.clean = false;
        self.left_out = left_out(here)?;
        self.switching = programs::switching(here).map_err(complaints)?;
        let n_switches = self.n_switches();
        self.sides.resize(n_switches, 0.0);
        self.slide([]);
        (self.gradients, self.pattern) = ([None, None], None);
        self.renew_implicit(here)?;
        self.unknowns = AlgebraicLoops::new(here).map_err(complaints)?;
        self.was_weak = false;
        self.configuration = configuration;
        Ok(())
    }

    /// Whether there are angles whose turns are counted.
    pub fn counts_turns(&self) -> bool {
        self.counted.is_some()
    }

    /// Takes over the turns of counted angles at an accepted state.
    pub fn count_turns(&mut self, t: f64, y: &[f64]) {
        self.set(t, y);
        if let Some(program) = &self.counted {
            let places = self.scene.layout.turns();
            let mut angles = vec![0.0; places.len()];
            program.run(&self.numbers, &mut self.count_work, &mut angles);
            for (turn, angle) in self.numbers[places].iter_mut().zip(angles) {
                if angle.is_finite() {
                    *turn = angle;
                }
            }
        }
    }

    /// A bound of how fast any angle turns at a state, rad per time; at a rate, of how fast that changes.
    pub fn spin(&self, y: &[f64]) -> f64 {
        let l = self.scene.layout;
        let speeds = self
            .scene
            .coordinates
            .iter()
            .zip(&self.scene.freedoms)
            .filter(|(c, _)| c.angular);
        speeds
            .filter_map(|(_, f)| f.v)
            .map(|v| l.state(y).v[v].abs())
            .sum()
    }

    /// How long a step may be so that no angle which decides a branch turns by more than [`FOLLOWED`]: a free flight or a free rotation leaves long steps no
    /// reason to become shorter, and a branch may come and go in every turn.
    pub(super) fn longest_turn(&self, y: &[f64], ydot: &[f64]) -> f64 {
        let l = self.scene.layout;
        let (v, vdot) = (l.state(y).v, l.state(ydot).v);
        let time = |&k: &usize| {
            let (speed, acceleration) = (v[k].abs(), vdot[k].abs());
            2.0 * FOLLOWED / (speed + (speed * speed + 2.0 * FOLLOWED * acceleration).sqrt())
        };
        let times = self.watched_angles.iter().map(time);
        times.filter(|h| !h.is_nan()).fold(f64::INFINITY, f64::min)
    }

    /// Times at which steps have to end, lest a pulse passes unseen.
    pub fn landings(&mut self, start: f64, end: f64) -> Vec<f64> {
        self.pulses.landings(&mut self.time_events, start, end)
    }

    /// All numbers at a state, projected onto the rows.
    pub fn row(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut y = y.to_vec();
        let kept = y.clone();
        if Ode::project(self, t, &mut y).is_err() {
            y = kept;
        }
        self.set(t, &y);
        if !self.external.is_empty() {
            self.external.evaluate(&mut self.numbers, true);
        }
        self.numbers.clone()
    }

    /// All numbers at a state; multipliers after it are of no concern.
    pub(super) fn numbers_at(&self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut numbers = self.numbers.clone();
        let places = self.scene.layout.y();
        numbers[Layout::TIME] = t;
        let n = places.len();
        numbers[places].copy_from_slice(&y[..n]);
        numbers
    }

    /// Takes over time and state; multipliers after the state are of no concern.
    pub(super) fn set(&mut self, t: f64, y: &[f64]) {
        self.numbers[Layout::TIME] = t;
        let places = self.scene.layout.y();
        let n = places.len();
        self.numbers[places].copy_from_slice(&y[..n]);
        if !self.external.is_empty() {
            self.external.evaluate(&mut self.numbers, false);
        }
        if let Some(unknowns) = &mut self.unknowns {
            self.unsolved = unknowns.solve(&mut self.numbers).err();
        }
    }

    /// Solves the loops at the present numbers, after some of them have been changed.
    ///
    /// # Errors
    /// The index of a loop without a solution near, in [`Scene::loops`].
    pub fn resolve(&mut self) -> Result<(), usize> {
        if !self.external.is_empty() {
            self.external.evaluate(&mut self.numbers, true);
        }
        if let Some(unknowns) = &mut self.unknowns {
            self.unsolved = unknowns.solve(&mut self.numbers).err();
        }
        self.unsolved.map_or(Ok(()), Err)
    }

    /// Tells along which directions closures' results and loops' unknowns change, where `along` says it of the other numbers.
    pub fn depend_along(&self, along: &mut [Vec<u32>]) {
        self.external.depend(along);
        if let Some(unknowns) = &self.unknowns {
            unknowns.depend(along);
        }
    }

    /// Derivatives of closures' results and loops' unknowns along the directions of a row of numbers, into their places; `first`: at new numbers.
    ///
    /// # Errors
    /// The index of a loop that nothing determines, in [`Scene::loops`].
    pub fn follow_along(&mut self, numbers: &mut [Dual<WIDTH>], first: bool) -> Result<(), usize> {
        self.external.follow(numbers, first);
        match &mut self.unknowns {
            Some(unknowns) => unknowns.follow(numbers, first),
            None => Ok(()),
        }
    }

    /// The same for the system's own numbers.
    fn follow(&mut self, first: bool) -> Result<(), Failure> {
        let n = self.scene.layout.n_y();
        self.external.follow(&mut self.dual_numbers, first);
        match &mut self.unknowns {
            Some(unknowns) => unknowns
                .follow(&mut self.dual_numbers, first)
                .map_err(|k| Failure {
                    what: n + k,
                    recoverable: true,
                }),
            None => Ok(()),
        }
    }
}

impl Ode for System {
    fn size(&self) -> usize {
        self.scene.layout.n_y()
    }

    fn rate(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.set(t, y);
        if let Some(k) = self.unsolved {
            return Err(Failure {
                what: y.len() + k,
                recoverable: true,
            });
        }
        let n = ydot.len();
        self.run_rate();
        if self.rates[n] < NEAR_SINGULAR_PIVOT && self.projection.is_some() {
            (self.was_weak, self.weak_seen) = (true, true);
            // near a position where rows become dependent, what violates them is magnified by 1/σ: evaluate on the rows where that matters
            let strength = self.rates[n].max(0.0);
            let permitted = (FELT * self.precision * strength.sqrt()).max(ROUNDED);
            let violation = self.violation();
            if violation.is_nan() || violation > permitted {
                let mut stage = std::mem::take(&mut self.stage);
                stage.clear();
                stage.extend_from_slice(y);
                if self.project(t, &mut stage).is_ok() {
                    self.set(t, &stage);
                    self.run_rate();
                }
                self.stage = stage;
            }
            self.singular_steps.see(t, self.rates[n]);
        }
        ydot.copy_from_slice(&self.rates[..n]);
        // a sum is finite only if all its terms are
        let sum: f64 = ydot.iter().map(|x| x * 0.0).sum();
        if sum == 0.0 {
            return Ok(());
        }
        let what = ydot.iter().position(|x| !x.is_finite()).unwrap_or(0);
        Err(Failure {
            what,
            recoverable: true,
        })
    }

    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<bool, Failure> {
        let l = self.scene.layout;
        let changed = self.mover.normalize(l.state_mut(y).q);
        let Some(program) = self.projection.take() else {
            return Ok(changed);
        };
        if self.clean {
            self.set(t, y);
            if self.violation() <= ROUNDED {
                self.projection = Some(program);
                return Ok(changed);
            }
        }
        let (mut first, mut last) = (None, f64::INFINITY);
        let mut outcome = Err(Failure {
            what: 0,
            recoverable: true,
        });
        for _ in 0..8 {
            self.set(t, y);
            program.run(&self.numbers, &mut self.project_work, &mut self.change);
            let change = l.change(&self.change);
            let size = change.q.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            if !size.is_finite() || size > 2.0 * last {
                break;
            }
            last = size;
            first.get_or_insert(size);
            let state = l.state_mut(y);
            for (v, d) in state.v.iter_mut().zip(change.v) {
                *v += d;
            }
            for (&place, d) in self.contacts.iter().zip(change.x) {
                state.x[place] += d;
            }
            if size > 0.0 {
                self.mover.displace(state.q, change.q);
            }
            // the velocities were corrected with the gradient before this displacement
            if size < 1e-11 {
                outcome = Ok(true);
                break;
            }
        }
        // where rows are nearly dependent the last digits along them are noise
        if self.was_weak && last < 1e-9 {
            outcome = Ok(true);
        }
        // where a mechanism keeps its rows by itself, looking at them is cheaper
        self.clean = self.contacts.is_empty() && first.is_some_and(|size| size < 10.0 * ROUNDED);
        self.projection = Some(program);
        outcome
    }

    fn filter_error(&mut self, t: f64, y: &[f64], error: &mut [f64]) -> bool {
        let (true, Some(program)) = (self.was_weak, &self.projection) else {
            return false;
        };
        // Δv(v) = −W Gᵀ (G W Gᵀ)⁻¹ (G v + ġ₀): its part linear in v takes away what is normal to the rows
        let l = self.scene.layout;
        let n_v = l.n_v;
        let q = l.state(y).q;
        let error = l.state_mut(error);
        let tangent = self.mover.tangent(q, error.q, n_v);
        let mut state = y.to_vec();
        let mut normal = |v: &[f64], numbers: &mut [f64]| {
            l.state_mut(&mut state).v.copy_from_slice(v);
            numbers[Layout::TIME] = t;
            numbers[l.y()].copy_from_slice(&state);
            program.run(numbers, &mut self.project_work, &mut self.change);
            l.change(&self.change).v.to_vec()
        };
        let none = normal(&vec![0.0; n_v], &mut self.numbers);
        let of_q = normal(&tangent, &mut self.numbers);
        let of_v = normal(error.v, &mut self.numbers);
        let filtered: Vec<f64> = (0..n_v).map(|k| tangent[k] + of_q[k] - none[k]).collect();
        self.mover.untangent(q, &filtered, error.q);
        for k in 0..n_v {
            error.v[k] += of_v[k] - none[k];
        }
        true
    }

    fn place_step(&mut self, t: f64, h: f64, gap: [f64; 2]) -> Option<f64> {
        let harmful = (HARMFUL / self.precision).min(NEAR_SINGULAR_PIVOT);
        self.singular_steps.place(t, h, gap, harmful)
    }

    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        jacobian: &mut [f64],
        dfdt: &mut [f64],
    ) -> Result<(), Failure> {
        self.set(t, y);
        self.full_jacobian(y.len(), jacobian, dfdt)
    }

    fn pattern(&mut self) -> Option<Arc<Pattern>> {
        self.jacobian_pattern()
    }

    fn jacobian_entries(&mut self, t: f64, y: &[f64], entries: &mut [f64]) -> Result<(), Failure> {
        self.set(t, y);
        self.jacobian_by_groups(entries)
    }

    fn typical(&self, typical: &mut [f64]) {
        typical.fill(1.0);
        let typical = self.scene.layout.state_mut(typical);
        for (c, f) in self.scene.coordinates.iter().zip(&self.scene.freedoms) {
            if let Source::Free { q, v } = c.source
                && !c.angular
                && !f.in_ball
            {
                typical.q[q] = self.scene.length;
                typical.v[v] = self.scene.length;
            }
        }
    }

    fn relations(&self, relations: &mut [Relation]) {
        let relations = self.scene.layout.state_mut(relations);
        for (c, f) in self.scene.coordinates.iter().zip(&self.scene.freedoms) {
            let Source::Free { q, v } = c.source else {
                continue;
            };
            let kind = u16::from(c.angular);
            if !f.in_ball {
                relations.q[q] = Relation {
                    most: if c.angular {
                        std::f64::consts::PI
                    } else {
                        f64::INFINITY
                    },
                    group: Some(kind),
                    share: SHARE,
                    rate_of: None,
                };
            }
            // what is short because of a contact has to be seen in velocity
            let smooth = self.switching.is_none() && !f.in_ball;
            relations.v[v] = Relation {
                group: Some(2 + kind),
                share: SHARE_OF_SPEED,
                rate_of: smooth.then_some(q),
                ..Relation::default()
            };
        }
    }
}
