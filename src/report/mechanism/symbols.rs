//! Symbols of joints, primitives, motions, gears and elastic elements, in the frames of the bodies
//! that carry them.

use super::bodies::{Anchor, Bodies};
use super::solid::{Solid, along_z};
use super::track::Track;
use super::{Form, Piece, Role, Sizes, View, colours};
use crate::model::{Driven, ElementId, ElementKind, Joint, JointKind, Model, PrimitiveKind};
use crate::space::{Frame, Mat3, Vec3};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Everything that symbols are made from.
pub struct Symbols<'a> {
    /// the model
    pub model: &'a Model,
    /// its bodies
    pub bodies: &'a Bodies,
    /// where they go
    pub track: &'a Track,
    /// the direction upwards
    pub view: View,
    /// sizes of what has none
    pub sizes: Sizes,
    /// bodies that GRAPHICS show
    pub shaped: &'a BTreeSet<usize>,
}

/// The two ends of a tie.
#[derive(Clone, Copy)]
pub(super) struct Ends {
    element: ElementId,
    pub(super) i: Anchor,
    pub(super) j: Anchor,
}

impl Symbols<'_> {
    /// Returns the symbols of all elements that have one.
    pub fn all(&self) -> Vec<Piece> {
        let mut pieces = Vec::new();
        let active = |id: ElementId| !self.model.inactive.contains(&id);
        for (&number, joint) in &self.model.joints {
            let id = ElementKind::Joint.id(number);
            if let Some(ends) = self.ends(id, joint.i, joint.j).filter(|_| active(id)) {
                self.joint(joint, ends, &mut pieces);
            }
        }
        for (&number, primitive) in &self.model.primitives {
            let id = ElementKind::Jprim.id(number);
            if let Some(ends) = self
                .ends(id, primitive.i, primitive.j)
                .filter(|_| active(id))
            {
                self.primitive(primitive.kind, ends, &mut pieces);
            }
        }
        self.motions(&mut pieces);
        self.gears(&mut pieces);
        self.belts(&mut pieces);
        self.elastic(&mut pieces);
        pieces
    }

    pub(super) fn ends(&self, element: ElementId, i: u32, j: u32) -> Option<Ends> {
        let (i, j) = (self.bodies.marker(i)?, self.bodies.marker(j)?);
        Some(Ends { element, i, j })
    }

    fn piece(&self, element: ElementId, at: Anchor, colour: [u8; 3], form: Form) -> Piece {
        Piece {
            body: at.body,
            element,
            role: Role::Joint,
            form: form.placed(&at.frame),
            colour,
        }
    }

    fn colour(&self, at: Anchor) -> [u8; 3] {
        self.bodies.all[at.body].colour
    }

    /// Adds the symbol of a joint.
    fn joint(&self, joint: &Joint, ends: Ends, pieces: &mut Vec<Piece>) {
        let s = self.sizes.joint;
        let Ends { element, i, j } = ends;
        let dark = |at: Anchor, form: Form| self.piece(element, at, colours::JOINT, form);
        match joint.kind {
            JointKind::Revolute => self.pin(ends, 0.75 * s, 1.1 * s, pieces),
            JointKind::Cylindrical => self.pin(ends, 1.2 * s, 2.4 * s, pieces),
            JointKind::Translational => self.slide(ends, true, pieces),
            JointKind::Screw => {
                let turns: Vec<[f64; 3]> = (0..=96)
                    .map(|k| {
                        let (sin, cos) = (TAU * f64::from(k) / 16.0).sin_cos();
                        let height = s * (f64::from(k) / 24.0 - 2.0);
                        [0.75 * s * cos, 0.75 * s * sin, height]
                    })
                    .collect();
                pieces.push(dark(
                    j,
                    Form::Solid(Solid::tube(&turns, false, 0.18 * s, 6)),
                ));
            }
            JointKind::Spherical | JointKind::Convel => {
                pieces.push(dark(j, sphere(0.9 * s)));
                self.stand(ends, pieces);
                if joint.kind == JointKind::Convel {
                    pieces.push(dark(i, Form::Solid(Solid::torus(1.3 * s, 0.25 * s))));
                }
            }
            JointKind::Universal | JointKind::Hooke => {
                let [of_i, of_j] = match joint.kind {
                    JointKind::Hooke => [0, 1],
                    _ => [2, 2],
                };
                let colour = self.colour(i);
                pieces.push(self.piece(element, i, colour, bar(of_i, 1.6 * s, 0.42 * s)));
                pieces.push(dark(j, bar(of_j, 1.6 * s, 0.42 * s)));
                self.stand(ends, pieces);
            }
            JointKind::Planar => {
                let (a, h) = (2.2 * s, 0.12 * s);
                let plate = Solid::block([-a, -a, -h], [a, a, h]);
                pieces.push(dark(j, Form::Solid(plate)));
            }
            JointKind::Fixed => {
                let a = 0.6 * s;
                pieces.push(dark(j, Form::Solid(Solid::block([-a; 3], [a; 3]))));
            }
            JointKind::Rackpin => {
                let radius = joint.pd.unwrap_or(0.0).abs() / 2.0;
                if radius > 0.0 && !self.shaped.contains(&i.body) {
                    // I is the pinion, which turns about its z
                    pieces.push(self.wheel(element, i, radius, false));
                }
            }
        }
    }

    /// Adds a pin along z of J in a boss on I; on ground a stand.
    fn pin(&self, ends: Ends, boss: f64, pin: f64, pieces: &mut Vec<Piece>) {
        let s = self.sizes.joint;
        let Ends { element, i, j } = ends;
        let about =
            |radius: f64, half: f64| Form::Solid(Solid::frustum(radius, radius, [-half, half]));
        // the boss belongs to a body that moves
        let (inner, outer) = if self.bodies.all[i.body].is_ground {
            (i, j)
        } else {
            (j, i)
        };
        let colour = self.colour(outer);
        pieces.push(self.piece(element, outer, colour, about(s, boss)));
        pieces.push(self.piece(element, inner, colours::JOINT, about(0.5 * s, pin)));
        self.stand(ends, pieces);
    }

    /// Adds a block on a rail that is as long as the way of the block.
    fn slide(&self, ends: Ends, with_block: bool, pieces: &mut Vec<Piece>) {
        let s = self.sizes.joint;
        let Ends { element, i, j } = ends;
        // the rail belongs to ground, else to J
        let (block, rail) = if self.bodies.all[i.body].is_ground {
            (j, i)
        } else {
            (i, j)
        };
        let [low, high] = self.way(block, rail);
        let (from, to) = ([0.0, 0.0, low - 3.0 * s], [0.0, 0.0, high + 3.0 * s]);
        let radius = 0.4 * s;
        let form = Form::Rod { from, to, radius };
        pieces.push(self.piece(element, rail, self.colour(rail), form));
        if with_block && !self.shaped.contains(&block.body) {
            let (a, h) = (1.15 * s, 1.7 * s);
            let form = Form::Solid(Solid::block([-a, -a, -h], [a, a, h]));
            pieces.push(self.piece(element, block, self.colour(block), form));
        }
    }

    /// Returns the least and the greatest displacement of a frame along z of another.
    fn way(&self, block: Anchor, rail: Anchor) -> [f64; 2] {
        let at = |row: usize| {
            let frame = |a: Anchor| self.track.frame(self.bodies, a.body, row).compose(&a.frame);
            let (b, r) = (frame(block), frame(rail));
            (b.position - r.position).dot(r.rotation.column(2))
        };
        let all = (0..self.track.times.len().max(1))
            .map(at)
            .filter(|d| d.is_finite());
        all.fold([0.0, 0.0], |[low, high], d| [low.min(d), high.max(d)])
    }

    /// Adds a stand below a joint on ground.
    fn stand(&self, ends: Ends, pieces: &mut Vec<Piece>) {
        let s = self.sizes.joint;
        let on_ground = [ends.i, ends.j].into_iter();
        let ground = |at: &Anchor| self.bodies.all[at.body].is_ground;
        let Some(at) = on_ground.rev().find(&ground) else {
            return;
        };
        let rotation = if self.view.is_planar {
            let (right, up) = self.view.axes();
            Mat3::from_columns(right, up, self.view.eye)
        } else {
            along_z(self.view.up)
        };
        let frame = Frame {
            rotation,
            position: at.frame.position,
        };
        let solid = if self.view.is_planar {
            let foot = [[0.0, 0.4 * s], [-1.9 * s, -2.6 * s], [1.9 * s, -2.6 * s]];
            Solid::prism(&foot, [-0.9 * s, -0.3 * s])
        } else {
            Solid::turned(&[(2.0 * s, -2.6 * s), (0.5 * s, 0.0)], 4, false)
        };
        pieces.push(Piece {
            body: at.body,
            element: ends.element,
            role: Role::Ground,
            form: Form::Solid(solid.placed(&frame)),
            colour: colours::GROUND,
        });
    }

    /// Adds the symbol of a primitive.
    fn primitive(&self, kind: PrimitiveKind, ends: Ends, pieces: &mut Vec<Piece>) {
        let s = self.sizes.joint;
        let Ends { element, i, j } = ends;
        let dark = |at: Anchor, form: Form| self.piece(element, at, colours::JOINT, form);
        match kind {
            PrimitiveKind::Atpoint => pieces.push(dark(j, sphere(0.8 * s))),
            PrimitiveKind::Inline => {
                self.slide(ends, false, pieces);
                pieces.push(dark(i, sphere(0.7 * s)));
            }
            PrimitiveKind::Inplane => {
                let (a, h) = (2.2 * s, 0.1 * s);
                pieces.push(dark(j, Form::Solid(Solid::block([-a, -a, -h], [a, a, h]))));
                pieces.push(dark(i, sphere(0.6 * s)));
            }
            PrimitiveKind::Orientation
            | PrimitiveKind::ParallelAxes
            | PrimitiveKind::Perpendicular => {
                let profile = [(0.0, -0.9 * s), (0.6 * s, 0.0), (0.0, 0.9 * s)];
                pieces.push(dark(j, Form::Solid(Solid::turned(&profile, 4, false))));
            }
        }
    }

    /// Adds an arrow about or along z to each joint that a motion drives.
    fn motions(&self, pieces: &mut Vec<Piece>) {
        let s = self.sizes.joint;
        for (&number, motion) in &self.model.motions {
            let (joint, turns) = match motion.driven {
                Driven::Joint(n) => (n, None),
                Driven::JointRotation(n) => (n, Some(true)),
                Driven::JointTranslation(n) => (n, Some(false)),
                Driven::Markers { .. } => continue,
            };
            let Some(joint) = self.model.joints.get(&joint) else {
                continue;
            };
            let turns = joint.kind.displacements().chosen(turns).unwrap_or(true);
            let Some(at) = self.bodies.marker(joint.j).filter(|_| turns) else {
                continue;
            };
            let radius = 2.1 * s;
            let arc: Vec<[f64; 3]> = (0..=30)
                .map(|k| {
                    let (sin, cos) = (0.4 + 0.72 * TAU * f64::from(k) / 30.0).sin_cos();
                    [radius * cos, radius * sin, 0.0]
                })
                .collect();
            let mut arrow = Solid::tube(&arc, false, 0.16 * s, 8);
            let (tip, before) = (Vec3(arc[30]), Vec3(arc[29]));
            let frame = Frame {
                rotation: along_z(tip - before),
                position: tip,
            };
            arrow.join(Solid::turned(&[(0.5 * s, 0.0), (0.0, 1.2 * s)], 12, true).placed(&frame));
            let id = ElementKind::Motion.id(number);
            pieces.push(self.piece(id, at, colours::FORCE, Form::Solid(arrow)));
        }
    }

    /// Adds the wheels of gear pairs, whose radii are the distances of the common point.
    fn gears(&self, pieces: &mut Vec<Piece>) {
        for (&number, gear) in &self.model.gears {
            let id = ElementKind::Gear.id(number);
            let Some(cv) = self.bodies.marker(gear.cv) else {
                continue;
            };
            let wheel = |joint: &u32| {
                let joint = self.model.joints.get(joint)?;
                let turns = joint.kind.displacements().turns();
                let ends = self.ends(id, joint.i, joint.j).filter(|_| turns)?;
                // the carrier has the common point, the wheel is the other body
                let (wheel, axis) = if ends.i.body == cv.body {
                    (ends.j, ends.i)
                } else {
                    (ends.i, ends.j)
                };
                let z = axis.frame.rotation.column(2);
                let arm = cv.frame.position - axis.frame.position;
                Some((wheel, arm - z.times(z.dot(arm))))
            };
            let wheels: Vec<_> = gear.joints.iter().filter_map(wheel).collect();
            let [(a, to_a), (b, to_b)] = wheels[..] else {
                continue;
            };
            let is_inside = to_a.dot(to_b) > 0.0;
            for (at, own, other) in [(a, to_a, to_b), (b, to_b, to_a)] {
                if !self.shaped.contains(&at.body) && own.norm() > 0.0 {
                    let is_ring = is_inside && own.norm() > other.norm();
                    pieces.push(self.wheel(id, at, own.norm(), is_ring));
                }
            }
        }
    }

    /// Returns a toothed wheel about z of a frame; a ring has its teeth inside.
    pub(super) fn wheel(
        &self,
        element: ElementId,
        at: Anchor,
        radius: f64,
        is_ring: bool,
    ) -> Piece {
        let s = self.sizes.joint;
        let teeth = ((radius / s * 4.0).round() as usize).clamp(10, 90);
        let inner = if is_ring {
            1.16 * radius
        } else {
            0.72 * radius
        };
        let mut solid = Solid::gear(inner, radius, 0.8 * s, teeth);
        if is_ring {
            solid.faces.iter_mut().for_each(|f| f.reverse());
        } else {
            for k in 0..3 {
                let (sin, cos) = (TAU * f64::from(k) / 6.0).sin_cos();
                let end = [inner * 1.02 * cos, inner * 1.02 * sin, 0.0];
                let path = [end.map(|x| -x), end];
                solid.join(Solid::tube(&path, false, 0.35 * s, 8));
            }
        }
        self.piece(element, at, self.colour(at), Form::Solid(solid))
    }

    /// Adds the symbols of bushings and of springs about an axis.
    fn elastic(&self, pieces: &mut Vec<Piece>) {
        let s = self.sizes.joint;
        let grey = colours::ELASTIC;
        for (&number, bushing) in &self.model.bushings {
            let id = ElementKind::Bushing.id(number);
            if let Some(at) = self.bodies.marker(bushing.j) {
                let ring = Form::Solid(Solid::torus(1.2 * s, 0.55 * s));
                pieces.push(self.piece(id, at, grey, ring));
            }
        }
        let springs = self.model.spring_dampers.iter();
        for (&number, spring) in springs.filter(|(_, s)| s.rotational) {
            let id = ElementKind::SpringDamper.id(number);
            let spiral: Vec<[f64; 3]> = (0..=72)
                .map(|k| {
                    let (sin, cos) = (TAU * f64::from(k) / 24.0).sin_cos();
                    let radius = s * (1.1 + 1.5 * f64::from(k) / 72.0);
                    [radius * cos, radius * sin, 0.0]
                })
                .collect();
            if let Some(at) = self.bodies.marker(spring.j) {
                let form = Form::Solid(Solid::tube(&spiral, false, 0.14 * s, 6));
                pieces.push(self.piece(id, at, grey, form));
            }
        }
    }
}

fn sphere(radius: f64) -> Form {
    let centre = [0.0; 3];
    Form::Ball { centre, radius }
}

/// Returns a rod along an axis, through the origin.
fn bar(axis: usize, half: f64, radius: f64) -> Form {
    let to = Vec3::axis(axis).times(half);
    Form::Rod {
        from: (-to).0,
        to: to.0,
        radius,
    }
}
