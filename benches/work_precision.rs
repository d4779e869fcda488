//! Error against time for all problems with trusted solutions, by every method: the page `docs/work_precision.md` with its picture of curves, and
//! one with all runs in the folder of targets.
//!
//! `cargo bench --bench work_precision`, or `cargo bench --bench work_precision -- andrews bounce`: only problems whose names contain a word,
//! which writes no page. BUDGET=seconds of processor time for each problem (5).

use cognate::analysis::session::Options;
use cognate::analysis::watch::Unwatched;
use cognate::dataset::command::Script;
use cognate::internals::work_precision::{Question, Reference, Study, page, sheet, survey};
use cognate::model::Model;
use cognate::numeric::METHODS;
use cognate::results::csv;
use requests::{expressions, problems};
use std::fmt::Write as _;
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
        requests: requests_made().collect(),
        methods: Vec::new(),
        wanted: WANTED.to_vec(),
        budget,
        trusted: Some(trusted),
    };
    survey(&question, &mut Unwatched).expect("a study")
}

/// The cheapest run of a study for an error: its time, what it asks for, and the error that it has.
fn cheapest(study: &Study, wanted: f64) -> String {
    study.recommended(wanted).map_or_else(String::new, |row| {
        let error = row.error().map_or(0.0, |e| e.largest);
        let ms = 1e3 * row.cost.solve;
        let digits = if ms < 10.0 { 2 } else { 0 };
        format!(
            "{ms:.digits$} ms, {} {:.0e}: {error:.0e}",
            row.method, row.request
        )
    })
}

/// The table of the cheapest runs, a line a problem.
fn cheapest_runs(studies: &[Study]) -> String {
    let mut text = "| problem |".to_string();
    for wanted in WANTED {
        let _ = write!(text, " {wanted:.0e} |");
    }
    text += "\n|---|";
    text += &"---|".repeat(WANTED.len());
    for study in studies {
        let runs = WANTED.map(|wanted| cheapest(study, wanted));
        let _ = write!(text, "\n| {} | {} |", study.name, runs.join(" | "));
    }
    text
}

/// The error of the trusted table of a study, over the swing.
fn trust(study: &Study) -> f64 {
    study.reference.as_ref().map_or(0.0, Reference::trust)
}

/// The table of errors over requests: their geometric mean over all problems, and the largest.
fn errors_over_requests(studies: &[Study]) -> String {
    let methods: Vec<&str> = METHODS.iter().map(|m| m.name).collect();
    let mut text = format!("| request | {} |\n|---|", methods.join(" | "));
    text += &"---|".repeat(methods.len());
    for request in requests_made() {
        let _ = write!(text, "\n| {request:.0e} |");
        for method in &methods {
            let rows = studies.iter().flat_map(|study| {
                let own = study.rows.iter();
                own.filter(|row| row.method == *method && row.request == request)
                    .filter_map(|row| Some(row.error()?.largest))
                    .filter(|error| *error > 2.0 * trust(study))
            });
            let ratios: Vec<f64> = rows.map(|error| error / request).collect();
            let logs: f64 = ratios.iter().map(|r| r.ln()).sum();
            let most = ratios.iter().fold(0.0_f64, |m, r| m.max(*r));
            text += &match ratios.len() {
                0 => " |".to_string(),
                n => format!(" {:.1e}, {most:.0e} ({n}) |", (logs / n as f64).exp()),
            };
        }
    }
    text
}

/// Writes the page of tables.
fn tables(studies: &[Study]) -> String {
    format!(
        "# Error against time\n\n\
         Written by `cargo bench --bench work_precision`. Mechanisms with trusted solutions (`tests/data/references`) are run by every method at requests\n\
         from 1e-2 to 1e-12. The error is the largest difference from the trusted table over all channels and outputs, each channel over its swing;\n\
         times are processor times of solving on one core. `cognate report MODEL` makes such a study, with curves, of a model of yours.\n\n\
         ![Processor time of solving over the error, for each problem and method](work_precision.svg)\n\n\
         ## The cheapest run for an error\n\n\
         Time, method and request, and the error that the run has. Empty: no run is known to be that good, as the trusted table has no more digits,\n\
         or none was made in time.\n\n{}\n\n\
         ## Error over request\n\n\
         The geometric mean over all problems, the largest, and the number of problems; of those whose trusted table has the digits.\n\n{}\n",
        cheapest_runs(studies),
        errors_over_requests(studies)
    )
}

fn requests_made() -> impl Iterator<Item = f64> {
    (2..=12).map(|k| 10f64.powi(-k))
}

fn main() {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with('-'))
        .collect();
    let budget = std::env::var("BUDGET").ok().and_then(|b| b.parse().ok());
    let mut studies = Vec::new();
    for problem in problems(&root().join("tests/data/references")) {
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
        let curves = Path::new(env!("CARGO_TARGET_TMPDIR")).join("work_precision.html");
        std::fs::write(&curves, html).expect("the curves are written");
        std::fs::write(root().join("docs/work_precision.svg"), sheet(&studies))
            .expect("the picture is written");
        let file = root().join("docs/work_precision.md");
        std::fs::write(file, tables(&studies)).expect("the page is written");
        println!(
            "docs/work_precision.md, docs/work_precision.svg, {}",
            curves.display()
        );
    }
}
