//! The touches of two convex solids without a formula: box, cylinder, frustum, ellipsoid, hull,
//! ball with each other.
//!
//! 1. **Direction** (`direction.rs`). The direction n from J's solid to I's in which they overlap
//!    least: for two boxes among the normals of faces and the products of edges, else by the
//!    algorithm of Gilbert, Johnson and Keerthi (parry), made exact by the features that face each
//!    other.
//! 2. **Points** (`points.rs`). The face of each solid that looks at the other is projected along n
//!    onto a plane: the points are the corners of each that lie within the other, and the
//!    intersections of their outlines. The two faces give the depth at each point. A rim is a
//!    circle of [`RIM_POINTS`] points with four corners, one of them the deepest; the side of a
//!    cylinder is a line.
//! 3. **Shares.** Points that are near each other share the force of one, so that the force does
//!    not jump where a corner of the overlap becomes two.
//!
//! Forces, damping and friction are those of every contact (`law.rs`). The points themselves jump
//! where other faces come to face each other, and the force with them, if they are deep by then.

mod body;
mod direction;
mod flat;
pub mod hull;
mod points;
mod polytope;
pub mod separation;
pub mod shell;

use super::{Solid, TOUCH_NUMBERS};
pub(super) use body::Body;
pub use body::RIM_POINTS;
use parry3d_f64::math::{Matrix, Pose, Rotation, Vector};

/// Distance, as a multiple of their size, above which solids are not searched.
const SEARCH_DISTANCE: f64 = 1e6;

/// The search for the touches of a pair of solids.
#[derive(Debug)]
pub struct Query {
    i: Body,
    j: Body,
}

impl Query {
    /// Prepares for the solids of I and J; `None` if one of them is not convex or not of finite
    /// size.
    pub fn new(i: &Solid, j: &Solid) -> Option<Self> {
        Some(Self {
            i: Body::new(i)?,
            j: Body::new(j)?,
        })
    }

    /// Writes the touches for a pose of I's marker in J's, its position and the three columns of
    /// its axes, in the form that [`super::found`] reads   (TOUCHES × TOUCH_NUMBERS).
    pub fn ask(&self, pose: &[f64], out: &mut [f64]) {
        super::nothing(out);
        let reach = SEARCH_DISTANCE * (self.i.size[1] + self.j.size[1]);
        if pose.len() != 12 || !pose.iter().all(|x| x.abs() <= reach.max(2.0)) {
            return;
        }
        let column = |k: usize| Vector::new(pose[3 * k], pose[3 * k + 1], pose[3 * k + 2]);
        let axes = Matrix::from_cols(column(1), column(2), column(3));
        let turn = Rotation::from_mat3(&axes).normalize();
        if !turn.is_finite() {
            return;
        }
        let pose = Pose::from_parts(column(0), turn);
        let Some(n) = self.direction(&pose) else {
            return;
        };
        let points = self.points(&pose, n);
        for (touch, [p_i, p_j, share]) in out.chunks_mut(TOUCH_NUMBERS).zip(&points) {
            let p_i = pose.inverse_transform_point(*p_i);
            let all = [
                p_i.x, p_i.y, p_i.z, p_j.x, p_j.y, p_j.z, n.x, n.y, n.z, 0.0, share.x,
            ];
            touch.copy_from_slice(&all);
        }
    }
}
