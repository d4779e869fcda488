//! A scene of known answer: a model of a few lines, how it is run, and what must come out.

use crate::running::{self, Analysis, Options, Session};
use cognate::analysis::session::Accuracy;
use cognate::analysis::watch::Unwatched;
use cognate::results::Status;

/// What must come out of a scene.
pub enum Claim {
    /// a column follows a function of time at every output, up to a tolerance
    Follows(String, Box<dyn Fn(f64) -> f64>, f64),
    /// a column stays zero as terms of some size cancel in it, up to a tolerance
    Balances(String, f64, f64),
    /// the run stops, or is refused, and one of the sentences that say so has these words
    Ends(&'static str),
    /// the run goes to its end, and one of its warnings has these words
    Tells(&'static str),
}

/// How a scene came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// as claimed
    Right,
    /// not as claimed, but said so: stopped or refused with a reason
    Stopped,
    /// not as claimed, but it is warned that errors have added up
    Told,
    /// ended at its limit of steps or of processor time
    Limited,
    /// not as claimed, without a word
    Wrong,
}

/// How a scene came out at some request.
pub struct Found {
    pub outcome: Outcome,
    /// the worst of it, or why it stopped
    pub sentence: String,
    /// accepted steps
    pub steps: u64,
}

/// A scene.
pub struct Scene {
    pub family: &'static str,
    pub name: String,
    text: String,
    pub analysis: Analysis,
    end: f64,
    steps: usize,
    pub error: f64,
    pub method: Option<&'static str>,
    pub claims: Vec<Claim>,
}

/// A scene of a family; ground with MARKER/1 at its origin is there, what else there is stands in `text`.
pub fn scene(family: &'static str, name: impl Into<String>, text: impl Into<String>) -> Scene {
    Scene {
        family,
        name: name.into(),
        text: text.into(),
        analysis: Analysis::Dynamic,
        end: 1.0,
        steps: 10,
        error: 1e-8,
        method: None,
        claims: Vec::new(),
    }
}

impl Scene {
    pub fn end(mut self, end: f64) -> Self {
        self.end = end;
        self
    }
    pub fn steps(mut self, steps: usize) -> Self {
        self.steps = steps;
        self
    }
    pub fn error(mut self, error: f64) -> Self {
        self.error = error;
        self
    }
    pub fn method(mut self, method: &'static str) -> Self {
        self.method = Some(method);
        self.name += " ";
        self.name += method;
        self
    }
    pub fn kinematic(mut self) -> Self {
        self.analysis = Analysis::Kinematic;
        self
    }
    pub fn at_rest(mut self) -> Self {
        self.analysis = Analysis::Static;
        self.steps = 1;
        self
    }
    pub fn follows(
        mut self,
        column: impl Into<String>,
        expected: impl Fn(f64) -> f64 + 'static,
        tolerance: f64,
    ) -> Self {
        self.claims
            .push(Claim::Follows(column.into(), Box::new(expected), tolerance));
        self
    }
    /// A column stays zero: its terms, of about that size, cancel.
    pub fn balances(mut self, column: impl Into<String>, size: f64, tolerance: f64) -> Self {
        self.claims
            .push(Claim::Balances(column.into(), size, tolerance));
        self
    }
    pub fn ends(mut self, words: &'static str) -> Self {
        self.claims.push(Claim::Ends(words));
        self
    }

    pub fn tells(mut self, words: &'static str) -> Self {
        self.claims.push(Claim::Tells(words));
        self
    }

    /// Runs the scene at a requested error by a method, within a limit of processor time in s.
    ///
    /// At a larger request than the scene's own the permitted error grows in proportion, and an error as large as the request is permitted, up to
    /// the swing of what is expected.
    pub fn run_at(&self, error: f64, method: Option<&str>, limit: Option<f64>) -> Found {
        let follows = self.claims.iter().filter_map(|c| match c {
            Claim::Follows(column, ..) | Claim::Balances(column, ..) => Some(column.clone()),
            Claim::Ends(_) | Claim::Tells(_) => None,
        });
        let options = Options {
            columns: follows.collect(),
            error: Some(error),
            method: method.map(str::to_owned),
            limit,
            accuracy: Accuracy::Digits,
            ..Options::default()
        };
        let model = running::model(&self.text);
        let mut session = running::begin(model, "scene", options);
        let status = session.simulate(self.analysis, self.end, self.steps, &mut Unwatched);
        let (outcome, sentence) = self.judged(status, &session, error);
        let steps = session.run.record.counts.steps;
        Found {
            outcome,
            sentence,
            steps,
        }
    }

    /// How a session that has ended came out, and a sentence about the worst of it.
    fn judged(
        &self,
        status: Result<Status, cognate::Error>,
        session: &Session,
        error: f64,
    ) -> (Outcome, String) {
        let (ended, said): (Outcome, Vec<String>) = match status {
            Err(errors) => (
                Outcome::Stopped,
                (errors.diagnostics().iter())
                    .map(ToString::to_string)
                    .collect(),
            ),
            Ok(Status::Completed) => (Outcome::Right, Vec::new()),
            Ok(Status::Limit) => (
                Outcome::Limited,
                vec![session.run.record.stop_reason.clone()],
            ),
            Ok(_) => (
                Outcome::Stopped,
                vec![session.run.record.stop_reason.clone()],
            ),
        };
        if ended != Outcome::Right {
            let expected = self
                .claims
                .iter()
                .any(|c| matches!(c, Claim::Ends(words) if said.iter().any(|s| s.contains(words))));
            let outcome = if expected { Outcome::Right } else { ended };
            return (outcome, said.join("; "));
        }
        let mut worst = (0.0, String::new());
        for claim in &self.claims {
            match claim {
                Claim::Ends(words) => {
                    return (Outcome::Wrong, format!("went on; expected {words:?}"));
                }
                Claim::Tells(words) => {
                    let said = session.run.record.warned();
                    if !said.iter().any(|s| s.contains(words)) {
                        return (Outcome::Wrong, format!("said {said:?}; expected {words:?}"));
                    }
                }
                Claim::Follows(column, expected, tolerance) => {
                    let swing = swing(session, expected);
                    let permitted = tolerance * self.slack(swing, *tolerance, error);
                    match self.followed(session, (column, expected), permitted) {
                        Ok(found) if found.0 >= worst.0 => worst = found,
                        Ok(_) => {}
                        Err(sentence) => return (Outcome::Wrong, sentence),
                    }
                }
                Claim::Balances(column, size, tolerance) => {
                    let permitted = tolerance * self.slack(*size, *tolerance, error);
                    match self.followed(session, (column, &|_| 0.0), permitted) {
                        Ok(found) if found.0 >= worst.0 => worst = found,
                        Ok(_) => {}
                        Err(sentence) => return (Outcome::Wrong, sentence),
                    }
                }
            }
        }
        let sentence = format!("{:.1e} of what is permitted; {}", worst.0, worst.1);
        let is_told = || {
            let said = session.run.record.warned();
            let words = [
                "errors have added up",
                "is known no longer",
                "the balance of energy",
            ];
            said.iter().any(|s| words.iter().any(|w| s.contains(w)))
        };
        let outcome = match worst.0 <= 1.0 {
            true => Outcome::Right,
            false if is_told() => Outcome::Told,
            false => Outcome::Wrong,
        };
        (outcome, sentence)
    }

    /// The factor by which the tolerance of a claim grows at a requested error larger than the scene's own: as the request does, at least to
    /// the request itself, but no further than the swing of what is expected.
    fn slack(&self, swing: f64, tolerance: f64, error: f64) -> f64 {
        if error <= self.error {
            return 1.0;
        }
        let whole = (swing / tolerance).max(1.0);
        (error / self.error).max(error * whole).clamp(1.0, whole)
    }

    /// The largest difference of a column from what is expected, over what is permitted, with its sentence.
    fn followed(
        &self,
        session: &Session,
        (column, expected): (&str, &dyn Fn(f64) -> f64),
        permitted: f64,
    ) -> Result<(f64, String), String> {
        let times = session.run.column("TIME").unwrap_or_default();
        let values = session.run.column(column).unwrap_or_default();
        // rest is what a search ends with
        let first = if self.analysis == Analysis::Static {
            values.len().saturating_sub(1)
        } else {
            0
        };
        let mut worst = (0.0, String::new());
        for (&t, &x) in times.iter().zip(values).skip(first) {
            let off = (x - expected(t)).abs() / permitted;
            let off = if off.is_nan() { f64::INFINITY } else { off };
            if off >= worst.0 {
                worst = (
                    off,
                    format!("{column} = {x:e} at {t}, expected {:e}", expected(t)),
                );
            }
        }
        if values.len() < 2 {
            return Err(format!("{column} has {} rows", values.len()));
        }
        Ok(worst)
    }
}

/// The swing of what is expected at the outputs; its size where it stays the same.
fn swing(session: &Session, expected: &dyn Fn(f64) -> f64) -> f64 {
    let times = session.run.column("TIME").unwrap_or_default();
    let values = || times.iter().map(|&t| expected(t));
    let high = values().fold(f64::NEG_INFINITY, f64::max);
    let low = values().fold(f64::INFINITY, f64::min);
    let size = values().fold(0.0, |m: f64, x| m.max(x.abs()));
    if high > low { high - low } else { size }
}
