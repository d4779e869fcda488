//! A simulation at rest: one equilibrium, or one at each output time.

use super::outcome::counts;
use super::phase::Phase;
use super::simulate::Span;
use super::stop_reason::StopReason;
use super::tilts::Tilts;
use super::{LINEAR, Session};
use crate::analysis::linear::{Growth, growth};
use crate::analysis::statics::{self, Equilibrium, NoEquilibrium, Settings};
use crate::analysis::system::System;
use crate::analysis::trajectory::Limited;
use crate::analysis::warning::RunWarning;
use crate::analysis::watch::Watch;
use crate::expr::program::Program;
use crate::model::{ElementKind, Formula, Level, Motion};
use crate::numeric::Stats;
use crate::results::{self, Event, Kind, Status};
use crate::scene::broken::broken;
use crate::scene::layout::Layout;

/// Way of the drives between equilibria, rad, where turns are counted from one to the next.
const TURN_BETWEEN_EQUILIBRIA: f64 = 1.0;
/// Most equilibria between two outputs.
const MAX_EQUILIBRIA_BETWEEN: f64 = 1e4;
/// Most unknowns of small motions whose eigenvalues are looked for: of a single equilibrium, which
/// takes a second, and of each one in a row, which takes some ten milliseconds.
const MAX_JUDGED_ALONE: usize = 240;
/// See above.
const MAX_JUDGED: usize = 60;

/// The equilibria that were found, one after the other.
#[derive(Default)]
struct Equilibria {
    /// how many
    count: usize,
    /// all numbers at the last
    last: Option<Vec<f64>>,
    stats: Stats,
    /// the method, and the stability of the last one
    method: String,
    /// whether it has been told that a push grows
    grew: bool,
    /// why the search ended before the last time
    failed: Option<StopReason>,
}

impl Session {
    /// Finds an equilibrium now, or one at each output time up to an end that is still to come.
    pub(super) fn at_rest(
        &mut self,
        system: &mut System,
        span: Span,
        program: &Program,
        watch: &mut dyn Watch,
    ) -> Status {
        let (kind, times) = if span.end > span.start {
            (Kind::QuasiStatic, span.output.times(span.start, span.end))
        } else {
            (Kind::Static, vec![span.start])
        };
        if kind == Kind::QuasiStatic {
            self.warn_of_rates();
        }
        let first = system.numbers.clone();
        // the equilibria
        let phase = Phase::begin();
        self.run.begin(kind);
        let found = self.equilibria(system, &times, program, watch);
        let (seconds, translation) = phase.elapsed();
        let processor = phase.processor_seconds(seconds);
        self.run.record.seconds.translate += translation;
        self.warn_of_gaps();
        let stopped = found.failed;
        // what the next simulation begins with
        let last = found.last.unwrap_or(first);
        let end = last[Layout::TIME];
        self.keep(system, last);
        if let Some(carried) = &mut self.carried {
            carried.at_rest = true;
        }
        // the record
        let simulation = results::Simulation {
            end,
            outputs: found.count,
            method: found.method,
            solve_seconds: seconds,
            solve_processor_seconds: processor,
            counts: counts(&found.stats, Limited::default()),
            ..results::Simulation::new(kind, span.start)
        };
        self.close(simulation, stopped)
    }

    /// Settles the system at each time, as long as there is an equilibrium, and adds it to the
    /// results.
    fn equilibria(
        &mut self,
        system: &mut System,
        times: &[f64],
        program: &Program,
        watch: &mut dyn Watch,
    ) -> Equilibria {
        let mut settings = Settings::of(&self.model.equilibrium);
        let tolerances = [&mut settings.error, &mut settings.imbalance];
        tolerances
            .into_iter()
            .flatten()
            .for_each(|x| *x *= self.pace.rest);
        settings.pace = self.pace.steps;
        let mut all = Equilibria {
            method: "EQUILIBRIUM".into(),
            ..Equilibria::default()
        };
        let mut tilts = Tilts::of(system);
        let begin = system.numbers.clone();
        let parts = self.may_part(system).then_some(&*system);
        let mut parts = parts.and_then(|whole| self.take_apart(whole, (&begin, 0.0), watch));
        for &t in times {
            let stats = &mut all.stats;
            let mut settle = |system: &mut System| settle_at(system, &settings, t, watch, stats);
            let found = match &mut parts {
                Some(parts) => parts.settle(system, settle),
                None => settle(system),
            };
            let found = match found {
                Ok(found) => found,
                Err(why) => {
                    all.failed = Some(match why {
                        NoEquilibrium::Interrupted => self.ended_at_rest(t, &all.stats),
                        NoEquilibrium::Unbalanced(imbalance) => {
                            StopReason::NoEquilibrium { at: t, imbalance }
                        }
                    });
                    break;
                }
            };
            let here = system.scene.within(&system.configuration);
            if let Some(broken) = broken(here, &system.numbers, None) {
                all.failed = Some(StopReason::Contact { at: t, broken });
                break;
            }
            self.run.log.push(Event::Static {
                time: t,
                iterations: found.iterations as u32,
                imbalance: found.imbalance,
            });
            let most = if times.len() > 1 {
                MAX_JUDGED
            } else {
                MAX_JUDGED_ALONE
            };
            let judged = self.judged(system, &found, most, watch);
            let stability = self.told_of_stability(t, &found, judged, &mut all.grew);
            all.method = format!("EQUILIBRIUM, {stability}");
            let row = std::slice::from_ref(&system.numbers);
            self.more_rows(program, row);
            self.remember((system, &system.configuration.active), row, |_| None);
            tilts.see(row);
            all.count += 1;
            all.last = Some(system.numbers.clone());
        }
        self.warn_of_tilts(tilts);
        all
    }
}

impl Session {
    /// Tells of motions that give rates which are not zero.
    fn warn_of_rates(&mut self) {
        let motions = self.model.active(ElementKind::Motion, &self.model.motions);
        let gives_rate = |motion: &Motion| {
            let none = matches!(&motion.function, Formula::Expression { text, .. }
                if text.trim().parse() == Ok(0.0));
            motion.level != Level::Displacement && !none
        };
        let rates = motions.filter(|(_, motion)| gives_rate(motion));
        let rates: Vec<u32> = rates.map(|(n, _)| n).collect();
        for motion in rates {
            self.warn(RunWarning::RateAtRest { motion });
        }
    }

    /// Judges by eigenvalues what becomes of a small push off the equilibrium in which a system is.
    fn judged(
        &mut self,
        system: &System,
        found: &Equilibrium,
        most: usize,
        watch: &mut dyn Watch,
    ) -> Judged {
        let (l, s) = (system.scene.layout, &found.stability);
        let free = s.stable + s.neutral + s.unstable;
        if found.is_passive || free == 0 {
            return Judged::ByStiffness;
        }
        if 2 * free + l.n_x > most {
            return Judged::Unjudged;
        }
        // as the model is about to move, which MODE, friction and what is held in statics change
        let (before, seconds) = (self.carried.take(), self.run.record.seconds);
        self.keep(system, system.numbers.clone());
        if let Some(carried) = &mut self.carried {
            carried.at_rest = true;
        }
        let moving = self.prepare(LINEAR, &[], watch);
        self.carried = before;
        self.run.record.seconds = seconds;
        match moving.ok().and_then(|(mut moving, _)| growth(&mut moving)) {
            None => Judged::Unjudged,
            Some(None) => Judged::Decays,
            Some(Some(growth)) => Judged::Grows(growth),
        }
    }

    /// Warns of what becomes of a push off an equilibrium, growth once; returns it in words.
    fn told_of_stability(
        &mut self,
        t: f64,
        found: &Equilibrium,
        judged: Judged,
        grew: &mut bool,
    ) -> String {
        let (at, directions) = (t, found.stability.unstable);
        let words = found.stability.words();
        match judged {
            Judged::Decays if directions > 0 => return "stable by forces of velocity".into(),
            _ if directions > 0 => self.warn(RunWarning::Unstable { at, directions }),
            Judged::ByStiffness | Judged::Decays => {}
            Judged::Unjudged => return format!("{}, growth not judged", in_stiffness(&words)),
            Judged::Grows(growth) => {
                if !std::mem::replace(grew, true) {
                    self.warn(RunWarning::PushGrows {
                        at,
                        growth: [growth.rate, growth.frequency],
                        unit: self.run.units.time.clone(),
                    });
                }
                return format!("{}, but a push grows", in_stiffness(&words));
            }
        }
        words
    }
}

/// Says of words on stability that they are those of stiffness alone.
fn in_stiffness(words: &str) -> String {
    words.replacen("stable", "stable in stiffness", 1)
}

/// The fate of a small push off an equilibrium.
enum Judged {
    /// as stiffness says
    ByStiffness,
    /// it does not grow
    Decays,
    Grows(Growth),
    /// the model is too large, or has no eigenvalues there
    Unjudged,
}

/// Finds the equilibrium at a time. Where turns are counted from one to the next, drives come there
/// by so small ways that none is lost.
///
/// # Errors
/// There is none near.
fn settle_at(
    system: &mut System,
    settings: &Settings,
    t: f64,
    watch: &mut dyn Watch,
    stats: &mut Stats,
) -> Result<Equilibrium, NoEquilibrium> {
    let mut rest = |system: &mut System, t: f64| {
        let y = system.numbers[system.scene.layout.y()].to_vec();
        let numbers = system.row(t, &y);
        system.numbers.copy_from_slice(&numbers);
        statics::settle(system, settings, watch, stats)
    };
    let start = system.numbers[Layout::TIME];
    if system.counts_turns() && t > start {
        let way = system.turn_of_drives(t) / TURN_BETWEEN_EQUILIBRIA;
        let ways = way.min(MAX_EQUILIBRIA_BETWEEN).ceil() as usize;
        for k in 1..ways {
            let kept = system.numbers.clone();
            match rest(system, start + (t - start) * k as f64 / ways as f64) {
                Ok(_) => {}
                Err(NoEquilibrium::Interrupted) => return Err(NoEquilibrium::Interrupted),
                // nobody has asked for this one
                Err(NoEquilibrium::Unbalanced(_)) => system.numbers.copy_from_slice(&kept),
            }
        }
    }
    rest(system, t)
}
