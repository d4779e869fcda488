//! Results kept within one instant: each thing is computed when it is first asked for.

use super::formulas::Opened;
use super::{RowValue, Solved, Unsupported};
use crate::physics::action::Action;
use crate::scalar::Jet;
use crate::scene::Scene;
use crate::scene::loops::Key;
use crate::scene::sweep::{LinkState, Wrench};
use crate::space::{Frame, MarkerState};
use std::cell::{Cell, OnceCell, RefCell};
use std::collections::BTreeSet;
use std::rc::Rc;

/// Two markers, and their frames as they move in time.
pub(super) type InTime<S> = ([usize; 2], [Frame<Jet<S>>; 2]);

/// Values of some of many things: room is taken by those that were asked for, as most of a large
/// scene may be asked for by nobody.
#[derive(Clone)]
pub(super) struct Asked<T> {
    /// where a value stands among these, counted from one; 0: it was not asked for
    place: Vec<u32>,
    values: Vec<T>,
}

/// Number of values for which there is room from the beginning.
const ROOM: usize = 16;

impl<T: Copy> Asked<T> {
    /// Creates the values of things of which none was asked for.
    fn none(n: usize) -> Self {
        Self {
            place: vec![0; n],
            values: Vec::with_capacity(n.min(ROOM)),
        }
    }

    /// Returns a value, where it was asked for before.
    pub fn get(&self, k: usize) -> Option<T> {
        let place = (self.place[k] as usize).checked_sub(1)?;
        Some(self.values[place])
    }

    /// Keeps a value that was not asked for before.
    pub fn keep(&mut self, k: usize, value: T) {
        self.values.push(value);
        self.place[k] = self.values.len() as u32;
    }
}

/// Results found so far, and questions that are open.
pub(super) struct Scratch<S> {
    /// links with the accelerations of driven coordinates only   (n_links)
    pub links: OnceCell<Rc<Vec<LinkState<S>>>>,
    /// poses and velocities of those markers that were asked for
    pub markers: RefCell<Asked<MarkerState<S>>>,
    /// two markers as they move in time: those of the row that was evaluated last, as the rows of
    /// a joint are of the same two
    pub in_time: RefCell<Option<InTime<S>>>,
    /// values of formulas   (n_formulas)
    pub formulas: RefCell<Vec<Option<S>>>,
    /// rows but for formulas   (n_rows)
    pub rows: RefCell<Vec<Option<Rc<RowValue<S>>>>>,
    /// formulas being evaluated: a formula that asks for itself is a loop
    pub open: RefCell<Opened>,
    /// accelerations and multipliers
    pub solved: OnceCell<Solved<S>>,
    /// links with all accelerations   (n_links)
    pub accelerated: OnceCell<Vec<LinkState<S>>>,
    /// what the carrier exerts on each link   (n_links)
    pub carried: OnceCell<Vec<Wrench<S>>>,
    /// true while loads are found, on which accelerations depend
    pub solving: Cell<bool>,
    /// reactions of the least set where dependent rows leave them open   (n_constraints or 0)
    pub least: OnceCell<Vec<Option<Action<S>>>>,
    /// unknowns of loops that were asked for too early, in the order in which they were
    pub discovered: RefCell<Vec<Key>>,
    /// the same, to be found
    pub early: RefCell<BTreeSet<Key>>,
    /// algebraic equations whose rates are being found
    pub rates_open: RefCell<Vec<usize>>,
    /// what could not be supplied, for the compiler to report
    pub complaints: RefCell<Vec<Unsupported>>,
}

impl<S: Copy> Scratch<S> {
    /// Creates the scratch of an instant at which nothing has been asked for.
    pub fn new(scene: &Scene) -> Self {
        Self {
            links: OnceCell::new(),
            markers: RefCell::new(Asked::none(scene.markers.len())),
            in_time: RefCell::default(),
            formulas: RefCell::new(vec![None; scene.formulas.len()]),
            rows: RefCell::new(vec![None; scene.rows.len()]),
            open: RefCell::new(Opened::none(scene.formulas.len())),
            solved: OnceCell::new(),
            accelerated: OnceCell::new(),
            carried: OnceCell::new(),
            solving: Cell::new(false),
            least: OnceCell::new(),
            discovered: RefCell::default(),
            early: RefCell::default(),
            rates_open: RefCell::default(),
            complaints: RefCell::default(),
        }
    }

    /// Creates the scratch of the same instant at which nothing is known that may depend on
    /// accelerations.
    pub fn before_accelerations(&self, scene: &Scene) -> Self {
        Self {
            links: self.links.clone(),
            markers: self.markers.clone(),
            rows: self.rows.clone(),
            complaints: self.complaints.clone(),
            ..Self::new(scene)
        }
    }

    /// Computes what accelerations depend on: whoever asks for these meanwhile asks too early.
    pub fn while_solving<T>(&self, compute: impl FnOnce() -> T) -> T {
        let before = self.solving.replace(true);
        let found = compute();
        self.solving.set(before);
        found
    }
}
