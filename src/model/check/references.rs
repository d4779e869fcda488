//! Rules of references: elements that are named exist, and functions can be read.

use super::{Out, about, advise, at_argument, error, near};
use crate::diagnostic::{Cause, Diagnostic, Span};
use crate::expr::Expr;
use crate::expr::ast::{Ast, Node};
use crate::expr::lint::lint;
use crate::expr::signature;
use crate::model::{ElementId, ElementKind, Formula, Model};
use std::collections::BTreeMap;

/// Numbers that do not exist for which near ones are sought, at most: each is compared with all
/// that do.
const MOST_ADVISED: usize = 100;

/// Advice on elements that do not exist.
#[derive(Default)]
struct Advice(BTreeMap<ElementId, Option<String>>);

impl Advice {
    /// Returns which numbers near that of an element exist; nothing once that has been asked of
    /// more elements than anybody reads of.
    fn on(&mut self, model: &Model, target: ElementId) -> Option<String> {
        if self.0.len() >= MOST_ADVISED && !self.0.contains_key(&target) {
            return None;
        }
        let near = || near(target.number, &model.numbers(target.kind));
        self.0.entry(target).or_insert_with(near).clone()
    }
}

pub(super) fn references_exist(model: &Model, out: &mut Out) {
    let mut advice = Advice::default();
    for r in model.each_reference() {
        if model.has(r.target) {
            continue;
        }
        let number = r.target.number;
        let message = format!("{} = {number}: {} does not exist", r.argument, r.target);
        error(
            out,
            Cause::UnknownElement.code(),
            (r.element, r.place),
            message,
        );
        at_argument(out, r.argument);
        if let Some(near) = advice.on(model, r.target) {
            advise(out, near);
        }
    }
}

pub(super) fn functions_can_be_read(model: &Model, out: &mut Out) {
    let (mut known, mut advice) = (Known::default(), Advice::default());
    for owned in model.formulas() {
        let Formula::Expression { text, .. } = owned.formula else {
            continue;
        };
        let who = |d: Diagnostic| {
            let d = about(d, (owned.element, owned.place));
            Diagnostic {
                message: format!("{}: {}", owned.argument, d.message),
                ..d
            }
        };
        if text.is_empty() && owned.place.line > 0 {
            continue; // the reader has said so already
        }
        if text.is_empty() {
            out.push(who(Diagnostic::error(
                "missing_argument",
                "an expression is needed",
            )));
            continue;
        }
        match text.sound_ast() {
            Err(mut d) => {
                let at = d.span.map_or(0, |s| s.start);
                if let Some(advice) = numbers_for(model, text) {
                    d.help = vec![advice];
                }
                out.push(placed(
                    who(strip(marks_told(d, owned.formula))),
                    owned.formula,
                    at,
                ));
                continued_by_comma(owned.formula, at, out);
            }
            Ok(ast) => {
                for d in lint(ast, text) {
                    let at = d.span.map_or(0, |s| s.start);
                    out.push(placed(who(strip(d)), owned.formula, at));
                }
                for (at, target) in named(ast) {
                    if known.has(model, target) {
                        continue;
                    }
                    let message = format!("{target} does not exist");
                    let mut d = who(Diagnostic::error(Cause::UnknownElement, message));
                    d.help.extend(advice.on(model, target));
                    out.push(placed(d, owned.formula, at));
                }
            }
        }
    }
}

impl Model {
    /// Returns the mistakes in an expression that is not part of the model but reads it, as a
    /// column of results does: what cannot be read, elements that do not exist. It may call
    /// elements by their names, see [`Model::numbered`]. Places count in its text.
    pub fn check_expression(&self, text: &str) -> Vec<Diagnostic> {
        let numbered = match self.numbered(text) {
            Ok(numbered) => numbered,
            Err(wrong) => return wrong,
        };
        let found = self.check_numbered(&numbered.text);
        let as_typed = found.into_iter().map(|d| numbered.as_typed(d));
        as_typed.collect()
    }

    fn check_numbered(&self, text: &str) -> Vec<Diagnostic> {
        let expr = match Expr::parse(text) {
            Ok(expr) => expr,
            Err(error) => return error.into(),
        };
        let mut known = Known::default();
        let mut out = Vec::new();
        for (at, target) in named(expr.ast()) {
            if known.has(self, target) {
                continue;
            }
            let message = format!("{target} does not exist");
            let mut d = Diagnostic::error(Cause::UnknownElement, message);
            d.help
                .extend(near(target.number, &self.numbers(target.kind)));
            out.push(d.at(text, Span::new(at, at + 1)));
        }
        out
    }
}

/// Returns advice on a function that calls elements by their names, which datasets do not.
fn numbers_for(model: &Model, text: &str) -> Option<String> {
    let numbered = model.numbered(text).ok().filter(|n| n.text != text)?;
    let is_sound = Expr::parse(&numbered.text).is_ok();
    is_sound.then(|| {
        let numbers = &numbered.text;
        format!("datasets call elements by their numbers: {numbers}")
    })
}

/// Further places of the expression as sentences, with their lines and columns in the file.
fn marks_told(mut d: Diagnostic, formula: &Formula) -> Diagnostic {
    for (span, what) in std::mem::take(&mut d.marks) {
        if let Some((line, column)) = formula.file_place(span.start) {
            d.help.push(format!("{what}: line {line}, column {column}"));
        }
    }
    d
}

/// A place in an expression is not yet one in a file.
fn strip(d: Diagnostic) -> Diagnostic {
    Diagnostic {
        span: None,
        line: 0,
        column: 0,
        ..d
    }
}

/// The place in the file of a byte of the expression; the place of the statement stays where there
/// is none.
fn placed(mut d: Diagnostic, formula: &Formula, offset: usize) -> Diagnostic {
    if let Some((line, column)) = formula.file_place(offset) {
        (d.line, d.column) = (line, column);
    }
    d
}

/// A comma at the beginning of a line does not separate arguments: say so where that may be the
/// mistake.
fn continued_by_comma(formula: &Formula, offset: usize, out: &mut Out) {
    let Formula::Expression { text, breaks, .. } = formula else {
        return;
    };
    let at_break = breaks.iter().any(|b| b.offset == offset);
    let open = text
        .get(..offset)
        .is_some_and(|t| !t.trim_end().ends_with([',', '+', '-', '*', '/', '(']));
    if at_break && open {
        advise(
            out,
            "a comma that begins a line only continues the statement; one that separates arguments ends the line above",
        );
    }
}

/// Numbers in use, looked up once per kind.
#[derive(Default)]
struct Known(BTreeMap<ElementKind, Vec<u32>>);

impl Known {
    fn has(&mut self, model: &Model, id: ElementId) -> bool {
        let numbers = self.0.entry(id.kind);
        let numbers = numbers.or_insert_with(|| model.numbers(id.kind));
        numbers.binary_search(&id.number).is_ok()
    }
}

/// The elements an expression names: byte and element. Zeros that stand for ground are left out.
pub(crate) fn named(ast: &Ast) -> Vec<(usize, ElementId)> {
    let mut all = Vec::new();
    for node in &ast.nodes {
        let Node::Call { callee, args } = node else {
            continue;
        };
        for (k, &arg) in args.iter().enumerate() {
            let signature::Kind::Identifier { element, .. } = callee.argument(k) else {
                continue;
            };
            if let Node::Number { literal, .. } = ast.node(arg)
                && *literal >= 1.0
                && *literal <= f64::from(u32::MAX)
            {
                let at = ast.spans.get(arg as usize).map_or(0, |s| s.start);
                all.push((at, ElementKind::from(element).id(*literal as u32)));
            }
        }
    }
    all
}
