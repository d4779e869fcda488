//! Data and equations of the user: VARIABLE, DIFF, ARRAY, SPLINE, STRING, MATRIX, LSE, GSE, TFSISO, PINPUT, POUTPUT, SENSOR.

use super::element::{Element, ElementKind, Named, names, names_each, placed};
use super::{Formula, Place};

/// VARIABLE
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Variable {
    pub place: Place,
    pub ic: Option<f64>,
    pub function: Formula,
}

impl Element for Variable {
    placed!();
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        vec![("FUNCTION", &self.function)]
    }
}

/// DIFF
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Differential {
    pub place: Place,
    pub ic: [Option<f64>; 2],
    pub static_hold: bool,
    pub implicit: bool,
    pub function: Formula,
}

impl Element for Differential {
    placed!();
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        vec![("FUNCTION", &self.function)]
    }
}

/// ARRAY kinds.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum ArrayKind {
    Ic(Vec<f64>),
    States,
    Outputs,
    Inputs(Vec<u32>),
}

impl Default for ArrayKind {
    fn default() -> Self {
        ArrayKind::Ic(Vec::new())
    }
}

/// ARRAY
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Array {
    pub place: Place,
    pub size: Option<usize>,
    pub kind: ArrayKind,
}

impl Element for Array {
    placed!();
    fn references(&self) -> Vec<Named> {
        match &self.kind {
            ArrayKind::Inputs(all) => names_each(ElementKind::Variable, "VARIABLES", all),
            ArrayKind::Ic(_) | ArrayKind::States | ArrayKind::Outputs => Vec::new(),
        }
    }
}

/// SPLINE
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct SplineData {
    pub place: Place,
    pub x: Vec<f64>,
    /// one curve per z   (n_z × n_x)
    pub y: Vec<Vec<f64>>,
    /// empty for a single curve
    pub z: Vec<f64>,
    pub linear_extrapolate: bool,
    pub file: Option<String>,
}

impl Element for SplineData {
    placed!();
}

/// STRING
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct StringData {
    pub place: Place,
    pub text: String,
}

impl Element for StringData {
    placed!();
}

/// How the numbers of a MATRIX are laid out.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum MatrixLayout {
    /// FULL=RORDER: row after row
    #[default]
    ByRows,
    /// FULL=CORDER: column after column
    ByColumns,
    /// SPARSE: entry k stands in row `rows[k]`, column `columns[k]`, counted from 1
    Sparse {
        /// I=
        rows: Vec<u32>,
        /// J=
        columns: Vec<u32>,
    },
}

/// MATRIX
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Matrix {
    pub place: Place,
    pub rows: usize,
    pub columns: usize,
    pub layout: MatrixLayout,
    /// as laid out
    pub values: Vec<f64>,
    /// FILE and NAME: the numbers stand in a file
    pub file: Option<String>,
}

impl Element for Matrix {
    placed!();
}

impl Matrix {
    /// All numbers row after row   (rows × columns), or `None` when they do not fit the stated size.
    pub fn by_rows(&self) -> Option<Vec<f64>> {
        let (m, n) = (self.rows, self.columns);
        let size = m.checked_mul(n).filter(|&s| s <= 1 << 28)?;
        match &self.layout {
            MatrixLayout::ByRows => (self.values.len() == size).then(|| self.values.clone()),
            MatrixLayout::ByColumns => (self.values.len() == size).then(|| {
                let at = |k: usize| self.values[(k % n) * m + k / n];
                (0..size).map(at).collect()
            }),
            MatrixLayout::Sparse { rows, columns } => {
                if rows.len() != self.values.len() || columns.len() != self.values.len() {
                    return None;
                }
                let mut full = vec![0.0; size];
                for ((&i, &j), &v) in rows.iter().zip(columns).zip(&self.values) {
                    let (i, j) = (i as usize, j as usize);
                    if i == 0 || j == 0 || i > m || j > n {
                        return None;
                    }
                    full[(i - 1) * n + j - 1] = v;
                }
                Some(full)
            }
        }
    }
}

/// LSE: ẋ = A x + B u, y = C x + D u; numbers of ARRAY and MATRIX statements
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct LinearSystem {
    pub place: Place,
    pub x: u32,
    pub u: Option<u32>,
    pub y: Option<u32>,
    pub ic: Option<u32>,
    pub a: u32,
    pub b: Option<u32>,
    pub c: Option<u32>,
    pub d: Option<u32>,
    pub static_hold: bool,
}

impl Element for LinearSystem {
    placed!();
    fn references(&self) -> Vec<Named> {
        let mut all = names(ElementKind::Array, [("X", self.x)]);
        let arrays = [("U", self.u), ("Y", self.y), ("IC", self.ic)];
        all.extend(names(ElementKind::Array, arrays));
        all.extend(names(ElementKind::Matrix, [("A", self.a)]));
        let matrices = [("B", self.b), ("C", self.c), ("D", self.d)];
        all.extend(names(ElementKind::Matrix, matrices));
        all
    }
}

/// GSE: states and outputs computed by routines of the user's
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct GeneralSystem {
    pub place: Place,
    /// number of states, of outputs
    pub ns: usize,
    pub no: usize,
    pub x: Option<u32>,
    pub u: Option<u32>,
    pub y: Option<u32>,
    pub ic: Option<u32>,
    pub function: Option<Formula>,
    /// number of discrete states, their array, their initial values, the time between samples
    pub nd: usize,
    pub xd: Option<u32>,
    pub icd: Option<u32>,
    pub sample_period: Option<Formula>,
    pub static_hold: bool,
}

impl Element for GeneralSystem {
    placed!();
    fn references(&self) -> Vec<Named> {
        let arrays = [
            ("X", self.x),
            ("U", self.u),
            ("Y", self.y),
            ("IC", self.ic),
            ("XD", self.xd),
            ("ICD", self.icd),
        ];
        names(ElementKind::Array, arrays)
    }
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        let function = self.function.iter().map(|f| ("FUNCTION", f));
        let period = self.sample_period.iter().map(|f| ("SAMPLE_PERIOD", f));
        function.chain(period).collect()
    }
}

/// TFSISO: y/u = (b0 + b1 s + …)/(a0 + a1 s + …)
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct TransferFunction {
    pub place: Place,
    pub x: u32,
    pub u: u32,
    pub y: u32,
    /// b0, b1, …
    pub numerator: Vec<f64>,
    /// a0, a1, …
    pub denominator: Vec<f64>,
    pub static_hold: bool,
}

impl Element for TransferFunction {
    placed!();
    fn references(&self) -> Vec<Named> {
        names(
            ElementKind::Array,
            [("X", self.x), ("U", self.u), ("Y", self.y)],
        )
    }
}

/// PINPUT, POUTPUT: VARIABLEs in order
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Plant {
    pub place: Place,
    pub variables: Vec<u32>,
}

impl Element for Plant {
    placed!();
    fn references(&self) -> Vec<Named> {
        names_each(ElementKind::Variable, "VARIABLES", &self.variables)
    }
}

/// How a SENSOR compares.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[rustfmt::skip]
pub enum Comparison { #[default] Equal, GreaterOrEqual, LessOrEqual }

/// SENSOR
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Sensor {
    pub place: Place,
    pub function: Formula,
    pub comparison: Comparison,
    pub value: f64,
    /// 1e-3 when absent
    pub error: Option<f64>,
    /// compare modulo 2π
    pub angular: bool,
    /// locate the instant to this error in time
    pub bisection: Option<f64>,
    /// what SENVAL returns after the trigger
    pub evaluate: Option<Formula>,
    /// stop the run
    pub halt: bool,
    /// end this simulation, go on with the next command
    pub end_simulation: bool,
    pub print: bool,
    /// output step afterwards
    pub dt: Option<f64>,
    /// integration step afterwards
    pub stepsize: Option<f64>,
    pub restart: bool,
    pub codgen: bool,
    pub yydump: bool,
}

impl Element for Sensor {
    placed!();
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        let function = std::iter::once(("FUNCTION", &self.function));
        let evaluate = self.evaluate.iter().map(|f| ("EVALUATE", f));
        function.chain(evaluate).collect()
    }
}
