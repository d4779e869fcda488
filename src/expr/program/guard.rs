//! Under which conditions a node is needed: the sides of selections that all its users lie on.
//!
//! A node that is used only for one side of an IF need not be computed where the other side is
//! taken, and its derivatives must not be counted there. Guards form a tree; that of a node is the
//! nearest common ancestor of the guards of its uses. Selections by the same condition under the
//! same guard share their sides.

use super::builder::Builder;
use super::hashing::HashMap;
use super::node::{Node, Value};

/// Index into [`Guards`]; [`ALWAYS`] is the root.
pub(super) type GuardIx = u32;

/// The guard of what is needed in any case.
pub(super) const ALWAYS: GuardIx = 0;

/// The guard of what is not needed at all.
pub(super) const NEVER: GuardIx = u32::MAX;

/// One side of a selection, inside another guard.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guard {
    pub(super) parent: GuardIx,
    depth: u32,
    /// a selection (`Select` or `If`) by the condition
    pub(super) selection: Value,
    /// `Select`: 0 yes, 1 no; `If`: 0 negative, 1 zero, 2 positive
    pub(super) side: u8,
}

/// The guards of all nodes with respect to some outputs.
#[derive(Debug)]
pub(super) struct Guards {
    pub(super) tree: Vec<Guard>,
    pub(super) of: Vec<GuardIx>,
    /// guards of the sides of each selection: that of side 0; the others follow
    sides: Vec<GuardIx>,
    /// the same by guard, condition and number of sides
    by_condition: HashMap<(GuardIx, Value, usize), GuardIx>,
}

impl Guards {
    /// Finds the guards of the needed nodes of a builder; nothing that is not needed gets a guard.
    pub(super) fn new(builder: &Builder, outputs: &[Value]) -> Self {
        let n = outputs.iter().map(|v| v.index() + 1).max().unwrap_or(0);
        let root = Guard {
            parent: ALWAYS,
            depth: 0,
            selection: Value(0),
            side: 0,
        };
        let mut guards = Guards {
            tree: vec![root],
            of: vec![NEVER; builder.nodes.len()],
            sides: vec![NEVER; n],
            by_condition: HashMap::default(),
        };
        for output in outputs {
            guards.of[output.index()] = ALWAYS;
        }
        for k in (0..n).rev() {
            let here = guards.of[k];
            if here == NEVER {
                continue;
            }
            match builder.nodes[k] {
                Node::Select(condition, yes, no) => {
                    guards.need(condition, here);
                    guards.open(Value(k as u32), condition, here, &[yes, no]);
                }
                node @ Node::If(_) => {
                    let list = node.list().unwrap_or(0..0);
                    if let &[selector, ref sides @ ..] = &builder.arguments[list] {
                        guards.need(selector, here);
                        guards.open(Value(k as u32), selector, here, sides);
                    }
                }
                node => builder.operands(&node, |v| guards.need(v, here)),
            }
        }
        guards
    }

    /// Returns the guard of one side of a needed selection.
    pub(super) fn side(&self, selection: Value, side: u8) -> GuardIx {
        self.sides[selection.index()] + u32::from(side)
    }

    fn open(&mut self, selection: Value, condition: Value, parent: GuardIx, operands: &[Value]) {
        let next = self.tree.len() as u32;
        let first = *self
            .by_condition
            .entry((parent, condition, operands.len()))
            .or_insert(next);
        self.sides[selection.index()] = first;
        if first == next {
            let depth = self.tree[parent as usize].depth + 1;
            self.tree
                .extend((0u8..).zip(operands).map(|(side, _)| Guard {
                    parent,
                    depth,
                    selection,
                    side,
                }));
        }
        for (side, &v) in (0u8..).zip(operands) {
            self.need(v, self.side(selection, side));
        }
    }

    /// Returns whether `inner` is `outer` or lies inside it.
    pub(super) fn is_within(&self, mut inner: GuardIx, outer: GuardIx) -> bool {
        if inner == NEVER {
            return false;
        }
        while self.tree[inner as usize].depth > self.tree[outer as usize].depth {
            inner = self.tree[inner as usize].parent;
        }
        inner == outer
    }

    fn need(&mut self, v: Value, guard: GuardIx) {
        let before = self.of[v.index()];
        self.of[v.index()] = if before == NEVER {
            guard
        } else {
            self.common(before, guard)
        };
    }

    /// Returns the nearest common ancestor.
    fn common(&self, mut a: GuardIx, mut b: GuardIx) -> GuardIx {
        while a != b {
            if self.tree[a as usize].depth >= self.tree[b as usize].depth {
                a = self.tree[a as usize].parent;
            } else {
                b = self.tree[b as usize].parent;
            }
        }
        a
    }
}
