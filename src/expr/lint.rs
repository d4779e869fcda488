//! Warnings about what is legal but probably not meant: degrees for radians, operators that bind
//! otherwise than they look.
//!
//! Only patterns that are hardly ever right are reported; each rule examines one node and its
//! children.

use super::advice;
use super::ast::{Ast, BinaryOp, Callee, Constant, Node, NodeIx};
use super::functions::Function;
use super::measures::Measure;
use crate::diagnostic::{Diagnostic, Severity};
use std::f64::consts::TAU;

/// Returns the warnings about an expression, in the order of its text.
///
/// ```
/// use cognate::expr::{Profile, ast::Dialect, lint, parse};
/// let text = "10*SIN(30)";
/// let warnings = lint(&parse(text, Dialect::Function, Profile::Adams)?, text);
/// assert_eq!((warnings[0].code, warnings[0].column), ("degrees_or_radians", 4));
/// # Ok::<(), cognate::diagnostic::Diagnostic>(())
/// ```
pub fn lint(ast: &Ast, text: &str) -> Vec<Diagnostic> {
    let mut found: Vec<Diagnostic> = Vec::new();
    for (ix, node) in (0..).zip(&ast.nodes) {
        let doubt = match *node {
            Node::Call {
                callee: Callee::Function(f),
                ref args,
            } => angle_argument(ast, f, args),
            Node::Binary(op, a, b) => {
                let loose = |_: &Doubt| !parenthesis_between(ast, text, a, ix);
                precedence(ast, op, a, b)
                    .filter(loose)
                    .or_else(|| angle_difference(ast, op, a, b))
            }
            Node::Negate(x) => negated_power(ast, x, ix, text),
            _ => None,
        };
        if let Some((code, message, help)) = doubt {
            let span = ast.spans.get(ix as usize).copied().unwrap_or_default();
            let said = advice::at(text, code, message, span).help(help);
            found.push(Diagnostic {
                severity: Severity::Warning,
                ..said
            });
        }
    }
    found.sort_by_key(|d| d.column);
    found
}

/// Returns whether there is a parenthesis between the places of two nodes: then their order was
/// written, not left to precedence.
fn parenthesis_between(ast: &Ast, text: &str, first: NodeIx, second: NodeIx) -> bool {
    let start = |ix: NodeIx| ast.spans.get(ix as usize).map_or(0, |span| span.start);
    text.get(start(first)..start(second))
        .is_some_and(|between| between.contains(['(', ')']))
}

/// A warning: code, message, advice.
type Doubt = (&'static str, String, String);

/// Warns of degrees for radians: SIN(30), SIN(360*TIME); in expression functions sin(radians(x)).
fn angle_argument(ast: &Ast, function: Function, args: &[NodeIx]) -> Option<Doubt> {
    use Function as F;
    let &[x] = args else { return None };
    let name = function.name();
    match function {
        F::Sin | F::Cos | F::Tan => {
            let degrees = match *ast.node(x) {
                Node::Binary(BinaryOp::Mul, a, b) => match (ast.node(a), ast.node(b)) {
                    (_, Node::Constant(Constant::Time)) => number(ast, a),
                    (Node::Constant(Constant::Time), _) => number(ast, b),
                    _ => None,
                }
                .filter(|n| n % 90.0 == 0.0),
                _ => number(ast, x),
            };
            let n = degrees.filter(|&n| looks_like_degrees(n))?;
            let message = format!("{name} takes radians, and {n} looks like degrees");
            Some((
                "degrees_or_radians",
                message,
                format!("the suffix D makes degrees of a literal: {n}D"),
            ))
        }
        F::SinDegrees | F::CosDegrees | F::TanDegrees => {
            let turned = matches!(
                ast.node(x),
                Node::Call {
                    callee: Callee::Function(F::Radians),
                    ..
                }
            );
            let message = format!("{name} takes degrees here, and this gives it radians");
            turned.then(|| {
                (
                    "degrees_or_radians",
                    message,
                    "leave radians(...) out".to_string(),
                )
            })
        }
        _ => None,
    }
}

/// Warns of degrees for the radians of an angle: AZ(1,2)-25.
fn angle_difference(ast: &Ast, op: BinaryOp, a: NodeIx, b: NodeIx) -> Option<Doubt> {
    use Measure as M;
    if !matches!(op, BinaryOp::Add | BinaryOp::Sub) {
        return None;
    }
    let angle = |ix| match *ast.node(ix) {
        Node::Call {
            callee: Callee::Measure(m),
            ..
        } => matches!(
            m,
            M::Ax
                | M::Ay
                | M::Az
                | M::Psi
                | M::Theta
                | M::Phi
                | M::Yaw
                | M::Pitch
                | M::Roll
                | M::Incang
        )
        .then_some(m),
        _ => None,
    };
    let (measure, n) = match (angle(a), angle(b)) {
        (Some(m), None) => (m, number(ast, b)?),
        (None, Some(m)) => (m, number(ast, a)?),
        _ => return None,
    };
    let message = format!(
        "{} is in radians, and {n} looks like degrees",
        measure.name()
    );
    let help = format!("the suffix D makes degrees of a literal: {n}D");
    looks_like_degrees(n).then_some(("degrees_or_radians", message, help))
}

/// Warns of `x**1/2`, which is `(x**1)/2`.
fn precedence(ast: &Ast, op: BinaryOp, a: NodeIx, b: NodeIx) -> Option<Doubt> {
    let n = number(ast, b).filter(|n| [2.0, 3.0, 4.0].contains(n))?;
    match *ast.node(a) {
        Node::Binary(BinaryOp::Pow, _, e) if op == BinaryOp::Div && number(ast, e) == Some(1.0) => {
            let message = format!("** binds tighter than /: this is a first power divided by {n}");
            Some((
                "doubtful_precedence",
                message,
                format!("the root is written **(1/{n})"),
            ))
        }
        _ => None,
    }
}

/// Warns of `-2**2`, which is `-(2**2)`.
fn negated_power(ast: &Ast, x: NodeIx, sign: NodeIx, text: &str) -> Option<Doubt> {
    let Node::Binary(BinaryOp::Pow, base, exponent) = *ast.node(x) else {
        return None;
    };
    let even = number(ast, exponent).is_some_and(|e| e % 2.0 == 0.0);
    if !even || number(ast, base).is_none() || parenthesis_between(ast, text, sign, base) {
        return None;
    }
    let message = "** binds tighter than the sign: this is the negative of the power".to_string();
    Some((
        "doubtful_precedence",
        message,
        "a negative base stands in parentheses, as in (-2)**2".to_string(),
    ))
}

/// Returns the value of a literal without suffix.
fn number(ast: &Ast, ix: NodeIx) -> Option<f64> {
    match *ast.node(ix) {
        Node::Number {
            literal,
            degrees: false,
        } => Some(literal),
        Node::Negate(x) => match *ast.node(x) {
            Node::Number {
                literal,
                degrees: false,
            } => Some(-literal),
            _ => None,
        },
        _ => None,
    }
}

/// Returns whether an angle is more than a turn and a multiple of five: hardly radians.
fn looks_like_degrees(n: f64) -> bool {
    n.abs() > TAU
        && n % 5.0 == 0.0
        && n.abs() <= 3600.0
        && ![10.0, 20.0, 50.0, 100.0, 1000.0].contains(&n.abs())
}

#[cfg(test)]
mod tests {
    use super::super::ast::Dialect;
    use super::super::{Profile, parse};
    use super::*;

    fn codes(text: &str, dialect: Dialect) -> Vec<&'static str> {
        lint(&parse(text, dialect, Profile::Adams).unwrap(), text)
            .iter()
            .map(|d| d.code)
            .collect()
    }

    #[test]
    fn degrees_given_to_radians_are_doubted() {
        for text in [
            "SIN(30)",
            "2*COS(-45)",
            "TAN(90)",
            "SIN(360*TIME)",
            "SIN(TIME*180)",
            "AZ(1,2)-25",
            "90 + AX(3)",
        ] {
            assert_eq!(
                codes(text, Dialect::Function),
                ["degrees_or_radians"],
                "{text}"
            );
        }
        assert_eq!(
            codes("sin(radians(30))", Dialect::Expression),
            ["degrees_or_radians"]
        );
    }

    #[test]
    fn what_is_meant_is_not_doubted() {
        for text in [
            "SIN(30D)",
            "SIN(360D*TIME)",
            "SIN(2*PI*TIME)",
            "SIN(10*TIME)",
            "SIN(90*DTOR)",
            "SIN(100)",
            "SIN(3)",
        ] {
            assert!(codes(text, Dialect::Function).is_empty(), "{text}");
        }
        for text in [
            "AZ(1,2)-25D",
            "SIN(180*AZ(1))",
            "-TIME**2",
            "2**(1/2)",
            "TIME**2/2",
            "-2**3",
            "-(2**2)",
            "(TIME**1)/2",
        ] {
            assert!(codes(text, Dialect::Function).is_empty(), "{text}");
        }
        assert!(codes("sin(30)+sin(360*t)", Dialect::Expression).is_empty());
    }

    #[test]
    fn roots_and_signs_of_powers_are_doubted() {
        assert_eq!(
            codes("TIME**1/2", Dialect::Function),
            ["doubtful_precedence"]
        );
        assert_eq!(
            codes("1-2**2+(-2**2)", Dialect::Function),
            ["doubtful_precedence"]
        );
    }
}
