//! The start of a simulation: the model compiled as it is now, in the state that the last
//! simulation left or that is assembled.

use super::carried::{Carried, has_new_unknowns, moved};
use super::kept::Prepared;
use super::limit::SetUp;
use super::phase::Phase;
use super::placed::{Assembled, Drawn, Found, Placed, Velocities};
use super::shells;
use super::spline_range::{SplineCall, spline_calls};
use super::state_at_start::Start;
use super::{DYNAMIC, INITIAL_CONDITIONS, KINEMATIC, LINEAR, STATIC, Session};
use crate::analysis::look::Look;
use crate::analysis::start::assemble::{self, Assembly};
use crate::analysis::start::velocities::Beginning;
use crate::analysis::start::{
    coincident, embedded, initial_conditions, leap, misalignment, velocities,
};
use crate::analysis::system::external_inputs::ExternalInputs;
use crate::analysis::system::samples;
use crate::analysis::system::{Purpose, System, complaints};
use crate::analysis::verify::culprit::blamed;
use crate::analysis::warning::{AssemblyWarning, Warning};
use crate::analysis::watch::Watch;
use crate::diagnostic::{Diagnostic, Error};
use crate::model::Model;
use crate::numeric::Ode;
use crate::scene::Scene;
use crate::scene::build;
use crate::scene::configuration::Configured;
use crate::scene::contacts::Shell;
use crate::scene::external_inputs::ExternalInput;
use crate::scene::layout::Layout;
use crate::scene::recorder::Recorder;
use std::collections::BTreeMap;
use std::sync::Arc;

impl Session {
    /// Compiles the model for a MODE, as the present columns need it.
    pub(super) fn compile_again(&mut self, mode: u32) -> Result<Arc<Scene>, Error> {
        Ok(self.compile(mode, &[])?.0)
    }

    /// Brings the model for a MODE, with VARIABLEs that are inputs, into its state.
    pub(super) fn prepare(
        &mut self,
        mode: u32,
        inputs: &[u32],
        watch: &mut dyn Watch,
    ) -> Result<(System, Assembly), Vec<Diagnostic>> {
        if let Some(before) = self.before(mode, inputs) {
            return Ok(before);
        }
        let (start, v, assembly) = self.assembled(mode, inputs, watch)?;
        let system = self.recorded((start, v), &assembly, inputs, watch)?;
        Ok((system, assembly))
    }

    /// Brings the model for dynamics into its state; without freedom, nothing is recorded.
    pub(super) fn prepare_dynamics(
        &mut self,
        watch: &mut dyn Watch,
    ) -> Result<Prepared, Vec<Diagnostic>> {
        if let Some((system, assembly)) = self.before(DYNAMIC, &[]) {
            return Ok(Prepared::Moves(Box::new(system), assembly));
        }
        if let Some((scene, assembly)) = self.still_before() {
            return Ok(Prepared::Still(scene, assembly));
        }
        let (start, v, assembly) = self.assembled(DYNAMIC, &[], watch)?;
        // velocities that equations determine are followed in time
        if assembly.freedom > 0 || assembly.of_velocities > 0 {
            let system = self.recorded((start, v), &assembly, &[], watch)?;
            return Ok(Prepared::Moves(Box::new(system), assembly));
        }
        self.keep_still(&start.scene, &assembly);
        Ok(Prepared::Still(start.scene, assembly))
    }

    /// Compiles the model and assembles it: the start, its velocities, and what assembly found.
    fn assembled(
        &mut self,
        mode: u32,
        inputs: &[u32],
        watch: &mut dyn Watch,
    ) -> Result<(Start, Vec<f64>, Assembly), Vec<Diagnostic>> {
        self.columns_program = None;
        // a model that differs in its loads alone from one that was assembled is as right as that
        let before = self.placed_before(mode, inputs);
        let was_checked = std::mem::take(&mut self.is_checked);
        if before.is_none() && !was_checked {
            self.model.checked()?;
        }
        self.check_closures()?;
        self.check_choice()?;
        self.may_go_on(SetUp::Reading, watch)?;
        let phase = Phase::begin();
        let (scene, moved) = self.compile(mode, inputs)?;
        phase.end(&mut self.run.record.seconds, |s| &mut s.compile);
        self.may_go_on(SetUp::Compiling, watch)?;
        let phase = Phase::begin();
        let mut start = Start::new(scene, mode, self.time());
        let first = self.carried.is_none();
        let (mut assembly, found) = self.looking(SetUp::Compiling, watch, |session, look| {
            if first {
                session.assemble(&mut start, before.as_deref(), look)
            } else {
                Ok((session.go_on(&mut start, look)?, None))
            }
        })?;
        self.may_go_on(SetUp::Assembling, watch)?;
        (start.configuration).begin_states(&start.scene, &mut start.x);
        self.looking(SetUp::Assembling, watch, |session, look| {
            session.begin_rates(&mut start, look)
        })?;
        start.begin_turns(self.carried.as_ref());
        let before = before.filter(|_| found.is_none());
        let (begun, unmet) = match before.and_then(|placed| placed.velocities(&start.scene)) {
            Some(velocities) => velocities,
            None => self.looking(SetUp::Assembling, watch, |session, look| {
                session.velocities(&mut start, moved.as_ref(), look)
            })?,
        };
        if let Some(found) = found.filter(|_| self.keeps_place(inputs)) {
            self.keep_place(mode, found, (begun.clone(), unmet.clone()));
        }
        let v = begun.v;
        assembly.warnings.extend(unmet);
        phase.end(&mut self.run.record.seconds, |s| &mut s.assemble);
        self.may_go_on(SetUp::Velocities, watch)?;
        Ok((start, v, assembly))
    }

    /// Records the programs of a start.
    fn recorded(
        &mut self,
        (start, v): (Start, Vec<f64>),
        assembly: &Assembly,
        inputs: &[u32],
        watch: &mut dyn Watch,
    ) -> Result<System, Vec<Diagnostic>> {
        let mode = start.mode;
        let phase = Phase::begin();
        let looks = self.records_again && !self.options.keep_start;
        let looking = looks.then(|| {
            self.structures.next_generation();
            self.structures.look()
        });
        let mut system = self.system(start, v, watch)?;
        drop(looking);
        self.leap = self.leap_of(&mut system, mode);
        let is_kept = self.carried.is_none() && self.options.keep_start && inputs.is_empty();
        if is_kept && mode == DYNAMIC {
            // every run watches it
            system.prepare_energy();
        }
        phase.end(&mut self.run.record.seconds, |s| &mut s.record);
        self.may_go_on(SetUp::Recording, watch)?;
        if is_kept {
            let start = self.kept_start(mode, &system, assembly);
            self.starts.systems.insert(mode, start);
        }
        self.begin_companion_at(mode, inputs, &system, assembly);
        Ok(system)
    }

    /// Compiles the model; where commands have changed what carries a part, with its parts where
    /// the last simulation left them, which is that model: the place of such a part is no unknown
    /// of before.
    fn compile(
        &mut self,
        mode: u32,
        inputs: &[u32],
    ) -> Result<(Arc<Scene>, Option<Model>), Vec<Diagnostic>> {
        let mut extra = self.columns.extra.clone();
        extra.extend(spline_calls(&self.model).iter().map(SplineCall::extra));
        let mut options = build::Options {
            mode,
            extra,
            variables: self.columns.show_joint_variables(),
            skip: self.options.skip.clone(),
            hooks: self.hooks.clone(),
            zero_user: self.options.zero_user,
            plant_inputs: inputs.to_vec(),
            changing: self.changing.clone(),
            shells: self.shells(),
            ..build::Options::default()
        };
        let compiled = match Scene::compile(&self.model, &options) {
            // a motion may read a number, but no external input
            Err(_) if !options.changing.is_empty() => {
                options.changing.clear();
                Scene::compile(&self.model, &options)?
            }
            outcome => outcome?,
        };
        let moved = (self.carried.as_ref())
            .filter(|carried| has_new_unknowns(&compiled, carried))
            .map(|carried| moved(&self.model, carried));
        let scene = match &moved {
            Some(moved) => Scene::compile(moved, &options)?,
            None => compiled,
        };
        Ok((scene, moved))
    }

    /// Goes on from the state of the last simulation.
    fn go_on(&self, start: &mut Start, look: Look<'_>) -> Result<Assembly, Vec<Diagnostic>> {
        if let Some(carried) = &self.carried {
            start.take_over(carried);
            self.begin_motions(start, carried);
        }
        start.configuration.external = self.external(start.here(), start.t, &start.q, &start.x)?;
        start.positions(look)
    }

    /// Assembles the first state: from the dataset, to initial conditions as far as rows let it; or
    /// puts it where another was assembled that began with the same. Returns what assembly began
    /// and ended with, too, where it has been done.
    fn assemble(
        &mut self,
        start: &mut Start,
        before: Option<&Placed>,
        look: Look<'_>,
    ) -> Result<Assembled, Vec<Diagnostic>> {
        // the dataset
        if start.mode != KINEMATIC && start.mode != STATIC {
            initial_conditions::initial_joints(&start.scene, &self.model, &mut start.q);
        }
        for m in 0..start.scene.motions.len() {
            self.initial_motion(&start.scene, m, &mut start.x);
        }
        start.configuration.external = self.external(start.here(), start.t, &start.q, &start.x)?;
        let (mut assembly, found) = match before.and_then(|placed| placed.put(start)) {
            Some(assembly) => (assembly, None),
            None => {
                let drawn = Drawn::of(start);
                let assembly = self.onto_rows(start, look)?;
                let found = Found {
                    configuration: start.configuration.clone(),
                    q: start.q.clone(),
                    assembly: assembly.clone(),
                };
                (assembly, Some((drawn, found)))
            }
        };
        // what forces do there
        let (here, t, q, x) = (start.here(), start.t, &start.q, &start.x);
        let still = vec![0.0; here.layout.n_v];
        let numbers = assemble::numbers(here, t, q, &still, x);
        let coincident = coincident::lines(here, &numbers)?;
        let deep = embedded::contacts(here, &numbers);
        let of_forces = coincident.into_iter().chain(deep).map(Warning::from);
        assembly.warnings.extend(of_forces);
        Ok((assembly, found))
    }

    /// Moves the first state onto the rows. Masses, springs and gravity have no say in it: what
    /// this is of one model is kept for others.
    fn onto_rows(&self, start: &mut Start, look: Look<'_>) -> Result<Assembly, Vec<Diagnostic>> {
        let mode = start.mode;
        let joints = mode == DYNAMIC || mode == INITIAL_CONDITIONS;
        let moves = mode != KINEMATIC && mode != STATIC;
        let orders = if joints {
            misalignment::orders(&start.scene, &self.model)
        } else {
            Vec::new()
        };
        let misaligned = misalignment::misaligned(&start.scene, &self.model);
        let conditions = if moves {
            initial_conditions::collect(&start.scene, &self.model)
        } else {
            Vec::new()
        };
        let drawn = (start.t, &start.q[..], &start.x[..]);
        let driven = misalignment::driven(&start.scene, &start.configuration, drawn);
        // the rows, and what they did not let be met
        let (mut assembly, contacts) = (start.assemble(&self.model, &conditions, look))
            .map_err(|said| blamed(&self.model, said))?;
        let (here, t, q, x) = (start.here(), start.t, &start.q, &start.x);
        let warnings = &mut assembly.warnings;
        let unmet = initial_conditions::unmet(here, &conditions, &contacts, t, q, x);
        warnings.extend(unmet.into_iter().map(Warning::from));
        warnings.splice(0..0, misaligned.into_iter().map(Warning::from));
        warnings.extend(orders.into_iter().map(Warning::from));
        let still = vec![0.0; here.layout.n_v];
        let numbers = assemble::numbers(here, t, q, &still, x);
        let turned = misalignment::turned(here, &self.model, &numbers, moves);
        let moved = driven.into_iter().chain(turned);
        warnings.extend(moved.map(Warning::from));
        Ok(assembly)
    }

    /// Returns the velocities to start with: those of before, else those of the model on the rows;
    /// and the warnings of those that the model gives and that are not met.
    fn velocities(
        &self,
        start: &mut Start,
        moved: Option<&Model>,
        look: Look<'_>,
    ) -> Result<Velocities, Vec<Diagnostic>> {
        let mode = start.mode;
        let begun = self.velocities_on_rows(start, moved, look)?;
        if self.carried.is_some() || mode != DYNAMIC && mode != INITIAL_CONDITIONS {
            return Ok((begun, Vec::new()));
        }
        let (here, t, q, x) = (start.here(), start.t, &start.q, &start.x);
        let unmet = velocities::unmet(here, &self.model, t, (q, &begun.v, x));
        Ok((begun, unmet.into_iter().map(Warning::from).collect()))
    }

    fn velocities_on_rows(
        &self,
        start: &mut Start,
        moved: Option<&Model>,
        look: Look<'_>,
    ) -> Result<Beginning, Vec<Diagnostic>> {
        let at_rest = self.is_at_rest();
        if start.mode == STATIC || start.mode == LINEAR && at_rest {
            return Ok(Beginning::fixed(vec![0.0; start.scene.layout.n_v]));
        }
        if let Some(v) = start.v.take() {
            return Ok(Beginning::fixed(v));
        }
        let given = moved.filter(|_| !at_rest).unwrap_or(&self.model);
        let at = (start.t, &start.q[..], &start.x[..]);
        velocities::velocities_while(start.here(), given, at, look)
            .map_err(|said| blamed(given, said))
    }

    /// Records the programs and puts the system into its state, with past, samples and sensors.
    /// Columns, which a simulation shows, read much of what the rates read, and are recorded with
    /// them.
    fn system(
        &mut self,
        start: Start,
        v: Vec<f64>,
        watch: &mut dyn Watch,
    ) -> Result<System, Vec<Diagnostic>> {
        let (mode, t) = (start.mode, start.t);
        let mut y = start.q;
        y.extend(v);
        y.extend(start.x);
        let hooks = self.hooks.clone();
        self.looking(SetUp::Velocities, watch, |session, look| {
            let (scene, configuration) = (start.scene, start.configuration);
            let purpose = session.purpose;
            let then = |system: &mut System, recorder: &Recorder<'_, '_>| {
                session.put(system, (t, &y), mode)?;
                let shows = purpose == Purpose::Motion && mode != LINEAR;
                if shows && !session.columns.is_empty() {
                    let columns = session.columns.program_beside(recorder, &system.numbers);
                    session.columns_at_start = Some(columns);
                }
                Ok(())
            };
            System::recorded_while(scene, configuration, &hooks, purpose, look, then)
        })
    }

    /// Returns what a system that goes on does to the parts as the last simulation left them.
    fn leap_of(&self, system: &mut System, mode: u32) -> Option<AssemblyWarning> {
        let carried = self.carried.as_ref()?;
        let moves = !carried.at_rest && matches!(mode, DYNAMIC | KINEMATIC);
        let y = system.scene.layout.y();
        let (t, mut numbers) = (carried.t, system.numbers.clone());
        if moves && !system.scene.rows.is_empty() {
            // velocities are put onto rows by the first step
            let mut state = numbers[y.clone()].to_vec();
            let done = system.aside(|system| Ode::project(system, t, &mut state));
            system.numbers.copy_from_slice(&numbers);
            if done.is_ok() {
                numbers[y].copy_from_slice(&state);
            }
        }
        leap::of_parts(
            system.configured(),
            &carried.parts,
            &numbers,
            moves.then_some(t),
        )
    }

    /// Brings a system into a state: its past, the numbers that follow, and what sensors see.
    ///
    /// # Errors
    /// Formulas that depend on themselves and have no value.
    pub(super) fn put(
        &self,
        system: &mut System,
        (t, y): (f64, &[f64]),
        mode: u32,
    ) -> Result<(), Vec<Diagnostic>> {
        let l = system.scene.layout;
        let carried = self.carried.as_ref();
        if let Some(carried) = carried {
            system.recorded.external.delays.begin(t, &carried.past);
        } else {
            system.recorded.external.delays.begin(t, &BTreeMap::new());
        }
        system.numbers[Layout::TIME] = t;
        system.numbers[l.states()].copy_from_slice(y);
        if let Err(k) = system.resolve() {
            let what = "it depends on itself, and no value solves that";
            return Err(vec![
                Diagnostic::error("loop", what)
                    .element(&system.scene.loops[k].asker)
                    .help("give an IC near the solution, where it has one"),
            ]);
        }
        let row = system.row(t, y);
        system.numbers.copy_from_slice(&row);
        system.count_turns(t, &row[l.y()]);
        let none = BTreeMap::new();
        let held = carried.map_or(&none, |c| &c.samples);
        system.begin_sampling(held).map_err(|d| vec![d])?;
        if mode != STATIC {
            system.follow_sensors(carried.map_or(&BTreeMap::new(), |c| &c.held));
            system.begin_sensing();
        }
        Ok(())
    }

    /// Returns the shells of contacts, read when they are first asked for.
    fn shells(&mut self) -> Arc<BTreeMap<u32, Result<Shell, String>>> {
        let load = || Arc::new(shells::load(&self.model, &self.folders));
        self.shells.get_or_insert_with(load).clone()
    }

    /// Returns the external inputs where assembly begins: values that sensors evaluated before, and
    /// results of closures in that configuration.
    pub(super) fn external(
        &self,
        scene: Configured<'_>,
        t: f64,
        q: &[f64],
        x: &[f64],
    ) -> Result<Vec<f64>, Vec<Diagnostic>> {
        let l = scene.layout;
        let mut numbers = vec![0.0; l.len()];
        let carried = self.carried.as_ref();
        let none = BTreeMap::new();
        let held = carried.map_or(&none, |c| &c.samples);
        for (place, input) in scene.external_inputs.iter().enumerate() {
            let sensor = scene.sensor_of(*input);
            let seen = sensor.and_then(|id| carried?.sensors.get(&id).copied());
            let value = seen.or_else(|| samples::before(&scene, *input, held));
            numbers[l.external_at(place)] = value.unwrap_or(0.0);
        }
        self.set_constants(&scene, &mut numbers);
        if !scene.hooks.is_empty() {
            numbers[Layout::TIME] = t;
            numbers[l.q()].copy_from_slice(q);
            numbers[l.x()].copy_from_slice(x);
            let angles = numbers[l.turns()].iter_mut();
            angles
                .zip(scene.configuration.angles())
                .for_each(|(x, angle)| *x = angle);
            let mut outside = ExternalInputs::new(scene, &self.hooks).map_err(complaints)?;
            outside.evaluate(&mut numbers, true);
        }
        Ok(numbers[l.external()].to_vec())
    }

    /// Puts the constants that commands change into their places.
    pub(super) fn set_constants(&self, scene: &Scene, numbers: &mut [f64]) {
        for (place, what) in scene.layout.external().zip(&scene.external_inputs) {
            if let ExternalInput::Constant(id) = what {
                let variable = self.model.variables.get(id);
                let value = variable.and_then(|v| v.function.constant());
                numbers[place] = value.unwrap_or(f64::NAN);
            }
        }
    }

    pub(super) fn is_at_rest(&self) -> bool {
        self.carried.as_ref().is_some_and(|c| c.at_rest)
    }

    /// Puts in the start of a motion given by its rate: ICDISP and ICVEL, else the displacement of
    /// the dataset's configuration and the joint's IC; rows begin in the assembled configuration.
    /// Lets motions whose states are new begin: where they are told to, else where their
    /// coordinates are.
    fn begin_motions(&self, start: &mut Start, carried: &Carried) {
        let scene = &start.scene;
        for (m, motion) in scene.motions.iter().enumerate() {
            let is_new = |&state: &usize| !carried.unknowns.contains(&scene.unknowns.x[state]);
            let Some(state) = motion.state.filter(is_new) else {
                continue;
            };
            self.initial_motion(scene, m, &mut start.x);
            let (Some(data), Some(c)) = (self.model.motions.get(&motion.id), motion.coordinate)
            else {
                continue;
            };
            let Some(&[value, rate]) = carried.coordinates.get(&scene.coordinates[c].id) else {
                continue;
            };
            if data.ic_displacement.is_none() {
                start.x[state] = value;
            }
            if motion.level == crate::model::Level::Acceleration && data.ic_velocity.is_none() {
                start.x[state + 1] = rate;
            }
        }
    }

    pub(super) fn initial_motion(&self, scene: &Scene, m: usize, x: &mut [f64]) {
        let Some(state) = scene.motions[m].state else {
            return;
        };
        let motion = &scene.motions[m];
        let Some(data) = self.model.motions.get(&motion.id) else {
            return;
        };
        let begins_there = scene.initial_displacement(m);
        x[state] = data.ic_displacement.or(begins_there).unwrap_or(0.0);
        if motion.level == crate::model::Level::Acceleration {
            let rate = scene.motions[m].coordinate.and_then(|c| {
                let coordinate = &scene.coordinates[c];
                let joint = self.model.joints.get(&coordinate.joint?)?;
                if coordinate.angular {
                    joint.ic_rotation[1]
                } else {
                    joint.ic_translation[1]
                }
            });
            x[state + 1] = data.ic_velocity.or(rate).unwrap_or(0.0);
        }
    }
}
