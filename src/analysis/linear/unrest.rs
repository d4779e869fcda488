//! The element that is farthest from rest in a state that small motions are taken about.
//!
//! Eigenvalues tell what becomes of a push where nothing else happens. About a state that moves or
//! is no equilibrium they are those of the equations frozen at that instant.
//!
//! ```text
//! |v| > δ ℓ ω               a part moves                                                   (1)
//! |a| > δ Σⱼ |∂a/∂zⱼ| sⱼ     a part accelerates: no change of δ explains it                 (2)
//! |ẋ| > δ Σⱼ |∂ẋ/∂zⱼ| sⱼ     a state changes that something reads                           (3)
//! ```
//!
//! ℓ is the size of the mechanism (1 of angles), ω the slowest eigenvalue that is none of a free
//! motion. sⱼ is the way of ξⱼ where no coordinate moves by more than ℓ or a radian, ω times that
//! for ηⱼ, and the size of a state. So neither units nor stiff parts elsewhere count. Free parts
//! have no slopes: rounding of their loads is left out beside gravity, or beside all slopes where
//! there is none.

use super::modes::center;
use super::{Linearization, Small, along, directions, undetermined};
use crate::analysis::system::{System, complaints};
use crate::analysis::warning::{Rate, Unrest};
use crate::diagnostic::{Diagnostic, Subject};
use crate::expr::program::{Program, Work};
use crate::model::Model;
use crate::scalar::hypot;
use crate::scene::programs::record;
use nalgebra::DMatrix;
use std::sync::Arc;

/// δ: a way beside the size of the mechanism, or an angle, that eigenvalues hardly notice. It is
/// ERROR of EQUILIBRIUM.
const NOTICED: f64 = 1e-4;
/// Eigenvalue beside the largest that counts as one of a free motion.
const FREE: f64 = 1e-6;
/// Acceleration beside gravity, or beside all slopes, that counts as rounding of loads.
const ROUNDING: f64 = 1e-9;
/// Least size of a state.
const STATE_OF_NOTHING: f64 = 1e-6;

/// Finds what is farthest from rest in the state of a system about which small motions were found.
///
/// # Errors
/// Functions that the equations cannot supply.
pub(super) fn unrest(
    system: &mut System,
    model: &Model,
    small: &Small,
    found: &Linearization,
) -> Result<Option<Unrest>, Vec<Diagnostic>> {
    if found.modes.is_empty() {
        return Ok(None);
    }
    let program = rates(system, model)?;
    let mut rates = vec![0.0; program.n_outputs()];
    program.eval(&system.numbers, &mut Work::default(), &mut rates);
    let ways = directions(system, small, &[], false);
    let slopes = along(system, &program, &ways).map_err(|k| undetermined(system, k))?;
    let here = State {
        system,
        small,
        found,
        rates,
        slopes,
    };
    let all = here.parts().into_iter().chain(here.states());
    let worst = all.filter(|(share, _)| *share > 1.0);
    Ok(worst.max_by(|a, b| a.0.total_cmp(&b.0)).map(|w| w.1))
}

/// Records v, ω, a, α of each part, ground axes, at its centre of mass; then ẋ.
fn rates(system: &System, model: &Model) -> Result<Program, Vec<Diagnostic>> {
    let scene = Arc::clone(&system.scene);
    let l = scene.layout;
    let rates = record(system.configured(), |at| {
        let mut out = Vec::with_capacity(PART * scene.parts.len() + l.n_x);
        for k in 0..scene.parts.len() {
            let s = at.part(k, true);
            let (w, arm) = (s.w_GM, center(&scene, model, at, k) - s.p_GM);
            let a = s.a_GM + s.alpha_GM.cross(arm) + w.cross(w.cross(arm));
            for x in [s.v_GM + w.cross(arm), w, a, s.alpha_GM] {
                out.extend(x.0);
            }
        }
        out.extend(l.state(&at.rates()).x);
        out
    });
    rates.map_err(complaints)
}

/// Numbers of a part among the rates.
const PART: usize = 12;

/// A state about which small motions were found.
struct State<'a> {
    system: &'a System,
    small: &'a Small,
    found: &'a Linearization,
    /// of parts, then of states
    rates: Vec<f64>,
    /// of these along z
    slopes: DMatrix<f64>,
}

impl State<'_> {
    /// Returns ω; zero where all motions are free.
    fn frequency(&self) -> f64 {
        let sizes = || self.found.modes.iter().map(|m| hypot(m.re, m.im));
        let largest = sizes().fold(0.0, f64::max);
        let slowest = sizes().filter(|s| *s > FREE * largest);
        slowest.reduce(f64::min).unwrap_or(0.0)
    }

    /// Returns s.
    fn changes(&self, length: f64) -> Vec<f64> {
        let l = self.system.scene.layout;
        let mut all = self.ways(&self.small.z, length);
        let frequency = self.frequency();
        let speeds = self.ways(&self.small.y, length);
        all.extend(speeds.into_iter().map(|way| way * frequency));
        let size = |j: usize| self.system.numbers[l.x_at(j)].abs();
        all.extend((0..l.n_x).map(|j| size(j).max(STATE_OF_NOTHING)));
        all
    }

    /// Returns the way of each ξ, or of each η in one unit of time: of the columns of Z or Y.
    fn ways(&self, space: &DMatrix<f64>, length: f64) -> Vec<f64> {
        let scene = &self.system.scene;
        let mut largest = vec![1.0; scene.layout.n_v];
        for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
            if let Some(v) = f.v.filter(|_| !c.angular) {
                largest[v] = length;
            }
        }
        let way = |z: nalgebra::DVectorView<f64>| {
            let parts = z.iter().zip(&largest).map(|(z, l)| z.abs() / l);
            1.0 / parts.fold(f64::MIN_POSITIVE, f64::max)
        };
        space.column_iter().map(way).collect()
    }

    /// Returns the rates of parts, each over what counts as none.
    fn parts(&self) -> Vec<(f64, Unrest)> {
        let scene = &self.system.scene;
        let (length, frequency) = (scene.size, self.frequency());
        let changes = self.changes(length);
        // the size of a vector, and of its slopes
        let size = |first: usize| {
            let x = &self.rates[first..first + 3];
            let slopes = |j: usize| self.slopes.fixed_view::<3, 1>(first, j).norm();
            let explained = changes.iter().enumerate().map(|(j, s)| slopes(j) * s);
            (hypot(hypot(x[0], x[1]), x[2]), explained.sum::<f64>())
        };
        let (mut moves, mut accelerates) = (Vec::new(), Vec::new());
        for (k, part) in scene.parts.iter().enumerate() {
            for (turn, unit) in [(0, length), (1, 1.0)] {
                let rate = [Rate::Velocity, Rate::AngularVelocity][turn];
                let (value, _) = size(PART * k + 3 * turn);
                moves.push((value, unit, rate, part.id));
                let rate = [Rate::Acceleration, Rate::AngularAcceleration][turn];
                let (value, explained) = size(PART * k + 6 + 3 * turn);
                accelerates.push((value, explained, unit, rate, part.id));
            }
        }
        let all = accelerates.iter();
        let slopes = all.map(|(_, e, unit, ..)| e / unit).fold(0.0, f64::max);
        let gravity = scene.gravity.norm() / length;
        let idle = ROUNDING * if gravity > 0.0 { gravity } else { slopes };
        let slow = NOTICED
            * if frequency > 0.0 {
                frequency
            } else {
                idle.sqrt()
            };
        let unrest = |part, rate, value| Unrest {
            subject: Subject::from(part),
            rate,
            value,
        };
        let moves = moves
            .into_iter()
            .map(|(value, unit, rate, part)| (over(value, slow * unit), unrest(part, rate, value)));
        // what moves is told as that: its acceleration may be all of its motion
        let moves: Vec<_> = moves.filter(|(share, _)| *share > 1.0).collect();
        if !moves.is_empty() {
            return moves;
        }
        let accelerates = accelerates.into_iter();
        let accelerates = accelerates.map(|(value, explained, unit, rate, part)| {
            let none = (NOTICED * explained).max(idle * unit);
            (over(value, none), unrest(part, rate, value))
        });
        accelerates.collect()
    }

    /// Returns the rates of states that something reads, each over what counts as none.
    fn states(&self) -> Vec<(f64, Unrest)> {
        let l = self.system.scene.layout;
        let changes = self.changes(self.system.scene.size);
        let (first, n) = (self.rates.len() - l.n_x, self.slopes.ncols() - l.n_x);
        let is_read = |k: usize| self.found.a.iter().any(|row| row[n + k] != 0.0);
        let of = |k: usize| {
            let all = changes.iter().enumerate();
            let explained = all.map(|(j, s)| self.slopes[(first + k, j)].abs() * s);
            let value = self.rates[first + k];
            let unrest = Unrest {
                subject: Subject::from(self.found.states[n + k].as_str()),
                rate: Rate::StateRate,
                value,
            };
            (over(value.abs(), NOTICED * explained.sum::<f64>()), unrest)
        };
        (0..l.n_x).filter(|k| is_read(*k)).map(of).collect()
    }
}

/// Returns how much more a rate is than what counts as none.
fn over(value: f64, none: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value / none }
}
