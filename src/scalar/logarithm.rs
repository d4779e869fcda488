//! Logarithms, and powers with any exponent.
//!
//! ```text
//! x = 2ᵏ m,  √½ ≤ m < √2            (nearly: the pieces of the table begin there)
//! f = m/c − 1,  |f| ≤ 1/128         1/c in eleven bits, so that f is a sum of two exact products
//! ln x = k ln 2 + ln c + f − f²/2 + f³ L(f)
//! xᵉ = exp(e ln x)
//! ```
//!
//! `ln c` stands in a table of twice as many digits, L is a minimax polynomial with a relative
//! error of 1e-20 · f². The sum has twice as many digits up to its cubic term: its relative error
//! is below 2⁻⁶⁵, of which even the largest power, e ln x = 709, keeps an error of less than a
//! tenth of a unit in the last place.

use super::elementary::{Elementary, Twice, half_square, lost_in_product, rounded, upper_half};
use super::exponential::{LN_2_PARTS, MOST_USUAL, far_of_sum, near_of_sum};
use std::f64::consts::LOG10_E;

/// The natural logarithm.
pub(super) struct Ln;
/// The logarithm to the base 10.
pub(super) struct Log10;
/// The power of a base and an exponent.
pub(super) struct Power;

/// Coefficients of L: (ln(1 + f) − f + f²/2)/f³ over f.
const L: [f64; 6] = [
    0.333_333_333_333_338_03,
    -0.249_999_999_999_962_03,
    0.199_999_999_532_978_34,
    -0.166_666_668_528_062_92,
    0.142_870_265_339_060_72,
    -0.124_983_503_129_763_65,
];

/// A piece of the table.
#[derive(Clone, Copy)]
struct Piece {
    /// 1/c
    reciprocal: f64,
    /// ln c in two parts, the first a multiple of 2⁻⁴²
    ln: Twice,
}

/// Bits of the least m: near √½, and a whole number of pieces below one.
const LEAST: u64 = 0x3FE6_A000_0000_0000;
/// Bits of a number that tell its place within its piece.
const PLACE_BITS: u32 = 45;
const ONE: u64 = 0x3FF0_0000_0000_0000;
const FRACTION: u64 = 0x000F_FFFF_FFFF_FFFF;
/// 2⁵², whose last bits are whole numbers.
const WHOLE: f64 = 4_503_599_627_370_496.0;

static PIECES: [Piece; 128] = pieces();

const fn pieces() -> [Piece; 128] {
    let one = Piece {
        reciprocal: 1.0,
        ln: Twice(0.0, 0.0),
    };
    let mut pieces = [one; 128];
    let mut i = 0;
    while i < 128 {
        let middle = LEAST + ((i as u64) << PLACE_BITS) + (1 << (PLACE_BITS - 1));
        let c = f64::from_bits(middle);
        let reciprocal = (2048.0 / c + 0.5) as i64 as f64 / 2048.0;
        // the pieces on either side of one have c = 1, so that f is exact where the sum is small
        if (c - 1.0).abs() > 1.0 / 128.0 {
            let ln = ln_of_short(reciprocal);
            let round = 1.5 * WHOLE / (1u64 << 42) as f64;
            let first = (round - ln.0) - round;
            pieces[i] = Piece {
                reciprocal,
                ln: Twice(first, (-ln.0 - first) - ln.1),
            };
        }
        i += 1;
    }
    pieces
}

/// Returns the logarithm of a number between ½ and 2 with few digits: 2 artanh((x − 1)/(x + 1)).
const fn ln_of_short(x: f64) -> Twice {
    let s = Twice(x - 1.0, 0.0).over(Twice(x + 1.0, 0.0));
    let z = s.times(s);
    let mut sum = Twice(0.0, 0.0);
    let mut k = 61;
    while k > 0 {
        sum = sum
            .times(z)
            .plus(Twice(2.0, 0.0).over(Twice(k as f64, 0.0)));
        k -= 2;
    }
    sum.times(s)
}

/// Returns `ln x` as a sum, for a positive normal number; `more` is added to k.
#[inline(always)]
fn ln_as_sum(x: f64, more: f64) -> [f64; 2] {
    let above = x.to_bits().wrapping_sub(LEAST);
    let Piece { reciprocal, ln } = PIECES[(above >> PLACE_BITS) as usize & 127];
    let shifted = above.wrapping_add(ONE);
    let k = f64::from_bits(shifted >> 52 | WHOLE.to_bits()) - (WHOLE + 1023.0) + more;
    let m = f64::from_bits((shifted & FRACTION) + LEAST);

    // f = upper m/c − 1 + rest of m/c, rounded, and what that loses
    let upper = upper_half(m);
    let (a, b) = (upper * reciprocal - 1.0, (m - upper) * reciprocal);
    // where the second is the larger, both are so small that the sum is exact
    let [f, f_rest] = rounded([a, b]);
    let [half, half_rest] = half_square(f);
    let f2 = f * f;
    let l = (L[0] + f * L[1]) + f2 * ((L[2] + f * L[3]) + f2 * (L[4] + f * L[5]));

    let constant = k * LN_2_PARTS[0] + ln.0;
    let [sum, lost] = rounded([constant, f]);
    let [sum, lost_too] = rounded([sum, -half]);
    let rest = (k * LN_2_PARTS[1] + ln.1) + (lost + lost_too);
    [
        sum,
        rest + ((f_rest - (half_rest + f_rest * f)) + (f * f2) * l),
    ]
}

/// Returns whether a number is positive and normal.
#[expect(
    clippy::manual_range_contains,
    reason = "no short cut: this must become vector instructions"
)]
#[inline(always)]
fn is_positive_and_normal(x: f64) -> bool {
    (x >= f64::MIN_POSITIVE) & (x <= f64::MAX)
}

/// Returns the logarithm of a number that is no positive normal one; `of` adds to k.
fn far_logarithm(x: f64, of: impl Fn(f64, f64) -> f64) -> f64 {
    if x == 0.0 {
        f64::NEG_INFINITY
    } else if x < 0.0 {
        f64::NAN
    } else if x < f64::MIN_POSITIVE {
        of(x * WHOLE, -52.0)
    } else {
        x
    }
}

#[inline(always)]
fn ln(x: f64, more: f64) -> f64 {
    let [sum, rest] = ln_as_sum(x, more);
    sum + rest
}

impl Elementary for Ln {
    type Argument = f64;
    #[inline(always)]
    fn is_usual(x: f64) -> bool {
        is_positive_and_normal(x)
    }
    #[inline(always)]
    fn near(x: f64) -> f64 {
        ln(x, 0.0)
    }
    #[cold]
    fn far(x: f64) -> f64 {
        far_logarithm(x, ln)
    }
}

/// 1/ln 10 in two parts: 26 bits, and the rest.
const LOG10_E_PARTS: [f64; 2] = [0.434_294_477_105_140_7, 4.798_111_141_615_973e-9];

#[inline(always)]
fn log10(x: f64, more: f64) -> f64 {
    let [sum, rest] = rounded(ln_as_sum(x, more));
    let upper = upper_half(sum);
    // the first product is exact
    let first = upper * LOG10_E_PARTS[0];
    first + (upper * LOG10_E_PARTS[1] + ((sum - upper) + rest) * LOG10_E)
}

impl Elementary for Log10 {
    type Argument = f64;
    #[inline(always)]
    fn is_usual(x: f64) -> bool {
        is_positive_and_normal(x)
    }
    #[inline(always)]
    fn near(x: f64) -> f64 {
        log10(x, 0.0)
    }
    #[cold]
    fn far(x: f64) -> f64 {
        far_logarithm(x, log10)
    }
}

/// Returns `e ln x` as a sum, for a positive normal base; `more` is added to k.
#[inline(always)]
fn exponent_of_power(x: f64, more: f64, e: f64) -> [f64; 2] {
    let [ln, rest] = rounded(ln_as_sum(x, more));
    let product = e * ln;
    [product, lost_in_product(e, ln, product) + e * rest]
}

/// Returns the power of any positive base.
fn far_from_positive(x: f64, e: f64) -> f64 {
    let [product, rest] = match x < f64::MIN_POSITIVE {
        true => exponent_of_power(x * WHOLE, -52.0, e),
        false => exponent_of_power(x, 0.0, e),
    };
    // where the product is no number its rest counts for nothing
    far_of_sum(product, if rest.is_finite() { rest } else { 0.0 })
}

impl Elementary for Power {
    type Argument = [f64; 2];
    #[inline(always)]
    fn is_usual([x, e]: [f64; 2]) -> bool {
        // |e ln x| ≤ 708 if |e| (|k| + 1) ln 2 is; an exponent not so small that parts are lost
        let k = f64::from_bits(x.to_bits() >> 52 | WHOLE.to_bits()) - (WHOLE + 1023.0);
        let (most, least) = (MOST_USUAL / std::f64::consts::LN_2, 1e-100);
        is_positive_and_normal(x) & ((k.abs() + 1.0) * e.abs() <= most) & (e.abs() >= least)
    }
    #[inline(always)]
    fn near([x, e]: [f64; 2]) -> f64 {
        let [product, rest] = exponent_of_power(x, 0.0, e);
        near_of_sum(product, rest)
    }
    #[cold]
    fn far([x, e]: [f64; 2]) -> f64 {
        if e == 0.0 || x == 1.0 {
            return 1.0;
        }
        if x.is_nan() || e.is_nan() {
            return f64::NAN;
        }
        let is_whole = e.trunc() == e;
        // doubles beyond 2⁵³ are even
        let is_odd = is_whole && e.abs() < 2.0 * WHOLE && (e.abs() as u64) & 1 == 1;
        let magnitude = x.abs();
        let positive = if magnitude == 0.0 || magnitude == f64::INFINITY || e.is_infinite() {
            // grows beyond all bounds, vanishes, or stays one
            match (magnitude > 1.0) == (e > 0.0) {
                _ if magnitude == 1.0 => 1.0,
                true => f64::INFINITY,
                false => 0.0,
            }
        } else {
            far_from_positive(magnitude, e)
        };
        if x.is_sign_positive() {
            positive
        } else if is_odd {
            -positive
        } else if is_whole || e.is_infinite() || magnitude == 0.0 || magnitude == f64::INFINITY {
            positive
        } else {
            f64::NAN
        }
    }
}
