//! A run that somebody attends: its progress is shown, and what ends it is listened for.

use super::limit::{Guard, simulations_to_the_end};
use super::mistake::Mistake;
use super::progress::Progress;
use super::{interrupt, output};
use cognate::analysis::session::Session;
use cognate::analysis::session::script::obey;
use cognate::analysis::watch::Watch;
use cognate::dataset::command::Step;
use cognate::diagnostic::Error;
use cognate::numeric::Stats;
use cognate::results::{Run, Status};
use std::cell::{Cell, RefCell};

/// The surroundings of a run.
pub struct Attended<'a> {
    /// no progress is shown
    pub is_quiet: bool,
    /// bars of error come after the rows
    pub has_bars: bool,
    /// the tables that are written while it goes on
    pub tables: &'a output::Tables,
    /// ends what does not listen
    pub guard: &'a Guard,
    /// what a routine has done wrong
    pub mistake: &'a Mistake,
}

/// Shows progress and listens for Ctrl-C.
struct Terminal<'a> {
    of: &'a Attended<'a>,
    progress: &'a RefCell<Progress>,
    /// simulations that are still to begin, where nothing comes after the last of them
    left: &'a Cell<Option<usize>>,
}

impl Watch for Terminal<'_> {
    fn interrupted(&mut self) -> bool {
        interrupt::requested() || self.of.tables.have_failed() || self.of.mistake.is_there()
    }
    fn progress(&mut self, t: f64, _h: f64, stats: &Stats) {
        interrupt::results_begin();
        self.of.guard.moves();
        self.progress.borrow().at(t, stats.steps);
    }
    fn measures(&mut self, t: f64, stats: &Stats) {
        self.of.guard.moves();
        self.progress.borrow().measures(t, stats.steps);
    }
    fn simulated(&mut self, run: &Run) {
        match self.left.get() {
            // only writing is left, and nobody needs a copy
            Some(0) => self.of.guard.done(),
            _ => self.of.guard.keep(run),
        }
    }
}

impl Attended<'_> {
    /// Obeys the commands of a run, with a bar of its progress.
    ///
    /// # Errors
    /// Those of the commands and of the model, and what a routine has done wrong.
    pub fn solve(&self, session: &mut Session, steps: &[Step]) -> Result<Status, Error> {
        let progress = RefCell::new(Progress::new(true, 0.0, 1.0));
        let left = simulations_to_the_end(steps).filter(|_| !self.has_bars);
        let left = Cell::new(left);
        let begin = |start: f64, end: f64| {
            left.set(left.get().map(|n| n.saturating_sub(1)));
            progress.borrow().done();
            *progress.borrow_mut() = Progress::new(self.is_quiet, start, end);
        };
        let mut terminal = Terminal {
            of: self,
            progress: &progress,
            left: &left,
        };
        let outcome = obey(session, steps, begin, &mut terminal);
        progress.borrow().done();
        self.mistake.before(outcome)
    }
}
