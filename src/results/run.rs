//! The results of a run as a table: named columns of one length, and which rows belong to what.

use super::{Event, Record, Units};
use crate::model::{ElementId, RequestKind};
use std::collections::BTreeSet;
use std::ops::Range;

/// The results of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// base name of the files a run writes
    pub name: String,
    /// title line of the dataset
    pub title: String,
    /// units of the model as result files spell them
    pub units: Units,
    /// all columns, of one length, in the order of their identifiers in `.res` files; the first is
    /// time
    pub columns: Vec<Column>,
    /// elements and the columns that are their components
    pub entities: Vec<Entity>,
    /// requests, of which some of the entities are the components
    pub requests: Vec<Requested>,
    /// columns that tables (`.csv`, plots) show, in order; empty: all
    pub table: Vec<usize>,
    /// which rows belong to which simulation
    pub sequences: Vec<Sequence>,
    /// elements that were switched off, and from which row on; files of results do not hold it
    pub switched: Vec<Switched>,
    /// status, counts and timings
    pub record: Record,
    /// what happened, in order, as the `.msg` file tells it
    pub log: Vec<Event>,
    /// rows at the beginning that have been written to files and are no longer held
    pub released: usize,
    /// tables for other tools have a column `phase` with the kind of simulation of each row:
    /// equilibria and motion follow each other, and their rows may share a time
    pub has_phases: bool,
}

/// One quantity over all rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Column {
    /// `time`, `PART_2_XFORM.X`, or the text of an expression
    pub name: String,
    /// `mm`, `rad/sec` …; empty: a pure number or unknown
    pub unit: String,
    /// one per row that is held: all but the first [`Run::released`]
    pub values: Vec<f64>,
    /// index of the column whose errors it bounds, of a bar
    pub bar_of: Option<usize>,
}

impl Column {
    /// Returns the value at a place among the rows that are held; NaN where there is none.
    pub(crate) fn at(&self, place: usize) -> f64 {
        self.values.get(place).copied().unwrap_or(f64::NAN)
    }

    /// Returns a column of the same name and unit without values.
    pub fn empty(&self) -> Self {
        Self {
            name: self.name.clone(),
            unit: self.unit.clone(),
            values: Vec::new(),
            bar_of: self.bar_of,
        }
    }
}

/// An element of the model that results belong to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Entity {
    /// name of its result set, for example `PART_2_XFORM`
    pub name: String,
    /// name of the element, for example `PART_2`
    pub entity: String,
    /// `Part`, `Joint`, `Single_Component_Force`, `ADAMS_Variable`, `Request` …
    pub kind: String,
    /// number of the element in the dataset; 0 when unknown
    pub id: u64,
    /// its components, in the order shown
    pub components: Vec<Component>,
}

/// One component of an [`Entity`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Component {
    /// `X`, `PSI`, `FX`, `Q` …
    pub name: String,
    /// index in [`Run::columns`], whose unit it has
    pub column: usize,
}

/// A REQUEST as `.req` files list it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Requested {
    /// its number
    pub id: u32,
    /// 1 DISPLACEMENT, 2 VELOCITY, 3 ACCELERATION, 4 FORCE, 5 expressions
    pub kind: u32,
    /// numbers of I, J and RM; 0: there is none
    pub markers: [u32; 3],
    /// indices in [`Run::columns`] of its eight components
    pub columns: [Option<usize>; 8],
}

impl Requested {
    /// Makes the entry of a REQUEST whose components have no columns so far.
    pub fn new(id: u32, request: &RequestKind) -> Self {
        let (kind, markers) = match *request {
            RequestKind::Displacement { i, j, rm } => (1, [Some(i), j, rm]),
            RequestKind::Velocity { i, j, rm } => (2, [Some(i), j, rm]),
            RequestKind::Acceleration { i, j, rm } => (3, [Some(i), j, rm]),
            RequestKind::Force { i, j, rm } => (4, [Some(i), j, rm]),
            RequestKind::Functions(_) | RequestKind::User(_) => (5, [None; 3]),
        };
        Self {
            id,
            kind,
            markers: markers.map(|marker| marker.unwrap_or(0)),
            columns: [None; 8],
        }
    }
}

/// A kind of rows: what the model did in them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// the model as it was read, not assembled
    Input,
    /// after assembly, at the start of a simulation
    InitialConditions,
    /// an equilibrium
    Static,
    /// a row of equilibria
    QuasiStatic,
    /// moved by its motions alone
    Kinematic,
    /// integrated
    Dynamic,
}

impl Kind {
    /// All kinds with their names in `.res` files: of the data block, of its steps.
    pub const NAMES: [(Kind, &'static str, &'static str); 6] = [
        (Kind::Input, "modelInput", "input"),
        (
            Kind::InitialConditions,
            "initialConditions",
            "initialConditions",
        ),
        (Kind::Static, "static", "static"),
        (Kind::QuasiStatic, "quasiStatic", "quasiStatic"),
        (Kind::Kinematic, "kinematic", "kinematic"),
        (Kind::Dynamic, "dynamic", "dynamic"),
    ];

    /// Returns the name of its data blocks in `.res` files, without the number.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize].1
    }
    /// Returns the type of its steps in `.res` files.
    pub fn step(self) -> &'static str {
        Self::NAMES[self as usize].2
    }
}

/// The elements that are switched off from a row on, until the next entry.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Switched {
    /// the first row
    pub row: usize,
    /// the elements that do not act
    pub inactive: BTreeSet<ElementId>,
}

/// Consecutive rows that one simulation produced.
#[derive(Clone, Debug, PartialEq)]
pub struct Sequence {
    /// `dynamic_001`
    pub name: String,
    /// what the model did in its rows
    pub kind: Kind,
    /// which rows
    pub rows: Range<usize>,
}

/// Adds what a longer list has beyond one that is its beginning.
pub(super) fn catch_up<T: Clone>(list: &mut Vec<T>, longer: &[T]) {
    list.truncate(longer.len());
    list.extend_from_slice(&longer[list.len()..]);
}

/// Numbers for which room is made ahead, at most.
const MOST_RESERVED: usize = 1 << 20;
/// End of the name of a column of bars of error.
const BAR: char = '±';

impl Run {
    /// Makes a run without rows, whose first column is time.
    pub fn new(name: impl Into<String>, title: impl Into<String>, units: Units) -> Self {
        let time = Column {
            name: "time".into(),
            unit: units.time.clone(),
            values: Vec::new(),
            bar_of: None,
        };
        Self {
            name: name.into(),
            title: title.into(),
            units,
            columns: vec![time],
            ..Self::default()
        }
    }
    /// Adds a column and returns its index. All columns are added before the first row.
    pub fn add_column(&mut self, name: impl Into<String>, unit: impl Into<String>) -> usize {
        self.columns.push(Column {
            name: name.into(),
            unit: unit.into(),
            values: Vec::new(),
            bar_of: None,
        });
        self.columns.len() - 1
    }
    /// Adds columns for the bars of error of all columns but time; tables show each beside its
    /// column. They have no values so far.
    pub fn add_bars(&mut self) {
        let shown = self.table_columns();
        let n = self.columns.len();
        for of in 1..n {
            let column = &self.columns[of];
            let bar = Column {
                name: format!("{}{BAR}", column.name),
                unit: column.unit.clone(),
                values: vec![f64::NAN; column.values.len()],
                bar_of: Some(of),
            };
            self.columns.push(bar);
        }
        let bar_of = |of: usize| of.checked_sub(1).map(|k| n + k);
        self.table = (shown.into_iter())
            .flat_map(|of| std::iter::once(of).chain(bar_of(of)))
            .collect();
    }
    /// Marks as bars of error the columns of a table that was read which are named so: `slider.X±`
    /// are those of `slider.X`.
    pub fn find_bars(&mut self) {
        for bar in 0..self.columns.len() {
            let named = self.columns[bar].name.strip_suffix(BAR);
            let of = named.and_then(|name| self.columns.iter().position(|c| c.name == name));
            self.columns[bar].bar_of = self.columns[bar].bar_of.or(of);
        }
    }
    /// Returns the index of the column of bars of a column, if it has one.
    pub fn bars(&self, of: usize) -> Option<usize> {
        self.columns.iter().position(|c| c.bar_of == Some(of))
    }
    /// Adds a row: time and one value for each further column, in order; missing ones are NaN.
    pub fn push(&mut self, row: &[f64]) {
        for (column, index) in self.columns.iter_mut().zip(0..) {
            column
                .values
                .push(row.get(index).copied().unwrap_or(f64::NAN));
        }
    }
    /// Adds rows of equal width that stand one behind the other, each as [`Run::push`] does.
    pub(crate) fn push_block(&mut self, block: &[f64], width: usize) {
        let n_rows = block.len() / width;
        for (column, index) in self.columns.iter_mut().zip(0..) {
            if n_rows == 1 && index < width {
                column.values.push(block[index]);
            } else if index < width {
                let values = block.iter().skip(index).step_by(width);
                column.values.extend(values);
            } else {
                let all = column.values.len() + n_rows;
                column.values.resize(all, f64::NAN);
            }
        }
    }
    /// Makes room for further rows, and at once for those that are known to follow later.
    pub(crate) fn reserve(&mut self, n_rows: usize, more: usize) {
        let most = MOST_RESERVED / self.columns.len().max(1);
        for column in &mut self.columns {
            let values = &mut column.values;
            if values.capacity() - values.len() < n_rows {
                values.reserve(n_rows + more.min(most));
            }
        }
    }
    /// Begins a sequence at the next row; it is named by its kind and number.
    pub fn begin(&mut self, kind: Kind) {
        let number = self.sequences.iter().filter(|s| s.kind == kind).count() + 1;
        let rows = self.rows()..self.rows();
        self.sequences.push(Sequence {
            name: format!("{}_{number:03}", kind.name()),
            kind,
            rows,
        });
    }
    /// Notes the elements that are switched off in the rows that follow.
    pub(crate) fn switch(&mut self, inactive: &BTreeSet<ElementId>) {
        let before = self.switched.last().map(|s| &s.inactive);
        if before.map_or(!inactive.is_empty(), |before| before != inactive) {
            let (row, inactive) = (self.rows(), inactive.clone());
            self.switched.push(Switched { row, inactive });
        }
    }
    /// Ends the last sequence after the last row.
    pub fn end(&mut self) {
        let rows = self.rows();
        if let Some(last) = self.sequences.last_mut() {
            last.rows.end = rows;
        }
    }
    /// Keeps the rows of some sequences and drops all others.
    pub fn keep_sequences(&mut self, keep: impl Fn(&Sequence) -> bool) {
        self.sequences.retain(keep);
        self.switched.clear();
        for column in &mut self.columns {
            let kept = self
                .sequences
                .iter()
                .filter_map(|s| column.values.get(s.rows.clone()));
            column.values = kept.flatten().copied().collect();
        }
        let mut at = 0;
        for sequence in &mut self.sequences {
            let length = sequence.rows.len();
            sequence.rows = at..at + length;
            at += length;
        }
    }
    /// Drops the second, fourth, sixth … row of a run that holds all its rows, and its sequences.
    pub fn keep_every_second(&mut self) {
        self.sequences.clear();
        self.switched.clear();
        for column in &mut self.columns {
            column.values = column.values.iter().step_by(2).copied().collect();
        }
    }
    /// Appends the rows of another run with the same columns.
    pub fn append(&mut self, other: Run) {
        let from = self.rows();
        for (own, more) in self.columns.iter_mut().zip(other.columns) {
            own.values.extend(more.values);
        }
        for sequence in other.sequences {
            let rows = from + sequence.rows.start..from + sequence.rows.end;
            match self.sequences.last_mut() {
                Some(last) if last.name == sequence.name && last.rows.end == rows.start => {
                    last.rows.end = rows.end;
                }
                _ => self.sequences.push(Sequence { rows, ..sequence }),
            }
        }
    }
    /// Becomes a later state of the same run; what has been copied before is copied again only
    /// where it is no longer the beginning.
    pub fn catch_up(&mut self, later: &Run) {
        if !self.begins(later) {
            self.clone_from(later);
            return;
        }
        for (own, more) in self.columns.iter_mut().zip(&later.columns) {
            if own.values.capacity() < more.values.len() {
                let room = more.values.capacity() - own.values.len();
                own.values.reserve_exact(room);
            }
            catch_up(&mut own.values, &more.values);
        }
        // the last one may have grown
        self.sequences.pop();
        catch_up(&mut self.sequences, &later.sequences);
        catch_up(&mut self.log, &later.log);
        self.switched.clone_from(&later.switched);
        self.record.catch_up(&later.record);
    }
    /// Returns whether a later state of the same run has the rows of this one as its first: no
    /// rows were dropped or released, no columns added.
    fn begins(&self, later: &Run) -> bool {
        let counts = |run: &Run| {
            let lists = [run.columns.len(), run.entities.len(), run.requests.len()];
            (lists, run.table.len(), run.released, run.has_phases)
        };
        let held = self.columns.first().map_or(0, |c| c.values.len());
        let has_last = |row: usize| {
            let bits = |column: &Column| column.values.get(row).map(|x| x.to_bits());
            let mut pairs = self.columns.iter().zip(&later.columns);
            pairs.all(|(own, more)| bits(own).is_some_and(|own| Some(own) == bits(more)))
        };
        let lists = [self.sequences.len(), self.log.len()];
        let later_lists = [later.sequences.len(), later.log.len()];
        held > 0
            && counts(self) == counts(later)
            && lists
                .iter()
                .zip(&later_lists)
                .all(|(own, more)| own <= more)
            && has_last(held - 1)
    }
    /// Returns the number of rows, those that are no longer held included.
    pub fn rows(&self) -> usize {
        self.released + self.columns.first().map_or(0, |c| c.values.len())
    }
    /// Returns the value of a column at a place among the rows that are held; NaN where there is
    /// none, as a caller may have taken away columns or rows.
    pub(crate) fn value(&self, column: usize, place: usize) -> f64 {
        let column = self.columns.get(column);
        column.map_or(f64::NAN, |column| column.at(place))
    }
    /// Returns the rows that are held.
    pub fn held(&self) -> Range<usize> {
        self.released..self.rows()
    }
    /// Drops the values of all rows, which somebody has written elsewhere; the rows count on.
    pub fn release(&mut self) {
        self.released = self.rows();
        for column in &mut self.columns {
            column.values.clear();
        }
    }
    /// Returns those of some rows that tables show, and of these those that are held, as places in
    /// [`Column::values`].
    pub fn table_places(&self, rows: Range<usize>) -> impl Iterator<Item = usize> + '_ {
        let held = rows.start.max(self.released)..rows.end.min(self.rows());
        self.shown(held).map(|row| row - self.released)
    }
    /// Returns the indices of the columns that tables show: [`Run::table`], or all.
    pub fn table_columns(&self) -> Vec<usize> {
        if self.table.is_empty() {
            (0..self.columns.len()).collect()
        } else {
            self.table.clone()
        }
    }
    /// Returns the rows that tables show: all but the model as it was read.
    pub fn table_rows(&self) -> impl Iterator<Item = usize> + '_ {
        self.shown(0..self.rows())
    }
    fn shown(&self, rows: Range<usize>) -> impl Iterator<Item = usize> + '_ {
        let inputs = self.sequences.iter().filter(|s| s.kind == Kind::Input);
        let inputs: Vec<Range<usize>> = inputs.map(|s| s.rows.clone()).collect();
        rows.filter(move |row| !inputs.iter().any(|rows| rows.contains(row)))
    }
    /// Returns the kind of the simulation that a row belongs to, also while that simulation goes
    /// on.
    pub fn kind_of(&self, row: usize) -> Option<Kind> {
        let begun = self.sequences.iter().rev();
        let mut begun = begun.skip_while(|s| s.rows.start > row);
        begun.next().map(|s| s.kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sequences_are_numbered_by_kind_and_hold_their_rows() {
        let mut run = Run::new("r", "t", Units::default());
        run.add_column("x", "mm");
        for (kind, rows) in [(Kind::Dynamic, 2), (Kind::Static, 1), (Kind::Dynamic, 3)] {
            run.begin(kind);
            (0..rows).for_each(|i| run.push(&[i as f64, 0.0]));
            run.end();
        }
        let names: Vec<_> = run
            .sequences
            .iter()
            .map(|s| (s.name.as_str(), s.rows.clone()))
            .collect();
        assert_eq!(
            names,
            [
                ("dynamic_001", 0..2),
                ("static_001", 2..3),
                ("dynamic_002", 3..6)
            ]
        );
    }

    #[test]
    fn a_copy_that_catches_up_is_the_run() {
        let mut run = Run::new("r", "t", Units::default());
        run.add_column("x", "mm");
        let mut copy = run.clone();
        for k in 0..9 {
            run.begin(Kind::Dynamic);
            (0..k).for_each(|i| run.push(&[f64::from(i), if i == 2 { f64::NAN } else { 0.0 }]));
            run.end();
            let simulation = crate::results::Simulation::new(Kind::Dynamic, f64::from(k));
            run.record.simulations.push(simulation);
            run.record.counts.steps += 1;
            run.log.push(Event::Command(format!("SIMULATE {k}")));
            match k {
                4 => run.keep_every_second(),
                6 => run.release(),
                7 => run.columns[1].values.fill(1.0),
                _ => (),
            }
            copy.catch_up(&run);
            assert_eq!(format!("{copy:?}"), format!("{run:?}"), "{k}");
        }
    }

    #[test]
    fn columns_are_found_without_regard_to_blanks_and_case() {
        let mut run = Run::new("r", "t", Units::default());
        run.add_column("DX(12, 21)", "mm");
        run.push(&[0.0, 4.5]);
        assert_eq!(run.column("dx(12,21)"), Some(&[4.5][..]));
        assert_eq!(run.column("DX(12,22)"), None);
    }

    #[test]
    fn a_column_is_found_by_every_name_of_its_element() {
        let mut run = Run::new("r", "t", Units::default());
        for name in [
            "CONTACT_1.FX",
            "hinge.FX",
            "POINT_MASS_3_XFORM.X",
            "JOINT_1.FY",
        ] {
            run.add_column(name, "");
        }
        run.entities.push(Entity {
            name: "hinge".into(),
            entity: "hinge".into(),
            kind: "Joint".into(),
            id: 2,
            components: vec![Component {
                name: "FX".into(),
                column: 2,
            }],
        });
        for (name, column) in [
            ("CONTACT_1.FX", Some(1)),
            ("CONTACT/1.FX", Some(1)),
            ("1-CONTACT1.fx", Some(1)),
            ("JOINT/2.FX", Some(2)),
            ("2-JOINT2.FX", Some(2)),
            ("POINT_MASS/3_XFORM.X", Some(3)),
            ("JOINT/1.FY", Some(4)),
            ("PART/2.FX", None),
            ("JOINT/2.FZ", None),
        ] {
            assert_eq!(run.find(name), column, "{name}");
        }
    }

    #[test]
    fn names_of_kinds_stand_in_the_order_of_the_kinds() {
        for (kind, block, step) in Kind::NAMES {
            assert_eq!((kind.name(), kind.step()), (block, step));
        }
    }
}
