//! Error against time for all problems with trusted solutions, by every method: the page `docs/work_precision.html`.
//!
//! `cargo bench --bench work_precision`, or `cargo bench --bench work_precision -- andrews bounce`: only problems whose names contain a word,
//! which writes no page. BUDGET=seconds of processor time for each problem (5).

use cognate::analysis::session::Options;
use cognate::analysis::watch::Unwatched;
use cognate::analysis::work_precision::{Question, Study, page, survey};
use cognate::dataset::command::Script;
use cognate::model::Model;
use cognate::results::csv;
use requests::expressions;
use std::path::{Path, PathBuf};

#[path = "../tests/common/requests.rs"]
mod requests;

/// Errors for which a run is recommended.
const WANTED: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-11];
/// Processor time for each problem, in s, when BUDGET does not say.
const BUDGET: f64 = 5.0;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_path_buf()
}

/// The problems: command files that have a trusted table beside them.
fn problems() -> Vec<String> {
    let folder = root().join("tests/data/references");
    let files = std::fs::read_dir(folder).expect("references");
    let names = files.filter_map(|file| {
        let path = file.ok()?.path();
        let is_commands = path.extension()? == "acf" && path.with_extension("csv").exists();
        is_commands.then(|| path.file_stem().map(|s| s.to_string_lossy().into_owned()))?
    });
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

fn study(problem: &str, budget: f64) -> Study {
    let folder = root().join("tests/data/references");
    let script = Script::read(folder.join(format!("{problem}.acf"))).expect("commands");
    let model = Model::read(script.model_file().expect("a dataset")).expect("a model");
    let table = std::fs::read(folder.join(format!("{problem}.csv"))).expect("a solution");
    let mut trusted = csv::read(&table).expect("a table");
    // the solution has more columns than are asked for
    let asked = expressions(&model);
    trusted.table = (0..trusted.columns.len())
        .filter(|&k| k == 0 || asked.contains(&trusted.columns[k].name))
        .collect();
    let question = Question {
        name: problem.to_string(),
        model: &model,
        steps: &script.steps,
        options: Options {
            columns: asked,
            ..Options::default()
        },
        folders: Vec::new(),
        requests: (2..=12).map(|k| 10f64.powi(-k)).collect(),
        methods: Vec::new(),
        budget,
        trusted: Some(trusted),
    };
    survey(&question, &mut Unwatched).expect("a study")
}

fn main() {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with('-'))
        .collect();
    let budget = std::env::var("BUDGET").ok().and_then(|b| b.parse().ok());
    let mut studies = Vec::new();
    for problem in problems() {
        if !words.is_empty() && !words.iter().any(|w| problem.contains(w.as_str())) {
            continue;
        }
        let study = study(&problem, budget.unwrap_or(BUDGET));
        println!("{problem}\n{}", study.text(&WANTED));
        studies.push(study);
    }
    if words.is_empty() {
        let about = "<p>Mechanisms with trusted solutions (<code>tests/data/references</code>), each run by every method at requests from 1e-2 to 1e-12. \
            The error is the largest difference from the trusted table over all channels and outputs, each channel over its swing; \
            times are processor times on one core. Written by <code>cargo bench --bench work_precision</code>; \
            <code>cognate report MODEL</code> makes the same page for a model of yours.</p>";
        let html = page("Error against time", about, &studies, &WANTED);
        let file = root().join("docs/work_precision.html");
        std::fs::write(&file, html).expect("the page is written");
        println!("docs/work_precision.html");
    }
}
