//! Branches: functions that change branch, held on one side of their switches while a step is
//! taken.
//!
//! While branches are held the rates are smooth, wherever a step leads. `Slides` are the switches
//! at which the motion stays meanwhile.

use super::algebraic_loops::AlgebraicLoops;
use super::bounds::{Bounded, Bounds, Watched};
use super::sliding::Slides;
use crate::expr::program::{Program, Work};
use crate::model::Level;
use crate::scalar::{Interval, Scalar};
use crate::scene::equations::Unsupported;
use crate::scene::layout::{Layout, LongRow};
use crate::scene::programs::{self, Switching};
use crate::scene::recorder::Recorder;
use crate::scene::{Scene, Source};

/// Angle by which an angle that decides a branch may turn within a step: a quarter of a turn, in
/// which a step is looked at several times.
const MAX_TURN_PER_STEP: f64 = std::f64::consts::FRAC_PI_2;

/// The switching functions of a configuration, and the branches that are held.
#[derive(Clone, Debug)]
pub struct Branches {
    /// values that change sign where a force or a differential equation changes branch
    pub(super) switching: Option<Switching>,
    switch_work: Work,
    unknown_work: Work,
    pub(super) held_work: Work,
    sensor_work: Work,
    /// the numbers, then what the switches read after them: unknowns of loops, then sides
    pub(super) numbers: Vec<f64>,
    /// loops with branches held, solved in that row
    pub(super) loops: Option<AlgebraicLoops>,
    /// that row: the numbers, the unknowns of all loops, the sides
    pub(super) row: LongRow,
    /// whether branches are held
    holding: bool,
    /// sides of the switches, as the held rate reads them   (n_switches)
    sides: Vec<f64>,
    /// whether the row has these sides
    pub(super) row_has_sides: bool,
    /// switches at which the motion stays while branches are held
    pub(super) slides: Slides,
    /// angles that decide a branch again in every turn
    watched_angles: Vec<WatchedAngle>,
    /// the numbers of the steps while evaluations are made aside
    numbers_of_steps: Vec<f64>,
    /// whether they are
    is_aside: bool,
    /// the program of the switches over bounds
    bounds: Bounded,
}

impl Branches {
    /// Records the switching functions of a scene.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub(super) fn new(recorder: &Recorder<'_, '_>) -> Result<Self, Vec<Unsupported>> {
        let scene = recorder.scene();
        let switching = programs::switching(recorder)?;
        let n = switching.as_ref().map_or(0, |s| s.switches.n_outputs());
        let row = LongRow {
            numbers: scene.layout,
            n_more: scene.loops.len(),
            n_sides: n,
        };
        let residual = switching.as_ref().and_then(|s| s.held_loops.clone());
        Ok(Self {
            loops: residual.map(|r| AlgebraicLoops::of(&scene, r, row.more())),
            row,
            watched_angles: watched_angles(&scene, switching.as_ref()),
            switching,
            switch_work: Work::default(),
            unknown_work: Work::default(),
            held_work: Work::default(),
            sensor_work: Work::default(),
            numbers: Vec::new(),
            holding: false,
            sides: vec![0.0; n],
            row_has_sides: false,
            slides: Slides::default(),
            numbers_of_steps: Vec::new(),
            is_aside: false,
            bounds: Bounded::default(),
        })
    }

    /// Returns the number of switching functions.
    pub fn len(&self) -> usize {
        let switching = self.switching.as_ref();
        switching.map_or(0, |s| s.switches.n_outputs())
    }

    /// Returns whether nothing changes branch.
    pub fn is_empty(&self) -> bool {
        self.switching.is_none()
    }

    /// Returns whether branches can be held.
    pub fn can_hold(&self) -> bool {
        self.held_rate().is_some()
    }

    /// Evaluates for each sensor whether what it watches is beyond its value on the branches that
    /// are held (0, 1); returns false where none are, or nobody can tell   (n_sensors)
    pub(super) fn beyond_sensors(&mut self, numbers: &[f64], beyond: &mut Vec<f64>) -> bool {
        let held = |switching: &Switching| switching.held_sensors.is_some();
        let can = self.holding && self.switching.as_ref().is_some_and(held);
        if !can || self.with_sides(numbers).is_none() {
            return false;
        }
        let switching = self.switching.as_ref();
        let Some(program) = switching.and_then(|s| s.held_sensors.as_ref()) else {
            return false;
        };
        beyond.resize(program.n_outputs(), 0.0);
        program.run(&self.numbers, &mut self.sensor_work, beyond);
        true
    }

    /// Returns the sides of the switches, whether or not branches are held   (n_switches)
    pub(super) fn sides(&self) -> &[f64] {
        &self.sides
    }

    /// Returns whether branches are held.
    #[inline]
    pub(super) fn is_holding(&self) -> bool {
        self.holding
    }

    /// Returns the program of the rates with branches held, which reads the unknowns of loops and
    /// the sides after the numbers.
    pub(super) fn held_rate(&self) -> Option<&Program> {
        self.switching.as_ref().and_then(|s| s.held.as_ref())
    }

    /// Holds the branches on these sides of the switches (−1, 0, 1) from now on, wherever the state
    /// goes; nothing slides.
    pub fn hold(&mut self, sides: &[i8]) {
        self.slide([]);
        self.sides.clear();
        self.sides.extend(sides.iter().map(|&s| f64::from(s)));
        self.row_has_sides = false;
        self.holding = self.can_hold();
    }

    /// Exchanges the sides of the switches: a look at another branch.
    pub(super) fn exchange_sides(&mut self, sides: &mut Vec<f64>) {
        std::mem::swap(&mut self.sides, sides);
        self.row_has_sides = false;
    }

    /// Takes the branch that the state says from now on.
    pub fn release(&mut self) {
        self.holding = false;
    }

    /// Returns the numbers followed by the unknowns of loops, as the held branches have them, and
    /// by the sides: what the held rate reads. `None`: a loop has no solution near.
    pub(super) fn with_sides(&mut self, numbers: &[f64]) -> Option<&[f64]> {
        self.put(numbers);
        self.solve_held().is_ok().then_some(&self.numbers[..])
    }

    /// Puts numbers and sides into the row that held programs read. Unknowns of loops stay what
    /// they were, where the numbers do not say them.
    pub(super) fn put(&mut self, numbers: &[f64]) {
        let LongRow {
            n_more, n_sides, ..
        } = self.row;
        if self.numbers.len() != numbers.len() + n_more + n_sides {
            self.numbers.resize(self.row.len(), 0.0);
            self.row_has_sides = false;
        }
        let (front, behind) = self.numbers.split_at_mut(numbers.len());
        front.copy_from_slice(numbers);
        if !std::mem::replace(&mut self.row_has_sides, true) {
            behind[n_more..].copy_from_slice(&self.sides);
        }
        if self.row.numbers.n_loops > 0 {
            behind[..n_more].copy_from_slice(&numbers[self.row.numbers.loops()]);
        }
    }

    /// Solves the loops of the held branches in the row.
    ///
    /// # Errors
    /// The index of a loop without a solution near.
    pub(super) fn solve_held(&mut self) -> Result<(), usize> {
        match &mut self.loops {
            Some(loops) => loops.solve(&mut self.numbers),
            None => Ok(()),
        }
    }

    /// Puts the unknowns of loops, as the held branches have them, into the numbers. False: no
    /// branches are held, or a loop has no solution near.
    pub(super) fn fill_loops(&mut self, numbers: &mut [f64]) -> bool {
        if !self.holding || self.loops.is_none() || self.with_sides(numbers).is_none() {
            return false;
        }
        let places = self.row.numbers.loops();
        numbers[places].copy_from_slice(&self.numbers[self.row.more()]);
        true
    }

    /// Begins or ends evaluations aside, which leave neither unknowns nor factors of loops behind.
    pub(super) fn exchange_traces(&mut self) {
        let Some(loops) = &mut self.loops else {
            return;
        };
        loops.exchange_factors();
        self.is_aside = !self.is_aside;
        self.row_has_sides = false;
        if self.is_aside {
            self.numbers_of_steps.clone_from(&self.numbers);
        } else {
            self.numbers.clone_from(&self.numbers_of_steps);
        }
        self.slides.exchange_unknowns(self.is_aside);
    }

    /// Returns whether what held branches read has to be solved for beside the programs.
    pub(super) fn has_loops(&self) -> bool {
        self.loops.is_some()
    }

    /// Evaluates the rates of the branches that are held; false where they have no value.
    pub(super) fn run_held(&mut self, numbers: &[f64], rates: &mut [f64]) -> bool {
        if self.is_sliding() && self.run_sliding(numbers, rates) {
            return true;
        }
        if self.with_sides(numbers).is_none() {
            return false;
        }
        if !run(
            self.switching.as_ref(),
            &self.numbers,
            &mut self.held_work,
            rates,
        ) {
            return false;
        }
        // beyond its end a branch may have no value
        rates.iter().map(|x| x * 0.0).sum::<f64>() == 0.0
    }

    /// Evaluates the rates of the branches that are held and between which nothing slides, into
    /// their place; returns how strong the rows are. `None`: they have no value.
    pub(super) fn held_rates_at(&mut self, numbers: &[f64], ydot: &mut [f64]) -> Option<f64> {
        self.with_sides(numbers)?;
        let held = self.switching.as_ref()?.held.as_ref()?;
        let (strength, is_finite) = held.run_finite(&self.numbers, &mut self.held_work, ydot);
        (is_finite && strength.is_finite()).then_some(strength)
    }

    /// Returns how long a step from a state may be so that no angle which decides a branch turns by
    /// more than [`MAX_TURN_PER_STEP`]: a free flight or a free rotation leaves long steps no
    /// reason to become shorter, and a branch may come and go in every turn.
    pub(in crate::analysis) fn longest_turn(&self, y: &[f64], ydot: &[f64]) -> f64 {
        let time = |angle: &WatchedAngle| {
            let [speed, acceleration] = angle.rates(&self.row.numbers, y, ydot).map(f64::abs);
            let fastest = (speed * speed + 2.0 * MAX_TURN_PER_STEP * acceleration).sqrt();
            2.0 * MAX_TURN_PER_STEP / (speed + fastest)
        };
        let times = self.watched_angles.iter().map(time);
        times.filter(|h| !h.is_nan()).fold(f64::INFINITY, f64::min)
    }
}

impl Watched for Branches {
    fn bounded(&self) -> (Vec<usize>, Vec<usize>) {
        match &self.switching {
            Some(Switching { switches, .. }) => Bounded::of(switches, self.row),
            None => Default::default(),
        }
    }

    /// Evaluates the switching functions, the branches of others held where branches are held.
    fn values(&mut self, numbers: &[f64], values: &mut [f64]) {
        self.put(numbers);
        let solved = self.holding && self.solve_held().is_ok();
        let Some(switching) = &self.switching else {
            return;
        };
        if let (Some(unknowns), false) = (&switching.unknowns, solved) {
            let places = self.row.more();
            let (work, unknown) = (&mut self.unknown_work, &mut self.numbers[places]);
            unknowns.run(numbers, work, unknown);
        }
        let work = &mut self.switch_work;
        switching.switches.run(&self.numbers, work, values);
        if self.is_sliding() {
            self.sliding_values(numbers, values);
        }
    }

    fn loop_unknowns(&self) -> &[f64] {
        self.numbers.get(self.row.more()).unwrap_or(&[])
    }

    fn take_bounds(
        &mut self,
        numbers: &[f64],
        time: Interval,
        unknowns: &mut dyn Iterator<Item = (usize, [Interval; 2])>,
    ) {
        let read = (numbers, &self.sides[..]);
        self.bounds.take(self.row, read, time, unknowns);
    }

    fn bound(&mut self, bounds: &mut [Bounds]) {
        if let Some(Switching { switches, .. }) = &self.switching {
            self.bounds.all(switches, bounds);
        }
    }

    fn bound_one(&mut self, k: usize) -> Bounds {
        match &self.switching {
            Some(Switching { switches, .. }) => self.bounds.one(switches, k),
            None => Bounds::constant(f64::NAN),
        }
    }

    fn unknowns_of(&mut self, k: usize) -> Vec<usize> {
        match &self.switching {
            Some(Switching { switches, .. }) => self.bounds.unknowns_of(switches, self.row, k),
            None => Vec::new(),
        }
    }
}

/// Runs the program of the rates with branches held; false where there is none.
pub(super) fn run(
    switching: Option<&Switching>,
    numbers: &[f64],
    work: &mut Work,
    rates: &mut [f64],
) -> bool {
    let held = switching.and_then(|s| s.held.as_ref());
    if let Some(held) = held {
        held.run(numbers, work, rates);
    }
    held.is_some()
}

/// An angle that decides a branch again in every turn.
#[derive(Clone, Copy, Debug)]
enum WatchedAngle {
    /// an unknown: its place in v
    Free(usize),
    /// driven at a given velocity: place in x of the displacement
    Velocity(usize),
    /// driven by a given acceleration: place in x of the displacement
    Acceleration(usize),
}

impl WatchedAngle {
    /// Returns its rate, and the rate of that as far as the state says it.
    fn rates(self, layout: &Layout, y: &[f64], ydot: &[f64]) -> [f64; 2] {
        let (y, ydot) = (layout.state(y), layout.state(ydot));
        match self {
            Self::Free(v) => [y.v[v], ydot.v[v]],
            Self::Velocity(x) => [ydot.x[x], 0.0],
            Self::Acceleration(x) => [ydot.x[x], ydot.x[x + 1]],
        }
    }
}

/// Returns the angles that a switch reads otherwise than by straight pieces; of those of a ball all
/// three. Angles that time drives are left to time events.
fn watched_angles(scene: &Scene, switching: Option<&Switching>) -> Vec<WatchedAngle> {
    let Some(Switching { switches, .. }) = switching else {
        return Vec::new();
    };
    let angular = scene.coordinates.iter().filter(|c| c.angular);
    let watched = angular.filter_map(|c| match c.source {
        Source::Free { q, v } => Some((scene.layout.q_at(q), WatchedAngle::Free(v))),
        Source::Driven(m) => {
            let motion = &scene.motions[m];
            let x = motion.state?;
            let angle = match motion.level {
                Level::Displacement => return None,
                Level::Velocity => WatchedAngle::Velocity(x),
                Level::Acceleration => WatchedAngle::Acceleration(x),
            };
            Some((scene.layout.x_at(x), angle))
        }
    });
    let (positions, angles): (Vec<usize>, Vec<WatchedAngle>) = watched.unzip();
    let bends = switches.bends(&positions).into_iter();
    let bent = bends.zip(angles).filter(|(bends, _)| *bends);
    bent.map(|(_, angle)| angle).collect()
}
