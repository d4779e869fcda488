//! The least value of a function that is nowhere negative, located as a root is: once it is clear
//! that it falls to zero or stays well above, a few looks are enough.

/// Looks at a margin in search of its least value, at most.
const MOST_LOOKS: usize = 60;

/// Slope of a margin between places that have been looked at, over the steepest between these, at
/// most.
const STEEPER: f64 = 6.0;

/// Parts of the way from the middle place to one that has no value, at which others are tried.
const SHORT_OF_IT: [f64; 2] = [0.9, 0.5];

/// Three places on a way, and the values there of a function that is nowhere negative. Once a
/// minimum is enclosed the function is least at the middle one.
#[derive(Clone, Copy)]
pub(super) struct Valley {
    points: [(f64, f64); 3],
    /// the steepest that the function has been between two places
    steepest: f64,
}

impl Valley {
    /// Holds three places with their values, in order.
    pub fn of(points: [(f64, f64); 3]) -> Self {
        let mut valley = Self {
            points,
            steepest: 0.0,
        };
        valley.note_slopes();
        valley
    }

    /// Lays a place between two others.
    pub fn between([low, high]: [(f64, f64); 2], mut f: impl FnMut(f64) -> f64) -> Self {
        let middle = 0.5 * (low.0 + high.0);
        Self::of([low, (middle, f(middle)), high])
    }

    /// Returns the place where the function is least, and its value there.
    pub fn lowest(&self) -> (f64, f64) {
        let [a, m, b] = self.points;
        let lower = |x: (f64, f64), y: (f64, f64)| if y.1 < x.1 { y } else { x };
        lower(lower(m, a), b)
    }

    /// Returns where it is least.
    pub fn place(&self) -> f64 {
        self.lowest().0
    }

    /// Returns its least value.
    pub fn least(&self) -> f64 {
        self.lowest().1
    }

    /// Returns how far from its least place the function may vanish, about.
    pub fn reach(&self) -> f64 {
        2.0 * self.least() / self.steepest.max(f64::MIN_POSITIVE)
    }

    fn note_slopes(&mut self) {
        for pair in self.points.windows(2) {
            let slope = (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0);
            self.steepest = self.steepest.max(slope.abs());
        }
    }

    /// Returns the least that the function may be between the outer places, at slopes up to
    /// [`STEEPER`] times the steepest that has been seen.
    fn bound(&self) -> f64 {
        let of = |pair: &[(f64, f64)]| {
            let fall = STEEPER * self.steepest * (pair[1].0 - pair[0].0);
            0.5 * (pair[0].1 + pair[1].1 - fall)
        };
        self.points.windows(2).map(of).fold(f64::INFINITY, f64::min)
    }

    /// Looks at further places until the function is no more than `enough`, the outer places are
    /// `near` each other, nothing between them can be as small as `hopeless`, or the function has
    /// no value at a place nor short of it.
    pub fn descended(
        mut self,
        enough: f64,
        near: f64,
        hopeless: f64,
        mut f: impl FnMut(f64) -> Option<f64>,
    ) -> Self {
        let width = |points: &[(f64, f64); 3]| points[2].0 - points[0].0;
        let mut by_halves = false;
        for _ in 0..MOST_LOOKS {
            let is_open = width(&self.points) > near && self.least() > enough;
            if !is_open || self.bound().is_nan() || self.bound() > hopeless {
                break;
            }
            let before = width(&self.points);
            let next = self.root().filter(|_| !by_halves);
            let next = next.unwrap_or_else(|| self.aside());
            let middle = self.points[1].0;
            let short = SHORT_OF_IT.map(|part| middle + part * (next - middle));
            let mut places = std::iter::once(next).chain(short);
            let Some(new) = places.find_map(|place| Some((place, f(place)?))) else {
                break;
            };
            self.take(new);
            // a root that leaves most of the way on one side is followed by a place on that side
            by_halves = !by_halves && width(&self.points) > 0.5 * before;
        }
        self
    }

    /// Returns where a function that changes its sign where this one vanishes would be zero: by the
    /// inverse parabola, the sign of the middle place being the one that makes it straighter.
    fn root(&self) -> Option<f64> {
        let [(a, fa), (m, fm), (b, fb)] = self.points;
        if fa < fm || fb < fm {
            return None;
        }
        let slopes = |fm: f64| [(fm - fa) / (m - a), (-fb - fm) / (b - m)];
        let bend = |fm: f64| {
            let [left, right] = slopes(fm);
            (left - right).abs()
        };
        let (g, low, high) = match bend(fm) <= bend(-fm) {
            true => (fm, m, b),
            false => (-fm, a, m),
        };
        let term = |x: f64, g: f64, [h, k]: [f64; 2]| x * (h / (g - h)) * (k / (g - k));
        let root = term(a, fa, [g, -fb]) + term(m, g, [fa, -fb]) + term(b, -fb, [fa, g]);
        let margin = 1e-3 * (high - low).min(self.reach());
        (root > low + margin && root < high - margin).then_some(root)
    }

    /// Returns a place on the side of the lower end, or of a minimum on its wider side: as far from
    /// it as makes sure that it is enclosed.
    fn aside(&self) -> f64 {
        /// Smaller part of a golden section.
        const GOLDEN: f64 = 0.381_966_011_250_105;
        let [(a, fa), (m, fm), (b, fb)] = self.points;
        let is_enclosed = fm <= fa && fm <= fb;
        let is_right = if is_enclosed { b - m > m - a } else { fb < fa };
        let side = if is_right { b - m } else { a - m };
        let part = match is_enclosed {
            true => (2.0 * self.reach() / side.abs()).min(GOLDEN),
            false => 1.0 - GOLDEN,
        };
        m + part * side
    }

    /// Takes up a place between the outer ones.
    fn take(&mut self, new: (f64, f64)) {
        let [a, m, b] = self.points;
        let is_right = new.0 > m.0;
        // an end that is lower than the middle stays
        let has_lower_end = if is_right { b.1 < m.1 } else { a.1 < m.1 };
        self.points = match (is_right, new.1 < m.1 || has_lower_end) {
            (true, true) => [m, new, b],
            (true, false) => [a, m, new],
            (false, true) => [a, new, m],
            (false, false) => [new, m, b],
        };
        self.note_slopes();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the least value found of a function between 0 and 1, and the number of looks.
    fn least(f: impl Fn(f64) -> f64) -> (f64, usize) {
        let mut looks = 0;
        let mut f = |s: f64| {
            looks += 1;
            f(s)
        };
        let ends = [0.0, 1.0].map(|s| (s, f(s)));
        let valley = Valley::between(ends, &mut f);
        let valley = valley.descended(1e-8, 1e-12, 1e-6, |s| Some(f(s)));
        (valley.least(), looks)
    }

    #[test]
    fn a_pass_is_found_wherever_it_is_and_a_near_miss_is_told_soon() {
        for k in 1..200 {
            let at = f64::from(k) / 200.0 + 1e-4;
            let bent = |s: f64| {
                let x = s - at;
                x.abs() * (1.0 + 0.5 * (2.0 * x).sin())
            };
            let (size, looks) = least(bent);
            assert!(size <= 1e-8 && looks < 30, "{at}: {size:e} after {looks}");
            let missed = |s: f64| bent(s).hypot(1e-3);
            let (size, looks) = least(missed);
            assert!(size > 9e-4 && looks < 30, "{at}: {size:e} after {looks}");
        }
    }

    #[test]
    fn a_pass_beside_which_the_function_has_no_value_is_approached_up_to_there() {
        for k in 1..200 {
            let at = f64::from(k) / 200.0 + 1e-4;
            let value = |s: f64| ((s - at).abs() > 1e-6).then_some(3.0 * (s - at).abs());
            let ends = [0.0, 1.0].map(|s| (s, 3.0 * (s - at).abs()));
            let middle = (0.5, 3.0 * (0.5 - at).abs());
            let valley = Valley::of([ends[0], middle, ends[1]]);
            let least = valley.descended(1e-8, 1e-12, 0.1, value).least();
            assert!(least < 3e-5, "{at}: {least:e}");
        }
    }

    #[test]
    fn a_function_that_is_nowhere_small_or_has_no_value_ends_the_search() {
        assert!(least(|_| 1.0).1 < 60);
        assert!(least(|s| s).1 < 60);
        assert!(least(|_| f64::NAN).1 < 60);
        assert!(least(|_| 0.0).1 < 60);
    }
}
