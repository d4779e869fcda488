//! Angles whose tangent, sine or cosine is known.
//!
//! ```text
//! atan(y/x) = c ± atan q            q = n/d, |q| ≤ tan(π/8):
//!     n = y,     d = x              c = 0        y ≤ x tan(π/8)
//!     n = y − x, d = y + x          c = π/4      between
//!     n = x,     d = y              c = π/2      x ≤ y tan(π/8)
//! atan q = q + q³ A(q²)
//!
//! asin x = x + x³ B(x²)                          |x| ≤ ½
//! asin x = π/2 − 2 asin s,   s² = (1 − |x|)/2    otherwise
//! ```
//!
//! A and B are minimax polynomials with relative errors of 5e-20 and 1e-18. Quotients and roots
//! are sums of two numbers.

use super::elementary::{Elementary, lost_in_product, quotient, rounded};

/// The arc tangent.
pub(super) struct Atan;
/// The angle of a point, given y and x.
pub(super) struct Atan2;
/// The arc sine.
pub(super) struct Asin;
/// The arc cosine.
pub(super) struct Acos;

/// π/4 in two parts; the first has three bits to spare for its multiples.
const EIGHTH_OF_TURN: [f64; 2] = [std::f64::consts::FRAC_PI_4, 3.061_616_997_868_383e-17];

/// tan(π/8)
const TAN_OF_SIXTEENTH: f64 = 0.414_213_562_373_095_03;

/// Coefficients of A: (atan q/q − 1)/z over z = q².
const A: [f64; 12] = [
    -0.333_333_333_333_333_26,
    0.199_999_999_999_977_1,
    -0.142_857_142_853_926_76,
    0.111_111_110_884_465_29,
    -0.090_909_081_536_710_41,
    0.076_922_829_561_976_71,
    -0.066_662_295_700_469_89,
    0.058_770_485_280_541_64,
    -0.052_185_721_952_964_88,
    0.045_042_174_180_872_43,
    -0.033_489_728_418_608_956,
    0.015_210_422_641_722_952,
];

/// Returns k π/4 plus an angle that is a sum.
#[inline(always)]
fn from_eighths(k: f64, [angle, angle_rest]: [f64; 2]) -> f64 {
    let [sum, lost] = rounded([k * EIGHTH_OF_TURN[0], angle]);
    sum + (lost + (angle_rest + k * EIGHTH_OF_TURN[1]))
}

/// Returns the angle of the point (x, y) for y ≥ 0.
#[inline(always)]
fn angle(y: f64, x: f64) -> f64 {
    let across = x.abs();
    let is_steep = y > across;
    let (n, d) = if is_steep { (across, y) } else { (y, across) };
    let is_between = n > TAN_OF_SIXTEENTH * d;
    let [sum, sum_rest] = rounded([d, n]);
    let [difference, difference_rest] = rounded([-d, n]);
    let [n, n_rest] = if is_between {
        [difference, difference_rest]
    } else {
        [n, 0.0]
    };
    let [d, d_rest] = if is_between {
        [sum, sum_rest]
    } else {
        [d, 0.0]
    };
    let [q, q_rest] = quotient([n, n_rest], [d, d_rest]);

    let z = q * q;
    let z2 = z * z;
    let z4 = z2 * z2;
    let a = (((A[0] + z * A[1]) + z2 * (A[2] + z * A[3]))
        + z4 * ((A[4] + z * A[5]) + z2 * (A[6] + z * A[7])))
        + (z4 * z4) * ((A[8] + z * A[9]) + z2 * (A[10] + z * A[11]));
    // the rest counts by the slope, 1/(1 + z)
    let rest = (q_rest - z * q_rest) + q * (z * a);

    // eighths of a turn, and the sense in which the rest counts
    let is_turned = x.is_sign_negative();
    let k = if is_between { 1.0 } else { 0.0 };
    let k = if is_steep { 2.0 - k } else { k };
    let k = if is_turned { 4.0 - k } else { k };
    let sense = if is_steep ^ is_turned { -1.0 } else { 1.0 };
    from_eighths(k, [sense * q, sense * rest])
}

impl Elementary for Atan {
    type Argument = f64;
    #[inline(always)]
    fn near(x: f64) -> f64 {
        // beyond, it is a right angle to the last digit
        let most = 1e18;
        let magnitude = x.abs();
        let magnitude = if magnitude > most { most } else { magnitude };
        angle(magnitude, 1.0).copysign(x)
    }
}

/// Between these bounds no part of a quotient or a product is lost.
const USUAL_LENGTHS: [f64; 2] = [1e-130, 1e150];

impl Elementary for Atan2 {
    /// y and x
    type Argument = [f64; 2];
    #[inline(always)]
    fn is_usual([y, x]: [f64; 2]) -> bool {
        let [least, most] = USUAL_LENGTHS;
        let (x, y) = (x.abs(), y.abs());
        (x <= most)
            & (y <= most)
            & ((x >= least) | (x == 0.0))
            & ((y >= least) | (y == 0.0))
            & (x + y > 0.0)
    }
    #[inline(always)]
    fn near([y, x]: [f64; 2]) -> f64 {
        angle(y.abs(), x).copysign(y)
    }
    #[cold]
    fn far([y, x]: [f64; 2]) -> f64 {
        if x.is_nan() || y.is_nan() {
            return f64::NAN;
        }
        let (across, up) = (x.abs(), y.abs());
        let most = across.max(up);
        if most == 0.0 {
            // the directions of the zeros
            return angle(0.0, 1f64.copysign(x)).copysign(y);
        }
        if most == f64::INFINITY {
            let of = |x: f64| if x == f64::INFINITY { 1.0 } else { 0.0 };
            return angle(of(up), of(across).copysign(x)).copysign(y);
        }
        // lengths of the same ratio, the larger between one and two
        let first = if most > 1.0 {
            0.5f64.powi(100)
        } else {
            2f64.powi(100)
        };
        let exponent = (most * first).to_bits() >> 52;
        let scale = f64::from_bits((2046 - exponent) << 52);
        let [across, up] = [across, up].map(|x| x * first * scale);
        if across.min(up) > 1e-100 {
            return angle(up, across.copysign(x)).copysign(y);
        }
        // one is nothing beside the other, except where the angle itself is as small
        match (up < across, x.is_sign_positive()) {
            (true, true) => y.abs() / x,
            (true, false) => angle(0.0, -1.0),
            (false, _) => angle(1.0, 0.0),
        }
        .copysign(y)
    }
}

/// Coefficients of B: (asin x/x − 1)/z over z = x².
const B: [f64; 13] = [
    0.166_666_666_666_667_63,
    0.074_999_999_999_702_65,
    0.044_642_857_175_117_66,
    0.030_381_942_683_756_376,
    0.022_372_215_656_576_37,
    0.017_351_600_156_937_156,
    0.013_980_960_678_877_422,
    0.011_397_782_325_659_396,
    0.010_786_493_115_545_507,
    0.003_683_180_142_961_295,
    0.021_763_155_591_849_97,
    -0.021_076_794_006_042_81,
    0.032_676_569_971_916_95,
];

/// Returns the arc sine of `x`, or where `x` is large that of √((1 − x)/2), as a sum; x ≥ 0.
#[inline(always)]
fn arc_sine(x: f64, is_large: bool) -> [f64; 2] {
    let z = if is_large { 0.5 * (1.0 - x) } else { x * x };
    let root = z.sqrt();
    let s = if is_large { root } else { x };
    let square = s * s;
    let lost = (z - square) - lost_in_product(s, s, square);
    // the divisor is not zero even at x = 1
    let root_rest = lost / (s + s + f64::MIN_POSITIVE);
    let s_rest = if is_large { root_rest } else { 0.0 };
    let z2 = z * z;
    let z4 = z2 * z2;
    let b = (((B[0] + z * B[1]) + z2 * (B[2] + z * B[3]))
        + z4 * ((B[4] + z * B[5]) + z2 * (B[6] + z * B[7])))
        + (z4 * z4) * (((B[8] + z * B[9]) + z2 * (B[10] + z * B[11])) + z4 * B[12]);
    [s, s_rest + s * (z * b)]
}

impl Elementary for Asin {
    type Argument = f64;
    #[inline(always)]
    fn near(x: f64) -> f64 {
        let is_large = x.abs() > 0.5;
        let arc = arc_sine(x.abs(), is_large);
        let k = if is_large { 2.0 } else { 0.0 };
        let times = if is_large { -2.0 } else { 1.0 };
        from_eighths(k, arc.map(|part| times * part)).copysign(x)
    }
}

impl Elementary for Acos {
    type Argument = f64;
    #[inline(always)]
    fn near(x: f64) -> f64 {
        let is_large = x.abs() > 0.5;
        let arc = arc_sine(x.abs(), is_large);
        let from_end = if x > 0.0 { 0.0 } else { 4.0 };
        let k = if is_large { from_end } else { 2.0 };
        let times = if is_large { 2.0 } else { 1.0 };
        let times = if (x > 0.0) == is_large { times } else { -times };
        from_eighths(k, arc.map(|part| times * part))
    }
}
