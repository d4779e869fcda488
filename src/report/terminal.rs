//! A [`Plot`] as text: curves in braille characters of two by four dots each, with ranges at the
//! edges and names below.

use super::plot::{Plot, pieces};
use super::svg::{COLOURS, tick};
use crate::diagnostic::Diagnostic;
use plotters::style::RGBColor;

/// The size of a picture, and whether the terminal has colours.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// characters in a line, with the numbers at the left
    pub columns: usize,
    /// lines of the picture, without those below it
    pub lines: usize,
    /// whether escape sequences for colours are understood
    pub colour: bool,
}

/// Draws a plot as lines of text.
///
/// # Errors
/// When there is no finite value to show.
pub fn terminal(plot: &Plot, style: Style) -> Result<String, Diagnostic> {
    let (x, y) = plot.ranges()?;
    let number = |v: f64, range: (f64, f64)| tick(v, 0.01 * (range.1 - range.0));
    let [top, middle, bottom] = [y.1, 0.5 * (y.0 + y.1), y.0].map(|v| number(v, y));
    let margin = [&top, &middle, &bottom]
        .map(String::len)
        .into_iter()
        .max()
        .unwrap_or(0);
    let mut canvas = Canvas::new(
        style.columns.saturating_sub(margin + 2).clamp(16, 400),
        style.lines.clamp(4, 200),
    );
    for (curve, colour) in plot.curves.iter().zip((0..COLOURS.len()).cycle()) {
        for piece in pieces(&curve.points, x, 2 * canvas.columns as u32) {
            let dots: Vec<(i64, i64)> = piece
                .iter()
                .map(|p| canvas.place((p.0 - x.0) / (x.1 - x.0), (p.1 - y.0) / (y.1 - y.0)))
                .collect();
            dots.first()
                .into_iter()
                .for_each(|&dot| canvas.line(dot, dot, colour));
            dots.windows(2)
                .for_each(|w| canvas.line(w[0], w[1], colour));
        }
    }
    let mut text = heading(plot);
    for line in 0..canvas.lines {
        let label = match line {
            0 => top.as_str(),
            l if l + 1 == canvas.lines => &bottom,
            l if l == canvas.lines / 2 => &middle,
            _ => "",
        };
        text += &format!(
            "{label:>margin$} {}{}\n",
            if label.is_empty() { '│' } else { '┤' },
            canvas.text(line, style.colour)
        );
    }
    let (left, right) = (number(x.0, x), number(x.1, x));
    let gap = canvas
        .columns
        .saturating_sub(left.len() + right.len() + plot.x_label.chars().count());
    let (before, after) = (gap / 2, gap - gap / 2);
    text += &format!("{:margin$} └{}\n", "", "─".repeat(canvas.columns));
    text += &format!(
        "{:margin$}  {left}{:before$}{}{:after$}{right}\n",
        "", "", plot.x_label, ""
    );
    for (name, RGBColor(r, g, b)) in plot.legend().iter().zip(COLOURS.iter().cycle()) {
        let swatch = if style.colour {
            format!("\x1b[38;2;{r};{g};{b}m──\x1b[0m")
        } else {
            "──".into()
        };
        text += &format!("{:margin$}  {swatch} {name}\n", "");
    }
    Ok(text)
}

/// Returns the line above the picture: title and name of the y axis.
fn heading(plot: &Plot) -> String {
    let words: Vec<String> = [plot.title.clone(), plot.y_axis()]
        .into_iter()
        .filter(|w| !w.is_empty())
        .collect();
    if words.is_empty() {
        String::new()
    } else {
        words.join("  ") + "\n"
    }
}

/// Dots in braille characters.
struct Canvas {
    columns: usize,
    lines: usize,
    /// bits of each character, and the colour that set the last of them   (lines × columns)
    cells: Vec<(u8, usize)>,
}

/// Bits of the dots of a braille character: by line, then by column.
const BITS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];

impl Canvas {
    fn new(columns: usize, lines: usize) -> Self {
        Self {
            columns,
            lines,
            cells: vec![(0, 0); columns * lines],
        }
    }
    /// Returns the dot at a place in the unit square, whose origin is the lower left.
    fn place(&self, x: f64, y: f64) -> (i64, i64) {
        let (right, bottom) = ((2 * self.columns - 1) as f64, (4 * self.lines - 1) as f64);
        (
            (x.clamp(0.0, 1.0) * right).round() as i64,
            ((1.0 - y.clamp(0.0, 1.0)) * bottom).round() as i64,
        )
    }
    /// Sets the dots of a line between two dots.
    fn line(&mut self, a: (i64, i64), b: (i64, i64), colour: usize) {
        let steps = (b.0 - a.0).abs().max((b.1 - a.1).abs()).max(1);
        for k in 0..=steps {
            let along = |a: i64, b: i64| {
                (a as f64 + (b - a) as f64 * k as f64 / steps as f64).round() as usize
            };
            let (x, y) = (along(a.0, b.0), along(a.1, b.1));
            if let Some(cell) = self.cells.get_mut(y / 4 * self.columns + x / 2) {
                *cell = (cell.0 | BITS[y % 4][x % 2], colour);
            }
        }
    }
    /// Prints a line of characters.
    fn text(&self, line: usize, colour: bool) -> String {
        let mut text = String::new();
        for &(bits, which) in &self.cells[line * self.columns..(line + 1) * self.columns] {
            let dots = char::from_u32(0x2800 + u32::from(bits)).unwrap_or(' ');
            match bits {
                0 => text.push(' '),
                _ if colour => {
                    let RGBColor(r, g, b) = COLOURS[which];
                    text += &format!("\x1b[38;2;{r};{g};{b}m{dots}\x1b[0m");
                }
                _ => text.push(dots),
            }
        }
        text.trim_end().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Curve;

    #[test]
    fn a_rising_line_goes_from_corner_to_corner() {
        let points = (0..=10).map(|i| (f64::from(i), f64::from(i))).collect();
        let plot = Plot {
            x_label: "x".into(),
            curves: vec![Curve {
                name: "y".into(),
                points,
                ..Curve::default()
            }],
            ..Plot::default()
        };
        let text = terminal(
            &plot,
            Style {
                columns: 24,
                lines: 4,
                colour: false,
            },
        )
        .unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 1 + 4 + 2);
        assert!(
            lines[0] == "y" && lines[1].starts_with("10 ┤") && lines[4].starts_with(" 0 ┤⣀"),
            "{text}"
        );
        assert!(
            lines[1].ends_with('⠉')
                || lines[1].ends_with('⠋')
                || lines[1].ends_with('⠁')
                || lines[1].ends_with('⠊'),
            "{text}"
        );
        assert!(
            lines[6].trim_start().starts_with('0') && lines[6].ends_with("10"),
            "{text}"
        );
    }
}
