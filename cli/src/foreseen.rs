//! A run foreseen, without running: the mistakes and doubts of a model, the elements that could
//! not be looked at, and whether the run makes its first step.

use cognate::analysis::session::{Analysis, Options, Session};
use cognate::dataset::Reading;
use cognate::dataset::command::Simulate;
use cognate::diagnostic::{Cause, Diagnostic, Severity, counted};
use cognate::model::{ElementId, ElementKind, Model};
use serde_json::json;
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::path::Path;

/// Time up to which motions are looked at where no command says when the run ends.
const HORIZON: f64 = 10.0;
/// Elements that are named where some could not be looked at, at most.
const MOST_NAMED: usize = 8;
/// Assemblies without what the one before could not solve, at most.
const MOST_ASSEMBLIES: usize = 4;

/// Reasons why a model is not solved, or not as it is meant, that are no mistakes in it.
const NOT_SOLVED_HERE: [Cause; 5] = [
    Cause::Unsupported,
    Cause::UserRoutine,
    Cause::CurveData,
    Cause::Skipped,
    Cause::Approximate,
];

/// All that a run of one file says before its first step.
#[derive(Default)]
pub struct Foreseen {
    /// mistakes, doubts and notes
    pub found: Vec<Diagnostic>,
    /// the first of the reasons why the run does not begin
    pub stop: Option<Diagnostic>,
    /// elements that were left out so that the rest could be looked at, as the file names them
    pub left_out: BTreeMap<ElementId, String>,
    /// the reason why not even the rest could be looked at
    pub unseen: Option<String>,
    /// whether the model has an error, rather than a file
    pub model_fails: bool,
}

/// Returns whether a diagnostic is an error.
fn is_error(d: &Diagnostic) -> bool {
    d.severity == Severity::Error
}

fn is_ours(d: &Diagnostic) -> bool {
    d.is_any(&NOT_SOLVED_HERE)
}

impl Foreseen {
    /// Returns what is foreseen of a file that is not looked at further: its errors stop the run.
    pub fn of_file(found: Vec<Diagnostic>) -> Self {
        Self {
            stop: found.iter().find(|d| is_error(d)).cloned(),
            found,
            ..Self::default()
        }
    }

    /// Adds what is foreseen of more of the same run.
    pub fn append(&mut self, more: Self) {
        self.found.extend(more.found);
        self.stop = self.stop.take().or(more.stop);
        self.left_out.extend(more.left_out);
        self.unseen = self.unseen.take().or(more.unseen);
        self.model_fails |= more.model_fails;
    }

    /// Finds what a run would refuse or doubt before its first step, of a model as commands leave
    /// it before their first simulation; nothing where the dataset has mistakes.
    pub fn of_model(
        reading: &Reading,
        model: &Model,
        file: &Path,
        simulate: Option<&Simulate>,
    ) -> Self {
        if reading.failed() {
            return Self {
                unseen: Some("the dataset has mistakes".to_owned()),
                ..Self::default()
            };
        }
        let (analysis, end) = match simulate.map(|s| s.resolved(0.0)) {
            Some(Ok((analysis, end, _))) => (analysis, end),
            Some(Err(error)) => return Self::of_file(error.into()),
            None => (Analysis::Transient, HORIZON),
        };
        let begin = |model: &Model, options: Options| {
            let mut session = Session::new(model.clone(), "check", options);
            session.folders = file.parent().map(Path::to_path_buf).into_iter().collect();
            session.preview(analysis, end)
        };
        let mut this = Self::of_file(begin(
            model,
            Options {
                named_only: true,
                ..Options::default()
            },
        ));
        if this.found.iter().any(|d| is_error(d) && is_ours(d)) {
            this.look_at_the_rest(model, begin);
        }
        for d in this.found.iter_mut().filter(|d| is_ours(d)) {
            d.severity = Severity::Note;
        }
        this.model_fails = this.found.iter().any(is_error);
        this.add_doubts(model);
        // the reader has told, with more advice, what can be seen without assembly
        let what = |d: &Diagnostic| (d.code, d.subject(), d.argument);
        let told: HashSet<_> = reading.diagnostics.iter().map(what).collect();
        this.found.retain(|d| !told.contains(&what(d)));
        let found = std::mem::take(&mut this.found).into_iter();
        this.found = found.map(|d| reading.dataset.locate(d)).collect();
        this.stop = this.stop.map(|d| reading.dataset.locate(d));
        this
    }

    /// Looks at the model without what is not solved, and without what that in turn lacks.
    fn look_at_the_rest(
        &mut self,
        model: &Model,
        begin: impl Fn(&Model, Options) -> Vec<Diagnostic>,
    ) {
        let mut rest = model.clone();
        let mut seen = Vec::new();
        for _ in 0..MOST_ASSEMBLIES {
            seen = begin(
                &rest,
                Options {
                    zero_user: true,
                    skip: ElementKind::ALL.iter().copied().collect(),
                    named_only: true,
                    ..Options::default()
                },
            );
            let lacking = elements(seen.iter().filter(|d| is_error(d) && is_ours(d)));
            let before = rest.inactive.len();
            rest.inactive.extend(lacking);
            if rest.inactive.len() == before {
                break;
            }
        }
        let unsolved = self.found.iter().filter(|d| is_error(d) && is_ours(d));
        let skipped = seen.iter().filter(|d| d.is(Cause::Skipped));
        let switched_off = rest.inactive.difference(&model.inactive).copied();
        let left_out = elements(unsolved.chain(skipped))
            .into_iter()
            .chain(switched_off);
        self.left_out = left_out.map(|id| (id, model.called(id))).collect();
        self.unseen = (seen.iter().find(|d| is_error(d) && is_ours(d))).map(in_brief);
        // warnings about the whole are those of the rest
        self.found.retain(|d| is_ours(d) || is_error(d));
        let named = elements(self.found.iter());
        let is_news = |d: &Diagnostic| match is_ours(d) {
            true => d.is(Cause::Skipped) && elements(std::iter::once(d)).is_disjoint(&named),
            false => true,
        };
        self.found.extend(seen.into_iter().filter(is_news));
    }

    /// Adds what is doubted about the mechanism; where something cannot be, that comes before.
    fn add_doubts(&mut self, model: &Model) {
        let doubts = model.doubts();
        if self.found.iter().any(is_error) {
            self.found.extend(doubts);
        } else {
            self.found.splice(0..0, doubts);
        }
        self.found.dedup();
    }

    /// Returns what is foreseen of the run of a file, as data.
    pub fn json(&self, file: &Path) -> serde_json::Value {
        let names =
            |d: &Diagnostic| json!({ "code": d.code, "element": d.element, "message": d.message });
        json!({
            "file": file.display().to_string(),
            "begins": self.stop.is_none(),
            "stop": self.stop.as_ref().map(names),
            "not_looked_at": self.left_out.keys().map(ToString::to_string).collect::<Vec<_>>(),
            "not_assembled": self.unseen,
        })
    }

    /// Returns the sentences about what was not looked at, and about the run: a line each.
    pub fn sentences(&self) -> Vec<String> {
        let mut lines = Vec::new();
        if !self.left_out.is_empty() {
            let names: Vec<&str> = self.left_out.values().map(String::as_str).collect();
            let shown = names.len().min(MOST_NAMED);
            let more = match names.len() - shown {
                0 => String::new(),
                more => format!(" and {}", counted(more, "more element")),
            };
            let rest = match self.unseen.is_none() && !self.model_fails {
                true => "; the rest can be assembled",
                false => "",
            };
            lines.push(format!(
                "not looked at: {}{more}{rest}",
                names[..shown].join(", ")
            ));
        }
        if let Some(why) = &self.unseen {
            lines.push(format!("not assembled: {why}"));
        }
        lines.push(match &self.stop {
            Some(why) => format!("run will stop before its first step: {}", in_brief(why)),
            None => "run will begin".to_owned(),
        });
        lines
    }
}

/// Returns the element and the message of a diagnostic.
fn in_brief(d: &Diagnostic) -> String {
    let element = d.named().map_or(String::new(), |name| format!("{name}: "));
    format!("{element}{}", d.message)
}

/// Returns the elements that diagnostics are about.
fn elements<'a>(all: impl Iterator<Item = &'a Diagnostic>) -> BTreeSet<ElementId> {
    let names = all.filter_map(|d| d.element.as_deref());
    names.filter_map(|name| name.parse().ok()).collect()
}
