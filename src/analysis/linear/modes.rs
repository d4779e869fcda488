//! Eigenvalues and mode shapes of a linear system.
//!
//! Eigenvalues are those of the balanced matrix, so that slow modes keep their digits beside fast
//! ones. Rounding δA of the matrix moves them by
//!
//! ```text
//! |δλ| ≤ κ ‖δA‖,  κ = |y||x|/|yᴴx|      A x = λ x,  yᴴA = λ yᴴ                         (1)
//! ```
//!
//! A free motion has two eigenvalues of zero with one shape: κ is infinite, rounding parts them by
//! its root, and they look like a slow swing or a slow growth. Those that are no more than (1) are
//! zero.
//!
//! Shapes come from inverse iteration, `(A − λ') x ← x` with λ' beside λ; those of equal
//! eigenvalues are kept apart.

use super::{Mode, PartShape, Small, Wanted};
use crate::analysis::system::System;
use crate::arrange::Arrange;
use crate::diagnostic::Diagnostic;
use crate::model::Model;
use crate::numeric;
use crate::numeric::connected::{SparseRow, connected};
use crate::scalar::Scalar;
use crate::scene::Scene;
use crate::scene::equations::Equations;
use crate::scene::layout::Layout;
use crate::space::Vec3;
use nalgebra::linalg::Hessenberg;
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector};

/// Inverse iterations: each takes away all but a rounding of the other modes.
const INVERSE_ITERATIONS: usize = 4;

/// Rounding of the entries of A, relative to its norm: they come out of a factorization of masses.
const ROUNDING: f64 = 1e3 * f64::EPSILON;
/// Size of an eigenvalue, relative to the norm of A, above which it is not that of a free motion:
/// rounding parts three equal ones by its cubic root.
const SURELY_NOT_FREE: f64 = 1e-4;

/// Returns the eigenvalues of A by size, one of each conjugate pair, with their shapes.
pub(super) fn modes(
    system: &System,
    model: &Model,
    small: &Small,
    a: &DMatrix<f64>,
    wanted: &Wanted,
) -> Result<Vec<Mode>, Vec<Diagnostic>> {
    let size = a.nrows();
    if size == 0 {
        return Ok(Vec::new());
    }
    let parts = parts(a);
    let mut values: Vec<(Complex<f64>, &Part)> = Vec::with_capacity(size);
    for part in &parts {
        let found = part.eigenvalues().ok_or_else(|| {
            vec![Diagnostic::error(
                "linear",
                "the eigenvalues cannot be found: the iteration does not converge",
            )]
        })?;
        values.extend(found.into_iter().map(|v| (part.without_rounding(v), part)));
    }
    values.retain(|(v, _)| v.im >= 0.0);
    values.arrange_by(|(x, _), (y, _)| {
        let by_size = x.norm().total_cmp(&y.norm());
        by_size.then(x.re.total_cmp(&y.re))
    });
    let [first, last] = wanted.shapes.unwrap_or([1, usize::MAX]);
    let motion = PartMotion::of(system, model, small);
    let names = system.scene.unknown_names();
    let mut found: Vec<Mode> = Vec::with_capacity(values.len());
    let mut vectors: Vec<(Complex<f64>, &Part, Shape)> = Vec::new();
    for (k, &(value, part)) in values.iter().enumerate() {
        let mut mode = Mode {
            re: value.re,
            im: value.im,
            parts: Vec::new(),
            states: Vec::new(),
        };
        if (first..=last).contains(&(k + 1)) {
            let near: Vec<&Shape> = vectors
                .iter()
                .filter(|(v, other, _)| {
                    let near = 1e-8 * value.norm().max(1e-6 * part.norm);
                    std::ptr::eq(*other, part) && (v - value).norm() <= near
                })
                .map(|(_, _, x)| x)
                .collect();
            if let Some(x) = eigenvector(&part.balanced, value, part.norm, &near) {
                let mut own = DVector::zeros(size);
                for ((&place, x), s) in part.places.iter().zip(x.iter()).zip(part.scales.iter()) {
                    own[place] = x * Complex::new(*s, 0.0);
                }
                vectors.push((value, part, x));
                motion.show(&mut mode, &own, &names);
            }
        }
        found.push(mode);
    }
    Ok(found)
}

/// An eigenvector of a part, of length one.
type Shape = DVector<Complex<f64>>;

/// A part of the states that nothing couples to the others, with its block of the matrix.
pub(super) struct Part {
    /// ascending
    places: Vec<usize>,
    balanced: DMatrix<f64>,
    scales: DVector<f64>,
    norm: f64,
}

/// Takes a matrix apart: what nothing couples has eigenvalues, and rounding, of its own.
pub(super) fn parts(a: &DMatrix<f64>) -> Vec<Part> {
    let n = a.nrows();
    let row = |i: usize| {
        let entries = (0..n).filter(|&j| a[(i, j)] != 0.0);
        let others = entries.map(|j| (j, a[(i, j)]));
        std::iter::once((i, 0.0)).chain(others).collect()
    };
    let rows: Vec<SparseRow> = (0..n).map(row).collect();
    let blocks = connected(&rows, n).into_iter();
    blocks
        .map(|block| {
            let places = block.columns;
            let m = places.len();
            let mut balanced = DMatrix::from_fn(m, m, |i, j| a[(places[i], places[j])]);
            let scales = balance_parlett_reinsch(&mut balanced);
            Part {
                norm: balanced.norm(),
                places,
                balanced,
                scales,
            }
        })
        .collect()
}

impl Part {
    /// Returns its eigenvalues, in no particular order; `None`: the iteration does not converge.
    pub fn eigenvalues(&self) -> Option<Vec<Complex<f64>>> {
        let n = self.balanced.nrows();
        if n < 2 {
            let all = self.balanced.iter();
            return Some(all.map(|&x| Complex::new(x, 0.0)).collect());
        }
        let mut by_rows = Hessenberg::new(self.balanced.clone())
            .unpack_h()
            .transpose();
        let found = numeric::eigenvalues::eigenvalues(by_rows.as_mut_slice(), n)?;
        let pairs = found.into_iter();
        Some(pairs.map(|(re, im)| Complex::new(re, im)).collect())
    }

    /// Returns an eigenvalue without what rounding makes of it.
    fn without_rounding(&self, mut v: Complex<f64>) -> Complex<f64> {
        let size = v.norm();
        if size < SURELY_NOT_FREE * self.norm && self.is_rounding(v, size) {
            return Complex::new(0.0, 0.0);
        }
        // a real one that has been perturbed into a pair by less than rounding stays as it is
        if v.im.abs() < 1e-14 * v.norm() {
            v.im = 0.0;
        }
        if v.re.abs() < ROUNDING * v.im.abs() {
            v.re = 0.0;
        }
        v
    }

    /// Returns whether rounding of the matrix may make a part of an eigenvalue so large (1).
    pub fn is_rounding(&self, value: Complex<f64>, part: f64) -> bool {
        let least = ROUNDING * self.norm;
        if part <= least {
            return true;
        }
        let right = eigenvector(&self.balanced, value, self.norm, &[]);
        let left = eigenvector(&self.balanced.transpose(), value.conj(), self.norm, &[]);
        let (Some(right), Some(left)) = (right, left) else {
            return true;
        };
        // both are of length one
        part * left.dotc(&right).norm() <= least
    }
}

/// Finds an eigenvector by inverse iteration, apart from those found before for the same value.
fn eigenvector(
    a: &DMatrix<f64>,
    value: Complex<f64>,
    norm: f64,
    before: &[&Shape],
) -> Option<Shape> {
    let n = a.nrows();
    let shift = value + Complex::new(1e-13 * norm.min(value.norm() + 1e-3 * norm), 0.0);
    let mut shifted = a.map(|x| Complex::new(x, 0.0));
    for k in 0..n {
        shifted[(k, k)] -= shift;
    }
    let lu = shifted.lu();
    // any start that is not special will do; another for each repetition
    let seed = before.len() as f64;
    let mut x = DVector::from_fn(n, |k, _| {
        Complex::new(
            1.0 + Scalar::sin(1.7 * k as f64 + seed) * 0.5,
            Scalar::cos(2.3 * k as f64 + 3.0 * seed) * 0.3,
        )
    });
    for _ in 0..INVERSE_ITERATIONS {
        for b in before {
            let part = b.dotc(&x);
            x -= *b * part;
        }
        x = lu.solve(&x)?;
        let size = x.norm();
        if !size.is_finite() || size == 0.0 {
            return None;
        }
        x.unscale_mut(size);
    }
    Some(x)
}

/// Returns the centre of mass of a part; where it has none, the origin of its frame.
pub(super) fn center<S: Scalar>(
    scene: &Scene,
    model: &Model,
    at: &Equations<S>,
    part: usize,
) -> Vec3<S> {
    let cm = model.body(scene.parts[part].id).and_then(|p| p.cm);
    let cm = cm.and_then(|cm| scene.marker_of.get(&cm));
    cm.map_or_else(|| at.part(part, false).p_GM, |&m| at.marker(m).p_GM)
}

/// The motions of parts with z: centre of mass and rotation, ground axes.
struct PartMotion {
    parts: Vec<String>,
    /// (6 n_parts × n_free)
    map: DMatrix<f64>,
    /// numbers of positions, and of positions and velocities
    n: usize,
    n_moving: usize,
    layout: Layout,
}

impl PartMotion {
    fn of(system: &System, model: &Model, small: &Small) -> Self {
        let scene = system.configured();
        let l = scene.layout;
        let mut numbers = system.numbers.clone();
        let mut twists = |k: Option<usize>| -> Vec<f64> {
            numbers[l.v()].fill(0.0);
            if let Some(k) = k {
                numbers[l.v_at(k)] = 1.0;
            }
            let at = Equations::new(scene, &numbers);
            let mut all = Vec::with_capacity(6 * scene.parts.len());
            for k in 0..scene.parts.len() {
                let state = at.part(k, false);
                let arm = center(&system.scene, model, &at, k) - state.p_GM;
                let v = state.v_GM + state.w_GM.cross(arm);
                all.extend(v.0.into_iter().chain(state.w_GM.0));
            }
            all
        };
        let none = twists(None);
        let mut jacobian = DMatrix::zeros(none.len(), l.n_v);
        for k in 0..l.n_v {
            for (i, x) in twists(Some(k)).iter().enumerate() {
                jacobian[(i, k)] = x - none[i];
            }
        }
        Self {
            parts: scene.parts.iter().map(|p| p.id.to_string()).collect(),
            map: jacobian * &small.z,
            n: small.z.ncols(),
            n_moving: small.n_moving(),
            layout: l,
        }
    }

    /// Puts its shape into a mode, scaled so that its largest number is 1.
    fn show(&self, mode: &mut Mode, z: &DVector<Complex<f64>>, names: &[String]) {
        let map = self.map.map(|x| Complex::new(x, 0.0));
        let moved = map * z.rows(0, self.n);
        let largest = |all: &mut dyn Iterator<Item = Complex<f64>>| {
            all.fold(Complex::new(0.0, 0.0), |m: Complex<f64>, x| {
                if x.norm() > m.norm() * (1.0 + 1e-9) {
                    x
                } else {
                    m
                }
            })
        };
        let part = |first: usize| {
            moved
                .iter()
                .enumerate()
                .filter(move |(k, _)| k % 6 / 3 == first)
                .map(|(_, x)| *x)
        };
        let whole = z.norm();
        let mut unit = largest(&mut part(0));
        if unit.norm() <= 1e-9 * whole {
            unit = largest(&mut part(1));
        }
        if unit.norm() <= 1e-9 * whole {
            unit = largest(&mut z.rows(self.n_moving, self.layout.n_x).iter().copied());
        }
        if unit.norm() == 0.0 {
            return;
        }
        let pair = |x: Complex<f64>| {
            let x = x / unit;
            [x.re, x.im]
        };
        mode.parts = self
            .parts
            .iter()
            .enumerate()
            .map(|(k, name)| PartShape {
                part: name.clone(),
                translation: [0, 1, 2].map(|i| pair(moved[6 * k + i])),
                rotation: [3, 4, 5].map(|i| pair(moved[6 * k + i])),
            })
            .collect();
        let states = self.layout.state(names).x.iter().enumerate();
        mode.states = states
            .map(|(k, name)| (name.clone(), pair(z[self.n_moving + k])))
            .collect();
    }
}
