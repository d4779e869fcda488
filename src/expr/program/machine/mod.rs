//! The machine of plain numbers: two engines that go through one list of steps.
//!
//! Straight code is lowered to [`steps`] when a program first runs over plain numbers: sides of
//! selections are jumped over where that pays, functions with constant parameters are prepared. The
//! interpreter goes through the steps in safe Rust. With the feature `native`, on processors that
//! we know, a program that runs often is translated into code of the processor; what is won is the
//! dispatch, and stores of what nobody reads. Both engines do the same operations in the same
//! order: every bit of every result is the same.
//!
//! A program is interpreted until that has taken about as long as its translation, measured: see
//! [`RUNS_PER_TRANSLATION`].

mod interpreter;
mod lower;
#[cfg(all(
    feature = "native",
    target_arch = "x86_64",
    target_os = "linux",
    not(miri)
))]
mod native;
#[cfg(not(all(
    feature = "native",
    target_arch = "x86_64",
    target_os = "linux",
    not(miri)
)))]
#[path = "absent.rs"]
mod native;
mod prepared;
mod steps;

use super::code::Core;
use native::Native;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, OnceLock};
use steps::{Extra, Steps};

/// Interpreted runs that take as long as the translation of a long program.
const RUNS_PER_TRANSLATION: usize = 30;
/// Interpreted steps that take as long as the part of a translation that does not grow with the
/// program.
const STEPS_PER_TRANSLATION: usize = 5000;

/// An engine that runs programs over plain numbers. Both give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    /// goes through the steps of a program in safe Rust
    Interpreter,
    /// code of the processor, with the feature `native` on x86-64 under Linux
    Native,
}

/// Straight code as steps and as code of the processor, each made when it is first needed.
pub(super) struct Machine {
    core: Arc<Core>,
    /// the engine that runs from the first run on; by the number of runs if `None`
    chosen: Option<Engine>,
    n_runs: AtomicU32,
    steps: OnceLock<Arc<Steps>>,
    native: OnceLock<Option<Native>>,
}

impl std::fmt::Debug for Machine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Machine")
            .field("core", &self.core)
            .field("engine", &self.engine())
            .finish()
    }
}

impl Machine {
    pub(super) fn new(core: Arc<Core>) -> Self {
        Self {
            core,
            chosen: None,
            n_runs: AtomicU32::new(0),
            steps: OnceLock::new(),
            native: OnceLock::new(),
        }
    }

    pub(super) fn core(&self) -> &Core {
        &self.core
    }

    /// Returns the same machine with one engine from the first run on; `None` where that is not to
    /// be had.
    pub(super) fn with_engine(&self, engine: Engine) -> Option<Self> {
        let machine = Self {
            chosen: Some(engine),
            steps: self.steps.clone(),
            ..Self::new(self.core.clone())
        };
        match engine {
            Engine::Interpreter => Some(machine),
            Engine::Native => machine.translated().is_some().then_some(machine),
        }
    }

    /// Returns the engine that runs at present.
    pub(super) fn engine(&self) -> Engine {
        match self.native.get() {
            Some(Some(_)) => Engine::Native,
            _ => Engine::Interpreter,
        }
    }

    pub(super) fn n_steps(&self) -> usize {
        self.steps().steps.len()
    }

    /// Returns the numbers that stand in a frame behind the registers of the straight code.
    pub(super) fn extras(&self) -> impl Iterator<Item = f64> {
        self.steps().extras.iter().map(|extra| match *extra {
            Extra::Constant(c) => c,
            Extra::Between => f64::NAN,
        })
    }

    fn steps(&self) -> &Arc<Steps> {
        self.steps.get_or_init(|| {
            let steps = lower::lower(&self.core);
            debug_assert!(steps.are_sound(&self.core), "{steps:?}");
            Arc::new(steps)
        })
    }

    fn translated(&self) -> Option<&Native> {
        self.native
            .get_or_init(|| Native::of(self.steps(), &self.core))
            .as_ref()
    }

    /// Runs over a frame whose constants are in place; returns the first output, NaN if there is
    /// none.
    #[inline(always)]
    pub(super) fn run(&self, frame: &mut [f64], inputs: &[f64]) -> f64 {
        match self.native.get() {
            Some(Some(native)) => native.run(frame, inputs),
            _ => self.interpret(frame, inputs),
        }
    }

    #[inline(never)]
    fn interpret(&self, frame: &mut [f64], inputs: &[f64]) -> f64 {
        if self.is_worth_a_translation()
            && let Some(native) = self.translated()
        {
            return native.run(frame, inputs);
        }
        self.steps().run(&self.core, frame, inputs);
        self.core
            .outputs
            .first()
            .map_or(f64::NAN, |&output| frame[output as usize])
    }

    /// Counts a run; returns whether the program has been interpreted for as long as a translation
    /// takes.
    fn is_worth_a_translation(&self) -> bool {
        if self.chosen.is_some() || self.native.get().is_some() {
            return false;
        }
        let n_runs = self.n_runs.fetch_add(1, Ordering::Relaxed) as usize;
        n_runs >= RUNS_PER_TRANSLATION + STEPS_PER_TRANSLATION / self.n_steps().max(1)
    }
}
