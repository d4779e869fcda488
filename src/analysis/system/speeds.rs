//! Speeds of coordinates and drives: bounds of how far a step may turn.

use super::System;
use crate::scene::equations::Equations;
use crate::scene::layout::Layout;
use crate::scene::{Coordinate, Source};

impl System {
    /// Returns a bound of the speed of any angle at a state, rad per time; at a rate, of its
    /// change.
    pub fn spin(&self, y: &[f64]) -> f64 {
        self.speeds_of_angles(y).map(|(_, speed)| speed).sum()
    }

    /// Returns the speed of the fastest angle among the coordinates whose places in v are
    /// `counted`, rad per time.
    pub fn fastest_angle(&self, y: &[f64], counted: impl Fn(usize) -> bool) -> f64 {
        let speeds = self.speeds_of_angles(y).filter(|(v, _)| counted(*v));
        speeds.fold(0.0, |most, (_, speed)| speed.max(most))
    }

    /// Iterates over the coordinates that are angles: their places in v, and their speeds.
    fn speeds_of_angles<'a>(&'a self, y: &'a [f64]) -> impl Iterator<Item = (usize, f64)> + 'a {
        let l = self.scene.layout;
        let speeds = self
            .scene
            .coordinates
            .iter()
            .zip(&self.scene.freedoms)
            .filter(|(c, _)| c.angular);
        speeds
            .filter_map(|(_, f)| f.v)
            .map(move |v| (v, l.state(y).v[v].abs()))
    }

    /// Returns how fast coordinates and drives move at a state: the sum of their speeds, rad per
    /// time; lengths are measured by that of the mechanism.
    pub fn pace(&self, t: f64, y: &[f64]) -> f64 {
        let numbers = self.numbers_at(t, y);
        let at = Equations::new(self.configured(), &numbers);
        let v = self.scene.layout.state(y).v;
        let speed = |c: &Coordinate| {
            let rate = match c.source {
                Source::Free { v: k, .. } => v[k],
                Source::Driven(m) => at.prescribed(m).first,
            };
            let one = if c.angular { 1.0 } else { self.scene.length };
            rate.abs() / one
        };
        self.scene.coordinates.iter().map(speed).sum()
    }

    /// Returns how far motions that are angles go from the present numbers to a time, rad.
    pub fn turn_of_drives(&self, t: f64) -> f64 {
        let mut numbers = self.numbers.clone();
        let now = Equations::new(self.configured(), &numbers);
        let value = |at: &Equations<'_, f64>, m| at.prescribed(m).value;
        let motions = 0..self.scene.motions.len();
        let angles: Vec<usize> = motions.filter(|&m| self.scene.drives_an_angle(m)).collect();
        let before: Vec<f64> = angles.iter().map(|&m| value(&now, m)).collect();
        drop(now);
        numbers[Layout::TIME] = t;
        let then = Equations::new(self.configured(), &numbers);
        let ways = angles.iter().zip(before);
        ways.map(|(&m, before)| (value(&then, m) - before).abs())
            .sum()
    }
}
