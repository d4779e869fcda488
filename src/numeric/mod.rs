//! Methods for differential and differential-algebraic equations, and the linear algebra they need.
//!
//! This floor has never heard of a body: it sees numbers, residuals and rates. A method offers steps and an interpolant;
//! output times, events and files belong to the analysis that drives it.

/// Why an evaluation could not be done: a small code the analysis translates into words ("what" is chosen by the problem).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Failure {
    /// meaning is the problem's: usually the index of a row, or of an output that is not finite
    pub what: usize,
    /// whether a smaller step may help (a stage left the domain) or not (a mistake of the user's that will not go away)
    pub recoverable: bool,
}

/// An explicit system `ẏ = f(t, y)`, possibly with invariants `g(t, y) = 0` that exact solutions keep.
pub trait Ode {
    /// Number of unknowns.
    fn size(&self) -> usize;
    /// `ydot = f(t, y)`
    ///
    /// # Errors
    /// When `f` has no finite value there.
    fn rate(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure>;
    /// Moves `y` back onto the invariants; tells whether it changed.
    ///
    /// # Errors
    /// When they cannot be reached from here.
    fn project(&mut self, _t: f64, _y: &mut [f64]) -> Result<bool, Failure> {
        Ok(false)
    }
    /// `jacobian[i + n·j] = ∂fᵢ/∂yⱼ` (by columns), `dfdt[i] = ∂fᵢ/∂t`.
    ///
    /// # Errors
    /// When it has no finite value there.
    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        jacobian: &mut [f64],
        dfdt: &mut [f64],
    ) -> Result<(), Failure>;
    /// Typical magnitude of each unknown, below which its error is measured absolutely   (n)
    fn typical(&self, typical: &mut [f64]);
}

/// An implicit system `F(t, y, ẏ) = 0`.
pub trait Dae {
    /// Number of unknowns and of rows.
    fn size(&self) -> usize;
    /// `r = F(t, y, ydot)`
    ///
    /// # Errors
    /// When `F` has no finite value there.
    fn residual(&mut self, t: f64, y: &[f64], ydot: &[f64], r: &mut [f64]) -> Result<(), Failure>;
    /// Rows and columns of the entries of the Jacobian, fixed for the whole life of the problem.
    fn pattern(&self) -> Vec<(usize, usize)>;
    /// `values[e] = (∂F/∂y + cj ∂F/∂ẏ)` at the `e`-th entry of the pattern.
    ///
    /// # Errors
    /// When it has no finite value there.
    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        ydot: &[f64],
        cj: f64,
        values: &mut [f64],
    ) -> Result<(), Failure>;
    /// How each unknown is treated by the error norm and the order of its constraint   (n)
    fn kinds(&self) -> Vec<Kind>;
    /// Typical magnitude of each unknown, below which its error is measured absolutely   (n)
    fn typical(&self, typical: &mut [f64]);
}

/// What an unknown of a [`Dae`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// its rate occurs; its error is controlled
    Differential,
    /// its rate occurs; its error is not controlled (velocities in an index-3 formulation)
    DifferentialUncontrolled,
    /// its rate does not occur: multipliers, algebraic variables; its error is not controlled
    Algebraic,
    /// its rate does not occur, but its error is controlled
    AlgebraicControlled,
}
