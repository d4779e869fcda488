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
/// Magnitude below which digits are found without a signed exponent.
const SIGNED_EXPONENT: f64 = 1e15;

/// Appends a number with the shortest decimal digits that read back as the same number: `1e300`,
/// `NaN`, `-inf`; whole numbers have no point.
pub fn push_digits(x: f64, text: &mut Vec<u8>) {
    // what does not move, or has no such component, is zero: a third of what is written
    if x.to_bits() == 0 {
        return text.push(b'0');
    }
    let size = x.abs();
    let mut buffer = zmij::Buffer::new();
    let digits = buffer.format(x).as_bytes();
    if LEADING_ZEROS.contains(&size) {
        return push_behind_zeros(x, digits, text);
    }
    let digits = digits.strip_suffix(b".0").unwrap_or(digits);
    let plus = match size < SIGNED_EXPONENT {
        true => None,
        false => digits.iter().position(|&c| c == b'+'),
    };
    match plus {
        Some(plus) => {
            text.extend_from_slice(&digits[..plus]);
            text.extend_from_slice(&digits[plus + 1..]);
        }
        None => text.extend_from_slice(digits),
    }
}

/// Zeros at the end of a mantissa from which on a number of [`LEADING_ZEROS`] may lie exactly in
/// the middle between two texts of 17 digits: it has 18 digits then, so no more than 10 bits.
const ZEROS_OF_TIES: u32 = 42;

/// Appends a number of [`LEADING_ZEROS`] with an exponent. `digits`: as they were found, such as
/// `0.00001234`.
fn push_behind_zeros(x: f64, digits: &[u8], text: &mut Vec<u8>) {
    let known = digits.iter().position(|c| (b'1'..=b'9').contains(c));
    let known = known.filter(|_| x.to_bits().trailing_zeros() < ZEROS_OF_TIES);
    let Some((first, others)) = known.and_then(|known| digits[known..].split_first()) else {
        // of two texts that are as near the one of the standard library is taken
        text.extend_from_slice(format!("{x:?}").as_bytes());
        return;
    };
    if x.is_sign_negative() {
        text.push(b'-');
    }
    text.push(*first);
    if !others.is_empty() {
        text.push(b'.');
        text.extend_from_slice(others);
    }
    text.extend_from_slice(b"e-5");
}

/// Prints a number as FORTRAN's E format does: one digit before the point, a signed exponent of at
/// least two digits.
pub(super) fn exponential(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$E}");
    let Some((mantissa, exponent)) = text.split_once('E') else {
        return text;
    };
    let (sign, digits) = match exponent.strip_prefix('-') {
        Some(digits) => ('-', digits),
        None => ('+', exponent),
    };
    format!("{mantissa}E{sign}{digits:0>2}")
}

/// Digits behind the point of numbers in columns.
const DECIMALS: usize = 5;

/// Width of a column of numbers.
const COLUMN: usize = 13;

/// Appends a finite number as [`exponential`] prints it with five decimals, on the right of a
/// column of 13 characters.
///
/// The shortest digits of the number round to the same six as the number itself, unless a single 5
/// follows these: a tie would otherwise be a shorter number that reads back as the same. Numbers
/// with fewer digits than that, next to zero, are rounded exactly.
pub(super) fn push_column(x: f64, text: &mut Vec<u8>) {
    let mut buffer = zmij::Buffer::new();
    let rounded = match x.is_subnormal() {
        true => None,
        false => Decimal::rounded(buffer.format(x).as_bytes()),
    };
    let Some(Decimal { digits, exponent }) = rounded else {
        let text_of_tie = format!("{:>COLUMN$}", exponential(x, DECIMALS));
        text.extend_from_slice(text_of_tie.as_bytes());
        return;
    };
    // from the right: the exponent, the digits, the sign, blanks
    let mut column = [b' '; COLUMN];
    let size = exponent.unsigned_abs();
    let n_of_exponent = if size > 99 { 3 } else { 2 };
    let at = COLUMN - n_of_exponent;
    if size > 99 {
        column[at] = b'0' + (size / 100) as u8;
    }
    column[COLUMN - 2] = b'0' + (size / 10 % 10) as u8;
    column[COLUMN - 1] = b'0' + (size % 10) as u8;
    column[at - 1] = if exponent < 0 { b'-' } else { b'+' };
    column[at - 2] = b'E';
    column[at - 2 - DECIMALS..at - 2].copy_from_slice(&digits[1..]);
    column[at - 3 - DECIMALS] = b'.';
    column[at - 4 - DECIMALS] = digits[0];
    if x.is_sign_negative() {
        column[at - 5 - DECIMALS] = b'-';
    }
    text.extend_from_slice(&column);
}

/// A number as digits, the first of which stands before the point, and a power of ten.
struct Decimal {
    /// as letters
    digits: [u8; DECIMALS + 1],
    exponent: i32,
}

impl Decimal {
    /// Rounds digits such as `-12.5` or `1e-7`; `None` where they end in the middle between two
    /// results.
    fn rounded(text: &[u8]) -> Option<Self> {
        let text = text.strip_prefix(b"-").unwrap_or(text);
        let end = text.iter().rposition(|&c| c == b'e');
        let power = end.map_or(0, |end| power_of(&text[end + 1..]));
        let text = &text[..end.unwrap_or(text.len())];
        let point = text.iter().position(|&c| c == b'.');
        let (whole, behind) = match point {
            Some(point) => (&text[..point], &text[point + 1..]),
            None => (text, &text[text.len()..]),
        };
        // the digits from the first that is not zero on: some before the point, some behind it
        let is_digit = |&c: &u8| c != b'0';
        let (whole, behind, exponent) = match whole.iter().position(is_digit) {
            Some(first) => (&whole[first..], behind, (whole.len() - first) as i32 - 1),
            None => match behind.iter().position(is_digit) {
                Some(first) => (&behind[first..], &[][..], -(first as i32) - 1),
                None => (&[][..], &[][..], 0),
            },
        };
        let mut digits = [b'0'; DECIMALS + 1];
        let (n_whole, n) = (whole.len(), digits.len());
        let of_whole = n_whole.min(n);
        digits[..of_whole].copy_from_slice(&whole[..of_whole]);
        let of_behind = behind.len().min(n - of_whole);
        digits[of_whole..of_whole + of_behind].copy_from_slice(&behind[..of_behind]);
        let (whole, behind) = (&whole[of_whole..], &behind[of_behind..]);
        let mut further = whole.iter().chain(behind);
        let next = further.next().copied().unwrap_or(b'0');
        if next == b'5' && !further.any(is_digit) {
            return None;
        }
        let mut rounded = Self {
            digits,
            exponent: exponent + power,
        };
        if next >= b'5' {
            rounded.round_up();
        }
        Some(rounded)
    }

    /// Adds one to the last digit.
    fn round_up(&mut self) {
        for digit in self.digits.iter_mut().rev() {
            if *digit < b'9' {
                *digit += 1;
                return;
            }
            *digit = b'0';
        }
        self.digits[0] = b'1';
        self.exponent += 1;
    }
}

/// Returns the power of ten that stands behind an `e`, as `-7` or `+300`.
fn power_of(text: &[u8]) -> i32 {
    let digits = text.iter().filter(|c| c.is_ascii_digit());
    let size = digits.fold(0, |power, &c| 10 * power + i32::from(c - b'0'));
    if text.first() == Some(&b'-') {
        -size
    } else {
        size
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
    fn exponents_have_a_sign_and_two_digits() {
        let cases = [
            (0.0, "0.00000E+00"),
            (-5.0287, "-5.02870E+00"),
            (1e-100, "1.00000E-100"),
        ];
        for (x, text) in cases {
            assert_eq!(exponential(x, 5), text);
        }
    }

    #[test]
    fn digits_have_neither_a_plus_nor_an_idle_point_and_read_back() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        let mut odd = vec![
            0.0,
            -0.0,
            1e15,
            1e16,
            1e17,
            1e300,
            3e-5,
            5e-324,
            f64::INFINITY,
        ];
        odd.extend((0..300).map(|k| f64::powi(1.7, k - 150)));
        for _ in 0..2000 {
            bits ^= bits << 13;
            bits ^= bits >> 7;
            bits ^= bits << 17;
            odd.push(f64::from_bits(bits));
        }
        for x in odd.into_iter().filter(|x| !x.is_nan()) {
            let text = digits(x);
            let read: f64 = text.parse().expect("a number");
            assert_eq!(read.to_bits(), x.to_bits(), "{text}");
            assert!(!text.contains('+') && !text.ends_with(".0"), "{text}");
        }
        assert_eq!(
            [0.0, -0.0, 12.0, 1e300].map(digits),
            ["0", "-0", "12", "1e300"]
        );
    }

    #[test]
    fn columns_hold_what_exact_rounding_gives() {
        let same = |x: f64| {
            let mut text = Vec::new();
            push_column(x, &mut text);
            let exact = format!("{:>13}", exponential(x, 5));
            assert_eq!(String::from_utf8_lossy(&text), exact, "{x:?}");
        };
        // ties, carries, ends of the range, zeros
        let odd = [
            0.0,
            1.0,
            10.0,
            1234565.0,
            1234575.0,
            0.1234565,
            1.234565,
            9.999995,
            99999.95,
            999999.5,
            999999.4,
            5e-324,
            f64::MAX,
            f64::MIN_POSITIVE,
            1e-5,
            9.9e-5,
            1e15,
            1e16,
            123456789e9,
            1e99,
            9.999999e99,
            1e-99,
            9.999999e-100,
            4.5,
            0.5,
        ];
        odd.into_iter()
            .for_each(|x| [x, -x].into_iter().for_each(same));
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        for k in 0..20_000 {
            bits ^= bits << 13;
            bits ^= bits >> 7;
            bits ^= bits << 17;
            let few = (bits % 10_000_000) as f64;
            let usual = few * f64::powi(10.0, k % 45 - 25);
            let tie = (10.0 * few.trunc() + 5.0) / f64::powi(2.0, k % 30);
            let any = f64::from_bits(bits);
            [any, usual, -usual, tie]
                .into_iter()
                .filter(|x| x.is_finite())
                .for_each(same);
        }
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
    fn digits_next_to_zero_are_those_of_the_standard_library() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        let any = (0..20_000).map(|_| {
            bits ^= bits << 13;
            bits ^= bits >> 7;
            bits ^= bits << 17;
            LEADING_ZEROS.start * (1.0 + 8.999 * (bits >> 11) as f64 / f64::powi(2.0, 53))
        });
        // what may lie in the middle between two texts
        let ties = (42..839).flat_map(|k| [22, 23].map(|p| f64::from(k) / f64::powi(2.0, p)));
        let few = (1..1000).map(|k| f64::from(k) * 1e-7);
        for x in any.chain(ties).chain(few) {
            if LEADING_ZEROS.contains(&x) {
                assert_eq!(digits(x), format!("{x:?}"));
                assert_eq!(digits(-x), format!("{:?}", -x));
            }
        }
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
