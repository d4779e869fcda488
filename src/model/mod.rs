//! What the user wrote: the dataset as data. Numbers are the user's, in the user's units; angles are radians.
//!
//! Elements refer to each other by their numbers, unresolved, so that a model can be built, changed and printed in any
//! order. All fields are public; `check` and the scene compiler say what does not fit together.
//! Nothing here knows how anything is computed.

use std::collections::{BTreeMap, BTreeSet};

/// Elements of one kind by their numbers.
pub type ById<T> = BTreeMap<u32, T>;

/// Where an element was written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Place {
    /// 1-based line of the statement's first character; 0 when built by a program
    pub line: usize,
    /// the name given by `adams_view_name='…'`
    pub name: Option<String>,
}

/// A FUNCTION as written.
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    /// an expression of the function language
    Expression {
        /// the text, continuation commas removed
        text: String,
        /// line of its first character in the file; 0 when built by a program
        line: usize,
        /// column of its first character in that line
        column: usize,
    },
    /// `USER(r1, …)`, computed by a routine of the user's
    User {
        /// r1, …
        constants: Vec<f64>,
        /// `ROUTINE=library::entry`
        routine: Option<String>,
    },
}

impl Formula {
    /// An expression built by a program.
    pub fn text(text: impl Into<String>) -> Self {
        Formula::Expression {
            text: text.into(),
            line: 0,
            column: 0,
        }
    }
}

/// The orientation of a part or marker, as written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Orientation {
    /// that of the parent
    #[default]
    Aligned,
    /// body-fixed 3-1-3 angles ψ, θ, φ [rad]
    Euler([f64; 3]),
    /// points on the axes, in parent coordinates (ZP/XP, ZG/XG)
    Points {
        /// on +z (with `use_x`: only in the x–z half plane)
        z: Option<[f64; 3]>,
        /// in the +x half plane (with `use_x`: on +x)
        x: Option<[f64; 3]>,
        /// USEXP: x is exact
        use_x: bool,
    },
}

/// PART (a rigid body; ground is the part with `ground`) and POINT_MASS.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Part {
    pub place: Place,
    pub ground: bool,
    pub mass: f64,
    /// marker at the centre of mass
    pub cm: Option<u32>,
    /// marker about whose origin and axes `ip` is given; CM when absent
    pub im: Option<u32>,
    /// Ixx, Iyy, Izz, and the positive products ∫xy, ∫xz, ∫yz dm
    pub ip: [f64; 6],
    /// origin of the part frame in ground
    pub qg: [f64; 3],
    /// orientation of the part frame in ground
    pub orientation: Orientation,
    /// initial velocity of CM along the axes of `vm` (ground when absent); `None` = not given
    pub velocity: [Option<f64>; 3],
    /// initial angular velocity about the axes of `wm` (CM when absent); `None` = not given
    pub angular_velocity: [Option<f64>; 3],
    pub vm: Option<u32>,
    pub wm: Option<u32>,
    /// EXACT: x, y, z, ψ, θ, φ that assembly should keep
    pub exact: [bool; 6],
}

/// What a marker is fixed in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum MarkerOwner {
    Part(u32),
    PointMass(u32),
    /// FLEX_BODY, FE_PART, CURVE …: read, not solved
    Other(u32),
}

/// MARKER: a frame fixed in a part, or floating.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Marker {
    pub place: Place,
    pub owner: MarkerOwner,
    /// origin in the part frame
    pub qp: [f64; 3],
    pub orientation: Orientation,
    /// its frame is set by the element that owns it
    pub floating: bool,
}

/// JOINT types.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[rustfmt::skip]
pub enum JointKind {
    Fixed, Revolute, Translational, Cylindrical, Spherical, Planar, Universal, Hooke, Convel, Rackpin, Screw,
}

/// JOINT
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Joint {
    pub place: Place,
    pub kind: JointKind,
    pub i: u32,
    pub j: u32,
    /// IC or ICTRAN: initial displacement and velocity along z_J
    pub ic_translation: [Option<f64>; 2],
    /// IC or ICROT: initial angle and rate about z_J [rad]
    pub ic_rotation: [Option<f64>; 2],
    /// SCREW: translation per revolution
    pub pitch: Option<f64>,
    /// RACKPIN: pitch diameter, signed
    pub pd: Option<f64>,
}

/// JPRIM types.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[rustfmt::skip]
pub enum PrimitiveKind { Atpoint, Inline, Inplane, Orientation, ParallelAxes, Perpendicular }

/// JPRIM
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Primitive {
    pub place: Place,
    pub kind: PrimitiveKind,
    pub i: u32,
    pub j: u32,
}

/// What a MOTION drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Driven {
    JointTranslation(u32),
    JointRotation(u32),
    /// the only freedom of a joint (no keyword given)
    Joint(u32),
    /// component 0 X, 1 Y, 2 Z of I from J along J's axes; 3 B1, 4 B2, 5 B3 body 1-2-3 angles of I in J
    Markers {
        i: u32,
        j: u32,
        component: usize,
    },
}

/// Level at which a MOTION prescribes.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[rustfmt::skip]
pub enum Level { #[default] Displacement, Velocity, Acceleration }

/// MOTION
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Motion {
    pub place: Place,
    pub driven: Driven,
    pub level: Level,
    pub function: Formula,
    pub ic_displacement: Option<f64>,
    pub ic_velocity: Option<f64>,
}

/// COUPLER: r1 q1 + r2 q2 + r3 q3 = constant.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Coupler {
    pub place: Place,
    pub joints: Vec<u32>,
    /// per joint: rotation (true) or translation (false); `None` = the joint's only freedom
    pub rotational: Vec<Option<bool>>,
    /// as many as joints
    pub scales: Vec<f64>,
    pub user: Option<Formula>,
}

/// GEAR
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Gear {
    pub place: Place,
    pub joints: [u32; 2],
    pub cv: u32,
}

/// GCON: expression = 0
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct GeneralConstraint {
    pub place: Place,
    pub i: Option<u32>,
    pub function: Formula,
}

/// SFORCE
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct SingleForce {
    pub place: Place,
    pub rotational: bool,
    pub i: u32,
    pub j: u32,
    pub action_only: bool,
    pub function: Formula,
}

/// VFORCE, VTORQUE, GFORCE: components in the axes of `rm`, on I; the reaction acts on the part of `jfloat`.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct VectorForce {
    pub place: Place,
    pub i: u32,
    /// floating marker that carries the reaction; `None` = no reaction
    pub jfloat: Option<u32>,
    /// axes of the components; ground when absent
    pub rm: Option<u32>,
    /// FX, FY, FZ; absent = 0
    pub force: [Option<Formula>; 3],
    /// TX, TY, TZ; absent = 0
    pub torque: [Option<Formula>; 3],
    /// FUNCTION=USER(…) for all of them
    pub user: Option<Formula>,
}

/// SPRINGDAMPER
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct SpringDamper {
    pub place: Place,
    pub rotational: bool,
    pub i: u32,
    pub j: u32,
    /// K or KT
    pub stiffness: f64,
    /// C or CT
    pub damping: f64,
    /// FORCE or TORQUE at the free length
    pub preload: f64,
    /// LENGTH or ANGLE [rad]
    pub free: f64,
}

/// BUSHING: three translations then three rotations, in J axes
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Bushing {
    pub place: Place,
    pub i: u32,
    pub j: u32,
    /// K, KT
    pub stiffness: [f64; 6],
    /// C, CT
    pub damping: [f64; 6],
    /// FORCE, TORQUE
    pub preload: [f64; 6],
}

/// VARIABLE
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Variable {
    pub place: Place,
    pub ic: Option<f64>,
    pub function: Formula,
}

/// DIFF
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Differential {
    pub place: Place,
    pub ic: [Option<f64>; 2],
    pub static_hold: bool,
    pub implicit: bool,
    pub function: Formula,
}

/// ARRAY kinds.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum ArrayKind {
    Ic(Vec<f64>),
    States,
    Outputs,
    Inputs(Vec<u32>),
}

/// ARRAY
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Array {
    pub place: Place,
    pub size: Option<usize>,
    pub kind: ArrayKind,
}

/// SPLINE
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct SplineData {
    pub place: Place,
    pub x: Vec<f64>,
    /// one curve per z   (n_z × n_x)
    pub y: Vec<Vec<f64>>,
    /// empty for a single curve
    pub z: Vec<f64>,
    pub linear_extrapolate: bool,
    pub file: Option<String>,
}

/// What a REQUEST asks.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum RequestKind {
    Displacement {
        i: u32,
        j: Option<u32>,
        rm: Option<u32>,
    },
    Velocity {
        i: u32,
        j: Option<u32>,
        rm: Option<u32>,
    },
    Acceleration {
        i: u32,
        j: Option<u32>,
        rm: Option<u32>,
    },
    Force {
        i: u32,
        j: Option<u32>,
        rm: Option<u32>,
    },
    Functions(Box<[Option<Formula>; 8]>),
    User(Formula),
}

/// REQUEST
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Request {
    pub place: Place,
    pub kind: RequestKind,
    pub comment: Option<String>,
    pub title: Vec<String>,
    pub results_name: Option<String>,
    pub cnames: Vec<String>,
    pub cunits: Vec<String>,
    pub clabels: Vec<String>,
}

/// UNITS
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Units {
    pub force: String,
    pub mass: String,
    pub length: String,
    pub time: String,
    /// Force·UCF = Mass·Acceleration, all in model units
    pub ucf: f64,
}

/// INTEGRATOR; `None` = not given
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct IntegratorSettings {
    /// GSTIFF, WSTIFF, HHT, ABAM … in full
    pub method: Option<String>,
    /// I3, SI2, SI1
    pub formulation: Option<String>,
    pub error: Option<f64>,
    pub hmax: Option<f64>,
    pub hmin: Option<f64>,
    pub hinit: Option<f64>,
    pub kmax: Option<u32>,
    pub maxit: Option<u32>,
    pub alpha: Option<f64>,
    pub beta: Option<f64>,
    pub gamma: Option<f64>,
}

/// EQUILIBRIUM, KINEMATICS, IC and the like: numbers and words by full keyword; empty = defaults
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Settings {
    pub numbers: BTreeMap<String, f64>,
    pub words: BTreeMap<String, String>,
}

/// The dataset as data.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Model {
    pub title: String,
    pub units: Option<Units>,
    /// along ground x, y, z [length/time²]
    pub gravity: [f64; 3],
    pub parts: ById<Part>,
    pub point_masses: ById<Part>,
    pub markers: ById<Marker>,
    pub joints: ById<Joint>,
    pub primitives: ById<Primitive>,
    pub motions: ById<Motion>,
    pub couplers: ById<Coupler>,
    pub gears: ById<Gear>,
    pub general_constraints: ById<GeneralConstraint>,
    pub sforces: ById<SingleForce>,
    pub vforces: ById<VectorForce>,
    pub vtorques: ById<VectorForce>,
    pub gforces: ById<VectorForce>,
    pub spring_dampers: ById<SpringDamper>,
    pub bushings: ById<Bushing>,
    pub variables: ById<Variable>,
    pub differentials: ById<Differential>,
    pub arrays: ById<Array>,
    pub splines: ById<SplineData>,
    pub requests: ById<Request>,
    pub integrator: IntegratorSettings,
    pub equilibrium: Settings,
    pub kinematics: Settings,
    pub initial_conditions: Settings,
    /// OUTPUT, RESULTS, PREFERENCES, DEBUG, LSOLVER … by keyword
    pub settings: BTreeMap<String, Settings>,
    /// elements switched off by DEACTIVATE: (statement keyword, number)
    pub inactive: BTreeSet<(String, u32)>,
}
