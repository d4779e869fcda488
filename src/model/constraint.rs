//! What ties parts together: JOINT, JPRIM, MOTION, COUPLER, GEAR, GCON, CURVE, PTCV, CVCV.

use super::element::{Element, ElementKind, Named, names, names_each, placed};
use super::{Formula, Place};
pub use crate::physics::joint::{JointKind, PrimitiveKind};

/// JOINT
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Joint {
    pub place: Place,
    pub kind: JointKind,
    pub i: u32,
    pub j: u32,
    /// IC or ICTRAN: initial displacement and velocity along z_J
    pub ic_translation: [Option<f64>; 2],
    /// IC or ICROT: initial angle and rate about z_J, in rad
    pub ic_rotation: [Option<f64>; 2],
    /// SCREW: translation per revolution
    pub pitch: Option<f64>,
    /// RACKPIN: pitch diameter, signed
    pub pd: Option<f64>,
}

impl Element for Joint {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Marker, [("I", self.i), ("J", self.j)])
    }
    fn ends(&self) -> Option<[u32; 2]> {
        Some([self.i, self.j])
    }
}

/// JPRIM
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Primitive {
    pub place: Place,
    pub kind: PrimitiveKind,
    pub i: u32,
    pub j: u32,
}

impl Element for Primitive {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Marker, [("I", self.i), ("J", self.j)])
    }
    fn ends(&self) -> Option<[u32; 2]> {
        Some([self.i, self.j])
    }
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

impl Default for Driven {
    fn default() -> Self {
        Driven::Joint(0)
    }
}

/// Level at which a MOTION prescribes.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[rustfmt::skip]
pub enum Level { #[default] Displacement, Velocity, Acceleration }

/// MOTION
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Motion {
    pub place: Place,
    pub driven: Driven,
    pub level: Level,
    pub function: Formula,
    pub ic_displacement: Option<f64>,
    pub ic_velocity: Option<f64>,
}

impl Element for Motion {
    placed!();
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

impl Element for Coupler {
    placed!();
    fn references(&self) -> Vec<Named> {
        names_each(ElementKind::Joint, "JOINTS", &self.joints)
    }
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        self.user.iter().map(|f| ("FUNCTION", f)).collect()
    }
}

/// GEAR
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Gear {
    pub place: Place,
    pub joints: [u32; 2],
    pub cv: u32,
}

impl Element for Gear {
    placed!();
    fn references(&self) -> Vec<Named> {
        let mut all = names_each(ElementKind::Joint, "JOINTS", &self.joints);
        all.extend(names(ElementKind::Marker, [("CV", self.cv)]));
        all
    }
}

/// GCON: expression = 0
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct GeneralConstraint {
    pub place: Place,
    pub i: Option<u32>,
    pub function: Formula,
}

impl Element for GeneralConstraint {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Marker, [("I", self.i)])
    }
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        vec![("FUNCTION", &self.function)]
    }
}

/// CURVE: a B-spline through or near the rows of a MATRIX, or computed by a routine.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Curve {
    pub place: Place,
    pub closed: bool,
    /// one more than the degree of the pieces; 4 when absent
    pub order: Option<u32>,
    /// MATRIX with one row x, y, z per point
    pub matrix: Option<u32>,
    /// CURVE_POINTS: the rows lie on the curve; otherwise they are control points
    pub through_points: bool,
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
#[allow(missing_docs)]
pub struct PointOnCurve {
    pub place: Place,
    pub curve: u32,
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
#[allow(missing_docs)]
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
#[allow(missing_docs)]
pub struct CurveOnCurve {
    pub place: Place,
    pub i: CurveSide,
    pub j: CurveSide,
}

impl Element for CurveOnCurve {
    placed!();
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
