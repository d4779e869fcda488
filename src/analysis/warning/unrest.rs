//! The element that is farthest from rest in a state, and what it does there.

use crate::analysis::quantity::short;
use crate::diagnostic::Subject;
use crate::results::Units;

/// The rate of something that is not at rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rate {
    /// velocity of a centre of mass, length per time
    Velocity,
    /// angular velocity, rad per time
    AngularVelocity,
    /// acceleration of a centre of mass
    Acceleration,
    /// angular acceleration
    AngularAcceleration,
    /// rate of a state
    StateRate,
}

impl Rate {
    /// Returns its name in JSON.
    pub fn word(self) -> &'static str {
        match self {
            Rate::Velocity => "velocity",
            Rate::AngularVelocity => "angular_velocity",
            Rate::Acceleration => "acceleration",
            Rate::AngularAcceleration => "angular_acceleration",
            Rate::StateRate => "rate",
        }
    }

    /// Returns its unit: "mm/sec**2".
    fn unit(self, units: &Units) -> String {
        let (of, power) = match self {
            Rate::Velocity => (units.length.as_str(), ""),
            Rate::Acceleration => (units.length.as_str(), "**2"),
            Rate::AngularVelocity => ("rad", ""),
            Rate::AngularAcceleration => ("rad", "**2"),
            Rate::StateRate => ("", ""),
        };
        if of.is_empty() || units.time.is_empty() {
            return String::new();
        }
        format!(" {of}/{}{power}", units.time)
    }
}

impl Unrest {
    /// Says what it does, after its subject.
    pub(super) fn words(&self, units: &Units) -> String {
        let by = format!("{}{}", short(self.value), self.rate.unit(units));
        match self.rate {
            Rate::Velocity | Rate::AngularVelocity => format!("moves by {by}"),
            Rate::Acceleration | Rate::AngularAcceleration => format!("accelerates by {by}"),
            Rate::StateRate => format!("changes by {by}"),
        }
    }
}

/// The element that is farthest from rest in a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Unrest {
    /// PART, POINT_MASS, or a state such as `DIFF/3`
    pub subject: Subject,
    /// which rate of it is not zero
    pub rate: Rate,
    /// its size
    pub value: f64,
}
