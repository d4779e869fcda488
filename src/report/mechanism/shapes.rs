//! GRAPHICS as solids and lines in the frames of their bodies.

use super::bodies::{Anchor, Bodies};
use super::solid::{SIDES, Solid};
use super::{Form, Piece, Role};
use crate::dataset::surface::{Surface, Surfaces};
use crate::expr::interpolation::Curve;
use crate::model::{ElementId, ElementKind, Model, Shape};
use crate::scene::formula::curve as curve_of;
use crate::space::{Frame, Vec3};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Points of a curve that is drawn.
const CURVE_POINTS: usize = 160;
/// Side of a plane without limits, as a part of the size of the mechanism.
const UNLIMITED_PLANE: f64 = 2.0;
/// Radius of a point, as a part of the size of the mechanism.
const POINT_RADIUS: f64 = 0.008;

/// Returns the pieces of all GRAPHICS that have a shape, and of curves that constraints name;
/// `size`: of the whole mechanism.
pub fn shapes(model: &Model, bodies: &Bodies, surfaces: &Surfaces, size: f64) -> Vec<Piece> {
    let mut all = Vec::new();
    let mut curves = BTreeSet::new();
    for (&number, graphics) in &model.graphics {
        if let Shape::Curve { curve, rm } = graphics.shape {
            curves.insert((curve, rm));
        }
        let surface = surfaces.known.get(&number);
        let Some((marker, form)) = form(model, &graphics.shape, surface, size) else {
            continue;
        };
        if let Some(at) = bodies.marker(marker) {
            let id = ElementKind::Graphics.id(number);
            all.push(piece(bodies, id, at, form, Role::Shape));
        }
    }
    for (id, side) in followed(model)
        .into_iter()
        .filter(|(_, s)| curves.insert(*s))
    {
        if let (Some(line), Some(at)) = (curve(model, side.0), bodies.marker(side.1)) {
            all.push(piece(bodies, id, at, line, Role::Shape));
        }
    }
    all
}

/// Returns the curves that constraints follow, each with the marker in whose frame it stands.
fn followed(model: &Model) -> Vec<(ElementId, (u32, u32))> {
    let points = model.points_on_curves.iter();
    let points = points.map(|(&n, c)| (ElementKind::Ptcv.id(n), (c.curve, c.rm)));
    let pairs = model.curves_on_curves.iter().flat_map(|(&n, c)| {
        let id = ElementKind::Cvcv.id(n);
        [(id, (c.i.curve, c.i.rm)), (id, (c.j.curve, c.j.rm))]
    });
    points.chain(pairs).collect()
}

fn piece(bodies: &Bodies, element: ElementId, at: Anchor, form: Form, role: Role) -> Piece {
    Piece {
        body: at.body,
        element,
        role,
        form: form.placed(&at.frame),
        colour: bodies.all[at.body].colour,
    }
}

/// Returns the shape in the frame of a marker; `None` where there is nothing to draw.
fn form(model: &Model, shape: &Shape, surface: Option<&Surface>, size: f64) -> Option<(u32, Form)> {
    let arc = |radius: f64, angle: f64| {
        let n = 2 * SIDES;
        let closed = angle.abs() >= TAU * (1.0 - 1e-12);
        let last = if closed { n - 1 } else { n };
        let points = (0..=last).map(|k| {
            let (sin, cos) = (angle * k as f64 / n as f64).sin_cos();
            [radius * cos, radius * sin, 0.0]
        });
        let points = points.collect();
        Form::Line { points, closed }
    };
    let solid = |solid: Solid| Form::Solid(solid);
    Some(match *shape {
        Shape::Box { corner, size } => {
            let low = size.map(|x| x.min(0.0));
            (corner, solid(Solid::block(low, size.map(|x| x.max(0.0)))))
        }
        Shape::Cylinder { cm, length, radius } => {
            (cm, solid(Solid::frustum(radius, radius, [0.0, length])))
        }
        Shape::Frustum {
            cm,
            length,
            top,
            bottom,
        } => (cm, solid(Solid::frustum(bottom, top, [0.0, length]))),
        Shape::Ellipsoid { cm, diameters } => {
            let semi = diameters.map(|d| d / 2.0);
            let is_ball = semi[0] == semi[1] && semi[1] == semi[2];
            let ball = Form::Ball {
                centre: [0.0; 3],
                radius: semi[0],
            };
            (
                cm,
                if is_ball {
                    ball
                } else {
                    solid(Solid::ellipsoid(semi))
                },
            )
        }
        Shape::Torus { cm, ring, tube } => (cm, solid(Solid::torus(ring, tube))),
        Shape::Plane { rm, x, y } => {
            let half = UNLIMITED_PLANE * size / 2.0;
            let [x, y] = [x, y].map(|[low, high]| match (low, high) {
                (Some(low), Some(high)) => [low, high],
                (Some(low), None) => [low, low + 2.0 * half],
                (None, Some(high)) => [high - 2.0 * half, high],
                (None, None) => [-half, half],
            });
            let corners = [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
            (rm, solid(Solid::sheet(&corners.map(|[x, y]| [x, y, 0.0]))))
        }
        Shape::Circle { cm, radius } => (cm, arc(radius, TAU)),
        Shape::Arc { cm, radius, angle } => (cm, arc(radius, angle)),
        Shape::Point { rm } => {
            let radius = POINT_RADIUS * size;
            let centre = [0.0; 3];
            (rm, Form::Ball { centre, radius })
        }
        Shape::Curve { curve: id, rm } => (rm, curve(model, id)?),
        Shape::External { rm, .. } | Shape::Shell { rm, .. } => {
            let Surface { points, faces } = surface?.clone();
            let smooth = vec![false; faces.len()];
            let shell = Solid {
                points,
                faces,
                smooth,
            };
            (rm, solid(shell))
        }
        Shape::Other(_) | Shape::Nothing => return None,
    })
}

/// Returns a CURVE as a line of points; `None` where its data cannot be read.
fn curve(model: &Model, id: u32) -> Option<Form> {
    let curve = curve_of(model, &[], id).ok()?;
    let n = if curve.is_closed() {
        CURVE_POINTS
    } else {
        CURVE_POINTS - 1
    };
    let points = (0..CURVE_POINTS).map(|k| point(&curve, -1.0 + 2.0 * k as f64 / n as f64));
    Some(Form::Line {
        points: points.collect(),
        closed: curve.is_closed(),
    })
}

fn point(curve: &Curve, parameter: f64) -> [f64; 3] {
    let mut all = [0.0; 3];
    for (value, table) in all.iter_mut().zip(curve.components()) {
        *value = table.at(parameter, 0);
    }
    all
}

impl Form {
    /// Returns the same form, placed by a frame.
    pub fn placed(self, frame: &Frame<f64>) -> Self {
        let at = |p: [f64; 3]| frame.point(Vec3(p)).0;
        match self {
            Form::Rod { from, to, radius } => Form::Rod {
                from: at(from),
                to: at(to),
                radius,
            },
            Form::Ball { centre, radius } => Form::Ball {
                centre: at(centre),
                radius,
            },
            Form::Solid(solid) => Form::Solid(solid.placed(frame)),
            Form::Line { points, closed } => Form::Line {
                points: points.into_iter().map(at).collect(),
                closed,
            },
        }
    }
}
