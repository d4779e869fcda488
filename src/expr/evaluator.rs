//! An expression that is compiled once, for programs that evaluate it often: values, slopes, rates
//! in time, columns of points.

use super::Expr;
use super::calls::Calls;
use super::interpolation::Bindings;
use super::program::{Batch, Input, Program, Work, too_few};
use crate::diagnostic::{Cause, Diagnostic, Error};
use crate::scalar::Jet;
use std::sync::Arc;

/// A compiled expression with its work space.
///
/// Inputs are given as numbers, in the order of [`inputs`](Self::inputs). Every method but
/// [`value`](Self::value) is checked: too few numbers, numbers that are not finite, and operations
/// without a value are errors that name them.
///
/// ```
/// use cognate::expr::Evaluator;
/// let mut spring = Evaluator::parse("-25*(DM(1,2) - 10) - 2*VR(1,2)")?;
/// let names: Vec<String> = spring.inputs().iter().map(|input| input.to_string()).collect();
/// assert_eq!(names, ["DM(1, 2)", "VR(1, 2)"]);
/// assert_eq!(spring.eval(&[12.0, 0.5])?, -51.0);
/// assert_eq!(spring.gradient(&[12.0, 0.5])?, [-25.0, -2.0]);
///
/// let error = spring.eval(&[12.0]).unwrap_err();
/// assert_eq!(error.first().message, "1 value was given for 2 inputs: DM(1, 2), VR(1, 2)");
/// # Ok::<(), cognate::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Evaluator {
    expr: Expr,
    program: Program,
    /// functions of the caller's own that the program reads as inputs
    calls: Option<Arc<Calls>>,
    work: Work,
    /// the slopes and what they need, once they have been asked for
    gradient: Option<(Program, Work)>,
    jets: Work<Jet>,
    batch: Option<Batch>,
}

impl Evaluator {
    /// Reads and compiles a direct-entry function.
    ///
    /// # Errors
    /// Those of [`Expr::parse`], and splines or curves, which [`new`](Self::new) takes.
    pub fn parse(text: &str) -> Result<Self, Error> {
        Self::new(Expr::parse(text)?, &Bindings::default())
    }

    /// Compiles an expression with the splines and curves that it names.
    ///
    /// # Errors
    /// A spline or curve that is not bound.
    pub fn new(expr: Expr, bindings: &Bindings) -> Result<Self, Error> {
        let (program, calls) = expr.compile_with_calls(bindings)?;
        Ok(Self {
            program,
            calls: calls.map(Arc::new),
            expr,
            work: Work::default(),
            gradient: None,
            jets: Work::default(),
            batch: None,
        })
    }

    /// Returns the expression.
    pub fn expr(&self) -> &Expr {
        &self.expr
    }

    /// Returns its program. Values of functions of the caller's own of which only numbers are known
    /// are inputs of it, beside those of [`inputs`](Self::inputs).
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Returns the inputs, in the order in which their values are given.
    pub fn inputs(&self) -> &[Input] {
        match &self.calls {
            None => self.program.inputs(),
            Some(calls) => calls.inputs(),
        }
    }

    /// Returns the value.
    ///
    /// # Errors
    /// Too few values, a value that is not finite, or an operation that has no value: the message
    /// names it and the numbers it was given.
    pub fn eval(&mut self, inputs: &[f64]) -> Result<f64, Error> {
        let value = self.value(inputs);
        if value.is_finite() && inputs.iter().all(|x| x.is_finite()) {
            return Ok(value);
        }
        self.explain(inputs, value)
    }

    /// Returns the value, unchecked: NaN or infinite where there is none, and NaN for inputs that
    /// are missing.
    #[inline]
    pub fn value(&mut self, inputs: &[f64]) -> f64 {
        match &self.calls {
            None => self.program.value(inputs, &mut self.work),
            Some(calls) => (self.program).value(&calls.complete(inputs), &mut self.work),
        }
    }

    /// Returns the partial derivatives with respect to the inputs, in their order.
    ///
    /// At a switching point they are those of the side that supplies the value.
    ///
    /// # Errors
    /// Those of [`eval`](Self::eval), and a derivative that is not finite.
    pub fn gradient(&mut self, inputs: &[f64]) -> Result<Vec<f64>, Error> {
        self.eval(inputs)?;
        let (program, work) = self.gradient.get_or_insert_with(|| {
            let program = self.program.with_gradient(self.program.inputs());
            (program, Work::default())
        });
        let mut all = vec![0.0; program.n_outputs()];
        let slopes = match &self.calls {
            None => {
                program.run(inputs, work, &mut all);
                all.split_off(1)
            }
            Some(calls) => {
                let inputs = calls.complete(inputs);
                program.run(&inputs, work, &mut all);
                calls.slopes(&inputs, &all[1..])?
            }
        };
        match slopes.iter().position(|slope| !slope.is_finite()) {
            None => Ok(slopes),
            Some(k) => {
                let input = self.expr.input_name(self.inputs()[k]);
                let what = format!("the derivative with respect to {input} has no finite value");
                Err(Diagnostic::error(Cause::Domain, what).into())
            }
        }
    }

    /// Returns the value with its first and second derivative in time, for inputs that are given
    /// likewise: `[t, 1.0, 0.0]` for TIME.
    ///
    /// ```
    /// use cognate::expr::Evaluator;
    /// let mut f = Evaluator::parse("TIME*DX(1,2)")?;
    /// assert_eq!(f.rates(&[[2.0, 1.0, 0.0], [5.0, 3.0, 0.5]])?, [10.0, 11.0, 7.0]);
    /// # Ok::<(), cognate::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`eval`](Self::eval), and rates that are not finite.
    pub fn rates(&mut self, inputs: &[[f64; 3]]) -> Result<[f64; 3], Error> {
        let values: Vec<f64> = inputs.iter().map(|input| input[0]).collect();
        self.eval(&values)?;
        if let Some(calls) = &self.calls {
            return Err(calls.no_rates());
        }
        let jet = |&[value, first, second]: &[f64; 3]| Jet {
            value,
            first,
            second,
        };
        let jets: Vec<Jet> = inputs.iter().map(jet).collect();
        let mut out = [Jet::variable(f64::NAN)];
        self.program.eval(&jets, &mut self.jets, &mut out);
        let all = [out[0].value, out[0].first, out[0].second];
        if all.iter().all(|x| x.is_finite()) {
            return Ok(all);
        }
        let what = format!("its rates are {} and {}", all[1], all[2]);
        Err(Diagnostic::error(Cause::Domain, what).into())
    }

    /// Returns the values at many points; `columns`: one for each input, of one length. A point
    /// without a value is NaN or infinite.
    ///
    /// # Errors
    /// Columns that are missing, and columns of different lengths.
    pub fn batch(&mut self, columns: &[&[f64]]) -> Result<Vec<f64>, Error> {
        let mut values = vec![0.0; columns.first().map_or(1, |column| column.len())];
        self.batch_into(columns, &mut values)?;
        Ok(values)
    }

    /// Puts the values at many points into a slice; see [`batch`](Self::batch).
    ///
    /// # Errors
    /// Columns that are missing, or shorter than the slice.
    pub fn batch_into(&mut self, columns: &[&[f64]], values: &mut [f64]) -> Result<(), Error> {
        self.expr
            .check_columns(self.inputs(), columns, values.len())?;
        let batch = self.batch.get_or_insert_with(|| self.program.batch());
        let Some(calls) = &self.calls else {
            return batch.run(columns, &mut [values]);
        };
        let columns = calls.complete_columns(columns, values.len())?;
        let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        batch.run(&columns, &mut [values])
    }

    /// Says why there is no value.
    #[cold]
    fn explain(&self, inputs: &[f64], value: f64) -> Result<f64, Error> {
        let known = self.inputs();
        if inputs.len() < known.len() {
            return Err(too_few(inputs.len(), &self.expr.names_of(known)).into());
        }
        let of = |input: Input| {
            let place = known.iter().position(|&k| k == input);
            place.and_then(|k| inputs.get(k).copied())
        };
        self.expr.eval_with(&of)?;
        // numbers beyond those of the program may be anything
        if value.is_finite() {
            return Ok(value);
        }
        let what = format!("it has no finite value: {value}");
        Err(Diagnostic::error(Cause::Domain, what).into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_evaluator_gives_what_the_walker_gives_and_says_why_not() {
        let mut f = Evaluator::parse("LOG(TIME)/DX(1,2)").unwrap();
        assert_eq!(f.eval(&[1.0, 2.0]), Ok(0.0));
        let message = |outcome: Result<f64, Error>| outcome.unwrap_err().into_first().message;
        assert!(message(f.eval(&[-1.0, 2.0])).starts_with("LOG of -1 has no value"));
        assert!(message(f.eval(&[f64::NAN, 2.0])).contains("NaN"));
        assert_eq!(f.eval(&[]).unwrap_err().code(), "missing_value");
        assert!(f.value(&[]).is_nan());
        assert_eq!(f.gradient(&[1.0, 2.0]), Ok(vec![0.5, 0.0]));
        let columns = [&[1.0, 1.0][..], &[1.0, 2.0]];
        assert_eq!(f.batch(&columns), Ok(vec![0.0, 0.0]));
        assert_eq!(f.batch(&[]).unwrap_err().code(), "missing_value");
        assert!(f.batch(&[&[1.0, 1.0], &[1.0]]).is_err());
    }

    #[test]
    fn a_constant_needs_no_inputs() {
        let mut f = Evaluator::parse("2*PI").unwrap();
        assert_eq!(f.gradient(&[]), Ok(Vec::new()));
        assert_eq!(f.batch(&[]), Ok(vec![f.value(&[])]));
    }
}
