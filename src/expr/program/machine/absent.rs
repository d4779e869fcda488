//! No code of the processor: for builds without the feature `native`, and for processors and
//! systems that it does not know.

use super::super::code::Core;
use super::steps::Steps;
use std::sync::Arc;

/// There is none.
pub(super) enum Native {}

impl Native {
    pub(super) fn of(_: &Steps, _: &Arc<Core>) -> Option<Self> {
        None
    }
    pub(super) fn run(&self, _: &mut [f64], _: &[f64]) -> Option<f64> {
        match *self {}
    }
}
