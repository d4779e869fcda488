//! Writing `.res` files. They hold no bars of error: they are for programs that know of none.

use super::EXPRESSIONS;
use crate::results::format::TableText;
use crate::results::number::push_digits;
use crate::results::{Entity, Run, Status};
use std::fmt::Write;
use std::ops::Range;

/// Writes a run as `.res` text, which reads back with the same numbers.
pub fn write(run: &Run) -> String {
    crate::results::format::text(&mut Steps::default(), run)
}

/// A `.res` file that is being written.
#[derive(Debug, Default)]
pub struct Steps {
    /// the entity that each column belongs to; `None`: it belongs to no element
    owners: Vec<Option<usize>>,
    /// sequences whose data block has been opened
    opened: usize,
}

impl Steps {
    /// Opens the data blocks of sequences up to one, and closes those before.
    fn open(&mut self, run: &Run, until: usize, text: &mut Vec<u8>) {
        while self.opened < until {
            self.close(text);
            let name = escape(&run.sequences[self.opened].name);
            self.opened += 1;
            let id = self.opened;
            put(text, &format!("<Data name=\"{name}\" id=\"{id}\">\n"));
        }
    }

    fn close(&self, text: &mut Vec<u8>) {
        if self.opened > 0 {
            put(text, "</Data>\n");
        }
    }
}

impl TableText for Steps {
    fn begin(&mut self, run: &Run, text: &mut Vec<u8>) {
        self.owners = owners(run);
        put(
            text,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
             <Results xmlns=\"http://www.mscsoftware.com/:xrf10\">\n",
        );
        let mut before = String::new();
        head(run, &mut before);
        step_map(run, &self.owners, &mut before);
        put(text, &before);
    }

    fn rows(&mut self, run: &Run, rows: Range<usize>, text: &mut Vec<u8>) {
        let columns = separated(run, &self.owners);
        for (sequence, index) in run.sequences.iter().zip(0..) {
            let own = sequence.rows.start.max(rows.start)..sequence.rows.end.min(rows.end);
            for row in own {
                self.open(run, index + 1, text);
                put(text, "<Step type=\"");
                put(text, sequence.kind.step());
                put(text, "\">\n");
                values(&columns, row - run.released, text);
                put(text, "</Step>\n");
            }
        }
    }

    fn end(&mut self, run: &Run, text: &mut Vec<u8>) {
        self.open(run, run.sequences.len(), text);
        self.close(text);
        let status = if run.record.status == Status::Completed {
            "Successful"
        } else {
            "Failed"
        };
        let reason = escape(&run.record.stop_reason);
        put(
            text,
            &format!(
                "<TerminationStatus runTermObject=\"{reason}\" runStatus=\"{status}\" />\n\
                 </Analysis>\n</Results>\n"
            ),
        );
    }
}

fn put(text: &mut Vec<u8>, more: &str) {
    text.extend_from_slice(more.as_bytes());
}

fn add(text: &mut String, what: std::fmt::Arguments<'_>) {
    // writing to a String cannot fail
    let _ = text.write_fmt(what);
}

/// Returns the entity that each column belongs to; `None`: it belongs to no element.
fn owners(run: &Run) -> Vec<Option<usize>> {
    let mut owners = vec![None; run.columns.len()];
    for (index, entity) in run.entities.iter().enumerate() {
        for component in &entity.components {
            if let Some(owner) = owners.get_mut(component.column) {
                *owner = Some(index);
            }
        }
    }
    owners
}

/// Returns the name of a set in the file: of an element within an assembly its own, as Adams
/// writes it, for `entity` has that of the assembly.
fn own_name(e: &Entity) -> &str {
    match e.entity.rsplit_once('.') {
        Some((_, own)) if e.name == e.entity && !own.is_empty() => own,
        _ => &e.name,
    }
}

fn head(run: &Run, text: &mut String) {
    let (name, title, version) = (
        escape(&run.name),
        escape(&run.title),
        env!("CARGO_PKG_VERSION"),
    );
    let u = &run.units;
    add(
        text,
        format_args!(
            "<Bibliography>\n\
             <File URI=\"file://{name}.res\" schema=\"xrf\" version=\"2.0.0.0\" publicationDate=\"-unknown-\" />\n\
             <Revision version=\"1\" derivedFrom=\"-unknown-\">\n<Comment>\n</Comment>\n</Revision>\n\
             </Bibliography>\n\
             <Analysis name=\"{name}\" executionDate=\"-unknown-\" Solver=\"cognate {version}\" script=\"-unknown-\">\n\
             <Bibliography>\n\
             <Environment operatingSystem=\"-unknown-\" hostname=\"-unknown-\" />\n\
             <Application name=\"cognate\" version=\"{version}\" />\n\
             </Bibliography>\n\
             <ModelInfo title=\"{title}\" creationDate=\"-unknown-\" checksum=\"-unknown-\" />\n\
             <Units angle=\"{}\" length=\"{}\" mass=\"{}\" time=\"{}\" />\n",
            escape(&u.angle),
            escape(&u.length),
            escape(&u.mass),
            escape(&u.time)
        ),
    );
}

/// Writes the map: time, the elements, and columns of no element. A column's number is its place in
/// the run, from 1.
fn step_map(run: &Run, owners: &[Option<usize>], text: &mut String) {
    let component = |text: &mut String, name: &str, column: usize, label: bool| {
        let unit = run.columns.get(column).map_or("", |c| c.unit.as_str());
        add(text, format_args!("<Component name=\"{}\"", escape(name)));
        if label {
            add(text, format_args!(" plotLabel=\"{}\"", escape(name)));
        }
        if !unit.is_empty() {
            add(text, format_args!(" unitsValue=\"{}\"", escape(unit)));
        }
        add(text, format_args!(" id=\"{}\" />\n", column + 1));
    };
    text.push_str("<StepMap name=\"map_001\">\n<Entity name=\"time\">\n");
    component(text, "TIME", 0, false);
    text.push_str("</Entity>\n");
    for e in &run.entities {
        let (name, entity) = (escape(own_name(e)), escape(&e.entity));
        let (kind, id) = (escape(&e.kind), e.id);
        add(
            text,
            format_args!(
                "<Entity name=\"{name}\" entity=\"{entity}\" entType=\"{kind}\" objectId=\"{id}\">\n"
            ),
        );
        for c in e.components.iter().filter(|c| c.column < run.columns.len()) {
            component(text, &c.name, c.column, e.kind == "Request");
        }
        text.push_str("</Entity>\n");
    }
    let free: Vec<usize> = (1..run.columns.len())
        .filter(|&c| owners[c].is_none() && run.columns[c].bar_of.is_none())
        .collect();
    if !free.is_empty() {
        add(
            text,
            format_args!(
                "<Entity name=\"{EXPRESSIONS}\" entity=\"{EXPRESSIONS}\" entType=\"Request\" objectId=\"0\">\n"
            ),
        );
        free.into_iter()
            .for_each(|c| component(text, &run.columns[c].name, c, true));
        text.push_str("</Entity>\n");
    }
    text.push_str("</StepMap>\n");
}

/// Returns the values of the columns, each with the mark that follows it: the end of a line behind
/// the time and behind each group of neighbours with one owner.
fn separated<'r>(run: &'r Run, owners: &[Option<usize>]) -> Vec<(&'r [f64], u8)> {
    let columns = run.columns.iter().enumerate();
    let shown: Vec<usize> = columns
        .filter(|(_, c)| c.bar_of.is_none())
        .map(|(i, _)| i)
        .collect();
    let ends = |next: usize| next == 1 || owners[next] != owners[next - 1];
    let mark = |next: Option<&usize>| match next {
        Some(&next) if !ends(next) => b' ',
        _ => b'\n',
    };
    let marks = (1..=shown.len()).map(|k| mark(shown.get(k)));
    (shown.iter().zip(marks))
        .filter_map(|(&i, mark)| Some((run.columns.get(i)?.values.as_slice(), mark)))
        .collect()
}

/// Writes one row. `place`: where its values are.
fn values(columns: &[(&[f64], u8)], place: usize, text: &mut Vec<u8>) {
    for (values, mark) in columns {
        push_digits(values.get(place).copied().unwrap_or(f64::NAN), text);
        text.push(*mark);
    }
}

/// Escapes a text for an attribute; characters that XML cannot hold become blanks.
fn escape(text: &str) -> String {
    let is_odd = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    quick_xml::escape::escape(text.replace(is_odd, " ")).into_owned()
}
