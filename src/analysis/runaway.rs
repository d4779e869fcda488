//! Motions that run away: a run that grows exponentially takes ever more steps for ever less time,
//! and would not end.
//!
//! ```text
//! M(t)                        largest kinetic energy up to t
//! d₁ = t − t(M/10³)           the time of the last three decades of its growth,
//! d₂ = t(M/10³) − t(M/10⁶)    and that of the three before
//! d₁ ≤ 2 d₂                   it grows exponentially, or faster
//! 2 d₁ ≤ T − t                six more decades would follow
//! n (T − t)/Δt > 10⁶          steps that are left, as many a time as the last n took
//! ```
//!
//! Bodies that fall or are driven grow as a power of time, tᵏ, for which d₁/d₂ = 10^(3/k): 31
//! where a constant torque turns a rotor. A column that has buckled grows no more.
//!
//! A run that comes to its end all the same is judged there, by the quarters of its time, whatever
//! its steps: `session/growth.rs`.

/// Growth of the kinetic energy, as a factor, whose time is compared with that of the one before.
const DECADES: f64 = 1e3;
/// Time of the last decades over that of the ones before, up to which growth is exponential.
const SLOWER: f64 = 2.0;
/// Steps left from which on nobody waits for the end.
const HOPELESS_STEPS: f64 = 1e6;
/// Attempted steps after which the energy is looked at again, and parts of the duration after which
/// it is.
const LOOK: (usize, f64) = (500, 200.0);
/// Growth of the largest energy, as a factor, that is noted.
const NOTED: f64 = 1.1;

/// The growth of the kinetic energy of a run so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Runaway {
    /// times at which the largest kinetic energy had grown, and its value
    highs: Vec<(f64, f64)>,
    /// attempted steps of the method, and time, from which on is looked again
    due: (usize, f64),
}

/// A run that grows without bound and would not end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunsAway {
    /// when it was seen
    pub t: f64,
    /// time in which the kinetic energy last grew a thousand times
    pub within: f64,
    /// steps that are left, if none gets shorter
    pub steps_left: f64,
}

impl Runaway {
    /// Looks for a new method, whose steps are counted from the beginning.
    pub fn begin(&mut self) {
        self.due = (0, f64::NEG_INFINITY);
    }

    /// Looks at the kinetic energy at the end of an accepted step, `t`, after so many attempted
    /// ones, of a run of some duration.
    pub fn see(
        &mut self,
        (attempted, t): (usize, f64),
        duration: f64,
        kinetic: impl FnOnce() -> Option<f64>,
    ) {
        if attempted < self.due.0 && t < self.due.1 {
            return;
        }
        self.due = (attempted + LOOK.0, t + duration / LOOK.1);
        let Some(kinetic) = kinetic() else {
            return;
        };
        let high = self.highs.last().map_or(0.0, |h| h.1);
        if kinetic > NOTED * high {
            self.highs.push((t, kinetic));
        }
    }

    /// Returns the time at which the largest energy was a part of the present one for the last
    /// time; `None`: it never was so small.
    fn last_below(&self, part: f64) -> Option<f64> {
        let now = self.highs.last()?.1;
        let after = self.highs.partition_point(|h| h.1 <= part * now);
        Some(self.highs[after.checked_sub(1)?].0)
    }

    /// Judges a run at `t` that is to end at `end` and took `steps` for the last `advanced`.
    pub fn judge(&self, (t, end): (f64, f64), steps: usize, advanced: f64) -> Option<RunsAway> {
        let steps_left = steps as f64 * (end - t) / advanced;
        if steps_left <= HOPELESS_STEPS {
            return None;
        }
        let small = self.last_below(1.0 / DECADES)?;
        let smaller = self.last_below(1.0 / (DECADES * DECADES))?;
        let (within, before) = (t - small, small - smaller);
        let exponential = within <= SLOWER * before;
        (exponential && 2.0 * within <= end - t).then_some(RunsAway {
            t,
            within,
            steps_left,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grown(energy: impl Fn(f64) -> f64) -> Runaway {
        let mut highs: Vec<(f64, f64)> = Vec::new();
        for k in 0..=1000 {
            let t = 0.001 * f64::from(k);
            if energy(t) > NOTED * highs.last().map_or(0.0, |h| h.1) {
                highs.push((t, energy(t)));
            }
        }
        Runaway {
            highs,
            ..Runaway::default()
        }
    }

    /// A long run of short steps.
    fn judged(run: &Runaway) -> Option<RunsAway> {
        run.judge((1.0, 100.0), 20_000, 1e-3)
    }

    #[test]
    fn exponential_growth_is_told_from_powers_of_time() {
        let found = judged(&grown(|t| 1e-6 * (40.0 * t).exp())).expect("exponential");
        assert!((found.within - 3.0 * 10.0_f64.ln() / 40.0).abs() < 0.005);
        assert!((found.steps_left - 99.0 * 2e7).abs() < 1.0);
        for power in [1, 2, 4, 8] {
            assert_eq!(judged(&grown(|t| t.powi(power))), None, "t^{power}");
            // one that begins late
            let late = |t: f64| (t - 0.5).max(0.0).powi(power);
            assert_eq!(judged(&grown(late)), None, "(t - 0.5)^{power}");
        }
    }

    #[test]
    fn growth_that_has_ended_or_whose_run_soon_ends_goes_on() {
        let buckled = |t: f64| 1e-9 * (80.0 * t.min(0.3)).exp();
        assert_eq!(judged(&grown(buckled)), None);
        let run = grown(|t| (40.0 * t).exp());
        assert_eq!(run.judge((1.0, 1.1), 20_000, 1e-9), None);
        assert_eq!(run.judge((1.0, 100.0), 20_000, 10.0), None);
    }
}
