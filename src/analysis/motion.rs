//! Motion of markers after a run, from its record alone: nothing is solved again.
//!
//! The record has the frame of every part at every output, with its rates; the model says where a
//! marker is fixed in its part. A marker's motion follows from both, and any displacement, velocity
//! or acceleration of the function language from the motions of the markers that it names:
//!
//! ```text
//! p = p_P + R r     v = v_P + ω × R r     a = a_P + α × R r + ω × (ω × R r)
//! ```
//!
//! A level (displacement, velocity, acceleration) needs sets of six functions of the parts
//! concerned, three of translation and three of rotation: its own, and those of the levels below.

use super::session::columns::unit_of;
use crate::diagnostic::{Cause, Diagnostic};
use crate::expr::measures::{Family, Measure};
use crate::expr::program::Input;
use crate::model::{
    ElementId, ElementKind, Marker, MarkerOwner, Model, Orientation, Text, geometry,
};
use crate::physics::kinematic;
use crate::results::{Column, Run, digest};
use crate::space::{Frame, MarkerState, Vec3, rotation};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt::Write;

/// Components of the sets of six functions, level by level.
const SETS: [[&str; 6]; 3] = [
    ["X", "Y", "Z", "PSI", "THETA", "PHI"],
    ["VX", "VY", "VZ", "WX", "WY", "WZ"],
    ["ACCX", "ACCY", "ACCZ", "WDX", "WDY", "WDZ"],
];
const LEVELS: [&str; 3] = ["displacements", "velocities", "accelerations"];

/// A record with the model that it is of.
#[derive(Debug)]
pub struct Recorded<'a> {
    run: &'a Run,
    model: &'a Model,
}

/// A measure of markers, as an expression that is nothing else: `DX(20,10)`.
#[derive(Clone, Debug)]
pub struct MarkerMeasure {
    /// with the numbers of its markers
    text: Text,
    measure: Measure,
    arguments: [u32; 4],
    /// 0 displacement, 1 velocity, 2 acceleration
    level: usize,
}

impl MarkerMeasure {
    /// Reads an expression, in which markers may have their names; `None`: it is something else
    /// than one measure of markers.
    ///
    /// # Errors
    /// Names of no marker, or of several.
    pub fn of(model: &Model, text: &str) -> Result<Option<Self>, Vec<Diagnostic>> {
        Ok(Self::of_numbers(&model.numbered(text)?.text))
    }

    fn of_numbers(text: &str) -> Option<Self> {
        let text = Text::from(text);
        let ast = text.ast().ok()?;
        let Some(Input::Measure(measure, arguments)) = ast.input(ast.root) else {
            return None;
        };
        let level = match measure.row().family {
            Family::Displacement => 0,
            Family::Velocity => 1,
            Family::Acceleration => 2,
            Family::GenericForce | Family::ElementForce | Family::System => return None,
        };
        Some(Self {
            text,
            measure,
            arguments,
            level,
        })
    }

    /// Returns the numbers of its markers, ground left out.
    fn markers(&self) -> impl Iterator<Item = u32> {
        let first = if self.measure == Measure::Orient {
            2
        } else {
            0
        };
        let markers = self.arguments.into_iter().skip(first);
        markers.filter(|&marker| marker != 0)
    }
}

/// The place of a marker in what moves it.
struct Carried {
    /// per level, the columns of the six functions of its part; none: ground
    levels: Option<Vec<[usize; 6]>>,
    /// the marker in the part's frame
    frame: Frame<f64>,
}

impl<'a> Recorded<'a> {
    /// Takes a record and its model.
    pub fn new(run: &'a Run, model: &'a Model) -> Self {
        Self { run, model }
    }

    /// Returns a measure at every row of the record, as a column of this name.
    ///
    /// # Errors
    /// A marker that does not exist or does not move with a part, or a part without the sets of
    /// six functions that the measure needs.
    pub fn column(&self, name: &str, asked: &MarkerMeasure) -> Result<Column, Diagnostic> {
        let mut carried = BTreeMap::new();
        for marker in asked.markers() {
            carried.insert(marker, self.carried(marker, asked.level)?);
        }
        let values = (0..self.run.held().len()).map(|place| {
            let state = |marker: u32| Some(self.state(carried.get(&marker)?, place));
            kinematic::kinematic_of(asked.measure, asked.arguments, state).unwrap_or(f64::NAN)
        });
        Ok(Column {
            name: name.to_owned(),
            values: values.collect(),
            unit: unit_of(&asked.text, &self.run.units),
            bar_of: None,
        })
    }

    /// Returns the frame of a marker in ground at every row of the record.
    ///
    /// # Errors
    /// As [`Recorded::column`].
    pub fn frames(&self, marker: u32) -> Result<Vec<Frame<f64>>, Diagnostic> {
        let carried = self.carried(marker, 0)?;
        let frame = |place: usize| {
            let state = self.state(&carried, place);
            Frame {
                rotation: state.R_GM,
                position: state.p_GM,
            }
        };
        Ok((0..self.run.held().len()).map(frame).collect())
    }

    /// Finds a marker, and the columns that move it up to a level.
    fn carried(&self, marker: u32, level: usize) -> Result<Carried, Diagnostic> {
        let id = ElementKind::Marker.id(marker);
        let unknown = |what: String| Diagnostic::error(Cause::UnknownElement, what);
        let Some(data) = self.model.markers.get(&marker) else {
            return Err(unknown(format!("{id} does not exist in the model")));
        };
        let body = data.owner.body().filter(|_| !data.floating);
        let found = body.and_then(|body| {
            let mut bodies = self.model.bodies();
            bodies.find(|(id, _)| *id == body)
        });
        let Some((body, part)) = found else {
            let what = format!("{id} is not fixed in a part: its motion is not in the record");
            return Err(unknown(what));
        };
        let rotation = geometry::orientation(&data.orientation, data.qp)
            .map_err(|why| Diagnostic::error("unfit_value", why).element(id.to_string()))?;
        let frame = Frame {
            rotation,
            position: Vec3(data.qp),
        };
        if part.ground {
            return Ok(Carried {
                levels: None,
                frame,
            });
        }
        let name = self.model.labels().name(self.model, body);
        let levels = (0..=level).map(|level| self.set(body, &name, level));
        Ok(Carried {
            levels: Some(levels.collect::<Result<_, _>>()?),
            frame,
        })
    }

    /// Finds the columns of the six functions of a part at a level.
    fn set(&self, body: ElementId, name: &str, level: usize) -> Result<[usize; 6], Diagnostic> {
        let entities = self.run.entities.iter();
        let mut by_number = entities.filter(|e| e.kind == "Part" && e.id == u64::from(body.number));
        // results of other programs may call a part otherwise
        let other = by_number.next().map(|e| e.name.clone());
        let find = |component: &str| {
            let own = self.run.find(&format!("{name}_XFORM.{component}"));
            own.or_else(|| self.run.find(&format!("{}.{component}", other.as_ref()?)))
        };
        let found = SETS[level].map(find);
        if let [Some(a), Some(b), Some(c), Some(d), Some(e), Some(f)] = found {
            return Ok([a, b, c, d, e, f]);
        }
        let missing = SETS[level].iter().zip(found);
        let missing: Vec<&str> = (missing.filter(|(_, found)| found.is_none()))
            .map(|(component, _)| *component)
            .collect();
        let what = format!(
            "the record has no complete set of six {} of {body} ({name}): {} is missing",
            LEVELS[level],
            missing.join(", ")
        );
        Err(Diagnostic::error(Cause::NoMotionSet, what).help(
            "RESULTS in the dataset, or --format res or parquet, records them; NOVELOCITIES and NOACCELERATIONS leave them out",
        ))
    }

    /// Returns the motion of a marker at a row; rates that it does not need are zero.
    fn state(&self, carried: &Carried, place: usize) -> MarkerState<f64> {
        let Some(levels) = &carried.levels else {
            return MarkerState {
                R_GM: carried.frame.rotation,
                p_GM: carried.frame.position,
                ..MarkerState::ground()
            };
        };
        let at = |level: usize, first: usize| {
            let values = |set: &[usize; 6]| {
                Vec3([0, 1, 2].map(|k| {
                    let column = &self.run.columns[set[first + k]];
                    let in_degrees = first == 3 && column.unit.starts_with("deg");
                    let factor = if in_degrees { PI / 180.0 } else { 1.0 };
                    factor * column.values[place]
                }))
            };
            levels.get(level).map_or_else(Vec3::zero, values)
        };
        let [psi, theta, phi] = at(0, 3).0;
        let R_GP = rotation::from_313(psi, theta, phi);
        let arm = R_GP.apply(carried.frame.position);
        let (w, alpha) = (at(1, 3), at(2, 3));
        MarkerState {
            R_GM: R_GP * carried.frame.rotation,
            p_GM: at(0, 0) + arm,
            w_GM: w,
            v_GM: at(1, 0) + w.cross(arm),
            alpha_GM: alpha,
            a_GM: at(2, 0) + alpha.cross(arm) + w.cross(w.cross(arm)),
        }
    }
}

/// Returns a text that two models have in common where their markers are fixed alike in the same
/// parts: 16 hexadecimal digits.
pub fn marker_digest(model: &Model) -> String {
    let mut text = String::new();
    for (&number, marker) in &model.markers {
        push_marker(&mut text, number, marker);
    }
    digest(text.bytes())
}

/// Appends what is digested of a marker. Records of earlier versions hold the digest of what `{:?}`
/// writes: this is the same text without its work.
fn push_marker(text: &mut String, number: u32, marker: &Marker) {
    push_whole(text, number);
    match marker.owner {
        MarkerOwner::Part(part) => {
            text.push_str(" Part(");
            push_whole(text, part);
            text.push_str(") ");
        }
        // writing to a text cannot fail
        other => drop(write!(text, " {other:?} ")),
    }
    push_numbers(text, marker.qp);
    match marker.orientation {
        Orientation::Euler(angles) => {
            text.push_str(" Euler(");
            push_numbers(text, angles);
            text.push(')');
        }
        Orientation::Aligned => text.push_str(" Aligned"),
        other => drop(write!(text, " {other:?}")),
    }
    text.push_str(if marker.floating {
        " true\n"
    } else {
        " false\n"
    });
}

/// Appends numbers as `{:?}` does; small whole ones, which most are, without its work.
fn push_numbers(text: &mut String, numbers: [f64; 3]) {
    /// Largest whole number that is written by itself.
    const SMALL: f64 = 1e5;
    text.push('[');
    for (k, x) in numbers.into_iter().enumerate() {
        text.push_str(if k > 0 { ", " } else { "" });
        let whole = x as i32;
        if x.abs() < SMALL && f64::from(whole).to_bits() == x.to_bits() {
            text.push_str(if whole < 0 { "-" } else { "" });
            push_whole(text, whole.unsigned_abs());
            text.push_str(".0");
        } else {
            let _ = write!(text, "{x:?}");
        }
    }
    text.push(']');
}

/// Appends a whole number.
fn push_whole(text: &mut String, number: u32) {
    let mut digits = [0; 10];
    let (mut first, mut rest) = (digits.len(), number);
    loop {
        first -= 1;
        digits[first] = b'0' + (rest % 10) as u8;
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    text.extend(digits[first..].iter().map(|&digit| char::from(digit)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Records of earlier versions name the same models.
        #[test]
        fn numbers_of_a_digest_are_those_of_debug(x: f64, whole in -200_000i32..200_000, y in -2.0..2.0) {
            for numbers in [[x, f64::from(whole), y], [-0.0, 0.0, -x], [0.5 * f64::from(whole), f64::NAN, 1e5]] {
                let mut text = String::new();
                push_numbers(&mut text, numbers);
                prop_assert_eq!(text, format!("{numbers:?}"));
            }
        }

        #[test]
        fn markers_of_a_digest_are_those_of_debug(
            number: u32, owner: u32, x in -9i32..9, kind in 0..6
        ) {
            let qp = [f64::from(x), 0.0, 0.1 * f64::from(x)];
            let marker = Marker {
                owner: match kind {
                    0 => MarkerOwner::PointMass(owner),
                    1 => MarkerOwner::Other(ElementKind::FlexBody.id(owner)),
                    _ => MarkerOwner::Part(owner),
                },
                orientation: match kind {
                    2 => Orientation::default(),
                    3 => Orientation::Points { z: Some(qp), x: None, use_x: false },
                    _ => Orientation::Euler(qp),
                },
                floating: kind == 4,
                qp,
                ..Marker::default()
            };
            let mut text = String::new();
            push_marker(&mut text, number, &marker);
            let Marker { owner, orientation, floating, .. } = marker;
            let debug = format!("{number} {owner:?} {qp:?} {orientation:?} {floating}\n");
            prop_assert_eq!(text, debug);
        }
    }
}
