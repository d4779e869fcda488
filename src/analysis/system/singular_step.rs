//! Singular steps: steps over an instant where rows are dependent, placed so that no evaluation is
//! near it.
//!
//! There the rates are a quotient of two numbers that vanish together. With σ the square root of
//! the weakest pivot, which grows in proportion to the time from that instant, rounding and
//! violations of the rows are magnified by 1/σ. The solution itself passes smoothly, so a step may
//! well span the instant: if it falls into the widest gap between the evaluations of the method,
//! none of them is near.

use crate::arrange::Arrange;

/// The distances of rows from dependence at the evaluations of a step.
#[derive(Clone, Debug, Default)]
pub struct SingularSteps {
    /// time, σ
    seen: Vec<(f64, f64)>,
    /// rows have nearly been dependent since somebody last asked
    weak: bool,
    /// evaluations are made aside, and not taken note of
    paused: bool,
    /// evaluations of the step in work at which rows are on the way to dependence: time, σ
    approach: Vec<(f64, f64)>,
    /// a step may have passed a position where rows are dependent between its evaluations
    passed_between: bool,
}

/// Strength of rows below which they may become dependent before the next evaluation.
pub const APPROACHING_PIVOT: f64 = 0.3;

/// Evaluations remembered, at most.
const MAX_SEEN: usize = 64;
/// Part of half the gap within which the instant is well placed, from the middle to either side.
const WELL_PLACED: f64 = 0.4;
/// Distance of the instant from the beginning of a step that is far enough behind its end, as a
/// part of its length.
const FAR_BEHIND: f64 = 1.2;

impl SingularSteps {
    /// Takes note of an evaluation with weak rows. `strength`: the weakest pivot over its usual
    /// size.
    pub fn see(&mut self, t: f64, strength: f64) {
        if self.paused {
            return;
        }
        self.weak = true;
        if self.seen.len() >= MAX_SEEN {
            self.seen.clear();
        }
        self.seen.push((t, strength.max(0.0).sqrt()));
    }

    /// Stops taking note of evaluations, or goes on doing so.
    pub fn pause(&mut self, paused: bool) {
        self.paused = paused;
    }

    /// Returns whether evaluations are not taken note of.
    pub fn is_paused(&self) -> bool {
        self.paused
    }

    /// Takes note of an evaluation with rows that approach dependence.
    pub fn see_approach(&mut self, t: f64, strength: f64) {
        if self.approach.len() < MAX_SEEN && !self.paused {
            self.approach.push((t, strength.max(0.0).sqrt()));
        }
    }

    /// Returns whether an evaluation had weak rows since [`SingularSteps::take_weak`].
    pub fn is_weak(&self) -> bool {
        self.weak
    }

    /// Returns whether rows have nearly been dependent since [`SingularSteps::take_weak`], at an
    /// evaluation or between two.
    pub fn was_near(&self) -> bool {
        self.weak || self.passed_between
    }

    /// Returns whether an evaluation had weak rows since this was last asked.
    pub fn take_weak(&mut self) -> bool {
        self.passed_between = false;
        std::mem::take(&mut self.weak)
    }

    /// Finds out whether σ, which falls and rises in proportion to time, vanishes between two
    /// evaluations of the step from `t`, and forgets them.
    fn look_between(&mut self, t: f64) {
        let seen = &mut self.approach;
        seen.retain(|s| s.0 >= t);
        seen.arrange_by(|a, b| a.0.total_cmp(&b.0));
        seen.dedup_by(|a, b| a.0 == b.0);
        let vanishes = |from: (f64, f64), at: (f64, f64), until: f64| {
            let slope = (at.1 - from.1) / (at.0 - from.0);
            slope * (until - at.0) + at.1 <= 0.0
        };
        let between = |four: &[(f64, f64)]| {
            vanishes(four[0], four[1], four[2].0) || vanishes(four[3], four[2], four[1].0)
        };
        self.passed_between |= seen.windows(4).any(between);
        seen.clear();
    }

    /// Returns a better length of the step from `t` that was attempted with `h`, if there is one,
    /// and forgets the evaluations after `t`. `gap`: the part of a step without evaluations;
    /// `harmful`: the strength below which an evaluation is too near.
    pub fn place(&mut self, t: f64, h: f64, gap: [f64; 2], harmful: f64) -> Option<f64> {
        if !self.approach.is_empty() {
            self.look_between(t);
        }
        if self.seen.is_empty() {
            return None;
        }
        let mut seen = self.seen.clone();
        self.seen.retain(|s| s.0 == t);
        seen.retain(|s| s.0 >= t && s.0 <= t + h * (1.0 + 1e-9) && s.1.is_finite());
        // where the step begins is no longer a choice
        if !seen.iter().any(|s| s.0 > t && s.1 * s.1 < harmful) {
            return None;
        }
        seen.arrange_by(|a, b| a.0.total_cmp(&b.0));
        seen.dedup_by(|a, b| a.0 - b.0 < 1e-9 * h);
        let (middle, half) = (0.5 * (gap[0] + gap[1]), 0.5 * (gap[1] - gap[0]));
        let part = (instant(&seen)? - t) / h;
        if !(part > 0.0 && part < FAR_BEHIND) || (part - middle).abs() <= WELL_PLACED * half {
            return None;
        }
        // a shorter step with the instant in its gap; or one that ends so far before it that the
        // next, as long, has it there
        let shorter = part / middle;
        let before = part - middle;
        Some(
            h * if part < middle {
                shorter
            } else {
                before.max(0.02)
            },
        )
    }
}

/// Finds the time at which σ vanishes, from values around or before.
fn instant(seen: &[(f64, f64)]) -> Option<f64> {
    if seen.len() < 3 {
        return None;
    }
    let least = (0..seen.len()).min_by(|&a, &b| seen[a].1.total_cmp(&seen[b].1))?;
    // as if it were between two neighbours: the instant and the slope of σ on both sides
    let between = |a: usize| {
        let ((t0, s0), (t1, s1)) = (seen[a], seen[a + 1]);
        ((t0 * s1 + t1 * s0) / (s0 + s1), (s0 + s1) / (t1 - t0))
    };
    let falling = |a: usize| (seen[a].1 - seen[a + 1].1) / (seen[a + 1].0 - seen[a].0);
    let last = seen.len() - 1;
    if least == last {
        // between the last two, or after all of them
        let (time, slope) = between(last - 1);
        let (usual, outside) = (falling(last - 2), falling(last - 1));
        if (slope - usual).abs() < (outside - usual).abs() {
            return Some(time);
        }
        return (outside > 0.0).then(|| seen[last].0 + seen[last].1 / outside);
    }
    if least == 0 {
        // before all of them, or between the first two
        let (time, slope) = between(0);
        let rising = -falling(1);
        let inside = (slope - rising).abs() < (-falling(0) - rising).abs();
        return inside.then_some(time);
    }
    let (earlier, later) = (between(least - 1), between(least));
    let off_earlier = (earlier.1 + falling(least)).abs();
    let off_later = (later.1 - falling(least - 1)).abs();
    Some(if off_earlier < off_later {
        earlier.0
    } else {
        later.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes of DOP853 and the gap between them.
    const NODES: [f64; 11] = [
        0.053, 0.079, 0.118, 0.25, 0.282, 0.308, 0.333, 0.6, 0.651, 0.857, 1.0,
    ];
    const GAP: [f64; 2] = [1.0 / 3.0, 0.6];

    fn attempt(singular_steps: &mut SingularSteps, t: f64, h: f64, at: f64) -> Option<f64> {
        for c in NODES {
            let s = t + c * h - at;
            singular_steps.see(t + c * h, (2.0 * s + 0.3 * s * s).powi(2));
        }
        singular_steps.place(t, h, GAP, f64::INFINITY)
    }

    #[test]
    fn wherever_the_instant_lies_it_comes_to_lie_in_the_gap_after_a_few_trials() {
        for k in 1..120 {
            let at = 3.0 + 0.01 * f64::from(k) * 0.1;
            let (mut t, mut h, mut trials) = (3.0, 0.1, 0);
            let mut singular_steps = SingularSteps::default();
            singular_steps.see(t, (2.0 * (t - at)).powi(2));
            while t < at + 1e-12 {
                if let Some(better) = attempt(&mut singular_steps, t, h, at) {
                    h = better;
                    trials += 1;
                    assert!(trials < 8, "{k}");
                    continue;
                }
                let part = (at - t) / h;
                let well = (0.36..0.58).contains(&part);
                assert!(well || part > 1.1, "{k}: {part}");
                t += h;
                h = 0.1;
                singular_steps.see(t, (2.0 * (t - at)).powi(2));
            }
        }
    }

    #[test]
    fn a_position_between_evaluations_that_are_all_far_from_it_is_noticed() {
        let noticed = |least: f64| {
            let mut singular_steps = SingularSteps::default();
            for c in NODES {
                singular_steps.see_approach(c, (c - 0.48_f64).powi(2) + least * least);
            }
            singular_steps.place(0.0, 1.0, GAP, f64::INFINITY);
            singular_steps.was_near() && !singular_steps.is_weak()
        };
        assert!(noticed(0.0) && noticed(1e-4) && !noticed(0.3));
    }

    #[test]
    fn a_step_whose_evaluations_do_no_harm_stays_as_it_is() {
        let mut singular_steps = SingularSteps::default();
        for c in NODES {
            singular_steps.see(c, (c - 0.64_f64).powi(2));
        }
        // the nearest is 0.011 away
        assert_eq!(singular_steps.place(0.0, 1.0, GAP, 1e-4), None);
        for c in NODES {
            singular_steps.see(c, (c - 0.64_f64).powi(2));
        }
        assert!(singular_steps.place(0.0, 1.0, GAP, 1e-3).is_some());
    }

    #[test]
    fn rows_that_stay_away_from_dependence_leave_steps_alone() {
        let mut singular_steps = SingularSteps::default();
        for c in NODES {
            singular_steps.see(c, 0.01 + 1e-5 * c);
        }
        assert_eq!(singular_steps.place(0.0, 1.0, GAP, f64::INFINITY), None);
    }
}
