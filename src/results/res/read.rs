//! Reading `.res` files of the XML form, tag by tag.

use super::{EXPRESSIONS, text};
use crate::arrange::Arrange;
use crate::diagnostic::{Diagnostic, counted};
use crate::results::{
    Column, Component, Entity, Kind, Run, Sequence, Status, component_unit, malformed, no_row,
    number,
};
use quick_xml::Reader;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};

/// Reads a `.res` file in XML or the old text form.
///
/// Columns are named `ENTITY.COMPONENT`. Of several analyses in a file the first is read; of a file
/// that is cut off its whole steps.
///
/// # Errors
/// When the contents are not of this format, with the line: markup that does not close, components
/// without a number or with the same number twice, steps with more or fewer values than there are
/// components.
pub fn read(bytes: &[u8]) -> Result<Run, Diagnostic> {
    let contents = String::from_utf8_lossy(bytes);
    if text::recognise(&contents) {
        return text::read(&contents);
    }
    let markup = contents.strip_prefix('\u{feff}').unwrap_or(&contents);
    // a tag that is cut off, or numbers of a step without its end
    let whole = markup.rfind('>').map_or("", |end| &markup[..=end]);
    let mut reader = Reader::from_str(whole);
    let mut reading = Reading::default();
    let outcome = reading.all(&mut reader);
    let position = usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX);
    let before = &contents.as_bytes()[..position.min(contents.len())];
    let line = || 1 + before.iter().filter(|&&b| b == b'\n').count();
    let n_lines = whole.bytes().filter(|&b| b == b'\n').count();
    outcome.map_err(|message| no_row(malformed(line(), message), n_lines))?;
    if !reading.is_complete {
        if reading.run.rows() == 0 {
            return Err(no_row(malformed(0, "there is no whole Step"), n_lines));
        }
        reading.run.note_cut();
    }
    Ok(reading.run)
}

/// A file that is being read: the run so far, and where the reader stands.
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
    /// whether the end of the analysis has been read
    is_complete: bool,
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

    /// Handles an opening tag. `empty`: it closes itself.
    fn start(&mut self, e: &BytesStart<'_>, empty: bool) -> Result<(), String> {
        match e.local_name().as_ref() {
            "Analysis" => self.run.name = attribute(e, "name")?.unwrap_or_default(),
            "ModelInfo" => self.run.title = attribute(e, "title")?.unwrap_or_default(),
            "Units" => self.units(e)?,
            "Entity" => self.entity(e)?,
            "Component" => self.component(e)?,
            "Data" => self.data(e)?,
            "Step" => {
                self.step(e)?;
                if empty {
                    self.step_ends()?;
                }
            }
            "TerminationStatus" => self.termination(e)?,
            _ => {}
        }
        Ok(())
    }

    fn units(&mut self, e: &BytesStart<'_>) -> Result<(), String> {
        let u = &mut self.run.units;
        for (name, unit) in [
            ("angle", &mut u.angle),
            ("length", &mut u.length),
            ("mass", &mut u.mass),
            ("time", &mut u.time),
        ] {
            if let Some(value) = attribute(e, name)? {
                *unit = value;
            }
        }
        Ok(())
    }

    fn entity(&mut self, e: &BytesStart<'_>) -> Result<(), String> {
        let own = attribute(e, "name")?.ok_or("an Entity without a name")?;
        let entity = attribute(e, "entity")?.unwrap_or_else(|| own.clone());
        // of an element within an assembly the file has its own name apart
        let within = entity.strip_suffix(&own).is_some_and(|s| s.ends_with('.'));
        let name = if within { entity.clone() } else { own };
        self.run.entities.push(Entity {
            entity,
            kind: attribute(e, "entType")?.unwrap_or_default(),
            id: whole(attribute(e, "objectId")?).unwrap_or(0),
            name,
            components: Vec::new(),
        });
        Ok(())
    }

    /// Begins a block of rows.
    fn data(&mut self, e: &BytesStart<'_>) -> Result<(), String> {
        self.map_ends()?;
        // a block may begin inside another: steps so far belong to the one before
        self.run.end();
        let rows = self.run.rows()..self.run.rows();
        let name = attribute(e, "name")?.unwrap_or_default();
        let kind = Kind::NAMES.iter().find(|k| name.starts_with(k.1));
        let kind = kind.map_or(Kind::Dynamic, |k| k.0);
        self.run.sequences.push(Sequence { name, kind, rows });
        Ok(())
    }

    /// Begins a row.
    fn step(&mut self, e: &BytesStart<'_>) -> Result<(), String> {
        let sequence = self.run.sequences.last_mut();
        let sequence = sequence.ok_or("a Step outside of Data")?;
        let given = attribute(e, "type")?;
        let kind = given.and_then(|t| Kind::NAMES.iter().find(|k| k.2 == t));
        if let Some(kind) = kind {
            sequence.kind = kind.0;
        }
        self.row.clear();
        self.in_step = true;
        Ok(())
    }

    fn termination(&mut self, e: &BytesStart<'_>) -> Result<(), String> {
        let record = &mut self.run.record;
        record.stop_reason = attribute(e, "runTermObject")?.unwrap_or_default();
        let successful = attribute(e, "runStatus")?.is_none_or(|s| s == "Successful");
        record.status = if successful {
            Status::Completed
        } else {
            Status::Stopped
        };
        Ok(())
    }

    /// Handles a closing tag. Returns whether there is nothing more to read.
    fn end(&mut self, name: &str) -> Result<bool, String> {
        match name {
            "StepMap" => self.map_ends()?,
            "Step" => self.step_ends()?,
            "Data" => self.run.end(),
            "Analysis" => {
                self.is_complete = true;
                return Ok(true);
            }
            _ => {}
        }
        Ok(false)
    }

    /// Adds a component of the last entity.
    fn component(&mut self, e: &BytesStart<'_>) -> Result<(), String> {
        let name = attribute(e, "name")?.ok_or("a Component without a name")?;
        let id = whole(attribute(e, "id")?).ok_or("a Component without a number (id)")?;
        let unit = attribute(e, "unitsValue")?;
        if self.width > 0 {
            return Err("a Component after the first Data".into());
        }
        let entity = self.run.entities.last_mut();
        let entity = entity.ok_or("a Component outside of an Entity")?;
        let column = match entity.name.as_str() {
            "time" if name == "TIME" => "time".into(),
            EXPRESSIONS => name.clone(),
            owner => format!("{owner}.{name}"),
        };
        let unit = unit.unwrap_or_else(|| component_unit(&name, &self.run.units));
        self.run.columns.push(Column {
            name: column,
            unit,
            values: Vec::new(),
            bar_of: None,
        });
        entity.components.push(Component {
            name,
            column: self.run.columns.len() - 1,
        });
        self.ids.push(id);
        Ok(())
    }

    /// Completes the map: puts the columns in the order of their numbers.
    fn map_ends(&mut self) -> Result<(), String> {
        if self.width > 0 {
            return Ok(());
        }
        if self.ids.is_empty() {
            return Err("there is no Component before the first Data".into());
        }
        // the order of the numbers
        let mut by_id: Vec<usize> = (0..self.ids.len()).collect();
        by_id.arrange_by_key(|&c| self.ids[c]);
        if let Some(pair) = by_id.windows(2).find(|w| self.ids[w[0]] == self.ids[w[1]]) {
            let id = self.ids[pair[0]];
            return Err(format!("the number {id} is given to two components"));
        }
        // columns and components in that order
        self.rearrange(&by_id);
        if self.run.columns[0].name != "time" {
            return Err("the component with the lowest number is not TIME".into());
        }
        self.force_unit();
        self.width = by_id.len();
        self.ids.sort_unstable();
        Ok(())
    }

    /// Rearranges the columns; drops time and expressions from the entities.
    fn rearrange(&mut self, order: &[usize]) {
        let mut new_place = vec![0; order.len()];
        for (place, &column) in order.iter().enumerate() {
            new_place[column] = place;
        }
        let mut old = std::mem::take(&mut self.run.columns);
        let column = |&c: &usize| std::mem::take(&mut old[c]);
        self.run.columns = order.iter().map(column).collect();
        let columns = &self.run.columns;
        for entity in &mut self.run.entities {
            for component in &mut entity.components {
                component.column = new_place[component.column];
            }
            let is_time = |c: &Component| columns[c.column].name == "time";
            entity.components.retain(|c| !is_time(c));
        }
        let shown = |e: &Entity| !e.components.is_empty() && e.name != EXPRESSIONS;
        self.run.entities.retain(shown);
    }

    /// Takes the unit of forces, which the units of the file do not tell, from the first FX.
    fn force_unit(&mut self) {
        let components = self.run.entities.iter().flat_map(|e| &e.components);
        let units = components
            .filter(|c| c.name == "FX" && !self.run.columns[c.column].unit.is_empty())
            .map(|c| c.column);
        if let Some(first) = units.min() {
            self.run.units.force = self.run.columns[first].unit.clone();
        }
    }

    /// Adds the numbers of a piece of text to the row.
    fn numbers(&mut self, text: &str) -> Result<(), String> {
        let last = self.ids.last().copied().unwrap_or(0);
        let last = usize::try_from(last).unwrap_or(usize::MAX);
        let most = last.max(self.width);
        for word in text.split_ascii_whitespace() {
            if self.row.len() >= most {
                let width = self.width;
                let what = format!("a step has more values than there are components ({width})");
                return Err(what);
            }
            let value = number(word).ok_or_else(|| format!("`{word}` is no number"))?;
            self.row.push(value);
        }
        Ok(())
    }

    fn step_ends(&mut self) -> Result<(), String> {
        self.in_step = false;
        let (given, width) = (self.row.len(), self.width);
        let last = self.ids.last().copied();
        let dense = last == Some(width as u64);
        if given == width {
            self.run.push(&self.row);
            return Ok(());
        }
        if dense || last != Some(given as u64) {
            return Err(format!(
                "a step has {} where there are {}",
                counted(given, "value"),
                counted(width, "component")
            ));
        }
        // components were taken out of the map, not out of the steps: the number is the place
        let value = |id: &u64| {
            let place = (*id as usize).wrapping_sub(1);
            self.row.get(place).copied().unwrap_or(f64::NAN)
        };
        let row: Vec<f64> = self.ids.iter().map(value).collect();
        self.run.push(&row);
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

/// Returns the value of an attribute, where the tag has it.
fn attribute(e: &BytesStart<'_>, name: &str) -> Result<Option<String>, String> {
    let found = e.try_get_attribute(name).map_err(|e| e.to_string())?;
    let value = found.map(|a| {
        a.normalized_value(XmlVersion::Implicit1_0)
            .map(|v| v.into_owned())
    });
    value.transpose().map_err(|e| e.to_string())
}

/// Reads a whole number of an attribute.
fn whole(text: Option<String>) -> Option<u64> {
    text?.trim().parse().ok()
}
