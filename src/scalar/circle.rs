//! Sine, cosine and tangent of plain numbers.
//!
//! Our own, because a mechanism evaluates little else: the library of the system takes four times
//! as long (it saves and restores the rounding mode at each call), and its last bits differ from
//! one system to the next. Here they are the same everywhere.
//!
//! ```text
//! x = n π/2 + r + ρ,  |r| ≤ π/4     π/2 in three parts, whose products with n are exact for two;
//!                                   ρ: the part of the remainder that r cannot hold
//! sin(r + ρ) = r + (r z S(z) + ρ (1 − z/2))         z = r²
//! cos(r + ρ) = 1 − z/2 + (z² C(z) − r ρ)
//! ```
//!
//! S and C are minimax polynomials, with relative errors of 3e-18 and 5e-20. Results are off by at
//! most 0.8 units in the last place, even where they are nearly zero: `|x| ≤` [`LARGEST_REDUCED`]
//! keeps n small enough for that. Beyond it whole numbers find n and r + ρ ([`quarters`]). The
//! tangent is the quotient of both as sums of two numbers, 0.82 units off at most.

use super::elementary::{Elementary, ROUND_TO_WHOLE, half_square, quotient, rounded};
use super::quarters;
use std::f64::consts::FRAC_2_PI;

/// Largest angle, in rad, that is reduced here: n has thirteen bits, and r all its digits even at
/// the doubles nearest to multiples of π/2.
const LARGEST_REDUCED: f64 = 12_000.0;

/// Sizes of angles, in rad, up to and from which it is plain how many quarter turns are nearest:
/// none, one, two. They are not quite the odd multiples of π/4.
const PLAINLY_NONE: f64 = 0.785;
const PLAINLY_ONE: [f64; 2] = [0.786, 2.356];
const PLAINLY_TWO: [f64; 2] = [2.357, 3.926];

/// Size of an angle without its quarter turns, in rad, from which on it is larger than what one or
/// two quarter turns have in their second part.
const BEYOND_SECOND_PART: f64 = 1e-9;

/// π/2 in three parts: 33 bits, the next 33, the rest.
const HALF_PI_PARTS: [f64; 3] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_795_950_6e-21,
];

/// Bit of the sign.
const SIGN: u64 = 1 << 63;

/// Coefficients of S: (sin r/r − 1)/z over z.
const S: [f64; 6] = [
    -0.166_666_666_666_666_32,
    0.008_333_333_333_322_41,
    -0.000_198_412_698_298_050_94,
    2.755_731_369_093_595_4e-6,
    -2.505_075_795_559_771_5e-8,
    1.589_678_607_597_384_3e-10,
];

/// Coefficients of C: (cos r − 1 + z/2)/z² over z.
const C: [f64; 6] = [
    0.041_666_666_666_666_6,
    -0.001_388_888_888_887_412,
    2.480_158_728_947_932_8e-5,
    -2.755_731_435_147_006_7e-7,
    2.087_572_315_122_1e-9,
    -1.135_964_125_505_546_6e-11,
];

/// Angle, in rad, below which the sine is the angle itself, signed zeros included.
const SINE_IS_ANGLE: f64 = 1e-8;

/// Angle, in rad, below which the tangent is the angle itself.
const TANGENT_IS_ANGLE: f64 = 1e-9;

/// Returns sine and cosine of an angle in radians.
///
/// A single angle is waited for: what takes longest is to learn how many quarter turns to take off,
/// and then to take them off. Where their number is plain, the processor goes ahead with it.
#[inline(always)]
pub fn sin_cos(x: f64) -> (f64, f64) {
    if x.abs() <= PLAINLY_NONE {
        let (sine, cosine) = of_remainder([x, 0.0]);
        (unless_small(x, sine), cosine)
    } else {
        beyond_an_eighth(x)
    }
}

/// Returns sine and cosine of an angle beyond an eighth of a turn, or of what is no number: the
/// same bits as [`near`], sooner.
#[inline(never)]
fn beyond_an_eighth(x: f64) -> (f64, f64) {
    let (size, sign) = (x.abs(), x.to_bits() & SIGN);
    let signed = |y: f64| f64::from_bits(y.to_bits() ^ sign);
    if (PLAINLY_ONE[0]..=PLAINLY_ONE[1]).contains(&size) {
        let (sine, cosine) = of_remainder(without(size, 1.0));
        (signed(cosine), -sine)
    } else if (PLAINLY_TWO[0]..=PLAINLY_TWO[1]).contains(&size) {
        let (sine, cosine) = of_remainder(without(size, 2.0));
        (signed(-sine), -cosine)
    } else if size <= LARGEST_REDUCED {
        near(x)
    } else {
        far(x)
    }
}

#[cold]
fn far(x: f64) -> (f64, f64) {
    let (quarters, r) = quarters::of_size(x);
    let (sine, cosine) = of_remainder(r);
    let (sine, cosine) = turned(quarters, sine, cosine);
    (if x < 0.0 { -sine } else { sine }, cosine)
}

/// Returns sines and cosines of several angles, in parallel where all are small enough, with the
/// same bits.
#[inline(always)]
pub fn of_several<const N: usize>(x: [f64; N]) -> ([f64; N], [f64; N]) {
    let (mut sines, mut cosines) = ([0.0; N], [0.0; N]);
    if x.iter().all(|x| x.abs() <= LARGEST_REDUCED) {
        for k in 0..N {
            (sines[k], cosines[k]) = near(x[k]);
        }
    } else {
        for k in 0..N {
            (sines[k], cosines[k]) = sin_cos(x[k]);
        }
    }
    (sines, cosines)
}

/// Finds sines and cosines of some angles, in parallel as [`of_several`]: of a number of them that
/// is not known beforehand, which the compiler leaves a loop.
#[inline(always)]
pub fn sines_and_cosines(x: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    let all = x.iter().zip(sines).zip(cosines);
    if x.iter().all(|x| x.abs() <= LARGEST_REDUCED) {
        for ((x, sine), cosine) in all {
            (*sine, *cosine) = near(*x);
        }
    } else {
        for ((x, sine), cosine) in all {
            (*sine, *cosine) = sin_cos(*x);
        }
    }
}

/// Returns n, with its last bits at the end, and r + ρ.
#[inline(always)]
fn reduced(x: f64) -> (u64, [f64; 2]) {
    let shifted = x * FRAC_2_PI + ROUND_TO_WHOLE;
    let n = shifted - ROUND_TO_WHOLE;
    let [first, second, rest] = HALF_PI_PARTS;
    // the product with the first part is exact; the other differences keep their rounding errors
    let (a, b) = (x - n * first, n * second);
    let difference = a - b;
    let part = difference - a;
    let lost = (a - (difference - part)) - (b + part);
    let less = n * rest - lost;
    let r = difference - less;
    (shifted.to_bits(), [r, (difference - r) - less])
}

/// Returns r + ρ of an angle without one or two quarter turns, as [`reduced`] does.
#[inline(always)]
fn without(x: f64, n: f64) -> [f64; 2] {
    let [first, second, rest] = HALF_PI_PARTS;
    let (a, b) = (x - n * first, n * second);
    let difference = a - b;
    // what rounding lost takes two operations where `a` is the larger, else four
    let lost = if a.abs() >= BEYOND_SECOND_PART {
        (a - difference) - b
    } else {
        let part = difference - a;
        (a - (difference - part)) - (b + part)
    };
    let less = n * rest - lost;
    let r = difference - less;
    [r, (difference - r) - less]
}

/// Returns S and C at z = r².
#[inline(always)]
fn polynomials(z: f64) -> [f64; 2] {
    let z2 = z * z;
    [
        (S[0] + z * S[1]) + z2 * ((S[2] + z * S[3]) + z2 * (S[4] + z * S[5])),
        (C[0] + z * C[1]) + z2 * ((C[2] + z * C[3]) + z2 * (C[4] + z * C[5])),
    ]
}

/// Returns sine and cosine of r + ρ.
#[inline(always)]
fn of_remainder([r, rho]: [f64; 2]) -> (f64, f64) {
    let z = r * r;
    let half = 0.5 * z;
    let [s, c] = polynomials(z);
    let sine = r + (r * (z * s) + rho * (1.0 - half));
    let most = 1.0 - half;
    let cosine = most + (((1.0 - most) - half) + (z * z * c - r * rho));
    (sine, cosine)
}

/// Returns the sine of an angle, or the angle itself where that is small.
#[inline(always)]
fn unless_small(x: f64, sine: f64) -> f64 {
    if x.abs() < SINE_IS_ANGLE { x } else { sine }
}

/// Reduces and evaluates without any branch, so that several angles run in parallel.
#[inline(always)]
fn near(x: f64) -> (f64, f64) {
    let (quarters, r) = reduced(x);
    let (sine, cosine) = of_remainder(r);
    turned(quarters, unless_small(x, sine), cosine)
}

/// Returns sine and cosine of an angle with so many quarter turns more: exchanges them where they
/// are odd, and sets signs by their second bit.
#[inline(always)]
fn turned(quarters: u64, sine: f64, cosine: f64) -> (f64, f64) {
    let odd = 0u64.wrapping_sub(quarters & 1);
    let (sine, cosine) = (sine.to_bits(), cosine.to_bits());
    let change = (sine ^ cosine) & odd;
    let sine = sine ^ change ^ (quarters & 2) << 62;
    let cosine = cosine ^ change ^ (quarters.wrapping_add(1) & 2) << 62;
    (f64::from_bits(sine), f64::from_bits(cosine))
}

/// The tangent.
pub(super) struct Tan;

impl Elementary for Tan {
    type Argument = f64;
    #[inline(always)]
    fn is_usual(x: f64) -> bool {
        x.abs() <= LARGEST_REDUCED
    }
    #[inline(always)]
    fn near(x: f64) -> f64 {
        let (quarters, r) = reduced(x);
        let tangent = tangent(quarters, r);
        if x.abs() < TANGENT_IS_ANGLE {
            x
        } else {
            tangent
        }
    }
    #[cold]
    fn far(x: f64) -> f64 {
        let (quarters, r) = quarters::of_size(x);
        let tangent = tangent(quarters, r);
        if x < 0.0 { -tangent } else { tangent }
    }
}

/// Returns the tangent of quarter turns and r + ρ: the quotient of sine and cosine, both as sums.
#[inline(always)]
fn tangent(quarters: u64, [r, rho]: [f64; 2]) -> f64 {
    let z = r * r;
    let [s, c] = polynomials(z);
    let [half, half_rest] = half_square(r);
    let [s, s2] = rounded([r, r * (z * s) + rho * (1.0 - half)]);
    let [most, lost] = rounded([1.0, -half]);
    let [c, c2] = rounded([most, lost + ((z * z * c - r * rho) - half_rest)]);
    let is_odd = quarters & 1 == 1;
    let (n, n2) = (if is_odd { -c } else { s }, if is_odd { -c2 } else { s2 });
    let (d, d2) = (if is_odd { s } else { c }, if is_odd { s2 } else { c2 });
    let [tangent, rest] = quotient([n, n2], [d, d2]);
    tangent + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// One unit of the last digit, relative to the larger neighbour: half of it is the library's.
    const UNIT: f64 = f64::EPSILON;

    fn agrees(x: f64) {
        let ((s, c), (sine, cosine)) = (sin_cos(x), f64::sin_cos(x));
        assert!(
            (s - sine).abs() <= UNIT * sine.abs(),
            "sin {x:e}: {s:e} {sine:e}"
        );
        assert!(
            (c - cosine).abs() <= UNIT * cosine.abs(),
            "cos {x:e}: {c:e} {cosine:e}"
        );
    }

    #[test]
    fn it_is_the_librarys_to_the_last_digit() {
        let mut x = 1e-9;
        while x < 13_000.0 {
            agrees(x);
            agrees(-x);
            x *= 1.000_037_1;
        }
        (0..200_000).for_each(|k| agrees(f64::from(k) * 0.061_803_4 - 6_000.0));
    }

    #[test]
    fn all_digits_are_right_where_the_result_is_nearly_zero() {
        for k in 0..7_600 {
            let x = f64::from(k) * FRAC_PI_2;
            [x, -x, x.next_up(), x.next_down()]
                .into_iter()
                .for_each(agrees);
        }
        assert_eq!(sin_cos(PI).0, 1.224_646_799_147_353_2e-16);
        // of all doubles this one is nearest to a multiple of π/2 (by whole numbers of 1400 digits;
        // libraries may be off by several units)
        let nearest = 6_381_956_970_095_103.0 * 2f64.powi(797);
        assert_eq!(sin_cos(nearest), (1.0, -4.687_165_924_254_628e-19));
    }

    #[test]
    fn angles_of_any_size_are_those_of_the_library() {
        let mut x = LARGEST_REDUCED;
        while x < f64::MAX / 2.0 {
            [x, -x, (x * FRAC_2_PI).round() * FRAC_PI_2]
                .into_iter()
                .for_each(agrees);
            x *= 1.003_7;
        }
        agrees(f64::MAX);
        for x in [3e4, 1.2e9, 7e300] {
            assert_eq!(Tan::far(-x), -Tan::far(x));
            assert_eq!(sin_cos(-x), (-sin_cos(x).0, sin_cos(x).1));
        }
    }

    #[test]
    fn special_numbers_stay_what_they_are() {
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert!(sin_cos(-0.0).0.is_sign_negative());
        assert_eq!(sin_cos(f64::MIN_POSITIVE), (f64::MIN_POSITIVE, 1.0));
        for x in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
            let (s, c) = sin_cos(x);
            assert!(s.is_nan() && c.is_nan());
        }
        agrees(1e300);
    }

    #[test]
    fn a_single_angle_is_the_same_bits_with_and_without_going_ahead() {
        let same = |x: f64| {
            let (one, other) = (sin_cos(x), near(x));
            let bits = |(s, c): (f64, f64)| (s.to_bits(), c.to_bits());
            assert_eq!(bits(one), bits(other), "{x:e}");
        };
        (0..400_000).for_each(|k| same(f64::from(k) * 2.618_034e-5 - 5.0));
        let bounds = [PLAINLY_ONE, PLAINLY_TWO].concat();
        for at in (0..6).map(|k| f64::from(k) * FRAC_PI_2).chain(bounds) {
            // outwards from the angle, ever farther
            for k in -1100..0 {
                let by = f64::powf(1.02, f64::from(2 * k));
                [at + by, at - by, -at + by, -at - by]
                    .into_iter()
                    .for_each(same);
            }
            [at, -at, at.next_up(), at.next_down()]
                .into_iter()
                .for_each(same);
        }
        [PLAINLY_NONE, -PLAINLY_NONE, f64::MIN_POSITIVE, 1e-8, -1e-9]
            .into_iter()
            .for_each(same);
    }

    #[test]
    fn several_are_the_same_bits_as_one() {
        let x: [f64; 8] = std::array::from_fn(|k| 1.7 * k as f64 - 3.0);
        let far = [1.0, 2e5, -3.0, 4e9, 0.5, 1.0, -0.0, 2.0];
        for x in [x, far] {
            let (sines, cosines) = of_several(x);
            assert_eq!(sines, x.map(|x| sin_cos(x).0));
            assert_eq!(cosines, x.map(|x| sin_cos(x).1));
            for n in 0..=x.len() {
                let (mut s, mut c) = ([0.0; 8], [0.0; 8]);
                sines_and_cosines(&x[..n], &mut s[..n], &mut c[..n]);
                assert_eq!((&s[..n], &c[..n]), (&sines[..n], &cosines[..n]));
            }
        }
    }
}
