//! The message for a mistake in an expression: one sentence that names it, and advice for common
//! habits.
//!
//! The tables list characters and names that users of other languages bring along. Advice is given
//! only where it fits; a mistake that is plain gets none.

use super::ast::{Callee, Dialect};
use super::signature::Kind;
use super::symbols;
use super::token::{About, Fault, Open};
use crate::diagnostic::{Diagnostic, Span, near_names};

/// Returns the diagnostic for the first mistake of a text.
pub(crate) fn explain(text: &str, dialect: Dialect, fault: &Fault) -> Diagnostic {
    let place = Place {
        text,
        dialect,
        span: fault.span,
    };
    let (message, help) = match (fault.code, fault.about) {
        ("bad_char", _) => place.bad_character(),
        ("bad_number", _) => place.bad_number(),
        ("unknown_name", _) => place.unknown_name(),
        ("not_callable", _) => place.not_callable(),
        (
            "unexpected_end",
            About::Token {
                after_operand,
                inside,
            },
        ) => place.unexpected_end(after_operand, inside),
        ("empty_argument", _) => place.empty_argument(),
        ("missing_arguments", About::Token { inside, .. }) => place.missing_arguments(inside),
        (
            _,
            About::Token {
                after_operand,
                inside,
            },
        ) => place.unexpected_token(after_operand, inside),
        ("arity", About::Count(callee, count)) => arity(callee, count),
        (code, About::Argument(callee, k)) => place.argument(code, callee, k),
        (code, About::Limit(limit)) => beyond(code, limit),
        (code, _) => (code.replace('_', " "), vec![]),
    };
    let mut said = at(text, fault.code, message, fault.span);
    said.help = help;
    said
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

/// Characters of other languages, with their replacement here.
const CHARACTERS: &[(&str, &str)] = &[
    ("^", "the power operator is **, as in 2**3"),
    (
        "<>=",
        "there are no comparisons; IF(a-b: x, y, z) is x where a < b, y where a = b, z where a > b",
    ),
    (
        "&",
        "an ampersand continues a line when it is its last character; there are no logical operators",
    ),
    (
        "|",
        "there are no logical operators; products of IF(...) with values 0 and 1 serve",
    ),
    ("%", "the remainder of a division is MOD(a, b)"),
    (
        "[]{}",
        "parentheses are round; vectors are not part of this language",
    ),
    (";", "arguments are separated by commas"),
    (
        "\"'`“”‘’",
        "there are no strings; elements of the model are named by their numbers",
    ),
    ("?", "a choice is written IF(e1: e2, e3, e4)"),
    (
        "\\",
        "a backslash ends a function in a dataset and does not belong to the expression",
    ),
    ("_$@#~", "a name begins with a letter"),
    ("−–—", "this is a dash; the minus sign is -"),
    ("×·∙⋅", "multiplication is written *"),
    ("÷", "division is written /"),
    ("²", "a square is written **2"),
    ("³", "a cube is written **3"),
    ("√", "a square root is written SQRT(x)"),
    ("π", "the number is called PI"),
    ("°", "degrees are written with the suffix D, as in 30D"),
    ("，", "this is a wide comma; write an ordinary one"),
    ("（）", "these are wide parentheses; write ordinary ones"),
    (
        "\u{a0}\u{2009}\u{202f}\u{3000}\u{feff}",
        "this is a special blank; write an ordinary one",
    ),
];

/// Names of other languages, with their replacement in direct-entry functions.
const NAMES: &[(&str, &str)] = &[
    (
        "LN",
        "LOG(x) is the natural logarithm, LOG10(x) the decimal one",
    ),
    ("INT", "AINT(x) cuts off, NINT(x) rounds"),
    ("FIX", "AINT(x) cuts off, NINT(x) rounds"),
    ("TRUNC", "AINT(x) cuts off, NINT(x) rounds"),
    (
        "FLOOR",
        "AINT(x) cuts off toward zero, which is the floor where x is not negative",
    ),
    ("CEIL", "AINT(x) cuts off toward zero; AINT(x)+1 is above"),
    ("ROUND", "NINT(x) rounds to the nearest whole number"),
    ("T", "time is TIME here; t belongs to expression functions"),
    ("POW", "powers are written a**b"),
    ("POWER", "powers are written a**b"),
    ("SQR", "a square is written x**2, a square root SQRT(x)"),
    ("CBRT", "a cube root is written x**(1/3) for positive x"),
    (
        "ARCSIN",
        "the inverse functions are ASIN, ACOS, ATAN and ATAN2",
    ),
    (
        "ARCCOS",
        "the inverse functions are ASIN, ACOS, ATAN and ATAN2",
    ),
    (
        "ARCTAN",
        "the inverse functions are ASIN, ACOS, ATAN and ATAN2",
    ),
    (
        "SIND",
        "angles are radians; write SIN(30D) for a literal, SIN(x*DTOR) for a value",
    ),
    (
        "COSD",
        "angles are radians; write COS(30D) for a literal, COS(x*DTOR) for a value",
    ),
    (
        "TAND",
        "angles are radians; write TAN(30D) for a literal, TAN(x*DTOR) for a value",
    ),
    ("DEGREES", "x*RTOD turns radians into degrees"),
    ("RADIANS", "x*DTOR turns degrees into radians"),
    (
        "DEG",
        "x*RTOD turns radians into degrees; a literal takes the suffix D, as in 30D",
    ),
    ("RAD", "x*DTOR turns degrees into radians"),
    ("E", "the base of natural logarithms is EXP(1)"),
    ("FRAC", "the fraction is x-AINT(x)"),
    (
        "ENT",
        "ENT belongs to expression functions; AINT(x) cuts off toward zero",
    ),
    ("ALOG", "LOG(x) is the natural logarithm"),
    ("SGN", "the sign of x is SIGN(1, x)"),
    (
        "HEAVISIDE",
        "STEP(x, x0, h0, x1, h1) rises smoothly; IF(x: 0, 0, 1) jumps",
    ),
    ("STEP3", "the cubic step is STEP, the quintic one STEP5"),
    (
        "AND",
        "there are no logical operators; decide by IF(e1: e2, e3, e4)",
    ),
    (
        "OR",
        "there are no logical operators; decide by IF(e1: e2, e3, e4)",
    ),
    (
        "NOT",
        "there are no logical operators; decide by IF(e1: e2, e3, e4)",
    ),
    (
        "AKIMA",
        "the Akima spline is AKISPL(x, z, id); AKIMA is its name in the I-DEAS profile",
    ),
    (
        "USER",
        "USER(...) calls a compiled subroutine and replaces a whole expression; it cannot be part of one",
    ),
    ("AXU", "AX counts turns by itself"),
    ("AYU", "AY counts turns by itself"),
    ("AZU", "AZ counts turns by itself"),
];

/// Names of other languages, with their replacement in expression functions.
const EXPRESSION_NAMES: &[(&str, &str)] = &[
    ("TIME", "time is t here"),
    ("PI", "the number is radians(180)"),
    (
        "LOG10",
        "log(x) is the decimal logarithm, ln(x) the natural one",
    ),
    ("FLOOR", "ent(x) rounds down"),
    ("AINT", "int(x) cuts off, ent(x) rounds down"),
    (
        "IF",
        "expression functions have no IF; direct-entry functions have",
    ),
    (
        "DTOR",
        "radians(x) turns degrees into radians; sin, cos and tan take degrees",
    ),
    (
        "RTOD",
        "degrees(x) turns radians into degrees; asin, acos and atan give degrees",
    ),
];

/// The place of a mistake: the text, its language, and the bytes.
struct Place<'a> {
    text: &'a str,
    dialect: Dialect,
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
        if c == "." {
            // TIME.GT.2
            let relation: String = self
                .after()
                .chars()
                .take_while(char::is_ascii_alphabetic)
                .collect();
            help.push(match relation.to_ascii_uppercase().as_str() {
                "GT" | "GE" | "LT" | "LE" | "EQ" | "NE" | "AND" | "OR" | "NOT" => {
                    "there are no comparisons; \
                     IF(a-b: x, y, z) is x where a < b, y where a = b, z where a > b"
                        .to_string()
                }
                _ => "a point belongs to a number: 0.5, .5 or 5.".to_string(),
            });
        } else if let Some((_, advice)) = CHARACTERS.iter().find(|(list, _)| list.contains(c)) {
            help.push((*advice).to_string());
        }
        (format!("`{}` is no part of the language", shown(c)), help)
    }

    /// Words a literal that is not a number.
    fn bad_number(&self) -> Said {
        let word = self.word();
        let upper = word.to_ascii_uppercase();
        let digits = upper.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
        let mantissa = &word[..word.len() - digits.len()];
        let advice = match digits.split_at_checked(1) {
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

    /// Words a name that has no meaning, with near names.
    fn unknown_name(&self) -> Said {
        let word = self.word();
        let table = match self.dialect {
            Dialect::Function => NAMES,
            Dialect::Expression => EXPRESSION_NAMES,
        };
        let mut help = Vec::new();
        if let Some((_, advice)) = table
            .iter()
            .find(|(name, _)| name.eq_ignore_ascii_case(word))
        {
            help.push((*advice).to_string());
        } else {
            let near = near_names(
                word,
                symbols::names(self.dialect).iter().map(|entry| entry.0),
            );
            if !near.is_empty() {
                help.push(format!("did you mean {}?", near.join(" or ")));
            }
        }
        let what = if self.after().trim_start().starts_with('(') {
            "function"
        } else {
            "constant or function"
        };
        (format!("there is no {what} `{word}`"), help)
    }

    /// Words a name followed by parentheses that takes no arguments.
    fn not_callable(&self) -> Said {
        let name = self
            .before()
            .trim_end()
            .rsplit(|c: char| !c.is_ascii_alphanumeric())
            .next()
            .unwrap_or_default();
        let help = vec![format!(
            "multiplication is written {name}*(...); a constant stands alone"
        )];
        (format!("{name} is a number, not a function"), help)
    }

    /// Words a text that ends too early.
    fn unexpected_end(&self, after_operand: bool, inside: Option<(Open, Span)>) -> Said {
        let Some((open, name)) = inside else {
            let what = if self.before().trim().is_empty() {
                "there is no expression"
            } else {
                "the expression ends too early"
            };
            return (what.to_string(), vec![]);
        };
        let column = self
            .text
            .get(..name.start)
            .unwrap_or_default()
            .chars()
            .count()
            + 1;
        let (what, mut help) = match open {
            Open::Group => ("the parenthesis".to_string(), vec![]),
            Open::If(_) => (
                "IF".to_string(),
                vec!["it is written IF(e1: e2, e3, e4)".to_string()],
            ),
            Open::Call(callee) => (
                callee.name().to_string(),
                vec![format!("it is written {}", callee.signature())],
            ),
        };
        if after_operand && open == Open::Group {
            help.push("a closing parenthesis is missing".to_string());
        }
        (
            format!("the text ends inside {what} of column {column}"),
            help,
        )
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
            _ if after_operand && starts_operand => {
                "multiplication is written with a star, as in 2*TIME".to_string()
            }
            _ if !after_operand => "a number, a name or a parenthesis is needed here".to_string(),
            _ => return (format!("`{word}` cannot stand here"), vec![]),
        };
        (format!("`{word}` cannot stand here"), vec![advice])
    }

    /// Words an argument of the wrong kind or range.
    fn argument(&self, code: &str, callee: Callee, k: usize) -> Said {
        let parameter = callee.argument_name(k);
        let name = callee.name();
        let word = self.word();
        let help = vec![format!("it is written {}", callee.signature())];
        match (code, callee.argument(k)) {
            ("out_of_range", Kind::Identifier { zero, .. }) => {
                let first = u32::from(!zero);
                (
                    format!(
                        "{parameter} of {name} is an identifier from {first} to 2147483646, not {word}"
                    ),
                    help,
                )
            }
            ("out_of_range", Kind::Selector(choice)) => (
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

/// Words a wrong number of arguments.
fn arity(callee: Callee, count: usize) -> Said {
    let (least, most) = callee.arity();
    let takes = match (least, most) {
        (1, 1) => "one argument".to_string(),
        (a, b) if a == b => format!("{a} arguments"),
        (a, b) if b > 1000 => format!("{a} or more arguments"),
        (a, b) => format!("{a} to {b} arguments"),
    };
    let got = if count == 0 {
        "none".to_string()
    } else {
        count.to_string()
    };
    (
        format!("{} takes {takes}, not {got}", callee.name()),
        vec![format!("it is written {}", callee.signature())],
    )
}

/// Words a limit that is exceeded.
fn beyond(code: &str, limit: usize) -> Said {
    let message = match code {
        "limit_nesting" => {
            format!("more than {limit} functions and parentheses inside one another")
        }
        "limit_symbols" => format!("more than {limit} operators, brackets, functions and numbers"),
        "limit_elements" => format!("more than {limit} different elements of one kind"),
        "limit_lines" => format!("more than {limit} lines"),
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
            ("3+MAX(1,2", "the text ends inside MAX of column 3"),
            ("", "there is no expression"),
            ("INTERP(TIME,2,1)", "method of INTERP is 1 or 3, not 2"),
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
