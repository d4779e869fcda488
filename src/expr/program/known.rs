//! Where a builder finds a node that it has recorded before.
//!
//! A node is sought among the users of its newest operand, which nearly always are few and were
//! recorded a moment ago. A table of hashes alone is larger than the caches of a processor for a
//! large scene, and a look at it costs more than all else that recording a node does; it holds the
//! nodes without operands, and those whose newest operand has many users.

use super::node::{Node, Value};

/// Users of one newest operand that are looked through, at most.
const MOST_USERS: usize = 16;
const NONE: u32 = u32::MAX;

/// The nodes that have been recorded, to be found again.
#[derive(Clone, Debug, Default)]
pub(super) struct Known {
    /// for each node the first user whose newest operand it is, and the next user after itself
    users: Vec<(u32, u32)>,
    /// open addressing: the hash of a node, and `NONE` or its index
    slots: Vec<(u32, u32)>,
    /// slots that are taken
    n_taken: usize,
    /// how often a node was looked at: tests see that recording is linear
    pub probes: u64,
}

impl Known {
    /// Looks for a node among the users of its newest operand; returns whether they are few, so
    /// that it is nowhere else.
    #[inline]
    pub fn user(&mut self, newest: usize, is_equal: impl Fn(usize) -> bool) -> (Option<u32>, bool) {
        let mut at = self.users.get(newest).map_or(NONE, |u| u.0);
        for _ in 0..MOST_USERS {
            if at == NONE {
                return (None, true);
            }
            self.probes += 1;
            if is_equal(at as usize) {
                return (Some(at), true);
            }
            at = self.users[at as usize].1;
        }
        (None, false)
    }

    /// Adds a node to the users of its newest operand.
    #[inline]
    pub fn add_user(&mut self, newest: usize, k: u32) {
        if self.users.len() <= k as usize {
            self.users.resize(k as usize + 1, (NONE, NONE));
        }
        self.users[k as usize].1 = self.users[newest].0;
        self.users[newest].0 = k;
    }

    /// Returns the node of this hash, or the slot that is to hold it.
    pub fn slot(&mut self, hash: u32, is_equal: impl Fn(usize) -> bool) -> Result<u32, usize> {
        if (self.n_taken + 1) * 4 > self.slots.len() * 3 {
            self.grow();
        }
        let mask = self.slots.len() - 1;
        let mut slot = hash as usize & mask;
        loop {
            let (known, found) = self.slots[slot];
            self.probes += 1;
            if found == NONE {
                return Err(slot);
            }
            if known == hash && is_equal(found as usize) {
                return Ok(found);
            }
            slot = (slot + 1) & mask;
        }
    }

    pub fn fill(&mut self, slot: usize, hash: u32, k: u32) {
        self.slots[slot] = (hash, k);
        self.n_taken += 1;
    }

    fn grow(&mut self) {
        let mut slots = vec![(0, NONE); (self.slots.len() * 2).max(64)];
        let mask = slots.len() - 1;
        for &(hash, k) in self.slots.iter().filter(|slot| slot.1 != NONE) {
            let mut slot = hash as usize & mask;
            while slots[slot].1 != NONE {
                slot = (slot + 1) & mask;
            }
            slots[slot] = (hash, k);
        }
        self.slots = slots;
    }
}

/// Returns the hash of a node.
pub(super) fn hash(arguments: &[Value], node: &Node) -> u64 {
    // all bits of a product reach all bits of the hash: numbers such as 2.5 have zeros in all
    // low bits
    let mix = |h: u64, word: u64| {
        let product =
            u128::from(h ^ word ^ 0x9E37_79B9_7F4A_7C15) * u128::from(0xD6E8_FEB8_6659_FD93u64);
        (product >> 64) as u64 ^ product as u64
    };
    let pair = |a: Value, b: Value| u64::from(a.0) << 32 | u64::from(b.0);
    let of_list = |seed: u64| {
        let list = &arguments[node.list().unwrap_or(0..0)];
        list.iter().fold(seed, |h, v| mix(h, u64::from(v.0)))
    };
    match *node {
        Node::Constant(bits) => mix(1, bits),
        Node::Input(k) => mix(2, u64::from(k)),
        Node::Unary(op, x) => mix(mix(3, op as u64), u64::from(x.0)),
        Node::Whole(x, n) => mix(mix(4, u64::from(x.0)), n as u64),
        Node::Binary(op, a, b) => mix(mix(5, op as u64), pair(a, b)),
        Node::Compare(op, a, b) => mix(mix(6, op as u64), pair(a, b)),
        Node::Select(c, yes, no) => mix(mix(7, u64::from(c.0)), pair(yes, no)),
        Node::Lookup { table, order, x } => mix(
            mix(8, u64::from(table) << 8 | u64::from(order)),
            u64::from(x.0),
        ),
        Node::Partial { call, k } => mix(mix(11, u64::from(call.0)), u64::from(k)),
        Node::If(_) => of_list(9),
        Node::Call { function, .. } => of_list(mix(10, function as u64)),
    }
}

/// Returns whether two nodes are the same operation of the same operands.
pub(super) fn equal(arguments: &[Value], a: &Node, b: &Node) -> bool {
    let same_lists = || match (a.list(), b.list()) {
        (Some(a), Some(b)) => arguments[a] == arguments[b],
        _ => false,
    };
    match (a, b) {
        (Node::If(_), Node::If(_)) => same_lists(),
        (Node::Call { function: f, .. }, Node::Call { function: g, .. }) => f == g && same_lists(),
        _ => a == b,
    }
}
