//! Overlays of a drawing: paths, directions, dimensions, forces and names above its mechanism.

use super::{Layer, Mark, Names, Pen, Point, SymbolKind, shaded};
use crate::report::mechanism::{Anchor, Pictured, Piece, Role, Trail, colours};
use crate::space::Vec3;
use std::collections::BTreeSet;

/// Length of the arrow of the largest force of a row, as a part of the size of the mechanism.
const ARROW: f64 = 0.16;
/// Width of the line of an axis or dimension, as a part of half the length of a joint's symbol.
const AXIS_WIDTH: f64 = 0.14;

impl Pen<'_> {
    /// Returns the paths of markers, up to the row.
    pub(super) fn paths(&self) -> Layer {
        let Pictured { bodies, track, .. } = self.pictured;
        let rows = track.times.len();
        let step = rows.div_ceil(600).max(1);
        let of = |trail: &Trail| {
            let place = |row: usize| {
                track
                    .frame(bodies, trail.body, row)
                    .point(Vec3(trail.place))
            };
            let points = (0..rows)
                .step_by(step)
                .map(|row| self.projection.point(place(row)));
            Mark::Stroke {
                points: points.collect(),
                width: 0.0,
                colour: bodies.all[trail.body].colour,
                is_rod: false,
            }
        };
        Layer {
            marks: self.pictured.trails.iter().map(of).collect(),
            opacity: 0.7,
        }
    }

    /// Returns the axes of markers, or the action vectors of joints, at a row.
    pub(super) fn directions(&self, row: usize) -> Layer {
        let Pictured {
            bodies,
            track,
            sizes,
            ..
        } = self.pictured;
        let mut marks = Vec::new();
        let mut arrow = |at: Anchor, axis: usize, length: f64, colour: [u8; 3]| {
            let frame = track.frame(bodies, at.body, row).compose(&at.frame);
            let tip = frame.position + frame.rotation.column(axis).times(length);
            let [a, b] = [frame.position, tip].map(|p| self.projection.point(p));
            marks.extend(arrow_between(a, b, AXIS_WIDTH * sizes.joint, colour));
        };
        match self.wanted.symbols {
            SymbolKind::None | SymbolKind::Joints => {}
            SymbolKind::Actions => {
                for vector in &self.pictured.action_vectors {
                    arrow(vector.at, 2, 5.0 * sizes.joint, colours::MEASURE);
                }
            }
            SymbolKind::Markers => {
                for triad in &self.pictured.triads {
                    for (axis, colour) in colours::AXES.into_iter().enumerate() {
                        arrow(triad.at, axis, 2.5 * sizes.joint, colour);
                    }
                }
            }
        }
        let opacity = 1.0;
        Layer { marks, opacity }
    }

    /// Returns the dimensions at a row, each with its value.
    pub(super) fn dimensions(&self, row: usize) -> Layer {
        let Pictured {
            bodies,
            track,
            sizes,
            dimensions,
            ..
        } = self.pictured;
        let mut marks = Vec::new();
        let colour = colours::MEASURE;
        for dimension in dimensions {
            let [a, b] = dimension.places(bodies, track, row);
            let middle = self.projection.point((a + b).times(0.5));
            for end in [a, b].map(|p| self.projection.point(p)) {
                marks.extend(arrow_between(middle, end, AXIS_WIDTH * sizes.joint, colour));
            }
            let value = crate::results::digits_of_six((a - b).norm());
            marks.push(Mark::Word {
                at: middle,
                text: format!("{value} {}", self.wanted.unit)
                    .trim_end()
                    .to_owned(),
                colour,
            });
        }
        let opacity = 1.0;
        Layer { marks, opacity }
    }

    /// Returns the arrows of the forces that act at a row.
    pub(super) fn forces(&self, row: usize) -> Layer {
        let Pictured {
            bodies,
            track,
            arrows,
            sizes,
            ..
        } = self.pictured;
        let force = |load: usize| {
            let values = track.loads[load]
                .values
                .get(row)
                .copied()
                .unwrap_or_default();
            Vec3([values[0], values[1], values[2]])
        };
        let acting = || arrows.iter().filter(|a| !a.is_reaction);
        let largest = acting()
            .map(|a| force(a.load).norm())
            .filter(|f| f.is_finite())
            .fold(0.0, f64::max);
        let mut marks = Vec::new();
        for arrow in acting() {
            let f = force(arrow.load);
            let length = ARROW * sizes.whole * f.norm() / largest;
            if !(largest > 0.0 && length > 0.02 * sizes.whole) {
                continue;
            }
            let from = arrow.from(bodies, track, row);
            let to = from + f.times(length / f.norm());
            let (a, b) = (self.projection.point(from), self.projection.point(to));
            marks.extend(arrow_between(a, b, 0.35 * sizes.joint, colours::FORCE));
        }
        let opacity = 1.0;
        Layer { marks, opacity }
    }

    /// Returns the names at a row.
    pub(super) fn names(&self, row: usize) -> Layer {
        let Pictured {
            bodies,
            track,
            pieces,
            ..
        } = self.pictured;
        let (of_bodies, of_joints) = match self.wanted.names {
            Names::None => (false, false),
            Names::Bodies => (true, false),
            Names::All => (true, true),
        };
        let middle = |points: Vec<[f64; 3]>| {
            let n = points.len() as f64;
            points
                .into_iter()
                .fold(Vec3::zero(), |sum, p| sum + Vec3(p))
                .times(1.0 / n)
        };
        let mut marks = Vec::new();
        let word = |at: Vec3<f64>, text: &str, colour: [u8; 3]| Mark::Word {
            at: self.projection.point(at),
            text: text.to_owned(),
            colour: shaded(colour, 0.62),
        };
        for (k, body) in bodies
            .all
            .iter()
            .enumerate()
            .filter(|(_, b)| of_bodies && !b.is_ground)
        {
            let own = pieces.iter().filter(|p| p.body == k);
            let own: Vec<&Piece> = own.collect();
            let body_itself = own.iter().filter(|p| p.role != Role::Joint);
            let mut marks_of: Vec<[f64; 3]> = body_itself.flat_map(|p| p.form.marks()).collect();
            if marks_of.is_empty() {
                marks_of = own.iter().flat_map(|p| p.form.marks()).collect();
            }
            if !marks_of.is_empty() {
                let at = track.frame(bodies, k, row).point(middle(marks_of));
                marks.push(word(at, &body.name, body.colour));
            }
        }
        let of_markers = of_joints && self.wanted.symbols == SymbolKind::Markers;
        let beside = self.projection.right.times(-1.0) - self.projection.up;
        for triad in self.pictured.triads.iter().filter(|_| of_markers) {
            let frame = track.frame(bodies, triad.at.body, row);
            let place = frame.point(triad.at.frame.position);
            let at = place + beside.times(1.2 * self.pictured.sizes.joint);
            marks.push(word(at, &triad.element.to_string(), colours::JOINT));
        }
        let of_joints = of_joints && self.wanted.symbols.has_joints();
        let mut named = BTreeSet::new();
        let joints = pieces.iter().filter(|p| of_joints && p.role == Role::Joint);
        for piece in joints.filter(|p| named.insert(p.element)) {
            let at = track
                .frame(bodies, piece.body, row)
                .point(middle(piece.form.marks()));
            let above = self.projection.up.times(2.2 * self.pictured.sizes.joint);
            marks.push(word(at + above, &piece.element.to_string(), colours::JOINT));
        }
        let opacity = 1.0;
        Layer { marks, opacity }
    }
}

/// Returns an arrow.
fn arrow_between(a: Point, b: Point, width: f64, colour: [u8; 3]) -> Vec<Mark> {
    let d = [b[0] - a[0], b[1] - a[1]];
    let length = d[0].hypot(d[1]);
    if length < 1e-9 * width {
        return Vec::new();
    }
    let unit = d.map(|x| x / length);
    let head = (5.0 * width).min(0.7 * length);
    let neck = [b[0] - head * unit[0], b[1] - head * unit[1]];
    let half = 0.42 * head;
    let side = |s: f64| [neck[0] - s * half * unit[1], neck[1] + s * half * unit[0]];
    vec![
        Mark::Stroke {
            points: vec![a, neck],
            width,
            colour,
            is_rod: false,
        },
        Mark::Faces {
            outlines: vec![vec![b, side(1.0), side(-1.0)]],
            colour,
            edges: false,
            sheer: false,
        },
    ]
}
