//! The sizes of what columns show, by units.
//!
//! A value that is zero but for rounding has no digits to count, so a column is measured against
//! the largest value of all that have its unit. In a planar model no torque may be there at all but
//! for rounding: then it is measured against forces times the length of the scene, as angles and
//! their rates against lengths.

use super::shown::Unit;
use crate::analysis::accuracy::LEAST_SIZE;
use crate::results::Units;
use std::collections::BTreeMap;

/// The largest value by units.
#[derive(Clone, Debug, Default)]
pub(super) struct Sizes(BTreeMap<String, f64>);

impl Sizes {
    /// Takes units and values of columns; `span`: the length of the scene.
    pub fn of<'a>(
        columns: impl Iterator<Item = (&'a str, &'a [f64])>,
        units: &Units,
        span: f64,
    ) -> Self {
        let mut sizes = Self::default();
        for (unit, values) in columns {
            let most = sizes.0.entry(unit.to_owned()).or_default();
            *most = most.max(largest(values));
        }
        sizes.relate([Unit::Force, Unit::Torque], units, span);
        for power in 0..=2 {
            sizes.relate([Unit::Angle(power), Unit::Length(power)], units, span);
        }
        sizes
    }

    /// Makes each of two units of which the second is the first times a length no smaller than a
    /// part of what the other one says.
    fn relate(&mut self, pair: [Unit; 2], units: &Units, span: f64) {
        let [of, times_length] = pair.map(|unit| unit.spelt(units));
        let [a, b] = [&of, &times_length].map(|unit| self.get(unit));
        if of.is_empty() || times_length.is_empty() || span <= 0.0 {
            return;
        }
        for (unit, least) in [(of, b / span), (times_length, a * span)] {
            if let Some(size) = self.0.get_mut(&unit) {
                *size = size.max(LEAST_SIZE * least);
            }
        }
    }

    /// Returns the size of what has this unit; zero where nothing has it.
    pub fn get(&self, unit: &str) -> f64 {
        self.0.get(unit).copied().unwrap_or(0.0)
    }
}

/// Returns the largest of some values that are finite.
pub(super) fn largest(values: &[f64]) -> f64 {
    let finite = values.iter().filter(|x| x.is_finite());
    finite.fold(0.0, |m: f64, x| m.max(x.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn torques_that_are_rounding_are_measured_against_forces() {
        let units = Units {
            force: "newton".into(),
            length: "meter".into(),
            ..Units::default()
        };
        let columns: [(&str, &[f64]); 3] = [
            ("newton", &[3.0, -50.0, f64::NAN]),
            ("newton-meter", &[1e-15, -2e-15]),
            ("", &[7.0]),
        ];
        let sizes = Sizes::of(columns.into_iter(), &units, 4.0);
        let found = ["newton", "newton-meter", "", "meter"].map(|unit| sizes.get(unit));
        assert_eq!(found, [50.0, LEAST_SIZE * 200.0, 7.0, 0.0]);
    }
}
