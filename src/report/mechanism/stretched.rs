//! Elements that reach from one body to another and change their length: springs, forces along
//! lines, beams.

use super::bodies::Bodies;
use super::solid::Solid;
use super::track::Track;
use super::{Sizes, along_z, colours};
use crate::model::{ElementId, ElementKind, Model};
use crate::space::{Frame, Vec3};
use std::f64::consts::TAU;

/// Turns of a coil.
const TURNS: f64 = 9.0;

/// The look of what reaches from one body to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// the coil of a spring
    Coil,
    /// a thin rod
    Rod,
}

/// An element between points of two bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretched {
    /// the element
    pub element: ElementId,
    /// its look
    pub look: Look,
    /// body and point of one end, in the frame of the body
    pub from: (usize, [f64; 3]),
    /// body and point of the other end
    pub to: (usize, [f64; 3]),
    /// its radius   (length)
    pub radius: f64,
    /// red, green, blue
    pub colour: [u8; 3],
}

impl Stretched {
    /// Returns the surface for a length of 1 along z, from the origin on.
    pub fn unit(&self) -> Solid {
        match self.look {
            Look::Rod => Solid::frustum(self.radius, self.radius, [0.0, 1.0]),
            Look::Coil => {
                let n = (TURNS * 16.0) as u32;
                let coil: Vec<[f64; 3]> = (0..=n)
                    .map(|k| {
                        let u = f64::from(k) / f64::from(n);
                        let (sin, cos) = (TAU * TURNS * u).sin_cos();
                        // straight ends along the axis
                        let ends = (12.0 * u.min(1.0 - u)).min(1.0);
                        [ends * self.radius * cos, ends * self.radius * sin, u]
                    })
                    .collect();
                Solid::tube(&coil, false, 0.16 * self.radius, 6)
            }
        }
    }

    /// Returns its ends in ground at a row.
    pub fn ends(&self, bodies: &Bodies, track: &Track, row: usize) -> [Vec3<f64>; 2] {
        [self.from, self.to].map(|(body, p)| track.frame(bodies, body, row).point(Vec3(p)))
    }

    /// Returns its frame at a row, z from one end to the other, and its length.
    pub fn place(&self, bodies: &Bodies, track: &Track, row: usize) -> (Frame<f64>, f64) {
        let [from, to] = self.ends(bodies, track, row);
        let frame = Frame {
            rotation: along_z(to - from),
            position: from,
        };
        (frame, (to - from).norm())
    }
}

/// Returns all elements of a model that reach from one body to another.
pub fn stretched(model: &Model, bodies: &Bodies, sizes: Sizes) -> Vec<Stretched> {
    let s = sizes.joint;
    let springs = (model.spring_dampers.iter())
        .filter(|(_, e)| !e.rotational)
        .map(|(&n, e)| {
            (
                ElementKind::SpringDamper.id(n),
                [e.i, e.j],
                Look::Coil,
                1.1 * s,
            )
        });
    let forces = (model.sforces.iter())
        .filter(|(_, e)| !e.rotational && !e.action_only)
        .map(|(&n, e)| (ElementKind::Sforce.id(n), [e.i, e.j], Look::Rod, 0.2 * s));
    let beams = model.beams.iter();
    let beams = beams.map(|(&n, e)| (ElementKind::Beam.id(n), [e.i, e.j], Look::Rod, 0.55 * s));
    let fields = model.fields.iter();
    let fields = fields.map(|(&n, e)| (ElementKind::Field.id(n), [e.i, e.j], Look::Rod, 0.4 * s));
    let all = springs.chain(forces).chain(beams).chain(fields);
    all.filter(|(id, ..)| !model.inactive.contains(id))
        .filter_map(|(element, [i, j], look, radius)| {
            let (i, j) = (bodies.marker(i)?, bodies.marker(j)?);
            Some(Stretched {
                element,
                look,
                from: (i.body, i.frame.position.0),
                to: (j.body, j.frame.position.0),
                radius,
                colour: colours::ELASTIC,
            })
        })
        .collect()
}
