//! Rows during a leg: those that are left out are watched, and others are chosen where that is
//! better.

use crate::analysis::system::System;
use crate::analysis::time::leg::{Finished, Leg};
use crate::analysis::time::ranks::{self, Judgement, Sides};
use crate::analysis::time::states::Node;
use crate::numeric::{Failure, Method, Reason, Step, Stop};
use crate::scene::layout::Layout;

/// Violation of a row that is left out, relative to what counts as one, up to which it follows from
/// the others.
const FOLLOWS_TOLERANCE: f64 = 1e-8;
/// The same, beyond which a step is shortened.
const STEP_TOLERANCE: f64 = 1e-6;
/// Halvings of a step because of rows that are left out, in a row.
const MAX_HALVINGS: usize = 40;
/// Turn of the fastest angle in a step, rad, from which on no evaluation need be near a position
/// where rows are dependent that it has passed.
const LONG_TURN: f64 = 1.0;
/// Turn of the fastest angle, rad, in which rows do not become dependent twice.
const TURN_OF_PIECE: f64 = 1.0;
/// Pieces in which a step is looked at, at most.
const MAX_PIECES: f64 = 64.0;
/// Time to a position where rows are dependent, as a part of the duration, that counts as none.
const STANDING_TIME: f64 = 1e-6;
/// Velocities of the largest mechanism all of whose states are kept to find positions where rows
/// become dependent.
const SMALL_MECHANISM: usize = 30;

impl Leg<'_> {
    /// Returns the row among those left out that no longer follows from the others, and its value.
    pub(super) fn violated(
        &mut self,
        method: &dyn Method<System>,
        step: &Step,
    ) -> Option<(usize, f64)> {
        let worst = self.system.worst_left_out(step.t1, method.y());
        worst.filter(|w| w.1.is_nan() || w.1 > FOLLOWS_TOLERANCE)
    }

    /// Returns whether a step leads beyond a position where the others leave two ways and this row
    /// one, and can be shortened.
    pub(super) fn shortens(&self, violated: Option<(usize, f64)>, step: &Step) -> bool {
        violated.is_some_and(|(_, size)| size > STEP_TOLERANCE)
            && step.t1 - step.t0 > 1e-12 * self.limits.end.abs().max(step.t1.abs())
            && self.halved < MAX_HALVINGS
    }

    /// Returns whether a step leads to another branch that only comes near the present one, or to
    /// a position where branches meet, from which rounding would choose one. Evaluations of rates
    /// notice where rows are, or between them may have been, nearly dependent.
    pub(super) fn leaves_branch(&mut self, method: &mut dyn Method<System>, step: &Step) -> bool {
        if self.before.is_empty() {
            return false;
        }
        let near = self.system.was_near_dependence();
        if !near && self.system.fastest_angle(method.y(), |_| true) * step.h <= LONG_TURN {
            return false;
        }
        if self.sides.is_none() {
            self.sides = Sides::new(self.system);
        }
        let Some(mut sides) = self.sides.take() else {
            return false;
        };
        let in_loop = |v: usize| sides.coordinates().any(|places| places.contains(&v));
        let turn = self.system.fastest_angle(method.y(), in_loop) * step.h;
        if !near && turn <= LONG_TURN {
            self.sides = Some(sides);
            return false;
        }
        let (mut nodes, mut looks) = (Vec::new(), Vec::new());
        let (pieces, t1) = (self.pieces(method, step, turn), step.t1);
        for (k, mut node) in pieces.into_iter().enumerate() {
            // the last look, if that was where this step begins
            let last = self.last_look.take().filter(|(there, _)| *there == node);
            let mut side = match last {
                Some((_, side)) => side,
                None => sides.look(&self.system.numbers_at(node.t, &node.y)),
            };
            // off the rows it may be beside both branches
            if k > 0 && node.t < t1 && sides.are_near(&side) {
                self.system.project_anew();
                if self.system.put_on_rows(node.t, &mut node.y).is_err() {
                    continue;
                }
                side = sides.look(&self.system.numbers_at(node.t, &node.y));
            }
            nodes.push(node);
            looks.push(side);
        }
        let patience = STANDING_TIME * (self.limits.end - self.limits.start);
        let leaves = nodes.windows(2).zip(looks.windows(2)).any(|(ends, looks)| {
            let ([a, b], [from, to]) = (ends, looks) else {
                return false;
            };
            let turned = Sides::turned(from, to);
            match turned.is_empty() {
                true => sides.stands([from, to], [a.t, b.t], patience),
                false => !sides.meet(self.system, &turned, [(a, from), (b, to)]),
            }
        });
        self.sides = Some(sides);
        self.last_look = nodes.pop().zip(looks.pop());
        leaves
    }

    /// Returns the ends of a step in which the fastest angle turns by `turn` rad, and states
    /// between them from one to the next of which rows cannot turn twice.
    fn pieces(&mut self, method: &mut dyn Method<System>, step: &Step, turn: f64) -> Vec<Node> {
        let l = self.system.scene.layout;
        let node = |t: f64, y: &[f64]| Node {
            t,
            y: l.upstream(y).to_vec(),
        };
        let pieces = (turn / TURN_OF_PIECE).ceil().clamp(1.0, MAX_PIECES) as usize;
        let mut nodes = vec![node(step.t0, &self.before)];
        let mut between = method.y().to_vec();
        for k in 1..pieces {
            let t = step.t0 + (step.t1 - step.t0) * k as f64 / pieces as f64;
            if (method.interpolate(self.system, t, &mut between)).is_ok() {
                nodes.push(node(t, &between));
            }
        }
        nodes.push(node(step.t1, method.y()));
        nodes
    }

    /// Makes the next step half as long as one that has left its branch.
    pub(super) fn go_nearer(&mut self, step: &Step) -> Result<(), Finished> {
        if self.halved >= MAX_HALVINGS {
            let (what, recoverable) = (0, false);
            let reason = Reason::Projection(Failure { what, recoverable });
            let (t, h) = (step.t0, step.t1 - step.t0);
            return Err(Stop { reason, t, h }.into());
        }
        self.halved += 1;
        self.landing = step.t0 + 0.5 * (step.t1 - step.t0);
        Ok(())
    }

    /// Makes the next step half as long as the one that was undone, or begins with better rows.
    pub(super) fn halve(&mut self, step: &Step) -> Result<(), Finished> {
        self.halved += 1;
        let before = std::mem::take(&mut self.before);
        if self.choose(step.t0, &before) {
            return Err(Finished::Rows(before));
        }
        self.before = before;
        self.landing = step.t0 + 0.5 * (step.t1 - step.t0);
        Ok(())
    }

    /// Looks after the rows at the end of an accepted step: notes where they are nearly dependent,
    /// chooses others, restores one that no longer follows.
    pub(super) fn keep_rows(
        &mut self,
        method: &dyn Method<System>,
        step: &Step,
        violated: Option<(usize, f64)>,
    ) -> Result<(), Finished> {
        if let Some(beyond) = self.system.worst_loose(step.t1, method.y()) {
            self.out.note_beyond(step.t1, beyond);
        }
        if self.before.is_empty() {
            return Ok(());
        }
        let weak = self.system.take_weak();
        self.note_weak(method, step.t0, weak);
        if let Some((row, _)) = violated {
            return Err(self.restore(row, method, step.t0));
        }
        let (t, y) = (method.t(), method.y());
        let is_open = weak && self.system.watches_rows() && !self.system.has_right_rows(t, y);
        if is_open && self.choose(t, y) {
            return Err(Finished::Rows(y.to_vec()));
        }
        Ok(())
    }

    /// Keeps the states of a step for the search for positions where rows become dependent: all of
    /// small mechanisms, else those where an evaluation has found rows nearly dependent.
    fn note_weak(&mut self, method: &dyn Method<System>, t0: f64, weak: bool) {
        let n_v = self.system.scene.layout.n_v;
        let kept = &mut self.out.weak;
        if kept.len() >= ranks::states_kept(n_v) as usize || !(weak || n_v <= SMALL_MECHANISM) {
            return;
        }
        let last = kept.last().and_then(Option::as_ref);
        if !last.is_some_and(|n| n[Layout::TIME] == t0) {
            kept.push(None);
            kept.push(Some(self.system.numbers_at(t0, &self.before)));
        }
        kept.push(Some(self.system.numbers_at(method.t(), method.y())));
    }

    /// Puts the state onto all rows, one of which no longer follows from the others.
    fn restore(&mut self, row: usize, method: &dyn Method<System>, t0: f64) -> Finished {
        let l = self.system.scene.layout;
        let t = method.t();
        let mut numbers = self.system.numbers_at(t, method.y());
        if !ranks::repair(self.system.configured(), &mut numbers) {
            let what = Failure {
                what: row,
                recoverable: false,
            };
            let (reason, h) = (Reason::Projection(what), t - t0);
            return Stop { reason, t, h }.into();
        }
        self.out.restored.push((t, row));
        let y = numbers[l.y()].to_vec();
        self.choose(t, &y);
        Finished::Rows(y)
    }

    /// Chooses other rows where they are better; whether it did.
    fn choose(&mut self, t: f64, y: &[f64]) -> bool {
        let l = self.system.scene.layout;
        l.set_state(&mut self.system.numbers, t, y);
        let active = match ranks::better_rows(self.system.configured(), &self.system.numbers) {
            Judgement::Better(active) => active,
            Judgement::Right(least) => {
                self.system.note_right_rows(least);
                return false;
            }
        };
        let chosen = (self.out.t.len(), t, active.clone());
        if self.system.reselect(active).is_err() {
            return false;
        }
        self.out.selections.push(chosen);
        true
    }
}
