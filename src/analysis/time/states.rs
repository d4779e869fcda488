//! States on the way, and those between or after them: positions cubic in time, from positions and
//! velocities at two instants.

use crate::scene::layout::Layout;
use crate::scene::mover::Mover;

/// Secants in search of a position within a cubic, at most.
const MOST_SECANTS: usize = 20;

/// A state at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// time
    pub t: f64,
    /// q | v | x   (n_y)
    pub y: Vec<f64>,
}

/// The cubic through the positions and velocities of two states.
#[derive(Clone, Debug)]
pub struct Cubic {
    layout: Layout,
    /// where it begins, and the distance in time of its ends
    t: f64,
    h: f64,
    /// coefficients of powers of the part of the way, by positions   (4 n_q)
    q: Vec<[f64; 4]>,
    /// the same of further states, which are linear   (2 n_x)
    x: Vec<[f64; 2]>,
}

impl Cubic {
    /// Lays a cubic through two states at different instants.
    pub fn new(mover: &Mover, layout: Layout, [a, b]: [&Node; 2]) -> Self {
        let h = b.t - a.t;
        let (before, after) = (layout.state(&a.y), layout.state(&b.y));
        let (mut m0, mut m1) = (vec![0.0; layout.n_q], vec![0.0; layout.n_q]);
        mover.untangent(before.q, before.v, &mut m0);
        mover.untangent(after.q, after.v, &mut m1);
        let coefficients = |k: usize| {
            let (m0, m1, d) = (h * m0[k], h * m1[k], after.q[k] - before.q[k]);
            [before.q[k], m0, 3.0 * d - 2.0 * m0 - m1, m0 + m1 - 2.0 * d]
        };
        let lines = before.x.iter().zip(after.x);
        Self {
            layout,
            t: a.t,
            h,
            q: (0..layout.n_q).map(coefficients).collect(),
            x: lines.map(|(&a, &b)| [a, b - a]).collect(),
        }
    }

    /// Returns a time between the ends at which a position has a value that lies between those at
    /// the ends, to a thousandth of the way; `None`: it does not.
    pub(super) fn reaches(&self, k: usize, value: f64) -> Option<f64> {
        let [p, m, second, third] = self.q[k];
        let off = |s: f64| p + s * (m + s * (second + s * third)) - value;
        let [mut a, mut b] = [0.0, 1.0].map(|s| (s, off(s)));
        if a.1 * b.1 >= 0.0 {
            return None;
        }
        let enough = 1e-3 * (b.1 - a.1).abs();
        // secants, of which the end that stays counts half
        for _ in 0..MOST_SECANTS {
            let s = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
            let now = (s, off(s));
            if now.1.abs() <= enough {
                return Some(self.t + s * self.h);
            }
            if (now.1 < 0.0) == (a.1 < 0.0) {
                (a, b.1) = (now, 0.5 * b.1);
            } else {
                (b, a.1) = (now, 0.5 * a.1);
            }
        }
        None
    }

    /// Evaluates positions, velocities and further states at a time between the ends or beyond.
    pub fn at(&self, mover: &Mover, t: f64, y: &mut [f64]) {
        let s = (t - self.t) / self.h;
        let state = self.layout.state_mut(y);
        let mut rate = vec![0.0; self.layout.n_q];
        for ((q, rate), [p, m, second, third]) in state.q.iter_mut().zip(&mut rate).zip(&self.q) {
            *q = p + s * (m + s * (second + s * third));
            *rate = (m + s * (2.0 * second + s * 3.0 * third)) / self.h;
        }
        mover.find_tangent(state.q, &rate, state.v);
        mover.normalize(state.q);
        for (x, [a, d]) in state.x.iter_mut().zip(&self.x) {
            *x = a + s * d;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_reaches_what_lies_between_its_ends_and_nothing_else() {
        for q in [
            [0.0, 1.0, 0.0, 0.0],
            [2.0, -0.1, -3.0, 1.0],
            [-1.0, 0.0, 0.1, 40.0],
        ] {
            let cubic = Cubic {
                layout: Layout::default(),
                t: 5.0,
                h: 0.25,
                q: vec![q],
                x: Vec::new(),
            };
            let at = |s: f64| q[0] + s * (q[1] + s * (q[2] + s * q[3]));
            let way = at(1.0) - at(0.0);
            for part in [0.01, 0.3, 0.5, 0.9, 0.999] {
                let value = at(0.0) + part * way;
                let t = cubic.reaches(0, value).expect("a time");
                assert!((5.0..=5.25).contains(&t));
                let off = at((t - 5.0) / 0.25) - value;
                assert!(off.abs() <= 1.1e-3 * way.abs(), "{q:?} {part}: {off}");
            }
            for part in [-0.01, 1.01] {
                assert_eq!(cubic.reaches(0, at(0.0) + part * way), None);
            }
        }
    }
}
