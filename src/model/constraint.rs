//! Constraints: JOINT, JPRIM, MOTION, COUPLER, GEAR, GCON, CURVE, PTCV, CVCV.

use super::element::{Element, ElementKind, Named, names, names_each, placed};
use super::{Formula, Place};
use crate::physics::joint::Tie;
pub use crate::physics::joint::{JointKind, PrimitiveKind};

/// JOINT: a joint between two markers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Joint {
    /// where it stands in the dataset
    pub place: Place,
    /// its type
    pub kind: JointKind,
    /// I marker, on the part that moves
    pub i: u32,
    /// J marker, against which I moves
    pub j: u32,
    /// IC or ICTRAN: initial displacement and velocity along z_J
    pub ic_translation: [Option<f64>; 2],
    /// IC or ICROT: initial angle and rate about z_J, in rad
    pub ic_rotation: [Option<f64>; 2],
    /// SCREW: translation per revolution
    pub pitch: Option<f64>,
    /// RACKPIN: pitch diameter, signed
    pub pd: Option<f64>,
    /// FRICTION of datasets older than the statement FRICTION: ON, OFF, PRELOAD_ONLY; not solved
    pub friction: Option<String>,
    /// its initial displacement and velocity were given by name, so that their order says nothing
    pub has_named_ic: bool,
}

impl Element for Joint {
    placed!();
    fn equations(&self) -> Option<usize> {
        Some(Tie::Joint(self.kind).removes())
    }
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Marker, [("I", self.i), ("J", self.j)])
    }
    fn ends(&self) -> Option<[u32; 2]> {
        Some([self.i, self.j])
    }
}

/// JPRIM: a single condition between two markers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Primitive {
    /// where it stands in the dataset
    pub place: Place,
    /// its type
    pub kind: PrimitiveKind,
    /// I marker
    pub i: u32,
    /// J marker
    pub j: u32,
}

impl Element for Primitive {
    placed!();
    fn equations(&self) -> Option<usize> {
        Some(Tie::Primitive(self.kind).removes())
    }
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Marker, [("I", self.i), ("J", self.j)])
    }
    fn ends(&self) -> Option<[u32; 2]> {
        Some([self.i, self.j])
    }
}

/// The displacement that a MOTION drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driven {
    /// translation along z of J of a joint
    JointTranslation(u32),
    /// rotation about z of J of a joint
    JointRotation(u32),
    /// the only freedom of a joint (no keyword given)
    Joint(u32),
    /// component 0 X, 1 Y, 2 Z of I from J along J's axes; 3 B1, 4 B2, 5 B3 body 1-2-3 angles of I
    /// in J
    Markers {
        /// I marker
        i: u32,
        /// J marker
        j: u32,
        /// which: 0 to 5
        component: usize,
    },
}

impl Default for Driven {
    fn default() -> Self {
        Driven::Joint(0)
    }
}

/// The level at which a MOTION prescribes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Level {
    /// DISPLACEMENT
    #[default]
    Displacement,
    /// VELOCITY
    Velocity,
    /// ACCELERATION
    Acceleration,
}

/// MOTION: a displacement, velocity or acceleration given as a function of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// where it stands in the dataset
    pub place: Place,
    /// the displacement that is given
    pub driven: Driven,
    /// whether the function is the displacement or a rate of it
    pub level: Level,
    /// FUNCTION   [length or rad, over time or time² at the higher levels]
    pub function: Formula,
    /// ICDISP: displacement at the start   [length or rad]; used by velocity and acceleration
    pub ic_displacement: Option<f64>,
    /// ICVEL: velocity at the start   [length/time or rad/time]; used by acceleration
    pub ic_velocity: Option<f64>,
}

impl Element for Motion {
    placed!();
    fn equations(&self) -> Option<usize> {
        Some(1)
    }
    fn references(&self) -> Vec<Named> {
        match self.driven {
            Driven::Joint(n) | Driven::JointRotation(n) | Driven::JointTranslation(n) => {
                names(ElementKind::Joint, [("JOINT", n)])
            }
            Driven::Markers { i, j, .. } => names(ElementKind::Marker, [("I", i), ("J", j)]),
        }
    }
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        vec![("FUNCTION", &self.function)]
    }
    fn ends(&self) -> Option<[u32; 2]> {
        match self.driven {
            Driven::Joint(_) | Driven::JointRotation(_) | Driven::JointTranslation(_) => None,
            Driven::Markers { i, j, .. } => Some([i, j]),
        }
    }
}

/// COUPLER: r1 q1 + r2 q2 + r3 q3 = constant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coupler {
    /// where it stands in the dataset
    pub place: Place,
    /// JOINTS: two or three
    pub joints: Vec<u32>,
    /// per joint: rotation (true) or translation (false); `None` = the joint's only freedom
    pub rotational: Vec<Option<bool>>,
    /// as many as joints
    pub scales: Vec<f64>,
    /// FUNCTION=USER(…), instead of SCALES
    pub user: Option<Formula>,
}

impl Element for Coupler {
    placed!();
    fn equations(&self) -> Option<usize> {
        Some(1)
    }
    fn references(&self) -> Vec<Named> {
        names_each(ElementKind::Joint, "JOINTS", &self.joints)
    }
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        self.user.iter().map(|f| ("FUNCTION", f)).collect()
    }
}

/// GEAR: two joints whose points at the common velocity marker move alike.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gear {
    /// where it stands in the dataset
    pub place: Place,
    /// JOINTS: the two joints, which share the carrier of their J markers
    pub joints: [u32; 2],
    /// CV: marker on the carrier; its z points along the common velocity
    pub cv: u32,
}

impl Element for Gear {
    placed!();
    fn equations(&self) -> Option<usize> {
        Some(1)
    }
    fn references(&self) -> Vec<Named> {
        let mut all = names_each(ElementKind::Joint, "JOINTS", &self.joints);
        all.extend(names(ElementKind::Marker, [("CV", self.cv)]));
        all
    }
}

/// GCON: an expression that stays zero.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GeneralConstraint {
    /// where it stands in the dataset
    pub place: Place,
    /// I: marker on whose part the reaction is told
    pub i: Option<u32>,
    /// FUNCTION: the expression
    pub function: Formula,
}

impl Element for GeneralConstraint {
    placed!();
    fn equations(&self) -> Option<usize> {
        Some(1)
    }
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Marker, [("I", self.i)])
    }
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        vec![("FUNCTION", &self.function)]
    }
}

/// CURVE: a B-spline through or near the rows of a MATRIX, or computed by a routine.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// where it stands in the dataset
    pub place: Place,
    /// CLOSED: its end meets its beginning
    pub closed: bool,
    /// one more than the degree of the pieces; 4 when absent
    pub order: Option<u32>,
    /// MATRIX with one row x, y, z per point
    pub matrix: Option<u32>,
    /// CURVE_POINTS: the rows lie on the curve; CONTROL_POINTS, and when neither is said: they are
    /// control points
    pub through_points: Option<bool>,
    /// FUNCTION=USER(…)
    pub function: Option<Formula>,
    /// −1 when absent
    pub minpar: Option<f64>,
    /// 1 when absent
    pub maxpar: Option<f64>,
}

impl Element for Curve {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Matrix, [("MATRIX", self.matrix)])
    }
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        self.function.iter().map(|f| ("FUNCTION", f)).collect()
    }
}

/// PTCV: the origin of I stays on a curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointOnCurve {
    /// where it stands in the dataset
    pub place: Place,
    /// CURVE
    pub curve: u32,
    /// I marker
    pub i: u32,
    /// floating marker that carries the reaction
    pub jfloat: Option<u32>,
    /// in whose coordinates the curve is given
    pub rm: u32,
    /// where the contact is to start, in ICM or RM coordinates
    pub start: Option<[f64; 3]>,
    /// initial velocity along the curve
    pub velocity: Option<f64>,
    /// ICM
    pub start_marker: Option<u32>,
}

impl Element for PointOnCurve {
    placed!();
    fn equations(&self) -> Option<usize> {
        Some(2)
    }
    fn references(&self) -> Vec<Named> {
        let mut all = names(ElementKind::Curve, [("CURVE", self.curve)]);
        all.extend(names(ElementKind::Marker, [("I", self.i), ("RM", self.rm)]));
        let optional = [("JFLOAT", self.jfloat), ("ICM", self.start_marker)];
        all.extend(names(ElementKind::Marker, optional));
        all
    }
    fn ends(&self) -> Option<[u32; 2]> {
        Some([self.i, self.rm])
    }
}

/// One of the two sides of a CVCV.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveSide {
    /// ICURVE, JCURVE
    pub curve: u32,
    /// IRM, JRM: in whose coordinates the curve is given
    pub rm: u32,
    /// IFLOAT, JFLOAT
    pub float: Option<u32>,
    /// IDISP, JDISP: where the contact is to start
    pub start: Option<[f64; 3]>,
    /// IICM, JICM
    pub start_marker: Option<u32>,
    /// IVEL, JVEL
    pub velocity: Option<f64>,
}

/// CVCV: two planar curves touch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveOnCurve {
    /// where it stands in the dataset
    pub place: Place,
    /// the curve of I
    pub i: CurveSide,
    /// the curve of J
    pub j: CurveSide,
}

impl Element for CurveOnCurve {
    placed!();
    fn equations(&self) -> Option<usize> {
        Some(2)
    }
    fn references(&self) -> Vec<Named> {
        let mut all = Vec::new();
        let words = [
            ["ICURVE", "IRM", "IFLOAT", "IICM"],
            ["JCURVE", "JRM", "JFLOAT", "JICM"],
        ];
        for (side, [curve, rm, float, icm]) in [&self.i, &self.j].into_iter().zip(words) {
            all.extend(names(ElementKind::Curve, [(curve, side.curve)]));
            all.extend(names(ElementKind::Marker, [(rm, side.rm)]));
            let optional = [(float, side.float), (icm, side.start_marker)];
            all.extend(names(ElementKind::Marker, optional));
        }
        all
    }
    fn ends(&self) -> Option<[u32; 2]> {
        Some([self.i.rm, self.j.rm])
    }
}
