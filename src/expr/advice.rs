//! The message for a mistake in an expression: one sentence that names it, and advice for common
//! habits.
//!
//! The tables of what users of other languages bring along stand in `foreign.rs`. Advice is given
//! only where it fits; a mistake that is plain gets none.

use super::ast::{Callee, Dialect};
use super::foreign::{ASSIGNED, CHARACTERS, DEGREES, EXPRESSION_NAMES, NAMES, RADIANS, UNITS};
use super::names::Names;
use super::signature::Kind;
use super::symbols::{self, Symbol};
use super::token::{self, About, Fault, FaultKind, Lexer, Open};
use crate::diagnostic::{Diagnostic, Span, counted, near_names};

/// Returns the diagnostic for the first mistake of a text.
pub(crate) fn explain(text: &str, dialect: Dialect, names: &Names, fault: &Fault) -> Diagnostic {
    let place = Place {
        text,
        dialect,
        names,
        span: fault.span,
    };
    let (message, help) = match (fault.kind, fault.about) {
        (FaultKind::BadCharacter, _) => place.bad_character(),
        (FaultKind::BadNumber, _) => place.bad_number(),
        (FaultKind::UnknownName, _) => place.unknown_name(),
        (FaultKind::NotCallable, _) => place.not_callable(),
        (
            FaultKind::UnexpectedEnd,
            About::Token {
                after_operand,
                inside,
            },
        ) => place.unexpected_end(after_operand, inside),
        (FaultKind::EmptyArgument, _) => place.empty_argument(),
        (FaultKind::MissingArguments, About::Token { inside, .. }) => {
            place.missing_arguments(inside)
        }
        (
            _,
            About::Token {
                after_operand,
                inside,
            },
        ) => place.unexpected_token(after_operand, inside),
        (_, About::Count(callee, count)) => {
            arity(callee.name(), callee.arity(), callee.signature(), count)
        }
        (_, About::NamedCount(entry, count)) => {
            let entry = names.entry(entry);
            let n = entry.arguments.len();
            arity(&entry.name, (n, n), entry.signature(), count)
        }
        (kind, About::Argument(callee, k)) => place.argument(kind, callee, k),
        (kind, About::Limit(limit)) => beyond(kind, limit),
        (kind, About::Place) => (kind.code().replace('_', " "), vec![]),
    };
    let mut said = at(text, fault.kind.code(), message, fault.span);
    said.help = help;
    match place.unclosed(fault) {
        Some(parenthesis) => said.mark(parenthesis, "this parenthesis is not closed"),
        None => said,
    }
}

/// Returns an error at a place of an expression; its column counts all characters of the text.
pub(crate) fn at(
    text: &str,
    code: &'static str,
    message: impl Into<String>,
    span: Span,
) -> Diagnostic {
    let mut said = Diagnostic::error(code, message).at(text, span);
    let before = text.get(..span.start).unwrap_or(text);
    said.line = 1;
    said.column = before.chars().count() + 1;
    said
}

/// The sentence of a message, and advice.
type Said = (String, Vec<String>);

/// The text, its language, and where the mistake is.
struct Place<'a> {
    text: &'a str,
    dialect: Dialect,
    names: &'a Names,
    span: Span,
}

impl Place<'_> {
    fn word(&self) -> &str {
        self.text
            .get(self.span.start..self.span.end)
            .unwrap_or_default()
    }
    fn before(&self) -> &str {
        self.text.get(..self.span.start).unwrap_or_default()
    }
    fn after(&self) -> &str {
        self.text.get(self.span.end..).unwrap_or_default()
    }

    /// Words a character that does not belong to the language.
    fn bad_character(&self) -> Said {
        let c = self.word();
        let mut help = Vec::new();
        if let Some(advice) = self.equals_sign(c).or_else(|| self.absolute_value(c)) {
            help.push(advice);
        } else if c == "." && self.is_relation() {
            help.push(NO_COMPARISONS.to_string());
        } else if let Some(name) = self.view_name().filter(|_| [".", "$"].contains(&c)) {
            help.push(of_view(&name));
        } else if c == "." {
            help.push("a point belongs to a number: 0.5, .5 or 5.".to_string());
        } else if let Some((_, advice)) = CHARACTERS.iter().find(|(list, _)| list.contains(c)) {
            help.push((*advice).to_string());
        }
        (format!("`{}` is no part of the language", shown(c)), help)
    }

    /// Advises on a leading `=`, as in a table calculation.
    fn equals_sign(&self, c: &str) -> Option<String> {
        let leads = c == "=" && self.before().trim().is_empty();
        leads.then(|| "an expression begins without an equals sign: leave it out".to_string())
    }

    /// Advises on `|x|`.
    fn absolute_value(&self, c: &str) -> Option<String> {
        let (inside, _) = self.after().split_once('|').filter(|_| c == "|")?;
        let inside = inside.trim();
        (!inside.is_empty()).then(|| format!("an absolute value is written ABS({inside})"))
    }

    /// Returns the name of Adams View that begins here: `.MODEL.PART.MAR`, `$x`, `MODEL_1.PART_2`,
    /// `MARKER_1`.
    fn view_name(&self) -> Option<String> {
        let rest = self.text.get(self.span.start..)?;
        let part = |c: char| c.is_ascii_alphanumeric() || "_.$".contains(c);
        let end = rest.find(|c| !part(c)).unwrap_or(rest.len());
        let name = rest[..end].trim_end_matches('.');
        let words = name.trim_start_matches(['.', '$']);
        let begins = words.starts_with(|c: char| c.is_ascii_alphabetic());
        let is_one = begins && (words.len() < name.len() || name.contains(['.', '_']));
        is_one.then(|| name.to_string())
    }

    /// Returns whether `.GT.` or the like begins here.
    fn is_relation(&self) -> bool {
        let word = self
            .after()
            .split(|c: char| !c.is_ascii_alphabetic())
            .next();
        let relations = ["GT", "GE", "LT", "LE", "EQ", "NE", "AND", "OR", "NOT"];
        word.is_some_and(|word| relations.iter().any(|r| r.eq_ignore_ascii_case(word)))
    }

    /// Words a literal that is not a number.
    fn bad_number(&self) -> Said {
        let word = self.word();
        let upper = word.to_ascii_uppercase();
        if let Some(advice) = based(&upper) {
            return (format!("`{word}` is not a number"), vec![advice]);
        }
        let digits = upper.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
        let mantissa = &word[..word.len() - digits.len()];
        let unit = self.unit(mantissa, &word[mantissa.len()..]);
        let advice = match digits.split_at_checked(1) {
            _ if unit.is_some() => unit.unwrap_or_default(),
            Some(("D", rest)) if rest.starts_with(|c: char| c.is_ascii_digit()) => {
                format!(
                    "write {mantissa}E{rest} for an exponent; D is the suffix for degrees and ends the number"
                )
            }
            Some(("D", "")) => {
                "numbers have no suffix here: angles are degrees already".to_string()
            }
            Some(("E", "" | "+" | "-")) => "digits are missing after the exponent's E".to_string(),
            _ if mantissa.matches('.').count() > 1 => "a number has one decimal point".to_string(),
            Some((first, _))
                if first.starts_with(|c: char| c.is_ascii_alphabetic()) && first != "E" =>
            {
                format!(
                    "multiplication is written {mantissa}*{}",
                    &word[mantissa.len()..]
                )
            }
            _ if upper.parse::<f64>().is_ok_and(f64::is_infinite) => {
                "numbers end at 1.8E308".to_string()
            }
            _ => "a number is digits, a point, and an exponent such as E-3, without blanks"
                .to_string(),
        };
        (format!("`{word}` is not a number"), vec![advice])
    }

    /// Advises on a unit behind a number.
    fn unit(&self, number: &str, word: &str) -> Option<String> {
        let is_one_of = |list: &[&str]| list.iter().any(|unit| unit.eq_ignore_ascii_case(word));
        let advice = match self.dialect {
            Dialect::Function if is_one_of(DEGREES) => {
                format!("degrees are written with the suffix D: {number}D")
            }
            Dialect::Expression if is_one_of(DEGREES) => {
                format!("angles are degrees already: {number}")
            }
            Dialect::Function if is_one_of(RADIANS) => {
                format!("a number without suffix is radians already: {number}")
            }
            _ if is_one_of(UNITS) => {
                format!("numbers carry no unit, UNITS of the model says what they mean: {number}")
            }
            _ => return None,
        };
        Some(advice)
    }

    /// Words a name that has no meaning, with near names.
    fn unknown_name(&self) -> Said {
        let word = self.word();
        let table = match self.dialect {
            Dialect::Function => NAMES,
            Dialect::Expression => EXPRESSION_NAMES,
        };
        let mut help = Vec::new();
        let called = self.after().trim_start().starts_with('(');
        if let Some((_, advice)) = table
            .iter()
            .find(|(name, _)| name.eq_ignore_ascii_case(word))
        {
            help.push((*advice).to_string());
        } else if let Some(advice) = self.assignment() {
            help.push(advice);
        } else if let Some(name) = self.view_name() {
            help.push(of_view(&name));
        } else {
            let own = self.names.entries().iter();
            let known = symbols::names(self.dialect).iter();
            let near = near_names(
                word,
                known
                    // a single letter is near to all names of two
                    .filter(|entry| called || word.len() > 2 || is_constant(entry.1))
                    .map(|entry| entry.0)
                    .chain(own.map(|entry| entry.name.as_str())),
            );
            if !near.is_empty() {
                help.push(format!("did you mean {}?", near.join(" or ")));
            }
            let is_alone = self.names.entries().is_empty();
            if self.dialect == Dialect::Function && !called && near.is_empty() && is_alone {
                help.push(NO_VARIABLES.to_string());
            }
        }
        let what = if called {
            "function"
        } else {
            "constant or function"
        };
        (format!("there is no {what} `{word}`"), help)
    }

    /// Advises on `FUNCTION=` before an expression, or another name that is to become it.
    fn assignment(&self) -> Option<String> {
        let rest = self.after().trim_start().strip_prefix('=')?;
        if rest.starts_with('=') || !self.before().trim().is_empty() {
            return None;
        }
        let word = self.word();
        Some(if ASSIGNED.iter().any(|a| a.eq_ignore_ascii_case(word)) {
            format!("`{word}=` belongs to the dataset; the expression is what stands behind it")
        } else {
            format!("nothing is assigned here; the expression is what stands behind `{word}=`")
        })
    }

    /// Words a name followed by parentheses that takes no arguments.
    fn not_callable(&self) -> Said {
        let name = self
            .before()
            .trim_end()
            .rsplit(|c: char| !c.is_ascii_alphanumeric() && c != '_')
            .next()
            .unwrap_or_default();
        let help = vec![format!(
            "multiplication is written {name}*(...); a constant stands alone"
        )];
        (format!("{name} is a number, not a function"), help)
    }

    /// Words a text that ends too early.
    fn unexpected_end(&self, after_operand: bool, inside: Option<(Open, Span)>) -> Said {
        let Some((open, _)) = inside else {
            let what = if self.before().trim().is_empty() {
                "there is no expression"
            } else {
                "the expression ends too early"
            };
            return (what.to_string(), vec![]);
        };
        let (what, help) = match open {
            Open::Group if after_operand => (
                "a parenthesis",
                vec!["a closing parenthesis is missing".to_string()],
            ),
            Open::Group => ("a parenthesis", vec![]),
            Open::If(_) => ("IF", vec!["it is written IF(e1: e2, e3, e4)".to_string()]),
            Open::Call(callee) => (
                callee.name(),
                vec![format!("it is written {}", callee.signature())],
            ),
            Open::Named(entry) => {
                let entry = self.names.entry(entry);
                let form = format!("it is written {}", entry.signature());
                (entry.name.as_str(), vec![form])
            }
        };
        (format!("the text ends inside {what}"), help)
    }

    /// The parenthesis that a text which ends too early leaves open.
    fn unclosed(&self, fault: &Fault) -> Option<Span> {
        let About::Token {
            inside: Some((_, name)),
            ..
        } = fault.about
        else {
            return None;
        };
        let from = self.text.get(name.start..self.span.start)?;
        let open = from
            .find('(')
            .filter(|_| fault.kind == FaultKind::UnexpectedEnd)?;
        Some(Span::new(name.start + open, name.start + open + 1))
    }

    /// Words an argument that is missing between separators.
    fn empty_argument(&self) -> Said {
        let help = if self.before().trim_end().ends_with(',') {
            vec![
                "an argument that is left out in the middle is written 0".to_string(),
                "a comma that begins a continuation line of a dataset does not belong to the expression".to_string(),
            ]
        } else {
            vec!["an argument that is left out in the middle is written 0; trailing ones are omitted".to_string()]
        };
        (
            format!("an argument is missing before `{}`", self.word()),
            help,
        )
    }

    /// Words a function without its parentheses.
    fn missing_arguments(&self, inside: Option<(Open, Span)>) -> Said {
        let word = self.word().to_ascii_uppercase();
        let form = match inside {
            Some((Open::Call(callee), _)) => callee.signature(),
            Some((Open::Named(entry), _)) => self.names.entry(entry).signature(),
            _ => "IF(e1: e2, e3, e4)".to_string(),
        };
        (
            format!("{word} needs its arguments in parentheses"),
            vec![format!("it is written {form}")],
        )
    }

    /// Words a token that cannot stand at its place.
    fn unexpected_token(&self, after_operand: bool, inside: Option<(Open, Span)>) -> Said {
        let word = self.word();
        let starts_operand =
            word.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '(' || c == '.');
        let form = "IF is written IF(e1: e2, e3, e4)".to_string();
        let open = inside.map(|(open, _)| open);
        let advice = match (word, open) {
            (",", Some(Open::If(0))) if after_operand => {
                "IF takes a colon after its first part: IF(e1: e2, e3, e4)".to_string()
            }
            (_, Some(Open::If(_))) if after_operand && !starts_operand => form,
            (":", _) => "a colon stands in IF only, after its first part".to_string(),
            (",", _) if after_operand && is_number(self.before(), self.after()) => {
                "a decimal point is written, not a comma; commas separate arguments".to_string()
            }
            (",", _) if after_operand => "commas separate the arguments of a function".to_string(),
            (")", None) => "no parenthesis is open here".to_string(),
            (")", Some(Open::Group))
                if !after_operand && self.before().trim_end().ends_with('(') =>
            {
                "the parentheses are empty".to_string()
            }
            ("*", _) if !after_operand && self.before().ends_with("**") => {
                "a power has two stars: a**b".to_string()
            }
            ("*", _) if !after_operand && self.before().trim_end().ends_with('*') => {
                "a power is written ** without a blank between the stars".to_string()
            }
            _ if after_operand && self.unit_behind().is_some() => {
                self.unit_behind().unwrap_or_default()
            }
            _ if after_operand && starts_operand => match inside {
                Some((Open::Call(callee), name)) => {
                    self.star_or_comma(callee.arity(), callee.signature(), name)
                }
                Some((Open::Named(entry), name)) => {
                    let entry = self.names.entry(entry);
                    let n = entry.arguments.len();
                    self.star_or_comma((n, n), entry.signature(), name)
                }
                _ => STAR.to_string(),
            },
            _ if !after_operand => "a number, a name or a parenthesis is needed here".to_string(),
            _ => return (format!("`{word}` cannot stand here"), vec![]),
        };
        (format!("`{word}` cannot stand here"), vec![advice])
    }

    /// Advises on a unit behind a number and a blank.
    fn unit_behind(&self) -> Option<String> {
        let before = self.before().trim_end();
        let part = |c: char| c.is_ascii_alphanumeric() || c == '.';
        let start = before.rfind(|c| !part(c)).map_or(0, |at| at + 1);
        let number = before.get(start..)?;
        number.parse::<f64>().ok()?;
        self.unit(number, self.word())
    }

    /// Advises on two operands side by side in a call: the number of arguments tells which sign is
    /// missing.
    fn star_or_comma(
        &self,
        (least, most): (usize, usize),
        signature: String,
        name: Span,
    ) -> String {
        let comma = format!("a comma is missing before `{}`", self.word());
        let Some(written) = self.arguments_written(name) else {
            return STAR.to_string();
        };
        let fits = |count: usize| (least..=most).contains(&count);
        match (fits(written), fits(written + 1)) {
            (true, false) => STAR.to_string(),
            (false, true) => format!("{comma}: it is written {signature}"),
            _ => format!("{comma}, or a star for a multiplication"),
        }
    }

    /// Returns the number of arguments of a call, by its commas.
    fn arguments_written(&self, name: Span) -> Option<usize> {
        let rest = self.text.get(name.end..)?;
        let mut lexer = Lexer::new(rest, self.dialect == Dialect::Function);
        let (mut depth, mut commas) = (0_usize, 0);
        loop {
            match lexer.next().ok()?.kind {
                token::Kind::Open => depth += 1,
                token::Kind::Close if depth <= 1 => return Some(commas + 1),
                token::Kind::Close => depth -= 1,
                token::Kind::Comma if depth == 1 => commas += 1,
                token::Kind::End => return Some(commas + 1),
                _ => {}
            }
        }
    }

    /// Words an argument of the wrong kind or range.
    fn argument(&self, fault: FaultKind, callee: Callee, k: usize) -> Said {
        let parameter = callee.argument_name(k);
        let name = callee.name();
        let word = self.word();
        let help = vec![format!("it is written {}", callee.signature())];
        match (fault, callee.argument(k)) {
            (FaultKind::OutOfRange, Kind::Identifier { zero, .. }) => {
                let first = u32::from(!zero);
                (
                    format!(
                        "{parameter} of {name} is an identifier from {first} to 2147483646, not {word}"
                    ),
                    help,
                )
            }
            (FaultKind::OutOfRange, Kind::Selector(choice)) => (
                format!("{parameter} of {name} is {choice}, not {word}"),
                help,
            ),
            (_, Kind::Identifier { .. }) => (
                format!(
                    "{parameter} of {name} is an identifier: an integer without sign, not an expression"
                ),
                help,
            ),
            _ => (
                format!("{parameter} of {name} is an integer without sign, not an expression"),
                help,
            ),
        }
    }
}

const NO_COMPARISONS: &str =
    "there are no comparisons; IF(a-b: x, y, z) is x where a < b, y where a = b, z where a > b";
const STAR: &str = "multiplication is written with a star, as in 2*TIME";
const NO_VARIABLES: &str = "write the number, or read a VARIABLE of the model by VARVAL(id); programs and the prompt can name variables of their own";

/// Advises on a name that Adams View knows and the solver does not.
fn of_view(name: &str) -> String {
    if name.starts_with('$') {
        return format!("`{name}` is a variable of Adams View: write its value");
    }
    format!(
        "`{name}` is a name of Adams View; functions take the numbers of elements, as DX(12, 21)"
    )
}

/// Advises on a number to another base, as in 0x10.
fn based(upper: &str) -> Option<String> {
    let (base, digits) = [(16, "0X"), (2, "0B"), (8, "0O")]
        .into_iter()
        .find_map(|(base, prefix)| Some((base, upper.strip_prefix(prefix)?)))?;
    let value = u64::from_str_radix(digits, base).ok()?;
    Some(format!("numbers are decimal: write {value}"))
}

/// Returns whether a name means a number.
fn is_constant(meaning: Symbol) -> bool {
    matches!(meaning, Symbol::Constant(_))
}

/// Words a wrong number of arguments.
fn arity(name: &str, (least, most): (usize, usize), signature: String, count: usize) -> Said {
    let takes = match (least, most) {
        (1, 1) => "one argument".to_string(),
        (a, b) if a == b => counted(a, "argument"),
        (a, b) if b > 1000 => format!("{a} or more arguments"),
        (a, b) => format!("{a} to {b} arguments"),
    };
    let got = if count == 0 {
        "none".to_string()
    } else {
        count.to_string()
    };
    (
        format!("{name} takes {takes}, not {got}"),
        vec![format!("it is written {signature}")],
    )
}

/// Words a limit that is exceeded.
fn beyond(fault: FaultKind, limit: usize) -> Said {
    let message = match fault {
        FaultKind::Nesting => {
            format!("more than {limit} functions and parentheses inside one another")
        }
        FaultKind::Symbols => {
            format!("more than {limit} operators, brackets, functions and numbers")
        }
        FaultKind::Elements => format!("more than {limit} different elements of one kind"),
        FaultKind::Lines => format!("more than {limit} lines"),
        _ => format!("more than {limit} characters"),
    };
    (
        message,
        vec![
            "a long expression can be divided among several VARIABLEs, read by VARVAL(id)"
                .to_string(),
        ],
    )
}

/// Returns whether a comma between these stands for a decimal point.
fn is_number(before: &str, after: &str) -> bool {
    before.ends_with(|c: char| c.is_ascii_digit())
        && after.starts_with(|c: char| c.is_ascii_digit())
}

/// Returns a visible form of a character.
fn shown(c: &str) -> String {
    match c.chars().next() {
        Some(x) if x.is_control() || x.is_whitespace() => x.escape_unicode().to_string(),
        _ => c.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Profile, parse};
    use super::*;

    fn said(text: &str, dialect: Dialect) -> Diagnostic {
        parse(text, dialect, Profile::Adams).expect_err(text)
    }

    #[test]
    fn what_people_type_is_answered_with_what_to_write() {
        for (text, words) in [
            ("2^3", "**"),
            ("TIME>2", "IF(a-b: x, y, z)"),
            ("IF(TIME.GT.2: 1, 2, 3)", "IF(a-b: x, y, z)"),
            ("TIME==2", "no comparisons"),
            ("1 && 0", "logical"),
            ("7%2", "MOD(a, b)"),
            ("2x", "2*x"),
            ("2(TIME)", "2*TIME"),
            ("2 TIME", "2*TIME"),
            ("(1)(2)", "star"),
            ("1D3", "1E3"),
            ("1.5E", "digits"),
            ("1.2.3", "one decimal point"),
            ("LN(2)", "LOG(x) is the natural"),
            ("2*t", "TIME"),
            ("IF(TIME,1,2,3)", "colon after its first part"),
            ("IF(TIME:1,2)", "IF(e1: e2, e3, e4)"),
            ("STEP(TIME,0,0,1)", "STEP(x, x0, h0, x1, h1)"),
            ("SINE(1)", "SIN"),
            ("DX(1,,3)", "written 0"),
            ("JOINT(1,2,2,0)", "JOINT(id, jflag, comp, rm)"),
            ("3,5*TIME", "decimal point"),
            ("2***3", "two stars"),
            ("2* *3", "without a blank"),
            ("TIME(2+1)", "TIME*(...)"),
            ("SIN 3", "SIN(x)"),
            ("1 − 2", "minus sign"),
            ("30°", "30D"),
            ("TIME\\", "dataset"),
        ] {
            let said = said(text, Dialect::Function);
            let help = said.help.join("\n");
            assert!(help.contains(words), "{text}: {said}");
        }
        for (text, words) in [
            ("sin(TIME)", "t here"),
            ("2*pi", "radians(180)"),
            ("sin(30D)", "degrees already"),
        ] {
            let said = said(text, Dialect::Expression);
            assert!(said.help.join("\n").contains(words), "{text}: {said}");
        }
    }

    #[test]
    fn messages_name_what_is_wrong() {
        for (text, message) in [
            ("JOINT(1,2,2,0)", "jflag of JOINT is 0 to 1, not 2"),
            (
                "DX(0,2)",
                "i of DX is an identifier from 1 to 2147483646, not 0",
            ),
            (
                "DX(1,TIME)",
                "j of DX is an identifier: an integer without sign, not an expression",
            ),
            ("SIN(1,2)", "SIN takes one argument, not 2"),
            ("AX()", "AX takes 1 to 2 arguments, not none"),
            ("3+MAX(1,2", "the text ends inside MAX"),
            ("", "there is no expression"),
            ("INTERP(TIME,2,1)", "method of INTERP is 0, 1 or 3, not 2"),
        ] {
            assert_eq!(said(text, Dialect::Function).message, message, "{text}");
        }
    }

    #[test]
    fn advice_on_names_is_for_names_that_are_unknown() {
        for (dialect, table) in [
            (Dialect::Function, NAMES),
            (Dialect::Expression, EXPRESSION_NAMES),
        ] {
            for (name, _) in table {
                assert_eq!(
                    symbols::symbol(name, dialect, Profile::Adams),
                    None,
                    "{name}"
                );
            }
        }
    }
}
