//! The caller of a search for an equilibrium, who may want to stop within each of its steps.

use crate::analysis::watch::Watch;

/// A caller who is asked on the way; who wanted to stop once is asked no more.
pub(super) struct Asked<'a> {
    watch: &'a mut dyn Watch,
    stops: bool,
}

impl<'a> Asked<'a> {
    /// Takes a caller who has not been asked.
    pub(super) fn new(watch: &'a mut dyn Watch) -> Self {
        Self {
            watch,
            stops: false,
        }
    }

    /// Returns whether to stop, now or before.
    pub(super) fn stops(&mut self) -> bool {
        self.stops = self.stops || self.watch.interrupted();
        self.stops
    }

    /// Returns nothing where the caller wants to stop: what is being computed is needed no more.
    pub(super) fn go_on(&mut self) -> Option<()> {
        (!self.stops()).then_some(())
    }
}
