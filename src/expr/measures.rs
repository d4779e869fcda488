//! The TABLE of functions of the model: DX, VZ, FX, VARVAL … Their arguments are identifiers; their
//! value comes from a host.
//!
//! A row is: variant, name, arguments, dimension, formula, and the documentation above it. Parsing,
//! checks of arguments, help and completion read the rows; the formulas of the kinematic ones are
//! code in `physics/kinematic.rs`.

use super::dimension::Dimension;
use super::signature::{Argument, Choice, Element};

/// The data of the model that a group of measures reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Family {
    /// poses of markers
    Displacement,
    /// velocities of markers
    Velocity,
    /// accelerations of markers
    Acceleration,
    /// all forces between two markers
    GenericForce,
    /// the force of one element
    ElementForce,
    /// variables, arrays, differential equations, inputs, outputs, sensors
    System,
}

/// A row of the table: everything the language knows about a measure.
#[derive(Debug)]
pub struct Row {
    /// the measure
    pub measure: Measure,
    /// name, in upper case
    pub name: &'static str,
    /// arguments in order
    pub arguments: &'static [Argument],
    /// data of the model that it reads
    pub family: Family,
    /// dimension of the value
    pub dimension: Dimension,
    /// the value as an equation, with the symbols of the formulas; empty where the model decides
    pub formula: &'static str,
    /// description
    pub doc: &'static str,
}

macro_rules! measures {
    ($( $family:ident { $(
        $(#[doc = $doc:literal])+
        $variant:ident $name:literal $arguments:ident $dimension:ident $formula:literal;
    )+ } )+) => {
        /// A function of the model.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Measure { $( $( $(#[doc = $doc])+ $variant, )+ )+ }

        impl Measure {
            /// All measures in the order of the table.
            pub const ALL: &'static [Measure] = &[ $( $( Measure::$variant, )+ )+ ];
        }

        static ROWS: &[Row] = &[ $( $( Row {
            measure: Measure::$variant,
            name: $name,
            arguments: $arguments,
            family: Family::$family,
            dimension: Dimension::$dimension,
            formula: $formula,
            doc: concat!($($doc),+),
        }, )+ )+ ];
    };
}

const fn marker(name: &'static str) -> Argument {
    Argument::identifier(name, Element::Marker)
}
const fn marker_or_ground(name: &'static str) -> Argument {
    Argument::identifier_or_zero(name, Element::Marker).or("ground")
}

const I: Argument = marker("i").meaning("marker that is looked at");
const J: Argument = marker_or_ground("j").meaning("marker that it is seen from");
const K: Argument = marker_or_ground("k").meaning("marker whose axes give the directions");
const L: Argument = marker_or_ground("l").meaning("marker in whose frame the rate is taken");
const ACTING: Argument = marker("i").meaning("marker on which the forces act");
const REACTING: Argument =
    marker_or_ground("j").meaning("marker at their other end; 0 for action-only forces");
const JFLAG: Argument = Argument::selector("jflag", Choice::Range(0, 1))
    .meaning("0 on the I marker, 1 on the J marker");
const COMPONENT: Argument = Argument::selector("comp", Choice::Range(1, 8))
    .meaning("force: 1 magnitude, 2 x, 3 y, 4 z; torque: 5 magnitude, 6 x, 7 y, 8 z");
const RM: Argument = Argument::identifier_or_zero("rm", Element::Marker)
    .meaning("marker whose axes give the directions; 0 ground");
const N: Argument = Argument::selector("n", Choice::Positive).meaning("place in the list, from 1");

const I_J: &[Argument] = &[I, J];
const I_J_K: &[Argument] = &[I, J, K];
const I_J_L: &[Argument] = &[I, J, L];
const I_J_K_L: &[Argument] = &[I, J, K, L];
const ACTION: &[Argument] = &[ACTING, REACTING];
const ACTION_K: &[Argument] = &[ACTING, REACTING, K];
const THREE_MARKERS: &[Argument] = &[
    marker("i").meaning("marker at the end of the first leg"),
    marker("j").meaning("marker at the vertex"),
    marker("k").meaning("marker at the end of the second leg"),
];
const ORIENTATION: &[Argument] = &[
    Argument::selector("system", Choice::Range(1, 29)).meaning("sequence of angles or parameters"),
    Argument::selector("component", Choice::Range(1, 9)).meaning("which of them"),
    I,
    J,
];

const fn id(element: Element) -> Argument {
    Argument::identifier("id", element).meaning("element that is asked")
}

/// `(id, jflag, comp, rm)` of an element that acts between two markers.
macro_rules! element_force {
    ($($name:ident $element:ident)+) => { $(
        const $name: &[Argument] = &[id(Element::$element), JFLAG, COMPONENT, RM];
    )+ };
}
element_force! {
    OF_BEAM Beam  OF_BUSH Bushing  OF_FIELD Field  OF_SPDP SpringDamper  OF_SFORCE Sforce  OF_GFORCE Gforce  OF_VFORCE Vforce
    OF_VTORQ Vtorque  OF_PTCV Ptcv  OF_CVCV Cvcv  OF_JOINT Joint  OF_JPRIM Jprim  OF_MOTION Motion  OF_CONTACT Contact
}
const OF_NFORCE: &[Argument] = &[
    id(Element::Nforce),
    marker("at").meaning("marker on which the force acts"),
    COMPONENT,
    RM,
];
const OF_FRICTION: &[Argument] = &[
    id(Element::Friction),
    Argument::selector("index", Choice::Range(1, 24)).meaning("which number: see above"),
];
const OF_VARIABLE: &[Argument] = &[id(Element::Variable)];
const OF_ARRAY: &[Argument] = &[id(Element::Array), N];
const OF_DIFF: &[Argument] = &[id(Element::Diff)];
const OF_PINPUT: &[Argument] = &[id(Element::Pinput), N];
const OF_POUTPUT: &[Argument] = &[id(Element::Poutput), N];
const OF_SENSOR: &[Argument] = &[id(Element::Sensor)];

measures! {
    Displacement {
        /// Distance of the origin of i from that of j, never negative; its rate is VR, and 0 where
        /// the origins coincide.
        Dm "DM" I_J Length "|p_JI|";
        /// Displacement of i from j along the x axis of k.
        Dx "DX" I_J_K Length "p_JI · x_K";
        /// Displacement of i from j along the y axis of k.
        Dy "DY" I_J_K Length "p_JI · y_K";
        /// Displacement of i from j along the z axis of k.
        Dz "DZ" I_J_K Length "p_JI · z_K";
        /// Rotation of i against j about the x axis of j, radians. In a simulation it counts turns;
        /// without history it is the principal value. Undefined where z of i is parallel to x of j.
        Ax "AX" I_J Angle "atan2(−z_I · y_J, z_I · z_J)";
        /// Rotation of i against j about the y axis of j, radians. In a simulation it counts turns;
        /// without history it is the principal value. Undefined where z of i is parallel to y of j.
        Ay "AY" I_J Angle "atan2(z_I · x_J, z_I · z_J)";
        /// Rotation of i against j about the z axis of j, radians. In a simulation it counts turns;
        /// without history it is the principal value. Undefined where x of i is parallel to z of j.
        Az "AZ" I_J Angle "atan2(x_I · y_J, x_I · x_J)";
        /// First of the body-fixed 3-1-3 angles of i in j, radians. Where THETA is 0 or π the whole
        /// turn is PSI.
        Psi "PSI" I_J Angle "atan2(R13, −R23),  R = R_JI = Rz(ψ) Rx(θ) Rz(φ)";
        /// Second of the body-fixed 3-1-3 angles of i in j, radians, 0 to π.
        Theta "THETA" I_J Angle "atan2(√(R13² + R23²), R33),  R = R_JI = Rz(ψ) Rx(θ) Rz(φ)";
        /// Third of the body-fixed 3-1-3 angles of i in j, radians; 0 where THETA is 0 or π.
        Phi "PHI" I_J Angle "atan2(R31, R32),  R = R_JI = Rz(ψ) Rx(θ) Rz(φ)";
        /// First of the body-fixed 3-2-1 angles of i in j, radians.
        Yaw "YAW" I_J Angle "atan2(R21, R11),  R = R_JI = Rz(yaw) Ry(−pitch) Rx(roll)";
        /// The negative of the second of the body-fixed 3-2-1 angles of i in j, radians: nose up is
        /// positive.
        Pitch "PITCH" I_J Angle "atan2(R31, √(R11² + R21²)),  R = R_JI = Rz(yaw) Ry(−pitch) Rx(roll)";
        /// Third of the body-fixed 3-2-1 angles of i in j, radians; 0 where PITCH is ±π/2.
        Roll "ROLL" I_J Angle "atan2(R32, R33),  R = R_JI = Rz(yaw) Ry(−pitch) Rx(roll)";
        /// Angle at j between the directions to i and to k, radians. In a simulation it is followed
        /// continuously; without history it lies between 0 and π.
        Incang "INCANG" THREE_MARKERS Angle "atan2(|p_JI × p_JK|, p_JI · p_JK)";
        /// Component of the orientation of i in j. System 1 to 12: angles of the body-fixed
        /// sequences 1-2-3, 2-3-1, 3-1-2, 1-3-2, 2-1-3, 3-2-1, 1-2-1, 1-3-1, 2-1-2, 2-3-2, 3-1-3,
        /// 3-2-3; 13 to 24: of the same sequences about the axes of j, which stay; 27: Euler
        /// parameters, components 1 to 4; 28: Rodrigues parameters; 29: direction cosines,
        /// components 1 to 3 the x axis of i, 4 to 6 its y axis, 7 to 9 its z axis. Systems 25 and
        /// 26 are read but have no value here.
        Orient "ORIENT" ORIENTATION AngleOrNone "";
    }
    Velocity {
        /// Magnitude of the velocity of i relative to j, seen from l.
        Vm "VM" I_J_L Velocity "|v_JI − ω_L × p_JI|";
        /// Rate at which i and j separate; negative while they approach, 0 where the origins
        /// coincide.
        Vr "VR" I_J_L Velocity "v_JI · p_JI / |p_JI|";
        /// Velocity of i relative to j, seen from l, along the x axis of k.
        Vx "VX" I_J_K_L Velocity "(v_JI − ω_L × p_JI) · x_K";
        /// Velocity of i relative to j, seen from l, along the y axis of k.
        Vy "VY" I_J_K_L Velocity "(v_JI − ω_L × p_JI) · y_K";
        /// Velocity of i relative to j, seen from l, along the z axis of k.
        Vz "VZ" I_J_K_L Velocity "(v_JI − ω_L × p_JI) · z_K";
        /// Magnitude of the angular velocity of i relative to j.
        Wm "WM" I_J AngularVelocity "|ω_JI|";
        /// Angular velocity of i relative to j along the x axis of k.
        Wx "WX" I_J_K AngularVelocity "ω_JI · x_K";
        /// Angular velocity of i relative to j along the y axis of k.
        Wy "WY" I_J_K AngularVelocity "ω_JI · y_K";
        /// Angular velocity of i relative to j along the z axis of k.
        Wz "WZ" I_J_K AngularVelocity "ω_JI · z_K";
    }
    Acceleration {
        /// Magnitude of the acceleration of i relative to j, seen from l, without gravity.
        Accm "ACCM" I_J_L Acceleration "|a_JI − α_L × p_JI − 2 ω_L × v_JI + ω_L × (ω_L × p_JI)|";
        /// Acceleration of i relative to j, seen from l, along the x axis of k, without gravity.
        Accx "ACCX" I_J_K_L Acceleration "(a_JI − α_L × p_JI − 2 ω_L × v_JI + ω_L × (ω_L × p_JI)) · x_K";
        /// Acceleration of i relative to j, seen from l, along the y axis of k, without gravity.
        Accy "ACCY" I_J_K_L Acceleration "(a_JI − α_L × p_JI − 2 ω_L × v_JI + ω_L × (ω_L × p_JI)) · y_K";
        /// Acceleration of i relative to j, seen from l, along the z axis of k, without gravity.
        Accz "ACCZ" I_J_K_L Acceleration "(a_JI − α_L × p_JI − 2 ω_L × v_JI + ω_L × (ω_L × p_JI)) · z_K";
        /// Magnitude of the angular acceleration of i relative to j, seen from l.
        Wdtm "WDTM" I_J_L AngularAcceleration "|α_JI − ω_L × ω_JI|";
        /// Angular acceleration of i relative to j, seen from l, along the x axis of k.
        Wdtx "WDTX" I_J_K_L AngularAcceleration "(α_JI − ω_L × ω_JI) · x_K";
        /// Angular acceleration of i relative to j, seen from l, along the y axis of k.
        Wdty "WDTY" I_J_K_L AngularAcceleration "(α_JI − ω_L × ω_JI) · y_K";
        /// Angular acceleration of i relative to j, seen from l, along the z axis of k.
        Wdtz "WDTZ" I_J_K_L AngularAcceleration "(α_JI − ω_L × ω_JI) · z_K";
    }
    GenericForce {
        /// Magnitude of the sum of all forces on i from elements between i and j; without j, of
        /// action-only forces on i.
        Fm "FM" ACTION Force "|F|";
        /// Sum of all forces on i from elements between i and j, along the x axis of k; without j,
        /// of action-only forces.
        Fx "FX" ACTION_K Force "F · x_K";
        /// Sum of all forces on i from elements between i and j, along the y axis of k; without j,
        /// of action-only forces.
        Fy "FY" ACTION_K Force "F · y_K";
        /// Sum of all forces on i from elements between i and j, along the z axis of k; without j,
        /// of action-only forces.
        Fz "FZ" ACTION_K Force "F · z_K";
        /// Magnitude of the sum of all torques on i from elements between i and j; without j, of
        /// action-only torques on i.
        Tm "TM" ACTION Torque "|T|";
        /// Sum of all torques on i from elements between i and j, along the x axis of k; without j,
        /// of action-only torques.
        Tx "TX" ACTION_K Torque "T · x_K";
        /// Sum of all torques on i from elements between i and j, along the y axis of k; without j,
        /// of action-only torques.
        Ty "TY" ACTION_K Torque "T · y_K";
        /// Sum of all torques on i from elements between i and j, along the z axis of k; without j,
        /// of action-only torques.
        Tz "TZ" ACTION_K Torque "T · z_K";
    }
    ElementForce {
        /// Force of a beam on its I marker (jflag 0) or J marker (1), in the axes of rm; comp 1
        /// magnitude, 2–4 force, 5 magnitude, 6–8 torque.
        Beam "BEAM" OF_BEAM ForceOrTorque "";
        /// Force of a bushing on its I marker (jflag 0) or J marker (1), in the axes of rm; comp 1
        /// magnitude, 2–4 force, 5 magnitude, 6–8 torque.
        Bush "BUSH" OF_BUSH ForceOrTorque "";
        /// Force of a field element on its I marker (jflag 0) or J marker (1), in the axes of rm;
        /// comp 1 magnitude, 2–4 force, 5 magnitude, 6–8 torque.
        Field "FIELD" OF_FIELD ForceOrTorque "";
        /// Force of a spring-damper on its I marker (jflag 0) or J marker (1), in the axes of rm;
        /// comp 1 magnitude, 2–4 force, 5 magnitude, 6–8 torque.
        Spdp "SPDP" OF_SPDP ForceOrTorque "";
        /// Force of a single-component force on its I marker (jflag 0) or J marker (1), in the axes
        /// of rm; comp 1 magnitude, 2–4 force, 5 magnitude, 6–8 torque.
        Sforce "SFORCE" OF_SFORCE ForceOrTorque "";
        /// Force of a six-component force on its I marker (jflag 0) or J marker (1), in the axes of
        /// rm; comp 1 magnitude, 2–4 force, 5 magnitude, 6–8 torque.
        Gforce "GFORCE" OF_GFORCE ForceOrTorque "";
        /// Force of a three-component force on its I marker (jflag 0) or J marker (1), in the axes
        /// of rm; comp 1 magnitude, 2–4 force; 5–8 are 0.
        Vforce "VFORCE" OF_VFORCE ForceOrTorque "";
        /// Torque of a three-component torque on its I marker (jflag 0) or J marker (1), in the
        /// axes of rm; comp 5 magnitude, 6–8 torque; 1–4 are 0.
        Vtorq "VTORQ" OF_VTORQ ForceOrTorque "";
        /// Reaction of a point-curve constraint on its I marker (jflag 0) or J marker (1), in the
        /// axes of rm; comp 1 magnitude, 2–4 force, 5 magnitude, 6–8 torque.
        Ptcv "PTCV" OF_PTCV ForceOrTorque "";
        /// Reaction of a curve-curve constraint on its I marker (jflag 0) or J marker (1), in the
        /// axes of rm; comp 1 magnitude, 2–4 force, 5 magnitude, 6–8 torque.
        Cvcv "CVCV" OF_CVCV ForceOrTorque "";
        /// Reaction of a joint on its I marker (jflag 0) or J marker (1), in the axes of rm; comp 1
        /// magnitude, 2–4 force, 5 magnitude, 6–8 torque.
        Joint "JOINT" OF_JOINT ForceOrTorque "";
        /// Reaction of a joint primitive on its I marker (jflag 0) or J marker (1), in the axes of
        /// rm; comp 1 magnitude, 2–4 force, 5 magnitude, 6–8 torque.
        Jprim "JPRIM" OF_JPRIM ForceOrTorque "";
        /// Reaction of a motion on its I marker (jflag 0) or J marker (1), in the axes of rm; comp
        /// 1 magnitude, 2–4 force, 5 magnitude, 6–8 torque.
        Motion "MOTION" OF_MOTION ForceOrTorque "";
        /// Force of a contact, all its incidents together, on its I geometry (jflag 0) or J
        /// geometry (1), in the axes of rm; comp 1 magnitude, 2–4 force, 5 magnitude, 6–8 torque.
        Contact "CONTACT" OF_CONTACT ForceOrTorque "";
        /// Force of a multi-point force on the marker `at`, in the axes of rm; comp 1 magnitude,
        /// 2–4 force, 5 magnitude, 6–8 torque.
        Nforce "NFORCE" OF_NFORCE ForceOrTorque "";
        /// Joint friction, in the axes of the joint's J marker; index 1–3 force, 4–6 torque, 7–12
        /// coefficients, 13 effective static coefficient, 14–16 sliding velocity, 17–19 angular
        /// velocity, 20–24 creep.
        Friction "FRICTION" OF_FRICTION ByIndex "";
    }
    System {
        /// Value of an algebraic variable.
        Varval "VARVAL" OF_VARIABLE Variable "";
        /// The n-th entry of an array, from 1.
        Aryval "ARYVAL" OF_ARRAY Array "";
        /// Integrated value of a differential equation.
        Dif "DIF" OF_DIFF Equation "";
        /// Rate of a differential equation.
        Dif1 "DIF1" OF_DIFF EquationRate "";
        /// The n-th entry of a plant input, from 1.
        Pinval "PINVAL" OF_PINPUT PlantInput "";
        /// The n-th entry of a plant output, from 1.
        Pouval "POUVAL" OF_POUTPUT PlantOutput "";
        /// The last value that a sensor evaluated.
        Senval "SENVAL" OF_SENSOR Sensor "";
    }
}

impl Measure {
    /// Returns the row of this measure in the table.
    pub fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }
    /// Returns the name, in upper case.
    pub fn name(self) -> &'static str {
        self.row().name
    }
    /// Finds the measure of this name, in any case.
    pub fn by_name(name: &str) -> Option<Self> {
        ROWS.iter()
            .find(|r| r.name.eq_ignore_ascii_case(name))
            .map(|r| r.measure)
    }
    /// Returns whether its value depends on the past: angles that count turns, Euler parameters
    /// that keep their sign.
    pub fn needs_history(self) -> bool {
        matches!(
            self,
            Measure::Ax | Measure::Ay | Measure::Az | Measure::Incang | Measure::Orient
        )
    }
    /// Returns whether its value goes on beyond half a turn. INCANG never goes there: it has no
    /// sign.
    pub fn counts_turns(self) -> bool {
        self.needs_history() && self != Measure::Incang
    }
}

/// Returns the number of components of a system of ORIENT.
pub fn orientation_components(system: u32) -> u32 {
    match system {
        27 => 4,
        29 => 9,
        _ => 3,
    }
}

/// Returns all rows, in the order of the reference.
pub fn rows() -> &'static [Row] {
    ROWS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_found_under_its_name_and_its_place() {
        for (k, row) in rows().iter().enumerate() {
            assert_eq!(row.measure as usize, k);
            assert_eq!(
                Measure::by_name(&row.name.to_lowercase()),
                Some(row.measure)
            );
            assert!(
                row.arguments.len() <= 4,
                "{}: an input holds four identifiers",
                row.name
            );
        }
    }

    #[test]
    fn what_may_be_left_out_stands_last() {
        for row in rows() {
            let first_optional = row
                .arguments
                .iter()
                .position(|a| a.default.is_some())
                .unwrap_or(row.arguments.len());
            assert!(
                row.arguments[first_optional..]
                    .iter()
                    .all(|a| a.default.is_some()),
                "{}",
                row.name
            );
        }
    }
}
