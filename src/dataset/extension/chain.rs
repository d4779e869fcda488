//! Chains of curves: pieces that share end points, merged to one spline through all their points.

use super::bad;
use super::line::Line;
use crate::diagnostic::{Diagnostic, Severity, Span};
use crate::model::{Curve, ElementKind, Matrix, MatrixLayout, Model, Place};
use crate::scalar::Scalar;
use crate::space::Vec3;

/// A turn between two pieces that is told, since a spline rounds it.   [deg]
const CORNER: f64 = 10.0;

/// Distance of two end points that are one, as a part of the chain's size.
const MEETING_TOLERANCE: f64 = 1e-6;

/// Makes a CURVE of the pieces that a line names, and the MATRIX of its points.
///
/// # Errors
/// When a piece does not exist or has no points, or pieces share no end point.
pub(super) fn make(
    line: &Line<'_>,
    id: u32,
    model: &mut Model,
    out: &mut Vec<Diagnostic>,
) -> Result<(), Diagnostic> {
    let piece = |(name, at): &(String, Span)| {
        points(model, name)
            .map_err(|d| line.at(d, *at))
            .map(|points| (name.clone(), points))
    };
    let pieces: Vec<_> = line.words.iter().map(piece).collect::<Result<_, _>>()?;
    let mut points = merged(&pieces, line, out)?;
    let closed = meet(&points, points[0], points[points.len() - 1]);
    if closed {
        let first = points[0];
        points.last_mut().into_iter().for_each(|last| *last = first);
    }
    let matrix = super::next(model.matrices.keys().next_back());
    let values: Vec<f64> = points.iter().flat_map(|p| p.0).collect();
    let place = Place {
        name: Some(format!("{}_points", line.name)),
        ..Place::default()
    };
    let (rows, columns, layout) = (points.len(), 3, MatrixLayout::ByRows);
    let merged = Matrix {
        place,
        rows,
        columns,
        layout,
        values,
        file: None,
    };
    model.matrices.insert(matrix, merged);
    let curve = Curve {
        place: Place {
            name: Some(line.name.clone()),
            ..Place::default()
        },
        closed,
        matrix: Some(matrix),
        through_points: Some(true),
        ..Curve::default()
    };
    model.curves.insert(id, curve);
    Ok(())
}

/// Returns the points of a CURVE through points or of a MATRIX.
fn points(model: &Model, name: &str) -> Result<Vec<Vec3<f64>>, Diagnostic> {
    let kinds = [ElementKind::Matrix, ElementKind::Curve];
    let id = model.find_of(&kinds, name).map_err(|d| d.help(PIECES))?;
    let matrix = match id.kind {
        ElementKind::Matrix => Some(id.number),
        ElementKind::Curve => {
            let curve = model.curves.get(&id.number);
            let through = curve.filter(|c| c.through_points == Some(true));
            through
                .ok_or_else(|| bad(format!("{id} does not say CURVE_POINTS")).help(PIECES))?
                .matrix
        }
        _ => return Err(bad(format!("{id} has no points")).help(PIECES)),
    };
    let matrix = matrix.and_then(|m| model.matrices.get(&m));
    let numbers = matrix
        .filter(|m| m.columns == 3 && m.rows > 1)
        .and_then(Matrix::by_rows);
    let numbers = numbers.ok_or_else(|| {
        bad(format!("{id} has no rows x, y, z of two points or more")).help(PIECES)
    })?;
    Ok(numbers
        .chunks_exact(3)
        .map(|p| Vec3([p[0], p[1], p[2]]))
        .collect())
}

const PIECES: &str = "a chain is made of CURVEs through their points (CURVE_POINTS), and of MATRIXes with a row x, y, z per point";

/// Returns all points in their order, each piece turned round where its other end meets the last.
fn merged(
    pieces: &[(String, Vec<Vec3<f64>>)],
    line: &Line<'_>,
    out: &mut Vec<Diagnostic>,
) -> Result<Vec<Vec3<f64>>, Diagnostic> {
    let [(_, first), rest @ ..] = pieces else {
        return Err(line.at(
            bad("a curve has at least one piece").help(PIECES),
            line.span,
        ));
    };
    let everything: Vec<Vec3<f64>> = pieces.iter().flat_map(|(_, p)| p.iter().copied()).collect();
    let touches = |p: Vec3<f64>, piece: &[Vec3<f64>]| {
        meet(&everything, p, piece[0]) || meet(&everything, p, piece[piece.len() - 1])
    };
    let mut all = first.clone();
    if let Some((_, second)) = rest.first()
        && !touches(all[all.len() - 1], second)
    {
        all.reverse();
    }
    for (name, piece) in rest {
        let (end, mut piece) = (all[all.len() - 1], piece.clone());
        if !touches(end, &piece) {
            let gap = |p: Vec3<f64>| (p - end).norm();
            let gap = gap(piece[0]).min(gap(piece[piece.len() - 1]));
            let d = bad(format!(
                "{name} begins {gap:.6} beside the end of the piece before it"
            ));
            return Err(line.at(d.help("neighbours share an end point"), line.span));
        }
        if !meet(&everything, end, piece[0]) {
            piece.reverse();
        }
        out.extend(corner(all[all.len() - 2], end, piece[1], name).map(|d| line.at(d, line.span)));
        all.extend(&piece[1..]);
    }
    Ok(all)
}

/// Returns the warning about a corner that the spline rounds.
fn corner(before: Vec3<f64>, at: Vec3<f64>, after: Vec3<f64>, name: &str) -> Option<Diagnostic> {
    let (a, b) = (at - before, after - at);
    let turn = Scalar::atan2(a.cross(b).norm(), a.dot(b)).to_degrees();
    (turn > CORNER).then(|| Diagnostic {
        severity: Severity::Warning,
        ..bad(format!(
            "a corner of {turn:.0} degrees before {name}: the spline through all points rounds it"
        ))
        .help("more points beside the corner keep the curve near it")
    })
}

/// Returns whether two points are one within rounding of the size of all.
fn meet(all: &[Vec3<f64>], a: Vec3<f64>, b: Vec3<f64>) -> bool {
    let size = all.iter().map(|p| (*p - all[0]).norm()).fold(0.0, f64::max);
    (a - b).norm() <= MEETING_TOLERANCE * size
}
