//! A chart with two logarithmic axes, as SVG within a page.

use quick_xml::escape::escape;
use std::fmt::Write as _;

/// Width and height of a chart, in px.
pub(super) const SIZE: [f64; 2] = [560.0, 380.0];
/// Space for axes on the left, at the top, on the right, at the bottom, in px.
pub(super) const MARGIN: [f64; 4] = [64.0, 14.0, 16.0, 48.0];
/// Most decades that have a label each.
const LABELLED: i32 = 9;

/// A curve of a chart.
pub(super) struct Curve {
    pub name: String,
    /// points with their description
    pub points: Vec<(f64, f64, String)>,
}

/// A chart.
pub(super) struct Chart {
    pub x: String,
    pub y: String,
    pub curves: Vec<Curve>,
    /// a value of x below which nothing can be told
    pub shade_below: Option<f64>,
    /// whether a line shows where x and y are equal
    pub diagonal: bool,
}

/// Colours of the curves by their place among all methods: they differ in lightness too.
pub(super) const COLOURS: [&str; 8] = [
    "#005ea2", "#d55e00", "#008a62", "#aa3377", "#e69f00", "#56aade", "#5a3c96", "#787878",
];

/// An axis: decades on pixels.
struct Axis {
    /// exponents of its ends
    decades: [i32; 2],
    /// px of its ends
    ends: [f64; 2],
}

impl Axis {
    /// Fits an axis around positive values.
    fn around(values: impl Iterator<Item = f64>, ends: [f64; 2]) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for exponent in values.filter(|x| *x > 0.0 && x.is_finite()).map(f64::log10) {
            (low, high) = (low.min(exponent), high.max(exponent));
        }
        let decades = if low > high {
            [-1, 0]
        } else {
            let low = (low - 0.05).floor() as i32;
            [low, ((high + 0.05).ceil() as i32).max(low + 1)]
        };
        Self { decades, ends }
    }

    /// Returns the place of a value, in px, within the axis.
    fn at(&self, value: f64) -> f64 {
        let [low, high] = self.decades.map(f64::from);
        let part = ((value.max(f64::MIN_POSITIVE).log10() - low) / (high - low)).clamp(0.0, 1.0);
        self.ends[0] + part * (self.ends[1] - self.ends[0])
    }

    /// Returns the exponents that have a line and a label.
    fn ticks(&self) -> impl Iterator<Item = i32> + use<> {
        let [low, high] = self.decades;
        let step = (high - low + LABELLED - 1) / LABELLED;
        (low..=high).filter(move |k| k.rem_euclid(step.max(1)) == 0)
    }
}

/// Prints a power of ten.
fn power(exponent: i32) -> String {
    format!("10<tspan dy=\"-5\" font-size=\"9\">{exponent}</tspan>")
}

impl Chart {
    /// Draws the chart; `colour` says the colour of each curve.
    pub fn svg(&self, colour: &dyn Fn(&str) -> &'static str) -> String {
        let ([width, height], [left, top, right, bottom]) = (SIZE, MARGIN);
        let points = || self.curves.iter().flat_map(|c| &c.points);
        let x = Axis::around(points().map(|p| p.0), [left, width - right]);
        let y = Axis::around(points().map(|p| p.1), [height - bottom, top]);
        let mut svg = format!(
            "<svg viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\" aria-label=\"{} against {}\">\n",
            escape(&self.y),
            escape(&self.x)
        );
        self.draw_axes(&mut svg, &x, &y);
        if self.diagonal {
            let low = x.decades[0].max(y.decades[0]);
            let high = x.decades[1].min(y.decades[1]);
            if low < high {
                let [a, b] = [low, high].map(|k| 10f64.powi(k));
                let (x1, y1, x2, y2) = (x.at(a), y.at(a), x.at(b), y.at(b));
                let _ = writeln!(
                    svg,
                    "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"#999\" stroke-dasharray=\"4 4\"/>"
                );
            }
        }
        for curve in &self.curves {
            draw_curve(&mut svg, curve, (&x, &y), colour(&curve.name));
        }
        svg += "</svg>\n";
        svg
    }

    /// Draws lines and labels of both axes, and shades what cannot be told.
    fn draw_axes(&self, svg: &mut String, x: &Axis, y: &Axis) {
        let [x0, x1] = x.ends;
        let [y0, y1] = y.ends;
        if let Some(limit) = self.shade_below {
            let _ = writeln!(
                svg,
                "<rect x=\"{x0}\" y=\"{y1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"#f0f0f2\"/>",
                x.at(limit) - x0,
                y0 - y1
            );
        }
        for k in x.ticks() {
            let at = x.at(10f64.powi(k));
            let _ = writeln!(
                svg,
                "<line x1=\"{at:.1}\" y1=\"{y0}\" x2=\"{at:.1}\" y2=\"{y1}\" stroke=\"#e2e2e6\"/>\
                 <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                y0 + 18.0,
                power(k)
            );
        }
        for k in y.ticks() {
            let at = y.at(10f64.powi(k));
            let _ = writeln!(
                svg,
                "<line x1=\"{x0}\" y1=\"{at:.1}\" x2=\"{x1}\" y2=\"{at:.1}\" stroke=\"#e2e2e6\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                x0 - 8.0,
                at + 4.0,
                power(k)
            );
        }
        let (middle_x, middle_y) = (0.5 * (x0 + x1), 0.5 * (y0 + y1));
        let _ = writeln!(
            svg,
            "<path d=\"M{x0} {y1}V{y0}H{x1}\" fill=\"none\" stroke=\"#6e6e78\"/>\
             <text x=\"{middle_x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\
             <text x=\"14\" y=\"{middle_y:.1}\" text-anchor=\"middle\" transform=\"rotate(-90 14 {middle_y:.1})\">{}</text>",
            y0 + 40.0,
            escape(&self.x),
            escape(&self.y)
        );
    }
}

fn draw_curve(svg: &mut String, curve: &Curve, (x, y): (&Axis, &Axis), colour: &str) {
    let finite = |v: f64| v.is_finite() && v > 0.0;
    let shown = curve.points.iter().filter(|p| finite(p.0) && finite(p.1));
    let places: Vec<(f64, f64, &str)> = shown
        .map(|(a, b, what)| (x.at(*a), y.at(*b), what.as_str()))
        .collect();
    let line: Vec<String> = places
        .iter()
        .map(|p| format!("{:.1},{:.1}", p.0, p.1))
        .collect();
    let _ = writeln!(
        svg,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>",
        line.join(" ")
    );
    for (px, py, what) in places {
        let _ = writeln!(
            svg,
            "<circle cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"3.2\" fill=\"{colour}\"><title>{}</title></circle>",
            escape(what)
        );
    }
}
