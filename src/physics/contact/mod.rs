//! CONTACT: the places where two solids touch (one file per kind of pair), and the forces there
//! (`law.rs`).
//!
//! Each solid stands in the frame of one marker. The result is a list of [`Touch`]es of fixed
//! length, whether the solids touch or not: the recorded equations need the same operations
//! everywhere, and the law gives no force where the depth is negative. All of it is a formula of
//! the two frames, so that derivatives and the instant of first touch need no code of their own.
//!
//! | pair | points |
//! |---|---|
//! | ball – ball, plane, box, cylinder, frustum, torus | 1, from the centre (`ball.rs`) |
//! | plane – box, hull | the corners (`plane.rs`) |
//! | plane – cylinder, frustum | the deepest point of each rim and three more |
//! | plane – torus | the same four of its ring |
//! | plane – ellipsoid | 1, the deepest |
//! | point | a ball without radius |
//! | torus – every solid but a ball or a plane | nearest and 12 fixed points of it (`wire/`) |
//! | curve, circle, arc – solid | the same of a wire without thickness |
//! | point – ellipsoid, hull | 1, from its distance (`ellipsoid.rs`) |
//! | curve, circle, arc, point with each other | up to 8, in a plane (`outline.rs`, `curves.rs`) |
//! | other convex solids with each other | up to 8, by parry (`query/`, feature `geometry`) |
//! | plane – plane, point – point | none |

pub mod ball;
pub mod curves;
mod ellipsoid;
pub mod extent;
pub mod law;
pub mod outline;
pub mod plane;
#[cfg(feature = "geometry")]
pub mod query;
pub mod wire;

use super::action::Action;
use crate::scalar::Scalar;
use crate::space::{MarkerState, Vec3};
pub use law::{Given, Law};
use outline::Outline;
use std::sync::Arc;

/// A search for the touches of a pair that has no formula.
#[derive(Clone, Debug)]
pub enum Question {
    /// two convex solids
    Solids(Box<[Solid; 2]>),
    /// a torus, a plane curve or a point, and a solid
    Wire(Box<wire::Wire>),
    /// two outlines, I's and J's
    Outlines([Arc<Outline>; 2]),
}

impl Question {
    /// Returns whether the search depends on this one of the twelve numbers of a pose: outlines in
    /// a plane do not depend on z.
    pub fn reads(&self, number: usize) -> bool {
        match self {
            Question::Outlines(_) => number < 9 && number % 3 < 2,
            Question::Solids(_) | Question::Wire(_) => true,
        }
    }
    /// Returns the largest number of touches that it finds.
    pub fn touches(&self) -> usize {
        match self {
            Question::Solids(_) | Question::Outlines(_) => TOUCHES,
            Question::Wire(wire) => wire.touches(),
        }
    }
}

/// A solid in the frame of its marker; lengths in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid {
    /// about the origin; radius 0: a point
    Ball {
        /// its radius
        radius: f64,
    },
    /// the half space below z = 0, above a rectangle where bounds are given
    Plane {
        /// least and largest x
        x: [Option<f64>; 2],
        /// least and largest y
        y: [Option<f64>; 2],
    },
    /// edges along the axes
    Box {
        /// least corner
        low: [f64; 3],
        /// largest corner
        high: [f64; 3],
    },
    /// about z: a cylinder where the radii agree, a cone where one is 0
    Frustum {
        /// z of the two ends, ascending
        z: [f64; 2],
        /// radii there
        radius: [f64; 2],
    },
    /// about the origin
    Ellipsoid {
        /// half its diameters along the axes
        semi: [f64; 3],
    },
    /// about z
    Torus {
        /// radius of the ring
        ring: f64,
        /// radius of the tube
        tube: f64,
    },
    /// the convex hull of points
    Hull(Vec<[f64; 3]>),
}

impl Solid {
    /// Returns whether it is convex and of finite size, so that parry can be asked about it.
    pub fn can_be_queried(&self) -> bool {
        match self {
            Solid::Ball { radius } => *radius > 0.0,
            Solid::Box { .. }
            | Solid::Frustum { .. }
            | Solid::Ellipsoid { .. }
            | Solid::Hull(_) => true,
            Solid::Plane { .. } | Solid::Torus { .. } => false,
        }
    }
    /// Returns the word for it in messages.
    pub fn name(&self) -> &'static str {
        match self {
            Solid::Ball { radius } if *radius == 0.0 => "point",
            Solid::Ball { .. } => "sphere",
            Solid::Plane { .. } => "plane",
            Solid::Box { .. } => "box",
            Solid::Frustum { radius: [a, b], .. } if a == b => "cylinder",
            Solid::Frustum { .. } => "frustum",
            Solid::Ellipsoid { .. } => "ellipsoid",
            Solid::Torus { .. } => "torus",
            Solid::Hull(_) => "convex hull",
        }
    }
}

/// A place where two solids touch, or come nearest.
#[derive(Clone, Copy, Debug)]
pub struct Touch<S> {
    /// overlap, in length units; negative: they do not touch
    pub depth: S,
    /// unit vector from J's solid into I's, ground axes
    pub normal: Vec3<S>,
    /// point at which they act on each other, in ground
    pub point: Vec3<S>,
    /// part of the law's force that acts here: 1, or less where several points stand for one place
    pub share: S,
}

/// Largest number of touches between two solids or two outlines.
pub const TOUCHES: usize = 8;
/// Numbers per touch that a search returns: the points on I's and on J's solid, each in the frame
/// of its marker, the direction from J's solid to I's in the frame of J's marker, a subtraction
/// from the depth (for touches that are not there), and the share.
pub const TOUCH_NUMBERS: usize = 11;

/// Writes the numbers of touches that are not there: no share, and a gap.
fn nothing(out: &mut [f64]) {
    for touch in out.chunks_mut(TOUCH_NUMBERS) {
        touch.fill(0.0);
        touch[TOUCH_NUMBERS - 2] = 1.0;
    }
}

/// Turns the numbers of a search into touches, as formulas of the two frames: the points stay on
/// their solids.
pub fn found<S: Scalar>(numbers: &[S], i: &MarkerState<S>, j: &MarkerState<S>) -> Vec<Touch<S>> {
    let one = |touch: &[S]| {
        let vector = |k: usize| Vec3([touch[k], touch[k + 1], touch[k + 2]]);
        let p_i = i.p_GM + i.R_GM.apply(vector(0));
        let p_j = j.p_GM + j.R_GM.apply(vector(3));
        let normal = j.R_GM.apply(vector(6));
        Touch {
            depth: (p_j - p_i).dot(normal) - touch[9],
            normal,
            point: (p_i + p_j).times(S::constant(0.5)),
            share: touch[10],
        }
    };
    numbers.chunks(TOUCH_NUMBERS).map(one).collect()
}

impl<S: Scalar> Touch<S> {
    /// Returns the same touch with I and J exchanged.
    fn turned(self) -> Self {
        Self {
            normal: -self.normal,
            ..self
        }
    }
}

/// The formula for the touches of a pair.
#[derive(Clone, Debug, PartialEq)]
pub enum Pair {
    /// a ball on I or, `turned`, on J, and a solid
    Ball {
        /// radius of the ball
        radius: f64,
        /// the other solid
        solid: Solid,
        /// whether the ball is J's
        turned: bool,
    },
    /// a solid on I or, `turned`, on J, and a plane
    Plane {
        /// the solid on the plane
        solid: Solid,
        /// bounds of the plane along x
        x: [Option<f64>; 2],
        /// bounds of the plane along y
        y: [Option<f64>; 2],
        /// whether the solid is J's
        turned: bool,
    },
}

impl Pair {
    /// Returns the formula for two solids, or `None` if there is none.
    pub fn of(i: &Solid, j: &Solid) -> Option<Pair> {
        let ball = |radius: f64, solid: &Solid, turned: bool| {
            let known = !matches!(solid, Solid::Ellipsoid { .. } | Solid::Hull(_));
            known.then(|| Pair::Ball {
                radius,
                solid: solid.clone(),
                turned,
            })
        };
        let plane = |solid: &Solid, x: [Option<f64>; 2], y: [Option<f64>; 2], turned: bool| {
            let known = !matches!(solid, Solid::Plane { .. });
            known.then(|| Pair::Plane {
                solid: solid.clone(),
                x,
                y,
                turned,
            })
        };
        match (i, j) {
            (Solid::Ball { radius }, solid) => ball(*radius, solid, false),
            (solid, Solid::Ball { radius }) => ball(*radius, solid, true),
            (solid, Solid::Plane { x, y }) => plane(solid, *x, *y, false),
            (Solid::Plane { x, y }, solid) => plane(solid, *x, *y, true),
            _ => None,
        }
    }

    /// Returns the touches of the solids of I and J.
    pub fn touches<S: Scalar>(&self, i: &MarkerState<S>, j: &MarkerState<S>) -> Vec<Touch<S>> {
        match self {
            Pair::Ball {
                radius,
                solid,
                turned: false,
            } => vec![ball::touch(*radius, i, solid, j)],
            Pair::Ball { radius, solid, .. } => vec![ball::touch(*radius, j, solid, i).turned()],
            Pair::Plane {
                solid,
                x,
                y,
                turned: false,
            } => plane::touches(solid, i, (*x, *y), j),
            Pair::Plane { solid, x, y, .. } => {
                let found = plane::touches(solid, j, (*x, *y), i);
                found.into_iter().map(Touch::turned).collect()
            }
        }
    }
}

/// A touch as a routine of the force along the normal is given it.
#[derive(Clone, Copy, Debug)]
pub struct Pressing<S> {
    /// distance of the solids: negative where they overlap
    pub gap: S,
    /// its rate
    pub gap_rate: S,
    /// the point and the normal of I's solid, outwards, in the frame of I's marker
    pub on_i: [Vec3<S>; 2],
    /// the same of J's
    pub on_j: [Vec3<S>; 2],
}

/// A touch as a routine of friction is given it.
#[derive(Clone, Copy, Debug)]
pub struct Slipping<S> {
    /// force along the normal
    pub normal_force: S,
    /// velocity of I's solid against J's across the normal, ground axes
    pub velocity: Vec3<S>,
    /// the point in the frames of I's and of J's marker
    pub points: [Vec3<S>; 2],
}

impl<S: Scalar> Pressing<S> {
    /// Returns what a touch is between two markers.
    pub fn of(touch: &Touch<S>, i: &MarkerState<S>, j: &MarkerState<S>) -> Self {
        let seen = |m: &MarkerState<S>, normal: Vec3<S>| {
            [
                m.R_GM.apply_transposed(touch.point - m.p_GM),
                m.R_GM.apply_transposed(normal),
            ]
        };
        Self {
            gap: -touch.depth,
            gap_rate: touch.velocity(i, j).dot(touch.normal),
            on_i: seen(i, -touch.normal),
            on_j: seen(j, touch.normal),
        }
    }

    /// Returns its numbers, in the order of the fields.
    pub fn numbers(&self) -> impl Iterator<Item = S> {
        let vectors = [self.on_i, self.on_j].concat();
        let rest = vectors.into_iter().flat_map(|v| v.0);
        [self.gap, self.gap_rate].into_iter().chain(rest)
    }
}

impl Pressing<f64> {
    /// Numbers of each.
    pub const LEN: usize = 14;

    /// Returns what the numbers of one are.
    pub fn from_numbers(x: &[f64; Self::LEN]) -> Self {
        let vector = |k: usize| Vec3([x[k], x[k + 1], x[k + 2]]);
        Self {
            gap: x[0],
            gap_rate: x[1],
            on_i: [vector(2), vector(5)],
            on_j: [vector(8), vector(11)],
        }
    }
}

impl<S: Scalar> Slipping<S> {
    /// Returns what a touch is between two markers.
    pub fn of(touch: &Touch<S>, normal_force: S, i: &MarkerState<S>, j: &MarkerState<S>) -> Self {
        let velocity = touch.velocity(i, j);
        Self {
            normal_force,
            velocity: velocity - touch.normal.times(velocity.dot(touch.normal)),
            points: [i, j].map(|m| m.R_GM.apply_transposed(touch.point - m.p_GM)),
        }
    }

    /// Returns its numbers, in the order of the fields.
    pub fn numbers(&self) -> impl Iterator<Item = S> {
        let vectors = [self.velocity, self.points[0], self.points[1]];
        let rest = vectors.into_iter().flat_map(|v| v.0);
        [self.normal_force].into_iter().chain(rest)
    }
}

impl Slipping<f64> {
    /// Numbers of each.
    pub const LEN: usize = 10;

    /// Returns what the numbers of one are.
    pub fn from_numbers(x: &[f64; Self::LEN]) -> Self {
        let vector = |k: usize| Vec3([x[k], x[k + 1], x[k + 2]]);
        Self {
            normal_force: x[0],
            velocity: vector(1),
            points: [vector(4), vector(7)],
        }
    }
}

/// Forces that routines compute, touch by touch; none where the law says them.
#[derive(Clone, Copy, Debug)]
pub struct Outside<'a, S> {
    /// along the normal: one number each
    pub normal: &'a [S],
    /// across it: three each, ground axes
    pub friction: &'a [S],
}

impl<S: Scalar> Touch<S> {
    /// Returns the velocity of I's solid against J's where they touch.
    fn velocity(&self, i: &MarkerState<S>, j: &MarkerState<S>) -> Vec3<S> {
        let (to_i, to_j) = (self.point - i.p_GM, self.point - j.p_GM);
        i.v_GM + i.w_GM.cross(to_i) - j.v_GM - j.w_GM.cross(to_j)
    }
}

/// Returns the action of the touches on I, about its origin.
pub fn action<S: Scalar>(
    touches: &[Touch<S>],
    law: &Law,
    outside: Outside<'_, S>,
    i: &MarkerState<S>,
    j: &MarkerState<S>,
) -> Action<S> {
    let mut sum = Action::zero();
    for (k, touch) in touches.iter().enumerate() {
        let to_i = touch.point - i.p_GM;
        let friction = outside.friction.get(3 * k..3 * k + 3);
        let given = Given {
            normal: outside.normal.get(k).copied(),
            friction: friction.map(|f| Vec3([f[0], f[1], f[2]])),
        };
        let force = law.force(touch.depth, touch.normal, touch.velocity(i, j), given);
        let force = force.times(touch.share);
        sum = sum.plus(&Action {
            force,
            torque: to_i.cross(force),
        });
    }
    sum
}
