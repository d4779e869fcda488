//! Where a program may break because of what depends on time alone: at times that are known before
//! anything else is.

use super::breaks::{Break, Levels};
use super::builder::Builder;
use super::expand::Expand;
use super::hashing::HashMap;
use super::input::Input;
use super::node::{Node, Value};

/// Most knots of a table that was drawn by hand.
const FEW: usize = 64;

impl Builder {
    /// Values that depend on `time` alone, and are not looked up in a table, at whose levels some
    /// outputs may break. Calls are expanded; tables of many knots are left out.
    pub(crate) fn timed_breaks(&mut self, outputs: &[Value], time: Input) -> Vec<Break> {
        if self.are_untimed_by_tape(outputs) {
            return Vec::new();
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
        let timed = self.dependent_on(time);
        let none = (0..n).all(|k| !(needed[k] && timed[k]));
        if none && outputs == asked && self.nodes.len() == before {
            // whatever the numbers are
            self.keep_untimed(asked);
            return Vec::new();
        }
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
        breaks
    }

    /// Returns which values are made of one input and of constants, without tables.
    fn dependent_on(&self, input: Input) -> Vec<bool> {
        // none: a constant
        let mut only: Vec<Option<bool>> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let mut all = None;
            match *node {
                Node::Input(k) => all = Some(self.inputs[k as usize] == input),
                Node::Lookup { .. } => all = Some(false),
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
    /// Returns whether they are the knots of a table of more than a few points: measured data,
    /// which no step need heed one by one.
    fn are_many(&self) -> bool {
        matches!(self, Levels::Knots(table) if table.knots().len() > FEW)
    }
}
