//! Warnings about what is legal but probably not meant: degrees for radians, operators that bind
//! otherwise than they look, marks that are read otherwise than they are typed, laws of contact
//! that nothing can step through, steps that run over a number.
//!
//! Only patterns that are hardly ever right are reported. A warning says the number that was
//! written and its meaning; its advice says the replacement. The rules stand in a file per kind:
//! `angles.rs`, `precedence.rs`, `typing.rs`, `contact.rs`, `steps.rs`.

mod angles;
mod contact;
mod precedence;
mod steps;
mod typing;

pub use angles::{degrees_in_angle, degrees_in_speed, reads_as_degrees};
#[cfg(feature = "solver")]
pub(crate) use contact::{ADVICE as EXPONENT_ADVICE, infinitely_stiff, is_infinitely_stiff};

use super::advice;
use super::ast::{Ast, Node, NodeIx};
use crate::arrange::Arrange;
use crate::diagnostic::{Diagnostic, Severity, Span};
use crate::scalar::Scalar;

/// Returns the warnings about an expression, in the order of its text.
///
/// ```
/// use cognate::expr::{Profile, ast::Dialect, lint, parse};
/// let text = "10*SIN(30)";
/// let warnings = lint(&parse(text, Dialect::Function, Profile::Adams)?, text);
/// assert_eq!((warnings[0].code, warnings[0].column), ("degrees_or_radians", 4));
/// # Ok::<(), cognate::Error>(())
/// ```
pub fn lint(ast: &Ast, text: &str) -> Vec<Diagnostic> {
    let mut doubts: Vec<Doubt> = typing::doubts(ast.dialect, text);
    for ix in 0..ast.nodes.len() as NodeIx {
        doubts.extend(angles::of_node(ast, ix));
        doubts.extend(precedence::of_node(ast, ix, text));
        doubts.extend(contact::of_node(ast, ix));
        doubts.extend(steps::of_node(ast, ix));
    }
    doubts.extend(angles::of_several_axes(ast));
    said(doubts, text)
}

/// A warning to be: the place, the code, the number with its meaning, the replacement.
struct Doubt {
    span: Span,
    code: &'static str,
    message: String,
    help: String,
}

impl Doubt {
    fn new(
        span: Span,
        code: &'static str,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        let (message, help) = (message.into(), help.into());
        Self {
            span,
            code,
            message,
            help,
        }
    }
}

/// Returns doubts as warnings about a text, in its order.
fn said(mut doubts: Vec<Doubt>, text: &str) -> Vec<Diagnostic> {
    doubts.arrange_by_key(|d| d.span.start);
    let warning = |d: Doubt| Diagnostic {
        severity: Severity::Warning,
        ..advice::at(text, d.code, d.message, d.span).help(d.help)
    };
    doubts.into_iter().map(warning).collect()
}

/// Returns the place of a node in the text.
fn place(ast: &Ast, ix: NodeIx) -> Span {
    ast.spans.get(ix as usize).copied().unwrap_or_default()
}

/// Returns the value of a literal without suffix.
fn number(ast: &Ast, ix: NodeIx) -> Option<f64> {
    let literal = |ix: NodeIx| match *ast.node(ix) {
        Node::Number {
            literal,
            degrees: false,
        } => Some(literal),
        _ => None,
    };
    match *ast.node(ix) {
        Node::Negate(x) => literal(x).map(|n| -n),
        _ => literal(ix),
    }
}

/// Returns a number in three digits, for people.
fn rounded(x: f64) -> String {
    if x == 0.0 || !(1e-4..1e6).contains(&x.abs()) {
        return if x == 0.0 {
            "0".into()
        } else {
            format!("{x:.2e}")
        };
    }
    let decimals = (2 - Scalar::log10(x.abs()).floor() as i32).max(0) as usize;
    let text = format!("{x:.decimals$}");
    match text.split_once('.') {
        Some(_) => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        None => text,
    }
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
    fn what_is_hardly_meant_is_doubted() {
        for (code, texts) in [
            (
                "rate_of_another",
                &[
                    "IMPACT(DZ(2,1),VZ(3,1),1,10,1,1,1)",
                    "IMPACT(DZ(2,1)-STEP(TIME,0,0,1,1),-VX(2,1),1,10,1,1,1)",
                    "BISTOP(DM(2,1),VX(2,1),1,2,10,1,1,1)",
                    "IMPACT(AZ(2,1),WZ(2,3),1,10,1,1,1)",
                ][..],
            ),
            (
                "degrees_or_radians",
                &[
                    "SIN(30)",
                    "2*COS(-45)",
                    "TAN(90)",
                    "SIN(360*TIME)",
                    "SIN(45*TIME)",
                    "SIN(TIME*180)",
                    "AZ(1,2)-25",
                    "90 + AX(3)",
                ][..],
            ),
            (
                "doubtful_precedence",
                &[
                    "TIME**1/2",
                    "1-2**2+(-2**2)",
                    "2**-1",
                    "TIME**-2",
                    "2**3**2",
                ],
            ),
            (
                "constant_step",
                &[
                    "STEP(0,0,TIME,1,10)",
                    "2*STEP5(1,TIME,0,2,1)",
                    "HAVSIN(-1,0,0,1,TIME)",
                ],
            ),
            (
                "step_order",
                &[
                    "HAVSIN(TIME,0,0.5,30D,120D)",
                    "2*STEP(TIME,0,1,30D,DX(1,2))",
                ],
            ),
            ("doubtful_number", &["1.0D-3", "2*5D+2", "1.D-3*DX(1,2)"]),
            ("doubtful_comment", &["5!*2", "5!", "TIME+3! +2"]),
            (
                "unlikely_magnitude",
                &[
                    "IMPACT(DX(1,2),VX(1,2),1,1E5,0.5,10,0.1)",
                    "BISTOP(DX(1),VX(1),1,2,1E5,.99,10,0.1)",
                ],
            ),
            (
                "angles_of_several_axes",
                &[
                    "AX(1,2)+AY(1,2)",
                    "SIN(AY(1))*COS(AZ(1,0))",
                    "AX(1)-AY(1)+AX(1)",
                ],
            ),
        ] {
            for text in texts {
                assert_eq!(codes(text, Dialect::Function), [code], "{text}");
            }
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
            "IMPACT(DX(3,4,4),VX(3,4,4),.25,1.5,1.5,0,.1)",
            "IMPACT(-DX(1,2),-VX(2,1),1,10,1,1,1)",
            "STEP(1.25,1,0,2,1)",
            "STEP(TIME,0,0,1,TIME)",
            "STEP(TIME,0,30D,1,90D)",
            "STEP(AZ(1,2),0,0.5,30D,1)",
            "STEP(DX(1,2),0,0,1,TIME)",
            "IMPACT(DM(2,1),VR(2,1),1,10,1,1,1)",
            "IMPACT(DX(2,1)+DX(3,1),VX(2,1),1,10,1,1,1)",
            "IMPACT(VARVAL(1),VARVAL(2),1,10,1,1,1)",
            "IMPACT(DZ(2,1),0,1,10,1,1,1)",
            "SIN(360D*TIME)",
            "SIN(2*PI*TIME)",
            "SIN(10*TIME)",
            "SIN(25*TIME)",
            "SIN(90*DTOR)",
            "SIN(100)",
            "SIN(3)",
            "AZ(1,2)-25D",
            "SIN(180*AZ(1))",
            "-TIME**2",
            "2**(1/2)",
            "TIME**2/2",
            "-2**3",
            "-(2**2)",
            "(TIME**1)/2",
            "2**(-1)",
            "2**(3**2)",
            "(2**3)**2",
            "2**(1+1)",
            "TIME*-3",
            "30D-5",
            "1D - 3",
            "1E-3",
            "(1D)-3",
            "5 ! *2",
            "5!the force",
            "5!-----",
            "AX(1,2)+AY(3,2)",
            "AX(1,2)+AX(2,1)",
            "AX(1)+WY(1)",
            "IMPACT(DX(1,2),VX(1,2),1,1E5,1,10,0.1)",
            "BISTOP(DX(1),VX(1),1,2,1E5,2.2,0.5,0.1)",
        ] {
            let found = codes(text, Dialect::Function);
            assert!(found.is_empty(), "{text}: {found:?}");
        }
        assert!(codes("sin(30)+sin(360*t)", Dialect::Expression).is_empty());
    }

    #[test]
    fn angles_of_a_drive_are_doubted_at_their_literals() {
        let at = |text: &str| -> Vec<usize> {
            let ast = parse(text, Dialect::Function, Profile::Adams).unwrap();
            let found = degrees_in_angle(&ast, text);
            found.iter().map(|d| d.column).collect()
        };
        for (text, columns) in [
            ("360*TIME", vec![1]),
            ("-360*TIME", vec![1]),
            ("-(360*TIME)", vec![3]),
            ("TIME*360", vec![6]),
            ("0.1 + STEP(TIME, 0, 0, 1, 90)", vec![27]),
            ("90 - 45*TIME", vec![1, 6]),
            ("-90", vec![2]),
            ("30*TIME", vec![]),
            ("360D*TIME", vec![]),
            ("2*PI*TIME", vec![]),
            ("STEP(TIME, 0, 0, 90, 1)", vec![]),
            ("40*SIN(2*PI*TIME)", vec![1]),
            ("STEP(TIME,0,0,1,40)*SIN(TIME)", vec![17]),
            ("STEP(TIME,0,0,1,1)*SIN(TIME)*45", vec![30]),
            ("SHF(TIME, 0, 30, PI, 0, 0)", vec![14]),
            ("SHF(TIME, 0, 30D, PI, 0, 0)", vec![]),
            ("40D*SIN(2*PI*TIME)", vec![]),
            ("1.5*SIN(90*TIME)", vec![]),
            ("40*DX(1,2)", vec![]),
        ] {
            assert_eq!(at(text), columns, "{text}");
        }
        let speed = "360";
        let ast = parse(speed, Dialect::Function, Profile::Adams).unwrap();
        assert_eq!(degrees_in_speed(&ast, speed).len(), 1);
    }

    #[test]
    fn numbers_are_told_in_three_digits() {
        for (x, text) in [
            (0.0, "0"),
            (4.7746, "4.77"),
            (57.2957, "57.3"),
            (0.125, "0.125"),
            (-0.98803, "-0.988"),
            (1.0, "1"),
            (12345.6, "12346"),
            (2e-7, "2.00e-7"),
        ] {
            assert_eq!(rounded(x), text);
        }
    }
}
