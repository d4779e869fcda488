//! CONTACT: where two solids touch (a file per kind of question), and what they do to each other there (`law.rs`).
//!
//! Solids stand in the frame of one marker each. What is found is a list of [`Touch`]es of fixed length, whether they touch
//! or not: whoever records the equations needs the same operations everywhere, and the law gives no force where the depth
//! is negative. All of it is a formula of the two frames, so that derivatives and the instant of first touch come by
//! themselves.
//!
//! | pair | points |
//! |---|---|
//! | ball – ball, plane, box, cylinder, frustum, torus | 1, from the distance of the centre (`ball.rs`) |
//! | plane – box, hull | the corners (`plane.rs`) |
//! | plane – cylinder, frustum | on each rim the deepest point and those a quarter and half a turn further |
//! | plane – torus | the same four of its ring |
//! | plane – ellipsoid | 1, the deepest |
//! | point | a ball without radius |
//! | torus – box, cylinder, frustum, ellipsoid, hull, torus | where the ring is nearest, and 12 places of it that are always looked at (`wire.rs`) |
//! | curve, circle, arc – solid | the same of a wire without thickness |
//! | point – ellipsoid, hull | 1, from its distance (`ellipsoid.rs`) |
//! | curve, circle, arc, point with each other, in a plane | up to 8, where one reaches deepest into the other (`outline.rs`, `curves.rs`) |
//! | box, cylinder, frustum, ellipsoid, hull with each other | up to 8, found by queries (`query/`, feature `geometry`) |
//! | plane – plane, point – point | none: what has no end or no size meets nothing |

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
pub use law::Law;
use outline::Outline;
use std::sync::Arc;

/// What is asked for the touches of a pair that no formula finds.
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
    /// Whether it depends on one of the twelve numbers of a pose: what lies in a plane knows nothing of z.
    pub fn reads(&self, number: usize) -> bool {
        match self {
            Question::Outlines(_) => number < 9 && number % 3 < 2,
            Question::Solids(_) | Question::Wire(_) => true,
        }
    }
    /// How many touches it finds at most.
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
    /// Whether it is convex and of finite size, so that queries can be made for it.
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
    /// What it is called.
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
    /// how far they overlap; negative: they do not touch
    pub depth: S,
    /// unit vector from J's solid into I's, ground axes
    pub normal: Vec3<S>,
    /// where they act on each other, in ground
    pub point: Vec3<S>,
    /// part of the law's force that acts here: 1, less where several points stand for one place
    pub share: S,
}

/// Most touches that a query between two solids or two outlines finds.
pub const TOUCHES: usize = 8;
/// Numbers of one: its point on I's solid and on J's, each in the frame of its marker, the direction from J's solid to I's in
/// the frame of J's marker, what is taken off the depth (of touches that are not there), its share.
pub const TOUCH_NUMBERS: usize = 11;

/// Numbers of touches that are not there: no share, and a gap.
fn nothing(out: &mut [f64]) {
    for touch in out.chunks_mut(TOUCH_NUMBERS) {
        touch.fill(0.0);
        touch[TOUCH_NUMBERS - 2] = 1.0;
    }
}

/// The touches that a query found, as formulas of the two frames: the points stay on their solids.
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
    /// The same, seen from the other solid.
    fn turned(self) -> Self {
        Self {
            normal: -self.normal,
            ..self
        }
    }
}

/// Which formula finds the touches of a pair.
#[derive(Clone, Debug, PartialEq)]
pub enum Pair {
    /// a ball on I or, `turned`, on J, and a solid
    Ball {
        /// of the ball
        radius: f64,
        /// the other
        solid: Solid,
        /// the ball is J's
        turned: bool,
    },
    /// a solid on I or, `turned`, on J, and a plane
    Plane {
        /// on the plane
        solid: Solid,
        /// bounds of the plane
        x: [Option<f64>; 2],
        /// bounds of the plane
        y: [Option<f64>; 2],
        /// the solid is J's
        turned: bool,
    },
}

impl Pair {
    /// The formula for two solids; `None`: there is none.
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

    /// Where the solids of I and J touch.
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

/// What the touches do to I, about its origin.
pub fn action<S: Scalar>(
    touches: &[Touch<S>],
    law: &Law,
    i: &MarkerState<S>,
    j: &MarkerState<S>,
) -> Action<S> {
    let mut sum = Action::zero();
    for touch in touches {
        let (to_i, to_j) = (touch.point - i.p_GM, touch.point - j.p_GM);
        let velocity = i.v_GM + i.w_GM.cross(to_i) - j.v_GM - j.w_GM.cross(to_j);
        let force = law.force(touch.depth, touch.normal, velocity);
        let force = force.times(touch.share);
        sum = sum.plus(&Action {
            force,
            torque: to_i.cross(force),
        });
    }
    sum
}
