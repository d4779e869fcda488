//! Initial conditions of a dataset: IC of joints, EXACT coordinates of parts, DISP of contacts.
//!
//! An initial condition is an equation that assembly satisfies together with the rows where it can,
//! and that is forgotten once the mechanism moves:
//!
//! ```text
//! d.z_J = ICTRAN,  angle of x_I about z_J = ICROT      part frame: X, Y, Z, ψ, θ, φ as in the dataset
//! comment lines of ours: variables of any joint, place of a marker in ground
//! PTCV: I at the point of the curve next to DISP        CVCV: the curves touch next to IDISP and JDISP
//! ```
//!
//! Angles of a marker that are all given, or that have no slope where they are drawn, as ψ and φ
//! have none at θ = 0, are one condition: the whole orientation, with the angles as drawn in place
//! of those that are not given. So are the three angles of a ball.
//!
//! ```text
//! the turn that is left from x_I, y_I, z_I to where they are wanted is zero
//! ```
//!
//! The position nearest to the drawing meets them as far as the rows let it (`nearest.rs`): rows
//! win where they contradict conditions, with a warning. Only dynamic simulations have conditions
//! of joints and parts: kinematics and statics find their own configuration. Those of contacts
//! count always: they choose among the ways in which the parts can be put together.

use crate::analysis::start::{assemble, branch};
use crate::analysis::warning::ConditionWarning;
use crate::arrange::Arrange;
use crate::expr::measures::Measure;
use crate::expr::program::{Program, Work};
use crate::model::{Beginning, ElementId, ElementKind, InitialQuantity, Model};
use crate::numeric::connected::SparseRow;
use crate::physics::cam::Contact;
use crate::physics::coupler::Gauge;
use crate::physics::kinematic::kinematic;
use crate::scalar::Scalar;
use crate::scene::cams::{self, Start};
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::scene::mover::Mover;
use crate::scene::programs::record_with_complaints;
use crate::scene::slopes::{Direction, along};
use crate::scene::{RowKind, Scene, Source};
use crate::space::{Frame, MarkerState, Mat3, Vec3, rotation};
use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

/// Deviation of a condition that is met, at most (rad, lengths relative to the size of the
/// mechanism).
const MET_TOLERANCE: f64 = 1e-7;

/// A quantity whose value is given.
#[derive(Clone, Debug, PartialEq)]
enum Given {
    /// of marker `i` against marker `j`
    Joint { gauge: Gauge, i: usize, j: usize },
    /// of a part's frame: 0 x, 1 y, 2 z, 3 ψ, 4 θ, 5 φ
    Part { part: usize, component: usize },
    /// of a marker in ground: 0 x, 1 y, 2 z, 3 ψ, 4 θ, 5 φ
    Marker { marker: usize, component: usize },
    /// angle between an axis of marker `i` and that of marker `j`: 0 x, 1 y, 2 z
    Between { i: usize, j: usize, axis: usize },
    /// small turn of a part's frame from where the dataset has it, about its axis
    Turn { part: usize, axis: usize },
}

/// An initial condition: a quantity and the value it should have.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialCondition {
    element: ElementId,
    /// "IC", "EXACT X"
    argument: &'static str,
    given: Given,
    value: f64,
    angle: bool,
    /// a motion says what it is: nothing can be changed
    driven: bool,
    /// the orientation that it is a part of: that is met in its place
    orientation: Option<Orientation>,
}

/// The orientation of marker I that is wanted, against marker J or ground.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Orientation {
    i: usize,
    j: Option<usize>,
    /// R_JI
    wanted: Mat3<f64>,
}

impl Orientation {
    /// Returns the turn that is left, about axes in ground.
    fn left(&self, at: &Equations<'_, f64>) -> Vec<(Vec3<f64>, f64)> {
        let from = at.marker(self.i).R_GM;
        let against = self.j.map_or(Mat3::identity(), |j| at.marker(j).R_GM);
        branch::whole(&from, &(against * self.wanted))
    }

    /// Returns how fast I turns against J about an axis in ground, by the velocities.
    fn slope(&self, at: &Equations<'_, f64>, axis: Vec3<f64>) -> Vec<(usize, f64)> {
        match self.j {
            Some(j) => at.gradient_of(&branch::against(self.i, j, axis)),
            None => at.gradient_of(&branch::against(self.i, self.i, axis)[..1]),
        }
    }
}

/// Returns the joints of a model that have an initial displacement or rate: number, gauge,
/// displacement and rate.
pub(in crate::analysis) fn of_joints(model: &Model) -> Vec<(u32, Gauge, [Option<f64>; 2])> {
    let mut found = Vec::new();
    for (id, joint) in model.active(ElementKind::Joint, &model.joints) {
        let has = joint.kind.displacements();
        for (allowed, gauge, given) in [
            (has.slides(), Gauge::Distance, joint.ic_translation),
            (has.turns(), Gauge::Angle(2), joint.ic_rotation),
        ] {
            if allowed && given != [None; 2] {
                found.push((id, gauge, given));
            }
        }
    }
    found
}

/// Puts in IC, ICTRAN and ICROT of joints that carry a part: there assembly begins.
pub(in crate::analysis) fn initial_joints(scene: &Scene, model: &Model, q: &mut [f64]) {
    for c in &scene.coordinates {
        let Some(joint) = c.joint.and_then(|j| model.joints.get(&j)) else {
            continue;
        };
        let given = if c.angular {
            joint.ic_rotation[0]
        } else {
            joint.ic_translation[0]
        };
        if let (Some(value), Source::Free { q: place, .. }) = (given, c.source) {
            q[place] = value;
        }
    }
}

/// The arguments of EXACT, by the components of a part's frame.
const EXACT: [&str; 6] = [
    "EXACT X",
    "EXACT Y",
    "EXACT Z",
    "EXACT PSI",
    "EXACT THETA",
    "EXACT PHI",
];

/// Collects the initial conditions of a model.
pub fn collect(scene: &Scene, model: &Model) -> Vec<InitialCondition> {
    let mut conditions = Vec::new();
    for (id, gauge, given) in of_joints(model) {
        let joint = &model.joints[&id];
        let markers = [joint.i, joint.j].map(|m| scene.marker_of.get(&m).copied());
        let driven = scene.coordinates.iter().any(|c| {
            c.joint == Some(id)
                && c.angular == gauge.is_angle()
                && matches!(c.source, Source::Driven(_))
        });
        if let ([Some(i), Some(j)], Some(value)) = (markers, given[0]) {
            conditions.push(InitialCondition {
                element: ElementKind::Joint.id(id),
                argument: "IC",
                given: Given::Joint { gauge, i, j },
                value,
                angle: gauge.is_angle(),
                driven,
                orientation: None,
            });
        }
    }
    conditions.extend(of_lines(scene, model));
    for (k, part) in scene.parts.iter().enumerate() {
        let Some(exact) = model.body(part.id).map(|p| p.exact) else {
            continue;
        };
        let mut condition = |component: usize, argument: &'static str, given: Given, value: f64| {
            conditions.push(InitialCondition {
                element: part.id,
                argument,
                given,
                value,
                angle: component > 2,
                driven: false,
                orientation: None,
            });
        };
        for component in 0..3 {
            if exact[component] {
                let value = part.initial.position.0[component];
                let given = Given::Part { part: k, component };
                condition(component, EXACT[component], given, value);
            }
        }
        if exact[3..] == [true; 3] {
            for axis in 0..3 {
                condition(3, "EXACT PSI:THETA:PHI", Given::Turn { part: k, axis }, 0.0);
            }
            continue;
        }
        let state = MarkerState {
            R_GM: part.initial.rotation,
            p_GM: part.initial.position,
            ..MarkerState::ground()
        };
        for component in 3..6 {
            if exact[component] {
                let given = Given::Part { part: k, component };
                let value = angle(&state, component);
                condition(component, EXACT[component], given, value);
            }
        }
    }
    conditions
}

/// Collects the positions that comment lines of ours give joints and markers.
fn of_lines(scene: &Scene, model: &Model) -> Vec<InitialCondition> {
    let mut found = Vec::new();
    let place = |m: u32| scene.marker_of.get(&m).copied();
    for (&id, values) in &model.beginnings {
        let orientation = orientation(scene, model, id, values);
        for (&quantity, &value) in values {
            let given = match quantity {
                InitialQuantity::Variable(k) => model.joints.get(&id.number).and_then(|joint| {
                    let (i, j) = (place(joint.i)?, place(joint.j)?);
                    if joint.kind.is_ball() {
                        return Some((Given::Between { i, j, axis: k }, true));
                    }
                    let &(_, gauge) = joint.kind.row().variables.get(k)?;
                    Some((Given::Joint { gauge, i, j }, gauge.is_angle()))
                }),
                InitialQuantity::Place(component) => place(id.number)
                    .map(|marker| (Given::Marker { marker, component }, component > 2)),
                InitialQuantity::VariableRate(_) | InitialQuantity::Rate(_) => None,
            };
            if let Some((given, angle)) = given.filter(|_| model.is_active(id)) {
                found.push(InitialCondition {
                    element: id,
                    argument: model.initial_quantity_name(id, quantity),
                    given,
                    value,
                    angle,
                    driven: false,
                    orientation: orientation.filter(|_| angle),
                });
            }
        }
    }
    found
}

/// Returns the orientation that the angles of a marker or a ball ask for together; `None`: each is
/// a condition of its own.
fn orientation(
    scene: &Scene,
    model: &Model,
    id: ElementId,
    values: &Beginning,
) -> Option<Orientation> {
    let place = |m: u32| scene.marker_of.get(&m).copied();
    if id.kind == ElementKind::Joint {
        let joint = model.joints.get(&id.number).filter(|j| j.kind.is_ball())?;
        let (i, j) = (place(joint.i)?, place(joint.j)?);
        let angle = |k: usize| values.get(&InitialQuantity::Variable(k)).copied();
        let angles = [angle(0)?, angle(1)?, angle(2)?];
        let [drawn, against] = [i, j].map(|m| scene.drawn(m).rotation);
        let near = rotation::vector(&(against.transpose() * drawn));
        let wanted = rotation::with_angles_between_axes(angles, near)?;
        let j = Some(j);
        return Some(Orientation { i, j, wanted });
    }
    let i = place(id.number)?;
    let given = [3, 4, 5].map(|k| values.get(&InitialQuantity::Place(k)).copied());
    let drawn = MarkerState {
        R_GM: scene.drawn(i).rotation,
        ..MarkerState::ground()
    };
    let has_slopes = Scalar::sin(angle(&drawn, 4)).abs() > branch::NO_NORMAL;
    if given == [None; 3] || has_slopes && given.contains(&None) {
        return None;
    }
    let [psi, theta, phi] = [0, 1, 2].map(|k| given[k].unwrap_or_else(|| angle(&drawn, 3 + k)));
    let wanted = rotation::from_313(psi, theta, phi);
    Some(Orientation { i, j: None, wanted })
}

fn angle<S: Scalar>(state: &MarkerState<S>, component: usize) -> S {
    let ground = MarkerState::ground();
    let measure = [Measure::Psi, Measure::Theta, Measure::Phi][component - 3];
    kinematic(measure, state, &ground, &ground, &ground).unwrap_or_else(S::zero)
}

impl InitialCondition {
    fn quantity<S: Scalar>(&self, scene: &Scene, at: &Equations<'_, S>) -> S {
        match self.given {
            Given::Joint { gauge, i, j } => {
                let frame = |m: usize| {
                    let state = at.marker(m);
                    Frame {
                        rotation: state.R_GM,
                        position: state.p_GM,
                    }
                };
                gauge.value(&frame(i), &frame(j))
            }
            Given::Between { i, j, axis } => {
                let of = |m: usize| at.marker(m).R_GM.column(axis);
                of(i).dot(of(j)).acos()
            }
            Given::Marker { marker, component } => {
                let state = at.marker(marker);
                match component {
                    0..=2 => state.p_GM.0[component],
                    _ => angle(&state, component),
                }
            }
            Given::Part { part, component } => {
                let state = at.part(part, false);
                match component {
                    0..=2 => state.p_GM.0[component],
                    _ => angle(&state, component),
                }
            }
            Given::Turn { part, axis } => {
                // half the skew part of R₀ᵀ R: the sine of the angle times its axis
                let state = at.part(part, false);
                let first = scene.parts[part].initial.rotation;
                let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
                let entry = |i: usize, j: usize| {
                    let mut sum = S::zero();
                    for k in 0..3 {
                        sum += state.R_GM.0[k][j].scale(first.0[k][i]);
                    }
                    sum
                };
                (entry(b, a) - entry(a, b)).scale(0.5)
            }
        }
    }

    /// Returns its deviation; angles the short way.
    fn residual(&self, quantity: f64) -> f64 {
        let off = quantity - self.value;
        if self.angle {
            (off + PI).rem_euclid(TAU) - PI
        } else {
            off
        }
    }
}

/// A value that is wanted, as an equation to first order.
pub(super) struct Equation {
    /// how far it is off   [rad, length]
    pub residual: f64,
    /// its slopes along the velocities
    pub gradient: SparseRow,
    is_length: bool,
}

impl Equation {
    /// Returns what counts as one of it in a mechanism of this size.
    pub fn one(&self, size: f64) -> f64 {
        if self.is_length { size } else { 1.0 }
    }
}

/// Everything that is wanted of a position beside its rows: conditions, orientations, where
/// contacts begin; or the turns of orientation rows in place of these rows.
#[derive(Default)]
pub(super) struct Wanted {
    conditions: Vec<InitialCondition>,
    /// the quantities of the conditions; `None` where there are none
    quantities: Option<Program>,
    orientations: Vec<Orientation>,
    /// where contacts are asked to begin
    pub starts: Vec<Start>,
    /// orientation rows are read as turns, with this normal where axes are opposite
    turns: Option<usize>,
}

impl Wanted {
    /// Takes over conditions, but for what EXACT asks of parts, whose places are counted.
    /// Contacts are asked to begin next to where the numbers of an instant have their points.
    pub fn new(scene: Configured<'_>, conditions: &[InitialCondition], numbers: &[f64]) -> Self {
        let mut orientations: Vec<Orientation> =
            conditions.iter().filter_map(|c| c.orientation).collect();
        orientations.dedup();
        let is_own = |c: &&InitialCondition| {
            let of_part = matches!(c.given, Given::Part { .. } | Given::Turn { .. });
            !c.driven && c.orientation.is_none() && !of_part
        };
        let conditions: Vec<_> = conditions.iter().filter(is_own).cloned().collect();
        let quantities = (!conditions.is_empty()).then(|| {
            let (quantities, _) = record_with_complaints(scene, |at| {
                conditions.iter().map(|c| c.quantity(&scene, at)).collect()
            });
            quantities
        });
        Self {
            conditions,
            quantities,
            orientations,
            starts: cams::starts(scene, numbers),
            turns: None,
        }
    }

    /// Asks for the turns of orientation rows, with this normal where axes are opposite.
    pub fn turns(normal: usize) -> Self {
        Self {
            turns: Some(normal),
            ..Self::default()
        }
    }

    /// Returns whether equations stand in place of a row: of a contact that is asked to begin
    /// somewhere, and of an orientation that is read as a turn.
    pub fn replaces(&self, scene: &Scene, row: usize) -> bool {
        match scene.rows[row].kind {
            RowKind::Cam { cam, .. } => self.starts.iter().any(|start| start.cam == cam),
            RowKind::Markers { law, .. } => self.turns.is_some() && !law.is_length(),
            RowKind::Displacements(_) | RowKind::Formula { .. } => false,
        }
    }

    /// Returns the equations at an instant that have a value and slopes.
    pub fn equations(
        &self,
        scene: Configured<'_>,
        numbers: &[f64],
        mover: &Mover,
    ) -> Vec<Equation> {
        let at = Equations::<f64>::new(scene, numbers);
        let mut found = self.of_conditions(&scene, numbers, mover);
        for start in &self.starts {
            let all = at.cam_start(start.cam, start.given).into_iter();
            found.extend(all.map(|(residual, gradient)| Equation {
                residual,
                gradient: sorted(gradient),
                is_length: true,
            }));
        }
        let mut turns: Vec<(f64, SparseRow)> = Vec::new();
        for o in &self.orientations {
            let left = o.left(&at).into_iter();
            turns.extend(left.map(|(axis, by)| (-by, o.slope(&at, axis))));
        }
        if let Some(normal) = self.turns {
            for turn in branch::turns(scene, &at, normal) {
                turns.extend(turn.equations(&at));
            }
        }
        found.extend(turns.into_iter().map(|(residual, gradient)| Equation {
            residual,
            gradient: sorted(gradient),
            is_length: false,
        }));
        found.retain(|e| {
            e.residual.is_finite() && e.gradient.iter().all(|(_, slope)| slope.is_finite())
        });
        found
    }

    fn of_conditions(&self, scene: &Scene, numbers: &[f64], mover: &Mover) -> Vec<Equation> {
        let Some(quantities) = &self.quantities else {
            return Vec::new();
        };
        let l = scene.layout;
        let mut values = vec![0.0; self.conditions.len()];
        quantities.run(numbers, &mut Work::default(), &mut values);
        let mut directions = vec![Direction::new(); l.n_v];
        for (v, place, slope) in mover.tangents(&numbers[l.q()]) {
            directions[v].push((l.q_at(place), slope));
        }
        let all = numbers.iter().copied();
        let nothing = |_: &mut [_], _| Ok(());
        let Ok::<_, Infallible>(slopes) = along(
            quantities,
            &mut Work::default(),
            all,
            &directions,
            None,
            nothing,
        );
        let conditions = self.conditions.iter().zip(&values).enumerate();
        let equation = |(k, (condition, &value)): (usize, (&InitialCondition, &f64))| Equation {
            residual: condition.residual(value),
            gradient: (slopes.row(k).iter().copied().enumerate())
                .filter(|e| e.1 != 0.0)
                .collect(),
            is_length: !condition.angle,
        };
        conditions.map(equation).collect()
    }
}

/// Returns a row by ascending columns, each once.
fn sorted(mut row: SparseRow) -> SparseRow {
    row.arrange_by_key(|e| e.0);
    assemble::merged(row)
}

/// Returns warnings of the conditions that an assembled configuration does not meet.
pub fn unmet(
    scene: Configured<'_>,
    conditions: &[InitialCondition],
    starts: &[Start],
    t: f64,
    q: &[f64],
    x: &[f64],
) -> Vec<ConditionWarning> {
    let numbers = assemble::numbers(scene, t, q, &vec![0.0; scene.layout.n_v], x);
    let at = Equations::new(scene, &numbers);
    let told = conditions.iter().filter_map(|condition| {
        let found = condition.quantity(&scene, &at);
        let unit = if condition.angle { 1.0 } else { scene.size };
        let off = match condition.orientation {
            Some(o) if o.left(&at).iter().all(|turn| turn.1.abs() <= MET_TOLERANCE) => 0.0,
            _ => condition.residual(found),
        };
        (off.abs() > MET_TOLERANCE * unit).then_some(ConditionWarning::Unmet {
            element: condition.element,
            argument: condition.argument,
            found,
            wanted: condition.value,
        })
    });
    let mut told: Vec<ConditionWarning> = told.collect();
    for start in starts {
        let cam = &scene.cams[start.cam];
        let names: &[&'static str] = match cam.contact {
            Contact::Point(_) => &["DISP"],
            Contact::Curves(..) => &["IDISP", "JDISP"],
        };
        let reached = at.cam_parameters(start.cam);
        for (k, path) in cam.contact.paths().iter().enumerate() {
            let Some(given) = start.given[k] else {
                continue;
            };
            let off = (path.at::<f64>(reached[k], 0) - path.at(given, 0)).norm();
            if off > MET_TOLERANCE * scene.size {
                told.push(ConditionWarning::UnmetContact {
                    element: cam.id,
                    argument: names[k],
                    curve: cam.curves[k],
                    off,
                    unit: scene.length_unit.clone(),
                });
            }
        }
    }
    told
}
