//! Calls of functions of a caller's own that are known by their numbers only.
//!
//! A program cannot hold them: it reads their values as inputs behind those that the caller gives.
//! The arguments of each call are a program of their own, which reads the values of earlier calls:
//!
//! ```text
//! c₁ = f(a₁(x)),  c₂ = g(a₂(x, c₁)), …        value = p(x, c₁, c₂, …)
//! dcₖ/dx = Σⱼ ∂f/∂aⱼ (∂aⱼ/∂x + Σ ∂aⱼ/∂cₗ dcₗ/dx),  l < k
//! ```

use super::compile::{Compiler, NamedCall};
use super::names::Numeric;
use super::program::{Input, Program, Value, Work};
use crate::diagnostic::{Diagnostic, Error};

/// The calls of an expression, each behind those that its arguments read.
#[derive(Debug)]
pub(super) struct Calls {
    /// inputs that the caller gives
    inputs: Vec<Input>,
    /// their places among the inputs of the programs
    places: Vec<usize>,
    /// inputs of the programs
    n_inputs: usize,
    calls: Vec<Call>,
}

/// A call of a function.
#[derive(Debug)]
struct Call {
    name: String,
    function: Numeric,
    /// the arguments
    args: Program,
    /// place of its value among the inputs of the programs
    place: usize,
}

impl Calls {
    /// Takes the calls that a compiler has met; `None`: there is none.
    pub fn new(compiler: &Compiler<'_>, value: Value) -> Option<Self> {
        let calls = compiler.calls();
        if calls.is_empty() {
            return None;
        }
        let all = compiler.finish(&[value]);
        let all = all.inputs();
        let is_call = |input: &Input| calls.iter().any(|call| call.input == *input);
        let given = || all.iter().enumerate().filter(|(_, input)| !is_call(input));
        let place = |input: Input| all.iter().position(|i| *i == input);
        let call = |call: &NamedCall| Call {
            name: call.name.clone(),
            function: call.function.clone(),
            args: compiler.finish(&call.args),
            place: place(call.input).unwrap_or(usize::MAX),
        };
        Some(Self {
            inputs: given().map(|(_, input)| *input).collect(),
            places: given().map(|(k, _)| k).collect(),
            n_inputs: all.len(),
            calls: calls.iter().map(call).collect(),
        })
    }

    /// Returns the inputs that the caller gives, in their order.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// Returns the name of the function that is called first.
    pub fn first_name(&self) -> &str {
        self.calls.first().map_or("", |call| &call.name)
    }

    /// Returns the inputs of the program: those given, NaN for those that are missing, and the
    /// values of the calls.
    pub fn complete(&self, given: &[f64]) -> Vec<f64> {
        let mut all = vec![f64::NAN; self.n_inputs];
        for (&place, &x) in self.places.iter().zip(given) {
            all[place] = x;
        }
        let mut work = Work::default();
        for call in &self.calls {
            let mut args = vec![f64::NAN; call.args.n_outputs()];
            call.args.run(&all, &mut work, &mut args);
            all[call.place] = (call.function.closure)(&args, &mut []);
        }
        all
    }

    /// Returns the columns of the inputs of the program, of `n` points.
    ///
    /// # Errors
    /// Those of a batch.
    pub fn complete_columns(&self, given: &[&[f64]], n: usize) -> Result<Vec<Vec<f64>>, Error> {
        let mut all = vec![vec![f64::NAN; n]; self.n_inputs];
        for (&place, column) in self.places.iter().zip(given) {
            all[place].copy_from_slice(&column[..n]);
        }
        for call in &self.calls {
            let mut args = vec![vec![0.0; n]; call.args.n_outputs()];
            let mut to: Vec<&mut [f64]> = args.iter_mut().map(Vec::as_mut_slice).collect();
            let from: Vec<&[f64]> = all.iter().map(Vec::as_slice).collect();
            call.args.batch().run(&from, &mut to)?;
            let mut point = vec![0.0; args.len()];
            for k in 0..n {
                point.iter_mut().zip(&args).for_each(|(x, c)| *x = c[k]);
                all[call.place][k] = (call.function.closure)(&point, &mut []);
            }
        }
        Ok(all)
    }

    /// Returns the derivatives of a value along the inputs that the caller gives; `all` are the
    /// inputs of the program, `partial` the derivatives along them.
    ///
    /// # Errors
    /// A function that the value depends on and whose derivatives are not known.
    pub fn slopes(&self, all: &[f64], partial: &[f64]) -> Result<Vec<f64>, Error> {
        let n = self.places.len();
        // dcₖ/dx of the calls so far
        let mut of_calls: Vec<Vec<f64>> = Vec::with_capacity(self.calls.len());
        let total = |partial: &[f64], of_calls: &[Vec<f64>]| {
            let mut sum: Vec<f64> = self.places.iter().map(|&place| partial[place]).collect();
            for (call, slopes) in self.calls.iter().zip(of_calls) {
                let factor = partial[call.place];
                // what does not enter has no part, also where it has no value
                if factor != 0.0 {
                    sum.iter_mut()
                        .zip(slopes)
                        .for_each(|(s, d)| *s += factor * d);
                }
            }
            sum
        };
        let mut work = Work::default();
        for call in &self.calls {
            let with_slopes = call.args.with_gradient(call.args.inputs());
            let mut out = vec![0.0; with_slopes.n_outputs()];
            with_slopes.run(all, &mut work, &mut out);
            let n_args = call.args.n_outputs();
            let (args, partials) = out.split_at(n_args);
            // without derivatives of its own all that its arguments read makes NaN
            let mut own = vec![f64::NAN; n_args];
            (call.function.closure)(args, &mut own);
            let mut sum = vec![0.0; n];
            for (slope, partial) in own.iter().zip(partials.chunks(self.n_inputs)) {
                let along = total(partial, &of_calls);
                let parts = sum.iter_mut().zip(&along).filter(|(_, d)| **d != 0.0);
                parts.for_each(|(s, d)| *s += slope * d);
            }
            of_calls.push(sum);
        }
        let slopes = total(partial, &of_calls);
        let has_unknown = slopes.iter().any(|slope| slope.is_nan());
        match self.unknown_slopes().filter(|_| has_unknown) {
            None => Ok(slopes),
            Some(said) => Err(said.into()),
        }
    }

    /// Returns the mistake of asking for derivatives, if those of a function are not known.
    pub fn unknown_slopes(&self) -> Option<Diagnostic> {
        let call = self.calls.iter().find(|call| !call.function.has_slopes)?;
        let what = format!("the derivatives of {} are not known", call.name);
        let said = Diagnostic::error("no_derivative", what);
        Some(said.help("give it as a law, as a formula, or with its slopes"))
    }

    /// Returns the mistake of asking for rates in time, which want second derivatives.
    pub fn no_rates(&self) -> Error {
        let what = format!(
            "the second derivatives of {} are not known",
            self.first_name()
        );
        let said = Diagnostic::error("no_derivative", what);
        said.help("give it as a law or as a formula").into()
    }
}
