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
    let mut text = Vec::new();
    push_digits(x, &mut text);
    String::from_utf8_lossy(&text).into_owned()
}

/// Numbers that are written with an exponent although their digits are found with leading zeros.
const LEADING_ZEROS: std::ops::Range<f64> = 1e-5..1e-4;

/// Appends a number with the shortest decimal digits that read back as the same number: `1e300`,
/// `NaN`, `-inf`; whole numbers have no point.
pub fn push_digits(x: f64, text: &mut Vec<u8>) {
    if LEADING_ZEROS.contains(&x.abs()) {
        text.extend_from_slice(format!("{x:?}").as_bytes());
        return;
    }
    let mut buffer = zmij::Buffer::new();
    let digits = buffer.format(x).as_bytes();
    let digits = digits.strip_suffix(b".0").unwrap_or(digits);
    match digits.iter().rposition(|&c| c == b'+') {
        Some(plus) => {
            text.extend_from_slice(&digits[..plus]);
            text.extend_from_slice(&digits[plus + 1..]);
        }
        None => text.extend_from_slice(digits),
    }
}

/// Writes a number for reading: six digits, without the noise of rounding behind them.
pub fn digits_of_six(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    if rounded == 0.0 {
        return "0".into();
    }
    if (1e-4..1e6).contains(&rounded.abs()) {
        digits(rounded)
    } else {
        format!("{rounded:e}")
    }
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
    fn six_digits_have_no_noise() {
        let written = [0.95 + 1e-16, -8.106, 0.1 + 0.2, 1e-7 / 3.0, 2e6, -0.0].map(digits_of_six);
        assert_eq!(written, ["0.95", "-8.106", "0.3", "3.33333e-8", "2e6", "0"]);
    }

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

    #[test]
    fn digits_are_as_few_as_those_of_the_standard_library() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        for k in 0..20_000 {
            bits ^= bits << 13;
            bits ^= bits >> 7;
            bits ^= bits << 17;
            let usual = (bits % 1_000_000) as f64 * f64::powi(10.0, k % 45 - 25);
            for x in [f64::from_bits(bits), usual, -usual] {
                let text = format!("{x:?}");
                let text = text.strip_suffix(".0").unwrap_or(&text);
                // of two that are as near the last digit may be either
                let own = digits(x);
                assert_eq!(own.len(), text.len(), "{own} {text}");
                assert!(x.is_nan() || own.parse() == Ok(x), "{own} {text}");
            }
        }
    }
}
