//! Contacts that cannot be solved: why, and the sentences made of it.

use crate::model::ElementId;
use std::fmt;

/// The reason why the touches of a CONTACT cannot be found.
#[derive(Clone, Debug, PartialEq)]
pub enum Untouchable {
    /// a GRAPHICS does not exist
    Missing(ElementId),
    /// the CURVE of a GRAPHICS does not exist
    NoCurve(ElementId),
    /// a curve is not plane
    NotPlane {
        /// the CURVE
        curve: ElementId,
        /// the GRAPHICS that draws it
        graphics: ElementId,
        /// how far it leaves the x-y plane of its marker   \[length\]
        height: f64,
    },
    /// the file of a shell cannot be used
    NotRead {
        /// the GRAPHICS that names it
        graphics: ElementId,
        /// the words of the reader of files: "stands in the file …, which …"
        why: String,
    },
    /// nobody has read the file of a shell
    NotAsked {
        /// the GRAPHICS that names it
        graphics: ElementId,
        /// the file, as the dataset names it
        file: String,
    },
    /// the shape is drawn, but has no surface
    Drawn {
        /// the GRAPHICS
        graphics: ElementId,
        /// keyword of the shape
        shape: String,
    },
    /// a GRAPHICS has no shape
    NoShape(ElementId),
    /// a GRAPHICS has no size
    NoSize(ElementId),
    /// IFLIP or JFLIP with a solid
    FlippedSolid(ElementId),
    /// two shapes do not touch
    NoPair {
        /// name of the shape of I, and its GRAPHICS
        i: (&'static str, ElementId),
        /// those of J
        j: (&'static str, ElementId),
        /// why
        why: NoPair,
    },
}

/// The reason why two shapes do not touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoPair {
    /// both are planes
    Planes,
    /// both are points
    Points,
    /// their distance is known only with the feature `geometry`
    NoGeometry,
}

impl fmt::Display for Untouchable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing(graphics) => write!(f, "{graphics} does not exist"),
            Self::NoCurve(graphics) => write!(f, "{graphics} has no curve"),
            Self::NotPlane {
                curve,
                graphics,
                height,
            } => write!(
                f,
                "{curve} of {graphics} leaves the x-y plane of its marker by {height:.4} along z: only plane curves touch"
            ),
            Self::NotRead { graphics, why } => write!(f, "{graphics} {why}"),
            Self::NotAsked { graphics, file } => {
                write!(f, "{graphics} stands in {file:?}, which was not asked for")
            }
            Self::Drawn { graphics, shape } => {
                write!(f, "{graphics} is {shape}, for which there is no contact")
            }
            Self::NoShape(graphics) => write!(f, "{graphics} has no shape"),
            Self::NoSize(graphics) => write!(f, "{graphics} has no size"),
            Self::FlippedSolid(graphics) => write!(
                f,
                "IFLIP and JFLIP turn a curve over, but {graphics} is a solid, which has its outside outside: leave the flag out"
            ),
            Self::NoPair { i, j, why } => write!(
                f,
                "there is no contact between a {} ({}) and a {} ({}){why}",
                i.0, i.1, j.0, j.1
            ),
        }
    }
}

impl fmt::Display for NoPair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Planes => {
                ": planes have no end, so that they meet everywhere or never; draw the side that moves as a BOX"
            }
            Self::Points => {
                ": points have no size and pass each other; draw one of them as a sphere, an ELLIPSOID with three equal scales"
            }
            Self::NoGeometry => {
                " in this program: it was built without the feature geometry"
            }
        })
    }
}
