//! Functions of plain numbers: one formula for one number and for several side by side.
//!
//! Each function has a formula without branches that holds for the usual arguments, and another
//! way for the rest (poles, overflow, numbers that are not normal). Several numbers go through the
//! first one in vector instructions where all are usual; a single number takes the same way, so
//! that value, batch, derivative and translated code have the same bits. The formulas add,
//! multiply, divide and take roots and nothing else, each rounded once: the bits are the same on
//! every machine. Fused products are not used, because not every machine has them.
//!
//! The last rounding of a result costs half a unit in the last place. The formulas carry the lost
//! parts of what they subtract and multiply, so that what comes before it adds a twentieth
//! (exponentials, logarithms, powers) to a third (tangents). Tests compare with correctly rounded
//! functions.

/// A function with a formula without branches for the usual arguments.
pub(super) trait Elementary {
    /// One number, or two.
    type Argument: Copy;
    /// Returns whether [`Elementary::near`] holds; it does for every argument unless this says
    /// otherwise.
    #[inline(always)]
    fn is_usual(_: Self::Argument) -> bool {
        true
    }
    /// Returns the value for a usual argument, without any branch.
    fn near(x: Self::Argument) -> f64;
    /// Returns the value for any other argument.
    fn far(x: Self::Argument) -> f64 {
        Self::near(x)
    }
}

/// Returns the value for any argument.
#[inline(always)]
pub(super) fn one<F: Elementary>(x: F::Argument) -> f64 {
    if F::is_usual(x) {
        F::near(x)
    } else {
        F::far(x)
    }
}

/// Returns the values for several arguments, in parallel where all are usual, with the same bits.
#[inline(always)]
pub(super) fn several<F: Elementary, const N: usize>(
    argument: impl Fn(usize) -> F::Argument,
) -> [f64; N] {
    let mut values = [0.0; N];
    // no short cut: this must become vector instructions
    let mut all_usual = true;
    for k in 0..N {
        all_usual &= F::is_usual(argument(k));
    }
    if all_usual {
        for (k, value) in values.iter_mut().enumerate() {
            *value = F::near(argument(k));
        }
    } else {
        for (k, value) in values.iter_mut().enumerate() {
            *value = one::<F>(argument(k));
        }
    }
    values
}

/// 1.5 · 2⁵²: added to a number it rounds it to a whole one, whose bits end the sum.
pub(super) const ROUND_TO_WHOLE: f64 = 6_755_399_441_055_744.0;

/// Returns the number without the lower half of its digits.
#[inline(always)]
pub(super) const fn upper_half(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & 0xFFFF_FFFF_F800_0000)
}

/// Returns `a b − product`, which rounding has lost.
#[inline(always)]
pub(super) const fn lost_in_product(a: f64, b: f64, product: f64) -> f64 {
    let (a1, b1) = (upper_half(a), upper_half(b));
    let (a2, b2) = (a - a1, b - b1);
    ((a1 * b1 - product) + (a1 * b2 + a2 * b1)) + a2 * b2
}

/// Returns half the square of a number, as a sum.
#[inline(always)]
pub(super) fn half_square(x: f64) -> [f64; 2] {
    let upper = upper_half(x);
    [0.5 * upper * upper, 0.5 * ((x - upper) * (x + upper))]
}

/// Returns the same sum with its first part rounded, where the first part is not the smaller.
#[inline(always)]
pub(super) const fn rounded([first, second]: [f64; 2]) -> [f64; 2] {
    let sum = first + second;
    [sum, (first - sum) + second]
}

/// Returns the quotient of two sums, as a sum.
#[inline(always)]
pub(super) fn quotient([n, n2]: [f64; 2], [d, d2]: [f64; 2]) -> [f64; 2] {
    let reciprocal = 1.0 / d;
    let q = n * reciprocal;
    let product = q * d;
    let rest = ((n - product) - lost_in_product(q, d, product)) + (n2 - q * d2);
    [q, rest * reciprocal]
}

/// Numbers of twice as many digits, with which tables are made when the program is compiled.
#[derive(Clone, Copy)]
pub(super) struct Twice(pub(super) f64, pub(super) f64);

impl Twice {
    pub(super) const fn sum(a: f64, b: f64) -> Self {
        let sum = a + b;
        let part = sum - a;
        Self(sum, (a - (sum - part)) + (b - part))
    }
    pub(super) const fn plus(self, b: Self) -> Self {
        let Self(sum, lost) = Self::sum(self.0, b.0);
        Self::sum(sum, lost + (self.1 + b.1))
    }
    pub(super) const fn times(self, b: Self) -> Self {
        let product = self.0 * b.0;
        let lost = lost_in_product(self.0, b.0, product);
        Self::sum(product, lost + (self.0 * b.1 + self.1 * b.0))
    }
    pub(super) const fn over(self, b: Self) -> Self {
        let q = self.0 / b.0;
        let product = q * b.0;
        let rest = ((self.0 - product) - lost_in_product(q, b.0, product)) + (self.1 - q * b.1);
        Self::sum(q, rest / b.0)
    }
}
