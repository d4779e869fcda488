//! Selections by jumps: what only one side needs is computed only where that side is taken.
//!
//! Selections by the same condition share their sides. A value of a side goes where the selection
//! has its result as soon as it is computed; only what was there before (an input, a constant, a
//! value with other users) is copied.

use super::super::super::code::{Code, Instruction, Mark};
use super::super::super::operation::Comparison;
use super::super::steps::Step;
use super::{Lowering, Open};

impl Lowering<'_> {
    /// Lets the jump of a step lead to the next step; `side` is that of a branch.
    pub(super) fn lands(&mut self, step: usize, side: u8) {
        let here = self.steps.len() as u32;
        match &mut self.steps[step] {
            Step::Unless { target, .. } | Step::Go { target } => *target = here,
            Step::Branch {
                negative,
                zero,
                positive,
                ..
            } => match side {
                0 => *negative = here,
                1 => *zero = here,
                _ => *positive = here,
            },
            step => unreachable!("{step:?} is no jump"),
        }
    }

    /// Begins or ends a side of some selections.
    pub(super) fn mark(&mut self, mark: Mark, end_of_side: u32) {
        if mark.is_end {
            return self.end(mark);
        }
        if mark.side == 0 {
            self.open(mark.group);
        } else if let Some(branch) = self.open.last().map(|open| open.branch) {
            self.lands(branch, mark.side);
        }
        // what is computed here for one of the selections alone goes where that has its result
        for member in self.core.sides.groups[mark.group as usize].clone() {
            let to = self.results.to[self.core.sides.members[member] as usize];
            let chosen = &mut self.results.chosen[member][mark.side as usize];
            if let Some(x) = *chosen
                && (mark.at..end_of_side).contains(&x)
                && self.results.n_reads[x as usize] == 1
            {
                self.results.to[x as usize] = to;
            } else {
                *chosen = None;
            }
        }
    }

    /// Begins a group: emits the jump to its sides.
    fn open(&mut self, group: u32) {
        let core = self.core;
        let members = &core.sides.members[core.sides.groups[group as usize].clone()];
        let Instruction { code, a, b, .. } = core.code[members[0] as usize];
        let zero = self.constant(0.0);
        let branch = self.steps.len();
        self.steps.push(match code {
            Code::CompareSelect(comparison) => Step::Unless {
                comparison,
                a,
                b,
                target: 0,
            },
            Code::If => Step::Branch {
                selector: a,
                negative: 0,
                zero: 0,
                positive: 0,
            },
            _ => Step::Unless {
                comparison: Comparison::Lt,
                a: zero,
                b: a,
                target: 0,
            },
        });
        let mut exits = Vec::new();
        if code == Code::If {
            // where the selector is no number, no value is one
            let from = self.constant(f64::NAN);
            for &member in members {
                let to = self.results.to[member as usize];
                self.steps.push(Step::Copy { from, to });
            }
            exits.push(self.steps.len());
            self.steps.push(Step::Go { target: 0 });
            self.lands(branch, 0);
        }
        self.open.push(Open {
            group,
            branch,
            exits,
        });
    }

    /// Ends a side: copies the values that are not where the selections have their results, and
    /// leaves.
    fn end(&mut self, mark: Mark) {
        let core = self.core;
        let range = core.sides.groups[mark.group as usize].clone();
        let first = self.steps.len();
        for member in range.clone() {
            if self.results.chosen[member][mark.side as usize].is_none() {
                let instruction = core.sides.members[member] as usize;
                let from = core.code[instruction].chosen(mark.side);
                let to = self.results.to[instruction];
                self.steps.push(Step::Copy { from, to });
            }
        }
        let Some(mut open) = self.open.pop() else {
            return;
        };
        debug_assert_eq!(open.group, mark.group, "sides are nested");
        let (exits, end) = std::mem::take(&mut self.closed);
        if end == self.steps.len() && end == first {
            // what leaves an inner selection here has nothing left to do
            open.exits.extend(exits);
        }
        let instruction = core.code[core.sides.members[range.start] as usize];
        if mark.side + 1 < instruction.n_sides() {
            open.exits.push(self.steps.len());
            self.steps.push(Step::Go { target: 0 });
            self.open.push(open);
            return;
        }
        for &exit in &open.exits {
            self.lands(exit, 0);
        }
        self.closed = (open.exits, self.steps.len());
    }
}
