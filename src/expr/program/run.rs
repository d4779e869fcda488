//! Programs, and the work arrays that they run over.

use super::code::Core;
use super::input::Input;
use super::machine::{Alike, Engine, Machine};
use crate::diagnostic::{Cause, Diagnostic, Error, counted};
use crate::scalar::Table;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Straight-line code with several outputs. Made by [`Builder::finish`](super::Builder::finish);
/// never changes.
///
/// Copies share the code.
#[derive(Clone, Debug)]
pub struct Program {
    /// tells whose registers a [`Work`] holds
    pub(super) id: u64,
    /// what the host supplies, in this order
    pub(super) inputs: Arc<[Input]>,
    pub(super) machine: Arc<Machine>,
}

/// The registers of a program while it runs. Any program may use any work; changing between them
/// costs a preparation.
#[derive(Clone, Debug)]
pub struct Work<S = f64> {
    pub(super) owner: u64,
    pub(super) registers: Vec<S>,
}

/// Added to the owner of registers that are laid out for the machine, which needs more of them.
const FOR_THE_MACHINE: u64 = 1;

impl<S> Default for Work<S> {
    fn default() -> Self {
        Self {
            owner: 0,
            registers: Vec::new(),
        }
    }
}

impl Program {
    pub(super) fn new(inputs: Vec<Input>, core: Core) -> Self {
        Self::of(inputs.into(), Machine::new(Arc::new(core)))
    }

    /// Returns a program whose components are run one by one.
    pub(super) fn of_components(inputs: Vec<Input>, core: Core, alike: Alike) -> Self {
        Self::of(inputs.into(), Machine::of_components(Arc::new(core), alike))
    }

    fn of(inputs: Arc<[Input]>, machine: Machine) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(2);
        Self {
            id: NEXT.fetch_add(2, Ordering::Relaxed),
            inputs,
            machine: Arc::new(machine),
        }
    }

    /// Returns the program that does the same with other constants and tables.
    pub(super) fn with_constants(&self, constants: Vec<f64>, tables: &[Arc<dyn Table>]) -> Self {
        let core = Core {
            constants,
            tables: tables.to_vec(),
            shape: Arc::clone(&self.core().shape),
        };
        Self::of(Arc::clone(&self.inputs), self.machine.with_core(core))
    }

    /// Returns the same program for other inputs, as many as before.
    pub(super) fn with_inputs(self, inputs: Vec<Input>) -> Self {
        debug_assert_eq!(inputs.len(), self.inputs.len(), "an input for each");
        Self {
            inputs: inputs.into(),
            ..self
        }
    }

    pub(super) fn core(&self) -> &Core {
        self.machine.core()
    }

    /// Returns the code, to be kept.
    pub(super) fn shared_core(&self) -> Arc<Core> {
        Arc::clone(self.machine.core())
    }

    /// Returns the same program, run over plain numbers by one engine from the first run on;
    /// `None` where that engine is not to be had. For comparing the two: by itself a program
    /// changes to the faster when that pays.
    pub fn with_engine(&self, engine: Engine) -> Option<Self> {
        Some(Self {
            machine: Arc::new(self.machine.with_engine(engine)?),
            ..self.clone()
        })
    }

    /// Returns the engine that runs it over plain numbers at present.
    pub fn engine(&self) -> Engine {
        self.machine.engine()
    }

    /// Tells that so many runs over plain numbers follow: the program is translated before the
    /// first where that pays.
    #[cfg(feature = "solver")]
    pub(crate) fn expect_runs(&self, n: usize) {
        self.machine.expect_runs(n);
    }

    /// Returns whether both are copies of one program.
    #[cfg(feature = "solver")]
    pub(crate) fn is_copy_of(&self, other: &Self) -> bool {
        self.id == other.id
    }

    /// Returns what the host supplies, in this order.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }
    /// Returns whether the input at a position among them is read at all.
    pub fn reads(&self, position: usize) -> bool {
        self.core().used.iter().any(|&k| k as usize == position)
    }
    /// Returns how many numbers come out.
    pub fn n_outputs(&self) -> usize {
        self.core().outputs.len()
    }
    /// Returns how many operations it takes.
    pub fn n_operations(&self) -> usize {
        self.core().code.len()
    }
    /// Returns how many steps it takes over plain numbers, at most.
    pub fn n_steps(&self) -> usize {
        self.machine.n_steps()
    }
    /// Returns how many steps its code has over plain numbers: components that are alike share
    /// theirs.
    pub fn n_steps_of_code(&self) -> usize {
        self.machine.n_steps_of_code()
    }
    /// Returns how many registers it takes.
    pub fn work_size(&self) -> usize {
        self.core().size as usize
    }
    /// Returns the numbers that come out, if they depend on no input.
    pub fn constant_outputs(&self) -> Option<Vec<f64>> {
        let core = self.core();
        core.outputs
            .iter()
            .map(|&r| core.constants.get(r as usize).copied())
            .collect()
    }

    /// Runs over plain numbers, unchecked: an input that is missing counts as NaN, and a place for
    /// an output that the program does not have becomes NaN. [`Program::run_checked`] refuses both.
    ///
    /// Once `work` has been used with this program it allocates nothing, but for the one run in
    /// which the program is translated.
    #[inline]
    pub fn run(&self, inputs: &[f64], work: &mut Work, out: &mut [f64]) {
        let done = match work.owner == self.id + FOR_THE_MACHINE {
            true => self.machine.run_native(&mut work.registers, inputs, out),
            false => None,
        };
        if done.is_none() {
            self.enter_and_run(inputs, work, out);
        }
    }

    /// Runs over plain numbers as [`Program::run`] does, with at least one output more than places;
    /// returns the first output behind them, and whether all that came out before it are finite.
    #[cfg(feature = "solver")]
    #[inline]
    pub(crate) fn run_finite(
        &self,
        inputs: &[f64],
        work: &mut Work,
        out: &mut [f64],
    ) -> (f64, bool) {
        if self.run_at_once(inputs, work).is_none() {
            self.enter(inputs, work);
        }
        let results = self.results(work);
        // number by number: what was just written is not read as a whole. A sum is finite only if
        // all its terms are
        let mut sum = 0.0;
        for (out, &x) in out.iter_mut().zip(results) {
            *out = x;
            sum += x * 0.0;
        }
        let behind = results.get(out.len()).copied().unwrap_or(f64::NAN);
        (behind, sum == 0.0)
    }

    /// Runs over plain numbers as [`Program::run`] does, for inputs that nobody has counted.
    ///
    /// # Errors
    /// Fewer inputs or more places for outputs than the program has, and outputs that are not
    /// finite numbers.
    ///
    /// ```
    /// use cognate::expr::{Expr, interpolation::Bindings, program::Work};
    /// let program = Expr::parse("TIME*DX(1, 2)")?.compile(&Bindings::default())?;
    /// let (mut work, mut out) = (Work::default(), [0.0]);
    /// program.run_checked(&[2.0, 3.0], &mut work, &mut out)?;
    /// assert_eq!(out, [6.0]);
    /// let error = program.run_checked(&[2.0], &mut work, &mut out).unwrap_err();
    /// assert_eq!(error.first().message, "1 value was given for 2 inputs: TIME, DX(1, 2)");
    /// # Ok::<(), cognate::Error>(())
    /// ```
    pub fn run_checked(
        &self,
        inputs: &[f64],
        work: &mut Work,
        out: &mut [f64],
    ) -> Result<(), Error> {
        self.check_counts(inputs.len(), out.len())?;
        self.run(inputs, work, out);
        match out.iter().position(|y| !y.is_finite()) {
            None => Ok(()),
            Some(k) => {
                let what = format!("output {} has no finite value: {}", k + 1, out[k]);
                Err(Diagnostic::error(Cause::Domain, what).into())
            }
        }
    }

    /// Returns the first output, over plain numbers: as [`Program::run`], a little faster for a
    /// single number. NaN where there is no output.
    #[inline]
    pub fn value(&self, inputs: &[f64], work: &mut Work) -> f64 {
        match self.run_at_once(inputs, work) {
            Some(value) => value,
            None => self.enter_and_value(inputs, work),
        }
    }

    /// Runs as code of the processor, and returns the first output; `None` where anything has to
    /// be done or said before that. All outputs are [`Program::results`].
    #[inline(always)]
    fn run_at_once(&self, inputs: &[f64], work: &mut Work) -> Option<f64> {
        if work.owner != self.id + FOR_THE_MACHINE {
            return None;
        }
        self.machine.run_native_inside(&mut work.registers, inputs)
    }

    /// Returns the outputs, after a run that left them at the end of the frame.
    #[inline(always)]
    fn results<'w>(&self, work: &'w Work) -> &'w [f64] {
        let behind = work.registers.len().saturating_sub(self.n_outputs());
        &work.registers[behind..]
    }

    /// Checks the inputs, lays out the frame of the machine unless it is that of this program, and
    /// runs.
    #[inline(never)]
    fn enter(&self, inputs: &[f64], work: &mut Work) {
        let padded;
        let inputs = if inputs.len() < self.inputs.len() {
            padded = self.padded(inputs, f64::NAN);
            &padded
        } else {
            inputs
        };
        if work.owner != self.id + FOR_THE_MACHINE {
            self.prepare_machine(work);
        }
        if self.run_at_once(inputs, work).is_none() {
            self.machine.interpret(&mut work.registers, inputs);
        }
    }

    #[inline(never)]
    fn enter_and_run(&self, inputs: &[f64], work: &mut Work, out: &mut [f64]) {
        self.enter(inputs, work);
        let results = self.results(work);
        let n = out.len().min(results.len());
        out[..n].copy_from_slice(&results[..n]);
        out[n..].fill(f64::NAN);
    }

    #[inline(never)]
    fn enter_and_value(&self, inputs: &[f64], work: &mut Work) -> f64 {
        self.enter(inputs, work);
        self.results(work).first().copied().unwrap_or(f64::NAN)
    }

    /// Checks how many values and places for outputs a caller gave.
    ///
    /// # Errors
    /// Fewer values than inputs, or more places than outputs.
    pub(in crate::expr) fn check_counts(&self, values: usize, places: usize) -> Result<(), Error> {
        let outputs = self.n_outputs();
        let mut wrong = Vec::new();
        if values < self.inputs.len() {
            let names: Vec<String> = self.inputs.iter().map(ToString::to_string).collect();
            wrong.push(too_few(values, &names));
        }
        if places > outputs {
            let what = format!(
                "{} asked for, the program has {}",
                counted(places, "output"),
                counted(outputs, "output")
            );
            wrong.push(Diagnostic::error("unfit_value", what));
        }
        match wrong.is_empty() {
            true => Ok(()),
            false => Err(wrong.into()),
        }
    }

    /// Returns the inputs with as many as are missing added.
    #[cold]
    pub(super) fn padded<S: Copy>(&self, inputs: &[S], missing: S) -> Vec<S> {
        let mut padded = inputs.to_vec();
        padded.resize(self.inputs.len(), missing);
        padded
    }

    /// Lays out the frame of the machine.
    #[cold]
    fn prepare_machine(&self, work: &mut Work) {
        work.owner = 0;
        work.registers.clear();
        self.machine.lay_out(&mut work.registers);
        work.owner = self.id + FOR_THE_MACHINE;
    }
}
/// Returns the mistake of fewer values than inputs of these names.
pub(in crate::expr) fn too_few(values: usize, names: &[String]) -> Diagnostic {
    let was = if values == 1 { "was" } else { "were" };
    let what = format!(
        "{} {was} given for {}: {}",
        counted(values, "value"),
        counted(names.len(), "input"),
        names.join(", ")
    );
    Diagnostic::error(Cause::MissingValue, what)
}
