//! Bodies and the frames fixed in them: PART, POINT_MASS, MARKER.

use super::Place;
use super::element::{Element, ElementId, ElementKind, Named, names, placed};

/// The orientation of a part or marker, as written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Orientation {
    /// that of the parent
    #[default]
    Aligned,
    /// body-fixed 3-1-3 angles ψ, θ, φ, in rad
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
pub struct Part {
    /// where it stands in the dataset
    pub place: Place,
    /// GROUND: the part that does not move
    pub ground: bool,
    /// MASS; 0 when absent
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
    /// VM: marker whose axes `velocity` has
    pub vm: Option<u32>,
    /// WM: marker whose axes `angular_velocity` has
    pub wm: Option<u32>,
    /// EXACT: x, y, z, ψ, θ, φ that assembly should keep
    pub exact: [bool; 6],
}

/// The body that a marker is fixed in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkerOwner {
    /// a PART, by its number
    Part(u32),
    /// a POINT_MASS, by its number
    PointMass(u32),
    /// a FLEX_BODY, FE_PART or CURVE: read, not solved
    Other(ElementId),
}

impl MarkerOwner {
    /// Returns the part or point mass; `None` for owners that are not solved.
    pub fn body(self) -> Option<ElementId> {
        match self {
            MarkerOwner::Part(n) => Some(ElementKind::Part.id(n)),
            MarkerOwner::PointMass(n) => Some(ElementKind::PointMass.id(n)),
            MarkerOwner::Other(_) => None,
        }
    }
}

impl Default for MarkerOwner {
    fn default() -> Self {
        MarkerOwner::Part(0)
    }
}

/// MARKER: a frame fixed in a part, or floating.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marker {
    /// where it stands in the dataset
    pub place: Place,
    /// the body it is fixed in
    pub owner: MarkerOwner,
    /// origin in the part frame
    pub qp: [f64; 3],
    /// orientation in the part frame
    pub orientation: Orientation,
    /// its frame is set by the element that owns it
    pub floating: bool,
}

impl Element for Part {
    placed!();
    fn references(&self) -> Vec<Named> {
        let markers = [
            ("CM", self.cm),
            ("IM", self.im),
            ("VM", self.vm),
            ("WM", self.wm),
        ];
        names(ElementKind::Marker, markers)
    }
}

impl Element for Marker {
    placed!();
    fn references(&self) -> Vec<Named> {
        let body = self.owner.body();
        body.map(|b| (b.kind.keyword(), b)).into_iter().collect()
    }
}
