//! Where two convex solids touch for which there is no formula: box, cylinder, frustum, ellipsoid, hull, ball against each other.
//!
//! 1. **Direction** (`direction.rs`). The direction n from J's solid to I's in which they overlap least: for two boxes among the
//!    normals of faces and the products of edges, else by the algorithm of Gilbert, Johnson and Keerthi (parry), made exact by the features
//!    that look at each other.
//!
//! 2. **Points** (`points.rs`). The face of each solid that looks at the other is laid along n onto a plane: the points are the corners of
//!    each that lie within the other, and where their outlines cross. At each the two faces say how deep it is. A rim is a
//!    circle of [`RIM`] points with four corners, one of them the deepest; the side of a cylinder is a line.
//! 3. **Shares.** Points that are near each other share what one point would do, so that the force does not jump
//!    where a corner of the overlap becomes two.
//!
//! Forces, damping and friction are those of every contact (`law.rs`). The points themselves jump where other faces come to look at each
//! other, and the force with them, if they are deep by then.

mod body;
mod direction;
mod flat;
pub mod hull;
mod points;
mod polytope;

use super::{Solid, TOUCH_NUMBERS};
pub(super) use body::Body;
pub use body::RIM;
use parry3d_f64::math::{Matrix, Pose, Rotation, Vector};

/// Solids farther apart than this many times their size are left alone.
const FAR: f64 = 1e6;

/// The question for a pair of solids.
#[derive(Debug)]
pub struct Query {
    i: Body,
    j: Body,
}

impl Query {
    /// For the solids of I and J; `None`: one of them is no convex solid of finite size.
    pub fn new(i: &Solid, j: &Solid) -> Option<Self> {
        Some(Self {
            i: Body::new(i)?,
            j: Body::new(j)?,
        })
    }

    /// The touches for a pose of I's marker in J's, its position and the three columns of its axes, as [`super::found`] reads
    /// them   (TOUCHES × TOUCH_NUMBERS).
    pub fn ask(&self, pose: &[f64], out: &mut [f64]) {
        super::nothing(out);
        let reach = FAR * (self.i.size[1] + self.j.size[1]);
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
