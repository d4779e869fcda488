//! A scene of known answer: a model of a few lines, how it is run, and what must come out.

use crate::running::{self, Analysis, Options};
use cognate::analysis::watch::Unwatched;
use cognate::results::Status;

/// What must come out of a scene.
pub enum Claim {
    /// a column follows a function of time at every output, up to a tolerance
    Follows(String, Box<dyn Fn(f64) -> f64>, f64),
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
    /// not as claimed, without a word
    Wrong,
}

/// A scene.
pub struct Scene {
    pub family: &'static str,
    pub name: String,
    text: String,
    analysis: Analysis,
    end: f64,
    steps: usize,
    error: f64,
    method: Option<&'static str>,
    claims: Vec<Claim>,
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
    pub fn ends(mut self, words: &'static str) -> Self {
        self.claims.push(Claim::Ends(words));
        self
    }

    pub fn tells(mut self, words: &'static str) -> Self {
        self.claims.push(Claim::Tells(words));
        self
    }

    /// Runs the scene: how it came out, and a sentence about the worst of it.
    pub fn run(&self) -> (Outcome, String) {
        let follows = self.claims.iter().filter_map(|c| match c {
            Claim::Follows(column, ..) => Some(column.clone()),
            Claim::Ends(_) | Claim::Tells(_) => None,
        });
        let options = Options {
            columns: follows.collect(),
            error: Some(self.error),
            method: self.method.map(str::to_owned),
            ..Options::default()
        };
        let model = running::model(&self.text);
        let mut session = running::begin(model, "scene", options);
        let status = session.simulate(self.analysis, self.end, self.steps, &mut Unwatched);
        let (ended, said): (bool, Vec<String>) = match status {
            Err(errors) => (true, errors.iter().map(ToString::to_string).collect()),
            Ok(Status::Completed) => (false, Vec::new()),
            Ok(_) => (true, vec![session.run.record.stop_reason.to_string()]),
        };
        if ended {
            let expected = self
                .claims
                .iter()
                .any(|c| matches!(c, Claim::Ends(words) if said.iter().any(|s| s.contains(words))));
            let outcome = if expected {
                Outcome::Right
            } else {
                Outcome::Stopped
            };
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
                    let times = session.run.column("TIME").unwrap_or_default();
                    let values = session.run.column(column).unwrap_or_default();
                    // rest is what a search ends with
                    let first = if self.analysis == Analysis::Static {
                        values.len().saturating_sub(1)
                    } else {
                        0
                    };
                    for (&t, &x) in times.iter().zip(values).skip(first) {
                        let off = (x - expected(t)).abs() / tolerance;
                        let off = if off.is_nan() { f64::INFINITY } else { off };
                        if off >= worst.0 {
                            worst = (
                                off,
                                format!("{column} = {x:e} at {t}, expected {:e}", expected(t)),
                            );
                        }
                    }
                    if values.len() < 2 {
                        return (
                            Outcome::Wrong,
                            format!("{column} has {} rows", values.len()),
                        );
                    }
                }
            }
        }
        let sentence = format!(
            "{:.1e} of what is permitted; {}; {} steps",
            worst.0, worst.1, session.run.record.counts.steps
        );
        if worst.0 <= 1.0 {
            (Outcome::Right, sentence)
        } else {
            (Outcome::Wrong, sentence)
        }
    }
}
