//! The model of a session at the prompt: read, looked at, changed, solved; the values of
//! expressions in it at any time, and its pictures.
//!
//! Values come from the rows of the last run where one has this time; else the commands are
//! followed up to that time.

use crate::arguments::SpanArgs;
use crate::render::Sources;
use crate::run::{self, Single};
use crate::writing::WritingArgs;
use crate::{Exit, complain_in_files, width};
use crate::{Failure, configuration, draw, elements, interrupt, summary, verify as verifying};
use cognate::analysis::session::script::obey;
use cognate::analysis::session::{Analysis, Options, Session, check_column};
use cognate::analysis::verify::verify;
use cognate::analysis::work_limit::ProcessClock;
use cognate::dataset::Reading;
use cognate::dataset::command::{Command, Step};
use cognate::diagnostic::{Cause, Diagnostic, Error, Severity, counted};
use cognate::disk;
use cognate::internals::report::{Curve, Plot};
use cognate::model::{ElementKind, Model};
use cognate::results::{Status, digits_of_six};
use std::path::{Path, PathBuf};

/// Output steps of a run when nobody says.
const STEPS: usize = 200;

/// A model that has been read, and what has been computed of it.
pub struct Loaded {
    file: PathBuf,
    /// base of the names of results
    base: String,
    reading: Reading,
    /// its commands; none for a dataset alone
    steps: Vec<Step>,
    /// the mechanism at the time that was asked for last
    present: Option<Session>,
    /// the last run, and the end and the output steps that were asked for
    run: Option<Session>,
    asked: (Option<f64>, Option<usize>),
    /// expressions that cannot be computed for the rows of a run that is over
    columns: Vec<String>,
}

/// The rows of a run between two times; `None`: all of them.
pub type Span = Option<(f64, f64)>;

impl Loaded {
    /// Reads a dataset, or a command file with its dataset.
    ///
    /// # Errors
    /// When a file cannot be read, or has mistakes.
    pub fn read(file: &Path) -> Result<Self, Failure> {
        let (reading, base, steps) = match run::has_commands(file) {
            true => {
                let job = run::script(file, None)?;
                (job.reading, job.base, job.steps)
            }
            false => (run::read(file)?, run::stem(file), Vec::new()),
        };
        Ok(Self {
            file: file.to_owned(),
            base,
            reading,
            steps,
            present: None,
            run: None,
            asked: (None, None),
            columns: Vec::new(),
        })
    }

    /// Tells what has been read and solved.
    pub fn info(&self) -> String {
        let model = &self.reading.model;
        let mut text = format!("{}: {}\n", disk::text(&self.file), model.title.trim());
        let kinds = ElementKind::ALL.iter();
        let kinds = kinds.map(|kind| (model.numbers(*kind).len(), kind.keyword()));
        let kinds = kinds.filter(|(n, _)| *n > 0);
        let kinds: Vec<String> = kinds.map(|(n, kind)| format!("{n} {kind}")).collect();
        text += &format!("{}\n", kinds.join(", "));
        let warnings = self.reading.diagnostics.iter();
        let warnings = warnings.filter(|d| d.severity == Severity::Warning).count();
        if warnings > 0 {
            let files = disk::text(&self.file);
            text += &format!(
                "{}, which cognate check {files} shows\n",
                counted(warnings, "warning")
            );
        }
        let ends = self.steps.iter().filter(|s| is_simulation(s));
        let ends: Vec<&str> = ends.map(|s| s.text.as_str()).collect();
        if !ends.is_empty() {
            text += &format!("its commands: {}\n", ends.join("; "));
        }
        if let Some(session) = &self.run {
            let run = &session.run;
            text += &format!(
                "{}: {}",
                run.record.status.word(),
                counted(run.rows(), "row")
            );
            text += &format!(", up to {}\n", digits_of_six(session.time()));
        }
        text
    }

    /// Returns whether an expression that cannot be read alone is one of the model: it calls
    /// elements by their names, or a component of results.
    pub fn knows(&self, expression: &str) -> bool {
        let model = &self.reading.model;
        let is_named = model
            .numbered(expression)
            .map_or(true, |n| n.text != expression);
        let is_letter = |c: char| c.is_alphabetic() || c == '_' || c == '\'';
        let mut dots = expression.match_indices('.');
        is_named || dots.any(|(at, _)| expression[..at].ends_with(is_letter))
    }

    /// Lists the elements of a kind, or all.
    pub fn list(&self, kind: Option<ElementKind>) -> String {
        let kinds: Vec<ElementKind> = kind.into_iter().collect();
        elements::list(&self.reading.model, &kinds)
    }

    /// Shows an element.
    ///
    /// # Errors
    /// When it does not exist.
    pub fn show(&self, element: &str) -> Result<String, Diagnostic> {
        let id = self.reading.model.find_element(element)?;
        elements::shown(&self.reading.model, &self.reading.dataset, id)
    }

    /// Gives an element another name.
    ///
    /// # Errors
    /// When it does not exist, or the name cannot be written.
    pub fn rename(&mut self, element: &str, name: &str) -> Result<(), Diagnostic> {
        let id = self.reading.model.find_element(element)?;
        self.changed(elements::renamed(&self.reading, id, name)?);
        Ok(())
    }

    /// Takes an element out.
    ///
    /// # Errors
    /// When it does not exist, or others name it.
    pub fn delete(&mut self, element: &str) -> Result<(), Diagnostic> {
        let id = self.reading.model.find_element(element)?;
        self.changed(elements::without(&self.reading, &[id])?);
        Ok(())
    }

    fn changed(&mut self, reading: Reading) {
        self.reading = reading;
        (self.present, self.run) = (None, None);
        self.columns.clear();
    }

    /// Writes the dataset as it is now.
    ///
    /// # Errors
    /// When the file cannot be written, or is the one that was read.
    pub fn save(&self, file: &Path) -> Result<(), Diagnostic> {
        let source = &self.reading.dataset.source;
        WritingArgs::default().bytes(file, &source.encode(source.own_text()))
    }

    /// Counts the freedoms, and says what is fixed twice and what is free.
    ///
    /// # Errors
    /// When the model has mistakes.
    pub fn verify(&self) -> Result<String, Failure> {
        let model = self.before_simulations()?;
        let found = verify(&model).map_err(|errors| self.failure(errors))?;
        let mut text = verifying::text::of(&found, &model);
        for d in found.inconsistent {
            text += &format!("{}\n", self.reading.dataset.locate(d));
        }
        Ok(text)
    }

    /// Returns the model as the commands leave it before the first simulation.
    fn before_simulations(&self) -> Result<Model, Failure> {
        let mut model = self.reading.model.clone();
        for step in self.steps.iter().take_while(|step| !is_simulation(step)) {
            let applied = model.apply(&step.command);
            applied.map_err(|e| self.failure(e))?;
        }
        Ok(model)
    }

    /// Solves the model: by its commands, or up to an end in some output steps. Prints a few rows.
    ///
    /// # Errors
    /// When there are neither commands nor an end, or the model cannot work.
    pub fn solve(&mut self, end: Option<f64>, steps: Option<usize>) -> Result<String, Failure> {
        let mut session = self.session(self.columns.clone());
        let alone;
        let clock = ProcessClock::start();
        let commands = match end {
            None if self.steps.iter().any(is_simulation) => &self.steps,
            None => {
                let what = "a dataset has no commands: `:run END` solves it up to a time";
                return Err(Failure::usage(what));
            }
            Some(end) => {
                alone = self.up_to(end, steps)?;
                &alone
            }
        };
        let solved = obey(&mut session, commands, |_, _| (), &mut interrupt::Listener);
        let status = solved.map_err(|errors| self.failure(errors))?;
        let seconds = &mut session.run.record.seconds;
        seconds.total = clock.elapsed().as_secs_f64();
        seconds.processor = clock.seconds();
        let run = &session.run;
        let n_rows = run.table_rows().count();
        let mut text = summary::table(run, n_rows, width::columns(), ":plot shows all");
        text += &summary::facts(run, &[]);
        if status != Status::Completed {
            complain_in_files(&session.model.doubts());
        }
        (self.present, self.run) = (None, Some(session));
        self.asked = (end, steps);
        Ok(text)
    }

    /// Returns the commands before the first simulation, and one simulation up to an end.
    fn up_to(&self, end: f64, steps: Option<usize>) -> Result<Vec<Step>, Failure> {
        let before = self.steps.iter().take_while(|step| !is_simulation(step));
        let single = run::alone_step(&Single {
            variables: &[],
            model: &self.file,
            dataset: None,
            span: SpanArgs {
                kind: None,
                end: Some(end),
                steps: Some(steps.unwrap_or(STEPS)),
            },
        })?;
        Ok(before.cloned().chain([single]).collect())
    }

    /// Returns the value of an expression at a time.
    ///
    /// # Errors
    /// Mistakes in the expression or the model; a time that the run does not reach.
    pub fn value(&mut self, expression: &str, time: f64) -> Result<f64, Failure> {
        if let Some(row) = self.run.as_ref().and_then(|s| row_at(s, time))
            && let Some(session) = &mut self.run
            && session.add_column(expression).is_ok()
        {
            return Ok(value_in(session, expression, row));
        }
        let is_there = |s: &Session| s.time() == time && s.run.rows() > 0;
        if !self.present.as_ref().is_some_and(is_there) {
            self.present = Some(self.at(time, Vec::new())?);
        }
        let added = self.present.as_mut().map(|s| s.add_column(expression));
        if let Some(Err(errors)) = added {
            if !errors.first().is(Cause::LateColumn) {
                return Err(self.mistaken(expression, errors));
            }
            // it has a past, which nobody has kept: it is named before
            self.present = Some(self.at(time, vec![expression.to_owned()])?);
        }
        let session = self.present.as_ref();
        let last = |s: &Session| value_in(s, expression, s.run.rows().saturating_sub(1));
        Ok(session.map_or(f64::NAN, last))
    }

    /// Returns a session that has been led to a time.
    fn at(&self, time: f64, columns: Vec<String>) -> Result<Session, Failure> {
        let mut session = self.session(columns);
        let is_start = time == 0.0 && !self.steps.iter().any(is_simulation);
        if is_start {
            let assembled = session.simulate(
                Analysis::InitialConditions,
                0.0,
                1,
                &mut interrupt::Listener,
            );
            assembled.map_err(|errors| self.failure(errors))?;
            return Ok(session);
        }
        let alone;
        let commands = match self.steps.iter().any(is_simulation) {
            true => &self.steps,
            false => {
                alone = self.up_to(time, Some(1))?;
                &alone
            }
        };
        let led = configuration::lead(&mut session, commands, time);
        match led.map_err(|errors| self.failure(errors))? {
            Some(_) => Ok(session),
            None => Err(configuration::not_reached(&session, time)),
        }
    }

    /// Returns an expression over the rows of the last run.
    ///
    /// # Errors
    /// When there is no run, or a mistake in the expression.
    pub fn plot(&mut self, expression: &str, span: Span) -> Result<Plot, Failure> {
        let without = || {
            let what = "there is no run: `:run` solves the model, then its results are there";
            Failure::usage(what)
        };
        let added = self.run.as_mut().ok_or_else(without)?;
        match added.add_column(expression) {
            Err(errors) if !errors.first().is(Cause::LateColumn) => {
                return Err(self.mistaken(expression, errors));
            }
            // commands have changed the model on the way, or it has a past: it is named before
            Err(_) => {
                self.columns.push(expression.to_owned());
                let (end, steps) = self.asked;
                let solved = self.solve(end, steps);
                solved.inspect_err(|_| drop(self.columns.pop()))?;
            }
            Ok(()) => {}
        }
        let session = self.run.as_ref().ok_or_else(without)?;
        let name = [expression.to_owned()];
        let mut plot = Plot::of_run(&session.run, None, &name)?;
        plot.title = String::new();
        if let Some((first, last)) = span {
            let cut = |curve: &mut Curve| curve.points.retain(|p| (first..=last).contains(&p.0));
            plot.curves.iter_mut().for_each(cut);
        }
        Ok(plot)
    }

    /// Draws the mechanism at a time.
    ///
    /// # Errors
    /// When the time is not reached, or the file cannot be written.
    pub fn draw(&mut self, time: f64, file: &Path) -> Result<(), Failure> {
        let has_time = |s: &Session| row_at(s, time).is_some();
        if self.run.as_ref().is_some_and(has_time) {
            let session = self.run.as_ref();
            return session.map_or(Ok(()), |s| draw::draw_at(s, time, file));
        }
        let session = self.at(time, Vec::new())?;
        draw::draw_at(&session, time, file)?;
        self.present = Some(session);
        Ok(())
    }

    /// Begins a session of the model, with the results that pictures need.
    fn session(&self, columns: Vec<String>) -> Session {
        let options = Options {
            full: true,
            keep_states: true,
            columns,
            ..Options::default()
        };
        let mut session = Session::new(self.reading.model.clone(), &self.base, options);
        let folder = self.file.parent().map(Path::to_path_buf);
        session.folders = folder.into_iter().collect();
        session
    }

    /// Returns the mistakes in an expression: those of the check, which have places, else the
    /// others.
    fn mistaken(&self, expression: &str, others: Error) -> Failure {
        let found = check_column(&self.reading.model, expression);
        match found.is_empty() {
            true => others.into(),
            false => Failure {
                exit: Exit::Input,
                diagnostics: found,
                sources: Sources::of(expression),
            },
        }
    }

    fn failure(&self, errors: Error) -> Failure {
        Failure::in_model(&self.reading.dataset, errors.into_diagnostics())
    }
}

fn is_simulation(step: &Step) -> bool {
    matches!(step.command, Command::Simulate(_))
}

/// Returns the last row of this time.
fn row_at(session: &Session, time: f64) -> Option<usize> {
    let times = session.run.columns.first()?;
    times.values.iter().rposition(|t| *t == time)
}

fn value_in(session: &Session, column: &str, row: usize) -> f64 {
    let values = session.run.column(column).unwrap_or_default();
    values.get(row).copied().unwrap_or(f64::NAN)
}
