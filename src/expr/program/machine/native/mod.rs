//! The threaded code translated into code of the processor (x86-64 under Linux).
//!
//! The translation is one operation like any other: it is given the frame and the inputs, and does what all operations of
//! the threaded code do, in the same order, with the same roundings: the results are the same bits. What has a handler of
//! its own (functions, tables) is called. Code is written when the program is made, which takes little, and brought
//! into memory that can be executed when the program first runs. Where the system refuses that, the threaded code runs.
//!
//! # Safety
//!
//! The code reads and writes what the threaded code does, which [`super::Machine::check`] has seen to be inside the frame;
//! slots beyond the frame live in registers only.

mod assembler;
mod pages;
mod steps;
mod translate;

use super::{Handler, Kind, Meaning, Op, handlers};
use crate::expr::program::Core;
use pages::Pages;
use std::collections::HashMap;
use std::sync::{Arc, OnceLock};
use steps::{Step, Steps};

/// The translation of a program.
pub(super) struct Native {
    code: Vec<u8>,
    /// operations that the code calls, each followed by the end
    _called: Box<[[Op; 2]]>,
    /// where the code stands once it has run, and the operation that is the code
    loaded: OnceLock<Option<(Pages, Op)>>,
}

impl Native {
    pub(super) fn of(
        ops: &[Op],
        kinds: &[Kind],
        meanings: &[Meaning],
        core: &Core,
        n_registers: usize,
        outputs: &[u32],
    ) -> Option<Arc<Self>> {
        // places in the frame are distances of 32 bits
        if n_registers >= 1 << 27 {
            return None;
        }
        let steps = Steps::of(ops, kinds, meanings, core, n_registers, outputs);
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
        let called: Box<[[Op; 2]]> = numbers.iter().map(|&k| [ops[k as usize], end]).collect();
        let places: HashMap<u32, *const Op> = numbers
            .into_iter()
            .zip(called.iter().map(|pair| pair.as_ptr()))
            .collect();
        let code = translate::translate(&steps, &places, outputs);
        Some(Arc::new(Self {
            code,
            _called: called,
            loaded: OnceLock::new(),
        }))
    }

    /// The operation that is the whole program; `None` where there can be none.
    pub(super) fn start(&self) -> Option<*const Op> {
        let loaded = self.loaded.get_or_init(|| {
            let pages = Pages::new(&self.code)?;
            // SAFETY: the code is a function of this kind
            let run =
                unsafe { std::mem::transmute::<*const std::ffi::c_void, Handler>(pages.start()) };
            Some((
                pages,
                Op {
                    run,
                    operands: [0; 6],
                },
            ))
        });
        loaded.as_ref().map(|(_, op)| std::ptr::from_ref(op))
    }
}
