//! Velocities to start with: those nearest to the dataset's that satisfy the rows.

use super::assemble::{EMPTY, directions, least_change, null_space, numbers, rank_of, rows_at};
use super::initial_conditions::of_joints;
use crate::analysis::direction::Direction;
use crate::analysis::quantity::{length, short};
use crate::analysis::warning::ConditionWarning;
use crate::diagnostic::Diagnostic;
use crate::model::{ElementKind, Model};
use crate::scene::Scene;
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::scene::programs::weights;
use crate::space::Mat3;
use nalgebra::{DMatrix, DVector};

/// Part of a rate by which it may be off and is met.
const MET_TOLERANCE: f64 = 1e-6;

/// Returns the error of motions that ask for a rate which a row forbids: by how much it would have
/// to give way, and which motions there are.
fn prescribed_too_much(scene: Configured<'_>, numbers: &[f64], r: usize, rate: f64) -> Diagnostic {
    let at = Equations::new(scene, numbers);
    let row = &scene.rows[r];
    let direction = Direction::of_row(&scene, &at, r);
    let way = direction.way();
    let rate = if direction.is_rotation() {
        format!("{} deg", short(rate.abs().to_degrees()))
    } else {
        length(rate, &scene.length_unit)
    };
    let motions: Vec<String> = (scene.motions.iter())
        .map(|m| ElementKind::Motion.id(m.id).to_string())
        .collect();
    Diagnostic::error(
        "assembly",
        format!(
            "the prescribed velocities contradict it: {} would have to give way by {rate} per unit of time {way}",
            row.equation
        ),
    )
    .element(row.element)
    .help(format!(
        "prescribe less, or rates that go together: there are {}",
        motions.join(", ")
    ))
}

/// Returns the velocities nearest to those of the dataset that satisfy the rows: given ones first,
/// then
/// the rest as small as may be   (n_v)
///
/// # Errors
/// When the motions ask for velocities that the rows forbid.
pub fn velocities(
    scene: Configured<'_>,
    model: &Model,
    t: f64,
    q: &[f64],
    x: &[f64],
) -> Result<Vec<f64>, Vec<Diagnostic>> {
    let n = scene.layout.n_v;
    let (_, gradient, drift) = rows_at(scene, t, q, x);
    let given = GivenVelocities::collect(scene, model, t, q, x);
    // v = v₀ + N z, with N the null space of the rows
    let w = vec![1.0; n];
    let v0 = least_change(&gradient, &w, &(-&drift));
    let left = &gradient * &v0 + &drift;
    let scale = 1.0 + drift.amax().max(gradient.amax());
    if let Some(r) = (0..left.len()).find(|&r| left[r].abs() > 1e-8 * scale) {
        return Err(vec![prescribed_too_much(
            scene,
            &numbers(scene, t, q, &vec![0.0; n], x),
            r,
            left[r],
        )]);
    }
    let mut v = v0;
    let levels = [&given.of_constraints, &given.of_parts, &given.rest];
    if levels.iter().all(|(a, b)| (b - a * &v).amax() == 0.0) {
        return Ok(v.iter().copied().collect());
    }
    let mut space = null_space(&gradient, n);
    // each level as well as may be within the freedom that the levels before leave
    for (a, b) in levels {
        if space.ncols() == 0 || a.nrows() == 0 {
            continue;
        }
        let mut reduced = a * &space;
        // a velocity square to all that is free is not to be had: what is left of it is rounding
        for r in 0..reduced.nrows() {
            if reduced.row(r).norm() <= EMPTY * a.row(r).norm() {
                reduced.row_mut(r).fill(0.0);
            }
        }
        let rank = rank_of(&reduced, &vec![1.0; space.ncols()]);
        let mut z = vec![0.0; space.ncols()];
        rank.least_squares((b - a * &v).as_slice(), &mut z);
        v += &space * DVector::from_vec(z);
        space = &space * directions(&rank, space.ncols());
    }
    // without rounding dust where the dataset says zero
    let size = v.amax();
    Ok(v.iter()
        .map(|x| if x.abs() < 1e-14 * size { 0.0 } else { *x })
        .collect())
}

/// Returns warnings of the joints whose initial rate is not that of their IC.
pub fn unmet(
    scene: Configured<'_>,
    model: &Model,
    t: f64,
    (q, v, x): (&[f64], &[f64], &[f64]),
) -> Vec<ConditionWarning> {
    let numbers = numbers(scene, t, q, v, x);
    let at = Equations::new(scene, &numbers);
    let told = joint_rates(&scene, model, &at);
    let told = told.into_iter().filter_map(|(id, found, wanted)| {
        let off = (found - wanted).abs();
        (off > MET_TOLERANCE * found.abs().max(wanted.abs())).then_some(
            ConditionWarning::UnmetRate {
                element: ElementKind::Joint.id(id),
                found,
                wanted,
            },
        )
    });
    told.collect()
}

/// Returns the velocities nearest to the given ones that all rows permit   (n_v)
pub(in crate::analysis) fn nearest_velocities(
    scene: Configured<'_>,
    t: f64,
    q: &[f64],
    x: &[f64],
    v: &[f64],
) -> Vec<f64> {
    let (_, gradient, drift) = rows_at(scene, t, q, x);
    let given = DVector::from_column_slice(v);
    let missing = -(&gradient * &given + drift);
    let change = least_change(&gradient, &weights(&scene), &missing);
    (given + change).iter().copied().collect()
}

/// Linear equations that velocities should satisfy: matrix, right side.
type Equation = (DMatrix<f64>, DVector<f64>);

/// Velocities that the dataset gives: those of constraints (IC of joints, VEL of contacts), which
/// go before those of parts, and zero for all others.
struct GivenVelocities {
    of_constraints: Equation,
    of_parts: Equation,
    rest: Equation,
}

/// The origin of a velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    Constraint,
    Part,
    Rest,
}

impl Level {
    fn of(given: Option<f64>) -> (Self, f64) {
        given.map_or((Self::Rest, 0.0), |x| (Self::Part, x))
    }
}

impl GivenVelocities {
    fn collect(scene: Configured<'_>, model: &Model, t: f64, q: &[f64], x: &[f64]) -> Self {
        let n = scene.layout.n_v;
        // velocities are linear in v: one evaluation per coordinate, and one for motions
        let mut columns: Vec<Vec<f64>> = Vec::with_capacity(n + 1);
        let mut targets: Vec<(Level, f64)> = Vec::new();
        for k in 0..=n {
            let mut v = vec![0.0; n];
            if k > 0 {
                v[k - 1] = 1.0;
            }
            let at = Equations::new(scene, &numbers(scene, t, q, &v, x));
            let (values, given) = part_velocities(&scene, model, &at);
            let origin = columns.first();
            let column = match origin {
                Some(zero) => values.iter().zip(zero).map(|(a, b)| a - b).collect(),
                None => values,
            };
            columns.push(column);
            targets = given;
        }
        let level = |level: Level| {
            let rows: Vec<usize> = (0..targets.len())
                .filter(|&r| targets[r].0 == level)
                .collect();
            let a = DMatrix::from_fn(rows.len(), n, |i, j| columns[j + 1][rows[i]]);
            let b = DVector::from_iterator(
                rows.len(),
                rows.iter().map(|&r| targets[r].1 - columns[0][r]),
            );
            (a, b)
        };
        Self {
            of_constraints: level(Level::Constraint),
            of_parts: level(Level::Part),
            rest: level(Level::Rest),
        }
    }
}

/// Evaluates the velocity components of all parts as the dataset would give them, with origin and
/// value of those that it gives; then joint rates.
fn part_velocities(
    scene: &Scene,
    model: &Model,
    at: &Equations<'_, f64>,
) -> (Vec<f64>, Vec<(Level, f64)>) {
    let mut values = Vec::new();
    let mut targets = Vec::new();
    for part in &scene.parts {
        let Some(data) = model.body(part.id) else {
            continue;
        };
        let frame = |m: Option<u32>| {
            m.and_then(|m| scene.marker_of.get(&m))
                .map(|&m| at.marker(m))
        };
        let Some(cm) = frame(data.cm) else { continue };
        let axes_v = frame(data.vm).map_or_else(Mat3::identity, |m| m.R_GM);
        let axes_w = frame(data.wm).map_or(cm.R_GM, |m| m.R_GM);
        for k in 0..3 {
            values.push(axes_v.column(k).dot(cm.v_GM));
            targets.push(Level::of(data.velocity[k]));
        }
        for k in 0..3 {
            values.push(axes_w.column(k).dot(cm.w_GM));
            targets.push(Level::of(data.angular_velocity[k]));
        }
    }
    for (c, cam) in scene.cams.iter().enumerate() {
        for (k, along) in at.cam_speeds(c).into_iter().enumerate() {
            if let Some(given) = cam.velocity[k] {
                values.push(along);
                targets.push((Level::Constraint, given));
            }
        }
    }
    for (_, found, wanted) in joint_rates(scene, model, at) {
        values.push(found);
        targets.push((Level::Constraint, wanted));
    }
    (values, targets)
}

/// Returns the joints of which an initial rate is asked: number, rate, and the one that is asked.
fn joint_rates(scene: &Scene, model: &Model, at: &Equations<'_, f64>) -> Vec<(u32, f64, f64)> {
    let mut found = Vec::new();
    for (id, gauge, [_, rate]) in of_joints(model) {
        let joint = &model.joints[&id];
        let markers = [joint.i, joint.j].map(|m| scene.marker_of.get(&m));
        let ([Some(&i), Some(&j)], Some(rate)) = (markers, rate) else {
            continue;
        };
        let (i, j) = (at.marker(i), at.marker(j));
        let z = j.R_GM.column(2);
        let own = if gauge.is_angle() {
            (i.w_GM - j.w_GM).dot(z)
        } else {
            (i.v_GM - j.v_GM).dot(z) + (i.p_GM - j.p_GM).dot(j.w_GM.cross(z))
        };
        found.push((id, own, rate));
    }
    found
}
