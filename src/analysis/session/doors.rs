//! Doors of a session for programs: simulations without hooks, rows as they come, columns that are
//! named whenever they are wanted, and the way back to the start.

use super::catalogue::{check_column, expression_of};
use super::kept::Starts;
use super::{Analysis, Gaps, MetStiffness, Session};
use crate::analysis::system::closures::Hook;
use crate::analysis::watch::Unwatched;
use crate::analysis::work_limit::WorkLimit;
use crate::diagnostic::{Cause, Diagnostic, Error};
#[cfg(doc)]
use crate::model::Model;
use crate::results::{Run, Status};

impl Session {
    /// Runs one simulation as [`simulate`](Self::simulate) does, with nobody looking on.
    ///
    /// # Errors
    /// Those of [`simulate`](Self::simulate).
    pub fn run_to(&mut self, analysis: Analysis, end: f64, steps: usize) -> Result<Status, Error> {
        self.simulate(analysis, end, steps, &mut Unwatched)
    }

    /// Computes what `USER(…)` stands for by a closure that is shared; see
    /// [`register`](Self::register).
    pub fn register_hook(&mut self, mut hook: Hook) {
        for input in &mut hook.inputs {
            // a mistake in a name is told where the input is compiled
            if let Ok(numbered) = self.model.numbered(input) {
                *input = numbered.text;
            }
        }
        if !self.computes_something(&hook)
            && let Ok(id) = self.model.find_element(&hook.name)
        {
            hook.name = id.to_string();
        }
        let is_other = |other: &Hook| !other.name.eq_ignore_ascii_case(&hook.name);
        self.hooks.retain(is_other);
        self.hooks.push(hook);
        self.starts = Starts::default();
        if self.carried.is_none() {
            self.choose_columns();
        }
    }

    /// Hands each row of results to a closure while simulations go on: the values of all columns of
    /// [`Session::run`] in their order, time first. The rows are not kept then, however long a run
    /// is. They come some at a time, at most a second late.
    ///
    /// ```
    /// use cognate::{Analysis, Model, Options, Session};
    /// use std::sync::mpsc::channel;
    /// let model = Model::read("examples/slider_crank.adm")?;
    /// let mut session = Session::new(model, "crank", Options::default());
    /// let (sender, rows) = channel();
    /// session.stream(move |row| drop(sender.send(row[0])));
    /// session.run_to(Analysis::Dynamic, 0.1, 10)?;
    /// let times: Vec<f64> = rows.try_iter().collect();
    /// assert_eq!((times.len(), times[10]), (11, 0.1));
    /// # Ok::<(), cognate::Error>(())
    /// ```
    pub fn stream(&mut self, mut row: impl FnMut(&[f64]) + Send + 'static) {
        let mut values = Vec::new();
        self.receive(Box::new(move |run: &mut Run| {
            for k in 0..run.held().len() {
                values.clear();
                values.extend(run.columns.iter().map(|column| column.at(k)));
                row(&values);
            }
            run.release();
        }));
    }

    /// Adds a column, by whose text the run then knows it: an expression of the function language,
    /// in which elements may have their names (`DX(slider.cm, ground)`, see [`Model::numbered`]),
    /// or a component of a set of results (`crank_bearing.FX`).
    ///
    /// A session that is asked for no column records everything, as RESULTS does; with the first
    /// column it records what it is asked for.
    ///
    /// After a simulation its values in the rows so far are computed from their states, which
    /// [`Options::keep_states`](super::Options::keep_states) keeps.
    ///
    /// # Errors
    /// A mistake in the expression; after a simulation also rows whose states have not been kept, a
    /// model that has been changed since, and expressions with a past.
    pub fn add_column(&mut self, expression: &str) -> Result<(), Error> {
        let is_there = self.run.find(expression).is_some();
        if is_there && !(self.columns.are_by_default() && self.run.rows() == 0) {
            return Ok(());
        }
        match expression_of(&self.model, expression) {
            Some(text) => drop(text.expression()?),
            None => {
                let wrong = check_column(&self.model, expression);
                if !wrong.is_empty() {
                    return Err(wrong.into());
                }
            }
        }
        if self.run.rows() > 0 {
            return self.add_late_column(expression);
        }
        self.options.columns.push(expression.to_string());
        self.choose_columns();
        self.columns_program = None;
        self.starts = Starts::default();
        Ok(())
    }

    /// Goes back to the start, without results: the next simulation begins as the first did, with
    /// the model as it is now.
    ///
    /// With [`Options::keep_start`](super::Options::keep_start) nothing is compiled or assembled
    /// again where the model differs by nothing but VARIABLEs that are numbers and were told by
    /// [`will_change`](Self::will_change).
    ///
    /// ```
    /// use cognate::model::Formula;
    /// use cognate::{Analysis, Model, Options, Session};
    /// let text = "a drop\nPART/1, GROUND\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n\
    ///     VARIABLE/3, FUNCTION=1\nVFORCE/1, I=2, JFLOAT=9, FX=VARVAL(3), FY=0, FZ=0\n\
    ///     MARKER/9, PART=1, FLOATING\nEND\n";
    /// let options = Options { keep_start: true, ..Options::default() };
    /// let mut session = Session::new(Model::from_text(text)?, "drop", options);
    /// session.add_column("DX(2)")?;
    /// session.will_change([3]);
    /// for force in [1.0, 2.0, 4.0] {
    ///     session.reset();
    ///     let number = Formula::text(force.to_string());
    ///     session.model.variables.entry(3).or_default().function = number;
    ///     session.run_to(Analysis::Dynamic, 1.0, 10)?;
    ///     let way = session.run.column("DX(2)").and_then(|x| x.last().copied());
    ///     assert!(way.is_some_and(|x| (x - 0.5 * force).abs() < 1e-6));
    /// }
    /// # Ok::<(), cognate::Error>(())
    /// ```
    pub fn reset(&mut self) {
        let before = &self.run;
        let mut run = Run::new(
            before.name.clone(),
            self.model.title.clone(),
            before.units.clone(),
        );
        run.record.repeats = before.record.repeats;
        run.record.model.clone_from(&before.record.model);
        self.run = run;
        self.choose_columns();
        (self.carried, self.kept, self.companion) = (None, None, None);
        self.columns_program = None;
        (self.linear, self.saved) = (Vec::new(), std::collections::BTreeMap::new());
        (self.gaps, self.states) = (Gaps::default(), Vec::new());
        (self.halted, self.ended_early) = (false, None);
        self.leapt.clear();
        self.weighed = None;
        self.structures.next_generation();
        self.stiffness = MetStiffness::default();
        self.limit = self.options.limit.map(WorkLimit::begin);
    }

    /// Refuses a column that cannot be computed for the rows so far.
    pub(super) fn late(expression: &str, why: &str) -> Error {
        let what = format!("`{expression}` cannot be computed for the rows so far: {why}");
        let said = Diagnostic::error(Cause::LateColumn, what);
        said.help("name it before the first simulation").into()
    }
}
