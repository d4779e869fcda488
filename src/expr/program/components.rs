//! Components of a recording: operations that share nothing but inputs and constants.
//!
//! A scene of equal mechanisms records the same operations for each of them, on other inputs and
//! with other constants. They are found here, so that their order, their registers and their code
//! are made once and run for each. What reads several of them, the least of many numbers, is left
//! for a last piece that reads their results.

use super::builder::Builder;
use super::hashing::HashMap;
use super::input::Input;
use super::node::{self, Node, Value};
use super::operation::{BinaryOp, Comparison};
use crate::expr::functions::Function;

/// Nodes of a recording from which on it pays to look for components.
const LEAST_NODES: usize = 256;
/// Operations of a component from which on it pays to run it by itself.
const LEAST_OPERATIONS: usize = 16;
/// Part of the operations that components with companions must have.
const LEAST_PART: f64 = 0.6;
/// Place or component of a node that has none.
const NONE: u32 = u32::MAX;

/// Components that are the same but for their constants.
#[derive(Debug)]
pub(super) struct Kind {
    /// the nodes of the first, with inputs of its own
    pub builder: Builder,
    /// its results
    pub results: Vec<Value>,
    /// nodes that are constants, in the order of [`Member::constants`]
    pub constants: Vec<Value>,
    pub members: Vec<Member>,
}

/// One of some components that are the same.
#[derive(Debug, Default)]
pub(super) struct Member {
    /// nodes of the recording that its constants are
    pub constants: Vec<Value>,
    /// nodes that its inputs are: inputs of the recording, or results of other components
    pub inputs: Vec<Value>,
    /// where its results go
    pub targets: Vec<Target>,
}

/// Where a result of a component goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Target {
    /// an output of the program, by its position
    Output(u32),
    /// the last piece, as this node
    Last(Value),
}

impl Builder {
    /// Returns the components by which some values are computed, those that are alike together, in
    /// the order in which they can be run; the last is what is left. `None`: fewer than `fewest`
    /// are alike, or they are too small a part.
    pub(super) fn components(&self, outputs: &[Value], fewest: usize) -> Option<Vec<Kind>> {
        if self.n_components < fewest || self.nodes.len() < LEAST_NODES {
            return None;
        }
        let (parts, last) = parts(self, outputs)?;
        let mut pieces = Pieces {
            builder: self,
            places: vec![Value(NONE); self.nodes.len()],
            touched: Vec::new(),
        };
        let mut kinds: Vec<(Kind, Vec<usize>)> = Vec::new();
        let mut by_hash: HashMap<u64, Vec<usize>> = HashMap::default();
        for (p, part) in parts.iter().enumerate() {
            if part.nodes.len() < LEAST_OPERATIONS {
                continue;
            }
            let (piece, member) = pieces.piece(&part.nodes, &part.results);
            let alike = by_hash.entry(piece.hash()).or_default();
            if let Some(&k) = alike.iter().find(|&&k| piece.is_like(&kinds[k].0)) {
                kinds[k].0.members.push(member);
                kinds[k].1.push(p);
            } else {
                alike.push(kinds.len());
                kinds.push((piece.kind(self, member), vec![p]));
            }
        }
        kinds.retain(|(kind, _)| kind.members.len() >= fewest);
        let mut is_kept = vec![false; parts.len()];
        for &p in kinds.iter().flat_map(|(_, p)| p) {
            is_kept[p] = true;
        }
        let all = parts.iter().zip(&is_kept);
        let count = |kept: bool| -> usize {
            let those = all.clone().filter(|(_, is_kept)| **is_kept == kept);
            those.map(|(part, _)| part.nodes.len()).sum()
        };
        let (n_kept, n_left) = (count(true), count(false) + last.nodes.len());
        if (n_kept as f64) < LEAST_PART * (n_kept + n_left) as f64 {
            return None;
        }
        let mut left = last;
        for (part, _) in all.filter(|(_, is_kept)| !**is_kept) {
            left.nodes.extend_from_slice(&part.nodes);
            // what the last piece reads of them is now in it
            let is_output = |(_, target): &&(Value, Target)| matches!(target, Target::Output(_));
            left.results.extend(part.results.iter().filter(is_output));
        }
        let mut kinds: Vec<Kind> = kinds.into_iter().map(|(kind, _)| kind).collect();
        if !left.nodes.is_empty() {
            left.nodes.sort_unstable();
            left.results.sort_unstable_by_key(|(_, target)| *target);
            let (piece, member) = pieces.piece(&left.nodes, &left.results);
            kinds.push(piece.kind(self, member));
        }
        Some(kinds)
    }
}

/// Operations, in the order of the recording, and their results with where they go.
#[derive(Default)]
struct Part {
    nodes: Vec<Value>,
    results: Vec<(Value, Target)>,
}

fn is_operation(node: &Node) -> bool {
    !matches!(node, Node::Constant(_) | Node::Input(_))
}

/// Calls `each` with what a node is computed from, the call of which it is a derivative included.
#[inline(always)]
fn each_operand(builder: &Builder, node: &Node, mut each: impl FnMut(Value)) {
    match *node {
        Node::Binary(_, a, b) => {
            each(a);
            each(b);
        }
        Node::Unary(_, x) => each(x),
        _ => more_operands(builder, node, &mut each),
    }
}

fn more_operands(builder: &Builder, node: &Node, each: &mut dyn FnMut(Value)) {
    if let Node::Partial { call, .. } = *node {
        each(call);
    }
    builder.operands(node, each);
}

/// Returns which nodes find the extreme of two numbers, which may be those of two components.
fn extremes(builder: &Builder, needed: &[bool]) -> Vec<bool> {
    let mut is_extreme = vec![false; needed.len()];
    for (k, node) in builder.nodes[..needed.len()].iter().enumerate() {
        match *node {
            Node::Call {
                function: Function::Max | Function::Min,
                count: 2,
                ..
            } => is_extreme[k] = true,
            Node::Select(condition, yes, no) if needed[k] => {
                if let Node::Compare(Comparison::Lt | Comparison::Le, a, b) =
                    builder.nodes[condition.index()]
                    && ([a, b] == [yes, no] || [b, a] == [yes, no])
                {
                    is_extreme[k] = true;
                    is_extreme[condition.index()] = true;
                }
            }
            _ => {}
        }
    }
    is_extreme
}

/// Sets of nodes that belong together, each with a node of its set before it, or itself.
struct Sets(Vec<u32>);

impl Sets {
    #[inline(always)]
    fn root(&mut self, mut k: u32) -> u32 {
        let parents = &mut self.0;
        while parents[k as usize] != k {
            let above = parents[parents[k as usize] as usize];
            parents[k as usize] = above;
            k = above;
        }
        k
    }

    /// Joins a node and one of a set whose first node is known; returns the first of both.
    #[inline(always)]
    fn join(&mut self, first: u32, x: u32) -> u32 {
        let x = self.root(x);
        if x == first {
            return first;
        }
        self.0[x.max(first) as usize] = x.min(first);
        x.min(first)
    }

    /// Returns the first node of each set, by node.
    fn firsts(mut self) -> Vec<u32> {
        for k in 0..self.0.len() {
            self.0[k] = self.0[self.0[k] as usize];
        }
        self.0
    }
}

/// Which operations belong together, and which read several of those.
struct Found<'a> {
    builder: &'a Builder,
    outputs: &'a [Value],
    /// operations that are needed
    needed: Vec<bool>,
    sets: Sets,
    /// extremes of two numbers
    is_extreme: Vec<bool>,
    /// extremes of numbers of several components, and what reads those
    is_last: Vec<bool>,
}

impl<'a> Found<'a> {
    fn new(builder: &'a Builder, outputs: &'a [Value]) -> Self {
        let n = outputs.iter().map(|v| v.index() + 1).max().unwrap_or(0);
        let mut needed = builder.read(outputs, n);
        for (needed, node) in needed.iter_mut().zip(&builder.nodes) {
            *needed &= is_operation(node);
        }
        let is_extreme = extremes(builder, &needed);
        let mut sets = Sets((0..n as u32).collect());
        for k in (0..n).filter(|&k| needed[k] && !is_extreme[k]) {
            let mut first = k as u32;
            each_operand(builder, &builder.nodes[k], |x| {
                if needed[x.index()] && !is_extreme[x.index()] {
                    first = sets.join(first, x.0);
                }
            });
        }
        let mut found = Self {
            builder,
            outputs,
            needed,
            sets,
            is_extreme,
            is_last: vec![false; n],
        };
        if found.is_extreme.iter().any(|&is| is) {
            found.part_extremes();
            found.take_back();
        }
        found
    }

    /// Gives extremes of numbers of one component to it; those of several come last, with what
    /// reads them.
    fn part_extremes(&mut self) {
        let Self {
            builder,
            needed,
            sets,
            is_extreme,
            is_last,
            ..
        } = self;
        for k in (0..needed.len()).filter(|&k| needed[k]) {
            let node = &builder.nodes[k];
            let (mut is_concerned, mut reads_last) = (is_extreme[k], false);
            each_operand(builder, node, |x| {
                is_concerned |= is_extreme[x.index()] || is_last[x.index()];
                reads_last |= is_last[x.index()];
            });
            if !is_concerned {
                continue;
            }
            let (mut one, mut several) = (NONE, false);
            each_operand(builder, node, |x| {
                if needed[x.index()] {
                    let component = sets.root(x.0);
                    several |= one != NONE && one != component;
                    one = component;
                }
            });
            is_last[k] = reads_last || several && is_extreme[k];
            if !is_last[k] {
                let mut first = sets.root(k as u32);
                each_operand(builder, node, |x| {
                    if needed[x.index()] {
                        first = sets.join(first, x.0);
                    }
                });
            }
        }
    }

    /// Leaves extremes of one component for the end, too, where they are read there alone: the
    /// first component has no more of them than the others.
    fn take_back(&mut self) {
        let mut is_read_before = vec![false; self.needed.len()];
        for v in self.outputs {
            is_read_before[v.index()] = true;
        }
        for k in (0..self.needed.len()).rev().filter(|&k| self.needed[k]) {
            self.is_last[k] |= self.is_extreme[k] && !is_read_before[k];
            if !self.is_last[k] {
                each_operand(self.builder, &self.builder.nodes[k], |x| {
                    is_read_before[x.index()] = true;
                });
            }
        }
    }
}

/// Returns the components by which some values are computed, and what reads several of them;
/// `None`: there is one at most.
fn parts(builder: &Builder, outputs: &[Value]) -> Option<(Vec<Part>, Part)> {
    let Found {
        needed,
        sets,
        is_last,
        ..
    } = Found::new(builder, outputs);
    let firsts = sets.firsts();
    let operations = || (0..needed.len()).filter(|&k| needed[k]);
    let of_components = || operations().filter(|&k| !is_last[k]);
    let first = firsts[of_components().next()?];
    if of_components().all(|k| firsts[k] == first) {
        return None;
    }
    let mut sizes = vec![0u32; needed.len()];
    of_components().for_each(|k| sizes[firsts[k] as usize] += 1);
    let mut numbers = vec![NONE; needed.len()];
    let (mut parts, mut last) = (Vec::<Part>::new(), Part::default());
    let mut part_of = vec![NONE; needed.len()];
    for k in operations() {
        if is_last[k] {
            last.nodes.push(Value(k as u32));
            continue;
        }
        let first = firsts[k] as usize;
        if numbers[first] == NONE {
            numbers[first] = parts.len() as u32;
            parts.push(Part {
                nodes: Vec::with_capacity(sizes[first] as usize),
                results: Vec::new(),
            });
        }
        part_of[k] = numbers[first];
        parts[numbers[first] as usize].nodes.push(Value(k as u32));
    }
    for (place, &v) in (0u32..).zip(outputs) {
        let of = match part_of[v.index()] {
            NONE if is_last[v.index()] => &mut last,
            // a constant or an input
            NONE => continue,
            part => &mut parts[part as usize],
        };
        of.results.push((v, Target::Output(place)));
    }
    let mut is_read = vec![false; needed.len()];
    for &k in &last.nodes {
        each_operand(builder, &builder.nodes[k.index()], |x| {
            if part_of[x.index()] != NONE && !std::mem::replace(&mut is_read[x.index()], true) {
                let part = &mut parts[part_of[x.index()] as usize];
                part.results.push((x, Target::Last(x)));
            }
        });
    }
    Some((parts, last))
}

/// Takes operations out of a recording.
struct Pieces<'a> {
    builder: &'a Builder,
    /// by node: its place in the piece at hand
    places: Vec<Value>,
    /// nodes that have one
    touched: Vec<Value>,
}

/// Operations of a recording by themselves.
struct Piece {
    nodes: Vec<Node>,
    arguments: Vec<Value>,
    results: Vec<Value>,
    constants: Vec<Value>,
    n_inputs: u32,
}

impl Pieces<'_> {
    /// Returns some operations by themselves, and what they read of the whole.
    fn piece(&mut self, nodes: &[Value], results: &[(Value, Target)]) -> (Piece, Member) {
        let mut piece = Piece {
            nodes: Vec::with_capacity(nodes.len() * 3 / 2),
            arguments: Vec::new(),
            results: Vec::new(),
            constants: Vec::new(),
            n_inputs: 0,
        };
        let mut member = Member::default();
        for &v in nodes {
            let node = &self.builder.nodes[v.index()];
            let (places, touched) = (&mut self.places, &mut self.touched);
            each_operand(self.builder, node, |x| {
                if places[x.index()].0 == NONE {
                    places[x.index()] = Value(piece.nodes.len() as u32);
                    touched.push(x);
                    piece.read(self.builder, x, &mut member);
                }
            });
            let node = self.builder.copied(node, places, &mut piece.arguments);
            places[v.index()] = Value(piece.nodes.len() as u32);
            touched.push(v);
            let node = piece.in_order(node);
            piece.nodes.push(node);
        }
        piece.results = (results.iter())
            .map(|(v, _)| self.places[v.index()])
            .collect();
        member.targets = results.iter().map(|(_, target)| *target).collect();
        for v in self.touched.drain(..) {
            self.places[v.index()] = Value(NONE);
        }
        (piece, member)
    }
}

impl Piece {
    /// Adds what an operation reads that is none of the piece.
    fn read(&mut self, builder: &Builder, x: Value, member: &mut Member) {
        if let node @ Node::Constant(_) = builder.nodes[x.index()] {
            self.constants.push(Value(self.nodes.len() as u32));
            member.constants.push(x);
            self.nodes.push(node);
        } else {
            member.inputs.push(x);
            self.nodes.push(Node::Input(self.n_inputs));
            self.n_inputs += 1;
        }
    }

    /// Returns a node whose operands may be exchanged with a constant before the other: which was
    /// recorded first depends on what was recorded elsewhere.
    fn in_order(&self, node: Node) -> Node {
        use BinaryOp::{Add, And, Mul, Or};
        let is_constant = |v: Value| matches!(self.nodes[v.index()], Node::Constant(_));
        match node {
            Node::Binary(op @ (Add | Mul | And | Or), a, b) if is_constant(b) => {
                Node::Binary(op, b, a)
            }
            Node::Compare(Comparison::Eq, a, b) if is_constant(b) => {
                Node::Compare(Comparison::Eq, b, a)
            }
            _ => node,
        }
    }

    fn hash(&self) -> u64 {
        node::hash(&self.nodes, &self.results)
    }

    /// Returns whether it differs from those of a kind in its constants alone, but not in
    /// parameters of functions, of which code is made.
    fn is_like(&self, kind: &Kind) -> bool {
        let other = &kind.builder;
        let is_parameter = |v: &&Value| matches!(self.nodes[v.index()], Node::Constant(_));
        self.nodes.len() == other.nodes.len()
            && self.results == kind.results
            && self.arguments == other.arguments
            && self.nodes.iter().zip(&other.nodes).all(node::is_alike)
            && (self.arguments.iter().filter(is_parameter))
                .all(|v| self.nodes[v.index()] == other.nodes[v.index()])
    }

    /// Returns the kind of which this is the first.
    fn kind(self, whole: &Builder, member: Member) -> Kind {
        let mut builder = Builder::new(whole.folding());
        builder.nodes = self.nodes;
        builder.arguments = self.arguments;
        builder.inputs = (0..self.n_inputs).map(Input::Slot).collect();
        builder.tables.clone_from(&whole.tables);
        Kind {
            builder,
            results: self.results,
            constants: self.constants,
            members: vec![member],
        }
    }
}
