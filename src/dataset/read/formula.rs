//! Functions: expressions that go on over lines, and USER with its constants.

use super::*;
use crate::diagnostic::Cause;

impl Reader<'_> {
    /// An expression: up to `\`, the end, or a comma (or slash) that is followed by `KEYWORD =`.
    pub(super) fn formula(&mut self, name: Token) -> Result<Formula, Reported> {
        let from = self.at;
        let mut depth = 0usize;
        while let Some(&t) = self.tokens.get(self.at) {
            let next = self.after_separators(self.at);
            let ends = match t.kind {
                TokenKind::Open => {
                    depth += 1;
                    false
                }
                TokenKind::Close => {
                    depth = depth.saturating_sub(1);
                    false
                }
                TokenKind::Backslash => true,
                TokenKind::Slash => self.is_assignment(self.at + 1),
                TokenKind::Comma => depth == 0 || self.is_assignment(next),
                TokenKind::Continuation => {
                    self.is_assignment(next) || depth == 0 && self.forgotten_backslash(next, t.span)
                }
                _ => false,
            };
            if ends {
                break;
            }
            self.at += 1;
        }
        let mut to = self.at;
        while to > from
            && matches!(
                self.tokens[to - 1].kind,
                TokenKind::Slash | TokenKind::Comma | TokenKind::Continuation
            )
        {
            to -= 1;
        }
        if to == from {
            let message = format!("{} = what? It takes an expression", self.text(name));
            return self.fail(Cause::MissingValue.code(), name.span, message);
        }
        if let Some(user) = self.user(from, to)? {
            return Ok(user);
        }
        let (text, breaks) = self.joined(from, to, " ");
        let (line, column) = self.source.place(self.tokens[from].span.start);
        Ok(Formula::Expression {
            text: text.into(),
            line,
            column,
            breaks,
        })
    }

    /// Returns true if a line after an expression holds a bare keyword, before which a `\` belongs.
    pub(super) fn forgotten_backslash(&mut self, at: usize, span: Span) -> bool {
        let Some(&t) = self.tokens.get(at) else {
            return false;
        };
        let word = self.text(t);
        let is_flag = self.arguments().any(|a| {
            a.kind == Kind::Flag && word.len() > 1 && a.keyword().eq_ignore_ascii_case(word)
        });
        let alone = (self.tokens.get(at + 1)).is_none_or(|t| t.kind.separates());
        if t.kind == TokenKind::Atom && is_flag && alone {
            let d = Diagnostic::warning(
                "missing_backslash",
                format!("the expression before {word} does not end with `\\`"),
            );
            let d = d.help("an expression ends with `\\` where another argument follows");
            let d = self.source.locate(self.about(d), span);
            self.out.push(d);
            return true;
        }
        false
    }

    /// `USER(r1, …)`, when the tokens are that and nothing else.
    pub(super) fn user(&mut self, from: usize, to: usize) -> Result<Option<Formula>, Reported> {
        let tokens = self.tokens[from..to].to_vec();
        let [name, open, inner @ .., close] = tokens.as_slice() else {
            return Ok(None);
        };
        let kinds = (open.kind, close.kind);
        let nested = inner
            .iter()
            .any(|t| matches!(t.kind, TokenKind::Open | TokenKind::Close));
        let is_user = self.text(*name).eq_ignore_ascii_case("USER");
        if !is_user || kinds != (TokenKind::Open, TokenKind::Close) || nested {
            return Ok(None);
        }
        let mut constants = Vec::new();
        let mut sign = String::new();
        for &t in inner {
            match t.kind {
                TokenKind::Comma | TokenKind::Continuation => {}
                TokenKind::Atom if matches!(self.text(t), "+" | "-") => {
                    sign = self.text(t).to_owned()
                }
                _ => match Number::parse(&(std::mem::take(&mut sign) + self.text(t))) {
                    Some(x) => constants.push(x.value()),
                    None => {
                        let message = format!("`{}`: USER takes numbers only", self.text(t));
                        self.error("not_a_number", t.span, message);
                        return Err(Reported);
                    }
                },
            }
        }
        Ok(Some(Formula::User {
            constants,
            routine: None,
        }))
    }
}
