//! The machine of plain numbers: two engines that go through one list of steps.
//!
//! Straight code is lowered to [`steps`] when a program first runs over plain numbers: sides of
//! selections are jumped over where that pays, functions with constant parameters are prepared.
//! The interpreter goes through the steps in safe Rust. With the feature `native`, on processors
//! that we know, a program that runs often is translated into code of the processor; what is won
//! is the dispatch, and stores of what nobody reads. Both engines do the same operations in the
//! same order: every bit of every result is the same.
//!
//! A program is interpreted until that has taken about as long as its translation, measured: see
//! [`RUNS_PER_TRANSLATION`]. Where somebody knows that many runs follow, it is translated before
//! the first.

mod alike;
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
use crate::clock::Moment;
pub(super) use alike::{Alike, KindOfCode};
pub(super) use lower::written_out;
pub(super) use native::Columns;
use native::Native;
use std::cell::Cell;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Duration;
use steps::{Extra, Steps};

/// Interpreted runs that take as long as the translation of a long program.
const RUNS_PER_TRANSLATION: usize = 30;
/// Interpreted steps that take as long as the part of a translation that does not grow with the
/// program.
const STEPS_PER_TRANSLATION: usize = 5000;

/// Returns how many interpreted runs take as long as the translation of some steps.
fn runs_per_translation(steps: &Steps) -> usize {
    RUNS_PER_TRANSLATION + STEPS_PER_TRANSLATION / steps.steps.len().max(1)
}

thread_local! {
    /// Time that this thread has spent on lowering and translating programs.
    static TRANSLATION: Cell<Duration> = const { Cell::new(Duration::ZERO) };
}

/// Returns the time that this thread has spent so far on lowering and translating programs.
pub fn translation_time() -> Duration {
    TRANSLATION.get()
}

/// Adds the time since `clock` to [`translation_time`].
fn translated_since(clock: Moment) {
    TRANSLATION.set(TRANSLATION.get() + clock.elapsed());
}

/// An engine that runs programs over plain numbers. Both give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    /// goes through the steps of a program in safe Rust
    Interpreter,
    /// code of the processor, with the feature `native` on x86-64 under Linux
    Native,
}

/// Straight code as steps and as code of the processor.
pub(super) struct Machine {
    core: Arc<Core>,
    /// the same without calls, where it has any; made when it is first needed
    without_calls: OnceLock<Option<Core>>,
    made: Arc<Made>,
    /// components that are run one by one in place of the whole
    alike: Option<Arc<Alike>>,
}

/// Steps and code of the processor, each made when it is first needed. They read constants from
/// the frame, so that programs which differ in these alone may share them.
#[derive(Default)]
struct Made {
    n_runs: AtomicU32,
    steps: OnceLock<Steps>,
    native: OnceLock<Native>,
    /// whether there is to be no other attempt at a translation
    is_decided: AtomicBool,
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
            without_calls: OnceLock::new(),
            made: Arc::default(),
            alike: None,
        }
    }

    /// Returns the machine of a core that goes through its components.
    pub(super) fn of_components(core: Arc<Core>, alike: Alike) -> Self {
        Self {
            alike: Some(Arc::new(alike)),
            ..Self::new(core)
        }
    }

    /// Returns the machine of a core with the same shape. What is made of one core is shared where
    /// it is what would be made of the other.
    pub(super) fn with_core(&self, core: Core) -> Self {
        if let Some(alike) = &self.alike {
            let alike = alike.with_core(&core);
            return Self {
                alike: alike.map(Arc::new),
                ..Self::new(Arc::new(core))
            };
        }
        let steps = self.made.steps.get();
        let made = match steps.is_some_and(|steps| lower::are_of(steps, &self.core, &core)) {
            true => Arc::clone(&self.made),
            false => Arc::default(),
        };
        Self {
            made,
            ..Self::new(Arc::new(core))
        }
    }

    pub(super) fn core(&self) -> &Arc<Core> {
        &self.core
    }

    /// Returns the core with calls and their partial derivatives as operations, which `expanded`
    /// makes of one that has any.
    pub(super) fn core_without_calls(&self, expanded: impl FnOnce(&Core) -> Option<Core>) -> &Core {
        let made = self.without_calls.get_or_init(|| expanded(&self.core));
        made.as_ref().unwrap_or(&self.core)
    }

    /// Returns the same machine with one engine from the first run on; `None` where that is not to
    /// be had.
    pub(super) fn with_engine(&self, engine: Engine) -> Option<Self> {
        let machine = Self::new(self.core.clone());
        match engine {
            Engine::Interpreter => machine.made.is_decided.store(true, Ordering::Relaxed),
            Engine::Native => machine.translate(),
        }
        (machine.engine() == engine).then_some(machine)
    }

    /// Returns the engine that runs at present.
    pub(super) fn engine(&self) -> Engine {
        if let Some(alike) = &self.alike {
            return alike.engine();
        }
        match self.made.native.get() {
            Some(_) => Engine::Native,
            None => Engine::Interpreter,
        }
    }

    pub(super) fn n_steps(&self) -> usize {
        match &self.alike {
            Some(alike) => alike.n_steps(),
            None => self.steps().steps.len(),
        }
    }

    pub(super) fn n_steps_of_code(&self) -> usize {
        match &self.alike {
            Some(alike) => alike.n_steps_of_code(),
            None => self.n_steps(),
        }
    }

    /// Lays out a frame: constants, registers, numbers of the steps, and room for the outputs at
    /// the end.
    pub(super) fn lay_out(&self, frame: &mut Vec<f64>) {
        if let Some(alike) = &self.alike {
            alike.lay_out(&self.core, frame);
            return;
        }
        let first = frame.len();
        frame.extend(&self.core.constants);
        frame.resize(first + self.core.size as usize, f64::NAN);
        frame.extend(self.extras());
    }

    /// Returns the numbers that stand in a frame behind the registers of the straight code: those
    /// of the steps, and room for the outputs.
    fn extras(&self) -> impl Iterator<Item = f64> {
        let extras = self.steps().extras.iter().map(|extra| match *extra {
            Extra::Constant(c) => c,
            Extra::Between | Extra::Ahead => f64::NAN,
        });
        extras.chain(self.core.outputs.iter().map(|_| f64::NAN))
    }

    fn steps(&self) -> &Steps {
        self.made.steps.get_or_init(|| {
            let clock = Moment::now();
            let steps = lower::lower(&self.core);
            translated_since(clock);
            debug_assert!(steps.are_sound(&self.core), "{steps:?}");
            steps
        })
    }

    /// Translates the steps, once.
    fn translate(&self) {
        if self.made.is_decided.swap(true, Ordering::Relaxed) {
            return;
        }
        let (steps, clock) = (self.steps(), Moment::now());
        if let Some(native) = Native::of(steps, &self.core) {
            // nobody else gets so far
            let _ = self.made.native.set(native);
        }
        translated_since(clock);
    }

    /// Runs as code of the processor, over a frame whose constants are in place; returns the first
    /// output, or `None` where there is no such code, frame or inputs are too short, or there are
    /// not as many places as outputs.
    #[inline(always)]
    pub(super) fn run_native(
        &self,
        frame: &mut [f64],
        inputs: &[f64],
        out: &mut [f64],
    ) -> Option<f64> {
        self.made.native.get()?.run(frame, inputs, out)
    }

    /// Does as [`Machine::run_native`], the outputs at the end of the frame.
    #[inline(always)]
    pub(super) fn run_native_inside(&self, frame: &mut [f64], inputs: &[f64]) -> Option<f64> {
        self.made.native.get()?.run_inside(frame, inputs)
    }

    /// Goes through the steps, and copies the outputs to the end of the frame; translates the steps
    /// for the next run when that pays.
    pub(super) fn interpret(&self, frame: &mut [f64], inputs: &[f64]) {
        if let Some(alike) = &self.alike {
            alike.run(frame, inputs);
            return;
        }
        let steps = self.steps();
        steps.run(&self.core, frame, inputs);
        let (slots, outputs) = frame.split_at_mut(steps.n_slots());
        for (out, &slot) in outputs.iter_mut().zip(&self.core.outputs) {
            *out = slots[slot as usize];
        }
        if !self.made.is_decided.load(Ordering::Relaxed) {
            let n_runs = self.made.n_runs.fetch_add(1, Ordering::Relaxed) as usize;
            if n_runs >= runs_per_translation(steps) {
                self.translate();
            }
        }
    }

    /// Translates the steps at once where so many further runs take longer than that.
    #[cfg(feature = "solver")]
    pub(super) fn expect_runs(&self, n_runs: usize) {
        if let Some(alike) = &self.alike {
            alike.expect_runs(n_runs);
            return;
        }
        let is_decided = self.made.is_decided.load(Ordering::Relaxed);
        if !is_decided && n_runs > runs_per_translation(self.steps()) * 3 / 2 {
            self.translate();
        }
    }
}
