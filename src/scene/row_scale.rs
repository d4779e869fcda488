//! Scales of rows: residuals of lengths, angles and formulas are compared as parts of one.

use super::{RowKind, Scene};

impl Scene {
    /// Returns the residual of a row that counts as one: the size of the mechanism for lengths, a
    /// radian for angles.
    pub fn row_scale(&self, r: usize) -> f64 {
        match &self.rows[r].kind {
            RowKind::Markers { law, .. } if law.is_length() => self.length,
            RowKind::Markers { .. } => 1.0,
            RowKind::Displacements(sum) => sum.scale(self.length),
            RowKind::Formula { scale, .. } => *scale,
            RowKind::Cam { .. } => self.length,
        }
    }
}
