//! The parts of a program that depend on time alone: where it may break because of them, at times
//! that are known before anything else is; and its clocks, through which time acts on what depends
//! on more.

use super::breaks::{Break, Levels};
use super::builder::Builder;
use super::expand::Expand;
use super::hashing::HashMap;
use super::input::Input;
use super::node::{Node, Value};
use std::collections::BTreeSet;

/// Most knots of a table that was drawn by hand.
const FEW: usize = 64;

/// Values of some outputs that depend on time alone.
#[derive(Debug, Default)]
pub(crate) struct Timed {
    /// values, not looked up in a table, at whose levels the outputs may break
    pub breaks: Vec<Break>,
    /// values through which time acts on the outputs, but for time itself: as long as each of them
    /// rises or falls, time acts as a state does
    pub clocks: Vec<Value>,
}

impl Builder {
    /// Returns what of some outputs depends on `time` alone. Calls are expanded; breaks at the
    /// knots of tables that have many are left out.
    pub(crate) fn timed(&mut self, outputs: &[Value], time: Input) -> Timed {
        if self.are_untimed_by_tape(outputs) {
            return Timed::default();
        }
        let asked = outputs;
        let before = self.nodes.len();
        let outputs = self.expanded(asked, Expand::Calls);
        let n = outputs.iter().map(|v| v.index() + 1).max().unwrap_or(0);
        let mut needed = vec![false; n];
        for v in &outputs {
            needed[v.index()] = true;
        }
        let mut found = Vec::new();
        for k in (0..n).rev() {
            if needed[k] {
                let node = self.nodes[k];
                self.operands(&node, |v| needed[v.index()] = true);
                self.breaks_of(&node, &mut found);
            }
        }
        let [timed, looked_up] = [false, true].map(|tables| self.dependent_on(time, tables));
        let none = (0..n).all(|k| !(needed[k] && looked_up[k]));
        if none && outputs == asked && self.nodes.len() == before {
            // whatever the numbers are
            self.keep_untimed(asked);
            return Timed::default();
        }
        let clocks = self.clocks(&outputs, &needed, &looked_up);
        found.retain(|b| timed[b.value.index()] && !b.levels.are_many());
        let mut breaks: Vec<Break> = Vec::new();
        let mut places: HashMap<Value, Vec<usize>> = HashMap::default();
        for b in found.into_iter().rev() {
            let known = places.entry(b.value).or_default();
            if !known.iter().any(|&k| breaks[k].levels.are(&b.levels)) {
                known.push(breaks.len());
                breaks.push(b);
            }
        }
        Timed { breaks, clocks }
    }

    /// Returns the values of time alone that others read, or that are outputs.
    fn clocks(&self, outputs: &[Value], needed: &[bool], timed: &[bool]) -> Vec<Value> {
        let is_clock = |v: Value| {
            let node = &self.nodes[v.index()];
            timed[v.index()] && !matches!(node, Node::Input(_) | Node::Compare(..))
        };
        let mut clocks: BTreeSet<Value> =
            outputs.iter().copied().filter(|&v| is_clock(v)).collect();
        for k in (0..needed.len()).filter(|&k| needed[k] && !timed[k]) {
            self.operands(&self.nodes[k], |v| {
                if is_clock(v) {
                    clocks.insert(v);
                }
            });
        }
        clocks.into_iter().collect()
    }

    /// Returns which values are made of one input and of constants; `tables`: also by tables.
    fn dependent_on(&self, input: Input, tables: bool) -> Vec<bool> {
        // none: a constant
        let mut only: Vec<Option<bool>> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let mut all = None;
            match *node {
                Node::Input(k) => all = Some(self.inputs[k as usize] == input),
                Node::Lookup { .. } if !tables => all = Some(false),
                _ => self.operands(node, |v| {
                    if let Some(one) = only[v.index()] {
                        all = Some(one && all != Some(false));
                    }
                }),
            }
            only.push(all);
        }
        only.into_iter().map(|all| all == Some(true)).collect()
    }
}

impl Levels {
    /// Returns whether they are the knots of a smooth table of more than a few points: measured
    /// data, which no step need heed one by one.
    fn are_many(&self) -> bool {
        matches!(self, Levels::Knots(table) if table.knots().len() > FEW && !table.is_sharp())
    }
}
