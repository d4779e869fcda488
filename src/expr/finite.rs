//! Operands without a finite value that an operation can lose: `1/(1/TIME)` at 0 is 0 to a
//! processor, and has no value in the language.
//!
//! The walker stops at the first operation that has no finite value. A program has no such test at
//! each step: infinities and NaN run on, and the result tells. That fails where an operation makes
//! a number of them, as a division by infinity or MIN do. Here stands, from the tree alone, which
//! operands can be without value and which operations can lose them; the compiler keeps the result
//! with such an operand (`BinaryOp::Kept`): it has no value where the operand has none, no bit of
//! it changes elsewhere, and its derivatives are its own. Expressions without such an operand cost
//! nothing.
//!
//! Inputs are finite: the host sees to that. A sum or a product that is too large for a number
//! counts as finite unless an operand is at risk.

use super::ast::{Ast, BinaryOp, Callee, Node, NodeIx};
use super::compile::literal_value;
use super::functions::Function;
use super::interpolation::Interpolation;

/// The worst that a node can be whose inputs are finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Risk {
    /// a number
    None,
    /// NaN, which most operations pass on
    NotANumber,
    /// infinite, or NaN
    Infinite,
}

/// Returns the risk of every node. Operands at risk count as passed on: see [`watched`].
pub(super) fn risks(ast: &Ast) -> Vec<Risk> {
    let mut risks = Vec::with_capacity(ast.nodes.len());
    for node in &ast.nodes {
        let risk = of_node(ast, node, &risks);
        risks.push(risk);
    }
    risks
}

fn of_node(ast: &Ast, node: &Node, risks: &[Risk]) -> Risk {
    let of = |ix: NodeIx| risks.get(ix as usize).copied().unwrap_or(Risk::Infinite);
    match *node {
        Node::Number { .. } | Node::Constant(_) => Risk::None,
        Node::Negate(x) | Node::Plus(x) => of(x),
        Node::Binary(BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul, a, b) => of(a).max(of(b)),
        Node::Binary(BinaryOp::Div, a, b) => match literal(ast, b) {
            Some(divisor) if divisor != 0.0 => of(a),
            _ => Risk::Infinite,
        },
        Node::Binary(BinaryOp::Pow, a, b) => match literal(ast, b) {
            Some(exponent) if exponent < 0.0 => Risk::Infinite,
            Some(exponent) if exponent.fract() != 0.0 => of(a).max(Risk::NotANumber),
            Some(_) => of(a),
            None => Risk::Infinite,
        },
        Node::If {
            selector,
            negative,
            zero,
            positive,
        } => {
            let branches = of(negative).max(of(zero)).max(of(positive));
            branches.max(of(selector).min(Risk::NotANumber))
        }
        Node::Call { callee, ref args } => {
            let worst = args.iter().map(|&a| of(a)).max().unwrap_or(Risk::None);
            of_call(ast, callee, args, worst)
        }
        // variables and constants have values, functions of a caller need not
        Node::Named { ref args, .. } if args.is_empty() => Risk::None,
        Node::Named { .. } => Risk::Infinite,
    }
}

fn of_call(ast: &Ast, callee: Callee, args: &[NodeIx], worst: Risk) -> Risk {
    match callee {
        Callee::Measure(_) => Risk::None,
        Callee::Interpolation(Interpolation::Curve) => Risk::NotANumber,
        Callee::Interpolation(_) => worst.min(Risk::NotANumber),
        Callee::Function(Function::Sqrt | Function::ExpressionSqrt)
            if args.iter().all(|&a| is_not_negative(ast, a)) =>
        {
            worst
        }
        Callee::Function(f) => match handling(f) {
            Handling::Unbounded => Risk::Infinite,
            Handling::Passes => worst,
            Handling::PassesWithDomain => worst.max(Risk::NotANumber),
            Handling::LosesInfinity | Handling::Loses => {
                // literals outside the domain are refused where the text is read, but for
                // branches of an IF, which need not be reached
                let known = |&a: &NodeIx| literal(ast, a).unwrap_or(f64::NAN);
                let known: Vec<f64> = args.iter().map(known).collect();
                let parameters = known.get(1..).unwrap_or_default();
                let fixed = match f {
                    // the point (0, 0) has no angle, and a division by 0 no remainder
                    Function::Atan2 | Function::Mod => parameters.iter().any(|x| x.abs() > 0.0),
                    _ => !parameters.iter().any(|x| x.is_nan()) && f.violation(&known).is_none(),
                };
                let own = if fixed { Risk::None } else { Risk::NotANumber };
                own.max(worst.min(Risk::NotANumber))
            }
        },
    }
}

/// The effect of a function on arguments without value.
enum Handling {
    /// no number; of a number always one
    Passes,
    /// no number; it has none for some numbers either
    PassesWithDomain,
    /// no number of NaN, but perhaps one of infinity
    LosesInfinity,
    /// perhaps a number
    Loses,
    /// perhaps a number of infinity; infinite for some numbers
    Unbounded,
}

fn handling(function: Function) -> Handling {
    use Function as F;
    match function {
        F::Abs | F::Aint | F::Anint | F::Nint | F::Sin | F::Cos | F::Tan => Handling::Passes,
        F::SinDegrees | F::CosDegrees | F::TanDegrees | F::Degrees | F::Radians => Handling::Passes,
        F::ExpressionAbs | F::Int | F::Ent | F::Frac => Handling::Passes,
        F::Sqrt | F::Acos | F::Asin => Handling::PassesWithDomain,
        F::ExpressionSqrt | F::AsinDegrees | F::AcosDegrees => Handling::PassesWithDomain,
        F::Log | F::Log10 | F::Ln | F::CommonLog => Handling::Unbounded,
        F::Exp | F::Sinh | F::Cosh | F::ExpressionExp | F::Antilog => Handling::Unbounded,
        F::Min | F::Max | F::Dim | F::Sign | F::Mod | F::Atan2 => Handling::LosesInfinity,
        F::Atan | F::AtanDegrees | F::Tanh | F::SignOf => Handling::LosesInfinity,
        F::Bistop | F::Impact | F::Step | F::Step5 | F::Havsin | F::Sweep => Handling::Loses,
        F::Cheby | F::Forcos | F::Forsin | F::Poly | F::Shf | F::Delay => Handling::Loses,
    }
}

/// Calls `watch` for every operand of a node that is at risk and that the node can lose;
/// `is_same` tells of two operands if they are one value.
pub(super) fn watched(
    ast: &Ast,
    node: &Node,
    risks: &[Risk],
    is_same: impl Fn(NodeIx, NodeIx) -> bool,
    mut watch: impl FnMut(NodeIx),
) {
    let mut from = |least: Risk, ix: NodeIx| {
        if risks.get(ix as usize).is_some_and(|&risk| risk >= least) {
            watch(ix);
        }
    };
    match *node {
        Node::Binary(BinaryOp::Div, _, divisor) => from(Risk::Infinite, divisor),
        // recorded equations take 0·x for 0, and x − x
        Node::Binary(BinaryOp::Mul, a, b) => {
            if literal(ast, a) == Some(0.0) {
                from(Risk::NotANumber, b);
            }
            if literal(ast, b) == Some(0.0) {
                from(Risk::NotANumber, a);
            }
        }
        Node::Binary(BinaryOp::Sub, a, b) if is_same(a, b) => from(Risk::NotANumber, a),
        Node::Binary(BinaryOp::Pow, base, exponent) => match literal(ast, exponent) {
            Some(e) if e > 0.0 => {}
            Some(e) if e < 0.0 => from(Risk::Infinite, base),
            _ => {
                from(Risk::NotANumber, base);
                from(Risk::NotANumber, exponent);
            }
        },
        Node::If { selector, .. } => from(Risk::Infinite, selector),
        Node::Call {
            callee: Callee::Function(f),
            ref args,
        } => {
            let least = match handling(f) {
                Handling::Passes | Handling::PassesWithDomain => return,
                Handling::LosesInfinity | Handling::Unbounded => Risk::Infinite,
                // the host evaluates what is delayed, at another time
                Handling::Loses if f == Function::Delay => return,
                Handling::Loses => Risk::NotANumber,
            };
            args.iter().for_each(|&arg| from(least, arg));
        }
        Node::Call {
            callee: Callee::Interpolation(_),
            ref args,
        }
        | Node::Named { ref args, .. } => {
            args.iter().for_each(|&arg| from(Risk::NotANumber, arg));
        }
        _ => {}
    }
}

/// Returns whether a node is certainly no negative number, as a sum of squares is none.
fn is_not_negative(ast: &Ast, ix: NodeIx) -> bool {
    use Function as F;
    match *ast.node(ix) {
        Node::Number { literal, .. } => literal >= 0.0,
        Node::Plus(x) => is_not_negative(ast, x),
        Node::Binary(BinaryOp::Add, a, b) => is_not_negative(ast, a) && is_not_negative(ast, b),
        Node::Binary(BinaryOp::Mul, a, b) => {
            let factors = is_not_negative(ast, a) && is_not_negative(ast, b);
            factors || (ast.input(a).is_some() && ast.input(a) == ast.input(b))
        }
        Node::Binary(BinaryOp::Pow, _, b) => literal(ast, b).is_some_and(|e| e % 2.0 == 0.0),
        Node::Call { callee, .. } => matches!(
            callee,
            Callee::Function(F::Abs | F::Exp | F::Sqrt | F::ExpressionAbs | F::ExpressionExp)
        ),
        _ => false,
    }
}

/// Returns the number of a literal, with its sign.
fn literal(ast: &Ast, ix: NodeIx) -> Option<f64> {
    let number = |ix: NodeIx| match *ast.node(ix) {
        Node::Number { literal, degrees } => Some(literal_value(literal, degrees)),
        _ => None,
    };
    match *ast.node(ix) {
        Node::Negate(x) => number(x).map(|x| -x),
        _ => number(ix),
    }
}
