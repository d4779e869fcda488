//! Free directions without inertia: motions that nothing holds and nothing resists, in which no
//! acceleration is determined.
//!
//! With the free directions as columns of F, Fᵀ M F is positive definite wherever the parts that
//! move have mass or inertia in them:
//!
//! ```text
//! Tₐᵦ = Σ m vₐ·vᵦ + vₐ·(ωᵦ × s) + vᵦ·(ωₐ × s) + ωₐ·J ωᵦ          over links, about their origins, s = m p_LC        (1)
//! ```
//!
//! A direction whose own Tₐₐ vanishes moves only what has no mass; a combination of directions does
//! where (1), scaled to a unit diagonal, is singular: two arms without mass stretched out towards
//! the same ball.

use super::free::{Directions, Free, Moving};
use crate::analysis::start::assemble;
use crate::diagnostic::{Diagnostic, Subject};
use crate::model::Model;
use crate::scene::Scene;
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::space::Vec3;
use nalgebra::{DMatrix, SymmetricEigen};

/// A diagonal entry of (1) below this part of the model's mass times the square of the motion is
/// nothing: a mass on the axis of a turn moves by rounding, 1e-16 of its distance, and that squared
/// is what is left.
const NOTHING: f64 = 1e-24;

/// Eigenvalues of (1), scaled to a unit diagonal, below this are zero: what is left when rounding
/// is taken away.
const SINGULAR: f64 = 1e-13;

/// Returns true if some part lacks mass or a principal inertia: otherwise every motion is resisted.
pub(crate) fn possible(scene: &Scene, model: &Model) -> bool {
    scene.parts.iter().any(|p| {
        let turns = !p.is_point_mass();
        let body = model.body(p.id);
        body.is_none_or(|m| m.mass <= 0.0 || turns && m.ip[..3].iter().any(|&i| i <= 0.0))
    })
}

/// An error for each free direction at a position that moves no mass.
pub(crate) fn massless(
    scene: Configured<'_>,
    model: &Model,
    t: f64,
    q: &[f64],
    x: &[f64],
) -> Vec<Diagnostic> {
    if !possible(&scene, model) {
        return Vec::new();
    }
    let found = Directions::of(scene, model, t, q, x);
    let n = found.rates.len();
    let still = twists(scene, t, q, &vec![0.0; scene.layout.n_v], x);
    let all: Vec<Vec<[Vec3<f64>; 2]>> = (found.rates.iter())
        .map(|rates| {
            let moving = twists(scene, t, q, rates, x);
            let less = |(a, b): (&[Vec3<f64>; 2], &[Vec3<f64>; 2])| [a[0] - b[0], a[1] - b[1]];
            moving.iter().zip(&still).map(less).collect()
        })
        .collect();
    let form = |a: usize, b: usize| -> f64 {
        let pairs = scene.links.iter().zip(all[a].iter().zip(&all[b]));
        pairs
            .map(|(link, ([wa, va], [wb, vb]))| {
                let s = link.moment;
                link.mass * va.dot(*vb)
                    + va.dot(wb.cross(s))
                    + vb.dot(wa.cross(s))
                    + wa.dot(link.inertia.apply(*wb))
            })
            .sum()
    };
    let mass: f64 = scene.links.iter().map(|l| l.mass).sum();
    let size = |a: usize| -> f64 {
        let square = |[w, v]: &[Vec3<f64>; 2]| v.norm2() + w.norm2() * scene.length * scene.length;
        all[a].iter().map(square).sum()
    };
    let own: Vec<f64> = (0..n).map(|a| form(a, a)).collect();
    let weightless = |a: usize| own[a] <= NOTHING * mass * size(a);
    let mut out: Vec<Diagnostic> = (0..n)
        .filter(|&a| weightless(a))
        .map(|a| said(model, &found.described(a)))
        .collect();
    let rest: Vec<usize> = (0..n).filter(|&a| !weightless(a)).collect();
    if rest.is_empty() {
        return out;
    }
    let scaled = DMatrix::from_fn(rest.len(), rest.len(), |i, j| {
        form(rest[i], rest[j]) / (own[rest[i]] * own[rest[j]]).sqrt()
    });
    let eigen = SymmetricEigen::new(scaled);
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        if *value > SINGULAR {
            continue;
        }
        let largest = vector.amax();
        let names: Vec<String> = (vector.iter().zip(&rest))
            .filter(|(c, _)| c.abs() > 0.1 * largest)
            .map(|(_, &a)| found.unknown(a).to_string())
            .collect();
        let at = rest[vector.iamax()];
        let what = format!(
            "{} can move together so that no mass moves: nothing resists that, and no acceleration is determined",
            names.join(", ")
        );
        out.push(advised(
            Diagnostic::error("no_mass", what).element(element(&found.described(at))),
        ));
    }
    out
}

/// Angular velocity and velocity of every link, in its own axes, about its origin.
fn twists(scene: Configured<'_>, t: f64, q: &[f64], v: &[f64], x: &[f64]) -> Vec<[Vec3<f64>; 2]> {
    let numbers = assemble::numbers(scene, t, q, v, x);
    let at = Equations::new(scene, &numbers);
    at.links().iter().map(|l| [l.w, l.v]).collect()
}

fn element(free: &Free) -> Subject {
    let part = free.parts.first();
    part.map_or_else(|| free.unknown.clone(), |p| p.part.into())
}

fn said(model: &Model, free: &Free) -> Diagnostic {
    let lacks = match free.parts.first() {
        Some(part) => lacking(model, part),
        None => "mass",
    };
    let what = format!(
        "it has no {lacks} in a direction that nothing holds: {}",
        free.words
    );
    advised(Diagnostic::error("no_mass", what).element(element(free)))
}

/// Names the numbers that a part would need to resist its motion.
fn lacking(model: &Model, part: &Moving) -> &'static str {
    let data = model.body(part.part);
    match data {
        Some(data) if data.mass > 0.0 => "inertia (IP)",
        _ if part.angular == [0.0; 3] => "MASS",
        _ => "MASS or inertia (IP)",
    }
}

fn advised(d: Diagnostic) -> Diagnostic {
    d.help(
        "give MASS, CM and IP to what moves there, or hold that direction by a joint or a MOTION",
    )
}
