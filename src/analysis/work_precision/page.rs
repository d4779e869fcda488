//! Studies as one HTML page that needs nothing else: curves, facts and tables.

use super::chart::{COLOURS, Chart, Curve};
use super::write::duration;
use super::{Reference, Row, Study};
use crate::diagnostic::counted;
use crate::numeric::METHODS;
use quick_xml::escape::escape;
use std::fmt::Write as _;

const STYLE: &str = "\
body{font:15px/1.5 system-ui,sans-serif;color:#26262c;background:#fff;max-width:1180px;margin:2em auto;padding:0 1em}
h1{font-size:1.7em;margin-bottom:.2em}h2{font-size:1.25em;margin:2.2em 0 .2em;border-top:1px solid #e2e2e6;padding-top:1em}
p{margin:.3em 0}.faint{color:#6e6e78}svg text{font:11.5px system-ui,sans-serif;fill:#26262c}
.charts{display:flex;flex-wrap:wrap;gap:12px}.charts svg{max-width:100%;height:auto}
table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:13px;margin:.6em 0}
th,td{padding:2px 9px;text-align:right;border-bottom:1px solid #eeeef1;white-space:nowrap}
th{font-weight:600}td.l,th.l{text-align:left}td.why{text-align:left;white-space:normal;color:#8a1c1c;max-width:38em}
.legend span{display:inline-block;margin-right:1.1em}.legend i{display:inline-block;width:14px;height:4px;margin-right:5px;vertical-align:middle}
details{margin:.5em 0}summary{cursor:pointer;color:#005ea2}";

/// Returns the colour of a method: the same on all pages.
pub(super) fn colour(method: &str) -> &'static str {
    let place = METHODS.iter().position(|m| m.name == method);
    COLOURS[place.map_or(0, |k| 1 + k) % COLOURS.len()]
}

/// Writes studies as one page. `about`: HTML below the title, empty for none; `wanted`: errors for
/// which a run is recommended.
pub fn page(title: &str, about: &str, studies: &[Study], wanted: &[f64]) -> String {
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>{0}</title>\n<style>\n{STYLE}\n</style>\n</head>\n<body>\n<h1>{0}</h1>\n{about}\n",
        escape(title)
    );
    for study in studies {
        section(&mut page, study, wanted);
    }
    page += "</body>\n</html>\n";
    page
}

/// Writes a study: facts, curves, tables.
fn section(page: &mut String, study: &Study, wanted: &[f64]) {
    let _ = writeln!(
        page,
        "<section>\n<h2>{}</h2>\n<p class=\"faint\">{}</p>\n<p>{}.</p>",
        escape(&study.name),
        escape(&study.title),
        escape(study.about_reference())
    );
    if study.interrupted {
        *page += "<p>The study was interrupted: not all runs were made.</p>\n";
    }
    if !study.is_integrated {
        runs(page, study);
        *page += "</section>\n";
        return;
    }
    let methods = methods(study);
    *page += "<p class=\"legend\">";
    for method in &methods {
        let _ = write!(
            page,
            "<span><i style=\"background:{}\"></i>{}</span>",
            colour(method),
            escape(*method)
        );
    }
    *page += "</p>\n<div class=\"charts\">\n";
    for chart in charts(study, &methods) {
        *page += &chart.svg(&colour);
    }
    *page += "</div>\n";
    recommendations(page, study, wanted);
    *page += "<details><summary>all runs</summary>\n";
    runs(page, study);
    *page += "</details>\n";
    if study.rows.iter().any(|r| r.cost.profile.is_some()) {
        *page += "<details><summary>where solving spends its time</summary>\n";
        profiles(page, study);
        *page += "</details>\n";
    }
    *page += "</section>\n";
}

/// Returns the methods of a study, in the order of its runs.
pub(super) fn methods(study: &Study) -> Vec<&str> {
    let mut methods: Vec<&str> = study.rows.iter().map(|r| r.method.as_str()).collect();
    methods.dedup();
    methods
}

/// Returns the charts of a study: time over error, error over request.
pub(super) fn charts(study: &Study, methods: &[&str]) -> [Chart; 2] {
    let trust = study.reference.as_ref().map_or(0.0, Reference::trust);
    let curve = |method: &str, point: &dyn Fn(&Row, f64) -> (f64, f64)| {
        let rows = study.rows.iter().filter(|r| r.method == method);
        let points = rows.filter_map(|row| {
            let error = row.error()?.largest;
            if error == 0.0 || !study.is_told(error) {
                return None;
            }
            let (x, y) = point(row, error);
            let what = format!(
                "{method} at {:.0e}: error {error:.1e} in {}, {}",
                row.request,
                duration(row.cost.solve),
                counted(row.cost.counts.steps, "step")
            );
            Some((x, y, what))
        });
        Curve {
            name: method.to_string(),
            points: points.collect(),
        }
    };
    let by = |point: &dyn Fn(&Row, f64) -> (f64, f64)| -> Vec<Curve> {
        methods.iter().map(|method| curve(method, point)).collect()
    };
    [
        Chart {
            x: "largest error, over the swing of its channel".into(),
            y: "processor time of solving, s".into(),
            curves: by(&|row, error| (error, row.cost.solve)),
            shade_below: (trust > 0.0).then_some(trust),
            diagonal: false,
        },
        Chart {
            x: "requested error".into(),
            y: "largest error".into(),
            curves: by(&|row, error| (row.request, error)),
            shade_below: None,
            diagonal: true,
        },
    ]
}

fn recommendations(page: &mut String, study: &Study, wanted: &[f64]) {
    let found = wanted
        .iter()
        .filter_map(|&w| Some((w, study.recommended(w)?)));
    let found: Vec<(f64, &Row)> = found.collect();
    if found.is_empty() {
        return;
    }
    *page += "<table><tr><th>wanted error</th><th class=\"l\">cheapest run</th><th>error</th><th>set-up</th><th>solving</th></tr>\n";
    for (wanted, row) in found {
        let error = row.error().unwrap_or_default().largest;
        let _ = writeln!(
            page,
            "<tr><td>{wanted:.0e}</td><td class=\"l\">--method {} --error {:.0e}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            escape(&row.method),
            row.request,
            shown(study, error),
            duration(row.cost.set_up),
            duration(row.cost.solve)
        );
    }
    *page += "</table>\n";
}

/// Prints an error as far as the reference can tell it.
fn shown(study: &Study, error: f64) -> String {
    if study.is_told(error) {
        format!("{error:.1e}")
    } else {
        "≤ ref.".into()
    }
}

/// Writes the table of all runs, and what was left out.
fn runs(page: &mut String, study: &Study) {
    *page += "<table><tr><th class=\"l\">method</th><th>request</th><th>RMS error</th><th>largest</th><th class=\"l\">in</th>\
              <th>set-up</th><th>solving</th><th>writing</th><th>steps</th><th>rejected</th><th>evaluations</th><th>Jacobians</th><th>factorizations</th></tr>\n";
    for row in &study.rows {
        let (cost, c) = (&row.cost, &row.cost.counts);
        let _ = write!(
            page,
            "<tr><td class=\"l\">{}</td><td>{:.0e}</td>",
            escape(&row.method),
            row.request
        );
        match row.error() {
            Some(e) => {
                let _ = write!(
                    page,
                    "<td>{}</td><td>{}</td><td class=\"l\">{}</td>",
                    shown(study, e.rms),
                    shown(study, e.largest),
                    escape(study.channel(e.worst))
                );
            }
            None => {
                let _ = write!(
                    page,
                    "<td class=\"why\" colspan=\"3\">{}</td>",
                    escape(row.reason())
                );
            }
        }
        let _ = writeln!(
            page,
            "<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            duration(cost.set_up),
            duration(cost.solve),
            duration(cost.write),
            c.steps,
            c.rejected_steps,
            c.evaluations,
            c.jacobians,
            c.factorizations
        );
    }
    *page += "</table>\n";
    for left in &study.left_out {
        let requests: Vec<String> = left.requests.iter().map(|r| format!("{r:.0e}")).collect();
        let _ = writeln!(
            page,
            "<p class=\"faint\">Left out: {} at {}: {}.</p>",
            escape(&left.method),
            requests.join(", "),
            left.why
        );
    }
}

/// Writes where solving spent its time, in parts of a hundred.
fn profiles(page: &mut String, study: &Study) {
    let names = super::Profile::default().parts().map(|(name, _)| name);
    *page += "<table><tr><th class=\"l\">method</th><th>request</th><th>solving</th>";
    for name in names {
        let _ = write!(page, "<th>{name}, %</th>");
    }
    *page += "</tr>\n";
    for row in &study.rows {
        let Some(profile) = row.cost.profile else {
            continue;
        };
        let _ = write!(
            page,
            "<tr><td class=\"l\">{}</td><td>{:.0e}</td><td>{}</td>",
            escape(&row.method),
            row.request,
            duration(row.cost.solve)
        );
        let whole: f64 = profile.parts().iter().map(|(_, s)| s).sum();
        for (_, seconds) in profile.parts() {
            let percent = 100.0 * seconds / whole.max(f64::MIN_POSITIVE);
            let _ = write!(page, "<td>{percent:.0}</td>");
        }
        *page += "</tr>\n";
    }
    *page += "</table>\n<p class=\"faint\">Sweeps: positions and velocities of all parts; language: functions and laws of forces; contact: solids that touch; \
              accelerations: masses, rows, their elimination; derivatives: Jacobians; steps: the rest, with matrices and sums of the method, projection, events and outputs. \
              Counted and timed at the end of the run, not clocked within it.</p>\n";
}
