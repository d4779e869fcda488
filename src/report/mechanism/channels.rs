//! The channels of a page: columns of a run that are shown as numbers at the cursor and as curves.
//!
//! Columns of the tables come first, to seven digits. Then follow the components of the elements,
//! to six, until the page would become too large; those that are left out are counted.

use super::pack::Packed;
use super::track::Track;
use crate::results::{Entity, Run};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Rounding of a column of the tables, as a part of its largest value.
const TABLE_QUANTUM: f64 = 1e-7;
/// Rounding of another column, as a part of its largest value.
const QUANTUM: f64 = 1e-6;
/// Packed bytes, before compression, beyond which no further column is added.
const MOST_BYTES: usize = 1_000_000;

/// The channels of a run.
pub struct Channels<'a> {
    run: &'a Run,
    track: &'a Track,
    /// name, unit, packed column, whether tables show it
    pub list: Vec<Value>,
    /// columns that are left out
    pub left_out: usize,
    of_column: BTreeMap<usize, usize>,
}

impl<'a> Channels<'a> {
    /// Prepares the channels of a run.
    pub fn new(run: &'a Run, track: &'a Track) -> Self {
        Self {
            run,
            track,
            list: Vec::new(),
            left_out: 0,
            of_column: BTreeMap::new(),
        }
    }

    /// Adds columns, those first that matter most.
    pub fn pack(&mut self, packed: &mut Packed) {
        let table: Vec<usize> = if self.run.table.is_empty() {
            Vec::new()
        } else {
            self.run.table.clone()
        };
        for column in table.into_iter().filter(|c| *c > 0) {
            self.push(packed, column, true);
        }
        let part = |e: &&Entity| e.kind == "Part";
        let (parts, others): (Vec<&Entity>, Vec<&Entity>) =
            self.run.entities.iter().partition(part);
        let of = |e: &&Entity| e.components.iter().map(|c| c.column).collect::<Vec<_>>();
        let mut columns: Vec<usize> = others.iter().flat_map(of).collect();
        // positions, velocities, accelerations: of all parts in turn
        for level in 0..3 {
            let part = |e: &&Entity| {
                of(e)
                    .into_iter()
                    .skip(6 * level)
                    .take(6)
                    .collect::<Vec<_>>()
            };
            columns.extend(parts.iter().flat_map(part));
        }
        for column in columns {
            if self.of_column.contains_key(&column) {
                continue;
            }
            if packed.len() > MOST_BYTES {
                self.left_out += 1;
            } else {
                self.push(packed, column, false);
            }
        }
    }

    fn push(&mut self, packed: &mut Packed, column: usize, is_table: bool) {
        let of = &self.run.columns[column];
        let values = || self.track.rows.iter().map(|&row| of.at(row));
        let finite = values().filter(|x| x.is_finite());
        let largest = finite.fold(0.0_f64, |a, x| a.max(x.abs()));
        let part = if is_table { TABLE_QUANTUM } else { QUANTUM };
        let at = packed.push(values(), part * largest);
        self.of_column.insert(column, self.list.len());
        (self.list)
            .push(json!({ "name": of.name, "unit": of.unit, "column": at, "table": is_table }));
    }

    /// Returns the channels of columns; `null` of one that is left out.
    pub fn of(&self, columns: &[usize]) -> Vec<Value> {
        let of = |c: &usize| self.of_column.get(c).map_or(Value::Null, |k| json!(k));
        columns.iter().map(of).collect()
    }

    /// Returns the sets of results: name of the element, its number, and channels with the names of
    /// the components.
    pub fn sets(&self, run: &Run) -> Vec<Value> {
        let of = |e: &Entity| {
            let known = e.components.iter().filter_map(|c| {
                let channel = self.of_column.get(&c.column)?;
                Some(json!([c.name, channel]))
            });
            json!({ "element": e.entity, "name": e.name, "number": e.id, "components": known.collect::<Vec<_>>() })
        };
        run.entities.iter().map(of).collect()
    }
}
