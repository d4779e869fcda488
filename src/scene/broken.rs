//! Contacts of PTCV and CVCV that have ended: why, in numbers, and the sentences made of them.

use super::cams::{COPLANAR_SINE, Cam, parameters};
use super::configuration::Configured;
use super::equations::Equations;
use super::layout::Layout;
use crate::model::{ElementId, ElementKind};
use crate::physics::cam::Contact;
use crate::scalar::Scalar;
use crate::space::{Frame, Vec3};
use std::fmt;

/// Distance from the common tangent, relative to the curves, beyond which there is none.
const TANGENT_TOLERANCE: f64 = 1e-6;

/// A contact of curves that has ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Broken {
    /// which PTCV or CVCV
    pub element: ElementId,
    /// why
    pub reason: Reason,
}

/// The reason why a contact of curves has ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// it has passed the end of an open curve
    CurveLeft {
        /// the CURVE
        curve: ElementId,
        /// the end is the first point of the curve, not the last
        first: bool,
        /// that end, in the coordinates of the curve
        end: Vec3<f64>,
        /// how far the parameter is beyond it
        beyond: f64,
        /// how the run would have gone on; `None` while parts are put together
        ahead: Option<Ahead>,
    },
    /// the planes of the two curves are inclined to each other
    NotCoplanar {
        /// by how much   \[deg\]
        angle: f64,
        /// the markers in whose x-y planes they lie
        markers: [ElementId; 2],
    },
    /// no point of the curve is next to I
    NoNearPoint,
    /// the two curves have no common tangent
    NoCommonTangent,
}

/// The way of a contact beyond the end of its curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ahead {
    /// speed along the curve   [length/time]
    pub speed: f64,
    /// way at that speed until the run ends   \[length\]
    pub way: f64,
    /// end of the run   \[time\]
    pub until: f64,
}

impl Broken {
    /// Returns the code of the diagnostic.
    pub fn code(&self) -> &'static str {
        match self.reason {
            Reason::CurveLeft { .. } => "curve_left",
            Reason::NotCoplanar { .. } => "curves_not_coplanar",
            Reason::NoNearPoint | Reason::NoCommonTangent => "no_common_tangent",
        }
    }

    /// Returns advice in a sentence.
    pub fn advice(&self) -> String {
        match &self.reason {
            Reason::CurveLeft {
                curve,
                ahead: Some(Ahead { speed, way, until }),
                ..
            } => format!(
                "extend {curve} beyond that point: it moves on at {speed:.4}, which takes {way:.4} more until time {until}"
            ),
            Reason::CurveLeft { curve, beyond, .. } => {
                format!("extend {curve} beyond that point by more than {beyond:.6}")
            }
            Reason::NotCoplanar { .. } => {
                "turn one of these markers, and let joints hold their x-y planes together".into()
            }
            Reason::NoNearPoint | Reason::NoCommonTangent => {
                "bring the parts to where they touch, or say where with DISP, IDISP and JDISP"
                    .into()
            }
        }
    }
}

/// Writes the reason, without the name of the element.
impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reason::CurveLeft {
                curve, first, end, ..
            } => {
                let which = if *first { "first" } else { "last" };
                let Vec3([x, y, z]) = end;
                write!(
                    f,
                    "the contact leaves the open {curve} at its {which} point ({x:.6}, {y:.6}, {z:.6})"
                )
            }
            Reason::NotCoplanar {
                angle,
                markers: [i, j],
            } => write!(
                f,
                "the planes of the curves are inclined to each other by {angle:.4} deg: the x-y planes of {i} and {j}"
            ),
            Reason::NoNearPoint => f.write_str("no point of the curve is next to I"),
            Reason::NoCommonTangent => f.write_str("the two curves have no common tangent near"),
        }
    }
}

/// Returns the first contact that has ended. `until`: when the run was to end, for how far a curve
/// is too short.
pub fn broken(scene: Configured<'_>, numbers: &[f64], until: Option<f64>) -> Option<Broken> {
    if scene.cams.is_empty() {
        return None;
    }
    let at = Equations::<f64>::new(scene, numbers);
    let x = &numbers[scene.layout.x()];
    scene.cams.iter().enumerate().find_map(|(c, cam)| {
        let (i, j) = (at.frame(cam.i), at.frame(cam.j));
        let start = &scene.configuration.contacts[c];
        let s = (cam.contact).refined(&i, &j, parameters(cam, start, x), 2);
        let left = until.map(|until| (until, until - numbers[Layout::TIME]));
        let speeds = || at.cam_jets(c).map(|jet| jet.first.abs());
        let reason = curve_left(cam, s, speeds, left)
            // what is inclined need not have a common tangent: that is said first
            .or_else(|| not_coplanar(scene, cam, &i, &j))
            .or_else(|| no_touch(cam, &i, &j, s))?;
        Some(Broken {
            element: cam.id,
            reason,
        })
    })
}

/// Returns the end of an open curve that the contact has passed. `left`: the end of the run, and
/// the time until then.
fn curve_left(
    cam: &Cam,
    s: [f64; 2],
    speeds: impl Fn() -> [f64; 2],
    left: Option<(f64, f64)>,
) -> Option<Reason> {
    for (k, path) in cam.contact.paths().iter().enumerate() {
        let beyond = path.beyond(s[k]);
        if beyond <= 0.0 || beyond.is_nan() {
            continue;
        }
        let end = if s[k] < 0.0 { -1.0 } else { 1.0 };
        let ahead = left.map(|(until, time)| {
            let tangent: Vec3<f64> = path.at(end, 1);
            let speed = speeds()[k] * tangent.norm();
            Ahead {
                speed,
                way: speed * time,
                until,
            }
        });
        return Some(Reason::CurveLeft {
            curve: ElementKind::Curve.id(cam.curves[k]),
            first: end < 0.0,
            end: path.at(end, 0),
            beyond,
            ahead,
        });
    }
    None
}

/// Returns the inclination of two curves whose planes are not the same.
fn not_coplanar(
    scene: Configured<'_>,
    cam: &Cam,
    i: &Frame<f64>,
    j: &Frame<f64>,
) -> Option<Reason> {
    let sine = i.rotation.column(2).cross(j.rotation.column(2)).norm();
    let inclined = matches!(cam.contact, Contact::Curves(..)) && sine > COPLANAR_SINE;
    inclined.then(|| Reason::NotCoplanar {
        angle: Scalar::asin(sine.min(1.0)).to_degrees(),
        markers: [cam.i, cam.j].map(|m| ElementKind::Marker.id(scene.markers[m].id)),
    })
}

/// Returns that there is no touch near the parameters `s`.
fn no_touch(cam: &Cam, i: &Frame<f64>, j: &Frame<f64>, s: [f64; 2]) -> Option<Reason> {
    let apart = cam.contact.missing(i, j, s);
    (apart.is_nan() || apart > TANGENT_TOLERANCE).then_some(match cam.contact {
        Contact::Point(_) => Reason::NoNearPoint,
        Contact::Curves(..) => Reason::NoCommonTangent,
    })
}
