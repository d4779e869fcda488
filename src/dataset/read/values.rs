//! Values of arguments: numbers, words, texts and lists, each as its kind is written.

use super::*;
use crate::diagnostic::Cause;

/// Letters of a keyword before a colon, at least, that make a text look like an argument.
const LEAST_KEYWORD: usize = 3;

impl Reader<'_> {
    pub(super) fn value(&mut self, kind: Kind, name: Token) -> Result<Value, Reported> {
        if self.at_end_of_value() {
            let message = format!("{} = what? It takes {}", self.text(name), kind.describe());
            return self.fail(Cause::MissingValue.code(), name.span, message);
        }
        Ok(match kind {
            Kind::Flag => Value::Flag,
            Kind::Id => Value::Id(self.whole()?),
            Kind::Ids { min, max } => {
                let all = self.list(min, Self::whole)?;
                self.count(name, all.len(), min, max, kind)?;
                Value::Ids(all)
            }
            Kind::Real { angle } => Value::Real(self.number(angle)?),
            Kind::Reals { min, max, angle } => {
                let all = self.list(min, |r| r.number(angle))?;
                self.count(name, all.len(), min, max, kind)?;
                Value::Reals(all)
            }
            Kind::Word(choices) => Value::Word(self.word(choices)?),
            Kind::Words(choices) => Value::Words(self.words(choices)?),
            Kind::Text => Value::Text(self.free_text()?),
            Kind::Texts => Value::Texts(self.texts()?),
            Kind::Formula => Value::Formula(self.formula(name)?),
            Kind::Raw => Value::Raw(self.raw(false)?),
        })
    }

    pub(super) fn count(
        &mut self,
        name: Token,
        n: usize,
        min: usize,
        max: usize,
        kind: Kind,
    ) -> Result<(), Reported> {
        if (min..=max).contains(&n) {
            return Ok(());
        }
        let message = format!("{} takes {}, not {n}", self.text(name), kind.describe());
        self.error("wrong_count", name.span, message);
        Err(Reported)
    }

    /// Values with commas between them, as long as what follows a comma begins like a number; and
    /// in any case `min`, unless another argument begins.
    pub(super) fn list<T>(
        &mut self,
        min: usize,
        mut one: impl FnMut(&mut Self) -> Result<T, Reported>,
    ) -> Result<Vec<T>, Reported> {
        let mut all = vec![one(self)?];
        loop {
            let next = self.after_separators(self.at);
            let atom = self
                .tokens
                .get(next)
                .filter(|t| next > self.at && t.kind == TokenKind::Atom);
            let expected = all.len() < min && !self.begins_argument(next);
            let more = atom.is_some_and(|t| self.numeric(*t) || expected);
            if !more || self.is_assignment(next) {
                return Ok(all);
            }
            self.at = next;
            all.push(one(self)?);
        }
    }

    pub(super) fn whole(&mut self) -> Result<u32, Reported> {
        let token = self.atom()?;
        let text = self.text(token);
        match text.parse::<u32>() {
            Ok(n) if n <= i32::MAX as u32 => Ok(n),
            _ => self.fail(
                "not_a_whole_number",
                token.span,
                format!("`{text}` is not a whole number from 0 to 2147483647"),
            ),
        }
    }

    pub(super) fn number(&mut self, angle: bool) -> Result<Number, Reported> {
        let token = self.atom()?;
        let mut span = token.span;
        let mut text = Cow::Borrowed(self.text(token));
        if matches!(&*text, "+" | "-") {
            let digits = self.atom()?;
            span.end = digits.span.end;
            text += self.text(digits);
        }
        let suffix = self
            .tokens
            .get(self.at)
            .filter(|t| t.kind == TokenKind::Atom);
        if let Some(&suffix) = suffix.filter(|t| self.text(**t).eq_ignore_ascii_case("D")) {
            self.at += 1;
            span.end = suffix.span.end;
            text += "D";
            self.warning(
                "blank_before_suffix",
                span,
                "a blank stands between the number and its suffix D".into(),
            );
        }
        let Some(number) = Number::parse(&text) else {
            let d = Diagnostic::error("not_a_number", format!("`{text}` is not a number"));
            let exponent = text.contains(['D', 'd'])
                && Number::parse(&text.replace(['D', 'd'], "E")).is_some();
            let d = match exponent {
                true => d.help("D is the suffix of degrees; an exponent is written with E"),
                false => d,
            };
            let d = self.source.locate(self.about(d), span);
            self.out.push(d);
            return Err(Reported);
        };
        if number.degrees && !angle {
            let message = format!(
                "`{text}` means {} here: the suffix D turns degrees into radians",
                number.value()
            );
            self.warning("degrees_of_a_length", span, message);
        }
        Ok(number)
    }

    pub(super) fn word(&mut self, choices: &'static [&'static str]) -> Result<String, Reported> {
        let token = self.atom()?;
        let word = self.text(token).to_owned();
        self.choose(&word, choices, token.span)
    }

    pub(super) fn choose(
        &mut self,
        word: &str,
        choices: &'static [&'static str],
        span: Span,
    ) -> Result<String, Reported> {
        if choices.is_empty() {
            return Ok(word.to_owned());
        }
        let plural = word.strip_suffix(['S', 's']).unwrap_or(word);
        for word in [word, plural] {
            if let Meaning::One(k) = meaning(word, choices.iter().copied()) {
                return Ok(choices[k].to_owned());
            }
        }
        let near = near_names(word, choices.iter().copied());
        let d = Diagnostic::error(
            "unknown_word",
            format!("`{word}` is none of {}", choices.join(", ")),
        );
        let d = match near.is_empty() {
            true => d,
            false => d.help(format!("did you mean {}?", near.join(" or "))),
        };
        let d = self.source.locate(self.about(d), span);
        self.out.push(d);
        Err(Reported)
    }

    /// Goes on to the next token of one of these kinds, or to the end.
    fn skip_to(&mut self, ends: &[TokenKind]) {
        let rest = self.tokens.iter().skip(self.at);
        self.at += rest.take_while(|t| !ends.contains(&t.kind)).count();
    }

    pub(super) fn words(
        &mut self,
        choices: &'static [&'static str],
    ) -> Result<Vec<String>, Reported> {
        let mut all = Vec::new();
        loop {
            let from = self.at;
            self.skip_to(&[
                TokenKind::Colon,
                TokenKind::Comma,
                TokenKind::Continuation,
                TokenKind::Backslash,
            ]);
            let span = self.between(from, self.at);
            let item = self.source.slice(span).to_owned();
            all.push(self.choose(&item, choices, span)?);
            if self.take(TokenKind::Colon).is_none() {
                return Ok(all);
            }
        }
    }

    /// The rest of the line, up to a comma that begins another argument.
    pub(super) fn free_text(&mut self) -> Result<String, Reported> {
        let from = self.at;
        while let Some(t) = self.tokens.get(self.at) {
            let next = self.after_separators(self.at);
            let ends = match t.kind {
                TokenKind::Comma | TokenKind::Continuation => {
                    next >= self.tokens.len() || self.begins_argument(next)
                }
                TokenKind::Backslash => next >= self.tokens.len() || self.is_assignment(next),
                _ => false,
            };
            if ends {
                break;
            }
            if t.kind == TokenKind::Comma {
                self.colon_for_equals(next);
            }
            self.at += 1;
        }
        Ok(self.joined(from, self.at, ", ").0)
    }

    /// Texts in quotes, or bare, with commas between them.
    pub(super) fn texts(&mut self) -> Result<Vec<String>, Reported> {
        let mut all = Vec::new();
        loop {
            let from = self.at;
            self.skip_to(&[
                TokenKind::Comma,
                TokenKind::Continuation,
                TokenKind::Backslash,
            ]);
            let text = self.source.slice(self.between(from, self.at));
            let inner = text.strip_prefix('"').and_then(|t| t.strip_suffix('"'));
            all.push(inner.unwrap_or(text).to_owned());
            let next = self.after_separators(self.at);
            let quoted = self
                .tokens
                .get(next)
                .is_some_and(|t| t.kind == TokenKind::Quoted);
            if next == self.at || next >= self.tokens.len() || !quoted && self.begins_argument(next)
            {
                self.cut_by_abbreviation(next);
                return Ok(all);
            }
            self.colon_for_equals(next);
            self.at = next;
        }
    }

    /// Doubts a text that begins with a keyword and a colon: an equals sign would make it another
    /// argument.
    fn colon_for_equals(&mut self, next: usize) {
        let is = |k: usize, kind| self.tokens.get(k).is_some_and(|t| t.kind == kind);
        if !is(next, TokenKind::Atom) || !is(next + 1, TokenKind::Colon) {
            return;
        }
        let word = self.text(self.tokens[next]);
        let meant = match self.argument_meant(word) {
            Meaning::One(k) if word.len() >= LEAST_KEYWORD => self.arguments().nth(k),
            _ => None,
        };
        let Some(keyword) = meant.map(Argument::keyword) else {
            return;
        };
        let what = format!("`{word}:` is taken as text, and not as the argument {keyword}");
        let d = Diagnostic::warning("ambiguous_argument", what).help(format!(
            "{keyword}= gives that argument; a text that looks like one stands in quotation marks"
        ));
        let d = self.source.locate(self.about(d), self.tokens[next].span);
        self.out.push(d);
    }

    /// Doubts a shortened keyword that ends a list of bare texts: it may be one of them.
    fn cut_by_abbreviation(&mut self, next: usize) {
        let Some(&t) = self.tokens.get(next) else {
            return;
        };
        let word = self.text(t);
        if let (false, Meaning::One(k)) = (self.is_assignment(next), self.argument_meant(word))
            && let Some(keyword) = self.arguments().nth(k).map(Argument::keyword)
            && !keyword.eq_ignore_ascii_case(word)
        {
            let what = format!("`{word}` is taken as {keyword}, and no longer as one of the texts");
            let d = Diagnostic::warning("ambiguous_argument", what).help(format!(
                "a text that looks like a keyword stands in quotation marks: \"{word}\""
            ));
            let d = self.source.locate(self.about(d), t.span);
            self.out.push(d);
        }
    }

    /// Whatever stands there, up to what looks like another argument.
    pub(super) fn raw(&mut self, open: bool) -> Result<String, Reported> {
        let from = self.at;
        while let Some(t) = self.tokens.get(self.at) {
            if matches!(
                t.kind,
                TokenKind::Comma | TokenKind::Continuation | TokenKind::Backslash
            ) {
                let next = self.after_separators(self.at);
                let word = self
                    .tokens
                    .get(next)
                    .filter(|t| t.kind == TokenKind::Atom && !self.numeric(**t));
                if next >= self.tokens.len()
                    || self.is_assignment(next)
                    || word.is_some() && (open || self.begins_argument(next))
                {
                    break;
                }
            }
            self.at += 1;
        }
        Ok(self.joined(from, self.at, ", ").0)
    }
}
