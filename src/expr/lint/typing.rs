//! Warnings about marks that are read otherwise than typed: D for the E of an exponent, an
//! exclamation mark for a factorial.

use super::{Doubt, rounded};
use crate::diagnostic::Span;
use crate::expr::ast::Dialect;
use crate::expr::compile::literal_value;
use crate::expr::token::{Kind, Lexer, Token};

/// Returns the doubts about the tokens of a text.
pub(super) fn doubts(dialect: Dialect, text: &str) -> Vec<Doubt> {
    if !may_doubt(text) {
        return Vec::new();
    }
    let mut lexer = Lexer::new(text, dialect == Dialect::Function);
    let mut last: Option<Token> = None;
    let mut before: Option<Token> = None;
    let mut found = Vec::new();
    while let Ok(token) = lexer.next() {
        if let Some(operand) = last.filter(|t| ends_operand(t.kind)) {
            found.extend(factorial(text, operand, token));
        }
        if let (Some(first), Some(sign)) = (before, last) {
            found.extend(exponent(text, first, sign, token));
        }
        if token.kind == Kind::End {
            break;
        }
        (before, last) = (last, Some(token));
    }
    found
}

/// Returns whether a text has a mark that may be doubted: an exclamation mark, a D behind a digit.
fn may_doubt(text: &str) -> bool {
    let mut last = b' ';
    text.bytes().any(|byte| {
        let is_suffix = matches!(byte, b'd' | b'D') && matches!(last, b'0'..=b'9' | b'.');
        if !byte.is_ascii_whitespace() {
            last = byte;
        }
        is_suffix || byte == b'!'
    })
}

/// Returns whether an operand may end with this token.
fn ends_operand(kind: Kind) -> bool {
    matches!(kind, Kind::Number { .. } | Kind::Name | Kind::Close)
}

/// Warns of `5!*2`, which is 5 and a comment.
fn factorial(text: &str, operand: Token, next: Token) -> Option<Doubt> {
    let at = operand.span.end;
    let comment = text
        .get(at..next.span.start)?
        .lines()
        .next()?
        .strip_prefix('!')?;
    let rest = comment.trim();
    let mut marks = rest.chars();
    let looks_so = match (marks.next(), marks.next()) {
        (None, _) => true,
        // lines of dashes, stars and so on are ornaments
        (Some(a), Some(b)) if a == b => rest.starts_with("**") && !rest.starts_with("***"),
        (Some(first), _) => "+-*/),".contains(first),
    };
    let left_out = if rest.is_empty() {
        String::new()
    } else {
        format!(": `{rest}` is not read")
    };
    looks_so.then(|| {
        Doubt::new(
            Span::new(at, at + 1),
            "doubtful_comment",
            format!("an exclamation mark begins a comment{left_out}"),
            "there is no factorial; a blank before the mark shows that a comment is meant",
        )
    })
}

/// Warns of `1.0D-3`, which is one degree minus three.
fn exponent(text: &str, first: Token, sign: Token, next: Token) -> Option<Doubt> {
    let Kind::Number {
        literal,
        degrees: true,
    } = first.kind
    else {
        return None;
    };
    let Kind::Number {
        literal: power,
        degrees: false,
    } = next.kind
    else {
        return None;
    };
    let adjacent = first.span.end == sign.span.start && sign.span.end == next.span.start;
    let digits = text.get(next.span.start..next.span.end)?;
    let whole = digits.len() <= 3 && digits.bytes().all(|b| b.is_ascii_digit());
    let is_sign = matches!(sign.kind, Kind::Plus | Kind::Minus);
    // 30D-5 is an angle; the mantissa of an exponent is a small number
    if !adjacent || !whole || !is_sign || literal.abs() >= 10.0 {
        return None;
    }
    let written = text.get(first.span.start..next.span.end)?;
    let mantissa = text.get(first.span.start..first.span.end - 1)?;
    let tail = text.get(sign.span.start..next.span.end)?;
    let signed = if sign.kind == Kind::Minus {
        -power
    } else {
        power
    };
    let meant: f64 = format!("{mantissa}E{tail}").parse().ok()?;
    Some(Doubt::new(
        Span::new(first.span.start, next.span.end),
        "doubtful_number",
        format!(
            "D is the suffix for degrees: {written} is {mantissa} degrees {} {digits}, which is {}",
            if signed < 0.0 { "minus" } else { "plus" },
            rounded(literal_value(literal, true) + signed)
        ),
        format!(
            "an exponent is written {mantissa}E{tail}, which is {}",
            rounded(meant)
        ),
    ))
}
