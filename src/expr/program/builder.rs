//! Recording a program: equal parts become one node, constants fold, and nothing is recorded
//! twice.
//!
//! Nodes stand in one vector, operands before their users, and a table of hashes finds equal ones:
//! recording is linear in time. Nothing here depends on the order of a hash map; the same calls
//! make the same program.

use super::hashing::HashMap;
use super::input::Input;
use super::known::{self, Known};
use super::node::{Node, Value};
use super::operation::{BinaryOp, Comparison, UnaryOp, arithmetic_if};
use super::tape::Taped;
use crate::expr::functions::Function;
use crate::scalar::{Scalar, Table};
use std::sync::Arc;

/// The extent to which a builder may simplify.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Folding {
    /// Only what keeps every bit of every result, NaN and signed zeros included: the compiled
    /// expression is the walked one.
    Strict,
    /// Zeros and ones are structure: `0·x → 0`, `x + 0 → x`, `x − x → 0`, `(x + y) − y → x`, `0/x
    /// → 0`. For recorded physics, where a zero is a part that is not there.
    Structural,
    /// Of these only zeros and ones that are factors or terms, which keeps every bit of finite
    /// numbers but for the sign of a zero: neither `(x + y) − y → x` nor `x − x → 0`. For
    /// derivatives of what has been recorded.
    Finite,
}

/// The result of an operation of a number and a value of which nothing need be recorded.
pub(super) enum Trivial {
    /// a number, whatever the value is
    Number(f64),
    /// the value itself
    Operand,
}

impl Folding {
    /// Returns whether zeros are structure.
    fn is_structural(self) -> bool {
        self != Folding::Strict
    }

    /// Returns the result of `c op x` where that is `x` or a number, whatever `x` is.
    #[inline]
    pub(super) fn number_before(self, op: BinaryOp, c: f64) -> Option<Trivial> {
        use BinaryOp::{Add, Along, Div, Mul};
        let is_zero = c == 0.0 && self.is_structural();
        match op {
            Add if is_zero || c == 0.0 && c.is_sign_negative() => Some(Trivial::Operand),
            Mul if c == 1.0 => Some(Trivial::Operand),
            Mul | Div | Along if is_zero => Some(Trivial::Number(0.0)),
            _ => None,
        }
    }

    /// Returns the result of `x op c` where that is `x` or a number, whatever `x` is.
    #[inline]
    pub(super) fn number_behind(self, op: BinaryOp, c: f64) -> Option<Trivial> {
        use BinaryOp::{Add, Div, Kept, Mul, Sub};
        let is_zero = c == 0.0 && self.is_structural();
        match op {
            Add if is_zero || c == 0.0 && c.is_sign_negative() => Some(Trivial::Operand),
            Sub if is_zero || c == 0.0 && c.is_sign_positive() => Some(Trivial::Operand),
            Mul | Div if c == 1.0 => Some(Trivial::Operand),
            Mul if is_zero => Some(Trivial::Number(0.0)),
            Kept if c.is_finite() => Some(Trivial::Operand),
            _ => None,
        }
    }
}

/// Records a program.
#[derive(Debug)]
pub struct Builder {
    folding: Folding,
    pub(super) nodes: Vec<Node>,
    /// operands of nodes with more than three
    pub(super) arguments: Vec<Value>,
    pub(super) inputs: Vec<Input>,
    pub(super) tables: Vec<Arc<dyn Table>>,
    input_nodes: HashMap<Input, Value>,
    /// places at which nodes are found again
    pub(super) known: Known,
    /// what was asked before, or is asked now
    pub(super) taped: Option<Box<Taped>>,
    /// how many components that share no operation may be recorded, as far as is known
    pub(super) n_components: usize,
}

impl Builder {
    /// Makes an empty builder.
    pub fn new(folding: Folding) -> Self {
        Self {
            folding,
            nodes: Vec::new(),
            arguments: Vec::new(),
            inputs: Vec::new(),
            tables: Vec::new(),
            input_nodes: HashMap::default(),
            known: Known::default(),
            taped: None,
            n_components: 1,
        }
    }

    /// Tells how many components may be recorded that share no operation.
    #[cfg(feature = "solver")]
    pub(crate) fn expect_components(&mut self, n: usize) {
        self.n_components = n;
    }

    /// Returns how far it simplifies.
    pub fn folding(&self) -> Folding {
        self.folding
    }
    /// Sets how far it simplifies from now on; what is recorded stays.
    pub fn set_folding(&mut self, folding: Folding) {
        if folding != self.folding {
            // a tape is of one folding
            self.leave_tape();
            self.taped = None;
        }
        self.folding = folding;
    }
    /// Returns how many nodes are recorded, needed or not.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }
    /// Returns whether nothing is recorded yet.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }
    /// Returns the inputs asked for, in the order of asking.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }
    /// Returns the number a value is, when it is a constant.
    pub fn constant_of(&self, v: Value) -> Option<f64> {
        match self.nodes[v.index()] {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }
    /// Returns the input a value is, when it is one.
    pub fn input_of(&self, v: Value) -> Option<Input> {
        match self.nodes[v.index()] {
            Node::Input(k) => Some(self.inputs[k as usize]),
            _ => None,
        }
    }

    /// Records an input, which the host supplies; the same input is the same value.
    pub fn input(&mut self, input: Input) -> Value {
        if let Some(&v) = self.input_nodes.get(&input) {
            return v;
        }
        self.tape_input(input);
        let k = self.inputs.len() as u32;
        self.inputs.push(input);
        let v = Value(self.nodes.len() as u32);
        self.nodes.push(Node::Input(k));
        self.input_nodes.insert(input, v);
        v
    }

    /// Records a number.
    pub fn constant(&mut self, x: f64) -> Value {
        self.reads_number();
        self.intern(Node::Constant(x.to_bits()))
    }

    /// Records an operation on one value.
    pub fn unary(&mut self, op: UnaryOp, x: Value) -> Value {
        if let Some(c) = self.constant_of(x) {
            return self.constant(op.apply(c));
        }
        match (op, self.nodes[x.index()]) {
            (UnaryOp::Neg, Node::Unary(UnaryOp::Neg, y)) => y,
            (UnaryOp::Abs, Node::Unary(UnaryOp::Neg, y)) => self.unary(UnaryOp::Abs, y),
            (UnaryOp::Abs, Node::Unary(UnaryOp::Abs, _)) => x,
            (UnaryOp::Not, Node::Unary(UnaryOp::Not, y)) => y,
            _ => self.intern(Node::Unary(op, x)),
        }
    }

    /// Records a power with a whole exponent.
    pub fn powi(&mut self, x: Value, n: i32) -> Value {
        if let Some(c) = self.constant_of(x) {
            return self.constant(Scalar::powi(c, n));
        }
        match n {
            0 => self.constant(1.0),
            1 => x,
            2 => self.binary(BinaryOp::Mul, x, x),
            _ => self.intern(Node::Whole(x, n)),
        }
    }

    /// Records an operation on two values.
    pub fn binary(&mut self, op: BinaryOp, a: Value, b: Value) -> Value {
        let (ca, cb) = (self.constant_of(a), self.constant_of(b));
        if let (Some(x), Some(y)) = (ca, cb) {
            return self.constant(op.apply(x, y));
        }
        if ca.is_some() || cb.is_some() {
            self.reads_number();
            if !is_one_of_many(op, ca, cb) {
                return self.binary_anew(op, a, b, [ca, cb]);
            }
        }
        self.binary_by_tape(op, a, b, [ca, cb])
    }

    /// Records an operation on two values, whatever was asked before. Not both are constant.
    #[inline]
    pub(super) fn binary_anew(
        &mut self,
        op: BinaryOp,
        a: Value,
        b: Value,
        [ca, cb]: [Option<f64>; 2],
    ) -> Value {
        use BinaryOp::{Add, And, Mul, Or};
        if !self.stays(op, [a, b], [ca, cb])
            && let Some(v) = self.simpler(op, a, b, ca, cb)
        {
            return v;
        }
        let swap = matches!(op, Add | Mul | And | Or) && b < a;
        let (a, b) = if swap { (b, a) } else { (a, b) };
        self.intern(Node::Binary(op, a, b))
    }

    /// Returns whether it is plain at once that nothing simplifies an operation, as of most.
    #[inline]
    fn stays(&self, op: BinaryOp, [a, b]: [Value; 2], [ca, cb]: [Option<f64>; 2]) -> bool {
        use BinaryOp::{Add, Mul, Sub};
        let has_number = ca.is_some() || cb.is_some();
        let is_sum = matches!(op, Add | Sub);
        let is_factor = op == Mul && has_number;
        let is_plain = |v: Value| match self.nodes[v.index()] {
            Node::Unary(UnaryOp::Neg, _) => false,
            Node::Binary(Add | Sub, ..) => !is_sum,
            Node::Binary(Mul, ..) => !is_factor,
            _ => true,
        };
        a != b && is_plain(a) && is_plain(b) && (!has_number || is_one_of_many(op, ca, cb))
    }

    /// Records the same value by less, if the folding allows it. Not both operands are constant.
    fn simpler(
        &mut self,
        op: BinaryOp,
        a: Value,
        b: Value,
        ca: Option<f64>,
        cb: Option<f64>,
    ) -> Option<Value> {
        use BinaryOp::{Div, Mul, Pow, Sub};
        let structural = self.folding.is_structural();
        // a number that is none does not cancel
        let cancels = self.folding == Folding::Structural;
        let before = ca.and_then(|c| Some((b, self.folding.number_before(op, c)?)));
        let behind = || cb.and_then(|c| Some((a, self.folding.number_behind(op, c)?)));
        match before.or_else(behind) {
            Some((operand, Trivial::Operand)) => return Some(operand),
            Some((_, Trivial::Number(c))) => return Some(self.constant(c)),
            None => {}
        }
        match op {
            Sub if ca == Some(0.0) && (structural || ca.is_some_and(f64::is_sign_negative)) => {
                return Some(self.unary(UnaryOp::Neg, b));
            }
            Sub if cancels && a == b => return Some(self.constant(0.0)),
            Mul | Div if cb == Some(-1.0) => return Some(self.unary(UnaryOp::Neg, a)),
            Mul if ca == Some(-1.0) => return Some(self.unary(UnaryOp::Neg, b)),
            Div if cancels && a == b => return Some(self.constant(1.0)),
            // a power of two divides as its reciprocal multiplies, to the bit
            Div if cb.is_some_and(is_power_of_two) => {
                let reciprocal = self.constant(1.0 / cb?);
                return Some(self.binary(Mul, a, reciprocal));
            }
            Pow => return self.simpler_power(a, cb?),
            _ => {}
        }
        if cancels && let Some(v) = self.cancelled(op, a, b, ca, cb) {
            return Some(v);
        }
        self.without_minus_signs(op, a, b, ca, cb)
    }

    /// Records the same value with minus signs moved outward or into constants: a + (−b) is a − b
    /// to the bit, and so on.
    fn without_minus_signs(
        &mut self,
        op: BinaryOp,
        a: Value,
        b: Value,
        ca: Option<f64>,
        cb: Option<f64>,
    ) -> Option<Value> {
        use BinaryOp::{Add, Along, Div, Mul, Sub};
        let structural = self.folding.is_structural();
        let negated = |v: Value| match self.nodes[v.index()] {
            Node::Unary(UnaryOp::Neg, y) => Some(y),
            _ => None,
        };
        let (na, nb) = (negated(a), negated(b));
        match (op, na, nb) {
            (Add, _, Some(y)) => Some(self.binary(Sub, a, y)),
            (Add, Some(y), None) => Some(self.binary(Sub, b, y)),
            (Sub, _, Some(y)) => Some(self.binary(Add, a, y)),
            (Mul | Div, Some(x), Some(y)) => Some(self.binary(op, x, y)),
            (Along, Some(x), _) if structural => {
                let along = self.binary(Along, x, b);
                Some(self.unary(UnaryOp::Neg, along))
            }
            // −x − b is −(x + b) but for the sign of a zero sum
            (Sub, Some(x), None) if structural => {
                let sum = self.binary(Add, x, b);
                Some(self.unary(UnaryOp::Neg, sum))
            }
            // the sign goes into a constant
            (Mul | Div, Some(x), None) if cb.is_some() => {
                let minus = self.constant(-cb?);
                Some(self.binary(op, x, minus))
            }
            (Mul | Div, None, Some(y)) if ca.is_some() => {
                let minus = self.constant(-ca?);
                Some(self.binary(op, minus, y))
            }
            (Mul | Div, Some(x), None) => {
                let product = self.binary(op, x, b);
                Some(self.unary(UnaryOp::Neg, product))
            }
            (Mul | Div, None, Some(y)) => {
                let product = self.binary(op, a, y);
                Some(self.unary(UnaryOp::Neg, product))
            }
            _ => None,
        }
    }

    /// Sums of which a part goes, and constants that meet: `(x + y) − y → x`, `c₁ (c₂ x) → (c₁ c₂)
    /// x`. That is the arm of a lever, the difference of two places on one part, without the
    /// rounding of these places.
    fn cancelled(
        &mut self,
        op: BinaryOp,
        a: Value,
        b: Value,
        ca: Option<f64>,
        cb: Option<f64>,
    ) -> Option<Value> {
        use BinaryOp::{Add, Mul, Sub};
        let (na, nb) = (self.nodes[a.index()], self.nodes[b.index()]);
        match (op, na, nb) {
            (Sub, Node::Binary(Add, x, y), _) if y == b => return Some(x),
            (Sub, Node::Binary(Add, x, y), _) if x == b => return Some(y),
            (Sub, Node::Binary(Sub, x, y), _) if x == b => {
                return Some(self.unary(UnaryOp::Neg, y));
            }
            (Sub, _, Node::Binary(Add, x, y)) if x == a => {
                return Some(self.unary(UnaryOp::Neg, y));
            }
            (Sub, _, Node::Binary(Add, x, y)) if y == a => {
                return Some(self.unary(UnaryOp::Neg, x));
            }
            (Sub, _, Node::Binary(Sub, x, y)) if x == a => return Some(y),
            (Add, Node::Binary(Sub, x, y), _) if y == b => return Some(x),
            (Add, _, Node::Binary(Sub, x, y)) if y == a => return Some(x),
            _ => {}
        }
        // a constant and an operation with another
        let (c, other, first) = match (ca, cb) {
            (Some(c), None) => (c, nb, true),
            (None, Some(c)) => (c, na, false),
            _ => return None,
        };
        let Node::Binary(inner, x, y) = other else {
            return None;
        };
        let (cx, cy) = (self.constant_of(x), self.constant_of(y));
        if let (Mul, Mul) = (op, inner) {
            let (k, v) = cx.map(|k| (k, y)).or(cy.map(|k| (k, x)))?;
            self.reads_number();
            let both = c * k;
            return both.is_normal().then(|| {
                let both = self.constant(both);
                self.binary(Mul, both, v)
            });
        }
        // the other is k + v or k − v
        let (k, plus, v) = match (inner, cx, cy) {
            (Add, Some(k), _) => (k, true, y),
            (Add, _, Some(k)) => (k, true, x),
            (Sub, Some(k), _) => (k, false, y),
            (Sub, _, Some(k)) => (-k, true, x),
            _ => return None,
        };
        let (sum, plus) = match op {
            Add => (c + k, plus),
            Sub if first => (c - k, !plus),
            Sub => (k - c, plus),
            _ => return None,
        };
        self.reads_number();
        (sum.is_normal() || sum == 0.0).then(|| {
            let sum = self.constant(sum);
            self.binary(if plus { Add } else { Sub }, sum, v)
        })
    }

    /// Records a power with a constant exponent, by the same multiplications and roots that
    /// `f64`'s `powf` uses.
    fn simpler_power(&mut self, a: Value, exponent: f64) -> Option<Value> {
        use crate::scalar::Exponent;
        match Exponent::of(exponent) {
            Exponent::Whole(n) => Some(self.powi(a, n)),
            Exponent::Half(n) => {
                let root = self.unary(UnaryOp::Sqrt, a);
                let whole = self.powi(a, n);
                Some(self.binary(BinaryOp::Mul, whole, root))
            }
            Exponent::Other => None,
        }
    }

    /// Returns base and `n ≥ 1` of a product that is `xⁿ √x`. At x = 0 the root has no finite
    /// derivative, the product has.
    #[inline]
    pub(super) fn half_power(&self, node: &Node) -> Option<(Value, i32)> {
        let Node::Binary(BinaryOp::Mul, a, b) = *node else {
            return None;
        };
        let of_factors = |whole: Value, root: Value| {
            let Node::Unary(UnaryOp::Sqrt, x) = self.nodes[root.index()] else {
                return None;
            };
            match self.nodes[whole.index()] {
                _ if whole == x => Some((x, 1)),
                Node::Binary(BinaryOp::Mul, y, z) if y == x && z == x => Some((x, 2)),
                Node::Whole(y, n) if y == x && n > 0 => Some((x, n)),
                _ => None,
            }
        };
        of_factors(a, b).or_else(|| of_factors(b, a))
    }

    /// Records a comparison, as a condition: 1 or 0.
    pub fn compare(&mut self, comparison: Comparison, a: Value, b: Value) -> Value {
        if let (Some(x), Some(y)) = (self.constant_of(a), self.constant_of(b)) {
            let holds = comparison.apply(x, y);
            return self.constant(f64::from(u8::from(holds)));
        }
        if a == b && comparison == Comparison::Lt {
            return self.constant(0.0);
        }
        if a == b && self.folding == Folding::Structural {
            return self.constant(1.0);
        }
        // "0 < condition" is the condition
        if comparison == Comparison::Lt && self.constant_of(a) == Some(0.0) && self.is_condition(b)
        {
            return b;
        }
        let swap = comparison == Comparison::Eq && b < a;
        let (a, b) = if swap { (b, a) } else { (a, b) };
        self.intern(Node::Compare(comparison, a, b))
    }

    /// Returns whether a value is 0 or 1 by construction.
    fn is_condition(&self, v: Value) -> bool {
        match self.nodes[v.index()] {
            Node::Compare(..) | Node::Unary(UnaryOp::Not, _) => true,
            Node::Binary(op, ..) => matches!(op, BinaryOp::And | BinaryOp::Or),
            Node::Constant(bits) => bits == 0 || bits == 1.0f64.to_bits(),
            _ => false,
        }
    }

    /// Records that both conditions hold.
    pub fn and(&mut self, a: Value, b: Value) -> Value {
        match (self.constant_of(a), self.constant_of(b)) {
            (Some(0.0), _) | (_, Some(0.0)) => self.constant(0.0),
            (Some(_), _) => b,
            (_, Some(_)) => a,
            _ if a == b => a,
            _ => self.binary(BinaryOp::And, a, b),
        }
    }
    /// Records that either condition holds.
    pub fn or(&mut self, a: Value, b: Value) -> Value {
        match (self.constant_of(a), self.constant_of(b)) {
            (Some(0.0), _) => b,
            (_, Some(0.0)) => a,
            (Some(_), _) | (_, Some(_)) => self.constant(1.0),
            _ if a == b => a,
            _ => self.binary(BinaryOp::Or, a, b),
        }
    }
    /// Records the contrary of a condition.
    pub fn not(&mut self, a: Value) -> Value {
        self.unary(UnaryOp::Not, a)
    }

    /// Records a selection: `yes` where the condition is not 0, else `no`.
    pub fn select(&mut self, condition: Value, yes: Value, no: Value) -> Value {
        if let Some(c) = self.constant_of(condition) {
            return if 0.0 < c { yes } else { no };
        }
        if yes == no {
            return yes;
        }
        // "condition ? 1 : 0" is the condition
        let is = |v: Value, c: f64| self.nodes[v.index()] == Node::Constant(c.to_bits());
        if is(yes, 1.0) && is(no, 0.0) && self.is_condition(condition) {
            return condition;
        }
        if let Node::Unary(UnaryOp::Not, contrary) = self.nodes[condition.index()] {
            return self.select(contrary, no, yes);
        }
        self.intern(Node::Select(condition, yes, no))
    }

    /// Records `IF(selector: negative, zero, positive)`; NaN where the selector is NaN.
    pub fn arithmetic_if(
        &mut self,
        selector: Value,
        negative: Value,
        zero: Value,
        positive: Value,
    ) -> Value {
        if let Some(s) = self.constant_of(selector) {
            // which of the three, by the same rule that runs later
            let pick = arithmetic_if(s, 1.0, 2.0, 3.0);
            return match pick {
                1.0 => negative,
                2.0 => zero,
                3.0 => positive,
                _ => self.constant(f64::NAN),
            };
        }
        if self.folding.is_structural() && negative == zero && zero == positive {
            return zero;
        }
        let first = self.arguments.len() as u32;
        self.arguments.extend([selector, negative, zero, positive]);
        self.intern(Node::If(first))
    }

    /// Records the value or a derivative of a table at `x`.
    pub fn lookup(&mut self, table: &Arc<dyn Table>, order: u32, x: Value) -> Value {
        if let Some(c) = self.constant_of(x) {
            return self.constant(table.at(c, order));
        }
        let k = self
            .tables
            .iter()
            .position(|t| Arc::ptr_eq(t, table))
            .unwrap_or_else(|| {
                self.tables.push(table.clone());
                self.tables.len() - 1
            });
        self.intern(Node::Lookup {
            table: k as u32,
            order,
            x,
        })
    }

    /// Records a function of the table as one operation.
    pub fn call(&mut self, function: Function, args: &[Value]) -> Value {
        let mut numbers = [0.0; 40];
        if args.len() <= numbers.len() {
            let constants =
                args.iter()
                    .zip(&mut numbers)
                    .all(|(&v, slot)| match self.constant_of(v) {
                        Some(c) => {
                            *slot = c;
                            true
                        }
                        None => false,
                    });
            if constants {
                return self.constant(function.eval(&numbers[..args.len()]));
            }
        }
        let first = self.arguments.len() as u32;
        self.arguments.extend_from_slice(args);
        self.intern(Node::Call {
            function,
            first,
            count: args.len() as u32,
        })
    }

    /// Returns the node, or the equal one that is there already. Arguments of a list node must be
    /// the last of the list.
    pub(super) fn intern(&mut self, node: Node) -> Value {
        if self.taped.is_none() {
            return self.found_or_new(node);
        }
        if let Some(answer) = self.node_by_tape(node) {
            return answer;
        }
        self.leave_tape();
        self.write_list(&node);
        let answer = self.found_or_new(node);
        self.write_node(node, answer);
        answer
    }

    /// Returns the node that equals this one, or records it; arguments of a node that is known are
    /// taken from the end of the list.
    pub(super) fn found_or_new(&mut self, node: Node) -> Value {
        let newest = self.newest_operand(&node);
        let (nodes, arguments) = (&self.nodes, &self.arguments);
        let is_equal = |found: usize| known::equal(arguments, &nodes[found], &node);
        let new = nodes.len() as u32;
        let among_users = newest.map(|k| (k, self.known.user(k, is_equal)));
        let found = match among_users {
            Some((_, (Some(found), _))) => Ok(found),
            Some((newest, (None, true))) => {
                self.known.add_user(newest, new);
                Err(())
            }
            Some((_, (None, false))) | None => {
                let hash = known::hash(&self.arguments, &node) as u32;
                let slot = self.known.slot(hash, is_equal);
                slot.map_err(|slot| self.known.fill(slot, hash, new))
            }
        };
        match found {
            Ok(found) => {
                if let Some(range) = node.list() {
                    self.arguments.truncate(range.start);
                }
                Value(found)
            }
            Err(()) => {
                self.nodes.push(node);
                Value(new)
            }
        }
    }

    /// Finds a place for each node, after a tape has told where they are.
    pub(super) fn find_again(&mut self) {
        let mut again = Known::default();
        for (k, node) in self.nodes.iter().enumerate() {
            if matches!(node, Node::Input(_)) {
                continue;
            }
            let among_users = |newest: &usize| again.user(*newest, |_| false).1;
            match self.newest_operand(node).filter(among_users) {
                Some(newest) => again.add_user(newest, k as u32),
                None => {
                    let hash = known::hash(&self.arguments, node) as u32;
                    if let Err(slot) = again.slot(hash, |_| false) {
                        again.fill(slot, hash, k as u32);
                    }
                }
            }
        }
        again.probes = self.known.probes;
        self.known = again;
    }

    /// Returns the index of the operand of a node that was recorded last.
    #[inline]
    fn newest_operand(&self, node: &Node) -> Option<usize> {
        let mut newest = None;
        self.operands(node, |v| newest = newest.max(Some(v.index())));
        newest
    }

    /// Calls `f` with every operand of a node, in order.
    #[inline]
    pub(super) fn operands(&self, node: &Node, mut f: impl FnMut(Value)) {
        match *node {
            Node::Constant(_) | Node::Input(_) => {}
            Node::Unary(_, x) | Node::Whole(x, _) | Node::Lookup { x, .. } => f(x),
            Node::Partial { call, .. } => {
                for &v in &self.arguments[self.nodes[call.index()].list().unwrap_or(0..0)] {
                    f(v);
                }
            }
            Node::Binary(_, a, b) | Node::Compare(_, a, b) => {
                f(a);
                f(b);
            }
            Node::Select(c, yes, no) => {
                f(c);
                f(yes);
                f(no);
            }
            Node::If(_) | Node::Call { .. } => {
                for &v in &self.arguments[node.list().unwrap_or(0..0)] {
                    f(v);
                }
            }
        }
    }
}

/// Returns whether an operation of a value and a number is simplified as with almost every other
/// number there. Not so with 0, 1 and −1, and with divisors that multiply as well.
fn is_one_of_many(op: BinaryOp, ca: Option<f64>, cb: Option<f64>) -> bool {
    use BinaryOp::{Add, Div, Mul, Sub};
    let Some(c) = ca.or(cb) else { return true };
    match op {
        Add | Sub => c != 0.0,
        Div if cb.is_none() => c != 0.0,
        Mul => c != 0.0 && c.abs() != 1.0,
        Div => c != 0.0 && c.abs() != 1.0 && !is_power_of_two(c),
        _ => false,
    }
}

/// Returns whether dividing by `c` is exactly multiplying by `1/c`.
fn is_power_of_two(c: f64) -> bool {
    const FRACTION: u64 = (1 << 52) - 1;
    c.is_normal() && c.to_bits() & FRACTION == 0 && (1.0 / c).is_normal()
}
