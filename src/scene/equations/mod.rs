//! All that can be computed at one instant, generic over the number, each thing when it is first
//! asked for.
//!
//! ```text
//! t, q, v, x → links, markers → formulas → loads ┐
//!                              mass matrix, rows ┴→ v̇, λ → accelerations, reactions → measures
//! ```
//!
//! Run over `f64` this is the reference; run over a recording number it becomes the program that
//! the solver runs.

mod algebraic;
mod cams;
mod dynamics;
mod energy;
mod formulas;
mod general;
mod least_reactions;
mod loops;
mod measures;
mod reactions;
mod rows;
mod scratch;
mod turns;
mod undetermined_reactions;
mod unsupported;

pub use dynamics::Solved;
pub use energy::Powers;
pub(in crate::scene) use reactions::element_of;
pub use rows::{RowValue, row_name};
pub use turns::TurnedAngle;
pub use unsupported::{Lack, Unsupported};

use super::Scene;
use super::configuration::{Configuration, Configured};
use super::layout::{Instant, several};
use super::sweep::{self, Coordinates};
use crate::expr::program::Input;
use crate::model::{ElementId, Level};
use crate::physics::action::Action;
use crate::scalar::{Jet, Scalar};
use crate::scene::asker::Asker;
use crate::space::MarkerState;
use scratch::Scratch;
use std::ops::Range;
use std::rc::Rc;

/// Value of MODE in a kinematic analysis.
pub const KINEMATIC: f64 = 1.0;
/// Value of MODE in a static analysis: nothing moves, motions stand still where they are.
pub const STATIC: f64 = 5.0;

/// One instant of a scene.
pub struct Equations<'s, S: Scalar> {
    scene: &'s Scene,
    configuration: &'s Configuration,
    /// the numbers that it was given
    now: Instant<S>,
    /// value, rate and acceleration that each motion prescribes   (n_motions)
    driven: Vec<Jet<S>>,
    /// notes what is asked for too early instead of complaining
    discovering: bool,
    /// everything else, as it is asked for
    scratch: Scratch<S>,
}

impl<'s, S: Scalar> Equations<'s, S> {
    /// From the flat row of numbers that [`Layout`](super::layout::Layout) describes.
    pub fn new(scene: Configured<'s>, numbers: &[S]) -> Self {
        let loops = numbers[scene.layout.loops()].to_vec();
        Self::with_unknowns(scene, numbers, loops, false)
    }

    /// As [`Equations::new`], with values for the unknowns of algebraic loops; or to find out which
    /// these are.
    pub(in crate::scene) fn with_unknowns(
        scene: Configured<'s>,
        numbers: &[S],
        loops: Vec<S>,
        discovering: bool,
    ) -> Self {
        let Configured {
            scene,
            configuration,
        } = scene;
        let mut this = Self {
            scene,
            configuration,
            now: Instant {
                loops,
                ..scene.layout.instant(numbers)
            },
            driven: Vec::new(),
            discovering,
            scratch: Scratch::new(scene),
        };
        this.driven = (0..scene.motions.len()).map(|m| this.drive(m)).collect();
        this
    }

    /// Returns the same instant in a configuration that differs in the order of elimination only:
    /// links, markers and rows are known there, too.
    pub(in crate::scene) fn eliminating(&self, configuration: &'s Configuration) -> Self {
        Self {
            scene: self.scene,
            configuration,
            now: self.now.clone(),
            driven: self.driven.clone(),
            discovering: self.discovering,
            scratch: self.scratch.before_accelerations(self.scene),
        }
    }

    /// Returns what could not be supplied; empty when all is well.
    pub fn complaints(&self) -> Vec<Unsupported> {
        self.scratch.complaints.borrow().clone()
    }

    /// Notes what could not be supplied; its value is NaN.
    fn complain(&self, asked_by: &Asker, lack: Lack) -> S {
        let what = Unsupported::new(asked_by.clone(), lack);
        let mut complaints = self.scratch.complaints.borrow_mut();
        if !complaints.contains(&what) {
            complaints.push(what);
        }
        S::constant(f64::NAN)
    }

    /// Where every link is and how it moves, with the accelerations of driven coordinates only.
    pub fn links(&self) -> &[sweep::LinkState<S>] {
        let links = || Rc::new(sweep::outward(self.scene, &self.coordinates(&[])));
        self.scratch.links.get_or_init(links)
    }

    fn coordinates<'a>(&'a self, vdot: &'a [S]) -> Coordinates<'a, S> {
        Coordinates {
            q: &self.now.q,
            v: &self.now.v,
            vdot,
            driven: &self.driven,
        }
    }

    /// Time.
    pub fn time(&self) -> S {
        self.now.t
    }

    /// Returns some of the further states.
    pub fn further_states(&self, places: &std::ops::Range<usize>) -> &[S] {
        &self.now.x[places.clone()]
    }

    /// Velocities of the free coordinates   (n_v)
    pub fn velocities(&self) -> &[S] {
        &self.now.v
    }

    /// Value, rate and acceleration that a motion prescribes.
    fn drive(&self, m: usize) -> Jet<S> {
        let moving = self.drive_in_time(m);
        if self.scene.mode == STATIC {
            Jet::new(moving.value, S::zero(), S::zero())
        } else {
            moving
        }
    }

    fn drive_in_time(&self, m: usize) -> Jet<S> {
        let motion = &self.scene.motions[m];
        let start = &self.configuration.motions[m];
        if let Some(displacement) = start.stands_at {
            return Jet::constant(displacement);
        }
        let f = match self.scene.computed(motion.formula) {
            // a closure of the user's tells its derivatives
            Some(p) => {
                let [value, first, second] = several(&self.now.external, p);
                Jet::new(value, first, second)
            }
            None => self.in_time(motion.formula, 2),
        };
        let state = |k: usize| motion.state.map_or_else(S::zero, |s| self.now.x[s + k]);
        let offset = S::constant(start.offset);
        match motion.level {
            Level::Displacement => f,
            Level::Velocity => Jet::new(state(0) + offset, f.value, f.first),
            Level::Acceleration => Jet::new(state(0) + offset, state(1), f.value),
        }
    }

    /// Value, rate and acceleration that a motion prescribes now.
    pub fn prescribed(&self, motion: usize) -> Jet<S> {
        self.driven[motion]
    }

    /// The function of a motion, whatever its level; of one that stands still, its displacement.
    pub fn motion_function(&self, m: usize) -> S {
        if let Some(displacement) = self.configuration.motions[m].stands_at {
            return S::constant(displacement);
        }
        let formula = self.scene.motions[m].formula;
        self.in_time(formula, 0).value
    }

    /// Pose and velocity of a marker; its accelerations are those of driven coordinates only.
    pub fn marker(&self, m: usize) -> MarkerState<S> {
        if let Some(state) = self.scratch.markers.borrow().get(m) {
            return state;
        }
        let state = sweep::marker_state(&self.scene.markers[m], self.links());
        self.scratch.markers.borrow_mut().keep(m, state);
        state
    }

    /// The user's number of a marker.
    pub fn marker_id(&self, m: usize) -> u32 {
        self.scene.markers[m].id
    }

    /// A part's frame, with its accelerations when asked for.
    pub fn part(&self, part: usize, accelerated: bool) -> MarkerState<S> {
        let p = &self.scene.parts[part];
        let marker = super::MarkerOnLink {
            id: 0,
            link: p.link,
            frame: p.frame,
            part: Some(part),
        };
        sweep::marker_state(
            &marker,
            if accelerated {
                self.accelerated_links()
            } else {
                self.links()
            },
        )
    }

    /// Action of an element on its I marker; `None` when there is no such active element.
    pub fn action_of(&self, id: ElementId) -> Option<Action<S>> {
        self.element(id).map(|found| found.0)
    }

    /// A marker with all its accelerations.
    pub fn accelerated_marker(&self, m: usize) -> MarkerState<S> {
        sweep::marker_state(&self.scene.markers[m], self.accelerated_links())
    }

    /// A marker by the user's number, also a floating one of a contact; with accelerations when
    /// asked for.
    fn marker_by_id(&self, id: u32, accelerated: bool) -> Option<MarkerState<S>> {
        if let Some(&m) = self.scene.marker_of.get(&id) {
            return Some(if accelerated {
                self.accelerated_marker(m)
            } else {
                self.marker(m)
            });
        }
        let &floating = self.scene.floating.get(&id)?;
        Some(self.floating_marker(floating, accelerated))
    }

    /// Numbers from outside: places among these.
    pub fn external(&self, places: Range<usize>) -> &[S] {
        &self.now.external[places]
    }

    /// Supplies what a formula asks for: the one door between the language and the scene.
    pub fn input(&self, input: Input, asked_by: &Asker) -> S {
        match input {
            Input::Time => self.now.t,
            Input::Mode => S::constant(self.scene.mode),
            Input::Measure(measure, ids) => self.measure(measure, ids, asked_by),
            Input::Delayed(_) | Input::Slot(_) => {
                unreachable!("numbers from outside are asked for by formulas alone")
            }
        }
    }
}
