//! `.res` files, XML form: every element's components at every output, in the schema that pre- and postprocessors read.
//!
//! Card: `StepMap` lists entities and their components, each with a number; each `Step` of each `Data` block holds the values of all
//! components in the order of their numbers, whatever its line breaks. White space is free, attributes may be missing, numbers
//! may have three-digit exponents. We write one line per group of components that belong to one element, as other programs do:
//! scripts that split such lines at single blanks keep working. Nothing in a file depends on the clock: same run, same bytes.
//!
//! The old text form is recognised by its first line and read by `text_res.rs`.

use super::{
    Column, Component, Entity, Kind, Run, Sequence, Status, component_unit, digits, malformed,
    number, text_res,
};
use crate::diagnostic::Diagnostic;
use quick_xml::Reader;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use std::fmt::Write;

/// The entity that holds columns which belong to no element.
const EXPRESSIONS: &str = "expressions";

/// A run as `.res` text; it reads back with the same numbers.
pub fn write(run: &Run) -> String {
    let owners = owners(run);
    let mut text = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Results xmlns=\"http://www.mscsoftware.com/:xrf10\">\n",
    );
    head(run, &mut text);
    step_map(run, &owners, &mut text);
    for (sequence, id) in run.sequences.iter().zip(1..) {
        put(
            &mut text,
            format_args!("<Data name=\"{}\" id=\"{id}\">\n", escape(&sequence.name)),
        );
        for row in sequence.rows.clone().filter(|&row| row < run.rows()) {
            put(
                &mut text,
                format_args!("<Step type=\"{}\">\n", sequence.kind.step()),
            );
            values(run, &owners, row, &mut text);
            text.push_str("</Step>\n");
        }
        text.push_str("</Data>\n");
    }
    let status = if run.record.status == Status::Completed {
        "Successful"
    } else {
        "Failed"
    };
    put(
        &mut text,
        format_args!(
            "<TerminationStatus runTermObject=\"{}\" runStatus=\"{status}\" />\n",
            escape(&run.record.stop_reason)
        ),
    );
    text.push_str("</Analysis>\n</Results>\n");
    text
}

fn put(text: &mut String, what: std::fmt::Arguments<'_>) {
    // Writing to a String cannot fail.
    let _ = text.write_fmt(what);
}

/// Which entity each column belongs to; `None`: to no element.
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

fn head(run: &Run, text: &mut String) {
    let (name, title, version) = (
        escape(&run.name),
        escape(&run.title),
        env!("CARGO_PKG_VERSION"),
    );
    let u = &run.units;
    put(
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

/// The map: time, the elements, and what belongs to none. A column's number is its place in the run, from 1.
fn step_map(run: &Run, owners: &[Option<usize>], text: &mut String) {
    let component = |text: &mut String, name: &str, column: usize, label: bool| {
        let unit = run.columns.get(column).map_or("", |c| c.unit.as_str());
        put(text, format_args!("<Component name=\"{}\"", escape(name)));
        if label {
            put(text, format_args!(" plotLabel=\"{}\"", escape(name)));
        }
        if !unit.is_empty() {
            put(text, format_args!(" unitsValue=\"{}\"", escape(unit)));
        }
        put(text, format_args!(" id=\"{}\" />\n", column + 1));
    };
    text.push_str("<StepMap name=\"map_001\">\n<Entity name=\"time\">\n");
    component(text, "TIME", 0, false);
    text.push_str("</Entity>\n");
    for e in &run.entities {
        let (name, entity, kind, id) = (escape(&e.name), escape(&e.entity), escape(&e.kind), e.id);
        put(
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
        .filter(|&c| owners[c].is_none())
        .collect();
    if !free.is_empty() {
        put(
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

/// One row, a line per group of neighbours with one owner.
fn values(run: &Run, owners: &[Option<usize>], row: usize, text: &mut String) {
    for (i, column) in run.columns.iter().enumerate() {
        if i > 0 {
            text.push(if i == 1 || owners[i] != owners[i - 1] {
                '\n'
            } else {
                ' '
            });
        }
        text.push_str(&digits(column.values[row]));
    }
    text.push('\n');
}

/// A text inside an attribute: markup replaced, and characters that XML cannot hold.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() => out.push(' '),
            '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// Reads a `.res` file in XML or the old text form.
///
/// Columns are named `ENTITY.COMPONENT`. Of several analyses in a file the first is read.
///
/// # Errors
/// When the contents are not of this format: markup that does not close, components without number or with the same number twice,
/// steps with more or fewer values than there are components; says which line.
pub fn read(bytes: &[u8]) -> Result<Run, Diagnostic> {
    let text = String::from_utf8_lossy(bytes);
    if text_res::recognise(&text) {
        return text_res::read(&text);
    }
    let mut reader = Reader::from_str(text.strip_prefix('\u{feff}').unwrap_or(&text));
    let mut reading = Reading::default();
    let outcome = reading.all(&mut reader);
    let position = usize::try_from(reader.buffer_position())
        .unwrap_or(usize::MAX)
        .min(text.len());
    outcome.map_err(|message| {
        malformed(
            1 + text.as_bytes()[..position]
                .iter()
                .filter(|&&b| b == b'\n')
                .count(),
            message,
        )
    })?;
    Ok(reading.run)
}

/// What has been read so far.
#[derive(Default)]
struct Reading {
    run: Run,
    /// number of each component in the file, beside the columns in the order they were met
    ids: Vec<u64>,
    /// number of components; 0 until the map is complete
    width: usize,
    /// values of the step that is being read
    row: Vec<f64>,
    /// whether text belongs to a step
    in_step: bool,
}

impl Reading {
    fn all(&mut self, reader: &mut Reader<&[u8]>) -> Result<(), String> {
        loop {
            match reader.read_event().map_err(|e| e.to_string())? {
                Event::Start(e) => self.start(&e, false)?,
                Event::Empty(e) => self.start(&e, true)?,
                Event::End(e) => {
                    let name = e.local_name();
                    if self.end(name.as_ref())? {
                        return self.finish();
                    }
                }
                Event::Text(t) if self.in_step => self.numbers(&t)?,
                Event::CData(t) if self.in_step => self.numbers(&t)?,
                Event::GeneralRef(_) if self.in_step => {
                    return Err("a step holds something that is no number".into());
                }
                Event::Eof => return self.finish(),
                _ => {}
            }
        }
    }

    fn start(&mut self, e: &BytesStart<'_>, empty: bool) -> Result<(), String> {
        let attribute = |name: &str| -> Result<Option<String>, String> {
            let found = e.try_get_attribute(name).map_err(|e| e.to_string())?;
            found
                .map(|a| {
                    a.normalized_value(XmlVersion::Implicit1_0)
                        .map(|v| v.into_owned())
                        .map_err(|e| e.to_string())
                })
                .transpose()
        };
        match e.local_name().as_ref() {
            "Analysis" => self.run.name = attribute("name")?.unwrap_or_default(),
            "ModelInfo" => self.run.title = attribute("title")?.unwrap_or_default(),
            "Units" => {
                let u = &mut self.run.units;
                for (name, unit) in [
                    ("angle", &mut u.angle),
                    ("length", &mut u.length),
                    ("mass", &mut u.mass),
                    ("time", &mut u.time),
                ] {
                    if let Some(value) = attribute(name)? {
                        *unit = value;
                    }
                }
            }
            "Entity" => {
                let name = attribute("name")?.ok_or("an Entity without a name")?;
                self.run.entities.push(Entity {
                    entity: attribute("entity")?.unwrap_or_else(|| name.clone()),
                    kind: attribute("entType")?.unwrap_or_default(),
                    id: attribute("objectId")?
                        .and_then(|id| id.trim().parse().ok())
                        .unwrap_or(0),
                    name,
                    components: Vec::new(),
                });
            }
            "Component" => {
                let name = attribute("name")?.ok_or("a Component without a name")?;
                let id = attribute("id")?
                    .and_then(|id| id.trim().parse().ok())
                    .ok_or("a Component without a number (id)")?;
                self.component(name, id, attribute("unitsValue")?)?;
            }
            "Data" => {
                self.map_ends()?;
                // a block may begin inside another: steps so far belong to the one before
                self.run.end();
                let rows = self.run.rows()..self.run.rows();
                let name = attribute("name")?.unwrap_or_default();
                let kind = Kind::NAMES
                    .iter()
                    .find(|k| name.starts_with(k.1))
                    .map_or(Kind::Dynamic, |k| k.0);
                self.run.sequences.push(Sequence { name, kind, rows });
            }
            "Step" => {
                let sequence = self
                    .run
                    .sequences
                    .last_mut()
                    .ok_or("a Step outside of Data")?;
                if let Some(kind) =
                    attribute("type")?.and_then(|t| Kind::NAMES.iter().find(|k| k.2 == t))
                {
                    sequence.kind = kind.0;
                }
                self.row.clear();
                self.in_step = true;
                if empty {
                    self.step_ends()?;
                }
            }
            "TerminationStatus" => {
                self.run.record.stop_reason = attribute("runTermObject")?.unwrap_or_default();
                let successful = attribute("runStatus")?.is_none_or(|s| s == "Successful");
                self.run.record.status = if successful {
                    Status::Completed
                } else {
                    Status::Stopped
                };
            }
            _ => {}
        }
        Ok(())
    }

    /// Handles a closing tag; whether there is nothing more to read.
    fn end(&mut self, name: &str) -> Result<bool, String> {
        match name {
            "StepMap" => self.map_ends()?,
            "Step" => self.step_ends()?,
            "Data" => self.run.end(),
            "Analysis" => return Ok(true),
            _ => {}
        }
        Ok(false)
    }

    /// Adds a component of the last entity.
    fn component(&mut self, name: String, id: u64, unit: Option<String>) -> Result<(), String> {
        if self.width > 0 {
            return Err("a Component after the first Data".into());
        }
        let entity = self
            .run
            .entities
            .last_mut()
            .ok_or("a Component outside of an Entity")?;
        let is_time = name == "TIME" && entity.name == "time";
        let unit = unit.unwrap_or_else(|| component_unit(&name, &self.run.units));
        if is_time {
            self.run.columns.push(Column {
                name: "time".into(),
                unit,
                values: Vec::new(),
            });
        } else {
            let full = if entity.name == EXPRESSIONS {
                name.clone()
            } else {
                format!("{}.{name}", entity.name)
            };
            self.run.columns.push(Column {
                name: full,
                unit,
                values: Vec::new(),
            });
        }
        entity.components.push(Component {
            name,
            column: self.run.columns.len() - 1,
        });
        self.ids.push(id);
        Ok(())
    }

    /// The map is complete: puts the columns in the order of their numbers.
    fn map_ends(&mut self) -> Result<(), String> {
        if self.width > 0 {
            return Ok(());
        }
        if self.ids.is_empty() {
            return Err("there is no Component before the first Data".into());
        }
        let mut by_id: Vec<usize> = (0..self.ids.len()).collect();
        by_id.sort_by_key(|&c| self.ids[c]);
        if let Some(pair) = by_id.windows(2).find(|w| self.ids[w[0]] == self.ids[w[1]]) {
            return Err(format!(
                "the number {} is given to two components",
                self.ids[pair[0]]
            ));
        }
        let mut new_place = vec![0; by_id.len()];
        for (place, &column) in by_id.iter().enumerate() {
            new_place[column] = place;
        }
        let mut columns = std::mem::take(&mut self.run.columns);
        self.run.columns = by_id
            .iter()
            .map(|&c| std::mem::take(&mut columns[c]))
            .collect();
        for entity in &mut self.run.entities {
            entity
                .components
                .iter_mut()
                .for_each(|c| c.column = new_place[c.column]);
            entity
                .components
                .retain(|c| self.run.columns[c.column].name != "time");
        }
        self.run
            .entities
            .retain(|e| !e.components.is_empty() && e.name != EXPRESSIONS);
        if self.run.columns[0].name != "time" {
            return Err("the component with the lowest number is not TIME".into());
        }
        if let Some(force) = self
            .run
            .columns
            .iter()
            .find(|c| c.name.ends_with(".FX") && !c.unit.is_empty())
        {
            self.run.units.force = force.unit.clone();
        }
        self.width = by_id.len();
        self.ids.sort_unstable();
        Ok(())
    }

    fn numbers(&mut self, text: &str) -> Result<(), String> {
        let most = self
            .ids
            .last()
            .map_or(0, |&id| usize::try_from(id).unwrap_or(usize::MAX))
            .max(self.width);
        for word in text.split_ascii_whitespace() {
            if self.row.len() >= most {
                return Err(format!(
                    "a step has more values than there are components ({})",
                    self.width
                ));
            }
            self.row
                .push(number(word).ok_or_else(|| format!("`{word}` is no number"))?);
        }
        Ok(())
    }

    fn step_ends(&mut self) -> Result<(), String> {
        self.in_step = false;
        let (given, width) = (self.row.len(), self.width);
        let dense = self.ids.last().is_some_and(|&last| last == width as u64);
        if given == width {
            self.run.push(&self.row);
        } else if !dense && self.ids.last().is_some_and(|&last| last == given as u64) {
            // Some components were taken out of the map, not out of the steps: the number is the place.
            let row: Vec<f64> = self
                .ids
                .iter()
                .map(|&id| {
                    self.row
                        .get((id as usize).wrapping_sub(1))
                        .copied()
                        .unwrap_or(f64::NAN)
                })
                .collect();
            self.run.push(&row);
        } else {
            return Err(format!(
                "a step has {given} values where there are {width} components"
            ));
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), String> {
        if self.run.columns.is_empty() || self.run.sequences.is_empty() {
            return Err(
                "this is no XML results file: it has no StepMap with Components, or no Data".into(),
            );
        }
        self.run.end();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::Units;

    /// Two parts in the order of solvers (all places, then all velocities), a request and an expression.
    fn example() -> Run {
        let mut run = Run::new(
            "four <bar>",
            "\"A&B\" model",
            Units {
                length: "mm".into(),
                ..Units::default()
            },
        );
        let mut parts = Vec::new();
        for part in ["PART_2", "PART_3"] {
            parts.push(Entity {
                name: format!("{part}_XFORM"),
                entity: part.into(),
                kind: "Part".into(),
                id: 2,
                components: vec![],
            });
        }
        for names in [["X", "Y"], ["VX", "VY"]] {
            for part in &mut parts {
                for name in names {
                    let column = run.add_column(
                        format!("{}.{name}", part.name),
                        component_unit(name, &run.units),
                    );
                    part.components.push(Component {
                        name: name.into(),
                        column,
                    });
                }
            }
        }
        let column = run.add_column("REQ.a<b", "");
        let components = vec![Component {
            name: "a<b".into(),
            column,
        }];
        parts.push(Entity {
            name: "REQ".into(),
            entity: "REQ".into(),
            kind: "Request".into(),
            id: 1,
            components,
        });
        run.entities = parts;
        run.add_column("DX(12,21)", "mm");
        for (kind, rows) in [(Kind::Input, 1), (Kind::Static, 1), (Kind::Dynamic, 2)] {
            run.begin(kind);
            for row in 0..rows {
                let values: Vec<f64> = (0..run.columns.len())
                    .map(|c| (c as f64 + 0.1) / 3.0 * f64::powi(-1e-3, row))
                    .collect();
                run.push(&values);
            }
            run.end();
        }
        run
    }

    #[test]
    fn what_is_written_reads_back() {
        let (run, back) = (example(), read(write(&example()).as_bytes()).unwrap());
        assert_eq!(run.columns, back.columns);
        assert_eq!(run.entities, back.entities);
        assert_eq!(
            (run.sequences, run.name, run.title, run.units),
            (back.sequences, back.name, back.title, back.units)
        );
    }

    #[test]
    fn values_go_by_the_numbers_of_components_not_by_their_place_in_the_map() {
        let text = "<Results><Analysis><StepMap><Entity name=\"P\"><Component name=\"Y\" id=\"3\"/><Component name=\"X\" id=\"2\"/></Entity>\
                    <Entity name=\"time\"><Component name=\"TIME\" id=\"1\"/></Entity></StepMap>\
                    <Data name=\"dynamic_001\"><Step type=\"dynamic\">0.5 \n 2.5E-001\t-3</Step></Data></Analysis></Results>";
        let run = read(text.as_bytes()).unwrap();
        assert_eq!(
            (run.column("time"), run.column("P.X"), run.column("P.Y")),
            (Some(&[0.5][..]), Some(&[0.25][..]), Some(&[-3.0][..]))
        );
        assert_eq!(run.sequences[0].kind, Kind::Dynamic);
    }

    #[test]
    fn components_left_out_of_the_map_leave_their_values_behind() {
        let text = "<Results><Analysis><StepMap><Entity name=\"time\"><Component name=\"TIME\" id=\"1\"/></Entity>\
                    <Entity name=\"P\"><Component name=\"X\" id=\"4\"/></Entity></StepMap>\
                    <Data name=\"dynamic_001\"><Step type=\"dynamic\">0 1 2 3</Step></Data></Analysis></Results>";
        assert_eq!(
            read(text.as_bytes()).unwrap().column("P.X"),
            Some(&[3.0][..])
        );
    }

    #[test]
    fn steps_have_the_shape_that_scripts_split_at_blanks() {
        let text = write(&example());
        let step: Vec<&str> = text
            .split("<Step type=\"static\">\n")
            .nth(1)
            .unwrap()
            .split("</Step>")
            .next()
            .unwrap()
            .lines()
            .collect();
        assert_eq!(
            step.len(),
            1 + 2 + 2 + 1 + 1,
            "time, places, velocities, request, expression"
        );
        assert!(step.iter().all(|l| l.trim() == *l && !l.contains("  ")));
    }

    #[test]
    fn mistakes_are_told_with_their_line() {
        let good = write(&example());
        let line_of =
            |from: &str, to: &str| read(good.replacen(from, to, 1).as_bytes()).map_err(|d| d.line);
        let line = |what: &str| 1 + good[..good.find(what).unwrap()].matches('\n').count();
        assert_eq!(line_of("</StepMap>", "</Step>"), Err(line("</StepMap>")));
        assert_eq!(line_of("id=\"3\"", "id=\"2\""), Err(line("</StepMap>")));
        assert_eq!(line_of("id=\"3\"", ""), Err(line("id=\"3\"")));
        assert!(matches!(line_of("</Step>", "1 2</Step>"), Err(n) if n >= line("</Step>")));
        assert!(line_of("</Step>", "&lt;</Step>").is_err());
        assert!(read(b"").is_err() && read(b"<Results/>").is_err() && read(b"\xff\xfe<<").is_err());
    }

    #[test]
    fn a_cut_file_is_never_a_panic() {
        let text = write(&example());
        for cut in 0..text.len() {
            let _ = read(&text.as_bytes()[..cut]);
        }
    }
}
