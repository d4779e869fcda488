//! Output times of a simulation.

/// The most output times of one simulation.
pub const MOST: usize = 10_000_000;

/// Output times after the start, the last of them the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Output {
    /// so many, at equal distances
    Steps(usize),
    /// at this distance from each other; the last may be nearer
    Every(f64),
}

impl Output {
    /// Returns the number of times, `usize::MAX` at most.
    pub fn count(self, start: f64, end: f64) -> usize {
        match self {
            Output::Steps(n) => n.max(1),
            // a distance that fits up to rounding does not leave a sliver; conversion saturates
            Output::Every(dt) => ((end - start) / dt - 1e-9).ceil().max(1.0) as usize,
        }
    }

    /// Returns the times, [`MOST`] at most, after `start`, up to `end` and including it.
    pub fn times(self, start: f64, end: f64) -> Vec<f64> {
        let n = self.count(start, end).min(MOST);
        let distance = match self {
            Output::Steps(_) => None,
            Output::Every(dt) => Some(dt),
        };
        let time = |k: usize| match distance {
            _ if k == n => end,
            Some(dt) => start + k as f64 * dt,
            None => start + (end - start) * k as f64 / n as f64,
        };
        (1..=n).map(time).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_interval_of_a_given_distance_is_the_shorter_one() {
        assert_eq!(Output::Every(0.4).times(1.0, 2.0), [1.4, 1.8, 2.0]);
        assert_eq!(Output::Every(0.25).times(0.0, 1.0), [0.25, 0.5, 0.75, 1.0]);
        assert_eq!(Output::Every(5.0).times(0.0, 1.0), [1.0]);
    }

    #[test]
    fn a_distance_that_fits_up_to_rounding_leaves_no_sliver() {
        assert_eq!(Output::Every(0.1).times(0.0, 0.3 + 1e-17).len(), 3);
        assert_eq!(Output::Every(0.1).times(0.7, 1.0).len(), 3);
    }

    #[test]
    fn steps_are_equal_and_end_at_the_end() {
        assert_eq!(Output::Steps(4).times(1.0, 2.0), [1.25, 1.5, 1.75, 2.0]);
        assert_eq!(Output::Steps(0).times(0.0, 3.0), [3.0]);
    }
}
