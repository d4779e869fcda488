//! A study as text for the terminal, as CSV and as JSON.

use super::{Outcome, Reference, Row, Study};
use crate::results::Counts;
use serde_json::{Value, json};
use std::fmt::Write as _;

impl Row {
    /// Returns why it has no error; empty: it has one.
    pub(super) fn reason(&self) -> String {
        match &self.outcome {
            Outcome::Done(_) => String::new(),
            Outcome::Ended(status, reason) if reason.starts_with(status.word()) => reason.clone(),
            Outcome::Ended(status, reason) => format!("{}: {reason}", status.word()),
            Outcome::Refused(reason) => format!("refused: {reason}"),
        }
    }
}

/// Prints a duration in s with three digits and a fitting unit.
pub(super) fn duration(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s >= 120.0 => (s / 60.0, "min"),
        s if s >= 1.0 => (s, "s"),
        s if s >= 1e-3 => (1e3 * s, "ms"),
        s => (1e6 * s, "µs"),
    };
    let decimals = match value {
        v if v >= 100.0 => 0,
        v if v >= 10.0 => 1,
        _ => 2,
    };
    format!("{value:.decimals$} {unit}")
}

impl Study {
    /// Returns the sentence about the reference.
    pub fn about_reference(&self) -> String {
        match &self.reference {
            _ if !self.is_integrated => "nothing is integrated here: the result is exact to rounding, whatever method and error are asked for".into(),
            None => "no run came to its end: there is no reference".into(),
            Some(Reference::Trusted) => "errors are against a trusted table".into(),
            Some(Reference::Run { best, other }) => {
                let (method, request) = best;
                let mut text = format!("errors are against {method} at {request:.0e}");
                match other {
                    Some(((by, at), difference)) => {
                        let _ = write!(
                            text,
                            ", from which {by} at {at:.0e} differs by {difference:.1e}: smaller errors cannot be told"
                        );
                    }
                    None => text += "; no other method confirms it",
                }
                text
            }
        }
    }

    /// Returns the name of a channel.
    pub(super) fn channel(&self, k: usize) -> &str {
        self.channels.get(k).map_or("", String::as_str)
    }

    /// Returns the sentence that recommends a method and a request for an error.
    pub fn recommendation(&self, wanted: f64) -> String {
        match self.recommended(wanted) {
            Some(row) => {
                let error = row.error().unwrap_or_default().largest;
                let error = match error > 0.0 {
                    true => format!("{error:.1e}"),
                    false => "no error found".to_owned(),
                };
                format!(
                    "for an error of {wanted:.0e}: --method {} --error {:.0e} ({error}, in {} of solving)",
                    row.method,
                    row.request,
                    duration(row.cost.solve)
                )
            }
            None => format!("for an error of {wanted:.0e}: no run is known to be that good"),
        }
    }

    /// Returns the table of runs and what follows from it, for the terminal.
    pub fn text(&self, wanted: &[f64]) -> String {
        let mut text = format!(
            "{:<8} {:>8} {:>9} {:>9} {:>10} {:>10} {:>8} {:>9} {:>8}  worst channel, or why not\n",
            "method", "request", "RMS", "maximum", "set-up", "solving", "steps", "evals", "factors"
        );
        for row in &self.rows {
            let c = &row.cost.counts;
            let (rms, largest, worst) = match row.error() {
                Some(e) if self.is_told(e.largest) => (
                    format!("{:.1e}", e.rms),
                    format!("{:.1e}", e.largest),
                    self.channel(e.worst).to_string(),
                ),
                Some(_) => ("≤ ref.".into(), "≤ ref.".into(), String::new()),
                None => ("-".into(), "-".into(), row.reason()),
            };
            let _ = writeln!(
                text,
                "{:<8} {:>8.0e} {rms:>9} {largest:>9} {:>10} {:>10} {:>8} {:>9} {:>8}  {worst}",
                row.method,
                row.request,
                duration(row.cost.set_up),
                duration(row.cost.solve),
                c.steps,
                c.evaluations,
                c.factorizations,
            );
        }
        for left in &self.left_out {
            let requests: Vec<String> = left.requests.iter().map(|r| format!("{r:.0e}")).collect();
            let requests = requests.join(", ");
            let _ = writeln!(
                text,
                "left out: {} at {requests}: {}",
                left.method, left.why
            );
        }
        let _ = writeln!(text, "{}", self.about_reference());
        for error in wanted.iter().filter(|_| self.is_integrated) {
            let _ = writeln!(text, "{}", self.recommendation(*error));
        }
        text
    }

    /// Returns all runs as comma-separated values.
    pub fn csv(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let parts = super::Profile::default()
            .parts()
            .map(|(name, _)| format!("{name}_seconds"));
        let head = "method request status error_rms error_max worst_channel set_up_seconds solve_seconds write_seconds \
                    steps rejected_steps evaluations jacobians factorizations";
        let head = head.split_whitespace().map(str::to_string).chain(parts);
        // rows of equal length in memory cannot fail
        let _ = writer.write_record(head.chain(["reason".to_string()]));
        for row in &self.rows {
            let error = row.error();
            let number = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:e}"));
            let status = match &row.outcome {
                Outcome::Done(_) => "completed",
                Outcome::Ended(status, _) => status.word(),
                Outcome::Refused(_) => "refused",
            };
            let c = &row.cost.counts;
            let mut cells = vec![
                row.method.clone(),
                format!("{:e}", row.request),
                status.into(),
            ];
            cells.extend([
                number(error.map(|e| e.rms)),
                number(error.map(|e| e.largest)),
            ]);
            cells.push(error.map_or("", |e| self.channel(e.worst)).to_string());
            let seconds = [row.cost.set_up, row.cost.solve, row.cost.write];
            cells.extend(seconds.map(|s| format!("{s:e}")));
            cells.extend(counted(c).map(|(_, n)| n.to_string()));
            let parts = row
                .cost
                .profile
                .map(|p| p.parts().map(|(_, s)| format!("{s:e}")));
            cells.extend(parts.unwrap_or_default());
            cells.push(row.reason());
            let _ = writer.write_record(cells);
        }
        let bytes = writer.into_inner().unwrap_or_default();
        String::from_utf8_lossy(&bytes).into_owned()
    }

    /// Returns the study as a JSON value. `wanted`: errors for which a run is recommended.
    pub fn json(&self, wanted: &[f64]) -> Value {
        let reference = match &self.reference {
            None => Value::Null,
            Some(Reference::Trusted) => json!({ "kind": "trusted" }),
            Some(Reference::Run { best, other }) => json!({
                "kind": "run",
                "method": best.0,
                "request": best.1,
                "confirmed_by": other.as_ref().map(|((method, request), difference)| json!({
                    "method": method, "request": request, "difference": difference,
                })),
            }),
        };
        let left_out = self.left_out.iter().map(|left| {
            json!({ "method": left.method, "requests": left.requests, "reason": left.why.to_string() })
        });
        let asked = wanted.iter().filter(|_| self.is_integrated);
        let recommended = asked.map(|&wanted| {
            let row = self.recommended(wanted);
            let chosen = row.map(|row| json!({ "method": row.method, "request": row.request }));
            json!({ "error": wanted, "run": chosen })
        });
        json!({
            "model": self.name,
            "title": self.title,
            "channels": self.channels,
            "reference": reference,
            "runs": self.rows.iter().map(|row| self.row_json(row)).collect::<Vec<_>>(),
            "left_out": left_out.collect::<Vec<_>>(),
            "recommended": recommended.collect::<Vec<_>>(),
            "processor_seconds": self.seconds,
            "interrupted": self.interrupted,
            "integrated": self.is_integrated,
            "versions": { "cognate": env!("CARGO_PKG_VERSION"), "report": 1 },
        })
    }

    fn row_json(&self, row: &Row) -> Value {
        let cost = &row.cost;
        let mut value = json!({
            "method": row.method,
            "request": row.request,
            "status": match &row.outcome {
                Outcome::Done(_) => "completed",
                Outcome::Ended(status, _) => status.word(),
                Outcome::Refused(_) => "refused",
            },
            "reason": row.reason(),
            "set_up_seconds": cost.set_up,
            "solve_seconds": cost.solve,
            "write_seconds": cost.write,
        });
        if let Some(value) = value.as_object_mut() {
            for (name, n) in counted(&cost.counts) {
                value.insert(name.into(), n.into());
            }
            if let Some(error) = row.error() {
                value.insert("error_rms".into(), json!(error.rms));
                value.insert("error_max".into(), json!(error.largest));
                value.insert("worst_channel".into(), self.channel(error.worst).into());
                value.insert("below_trust".into(), (!self.is_told(error.largest)).into());
            }
            if let Some(profile) = cost.profile {
                let parts = profile
                    .parts()
                    .map(|(name, s)| (name.to_string(), json!(s)));
                value.insert("solving".into(), Value::Object(parts.into_iter().collect()));
            }
        }
        value
    }
}

/// Returns counts with their names in files.
fn counted(c: &Counts) -> [(&'static str, u64); 5] {
    [
        ("steps", c.steps),
        ("rejected_steps", c.rejected_steps),
        ("evaluations", c.evaluations),
        ("jacobians", c.jacobians),
        ("factorizations", c.factorizations),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::{Cost, Error, LeftOut, Profile, Reason};
    use super::*;
    use crate::results::Status;

    fn study() -> Study {
        let row = |method: &str, request: f64, outcome, solve| Row {
            method: method.into(),
            request,
            outcome,
            cost: Cost {
                solve,
                profile: Some(Profile::default()),
                ..Cost::default()
            },
        };
        let error = |largest| {
            let rms = largest / 2.0;
            Outcome::Done(Error {
                rms,
                largest,
                worst: 1,
            })
        };
        Study {
            name: "crank".into(),
            title: "A <crank> & rod".into(),
            channels: vec!["DX(1,2)".into(), "VX(1,2), m".into()],
            reference: Some(Reference::Run {
                best: ("DOP853".into(), 1e-9),
                other: Some((("RADAU5".into(), 1e-9), 1e-8)),
            }),
            rows: vec![
                row("DOP853", 1e-3, error(1e-2), 1e-3),
                row("DOP853", 1e-9, error(0.0), 1e-1),
                row("RADAU5", 1e-3, error(1e-4), 2e-3),
                row(
                    "RADAU5",
                    1e-3,
                    Outcome::Ended(Status::Stopped, "it, \"failed\"".into()),
                    0.0,
                ),
                row(
                    "RADAU5",
                    1e-4,
                    Outcome::Ended(Status::Stopped, "stopped at time 1: why".into()),
                    0.0,
                ),
                row(
                    "AUTO",
                    1e-3,
                    Outcome::Refused("no <such> thing".into()),
                    0.0,
                ),
            ],
            left_out: vec![LeftOut {
                method: "RADAU5".into(),
                requests: vec![1e-6],
                why: Reason::Budget {
                    to: 1e-6,
                    expected: 3.0,
                },
            }],
            seconds: 1.0,
            interrupted: false,
            is_integrated: true,
        }
    }

    #[test]
    fn every_run_is_a_row_in_all_formats_and_failures_say_why() {
        let study = study();
        let text = study.text(&[1e-3, 1e-9]);
        for part in [
            "≤ ref.",
            "stopped: it, \"failed\"",
            "  stopped at time 1: why",
            "refused: no",
            "left out: RADAU5 at 1e-6",
        ] {
            assert!(text.contains(part), "{part}:\n{text}");
        }
        assert!(
            text.contains("for an error of 1e-3: --method RADAU5 --error 1e-3"),
            "{text}"
        );
        assert!(text.contains("for an error of 1e-9: no run"), "{text}");
        let mut reader = csv::Reader::from_reader(study.csv().into_bytes().leak() as &[u8]);
        let width = reader.headers().expect("names").len();
        let rows: Vec<_> = reader.records().map(|r| r.expect("a row")).collect();
        assert_eq!(rows.len(), 6);
        assert!(rows.iter().all(|r| r.len() == width));
        let json = study.json(&[1e-3]);
        assert_eq!(json["runs"].as_array().map(Vec::len), Some(6));
        assert_eq!(json["runs"][1]["below_trust"], true);
        assert_eq!(json["recommended"][0]["run"]["method"], "RADAU5");
    }

    #[test]
    fn a_page_is_whole_and_asks_the_network_for_nothing() {
        let page = super::super::page("Error <against> time", "", &[study()], &[1e-3]);
        assert!(page.starts_with("<!DOCTYPE html>") && page.trim_end().ends_with("</html>"));
        for part in [
            "A &lt;crank&gt; &amp; rod",
            "no &lt;such&gt; thing",
            "<svg",
            "RADAU5",
        ] {
            assert!(page.contains(part), "{part}");
        }
        for part in ["http-equiv", "src=", "@import", "<script", "<link", "url("] {
            assert!(!page.contains(part), "{part}");
        }
        let opened = |tag: &str| page.matches(&format!("<{tag}")).count();
        for tag in ["svg", "table", "details", "section", "text "] {
            let closed = page.matches(&format!("</{}>", tag.trim())).count();
            assert_eq!(opened(tag), closed, "{tag}");
        }
    }

    #[test]
    fn durations_have_three_digits() {
        assert_eq!(
            [3e-6, 1.25e-3, 0.5, 12.34, 300.0].map(duration),
            ["3.00 µs", "1.25 ms", "500 ms", "12.3 s", "5.00 min"]
        );
    }
}
