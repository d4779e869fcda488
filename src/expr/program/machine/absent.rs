//! No code of the processor: for builds without the feature `native`, and for processors and
//! systems that it does not know.

use super::super::batch::Block;
use super::super::code::{Core, Instruction};
use super::steps::Steps;
use std::sync::Arc;

/// There is none.
pub(super) enum Native {}

impl Native {
    pub(super) fn of(_: &Steps, _: &Arc<Core>) -> Option<Self> {
        None
    }
    pub(super) fn run(&self, _: &mut [f64], _: &[f64], _: &mut [f64]) -> Option<f64> {
        match *self {}
    }
    pub(super) fn run_inside(&self, _: &mut [f64], _: &[f64]) -> Option<f64> {
        match *self {}
    }
}

/// There are no loops over columns.
#[derive(Debug)]
pub(in crate::expr::program) enum Columns {}

impl Columns {
    pub(in crate::expr::program) fn are_to_be_had() -> bool {
        false
    }
    pub(in crate::expr::program) fn can(_: &Instruction) -> bool {
        false
    }
    pub(in crate::expr::program) fn frame(_: &Core) -> Vec<f64> {
        Vec::new()
    }
    pub(in crate::expr::program) fn of(_: &Core, _: &[Instruction], _: &[u32]) -> Option<Self> {
        None
    }
    pub(in crate::expr::program) fn over_blocks(&self, _: &mut [f64], _: &mut [Block]) {
        match *self {}
    }
    pub(in crate::expr::program) fn over_columns<'a>(
        &self,
        _: &mut [f64],
        _: impl Iterator<Item = &'a [f64]>,
        _: &mut [&mut [f64]],
    ) {
        match *self {}
    }
    pub(in crate::expr::program) fn inputs(&self) -> &[u32] {
        match *self {}
    }
}
