//! Numbers in result files, and mistakes where one should stand.

use crate::diagnostic::Diagnostic;

/// Makes an error of a mistake in the contents of a result file, at a 1-based line (0: the whole
/// file).
pub(super) fn malformed(line: usize, message: impl Into<String>) -> Diagnostic {
    let mut d = Diagnostic::error("result_syntax", message);
    d.line = line;
    d.column = usize::from(line > 0);
    d
}

/// Writes a number with the shortest decimal digits that read back as the same number.
pub fn digits(x: f64) -> String {
    let text = format!("{x:?}");
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}

/// Reads a number as result files of every age write it: `1.5`, `-2.18E-014`, `1.0D+00`,
/// `Infinity`.
pub(super) fn number(text: &str) -> Option<f64> {
    text.parse()
        .ok()
        .or_else(|| text.replace(['D', 'd'], "E").parse().ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_the_shortest_that_read_back() {
        let written = [0.1 + 0.2, 1.0, -0.0, 1e300, 5e-324, 1234567.0].map(digits);
        assert_eq!(
            written,
            [
                "0.30000000000000004",
                "1",
                "-0",
                "1e300",
                "5e-324",
                "1234567"
            ]
        );
    }
}
