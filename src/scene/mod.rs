//! The scene: what must be computed, dense and constant; made once from a [`Model`](crate::model::Model).
//!
//! Parts hang on a forest of links, one primitive motion each; what closes loops is a row. Numbers are indices here, names
//! live in one list, and everything a run does not need has been left out before it starts.

pub mod compile;
pub mod forest;
pub mod record;
pub mod sweep;

use crate::physics::row::Law;
use crate::space::{Frame, Mat3, Vec3};

/// Index of a link in [`Scene::links`]; `None` is ground.
pub type LinkIx = Option<usize>;

/// A rigid body or a massless step of a joint, moved by at most one primitive against its parent.
#[derive(Clone, Debug)]
pub struct Link {
    /// what carries it; parents come before children
    pub parent: LinkIx,
    /// where the primitive starts, in the parent's frame
    pub placement: Frame<f64>,
    /// how it moves from there
    pub motion: LinkMotion,
    /// mass, in units in which force = mass · acceleration
    pub mass: f64,
    /// mass times position of the centre of mass, in the link's frame
    pub moment: Vec3<f64>,
    /// inertia about the link's origin, in the link's axes
    pub inertia: Mat3<f64>,
}

/// The one motion of a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LinkMotion {
    /// none
    Rigid,
    /// along `axis` by `sign` × coordinate
    Slide {
        /// 0 x, 1 y, 2 z
        axis: usize,
        /// 1, or −1 when the joint is passed from I to J
        sign: f64,
        /// index in [`Scene::coordinates`]
        coordinate: usize,
    },
    /// about `axis` by `sign` × coordinate
    Turn {
        /// 0 x, 1 y, 2 z
        axis: usize,
        /// 1, or −1 when the joint is passed from I to J
        sign: f64,
        /// index in [`Scene::coordinates`]
        coordinate: usize,
    },
    /// by a unit quaternion
    Ball {
        /// first of three consecutive coordinates (angular velocity in the link's axes)
        coordinate: usize,
        /// index of the quaternion's first number in q
        quaternion: usize,
    },
}

/// A velocity coordinate of the forest.
#[derive(Clone, Debug)]
pub struct Coordinate {
    /// the element it belongs to, with what it measures: "JOINT/3 angle"
    pub name: String,
    /// the joint it is a variable of; `None` for free parts
    pub joint: Option<u32>,
    /// whether it is an angle (else a length)
    pub angular: bool,
    /// who says what it does
    pub source: Source,
    /// the link it moves
    pub link: usize,
}

/// Who says what a coordinate does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// the equations of motion: places of its position in q and of its velocity in v; three of a ball share a quaternion,
    /// and their `q` is that of the quaternion
    Free {
        /// place in q
        q: usize,
        /// place in v
        v: usize,
    },
    /// a MOTION: index in [`Scene::motions`]
    Driven(usize),
}

/// A part: where it sits on its link.
#[derive(Clone, Debug)]
pub struct PartOnLink {
    /// user's number
    pub id: u32,
    /// POINT_MASS rather than PART
    pub point_mass: bool,
    /// what carries it
    pub link: LinkIx,
    /// part frame in the link's frame
    pub frame: Frame<f64>,
    /// part frame in ground as the dataset has it
    pub initial: Frame<f64>,
}

/// A marker: where it sits on its link.
#[derive(Clone, Debug)]
pub struct MarkerOnLink {
    /// user's number
    pub id: u32,
    /// what carries it
    pub link: LinkIx,
    /// marker frame in the link's frame
    pub frame: Frame<f64>,
    /// index in [`Scene::parts`]; `None` on ground
    pub part: Option<usize>,
}

/// One scalar constraint equation.
#[derive(Clone, Debug)]
pub struct Row {
    /// the element it comes from: "JOINT/7"
    pub element: String,
    /// Adams' name of the equation: "Zi.Xj"
    pub equation: String,
    /// what it says
    pub kind: RowKind,
}

/// What a row says.
#[derive(Clone, Debug)]
pub enum RowKind {
    /// a law between two markers (indices in [`Scene::markers`]), possibly driven by a motion
    Markers {
        /// the equation
        law: Law,
        /// I marker
        i: usize,
        /// J marker
        j: usize,
        /// index in [`Scene::motions`]
        motion: Option<usize>,
    },
    /// Σ factor · coordinate = constant
    Linear {
        /// (coordinate, factor)
        terms: Vec<(usize, f64)>,
        /// the sum in the assembled configuration
        constant: f64,
    },
}
