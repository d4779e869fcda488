//! `docs/capabilities.md`: every row of the founding document with its command and its tests. The page is made from
//! `tests/data/capabilities.tsv`, whose tests must exist here and whose commands the program must have.

use super::command::cognate;
use crate::repository::root;
use std::collections::{BTreeMap, BTreeSet};

/// Rows of the founding document.
const ROWS: usize = 141;

struct Row {
    number: String,
    capability: String,
    state: String,
    command: String,
    tests: Vec<String>,
    note: String,
}

fn rows() -> Vec<Row> {
    let text = std::fs::read_to_string(root("tests/data/capabilities.tsv")).unwrap();
    let row = |line: &str| {
        let cells: Vec<&str> = line.split('\t').collect();
        assert_eq!(cells.len(), 6, "{line}");
        let cell = |k: usize| cells[k].to_owned();
        Row {
            number: cell(0),
            capability: cell(1),
            state: cell(2),
            command: cell(3),
            tests: cells[4].split_whitespace().map(str::to_owned).collect(),
            note: cell(5),
        }
    };
    text.lines().skip(1).map(row).collect()
}

/// Whether a file of tests has a test of this name.
fn is_test(test: &str, sources: &mut BTreeMap<String, String>) -> bool {
    let (file, name) = test.split_once("::").unwrap_or((test, ""));
    let source = sources.entry(file.to_owned()).or_insert_with(|| {
        let file = root("tests").join(file);
        std::fs::read_to_string(file).unwrap_or_default()
    });
    let head = format!("fn {name}(");
    source
        .match_indices(&head)
        .any(|(at, _)| source[..at].trim_end().ends_with(']'))
}

#[test]
fn every_row_has_its_command_and_its_tests_or_says_what_is_missing() {
    let (rows, mut sources) = (rows(), BTreeMap::new());
    let numbers: Vec<String> = (1..=ROWS).map(|k| format!("S{k:02}")).collect();
    assert_eq!(
        rows.iter().map(|r| r.number.clone()).collect::<Vec<_>>(),
        numbers
    );
    let mut wrong = Vec::new();
    for row in &rows {
        let n = &row.number;
        let missing = row.tests.iter().filter(|t| !is_test(t, &mut sources));
        wrong.extend(missing.map(|t| format!("{n}: there is no test {t}")));
        let fits = match row.state.as_str() {
            "done" => !row.tests.is_empty() && !row.command.is_empty(),
            "partly" => !row.tests.is_empty() && !row.note.is_empty() && !row.command.is_empty(),
            "not yet" => row.tests.is_empty() && !row.note.is_empty() && row.command.is_empty(),
            _ => false,
        };
        if !fits {
            wrong.push(format!(
                "{n}: `{}` does not fit its tests, command and note",
                row.state
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let verbs = rows
        .iter()
        .filter_map(|row| row.command.strip_prefix("cognate "));
    let verbs: BTreeSet<&str> = verbs.filter_map(|c| c.split([' ', ',']).next()).collect();
    assert!(verbs.len() > 10, "{verbs:?}");
    for verb in verbs {
        assert_eq!(
            cognate(&[verb, "--help"]).code,
            0,
            "there is no `cognate {verb}`"
        );
    }
}

#[test]
fn the_page_of_capabilities_is_made_from_their_tests() {
    let rows = rows();
    let count = |state: &str| rows.iter().filter(|r| r.state == state).count();
    let mut page = format!(
        "# What the founding document asks for, row by row\n\n\
         The help text of a mechanism module with ADAMS asks for {ROWS} things. Of these {} are done, {} partly, {} not yet. Each row has\n\
         the command to try it with (`MODEL` is a dataset or command file, `RUN` a file of results) and the tests that hold it.\n\
         This page is made from `tests/data/capabilities.tsv` by `BLESS=1 cargo test --test program capabilities::`; a test fails\n\
         when a test that is named here is not there.\n\n\
         | row | capability | state | command | tests |\n|---|---|---|---|---|\n",
        count("done"),
        count("partly"),
        count("not yet"),
    );
    for row in &rows {
        let link = |test: &String| {
            let (file, name) = test.split_once("::").unwrap_or((test, ""));
            format!("[{}](../tests/{file})", name.replace('_', " "))
        };
        let tests: Vec<String> = row.tests.iter().map(link).collect();
        let state = match row.note.as_str() {
            "" => row.state.clone(),
            note => format!("{}: {note}", row.state),
        };
        let command = match row.command.as_str() {
            "" => String::new(),
            command => format!("`{command}`"),
        };
        page += &format!(
            "| {} | {} | {state} | {command} | {} |\n",
            row.number,
            row.capability,
            tests.join("; ")
        );
    }
    let file = root("docs/capabilities.md");
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&file, &page).unwrap();
    }
    let written = std::fs::read_to_string(&file).unwrap_or_default();
    assert!(
        written == page,
        "docs/capabilities.md is not what its rows make: BLESS=1 cargo test --test program capabilities:: writes it"
    );
}
