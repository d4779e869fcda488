//! Columns of results: one formula of an instant per column.

use crate::expr::dimension::Dimension;
use crate::expr::measures::Measure;
use crate::expr::program::{Input, Program, Work};
use crate::model::{ElementId, ElementKind, Formula, Model, Part, Place, RequestKind, Text};
use crate::physics::kinematic;
use crate::results::{Component, Entity, Run, Units};
use crate::scalar::Scalar;
use crate::scene::Scene;
use crate::scene::configuration::Configured;
use crate::scene::equations::{Equations, Unsupported};
use crate::scene::layout::Layout;
use crate::scene::programs::record_with_complaints;
use crate::space::MarkerState;

/// The quantity that a column shows.
#[derive(Clone, Debug, PartialEq)]
enum What {
    /// an expression: index among the extra formulas of the scene
    Text(usize),
    /// a component of a part's motion: 0–2 position, 3–5 ψ θ φ, 6–8 velocity, 9–11 angular
    /// velocity, 12–14 acceleration, 15–17 angular acceleration; of the part frame, ground axes
    Part { id: ElementId, quantity: usize },
    /// a component of a REQUEST that a closure computes, from 0
    Request { id: u32, component: usize },
    /// a variable of a joint
    JointVariable { joint: u32, variable: &'static str },
    /// a component of the action of an element on its I marker, ground axes: 0–2 force, 3–5 torque
    Action { id: ElementId, component: usize },
}

/// The columns of a run in the order of its table of all columns, time left out.
#[derive(Debug, Default)]
pub struct Columns {
    what: Vec<What>,
    /// expressions to compile with each scene: (name, text)
    pub extra: Vec<(String, Text)>,
}

/// The unit of what an expression yields, where it is a single measure.
fn unit_of(text: &Text, units: &Units) -> String {
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

/// An element whose components are columns of its own name.
fn shown(run: &mut Run, kind: &str, entity: String, id: u32, components: Vec<Component>) {
    run.entities.push(Entity {
        name: entity.clone(),
        entity,
        kind: kind.into(),
        id: u64::from(id),
        components,
    });
}

/// A component of a REQUEST.
struct RequestComponent {
    /// 1 to 8
    place: usize,
    name: String,
    /// its expression; empty when a closure computes it
    text: String,
}

/// Returns the components of a REQUEST as expressions, or those that a closure computes.
fn components(
    id: u32,
    kind: &RequestKind,
    computed: &dyn Fn(u32, &Formula) -> bool,
) -> Vec<RequestComponent> {
    match kind {
        RequestKind::Displacement { i, j, rm } => {
            let mut all = measured(1, "MAG", "DM", ["DX", "DY", "DZ"], (*i, *j, *rm));
            all.extend(
                (["PSI", "THETA", "PHI"].iter().enumerate()).map(|(k, name)| RequestComponent {
                    place: 6 + k,
                    name: name.to_string(),
                    text: format!("{name}({i},{})", j.unwrap_or(0)),
                }),
            );
            all
        }
        RequestKind::Velocity { i, j, rm } => {
            let translation = ("VM", ["VX", "VY", "VZ"]);
            both(translation, ("WM", ["WX", "WY", "WZ"]), (*i, *j, *rm))
        }
        RequestKind::Acceleration { i, j, rm } => {
            let translation = ("ACCM", ["ACCX", "ACCY", "ACCZ"]);
            let rotation = ("WDTM", ["WDTX", "WDTY", "WDTZ"]);
            both(translation, rotation, (*i, *j, *rm))
        }
        RequestKind::Force { i, j, rm } => {
            let translation = ("FM", ["FX", "FY", "FZ"]);
            both(translation, ("TM", ["TX", "TY", "TZ"]), (*i, *j, *rm))
        }
        RequestKind::Functions(all) => (all.iter().enumerate())
            .filter_map(|(k, f)| match f {
                Some(Formula::Expression { text, .. }) => Some(function(k + 1, text)),
                _ => None,
            })
            .collect(),
        RequestKind::User(user) if computed(id, user) => (1..=8).map(|k| function(k, "")).collect(),
        RequestKind::User(_) => Vec::new(),
    }
}

fn function(place: usize, text: &str) -> RequestComponent {
    RequestComponent {
        place,
        name: format!("F{place}"),
        text: text.into(),
    }
}

/// Returns a magnitude and three components that measures between markers I and J yield, those of
/// RM resolving the components.
fn measured(
    first: usize,
    magnitude: &str,
    of_magnitude: &str,
    measures: [&str; 3],
    (i, j, rm): (u32, Option<u32>, Option<u32>),
) -> Vec<RequestComponent> {
    let (j, rm) = (j.unwrap_or(0), rm.unwrap_or(0));
    let mut all = vec![RequestComponent {
        place: first,
        name: magnitude.into(),
        text: format!("{of_magnitude}({i},{j})"),
    }];
    all.extend(measures.iter().zip(first + 1..).map(|(name, place)| {
        let text = format!("{name}({i},{j},{rm})");
        let name = name.to_string();
        RequestComponent { place, name, text }
    }));
    all
}

/// Returns the eight components of a quantity that has a part of translation and one of rotation.
fn both(
    translation: (&str, [&str; 3]),
    rotation: (&str, [&str; 3]),
    markers: (u32, Option<u32>, Option<u32>),
) -> Vec<RequestComponent> {
    let mut all = measured(1, "MAG", translation.0, translation.1, markers);
    all.extend(measured(5, "AMAG", rotation.0, rotation.1, markers));
    all
}

impl Columns {
    /// Declares all columns of a run: those of the parts, joints and forces when `full`, requests,
    /// and `user` expressions. `computed` tells whether there is a closure for a REQUEST of this
    /// number with this USER.
    pub fn new(
        model: &Model,
        run: &mut Run,
        user: &[String],
        full: bool,
        computed: &dyn Fn(u32, &Formula) -> bool,
    ) -> Self {
        run.columns.clear();
        run.entities.clear();
        run.add_column("time", run.units.time.clone());
        let mut this = Self::default();
        if full {
            this.parts(model, run);
        }
        let mut table = vec![0];
        for text in user {
            table.push(this.text(run, text.clone(), text, &run.units.clone()));
        }
        this.requests(model, run, &mut table, computed);
        if full {
            this.elements(model, run);
        }
        run.table = table;
        this
    }

    fn push(&mut self, run: &mut Run, name: String, unit: String, what: What) -> usize {
        self.what.push(what);
        run.add_column(name, unit)
    }

    fn text(&mut self, run: &mut Run, name: String, text: &str, units: &Units) -> usize {
        let (k, text) = (self.extra.len(), Text::from(text));
        let unit = unit_of(&text, units);
        self.extra.push((name.clone(), text));
        self.push(run, name, unit, What::Text(k))
    }

    /// Positions of all parts, then velocities, then accelerations.
    fn parts(&mut self, model: &Model, run: &mut Run) {
        let u = run.units.clone();
        let first = run.entities.len();
        let moving = |(id, p): &(ElementId, &Part)| id.kind == ElementKind::PointMass || !p.ground;
        let all: Vec<(ElementId, &Part)> = model.bodies().filter(moving).collect();
        for &(id, part) in &all {
            let entity = name_of(&part.place, id);
            let name = format!("{entity}_XFORM");
            run.entities.push(Entity {
                name,
                entity,
                kind: "Part".into(),
                id: u64::from(id.number),
                components: Vec::new(),
            });
        }
        let names = [
            ["X", "Y", "Z", "PSI", "THETA", "PHI"],
            ["VX", "VY", "VZ", "WX", "WY", "WZ"],
            ["ACCX", "ACCY", "ACCZ", "WDX", "WDY", "WDZ"],
        ];
        for (level, names) in names.iter().enumerate() {
            let rate = [
                "".to_string(),
                format!("/{}", u.time),
                format!("/{}**2", u.time),
            ][level]
                .clone();
            for (k, &(id, _)) in all.iter().enumerate() {
                for (c, component) in names.iter().enumerate() {
                    let unit = format!("{}{rate}", if c < 3 { &u.length } else { &u.angle });
                    let what = What::Part {
                        id,
                        quantity: 6 * level + c,
                    };
                    let name = format!("{}.{component}", run.entities[first + k].name);
                    let column = self.push(run, name, unit, what);
                    run.entities[first + k].components.push(Component {
                        name: (*component).into(),
                        column,
                    });
                }
            }
        }
    }

    /// Reactions of joints and actions of forces.
    fn elements(&mut self, model: &Model, run: &mut Run) {
        let u = run.units.clone();
        let shown_kinds = [
            (ElementKind::Joint, "Joint"),
            (ElementKind::Jprim, "Primitive_Joint"),
            (ElementKind::Sforce, "Single_Component_Force"),
        ];
        for (&id, joint) in &model.joints {
            let entity = format!(
                "{}_VARIABLES",
                name_of(&joint.place, ElementKind::Joint.id(id))
            );
            let mut components = Vec::new();
            for &(variable, gauge) in joint.kind.row().variables {
                let unit = if gauge.is_angle() {
                    u.angle.clone()
                } else {
                    u.length.clone()
                };
                let name = format!("{entity}.{variable}");
                let what = What::JointVariable {
                    joint: id,
                    variable,
                };
                let column = self.push(run, name, unit, what);
                let name = variable.into();
                components.push(Component { name, column });
            }
            if !components.is_empty() {
                shown(run, "Joint_Variables", entity, id, components);
            }
        }
        let all = shown_kinds.into_iter().flat_map(|(kind, word)| {
            let numbers = model.numbers(kind).into_iter();
            numbers.filter_map(move |n| {
                let id = kind.id(n);
                Some((id, name_of(model.element(id)?.place(), id), word))
            })
        });
        for (id, entity, kind) in all {
            let mut components = Vec::new();
            for (c, component) in ["FX", "FY", "FZ", "TX", "TY", "TZ"].iter().enumerate() {
                let unit = if c < 3 {
                    u.force.clone()
                } else {
                    format!("{}-{}", u.force, u.length)
                };
                let what = What::Action { id, component: c };
                let column = self.push(run, format!("{entity}.{component}"), unit, what);
                components.push(Component {
                    name: (*component).into(),
                    column,
                });
            }
            shown(run, kind, entity, id.number, components);
        }
        for (&id, variable) in &model.variables {
            let entity = name_of(&variable.place, ElementKind::Variable.id(id));
            let column = self.text(run, format!("{entity}.Q"), &format!("VARVAL({id})"), &u);
            let components = vec![Component {
                name: "Q".into(),
                column,
            }];
            shown(run, "ADAMS_Variable", entity, id, components);
        }
    }

    /// Declares the columns of all requests, which are those of the table.
    fn requests(
        &mut self,
        model: &Model,
        run: &mut Run,
        table: &mut Vec<usize>,
        computed: &dyn Fn(u32, &Formula) -> bool,
    ) {
        let units = run.units.clone();
        for (&id, request) in &model.requests {
            let entity = request
                .results_name
                .clone()
                .unwrap_or_else(|| name_of(&request.place, ElementKind::Request.id(id)));
            let by_closure = matches!(request.kind, RequestKind::User(_));
            let mut columns = Vec::new();
            for component in components(id, &request.kind, computed) {
                let given = request.cnames.get(component.place - 1);
                if given.is_some_and(String::is_empty) {
                    continue;
                }
                let name = given.cloned().unwrap_or(component.name);
                let title = format!("{entity}.{name}");
                let column = if by_closure {
                    let component = component.place - 1;
                    self.push(run, title, String::new(), What::Request { id, component })
                } else {
                    self.text(run, title, &component.text, &units)
                };
                table.push(column);
                columns.push(Component { name, column });
            }
            if !columns.is_empty() {
                shown(run, "Request", entity, id, columns);
            }
        }
    }

    fn value<S: Scalar>(&self, what: &What, scene: &Scene, at: &Equations<'_, S>) -> S {
        match what {
            What::Text(k) => at.formula(scene.extra[*k]),
            What::Part { id, quantity } => {
                let part = scene.parts.iter().position(|p| p.id == *id);
                let Some(part) = part else {
                    return S::constant(f64::NAN);
                };
                let accelerated = *quantity >= 12;
                let state = at.part(part, accelerated);
                let angle = |m: Measure| {
                    let ground = MarkerState::ground();
                    kinematic::kinematic(m, &state, &ground, &ground, &ground)
                        .unwrap_or_else(S::zero)
                };
                match quantity {
                    0..=2 => state.p_GM.0[*quantity],
                    3 => angle(Measure::Psi),
                    4 => angle(Measure::Theta),
                    5 => angle(Measure::Phi),
                    6..=8 => state.v_GM.0[quantity - 6],
                    9..=11 => state.w_GM.0[quantity - 9],
                    12..=14 => state.a_GM.0[quantity - 12],
                    _ => state.alpha_GM.0[quantity - 15],
                }
            }
            What::Request { id, component } => match scene.requests.get(id) {
                Some(formulas) => at.formula(formulas[*component]),
                None => S::constant(f64::NAN),
            },
            What::JointVariable { joint, variable } => {
                let mut all = scene.joint_variables.iter();
                let found = all.position(|v| v.joint == *joint && v.name == *variable);
                found.map_or_else(S::zero, |k| at.joint_variable(k))
            }
            What::Action { id, component } => match at.action_of(*id) {
                Some(a) if *component < 3 => a.force.0[*component],
                Some(a) => a.torque.0[component - 3],
                None => S::zero(),
            },
        }
    }

    /// The columns as a program of the scene, and what could not be supplied.
    pub fn program(&self, scene: Configured<'_>) -> (Program, Vec<Unsupported>) {
        record_with_complaints(scene, |at| {
            (self.what.iter())
                .map(|w| self.value(w, &scene, at))
                .collect()
        })
    }

    /// Number of columns.
    pub fn len(&self) -> usize {
        self.what.len()
    }

    /// Returns true if there are none.
    pub fn is_empty(&self) -> bool {
        self.what.is_empty()
    }
}

/// Evaluates the columns at each row of numbers and appends them to the run.
pub fn append(run: &mut Run, program: &Program, rows: &[Vec<f64>]) {
    append_means(run, program, rows, |_| None);
}

/// Appends the columns as [`append`] does; `branches`: the numbers on the branches between which
/// the motion stays at the row of an index, and the part of each in the mean that is what happens.
pub fn append_means<'a>(
    run: &mut Run,
    program: &Program,
    rows: &[Vec<f64>],
    branches: impl Fn(usize) -> Option<&'a Vec<(f64, Vec<f64>)>>,
) {
    let mut work = Work::default();
    let mut values = vec![0.0; program.n_outputs() + 1];
    let (mut mean, mut other) = (values[1..].to_vec(), values[1..].to_vec());
    let mut changes = vec![false; other.len()];
    for (k, row) in rows.iter().enumerate() {
        values[0] = row[Layout::TIME];
        program.run(row, &mut work, &mut values[1..]);
        if let Some(branches) = branches(k) {
            mean.fill(0.0);
            changes.fill(false);
            for (part, row) in branches {
                program.run(row, &mut work, &mut other);
                let all = mean.iter_mut().zip(&mut changes).zip(&other);
                for (((mean, changes), other), value) in all.zip(&values[1..]) {
                    *mean += part * other;
                    *changes |= other != value;
                }
            }
            let all = values[1..].iter_mut().zip(&mean).zip(&changes);
            for ((value, mean), _) in
                all.filter(|((_, mean), changes)| **changes && mean.is_finite())
            {
                *value = *mean;
            }
        }
        // a zero has no sign that would mean something
        values.iter_mut().for_each(|value| *value += 0.0);
        run.push(&values);
    }
}

/// The name given in the dataset, or `KEYWORD_id`.
pub fn name_of(place: &Place, id: ElementId) -> String {
    let name = place.name.clone();
    name.unwrap_or_else(|| format!("{}_{}", id.kind, id.number))
}
