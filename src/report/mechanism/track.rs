//! The track of a run: where each body is, and what each force is, at every row.
//!
//! Poses come from the columns of the run alone, those of the sets `…_XFORM`; a run that was read
//! from a file of results does as well as one that has just been solved.

use super::bodies::Bodies;
use crate::diagnostic::Diagnostic;
use crate::model::{ElementId, Family, Model};
use crate::results::{Entity, Kind, Run, Switched};
use crate::space::{Frame, Vec3, rotation};
use std::collections::{BTreeMap, BTreeSet};

/// Components of a pose in a set of results: position and 3-1-3 angles in ground.
const POSE: [&str; 6] = ["X", "Y", "Z", "PSI", "THETA", "PHI"];
/// Components of a force and a torque in a set of results, in ground axes.
const LOAD: [&str; 6] = ["FX", "FY", "FZ", "TX", "TY", "TZ"];
/// Components of a place in a set of results, in ground.
const PLACE: [&str; 3] = ["X", "Y", "Z"];

/// The places of the bodies of a model, and its forces, at every row of a run.
#[derive(Clone, Debug, Default)]
pub struct Track {
    /// place of each row in [`Column::values`](crate::results::Column)
    pub rows: Vec<usize>,
    /// clock at each row; two rows may have the same
    pub times: Vec<f64>,
    /// kind of simulation of each row
    pub kinds: Vec<Kind>,
    /// frames of each body in ground, one a row; empty where the run has none
    pub poses: Vec<Vec<Frame<f64>>>,
    /// forces that the run knows
    pub loads: Vec<Load>,
    /// elements that are switched off at some rows: from a row to before another
    pub off: BTreeMap<ElementId, Vec<[usize; 2]>>,
}

/// The force and torque of an element on its first marker, ground axes.
#[derive(Clone, Debug)]
pub struct Load {
    /// the element
    pub element: ElementId,
    /// the columns of the run that it is read from
    pub columns: [usize; 6],
    /// fx, fy, fz, tx, ty, tz at each row; NaN where the run has no value
    pub values: Vec<[f64; 6]>,
    /// columns of where it acts in ground, of an element that says so, such as a contact
    pub place_columns: Option<[usize; 3]>,
    /// the same at each row; empty: it acts on a marker
    pub places: Vec<[f64; 3]>,
}

impl Track {
    /// Finds the columns of a run that tell where the bodies are.
    ///
    /// # Errors
    /// When the run has no row, or no position of any body that moves.
    pub fn new(model: &Model, bodies: &Bodies, run: &Run) -> Result<Self, Diagnostic> {
        let rows: Vec<usize> = run.table_places(0..run.rows()).collect();
        let kinds = run.table_rows().filter(|row| *row >= run.released);
        let kind = |row: usize| {
            let of = run.sequences.iter().find(|s| s.rows.contains(&row));
            of.map_or(Kind::Dynamic, |s| s.kind)
        };
        let time = &run.columns[0].values;
        let mut this = Self {
            times: rows.iter().map(|&row| time[row]).collect(),
            kinds: kinds.map(kind).collect(),
            rows,
            ..Self::default()
        };
        let moving = |b: &super::Body| !b.is_ground;
        for body in &bodies.all {
            let columns = moving(body).then(|| pose_columns(run, body.id, &body.name));
            this.poses.push(
                columns
                    .flatten()
                    .map_or_else(Vec::new, |c| this.frames(run, &c)),
            );
        }
        let is_without = this.poses.iter().all(Vec::is_empty) && bodies.all.iter().any(moving);
        if this.rows.is_empty() || is_without {
            let what = "the run does not say where the bodies of this model are";
            return Err(Diagnostic::error("no_positions", what).help(
                "results with all parts are written by cognate run MODEL --format res; \
                 cognate animate MODEL.acf solves by itself",
            ));
        }
        this.loads(model, run);
        this.switches(model, run);
        Ok(this)
    }

    /// Finds the rows at which elements are switched off; a run that does not say so has those of
    /// its model off all the time.
    fn switches(&mut self, model: &Model, run: &Run) {
        for (row, place) in self.rows.iter().enumerate() {
            let before = |s: &&Switched| s.row <= run.released + place;
            let inactive = match run.switched.iter().rfind(before) {
                Some(switched) => &switched.inactive,
                None if run.switched.is_empty() => &model.inactive,
                None => continue,
            };
            for &id in inactive {
                let spans = self.off.entry(id).or_default();
                match spans.last_mut() {
                    Some(last) if last[1] == row => last[1] = row + 1,
                    _ => spans.push([row, row + 1]),
                }
            }
        }
    }

    /// Returns whether an element acts at a row.
    pub fn is_active(&self, id: ElementId, row: usize) -> bool {
        let spans = self.off.get(&id).into_iter().flatten();
        !spans
            .into_iter()
            .any(|&[from, to]| (from..to).contains(&row))
    }

    /// Returns the elements that act at no row.
    pub fn never_active(&self) -> BTreeSet<ElementId> {
        let all = [0, self.rows.len()];
        let never = self.off.iter().filter(|(_, spans)| **spans == [all]);
        never.map(|(&id, _)| id).collect()
    }

    /// Returns the frames of a body at all rows; a row without numbers repeats the one before.
    fn frames(&self, run: &Run, columns: &[usize; 6]) -> Vec<Frame<f64>> {
        let degrees = columns.map(|c| run.columns[c].unit.to_lowercase().starts_with("deg"));
        let value = |row: usize, c: usize| {
            let x = run.value(columns[c], row);
            if degrees[c] { x.to_radians() } else { x }
        };
        let mut last = Frame::identity();
        let mut all: Vec<Frame<f64>> = Vec::with_capacity(self.rows.len());
        for &row in &self.rows {
            let x = [0, 1, 2, 3, 4, 5].map(|c| value(row, c));
            if x.iter().all(|x| x.is_finite()) {
                last = Frame {
                    rotation: rotation::from_313(x[3], x[4], x[5]),
                    position: Vec3([x[0], x[1], x[2]]),
                };
            }
            all.push(last);
        }
        all
    }

    /// Finds the forces and torques of elements.
    fn loads(&mut self, model: &Model, run: &Run) {
        let acts = |id: &ElementId| matches!(id.kind.family(), Family::Force | Family::Constraint);
        let mut seen = BTreeSet::new();
        let labels = model.labels();
        for (element, _) in model.elements().into_iter().filter(|(id, _)| acts(id)) {
            let name = labels.name(model, element);
            let mut sets = run.entities.iter();
            let is_its = |e: &&Entity| {
                e.id == u64::from(element.number) && (e.entity == name || e.name == name)
            };
            let found = sets.find_map(|e| {
                let columns = Some(e).filter(is_its).and_then(|e| columns_of(e, LOAD))?;
                Some((columns, columns_of(e, PLACE)))
            });
            let Some((columns, place_columns)) = found.filter(|(c, _)| seen.insert(c[0])) else {
                continue;
            };
            let value = |c: usize, row: usize| run.value(c, row);
            let values = self.rows.iter().map(|&row| columns.map(|c| value(c, row)));
            let values = values.collect();
            let places = place_columns.map_or_else(Vec::new, |place| {
                let at = |row: usize| place.map(|c| value(c, row));
                self.rows.iter().map(|&row| at(row)).collect()
            });
            self.loads.push(Load {
                element,
                columns,
                values,
                place_columns,
                places,
            });
        }
    }

    /// Returns the frame of a body at a row; where the run has none, where the dataset places it.
    pub fn frame(&self, bodies: &Bodies, body: usize, row: usize) -> Frame<f64> {
        let known = self.poses[body].get(row).copied();
        known.unwrap_or(bodies.all[body].placed)
    }
}

/// Returns the columns of the components of a set, if it has all of them.
fn columns_of<const N: usize>(entity: &Entity, names: [&str; N]) -> Option<[usize; N]> {
    let column = |name: &str| entity.components.iter().find(|c| c.name == name);
    let found = names.map(|name| column(name).map(|c| c.column));
    found
        .iter()
        .all(Option::is_some)
        .then(|| found.map(Option::unwrap_or_default))
}

/// Returns the columns of the pose of a body: those of its set, or columns of such names.
fn pose_columns(run: &Run, id: ElementId, name: &str) -> Option<[usize; 6]> {
    let set = format!("{name}_XFORM");
    let is_its = |e: &&Entity| e.name == set || e.entity == name;
    let is_alike =
        |e: &&Entity| e.name.eq_ignore_ascii_case(&set) || e.entity.eq_ignore_ascii_case(name);
    let of_name = run.entities.iter().filter(is_its);
    let of_name = of_name.chain(run.entities.iter().filter(is_alike));
    // a file of another program may have names of its own; then the number tells
    let of_number = (run.entities.iter())
        .filter(|e| e.kind == "Part" && e.id == u64::from(id.number) && id.number > 0);
    let mut sets = of_name.chain(of_number);
    let in_set = sets.find_map(|e| columns_of(e, POSE));
    in_set.or_else(|| {
        let found = POSE.map(|c| run.find(&format!("{set}.{c}")));
        found
            .iter()
            .all(Option::is_some)
            .then(|| found.map(Option::unwrap_or_default))
    })
}
