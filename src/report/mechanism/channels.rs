//! The channels of a page: columns of a run that are shown as numbers at the cursor and as curves.
//!
//! Columns of the tables come first, to seven digits. Then follow the components of the elements,
//! to six, until the page would become too large; those that are left out are counted. A value
//! below its bar of error, or below the rounding of the largest value of its unit, is zero.

use super::pack::Packed;
use super::track::Track;
use crate::results::{Column, Entity, Run};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Rounding of a column of the tables, as a part of its largest value.
const TABLE_QUANTUM: f64 = 1e-7;
/// Rounding of another column, as a part of its largest value.
const QUANTUM: f64 = 1e-6;
/// Packed bytes, before compression, beyond which no further column is added.
const MOST_BYTES: usize = 1_000_000;

/// Part of the largest value of a unit below which a value is rounding.
const ROUNDING: f64 = 1e-12;

/// The channels of a run.
pub struct Channels<'a> {
    run: &'a Run,
    track: &'a Track,
    /// name, unit, packed column, whether tables show it
    pub list: Vec<Value>,
    /// columns that are left out
    pub left_out: usize,
    of_column: BTreeMap<usize, usize>,
    /// for each unit the size below which its values are rounding
    rounding: BTreeMap<&'a str, f64>,
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
            rounding: rounding(run),
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
        let floor = self.rounding.get(of.unit.as_str()).copied().unwrap_or(0.0);
        let bars = self.run.bars(column).map(|bars| &self.run.columns[bars]);
        let known = |row: usize| {
            let (x, bar) = (of.at(row), bars.map_or(0.0, |bars| bars.at(row)));
            if x.abs() <= floor.max(bar) { 0.0 } else { x }
        };
        let values = || self.track.rows.iter().map(|&row| known(row));
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

/// Returns for each unit the size below which values are rounding; numbers without a unit are not
/// comparable.
fn rounding(run: &Run) -> BTreeMap<&str, f64> {
    let mut all = BTreeMap::new();
    let comparable = |c: &&Column| !c.unit.is_empty() && c.bar_of.is_none();
    for column in run.columns.iter().skip(1).filter(comparable) {
        let finite = column.values.iter().filter(|x| x.is_finite());
        let largest = finite.fold(0.0_f64, |a, x| a.max(x.abs()));
        let size = all.entry(column.unit.as_str()).or_insert(0.0_f64);
        *size = size.max(ROUNDING * largest);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Kind, Units};

    #[test]
    fn values_below_their_bar_or_below_the_rounding_of_their_unit_are_zero() {
        let mut run = Run::new("noise", "", Units::default());
        let large = run.add_column("large", "rad");
        let noise = run.add_column("noise", "rad");
        let small = run.add_column("small", "mm");
        let measured = run.add_column("measured", "mm");
        let bars = run.add_column("measured ±", "mm");
        run.columns[bars].bar_of = Some(measured);
        run.begin(Kind::Dynamic);
        run.push(&[0.0, 2.0, 8.97e-16, 1e-9, 3e-7, 1e-6]);
        run.push(&[1.0, 1.0, -1e-15, 2e-9, 5e-3, 1e-6]);
        run.end();
        run.table = vec![0, large, noise, small, measured];
        let track = Track {
            rows: vec![0, 1],
            ..Track::default()
        };
        let (mut channels, mut packed) = (Channels::new(&run, &track), Packed::default());
        channels.pack(&mut packed);
        let (columns, bytes) = packed.finish();
        let shown = |k: usize| super::super::pack::tests::read(&columns[k], &bytes, 2);
        assert_eq!(shown(1), [0.0, 0.0]);
        assert!(
            (shown(2)[1] - 2e-9).abs() < 1e-15,
            "what is alone of its unit stays"
        );
        let [first, second] = shown(3)[..] else {
            panic!()
        };
        assert!(first == 0.0 && (second - 5e-3).abs() < 1e-9);
    }
}
