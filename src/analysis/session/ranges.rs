//! Ranges of coordinates and velocities in a simulation: whether anything has moved.

use crate::scene::layout::Layout;
use std::ops::Range;

/// Range of a coordinate over its size, and over what is typical of it, in which it stands still:
/// as rounding and the permitted error of a method move it where forces balance.
const STILL_OF_SIZE: f64 = 1e-9;
const STILL_OF_TYPICAL: f64 = 1e-12;

/// Least and largest value of each coordinate and velocity of a simulation, seen at the ends of
/// steps: outputs change nothing.
#[derive(Debug, Default)]
pub(super) struct Ranges {
    layout: Layout,
    coordinates: Vec<[f64; 2]>,
    velocities: Vec<[f64; 2]>,
}

impl Ranges {
    /// Begins at a state.
    pub fn begin(layout: &Layout, numbers: &[f64]) -> Self {
        let of = |place: Range<usize>| {
            let first = numbers.get(place).unwrap_or_default();
            first.iter().map(|&x| [x; 2]).collect()
        };
        Self {
            coordinates: of(layout.q()),
            velocities: of(layout.v()),
            layout: *layout,
        }
    }

    /// Looks at all numbers of a state.
    pub fn see(&mut self, numbers: &[f64]) {
        let of_coordinates = (&mut self.coordinates, self.layout.q());
        let of_velocities = (&mut self.velocities, self.layout.v());
        for (ranges, place) in [of_coordinates, of_velocities] {
            let now = numbers.get(place).unwrap_or_default();
            for ([low, high], &x) in ranges.iter_mut().zip(now) {
                (*low, *high) = (low.min(x), high.max(x));
            }
        }
    }

    /// Returns whether coordinates have been seen and none has moved by more than rounding and
    /// permitted errors move what is at rest; `typical`: magnitudes of the coordinates.
    pub fn stood_still(&self, typical: &[f64]) -> bool {
        let stands = |([low, high], typical): (&[f64; 2], &f64)| {
            let size = STILL_OF_SIZE * low.abs().max(high.abs());
            high - low <= size.max(STILL_OF_TYPICAL * typical)
        };
        !self.coordinates.is_empty() && self.coordinates.iter().zip(typical).all(stands)
    }

    /// Returns the largest way of a coordinate, or velocity, over what is typical of it; `typical`:
    /// magnitudes of the coordinates and of the velocities.
    pub fn reach(&self, typical: [&[f64]; 2]) -> f64 {
        let ways = self.coordinates.iter().map(|[low, high]| high - low);
        let speeds = self.velocities.iter();
        let speeds = speeds.map(|[low, high]| low.abs().max(high.abs()));
        let all = ways.zip(typical[0]).chain(speeds.zip(typical[1]));
        all.fold(0.0, |most, (x, typical)| most.max(x / typical))
    }

    /// Returns whether any velocity changes by more than some error: below it nothing can be told.
    pub fn exceed(&self, error: f64) -> bool {
        (self.velocities.iter()).any(|[low, high]| high - low > error)
    }
}
