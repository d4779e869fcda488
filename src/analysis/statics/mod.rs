//! Equilibrium: where loads and reactions balance at rest.
//!
//! A damped descent from the present configuration, taken in ever longer implicit steps until it
//! is Newton's iteration:
//!
//! ```text
//! D q̇ = f(q, x) + Gᵀλ,   ẋ = e(q, x),   g(q) = 0      D: mass matrix, a little added everywhere
//! ⎡ D/h − K   −Gᵀ ⎤ ⎡Δ ⎤   ⎡ f + Gᵀλ ⎤
//! ⎣    G       0  ⎦ ⎣Δλ⎦ = ⎣   −g    ⎦     K = ∂(f + Gᵀλ)/∂q,  λ balances f as well as rows can
//! ```
//!
//! Short steps follow the descent, which loses energy and therefore ends at a stable place or
//! nowhere; long ones converge quadratically. A step is kept when the loads found at its end are
//! those that its linear model foretold, and when the matrix is positive on the motions that the
//! rows leave: then it cannot jump to the top of a hill. A singular stiffness, as of a body that
//! touches nothing yet, needs no special treatment.
//!
//! A state may be the integral of a velocity (a spring that knows how far it was wound): at rest
//! its rate is zero wherever it stands, and no equation of the end finds it. Where no equilibrium
//! is found otherwise, such states follow the velocities of the descent, Δ/h:
//!
//! ```text
//! Δx/h = e + … + ∂e/∂v Δ/h
//! ```
//!
//! An equilibrium that turns out to be a saddle is left along its steepest descent, unless the
//! model stood there from the start.

mod asked;
mod descent;
mod metric;
mod outcome;
mod point;
mod stability;
mod step;

pub use outcome::Imbalance;
pub use stability::Stability;

use crate::analysis::system::System;
use crate::analysis::watch::Watch;
use crate::expr::program::{Program, Work};
use crate::model;
use crate::numeric::Stats;
use crate::numeric::dense::Lu;
use crate::numeric::pattern::Pattern;
use crate::scalar::Dual;
use crate::scene::layout::Layout;
use crate::scene::programs::{record_more, record_moving};
use crate::scene::slopes::WIDTH;
use asked::Asked;
use nalgebra::DMatrix;
use point::Point;

/// Saddles that are left before one is accepted.
const MAX_SADDLES: usize = 8;
/// Length of the push off a saddle, as a part of ALIMIT, of one radian at most.
const PUSH: f64 = 0.01;

/// The settings of EQUILIBRIUM.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// ERROR: largest rate of a state that may remain; `None`: what rounding leaves
    pub error: Option<f64>,
    /// TLIMIT: largest translation in one iteration; `None`: twenty sizes of the mechanism
    pub translation: Option<f64>,
    /// ALIMIT: largest rotation in one iteration   (rad)
    pub angle: f64,
    /// MAXIT
    pub iterations: usize,
    /// IMBALANCE: largest force or torque that may remain; `None`: what rounding leaves
    pub imbalance: Option<f64>,
    /// STABILITY: least part of the mass matrix that is added to the stiffness
    pub stability: f64,
    /// factor of the first step: another one goes another way to the same place, whose last digits
    /// are others
    pub pace: f64,
}

impl Settings {
    /// Takes the settings of a model, defaults where it says nothing. No default is a length, a
    /// force or a time.
    pub fn of(settings: &model::EquilibriumSettings) -> Self {
        let given = |number: Option<f64>| number.filter(|x| x.is_finite() && *x > 0.0);
        Self {
            error: given(settings.error),
            translation: given(settings.tlimit),
            angle: given(settings.alimit).unwrap_or(10f64.to_radians()),
            iterations: given(settings.maxit).unwrap_or(25.0) as usize,
            imbalance: given(settings.imbalance),
            stability: given(settings.stability).unwrap_or(1e-5),
            pace: 1.0,
        }
    }

    /// Returns whether it is said how good is good enough.
    fn asked(&self) -> bool {
        self.error.is_some() && self.imbalance.is_some()
    }
}

/// An equilibrium; its configuration stands in the numbers of the system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// steps of the descent
    pub iterations: usize,
    /// largest force or torque that is left
    pub imbalance: f64,
    /// the answers to a push, as stiffness gives them
    pub stability: Stability,
    /// whether these decide what becomes of a push: loads have a potential, what depends on
    /// velocities takes energy, and no state acts back
    pub is_passive: bool,
}

impl Equilibrium {
    /// Returns that of this mechanism and of another one that nothing couples to it.
    pub(in crate::analysis) fn beside(&self, other: &Self) -> Self {
        let [own, others] = [self.stability, other.stability];
        Self {
            iterations: self.iterations + other.iterations,
            imbalance: self.imbalance.max(other.imbalance),
            stability: Stability {
                stable: own.stable + others.stable,
                neutral: own.neutral + others.neutral,
                unstable: own.unstable + others.unstable,
            },
            is_passive: self.is_passive && other.is_passive,
        }
    }
}

/// The reason why there is no equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub enum NoEquilibrium {
    /// what is not balanced
    Unbalanced(Imbalance),
    /// the caller asked to stop
    Interrupted,
}

/// The search for an equilibrium.
struct Settler<'a> {
    system: &'a mut System,
    settings: &'a Settings,
    /// the caller, who may want to stop
    asked: Asked<'a>,
    /// loads with multipliers | row values | e
    program: Program,
    /// which of them change along which coordinates and states, once it has been asked for
    pattern: Option<Pattern>,
    work: Work,
    dual_work: Work<Dual<WIDTH>>,
    /// places in x of the states that are sought
    states: Vec<usize>,
    /// e of the states that are sought, where some reads a velocity
    moving: Option<Program>,
    /// ∂e/∂v where the derivatives were taken last   (n_d × n_v)
    drift: Option<DMatrix<f64>>,
    /// indices of the active rows
    rows: Vec<usize>,
    /// the matrix of a step, and its factors
    lu: Lu,
    evaluations: usize,
    factorizations: usize,
}

/// Brings a system to rest from its present state; its numbers end at the equilibrium, or where
/// the search ended.
///
/// # Errors
/// When there is none to be found: what is not balanced.
pub fn settle(
    system: &mut System,
    settings: &Settings,
    watch: &mut dyn Watch,
    stats: &mut Stats,
) -> Result<Equilibrium, NoEquilibrium> {
    let mut asked = Asked::new(watch);
    if asked.stops() {
        return Err(NoEquilibrium::Interrupted);
    }
    let mut settler = Settler::new(system, settings, asked)?;
    let moving = settler.moving.take();
    let begin = settler.system.numbers.clone();
    let mut found = settler.run();
    // most states that integrate velocities only count: they are wound up where nothing else holds
    // the load
    if moving.is_some() && matches!(found, Err(NoEquilibrium::Unbalanced(..))) {
        let end = std::mem::replace(&mut settler.system.numbers, begin);
        settler.moving = moving;
        match settler.run() {
            Err(NoEquilibrium::Unbalanced(_)) => settler.system.numbers = end,
            other => found = other,
        }
    }
    stats.evaluations += settler.evaluations;
    stats.factorizations += settler.factorizations;
    if let Ok(e) = &found {
        stats.steps += e.iterations;
    }
    found
}

impl<'a> Settler<'a> {
    fn new(
        system: &'a mut System,
        settings: &'a Settings,
        asked: Asked<'a>,
    ) -> Result<Self, NoEquilibrium> {
        let scene = system.configured();
        let rows: Vec<usize> = scene.configuration.active_rows().collect();
        let states: Vec<usize> = (scene.differentials.iter())
            .filter(|d| !d.static_hold)
            .filter_map(|d| d.state)
            .collect();
        let (program, complaints) = record_more(scene, rows.len(), |at, multipliers| {
            let mut out = at.balance(multipliers);
            out.extend(rows.iter().map(|&r| at.row(r).value));
            let rates = at.state_rates();
            out.extend(states.iter().map(|&x| rates[x]));
            out
        });
        if let Some(first) = complaints.first() {
            return Err(NoEquilibrium::Unbalanced(Imbalance::Unsupported(
                first.clone(),
            )));
        }
        let moving = record_moving(scene, |at| {
            let rates = at.state_rates();
            states.iter().map(|&x| rates[x]).collect()
        });
        let mut speeds = vec![Vec::new(); scene.layout.len()];
        scene.layout.v().for_each(|place| speeds[place].push(0));
        let follows = moving.dependence(&speeds);
        let moving = (follows.iter().any(|along| !along.is_empty())).then_some(moving);
        Ok(Self {
            program,
            pattern: None,
            work: Work::default(),
            dual_work: Work::default(),
            drift: None,
            moving,
            states,
            rows,
            lu: Lu::new(0),
            evaluations: 0,
            factorizations: 0,
            system,
            settings,
            asked,
        })
    }

    fn n_v(&self) -> usize {
        self.system.scene.layout.n_v
    }

    /// Descends from where the system stands, past saddles, to an equilibrium.
    fn run(&mut self) -> Result<Equilibrium, NoEquilibrium> {
        let found = self.descend_past_saddles();
        // what came of a search that ended early says nothing
        if self.asked.stops() {
            return Err(NoEquilibrium::Interrupted);
        }
        found
    }

    fn descend_past_saddles(&mut self) -> Result<Equilibrium, NoEquilibrium> {
        let l = self.system.scene.layout;
        let mut start = self.system.numbers.clone();
        start[l.v()].fill(0.0);
        let nothing = || NoEquilibrium::Unbalanced(Imbalance::NoValue);
        let mut p = self.point(&start).ok_or_else(nothing)?;
        let mut saddles = 0;
        let mut iterations = 0;
        loop {
            let stood = iterations == 0;
            let (outcome, jacobian) = self.descend(&mut p, &mut iterations);
            self.keep(&p);
            outcome?;
            let stood = stood && iterations == 0;
            let answers = self.stability(&p, &jacobian);
            let leave = answers.stability.unstable > 0 && !stood && saddles < MAX_SADDLES;
            let pushed = answers
                .descent
                .as_ref()
                .filter(|_| leave)
                .and_then(|descent| {
                    saddles += 1;
                    let push = descent * (PUSH * self.settings.angle.min(1.0));
                    self.moved(&p, &push).and_then(|n| self.point(&n))
                });
            match pushed {
                Some(pushed) => p = pushed,
                None => {
                    return Ok(Equilibrium {
                        iterations,
                        imbalance: p.force.amax(),
                        stability: answers.stability,
                        is_passive: self.is_passive(&p, &answers),
                    });
                }
            }
        }
    }

    /// Puts a configuration into the system.
    fn keep(&mut self, p: &Point) {
        let y = p.numbers[self.system.scene.layout.y()].to_vec();
        self.system.numbers.copy_from_slice(&p.numbers);
        self.system.count_turns(p.numbers[Layout::TIME], &y);
    }
}
