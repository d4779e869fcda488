//! The manual in the program and its pages: every model of it runs, every page is the program's own.

use super::command::{cognate, path, scratch};
use crate::repository::root;
use cognate::dataset::read_text;
use cognate::internals::dataset::manual::{self, Effect};
use std::path::PathBuf;

fn page(name: &str) -> PathBuf {
    root("docs").join(name)
}

/// Compares a page with its text; with BLESS=1 writes it.
fn is_made_by_the_program(name: &str, text: &str) {
    let file = page(name);
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&file, text).unwrap();
    }
    let written = std::fs::read_to_string(&file).unwrap_or_default();
    assert!(
        written == text,
        "docs/{name} is not what the program prints: BLESS=1 cargo test --test program manual:: writes it"
    );
}

#[test]
fn every_model_of_the_manual_runs_as_it_stands() {
    for model in manual::examples() {
        let folder = format!("manual_{}", model.name);
        scratch(&folder, &format!("{}.adm", model.name), model.dataset);
        let commands = scratch(&folder, &format!("{}.acf", model.name), model.commands);
        let results = commands.with_file_name("results");
        let mut arguments = vec![
            "run",
            path(&commands),
            "--max-steps",
            "20000",
            "--out",
            path(&results),
        ];
        arguments.extend(model.options);
        let done = cognate(&arguments);
        assert_eq!(done.code, 0, "{}: {}", model.name, done.err);
        assert!(
            !done.err.contains("warning") || model.name == "routine",
            "{}: {}",
            model.name,
            done.err
        );
    }
}

#[test]
fn models_of_the_manual_are_written_and_never_over_others() {
    let folder = scratch("manual_written", "anything", "").with_file_name("models");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let write = || cognate(&["statements", "--model", "cam", "--out", path(&folder)]);
    assert_eq!(write().code, 0);
    let text = std::fs::read_to_string(folder.join("cam.adm")).unwrap();
    assert_eq!(text, manual::example("cam").unwrap().dataset);
    std::fs::write(folder.join("cam.adm"), "mine").unwrap();
    let refused = write();
    assert_eq!(refused.code, 2, "{}", refused.err);
    let text = std::fs::read_to_string(folder.join("cam.adm")).unwrap();
    assert_eq!(text, "mine");
}

#[test]
fn the_rack_of_the_manual_moves_with_the_rim_of_its_pinion() {
    let model = manual::example("gears").unwrap();
    scratch("manual_gears", "gears.adm", model.dataset);
    let commands = scratch("manual_gears", "gears.acf", model.commands);
    let results = commands.with_file_name("results");
    // the lowest point of the pinion, 30 below its axis, and the rack there
    let rim = "0.5*PI*60*2";
    let asked = [
        format!("VX(50,11)-{rim}"),
        "DX(50,11)-30*AZ(21,11)".to_owned(),
    ];
    let mut arguments = vec!["run", path(&commands), "--out", path(&results), "--quiet"];
    for column in &asked {
        arguments.extend(["--column", column]);
    }
    let done = cognate(&arguments);
    assert_eq!(done.code, 0, "{}", done.err);
    let table = std::fs::read_to_string(results.join("gears.csv")).unwrap();
    let rows: Vec<Vec<f64>> = (table.lines().skip(2))
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    assert!(rows.len() > 40);
    for row in rows {
        assert!(row[1].abs() < 1e-6 && row[2].abs() < 1e-6, "{row:?}");
    }
}

#[test]
fn every_statement_of_a_model_is_described_as_solved() {
    for model in manual::examples() {
        let reading = read_text(model.dataset);
        // the statements that the manual describes as kept are told so, and nothing else
        let told = &reading.diagnostics;
        let kept = |page: &manual::Page| page.effect == Effect::Kept;
        let mut records = reading.dataset.records.iter().flatten();
        let has_kept = records.any(|r| manual::page(r.row.keyword()).is_some_and(kept));
        let codes: Vec<&str> = told.iter().map(|d| d.code).collect();
        let expected: &[&str] = if has_kept { &["ignored"] } else { &[] };
        assert_eq!(codes, expected, "{}: {told:?}", model.name);
        for record in reading.dataset.records.iter().flatten() {
            let page = manual::page(record.row.keyword()).unwrap();
            assert_ne!(
                page.effect,
                Effect::Refused,
                "{}: {}",
                model.name,
                page.keyword
            );
        }
    }
}

#[test]
fn the_page_of_statements_is_the_programs_own() {
    is_made_by_the_program("statements.md", &cognate(&["statements", "--markdown"]).out);
}

#[test]
fn the_page_of_codes_is_the_programs_own() {
    is_made_by_the_program("codes.md", &cognate(&["explain", "--markdown"]).out);
}

#[test]
fn every_field_of_the_record_is_explained() {
    let model = manual::example("slider_crank").unwrap();
    scratch("manual_record", "slider_crank.adm", model.dataset);
    let commands = scratch("manual_record", "slider_crank.acf", model.commands);
    let results = commands.with_file_name("results");
    let done = cognate(&["run", path(&commands), "--out", path(&results), "--json"]);
    let record: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    let text = std::fs::read_to_string(page("files.md")).unwrap();
    let simulation = record["simulations"][0].as_object().unwrap();
    let fields = record.as_object().unwrap().keys().chain(simulation.keys());
    let missing: Vec<&String> = fields
        .filter(|f| !text.contains(&format!("`{f}`")))
        .collect();
    assert!(
        missing.is_empty(),
        "explain these in docs/files.md: {missing:?}"
    );
}

#[test]
fn statements_are_explained_by_name_and_as_json() {
    let contact = cognate(&["explain", "CONTACT"]).out;
    assert!(
        contact.contains("STIFFNESS=x") && contact.contains("CONTACT(id"),
        "{contact}"
    );
    let part = cognate(&["statements", "part", "--json"]).out;
    let part: serde_json::Value = serde_json::from_str(&part).unwrap();
    let names: Vec<&str> = (part["arguments"].as_array().unwrap().iter())
        .map(|a| a["name"].as_str().unwrap())
        .collect();
    assert_eq!(names[..2], ["GROUND", "QG"]);
    let unknown = cognate(&["statements", "CONTAKT"]);
    assert!(
        unknown.code == 3 && unknown.err.contains("did you mean CONTACT?"),
        "{}",
        unknown.err
    );
}

#[test]
fn a_mistaken_argument_is_answered_with_all_that_there_are() {
    let model = scratch(
        "manual_argument",
        "m.adm",
        "t\nPART/1, GROUND, MASSE=1\nEND\n",
    );
    let said = cognate(&["check", path(&model)]).err;
    let (near, all) = (
        said.find("did you mean MASS?"),
        said.find("PART has GROUND, QG, REULER"),
    );
    assert!(near.is_some() && near < all, "{said}");
}

/// The targets of the links of a page: `[text](target)`.
fn links(text: &str) -> Vec<String> {
    let mut outside = String::new();
    let mut within = false;
    for line in text.lines() {
        let fence = line.trim_start().starts_with("```");
        within ^= fence;
        if !within && !fence {
            outside += line;
            outside.push('\n');
        }
    }
    let starts = outside.match_indices("](");
    starts
        .filter_map(|(at, _)| Some(outside[at + 2..].split_once(')')?.0.to_owned()))
        .collect()
}

/// The anchor of a heading: small letters, blanks as hyphens, nothing else.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().to_lowercase();
    let kept = kept
        .chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.collect::<String>().replace(' ', "-")
}

#[test]
fn links_of_the_pages_lead_somewhere() {
    let root = root("");
    let folder = std::fs::read_dir(root.join("docs")).unwrap().flatten();
    let mut pages: Vec<PathBuf> = folder
        .map(|e| e.path())
        .filter(|p| p.extension().is_some_and(|e| e == "md"))
        .collect();
    pages.extend(["README.md", "ARCHITECTURE.md"].map(|p| root.join(p)));
    let mut dead = Vec::new();
    let mut n_links = 0;
    for page in pages {
        for link in links(&std::fs::read_to_string(&page).unwrap()) {
            if link.contains("://") {
                continue;
            }
            n_links += 1;
            let (file, place) = link.split_once('#').unwrap_or((&link, ""));
            let target = if file.is_empty() {
                page.clone()
            } else {
                page.parent().unwrap().join(file)
            };
            let text = std::fs::read_to_string(&target).unwrap_or_default();
            let headings = text.lines().filter(|l| l.starts_with('#'));
            let mut anchors = headings.map(|l| anchor(l.trim_start_matches('#')));
            if !target.exists() || !place.is_empty() && !anchors.any(|a| a == place) {
                dead.push(format!("{}: {link}", page.display()));
            }
        }
    }
    assert!(dead.is_empty() && n_links > 3, "{dead:#?}");
}
