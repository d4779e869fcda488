//! From text to commands, nothing lost: words, arguments and their values with their places.
//!
//! The grammar (`grammar/view.pest`) says what a command, a continuation and a text are. Nothing
//! here knows any command by name.

use crate::dataset::syntax::Source;
use crate::diagnostic::{Diagnostic, Span};
use pest::Parser;
use pest::iterators::Pair;

/// Generated from the grammar.
pub(super) mod grammar {
    #[derive(pest_derive::Parser)]
    #[grammar = "../grammar/view.pest"]
    pub struct View;
}
use grammar::{Rule, View};

/// Parentheses within one another, more than any file has.
pub(super) const DEEPEST: usize = 64;

/// The form of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// a word, a name, a number
    Bare,
    /// text in double quotes
    Quoted,
    /// an expression in parentheses
    Group,
}

/// A value of an argument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    pub form: Form,
    /// quotes and parentheses included
    pub span: Span,
}

/// `name = value, value`
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Argument {
    pub name: Span,
    pub values: Vec<Piece>,
}

impl Argument {
    /// Returns the place of the values, or of the name where there are none.
    pub fn span(&self) -> Span {
        match (self.values.first(), self.values.last()) {
            (Some(first), Some(last)) => Span::new(first.span.start, last.span.end),
            _ => self.name,
        }
    }
}

/// Words and arguments of a command.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Command {
    pub words: Vec<Span>,
    pub arguments: Vec<Argument>,
    pub span: Span,
}

impl Command {
    /// Returns the place of its words.
    pub fn head(&self) -> Span {
        match (self.words.first(), self.words.last()) {
            (Some(first), Some(last)) => Span::new(first.start, last.end),
            _ => self.span,
        }
    }
}

pub(super) fn span_of(pair: &Pair<Rule>) -> Span {
    let s = pair.as_span();
    Span::new(s.start(), s.end())
}

/// Takes a file apart.
pub(super) fn commands(source: &Source, out: &mut Vec<Diagnostic>) -> Vec<Command> {
    if let Some(at) = too_deep(&source.text) {
        let what = format!("more than {DEEPEST} parentheses stand within one another here");
        let d = Diagnostic::error("view_syntax", what);
        out.push(source.locate(d, Span::new(at, at + 1)));
        return Vec::new();
    }
    let pairs = match View::parse(Rule::view, &source.text) {
        Ok(pairs) => pairs,
        Err(e) => {
            let at = match e.location {
                pest::error::InputLocation::Pos(p) => p,
                pest::error::InputLocation::Span((p, _)) => p,
            };
            let d = Diagnostic::error("unreadable", "the text cannot be taken apart here");
            out.push(source.locate(d, Span::new(at, at)));
            return Vec::new();
        }
    };
    let all = pairs.flat_map(Pair::into_inner);
    let commands = all.filter(|pair| pair.as_rule() == Rule::command);
    commands.map(|pair| command(source, pair, out)).collect()
}

/// Returns where parentheses are nested too deeply, quotation marks left aside. A line without `&`
/// is not continued.
fn too_deep(text: &str) -> Option<usize> {
    let (mut depth, mut may_go_on) = (0_usize, false);
    for (at, c) in text.char_indices() {
        match c {
            '(' | '{' => depth += 1,
            ')' | '}' => depth = depth.saturating_sub(1),
            '&' => may_go_on = true,
            '\n' | '\r' if !std::mem::take(&mut may_go_on) => depth = 0,
            _ => {}
        }
        if depth > DEEPEST {
            return Some(at);
        }
    }
    None
}

/// Puts the tokens of a command together: words up to the first `name =`, then arguments.
fn command(source: &Source, pair: Pair<Rule>, out: &mut Vec<Diagnostic>) -> Command {
    let span = span_of(&pair);
    let tokens: Vec<(Rule, Span)> = pair
        .into_inner()
        .map(|p| (p.as_rule(), span_of(&p)))
        .collect();
    let mut this = Command {
        words: Vec::new(),
        arguments: Vec::new(),
        span: Span::new(
            span.start,
            tokens.last().map_or(span.end, |(_, last)| last.end),
        ),
    };
    let mut separated = true;
    for (k, &(rule, at)) in tokens.iter().enumerate() {
        let assigned = tokens.get(k + 1).is_some_and(|(r, _)| *r == Rule::equals);
        match rule {
            Rule::equals => {}
            Rule::comma => separated = true,
            Rule::atom if assigned => {
                let values = Vec::new();
                this.arguments.push(Argument { name: at, values });
                separated = true;
            }
            Rule::stray => {
                out.push(source.locate(stray(source.slice(at)), at));
            }
            _ => {
                let form = match rule {
                    Rule::string => Form::Quoted,
                    Rule::group => Form::Group,
                    _ => Form::Bare,
                };
                let Some(argument) = this.arguments.last_mut() else {
                    this.words.push(at);
                    continue;
                };
                match argument.values.last_mut() {
                    // `2.0(meter)`: a number and its unit are one value
                    Some(last) if !separated && last.span.end == at.start => {
                        last.span.end = at.end;
                        last.form = Form::Group;
                    }
                    Some(_) if !separated => {
                        let d = Diagnostic::error(
                            "view_syntax",
                            format!("`{}` stands behind a value", source.slice(at)),
                        );
                        let d = d.help(
                            "values of a list are separated by commas, a further argument is `name = value`; \
                             a command that goes on in the next line needs `&` at the end of this one",
                        );
                        out.push(source.locate(d, at));
                    }
                    _ => argument.values.push(Piece { form, span: at }),
                }
                separated = false;
            }
        }
    }
    this
}

fn stray(mark: &str) -> Diagnostic {
    let (what, help) = match mark {
        "\"" => (
            "a quotation mark without the other",
            "a text stands between two of them",
        ),
        "&" => (
            "`&` stands in the middle of a line",
            "`&` goes to the end of the line that is continued",
        ),
        _ => (
            "a parenthesis without the other",
            "an expression stands between two of them; it goes on in the next line behind `&`",
        ),
    };
    Diagnostic::error("view_syntax", what).help(help)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn taken(text: &str) -> (Vec<(String, Vec<String>)>, usize) {
        let source = Source::from_text(None, text);
        let mut out = Vec::new();
        let all = commands(&source, &mut out);
        let shown = all.iter().map(|c| {
            let words: Vec<&str> = c.words.iter().map(|w| source.slice(*w)).collect();
            let arguments = c.arguments.iter().map(|a| {
                let values: Vec<&str> = a.values.iter().map(|v| source.slice(v.span)).collect();
                format!("{}={}", source.slice(a.name), values.join("|"))
            });
            (words.join(" "), arguments.collect())
        });
        (shown.collect(), out.len())
    }

    #[test]
    fn commands_go_on_behind_an_ampersand_and_texts_over_lines() {
        let text = "! title\nmarker create &  ! a comment\n  marker_name = .m.P.M  & \r\n! between\n location = 0.0, &\n (1 + \
            2), 3  orientation=0.0d,0d,0d\nif condition = (! db_exists(\"!&\"))\n\nx y = \"a ! b\n& c\", \"C:\\temp\\\"\n";
        let (all, wrong) = taken(text);
        assert_eq!(wrong, 0);
        assert_eq!(all.len(), 3);
        assert_eq!(all[0].0, "marker create");
        assert_eq!(all[0].1[1], "location=0.0|(1 + 2)|3");
        assert_eq!(all[0].1[2], "orientation=0.0d|0d|0d");
        assert_eq!(all[1].1[0], "condition=(! db_exists(\"!&\"))");
        assert_eq!(all[2].1[0], "y=\"a ! b\n& c\"|\"C:\\temp\\\"");
    }

    #[test]
    fn marks_without_their_other_are_told_and_lose_no_other_command() {
        for text in [
            "a b = (1\nc d = 2\n",
            "a b = 1)\nc d = 2\n",
            "a b = 1 2\nc d = 2\n",
        ] {
            let (all, wrong) = taken(text);
            assert_eq!((all.len(), wrong), (2, 1), "{text}");
        }
    }
}
