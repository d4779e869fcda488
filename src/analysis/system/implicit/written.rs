//! A residual as it is written down once: its program, its derivatives, and the multipliers to
//! begin with.

use crate::analysis::system::closures::Closures;
use crate::expr::program::{Builder, Folding, Input, Program, Work};
use crate::numeric::pattern::Pattern;
use crate::scalar::{Dual, Scalar};
use crate::scene::Scene;
use crate::scene::layout::ImplicitLayout;
use crate::scene::slopes::WIDTH;

/// Programs of one form of the implicit equations. All read the numbers, then ẏ, λ, μ, and what may
/// come after.
#[derive(Clone, Debug)]
pub(super) struct Written {
    residual: Program,
    /// multipliers at a state
    multipliers: Program,
    jacobian: Jacobian,
    layout: ImplicitLayout,
    work: Work,
    /// places of the entries among those of a larger pattern   (entries)
    places: Vec<usize>,
}

/// Derivatives of the residual.
#[derive(Clone, Debug)]
enum Jacobian {
    /// recorded: entries (row, column), the output that is ∂F/∂y, the one that is ∂F/∂ẏ
    Recorded {
        program: Program,
        work: Work,
        entries: Vec<(usize, usize, Option<usize>, Option<usize>)>,
        out: Vec<f64>,
    },
    /// by duals, columns that share no row together: where the program would be too long, and where
    /// numbers come from outside
    Duals {
        pattern: Pattern,
        work: Work<Dual<WIDTH>>,
        numbers: Vec<Dual<WIDTH>>,
        out: Vec<Dual<WIDTH>>,
    },
}

/// Operations whose derivatives are recorded, times the unknowns, at most.
const MAX_OPERATIONS: usize = 400_000;

impl Jacobian {
    fn new(scene: &Scene, residual: &Program, layout: ImplicitLayout, outside: &Closures) -> Self {
        let size = layout.size();
        let by_duals = || {
            let mut along = vec![Vec::new(); residual.inputs().len()];
            for j in 0..size {
                along[layout.unknown_at(j)].push(j as u32);
                if let Some(rate) = layout.rate_at(j) {
                    along[rate].push(j as u32);
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
        // results of closures and queries are differentiated by differences, beside the programs
        if size * residual.n_operations() > MAX_OPERATIONS || !scene.hooks.is_empty() {
            return by_duals();
        }
        let mut builder = Builder::new(Folding::Structural);
        let rows = residual.record(&mut builder);
        let slot = |k: usize| Input::Slot(k as u32);
        // y, then ẏ
        let places = (0..size)
            .map(|j| slot(layout.unknown_at(j)))
            .chain((0..size).filter_map(|j| layout.rate_at(j)).map(slot));
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
                let by_ydot = layout.rate_at(j).and_then(|_| output(size + j));
                if by_y.is_some() || by_ydot.is_some() || i == j {
                    entries.push((i, j, by_y, by_ydot));
                }
            }
        }
        let program = builder.finish_with_inputs(&wanted, residual.inputs());
        if program.n_operations() > MAX_OPERATIONS {
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

impl Written {
    /// Records the derivatives of a residual.
    pub(super) fn new(
        scene: &Scene,
        residual: Program,
        multipliers: Program,
        layout: ImplicitLayout,
        outside: &Closures,
    ) -> Self {
        Self {
            jacobian: Jacobian::new(scene, &residual, layout, outside),
            residual,
            multipliers,
            layout,
            work: Work::default(),
            places: Vec::new(),
        }
    }

    /// Returns row and column of every entry of the Jacobian.
    pub(super) fn pattern(&self) -> Box<dyn Iterator<Item = (usize, usize)> + '_> {
        match &self.jacobian {
            Jacobian::Recorded { entries, .. } => Box::new(entries.iter().map(|e| (e.0, e.1))),
            Jacobian::Duals { pattern, .. } => Box::new(pattern.entries()),
        }
    }

    /// Finds the entries in a pattern that has all of them, sorted by columns.
    pub(super) fn place_in(&mut self, all: &[(usize, usize)]) {
        let place = |(i, j): (usize, usize)| all.partition_point(|&(k, l)| (l, k) < (j, i));
        self.places = self.pattern().map(place).collect();
    }

    /// Evaluates `r = F` of the numbers.
    pub(super) fn residual(&mut self, numbers: &[f64], r: &mut [f64]) {
        let read = self.residual.inputs().len();
        self.residual.run(&numbers[..read], &mut self.work, r);
    }

    /// Evaluates the multipliers of the numbers.
    pub(super) fn multipliers(&mut self, numbers: &[f64], lambda: &mut [f64]) {
        let read = self.multipliers.inputs().len();
        self.multipliers
            .run(&numbers[..read], &mut self.work, lambda);
    }

    /// Evaluates `∂F/∂y + cj ∂F/∂ẏ` at the entries of the pattern given to [`Written::place_in`].
    pub(super) fn derivatives(
        &mut self,
        read: &[f64],
        cj: f64,
        outside: &mut Closures,
        values: &mut [f64],
    ) {
        let layout = self.layout;
        let read = &read[..self.residual.inputs().len()];
        values.fill(0.0);
        match &mut self.jacobian {
            Jacobian::Recorded {
                program,
                work,
                entries,
                out,
            } => {
                program.run(read, work, out);
                for (&place, (_, _, by_y, by_ydot)) in self.places.iter().zip(entries) {
                    values[place] =
                        by_y.map_or(0.0, |k| out[k]) + by_ydot.map_or(0.0, |k| cj * out[k]);
                }
            }
            Jacobian::Duals {
                pattern,
                work,
                numbers,
                out,
            } => {
                let size = pattern.n_columns();
                numbers.clear();
                numbers.extend(read.iter().map(|&x| Dual::<WIDTH>::constant(x)));
                out.resize(size, Dual::constant(0.0));
                for (chunk, groups) in pattern.groups().chunks(WIDTH).enumerate() {
                    let mark = |numbers: &mut [Dual<WIDTH>], by_y: f64, by_ydot: f64| {
                        for (k, group) in groups.iter().enumerate() {
                            for &j in group {
                                numbers[layout.unknown_at(j)].eps[k] = by_y;
                                if let Some(rate) = layout.rate_at(j) {
                                    numbers[rate].eps[k] = by_ydot;
                                }
                            }
                        }
                    };
                    mark(numbers, 1.0, cj);
                    outside.follow(numbers, chunk == 0);
                    self.residual.eval(numbers, work, out);
                    mark(numbers, 0.0, 0.0);
                    outside.forget(numbers);
                    for (k, group) in groups.iter().enumerate() {
                        for &j in group {
                            for (e, row) in pattern.column(j) {
                                values[self.places[e]] = out[row].eps[k];
                            }
                        }
                    }
                }
            }
        }
    }
}
