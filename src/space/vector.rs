//! Three-vectors, 3×3 matrices and frames over any scalar.

use crate::scalar::Scalar;
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// Returns an array of three. `array::from_fn` does the same by a machinery of guards and iterators
/// that is compiled anew for every closure and every number.
#[inline(always)]
fn three<T>(of: impl Fn(usize) -> T) -> [T; 3] {
    [of(0), of(1), of(2)]
}

/// A vector with three components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vec3<S>(pub [S; 3]);

impl<S: Scalar> Vec3<S> {
    /// Creates a vector from its components.
    #[inline(always)]
    pub fn new(x: S, y: S, z: S) -> Self {
        Self([x, y, z])
    }
    /// Returns the zero vector.
    #[inline(always)]
    pub fn zero() -> Self {
        Self([S::zero(); 3])
    }
    /// Returns the unit vector of axis `k` (0 x, 1 y, 2 z).
    #[inline(always)]
    pub fn axis(k: usize) -> Self {
        Self(three(|i| if i == k { S::one() } else { S::zero() }))
    }
    /// Converts a constant vector.
    #[inline(always)]
    pub fn constant(v: Vec3<f64>) -> Self {
        Self(three(|k| S::constant(v.0[k])))
    }
    /// Returns the scalar product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> S {
        self.0[0] * b.0[0] + self.0[1] * b.0[1] + self.0[2] * b.0[2]
    }
    /// Returns the vector product.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        let (a, b) = (self.0, b.0);
        Self([
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ])
    }
    /// Multiplies by a number.
    #[inline(always)]
    pub fn times(self, s: S) -> Self {
        Self(three(|k| self.0[k] * s))
    }
    /// Returns the squared length.
    #[inline(always)]
    pub fn norm2(self) -> S {
        self.dot(self)
    }
    /// Returns the length.
    #[inline(always)]
    pub fn norm(self) -> S {
        self.norm2().sqrt()
    }
}

impl<S: Scalar> Add for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self(three(|k| self.0[k] + b.0[k]))
    }
}
impl<S: Scalar> Sub for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self(three(|k| self.0[k] - b.0[k]))
    }
}
impl<S: Scalar> Neg for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(three(|k| -self.0[k]))
    }
}
impl<S: Scalar> AddAssign for Vec3<S> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
impl<S: Scalar> SubAssign for Vec3<S> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl<S: Scalar> Default for Vec3<S> {
    fn default() -> Self {
        Self::zero()
    }
}

/// A 3×3 matrix, stored by rows: `m.0[row][column]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mat3<S>(pub [[S; 3]; 3]);

impl<S: Scalar> Mat3<S> {
    /// Returns the unit matrix.
    #[inline(always)]
    pub fn identity() -> Self {
        Self::diagonal(S::one(), S::one(), S::one())
    }
    /// Returns the zero matrix.
    #[inline(always)]
    pub fn zero() -> Self {
        Self([[S::zero(); 3]; 3])
    }
    /// Returns a diagonal matrix.
    #[inline(always)]
    pub fn diagonal(x: S, y: S, z: S) -> Self {
        let o = S::zero();
        Self([[x, o, o], [o, y, o], [o, o, z]])
    }
    /// Creates a matrix from its columns.
    #[inline(always)]
    pub fn from_columns(x: Vec3<S>, y: Vec3<S>, z: Vec3<S>) -> Self {
        Self(three(|i| [x.0[i], y.0[i], z.0[i]]))
    }
    /// Converts a constant matrix.
    #[inline(always)]
    pub fn constant(m: Mat3<f64>) -> Self {
        Self(three(|i| three(|j| S::constant(m.0[i][j]))))
    }
    /// Returns column `k`: for a rotation `R_GM`, axis `k` of M in G.
    #[inline(always)]
    pub fn column(&self, k: usize) -> Vec3<S> {
        Vec3([self.0[0][k], self.0[1][k], self.0[2][k]])
    }
    /// Returns row `k`.
    #[inline(always)]
    pub fn row(&self, k: usize) -> Vec3<S> {
        Vec3(self.0[k])
    }
    /// Returns the transpose; for a rotation, the inverse.
    #[inline(always)]
    pub fn transpose(&self) -> Self {
        Self(three(|i| three(|j| self.0[j][i])))
    }
    /// Returns `self · v`.
    #[inline(always)]
    pub fn apply(&self, v: Vec3<S>) -> Vec3<S> {
        Vec3(three(|i| self.row(i).dot(v)))
    }
    /// Returns `selfᵀ · v`.
    #[inline(always)]
    pub fn apply_transposed(&self, v: Vec3<S>) -> Vec3<S> {
        Vec3(three(|i| self.column(i).dot(v)))
    }
    /// Returns the matrix of the cross product: `cross_matrix(a) b = a × b`.
    #[inline(always)]
    pub fn cross_matrix(a: Vec3<S>) -> Self {
        let [x, y, z] = a.0;
        let o = S::zero();
        Self([[o, -z, y], [z, o, -x], [-y, x, o]])
    }
    /// Multiplies by a number.
    #[inline(always)]
    pub fn times(&self, s: S) -> Self {
        Self(three(|i| three(|j| self.0[i][j] * s)))
    }
}

impl<S: Scalar> Mul for Mat3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self(three(|i| three(|j| self.row(i).dot(b.column(j)))))
    }
}
impl<S: Scalar> Add for Mat3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self(three(|i| three(|j| self.0[i][j] + b.0[i][j])))
    }
}
impl<S: Scalar> Sub for Mat3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self(three(|i| three(|j| self.0[i][j] - b.0[i][j])))
    }
}

/// A pose `X_GM`: orientation `R_GM` and position `p_GM` of M in G.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<S> {
    /// orientation; the columns are the axes of M in G
    pub rotation: Mat3<S>,
    /// position of M's origin from G's, in G
    pub position: Vec3<S>,
}

impl<S: Scalar> Frame<S> {
    /// Returns the frame aligned with the reference, at its origin.
    pub fn identity() -> Self {
        Self {
            rotation: Mat3::identity(),
            position: Vec3::zero(),
        }
    }
    /// Converts a constant frame.
    pub fn constant(f: Frame<f64>) -> Self {
        Self {
            rotation: Mat3::constant(f.rotation),
            position: Vec3::constant(f.position),
        }
    }
    /// Composes `X_GP · X_PM = X_GM`.
    #[inline(always)]
    pub fn compose(&self, inner: &Self) -> Self {
        Self {
            rotation: self.rotation * inner.rotation,
            position: self.point(inner.position),
        }
    }
    /// Returns the pose of G in M.
    pub fn inverse(&self) -> Self {
        Self {
            rotation: self.rotation.transpose(),
            position: -self.rotation.apply_transposed(self.position),
        }
    }
    /// Returns a point of M, expressed in G.
    #[inline(always)]
    pub fn point(&self, p: Vec3<S>) -> Vec3<S> {
        self.position + self.rotation.apply(p)
    }
}
