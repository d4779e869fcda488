//! Branches: functions that change branch, held on one side of their switches while a step is
//! taken.
//!
//! While branches are held the rates are smooth, wherever a step leads. `Slides` are the switches
//! at which the motion stays meanwhile.

use super::complaints;
use super::sliding::Slides;
use crate::diagnostic::Diagnostic;
use crate::expr::program::{Program, Work};
use crate::model::Level;
use crate::scene::configuration::Configured;
use crate::scene::layout::Layout;
use crate::scene::programs::{self, Switching};
use crate::scene::{Scene, Source};

/// Angle by which an angle that decides a branch may turn within a step: a quarter of a turn, in
/// which a step is looked at several times.
const MAX_TURN_PER_STEP: f64 = std::f64::consts::FRAC_PI_2;

/// The switching functions of a configuration, and the branches that are held.
#[derive(Debug)]
pub struct Branches {
    /// values that change sign where a force or a differential equation changes branch
    pub(super) switching: Option<Switching>,
    switch_work: Work,
    unknown_work: Work,
    pub(super) held_work: Work,
    /// the numbers, then what the switches read after them: unknowns of linear loops, or sides
    pub(super) numbers: Vec<f64>,
    pub(super) layout: Layout,
    /// whether branches are held
    holding: bool,
    /// sides of the switches, as the held rate reads them   (n_switches)
    sides: Vec<f64>,
    /// switches at which the motion stays while branches are held
    pub(super) slides: Slides,
    /// angles that decide a branch again in every turn
    watched_angles: Vec<WatchedAngle>,
}

impl Branches {
    /// Records the switching functions of a scene.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub(super) fn new(scene: Configured<'_>) -> Result<Self, Vec<Diagnostic>> {
        let switching = programs::switching(scene).map_err(complaints)?;
        let n = switching.as_ref().map_or(0, |s| s.switches.n_outputs());
        Ok(Self {
            watched_angles: watched_angles(&scene, switching.as_ref()),
            layout: scene.layout,
            switching,
            switch_work: Work::default(),
            unknown_work: Work::default(),
            held_work: Work::default(),
            numbers: Vec::new(),
            holding: false,
            sides: vec![0.0; n],
            slides: Slides::default(),
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

    /// Returns the sides of the switches while branches are held.
    pub(super) fn held_sides(&self) -> Option<&[f64]> {
        self.holding.then_some(&self.sides[..])
    }

    /// Returns the sides of the switches, whether or not branches are held   (n_switches)
    pub(super) fn sides(&self) -> &[f64] {
        &self.sides
    }

    /// Returns whether branches are held.
    pub(super) fn is_holding(&self) -> bool {
        self.holding
    }

    /// Returns the program of the rates with branches held, which reads the sides after the
    /// numbers.
    pub(super) fn held_rate(&self) -> Option<&Program> {
        self.switching.as_ref().and_then(|s| s.held.as_ref())
    }

    /// Holds the branches on these sides of the switches (−1, 0, 1) from now on, wherever the state
    /// goes; nothing slides.
    pub fn hold(&mut self, sides: &[i8]) {
        self.slide([]);
        self.sides.clear();
        self.sides.extend(sides.iter().map(|&s| f64::from(s)));
        self.holding = self.can_hold();
    }

    /// Takes the branch that the state says from now on.
    pub fn release(&mut self) {
        self.holding = false;
    }

    /// Returns the numbers followed by the sides, as the held rate reads them.
    pub(super) fn with_sides(&mut self, numbers: &[f64]) -> &[f64] {
        let n = numbers.len();
        let all = &mut self.numbers;
        all.resize(n + self.sides.len(), 0.0);
        all[..n].copy_from_slice(numbers);
        all[n..].copy_from_slice(&self.sides);
        all
    }

    /// Evaluates the rates of the branches that are held; false where none are, or where they have
    /// no value.
    pub(super) fn run_held(&mut self, numbers: &[f64], rates: &mut [f64]) -> bool {
        if !self.holding {
            return false;
        }
        if self.is_sliding() && self.run_sliding(numbers, rates) {
            return true;
        }
        self.with_sides(numbers);
        let Some(Switching {
            held: Some(held), ..
        }) = &self.switching
        else {
            return false;
        };
        held.run(&self.numbers, &mut self.held_work, rates);
        // beyond its end a branch may have no value
        rates.iter().map(|x| x * 0.0).sum::<f64>() == 0.0
    }

    /// Evaluates the switching functions, the branches of others held where branches are held
    /// (n_switches)
    pub(super) fn values(&mut self, numbers: &[f64], values: &mut [f64]) {
        let Some(switching) = &self.switching else {
            return;
        };
        let n = numbers.len();
        let all = &mut self.numbers;
        if let Some(unknowns) = &switching.unknowns {
            all.resize(n + unknowns.n_outputs(), 0.0);
            all[..n].copy_from_slice(numbers);
            unknowns.run(numbers, &mut self.unknown_work, &mut all[n..]);
        } else if switching.held.is_some() {
            all.resize(n + values.len(), 0.0);
            all[..n].copy_from_slice(numbers);
            all[n..].copy_from_slice(&self.sides);
        } else {
            let work = &mut self.switch_work;
            switching.switches.run(numbers, work, values);
            return;
        }
        switching.switches.run(all, &mut self.switch_work, values);
        if self.is_sliding() {
            self.sliding_values(numbers, values);
        }
    }

    /// Returns how long a step from a state may be so that no angle which decides a branch turns by
    /// more than [`MAX_TURN_PER_STEP`]: a free flight or a free rotation leaves long steps no
    /// reason to become shorter, and a branch may come and go in every turn.
    pub(in crate::analysis) fn longest_turn(&self, y: &[f64], ydot: &[f64]) -> f64 {
        let time = |angle: &WatchedAngle| {
            let [speed, acceleration] = angle.rates(&self.layout, y, ydot).map(f64::abs);
            let fastest = (speed * speed + 2.0 * MAX_TURN_PER_STEP * acceleration).sqrt();
            2.0 * MAX_TURN_PER_STEP / (speed + fastest)
        };
        let times = self.watched_angles.iter().map(time);
        times.filter(|h| !h.is_nan()).fold(f64::INFINITY, f64::min)
    }
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
        Source::Free { q, v } => {
            let bends = switches.bends(scene.layout.q_at(q));
            bends.then_some(WatchedAngle::Free(v))
        }
        Source::Driven(m) => {
            let motion = &scene.motions[m];
            let x = motion.state?;
            let angle = match motion.level {
                Level::Displacement => return None,
                Level::Velocity => WatchedAngle::Velocity(x),
                Level::Acceleration => WatchedAngle::Acceleration(x),
            };
            switches.bends(scene.layout.x_at(x)).then_some(angle)
        }
    });
    watched.collect()
}
