//! Functions of the user's: over time, as an expression in degrees, in the language of direct
//! entry, or as a cubic spline through points.
//!
//! A cubic spline with any end conditions is the natural one of a dataset (SPLINE, CUBSPL) and a
//! cubic: with M the curvatures of the wanted spline at its ends a and b,
//!
//! ```text
//! s(t) = CUBSPL(t) + p(t),   p = M_a (t−a)²/2 + (M_b − M_a) (t−a)³/(6 (b−a)),   CUBSPL through yᵢ − p(tᵢ)
//! ```
//!
//! for s − p has no curvature at its ends.

use super::Named;
use crate::diagnostic::{Diagnostic, Span, counted};
use crate::disk;
use crate::encoding::as_utf8;
use crate::expr::Expr;
use crate::expr::ast::Dialect;
use crate::expr::program::Input;
use crate::expr::spline::{Ends, Extrapolation, Piecewise};
use crate::results::Units;
use crate::scalar::Table;
use std::path::Path;

/// A function of the user's.
#[derive(Clone, Debug)]
pub struct UserFunction {
    /// its name
    pub name: Named,
    /// how it is given
    pub shape: Shape,
    /// the quantity that it yields
    pub ordinate: Ordinate,
}

/// The form in which a function is given.
#[derive(Clone, Debug)]
pub enum Shape {
    /// an expression function: of `t`, angles in degrees
    Expression(Named),
    /// in the language of direct entry: angles in radians
    Direct(Named),
    /// a cubic spline through points
    Points {
        /// time and value, by increasing time
        points: Vec<[f64; 2]>,
        /// end conditions
        ends: Ends,
        /// where the points stand in the file
        span: Span,
    },
}

/// The quantity that a function yields. Angles of expressions and points are in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ordinate {
    /// not said
    #[default]
    Unsaid,
    /// a length
    Position,
    /// an angle
    Angle,
    /// length over time
    Velocity,
    /// angle over time
    AngularVelocity,
    /// length over squared time
    Acceleration,
    /// angle over squared time
    AngularAcceleration,
    /// a force
    Force,
    /// a torque
    Torque,
}

impl Ordinate {
    /// All quantities that can be said.
    const ALL: [Self; 8] = [
        Self::Position,
        Self::Angle,
        Self::Velocity,
        Self::AngularVelocity,
        Self::Acceleration,
        Self::AngularAcceleration,
        Self::Force,
        Self::Torque,
    ];

    /// Returns the words of all quantities that can be said.
    pub fn words() -> [&'static str; 8] {
        Self::ALL.map(Self::word)
    }

    /// Returns its word in the file.
    pub fn word(self) -> &'static str {
        match self {
            Self::Unsaid => "",
            Self::Position => "position",
            Self::Angle => "angle",
            Self::Velocity => "velocity",
            Self::AngularVelocity => "angular velocity",
            Self::Acceleration => "acceleration",
            Self::AngularAcceleration => "angular acceleration",
            Self::Force => "force",
            Self::Torque => "torque",
        }
    }

    /// Returns the quantity of a word.
    ///
    /// # Errors
    /// The words that there are.
    pub fn of(word: &str) -> Result<Self, String> {
        let mut all = Self::ALL.into_iter();
        let found = all.find(|o| o.word().eq_ignore_ascii_case(word.trim()));
        found.ok_or_else(|| {
            let words = Self::ALL.map(Self::word).join(", ");
            format!("`{word}` is no ordinate: {words}")
        })
    }

    /// Returns its unit; `degrees`: angles are in degrees.
    fn unit(self, units: &Units, degrees: bool) -> String {
        let angle = if degrees { "deg" } else { units.angle.as_str() };
        let (length, time, force) = (&units.length, &units.time, &units.force);
        match self {
            Self::Unsaid => String::new(),
            Self::Position => length.clone(),
            Self::Angle => angle.to_owned(),
            Self::Velocity => format!("{length}/{time}"),
            Self::AngularVelocity => format!("{angle}/{time}"),
            Self::Acceleration => format!("{length}/{time}**2"),
            Self::AngularAcceleration => format!("{angle}/{time}**2"),
            Self::Force => force.clone(),
            Self::Torque => format!("{force}-{length}"),
        }
    }
}

impl UserFunction {
    /// Returns whether its angles are in degrees: of all functions but those of direct entry.
    pub fn is_in_degrees(&self) -> bool {
        !matches!(self.shape, Shape::Direct(_))
    }

    /// Returns the unit of its values.
    pub fn unit(&self, units: &Units) -> String {
        self.ordinate.unit(units, self.is_in_degrees())
    }

    /// Returns how it is given, in a few words.
    pub fn described(&self) -> String {
        match &self.shape {
            Shape::Expression(text) => format!("expression {}", text.text),
            Shape::Direct(text) => format!("direct entry {}", text.text),
            Shape::Points { points, .. } => {
                format!("spline through {}", counted(points.len(), "point"))
            }
        }
    }

    /// Returns its values at times; `None` where it reads more than time.
    ///
    /// # Errors
    /// A mistake in it, or a time at which it has no value.
    pub fn values(&self, times: &[f64]) -> Result<Option<Vec<f64>>, Diagnostic> {
        let expr = match &self.shape {
            Shape::Points { points, ends, .. } => {
                let fitted = Fitted::through(points, *ends)?;
                let curve = fitted.natural()?;
                let value = |&t: &f64| curve.at(t, 0) + fitted.cubic_at(t);
                return Ok(Some(times.iter().map(value).collect()));
            }
            Shape::Expression(text) => Expr::parse_dialect(&text.text, Dialect::Expression),
            Shape::Direct(text) => Expr::parse(&text.text),
        };
        let expr = expr.map_err(|e| e.into_first())?;
        if expr.inputs().iter().any(|input| *input != Input::Time) {
            return Ok(None);
        }
        let value = |&t: &f64| {
            let value = expr.eval_with(&|input| (input == Input::Time).then_some(t));
            value.map_err(|e| e.into_first())
        };
        times.iter().map(value).collect::<Result<_, _>>().map(Some)
    }
}

/// Points that a SPLINE has at least.
const LEAST_POINTS: usize = 4;

/// A cubic spline as a natural one and a cubic.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// times of the points
    pub x: Vec<f64>,
    /// values of the natural spline there
    pub y: Vec<f64>,
    /// factors of (t − a)² and (t − a)³
    pub cubic: [f64; 2],
}

impl Fitted {
    /// Fits a spline with end conditions.
    ///
    /// # Errors
    /// When there are too few points, or times do not increase.
    pub fn through(points: &[[f64; 2]], ends: Ends) -> Result<Self, Diagnostic> {
        let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|p| (p[0], p[1])).unzip();
        let unfit =
            |why: crate::expr::spline::UnfitData| Diagnostic::error("spline_data", why.to_string());
        let wanted = Piecewise::cubic(&x, &y, ends, Extrapolation::Parabolic).map_err(unfit)?;
        let (a, b) = wanted.range();
        let [first, last] = match ends {
            Ends::Natural => [0.0; 2],
            Ends::NotAKnot | Ends::Clamped(..) | Ends::Periodic => [a, b].map(|t| wanted.at(t, 2)),
        };
        let mut fitted = Self {
            cubic: [first / 2.0, (last - first) / (6.0 * (b - a))],
            y,
            x,
        };
        let less: Vec<f64> = fitted.x.iter().map(|&t| fitted.cubic_at(t)).collect();
        fitted.y.iter_mut().zip(less).for_each(|(y, p)| *y -= p);
        while fitted.x.len() < LEAST_POINTS {
            fitted.halve()?;
        }
        Ok(fitted)
    }

    /// Adds the points in the middle of the intervals: the natural spline through them is the same.
    fn halve(&mut self) -> Result<(), Diagnostic> {
        let curve = self.natural()?;
        let middles = self.x.windows(2).map(|ends| 0.5 * (ends[0] + ends[1]));
        let mut all: Vec<f64> = self.x.iter().copied().chain(middles).collect();
        all.sort_by(f64::total_cmp);
        self.y = all.iter().map(|&t| curve.at(t, 0)).collect();
        self.x = all;
        Ok(())
    }

    /// Returns the natural spline.
    fn natural(&self) -> Result<Piecewise, Diagnostic> {
        let fitted = Piecewise::cubic(&self.x, &self.y, Ends::Natural, Extrapolation::Parabolic);
        fitted.map_err(|why| Diagnostic::error("spline_data", why.to_string()))
    }

    fn cubic_at(&self, t: f64) -> f64 {
        let s = t - self.x.first().copied().unwrap_or_default();
        s * s * (self.cubic[0] + s * self.cubic[1])
    }

    /// Returns the function in the language of direct entry, where the natural spline is
    /// `SPLINE/id`.
    pub fn text(&self, id: u32) -> String {
        let spline = format!("CUBSPL(TIME, 0, {id})");
        if self.cubic == [0.0; 2] {
            return spline;
        }
        let a = self.x.first().copied().unwrap_or_default();
        let [square, cube] = self.cubic;
        format!("{spline} + POLY(TIME, {a:E}, 0, 0, {square:E}, {cube:E})")
    }
}

/// Reads a direct-entry function from a file: its lines in one, without the commas that continue
/// them.
pub(super) fn read_formula(file: &Path) -> Result<String, String> {
    let text = contents(file)?;
    let lines = text.lines().map(|line| {
        let line = line.split('!').next().unwrap_or_default().trim();
        line.strip_prefix(',')
            .unwrap_or(line)
            .trim_end_matches('\\')
            .trim()
    });
    let whole = lines
        .filter(|l| !l.is_empty())
        .collect::<Vec<_>>()
        .join(" ");
    let bare = whole.split_once('=').filter(|(word, _)| {
        let word = word.trim();
        word.len() >= 3 && "FUNCTION".starts_with(&word.to_uppercase())
    });
    let function = bare.map_or(whole.as_str(), |(_, function)| function.trim());
    match function.is_empty() {
        true => Err(format!("{}: there is no function in it", disk::text(&file))),
        false => Ok(function.to_owned()),
    }
}

/// Reads points from a file of two columns, separated by commas, semicolons or blanks; lines of
/// words above them are heads.
pub(super) fn read_points(file: &Path) -> Result<Vec<[f64; 2]>, String> {
    let text = contents(file)?;
    let mut points: Vec<[f64; 2]> = Vec::new();
    for (line, number) in text.lines().zip(1..) {
        let cells = line.split([',', ';', '\t', ' ']).filter(|c| !c.is_empty());
        let cells: Vec<&str> = cells.map(str::trim).collect();
        let numbers: Vec<f64> = cells.iter().filter_map(|c| c.parse().ok()).collect();
        match numbers.as_slice() {
            &[x, y] if cells.len() == 2 => points.push([x, y]),
            _ if points.is_empty() || cells.is_empty() => {}
            _ => {
                let place = format!("{}:{number}", disk::text(&file));
                return Err(format!("{place}: a time and a value should stand here"));
            }
        }
    }
    match points.is_empty() {
        true => Err(format!("{}: there are no points in it", disk::text(&file))),
        false => Ok(points),
    }
}

fn contents(file: &Path) -> Result<String, String> {
    let bytes = disk::read(file).map_err(|e| format!("{}: {e}", disk::text(&file)))?;
    Ok(String::from_utf8_lossy(&as_utf8(bytes)).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spline_with_any_ends_is_a_natural_one_and_a_cubic() {
        let points = [[0.5, 1.0], [1.0, -2.0], [2.5, 4.0], [3.0, 0.0], [4.0, 1.0]];
        let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|p| (p[0], p[1])).unzip();
        for ends in [
            Ends::Natural,
            Ends::NotAKnot,
            Ends::Clamped(2.0, -3.0),
            Ends::Periodic,
        ] {
            let wanted = Piecewise::cubic(&x, &y, ends, Extrapolation::None).unwrap();
            let fitted = Fitted::through(&points, ends).unwrap();
            let natural = fitted.natural().unwrap();
            for k in 0..=70 {
                let t = 0.5 + 0.05 * f64::from(k);
                let off = natural.at(t, 0) + fitted.cubic_at(t) - wanted.at(t, 0);
                assert!(off.abs() < 1e-12, "{ends:?} at {t}: {off}");
            }
        }
    }

    #[test]
    fn a_spline_through_few_points_has_as_many_as_a_dataset_asks_for() {
        for points in [
            &[[0.0, 1.0], [2.0, 3.0]][..],
            &[[0.0, 1.0], [1.0, 3.0], [4.0, 0.0]][..],
        ] {
            let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|p| (p[0], p[1])).unzip();
            let wanted = Piecewise::cubic(&x, &y, Ends::Natural, Extrapolation::None).unwrap();
            let fitted = Fitted::through(points, Ends::Natural).unwrap();
            assert!(fitted.x.len() >= LEAST_POINTS);
            let natural = fitted.natural().unwrap();
            for k in 0..=20 {
                let t = x[x.len() - 1] * f64::from(k) / 20.0;
                assert!(
                    (natural.at(t, 0) - wanted.at(t, 0)).abs() < 1e-14,
                    "{points:?} at {t}"
                );
            }
        }
    }

    #[test]
    fn every_ordinate_is_read_by_its_word() {
        for ordinate in Ordinate::ALL {
            assert_eq!(Ordinate::of(ordinate.word()), Ok(ordinate));
        }
        assert!(Ordinate::of("").is_err() && Ordinate::of("weight").is_err());
    }
}
