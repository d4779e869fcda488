//! A model and its clock: one simulation after another, each from where the last one ended.
//!
//! A simulation compiles the model as it is now, takes over the state (or assembles the first
//! one), computes, and appends its rows to the run. What goes wrong in numbers is an outcome in
//! the record, with the results so far; what is wrong in the model is an error.

mod apart;
mod arguments;
mod at_rest;
pub mod beginning;
mod begun_rates;
mod carried;
mod catalogue;
pub mod columns;
mod companion;
mod doors;
mod growth;
mod kept;
mod limit;
mod measured;
mod outcome;
mod over_time;
mod phase;
mod placed;
mod preview;
mod ranges;
mod requests;
mod rows;
pub mod script;
mod selection;
mod sets;
mod settings;
pub(in crate::analysis) mod shells;
mod shown;
mod simulate;
mod sizes;
mod spline_range;
mod start;
pub mod state;
mod state_at_start;
mod state_values;
mod states;
mod stiffness;
mod stop_reason;
mod tilts;

use crate::analysis::linear::{self, Linearization};
use crate::analysis::session::columns::Columns;
use crate::analysis::system::{Purpose, System, closures};
use crate::analysis::time::output::Output;
use crate::analysis::warning::AssemblyWarning;
use crate::analysis::warning::RunWarning;
use crate::analysis::watch::{Unwatched, Watch};
use crate::analysis::work_limit::WorkLimit;
use crate::diagnostic::Error;
use crate::expr::program::{Program, Structures};
use crate::model::{ElementId, ElementKind, Model};
use crate::results::{Event, Run, Status};
use crate::scene::contacts::Shell;
use crate::scene::equations::Unsupported;
use crate::scene::external_inputs::closure_for;
use crate::scene::unknown::UnknownId;
use carried::Carried;
pub use catalogue::check_column;
use companion::{Integrated, Pace};
use kept::{Kept, Starts};
pub use limit::Activity;
use outcome::units;
use rows::Gaps;
pub use rows::Receiver;
pub use selection::Chosen;
use states::Stretch;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use stiffness::MetStiffness;
use stop_reason::StopReason;

/// The kind of a simulation, as SIMULATE asks for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Analysis {
    /// motions alone move it: position, velocity and acceleration at each output time
    Kinematic,
    /// forces move it
    Dynamic,
    /// an equilibrium, or one at each output time
    Static,
    /// kinematic without freedom, else dynamic
    Transient,
    /// assembled positions and velocities
    InitialConditions,
}

/// The ways in which a run may say how far off it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Accuracy {
    /// not at all
    #[default]
    Unknown,
    /// in a sentence, how many digits to believe: from one further integration of each dynamic
    /// simulation, mostly at a larger request, which then costs about six tenths of it
    Digits,
    /// beside every number, by bars of error: from further runs at other requests
    Bars,
}

/// Options of solving, beyond what the model says. `None`: as the model says, else our default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// permitted local error
    pub error: Option<f64>,
    /// name of a method
    pub method: Option<String>,
    /// how often to solve, for timing
    pub repeat: usize,
    /// further columns: expressions, in which elements may have their names
    /// (`DX(slider.cm, ground)`), and components of sets of results (`crank_bearing.FX`)
    pub columns: Vec<String>,
    /// sets of results of all elements, as RESULTS asks for them. A run that is asked for nothing
    /// (no column, no element in `only`, no REQUEST) has them as well, or the places of bodies
    /// alone where there are more than 400 of them
    pub full: bool,
    /// record what is asked for alone, also where that is nothing but time
    pub named_only: bool,
    /// positions and angles of parts, whatever else is recorded
    pub frames: bool,
    /// sets of eight velocities and eight accelerations of the bodies' centres of mass
    pub body_rates: bool,
    /// the elements that have sets; none: all
    pub only: Vec<Chosen>,
    /// run motions whose displacement or velocity jumps, piece by piece
    pub piecewise: bool,
    /// kinds of elements that are left out where they are not solved
    pub skip: std::collections::BTreeSet<ElementKind>,
    /// take what `USER(…)` would compute as zero where no closure computes it
    pub zero_user: bool,
    /// steps that one integration may try, accepted or not, before it ends with [`Status::Limit`];
    /// `None`: any number
    pub max_steps: Option<usize>,
    /// processor time of this session, in s, after which it ends with [`Status::Limit`] and the
    /// results so far; `None`: any time. It is looked at after each step, each iteration of statics
    /// and each phase of setting up
    pub limit: Option<f64>,
    /// threads on which mechanisms that nothing couples are integrated; results do not depend on
    /// it. `None`: one; 0: one for each processor
    pub threads: Option<usize>,
    /// how a run says how far off it is
    pub accuracy: Accuracy,
    /// keep the states of all rows: columns may then be named after a simulation, see
    /// [`Session::add_column`]
    pub keep_states: bool,
    /// keep the assembled start: after [`Session::reset`] nothing is compiled again
    pub keep_start: bool,
}

/// A model and its clock.
pub struct Session {
    /// the model as it is now
    pub model: Model,
    /// results so far
    pub run: Run,
    options: Options,
    columns: Columns,
    carried: Option<Carried>,
    /// VARIABLEs that commands will change
    changing: BTreeSet<u32>,
    /// what the last simulation ran, for the next one
    kept: Option<Box<Kept>>,
    /// the model of the system that the present simulation began with, as that keeps it
    kept_model: Option<Arc<Model>>,
    /// the present simulation goes on with the system of the one before, of which all was told
    goes_on: bool,
    /// program of the columns of the present scene
    columns_program: Option<Program>,
    /// the program of the columns that was recorded with the system of the present start, or that
    /// belongs to the kept start which the session has gone back to; and the numbers that it lacks
    columns_at_start: Option<(Program, Vec<Unsupported>)>,
    hooks: Vec<closures::Hook>,
    /// linear systems that commands asked for: name of their file where one was given, and whether
    /// matrices are wanted
    pub linear: Vec<(Option<String>, bool, Linearization)>,
    /// states that commands saved, by the names of their files
    pub saved: std::collections::BTreeMap<String, String>,
    /// folders in which RELOAD, and GRAPHICS that contacts name, look for files
    pub folders: Vec<std::path::PathBuf>,
    /// whether a first simulation over time begins at a static equilibrium, see
    /// [`Session::simulate_as`]
    pub at_rest_first: bool,
    /// who read the model has checked it, and nothing has changed it since
    is_checked: bool,
    /// commands that are obeyed are the last that is asked of this session
    ends_with_commands: bool,
    /// nothing comes after the present simulation
    is_last: bool,
    /// a sensor ended the run, not only its simulation
    halted: bool,
    /// columns that have gaps
    gaps: Gaps,
    /// what columns are evaluated with
    scratch: columns::Scratch,
    /// rows that the commands to come will add, as far as they say
    rows_to_come: usize,
    /// why equations are recorded
    purpose: Purpose,
    /// whether commands will have equations recorded that are much like those of before
    records_again: bool,
    /// takes rows while simulations go on
    receiver: Option<Receiver>,
    /// the processor time that may be used
    limit: Option<WorkLimit>,
    /// why the set-up of a simulation was ended
    ended_early: Option<StopReason>,
    /// what the present simulation does to the parts as the one before has left them
    leap: Option<AssemblyWarning>,
    /// parts whose leaps have been told
    leapt: BTreeSet<ElementId>,
    /// velocities and number of rows of the scene that was last found to have masses
    weighed: Option<(Vec<UnknownId>, usize)>,
    activity: Activity,
    shells: Option<Arc<BTreeMap<u32, Result<Shell, String>>>>,
    /// the same at another request, where bars of error are wanted
    companion: Option<Box<Session>>,
    /// a companion ended otherwise than its simulation: of what follows no error is known
    strayed: bool,
    /// how this session differs from the one whose companion it is
    pace: Pace,
    /// the last simulation over time
    last: Integrated,
    /// what an integration that measures the error is off by at the end of the last simulation
    beside: Option<measured::Beside>,
    /// stiffness that simulations have met, where the program chooses the method
    stiffness: MetStiffness,
    /// states of the rows so far, where they are kept
    states: Vec<Stretch>,
    /// assembled starts, where they are kept
    starts: Starts,
    /// structures of the programs so far: those of another start differ in their constants
    structures: Structures,
}

/// Values of MODE.
const KINEMATIC: u32 = 1;
const INITIAL_CONDITIONS: u32 = 3;
const DYNAMIC: u32 = 4;
const STATIC: u32 = 5;
const LINEAR: u32 = 7;

impl Session {
    /// Begins with a model; `name` is the base name of its results.
    pub fn new(model: Model, name: &str, options: Options) -> Self {
        let mut options = options;
        options.choose_in(&model);
        let units = units(&model);
        let mut run = Run::new(name, model.title.clone(), units);
        let columns = Columns::chosen(
            &model,
            &mut run,
            &options.columns,
            &options.selection(),
            &|_, _| false,
            Columns::default(),
        );
        run.record.repeats = options.repeat.max(1) as u32;
        let limit = options.limit.map(WorkLimit::begin);
        Self {
            model,
            run,
            options,
            columns,
            carried: None,
            changing: BTreeSet::new(),
            kept: None,
            kept_model: None,
            goes_on: false,
            columns_program: None,
            columns_at_start: None,
            hooks: Vec::new(),
            linear: Vec::new(),
            saved: std::collections::BTreeMap::new(),
            folders: Vec::new(),
            at_rest_first: false,
            is_checked: false,
            ends_with_commands: false,
            is_last: false,
            halted: false,
            gaps: Gaps::default(),
            scratch: columns::Scratch::default(),
            rows_to_come: 0,
            purpose: Purpose::Motion,
            records_again: false,
            receiver: None,
            limit,
            ended_early: None,
            leap: None,
            leapt: BTreeSet::new(),
            weighed: None,
            activity: Activity::default(),
            shells: None,
            companion: None,
            strayed: false,
            pace: Pace::default(),
            last: Integrated::default(),
            beside: None,
            stiffness: MetStiffness::default(),
            states: Vec::new(),
            starts: Starts::default(),
            structures: Structures::default(),
        }
    }

    /// Computes what `USER(…)` stands for by a closure.
    ///
    /// `name` is an element ("SFORCE/3", or by its name), the text of its ROUTINE, or the first
    /// number of `USER(…)`; `inputs` are expressions of the function language whose values the
    /// closure is given, in this order. They may not depend on what it computes. See
    /// [`closures::Law`] for what it has to fill in. Of several that stand for one `USER(…)` the
    /// last counts.
    pub fn register(
        &mut self,
        name: &str,
        inputs: &[&str],
        law: impl Fn(&closures::Call<'_>, &mut [f64]) + Send + Sync + 'static,
    ) {
        self.register_hook(closures::Hook {
            name: name.to_string(),
            inputs: inputs.iter().map(ToString::to_string).collect(),
            law: std::sync::Arc::new(law),
        });
    }

    /// Says that the model was read without errors and is as it was read: the first simulation
    /// begins without checking it again. What a model with mistakes gives then is not said.
    pub fn was_read(&mut self) {
        self.is_checked = true;
    }

    /// Says that nothing is asked of this session after the commands that it will obey: the last
    /// simulation keeps nothing to go on with.
    pub fn end_with_commands(&mut self) {
        self.ends_with_commands = true;
    }

    /// Chooses the columns anew after a command has changed the model, while there are no rows.
    fn model_changed(&mut self) {
        self.is_checked = false;
        if self.carried.is_none() && self.run.rows() == 0 {
            self.choose_columns();
        }
    }

    /// Chooses the columns of the results, before there are any rows.
    fn choose_columns(&mut self) {
        self.options.choose_in(&self.model);
        let hooks = &self.hooks;
        let known = |id: u32, user: &crate::model::Formula| {
            let element = ElementKind::Request.id(id);
            closure_for(hooks, element, user).is_some()
        };
        let (run, options) = (&mut self.run, &self.options);
        self.columns = Columns::chosen(
            &self.model,
            run,
            &options.columns,
            &options.selection(),
            &known,
            std::mem::take(&mut self.columns),
        );
    }

    /// Tells which VARIABLEs will be changed between simulations: where their functions are
    /// numbers, these stay outside the equations, which then need not be written anew.
    pub fn will_change(&mut self, variables: impl IntoIterator<Item = u32>) {
        self.changing.extend(variables);
    }

    /// Returns the options that it was begun with.
    pub(in crate::analysis) fn options(&self) -> &Options {
        &self.options
    }

    /// Returns true if a sensor has ended the run.
    pub fn halted(&self) -> bool {
        self.halted
    }

    /// Returns what the session is doing, as another thread may ask.
    pub fn activity(&self) -> Activity {
        self.activity.clone()
    }

    /// Returns the system of the last simulation as it was left, if it is still there.
    pub(in crate::analysis) fn kept_system(&mut self) -> Option<&mut System> {
        self.kept.as_mut().map(|kept| kept.system_mut())
    }

    /// The clock.
    pub fn time(&self) -> f64 {
        self.carried.as_ref().map_or(0.0, |c| c.t)
    }

    /// Linearizes the model about its present state; before any simulation, about its initial
    /// conditions.
    ///
    /// # Errors
    /// Mistakes in the model, and functions without derivatives.
    pub fn linearize(&mut self, wanted: &linear::Wanted) -> Result<Linearization, Error> {
        let inputs = linear::inputs(&self.model, wanted).map_err(Error::from)?;
        let (mut system, assembly) = self.prepare(LINEAR, &inputs, &mut Unwatched)?;
        self.first_facts(&system, &assembly);
        let found = linear::linearize(&mut system, &self.model, wanted)?;
        if let Some(unrest) = found.unrest.clone() {
            self.warn(RunWarning::Unrest {
                at: found.time,
                unrest,
                is_settled: self.carried.as_ref().is_some_and(|c| c.at_rest),
                units: self.run.units.clone(),
            });
        }
        for line in found.table().lines() {
            self.run.log.push(Event::Info(line.to_string()));
        }
        Ok(found)
    }

    /// Runs one simulation up to `end` with `steps` output steps at equal distances, at least one.
    ///
    /// `end` is absolute time, in the unit of the model. A numerical failure is no error but a
    /// [`Status`], with the results so far: see the record of [`Session::run`].
    ///
    /// # Errors
    /// Mistakes in the model ([`Model::check`]), in the options, in the names of closures; an end
    /// that is not finite or has passed.
    pub fn simulate(
        &mut self,
        analysis: Analysis,
        end: f64,
        steps: usize,
        watch: &mut dyn Watch,
    ) -> Result<Status, Error> {
        self.simulate_with(analysis, end, Output::Steps(steps), watch)
    }
}
