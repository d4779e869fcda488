//! Which runs a study makes: the cheapest first, as long as the budget lasts.

use super::attempt::{Attempt, attempt};
use super::distance::{self, Candidate, Table};
use super::{Cost, Error, Follow, LeftOut, Outcome, Question, Reason, Reference, Row, Study};
use crate::analysis::time::options::method_named;
use crate::arrange::Arrange;
use crate::diagnostic;
use crate::numeric::METHODS;
use crate::results::Status;
use crate::scalar::Scalar;

/// Part of what the budget has left that one run may take.
const MOST_PER_RUN: f64 = 0.5;
/// Growth of the cost from one run to the next that is expected, at least.
const LEAST_GROWTH: f64 = 1.1;

/// The runs of one method, from the largest request on.
struct Series {
    method: String,
    order: usize,
    /// place of the next request
    next: usize,
    /// requests and processor times of the runs that came to their end
    times: Vec<(f64, f64)>,
    /// why no more are started
    closed: Option<Reason>,
}

impl Series {
    /// Returns the processor time that a run at `request` will probably take, in s: the least and
    /// the most of what its order and its last two runs say.
    fn expected(&self, request: f64) -> [f64; 2] {
        let Some(&(last, seconds)) = self.times.last() else {
            return [0.0; 2];
        };
        let finer = (last / request).max(1.0);
        let by_order = Scalar::powf(finer, 1.0 / self.order as f64);
        let seen = match self.times.as_slice() {
            [.., (before, less), _] if *before > last && *less > 0.0 => {
                let exponent = Scalar::ln(seconds / less) / Scalar::ln(before / last);
                Scalar::powf(finer, exponent.clamp(0.0, 2.0))
            }
            _ => by_order,
        };
        [
            seconds * by_order.min(seen),
            seconds * by_order.max(seen).max(LEAST_GROWTH),
        ]
    }
}

/// A run and its place in the study.
struct Done {
    method: String,
    request: f64,
    attempt: Result<Attempt, String>,
}

/// A study on its way.
struct Survey<'a> {
    question: &'a Question<'a>,
    watch: &'a mut dyn Follow,
    series: Vec<Series>,
    done: Vec<Done>,
    spent: f64,
    interrupted: bool,
    is_integrated: bool,
}

/// Runs the model of a question at all its requests by all methods that fit, cheap runs first.
///
/// # Errors
/// The model cannot be run by the first method at the first request.
pub fn survey(question: &Question<'_>, watch: &mut dyn Follow) -> Result<Study, diagnostic::Error> {
    let mut survey = Survey {
        question,
        watch,
        series: Vec::new(),
        done: Vec::new(),
        spent: 0.0,
        interrupted: false,
        is_integrated: true,
    };
    let Some(&first) = question.requests.first() else {
        return Ok(survey.study());
    };
    survey.begin(first)?;
    while let Some(k) = survey.cheapest() {
        survey.run(k);
    }
    Ok(survey.study())
}

impl Survey<'_> {
    /// Makes the first run, which tells which methods fit.
    ///
    /// # Errors
    /// The model cannot be run.
    fn begin(&mut self, request: f64) -> Result<(), diagnostic::Error> {
        // several names may stand for one method
        let mut names: Vec<String> = Vec::new();
        for name in self.question.methods.iter().map(|name| method_named(name)) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let first = names.first().map_or("AUTO", String::as_str);
        self.watch.begins((first, request), 0.0);
        let attempt = attempt(self.question, (first, request), self.limit(), self.watch)?;
        // a run that ended early may not have come to its integration
        self.is_integrated = attempt.is_integrated || attempt.status != Status::Completed;
        let known = METHODS.iter().map(|m| m.name);
        let fit: Vec<&str> = match (self.is_integrated, names.is_empty()) {
            (false, _) => vec![first],
            (true, true) => ["AUTO"].into_iter().chain(known).collect(),
            (true, false) => names.iter().map(String::as_str).collect(),
        };
        self.series = fit.into_iter().map(series).collect();
        self.take(0, request, Ok(attempt));
        if !self.is_integrated {
            // neither method nor request changes anything: one run says it all
            self.series[0].next = self.question.requests.len();
        }
        Ok(())
    }

    /// Returns the processor time that the next run may take, in s.
    fn limit(&self) -> f64 {
        (MOST_PER_RUN * (self.question.budget - self.spent)).max(0.0)
    }

    /// Returns the series whose next run is expected to be the cheapest; closes those that cannot
    /// reach the next wanted error with what the budget has left: runs on the way there would not
    /// help.
    fn cheapest(&mut self) -> Option<usize> {
        let limit = self.limit();
        let requests = &self.question.requests;
        let mut best: Option<(f64, usize)> = None;
        for (k, series) in self.series.iter_mut().enumerate() {
            let Some(&request) = requests.get(series.next) else {
                continue;
            };
            if series.closed.is_some() {
                continue;
            }
            let [_, expected] = series.expected(request);
            let wanted = self.question.wanted.iter().copied();
            let wanted = wanted.filter(|w| *w <= request).fold(0.0, f64::max);
            let [there, _] = series.expected(if wanted > 0.0 { wanted } else { request });
            if self.interrupted {
                series.closed = Some(Reason::Interrupted);
            } else if expected > limit || limit <= 0.0 {
                let to = request;
                series.closed = Some(Reason::Budget { to, expected });
            } else if there > limit {
                let (to, expected) = (wanted, there);
                series.closed = Some(Reason::Budget { to, expected });
            } else if best.is_none_or(|(least, _)| expected < least) {
                best = Some((expected, k));
            }
        }
        best.map(|(_, k)| k)
    }

    /// Makes the next run of a series.
    fn run(&mut self, k: usize) {
        let series = &self.series[k];
        let request = self.question.requests[series.next];
        let by = (series.method.as_str(), request);
        self.watch.begins(by, self.spent);
        let found = attempt(self.question, by, self.limit(), self.watch);
        let refused = |error: diagnostic::Error| error.first().to_string();
        self.take(k, request, found.map_err(refused));
    }

    /// Takes note of a run of a series.
    fn take(&mut self, k: usize, request: f64, attempt: Result<Attempt, String>) {
        let series = &mut self.series[k];
        series.next += 1;
        match &attempt {
            Ok(run) => {
                self.spent += run.spent;
                match run.status {
                    Status::Completed => {
                        series
                            .times
                            .push((request, run.cost.set_up + run.cost.solve));
                    }
                    Status::Limit => series.closed = Some(Reason::Slower),
                    Status::Interrupted => {
                        self.interrupted = true;
                        series.next -= 1;
                    }
                    Status::Model | Status::NoEquilibrium | Status::Stopped => {}
                }
            }
            // it will be refused at every request
            Err(_) => series.next = self.question.requests.len(),
        }
        let method = series.method.clone();
        self.done.push(Done {
            method,
            request,
            attempt,
        });
    }

    /// Returns the study: all runs against the reference.
    fn study(mut self) -> Study {
        let order = |method: &str| self.series.iter().position(|s| s.method == method);
        let key = |done: &Done| (order(&done.method), -done.request);
        self.done.arrange_by(|a, b| {
            let (a, b) = (key(a), key(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        let (table, reference) = self.reference().unzip();
        let channels = table.as_ref().map_or_else(Vec::new, |t| t.names.clone());
        let left_out = self.series.iter().filter_map(|series| {
            let requests = self.question.requests.get(series.next..)?.to_vec();
            let why = series.closed.filter(|_| !requests.is_empty())?;
            let method = series.method.clone();
            Some(LeftOut {
                method,
                requests,
                why,
            })
        });
        let left_out = left_out.collect();
        let (name, title) = (
            self.question.name.clone(),
            self.question.model.title.clone(),
        );
        let rows = self.done.into_iter();
        Study {
            rows: rows.map(|done| row(done, table.as_ref())).collect(),
            name,
            title,
            channels,
            reference,
            left_out,
            seconds: self.spent,
            interrupted: self.interrupted,
            is_integrated: self.is_integrated,
        }
    }

    /// Returns the table that errors are measured against.
    fn reference(&self) -> Option<(Table, Reference)> {
        if let Some(trusted) = &self.question.trusted {
            return Some((Table::of(trusted), Reference::Trusted));
        }
        let finished = self.done.iter().filter_map(|done| {
            let run = done.attempt.as_ref().ok()?;
            (run.status == Status::Completed).then_some(Candidate {
                method: &done.method,
                worked: &run.worked,
                request: done.request,
                table: &run.table,
            })
        });
        let candidates: Vec<Candidate<'_>> = finished.collect();
        let (k, reference) = distance::choose(&candidates)?;
        Some((candidates[k].table.clone(), reference))
    }
}

/// Begins the series of a method.
fn series(method: &str) -> Series {
    let row = METHODS.iter().find(|m| m.name == method);
    Series {
        method: method.to_string(),
        // AUTO takes the best of them
        order: row.map_or(5, |m| m.order),
        next: 0,
        times: Vec::new(),
        closed: None,
    }
}

/// Returns the row of a run against a reference.
fn row(done: Done, reference: Option<&Table>) -> Row {
    let (outcome, cost) = match done.attempt {
        Err(reason) => (Outcome::Refused(reason), Cost::default()),
        Ok(run) if run.status == Status::Completed => {
            (Outcome::Done(compared(&run.table, reference)), run.cost)
        }
        Ok(run) => (Outcome::Ended(run.status, run.reason), run.cost),
    };
    Row {
        method: done.method,
        request: done.request,
        outcome,
        cost,
    }
}

/// Returns the error of a table; infinite where it cannot be compared.
fn compared(table: &Table, reference: Option<&Table>) -> Error {
    let infinite = Error {
        rms: f64::INFINITY,
        largest: f64::INFINITY,
        worst: 0,
    };
    let against = reference.and_then(|reference| {
        let same = table.with_channels_of(reference)?;
        distance::error(&same, reference)
    });
    against.unwrap_or(infinite)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::session::Options;
    use crate::analysis::watch::{Unwatched, Watch};
    use crate::dataset::command::Script;
    use crate::model::Model;

    const PENDULUM: &str = "PENDULUM\nPART/1, GROUND\nMARKER/1, PART=1\n\
        PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2, QP=1,0,0\nMARKER/3, PART=2\n\
        JOINT/1, REVOLUTE, I=3, J=1\nACCGRAV/JGRAV=-9.81\nEND\n";

    fn study(budget: f64, methods: &[&str], watch: &mut dyn Follow) -> Study {
        let model = Model::from_text(PENDULUM).expect("a model");
        asked(
            &model,
            "SIMULATE/DYNAMIC, END=1, STEPS=10\n",
            (budget, methods),
            watch,
        )
    }

    fn study_of(model: &Model, commands: &str) -> Study {
        asked(model, commands, (60.0, &[]), &mut Unwatched)
    }

    fn asked(
        model: &Model,
        commands: &str,
        (budget, methods): (f64, &[&str]),
        watch: &mut dyn Follow,
    ) -> Study {
        let script = Script::from_text(commands).expect("commands");
        let question = Question {
            name: "pendulum".into(),
            model,
            steps: &script.steps,
            options: Options {
                columns: vec!["DX(2,1)".into(), "DY(2,1)".into()],
                ..Options::default()
            },
            folders: Vec::new(),
            requests: vec![1e-3, 1e-6, 1e-9],
            methods: methods.iter().map(ToString::to_string).collect(),
            wanted: vec![1e-4],
            budget,
            trusted: None,
        };
        survey(&question, watch).expect("a study")
    }

    #[test]
    fn errors_of_a_study_fall_with_the_request_and_costs_are_counted() {
        let study = study(60.0, &["DOP853", "RADAU5"], &mut Unwatched);
        assert_eq!(study.rows.len(), 6, "{study:?}");
        assert!(study.left_out.is_empty() && !study.interrupted);
        assert!(
            study
                .reference
                .as_ref()
                .is_some_and(|r| r.trust() > 0.0 && r.trust() < 1e-6)
        );
        for method in ["DOP853", "RADAU5"] {
            let of = study.rows.iter().filter(|r| r.method == method);
            let errors: Vec<f64> = of.map(|r| r.error().expect("done").largest).collect();
            assert!(errors[0] > 10.0 * errors[1], "{method}: {errors:?}");
        }
        let row = study.recommended(1e-4).expect("a recommendation");
        assert!(row.cost.counts.steps > 0 && row.cost.profile.is_some());
        assert!(study.recommended(1e-15).is_none(), "below the trust");
    }

    #[test]
    fn names_that_stand_for_one_method_are_one_series_with_its_name() {
        let study = study(60.0, &["HHT", "radau5", "GSTIFF"], &mut Unwatched);
        assert!(study.rows.iter().all(|row| row.method == "RADAU5"));
        let requests: Vec<f64> = study.rows.iter().map(|row| row.request).collect();
        assert!(
            requests.windows(2).all(|pair| pair[0] > pair[1]),
            "{requests:?}"
        );
    }

    #[test]
    fn a_budget_leaves_out_and_says_so() {
        let none = study(1e-9, &[], &mut Unwatched);
        assert!(none.rows.iter().all(|r| r.error().is_none()));
        assert!(!none.left_out.is_empty() && none.reference.is_none());
    }

    #[test]
    fn a_method_that_cannot_reach_what_is_wanted_is_left_out_by_name() {
        // of order five: a decade costs 1.6 times at least, here 1.8 times
        let slow = Series {
            times: vec![(1e-2, 5.0), (1e-3, 9.0)],
            next: 2,
            ..series("RADAU5")
        };
        assert!(slow.expected(1e-6)[0] > 30.0 && slow.expected(1e-4)[1] < 30.0);
        let model = Model::default();
        let question = Question {
            name: String::new(),
            model: &model,
            steps: &[],
            options: Options::default(),
            folders: Vec::new(),
            requests: vec![1e-2, 1e-3, 1e-4, 1e-5, 1e-6],
            methods: Vec::new(),
            wanted: vec![1e-6],
            budget: 60.0,
            trusted: None,
        };
        let mut survey = Survey {
            question: &question,
            watch: &mut Unwatched,
            series: vec![slow],
            done: Vec::new(),
            spent: 0.0,
            interrupted: false,
            is_integrated: true,
        };
        assert_eq!(survey.cheapest(), None);
        let study = survey.study();
        let [left] = study.left_out.as_slice() else {
            panic!("{:?}", study.left_out);
        };
        assert_eq!((left.method.as_str(), left.requests.len()), ("RADAU5", 3));
        assert!(left.why.to_string().contains("1e-6"), "{}", left.why);
    }

    #[test]
    fn where_nothing_is_integrated_one_run_says_so() {
        let text = PENDULUM.replace(
            "ACCGRAV",
            "MOTION/1, JOINT=1, ROTATION, FUNCTION=TIME\nACCGRAV",
        );
        let model = Model::from_text(&text).expect("a model");
        let study = study_of(&model, "SIMULATE/KINEMATIC, END=1, STEPS=10\n");
        assert_eq!((study.rows.len(), study.is_integrated), (1, false));
        let told = study.text(&[1e-4, 1e-8]);
        assert!(told.contains("nothing is integrated"), "{told}");
        assert!(
            !told.contains("--error") && !told.contains("for an error"),
            "{told}"
        );
    }

    #[test]
    fn an_interrupted_study_keeps_what_it_has() {
        /// Stops after some looks.
        struct Impatient(usize);
        impl Watch for Impatient {
            fn interrupted(&mut self) -> bool {
                self.0 = self.0.saturating_sub(1);
                self.0 == 0
            }
        }
        impl Follow for Impatient {}
        let study = study(60.0, &["DOP853", "RADAU5"], &mut Impatient(60));
        assert!(study.interrupted);
        assert!(study.rows.iter().any(|r| r.error().is_some()), "{study:?}");
        assert!(study.left_out.iter().all(|l| l.why == Reason::Interrupted));
        assert!(!study.left_out.is_empty());
    }
}
