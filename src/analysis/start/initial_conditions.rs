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
//! First rows and conditions are satisfied together, by least changes; then the rows alone,
//! exactly. So rows win where they contradict conditions, with a warning. Only dynamic simulations
//! have conditions of joints and parts: kinematics and statics find their own configuration. Those
//! of contacts count always: they choose among the ways in which the parts can be put together.

use crate::analysis::start::assemble::{self, least_change, rows_at_rest};
use crate::analysis::warning::ConditionWarning;
use crate::arrange::Arrange;
use crate::expr::measures::Measure;
use crate::expr::program::{Program, Work};
use crate::model::{ElementId, ElementKind, InitialQuantity, Model};
use crate::physics::cam::Contact;
use crate::physics::coupler::Gauge;
use crate::physics::kinematic::kinematic;
use crate::scalar::Scalar;
use crate::scene::cams::{self, Start};
use crate::scene::configuration::{Configuration, Configured};
use crate::scene::equations::Equations;
use crate::scene::mover::Mover;
use crate::scene::programs::{record_with_complaints, weights};
use crate::scene::slopes::{Direction, along};
use crate::scene::{RowKind, Scene};
use crate::space::{Frame, MarkerState};
use nalgebra::{DMatrix, DVector};
use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

/// Iterations towards rows and conditions together.
const MAX_ITERATIONS: usize = 30;
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
    /// a comment line of ours gives it
    of_line: bool,
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
                && matches!(c.source, crate::scene::Source::Driven(_))
        });
        if let ([Some(i), Some(j)], Some(value)) = (markers, given[0]) {
            conditions.push(InitialCondition {
                element: ElementKind::Joint.id(id),
                argument: "IC",
                given: Given::Joint { gauge, i, j },
                value,
                angle: gauge.is_angle(),
                driven,
                of_line: false,
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
                of_line: false,
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
        for (&quantity, &value) in values {
            let given = match quantity {
                InitialQuantity::Variable(k) => model.joints.get(&id.number).and_then(|joint| {
                    let &(_, gauge) = joint.kind.row().variables.get(k)?;
                    let (i, j) = (place(joint.i)?, place(joint.j)?);
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
                    of_line: true,
                });
            }
        }
    }
    found
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

    /// Returns whether a comment line of ours gives it: a placement of parts does not know it.
    pub(super) fn is_of_line(&self) -> bool {
        self.of_line
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

/// Residuals of conditions and their derivatives along the velocities, from the program of their
/// quantities; conditions without finite ones are left out (zero).
fn equations(
    scene: &Scene,
    conditions: &[InitialCondition],
    quantities: &Program,
    numbers: &[f64],
    mover: &Mover,
) -> (DVector<f64>, DMatrix<f64>) {
    let l = scene.layout;
    let mut found = vec![0.0; conditions.len()];
    quantities.run(numbers, &mut Work::default(), &mut found);
    let residual = conditions.iter().zip(&found).map(|(w, &x)| w.residual(x));
    let mut residual = DVector::from_iterator(conditions.len(), residual);
    let mut directions = vec![Direction::new(); l.n_v];
    for (v, place, slope) in mover.tangents(&numbers[l.q()]) {
        directions[v].push((l.q_at(place), slope));
    }
    let all = numbers.iter().copied();
    let nothing = |_: &mut [_], _| Ok(());
    let Ok::<_, Infallible>(mut gradient) = along(
        quantities,
        &mut Work::default(),
        all,
        &directions,
        None,
        nothing,
    );
    for w in 0..conditions.len() {
        let bad = !residual[w].is_finite() || gradient.row(w).iter().any(|x| !x.is_finite());
        if bad {
            residual[w] = 0.0;
            gradient.row_mut(w).fill(0.0);
        }
    }
    (residual, gradient)
}

/// Moves positions towards rows and conditions together; contacts that are asked to begin somewhere
/// are taken to be there, and returned.
pub fn approach(
    scene: &Scene,
    configuration: &mut Configuration,
    conditions: &[InitialCondition],
    t: f64,
    q: &mut [f64],
    x: &[f64],
) -> Vec<Start> {
    let here = scene.within(configuration);
    let still = vec![0.0; scene.layout.n_v];
    let starts = cams::starts(here, &assemble::numbers(here, t, q, &still, x));
    let conditions: Vec<_> = conditions.iter().filter(|c| !c.driven).cloned().collect();
    let conditions = &conditions[..];
    if conditions.is_empty() && starts.is_empty() || scene.layout.n_v == 0 {
        return starts;
    }
    let w = weights(scene);
    let mover = Mover::new(scene);
    let (quantities, _) = record_with_complaints(here, |at| {
        conditions.iter().map(|w| w.quantity(scene, at)).collect()
    });
    // contacts that are asked to be somewhere are equations of their own
    let asked = |scene: Configured<'_>, r: usize| match scene.rows[r].kind {
        RowKind::Cam { cam, .. } => starts.iter().any(|s| s.cam == cam),
        _ => scene.is_held(r),
    };
    for _ in 0..MAX_ITERATIONS {
        let here = assemble::numbers(scene.within(configuration), t, q, &still, x);
        cams::track(scene, configuration, &here);
        cams::place(scene, configuration, &starts, &here);
        let configured = scene.within(configuration);
        let (mut g, mut gradient) = rows_at_rest(configured, t, q, x);
        for r in (0..g.len()).filter(|&r| asked(configured, r)) {
            g[r] = 0.0;
            gradient[r].clear();
        }
        let at = Equations::<f64>::new(configured, &here);
        let places: Vec<(f64, Vec<(usize, f64)>)> = (starts.iter())
            .flat_map(|s| at.cam_start(s.cam, s.given))
            .filter(|(value, _)| value.is_finite())
            .collect();
        let (off, slopes) = equations(scene, conditions, &quantities, &here, &mover);
        let (m, n) = (g.len(), conditions.len());
        let mut a = gradient;
        for slopes in slopes.row_iter() {
            let entries = slopes.iter().copied().enumerate();
            a.push(entries.filter(|e| e.1 != 0.0).collect());
        }
        for (_, slopes) in &places {
            let mut slopes = slopes.clone();
            slopes.arrange_by_key(|e| e.0);
            a.push(assemble::merged(slopes));
        }
        let all = g
            .iter()
            .chain(off.iter())
            .chain(places.iter().map(|p| &p.0));
        let b = DVector::from_iterator(m + n + places.len(), all.map(|x| -x));
        let step = least_change(&a, &w, &b);
        let size = |v: usize| step[v].abs() / w[v].sqrt();
        let longest = (0..w.len()).map(size).fold(0.0, f64::max);
        if !longest.is_finite() || longest < 1e-14 {
            break;
        }
        mover.displace(q, (&step * (0.5 / longest).min(1.0)).as_slice());
    }
    let reached = assemble::numbers(scene.within(configuration), t, q, &still, x);
    cams::place(scene, configuration, &starts, &reached);
    starts
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
        let off = condition.residual(found);
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
