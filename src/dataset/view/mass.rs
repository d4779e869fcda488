//! Mass, centre and inertia of parts from their shapes, as Adams View computes them.
//!
//! ```text
//! m = Σ ρ V      c = Σ m c / m      J = Σ (J + m (|d|² − d dᵀ)),  d from the common centre
//! ```

use super::database::{Database, Pose};
use crate::scalar::Scalar;
use crate::space::{Mat3, Vec3};

/// Mass, centre, and inertia about the centre; in the axes of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mass {
    pub mass: f64,
    pub center: Vec3<f64>,
    pub tensor: Mat3<f64>,
}

/// Chords of a rounded corner: so many that its centre has the ten digits that View writes.
const CHORDS: u32 = 2000;

/// The sides that a cylinder has where nothing is said: it is a true circle, as Adams' masses show.
const CIRCLE: f64 = 20.0;
/// Up to so many sides a cylinder is a prism. Masses of Adams are known for 4 sides, which are one,
/// and for 20; between the two nothing is known, which is told of those that are taken as round.
const MOST_SIDES_OF_A_PRISM: f64 = 10.0;

/// The section of a cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Section {
    Round,
    /// taken as round, by its sides
    MaybeRound(f64),
    /// a regular polygon
    Sides(f64),
}

impl Mass {
    fn zero() -> Self {
        Self {
            mass: 0.0,
            center: Vec3::zero(),
            tensor: Mat3::zero(),
        }
    }

    /// Returns the inertia of a mass at the end of `d`.
    fn of_point(mass: f64, d: Vec3<f64>) -> Mat3<f64> {
        let square = d.dot(d);
        Mat3(std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let one = if i == j { square } else { 0.0 };
                mass * (one - d.0[i] * d.0[j])
            })
        }))
    }

    /// Returns both as one.
    fn with(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        if mass == 0.0 {
            return self;
        }
        let sum = self.center.times(self.mass) + other.center.times(other.mass);
        let center = sum.times(1.0 / mass);
        let about = |one: &Self| one.tensor + Self::of_point(one.mass, one.center - center);
        let tensor = about(&self) + about(&other);
        Self {
            mass,
            center,
            tensor,
        }
    }

    /// Returns the same in the frame in which this one's frame is given.
    fn moved(self, frame: &Pose) -> Self {
        let R = frame.rotation;
        Self {
            center: frame.point(self.center),
            tensor: R * self.tensor * R.transpose(),
            ..self
        }
    }

    /// Returns the inertia about the centre in the axes of `R`: xx, yy, zz, xy, xz, yz, as tensor
    /// components.
    pub fn in_axes(&self, R: Mat3<f64>) -> [f64; 6] {
        let m = (R.transpose() * self.tensor * R).0;
        [m[0][0], m[1][1], m[2][2], m[0][1], m[0][2], m[1][2]]
    }
}

/// Returns a prism of density 1 on a polygon of the x-y plane, between two heights.
fn prism(polygon: &[[f64; 2]], bottom: f64, top: f64) -> Mass {
    let (mut area, mut sx, mut sy) = (0.0, 0.0, 0.0);
    let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
    for (k, p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        let cross = p[0] * q[1] - q[0] * p[1];
        area += cross / 2.0;
        sx += cross * (p[0] + q[0]) / 6.0;
        sy += cross * (p[1] + q[1]) / 6.0;
        xx += cross * (p[0] * p[0] + p[0] * q[0] + q[0] * q[0]) / 12.0;
        yy += cross * (p[1] * p[1] + p[1] * q[1] + q[1] * q[1]) / 12.0;
        xy += cross * (p[0] * q[1] + 2.0 * (p[0] * p[1] + q[0] * q[1]) + q[0] * p[1]) / 24.0;
    }
    if area == 0.0 {
        return Mass::zero();
    }
    let height = top - bottom;
    let (x, y) = (sx / area, sy / area);
    let mass = (area * height).abs();
    let share = mass / area;
    let [xx, yy, xy] = [
        xx * share - mass * x * x,
        yy * share - mass * y * y,
        xy * share - mass * x * y,
    ];
    let zz = mass * height * height / 12.0;
    Mass {
        mass,
        center: Vec3([x, y, (bottom + top) / 2.0]),
        tensor: Mat3([
            [yy + zz, -xy, 0.0],
            [-xy, xx + zz, 0.0],
            [0.0, 0.0, xx + yy],
        ]),
    }
}

/// Returns the solid of density 1 that a profile of radii and heights sweeps about z.
fn revolved(profile: &[[f64; 2]]) -> Mass {
    // three points of Gauss: exact for the fourth powers below
    let points = [
        (-(0.6_f64.sqrt()), 5.0 / 9.0),
        (0.0, 8.0 / 9.0),
        (0.6_f64.sqrt(), 5.0 / 9.0),
    ];
    let (mut v, mut first, mut about_z, mut about_x) = (0.0, 0.0, 0.0, 0.0);
    for ends in profile.windows(2) {
        let ([r1, z1], [r2, z2]) = (ends[0], ends[1]);
        for (s, weight) in points {
            let share = (1.0 + s) / 2.0;
            let (r, z) = (r1 + (r2 - r1) * share, z1 + (z2 - z1) * share);
            let slice = std::f64::consts::PI * weight / 2.0 * (z2 - z1);
            v += slice * r * r;
            first += slice * r * r * z;
            about_z += slice * r.powi(4) / 2.0;
            about_x += slice * (r.powi(4) / 4.0 + r * r * z * z);
        }
    }
    if v == 0.0 {
        return Mass::zero();
    }
    let sign = v.signum();
    let z = first / v;
    let across = sign * about_x - v.abs() * z * z;
    Mass {
        mass: v.abs(),
        center: Vec3([0.0, 0.0, z]),
        tensor: Mat3::diagonal(across, across, sign * about_z),
    }
}

/// Returns a regular polygon.
fn regular(sides: f64, radius: f64) -> Vec<[f64; 2]> {
    let corner = |k: usize| {
        let (s, c) = Scalar::sin_cos(std::f64::consts::TAU * k as f64 / sides);
        [radius * c, radius * s]
    };
    (0..sides as usize).map(corner).collect()
}

/// Returns the outline of a link of a length and a width: ends of ten chords each.
fn link_outline(length: f64, width: f64) -> Vec<[f64; 2]> {
    let end = |k: usize, from: f64, x: f64| {
        let angle = (from + 18.0 * k as f64) * super::units::DEGREE;
        let (s, c) = Scalar::sin_cos(angle);
        [x + width / 2.0 * c, width / 2.0 * s]
    };
    let first = (0..=10).map(|k| end(k, -90.0, length));
    first.chain((0..=10).map(|k| end(k, 90.0, 0.0))).collect()
}

/// Returns the outline of a polygon with a margin of a radius: its corners are arcs of that radius
/// about the corners, re-entrant ones fillets of it.
fn rounded(corners: &[[f64; 2]], radius: f64) -> Vec<[f64; 2]> {
    let mut corners = corners.to_vec();
    let n = corners.len();
    let twice: f64 = (0..n)
        .map(|k| {
            let (p, q) = (corners[k], corners[(k + 1) % n]);
            p[0] * q[1] - q[0] * p[1]
        })
        .sum();
    if twice < 0.0 {
        corners.reverse();
    }
    let outward = |k: usize| {
        let (p, q) = (corners[k % n], corners[(k + 1) % n]);
        let (x, y) = (q[0] - p[0], q[1] - p[1]);
        let length = (x * x + y * y).sqrt();
        [y / length, -x / length]
    };
    let mut all = Vec::new();
    for (k, corner) in corners.iter().enumerate() {
        let (a, b) = (outward(k + n - 1), outward(k));
        let cosine = a[0] * b[0] + a[1] * b[1];
        let turn = Scalar::atan2(a[0] * b[1] - a[1] * b[0], cosine);
        let begin = Scalar::atan2(a[1], a[0]);
        let (center, begin) = match turn < 0.0 {
            false => (*corner, begin),
            true => {
                let far = 2.0 * radius / (1.0 + cosine);
                let center = [
                    corner[0] + far * (a[0] + b[0]),
                    corner[1] + far * (a[1] + b[1]),
                ];
                (center, begin + std::f64::consts::PI)
            }
        };
        for step in 0..=CHORDS {
            let (s, c) = Scalar::sin_cos(begin + turn * f64::from(step) / f64::from(CHORDS));
            all.push([center[0] + radius * c, center[1] + radius * s]);
        }
    }
    all
}

/// Returns the frame of a link between two markers, and its length: x along the line to the other,
/// z as near to that of the first as it can be.
pub(super) fn bar(i: &Pose, j: &Pose) -> (Pose, f64) {
    let way = j.position - i.position;
    let length = way.norm();
    let x = match length > 0.0 {
        true => way,
        false => i.rotation.column(0),
    };
    let rotation = crate::space::rotation::from_z_and_x(
        i.rotation.column(2) - x.times(i.rotation.column(2).dot(x) / x.dot(x)),
        x,
    );
    let frame = Pose {
        rotation: rotation.unwrap_or(i.rotation),
        position: i.position,
    };
    (frame, length)
}

/// A reason why a mass is not known.
pub(super) type Unknown = String;

impl Database {
    /// Returns the mass that a part's shapes and its density give it, in the part's frame; `None`
    /// where it has none or they are not understood.
    pub fn mass_of(&self, part: usize) -> Option<Mass> {
        let density = self.density(part)?;
        let solid = self.solids(part).ok().flatten()?;
        Some(Mass {
            mass: solid.mass * density,
            center: solid.center,
            tensor: solid.tensor.times(density),
        })
    }

    /// Returns the density of a part: its own, that of its material, or of steel.
    pub fn density(&self, part: usize) -> Option<f64> {
        if let Some(density) = self.number(part, "density") {
            return Some(density);
        }
        let material = self.word(part, "material_type");
        let steel = || self.units.density(7801.0);
        let Some(name) = material else {
            return Some(steel());
        };
        if let Some(k) = self.find(&name) {
            return self.number(k, "density");
        }
        let last = name
            .rsplit('.')
            .next()
            .unwrap_or_default()
            .to_ascii_lowercase();
        match last.as_str() {
            "steel" => Some(steel()),
            "aluminum" => Some(self.units.density(2740.0)),
            "cast_iron" => Some(self.units.density(7080.0)),
            _ => None,
        }
    }

    /// Returns all solids of a part with density 1; `None` when it has none.
    ///
    /// # Errors
    /// A sentence that names the shape that is not understood.
    pub fn solids(&self, part: usize) -> Result<Option<Mass>, Unknown> {
        if let Some(file) = &self.solids_file {
            let begin = format!("{}.", self.objects[part].name).to_ascii_lowercase();
            let mut of_part = self.imported.range(begin.clone()..);
            if of_part.next().is_some_and(|name| name.starts_with(&begin)) {
                return Err(format!("its solids are in {file}"));
            }
        }
        let mut all: Option<Mass> = None;
        for k in self.of_kind("geometry shape") {
            if self.owner(k) != Some(part) {
                continue;
            }
            if let Some(solid) = self.solid(k, part)? {
                all = Some(all.map_or(solid, |all| all.with(solid)));
            }
        }
        Ok(all)
    }

    /// Returns a shape in the frame of its part with density 1; `None` for what has no volume.
    fn solid(&self, k: usize, part: usize) -> Result<Option<Mass>, Unknown> {
        let name = self.inner_name(k);
        let not = |why: &str| format!("{name}: {why}");
        let number = |argument: &str| {
            let value = self.number(k, argument);
            value.ok_or_else(|| not(&format!("{argument} is not known")))
        };
        let at = |argument: &str| -> Result<Pose, Unknown> {
            let marker = self.reference_of(k, argument);
            let marker = marker.ok_or_else(|| not(&format!("{argument} is not known")))?;
            let pose = self.pose(marker).map_err(|why| not(&why))?;
            let own = self.pose(part).map_err(|why| not(&why))?;
            Ok(own.inverse().compose(&pose))
        };
        let full = |unit: f64| {
            let extent = self
                .number(k, "angle_extent")
                .unwrap_or(360.0 * super::units::DEGREE / unit);
            (extent * unit - 360.0 * super::units::DEGREE).abs() < 1e-6
        };
        let shape = self.objects[k].kind.rsplit(' ').next().unwrap_or_default();
        if matches!(shape, "cylinder" | "frustum" | "torus" | "revolution")
            && !full(self.units.angle())
        {
            return Err(not("a part of a turn is not read"));
        }
        let solid = match shape {
            "block" => self.block(k)?.moved(&at("corner_marker")?),
            "ellipsoid" => {
                let axes = ["x_scale_factor", "y_scale_factor", "z_scale_factor"].map(number);
                let [a, b, c] = axes;
                ellipsoid(a?, b?, c?).moved(&at("center_marker")?)
            }
            "cylinder" => {
                let (length, radius) = (number("length")?, number("radius")?);
                let solid = match self.section(k) {
                    Section::Sides(sides) => prism(&regular(sides, radius), 0.0, length),
                    Section::Round | Section::MaybeRound(_) => {
                        revolved(&[[radius, 0.0], [radius, length]])
                    }
                };
                solid.moved(&at("center_marker")?)
            }
            "frustum" => {
                let ends = [
                    [number("bottom_radius")?, 0.0],
                    [number("top_radius")?, number("length")?],
                ];
                revolved(&ends).moved(&at("center_marker")?)
            }
            "torus" => {
                let (R, r) = (number("major_radius")?, number("minor_radius")?);
                torus(R, r).moved(&at("center_marker")?)
            }
            "link" => {
                let (frame, length) = bar(&at("i_marker")?, &at("j_marker")?);
                let half = number("depth")? / 2.0;
                prism(&link_outline(length, number("width")?), -half, half).moved(&frame)
            }
            "plate" => self.plate(k, part).map_err(|why| not(&why))?,
            "extrusion" => {
                let points = self.profile(k).map_err(|why| not(&why))?;
                let flat: Vec<[f64; 2]> = points.iter().map(|p| [p.0[0], p.0[1]]).collect();
                let bottom = points.first().map_or(0.0, |p| p.0[2]);
                let top = bottom + number("length_along_z_axis")?;
                prism(&flat, bottom, top).moved(&at("reference_marker")?)
            }
            "revolution" => {
                let points = self.profile(k).map_err(|why| not(&why))?;
                let around = |p: &Vec3<f64>| [(p.0[0] * p.0[0] + p.0[1] * p.0[1]).sqrt(), p.0[2]];
                let profile: Vec<[f64; 2]> = points.iter().map(around).collect();
                revolved(&profile).moved(&at("reference_marker")?)
            }
            "csg" | "solid" | "shell" | "solid_shell" | "face" if shape != "shell" => {
                return Err(not(&format!("the volume of a {shape} is not known")));
            }
            _ => return Ok(None),
        };
        Ok(Some(solid))
    }

    /// Returns the section of a cylinder.
    pub fn section(&self, k: usize) -> Section {
        match self.number(k, "side_count_for_body").unwrap_or(CIRCLE) {
            CIRCLE => Section::Round,
            n if (3.0..=MOST_SIDES_OF_A_PRISM).contains(&n) => Section::Sides(n.trunc()),
            n => Section::MaybeRound(n),
        }
    }

    /// Returns a block of density 1 in the frame of its corner.
    fn block(&self, k: usize) -> Result<Mass, Unknown> {
        let sides = self.numbers(k, "diag_corner_coords");
        let Some([a, b, c]) = sides.and_then(|s| <[f64; 3]>::try_from(s).ok()) else {
            return Err(format!("{}: three sides are not known", self.inner_name(k)));
        };
        let mass = (a * b * c).abs();
        let square = |x: f64, y: f64| mass * (x * x + y * y) / 12.0;
        Ok(Mass {
            mass,
            center: Vec3([a / 2.0, b / 2.0, c / 2.0]),
            tensor: Mat3::diagonal(square(b, c), square(a, c), square(a, b)),
        })
    }

    /// Returns a plate through markers, with rounded corners.
    fn plate(&self, k: usize, part: usize) -> Result<Mass, Unknown> {
        let own = self.pose(part)?;
        let mut corners = Vec::new();
        for marker in self.references_of(k, "marker_name") {
            corners.push(own.inverse().compose(&self.pose(marker)?));
        }
        let (Some(first), Some(width)) = (corners.first().copied(), self.number(k, "width")) else {
            return Err("markers or width are not known".into());
        };
        if corners.len() < 3 {
            return Err("a plate has three markers or more".into());
        }
        // its plane is that of the markers, whatever their axes are
        let sides = (0..corners.len()).map(|k| {
            let next = corners[(k + 1) % corners.len()].position;
            (corners[k].position - first.position).cross(next - first.position)
        });
        let normal = sides.fold(Vec3::zero(), |sum, side| sum + side);
        let along = corners[1].position - first.position;
        let rotation = crate::space::rotation::from_z_and_x(normal, along);
        let rotation = rotation.ok_or("its markers lie on a line")?;
        let frame = Pose {
            rotation,
            position: first.position,
        };
        let local = frame.inverse();
        let flat = corners.iter().map(|c| local.point(c.position));
        let flat: Vec<[f64; 2]> = flat.map(|p| [p.0[0], p.0[1]]).collect();
        let outline = match self.number(k, "radius").filter(|r| *r > 0.0) {
            Some(radius) => rounded(&flat, radius),
            None => flat,
        };
        // the markers lie in its middle
        Ok(prism(&outline, -width / 2.0, width / 2.0).moved(&frame))
    }

    fn profile(&self, k: usize) -> Result<Vec<Vec3<f64>>, Unknown> {
        let numbers = self.numbers(k, "points_for_profile");
        let numbers = numbers.ok_or("its profile is a curve, which is not read")?;
        let points = numbers.chunks_exact(3).map(|p| Vec3([p[0], p[1], p[2]]));
        Ok(points.collect())
    }
}

/// Returns an ellipsoid of density 1, by the lengths of its axes.
fn ellipsoid(a: f64, b: f64, c: f64) -> Mass {
    let mass = std::f64::consts::PI * (a * b * c).abs() / 6.0;
    let square = |x: f64, y: f64| mass * (x * x + y * y) / 20.0;
    Mass {
        mass,
        center: Vec3::zero(),
        tensor: Mat3::diagonal(square(b, c), square(a, c), square(a, b)),
    }
}

fn torus(R: f64, r: f64) -> Mass {
    let mass = 2.0 * std::f64::consts::PI.powi(2) * R * r * r;
    let across = mass * (R * R / 2.0 + 0.625 * r * r);
    Mass {
        mass,
        center: Vec3::zero(),
        tensor: Mat3::diagonal(across, across, mass * (R * R + 0.75 * r * r)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-12 * b.abs().max(1e-300)
    }

    #[test]
    fn prisms_and_turned_profiles_have_their_closed_forms() {
        let block = prism(&[[0.0, 0.0], [2.0, 0.0], [2.0, 3.0], [0.0, 3.0]], 0.0, -5.0);
        assert!(near(block.mass, 30.0) && near(block.tensor.0[0][0], 30.0 * (9.0 + 25.0) / 12.0));
        assert_eq!(block.center.0, [1.0, 1.5, -2.5]);
        let cylinder = revolved(&[[2.0, 0.0], [2.0, -3.0]]);
        let mass = std::f64::consts::PI * 12.0;
        assert!(near(cylinder.mass, mass) && near(cylinder.tensor.0[2][2], mass * 2.0));
        assert!(near(
            cylinder.tensor.0[0][0],
            mass * (3.0 * 4.0 + 9.0) / 12.0
        ));
        let cone = revolved(&[[0.0, 0.0], [1.0, 4.0]]);
        assert!(near(cone.center.0[2], 3.0) && near(cone.tensor.0[2][2], cone.mass * 0.3));
        let square = prism(&regular(4.0, 2.0), 0.0, 3.0);
        assert!(near(square.mass, 24.0) && near(square.tensor.0[2][2], 24.0 * 4.0 / 3.0));
        let link = prism(&link_outline(10.0, 4.0), -0.5, 0.5);
        assert!((link.mass - (40.0 + 3.090_169_943_749_474 * 4.0)).abs() < 1e-12);
    }

    #[test]
    fn parts_of_a_solid_make_the_whole() {
        let sides = |x: f64| [[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]];
        let halves = prism(&sides(0.0), 0.0, 1.0).with(prism(&sides(1.0), 0.0, 1.0));
        let whole = prism(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], 0.0, 1.0);
        for k in 0..3 {
            assert!(near(halves.tensor.0[k][k], whole.tensor.0[k][k]));
            assert!(near(halves.center.0[k], whole.center.0[k]));
        }
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let mut back = square;
        back.reverse();
        for corners in [square, back] {
            let plate = prism(&rounded(&corners, 0.5), 0.0, 1.0);
            let exact = 1.0 + 2.0 + std::f64::consts::PI / 4.0;
            assert!((plate.mass - exact).abs() < 1e-6, "{}", plate.mass);
        }
    }
}
