//! A scene with its programs: everything that methods of `numeric` see, and that analyses ask for
//! at a state.
//!
//! y = (q, v, x): positions and velocities of the forest and states of differential equations.
//!
//! ```text
//! recorded     the programs of a configuration: rate, rows, branches, loops, turns; remade as a whole
//! ode          ẏ = f(t, y), projection; jacobian: its derivatives
//! downstream   ẋ = g(t, y, x) of what reads the mechanism and is not read by it
//! numbers      of an instant, from time and state; speeds, accepted: what is asked of them
//! external_inputs (past, closures), sensors, samples     numbers that programs read but do not compute
//! asked        what a user's routine asks of the model
//! peaks, time_events, clocks, tunnelling, singular_step     how long a step may be
//! ```

mod accepted;
mod algebraic_loops;
mod aside;
pub mod asked;
pub(super) mod bounds;
pub mod branches;
mod clocks;
pub mod closures;
pub(super) mod downstream;
pub(super) mod energy;
pub mod external_inputs;
mod jacobian;
mod judged;
mod loop_factors;
mod numbers;
mod ode;
pub mod past;
pub(super) mod peaks;
mod recorded;
mod recording;
mod rows;
pub mod samples;
pub mod sensors;
mod singular_step;
mod sliding;
mod speeds;
mod tangents;
pub(super) mod time_events;
mod tunnelling;
pub mod turns;

use crate::analysis::look;
use crate::diagnostic::{Diagnostic, Error};
use crate::expr::program::Program;
use crate::numeric::Ode;
use crate::scene::Scene;
use crate::scene::broken::{Broken, broken};
use crate::scene::configuration::{Configuration, Configured, Elimination};
use crate::scene::equations::Unsupported;
use crate::scene::layout::Layout;
use crate::scene::mover::Mover;
use crate::scene::programs::record;
use crate::scene::recorder::Recorder;
use bounds::{Watched, What};
use branches::Branches;
use closures::Hook;
pub(in crate::analysis) use recorded::Purpose;
use recorded::Recorded;
pub(in crate::analysis) use rows::RowGradients;
use singular_step::SingularSteps;
use std::cell::OnceCell;
use std::sync::Arc;
use turns::Look;

/// Operations beside those of evaluations in a step, over the evaluations in it: of any step, and
/// for each unknown.
const OPERATIONS_OF_A_STEP: usize = 100;
const OPERATIONS_OF_AN_UNKNOWN: usize = 25;

/// A scene with its programs, ready to be integrated.
#[derive(Clone, Debug)]
pub struct System {
    /// what is computed
    pub scene: Arc<Scene>,
    /// what has been decided about it
    pub configuration: Configuration,
    /// what the programs read: t | q | v | x | turns | loops | external
    pub numbers: Vec<f64>,
    /// the programs of the configuration, and what they have seen
    pub(super) recorded: Recorded,
    /// the closures that hooks of the scene refer to
    hooks: Vec<Hook>,
    /// energy and powers, where they are watched
    energy: Option<Box<energy::EnergyProgram>>,
    /// instants near which rows were dependent in the present step
    singular_steps: SingularSteps,
    /// where the rows that take part were last found to be the right ones
    judged: Option<judged::Judged>,
    /// the functions of the motions, once somebody has asked for them
    drives: OnceCell<Program>,
    /// what steps leave behind, while evaluations are made aside
    traces: aside::Traces,
    /// the permitted local error: evaluations need not be much better
    pub precision: f64,
    /// the loop that had no solution at the last numbers
    unsolved: Option<usize>,
    /// a stage of a method on the rows   (n)
    stage: Vec<f64>,
    mover: Mover,
}

/// Makes errors of what the equations cannot supply.
pub fn complaints(what: Vec<Unsupported>) -> Vec<Diagnostic> {
    what.iter().map(Unsupported::error).collect()
}

impl System {
    /// Records the programs of a scene.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub fn new(scene: Arc<Scene>, configuration: Configuration) -> Result<Self, Error> {
        Self::with_hooks(scene, configuration, &[])
    }

    /// Records the programs of a scene, with the closures that its hooks refer to.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub fn with_hooks(
        scene: Arc<Scene>,
        configuration: Configuration,
        hooks: &[Hook],
    ) -> Result<Self, Error> {
        Ok(Self::recorded_while(
            scene,
            configuration,
            hooks,
            Purpose::Motion,
            &mut || Ok(()),
            |_, _| Ok(()),
        )?)
    }

    /// Records the programs of a scene for a purpose, with the closures that its hooks refer to;
    /// `look` is asked between them whether to go on. `then` may bring the system into its state,
    /// and record more of what the programs were recorded of: kinematics and reactions are there.
    ///
    /// # Errors
    /// Functions that the equations cannot supply, and what `look` and `then` answer.
    pub(in crate::analysis) fn recorded_while(
        scene: Arc<Scene>,
        mut configuration: Configuration,
        hooks: &[Hook],
        purpose: Purpose,
        look: look::Look<'_>,
        then: impl FnOnce(&mut Self, &Recorder<'_, '_>) -> Result<(), Vec<Diagnostic>>,
    ) -> Result<Self, Vec<Diagnostic>> {
        let lent_inertia = recorded::lent_inertia(scene.within(&configuration));
        configuration.elimination = Elimination {
            lent_inertia,
            ..Elimination::default()
        };
        let of = |recorded, configuration, recorder: &Recorder<'_, '_>| {
            let mut system = Self {
                recorded,
                hooks: hooks.to_vec(),
                energy: None,
                singular_steps: SingularSteps::default(),
                judged: None,
                drives: OnceCell::new(),
                traces: aside::Traces::default(),
                precision: 1e-6,
                unsolved: None,
                stage: Vec::with_capacity(scene.layout.n_y()),
                mover: Mover::new(&scene),
                numbers: numbers::first_numbers(scene.within(&configuration)),
                scene: Arc::clone(&scene),
                configuration,
            };
            then(&mut system, recorder)?;
            Ok(system)
        };
        let q = &scene.initial_q;
        Recorded::record(&scene, configuration, q, hooks, purpose, look, of)
    }

    /// Goes on with other rows, whose pivots are measured at the present positions.
    ///
    /// # Errors
    /// Functions that the equations cannot supply; then the system stays as it is.
    pub fn reselect(&mut self, active: Vec<bool>) -> Result<(), Error> {
        let mut configuration = self.configuration.clone();
        configuration.active = active;
        let q = &self.numbers[self.scene.layout.q()];
        let look = &mut || Ok(());
        let (recorded, configuration) = Recorded::record(
            &self.scene,
            configuration,
            q,
            &self.hooks,
            Purpose::Motion,
            look,
            |r, c, _| Ok((r, c)),
        )?;
        let before = std::mem::replace(&mut self.recorded, recorded);
        self.recorded.carry_on(before);
        self.configuration = configuration;
        if self.energy.take().is_some() {
            self.prepare_energy();
        }
        Ok(())
    }

    /// Returns the program of the functions of all motions   (n_motions)
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub(in crate::analysis) fn drives(&self) -> Result<&Program, Vec<Diagnostic>> {
        if let Some(known) = self.drives.get() {
            return Ok(known);
        }
        let program = record(self.configured(), |at| {
            let motions = 0..self.scene.motions.len();
            motions.map(|m| at.motion_function(m)).collect()
        });
        let program = program.map_err(complaints)?;
        Ok(self.drives.get_or_init(|| program))
    }

    /// Returns the program of the values of all rows   (n_rows)
    pub(in crate::analysis) fn row_values(&self) -> &Program {
        &self.recorded.rows.values
    }

    /// Returns the gradients of the rows that take part.
    pub(in crate::analysis) fn row_gradients(&self) -> &RowGradients {
        &self.recorded.rows.gradients
    }

    /// Returns whether a projection onto the rows changes positions and velocities alone, and asks
    /// nothing beside the programs: neither closures nor loops.
    pub(in crate::analysis) fn projects_positions_alone(&self) -> bool {
        let recorded = &self.recorded;
        recorded.rows.projection.is_some()
            && self.scene.cams.is_empty()
            && recorded.loops.is_none()
            && recorded.external.is_empty()
    }

    /// Returns the scene in its present configuration.
    pub fn configured(&self) -> Configured<'_> {
        self.scene.within(&self.configuration)
    }

    /// Returns the number of operations of one evaluation of the rate.
    pub fn operations(&self) -> usize {
        self.recorded.rate.program.n_operations()
    }

    /// Returns the number of operations of a step over the evaluations in it: those of one, and of
    /// what else is done.
    pub(super) fn operations_of_a_step(&self) -> usize {
        let others = OPERATIONS_OF_A_STEP + OPERATIONS_OF_AN_UNKNOWN * self.scene.layout.n_y();
        self.operations() + others
    }

    /// Returns the number of operations of one projection.
    pub fn projection_operations(&self) -> Option<usize> {
        let projection = self.recorded.rows.projection.as_ref();
        projection.map(|p| p.program.n_operations())
    }

    /// Returns what moves positions along tangents.
    pub fn mover(&self) -> &Mover {
        &self.mover
    }

    /// Returns the branches of functions, and which of them are held.
    pub fn branches(&self) -> &Branches {
        &self.recorded.branches
    }

    /// Returns the branches of functions, to hold or to release them.
    pub fn branches_mut(&mut self) -> &mut Branches {
        &mut self.recorded.branches
    }

    /// Evaluates the switching functions at a state   (n_switches)
    pub fn switches(&mut self, t: f64, y: &[f64], values: &mut [f64]) {
        self.set(t, y);
        self.recorded.branches.values(&self.numbers, values);
    }

    /// Returns whether the motion would stay where switch `k` changes, while those slide that do.
    pub fn attracts(&mut self, t: f64, y: &[f64], k: usize) -> bool {
        if !self.recorded.branches.can_hold() || !self.recorded.external.is_empty() {
            return false;
        }
        self.set(t, y);
        self.recorded.branches.attracts(&self.numbers, k)
    }

    /// Puts a state where steps have ended near it onto the place at which the motion stays.
    pub fn stay(&mut self, t: f64, y: &mut [f64]) {
        self.set(t, y);
        self.recorded.branches.stay(&self.numbers, y);
    }

    /// Returns the side on which a switch that slid goes on.
    pub fn side_left_to(&mut self, t: f64, y: &[f64], k: usize) -> i8 {
        self.set(t, y);
        self.recorded.branches.side_left_to(&self.numbers, k)
    }

    /// Returns whether the rate jumps where switch `k` changes.
    pub fn rate_jumps(&mut self, t: f64, y: &[f64], k: usize) -> bool {
        self.set(t, y);
        self.recorded.branches.rate_jumps(&self.numbers, k)
    }

    /// Returns the unknown whose rate changes most where switch `k` does.
    pub fn changed_most_by(&mut self, t: f64, y: &[f64], k: usize) -> usize {
        self.set(t, y);
        self.recorded.branches.changed_most_by(&self.numbers, k)
    }

    /// Returns the first contact of curves that has ended at a state. `until`: when the run was to
    /// end.
    pub fn broken(&mut self, t: f64, y: &[f64], until: f64) -> Option<Broken> {
        if self.scene.cams.is_empty() {
            return None;
        }
        self.set(t, y);
        broken(self.configured(), &self.numbers, Some(until))
    }

    /// Returns how long a step from here may be so that no body of a contact passes unseen through
    /// another.
    pub(super) fn longest_unseen(&mut self, t: f64, y: &[f64]) -> f64 {
        if self.recorded.thickness.is_empty() {
            return f64::INFINITY;
        }
        // accelerations read what loops and closures yield here
        let mut rates = std::mem::take(&mut self.recorded.thickness.rates);
        let done = self.rate(t, y, &mut rates);
        self.recorded.thickness.rates = rates;
        match done {
            Ok(()) => self.recorded.thickness.time(&self.scene, &self.numbers),
            // the step itself will say so
            Err(_) => f64::INFINITY,
        }
    }

    /// Returns whether a touch may begin within a step of this length from where
    /// `longest_unseen` was asked last, of which nothing told there.
    pub fn is_surprised(&self, h: f64) -> bool {
        !self.recorded.thickness.is_empty() && h > self.recorded.thickness.surprise
    }

    /// Returns functions that are watched along a step by their bounds, and the numbers of the last
    /// state.
    pub(super) fn watched(&mut self, what: What) -> (&mut dyn Watched, &[f64]) {
        let watched: &mut dyn Watched = match what {
            What::Switches => &mut self.recorded.branches,
            What::Peaks => &mut self.recorded.peaks,
        };
        (watched, &self.numbers)
    }

    /// Evaluates functions that are watched at a state   (n)
    pub(super) fn watch(&mut self, what: What, (t, y): (f64, &[f64]), values: &mut [f64]) {
        self.set(t, y);
        let (watched, numbers) = self.watched(what);
        watched.values(numbers, values);
    }

    /// Returns whether rows have nearly been dependent since this was last asked.
    pub fn take_weak(&mut self) -> bool {
        self.singular_steps.take_weak()
    }

    /// Returns whether rows have nearly been dependent since that was last taken note of.
    pub fn is_weak(&self) -> bool {
        self.singular_steps.is_weak()
    }

    /// Returns whether rows have nearly been dependent since that was last taken note of, also
    /// between two evaluations of a step.
    pub fn was_near_dependence(&self) -> bool {
        self.singular_steps.was_near()
    }

    /// Returns the largest violation in position of a row that takes part, at all numbers of a
    /// state, relative to what counts as one.
    pub fn worst_gap(&mut self, numbers: &[f64]) -> f64 {
        self.recorded.rows.worst_gap(numbers)
    }

    /// Returns the row among those that take part that is violated most in position at a state, and
    /// by how much, relative to what counts as one.
    pub(in crate::analysis) fn worst_kept(&mut self, t: f64, y: &[f64]) -> Option<(usize, f64)> {
        self.set(t, y);
        let scene = self.scene.within(&self.configuration);
        self.recorded.rows.worst_kept(scene, &self.numbers)
    }

    /// Tells that so many outputs follow, by an explicit method or from position to position: what
    /// runs at least as often is translated first, where that pays.
    pub(in crate::analysis) fn expect_outputs(&self, n: usize, is_kinematic: bool) {
        let recorded = &self.recorded;
        if is_kinematic {
            recorded.rows.expect_projections(n);
        } else if recorded.branches.switching.is_none() {
            recorded.rate.program.expect_runs(n);
        }
        if let Some(energy) = &self.energy {
            energy.expect_runs(n);
        }
    }

    /// Returns whether rows that are left out have to be watched: they say something that changes.
    pub fn watches_rows(&self) -> bool {
        self.recorded.rows.has_left_out()
    }

    /// Returns the row among those left out that is violated most at a state, and by how much,
    /// relative to what counts as one.
    pub fn worst_left_out(&mut self, t: f64, y: &[f64]) -> Option<(usize, f64)> {
        if !self.watches_rows() {
            return None;
        }
        self.set(t, y);
        let scene = self.scene.within(&self.configuration);
        self.recorded.rows.worst_left_out(scene, &self.numbers)
    }

    /// Returns the row among those left out within tolerance that is farthest beyond its limit at
    /// a state, and its value.   [rad, length]
    pub fn worst_loose(&mut self, t: f64, y: &[f64]) -> Option<(usize, f64)> {
        if self.configuration.loose.is_empty() {
            return None;
        }
        self.set(t, y);
        let scene = self.scene.within(&self.configuration);
        self.recorded.rows.worst_loose(scene, &self.numbers)
    }

    /// Returns whether the rates depend on time other than by the state.
    pub(in crate::analysis) fn reads_time(&self) -> bool {
        let recorded = &self.recorded;
        recorded.rate.program.reads(Layout::TIME) || !recorded.external.is_empty()
    }

    /// Returns whether there are angles whose turns are counted from step to step.
    pub fn counts_turns(&self) -> bool {
        self.recorded.turns.is_some()
    }

    /// Returns whether angles that are counted from step to step decide forces.
    pub fn turns_decide(&self) -> bool {
        let turns = self.recorded.turns.as_ref();
        turns.is_some_and(|turns| turns.decide)
    }

    /// Looks at counted angles at a state; they count from those last taken over.
    pub fn look_at_turns(&mut self, t: f64, y: &[f64], look: &mut Look) {
        self.set(t, y);
        if let Some(turns) = &mut self.recorded.turns {
            turns.look(t, &self.numbers, look);
        }
    }

    /// Takes over the counted angles of a look.
    pub fn take_turns(&mut self, look: &Look) {
        if let Some(turns) = &self.recorded.turns {
            turns.take_over(look, &mut self.numbers);
        }
    }

    /// Takes over the counted angles at a state less than half a turn from the one before.
    pub fn count_turns(&mut self, t: f64, y: &[f64]) {
        let mut look = Look::default();
        self.look_at_turns(t, y, &mut look);
        self.take_turns(&look);
    }
}
