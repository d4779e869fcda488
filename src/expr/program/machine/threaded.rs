//! No translation: for processors and systems that `native` does not know.

use super::{Kind, Meaning, Op};
use crate::expr::program::Core;
use std::sync::Arc;

/// What would be translated.
#[allow(dead_code)]
pub(super) struct Threaded {
    pub(super) ops: Arc<[Op]>,
    pub(super) kinds: Vec<Kind>,
    pub(super) meanings: Vec<Meaning>,
    pub(super) core: Arc<Core>,
    pub(super) parameters: Vec<f64>,
    pub(super) n_registers: usize,
    pub(super) outputs: Vec<u32>,
}

pub(super) enum Native {}

impl Native {
    pub(super) fn of(_: Threaded) -> Option<Arc<Self>> {
        None
    }
    pub(super) fn start(&self) -> Option<*const Op> {
        match *self {}
    }
    pub(super) fn n_spare(&self) -> usize {
        match *self {}
    }
}
