//! States of rows that are kept, so that columns can be named after a simulation.

use super::kept::Starts;
use super::{Accuracy, Session, columns};
use crate::analysis::system::System;
use crate::diagnostic::Error;
use crate::model::Model;
use crate::results::Run;
use crate::scene::Scene;
use crate::scene::configuration::Configuration;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Rows of one configuration of one scene, one after the other.
pub(super) struct Stretch {
    scene: Arc<Scene>,
    configuration: Configuration,
    /// all numbers of each row
    rows: Vec<Vec<f64>>,
    /// the numbers on the branches between which the motion stays at a row, with their parts
    means: BTreeMap<usize, Vec<(f64, Vec<f64>)>>,
    /// the model that was simulated
    model: Arc<Model>,
}

impl Session {
    /// Keeps the states of rows, where that is asked for.
    pub(super) fn remember<'a>(
        &mut self,
        (system, active): (&System, &[bool]),
        rows: &[Vec<f64>],
        means: impl Fn(usize) -> Option<&'a Vec<(f64, Vec<f64>)>>,
    ) {
        if !self.options.keep_states || self.receiver.is_some() || self.pace.columns_alone {
            return;
        }
        let is_same = |s: &Stretch| {
            Arc::ptr_eq(&s.scene, &system.scene)
                && s.configuration.active == active
                && *s.model == self.model
        };
        if !self.states.last().is_some_and(is_same) {
            let mut configuration = system.configuration.clone();
            configuration.active = active.to_vec();
            let last = self.states.last();
            let model = match last.filter(|s| *s.model == self.model) {
                Some(last) => Arc::clone(&last.model),
                None => Arc::new(self.model.clone()),
            };
            self.states.push(Stretch {
                scene: Arc::clone(&system.scene),
                configuration,
                rows: Vec::new(),
                means: BTreeMap::new(),
                model,
            });
        }
        let Some(stretch) = self.states.last_mut() else {
            return;
        };
        let first = stretch.rows.len();
        stretch.rows.extend_from_slice(rows);
        let known = (0..rows.len()).filter_map(|k| Some((first + k, means(k)?.clone())));
        stretch.means.extend(known);
    }

    /// Adds a column whose values in the rows so far follow from their states.
    ///
    /// # Errors
    /// States that were not kept, another model, and expressions with a past.
    pub(super) fn add_late_column(&mut self, expression: &str) -> Result<(), Error> {
        let late = |why: &str| Err(Self::late(expression, why));
        let kept: usize = self.states.iter().map(|s| s.rows.len()).sum();
        if kept != self.run.rows() || self.run.released > 0 {
            return late("their states have not been kept; Options::keep_states keeps them");
        }
        if self.options.accuracy == Accuracy::Bars {
            return late("their bars of error would be missing");
        }
        if self.states.iter().any(|s| *s.model != self.model) {
            return late("the model has been changed since");
        }
        let before = self.run.columns.len();
        self.columns.add(&self.model, &mut self.run, expression);
        match self.late_values() {
            Ok(values) => {
                self.run.columns[before].values = values;
                self.options.columns.push(expression.to_string());
                (self.columns_program, self.kept) = (None, None);
                self.starts = Starts::default();
                Ok(())
            }
            Err(said) => {
                self.columns.take_back(&mut self.run);
                Err(said)
            }
        }
    }

    /// Returns the values of the last column in all rows.
    fn late_values(&mut self) -> Result<Vec<f64>, Error> {
        let states = std::mem::take(&mut self.states);
        let all: Result<Vec<_>, Error> = states.iter().map(|s| self.values_in(s)).collect();
        self.states = states;
        Ok(all?.concat())
    }

    /// Returns the values of the last column in the rows of a stretch.
    fn values_in(&mut self, stretch: &Stretch) -> Result<Vec<f64>, Error> {
        let scene = self.compile_again(stretch.scene.mode as u32)?;
        let same = scene.layout == stretch.scene.layout && scene.unknowns == stretch.scene.unknowns;
        let name = self
            .run
            .columns
            .last()
            .map(|c| c.name.clone())
            .unwrap_or_default();
        if !same {
            return Err(Self::late(&name, "it has a past, which nobody has kept"));
        }
        let here = scene.within(&stretch.configuration);
        let (program, complaints) = self.columns.last_alone().program(here);
        if let Some(complaint) = complaints.first() {
            return Err(complaint.error().into());
        }
        let mut run = Run::new("late", "", self.run.units.clone());
        run.add_column(name, "");
        let columns = (&program, &mut self.scratch);
        columns::append_with(&mut run, columns, (&stretch.rows, 0), |k| {
            stretch.means.get(&k)
        });
        Ok(run
            .columns
            .pop()
            .map(|column| column.values)
            .unwrap_or_default())
    }
}
