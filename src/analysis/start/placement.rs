//! Where parts go when they do not fit: the positions nearest to those of the dataset that satisfy all rows.
//!
//! ```text
//! least  Σ w² |change of a part's place|² + Σ W² (joint − IC)²     subject to the rows
//! w = 1, for coordinates that EXACT names and for IC of joints 10⁵ (weights 1 and 10¹⁰ of the squares, as in Adams)
//! ```
//!
//! Changes of place are those of the part's origin, against the size of the mechanism, and of its orientation, in rad. They are counted by parts, not by
//! coordinates, so that the answer does not depend on what carries what. An Euler angle that EXACT names holds the whole orientation: the angles of a part
//! that turns about another axis all change. Gauss–Newton: `Δ = Δ₀ + N z`, with `Δ₀` closing the rows, N what they leave free, and z least squares.

use crate::analysis::start::assemble;
use crate::model::{ElementKind, JointKind, Model};
use crate::numeric::rank::Rank;
use crate::physics::row::Law;
use crate::scalar::{Jet, Scalar};
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::scene::mover::Mover;
use crate::scene::programs::weights;
use crate::scene::{Scene, Source};
use crate::space::{Mat3, Vec3};
use nalgebra::{DMatrix, DVector};

/// What EXACT and IC weigh more than an ordinary coordinate.
const FIRM: f64 = 1e5;
/// Largest mechanism whose parts are weighed: beyond, coordinates move as little as may be.
const LARGEST: usize = 300;
/// Change below which a place is one.
const ARRIVED: f64 = 1e-11;

/// IC, ICTRAN, ICROT of joints that carry a part: where assembly begins.
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

/// Moves `q` to the positions nearest to the dataset. `joints`: IC of joints count. False: the mechanism is not one that is placed
/// like this, or no step led anywhere.
pub fn settle(
    scene: Configured<'_>,
    model: &Model,
    t: f64,
    q: &mut [f64],
    x: &[f64],
    joints: bool,
) -> bool {
    let l = scene.layout;
    // contacts of curves go where their bodies are: coordinates decide
    if l.n_v == 0 || l.n_v > LARGEST || !scene.cams.is_empty() {
        return false;
    }
    let asked = Asked::of(&scene, model, joints);
    let w = weights(&scene);
    let mover = Mover::new(&scene);
    let mut here = q.to_vec();
    for k in 0..40 {
        let Some((residual, slopes)) = wishes(scene, model, t, &here, x, &asked) else {
            return false;
        };
        let (mut g, mut gradient, _) = assemble::rows_at(scene, t, &here, x);
        for r in (0..g.len()).filter(|&r| scene.is_held(r)) {
            g[r] = 0.0;
            gradient.row_mut(r).fill(0.0);
        }
        let off = (0..g.len()).fold(0.0, |m: f64, r| m.max((g[r] / scene.row_scale(r)).abs()));
        if k == 0 && off < 1e-9 && residual.amax() < 1e-9 {
            return true;
        }
        // in coordinates scaled by √w
        let rows = assemble::scaled_rows(&gradient, &w);
        let rank = Rank::of(rows.iter().map(Vec::as_slice), w.len(), 1e-9);
        let mut step = vec![0.0; w.len()];
        rank.least_norm((-g).as_slice(), &mut step);
        let mut step = DVector::from_vec(step);
        let free = rank.free_directions();
        if !free.is_empty() {
            let free = DMatrix::from_fn(w.len(), free.len(), |i, j| free[j][i]);
            let scaled =
                DMatrix::from_fn(slopes.nrows(), w.len(), |i, j| slopes[(i, j)] * w[j].sqrt());
            let reduced = &scaled * &free;
            let missing = -(residual + &scaled * &step);
            let rows: Vec<Vec<f64>> = reduced
                .row_iter()
                .map(|r| r.iter().copied().collect())
                .collect();
            let own = Rank::of(rows.iter().map(Vec::as_slice), free.ncols(), 1e-12);
            let mut z = vec![0.0; free.ncols()];
            own.least_squares(missing.as_slice(), &mut z);
            step += free * DVector::from_vec(z);
        }
        let longest = step.amax();
        if !longest.is_finite() {
            return false;
        }
        let damping = (0.5 / longest).min(1.0);
        let change: Vec<f64> = step
            .iter()
            .zip(&w)
            .map(|(s, w)| damping * s * w.sqrt())
            .collect();
        mover.displace(&mut here, &change);
        if longest < ARRIVED {
            break;
        }
    }
    q.copy_from_slice(&here);
    true
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
            let has = match joint.kind {
                JointKind::Revolute => [false, true],
                JointKind::Translational => [true, false],
                JointKind::Cylindrical => [true, true],
                _ => [false, false],
            };
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

/// How far parts and joints are from what is wished, weighted, and how that changes along each velocity; `None` when something is not finite.
fn wishes(
    scene: Configured<'_>,
    model: &Model,
    t: f64,
    q: &[f64],
    x: &[f64],
    asked: &Asked,
) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let n = scene.layout.n_v;
    let at = |v: &[f64]| {
        let numbers = assemble::numbers(scene, t, q, v, x);
        let at = Equations::new(scene, &numbers);
        (0..scene.parts.len())
            .map(|k| at.part(k, false))
            .collect::<Vec<_>>()
    };
    let still = at(&vec![0.0; n]);
    let mut residual = Vec::new();
    let mut weight = Vec::new();
    for (part, now) in scene.parts.iter().zip(&still) {
        let exact = model.body(part.id).map_or([false; 6], |d| d.exact);
        let firm = |exact: bool| if exact { FIRM } else { 1.0 };
        let off = now.p_GM - part.initial.position;
        for (exact, off) in exact.into_iter().zip(off.0) {
            weight.push(firm(exact) / scene.length);
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
    let parts = residual.len();
    let rows = parts + asked.coordinates.len() + asked.rows.len();
    let mut slopes = DMatrix::zeros(rows, n);
    let mut v = vec![0.0; n];
    for j in 0..n {
        v[j] = 1.0;
        for (k, (state, rest)) in at(&v).iter().zip(&still).enumerate() {
            let (linear, angular) = (state.v_GM - rest.v_GM, state.w_GM - rest.w_GM);
            for c in 0..3 {
                slopes[(6 * k + c, j)] = linear.0[c];
                slopes[(6 * k + 3 + c, j)] = angular.0[c];
            }
        }
        v[j] = 0.0;
    }
    for &(place, value) in &asked.coordinates {
        let own = scene.coordinates.iter().find_map(|c| match c.source {
            Source::Free { q, v } if v == place => Some((q, c.angular)),
            _ => None,
        });
        let (at, angular) = own?;
        slopes[(residual.len(), place)] = 1.0;
        residual.push(q[at] - value);
        weight.push(FIRM / if angular { 1.0 } else { scene.length });
    }
    let numbers = assemble::numbers(scene, t, q, &vec![0.0; n], x);
    let here = Equations::new(scene, &numbers);
    for &(law, markers, value) in &asked.rows {
        let row = here.marker_row(law, markers, Some(Jet::constant(value)));
        for (v, slope) in row.gradient {
            slopes[(residual.len(), v)] += slope;
        }
        residual.push(row.value);
        weight.push(FIRM / if law.is_length() { scene.length } else { 1.0 });
    }
    let mut residual = DVector::from_vec(residual);
    for (r, w) in weight.iter().enumerate() {
        residual[r] *= w;
        slopes.row_mut(r).scale_mut(*w);
    }
    (residual.iter().all(|x| x.is_finite()) && slopes.iter().all(|x| x.is_finite()))
        .then_some((residual, slopes))
}

/// The rotation vector of a rotation: axis times angle.
fn log(R: &Mat3<f64>) -> Vec3<f64> {
    let [w, x, y, z] = crate::space::rotation::to_quaternion(R);
    let (sine, sign) = (
        (x * x + y * y + z * z).sqrt(),
        if w < 0.0 { -1.0 } else { 1.0 },
    );
    if sine == 0.0 {
        return Vec3::zero();
    }
    let angle = 2.0 * sine.atan2(w.abs());
    Vec3([x, y, z]).times(sign * angle / sine)
}
