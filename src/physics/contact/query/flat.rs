//! Geometry in a plane: intersections of lines, points within polygons, nearest points of outlines.

use crate::scalar::hypot;

/// A point projected onto the plane perpendicular to n.
pub(super) type Flat = [f64; 2];

/// Sine of the angle between two lines below which they are parallel.
const PARALLEL_SINE: f64 = 1e-6;

pub(super) fn distance(p: Flat, q: Flat) -> f64 {
    hypot(p[0] - q[0], p[1] - q[1])
}

/// Returns the point of the line from `p` to `q` that is nearest to `at`.
pub(super) fn foot(at: Flat, p: Flat, q: Flat) -> Flat {
    let along = [q[0] - p[0], q[1] - p[1]];
    let length2 = along[0] * along[0] + along[1] * along[1];
    let u = (along[0] * (at[0] - p[0]) + along[1] * (at[1] - p[1])) / length2;
    let u = if u.is_finite() {
        u.clamp(0.0, 1.0)
    } else {
        0.0
    };
    [p[0] + u * along[0], p[1] + u * along[1]]
}

/// Returns the nearest points of two outlines, the same twice where they cross.
pub(super) fn nearest(i: &[Flat], j: &[Flat]) -> Option<[Flat; 2]> {
    for (p, q) in edges(i) {
        for (r, s) in edges(j) {
            if let Some((at, _)) = crossing(p, q, r, s) {
                return Some([at, at]);
            }
        }
    }
    let mut pairs: Vec<[Flat; 2]> = Vec::new();
    for &p in i {
        pairs.extend(j.iter().map(|&q| [p, q]));
        pairs.extend(edges(j).map(|(r, s)| [p, foot(p, r, s)]));
    }
    for &q in j {
        pairs.extend(edges(i).map(|(r, s)| [foot(q, r, s), q]));
    }
    let apart = |pair: &[Flat; 2]| distance(pair[0], pair[1]);
    pairs
        .into_iter()
        .min_by(|a, b| apart(a).total_cmp(&apart(b)))
}

/// Returns twice the area of the triangle p, q, r.
fn area(p: Flat, q: Flat, r: Flat) -> f64 {
    (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
}

/// Iterates over the edges of an outline.
pub(super) fn edges(outline: &[Flat]) -> impl Iterator<Item = (Flat, Flat)> + '_ {
    let n = if outline.len() > 2 {
        outline.len()
    } else {
        outline.len().saturating_sub(1)
    };
    (0..n).map(move |k| (outline[k], outline[(k + 1) % outline.len()]))
}

/// Returns whether a point lies within an outline, or within `near` of it.
pub(super) fn is_within(p: Flat, outline: &[Flat], near: f64) -> bool {
    match *outline {
        [] => false,
        [q] => distance(p, q) <= near,
        [q, r] => {
            let length = distance(q, r);
            let along = (r[0] - q[0]) * (p[0] - q[0]) + (r[1] - q[1]) * (p[1] - q[1]);
            area(q, r, p).abs() <= near * length
                && along >= -near * length
                && along <= length * (length + near)
        }
        _ => {
            let sides = edges(outline).map(|(q, r)| {
                let length = distance(q, r);
                if length > 0.0 {
                    area(q, r, p) / length
                } else {
                    0.0
                }
            });
            let (low, high) = sides.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(x), high.max(x))
            });
            low >= -near || high <= near
        }
    }
}

/// Returns the intersection of two lines, and the sine of the angle between them.
pub(super) fn crossing(p: Flat, q: Flat, r: Flat, s: Flat) -> Option<(Flat, f64)> {
    let (d, g) = ([q[0] - p[0], q[1] - p[1]], [s[0] - r[0], s[1] - r[1]]);
    let cross = d[0] * g[1] - d[1] * g[0];
    let sine = cross.abs() / (hypot(d[0], d[1]) * hypot(g[0], g[1]));
    // parallel lines touch at their corners instead
    if sine.is_nan() || sine < PARALLEL_SINE {
        return None;
    }
    let apart = [r[0] - p[0], r[1] - p[1]];
    let u = (apart[0] * g[1] - apart[1] * g[0]) / cross;
    let v = (apart[0] * d[1] - apart[1] * d[0]) / cross;
    let inside = |x: f64| (0.0..=1.0).contains(&x);
    (inside(u) && inside(v)).then(|| ([p[0] + u * d[0], p[1] + u * d[1]], sine))
}
