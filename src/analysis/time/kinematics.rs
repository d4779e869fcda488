//! Motion of a mechanism without freedom: positions that its drives and rows leave, then
//! velocities; accelerations and reactions follow from the equations when somebody asks.
//!
//! The mechanism goes along its branch in steps of its own ([`Continuation`]), which know nothing
//! of output times; these are found within the steps. So the number of outputs changes nothing but
//! the number of rows. Where the branch ends the mechanism is locked: it cannot be driven further,
//! and the row that stands in the way is named.

use crate::analysis::system::System;
use crate::analysis::time::continuation::Continuation;
use crate::analysis::time::energy::DrivenAccount;
use crate::analysis::time::kinematic_sensors::Followed;
use crate::analysis::time::options::Options;
use crate::analysis::time::output::Output;
use crate::analysis::time::ranks::{self, Judgement};
use crate::analysis::trajectory::{Ended, Takeover, Trajectory};
use crate::analysis::watch::Watch;
use crate::numeric::{Failure, Reason, Stop};
use crate::scene::layout::Layout;

/// Moves through all `outputs` (ascending, after the state's time), along a branch that
/// [`Continuation::new`] has prepared for this system.
pub fn trace(
    system: &mut System,
    path: &mut Continuation,
    outputs: &[f64],
    options: &Options,
    watch: &mut dyn Watch,
) -> Trajectory {
    let t = system.numbers[Layout::TIME];
    let mut out = Trajectory::default();
    let Some(&end) = outputs.last() else {
        return out;
    };
    out.begin_method(t, "KINEMATIC", Takeover::Begins);
    system.begin_sensing();
    if !system.scene.rows.is_empty() {
        out.weak.push(Some(system.numbers.clone()));
    }
    path.begin(system, options.h_max, end);
    let mut followed = Followed::default();
    followed.begin(system, path);
    let mut account = DrivenAccount::default();
    account.begin(system, path, end);
    system.expect_outputs(outputs.len(), true);
    let mut tracer = Tracer {
        started: t,
        followed,
        account,
        max_steps: options.max_steps,
        path,
        system,
        out,
    };
    let mut ahead = outputs.iter().rev().copied().collect();
    tracer.out.ended = tracer.go(&mut ahead, end, watch).err();
    let reached = tracer.out.t.last().copied().unwrap_or(t);
    tracer.out.energy = (tracer.account).end(tracer.system, tracer.path, reached);
    tracer.out
}

/// A mechanism on its way.
struct Tracer<'a> {
    system: &'a mut System,
    started: f64,
    /// turns and sensors
    followed: Followed,
    /// energy and works
    account: DrivenAccount,
    max_steps: usize,
    path: &'a mut Continuation,
    out: Trajectory,
}

impl Tracer<'_> {
    /// Moves through all output times that are ahead, the next one last; sensors may ask for
    /// others up to the `end`.
    fn go(&mut self, ahead: &mut Vec<f64>, end: f64, watch: &mut dyn Watch) -> Result<(), Ended> {
        while let Some(target) = ahead.pop() {
            self.reach(target, watch)?;
            if let Some((from, distance)) = self.followed.every.take() {
                ahead.clear();
                ahead.extend(Output::Every(distance).times(from, end).iter().rev());
            }
        }
        Ok(())
    }

    /// Moves to an output time and puts it out, unless a sensor asks for other outputs on the way.
    fn reach(&mut self, target: f64, watch: &mut dyn Watch) -> Result<(), Ended> {
        let mut landing = f64::INFINITY;
        let y = loop {
            while self.path.now().t < target {
                if watch.interrupted() {
                    return Err(Ended::Interrupted);
                }
                self.advance(landing)?;
                if self.followed.every.is_some() {
                    return Ok(());
                }
                let last = (self.path.now().t, self.path.step());
                self.out.last_step = Some(last);
                watch.progress(last.0, last.1, &self.out.stats);
                let now = self.path.now();
                watch.visit(self.system, now.t, &now.y);
            }
            match self.path.within(self.system, target) {
                Ok(y) => break y,
                // a step ends there
                Err(_) if landing > target && self.path.step_back(self.system, target) => {
                    landing = target;
                }
                Err(failure) => return Err(self.locked(failure, 0.0)),
            }
        };
        self.out.stats.evaluations += 1;
        (self.followed).follow(self.system, self.path, target, &mut self.out)?;
        if self.followed.every.is_some() {
            return Ok(());
        }
        if self.out.ends_before(target) {
            let row = self.system.row_of(target, &y);
            self.out.push(target, row);
            watch.collect(self.system, &mut self.out);
        }
        (self.followed).trigger(self.system, (target, &y), &mut self.out)
    }

    /// Takes one step of the continuation, with the rows that are the better ones at its beginning;
    /// none where a sensor asks for other outputs before it.
    fn advance(&mut self, landing: f64) -> Result<(), Ended> {
        let t = self.path.now().t;
        if self.out.stats.steps + self.out.stats.rejected >= self.max_steps {
            let (reason, h) = (Reason::TooManySteps, self.path.step());
            return Err(Ended::Stop(Stop { reason, t, h }));
        }
        (self.followed).follow(self.system, self.path, t, &mut self.out)?;
        if self.followed.every.is_some() {
            return Ok(());
        }
        if let Some(h) = self.followed.stepsize.take() {
            self.path.propose(h);
        }
        self.account.follow(self.system, self.path, t);
        self.choose_rows();
        if let Err((failure, h)) = (self.path).advance(self.system, landing, &mut self.out.stats) {
            return Err(self.locked(failure, h));
        }
        let now = self.path.now();
        (self.followed).begin_step(self.system, self.path, t);
        (self.account).begin_step(self.system, &self.followed.counting);
        if let Some(beyond) = self.system.worst_loose(now.t, &now.y) {
            self.out.note_beyond(now.t, beyond);
        }
        let most = ranks::states_kept(self.system.scene.layout.n_v);
        if (self.out.weak.len() as f64) < most && !self.system.scene.rows.is_empty() {
            let numbers = self.system.numbers_at(now.t, &now.y);
            self.out.weak.push(Some(numbers));
        }
        Ok(())
    }

    /// Chooses other rows where they are better.
    fn choose_rows(&mut self) {
        let system = &mut *self.system;
        if !system.watches_rows() {
            return;
        }
        let now = self.path.now();
        let numbers = system.numbers_at(now.t, &now.y);
        if let Judgement::Better(active) = ranks::better_rows(system.configured(), &numbers) {
            let chosen = (self.out.t.len(), now.t, active.clone());
            system.numbers.copy_from_slice(&numbers);
            if system.reselect(active).is_ok() {
                self.out.selections.push(chosen);
                self.path.see_rows(system);
            }
        }
    }

    /// Ends where the mechanism can be driven no further; the last configuration is kept.
    fn locked(&mut self, failure: Failure, h: f64) -> Ended {
        let now = self.path.now();
        let t = now.t;
        if self.out.ends_before(t) && t > self.started {
            let row = self.system.row(t, &now.y);
            self.out.push(t, row);
        }
        let reason = Reason::Projection(failure);
        Ended::Stop(Stop { reason, t, h })
    }
}
