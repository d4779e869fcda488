//! A scene as F(t, y, ẏ) = 0, for methods for differential-algebraic equations.
//!
//! ```text
//! I3    q̇ = N(q) v                  M v̇ + h = f + Gᵀλ      ẋ = s      g(t, q) = 0                     y = q | v | x | λ
//! SI2   q̇ = N(q) (v + A Gᵀμ)        M v̇ + h = f + Gᵀλ      ẋ = s      g = 0,  G v + ġ₀ = 0            y = q | v | x | λ | μ
//! ```
//!
//! A is diagonal: 1 for lengths, 1/L² for angles, L the length of the mechanism. Without it the
//! multiplier would move angles and lengths by amounts that depend on the unit of length.
//!
//! Both are recorded from the same equations as the explicit rates. I3 controls the errors of
//! positions only; the second multiplier of SI2, zero but for the error of the method, lets the
//! rows hold in velocity too, and velocities are controlled.
//!
//! Where functions change branch the same is recorded with branches held, as the explicit rates
//! are: a step sees smooth equations, also beyond the end of a branch.
//!
//! Source: Gear, Gupta & Leimkuhler 1985 for SI2.

mod written;

use crate::analysis::system::System;
use crate::analysis::system::closures::Closures;
use crate::diagnostic::{Diagnostic, Error};
use crate::numeric::{Dae, Failure, Kind, Levels, Ode, Relation};
use crate::scalar::Scalar;
use crate::scene::Scene;
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::scene::layout::ImplicitLayout;
use crate::scene::programs::{Switching, held_with, record, record_more, weights};
use written::Written;

/// The levels of the rows that an implicit method sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Formulation {
    /// positions alone
    Index3,
    /// positions, and velocities with a second multiplier
    Stabilized,
}

/// The implicit equations of a scene.
#[derive(Clone, Debug)]
pub struct Implicit {
    formulation: Formulation,
    layout: ImplicitLayout,
    /// with the branch that each state says
    free: Written,
    /// with branches held
    held: Option<Written>,
    /// of the Jacobian, whichever is asked for
    pattern: Vec<(usize, usize)>,
    /// the inputs of the residual: the numbers, then ẏ, λ, μ, then the sides of the switches
    numbers: Vec<f64>,
}

fn residual<S: Scalar>(
    scene: &Scene,
    at: &Equations<'_, S>,
    more: &[S],
    layout: ImplicitLayout,
) -> Vec<S> {
    let [ydot, lambda, mu] = layout.split(more);
    let rows: Vec<_> = (0..scene.rows.len())
        .filter(|&r| at.is_active(r))
        .map(|r| at.row(r))
        .collect();
    let mut v = at.velocities().to_vec();
    let metric = weights(scene);
    let length = scene.length * scene.length;
    for (row, &mu) in rows.iter().zip(mu) {
        for &(k, g) in &row.gradient {
            v[k] += g * mu * S::constant(metric[k] / length);
        }
    }
    let minus = |rates: &[S], values: Vec<S>| -> Vec<S> {
        rates.iter().zip(values).map(|(&a, b)| a - b).collect()
    };
    let rates = layout.numbers.state(ydot);
    let mut out = minus(rates.q, at.position_rates_at(&v));
    out.extend(at.imbalance(rates.v, lambda));
    out.extend(minus(rates.x, at.state_rates()));
    out.extend(rows.iter().map(|row| row.value));
    if layout.has_mu {
        out.extend(rows.iter().map(|row| {
            let along = row.gradient.iter();
            along.fold(row.drift, |s, &(k, g)| s + g * at.velocities()[k])
        }));
    }
    out
}

/// Loops that are named where no method for implicit equations can solve them.
const MOST_NAMED: usize = 3;

impl Implicit {
    /// Records the equations of a scene.
    ///
    /// # Errors
    /// Functions that read what is solved for: their loops are solved beside explicit rates only.
    pub fn new(
        scene: Configured<'_>,
        formulation: Formulation,
        (outside, switching): (&Closures, Option<&Switching>),
    ) -> Result<Self, Vec<Diagnostic>> {
        if !scene.loops.is_empty() {
            let loops = scene.loops.iter().take(MOST_NAMED);
            let loops: Vec<String> = loops.map(|u| u.asker.to_string()).collect();
            let more = match scene.loops.len() - loops.len() {
                0 => String::new(),
                n => format!(" (and each of {n} more)"),
            };
            return Err(vec![Diagnostic::error(
                "implicit_loop",
                format!(
                    "{}{more} reads accelerations or forces that depend on it: methods for implicit equations do not solve that",
                    loops.join(", ")
                ),
            )
            .help("leave the method to the program, or ask for RADAU5")]);
        }
        let layout = ImplicitLayout {
            numbers: scene.layout,
            n_rows: scene.configuration.active_rows().count(),
            has_mu: match formulation {
                Formulation::Index3 => false,
                Formulation::Stabilized => true,
            },
            n_sides: switching.map_or(0, |s| s.switches.n_outputs()),
        };
        let (program, complaints) = record_more(scene, layout.size(), |at, more| {
            residual(&scene, at, more, layout)
        });
        if !complaints.is_empty() {
            return Err(crate::analysis::system::complaints(complaints));
        }
        let multipliers = record(scene, |at| multipliers_at(&scene, at))
            .map_err(crate::analysis::system::complaints)?;
        let free = Written::new(&scene, program, multipliers, layout, outside);
        let held = switching.and_then(|switching| {
            let [residual, multipliers] =
                held_with(scene, switching, layout.size(), |at, more| {
                    [
                        residual(&scene, at, more, layout),
                        multipliers_at(&scene, at),
                    ]
                })?;
            Some(Written::new(&scene, residual, multipliers, layout, outside))
        });
        let mut pattern: Vec<_> = free.pattern().collect();
        pattern.extend(held.iter().flat_map(Written::pattern));
        pattern.sort_unstable_by_key(|&(i, j)| (j, i));
        pattern.dedup();
        let mut implicit = Self {
            formulation,
            layout,
            free,
            held,
            numbers: vec![0.0; layout.row().len()],
            pattern: Vec::new(),
        };
        implicit.free.place_in(&pattern);
        if let Some(held) = &mut implicit.held {
            held.place_in(&pattern);
        }
        implicit.pattern = pattern;
        Ok(implicit)
    }

    /// Returns the levels of the rows that it sees.
    pub fn formulation(&self) -> Formulation {
        self.formulation
    }

    /// Returns the number of unknowns.
    pub fn size(&self) -> usize {
        self.layout.size()
    }

    fn set(&mut self, numbers: &[f64], y: &[f64], ydot: &[f64], sides: &[f64]) {
        self.layout
            .put(&mut self.numbers, numbers, (y, ydot), sides);
    }
}

/// Returns the multipliers of the rows that take part, as the explicit equations have them.
fn multipliers_at<S: Scalar>(scene: &Scene, at: &Equations<'_, S>) -> Vec<S> {
    let solved = at.solved();
    let active = (0..scene.rows.len()).filter(|&r| at.is_active(r));
    active.map(|r| solved.lambda[r]).collect()
}

impl System {
    /// Makes the system an implicit one, too.
    ///
    /// # Errors
    /// Functions that read what is solved for.
    pub fn make_implicit(&mut self, formulation: Formulation) -> Result<(), Error> {
        let implicit = self.recorded.implicit.as_ref();
        if implicit.is_none_or(|i| i.formulation != formulation) {
            let here = self.scene.within(&self.configuration);
            self.recorded.make_implicit(here, formulation)?;
        }
        Ok(())
    }

    /// Returns the number of unknowns of the implicit system: the state, and multipliers.
    pub fn implicit_size(&self) -> usize {
        self.recorded.implicit.as_ref().map_or(0, |i| i.size())
    }

    fn implicit(&self) -> &Implicit {
        match &self.recorded.implicit {
            Some(implicit) => implicit,
            None => unreachable!("make_implicit comes before a method for implicit equations"),
        }
    }
}

impl Dae for System {
    fn size(&self) -> usize {
        self.implicit().size()
    }

    fn residual(&mut self, t: f64, y: &[f64], ydot: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        self.set(t, y);
        let holding = self.recorded.branches.is_holding();
        if let Some(i) = &mut self.recorded.implicit {
            i.set(&self.numbers, y, ydot, self.recorded.branches.sides());
            if let (true, Some(held)) = (holding, &mut i.held) {
                held.residual(&i.numbers, r);
                // beyond its end a branch may have no value
                if r.iter().map(|x| x * 0.0).sum::<f64>() == 0.0 {
                    return Ok(());
                }
            }
            i.free.residual(&i.numbers, r);
        }
        match r.iter().position(|x| !x.is_finite()) {
            Some(what) => Err(Failure {
                what,
                recoverable: true,
            }),
            None => Ok(()),
        }
    }

    fn pattern(&self) -> Vec<(usize, usize)> {
        self.implicit().pattern.clone()
    }

    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        ydot: &[f64],
        cj: f64,
        values: &mut [f64],
    ) -> Result<(), Failure> {
        self.set(t, y);
        let holding = self.recorded.branches.is_holding();
        if let Some(i) = &mut self.recorded.implicit {
            i.set(&self.numbers, y, ydot, self.recorded.branches.sides());
            let written = match (holding, &mut i.held) {
                (true, Some(held)) => held,
                _ => &mut i.free,
            };
            written.derivatives(&i.numbers, cj, &mut self.recorded.external.closures, values);
        }
        Ok(())
    }

    fn consistent(&mut self, t: f64, y: &mut [f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let layout = self.implicit().layout;
        y[layout.multipliers()].fill(0.0);
        ydot.fill(0.0);
        Ode::rate(self, t, &y[layout.y()], &mut ydot[layout.y()])?;
        let holding = self.recorded.branches.is_holding();
        if let Some(i) = &mut self.recorded.implicit {
            i.set(&self.numbers, y, ydot, self.recorded.branches.sides());
            let lambda = &mut y[layout.lambda()];
            if let (true, Some(held)) = (holding, &mut i.held) {
                held.multipliers(&i.numbers, lambda);
                if lambda.iter().all(|x| x.is_finite()) {
                    return Ok(());
                }
            }
            i.free.multipliers(&self.numbers, lambda);
        }
        Ok(())
    }

    fn kinds(&self) -> Vec<Kind> {
        let l = self.scene.layout;
        let mut kinds = vec![Kind::Differential; l.n_y()];
        if self.implicit().formulation == Formulation::Index3 && self.implicit().layout.n_rows > 0 {
            (l.state_mut(&mut kinds).v).fill(Kind::DifferentialUncontrolled);
        }
        kinds.resize(Dae::size(self), Kind::Algebraic);
        kinds
    }

    fn levels(&self) -> Levels {
        let l = self.scene.layout;
        let m = self.implicit().layout.n_rows;
        let (mut rows, mut unknowns) = (vec![1; l.n_y()], vec![0; l.n_y()]);
        l.state_mut(&mut rows).v.fill(2);
        l.state_mut(&mut unknowns).v.fill(1);
        rows.resize(rows.len() + m, 0);
        unknowns.resize(unknowns.len() + m, 2);
        if self.implicit().formulation == Formulation::Stabilized {
            rows.resize(rows.len() + m, 1);
            unknowns.resize(unknowns.len() + m, 1);
        }
        Levels { rows, unknowns }
    }

    fn typical(&self, typical: &mut [f64]) {
        typical.fill(1.0);
        Ode::typical(self, &mut typical[self.implicit().layout.y()]);
    }

    fn relations(&self, relations: &mut [Relation]) {
        Ode::relations(self, &mut relations[self.implicit().layout.y()]);
    }
}
