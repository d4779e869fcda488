//! Real files, read where they lie: the folder named by COGNATE_CORPUS. Without it the tests are left out.
#![cfg(feature = "solver")]

#[path = "corpus/chrono.rs"]
mod chrono;
#[path = "common/meaning.rs"]
mod meaning;
#[path = "common/needs.rs"]
mod needs;
#[path = "common/running.rs"]
mod running;
#[path = "corpus/runs.rs"]
mod runs;
#[path = "corpus/skipped.rs"]
mod skipped;
#[path = "corpus/view.rs"]
mod view;

use cognate::dataset;
use cognate::dataset::command::{Command, Script, Step};
use cognate::diagnostic::{Diagnostic, Severity};
use cognate::internals::dataset::syntax::{Item, TokenKind};
use cognate::model::Model;
use meaning::{difference, meaning};
use std::path::{Path, PathBuf};

/// All files of the corpus with this ending, in order of their names; `None` without a corpus.
#[track_caller]
fn corpus(ending: &str) -> Option<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut folders = vec![needs::corpus()?];
    while let Some(folder) = folders.pop() {
        let entries =
            std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
        for entry in entries {
            let path = entry.expect("a readable entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path
                .extension()
                .is_some_and(|e| e.eq_ignore_ascii_case(ending))
            {
                found.push(path);
            }
        }
    }
    found.sort();
    assert!(!found.is_empty(), "the corpus holds .{ending} files");
    Some(found)
}

/// Inputs made by hand for another program's parser, partly illegal on purpose.
fn made_by_hand(path: &Path) -> bool {
    path.display().to_string().contains("a2m/samples")
}

fn errors(of: &[Diagnostic]) -> Vec<&Diagnostic> {
    of.iter()
        .filter(|d| d.severity == Severity::Error)
        .collect()
}

#[test]
fn every_real_dataset_reads_without_an_error() {
    let Some(files) = corpus("adm") else { return };
    let mut read = 0;
    for path in files.iter().filter(|p| !made_by_hand(p)) {
        let reading = dataset::read(path).expect("a readable file");
        let wrong = errors(&reading.diagnostics);
        assert!(wrong.is_empty(), "{}: {}", path.display(), wrong[0]);
        assert!(
            !reading.model.parts.is_empty(),
            "{} has parts",
            path.display()
        );
        read += 1;
    }
    println!("{read} datasets");
}

/// (file, line, code) of mistakes in the hand-made samples: what must be reported, and where.
const MISTAKES: &[(&str, usize, &str)] = &[
    ("prova.adm", 3, "unknown_argument"),
    ("prova.adm", 8, "unknown_argument"),
    ("prova.adm", 34, "defined_twice"),
    ("prova.adm", 56, "blank_before_suffix"),
    ("prova.adm", 79, "unknown_statement"),
    ("prova.adm", 80, "missing_argument"),
    ("prova.adm", 90, "missing_argument"),
    ("prova.adm", 93, "unknown_statement"),
    ("prova.adm", 100, "missing_end"),
    ("prova_beam00.adm", 3, "missing_argument"),
    ("mark.adm", 1, "statement_as_title"),
    ("monster.adm", 9, "defined_twice"),
    ("monster.adm", 14, "unknown_statement"),
    ("monster.adm", 354, "defined_twice"),
    ("pm02.adm", 26, "unknown_statement"),
];

#[test]
fn mistakes_in_files_made_by_hand_are_found_in_their_lines() {
    let Some(files) = corpus("adm") else { return };
    for path in files.iter().filter(|p| made_by_hand(p)) {
        let name = path.file_name().expect("a name").to_string_lossy();
        let found = dataset::read(path).expect("a readable file").diagnostics;
        for (file, line, code) in MISTAKES.iter().filter(|m| m.0 == name) {
            let hit = found.iter().any(|d| d.line == *line && d.code == *code);
            assert!(hit, "{file}:{line}: {code} is not among {found:#?}");
        }
    }
}

#[test]
fn every_command_file_reads() {
    let Some(files) = corpus("acf") else { return };
    for path in &files {
        let script = Script::read(path).unwrap_or_else(|e| panic!("{e}"));
        let model = script.model_file().expect("a model is named");
        assert!(
            model.exists(),
            "{} names {}",
            path.display(),
            model.display()
        );
        let mut model = Model::read(model).unwrap_or_else(|e| panic!("{e}"));
        for step in &script.steps {
            model
                .apply(&step.command)
                .unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        }
        let stops = script
            .steps
            .iter()
            .filter(|s| matches!(s.command, Command::Stop))
            .count();
        let runs = script
            .steps
            .iter()
            .filter(|s| matches!(s.command, Command::Simulate(_)))
            .count();
        assert!(stops == 1 && runs > 0, "{}", path.display());
    }
}

/// (log, changes of elements, simulations, end of the last): runs that another program drove, echoed by the solver.
const REPLAYS: &[(&str, usize, usize, f64)] = &[
    ("ControlSimulink/Controls_Plant_5.msg", 0, 1680, 8.395),
    ("matlab & adams/Controls_Plant_10.msg", 58, 29, 0.14),
    ("pd-control/Controls_Plant_1.msg", 31438, 826, 4.125),
    ("fitestv1/Fkinev1.msg", 1001, 1001, 5.0),
    ("T_MSC_ADAMS/RD3.msg", 1809, 201, 1.0),
    ("validation/Matlab.msg", 2001, 2001, 10.0),
    (
        "adams_simulink_robotarm/Controls_Plant_1.msg",
        7007,
        1001,
        5.0,
    ),
];

#[test]
fn message_logs_replay_as_commands() {
    let Some(files) = corpus("msg") else { return };
    for (log, changes, simulations, end) in REPLAYS {
        let mut here = files
            .iter()
            .filter(|p| p.display().to_string().ends_with(log));
        let path = here.next().expect("a log of the corpus");
        let script = Script::from_message_log(path).unwrap_or_else(|e| panic!("{e}"));
        let is_change = |s: &&Step| matches!(s.command, Command::Change(_));
        assert_eq!(
            script.steps.iter().filter(is_change).count(),
            *changes,
            "changes in {log}"
        );
        let runs = script.steps.iter().filter_map(|s| match &s.command {
            Command::Simulate(s) => Some(s),
            _ => None,
        });
        let runs: Vec<_> = runs.collect();
        assert_eq!(runs.len(), *simulations, "simulations in {log}");
        assert_eq!(runs.last().and_then(|s| s.end), Some(*end), "end of {log}");
        let model = path.with_extension("adm");
        let mut model = Model::read(model).unwrap_or_else(|e| panic!("{e}"));
        for step in &script.steps {
            model
                .apply(&step.command)
                .unwrap_or_else(|e| panic!("{log}:{}: {e}", step.line));
        }
    }
}

fn same(a: &str, b: &str, what: &str, path: &Path) {
    assert!(a == b, "{}: {what}: {}", path.display(), difference(a, b));
}

#[test]
fn every_real_dataset_is_written_as_it_was_read() {
    let Some(files) = corpus("adm") else { return };
    for path in &files {
        let dataset = dataset::read(path).expect("a readable file").dataset;
        let bytes = std::fs::read(path).expect("a readable file");
        assert!(
            dataset.source.encode(dataset.to_text()) == bytes,
            "{}",
            path.display()
        );
    }
}

#[test]
fn formatting_keeps_what_every_real_dataset_means() {
    let Some(files) = corpus("adm") else { return };
    for path in files.iter().filter(|p| !made_by_hand(p)) {
        let first = dataset::read(path).expect("a readable file");
        let text = first.dataset.formatted();
        let second = dataset::read_text(&text);
        same(
            &meaning(&first.model),
            &meaning(&second.model),
            "meaning",
            path,
        );
        same(&text, &second.dataset.formatted(), "formatting again", path);
        let comments = |r: &dataset::Reading| -> Vec<String> {
            let source = &r.dataset.source;
            let all = r.dataset.syntax.items.iter().flat_map(|item| match item {
                Item::Comment(span) => vec![*span],
                Item::Statement(tokens) => {
                    let inside = tokens
                        .tokens
                        .iter()
                        .filter(|t| t.kind == TokenKind::Comment);
                    inside.map(|t| t.span).collect()
                }
            });
            all.map(|span| source.slice(span).trim_end().to_owned())
                .collect()
        };
        assert_eq!(
            comments(&first),
            comments(&second),
            "comments of {}",
            path.display()
        );
        let heads = |r: &dataset::Reading| -> Vec<String> {
            r.dataset
                .records
                .iter()
                .flatten()
                .map(|r| r.element())
                .collect()
        };
        assert_eq!(heads(&first), heads(&second), "order of {}", path.display());
        let broad = text.lines().skip(1).find(|l| {
            l.chars().count() > 80 && !l.contains('!') && !l.contains('"') && l.contains(' ')
        });
        let texts = ["COMMENT", "STRING", "FILE", "ROUTINE"];
        let excused = broad.is_none_or(|l| texts.iter().any(|t| l.contains(t)));
        assert!(excused, "{}: {broad:?}", path.display());
    }
}

#[test]
fn a_model_written_by_itself_says_the_same() {
    let Some(files) = corpus("adm") else { return };
    for path in files.iter().filter(|p| !made_by_hand(p)) {
        let first = dataset::read(path).expect("a readable file").model;
        let text = first.to_text();
        let second = dataset::read_text(&text);
        let wrong = errors(&second.diagnostics);
        assert!(wrong.is_empty(), "{}: {}", path.display(), wrong[0]);
        same(&meaning(&first), &meaning(&second.model), "meaning", path);
    }
}

#[test]
fn hand_made_files_are_formatted_without_harm() {
    let Some(files) = corpus("adm") else { return };
    for path in files.iter().filter(|p| made_by_hand(p)) {
        let first = dataset::read(path).expect("a readable file");
        let text = first.dataset.formatted();
        let again = dataset::read_text(&text);
        same(&text, &again.dataset.formatted(), "formatting again", path);
    }
}

/// (dataset, Gruebler count, freedom, why): what `verify` finds in real models.
const FREEDOMS: &[(&str, i64, usize, &str)] = &[
    (
        "analysis_with_spikes/test_analysis_with_spikes.adm",
        -1,
        0,
        "one redundant row, as the log of Adams says",
    ),
    (
        "real_analysis_with_spikes/FRS5_doe_8_LAUL_analysis.adm",
        538,
        538,
        "a gear selector: 11 INPLANE, 18 points on curves and 4 couplers hold 140 parts that contacts and bushings keep in place; none is redundant",
    ),
    (
        "T_MSC_ADAMS/RD3.adm",
        3,
        9,
        "three pairs of planar joints on one plane: six redundant rows, as the log of Adams says",
    ),
    (
        "ControlSimulink/Controls_Plant_5.adm",
        -21,
        1,
        "a planar linkage of hinges: 22 redundant rows, as the log of Adams says",
    ),
    (
        "fitestv1/Fkinev1.adm",
        -27,
        1,
        "3-RPR between planes, two drives: 28 redundant rows, as the log of Adams says",
    ),
    (
        "bachelor-diploma/Only_AGV.adm",
        8,
        10,
        "two loops of hinges with parallel axes fix a translation twice",
    ),
    ("bachelor-diploma/Only_AGV_3.adm", 8, 10, "as Only_AGV"),
    (
        "models/rescale_analysis.adm",
        1,
        1,
        "a pendulum of two welded parts",
    ),
    (
        "matlab & adams/Controls_Plant_10.adm",
        8,
        8,
        "an open chain on a free body",
    ),
    (
        "pd-control/Controls_Plant_1.adm",
        2,
        2,
        "two legs of hinges",
    ),
    (
        "adams_simulink_robotarm/Controls_Plant_1.adm",
        7,
        7,
        "an arm of seven hinges",
    ),
    ("validation/Matlab.adm", 2, 2, "cart and pendulum"),
    (
        "Simulink and adams/Controls_Plant_1.adm",
        2,
        2,
        "cart and pendulum",
    ),
    ("Continuous_Action_Space/pendulum.adm", 1, 1, "a pendulum"),
    (
        "adams_models/test_Cylindrical_Case01.adm",
        2,
        2,
        "one cylindrical joint",
    ),
    (
        "adams_models/test_Distance_Case01.adm",
        5,
        5,
        "one distance by GCON",
    ),
    ("adams_models/test_Prismatic_Case01.adm", 1, 1, "one slide"),
    (
        "adams_models/test_RackPinion_Case01.adm",
        1,
        1,
        "hinge, slide and rack",
    ),
    ("adams_models/test_Revolute_Case01.adm", 1, 1, "one hinge"),
    ("adams_models/test_Spherical_Case01.adm", 3, 3, "one ball"),
    (
        "adams_models/test_TransSpring_Case01.adm",
        6,
        6,
        "a free body on a spring",
    ),
    (
        "adams_models/test_Universal_Case01.adm",
        2,
        2,
        "one Hooke joint",
    ),
];

#[test]
fn real_models_assemble_and_count_their_freedoms() {
    let Some(files) = corpus("adm") else { return };
    let mut checked = 0;
    for path in &files {
        let name = path.display().to_string();
        let Some((_, gruebler, freedom, why)) = FREEDOMS.iter().find(|f| name.ends_with(f.0))
        else {
            continue;
        };
        let model = Model::read(path).unwrap_or_else(|e| panic!("{e}"));
        let found =
            cognate::analysis::verify::verify(&model).unwrap_or_else(|e| panic!("{name}: {e:?}"));
        assert!(
            found.inconsistent.is_empty(),
            "{name}: {:?}",
            found.inconsistent
        );
        assert_eq!(
            (found.gruebler, found.freedom),
            (*gruebler, Some(*freedom)),
            "{name}: {why}"
        );
        let redundant = found.dependent.len() as i64;
        assert_eq!(
            *freedom as i64 - redundant,
            *gruebler,
            "{name}: {:?}",
            found.redundant()
        );
        checked += 1;
    }
    println!("{checked} models counted");
    assert!(checked >= 20, "{checked}");
}

/// Rows that Adams leaves out of a model, by its log: as many as are found here.
#[test]
fn as_many_rows_are_redundant_as_the_logs_of_adams_say() {
    let Some(files) = corpus("msg") else { return };
    let mut checked = 0;
    for path in &files {
        let text =
            String::from_utf8_lossy(&std::fs::read(path).expect("a readable log")).into_owned();
        let Some(told) = text
            .split("analysis identified redundant constraints")
            .nth(1)
        else {
            continue;
        };
        let n = told.matches("deactivating constraint equation").count();
        let adm = path.with_extension("adm");
        if !adm.exists() {
            continue;
        }
        let model = Model::read(&adm).unwrap_or_else(|e| panic!("{e}"));
        let found = cognate::analysis::verify::verify(&model)
            .unwrap_or_else(|e| panic!("{}: {e:?}", adm.display()));
        assert_eq!(found.dependent.len(), n, "{}", adm.display());
        checked += 1;
    }
    assert!(checked >= 3, "{checked}");
}
