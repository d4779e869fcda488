//! The summary at the end of `cognate run`: a short table, the facts of the run and its files, and
//! a picture of the results.

use super::table::Table;
use cognate::diagnostic::counted;
use cognate::disk;
use cognate::internals::report::{Plot, svg::panels};
use cognate::internals::warning::OPEN_REACTION;
use cognate::results::{Accuracy, Kind, Run, Seconds, Warning, digits_of_six};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Rows of the table of one simulation: at every tenth of it. Results can have thousands.
const ROWS: usize = 11;
/// Rows of the table of several simulations, beside the first and the last of each.
const ROWS_OF_SEVERAL: usize = 9;
/// Most rows of which none is left out.
const MOST_ROWS: usize = 13;
/// Most simulations whose first and last rows are shown.
const SIMULATIONS: usize = 4;

/// Prints a few rows of the table, from the first to the last at equal distances, and as many of
/// its columns as fit into a width; says what is left out of `n_rows` in all, and who has it.
pub fn table(run: &Run, n_rows: usize, width: usize, who_has_all: &str) -> String {
    let mut columns = run.table_columns();
    columns.retain(|&c| c < run.columns.len());
    let rows: Vec<usize> = run.table_rows().collect();
    let shown = selected(run, &rows);
    if shown.is_empty() || columns.len() < 2 {
        return String::new();
    }
    let phases = phases(run, &rows);
    let mut cells: Vec<Vec<String>> = Vec::new();
    for &c in &columns {
        let column = &run.columns[c];
        let values: Vec<f64> = shown.iter().map(|&row| column.values[row]).collect();
        let written = match column.bar_of {
            Some(_) => values.iter().copied().map(bar).collect(),
            None => aligned(&values),
        };
        cells.push([vec![column.name.clone(), column.unit.clone()], written].concat());
        if c == columns[0] && phases.len() > 1 {
            let phase = |row: &usize| run.kind_of(*row).map_or("", Kind::name).to_owned();
            let head = vec!["phase".to_owned(), String::new()];
            cells.push([head, shown.iter().map(phase).collect()].concat());
        }
    }
    let line = |k: usize| {
        cells
            .iter()
            .map(|column| column[k].clone())
            .collect::<Vec<_>>()
    };
    let mut table = Table::new(line(0));
    if columns.iter().any(|&c| !run.columns[c].unit.is_empty()) {
        table.head(line(1));
    }
    (2..shown.len() + 2).for_each(|k| table.push(line(k)));
    let n = table.n_fitting(width);
    let hidden = cells.len() - n;
    let mut left_out = Vec::new();
    if shown.len() < n_rows {
        left_out.push(format!("{} of {}", shown.len(), counted(n_rows, "row")));
    }
    if hidden > 0 {
        left_out.push(format!(
            "{} of {}",
            columns.len() - hidden,
            counted(columns.len(), "column")
        ));
    }
    let mut text = table.first(n);
    if !left_out.is_empty() {
        text += &format!("… {}; {who_has_all}\n", left_out.join(", "));
    }
    text
}

/// Returns the kinds of simulation that rows belong to, in their order; assembly counts as part of
/// what follows it.
fn phases(run: &Run, rows: &[usize]) -> Vec<Kind> {
    let mut kinds: Vec<Kind> = Vec::new();
    for kind in rows.iter().filter_map(|&row| run.kind_of(row)) {
        if kind != Kind::InitialConditions && !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    kinds
}

/// Returns the rows that are shown: some at equal times, and where few simulations follow each
/// other the first and last of each.
fn selected(run: &Run, rows: &[usize]) -> Vec<usize> {
    let n = rows.len();
    if n <= MOST_ROWS {
        return rows.to_vec();
    }
    let sequences = run.sequences.iter().filter(|s| !s.rows.is_empty());
    let mut ends = Vec::new();
    let mut before = None;
    for sequence in sequences.filter(|s| s.kind != Kind::Input) {
        // what follows assembly begins with its row
        if before != Some(Kind::InitialConditions) {
            ends.push(sequence.rows.start);
        }
        ends.push(sequence.rows.end - 1);
        before = Some(sequence.kind);
    }
    let simulations = run.sequences.iter();
    let simulations =
        simulations.filter(|s| !matches!(s.kind, Kind::Input | Kind::InitialConditions));
    let last = match simulations.count() {
        0 | 1 => ROWS - 1,
        _ => ROWS_OF_SEVERAL - 1,
    };
    let mut shown = at_equal_times(run, rows, last);
    if ends.len() <= 2 * SIMULATIONS {
        shown.extend(ends.into_iter().filter(|row| rows.contains(row)));
    }
    shown.sort_unstable();
    shown.dedup();
    shown
}

/// Returns the rows at equal parts of the time from the first to the last, these two among them; of
/// rows that time does not tell apart, equal parts of their number.
fn at_equal_times(run: &Run, rows: &[usize], parts: usize) -> Vec<usize> {
    let n = rows.len();
    let time = |row: usize| run.columns.first().map_or(0.0, |time| time.values[row]);
    let (begin, span) = (time(rows[0]), time(rows[n - 1]) - time(rows[0]));
    let tiny = 1e-9 * span;
    let at = |k: usize| match k {
        0 => rows[0],
        _ if span > 0.0 => {
            let t = begin + span * k as f64 / parts as f64;
            let after = rows.partition_point(|&row| time(row) <= t + tiny);
            rows[after.saturating_sub(1)]
        }
        _ => rows[k * (n - 1) / parts],
    };
    (0..=parts).map(at).collect()
}

/// Prints the numbers of a column with as many decimals as its largest needs for six digits; the
/// files have all of them. Very large and very small columns have exponents.
fn aligned(values: &[f64]) -> Vec<String> {
    let finite = values.iter().filter(|x| x.is_finite());
    let largest = finite.fold(0.0_f64, |largest, x| largest.max(x.abs()));
    if largest != 0.0 && !(1e-3..1e6).contains(&largest) {
        return values.iter().map(|&x| digits_of_six(x)).collect();
    }
    let size = if largest == 0.0 {
        0
    } else {
        largest.log10().floor() as i32
    };
    let decimals = usize::try_from(5 - size).unwrap_or(0);
    let written: Vec<String> = values.iter().map(|x| format!("{x:.decimals$}")).collect();
    let needed = |text: &String| match text.split_once('.') {
        Some((_, decimals)) => decimals.trim_end_matches('0').len(),
        None => 0,
    };
    let needed = written.iter().map(needed).max().unwrap_or(0);
    let number = |x: &f64| {
        let text = format!("{x:.needed$}");
        match text.strip_prefix('-') {
            Some(size) if size.bytes().all(|b| matches!(b, b'0' | b'.')) => size.to_owned(),
            _ => text,
        }
    };
    values.iter().map(number).collect()
}

/// Prints a bar of error with the two digits that it has.
fn bar(x: f64) -> String {
    match x {
        0.0 => "0".into(),
        x if x.is_nan() => digits_of_six(x),
        x => format!("{x:.1e}"),
    }
}

/// Prints the facts of a run, and the files that were written.
pub fn facts(run: &Run, written: &[PathBuf]) -> String {
    let r = &run.record;
    let mut text = format!(
        "{}: {}, {}",
        r.status.word(),
        counted(run.table_rows().count(), "row"),
        counted(r.counts.steps, "step")
    );
    if !r.method.is_empty() {
        text += &format!(" of {}", r.method);
    }
    text += &format!(", solved in {}\n", times(&r.seconds));
    if !r.stop_reason.is_empty() {
        text += &format!("{}\n", r.stop_reason);
    }
    let said = r.accuracy.as_ref().map(Accuracy::sentence);
    if let Some(said) = said.filter(|said| !said.is_empty()) {
        text += &format!("{said}\n");
    }
    for simulation in r.simulations.iter().filter(|s| !s.worst.is_empty()) {
        text += &format!(
            "worst at the end of {} at time {}: {}\n",
            simulation.kind.name(),
            simulation.end,
            simulation.worst.join(", ")
        );
    }
    let is_read = r.warnings.iter().any(|w| w.code == OPEN_REACTION);
    text += &redundancy(&r.redundant, is_read);
    for line in warnings(&r.warnings) {
        text += &format!("warning: {line}\n");
    }
    if run.table_columns().len() <= 1 {
        text += "the model has no REQUEST: --column EXPR adds a column to the table\n";
    }
    for file in written {
        text += &format!("{}\n", disk::text(&file));
    }
    text
}

/// Tells which equations were left out, and what that means for reactions, and for the motion where
/// loads read one of those (`is_read`).
fn redundancy(redundant: &[String], is_read: bool) -> String {
    let same = if is_read {
        ""
    } else {
        "the motion is the same, but "
    };
    let Some(first) = redundant.first() else {
        return String::new();
    };
    let named: Vec<&str> = redundant.iter().take(ALIKE).map(String::as_str).collect();
    let more = match redundant.len() - named.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let what = match redundant.len() {
        1 => format!("{first} follows from other equations and is left out"),
        n => format!(
            "{} follow from others and are left out ({}{more})",
            counted(n, "equation"),
            named.join(", ")
        ),
    };
    format!(
        "redundant: {what}; {same}reactions of these joints are not unique, and the smallest are \
         given\n"
    )
}

/// Tells the time of solving, and how much the rest took: "1.200 ms of 30.1 ms (read 0.3, …)".
fn times(s: &Seconds) -> String {
    let phases = [
        ("read", s.read),
        ("set-up", s.set_up()),
        ("accuracy", s.accuracy),
        ("evaluate", s.evaluate),
        ("write", s.write),
    ];
    let phases = phases.iter().filter(|(_, seconds)| *seconds > 0.0);
    let phases: Vec<String> = phases
        .map(|(name, seconds)| format!("{name} {:.1}", 1e3 * seconds))
        .collect();
    format!(
        "{:.3} ms of {:.1} ms ({}; processor {:.1})",
        1e3 * s.solve,
        1e3 * s.total,
        phases.join(", "),
        1e3 * s.processor
    )
}

/// Number of warnings of one kind that are shown.
const ALIKE: usize = 3;

/// Selects the warnings to show, a few of each kind, those first that name an element; the record
/// has all of them.
pub(super) fn warnings(all: &[Warning]) -> Vec<String> {
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    let few = |w: &&Warning| {
        let count = seen.entry(w.code).or_default();
        *count += 1;
        *count <= ALIKE
    };
    let mut shown: Vec<&Warning> = all.iter().filter(few).collect();
    shown.sort_by_key(|w| w.subject.is_none());
    let hidden = all.len() - shown.len();
    let mut shown: Vec<String> = shown.into_iter().map(Warning::sentence).collect();
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
                    .map(cognate::results::Column::empty)
                    .collect(),
                ..Run::new(&run.name, &run.title, run.units.clone())
            };
            self.rows.table.clone_from(&run.table);
        }
        let mut row = self.seen.max(run.released);
        loop {
            // column by column, as many rows as there is room for
            row = row.next_multiple_of(self.stride);
            let room = MOST_OF_OVERVIEW - self.rows.rows();
            let n = run
                .rows()
                .saturating_sub(row)
                .div_ceil(self.stride)
                .min(room);
            if n == 0 {
                break;
            }
            let place = row - run.released;
            for (own, column) in self.rows.columns.iter_mut().zip(&run.columns) {
                let values = column.values[place..].iter().step_by(self.stride);
                own.values.extend(values.take(n));
            }
            row += n * self.stride;
            if n == room {
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
    use cognate::results::{Kind, Units};

    #[test]
    fn the_table_has_the_first_and_the_last_row_and_says_what_is_left_out() {
        let mut run = Run::new("r", "t", Units::default());
        run.add_column("a rather long expression", "mm");
        run.begin(Kind::Dynamic);
        (0..=1000).for_each(|k| run.push(&[f64::from(k) * 1e-3, -1e-7 * f64::from(k)]));
        run.end();
        let text = table(&run, 1001, 80, "the files have all");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 2 + ROWS + 1);
        assert!(lines[0].ends_with("a rather long expression") && lines[1].ends_with("mm"));
        assert!(
            lines[2].trim_start().starts_with("0.0") && lines[ROWS + 1].ends_with("-0.0001"),
            "{text}"
        );
        let told = format!("… {ROWS} of 1001 rows; the files have all");
        assert_eq!(lines[ROWS + 2], told);
        assert_eq!(table(&Run::new("r", "t", Units::default()), 0, 80, ""), "");
    }

    #[test]
    fn a_static_row_and_a_dynamic_row_at_one_time_are_told_apart() {
        let mut run = Run::new("r", "t", Units::default());
        run.add_column("x", "mm");
        for kind in [Kind::Static, Kind::Dynamic] {
            run.begin(kind);
            run.push(&[0.0, 0.1 + 0.2]);
            run.end();
        }
        let text = table(&run, 2, 80, "");
        assert!(
            text.contains("phase") && text.contains("static") && text.contains("dynamic"),
            "{text}"
        );
        assert!(text.contains("0.3") && !text.contains("0.30"), "{text}");
    }

    #[test]
    fn rows_are_shown_at_round_times_whatever_came_before_the_motion() {
        let mut run = Run::new("r", "t", Units::default());
        run.add_column("x", "mm");
        run.begin(Kind::Static);
        run.push(&[0.0, 1.0]);
        run.end();
        run.begin(Kind::Dynamic);
        (1..=600).for_each(|k| run.push(&[f64::from(k) * 0.01, 1.0]));
        run.end();
        let text = table(&run, 601, 80, "");
        let times: Vec<&str> = text.lines().skip(2).filter_map(|l| l.get(..4)).collect();
        let (first, rest) = times.split_at(2);
        assert_eq!(first, ["0.00", "0.01"]);
        assert_eq!(rest[..3], ["0.75", "1.50", "2.25"]);
    }

    #[test]
    fn reactions_that_are_not_unique_are_told() {
        assert_eq!(redundancy(&[], false), "");
        let one = redundancy(&["JOINT/2 Zi.Xj".into()], false);
        assert!(
            one.contains("JOINT/2 Zi.Xj follows") && one.contains("not unique"),
            "{one}"
        );
        let many: Vec<String> = (1..6).map(|k| format!("JOINT/{k} Zi.Xj")).collect();
        assert!(
            redundancy(&many, false).contains("and 2 more"),
            "{}",
            redundancy(&many, false)
        );
    }

    #[test]
    fn of_each_kind_of_warning_three_are_shown() {
        let warning = |code, element: String, what: &str| Warning {
            code,
            subject: Some(element.into()),
            name: None,
            rest: format!(": {what}"),
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
    fn bars_have_two_digits() {
        assert_eq!([0.0, 9.156e-10, 12.0].map(bar), ["0", "9.2e-10", "1.2e1"]);
    }

    #[test]
    fn numbers_of_a_column_have_the_decimals_that_they_need() {
        assert_eq!(aligned(&[0.0, 199.99999, 1.5]), ["0.0", "200.0", "1.5"]);
        assert_eq!(aligned(&[0.95 + 1e-16, -8.106]), ["0.950", "-8.106"]);
        assert_eq!(aligned(&[1e7, 0.0]), ["1e7", "0"]);
        assert_eq!(aligned(&[-1e-14, 200.0]), ["0", "200"]);
    }
}
