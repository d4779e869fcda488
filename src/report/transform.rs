//! Curves made of curves: derivative, integral and spectrum over x, and statistics.
//!
//! Results repeat a time where a static and a dynamic row, or two sides of a jump, share it. A
//! derivative begins anew there; an integral and a spectrum take the later value.

use std::f64::consts::{PI, TAU};

/// A point of a curve: x, y.
pub type Point = (f64, f64);

/// Returns the pieces of a curve in which x grows and all values are finite.
fn growing(points: &[Point]) -> Vec<Vec<Point>> {
    let mut pieces: Vec<Vec<Point>> = vec![Vec::new()];
    for &(x, y) in points {
        let last = pieces.last().and_then(|piece| piece.last());
        if last.is_some_and(|last| last.0 >= x) || !(x.is_finite() && y.is_finite()) {
            pieces.push(Vec::new());
        }
        if let Some(piece) = pieces.last_mut()
            && x.is_finite()
            && y.is_finite()
        {
            piece.push((x, y));
        }
    }
    pieces.retain(|piece| !piece.is_empty());
    pieces
}

/// Returns the points with one value for each x, the last one, in growing order.
fn single_valued(points: &[Point]) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for &(x, y) in points.iter().filter(|p| p.0.is_finite() && p.1.is_finite()) {
        match kept.last_mut() {
            Some(last) if last.0 == x => *last = (x, y),
            Some(last) if last.0 > x => {}
            _ => kept.push((x, y)),
        }
    }
    kept
}

/// Returns the slope at the middle of three points of their parabola, or at an end (`at`).
fn slope(p: [Point; 3], at: usize) -> f64 {
    let [h, k] = [p[1].0 - p[0].0, p[2].0 - p[1].0];
    let [a, b] = [(p[1].1 - p[0].1) / h, (p[2].1 - p[1].1) / k];
    let middle = (a * k + b * h) / (h + k);
    match at {
        0 => 2.0 * a - middle,
        1 => middle,
        _ => 2.0 * b - middle,
    }
}

/// Returns the derivative: the slope of the parabola through neighbours, of second order. Pieces
/// are set apart by a gap.
pub fn derivative(points: &[Point]) -> Vec<Point> {
    let mut out = Vec::with_capacity(points.len());
    for piece in growing(points) {
        if !out.is_empty() {
            out.push((f64::NAN, f64::NAN));
        }
        match piece.as_slice() {
            [] | [_] => {}
            [a, b] => {
                let rate = (b.1 - a.1) / (b.0 - a.0);
                out.extend([(a.0, rate), (b.0, rate)]);
            }
            all => {
                let n = all.len();
                for k in 0..n {
                    let first = k.saturating_sub(1).min(n - 3);
                    let three = [all[first], all[first + 1], all[first + 2]];
                    out.push((all[k].0, slope(three, k - first)));
                }
            }
        }
    }
    out
}

/// Returns the integral from the first point on, by trapezia.
pub fn integral(points: &[Point]) -> Vec<Point> {
    let points = single_valued(points);
    let mut sum = 0.0;
    let mut last = points.first().copied().unwrap_or_default();
    let mut out = Vec::with_capacity(points.len());
    for p in points {
        sum += 0.5 * (p.1 + last.1) * (p.0 - last.0);
        out.push((p.0, sum));
        last = p;
    }
    out
}

/// Returns the amplitude at each frequency from 0 on, in 1 over the unit of x.
///
/// The mean is taken away, the rest weighted by a Hann window, whose loss is made good: a sine of
/// amplitude a shows a peak of a where its frequency is one of those shown. Points at unequal
/// distances are interpolated to equal ones first.
pub fn spectrum(points: &[Point]) -> Vec<Point> {
    let points = single_valued(points);
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
        return Vec::new();
    };
    let n = points.len();
    let span = last.0 - first.0;
    if n < 4 || span <= 0.0 {
        return Vec::new();
    }
    let step = span / (n - 1) as f64;
    let samples = resampled(&points, first.0, step);
    let mean = samples.iter().sum::<f64>() / n as f64;
    let hann = |k: usize| 0.5 - 0.5 * (TAU * k as f64 / n as f64).cos();
    let weighted: Vec<Complex> = (samples.iter().enumerate())
        .map(|(k, y)| Complex(hann(k) * (y - mean), 0.0))
        .collect();
    let found = transformed(&weighted);
    let amplitude = |z: &Complex| 4.0 * z.0.hypot(z.1) / n as f64;
    (found.iter().take(n / 2 + 1).enumerate())
        .map(|(k, z)| (k as f64 / (n as f64 * step), amplitude(z)))
        .collect()
}

/// Returns the values at equal distances, on the straight lines between the points.
fn resampled(points: &[Point], start: f64, step: f64) -> Vec<f64> {
    let mut at = 0;
    (0..points.len())
        .map(|k| {
            let x = start + step * k as f64;
            while at + 2 < points.len() && points[at + 1].0 < x {
                at += 1;
            }
            let [a, b] = [points[at], points[at + 1]];
            let part = ((x - a.0) / (b.0 - a.0)).clamp(0.0, 1.0);
            a.1 + part * (b.1 - a.1)
        })
        .collect()
}

/// A complex number.
#[derive(Clone, Copy, Debug, Default)]
struct Complex(f64, f64);

impl std::ops::Mul for Complex {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self(self.0 * o.0 - self.1 * o.1, self.0 * o.1 + self.1 * o.0)
    }
}

impl Complex {
    /// Returns e^(iφ).
    fn turn(angle: f64) -> Self {
        Self(angle.cos(), angle.sin())
    }
}

/// Returns the discrete Fourier transform of any number of values, by Bluestein's convolution.
fn transformed(values: &[Complex]) -> Vec<Complex> {
    let n = values.len();
    // k² modulo 2n keeps the angles exact
    let chirp = |k: usize| Complex::turn(-PI * ((k * k) % (2 * n)) as f64 / n as f64);
    let size = (2 * n).next_power_of_two();
    let (mut a, mut b) = (
        vec![Complex::default(); size],
        vec![Complex::default(); size],
    );
    for (k, &value) in values.iter().enumerate() {
        a[k] = value * chirp(k);
        let Complex(re, im) = chirp(k);
        b[k] = Complex(re, -im);
        b[(size - k) % size] = b[k];
    }
    radix_two(&mut a, -1.0);
    radix_two(&mut b, -1.0);
    a.iter_mut().zip(&b).for_each(|(a, b)| *a = *a * *b);
    radix_two(&mut a, 1.0);
    let scale = Complex(1.0 / size as f64, 0.0);
    (0..n).map(|k| a[k] * chirp(k) * scale).collect()
}

/// Transforms in place a power of two of values; `sign` is that of the exponent.
fn radix_two(a: &mut [Complex], sign: f64) {
    let n = a.len();
    let bits = n.trailing_zeros();
    for k in 0..n {
        let reversed = if bits == 0 {
            k
        } else {
            k.reverse_bits() >> (usize::BITS - bits)
        };
        if k < reversed {
            a.swap(k, reversed);
        }
    }
    let mut half = 1;
    while half < n {
        let turns: Vec<Complex> = (0..half)
            .map(|k| Complex::turn(sign * PI * k as f64 / half as f64))
            .collect();
        for block in a.chunks_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for ((l, h), turn) in low.iter_mut().zip(high).zip(&turns) {
                let (x, y) = (*l, *h * *turn);
                *l = Complex(x.0 + y.0, x.1 + y.1);
                *h = Complex(x.0 - y.0, x.1 - y.1);
            }
        }
        half *= 2;
    }
}

/// Extremes and means of a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// first and last value
    pub ends: [f64; 2],
    /// least value, and its x
    pub least: Point,
    /// largest value, and its x
    pub largest: Point,
    /// mean over x
    pub mean: f64,
    /// root of the mean of squares over x
    pub rms: f64,
}

/// Returns the statistics of a curve; `None` where it has no finite value. Means are those of the
/// straight lines between the points.
pub fn statistics(points: &[Point]) -> Option<Statistics> {
    let points = single_valued(points);
    let (first, last) = (*points.first()?, *points.last()?);
    let least = points.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let largest = points.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let span = last.0 - first.0;
    let (mut sum, mut squares) = (0.0, 0.0);
    for pair in points.windows(2) {
        let (h, [a, b]) = (pair[1].0 - pair[0].0, [pair[0].1, pair[1].1]);
        sum += 0.5 * h * (a + b);
        squares += h * (a * a + a * b + b * b) / 3.0;
    }
    let over = |integral: f64, otherwise: f64| {
        if span > 0.0 {
            integral / span
        } else {
            otherwise
        }
    };
    Some(Statistics {
        ends: [first.1, last.1],
        least: (least.1, least.0),
        largest: (largest.1, largest.0),
        mean: over(sum, first.1),
        rms: over(squares, first.1 * first.1).sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(f: impl Fn(f64) -> f64, times: impl Iterator<Item = f64>) -> Vec<Point> {
        times.map(|t| (t, f(t))).collect()
    }

    #[test]
    fn a_parabola_at_unequal_distances_has_its_slope() {
        let times = [0.0, 0.1, 0.35, 0.4, 1.0];
        let points = sampled(|t| 3.0 * t * t - t, times.into_iter());
        for (t, rate) in derivative(&points) {
            assert!((rate - (6.0 * t - 1.0)).abs() < 1e-12, "{t}: {rate}");
        }
    }

    #[test]
    fn a_jump_between_rows_of_one_time_is_no_slope() {
        let points = [(0.0, 0.0), (1.0, 1.0), (1.0, 5.0), (2.0, 6.0)];
        let rates = derivative(&points);
        assert!(
            rates
                .iter()
                .filter(|p| p.0.is_finite())
                .all(|p| (p.1 - 1.0).abs() < 1e-12)
        );
        assert_eq!(rates.iter().filter(|p| p.0.is_nan()).count(), 1);
    }

    #[test]
    fn the_integral_of_the_derivative_is_the_curve() {
        let points = sampled(f64::sin, (0..=1000).map(|k| f64::from(k) * 0.01));
        for ((_, y), (_, back)) in points.iter().zip(integral(&derivative(&points))) {
            assert!((y - back).abs() < 1e-4);
        }
    }

    #[test]
    fn a_sine_is_a_peak_of_its_amplitude_at_its_frequency() {
        for n in [256, 250, 251] {
            let step = 1.0 / f64::from(n);
            let sine = |t: f64| 7.0 + 3.0 * (TAU * 20.0 * t).sin();
            let found = spectrum(&sampled(sine, (0..n).map(|k| f64::from(k) * step)));
            let peak = found.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
            assert!(
                (peak.0 - 20.0).abs() < 1e-9 && (peak.1 - 3.0).abs() < 1e-9,
                "{n}: {peak:?}"
            );
        }
        assert!(spectrum(&[(0.0, 1.0)]).is_empty());
    }

    #[test]
    fn means_are_those_over_x_not_over_rows() {
        let found = statistics(&[(0.0, 0.0), (1.0, 0.0), (1.0, 3.0), (4.0, 3.0)]).unwrap();
        // the later value at 1 counts: a ramp, then 3
        assert!((found.mean - 10.5 / 4.0).abs() < 1e-12);
        assert_eq!((found.least, found.largest), ((0.0, 0.0), (3.0, 4.0)));
        assert!(statistics(&[(0.0, f64::NAN)]).is_none());
    }
}
