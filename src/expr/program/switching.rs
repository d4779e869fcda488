//! Where a program changes branch: the differences whose signs its comparisons and IFs ask for; and
//! the same program with its branches held.
//!
//! A program whose branches are held is smooth as far as its functions are: a method of high order
//! may step across the place where the branch ends, find that place on its interpolant, and go back
//! there.

use super::builder::Builder;
use super::expand::Expand;
use super::input::Input;
use super::node::{Node, Value};
use super::operation::{BinaryOp, Comparison, UnaryOp};

/// The branches of some outputs.
struct Branches {
    /// values that change sign where a branch changes, each once, in the order of recording
    differences: Vec<Value>,
    /// per node: the difference it asks for, and whether with the contrary sign
    asked: Vec<Option<(usize, bool)>>,
}

impl Builder {
    /// Values that change sign where one of the outputs changes branch, each once, in the order of
    /// recording.
    ///
    /// For `a < b` and `a ≤ b` that is `a − b`, for IF its selector, for |x| its argument.
    /// Comparisons for equality are left out, and so are those of zero with what is never negative:
    /// they hold at isolated points only.
    pub fn switching(&mut self, outputs: &[Value]) -> Vec<Value> {
        let outputs = self.expanded(outputs, Expand::Calls);
        self.branches(&outputs).differences
    }

    /// Returns the outputs with the branches of `sources` held, and the values that change sign
    /// where these change, with the others held.
    ///
    /// The decision of a branch is not computed but read: the sign of the `k`-th of these values,
    /// as −1, 0 or 1, from the input `sign(k)`. A root or a power of one of these values goes on
    /// beyond its end as that of the magnitude, with the sign of the value where the power has one:
    /// without that, a step far beyond the end of a contact would see no force anywhere.
    pub fn held(
        &mut self,
        outputs: &[Value],
        sources: &[Value],
        sign: impl Fn(usize) -> Input,
    ) -> (Vec<Value>, Vec<Value>) {
        let Branches { differences, asked } = self.branches(sources);
        let n = self.nodes.len();
        let mut wanted = outputs.to_vec();
        wanted.extend(&differences);
        let needed = self.needed(&wanted, n);
        let zero = self.constant(0.0);
        let mut images: Vec<Value> = (0..n as u32).map(Value).collect();
        let watched = self.watched(&differences, n);
        for k in (0..n).filter(|&k| needed[k]) {
            let of = |v: Value| images[v.index()];
            let Some((which, contrary)) = asked.get(k).copied().flatten() else {
                images[k] = match self.nodes[k] {
                    Node::Unary(UnaryOp::Sqrt, x) if watched[x.index()] => {
                        let magnitude = self.unary(UnaryOp::Abs, of(x));
                        self.unary(UnaryOp::Sqrt, magnitude)
                    }
                    Node::Binary(BinaryOp::Pow, x, e) if watched[x.index()] => {
                        let (x, e) = (of(x), of(e));
                        let magnitude = self.unary(UnaryOp::Abs, x);
                        let power = self.binary(BinaryOp::Pow, magnitude, e);
                        self.binary(BinaryOp::Along, power, x)
                    }
                    _ => self.again(Value(k as u32), of),
                };
                continue;
            };
            let node = self.nodes[k];
            let mut arguments = [zero; 4];
            let mut count = 0;
            self.operands(&node, |v| {
                arguments[count] = of(v);
                count += 1;
            });
            let mut side = self.input(sign(which));
            if contrary {
                side = self.unary(UnaryOp::Neg, side);
            }
            images[k] = match node {
                Node::Compare(op, ..) => self.compare(op, side, zero),
                Node::If(_) => self.arithmetic_if(side, arguments[1], arguments[2], arguments[3]),
                Node::Binary(op, ..) => self.binary(op, arguments[0], side),
                _ => {
                    let negative = self.compare(Comparison::Lt, side, zero);
                    let minus = self.unary(UnaryOp::Neg, arguments[0]);
                    self.select(negative, minus, arguments[0])
                }
            };
        }
        let image = |v: &Value| images[v.index()];
        (
            outputs.iter().map(image).collect(),
            differences.iter().map(image).collect(),
        )
    }

    /// Returns which of the first `n` nodes change sign with one of the differences only: these,
    /// their contraries, and choices of such.
    fn watched(&self, differences: &[Value], n: usize) -> Vec<bool> {
        let mut watched = vec![false; n];
        let mut contrary = super::hashing::HashSet::default();
        for v in differences {
            if let Some(w) = watched.get_mut(v.index()) {
                *w = true;
            }
            if let Node::Binary(BinaryOp::Sub, a, b) = self.nodes[v.index()] {
                contrary.insert((b, a));
            }
        }
        for k in 0..n {
            watched[k] |= match self.nodes[k] {
                Node::Unary(UnaryOp::Neg, x) => watched[x.index()],
                Node::Binary(BinaryOp::Sub, a, b) => contrary.contains(&(a, b)),
                Node::Select(_, a, b) => watched[a.index()] && watched[b.index()],
                _ => false,
            };
        }
        watched
    }

    /// Returns which of the first `n` nodes some values need.
    pub(super) fn needed(&self, values: &[Value], n: usize) -> Vec<bool> {
        let mut needed = vec![false; n];
        for v in values {
            needed[v.index()] = true;
        }
        for k in (0..n).rev() {
            if needed[k] {
                self.operands(&self.nodes[k], |v| needed[v.index()] = true);
            }
        }
        needed
    }

    fn branches(&mut self, outputs: &[Value]) -> Branches {
        let n = self.nodes.len();
        let needed = self.needed(outputs, n);
        let mut differences: Vec<Value> = Vec::new();
        let mut places = super::hashing::HashMap::default();
        let mut by_operands = super::hashing::HashMap::default();
        let mut asked = vec![None; n];
        for k in (0..n).filter(|&k| needed[k]) {
            let difference = match self.nodes[k] {
                Node::Compare(Comparison::Lt | Comparison::Le, a, b) => {
                    if self.is_bound(a, b) {
                        continue;
                    }
                    self.binary(BinaryOp::Sub, a, b)
                }
                Node::If(first) => self.arguments[first as usize],
                Node::Unary(UnaryOp::Abs, x) | Node::Binary(BinaryOp::Along, _, x) => x,
                _ => continue,
            };
            if self.constant_of(difference).is_some() {
                continue;
            }
            let (plain, contrary) = match self.nodes[difference.index()] {
                Node::Unary(UnaryOp::Neg, x) => (x, true),
                // b − a has the contrary sign of a − b, to the bit
                Node::Binary(BinaryOp::Sub, a, b) => match by_operands.get(&(b, a)) {
                    Some(&before) => (before, true),
                    None => {
                        by_operands.insert((a, b), difference);
                        (difference, false)
                    }
                },
                _ => (difference, false),
            };
            let which = *places.entry(plain).or_insert_with(|| {
                differences.push(plain);
                differences.len() - 1
            });
            asked[k] = Some((which, contrary));
        }
        Branches { differences, asked }
    }

    /// Returns whether one of two compared values is zero and the other is never negative, whatever
    /// the inputs.
    fn is_bound(&self, a: Value, b: Value) -> bool {
        let zero = |v: Value| self.constant_of(v) == Some(0.0);
        zero(b) && self.never_negative(a, 8) || zero(a) && self.never_negative(b, 8)
    }

    /// Returns whether a value is never negative by construction, looking `depth` operations deep.
    fn never_negative(&self, v: Value, depth: usize) -> bool {
        if depth == 0 {
            return false;
        }
        match self.nodes[v.index()] {
            Node::Constant(bits) => f64::from_bits(bits) >= 0.0,
            Node::Unary(UnaryOp::Abs | UnaryOp::Sqrt | UnaryOp::Exp, _) => true,
            Node::Whole(_, n) => n % 2 == 0,
            Node::Binary(BinaryOp::Mul, a, b) if a == b => true,
            Node::Binary(BinaryOp::Add | BinaryOp::Mul | BinaryOp::Div, a, b) => {
                self.never_negative(a, depth - 1) && self.never_negative(b, depth - 1)
            }
            Node::Select(_, a, b) => {
                self.never_negative(a, depth - 1) && self.never_negative(b, depth - 1)
            }
            _ => false,
        }
    }
}
