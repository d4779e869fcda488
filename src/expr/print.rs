//! The printer from [`Ast`] to text: as few parentheses as the grammar allows, shortest digits;
//! reading it back gives the same tree.
//!
//! It keeps a list of the pieces that remain to be written instead of recursing, because the tree
//! of a sum of many thousand terms is as deep as the sum is long.

use super::ast::{Ast, BinaryOp, Dialect, Node, NodeIx};
use std::fmt;

/// Levels of binding in the grammar, loosest first; a place demands a level, a node has one.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Sum,
    Product,
    Unary,
    Power,
    Primary,
}

/// A piece that remains to be written.
enum Piece {
    Text(&'static str),
    /// a node, at a place of this level
    Node(NodeIx, Level),
}

impl fmt::Display for Ast {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Written {
            ast: self,
            ix: self.root,
        }
        .fmt(f)
    }
}

/// A node with everything below it.
pub(super) struct Written<'a> {
    pub ast: &'a Ast,
    pub ix: NodeIx,
}

impl fmt::Display for Written<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ast = self.ast;
        let mut rest = vec![Piece::Node(self.ix, Level::Sum)];
        while let Some(piece) = rest.pop() {
            match piece {
                Piece::Text(text) => f.write_str(text)?,
                Piece::Node(ix, place) if ast.level(ix) < place => {
                    f.write_str("(")?;
                    rest.extend([Piece::Text(")"), Piece::Node(ix, Level::Sum)]);
                }
                Piece::Node(ix, _) => ast.begin(ix, f, &mut rest)?,
            }
        }
        Ok(())
    }
}

impl Ast {
    /// Returns the level of a node.
    fn level(&self, ix: NodeIx) -> Level {
        match self.node(ix) {
            Node::Binary(BinaryOp::Add | BinaryOp::Sub, ..) => Level::Sum,
            Node::Binary(BinaryOp::Mul | BinaryOp::Div, ..) => Level::Product,
            Node::Binary(BinaryOp::Pow, ..) => Level::Power,
            Node::Negate(_) | Node::Plus(_) => Level::Unary,
            Node::Number { .. }
            | Node::Constant(_)
            | Node::If { .. }
            | Node::Call { .. }
            | Node::Named { .. } => Level::Primary,
        }
    }

    /// Writes the beginning of a node and notes the rest, last first.
    fn begin(&self, ix: NodeIx, f: &mut fmt::Formatter<'_>, rest: &mut Vec<Piece>) -> fmt::Result {
        match *self.node(ix) {
            Node::Number { literal, degrees } => {
                write!(f, "{}", Digits(literal))?;
                f.write_str(if degrees { "D" } else { "" })
            }
            Node::Constant(c) => f.write_str(c.name(self.dialect)),
            Node::Negate(x) | Node::Plus(x) => {
                rest.push(Piece::Node(x, Level::Unary));
                f.write_str(if matches!(self.node(ix), Node::Negate(_)) {
                    "-"
                } else {
                    "+"
                })
            }
            Node::Binary(op, a, b) => {
                let (left, right) = match op {
                    BinaryOp::Add | BinaryOp::Sub => (Level::Sum, Level::Product),
                    BinaryOp::Mul | BinaryOp::Div => (Level::Product, Level::Unary),
                    BinaryOp::Pow => (Level::Primary, Level::Unary),
                };
                rest.extend([
                    Piece::Node(b, right),
                    Piece::Text(op.spaced()),
                    Piece::Node(a, left),
                ]);
                Ok(())
            }
            Node::If {
                selector,
                negative,
                zero,
                positive,
            } => {
                let part = |ix| Piece::Node(ix, Level::Sum);
                rest.extend([
                    Piece::Text(")"),
                    part(positive),
                    Piece::Text(", "),
                    part(zero),
                    Piece::Text(", "),
                ]);
                rest.extend([part(negative), Piece::Text(": "), part(selector)]);
                f.write_str("IF(")
            }
            Node::Call { callee, ref args } => {
                note_arguments(args, rest);
                write!(f, "{}(", callee.name())
            }
            Node::Named { entry, ref args } => {
                f.write_str(&self.names.entry(entry).name)?;
                if args.is_empty() {
                    return Ok(());
                }
                note_arguments(args, rest);
                f.write_str("(")
            }
        }
    }
}

/// Notes the arguments of a call and its closing parenthesis, last first.
fn note_arguments(args: &[NodeIx], rest: &mut Vec<Piece>) {
    rest.push(Piece::Text(")"));
    for (k, &arg) in args.iter().enumerate().rev() {
        rest.push(Piece::Node(arg, Level::Sum));
        if k > 0 {
            rest.push(Piece::Text(", "));
        }
    }
}

impl BinaryOp {
    /// Returns the operator as it is written.
    pub fn symbol(self) -> &'static str {
        self.spaced().trim()
    }
    /// Returns the operator with blanks where they help reading.
    fn spaced(self) -> &'static str {
        match self {
            BinaryOp::Add => " + ",
            BinaryOp::Sub => " - ",
            BinaryOp::Mul => "*",
            BinaryOp::Div => "/",
            BinaryOp::Pow => "**",
        }
    }
}

/// A number in the fewest digits that read back as the same number.
pub(super) struct Digits(pub f64);

impl fmt::Display for Digits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (x, size) = (self.0, self.0.abs());
        if size != 0.0 && !(1e-4..1e15).contains(&size) {
            write!(f, "{x:E}")
        } else {
            write!(f, "{x}")
        }
    }
}

/// Two trees are equal when they have the same meaning in the same words; places do not count.
impl PartialEq for Ast {
    fn eq(&self, other: &Self) -> bool {
        (self.dialect, self.root) == (other.dialect, other.root)
            && self.nodes == other.nodes
            && self.names == other.names
    }
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Dialect::Function => "function",
            Dialect::Expression => "expression",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Profile, parse};
    use super::*;

    fn printed(text: &str) -> String {
        let ast = parse(text, Dialect::Function, Profile::Adams).unwrap();
        let printed = ast.to_string();
        assert_eq!(
            parse(&printed, Dialect::Function, Profile::Adams).unwrap(),
            ast,
            "{printed}"
        );
        printed
    }

    #[test]
    fn parentheses_stand_only_where_they_are_needed() {
        for (text, expected) in [
            ("((1+2))*3", "(1 + 2)*3"),
            ("1-(2-3)-(4*5)", "1 - (2 - 3) - 4*5"),
            ("(2**3)**2**-(1)", "(2**3)**2**-1"),
            ("-(2**2)+(-2)**2", "-2**2 + (-2)**2"),
            ("2*(-3)/(4/5)", "2*-3/(4/5)"),
            ("-(a)".replace('a', "TIME*2").as_str(), "-(TIME*2)"),
            ("if ( time-2:1,2 , 3 )", "IF(TIME - 2: 1, 2, 3)"),
            ("step5(time,0,0,1.50,30d)", "STEP5(TIME, 0, 0, 1.5, 30D)"),
            ("dx(012,0)+1.e-7+1E300", "DX(12, 0) + 1E-7 + 1E300"),
        ] {
            assert_eq!(printed(text), expected);
        }
    }

    #[test]
    fn a_sum_of_many_terms_prints_without_recursion() {
        let text = format!("1{}", " + 1".repeat(200_000));
        assert_eq!(printed(&text), text);
    }
}
