//! A scene as ẏ = f(t, y): what methods for ordinary differential equations see.
//!
//! Within a step the rows hold at acceleration level. Near a position where they become dependent,
//! violations are magnified by 1/σ, σ² the weakest pivot: there a stage is put onto the rows before
//! it is evaluated, where that is felt. Each accepted step is projected back onto the rows.

use super::System;
use super::recording::Recording;
use super::rows::ROUNDING;
use super::singular_step::APPROACHING_PIVOT;
use crate::numeric::pattern::Pattern;
use crate::numeric::{Failure, Ode, Relation};
use crate::scene::Source;
use crate::scene::solve::NEAR_SINGULAR_PIVOT;
use std::sync::Arc;

/// Error of the rates that weak rows magnify, at most, as a part of the permitted local error.
const MAGNIFIED_ERROR: f64 = 1e-3;
/// Rounding of the rates where the strength of the rows is one, over the part of the permitted
/// local error that it may be: a pivot σ² is rounded like one of size one, so that rates are off by
/// rounding/σ².
const ROUNDING_OF_RATES: f64 = 1e-13;
/// Part of the largest angle (or length) that a small one is measured against: measured, chains of
/// 160 links take a fifth fewer steps and are still a thousand times more exact than asked for.
const SHARE_OF_LARGEST_POSITION: f64 = 0.1;
/// The same for speeds, which may differ more: a wheel on a slow arm.
const SHARE_OF_LARGEST_SPEED: f64 = 0.02;
/// Iterations of a projection, at most.
const MAX_PROJECTIONS: usize = 8;
/// Change of positions, rad or parts of the length of the scene, at which a projection has
/// converged.
const PROJECTED: f64 = 1e-11;
/// Change of positions, rad or parts of the length of the scene, that no velocity on the rows
/// feels.
const ROUNDING_OF_POSITION: f64 = 1e-15;
/// The same as [`PROJECTED`] where rows have nearly been dependent: the last digits along them are
/// noise.
const PROJECTED_WEAKLY: f64 = 1e-9;
/// Change of velocities, over the permitted local error, beyond which putting a state onto rows
/// that have nearly been dependent is no correction but a jump: it would take energy away.
const JUMP: f64 = 100.0;
/// Least and largest such change, as parts of the largest velocity.
const JUMP_BOUNDS: [f64; 2] = [1e-6, 0.05];
/// Change at the first iteration, at most, of a state that was on the rows.
const ON_ROWS: f64 = 10.0 * ROUNDING;

impl System {
    /// Puts the stage `y` of a step onto weak rows and evaluates it anew, where violations would be
    /// felt. Given are its rates, how strong the rows are, and whether the rates are finite;
    /// returns whether they are now.
    fn evaluate_weak(
        &mut self,
        t: f64,
        y: &[f64],
        (ydot, mut strength, mut finite): (&mut [f64], f64, bool),
    ) -> bool {
        self.recorded.rows.were_weak |= !self.singular_steps.is_paused();
        let square = strength.max(0.0);
        let permitted = (MAGNIFIED_ERROR * self.precision * square.sqrt()).max(ROUNDING);
        let violation = self.worst_violation();
        if violation.is_nan() || violation > permitted {
            let mut stage = std::mem::take(&mut self.stage);
            stage.clear();
            stage.extend_from_slice(y);
            if self.put_on_rows(t, &mut stage).is_ok() {
                self.set(t, &stage);
                (strength, finite) = self.recorded.rates_at(&self.numbers, ydot);
            }
            self.stage = stage;
        }
        self.singular_steps.see(t, strength);
        finite
    }

    /// Returns the largest violation of a row at the present numbers.
    fn worst_violation(&mut self) -> f64 {
        let v = &self.numbers[self.scene.layout.v()];
        self.recorded.rows.worst_violation(&self.numbers, v)
    }

    /// Puts a state onto the rows that take part, by least changes; returns whether it changed.
    ///
    /// # Errors
    /// No state on the rows is near.
    pub fn put_on_rows(&mut self, t: f64, y: &mut [f64]) -> Result<bool, Failure> {
        self.recorded.rows.last_change = 0.0;
        let changed = self.mover.normalize(self.scene.layout.state_mut(y).q);
        if self.recorded.rows.clean {
            self.set(t, y);
            if self.worst_violation() <= ROUNDING {
                return Ok(changed);
            }
        }
        // taken out, as loops and closures are solved for on the way
        let Some(mut projection) = self.recorded.rows.projection.take() else {
            return Ok(changed);
        };
        let outcome = self.iterate_onto_rows(&mut projection, t, y);
        self.recorded.rows.projection = Some(projection);
        outcome
    }

    /// Puts a state onto the rows as [`put_on_rows`](Self::put_on_rows) does, with velocities as
    /// exact as positions: an iteration corrects them before its displacement.
    ///
    /// # Errors
    /// No state on the rows is near.
    pub fn put_on_rows_exactly(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        self.put_on_rows(t, y)?;
        if self.recorded.rows.last_change > ROUNDING_OF_POSITION {
            self.put_on_rows(t, y)?;
        }
        Ok(())
    }

    /// Lets the next projection depend on nothing that was projected before.
    pub fn project_anew(&mut self) {
        self.recorded.rows.clean = false;
    }

    /// Returns whether a velocity changes between two states by more than a projection may.
    fn jumped(&self, from: &[f64], to: &[f64]) -> bool {
        let l = self.scene.layout;
        let scales = &self.recorded.rows.scales;
        let (from, to) = (l.state(from).v, l.state(to).v);
        let speeds = from.iter().zip(scales).map(|(v, s)| v.abs() * s);
        let largest = speeds.fold(0.0, f64::max);
        let permitted = (JUMP * self.precision).clamp(JUMP_BOUNDS[0], JUMP_BOUNDS[1]) * largest;
        let changes = from.iter().zip(to).zip(scales);
        let mut sizes = changes.map(|((a, b), s)| (b - a).abs() * s);
        sizes.any(|size| size > permitted)
    }

    /// Iterates least changes until a state is on the rows.
    fn iterate_onto_rows(
        &mut self,
        projection: &mut Recording,
        t: f64,
        y: &mut [f64],
    ) -> Result<bool, Failure> {
        let l = self.scene.layout;
        let (mut first, mut last) = (None, f64::INFINITY);
        let mut outcome = Err(Failure {
            what: 0,
            recoverable: true,
        });
        for _ in 0..MAX_PROJECTIONS {
            self.set(t, y);
            let change = l.change(projection.run(&self.numbers));
            let scales = &self.recorded.rows.scales;
            let sizes = change.q.iter().zip(scales).map(|(x, s)| x.abs() * s);
            let largest = |m: f64, x: f64| if x.is_nan() { x } else { f64::max(m, x) };
            let mut size = sizes.fold(0.0, largest);
            if self.recorded.rows.of_velocities {
                let speeds = l.state(y).v.iter().zip(scales);
                let fastest = speeds.map(|(v, s)| v.abs() * s).fold(1.0, f64::max);
                let sizes = change.v.iter().zip(scales);
                size = sizes
                    .map(|(x, s)| x.abs() * s / fastest)
                    .fold(size, largest);
            }
            if !size.is_finite() || size > 2.0 * last {
                break;
            }
            last = size;
            first.get_or_insert(size);
            let state = l.state_mut(y);
            for (v, d) in state.v.iter_mut().zip(change.v) {
                *v += d;
            }
            for (&place, d) in self.recorded.rows.contacts.iter().zip(change.x) {
                state.x[place] += d;
            }
            if size > 0.0 {
                self.mover.displace(state.q, change.q);
            }
            // the velocities were corrected with the gradient before this displacement
            if size < PROJECTED {
                outcome = Ok(true);
                break;
            }
        }
        let rows = &mut self.recorded.rows;
        rows.last_change = last;
        if rows.were_weak && last < PROJECTED_WEAKLY {
            outcome = Ok(true);
        }
        // where a mechanism keeps its rows by itself, looking at them is cheaper
        rows.clean = rows.contacts.is_empty() && first.is_some_and(|size| size < ON_ROWS);
        outcome
    }
}

impl Ode for System {
    fn size(&self) -> usize {
        self.scene.layout.n_y()
    }

    fn rate(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.set(t, y);
        if let Some(k) = self.unsolved {
            return Err(Failure {
                what: y.len() + k,
                recoverable: true,
            });
        }
        let ydot = &mut ydot[..self.scene.layout.n_y()];
        let (strength, mut finite) = self.recorded.rates_at(&self.numbers, ydot);
        if strength < APPROACHING_PIVOT && self.recorded.rows.projection.is_some() {
            self.singular_steps.see_approach(t, strength);
            if strength < NEAR_SINGULAR_PIVOT {
                finite = self.evaluate_weak(t, y, (ydot, strength, finite));
            }
        }
        if finite {
            return Ok(());
        }
        let what = ydot.iter().position(|x| !x.is_finite()).unwrap_or(0);
        Err(Failure {
            what,
            recoverable: true,
        })
    }

    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<bool, Failure> {
        if !self.recorded.rows.were_weak {
            return self.put_on_rows(t, y);
        }
        let mut before = std::mem::take(&mut self.stage);
        before.clear();
        before.extend_from_slice(y);
        let outcome = self.put_on_rows(t, y);
        let jumped = self.jumped(&before, y);
        self.stage = before;
        if jumped {
            let (what, recoverable) = (0, true);
            return Err(Failure { what, recoverable });
        }
        outcome
    }

    fn filter_errors(&mut self, t: f64, y: &[f64], errors: [&mut [f64]; 2]) -> bool {
        let rows = &mut self.recorded.rows;
        // what an equation of velocities forbids is no error of a position alone
        let filters = rows.were_weak && !rows.of_velocities;
        let (true, Some(projection)) = (filters, &mut rows.projection) else {
            return false;
        };
        // Δv(v) = −W Gᵀ (G W Gᵀ)⁻¹ (G v + ġ₀): its part linear in v takes away all that is normal
        // to the rows
        let (l, mover) = (self.scene.layout, &self.mover);
        let n_v = l.n_v;
        let q = l.state(y).q;
        l.set_state(&mut self.numbers, t, y);
        let mut normal = |v: &[f64], out: &mut [f64]| {
            self.numbers[l.v()].copy_from_slice(v);
            out.copy_from_slice(l.change(projection.run(&self.numbers)).v);
        };
        let mut tangent = vec![0.0; n_v];
        let [mut none, mut change] = [tangent.clone(), tangent.clone()];
        normal(&tangent, &mut none);
        for error in errors {
            let error = l.state_mut(error);
            mover.find_tangent(q, error.q, &mut tangent);
            normal(&tangent, &mut change);
            let changes = change.iter().zip(&none);
            (tangent.iter_mut().zip(changes)).for_each(|(v, (d, none))| *v = *v + d - none);
            mover.untangent(q, &tangent, error.q);
            normal(error.v, &mut change);
            let changes = change.iter().zip(&none);
            (error.v.iter_mut().zip(changes)).for_each(|(v, (d, none))| *v += d - none);
        }
        true
    }

    fn place_step(&mut self, t: f64, h: f64, gap: [f64; 2], failed: bool) -> Option<f64> {
        let harmful = match failed {
            true => NEAR_SINGULAR_PIVOT,
            false => (ROUNDING_OF_RATES / self.precision).min(NEAR_SINGULAR_PIVOT),
        };
        self.singular_steps.place(t, h, gap, harmful)
    }

    fn is_noisy(&self) -> bool {
        self.is_weak()
    }

    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        jacobian: &mut [f64],
        dfdt: &mut [f64],
    ) -> Result<(), Failure> {
        self.set(t, y);
        self.full_jacobian(y.len(), jacobian, dfdt)
    }

    fn pattern(&mut self) -> Option<Arc<Pattern>> {
        self.jacobian_pattern()
    }

    fn jacobian_entries(&mut self, t: f64, y: &[f64], entries: &mut [f64]) -> Result<(), Failure> {
        self.set(t, y);
        self.jacobian_by_groups(entries)
    }

    fn typical(&self, typical: &mut [f64]) {
        typical.fill(1.0);
        let typical = self.scene.layout.state_mut(typical);
        for (c, f) in self.scene.coordinates.iter().zip(&self.scene.freedoms) {
            if let Source::Free { q, v } = c.source
                && !c.angular
                && !f.in_ball
            {
                let size = self.scene.memberships[c.link].size;
                (typical.q[q], typical.v[v]) = (size, size);
            }
        }
    }

    fn relations(&self, relations: &mut [Relation]) {
        let relations = self.scene.layout.state_mut(relations);
        for (c, f) in self.scene.coordinates.iter().zip(&self.scene.freedoms) {
            let Source::Free { q, v } = c.source else {
                continue;
            };
            // angles and lengths, of places and of velocities
            let kind = 4 * self.scene.memberships[c.link].group + u32::from(c.angular);
            if !f.in_ball {
                relations.q[q] = Relation {
                    most: if c.angular {
                        std::f64::consts::PI
                    } else {
                        f64::INFINITY
                    },
                    group: Some(kind),
                    share: SHARE_OF_LARGEST_POSITION,
                    from_beginning: !c.angular,
                    ..Relation::default()
                };
            }
            // short steps because of a contact have to be seen in velocity
            let smooth =
                self.recorded.branches.is_empty() && self.recorded.peaks.is_empty() && !f.in_ball;
            relations.v[v] = Relation {
                group: Some(2 + kind),
                share: SHARE_OF_LARGEST_SPEED,
                rate_of: smooth.then_some(q),
                is_rate: true,
                ..Relation::default()
            };
        }
    }
}
