//! Tokens of a statement: the text of some, the next of a kind, where an argument ends, complaints.

use super::*;
use crate::diagnostic::Cause;

impl<'a> Reader<'a> {
    /// The text of some tokens: lines joined by a blank; `between` stands for a comma that began a
    /// line, where the comma is part of the text. And where each further line begins.
    pub(super) fn joined(&self, from: usize, to: usize, between: &str) -> (String, Vec<Break>) {
        let mut text = String::new();
        let mut breaks = Vec::new();
        let mut k = from;
        while k < to {
            if self.tokens[k].kind == TokenKind::Continuation {
                let bare = !text.ends_with(',');
                text.push_str(if bare { between } else { " " });
                k += 1;
                continue;
            }
            let mut last = k;
            while last + 1 < to
                && self.tokens[last + 1].kind != TokenKind::Continuation
                && self.same_line(last)
            {
                last += 1;
            }
            let start = self.tokens[k].span.start;
            if k > from {
                if !text.ends_with(' ') {
                    text.push(' ');
                }
                let (line, column) = self.source.place(start);
                breaks.push(Break {
                    offset: text.len(),
                    line,
                    column,
                });
            }
            text.push_str(
                self.source
                    .slice(Span::new(start, self.tokens[last].span.end)),
            );
            k = last + 1;
        }
        (text.trim_end().to_owned(), breaks)
    }

    /// Returns true if the next token stands on the same line as this one.
    pub(super) fn same_line(&self, k: usize) -> bool {
        let gap = Span::new(self.tokens[k].span.end, self.tokens[k + 1].span.start);
        !self.source.slice(gap).contains(['\n', '\r'])
    }

    pub(super) fn between(&self, from: usize, to: usize) -> Span {
        match (
            self.tokens.get(from),
            to.checked_sub(1).and_then(|k| self.tokens.get(k)),
        ) {
            (Some(a), Some(b)) if to > from => Span::new(a.span.start, b.span.end),
            (Some(a), _) => Span::new(a.span.start, a.span.start),
            _ => Span::default(),
        }
    }

    pub(super) fn text(&self, token: Token) -> &'a str {
        self.source.slice(token.span)
    }

    pub(super) fn take(&mut self, kind: TokenKind) -> Option<Token> {
        let token = self.tokens.get(self.at).filter(|t| t.kind == kind).copied();
        self.at += usize::from(token.is_some());
        token
    }

    pub(super) fn atom(&mut self) -> Result<Token, Reported> {
        match self.take(TokenKind::Atom) {
            Some(token) => Ok(token),
            None => {
                let span = self
                    .tokens
                    .get(self.at)
                    .or(self.tokens.last())
                    .map_or(Span::default(), |t| t.span);
                let message = format!("a value is missing before `{}`", self.source.slice(span));
                self.fail(Cause::MissingValue.code(), span, message)
            }
        }
    }

    /// Returns true if a word begins like a number.
    pub(super) fn numeric(&self, token: Token) -> bool {
        let text = self.text(token);
        text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-'))
    }

    /// The first token from here on that is neither comma nor backslash.
    pub(super) fn after_separators(&self, from: usize) -> usize {
        let is = |t: &Token| t.kind.separates();
        from + self.tokens[from.min(self.tokens.len())..]
            .iter()
            .take_while(|t| is(t))
            .count()
    }

    /// Returns true if a word and an equals sign stand here.
    pub(super) fn is_assignment(&self, at: usize) -> bool {
        self.tokens
            .get(at)
            .is_some_and(|t| t.kind == TokenKind::Atom && !self.numeric(*t))
            && self
                .tokens
                .get(at + 1)
                .is_some_and(|t| t.kind == TokenKind::Equals)
    }

    /// Returns true if an argument of this statement stands here.
    pub(super) fn begins_argument(&self, at: usize) -> bool {
        let Some(&t) = self.tokens.get(at) else {
            return false;
        };
        if self.is_assignment(at) {
            return true;
        }
        if t.kind != TokenKind::Atom || self.numeric(t) {
            return false;
        }
        let alone = (self.tokens.get(at + 1)).is_none_or(|t| t.kind.separates());
        let flag = |k: usize| {
            let mut arguments = self.arguments();
            arguments.nth(k).is_some_and(|a| a.kind == Kind::Flag)
        };
        alone && matches!(self.argument_meant(self.text(t)), Meaning::One(k) if flag(k))
    }

    pub(super) fn at_end_of_value(&self) -> bool {
        let next = self.after_separators(self.at);
        next >= self.tokens.len() || next > self.at && self.is_assignment(next)
    }

    /// After a value comes a separator or the end.
    pub(super) fn separated(&mut self) -> Result<(), Reported> {
        let Some(&t) = self.tokens.get(self.at) else {
            return Ok(());
        };
        match t.kind {
            TokenKind::Comma
            | TokenKind::Continuation
            | TokenKind::Backslash
            | TokenKind::Slash => Ok(()),
            _ => {
                let message = format!("`{}` does not belong to the value before it", self.text(t));
                let d = Diagnostic::error("unexpected_text", message)
                    .help("arguments are separated by commas");
                let d = self.source.locate(self.about(d), t.span);
                self.out.push(d);
                Err(Reported)
            }
        }
    }

    /// Goes to the next place where an argument may begin: a word after a comma, outside
    /// parentheses.
    pub(super) fn recover(&mut self) {
        let mut depth = 0usize;
        while let Some(t) = self.tokens.get(self.at) {
            match t.kind {
                TokenKind::Open => depth += 1,
                TokenKind::Close => depth = depth.saturating_sub(1),
                _ => {}
            }
            let next = self.after_separators(self.at);
            let word = self
                .tokens
                .get(next)
                .is_none_or(|t| t.kind == TokenKind::Atom && !self.numeric(*t));
            if next > self.at && (depth == 0 && word || self.is_assignment(next)) {
                self.at = next;
                return;
            }
            self.at = next.max(self.at + 1);
        }
    }

    pub(super) fn error(&mut self, code: &'static str, span: Span, message: String) {
        let d = self.about(Diagnostic::error(code, message));
        let d = self.source.locate(d, span);
        self.out.push(d);
    }

    pub(super) fn warning(&mut self, code: &'static str, span: Span, message: String) {
        let d = self.about(Diagnostic::warning(code, message));
        let d = self.source.locate(d, span);
        self.out.push(d);
    }

    pub(super) fn fail<T>(
        &mut self,
        code: &'static str,
        span: Span,
        message: String,
    ) -> Result<T, Reported> {
        self.error(code, span, message);
        Err(Reported)
    }
}
