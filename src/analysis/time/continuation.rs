//! Continuation of a mechanism without freedom: steps along the branch on which it stands, as long
//! as the mechanism permits and whatever is put out on the way.
//!
//! ```text
//! predict   the cubic through the last two states, continued; after the first a straight line
//! correct   onto the rows
//! accept    if positions and velocities come out as predicted, but for a part of the way;
//!           if no loop has turned (ranks::Sides), or has where two branches meet
//! ```
//!
//! Else the step is shortened. Where no step is short enough the branch ends: the mechanism is
//! locked. Sources: Allgower & Georg, Introduction to Numerical Continuation Methods, chapters 2
//! and 8, for predictor, corrector and the orientation of the rows.

use crate::analysis::system::System;
use crate::analysis::time::ranks::{self, Side, Sides};
use crate::analysis::time::states::{Cubic, Node};
use crate::diagnostic::Diagnostic;
use crate::expr::program::{Program, Work};
use crate::numeric::{Failure, Ode, Stats};
use crate::scalar::Scalar;
use crate::scene::layout::Layout;
use crate::scene::mover::Mover;
use crate::scene::programs::{record, weights};

/// Violation of a row that is left out, relative to what counts as one, up to which it follows from
/// the others.
const FOLLOWS_TOLERANCE: f64 = 1e-8;
/// Correction of a predicted position, as a part of the way of the step, up to which it is the
/// continuation.
const POSITION_TOLERANCE: f64 = 0.1;
/// The same for velocities, which are predicted less well.
const VELOCITY_TOLERANCE: f64 = 0.25;
/// Correction up to which it always is, rad or parts of the mechanism's length.
const SMALL_CORRECTION: f64 = 1e-6;
/// Way of a coordinate or a drive in a step, at most, rad or parts of the mechanism's length.
const LONGEST_WAY: f64 = 1.0;
/// First step, as a part of the duration, where nothing moves.
const FIRST_STEP: f64 = 0.01;
/// Shortest step, as a part of the duration: the branch ends where it is not short enough.
const SHORTEST_STEP: f64 = 1e-11;
/// Factors by which a step may change the length of the next.
const CHANGE: [f64; 2] = [0.2, 2.0];
/// Part of the permitted length that is tried.
const SAFETY: f64 = 0.9;
/// Way of a motion over the one that its rates would explain, from which on it jumps.
const FURTHER: f64 = 10.0;
/// Narrower intervals about a time at which a state is looked for where branches meet.
const NARROWINGS: usize = 3;
/// Factor from one of these to the next: the error of the cubic falls with the fourth power.
const NARROWING: f64 = 0.05;
/// Change of a row by a drive, over the change of the drive, below which it does not read it.
const UNREAD: f64 = 1e-9;

/// The displacements that motions prescribe.
#[derive(Debug)]
struct Drives {
    /// value and rate of each   (2 n)
    program: Program,
    work: Work,
    /// values and rates at the present state, and at the one that is tried   (2 n each)
    values: [Vec<f64>; 2],
    /// the reciprocal of one rad, or of the mechanism's length; zero for motions that no row reads
    scales: Vec<f64>,
}

/// The steps of a mechanism along its branch.
#[derive(Debug)]
pub struct Continuation {
    /// the states before and after the last step
    before: Option<Node>,
    now: Node,
    /// where the next step ends at first
    h: f64,
    /// shortest and longest step
    bounds: [f64; 2],
    /// time at which all ends
    end: f64,
    /// what tells branches from each other, and the rows at the present state; `None`: no row takes
    /// part
    sides: Option<(Sides, Side)>,
    /// what divides each velocity where they are compared   (n_v)
    scales: Vec<f64>,
    /// what divides each position   (n_q, and more)
    lengths: Vec<f64>,
    drives: Option<Drives>,
    mover: Mover,
    layout: Layout,
    /// the last step: the cubic through its ends, and what a state within may be off from it
    cubic: Option<(Cubic, f64)>,
    /// it goes through a position at which branches meet
    met: bool,
}

/// The outcome of a step that was tried.
enum Tried {
    /// on the branch, with the factor that the next step may be longer by
    Continues {
        node: Node,
        side: Option<Side>,
        way: f64,
        factor: f64,
        met: bool,
    },
    /// not, and the factor by which it should be shorter
    Leaves { failure: Failure, factor: f64 },
}

impl Tried {
    fn leaves(what: usize, factor: f64) -> Self {
        let recoverable = true;
        Tried::Leaves {
            failure: Failure { what, recoverable },
            factor,
        }
    }
}

impl Continuation {
    /// Records what steps of a system need besides its equations.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub fn new(system: &System) -> Result<Self, Vec<Diagnostic>> {
        let l = system.scene.layout;
        let t = system.numbers[Layout::TIME];
        let w = weights(&system.scene);
        let mut this = Self {
            before: None,
            now: Node {
                t,
                y: system.numbers[l.y()].to_vec(),
            },
            h: 0.0,
            bounds: [0.0; 2],
            end: t,
            sides: None,
            scales: w.iter().map(|w| 1.0 / w.sqrt()).collect(),
            lengths: {
                let mut lengths = vec![1.0; l.n_y()];
                Ode::typical(system, &mut lengths);
                lengths
            },
            drives: Drives::new(system)?,
            mover: Mover::new(&system.scene),
            layout: l,
            cubic: None,
            met: false,
        };
        this.see_rows(system);
        Ok(this)
    }

    /// Begins at the state of the system that it was made for.
    pub fn begin(&mut self, system: &System, longest: f64, end: f64) {
        let t = system.numbers[Layout::TIME];
        (self.before, self.cubic) = (None, None);
        self.now.t = t;
        (self.now.y).copy_from_slice(&system.numbers[self.layout.y()]);
        self.h = FIRST_STEP * (end - t);
        self.bounds = [SHORTEST_STEP * (end - t), longest];
        (self.end, self.met) = (end, false);
        self.look(system);
    }

    /// Takes the rows as they are at the present state.
    fn look(&mut self, system: &System) {
        let numbers = system.numbers_at(self.now.t, &self.now.y);
        if let Some((sides, now)) = &mut self.sides {
            *now = sides.look(&numbers);
        }
        if let Some(drives) = &mut self.drives {
            drives.begin(&numbers);
        }
    }

    /// Returns the state that has been reached.
    pub fn now(&self) -> &Node {
        &self.now
    }

    /// Returns the length of the next step, if nothing is in its way.
    pub fn step(&self) -> f64 {
        self.h
    }

    /// Proposes the length of the next step.
    pub fn propose(&mut self, h: f64) {
        self.h = h.max(self.bounds[0]);
    }

    /// Takes note that other rows take part from the present state on.
    pub fn see_rows(&mut self, system: &System) {
        self.sides = Sides::new(system).map(|sides| (sides, Side::default()));
        self.look(system);
    }

    /// Takes one step, no further than `landing`.
    ///
    /// # Errors
    /// The branch ends here: what the last step that was tried met, and its length.
    pub fn advance(
        &mut self,
        system: &mut System,
        landing: f64,
        stats: &mut Stats,
    ) -> Result<(), (Failure, f64)> {
        let landing = landing.min(self.end);
        loop {
            let wanted = self.h.min(self.bounds[1]);
            let near = self.now.t + wanted * (1.0 + 1e-9) >= landing;
            let t = if near { landing } else { self.now.t + wanted };
            let h = t - self.now.t;
            stats.evaluations += 1;
            match self.attempt(system, t) {
                Tried::Continues {
                    node,
                    side,
                    way,
                    factor,
                    met,
                } => {
                    let next = h * factor;
                    self.h = if near { next.max(self.h) } else { next };
                    let before = std::mem::replace(&mut self.now, node);
                    let cubic = Cubic::new(&self.mover, self.layout, [&before, &self.now]);
                    self.cubic = Some((cubic, POSITION_TOLERANCE * way + SMALL_CORRECTION));
                    self.before = Some(before);
                    if let (Some((_, now)), Some(side)) = (&mut self.sides, side) {
                        *now = side;
                    }
                    if let Some(drives) = &mut self.drives {
                        drives.accept();
                    }
                    self.met = met;
                    stats.steps += 1;
                    return Ok(());
                }
                Tried::Leaves { failure, factor } => {
                    stats.rejected += 1;
                    self.h = h * factor;
                    let rounding = 4.0 * f64::EPSILON * self.now.t.abs();
                    let shortest = self.bounds[0].max(rounding);
                    if self.h < shortest {
                        return match self.jump(system, self.now.t + shortest) {
                            true => Ok(()),
                            false => Err((failure, self.h)),
                        };
                    }
                }
            }
        }
    }

    /// Follows a motion that jumps to the nearest state behind the jump; returns whether one does,
    /// and there is such a state.
    fn jump(&mut self, system: &mut System, t: f64) -> bool {
        let mut node = Node {
            t,
            y: self.now.y.clone(),
        };
        let Some(drives) = &mut self.drives else {
            return false;
        };
        let numbers = system.numbers_at(t, &node.y);
        if !drives.jump(&numbers, t - self.now.t) || close(system, &mut node).is_err() {
            return false;
        }
        self.h = FIRST_STEP * (self.end - t);
        (self.before, self.cubic, self.now) = (None, None, node);
        self.see_rows(system);
        true
    }

    /// Tries a step to a time.
    fn attempt(&mut self, system: &mut System, t: f64) -> Tried {
        let h = t - self.now.t;
        // nothing but motions on coordinates of the forest
        let Some(mut sides) = self.sides.take() else {
            let y = self.now.y.clone();
            if let Some((what, off)) = system.worst_left_out(t, &y)
                && (off.is_nan() || off > FOLLOWS_TOLERANCE)
            {
                return Tried::leaves(what, 0.5);
            }
            return Tried::Continues {
                node: Node { t, y },
                side: None,
                way: f64::INFINITY,
                factor: CHANGE[1],
                met: false,
            };
        };
        let numbers = system.numbers_at(t, &self.now.y);
        let driven = (self.drives.as_mut()).map_or(0.0, |drives| drives.way(&numbers, h));
        let tried = if driven > LONGEST_WAY {
            Tried::leaves(0, (SAFETY * LONGEST_WAY / driven).max(CHANGE[0]))
        } else {
            self.correct(system, t, &mut sides, driven)
        };
        self.sides = Some(sides);
        tried
    }

    /// Predicts a state, and brings it onto the rows.
    fn correct(
        &self,
        system: &mut System,
        t: f64,
        (sides, here): &mut (Sides, Side),
        driven: f64,
    ) -> Tried {
        let h = t - self.now.t;
        let predicted = self.predict(t);
        let mut node = predicted.clone();
        if let Err(failure) = close(system, &mut node) {
            let factor = 0.5;
            return Tried::Leaves { failure, factor };
        }
        // as predicted?
        let (off, way) = self.compare(sides, &predicted, &node, h);
        if off.is_nan() || off > 1.0 || way > LONGEST_WAY {
            let factor = if off > 1.0 {
                SAFETY * Scalar::powf(off, -0.25)
            } else {
                0.5
            };
            return Tried::leaves(0, factor.clamp(CHANGE[0], 0.7));
        }
        // on the same branch?
        let side = sides.look(&system.numbers_at(t, &node.y));
        let turned = Sides::turned(here, &side);
        let met = !turned.is_empty();
        if met && !sides.meet(system, &turned, [(&self.now, here), (&node, &side)]) {
            return Tried::leaves(0, 0.5);
        }
        let most = SAFETY * LONGEST_WAY / way.max(driven).max(f64::MIN_POSITIVE);
        let factor = (SAFETY * Scalar::powf(off.max(1e-10), -0.25)).min(most);
        Tried::Continues {
            node,
            side: Some(side),
            way,
            factor: factor.clamp(CHANGE[0], CHANGE[1]),
            met,
        }
    }

    /// Continues the last two states, or the present velocity, to a time.
    fn predict(&self, t: f64) -> Node {
        let mut y = self.now.y.clone();
        match &self.cubic {
            Some((cubic, _)) => cubic.at(&self.mover, t, &mut y),
            None => {
                let state = self.layout.state_mut(&mut y);
                let change: Vec<f64> = state.v.iter().map(|v| v * (t - self.now.t)).collect();
                self.mover.displace(state.q, &change);
            }
        }
        Node { t, y }
    }

    /// Compares a state with its prediction: by how much they differ, as a part of what is
    /// permitted, and the longest way of a coordinate.
    fn compare(&self, sides: &Sides, predicted: &Node, node: &Node, h: f64) -> (f64, f64) {
        let l = self.layout;
        let [p, n, o] = [predicted, node, &self.now].map(|n| l.state(&n.y));
        let between = |a: &[f64], b: &[f64]| -> Vec<f64> {
            let change: Vec<f64> = b.iter().zip(a).map(|(b, a)| b - a).collect();
            self.mover.tangent(a, &change, l.n_v)
        };
        let (correction, moved) = (between(p.q, n.q), between(o.q, n.q));
        let (mut off, mut way) = (0.0_f64, 0.0_f64);
        for coordinates in sides.coordinates() {
            let largest = |f: &dyn Fn(usize) -> f64| {
                let sizes = coordinates.iter().map(|&k| (f(k) * self.scales[k]).abs());
                sizes.fold(0.0, |m: f64, x| if x.is_nan() { x } else { m.max(x) })
            };
            let pace = h * largest(&|k| n.v[k].abs().max(o.v[k].abs()));
            let q = largest(&|k| correction[k]) / (POSITION_TOLERANCE * pace + SMALL_CORRECTION);
            let v = h * largest(&|k| n.v[k] - p.v[k]);
            let v = v / (VELOCITY_TOLERANCE * pace + SMALL_CORRECTION);
            off = if (q + v).is_nan() {
                f64::NAN
            } else {
                off.max(q).max(v)
            };
            way = way.max(largest(&|k| moved[k]));
        }
        (off, way)
    }

    /// Finds the state at a time within the last step.
    ///
    /// # Errors
    /// No state of the rows is near the cubic through the ends of the step.
    pub fn within(&self, system: &mut System, t: f64) -> Result<Vec<f64>, Failure> {
        let mut y = self.now.y.clone();
        let (Some(before), Some((cubic, permitted)), false) =
            (&self.before, &self.cubic, t >= self.now.t)
        else {
            return Ok(y);
        };
        if !self.met {
            cubic.at(&self.mover, t, &mut y);
            let mut node = Node { t, y };
            let predicted = node.y[..self.layout.n_q].to_vec();
            close(system, &mut node)?;
            let changes = predicted.iter().zip(&node.y).zip(&self.lengths);
            let off = changes.map(|((p, q), one)| ((q - p) / one).abs());
            return match off.fold(0.0, f64::max) <= *permitted {
                true => Ok(node.y),
                false => Err(Failure {
                    what: 0,
                    recoverable: true,
                }),
            };
        }
        // branches meet within the step: between states ever nearer to this one, until what
        // differs is rounding
        let (mut ends, mut cubic) = ([before.clone(), self.now.clone()], cubic.clone());
        let mut width = self.now.t - before.t;
        for _ in 0..NARROWINGS {
            width *= NARROWING;
            ends = [(t - width).max(ends[0].t), (t + width).min(ends[1].t)].map(|t| {
                let mut y = self.now.y.clone();
                cubic.at(&self.mover, t, &mut y);
                let mut node = Node { t, y };
                let kept = node.clone();
                close(system, &mut node).map_or(kept, |()| node)
            });
            cubic = Cubic::new(&self.mover, self.layout, [&ends[0], &ends[1]]);
        }
        cubic.at(&self.mover, t, &mut y);
        Ok(y)
    }

    /// Returns the states of the last step, by their times.
    pub fn states(&self) -> impl FnMut(&mut System, f64, &mut [f64]) -> bool + '_ {
        |system, t, state| match self.within(system, t) {
            Ok(y) => {
                state.copy_from_slice(&y);
                true
            }
            Err(_) => false,
        }
    }

    /// Goes back to the beginning of the last step, to go on from there to a time within it;
    /// returns whether there is one.
    pub fn step_back(&mut self, system: &System, t: f64) -> bool {
        let Some(before) = self.before.take() else {
            return false;
        };
        self.cubic = None;
        self.h = 0.5 * (t - before.t);
        self.now = before;
        self.look(system);
        self.h > 0.0
    }
}

/// Brings a state onto the rows, those that are left out too.
fn close(system: &mut System, node: &mut Node) -> Result<(), Failure> {
    // the same bits whatever was put out before
    system.project_anew();
    system.put_on_rows_exactly(node.t, &mut node.y)?;
    // where rows are dependent the least change may be none, beside the rows too
    if let Some((what, off)) = system.worst_kept(node.t, &node.y)
        && (off.is_nan() || off > FOLLOWS_TOLERANCE)
    {
        let recoverable = true;
        return Err(Failure { what, recoverable });
    }
    if let Some((what, off)) = system.worst_left_out(node.t, &node.y)
        && (off.is_nan() || off > FOLLOWS_TOLERANCE)
    {
        // the rows that take part leave two ways here; all rows together one
        let mut numbers = system.numbers_at(node.t, &node.y);
        if !ranks::repair(system.configured(), &mut numbers) {
            let recoverable = true;
            return Err(Failure { what, recoverable });
        }
        node.y.copy_from_slice(&numbers[system.scene.layout.y()]);
    }
    Ok(())
}

impl Drives {
    /// Records the motions of a system; `None` where there are none.
    fn new(system: &System) -> Result<Option<Self>, Vec<Diagnostic>> {
        let scene = system.configured();
        let n = scene.motions.len();
        if n == 0 {
            return Ok(None);
        }
        let program = record(scene, |at| {
            let both = |m: usize| [at.prescribed(m).value, at.prescribed(m).first];
            (0..n).flat_map(both).collect()
        });
        let program = program.map_err(crate::analysis::system::complaints)?;
        let mut drives = Self {
            program,
            work: Work::default(),
            values: [vec![0.0; 2 * n], vec![0.0; 2 * n]],
            scales: Vec::new(),
        };
        drives.begin(&system.numbers);
        let read = read_by_rows(system, &drives.values[0]);
        let scale = |m: usize| f64::from(u8::from(read[m])) / scene.unit_of_motion(m);
        drives.scales = (0..n).map(scale).collect();
        Ok(Some(drives))
    }

    /// Evaluates the motions at all numbers of the present state.
    fn begin(&mut self, numbers: &[f64]) {
        (self.program).run(numbers, &mut self.work, &mut self.values[0]);
    }

    /// Takes over the state that was tried last.
    fn accept(&mut self) {
        self.values.swap(0, 1);
    }

    /// Returns the longest way of a motion to a state that is `h` later, by its displacements and
    /// by its rates.
    fn way(&mut self, numbers: &[f64], h: f64) -> f64 {
        (self.program).run(numbers, &mut self.work, &mut self.values[1]);
        let [from, to] = &self.values;
        let ways = from.chunks_exact(2).zip(to.chunks_exact(2));
        let way = |((a, b), scale): ((&[f64], &[f64]), &f64)| {
            let fastest = a[1].abs().max(b[1].abs());
            scale * (b[0] - a[0]).abs().max(h * fastest)
        };
        ways.zip(&self.scales).map(way).fold(0.0, f64::max)
    }

    /// Returns whether a motion goes further to a state that is `h` later than its rates at both
    /// say.
    fn jump(&mut self, numbers: &[f64], h: f64) -> bool {
        (self.program).run(numbers, &mut self.work, &mut self.values[1]);
        let [from, to] = &self.values;
        from.chunks_exact(2).zip(to.chunks_exact(2)).any(|(a, b)| {
            let fastest = a[1].abs().max(b[1].abs());
            let rounding = 8.0 * f64::EPSILON * b[0].abs().max(a[0].abs());
            (b[0] - a[0]).abs() > FURTHER * h * fastest + rounding
        })
    }
}

/// Returns for each motion whether any row reads it.
fn read_by_rows(system: &System, values: &[f64]) -> Vec<bool> {
    /// Change of what a motion prescribes by which the rows that read it are found, rad or parts of
    /// the length of the scene.
    const DISPLACEMENT: f64 = 1e-4;
    let (scene, l) = (system.configured(), system.scene.layout);
    let (t, q, x) = (
        system.numbers[Layout::TIME],
        &system.numbers[l.q()],
        &system.numbers[l.x()],
    );
    let displacements: Vec<f64> = values.iter().step_by(2).copied().collect();
    let rows = |displacements: &[f64]| {
        let there = scene.configuration.with_motions_at(displacements);
        crate::analysis::start::assemble::rows_at_rest(scene.within(&there), t, q, x)
    };
    let still = rows(&displacements);
    let units: Vec<f64> = weights(&scene).iter().map(|w| w.sqrt()).collect();
    let read = |m: usize| {
        let mut other = displacements.clone();
        other[m] += DISPLACEMENT * scene.unit_of_motion(m);
        let (values, slopes) = rows(&other);
        let change = (0..scene.rows.len()).map(|r| {
            let turned =
                (slopes[r].iter().zip(&still.1[r])).map(|(a, b)| (a.1 - b.1).abs() * units[a.0]);
            turned.fold((values[r] - still.0[r]).abs(), f64::max) / scene.row_scale(r)
        });
        let change = change.fold(0.0, |m, x| if x.is_nan() { x } else { f64::max(m, x) });
        change.is_nan() || change > UNREAD * DISPLACEMENT
    };
    (0..displacements.len()).map(read).collect()
}
