//! Calls of functions whose parameters are constant, value and slopes together.

use crate::expr::functions::prepared::{self, Power, Prepared};
use crate::scalar::Dual;

/// A function with its parameters; variables and results are slots.
#[derive(Clone, Debug)]
pub(super) struct PreparedCall {
    pub(super) function: Prepared,
    pub(super) parameters: Vec<f64>,
    /// the second is the first where there is one variable
    pub(super) variables: [u32; 2],
    pub(super) value: Option<u32>,
    /// derivatives with respect to the variables
    pub(super) slopes: [Option<u32>; 2],
}

impl PreparedCall {
    /// Returns whether a derivative is wanted.
    pub(super) fn has_slopes(&self) -> bool {
        self.slopes != [None; 2]
    }

    /// Evaluates the function, with its slopes where they are wanted.
    pub(super) fn perform(&self, frame: &mut [f64]) {
        self.perform_as(self.function, self.has_slopes(), frame);
    }

    /// Does as [`PreparedCall::perform`], told what the call says itself: where these are
    /// constants, there is nothing left to decide.
    #[inline(always)]
    pub(super) fn perform_as(&self, function: Prepared, has_slopes: bool, frame: &mut [f64]) {
        let p = &self.parameters[..];
        let [x, y] = self.variables.map(|slot| frame[slot as usize]);
        let (value, slopes) = if !has_slopes {
            (evaluate(function, p, x, y), [f64::NAN; 2])
        } else if function.n_variables() == 2 {
            let (x, y) = (Dual::<2>::variable(x, 0), Dual::variable(y, 1));
            let dual = evaluate(function, p, x, y);
            (dual.re, dual.eps)
        } else {
            let x = Dual::<1>::variable(x, 0);
            let dual = evaluate(function, p, x, x);
            (dual.re, [dual.eps[0], f64::NAN])
        };
        let [first, second] = slopes;
        let wanted = [self.value, self.slopes[0], self.slopes[1]];
        for (slot, result) in wanted.into_iter().zip([value, first, second]) {
            if let Some(slot) = slot {
                frame[slot as usize] = result;
            }
        }
    }
}

#[inline(always)]
fn evaluate<S: Power>(function: Prepared, parameters: &[f64], x: S, x_dot: S) -> S {
    match (function, parameters) {
        (Prepared::Step, &[x0, x1, h0, h1, l, h]) => prepared::step3(x, &[x0, x1, h0, h1, l, h]),
        (Prepared::Step5, &[x0, x1, h0, h1, l, h]) => prepared::step5(x, &[x0, x1, h0, h1, l, h]),
        (Prepared::Havsin, &[x0, x1, h0, h1, l, h]) => prepared::havsin(x, &[x0, x1, h0, h1, l, h]),
        (Prepared::Poly, p) => prepared::poly(x, p),
        (Prepared::Cheby, p) => prepared::cheby(x, p),
        (Prepared::Forcos, p) => prepared::forcos(x, p),
        (Prepared::Forsin, p) => prepared::forsin(x, p),
        (Prepared::Impact(e), &[x1, k, c, d, w, n]) => {
            prepared::impact(x, x_dot, &[x1, k, c, d, w, n], e)
        }
        (Prepared::Bistop(e), &[x1, x2, k, c, d, w, n]) => {
            prepared::bistop(x, x_dot, &[x1, x2, k, c, d, w, n], e)
        }
        _ => unreachable!("a prepared function comes with as many parameters as it says"),
    }
}
