//! Changes of `MODEL.toml`: what a command is asked to change is changed, all else stays as it is
//! written.

use super::{LAST_USED, Setup};
use cognate::diagnostic::{Cause, Diagnostic};
use cognate::disk;
use cognate::results;
use toml_edit::{Array, DocumentMut, Item, Table, Value};

/// Lines that a new file begins with.
const HEAD: &str = "\
# Load cases, functions, groups and set-up of the model beside this file; `cognate loads` and
# `cognate group` change it, and so may you.

";

/// Changes the file of a set-up.
///
/// # Errors
/// When the outcome would have mistakes, or cannot be written; the file is then as it was.
pub fn change(setup: &Setup, edit: impl FnOnce(&mut DocumentMut)) -> Result<Setup, Diagnostic> {
    let mut document: DocumentMut = setup.text.parse().map_err(|e: toml_edit::TomlError| {
        Diagnostic::error("bad_setup", e.message().trim().to_owned())
    })?;
    edit(&mut document);
    let head = if setup.exists() { "" } else { HEAD };
    let text = head.to_owned() + &document.to_string();
    let new = Setup::read(setup.file.clone(), text);
    let new = new.map_err(|found| {
        let mut d = found.into_first();
        // the place is in a text that was not written
        (d.file, d.line, d.column, d.span) = (None, 0, 0, None);
        d
    })?;
    if new.text != setup.text {
        results::write_text(&new.file, &new.text)?;
    }
    Ok(new)
}

/// Returns a table of the document, which is made where it is not there.
pub fn table<'d>(document: &'d mut DocumentMut, name: &str) -> &'d mut Item {
    document.entry(name).or_insert(Item::Table(Table::new()))
}

/// Returns a list of texts.
pub fn list(names: &[String]) -> Value {
    Value::Array(names.iter().map(String::as_str).collect::<Array>())
}

/// Sets an entry of a table, whose comment beside it stays.
pub fn set(table: &mut Item, key: &str, value: Value) {
    let Some(table) = table.as_table_like_mut() else {
        return;
    };
    match table.get_mut(key).and_then(Item::as_value_mut) {
        Some(old) => {
            let decor = old.decor().clone();
            *old = value;
            *old.decor_mut() = decor;
        }
        None => {
            table.insert(key, Item::Value(value));
        }
    }
}

/// Keeps names of loads and load cases as the choice of the next runs; none: all loads.
///
/// # Errors
/// When the file cannot be written.
pub fn choose(setup: &Setup, names: &[String]) -> Result<Setup, Diagnostic> {
    if names.is_empty() && setup.solve.loads.is_none() {
        return Ok(setup.clone());
    }
    change(setup, |document| {
        let solve = table(document, "solve");
        match names.is_empty() {
            false => set(solve, "loads", list(names)),
            true => {
                if let Some(solve) = solve.as_table_like_mut() {
                    solve.remove("loads");
                }
            }
        }
    })
}

/// Keeps loads that were chosen one by one as a load case.
///
/// # Errors
/// When the file cannot be written.
pub fn keep_last_used(setup: &Setup, loads: &[String]) -> Result<Setup, Diagnostic> {
    set_case(setup, LAST_USED, loads)
}

/// Makes or changes a load case.
///
/// # Errors
/// When the file cannot be written.
pub fn set_case(setup: &Setup, name: &str, loads: &[String]) -> Result<Setup, Diagnostic> {
    change(setup, |document| {
        set(table(document, "cases"), name, list(loads));
    })
}

/// Removes an entry of a table.
///
/// # Errors
/// When the file cannot be written, or would have mistakes without the entry.
pub fn remove(setup: &Setup, table: &str, name: &str) -> Result<Setup, Diagnostic> {
    change(setup, |document| {
        let found = document.get_mut(table).and_then(Item::as_table_like_mut);
        found.and_then(|t| t.remove(name));
    })
}

/// Puts the text back that a set-up was read from; removes the file where there was none.
///
/// # Errors
/// When the file cannot be written or removed.
pub fn restore(before: &Setup) -> Result<(), Diagnostic> {
    if before.exists() {
        return results::write_text(&before.file, &before.text);
    }
    std::fs::remove_file(&before.file).map_err(|e| {
        let what = format!("{} cannot be removed: {e}", disk::text(&before.file));
        Diagnostic::error(Cause::FileUnwritable, what)
    })
}
