//! One expression of the function language over scalars and arrays.

use crate::arrays::{self, Values};
use crate::errors::{self, Kind};
use cognate::Error;
use cognate::diagnostic::{Cause, Diagnostic};
use cognate::expr;
use cognate::expr::ast::Dialect;
use cognate::expr::interpolation::Bindings;
use cognate::expr::program::{Batch, Input, Program, Work};
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyTuple};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Mutex, OnceLock, PoisonError};

/// Points between two looks for Ctrl-C.
const POINTS_AT_ONCE: usize = 1 << 20;
/// Points from which on Python's lock is released.
const POINTS_TO_DETACH: usize = 512;

/// An expression of the ADAMS function language, checked and compiled.
///
/// Call it with times and, by name, the values of its other inputs: ``f(t)``,
/// ``f(t, {"DX(1, 2)": x})``, ``f({"DX(1, 2)": x})``. Numbers give a number; lists and arrays of
/// any type, layout and shape give an array of the shape that numpy's rules give them together.
///
/// Parameters
/// ----------
/// text : str
///     The expression.
/// dialect : {"function", "expression"}
///     Radians and ``TIME``, or degrees and ``t``.
///
/// Raises
/// ------
/// ExprError
///     The first mistake, with its column and advice.
///
/// Notes
/// -----
/// Arrays are evaluated with Python's lock released. Expressions can be pickled.
///
/// Examples
/// --------
/// >>> f = Expr("SIN(2*PI*TIME)")
/// >>> f(0.25)
/// 1.0
#[pyclass(module = "cognate", frozen)]
pub struct Expr {
    expr: expr::Expr,
    dialect: Dialect,
    value: Compiled,
    gradient: OnceLock<Compiled>,
    /// inputs of the program, by their places in it
    inputs: Vec<Input>,
    /// their names
    names: Vec<String>,
    /// place of TIME among them
    time: Option<usize>,
}

/// A program with the scratch that runs of it need: a run takes some and gives it back, so that
/// threads do not wait for each other.
struct Compiled {
    program: Program,
    scalars: Mutex<Vec<Work>>,
    batches: Mutex<Vec<Batch>>,
}

impl Compiled {
    fn new(program: Program) -> Self {
        Self {
            program,
            scalars: Mutex::default(),
            batches: Mutex::default(),
        }
    }

    fn run(&self, inputs: &[f64], out: &mut [f64]) {
        let mut work = take(&self.scalars).unwrap_or_default();
        self.program.run(inputs, &mut work, out);
        give(&self.scalars, work);
    }

    fn batch(&self, inputs: &[&[f64]], out: &mut [&mut [f64]]) -> Result<(), Error> {
        let mut batch = take(&self.batches).unwrap_or_else(|| self.program.batch());
        let outcome = batch.run(inputs, out);
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

/// What to do at points without a value.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Invalid {
    /// raise ExprError, which names the first
    Raise,
    /// NaN is the result there
    Nan,
}

impl Invalid {
    fn of(word: &str) -> PyResult<Self> {
        match word {
            "raise" => Ok(Invalid::Raise),
            "nan" => Ok(Invalid::Nan),
            _ => Err(PyValueError::new_err(format!(
                "invalid={word:?}: it is \"raise\" or \"nan\""
            ))),
        }
    }
}

#[pymethods]
impl Expr {
    #[new]
    #[pyo3(signature = (text, *, dialect = "function"))]
    fn new(py: Python<'_>, text: &str, dialect: &str) -> PyResult<Self> {
        let dialect = match dialect {
            "function" => Dialect::Function,
            "expression" => Dialect::Expression,
            _ => {
                return Err(PyValueError::new_err(format!(
                    "dialect={dialect:?}: it is \"function\" (radians, TIME) or \"expression\" (degrees, t)"
                )));
            }
        };
        let raised = |e: Error| errors::exception(py, Kind::Expr, e, Some(text));
        let expr = expr::Expr::parse_dialect(text, dialect).map_err(raised)?;
        let program = expr.compile(&Bindings::default()).map_err(raised)?;
        if let Some(past) = program.inputs().iter().find(|i| is_of_the_past(i)) {
            let message = format!(
                "{} depends on the past, which an expression alone has not",
                past
            );
            let d = Diagnostic::error("needs_history", message);
            let advice = "put it into a model, or ask for it as a column of a run";
            return Err(raised(d.help(advice).into()));
        }
        let inputs = program.inputs().to_vec();
        Ok(Self {
            names: inputs.iter().map(ToString::to_string).collect(),
            time: inputs.iter().position(|i| *i == Input::Time),
            inputs,
            value: Compiled::new(program),
            gradient: OnceLock::new(),
            dialect,
            expr,
        })
    }

    /// The text that it was read from.
    #[getter]
    fn text(&self) -> &str {
        self.expr.text()
    }

    /// The language: "function" (radians, TIME) or "expression" (degrees, t).
    #[getter]
    fn dialect(&self) -> &'static str {
        match self.dialect {
            Dialect::Function => "function",
            Dialect::Expression => "expression",
        }
    }

    /// The names of its inputs, in the order of the text.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.names)
    }

    /// Doubts about what is legal but hardly meant, as a list of Diagnostic.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(errors::diagnostics(py, &self.expr.warnings())?.into_any())
    }

    /// Evaluate.
    ///
    /// Parameters
    /// ----------
    /// time : float or array_like, optional
    ///     The values of ``TIME`` (``t``); or, if it is a mapping, of all inputs.
    /// inputs : mapping of str to array_like, optional
    ///     Values of inputs by their names, as the expression writes them.
    /// invalid : {"raise", "nan"}
    ///     What to do at points without a value: raise ExprError, which names the operation, or
    ///     give NaN there.
    /// out : ndarray of float64, optional
    ///     Where results go, in C order.
    /// **named : array_like
    ///     Values of inputs whose names are identifiers: ``TIME=0.5``.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     The values.
    #[pyo3(signature = (time = None, inputs = None, /, *, invalid = "raise", out = None, **named))]
    fn __call__<'py>(
        &self,
        py: Python<'py>,
        time: Option<&Bound<'py, PyAny>>,
        inputs: Option<&Bound<'py, PyAny>>,
        invalid: &str,
        out: Option<Bound<'py, PyAny>>,
        named: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let invalid = Invalid::of(invalid)?;
        // a number in, a number out, by the shortest way
        if let (Some(time), None, None, None) = (time, inputs, named, &out)
            && self.inputs.len() <= 1
            && self.time.is_some() != self.inputs.is_empty()
            && let Ok(time) = time.cast_exact::<PyFloat>()
        {
            let (given, mut result) = ([time.value()], [0.0]);
            self.value.run(&given[..self.inputs.len()], &mut result);
            if given[0].is_finite() && result[0].is_finite() {
                return Ok(PyFloat::new(py, result[0]).into_any());
            }
        }
        let (mut values, extra) = self.gather(py, time, inputs, named)?;
        let Some(shape) = self.shape(py, &mut values, extra)? else {
            if out.is_some() {
                return Err(PyTypeError::new_err("out= goes with arrays"));
            }
            let given = scalars(&values);
            let mut result = [0.0];
            self.value.run(&given, &mut result);
            self.see_scalar(py, &given, &mut result, invalid)?;
            return Ok(PyFloat::new(py, result[0]).into_any());
        };
        let out = match out {
            Some(out) => out
                .cast_into::<PyArrayDyn<f64>>()
                .map_err(|_| PyTypeError::new_err("out= is an array of float64"))?,
            None => PyArrayDyn::zeros(py, &shape[..], false),
        };
        if out.shape() != shape {
            let message = format!("out= has shape {:?}, the result {shape:?}", out.shape());
            return Err(PyValueError::new_err(message));
        }
        self.over(
            py,
            &self.value,
            &values,
            std::slice::from_ref(&out),
            invalid,
        )?;
        Ok(out.into_any())
    }

    /// Differentiate with respect to every input, exactly.
    ///
    /// Parameters
    /// ----------
    /// time, inputs, invalid, **named
    ///     As for a call.
    ///
    /// Returns
    /// -------
    /// dict of str to float or ndarray
    ///     The derivative along each input, by its name.
    ///
    /// Examples
    /// --------
    /// >>> Expr("TIME**3").gradient(2.0)
    /// {'TIME': 12.0}
    #[pyo3(signature = (time = None, inputs = None, /, *, invalid = "raise", **named))]
    fn gradient<'py>(
        &self,
        py: Python<'py>,
        time: Option<&Bound<'py, PyAny>>,
        inputs: Option<&Bound<'py, PyAny>>,
        invalid: &str,
        named: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let invalid = Invalid::of(invalid)?;
        let (mut values, extra) = self.gather(py, time, inputs, named)?;
        let shape = self.shape(py, &mut values, extra)?;
        let slopes = (self.gradient)
            .get_or_init(|| Compiled::new(self.value.program.with_gradient(&self.inputs)));
        let all = PyDict::new(py);
        let Some(shape) = shape else {
            let given = scalars(&values);
            let mut result = vec![0.0; 1 + self.inputs.len()];
            slopes.run(&given, &mut result);
            self.see_scalar(py, &given, &mut result, invalid)?;
            for (name, slope) in self.names.iter().zip(&result[1..]) {
                all.set_item(name, slope)?;
            }
            return Ok(all);
        };
        let outs: Vec<_> = (0..=self.inputs.len())
            .map(|_| PyArrayDyn::zeros(py, &shape[..], false))
            .collect();
        self.over(py, slopes, &values, &outs, invalid)?;
        for (name, slope) in self.names.iter().zip(&outs[1..]) {
            all.set_item(name, slope)?;
        }
        Ok(all)
    }

    fn __repr__(&self) -> String {
        match self.dialect {
            Dialect::Function => format!("Expr({:?})", self.expr.text()),
            Dialect::Expression => format!("Expr({:?}, dialect=\"expression\")", self.expr.text()),
        }
    }

    fn __str__(&self) -> String {
        self.expr.to_string()
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.dialect == other.dialect && self.expr.text() == other.expr.text()
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        (self.expr.text(), self.dialect()).hash(&mut hasher);
        hasher.finish()
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, (String, &'static str))> {
        let maker = py.import("cognate._expr")?.getattr("_restored")?;
        let this = slf.get();
        Ok((maker, (this.expr.text().to_owned(), this.dialect())))
    }
}

/// The values of all inputs, and the shape of what was given for TIME without being read.
type Gathered<'py> = (Vec<Values<'py>>, Option<Values<'py>>);

impl Expr {
    /// Collects the values of all inputs: of TIME in the first place, of others by name.
    fn gather<'py>(
        &self,
        py: Python<'py>,
        time: Option<&Bound<'py, PyAny>>,
        inputs: Option<&Bound<'py, PyAny>>,
        named: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Gathered<'py>> {
        let mut found: Vec<Option<Values<'py>>> = self.inputs.iter().map(|_| None).collect();
        let mut extra = None;
        let mut time = time.cloned();
        // f({"DX(1, 2)": 3.0}): inputs alone
        let by_name = match inputs {
            None => match &time {
                Some(first) if is_mapping(py, first)? => time.take(),
                _ => None,
            },
            Some(inputs) => Some(inputs.clone()),
        };
        if let Some(time) = time {
            match self.time {
                Some(place) => found[place] = Some(Values::of(&time)?),
                None => extra = Some(Values::of(&time)?),
            }
        }
        let mut put = |name: &str, value: &Bound<'py, PyAny>| -> PyResult<()> {
            match self.place(py, name)? {
                Some(place) if found[place].is_some() => Err(PyTypeError::new_err(format!(
                    "{} has been given twice",
                    self.names[place]
                ))),
                Some(place) => {
                    found[place] = Some(Values::of(value)?);
                    Ok(())
                }
                None => Ok(()),
            }
        };
        for given in [by_name, named.map(|n| n.clone().into_any())]
            .into_iter()
            .flatten()
        {
            for pair in given.call_method0("items")?.try_iter()? {
                let (name, value): (String, Bound<'py, PyAny>) = pair?.extract()?;
                put(&name, &value)?;
            }
        }
        let missing = |k: usize| {
            let name = &self.names[k];
            let d = Diagnostic::error(Cause::MissingValue, format!("{name} has not been given"));
            let help = match self.inputs[k] {
                Input::Time => "time comes first: f(0.5)".to_owned(),
                _ => format!("inputs of a model are given by name: f(t, {{\"{name}\": 0.5}})"),
            };
            errors::exception(py, Kind::Expr, d.help(help), Some(self.expr.text()))
        };
        let values = found.into_iter().enumerate();
        let values = values.map(|(k, value)| value.ok_or_else(|| missing(k)));
        Ok((values.collect::<PyResult<_>>()?, extra))
    }

    /// Returns the place of an input among those of the program; `None`: it is not read.
    fn place(&self, py: Python<'_>, name: &str) -> PyResult<Option<usize>> {
        if let Some(place) = self.names.iter().position(|n| n == name) {
            return Ok(Some(place));
        }
        let input = expr::input_named(name, self.dialect)
            .map_err(|e| errors::exception(py, Kind::Expr, e, Some(name)))?;
        Ok(self.inputs.iter().position(|i| *i == input))
    }

    /// Gives all values one shape; `None`: they are scalars.
    fn shape<'py>(
        &self,
        py: Python<'py>,
        values: &mut Vec<Values<'py>>,
        extra: Option<Values<'py>>,
    ) -> PyResult<Option<Vec<usize>>> {
        // what is not read gives its shape all the same: f(t) of a constant is an array
        let n = values.len();
        values.extend(extra);
        let shape = arrays::broadcast(py, values);
        values.truncate(n);
        shape
    }

    /// Runs a program over arrays of one shape; each output goes into an array.
    fn over<'py>(
        &self,
        py: Python<'py>,
        compiled: &Compiled,
        values: &[Values<'py>],
        outs: &[Bound<'py, PyArrayDyn<f64>>],
        invalid: Invalid,
    ) -> PyResult<()> {
        let contiguous = |_| PyTypeError::new_err("out= is an array in C order");
        let shared =
            |_| PyValueError::new_err("out= shares its memory with an input, or cannot be written");
        let n = outs.first().map_or(0, |out| out.len());
        let read: Vec<_> = (values.iter())
            .map(|v| match v {
                Values::Scalar(x) => Ok((Some(vec![*x; n.min(POINTS_AT_ONCE)]), None)),
                Values::Array(a) => a.try_readonly().map(|a| (None, Some(a))),
            })
            .collect::<Result<_, _>>()
            .map_err(shared)?;
        let mut write: Vec<_> = (outs.iter())
            .map(|out| out.try_readwrite())
            .collect::<Result<_, _>>()
            .map_err(shared)?;
        let mut results: Vec<&mut [f64]> = (write.iter_mut())
            .map(|out| out.as_slice_mut())
            .collect::<Result<_, _>>()
            .map_err(contiguous)?;
        let columns: Vec<(bool, &[f64])> = (read.iter())
            .map(|(scalar, array)| match (scalar, array) {
                (Some(scalar), _) => Ok((false, &scalar[..])),
                (None, Some(array)) => array.as_slice().map(|a| (true, a)),
                (None, None) => Ok((false, &[][..])),
            })
            .collect::<Result<_, _>>()
            .map_err(contiguous)?;
        for from in (0..n).step_by(POINTS_AT_ONCE) {
            let to = n.min(from + POINTS_AT_ONCE);
            let inputs: Vec<&[f64]> = (columns.iter())
                .map(|&(moves, c)| if moves { &c[from..to] } else { &c[..to - from] })
                .collect();
            let mut out: Vec<&mut [f64]> = results.iter_mut().map(|r| &mut r[from..to]).collect();
            let mut go = || {
                compiled.batch(&inputs, &mut out)?;
                let all = inputs.iter().copied().chain(out.iter().map(|r| &**r));
                Ok(all.fold(true, |so_far, numbers| so_far & are_finite(numbers)))
            };
            let finite = if n < POINTS_TO_DETACH {
                go()
            } else {
                py.detach(&mut go)
            };
            let finite = finite
                .map_err(|e: Error| errors::exception(py, Kind::Expr, e, Some(self.expr.text())))?;
            if !finite {
                self.see(py, &inputs, &mut out, Some(from), invalid)?;
            }
            if n > POINTS_AT_ONCE {
                py.check_signals()?;
            }
        }
        Ok(())
    }

    /// Looks at points without a value: complains of the first, or makes all NaN. `from`: index of
    /// the first point; `None`: there is one, which needs no number.
    fn see(
        &self,
        py: Python<'_>,
        inputs: &[&[f64]],
        out: &mut [&mut [f64]],
        from: Option<usize>,
        invalid: Invalid,
    ) -> PyResult<()> {
        let n = out.first().map_or(0, |out| out.len());
        for k in 0..n {
            let finite = inputs.iter().all(|c| c[k].is_finite());
            if finite && out.iter().all(|c| c[k].is_finite()) {
                continue;
            }
            if invalid == Invalid::Raise {
                let given: Vec<f64> = inputs.iter().map(|c| c[k]).collect();
                return Err(self.complaint(py, &given, from.map(|from| from + k)));
            }
            for column in out.iter_mut() {
                if !finite || !column[k].is_finite() {
                    column[k] = f64::NAN;
                }
            }
        }
        Ok(())
    }

    /// The same for one point.
    fn see_scalar(
        &self,
        py: Python<'_>,
        given: &[f64],
        out: &mut [f64],
        invalid: Invalid,
    ) -> PyResult<()> {
        let given: Vec<&[f64]> = given.iter().map(std::slice::from_ref).collect();
        let mut out: Vec<&mut [f64]> = out.iter_mut().map(std::slice::from_mut).collect();
        let finite = given.iter().all(|c| are_finite(c)) && out.iter().all(|c| are_finite(c));
        if finite {
            return Ok(());
        }
        self.see(py, &given, &mut out, None, invalid)
    }

    /// Returns the exception for a point without a value: the walker names the operation.
    fn complaint(&self, py: Python<'_>, given: &[f64], point: Option<usize>) -> PyErr {
        let infinite = self.names.iter().zip(given).find(|(_, x)| !x.is_finite());
        let host = |input: Input| {
            let place = self.inputs.iter().position(|i| *i == input);
            place.map(|place| given[place])
        };
        let mut d = match (infinite, self.expr.eval_with(&host)) {
            (Some((name, x)), _) => Diagnostic::error(
                "domain",
                format!("{name} is {x}, which is not a finite number"),
            ),
            (None, Err(e)) => e.into_first(),
            (None, Ok(value)) => {
                let what = format!("a derivative is not finite where the value is {value}");
                Diagnostic::error("domain", what)
            }
        };
        if let Some(point) = point {
            d.message += &format!(" (point {point})");
            d.help
                .push("invalid=\"nan\" gives NaN at such points".into());
        }
        errors::exception(py, Kind::Expr, d, Some(self.expr.text()))
    }
}

fn scalars(values: &[Values<'_>]) -> Vec<f64> {
    let number = |v: &Values<'_>| match v {
        Values::Scalar(x) => Some(*x),
        Values::Array(_) => None,
    };
    values.iter().filter_map(number).collect()
}

fn is_of_the_past(input: &Input) -> bool {
    matches!(input, Input::Delayed(_))
}

fn is_mapping(py: Python<'_>, object: &Bound<'_, PyAny>) -> PyResult<bool> {
    if object.is_instance_of::<PyDict>() {
        return Ok(true);
    }
    if object.is_instance_of::<PyFloat>() {
        return Ok(false);
    }
    let class = py.import("collections.abc")?.getattr("Mapping")?;
    object.is_instance(&class)
}

/// Returns true if all numbers are finite.
fn are_finite(numbers: &[f64]) -> bool {
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
