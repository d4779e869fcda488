//! TABLE of functions of numbers: one row is name, arguments with defaults, doc, body generic over scalar, example.

/// A function of numbers. (Contract: the table macro generates this enum, `eval`, and the rows' documentation.)
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Function {
    /// absolute value
    Abs,
}
