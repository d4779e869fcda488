//! The TABLE of joints: a row says all that distinguishes a joint from others.
//!
//! Two columns describe the same joint. *Motions*: the joint as a chain of primitives from the J
//! marker to the I marker, for a joint that carries a part of the forest. *Rows*: the joint as
//! scalar equations between the two marker frames, for a joint that closes a loop. A property test
//! moves every joint by random motions and finds its rows zero. The other columns: the keyword, the
//! displacements along and about z that motions, couplers and initial conditions may refer to, the
//! equation between displacements, the variables among the results, and the law of friction.

use super::coupler::Gauge;
use super::friction;
use super::row::Law;
use crate::space::{Mat3, rotation};

/// One step of the chain from J to I.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// translation along axis 0 x, 1 y, 2 z
    Slide(usize),
    /// rotation about axis 0 x, 1 y, 2 z
    Turn(usize),
    /// any rotation, as a unit quaternion with the angular velocity in the turned axes
    Ball,
    /// a constant quarter turn about x, which brings the pins of a universal joint to z
    QuarterX,
}

use Law::{Along, Dot, EqualDots, Offset};
use Motion::{Ball, QuarterX, Slide, Turn};

/// The displacements of a joint along and about z of its J marker that others may refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Displacements {
    /// none
    None,
    /// a rotation
    Rotation,
    /// a translation
    Translation,
    /// a rotation and a translation, so that others must say which they mean
    Both,
}

impl Displacements {
    /// Returns whether there is a rotation.
    pub fn turns(self) -> bool {
        matches!(self, Self::Rotation | Self::Both)
    }

    /// Returns whether there is a translation.
    pub fn slides(self) -> bool {
        matches!(self, Self::Translation | Self::Both)
    }

    /// Returns whether the displacement that is meant is a rotation; `said`: a rotation (true) or a
    /// translation (false), where that has been said.
    ///
    /// # Errors
    /// There is no such displacement, or it must be said which.
    pub fn chosen(self, said: Option<bool>) -> Result<bool, Unclear> {
        match (self, said) {
            (Self::Rotation, None | Some(true)) => Ok(true),
            (Self::Translation, None | Some(false)) => Ok(false),
            (Self::Both, Some(turns)) => Ok(turns),
            (Self::Both, None) => Err(Unclear::Several),
            (Self::Rotation | Self::Translation, Some(turns)) => Err(Unclear::Other { turns }),
            (Self::None, _) => Err(Unclear::None),
        }
    }
}

/// The reason why it is not clear which displacement of a joint is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unclear {
    /// it has two, and none was named
    Several,
    /// it has only the other one
    Other {
        /// a rotation was asked for
        turns: bool,
    },
    /// it has none
    None,
}

/// An equation between the translation of a joint and its rotation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// PITCH of translation along z for each turn about z
    Screw,
    /// half of PD of translation along z for each radian about x
    Rack,
}

impl Relation {
    /// Returns the axis of J about which it turns: 0 x, 1 y, 2 z.
    pub fn axis(self) -> usize {
        match self {
            Self::Screw => 2,
            Self::Rack => 0,
        }
    }
}

/// A row of the table of joints.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// the keyword; the capitals at its beginning are its shortest abbreviation
    pub word: &'static str,
    /// the same in capitals
    pub keyword: &'static str,
    /// displacements that motions, couplers and initial conditions may refer to
    pub displacements: Displacements,
    /// the chain from J to I; `None` when other joints carry the parts
    pub motions: Option<&'static [Motion]>,
    /// the equations between the marker frames
    pub rows: &'static [Law],
    /// the equation between displacements that it is instead
    pub relation: Option<Relation>,
    /// variables among the results: names, and the displacements of I against J that they measure
    pub variables: &'static [(&'static str, Gauge)],
    /// the law of friction in it
    pub friction: Option<friction::Kind>,
}

const DISTANCE: (&str, Gauge) = ("DISTANCE", Gauge::Distance);
const ANGLE: (&str, Gauge) = ("ANGLE", Gauge::Angle(2));
const HOOKE_PINS: [(&str, Gauge); 2] = pins(true);
const UNIVERSAL_PINS: [(&str, Gauge); 2] = pins(false);

const fn pins(hooke: bool) -> [(&'static str, Gauge); 2] {
    let second = false;
    let first = Gauge::Pin { hooke, second };
    let second = true;
    [
        ("ANGLE_1", first),
        ("ANGLE_2", Gauge::Pin { hooke, second }),
    ]
}

/// Returns a word in capitals.
const fn capitals<const N: usize>(word: &str) -> [u8; N] {
    let mut all = [0; N];
    let mut k = 0;
    while k < N {
        all[k] = word.as_bytes()[k].to_ascii_uppercase();
        k += 1;
    }
    all
}

macro_rules! in_capitals {
    ($word:literal) => {
        const {
            const ALL: [u8; $word.len()] = capitals($word);
            match std::str::from_utf8(&ALL) {
                Ok(word) => word,
                Err(_) => $word,
            }
        }
    };
}

macro_rules! joints {
    ($(
        $(#[$meta:meta])*
        $kind:ident $word:literal $displacements:ident {
            motions: $motions:expr,
            rows: $rows:expr,
            relation: $relation:expr,
            variables: $variables:expr,
            friction: $friction:expr,
        }
    )*) => {
        /// JOINT types.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum JointKind {
            $($(#[$meta])* $kind,)*
        }

        impl JointKind {
            /// All types, in the order of the table.
            pub const ALL: [JointKind; [$(JointKind::$kind),*].len()] = [$(JointKind::$kind),*];

            /// Returns the row of the table.
            pub const fn row(self) -> &'static Row {
                match self {
                    $(Self::$kind => const { &Row {
                        word: $word,
                        keyword: in_capitals!($word),
                        displacements: Displacements::$displacements,
                        motions: $motions,
                        rows: $rows,
                        relation: $relation,
                        variables: $variables,
                        friction: $friction,
                    } },)*
                }
            }
        }
    };
}

joints! {
    /// no freedom
    #[default]
    Fixed "FIXED" None {
        motions: Some(&[]),
        rows: &[Offset(0), Offset(1), Offset(2), Dot(2, 0), Dot(2, 1), Dot(0, 1)],
        relation: None,
        variables: &[],
        friction: None,
    }
    /// turns about z
    Revolute "Revolute" Rotation {
        motions: Some(&[Turn(2)]),
        rows: &[Offset(0), Offset(1), Offset(2), Dot(2, 0), Dot(2, 1)],
        relation: None,
        variables: &[ANGLE],
        friction: Some(friction::Kind::Revolute),
    }
    /// slides along z
    Translational "Translational" Translation {
        motions: Some(&[Slide(2)]),
        rows: &[Along(0), Along(1), Dot(2, 0), Dot(2, 1), Dot(0, 1)],
        relation: None,
        variables: &[DISTANCE],
        friction: Some(friction::Kind::Translational),
    }
    /// slides along z and turns about it
    Cylindrical "Cylindrical" Both {
        motions: Some(&[Slide(2), Turn(2)]),
        rows: &[Along(0), Along(1), Dot(2, 0), Dot(2, 1)],
        relation: None,
        variables: &[DISTANCE, ANGLE],
        friction: Some(friction::Kind::Cylindrical),
    }
    /// turns about all axes
    Spherical "Spherical" None {
        motions: Some(&[Ball]),
        rows: &[Offset(0), Offset(1), Offset(2)],
        relation: None,
        variables: &[],
        friction: Some(friction::Kind::Spherical),
    }
    /// slides along x and y and turns about z
    Planar "PLANAR" None {
        motions: Some(&[Slide(0), Slide(1), Turn(2)]),
        rows: &[Along(2), Dot(2, 0), Dot(2, 1)],
        relation: None,
        variables: &[("X", Gauge::Across(0)), ("Y", Gauge::Across(1)), ANGLE],
        friction: None,
    }
    /// turns about z of J and z of I, which stay square to each other
    Universal "Universal" None {
        motions: Some(&[Turn(2), QuarterX, Turn(2)]),
        rows: &[Offset(0), Offset(1), Offset(2), Dot(2, 2)],
        relation: None,
        variables: &UNIVERSAL_PINS,
        friction: Some(friction::Kind::Pins { i: 2, j: 2 }),
    }
    /// turns about y of J and x of I, which stay square to each other
    Hooke "Hooke" None {
        motions: Some(&[Turn(1), Turn(0)]),
        rows: &[Offset(0), Offset(1), Offset(2), Dot(0, 1)],
        relation: None,
        variables: &HOOKE_PINS,
        friction: Some(friction::Kind::Pins { i: 0, j: 1 }),
    }
    /// joins two shafts that turn equally fast at any angle
    Convel "CONvel" None {
        motions: None,
        rows: &[Offset(0), Offset(1), Offset(2), EqualDots],
        relation: None,
        variables: &[],
        friction: None,
    }
    /// rolls on a rack without slipping
    Rackpin "RAckpin" None {
        motions: None,
        rows: &[],
        relation: Some(Relation::Rack),
        variables: &[DISTANCE, ("ANGLE", Gauge::Angle(0))],
        friction: None,
    }
    /// advances along z as it turns about it
    Screw "SCrew" None {
        motions: None,
        rows: &[],
        relation: Some(Relation::Screw),
        variables: &[DISTANCE, ANGLE],
        friction: None,
    }
}

impl JointKind {
    /// Returns its keyword, in capitals.
    pub const fn keyword(self) -> &'static str {
        self.row().keyword
    }

    /// Returns the displacements that motions, couplers and initial conditions may refer to.
    pub const fn displacements(self) -> Displacements {
        self.row().displacements
    }

    /// Returns whether it turns about a point: it has no angle of its own, and results show those
    /// between the axes of its markers.
    pub const fn is_ball(self) -> bool {
        matches!(self, Self::Spherical | Self::Convel)
    }
}

/// A row of the table of primitives.
#[derive(Clone, Copy, Debug)]
pub struct PrimitiveRow {
    /// the keyword; the capitals at its beginning are its shortest abbreviation
    pub word: &'static str,
    /// the same in capitals
    pub keyword: &'static str,
    /// the chain from J to I
    pub motions: &'static [Motion],
    /// the equations between the marker frames
    pub rows: &'static [Law],
}

macro_rules! primitives {
    ($(
        $(#[$meta:meta])*
        $kind:ident $word:literal { motions: $motions:expr, rows: $rows:expr, }
    )*) => {
        /// JPRIM types.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum PrimitiveKind {
            $($(#[$meta])* $kind,)*
        }

        impl PrimitiveKind {
            /// All types, in the order of the table.
            pub const ALL: [PrimitiveKind; [$(PrimitiveKind::$kind),*].len()] =
                [$(PrimitiveKind::$kind),*];

            /// Returns the row of the table.
            pub const fn row(self) -> &'static PrimitiveRow {
                match self {
                    $(Self::$kind => const { &PrimitiveRow {
                        word: $word,
                        keyword: in_capitals!($word),
                        motions: $motions,
                        rows: $rows,
                    } },)*
                }
            }
        }
    };
}

primitives! {
    /// the origins coincide
    #[default]
    Atpoint "ATpoint" {
        motions: &[Ball],
        rows: &[Offset(0), Offset(1), Offset(2)],
    }
    /// the origin of I stays on z of J
    Inline "INLine" {
        motions: &[Slide(2), Ball],
        rows: &[Along(0), Along(1)],
    }
    /// the origin of I stays in the x–y plane of J
    Inplane "INPlane" {
        motions: &[Slide(0), Slide(1), Ball],
        rows: &[Along(2)],
    }
    /// all axes stay parallel
    Orientation "Orientation" {
        motions: &[Slide(0), Slide(1), Slide(2)],
        rows: &[Dot(2, 0), Dot(2, 1), Dot(0, 1)],
    }
    /// the z axes stay parallel
    ParallelAxes "PArallel_axes" {
        motions: &[Slide(0), Slide(1), Slide(2), Turn(2)],
        rows: &[Dot(2, 0), Dot(2, 1)],
    }
    /// the z axes stay square to each other
    Perpendicular "PErpendicular" {
        motions: &[Slide(0), Slide(1), Slide(2), Turn(2), QuarterX, Turn(2)],
        rows: &[Dot(2, 2)],
    }
}

/// A tie between two markers: a joint or a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tie {
    /// JOINT
    Joint(JointKind),
    /// JPRIM
    Primitive(PrimitiveKind),
}

impl Tie {
    /// Returns the chain from J to I, or `None` when the tie is a row between bodies that other
    /// joints carry.
    pub fn motions(self) -> Option<&'static [Motion]> {
        match self {
            Tie::Joint(kind) => kind.row().motions,
            Tie::Primitive(kind) => Some(kind.row().motions),
        }
    }

    /// Returns the equations between the marker frames.
    ///
    /// SCREW and RACKPIN are equations between displacements; they have none of this kind.
    pub fn rows(self) -> &'static [Law] {
        match self {
            Tie::Joint(kind) => kind.row().rows,
            Tie::Primitive(kind) => kind.row().rows,
        }
    }

    /// Returns the equation between displacements that the tie is.
    pub fn relation(self) -> Option<Relation> {
        match self {
            Tie::Joint(kind) => kind.row().relation,
            Tie::Primitive(_) => None,
        }
    }

    /// Returns the number of freedoms that it removes between two bodies.
    pub fn removes(self) -> usize {
        self.rows().len() + usize::from(self.relation().is_some())
    }

    /// Returns whether it says anything of how its markers are turned against each other.
    pub fn holds_orientation(self) -> bool {
        self.relation().is_some() || self.rows().iter().any(|law| !law.is_length())
    }

    /// Returns whether it keeps the z axes of its markers pointing the same way.
    pub fn keeps_z(self) -> bool {
        [Dot(2, 0), Dot(2, 1)]
            .iter()
            .all(|law| self.rows().contains(law))
    }
}

impl Tie {
    /// Returns whether it keeps all axes of its markers pointing the same way.
    pub fn keeps_x(self) -> bool {
        self.keeps_z() && self.rows().contains(&Dot(0, 1))
    }
}

impl Motion {
    /// Returns the number of velocity coordinates.
    pub fn freedoms(self) -> usize {
        match self {
            Slide(_) | Turn(_) => 1,
            Ball => 3,
            QuarterX => 0,
        }
    }
}

/// Returns the constant rotation of [`Motion::QuarterX`].
pub fn quarter_x() -> Mat3<f64> {
    rotation::snapped(&rotation::about_axis(0, std::f64::consts::FRAC_PI_2))
}
