//! Markers that stand at places in ground: their coordinates in the body that carries them follow
//! when the model is made, so that bodies may be placed before or after.

use super::{Body, Element, Frame, Key, ModelBuilder};
use crate::dataset::row::{Given, Statement, canonical};
use crate::dataset::value::{Value, angles, numbers};
use crate::diagnostic::{Diagnostic, Span};
use crate::model::geometry::{marker_frame, orientation};
use crate::model::{ElementId, ElementKind, Model};
use crate::scalar::{Scalar, hypot};
use crate::space::{self, Mat3, Vec3, rotation};

/// One end of a joint or force: a marker, or a body, on which a marker is made where the other end
/// is.
#[derive(Clone, Copy, Debug)]
pub struct End {
    key: Key,
    is_body: bool,
}

impl From<&Element<'_, Frame>> for End {
    fn from(marker: &Element<'_, Frame>) -> Self {
        Self {
            key: marker.key(),
            is_body: false,
        }
    }
}

impl From<&Element<'_, Body>> for End {
    fn from(body: &Element<'_, Body>) -> Self {
        Self {
            key: body.key(),
            is_body: true,
        }
    }
}

/// The place of a marker in ground, as the model is drawn.
pub(super) enum Stand {
    /// at a point, with these directions of its axes
    At {
        body: ElementId,
        place: [f64; 3],
        z: [f64; 3],
        x: Option<[f64; 3]>,
    },
    /// where another marker is
    With { body: ElementId, marker: u32 },
}

impl Stand {
    /// Returns the arguments of the MARKER: its body, origin and orientation.
    ///
    /// # Errors
    /// Axes without directions.
    pub fn arguments(&self, model: &Model, row: &dyn Statement) -> Result<Vec<Given>, Diagnostic> {
        let (body, X_GM) = match self {
            Stand::At { body, place, z, x } => (body, frame(*place, *z, *x)?),
            Stand::With { body, marker } => {
                let there = marker_frame(model, *marker);
                let nowhere = || {
                    let other = ElementKind::Marker.id(*marker);
                    let what = format!("{other}, with which it stands, has no place");
                    Diagnostic::error("no_direction", what)
                };
                (body, there.ok_or_else(nowhere)?)
            }
        };
        let X_PM = match model.body(*body).filter(|part| !part.ground) {
            None => X_GM,
            Some(part) => {
                let why = |why| Diagnostic::error("no_direction", why);
                let carrier = space::Frame {
                    rotation: orientation(&part.orientation, part.qg).map_err(why)?,
                    position: Vec3(part.qg),
                };
                carrier.inverse().compose(&X_GM)
            }
        };
        let owner = Value::Id(body.number);
        let mut all = vec![given(row, body.kind.keyword(), owner)];
        all.push(given(row, "QP", numbers(&X_PM.position.0)));
        if X_PM.rotation != Mat3::identity() {
            all.push(given(row, "REULER", angles(&euler(&X_PM.rotation))));
        }
        Ok(all)
    }
}

/// Returns an argument of a row of the table.
fn given(row: &dyn Statement, keyword: &str, value: Value) -> Given {
    let arguments = row.arguments();
    let place = arguments
        .iter()
        .position(|a| a.keyword() == canonical(keyword));
    Given {
        argument: place.unwrap_or_else(|| unreachable!("MARKER has {keyword}")),
        value,
        span: Span::default(),
    }
}

/// Returns the frame at a place, with these directions of its z axis and in the half plane of its x
/// axis; where that is not given, ground's x axis, or y where z is along x.
fn frame(
    place: [f64; 3],
    z: [f64; 3],
    x: Option<[f64; 3]>,
) -> Result<space::Frame<f64>, Diagnostic> {
    let z = Vec3(z);
    let first = Vec3::axis(0);
    let usual = match first.cross(z).norm() > 1e-9 * z.norm() {
        true => first,
        false => Vec3::axis(1),
    };
    if let Some(x) = place.iter().find(|x| !x.is_finite()) {
        let what = format!("its place is at {x}");
        return Err(Diagnostic::error("unfit_value", what));
    }
    let axes = rotation::from_z_and_x(z, x.map_or(usual, Vec3));
    let axes = axes.filter(|r| r.0.iter().flatten().all(|x| x.is_finite()));
    let none = || {
        let what = "its z axis has no direction, or that of its x axis";
        Diagnostic::error("no_direction", what)
    };
    Ok(space::Frame {
        rotation: rotation::snapped(&axes.ok_or_else(none)?),
        position: Vec3(place),
    })
}

/// Returns the body 3-1-3 angles ψ, θ, φ of a rotation `R = Rz(ψ) Rx(θ) Rz(φ)`; φ = 0 where
/// z stays.
fn euler(r: &Mat3<f64>) -> [f64; 3] {
    let r = &r.0;
    let sine = hypot(r[0][2], r[1][2]);
    if sine < 1e-15 {
        return [
            Scalar::atan2(r[1][0], r[0][0]),
            Scalar::atan2(0.0f64, r[2][2]),
            0.0,
        ];
    }
    [
        Scalar::atan2(r[0][2], -r[1][2]),
        Scalar::atan2(sine, r[2][2]),
        Scalar::atan2(r[2][0], r[2][1]),
    ]
}

impl ModelBuilder {
    /// Returns a body or marker as the end of a joint or force; `None`: it is another statement, or
    /// one of another builder.
    pub fn end(&self, key: Key) -> Option<End> {
        let body = self.body(key).map(|body| End::from(&body));
        body.or_else(|| self.frame(key).map(|marker| End::from(&marker)))
    }

    /// Makes a marker on the body of a draft, at a place in ground.
    pub(super) fn marker_at(&self, body: usize, place: [f64; 3]) -> Element<'_, Frame> {
        let mut inner = self.inner.borrow_mut();
        let on = inner.body(body);
        let draft = inner.add(ElementKind::Marker, "");
        inner.drafts[draft].stand = Some(Stand::At {
            body: on,
            place,
            z: [0.0, 0.0, 1.0],
            x: None,
        });
        drop(inner);
        Element::new(self, draft)
    }

    /// Gives the axes of a marker directions in ground.
    pub(super) fn turn(&self, marker: usize, direction: [f64; 3], half_plane: Option<[f64; 3]>) {
        let mut inner = self.inner.borrow_mut();
        if let Some(Stand::At { z, x, .. }) = &mut inner.drafts[marker].stand {
            (*z, *x) = (direction, half_plane);
        }
    }

    /// Returns the markers of two ends; a body gets one where the other end is.
    ///
    /// Two bodies do not say where, and ends of another builder are none here: told with the other
    /// mistakes.
    pub(super) fn markers(&self, name: &str, i: End, j: End) -> [u32; 2] {
        let drafts = [i, j].map(|end| self.statement(end.key).map(|e| e.draft));
        let mut inner = self.inner.borrow_mut();
        let [Some(at_i), Some(at_j)] = drafts else {
            let what = format!("an end of `{name}` is an element of another builder");
            inner.wrong.push(Diagnostic::error("unfit_value", what));
            return [0; 2];
        };
        let (i, j) = match (i.is_body, j.is_body) {
            (false, false) => (at_i, at_j),
            (false, true) => (at_i, inner.beside(at_i, at_j)),
            (true, false) => (inner.beside(at_j, at_i), at_j),
            (true, true) => {
                let what =
                    format!("`{name}` stands between two bodies, neither of which says where");
                let said = Diagnostic::error("missing_argument", what);
                let advice = "make a marker on one of them: body.at([x, y, z])";
                inner.wrong.push(said.help(advice));
                return [0; 2];
            }
        };
        [i, j].map(|draft| inner.drafts[draft].id.unwrap_or(0))
    }
}

impl super::Inner {
    /// Returns the element of a body's draft.
    fn body(&self, draft: usize) -> ElementId {
        let element = self.drafts[draft].element();
        element.unwrap_or_else(|| unreachable!("bodies are elements"))
    }

    /// Adds a marker on a body where another marker is; returns its draft.
    fn beside(&mut self, marker: usize, body: usize) -> usize {
        let stand = Stand::With {
            body: self.body(body),
            marker: self.drafts[marker].id.unwrap_or(0),
        };
        let draft = self.add(ElementKind::Marker, "");
        self.drafts[draft].stand = Some(stand);
        draft
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_of_a_rotation_give_the_rotation_again() {
        let angles = [-2.5, -0.3, 0.0, 1e-9, 0.7, 3.0];
        for psi in angles {
            for theta in [0.0, 1e-8, 0.4, 1.6, 3.0, std::f64::consts::PI] {
                for phi in angles {
                    let r = rotation::from_313(psi, theta, phi);
                    let [psi, theta, phi] = euler(&r);
                    let again = rotation::from_313(psi, theta, phi);
                    for (x, y) in r.0.iter().flatten().zip(again.0.iter().flatten()) {
                        assert!((x - y).abs() < 1e-14, "{r:?}\n{again:?}");
                    }
                }
            }
        }
    }
}
