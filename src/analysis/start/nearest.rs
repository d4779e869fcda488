//! The position nearest to the drawing: it satisfies all rows, meets the values that are given as
//! far as these let it, and moves and turns parts as little as may be.
//!
//! ```text
//! least  ½ Σ |Δp|²/L² + |Δθ|² over parts      subject to  g(q) = 0  and, softly, c(q) = 0     (1)
//! g  rows             compliance 0
//! c  given values     compliance 10⁻¹⁰, as EXACT has in Adams
//! Δ  of a part        compliance 1; 10⁻¹⁰ of a coordinate that EXACT names
//! ```
//!
//! Places are counted by parts, not by coordinates, so that the answer does not depend on what
//! carries what; lengths against the size L of the mechanism. An Euler angle that EXACT names holds
//! the whole orientation: the angles of a part that turns about another axis all change.
//!
//! Gauss–Newton: with τ the twists of links about one point, S the freedoms, and multipliers,
//!
//! ```text
//! Pᵀ W (r + P τ) + μ − Σ μ of what it carries = 0         of each link
//! −Sᵀ μ + Gᵀ λ + Cᵀ κ = 0                                 of each velocity
//! τ − τ of its carrier − S d = 0                          of each link                        (2)
//! G d − ρ (λ − λ₀) = −g,   C d − 10⁻¹⁰ (κ − κ₀) = −c      λ₀, κ₀: those of the iteration before
//! ```
//!
//! a sparse system with entries in proportion to links and rows. ρ lets rows depend on each other;
//! that λ₀ and κ₀ follow makes rows exact all the same, and given values where rows let them be
//! (Rockafellar's method of multipliers).
//!
//! Mechanisms that nothing couples go their ways side by side, each with its own size, steps and
//! end: what else is in a model changes no bit of where it is assembled.
//!
//! Source: Gauss–Newton with equality constraints, Nocedal & Wright, *Numerical Optimization*, 10.3
//! and 17.3.

use crate::analysis::start::assemble;
use crate::analysis::start::initial_conditions::{Equation, Wanted};
use crate::analysis::start::mechanisms::{Mechanism, mechanisms};
use crate::model::Model;
use crate::numeric::connected::SparseRow;
use crate::numeric::sparse::Factors;
use crate::scene::configuration::Configuration;
use crate::scene::equations::Equations;
use crate::scene::mover::Mover;
use crate::scene::{Scene, cams};
use crate::space::{Frame, Vec3, rotation};

/// Compliance of a value that is given, against that of where parts are drawn.
const GIVEN: f64 = 1e-10;
/// The ρ of (2): what a row asks for beyond others is followed at once where its strength σ² is
/// more than this, else step by step. Far above the part of a column that counts as zero, 1e-14.
const DEPENDENT: f64 = 1e-12;
/// Iterations towards rows, at most.
pub(super) const MAX_ITERATIONS: usize = 100;
/// Longest change of a coordinate in one iteration, rad or parts of the mechanism's size.
pub(super) const LONGEST_STEP: f64 = 0.5;
/// Deviation of parts, rows and given values that are in place already.
const IN_PLACE: f64 = 1e-9;
/// Change of a coordinate at which the iteration has converged.
const ARRIVED: f64 = 1e-11;

/// The places from which the places of parts count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// where they are drawn
    Drawn,
    /// where they are in the beginning; where they are drawn for what EXACT names
    Beginning,
    /// where each iteration begins: each step is short
    EachStep,
}

/// The way of a mechanism to its place.
struct Way {
    mechanism: Mechanism,
    /// multipliers of its rows, then of what is given
    multipliers: Vec<f64>,
    /// it is in place, or no step leads anywhere
    is_done: bool,
}

/// Everything that (2) is made of, at one position.
struct Position<'a> {
    scene: &'a Scene,
    at: Equations<'a, f64>,
    /// residuals and gradients of rows   (n_rows)
    g: Vec<f64>,
    gradient: Vec<SparseRow>,
    given: Vec<Equation>,
    /// which coordinates of a part are firm, and from where its place counts, for each part
    firm: &'a [[bool; 6]],
    from: &'a [Frame<f64>],
}

/// Moves `q` to the nearest position; contacts on curves go along, and are where they are asked to
/// begin as far as that can be.
pub(super) fn nearest(
    (scene, configuration): (&Scene, &mut Configuration),
    (model, wanted): (Option<&Model>, &Wanted),
    t: f64,
    q: &mut [f64],
    x: &[f64],
    origin: Origin,
) {
    let n_v = scene.layout.n_v;
    if n_v == 0 {
        return;
    }
    let still = vec![0.0; n_v];
    let firm: Vec<[bool; 6]> = (scene.parts.iter())
        .map(|part| {
            model
                .and_then(|m| m.body(part.id))
                .map_or([false; 6], |data| data.exact)
        })
        .collect();
    let mut from = places(scene, configuration, (t, q, x), (&firm, origin));
    let mover = Mover::new(scene);
    let mut ways: Option<Vec<Way>> = None;
    for k in 0..MAX_ITERATIONS {
        if k > 0 && origin == Origin::EachStep {
            from = places(scene, configuration, (t, q, x), (&firm, origin));
        }
        let numbers = assemble::numbers(scene.within(configuration), t, q, &still, x);
        cams::track(scene, configuration, &numbers);
        cams::place(scene, configuration, &wanted.starts, &numbers);
        let here = scene.within(configuration);
        let (g, mut gradient) = assemble::rows_at_rest(here, t, q, x);
        let mut g: Vec<f64> = g.iter().copied().collect();
        let given = wanted.equations(here, &numbers, &mover);
        let ways = ways.get_or_insert_with(|| {
            let of_given = given.iter().map(|e| &e.gradient);
            let all = mechanisms(scene, gradient.iter().chain(of_given)).into_iter();
            all.map(Way::new).collect()
        });
        for r in (0..g.len()).filter(|&r| here.is_held(r) || wanted.replaces(scene, r)) {
            g[r] = 0.0;
            gradient[r].clear();
        }
        assemble::clear_idle(scene, &g, &mut gradient);
        let position = Position {
            scene,
            at: Equations::new(here, &numbers),
            g,
            gradient,
            given,
            firm: &firm,
            from: &from,
        };
        let mut change = vec![0.0; n_v];
        for way in ways.iter_mut().filter(|way| !way.is_done) {
            if k == 0 && position.is_in_place(&way.mechanism) {
                way.is_done = true;
                continue;
            }
            way.step(&position, &mut change);
        }
        if ways.iter().all(|way| way.is_done) && change.iter().all(|x| *x == 0.0) {
            break;
        }
        let mut moved = q.to_vec();
        mover.displace(&mut moved, &change);
        mover.take_over(q, &moved, &change);
    }
    let numbers = assemble::numbers(scene.within(configuration), t, q, &still, x);
    cams::place(scene, configuration, &wanted.starts, &numbers);
}

/// Returns from where the places of parts count: as drawn, or as they are; what EXACT names counts
/// from where it is drawn.
fn places(
    scene: &Scene,
    configuration: &Configuration,
    (t, q, x): (f64, &[f64], &[f64]),
    (firm, origin): (&[[bool; 6]], Origin),
) -> Vec<Frame<f64>> {
    if origin == Origin::Drawn {
        return scene.parts.iter().map(|part| part.initial).collect();
    }
    let here = scene.within(configuration);
    let numbers = assemble::numbers(here, t, q, &vec![0.0; scene.layout.n_v], x);
    let at = Equations::<f64>::new(here, &numbers);
    let place = |(k, firm): (usize, &[bool; 6])| {
        let (state, initial) = (at.part(k, false), scene.parts[k].initial);
        let mut position = state.p_GM;
        for c in (0..3).filter(|&c| firm[c]) {
            position.0[c] = initial.position.0[c];
        }
        let is_held = firm[3..].contains(&true);
        Frame {
            rotation: if is_held {
                initial.rotation
            } else {
                state.R_GM
            },
            position,
        }
    };
    firm.iter().enumerate().map(place).collect()
}

impl Position<'_> {
    /// Returns how far a part is from where its place counts: length, and rotation vector.
    fn off(&self, part: usize) -> [Vec3<f64>; 2] {
        let (now, from) = (self.at.part(part, false), &self.from[part]);
        let turned = rotation::vector(&(now.R_GM * from.rotation.transpose()));
        [now.p_GM - from.position, turned]
    }

    /// Returns the compliances of a part's place and orientation; infinite where it does not count.
    fn compliances(&self, part: usize) -> [f64; 6] {
        let firm = &self.firm[part];
        let turns = firm[3..].contains(&true);
        [0, 1, 2, 3, 4, 5].map(|c| match c {
            3.. if self.scene.parts[part].is_point_mass() => f64::INFINITY,
            3.. if turns => GIVEN,
            0..3 if firm[c] => GIVEN,
            _ => 1.0,
        })
    }

    /// Returns which of the given values are of a mechanism.
    fn given_to<'s>(&'s self, m: &'s Mechanism) -> impl Iterator<Item = &'s Equation> {
        let is_own = |e: &&Equation| {
            let first = e.gradient.first();
            first.is_some_and(|(v, _)| m.velocities.binary_search(v).is_ok())
        };
        self.given.iter().filter(is_own)
    }

    fn is_in_place(&self, m: &Mechanism) -> bool {
        let one = |r: &usize| self.scene.row_scale_at(*r, m.size);
        let rows = m.rows.iter().map(|r| self.g[*r] / one(r));
        let given = self.given_to(m).map(|e| e.residual / e.one(m.size));
        let parts = m.parts.iter().flat_map(|&part| {
            let ([offset, turn], has) = (self.off(part), self.compliances(part));
            let turn = turn.times(f64::from(u8::from(has[3].is_finite())));
            offset.times(1.0 / m.size).0.into_iter().chain(turn.0)
        });
        let mut all = rows.chain(given).chain(parts);
        all.all(|x| x.abs() < IN_PLACE)
    }
}

/// A square system as it is written down.
#[derive(Default)]
struct Matrix {
    places: Vec<(usize, usize)>,
    values: Vec<f64>,
}

impl Matrix {
    fn add(&mut self, i: usize, j: usize, x: f64) {
        self.places.push((i, j));
        self.values.push(x);
    }

    /// Adds an entry and its mirror image.
    fn add_both(&mut self, i: usize, j: usize, x: f64) {
        self.add(i, j, x);
        self.add(j, i, x);
    }
}

impl Way {
    fn new(mechanism: Mechanism) -> Self {
        Self {
            is_done: mechanism.velocities.is_empty(),
            mechanism,
            multipliers: Vec::new(),
        }
    }

    /// Puts the step of Gauss and Newton (2) into the changes of its velocities; it is done where
    /// that is next to nothing, or no number.
    fn step(&mut self, position: &Position<'_>, change: &mut [f64]) {
        let m = &self.mechanism;
        let given: Vec<&Equation> = position.given_to(m).collect();
        let Some(x) = self.solved(position, &given) else {
            self.is_done = true;
            return;
        };
        let n = m.velocities.len();
        let longest = x[..n].iter().fold(0.0, |m: f64, d| m.max(d.abs()));
        if !longest.is_finite() {
            self.is_done = true;
            return;
        }
        let damping = (LONGEST_STEP / longest).min(1.0);
        for (&v, d) in m.velocities.iter().zip(&x) {
            change[v] = damping * d * m.unit(v);
        }
        let at = n + 12 * m.links.len();
        self.multipliers = x[at..].to_vec();
        self.is_done = longest < ARRIVED;
    }

    /// Solves (2), scaled: velocities, twists of links, what carries them bear, rows, given values.
    fn solved(&self, position: &Position<'_>, given: &[&Equation]) -> Option<Vec<f64>> {
        let m = &self.mechanism;
        let (scene, size) = (position.scene, m.size);
        let links = position.at.links();
        let (n, n_links) = (m.velocities.len(), m.links.len());
        let [twist, load] = [n, n + 6 * n_links];
        let row = n + 12 * n_links;
        let all = row + m.rows.len() + given.len();
        let (mut a, mut b) = (Matrix::default(), vec![0.0; all]);
        let local = |l: usize| m.links.binary_search(&l).ok();
        // about the origin of its first link
        let center = links[m.links[0]].X_GL.position;
        let arm = |p: Vec3<f64>| (p - center).times(1.0 / size);
        for (k, &l) in m.links.iter().enumerate() {
            for c in 0..6 {
                a.add_both(twist + 6 * k + c, load + 6 * k + c, 1.0);
            }
            let Some(parent) = scene.links[l].parent.and_then(local) else {
                continue;
            };
            for c in 0..6 {
                a.add_both(twist + 6 * parent + c, load + 6 * k + c, -1.0);
            }
        }
        for freedom in &scene.freedoms {
            let Some((k, v)) = local(freedom.link).zip(freedom.v) else {
                continue;
            };
            let Ok(v) = m.velocities.binary_search(&v) else {
                continue;
            };
            let X = &links[freedom.link].X_GL;
            let axis = X.rotation.column(freedom.axis).times(freedom.sign);
            let (turn, shift) = match freedom.turn {
                true => (axis, arm(X.position).cross(axis)),
                false => (Vec3::zero(), axis),
            };
            let entries = turn.0.into_iter().chain(shift.0).enumerate();
            for (c, s) in entries.filter(|e| e.1 != 0.0) {
                a.add_both(v, load + 6 * k + c, -s);
            }
        }
        for &part in &m.parts {
            if let Some(k) = scene.parts[part].link.and_then(local) {
                let arm = arm(position.at.part(part, false).p_GM);
                add_part(position, (part, size), arm, twist + 6 * k, (&mut a, &mut b));
            }
        }
        // what is given may have no slopes for a while
        let mut before = self.multipliers.clone();
        before.resize(m.rows.len() + given.len(), 0.0);
        let velocity = |v: usize| m.velocities.binary_search(&v).ok();
        let mut add_row = |i: usize, gradient: &SparseRow, one: f64, compliance: f64| {
            for &(v, x) in gradient {
                if let Some(k) = velocity(v) {
                    a.add_both(k, i, x * m.unit(v) / one);
                }
            }
            a.add(i, i, -compliance);
        };
        for (k, &r) in m.rows.iter().enumerate() {
            let one = scene.row_scale_at(r, size);
            add_row(row + k, &position.gradient[r], one, DEPENDENT);
            b[row + k] = -position.g[r] / one - DEPENDENT * before[k];
        }
        for (k, e) in given.iter().enumerate() {
            let i = row + m.rows.len() + k;
            add_row(i, &e.gradient, e.one(size), GIVEN);
            b[i] = -e.residual / e.one(size) - GIVEN * before[m.rows.len() + k];
        }
        for k in 0..n {
            a.add(k, k, DEPENDENT);
        }
        let mut factors = Factors::new(all, &a.places);
        let values: Vec<[f64; 1]> = a.values.iter().map(|&v| [v]).collect();
        factors.factor(&values).ok()?;
        factors.solve([&mut b]);
        Some(b)
    }
}

/// Adds to the equations of a link what holds one of its parts where its place counts.
fn add_part(
    position: &Position<'_>,
    (part, size): (usize, f64),
    arm: Vec3<f64>,
    at: usize,
    (a, b): (&mut Matrix, &mut [f64]),
) {
    let [offset, turned] = position.off(part);
    let off: Vec<f64> = (offset.times(1.0 / size).0.into_iter())
        .chain(turned.0)
        .collect();
    let stiffness = position.compliances(part).map(f64::recip);
    // changes of place and orientation with the twist (angular velocity, velocity of the center)
    let [x, y, z] = arm.0;
    let slopes: [[f64; 6]; 6] = [
        [0.0, z, -y, 1.0, 0.0, 0.0],
        [-z, 0.0, x, 0.0, 1.0, 0.0],
        [y, -x, 0.0, 0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
    ];
    for i in 0..6 {
        for j in 0..6 {
            let sum: f64 = (0..6)
                .map(|r| slopes[r][i] * stiffness[r] * slopes[r][j])
                .sum();
            if sum != 0.0 || i == j {
                a.add(at + i, at + j, sum);
            }
        }
        let pull = (0..6).map(|r| slopes[r][i] * stiffness[r] * off[r]);
        b[at + i] -= pull.sum::<f64>();
    }
}
