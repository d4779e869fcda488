//! Numbers that the user gives for an expression: states of markers, data of splines and points
//! of curves from JSON files, and the host that answers expressions from them.
//!
//! Markers: `{"12": {"r": [x, y, z], "v": …, "w": …, "a": …, "al": …, "e313": [psi, theta, phi]}}`,
//! or `"A"` with the rows of the matrix whose columns are the marker's axes; all in ground, angles
//! in rad; missing entries are 0. Splines: `{"1": {"x": […], "y": […]}}`, with `"z"` a family of
//! curves; `"end"` is natural, not-a-knot or periodic, `"extrap"` parabolic or linear. Curves:
//! `{"1": {"points": [[x, y, z], …]}}`, with `"closed"`, `"control"` (the points are those of a
//! B-spline) and `"order"`.

use cognate::diagnostic::Diagnostic;
use cognate::disk;
use cognate::expr::interpolation::{Bindings, Curve, CurvePoints, Spline};
use cognate::expr::program::Input;
use cognate::expr::spline::{Ends, Extrapolation};
use cognate::internals::encoding::as_utf8;
use cognate::internals::physics::kinematic::kinematic_of;
use cognate::internals::space::{MarkerState, Mat3, Vec3, rotation};
use cognate::scalar::{Jet, Scalar};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// The inputs of expressions other than time.
#[derive(Clone, Debug, Default)]
pub struct Data {
    /// states of markers by number
    pub markers: BTreeMap<u32, MarkerState<f64>>,
    /// splines and curves by number
    pub bindings: Bindings,
    /// values of other functions of the model, such as VARVAL(3)
    pub values: BTreeMap<Input, f64>,
    /// code of the analysis; 0 when none runs
    pub mode: f64,
}

impl Data {
    /// Returns the value of an input with its rates in time, as far as they are known: markers move
    /// on with constant accelerations, given values stay. `None`: nothing is known of it.
    pub fn jet(&self, input: Input, time: f64) -> Option<Jet> {
        match input {
            Input::Time => Some(Jet::variable(time)),
            Input::Mode => Some(Jet::constant(self.mode)),
            Input::Measure(measure, arguments) => {
                let given = self.values.get(&input).map(|&v| Jet::constant(v));
                given.or_else(|| {
                    kinematic_of(measure, arguments, |id| self.markers.get(&id).map(moving))
                })
            }
            Input::Delayed(_) | Input::Slot(_) => {
                self.values.get(&input).map(|&v| Jet::constant(v))
            }
        }
    }
    /// Returns the value of an input, if it is known.
    pub fn value(&self, input: Input, time: f64) -> Option<f64> {
        match input {
            Input::Measure(measure, arguments) if !self.values.contains_key(&input) => {
                kinematic_of(measure, arguments, |id| self.markers.get(&id).copied())
            }
            _ => self.jet(input, time).map(|j| j.value),
        }
    }
    /// Reads states of markers from a file.
    ///
    /// # Errors
    /// When the file cannot be read or is not of the form above; the message names the place.
    pub fn read_markers(&mut self, file: &Path) -> Result<(), Diagnostic> {
        each_of(file, |id, object| {
            marker(object).map(|m| {
                self.markers.insert(id, m);
            })
        })
    }
    /// Reads data of splines from a file.
    ///
    /// # Errors
    /// When the file cannot be read or is not of the form above; the message names the place.
    pub fn read_splines(&mut self, file: &Path) -> Result<(), Diagnostic> {
        each_of(file, |id, object| {
            spline(object).map(|s| drop(self.bindings.splines.insert(id, Arc::new(s))))
        })
    }
    /// Reads points of curves from a file.
    ///
    /// # Errors
    /// When the file cannot be read or is not of the form above; says where.
    pub fn read_curves(&mut self, file: &Path) -> Result<(), Diagnostic> {
        each_of(file, |id, object| {
            curve(object).map(|c| drop(self.bindings.curves.insert(id, Arc::new(c))))
        })
    }
    /// Adds one marker from the text of a JSON object, as in a file.
    ///
    /// # Errors
    /// When the text is not of the form above.
    pub fn add_marker(&mut self, id: u32, text: &str) -> Result<(), Diagnostic> {
        let value: Value = serde_json::from_str(text).map_err(|e| bad(format!("no JSON: {e}")))?;
        let object = value
            .as_object()
            .ok_or_else(|| bad("a marker is an object, such as {\"r\": [1, 2, 3]}"))?;
        self.markers.insert(id, marker(object).map_err(bad)?);
        Ok(())
    }
}

/// Returns the state with its rates: positions and velocities from the next derivative,
/// accelerations constant.
fn moving(m: &MarkerState<f64>) -> MarkerState<Jet> {
    let jets = |value: Vec3<f64>, rate: Vec3<f64>, second: Vec3<f64>| {
        Vec3([0, 1, 2].map(|k| Jet::new(value.0[k], rate.0[k], second.0[k])))
    };
    let (zero, pose) = (Vec3::zero(), m.in_time());
    MarkerState {
        R_GM: pose.rotation,
        p_GM: pose.position,
        w_GM: jets(m.w_GM, m.alpha_GM, zero),
        v_GM: jets(m.v_GM, m.a_GM, zero),
        alpha_GM: jets(m.alpha_GM, zero, zero),
        a_GM: jets(m.a_GM, zero, zero),
    }
}

fn bad(message: impl Into<String>) -> Diagnostic {
    Diagnostic::error("bad_data", message)
}

/// Calls `take` for every entry of a file that holds an object from numbers to objects.
fn each_of(
    file: &Path,
    mut take: impl FnMut(u32, &Map<String, Value>) -> Result<(), String>,
) -> Result<(), Diagnostic> {
    let in_file = |mut d: Diagnostic| {
        d.file = Some(disk::text(&file));
        d
    };
    let bytes = cognate::disk::read(file).map_err(|e| {
        in_file(Diagnostic::error(
            "file_unreadable",
            format!("cannot be read: {e}"),
        ))
    })?;
    let value: Value = serde_json::from_slice(&as_utf8(bytes)).map_err(|e| {
        let mut d = in_file(bad(format!("no JSON: {e}")));
        (d.line, d.column) = (e.line(), e.column());
        d
    })?;
    let entries = value.as_object().ok_or_else(|| {
        in_file(bad(
            "an object from numbers to data is expected, such as {\"12\": {…}}",
        ))
    })?;
    for (key, entry) in entries {
        let taken = match (key.parse(), entry.as_object()) {
            (Ok(id), Some(object)) if id > 0 => take(id, object),
            (Ok(_), Some(_)) => Err("numbers start at 1".into()),
            (Err(_), _) => Err("this is not a whole number".into()),
            (_, None) => Err("an object is expected".into()),
        };
        taken.map_err(|message| in_file(bad(format!("\"{key}\": {message}"))))?;
    }
    Ok(())
}

fn known_keys(object: &Map<String, Value>, known: &[&str]) -> Result<(), String> {
    match object.keys().find(|k| !known.contains(&k.as_str())) {
        Some(key) => Err(format!("\"{key}\" is not one of {}", known.join(", "))),
        None => Ok(()),
    }
}

/// Reads the state of a marker.
fn marker(object: &Map<String, Value>) -> Result<MarkerState<f64>, String> {
    known_keys(object, &["r", "v", "w", "a", "al", "A", "e313"])?;
    let vector = |key: &str| match object.get(key) {
        None => Ok(Vec3::zero()),
        Some(value) => numbers(value)
            .ok()
            .and_then(|n| n.try_into().ok())
            .map(Vec3)
            .ok_or_else(|| format!("\"{key}\" should be three numbers")),
    };
    let rotation = match (object.get("A"), object.get("e313")) {
        (Some(_), Some(_)) => return Err("\"A\" and \"e313\" both give the orientation".into()),
        (Some(rows), None) => matrix(rows)?,
        (None, Some(_)) => {
            vector("e313").map(|Vec3([psi, theta, phi])| rotation::from_313(psi, theta, phi))?
        }
        (None, None) => Mat3::identity(),
    };
    Ok(MarkerState {
        R_GM: rotation,
        p_GM: vector("r")?,
        w_GM: vector("w")?,
        v_GM: vector("v")?,
        alpha_GM: vector("al")?,
        a_GM: vector("a")?,
    })
}

/// Reads a matrix from its three rows, which must be orthonormal to six digits.
fn matrix(rows: &Value) -> Result<Mat3<f64>, String> {
    let wrong = || "\"A\" should be three rows of three numbers".to_owned();
    let rows: Vec<[f64; 3]> = rows
        .as_array()
        .ok_or_else(wrong)?
        .iter()
        .filter_map(|r| numbers(r).ok()?.try_into().ok())
        .collect();
    let m = Mat3(rows.try_into().map_err(|_| wrong())?);
    let off = |i: usize, j: usize| (m.row(i).dot(m.row(j)) - f64::from(u8::from(i == j))).abs();
    let turned = m.row(0).cross(m.row(1)).dot(m.row(2));
    let worst = (0..9).map(|k| off(k / 3, k % 3)).fold(0.0, f64::max);
    if worst < 1e-6 && turned > 0.0 {
        Ok(m)
    } else {
        Err("the rows of \"A\" are no rotation: they must be unit vectors at right angles, right-handed".into())
    }
}

/// Reads the data of a spline.
fn spline(object: &Map<String, Value>) -> Result<Spline, String> {
    known_keys(object, &["x", "y", "z", "end", "extrap"])?;
    let get = |key: &str| {
        object
            .get(key)
            .ok_or_else(|| format!("\"{key}\" is missing"))
    };
    let (x, z) = (
        numbers(get("x")?)?,
        object.get("z").map_or(Ok(Vec::new()), numbers)?,
    );
    let y = match get("y")?.as_array().map(Vec::as_slice) {
        Some(curves @ [Value::Array(_), ..]) => {
            curves.iter().map(numbers).collect::<Result<_, _>>()?
        }
        _ => vec![numbers(get("y")?)?],
    };
    let word =
        |key: &str, default: &'static str| object.get(key).map_or(Some(default), Value::as_str);
    let ends = match word("end", "natural") {
        Some("natural") => Ends::Natural,
        Some("not-a-knot") => Ends::NotAKnot,
        Some("periodic") => Ends::Periodic,
        _ => return Err("\"end\" is natural, not-a-knot or periodic".into()),
    };
    let extrapolation = match word("extrap", "parabolic") {
        Some("parabolic") => Extrapolation::Parabolic,
        Some("linear") => Extrapolation::Linear,
        _ => return Err("\"extrap\" is parabolic or linear".into()),
    };
    Spline::new(x, z, y, ends, extrapolation).map_err(|e| e.to_string())
}

fn curve(object: &Map<String, Value>) -> Result<Curve, String> {
    known_keys(object, &["points", "closed", "control", "order"])?;
    let wrong = || "\"points\" should be a list of points, each three numbers".to_owned();
    let points = (object.get("points").ok_or("\"points\" is missing")?)
        .as_array()
        .ok_or_else(wrong)?
        .iter()
        .map(|p| numbers(p)?.try_into().map_err(|_| wrong()))
        .collect::<Result<Vec<[f64; 3]>, String>>()?;
    let switch = |key: &str| match object.get(key) {
        None => Ok(false),
        Some(value) => value
            .as_bool()
            .ok_or_else(|| format!("\"{key}\" is true or false")),
    };
    let order = match object.get("order") {
        None => 4,
        Some(value) => value.as_u64().ok_or("\"order\" is a whole number")? as usize,
    };
    let kind = if switch("control")? {
        CurvePoints::Control
    } else {
        CurvePoints::OnCurve
    };
    Curve::new(&points, switch("closed")?, order, kind).map_err(|e| e.to_string())
}

fn numbers(value: &Value) -> Result<Vec<f64>, String> {
    let list = value
        .as_array()
        .and_then(|list| list.iter().map(Value::as_f64).collect::<Option<Vec<f64>>>());
    list.ok_or_else(|| "a list of numbers is expected".into())
}
