//! The equations of a scene as straight-line programs: run once over recording numbers, then as often as needed.

use super::Scene;
use super::equations::{Equations, STATIC};
use super::solve::solve_symmetric;
use crate::expr::program::{Builder, Folding, Input, Program, Sym};
use crate::scalar::Scalar;
use std::cell::RefCell;

/// Records what `f` computes from the instant it is given. The program reads the row of numbers that
/// [`Layout`](super::layout::Layout) describes.
///
/// # Errors
/// What the equations complained about.
pub fn record<F>(scene: &Scene, f: F) -> Result<Program, Vec<String>>
where
    F: for<'b> FnOnce(&Equations<'_, Sym<'b>>) -> Vec<Sym<'b>>,
{
    let (program, complaints) = record_with_complaints(scene, f);
    if complaints.is_empty() {
        Ok(program)
    } else {
        Err(complaints)
    }
}

/// As [`record`]; what could not be computed is NaN in the program, and told.
pub fn record_with_complaints<F>(scene: &Scene, f: F) -> (Program, Vec<String>)
where
    F: for<'b> FnOnce(&Equations<'_, Sym<'b>>) -> Vec<Sym<'b>>,
{
    record_more(scene, 0, |at, _| f(at))
}

/// As [`record_with_complaints`], for programs that read `n_more` further numbers after those of the layout.
pub fn record_more<F>(scene: &Scene, n_more: usize, f: F) -> (Program, Vec<String>)
where
    F: for<'b> FnOnce(&Equations<'_, Sym<'b>>, &[Sym<'b>]) -> Vec<Sym<'b>>,
{
    let builder = RefCell::new(Builder::new(Folding::Structural));
    let n = scene.layout.len();
    let layout: Vec<Input> = (0..n + n_more).map(|k| Input::Slot(k as u32)).collect();
    let mut numbers: Vec<Sym<'_>> = layout
        .iter()
        .map(|&input| Sym::input(input, &builder))
        .collect();
    if scene.mode == STATIC {
        numbers[scene.layout.v()].fill(Sym::Constant(0.0));
    }
    let equations = Equations::new(scene, &numbers[..n]);
    let out = f(&equations, &numbers[n..]);
    let values: Vec<_> = out
        .iter()
        .map(|s| s.value(&mut builder.borrow_mut()))
        .collect();
    let program = builder.borrow().finish_with_inputs(&values, &layout);
    (program, equations.complaints())
}

/// Where loads and differential equations change branch: one value per switch, changing sign there. `None`: nowhere.
///
/// # Errors
/// What the equations complained about.
pub fn switching(scene: &Scene) -> Result<Option<Program>, Vec<String>> {
    let builder = RefCell::new(Builder::new(Folding::Structural));
    let layout = scene.layout.inputs();
    let numbers: Vec<Sym<'_>> = layout
        .iter()
        .map(|&input| Sym::input(input, &builder))
        .collect();
    let equations = Equations::new(scene, &numbers);
    let mut sources = equations.state_rates();
    for force in &scene.forces {
        let action = force.action(&equations);
        sources.extend(action.force.0.into_iter().chain(action.torque.0));
    }
    let complaints = equations.complaints();
    if !complaints.is_empty() {
        return Err(complaints);
    }
    let values: Vec<_> = sources
        .iter()
        .map(|s| s.value(&mut builder.borrow_mut()))
        .collect();
    let switches = builder.borrow_mut().switching(&values);
    if switches.is_empty() {
        return Ok(None);
    }
    let program = builder.borrow().finish_with_inputs(&switches, &layout);
    Ok(Some(program))
}

/// Weight of a coordinate's change in a projection: angles count as such, lengths against the size of the mechanism.
pub fn weights(scene: &Scene) -> Vec<f64> {
    let mut w = vec![1.0; scene.layout.n_v];
    for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
        if let (Some(v), false) = (f.v, c.angular) {
            w[v] = scene.length * scene.length;
        }
    }
    w
}

/// Least changes that satisfy the active rows to first order: of the positions (as a tangent, n_v), then of the velocities.
///
/// ```text
/// Δq = −W Gᵀ (G W Gᵀ)⁻¹ g        Δv = −W Gᵀ (G W Gᵀ)⁻¹ (G v + ġ₀)
/// ```
pub fn projection<S: Scalar>(scene: &Scene, at: &Equations<'_, S>, velocities: &[S]) -> Vec<S> {
    let w = weights(scene);
    let rows: Vec<_> = (0..scene.rows.len())
        .filter(|&r| at.is_active(r))
        .map(|r| at.row(r))
        .collect();
    let gram: Vec<Vec<S>> = rows
        .iter()
        .enumerate()
        .map(|(r, row)| {
            (0..=r)
                .map(|c| {
                    let mut sum = S::zero();
                    for &(v, x) in &row.gradient {
                        for &(u, y) in &rows[c].gradient {
                            if u == v {
                                sum += (x * y).scale(w[v]);
                            }
                        }
                    }
                    sum
                })
                .collect()
        })
        .collect();
    let position: Vec<S> = rows.iter().map(|r| -r.value).collect();
    let velocity: Vec<S> = rows
        .iter()
        .map(|r| {
            r.gradient
                .iter()
                .fold(-r.drift, |s, &(v, g)| s - g * velocities[v])
        })
        .collect();
    let mut out = Vec::with_capacity(2 * scene.layout.n_v);
    for rhs in [position, velocity] {
        let lambda = solve_symmetric(gram.clone(), rhs).x;
        let mut change = vec![S::zero(); scene.layout.n_v];
        for (row, &l) in rows.iter().zip(&lambda) {
            for &(v, g) in &row.gradient {
                change[v] += (g * l).scale(w[v]);
            }
        }
        out.extend(change);
    }
    out
}
