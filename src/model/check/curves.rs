//! Curves: enough points of three coordinates, of a kind that is said, and closed ends that meet.

use super::*;
use crate::diagnostic::counted;
use crate::expr::interpolation::CLOSING_TOLERANCE;

pub(super) fn curves_have_points(model: &Model, out: &mut Out) {
    for (&id, c) in &model.curves {
        let who = (ElementKind::Curve.id(id), &c.place);
        if c.matrix.is_none() && c.function.is_none() {
            error(
                out,
                "missing_argument",
                who,
                "a CURVE needs MATRIX, or FUNCTION = USER(…)".into(),
            );
        }
        let Some(points) = c.matrix.and_then(|m| model.matrices.get(&m)) else {
            continue;
        };
        if c.through_points.is_none() {
            let message = "neither CURVE_POINTS nor CONTROL_POINTS: the rows of its MATRIX are control points, \
                           and the curve passes by them"
                .into();
            warn(out, "control_points", who, message);
            advise(
                out,
                "CURVE_POINTS lays the curve through them; CONTROL_POINTS says that this is meant",
            );
        }
        if points.unread_file().is_some() {
            continue;
        }
        if points.columns != 3 {
            let message = format!(
                "its MATRIX has {}; a point has three",
                counted(points.columns, "column")
            );
            error(out, "wrong_count", who, message);
            continue;
        }
        if points.rows < 4 {
            error(
                out,
                "few_points",
                who,
                format!(
                    "{}; a curve needs four or more",
                    counted(points.rows, "point")
                ),
            );
        }
        let all = points.by_rows().unwrap_or_default();
        if c.closed {
            closed(&all, who, out);
        }
    }
}

/// The ends of a closed curve: apart, or apart by rounding.
fn closed(all: &[f64], who: Who, out: &mut Out) {
    let points: Vec<&[f64]> = all.chunks_exact(3).collect();
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return;
    };
    let gap = |a: &[f64], b: &[f64]| {
        let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
        squares.sum::<f64>().sqrt()
    };
    let size = points.iter().map(|p| gap(p, first)).fold(0.0, f64::max);
    let open = gap(first, last);
    if open > CLOSING_TOLERANCE * size {
        let message = format!("CLOSED, but its first and last point are {open:.6} apart");
        error(out, "open_ends", who, message);
        advise(out, "repeat the first point as the last one");
    }
}
