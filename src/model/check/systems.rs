//! Data and system elements: splines, arrays, and the arrays that systems fill and read.

use super::*;
use crate::diagnostic::counted;

pub(super) fn splines_are_functions(model: &Model, out: &mut Out) {
    for (&id, s) in &model.splines {
        let who = (ElementKind::Spline.id(id), &s.place);
        if s.file.is_some() && s.x.is_empty() {
            continue;
        }
        let n = s.x.len();
        if n == 0 || s.y.is_empty() {
            error(
                out,
                "missing_argument",
                who,
                "a SPLINE needs X and Y, or FILE".into(),
            );
            continue;
        }
        for (k, y) in s.y.iter().enumerate().filter(|(_, y)| y.len() != n) {
            let which = if s.y.len() > 1 {
                format!(" {}", k + 1)
            } else {
                String::new()
            };
            error(
                out,
                "wrong_count",
                who,
                format!("X has {}, Y{which} has {}", counted(n, "number"), y.len()),
            );
        }
        for (name, list) in [("X", &s.x), ("Z (the first numbers of each Y)", &s.z)] {
            if let Some(w) = list.windows(2).find(|w| w[0].total_cmp(&w[1]).is_ge()) {
                let message = format!("{name} must increase: {} comes after {}", w[1], w[0]);
                error(out, "not_increasing", who, message);
            }
        }
        if n < 4 {
            warn(
                out,
                "few_points",
                who,
                format!("{}: a cubic spline needs four or more", counted(n, "point")),
            );
        }
    }
}

pub(super) fn arrays_have_their_size(model: &Model, out: &mut Out) {
    for (&id, a) in &model.arrays {
        let (n, name) = match &a.kind {
            ArrayKind::Ic(x) => (x.len(), "NUMBERS"),
            ArrayKind::Inputs(x) => (x.len(), "VARIABLES"),
            ArrayKind::States | ArrayKind::Outputs => continue,
        };
        let who = (ElementKind::Array.id(id), &a.place);
        if n == 0 {
            error(out, "missing_argument", who, format!("{name} is needed"));
        }
        if let Some(size) = a.size.filter(|&s| s != n && n > 0) {
            error(
                out,
                "wrong_count",
                who,
                format!("SIZE = {size}, but {name} holds {n}"),
            );
            at_argument(out, "SIZE");
        }
    }
    for (&id, m) in &model.matrices {
        let who = (ElementKind::Matrix.id(id), &m.place);
        if m.unread_file().is_some() {
            continue;
        }
        if m.rows == 0 || m.columns == 0 {
            error(
                out,
                "missing_argument",
                who,
                "ROWS and COLUMNS are needed".into(),
            );
        } else if m.by_rows().is_none() {
            let message = match &m.layout {
                MatrixLayout::Sparse { rows, columns } => format!(
                    "SPARSE has {} I, {} J and {} VALUES, within {} by {}",
                    rows.len(),
                    columns.len(),
                    m.values.len(),
                    m.rows,
                    m.columns
                ),
                _ => format!(
                    "{} of {} make {}, but VALUES holds {}",
                    counted(m.rows, "row"),
                    m.columns,
                    m.rows.saturating_mul(m.columns),
                    m.values.len()
                ),
            };
            error(out, "wrong_count", who, message);
        }
    }
}

pub(super) fn systems_have_their_arrays(model: &Model, out: &mut Out) {
    let fits = |array: u32, argument: &str| {
        model.arrays.get(&array).is_none_or(|a| match argument {
            "X" | "XD" => a.kind == ArrayKind::States,
            "Y" => a.kind == ArrayKind::Outputs,
            "U" => matches!(a.kind, ArrayKind::Inputs(_)),
            _ => matches!(a.kind, ArrayKind::Ic(_)),
        })
    };
    let all = match model.arrays.is_empty() {
        true => Vec::new(),
        false => model.references(),
    };
    for r in all {
        if r.target.kind == ElementKind::Array && !fits(r.target.number, r.argument) {
            let kind = match r.argument {
                "XD" => "X",
                "ICD" => "IC",
                other => other,
            };
            let message = format!(
                "{} = {}: {} is not of the kind {kind}",
                r.argument, r.target.number, r.target
            );
            error(out, "wrong_array", (r.element, r.place), message);
            at_argument(out, r.argument);
        }
    }
    for (&id, t) in &model.transfer_functions {
        let who = (ElementKind::Tfsiso.id(id), &t.place);
        if t.numerator.len() > t.denominator.len() {
            let message = "the degree of NUMERATOR is higher than that of DENOMINATOR".to_owned();
            error(out, "improper_transfer_function", who, message);
            at_argument(out, "NUMERATOR");
        }
        if t.denominator.last().is_some_and(|&a| a == 0.0) {
            error(
                out,
                "unfit_value",
                who,
                "the last number of DENOMINATOR, its highest power, is zero".into(),
            );
        }
    }
}

/// Sensors watch something that changes.
pub(super) fn sensors_watch_something(model: &Model, out: &mut Out) {
    for (&id, s) in &model.sensors {
        if let Some(value) = s.function.constant() {
            let who = (ElementKind::Sensor.id(id), &s.place);
            let message = format!("its FUNCTION is {value} for ever: nothing triggers it");
            warn(out, "no_effect", who, message);
        }
    }
}
