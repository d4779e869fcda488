//! Bodies without GRAPHICS as links: rods and plates between the places where joints and forces
//! hold them, and their mass.

use super::bodies::{Bodies, Body};
use super::solid::{Solid, along_z};
use super::{Form, Piece, Role, Sizes, Trail};
use crate::arrange::Arrange;
use crate::model::{ElementId, ElementKind, Family, Model};
use crate::space::{Frame, Mat3, Vec3, rotation};
use std::collections::BTreeSet;

/// Distance below which two places are one, as a part of the size of the mechanism.
const SAME_PLACE: f64 = 1e-3;
/// Distance of a centre of mass from the places of joints beyond which it is drawn, as a part of
/// the size of the mechanism.
const APART: f64 = 0.03;
/// Distance from a plane up to which places lie in it, as a part of the size of the mechanism.
const COPLANAR: f64 = 0.01;
/// Semi-axes of the solid that stands for a free body, as parts of the size of the mechanism.
const FREE_BODY: [f64; 2] = [0.012, 0.16];

/// Returns the links of all bodies that no piece shows so far.
pub fn links(
    model: &Model,
    bodies: &Bodies,
    sizes: Sizes,
    drawn: &BTreeSet<usize>,
    asked: &[Trail],
) -> Vec<Piece> {
    let mut all = Vec::new();
    for (k, body) in bodies.all.iter().enumerate() {
        if body.is_ground || drawn.contains(&k) {
            continue;
        }
        let same = SAME_PLACE * sizes.whole;
        let mut places = places(model, bodies, k, same);
        // a point whose path is seen belongs to the link
        for point in asked.iter().filter(|t| t.body == k).map(|t| Vec3(t.place)) {
            let is_new = places.iter().all(|p| (*p - point).norm() > same);
            if is_new && !places.is_empty() {
                places.push(point);
            }
        }
        let forms = link(&places, body, sizes, || inertia(model, bodies, body));
        all.extend(forms.into_iter().map(|(role, form)| Piece {
            body: k,
            element: body.id,
            role,
            form,
            colour: body.colour,
        }));
    }
    all
}

/// Returns the places in a body where joints and forces act, each once.
fn places(model: &Model, bodies: &Bodies, body: usize, same: f64) -> Vec<Vec3<f64>> {
    let mut found: Vec<Vec3<f64>> = Vec::new();
    let mut add = |marker: u32| {
        let anchor = bodies.marker(marker).filter(|a| a.body == body);
        let place = anchor.map(|a| a.frame.position);
        found.extend(place.filter(|p| found.iter().all(|q| (*p - *q).norm() > same)));
    };
    let holds = |id: &ElementId| {
        matches!(id.kind.family(), Family::Constraint | Family::Force)
            && id.kind != ElementKind::Motion
            && !model.inactive.contains(id)
    };
    for (_, element) in model.elements().into_iter().filter(|(id, _)| holds(id)) {
        element.ends().into_iter().flatten().for_each(&mut add);
    }
    found
}

type Forms = Vec<(Role, Form)>;

/// Returns the link between places of a body.
fn link(
    places: &[Vec3<f64>],
    body: &Body,
    sizes: Sizes,
    solid: impl Fn() -> Option<(Frame<f64>, [f64; 3])>,
) -> Forms {
    let rod = |a: Vec3<f64>, b: Vec3<f64>| {
        let (from, to, radius) = (a.0, b.0, sizes.rod);
        (Role::Link, Form::Rod { from, to, radius })
    };
    let apart = |cm: Vec3<f64>| {
        let nearest = places.iter().map(|p| (cm - *p).norm());
        nearest.fold(f64::INFINITY, f64::min) > APART * sizes.whole
    };
    let mut forms = match places {
        [] => Vec::new(),
        [one] => match body.cm.filter(|cm| apart(*cm)) {
            Some(cm) => vec![rod(*one, cm)],
            None => vec![ball(*one, 1.6 * sizes.rod)],
        },
        [a, b] => vec![rod(*a, *b)],
        many => several(many, sizes),
    };
    match (places, body.cm) {
        ([], cm) => {
            let centre = cm.unwrap_or_default();
            forms.push((Role::Mass, free_body(centre, solid(), sizes)));
        }
        ([_], Some(cm)) if apart(cm) => forms.push(ball(cm, 2.4 * sizes.rod)),
        _ => {}
    }
    forms
}

fn ball(centre: Vec3<f64>, radius: f64) -> (Role, Form) {
    let centre = centre.0;
    (Role::Mass, Form::Ball { centre, radius })
}

/// Returns the solid of a body that nothing holds: the ellipsoid of its inertia, within limits.
fn free_body(centre: Vec3<f64>, inertia: Option<(Frame<f64>, [f64; 3])>, sizes: Sizes) -> Form {
    let [least, most] = FREE_BODY.map(|part| part * sizes.whole);
    let Some((frame, semi)) = inertia else {
        let radius = 2.0 * sizes.rod;
        return Form::Ball {
            centre: centre.0,
            radius,
        };
    };
    let largest = semi.iter().fold(0.0_f64, |a, b| a.max(*b));
    let scale = if largest > most { most / largest } else { 1.0 };
    let semi = semi.map(|a| (scale * a).max(least));
    let is_ball = semi.iter().all(|a| (a - semi[0]).abs() < 1e-3 * semi[0]);
    if is_ball {
        let (centre, radius) = (frame.position.0, semi[0]);
        return Form::Ball { centre, radius };
    }
    Form::Solid(Solid::ellipsoid(semi).placed(&frame))
}

/// Returns the frame of the inertia of a body and the semi-axes of the homogeneous ellipsoid that
/// has its moments: `a² = 5 (Iy + Iz − Ix)/(2 m)`.
fn inertia(model: &Model, bodies: &Bodies, body: &Body) -> Option<(Frame<f64>, [f64; 3])> {
    let part = model.body(body.id)?;
    let [ix, iy, iz, ..] = part.ip;
    let axes = part.im.or(part.cm).and_then(|m| bodies.marker(m));
    let frame = Frame {
        rotation: axes.map_or_else(Mat3::identity, |a| a.frame.rotation),
        position: body.cm?,
    };
    let square = |twice: f64| 2.5 * twice / part.mass;
    let semi =
        [iy + iz - ix, iz + ix - iy, ix + iy - iz].map(|twice| square(twice).max(0.0).sqrt());
    let is_given =
        part.mass > 0.0 && semi.iter().all(|a| a.is_finite()) && semi.iter().any(|a| *a > 0.0);
    is_given.then_some((frame, semi))
}

/// Returns the link between three places or more: a rod, a plate with a rim, or rods to the middle.
fn several(places: &[Vec3<f64>], sizes: Sizes) -> Forms {
    let rod = |a: Vec3<f64>, b: Vec3<f64>| {
        let (from, to, radius) = (a.0, b.0, sizes.rod);
        (Role::Link, Form::Rod { from, to, radius })
    };
    let n = places.len() as f64;
    let middle = places
        .iter()
        .fold(Vec3::zero(), |sum, p| sum + *p)
        .times(1.0 / n);
    let far = |from: Vec3<f64>| {
        let mut all = places.iter().copied();
        let first = all.next().unwrap_or(from);
        all.fold(first, |a, b| {
            if (b - from).norm() > (a - from).norm() {
                b
            } else {
                a
            }
        })
    };
    let (a, b) = (far(far(middle)), far(middle));
    let line = b - a;
    let off_line = |p: Vec3<f64>| (p - a).cross(line).norm() / line.norm();
    let c = places
        .iter()
        .copied()
        .fold(a, |c, p| if off_line(p) > off_line(c) { p } else { c });
    if off_line(c) < COPLANAR * sizes.whole {
        return vec![rod(a, b)];
    }
    let normal = line.cross(c - a);
    let off_plane = |p: &Vec3<f64>| (*p - a).dot(normal).abs() / normal.norm();
    if places.iter().any(|p| off_plane(p) > COPLANAR * sizes.whole) {
        return places.iter().map(|p| rod(middle, *p)).collect();
    }
    let frame = Frame {
        rotation: rotation::from_z_and_x(normal, line).unwrap_or_else(|| along_z(normal)),
        position: a,
    };
    let flat = |p: &Vec3<f64>| frame.inverse().point(*p);
    let outline = hull(
        places
            .iter()
            .map(|p| [flat(p).0[0], flat(p).0[1]])
            .collect(),
    );
    let half = 0.35 * sizes.rod;
    let plate = Solid::prism(&outline, [-half, half]).placed(&frame);
    let corner = |k: usize| {
        let [x, y] = outline[k % outline.len()];
        frame.point(Vec3([x, y, 0.0]))
    };
    let rim = (0..outline.len()).map(|k| rod(corner(k), corner(k + 1)));
    let mut forms: Forms = rim.collect();
    forms.push((Role::Link, Form::Solid(plate)));
    forms
}

/// Returns the convex hull of points of a plane, counter-clockwise (Andrew's chains).
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.arrange_by(|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..]
                && turn(a, b, p) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut all = chain(&mut points.iter().copied());
    all.extend(chain(&mut points.iter().rev().copied()));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hull_of_points_turns_left_and_leaves_out_what_is_inside() {
        let square = [
            [1.0, 1.0],
            [0.0, 0.0],
            [0.4, 0.5],
            [0.0, 1.0],
            [1.0, 0.0],
            [0.5, 0.0],
        ];
        let found = hull(square.to_vec());
        assert_eq!(found, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    }
}
