//! Tables of results: columns as arrays without a copy, the record, files.

use crate::errors::{self, Kind};
use crate::model::Model;
use cognate::diagnostic::Diagnostic;
use cognate::internals::dataset::surface::Surfaces;
use cognate::internals::motion::{MarkerMeasure, Recorded};
use cognate::internals::report::mechanism::page::page_of_run;
use cognate::model::ElementId;
use cognate::results::format::Style;
use cognate::results::{
    self, Column, Component, Entity, Requested, Run, Sequence, Units, json, msg,
};
use numpy::ndarray::ArrayView1;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use std::path::PathBuf;

/// The results of a run, which no longer change.
#[pyclass(module = "pycognate._core", frozen)]
pub struct Results {
    run: Run,
    /// the record as JSON
    record: String,
    /// the rows that tables show, where these follow each other
    shown: Option<std::ops::Range<usize>>,
}

impl Results {
    /// Takes the results of a run.
    pub fn new(run: Run) -> Self {
        let record = json::text(&json::record(&run));
        Self::with_record(run, record)
    }

    fn with_record(run: Run, record: String) -> Self {
        let rows: Vec<usize> = run.table_rows().collect();
        let shown = match (rows.first(), rows.last()) {
            (Some(&first), Some(&last)) => {
                (last + 1 - first == rows.len()).then_some(first..last + 1)
            }
            _ => Some(0..0),
        };
        Self { run, record, shown }
    }

    fn at(&self, index: usize) -> PyResult<&Column> {
        let column = self.run.columns.get(index);
        column.ok_or_else(|| PyIndexError::new_err("there is no such column"))
    }
}

/// Name of a result set, its element, kind and number, and its components with their columns.
type Set = (String, String, String, u64, Vec<(String, usize)>);

/// A REQUEST: number, kind, markers, columns of its components.
type Asked = (u32, u32, [u32; 3], [Option<usize>; 8]);

/// Everything that makes results again: the maker, its arguments.
type Reduced<'py> = (Bound<'py, PyAny>, (Frame, Vec<Bound<'py, PyArray1<f64>>>));

/// Everything of a table but its numbers, as `__reduce__` hands it on.
#[derive(FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
struct Frame {
    name: String,
    title: String,
    /// angle, length, mass, time, force
    units: [String; 5],
    /// name, unit, index of the column that it is the bar of
    columns: Vec<(String, String, Option<usize>)>,
    table: Vec<usize>,
    requests: Vec<Asked>,
    /// name, element, kind, number, components
    entities: Vec<Set>,
    /// name, kind, first row, row after the last
    sequences: Vec<(String, String, usize, usize)>,
    record: String,
}

#[pymethods]
impl Results {
    /// Read a file of results; the ending of its name tells the format.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let run = py.detach(|| results::read(&path));
        let raised = |d| errors::exception(py, Kind::Results, d, None);
        run.map(Self::new).map_err(raised)
    }

    /// Return the page that shows the run in motion, and the shells that cannot be read.
    fn page(&self, py: Python<'_>, model: &Model) -> PyResult<(String, Vec<String>)> {
        let folders: Vec<PathBuf> = model.folder().into_iter().collect();
        let (page, unread) = py.detach(|| {
            let surfaces = Surfaces::read(&model.model, &folders);
            let page = page_of_run(&model.model, &self.run, &surfaces);
            (page, surfaces.unread)
        });
        let page = page.map_err(|d| errors::exception(py, Kind::Results, d, None))?;
        let told = |(id, why): (ElementId, String)| format!("{id} is not drawn: {why}");
        Ok((page, unread.into_iter().map(told).collect()))
    }

    /// Make the results again that were pickled.
    #[staticmethod]
    fn restored(frame: Frame, values: Vec<Bound<'_, PyArray1<f64>>>) -> PyResult<Self> {
        let [angle, length, mass, time, force] = frame.units;
        let kind = |word: &str| {
            let known = results::Kind::NAMES.iter().find(|row| row.1 == word);
            known
                .map(|row| row.0)
                .ok_or_else(|| PyValueError::new_err("no results of this package"))
        };
        let columns = frame.columns.into_iter().zip(values);
        let columns = columns.map(|((name, unit, bar_of), values)| {
            let values = values.try_readonly()?.as_slice()?.to_vec();
            Ok(Column {
                name,
                unit,
                values,
                bar_of,
            })
        });
        let entities = frame
            .entities
            .into_iter()
            .map(|(name, entity, kind, id, components)| {
                let components = components.into_iter();
                let components = components.map(|(name, column)| Component { name, column });
                Entity {
                    name,
                    entity,
                    kind,
                    id,
                    components: components.collect(),
                }
            });
        let sequences = frame.sequences.into_iter().map(|(name, word, first, end)| {
            Ok(Sequence {
                name,
                kind: kind(&word)?,
                rows: first..end,
            })
        });
        let run = Run {
            name: frame.name,
            title: frame.title,
            units: Units {
                angle,
                length,
                mass,
                time,
                force,
            },
            columns: columns.collect::<PyResult<_>>()?,
            table: frame.table,
            requests: (frame.requests.into_iter())
                .map(|(id, kind, markers, columns)| Requested {
                    id,
                    kind,
                    markers,
                    columns,
                })
                .collect(),
            entities: entities.collect(),
            sequences: sequences.collect::<PyResult<_>>()?,
            ..Run::default()
        };
        Ok(Self::with_record(run, frame.record))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let run = &slf.get().run;
        let Units {
            angle,
            length,
            mass,
            time,
            force,
        } = run.units.clone();
        let frame = Frame {
            name: run.name.clone(),
            title: run.title.clone(),
            units: [angle, length, mass, time, force],
            columns: (run.columns.iter())
                .map(|c| (c.name.clone(), c.unit.clone(), c.bar_of))
                .collect(),
            table: run.table.clone(),
            requests: (run.requests.iter())
                .map(|r| (r.id, r.kind, r.markers, r.columns))
                .collect(),
            entities: (run.entities.iter())
                .map(|e| {
                    let components = e.components.iter();
                    let components = components.map(|c| (c.name.clone(), c.column)).collect();
                    (
                        e.name.clone(),
                        e.entity.clone(),
                        e.kind.clone(),
                        e.id,
                        components,
                    )
                })
                .collect(),
            sequences: (run.sequences.iter())
                .map(|s| {
                    (
                        s.name.clone(),
                        s.kind.name().to_owned(),
                        s.rows.start,
                        s.rows.end,
                    )
                })
                .collect(),
            record: slf.get().record.clone(),
        };
        let values = run
            .columns
            .iter()
            .map(|c| PyArray1::from_slice(py, &c.values));
        let maker = py.get_type::<Self>().getattr("restored")?;
        Ok((maker, (frame, values.collect())))
    }

    /// Base name of the files.
    #[getter]
    fn name(&self) -> &str {
        &self.run.name
    }

    /// Title of the dataset.
    #[getter]
    fn title(&self) -> &str {
        &self.run.title
    }

    /// Name and unit of every column, and the column that it is the bar of.
    #[getter]
    fn columns(&self) -> Vec<(String, String, Option<usize>)> {
        let all = self.run.columns.iter();
        all.map(|c| (c.name.clone(), c.unit.clone(), c.bar_of))
            .collect()
    }

    /// The columns that tables show, in their order.
    #[getter]
    fn table(&self) -> Vec<usize> {
        self.run.table_columns()
    }

    /// Elements: name of the result set, element, kind, number, and their components with columns.
    #[getter]
    fn entities(&self) -> Vec<Set> {
        let all = self.run.entities.iter().map(|e| {
            let components = e.components.iter().map(|c| (c.name.clone(), c.column));
            (
                e.name.clone(),
                e.entity.clone(),
                e.kind.clone(),
                e.id,
                components.collect(),
            )
        });
        all.collect()
    }

    /// Simulations: name, kind, first row, row after the last, among all rows.
    #[getter]
    fn sequences(&self) -> Vec<(String, &'static str, usize, usize)> {
        let all = self.run.sequences.iter();
        all.map(|s| (s.name.clone(), s.kind.name(), s.rows.start, s.rows.end))
            .collect()
    }

    /// The run record as JSON.
    #[getter]
    fn record(&self) -> &str {
        &self.record
    }

    /// The warnings of the run: code, element, sentence.
    #[getter]
    fn warnings(&self) -> Vec<(&'static str, Option<String>, String)> {
        let all = self.run.record.warnings.iter();
        let element = |w: &results::Warning| w.subject.as_ref().map(|s| s.element.clone());
        all.map(|w| (w.code, element(w), w.sentence())).collect()
    }

    /// The log of the run as the `.msg` file tells it.
    #[getter]
    fn log(&self) -> String {
        msg::write(&self.run)
    }

    /// Find the index of a column by its name, without regard to blanks and case.
    fn find(&self, name: &str) -> Option<usize> {
        self.run.find(name)
    }

    /// Find the index of a column; raise ColumnError where there is none, or there are several.
    fn resolve(&self, py: Python<'_>, name: &str) -> PyResult<usize> {
        self.run.resolve(name).map_err(|d| {
            let d = d
                .help("columns are asked for before a run: model.run(…, columns=[…])")
                .help("after it run.measure(…) finds motions of markers");
            errors::exception(py, Kind::Column, d, None)
        })
    }

    /// Find the indices of the columns of a pattern, as `slider.*`, or of one name.
    fn resolve_all(&self, py: Python<'_>, name: &str) -> PyResult<Vec<usize>> {
        let found = self.run.resolve_all(name);
        found.map_err(|d| errors::exception(py, Kind::Column, d, None))
    }

    /// Return the values of a column: a view that cannot be written.
    fn column<'py>(slf: &Bound<'py, Self>, index: usize) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let py = slf.py();
        let this = slf.get();
        let values = &this.at(index)?.values;
        let Some(shown) = this.shown.clone() else {
            let rows = this
                .run
                .table_rows()
                .filter_map(|row| values.get(row).copied());
            return Ok(PyArray1::from_iter(py, rows));
        };
        let view = ArrayView1::from(values.get(shown).unwrap_or_default());
        // SAFETY: the class is frozen, so its columns neither move nor change while it lives, and
        // the array keeps it alive as its base; nobody can write through the array
        #[expect(
            unsafe_code,
            reason = "lending memory without a copy is unsafe in numpy; the only place of this crate"
        )]
        let array = unsafe { PyArray1::borrow_from_array(&view, slf.clone().into_any()) };
        array.readwrite().make_nonwriteable();
        Ok(array)
    }

    /// Find a measure of markers from what has been recorded.
    fn measure<'py>(
        &self,
        py: Python<'py>,
        model: &Bound<'py, Model>,
        name: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let of = &model.get().model;
        let told = |wrong: Vec<Diagnostic>| errors::exception(py, Kind::Model, wrong, Some(name));
        let asked = MarkerMeasure::of(of, name).map_err(told)?.ok_or_else(|| {
            let what = format!("`{name}` is no measure of markers alone");
            let d = Diagnostic::error("usage", what);
            let d = d.help("others are asked for before a run: model.run(…, columns=[…])");
            errors::exception(py, Kind::Model, d, Some(name))
        })?;
        let column = Recorded::new(&self.run, of).column(name, &asked);
        let column = column.map_err(|d| errors::exception(py, Kind::Model, d, None))?;
        let rows = self
            .run
            .table_rows()
            .filter_map(|row| column.values.get(row).copied());
        Ok(PyArray1::from_iter(py, rows))
    }

    /// Write a file; the ending of its name tells the format.
    #[pyo3(signature = (path, *, units = true, decimal_comma = false))]
    fn write(
        &self,
        py: Python<'_>,
        path: PathBuf,
        units: bool,
        decimal_comma: bool,
    ) -> PyResult<()> {
        let style = Style {
            units,
            decimal_comma,
        };
        let written = py.detach(|| results::write(&self.run, &path, style));
        written.map_err(|d| errors::exception(py, Kind::Results, d, None))
    }
}
