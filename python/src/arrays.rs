//! Numbers that Python gives: scalars, lists, and arrays of any type, layout and shape.

use numpy::{PyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyFloat, PyTuple};

/// The values of one input.
#[derive(Debug)]
pub enum Values<'py> {
    /// the same number at every point
    Scalar(f64),
    /// an array in C order
    Array(Bound<'py, PyArrayDyn<f64>>),
}

impl<'py> Values<'py> {
    /// Takes what Python gives: a number, or what `numpy.asarray` understands.
    ///
    /// # Errors
    /// Values that are no real numbers, and arrays whose masked entries would be lost.
    pub fn of(given: &Bound<'py, PyAny>) -> PyResult<Self> {
        if let Ok(number) = given.cast_exact::<PyFloat>() {
            return Ok(Values::Scalar(number.value()));
        }
        // the usual case by the shortest way: an array of float64 in C order
        if given.get_type().is(given.py().get_type::<PyUntypedArray>())
            && let Ok(array) = given.cast::<PyArrayDyn<f64>>()
            && array.is_c_contiguous()
            && array.ndim() > 0
        {
            return Ok(Values::Array(array.clone()));
        }
        let py = given.py();
        let array = numpy(py)?.call_method1("asarray", (given,))?;
        let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
        // an array of objects is read number by number, which complains by itself
        if !["b", "i", "u", "f", "O"].contains(&kind.as_str()) {
            let kind = array.getattr("dtype")?;
            return Err(PyTypeError::new_err(format!(
                "an input is a real number or an array of real numbers, not of {kind}"
            )));
        }
        if given.hasattr("mask")? {
            return Err(PyTypeError::new_err(
                "a masked array has no value at masked points: give array.filled(…)",
            ));
        }
        let keywords = PyDict::new(py);
        keywords.set_item("dtype", "float64")?;
        keywords.set_item("order", "C")?;
        let array = numpy(py)?.call_method("asarray", (array,), Some(&keywords))?;
        let array = array.cast_into::<PyArrayDyn<f64>>()?;
        if array.ndim() == 0 {
            return Ok(Values::Scalar(array.call_method0("item")?.extract()?));
        }
        Ok(Values::Array(array))
    }
}

/// Gives all arrays among some values the shape that numpy's rules give them together; `None`: all
/// are scalars.
///
/// # Errors
/// Shapes that do not go together.
pub fn broadcast<'py>(py: Python<'py>, all: &mut [Values<'py>]) -> PyResult<Option<Vec<usize>>> {
    let shape = |v: &Values<'_>| match v {
        Values::Scalar(_) => None,
        Values::Array(array) => Some(array.shape().to_vec()),
    };
    let mut shapes = all.iter().filter_map(shape);
    let Some(first) = shapes.next() else {
        return Ok(None);
    };
    if shapes.all(|other| other == first) {
        return Ok(Some(first));
    }
    let arrays = all.iter().filter_map(|v| match v {
        Values::Scalar(_) => None,
        Values::Array(array) => Some(array),
    });
    let arrays = PyTuple::new(py, arrays.collect::<Vec<_>>())?;
    let mut wide = (numpy(py)?.call_method1("broadcast_arrays", arrays)?).try_iter()?;
    let mut common = first;
    for value in all {
        if let Values::Array(array) = value {
            let next = wide.next().transpose()?;
            let next = next.ok_or_else(|| PyValueError::new_err("too few arrays"))?;
            let next = numpy(py)?.call_method1("ascontiguousarray", (next,))?;
            *array = next.cast_into::<PyArrayDyn<f64>>()?;
            common = array.shape().to_vec();
        }
    }
    Ok(Some(common))
}

/// Returns the module numpy.
///
/// # Errors
/// When it cannot be imported.
pub fn numpy(py: Python<'_>) -> PyResult<&Bound<'_, PyModule>> {
    static NUMPY: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let module = NUMPY.get_or_try_init(py, || py.import("numpy").map(Bound::unbind))?;
    Ok(module.bind(py))
}
