//! Expression functions in the language of direct entry: degrees become radians, names those of
//! FORTRAN.
//!
//! ```text
//! sin(360*t)  →  SIN(360*TIME*DTOR)        asin(x)  →  ASIN(x)*RTOD        log(x)  →  LOG10(x)
//! ```
//!
//! A solver of datasets knows the second language only, so this is how an expression function
//! reaches a statement. The translation has the value of the original.

use super::ast::{Ast, BinaryOp, Callee, Constant, Dialect, Node, NodeIx};
use super::check::MOST_CHARACTERS;
use super::functions::Function;
use crate::diagnostic::{Diagnostic, Span};

impl Ast {
    /// Returns the same function in the language of direct entry, where it is written in the other.
    ///
    /// # Errors
    /// When it would be too long: `ent` and `sign` repeat their argument, and multiply where they
    /// stand within each other.
    pub fn in_direct_entry(&self) -> Result<Ast, Diagnostic> {
        let mut new = Translation::default();
        // old index → new index; children stand before their parents
        let mut place: Vec<NodeIx> = Vec::with_capacity(self.nodes.len());
        for (node, span) in self.nodes.iter().zip(&self.spans) {
            new.span = *span;
            let at = |ix: &NodeIx| place[*ix as usize];
            let made = match node {
                Node::Number { .. } | Node::Constant(_) => new.add(node.clone()),
                Node::Negate(x) => new.add(Node::Negate(at(x))),
                Node::Plus(x) => new.add(Node::Plus(at(x))),
                Node::Binary(op, a, b) => new.binary(*op, at(a), at(b)),
                Node::If {
                    selector,
                    negative,
                    zero,
                    positive,
                } => new.add(Node::If {
                    selector: at(selector),
                    negative: at(negative),
                    zero: at(zero),
                    positive: at(positive),
                }),
                Node::Call { callee, args } => new.call(*callee, args.iter().map(at).collect()),
                Node::Named { entry, args } => new.add(Node::Named {
                    entry: *entry,
                    args: args.iter().map(at).collect(),
                }),
            };
            place.push(made);
        }
        let root = place[self.root as usize];
        if new.length[root as usize] > MOST_CHARACTERS {
            let what = "this is too long in the language of direct entry";
            let advice = "ent and sign repeat their argument: divide the function";
            return Err(Diagnostic::error("limit_length", what).help(advice));
        }
        Ok(Ast {
            dialect: Dialect::Function,
            nodes: new.nodes,
            spans: new.spans,
            root,
            names: self.names.clone(),
        })
    }
}

/// The tree that is being made.
#[derive(Default)]
struct Translation {
    nodes: Vec<Node>,
    spans: Vec<Span>,
    /// per node at least as many characters as it has when it is printed
    length: Vec<usize>,
    /// place of the node that is being translated
    span: Span,
}

/// Characters that a number, a name or an operator takes, with its parentheses.
const WORD_LENGTH: usize = 8;

impl Translation {
    fn add(&mut self, node: Node) -> NodeIx {
        let of = |ix: &NodeIx| self.length[*ix as usize];
        let below = match &node {
            Node::Number { .. } | Node::Constant(_) => 0,
            Node::Negate(x) | Node::Plus(x) => of(x),
            Node::Binary(_, a, b) => of(a).saturating_add(of(b)),
            Node::If {
                selector,
                negative,
                zero,
                positive,
            } => [selector, negative, zero, positive]
                .map(of)
                .into_iter()
                .fold(0, usize::saturating_add),
            Node::Call { args, .. } | Node::Named { args, .. } => {
                args.iter().map(of).fold(0, usize::saturating_add)
            }
        };
        self.length.push(below.saturating_add(WORD_LENGTH));
        self.nodes.push(node);
        self.spans.push(self.span);
        (self.nodes.len() - 1) as NodeIx
    }

    fn number(&mut self, literal: f64) -> NodeIx {
        let degrees = false;
        self.add(Node::Number { literal, degrees })
    }

    fn binary(&mut self, op: BinaryOp, a: NodeIx, b: NodeIx) -> NodeIx {
        self.add(Node::Binary(op, a, b))
    }

    fn function(&mut self, function: Function, args: Vec<NodeIx>) -> NodeIx {
        let callee = Callee::Function(function);
        self.add(Node::Call { callee, args })
    }

    fn times(&mut self, x: NodeIx, factor: Constant) -> NodeIx {
        let factor = self.add(Node::Constant(factor));
        self.binary(BinaryOp::Mul, x, factor)
    }

    /// Adds a call in the words of the other language.
    fn call(&mut self, callee: Callee, args: Vec<NodeIx>) -> NodeIx {
        let (Callee::Function(function), Some(&x)) = (callee, args.first()) else {
            return self.add(Node::Call { callee, args });
        };
        match function {
            Function::SinDegrees => self.of_degrees(Function::Sin, x),
            Function::CosDegrees => self.of_degrees(Function::Cos, x),
            Function::TanDegrees => self.of_degrees(Function::Tan, x),
            Function::AsinDegrees => self.in_degrees(Function::Asin, x),
            Function::AcosDegrees => self.in_degrees(Function::Acos, x),
            Function::AtanDegrees => self.in_degrees(Function::Atan, x),
            Function::Degrees => self.times(x, Constant::Rtod),
            Function::Radians => self.times(x, Constant::Dtor),
            Function::CommonLog => self.function(Function::Log10, vec![x]),
            Function::Antilog => {
                let ten = self.number(10.0);
                self.binary(BinaryOp::Pow, ten, x)
            }
            Function::Ln => self.function(Function::Log, vec![x]),
            Function::ExpressionExp => self.function(Function::Exp, vec![x]),
            Function::ExpressionSqrt => self.function(Function::Sqrt, vec![x]),
            Function::ExpressionAbs => self.function(Function::Abs, vec![x]),
            Function::Int => self.function(Function::Aint, vec![x]),
            Function::Frac => {
                let one = self.number(1.0);
                self.function(Function::Mod, vec![x, one])
            }
            Function::SignOf => {
                let [one, zero] = [1.0, 0.0].map(|n| self.number(n));
                let negative = self.add(Node::Negate(one));
                self.add(Node::If {
                    selector: x,
                    negative,
                    zero,
                    positive: one,
                })
            }
            Function::Ent => self.downward(x),
            // a function of this language already
            other => self.function(other, args),
        }
    }

    fn of_degrees(&mut self, function: Function, x: NodeIx) -> NodeIx {
        let radians = self.times(x, Constant::Dtor);
        self.function(function, vec![radians])
    }

    fn in_degrees(&mut self, function: Function, x: NodeIx) -> NodeIx {
        let radians = self.function(function, vec![x]);
        self.times(radians, Constant::Rtod)
    }

    /// Adds the largest whole number that is not above x: `IF(x-AINT(x): AINT(x)-1, x, AINT(x))`.
    fn downward(&mut self, x: NodeIx) -> NodeIx {
        let toward_zero = self.function(Function::Aint, vec![x]);
        let one = self.number(1.0);
        let selector = self.binary(BinaryOp::Sub, x, toward_zero);
        let negative = self.binary(BinaryOp::Sub, toward_zero, one);
        self.add(Node::If {
            selector,
            negative,
            zero: x,
            positive: toward_zero,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Expr;

    fn translated(text: &str) -> String {
        let expr = Expr::parse_dialect(text, Dialect::Expression).unwrap();
        expr.ast().in_direct_entry().unwrap().to_string()
    }

    #[test]
    fn degrees_become_radians_and_names_those_of_direct_entry() {
        for (text, expected) in [
            ("180*sin(360*t)", "180*SIN(360*TIME*DTOR)"),
            ("atan(t)+ln(2)", "ATAN(TIME)*RTOD + LOG(2)"),
            ("alog(t)-log(5)", "10**TIME - LOG10(5)"),
            ("frac(t)*int(t)", "MOD(TIME, 1)*AINT(TIME)"),
        ] {
            assert_eq!(translated(text), expected);
        }
    }

    #[test]
    fn every_expression_function_has_the_same_value_in_direct_entry() {
        let functions = Function::ALL.iter();
        let all: Vec<_> = functions
            .filter(|f| f.row().dialect == Dialect::Expression)
            .collect();
        let mut compared = 0;
        for function in &all {
            for x in [-2.75, -1.0, -0.3, 0.0, 0.25, 1.0, 2.0, 37.5] {
                let text = format!("{}({x})", function.name());
                // of a negative literal the argument begins with a sign
                let read = Expr::parse_dialect(&text, Dialect::Expression);
                // where the function has no value there is nothing to compare
                let Ok(expected) = read.and_then(|expr| expr.eval(&[])) else {
                    continue;
                };
                compared += 1;
                let new = Expr::parse(&translated(&text)).unwrap();
                let off = (new.eval(&[]).unwrap() - expected).abs();
                assert!(off <= 4.0 * f64::EPSILON * expected.abs(), "{text}: {new}");
            }
        }
        assert!(
            compared > 4 * all.len(),
            "{compared} values of {}",
            all.len()
        );
    }

    #[test]
    fn a_function_that_would_be_too_long_is_refused() {
        let text = format!("{}t{}", "ent(".repeat(30), ")".repeat(30));
        let expr = Expr::parse_dialect(&text, Dialect::Expression).unwrap();
        let refused = expr.ast().in_direct_entry().unwrap_err();
        assert_eq!(refused.code, "limit_length");
    }
}
