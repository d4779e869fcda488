//! Numbers as sentences write them: few digits, lengths with their unit, points in parentheses.

use crate::scalar::Scalar;
use crate::space::Vec3;

/// Writes the size of a length with its unit.
pub(in crate::analysis) fn length(value: f64, unit: &str) -> String {
    let number = short(value.abs());
    if unit.is_empty() {
        number
    } else {
        format!("{number} {unit}")
    }
}

/// Writes the size of a length with its unit, or of an angle, given in rad, in degrees.
pub(in crate::analysis) fn amount(value: f64, is_length: bool, unit: &str) -> String {
    if is_length {
        length(value, unit)
    } else {
        format!("{} deg", short(value.abs().to_degrees()))
    }
}

/// Writes a number with four digits, without zeros that say nothing.
pub(in crate::analysis) fn short(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    if !(1e-3..1e5).contains(&x.abs()) {
        return format!("{x:.3e}");
    }
    let decimals = (3 - Scalar::log10(x.abs()).floor() as i32).max(0) as usize;
    let text = format!("{x:.decimals$}");
    if decimals == 0 {
        return text;
    }
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}

/// Writes values of coordinates, the first four: "JOINT/1 angle = 1.571, JOINT/2 angle = 0".
pub(in crate::analysis) fn place(coordinates: &[(String, f64)]) -> String {
    /// Coordinates that are shown, at most.
    const SHOWN: usize = 4;
    let rounded = |x: f64| if x.abs() < 1e-12 { 0.0 } else { x };
    let some = coordinates.iter().take(SHOWN);
    let some: Vec<String> = some
        .map(|(name, x)| format!("{name} = {}", short(rounded(*x))))
        .collect();
    let more = if coordinates.len() > SHOWN {
        ", …"
    } else {
        ""
    };
    format!("{}{more}", some.join(", "))
}

/// Writes the three components of a vector with four decimals each.
pub(in crate::analysis) fn point(p: Vec3<f64>) -> String {
    let largest = p.0.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let number = |x: f64| {
        let x = if x.abs() < 1e-6 * largest { 0.0 } else { x };
        // four decimals would show no digit of it
        if x != 0.0 && x.abs() < 0.5e-4 {
            return format!("{x:.3e}");
        }
        let text = format!("{x:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_string()
    };
    format!(
        "({}, {}, {})",
        number(p.0[0]),
        number(p.0[1]),
        number(p.0[2])
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits_and_no_idle_zeros() {
        let written = [0.0, 12.5, 0.001, 12345.678, 1e-7, -3.0, 1e6].map(short);
        let expected = ["0", "12.5", "0.001", "12346", "1.000e-7", "-3", "1.000e6"];
        assert_eq!(written, expected);
        assert_eq!(length(-2.0, "mm"), "2 mm");
        assert_eq!(length(2.0, ""), "2");
    }

    #[test]
    fn points_show_small_components_and_drop_rounding() {
        let written = point(Vec3([1.0, 1e-9, -0.00002]));
        assert_eq!(written, "(1, 0, -2.000e-5)");
    }
}
