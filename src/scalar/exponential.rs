//! The exponential function, and sine, cosine and tangent of hyperbolas.
//!
//! ```text
//! x = (n + j/64) ln 2 + r + ρ       |r| ≤ ln 2/128; ρ: the part of the remainder that r cannot hold
//! exp x = 2ⁿ 2^(j/64) (1 + r + r² E(r))
//!
//! x = n ln 2 + r + ρ,  x ≥ 0        |r| ≤ ln 2/2
//! 2 sinh x = 2ⁿ (1 + r) − 2⁻ⁿ (1 − r) + (2ⁿ + 2⁻ⁿ) s + (2ⁿ − 2⁻ⁿ) c      s = sinh r − r
//! 2 cosh x = 2ⁿ (1 + r) + 2⁻ⁿ (1 − r) + (2ⁿ + 2⁻ⁿ) c + (2ⁿ − 2⁻ⁿ) s      c = cosh r − 1
//! ```
//!
//! E, s and c are minimax polynomials with relative errors of 1e-18 and less; the powers 2^(j/64)
//! stand in a table of twice as many digits.

use super::elementary::{Elementary, ROUND_TO_WHOLE, Twice, quotient, rounded};
use std::f64::consts::LOG2_E;

/// The exponential function.
pub(super) struct Exp;
/// The hyperbolic sine.
pub(super) struct Sinh;
/// The hyperbolic cosine.
pub(super) struct Cosh;
/// The hyperbolic tangent.
pub(super) struct Tanh;

/// Largest magnitude whose exponential, and that of the negative, is a normal number.
pub(super) const MOST_USUAL: f64 = 708.0;

/// ln 2 in two parts: 42 bits, and the rest.
pub(super) const LN_2_PARTS: [f64; 2] = [0.693_147_180_559_890_3, 5.497_923_018_708_371e-14];

/// ln 2 / 64 in two parts: 36 bits, and the rest.
const STEP_PARTS: [f64; 2] = [0.010_830_424_696_223_417, 2.572_804_622_327_669e-14];
/// 64 / ln 2
const STEPS_PER_UNIT: f64 = 92.332_482_616_893_66;

/// Coefficients of E: (exp r − 1 − r)/r² over r.
const E: [f64; 4] = [
    0.499_999_999_999_485_63,
    0.166_666_666_666_852_65,
    0.041_666_723_416_096_244,
    0.008_333_331_290_157_762,
];

/// 2^(j/64), in two parts.
static POWERS: [Twice; 64] = powers();

const fn powers() -> [Twice; 64] {
    let ln_2 = Twice(std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);
    let mut powers = [Twice(1.0, 0.0); 64];
    let mut j = 1;
    while j < 64 {
        let x = ln_2.times(Twice(j as f64 / 64.0, 0.0));
        // 1 + x (1 + x/2 (1 + x/3 …
        let mut sum = Twice(1.0, 0.0);
        let mut k = 30;
        while k > 0 {
            let factor = x.over(Twice(k as f64, 0.0));
            sum = Twice(1.0, 0.0).plus(factor.times(sum));
            k -= 1;
        }
        powers[j] = sum;
        j += 1;
    }
    powers
}

/// Returns a number near one and, in its last twelve bits, the power of two that goes with it:
/// together the exponential of `x + more`, where `more` is a small part of a unit in the last place
/// of `x`.
#[inline(always)]
fn parts(x: f64, more: f64) -> (f64, u64) {
    let shifted = x * STEPS_PER_UNIT + ROUND_TO_WHOLE;
    let n = shifted - ROUND_TO_WHOLE;
    // the product with the first part is exact, and so is this difference
    let (a, b) = (x - n * STEP_PARTS[0], n * STEP_PARTS[1]);
    let r = a - b;
    let rho = ((a - r) - b) + more;
    let e = E[0] + r * (E[1] + r * (E[2] + r * E[3]));
    let less_one = r + (rho + r * (rho + r * e));
    let bits = shifted.to_bits();
    let Twice(power, rest) = POWERS[(bits & 63) as usize];
    (power + (rest + power * less_one), bits >> 6)
}

/// Returns the exponential of `x + more`, of a magnitude up to [`MOST_USUAL`].
#[inline(always)]
pub(super) fn near_of_sum(x: f64, more: f64) -> f64 {
    let (near_one, n) = parts(x, more);
    f64::from_bits(near_one.to_bits().wrapping_add(n << 52))
}

/// Returns the exponential of any sum.
#[cold]
pub(super) fn far_of_sum(x: f64, more: f64) -> f64 {
    // beyond these bounds it is zero or infinite
    let bounded = x.clamp(-800.0, 800.0);
    let (near_one, n) = parts(bounded, if bounded == x { more } else { 0.0 });
    // n in its last twelve bits; its power of two in two factors, each of which is normal
    let n = (n << 52) as i64 >> 52;
    let half = n >> 1;
    near_one * power_of_two(half) * power_of_two(n - half)
}

/// Returns 2ⁿ, a normal number.
fn power_of_two(n: i64) -> f64 {
    f64::from_bits(((n + 1023) as u64) << 52)
}

impl Elementary for Exp {
    type Argument = f64;
    #[inline(always)]
    fn is_usual(x: f64) -> bool {
        x.abs() <= MOST_USUAL
    }
    #[inline(always)]
    fn near(x: f64) -> f64 {
        near_of_sum(x, 0.0)
    }
    fn far(x: f64) -> f64 {
        far_of_sum(x, 0.0)
    }
}

/// Coefficients of (cosh r − 1 − z/2)/z² over z = r².
const C: [f64; 5] = [
    0.041_666_666_666_666_685,
    0.001_388_888_888_887_347_9,
    2.480_158_734_875_344_7e-5,
    2.755_725_224_339_241e-7,
    2.092_162_832_887_228_4e-9,
];

/// Coefficients of (sinh r/r − 1)/z over z = r².
const S: [f64; 5] = [
    0.166_666_666_666_666_77,
    0.008_333_333_333_321_705,
    0.000_198_412_698_859_738_3,
    2.755_724_434_008_545_3e-6,
    2.510_899_701_184_936_5e-8,
];

/// Bits of one.
const ONE: u64 = 0x3FF0_0000_0000_0000;

/// Returns `2 sinh x` and `2 cosh x` as sums, both times 2^−`lowered`; x ≥ 0, and so large that
/// exp(−x) does not count where anything is lowered.
#[inline(always)]
fn twice_hyperbolic(x: f64, lowered: u64) -> [[f64; 2]; 2] {
    let shifted = x * LOG2_E + ROUND_TO_WHOLE;
    let n = shifted - ROUND_TO_WHOLE;
    let (a, b) = (x - n * LN_2_PARTS[0], n * LN_2_PARTS[1]);
    let r = a - b;
    let rho = (a - r) - b;

    let z = r * r;
    let z2 = z * z;
    let c = 0.5 * z + z2 * ((C[0] + z * C[1]) + z2 * ((C[2] + z * C[3]) + z2 * C[4]));
    let s = r * z * ((S[0] + z * S[1]) + z2 * ((S[2] + z * S[3]) + z2 * S[4]));
    let (c, s) = (c + rho * r, s + rho * (1.0 + 0.5 * z));

    let bits = shifted.to_bits().wrapping_sub(lowered) << 52;
    let rising = f64::from_bits(ONE.wrapping_add(bits));
    let falling = f64::from_bits(ONE.wrapping_sub(bits));
    let (more, less) = (1.0 + r, 1.0 - r);
    let (more_rest, less_rest) = (r - (more - 1.0), (1.0 - less) - r);
    let (e, e_rest) = (rising * more, rising * more_rest);
    let (f, f_rest) = (falling * less, falling * less_rest);
    let (both, excess) = (rising + falling, rising - falling);
    let [sine, sine_rest] = rounded([e, -f]);
    let [cosine, cosine_rest] = rounded([e, f]);
    [
        [
            sine,
            (sine_rest + (e_rest - f_rest)) + (both * s + excess * c),
        ],
        [
            cosine,
            (cosine_rest + (e_rest + f_rest)) + (both * c + excess * s),
        ],
    ]
}

/// Returns hyperbolic sine and cosine of a large number, or infinity.
fn large_hyperbolic(x: f64) -> [f64; 2] {
    // beyond the bound both are infinite
    let raise = f64::from_bits(ONE + (63 << 52));
    twice_hyperbolic(if x > 720.0 { 720.0 } else { x }, 64).map(|[a, b]| (a + b) * raise)
}

impl Elementary for Sinh {
    type Argument = f64;
    #[inline(always)]
    fn is_usual(x: f64) -> bool {
        x.abs() <= MOST_USUAL
    }
    #[inline(always)]
    fn near(x: f64) -> f64 {
        let [[sine, rest], _] = twice_hyperbolic(x.abs(), 0);
        (0.5 * (sine + rest)).copysign(x)
    }
    #[cold]
    fn far(x: f64) -> f64 {
        large_hyperbolic(x.abs())[0].copysign(x)
    }
}

impl Elementary for Cosh {
    type Argument = f64;
    #[inline(always)]
    fn is_usual(x: f64) -> bool {
        x.abs() <= MOST_USUAL
    }
    #[inline(always)]
    fn near(x: f64) -> f64 {
        let [_, [cosine, rest]] = twice_hyperbolic(x.abs(), 0);
        0.5 * (cosine + rest)
    }
    #[cold]
    fn far(x: f64) -> f64 {
        large_hyperbolic(x.abs())[1]
    }
}

impl Elementary for Tanh {
    type Argument = f64;
    #[inline(always)]
    fn near(x: f64) -> f64 {
        // from 22 on it is one to the last digit
        let magnitude = x.abs();
        let magnitude = if magnitude > 22.0 { 22.0 } else { magnitude };
        let [sine, cosine] = twice_hyperbolic(magnitude, 0);
        let [tangent, rest] = quotient(rounded(sine), rounded(cosine));
        (tangent + rest).copysign(x)
    }
}
