//! Forces: SFORCE, VFORCE, VTORQUE, GFORCE, SPRINGDAMPER, BUSHING, FIELD, BEAM, NFORCE,
//! CONTACT, FRICTION.

use super::element::{Element, ElementKind, Named, names, names_each, placed};
use super::{Formula, Place};
use crate::physics::{bushing, spring_damper};

/// SFORCE: a force along the line between two markers, or a torque about z of J.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SingleForce {
    /// where it stands in the dataset
    pub place: Place,
    /// ROTATION: a torque rather than a force
    pub rotational: bool,
    /// I marker, on which it acts
    pub i: u32,
    /// J marker, on which the reaction acts
    pub j: u32,
    /// ACTIONONLY: nothing feels the reaction, and the force acts along z of J
    pub action_only: bool,
    /// FUNCTION: force (positive drives the markers apart) or torque
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
    // of a force without reaction, J says the direction only
    fn ends(&self) -> Option<[u32; 2]> {
        (!self.action_only).then_some([self.i, self.j])
    }
}

/// Arguments that give the components of a force and a torque.
pub const COMPONENTS: [&str; 6] = ["FX", "FY", "FZ", "TX", "TY", "TZ"];

/// VFORCE, VTORQUE, GFORCE: components in the axes of `rm`, on I; the reaction acts on the part of
/// `jfloat`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VectorForce {
    /// where it stands in the dataset
    pub place: Place,
    /// I marker, on which it acts
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

/// SPRINGDAMPER: a linear spring with a damper along the line IJ, or about z of J.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpringDamper {
    /// where it stands in the dataset
    pub place: Place,
    /// ROTATION: a torque rather than a force
    pub rotational: bool,
    /// I marker
    pub i: u32,
    /// J marker
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

impl From<&SpringDamper> for spring_damper::SpringDamper {
    fn from(s: &SpringDamper) -> Self {
        Self {
            rotational: s.rotational,
            stiffness: s.stiffness,
            damping: s.damping,
            free: s.free,
            preload: s.preload,
        }
    }
}

/// BUSHING: three linear springs with dampers along, and three about, the axes of J.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bushing {
    /// where it stands in the dataset
    pub place: Place,
    /// I marker
    pub i: u32,
    /// J marker
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

impl From<&Bushing> for bushing::Bushing {
    fn from(b: &Bushing) -> Self {
        Self {
            stiffness: b.stiffness,
            damping: b.damping,
            preload: b.preload,
        }
    }
}

/// FIELD: six displacements to six forces by full matrices, in J axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Field {
    /// where it stands in the dataset
    pub place: Place,
    /// I marker
    pub i: u32,
    /// J marker
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

/// The treatment of large displacements by a BEAM.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BeamFormulation {
    /// LINEAR: small displacements
    #[default]
    Linear,
    /// STRING: tension stiffens
    String,
    /// NONLINEAR: large displacements
    Nonlinear,
}

/// BEAM: a massless beam; J at the root, I at the tip, x of J along the undeflected beam.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Beam {
    /// where it stands in the dataset
    pub place: Place,
    /// I marker, at the tip
    pub i: u32,
    /// J marker, at the root
    pub j: u32,
    /// LENGTH: undeflected length along x of J
    pub length: f64,
    /// second moments of area about x (torsion constant), y, z
    pub second_moments: [f64; 3],
    /// AREA: area of the cross section
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
    /// FORMULATION
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
pub struct NodalForce {
    /// where it stands in the dataset
    pub place: Place,
    /// IMARKERS
    pub i: Vec<u32>,
    /// J marker, against which the others move
    pub j: u32,
    /// KMATRIX: MATRIX of six rows and columns for each I marker
    pub stiffness: u32,
    /// CMATRIX: MATRIX of the same size
    pub damping: Option<u32>,
    /// CRATIO: damping = ratio · stiffness   in units of time
    pub damping_ratio: Option<f64>,
    /// LENGTH: MATRIX of the displacements at which the forces are the preload
    pub free: Option<u32>,
    /// FORCE: MATRIX of the forces there
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactLaw {
    /// IMPACT: a stiffening spring with a damper
    #[default]
    Impact,
    /// POISSON: a penalty with a coefficient of restitution
    Poisson,
    /// FUNCTION=USER(…)
    User,
}

/// The part of a CONTACT in which there is Coulomb friction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CoulombFriction {
    /// OFF
    #[default]
    Off,
    /// ON
    On,
    /// DYNAMICS_ONLY: not in statics
    DynamicsOnly,
}

/// CONTACT: forces where GRAPHICS touch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contact {
    /// where it stands in the dataset
    pub place: Place,
    /// TYPE: SOLID_TO_SOLID, POINT_TO_CURVE …
    pub kind: Option<String>,
    /// IGEOM: GRAPHICS on one side
    pub i_geometry: Vec<u32>,
    /// JGEOM: GRAPHICS on the other
    pub j_geometry: Vec<u32>,
    /// IMPACT, POISSON or FUNCTION: the normal law
    pub law: ContactLaw,
    /// STIFFNESS: force at unit depth, IMPACT   [force/length^exponent]
    pub stiffness: f64,
    /// DAMPING: largest damping, IMPACT   [force·time/length]
    pub damping: f64,
    /// penetration at which the damping is fully there
    pub dmax: f64,
    /// EXPONENT of the depth, IMPACT
    pub exponent: f64,
    /// PENALTY: stiffness of POISSON   [force/length]
    pub penalty: f64,
    /// RESTITUTION_COEFFICIENT, POISSON: 0 plastic to 1 elastic
    pub restitution: f64,
    /// COULOMB_FRICTION
    pub friction: CoulombFriction,
    /// MU_STATIC: coefficient at the stiction transition velocity
    pub mu_static: f64,
    /// MU_DYNAMIC: coefficient beyond the friction transition velocity
    pub mu_dynamic: f64,
    /// STICTION_TRANSITION_VELOCITY   [length/time]
    pub stiction_transition_velocity: f64,
    /// FRICTION_TRANSITION_VELOCITY   [length/time]
    pub friction_transition_velocity: f64,
    /// STICTION=ON
    pub stiction: bool,
    /// MAX_STICTION_DEFORMATION   a length
    pub max_stiction_deformation: Option<f64>,
    /// IFLIP, JFLIP: the outside of the geometry is its inside
    pub flip: [bool; 2],
    /// AUGMENTED_LAGRANGIAN_FORMULATION
    pub augmented_lagrangian: bool,
    /// FUNCTION=USER(…): the force along the normal
    pub function: Option<Formula>,
    /// FRICTION_FUNCTION=USER(…): the force across it
    pub friction_function: Option<Formula>,
}

/// An argument that the law IMPACT of a CONTACT needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MissingOfImpact {
    /// STIFFNESS
    Stiffness,
    /// EXPONENT
    Exponent,
    /// DMAX, with DAMPING
    Dmax,
}

impl MissingOfImpact {
    /// Returns a usual value, in a sentence.
    pub fn advice(self) -> &'static str {
        match self {
            Self::Stiffness => "STIFFNESS=1E5 is usual for steel, in N/mm",
            Self::Exponent => {
                "EXPONENT=2.2 is usual for steel, 1.5 for a sphere after Hertz, 1 for a linear spring"
            }
            Self::Dmax => "DMAX=0.1 is usual in mm: the depth at which the damping is fully there",
        }
    }
}

impl std::fmt::Display for MissingOfImpact {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Stiffness => "IMPACT without STIFFNESS: nothing keeps its bodies apart",
            Self::Exponent => "IMPACT without EXPONENT: its force would be STIFFNESS at any depth",
            Self::Dmax => {
                "DAMPING without DMAX: it says from which depth on the damping is fully there"
            }
        })
    }
}

impl Contact {
    /// Returns what the law IMPACT needs and does not have.
    pub fn missing(&self) -> Vec<MissingOfImpact> {
        let needed = [
            (self.stiffness == 0.0, MissingOfImpact::Stiffness),
            (self.exponent == 0.0, MissingOfImpact::Exponent),
            (
                self.damping != 0.0 && self.dmax == 0.0,
                MissingOfImpact::Dmax,
            ),
        ];
        needed.into_iter().filter(|n| n.0).map(|n| n.1).collect()
    }
}

impl Element for Contact {
    placed!();
    fn references(&self) -> Vec<Named> {
        let mut all = names_each(ElementKind::Graphics, "IGEOM", &self.i_geometry);
        all.extend(names_each(ElementKind::Graphics, "JGEOM", &self.j_geometry));
        all
    }
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        let normal = self.function.iter().map(|f| ("FUNCTION", f));
        let friction = self.friction_function.iter();
        normal
            .chain(friction.map(|f| ("FRICTION_FUNCTION", f)))
            .collect()
    }
}

/// FRICTION in a joint; `None` = the documented default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Friction {
    /// where it stands in the dataset
    pub place: Place,
    /// JOINT
    pub joint: u32,
    /// MU_STATIC: coefficient at the stiction transition velocity
    pub mu_static: f64,
    /// MU_DYNAMIC: coefficient beyond it
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
    /// FORMULATION=LUGRE: bristles that bend with the velocity, in place of sticking and sliding
    pub lugre: bool,
}

impl Element for Friction {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Joint, [("JOINT", self.joint)])
    }
}
