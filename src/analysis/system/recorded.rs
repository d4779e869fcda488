//! The programs of a scene in one configuration.
//!
//! They are recorded together, before the first step and again whenever other rows are chosen: each
//! of them is written for the rows that take part, as whatever reads an acceleration or a reaction
//! depends on them. What has been seen so far (the past, sensors, samples) is carried over.

use super::algebraic_loops::AlgebraicLoops;
use super::branches::Branches;
use super::clocks::Clocks;
use super::closures::Hook;
use super::complaints;
use super::downstream::DownstreamRates;
use super::external_inputs::ExternalInputs;
use super::jacobian::Derivatives;
use super::peaks::Peaks;
use super::recording::Recording;
use super::rows::Rows;
use super::samples::Samples;
use super::sensors::Sensors;
use super::time_events::TimeEvents;
use super::tunnelling::ThicknessBounds;
use super::turns::Turns;
use crate::analysis::look::Look;
use crate::diagnostic::Diagnostic;
use crate::expr::program::{Builder, Program};
use crate::scene::articulated::ArticulatedFactor;
use crate::scene::cams;
use crate::scene::configuration::{Configuration, Configured, Way};
use crate::scene::elimination;
use crate::scene::equations::{Equations, KINEMATIC, STATIC};
use crate::scene::programs;
use crate::scene::recorder::{self, Recorder};
use crate::scene::solve;
use crate::scene::{Scene, Source};
use std::cell::RefCell;

/// Depth of the deepest forest that is also eliminated by the entries of the mass matrix: the
/// number of operations grows with the square of the depth.
const MAX_DEPTH_OF_MATRIX: usize = 40;
/// Least usual size of a pivot, as a part of the largest: rows that happen to vanish where pivots
/// are measured are taken to be like the others.
const LEAST_USUAL_PIVOT: f64 = 0.01;

/// The programs of a scene in one configuration, with their scratch.
#[derive(Clone, Debug)]
pub(in crate::analysis) struct Recorded {
    /// ẏ, then the strength of the rows: their weakest pivot over its usual size   (n + 1)
    pub(super) rate: Recording,
    /// rows: kept by projection, watched where they are left out
    pub(super) rows: Rows,
    /// switching functions, and the rate with branches held
    pub branches: Branches,
    /// unknowns of loops that are not linear
    pub loops: Option<AlgebraicLoops>,
    /// angles whose turns are counted from step to step
    pub(super) turns: Option<Turns>,
    /// bodies that could pass through each other
    pub thickness: ThicknessBounds,
    /// derivatives of the rates
    pub(super) derivatives: Derivatives,
    /// values of the past, results of closures
    pub external: ExternalInputs,
    /// expressions that are watched
    pub sensors: Sensors,
    /// discrete states
    pub samples: Samples,
    /// narrow peaks of functions
    pub peaks: Peaks,
    /// breaks at times that are fixed beforehand
    pub time_events: TimeEvents,
    /// what acts through time
    pub clocks: Clocks,
    /// rates of the states downstream of the mechanism; `None`: there are none
    pub downstream: Option<Box<DownstreamRates>>,
}

/// The reason why the programs of a scene are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::analysis) enum Purpose {
    /// the scene is to move
    Motion,
    /// its start is looked at, and nothing moves: loads stand in the place of accelerations, which
    /// take most of the time of recording
    Preview,
}

impl Recorded {
    /// Records the programs of a scene, and chooses how accelerations are eliminated: pivots are
    /// measured at the positions `q`, and the shorter rate is kept. The hooks of the scene refer to
    /// `hooks`. Returns what `then` makes of it and of the configuration, while the recorder can
    /// record more of the same instant.
    ///
    /// # Errors
    /// Functions that the equations cannot supply, and what `then` answers.
    pub fn record<T>(
        scene: &Scene,
        mut configuration: Configuration,
        q: &[f64],
        hooks: &[Hook],
        purpose: Purpose,
        look: Look<'_>,
        then: impl FnOnce(Self, Configuration, &Recorder<'_, '_>) -> Result<T, Vec<Diagnostic>>,
    ) -> Result<T, Vec<Diagnostic>> {
        choose_elimination(scene, &mut configuration, q);
        look()?;
        let ways = ways(&configuration);
        let builders = [recorder::builder(), recorder::builder()];
        let (together, recorder) = record_together(scene, &ways, &builders, purpose, look)?;
        look()?;
        configuration.elimination.way = recorder.scene().configuration.elimination.way;
        let here = scene.within(&configuration);
        let switches = (together.branches.switching.as_ref()).map(|s| &s.switches);
        let readers: Vec<&Program> = std::iter::once(&together.rate).chain(switches).collect();
        let turns = Turns::new(here, &readers)?;
        look()?;
        let loops = AlgebraicLoops::new(here).map_err(complaints)?;
        look()?;
        let thickness = ThicknessBounds::new(here, scene.layout.n_y()).map_err(complaints)?;
        look()?;
        let external = ExternalInputs::new(here, hooks).map_err(complaints)?;
        look()?;
        let sensors = Sensors::new(here).map_err(complaints)?;
        let samples = Samples::new(here).map_err(complaints)?;
        look()?;
        let peaks = Peaks::new(here)?;
        look()?;
        let recorded = Self {
            turns,
            rate: Recording::new(together.rate),
            rows: together.rows,
            branches: together.branches,
            time_events: together.time_events,
            clocks: together.clocks,
            downstream: together.downstream,
            loops,
            thickness,
            derivatives: Derivatives::default(),
            external,
            sensors,
            samples,
            peaks,
        };
        then(recorded, configuration, &recorder)
    }

    /// Goes on from what the programs of other rows have seen so far.
    pub fn carry_on(&mut self, mut before: Self) {
        self.external.delays.carry_on(&mut before.external.delays);
        self.sensors.carry_on(&before.sensors);
        self.samples.carry_on(before.samples);
        self.time_events.carry_on(&before.time_events);
    }

    /// Evaluates the rates at a row of numbers, and how strong the rows are: of the branches that
    /// are held, else of those that the numbers say.
    #[inline]
    pub fn run_rate(&mut self, numbers: &[f64]) {
        let branches = &mut self.branches;
        if !branches.is_holding() || !branches.run_held(numbers, &mut self.rate.values) {
            self.rate.run(numbers);
        }
    }

    /// Evaluates the rates as [`run_rate`](Self::run_rate) does, into `ydot`; returns how strong
    /// the rows are, and whether the rates are finite.
    #[inline]
    pub fn rates_at(&mut self, numbers: &[f64], ydot: &mut [f64]) -> (f64, bool) {
        let branches = &mut self.branches;
        if branches.is_holding() && branches.is_sliding() {
            self.run_rate(numbers);
            let (rates, strength) = self.rate.values.split_at(ydot.len());
            ydot.copy_from_slice(rates);
            let is_finite = rates.iter().all(|x| x.is_finite());
            return (strength.first().copied().unwrap_or(f64::NAN), is_finite);
        }
        if branches.is_holding()
            && let Some(strength) = branches.held_rates_at(numbers, ydot)
        {
            return (strength, true);
        }
        self.rate.run_finite(numbers, ydot)
    }
}

/// Programs that have the rows of a scene in common, and are recorded together.
struct Together {
    rate: Program,
    rows: Rows,
    branches: Branches,
    time_events: TimeEvents,
    clocks: Clocks,
    downstream: Option<Box<DownstreamRates>>,
}

/// Returns a configuration with each way in which accelerations may be found; the second is not
/// tried where rows are eliminated where loops close.
fn ways(configuration: &Configuration) -> [Configuration; 2] {
    let first = match configuration.elimination.way {
        Way::RowsWhereLoopsClose => Way::RowsWhereLoopsClose,
        Way::ArticulatedBodies | Way::MassMatrix => Way::ArticulatedBodies,
    };
    [first, Way::MassMatrix].map(|way| {
        let mut configuration = configuration.clone();
        configuration.elimination.way = way;
        configuration
    })
}

/// Chooses the way of elimination that takes fewer operations, and records with it what reads rows
/// or the rates; deep forests are not tried the quadratic way, and rows are left where they are to
/// be eliminated.
fn record_together<'s, 'b>(
    scene: &'s Scene,
    [first, second]: &'s [Configuration; 2],
    builders: &'b [RefCell<Builder>; 2],
    purpose: Purpose,
    look: Look<'_>,
) -> Result<(Together, Recorder<'s, 'b>), Vec<Diagnostic>> {
    let rows_where_loops_close = first.elimination.way == Way::RowsWhereLoopsClose;
    let mut recorder = Recorder::new(scene.within(first), &builders[0]);
    look()?;
    let mut rate = match purpose {
        Purpose::Motion => programs::rate(recorder.at()),
        Purpose::Preview => programs::loads(recorder.at()),
    };
    look()?;
    let has_choice = !rows_where_loops_close && purpose == Purpose::Motion;
    if has_choice && scene.depth() <= MAX_DEPTH_OF_MATRIX {
        let other = match scene.loops.is_empty() {
            true => recorder.eliminating(second),
            // unknowns of loops are eliminated anew
            false => Recorder::new(scene.within(second), &builders[1]),
        };
        let matrix = programs::rate(other.at());
        look()?;
        let other_count = other.count_operations(&matrix).map_err(complaints)?;
        if other_count <= recorder.count_operations(&rate).map_err(complaints)? {
            (rate, recorder) = (matrix, other);
        }
    }
    let rate = recorder.program(&rate).map_err(complaints)?;
    look()?;
    let branches = Branches::new(&recorder).map_err(complaints)?;
    look()?;
    let rows = Rows::new(&recorder).map_err(complaints)?;
    look()?;
    let timed = programs::timed(&recorder).map_err(complaints)?;
    let time_events = TimeEvents::new(scene, timed.values, timed.levels);
    let clocks = Clocks::new(&timed.clocks);
    look()?;
    // last, so that the programs of the mechanism are recorded as without it
    let downstream = match scene.layout.n_downstream {
        0 => None,
        _ => Some(Box::new(DownstreamRates::new(&recorder, &branches)?)),
    };
    let together = Together {
        rate,
        branches,
        rows,
        time_events,
        clocks,
        downstream,
    };
    Ok((together, recorder))
}

/// Returns the inertia to lend to freedoms that have none although rows determine their motion
/// (n_v; empty: none).
pub(super) fn lent_inertia(scene: Configured<'_>) -> Vec<f64> {
    if scene.rows.is_empty() || scene.mode == KINEMATIC || scene.mode == STATIC {
        return Vec::new();
    }
    let mut numbers = vec![0.0; scene.layout.len()];
    numbers[scene.layout.q()].copy_from_slice(&scene.initial_q);
    let at = Equations::new(scene, &numbers);
    let rows = at.mass_rows();
    // eliminating the entries of a deep forest takes the cube of its depth
    if scene.depth() > MAX_DEPTH_OF_MATRIX {
        let factor = ArticulatedFactor::new(&scene, at.links());
        if solve::have_inertia(&rows, &factor.inverse()) {
            return Vec::new();
        }
    }
    let free = scene.freedoms.iter().filter(|f| f.v.is_some());
    let turns: Vec<bool> = free.map(|f| f.turn).collect();
    solve::lent_inertia(rows, &turns, scene.length)
}

/// Chooses the order in which rows are eliminated, and measures at the positions `q` against what
/// their pivots are compared.
fn choose_elimination(scene: &Scene, configuration: &mut Configuration, q: &[f64]) {
    let mut elimination = std::mem::take(&mut configuration.elimination);
    elimination.usual_pivots.clear();
    configuration.elimination = elimination.clone();
    let mut numbers = vec![0.0; scene.layout.len()];
    numbers[scene.layout.q()].copy_from_slice(q);
    // contacts on curves are sought there
    let mut there = configuration.clone();
    there.contacts.iter_mut().for_each(|c| c.begun = false);
    cams::track(scene, &mut there, &numbers);
    elimination::choose(scene.within(&there), &numbers, &mut elimination);
    there.elimination = elimination.clone();
    elimination.usual_pivots = usual_pivots(scene.within(&there), &numbers);
    configuration.elimination = elimination;
}

/// Places nearby at which usual pivots are measured.
const PLACES_NEARBY: u32 = 3;
/// Turn of an angle to such a place, at most, rad.
const LARGEST_TURN: f64 = 1.2;
/// Factor of the turns of angles from one to the next: they spread evenly.
const GOLDEN_RATIO: f64 = 0.618_033_988_749_895;
/// Diagonal at such a place over that at the present one, from which on the present one is small.
const MUCH_LARGER: f64 = 10.0;

/// Returns the diagonal of `G M⁻¹ Gᵀ` at a row of numbers, against which pivots are measured; where
/// it is much larger nearby, the value there, as a mechanism may begin beside a position where rows
/// are dependent   (n_active).
fn usual_pivots(scene: Configured<'_>, numbers: &[f64]) -> Vec<f64> {
    if scene.rows.is_empty() {
        return Vec::new();
    }
    let mut diagonal = Equations::new(scene, numbers).pivots();
    let mut elsewhere = vec![0.0_f64; diagonal.len()];
    // contacts on curves are where they have been sought only
    let n_places = if scene.configuration.contacts.is_empty() {
        PLACES_NEARBY
    } else {
        0
    };
    for place in 1..=n_places {
        let there = Equations::new(scene, &turned(&scene, numbers, place)).pivots();
        for (most, d) in elsewhere.iter_mut().zip(there) {
            *most = if d.is_finite() { most.max(d) } else { *most };
        }
    }
    for (d, most) in diagonal.iter_mut().zip(elsewhere) {
        *d = if most > MUCH_LARGER * *d { most } else { *d };
    }
    let largest = diagonal
        .iter()
        .fold(0.0, |m: f64, &d| if d.is_finite() { m.max(d) } else { m });
    diagonal
        .iter()
        .map(|&d| {
            if d > LEAST_USUAL_PIVOT * largest {
                d
            } else {
                LEAST_USUAL_PIVOT * largest
            }
        })
        .collect()
}

/// Returns numbers with all angles turned, each by an amount of its own that the number of the
/// `place` decides.
fn turned(scene: &Scene, numbers: &[f64], place: u32) -> Vec<f64> {
    let mut numbers = numbers.to_vec();
    let q = &mut numbers[scene.layout.q()];
    let coordinates = scene.coordinates.iter().zip(&scene.freedoms);
    let angles = coordinates.filter(|(c, f)| c.angular && !f.in_ball);
    for (k, (c, _)) in angles.enumerate() {
        if let Source::Free { q: at, .. } = c.source {
            let part = (GOLDEN_RATIO * f64::from(place) * (k + 1) as f64).fract();
            q[at] += (2.0 * part - 1.0) * LARGEST_TURN;
        }
    }
    numbers
}
