//! One simulation: what it is, whether it can be run, and what is told before and after it.

use super::companion::Integrated;
use super::kept::{Kept, Prepared};
use super::limit::SetUp;
use super::phase::Phase;
use super::{Accuracy, Analysis, DYNAMIC, INITIAL_CONDITIONS, KINEMATIC, STATIC, Session};
use crate::analysis::quantity::short;
use crate::analysis::start::assemble::{self, Assembly};
use crate::analysis::system::System;
use crate::analysis::time::drives;
use crate::analysis::time::output::Output;
use crate::analysis::verify::driving::driving;
use crate::analysis::verify::massless::massless;
use crate::analysis::warning::{RunWarning, Warning};
use crate::analysis::watch::Watch;
use crate::diagnostic::{Cause, Diagnostic, Error, Severity};
use crate::expr::program::Program;
use crate::model::ElementKind;
use crate::results::{Event, Kind, Status};
use crate::scene::asker::Asker;
use crate::scene::equations::Equations;
use crate::scene::layout::Layout;
use crate::scene::{Row, Scene};

/// Velocities times links of the largest scene that is searched for free directions without mass
/// before each run: a motion of all links takes about a microsecond per link.
const MAX_MASSLESS_SEARCH: usize = 200_000;

/// The time that a simulation covers, and its output times.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub start: f64,
    pub end: f64,
    pub output: Output,
}

impl Session {
    /// Runs one simulation, whose hooks know of the limit of work where there is one.
    ///
    /// # Errors
    /// Mistakes in the model.
    pub(super) fn simulate_within(
        &mut self,
        analysis: Analysis,
        end: f64,
        output: Output,
        watch: &mut dyn Watch,
    ) -> Result<Status, Error> {
        if self.options.accuracy != Accuracy::Bars {
            return self.simulate_alone(analysis, end, output, watch);
        }
        let begun = self.begin_companion();
        let status = self.simulate_alone(analysis, end, output, watch)?;
        let phase = Phase::begin();
        self.follow(begun, |companion| {
            companion.simulate_alone(analysis, end, output, watch)
        });
        let (own, translation) = phase.elapsed();
        self.run.record.seconds.accuracy += own + translation;
        Ok(status)
    }

    /// Runs one simulation.
    ///
    /// # Errors
    /// Mistakes in the model.
    fn simulate_alone(
        &mut self,
        analysis: Analysis,
        end: f64,
        output: Output,
        watch: &mut dyn Watch,
    ) -> Result<Status, Error> {
        self.last = Integrated::default();
        // what is asked for
        let asked = [
            self.check_method(),
            self.check_settings(),
            self.check_times(analysis, end, output),
            self.check_rows(),
        ];
        let wrong: Vec<Diagnostic> = asked
            .into_iter()
            .filter_map(Result::err)
            .flatten()
            .collect();
        if !wrong.is_empty() {
            return Err(wrong.into());
        }
        // programs of earlier runs differ in their constants alone, where they do
        let _looking = (self.options.keep_start).then(|| self.structures.look());
        // the system in its state, and which analysis moves it
        let (mut system, assembly, analysis) = self.begin(analysis, watch)?;
        self.run.switch(&self.model.inactive);
        self.check_masses(&system, analysis)?;
        self.check_drives(&system, analysis, end)?;
        // what is told before it moves
        if !self.goes_on {
            self.first_facts(&system, &assembly);
            self.warn_of_start(&system, &assembly);
        }
        let phase = Phase::begin();
        let program = self.columns_program(&system)?;
        phase.end(&mut self.run.record.seconds, |s| &mut s.record);
        self.may_go_on(SetUp::Columns, watch)?;
        if self.carried.is_none() || analysis == Analysis::InitialConditions {
            self.show_start(&system, &assembly, &program);
        }
        // the analysis
        let (active, start) = (system.configuration.active.clone(), self.time());
        let span = Span { start, end, output };
        let status = match analysis {
            Analysis::InitialConditions => {
                let numbers = system.numbers.clone();
                self.keep(&system, numbers);
                Status::Completed
            }
            Analysis::Static => self.at_rest(&mut system, span, &program, watch),
            _ => self.over_time(&mut system, analysis, span, &program, watch)?,
        };
        if system.configuration.active != active {
            // reactions are others
            self.columns_program = None;
        }
        watch.simulated(&self.run);
        // what the next simulation may go on with
        if let Some(start) = self.starts.systems.get_mut(&(system.scene.mode as u32)) {
            start.take_derivatives(&system);
        }
        if self.hooks.is_empty() && analysis == Analysis::Dynamic && status == Status::Completed {
            let model = (!self.is_last).then(|| self.made_of(&system.scene));
            self.kept = Some(Box::new(Kept::new(model, DYNAMIC, system, assembly)));
        }
        Ok(status)
    }

    /// Brings the model into its state; which analysis moves it, as its freedom says.
    pub(super) fn begin(
        &mut self,
        asked: Analysis,
        watch: &mut dyn Watch,
    ) -> Result<(System, Assembly, Analysis), Vec<Diagnostic>> {
        let mode = match asked {
            Analysis::Kinematic => KINEMATIC,
            Analysis::InitialConditions => INITIAL_CONDITIONS,
            Analysis::Static => STATIC,
            Analysis::Dynamic | Analysis::Transient => DYNAMIC,
        };
        let (system, assembly, analysis) = match mode {
            DYNAMIC => match self.prepare_dynamics(watch)? {
                Prepared::Moves(system, assembly) => (*system, assembly, Analysis::Dynamic),
                Prepared::Still(scene, assembly) => {
                    if asked == Analysis::Dynamic {
                        self.warn_of_no_freedom(&scene);
                    }
                    let (system, _) = self.prepare(KINEMATIC, &[], watch)?;
                    (system, assembly, Analysis::Kinematic)
                }
            },
            _ => {
                let (system, assembly) = self.prepare(mode, &[], watch)?;
                if asked == Analysis::Kinematic {
                    if let Some(row) = system.scene.rows.iter().find(|r| r.is_of_velocities()) {
                        return Err(vec![is_of_velocities(row)]);
                    }
                    if assembly.freedom > 0 {
                        return Err(vec![has_freedom(assembly.freedom)]);
                    }
                }
                if asked == Analysis::Static {
                    check_rest(&system)?;
                }
                (system, assembly, asked)
            }
        };
        let contacts = self
            .model
            .active(ElementKind::Contact, &self.model.contacts);
        let contacts: Vec<_> = contacts.map(|c| ElementKind::Contact.id(c.0)).collect();
        if analysis == Analysis::Kinematic && !contacts.is_empty() {
            self.warn(RunWarning::ContactsWithoutFreedom(contacts));
        }
        Ok((system, assembly, analysis))
    }

    /// Warns that motions, or joints alone, decide how everything moves.
    fn warn_of_no_freedom(&mut self, scene: &Scene) {
        if !scene.motions.is_empty() {
            self.warn(RunWarning::NoFreedom);
        } else if !scene.parts.is_empty() {
            self.warn(RunWarning::Held);
        }
    }

    /// Checks that nothing moves without mass when dynamics begins, and when other parts or joints
    /// move than before.
    pub(super) fn check_masses(
        &mut self,
        system: &System,
        analysis: Analysis,
    ) -> Result<(), Vec<Diagnostic>> {
        let scene = &system.scene;
        if analysis != Analysis::Dynamic || !is_searched_for_masses(scene) {
            return Ok(());
        }
        let weighed = (scene.unknowns.v.clone(), scene.rows.len());
        if self.carried.is_some() && self.weighed.as_ref() == Some(&weighed) {
            return Ok(());
        }
        let (l, numbers) = (system.scene.layout, &system.numbers);
        let (q, x) = (&numbers[l.q()], &numbers[l.x()]);
        let massless = massless(
            system.configured(),
            &self.model,
            numbers[Layout::TIME],
            q,
            x,
        );
        if massless.is_empty() {
            self.weighed = Some(weighed);
            Ok(())
        } else {
            Err(massless)
        }
    }

    /// Checks that motions do not jump, or notes where they do when somebody insists.
    pub(super) fn check_drives(
        &mut self,
        system: &System,
        analysis: Analysis,
        end: f64,
    ) -> Result<(), Vec<Diagnostic>> {
        if !matches!(analysis, Analysis::Kinematic | Analysis::Dynamic) {
            return Ok(());
        }
        let breaks = drives::breaks(system, self.time(), end)?;
        let refused = drives::refused(&breaks);
        if !refused.is_empty() && !self.options.piecewise {
            return Err(refused);
        }
        for warning in drives::warnings(&breaks, self.options.piecewise) {
            self.warn(warning);
        }
        let jumps = breaks.into_iter().filter(|b| b.order < 2);
        self.run.record.piecewise.extend(jumps.map(|b| b.into()));
        Ok(())
    }

    /// Warns of what assembly and the scene found.
    fn warn_of_start(&mut self, system: &System, assembly: &Assembly) {
        for warning in &assembly.warnings {
            self.warn(warning.clone());
        }
        for found in &system.scene.warnings {
            self.warn(Warning::Scene(found.clone()));
        }
        let is_first = self.run.record.simulations.is_empty();
        if is_first {
            for found in driving(&system.scene, &self.model) {
                self.warn(Warning::Scene(found));
            }
        }
        let leap = self.leap.take();
        let leap = leap.filter(|leap| leap.leaps().is_none_or(|part| self.leapt.insert(part)));
        if let Some(leap) = leap {
            self.warn(Warning::Assembly(leap));
        }
    }

    /// Puts out the state in which a simulation begins.
    fn show_start(&mut self, system: &System, assembly: &Assembly, program: &Program) {
        self.run.log.push(Event::InitialConditions {
            time: self.time(),
            iterations: assembly.iterations as u32,
        });
        let first = std::slice::from_ref(&system.numbers);
        self.rows(Kind::InitialConditions, program, first);
        self.remember((system, &system.configuration.active), first, |_| None);
    }

    /// Returns the program of the columns; warns of columns that cannot be computed.
    ///
    /// # Errors
    /// The columns among those that the user asked for.
    pub(super) fn columns_program(&mut self, system: &System) -> Result<Program, Vec<Diagnostic>> {
        self.columns.begin(system.configured(), &system.numbers);
        if let Some(program) = &self.columns_program {
            return Ok(program.clone());
        }
        let (program, complaints) = match self.columns_at_start.take() {
            Some(kept) => kept,
            None => self.columns.program(system.configured()),
        };
        let start = self.starts.systems.get_mut(&(system.scene.mode as u32));
        if let Some(start) = start.filter(|_| self.carried.is_none()) {
            start.keep_columns(&program, &complaints);
        }
        for complaint in complaints {
            let wanted = |text: &str| self.options.columns.iter().any(|column| column == text);
            if matches!(&complaint.asked_by, Asker::Column(text) if wanted(text)) {
                let refused = Diagnostic {
                    severity: Severity::Error,
                    ..complaint.warning()
                };
                return Err(vec![refused]);
            }
            self.warn(RunWarning::EmptyColumn(complaint));
        }
        self.columns_program = Some(program.clone());
        Ok(program)
    }
}

fn has_freedom(freedom: usize) -> Diagnostic {
    let what =
        format!("a kinematic simulation needs a mechanism without freedom; this one has {freedom}");
    Diagnostic::error(Cause::Freedom, what)
        .help("drive the remaining freedoms by MOTION, or simulate dynamically")
}

/// Checks that nothing asks for velocities of a system at rest.
fn check_rest(system: &System) -> Result<(), Vec<Diagnostic>> {
    let scene = system.configured();
    let at = Equations::new(scene, &system.numbers);
    let rows = scene.rows.iter().enumerate();
    let asked = rows
        .filter(|(_, row)| row.is_of_velocities())
        .filter_map(|(r, row)| {
            let off = at.row_rate(&at.row(r));
            let rests = off.abs() <= assemble::CLOSED * scene.row_scale(r);
            (!rests).then(|| {
                let what = format!(
                    "its FUNCTION is {} without velocities: nothing can rest",
                    short(off)
                );
                Diagnostic::error("gcon_at_rest", what)
                    .element(row.element)
                    .help("simulate dynamically, or DEACTIVATE it before statics")
            })
        });
    let asked: Vec<Diagnostic> = asked.collect();
    match asked.is_empty() {
        true => Ok(()),
        false => Err(asked),
    }
}

/// Returns the error of an equation of velocities in kinematics.
fn is_of_velocities(row: &Row) -> Diagnostic {
    let what = "a kinematic simulation goes from position to position, and its FUNCTION holds \
                velocities alone";
    Diagnostic::error(Cause::Freedom, what)
        .element(row.element)
        .help("simulate dynamically: velocities are followed in time")
}

/// Returns whether the free directions of a scene are few enough to look for those without mass.
fn is_searched_for_masses(scene: &Scene) -> bool {
    scene.layout.n_v * scene.links.len() <= MAX_MASSLESS_SEARCH
}
