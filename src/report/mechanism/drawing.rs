//! A configuration on paper: what is seen of a mechanism from one side, from the back to the front.
//!
//! ```text
//! p = (x, y, depth)          along right, up and eye of the view, from its middle
//! x' = x d/(d − depth)       in perspective, d the distance of the eye; in a plane view x' = x
//! ```
//!
//! Pieces are sorted by the depth of their middle; of surfaces the faces that look away are left
//! out. Rods, balls and springs become strokes and circles, as in a textbook. Lengths are in units
//! of the model until they are written.

mod overlays;

use super::{Form, Look, Pictured, Piece, Role, Solid, View, colours};
use crate::model::ElementId;
use crate::space::Vec3;
use std::collections::BTreeSet;

/// Distance of the eye, as a part of the size of the mechanism.
const DISTANCE: f64 = 3.0;
/// Steps of brightness of a curved surface.
const SHADES: f64 = 16.0;
/// Depth by which a role is nearer to the eye than the one before, as a part of the size.
const LAYER: f64 = 0.02;
/// Windings of a spring on paper.
const WINDINGS: usize = 7;

/// The content of a drawing.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// the row of the run
    pub row: usize,
    /// further rows, drawn pale behind it
    pub pale: Vec<usize>,
    /// which names are written
    pub names: Names,
    /// what stands for joints and markers
    pub symbols: SymbolKind,
    /// elements that stand out; all others are pale. Empty: none
    pub highlighted: BTreeSet<ElementId>,
    /// paths of the markers that requests ask for
    pub paths: bool,
    /// arrows of forces
    pub forces: bool,
    /// the view; `None`: that of the mechanism
    pub view: Option<View>,
    /// unit of lengths, for dimensions
    pub unit: String,
}

impl Wanted {
    /// Returns the content of a drawing of one row: symbols of joints, names of bodies, forces.
    pub fn at_row(row: usize, unit: &str) -> Self {
        Self {
            row,
            pale: Vec::new(),
            names: Names::Bodies,
            symbols: SymbolKind::Joints,
            highlighted: BTreeSet::new(),
            paths: false,
            forces: true,
            view: None,
            unit: unit.to_owned(),
        }
    }
}

/// Names that a drawing shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Names {
    /// none
    None,
    /// those of bodies
    Bodies,
    /// those of bodies and joints, or of markers where these are shown
    All,
}

/// Symbols that a drawing shows at joints and markers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SymbolKind {
    /// none
    None,
    /// those of joints
    Joints,
    /// those of joints, with the directions of their displacements
    Actions,
    /// the axes of markers, in the place of joints
    Markers,
}

impl SymbolKind {
    /// Returns whether joints have symbols.
    pub fn has_joints(self) -> bool {
        matches!(self, Self::Joints | Self::Actions)
    }
}

/// A point on paper: to the right and upwards, in units of the model.
pub type Point = [f64; 2];

/// A stroke, a face, a circle or a word on paper.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// faces of one brightness
    Faces {
        /// outlines
        outlines: Vec<Vec<Point>>,
        /// colour
        colour: [u8; 3],
        /// whether edges are drawn
        edges: bool,
        /// whether one sees through
        sheer: bool,
    },
    /// a stroke with round ends
    Stroke {
        /// its points
        points: Vec<Point>,
        /// width   (length); 0: a thin line
        width: f64,
        /// colour
        colour: [u8; 3],
        /// whether it is a rod, which has an outline
        is_rod: bool,
    },
    /// a ball
    Ball {
        /// its middle
        centre: Point,
        /// radius
        radius: f64,
        /// colour
        colour: [u8; 3],
    },
    /// a name
    Word {
        /// its middle
        at: Point,
        /// the text
        text: String,
        /// colour
        colour: [u8; 3],
    },
}

/// Marks that belong together, and how clearly they are seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// the marks, from the back to the front
    pub marks: Vec<Mark>,
    /// 1: as they are, 0: not at all
    pub opacity: f64,
}

/// A drawing: its layers from the back to the front, and its corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// the layers
    pub layers: Vec<Layer>,
    /// lower left corner
    pub low: Point,
    /// upper right corner
    pub high: Point,
}

/// The way from space to paper.
struct Projection {
    view: View,
    right: Vec3<f64>,
    up: Vec3<f64>,
}

impl Projection {
    fn new(view: View) -> Self {
        let (right, up) = view.axes();
        Self { view, right, up }
    }

    /// Returns a point on paper, its depth, and the scale there.
    fn at(&self, p: Vec3<f64>) -> (Point, f64, f64) {
        let d = p - self.view.centre;
        let depth = d.dot(self.view.eye);
        let scale = if self.view.is_planar {
            1.0
        } else {
            let distance = DISTANCE * self.view.size;
            distance / (distance - depth).max(0.1 * distance)
        };
        (
            [scale * d.dot(self.right), scale * d.dot(self.up)],
            depth,
            scale,
        )
    }

    fn point(&self, p: Vec3<f64>) -> Point {
        self.at(p).0
    }

    /// Returns the direction from a point to the eye.
    fn to_eye(&self, p: Vec3<f64>) -> Vec3<f64> {
        if self.view.is_planar {
            return self.view.eye;
        }
        self.view.centre + self.view.eye.times(DISTANCE * self.view.size) - p
    }
}

/// Draws a mechanism.
pub fn drawing(pictured: &Pictured, wanted: &Wanted) -> Drawing {
    let projection = Projection::new(wanted.view.unwrap_or(pictured.view));
    let pen = Pen {
        pictured,
        wanted,
        projection,
    };
    let mut layers = Vec::new();
    if wanted.paths {
        layers.push(pen.paths());
    }
    for &row in &wanted.pale {
        layers.extend(pen.mechanism(row, 0.22));
    }
    layers.extend(pen.mechanism(wanted.row, 1.0));
    layers.push(pen.directions(wanted.row));
    if wanted.forces {
        layers.push(pen.forces(wanted.row));
    }
    layers.push(pen.dimensions(wanted.row));
    layers.push(pen.names(wanted.row));
    let (low, high) = corners(&layers);
    Drawing { layers, low, high }
}

struct Pen<'a> {
    pictured: &'a Pictured,
    wanted: &'a Wanted,
    projection: Projection,
}

impl Pen<'_> {
    /// Returns the bodies and springs at a row, from the back to the front: what does not stand out
    /// first, where something does.
    fn mechanism(&self, row: usize, opacity: f64) -> Vec<Layer> {
        let mut all = self.pieces(row);
        all.extend(self.stretched(row));
        all.sort_by(|a, b| a.1.total_cmp(&b.1));
        let special = &self.wanted.highlighted;
        let layer = |marks: Vec<Mark>, opacity| Layer { marks, opacity };
        let marks = |stands_out: bool| {
            let own = all
                .iter()
                .filter(|(element, ..)| special.contains(element) == stands_out);
            own.flat_map(|(_, _, marks)| marks.clone())
                .collect::<Vec<_>>()
        };
        if special.is_empty() {
            return vec![layer(marks(false), opacity)];
        }
        vec![
            layer(marks(false), 0.3 * opacity),
            layer(marks(true), opacity),
        ]
    }

    fn pieces(&self, row: usize) -> Vec<(ElementId, f64, Vec<Mark>)> {
        let Pictured { bodies, track, .. } = self.pictured;
        let of = |piece: &Piece| {
            let frame = track.frame(bodies, piece.body, row);
            let form = piece.form.clone().placed(&frame);
            let colour = self.colour(piece.element, piece.colour);
            let (marks, depth) = self.form(&form, colour);
            let layer = match piece.role {
                // floors and walls are behind everything
                Role::Shape if bodies.all[piece.body].is_ground => -100.0,
                Role::Ground => 0.0,
                Role::Shape => 1.0,
                Role::Link => 2.0,
                Role::Mass => 3.0,
                Role::Joint => 4.0,
            };
            (
                piece.element,
                depth + layer * LAYER * self.pictured.sizes.whole,
                marks,
            )
        };
        let with_joints = self.wanted.symbols.has_joints();
        let shown = |p: &&Piece| match p.role {
            Role::Joint => with_joints && track.is_active(p.element, row),
            Role::Ground => with_joints,
            Role::Shape | Role::Link | Role::Mass => true,
        };
        self.pictured.pieces.iter().filter(shown).map(of).collect()
    }

    /// Returns the colour of an element: where others stand out, those in red.
    fn colour(&self, element: ElementId, own: [u8; 3]) -> [u8; 3] {
        if self.wanted.highlighted.contains(&element) {
            colours::FORCE
        } else {
            own
        }
    }

    /// Returns the marks of a form in ground, and its depth.
    fn form(&self, form: &Form, colour: [u8; 3]) -> (Vec<Mark>, f64) {
        let at = |p: [f64; 3]| self.projection.at(Vec3(p));
        match form {
            Form::Rod { from, to, radius } => {
                let (a, b) = (at(*from), at(*to));
                let width = (a.2 + b.2) * radius;
                let points = vec![a.0, b.0];
                let is_rod = true;
                let stroke = Mark::Stroke {
                    points,
                    width,
                    colour,
                    is_rod,
                };
                (vec![stroke], (a.1 + b.1) / 2.0)
            }
            Form::Ball { centre, radius } => {
                let (point, depth, scale) = at(*centre);
                let ball = Mark::Ball {
                    centre: point,
                    radius: scale * radius,
                    colour,
                };
                (vec![ball], depth)
            }
            Form::Solid(solid) => (self.faces(solid, colour), self.depth(&solid.points)),
            Form::Line { points, closed } => {
                let mut all: Vec<Point> = points.iter().map(|p| at(*p).0).collect();
                all.extend(all.first().copied().filter(|_| *closed));
                let line = Mark::Stroke {
                    points: all,
                    width: 0.0,
                    colour,
                    is_rod: false,
                };
                (vec![line], self.depth(points))
            }
        }
    }

    fn depth(&self, points: &[[f64; 3]]) -> f64 {
        let sum: f64 = points.iter().map(|p| self.projection.at(Vec3(*p)).1).sum();
        sum / points.len().max(1) as f64
    }

    /// Returns the faces that look at the eye, from the back to the front, neighbours of one
    /// brightness together.
    fn faces(&self, solid: &Solid, colour: [u8; 3]) -> Vec<Mark> {
        let view = &self.projection.view;
        let light = self.projection.right.times(-0.35)
            + self.projection.up.times(0.75)
            + view.eye.times(0.9);
        let light = light.times(1.0 / light.norm());
        let mut seen = Vec::new();
        for (k, face) in solid.faces.iter().enumerate() {
            let corners: Vec<[f64; 3]> = face.iter().map(|&c| solid.points[c as usize]).collect();
            let normal = solid.normal(k);
            let size = normal.norm();
            let first = corners.first().copied().unwrap_or_default();
            if size == 0.0 || normal.dot(self.projection.to_eye(Vec3(first))) <= 0.0 {
                continue;
            }
            let brightness = 0.62 + 0.5 * (normal.dot(light) / size).max(0.0);
            let outline = corners.iter().map(|c| self.projection.point(Vec3(*c)));
            let step = (SHADES * brightness).round() / SHADES;
            seen.push((
                self.depth(&corners),
                step,
                solid.smooth[k],
                outline.collect::<Vec<_>>(),
            ));
        }
        seen.sort_by(|a, b| a.0.total_cmp(&b.0));
        let sheer = solid.faces.len() == 2;
        let mut marks: Vec<Mark> = Vec::new();
        let mut last = None;
        for (_, step, smooth, outline) in seen {
            if let (Some(Mark::Faces { outlines, .. }), true) =
                (marks.last_mut(), last == Some((step, smooth)))
            {
                outlines.push(outline);
                continue;
            }
            last = Some((step, smooth));
            marks.push(Mark::Faces {
                outlines: vec![outline],
                colour: shaded(colour, step),
                edges: !smooth,
                sheer,
            });
        }
        marks
    }

    /// Returns springs and lines of forces at a row.
    fn stretched(&self, row: usize) -> Vec<(ElementId, f64, Vec<Mark>)> {
        let Pictured { bodies, track, .. } = self.pictured;
        let of = |s: &super::Stretched| {
            let [from, to] = s.ends(bodies, track, row).map(|p| self.projection.at(p));
            let colour = self.colour(s.element, s.colour);
            let (points, width) = match s.look {
                Look::Rod => (vec![from.0, to.0], 2.0 * s.radius),
                Look::Coil => (zigzag(from.0, to.0, s.radius), 0.3 * s.radius),
            };
            let stroke = Mark::Stroke {
                points,
                width,
                colour,
                is_rod: false,
            };
            (s.element, (from.1 + to.1) / 2.0, vec![stroke])
        };
        let acts = |s: &&super::Stretched| track.is_active(s.element, row);
        let stretched = self.pictured.stretched.iter();
        stretched.filter(acts).map(of).collect()
    }
}

/// Returns a colour that is brighter (above 1) or darker.
pub(super) fn shaded(colour: [u8; 3], brightness: f64) -> [u8; 3] {
    colour.map(|c| {
        let c = f64::from(c);
        let bright = if brightness <= 1.0 {
            c * brightness
        } else {
            c + (255.0 - c) * (brightness - 1.0).min(1.0)
        };
        bright.round().clamp(0.0, 255.0) as u8
    })
}

/// Returns the line of a spring between two points.
fn zigzag(a: Point, b: Point, radius: f64) -> Vec<Point> {
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = along[0].hypot(along[1]);
    if length == 0.0 {
        return vec![a, b];
    }
    let across = [-along[1] / length * radius, along[0] / length * radius];
    let at = |u: f64, side: f64| [0, 1].map(|k| a[k] + u * along[k] + side * across[k]);
    let n = 2 * WINDINGS;
    let turns = (0..n).map(|k| {
        let u = 0.15 + 0.7 * (k as f64 + 0.5) / n as f64;
        at(u, if k % 2 == 0 { 1.0 } else { -1.0 })
    });
    let mut all = vec![a, at(0.15, 0.0)];
    all.extend(turns);
    all.extend([at(0.85, 0.0), b]);
    all
}

/// Returns the corners of everything that is drawn; without anything those of a square.
fn corners(layers: &[Layer]) -> (Point, Point) {
    let mut found = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let mut add = |p: Point, r: f64| {
        let sides = found.0.iter_mut().zip(&mut found.1).zip(p);
        for ((low, high), x) in sides.filter(|(_, x)| x.is_finite()) {
            *low = low.min(x - r);
            *high = high.max(x + r);
        }
    };
    for mark in layers.iter().flat_map(|l| &l.marks) {
        match mark {
            Mark::Faces { outlines, .. } => outlines.iter().flatten().for_each(|p| add(*p, 0.0)),
            Mark::Stroke { points, width, .. } => points.iter().for_each(|p| add(*p, width / 2.0)),
            Mark::Ball { centre, radius, .. } => add(*centre, *radius),
            Mark::Word { at, .. } => add(*at, 0.0),
        }
    }
    let (low, high) = found;
    if low[0] <= high[0] && low[1] <= high[1] {
        (low, high)
    } else {
        ([-1.0; 2], [1.0; 2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spring_on_paper_begins_and_ends_where_it_is_held() {
        let (a, b) = ([1.0, 2.0], [4.0, 6.0]);
        let line = zigzag(a, b, 0.3);
        assert_eq!((line.first(), line.last()), (Some(&a), Some(&b)));
        // no point is farther from the line between the ends than its radius
        let off = line
            .iter()
            .map(|p| ((p[0] - 1.0) * 4.0 - (p[1] - 2.0) * 3.0).abs() / 5.0);
        assert!((off.fold(0.0, f64::max) - 0.3).abs() < 1e-12);
    }

    #[test]
    fn of_a_cube_three_faces_are_seen_in_perspective_and_one_along_an_axis() {
        let seen = |is_planar: bool, eye: [f64; 3]| {
            let eye = Vec3(eye);
            let view = View {
                centre: Vec3::zero(),
                size: 4.0,
                eye: eye.times(1.0 / eye.norm()),
                up: Vec3::axis(2),
                is_planar,
            };
            let projection = Projection::new(view);
            let cube = Solid::block([-1.0; 3], [1.0; 3]);
            let looks = |f: &usize| {
                let corner = Vec3(cube.points[cube.faces[*f][0] as usize]);
                cube.normal(*f).dot(projection.to_eye(corner)) > 1e-9
            };
            (0..6).filter(looks).count()
        };
        assert_eq!(seen(false, [1.0, 1.0, 1.0]), 3);
        assert_eq!(seen(true, [1.0, 0.0, 0.0]), 1);
    }
}
