//! Several programs of one instant, recorded together: what they have in common is evaluated and
//! recorded once.
//!
//! Most of the time of setting up a model is recording, and most of that are the rows that close
//! loops, which the rates, the projection and what watches the rows all read.

use super::configuration::{Configuration, Configured};
use super::equations::{Equations, Unsupported};
use super::loops;
use super::programs::sources;
use crate::expr::program::{Builder, Folding, Program, Sym, Value};
use std::cell::{OnceCell, RefCell};

/// Returns the builder of a recording of equations.
pub fn builder() -> RefCell<Builder> {
    RefCell::new(Builder::again_or_new(Folding::Structural))
}

/// One instant of a scene whose values become programs, one after the other.
pub struct Recorder<'s, 'b> {
    scene: Configured<'s>,
    builder: &'b RefCell<Builder>,
    at: Equations<'s, Sym<'b>>,
    /// where functions may change branch
    sources: OnceCell<Vec<Sym<'b>>>,
}

impl<'s, 'b> Recorder<'s, 'b> {
    /// Begins recording a scene into a builder; programs read the row of numbers that
    /// [`Layout`](super::layout::Layout) describes. The unknowns of linear loops are eliminated.
    pub fn new(scene: Configured<'s>, builder: &'b RefCell<Builder>) -> Self {
        (builder.borrow_mut()).expect_components(scene.n_mechanisms());
        let numbers = loops::inputs(&scene, builder);
        let unknowns = match scene.layout.n_loops {
            0 if !scene.loops.is_empty() => loops::eliminated(scene, &numbers, builder),
            _ => numbers[scene.layout.loops()].to_vec(),
        };
        Self {
            scene,
            builder,
            at: Equations::with_unknowns(scene, &numbers, unknowns, false),
            sources: OnceCell::new(),
        }
    }

    /// Begins recording the same scene in a configuration that differs in the order of elimination
    /// only. The scene has no algebraic loops, whose unknowns may be accelerations.
    pub fn eliminating(&self, configuration: &'s Configuration) -> Self {
        debug_assert!(self.scene.loops.is_empty(), "unknowns of loops are known");
        Self {
            scene: self.scene.scene.within(configuration),
            builder: self.builder,
            at: self.at.eliminating(configuration),
            sources: OnceCell::new(),
        }
    }

    /// Returns the scene that is recorded.
    pub fn scene(&self) -> Configured<'s> {
        self.scene
    }

    /// Returns the instant.
    pub fn at(&self) -> &Equations<'s, Sym<'b>> {
        &self.at
    }

    /// Returns the program of some values of the instant.
    ///
    /// # Errors
    /// Functions have asked for what the equations cannot supply, for these values or for earlier
    /// ones.
    pub fn program(&self, values: &[Sym<'b>]) -> Result<Program, Vec<Unsupported>> {
        self.end(values, |builder, values| {
            builder.finish_with_inputs(&values, &self.scene.layout.inputs())
        })
    }

    /// As [`Recorder::program`]; what could not be computed is NaN in the program, and told.
    pub(crate) fn program_with_complaints(
        &self,
        values: &[Sym<'b>],
    ) -> (Program, Vec<Unsupported>) {
        let builder = &mut *self.builder.borrow_mut();
        let values: Vec<Value> = values.iter().map(|s| s.value(builder)).collect();
        let program = builder.finish_with_inputs(&values, &self.scene.layout.inputs());
        (program, self.at.complaints())
    }

    /// Returns how many operations the program of some values takes, without making it.
    ///
    /// # Errors
    /// As [`Recorder::program`].
    pub fn count_operations(&self, values: &[Sym<'b>]) -> Result<usize, Vec<Unsupported>> {
        self.end(values, |builder, values| builder.count_operations(&values))
    }

    /// Returns what `end` makes of some values of the instant.
    ///
    /// # Errors
    /// As [`Recorder::program`].
    pub(super) fn end<T>(
        &self,
        values: &[Sym<'b>],
        end: impl FnOnce(&mut Builder, Vec<Value>) -> T,
    ) -> Result<T, Vec<Unsupported>> {
        let complaints = self.at.complaints();
        if !complaints.is_empty() {
            return Err(complaints);
        }
        let builder = &mut *self.builder.borrow_mut();
        let values = values.iter().map(|s| s.value(builder)).collect();
        Ok(end(builder, values))
    }

    /// Returns the numbers that loads and differential equations are made of.
    pub(super) fn sources(&self) -> &[Sym<'b>] {
        self.sources.get_or_init(|| sources(&self.at, &self.scene))
    }
}
