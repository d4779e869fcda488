//! Where parts, markers and points stand: locations and orientations by the frames in which they
//! were given.
//!
//! ```text
//! X_GM = X_GF · X_FM        F: `relative_to`, else the default coordinate system, else the part
//! ```
//!
//! Three numbers of `orientation` are angles of the file's sequence; an expression that gives all
//! three, `({0, 90, 0})` or a function, gives those of body 3-1-3.

use super::database::{Attribute, Coordinates, Database, Datum, Pose, Reference, Sequence};
use super::evaluate::Trouble;
use crate::diagnostic::counted;
use crate::scalar::Scalar;
use crate::space::{Mat3, Vec3, rotation};

/// The frame in which locations are read: that of an argument, or that of an object's own numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Reading {
    /// whose argument is read
    pub object: Option<usize>,
    pub frame: Reference,
}

impl Reading {
    /// Returns the frame of an object's own numbers.
    pub fn of(object: usize) -> Self {
        Self {
            object: Some(object),
            frame: Reference::Own,
        }
    }
}

/// Returns the rotation by three angles about axes of a sequence.
pub(super) fn turned(sequence: Sequence, angles: [f64; 3]) -> Mat3<f64> {
    let [a, b, c] = [0, 1, 2].map(|k| rotation::about_axis(sequence.axes[k], angles[k]));
    match sequence.is_body {
        true => a * b * c,
        false => c * b * a,
    }
}

/// Returns numbers without what rounding has left of a zero beside larger ones.
pub(super) fn cleaned(all: [f64; 3], size: f64) -> [f64; 3] {
    all.map(|x| {
        if x.abs() <= 16.0 * f64::EPSILON * size {
            0.0
        } else {
            x
        }
    })
}

fn three(all: &[f64], what: &str) -> Result<[f64; 3], Trouble> {
    <[f64; 3]>::try_from(all)
        .map_err(|_| format!("{what} has {}, not 3", counted(all.len(), "number")))
}

impl Database {
    /// Returns where an object stands in ground: a part, a marker, a point.
    pub fn pose(&self, k: usize) -> Result<Pose, Trouble> {
        if let Some(known) = self.poses.borrow().get(&k) {
            let again = || format!("{} stands where it stands itself", self.objects[k].name);
            return known.ok_or_else(again);
        }
        self.poses.borrow_mut().insert(k, None);
        let pose = self.posed(k);
        match &pose {
            Ok(pose) => self.poses.borrow_mut().insert(k, Some(*pose)),
            Err(_) => self.poses.borrow_mut().remove(&k),
        };
        pose
    }

    fn posed(&self, k: usize) -> Result<Pose, Trouble> {
        let object = &self.objects[k];
        if object.is_ground || object.kind == "model" {
            return Ok(Pose::identity());
        }
        let holds = ["part", "marker", "point", "ude instance"];
        if !holds.iter().any(|kind| object.kind.starts_with(kind)) {
            return self.owner_pose(k);
        }
        let p = match object.attributes.get("location") {
            Some(attribute) => self.location(k, attribute)?,
            None => self.owner_pose(k)?.position,
        };
        let rotation = self.orientation(k, p)?;
        let position = p;
        Ok(Pose { rotation, position })
    }

    /// Returns the orientation that an object's arguments give it.
    fn orientation(&self, k: usize, p: Vec3<f64>) -> Result<Mat3<f64>, Trouble> {
        let given = &self.objects[k].attributes;
        if let Some(attribute) = given.get("orientation") {
            let frame = self.reference(k, self.frame_of(attribute))?;
            return Ok(frame.rotation * self.rotation(k, attribute)?);
        }
        if let Some(attribute) = given.get("along_axis_orientation") {
            let points = self.points(k, attribute)?;
            let z = match points[..] {
                [only] => only - p,
                [from, to] => to - from,
                _ => return Err("along_axis_orientation takes one or two points".into()),
            };
            return super::functions::along(z, 2).ok_or_else(|| "the points coincide".into());
        }
        if let Some(attribute) = given.get("in_plane_orientation") {
            let points = self.points(k, attribute)?;
            let [first, second] = points[..] else {
                return Err("in_plane_orientation takes two points".into());
            };
            // z towards the first point, x in the plane towards the second
            let turned = rotation::from_z_and_x(first - p, second - p);
            return turned.ok_or_else(|| "the points lie on a line".into());
        }
        match given.get("location") {
            Some(location) => Ok(self.reference(k, self.frame_of(location))?.rotation),
            None => Ok(self.owner_pose(k)?.rotation),
        }
    }

    /// Returns points of an argument in ground.
    fn points(&self, k: usize, attribute: &Attribute) -> Result<Vec<Vec3<f64>>, Trouble> {
        let within = self.reading(k, attribute);
        let numbers = self.as_numbers(&Datum::List(self.values(attribute, &within)?))?;
        let frame = self.reference(k, self.frame_of(attribute))?;
        let each = numbers.chunks_exact(3);
        Ok(each
            .map(|p| frame.point(Vec3([p[0], p[1], p[2]])))
            .collect())
    }

    /// Returns the frame in which an argument is read.
    pub fn reading(&self, k: usize, attribute: &Attribute) -> Reading {
        Reading {
            object: Some(k),
            frame: self.frame_of(attribute).clone(),
        }
    }

    fn location(&self, k: usize, attribute: &Attribute) -> Result<Vec3<f64>, Trouble> {
        let within = self.reading(k, attribute);
        let values = self.values(attribute, &within)?;
        if let [Datum::Object(other)] = values[..]
            && self.objects[other].kind != super::VARIABLE
        {
            return Ok(self.pose(other)?.position);
        }
        let numbers = three(&self.as_numbers(&Datum::List(values))?, "location")?;
        let is_whole = match self.counted(attribute) {
            Some(fixed) => fixed.is_whole,
            None => attribute.is_whole(),
        };
        let numbers = match is_whole {
            true => numbers,
            false => self.cartesian(numbers),
        };
        Ok(self
            .reference(k, self.frame_of(attribute))?
            .point(Vec3(numbers)))
    }

    /// Returns three numbers of a location as x, y, z.
    fn cartesian(&self, [r, angle, third]: [f64; 3]) -> [f64; 3] {
        let (s, c) = Scalar::sin_cos(angle * self.units.angle());
        match self.coordinates {
            Coordinates::Cartesian => [r, angle, third],
            Coordinates::Cylindrical => [r * c, r * s, third],
            Coordinates::Spherical => {
                let (across, along) = Scalar::sin_cos(third * self.units.angle());
                [r * across * c, r * across * s, r * along]
            }
        }
    }

    /// Returns the rotation that three angles, or an expression, give.
    pub fn rotation(&self, k: usize, attribute: &Attribute) -> Result<Mat3<f64>, Trouble> {
        let within = self.reading(k, attribute);
        let values = self.values(attribute, &within)?;
        let numbers = three(&self.as_numbers(&Datum::List(values))?, "orientation")?;
        let angles = numbers.map(|x| x * self.units.angle());
        let is_whole = match self.counted(attribute) {
            Some(fixed) => fixed.is_whole,
            None => attribute.is_whole(),
        };
        let sequence = match is_whole {
            true => Sequence::default(),
            false => self.sequence,
        };
        Ok(turned(sequence, angles))
    }

    /// Returns the frame of numbers of an object.
    pub fn reference(&self, k: usize, frame: &Reference) -> Result<Pose, Trouble> {
        match frame {
            Reference::Own => self.owner_pose(k),
            Reference::Of(name) => {
                let found = self.find(name);
                let found = found.or_else(|| self.in_part_of(k, name));
                let other = found.ok_or_else(|| format!("there is no `{name}`"))?;
                if other == k {
                    return self.owner_pose(k);
                }
                self.pose(other)
            }
        }
    }

    /// Returns a marker by its name in the part of another.
    fn in_part_of(&self, k: usize, name: &str) -> Option<usize> {
        let part = Self::parent(&self.objects[k].name)?;
        self.find(&format!("{part}.{name}"))
    }

    /// Returns the frame of the part that holds an object; ground for parts.
    pub fn owner_pose(&self, k: usize) -> Result<Pose, Trouble> {
        let held = !self.objects[k].kind.starts_with("part");
        match self.owner(k).filter(|_| held) {
            Some(owner) if owner != k => self.pose(owner),
            _ => Ok(Pose::identity()),
        }
    }

    /// Returns the frame in which expressions of locations give them.
    pub fn reading_pose(&self, within: &Reading) -> Result<Pose, Trouble> {
        match within.object {
            Some(k) => self.reference(k, &within.frame),
            None => Ok(Pose::identity()),
        }
    }

    /// Returns the location of an object in the part that holds it, or in ground.
    pub fn location_of(&self, k: usize) -> Result<[f64; 3], Trouble> {
        Ok(self.pose(k)?.position.0)
    }

    /// Returns the body 3-1-3 angles of an object in ground, in the file's unit.
    pub fn angles_of(&self, k: usize) -> Result<[f64; 3], Trouble> {
        let angles = rotation::to_313(&self.pose(k)?.rotation);
        Ok(angles.map(|x| x / self.units.angle()))
    }
}
