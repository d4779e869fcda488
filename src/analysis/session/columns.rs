//! Columns of results: one formula of an instant per column.
//!
//! Parts come first, all positions, then all velocities, then all accelerations; then further
//! columns of the user's, requests, and the sets of all other elements in the order of their table
//! (`sets.rs`).

use super::Options;
use super::catalogue::{self, Catalogue, Names, Taken, expression_of};
use super::requests::{components, request_sets};
use super::selection::{Omission, Selection, omits};
use super::sets::{self, Contents, Piece, SETS, Source};
use super::shown::{Origin, Unit, Values, What, origins};
use crate::expr::dimension::Dimension;
use crate::expr::program::{Input, Program, Work};
use crate::model::{ElementId, ElementKind, Formula, Labels, Model, Part, RequestKind, Text};
use crate::results::{self, Entity, Requested, Run, Units};
use crate::scalar::Scalar;
use crate::scene::configuration::Configured;
use crate::scene::equations::{Equations, Unsupported};
use crate::scene::layout::Layout;
use crate::scene::programs::record_with_complaints;
use crate::scene::recorder::Recorder;
use std::collections::{BTreeMap, BTreeSet};

/// A column as it is evaluated.
#[derive(Clone, Debug)]
struct Shown {
    what: What,
    /// the request it belongs to, which a command may switch off
    request: Option<ElementId>,
}

/// The columns of a run in the order of its table of all columns, time left out.
#[derive(Debug, Default)]
pub struct Columns {
    shown: Vec<Shown>,
    /// expressions to compile with each scene: (name, text)
    pub extra: Vec<(String, Text)>,
    /// bodies whose motion from where they began is shown, with the markers at their centres
    bodies: Vec<(ElementId, Option<u32>)>,
    /// where these began
    origins: BTreeMap<ElementId, Origin>,
    /// columns that the user has asked for, which tables show beside requests
    wished: Vec<usize>,
    /// texts of the choice before, which have been read
    known: Vec<(String, Text)>,
    /// names so far, while columns are declared
    names: Names,
    /// nothing was asked for: they are those of every run
    by_default: bool,
}

/// Returns the unit of what an expression yields, where it is a single measure.
pub(in crate::analysis) fn unit_of(text: &Text, units: &Units) -> String {
    let input = text.ast().ok().and_then(|ast| ast.input(ast.root));
    let Some(Input::Measure(measure, [_, _, component, _])) = input else {
        return String::new();
    };
    let (l, t, f, a) = (&units.length, &units.time, &units.force, &units.angle);
    match measure.row().dimension {
        Dimension::Length => l.clone(),
        Dimension::Angle => a.clone(),
        Dimension::Velocity => format!("{l}/{t}"),
        Dimension::AngularVelocity => format!("{a}/{t}"),
        Dimension::Acceleration => format!("{l}/{t}**2"),
        Dimension::AngularAcceleration => format!("{a}/{t}**2"),
        Dimension::Force => f.clone(),
        Dimension::Torque => format!("{f}-{l}"),
        // NAME(id, jflag, comp, rm): components 1 to 4 are of the force, 5 to 8 of the torque
        Dimension::ForceOrTorque => match component {
            1..=4 => f.clone(),
            5..=8 => format!("{f}-{l}"),
            _ => String::new(),
        },
        Dimension::AngleOrNone
        | Dimension::ByIndex
        | Dimension::Variable
        | Dimension::Array
        | Dimension::Equation
        | Dimension::EquationRate
        | Dimension::PlantInput
        | Dimension::PlantOutput
        | Dimension::Sensor => String::new(),
    }
}

/// Components of the motion of a body's centre of mass, level by level, and the names of the sets.
const BODY_LEVELS: [(&str, [&str; 8]); 3] = [
    (
        "DISPLACEMENT",
        ["X", "Y", "Z", "MAG", "RX", "RY", "RZ", "RMAG"],
    ),
    ("VELOCITY", ["VX", "VY", "VZ", "VM", "WX", "WY", "WZ", "WM"]),
    (
        "ACCELERATION",
        [
            "ACCX", "ACCY", "ACCZ", "ACCM", "WDTX", "WDTY", "WDTZ", "WDTM",
        ],
    ),
];
/// Words of RESULTS that leave out the levels of the motion of parts.
const LEVELS: [Omission; 3] = [
    Omission::Displacements,
    Omission::Velocities,
    Omission::Accelerations,
];

impl Columns {
    /// Declares all columns of a run: sets of all elements when `full`, requests, and `user`
    /// expressions. `computed` tells whether there is a closure for a REQUEST of this number with
    /// this USER.
    pub fn new(
        model: &Model,
        run: &mut Run,
        user: &[String],
        full: bool,
        computed: &dyn Fn(u32, &Formula) -> bool,
    ) -> Self {
        let options = Options {
            full,
            named_only: true,
            ..Options::default()
        };
        Self::chosen(
            model,
            run,
            user,
            &options.selection(),
            computed,
            Self::default(),
        )
    }

    /// Declares the columns as [`Columns::new`] does, with the sets of a selection.
    pub(super) fn chosen(
        model: &Model,
        run: &mut Run,
        user: &[String],
        selection: &Selection<'_>,
        computed: &dyn Fn(u32, &Formula) -> bool,
        before: Self,
    ) -> Self {
        run.columns.clear();
        run.entities.clear();
        run.requests.clear();
        run.add_column("time", run.units.time.clone());
        let mut this = Self {
            known: before.extra,
            names: Names::of(model),
            ..Self::default()
        };
        let is_asked = !user.is_empty() || !selection.only.is_empty();
        let unasked = !is_asked && !selection.full && !asks_for_requests(model, computed);
        let selection = &match unasked && selection.by_default {
            true => selection.of_everything(model),
            false => *selection,
        };
        this.parts(model, run, selection);
        let mut requested = Vec::new();
        if !omits(model, Omission::Requests) {
            this.requests(model, run, &mut requested, computed);
        }
        if selection.full {
            let first = run.columns.len();
            this.elements(model, run, selection);
            if !selection.only.is_empty() {
                this.wished.extend(first..run.columns.len());
            }
        }
        let mut table = vec![0];
        let asked = user.iter();
        let mut catalogue = None;
        for text in asked {
            let column = this.user(model, run, text, &mut catalogue);
            table.push(column);
        }
        table.extend(requested);
        // without wishes of its own the table has everything that is recorded
        let has_own = table.len() > 1 || !(selection.full || unasked && selection.by_default);
        table.append(&mut this.wished);
        let mut shown = BTreeSet::new();
        table.retain(|column| shown.insert(*column));
        run.table = if has_own { table } else { Vec::new() };
        (this.known, this.names) = (Vec::new(), Names::default());
        this.by_default = unasked && selection.by_default;
        this
    }

    /// Adds a column that a user asks for, unless it is there; returns its index.
    fn user(
        &mut self,
        model: &Model,
        run: &mut Run,
        text: &str,
        catalogue: &mut Option<Catalogue>,
    ) -> usize {
        if let Some(there) = run.columns.iter().position(|column| column.name == text) {
            return there;
        }
        if let Some(expression) = expression_of(model, text) {
            return self.text(run, text.to_owned(), expression, None);
        }
        let catalogue = catalogue.get_or_insert_with(|| Catalogue::of(model, &run.units));
        match catalogue.find(text) {
            Ok((unit, catalogue::Piece::Text(expression))) => {
                let column = self.text(run, text.to_owned(), expression, None);
                run.columns[column].unit = unit;
                column
            }
            Ok((unit, catalogue::Piece::Scene(what))) => {
                if let What::Body { id, centre, .. } = what {
                    let is_known = self.bodies.iter().any(|body| body.0 == id);
                    self.bodies.extend((!is_known).then_some((id, centre)));
                }
                self.push(run, text.to_owned(), unit, what)
            }
            // the mistake is told where the column is compiled
            Err(_) => self.text(run, text.to_owned(), text.into(), None),
        }
    }

    fn push(&mut self, run: &mut Run, name: String, unit: String, what: What) -> usize {
        self.shown.push(Shown {
            what,
            request: None,
        });
        let name = self.names.column(name);
        run.add_column(name, unit)
    }

    /// Adds the column of an expression; without a `unit` it has that of its measure.
    fn text(&mut self, run: &mut Run, name: String, text: Text, unit: Option<Unit>) -> usize {
        let k = self.extra.len();
        let known = self.known.get(k).map(|(_, known)| known);
        let known = known.filter(|known| **known == text).cloned();
        let text = known.unwrap_or(text);
        let unit = match unit {
            Some(unit) => unit.spelt(&run.units),
            None => unit_of(&text, &run.units),
        };
        self.extra.push((name.clone(), text));
        self.push(run, name, unit, What::Text(k))
    }

    /// Positions of all parts, then velocities, then accelerations; then the motions of bodies.
    fn parts(&mut self, model: &Model, run: &mut Run, selection: &Selection<'_>) {
        let moving = |(id, p): &(ElementId, &Part)| id.kind == ElementKind::PointMass || !p.ground;
        let is_shown = |(id, _): &(ElementId, &Part)| selection.frames || selection.has(*id);
        let all: Vec<(ElementId, &Part)> =
            (model.bodies().filter(moving).filter(is_shown)).collect();
        let first = run.entities.len();
        for &(id, _) in &all {
            let entity = self.names.element(model, id);
            run.entities.push(Entity {
                name: self.names.set(format!("{entity}_XFORM")),
                ..entity_of(entity, "Part", id)
            });
        }
        let names = [
            ["X", "Y", "Z", "PSI", "THETA", "PHI"],
            ["VX", "VY", "VZ", "WX", "WY", "WZ"],
            ["ACCX", "ACCY", "ACCZ", "WDX", "WDY", "WDZ"],
        ];
        for (level, names) in names.iter().enumerate() {
            let left_out = omits(model, LEVELS[level]);
            let asked = |id: ElementId| match level {
                0 => selection.frames || selection.has(id) && !left_out,
                _ => selection.has(id) && !left_out,
            };
            let shown = all.iter().enumerate().filter(|(_, (id, _))| asked(*id));
            for (k, &(id, _)) in shown {
                for (c, component) in names.iter().enumerate() {
                    let quantity = 6 * level + c;
                    let unit = level_unit(level, c < 3).spelt(&run.units);
                    let name = format!("{}.{component}", run.entities[first + k].name);
                    let column = self.push(run, name, unit, What::Part { id, quantity });
                    if selection.names(id) {
                        self.wished.push(column);
                    }
                    run.entities[first + k].components.push(results::Component {
                        name: (*component).into(),
                        column,
                    });
                }
            }
        }
        run.entities.retain(|entity| !entity.components.is_empty());
        for &(id, part) in all.iter().filter(|(id, _)| selection.has(*id)) {
            self.body(model, run, selection, id, part);
        }
    }

    /// Adds the sets of eight of a body: the change of the place of its centre of mass, and its
    /// velocities and accelerations where they are asked for.
    fn body(
        &mut self,
        model: &Model,
        run: &mut Run,
        selection: &Selection<'_>,
        id: ElementId,
        part: &Part,
    ) {
        let centre = part.cm;
        let levels = BODY_LEVELS.iter().zip(LEVELS).enumerate();
        let asked = |level: usize, left_out: Omission| {
            (level == 0 || selection.body_rates) && !omits(model, left_out)
        };
        for (level, ((set, names), _)) in levels.filter(|(level, (_, o))| asked(*level, *o)) {
            let entity = self.names.element(model, id);
            let name = self.names.set(format!("{entity}_{set}"));
            let mut components = Vec::new();
            for (component, of) in names.iter().enumerate() {
                let what = What::Body {
                    id,
                    centre,
                    level,
                    component,
                };
                let unit = level_unit(level, component < 4).spelt(&run.units);
                let column = self.push(run, format!("{name}.{of}"), unit, what);
                if selection.body_rates || selection.names(id) {
                    self.wished.push(column);
                }
                let name = (*of).to_owned();
                components.push(results::Component { name, column });
            }
            run.entities.push(Entity {
                name,
                components,
                ..entity_of(entity, "Body_Motion", id)
            });
        }
        self.bodies.push((id, centre));
    }

    /// Adds the sets of all other elements: variables of joints, the table, the energies.
    fn elements(&mut self, model: &Model, run: &mut Run, selection: &Selection<'_>) {
        if !omits(model, Omission::Displacements) {
            for &n in model.joints.keys() {
                let id = ElementKind::Joint.id(n);
                if selection.has(id) {
                    let name = format!("{}_VARIABLES", self.names.element(model, id));
                    let pieces = sets::joint_variables(model, n);
                    self.set(run, entity_of(name, "Joint_Variables", id), pieces);
                }
            }
        }
        let of_table = SETS
            .iter()
            .filter(|set| matches!(set.contents, Contents::Groups(_)));
        for set in of_table {
            for n in model.numbers(set.kind) {
                let id = set.kind.id(n);
                let pieces = sets::pieces(model, selection, set, n);
                if pieces.is_empty() {
                    continue;
                }
                let name = self.names.element(model, id);
                self.set(run, entity_of(name, set.word(), id), pieces);
            }
        }
        if selection.only.is_empty() {
            let entity = Entity {
                name: ENERGY.into(),
                entity: ENERGY.into(),
                kind: "Energy".into(),
                ..Entity::default()
            };
            self.set(run, entity, sets::energies());
        }
    }

    /// Adds a set of results, if it has components.
    fn set(&mut self, run: &mut Run, mut entity: Entity, pieces: Vec<Piece>) {
        if pieces.is_empty() {
            return;
        }
        entity.name = self.names.set(entity.name);
        for Piece { name, unit, source } in pieces {
            let title = format!("{}.{name}", entity.name);
            let column = match source {
                Source::Text(text) => self.text(run, title, text.into(), Some(unit)),
                Source::Scene(what) => {
                    let unit = unit.spelt(&run.units);
                    self.push(run, title, unit, what)
                }
            };
            entity.components.push(results::Component { name, column });
        }
        run.entities.push(entity);
    }

    /// Declares the columns of all requests, which are those of the table.
    fn requests(
        &mut self,
        model: &Model,
        run: &mut Run,
        table: &mut Vec<usize>,
        computed: &dyn Fn(u32, &Formula) -> bool,
    ) {
        // the requests of a MREQUEST have the numbers behind those of all others
        let mut last = model.requests.keys().copied().max().unwrap_or(0);
        for mut set in request_sets(model, &self.names.labels) {
            set.name = self.names.set(set.name);
            let number = match set.id.kind {
                ElementKind::Request => set.id.number,
                _ => {
                    last = last.saturating_add(1);
                    last
                }
            };
            let by_closure = matches!(*set.kind, RequestKind::User(_));
            let mut entity = entity_of(set.name.clone(), "Request", set.id);
            let (mut requested, mut own) = (Requested::new(number, &set.kind), Taken::default());
            for component in components(model, &set, computed) {
                let given = set.cnames.get(component.place - 1);
                if given.is_some_and(String::is_empty) {
                    continue;
                }
                let name = given.cloned().unwrap_or(component.name);
                let name = own.take(name);
                let title = format!("{}.{name}", set.name);
                let column = if by_closure {
                    let (id, place) = (set.id.number, component.place - 1);
                    let what = What::Request {
                        id,
                        component: place,
                    };
                    self.push(run, title, String::new(), what)
                } else {
                    self.text(run, title, component.text, None)
                };
                if let Some(last) = self.shown.last_mut() {
                    last.request = Some(set.id);
                }
                requested.columns[component.place - 1] = Some(column);
                table.push(column);
                entity.components.push(results::Component { name, column });
            }
            if !entity.components.is_empty() {
                run.entities.push(entity);
                run.requests.push(requested);
            }
        }
    }

    /// Notes where bodies are when the run begins.
    pub fn begin(&mut self, scene: Configured<'_>, numbers: &[f64]) {
        if self.origins.is_empty() && !self.bodies.is_empty() {
            let at = Equations::new(scene, numbers);
            self.origins = origins(&scene, &at, self.bodies.iter().copied());
        }
    }

    /// The columns as a program of an instant of which more is recorded, and what could not be
    /// supplied; bodies begin at these numbers, should the run begin there.
    pub(super) fn program_beside(
        &mut self,
        recorder: &Recorder<'_, '_>,
        numbers: &[f64],
    ) -> (Program, Vec<Unsupported>) {
        let begun = !self.origins.is_empty();
        self.begin(recorder.scene(), numbers);
        let values = self.values(recorder.scene(), recorder.at());
        if !begun {
            self.origins.clear();
        }
        recorder.program_with_complaints(&values)
    }

    /// Returns whether a column, time being 0, belongs to an element that is switched off and has
    /// nothing to show then.
    pub fn are_off(&self, column: usize, model: &Model) -> bool {
        let shown = column.checked_sub(1).and_then(|k| self.shown.get(k));
        let owner = shown.and_then(|shown| shown.request.or(shown.what.exists_by()));
        owner.is_some_and(|id| !model.is_active(id))
    }

    /// Returns whether variables of joints are among them.
    pub fn show_joint_variables(&self) -> bool {
        let mut all = self.shown.iter();
        all.any(|shown| matches!(shown.what, What::JointVariable { .. }))
    }

    /// The columns as a program of the scene, and what could not be supplied.
    pub fn program(&self, scene: Configured<'_>) -> (Program, Vec<Unsupported>) {
        record_with_complaints(scene, |at| self.values(scene, at))
    }

    /// Values of the columns at an instant of the scene.
    fn values<'s, S: Scalar>(&self, scene: Configured<'s>, at: &Equations<'s, S>) -> Vec<S> {
        let mut values = Values::new(&scene, at, &self.origins);
        let is_off = |id: ElementId| scene.inactive.contains(&id);
        (self.shown.iter())
            .map(|shown| match shown.request {
                Some(id) if is_off(id) => Scalar::constant(f64::NAN),
                _ => values.value(&shown.what),
            })
            .collect()
    }

    /// Adds a column after all others, shown by tables.
    pub fn add(&mut self, model: &Model, run: &mut Run, expression: &str) {
        let shown = run.table_columns();
        let column = self.user(model, run, expression, &mut None);
        run.table = shown;
        run.table.push(column);
    }

    /// Takes the last column away again, which [`add`](Self::add) added.
    pub fn take_back(&mut self, run: &mut Run) {
        if let Some(Shown {
            what: What::Text(_),
            ..
        }) = self.shown.pop()
        {
            self.extra.pop();
        }
        run.columns.pop();
        run.table.pop();
    }

    /// Returns the last column alone.
    pub fn last_alone(&self) -> Self {
        Self {
            shown: self.shown.last().cloned().into_iter().collect(),
            origins: self.origins.clone(),
            ..Self::default()
        }
    }

    /// Returns how a column is computed; `None`: it is time.
    pub(super) fn piece(&self, column: usize) -> Option<catalogue::Piece> {
        let shown = self.shown.get(column.checked_sub(1)?)?;
        Some(match &shown.what {
            What::Text(k) => catalogue::Piece::Text(self.extra.get(*k)?.1.clone()),
            what => catalogue::Piece::Scene(what.clone()),
        })
    }

    /// Returns whether they are recorded only because nothing was asked for.
    pub(super) fn are_by_default(&self) -> bool {
        self.by_default
    }

    /// Number of columns.
    pub fn len(&self) -> usize {
        self.shown.len()
    }

    /// Returns true if there are none.
    pub fn is_empty(&self) -> bool {
        self.shown.is_empty()
    }
}

/// Returns whether a model has requests that are computed.
fn asks_for_requests(model: &Model, computed: &dyn Fn(u32, &Formula) -> bool) -> bool {
    let sets = request_sets(model, &Labels::default());
    let is_computed = |set: &_| !components(model, set, computed).is_empty();
    !omits(model, Omission::Requests) && sets.iter().any(is_computed)
}

/// Name of the set of the energies of the model.
const ENERGY: &str = "ENERGY";

/// Returns the unit of a motion at a level: displacement, velocity, acceleration.
fn level_unit(level: usize, is_length: bool) -> Unit {
    let power = level as u8;
    match is_length {
        true => Unit::Length(power),
        false => Unit::Angle(power),
    }
}

/// Returns a set without components that has the name of its element.
fn entity_of(name: String, word: &str, id: ElementId) -> Entity {
    Entity {
        name: name.clone(),
        entity: name,
        kind: word.into(),
        id: u64::from(id.number),
        components: Vec::new(),
    }
}

/// Rows that are evaluated before they go to their columns: of each column a line of the cache or
/// more, and all of them together fit the caches.
const ROWS_OF_BLOCK: usize = 32;

/// The numbers that columns are evaluated with, from one simulation to the next.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    work: Work,
    /// rows that go to their columns together
    block: Vec<f64>,
    /// the mean over branches, the values on one of them, and which of these differ from the row's
    mean: Vec<f64>,
    other: Vec<f64>,
    changes: Vec<bool>,
}

/// Evaluates the columns at each row of numbers and appends them to the run.
pub fn append(run: &mut Run, program: &Program, rows: &[Vec<f64>]) {
    append_with(run, (program, &mut Scratch::default()), (rows, 0), |_| None);
}

/// Appends the columns as [`append`] does; `more`: rows that are known to follow later; `branches`:
/// the numbers on the branches between which the motion stays at the row of an index, and the part
/// of each in the mean that is what happens.
pub(super) fn append_with<'a>(
    run: &mut Run,
    (program, scratch): (&Program, &mut Scratch),
    (rows, more): (&[Vec<f64>], usize),
    branches: impl Fn(usize) -> Option<&'a Vec<(f64, Vec<f64>)>>,
) {
    let width = program.n_outputs() + 1;
    let room = width * rows.len().min(ROWS_OF_BLOCK);
    if scratch.block.len() < room {
        scratch.block.resize(room, 0.0);
    }
    let mut n_rows = 0;
    program.expect_runs(rows.len() + more);
    run.reserve(rows.len(), more);
    for (k, row) in rows.iter().enumerate() {
        let values = &mut scratch.block[n_rows * width..][..width];
        values[0] = row[Layout::TIME];
        program.run(row, &mut scratch.work, &mut values[1..]);
        if let Some(branches) = branches(k) {
            let Scratch {
                work,
                mean,
                other,
                changes,
                ..
            } = scratch;
            mean.clear();
            mean.resize(width - 1, 0.0);
            changes.clear();
            changes.resize(width - 1, false);
            other.resize(width - 1, 0.0);
            let values = &mut scratch.block[n_rows * width + 1..][..width - 1];
            for (part, row) in branches {
                program.run(row, work, other);
                let all = mean.iter_mut().zip(&mut *changes).zip(&*other);
                for (((mean, changes), other), value) in all.zip(&*values) {
                    *mean += part * other;
                    *changes |= other != value;
                }
            }
            let all = values.iter_mut().zip(&*mean).zip(&*changes);
            for ((value, mean), _) in
                all.filter(|((_, mean), changes)| **changes && mean.is_finite())
            {
                *value = *mean;
            }
        }
        // a zero has no sign that would mean something
        let values = &mut scratch.block[n_rows * width..][..width];
        values.iter_mut().for_each(|value| *value += 0.0);
        n_rows += 1;
        if n_rows == ROWS_OF_BLOCK || k + 1 == rows.len() {
            run.push_block(&scratch.block[..n_rows * width], width);
            n_rows = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Analysis, Session};
    use super::*;
    use crate::analysis::watch::Unwatched;
    use crate::dataset::manual;

    #[test]
    fn columns_beside_the_rates_are_those_recorded_alone_to_the_bit() {
        let mut n_compared = 0;
        for model in manual::examples() {
            let options = Options {
                full: true,
                ..Options::default()
            };
            let Ok(read) = Model::from_text(model.dataset) else {
                continue;
            };
            let mut session = Session::new(read, "columns", options);
            let Ok((system, ..)) = session.begin(Analysis::Dynamic, &mut Unwatched) else {
                continue;
            };
            let (beside, lacks) = session.columns_at_start.take().unwrap();
            let here = system.configured();
            session.columns.begin(here, &system.numbers);
            let (alone, others) = session.columns.program(here);
            assert_eq!(lacks, others, "{}", model.name);
            for k in 0..20 {
                let moved = |(j, x): (usize, &f64)| x + 0.01 * f64::from(k) * (j as f64).sin();
                let numbers: Vec<f64> = system.numbers.iter().enumerate().map(moved).collect();
                let bits = |program: &Program| -> Vec<u64> {
                    let mut out = vec![0.0; program.n_outputs()];
                    program.run(&numbers, &mut Work::default(), &mut out);
                    // as in results: numbers that are none and zeros have no sign
                    let plain = |x: &f64| if x.is_nan() { f64::NAN } else { x + 0.0 };
                    out.iter().map(|x| plain(x).to_bits()).collect()
                };
                assert_eq!(bits(&beside), bits(&alone), "{} {k}", model.name);
            }
            n_compared += session.columns.len();
        }
        assert!(n_compared > 300, "{n_compared}");
    }
}
