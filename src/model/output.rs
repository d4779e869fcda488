//! Output statements: REQUEST, MREQUEST, GRAPHICS.

use super::element::{Element, ElementKind, Named, names, placed};
use super::{Formula, Place};

/// The quantity that a REQUEST asks for.
#[derive(Clone, Debug, PartialEq)]
pub enum RequestKind {
    /// DISPLACEMENT of I from J, in the axes of RM
    Displacement {
        /// I marker
        i: u32,
        /// J marker
        j: Option<u32>,
        /// marker whose axes the components have; ground when absent
        rm: Option<u32>,
    },
    /// VELOCITY of I from J, in the axes of RM
    Velocity {
        /// I marker
        i: u32,
        /// J marker
        j: Option<u32>,
        /// marker whose axes the components have; ground when absent
        rm: Option<u32>,
    },
    /// ACCELERATION of I from J, in the axes of RM
    Acceleration {
        /// I marker
        i: u32,
        /// J marker
        j: Option<u32>,
        /// marker whose axes the components have; ground when absent
        rm: Option<u32>,
    },
    /// FORCE between I and J, in the axes of RM
    Force {
        /// I marker
        i: u32,
        /// J marker
        j: Option<u32>,
        /// marker whose axes the components have; ground when absent
        rm: Option<u32>,
    },
    /// F1 to F8
    Functions(Box<[Option<Formula>; 8]>),
    /// FUNCTION=USER(…)
    User(Formula),
}

impl Default for RequestKind {
    fn default() -> Self {
        RequestKind::Functions(Box::default())
    }
}

/// REQUEST: up to eight components among the results.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Request {
    /// where it stands in the dataset
    pub place: Place,
    /// the quantity that is asked for
    pub kind: RequestKind,
    /// COMMENT
    pub comment: Option<String>,
    /// TITLE: headings of the components
    pub title: Vec<String>,
    /// RESULTS_NAME: name of the set of results
    pub results_name: Option<String>,
    /// CNAMES: names of the components
    pub cnames: Vec<String>,
    /// CUNITS: their units
    pub cunits: Vec<String>,
    /// CLABELS: their labels
    pub clabels: Vec<String>,
}

impl Element for Request {
    placed!();
    fn references(&self) -> Vec<Named> {
        match self.kind {
            RequestKind::Displacement { i, j, rm }
            | RequestKind::Velocity { i, j, rm }
            | RequestKind::Acceleration { i, j, rm }
            | RequestKind::Force { i, j, rm } => {
                names(ElementKind::Marker, [("I", Some(i)), ("J", j), ("RM", rm)])
            }
            RequestKind::Functions(_) | RequestKind::User(_) => Vec::new(),
        }
    }
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        const NAMES: [&str; 8] = ["F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8"];
        match &self.kind {
            RequestKind::Functions(all) => {
                let all = NAMES.into_iter().zip(all.iter());
                all.filter_map(|(name, f)| Some((name, f.as_ref()?)))
                    .collect()
            }
            RequestKind::User(f) => vec![("FUNCTION", f)],
            RequestKind::Displacement { .. }
            | RequestKind::Velocity { .. }
            | RequestKind::Acceleration { .. }
            | RequestKind::Force { .. } => Vec::new(),
        }
    }
}

/// The four kinds of quantity a MREQUEST asks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quantity {
    /// DISPLACEMENT
    #[default]
    Displacement,
    /// VELOCITY
    Velocity,
    /// ACCELERATION
    Acceleration,
    /// FORCE
    Force,
}

/// MREQUEST: the same quantity of many elements; each list is ALL or numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ManyRequests {
    /// where it stands in the dataset
    pub place: Place,
    /// the quantity
    pub quantity: Quantity,
    /// PARTS
    pub parts: Vec<String>,
    /// JOINTS
    pub joints: Vec<String>,
    /// JPRIMS
    pub primitives: Vec<String>,
    /// APPFORS: applied forces
    pub forces: Vec<String>,
    /// RM: marker whose axes the components have; ground when absent
    pub rm: Option<u32>,
    /// COMMENT
    pub comment: Option<String>,
}

impl Element for ManyRequests {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Marker, [("RM", self.rm)])
    }
}

/// The shape that a GRAPHICS statement draws; lengths in model units, `cm` and `rm` are markers.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Shape {
    /// corner marker and extents along its axes, signed
    Box {
        /// marker at a corner
        corner: u32,
        /// extents along its x, y, z, signed
        size: [f64; 3],
    },
    /// from `cm` along its z
    Cylinder {
        /// marker at the centre, or the middle of the bottom
        cm: u32,
        /// along z of `cm`
        length: f64,
        /// radius
        radius: f64,
    },
    /// from `cm` along its z, from radius `bottom` to radius `top`
    Frustum {
        /// marker at the centre, or the middle of the bottom
        cm: u32,
        /// along z of `cm`
        length: f64,
        /// radius at the far end
        top: f64,
        /// radius at `cm`
        bottom: f64,
    },
    /// full diameters along the axes of `cm`
    Ellipsoid {
        /// marker at the centre, or the middle of the bottom
        cm: u32,
        /// along x, y, z
        diameters: [f64; 3],
    },
    /// about z of `cm`: radius of the ring, of the tube
    Torus {
        /// marker at the centre, or the middle of the bottom
        cm: u32,
        /// radius of the circle in the middle of the tube
        ring: f64,
        /// radius of the tube
        tube: f64,
    },
    /// a rectangle in the x–y plane of `rm`, its z outwards; unlimited where a bound is absent
    Plane {
        /// marker in whose frame it stands
        rm: u32,
        /// least and greatest x
        x: [Option<f64>; 2],
        /// least and greatest y
        y: [Option<f64>; 2],
    },
    /// about z of `cm`
    Circle {
        /// marker at the centre
        cm: u32,
        /// radius
        radius: f64,
    },
    /// of a circle about z of `cm`, by an angle from its x axis on
    Arc {
        /// marker at the centre
        cm: u32,
        /// radius
        radius: f64,
        /// from its x axis on, in rad
        angle: f64,
    },
    /// at the origin of `rm`
    Point {
        /// marker in whose frame it stands
        rm: u32,
    },
    /// a CURVE in the coordinates of `rm`
    Curve {
        /// the CURVE
        curve: u32,
        /// marker in whose frame it stands
        rm: u32,
    },
    /// a solid in a file of another program
    External {
        /// marker in whose frame it stands
        rm: u32,
        /// name of the file
        file: String,
        /// the element of the file that is meant
        element: Option<String>,
    },
    /// polygons in a file
    Shell {
        /// marker in whose frame it stands
        rm: u32,
        /// name of the file
        file: String,
    },
    /// by its keyword; arguments in the place's `extra`
    Other(String),
    /// none is given
    #[default]
    Nothing,
}

/// GRAPHICS: a shape that is drawn, and that a CONTACT may touch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Graphics {
    /// where it stands in the dataset
    pub place: Place,
    /// the shape
    pub shape: Shape,
}

impl Element for Graphics {
    placed!();
    fn references(&self) -> Vec<Named> {
        let mut all = Vec::new();
        let (name, marker) = match self.shape {
            Shape::Box { corner, .. } => ("CORNER", corner),
            Shape::Cylinder { cm, .. }
            | Shape::Frustum { cm, .. }
            | Shape::Ellipsoid { cm, .. }
            | Shape::Torus { cm, .. }
            | Shape::Circle { cm, .. }
            | Shape::Arc { cm, .. } => ("CM", cm),
            Shape::Plane { rm, .. }
            | Shape::Point { rm }
            | Shape::External { rm, .. }
            | Shape::Shell { rm, .. } => ("RM", rm),
            Shape::Curve { curve, rm } => {
                all.extend(names(ElementKind::Curve, [("CID", curve)]));
                ("CRM", rm)
            }
            Shape::Other(_) | Shape::Nothing => return all,
        };
        all.extend(names(ElementKind::Marker, [(name, marker)]));
        all
    }
}

/// A statement that is kept but carries no mechanics here (MATERIAL, SECTION, FE_PART …): its
/// arguments stand in the `extra` of its place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OtherElement {
    /// where it stands in the dataset
    pub place: Place,
}

impl Element for OtherElement {
    placed!();
}
