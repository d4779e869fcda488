//! Angles of any size without their quarter turns, by whole numbers alone.
//!
//! ```text
//! |x| = m 2ᵉ, m whole          2/π = 0.1010001011…₂
//! m 2ᵉ · 2/π = (4k) + n + f    digits of 2/π before 2^(2−e) make the whole turns 4k, and are left
//!                              out; of the 192 that follow, the product with m has n in its first
//!                              two digits, and f, −½ ≤ f < ½, in the others
//! ```
//!
//! Digits that are left out behind change f by 2⁻¹³⁷ at most, and no double but zero is nearer to a
//! multiple of π/2 than 2⁻⁶² of it: f has 66 right digits at least.

use super::elementary::Twice;
use std::f64::consts::FRAC_PI_2;

/// 2/π to 1216 binary digits, which the largest double needs, behind 64 zeros.
const TWO_OVER_PI: [u64; 20] = [
    0,
    0xa2f9_836e_4e44_1529,
    0xfc27_57d1_f534_ddc0,
    0xdb62_9599_3c43_9041,
    0xfe51_63ab_debb_c561,
    0xb724_6e3a_424d_d2e0,
    0x0649_2eea_09d1_921c,
    0xfe1d_eb1c_b129_a73e,
    0xe882_35f5_2ebb_4484,
    0xe99c_7026_b45f_7e41,
    0x3991_d639_8353_39f4,
    0x9c84_5f8b_bdf9_283b,
    0x1ff8_97ff_de05_980f,
    0xef2f_118b_5a0a_6d1f,
    0x6d36_7ecf_27cb_09b7,
    0x4f46_3f66_9e5f_ea2d,
    0x7527_bac7_ebe5_f17b,
    0x3d07_39f7_8a52_92ea,
    0x6bfb_5fb1_1f8d_5d08,
    0x5603_3046_fc7b_6bab,
];

/// π/2 − [`FRAC_PI_2`].
const HALF_PI_REST: f64 = 6.123_233_995_736_766e-17;

/// Bits of a double behind its first one.
const FRACTION_BITS: u32 = 52;

/// Returns the quarter turns of the size of an angle from 2¹³ rad on, in the last two bits, and the
/// angle that remains, in rad, as a sum; of an infinite one or of what is no number, not a number.
pub(super) fn of_size(x: f64) -> (u64, [f64; 2]) {
    if !x.is_finite() {
        return (0, [f64::NAN; 2]);
    }
    let bits = x.abs().to_bits();
    let mantissa = u128::from(bits & ((1 << FRACTION_BITS) - 1) | 1 << FRACTION_BITS);
    // e + 62, where the first digit that counts stands behind the zeros
    let exponent = (bits >> FRACTION_BITS) as usize;
    let place = exponent - (1023 + FRACTION_BITS as usize - 62);
    let digits = |k: usize| {
        let two = u128::from(TWO_OVER_PI[place / 64 + k]) << 64
            | u128::from(TWO_OVER_PI[place / 64 + k + 1]);
        (two << (place % 64) >> 64) as u64
    };
    // the product, without what is beyond its 192 digits
    let low = mantissa * u128::from(digits(2));
    let middle = mantissa * u128::from(digits(1)) + (low >> 64);
    let high = (mantissa * u128::from(digits(0)) + (middle >> 64)) as u64;
    let upper = u128::from(high) << 64 | u128::from(middle as u64);
    let n = (upper >> 126) as u64;
    let fraction = (upper << 2 | u128::from(low as u64) >> 62) as i128;
    let remainder = quarters(fraction.unsigned_abs());
    match fraction < 0 {
        true => (n + 1, remainder.map(|part| -part)),
        false => (n, remainder),
    }
}

/// Returns 2⁻¹²⁸ of a whole number of quarter turns, in rad.
fn quarters(fraction: u128) -> [f64; 2] {
    // it is not zero: no whole number is a multiple of π
    let zeros = fraction.leading_zeros();
    let digits = fraction.checked_shl(zeros).unwrap_or(0);
    let first = (digits >> 75) as f64;
    let second = ((digits >> 22) as u64 & ((1 << 53) - 1)) as f64;
    // 2⁻⁵³ less for the second; as powers of two these products are exact
    let scale = f64::from_bits(u64::from(1023 - 53 - zeros) << FRACTION_BITS);
    let turns = Twice::sum(first * scale, second * (scale * f64::EPSILON / 2.0));
    let Twice(r, rho) = turns.times(Twice(FRAC_PI_2, HALF_PI_REST));
    [r, rho]
}
