//! A look on the way: long phases of setting up ask between their pieces whether to go on.

use super::watch::Watch;
use crate::diagnostic::Diagnostic;

/// Asked whether to go on; the answer to a caller who does not want that is an error.
pub(in crate::analysis) type Look<'a> = &'a mut dyn FnMut() -> Result<(), Vec<Diagnostic>>;

/// A caller who is asked while an equilibrium is sought; who wanted to stop once is asked no more.
pub(in crate::analysis) struct Asked<'a> {
    watch: &'a mut dyn Watch,
    stops: bool,
}

impl<'a> Asked<'a> {
    /// Takes a caller who has not been asked.
    pub(in crate::analysis) fn new(watch: &'a mut dyn Watch) -> Self {
        Self {
            watch,
            stops: false,
        }
    }

    /// Returns whether to stop, now or before.
    pub(in crate::analysis) fn stops(&mut self) -> bool {
        self.stops = self.stops || self.watch.interrupted();
        self.stops
    }

    /// Returns nothing where the caller wants to stop: what is being computed is needed no more.
    pub(in crate::analysis) fn go_on(&mut self) -> Option<()> {
        (!self.stops()).then_some(())
    }
}
