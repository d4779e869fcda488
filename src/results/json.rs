//! The run record and tables as JSON: the same facts as the log, for programs.
//!
//! Numbers that are not finite become `null`, as JSON has no word for them.

use super::format::TableText;
use super::number::push_digits;
use super::output_folder::OutputFolder;
use super::{
    Accuracy, ChannelAccuracy, Column, Counts, Energy, Jump, Kind, Loads, RankChange, Record, Run,
    Seconds, Sequence, Simulation, Units, malformed, no_row,
};
use crate::diagnostic::{Diagnostic, Severity};
use crate::model::ElementKind;
use serde_json::{Map, Value, json};
use std::ops::Range;

/// Writes the record of a run: status, counts, timings, and one entry per simulation.
pub fn record(run: &Run) -> Value {
    let r = &run.record;
    let mut record = json!({
        "status": r.status.word(),
        "stop_code": r.stop_code,
        "stop_reason": r.stop_reason,
        "exit_code": r.status.exit_code(),
        "model": r.model,
        "markers": r.markers,
        "loads": r.loads.as_ref().map(loads),
        "inputs": r.inputs.as_ref().map(|t| json!({ "file": t.file, "held": t.held })),
        "title": run.title,
        "method": r.method,
        "error": r.error,
        "solve_seconds": r.seconds.solve,
        "read_seconds": r.seconds.read + r.seconds.parse,
        "write_seconds": r.seconds.write,
        "seconds": seconds(&r.seconds),
        "repeats": r.repeats,
        "freedom": r.freedom,
        "redundant_rows": r.redundant.len(),
        "redundant": r.redundant,
        "reactions": if r.redundant.is_empty() { "unique" } else { "smallest set: rows depend on each other" },
        "rank_changes": r.rank_changes.iter().map(rank_change).collect::<Vec<_>>(),
        "energy": energy(&r.energy, &run.units),
        "energy_drift": r.energy.error(),
        "accuracy": r.accuracy.as_ref().map(accuracy),
        "limited_steps": limited(&r.counts),
        "constraint_drift": r.constraint_drift,
        "outputs": run.table_rows().count(),
        "warnings": r.warned(),
        "findings": findings(&told(r)),
        "piecewise": r.piecewise.iter().map(jump).collect::<Vec<_>>(),
        "versions": { "cognate": env!("CARGO_PKG_VERSION"), "record": 1 },
        "files": Map::new(),
        "simulations": r.simulations.iter().map(simulation).collect::<Vec<_>>(),
    });
    if let Some(record) = record.as_object_mut() {
        add_counts(record, &r.counts);
    }
    record
}

/// Returns the diagnostics as JSON: an array of objects with the same facts.
pub fn findings(diagnostics: &[Diagnostic]) -> Value {
    let one = |d: &Diagnostic| {
        let severity = match d.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        json!({
            "code": d.code,
            "severity": severity,
            "message": d.message,
            "file": d.file,
            "line": d.line,
            "column": d.column,
            "start": d.span.map(|s| s.start),
            "end": d.span.map(|s| s.end),
            "element": d.element,
            "part": d.part,
            "name": d.name,
            "help": d.help,
            "marks": d.marks.iter().map(|(s, what)| json!({ "start": s.start, "end": s.end, "what": what })).collect::<Vec<_>>(),
        })
    };
    diagnostics.iter().map(one).collect()
}

/// Returns what is doubted in the files, and the warnings of the run.
fn told(r: &Record) -> Vec<Diagnostic> {
    let warned = r.warnings.iter().map(Diagnostic::from);
    r.doubts.iter().cloned().chain(warned).collect()
}

/// Adds to a record the names and sizes of the files that were written, and of those of the run
/// before that are kept.
pub fn with_files(mut record: Value, folder: &OutputFolder) -> Value {
    record["files"] = json!(folder.written());
    if !folder.kept_own().is_empty() {
        record["kept"] = json!(folder.kept_own());
    }
    record
}

fn seconds(s: &Seconds) -> Value {
    let named: Map<String, Value> = (s.named().into_iter())
        .map(|(name, seconds)| (name.to_owned(), json!(seconds)))
        .collect();
    Value::Object(named)
}

fn energy(e: &Energy, units: &Units) -> Value {
    json!({
        "unit": format!("{}-{}", units.force, units.length),
        "kinetic": { "start": e.kinetic[0], "end": e.kinetic[1] },
        "potential": { "start": e.potential[0], "end": e.potential[1] },
        "stored": e.stored,
        "by_motions": e.by_motions,
        "by_functions": e.by_functions,
        "dissipated": e.dissipated,
        "imbalance": e.imbalance,
        "error": e.error(),
    })
}

fn accuracy(a: &Accuracy) -> Value {
    let channel = |c: &ChannelAccuracy| {
        json!({
            "channel": c.channel,
            "unit": c.unit,
            "largest_bar": c.largest_bar,
            "relative": c.relative,
            "usual_bar": c.usual_bar,
            "digits": c.digits(),
            "least_digits": c.least_digits(),
            "lost_from": c.lost_from,
        })
    };
    json!({
        "sentence": a.sentence(),
        "companion_errors": a.companions,
        "digits": a.worst().map(ChannelAccuracy::digits),
        "worst": a.worst().map(channel),
        "channels": a.channels.iter().map(channel).collect::<Vec<_>>(),
    })
}

/// Writes the shares of the accepted steps that something else than the permitted error limited.
fn limited(c: &Counts) -> Value {
    let share = |n: u64| n as f64 / c.steps.max(1) as f64;
    json!({
        "by_stability": share(c.stability_limited),
        "by_events": share(c.event_limited),
        "by_outputs": share(c.output_limited),
    })
}

/// Writes the loads that were chosen for a run.
pub fn loads(l: &Loads) -> Value {
    json!({ "chosen": l.chosen, "acting": l.acting, "left_out": l.left_out })
}

fn jump(j: &Jump) -> Value {
    let motion = ElementKind::Motion.id(j.motion).to_string();
    json!({ "element": motion, "time": j.at, "of": j.of.word(), "by": j.by })
}

fn rank_change(c: &RankChange) -> Value {
    let place: Map<String, Value> = (c.place.iter())
        .map(|(name, x)| (name.clone(), json!(x)))
        .collect();
    json!({ "time": c.time, "what": c.change.word(), "rows": c.rows, "place": place })
}

fn simulation(s: &Simulation) -> Value {
    let mut value = json!({
        "kind": s.kind.name(),
        "status": s.status.word(),
        "stop_code": s.stop_code,
        "stop_reason": s.stop_reason,
        "start": s.start,
        "end": s.end,
        "outputs": s.outputs,
        "method": s.method,
        "solve_seconds": s.solve_seconds,
        "worst": s.worst,
    });
    if let Some(value) = value.as_object_mut() {
        add_counts(value, &s.counts);
    }
    value
}

fn add_counts(to: &mut Map<String, Value>, c: &Counts) {
    to.insert("steps".into(), c.steps.into());
    to.insert("rejected_steps".into(), c.rejected_steps.into());
    to.insert("evaluations".into(), c.evaluations.into());
    to.insert("jacobians".into(), c.jacobians.into());
    to.insert("factorizations".into(), c.factorizations.into());
}

/// Writes the table of a run, column by column: `{"columns": [{"name", "unit", "values"}]}`.
pub fn table(run: &Run) -> Value {
    let rows: Vec<usize> = run.table_rows().collect();
    let columns = run
        .table_columns()
        .into_iter()
        .filter_map(|i| run.columns.get(i))
        .map(|c| {
            let values: Vec<f64> = rows.iter().map(|&row| c.at(row)).collect();
            match c.bar_of.and_then(|of| run.columns.get(of)) {
                Some(of) => {
                    json!({ "name": c.name, "unit": c.unit, "bar_of": of.name, "values": values })
                }
                None => json!({ "name": c.name, "unit": c.unit, "values": values }),
            }
        });
    json!({ "name": run.name, "title": run.title, "columns": columns.collect::<Vec<_>>() })
}

/// A document that is being written: names and units of the columns, a line for each row, and which
/// rows belong to which simulation.
///
/// ```text
/// {
/// "name": "run", "title": "",
/// "columns": [
/// {"name": "time", "unit": "sec"},
/// {"name": "x", "unit": "mm"}
/// ],
/// "rows": [
/// [0,1.5],
/// [0.1,null]
/// ],
/// "sequences": [{"first_row": 0, "kind": "dynamic", "name": "dynamic_001", "rows": 2}]
/// }
/// ```
#[derive(Debug, Default)]
pub struct Rows {
    has_rows: bool,
}

/// The line that the rows of a document begin after.
const ROWS: &str = "\"rows\": [\n";

impl TableText for Rows {
    fn begin(&mut self, run: &Run, text: &mut Vec<u8>) {
        let columns = run.table_columns().into_iter();
        let columns: Vec<String> = columns
            .filter_map(|i| run.columns.get(i))
            .map(|c| match c.bar_of.and_then(|of| run.columns.get(of)) {
                Some(of) => json!({ "name": c.name, "unit": c.unit, "bar_of": of.name }),
                None => json!({ "name": c.name, "unit": c.unit }),
            })
            .map(|head| head.to_string())
            .collect();
        let (name, title) = (json!(run.name), json!(run.title));
        let columns = columns.join(",\n");
        let head = format!(
            "{{\n\"name\": {name}, \"title\": {title},\n\"columns\": [\n{columns}\n],\n{ROWS}"
        );
        text.extend_from_slice(head.as_bytes());
    }

    fn rows(&mut self, run: &Run, rows: Range<usize>, text: &mut Vec<u8>) {
        let columns = run.table_columns().into_iter();
        let columns: Vec<&Column> = columns.filter_map(|i| run.columns.get(i)).collect();
        for place in run.table_places(rows) {
            // the line of the row before ends here, where it is known that another follows
            if std::mem::replace(&mut self.has_rows, true) {
                text.extend_from_slice(b",\n");
            }
            text.push(b'[');
            for (i, column) in columns.iter().enumerate() {
                if i > 0 {
                    text.push(b',');
                }
                match column.at(place) {
                    x if x.is_finite() => push_digits(x, text),
                    _ => text.extend_from_slice(b"null"),
                }
            }
            text.push(b']');
        }
    }

    fn end(&mut self, run: &Run, text: &mut Vec<u8>) {
        let sequences: Value = (run.sequences.iter())
            .map(|s| json!({ "name": s.name, "kind": s.kind.name(), "first_row": s.rows.start, "rows": s.rows.len() }))
            .collect();
        let line = if self.has_rows { "\n" } else { "" };
        let end = format!("{line}],\n\"sequences\": {sequences}\n}}\n");
        text.extend_from_slice(end.as_bytes());
    }
}

/// Returns a document whose rows end with the last whole one; `None`: it is not cut off within or
/// behind its rows.
fn mended(text: &str) -> Option<String> {
    let begin = text.find(ROWS)? + ROWS.len();
    let (head, rows) = text.split_at(begin);
    // a row is whole with its bracket: numbers have none
    let rows = rows.find("\n]").map_or(rows, |end| &rows[..end]);
    let end = rows.rfind(']').map_or(0, |end| end + 1);
    Some(format!("{head}{}]}}", &rows[..end]))
}

/// Reads the table of a document that [`Rows`] has written, or of one whose columns hold their
/// values; of one that is cut off within its rows the whole ones.
///
/// # Errors
/// When it is no such document, or its columns differ in length.
pub fn read(bytes: &[u8]) -> Result<Run, Diagnostic> {
    let no_json = |e: &serde_json::Error| malformed(e.line(), format!("this is no JSON: {e}"));
    let (value, is_cut) = match serde_json::from_slice::<Value>(bytes) {
        Ok(value) => (value, false),
        Err(e) if e.is_eof() => {
            let text = String::from_utf8_lossy(bytes);
            let whole = mended(&text).and_then(|text| serde_json::from_str(&text).ok());
            (whole.ok_or_else(|| no_row(no_json(&e), 0))?, true)
        }
        Err(e) => return Err(no_json(&e)),
    };
    let Some(columns) = value["columns"].as_array() else {
        let what = "there is no \"columns\"; the record of a run has no table";
        return Err(malformed(0, what)
            .help("its .csv or .res has, and `cognate convert run.res run.json` makes one"));
    };
    let mut run = Run {
        name: value["name"].as_str().unwrap_or_default().to_owned(),
        title: value["title"].as_str().unwrap_or_default().to_owned(),
        ..Run::default()
    };
    let by_rows = value["rows"].as_array();
    run.columns = (columns.iter().enumerate())
        .map(|(k, c)| {
            column(c, by_rows.is_some())
                .ok_or_else(|| malformed(0, format!("column {} is no list of numbers", k + 1)))
        })
        .collect::<Result<_, _>>()?;
    for (k, row) in by_rows.into_iter().flatten().enumerate() {
        let numbers = numbers(row).filter(|row| row.len() == run.columns.len());
        let what = || format!("row {} is no list of a number for each column", k + 1);
        let numbers = numbers.ok_or_else(|| malformed(0, what()))?;
        for (column, x) in run.columns.iter_mut().zip(numbers) {
            column.values.push(x);
        }
    }
    let rows = run.rows();
    if run.columns.iter().any(|c| c.values.len() != rows) {
        return Err(malformed(0, "the columns differ in length"));
    }
    let (kind, rows) = (Kind::Dynamic, 0..rows);
    let name = format!("{}_001", kind.name());
    run.sequences.push(Sequence { name, kind, rows });
    if is_cut {
        run.note_cut();
    }
    Ok(run)
}

/// Reads a list of numbers; `null` is a value that is not finite.
fn numbers(value: &Value) -> Option<Vec<f64>> {
    let number = |x: &Value| x.as_f64().or_else(|| x.is_null().then_some(f64::NAN));
    value.as_array()?.iter().map(number).collect()
}

/// Reads a column, whose values may stand in rows.
fn column(value: &Value, by_rows: bool) -> Option<Column> {
    Some(Column {
        name: value["name"].as_str()?.to_owned(),
        unit: value["unit"].as_str().unwrap_or_default().to_owned(),
        values: match by_rows {
            true => Vec::new(),
            false => numbers(&value["values"])?,
        },
        bar_of: None,
    })
}

/// Writes a value as indented text with a line break at its end.
pub fn text(value: &Value) -> String {
    format!("{value:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Kind, Status, Units};

    #[test]
    fn the_record_has_every_promised_fact() {
        let mut run = Run::new("r", "t", Units::default());
        run.record.status = Status::Stopped;
        run.record.redundant = vec!["JOINT/2 Zi.Xj".into()];
        run.record.counts = Counts {
            steps: 7,
            ..Counts::default()
        };
        let record = record(&run);
        for key in "status stop_reason solve_seconds read_seconds write_seconds method steps rejected_steps evaluations \
                    jacobians factorizations freedom redundant_rows energy_drift constraint_drift versions simulations"
            .split_whitespace()
        {
            assert!(record.get(key).is_some(), "{key}");
        }
        assert_eq!(
            (
                &record["steps"],
                &record["redundant_rows"],
                &record["status"]
            ),
            (&json!(7), &json!(1), &json!("stopped"))
        );
    }

    #[test]
    fn a_table_is_read_back_and_a_record_is_refused() {
        let mut run = Run::new("r", "t", Units::default());
        run.add_column("x", "mm");
        run.begin(Kind::Dynamic);
        run.push(&[0.0, 0.1 + 0.2]);
        run.push(&[1.0, f64::NAN]);
        run.end();
        let document = crate::results::format::text(&mut Rows::default(), &run);
        let back = read(document.as_bytes()).unwrap();
        assert_eq!(
            (&back.columns[1].unit, back.columns[1].values[0]),
            (&"mm".to_owned(), 0.1 + 0.2)
        );
        assert!(back.columns[1].values[1].is_nan() && back.title == "t");
        let refused = read(text(&record(&run)).as_bytes()).unwrap_err();
        assert!(refused.message.contains("no table"));
    }

    #[test]
    fn numbers_that_are_not_finite_become_null() {
        let mut run = Run::new("r", "t", Units::default());
        run.add_column("x", "");
        run.begin(Kind::Dynamic);
        run.push(&[0.0, f64::INFINITY]);
        run.end();
        assert_eq!(table(&run)["columns"][1]["values"], json!([null]));
    }
}
