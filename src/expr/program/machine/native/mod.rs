//! The threaded code translated into code of the processor (x86-64 under Linux).
//!
//! The translation is one operation like any other: it is given the frame and the inputs, and does what all operations of
//! the threaded code do, in the same order, with the same roundings: the results are the same bits. What has a handler of
//! its own (functions, tables) is called. It is made when the program
//! first runs. Where the system refuses that, the threaded code runs.
//!
//! # Safety
//!
//! The code reads and writes what the threaded code does, which [`super::Machine::check`] has seen to be inside the frame;
//! slots of the translation's own stand behind them ([`Native::n_spare`]).

mod assembler;
mod inline;
mod pages;
mod steps;
mod translate;

use super::{Handler, Op, Threaded, handlers};
use pages::Pages;
use std::collections::HashMap;
use std::ffi::c_void;
use std::sync::{Arc, OnceLock};
use steps::{Step, Steps};

/// A program that is translated when it first runs.
pub(super) struct Native {
    threaded: Threaded,
    loaded: OnceLock<Option<Loaded>>,
}

/// Code that can run.
struct Loaded {
    /// the operation that is the whole program
    op: Op,
    n_spare: usize,
    /// where the code stands
    _pages: Pages,
    /// operations that it calls, each followed by the end
    _called: Box<[[Op; 2]]>,
}

impl Threaded {
    /// The parameters at a place in the frame.
    fn parameters(&self, place: u32, length: u32) -> &[f64] {
        let first = place as usize + self.parameters.len() - self.n_registers;
        &self.parameters[first..first + length as usize]
    }
}

impl Native {
    pub(super) fn of(threaded: Threaded) -> Option<Arc<Self>> {
        // places in the frame are distances of 32 bits
        (threaded.n_registers < 1 << 26).then(|| {
            Arc::new(Self {
                threaded,
                loaded: OnceLock::new(),
            })
        })
    }

    fn loaded(&self) -> Option<&Loaded> {
        self.loaded
            .get_or_init(|| Loaded::new(&self.threaded))
            .as_ref()
    }

    /// The operation that is the whole program; `None` where there can be none.
    pub(super) fn start(&self) -> Option<*const Op> {
        self.loaded().map(|loaded| std::ptr::from_ref(&loaded.op))
    }

    /// How many registers it needs behind those of the threaded code.
    pub(super) fn n_spare(&self) -> usize {
        self.loaded().map_or(0, |loaded| loaded.n_spare)
    }
}

impl Loaded {
    fn new(threaded: &Threaded) -> Option<Self> {
        let steps = Steps::of(threaded);
        let end = Op {
            run: handlers::halt,
            operands: [0; 6],
        };
        let numbers: Vec<u32> = steps
            .steps
            .iter()
            .filter_map(|step| match step {
                Step::Call { op, .. } => Some(*op),
                _ => None,
            })
            .collect();
        let called: Box<[[Op; 2]]> = numbers
            .iter()
            .map(|&k| [threaded.ops[k as usize], end])
            .collect();
        let places: HashMap<u32, *const Op> = numbers
            .into_iter()
            .zip(called.iter().map(|pair| pair.as_ptr()))
            .collect();
        let pages = Pages::new(&translate::translate(&steps, &places, &threaded.outputs))?;
        // SAFETY: the code is a function of this kind
        let run = unsafe { std::mem::transmute::<*const c_void, Handler>(pages.start()) };
        Some(Self {
            op: Op {
                run,
                operands: [0; 6],
            },
            n_spare: steps.first_constant - threaded.n_registers,
            _pages: pages,
            _called: called,
        })
    }
}
