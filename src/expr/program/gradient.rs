//! The adjoint of a program: one sweep from an output back to the inputs gives all partial
//! derivatives.
//!
//! Every node passes `bar = ∂output/∂node` on to its operands, times its own partial derivatives.
//! Those of a function of the table are its row evaluated over duals ([`Node::Partial`]). Where a
//! contribution leaves a side of a selection it is zero unless that side is taken, so that a branch
//! without a value does not spoil the derivatives of the other.

use super::builder::{Builder, Folding};
use super::code::partial;
use super::expand::Expand;
use super::guard::{GuardIx, Guards, NEVER};
use super::node::{Node, Value};
use super::operation::{BinaryOp, Comparison, UnaryOp, unary_operations};
use crate::expr::functions::Function;
use BinaryOp::{Add, Along, Div, Mul, Sub};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::f64::consts::LOG10_E;

impl Builder {
    /// Returns the partial derivatives of a value with respect to others, usually inputs.
    ///
    /// At a switching point the derivative is that of the side that supplies the value.
    pub fn gradient(&mut self, output: Value, with_respect_to: &[Value]) -> Vec<Value> {
        self.gradient_of_sum(&[output], with_respect_to)
    }

    /// Returns the partial derivatives of a sum of values with respect to others.
    fn gradient_of_sum(&mut self, outputs: &[Value], with_respect_to: &[Value]) -> Vec<Value> {
        let folding = self.folding();
        self.set_folding(Folding::Structural);
        let outputs = self.expanded(outputs, Expand::Partials);
        let gradient = Adjoint::new(self, &outputs, with_respect_to).sweep(with_respect_to);
        self.set_folding(folding);
        gradient
    }

    /// Returns the partial derivatives of values, by rows: places among `with_respect_to`,
    /// ascending, and the derivatives that are not zero. Values that read none of these in common
    /// share a sweep.
    pub fn jacobian(
        &mut self,
        outputs: &[Value],
        with_respect_to: &[Value],
    ) -> Vec<Vec<(usize, Value)>> {
        let reads = self.reads(outputs, with_respect_to);
        // groups of outputs, and the places that they read
        let mut groups: Vec<(Vec<usize>, HashSet<u32>)> = Vec::new();
        for (k, own) in reads.iter().enumerate().filter(|(_, own)| !own.is_empty()) {
            let apart = |group: &&mut (Vec<usize>, HashSet<u32>)| {
                own.iter().all(|place| !group.1.contains(place))
            };
            match groups.iter_mut().find(apart) {
                Some((members, places)) => {
                    members.push(k);
                    places.extend(own);
                }
                None => groups.push((vec![k], own.iter().copied().collect())),
            }
        }
        let mut rows = vec![Vec::new(); outputs.len()];
        for (members, _) in groups {
            let group: Vec<Value> = members.iter().map(|&k| outputs[k]).collect();
            let gradient = self.gradient_of_sum(&group, with_respect_to);
            for k in members {
                let places = reads[k].iter().map(|&place| place as usize);
                let entries = places.map(|place| (place, gradient[place]));
                rows[k] = entries
                    .filter(|e| self.constant_of(e.1) != Some(0.0))
                    .collect();
            }
        }
        rows
    }

    /// Returns of each value the places among `inputs` of those that it is made of, ascending.
    fn reads(&self, values: &[Value], inputs: &[Value]) -> Vec<Vec<u32>> {
        let n = values.iter().map(|v| v.index() + 1).max().unwrap_or(0);
        let mut sets: Vec<Vec<u32>> = vec![Vec::new()];
        let mut index: HashMap<Vec<u32>, usize> = HashMap::from([(Vec::new(), 0)]);
        let mut intern = |set: Vec<u32>, sets: &mut Vec<Vec<u32>>| {
            *index.entry(set).or_insert_with_key(|set| {
                sets.push(set.clone());
                sets.len() - 1
            })
        };
        let mut unions: HashMap<(usize, usize), usize> = HashMap::new();
        let mut set_of = vec![0; n.max(inputs.iter().map(|v| v.index() + 1).max().unwrap_or(0))];
        for (place, v) in inputs.iter().enumerate() {
            set_of[v.index()] = intern(vec![place as u32], &mut sets);
        }
        for k in 0..n {
            let mut own = set_of[k];
            self.operands(&self.nodes[k], |v| {
                let other = set_of[v.index()];
                if other != own && other != 0 {
                    let pair = (own.min(other), own.max(other));
                    own = *unions.entry(pair).or_insert_with(|| {
                        let both = sets[pair.0].iter().chain(&sets[pair.1]).copied();
                        let both: BTreeSet<u32> = both.collect();
                        intern(both.into_iter().collect(), &mut sets)
                    });
                }
            });
            set_of[k] = own;
        }
        values
            .iter()
            .map(|v| sets[set_of[v.index()]].clone())
            .collect()
    }

    /// Records the `k`-th partial derivative of a call.
    fn partial(&mut self, call: Value, k: u32) -> Value {
        self.intern(Node::Partial { call, k })
    }

    /// Records the `k`-th partial derivative of a function at these arguments.
    pub(super) fn partial_of(&mut self, function: Function, args: &[Value], k: u32) -> Value {
        let call = self.call(function, args);
        match self.nodes[call.index()] {
            Node::Call { .. } => self.partial(call, k),
            // all arguments are constant
            _ => {
                let numbers: Vec<f64> = args
                    .iter()
                    .map(|&a| self.constant_of(a).unwrap_or(f64::NAN))
                    .collect();
                self.constant(partial(function, &numbers, k as usize))
            }
        }
    }
}

/// A sweep in progress.
struct Adjoint<'b> {
    builder: &'b mut Builder,
    guards: Guards,
    /// whether a node depends on what is differentiated by
    active: Vec<bool>,
    bars: Vec<Option<Value>>,
}

impl<'b> Adjoint<'b> {
    fn new(builder: &'b mut Builder, outputs: &[Value], with_respect_to: &[Value]) -> Self {
        let n = outputs.iter().map(|v| v.index() + 1).max().unwrap_or(0);
        // what is differentiated by is wanted in any case, so that contributions from a side are
        // zero elsewhere
        let wanted: Vec<Value> = outputs.iter().chain(with_respect_to).copied().collect();
        let guards = Guards::new(builder, &wanted);
        let mut active = vec![false; builder.nodes.len()];
        for v in with_respect_to {
            active[v.index()] = true;
        }
        for k in 0..n {
            let mut depends = active[k];
            builder.operands(&builder.nodes[k], |v| depends |= active[v.index()]);
            active[k] = depends;
        }
        let one = builder.constant(1.0);
        let mut bars = vec![None; n];
        for output in outputs {
            bars[output.index()] = Some(one);
        }
        Self {
            builder,
            guards,
            active,
            bars,
        }
    }

    fn sweep(mut self, with_respect_to: &[Value]) -> Vec<Value> {
        for k in (0..self.bars.len()).rev() {
            let (Some(bar), true) = (self.bars[k], self.active[k]) else {
                continue;
            };
            if self.guards.of[k] != NEVER {
                self.pass(Value(k as u32), bar);
            }
        }
        let zero = self.builder.constant(0.0);
        with_respect_to
            .iter()
            .map(|v| self.bars.get(v.index()).copied().flatten().unwrap_or(zero))
            .collect()
    }

    /// Passes the bar of a node on to its operands.
    fn pass(&mut self, v: Value, bar: Value) {
        let here = self.guards.of[v.index()];
        match self.builder.nodes[v.index()] {
            Node::Constant(_) | Node::Input(_) | Node::Compare(..) => {}
            Node::Unary(op, x) => {
                if self.active[x.index()] {
                    let part = self.unary(op, x, v, bar);
                    self.add(x, here, part);
                }
            }
            Node::Whole(x, n) => {
                if self.active[x.index()] {
                    let slope = self.builder.powi(x, n - 1);
                    let part = self.times(bar, f64::from(n));
                    let part = self.op(Mul, part, slope);
                    self.add(x, here, part);
                }
            }
            node @ Node::Binary(op, a, b) => match self.builder.half_power(&node) {
                Some((x, n)) if self.active[x.index()] => {
                    let whole = self.builder.powi(x, n - 1);
                    let root = self.builder.unary(UnaryOp::Sqrt, x);
                    let slope = self.op(Mul, whole, root);
                    let part = self.times(bar, f64::from(n) + 0.5);
                    let part = self.op(Mul, part, slope);
                    self.add(x, here, part);
                }
                _ => self.binary(op, a, b, v, bar),
            },
            Node::Select(_, yes, no) => {
                for (side, x) in [(0, yes), (1, no)] {
                    self.add(x, self.guards.side(v, side), bar);
                }
            }
            node @ Node::If(_) => {
                let list = node.list().unwrap_or(0..0);
                let sides: Vec<Value> = self.builder.arguments[list]
                    .iter()
                    .skip(1)
                    .copied()
                    .collect();
                for (side, x) in (0u8..).zip(sides) {
                    self.add(x, self.guards.side(v, side), bar);
                }
            }
            Node::Lookup { table, order, x } => {
                let table = self.builder.tables[table as usize].clone();
                let slope = self.builder.lookup(&table, order + 1, x);
                let part = self.op(Mul, bar, slope);
                self.add(x, here, part);
            }
            node @ Node::Call { function, .. } => {
                let list = node.list().unwrap_or(0..0);
                let args = self.builder.arguments[list].to_vec();
                self.call(function, &args, v, bar);
            }
            Node::Partial { .. } => {
                unreachable!("partial derivatives were expanded before the sweep")
            }
        }
    }

    /// Records √(1 − x²).
    fn root_of_one_less_square(&mut self, x: Value) -> Value {
        let one = self.constant(1.0);
        let square = self.op(Mul, x, x);
        let rest = self.op(Sub, one, square);
        self.apply(UnaryOp::Sqrt, rest)
    }

    fn binary(&mut self, op: BinaryOp, a: Value, b: Value, v: Value, bar: Value) {
        let here = self.guards.of[v.index()];
        let (to_a, to_b) = (self.active[a.index()], self.active[b.index()]);
        match op {
            BinaryOp::Add => {
                self.add(a, here, bar);
                self.add(b, here, bar);
            }
            BinaryOp::Sub => {
                self.add(a, here, bar);
                let minus = self.negative(bar);
                self.add(b, here, minus);
            }
            BinaryOp::Mul if a == b => {
                let part = self.times(bar, 2.0);
                let part = self.op(Mul, part, a);
                self.add(a, here, part);
            }
            BinaryOp::Mul => {
                for (x, other) in [(a, b), (b, a)] {
                    if self.active[x.index()] {
                        let part = self.op(Mul, bar, other);
                        self.add(x, here, part);
                    }
                }
            }
            BinaryOp::Div => {
                // q = a/b: dq = (da − q db)/b
                let part = self.op(Div, bar, b);
                self.add(a, here, part);
                if to_b {
                    let part = self.op(Mul, part, v);
                    let part = self.negative(part);
                    self.add(b, here, part);
                }
            }
            BinaryOp::Pow => {
                if to_a {
                    let slope = self.power_slope(a, b, v);
                    let part = self.op(Mul, bar, slope);
                    self.add(a, here, part);
                }
                if to_b {
                    let logarithm = self.builder.unary(UnaryOp::Ln, a);
                    let slope = self.op(Mul, v, logarithm);
                    let part = self.op(Mul, bar, slope);
                    self.add(b, here, part);
                }
            }
            BinaryOp::Atan2 => self.atan2(a, b, v, bar),
            BinaryOp::Rem => {
                self.add(a, here, bar);
                if to_b {
                    let whole = self.op(Sub, a, v);
                    let turns = self.op(Div, whole, b);
                    let turns = self.builder.unary(UnaryOp::Round, turns);
                    let part = self.op(Mul, bar, turns);
                    let part = self.negative(part);
                    self.add(b, here, part);
                }
            }
            BinaryOp::Along => {
                let part = self.op(Along, bar, b);
                self.add(a, here, part);
            }
            BinaryOp::Kept => self.add(a, here, bar),
            BinaryOp::And | BinaryOp::Or => {}
        }
    }

    /// Records `b aᵇ⁻¹`, from the power itself where the base is not zero.
    fn power_slope(&mut self, a: Value, b: Value, v: Value) -> Value {
        let [zero, one] = [0.0, 1.0].map(|c| self.builder.constant(c));
        let quotient = self.op(Div, v, a);
        let quotient = self.op(Mul, b, quotient);
        let less = self.op(Sub, b, one);
        let power = self.builder.binary(BinaryOp::Pow, a, less);
        let at_zero = self.op(Mul, b, power);
        let is_zero = self.builder.compare(Comparison::Eq, a, zero);
        self.builder.select(is_zero, at_zero, quotient)
    }

    /// Passes on the bar of v = angle of (x, y): dv = (x dy − y dx)/(x² + y²)
    fn atan2(&mut self, y: Value, x: Value, v: Value, bar: Value) {
        let here = self.guards.of[v.index()];
        let (yy, xx) = (self.op(Mul, y, y), self.op(Mul, x, x));
        let square = self.op(Add, xx, yy);
        let part = self.op(Div, bar, square);
        let to_y = self.op(Mul, part, x);
        self.add(y, here, to_y);
        let to_x = self.op(Mul, part, y);
        let to_x = self.negative(to_x);
        self.add(x, here, to_x);
    }

    fn call(&mut self, function: Function, args: &[Value], v: Value, bar: Value) {
        let here = self.guards.of[v.index()];
        let zero = self.builder.constant(0.0);
        match (function, args) {
            (Function::Max | Function::Min, &[a, b]) => {
                let second = match function {
                    Function::Max => self.builder.compare(Comparison::Lt, a, b),
                    _ => self.builder.compare(Comparison::Lt, b, a),
                };
                let (to_a, to_b) = (
                    self.builder.select(second, zero, bar),
                    self.builder.select(second, bar, zero),
                );
                self.add(a, here, to_a);
                self.add(b, here, to_b);
            }
            (Function::Dim, &[a, b]) => {
                let none = self.builder.compare(Comparison::Le, a, b);
                let to_a = self.builder.select(none, zero, bar);
                self.add(a, here, to_a);
                let to_b = self.negative(to_a);
                self.add(b, here, to_b);
            }
            (Function::Sign, &[a, b]) => {
                let along = self.op(Along, bar, a);
                let against = self.negative(along);
                let flipped = self.builder.compare(Comparison::Lt, b, zero);
                let part = self.builder.select(flipped, against, along);
                self.add(a, here, part);
            }
            (Function::Atan2, &[y, x]) => self.atan2(y, x, v, bar),
            _ => {
                for (k, &x) in (0u32..).zip(args) {
                    if self.active[x.index()] {
                        let slope = self.builder.partial(v, k);
                        let part = self.op(Mul, bar, slope);
                        self.add(x, here, part);
                    }
                }
            }
        }
    }

    /// Adds a contribution to the bar of `x`, made by a use of `x` under the guard `from`.
    fn add(&mut self, x: Value, from: GuardIx, contribution: Value) {
        if !self.active[x.index()] {
            return;
        }
        let (mut guard, mut contribution) = (from, contribution);
        let zero = self.builder.constant(0.0);
        while guard != self.guards.of[x.index()] {
            let side = self.guards.tree[guard as usize];
            let node = self.builder.nodes[side.selection.index()];
            let at = |k: u8| if side.side == k { contribution } else { zero };
            contribution = match node {
                Node::Select(condition, ..) => self.builder.select(condition, at(0), at(1)),
                node => match node.list().map(|list| self.builder.arguments[list.start]) {
                    Some(selector) => self.builder.arithmetic_if(selector, at(0), at(1), at(2)),
                    None => contribution,
                },
            };
            guard = side.parent;
        }
        let bar = &mut self.bars[x.index()];
        *bar = Some(match *bar {
            None => contribution,
            Some(before) => sum(self.builder, before, contribution),
        });
    }

    fn constant(&mut self, c: f64) -> Value {
        self.builder.constant(c)
    }
    fn apply(&mut self, op: UnaryOp, a: Value) -> Value {
        self.builder.unary(op, a)
    }
    fn op(&mut self, op: BinaryOp, a: Value, b: Value) -> Value {
        self.builder.binary(op, a, b)
    }
    fn negative(&mut self, a: Value) -> Value {
        self.builder.unary(UnaryOp::Neg, a)
    }
    /// Records the multiple of a value; of a multiple, the multiple of what is in it.
    fn times(&mut self, a: Value, factor: f64) -> Value {
        if let Node::Binary(Mul, x, y) = self.builder.nodes[a.index()] {
            for (c, other) in [(x, y), (y, x)] {
                if let Some(c) = self.builder.constant_of(c).map(|c| c * factor)
                    && c.is_normal()
                {
                    let factor = self.builder.constant(c);
                    return self.op(Mul, other, factor);
                }
            }
        }
        let factor = self.builder.constant(factor);
        self.op(Mul, a, factor)
    }
}

/// Makes the adjoints of the operations on one number.
macro_rules! adjoints {
    (
        methods {
            $(
                $(#[$doc:meta])*
                $method_op:ident $method:ident, $method_cost:literal, $method_edges:ident, $method_rule:expr;
            )+
        }
        bodies {
            $(
                $(#[$body_doc:meta])*
                $body_op:ident |$x:ident| $body:expr,
                $body_cost:literal, $body_edges:ident, $body_rule:expr;
            )+
        }
    ) => {
        impl<'b> Adjoint<'b> {
            /// Returns the part of `bar` for the operand `x` of an operation with the result `y`.
            fn unary(&mut self, op: UnaryOp, x: Value, y: Value, bar: Value) -> Value {
                type Rule<'b> = fn(&mut Adjoint<'b>, Value, Value, Value) -> Value;
                // nodes are numbered in the order of recording: these two come first
                let _ = [0.0, 1.0].map(|c| self.constant(c));
                let rule: Rule<'b> = match op {
                    $(UnaryOp::$method_op => $method_rule,)+
                    $(UnaryOp::$body_op => $body_rule,)+
                };
                rule(self, x, y, bar)
            }
        }
    };
}
unary_operations!(adjoints);

/// Records `a + b`; two selections by the same condition become one.
fn sum(builder: &mut Builder, a: Value, b: Value) -> Value {
    let (node_a, node_b) = (builder.nodes[a.index()], builder.nodes[b.index()]);
    if let (Node::Select(c, a1, a2), Node::Select(d, b1, b2)) = (node_a, node_b)
        && c == d
    {
        let (yes, no) = (sum(builder, a1, b1), sum(builder, a2, b2));
        return builder.select(c, yes, no);
    }
    if let (Some(la), Some(lb)) = (if_list(builder, &node_a), if_list(builder, &node_b))
        && la[0] == lb[0]
    {
        let [negative, zero, positive] = [1, 2, 3].map(|k| sum(builder, la[k], lb[k]));
        return builder.arithmetic_if(la[0], negative, zero, positive);
    }
    builder.binary(BinaryOp::Add, a, b)
}

fn if_list(builder: &Builder, node: &Node) -> Option<[Value; 4]> {
    match node {
        Node::If(first) => builder
            .arguments
            .get(*first as usize..)?
            .first_chunk()
            .copied(),
        _ => None,
    }
}
