//! Clocks: the values of time alone through which time acts on the rest of a system.
//!
//! The error of each step says that the states are resolved by it. Nothing says so of a function of
//! time that acts on nothing yet: a wall that shakes a thousand times within one step of a body far
//! from it. As long as each clock rises or falls throughout a step, time acts as one more state
//! does; where one turns, what reads the time is not judged by the ends of the step.
//!
//! ```text
//! c(t): clocks        ċ over [t0, t1] keeps its sign, or is zero throughout     ([`Interval`])
//! ```

use crate::expr::program::{Program, Work};
use crate::numeric::subdivision::{self, Search};
use crate::scalar::Interval;
use crate::scene::layout::Layout;

/// Part of a stretch below which the place of a turn is not asked for more exactly.
const PLACE: f64 = 1e-6;

/// The clocks of a system.
#[derive(Clone, Debug, Default)]
pub struct Clocks {
    /// their rates; `None`: there are none
    rates: Option<Program>,
    work: Work<Interval>,
    /// the row of numbers, of which the time is read
    inputs: Vec<Interval>,
    bounds: Vec<Interval>,
    /// a stretch in which none turns
    steady: [f64; 2],
}

impl Clocks {
    /// Takes the program of the clocks.
    pub fn new(clocks: &Program) -> Self {
        let zero = Interval { lo: 0.0, hi: 0.0 };
        let n = clocks.n_outputs();
        if n == 0 {
            return Self::default();
        }
        Self {
            inputs: vec![zero; clocks.inputs().len()],
            bounds: vec![zero; n],
            rates: Some(clocks.rate(Layout::TIME)),
            work: Work::default(),
            steady: [f64::NAN; 2],
        }
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.rates.is_none()
    }

    /// Returns whether no clock turns between two times.
    pub fn are_steady(&mut self, from: f64, to: f64) -> bool {
        let [since, until] = self.steady;
        if self.is_empty() || since <= from && to <= until {
            return true;
        }
        // what follows, too, if that is so
        for reach in [8.0, 1.0] {
            let to = from + reach * (to - from);
            if self.keep_signs(from, to) {
                self.steady = [from, to];
                return true;
            }
        }
        false
    }

    /// Returns the times between two times at which a clock may turn, at most so many; the last
    /// `to` where there are no more.
    pub fn turns(&mut self, from: f64, to: f64, most: usize) -> Vec<f64> {
        let mut found = Vec::new();
        let mut at = from;
        let search = Search {
            first: to - from,
            shortest: PLACE * (to - from),
        };
        while found.len() < most && at < to && !self.is_empty() {
            let steady = |clocks: &mut Self, a: f64, b: f64| clocks.keep_signs(a, b);
            let turn = subdivision::first(self, (at, to), search, steady, |_, _, b| Some(b));
            at = turn.event.unwrap_or(turn.free_to);
            found.push(at);
            if turn.event.is_none() && at < to {
                break;
            }
        }
        if found.last() != Some(&to) && found.len() < most {
            found.push(to);
        }
        found
    }

    /// Returns whether the rates of all clocks surely keep their signs between two times.
    fn keep_signs(&mut self, from: f64, to: f64) -> bool {
        let Some(rates) = &self.rates else {
            return true;
        };
        self.inputs[Layout::TIME] = Interval { lo: from, hi: to };
        rates.eval(&self.inputs, &mut self.work, &mut self.bounds);
        let keeps = |rate: &Interval| rate.lo >= 0.0 || rate.hi <= 0.0;
        self.bounds.iter().all(keeps)
    }
}
