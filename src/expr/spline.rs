//! Curves through data: piecewise polynomials with their derivatives and their extrapolation.
//!
//! One form serves all kinds: on each interval a polynomial in `x − xᵢ`, and one more piece to
//! either side. An inner knot belongs to the interval on its right, the last knot to the last
//! interval; of steps to the piece beyond it, where the last value begins.

use crate::diagnostic::counted;
use crate::scalar::Table;

/// Least distance of a corner from the line between its neighbours, over the range of the values: a
/// step over smaller ones meets requests that are no tighter.
const CORNER: f64 = 1e-6;

/// The end conditions of a cubic spline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Ends {
    /// no curvature at either end
    #[default]
    Natural,
    /// the first two cubics are one polynomial, and the last two
    NotAKnot,
    /// given slopes
    Clamped(f64, f64),
    /// value, slope and curvature agree at both ends
    Periodic,
}

/// The continuation outside the data.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Extrapolation {
    /// the parabola through the first or last three points
    #[default]
    Parabolic,
    /// the straight line through the first or last two points
    Linear,
    /// no value (NaN)
    None,
}

/// A piecewise polynomial.
#[derive(Clone, Debug, PartialEq)]
pub struct Piecewise {
    /// knots, strictly increasing   (n ≥ 2)
    knots: Vec<f64>,
    /// coefficients of the powers of `x − origin`, lowest first   ((n + 1) pieces × (degree + 1))
    coefficients: Vec<f64>,
    /// degree of the polynomials
    degree: usize,
    /// intervals per unit of x, to guess the interval
    density: f64,
}

/// The reason why data make no curve, in a sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnfitData(pub String);

impl std::fmt::Display for UnfitData {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for UnfitData {}

/// Checks that there are enough finite points with increasing x.
pub(super) fn check(x: &[f64], y: &[f64], least: usize) -> Result<(), UnfitData> {
    if x.len() != y.len() {
        return Err(UnfitData(format!(
            "{} of x but {} of y",
            counted(x.len(), "value"),
            y.len()
        )));
    }
    if x.len() < least {
        return Err(UnfitData(format!(
            "{}, but at least {least} are needed",
            counted(x.len(), "point")
        )));
    }
    if let Some(k) = x
        .iter()
        .zip(y)
        .position(|(x, y)| !(x.is_finite() && y.is_finite()))
    {
        return Err(UnfitData(format!("point {} is not a number", k + 1)));
    }
    if let Some(k) = x.windows(2).position(|w| w[0] >= w[1]) {
        return Err(UnfitData(format!(
            "x must increase, but {} is followed by {}",
            x[k],
            x[k + 1]
        )));
    }
    Ok(())
}

impl Piecewise {
    /// Fits straight lines from point to point, continued to both sides.
    ///
    /// # Errors
    /// When there are too few points, x does not increase, or something is not a number.
    pub fn linear(x: &[f64], y: &[f64]) -> Result<Self, UnfitData> {
        check(x, y, 2)?;
        let pieces = (0..x.len() - 1).map(|i| vec![y[i], (y[i + 1] - y[i]) / (x[i + 1] - x[i])]);
        Ok(Self::assemble(x, y, 1, pieces, Extrapolation::Linear))
    }

    /// Builds steps: each value holds until the next point, the first one also before it.
    ///
    /// # Errors
    /// As [`Piecewise::linear`].
    pub fn steps(x: &[f64], y: &[f64]) -> Result<Self, UnfitData> {
        check(x, y, 2)?;
        let pieces = y[..y.len() - 1].iter().map(|&y| vec![y]);
        Ok(Self::assemble(x, y, 0, pieces, Extrapolation::Linear))
    }

    /// Fits Akima's local cubics (1970): the slope at a point is a mean of the neighbouring slopes,
    /// weighted by the change of the slopes on the other side.
    ///
    /// ```text
    /// tᵢ = (|mᵢ₊₁ − mᵢ| mᵢ₋₁ + |mᵢ₋₁ − mᵢ₋₂| mᵢ)/(|mᵢ₊₁ − mᵢ| + |mᵢ₋₁ − mᵢ₋₂|)
    /// ```
    ///
    /// Where both weights are zero up to rounding, the slope is the mean of the two neighbours.
    ///
    /// # Errors
    /// When there are too few points, x does not increase, or something is not a number.
    pub fn akima(x: &[f64], y: &[f64], extrapolation: Extrapolation) -> Result<Self, UnfitData> {
        check(x, y, 3)?;
        let n = x.len();
        // m[i + 2] is the slope of interval i; two more at either end
        let mut m = vec![0.0; n + 3];
        for i in 0..n - 1 {
            m[i + 2] = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
        }
        m[1] = 2.0 * m[2] - m[3];
        m[0] = 2.0 * m[1] - m[2];
        m[n + 1] = 2.0 * m[n] - m[n - 1];
        m[n + 2] = 2.0 * m[n + 1] - m[n];
        // rounding of the data in slopes that are equal: where straight parts meet, it must not
        // choose between them
        let noise = |i: usize| {
            let i = i.min(n - 2);
            let (x0, x1, y0, y1) = (x[i].abs(), x[i + 1].abs(), y[i].abs(), y[i + 1].abs());
            4.0 * f64::EPSILON * (y0 + y1 + m[i + 2].abs() * (x0 + x1)) / (x[i + 1] - x[i])
        };
        let slopes: Vec<f64> = (0..n)
            .map(|i| {
                let (after, before) = ((m[i + 3] - m[i + 2]).abs(), (m[i + 1] - m[i]).abs());
                let near = i.saturating_sub(2)..=i + 1;
                if after + before > near.map(noise).fold(0.0, f64::max) {
                    (after * m[i + 1] + before * m[i + 2]) / (after + before)
                } else {
                    0.5 * (m[i + 1] + m[i + 2])
                }
            })
            .collect();
        let pieces = (0..n - 1).map(|i| {
            let h = x[i + 1] - x[i];
            let (m, t0, t1) = (m[i + 2], slopes[i], slopes[i + 1]);
            vec![
                y[i],
                t0,
                (3.0 * m - 2.0 * t0 - t1) / h,
                (t0 + t1 - 2.0 * m) / (h * h),
            ]
        });
        Ok(Self::assemble(x, y, 3, pieces, extrapolation))
    }

    /// Fits the cubic spline with continuous curvature.
    ///
    /// # Errors
    /// When there are too few points, x does not increase, or something is not a number; or the
    /// ends do not fit the data.
    pub fn cubic(
        x: &[f64],
        y: &[f64],
        ends: Ends,
        extrapolation: Extrapolation,
    ) -> Result<Self, UnfitData> {
        check(x, y, 2)?;
        let m = curvatures(x, y, ends)?;
        let pieces = (0..x.len() - 1).map(|i| {
            let h = x[i + 1] - x[i];
            let slope = (y[i + 1] - y[i]) / h - h * (2.0 * m[i] + m[i + 1]) / 6.0;
            vec![y[i], slope, 0.5 * m[i], (m[i + 1] - m[i]) / (6.0 * h)]
        });
        Ok(Self::assemble(x, y, 3, pieces, extrapolation))
    }

    /// Builds the B-spline of an order (degree + 1) with equally spaced knots over `[from, to]`:
    /// clamped to the first and last control point, or closed.
    ///
    /// # Errors
    /// When the order is unknown, there are too few control points, or something is not a number.
    pub fn b_spline(
        control: &[f64],
        order: usize,
        closed: bool,
        from: f64,
        to: f64,
    ) -> Result<Self, UnfitData> {
        let degree = order.saturating_sub(1);
        if !(1..=9).contains(&degree) {
            return Err(UnfitData(format!(
                "a B-spline of order {order}, but orders 2 to 10 are known"
            )));
        }
        let mut control = control.to_vec();
        if closed {
            // the last control point repeats the first
            control.pop();
        }
        if control.len() < order.max(2) {
            return Err(UnfitData(format!(
                "{} control points, but order {order} needs more",
                control.len()
            )));
        }
        let n_spans = if closed {
            control.len()
        } else {
            control.len() - degree
        };
        let width = (to - from) / n_spans as f64;
        if control.iter().any(|c| !c.is_finite()) || !(width > 0.0 && width.is_finite()) {
            return Err(UnfitData(
                "control points and the range of the parameter must be numbers".to_string(),
            ));
        }
        // knots in units of spans: knot(i) for i in 0..control.len() + order
        let knot = |i: usize| {
            let k = i as f64 - degree as f64;
            if closed {
                k
            } else {
                k.clamp(0.0, n_spans as f64)
            }
        };
        let pieces = (0..n_spans).map(|span| {
            let points: Vec<f64> = (0..=degree)
                .map(|j| control[(span + j) % control.len()])
                .collect();
            b_spline_piece(points, span, width, knot)
        });
        let x: Vec<f64> = (0..=n_spans)
            .map(|k| {
                if k == n_spans {
                    to
                } else {
                    from + width * k as f64
                }
            })
            .collect();
        let y = vec![0.0; x.len()];
        Ok(Self::assemble(&x, &y, degree, pieces, Extrapolation::None))
    }

    /// Assembles a curve from the coefficients of its inner pieces and the extrapolation beyond
    /// them.
    fn assemble(
        x: &[f64],
        y: &[f64],
        degree: usize,
        pieces: impl Iterator<Item = Vec<f64>>,
        extrapolation: Extrapolation,
    ) -> Self {
        let n = x.len();
        let mut coefficients = Vec::with_capacity((n + 1) * (degree + 1));
        let outside = |at: usize, next: usize, third: usize| {
            let slope = |a: usize, b: usize| (y[b] - y[a]) / (x[b] - x[a]);
            let mut piece = vec![0.0; degree + 1];
            match extrapolation {
                Extrapolation::None => piece.fill(f64::NAN),
                Extrapolation::Parabolic if n >= 3 && degree >= 2 => {
                    let bend = (slope(next, third) - slope(at, next)) / (x[third] - x[at]);
                    piece[0] = y[at];
                    piece[1] = slope(at, next) + bend * (x[at] - x[next]);
                    piece[2] = bend;
                }
                _ if degree == 0 => piece[0] = y[at],
                _ => (piece[0], piece[1]) = (y[at], slope(at, next)),
            }
            piece
        };
        coefficients.extend(outside(0, 1, 2.min(n - 1)));
        for piece in pieces {
            coefficients.extend(piece);
        }
        coefficients.extend(outside(n - 1, n - 2, n.saturating_sub(3)));
        let density = (n - 1) as f64 / (x[n - 1] - x[0]);
        Self {
            knots: x.to_vec(),
            coefficients,
            degree,
            density,
        }
    }

    /// Returns the same curve without values outside the data.
    pub fn without_extrapolation(mut self) -> Self {
        let (width, length) = (self.degree + 1, self.coefficients.len());
        self.coefficients[..width].fill(f64::NAN);
        self.coefficients[length - width..].fill(f64::NAN);
        self
    }

    /// Returns the first and the last knot.
    pub fn range(&self) -> (f64, f64) {
        (self.knots[0], self.knots[self.knots.len() - 1])
    }

    /// Returns whether straight pieces meet in corners: their ends lie off the line between their
    /// neighbours, by more than those of a smooth function drawn finely.
    fn has_corners(&self) -> bool {
        let values = || self.knots.iter().map(|&x| self.at(x, 0));
        let (lo, hi) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), y| {
            (lo.min(y), hi.max(y))
        });
        let mut places = self.knots.windows(3);
        places.any(|x| {
            let [before, after] = [false, true].map(|above| self.beside(x[1], above, 1));
            let (h, k) = (x[1] - x[0], x[2] - x[1]);
            (after - before).abs() * h * (k / (h + k)) > CORNER * (hi - lo)
        })
    }

    /// Returns the knots.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Returns the piece for `x`, and the origin of its polynomial.
    #[inline]
    fn piece(&self, x: f64) -> (usize, f64) {
        let knots = &self.knots;
        let last = knots.len() - 1;
        if x >= knots[0] && x < knots[last] {
            // exact for equally spaced data; `as` saturates, so the guess is an index
            let guess = (((x - knots[0]) * self.density) as usize).min(last - 1);
            if knots[guess] <= x && x < knots[guess + 1] {
                return (guess + 1, knots[guess]);
            }
            let right = knots.partition_point(|&k| k <= x);
            return (right, knots[right - 1]);
        }
        if x == knots[last] && self.degree > 0 {
            (last, knots[last - 1])
        } else if x >= knots[last] {
            (last + 1, knots[last])
        } else {
            (0, knots[0])
        }
    }
}

impl Piecewise {
    /// Returns the `order`-th derivative of a piece at `x`.
    #[inline(always)]
    fn polynomial(&self, piece: usize, origin: f64, x: f64, order: u32) -> f64 {
        let width = self.degree + 1;
        let c = &self.coefficients[piece * width..(piece + 1) * width];
        let u = x - origin;
        let order = order as usize;
        if let (&[c0, c1, c2, c3], 0..=2) = (c, order) {
            return match order {
                0 => c0 + u * (c1 + u * (c2 + u * c3)),
                1 => c1 + u * (2.0 * c2 + u * (3.0 * c3)),
                _ => 2.0 * c2 + u * (6.0 * c3),
            };
        }
        // j!/(j − order)! cⱼ u^(j − order), highest first; NaN where the place itself is none
        let mut sum = if x.is_nan() || c[0].is_nan() {
            f64::NAN
        } else {
            0.0
        };
        for j in (order..width).rev() {
            let factor: f64 = (0..order).map(|k| (j - k) as f64).product();
            sum = sum * u + factor * c[j];
        }
        sum
    }
}

impl Table for Piecewise {
    fn at(&self, x: f64, order: u32) -> f64 {
        let (piece, origin) = self.piece(x);
        self.polynomial(piece, origin, x, order)
    }
    fn knots(&self) -> &[f64] {
        &self.knots
    }
    fn is_sharp(&self) -> bool {
        match self.degree {
            0 => true,
            1 => self.has_corners(),
            _ => false,
        }
    }
    fn beside(&self, x: f64, above: bool, order: u32) -> f64 {
        // pieces count from the one below all knots
        let piece = self.knots.partition_point(|&k| k < x || above && k == x);
        let origin = self.knots[piece.saturating_sub(1)];
        self.polynomial(piece, origin, x, order)
    }
}

/// Returns the coefficients of one span of a B-spline, as a polynomial in x less the start of the
/// span.
///
/// `points`: its control points   (degree + 1); `width`: length of a span; `knot(i)` in units of
/// spans.
fn b_spline_piece(
    mut points: Vec<f64>,
    span: usize,
    width: f64,
    knot: impl Fn(usize) -> f64,
) -> Vec<f64> {
    let degree = points.len() - 1;
    // derivatives at the start of the span: difference the control points, then evaluate by de Boor
    let mut coefficients = Vec::with_capacity(degree + 1);
    let (mut scale, mut lost) = (1.0, 0);
    loop {
        let remaining = degree - lost;
        coefficients
            .push(scale * de_boor(&points, remaining, span as f64, |i| knot(span + i + lost)));
        if remaining == 0 {
            return coefficients;
        }
        points = (0..remaining)
            .map(|j| {
                let (a, b) = (
                    knot(span + j + 1 + lost),
                    knot(span + j + 1 + lost + remaining),
                );
                remaining as f64 * (points[j + 1] - points[j]) / (b - a)
            })
            .collect();
        lost += 1;
        scale /= lost as f64 * width;
    }
}

/// Returns the value at `t` of the B-spline piece with these control points; `knot(i)` counts from
/// the first knot of the piece.
fn de_boor(points: &[f64], degree: usize, t: f64, knot: impl Fn(usize) -> f64) -> f64 {
    let mut d = points.to_vec();
    for r in 1..=degree {
        for j in (r..=degree).rev() {
            let (a, b) = (knot(j), knot(j + degree + 1 - r));
            let w = if b > a { (t - a) / (b - a) } else { 0.0 };
            d[j] = (1.0 - w) * d[j - 1] + w * d[j];
        }
    }
    d[degree]
}

/// Returns the second derivatives at the points of the spline.
///
/// ```text
/// hᵢ₋₁ Mᵢ₋₁ + 2 (hᵢ₋₁ + hᵢ) Mᵢ + hᵢ Mᵢ₊₁ = 6 (mᵢ − mᵢ₋₁),   hᵢ = xᵢ₊₁ − xᵢ, mᵢ = (yᵢ₊₁ − yᵢ)/hᵢ
/// ```
fn curvatures(x: &[f64], y: &[f64], ends: Ends) -> Result<Vec<f64>, UnfitData> {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let m: Vec<f64> = (0..n - 1).map(|i| (y[i + 1] - y[i]) / h[i]).collect();
    let mut rows = vec![[0.0, 1.0, 0.0, 0.0]; n]; // below, diagonal, above, right-hand side
    for i in 1..n - 1 {
        rows[i] = [
            h[i - 1],
            2.0 * (h[i - 1] + h[i]),
            h[i],
            6.0 * (m[i] - m[i - 1]),
        ];
    }
    match ends {
        Ends::Natural => Ok(tridiagonal(rows)),
        Ends::Clamped(first, last) => {
            rows[0] = [0.0, 2.0 * h[0], h[0], 6.0 * (m[0] - first)];
            rows[n - 1] = [h[n - 2], 2.0 * h[n - 2], 0.0, 6.0 * (last - m[n - 2])];
            Ok(tridiagonal(rows))
        }
        Ends::NotAKnot => {
            if n < 4 {
                return Err(UnfitData(format!(
                    "{}, but not-a-knot ends need at least 4",
                    counted(n, "point")
                )));
            }
            // M₀ = (1 + r) M₁ − r M₂ with r = h₀/h₁ makes the third derivative continuous at x₁;
            // likewise at the end
            let (r, s) = (h[0] / h[1], h[n - 2] / h[n - 3]);
            rows[1][1] += h[0] * (1.0 + r);
            rows[1][2] -= h[0] * r;
            rows[n - 2][1] += h[n - 2] * (1.0 + s);
            rows[n - 2][0] -= h[n - 2] * s;
            let inner = tridiagonal(rows[1..n - 1].to_vec());
            let first = (1.0 + r) * inner[0] - r * inner[1];
            let last = (1.0 + s) * inner[n - 3] - s * inner[n - 4];
            Ok([vec![first], inner, vec![last]].concat())
        }
        Ends::Periodic => {
            if y[0] != y[n - 1] {
                return Err(UnfitData(
                    "periodic ends need equal first and last values".to_string(),
                ));
            }
            if n < 3 {
                return Err(UnfitData(
                    "periodic ends need at least 3 points".to_string(),
                ));
            }
            Ok(periodic(&h, &m))
        }
    }
}

/// Solves `below xᵢ₋₁ + diagonal xᵢ + above xᵢ₊₁ = rhs`, diagonally dominant.
fn tridiagonal(mut rows: Vec<[f64; 4]>) -> Vec<f64> {
    let n = rows.len();
    for i in 1..n {
        let factor = rows[i][0] / rows[i - 1][1];
        rows[i][1] -= factor * rows[i - 1][2];
        rows[i][3] -= factor * rows[i - 1][3];
    }
    let mut x = vec![0.0; n];
    for i in (0..n).rev() {
        let next = if i + 1 < n {
            rows[i][2] * x[i + 1]
        } else {
            0.0
        };
        x[i] = (rows[i][3] - next) / rows[i][1];
    }
    x
}

/// Returns the second derivatives of the closed spline: solves the cyclic system as a tridiagonal
/// one with a correction of rank one.
fn periodic(h: &[f64], m: &[f64]) -> Vec<f64> {
    let n = h.len(); // unknowns; the last point is the first
    let before = |i: usize| if i == 0 { n - 1 } else { i - 1 };
    let mut rows: Vec<[f64; 4]> = (0..n)
        .map(|i| {
            [
                h[before(i)],
                2.0 * (h[before(i)] + h[i]),
                h[i],
                6.0 * (m[i] - m[before(i)]),
            ]
        })
        .collect();
    let solution = if n == 2 {
        // both neighbours are the other point
        let off = h[0] + h[1];
        let d = 2.0 * off;
        let det = d * d - off * off;
        let (r0, r1) = (rows[0][3], rows[1][3]);
        vec![(d * r0 - off * r1) / det, (d * r1 - off * r0) / det]
    } else {
        let corner = h[n - 1];
        let gamma = -rows[0][1];
        rows[0][1] -= gamma;
        rows[n - 1][1] -= corner * corner / gamma;
        let plain = tridiagonal(rows.clone());
        for row in &mut rows {
            row[3] = 0.0;
        }
        rows[0][3] = gamma;
        rows[n - 1][3] = corner;
        let edge = tridiagonal(rows);
        let factor = (plain[0] + corner * plain[n - 1] / gamma)
            / (1.0 + edge[0] + corner * edge[n - 1] / gamma);
        plain
            .iter()
            .zip(&edge)
            .map(|(p, e)| p - factor * e)
            .collect()
    };
    let first = solution[0];
    [solution, vec![first]].concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const X: [f64; 6] = [0.0, 0.4, 1.1, 1.5, 2.7, 3.0];
    const Y: [f64; 6] = [1.0, -0.5, 2.0, 2.2, 0.3, 1.0];

    fn kinds() -> Vec<Piecewise> {
        let cubic = |ends| Piecewise::cubic(&X, &Y, ends, Extrapolation::Parabolic).unwrap();
        vec![
            Piecewise::linear(&X, &Y).unwrap(),
            Piecewise::akima(&X, &Y, Extrapolation::Parabolic).unwrap(),
            cubic(Ends::Natural),
            cubic(Ends::NotAKnot),
            cubic(Ends::Clamped(0.5, -2.0)),
            cubic(Ends::Periodic),
        ]
    }

    #[test]
    fn curves_go_through_their_points() {
        for curve in kinds() {
            for (x, y) in X.iter().zip(Y) {
                assert_relative_eq!(curve.at(*x, 0), y, epsilon = 1e-14);
            }
        }
    }

    /// Slopes that differ by no more than the rounding of the data must not decide which side of a
    /// corner counts.
    #[test]
    fn akima_at_a_corner_of_straight_parts_has_the_mean_slope() {
        for (offset, step) in [(0.0, 0.1), (7.3, 0.1), (0.0, 0.7), (1e3, 0.3)] {
            let x: Vec<f64> = (0..9).map(|k| offset + step * f64::from(k)).collect();
            let y: Vec<f64> = (0..9)
                .map(|k: i32| 0.3 * f64::from((k - 4).abs()))
                .collect();
            let curve = Piecewise::akima(&x, &y, Extrapolation::Linear).unwrap();
            assert!(
                curve.at(x[4], 1).abs() < 1e-9,
                "{offset} {step}: {}",
                curve.at(x[4], 1)
            );
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let curved = Piecewise::b_spline(&Y, 5, false, -1.0, 2.0).unwrap();
        for curve in kinds().iter().chain([&curved]) {
            for x in [-0.9, 0.1, 0.7, 1.3, 1.9] {
                for order in 0..4 {
                    let h = 1e-5;
                    let difference = (curve.at(x + h, order) - curve.at(x - h, order)) / (2.0 * h);
                    assert_relative_eq!(
                        curve.at(x, order + 1),
                        difference,
                        epsilon = 1e-5,
                        max_relative = 1e-7
                    );
                }
            }
        }
    }

    #[test]
    fn cubic_splines_bend_continuously_and_end_as_told() {
        let jump = |c: &Piecewise, x: f64, order| c.at(x, order) - c.at(x - 1e-12, order);
        for curve in &kinds()[2..] {
            for x in &X[1..5] {
                assert_relative_eq!(jump(curve, *x, 1), 0.0, epsilon = 1e-9);
                assert_relative_eq!(jump(curve, *x, 2), 0.0, epsilon = 1e-8);
            }
        }
        let [.., natural, not_a_knot, clamped, periodic] = &kinds()[..] else {
            unreachable!()
        };
        assert_relative_eq!(natural.at(0.0, 2), 0.0);
        assert_relative_eq!(natural.at(3.0, 2), 0.0, epsilon = 1e-12);
        assert_relative_eq!(jump(not_a_knot, X[1], 3), 0.0, epsilon = 1e-9);
        assert_relative_eq!(jump(not_a_knot, X[4], 3), 0.0, epsilon = 1e-9);
        assert_relative_eq!(clamped.at(0.0, 1), 0.5, epsilon = 1e-12);
        assert_relative_eq!(clamped.at(3.0, 1), -2.0, epsilon = 1e-12);
        for order in 0..3 {
            assert_relative_eq!(
                periodic.at(0.0, order),
                periodic.at(3.0, order),
                epsilon = 1e-9
            );
        }
    }

    #[test]
    fn few_points_still_make_a_curve_or_say_why_not() {
        let line = Piecewise::cubic(
            &[0.0, 2.0],
            &[1.0, 5.0],
            Ends::Natural,
            Extrapolation::Parabolic,
        )
        .unwrap();
        assert_relative_eq!(line.at(3.0, 0), 7.0);
        let periodic = Piecewise::cubic(
            &[0.0, 1.0, 3.0],
            &[1.0, 2.0, 1.0],
            Ends::Periodic,
            Extrapolation::None,
        )
        .unwrap();
        assert_relative_eq!(periodic.at(0.0, 1), periodic.at(3.0, 1), epsilon = 1e-14);
        assert_relative_eq!(
            periodic.at(1.0, 2),
            periodic.at(1.0 - 1e-13, 2),
            epsilon = 1e-9
        );
        assert!(periodic.at(3.1, 0).is_nan());
        let refuse = |x: &[f64], y: &[f64], ends| {
            Piecewise::cubic(x, y, ends, Extrapolation::None)
                .unwrap_err()
                .0
        };
        assert_eq!(
            refuse(&[0.0], &[1.0], Ends::Natural),
            "1 point, but at least 2 are needed"
        );
        assert_eq!(
            refuse(&[0.0, 0.0], &[1.0, 2.0], Ends::Natural),
            "x must increase, but 0 is followed by 0"
        );
        assert_eq!(
            refuse(&[0.0, f64::NAN], &[1.0, 2.0], Ends::Natural),
            "point 2 is not a number"
        );
        assert!(refuse(&[0.0, 1.0, 2.0], &[1.0, 2.0, 3.0], Ends::Periodic).contains("equal"));
        assert!(refuse(&[0.0, 1.0, 2.0], &[1.0, 2.0, 3.0], Ends::NotAKnot).contains("at least 4"));
    }

    #[test]
    fn b_splines_of_order_two_are_polylines_and_others_are_smooth() {
        let line = Piecewise::b_spline(&[0.0, 3.0, 1.0], 2, false, -1.0, 1.0).unwrap();
        for (x, y) in [(-1.0, 0.0), (-0.5, 1.5), (0.0, 3.0), (0.5, 2.0), (1.0, 1.0)] {
            assert_relative_eq!(line.at(x, 0), y, epsilon = 1e-14);
        }
        let open = Piecewise::b_spline(&Y, 4, false, -1.0, 1.0).unwrap();
        assert_relative_eq!(open.at(-1.0, 0), Y[0], epsilon = 1e-14);
        assert_relative_eq!(open.at(1.0, 0), Y[5], epsilon = 1e-14);
        let closed =
            Piecewise::b_spline(&[0.0, 1.0, 5.0, 2.0, -1.0, 0.0], 4, true, -1.0, 1.0).unwrap();
        for (curve, joints) in [
            (&open, &open.knots[1..open.knots.len() - 1]),
            (&closed, &closed.knots[1..5]),
        ] {
            for x in joints {
                for order in 0..3 {
                    let before = curve.at(x - 1e-11, order);
                    assert_relative_eq!(curve.at(*x, order), before, epsilon = 1e-6);
                }
            }
        }
        for order in 0..3 {
            assert_relative_eq!(
                closed.at(-1.0, order),
                closed.at(1.0, order),
                epsilon = 1e-9
            );
        }
        // the uniform cubic blends 1:4:1 at a knot
        let knot = closed.knots[1];
        let want = [1.0, 5.0, 2.0, -1.0]
            .windows(3)
            .map(|w| (w[0] + 4.0 * w[1] + w[2]) / 6.0)
            .collect::<Vec<_>>();
        assert!(
            want.iter().any(|w| (closed.at(knot, 0) - w).abs() < 1e-12),
            "{} {want:?}",
            closed.at(knot, 0)
        );
        assert!(Piecewise::b_spline(&[1.0, 2.0], 4, false, -1.0, 1.0).is_err());
        assert!(Piecewise::b_spline(&Y, 1, false, -1.0, 1.0).is_err());
        assert!(Piecewise::b_spline(&[], 4, true, -1.0, 1.0).is_err());
    }
}
