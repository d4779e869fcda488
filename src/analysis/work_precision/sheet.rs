//! Studies as one SVG picture: a small chart of time over error for each, for pages that cannot
//! show HTML.

use super::page::{charts, colour, methods};
use super::{Study, chart};
use quick_xml::escape::escape;
use std::fmt::Write as _;

/// Charts side by side.
const COLUMNS: usize = 3;
/// Size of a chart, over its size on a page of HTML.
const SCALE: f64 = 0.62;
/// Height of the title of a chart, in px.
const TITLE: f64 = 26.0;
/// Height of the legend, in px.
const LEGEND: f64 = 34.0;
/// Distance of the names in the legend, in px.
const NAME: f64 = 110.0;

/// Draws a chart of processor time over error for each study.
pub fn sheet(studies: &[Study]) -> String {
    let [wide, high] = chart::SIZE.map(|px| SCALE * px);
    let rows = studies.len().div_ceil(COLUMNS);
    let (width, height) = (COLUMNS as f64 * wide, LEGEND + rows as f64 * (high + TITLE));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" height=\"{height:.0}\">\n\
         <style>text{{font:13px system-ui,sans-serif;fill:#26262c}}.t{{font-weight:600}}</style>\n\
         <rect width=\"{width:.0}\" height=\"{height:.0}\" fill=\"#fff\"/>\n"
    );
    let mut named: Vec<&str> = Vec::new();
    for method in studies.iter().flat_map(methods) {
        if !named.contains(&method) {
            named.push(method);
        }
    }
    for (k, method) in named.iter().enumerate() {
        let x = 12.0 + NAME * k as f64;
        let _ = writeln!(
            svg,
            "<rect x=\"{x}\" y=\"14\" width=\"16\" height=\"4\" fill=\"{}\"/><text x=\"{}\" y=\"21\">{}</text>",
            colour(method),
            x + 22.0,
            escape(*method)
        );
    }
    for (k, study) in studies.iter().enumerate() {
        let x = (k % COLUMNS) as f64 * wide;
        let y = LEGEND + (k / COLUMNS) as f64 * (high + TITLE);
        let [over_error, _] = charts(study, &methods(study));
        let _ = writeln!(
            svg,
            "<g transform=\"translate({x:.1} {y:.1})\"><text class=\"t\" x=\"{:.1}\" y=\"19\">{}</text>\n\
             <g transform=\"translate(0 {TITLE}) scale({SCALE})\">{}</g></g>",
            SCALE * chart::MARGIN[0],
            escape(&study.name),
            over_error.svg(&colour)
        );
    }
    svg += "</svg>\n";
    svg
}
