//! Model → Scene, in named passes: frames, ties, forest, links, rows, forces.

use super::forest::{self, Candidate, Carried};
use super::unknown::{CoordinateId, UnknownId, Variable};
use super::{
    ConstraintElement, Coordinate, Link, LinkIx, LinkMotion, MarkerOnLink, PartOnLink, Row,
    RowKind, Source,
};
use crate::diagnostic::{Diagnostic, Subject};
use crate::model::geometry::orientation;
use crate::model::{ElementId, ElementKind, Model, Part};
use crate::physics::joint::{Motion, Tie, quarter_x};
use crate::scalar::Scalar;
use crate::space::{Frame, Mat3, Vec3, rotation};
use std::collections::BTreeMap;

/// Findings of the passes so far. Errors collect; none ends a pass.
pub(super) struct Compiler<'m> {
    pub model: &'m Model,
    pub errors: Vec<Diagnostic>,
    pub parts: Vec<PartOnLink>,
    pub part_of: BTreeMap<ElementId, Option<usize>>,
    pub markers: Vec<MarkerOnLink>,
    pub marker_of: BTreeMap<u32, usize>,
    pub links: Vec<Link>,
    pub coordinates: Vec<Coordinate>,
    pub rows: Vec<Row>,
    pub constraints: Vec<ConstraintElement>,
    /// identities of the positions of the forest   (n_q)
    pub positions: Vec<UnknownId>,
    /// identities of its velocities   (n_v)
    pub velocities: Vec<UnknownId>,
    /// initial positions of the forest from the dataset's part frames   (n_q)
    pub q: Vec<f64>,
    /// driven joint freedoms: (joint, rotational) → index of the motion
    pub driven: BTreeMap<(u32, bool), usize>,
    /// joint → its coordinates in the forest, with translation/rotation
    pub joint_coordinates: BTreeMap<u32, Vec<usize>>,
}

/// A tie of the model: what it is, where, and its name.
pub(super) struct NamedTie {
    pub kind: Tie,
    pub i: u32,
    pub j: u32,
    pub id: ElementId,
    pub joint: Option<u32>,
}

impl<'m> Compiler<'m> {
    pub fn new(model: &'m Model) -> Self {
        Self {
            model,
            errors: Vec::new(),
            parts: Vec::new(),
            part_of: BTreeMap::new(),
            markers: Vec::new(),
            marker_of: BTreeMap::new(),
            links: Vec::new(),
            coordinates: Vec::new(),
            rows: Vec::new(),
            constraints: Vec::new(),
            positions: Vec::new(),
            velocities: Vec::new(),
            q: Vec::new(),
            driven: BTreeMap::new(),
            joint_coordinates: BTreeMap::new(),
        }
    }

    pub fn error(&mut self, element: impl Into<Subject>, message: impl Into<String>) {
        self.errors
            .push(Diagnostic::error("model", message).element(element));
    }

    /// Parts and markers with the frames of the dataset; nothing is carried yet.
    pub fn frames(&mut self) {
        let model = self.model;
        for (id, part) in model.bodies() {
            if part.ground {
                self.part_of.insert(id, None);
                continue;
            }
            let initial = match orientation(&part.orientation, part.qg) {
                Ok(rotation) => Frame {
                    rotation,
                    position: Vec3(part.qg),
                },
                Err(why) => {
                    self.error(id, why);
                    Frame::identity()
                }
            };
            self.part_of.insert(id, Some(self.parts.len()));
            self.parts.push(PartOnLink {
                id,
                link: None,
                frame: Frame::identity(),
                initial,
            });
        }
        for (&id, marker) in &model.markers {
            if marker.floating {
                continue;
            }
            let Some(body) = marker.owner.body() else {
                continue;
            };
            let name = ElementKind::Marker.id(id);
            let Some(&part) = self.part_of.get(&body) else {
                self.error(name, format!("its part {body} does not exist"));
                continue;
            };
            match orientation(&marker.orientation, marker.qp) {
                Ok(rotation) => {
                    self.marker_of.insert(id, self.markers.len());
                    let frame = Frame {
                        rotation,
                        position: Vec3(marker.qp),
                    };
                    self.markers.push(MarkerOnLink {
                        id,
                        link: None,
                        frame,
                        part,
                    });
                }
                Err(why) => self.error(name, why),
            }
        }
    }

    /// Index of a marker; an error names the element that asks when there is none.
    pub fn marker(&mut self, id: u32, asked_by: ElementId) -> Option<usize> {
        let found = self.marker_of.get(&id).copied();
        if found.is_none() {
            let why = match self.model.markers.get(&id) {
                Some(m) if m.floating => "is FLOATING and has no frame of its own",
                Some(_) => "belongs to something that is not solved here",
                None => "does not exist",
            };
            let what = format!("{} {why}", ElementKind::Marker.id(id));
            let error = Diagnostic::error("unknown_marker", what);
            self.errors.push(error.element(asked_by));
        }
        found
    }

    /// Pose of a marker in ground as the dataset has it.
    pub fn initial_frame(&self, marker: usize) -> Frame<f64> {
        let m = &self.markers[marker];
        m.part
            .map_or(m.frame, |p| self.parts[p].initial.compose(&m.frame))
    }

    /// Grows the forest and makes its links. `cut` says which ties must be rows.
    pub fn forest(
        &mut self,
        ties: &[NamedTie],
        cut: impl Fn(&NamedTie) -> bool,
        preferred: &dyn Fn(&NamedTie) -> bool,
    ) {
        let mut candidates = Vec::new();
        for (tie, t) in ties.iter().enumerate() {
            let (Some(i), Some(j)) = (self.marker(t.i, t.id), self.marker(t.j, t.id)) else {
                continue;
            };
            let point = |m: usize| {
                let part = self.markers[m].part;
                part.is_some_and(|p| self.parts[p].is_point_mass())
            };
            candidates.push(Candidate {
                tie,
                kind: t.kind,
                i: self.markers[i].part,
                j: self.markers[j].part,
                cut: cut(t) || point(i) || point(j),
                preferred: preferred(t),
            });
        }
        let order = forest::grow(self.parts.len(), &candidates);
        let mut carrying = vec![None; ties.len()];
        for placed in order {
            let end = match placed.by {
                Carried::Free => self.carry_free(placed.part),
                Carried::Forward(t) | Carried::Backward(t) => {
                    let backward = matches!(placed.by, Carried::Backward(_));
                    let end = self.carry(&ties[t], backward);
                    carrying[t] = end.0.map(|link| (link, backward));
                    end
                }
            };
            self.attach(placed.part, end);
        }
        for m in 0..self.markers.len() {
            if let Some(p) = self.markers[m].part {
                self.markers[m].link = self.parts[p].link;
                self.markers[m].frame = self.parts[p].frame.compose(&self.markers[m].frame);
                let r = &mut self.markers[m].frame.rotation;
                *r = rotation::snapped(r);
            }
        }
        for (t, tie) in ties.iter().enumerate() {
            let first = self.rows.len();
            if carrying[t].is_none() {
                self.close(tie);
            }
            let markers = self
                .marker_of
                .get(&tie.i)
                .copied()
                .zip(self.marker_of.get(&tie.j).copied());
            self.constraints.push(ConstraintElement {
                id: tie.id,
                markers,
                acts_on: markers.iter().map(|m| m.0).collect(),
                joins: Vec::new(),
                about: markers.map(|m| m.0),
                carries: carrying[t],
                laws: tie.kind.rows(),
                rows: first..self.rows.len(),
                coordinate: None,
            });
        }
    }

    /// Links for the chain of a tie; returns the last link and the part's frame on it.
    fn carry(&mut self, tie: &NamedTie, backward: bool) -> (LinkIx, Frame<f64>) {
        let (i, j) = (self.marker_of[&tie.i], self.marker_of[&tie.j]);
        let chain = tie.kind.motions().unwrap_or(&[]);
        let relative = self
            .initial_frame(j)
            .inverse()
            .compose(&self.initial_frame(i)); // X_JI
        // fit the joint's variables to where the dataset has its markers
        let mut fitted = fit(chain, &relative);
        if backward {
            let turned_back = rotation::to_quaternion(&relative.rotation.transpose());
            for (motion, fitted) in chain.iter().zip(&mut fitted) {
                if *motion == Motion::Ball {
                    fitted.copy_from_slice(&turned_back);
                }
            }
        }
        // begin at the carrier's marker, on the carrier's link
        let (from, to) = if backward { (i, j) } else { (j, i) };
        let (mut parent, mut placement) = match self.markers[from].part {
            None => (None, self.markers[from].frame),
            Some(p) => (
                self.parts[p].link,
                self.parts[p].frame.compose(&self.markers[from].frame),
            ),
        };
        // add a link per motion: numbered in the order of the links, so that what carries comes
        // first; kept in the order of the joint's table
        let steps: Vec<usize> = if backward {
            (0..chain.len()).rev().collect()
        } else {
            (0..chain.len()).collect()
        };
        let mut own = vec![Vec::new(); chain.len()];
        for k in steps {
            if chain[k] == Motion::QuarterX {
                let quarter = if backward {
                    quarter_x().transpose()
                } else {
                    quarter_x()
                };
                placement = placement.compose(&Frame {
                    rotation: quarter,
                    position: Vec3::zero(),
                });
                continue;
            }
            let motion = self.link_motion(chain[k], backward);
            own[k] = self.add_coordinates(tie, chain, k, &fitted[k]);
            parent = self.push_link(parent, placement, motion, &own[k]);
            placement = Frame::identity();
        }
        if let Some(id) = tie.joint {
            self.joint_coordinates
                .insert(id, own.iter().flatten().copied().collect());
        }
        if chain.is_empty() {
            parent = self.push_link(parent, placement, LinkMotion::Rigid, &[]);
            placement = Frame::identity();
        }
        // what is left of the placement (a trailing quarter turn) belongs to the part's frame on
        // the last link
        (parent, placement.compose(&self.markers[to].frame.inverse()))
    }

    /// Returns the motion of a link whose coordinates come next; backward it is passed from I to J.
    fn link_motion(&self, motion: Motion, backward: bool) -> LinkMotion {
        let sign = if backward { -1.0 } else { 1.0 };
        let coordinate = self.coordinates.len();
        match motion {
            Motion::QuarterX => LinkMotion::Rigid,
            Motion::Slide(axis) => LinkMotion::Slide {
                axis,
                sign,
                coordinate,
            },
            Motion::Turn(axis) => LinkMotion::Turn {
                axis,
                sign,
                coordinate,
            },
            Motion::Ball => LinkMotion::Ball {
                coordinate,
                quaternion: self.positions.len(),
            },
        }
    }

    /// Adds the coordinates of motion `k` of a tie's chain, driven or free, and the positions of
    /// the free ones: `fitted`, one number or a quaternion. Returns the indices of the coordinates.
    fn add_coordinates(
        &mut self,
        tie: &NamedTie,
        chain: &[Motion],
        k: usize,
        fitted: &[f64],
    ) -> Vec<usize> {
        let angular = !matches!(chain[k], Motion::Slide(_));
        let fixed_axis = matches!(chain[k], Motion::Slide(2) | Motion::Turn(2));
        let drive = (tie.joint.filter(|_| fixed_axis))
            .and_then(|id| self.driven.get(&(id, angular)).copied());
        let first = self.coordinates.len();
        for variable in variables(chain, k) {
            let id = CoordinateId {
                element: tie.id,
                variable,
            };
            let source = match drive {
                Some(motion) => Source::Driven(motion),
                None => self.add_velocity(id),
            };
            self.coordinates.push(Coordinate {
                initial: (fitted.len() == 1).then(|| fitted[0]),
                id,
                joint: tie.joint,
                angular,
                source,
                link: 0,
            });
        }
        if drive.is_none() {
            self.add_positions(first, fitted);
        }
        (first..self.coordinates.len()).collect()
    }

    /// Adds the velocity of a coordinate, whose position comes next; returns their places.
    fn add_velocity(&mut self, id: CoordinateId) -> Source {
        self.velocities.push(UnknownId::Velocity(id));
        Source::Free {
            q: self.positions.len(),
            v: self.velocities.len() - 1,
        }
    }

    /// Adds positions that begin with these values: that of a coordinate, the quaternion of a ball
    /// whose first coordinate it is, or none.
    fn add_positions(&mut self, coordinate: usize, values: &[f64]) {
        self.q.extend_from_slice(values);
        let Some(id) = self.coordinates.get(coordinate).map(|c| c.id) else {
            return;
        };
        match values.len() {
            1 => self.positions.push(UnknownId::Position(id)),
            n => (self.positions)
                .extend((0..n).map(|number| UnknownId::EulerParameter { ball: id, number })),
        }
    }

    /// Links for a part that nothing carries: three slides along ground axes and a ball at its
    /// centre of mass.
    fn carry_free(&mut self, part: usize) -> (LinkIx, Frame<f64>) {
        let name = self.parts[part].id;
        let data = self.part_data(part);
        let cm = data
            .cm
            .and_then(|m| self.marker_of.get(&m))
            .map(|&m| self.markers[m].frame);
        let centre = cm.unwrap_or_else(Frame::identity); // X_PC
        let start = self.parts[part].initial.compose(&centre);
        let mut parent = None;
        for axis in 0..3 {
            let id = CoordinateId {
                element: name,
                variable: Variable::Place(axis),
            };
            let source = self.add_velocity(id);
            let coordinate = self.coordinates.len();
            self.coordinates.push(Coordinate {
                initial: None,
                id,
                joint: None,
                angular: false,
                source,
                link: 0,
            });
            self.add_positions(coordinate, &[start.position.0[axis]]);
            let motion = LinkMotion::Slide {
                axis,
                sign: 1.0,
                coordinate,
            };
            parent = self.push_link(parent, Frame::identity(), motion, &[coordinate]);
        }
        if self.parts[part].is_point_mass() {
            let rotation = start.rotation;
            let x = Frame {
                rotation,
                position: Vec3::zero(),
            };
            return (parent, x.compose(&centre.inverse()));
        }
        let first = self.coordinates.len();
        for axis in 0..3 {
            let id = CoordinateId {
                element: name,
                variable: Variable::Rotation(axis),
            };
            let source = self.add_velocity(id);
            self.coordinates.push(Coordinate {
                initial: None,
                id,
                joint: None,
                angular: true,
                source,
                link: 0,
            });
        }
        let motion = LinkMotion::Ball {
            coordinate: first,
            quaternion: self.positions.len(),
        };
        self.add_positions(first, &rotation::to_quaternion(&start.rotation));
        parent = self.push_link(
            parent,
            Frame::identity(),
            motion,
            &[first, first + 1, first + 2],
        );
        (parent, centre.inverse())
    }

    fn push_link(
        &mut self,
        parent: LinkIx,
        placement: Frame<f64>,
        motion: LinkMotion,
        own: &[usize],
    ) -> LinkIx {
        let placement = Frame {
            rotation: rotation::snapped(&placement.rotation),
            ..placement
        };
        let (moment, inertia) = (Vec3::zero(), Mat3::zero());
        self.links.push(Link {
            parent,
            placement,
            motion,
            mass: 0.0,
            moment,
            inertia,
        });
        for &c in own {
            self.coordinates[c].link = self.links.len() - 1;
        }
        Some(self.links.len() - 1)
    }

    pub fn part_data(&self, part: usize) -> &'m Part {
        let id = self.parts[part].id;
        let body = self.model.body(id);
        body.unwrap_or_else(|| unreachable!("{id} comes from this model"))
    }

    /// Puts a part with its inertia on its link.
    fn attach(&mut self, part: usize, (link, frame): (LinkIx, Frame<f64>)) {
        let frame = Frame {
            rotation: rotation::snapped(&frame.rotation),
            ..frame
        };
        self.parts[part].link = link;
        self.parts[part].frame = frame;
        let data = self.part_data(part);
        let name = self.parts[part].id;
        if data.mass == 0.0 && data.ip == [0.0; 6] {
            return;
        }
        let ucf = self.model.units.as_ref().map_or(1.0, |u| u.ucf);
        let Some(cm) = data.cm.or(data.im) else {
            if data.mass > 0.0 {
                self.error(
                    name,
                    "has mass but no CM marker: say where its centre of mass is",
                );
            }
            return;
        };
        let (Some(c), Some(i)) = (
            self.marker(cm, name),
            self.marker(data.im.unwrap_or(cm), name),
        ) else {
            return;
        };
        let (X_PC, X_PI) = (self.markers[c].frame, self.markers[i].frame);
        if self.markers[c].part != Some(part) {
            self.error(
                name,
                format!(
                    "its CM marker {} belongs to another part",
                    ElementKind::Marker.id(cm)
                ),
            );
            return;
        }
        // IM → CM by the parallel axis rule, then to the link's origin
        let [xx, yy, zz, xy, xz, yz] = data.ip;
        let given = Mat3([[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]]);
        let R_LI = frame.rotation * X_PI.rotation;
        let about_im = R_LI * given * R_LI.transpose();
        let d = frame.rotation.apply(X_PI.position - X_PC.position);
        let about_cm = about_im - steiner(data.mass, d);
        let p_LC = frame.point(X_PC.position);
        let about_link = about_cm + steiner(data.mass, p_LC);
        let Some(k) = link else { return };
        let l = &mut self.links[k];
        l.mass += data.mass / ucf;
        l.moment += p_LC.times(data.mass / ucf);
        l.inertia = l.inertia + about_link.times(1.0 / ucf);
    }

    /// Rows for a tie that closes a loop.
    fn close(&mut self, tie: &NamedTie) {
        let (Some(i), Some(j)) = (
            self.marker_of.get(&tie.i).copied(),
            self.marker_of.get(&tie.j).copied(),
        ) else {
            return;
        };
        for &law in tie.kind.rows() {
            let kind = RowKind::Markers {
                law,
                i,
                j,
                motion: None,
            };
            self.rows.push(Row {
                element: tie.id,
                equation: law.name(),
                kind,
            });
        }
    }
}

/// `m (|d|² 1 − d dᵀ)`
fn steiner(mass: f64, d: Vec3<f64>) -> Mat3<f64> {
    let n2 = d.norm2();
    Mat3(std::array::from_fn(|i| {
        std::array::from_fn(|j| mass * (if i == j { n2 } else { 0.0 } - d.0[i] * d.0[j]))
    }))
}

/// Returns what the coordinates of motion `k` of a chain measure.
fn variables(chain: &[Motion], k: usize) -> Vec<Variable> {
    let count = |motions: &[Motion], turn: bool| {
        let alike = |m: &&Motion| matches!(m, Motion::Turn(_)) == turn && m.freedoms() == 1;
        motions.iter().filter(alike).count()
    };
    match chain[k] {
        Motion::Slide(axis) if count(chain, false) > 1 => vec![Variable::DistanceAlong(axis)],
        Motion::Slide(_) => vec![Variable::Distance],
        Motion::Turn(_) if count(chain, true) > 1 => {
            vec![Variable::AngleNumber(1 + count(&chain[..k], true))]
        }
        Motion::Turn(_) => vec![Variable::Angle],
        Motion::Ball => (0..3).map(Variable::Rotation).collect(),
        Motion::QuarterX => Vec::new(),
    }
}

/// Coordinates of a chain that bring it as near as may be to the frame `X_JI`: numbers per motion
/// (a quaternion for a ball).
///
/// Slides take their component of the position; a turn takes the angle that brings the axis of the
/// next turn where it should be, the last one the angle that is left.
fn fit(chain: &[Motion], frame: &Frame<f64>) -> Vec<Vec<f64>> {
    let mut left = *frame;
    let mut found = Vec::with_capacity(chain.len());
    for (k, motion) in chain.iter().enumerate() {
        match *motion {
            Motion::Slide(a) => {
                found.push(vec![left.position.0[a]]);
                left.position.0[a] = 0.0;
            }
            Motion::QuarterX => {
                found.push(Vec::new());
                left.rotation = quarter_x().transpose() * left.rotation;
            }
            Motion::Ball => found.push(rotation::to_quaternion(&left.rotation).to_vec()),
            Motion::Turn(a) => {
                // a direction that later motions leave alone, before and after this turn
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                let mut fixed = Vec3::<f64>::axis(b);
                let next = chain[k + 1..].iter().find_map(|m| {
                    if let Motion::Turn(n) = m {
                        Some(*n)
                    } else {
                        None
                    }
                });
                let mut target = left.rotation.column(b);
                if let Some(next) = next {
                    fixed = Vec3::axis(next);
                    if chain[k + 1..].contains(&Motion::QuarterX) {
                        fixed = quarter_x().apply(fixed);
                    }
                    target = left.rotation.column(next);
                }
                let angle = Scalar::atan2(
                    target.0[c] * fixed.0[b] - target.0[b] * fixed.0[c],
                    target.0[b] * fixed.0[b] + target.0[c] * fixed.0[c],
                );
                found.push(vec![angle]);
                left.rotation = rotation::about_axis(a, -angle) * left.rotation;
            }
        }
    }
    found
}
