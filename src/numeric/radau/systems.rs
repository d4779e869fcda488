//! The linear systems of Radau's iteration: one real, one complex, of the same Jacobian.
//!
//! ```text
//! (γ − J) x = b            (α + iβ − J)(x + iy) = b + ic                         (1)
//! ```
//!
//! The systems are full (`full.rs`) unless the problem gives the pattern of its Jacobian
//! (`sparse.rs`). Both eliminate positions first.

use super::full::Full;
use super::sparse::Sparse;
use crate::numeric::{Failure, Ode};
use std::sync::Arc;

/// Both systems (1), and the Jacobian in them.
#[derive(Clone, Debug)]
pub(super) struct Systems {
    n: usize,
    /// ∂f/∂y, by columns, or at the entries of the pattern
    jacobian: Vec<f64>,
    /// ∂f/∂t   (n)
    dfdt: Vec<f64>,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    Full(Box<Full>),
    Sparse(Box<Sparse>),
}

impl Systems {
    /// Creates full systems of `n` unknowns.
    pub fn new(n: usize) -> Self {
        Systems {
            n,
            jacobian: Vec::new(),
            dfdt: Vec::new(),
            kind: Kind::Full(Box::new(Full::new(n))),
        }
    }

    /// Becomes full or sparse, as the problem's Jacobian is.
    pub fn shape<P: Ode + ?Sized>(&mut self, problem: &mut P) {
        let n = self.n;
        match (problem.pattern(), &self.kind) {
            (Some(pattern), Kind::Sparse(s)) if Arc::ptr_eq(&pattern, &s.pattern) => {}
            (Some(pattern), _) => {
                self.jacobian = vec![0.0; pattern.n_entries()];
                self.kind = Kind::Sparse(Box::new(Sparse::new(pattern)));
            }
            (None, Kind::Full(..)) if self.jacobian.len() == n * n => {}
            (None, _) => {
                (self.jacobian, self.dfdt) = (vec![0.0; n * n], vec![0.0; n]);
                self.kind = Kind::Full(Box::new(Full::new(n)));
            }
        }
    }

    /// Leaves the Jacobian, ∂f/∂t, and the factors of full systems; nothing stays here.
    pub fn leave(&mut self) -> (Vec<f64>, Vec<f64>, Option<Box<Full>>) {
        let left = std::mem::replace(self, Systems::new(self.n));
        let full = match left.kind {
            Kind::Full(full) => Some(full),
            // whose pivots are those of the first Jacobian
            Kind::Sparse(_) => None,
        };
        (left.jacobian, left.dfdt, full)
    }

    /// Takes a Jacobian of the same shape, and ∂f/∂t; returns whether it is of that.
    pub fn take(&mut self, jacobian: &[f64], dfdt: &[f64]) -> bool {
        if self.jacobian.len() != jacobian.len() || self.dfdt.len() != dfdt.len() {
            return false;
        }
        self.jacobian.copy_from_slice(jacobian);
        self.dfdt.copy_from_slice(dfdt);
        true
    }

    /// Takes the factors that were left with the Jacobian; returns whether they are those that
    /// would be made of it.
    pub fn take_factors(&mut self, left: Option<&Full>) -> bool {
        let (Kind::Full(full), Some(left)) = (&mut self.kind, left) else {
            return false;
        };
        full.take(left, &self.jacobian)
    }

    /// Takes note of a Jacobian without factors.
    pub fn begin(&mut self) {
        if let Kind::Full(full) = &mut self.kind {
            full.see(&self.jacobian);
        }
    }

    /// Evaluates the Jacobian at `(t, y)`.
    ///
    /// # Errors
    /// When it has no finite value there.
    pub fn evaluate<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        t: f64,
        y: &[f64],
    ) -> Result<(), Failure> {
        match &mut self.kind {
            Kind::Full(full) => {
                problem.jacobian(t, y, &mut self.jacobian, &mut self.dfdt)?;
                full.see(&self.jacobian);
                Ok(())
            }
            Kind::Sparse(_) => problem.jacobian_entries(t, y, &mut self.jacobian),
        }
    }

    /// Returns a row whose derivatives are not finite, if there is one.
    pub fn not_finite(&self) -> Option<usize> {
        let sum: f64 = self.jacobian.iter().map(|x| x * 0.0).sum();
        if sum == 0.0 {
            return None;
        }
        let entry = self.jacobian.iter().position(|x| !x.is_finite())?;
        match &self.kind {
            Kind::Full(..) => Some(entry % self.n.max(1)),
            Kind::Sparse(s) => s.pattern.entries().nth(entry).map(|(i, _)| i),
        }
    }

    /// Returns about how many operations a factorization takes, and a correction.
    pub fn operations(&self) -> [usize; 2] {
        // kept unknowns, and entries of the factors
        let (m, fill) = match &self.kind {
            Kind::Full(full) => (full.n_kept(), full.n_kept() * full.n_kept()),
            Kind::Sparse(s) => (s.n_kept(), s.fill()),
        };
        // a complex multiplication is four, and the real system is there as well
        [5 * fill * fill / (3 * m.max(1)), 5 * fill]
    }

    /// Factors both matrices of (1).
    ///
    /// # Errors
    /// The unknown that nothing determines.
    pub fn factor(&mut self, gamma: f64, alpha: f64, beta: f64) -> Result<(), usize> {
        match &mut self.kind {
            Kind::Sparse(s) => s.factor(&self.jacobian, gamma, [alpha, beta]),
            Kind::Full(full) => full.factor(&self.jacobian, gamma, alpha, beta),
        }
    }

    /// `to ← |J| x`, entry by entry
    pub fn times_sizes(&self, x: &[f64], to: &mut [f64]) {
        to.fill(0.0);
        let mut add = |(i, j): (usize, usize), entry: &f64| to[i] += entry.abs() * x[j];
        match &self.kind {
            Kind::Full(_) => {
                let columns = self.jacobian.chunks_exact(self.n.max(1)).enumerate();
                columns.for_each(|(j, c)| c.iter().enumerate().for_each(|(i, e)| add((i, j), e)));
            }
            Kind::Sparse(s) => {
                let entries = s.pattern.entries().zip(&self.jacobian);
                entries.for_each(|(place, e)| add(place, e));
            }
        }
    }

    /// `x ← (γ − J)⁻¹ x`
    pub fn solve(&mut self, x: &mut [f64]) {
        match &mut self.kind {
            Kind::Full(full) => full.solve(x),
            Kind::Sparse(s) => s.solve(x),
        }
    }

    /// `re + i im ← (α + iβ − J)⁻¹ (re + i im)`
    pub fn solve_complex(&mut self, re: &mut [f64], im: &mut [f64]) {
        match &mut self.kind {
            Kind::Full(full) => full.solve_complex(re, im),
            Kind::Sparse(s) => s.solve_complex(re, im),
        }
    }
}
