//! Steps translated into code of the processor (x86-64 under Linux).
//!
//! The code does the operations of the steps in their order, with the same roundings: the results
//! are the same bits. What the processor has no instruction for is called; what reaches into
//! tables or has many arguments is given to the interpreter step by step.
//!
//! # Safety
//!
//! The code reads and writes slots and inputs that the steps name, and as many outputs as the
//! program has. [`Steps::are_sound`] has seen that all of them are inside the frame and inside the
//! inputs, and that jumps lead forward; steps that are not sound are not translated. That frame,
//! inputs and outputs are as long as they must be is checked before each run.

mod assembler;
mod calls;
mod columns;
mod held;
mod joins;
mod needs;
mod translate;

use super::super::code::Core;
use super::steps::Steps;
use crate::expr::program::hashing::HashMap;
use calls::CalledStep;
pub(in crate::expr::program) use columns::Columns;
use memmap2::{Mmap, MmapMut};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use translate::Call;

/// Most pieces of code at a time: a system allows some ten thousand mappings for a process; most
/// are left to others.
const MOST_MAPPINGS: usize = 20_000;
static N_MAPPINGS: AtomicUsize = AtomicUsize::new(0);

/// Most slots and inputs, whose distances in bytes are numbers of 31 bits.
const MOST_NUMBERS: usize = 1 << 28;

/// A function that works on a frame, reads inputs and writes outputs; returns the first of these.
type Entry =
    unsafe extern "sysv64" fn(frame: *mut f64, inputs: *const f64, outputs: *mut f64) -> f64;

/// Code that can run.
pub(super) struct Native {
    entry: Entry,
    n_slots: usize,
    n_inputs: usize,
    n_outputs: usize,
    /// slots, and behind them outputs
    frame_length: usize,
    /// where the code stands
    _code: Mapping,
    /// the steps that it calls, by address
    _called: Box<[CalledStep]>,
}

/// Memory that holds code, counted.
struct Mapping(Mmap);

impl Native {
    /// Translates steps; `None` where the system gives no memory that can be executed.
    pub(super) fn of(steps: &Steps, core: &Arc<Core>) -> Option<Self> {
        Self::with(steps, core, is_x86_feature_detected!("avx"))
    }

    #[allow(unsafe_code)]
    fn with(steps: &Steps, core: &Arc<Core>, has_avx: bool) -> Option<Self> {
        if core.outputs.is_empty()
            || steps.n_slots().max(core.n_inputs) >= MOST_NUMBERS
            || !steps.are_sound(core)
        {
            return None;
        }
        let called = (0u32..)
            .zip(&steps.steps)
            .filter_map(|(k, step)| Some((k, CalledStep::of(step, steps, core)?)));
        let (numbers, called): (Vec<u32>, Vec<CalledStep>) = called.unzip();
        let called = called.into_boxed_slice();
        let addresses = called.iter().map(|step| Call {
            function: step.function(),
            argument: std::ptr::from_ref(step).expose_provenance(),
        });
        let calls: HashMap<u32, Call> = numbers.into_iter().zip(addresses).collect();
        let code = Mapping::of(&translate::translate(steps, core, &calls, has_avx))?;
        // SAFETY: the translation is a function of this kind, and `code` keeps it where it is
        let entry = unsafe { std::mem::transmute::<*const u8, Entry>(code.0.as_ptr()) };
        Some(Self {
            entry,
            n_slots: steps.n_slots(),
            n_inputs: core.n_inputs,
            n_outputs: core.outputs.len(),
            frame_length: steps.n_slots() + core.outputs.len(),
            _code: code,
            _called: called,
        })
    }

    /// Runs over a frame whose constants are in place, and returns the first output; `None` where
    /// frame or inputs are too short, or there are not as many places as outputs.
    #[inline(always)]
    #[allow(unsafe_code)]
    pub(super) fn run(&self, frame: &mut [f64], inputs: &[f64], out: &mut [f64]) -> Option<f64> {
        if frame.len() < self.n_slots || inputs.len() < self.n_inputs || out.len() != self.n_outputs
        {
            return None;
        }
        // SAFETY: the code stays inside frame, inputs and outputs; see the head of this file
        Some(unsafe { (self.entry)(frame.as_mut_ptr(), inputs.as_ptr(), out.as_mut_ptr()) })
    }

    /// Does as [`Native::run`], the outputs behind the slots in the frame.
    #[inline(always)]
    #[allow(unsafe_code)]
    pub(super) fn run_inside(&self, frame: &mut [f64], inputs: &[f64]) -> Option<f64> {
        if frame.len() < self.frame_length || inputs.len() < self.n_inputs {
            return None;
        }
        let frame = frame.as_mut_ptr();
        // SAFETY: as above; the outputs are behind the slots, and both inside the frame
        Some(unsafe { (self.entry)(frame, inputs.as_ptr(), frame.add(self.n_slots)) })
    }
}

impl Mapping {
    /// Returns memory that holds this code, which can be executed and no longer be written.
    fn of(code: &[u8]) -> Option<Self> {
        if N_MAPPINGS.fetch_add(1, Ordering::Relaxed) >= MOST_MAPPINGS {
            N_MAPPINGS.fetch_sub(1, Ordering::Relaxed);
            return None;
        }
        let written = MmapMut::map_anon(code.len()).and_then(|mut memory| {
            memory.copy_from_slice(code);
            memory.make_exec()
        });
        match written {
            Ok(memory) => Some(Self(memory)),
            Err(_) => {
                N_MAPPINGS.fetch_sub(1, Ordering::Relaxed);
                None
            }
        }
    }
}

impl Drop for Mapping {
    fn drop(&mut self) {
        N_MAPPINGS.fetch_sub(1, Ordering::Relaxed);
    }
}
