//! Data and equations of the user: VARIABLE, DIFF, ARRAY, SPLINE, STRING, MATRIX, LSE, GSE, TFSISO,
//! PINPUT, POUTPUT, SENSOR.

use super::element::{Element, ElementKind, Named, names, names_each, placed};
use super::{Formula, Place};

/// VARIABLE: a number defined by an expression.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Variable {
    /// where it stands in the dataset
    pub place: Place,
    /// IC: first guess where it depends on itself
    pub ic: Option<f64>,
    /// FUNCTION
    pub function: Formula,
}

impl Element for Variable {
    placed!();
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        vec![("FUNCTION", &self.function)]
    }
}

/// DIFF: a differential equation of first order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Differential {
    /// where it stands in the dataset
    pub place: Place,
    /// IC: value and rate at the start
    pub ic: [Option<f64>; 2],
    /// STATIC_HOLD: it keeps its value in statics
    pub static_hold: bool,
    /// IMPLICIT: the function is zero rather than the rate
    pub implicit: bool,
    /// FUNCTION: the rate, or what is zero
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
pub enum ArrayKind {
    /// IC: these numbers
    Ic(Vec<f64>),
    /// X: states of the system that names it
    States,
    /// Y: outputs of the system that names it
    Outputs,
    /// U: values of these VARIABLEs
    Inputs(Vec<u32>),
}

impl Default for ArrayKind {
    fn default() -> Self {
        ArrayKind::Ic(Vec::new())
    }
}

/// ARRAY: a list that systems and functions read by number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Array {
    /// where it stands in the dataset
    pub place: Place,
    /// SIZE: number of entries
    pub size: Option<usize>,
    /// the meaning of its entries
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

/// SPLINE: a curve, or a surface of curves, through data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SplineData {
    /// where it stands in the dataset
    pub place: Place,
    /// X: abscissae, increasing   (n_x)
    pub x: Vec<f64>,
    /// one curve per z   (n_z × n_x)
    pub y: Vec<Vec<f64>>,
    /// empty for a single curve
    pub z: Vec<f64>,
    /// LINEAR_EXTRAPOLATE: straight beyond the ends, else parabolic
    pub linear_extrapolate: bool,
    /// FILE: the data stand in a file
    pub file: Option<String>,
}

impl Element for SplineData {
    placed!();
}

/// STRING: a text that routines read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StringData {
    /// where it stands in the dataset
    pub place: Place,
    /// STRING: the text
    pub text: String,
}

impl Element for StringData {
    placed!();
}

/// The order of the numbers of a MATRIX.
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

/// MATRIX: numbers in rows and columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Matrix {
    /// where it stands in the dataset
    pub place: Place,
    /// ROWS: number of rows
    pub rows: usize,
    /// COLUMNS: number of columns
    pub columns: usize,
    /// how `values` are laid out
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
    /// Returns the file in which the numbers stand, which is not read; `None` where VALUES gives
    /// them, which then count.
    pub fn unread_file(&self) -> Option<&str> {
        self.file.as_deref().filter(|_| self.values.is_empty())
    }

    /// All numbers row after row   (rows × columns), or `None` when they do not fit the stated
    /// size.
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

/// LSE: ẋ = A x + B u, y = C x + D u; numbers of ARRAY and MATRIX statements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinearSystem {
    /// where it stands in the dataset
    pub place: Place,
    /// X: array of the states
    pub x: u32,
    /// U: array of the inputs
    pub u: Option<u32>,
    /// Y: array of the outputs
    pub y: Option<u32>,
    /// IC: array of the states at the start; zeros when absent
    pub ic: Option<u32>,
    /// A: matrix, n × n
    pub a: u32,
    /// B: matrix, n × inputs
    pub b: Option<u32>,
    /// C: matrix, outputs × n
    pub c: Option<u32>,
    /// D: matrix, outputs × inputs
    pub d: Option<u32>,
    /// STATIC_HOLD: the states keep their values in statics
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

/// GSE: states and outputs computed by routines of the user's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GeneralSystem {
    /// where it stands in the dataset
    pub place: Place,
    /// NS: number of continuous states
    pub ns: usize,
    /// NO: number of outputs
    pub no: usize,
    /// X: array of the continuous states
    pub x: Option<u32>,
    /// U: array of the inputs
    pub u: Option<u32>,
    /// Y: array of the outputs
    pub y: Option<u32>,
    /// IC: array of the continuous states at the start
    pub ic: Option<u32>,
    /// FUNCTION=USER(…)
    pub function: Option<Formula>,
    /// ND: number of discrete states
    pub nd: usize,
    /// XD: array of the discrete states
    pub xd: Option<u32>,
    /// ICD: array of the discrete states at the start
    pub icd: Option<u32>,
    /// SAMPLE_PERIOD: time between samples
    pub sample_period: Option<Formula>,
    /// STATIC_HOLD: the states keep their values in statics
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

/// TFSISO: y/u = (b0 + b1 s + …)/(a0 + a1 s + …).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TransferFunction {
    /// where it stands in the dataset
    pub place: Place,
    /// X: array of the states
    pub x: u32,
    /// U: array of the one input
    pub u: u32,
    /// Y: array of the one output
    pub y: u32,
    /// b0, b1, …
    pub numerator: Vec<f64>,
    /// a0, a1, …
    pub denominator: Vec<f64>,
    /// STATIC_HOLD: the states keep their values in statics
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

/// PINPUT, POUTPUT: VARIABLEs in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plant {
    /// where it stands in the dataset
    pub place: Place,
    /// VARIABLES
    pub variables: Vec<u32>,
}

impl Element for Plant {
    placed!();
    fn references(&self) -> Vec<Named> {
        names_each(ElementKind::Variable, "VARIABLES", &self.variables)
    }
}

/// The comparison of a SENSOR.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Comparison {
    /// EQ: within ERROR of the value
    #[default]
    Equal,
    /// GE
    GreaterOrEqual,
    /// LE
    LessOrEqual,
}

/// SENSOR: watches an expression and acts when it passes a value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sensor {
    /// where it stands in the dataset
    pub place: Place,
    /// FUNCTION: the expression
    pub function: Formula,
    /// EQ, GE or LE
    pub comparison: Comparison,
    /// VALUE: compared with; in rad where ANGULAR
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
    /// PRINT: write a line when it is triggered
    pub print: bool,
    /// output step afterwards
    pub dt: Option<f64>,
    /// integration step afterwards
    pub stepsize: Option<f64>,
    /// RESTART: start the integration anew
    pub restart: bool,
    /// CODGEN: kept, without effect
    pub codgen: bool,
    /// YYDUMP: kept, without effect
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
