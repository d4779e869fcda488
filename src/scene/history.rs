//! Identities of what is remembered beside the unknowns: angles whose turns are counted, and values
//! whose past is kept.
//!
//! Each of them finds its place in the next simulation by its identity. As texts identities stand
//! in saved states, which read them back.

use crate::expr::measures::Measure;
use crate::physics::coupler::Gauge;
use std::fmt;
use std::str::FromStr;

/// An angle whose turns are counted. Prints as `AZ(2,1,0,0)` or `ANGLE_Z(2,1)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum AngleId {
    /// a measure with its arguments
    Measure(Measure, [u32; 4]),
    /// an angle of a joint or a coupler
    Gauge {
        /// which angle
        gauge: Gauge,
        /// user's numbers of the markers I and J
        markers: [u32; 2],
    },
}

/// A value whose past is kept for DELAY: the same expression of the same owner.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct DelayId {
    /// whose function asks for it: "SFORCE/3 FUNCTION"
    pub owner: String,
    /// the code of the expression, printed: what it computes whatever is written around it
    pub expression: String,
}

/// Names of the angles of joints.
const GAUGES: [(&str, Gauge); 7] = [
    ("ANGLE_X", Gauge::Angle(0)),
    ("ANGLE_Y", Gauge::Angle(1)),
    ("ANGLE_Z", Gauge::Angle(2)),
    ("HOOKE_PIN_1", pin(true, false)),
    ("HOOKE_PIN_2", pin(true, true)),
    ("UNIVERSAL_PIN_1", pin(false, false)),
    ("UNIVERSAL_PIN_2", pin(false, true)),
];

const fn pin(hooke: bool, second: bool) -> Gauge {
    Gauge::Pin { hooke, second }
}

impl AngleId {
    /// Reads the printed form.
    fn read(text: &str) -> Option<Self> {
        let (name, rest) = text.split_once('(')?;
        let numbers = rest.strip_suffix(')')?.split(',').map(|n| n.parse().ok());
        let numbers: Vec<u32> = numbers.collect::<Option<_>>()?;
        if let Some(measure) = Measure::by_name(name) {
            return Some(Self::Measure(measure, numbers.try_into().ok()?));
        }
        let (_, gauge) = GAUGES.into_iter().find(|(n, _)| *n == name)?;
        let markers = numbers.try_into().ok()?;
        Some(Self::Gauge { gauge, markers })
    }
}

impl fmt::Display for AngleId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Measure(measure, [a, b, c, d]) => {
                write!(f, "{}({a},{b},{c},{d})", measure.name())
            }
            Self::Gauge {
                gauge,
                markers: [i, j],
            } => {
                let named = GAUGES.iter().find(|(_, g)| g == gauge);
                let name = named.map_or("", |(name, _)| name);
                write!(f, "{name}({i},{j})")
            }
        }
    }
}

impl FromStr for AngleId {
    type Err = String;

    /// Reads the printed form, as saved states have it.
    fn from_str(text: &str) -> Result<Self, String> {
        Self::read(text).ok_or_else(|| format!("`{text}` is no angle of a model"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_print_as_saved_states_have_them_and_read_back() {
        let az = AngleId::Measure(Measure::Az, [2, 1, 0, 0]);
        assert_eq!(az.to_string(), "AZ(2,1,0,0)");
        assert_eq!("AZ(2,1,0,0)".parse(), Ok(az));
        for (name, gauge) in GAUGES {
            let angle = AngleId::Gauge {
                gauge,
                markers: [20, 1],
            };
            assert_eq!(angle.to_string(), format!("{name}(20,1)"));
            assert_eq!(angle.to_string().parse(), Ok(angle));
            assert!(gauge.is_angle());
        }
    }

    #[test]
    fn other_texts_are_no_angles() {
        for text in [
            "",
            "AZ",
            "AZ(2,1)",
            "AZ(2,1,0,x)",
            "ANGLE_W(2,1)",
            "ANGLE_Z(2,1,0)",
        ] {
            assert!(text.parse::<AngleId>().is_err(), "{text}");
        }
    }
}
