//! Functions of expressions: numbers, texts, and the LOC_ and ORI_ functions of places.
//!
//! Locations and orientations come out in the frame in which the argument that asks is read.

use super::database::{Database, Datum, Pose};
use super::evaluate::Trouble;
use super::frames::{Reading, cleaned, turned};
use super::term::Term;
use crate::diagnostic::counted;
use crate::scalar::Scalar;
use crate::space::rotation::to_313;
use crate::space::{Mat3, Vec3};

/// Returns the axis of a letter.
fn axis(letter: char) -> Option<usize> {
    "xyz".find(letter.to_ascii_lowercase())
}

/// Returns the two axes of `zx`, `z_zx` or `xy`, and whether the second is taken against the other.
fn pair(text: &str) -> Option<(usize, usize, bool)> {
    let text = text.trim();
    let text = text.rsplit('_').next().unwrap_or(text);
    let mut letters = text.chars();
    let first = axis(letters.next()?)?;
    let next = letters.next()?;
    let against = next == '-';
    let second = if against { letters.next()? } else { next };
    Some((first, axis(second)?, against))
}

/// Returns the frame with an axis along a direction. The free turn: the axis before it (of x and z
/// y, of y z) is the projection of that axis of ground.
pub(super) fn along(direction: Vec3<f64>, k: usize) -> Option<Mat3<f64>> {
    let length = direction.norm();
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let main = direction.times(1.0 / length);
    let second = if k == 1 { 2 } else { 1 };
    let up = Vec3::axis(second);
    let across = up - main.times(up.dot(main));
    let across = match across.norm() > 1e-9 {
        true => across.times(1.0 / across.norm()),
        // along that axis itself: z along y is (0, 90, 0), so that y is -z
        false => {
            let spare =
                Vec3::axis(3 - k - second).times(0.0) + Vec3::axis(if k == 2 { 2 } else { k });
            let spare = spare - main.times(spare.dot(main));
            let sign = -main.0[second].signum();
            spare.times(sign / spare.norm())
        }
    };
    Some(with_axes(k, main, second, across))
}

/// Returns the right-handed frame with two given axes.
fn with_axes(k: usize, first: Vec3<f64>, l: usize, second: Vec3<f64>) -> Mat3<f64> {
    let third = match (k + 1) % 3 == l {
        true => first.cross(second),
        false => second.cross(first),
    };
    let mut columns = [third; 3];
    columns[k] = first;
    columns[l] = second;
    let [x, y, z] = columns;
    Mat3::from_columns(x, y, z)
}

/// Returns the frame with axis `k` from `p` to `q` and axis `l` in the plane towards `r`.
fn in_plane(p: Vec3<f64>, q: Vec3<f64>, r: Vec3<f64>, k: usize, l: usize) -> Option<Mat3<f64>> {
    let first = q - p;
    let first = first.times(1.0 / first.norm());
    let second = r - p;
    let second = second - first.times(second.dot(first));
    let length = second.norm();
    (k != l && length > 0.0 && length.is_finite())
        .then(|| with_axes(k, first, l, second.times(1.0 / length)))
}

/// Returns a frame with axis `a` along axis `b` of another, in the axes of that.
fn aligned(a: usize, b: usize, against: bool) -> Mat3<f64> {
    let e = Vec3::<f64>::axis;
    let mut columns = [0, 1, 2].map(e);
    match (a == b, against) {
        (true, false) => {}
        (false, false) => columns = [0, 1, 2].map(|k| e((k + b + 3 - a) % 3)),
        (true, true) => {
            let (i, j) = ((a + 1) % 3, (a + 2) % 3);
            columns[a] = -e(a);
            columns.swap(i, j);
        }
        (false, true) => {
            let third = 3 - a - b;
            columns[a] = -e(b);
            // of a right-handed frame with the third axis where it is
            columns[b] = match (third + 1) % 3 == a {
                true => e(third).cross(-e(b)),
                false => (-e(b)).cross(e(third)),
            };
        }
    }
    let [x, y, z] = columns;
    Mat3::from_columns(x, y, z)
}

/// Says why points give no direction.
fn no_way() -> Trouble {
    "the points coincide or lie on a line".into()
}

fn unknown(name: &str) -> Trouble {
    format!("the function {} is not known here", name.to_uppercase())
}

impl Database {
    /// Returns the value of a function.
    pub fn call(&self, name: &str, terms: &[Term], within: &Reading) -> Result<Datum, Trouble> {
        if name.starts_with("loc_") {
            return self.location_function(name, terms, within);
        }
        if name.starts_with("ori_") {
            return self.orientation_function(name, terms, within);
        }
        match name {
            "eval" if terms.len() == 1 => return self.evaluate(&terms[0], within),
            "db_exists" => {
                let text = self.text_of(terms, 0, within)?;
                return Ok(Datum::Number(f64::from(u8::from(
                    self.find(&text).is_some(),
                ))));
            }
            "stoo" => {
                let text = self.text_of(terms, 0, within)?;
                let found = self.find(&text).map(Datum::Object);
                return found.ok_or_else(|| format!("there is no `{text}`"));
            }
            "rtoi" | "itos" | "rtos" | "ston" | "stoi" | "stor" => {
                return self.converted(name, terms, within);
            }
            "unique_name" => return Ok(Datum::Text(self.text_of(terms, 0, within)?)),
            "getenv" => return Ok(Datum::Text(String::new())),
            "dx" | "dy" | "dz" | "dm" => return self.displacement(name, terms, within),
            _ => {}
        }
        let arguments = terms.iter().map(|term| self.evaluate(term, within));
        let arguments = arguments.collect::<Result<Vec<_>, _>>()?;
        let lists = arguments.iter().map(|one| self.as_numbers(one));
        let numbers = lists.collect::<Result<Vec<_>, _>>()?.concat();
        self.number_function(name, &numbers).map(Datum::Number)
    }

    fn converted(&self, name: &str, terms: &[Term], within: &Reading) -> Result<Datum, Trouble> {
        let value = self.evaluate(self.term(terms, 0)?, within)?;
        if matches!(name, "ston" | "stoi" | "stor") {
            let text = self.as_text(&value)?;
            let number = text.trim().parse::<f64>();
            return number
                .map(Datum::Number)
                .map_err(|_| format!("`{text}` is no number"));
        }
        let x = self.as_number(&value)?;
        Ok(Datum::Text(match name {
            "rtos" => x.to_string(),
            _ => format!("{}", x.round()),
        }))
    }

    fn number_function(&self, name: &str, all: &[f64]) -> Result<f64, Trouble> {
        let angle = self.units.angle();
        let needs = |n: usize| {
            let is = all.len() == n;
            is.then_some(())
                .ok_or_else(|| format!("{name} takes {}, not {}", counted(n, "number"), all.len()))
        };
        let value = match name {
            "min" => all.iter().copied().fold(f64::INFINITY, f64::min),
            "max" => all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            "sum" => all.iter().sum(),
            "ssq" => all.iter().map(|x| x * x).sum(),
            "mean" => all.iter().sum::<f64>() / all.len() as f64,
            "atan2" | "mod" | "rmod" | "dim" | "sign" => {
                needs(2)?;
                let (x, y) = (all[0], all[1]);
                match name {
                    "atan2" => Scalar::atan2(x, y) / angle,
                    "dim" => (x - y).max(0.0),
                    "sign" => x.abs().copysign(y),
                    _ => x % y,
                }
            }
            _ => {
                needs(1)?;
                let x = all[0];
                match name {
                    "sin" => Scalar::sin(x * angle),
                    "cos" => Scalar::cos(x * angle),
                    "tan" => Scalar::tan(x * angle),
                    "asin" => Scalar::asin(x) / angle,
                    "acos" => Scalar::acos(x) / angle,
                    "atan" => Scalar::atan(x) / angle,
                    "sqrt" => x.sqrt(),
                    "abs" => x.abs(),
                    "exp" => Scalar::exp(x),
                    "log" => Scalar::ln(x),
                    "log10" => Scalar::log10(x),
                    "sinh" => Scalar::sinh(x),
                    "cosh" => Scalar::cosh(x),
                    "tanh" => Scalar::tanh(x),
                    "int" | "aint" => x.trunc(),
                    "nint" | "anint" => x.round(),
                    "floor" => x.floor(),
                    "ceil" => x.ceil(),
                    "real" | "dble" | "norm" => x,
                    _ => return Err(unknown(name)),
                }
            }
        };
        match value.is_finite() {
            true => Ok(value),
            false => Err(format!("{} has no value at {all:?}", name.to_uppercase())),
        }
    }

    fn term<'a>(&self, terms: &'a [Term], k: usize) -> Result<&'a Term, Trouble> {
        terms
            .get(k)
            .ok_or_else(|| "an argument of the function is missing".into())
    }

    fn text_of(&self, terms: &[Term], k: usize, within: &Reading) -> Result<String, Trouble> {
        match self.term(terms, k)? {
            Term::Name(name) if self.find(name).is_none() => Ok(name.clone()),
            term => self.as_text(&self.evaluate(term, within)?),
        }
    }

    /// Returns the pose of an object that an argument names, by itself or as a text.
    fn frame_argument(&self, terms: &[Term], k: usize, within: &Reading) -> Result<Pose, Trouble> {
        let term = self.term(terms, k)?;
        let value = self.evaluate(term, within)?;
        let object = match value {
            Datum::Object(k) => match self.variable(k)? {
                Datum::Object(k) => k,
                other => return Err(format!("`{}` is no frame", self.as_text(&other)?)),
            },
            Datum::Text(text) => match self.find(&text) {
                Some(k) => k,
                None => return Err(format!("there is no `{text}`")),
            },
            Datum::Number(0.0) => return Ok(Pose::identity()),
            other => return Err(format!("`{}` is no frame", self.as_text(&other)?)),
        };
        self.pose(object)
    }

    fn displacement(&self, name: &str, terms: &[Term], within: &Reading) -> Result<Datum, Trouble> {
        let to = self.frame_argument(terms, 0, within)?;
        let from = match terms.len() {
            1 => Pose::identity(),
            _ => self.frame_argument(terms, 1, within)?,
        };
        let along = match terms.len() {
            3 => self.frame_argument(terms, 2, within)?,
            _ => Pose::identity(),
        };
        let way = along.rotation.apply_transposed(to.position - from.position);
        Ok(Datum::Number(match name {
            "dx" => way.0[0],
            "dy" => way.0[1],
            "dz" => way.0[2],
            _ => way.norm(),
        }))
    }

    /// Returns the point that an argument is.
    fn point(&self, terms: &[Term], k: usize, within: &Reading) -> Result<Vec3<f64>, Trouble> {
        let numbers = self.as_numbers(&self.evaluate(self.term(terms, k)?, within)?)?;
        let three = <[f64; 3]>::try_from(numbers);
        three
            .map(Vec3)
            .map_err(|all| format!("a location has 3 numbers, not {}", all.len()))
    }

    /// Returns the axis that an argument names.
    fn axis_argument(&self, terms: &[Term], k: usize, within: &Reading) -> Result<usize, Trouble> {
        let text = self.text_of(terms, k, within)?;
        let found = text.chars().next().and_then(axis);
        found.ok_or_else(|| format!("`{text}` is no axis"))
    }

    /// Returns the two axes that an argument names.
    fn axes(
        &self,
        terms: &[Term],
        k: usize,
        within: &Reading,
    ) -> Result<(usize, usize, bool), Trouble> {
        let text = self.text_of(terms, k, within)?;
        pair(&text).ok_or_else(|| format!("`{text}` names no two axes"))
    }

    /// Returns a location.
    fn location_function(
        &self,
        name: &str,
        terms: &[Term],
        within: &Reading,
    ) -> Result<Datum, Trouble> {
        let frame = |k| self.frame_argument(terms, k, within);
        let point = |k| self.point(terms, k, within);
        let number = |k: usize| self.as_number(&self.evaluate(self.term(terms, k)?, within)?);
        let own = self.reading_pose(within)?;
        let here = |p: Vec3<f64>| {
            let q = own.rotation.apply_transposed(p - own.position);
            Datum::from(cleaned(q.0, p.norm().max(own.position.norm())))
        };
        Ok(match name {
            "loc_relative_to" => here(frame(1)?.point(point(0)?)),
            "loc_global" => frame(1)?.point(point(0)?).0.into(),
            "loc_local" => {
                let local = frame(1)?.inverse();
                local.point(point(0)?).0.into()
            }
            "loc_loc" => frame(2)?
                .inverse()
                .point(frame(1)?.point(point(0)?))
                .0
                .into(),
            "loc_along_line" => {
                let (from, to) = (frame(0)?.position, frame(1)?.position);
                let way = to - from;
                match way.norm() > 0.0 {
                    true => here(from + way.times(number(2)? / way.norm())),
                    false => return Err(no_way()),
                }
            }
            "loc_on_axis" => {
                let (at, k) = (frame(0)?, self.axis_argument(terms, 2, within)?);
                here(at.position + at.rotation.column(k).times(number(1)?))
            }
            "loc_mirror" => {
                let mirror = frame(1)?;
                let (a, b, _) = self.axes(terms, 2, within)?;
                let k = 3 - (a + b).min(3);
                let mut local = mirror.inverse().point(own.point(point(0)?));
                local.0[k.min(2)] *= -1.0;
                here(mirror.point(local))
            }
            "loc_cylindrical" => {
                let Vec3([r, angle, z]) = point(0)?;
                let (s, c) = Scalar::sin_cos(angle * self.units.angle());
                [r * c, r * s, z].into()
            }
            _ => return Err(unknown(name)),
        })
    }

    /// Returns the angles of an orientation.
    fn orientation_function(
        &self,
        name: &str,
        terms: &[Term],
        within: &Reading,
    ) -> Result<Datum, Trouble> {
        let frame = |k| self.frame_argument(terms, k, within);
        let point = |k| self.point(terms, k, within);
        let axes = |k| self.axes(terms, k, within);
        let own = self.reading_pose(within)?;
        let turned_here = |R: Mat3<f64>| {
            let angles = to_313(&(own.rotation.transpose() * R));
            Datum::from(cleaned(angles, 1.0).map(|x| x / self.units.angle()))
        };
        Ok(match name {
            "ori_relative_to" => {
                let angles = point(0)?.0.map(|x| x * self.units.angle());
                turned_here(
                    frame(1)?.rotation * turned(super::database::Sequence::default(), angles),
                )
            }
            "ori_global" => {
                let angles = point(0)?.0.map(|x| x * self.units.angle());
                let R = frame(1)?.rotation * turned(super::database::Sequence::default(), angles);
                Datum::from(to_313(&R).map(|x| x / self.units.angle()))
            }
            "ori_align_axis" => {
                let (a, b, against) = axes(1)?;
                turned_here(frame(0)?.rotation * aligned(a, b, against))
            }
            "ori_along_axis" | "ori_one_axis" => {
                let (from, to) = (frame(0)?.position, frame(1)?.position);
                let k = self.axis_argument(terms, 2, within)?;
                turned_here(along(to - from, k).ok_or_else(no_way)?)
            }
            "ori_in_plane" => {
                let (k, l, _) = axes(3)?;
                let at = [frame(0)?, frame(1)?, frame(2)?].map(|f| f.position);
                turned_here(in_plane(at[0], at[1], at[2], k, l).ok_or_else(no_way)?)
            }
            "ori_all_axes" => {
                let numbers = self.as_numbers(&self.evaluate(self.term(terms, 0)?, within)?)?;
                let [a, b, c, d, e, f, g, h, i] = numbers[..] else {
                    return Err("ORI_ALL_AXES takes three points".into());
                };
                let (k, l, _) = axes(1)?;
                let R = in_plane(Vec3([a, b, c]), Vec3([d, e, f]), Vec3([g, h, i]), k, l);
                // points of ground; nested in ORI_RELATIVE_TO, the angles are those in ground
                let angles = to_313(&R.ok_or_else(no_way)?);
                Datum::from(angles.map(|x| x / self.units.angle()))
            }
            _ => return Err(unknown(name)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn degrees(R: Mat3<f64>) -> [i32; 3] {
        to_313(&R).map(|x| (x.to_degrees().round() as i32).rem_euclid(360))
    }

    #[test]
    fn an_axis_lies_along_another_and_the_frame_is_right_handed() {
        for a in 0..3 {
            for b in 0..3 {
                for against in [false, true] {
                    let R = aligned(a, b, against);
                    let sign = if against { -1.0 } else { 1.0 };
                    assert_eq!(R.column(a).0, Vec3::<f64>::axis(b).times(sign).0);
                    let volume = R.column(0).cross(R.column(1)).dot(R.column(2));
                    assert_eq!(volume, 1.0, "{a} {b} {against}");
                }
            }
        }
        assert_eq!(degrees(aligned(2, 2, true)), [90, 180, 0]);
        assert_eq!(pair("z-y"), Some((2, 1, true)));
        assert_eq!(pair("z_zy"), Some((2, 1, false)));
    }

    #[test]
    fn an_axis_along_a_direction_keeps_another_upright() {
        let R = along(Vec3([0.0, 1.0, 0.0]), 2).unwrap();
        assert_eq!(
            (R.column(0).0, R.column(1).0),
            ([1.0, 0.0, 0.0], [0.0, 0.0, -1.0])
        );
        let R = along(Vec3([0.0, -1.0, 0.0]), 2).unwrap();
        assert_eq!(degrees(R), [0, 90, 0]);
        let R = along(Vec3([3.0, 4.0, 5.0]), 2).unwrap();
        assert!(R.column(1).0[1] > 0.0 && R.column(0).0[1].abs() < 1e-15);
        assert!(along(Vec3([0.0; 3]), 2).is_none());
    }
}
