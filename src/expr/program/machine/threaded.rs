//! No translation: for processors and systems that `native` does not know.

use super::{Kind, Meaning, Op};
use crate::expr::program::Core;
use std::sync::Arc;

pub(super) enum Native {}

impl Native {
    pub(super) fn of(
        _: &[Op],
        _: &[Kind],
        _: &[Meaning],
        _: &Core,
        _: usize,
        _: &[u32],
    ) -> Option<Arc<Self>> {
        None
    }
    pub(super) fn start(&self) -> Option<*const Op> {
        match *self {}
    }
}
