//! Inputs that functions ask for and the equations of a scene cannot supply: as data, and as the
//! sentence that the user reads.

use crate::diagnostic::{Cause, Diagnostic};
use crate::expr::measures::{Measure, orientation_components};
use crate::model::{ElementId, ElementKind};
use crate::scene::asker::Asker;
use std::fmt;

/// A number that somebody asks for and that the equations cannot supply.
#[derive(Clone, Debug, PartialEq)]
pub struct Unsupported {
    /// who asks
    pub asked_by: Asker,
    /// what is lacking
    pub lack: Lack,
}

/// The thing that is lacking where a number cannot be supplied.
#[derive(Clone, Debug, PartialEq)]
pub enum Lack {
    /// a solution: the value depends on itself where nothing solves for it
    OwnValue,
    /// a value outside of the loop that it belongs to
    OutsideLoop,
    /// an equation that determines the value of a loop
    LoopEquation,
    /// an acceleration that does not depend on the function that asks for it
    OwnAcceleration(Measure),
    /// a reaction that does not depend on the function that asks for it
    OwnReaction(Measure),
    /// the rate of a measure, without accelerations
    Rate(Measure),
    /// an element
    Element(ElementId),
    /// an active element
    ActiveElement(ElementId),
    /// an active NFORCE of this number that acts on a marker
    NodalForce {
        /// user's number of the NFORCE
        id: u32,
        /// user's number of the MARKER
        marker: u32,
    },
    /// an entry of an ARRAY, PINPUT or POUTPUT
    Entry {
        /// which
        element: ElementId,
        /// from 1 on
        entry: u32,
    },
    /// a marker that the measure names
    Marker(Measure),
    /// a component of a force
    Component(u32),
    /// a component of a FRICTION
    FrictionComponent(u32),
    /// the meaning of a system of angles of ORIENT
    Orientation {
        /// number of the system
        system: u32,
        /// number of the component
        component: u32,
    },
    /// a component of a system of angles of ORIENT
    OrientationComponent {
        /// number of the system
        system: u32,
        /// number of the component
        component: u32,
    },
    /// the equations of a measure
    Measure(Measure),
    /// a closure that does not read its own result
    OwnResult,
    /// an outline of a contact that is more than a point
    Outlines,
    /// a convex hull of the points of a solid
    Hull,
    /// the Cargo feature `geometry`
    Geometry,
}

impl fmt::Display for Lack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Lack::OwnValue => f.write_str("it depends on itself"),
            Lack::OutsideLoop => f.write_str("it is known only where its loop is solved"),
            Lack::LoopEquation => f.write_str(
                "its loop has no solution, or any: nothing determines the value that it reads of itself",
            ),
            Lack::OwnAcceleration(measure) => write!(
                f,
                "{} reads an acceleration that depends on this very function",
                measure.name()
            ),
            Lack::OwnReaction(measure) => write!(
                f,
                "{} reads a reaction that depends on this very function",
                measure.name()
            ),
            Lack::Rate(measure) => write!(
                f,
                "{} has no rate that is known here, which DIF1 asks for",
                measure.name()
            ),
            Lack::Element(element) => write!(f, "{element} does not exist"),
            Lack::ActiveElement(element) => {
                write!(f, "{element} does not exist or is not active")
            }
            Lack::NodalForce { id, marker } => write!(
                f,
                "{} does not exist, is not active, or does not act on {}",
                ElementKind::Nforce.id(id),
                ElementKind::Marker.id(marker)
            ),
            Lack::Entry { element, entry } => write!(f, "{element} has no entry {entry}"),
            Lack::Marker(measure) => write!(
                f,
                "{} names a marker that does not exist, is FLOATING or is left out",
                measure.name()
            ),
            Lack::Component(k) => write!(f, "component {k} does not exist"),
            Lack::FrictionComponent(k) => write!(
                f,
                "component {k} of FRICTION is not solved: there are force (1 to 3), torque (4 to 6), sliding velocity (14 to 16) and angular velocity (17 to 19)"
            ),
            Lack::Orientation { system, component } => write!(
                f,
                "ORIENT({system}, {component}, …): what system {system} means is not documented; \
                 YAW, PITCH and ROLL, AX, AY and AZ, or another system (`cognate functions ORIENT`) give an orientation"
            ),
            Lack::OrientationComponent { system, component } => write!(
                f,
                "ORIENT({system}, {component}, …): system {system} has components 1 to {}",
                orientation_components(system)
            ),
            Lack::Measure(measure) => write!(f, "{} is not solved yet", measure.name()),
            Lack::OwnResult => f.write_str("its closure reads what depends on its own result"),
            Lack::Outlines => f.write_str("both of its outlines are points, which never touch"),
            Lack::Hull => f.write_str("the points of one of its solids have no convex hull"),
            Lack::Geometry => f.write_str("needs the feature geometry"),
        }
    }
}

impl fmt::Display for Unsupported {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.asked_by, self.lack)
    }
}

impl Unsupported {
    /// Says so of an element or a function.
    pub fn new(asked_by: impl Into<Asker>, lack: Lack) -> Self {
        Self {
            asked_by: asked_by.into(),
            lack,
        }
    }

    /// Makes an error of it, about the function that asks.
    pub fn error(&self) -> Diagnostic {
        Diagnostic::error(Cause::Unsupported, self.lack.to_string()).element(&self.asked_by)
    }

    /// Makes a warning of it: the column that asks is empty.
    pub fn warning(&self) -> Diagnostic {
        Diagnostic::warning("unavailable", self.lack.to_string()).element(&self.asked_by)
    }
}
