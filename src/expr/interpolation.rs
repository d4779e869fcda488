//! TABLE of functions that look data up by identifier: AKISPL, CUBSPL, INTERP, CURVE, INVPSD.

/// A function over data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// Akima spline: AKISPL(x, z, id[, iord])
    Akispl,
    /// cubic spline: CUBSPL(x, z, id[, iord])
    Cubspl,
    /// time series: INTERP(x, method, id[, iord])
    Interp,
    /// component of a curve: CURVE(alpha, iord, comp, id)
    Curve,
    /// random signal with given spectrum: INVPSD(x, id, f0, f1, nf, linlog, seed)
    Invpsd,
}
