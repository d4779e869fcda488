//! A simulation over time: from its settings to its results and its place in the record.

use super::apart::Mechanisms;
use super::companion::Integrated;
use super::growth::{Growth, Looks};
use super::measured::{Measured, Sampled};
use super::outcome::counts;
use super::phase::Phase;
use super::rows::{Follower, Seen};
use super::simulate::Span;
use super::stop_reason::StopReason;
use super::{Analysis, Session};
use crate::analysis::system::System;
use crate::analysis::time::continuation::Continuation;
use crate::analysis::time::options::{self, Options};
use crate::analysis::time::{dynamics, kinematics};
use crate::analysis::trajectory::{Ended, SETS_STEPS, TOLD_ENERGY, Takeover, Trajectory};
use crate::analysis::warning::RunWarning;
use crate::analysis::watch::Watch;
use crate::diagnostic::{Diagnostic, counted};
use crate::expr::program::Program;
use crate::model::ElementKind;
use crate::numeric::{Ode, noise};
use crate::results::{self, Event, Kind, Status};
use crate::scene::layout::Layout;

impl Session {
    /// Runs a kinematic or dynamic simulation and adds its rows to the run.
    ///
    /// # Errors
    /// Motions that the equations cannot supply.
    pub(super) fn over_time(
        &mut self,
        system: &mut System,
        analysis: Analysis,
        span: Span,
        program: &Program,
        watch: &mut dyn Watch,
    ) -> Result<Status, Vec<Diagnostic>> {
        let kind = match analysis {
            Analysis::Kinematic => Kind::Kinematic,
            _ => Kind::Dynamic,
        };
        // the integration
        let settings = self.integration_of(system, kind, span);
        self.log_begin(kind, &settings);
        let first = system.numbers.clone();
        let settles = self.settles(system);
        let chosen = system.configuration.active.clone();
        let mut seen = self.begin_rows(kind, program, (system, span.end));
        let outputs = span.output.times(span.start, span.end);
        let start = self.measures(kind).then(|| system.clone());
        let before = self.beside_now();
        seen.sampled = (start.is_some()).then(|| Sampled::of(&self.run, &outputs));
        let asked = (kind, span, &outputs[..]);
        let (mut trajectory, [seconds, processor]) =
            self.timed(system, asked, &settings, (&mut seen, watch))?;
        // its results
        let phase = Phase::begin();
        let until = trajectory.t.len();
        self.see(&mut seen, system, &mut trajectory, until);
        self.run.log.push(Event::End);
        self.rank_changes(system, chosen, &trajectory);
        let mut typical = vec![0.0; system.scene.layout.n_y()];
        Ode::typical(system, &mut typical);
        let stopped = self.stop_reason(system, &trajectory, span.end);
        self.look_back(
            system,
            (&seen, &typical),
            (&trajectory, settings.error),
            stopped.as_ref(),
        );
        if settings.is_auto() && kind == Kind::Dynamic {
            self.stiffness.see(&trajectory, span.end - span.start);
        }
        self.last = Integrated::of(kind, &trajectory, (settings.error, system.scene.span), span);
        // what the next simulation begins with
        let last = trajectory.rows.last().cloned().unwrap_or(first);
        self.keep(system, last);
        self.keep_left(trajectory.left.take(), &system.scene);
        phase.end(&mut self.run.record.seconds, |s| &mut s.evaluate);
        // how far off they are
        let mut off = None;
        if let (Some(start), Some(sampled)) = (start, &seen.sampled)
            && !settles
            && (system.scene.layout.n_x > 0 || !seen.ranges.rest(&typical))
        {
            let measured = Measured {
                kind,
                span,
                program,
                settings: &settings,
                sampled,
                trajectory: &trajectory,
                before: before.as_ref(),
            };
            off = self.measure(&start, &measured, watch);
        }
        let phase = Phase::begin();
        self.warn_of_rounding((system, &seen.looks), &trajectory, (settings.error, off));
        self.warn_of_splines(seen.readings);
        self.warn_of_tilts(seen.tilts);
        phase.end(&mut self.run.record.seconds, |s| &mut s.evaluate);
        self.run.record.error = Some(settings.error);
        let simulation = results::Simulation {
            solve_seconds: seconds,
            solve_processor_seconds: processor,
            ..recorded(kind, span.start, &trajectory)
        };
        Ok(self.close(simulation, stopped))
    }

    /// Notes and warns of everything that the steps of a simulation have shown; `typical`:
    /// magnitudes of the unknowns.
    fn look_back(
        &mut self,
        system: &System,
        (seen, typical): (&Seen, &[f64]),
        (trajectory, error): (&Trajectory, f64),
        stopped: Option<&StopReason>,
    ) {
        self.warn_of_gaps();
        self.note_sensors(system, trajectory);
        self.note_downstream(system, trajectory);
        self.note_drift(system, &seen.balance);
        if stopped.is_some_and(StopReason::is_lock) {
            self.warn_of_locks();
        }
        self.account(&trajectory.energy, !seen.ranges.stand(typical));
        if !matches!(stopped, Some(StopReason::RunsAway { .. })) {
            let stops = matches!(stopped, Some(StopReason::Method { .. }));
            self.warn_of_growth(seen.looks.growth(system, stops));
        }
        if seen.ranges.exceed(error) {
            self.warn_of_energy(trajectory);
        }
        self.warn_of_stability(trajectory);
    }

    /// Chooses the method, and prepares the system for it.
    fn integration_of(&mut self, system: &mut System, kind: Kind, span: Span) -> Options {
        let mut settings = self.integration();
        settings.may_part = kind == Kind::Dynamic && self.may_part(system);
        settings.left = self.left_before(&system.scene);
        if let (Kind::Kinematic, Some(longest)) = (kind, self.kinematic_hmax()) {
            settings.h_max = self.pace.longest_step(longest);
        }
        if settings.is_auto() && kind == Kind::Dynamic {
            settings.goes_on_stiff = self.stiffness.goes_on();
            settings.first = match settings.goes_on_stiff {
                true => "RADAU5",
                false => options::first_method(system, span.end - self.stiffness.since(span.start)),
            }
            .into();
        }
        settings
    }

    fn log_begin(&mut self, kind: Kind, settings: &Options) {
        let asked = &self.model.integrator;
        let integrator = asked.method.clone();
        let begin = Event::Begin {
            kind,
            integrator: integrator.unwrap_or_else(|| settings.method.clone()),
            formulation: asked.formulation.clone().unwrap_or_default(),
            error: settings.error,
        };
        self.run.log.push(begin);
    }

    /// Integrates as often as the options say; the last trajectory, the median of the times that
    /// passed, and the mean of the processor times, in s.
    /// Rows become results meanwhile where somebody receives them.
    ///
    /// # Errors
    /// Motions that the equations cannot supply.
    fn timed(
        &mut self,
        system: &mut System,
        (kind, span, outputs): (Kind, Span, &[f64]),
        settings: &Options,
        (seen, watch): (&mut Seen, &mut dyn Watch),
    ) -> Result<(Trajectory, [f64; 2]), Vec<Diagnostic>> {
        let first = system.numbers.clone();
        let chosen = system.configuration.active.clone();
        let phase = Phase::begin();
        if !self.pace.columns_alone {
            system.prepare_energy();
        }
        phase.end(&mut self.run.record.seconds, |s| &mut s.record);
        let follows = kind == Kind::Kinematic && !is_integrated(system);
        let mut path = match follows {
            true => Some(Continuation::new(system)?),
            false => None,
        };
        let mut seconds = Vec::new();
        let repeat = self.options.repeat.max(1);
        let mut processor = 0.0;
        let mut trajectory = Trajectory::default();
        for k in 1..=repeat {
            if !trajectory.selections.is_empty() {
                if system.reselect(chosen.clone()).is_err() {
                    break;
                }
                path.iter_mut().for_each(|path| path.see_rows(system));
            }
            system.numbers.copy_from_slice(&first);
            let phase = Phase::begin();
            let taken;
            (trajectory, taken) = self.integrated(
                (system, path.as_mut()),
                (span.start, outputs),
                settings,
                (seen, watch, k == repeat),
            );
            let (own, translation) = phase.elapsed();
            let solving = own - taken - seen.seconds;
            processor += phase.processor_seconds(solving);
            seconds.push(solving);
            self.run.record.seconds.translate += translation;
            self.run.record.seconds.evaluate += seen.seconds;
        }
        let mean = processor / seconds.len() as f64;
        seconds.sort_by(f64::total_cmp);
        let median = seconds[seconds.len() / 2];
        Ok((trajectory, [median, mean]))
    }

    /// Integrates through some outputs, or follows a path of positions; returns the trajectory, and
    /// the time that it took to take mechanisms apart, without that of translation, in s.
    /// `is_kept`: its rows are the results.
    pub(super) fn integrated(
        &mut self,
        (system, path): (&mut System, Option<&mut Continuation>),
        (begun, outputs): (f64, &[f64]),
        settings: &Options,
        (seen, watch, is_kept): (&mut Seen, &mut dyn Watch, bool),
    ) -> (Trajectory, f64) {
        let mut follower = Follower::new(self, seen, watch, is_kept);
        let mut trajectory = match path {
            Some(path) => kinematics::trace(system, path, outputs, settings, &mut follower),
            None => dynamics::integrate(system, outputs, settings, &mut follower),
        };
        let taken = match trajectory.parted.take() {
            Some(numbers) => self.go_on_apart(
                (system, numbers),
                (begun, outputs),
                settings,
                (seen, is_kept),
                watch,
                &mut trajectory,
            ),
            None => 0.0,
        };
        (trajectory, taken)
    }

    /// Lets mechanisms that nothing couples go on each by itself to the end, as far as that pays;
    /// returns the time that it took to take them apart, without that of translation, in s.
    fn go_on_apart(
        &mut self,
        (system, numbers): (&mut System, Vec<f64>),
        (begun, outputs): (f64, &[f64]),
        settings: &Options,
        (seen, is_kept): (&mut Seen, bool),
        watch: &mut dyn Watch,
        trajectory: &mut Trajectory,
    ) -> f64 {
        let phase = Phase::begin();
        let outputs = &outputs[trajectory.t.len()..];
        let t = numbers[Layout::TIME];
        let left = outputs.last().map_or(0.0, |end| end - t);
        let mechanisms = self.take_apart(system, (&numbers, left), watch);
        system.numbers.copy_from_slice(&numbers);
        let (taken, _) = phase.elapsed();
        self.run.record.seconds.record += taken;
        let n = mechanisms.as_ref().map_or(0, Mechanisms::len);
        let threads = match self.options.threads {
            // asking costs a small run a hundredth, so it is not done before
            Some(0) => std::thread::available_parallelism().map_or(1, usize::from),
            asked => asked.unwrap_or(1),
        };
        let together = Options {
            may_part: false,
            left: None,
            ..settings.clone()
        };
        let mut follower = Follower::new(self, seen, watch, is_kept);
        let again = mechanisms.map_or(Some(t), |mechanisms| {
            let most = (threads, together.max_steps);
            mechanisms.integrate(system, (begun, outputs), most, &mut follower, trajectory)
        });
        if let Some(t) = again {
            let rest = &outputs[outputs.partition_point(|output| *output <= t)..];
            dynamics::go_on(system, rest, &together, &mut follower, trajectory);
        }
        if n > 0 && is_kept {
            let until = again.map_or(String::new(), |t| format!(" to {t}, then together again"));
            self.run.log.push(Event::Info(format!(
                "{n} mechanisms that nothing couples have steps of their own from time {t} on{until}"
            )));
        }
        taken
    }

    /// Notes in the log which sensors were triggered, and whether one ended the run.
    fn note_sensors(&mut self, system: &System, trajectory: &Trajectory) {
        for &(t, k) in &trajectory.triggered {
            let sensor = &system.scene.sensors[k];
            let sensor = ElementKind::Sensor.id(sensor.id);
            let message = format!("{sensor} is triggered at time {t}");
            self.run.log.push(Event::Info(message));
        }
        if let Some(Ended::Sensor(k)) = trajectory.ended {
            self.halted |= system.scene.sensors[k].halt;
        }
    }

    /// Notes in the log what the states downstream of the mechanism took.
    fn note_downstream(&mut self, system: &System, trajectory: &Trajectory) {
        if let Some((method, steps)) = trajectory.downstream {
            let n = system.scene.layout.n_downstream;
            let message = format!(
                "states that the mechanism does not read, integrated beside it: {n}, by {} of {method}",
                counted(steps, "step")
            );
            self.run.log.push(Event::Info(message));
        }
    }

    /// Warns where a smaller error was asked for than rounding permits; `off`: how far off the run
    /// is, over the size of what it shows, if that has been measured.
    fn warn_of_rounding(
        &mut self,
        (system, looks): (&System, &Looks),
        trajectory: &Trajectory,
        (error, off): (f64, Option<f64>),
    ) {
        let (below, steps) = (trajectory.stats.below_rounding, trajectory.stats.steps);
        let sets_error = below as f64 > SETS_STEPS * steps as f64;
        if sets_error && off.is_none_or(|off| off > error) {
            self.warn(RunWarning::BelowRounding {
                error,
                below,
                steps,
            });
            return;
        }
        if error > FINE_REQUEST || steps < FEWEST_STEPS || trajectory.stats.evaluations == 0 {
            return;
        }
        let y = system.scene.layout.y();
        let rows = looks.rows().iter();
        let states: Vec<(f64, &[f64])> = rows.map(|r| (r[Layout::TIME], &r[y.clone()])).collect();
        // what it evaluates leaves nothing behind
        let reached = noise::along(&mut system.clone(), &states, (error, steps));
        if let Some(reached) = reached.filter(|reached| *reached > error) {
            self.warn(RunWarning::RoundingAddsUp { error, reached });
        }
    }

    /// Warns where the motion grows without bound.
    fn warn_of_growth(&mut self, growth: Option<Growth>) {
        if let Some(Growth {
            factor,
            within,
            fed_by,
        }) = growth
        {
            self.warn(RunWarning::EnergyGrows {
                factor,
                within,
                fed_by,
            });
        }
    }

    /// Warns where the balance of energy does not close.
    fn warn_of_energy(&mut self, trajectory: &Trajectory) {
        let flow = &trajectory.energy;
        if flow.imbalance > TOLD_ENERGY * flow.scale {
            let share = flow.imbalance / flow.scale;
            self.warn(RunWarning::EnergyUnsure { share });
        }
    }

    /// Returns whether a system that begins is at rest in an equilibrium of statics, and nothing
    /// drives it with time: what moves is what the permitted imbalance has left.
    fn settles(&self, system: &System) -> bool {
        let still = system.numbers[system.scene.layout.v()]
            .iter()
            .all(|v| *v == 0.0);
        self.is_at_rest() && still && !system.reads_time()
    }

    /// Warns where stability, not the error asked for, set the steps of an explicit method.
    fn warn_of_stability(&mut self, trajectory: &Trajectory) {
        let (limited, steps) = (trajectory.stats.stability_limited, trajectory.stats.steps);
        if limited >= TOLD_STEPS && limited as f64 > SETS_STEPS * steps as f64 {
            self.warn(RunWarning::StabilityLimited { limited, steps });
        }
    }
}

/// Request from which on rounding may add up to more within any number of steps.
const FINE_REQUEST: f64 = 1e-7;
/// Fewest steps whose roundings add up.
const FEWEST_STEPS: usize = 100;
/// The least number of steps held short by stability that is told.
const TOLD_STEPS: usize = 200;

/// Returns the place of a simulation in the record, but for its times.
fn recorded(kind: Kind, start: f64, trajectory: &Trajectory) -> results::Simulation {
    results::Simulation {
        end: trajectory.t.last().copied().unwrap_or(start),
        outputs: trajectory.t.len(),
        method: methods(trajectory),
        counts: counts(&trajectory.stats, trajectory.limited),
        ..results::Simulation::new(kind, start)
    }
}

/// Returns whether a mechanism without freedom has states or a past all the same: these go on by
/// integration, which keeps positions on the rows as well.
fn is_integrated(system: &System) -> bool {
    let l = system.scene.layout;
    l.n_x > 0 || !system.recorded.external.delays.is_empty() || !system.recorded.samples.is_empty()
}

/// Writes the methods that worked, the first change of method with its reason, and how often they
/// changed after it: "DOP853, then RADAU5 from 0.3, where steps were limited by stiffness, then 16
/// more changes until 2.7".
fn methods(trajectory: &Trajectory) -> String {
    let Some(((_, first, _), changes)) = trajectory.methods.split_first() else {
        return String::new();
    };
    let mut text = first.clone();
    if let Some((t, name, why)) = changes.first() {
        let why = match why {
            Takeover::Begins => "",
            Takeover::Stiff => ", where steps were limited by stiffness",
            Takeover::Eased => ", where branches changed",
            Takeover::Cheaper => ", as its steps cost less",
        };
        text += &format!(", then {name} from {t}{why}");
    }
    match changes {
        [] | [_] => {}
        [_, (t, name, _)] => text += &format!(", then {name} from {t}"),
        [_, more @ .., (t, _, _)] => {
            text += &format!(", then {} more changes until {t}", more.len() + 1);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_are_told_with_the_first_change_and_the_number_of_others() {
        let told = |n: usize| {
            let mut trajectory = Trajectory::default();
            let all = [
                (0.0, "DOP853", Takeover::Begins),
                (0.3, "RADAU5", Takeover::Stiff),
                (0.5, "DOP853", Takeover::Eased),
                (0.7, "RADAU5", Takeover::Stiff),
                (0.9, "DOP853", Takeover::Eased),
            ];
            for (t, name, why) in all.into_iter().take(n) {
                trajectory.begin_method(t, name, why);
            }
            methods(&trajectory)
        };
        let changed = "DOP853, then RADAU5 from 0.3, where steps were limited by stiffness";
        assert_eq!(told(0), "");
        assert_eq!(told(1), "DOP853");
        assert_eq!(told(2), changed);
        assert_eq!(told(3), format!("{changed}, then DOP853 from 0.5"));
        assert_eq!(told(5), format!("{changed}, then 3 more changes until 0.9"));
    }
}
