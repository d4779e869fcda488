//! Placement of parts that do not fit: the positions nearest to those of the dataset that satisfy
//! all rows.
//!
//! ```text
//! least  Σ w² |change of a part's place|² + Σ W² (joint − IC)²     subject to the rows
//! w = 1, for coordinates that EXACT names and for IC of joints 10⁵ (weights 1 and 10¹⁰ of the squares, as in Adams)
//! ```
//!
//! Changes of place are those of the part's origin, against the size of the mechanism, and of its
//! orientation, in rad. They are counted by parts, not by coordinates, so that the answer does not
//! depend on what carries what. An Euler angle that EXACT names holds the whole orientation: the
//! angles of a part that turns about another axis all change. Gauss–Newton: `Δ = Δ₀ + N z`, with
//! `Δ₀` closing the rows, N what they leave free, and z least squares.

use crate::analysis::start::assemble;
use crate::model::{ElementKind, Model};
use crate::numeric::connected::SparseRow;
use crate::numeric::rank::Rank;
use crate::physics::row::{Drive, Law};
use crate::scalar::{Jet, Scalar};
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::scene::mover::Mover;
use crate::scene::programs::weights;
use crate::scene::{Scene, Source};
use crate::space::{MarkerState, Mat3, Vec3};
use nalgebra::{DMatrix, DVector};

/// Weight of EXACT and IC over that of an ordinary coordinate.
const FIRM_WEIGHT: f64 = 1e5;
/// Velocities of the largest mechanism whose parts are weighed: beyond, coordinates move as little
/// as may be.
const MAX_VELOCITIES: usize = 300;
/// Iterations, at most.
const MAX_ITERATIONS: usize = 40;
/// Longest change of a coordinate in one iteration, rad or parts of the mechanism's size.
const LONGEST_STEP: f64 = 0.5;
/// Deviation of parts and rows that are in place already.
const IN_PLACE: f64 = 1e-9;
/// Change of a coordinate at which the iteration has converged.
const ARRIVED: f64 = 1e-11;

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

/// Returns whether the parts of a mechanism are placed like this. Contacts of curves go where their
/// bodies are: there coordinates decide.
pub(super) fn places(scene: &Scene) -> bool {
    (1..=MAX_VELOCITIES).contains(&scene.layout.n_v) && scene.cams.is_empty()
}

/// Moves `q` to the positions nearest to the dataset. `joints`: IC of joints count. False: the
/// mechanism is not one that is placed like this, or no step led anywhere.
pub fn settle(
    scene: Configured<'_>,
    model: &Model,
    t: f64,
    q: &mut [f64],
    x: &[f64],
    joints: bool,
) -> bool {
    if !places(&scene) {
        return false;
    }
    let asked = Asked::of(&scene, model, joints);
    let w = weights(&scene);
    let mover = Mover::new(&scene);
    let mut here = q.to_vec();
    for k in 0..MAX_ITERATIONS {
        let Some(distance) = Distance::at(scene, model, t, &here, x, &asked) else {
            return false;
        };
        let (mut g, mut gradient) = assemble::rows_at_rest(scene, t, &here, x);
        for r in (0..g.len()).filter(|&r| scene.is_held(r)) {
            g[r] = 0.0;
            gradient[r].clear();
        }
        assemble::clear_idle(&scene, &g, &mut gradient);
        let off = (0..g.len()).fold(0.0, |m: f64, r| m.max((g[r] / scene.row_scale(r)).abs()));
        if k == 0 && off < IN_PLACE && distance.residual.amax() < IN_PLACE {
            return true;
        }
        let step = step(&w, &g, &gradient, distance);
        let longest = step.amax();
        if !longest.is_finite() {
            return false;
        }
        let damping = (LONGEST_STEP / longest).min(1.0);
        let scaled = step.iter().zip(&w);
        let change: Vec<f64> = scaled.map(|(s, w)| damping * s * w.sqrt()).collect();
        mover.displace(&mut here, &change);
        if longest < ARRIVED {
            break;
        }
    }
    q.copy_from_slice(&here);
    true
}

/// Returns the step of Gauss and Newton, in coordinates scaled by √w: it closes the rows, and in
/// what they leave free makes the distance least.
fn step(w: &[f64], g: &DVector<f64>, gradient: &[SparseRow], distance: Distance) -> DVector<f64> {
    let rows = assemble::scaled_rows(gradient, w);
    let rank = Rank::of(rows.iter().map(Vec::as_slice), w.len(), 1e-9);
    let mut step = vec![0.0; w.len()];
    rank.least_norm((-g).as_slice(), &mut step);
    let mut step = DVector::from_vec(step);
    let free = rank.free_directions();
    if free.is_empty() {
        return step;
    }
    let free = DMatrix::from_fn(w.len(), free.len(), |i, j| free[j][i]);
    let Distance { residual, slopes } = distance;
    let scaled = DMatrix::from_fn(slopes.nrows(), w.len(), |i, j| slopes[(i, j)] * w[j].sqrt());
    let reduced = &scaled * &free;
    let missing = -(residual + &scaled * &step);
    let rows = reduced.row_iter().map(|r| r.iter().copied().collect());
    let rows: Vec<Vec<f64>> = rows.collect();
    let own = Rank::of(rows.iter().map(Vec::as_slice), free.ncols(), 1e-12);
    let mut z = vec![0.0; free.ncols()];
    own.least_squares(missing.as_slice(), &mut z);
    step += free * DVector::from_vec(z);
    step
}

/// Initial displacements of joints, each as an equation of its own.
#[derive(Default)]
struct Asked {
    /// of joints that carry a part: place in v of the coordinate, and its value   [rad, length]
    coordinates: Vec<(usize, f64)>,
    /// of joints that carry nothing: the law between markers I and J, and the displacement
    rows: Vec<(Law, (usize, usize), f64)>,
}

impl Asked {
    /// Collects the initial displacements of a model's joints; none without `joints`.
    fn of(scene: &Scene, model: &Model, joints: bool) -> Self {
        let mut asked = Self::default();
        if !joints {
            return asked;
        }
        let joints = scene.constraints.iter();
        for element in joints.filter(|c| c.id.kind == ElementKind::Joint) {
            let id = element.id.number;
            let Some(joint) = model.joints.get(&id) else {
                continue;
            };
            let has = joint.kind.displacements();
            let has = [has.slides(), has.turns()];
            let given = [joint.ic_translation[0], joint.ic_rotation[0]];
            for (turn, value) in [false, true].into_iter().zip(given) {
                let Some(value) = value.filter(|_| has[usize::from(turn)]) else {
                    continue;
                };
                let own = scene
                    .coordinates
                    .iter()
                    .find(|c| c.joint == Some(id) && c.angular == turn);
                match (own.map(|c| c.source), element.markers) {
                    (Some(Source::Free { v, .. }), _) => asked.coordinates.push((v, value)),
                    (None, Some(markers)) => {
                        let law = if turn { Law::Angle } else { Law::Along(2) };
                        asked.rows.push((law, markers, value));
                    }
                    _ => {}
                }
            }
        }
        asked
    }
}

/// The distance of parts and joints from their given places, weighted, and its derivatives along
/// each velocity.
struct Distance {
    residual: DVector<f64>,
    /// (residuals × n_v)
    slopes: DMatrix<f64>,
}

impl Distance {
    /// Evaluates the distance at a position; `None` when something is not finite.
    fn at(
        scene: Configured<'_>,
        model: &Model,
        t: f64,
        q: &[f64],
        x: &[f64],
        asked: &Asked,
    ) -> Option<Self> {
        let n = scene.layout.n_v;
        let states = |v: &[f64]| {
            let numbers = assemble::numbers(scene, t, q, v, x);
            let at = Equations::new(scene, &numbers);
            let parts = 0..scene.parts.len();
            parts.map(|k| at.part(k, false)).collect::<Vec<_>>()
        };
        let still = states(&vec![0.0; n]);
        // parts
        let (mut residual, mut weight) = part_distances(&scene, model, &still);
        let rows = residual.len() + asked.coordinates.len() + asked.rows.len();
        let mut slopes = DMatrix::zeros(rows, n);
        let mut v = vec![0.0; n];
        for j in 0..n {
            v[j] = 1.0;
            for (k, (state, rest)) in states(&v).iter().zip(&still).enumerate() {
                let (linear, angular) = (state.v_GM - rest.v_GM, state.w_GM - rest.w_GM);
                for c in 0..3 {
                    slopes[(6 * k + c, j)] = linear.0[c];
                    slopes[(6 * k + 3 + c, j)] = angular.0[c];
                }
            }
            v[j] = 0.0;
        }
        // joints that carry a part
        for &(place, value) in &asked.coordinates {
            let own = scene.coordinates.iter().find_map(|c| match c.source {
                Source::Free { q, v } if v == place => Some((q, c.angular)),
                _ => None,
            });
            let (at, angular) = own?;
            slopes[(residual.len(), place)] = 1.0;
            residual.push(q[at] - value);
            weight.push(FIRM_WEIGHT / if angular { 1.0 } else { scene.size });
        }
        // joints that carry nothing
        let numbers = assemble::numbers(scene, t, q, &vec![0.0; n], x);
        let here = Equations::new(scene, &numbers);
        for &(law, markers, value) in &asked.rows {
            let row = here.marker_row(law, markers, Some(Drive::of(Jet::constant(value))));
            for (v, slope) in row.gradient {
                slopes[(residual.len(), v)] += slope;
            }
            residual.push(row.value);
            weight.push(FIRM_WEIGHT / if law.is_length() { scene.size } else { 1.0 });
        }
        // weights
        let mut residual = DVector::from_vec(residual);
        for (r, w) in weight.iter().enumerate() {
            residual[r] *= w;
            slopes.row_mut(r).scale_mut(*w);
        }
        let finite = residual.iter().chain(slopes.iter()).all(|x| x.is_finite());
        finite.then_some(Self { residual, slopes })
    }
}

/// Returns the distances of parts from the dataset, six for each, and their weights.
fn part_distances(
    scene: &Scene,
    model: &Model,
    still: &[MarkerState<f64>],
) -> (Vec<f64>, Vec<f64>) {
    let (mut residual, mut weight) = (Vec::new(), Vec::new());
    for (part, now) in scene.parts.iter().zip(still) {
        let exact = model.body(part.id).map_or([false; 6], |d| d.exact);
        let firm = |exact: bool| if exact { FIRM_WEIGHT } else { 1.0 };
        let off = now.p_GM - part.initial.position;
        for (exact, off) in exact.into_iter().zip(off.0) {
            weight.push(firm(exact) / scene.size);
            residual.push(off);
        }
        let turned = log(&(now.R_GM * part.initial.rotation.transpose()));
        for k in 0..3 {
            weight.push(if part.is_point_mass() {
                0.0
            } else {
                firm(exact[3] || exact[4] || exact[5])
            });
            residual.push(turned.0[k]);
        }
    }
    (residual, weight)
}

/// Returns the rotation vector of a rotation: axis times angle.
pub(super) fn log(R: &Mat3<f64>) -> Vec3<f64> {
    let [w, x, y, z] = crate::space::rotation::to_quaternion(R);
    let (sine, sign) = (
        (x * x + y * y + z * z).sqrt(),
        if w < 0.0 { -1.0 } else { 1.0 },
    );
    if sine == 0.0 {
        return Vec3::zero();
    }
    let angle = 2.0 * Scalar::atan2(sine, w.abs());
    Vec3([x, y, z]).times(sign * angle / sine)
}
