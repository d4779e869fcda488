//! Where a program may have a narrow peak: factors that are large only near a maximum of their
//! logarithm.
//!
//! ```text
//! EXP(a)               a               COSH(a), TANH(a)    −2 |a|
//! x**n, n < 0, n ≥ 8   n ln |x|        ATAN(a)             −ln(1 + a²)
//! b/x                  −ln |x|         TAN(a)              −ln |cos a|
//!                                      products            the sum of those of the factors
//! ```
//!
//! A curve through data is narrow where these change within a way much shorter than the next change
//! is away: what rises with each width towards the middle of such a bump stands for the logarithm.
//!
//! TANH and ATAN are steep there: the difference of two of them is a pulse. While the logarithm
//! changes by one the factor changes by a factor of e, so the logarithm is a scale for steps,
//! however narrow the peak is in time or on the way.

use super::builder::Builder;
use super::code::Code;
use super::node::{Node, Value};
use super::operation::{BinaryOp, UnaryOp};
use super::run::Program;
use crate::expr::spline::Piecewise;
use crate::scalar::Table;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Nodes of a product that are looked at, at most.
const MOST_FACTORS: usize = 64;
/// Exponent from which on a power counts as narrow.
const NARROW_POWER: f64 = 8.0;
/// Change of a curve by a bend at a knot, over the range of its values, that is none.
const STRAIGHT: f64 = 1e-6;
/// Distance of bends, in widths of both, up to which they are one bump: a step sees it.
const JOINED: f64 = 12.0;
/// Rise of what stands for the logarithm of a bump with each width: what is zero beside it must be
/// met within a width.
const PER_WIDTH: f64 = 4.0;
/// Bumps of one curve that are looked for, at most.
const MOST_BUMPS: usize = 200;

impl Program {
    /// Returns whether it has operations that may be narrow; most expressions have none.
    pub(crate) fn may_peak(&self) -> bool {
        self.core()
            .code
            .iter()
            .any(|instruction| match instruction.code {
                Code::Unary(op) => matches!(
                    op,
                    UnaryOp::Exp | UnaryOp::Cosh | UnaryOp::Tanh | UnaryOp::Atan | UnaryOp::Tan
                ),
                Code::Binary(op) => matches!(op, BinaryOp::Pow | BinaryOp::Div),
                Code::Whole(_) | Code::HalfPower(_) | Code::Lookup { .. } => true,
                Code::Compare(_)
                | Code::Select
                | Code::CompareSelect(_)
                | Code::If
                | Code::Call(..)
                | Code::Partial(..) => false,
            })
    }
}

impl Builder {
    /// Returns the logarithms of the narrow factors of some outputs, each once: a factor peaks
    /// where one has a maximum.
    pub(crate) fn peaks(&mut self, outputs: &[Value]) -> Vec<Value> {
        let nodes = self.nodes_below(outputs);
        let mut logarithms = BTreeSet::new();
        for k in nodes {
            let node = self.nodes[k];
            let own = self.logarithm(node);
            let all = [own, self.log_of_product(node)];
            let bumps = self.bumps_of(node);
            for log in all.into_iter().flatten().chain(bumps) {
                if !self.inputs_of(&[log]).is_empty() {
                    logarithms.insert(log);
                }
            }
        }
        logarithms.into_iter().collect()
    }

    /// Returns the distances from the bumps of a curve, each in widths of its bump and negative.
    fn bumps_of(&mut self, node: Node) -> Vec<Value> {
        let Node::Lookup { table, order, x } = node else {
            return Vec::new();
        };
        let bumps = bumps(&*self.tables[table as usize], order);
        bumps.iter().map(|b| self.lookup(b, 0, x)).collect()
    }

    /// Returns the logarithm of the size of a narrow factor, up to what does not matter.
    fn logarithm(&mut self, node: Node) -> Option<Value> {
        match node {
            Node::Unary(UnaryOp::Exp, a) => Some(a),
            Node::Unary(UnaryOp::Cosh | UnaryOp::Tanh, a) => {
                let size = self.unary(UnaryOp::Abs, a);
                Some(self.times(-2.0, size))
            }
            Node::Unary(UnaryOp::Atan, a) => {
                let square = self.binary(BinaryOp::Mul, a, a);
                let one = self.constant(1.0);
                let sum = self.binary(BinaryOp::Add, one, square);
                Some(self.log_of_size(-1.0, sum))
            }
            Node::Unary(UnaryOp::Tan, a) => {
                let cosine = self.unary(UnaryOp::Cos, a);
                Some(self.log_of_size(-1.0, cosine))
            }
            Node::Whole(x, n) => self.log_of_power(x, f64::from(n)),
            Node::Binary(BinaryOp::Pow, x, n) => {
                let n = self.constant_of(n)?;
                self.log_of_power(x, n)
            }
            Node::Binary(BinaryOp::Div, _, x) => self.log_of_power(x, -1.0),
            _ => None,
        }
    }

    /// Returns the logarithm of a product of narrow factors, if there are several.
    fn log_of_product(&mut self, node: Node) -> Option<Value> {
        let (mut sum, mut factors) = (None, 0);
        let mut open = vec![node];
        for _ in 0..MOST_FACTORS {
            let Some(node) = open.pop() else { break };
            let log = match node {
                Node::Unary(UnaryOp::Neg, x) => {
                    open.push(self.nodes[x.index()]);
                    continue;
                }
                Node::Binary(BinaryOp::Mul, a, b) => {
                    open.extend([a, b].map(|v| self.nodes[v.index()]));
                    continue;
                }
                Node::Binary(BinaryOp::Div, a, b) => {
                    open.push(self.nodes[a.index()]);
                    Some(self.log_of_size(-1.0, b))
                }
                Node::Unary(UnaryOp::Exp, a) => Some(a),
                Node::Whole(x, n) => Some(self.log_of_size(f64::from(n), x)),
                _ => None,
            };
            let Some(log) = log else { continue };
            factors += 1;
            sum = Some(match sum {
                Some(sum) => self.binary(BinaryOp::Add, sum, log),
                None => log,
            });
        }
        sum.filter(|_| factors > 1 && open.is_empty())
    }

    /// Returns `n ln |x|` if a power is narrow.
    fn log_of_power(&mut self, x: Value, n: f64) -> Option<Value> {
        (!(0.0..NARROW_POWER).contains(&n)).then(|| self.log_of_size(n, x))
    }

    fn log_of_size(&mut self, n: f64, x: Value) -> Value {
        let size = self.unary(UnaryOp::Abs, x);
        let log = self.unary(UnaryOp::Ln, size);
        self.times(n, log)
    }

    fn times(&mut self, n: f64, x: Value) -> Value {
        let n = self.constant(n);
        self.binary(BinaryOp::Mul, n, x)
    }

    /// Returns the places of the nodes that some values need, ascending.
    fn nodes_below(&self, values: &[Value]) -> Vec<usize> {
        let needed = self.needed(values, self.nodes.len());
        (0..needed.len()).filter(|&k| needed[k]).collect()
    }
}

/// Returns the bumps of a curve: for each a curve that rises to its middle by [`PER_WIDTH`] with
/// each width, from one width beside it on. None where the curve bends all the way, or hardly.
fn bumps(table: &dyn Table, order: u32) -> Vec<Arc<dyn Table>> {
    let knots = table.knots();
    let y: Vec<f64> = knots.iter().map(|&x| table.at(x, order)).collect();
    let range = y.iter().fold(f64::NEG_INFINITY, |m, &y| m.max(y))
        - y.iter().fold(f64::INFINITY, |m, &y| m.min(y));
    // bends: where, and the width of the shorter piece beside
    let bend = |k: usize| {
        let [before, after] = [k - 1, k].map(|k| knots[k + 1] - knots[k]);
        let width = before.min(after);
        let change = (y[k + 1] - y[k]) / after - (y[k] - y[k - 1]) / before;
        (change.abs() * width > STRAIGHT * range).then_some((knots[k], width))
    };
    let bends: Vec<(f64, f64)> = (1..knots.len().saturating_sub(1))
        .filter_map(bend)
        .collect();
    let joined = |a: &(f64, f64), b: &(f64, f64)| b.0 - a.0 <= JOINED * (a.1 + b.1);
    let groups: Vec<&[(f64, f64)]> = bends.chunk_by(joined).collect();
    let is_flat = |k: usize| (y[k + 1] - y[k]).abs() <= STRAIGHT * range;
    let ends_flat = knots.len() > 2 && is_flat(0) && is_flat(knots.len() - 2);
    // a curve that goes on bending to its ends has nothing narrow
    if groups.len() < 2 && !ends_flat {
        return Vec::new();
    }
    let tent = |group: &&[(f64, f64)]| {
        let [(first, w0), .., (last, w1)] = group else {
            return None;
        };
        let (width, middle) = (w0.min(*w1), 0.5 * (first + last));
        let height = PER_WIDTH * (1.0 + (middle - first) / width);
        let x = [first - width, middle, last + width];
        let tent = Piecewise::linear(&x, &[0.0, height, 0.0]).ok()?;
        Some(Arc::new(tent) as Arc<dyn Table>)
    };
    groups.iter().take(MOST_BUMPS).filter_map(tent).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::program::{Folding, Input, Program, Work};

    #[test]
    fn a_curve_has_a_bump_where_it_bends_within_a_short_way_and_none_where_it_bends_all_the_way() {
        let of = |x: &[f64], y: &[f64]| {
            let curve = Piecewise::linear(x, y).expect("a curve");
            bumps(&curve, 0)
        };
        let way = [0.0, 4.0, 4.001, 4.002, 4.003, 10.0];
        let bump = of(&way, &[0.0, 0.0, 5.0, 5.0, 0.0, 0.0]);
        assert_eq!(bump.len(), 1);
        let there = [4.0, 4.0015, 4.003, 4.013, 3.99].map(|x| bump[0].at(x, 0).round());
        assert_eq!(there, [4.0, 10.0, 4.0, -36.0, -36.0]);
        let fine: Vec<f64> = (0..50).map(f64::from).collect();
        let waves: Vec<f64> = fine.iter().map(|x| (2.0 * x).sin()).collect();
        assert!(of(&fine, &waves).is_empty());
        let straight: Vec<f64> = fine.iter().map(|x| 3.0 * x).collect();
        assert!(of(&fine, &straight).is_empty());
    }

    #[test]
    fn what_may_not_peak_has_no_peaks() {
        use crate::expr::{Expr, functions::Function, interpolation::Bindings};
        let examples = Function::ALL.iter().flat_map(|f| f.row().examples);
        let mut texts: Vec<String> = examples.map(|e| e.source.to_string()).collect();
        // every number of an example in turn is something that varies
        for k in 0..texts.len() {
            for digit in "0123456789".chars() {
                texts.push(texts[k].replacen(digit, "DX(1,2)", 1));
            }
        }
        for text in ["SIN(TIME)*DX(1,2)", "IF(TIME-1: TIME, 0, 2*TIME)"] {
            texts.push(text.into());
        }
        let mut calm = 0;
        for text in &texts {
            let Ok(expr) = Expr::parse(text) else {
                continue;
            };
            let Ok(program) = expr.compile(&Bindings::default()) else {
                continue;
            };
            if !program.may_peak() {
                calm += 1;
                let mut builder = Builder::new(Folding::Strict);
                let outputs = program.record(&mut builder);
                assert!(builder.peaks(&outputs).is_empty(), "{text}");
            }
        }
        assert!(calm > 20, "{calm}");
    }

    /// The logarithms of what `f` records over one input, as a program.
    fn logs(f: impl FnOnce(&mut Builder, Value) -> Value) -> Program {
        let mut builder = Builder::new(Folding::Strict);
        let x = builder.input(Input::Slot(0));
        let value = f(&mut builder, x);
        let peaks = builder.peaks(&[value]);
        builder.finish_with_inputs(&peaks, &[Input::Slot(0)])
    }

    #[test]
    fn a_bell_shows_its_exponent_and_a_wide_power_nothing() {
        let bell = logs(|b, x| {
            let square = b.powi(x, 2);
            let down = b.unary(UnaryOp::Neg, square);
            b.unary(UnaryOp::Exp, down)
        });
        assert_eq!(bell.value(&[3.0], &mut Work::default()), -9.0);
        assert_eq!(logs(|b, x| b.powi(x, 3)).n_outputs(), 0);
        let narrow = logs(|b, x| b.powi(x, 100));
        assert_eq!(
            narrow.value(&[2.0], &mut Work::default()),
            100.0 * 2f64.ln()
        );
        let steep = logs(|b, x| b.unary(UnaryOp::Tanh, x));
        assert_eq!(steep.value(&[-4.0], &mut Work::default()), -8.0);
    }
}
