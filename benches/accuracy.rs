//! Bars of error against reference solutions: how many errors lie within their bar, how much wider bars are, and what
//! they cost.
//!
//! ```text
//! cargo bench --bench accuracy [-- METHOD …]
//! ```
//!
//! Every problem of `tests/data/references` is run at requests 1e-3 … 1e-10 by every method, with `accuracy`. For each
//! method and request it prints, over all samples of all problems, the share of errors within their bars (goal 0.99),
//! the median of bar over error (goal: at most 30), the factor that would have sufficed for 99 %, and the time of the
//! further run over that of the run. The factors of [`cognate::numeric::METHODS`] come from the last line of a method.

use cognate::analysis::session::script::obey;
use cognate::analysis::session::{Options, Session};
use cognate::analysis::watch::Unwatched;
use cognate::dataset::command::Script;
use cognate::model::Model;
use cognate::numeric::METHODS;
use cognate::results::{Run, Status, csv};
use requests::expressions;
use std::path::{Path, PathBuf};

#[path = "../tests/common/requests.rs"]
mod requests;

/// Steps after which a method is the wrong one for a problem.
const MAX_STEPS: usize = 100_000;

/// Samples of one method: error over bar, and error with its bar.
#[derive(Default)]
struct Samples {
    ratios: Vec<f64>,
    widths: Vec<f64>,
    seconds: [f64; 2],
}

impl Samples {
    fn add(&mut self, other: &Samples) {
        self.ratios.extend(&other.ratios);
        self.widths.extend(&other.widths);
        self.seconds[0] += other.seconds[0];
        self.seconds[1] += other.seconds[1];
    }

    /// Prints coverage, width, the least sufficient part of the factor, and cost.
    fn tell(&mut self, what: &str, problem: &str) {
        if self.ratios.is_empty() {
            return;
        }
        self.ratios.sort_by(f64::total_cmp);
        self.widths.sort_by(f64::total_cmp);
        let n = self.ratios.len();
        let held = self.ratios.partition_point(|r| *r <= 1.0) as f64 / n as f64;
        println!(
            "{what:8} {problem:18} {n:7} samples   held {held:.4}   bar/error {:8.1}   99 % need {:6.2} of the factor   cost {:.2}",
            self.widths[n / 2],
            self.ratios[(0.99 * n as f64) as usize],
            self.seconds[1] / self.seconds[0],
        );
    }
}

/// Runs a problem with bars; `None` where the method does not come to its end.
fn run(folder: &Path, problem: &str, method: &str, error: f64) -> Option<(Run, Vec<String>)> {
    let script = Script::read(folder.join(format!("{problem}.acf"))).ok()?;
    let model = Model::read(script.model_file()?).ok()?;
    let columns = expressions(&model);
    let options = Options {
        error: Some(error),
        columns: columns.clone(),
        method: Some(method.into()),
        max_steps: Some(MAX_STEPS),
        accuracy: true,
        ..Options::default()
    };
    let mut session = Session::new(model, problem, options);
    let status = obey(&mut session, &script.steps, |_, _| (), &mut Unwatched);
    (status == Ok(Status::Completed)).then_some((session.run, columns))
}

/// Returns the time of the run itself, in s: what the further run does again.
fn set_up_and_solve(run: &Run) -> f64 {
    let s = &run.record.seconds;
    s.compile + s.assemble + s.record + s.translate + s.solve + s.evaluate
}

/// Compares a run with its reference.
fn compare(run: &Run, columns: &[String], reference: &Run) -> Samples {
    let mut samples = Samples {
        seconds: [set_up_and_solve(run), run.record.seconds.accuracy],
        ..Samples::default()
    };
    for column in columns {
        let found = [column.clone(), format!("{column}±")].map(|c| run.column(&c));
        let ([Some(values), Some(bars)], Some(exact)) = (found, reference.column(column)) else {
            continue;
        };
        let all = values.iter().zip(exact).zip(bars);
        for ((value, exact), bar) in all {
            let error = (value - exact).abs();
            samples.ratios.push(error / bar);
            // an error below rounding says nothing of the width
            samples
                .widths
                .push(bar / error.max(f64::EPSILON * exact.abs()).max(1e-300));
        }
    }
    samples
}

fn problems(folder: &Path) -> Vec<String> {
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let names = files
        .map(|f| f.path())
        .filter(|p| p.extension().is_some_and(|e| e == "acf"));
    let mut names: Vec<String> = names
        .filter_map(|p: PathBuf| Some(p.file_stem()?.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    names
}

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/references");
    let wanted: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with('-'))
        .collect();
    let methods = METHODS.iter().map(|m| m.name).chain(["AUTO"]);
    for method in methods.filter(|m| wanted.is_empty() || wanted.iter().any(|w| w == m)) {
        let mut whole = Samples::default();
        let mut given_up = std::collections::BTreeSet::new();
        for k in 3..=10 {
            let mut at_request = Samples::default();
            for problem in problems(&folder) {
                if given_up.contains(&problem) {
                    continue;
                }
                let file = folder.join(format!("{problem}.csv"));
                let reference = std::fs::read(file)
                    .ok()
                    .and_then(|bytes| csv::read(&bytes).ok());
                let Some(reference) = reference else {
                    continue;
                };
                let Some((run, columns)) = run(&folder, &problem, method, 10_f64.powi(-k)) else {
                    given_up.insert(problem);
                    continue;
                };
                let mut samples = compare(&run, &columns, &reference);
                at_request.add(&samples);
                samples.tell(method, &format!("{problem} 1e-{k}"));
            }
            at_request.tell(method, &format!("all at 1e-{k}"));
            whole.add(&at_request);
        }
        whole.tell(method, "all");
    }
}
