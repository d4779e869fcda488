//! The stability of an equilibrium: directions in which a small push is answered, and how.
//!
//! ```text
//! M q̈ = −C q̇ − K q                         q: along the directions that rows leave
//! ½ q̇ᵀM q̇ + ½ qᵀK q falls by q̇ᵀC q̇         (1)
//! ```
//!
//! By (1), stiffness alone decides where K is symmetric and C takes energy or none. Follower loads,
//! negative dampers and states that act back break that: eigenvalues decide then.

use super::Settler;
use super::point::Point;
use crate::diagnostic::counted;
use crate::numeric::eigenvalues::eigenvalues;
use crate::numeric::pattern::Pattern;
use crate::numeric::rank::{Rank, TOLERANCE};
use crate::scalar::Scalar;
use crate::scene::programs::record_moving;
use crate::scene::slopes::{Direction, along};
use nalgebra::{Cholesky, DMatrix, DVector};

/// Asymmetry of a stiffness, as a part of the whole, up to which loads have a potential: what is
/// left of an equilibrium's imbalance causes less.
const ASYMMETRY: f64 = 1e-6;
/// Damping below zero, as a part of the largest, that is rounding.
const DAMPING_ROUNDING: f64 = 1e-9;

/// The answers of an equilibrium to a small push.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stability {
    /// directions in which it is pushed back
    pub stable: usize,
    /// directions in which nothing happens
    pub neutral: usize,
    /// directions in which it leaves
    pub unstable: usize,
}

impl Stability {
    /// Writes them: "stable, indifferent in 2 directions".
    pub fn words(&self) -> String {
        match (self.unstable, self.neutral) {
            (0, 0) => "stable".into(),
            (0, n) => format!("stable, indifferent in {}", counted(n, "direction")),
            (n, _) => format!("unstable in {}", counted(n, "direction")),
        }
    }
}

/// An equilibrium's answers to a push, and what is needed to find out more.
pub(super) struct Answers {
    pub stability: Stability,
    /// the direction in which the model leaves fastest
    pub descent: Option<DVector<f64>>,
    /// whether the stiffness is that of a potential
    has_potential: bool,
    small: Option<Small>,
}

/// The directions that rows leave.
struct Small {
    /// (n_v × n_free)
    z: DMatrix<f64>,
    /// L of ZᵀMZ = L Lᵀ
    lower: DMatrix<f64>,
}

impl Small {
    fn at(p: &Point, n: usize) -> Option<Self> {
        let gradient = p.rows.gradient.transpose();
        let columns = gradient.column_iter().map(|c| c.iter().copied().collect());
        let columns: Vec<Vec<f64>> = columns.collect();
        let free = Rank::of(columns.iter().map(Vec::as_slice), n, TOLERANCE).free_directions();
        if free.is_empty() {
            return None;
        }
        let z = DMatrix::from_fn(n, free.len(), |i, j| free[j][i]);
        let mut metric = DMatrix::zeros(n, n);
        p.metric.add_to(&mut metric.as_view_mut(), 1.0);
        let lower = Cholesky::new(z.transpose() * metric * &z)?.l();
        Some(Self { z, lower })
    }

    /// Returns L⁻¹ ZᵀA Z L⁻ᵀ.
    fn reduced(&self, a: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let own = self.z.transpose() * a * &self.z;
        let half = self.lower.solve_lower_triangular(&own)?;
        let reduced = self.lower.solve_lower_triangular(&half.transpose())?;
        Some(reduced.transpose())
    }
}

impl Settler<'_> {
    /// Finds the answers to a push.
    pub(super) fn stability(&mut self, p: &Point, jacobian: &DMatrix<f64>) -> Answers {
        let (n, d) = (self.n_v(), self.states.len());
        let mut answers = Answers {
            stability: Stability::default(),
            descent: None,
            has_potential: true,
            small: None,
        };
        if self.asked.stops() {
            return answers;
        }
        answers.small = Small::at(p, n);
        if self.asked.stops() {
            return answers;
        }
        let Some(small) = &answers.small else {
            return answers;
        };
        let Some(reduced) = small.reduced(&-self.stiffness(jacobian)) else {
            return answers;
        };
        if self.asked.stops() {
            return answers;
        }
        let symmetric = (&reduced + reduced.transpose()) * 0.5;
        let eigen = symmetric.symmetric_eigen();
        answers.has_potential = asymmetry(&reduced) < ASYMMETRY;
        let values: Vec<f64> = if answers.has_potential {
            eigen.eigenvalues.iter().copied().collect()
        } else {
            // where an entry is not finite, the symmetric part tells the work of a push
            let (n, mut by_rows) = (reduced.nrows(), reduced.transpose());
            match eigenvalues(by_rows.as_mut_slice(), n) {
                Some(found) => found.iter().map(|z| z.0).collect(),
                None => eigen.eigenvalues.iter().copied().collect(),
            }
        };
        let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for x in &values {
            if x.abs() <= 1e-9 * largest || largest == 0.0 {
                answers.stability.neutral += 1;
            } else if *x > 0.0 {
                answers.stability.stable += 1;
            } else {
                answers.stability.unstable += 1;
            }
        }
        let lowest = eigen.eigenvalues.imin();
        let direction = eigen.eigenvectors.column(lowest).into_owned();
        let direction = small.lower.tr_solve_lower_triangular(&direction);
        answers.descent = direction.map(|c| {
            let x = &small.z * c;
            let size = self.excess(&x) * self.settings.angle;
            let x = if size > 0.0 { x / size } else { x };
            x.insert_rows(n, d, 0.0)
        });
        answers
    }

    /// Returns the slopes of loads along coordinates, which states follow: K − K_x e_x⁻¹ e_q.
    fn stiffness(&self, jacobian: &DMatrix<f64>) -> DMatrix<f64> {
        let (n, d) = (self.n_v(), self.states.len());
        let mut k = jacobian.view((0, 0), (n, n)).into_owned();
        if d == 0 {
            return k;
        }
        let own = jacobian.view((n, n), (d, d)).into_owned();
        let mut moved = jacobian.view((n, 0), (d, n)).into_owned();
        let inverse = own.clone().try_inverse().or_else(|| {
            // integrals of velocities follow these, in a motion as slow as may be:
            // λ x = e_x x + (e_q + λ e_v) q
            let slow = 1e-6 * own.amax().max(1.0);
            moved += self.drift.as_ref()? * slow;
            (own - DMatrix::identity(d, d) * slow).try_inverse()
        });
        if let Some(inverse) = inverse {
            let follow = inverse * moved;
            k -= jacobian.view((0, n), (n, d)) * follow;
        }
        k
    }

    /// Returns whether stiffness alone decides what becomes of a push: loads have a potential, what
    /// depends on velocities takes energy, and no state acts back.
    pub(super) fn is_passive(&mut self, p: &Point, answers: &Answers) -> bool {
        let Some(small) = &answers.small else {
            return true;
        };
        if !answers.has_potential || !self.system.scene.differentials.is_empty() {
            return false;
        }
        let Some(damping) = self.damping(p) else {
            return true;
        };
        let Some(reduced) = small.reduced(&damping) else {
            return false;
        };
        let taken = ((&reduced + reduced.transpose()) * 0.5).symmetric_eigenvalues();
        taken.min() >= -DAMPING_ROUNDING * reduced.amax()
    }

    /// Returns −∂f/∂v   (n_v × n_v); `None` where no load reads a velocity.
    fn damping(&mut self, p: &Point) -> Option<DMatrix<f64>> {
        let (n, m) = (self.n_v(), self.rows.len());
        let scene = self.system.configured();
        let loads = record_moving(scene, |at| at.balance(&vec![Scalar::zero(); m]));
        let places = scene.layout.v();
        let mut changed = vec![Vec::new(); scene.layout.len()];
        (places.clone().enumerate()).for_each(|(k, place)| changed[place].push(k as u32));
        self.system.depend_along(&mut changed);
        let follows = loads.dependence(&changed);
        if follows.iter().all(|along| along.is_empty()) {
            return None;
        }
        let pattern = Pattern::of_rows(n, &follows);
        let speeds: Vec<Direction> = places.map(|place| vec![(place, 1.0)]).collect();
        let all = p.numbers.iter().copied();
        let follow = |numbers: &mut [_], first| self.system.follow_along(numbers, first);
        let pattern = Some(&pattern);
        let slopes = along(&loads, &mut self.dual_work, all, &speeds, pattern, follow).ok();
        // where nothing determines a loop, nothing is known of what takes energy
        Some(-slopes.unwrap_or_else(|| DMatrix::identity(n, n)))
    }
}

/// Returns the size of the part that is not symmetric, relative to the whole.
pub(super) fn asymmetry(a: &DMatrix<f64>) -> f64 {
    let size = a.amax();
    if size == 0.0 {
        return 0.0;
    }
    (a - a.transpose()).amax() / size
}
