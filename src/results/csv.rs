//! Tables as comma-separated values: a row of names, a row of units when asked for, then one row
//! per output.
//!
//! Numbers have the shortest digits that read back as the same bits, so that a table is as good as
//! the run itself. Where spreadsheets have a comma in their numbers, cells are separated by `;`.

use super::format::{Style, TableText};
use super::number::push_digits;
use super::{Column, Kind, Run, Sequence, Units, malformed, number, whole_lines};
use crate::diagnostic::Diagnostic;
use std::ops::Range;

/// Writes the table of a run. `units`: with a row of units below the names.
pub fn write(run: &Run, units: bool) -> String {
    let style = Style {
        units,
        ..Style::default()
    };
    super::format::text(&mut Table::new(style), run)
}

/// Name of the column of words that tells what the model did in each row.
const PHASE: &str = "phase";

/// A table that is being written.
#[derive(Debug)]
pub struct Table {
    style: Style,
}

impl Table {
    /// Prepares a table.
    pub fn new(style: Style) -> Self {
        Self { style }
    }

    /// Returns whether an empty column follows: one column of numbers with decimal commas has no
    /// `;` by which a reader knows them.
    fn has_empty_column(&self, n_columns: usize) -> bool {
        self.style.decimal_comma && n_columns == 1
    }
}

impl TableText for Table {
    fn begin(&mut self, run: &Run, text: &mut Vec<u8>) {
        let columns = || {
            let columns = run.table_columns().into_iter();
            columns.filter_map(|i| run.columns.get(i))
        };
        let mut rows = vec![columns().map(|c| safe_name(&c.name)).collect::<Vec<_>>()];
        if self.style.units {
            rows.push(columns().map(|c| safe_name(&unit_cell(&c.unit))).collect());
        }
        if run.has_phases {
            let cells = [PHASE.to_owned(), unit_cell("")];
            rows.iter_mut()
                .zip(cells)
                .for_each(|(row, cell)| row.push(cell));
        } else if self.has_empty_column(columns().count()) {
            rows.iter_mut().for_each(|row| row.push(String::new()));
        }
        let separator = self.style.separator();
        text.extend_from_slice(to_text(&rows, separator).as_bytes());
    }

    fn rows(&mut self, run: &Run, rows: Range<usize>, text: &mut Vec<u8>) {
        let columns = run.table_columns().into_iter();
        let columns: Vec<&Column> = columns.filter_map(|i| run.columns.get(i)).collect();
        let separator = self.style.separator();
        for place in run.table_places(rows) {
            for (i, column) in columns.iter().enumerate() {
                if i > 0 {
                    text.push(separator);
                }
                let from = text.len();
                push_digits(column.at(place), text);
                if self.style.decimal_comma {
                    let point = text[from..].iter_mut().find(|c| **c == b'.');
                    point.into_iter().for_each(|c| *c = b',');
                }
            }
            if run.has_phases {
                text.push(separator);
                let kind = run.kind_of(run.released + place);
                text.extend_from_slice(kind.map_or("", Kind::name).as_bytes());
            } else if self.has_empty_column(columns.len()) {
                text.push(separator);
            }
            text.push(b'\n');
        }
    }

    fn end(&mut self, _run: &Run, _text: &mut Vec<u8>) {}
}

/// Characters at the beginning of a cell by which a spreadsheet takes it for a formula.
const FORMULA: [char; 6] = ['=', '+', '-', '@', '\t', '\r'];

/// Writes a name in a cell that no spreadsheet takes for a formula: behind an apostrophe where it
/// begins as one, or as one behind apostrophes. A lone `-` is none.
pub(crate) fn safe_name(name: &str) -> String {
    let bare = name.trim_start_matches('\'');
    match bare.starts_with(FORMULA) && name != "-" {
        true => format!("'{name}"),
        false => name.to_owned(),
    }
}

/// Returns the name that [`safe_name`] has written.
pub(crate) fn plain_name(cell: String) -> String {
    match cell.trim_start_matches('\'').starts_with(FORMULA) {
        true => cell.strip_prefix('\'').map(str::to_owned).unwrap_or(cell),
        false => cell,
    }
}

/// Writes a unit in a cell: never empty, so that no reader takes the row for numbers or for a blank
/// line.
fn unit_cell(unit: &str) -> String {
    if unit.is_empty() {
        "-".into()
    } else {
        unit.into()
    }
}

/// Writes rows of text cells, quoted where they must be: the first name, too, where it holds either
/// separator, because a reader takes the first separator outside of quotes, and where it begins
/// with a byte order mark, which a reader takes for the file's own.
fn to_text(rows: &[Vec<String>], separator: u8) -> String {
    let first = rows.first().and_then(|names| names.first());
    let is_misread = |name: &String| name.contains([',', ';']) || name.starts_with('\u{feff}');
    let quotes = match first.is_some_and(is_misread) {
        true => ::csv::QuoteStyle::Always,
        false => ::csv::QuoteStyle::Necessary,
    };
    let mut writer = ::csv::WriterBuilder::new()
        .delimiter(separator)
        .quote_style(quotes)
        .from_writer(Vec::new());
    for row in rows {
        // writing rows of equal length to memory cannot fail
        let written = writer.write_record(row);
        debug_assert!(written.is_ok(), "rows have equal length");
    }
    writer
        .into_inner()
        .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
        .unwrap_or_default()
}

/// Reads a table; a second row that holds no number is the row of units. Cells may be
/// separated by `;`, numbers then have a decimal comma. Columns behind the first that hold no
/// number at all are words, and left out. A last line without its end is left out and noted.
///
/// # Errors
/// When a row has more or fewer cells than the first, or a cell among numbers holds none, with the
/// line.
pub fn read(bytes: &[u8]) -> Result<Run, Diagnostic> {
    let (bytes, is_cut) = whole_lines(bytes);
    let mut cells_of = Rows::new(bytes);
    let mut run = Run {
        units: Units::default(),
        ..Run::default()
    };
    let mut words: Vec<Words> = Vec::new();
    while let Some((line, cells)) = cells_of.next()? {
        if run.columns.is_empty() {
            run.columns = cells.into_iter().map(named).collect();
            continue;
        }
        if cells.len() != run.columns.len() {
            return Err(malformed(
                line,
                format!(
                    "{} cells where the first row has {}",
                    cells.len(),
                    run.columns.len()
                ),
            ));
        }
        let numbers: Vec<Option<f64>> = cells.iter().map(|cell| cells_of.number(cell)).collect();
        if run.rows() == 0 && numbers.iter().all(Option::is_none) {
            for (column, unit) in run.columns.iter_mut().zip(cells) {
                column.unit = plain_name(unit);
                if column.unit == "-" {
                    column.unit.clear();
                }
            }
            continue;
        }
        words.resize_with(run.columns.len(), Words::default);
        for ((column, words), (value, cell)) in
            (run.columns.iter_mut().zip(&mut words)).zip(numbers.into_iter().zip(cells))
        {
            words.n_numbers += usize::from(value.is_some());
            if value.is_none() && words.first.is_none() {
                words.first = Some((line, cell));
            }
            column.values.push(value.unwrap_or(f64::NAN));
        }
    }
    leave_words_out(&mut run, &words)?;
    if run.columns.is_empty() {
        let what = "ends before its first row: there is no row of names";
        return Err(malformed(0, what));
    }
    // a table does not say where its rows come from: they are one sequence
    let (kind, rows) = (Kind::Dynamic, 0..run.rows());
    let name = format!("{}_001", kind.name());
    run.sequences.push(Sequence { name, kind, rows });
    if is_cut {
        run.note_cut();
    }
    Ok(run)
}

/// The rows of a table that is read.
pub(crate) struct Rows<'a> {
    reader: ::csv::Reader<&'a [u8]>,
    record: ::csv::ByteRecord,
    decimal_comma: bool,
}

impl<'a> Rows<'a> {
    /// Begins before the first row.
    pub fn new(bytes: &'a [u8]) -> Self {
        let decimal_comma = has_decimal_commas(bytes);
        Self {
            reader: ::csv::ReaderBuilder::new()
                .delimiter(if decimal_comma { b';' } else { b',' })
                .has_headers(false)
                .flexible(true)
                .trim(::csv::Trim::All)
                .from_reader(bytes),
            record: ::csv::ByteRecord::new(),
            decimal_comma,
        }
    }

    /// Returns the line and the cells of the next row; `None` behind the last.
    ///
    /// # Errors
    /// The bytes are no table.
    pub fn next(&mut self) -> Result<Option<(usize, Vec<String>)>, Diagnostic> {
        let is_there = (self.reader).read_byte_record(&mut self.record);
        if !is_there.map_err(|e| malformed(0, e.to_string()))? {
            return Ok(None);
        }
        let line = self.record.position().map_or(0, |p| p.line() as usize);
        let text = |cell| String::from_utf8_lossy(cell).into_owned();
        Ok(Some((line, self.record.iter().map(text).collect())))
    }

    /// Reads the number of a cell.
    pub fn number(&self, cell: &str) -> Option<f64> {
        match self.decimal_comma {
            true => number(&cell.replace(',', ".")),
            false => number(cell),
        }
    }
}

/// Returns a column without values, whose name stands in a cell.
fn named(cell: String) -> Column {
    Column {
        name: plain_name(cell),
        ..Column::default()
    }
}

/// Cells of a column that hold no number.
#[derive(Default)]
struct Words {
    n_numbers: usize,
    /// line and text of the first
    first: Option<(usize, String)>,
}

/// Leaves out the columns of words.
///
/// # Errors
/// A word among numbers, or in the first column; the first of them.
fn leave_words_out(run: &mut Run, words: &[Words]) -> Result<(), Diagnostic> {
    let is_wrong = |k: usize, words: &Words| k == 0 || words.n_numbers > 0;
    let wrong = words.iter().enumerate().filter(|(k, w)| is_wrong(*k, w));
    let first = wrong.filter_map(|(k, w)| Some((k, w.first.as_ref()?)));
    if let Some((k, (line, cell))) = first.min_by_key(|(_, (line, _))| *line) {
        let name = &run.columns[k].name;
        let what = format!("`{cell}` in column `{name}` is no number");
        return Err(malformed(*line, what));
    }
    let mut words = words.iter();
    let has_words = |words: &Words| words.first.is_some();
    run.columns.retain(|_| !words.next().is_some_and(has_words));
    Ok(())
}

/// Returns whether cells are separated by `;`: in the first row it comes first of the two
/// separators outside of quotes.
fn has_decimal_commas(bytes: &[u8]) -> bool {
    let mut bare = bytes.split(|&b| b == b'"').step_by(2).flatten();
    bare.find(|b| matches!(b, b';' | b',' | b'\n')) == Some(&b';')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Run {
        let mut run = Run::new("r", "t", Units::default());
        run.add_column("DX(12,21)", "meter");
        run.add_column("say \"x\"", "");
        run.begin(Kind::Input);
        run.push(&[0.0, 9.0, 9.0]);
        run.end();
        run.begin(Kind::Dynamic);
        run.push(&[0.1 + 0.2, -1e-300, 3.0]);
        run.push(&[1.0, f64::MAX, 0.0]);
        run.end();
        run
    }

    #[test]
    fn names_with_commas_are_quoted_and_the_model_as_read_is_left_out() {
        let text = write(&example(), true);
        assert_eq!(
            text.lines().next(),
            Some("time,\"DX(12,21)\",\"say \"\"x\"\"\"")
        );
        assert_eq!(text.lines().nth(1), Some("sec,meter,-"));
        assert_eq!(text.lines().nth(2), Some("0.30000000000000004,-1e-300,3"));
        assert_eq!(text.lines().count(), 4);
    }

    #[test]
    fn what_is_written_reads_back_to_the_bit() {
        for units in [false, true] {
            let (run, back) = (
                example(),
                read(write(&example(), units).as_bytes()).unwrap(),
            );
            for (a, b) in run.columns.iter().zip(&back.columns) {
                assert_eq!((&a.name, &a.values[1..]), (&b.name, &b.values[..]));
                assert_eq!(if units { a.unit.as_str() } else { "" }, b.unit);
            }
        }
    }

    #[test]
    fn a_table_with_decimal_commas_reads_back_to_the_bit() {
        let style = Style {
            decimal_comma: true,
            ..Style::default()
        };
        let text = crate::results::format::text(&mut Table::new(style), &example());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "time;DX(12,21);\"say \"\"x\"\"\"");
        assert_eq!(lines[2], "0,30000000000000004;-1e-300;3");
        let back = read(text.as_bytes()).unwrap();
        assert_eq!(back.columns[0].values, [0.1 + 0.2, 1.0]);
        assert_eq!(back.columns[1].values, [-1e-300, f64::MAX]);
    }

    #[test]
    fn a_first_name_that_could_be_taken_for_something_else_reads_back() {
        let names = [
            "x; mm",
            "DX(1,2)",
            "a\nb",
            "say \"x;y\"",
            "\u{feff}",
            "\u{feff}x",
        ];
        for name in names {
            for decimal_comma in [false, true] {
                let mut run = Run::new("r", "t", Units::default());
                run.columns[0].name = name.into();
                run.begin(Kind::Dynamic);
                run.push(&[0.5]);
                run.end();
                let style = Style {
                    decimal_comma,
                    ..Style::default()
                };
                let text = crate::results::format::text(&mut Table::new(style), &run);
                let back = read(text.as_bytes()).unwrap();
                assert_eq!(back.columns[0].name, name);
                assert_eq!(back.columns[0].values, [0.5], "{text}");
            }
        }
    }

    #[test]
    fn columns_of_words_are_left_out() {
        let read = read(b"run,x,why\n-,m,-\n0,1,\n1,2,stopped\n").unwrap();
        let names: Vec<&str> = read.columns.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["run", "x"]);
        assert_eq!((read.rows(), read.columns[1].unit.as_str()), (2, "m"));
    }

    #[test]
    fn mistakes_are_told_with_their_line() {
        let line = |text: &str| read(text.as_bytes()).unwrap_err().line;
        assert_eq!(line("time,x\n0,1\n1,oops\n"), 3);
        assert_eq!(line("time,x,y\n0,1,a\n1,2,3\n1,oops,4\n"), 2);
        assert_eq!(line("time,x\n0,1\nlate,1\n"), 3);
        assert_eq!(line("time,x\ns,m\n0\n"), 3);
        assert_eq!(line(""), 0);
    }
}
