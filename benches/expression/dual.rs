//! Hand-written forward duals, and the functions of the language as one would write them natively, over both.
// the product rule is a sum
#![allow(clippy::suspicious_arithmetic_impl)]

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value and `N` derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Forward<const N: usize> {
    pub re: f64,
    pub eps: [f64; N],
}

impl<const N: usize> Forward<N> {
    #[inline(always)]
    pub fn variable(re: f64, k: usize) -> Self {
        let mut eps = [0.0; N];
        eps[k] = 1.0;
        Self { re, eps }
    }
    #[inline(always)]
    fn chain(self, re: f64, slope: f64) -> Self {
        Self {
            re,
            eps: self.eps.map(|e| slope * e),
        }
    }
}

/// What the native functions need of a number.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    fn constant(x: f64) -> Self;
    fn re(self) -> f64;
    fn power(self, e: f64) -> Self;
    fn cosine(self) -> Self;
    fn squared(self) -> Self {
        self * self
    }
}

impl Real for f64 {
    #[inline(always)]
    fn constant(x: f64) -> f64 {
        x
    }
    #[inline(always)]
    fn re(self) -> f64 {
        self
    }
    #[inline(always)]
    fn power(self, e: f64) -> f64 {
        self.powf(e)
    }
    #[inline(always)]
    fn cosine(self) -> f64 {
        self.cos()
    }
}

impl<const N: usize> Real for Forward<N> {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self {
            re: x,
            eps: [0.0; N],
        }
    }
    #[inline(always)]
    fn re(self) -> f64 {
        self.re
    }
    #[inline(always)]
    fn power(self, e: f64) -> Self {
        let p = self.re.powf(e);
        self.chain(p, e * p / self.re)
    }
    #[inline(always)]
    fn cosine(self) -> Self {
        self.cos()
    }
}

impl<const N: usize> Forward<N> {
    #[inline(always)]
    pub fn sin(self) -> Self {
        let (s, c) = self.re.sin_cos();
        self.chain(s, c)
    }
    #[inline(always)]
    pub fn cos(self) -> Self {
        let (s, c) = self.re.sin_cos();
        self.chain(c, -s)
    }
    #[inline(always)]
    pub fn tan(self) -> Self {
        let t = self.re.tan();
        self.chain(t, 1.0 + t * t)
    }
    #[inline(always)]
    pub fn atan(self) -> Self {
        self.chain(self.re.atan(), 1.0 / (1.0 + self.re * self.re))
    }
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let r = self.re.sqrt();
        self.chain(r, 0.5 / r)
    }
    #[inline(always)]
    pub fn abs(self) -> Self {
        if self.re < 0.0 { -self } else { self }
    }
}

macro_rules! operator {
    ($trait:ident $f:ident, |$a:ident, $b:ident| $re:expr, |$x:ident, $y:ident| $eps:expr) => {
        impl<const N: usize> $trait for Forward<N> {
            type Output = Self;
            #[inline(always)]
            fn $f(self, other: Self) -> Self {
                let ($a, $b) = (self.re, other.re);
                Self {
                    re: $re,
                    eps: std::array::from_fn(|k| {
                        let ($x, $y) = (self.eps[k], other.eps[k]);
                        $eps
                    }),
                }
            }
        }
    };
}
operator!(Add add, |a, b| a + b, |x, y| x + y);
operator!(Sub sub, |a, b| a - b, |x, y| x - y);
operator!(Mul mul, |a, b| a * b, |x, y| x * b + a * y);
impl<const N: usize> Div for Forward<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let w = 1.0 / other.re;
        let q = self.re * w;
        Self {
            re: q,
            eps: std::array::from_fn(|k| (self.eps[k] - q * other.eps[k]) * w),
        }
    }
}
impl<const N: usize> Neg for Forward<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            re: -self.re,
            eps: self.eps.map(|e| -e),
        }
    }
}
impl<const N: usize> Add<f64> for Forward<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, c: f64) -> Self {
        Self {
            re: self.re + c,
            ..self
        }
    }
}
impl<const N: usize> Sub<f64> for Forward<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, c: f64) -> Self {
        Self {
            re: self.re - c,
            ..self
        }
    }
}
impl<const N: usize> Mul<f64> for Forward<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, c: f64) -> Self {
        self.chain(self.re * c, c)
    }
}
impl<const N: usize> Div<f64> for Forward<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, c: f64) -> Self {
        self.chain(self.re / c, 1.0 / c)
    }
}
impl<const N: usize> Add<Forward<N>> for f64 {
    type Output = Forward<N>;
    #[inline(always)]
    fn add(self, x: Forward<N>) -> Forward<N> {
        x + self
    }
}
impl<const N: usize> Sub<Forward<N>> for f64 {
    type Output = Forward<N>;
    #[inline(always)]
    fn sub(self, x: Forward<N>) -> Forward<N> {
        -x + self
    }
}
impl<const N: usize> Mul<Forward<N>> for f64 {
    type Output = Forward<N>;
    #[inline(always)]
    fn mul(self, x: Forward<N>) -> Forward<N> {
        x * self
    }
}

#[inline(always)]
pub fn step<R: Real>(x: R, x0: f64, h0: f64, x1: f64, h1: f64) -> R {
    if x.re() <= x0 {
        R::constant(h0)
    } else if x.re() >= x1 {
        R::constant(h1)
    } else {
        let u = (x - x0) / (x1 - x0);
        u * u * (u * -2.0 + 3.0) * (h1 - h0) + h0
    }
}

#[inline(always)]
pub fn impact<R: Real>(x: R, v: R, x1: f64, k: f64, e: f64, cmax: f64, d: f64) -> R {
    if x.re() >= x1 {
        return R::constant(0.0);
    }
    let force = (-x + x1).power(e) * k - step(x, x1 - d, cmax, x1, 0.0) * v;
    if force.re() > 0.0 {
        force
    } else {
        R::constant(0.0)
    }
}

#[allow(clippy::too_many_arguments)]
#[inline(always)]
pub fn bistop<R: Real>(x: R, v: R, x1: f64, x2: f64, k: f64, e: f64, cmax: f64, d: f64) -> R {
    if x.re() < x1 {
        let force = (-x + x1).power(e) * k - step(x, x1 - d, cmax, x1, 0.0) * v;
        if force.re() > 0.0 {
            force
        } else {
            R::constant(0.0)
        }
    } else if x.re() > x2 {
        let force = (x - x2).power(e) * -k - step(x, x2, 0.0, x2 + d, cmax) * v;
        if force.re() < 0.0 {
            force
        } else {
            R::constant(0.0)
        }
    } else {
        R::constant(0.0)
    }
}

#[inline(always)]
pub fn cheby<R: Real, const M: usize>(x: R, x0: f64, a: &[f64; M]) -> R {
    let y = x - x0;
    let (mut t0, mut t1) = (R::constant(1.0), y);
    let mut sum = y * a[1] + a[0];
    for &c in &a[2..] {
        (t0, t1) = (t1, y * t1 * 2.0 - t0);
        sum = sum + t1 * c;
    }
    sum
}

#[inline(always)]
pub fn forcos<R: Real, const M: usize>(x: R, x0: f64, w: f64, a: &[f64; M]) -> R {
    let theta = (x - x0) * w;
    let mut sum = R::constant(a[0]);
    for (j, &c) in a.iter().enumerate().skip(1) {
        sum = sum + (theta * j as f64).cosine() * c;
    }
    sum
}

#[inline(always)]
pub fn if3<R: Real>(
    s: R,
    negative: impl FnOnce() -> R,
    zero: impl FnOnce() -> R,
    positive: impl FnOnce() -> R,
) -> R {
    if s.re() < 0.0 {
        negative()
    } else if s.re() == 0.0 {
        zero()
    } else {
        positive()
    }
}
