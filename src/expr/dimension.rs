//! Dimensions of what functions of the model yield: the unit of a column and the cards of functions
//! ask for them.

use std::fmt;

/// Dimension of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// length
    Length,
    /// angle
    Angle,
    /// length over time
    Velocity,
    /// angle over time
    AngularVelocity,
    /// length over squared time
    Acceleration,
    /// angle over squared time
    AngularAcceleration,
    /// force
    Force,
    /// force times length
    Torque,
    /// of a component of an action: 1 to 4 of the force, 5 to 8 of the torque
    ForceOrTorque,
    /// of a component of an orientation: an angle, or a number without dimension
    AngleOrNone,
    /// of one of several numbers of different dimensions
    ByIndex,
    /// that of a VARIABLE
    Variable,
    /// that of an ARRAY's entry
    Array,
    /// that of a differential equation's value
    Equation,
    /// that of a differential equation's value, over time
    EquationRate,
    /// that of an input of the plant
    PlantInput,
    /// that of an output of the plant
    PlantOutput,
    /// that of what a SENSOR evaluates
    Sensor,
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Length => "length",
            Self::Angle => "angle",
            Self::Velocity => "length/time",
            Self::AngularVelocity => "angle/time",
            Self::Acceleration => "length/time²",
            Self::AngularAcceleration => "angle/time²",
            Self::Force => "force",
            Self::Torque => "torque",
            Self::ForceOrTorque => "force or torque",
            Self::AngleOrNone => "angle or none",
            Self::ByIndex => "by index",
            Self::Variable => "that of the variable",
            Self::Array => "that of the array",
            Self::Equation => "that of the equation",
            Self::EquationRate => "that of the equation/time",
            Self::PlantInput => "that of the input",
            Self::PlantOutput => "that of the output",
            Self::Sensor => "that of the sensor",
        })
    }
}
