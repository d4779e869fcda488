//! Ranges of coordinates and velocities in a simulation: whether anything has moved.

use crate::scene::layout::Layout;
use std::ops::Range;

/// Way of a coordinate, or velocity, over what is typical of it, up to which everything rests:
/// as rounding and the permitted error of a method move it where forces balance.
const RESTING: f64 = 1e-12;

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
    /// permitted errors move what is at rest; `typical`: magnitudes of the method's unknowns.
    pub fn stand(&self, typical: &[f64]) -> bool {
        let ways = self.coordinates.iter().map(|[low, high]| high - low);
        let mut ways = ways.zip(self.of(typical, self.layout.q()));
        !self.coordinates.is_empty() && ways.all(|(way, typical)| way <= RESTING * typical)
    }

    /// Returns whether nothing has a velocity, either: small and fast swings are a motion, though
    /// the permitted error moves what stands so fast, too.
    pub fn rest(&self, typical: &[f64]) -> bool {
        let speeds = self.velocities.iter();
        let speeds = speeds.map(|[low, high]| low.abs().max(high.abs()));
        let mut speeds = speeds.zip(self.of(typical, self.layout.v()));
        self.stand(typical) && speeds.all(|(speed, typical)| speed <= RESTING * typical)
    }

    /// Returns the part of the method's unknowns that has a place in the numbers of a state.
    fn of<'a>(&self, unknowns: &'a [f64], place: Range<usize>) -> &'a [f64] {
        let begin = self.layout.y().start;
        &unknowns[place.start - begin..place.end - begin]
    }

    /// Returns whether any velocity changes by more than some error: below it nothing can be told.
    pub fn exceed(&self, error: f64) -> bool {
        (self.velocities.iter()).any(|[low, high]| high - low > error)
    }
}
