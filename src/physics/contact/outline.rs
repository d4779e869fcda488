//! An outline: a plane curve as the rim of a solid, divided into cells so that it can be searched.
//!
//! The curve `c(s)` lies in the x–y plane of its marker. Its outside is to the left of its
//! direction, `n = z × t`, so that a profile drawn towards +x is the ground below a solid; a closed
//! curve has its outside outside, whichever way it is drawn. IFLIP and JFLIP reverse the outside: a
//! closed curve becomes a hole. (The default side of an open curve is not public; this one is the y
//! axis of the floating markers of CVCV.)
//!
//! - A **cell** lies between two parameters, within one polynomial, and turns by at most
//!   `CELL_TURN`.
//! - A **corner** is a jump of the tangent, or an end of an open curve: a point that touches with
//!   every normal between those of its sides. Behind an end the outside turns by a quarter turn.
//! - Cells are the leaves of a binary **tree**; each node has a circle about its cells and the
//!   range of the directions of their normals.
use super::super::cam::Path;
use crate::scalar::Scalar;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// A vector in the plane.
pub type Flat = [f64; 2];

/// Largest change of direction within a cell, in rad.
const CELL_TURN: f64 = 0.12;
/// Number of cells of a whole curve, from the least to the most.
const CELLS: Range<usize> = 64..65_536;
/// Jump of the tangent, in rad, below which it counts as smooth.
const SMOOTH_JUMP: f64 = 1e-5;

pub(super) fn dot(a: Flat, b: Flat) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}
pub(super) fn cross(a: Flat, b: Flat) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
pub(super) fn minus(a: Flat, b: Flat) -> Flat {
    [a[0] - b[0], a[1] - b[1]]
}
/// Returns a + k b.
pub(super) fn along(a: Flat, k: f64, b: Flat) -> Flat {
    [a[0] + k * b[0], a[1] + k * b[1]]
}
pub(super) fn length(a: Flat) -> f64 {
    // hypot, which avoids overflow, takes five times as long
    dot(a, a).sqrt()
}
/// Wraps an angle to between −π and π.
pub(super) fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// The curve of an outline.
#[derive(Clone, Debug)]
pub enum Rim {
    /// a CURVE
    Path(Box<Path>),
    /// a circle about the origin, or an arc of it: radius, and the angle that it covers from x on,
    /// in rad
    Circle(f64, f64),
    /// the origin alone
    Point,
}

impl Rim {
    /// Returns the derivative of some order with respect to the parameter.
    pub(super) fn at(&self, s: f64, order: u32) -> Flat {
        match self {
            Rim::Path(path) => {
                let p = path.at::<f64>(s, order);
                [p.0[0], p.0[1]]
            }
            Rim::Circle(radius, angle) => {
                let half = 0.5 * angle;
                let (sin, cos) = Scalar::sin_cos(half * (s + 1.0));
                match order {
                    0 => [radius * cos, radius * sin],
                    1 => [-radius * half * sin, radius * half * cos],
                    _ => [-radius * half * half * cos, -radius * half * half * sin],
                }
            }
            Rim::Point => [0.0; 2],
        }
    }
    pub(super) fn is_closed(&self) -> bool {
        match self {
            Rim::Path(path) => path.closed,
            Rim::Circle(_, angle) => *angle >= TAU,
            Rim::Point => false,
        }
    }
    /// Returns the parameters between which it is smooth, from end to end.
    pub(super) fn knots(&self) -> Vec<f64> {
        match self {
            Rim::Path(path) => path.knots.clone(),
            Rim::Circle(..) => vec![-1.0, 1.0],
            Rim::Point => Vec::new(),
        }
    }
}

/// A piece of an outline.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    /// parameters of its ends
    pub s: [f64; 2],
    /// points at its ends
    pub ends: [Flat; 2],
    /// whether it is straight
    pub straight: bool,
    /// corners at its ends: indices in [`Outline::corners`]
    pub corner: [Option<usize>; 2],
}

/// A jump of the tangent, or an end of an open curve.
#[derive(Clone, Debug)]
pub(super) struct Corner {
    /// the point
    pub at: Flat,
    /// directions of the normals of the sides before and after it, in rad
    pub normals: [f64; 2],
    /// whether outside turns away from it, or it is an end
    pub convex: bool,
    /// whether the sides before and after it are straight
    pub straight: [bool; 2],
}

/// A node of the tree: adjacent cells.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// the range of the cells
    pub cells: Range<usize>,
    /// centre of a circle about the cells
    pub centre: Flat,
    /// radius of that circle, in length units
    pub radius: f64,
    /// middle direction of their normals, in rad
    pub normal: f64,
    /// largest deviation from that direction, in rad
    pub spread: f64,
    /// whether all cells are straight
    pub straight: bool,
    /// the two child nodes; none of a single cell
    pub halves: Option<[usize; 2]>,
}

/// A plane curve as the rim of a solid.
#[derive(Clone, Debug)]
pub struct Outline {
    /// the curve
    rim: Rim,
    /// +1 if outside is to the left of its direction, else −1
    side: f64,
    /// cells, in the order of the parameter
    pub(super) cells: Vec<Cell>,
    /// corners, in the order of the parameter
    pub(super) corners: Vec<Corner>,
    /// nodes of the tree; the last is the root
    pub(super) nodes: Vec<Node>,
    /// whether it returns to its beginning
    pub(super) closed: bool,
    /// whether its solid lies within it
    encloses: bool,
    /// radius of the circle about it, in length units
    pub size: f64,
}

/// Place, tangent, second derivative and normal of a point of an outline.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// the point
    pub at: Flat,
    /// first derivative with respect to the parameter
    pub tangent: Flat,
    /// second derivative with respect to the parameter
    pub bend: Flat,
    /// outward unit normal
    pub normal: Flat,
}

impl Spot {
    /// Returns the curvature; positive where the outline bulges outwards.
    pub fn curvature(&self) -> f64 {
        -dot(self.bend, self.normal) / dot(self.tangent, self.tangent)
    }
}

impl Outline {
    /// Builds the outline of a rim; `flipped` puts its outside inside. `None` if the rim has no
    /// length.
    pub fn new(rim: Rim, flipped: bool) -> Option<Self> {
        let closed = rim.is_closed();
        let mut this = Self {
            rim,
            side: 1.0,
            cells: Vec::new(),
            corners: Vec::new(),
            nodes: Vec::new(),
            closed,
            encloses: closed && !flipped,
            size: 0.0,
        };
        if matches!(this.rim, Rim::Point) {
            this.corners.push(Corner {
                at: [0.0; 2],
                normals: [0.0; 2],
                convex: true,
                straight: [false; 2],
            });
            return Some(this);
        }
        this.divide();
        if this.cells.is_empty() {
            return None;
        }
        if closed {
            let twice = |c: &Cell| cross(c.ends[0], c.ends[1]);
            let area: f64 = this.cells.iter().map(twice).sum();
            this.side = if area > 0.0 { -1.0 } else { 1.0 };
        }
        if flipped {
            this.side = -this.side;
        }
        this.find_corners();
        let leaves: Vec<usize> = (0..this.cells.len()).map(|c| this.leaf(c)).collect();
        this.tree(&leaves);
        let root = this.nodes.last()?;
        // circles about circles are larger than needed
        let ends = this.cells.iter().flat_map(|c| c.ends);
        let sizes = ends.map(|end| length(minus(end, root.centre)));
        this.size = sizes.fold(0.0, f64::max);
        (this.size > 0.0 && this.size.is_finite()).then_some(this)
    }

    pub(super) fn rim(&self) -> &Rim {
        &self.rim
    }

    /// Returns whether it is a point.
    pub fn is_point(&self) -> bool {
        self.cells.is_empty()
    }

    /// Evaluates the outline at a parameter.
    pub(super) fn spot(&self, s: f64) -> Spot {
        let [at, tangent, bend] = [0, 1, 2].map(|k| self.rim.at(s, k));
        Spot {
            at,
            tangent,
            bend,
            normal: self.normal(tangent),
        }
    }

    /// Returns the outward normal to a tangent.
    pub(super) fn normal(&self, tangent: Flat) -> Flat {
        let k = self.side / length(tangent);
        [-tangent[1] * k, tangent[0] * k]
    }

    /// Returns the direction of the normal at a part of a cell, in rad.
    fn direction(&self, cell: usize, part: f64) -> f64 {
        let [a, b] = self.cells[cell].s;
        let n = self.normal(self.rim.at(a + (b - a) * part, 1));
        Scalar::atan2(n[1], n[0])
    }

    /// Divides the curve into cells that turn little, each within a polynomial.
    fn divide(&mut self) {
        let knots = self.rim.knots();
        let mut points = Vec::new();
        for pair in knots.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            if b - a <= 0.0 {
                continue;
            }
            let directions: Vec<f64> = (0..=16)
                .map(|k| {
                    self.rim
                        .at(a + (b - a) * (f64::from(k) + 1e-6) / 16.00001, 1)
                })
                .map(|t| Scalar::atan2(t[1], t[0]))
                .collect();
            let turn: f64 = directions
                .windows(2)
                .map(|d| wrapped(d[1] - d[0]).abs())
                .sum();
            let share = (b - a) / 2.0 * CELLS.start as f64;
            let n = (turn / CELL_TURN).max(share).ceil();
            // a tangent that is not a number yields no cells
            let n = if n.is_finite() {
                (n as usize).clamp(1, CELLS.start * 8)
            } else {
                1
            };
            points.extend((0..n).map(|k| a + (b - a) * k as f64 / n as f64));
        }
        if points.len() > CELLS.end {
            let stride = points.len().div_ceil(CELLS.end);
            points = points.into_iter().step_by(stride).collect();
        }
        points.extend(knots.last());
        for pair in points.windows(2) {
            let s = [pair[0], pair[1]];
            let ends = s.map(|s| self.rim.at(s, 0));
            let size = length(minus(ends[1], ends[0]));
            if size > 0.0 && size.is_finite() {
                let middle = self.rim.at(0.5 * (s[0] + s[1]), 1);
                let tangents = [1e-7, 1.0 - 1e-7].map(|u| self.rim.at(s[0] + (s[1] - s[0]) * u, 1));
                let bent = |t: Flat| (cross(t, middle) / dot(middle, middle)).abs();
                self.cells.push(Cell {
                    s,
                    ends,
                    straight: tangents.into_iter().all(|t| bent(t) < 1e-9),
                    corner: [None; 2],
                });
            }
        }
    }

    /// Finds the corners between cells and at the ends.
    fn find_corners(&mut self) {
        let n = self.cells.len();
        let last = if self.closed { n } else { n + 1 };
        for k in 0..last {
            // between cell k − 1 and cell k
            let before = if k > 0 || self.closed {
                Some((k + n - 1) % n)
            } else {
                None
            };
            let after = (k < n).then_some(k);
            let corner = match (before, after) {
                (Some(b), Some(a)) => {
                    let normals = [self.direction(b, 1.0 - 1e-7), self.direction(a, 1e-7)];
                    let jump = wrapped(normals[1] - normals[0]);
                    // with the outside on the left a turn to the right is convex
                    (jump.abs() > SMOOTH_JUMP).then(|| Corner {
                        at: self.cells[a].ends[0],
                        normals,
                        convex: jump * self.side < 0.0,
                        straight: [self.cells[b].straight, self.cells[a].straight],
                    })
                }
                (None, Some(a)) => {
                    let normal = self.direction(a, 1e-7);
                    Some(Corner {
                        at: self.cells[a].ends[0],
                        normals: [normal + self.side * 0.5 * PI, normal],
                        convex: true,
                        straight: [false, self.cells[a].straight],
                    })
                }
                (Some(b), None) => {
                    let normal = self.direction(b, 1.0 - 1e-7);
                    Some(Corner {
                        at: self.cells[b].ends[1],
                        normals: [normal, normal - self.side * 0.5 * PI],
                        convex: true,
                        straight: [self.cells[b].straight, false],
                    })
                }
                (None, None) => None,
            };
            if let Some(corner) = corner {
                let index = Some(self.corners.len());
                self.corners.push(corner);
                if let Some(b) = before {
                    self.cells[b].corner[1] = index;
                }
                if let Some(a) = after {
                    self.cells[a].corner[0] = index;
                }
            }
        }
    }

    /// Returns the centre of the circle about it.
    pub fn middle(&self) -> Flat {
        self.nodes.last().map_or([0.0; 2], |root| root.centre)
    }

    /// Adds the node of a cell; returns its index.
    fn leaf(&mut self, cell: usize) -> usize {
        let c = &self.cells[cell];
        let (s, straight) = (c.s, c.straight);
        let middle = [0, 1].map(|k| 0.5 * (c.ends[0][k] + c.ends[1][k]));
        let inside = (0..=4).map(|k| s[0] + (s[1] - s[0]) * f64::from(k) / 4.0);
        let reach = inside.map(|s| length(minus(self.rim.at(s, 0), middle)));
        let radius = 1.02 * reach.fold(0.0, f64::max);
        let normal = self.direction(cell, 0.5);
        let deviations =
            [1e-7, 0.25, 0.75, 1.0 - 1e-7].map(|u| wrapped(self.direction(cell, u) - normal).abs());
        let spread = 1.1 * deviations.into_iter().fold(0.0, f64::max) + 1e-9;
        self.nodes.push(Node {
            cells: cell..cell + 1,
            centre: middle,
            radius,
            normal,
            spread,
            straight,
            halves: None,
        });
        self.nodes.len() - 1
    }

    /// Adds the nodes above some leaves; returns the index of the topmost.
    fn tree(&mut self, leaves: &[usize]) -> usize {
        if let [only] = leaves {
            return *only;
        }
        let (a, b) = leaves.split_at(leaves.len() / 2);
        let halves = [self.tree(a), self.tree(b)];
        let [a, b] = halves.map(|h| &self.nodes[h]);
        let apart = minus(b.centre, a.centre);
        let distance = length(apart);
        let radius = (0.5 * (distance + a.radius + b.radius))
            .max(a.radius)
            .max(b.radius);
        let centre = if distance > 0.0 {
            along(a.centre, (radius - a.radius) / distance, apart)
        } else {
            a.centre
        };
        let turn = wrapped(b.normal - a.normal);
        // from the lowest direction to the highest, relative to a
        let low = (-a.spread).min(turn - b.spread);
        let high = a.spread.max(turn + b.spread);
        let node = Node {
            cells: a.cells.start..b.cells.end,
            centre,
            radius,
            normal: a.normal + 0.5 * (low + high),
            spread: 0.5 * (high - low),
            straight: a.straight && b.straight,
            halves: Some(halves),
        };
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    pub(super) fn root(&self) -> Option<usize> {
        self.nodes.len().checked_sub(1)
    }

    /// Returns whether a point may be in the solid, or close to it: within `near` of a solid inside
    /// its outline, within `limit` of any other.
    pub(super) fn may_hold(&self, p: Flat, near: f64, limit: f64) -> bool {
        let margin = if self.encloses { near } else { limit };
        self.nodes
            .last()
            .is_some_and(|root| length(minus(p, root.centre)) <= root.radius + margin)
    }

    /// Returns the parameter of the point of a cell that is nearest to `p`, and that point.
    fn nearest_of(&self, cell: usize, p: Flat) -> (f64, Flat) {
        let c = &self.cells[cell];
        let ([a, b], ends) = (c.s, c.ends);
        let chord = minus(ends[1], ends[0]);
        let u = dot(minus(p, ends[0]), chord) / dot(chord, chord);
        let u = u.clamp(0.0, 1.0);
        let mut s = a + (b - a) * u;
        if c.straight {
            return (s, along(ends[0], u, chord));
        }
        for _ in 0..20 {
            let [c, t, bend] = [0, 1, 2].map(|k| self.rim.at(s, k));
            let d = minus(p, c);
            let slope = dot(t, t) - dot(d, bend);
            // beyond the centre of curvature the slope is that of a straight line
            let slope = if slope > 0.0 { slope } else { dot(t, t) };
            let next = (s + dot(d, t) / slope).clamp(a, b);
            let step = next - s;
            s = next;
            if step.abs() <= 1e-15 {
                break;
            }
        }
        (s, self.rim.at(s, 0))
    }

    /// Finds the point nearest to `p` within some distance: its cell, its parameter, and the point.
    /// `hint`: a point of the outline that may be close.
    pub(super) fn nearest(
        &self,
        p: Flat,
        within: f64,
        hint: Option<Flat>,
    ) -> Option<(usize, f64, Flat)> {
        // no farther than any known point of the outline, which rounding must not exclude
        let known = |at: Flat| length(minus(p, at)) * (1.0 + 1e-12) + f64::MIN_POSITIVE;
        let mut best = (hint.map_or(within, |at| known(at).min(within)), None);
        let mut waiting = Vec::with_capacity(64);
        waiting.extend(self.root());
        while let Some(k) = waiting.pop() {
            let node = &self.nodes[k];
            if length(minus(p, node.centre)) - node.radius > best.0 {
                continue;
            }
            let known = known(self.cells[node.cells.start].ends[0]);
            if known < best.0 {
                best = (known, None);
            }
            match node.halves {
                Some([a, b]) => {
                    let far =
                        |k: usize| length(minus(p, self.nodes[k].centre)) - self.nodes[k].radius;
                    // the nearer half is examined first
                    waiting.extend(if far(a) < far(b) { [b, a] } else { [a, b] });
                }
                None => {
                    let cell = node.cells.start;
                    let (s, at) = self.nearest_of(cell, p);
                    let distance = length(minus(p, at));
                    if distance < best.0 || best.1.is_none() && distance <= best.0 {
                        best = (distance, Some((cell, s, at)));
                    }
                }
            }
        }
        best.1
    }

    /// Returns whether the straight line from `p` to `q` crosses a cell that is not adjacent to
    /// `own`.
    pub(super) fn is_crossed(&self, p: Flat, q: Flat, own: usize) -> bool {
        let way = minus(q, p);
        let size2 = dot(way, way);
        let mut waiting: Vec<usize> = self.root().into_iter().collect();
        while let Some(k) = waiting.pop() {
            let node = &self.nodes[k];
            let u = (dot(minus(node.centre, p), way) / size2).clamp(0.0, 1.0);
            if length(minus(node.centre, along(p, u, way))) > node.radius {
                continue;
            }
            if let Some(halves) = node.halves {
                waiting.extend(halves);
                continue;
            }
            let cell = node.cells.start;
            let n = self.cells.len();
            let apart = cell.abs_diff(own);
            let apart = if self.closed {
                apart.min(n - apart)
            } else {
                apart
            };
            let [a, b] = self.cells[cell].ends;
            let sides = [a, b].map(|x| cross(way, minus(x, p)) >= 0.0);
            let ends = [p, q].map(|x| cross(minus(b, a), minus(x, a)) >= 0.0);
            if apart > 2 && sides[0] != sides[1] && ends[0] != ends[1] {
                return true;
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(radius: f64) -> Outline {
        Outline::new(Rim::Circle(radius, TAU), false).unwrap()
    }

    #[test]
    fn the_outside_of_a_circle_is_outside() {
        for (flipped, sign) in [(false, 1.0), (true, -1.0)] {
            let o = Outline::new(Rim::Circle(2.0, TAU), flipped).unwrap();
            assert!(o.corners.is_empty());
            for s in [-0.9, -0.2, 0.3, 0.77] {
                let spot = o.spot(s);
                assert!((dot(spot.at, spot.normal) - 2.0 * sign).abs() < 1e-14);
                assert!((spot.curvature() - 0.5 * sign).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn the_nearest_point_of_a_circle_lies_on_its_radius() {
        let o = circle(1.5);
        for k in 0..200 {
            let angle = f64::from(k) * 0.37;
            let p = [0.1 + 0.02 * f64::from(k), 1.0].map(|r| r * 1.0);
            let p = [p[0] * angle.cos(), p[0] * angle.sin()];
            let (_, _, at) = o.nearest(p, 100.0, None).unwrap();
            assert!((length(at) - 1.5).abs() < 1e-14);
            assert!(cross(p, at).abs() < 1e-13 && dot(p, at) > 0.0);
        }
    }

    #[test]
    fn a_node_holds_its_cells_and_their_normals() {
        let o = Outline::new(Rim::Circle(1.0, 2.0), false).unwrap();
        // an open arc has two ends
        assert_eq!(o.corners.len(), 2);
        for node in &o.nodes {
            for cell in &o.cells[node.cells.clone()] {
                for u in [0.0, 0.3, 0.9, 1.0] {
                    let spot = o.spot(cell.s[0] + (cell.s[1] - cell.s[0]) * u);
                    assert!(length(minus(spot.at, node.centre)) <= node.radius);
                    let direction = spot.normal[1].atan2(spot.normal[0]);
                    assert!(wrapped(direction - node.normal).abs() <= node.spread);
                }
            }
        }
    }
}
