//! Bodies of a model with their frames, and where its markers stand in them.

use super::colours;
use crate::model::{ElementId, ElementKind, Model, geometry};
use crate::space::{Frame, Vec3};
use std::collections::BTreeMap;

/// Name of ground where the dataset gives none.
const GROUND: &str = "ground";

/// A body that is drawn.
#[derive(Clone, Debug)]
pub struct Body {
    /// the part or point mass; ground too
    pub id: ElementId,
    /// its name in the dataset, or `PART_2`; `ground` of ground without a name
    pub name: String,
    /// whether it is ground
    pub is_ground: bool,
    /// its colour: red, green, blue
    pub colour: [u8; 3],
    /// where the dataset places it, in ground
    pub placed: Frame<f64>,
    /// its mass   [mass unit of the model]
    pub mass: f64,
    /// its centre of mass, in its own frame; `None`: it has none
    pub cm: Option<Vec3<f64>>,
}

/// The bodies of a model, and its markers in their frames.
#[derive(Clone, Debug, Default)]
pub struct Bodies {
    /// in the order of their numbers, parts before point masses
    pub all: Vec<Body>,
    markers: BTreeMap<u32, Anchor>,
}

/// A frame fixed in a body.
#[derive(Clone, Copy, Debug)]
pub struct Anchor {
    /// index of the body
    pub body: usize,
    /// the frame in that of the body
    pub frame: Frame<f64>,
}

impl Bodies {
    /// Finds the bodies and markers of a model. Markers that float, and those whose axes have no
    /// directions, have no place.
    pub fn new(model: &Model) -> Self {
        let mut this = Self::default();
        let (mut index, labels) = (BTreeMap::new(), model.labels());
        for (id, part) in model.bodies() {
            let rotation = geometry::orientation(&part.orientation, part.qg);
            let placed = Frame {
                rotation: rotation.unwrap_or_else(|_| Frame::identity().rotation),
                position: Vec3(part.qg),
            };
            let is_ground = part.ground && id.kind == ElementKind::Part;
            let moving = this.all.iter().filter(|b| !b.is_ground).count();
            let colour = if is_ground {
                colours::GROUND
            } else {
                colours::BODIES[moving % colours::BODIES.len()]
            };
            index.insert(id, this.all.len());
            this.all.push(Body {
                id,
                name: match (&part.place.name, is_ground) {
                    (None, true) => GROUND.to_owned(),
                    _ => labels.name(model, id),
                },
                is_ground,
                colour,
                placed: if is_ground { Frame::identity() } else { placed },
                mass: part.mass,
                cm: None,
            });
        }
        for (&number, marker) in model.markers.iter().filter(|(_, m)| !m.floating) {
            let body = marker.owner.body().and_then(|b| index.get(&b));
            let rotation = geometry::orientation(&marker.orientation, marker.qp);
            if let (Some(&body), Ok(rotation)) = (body, rotation) {
                let position = Vec3(marker.qp);
                let frame = Frame { rotation, position };
                this.markers.insert(number, Anchor { body, frame });
            }
        }
        for (id, part) in model.bodies() {
            let cm = part.cm.and_then(|cm| this.marker(cm));
            let points = (id.kind == ElementKind::PointMass).then(Vec3::zero);
            if let Some(&k) = index.get(&id) {
                this.all[k].cm = cm.map(|a| a.frame.position).or(points);
            }
        }
        this
    }

    /// Returns the place of a marker; `None` where it has none of its own.
    pub fn marker(&self, number: u32) -> Option<Anchor> {
        self.markers.get(&number).copied()
    }

    /// Iterates over the markers that have a place, by number.
    pub fn markers(&self) -> impl Iterator<Item = (u32, Anchor)> + '_ {
        self.markers.iter().map(|(&number, &at)| (number, at))
    }

    /// Returns the index of a part or point mass.
    pub fn find(&self, id: ElementId) -> Option<usize> {
        self.all.iter().position(|b| b.id == id)
    }
}
