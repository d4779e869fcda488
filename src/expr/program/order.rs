//! In which order the needed nodes of a builder are computed, and which of them may be skipped.
//!
//! Operands come near their first use, the more demanding one first (Sethi and Ullman). What only
//! one side of a selection needs stands between `Begin` and `End` of that side, if it is worth a
//! jump; a machine that cannot jump ignores those marks and computes both sides. Nodes that one
//! operation can yield together follow each other: sine and cosine of one angle, a function and its
//! partial derivatives.

use super::builder::Builder;
use super::guard::{ALWAYS, GuardIx, Guards, NEVER};
use super::hashing::HashMap;
use super::node::{Node, Value};
use super::operation::UnaryOp;

/// An element of the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Item {
    /// compute this node
    Node(Value),
    /// what follows is needed only if the selection takes this side
    Begin(Value, u8),
    /// the end of that; the value of the side is known
    End(Value, u8),
}

/// The nodes that each node reads when it is computed, node after node.
#[derive(Debug)]
struct Reads {
    /// the last of each node and those of the nodes before it
    ends: Vec<u32>,
    all: Vec<Value>,
}

impl Reads {
    /// Lists what needed nodes read: their operands; those of an inlined comparison in place of
    /// it, and the base of a power behind its factors.
    fn new(builder: &Builder, inlined: &[bool], is_needed: impl Fn(usize) -> bool) -> Self {
        let n = builder.nodes.len();
        let (mut ends, mut all) = (Vec::with_capacity(n), Vec::with_capacity(2 * n));
        for (k, node) in builder.nodes.iter().enumerate() {
            if is_needed(k) {
                list_reads(builder, inlined, node, &mut all);
            }
            ends.push(all.len() as u32);
        }
        Self { ends, all }
    }

    /// Returns what a node reads.
    #[inline]
    fn of(&self, v: Value) -> &[Value] {
        let first = v.index().checked_sub(1).map_or(0, |k| self.ends[k]);
        &self.all[first as usize..self.ends[v.index()] as usize]
    }
}

/// Lists what a node reads.
#[inline]
fn list_reads(builder: &Builder, inlined: &[bool], node: &Node, all: &mut Vec<Value>) {
    match *node {
        Node::Select(condition, yes, no) if inlined[condition.index()] => {
            builder.operands(&builder.nodes[condition.index()], |x| all.push(x));
            all.extend([yes, no]);
        }
        Node::Binary(_, a, b) => {
            all.extend([a, b]);
            all.extend(builder.half_power(node).map(|(base, _)| base));
        }
        _ => builder.operands(node, |x| all.push(x)),
    }
}

/// The needed nodes in order, and how they are used.
#[derive(Debug)]
pub(super) struct Order {
    pub(super) items: Vec<Item>,
    reads: Reads,
    /// comparisons that exist only inside the selections they decide
    pub(super) inlined: Vec<bool>,
    /// selections whose sides stand together, by the one that `Begin` and `End` name, in the order
    /// of their values
    pub(super) groups: HashMap<Value, Vec<Value>>,
    /// whether a node is one of these
    pub(super) is_jumped: Vec<bool>,
}

/// A side of a selection is skipped by a jump if what it computes costs at least so much. An IF was
/// written by somebody who expects one side to be computed, mostly by time; other selections are
/// sides of a kink that change more often.
const WORTH_A_JUMP: u32 = 8;
const WORTH_A_JUMP_IN_IF: u32 = 2;

/// Most selections whose sides stand together, most candidates that are looked at for it, and most
/// nodes that are looked at to see that one does not need another: recording stays linear.
const MOST_TOGETHER: usize = 16;
const MOST_CANDIDATES: usize = 32;
const MOST_SEARCHED: usize = 200;

impl Order {
    pub(super) fn new(builder: &Builder, outputs: &[Value]) -> Self {
        let guards = Guards::new(builder, outputs);
        let is_needed = |k: usize| guards.of[k] != NEVER;
        let inlined = inlined(builder, outputs, is_needed);
        let mut order = Order {
            items: Vec::new(),
            reads: Reads::new(builder, &inlined, is_needed),
            inlined,
            groups: HashMap::default(),
            is_jumped: vec![false; builder.nodes.len()],
        };
        let (items, groups) = Walk::new(builder, &guards, &order).run(outputs);
        for member in groups.values().flatten() {
            order.is_jumped[member.index()] = true;
        }
        (order.items, order.groups) = (items, groups);
        order
    }

    /// Returns what a needed node reads: its operands; those of an inlined comparison in place of
    /// it, and the base of a power behind its factors.
    #[inline]
    pub(super) fn reads(&self, v: Value) -> &[Value] {
        self.reads.of(v)
    }
}

/// Returns which comparisons only decide selections, by node.
fn inlined(builder: &Builder, outputs: &[Value], is_needed: impl Fn(usize) -> bool) -> Vec<bool> {
    let is_compared = |node: &Node| matches!(node, Node::Compare(..));
    if !builder.nodes.iter().any(is_compared) {
        return vec![false; builder.nodes.len()];
    }
    let (mut uses, mut decides) = (vec![0; builder.nodes.len()], vec![0; builder.nodes.len()]);
    for v in outputs {
        uses[v.index()] += 1;
    }
    for (k, node) in builder.nodes.iter().enumerate() {
        if !is_needed(k) {
            continue;
        }
        builder.operands(node, |v| uses[v.index()] += 1);
        if let Node::Select(condition, ..) = node {
            decides[condition.index()] += 1;
        }
    }
    let is_inlined =
        |(k, node): (usize, &Node)| is_compared(node) && uses[k] > 0 && decides[k] == uses[k];
    builder.nodes.iter().enumerate().map(is_inlined).collect()
}

impl Builder {
    /// Returns how many operations the program of some values takes, without making it.
    pub fn count_operations(&self, outputs: &[Value]) -> usize {
        self.count_by_tape(outputs, || self.counted_operations(outputs))
    }

    fn counted_operations(&self, outputs: &[Value]) -> usize {
        let needed = self.needed(outputs, self.nodes.len());
        let inlined = inlined(self, outputs, |k| needed[k]);
        let is_operation = |k: &usize| {
            let is_read = matches!(self.nodes[*k], Node::Constant(_) | Node::Input(_));
            needed[*k] && !is_read && !inlined[*k]
        };
        (0..self.nodes.len()).filter(is_operation).count()
    }
}

/// A part of the work that remains.
#[derive(Clone, Copy, Debug)]
enum Task {
    /// place the node and before it its operands
    Visit(Value),
    /// place the node; its operands are placed
    Place(Value),
    /// place the exclusive nodes of the sides, then the selection
    Sides(Value),
    Begin(Value, u8),
    End(Value, u8),
}

/// Nodes that a search has met; a new search forgets them at no cost.
struct Met {
    /// the search that met each node last
    by: Vec<u32>,
    search: u32,
    count: usize,
    /// nodes that the search has still to look at
    open: Vec<Value>,
}

impl Met {
    fn new(n_nodes: usize) -> Self {
        Self {
            by: vec![0; n_nodes],
            search: 0,
            count: 0,
            open: Vec::new(),
        }
    }

    /// Begins a search at a node, which does not count as met.
    fn begin(&mut self, first: Value) {
        self.search += 1;
        self.count = 0;
        self.open.clear();
        self.open.push(first);
    }

    /// Notes a node; returns whether the search meets it for the first time.
    fn is_new(&mut self, v: Value) -> bool {
        let by = &mut self.by[v.index()];
        let is_new = *by != self.search;
        *by = self.search;
        is_new
    }

    /// Notes a node that is to be looked at, once.
    fn meet(&mut self, v: Value) {
        if self.is_new(v) {
            self.count += 1;
            self.open.push(v);
        }
    }
}

struct Walk<'a> {
    builder: &'a Builder,
    guards: &'a Guards,
    order: &'a Order,
    demand: Vec<u16>,
    /// cost of all that is needed only under each guard
    weight: Vec<u32>,
    placed: Vec<bool>,
    met: Met,
    /// nodes that one operation yields together, by the first of them
    partners: HashMap<Value, Vec<Value>>,
    /// guards of the open sides
    open: Vec<GuardIx>,
    alike: Alike,
    groups: HashMap<Value, Vec<Value>>,
    /// whether a selection belongs to a group
    grouped: Vec<bool>,
    tasks: Vec<Task>,
    items: Vec<Item>,
}

impl<'a> Walk<'a> {
    fn new(builder: &'a Builder, guards: &'a Guards, order: &'a Order) -> Self {
        Self {
            builder,
            guards,
            order,
            demand: demand(builder),
            weight: weights(builder, guards),
            placed: vec![false; builder.nodes.len()],
            met: Met::new(builder.nodes.len()),
            partners: partners(builder, guards),
            open: vec![ALWAYS],
            alike: Alike::new(builder, guards),
            groups: HashMap::default(),
            grouped: vec![false; builder.nodes.len()],
            tasks: Vec::new(),
            items: Vec::with_capacity(builder.nodes.len()),
        }
    }

    fn run(mut self, outputs: &[Value]) -> (Vec<Item>, HashMap<Value, Vec<Value>>) {
        for &output in outputs {
            self.tasks.push(Task::Visit(output));
            while let Some(task) = self.tasks.pop() {
                self.perform(task);
            }
        }
        (self.items, self.groups)
    }

    fn perform(&mut self, task: Task) {
        match task {
            Task::Visit(v) | Task::Place(v) if self.placed[v.index()] => {}
            Task::Visit(v) => self.visit(v),
            Task::Place(v) => self.place(v),
            Task::Sides(v) => self.sides(v),
            Task::Begin(v, side) => {
                self.open.push(self.guards.side(v, side));
                self.items.push(Item::Begin(v, side));
            }
            Task::End(v, side) => {
                self.open.pop();
                self.items.push(Item::End(v, side));
            }
        }
    }

    fn visit(&mut self, v: Value) {
        let node = &self.builder.nodes[v.index()];
        if self.grouped[v.index()] {
            // another of its group is on its way, and will place it
            return;
        }
        if self.is_worth_a_jump(v, node) {
            self.visit_selection(v, node);
            return;
        }
        self.tasks.push(Task::Place(v));
        let first = self.tasks.len();
        let reads = self.order.reads(v).iter().rev();
        let missing = reads.filter(|x| !self.placed[x.index()]);
        self.tasks.extend(missing.map(|&x| Task::Visit(x)));
        // the last pushed is placed first: least demanding below
        match self.tasks.len() - first {
            0 => {
                self.tasks.pop();
                self.place(v);
            }
            1 => {}
            _ => {
                let demand = &self.demand;
                self.tasks[first..].sort_by_key(|task| match task {
                    Task::Visit(x) => demand[x.index()],
                    _ => 0,
                });
            }
        }
    }

    /// Visits what a selection reads, then those that share its sides.
    fn visit_selection(&mut self, v: Value, node: &Node) {
        self.tasks.push(Task::Sides(v));
        // what decides is placed last, next to the jump
        let reads = self.order.reads(v);
        let n_sides = side_operands(self.builder, node).len();
        let deciders = reads[..reads.len() - n_sides].iter().rev();
        self.tasks.extend(deciders.map(|&x| Task::Visit(x)));
        let group = self.group(v);
        for &member in &group {
            self.grouped[member.index()] = true;
            let sides = side_operands(self.builder, &self.builder.nodes[member.index()]);
            self.visit_shared(v, &sides);
        }
        self.groups.insert(v, group);
    }

    /// Visits what the sides need but others need as well.
    fn visit_shared(&mut self, v: Value, sides: &[Value]) {
        self.met.begin(v);
        let mut below: Vec<(Value, u8)> = sides.iter().copied().zip(0u8..).collect();
        while let Some((x, side)) = below.pop() {
            if self.placed[x.index()] || !self.met.is_new(x) {
                continue;
            }
            if self
                .guards
                .is_within(self.guards.of[x.index()], self.guards.side(v, side))
            {
                let reads = self.order.reads(x).iter();
                below.extend(reads.map(|&o| (o, side)));
            } else {
                self.tasks.push(Task::Visit(x));
            }
        }
    }

    fn sides(&mut self, v: Value) {
        let group = &self.groups[&v];
        self.tasks
            .extend(group.iter().rev().map(|&m| Task::Place(m)));
        let n_sides = side_operands(self.builder, &self.builder.nodes[v.index()]).len();
        for side in (0..n_sides).rev() {
            self.tasks.push(Task::End(v, side as u8));
            for &m in group.iter().rev() {
                let sides = side_operands(self.builder, &self.builder.nodes[m.index()]);
                self.tasks.push(Task::Visit(sides[side]));
            }
            self.tasks.push(Task::Begin(v, side as u8));
        }
    }

    /// Returns the selections whose sides are placed together with those of `v`: they share its
    /// sides, and none needs another.
    fn group(&mut self, v: Value) -> Vec<Value> {
        let is_done = |w: &Value| self.placed[w.index()] || self.grouped[w.index()];
        let alike = self.alike.not_done(self.guards.side(v, 0), is_done);
        let mut candidates: Vec<Value> = alike
            .iter()
            .take(MOST_CANDIDATES)
            .copied()
            .filter(|w| !is_done(w))
            .collect();
        if !candidates.contains(&v) {
            candidates.push(v);
            candidates.sort_unstable();
        }
        let mut group = vec![v];
        for w in candidates {
            if w != v
                && group.len() < MOST_TOGETHER
                && self.is_ready(w)
                && group.iter().all(|&m| self.are_independent(m, w))
            {
                group.push(w);
            }
        }
        group.sort_unstable();
        group
    }

    /// Returns whether all that a selection needs may be placed here: nothing waits for a selection
    /// that is being placed, and nothing is needed where the open sides are not taken. `false`
    /// where that is not seen soon.
    fn is_ready(&mut self, w: Value) -> bool {
        let here = self.open.last().copied().unwrap_or(ALWAYS);
        self.met.begin(w);
        let mut is_ready = true;
        while let (Some(x), true) = (self.met.open.pop(), is_ready) {
            let node = &self.builder.nodes[x.index()];
            is_ready = matches!(node, Node::Constant(_) | Node::Input(_))
                || self.met.count <= MOST_SEARCHED
                    && !self.grouped[x.index()]
                    && self.guards.is_within(self.guards.of[x.index()], here);
            for &o in self.order.reads(x) {
                if !self.placed[o.index()] {
                    self.met.meet(o);
                }
            }
        }
        is_ready
    }

    /// Returns whether neither value needs the other; `false` where that is not seen soon.
    fn are_independent(&mut self, a: Value, b: Value) -> bool {
        let (below, above) = (a.min(b), a.max(b));
        self.met.begin(above);
        while let Some(x) = self.met.open.pop() {
            if x == below || self.met.count > MOST_SEARCHED {
                return false;
            }
            // operands stand before their users
            self.builder.operands(&self.builder.nodes[x.index()], |o| {
                if o >= below {
                    self.met.meet(o);
                }
            });
        }
        true
    }

    fn place(&mut self, v: Value) {
        self.placed[v.index()] = true;
        self.items.push(Item::Node(v));
        let node = &self.builder.nodes[v.index()];
        if !may_have_partners(node) {
            return;
        }
        let here = self.open.last().copied().unwrap_or(ALWAYS);
        let key = group(node).unwrap_or(v);
        if let Some(partners) = self.partners.get(&key) {
            for &partner in partners.iter().rev() {
                let guard = self.guards.of[partner.index()];
                if partner != v
                    && !self.placed[partner.index()]
                    && self.guards.is_within(guard, here)
                {
                    self.tasks.push(Task::Place(partner));
                }
            }
        }
    }

    fn is_worth_a_jump(&self, v: Value, node: &Node) -> bool {
        let (n, least) = match node {
            Node::Select(..) => (2, WORTH_A_JUMP),
            Node::If(_) => (3, WORTH_A_JUMP_IN_IF),
            _ => return false,
        };
        (0..n).any(|side| self.weight[self.guards.side(v, side) as usize] >= least)
    }
}

/// Returns the values that a selection chooses from.
pub(super) fn side_operands(builder: &Builder, node: &Node) -> Vec<Value> {
    match *node {
        Node::Select(_, yes, no) => vec![yes, no],
        Node::If(_) => node
            .list()
            .map_or(Vec::new(), |list| builder.arguments[list][1..].to_vec()),
        _ => Vec::new(),
    }
}

/// Needed selections by the guard of their first side: those that share their sides.
struct Alike {
    /// guard by guard, those of one in the order of their values
    selections: Vec<Value>,
    /// where those of each guard begin that may not be done yet
    first: Vec<u32>,
    /// where those of each guard end
    end: Vec<u32>,
}

impl Alike {
    fn new(builder: &Builder, guards: &Guards) -> Self {
        let nodes = (0u32..).map(Value).zip(&builder.nodes);
        let is_selection = |node: &Node| matches!(node, Node::Select(..) | Node::If(_));
        let mut selections: Vec<(GuardIx, Value)> = nodes
            .filter(|(v, node)| is_selection(node) && guards.of[v.index()] != NEVER)
            .map(|(v, _)| (guards.side(v, 0), v))
            .collect();
        selections.sort_unstable();
        let (mut first, mut end) = (vec![0; guards.tree.len()], vec![0; guards.tree.len()]);
        for (at, &(guard, _)) in (0u32..).zip(&selections) {
            if end[guard as usize] == 0 {
                first[guard as usize] = at;
            }
            end[guard as usize] = at + 1;
        }
        Self {
            selections: selections.into_iter().map(|(_, v)| v).collect(),
            first,
            end,
        }
    }

    /// Returns the selections of a guard without the first ones that are done.
    fn not_done(&mut self, guard: GuardIx, is_done: impl Fn(&Value) -> bool) -> &[Value] {
        let first = &mut self.first[guard as usize];
        let here = &self.selections[*first as usize..self.end[guard as usize] as usize];
        let done = here.iter().take_while(|w| is_done(w)).count();
        *first += done as u32;
        &here[done..]
    }
}

/// Returns the call that nodes have in common which are computed together.
fn group(node: &Node) -> Option<Value> {
    match *node {
        Node::Partial { call, .. } => Some(call),
        _ => None,
    }
}

/// Returns whether an operation may yield other nodes together with this one.
fn may_have_partners(node: &Node) -> bool {
    matches!(
        node,
        Node::Unary(UnaryOp::Sin | UnaryOp::Cos, _) | Node::Call { .. } | Node::Partial { .. }
    )
}

/// Returns needed nodes that one operation yields together.
fn partners(builder: &Builder, guards: &Guards) -> HashMap<Value, Vec<Value>> {
    let mut partners: HashMap<Value, Vec<Value>> = HashMap::default();
    let mut angles: HashMap<Value, Value> = HashMap::default();
    for (k, node) in builder.nodes.iter().enumerate() {
        if guards.of[k] == NEVER {
            continue;
        }
        let v = Value(k as u32);
        match *node {
            Node::Unary(UnaryOp::Sin | UnaryOp::Cos, angle) => {
                if let Some(&other) = angles.get(&angle) {
                    partners.insert(other, vec![v]);
                    partners.insert(v, vec![other]);
                }
                angles.insert(angle, v);
            }
            Node::Partial { call, .. } => {
                let group = partners.entry(call).or_default();
                if group.is_empty() && guards.of[call.index()] != NEVER {
                    group.push(call);
                }
                group.push(v);
            }
            _ => {}
        }
    }
    partners
}

/// Returns how many registers the tree below each node would need.
fn demand(builder: &Builder) -> Vec<u16> {
    let mut demand: Vec<u16> = Vec::with_capacity(builder.nodes.len());
    let mut below: Vec<u16> = Vec::new();
    for node in &builder.nodes {
        let of = |v: Value| demand[v.index()];
        let here = match *node {
            Node::Constant(_) | Node::Input(_) => 0,
            Node::Unary(_, x) => of(x).max(1),
            Node::Binary(_, a, b) => {
                let (a, b) = (of(a), of(b));
                a.max(b).max(a.min(b).saturating_add(1))
            }
            _ => {
                below.clear();
                builder.operands(node, |v| below.push(of(v)));
                below.sort_unstable_by(|a, b| b.cmp(a));
                let all = below.iter().zip(0u16..);
                all.map(|(d, held)| d.saturating_add(held))
                    .max()
                    .map_or(0, |most| most.max(1))
            }
        };
        demand.push(here);
    }
    demand
}

/// Returns the cost of all that is computed only under each guard, in additions.
fn weights(builder: &Builder, guards: &Guards) -> Vec<u32> {
    let mut weights = vec![0u32; guards.tree.len()];
    for (node, &guard) in builder.nodes.iter().zip(&guards.of) {
        if guard != NEVER {
            let weight = &mut weights[guard as usize];
            *weight = weight.saturating_add(cost(node));
        }
    }
    for k in (1..weights.len()).rev() {
        let parent = guards.tree[k].parent as usize;
        weights[parent] = weights[parent].saturating_add(weights[k]);
    }
    weights
}

/// Returns about how many additions a node costs.
fn cost(node: &Node) -> u32 {
    match node {
        Node::Constant(_) | Node::Input(_) => 0,
        Node::Unary(op, _) => op.cost(),
        Node::Binary(op, ..) => op.cost(),
        Node::Compare(..) => 1,
        Node::Whole(..) => 4,
        Node::Select(..) | Node::If(_) => 2,
        Node::Lookup { .. } => 15,
        Node::Call { .. } | Node::Partial { .. } => 10,
    }
}
