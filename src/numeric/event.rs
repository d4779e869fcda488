//! Events: the first sign change of switching functions inside a step.
//!
//! All functions `g(t)` are evaluated together, on the interpolant of an accepted step. Each has a
//! *side*, the sign it had last; an event is the first time at which one of them is on its other
//! side.
//!
//! ```text
//! 1  sample     t0 < s₁ < … < s_m < t1, with the times that the caller names; the event lies in
//!               the first interval at whose end a function has changed sides
//! 2  dips       where |g| has a minimum between samples of one sign, two more points are sampled:
//!               the vertex of the parabola through three samples, and the notch, where the secants
//!               beside an interval meet across zero (a convex function lies above both secants).
//!               So a function is seen that crosses and returns between two samples: a double root,
//!               or a distance that shrinks and grows
//! 3  bracket    at `a` no function has crossed, at `b` one has; the next point is the earliest
//!               secant root of those that have, moved towards the middle as far as needed to keep
//!               the bracket of bisection (method ITP)
//! 4  end        b − a is a few units in the last place; the event is at `b`, after the change
//! ```
//!
//! Since the event is put at `b`, integration restarts with a clear sign, and a function that has
//! just switched does not switch again by rounding. A value of exactly zero is on no side: a
//! function that starts there takes the side to which it leaves, without an event; one that touches
//! zero and goes back has not crossed; one that stays at zero never crosses.
//!
//! Source of ITP: Oliveira & Takahashi, ACM TOMS 47 (2020).

/// Interior samples per step.
pub const SAMPLES: usize = 4;
/// Most samples per step that the caller names.
pub const MOST_NAMED: usize = 16;
/// Most further samples at dips per step, for one function.
const MOST_DIPS: usize = 8;
/// Most further samples at dips per step, for all functions together.
const MOST_DIPS_OF_ALL: usize = 64;

/// The direction of the crossings that count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// both
    #[default]
    Either,
    /// from negative to positive
    Rising,
    /// from positive to negative
    Falling,
}

/// The search for the first event of several switching functions, step after step.
#[derive(Clone, Debug)]
pub struct Locator {
    /// crossings that count   (n)
    direction: Vec<Direction>,
    /// sign last seen; 0 while it has never been clear   (n)
    side: Vec<i8>,
    /// whether leaving zero is a crossing
    zero_counts: bool,
    /// functions that crossed at the last event
    crossed: Vec<usize>,
    /// times of the samples of this step, in order, in s   (SAMPLES + 2 + dips)
    times: Vec<f64>,
    /// values at these times   (as many, each n)
    values: Vec<Vec<f64>>,
    /// values at the beginning of the bracket   (n)
    at_a: Vec<f64>,
    /// values at the end of the bracket   (n)
    at_b: Vec<f64>,
    /// values at the trial point   (n)
    at_x: Vec<f64>,
}

impl Locator {
    /// Creates a locator for `n` functions; all crossings count.
    pub fn new(n: usize) -> Self {
        let room = SAMPLES + 2 + MOST_NAMED + (MOST_DIPS + n).min(MOST_DIPS_OF_ALL);
        Locator {
            direction: vec![Direction::Either; n],
            side: vec![0; n],
            zero_counts: false,
            crossed: Vec::with_capacity(n),
            times: Vec::with_capacity(room),
            values: vec![vec![0.0; n]; room],
            at_a: vec![0.0; n],
            at_b: vec![0.0; n],
            at_x: vec![0.0; n],
        }
    }

    /// Lets only some crossings of function `k` count.
    pub fn set_direction(&mut self, k: usize, direction: Direction) {
        self.direction[k] = direction;
    }

    /// Takes the values at the start, or where integration goes on after an event.
    pub fn begin(&mut self, values: &[f64]) {
        self.values[0].copy_from_slice(values);
        for (side, value) in self.side.iter_mut().zip(values) {
            *side = sign(*value);
        }
    }

    /// Takes the values and the sides at the start: where a value is mere rounding, its side is
    /// more reliable than its sign. From now on a function that is on no side crosses when it
    /// leaves zero.
    pub fn begin_on(&mut self, values: &[f64], sides: &[i8]) {
        self.values[0].copy_from_slice(values);
        self.side.copy_from_slice(sides);
        self.zero_counts = true;
    }

    /// Takes the values at the end of a step that needs no scan.
    pub fn skip(&mut self, values: &[f64]) {
        self.values[0].copy_from_slice(values);
    }

    /// Returns the side of each function: +1, −1, or 0 while it has been exactly zero   (n)
    pub fn sides(&self) -> &[i8] {
        &self.side
    }

    /// Returns the functions that crossed at the last event.
    pub fn crossed(&self) -> &[usize] {
        &self.crossed
    }

    /// Looks for the first event in `(t0, t1]`; `g(t, values)` evaluates all functions at `t`.
    /// Returns the time of the event, in s.
    ///
    /// The values at `t0` are those of [`Locator::begin`], or of the end of the step scanned
    /// before. After an event the next scan begins at it. A value that is not a number is on no
    /// side. `named`: times within the step that are sampled too, ascending, [`MOST_NAMED`] at
    /// most.
    ///
    /// # Errors
    /// Those of `g`.
    pub fn scan<E>(
        &mut self,
        ends: (f64, f64),
        named: &[f64],
        g: impl FnMut(f64, &mut [f64]) -> Result<(), E>,
    ) -> Result<Option<f64>, E> {
        self.first(ends, named, SAMPLES, g)
    }

    /// Looks for it as [`scan`](Self::scan) does, where it is known that no function comes to zero
    /// and goes back between two of the named times.
    ///
    /// # Errors
    /// Those of `g`.
    pub fn scan_named<E>(
        &mut self,
        ends: (f64, f64),
        named: &[f64],
        g: impl FnMut(f64, &mut [f64]) -> Result<(), E>,
    ) -> Result<Option<f64>, E> {
        self.first(ends, named, 0, g)
    }

    fn first<E>(
        &mut self,
        (t0, t1): (f64, f64),
        named: &[f64],
        samples: usize,
        mut g: impl FnMut(f64, &mut [f64]) -> Result<(), E>,
    ) -> Result<Option<f64>, E> {
        self.crossed.clear();
        if self.side.is_empty() {
            return Ok(None);
        }
        // 1: sample up to the first crossing
        self.times.clear();
        self.times.push(t0);
        let mut found = false;
        let regular = |i: usize| t0 + (t1 - t0) * i as f64 / (samples + 1) as f64;
        let inside = named.iter().copied().filter(|&t| t > t0);
        let (mut next, mut named) = (1, inside.peekable());
        for i in 1.. {
            let regular = if next > samples { t1 } else { regular(next) };
            let before = named.next_if(|&t| t < regular);
            let t = before.unwrap_or(regular);
            next += usize::from(t == regular);
            g(t, &mut self.values[i])?;
            self.times.push(t);
            if self.has_crossed(i) {
                found = true;
                break;
            }
            self.adopt_sides(i);
            if t == t1 {
                break;
            }
        }
        // 2: look for dips before that; they may insert samples before the last one
        let dip = match samples {
            0 => None,
            _ => self.find_dip(&mut g)?,
        };
        let last = self.times.len() - 1;
        let Some(i) = dip.or(found.then_some(last)) else {
            self.values.swap(0, last);
            return Ok(None);
        };
        // 3 and 4: close in
        let t = self.close_in(i, &mut g)?;
        for k in 0..self.side.len() {
            if self.counts(k, self.side[k], sign(self.at_b[k])) {
                self.crossed.push(k);
            }
            if sign(self.at_b[k]) != 0 {
                self.side[k] = sign(self.at_b[k]);
            }
        }
        self.values[0].copy_from_slice(&self.at_b);
        Ok(Some(t))
    }

    /// Returns whether a crossing that counts is seen at sample `i`.
    fn has_crossed(&self, i: usize) -> bool {
        self.any_crossed(&self.values[i])
    }

    /// Sets the sides to the signs at sample `i`, except where a value is zero.
    fn adopt_sides(&mut self, i: usize) {
        for (side, value) in self.side.iter_mut().zip(&self.values[i]) {
            if sign(*value) != 0 {
                *side = sign(*value);
            }
        }
    }

    /// Samples the dips where a function may have been across zero between samples; returns the
    /// sample that has crossed, which is inserted in its place.
    fn find_dip<E>(
        &mut self,
        g: &mut impl FnMut(f64, &mut [f64]) -> Result<(), E>,
    ) -> Result<Option<usize>, E> {
        let room = self.values.len();
        let mut i = 1;
        while i < self.times.len() && self.times.len() < room {
            let functions = 0..self.side.len();
            let dip = |k: usize| self.vertex(i, k).or_else(|| self.notch(i, k));
            let dip = functions.clone().find_map(dip);
            let place = |t: f64| self.times.partition_point(|&s| s < t);
            // a time between two samples, which may differ in the last place only
            let Some((t, place)) = dip
                .map(|t| (t, place(t)))
                .filter(|&(t, p)| (1..self.times.len()).contains(&p) && self.times[p] != t)
            else {
                i += 1;
                continue;
            };
            let end = self.times.len();
            g(t, &mut self.values[end])?;
            self.times.insert(place, t);
            self.values[place..=end].rotate_right(1);
            // the sides are those at the beginning of the dip, since nothing has crossed before it
            let (before, here) = (&self.values[place - 1], &self.values[place]);
            let crossed = |k: usize| self.counts(k, sign(before[k]), sign(here[k]));
            if functions.clone().any(crossed) {
                for k in functions {
                    if sign(self.values[place - 1][k]) != 0 {
                        self.side[k] = sign(self.values[place - 1][k]);
                    }
                }
                return Ok(Some(place));
            }
            i = i.saturating_sub(1).max(1);
        }
        Ok(None)
    }

    /// Returns the time at which the secants of function `k` beside the interval from sample i − 1
    /// to i meet, if that is inside it and across zero. At an end of the step the missing secant is
    /// the mirror image of the other one.
    fn notch(&self, i: usize, k: usize) -> Option<f64> {
        let value = |i: usize| self.values[i][k];
        let secant = |i: usize| {
            let h = self.times[i] - self.times[i - 1];
            (value(i) - value(i - 1)) / h
        };
        // a step may end exactly at zero
        let [before, here] = [i - 1, i].map(|i| sign(value(i)));
        let s = if here == 0 { before } else { here };
        if s == 0 || before == -s {
            return None;
        }
        // as if the values were positive: falling before, rising after
        let up = f64::from(s);
        let falling = (i > 1 && sign(value(i - 2)) != -s).then(|| up * secant(i - 1));
        let rising =
            (i + 1 < self.times.len() && sign(value(i + 1)) != -s).then(|| up * secant(i + 1));
        let (falling, rising) = match (falling, rising) {
            (Some(f), Some(r)) => (f, r),
            (Some(f), None) => (f, -f),
            (None, Some(r)) => (-r, r),
            (None, None) => return None,
        };
        if !(falling < 0.0 && rising > 0.0) {
            return None;
        }
        // a + falling x = b − rising (h − x)
        let (a, b, h) = (
            up * value(i - 1),
            up * value(i),
            self.times[i] - self.times[i - 1],
        );
        let x = (a - b + rising * h) / (rising - falling);
        let inside = x > 1e-3 * h && x < 0.999 * h;
        (inside && a + falling * x < 0.0).then(|| self.times[i - 1] + x)
    }

    /// Returns the time of the vertex of the parabola of function `k` through samples i − 1, i, i +
    /// 1 of one sign, if it lies across zero.
    fn vertex(&self, i: usize, k: usize) -> Option<f64> {
        if i + 1 >= self.times.len() {
            return None;
        }
        let [f0, f1, f2] = [
            self.values[i - 1][k],
            self.values[i][k],
            self.values[i + 1][k],
        ];
        let s = sign(f1);
        if s == 0 || sign(f0) != s || sign(f2) != s || f1.abs() > f0.abs() || f1.abs() > f2.abs() {
            return None;
        }
        let (h0, h2) = (
            self.times[i - 1] - self.times[i],
            self.times[i + 1] - self.times[i],
        );
        let (d0, d2) = ((f0 - f1) / h0, (f2 - f1) / h2);
        let bend = (d2 - d0) / (h2 - h0);
        let slope = d0 - bend * h0;
        let x = -0.5 * slope / bend;
        let least = f1 + 0.5 * slope * x;
        let inside = x > h0 && x < h2 && x.abs() > 1e-3 * (h2 - h0);
        // the parabola is an estimate, so a near miss is sampled too
        let across = sign(least) != s || least.abs() < 0.1 * f1.abs();
        (inside && across).then(|| self.times[i] + x)
    }

    /// Shrinks the bracket between samples i − 1 and i onto the first crossing; returns its end, in
    /// s, and leaves the values there in `at_b`.
    fn close_in<E>(
        &mut self,
        i: usize,
        g: &mut impl FnMut(f64, &mut [f64]) -> Result<(), E>,
    ) -> Result<f64, E> {
        let (mut a, mut b) = (self.times[i - 1], self.times[i]);
        self.at_a.copy_from_slice(&self.values[i - 1]);
        self.at_b.copy_from_slice(&self.values[i]);
        let resolution = 4.0 * f64::EPSILON * a.abs().max(b.abs());
        let whole = b - a;
        let mut radius = resolution;
        while 0.0 < radius && radius < whole {
            radius *= 2.0;
        }
        while b - a > resolution {
            let middle = a + 0.5 * (b - a);
            // earliest secant root of the functions that have crossed, moved a little towards the
            // middle
            let mut x = b;
            for k in 0..self.side.len() {
                let (fa, fb) = (self.at_a[k], self.at_b[k]);
                if self.counts(k, self.side[k], sign(fb)) {
                    x = x.min(a + (b - a) * (fa / (fa - fb)).clamp(0.0, 1.0));
                }
            }
            let nudge = (0.2 / whole * (b - a) * (b - a)).max(0.5 * resolution);
            x = if nudge < (middle - x).abs() {
                x + nudge.copysign(middle - x)
            } else {
                middle
            };
            // no farther from the middle than bisection permits
            let room = (radius - 0.5 * (b - a)).max(0.0);
            x = x.clamp(middle - room, middle + room);
            if !(x > a && x < b) {
                x = middle;
            }
            if !(x > a && x < b) {
                break;
            }
            g(x, &mut self.at_x)?;
            if self.any_crossed(&self.at_x) {
                b = x;
                std::mem::swap(&mut self.at_b, &mut self.at_x);
            } else {
                a = x;
                std::mem::swap(&mut self.at_a, &mut self.at_x);
                // crossings that do not count, and functions that leave zero
                for (side, value) in self.side.iter_mut().zip(&self.at_a) {
                    if sign(*value) != 0 {
                        *side = sign(*value);
                    }
                }
            }
            radius *= 0.5;
        }
        Ok(b)
    }

    /// Returns whether going from `side` to `sign` is a crossing of function `k` that counts.
    fn counts(&self, k: usize, side: i8, sign: i8) -> bool {
        let crosses = side * sign < 0 || self.zero_counts && side == 0 && sign != 0;
        crosses
            && match self.direction[k] {
                Direction::Either => true,
                Direction::Rising => sign > 0,
                Direction::Falling => sign < 0,
            }
    }

    /// Returns whether a crossing that counts leads from the sides to these values.
    fn any_crossed(&self, values: &[f64]) -> bool {
        let mut each = self.side.iter().zip(values).enumerate();
        each.any(|(k, (side, value))| self.counts(k, *side, sign(*value)))
    }
}

/// Returns the side of a value: 0 for zero and for NaN.
pub fn sign(x: f64) -> i8 {
    if x > 0.0 {
        1
    } else if x < 0.0 {
        -1
    } else {
        0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All events of scalar functions over equal steps, with the number of evaluations.
    fn events<F: Fn(f64) -> f64>(
        functions: &[F],
        steps: &[f64],
        set: impl Fn(&mut Locator),
    ) -> (Vec<(f64, Vec<usize>)>, usize) {
        let mut locator = Locator::new(functions.len());
        set(&mut locator);
        let at = |t: f64| functions.iter().map(|f| f(t)).collect::<Vec<_>>();
        locator.begin(&at(steps[0]));
        let (mut found, mut evaluations) = (vec![], 0);
        for pair in steps.windows(2) {
            let mut t0 = pair[0];
            while t0 < pair[1] {
                let event = locator.scan((t0, pair[1]), &[], |t, values| {
                    evaluations += 1;
                    for (value, f) in values.iter_mut().zip(functions) {
                        *value = f(t);
                    }
                    Ok::<(), ()>(())
                });
                match event.unwrap() {
                    Some(t) => {
                        found.push((t, locator.crossed().to_vec()));
                        t0 = t;
                    }
                    None => break,
                }
            }
        }
        (found, evaluations)
    }

    #[test]
    fn every_zero_of_the_cosine_is_found_to_the_last_place() {
        let steps: Vec<f64> = (0..=10).map(f64::from).collect();
        let (found, evaluations) = events(&[f64::cos], &steps, |_| ());
        assert_eq!(found.len(), 3);
        for (i, (t, crossed)) in found.iter().enumerate() {
            let exact = std::f64::consts::PI * (i as f64 + 0.5);
            assert!((t - exact).abs() < 8.0 * f64::EPSILON * exact);
            assert_eq!(crossed, &[0]);
        }
        assert!(evaluations < 50 + 3 * 20, "{evaluations} evaluations");
    }

    #[test]
    fn the_earliest_of_several_comes_first() {
        let functions: [fn(f64) -> f64; 3] = [|t| t - 0.7, |t| 0.3 - t, |t| (t - 0.3) * 1e9];
        let (found, _) = events(&functions, &[0.0, 1.0], |_| ());
        assert_eq!(found.len(), 2);
        assert!((found[0].0 - 0.3).abs() < 1e-15 && (found[1].0 - 0.7).abs() < 1e-15);
        assert_eq!(found[0].1, [1, 2]);
        assert_eq!(found[1].1, [0]);
    }

    #[test]
    fn directions_choose() {
        let steps = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        let (rising, _) = events(&[f64::sin], &steps, |l| {
            l.set_direction(0, Direction::Rising)
        });
        let (falling, _) = events(&[f64::sin], &steps, |l| {
            l.set_direction(0, Direction::Falling)
        });
        assert_eq!((rising.len(), falling.len()), (1, 1));
        assert!((rising[0].0 - 2.0 * std::f64::consts::PI).abs() < 1e-14);
        assert!((falling[0].0 - std::f64::consts::PI).abs() < 1e-14);
    }

    #[test]
    fn a_dip_between_samples_is_two_events_and_a_touch_is_none() {
        // below zero for 2 % of the step, between two samples
        let (found, _) = events(
            &[|t: f64| (t - 0.5) * (t - 0.5) - 1e-4],
            &[0.0, 1.0],
            |_| (),
        );
        assert_eq!(found.len(), 2);
        assert!((found[0].0 - 0.49).abs() < 1e-14 && (found[1].0 - 0.51).abs() < 1e-14);
        let (found, _) = events(&[|t: f64| (t - 0.5) * (t - 0.5)], &[0.0, 1.0], |_| ());
        assert!(found.is_empty());
        let (found, _) = events(
            &[|t: f64| -(t - 0.47) * (t - 0.47) + 1e-6],
            &[0.0, 1.0],
            |_| (),
        );
        assert_eq!(found.len(), 2);
    }

    #[test]
    fn a_distance_that_shrinks_and_grows_within_a_step_is_two_events() {
        for place in 1..100 {
            let c = f64::from(place) / 100.0;
            for (apart, sign) in [(0.0, 1.0), (3e-4, -1.0)] {
                let r = 5e-4f64;
                let g = |t: f64| sign * ((t - c).hypot(apart) - r);
                let (found, _) = events(&[g], &[0.0, 1.0], |_| ());
                let half = (r * r - apart * apart).sqrt();
                assert_eq!(found.len(), 2, "{c} {apart}");
                assert!((found[0].0 - c + half).abs() < 1e-12);
                assert!((found[1].0 - c - half).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_dip_that_ends_with_its_step_is_seen() {
        // back at zero to the last bit
        let g = |t: f64| (t - 0.875) * (t - 1.0);
        let (found, _) = events(&[g], &[0.0, 1.0, 2.0], |_| ());
        let times: Vec<f64> = found.iter().map(|f| f.0).collect();
        assert_eq!(times.len(), 2, "{times:?}");
        assert!((times[0] - 0.875).abs() < 1e-14 && (times[1] - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_near_miss_does_not_hide_a_later_crossing() {
        let functions: [fn(f64) -> f64; 2] = [|t| (t - 0.5) * (t - 0.5) + 1e-4, |t| 0.95 - t];
        let (found, _) = events(&functions, &[0.0, 1.0], |_| ());
        assert_eq!(found.len(), 1);
        assert!((found[0].0 - 0.95).abs() < 1e-15);
    }

    #[test]
    fn what_has_just_switched_does_not_switch_again() {
        // the restart is at the event itself, where the value is nearly zero
        let (found, _) = events(&[|t: f64| (t - 0.25).sin()], &[0.0, 1.0, 2.0, 3.0], |_| ());
        assert_eq!(found.len(), 1);
        // begins exactly at zero: no event; leaves upward, comes back
        let (found, _) = events(&[|t: f64| t * (1.0 - t)], &[0.0, 0.4, 0.8, 1.2], |_| ());
        assert_eq!(found.len(), 1);
        assert!((found[0].0 - 1.0).abs() < 1e-15);
        // stays at zero
        let (found, _) = events(&[|_| 0.0], &[0.0, 1.0], |_| ());
        assert!(found.is_empty());
    }

    #[test]
    fn steep_flat_and_jumping_functions_are_bracketed() {
        let functions: [fn(f64) -> f64; 4] = [
            |t| (t - 0.3).powi(9),
            |t| (1e6 * (t - 0.3)).tanh(),
            |t| if t < 0.3 { -1e-9 } else { 1e9 },
            |t| (t - 0.3).cbrt(),
        ];
        for (i, f) in functions.iter().enumerate() {
            let (found, evaluations) = events(&[*f], &[0.0, 1.0], |_| ());
            assert_eq!(found.len(), 1, "function {i}");
            let allowed = if i == 0 { 1e-10 } else { 1e-15 };
            assert!(
                (found[0].0 - 0.3).abs() < allowed,
                "function {i}: {}",
                found[0].0
            );
            assert!(evaluations < 80, "function {i}: {evaluations} evaluations");
        }
    }

    #[test]
    fn not_a_number_is_no_event_and_errors_pass_through() {
        let (found, _) = events(
            &[|t: f64| if t > 0.5 { f64::NAN } else { 1.0 }],
            &[0.0, 1.0],
            |_| (),
        );
        assert!(found.is_empty());
        let mut locator = Locator::new(1);
        locator.begin(&[1.0]);
        assert_eq!(locator.scan((0.0, 1.0), &[], |_, _| Err("no")), Err("no"));
    }
}
