//! The problems with known solutions, and one run of them with bars.

use crate::requests::expressions;
use crate::samples::Samples;
use cognate::analysis::session::script::obey;
use cognate::analysis::session::{Accuracy, Analysis, Options, Session};
use cognate::analysis::watch::Unwatched;
use cognate::analysis::work_limit::ProcessorClock;
use cognate::dataset::command::{Script, Step};
use cognate::model::Model;
use cognate::results::{Run, Status, csv};
use std::path::{Path, PathBuf};

/// Attempted steps after which a method is the wrong one for a problem.
const MAX_STEPS: usize = 100_000;
/// Rounding of the tables of solutions, relative to the largest value of a column.
const ROUNDING: f64 = 1e-16;
/// Solutions that are known less well: the difference of two of them by other formulations, relative to the largest
/// value of a column.
const TRUST: &[(&str, f64)] = &[
    ("bounce_k1e5", 1e-12),
    ("bounce_k1e6", 1e-11),
    ("bounce_k1e7", 2e-12),
    ("bounce_k1e8", 1e-13),
    ("bistop_slot", 5e-12),
    ("settle_sphere", 4e-14),
    ("a04_bricard", 3e-13),
    ("a03_andrews", 2e-15),
    ("stiff_bushing", 1e-15),
];
/// The problem that motions alone move.
const DRIVEN: &str = "slider_crank_kin";

/// The kinds of analysis, which have bars of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// by a method
    Integrated,
    /// positions that motions prescribe
    Kinematic,
    /// rest; a request is then that of EQUILIBRIUM, its ERROR and its IMBALANCE
    Static,
}

impl Kind {
    pub const ALL: [Kind; 3] = [Kind::Integrated, Kind::Kinematic, Kind::Static];
}

/// A problem and its solution.
pub struct Problem {
    pub name: String,
    pub kind: Kind,
    model: Model,
    /// its commands; none: it comes to rest
    steps: Vec<Step>,
    /// columns, and their exact values in the last rows of a run
    exact: Vec<(String, Vec<f64>)>,
    trust: f64,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/references")
}

fn table(name: &str) -> Run {
    let bytes = std::fs::read(folder().join(format!("{name}.csv"))).expect("a solution");
    csv::read(&bytes).expect("a table")
}

/// All problems, by their names.
pub fn all() -> Vec<Problem> {
    let names = crate::requests::problems(&folder());
    let mut problems: Vec<Problem> = names.iter().map(|name| moving(name)).collect();
    problems.extend(spheres());
    problems.push(chain());
    problems
}

/// A problem with commands.
fn moving(name: &str) -> Problem {
    let script = Script::read(folder().join(format!("{name}.acf"))).expect("commands");
    let model = Model::read(script.model_file().expect("a dataset")).expect("a model");
    let solution = table(name);
    let exact = expressions(&model).into_iter().filter_map(|column| {
        let values = solution.column(&column)?.to_vec();
        Some((column, values))
    });
    let trust = TRUST.iter().find(|t| t.0 == name);
    Problem {
        name: name.to_string(),
        kind: match name == DRIVEN {
            true => Kind::Kinematic,
            false => Kind::Integrated,
        },
        exact: exact.collect(),
        model,
        steps: script.steps,
        trust: trust.map_or(ROUNDING, |t| t.1),
    }
}

fn resting(name: String, text: &str, exact: Vec<(String, Vec<f64>)>) -> Problem {
    Problem {
        name,
        kind: Kind::Static,
        model: Model::from_text(text).expect("a model"),
        steps: Vec::new(),
        exact,
        trust: ROUNDING,
    }
}

/// A sphere on planes of other stiffness.
fn spheres() -> Vec<Problem> {
    let file = folder().join("static_sphere.adm");
    let text = std::fs::read_to_string(file).expect("a dataset");
    let solution = table("static_sphere");
    let [stiffness, heights] = ["k", "z"].map(|c| solution.column(c).expect("a column"));
    let all = stiffness.iter().zip(heights).map(|(k, z)| {
        let text = text.replace("1.0E8,", &format!("{k:E},"));
        let exact = vec![("DZ(2,1)".to_string(), vec![*z])];
        resting(format!("static_sphere {k:e}"), &text, exact)
    });
    all.collect()
}

/// A chain of twenty rods: the places of its joints.
fn chain() -> Problem {
    let name = "static_hanging_chain";
    let text = std::fs::read_to_string(folder().join(format!("{name}.adm"))).expect("a dataset");
    let solution = table(name);
    let exact = (1..20).flat_map(|joint| {
        let marker = 22 + 2 * joint;
        [("DX", "x"), ("DY", "y")].map(|(measure, column)| {
            let values = solution.column(column).expect("a column");
            (format!("{measure}({marker},1)"), vec![values[joint]])
        })
    });
    resting(name.to_string(), &text, exact.collect())
}

impl Problem {
    /// Runs the problem with bars, and compares; `None` where it does not come to its end.
    pub fn samples(&self, method: &str, request: f64, limit: f64) -> Option<Samples> {
        let run = self.run((method, request, limit), Accuracy::Bars)?;
        Some(self.compared(&run))
    }

    /// Runs the problem and lets it say how far off it is, and compares what it says of each column
    /// with the error that 19 of 20 of its numbers have; `None` as before.
    pub fn sentences(&self, method: &str, request: f64, limit: f64) -> Option<Samples> {
        let run = self.run((method, request, limit), Accuracy::Digits)?;
        let seconds = &run.record.seconds;
        let accuracy = run.record.accuracy.as_ref()?;
        let mut samples = Samples::of_run(seconds.accuracy / seconds.solve);
        for (column, exact) in &self.exact {
            let values = run.column(column)?;
            let said = accuracy.channels.iter().find(|c| c.channel == *column)?;
            let first = values.len().saturating_sub(exact.len());
            let largest = exact.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let errors = values[first..]
                .iter()
                .zip(exact)
                .map(|(x, y)| (x - y).abs());
            let mut errors: Vec<f64> = errors.collect();
            errors.sort_by(f64::total_cmp);
            let usual = (0.95 * errors.len() as f64).ceil() as usize;
            let error = errors.get(usual.saturating_sub(1))?;
            samples.take(*error, said.usual_bar, 0.0, self.trust * largest);
        }
        Some(samples)
    }

    /// Runs the problem, with bars beside every number, or with what it says of itself by default.
    fn run(&self, (method, request, limit): (&str, f64, f64), accuracy: Accuracy) -> Option<Run> {
        let mut model = self.model.clone();
        if self.kind == Kind::Static {
            (model.equilibrium.error, model.equilibrium.imbalance) = (Some(request), Some(request));
        }
        let options = Options {
            error: Some(request),
            columns: self.exact.iter().map(|c| c.0.clone()).collect(),
            method: (self.kind == Kind::Integrated).then(|| method.into()),
            max_steps: Some(MAX_STEPS),
            limit: Some(limit),
            accuracy,
            ..Options::default()
        };
        let clock = ProcessorClock::start();
        let mut session = Session::new(model, &self.name, options);
        let status = match self.kind {
            Kind::Static => session.simulate(Analysis::Static, 0.0, 1, &mut Unwatched),
            _ => obey(&mut session, &self.steps, |_, _| (), &mut Unwatched),
        };
        // a further run that had no time left says nothing
        let is_judged = status == Ok(Status::Completed) && clock.seconds() < limit;
        is_judged.then_some(session.run)
    }

    fn compared(&self, run: &Run) -> Samples {
        let seconds = &run.record.seconds;
        let mut samples = Samples::of_run(seconds.accuracy / once(run));
        for (column, exact) in &self.exact {
            let columns = [column.clone(), format!("{column}±")].map(|c| run.column(&c));
            let [Some(values), Some(bars)] = columns else {
                continue;
            };
            let largest = exact.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            // before them stand rows of the start
            let first = values.len().saturating_sub(exact.len());
            let all = values[first..].iter().zip(&bars[first..]).zip(exact);
            for ((&value, &bar), &exact) in all {
                samples.take(value, bar, exact, self.trust * largest);
            }
        }
        samples
    }
}

/// The time of the run itself, in s: what a further run does again or finds done.
fn once(run: &Run) -> f64 {
    let s = &run.record.seconds;
    s.compile + s.assemble + s.record + s.translate + s.solve + s.evaluate
}
