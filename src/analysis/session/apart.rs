//! Mechanisms that nothing couples, each brought to rest and integrated by itself: an event of one
//! is no event of the others, and each has the steps that it needs.
//!
//! ```text
//! whole      |--|-|-|--|-|        all begin anew at the events of each, until that has cost
//!                        |        what taking them apart does
//! mechanism 1            |-----|--|------|   stretch by stretch, on as many threads as there are
//! mechanism 2            |--|-----|------|
//!                        └ merged ┘          the numbers of the whole at outputs and at looks
//! ```
//!
//! A mechanism is a session of the elements that have to do with each other
//! ([`Model::apart`](crate::model::Model)), which goes on from the state of the whole. Where one
//! meets what speaks of the whole, or stops, the stretch is undone and the whole goes on together:
//! nothing ends otherwise than it would have ended. It does so, too, where the first stretch cost
//! more than before. Steps know nothing of threads, so that there are the same bits on any number
//! of them.

use super::carried::{ByElement, Carried};
use super::{DYNAMIC, Options, Session};
use crate::analysis::statics::{Equilibrium, Imbalance, NoEquilibrium};
use crate::analysis::system::System;
use crate::analysis::time::{dynamics, options, ranks};
use crate::analysis::trajectory::{Ended, EnergyFlow, Trajectory};
use crate::analysis::watch::Watch;
use crate::model::Model;
use crate::scene::Scene;
use crate::scene::history::AngleId;
use crate::scene::layout::{Layout, State};
use crate::scene::unknown::UnknownId;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::thread::Builder;
use std::time::Duration;

/// Stretches of what is left, after each of which there are results: more where outputs have more
/// numbers than that in one of them, 128 MB.
const STRETCHES: u32 = 16;
const MOST_NUMBERS: usize = 1 << 24;
/// Looks at all mechanisms together within a stretch, beside its outputs.
const LOOKS: u32 = 64;
/// Time between two questions whether to stop, while other threads work.
const WAIT: Duration = Duration::from_millis(2);

/// A mechanism, ready to go on.
struct Mechanism {
    system: System,
    settings: options::Options,
    /// its numbers, and where they stand among those of the whole
    places: Vec<[usize; 2]>,
    energy: EnergyFlow,
}

/// Mechanisms that a whole has been taken apart into.
pub(super) struct Mechanisms(Vec<Mechanism>);

/// The hooks of a caller, of whom nothing is wanted but whether to stop.
struct Ends<'a>(&'a mut dyn FnMut() -> bool);
impl Watch for Ends<'_> {
    fn interrupted(&mut self) -> bool {
        (self.0)()
    }
}

impl Session {
    /// Returns whether mechanisms of a system may go on apart, if there are several.
    pub(super) fn may_part(&self, system: &System) -> bool {
        let (scene, l) = (&system.scene, system.scene.layout);
        self.hooks.is_empty()
            && scene.sensors.is_empty()
            && l.n_external == 0
            && l.n_downstream == 0
            // states by themselves may be one, too
            && scene.n_mechanisms() + usize::from(l.n_x > 0) > 1
    }

    /// Takes a system apart at a state, with so much time left; `None`: its mechanisms have to do
    /// with each other after all, or one of them has not the unknowns that it has in the whole.
    pub(super) fn take_apart(
        &self,
        system: &System,
        (numbers, left): (&[f64], f64),
        watch: &mut dyn Watch,
    ) -> Option<Mechanisms> {
        let models = self.model.apart()?;
        let mut session = Session::new(Model::default(), &self.run.name, self.options_of_parts());
        let state = ByElement::new(Carried::of(system, numbers.to_vec()));
        session.folders.clone_from(&self.folders);
        session.shells.clone_from(&self.shells);
        (session.pace, session.records_again) = (self.pace, true);
        let (mode, structures) = (system.scene.mode as u32, session.structures.clone());
        let _looking = structures.look();
        let mut places = Places::of(&system.scene);
        let mut mechanisms = Vec::with_capacity(models.len());
        for model in models {
            session.carried = Some(state.of(&model));
            session.model = model;
            session.is_checked = true;
            let (mut part, _) = session.prepare(mode, &[], watch).ok()?;
            let places = places.take(&part.scene)?;
            let mut settings = session.integration();
            if mode == DYNAMIC && settings.is_auto() {
                settings.first = options::first_method(&mut part, left).into();
            }
            if mode == DYNAMIC && !self.pace.columns_alone {
                part.prepare_energy();
            }
            mechanisms.push(Mechanism {
                system: part,
                settings,
                places,
                energy: EnergyFlow::default(),
            });
        }
        // at rest the whole counts its turns itself
        let is_whole = places.states.is_empty() && (mode != DYNAMIC || places.turns.is_empty());
        (is_whole && mechanisms.len() > 1).then_some(Mechanisms(mechanisms))
    }

    /// Returns what mechanisms that are taken out of the model are asked for.
    fn options_of_parts(&self) -> Options {
        Options {
            error: self.options.error,
            method: self.options.method.clone(),
            skip: self.options.skip.clone(),
            zero_user: self.options.zero_user,
            max_steps: self.options.max_steps,
            named_only: true,
            ..Options::default()
        }
    }
}

/// The places of numbers of the whole that no mechanism has taken so far.
struct Places {
    states: BTreeMap<UnknownId, usize>,
    turns: BTreeMap<AngleId, usize>,
}

impl Places {
    fn of(scene: &Scene) -> Self {
        let (l, angles) = (scene.layout, &scene.counted);
        Self {
            states: unknowns(scene).zip(l.states()).collect(),
            turns: angles.iter().map(|c| c.id).zip(l.turns()).collect(),
        }
    }

    /// Takes the places of the numbers of a mechanism, each behind its own; `None`: it has others
    /// than the whole, or shares some with another.
    fn take(&mut self, scene: &Scene) -> Option<Vec<[usize; 2]>> {
        let l = scene.layout;
        if l.n_downstream > 0 || l.n_external > 0 {
            return None;
        }
        let mut places = vec![[Layout::TIME; 2]];
        for (own, id) in l.states().zip(unknowns(scene)) {
            places.push([own, self.states.remove(&id)?]);
        }
        for (own, angle) in l.turns().zip(&scene.counted) {
            places.push([own, self.turns.remove(&angle.id)?]);
        }
        Some(places)
    }
}

/// Goes through the identities of the states of a scene, in the order of their places.
fn unknowns(scene: &Scene) -> impl Iterator<Item = UnknownId> {
    let State { q, v, x } = &scene.unknowns;
    q.iter().chain(v).chain(x).copied()
}

impl Mechanism {
    /// Integrates to the last of some times; `ends` is asked whether to stop.
    fn advance(&mut self, times: &[f64], ends: &mut dyn FnMut() -> bool) -> Trajectory {
        let mut found =
            dynamics::integrate(&mut self.system, times, &self.settings, &mut Ends(ends));
        if let Some(last) = found.rows.last() {
            self.system.numbers.copy_from_slice(last);
        }
        let weak = std::mem::take(&mut found.weak);
        found.passes = ranks::passes(self.system.configured(), &self.system, &weak);
        self.settings.left = found.left.take();
        if let (true, Some((name, _))) = (self.settings.is_auto(), &self.settings.left) {
            self.settings.first.clone_from(name);
            self.settings.goes_on_stiff = name != "DOP853";
        }
        found
    }
}

fn attempted(found: &Trajectory) -> usize {
    found.stats.steps + found.stats.rejected
}

/// Returns what an integration has cost, in operations over the evaluations in a step.
fn work(system: &System, found: &Trajectory) -> f64 {
    attempted(found) as f64 * system.operations_of_a_step() as f64
}

/// Returns whether a trajectory has nothing that speaks of the whole.
fn is_plain(found: &Trajectory) -> bool {
    found.ended.is_none()
        && found.means.is_empty()
        && found.selections.is_empty()
        && found.restored.is_empty()
        && found.beyond.is_empty()
}

impl Mechanisms {
    /// Returns how many there are.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// Integrates through further outputs, behind what a trajectory has, from where the whole
    /// stands. `None`: that is the end; else all had better go on together from where the whole
    /// stands then. `begun`: when what the trajectory has so far began.
    pub(super) fn integrate(
        mut self,
        system: &mut System,
        (begun, outputs): (f64, &[f64]),
        (threads, max_steps): (usize, usize),
        watch: &mut dyn Watch,
        out: &mut Trajectory,
    ) -> Option<f64> {
        let before = std::mem::take(&mut out.energy);
        let from = system.numbers[Layout::TIME];
        let pace = work(system, out) / (from - begun);
        let mut again = None;
        let size = system.numbers.len();
        for (k, stretch) in stretches(from, outputs, size).into_iter().enumerate() {
            let reached = system.numbers[Layout::TIME];
            let max_steps = max_steps.saturating_sub(attempted(out));
            for mechanism in &mut self.0 {
                mechanism.settings.max_steps = max_steps;
            }
            let times: Vec<f64> = stretch.iter().map(|(t, _)| *t).collect();
            let found = self.advance(&times, threads, watch);
            let interrupted = |t: &Trajectory| t.ended == Some(Ended::Interrupted);
            if found.iter().any(interrupted) {
                out.ended = Some(Ended::Interrupted);
                break;
            }
            let steps: usize = found.iter().map(attempted).sum();
            if steps > max_steps || !found.iter().all(is_plain) {
                again = Some(reached);
                break;
            }
            self.merge((system, &stretch), &found, watch, out);
            let parts = self.0.iter().zip(&found);
            let done: f64 = parts.map(|(part, found)| work(&part.system, found)).sum();
            let now = system.numbers[Layout::TIME];
            if k == 0 && done > pace * (now - reached) {
                again = Some(now);
                break;
            }
        }
        out.energy = before.followed_by(&self.energy());
        again
    }

    /// Brings each to rest, which nothing of the others has a say in, and the whole with them.
    ///
    /// # Errors
    /// The first that is not balanced, of those that nothing carries if there are such.
    pub(super) fn settle(
        &mut self,
        system: &mut System,
        mut settle: impl FnMut(&mut System) -> Result<Equilibrium, NoEquilibrium>,
    ) -> Result<Equilibrium, NoEquilibrium> {
        let mut all: Option<Equilibrium> = None;
        let mut failed: Option<Imbalance> = None;
        for mechanism in &mut self.0 {
            let found = settle(&mut mechanism.system);
            for &[own, whole] in &mechanism.places {
                system.numbers[whole] = mechanism.system.numbers[own];
            }
            match found {
                Ok(found) => all = Some(all.map_or(found, |all| all.beside(&found))),
                Err(NoEquilibrium::Interrupted) => return Err(NoEquilibrium::Interrupted),
                Err(NoEquilibrium::Unbalanced(why)) => {
                    let is_worse = |other: &Imbalance| why.is_uncarried() && !other.is_uncarried();
                    if failed.as_ref().is_none_or(is_worse) {
                        failed = Some(why);
                    }
                }
            }
        }
        let (l, t) = (system.scene.layout, system.numbers[Layout::TIME]);
        let y = system.numbers[l.y()].to_vec();
        system.count_turns(t, &y);
        let row = system.row(t, &y);
        system.numbers.copy_from_slice(&row);
        match (all, failed) {
            (Some(all), None) => Ok(all),
            (_, failed) => Err(NoEquilibrium::Unbalanced(
                failed.unwrap_or(Imbalance::Unknown),
            )),
        }
    }

    /// Integrates all through some times, on some threads.
    fn advance(&mut self, times: &[f64], threads: usize, watch: &mut dyn Watch) -> Vec<Trajectory> {
        let mut found = vec![Trajectory::default(); self.0.len()];
        let threads = threads.min(found.len());
        let stops = AtomicBool::new(false);
        let work = Mutex::new(self.0.iter_mut().zip(&mut found));
        let go = |ends: &mut dyn FnMut() -> bool| {
            loop {
                let next = work.lock().unwrap_or_else(PoisonError::into_inner).next();
                let Some((mechanism, found)) = next else {
                    break;
                };
                *found = mechanism.advance(times, ends);
            }
        };
        std::thread::scope(|scope| {
            let (done, all_done) = mpsc::channel();
            let mut begun = 0;
            for _ in 1..threads {
                let (done, go, stops) = (done.clone(), &go, &stops);
                let work = move || {
                    go(&mut || stops.load(Ordering::Relaxed));
                    // nobody listens where the caller has gone
                    let _ = done.send(());
                };
                begun += usize::from(Builder::new().spawn_scoped(scope, work).is_ok());
            }
            // this thread works, too, and asks the caller
            go(&mut || {
                let stop = stops.load(Ordering::Relaxed) || watch.interrupted();
                stops.store(stop, Ordering::Relaxed);
                stop
            });
            // one that panics says nothing, but goes
            drop(done);
            while begun > 0 {
                match all_done.recv_timeout(WAIT) {
                    Ok(()) => begun -= 1,
                    Err(RecvTimeoutError::Timeout) => {
                        stops.fetch_or(watch.interrupted(), Ordering::Relaxed);
                    }
                    Err(RecvTimeoutError::Disconnected) => break,
                }
            }
        });
        found
    }

    /// Puts what all have found into the whole, and into its results where outputs are.
    fn merge(
        &mut self,
        (system, stretch): (&mut System, &[(f64, bool)]),
        found: &[Trajectory],
        watch: &mut dyn Watch,
        out: &mut Trajectory,
    ) {
        let l = system.scene.layout;
        for (k, &(t, is_output)) in stretch.iter().enumerate() {
            let mut numbers = system.numbers.clone();
            for (mechanism, found) in self.0.iter().zip(found) {
                for &[own, whole] in &mechanism.places {
                    numbers[whole] = found.rows[k][own];
                }
            }
            system.numbers.copy_from_slice(&numbers);
            let row = system.row(t, &numbers[l.y()]);
            watch.visit(system, t, &row[l.y()]);
            if is_output {
                out.push(t, row);
            }
        }
        let mut events = Vec::new();
        for (mechanism, found) in self.0.iter_mut().zip(found) {
            mechanism.energy = mechanism.energy.followed_by(&found.energy);
            out.add_cost(&found.stats);
            out.events += found.events;
            out.limited.events += found.limited.events;
            out.limited.outputs += found.limited.outputs;
            out.passes.extend_from_slice(&found.passes);
            out.last_step = found.last_step.or(out.last_step);
            events.extend_from_slice(&found.event_times);
            for (t, name, why) in &found.methods {
                if !out.methods.iter().any(|m| m.1 == *name) {
                    out.begin_method(*t, name, *why);
                }
            }
        }
        events.sort_by(f64::total_cmp);
        out.event_times.extend(events);
        if let Some((t, h)) = out.last_step {
            watch.progress(t, h, &out.stats);
        }
        watch.collect(system, out);
    }

    /// Returns the account of energy of all, as far as they have come.
    fn energy(&self) -> EnergyFlow {
        let mut all = self.0.iter().map(|mechanism| mechanism.energy);
        let first = all.next().unwrap_or_default();
        all.fold(first, |sum, one| sum.beside(&one))
    }
}

/// Divides what is left into stretches: their times, and which of them are outputs, with so many
/// numbers each. Where stretches end, as steps do, outputs have no say in while they fit.
fn stretches(from: f64, outputs: &[f64], size: usize) -> Vec<Vec<(f64, bool)>> {
    let Some(&end) = outputs.last() else {
        return Vec::new();
    };
    let more = outputs.len().saturating_mul(size) / (STRETCHES as usize * MOST_NUMBERS);
    let n = (STRETCHES * LOOKS).saturating_mul(1 + more.min(1 << 16) as u32);
    let mut outputs = outputs.iter().copied().peekable();
    let mut stretches = vec![Vec::new()];
    for k in 1..n {
        let look = from + (end - from) * f64::from(k) / f64::from(n);
        let mut times = Vec::new();
        while let Some(t) = outputs.next_if(|t| *t < look) {
            times.push((t, true));
        }
        times.push((look, outputs.next_if_eq(&look).is_some()));
        if let Some(last) = stretches.last_mut() {
            last.extend(times);
        }
        if k % LOOKS == 0 {
            stretches.push(Vec::new());
        }
    }
    if let Some(last) = stretches.last_mut() {
        last.extend(outputs.map(|t| (t, true)));
    }
    stretches
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_end_at_the_same_times_whatever_the_outputs_which_all_have_once() {
        let ends = |outputs: &[f64]| -> Vec<f64> {
            let stretches = stretches(0.3, outputs, 100);
            let times: Vec<(f64, bool)> = stretches.concat();
            assert!(times.windows(2).all(|pair| pair[0].0 < pair[1].0));
            let found = times.iter().filter(|time| time.1).map(|time| time.0);
            assert_eq!(found.collect::<Vec<f64>>(), outputs);
            stretches.iter().filter_map(|s| Some(s.last()?.0)).collect()
        };
        let one = ends(&[2.0]);
        assert_eq!((one.len(), one.last()), (STRETCHES as usize, Some(&2.0)));
        for n in [2, 7, 64, 5000] {
            let outputs: Vec<f64> = (1..=n)
                .map(|k| 0.3 + 1.7 * f64::from(k) / f64::from(n))
                .collect();
            assert_eq!(ends(&outputs), one, "{n} outputs");
        }
        assert!(stretches(0.3, &[], 100).is_empty());
    }

    #[test]
    fn many_outputs_of_many_numbers_have_more_stretches() {
        let outputs: Vec<f64> = (1..=10_000).map(f64::from).collect();
        let found = stretches(0.0, &outputs, 100_000);
        let longest = found.iter().map(Vec::len).max().unwrap_or(0);
        assert!(longest * 100_000 < 2 * MOST_NUMBERS, "{longest} times");
        assert_eq!(found.concat().iter().filter(|t| t.1).count(), outputs.len());
    }
}
