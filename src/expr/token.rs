//! The tokens of the language, one at a time, with their places.
//!
//! The lexer serves the ordered check of a text (`check.rs`): it reports a wrong character or
//! literal as soon as it is reached, and never reads beyond the end of the token.

use super::ast::Callee;
use super::compile::literal_value;
use crate::diagnostic::{Cause, Span};

/// The kind of a token.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    /// a literal
    Number {
        /// the number before the suffix
        literal: f64,
        /// whether the suffix D follows
        degrees: bool,
    },
    Name,
    Plus,
    Minus,
    Times,
    Over,
    Power,
    Open,
    Close,
    Comma,
    Colon,
    /// the end of the text
    End,
}

/// A token and its bytes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Token {
    pub kind: Kind,
    pub span: Span,
}

/// The kind of a mistake in a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FaultKind {
    BadCharacter,
    BadNumber,
    UnexpectedToken,
    UnexpectedEnd,
    UnknownName,
    NotCallable,
    MissingArguments,
    EmptyArgument,
    Arity,
    IntegerRequired,
    OutOfRange,
    Characters,
    Lines,
    Symbols,
    Elements,
    Nesting,
}

impl FaultKind {
    /// Returns the code of the diagnostic.
    pub fn code(self) -> &'static str {
        match self {
            Self::BadCharacter => "bad_char",
            Self::BadNumber => "bad_number",
            Self::UnexpectedToken => "unexpected_token",
            Self::UnexpectedEnd => Cause::UnexpectedEnd.code(),
            Self::UnknownName => Cause::UnknownName.code(),
            Self::NotCallable => "not_callable",
            Self::MissingArguments => "missing_arguments",
            Self::EmptyArgument => "empty_argument",
            Self::Arity => "arity",
            Self::IntegerRequired => "integer_required",
            Self::OutOfRange => "out_of_range",
            Self::Characters => "limit_length",
            Self::Lines => "limit_lines",
            Self::Symbols => "limit_symbols",
            Self::Elements => "limit_elements",
            Self::Nesting => "limit_nesting",
        }
    }
}

/// The first mistake of a text: kind, bytes, and the state of the check there, for advice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fault {
    pub kind: FaultKind,
    pub span: Span,
    /// state of the check there
    pub about: About,
}

/// The subject of a mistake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum About {
    /// the place alone
    Place,
    /// a token that cannot stand here
    Token {
        /// whether an operator or separator could have stood here; if not, an operand was needed
        after_operand: bool,
        /// the innermost open parenthesis and the name before it
        inside: Option<(Open, Span)>,
    },
    /// a call with this many arguments
    Count(Callee, usize),
    /// a call of a function of the caller's own, with this many arguments
    NamedCount(u32, usize),
    /// an argument of a call, from 0
    Argument(Callee, usize),
    /// a limit
    Limit(usize),
}

/// The owner of an open parenthesis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Open {
    Group,
    Call(Callee),
    /// a call of a function of the caller's own
    Named(u32),
    /// an IF, with the part that is being read: 0 the selector, 1 to 3 the branches
    If(u8),
}

impl Fault {
    pub fn new(kind: FaultKind, span: Span) -> Self {
        Self {
            kind,
            span,
            about: About::Place,
        }
    }
    pub fn about(self, about: About) -> Self {
        Self { about, ..self }
    }
}

/// A reader of tokens from a text.
pub(crate) struct Lexer<'a> {
    text: &'a str,
    /// next byte
    at: usize,
    /// whether the suffix D is known
    suffix: bool,
}

impl<'a> Lexer<'a> {
    pub fn new(text: &'a str, suffix: bool) -> Self {
        Self {
            text,
            at: 0,
            suffix,
        }
    }

    /// Reads the next token. After the end it is the end again.
    ///
    /// # Errors
    /// A wrong character or literal.
    pub fn next(&mut self) -> Result<Token, Fault> {
        self.skip_blanks()?;
        let start = self.at;
        let bytes = self.text.as_bytes();
        let Some(&first) = bytes.get(start) else {
            return Ok(Token {
                kind: Kind::End,
                span: Span::new(start, start),
            });
        };
        let kind = match first {
            b'+' => self.sign(Kind::Plus),
            b'-' => self.sign(Kind::Minus),
            b'*' if bytes.get(start + 1) == Some(&b'*') => {
                self.at += 1;
                self.sign(Kind::Power)
            }
            b'*' => self.sign(Kind::Times),
            b'/' => self.sign(Kind::Over),
            b'(' => self.sign(Kind::Open),
            b')' => self.sign(Kind::Close),
            b',' => self.sign(Kind::Comma),
            b':' => self.sign(Kind::Colon),
            b'0'..=b'9' => self.number()?,
            b'.' if bytes.get(start + 1).is_some_and(u8::is_ascii_digit) => self.number()?,
            b'A'..=b'Z' | b'a'..=b'z' => {
                self.skip_while(is_word);
                Kind::Name
            }
            _ => return Err(self.bad_character()),
        };
        Ok(Token {
            kind,
            span: Span::new(start, self.at),
        })
    }

    fn sign(&mut self, kind: Kind) -> Kind {
        self.at += 1;
        kind
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn skip_while(&mut self, keep: impl Fn(u8) -> bool) -> usize {
        let rest = &self.text.as_bytes()[self.at..];
        let length = rest.iter().position(|&b| !keep(b)).unwrap_or(rest.len());
        self.at += length;
        length
    }

    /// Skips blanks, comments, and ampersands that continue a line.
    fn skip_blanks(&mut self) -> Result<(), Fault> {
        loop {
            self.skip_while(|b| matches!(b, b' ' | b'\t' | b'\r' | b'\n'));
            match self.peek() {
                Some(b'!') => {
                    self.skip_while(|b| b != b'\n');
                }
                Some(b'&') => {
                    let ampersand = self.at;
                    self.at += 1;
                    self.skip_while(|b| matches!(b, b' ' | b'\t' | b'\r'));
                    if self.peek().is_some_and(|b| b != b'\n') {
                        return Err(Fault::new(
                            FaultKind::BadCharacter,
                            Span::new(ampersand, ampersand + 1),
                        ));
                    }
                }
                _ => return Ok(()),
            }
        }
    }

    fn bad_character(&self) -> Fault {
        let length = self.text[self.at..]
            .chars()
            .next()
            .map_or(0, char::len_utf8);
        Fault::new(
            FaultKind::BadCharacter,
            Span::new(self.at, self.at + length),
        )
    }

    /// Reads `mantissa [exponent] [D]`, after which neither a letter, a digit, `_` nor `.` may
    /// follow.
    fn number(&mut self) -> Result<Kind, Fault> {
        let start = self.at;
        let digit = |b: u8| b.is_ascii_digit();
        self.skip_while(digit);
        if self.peek() == Some(b'.') {
            self.at += 1;
            self.skip_while(digit);
        }
        let mut well_formed = true;
        if matches!(self.peek(), Some(b'E' | b'e')) {
            self.at += 1;
            if matches!(self.peek(), Some(b'+' | b'-')) {
                self.at += 1;
            }
            well_formed = self.skip_while(digit) > 0;
        }
        let end = self.at;
        let degrees = self.suffix && well_formed && matches!(self.peek(), Some(b'D' | b'd'));
        if degrees {
            self.at += 1;
        }
        well_formed &= self.skip_while(|b| is_word(b) || b == b'.') == 0;
        let fault = Fault::new(FaultKind::BadNumber, Span::new(start, self.at));
        if !well_formed {
            return Err(fault);
        }
        let literal = self.text[start..end].parse().unwrap_or(f64::INFINITY);
        if !literal_value(literal, degrees).is_finite() {
            return Err(fault);
        }
        Ok(Kind::Number { literal, degrees })
    }
}

fn is_word(b: u8) -> bool {
    b.is_ascii_alphanumeric() || b == b'_'
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Result<Vec<Kind>, Fault> {
        let mut lexer = Lexer::new(text, true);
        let mut found = Vec::new();
        loop {
            match lexer.next()?.kind {
                Kind::End => return Ok(found),
                kind => found.push(kind),
            }
        }
    }
    fn number(literal: f64, degrees: bool) -> Kind {
        Kind::Number { literal, degrees }
    }

    #[test]
    fn a_sign_after_the_suffix_is_an_operator_and_after_e_is_not() {
        assert_eq!(
            kinds("30D-5"),
            Ok(vec![number(30.0, true), Kind::Minus, number(5.0, false)])
        );
        assert_eq!(kinds("30E-5"), Ok(vec![number(30e-5, false)]));
        assert_eq!(kinds("1.8E2d"), Ok(vec![number(180.0, true)]));
        assert_eq!(
            kinds(".5+5."),
            Ok(vec![number(0.5, false), Kind::Plus, number(5.0, false)])
        );
    }

    #[test]
    fn malformed_literals_are_reported_at_their_first_character() {
        for text in [
            "1.5E", "1.5E+", "1E*3", "1D3", "1.5D0", "1.2.3", "1..2", "30DD", "30D2", "2TIME",
            "1E400", "1E308D", "1_",
        ] {
            let fault = kinds(&format!("2+{text}")).unwrap_err();
            assert_eq!(
                (fault.kind.code(), fault.span.start),
                ("bad_number", 2),
                "{text}"
            );
        }
        assert_eq!(
            Lexer::new("30D", false).next().unwrap_err().kind.code(),
            "bad_number"
        );
    }

    #[test]
    fn ampersands_continue_lines_and_nothing_else() {
        assert_eq!(kinds("2 & \r\n + ! one & two\n&").map(|k| k.len()), Ok(2));
        assert_eq!(
            kinds("2&3").unwrap_err(),
            Fault::new(FaultKind::BadCharacter, Span::new(1, 2))
        );
        assert_eq!(
            kinds("2 & ! no").unwrap_err(),
            Fault::new(FaultKind::BadCharacter, Span::new(2, 3))
        );
        assert_eq!(
            kinds("1 ü").unwrap_err(),
            Fault::new(FaultKind::BadCharacter, Span::new(2, 4))
        );
    }
}
