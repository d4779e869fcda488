//! Functions that read what depends on them: VARIABLEs that read themselves, forces that read
//! accelerations or reactions, rates of implicit differential equations. What is read too early
//! becomes an unknown of its own, with one equation.
//!
//! ```text
//! ρ(z) = φ(z) − z = 0        z: what is read,  φ: what it turns out to be;   implicit DIFF: ρ = e, z = ẏ (or y where no ẏ occurs)
//! ```
//!
//! Which these are is found by evaluating once and noting what is asked for while it is being
//! computed. Where ρ is linear in z the unknowns are eliminated inside each recorded program,
//! `(−∂ρ/∂z) z = ρ(0)`, and are gone; else they have places in the row of numbers, and whoever
//! fills that row solves ρ = 0 by Newton's iteration.

use super::Scene;
use super::configuration::{Configuration, Configured, Way};
use super::equations::{Equations, Lack, Unsupported};
use crate::expr::measures::Measure;
use crate::expr::program::{Builder, Folding, Input, Program, Sym, Value, Work};
use crate::numeric::connected::{SparseRow, connected};
use crate::random::Random;
use crate::scalar::{Dual, Scalar};
use crate::scene::asker::Asker;
use std::cell::RefCell;

/// The quantity that an unknown of the loops stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Key {
    /// value of a formula that reads itself: index in the formulas
    Formula(usize),
    /// a measure that loads read although it depends on all loads
    Measure(Measure, [u32; 4]),
    /// DIF1 of an implicit differential equation: its index
    Rate(usize),
    /// DIF of an implicit differential equation without DIF1: its index
    Value(usize),
}

/// An unknown of the loops.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// what it is
    pub key: Key,
    /// who asks for it before it is known, for messages
    pub asker: Asker,
    /// where Newton's iteration begins
    pub guess: f64,
}

/// Places of the first unknowns, beyond all that a host could lay out.
const PLACEHOLDER: u32 = u32::MAX / 2;

/// Finds the unknowns, and whether they can be eliminated.
///
/// # Errors
/// Loops without a solution, by name.
pub(super) fn find(
    scene: &mut Scene,
    guesses: &dyn Fn(&Key) -> f64,
) -> Result<(), Vec<Unsupported>> {
    let mut keys: Vec<Key> = scene
        .differentials
        .iter()
        .enumerate()
        .filter(|(_, d)| d.implicit)
        .map(|(k, d)| match d.state {
            Some(_) => Key::Rate(k),
            None => Key::Value(k),
        })
        .collect();
    // the rate of an implicit equation is zero in statics, and its value is sought there
    if scene.mode == super::equations::STATIC {
        keys.retain(|k| matches!(k, Key::Value(_)));
    }
    scene.loops = keys.iter().map(|k| unknown(scene, *k, guesses)).collect();
    scene.loop_of = keys.into_iter().zip(0..).collect();
    let mut numbers = vec![0.0; scene.layout.len()];
    numbers[scene.layout.q()].copy_from_slice(&scene.initial_q);
    let undecided = Configuration::new(scene);
    loop {
        let found = discover(scene.within(&undecided), &numbers);
        if found.is_empty() {
            break;
        }
        for key in found {
            let unknown = unknown(scene, key, guesses);
            scene.loop_of.insert(key, scene.loops.len());
            scene.loops.push(unknown);
        }
    }
    if scene.loops.is_empty() {
        return Ok(());
    }
    scene.loops_linear = linear(scene.within(&undecided))? && {
        // assembly may leave rows out: what they exert then reads loads that it does not read here
        let mut left_out = undecided;
        left_out.active.fill(false);
        scene.rows.is_empty() || linear(scene.within(&left_out))?
    };
    scene.layout.n_loops = if scene.loops_linear {
        0
    } else {
        scene.loops.len()
    };
    Ok(())
}

fn unknown(scene: &Scene, key: Key, guesses: &dyn Fn(&Key) -> f64) -> Unknown {
    let asker = match key {
        Key::Formula(f) => scene.formulas[f].owner.clone(),
        Key::Measure(m, ids) => Asker::Input(Input::Measure(m, ids)),
        Key::Rate(d) | Key::Value(d) => Asker::Equation(scene.differentials[d].id),
    };
    Unknown {
        key,
        asker,
        guess: guesses(&key),
    }
}

/// Finds what is asked for too early when everything is asked for once.
fn discover(scene: Configured<'_>, numbers: &[f64]) -> Vec<Key> {
    let unknowns = vec![0.0; scene.loops.len()];
    let at = Equations::with_unknowns(scene, numbers, unknowns, true);
    at.discover();
    at.discovered()
}

/// Returns the numbers of the layout, as they are recorded.
pub(super) fn inputs<'b>(scene: &Scene, builder: &'b RefCell<Builder>) -> Vec<Sym<'b>> {
    let layout = scene.layout.inputs();
    let mut numbers: Vec<Sym<'_>> = layout.iter().map(|&i| Sym::input(i, builder)).collect();
    if scene.mode == super::equations::STATIC {
        numbers[scene.layout.v()].fill(Sym::Constant(0.0));
    }
    numbers
}

/// Returns the first `n` unknowns, as they are recorded.
fn placeholders(n: usize, builder: &RefCell<Builder>) -> Vec<Sym<'_>> {
    (0..n)
        .map(|k| Sym::input(Input::Slot(PLACEHOLDER + k as u32), builder))
        .collect()
}

/// ρ with unknowns as inputs, and ∂ρ/∂z by rows where it is not zero.
fn residuals<'b>(
    scene: Configured<'_>,
    numbers: &[Sym<'b>],
    builder: &'b RefCell<Builder>,
) -> (Vec<Sym<'b>>, Vec<Vec<(usize, Value)>>) {
    let n = scene.loops.len();
    let z = placeholders(n, builder);
    let at = Equations::with_unknowns(scene, numbers, z.clone(), false);
    let rho = at.loop_residuals();
    let recorder = &mut *builder.borrow_mut();
    let variables: Vec<Value> = z.iter().map(|z| z.value(recorder)).collect();
    let values: Vec<Value> = rho.iter().map(|r| r.value(recorder)).collect();
    let jacobian = recorder.jacobian(&values, &variables);
    (rho, jacobian)
}

/// Returns true if every unknown has an equation and ρ is surely not linear in them: its second
/// derivatives are not all zero at some place.
///
/// ```text
/// g = ∂(w·ρ)/∂z        ρ(z + εd) = ρ + ε J d        g(z + εd) = g + ε ∂g/∂z d
/// ```
///
/// with random weights w and a random direction d. What is not zero there is no zero anywhere in a
/// formula, which takes one sweep; all entries of J, of reactions that each depend on all others,
/// take one for each of them.
fn is_surely_nonlinear(scene: Configured<'_>) -> bool {
    let builder = RefCell::new(Builder::new(Folding::Structural));
    let numbers = inputs(&scene, &builder);
    let z = placeholders(scene.loops.len(), &builder);
    // whatever way is chosen later: this one grows with the depth of a forest, not with its cube
    let mut configuration = scene.configuration.clone();
    configuration.elimination.way = Way::ArticulatedBodies;
    let scene = scene.scene.within(&configuration);
    let at = Equations::with_unknowns(scene, &numbers, z.clone(), false);
    let rho = at.loop_residuals();
    let mut random = Random(0);
    let weights = rho.iter().map(|_| Sym::Constant(1.0 + random.unit()));
    let sum = rho.iter().zip(weights).map(|(&r, w)| r * w);
    let sum = sum.fold(Sym::Constant(0.0), |sum, x| sum + x);
    let recorder = &mut *builder.borrow_mut();
    let variables: Vec<Value> = z.iter().map(|z| z.value(recorder)).collect();
    let mut outputs: Vec<Value> = rho.iter().map(|r| r.value(recorder)).collect();
    let sum = sum.value(recorder);
    outputs.extend(recorder.gradient(sum, &variables));
    let program = recorder.finish(&outputs);
    let mut place = |input: &Input| match *input {
        Input::Slot(k) if k >= PLACEHOLDER => {
            let guess = scene.loops[(k - PLACEHOLDER) as usize].guess;
            Dual {
                re: guess + random.unit(),
                eps: [1.0 + random.unit()],
            }
        }
        Input::Slot(k) if scene.layout.q().contains(&(k as usize)) => {
            Dual::constant(scene.initial_q[k as usize - scene.layout.q().start])
        }
        _ => Dual::constant(random.unit()),
    };
    let there: Vec<Dual<1>> = program.inputs().iter().map(&mut place).collect();
    let mut values = vec![Dual::constant(0.0); outputs.len()];
    program.eval(&there, &mut Work::default(), &mut values);
    let (rho, gradient) = values.split_at(rho.len());
    let is_there = |x: f64| x != 0.0 && x.is_finite();
    rho.iter().all(|r| is_there(r.eps[0]))
        && gradient.iter().all(|g| is_there(g.re))
        && gradient.iter().any(|g| is_there(g.eps[0]))
}

/// Returns true if ρ is linear in its unknowns.
fn linear(scene: Configured<'_>) -> Result<bool, Vec<Unsupported>> {
    if is_surely_nonlinear(scene) {
        return Ok(false);
    }
    let builder = RefCell::new(Builder::new(Folding::Structural));
    let numbers = inputs(&scene, &builder);
    let (_, jacobian) = residuals(scene, &numbers, &builder);
    let recorder = builder.borrow();
    let mut determined = vec![false; scene.loops.len()];
    for &(place, _) in jacobian.iter().flatten() {
        determined[place] = true;
    }
    let mut lost = Vec::new();
    for (k, u) in scene.loops.iter().enumerate() {
        // an equation that determines nothing, or an unknown that no equation determines
        if jacobian[k].is_empty() || !determined[k] {
            lost.push(Unsupported::new(u.asker.clone(), Lack::LoopEquation));
        }
    }
    if !lost.is_empty() {
        return Err(lost);
    }
    let entries: Vec<Value> = jacobian.iter().flatten().map(|e| e.1).collect();
    let program = recorder.finish(&entries);
    Ok(!program
        .inputs()
        .iter()
        .any(|i| matches!(i, Input::Slot(k) if *k >= PLACEHOLDER)))
}

/// Solves linear loops while a program is being recorded: the values of the unknowns.
pub(super) fn eliminated<'b>(
    scene: Configured<'_>,
    numbers: &[Sym<'b>],
    builder: &'b RefCell<Builder>,
) -> Vec<Sym<'b>> {
    let n = scene.loops.len();
    if n == 0 || !scene.loops_linear {
        return Vec::new();
    }
    let (_, rows) = residuals(scene, numbers, builder);
    let symbols = |row: Vec<(usize, Value)>| {
        let row = row.into_iter();
        row.map(|(k, value)| (k, Sym::of(value, builder))).collect()
    };
    let jacobian: Vec<Vec<(usize, Sym<'b>)>> = rows.into_iter().map(symbols).collect();
    let at = Equations::with_unknowns(scene, numbers, vec![Sym::Constant(0.0); n], false);
    let rhs: Vec<Sym<'b>> = at.loop_residuals().into_iter().map(|r| -r).collect();
    solve_parts(&jacobian, &rhs)
}

/// `A x = b` by rows of A, the parts that share no unknown each by itself.
fn solve_parts<S: Scalar>(a: &[Vec<(usize, S)>], b: &[S]) -> Vec<S> {
    // row k and unknown k are in one part, so that each is square
    let places = |(k, row): (usize, &Vec<(usize, S)>)| {
        let others = row.iter().map(|e| (e.0, 1.0));
        std::iter::once((k, 1.0)).chain(others).collect()
    };
    let pattern: Vec<SparseRow> = a.iter().enumerate().map(places).collect();
    let mut x = b.to_vec();
    for part in connected(&pattern, b.len()) {
        let dense = |&r: &usize| {
            let mut dense = vec![S::zero(); part.columns.len()];
            for (place, value) in &a[r] {
                if let Ok(k) = part.columns.binary_search(place) {
                    dense[k] = *value;
                }
            }
            dense
        };
        let own = part.rows.iter().map(dense).collect();
        let right = part.rows.iter().map(|&r| b[r]).collect();
        for (&k, value) in part.columns.iter().zip(solve(own, right)) {
            x[k] = value;
        }
    }
    x
}

/// `A x = b` by elimination with the largest pivot of each column, chosen when it is evaluated.
fn solve<S: Scalar>(mut a: Vec<Vec<S>>, mut b: Vec<S>) -> Vec<S> {
    let n = b.len();
    for k in 0..n {
        for i in k + 1..n {
            if a[i][k].is_known_zero() {
                continue;
            }
            let larger = a[k][k].abs().lt(a[i][k].abs());
            let (upper, lower) = a.split_at_mut(i);
            for (x, y) in upper[k][k..].iter_mut().zip(&mut lower[0][k..]) {
                (*x, *y) = (S::select(larger, *y, *x), S::select(larger, *x, *y));
            }
            (b[k], b[i]) = (S::select(larger, b[i], b[k]), S::select(larger, b[k], b[i]));
        }
        for i in k + 1..n {
            if a[i][k].is_known_zero() {
                continue;
            }
            let factor = a[i][k] / a[k][k];
            let (upper, lower) = a.split_at_mut(i);
            for (x, &pivot) in lower[0][k + 1..].iter_mut().zip(&upper[k][k + 1..]) {
                *x -= factor * pivot;
            }
            let pivot = b[k];
            b[i] -= factor * pivot;
        }
    }
    for k in (0..n).rev() {
        for j in k + 1..n {
            let known = a[k][j] * b[j];
            b[k] -= known;
        }
        b[k] = b[k] / a[k][k];
    }
    b
}

/// ρ of loops that are not linear, as a program of the numbers; `None` when there are none.
///
/// # Errors
/// Functions ask for what the equations cannot supply.
pub fn program(scene: Configured<'_>) -> Result<Option<Program>, Vec<Unsupported>> {
    if scene.layout.n_loops == 0 {
        return Ok(None);
    }
    super::programs::record(scene, |at| at.loop_residuals()).map(Some)
}

#[cfg(test)]
mod tests {
    use super::{solve, solve_parts};

    #[test]
    fn elimination_exchanges_rows_where_it_must() {
        let a = vec![
            vec![0.0, 2.0, 1.0],
            vec![1.0, 0.0, 0.0],
            vec![3.0, 1.0, 0.0],
        ];
        let x = solve(a, vec![7.0, 1.0, 5.0]);
        assert_eq!(x, [1.0, 2.0, 3.0]);
    }

    #[test]
    fn what_shares_no_unknown_is_eliminated_apart_with_the_same_bits() {
        // 0 with 3, 2 with 4 by a row of the other, 1 alone
        let a = vec![
            vec![(3, 0.3)],
            vec![(1, 7.0)],
            vec![(4, 1.1), (2, 0.1)],
            vec![(0, 3.0), (3, 1.7)],
            vec![(2, -5.0), (4, 0.2)],
        ];
        let b = [1.3, 2.9, 0.7, -4.1, 5.3];
        let dense = |row: &Vec<(usize, f64)>| {
            let mut dense = vec![0.0; b.len()];
            row.iter().for_each(|&(k, x)| dense[k] = x);
            dense
        };
        let whole = solve(a.iter().map(dense).collect(), b.to_vec());
        assert_eq!(solve_parts(&a, &b), whole);
        for (row, right) in a.iter().zip(b) {
            let left: f64 = row.iter().map(|&(k, x)| x * whole[k]).sum();
            assert!((left - right).abs() < 1e-14 * right.abs());
        }
    }
}
