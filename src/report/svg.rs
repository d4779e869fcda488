//! A [`Plot`] as an SVG file: light ground, axes with units, ticks at round numbers, a legend above the curves.

use super::plot::{Plot, pieces};
use crate::diagnostic::Diagnostic;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Size of the picture as it is shown.   [px]
const SHOWN: (u32, u32) = (960, 540);
/// Dots per pixel: the backend places points on whole dots, and curves must not wobble. All lengths below are in dots.
const DOTS: u32 = 10;
const SIZE: (u32, u32) = (SHOWN.0 * DOTS, SHOWN.1 * DOTS);
const LETTERS: u32 = 15 * DOTS;
const TITLE_LETTERS: u32 = 19 * DOTS;
/// Width of an average letter of a common sans-serif face, per size.
const LETTER_WIDTH: f64 = 0.56;

const INK: RGBColor = RGBColor(38, 38, 44);
const AXIS: RGBColor = RGBColor(110, 110, 120);
const GRID: RGBColor = RGBColor(226, 226, 230);

/// Colours of the curves. They differ in lightness too: everybody can tell them apart, also in grey print.
pub(super) const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 94, 162),
    RGBColor(213, 94, 0),
    RGBColor(0, 138, 98),
    RGBColor(170, 51, 119),
    RGBColor(230, 159, 0),
    RGBColor(86, 170, 222),
    RGBColor(90, 60, 150),
    RGBColor(120, 120, 120),
];

type Drawn<T> = Result<T, Box<dyn std::error::Error>>;

/// The plot as the text of an SVG file.
///
/// # Errors
/// When there is no finite value to show.
pub fn svg(plot: &Plot) -> Result<String, Diagnostic> {
    let (x, y) = plot.ranges()?;
    let margin = 0.04 * (y.1 - y.0);
    let mut text = String::new();
    let drawn = draw(plot, x, (y.0 - margin, y.1 + margin), &mut text);
    drawn.map_err(|e| {
        Diagnostic::error(
            "plot_failed",
            format!("the picture could not be drawn: {e}"),
        )
    })?;
    let size = |(w, h): (u32, u32)| format!("width=\"{w}\" height=\"{h}\"");
    Ok(text.replacen(&size(SIZE), &size(SHOWN), 1))
}

fn draw(plot: &Plot, x: (f64, f64), y: (f64, f64), text: &mut String) -> Drawn<()> {
    let root = SVGBackend::with_string(text, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.margin(14 * DOTS, 12 * DOTS, 14 * DOTS, 26 * DOTS);
    let (x_step, y_step) = (tick_step(x), tick_step(y));
    let left = y_labels_width(y, y_step);
    let mut top = 4 * DOTS as i32;
    if !plot.title.is_empty() {
        root.draw_text(
            &plot.title,
            &("sans-serif", TITLE_LETTERS).into_font().color(&INK),
            (left as i32, 0),
        )?;
        top += (TITLE_LETTERS + 8 * DOTS) as i32;
    }
    top = draw_legend(&root, &plot.legend(), left as i32, top)?;
    let (_, below) = root.split_vertically(top);

    let mut chart = (ChartBuilder::on(&below)
        .set_label_area_size(LabelAreaPosition::Bottom, 52 * DOTS))
    .set_label_area_size(LabelAreaPosition::Left, left)
    .build_cartesian_2d(x.0..x.1, y.0..y.1)?;
    (chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID.stroke_width(DOTS))
        .axis_style(AXIS.stroke_width(DOTS)))
    .x_labels(12)
    .y_labels(9)
    .set_all_tick_mark_size(5 * DOTS)
    .x_label_formatter(&|v| tick(*v, x_step))
    .y_label_formatter(&|v| tick(*v, y_step))
    .x_desc(plot.x_label.as_str())
    .y_desc(plot.y_axis())
    .label_style(("sans-serif", LETTERS - DOTS).into_font().color(&INK))
    .axis_desc_style(("sans-serif", LETTERS).into_font().color(&INK))
    .draw()?;
    for (curve, colour) in plot.curves.iter().zip(COLOURS.iter().cycle()) {
        for mut piece in pieces(&curve.points, x, SHOWN.0) {
            // The range may be narrower than the largest numbers, which have no place in pixels.
            piece
                .iter_mut()
                .for_each(|p| *p = (p.0.clamp(x.0, x.1), p.1.clamp(y.0, y.1)));
            if let [point] = piece.as_slice() {
                chart.draw_series([Circle::new(*point, 2 * DOTS, colour.filled())])?;
            } else {
                chart.draw_series(LineSeries::new(piece, colour.stroke_width(2 * DOTS)))?;
            }
        }
    }
    below.present()?;
    Ok(())
}

/// Draws the names of curves in rows from `top` on; where the rows end.
fn draw_legend<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    names: &[String],
    left: i32,
    top: i32,
) -> Drawn<i32>
where
    B::ErrorType: 'static,
{
    let (swatch, gap) = (26 * DOTS as i32, 8 * DOTS as i32);
    let (right, line) = (area.dim_in_pixel().0 as i32, (LETTERS + 7 * DOTS) as i32);
    let (mut at, mut y) = (left, top);
    let style = ("sans-serif", LETTERS)
        .into_font()
        .color(&INK)
        .pos(Pos::new(HPos::Left, VPos::Center));
    for (name, colour) in names.iter().zip(COLOURS.iter().cycle()) {
        let width =
            swatch + gap + (LETTER_WIDTH * f64::from(LETTERS) * name.chars().count() as f64) as i32;
        if at > left && at + width > right {
            (at, y) = (left, y + line);
        }
        let middle = y + line / 2;
        area.draw(&PathElement::new(
            [(at, middle), (at + swatch, middle)],
            colour.stroke_width(3 * DOTS),
        ))?;
        area.draw_text(name, &style, (at + swatch + gap, middle))?;
        at += width + 2 * gap;
    }
    Ok(if names.is_empty() {
        top
    } else {
        y + line + gap
    })
}

/// Distance of ticks that leaves about eight in a range: 1, 2 or 5 times a power of ten.
fn tick_step((low, high): (f64, f64)) -> f64 {
    let rough = (high - low) / 8.0;
    let power = 10f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|m| m * power)
        .find(|&s| s >= rough)
        .unwrap_or(rough)
}

/// A number beside an axis: as many digits as the distance of ticks needs.
pub(super) fn tick(value: f64, step: f64) -> String {
    if value.abs() < 1e-9 * step {
        return "0".into();
    }
    let trim = |text: &str| {
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text.to_owned()
        }
    };
    // One place more than the step has, for ticks at halves of it; what is not needed is cut.
    let (size, finest) = (
        value.abs().log10().floor() as i32,
        step.log10().floor() as i32 - 1,
    );
    if (-4..6).contains(&size) && finest >= -9 {
        return trim(&format!(
            "{value:.*}",
            usize::try_from(-finest).unwrap_or(0)
        ));
    }
    let text = format!(
        "{value:.*e}",
        usize::try_from(size - finest).unwrap_or(0).min(6)
    );
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{}e{exponent}", trim(mantissa))
}

/// Room for the numbers and the name of the y axis.   [dots]
fn y_labels_width(y: (f64, f64), step: f64) -> u32 {
    let longest = [y.0, 0.5 * (y.0 + y.1), y.1]
        .map(|v| tick((v / step).round() * step, step).len())
        .into_iter()
        .max()
        .unwrap_or(4);
    44 * DOTS + (LETTER_WIDTH * f64::from(LETTERS) * longest as f64) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Curve;

    #[test]
    fn ticks_have_the_digits_their_distance_needs() {
        let of = |value, step| tick(value, step);
        assert_eq!(
            [
                of(0.1 + 0.2, 0.1),
                of(1e-17, 0.1),
                of(-2.5, 0.5),
                of(250_000.0, 5e4)
            ],
            ["0.3", "0", "-2.5", "250000"]
        );
        assert_eq!(
            [
                of(3e7, 1e7),
                of(2.5e-9, 5e-10),
                of(1.0, 1.0),
                of(0.125, 0.025)
            ],
            ["3e7", "2.5e-9", "1", "0.125"]
        );
        assert_eq!(
            [
                tick_step((0.0, 1.0)),
                tick_step((0.0, 10.0)),
                tick_step((-3.0, 3.0))
            ],
            [0.2, 2.0, 1.0]
        );
    }

    #[test]
    fn a_picture_names_axes_and_curves_and_escapes_markup() {
        let curve = |name: &str| Curve {
            name: name.into(),
            unit: "mm".into(),
            points: (0..50).map(|i| (f64::from(i), f64::from(i * i))).collect(),
        };
        let plot = Plot {
            title: "a < b".into(),
            x_label: "time [sec]".into(),
            curves: vec![curve("DX(1,2)"), curve("DY(1,2)")],
            ..Plot::default()
        };
        let text = svg(&plot).unwrap();
        for part in [
            "<svg",
            "a &lt; b",
            "time [sec]",
            "[mm]",
            "DX(1,2)",
            "DY(1,2)",
            "</svg>",
        ] {
            assert!(text.contains(part), "{part}");
        }
        assert!(svg(&Plot::default()).is_err());
    }

    #[test]
    fn numbers_of_any_size_can_be_shown() {
        for y in [
            [1.0, 1.0 + 1e-11],
            [0.0, 5e-324],
            [-1e308, 1e308],
            [1e-300, 2e-300],
            [1.0, 1.0 + 1e-15],
            [-f64::MAX, f64::MAX],
        ] {
            let plot = Plot {
                curves: vec![Curve {
                    points: vec![(0.0, y[0]), (1.0, y[1])],
                    ..Curve::default()
                }],
                ..Plot::default()
            };
            assert!(svg(&plot).is_ok(), "{y:?}");
        }
    }
}
