//! What pushes: SFORCE, VFORCE, VTORQUE, GFORCE, SPRINGDAMPER, BUSHING, FIELD, BEAM, NFORCE, CONTACT, FRICTION.

use super::element::{Element, ElementKind, Named, names, names_each, placed};
use super::{Formula, Place};

/// SFORCE
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct SingleForce {
    pub place: Place,
    pub rotational: bool,
    pub i: u32,
    pub j: u32,
    pub action_only: bool,
    pub function: Formula,
}

impl Element for SingleForce {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Marker, [("I", self.i), ("J", self.j)])
    }
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        vec![("FUNCTION", &self.function)]
    }
}

/// Arguments that give the components of a force and a torque.
pub const COMPONENTS: [&str; 6] = ["FX", "FY", "FZ", "TX", "TY", "TZ"];

/// VFORCE, VTORQUE, GFORCE: components in the axes of `rm`, on I; the reaction acts on the part of `jfloat`.
#[derive(Clone, Debug, Default, PartialEq)]
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

impl Element for VectorForce {
    placed!();
    fn references(&self) -> Vec<Named> {
        let mut all = names(ElementKind::Marker, [("I", self.i)]);
        let optional = [("JFLOAT", self.jfloat), ("RM", self.rm)];
        all.extend(names(ElementKind::Marker, optional));
        all
    }
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        let components = COMPONENTS
            .into_iter()
            .zip(self.force.iter().chain(&self.torque));
        let given = components.filter_map(|(name, f)| Some((name, f.as_ref()?)));
        given
            .chain(self.user.iter().map(|f| ("FUNCTION", f)))
            .collect()
    }
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
    /// LENGTH or ANGLE, in rad
    pub free: f64,
}

impl Element for SpringDamper {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Marker, [("I", self.i), ("J", self.j)])
    }
    fn ends(&self) -> Option<[u32; 2]> {
        Some([self.i, self.j])
    }
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

impl Element for Bushing {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Marker, [("I", self.i), ("J", self.j)])
    }
    fn ends(&self) -> Option<[u32; 2]> {
        Some([self.i, self.j])
    }
}

/// FIELD: six displacements to six forces by full matrices, in J axes.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Field {
    pub place: Place,
    pub i: u32,
    pub j: u32,
    /// KMATRIX, 36 numbers by columns; empty when not given
    pub stiffness: Vec<f64>,
    /// CMATRIX, 36 numbers by columns; empty when not given
    pub damping: Vec<f64>,
    /// CRATIO: damping = ratio · stiffness
    pub damping_ratio: Option<f64>,
    /// LENGTH: displacements at which the spring force is zero; angles in radians
    pub free: [f64; 6],
    /// FORCE
    pub preload: [f64; 6],
    /// FUNCTION=USER(…)
    pub function: Option<Formula>,
}

impl Element for Field {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Marker, [("I", self.i), ("J", self.j)])
    }
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        self.function.iter().map(|f| ("FUNCTION", f)).collect()
    }
    fn ends(&self) -> Option<[u32; 2]> {
        Some([self.i, self.j])
    }
}

/// How a BEAM treats large displacements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum BeamFormulation {
    #[default]
    Linear,
    String,
    Nonlinear,
}

/// BEAM: J at the root, I at the tip, x of J along the undeflected beam.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Beam {
    pub place: Place,
    pub i: u32,
    pub j: u32,
    pub length: f64,
    /// second moments of area about x (torsion constant), y, z
    pub second_moments: [f64; 3],
    pub area: f64,
    /// ASY, ASZ: shear factors; 0 = no shear deformation
    pub shear: [f64; 2],
    /// EMODULUS
    pub youngs_modulus: f64,
    /// GMODULUS
    pub shear_modulus: f64,
    /// CRATIO: damping = ratio · stiffness; 0.01 when neither this nor CMATRIX is given
    pub damping_ratio: Option<f64>,
    /// CMATRIX: 21 numbers, lower triangle by rows; empty when not given
    pub damping: Vec<f64>,
    pub formulation: BeamFormulation,
}

impl Element for Beam {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Marker, [("I", self.i), ("J", self.j)])
    }
    fn ends(&self) -> Option<[u32; 2]> {
        Some([self.i, self.j])
    }
}

/// NFORCE: the linear law of FIELD between many markers, matrices given as MATRIX numbers.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct NodalForce {
    pub place: Place,
    pub i: Vec<u32>,
    pub j: u32,
    pub stiffness: u32,
    pub damping: Option<u32>,
    pub damping_ratio: Option<f64>,
    pub free: Option<u32>,
    pub preload: Option<u32>,
}

impl Element for NodalForce {
    placed!();
    fn references(&self) -> Vec<Named> {
        let mut all = names_each(ElementKind::Marker, "IMARKERS", &self.i);
        all.extend(names(ElementKind::Marker, [("J", self.j)]));
        all.extend(names(ElementKind::Matrix, [("KMATRIX", self.stiffness)]));
        let optional = [
            ("LENGTH", self.free),
            ("FORCE", self.preload),
            ("CMATRIX", self.damping),
        ];
        all.extend(names(ElementKind::Matrix, optional));
        all
    }
}

/// The normal law of a CONTACT.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[rustfmt::skip]
pub enum ContactLaw { #[default] Impact, Poisson, User }

/// When a CONTACT has Coulomb friction.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[rustfmt::skip]
pub enum CoulombFriction { #[default] Off, On, DynamicsOnly }

/// CONTACT between GRAPHICS.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Contact {
    pub place: Place,
    /// TYPE: SOLID_TO_SOLID, POINT_TO_CURVE …
    pub kind: Option<String>,
    pub i_geometry: Vec<u32>,
    pub j_geometry: Vec<u32>,
    pub law: ContactLaw,
    pub stiffness: f64,
    pub damping: f64,
    /// penetration at which the damping is fully there
    pub dmax: f64,
    pub exponent: f64,
    pub penalty: f64,
    pub restitution: f64,
    pub friction: CoulombFriction,
    pub mu_static: f64,
    pub mu_dynamic: f64,
    pub stiction_transition_velocity: f64,
    pub friction_transition_velocity: f64,
    /// STICTION=ON
    pub stiction: bool,
    pub max_stiction_deformation: Option<f64>,
    /// IFLIP, JFLIP: the outside of the geometry is its inside
    pub flip: [bool; 2],
    pub augmented_lagrangian: bool,
    /// FUNCTION=USER(…)
    pub function: Option<Formula>,
}

impl Element for Contact {
    placed!();
    fn references(&self) -> Vec<Named> {
        let mut all = names_each(ElementKind::Graphics, "IGEOM", &self.i_geometry);
        all.extend(names_each(ElementKind::Graphics, "JGEOM", &self.j_geometry));
        all
    }
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        self.function.iter().map(|f| ("FUNCTION", f)).collect()
    }
}

/// FRICTION in a joint; `None` = the documented default.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Friction {
    pub place: Place,
    pub joint: u32,
    pub mu_static: f64,
    pub mu_dynamic: f64,
    /// 0.1
    pub stiction_transition_velocity: Option<f64>,
    /// 0.01
    pub max_stiction_deformation: Option<f64>,
    /// ALL, STICTION, SLIDING
    pub effect: Option<String>,
    /// ALL, NONE or some of PRELOAD, REACTION_FORCE, BENDING_MOMENT, TORSIONAL_MOMENT
    pub inputs: Vec<String>,
    /// 0
    pub force_preload: Option<f64>,
    /// 0
    pub torque_preload: Option<f64>,
    /// 1
    pub friction_arm: Option<f64>,
    /// 1
    pub bending_reaction_arm: Option<f64>,
    /// 1
    pub pin_radius: Option<f64>,
    /// 1
    pub ball_radius: Option<f64>,
    /// 1000
    pub initial_overlap: Option<f64>,
    /// 1
    pub reaction_arm: Option<f64>,
    /// CONSTANT, INCREASE, DECREASE
    pub overlap_delta: Option<String>,
    /// INACTIVE=STATIC
    pub inactive_in_statics: bool,
}

impl Element for Friction {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Joint, [("JOINT", self.joint)])
    }
}
