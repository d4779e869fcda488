//! A scene as an implicit system: what the methods for differential-algebraic equations see.
//!
//! ```text
//! I3    q̇ = N(q) v                  M v̇ + h = f + Gᵀλ      ẋ = s      g(t, q) = 0                     y = q | v | x | λ
//! SI2   q̇ = N(q) (v + Gᵀμ)          M v̇ + h = f + Gᵀλ      ẋ = s      g = 0,  G v + ġ₀ = 0            y = q | v | x | λ | μ
//! ```
//!
//! Both are recorded from the same equations as the explicit rates. I3 controls the errors of positions only; the second multiplier of
//! SI2, zero but for the error of the method, lets the rows hold in velocity too, and velocities are controlled.
//!
//! Source: Gear, Gupta & Leimkuhler 1985 for SI2.

use super::outside::Outside;
use super::system::System;
use super::unknowns::WIDTH;
use crate::diagnostic::Diagnostic;
use crate::expr::program::{Builder, Folding, Input, Program, Work};
use crate::numeric::pattern::Pattern;
use crate::numeric::{Dae, Failure, Kind, Levels, Ode, Relation};
use crate::scalar::{Dual, Scalar};
use crate::scene::Scene;
use crate::scene::equations::Equations;
use crate::scene::programs::{record, record_more};

/// Which levels of the rows an implicit method sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Formulation {
    /// positions alone
    Index3,
    /// positions, and velocities with a second multiplier
    Stabilized,
}

/// The implicit equations of a scene.
#[derive(Debug)]
pub struct Implicit {
    formulation: Formulation,
    /// unknowns of the explicit system; rows that take part
    n: usize,
    m: usize,
    residual: Program,
    /// multipliers at a state
    multipliers: Program,
    jacobian: Jacobian,
    work: Work,
    /// what the residual reads: the numbers, then ẏ, λ, μ
    numbers: Vec<f64>,
}

/// Derivatives of the residual.
#[derive(Debug)]
enum Jacobian {
    /// recorded: entries (row, column), the output that is ∂F/∂y, the one that is ∂F/∂ẏ
    Recorded {
        program: Program,
        work: Work,
        entries: Vec<(usize, usize, Option<usize>, Option<usize>)>,
        out: Vec<f64>,
    },
    /// by duals, columns that share no row together: where the program would be too long, and where numbers come from outside
    Duals {
        pattern: Pattern,
        work: Work<Dual<WIDTH>>,
        numbers: Vec<Dual<WIDTH>>,
        out: Vec<Dual<WIDTH>>,
    },
}

/// Most operations whose derivatives are recorded, in products with the unknowns.
const LONGEST: usize = 400_000;

fn residual<S: Scalar>(
    scene: &Scene,
    at: &Equations<'_, S>,
    more: &[S],
    formulation: Formulation,
) -> Vec<S> {
    let l = scene.layout;
    let n = l.y().len();
    let (ydot, multipliers) = more.split_at(n);
    let rows: Vec<_> = (0..scene.rows.len())
        .filter(|&r| at.is_active(r))
        .map(|r| at.row(r))
        .collect();
    let (lambda, mu) = multipliers.split_at(rows.len());
    let mut v = at.velocities().to_vec();
    for (row, &mu) in rows.iter().zip(mu) {
        for &(k, g) in &row.gradient {
            v[k] += g * mu;
        }
    }
    let minus = |rates: &[S], values: Vec<S>| -> Vec<S> {
        rates.iter().zip(values).map(|(&a, b)| a - b).collect()
    };
    let mut out = minus(&ydot[..l.n_q], at.position_rates_at(&v));
    out.extend(at.imbalance(&ydot[l.n_q..l.n_q + l.n_v], lambda));
    out.extend(minus(&ydot[l.n_q + l.n_v..], at.state_rates()));
    out.extend(rows.iter().map(|row| row.value));
    if formulation == Formulation::Stabilized {
        out.extend(rows.iter().map(|row| {
            let along = row.gradient.iter();
            along.fold(row.drift, |s, &(k, g)| s + g * at.velocities()[k])
        }));
    }
    out
}

impl Implicit {
    /// Records the equations of a scene.
    ///
    /// # Errors
    /// Functions that read what is solved for: their loops are solved beside explicit rates only.
    pub fn new(
        scene: &Scene,
        formulation: Formulation,
        outside: &Outside,
    ) -> Result<Self, Vec<Diagnostic>> {
        if !scene.loops.is_empty() {
            let loops = scene.loops.iter().map(|u| u.name.as_str());
            return Err(vec![Diagnostic::error(
                "implicit_loop",
                format!(
                    "{} reads accelerations or forces that depend on it: methods for implicit equations do not solve that",
                    loops.collect::<Vec<_>>().join(", ")
                ),
            )
            .help("leave the method to the program, or ask for RADAU5")]);
        }
        let n = scene.layout.y().len();
        let m = (0..scene.rows.len())
            .filter(|&r| scene.active.get(r).copied().unwrap_or(true))
            .count();
        let levels = match formulation {
            Formulation::Index3 => 1,
            Formulation::Stabilized => 2,
        };
        let size = n + levels * m;
        let (program, complaints) = record_more(scene, n + levels * m, |at, more| {
            residual(scene, at, more, formulation)
        });
        if !complaints.is_empty() {
            return Err(super::system::complaints(complaints));
        }
        let multipliers = record(scene, |at| {
            let solved = at.solved();
            let active = (0..scene.rows.len()).filter(|&r| at.is_active(r));
            active.map(|r| solved.lambda[r]).collect()
        })
        .map_err(super::system::complaints)?;
        Ok(Self {
            formulation,
            n,
            m,
            jacobian: Jacobian::new(scene, &program, n, size, outside),
            residual: program,
            multipliers,
            work: Work::default(),
            numbers: vec![0.0; scene.layout.len() + n + levels * m],
        })
    }

    /// How many unknowns there are.
    pub fn size(&self) -> usize {
        match self.formulation {
            Formulation::Index3 => self.n + self.m,
            Formulation::Stabilized => self.n + 2 * self.m,
        }
    }

    fn set(&mut self, numbers: &[f64], y: &[f64], ydot: &[f64]) {
        let (n, first) = (self.n, numbers.len());
        self.numbers[..first].copy_from_slice(numbers);
        self.numbers[first..first + n].copy_from_slice(&ydot[..n]);
        self.numbers[first + n..].copy_from_slice(&y[n..]);
    }
}

/// Where the residual reads unknown `j`: numbers 1 … n, and of the multipliers those after ẏ, which begins at `first`.
fn place(j: usize, n: usize, first: usize) -> usize {
    if j < n { 1 + j } else { first + j }
}

impl Jacobian {
    fn new(scene: &Scene, residual: &Program, n: usize, size: usize, outside: &Outside) -> Self {
        let first = scene.layout.len();
        let by_duals = || {
            let mut along = vec![Vec::new(); first + size];
            for j in 0..size {
                along[place(j, n, first)].push(j as u32);
                if j < n {
                    along[first + j].push(j as u32);
                }
            }
            outside.depend(&mut along);
            let mut rows = residual.dependence(&along);
            (rows.iter_mut().enumerate()).for_each(|(i, row)| row.push(i as u32));
            Jacobian::Duals {
                pattern: Pattern::of_rows(size, &rows),
                work: Work::default(),
                numbers: Vec::new(),
                out: Vec::new(),
            }
        };
        // what closures and queries yield is differentiated by differences, beside the programs
        if size * residual.n_operations() > LONGEST || !scene.hooks.is_empty() {
            return by_duals();
        }
        let mut builder = Builder::new(Folding::Structural);
        let rows = residual.record(&mut builder);
        let slot = |k: usize| Input::Slot(k as u32);
        // y, then ẏ
        let places = (0..size)
            .map(|j| slot(place(j, n, first)))
            .chain((0..n).map(|j| slot(first + j)));
        let places: Vec<_> = places.map(|input| builder.input(input)).collect();
        let mut wanted = Vec::new();
        let mut entries = Vec::new();
        for (i, &row) in rows.iter().enumerate() {
            let gradient = builder.gradient(row, &places);
            let mut output = |k: usize| {
                let value = gradient[k];
                if builder.constant_of(value) == Some(0.0) {
                    return None;
                }
                wanted.push(value);
                Some(wanted.len() - 1)
            };
            for j in 0..size {
                let by_y = output(j);
                let by_ydot = if j < n { output(size + j) } else { None };
                if by_y.is_some() || by_ydot.is_some() || i == j {
                    entries.push((i, j, by_y, by_ydot));
                }
            }
        }
        let program = builder.finish_with_inputs(&wanted, residual.inputs());
        if program.n_operations() > LONGEST {
            return by_duals();
        }
        Jacobian::Recorded {
            out: vec![0.0; wanted.len()],
            program,
            work: Work::default(),
            entries,
        }
    }
}

impl System {
    /// From now on the system is also an implicit one.
    ///
    /// # Errors
    /// Functions that read what is solved for.
    pub fn make_implicit(&mut self, formulation: Formulation) -> Result<(), Vec<Diagnostic>> {
        if self
            .implicit
            .as_ref()
            .is_none_or(|i| i.formulation != formulation)
        {
            self.implicit = Some(Box::new(Implicit::new(
                &self.scene,
                formulation,
                &self.outside,
            )?));
        }
        Ok(())
    }

    /// Writes the implicit equations of another scene, if there were any.
    ///
    /// # Errors
    /// Functions that read what is solved for.
    pub(super) fn renew_implicit(&mut self, scene: &Scene) -> Result<(), Vec<Diagnostic>> {
        if let Some(implicit) = &self.implicit {
            let formulation = implicit.formulation;
            self.implicit = Some(Box::new(Implicit::new(scene, formulation, &self.outside)?));
        }
        Ok(())
    }

    /// A state of the explicit system with multipliers; the size of the implicit one.
    pub fn implicit_size(&self) -> usize {
        self.implicit.as_ref().map_or(0, |i| i.size())
    }

    fn implicit(&self) -> &Implicit {
        match &self.implicit {
            Some(implicit) => implicit,
            None => unreachable!("make_implicit comes before a method for implicit equations"),
        }
    }
}

impl Dae for System {
    fn size(&self) -> usize {
        self.implicit().size()
    }

    fn residual(&mut self, t: f64, y: &[f64], ydot: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        let n = self.implicit().n;
        self.set(t, &y[..n]);
        if let Some(i) = &mut self.implicit {
            i.set(&self.numbers, y, ydot);
            i.residual.run(&i.numbers, &mut i.work, r);
        }
        match r.iter().position(|x| !x.is_finite()) {
            Some(what) => Err(Failure {
                what,
                recoverable: true,
            }),
            None => Ok(()),
        }
    }

    fn pattern(&self) -> Vec<(usize, usize)> {
        match &self.implicit().jacobian {
            Jacobian::Recorded { entries, .. } => entries.iter().map(|e| (e.0, e.1)).collect(),
            Jacobian::Duals { pattern, .. } => pattern.entries().collect(),
        }
    }

    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        ydot: &[f64],
        cj: f64,
        values: &mut [f64],
    ) -> Result<(), Failure> {
        let (n, size) = (self.implicit().n, Dae::size(self));
        self.set(t, &y[..n]);
        let first = self.numbers.len();
        if let Some(i) = &mut self.implicit {
            i.set(&self.numbers, y, ydot);
            match &mut i.jacobian {
                Jacobian::Recorded {
                    program,
                    work,
                    entries,
                    out,
                } => {
                    program.run(&i.numbers, work, out);
                    for (value, (_, _, by_y, by_ydot)) in values.iter_mut().zip(entries) {
                        *value =
                            by_y.map_or(0.0, |k| out[k]) + by_ydot.map_or(0.0, |k| cj * out[k]);
                    }
                }
                Jacobian::Duals {
                    pattern,
                    work,
                    numbers,
                    out,
                } => {
                    numbers.clear();
                    numbers.extend(i.numbers.iter().map(|&x| Dual::<WIDTH>::constant(x)));
                    out.resize(size, Dual::constant(0.0));
                    for (chunk, groups) in pattern.groups().chunks(WIDTH).enumerate() {
                        let mark = |numbers: &mut [Dual<WIDTH>], by_y: f64, by_ydot: f64| {
                            for (k, group) in groups.iter().enumerate() {
                                for &j in group {
                                    numbers[place(j, n, first)].eps[k] = by_y;
                                    if j < n {
                                        numbers[first + j].eps[k] = by_ydot;
                                    }
                                }
                            }
                        };
                        mark(numbers, 1.0, cj);
                        self.outside.follow(numbers, chunk == 0);
                        i.residual.eval(numbers, work, out);
                        mark(numbers, 0.0, 0.0);
                        self.outside.forget(numbers);
                        for (k, group) in groups.iter().enumerate() {
                            for &j in group {
                                for (e, row) in pattern.column(j) {
                                    values[e] = out[row].eps[k];
                                }
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    }

    fn consistent(&mut self, t: f64, y: &mut [f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let n = self.implicit().n;
        y[n..].fill(0.0);
        ydot.fill(0.0);
        Ode::rate(self, t, &y[..n], &mut ydot[..n])?;
        if let Some(i) = &mut self.implicit {
            let m = i.m;
            i.multipliers
                .run(&self.numbers, &mut i.work, &mut y[n..n + m]);
        }
        Ok(())
    }

    fn kinds(&self) -> Vec<Kind> {
        let l = self.scene.layout;
        let mut kinds = vec![Kind::Differential; l.y().len()];
        if self.implicit().formulation == Formulation::Index3 && self.implicit().m > 0 {
            kinds[l.n_q..l.n_q + l.n_v].fill(Kind::DifferentialUncontrolled);
        }
        kinds.resize(Dae::size(self), Kind::Algebraic);
        kinds
    }

    fn levels(&self) -> Levels {
        let l = self.scene.layout;
        let m = self.implicit().m;
        let mut rows = vec![1; l.n_q];
        rows.resize(l.n_q + l.n_v, 2);
        rows.resize(l.y().len(), 1);
        let mut unknowns = vec![0; l.n_q];
        unknowns.resize(l.n_q + l.n_v, 1);
        unknowns.resize(l.y().len(), 0);
        rows.resize(rows.len() + m, 0);
        unknowns.resize(unknowns.len() + m, 2);
        if self.implicit().formulation == Formulation::Stabilized {
            rows.resize(rows.len() + m, 1);
            unknowns.resize(unknowns.len() + m, 1);
        }
        Levels { rows, unknowns }
    }

    fn typical(&self, typical: &mut [f64]) {
        let n = self.implicit().n;
        typical.fill(1.0);
        Ode::typical(self, &mut typical[..n]);
    }

    fn relations(&self, relations: &mut [Relation]) {
        let n = self.implicit().n;
        Ode::relations(self, &mut relations[..n]);
    }
}
