//! The summary at the end of `cognate run`: a short table, the facts of the run and its files, and
//! a picture of the results.

use crate::report::{Plot, svg::panels};
use crate::results::{Run, Warning};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Rows of the table; results can have thousands.
const ROWS: usize = 9;
/// Columns of the table; results can have thousands.
const COLUMNS: usize = 7;
/// Width of a column, in characters.
const WIDTH: usize = 13;

/// Prints a few rows of the table, from the first to the last at equal distances.
pub fn table(run: &Run) -> String {
    let columns: Vec<usize> = run
        .table_columns()
        .into_iter()
        .filter(|&c| c < run.columns.len())
        .collect();
    let rows: Vec<usize> = run.table_rows().collect();
    let shown: Vec<usize> = match rows.len() {
        n if n <= ROWS => rows,
        n => (0..ROWS).map(|k| rows[k * (n - 1) / (ROWS - 1)]).collect(),
    };
    if shown.is_empty() || columns.len() < 2 {
        return String::new();
    }
    let more = columns.len().saturating_sub(COLUMNS);
    let columns = &columns[..columns.len().min(COLUMNS)];
    let line = |cell: &dyn Fn(usize) -> String| {
        columns
            .iter()
            .map(|&c| format!("{:>WIDTH$}", cell(c)))
            .collect::<Vec<_>>()
            .join(" ")
            + "\n"
    };
    let mut text = line(&|c| shortened(&run.columns[c].name));
    if columns.iter().any(|&c| !run.columns[c].unit.is_empty()) {
        text += &line(&|c| shortened(&run.columns[c].unit));
    }
    for row in shown {
        text += &line(&|c| number(run.columns[c].values[row]));
    }
    if more > 0 {
        let columns = if more == 1 { "column" } else { "columns" };
        text += &format!("… and {more} more {columns}\n");
    }
    text
}

/// Cuts a name to the width of a column.
fn shortened(name: &str) -> String {
    if name.chars().count() <= WIDTH {
        name.to_owned()
    } else {
        name.chars().take(WIDTH - 1).chain(['…']).collect()
    }
}

/// Prints a number with six digits; the files have all of them.
fn number(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        "0".into()
    } else if (1e-4..1e6).contains(&size) {
        let decimals = 5 - size.log10().floor() as i32;
        format!("{x:.*}", usize::try_from(decimals).unwrap_or(0))
    } else {
        format!("{x:.5e}")
    }
}

/// Prints the facts of a run, and the files that were written.
pub fn facts(run: &Run, written: &[PathBuf]) -> String {
    let r = &run.record;
    let mut text = format!(
        "{}: {} rows, {} steps",
        r.status.word(),
        run.table_rows().count(),
        r.counts.steps
    );
    if !r.method.is_empty() {
        text += &format!(" of {}", r.method);
    }
    text += &format!(", {:.3} ms\n", 1e3 * r.solve_seconds);
    if !r.stop_reason.is_empty() {
        text += &format!("{}\n", r.stop_reason);
    }
    for simulation in r.simulations.iter().filter(|s| !s.worst.is_empty()) {
        text += &format!(
            "worst at the end of {} at time {}: {}\n",
            simulation.kind.name(),
            simulation.end,
            simulation.worst.join(", ")
        );
    }
    for line in warnings(&r.warnings) {
        text += &format!("warning: {line}\n");
    }
    if run.table_columns().len() <= 1 {
        text += "the model has no REQUEST: --column EXPR adds a column to the table\n";
    }
    for file in written {
        text += &format!("{}\n", file.display());
    }
    text
}

/// Number of warnings of one kind that are shown.
const ALIKE: usize = 3;

/// Selects the warnings to show, a few of each kind; the record has all of them.
fn warnings(all: &[Warning]) -> Vec<String> {
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    let few = |w: &&Warning| {
        let count = seen.entry(w.code).or_default();
        *count += 1;
        *count <= ALIKE
    };
    let shown = all.iter().filter(few).map(Warning::named);
    let mut shown: Vec<String> = shown.collect();
    let hidden = all.len() - shown.len();
    if hidden > 0 {
        shown.push(format!("{hidden} more like these are in the record"));
    }
    shown
}

/// Rows of an overview, at most.
const MOST_OF_OVERVIEW: usize = 8192;

/// Rows at equal distances of a run that has released some, so that it can be shown.
#[derive(Debug, Default)]
pub struct Overview {
    rows: Run,
    /// distance of its rows, a power of two; 0: it has none yet
    stride: usize,
    /// rows of the run that it has seen
    seen: usize,
}

impl Overview {
    /// Takes a part of the rows that a run holds and that are new.
    pub fn take(&mut self, run: &Run) {
        if self.stride == 0 {
            self.stride = 1;
            self.rows = Run {
                columns: run
                    .columns
                    .iter()
                    .map(crate::results::Column::empty)
                    .collect(),
                ..Run::new(&run.name, &run.title, run.units.clone())
            };
            self.rows.table.clone_from(&run.table);
        }
        for row in self.seen.max(run.released)..run.rows() {
            if !row.is_multiple_of(self.stride) {
                continue;
            }
            let place = row - run.released;
            let values: Vec<f64> = run.columns.iter().map(|c| c.values[place]).collect();
            self.rows.push(&values);
            if self.rows.rows() >= MOST_OF_OVERVIEW {
                self.rows.keep_every_second();
                self.stride *= 2;
            }
        }
        self.seen = run.rows();
    }

    /// Returns the run if it holds all its rows, else its overview up to the last row.
    pub fn of<'a>(&'a mut self, run: &'a Run) -> &'a Run {
        if run.released == 0 {
            return run;
        }
        self.take(run);
        &self.rows
    }
}

/// Most panels of the picture.
const PANELS: usize = 12;

/// Draws the table over time as SVG, a panel per unit, if it has a finite value.
pub fn picture(run: &Run) -> Option<String> {
    panels(&Plot::by_unit(run, PANELS)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Kind, Units};

    #[test]
    fn the_table_has_the_first_and_the_last_row_and_fits() {
        let mut run = Run::new("r", "t", Units::default());
        run.add_column("a rather long expression", "mm");
        run.begin(Kind::Dynamic);
        (0..=1000).for_each(|k| run.push(&[f64::from(k) * 1e-3, -1e-7 * f64::from(k)]));
        run.end();
        let text = table(&run);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 2 + ROWS);
        assert!(lines[0].ends_with("a rather lon…") && lines[1].ends_with("mm"));
        assert!(
            lines[2].trim_start().starts_with('0')
                && lines[10].trim_start().starts_with("1.00000")
                && lines[10].ends_with("-1.00000e-4"),
            "{text}"
        );
        assert_eq!(table(&Run::new("r", "t", Units::default())), "");
    }

    #[test]
    fn of_each_kind_of_warning_three_are_shown() {
        let warning = |code, element: String, what: &str| Warning {
            code,
            sentence: format!("{element}: {what}"),
            element: Some(element),
            name: None,
        };
        let left_out = |k| warning("skipped", format!("CONTACT/{k}"), "is left out");
        let mut all: Vec<Warning> = (0..50).map(left_out).collect();
        all.push(warning("misaligned", "JOINT/3".into(), "is off by 0.1 deg"));
        let shown = warnings(&all);
        assert_eq!(shown.len(), 5, "{shown:?}");
        assert!(shown[3].starts_with("JOINT/3"));
        assert_eq!(shown[4], "47 more like these are in the record");
        assert_eq!(warnings(&all[..3]).len(), 3);
    }

    #[test]
    fn numbers_have_six_digits() {
        assert_eq!(
            [3.25, 199.99999, 1e6, 1e-5, 0.0, 123456.7].map(number),
            [
                "3.25000",
                "200.000",
                "1.00000e6",
                "1.00000e-5",
                "0",
                "123457"
            ]
        );
    }
}
