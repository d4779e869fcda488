//! Command files of Adams View (`.cmd`): what a model is made by, and what View saves → Model.
//!
//! ```text
//! text → commands → objects with their arguments → records of the table of statements → Model
//!        syntax     interpret, database             make/
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `syntax.rs` | words, arguments, values and their places |
//! | `commands.rs` | the commands and arguments, and their abbreviations |
//! | `term.rs`, `evaluate.rs`, `functions.rs`, `units.rs` | expressions and their values |
//! | `interpret.rs`, `making.rs` | commands obeyed: loops, branches, defaults; objects made |
//! | `database.rs`, `attributes.rs` | objects by name |
//! | `frames.rs` | where they stand |
//! | `mass.rs` | masses of shapes |
//! | `make/` | records |
//! | `script.rs` | simulations as commands of the solver |
//!
//! The facts come from saved files beside the datasets that Adams View wrote of the same models.

mod attributes;
mod commands;
mod database;
mod evaluate;
mod frames;
mod functions;
mod interpret;
mod make;
mod making;
mod mass;
mod script;
mod syntax;
mod term;
mod units;

use super::syntax::Source;
use super::{Dataset, Reading};
use crate::arrange::Arrange;
use crate::diagnostic::{Cause, Diagnostic, Span};
use crate::model::Model;
use database::Database;
use interpret::Interpreter;
use std::collections::BTreeMap;

/// Kind of parts.
const PART: &str = "part rigid_body";
/// Kind of point masses.
const POINT_MASS: &str = "part point_mass";
/// Kind of design variables.
const VARIABLE: &str = "variable";

/// Returns whether a file is a command file of Adams View, by its name.
pub(super) fn is_view(file: Option<&str>) -> bool {
    file.is_some_and(|file| file.to_ascii_lowercase().ends_with(".cmd"))
}

/// Reads a command file of Adams View; `changed`: values that design variables have instead of
/// those of the file.
pub(super) fn read(source: Source, changed: &BTreeMap<String, f64>) -> Reading {
    let mut reading = Reading::default();
    let out = &mut reading.diagnostics;
    let commands = syntax::commands(&source, out);
    let mut db = Database::default();
    let lower = changed
        .iter()
        .map(|(name, x)| (name.to_ascii_lowercase(), *x));
    db.changed = lower.collect();
    let mut interpreter = Interpreter::new(&source, &commands, db);
    interpreter.run();
    let Interpreter {
        db, simulations, ..
    } = interpreter;
    let Some(name) = db.model.clone() else {
        // what is wrong in dialogs and macros is nothing that a model needs
        out.clear();
        let d = Diagnostic::error("view_no_model", "there is no model in this file");
        let d = d.help("a model begins with `model create`; files of dialogs and macros make none by themselves");
        out.push(source.locate(d, Span::default()));
        reading.dataset.source = source;
        return reading;
    };
    tell_of_changed(&db, out);
    let mut maker = make::Maker::new(&source, db);
    maker.make();
    let make::Maker { db, records, .. } = maker;
    reading.variables = db.design_variables();
    let (steps, about) = script::commands(&source, &db, &simulations);
    let mut said = db.said.into_inner();
    said.extend(about);
    for d in said {
        out.push(match (d.line, d.span) {
            (0, Some(span)) => source.locate(d, span),
            _ => d,
        });
    }
    let title = name.trim_start_matches('.');
    reading.model.title = format!("Adams View model name: {title}");
    reading.commands = steps;
    for record in &records {
        super::enter(&source, &mut reading.model, record, false, out);
    }
    for joint in reading.model.joints.values_mut() {
        joint.has_named_ic = true;
    }
    reading.dataset = Dataset {
        source,
        syntax: super::syntax::Syntax::default(),
        places: super::Places::default(),
        records: records.into_iter().map(Some).collect(),
    };
    find_contradictions(&mut reading);
    reading
}

/// Says of values of variables that there are none.
fn tell_of_changed(db: &Database, out: &mut Vec<Diagnostic>) {
    for name in db.changed.keys() {
        let known = db.find(name).filter(|k| db.objects[*k].kind == VARIABLE);
        if known.is_none() {
            let what = format!("there is no design variable `{name}`");
            let d = Diagnostic::error("unknown_element", what);
            let all = db.of_kind(VARIABLE).map(|k| db.objects[k].name.as_str());
            let near = crate::diagnostic::near_names(name, all);
            out.push(match near.is_empty() {
                true => d,
                false => d.help(format!("did you mean {}?", near.join(" or "))),
            });
        }
    }
}

/// Adds what does not fit together in the model, at the commands that made its elements.
fn find_contradictions(reading: &mut Reading) {
    let Reading {
        dataset,
        model,
        diagnostics: out,
        ..
    } = reading;
    let mut records = dataset.records.iter().flatten();
    let mistaken = records.by_ref().filter(|r| r.mistaken).map(|r| r.element());
    let mistaken = model.with_readers_of_data(mistaken.collect());
    let unsolved = out.iter().any(|d| d.is(Cause::ViewUnsolved));
    for d in Model::contradictions(model) {
        let excused = d.element.as_ref().is_some_and(|e| mistaken.contains(e));
        // what is not read may hold what is missing
        if excused && (!d.is(Cause::UnknownElement) || unsolved) {
            continue;
        }
        let source = &dataset.source;
        let element = d.element.as_ref();
        let record = element.and_then(|e| dataset.places.statement(&dataset.records, e));
        if let Some(given) = record.and_then(|record| super::argument_of(record, &d)) {
            out.push(source.locate(d, given));
            continue;
        }
        let d = match d.line {
            0 => d,
            line => Diagnostic {
                file: source.file.clone(),
                span: source.word_at(line, d.column.max(1)),
                ..d
            },
        };
        out.push(match d.column {
            0 => dataset.locate(Diagnostic { file: None, ..d }),
            _ => d,
        });
    }
    super::name_elements(&dataset.records, out);
    out.arrange_by_key(|d| (d.line == 0, d.line, d.column));
}
