//! The nearest points of a wire to a solid: local minima of the distance d(s), found between
//! stations by secants and bisection.
//!
//! Two minima that merge end as one: they share by the height B of the barrier between them and the
//! difference Δ of their distances,
//!
//! ```text
//! u = Δ/(Δ + B),   c = 1 − B/depth ∈ [0, 1]
//! share of the higher one  1 − c (1 + u)/2,   of the lower one  1 − c (1 − u)/2
//! ```
//!
//! so that one vanishes without a force where the barrier does, and two that meet halfway are half
//! a touch each. With q the mean of d'² on both sides a minimum has the share q²/(q² +
//! [`LEVEL_SLOPE_SQUARED`]²): the end of a stretch that lies along a solid is not a touch of its
//! own.

use super::{ANCHORS, Wire, both};
use crate::space::Vec3;

/// Most nearest points of a wire.
pub(super) const LOWS: usize = 4;
/// Difference of distance, as a part of the size, that counts as none: a minimum is the middle of a
/// level stretch.
const EQUAL_DISTANCE: f64 = 1e-9;
/// Mean square of d' (a pure number) on one side of a minimum below which the wire lies along the
/// solid there.
const LEVEL_SLOPE_SQUARED: f64 = 1e-7;

/// A local minimum of the distance.
#[derive(Clone, Copy)]
pub(super) struct Low {
    /// station before it
    pub station: usize,
    /// parameter of the curve
    pub s: f64,
    /// distance from the solid, in length units
    pub d: f64,
    /// part of a touch
    pub share: f64,
}

impl Wire {
    /// Returns the share of a minimum for its sharpness: less than 1 where the wire lies along the
    /// solid on one of its sides.
    pub(super) fn sharpness(&self, d: &[f64], station: usize) -> f64 {
        let n = d.len();
        let ways = n.div_ceil(ANCHORS);
        let after = if self.closed {
            ways
        } else {
            ways.min(n - 1 - station)
        };
        let before = if self.closed { ways } else { ways.min(station) };
        let q = both(
            self.inclined(d, station, after),
            self.inclined(d, station + n - before, before),
        );
        1.0 / (1.0 + (LEVEL_SLOPE_SQUARED / q).powi(2))
    }

    /// Finds the nearest points, the deepest [`LOWS`] in the order of the wire, with shares for
    /// those that merge.
    pub(super) fn lows(
        &self,
        d: &[f64],
        distance: &dyn Fn(Vec3<f64>) -> f64,
        slope: &dyn Fn(f64) -> f64,
    ) -> Vec<Low> {
        let n = d.len();
        let flat = EQUAL_DISTANCE * self.size;
        let mut lows = Vec::new();
        for k in 0..n {
            let before = (k > 0 || self.closed).then(|| d[(k + n - 1) % n]);
            if before.is_some_and(|before| before <= d[k] + flat) {
                continue;
            }
            // as far as the distance is level
            let mut last = k;
            let mut after = None;
            while last + 1 < n || self.closed && last + 1 < k + n {
                let next = d[(last + 1) % n];
                if (next - d[k]).abs() > flat {
                    after = Some(next);
                    break;
                }
                last += 1;
            }
            let begins = self.parameter(k + n - usize::from(before.is_some())) - 2.0;
            let ends = self.parameter(last + usize::from(after.is_some()));
            if after.is_some_and(|after| after < d[k]) {
                continue;
            }
            let middle = (k + last) / 2;
            let mut low = (self.parameter(middle), d[middle % n]);
            let way = self.stations[(k + n - 1) % n]
                .way
                .max(self.stations[last % n].way);
            // skip a minimum that cannot touch wherever it lies between the stations: the way along
            // the wire is hardly longer than a straight line
            if d[k] - self.tube <= 1.5 * way {
                let at = |s: f64| distance(self.at(s));
                let s = root(slope, begins, ends);
                let least = at(s);
                if least <= low.1 {
                    low = (s, least);
                }
                let level = low.1 + flat;
                let to = root(|s| at(s) - level, low.0, ends);
                let from = -root(|s| at(-s) - level, -low.0, -begins);
                low.0 = 0.5 * (from + to);
                low.1 = at(low.0);
            }
            lows.push(Low {
                station: middle % n,
                s: low.0,
                d: low.1,
                share: 1.0,
            });
        }
        self.share(d, &mut lows);
        lows.sort_by(|a, b| a.d.total_cmp(&b.d));
        lows.truncate(LOWS);
        lows.sort_by_key(|low| low.station);
        lows
    }

    /// Returns the parameter of a station, counted on around a closed wire.
    fn parameter(&self, k: usize) -> f64 {
        let n = self.stations.len();
        // once around is 2
        self.stations[k % n].s + 2.0 * (k / n) as f64
    }

    /// Divides between minima with a barrier between them that is lower than they are deep.
    fn share(&self, d: &[f64], lows: &mut [Low]) {
        let (n, m) = (d.len(), lows.len());
        let pairs = match (m, self.closed) {
            (0 | 1, _) => 0,
            // there are two ways around, and the lower barrier counts
            (2, true) => 1,
            (_, true) => m,
            (_, false) => m - 1,
        };
        let wall = |a: usize, b: usize| {
            let steps = (b + n - a) % n;
            (0..=steps).map(|k| d[(a + k) % n]).fold(f64::MIN, f64::max)
        };
        for k in 0..pairs {
            let (i, j) = (k, (k + 1) % m);
            let (a, b) = (lows[i].station, lows[j].station);
            let mut top = wall(a, b);
            if m == 2 && self.closed {
                top = top.min(wall(b, a));
            }
            let (high, low) = if d[a] > d[b] { (i, j) } else { (j, i) };
            let ground = d[lows[high].station];
            let (height, step) = (top - ground, ground - d[lows[low].station]);
            let depth = self.tube - lows[high].d;
            if depth > 0.0 && height < depth {
                let together = 1.0 - height / depth;
                let apart = step / (step + height).max(f64::MIN_POSITIVE);
                lows[high].share *= 1.0 - 0.5 * together * (1.0 + apart);
                lows[low].share *= 1.0 - 0.5 * together * (1.0 - apart);
            }
        }
    }
}

/// Finds the root of a function that is not positive at `a` and not negative at `b`: by secants, or
/// bisection where these stay on one side.
fn root(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let (mut fa, mut fb) = (f(a), f(b));
    for _ in 0..100 {
        if b - a <= 1e-15 || fb <= 0.0 {
            return b;
        }
        if fa >= 0.0 {
            return a;
        }
        let x = (a * fb - b * fa) / (fb - fa);
        let x = if x > a && x < b { x } else { 0.5 * (a + b) };
        let y = f(x);
        if y == 0.0 {
            return x;
        }
        // the value at the end that stays counts half (Illinois)
        if y > 0.0 {
            (b, fb) = (x, y);
            fa *= 0.5;
        } else {
            (a, fa) = (x, y);
            fb *= 0.5;
        }
    }
    0.5 * (a + b)
}
