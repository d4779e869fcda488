//! What is asked for and what is shown: REQUEST, MREQUEST, GRAPHICS.

use super::element::{Element, ElementKind, Named, names, placed};
use super::{Formula, Place};

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

impl Default for RequestKind {
    fn default() -> Self {
        RequestKind::Functions(Box::default())
    }
}

/// REQUEST
#[derive(Clone, Debug, Default, PartialEq)]
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
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[rustfmt::skip]
pub enum Quantity { #[default] Displacement, Velocity, Acceleration, Force }

/// MREQUEST: the same quantity of many elements; each list is ALL or numbers
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct ManyRequests {
    pub place: Place,
    pub quantity: Quantity,
    pub parts: Vec<String>,
    pub joints: Vec<String>,
    pub primitives: Vec<String>,
    pub forces: Vec<String>,
    pub rm: Option<u32>,
    pub comment: Option<String>,
}

impl Element for ManyRequests {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(ElementKind::Marker, [("RM", self.rm)])
    }
}

/// What a GRAPHICS statement draws; lengths in model units, `cm` and `rm` are markers.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub enum Shape {
    /// corner marker and extents along its axes, signed
    Box {
        corner: u32,
        size: [f64; 3],
    },
    /// from `cm` along its z
    Cylinder {
        cm: u32,
        length: f64,
        radius: f64,
    },
    /// from `cm` along its z, from radius `bottom` to radius `top`
    Frustum {
        cm: u32,
        length: f64,
        top: f64,
        bottom: f64,
    },
    /// full diameters along the axes of `cm`
    Ellipsoid {
        cm: u32,
        diameters: [f64; 3],
    },
    /// about z of `cm`: radius of the ring, of the tube
    Torus {
        cm: u32,
        ring: f64,
        tube: f64,
    },
    /// a rectangle in the x–y plane of `rm`, its z outwards; unlimited where a bound is absent
    Plane {
        rm: u32,
        x: [Option<f64>; 2],
        y: [Option<f64>; 2],
    },
    Circle {
        cm: u32,
        radius: f64,
    },
    /// of a circle about z of `cm`, by an angle from its x axis on
    Arc {
        cm: u32,
        radius: f64,
        angle: f64,
    },
    Point {
        rm: u32,
    },
    /// a CURVE in the coordinates of `rm`
    Curve {
        curve: u32,
        rm: u32,
    },
    External {
        rm: u32,
        file: String,
        element: Option<String>,
    },
    /// polygons in a file
    Shell {
        rm: u32,
        file: String,
    },
    /// by its keyword; arguments in the place's `extra`
    Other(String),
    #[default]
    Nothing,
}

/// GRAPHICS
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Graphics {
    pub place: Place,
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

/// A statement that is kept but carries no mechanics here (MATERIAL, SECTION, FE_PART …): arguments in the place's `extra`.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct OtherElement {
    pub place: Place,
}

impl Element for OtherElement {
    placed!();
}
