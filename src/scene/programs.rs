//! The equations of a scene as straight-line programs: run once over recording numbers, then as often as needed.

use super::Scene;
use super::equations::{Equations, STATIC};
use super::solve::{gram, solve_symmetric};
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
/// Δq = −A Gᵀ (G A Gᵀ)⁻¹ g        Δv = −A Gᵀ (G A Gᵀ)⁻¹ (G v + ġ₀)
/// ```
///
/// with `A = M⁻¹`: what is taken away is orthogonal in kinetic energy to all motions that the rows allow, so that noise normal
/// to the rows, however large where they are nearly dependent, leaves those motions alone. In kinematics, where masses
/// may be zero, A is a diagonal matrix of [`weights`].
pub fn projection<S: Scalar>(scene: &Scene, at: &Equations<'_, S>, velocities: &[S]) -> Vec<S> {
    let rows: Vec<_> = (0..scene.rows.len())
        .filter(|&r| at.is_active(r))
        .map(|r| at.row(r))
        .collect();
    let n = scene.layout.n_v;
    let factor = at.mass_factor();
    let w = weights(scene);
    // u with uᵀ D⁻¹ u = G A Gᵀ, and D⁻¹
    let inverse_d = match &factor {
        Some(factor) => factor.inverse_d(),
        None => w.iter().map(|&w| S::constant(w)).collect(),
    };
    let u: Vec<Vec<(usize, S)>> = rows
        .iter()
        .map(|row| match &factor {
            Some(factor) => factor.half_row(&row.gradient, n),
            None => row.gradient.clone(),
        })
        .collect();
    let gram = gram(&u, &inverse_d);
    let position: Vec<S> = rows.iter().map(|r| -r.value).collect();
    let velocity: Vec<S> = rows
        .iter()
        .map(|r| {
            r.gradient
                .iter()
                .fold(-r.drift, |s, &(v, g)| s - g * velocities[v])
        })
        .collect();
    let mut out = Vec::with_capacity(2 * n);
    for rhs in [position, velocity] {
        let lambda = solve_symmetric(gram.clone(), rhs, &[]).x;
        let mut change = vec![S::zero(); n];
        for (row, &l) in u.iter().zip(&lambda) {
            for &(v, x) in row {
                change[v] += x * l;
            }
        }
        match &factor {
            Some(factor) => factor.finish(&mut change),
            None => {
                for (x, &a) in change.iter_mut().zip(&inverse_d) {
                    *x = *x * a;
                }
            }
        }
        out.extend(change);
    }
    out
}
