//! A compiled expression that threads share: the evaluator behind the doors of other languages.
//!
//! Programs do not change; the scratch that a run of one needs is taken from a pool and given back,
//! so that threads do not wait for each other.

use super::Expr;
use super::Names;
use super::ast::Dialect;
use super::calls::Calls;
use super::interpolation::Bindings;
use super::program::{Batch, Input, Program, Work};
use crate::diagnostic::{Cause, Diagnostic, Error};
use std::sync::{Mutex, OnceLock, PoisonError};

/// A compiled expression that many threads evaluate at a time.
///
/// Numbers are given in the order of [`inputs`](Self::inputs); counts are the caller's business:
/// numbers that are missing make NaN. Where a result is not finite, [`complaint`](Self::complaint)
/// tells why.
///
/// ```
/// use cognate::expr::{SharedEvaluator, ast::Dialect};
/// let f = SharedEvaluator::parse("LOG(TIME)", Dialect::Function)?;
/// let mut value = [0.0];
/// f.run(&[1.0], &mut value);
/// assert_eq!(value, [0.0]);
/// f.run(&[-1.0], &mut value);
/// assert!(value[0].is_nan());
/// assert!(f.complaint(&[-1.0]).message.starts_with("LOG of -1 has no value"));
/// # Ok::<(), cognate::Error>(())
/// ```
#[derive(Debug)]
pub struct SharedEvaluator {
    expr: Expr,
    value: Pooled,
    /// value and slopes, once they have been asked for
    slopes: OnceLock<Pooled>,
    /// functions of the caller's own that the program reads as inputs
    calls: Option<Calls>,
    names: Vec<String>,
}

/// A program with the scratch of its runs.
#[derive(Debug)]
struct Pooled {
    program: Program,
    single: Mutex<Vec<Work>>,
    batches: Mutex<Vec<Batch>>,
}

impl Pooled {
    fn new(program: Program) -> Self {
        Self {
            program,
            single: Mutex::default(),
            batches: Mutex::default(),
        }
    }

    #[inline]
    fn run(&self, inputs: &[f64], out: &mut [f64]) {
        let mut work = take(&self.single).unwrap_or_default();
        self.program.run(inputs, &mut work, out);
        give(&self.single, work);
    }

    fn batch(&self, columns: &[&[f64]], out: &mut [&mut [f64]]) -> Result<(), Error> {
        let mut batch = take(&self.batches).unwrap_or_else(|| self.program.batch());
        let outcome = batch.run(columns, out);
        give(&self.batches, batch);
        outcome
    }
}

fn take<T>(pool: &Mutex<Vec<T>>) -> Option<T> {
    pool.lock().unwrap_or_else(PoisonError::into_inner).pop()
}

fn give<T>(pool: &Mutex<Vec<T>>, scratch: T) {
    let mut pool = pool.lock().unwrap_or_else(PoisonError::into_inner);
    pool.push(scratch);
}

impl SharedEvaluator {
    /// Reads and compiles an expression of either language.
    ///
    /// # Errors
    /// Those of [`Expr::parse`]; splines and curves; DELAY, since an expression alone has no past.
    pub fn parse(text: &str, dialect: Dialect) -> Result<Self, Error> {
        Self::new(Expr::parse_dialect(text, dialect)?)
    }

    /// Reads and compiles an expression with names of the caller's own.
    ///
    /// # Errors
    /// Those of [`Expr::parse_with`]; splines and curves; DELAY.
    pub fn parse_with(text: &str, names: &Names) -> Result<Self, Error> {
        Self::new(Expr::parse_with(text, names)?)
    }

    fn new(expr: Expr) -> Result<Self, Error> {
        let (program, calls) = expr.compile_with_calls(&Bindings::default())?;
        let inputs = calls.as_ref().map_or(program.inputs(), Calls::inputs);
        if let Some(past) = inputs.iter().find(|i| matches!(i, Input::Delayed(_))) {
            let what = format!("{past} depends on the past, which an expression alone has not");
            let said = Diagnostic::error("needs_history", what);
            let advice = "put it into a model, or ask for it as a column of a simulation";
            return Err(said.help(advice).into());
        }
        Ok(Self {
            names: expr.names_of(inputs),
            calls,
            value: Pooled::new(program),
            slopes: OnceLock::new(),
            expr,
        })
    }

    /// Returns the expression.
    pub fn expr(&self) -> &Expr {
        &self.expr
    }

    /// Returns the inputs, in the order in which their values are given.
    pub fn inputs(&self) -> &[Input] {
        match &self.calls {
            None => self.value.program.inputs(),
            Some(calls) => calls.inputs(),
        }
    }

    /// Returns the names of the inputs, in the same order.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Puts the value into `out`   (1)
    #[inline]
    pub fn run(&self, inputs: &[f64], out: &mut [f64]) {
        match &self.calls {
            None => self.value.run(inputs, out),
            Some(calls) => self.value.run(&calls.complete(inputs), out),
        }
    }

    /// Puts the value and its derivatives along all inputs into `out`   (1 + inputs)
    pub fn run_slopes(&self, inputs: &[f64], out: &mut [f64]) {
        let Some(calls) = &self.calls else {
            return self.slopes().run(inputs, out);
        };
        let all = calls.complete(inputs);
        let mut partial = vec![0.0; 1 + all.len()];
        self.slopes().run(&all, &mut partial);
        let slopes = calls.slopes(&all, &partial[1..]);
        out.fill(f64::NAN);
        if let Some((value, of_inputs)) = out.split_first_mut() {
            *value = partial[0];
            let slopes = slopes.unwrap_or_default();
            of_inputs
                .iter_mut()
                .zip(slopes)
                .for_each(|(to, slope)| *to = slope);
        }
    }

    /// Evaluates many points: `columns` holds one for each input, and `out` one for the value, or
    /// that and one for each derivative, all of one length.
    ///
    /// # Errors
    /// Columns that are missing or too short.
    pub fn batch(&self, columns: &[&[f64]], out: &mut [&mut [f64]]) -> Result<(), Error> {
        let n = out.iter().map(|column| column.len()).max().unwrap_or(0);
        self.expr.check_columns(self.inputs(), columns, n)?;
        match (&self.calls, out.len() > 1) {
            (None, true) => self.slopes().batch(columns, out),
            (None, false) => self.value.batch(columns, out),
            (Some(calls), false) => {
                let columns = calls.complete_columns(columns, n)?;
                let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
                self.value.batch(&columns, out)
            }
            (Some(_), true) => {
                self.slopes_by_points(columns, out, n);
                Ok(())
            }
        }
    }

    /// Evaluates values and slopes one point after another.
    fn slopes_by_points(&self, columns: &[&[f64]], out: &mut [&mut [f64]], n: usize) {
        let mut point = vec![0.0; columns.len()];
        let mut results = vec![0.0; out.len()];
        for k in 0..n {
            point.iter_mut().zip(columns).for_each(|(x, c)| *x = c[k]);
            self.run_slopes(&point, &mut results);
            out.iter_mut().zip(&results).for_each(|(c, y)| c[k] = *y);
        }
    }

    fn slopes(&self) -> &Pooled {
        let program = &self.value.program;
        (self.slopes).get_or_init(|| Pooled::new(program.with_gradient(program.inputs())))
    }

    /// Says why a point has no value: an input that is not finite, the operation that has none, or
    /// a derivative.
    #[cold]
    pub fn complaint(&self, given: &[f64]) -> Diagnostic {
        let infinite = self.names.iter().zip(given).find(|(_, x)| !x.is_finite());
        if let Some((name, x)) = infinite {
            let what = format!("{name} is {x}, which is not a finite number");
            return Diagnostic::error(Cause::Domain, what);
        }
        let inputs = self.inputs();
        let host = |input: Input| {
            let place = inputs.iter().position(|i| *i == input);
            place.and_then(|place| given.get(place).copied())
        };
        match self.expr.eval_with(&host) {
            Err(error) => error.into_first(),
            Ok(value) => {
                if let Some(unknown) = self.calls.as_ref().and_then(|c| c.unknown_slopes()) {
                    return unknown;
                }
                let what = format!("a derivative is not finite where the value is {value}");
                Diagnostic::error(Cause::Domain, what)
            }
        }
    }

    /// Makes NaN of results without a finite value, and of all results of points whose inputs are
    /// not finite; returns the first such point.
    pub fn mark(columns: &[&[f64]], out: &mut [&mut [f64]]) -> Option<usize> {
        if columns.iter().all(|c| are_finite(c)) && out.iter().all(|c| are_finite(c)) {
            return None;
        }
        let mut first = None;
        for k in 0..out.first().map_or(0, |c| c.len()) {
            let is_given = columns.iter().all(|c| c[k].is_finite());
            for column in out.iter_mut() {
                if !is_given || !column[k].is_finite() {
                    column[k] = f64::NAN;
                    first.get_or_insert(k);
                }
            }
        }
        first
    }
}

/// Returns true if all numbers are finite.
pub fn are_finite(numbers: &[f64]) -> bool {
    // x·0 is NaN where x is not finite; eight sums side by side become vector instructions
    let (eights, rest) = numbers.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for eight in eights {
        for (sum, x) in sums.iter_mut().zip(eight) {
            *sum += x * 0.0;
        }
    }
    sums.iter().all(|sum| *sum == 0.0) && rest.iter().all(|x| x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_share_an_expression() {
        let f = SharedEvaluator::parse("TIME**2 + DX(1,2)", Dialect::Function).unwrap();
        assert_eq!(f.names(), ["TIME", "DX(1, 2)"]);
        let once = |x: f64| {
            let mut out = [0.0; 3];
            f.run_slopes(&[x, 1.0], &mut out);
            out
        };
        std::thread::scope(|scope| {
            for k in 0..4 {
                let once = &once;
                scope.spawn(move || {
                    for j in 0..100 {
                        let x = f64::from(100 * k + j);
                        assert_eq!(once(x), [x * x + 1.0, 2.0 * x, 1.0]);
                    }
                });
            }
        });
    }

    #[test]
    fn points_without_a_value_are_marked_and_explained() {
        let f = SharedEvaluator::parse("SQRT(TIME)", Dialect::Function).unwrap();
        let times = [4.0, -1.0, f64::NAN, 0.0];
        let (mut value, mut slope) = ([0.0; 4], [0.0; 4]);
        f.batch(&[&times], &mut [&mut value, &mut slope]).unwrap();
        let first = SharedEvaluator::mark(&[&times], &mut [&mut value, &mut slope]);
        assert_eq!(first, Some(1));
        assert!((value[0], slope[0], value[3]) == (2.0, 0.25, 0.0));
        assert!(value[1].is_nan() && value[2].is_nan() && slope[3].is_nan());
        let said = |x: f64| f.complaint(&[x]).message;
        assert!(said(-1.0).starts_with("SQRT of -1"), "{}", said(-1.0));
        assert!(said(f64::NAN).contains("TIME is NaN"));
        assert!(said(0.0).contains("derivative"), "{}", said(0.0));
        let past = SharedEvaluator::parse("DELAY(DX(1,2), 1, 0)", Dialect::Function);
        assert_eq!(past.unwrap_err().code(), "needs_history");
    }
}
