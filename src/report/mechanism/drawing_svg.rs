//! A [`Drawing`] as the text of an SVG file.

use super::drawing::{Drawing, Mark, Point, shaded};
use super::labels::{Area, Placed, placed, written};
use crate::diagnostic::counted;
use std::collections::BTreeSet;

/// Width of a margin, in px.
const MARGIN: f64 = 26.0;
/// Width of a thin line, in px.
const LINE: f64 = 1.6;
/// Size of letters, in px.
const LETTERS: f64 = 13.0;
/// Most that the bar of the scale is long, in px.
const BAR: f64 = 110.0;
/// Largest share of the width of a picture that its height is.
const HIGHEST: f64 = 1.0;

/// Returns the text of an SVG file of a width in px; `unit`: of lengths, for the bar of the scale.
pub fn svg(drawing: &Drawing, width: f64, unit: &str) -> String {
    let size = [0, 1].map(|k| (drawing.high[k] - drawing.low[k]).max(f64::MIN_POSITIVE));
    let inside = width - 2.0 * MARGIN;
    let scale = (inside / size[0]).min((HIGHEST * width - 2.0 * MARGIN) / size[1]);
    let height = (scale * size[1] + 2.0 * MARGIN).max(140.0) + LETTERS;
    let paper = Paper {
        scale,
        left: (width - scale * size[0]) / 2.0 - scale * drawing.low[0],
        top: MARGIN.max((height - LETTERS - scale * size[1]) / 2.0) + scale * drawing.high[1],
    };
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"0 0 {width:.0} {height:.0}\" \
         font-family=\"sans-serif\" font-size=\"{LETTERS}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
    );
    paper.gradients(drawing, &mut text);
    let mut names = paper.names(drawing, [width, height]).into_iter();
    let left_out = names
        .clone()
        .filter(|name| *name == Placed::LeftOut)
        .count();
    for layer in &drawing.layers {
        let see_through = layer.opacity < 1.0;
        if see_through {
            text += &format!("<g opacity=\"{}\">\n", layer.opacity);
        }
        for mark in &layer.marks {
            match mark {
                Mark::Word {
                    at,
                    text: word,
                    colour,
                } => {
                    let name = names.next().unwrap_or(Placed::There);
                    let word = written(word, width, LETTERS);
                    paper.word(*at, &word, *colour, name, &mut text);
                }
                Mark::Faces { .. } | Mark::Stroke { .. } | Mark::Ball { .. } => {
                    paper.mark(mark, &mut text);
                }
            }
        }
        if see_through {
            text += "</g>\n";
        }
    }
    if left_out > 0 {
        text += &format!(
            "<text x=\"12\" y=\"{}\" font-size=\"11\" fill=\"#66707c\">left out for want of room: {}</text>\n",
            short(height - 10.0),
            counted(left_out, "name"),
        );
    }
    paper.bar([width, height], unit, &mut text);
    text + "</svg>\n"
}

/// The place of a drawing on the picture.
struct Paper {
    /// px per unit of length
    scale: f64,
    left: f64,
    top: f64,
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Returns a number with a digit behind the point, if it needs one.
fn short(x: f64) -> String {
    let rounded = (10.0 * x).round() / 10.0;
    // no negative zero
    format!("{}", rounded + 0.0)
}

impl Paper {
    /// Returns where a point is on the picture, in px.
    fn at(&self, p: Point) -> [f64; 2] {
        [self.left + self.scale * p[0], self.top - self.scale * p[1]]
    }

    /// Returns the same as it is written.
    fn place(&self, p: Point) -> [String; 2] {
        self.at(p).map(short)
    }

    fn path(&self, points: &[Point]) -> String {
        let all: Vec<String> = points.iter().map(|p| self.place(*p).join(" ")).collect();
        format!("M{}", all.join("L"))
    }

    /// Writes the gradients that balls are filled with.
    fn gradients(&self, drawing: &Drawing, text: &mut String) {
        let marks = drawing.layers.iter().flat_map(|l| &l.marks);
        let colours: BTreeSet<[u8; 3]> = marks
            .filter_map(|mark| match mark {
                Mark::Ball { colour, .. } => Some(*colour),
                Mark::Faces { .. } | Mark::Stroke { .. } | Mark::Word { .. } => None,
            })
            .collect();
        for colour in colours {
            let [light, dark] = [1.35, 0.72].map(|b| hex(shaded(colour, b)));
            let name = &hex(colour)[1..];
            *text += &format!(
                "<radialGradient id=\"b{name}\" cx=\"0.38\" cy=\"0.32\" r=\"0.75\"><stop offset=\"0\" stop-color=\"{light}\"/>\
                 <stop offset=\"1\" stop-color=\"{dark}\"/></radialGradient>\n"
            );
        }
    }

    fn mark(&self, mark: &Mark, text: &mut String) {
        match mark {
            Mark::Faces {
                outlines,
                colour,
                edges,
                sheer,
            } => {
                let all: String = outlines.iter().map(|o| self.path(o) + "Z").collect();
                let (fill, dark) = (hex(*colour), hex(shaded(*colour, 0.6)));
                let stroke = if *edges { &dark } else { &fill };
                let opacity = if *sheer { " fill-opacity=\"0.35\"" } else { "" };
                *text += &format!(
                    "<path d=\"{all}\" fill=\"{fill}\"{opacity} stroke=\"{stroke}\" stroke-width=\"0.7\"/>\n"
                );
            }
            Mark::Stroke {
                points,
                width,
                colour,
                is_rod,
            } => self.stroke(points, *width, *colour, *is_rod, text),
            Mark::Ball {
                centre,
                radius,
                colour,
            } => {
                let [x, y] = self.place(*centre);
                let r = short((radius * self.scale).max(2.0));
                let (name, dark) = (hex(*colour), hex(shaded(*colour, 0.55)));
                let fill = format!(
                    "fill=\"url(#b{})\" stroke=\"{dark}\" stroke-width=\"0.8\"",
                    &name[1..]
                );
                *text += &format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" {fill}/>\n");
            }
            // names are written where there is room
            Mark::Word { .. } => {}
        }
    }

    /// Returns where the names of a drawing go on a picture.
    fn names(&self, drawing: &Drawing, size: [f64; 2]) -> Vec<Placed> {
        let marks = drawing.layers.iter().flat_map(|l| &l.marks);
        let words = marks.filter_map(|mark| match mark {
            Mark::Word { at, text, .. } => Some((self.at(*at), written(text, size[0], LETTERS))),
            Mark::Faces { .. } | Mark::Stroke { .. } | Mark::Ball { .. } => None,
        });
        let bar = Area {
            middle: [size[0] - 12.0 - BAR / 2.0, size[1] - 16.0],
            half: [BAR / 2.0, 14.0],
        };
        placed(&words.collect::<Vec<_>>(), size, LETTERS, &[bar])
    }

    /// Writes a name, with a line to its point where it stands beside that.
    fn word(&self, at: Point, word: &str, colour: [u8; 3], name: Placed, text: &mut String) {
        let fill = hex(colour);
        let point = self.place(at);
        let [x, y] = match name {
            Placed::LeftOut => return,
            Placed::There => point,
            Placed::Moved(middle) => middle.map(short),
            Placed::Beside(middle) => {
                let middle = middle.map(short);
                *text += &format!(
                    "<path d=\"M{}L{}\" stroke=\"{fill}\" stroke-width=\"0.8\" stroke-opacity=\"0.7\"/>\n",
                    point.join(" "),
                    middle.join(" "),
                );
                middle
            }
        };
        let escaped = quick_xml::escape::partial_escape(word);
        let look =
            "text-anchor=\"middle\" stroke=\"#ffffff\" stroke-width=\"4\" paint-order=\"stroke\"";
        *text += &format!(
            "<text x=\"{x}\" y=\"{y}\" dy=\"0.35em\" fill=\"{fill}\" {look}>{escaped}</text>\n"
        );
    }

    /// Writes a stroke; of a rod with an outline and a lighter middle.
    fn stroke(
        &self,
        points: &[Point],
        width: f64,
        colour: [u8; 3],
        is_rod: bool,
        text: &mut String,
    ) {
        let d = self.path(points);
        let wide = (width * self.scale).max(LINE);
        let mut line = |brightness: f64, width: f64| {
            let (stroke, width) = (hex(shaded(colour, brightness)), short(width));
            *text += &format!(
                "<path d=\"{d}\" fill=\"none\" stroke=\"{stroke}\" stroke-width=\"{width}\"/>\n"
            );
        };
        if is_rod {
            line(0.55, wide + LINE);
        }
        line(1.0, wide);
        if is_rod {
            line(1.3, 0.3 * wide);
        }
    }

    /// Writes the bar of the scale, of a round length, in the lower right corner.
    fn bar(&self, [width, height]: [f64; 2], unit: &str, text: &mut String) {
        let most = BAR / self.scale;
        let power = 10f64.powf(most.log10().floor());
        let length = [5.0, 2.0, 1.0]
            .into_iter()
            .map(|k| k * power)
            .find(|l| *l <= most);
        let Some(length) = length.filter(|l| l.is_finite() && *l > 0.0) else {
            return;
        };
        let (right, y) = (width - 12.0, height - 10.0);
        let left = right - length * self.scale;
        let name = format!("{} {unit}", crate::results::digits_of_six(length));
        *text += &format!(
            "<path d=\"M{l} {t}V{y}H{r}V{t}\" fill=\"none\" stroke=\"#66707c\" stroke-width=\"1.2\"/>\n\
             <text x=\"{m}\" y=\"{w}\" text-anchor=\"middle\" font-size=\"11\" fill=\"#66707c\">{name}</text>\n",
            l = short(left),
            r = short(right),
            t = short(y - 4.0),
            m = short((left + right) / 2.0),
            w = short(y - 6.0),
        );
    }
}
