//! A mechanism as a picture: bodies, shapes, symbols and forces of a model, and where a run moves
//! them.
//!
//! [`Pictured`] is made once from a model and a run; the page that moves, the `.glb` file and the
//! drawing on paper all show the same. Nothing here solves anything. Lengths are in units of the
//! model, frames against ground, times those of the run.

mod annotations;
mod belts;
mod bodies;
mod channels;
mod colours;
pub mod drawing;
pub mod drawing_svg;
#[cfg(feature = "gif")]
pub mod film;
pub mod glb;
mod labels;
mod links;
mod pack;
pub mod page;
mod shapes;
mod solid;
mod stretched;
mod symbols;
mod track;
mod view;

pub use annotations::{ActionVector, Dimension, Pair, Triad};
pub use bodies::{Anchor, Bodies, Body};
pub use solid::{Solid, Triangles};
pub use stretched::{Look, Stretched};
pub use track::{Load, Track};
pub use view::View;

use crate::dataset::surface::Surfaces;
use crate::diagnostic::Diagnostic;
use crate::model::{Element, ElementId, ElementKind, Model};
use crate::results::Run;
use crate::space::Vec3;
use solid::along_z;
use std::borrow::Cow;
use std::collections::BTreeSet;
use symbols::Symbols;

/// Radius of a rod, as a part of the size of the mechanism.
const ROD: f64 = 0.009;
/// Half the length of the symbol of a joint, as a part of the size of the mechanism.
const JOINT: f64 = 0.016;

/// The sizes of what has none of its own   (length).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    /// diagonal of the whole mechanism
    pub whole: f64,
    /// radius of a rod
    pub rod: f64,
    /// half the length of the symbol of a joint
    pub joint: f64,
}

/// The part that a piece plays in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// a stand on ground
    Ground,
    /// a shape of the dataset
    Shape,
    /// a link between joints
    Link,
    /// a mass
    Mass,
    /// a symbol of a joint, a drive, a gear or a bushing
    Joint,
}

impl Role {
    /// Returns its word in files.
    pub fn word(self) -> &'static str {
        match self {
            Role::Ground => "ground",
            Role::Shape => "shape",
            Role::Link => "link",
            Role::Mass => "mass",
            Role::Joint => "joint",
        }
    }
}

/// A form in the frame of its body.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// a round rod with round ends
    Rod {
        /// one end
        from: [f64; 3],
        /// the other end
        to: [f64; 3],
        /// radius
        radius: f64,
    },
    /// a ball
    Ball {
        /// its middle
        centre: [f64; 3],
        /// radius
        radius: f64,
    },
    /// a surface
    Solid(Solid),
    /// a line without thickness
    Line {
        /// its points
        points: Vec<[f64; 3]>,
        /// whether its end meets its beginning
        closed: bool,
    },
}

/// A form that moves with a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// index of the body
    pub body: usize,
    /// the element that it shows
    pub element: ElementId,
    /// the part that it plays
    pub role: Role,
    /// the form, in the frame of the body
    pub form: Form,
    /// red, green, blue
    pub colour: [u8; 3],
}

/// A force or torque that is shown as an arrow.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrow {
    /// the element
    pub element: ElementId,
    /// index of the body that it acts on
    pub body: usize,
    /// where it acts, in the frame of the body, unless the run says where
    pub place: [f64; 3],
    /// index in `Track::loads`
    pub load: usize,
    /// whether it is the reaction of a joint or motion
    pub is_reaction: bool,
}

/// A point whose path is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Trail {
    /// index of the body
    pub body: usize,
    /// the marker
    pub marker: u32,
    /// the point, in the frame of the body
    pub place: [f64; 3],
}

/// Two solids that overlap at some rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlap {
    /// their GRAPHICS
    pub elements: [ElementId; 2],
    /// where they overlap most at each row, in ground; `None`: they do not, or nobody knows
    pub places: Vec<Option<[f64; 3]>>,
    /// depth of the deepest overlap   (length)
    pub depth: f64,
    /// row of the deepest overlap
    pub deepest: usize,
}

/// A mechanism over the rows of a run, ready to be drawn.
#[derive(Clone, Debug)]
pub struct Pictured {
    /// title of the model
    pub title: String,
    /// its bodies
    pub bodies: Bodies,
    /// where they go
    pub track: Track,
    /// what moves with them
    pub pieces: Vec<Piece>,
    /// what reaches from one to another
    pub stretched: Vec<Stretched>,
    /// forces and torques
    pub arrows: Vec<Arrow>,
    /// points whose paths are worth seeing: those that requests ask for
    pub trails: Vec<Trail>,
    /// axes of the markers
    pub triads: Vec<Triad>,
    /// directions of the displacements of joints
    pub action_vectors: Vec<ActionVector>,
    /// distances of markers, if somebody has asked for some
    pub dimensions: Vec<Dimension>,
    /// where solids overlap, if somebody has looked
    pub overlaps: Vec<Overlap>,
    /// where it is seen from at first
    pub view: View,
    /// sizes of symbols
    pub sizes: Sizes,
    /// the unit of time, in s
    pub second: f64,
}

impl Pictured {
    /// Makes the picture of a model and one of its runs; `surfaces`: the shells that stand in
    /// files.
    ///
    /// # Errors
    /// When the run does not say where the bodies of the model are.
    pub fn new(model: &Model, run: &Run, surfaces: &Surfaces) -> Result<Self, Diagnostic> {
        let bodies = Bodies::new(model);
        let track = Track::new(model, &bodies, run)?;
        // what acts at some time has a symbol
        let never = track.never_active();
        let model = &match never == model.inactive {
            true => Cow::Borrowed(model),
            false => Cow::Owned(Model {
                inactive: never,
                ..model.clone()
            }),
        };
        let (low, high) = extent(model, &bodies, &track, surfaces);
        let mut view = View::new(model, &bodies, low, high);
        let whole = view.size;
        let sizes = Sizes {
            whole,
            rod: ROD * whole,
            joint: JOINT * whole,
        };
        let mut pieces = shapes::shapes(model, &bodies, surfaces, whole);
        let solid = |p: &&Piece| !matches!(p.form, Form::Line { .. });
        let shaped: BTreeSet<usize> = pieces.iter().filter(solid).map(|p| p.body).collect();
        let trails = trails(model, &bodies);
        pieces.extend(links::links(model, &bodies, sizes, &shaped, &trails));
        let symbols = Symbols {
            model,
            bodies: &bodies,
            track: &track,
            view,
            sizes,
            shaped: &shaped,
        };
        pieces.extend(symbols.all());
        (view.centre, view.size) = seen(&bodies, &track, &pieces, (low, high));
        let stretched = stretched::stretched(model, &bodies, sizes);
        Ok(Self {
            title: model.title.clone(),
            arrows: arrows(model, &bodies, &track),
            trails,
            triads: annotations::triads(&bodies),
            action_vectors: annotations::action_vectors(model, &bodies),
            dimensions: Vec::new(),
            overlaps: Vec::new(),
            bodies,
            track,
            pieces,
            stretched,
            view,
            sizes,
            second: model.units.as_ref().map_or(1.0, |units| units.to_si()[3]),
        })
    }
}

type Corners = (Vec3<f64>, Vec3<f64>);

const NOTHING: Corners = (Vec3([f64::INFINITY; 3]), Vec3([f64::NEG_INFINITY; 3]));

fn with((low, high): Corners, p: Vec3<f64>) -> Corners {
    if p.0.iter().any(|x| !x.is_finite()) {
        return (low, high);
    }
    let of = |f: fn(f64, f64) -> f64, a: Vec3<f64>| Vec3([0, 1, 2].map(|k| f(a.0[k], p.0[k])));
    (of(f64::min, low), of(f64::max, high))
}

/// Returns the corners of the box about the mechanism as the run begins: places where something is
/// fixed to bodies, shapes of the dataset, centres of mass.
fn extent(model: &Model, bodies: &Bodies, track: &Track, surfaces: &Surfaces) -> Corners {
    let mut corners = NOTHING;
    let at = |body: usize, p: Vec3<f64>| track.frame(bodies, body, 0).point(p);
    for (id, element) in model.elements() {
        let ends = element.ends().filter(|_| !model.inactive.contains(&id));
        for anchor in ends.into_iter().flatten().filter_map(|m| bodies.marker(m)) {
            corners = with(corners, at(anchor.body, anchor.frame.position));
        }
    }
    for (k, body) in bodies.all.iter().enumerate() {
        corners = body.cm.map_or(corners, |cm| with(corners, at(k, cm)));
    }
    for piece in shapes::shapes(model, bodies, surfaces, 0.0) {
        for p in piece.form.marks() {
            corners = with(corners, at(piece.body, Vec3(p)));
        }
    }
    let (low, high) = corners;
    let flat = !(high - low).norm().is_finite() || (high - low).norm() == 0.0;
    if !flat {
        return corners;
    }
    // one point: a box as large as its way
    for row in 0..track.times.len() {
        for k in 0..bodies.all.len() {
            corners = with(corners, at_row(bodies, track, k, row, bodies.all[k].cm));
        }
    }
    let one = Vec3([0.5; 3]);
    match corners {
        (low, high) if (high - low).norm() > 0.0 && (high - low).norm().is_finite() => (low, high),
        (low, _) if low.0[0].is_finite() => (low - one, low + one),
        _ => (-one, one),
    }
}

fn at_row(bodies: &Bodies, track: &Track, k: usize, row: usize, p: Option<Vec3<f64>>) -> Vec3<f64> {
    track.frame(bodies, k, row).point(p.unwrap_or_default())
}

/// Returns middle and diagonal of what is seen over the run; a mechanism that goes far away is seen
/// at its beginning.
fn seen(bodies: &Bodies, track: &Track, pieces: &[Piece], start: Corners) -> (Vec3<f64>, f64) {
    const ROWS: usize = 60;
    const FARTHEST: f64 = 4.0;
    let marks: Vec<(usize, Vec<[f64; 3]>)> =
        pieces.iter().map(|p| (p.body, p.form.marks())).collect();
    let at = |corners: Corners, row: usize| {
        let all = marks.iter().flat_map(|(body, marks)| {
            let frame = track.frame(bodies, *body, row);
            marks.iter().map(move |p| frame.point(Vec3(*p)))
        });
        all.fold(corners, with)
    };
    let n = track.times.len();
    let first = at(start, 0);
    let all = (0..n).step_by(n.div_ceil(ROWS).max(1)).fold(first, at);
    let middle = |(low, high): Corners| ((low + high).times(0.5), (high - low).norm());
    let (all, first) = (middle(all), middle(first));
    if all.1.is_finite() && all.1 <= FARTHEST * first.1 {
        all
    } else {
        first
    }
}

impl Arrow {
    /// Returns where it acts at a row, in ground.
    pub fn from(&self, bodies: &Bodies, track: &Track, row: usize) -> Vec3<f64> {
        let known = track.loads[self.load].places.get(row).map(|p| Vec3(*p));
        let known = known.filter(|p| p.0.iter().all(|x| x.is_finite()));
        known.unwrap_or_else(|| track.frame(bodies, self.body, row).point(Vec3(self.place)))
    }
}

impl Form {
    /// Returns points that show how far it reaches, in the frame of its body.
    fn marks(&self) -> Vec<[f64; 3]> {
        /// Points of a surface that are looked at, about.
        const MARKS: usize = 60;
        let about = |p: [f64; 3], r: f64| [p.map(|x| x - r), p.map(|x| x + r)];
        match self {
            Form::Rod { from, to, radius } => [about(*from, *radius), about(*to, *radius)].concat(),
            Form::Ball { centre, radius } => about(*centre, *radius).to_vec(),
            Form::Solid(Solid { points, .. }) | Form::Line { points, .. } => {
                let step = points.len().div_ceil(MARKS).max(1);
                points.iter().step_by(step).copied().collect()
            }
        }
    }
}

/// Returns the forces that a run knows, where they act.
fn arrows(model: &Model, bodies: &Bodies, track: &Track) -> Vec<Arrow> {
    let of = |(load, known): (usize, &Load)| {
        let at = bodies.marker(first_marker(model, known.element)?)?;
        Some(Arrow {
            element: known.element,
            body: at.body,
            place: at.frame.position.0,
            load,
            is_reaction: known.element.kind.family() == crate::model::Family::Constraint,
        })
    };
    track.loads.iter().enumerate().filter_map(of).collect()
}

/// Returns the marker that an element acts on; of a contact that of its first solid.
fn first_marker(model: &Model, id: ElementId) -> Option<u32> {
    let vectors = [
        (ElementKind::Vforce, &model.vforces),
        (ElementKind::Vtorque, &model.vtorques),
        (ElementKind::Gforce, &model.gforces),
    ];
    let vector = vectors.into_iter().find(|(kind, _)| *kind == id.kind);
    let vector = vector.and_then(|(_, list)| Some(list.get(&id.number)?.i));
    let single = model
        .sforces
        .get(&id.number)
        .filter(|_| id.kind == ElementKind::Sforce);
    let contact = model
        .contacts
        .get(&id.number)
        .filter(|_| id.kind == ElementKind::Contact);
    let solid = contact.and_then(|c| model.graphics.get(c.i_geometry.first()?));
    let on_solid = solid.and_then(|g| {
        let mut named = g.references().into_iter().map(|(_, target)| target);
        let marker = named.find(|t| t.kind == ElementKind::Marker);
        marker.map(|t| t.number)
    });
    let ends = || model.element(id)?.ends().map(|[i, _]| i);
    vector.or(single.map(|f| f.i)).or(on_solid).or_else(ends)
}

/// Returns the markers of bodies that move whose place requests ask for, each once.
fn trails(model: &Model, bodies: &Bodies) -> Vec<Trail> {
    use crate::expr::measures::Measure;
    use crate::expr::program::Input;
    use crate::model::{Formula, RequestKind};
    let mut asked = BTreeSet::new();
    for request in model.requests.values() {
        match &request.kind {
            RequestKind::Displacement { i, .. } => {
                asked.insert(*i);
            }
            RequestKind::Functions(all) => {
                let texts = all.iter().flatten().filter_map(|f| match f {
                    Formula::Expression { text, .. } => text.ast().ok(),
                    Formula::User { .. } => None,
                });
                for ast in texts {
                    let inputs = (0..)
                        .zip(&ast.nodes)
                        .filter_map(|(node, _)| ast.input(node));
                    asked.extend(inputs.filter_map(|input| match input {
                        Input::Measure(
                            Measure::Dx | Measure::Dy | Measure::Dz | Measure::Dm,
                            [i, ..],
                        ) => Some(i),
                        _ => None,
                    }));
                }
            }
            RequestKind::Velocity { .. }
            | RequestKind::Acceleration { .. }
            | RequestKind::Force { .. }
            | RequestKind::User(_) => {}
        }
    }
    let of = |marker: u32| {
        let at = bodies
            .marker(marker)
            .filter(|a| !bodies.all[a.body].is_ground)?;
        Some(Trail {
            body: at.body,
            marker,
            place: at.frame.position.0,
        })
    };
    asked.into_iter().filter_map(of).collect()
}
