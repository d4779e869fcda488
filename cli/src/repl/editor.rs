//! Help while typing: completion, colours, the signature of the function at hand, and lines that go
//! on.

use super::super::statements;
use super::commands::COMMANDS;
use super::names::{Names, words};
use super::session::Session;
use cognate::expr::ast::{Callee, Dialect};
use cognate::expr::{Profile, Symbol, names, parse, symbol};
use cognate::internals::dataset::manual;
use rustyline::completion::{Completer, Pair};
use rustyline::highlight::{CmdKind, Highlighter};
use rustyline::hint::{Hint, Hinter};
use rustyline::validate::{ValidationContext, ValidationResult, Validator};
use rustyline::{Context, Result};
use std::borrow::Cow;

/// The state of the editor while a line is typed.
pub struct Helper {
    dialect: Dialect,
    /// names defined with `:let`
    defined: Vec<String>,
    colour: bool,
}

impl Helper {
    /// Prepares for the next line of a session.
    pub fn new(session: &Session, colour: bool) -> Self {
        Self {
            dialect: session.setting.dialect,
            defined: session.names.0.keys().cloned().collect(),
            colour,
        }
    }
}

impl rustyline::Helper for Helper {}

/// Returns the start of the word that ends at the cursor.
fn word_start(line: &str, at: usize) -> usize {
    let before = line.get(..at).unwrap_or(line);
    let word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == ':';
    before
        .char_indices()
        .rev()
        .take_while(|(_, c)| word(*c))
        .last()
        .map_or(before.len(), |(i, _)| i)
}

impl Completer for Helper {
    type Candidate = Pair;

    fn complete(&self, line: &str, at: usize, _: &Context<'_>) -> Result<(usize, Vec<Pair>)> {
        let start = word_start(line, at);
        let typed = line.get(start..at).unwrap_or_default().to_ascii_uppercase();
        let pair = |display: String, replacement: String| Pair {
            display,
            replacement,
        };
        let fits = |name: &str| name.to_ascii_uppercase().starts_with(&typed);
        if typed.is_empty() {
            return Ok((start, Vec::new()));
        }
        if let Some(found) = of_statements(line.get(..start).unwrap_or_default(), &typed) {
            return Ok((start, found));
        }
        let commands = COMMANDS
            .iter()
            .filter(|c| fits(c.0))
            .map(|(name, arguments, _)| pair(format!("{name} {arguments}"), format!("{name} ")));
        let known = names(self.dialect)
            .iter()
            .filter(|n| fits(n.0))
            .map(|&(name, meaning)| match meaning {
                Symbol::Constant(_) => pair(name.into(), name.into()),
                Symbol::If => pair(
                    "IF(selector: negative, zero, positive)".into(),
                    "IF(".into(),
                ),
                Symbol::Callee(callee) => pair(callee.signature(), format!("{name}(")),
            });
        let defined = self
            .defined
            .iter()
            .filter(|n| fits(n))
            .map(|n| pair(n.clone(), n.clone()));
        Ok((start, commands.chain(known).chain(defined).collect()))
    }
}

/// Returns what completes a word of a statement: after `:help` and `:statements` its keyword, after
/// `KEYWORD/` the keywords of its arguments; `None` where an expression is typed.
fn of_statements(before: &str, typed: &str) -> Option<Vec<Pair>> {
    let pair = |display: String, replacement: String| Pair {
        display,
        replacement,
    };
    let command = before.trim();
    if matches!(command, ":help" | ":h" | ":?" | ":statements") {
        let pages = manual::all().map(|(_, page)| page);
        let statements = pages
            .filter(|page| page.keyword.starts_with(typed))
            .map(|page| {
                pair(
                    format!("{}: {}", page.keyword, page.summary),
                    page.keyword.into(),
                )
            });
        let functions = names(Dialect::Function)
            .iter()
            .filter(|n| command != ":statements" && n.0.starts_with(typed))
            .map(|n| pair(n.0.into(), n.0.into()));
        return Some(statements.chain(functions).collect());
    }
    let (keyword, _) = before.split_once('/')?;
    let keyword = keyword.trim();
    let is_word = !keyword.is_empty()
        && keyword
            .bytes()
            .all(|b| b.is_ascii_alphabetic() || b == b'_');
    // TIME, which has no arguments, may also be the beginning of a quotient
    let page = manual::page(keyword).filter(|page| is_word && !page.entries().is_empty())?;
    let arguments = page.entries().into_iter();
    let fitting = arguments.filter(|entry| entry.note.name.starts_with(typed));
    Some(
        fitting
            .map(|entry| pair(statements::form(&entry), entry.note.name.into()))
            .collect(),
    )
}

/// The rest of a signature, shown behind the cursor; it is not typed.
pub struct Signature(String);

impl Hint for Signature {
    fn display(&self) -> &str {
        &self.0
    }
    fn completion(&self) -> Option<&str> {
        None
    }
}

impl Hinter for Helper {
    type Hint = Signature;

    fn hint(&self, line: &str, at: usize, _: &Context<'_>) -> Option<Signature> {
        let before = line.get(..at).filter(|_| at == line.len())?;
        let call = open_call(before)?;
        let signature = match symbol(call.name, self.dialect, Profile::Ideas)? {
            Symbol::Constant(_) => return None,
            Symbol::If => "IF(selector: negative, zero, positive)".into(),
            Symbol::Callee(callee) => Callee::signature(callee),
        };
        rest_of(&signature, call.n_arguments, call.is_begun).map(Signature)
    }
}

/// The call that the cursor stands in.
struct OpenCall<'l> {
    name: &'l str,
    /// separators so far: as many arguments are complete
    n_arguments: usize,
    /// something of the present argument has been typed
    is_begun: bool,
}

/// Returns the innermost call whose parenthesis is open at the end of a text.
fn open_call(before: &str) -> Option<OpenCall<'_>> {
    let (mut depth, mut n_arguments) = (0_usize, 0);
    let is_begun = !before.trim_end().ends_with(['(', ',', ':']);
    for (at, c) in before.char_indices().rev() {
        match c {
            ')' => depth += 1,
            '(' if depth > 0 => depth -= 1,
            '(' => {
                let head = before[..at].trim_end();
                let name = &head[word_start(head, head.len())..];
                let call = OpenCall {
                    name,
                    n_arguments,
                    is_begun,
                };
                return (!name.is_empty()).then_some(call);
            }
            ',' | ':' if depth == 0 => n_arguments += 1,
            _ => {}
        }
    }
    None
}

/// Returns what is left of a signature behind some complete arguments, and behind the present one
/// where it has been begun; `None` where there is nothing left to type.
fn rest_of(signature: &str, n_arguments: usize, is_begun: bool) -> Option<String> {
    let (_, arguments) = signature.split_once('(')?;
    let separators = arguments.match_indices([',', ':']).map(|(at, _)| at);
    let starts: Vec<usize> = std::iter::once(0)
        .chain(separators.map(|at| at + 1))
        .collect();
    let goes_on = arguments.contains('…') || arguments.contains("...");
    let from = match starts.get(n_arguments) {
        Some(&from) => from,
        // the last may be repeated
        None if goes_on => starts[starts.len() - 1],
        None => return None,
    };
    if !is_begun {
        return Some(arguments[from..].trim_start().to_owned());
    }
    let next = arguments[from..].find([',', ':', ')', '[']);
    next.map(|at| arguments[from + at..].to_owned())
}

/// Colours of the terminal's own palette: functions, constants and names, numbers, commands,
/// unknown names.
const FUNCTION: &str = "\x1b[34m";
const NAME: &str = "\x1b[35m";
const NUMBER: &str = "\x1b[36m";
const COMMAND: &str = "\x1b[1m";
const UNKNOWN: &str = "\x1b[31m";
const FAINT: &str = "\x1b[2m";
const PLAIN: &str = "\x1b[0m";

impl Highlighter for Helper {
    fn highlight<'l>(&self, line: &'l str, _: usize) -> Cow<'l, str> {
        if !self.colour {
            return Cow::Borrowed(line);
        }
        let (command, expression) = match line.split_once(char::is_whitespace) {
            _ if !line.starts_with(':') => ("", line),
            Some((command, rest)) => (command, &line[line.len() - rest.len() - 1..]),
            None => (line, ""),
        };
        let mut out = if command.is_empty() {
            String::new()
        } else {
            format!("{COMMAND}{command}{PLAIN}")
        };
        let painted = matches!(command, "" | ":let" | ":plot" | ":explain" | ":time");
        for word in words(expression) {
            let colour = if painted { self.colour_of(word) } else { "" };
            out.extend([colour, word, if colour.is_empty() { "" } else { PLAIN }]);
        }
        Cow::Owned(out)
    }
    fn highlight_hint<'h>(&self, hint: &'h str) -> Cow<'h, str> {
        if self.colour {
            Cow::Owned(format!("{FAINT}{hint}{PLAIN}"))
        } else {
            Cow::Borrowed(hint)
        }
    }
    fn highlight_char(&self, _: &str, _: usize, _: CmdKind) -> bool {
        self.colour
    }
}

impl Helper {
    /// Returns the colour of a word.
    fn colour_of(&self, word: &str) -> &'static str {
        match word.chars().next() {
            Some(c) if c.is_ascii_digit() || c == '.' => NUMBER,
            Some('!') => FAINT,
            Some(c) if c.is_ascii_alphabetic() => {
                match symbol(word, self.dialect, Profile::Ideas) {
                    Some(Symbol::Constant(_)) => NAME,
                    Some(Symbol::If | Symbol::Callee(_)) => FUNCTION,
                    None if self.defined.iter().any(|n| n.eq_ignore_ascii_case(word)) => NAME,
                    // while it is being typed a name may still become a known one
                    None if names(self.dialect).iter().any(|n| {
                        n.0.to_ascii_uppercase()
                            .starts_with(&word.to_ascii_uppercase())
                    }) =>
                    {
                        ""
                    }
                    None => UNKNOWN,
                }
            }
            _ => "",
        }
    }
}

impl Validator for Helper {
    fn validate(&self, context: &mut ValidationContext<'_>) -> Result<ValidationResult> {
        let mut session = Session::new(self.dialect);
        // defined names count as numbers for completeness
        let numbers = self.defined.iter().map(|n| (n.clone(), "1".to_owned()));
        session.names = Names(numbers.collect());
        let incomplete = session.is_incomplete(context.input());
        debug_assert!(!incomplete || parse(context.input(), self.dialect, Profile::Adams).is_err());
        Ok(if incomplete {
            ValidationResult::Incomplete
        } else {
            ValidationResult::Valid(None)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustyline::history::DefaultHistory;

    fn helper() -> Helper {
        Helper {
            dialect: Dialect::Function,
            defined: vec!["OMEGA".into()],
            colour: true,
        }
    }

    #[test]
    fn names_are_completed_with_their_parenthesis() {
        let history = DefaultHistory::new();
        let context = Context::new(&history);
        let complete = |line: &str| helper().complete(line, line.len(), &context).unwrap();
        let (start, found) = complete("2*ste");
        assert_eq!(start, 2);
        assert_eq!(
            found
                .iter()
                .map(|p| p.replacement.as_str())
                .collect::<Vec<_>>(),
            ["STEP(", "STEP5("]
        );
        assert!(complete("om").1.iter().any(|p| p.replacement == "OMEGA"));
        assert!(complete(":pl").1.iter().any(|p| p.replacement == ":plot "));
        assert!(complete("").1.is_empty());
    }

    #[test]
    fn statements_and_their_arguments_are_completed() {
        let history = DefaultHistory::new();
        let context = Context::new(&history);
        let complete = |line: &str| {
            let (_, found) = helper().complete(line, line.len(), &context).unwrap();
            found.into_iter().map(|p| p.replacement).collect::<Vec<_>>()
        };
        assert!(complete(":help cont").contains(&"CONTACT".to_owned()));
        assert_eq!(complete(":statements fric"), ["FRICTION"]);
        assert!(complete("CONTACT/1, IGEOM=2, st").contains(&"STIFFNESS".to_owned()));
        // a quotient is no statement
        assert!(complete("TIME/2 + ste").contains(&"STEP(".to_owned()));
    }

    #[test]
    fn the_signature_is_shown_where_arguments_begin() {
        let history = DefaultHistory::new();
        let context = Context::new(&history);
        let hint = |line: &str| helper().hint(line, line.len(), &context).map(|h| h.0);
        assert_eq!(hint("1+step("), Some("x, x0, h0, x1, h1)".into()));
        assert_eq!(hint("(").or(hint("TIME(")).or(hint("STEP")), None);
        // and kept while they are typed
        assert_eq!(hint("step(TIME"), Some(", x0, h0, x1, h1)".into()));
        assert_eq!(hint("step(TIME, "), Some("x0, h0, x1, h1)".into()));
        assert_eq!(
            hint("2*STEP(SIN(3*TIME), 0, (1+2)"),
            Some(", x1, h1)".into())
        );
        assert_eq!(hint("STEP(TIME, 0, 0, 1, 2"), Some(")".into()));
        assert_eq!(
            hint("STEP(TIME, 0, 0, 1, 2)").or(hint("STEP(1,2,3,4,5,")),
            None
        );
        assert_eq!(
            hint("IF(TIME-1: "),
            Some("negative, zero, positive)".into())
        );
    }

    #[test]
    fn colours_leave_the_text_as_it_is() {
        let line = ":plot SIN(OMEGA*TIME)+3.5E2D*foo 0 1";
        let painted = helper().highlight(line, 0).into_owned();
        assert!(
            painted.contains("\x1b[34mSIN")
                && painted.contains("\x1b[31mfoo")
                && painted.contains("\x1b[36m3.5E2D")
        );
        let mut plain = painted;
        [FUNCTION, NAME, NUMBER, COMMAND, UNKNOWN, FAINT, PLAIN]
            .iter()
            .for_each(|c| plain = plain.replace(c, ""));
        assert_eq!(plain, line);
    }
}
