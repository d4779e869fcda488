//! No translation: for processors and systems that `native` does not know.

use super::{Op, Threaded};
use std::sync::Arc;

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
