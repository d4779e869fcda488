//! The view of a mechanism that it is first seen in: square to its plane, or in perspective.

use super::bodies::{Anchor, Bodies};
use crate::model::{JointKind, Model};
use crate::space::Vec3;
use std::collections::BTreeMap;

/// Cosine of the largest angle between axes that count as parallel.
const PARALLEL: f64 = 0.999;
/// Extent square to a plane, as a part of the extent within, up to which a mechanism is planar.
const FLAT: f64 = 0.45;
/// Height of the eye of a view in perspective, in rad.
const ELEVATION: f64 = 0.38;
/// Turn of the eye about the vertical of a view in perspective, in rad.
const AZIMUTH: f64 = 0.65;

/// The place of the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// middle of what is seen, in ground
    pub centre: Vec3<f64>,
    /// diagonal of what is seen   (length)
    pub size: f64,
    /// direction from the middle to the eye, of unit length
    pub eye: Vec3<f64>,
    /// direction that is upwards, of unit length, square to `eye` in a plane view
    pub up: Vec3<f64>,
    /// whether the mechanism moves in a plane, square to `eye`
    pub is_planar: bool,
}

impl View {
    /// Chooses the view of a model between the corners of what is seen.
    pub fn new(model: &Model, bodies: &Bodies, low: Vec3<f64>, high: Vec3<f64>) -> Self {
        let size = (high - low).norm();
        let normal = plane(model, bodies).filter(|n| {
            let across = (high - low)
                .0
                .iter()
                .zip(n.0)
                .map(|(d, n)| d * n.abs())
                .sum::<f64>();
            across < FLAT * size
        });
        let upwards = -Vec3(model.gravity);
        let is_planar = normal.is_some();
        let up = up(upwards, normal);
        let eye = normal.unwrap_or_else(|| slanted(up));
        Self {
            centre: (low + high).times(0.5),
            size: if size > 0.0 { size } else { 1.0 },
            eye,
            up,
            is_planar,
        }
    }

    /// Returns the view of the same along an axis of ground, against it: 0 x, 1 y, 2 z.
    pub fn along(&self, axis: usize) -> Self {
        // y is looked along, so that z is upwards and x to the right
        let eye = Vec3::axis(axis).times(if axis == 1 { -1.0 } else { 1.0 });
        let square = |v: Vec3<f64>| unit(v - eye.times(eye.dot(v)));
        let steep = self.up.dot(eye).abs() > 0.9;
        let fallback = Vec3::axis(if axis == 2 { 1 } else { 2 });
        let up = Some(self.up)
            .filter(|_| !steep)
            .and_then(square)
            .unwrap_or(fallback);
        Self {
            eye,
            up,
            is_planar: true,
            ..*self
        }
    }

    /// Returns the view of the same in perspective, from the side and from above.
    pub fn slanted(&self) -> Self {
        Self {
            eye: slanted(self.up),
            is_planar: false,
            ..*self
        }
    }

    /// Returns the directions to the right and upwards on the picture.
    pub fn axes(&self) -> (Vec3<f64>, Vec3<f64>) {
        let right = unit(self.up.cross(self.eye)).unwrap_or(Vec3::axis(0));
        (right, self.eye.cross(right))
    }
}

/// Returns the direction to an eye at the side and above.
fn slanted(up: Vec3<f64>) -> Vec3<f64> {
    let side = (0..3).map(Vec3::axis).find(|a| a.dot(up).abs() < 0.5);
    let across = unit(up.cross(side.unwrap_or_default())).unwrap_or_default();
    let ahead = across.cross(up);
    let level = ahead.times(AZIMUTH.cos()) + across.times(AZIMUTH.sin());
    level.times(ELEVATION.cos()) + up.times(ELEVATION.sin())
}

fn unit(v: Vec3<f64>) -> Option<Vec3<f64>> {
    let n = v.norm();
    (n > 0.0 && n.is_finite()).then(|| v.times(1.0 / n))
}

/// Returns the direction upwards: against gravity, along the axis that it is nearest to; without
/// gravity y of a plane x–y, else z.
fn up(against_gravity: Vec3<f64>, normal: Option<Vec3<f64>>) -> Vec3<f64> {
    let square = |v: Vec3<f64>| match normal {
        Some(n) => unit(v - n.times(n.dot(v))).filter(|_| n.dot(v).abs() < PARALLEL * v.norm()),
        None => unit(v),
    };
    let likely = match normal {
        Some(n) if n.0[2].abs() > PARALLEL => Vec3::axis(1),
        _ => Vec3::axis(2),
    };
    let all = [against_gravity, likely, Vec3::axis(1), Vec3::axis(0)];
    all.into_iter().find_map(square).unwrap_or(Vec3::axis(2))
}

/// Returns the normal of the plane that joints keep a mechanism in, if they do.
fn plane(model: &Model, bodies: &Bodies) -> Option<Vec3<f64>> {
    let z_of = |Anchor { body, frame }: Anchor| {
        let placed = bodies.all[body].placed;
        placed.rotation.apply(frame.rotation.column(2))
    };
    let mut normal: Option<Vec3<f64>> = None;
    let mut within = Vec::new();
    // how each body is held: by balls alone, and by how many
    let mut balls = BTreeMap::new();
    for joint in model.joints.values() {
        let Some(z) = bodies.marker(joint.j).or(bodies.marker(joint.i)).map(z_of) else {
            continue;
        };
        for Anchor { body, .. } in [joint.i, joint.j].iter().filter_map(|m| bodies.marker(*m)) {
            let (alone, count) = balls.entry(body).or_insert((true, 0));
            *alone &= joint.kind == JointKind::Spherical;
            *count += 1;
        }
        match joint.kind {
            JointKind::Revolute | JointKind::Planar => {
                let n = *normal.get_or_insert(z);
                if n.dot(z).abs() < PARALLEL {
                    return None;
                }
            }
            JointKind::Translational => within.push(z),
            JointKind::Cylindrical | JointKind::Spherical | JointKind::Fixed => {}
            JointKind::Rackpin => {}
            JointKind::Universal | JointKind::Hooke | JointKind::Convel | JointKind::Screw => {
                return None;
            }
        }
    }
    let n = normal?;
    if balls.values().any(|held| *held == (true, 1)) {
        // a body that hangs on one ball swings out of every plane
        return None;
    }
    if within.iter().any(|z| n.dot(*z).abs() > 0.05) {
        return None;
    }
    let largest =
        n.0.iter()
            .fold(0.0, |a: f64, b| if b.abs() > a.abs() { *b } else { a });
    // the eye is on the positive side, but of y, which looks into the picture where z is up
    let is_along_y = n.0[1].abs() > PARALLEL;
    let flip = (largest < 0.0) != is_along_y;
    Some(if flip { -n } else { n })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An arm about Z, a load at its end on a joint, and gravity along Z.
    fn load_on(joint: &str) -> View {
        let text = format!(
            "a crane\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=20, IP=1,1,1\n\
             MARKER/20, PART=2\nMARKER/21, PART=2, QP=5,0,0\nPART/3, MASS=1, CM=31, IP=1,1,1\n\
             MARKER/30, PART=3, QP=5,0,0\nMARKER/31, PART=3, QP=5,0,-1\n\
             JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, {joint}, I=30, J=21\nACCGRAV/KGRAV=-9.81\nEND\n"
        );
        let model = Model::from_text(&text).expect("a model");
        let corners = [Vec3([0.0; 3]), Vec3([5.0, 0.0, 1.0])];
        View::new(&model, &Bodies::new(&model), corners[0], corners[1])
    }

    #[test]
    fn an_arm_with_a_load_on_a_ball_is_seen_in_perspective_and_one_on_a_hinge_in_its_plane() {
        assert!(!load_on("SPHERICAL").is_planar);
        assert!(load_on("REVOLUTE").is_planar);
    }
}
