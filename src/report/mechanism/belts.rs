//! The belts of couplers: two wheels about parallel axes, and the band around both, open or crossed
//! as their senses ask.
//!
//! ```text
//! s₁ q₁ + s₂ q₂ = 0        r₁ : r₂ = |s₁| : |s₂|        open where −s₂/s₁ > 0, crossed where it is below
//! ```
//!
//! Wheels that GRAPHICS show as cylinders about their axes have these radii, where they fit the
//! ratio; others are drawn with the band.

use super::bodies::Anchor;
use super::solid::Solid;
use super::symbols::Symbols;
use super::{Form, Piece, colours};
use crate::model::{Coupler, ElementId, ElementKind, Shape};
use crate::space::{Frame, Mat3};
use std::f64::consts::PI;

/// Radii of both wheels together, as a part of the distance of their axes, where no shape says.
const WHEELS: f64 = 0.62;
/// Largest cosine of the angle between axes that are not parallel.
const PARALLEL: f64 = 1.0 - 1e-6;
/// Largest difference of a ratio of radii from that of the scales, as a part of it.
const RATIO_TOLERANCE: f64 = 0.02;
/// Corners of the band on a full circle.
const CORNERS: f64 = 72.0;

/// A wheel of a belt.
struct Wheel {
    /// the body that turns, with the frame of its axis
    turns: Anchor,
    /// the frame of the axis on the carrier
    axis: Anchor,
    /// its number in SCALES
    scale: f64,
}

impl Symbols<'_> {
    /// Adds the belts of couplers between two wheels.
    pub(super) fn belts(&self, pieces: &mut Vec<Piece>) {
        for (&number, coupler) in &self.model.couplers {
            let id = ElementKind::Coupler.id(number);
            if self.model.is_active(id)
                && let Some([a, b]) = self.wheels_of(id, coupler)
            {
                self.belt(id, [&a, &b], pieces);
            }
        }
    }

    /// Returns the two wheels of a coupler; `None` where it couples something else.
    fn wheels_of(&self, id: ElementId, coupler: &Coupler) -> Option<[Wheel; 2]> {
        let (&[first, second], &[s1, s2]) = (&coupler.joints[..], &coupler.scales[..]) else {
            return None;
        };
        let ends = |joint: u32, k: usize| {
            let joint = self.model.joints.get(&joint)?;
            let chosen = coupler.rotational.get(k).copied().flatten();
            let turns = joint.kind.displacements().chosen(chosen).ok()?;
            self.ends(id, joint.i, joint.j).filter(|_| turns)
        };
        let (a, b) = (ends(first, 0)?, ends(second, 1)?);
        let carriers = [b.i.body, b.j.body];
        let carrier = [a.i.body, a.j.body];
        let carrier = carrier.into_iter().find(|body| carriers.contains(body))?;
        let wheel = |ends: super::symbols::Ends, scale: f64| {
            let (turns, axis) = match ends.i.body == carrier {
                true => (ends.j, ends.i),
                false => (ends.i, ends.j),
            };
            Wheel { turns, axis, scale }
        };
        Some([wheel(a, s1), wheel(b, s2)])
    }

    /// Adds the band around two wheels, and the wheels that no shape shows.
    fn belt(&self, id: ElementId, [a, b]: [&Wheel; 2], pieces: &mut Vec<Piece>) {
        let s = self.sizes.joint;
        let (p, q) = (a.axis.frame.position, b.axis.frame.position);
        let (z, other) = (
            a.axis.frame.rotation.column(2),
            b.axis.frame.rotation.column(2),
        );
        let across = (q - p) - z.times(z.dot(q - p));
        let distance = across.norm();
        let is_parallel = z.dot(other).abs() > PARALLEL;
        if !is_parallel || distance <= 0.0 || a.scale == 0.0 || b.scale == 0.0 {
            return;
        }
        let is_open = -a.scale * b.scale * z.dot(other) > 0.0;
        let radii = self.radii([a, b], distance);
        let reach = match is_open {
            true => (radii[0] - radii[1]).abs(),
            false => radii[0] + radii[1],
        };
        if reach >= distance {
            return;
        }
        let x = across.times(1.0 / distance);
        let frame = Frame {
            rotation: Mat3::from_columns(x, z.cross(x), z),
            position: p,
        };
        let band = band(radii, distance, is_open);
        let form = Form::Solid(Solid::tube(&band, true, 0.3 * s, 6)).placed(&frame);
        pieces.push(Piece {
            body: a.axis.body,
            element: id,
            role: super::Role::Joint,
            form,
            colour: colours::JOINT,
        });
        for (wheel, radius) in [a, b].into_iter().zip(radii) {
            if !self.shaped.contains(&wheel.turns.body) {
                pieces.push(self.wheel(id, wheel.turns, radius - 0.3 * s, false));
            }
        }
    }

    /// Returns the radii of two wheels: those of their shapes, else of the ratio.
    fn radii(&self, wheels: [&Wheel; 2], distance: f64) -> [f64; 2] {
        let [a, b] = wheels.map(|wheel| wheel.scale.abs());
        let made = [a, b].map(|scale| WHEELS * distance * scale / (a + b));
        match wheels.map(|wheel| self.drawn_radius(wheel)) {
            [Some(r), Some(t)] if (r * b - t * a).abs() < RATIO_TOLERANCE * t * a => [r, t],
            _ => made,
        }
    }

    /// Returns the radius of the largest cylinder about the axis of a wheel.
    fn drawn_radius(&self, wheel: &Wheel) -> Option<f64> {
        let axis = &wheel.turns.frame;
        let mut found: Option<f64> = None;
        for graphics in self.model.graphics.values() {
            let Shape::Cylinder { cm, radius, .. } = graphics.shape else {
                continue;
            };
            let Some(at) = self.bodies.marker(cm) else {
                continue;
            };
            let (z, off) = (axis.rotation.column(2), at.frame.position - axis.position);
            let beside = (off - z.times(z.dot(off))).norm();
            let along = z.dot(at.frame.rotation.column(2)).abs();
            if at.body == wheel.turns.body && along > PARALLEL && beside < 1e-3 * radius {
                found = Some(found.unwrap_or(0.0).max(radius));
            }
        }
        found
    }
}

/// Returns the band around circles about the origin and about a point on x, once around.
fn band([r, t]: [f64; 2], distance: f64, is_open: bool) -> Vec<[f64; 3]> {
    let on = |centre: f64, radius: f64, from: f64, to: f64| {
        let n = ((to - from).abs() / (2.0 * PI) * CORNERS).ceil().max(2.0);
        (0..=n as usize).map(move |k| {
            let angle = from + (to - from) * k as f64 / n;
            [centre + radius * angle.cos(), radius * angle.sin(), 0.0]
        })
    };
    // directions from the centres to the points where the straight parts begin
    let (first, second): (Vec<_>, Vec<_>) = if is_open {
        let a = ((r - t) / distance).acos();
        let first = on(0.0, r, a, 2.0 * PI - a).collect();
        (first, on(distance, t, -a, a).collect())
    } else {
        let a = ((r + t) / distance).acos();
        let first = on(0.0, r, a, 2.0 * PI - a).collect();
        (first, on(distance, t, PI - a, a - PI).collect())
    };
    [first, second].concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::Vec3;

    #[test]
    fn a_band_is_as_long_as_its_arcs_and_tangents() {
        let length = |points: &[[f64; 3]]| {
            let next = points.iter().cycle().skip(1);
            let step = |(a, b): (&[f64; 3], &[f64; 3])| (Vec3(*b) - Vec3(*a)).norm();
            points.iter().zip(next).map(step).sum::<f64>()
        };
        let (r, t, d) = (3.0, 1.0, 7.0);
        let (r, t, d): (f64, f64, f64) = (r, t, d);
        let straight = |sum: f64| (d * d - sum * sum).sqrt();
        let a = ((r - t) / d).acos();
        let open = 2.0 * straight(r - t) + r * 2.0 * (PI - a) + t * 2.0 * a;
        let a = ((r + t) / d).acos();
        let crossed = 2.0 * straight(r + t) + (r + t) * 2.0 * (PI - a);
        // corners cut off less than (2π/72)²/24 of an arc
        assert!((length(&band([r, t], d, true)) / open - 1.0).abs() < 4e-4);
        assert!((length(&band([r, t], d, false)) / crossed - 1.0).abs() < 4e-4);
    }
}
