//! What is said to what people type: the whole message with the caret below its place, and a neighbour of which it is not said.
//!
//! The cases stand in `tests/data/advice.txt`, a block each: the text behind `> `, carets below the place (dashes below a further
//! one), the message, its advice; behind `not: ` texts that are right, or wrong in another way.

use cognate::diagnostic::{Diagnostic, Severity, Span};
use cognate::expr::Expr;

/// What is said of a text: its mistake, or its warnings.
fn said(text: &str) -> Vec<Diagnostic> {
    match Expr::parse(text) {
        Err(error) => error.into_diagnostics(),
        Ok(expr) => expr.warnings(),
    }
}

/// Signs below a place.
fn below(text: &str, span: Span, sign: &str) -> (usize, String) {
    let width = |from: usize, to: usize| text[from..to].chars().count();
    let under = sign.repeat(width(span.start, span.end).max(1));
    (width(0, span.start), under)
}

/// A text and what is said of it, as the data file shows it.
fn block(text: &str) -> String {
    let mut out = format!("> {text}\n");
    for d in said(text) {
        let mut marks: Vec<(usize, String)> = (d.marks.iter())
            .map(|(span, _)| below(text, *span, "-"))
            .collect();
        marks.extend(d.span.map(|span| below(text, span, "^")));
        marks.sort();
        let mut line = String::from("  ");
        for (column, signs) in marks {
            line += &" ".repeat((column + 2).saturating_sub(line.chars().count()));
            line += &signs;
        }
        let severity = match d.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        out += &format!("{line}\n{severity}[{}]: {}\n", d.code, d.message);
        out.extend(d.marks.iter().map(|(_, what)| format!("mark: {what}\n")));
        out.extend(d.help.iter().map(|help| format!("help: {help}\n")));
        // the column is that of the caret
        let span = d.span.unwrap_or_default();
        assert_eq!(d.column, text[..span.start].chars().count() + 1, "{text}");
    }
    out
}

#[test]
fn what_people_type_is_answered_and_its_neighbours_are_not() {
    let file = include_str!("../data/advice.txt");
    let (mut wrong, mut actual) = (Vec::new(), String::new());
    let blocks: Vec<&str> = file
        .split("\n\n")
        .filter(|b| !b.trim().is_empty())
        .collect();
    for expected in &blocks {
        let mut lines = expected.trim_start().lines();
        let text = lines.next().and_then(|l| l.strip_prefix("> ")).unwrap();
        let neighbours: Vec<&str> = lines.filter_map(|l| l.strip_prefix("not: ")).collect();
        assert!(!neighbours.is_empty(), "{text}: no neighbour");
        let mut shown = block(text);
        let of_text = said(text);
        for neighbour in neighbours {
            for d in said(neighbour) {
                let same = |o: &Diagnostic| {
                    (o.severity == Severity::Warning || o.help == d.help) && o.code == d.code
                };
                assert!(
                    !of_text.iter().any(same),
                    "{neighbour} is told of {text}: {d}"
                );
            }
            shown += &format!("not: {neighbour}\n");
        }
        if shown.trim() != expected.trim() {
            wrong.push(text);
        }
        actual += &format!("{shown}\n");
    }
    assert!(blocks.len() > 30);
    assert!(wrong.is_empty(), "{wrong:#?}\nit is now\n{actual}");
}
