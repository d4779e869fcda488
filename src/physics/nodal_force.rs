//! NFORCE: the linear law of a FIELD for the displacements of many markers, all measured from one
//! marker J in its axes.
//!
//! | parameter | symbol | keyword | unit | default |
//! |---|---|---|---|---|
//! | stiffness | K (6n × 6n) | KMATRIX | force/length … torque/rad | – |
//! | damping | C (6n × 6n) | CMATRIX, or CRATIO · K | force·time/length … torque·time/rad | 0 |
//! | free displacements | x₀ (6n) | LENGTH | length, rad | 0 |
//! | preload | F₀ (6n) | FORCE | force, torque | 0 |
//!
//! ```text
//! (F₁, T₁ … Fₙ, Tₙ) = −K (x − x₀) − C ẋ + F₀      x: x, y, z, a, b, c of each I marker from J
//! ```
//!
//! Each of the I markers gets its six components; J's part gets the reaction to all of them.

use super::action::Action;
use super::bushing::in_axes_of;
use super::field::resisting;
use crate::scalar::Scalar;
use crate::space::MarkerState;

/// The parameters of an NFORCE with n markers.
#[derive(Clone, Debug, PartialEq)]
pub struct NodalForce {
    /// K by rows   (6n rows of 6n)
    pub stiffness: Vec<Vec<f64>>,
    /// C by rows; empty: none
    pub damping: Vec<Vec<f64>>,
    /// x₀   (6n)
    pub free: Vec<f64>,
    /// F₀   (6n)
    pub preload: Vec<f64>,
}

impl NodalForce {
    /// Returns the action on the I marker at index `place`, from the displacements of all of them
    /// and their rates   (6n each).
    pub fn action<S: Scalar>(
        &self,
        place: usize,
        j: &MarkerState<S>,
        x: &[S],
        rate: &[S],
    ) -> Action<S> {
        let stretch: Vec<S> = x
            .iter()
            .zip(&self.free)
            .map(|(&x, &x0)| x - S::constant(x0))
            .collect();
        let f = std::array::from_fn(|k| {
            let row = 6 * place + k;
            let damping = self
                .damping
                .get(row)
                .map_or_else(S::zero, |c| resisting(c, rate));
            S::constant(self.preload[row]) + resisting(&self.stiffness[row], &stretch) + damping
        });
        in_axes_of(j, f)
    }
}
