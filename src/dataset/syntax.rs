//! From bytes to statements and their tokens, nothing lost: every comment, mark and word with its
//! place.
//!
//! The grammar (`grammar/dataset.pest`) says what a statement, a continuation and a comment are.
//! Nothing here knows any statement by name.

use super::frequent;
use crate::diagnostic::{Diagnostic, Span};
pub use crate::encoding::Encoding;
use pest::Parser;
use pest::iterators::Pair;

/// A text with its file name, its encoding and the beginnings of its lines.
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// file it came from, as shown in messages
    pub file: Option<String>,
    /// the text; bytes that are not UTF-8 were taken as UTF-16 or Windows-1252
    pub text: String,
    /// how it stood in the file, and is to be written again
    pub encoding: Encoding,
    line_starts: Vec<usize>,
    /// the pieces of several files that the text consists of; none: it is that of one
    pieces: Vec<Piece>,
    /// the text of the file itself, where it includes others
    own: Option<String>,
}

/// Whole lines of one file within a text of several.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// first byte within the text
    pub start: usize,
    /// the same byte within its file
    pub at: usize,
    /// 1-based line of its file
    pub line: usize,
    /// its file
    pub file: Option<String>,
}

/// Part of the bytes that are control characters from which on they are no text: of random bytes a
/// tenth is, and a text has a stray one at most.
const MOST_CONTROL: f64 = 0.03;
/// Number of stray ones that even a short text may have.
const STRAY: usize = 4;

/// Returns whether bytes are no text of any encoding; zeros at the end are padding.
pub(super) fn is_no_text(bytes: &[u8]) -> bool {
    let end = bytes.iter().rposition(|&b| b != 0).map_or(0, |k| k + 1);
    let text = bytes.get(..end).unwrap_or_default();
    let is_control = |&b: &u8| b.is_ascii_control() & !matches!(b, b'\t' | b'\n' | 0x0C | b'\r');
    let control: usize = text.iter().map(|b| usize::from(is_control(b))).sum();
    let is_much = control > STRAY && control as f64 > MOST_CONTROL * text.len() as f64;
    is_much && !matches!(Encoding::of(bytes), Encoding::Utf16 { .. })
}

impl Source {
    /// A text given by a program.
    pub fn from_text(file: Option<&str>, text: impl Into<String>) -> Self {
        let text = text.into();
        let mut line_starts = vec![0];
        let bytes = text.as_bytes();
        if text.contains('\r') {
            for (k, &b) in bytes.iter().enumerate() {
                if b == b'\n' || b == b'\r' && bytes.get(k + 1) != Some(&b'\n') {
                    line_starts.push(k + 1);
                }
            }
        } else {
            line_starts.extend(text.match_indices('\n').map(|(k, _)| k + 1));
        }
        Self {
            file: file.map(str::to_owned),
            text,
            encoding: Encoding::Utf8,
            line_starts,
            pieces: Vec::new(),
            own: None,
        }
    }

    /// Returns a text of several files, in the place of this one, which includes the others.
    pub(super) fn within(self, text: String, pieces: Vec<Piece>) -> Self {
        Self {
            pieces,
            own: Some(self.text),
            encoding: self.encoding,
            ..Self::from_text(self.file.as_deref(), text)
        }
    }

    /// Returns the text of the file itself, without those that it includes.
    pub fn own_text(&self) -> &str {
        self.own.as_deref().unwrap_or(&self.text)
    }

    /// Returns the files that it includes.
    pub fn included(&self) -> impl Iterator<Item = &str> {
        let files = self.pieces.iter().map(|piece| &piece.file);
        let others = files.filter(|file| **file != self.file);
        others.filter_map(|file| file.as_deref())
    }

    /// Returns the lines, with their ends.
    pub(super) fn lines(&self) -> impl Iterator<Item = Span> {
        let ends = self.line_starts.iter().copied().skip(1);
        let lines = self.line_starts.iter().zip(ends.chain([self.text.len()]));
        lines.map(|(&start, end)| Span::new(start, end))
    }

    /// Returns the piece that a byte belongs to; `None`: the text is that of one file.
    fn piece(&self, offset: usize) -> Option<&Piece> {
        let after = self.pieces.partition_point(|piece| piece.start <= offset);
        self.pieces.get(after.saturating_sub(1))
    }

    /// Returns the file of a byte.
    pub(super) fn file_at(&self, offset: usize) -> Option<&str> {
        let piece = self.piece(offset);
        piece.map_or(self.file.as_deref(), |piece| piece.file.as_deref())
    }

    /// Returns the bytes within its file of a span; a span ends in the piece in which it begins.
    pub(super) fn in_file(&self, span: Span) -> Span {
        match self.piece(span.start) {
            None => span,
            Some(piece) => {
                let start = span.start - piece.start + piece.at;
                Span::new(start, start + (span.end - span.start))
            }
        }
    }

    /// The bytes of a file: UTF-16 or UTF-8 if they are, otherwise Windows-1252.
    pub fn from_bytes(file: Option<&str>, bytes: &[u8]) -> Self {
        let encoding = Encoding::of(bytes);
        Self {
            encoding,
            ..Self::from_text(file, encoding.decode(bytes).unwrap_or_default())
        }
    }

    /// The bytes to write for a text of this encoding.
    pub fn encode(&self, text: &str) -> Vec<u8> {
        self.encoding.encode(text)
    }

    /// Returns whether the file is one of RecurDyn (`.rmd`), whose statements have further
    /// arguments.
    pub(super) fn is_of_recurdyn(&self) -> bool {
        let ending = self.file.as_deref().and_then(|f| f.rsplit_once('.'));
        ending.is_some_and(|(_, ending)| ending.eq_ignore_ascii_case("rmd"))
    }

    /// 1-based line and column (in characters) of a byte, within its file.
    pub fn place(&self, offset: usize) -> (usize, usize) {
        let line = self.line_of(offset);
        let start = self.line_starts.get(line - 1).copied().unwrap_or(0);
        let before = self.text.get(start..offset.min(self.text.len()));
        let column = before.map_or(0, |s| s.chars().count()) + 1;
        match self.piece(offset) {
            None => (line, column),
            Some(piece) => (line - self.line_of(piece.start) + piece.line, column),
        }
    }

    /// Returns whether nothing but a comment stands before a byte in its line.
    pub(super) fn begins_line(&self, offset: usize) -> bool {
        let start = self.line_starts[self.line_of(offset) - 1];
        let before = self.text.get(start..offset).unwrap_or_default();
        before.trim_start().starts_with('!')
    }

    /// 1-based line of a byte within the text.
    fn line_of(&self, offset: usize) -> usize {
        self.line_starts.partition_point(|&s| s <= offset).max(1)
    }

    /// Returns what is said about a line and column of the file of a byte, with that file and the
    /// word there.
    pub(super) fn located_in_file_of(&self, offset: usize, d: Diagnostic) -> Diagnostic {
        let file = self.file_at(offset).map(str::to_owned);
        let alike = |piece: &&Piece| piece.file == file && piece.line <= d.line;
        let piece = self.pieces.iter().rfind(alike);
        let shift = piece.map_or(0, |piece| {
            self.line_of(piece.start) as isize - piece.line as isize
        });
        let word = (d.line.checked_add_signed(shift)).and_then(|line| self.word_at(line, d.column));
        Diagnostic {
            span: word.map(|word| self.in_file(word)),
            file,
            ..d
        }
    }

    /// The word at a 1-based line and column of the text.
    pub(super) fn word_at(&self, line: usize, column: usize) -> Option<Span> {
        let start = *self.line_starts.get(line.checked_sub(1)?)?;
        let rest = self.text.get(start..)?;
        let offset = rest.char_indices().nth(column.checked_sub(1)?)?.0;
        let word = rest.get(offset..)?;
        let ends = |c: char| c.is_whitespace() || matches!(c, ',' | '(' | ')' | '=' | '\\');
        let length = word.find(ends).unwrap_or(word.len()).max(1);
        Some(Span::new(start + offset, start + offset + length))
    }

    /// The text of a span.
    pub fn slice(&self, span: Span) -> &str {
        self.text.get(span.start..span.end).unwrap_or("")
    }

    /// The diagnostic with file, line and column of a span of this source.
    pub fn locate(&self, diagnostic: Diagnostic, span: Span) -> Diagnostic {
        let (line, column) = self.place(span.start);
        Diagnostic {
            file: self.file_at(span.start).map(str::to_owned),
            span: Some(self.in_file(span)),
            line,
            column,
            ..diagnostic
        }
    }
}

/// The kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// a word, a number, a sign: anything between marks
    Atom,
    /// text in double quotes, quotes included
    Quoted,
    /// a comma between two things on one line
    Comma,
    /// a comma that begins a line and continues the statement
    Continuation,
    /// `=`, between a keyword and its value
    Equals,
    /// `:`, between words of a list or branches of an IF
    Colon,
    /// `/`, between a statement and its number, or a division
    Slash,
    /// `\`, at the end of an expression
    Backslash,
    /// `(`
    Open,
    /// `)`
    Close,
    /// `&` at the end of a line
    Carry,
    /// a comment between the lines of a statement or after its last
    Comment,
    /// a mark that means nothing where it stands
    Stray,
}

impl TokenKind {
    /// Returns whether it stands between arguments.
    pub(super) fn separates(self) -> bool {
        matches!(self, Self::Comma | Self::Continuation | Self::Backslash)
    }
}

/// A word or mark of a statement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Token {
    /// what it is
    pub kind: TokenKind,
    /// where it stands
    pub span: Span,
}

/// The items of a file, in order.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// a comment on its own, `!` included
    Comment(Span),
    /// a statement
    Statement(Tokens),
}

impl Item {
    /// From its first byte to its last.
    pub fn span(&self) -> Span {
        match self {
            Item::Comment(span) => *span,
            Item::Statement(tokens) => tokens.span,
        }
    }
}

/// The tokens of one statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Tokens {
    /// from its first character to its last
    pub span: Span,
    /// at least one
    pub tokens: Vec<Token>,
    /// `adams_view_name` of the comments before it
    pub name: Option<String>,
}

/// A dataset or command file taken apart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Syntax {
    /// the first line of a dataset
    pub title: Span,
    /// comments and statements
    pub items: Vec<Item>,
    /// the END statement, where there is one
    pub end: Option<Span>,
    /// what follows END
    pub after: Span,
}

/// Generated from the grammars.
mod grammar {
    #[derive(pest_derive::Parser)]
    #[grammar = "../grammar/dataset.pest"]
    #[grammar = "../grammar/command.pest"]
    pub struct Grammar;
}
use grammar::{Grammar, Rule};

/// Takes a dataset apart.
pub fn dataset(source: &Source, out: &mut Vec<Diagnostic>) -> Syntax {
    frequent::dataset(&source.text).unwrap_or_else(|| dataset_by_grammar(source, out))
}

/// Takes a dataset apart as the grammar says, whatever stands in it.
pub(super) fn dataset_by_grammar(source: &Source, out: &mut Vec<Diagnostic>) -> Syntax {
    parse(source, Rule::dataset, out)
}

/// Takes a command file, or the part of it after the headings, apart.
pub fn script(source: &Source, out: &mut Vec<Diagnostic>) -> Syntax {
    frequent::script(&source.text).unwrap_or_else(|| script_by_grammar(source, out))
}

/// Takes a command file apart as the grammar says, whatever stands in it.
pub(super) fn script_by_grammar(source: &Source, out: &mut Vec<Diagnostic>) -> Syntax {
    parse(source, Rule::script, out)
}

/// The first two lines of a command file.
pub fn headings(source: &Source) -> Vec<Span> {
    // two lines have two ends of two characters at most
    let mut ends = source.text.match_indices(['\n', '\r']);
    let beyond = ends.nth(4).map_or(source.text.len(), |end| end.0);
    let Ok(pairs) = Grammar::parse(Rule::heading, &source.text[..beyond]) else {
        return Vec::new();
    };
    let lines = pairs.flat_map(|p| p.into_inner());
    lines
        .filter(|p| p.as_rule() == Rule::line)
        .map(|p| span_of(&p))
        .collect()
}

fn parse(source: &Source, rule: Rule, out: &mut Vec<Diagnostic>) -> Syntax {
    let mut syntax = Syntax::default();
    let pairs = match Grammar::parse(rule, &source.text) {
        Ok(pairs) => pairs,
        Err(e) => {
            let at = match e.location {
                pest::error::InputLocation::Pos(p) => p,
                pest::error::InputLocation::Span((p, _)) => p,
            };
            let d = Diagnostic::error("unreadable", "the text cannot be taken apart here");
            out.push(source.locate(d, Span::new(at, at)));
            return syntax;
        }
    };
    let mut name = None;
    for pair in pairs.flat_map(|p| p.into_inner()) {
        let span = span_of(&pair);
        match pair.as_rule() {
            Rule::title => syntax.title = span,
            Rule::comment => {
                name = view_name(pair.as_str()).or(name);
                syntax.items.push(Item::Comment(span));
            }
            Rule::statement => {
                let tokens: Vec<Token> = pair.into_inner().map(|p| token(&p)).collect();
                let span = tokens
                    .last()
                    .map_or(span, |t| Span::new(span.start, t.span.end));
                let name = name.take();
                syntax
                    .items
                    .push(Item::Statement(Tokens { span, tokens, name }));
            }
            Rule::end => syntax.end = Some(span),
            Rule::after => syntax.after = span,
            _ => {}
        }
    }
    syntax
}

fn span_of(pair: &Pair<Rule>) -> Span {
    let s = pair.as_span();
    Span::new(s.start(), s.end())
}

fn token(pair: &Pair<Rule>) -> Token {
    let kind = match pair.as_rule() {
        Rule::atom => TokenKind::Atom,
        Rule::string => TokenKind::Quoted,
        Rule::comma | Rule::dangling => TokenKind::Comma,
        Rule::continuation => TokenKind::Continuation,
        Rule::equals => TokenKind::Equals,
        Rule::colon => TokenKind::Colon,
        Rule::slash => TokenKind::Slash,
        Rule::backslash | Rule::hanging => TokenKind::Backslash,
        Rule::open => TokenKind::Open,
        Rule::close => TokenKind::Close,
        Rule::carry => TokenKind::Carry,
        Rule::comment => TokenKind::Comment,
        _ => TokenKind::Stray,
    };
    Token {
        kind,
        span: span_of(pair),
    }
}

/// The name in a comment `! adams_view_name='…'`.
pub(super) fn view_name(comment: &str) -> Option<String> {
    const KEY: &str = "adams_view_name";
    let at = comment
        .as_bytes()
        .windows(KEY.len())
        .position(|w| w.eq_ignore_ascii_case(KEY.as_bytes()))?;
    let rest = comment.get(at + KEY.len()..)?.trim_start();
    let rest = rest.strip_prefix('=')?.trim_start().strip_prefix('\'')?;
    rest.split_once('\'').map(|(name, _)| name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A line ends with `\n`, with `\r\n`, or with `\r` alone.
        #[test]
        fn lines_begin_behind_every_end(
            pieces in proptest::collection::vec(0..4_usize, 0..20),
            only in any::<bool>(),
        ) {
            const PIECES: [&str; 4] = ["ab", "\n", "\r\n", "\r"];
            let most = if only { 2 } else { 4 };
            let text: String = pieces.iter().map(|&k| PIECES[k % most]).collect();
            let source = Source::from_text(None, text.as_str());
            let bytes = text.as_bytes();
            let is_alone = |k: usize| bytes.get(k + 1) != Some(&b'\n');
            let ends = |k: &usize| bytes[*k] == b'\n' || bytes[*k] == b'\r' && is_alone(*k);
            let begins = [0].into_iter().chain((0..bytes.len()).filter(ends).map(|k| k + 1));
            prop_assert_eq!(source.line_starts, begins.collect::<Vec<_>>());
        }
    }
}
