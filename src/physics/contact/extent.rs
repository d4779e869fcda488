//! The size and the thickness of a body of a contact: a step must not carry one through the other
//! between two evaluations.

use super::Solid;
use super::curves::SOLID_DEPTH;
use super::outline::Outline;

/// A ball about a body, and the thickness of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// centre of the ball, in the frame of the marker
    pub centre: [f64; 3],
    /// radius of the ball
    pub radius: f64,
    /// smallest thickness in any direction
    pub thickness: f64,
}

impl Extent {
    /// Returns the extent of a box from corner to corner.
    fn between(low: [f64; 3], high: [f64; 3]) -> Self {
        let size = [0, 1, 2].map(|k| high[k] - low[k]);
        Self {
            centre: [0, 1, 2].map(|k| 0.5 * (low[k] + high[k])),
            radius: 0.5 * size.iter().map(|s| s * s).sum::<f64>().sqrt(),
            thickness: size.into_iter().fold(f64::INFINITY, f64::min),
        }
    }

    /// Returns the extent of a solid, or `None` for a plane: nothing passes through it however deep
    /// it is.
    pub fn of(solid: &Solid) -> Option<Self> {
        Some(match solid {
            Solid::Plane { .. } => return None,
            Solid::Ball { radius: r } => Self::between([-r; 3], [*r; 3]),
            Solid::Box { low, high } => Self::between(*low, *high),
            Solid::Frustum { z, radius } => {
                let r = radius[0].max(radius[1]);
                Self::between([-r, -r, z[0]], [r, r, z[1]])
            }
            Solid::Ellipsoid { semi } => Self::between(semi.map(|a| -a), *semi),
            Solid::Torus { ring, tube } => {
                let r = ring + tube;
                Self::between([-r, -r, -tube], [r, r, *tube])
            }
            Solid::Hull(points) => {
                let bound = |worst: f64, nearer: fn(f64, f64) -> f64| {
                    [0, 1, 2].map(|k| points.iter().fold(worst, |m, p| nearer(m, p[k])))
                };
                Self::between(
                    bound(f64::INFINITY, f64::min),
                    bound(f64::NEG_INFINITY, f64::max),
                )
            }
        })
    }

    /// Returns the extent of an outline. Its solid is as deep as its pair searches for touches,
    /// which depends on the smaller one of both; a point has no thickness.
    pub fn of_outline(outline: &Outline) -> Self {
        let centre = outline.middle();
        Self {
            centre: [centre[0], centre[1], 0.0],
            radius: outline.size,
            thickness: SOLID_DEPTH * outline.size,
        }
    }

    /// Returns the shortest way on which two bodies, both solids or both `outlines`, overlap when
    /// one goes through the other. A body without thickness counts with a thousandth of the smaller
    /// one's radius.
    pub fn overlap(&self, other: &Self, outlines: bool) -> f64 {
        let both = [self, other];
        let least = |all: [f64; 2]| {
            all.into_iter()
                .filter(|&x| x > 0.0)
                .fold(f64::INFINITY, f64::min)
        };
        let thickness = both.map(|e| e.thickness);
        if outlines {
            least(thickness)
        } else {
            thickness
                .iter()
                .sum::<f64>()
                .max(1e-3 * least(both.map(|e| e.radius)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plate_is_as_thin_as_its_shortest_edge_and_a_plane_is_not_thin() {
        let plate = Solid::Box {
            low: [-3.0, -4.0, -0.1],
            high: [3.0, 4.0, 0.1],
        };
        let extent = Extent::of(&plate).unwrap();
        assert_eq!((extent.centre, extent.thickness), ([0.0; 3], 0.2));
        assert!((extent.radius - 25.01f64.sqrt()).abs() < 1e-15);
        let plane = Solid::Plane {
            x: [None; 2],
            y: [None; 2],
        };
        assert_eq!(Extent::of(&plane), None);
    }
}
