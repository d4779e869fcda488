//! Frames of parts and markers as the dataset places them.

use super::{Model, Orientation};
use crate::space::{Frame, Mat3, Vec3, rotation};

/// Returns the orientation of a part or marker against its parent.
///
/// # Errors
/// The points that should give its axes do not.
pub(crate) fn orientation(o: &Orientation, origin: [f64; 3]) -> Result<Mat3<f64>, String> {
    let from = |p: &Option<[f64; 3]>| p.map(|p| Vec3(p) - Vec3(origin));
    let r = match o {
        Orientation::Aligned => return Ok(Mat3::identity()),
        Orientation::Euler([psi, theta, phi]) => rotation::from_313(*psi, *theta, *phi),
        Orientation::Points { z, x, use_x } => {
            let fallback = |given: Vec3<f64>, first: usize| {
                let axis = Vec3::<f64>::axis(first);
                if axis.cross(given).norm() > 1e-9 * given.norm() {
                    axis
                } else {
                    Vec3::axis((first + 1) % 3)
                }
            };
            let frame = if *use_x {
                let x = from(x).ok_or("USEXP needs XP")?;
                let z = from(z).unwrap_or_else(|| fallback(x, 2));
                // from_z_and_x with the roles of z and x exchanged: its y is x × z, ours z × x
                rotation::from_z_and_x(x, z)
                    .map(|m| Mat3::from_columns(m.column(2), -m.column(1), m.column(0)))
            } else {
                let z = from(z).unwrap_or_else(|| Vec3::axis(2));
                let x = from(x).unwrap_or_else(|| fallback(z, 0));
                rotation::from_z_and_x(z, x)
            };
            frame.ok_or(
                "the points that should give its axes coincide with its origin or lie on one line",
            )?
        }
    };
    Ok(rotation::snapped(&r))
}

/// Returns the pose of a marker in ground; `None` where it has none of its own, or its axes have no
/// directions.
pub(crate) fn marker_frame(model: &Model, id: u32) -> Option<Frame<f64>> {
    let marker = model.markers.get(&id).filter(|m| !m.floating)?;
    let body = model.body(marker.owner.body()?)?;
    let own = Frame {
        rotation: orientation(&marker.orientation, marker.qp).ok()?,
        position: Vec3(marker.qp),
    };
    if body.ground {
        return Some(own);
    }
    let carrier = Frame {
        rotation: orientation(&body.orientation, body.qg).ok()?,
        position: Vec3(body.qg),
    };
    Some(carrier.compose(&own))
}
