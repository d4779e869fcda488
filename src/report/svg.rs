//! A [`Plot`] as an SVG file: light background, axes with units, ticks at round numbers, a legend
//! above the curves.

use super::plot::{Curve, Plot, Range, pieces};
use crate::diagnostic::Diagnostic;
use plotters::chart::DualCoordChartContext;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Width of a picture, in px.
const WIDTH: u32 = 960;
/// Height of a picture with one panel, in px.
const HEIGHT: u32 = 540;
/// Height of each panel of a picture with several, in px.
const PANEL: u32 = 230;
/// Dots per px: the backend places points on whole dots, and curves must not look jagged. All
/// lengths below are in dots.
const DOTS: u32 = 10;
/// Size of the letters, in dots.
const LETTERS: u32 = 15 * DOTS;
/// Size of the letters of a title, in dots.
const TITLE_LETTERS: u32 = 19 * DOTS;
/// Width of an average letter of a common sans-serif face, as a part of its size.
const LETTER_WIDTH: f64 = 0.56;
/// Size of letters as the backend draws them, as a part of what it is asked for.
const DRAWN: f64 = 1.0 / 1.24;

/// Length of a dash and of the gap behind it, in dots.
const DASH: u32 = 6 * DOTS;

const INK: RGBColor = RGBColor(38, 38, 44);
const AXIS: RGBColor = RGBColor(110, 110, 120);
const GRID: RGBColor = RGBColor(226, 226, 230);

/// Colours of the curves. They differ in lightness too: everybody can tell them apart, also in grey
/// print.
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

/// Draws a plot; returns the text of an SVG file.
///
/// # Errors
/// When there is no finite value to show.
pub fn svg(plot: &Plot) -> Result<String, Diagnostic> {
    panels(std::slice::from_ref(plot))
}

/// Draws plots below each other, each with its own y; returns the text of an SVG file. The first
/// has the title, the last the name of x.
///
/// # Errors
/// When there is nothing to show, or a plot has no finite value.
pub fn panels(plots: &[Plot]) -> Result<String, Diagnostic> {
    let ranges = plots
        .iter()
        .map(Ranges::of)
        .collect::<Result<Vec<_>, _>>()?;
    if plots.is_empty() {
        return Err(super::plot::nothing_to_show());
    }
    let height = if plots.len() == 1 {
        HEIGHT
    } else {
        60 + PANEL * plots.len() as u32
    };
    let (mut text, mut paths) = (String::new(), Vec::new());
    let size = (WIDTH * DOTS, height * DOTS);
    let drawn = draw(plots, &ranges, size, (&mut text, &mut paths));
    drawn.map_err(|e| {
        Diagnostic::error(
            "plot_failed",
            format!("the picture could not be drawn: {e}"),
        )
    })?;
    let size = |w: u32, h: u32| format!("width=\"{w}\" height=\"{h}\"");
    let text = text.replacen(&size(WIDTH * DOTS, height * DOTS), &size(WIDTH, height), 1);
    Ok(with_paths(&text, &paths))
}

/// The points of a path that the backend is not given, as it would write them: number by number it
/// would take longer than all the rest.
const LEFT_OUT: &str = "points=\"\"";

/// Puts the points of paths into the places where they were left out.
fn with_paths(text: &str, paths: &[String]) -> String {
    let mut whole =
        String::with_capacity(text.len() + paths.iter().map(String::len).sum::<usize>());
    for (k, piece) in text.split(LEFT_OUT).enumerate() {
        if let Some(path) = k.checked_sub(1).and_then(|k| paths.get(k)) {
            whole.extend(["points=\"", path, "\""]);
        }
        whole.push_str(piece);
    }
    whole
}

/// Writes points on whole dots.
fn written(points: impl Iterator<Item = (i32, i32)>) -> String {
    let mut text = String::new();
    for (x, y) in points {
        push_whole(x, &mut text);
        text.push(',');
        push_whole(y, &mut text);
        text.push(' ');
    }
    text
}

fn push_whole(x: i32, text: &mut String) {
    if x < 0 {
        text.push('-');
    }
    let (size, mut power) = (x.unsigned_abs(), 1);
    while size / power > 9 {
        power *= 10;
    }
    while power > 0 {
        text.push(char::from(b'0' + (size / power % 10) as u8));
        power /= 10;
    }
}

/// The ranges of the axes of a plot.
struct Ranges {
    x: Range,
    left: Range,
    right: Option<Range>,
}

impl Ranges {
    /// Returns the ranges of a plot, those of y with a margin.
    ///
    /// # Errors
    /// When there is no finite point.
    fn of(plot: &Plot) -> Result<Self, Diagnostic> {
        let with_margin = |(low, high): Range| {
            let margin = 0.04 * (high - low);
            (low - margin, high + margin)
        };
        let (x, left) = plot.ranges()?;
        let other = plot.at_right().map(|right| right.ranges()).transpose()?;
        let x = other.map_or(x, |(also, _)| (x.0.min(also.0), x.1.max(also.1)));
        Ok(Self {
            x,
            left: with_margin(left),
            right: other.map(|(_, y)| with_margin(y)),
        })
    }
}

/// Draws all panels on a backend, with their axes aligned; the points of curves go to `paths`.
fn draw(
    plots: &[Plot],
    ranges: &[Ranges],
    size: (u32, u32),
    (text, paths): (&mut String, &mut Vec<String>),
) -> Drawn<()> {
    let root = SVGBackend::with_string(text, size).into_drawing_area();
    root.fill(&WHITE)?;
    let mut area = root.margin(14 * DOTS, 12 * DOTS, 14 * DOTS, 26 * DOTS);
    // the axes of all panels are aligned
    let left = ranges
        .iter()
        .map(|r| y_labels_width(r.left, tick_step(r.left)))
        .max()
        .unwrap_or(0);
    let right = ranges
        .iter()
        .filter_map(|r| r.right.map(|y| y_labels_width(y, tick_step(y))))
        .max()
        .unwrap_or(0);
    if let Some(title) = plots
        .first()
        .map(|p| p.title.as_str())
        .filter(|t| !t.is_empty())
    {
        let room = area.dim_in_pixel().0 as i32 - left as i32;
        area.draw_text(
            &fitting(title, TITLE_LETTERS, room),
            &("sans-serif", TITLE_LETTERS).into_font().color(&INK),
            (left as i32, 0),
        )?;
        area = area.split_vertically((TITLE_LETTERS + 8 * DOTS) as i32).1;
    }
    let last = plots.len() - 1;
    for (k, (plot, ranges)) in plots.iter().zip(ranges).enumerate() {
        let height = area.dim_in_pixel().1 / (plots.len() - k) as u32;
        // the last panel has the name of x below it; all have curves of one height
        let name = 24 * DOTS;
        let shorter = if k == last {
            0
        } else {
            name * (plots.len() - k) as u32 / plots.len() as u32 / 2
        };
        let (panel, rest) = area.split_vertically(height.saturating_sub(shorter));
        draw_panel(plot, &panel, ranges, ([left, right], k == last), paths)?;
        area = rest;
    }
    root.present()?;
    Ok(())
}

/// Opacity of a band of error.
const BAND_OPACITY: f64 = 0.25;

/// Returns the bands of a curve, one for each stretch of points that have bars.
fn bands(curve: &Curve, colour: &RGBColor, x: Range, y: Range) -> Vec<Polygon<(f64, f64)>> {
    let band = colour.mix(BAND_OPACITY).filled();
    let points: Vec<_> = curve.points.iter().zip(&curve.bars).collect();
    let known = |p: &(&(f64, f64), &f64)| p.0.0.is_finite() && p.0.1.is_finite() && p.1.is_finite();
    let stretches = points.chunk_by(|a, b| known(a) && known(b));
    let place = |(p, bar): (&(f64, f64), f64)| (p.0.clamp(x.0, x.1), (p.1 + bar).clamp(y.0, y.1));
    stretches
        .filter(|stretch| stretch.len() > 1)
        .map(|stretch| {
            let above = stretch.iter().map(|(p, bar)| place((p, **bar)));
            let below = stretch.iter().rev().map(|(p, bar)| place((p, -**bar)));
            Polygon::new(above.chain(below).collect::<Vec<_>>(), band)
        })
        .collect()
}

/// Draws one panel: axes, legend, curves with their bands of error.
fn draw_panel<B: DrawingBackend>(
    plot: &Plot,
    area: &DrawingArea<B, Shift>,
    ranges: &Ranges,
    ([left, right], named): ([u32; 2], bool),
    paths: &mut Vec<String>,
) -> Drawn<()>
where
    B::ErrorType: 'static,
{
    let (x, y) = (ranges.x, ranges.left);
    let second = ranges.right.unwrap_or(y);
    let (x_step, y_step, second_step) = (tick_step(x), tick_step(y), tick_step(second));
    let top = draw_legend(area, &plot.legend(), left as i32, 4 * DOTS as i32)?;
    let (_, below) = area.split_vertically(top);
    let mut chart = (ChartBuilder::on(&below).set_label_area_size(
        LabelAreaPosition::Bottom,
        if named { 52 } else { 30 } * DOTS,
    ))
    .set_label_area_size(LabelAreaPosition::Left, left)
    .set_label_area_size(LabelAreaPosition::Right, right)
    .build_cartesian_2d(x.0..x.1, y.0..y.1)?
    .set_secondary_coord(x.0..x.1, second.0..second.1);
    let (wide, tall) = (below.dim_in_pixel().0 as i32, below.dim_in_pixel().1 as i32);
    let x_label = fitting(&plot.x_label, LETTERS, wide);
    let fit = (tall / (55 * DOTS as i32)).clamp(3, 9) as usize;
    let mut mesh = chart.configure_mesh();
    (mesh
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID.stroke_width(DOTS))
        .axis_style(AXIS.stroke_width(DOTS)))
    .x_labels(12)
    .y_labels(labels_of(y, fit))
    .set_all_tick_mark_size(5 * DOTS)
    .x_label_formatter(&|v| tick(*v, x_step))
    .y_label_formatter(&|v| tick(*v, y_step))
    .x_desc(if named { x_label.as_str() } else { "" })
    .y_desc(fitting(&plot.y_axis(), LETTERS, tall))
    .label_style(("sans-serif", LETTERS - DOTS).into_font().color(&INK))
    .axis_desc_style(("sans-serif", LETTERS).into_font().color(&INK))
    .draw()?;
    if let Some(other) = plot.at_right() {
        (chart.configure_secondary_axes())
            .axis_style(AXIS.stroke_width(DOTS))
            .y_labels(labels_of(second, fit))
            .set_all_tick_mark_size(5 * DOTS)
            .y_label_formatter(&|v| tick(*v, second_step))
            .y_desc(fitting(&other.y_axis(), LETTERS, tall))
            .label_style(("sans-serif", LETTERS - DOTS).into_font().color(&INK))
            .axis_desc_style(("sans-serif", LETTERS).into_font().color(&INK))
            .draw()?;
    }
    let colours = COLOURS.iter().cycle();
    let curves = (plot.curves.iter().map(|c| (c, y, false)))
        .chain(plot.right.iter().map(|c| (c, second, true)));
    for ((curve, y, at_right), colour) in curves.zip(colours) {
        draw_curve(&mut chart, (curve, at_right), colour, (x, y), paths)?;
    }
    Ok(())
}

type Axes = Cartesian2d<RangedCoordf64, RangedCoordf64>;

/// Draws a curve with its bands of error, against the axis at the right or the other.
fn draw_curve<B: DrawingBackend>(
    chart: &mut DualCoordChartContext<'_, B, Axes, Axes>,
    (curve, at_right): (&Curve, bool),
    colour: &RGBColor,
    (x, y): (Range, Range),
    paths: &mut Vec<String>,
) -> Drawn<()>
where
    B::ErrorType: 'static,
{
    let bands = bands(curve, colour, x, y);
    match at_right {
        true => chart.draw_secondary_series(bands).map(drop)?,
        false => chart.draw_series(bands).map(drop)?,
    }
    for mut piece in pieces(&curve.points, x, WIDTH) {
        // the range may be narrower than the largest numbers, which have no place in pixels
        piece
            .iter_mut()
            .for_each(|p| *p = (p.0.clamp(x.0, x.1), p.1.clamp(y.0, y.1)));
        let dot = |point| [Circle::new(point, 2 * DOTS, colour.filled())];
        let style = colour.stroke_width(2 * DOTS);
        let line = || [PathElement::new(Vec::new(), style)];
        let dashes = |piece: Vec<_>| DashedLineSeries::new(piece, DASH, DASH, style);
        match (piece.as_slice(), at_right, curve.is_dashed) {
            ([point], false, _) => drop(chart.draw_series(dot(*point))?),
            ([point], true, _) => drop(chart.draw_secondary_series(dot(*point))?),
            (_, false, false) => {
                paths.push(written(piece.iter().map(|p| chart.backend_coord(p))));
                chart.draw_series(line())?;
            }
            (_, true, false) => {
                let other = chart.borrow_secondary();
                paths.push(written(piece.iter().map(|p| other.backend_coord(p))));
                chart.draw_secondary_series(line())?;
            }
            (_, false, true) => drop(chart.draw_series(dashes(piece))?),
            (_, true, true) => drop(chart.draw_secondary_series(dashes(piece))?),
        }
    }
    Ok(())
}

/// Returns a text that is no wider than a length in dots: of a longer one the beginning and the
/// end.
fn fitting(text: &str, letters: u32, width: i32) -> String {
    let letter = LETTER_WIDTH * DRAWN * f64::from(letters);
    super::cut(text, (f64::from(width) / letter).max(8.0) as usize)
}

/// Draws the names of curves in rows from `top` on; returns the end of the rows.
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
    let widest = right - left - swatch - gap;
    let names = names.iter().map(|name| fitting(name, LETTERS, widest));
    let is_empty = names.len() == 0;
    for (name, colour) in names.zip(COLOURS.iter().cycle()) {
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
        area.draw_text(&name, &style, (at + swatch + gap, middle))?;
        at += width + 2 * gap;
    }
    Ok(if is_empty { top } else { y + line + gap })
}

/// Returns the number of labels to ask for where so many fit beside a range: more where the places
/// of fewer are so far apart that no two lie within it.
fn labels_of((low, high): Range, fit: usize) -> usize {
    let range = RangedCoordf64::from(low..high);
    let shows_scale = |&n: &usize| range.key_points(n).len() >= 2;
    (fit..3 * fit).find(shows_scale).unwrap_or(fit)
}

/// Returns the distance of ticks that leaves about eight in a range: 1, 2 or 5 times a power of
/// ten.
fn tick_step((low, high): (f64, f64)) -> f64 {
    let rough = (high - low) / 8.0;
    let power = 10f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|m| m * power)
        .find(|&s| s >= rough)
        .unwrap_or(rough)
}

/// Prints a number beside an axis, with as many digits as the distance of ticks needs.
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
    // one place more than the step has, for ticks at halves of it, as far as a number has digits;
    // trailing zeros are cut
    let size = value.abs().log10().floor() as i32;
    let finest = (step.log10().floor() as i32 - 1).max(size - 16);
    let places = |n: i32| usize::try_from(n).unwrap_or(0);
    // an exponent hides what a small step changes in a large number
    let is_plain = (-4..6).contains(&size) || (6..16).contains(&size) && finest < -1;
    if is_plain && finest >= -16 {
        return trim(&format!("{value:.*}", places(-finest)));
    }
    let text = format!("{value:.*e}", places(size - finest).min(16));
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{}e{exponent}", trim(mantissa))
}

/// Returns the width of the numbers and the name of the y axis, in dots.
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

    #[test]
    fn two_labels_at_least_show_the_scale_of_a_panel() {
        assert_eq!(labels_of((0.0, 10.0), 3), 3);
        for low in (0..200).map(|k| -100.0 + 0.97 * f64::from(k)) {
            for size in (1..60).map(|k| 0.013 * 1.3f64.powi(k)) {
                let range = (low, low + size);
                let shown = RangedCoordf64::from(range.0..range.1);
                let n = shown.key_points(labels_of(range, 3)).len();
                assert!((2..=9).contains(&n), "{n} labels from {range:?}");
            }
        }
    }

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
    fn labels_of_neighbouring_ticks_differ_however_large_their_values() {
        for low in [
            0.0,
            1.0,
            -1.0,
            999_999.5,
            1e6,
            123_456_789.0,
            -4e9,
            2e-7,
            1e12,
            1e250,
        ] {
            for size in
                [1e-10, 1e-7, 3e-4, 0.02, 1.0, 7e5].map(|s| s * f64::max(1e-9, f64::abs(low)))
            {
                let step = tick_step((low, low + size));
                let first = (low / step).ceil() * step;
                let labels: Vec<String> = (0..6)
                    .map(|k| tick(first + f64::from(k) * step, step))
                    .collect();
                for (k, label) in labels.iter().enumerate() {
                    assert!(
                        !labels[..k].contains(label),
                        "{labels:?} by {step} from {low}"
                    );
                    let read: f64 = label.parse().unwrap();
                    let value = first + f64::from(k as u32) * step;
                    assert!(
                        (read - value).abs() < 0.1 * step,
                        "{label} at {value} by {step}"
                    );
                }
            }
        }
    }

    #[test]
    fn long_names_are_cut_in_the_middle_and_short_ones_are_not() {
        let name = format!("begin{}end", "x".repeat(300));
        let cut = fitting(&name, LETTERS, (WIDTH * DOTS) as i32);
        assert!(
            cut.starts_with("begin") && cut.ends_with("end") && cut.contains('…'),
            "{cut}"
        );
        let width = LETTER_WIDTH * DRAWN * f64::from(LETTERS) * cut.chars().count() as f64;
        assert!(width <= f64::from(WIDTH * DOTS), "{cut}");
        assert_eq!(
            fitting("DX(1,2)", LETTERS, (WIDTH * DOTS) as i32),
            "DX(1,2)"
        );
        let curve = |name: &str| Curve {
            name: name.into(),
            points: vec![(0.0, 0.0), (1.0, 1.0)],
            ..Curve::default()
        };
        let curves = vec![curve(&name), curve("y")];
        let plot = Plot {
            title: name.clone(),
            x_label: name,
            curves,
            ..Plot::default()
        };
        let text = svg(&plot).unwrap();
        assert!(!text.contains(&"x".repeat(200)));
    }

    #[test]
    fn a_picture_names_axes_and_curves_and_escapes_markup() {
        let curve = |name: &str| Curve {
            name: name.into(),
            unit: "mm".into(),
            points: (0..50).map(|i| (f64::from(i), f64::from(i * i))).collect(),
            bars: vec![9.0; 50],
            ..Curve::default()
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
            "<polygon",
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
