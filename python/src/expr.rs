//! One expression of the function language over scalars and arrays.

use crate::arrays::{self, Values};
use crate::errors::{self, Kind};
use crate::names::{self, Given};
use crate::watch::Raised;
use cognate::Error;
use cognate::diagnostic::{Cause, Diagnostic};
use cognate::expr::SharedEvaluator;
use cognate::expr::ast::Dialect;
use cognate::expr::program::Input;
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyTuple};
use std::hash::{DefaultHasher, Hash, Hasher};

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
/// names : dict, optional
///     Lists of ``variables``, ``constants`` and ``functions``; ``pycognate.expr`` makes it.
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
#[pyclass(module = "pycognate", frozen)]
pub struct Expr {
    shared: SharedEvaluator,
    dialect: Dialect,
    /// place of TIME among the inputs
    time: Option<usize>,
    /// names of one's own, as they were given
    given: Option<Py<PyDict>>,
    /// what functions of one's own have raised
    raised: Raised,
}

/// The text, the language and the names that an expression is made from.
type Restored = (String, &'static str, Option<Py<PyDict>>);

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
    #[pyo3(signature = (text, *, dialect = "function", names = None))]
    fn new(
        py: Python<'_>,
        text: &str,
        dialect: &str,
        names: Option<Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
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
        let kept = Raised::default();
        let given = match names {
            Some(names) if !names::is_empty(&names)? => Some(names),
            _ => None,
        };
        let shared = match &given {
            None => SharedEvaluator::parse(text, dialect),
            Some(names) => {
                let names: Given = names.extract()?;
                SharedEvaluator::parse_with(text, &names.names(py, dialect, &kept)?)
            }
        };
        let shared = shared.map_err(raised)?;
        Ok(Self {
            given: given.map(Bound::unbind),
            raised: kept,
            time: shared.inputs().iter().position(|i| *i == Input::Time),
            shared,
            dialect,
        })
    }

    /// The text that it was read from.
    #[getter]
    fn text(&self) -> &str {
        self.shared.expr().text()
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
    #[getter(inputs)]
    fn input_names<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.names())
    }

    /// Doubts about what is legal but hardly meant, as a list of Diagnostic.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(errors::diagnostics(py, &self.shared.expr().warnings())?.into_any())
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
            && self.inputs().len() <= 1
            && self.time.is_some() != self.inputs().is_empty()
            && let Ok(time) = time.cast_exact::<PyFloat>()
        {
            let (given, mut result) = ([time.value()], [0.0]);
            self.shared.run(&given[..self.inputs().len()], &mut result);
            if given[0].is_finite() && result[0].is_finite() && !self.raised.is_set() {
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
            self.shared.run(&given, &mut result);
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
        self.over(py, &values, std::slice::from_ref(&out), invalid)?;
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
        let all = PyDict::new(py);
        let Some(shape) = shape else {
            let given = scalars(&values);
            let mut result = vec![0.0; 1 + self.inputs().len()];
            self.shared.run_slopes(&given, &mut result);
            self.see_scalar(py, &given, &mut result, invalid)?;
            for (name, slope) in self.names().iter().zip(&result[1..]) {
                all.set_item(name, slope)?;
            }
            return Ok(all);
        };
        let outs: Vec<_> = (0..=self.inputs().len())
            .map(|_| PyArrayDyn::zeros(py, &shape[..], false))
            .collect();
        self.over(py, &values, &outs, invalid)?;
        for (name, slope) in self.names().iter().zip(&outs[1..]) {
            all.set_item(name, slope)?;
        }
        Ok(all)
    }

    fn __repr__(&self) -> String {
        match self.dialect {
            Dialect::Function => format!("Expr({:?})", self.shared.expr().text()),
            Dialect::Expression => format!(
                "Expr({:?}, dialect=\"expression\")",
                self.shared.expr().text()
            ),
        }
    }

    fn __str__(&self) -> String {
        self.shared.expr().to_string()
    }

    fn __eq__(&self, py: Python<'_>, other: &Self) -> PyResult<bool> {
        let texts = [self, other].map(|e| (e.dialect, e.shared.expr().text()));
        Ok(texts[0] == texts[1]
            && match (&self.given, &other.given) {
                (None, None) => true,
                (Some(a), Some(b)) => a.bind(py).eq(b)?,
                _ => false,
            })
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        (self.shared.expr().text(), self.dialect()).hash(&mut hasher);
        hasher.finish()
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Restored)> {
        let maker = py.import("pycognate._expr")?.getattr("_restored")?;
        let this = slf.get();
        Ok((
            maker,
            (
                this.shared.expr().text().to_owned(),
                this.dialect(),
                this.given.as_ref().map(|given| given.clone_ref(py)),
            ),
        ))
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
        let mut found: Vec<Option<Values<'py>>> = self.inputs().iter().map(|_| None).collect();
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
                    self.names()[place]
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
            let name = &self.names()[k];
            let d = Diagnostic::error(Cause::MissingValue, format!("{name} has not been given"));
            let help = match self.inputs()[k] {
                Input::Time => "time comes first: f(0.5)".to_owned(),
                Input::Slot(_) => format!("variables are given by name: f({name}=0.5)"),
                _ => format!("inputs of a model are given by name: f(t, {{\"{name}\": 0.5}})"),
            };
            errors::exception(
                py,
                Kind::Expr,
                d.help(help),
                Some(self.shared.expr().text()),
            )
        };
        let values = found.into_iter().enumerate();
        let values = values.map(|(k, value)| value.ok_or_else(|| missing(k)));
        Ok((values.collect::<PyResult<_>>()?, extra))
    }

    /// Returns the place of an input among those of the program; `None`: it is not read.
    fn place(&self, py: Python<'_>, name: &str) -> PyResult<Option<usize>> {
        if let Some(place) = self.names().iter().position(|n| n == name) {
            return Ok(Some(place));
        }
        let input = self.shared.expr().input_named(name).map_err(|mut said| {
            if said.is(Cause::UnknownName) {
                said = Diagnostic::error(Cause::UnknownName, format!("there is no input `{name}`"));
            }
            let all = match self.names() {
                [] => "this expression has no inputs".to_owned(),
                all => format!("inputs of this expression: {}", all.join("; ")),
            };
            errors::exception(py, Kind::Expr, said.help(all), Some(name))
        })?;
        Ok(self.inputs().iter().position(|i| *i == input))
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
                self.shared.batch(&inputs, &mut out)?;
                Ok(SharedEvaluator::mark(&inputs, &mut out))
            };
            let first = if n < POINTS_TO_DETACH {
                go()
            } else {
                py.detach(&mut go)
            };
            self.reraise()?;
            let text = self.shared.expr().text();
            let first =
                first.map_err(|e: Error| errors::exception(py, Kind::Expr, e, Some(text)))?;
            if let (Some(first), Invalid::Raise) = (first, invalid) {
                let given: Vec<f64> = inputs.iter().map(|c| c[first]).collect();
                return Err(self.complaint(py, &given, Some(from + first)));
            }
            if n > POINTS_AT_ONCE {
                py.check_signals()?;
            }
        }
        Ok(())
    }

    /// Looks whether the one point has a value: makes it NaN, or complains.
    fn see_scalar(
        &self,
        py: Python<'_>,
        given: &[f64],
        out: &mut [f64],
        invalid: Invalid,
    ) -> PyResult<()> {
        self.reraise()?;
        let columns: Vec<&[f64]> = given.iter().map(std::slice::from_ref).collect();
        let mut out: Vec<&mut [f64]> = out.iter_mut().map(std::slice::from_mut).collect();
        match (SharedEvaluator::mark(&columns, &mut out), invalid) {
            (Some(_), Invalid::Raise) => Err(self.complaint(py, given, None)),
            _ => Ok(()),
        }
    }

    /// Raises what a function of one's own has raised.
    fn reraise(&self) -> PyResult<()> {
        match self.raised.take() {
            Some(e) => Err(e),
            None => Ok(()),
        }
    }

    /// Returns the exception for a point without a value.
    fn complaint(&self, py: Python<'_>, given: &[f64], point: Option<usize>) -> PyErr {
        let mut said = self.shared.complaint(given);
        if let Some(point) = point {
            said.message += &format!(" (point {point})");
            let advice = "invalid=\"nan\" gives NaN at such points";
            said.help.push(advice.into());
        }
        errors::exception(py, Kind::Expr, said, Some(self.shared.expr().text()))
    }

    fn inputs(&self) -> &[Input] {
        self.shared.inputs()
    }

    fn names(&self) -> &[String] {
        self.shared.names()
    }
}

fn scalars(values: &[Values<'_>]) -> Vec<f64> {
    let number = |v: &Values<'_>| match v {
        Values::Scalar(x) => Some(*x),
        Values::Array(_) => None,
    };
    values.iter().filter_map(number).collect()
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
