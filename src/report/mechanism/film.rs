//! A run as a film: drawings one after the other in a GIF that repeats.
//!
//! The film takes as long as the run where somebody can watch that, else some seconds; its rows are
//! those nearest to equal steps of time. All pictures have the corners that hold every one of them.
//! Colours are those of a sample of the pictures, the most frequent ones exactly. A frame holds the
//! rectangle that has changed since the one before, and there only the dots that have.

use super::drawing::{Drawing, Names, Wanted, drawing};
use super::{Pictured, View, drawing_svg};
use crate::arrange::Arrange;
use crate::diagnostic::Diagnostic;
use crate::report::picture;
use crate::scalar::Scalar;
use gif::{DisposalMethod, Encoder, Frame, Repeat};
use std::collections::HashMap;

/// Pictures in a second.
const RATE: f64 = 20.0;
/// Seconds that a film takes as long as its run; others take the usual time.
const WATCHED: std::ops::RangeInclusive<f64> = 1.5..=12.0;
/// Usual duration of a film, in s.
const USUAL_DURATION: f64 = 6.0;
/// Pictures whose colours are counted.
const SAMPLE: usize = 8;
/// Colours of a film; one further stands for dots that stay as they are.
const COLOURS: usize = 255;
/// Most frequent colours, which are kept exactly.
const EXACT: usize = 32;

/// The drawings of a run, one after the other.
pub struct Film<'a> {
    pictured: &'a Pictured,
    wanted: Wanted,
    /// width in px
    width: f64,
    /// unit of time
    time: &'a str,
    rows: Vec<usize>,
    /// time that each picture is shown, in hundredths of a second
    delay: u16,
    corners: [[f64; 2]; 2],
}

impl<'a> Film<'a> {
    /// Chooses the pictures of a film; `units`: of length and of time.
    pub fn new(
        pictured: &'a Pictured,
        view: Option<View>,
        width: f64,
        units: [&'a str; 2],
    ) -> Self {
        let times = &pictured.track.times;
        let (rows, delay) = frames(times, pictured.second);
        let [length, time] = units;
        let wanted = Wanted {
            // names would jump from place to place
            names: Names::None,
            paths: true,
            view,
            ..Wanted::at_row(0, length)
        };
        let mut film = Self {
            pictured,
            wanted,
            width,
            time,
            rows,
            delay,
            corners: [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]],
        };
        for k in 0..film.rows.len() {
            let Drawing { low, high, .. } = film.drawn(k);
            for axis in 0..2 {
                film.corners[0][axis] = film.corners[0][axis].min(low[axis]);
                film.corners[1][axis] = film.corners[1][axis].max(high[axis]);
            }
        }
        film
    }

    /// Returns the number of its pictures.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns whether it has no picture.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    fn drawn(&self, k: usize) -> Drawing {
        let wanted = Wanted {
            row: self.rows[k],
            ..self.wanted.clone()
        };
        drawing(self.pictured, &wanted)
    }

    /// Returns the dots of a picture, red, green and blue, with width and height.
    fn dots(&self, k: usize) -> Result<(Vec<[u8; 3]>, [u16; 2]), Diagnostic> {
        let [low, high] = self.corners;
        let drawing = Drawing {
            low,
            high,
            ..self.drawn(k)
        };
        let text = drawing_svg::svg(&drawing, self.width, &self.wanted.unit);
        let times = &self.pictured.track.times;
        let time = written(times[self.rows[k]], span(times));
        let clock = format!(
            "<text x=\"12\" y=\"20\" fill=\"#66707c\">{time} {}</text>\n</svg>",
            self.time
        );
        picture::dots(&text.replace("</svg>", &clock))
    }

    /// Returns the film as a GIF; `None`: `goes_on`, which is asked before each picture with its
    /// number, said no.
    ///
    /// # Errors
    /// When a picture cannot be drawn.
    pub fn gif(
        &self,
        goes_on: &mut dyn FnMut(usize) -> bool,
    ) -> Result<Option<Vec<u8>>, Diagnostic> {
        let mut palette = Palette::new(&self.sample()?);
        let mut before: Vec<u8> = Vec::new();
        let mut encoder: Option<Encoder<Vec<u8>>> = None;
        for k in 0..self.len() {
            if !goes_on(k) {
                return Ok(None);
            }
            let (dots, [width, height]) = self.dots(k)?;
            let now: Vec<u8> = dots.into_iter().map(|dot| palette.index(dot)).collect();
            let encoder = match &mut encoder {
                Some(encoder) => encoder,
                None => {
                    let made = Encoder::new(Vec::new(), width, height, &palette.bytes());
                    let mut made = made.map_err(failed)?;
                    made.set_repeat(Repeat::Infinite).map_err(failed)?;
                    encoder.insert(made)
                }
            };
            let frame = frame(&now, &before, width, self.delay);
            encoder.write_frame(&frame).map_err(failed)?;
            before = now;
        }
        let bytes = encoder.map(|encoder| encoder.into_inner().map_err(failed));
        Ok(Some(bytes.transpose()?.unwrap_or_default()))
    }

    /// Returns how often each colour occurs in some of the pictures.
    fn sample(&self) -> Result<HashMap<[u8; 3], usize>, Diagnostic> {
        let mut found = HashMap::new();
        for k in (0..self.len()).step_by(self.len().div_ceil(SAMPLE).max(1)) {
            for dot in self.dots(k)?.0 {
                *found.entry(dot).or_default() += 1;
            }
        }
        Ok(found)
    }
}

/// Returns the time from the first row to the last.
fn span(times: &[f64]) -> f64 {
    times.last().copied().unwrap_or(0.0) - times.first().copied().unwrap_or(0.0)
}

/// Writes a time with as many decimals as show a hundredth of the span of all times.
fn written(time: f64, span: f64) -> String {
    let decimals = match span > 0.0 {
        true => (2.0 - Scalar::log10(span).floor()).clamp(0.0, 12.0),
        false => 3.0,
    };
    format!("{time:.*}", decimals as usize)
}

fn failed(why: impl std::fmt::Display) -> Diagnostic {
    let what = format!("the film could not be made: {why}");
    Diagnostic::error("plot_failed", what)
}

/// Returns the rows of a film, and the time that each is shown in hundredths of a second.
fn frames(times: &[f64], second: f64) -> (Vec<usize>, u16) {
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else {
        return (Vec::new(), 0);
    };
    let duration = (last - first) * second;
    let shown = match WATCHED.contains(&duration) {
        true => duration,
        false => USUAL_DURATION,
    };
    let n = times.len().min((RATE * shown).round() as usize).max(1);
    let delay = (100.0 * shown / n as f64).round().clamp(2.0, 6000.0) as u16;
    if n == times.len() || duration <= 0.0 {
        let rows = (0..n).map(|k| k * (times.len() - 1) / (n - 1).max(1));
        return (rows.collect(), delay);
    }
    let step = (last - first) / (n - 1).max(1) as f64;
    let row = |k: usize| {
        let t = first + k as f64 * step;
        let after = times.partition_point(|x| *x < t).min(times.len() - 1);
        let is_before = after > 0 && t - times[after - 1] < times[after] - t;
        after - usize::from(is_before)
    };
    ((0..n).map(row).collect(), delay)
}

/// Returns the part of a picture that differs from the one before.
fn frame(now: &[u8], before: &[u8], width: u16, delay: u16) -> Frame<'static> {
    let wide = usize::from(width).max(1);
    let changed = |at: usize| before.get(at) != now.get(at);
    let (mut left, mut right, mut top, mut bottom) = (wide, 0, usize::MAX, 0);
    for at in (0..now.len()).filter(|at| changed(*at)) {
        let (x, y) = (at % wide, at / wide);
        (left, right) = (left.min(x), right.max(x));
        (top, bottom) = (top.min(y), bottom.max(y));
    }
    if top == usize::MAX {
        // nothing has changed: one dot, as it is
        (left, right, top, bottom) = (0, 0, 0, 0);
    }
    let mut buffer = Vec::with_capacity((right + 1 - left) * (bottom + 1 - top));
    for y in top..=bottom {
        let dots = y * wide + left..=y * wide + right;
        buffer.extend(dots.map(|at| if changed(at) { now[at] } else { STAYS }));
    }
    Frame {
        delay,
        dispose: DisposalMethod::Keep,
        transparent: Some(STAYS),
        left: left as u16,
        top: top as u16,
        width: (right + 1 - left) as u16,
        height: (bottom + 1 - top) as u16,
        buffer: buffer.into(),
        ..Frame::default()
    }
}

/// Number of the colour of dots that stay as they are.
const STAYS: u8 = COLOURS as u8;

/// The colours of a film.
struct Palette {
    colours: Vec<[u8; 3]>,
    known: HashMap<[u8; 3], u8>,
}

impl Palette {
    /// Chooses colours from those that occur, and how often they do.
    fn new(found: &HashMap<[u8; 3], usize>) -> Self {
        let mut all: Vec<([u8; 3], usize)> = found.iter().map(|(c, n)| (*c, *n)).collect();
        all.arrange_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
        let exact = if all.len() <= COLOURS {
            all.len()
        } else {
            EXACT
        };
        let mut colours: Vec<[u8; 3]> = all.iter().take(exact).map(|c| c.0).collect();
        if exact < all.len() {
            // seldom ones weigh less, common ones not by their numbers
            let others = all.iter().skip(exact).flat_map(|&([r, g, b], n)| {
                let weight = (n as f64).sqrt().ceil().min(40.0) as usize;
                std::iter::repeat_n([r, g, b, 255], weight)
            });
            let others: Vec<u8> = others.flatten().collect();
            let quantized = color_quant::NeuQuant::new(1, COLOURS - exact, &others);
            let found = quantized.color_map_rgb();
            colours.extend(found.chunks_exact(3).map(|c| [c[0], c[1], c[2]]));
        }
        colours.truncate(COLOURS);
        let known = HashMap::new();
        Self { colours, known }
    }

    /// Returns the number of the nearest colour.
    fn index(&mut self, dot: [u8; 3]) -> u8 {
        let off = |c: &[u8; 3]| {
            let parts = c.iter().zip(dot).map(|(a, b)| i32::from(*a) - i32::from(b));
            parts.map(|d| d * d).sum::<i32>()
        };
        let colours = &self.colours;
        *self.known.entry(dot).or_insert_with(|| {
            let nearest = (0..colours.len()).min_by_key(|k| off(&colours[*k]));
            nearest.unwrap_or(0) as u8
        })
    }

    /// Returns all colours as a file holds them.
    fn bytes(&self) -> Vec<u8> {
        let mut bytes: Vec<u8> = self.colours.iter().flatten().copied().collect();
        bytes.resize(3 * (COLOURS + 1), 0);
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_takes_the_time_of_its_run_or_one_that_can_be_watched() {
        let times = |end: f64, n: usize| -> Vec<f64> {
            (0..n).map(|k| end * k as f64 / (n - 1) as f64).collect()
        };
        for (end, n, second) in [
            (2.0, 500, 1.0),
            (1e-3, 11, 1.0),
            (4000.0, 9000, 1e-3),
            (0.0, 1, 1.0),
        ] {
            let times = if n == 1 { vec![end] } else { times(end, n) };
            let (rows, delay) = frames(&times, second);
            assert_eq!((rows[0], *rows.last().unwrap()), (0, n - 1));
            assert!(rows.windows(2).all(|r| r[0] < r[1]), "{rows:?}");
            let shown = rows.len() as f64 * f64::from(delay) / 100.0;
            let expected = if (1.5..=12.0).contains(&(end * second)) {
                end * second
            } else {
                6.0
            };
            assert!(
                (shown - expected).abs() < 0.1 * expected,
                "{shown} {expected}"
            );
        }
        // equal steps of time, whatever the steps of the rows are
        let uneven: Vec<f64> = (0..1000)
            .map(|k| (f64::from(k) / 999.0).powi(3) * 2.0)
            .collect();
        let (rows, _) = frames(&uneven, 1.0);
        for (k, row) in rows.iter().enumerate() {
            let t = 2.0 * k as f64 / (rows.len() - 1) as f64;
            assert!((uneven[*row] - t).abs() < 4e-3, "{k}");
        }
    }

    #[test]
    fn the_time_on_a_picture_has_the_same_decimals_throughout() {
        assert_eq!(written(1.0 / 3.0, 1.0), "0.33");
        assert_eq!(written(2.0, 20.0), "2.0");
        assert_eq!(written(1e-3, 4e-3), "0.00100");
        assert_eq!(written(1234.5, 5000.0), "1234");
    }

    #[test]
    fn a_frame_holds_what_has_changed_and_nothing_else() {
        let before = vec![1; 12];
        let mut now = before.clone();
        (now[5], now[10]) = (2, 3);
        let part = frame(&now, &before, 4, 5);
        assert_eq!((part.left, part.top, part.width, part.height), (1, 1, 2, 2));
        assert_eq!(part.buffer[..], [2, STAYS, STAYS, 3]);
        let whole = frame(&now, &[], 4, 5);
        assert_eq!(
            (whole.width, whole.height, &whole.buffer[..]),
            (4, 3, &now[..])
        );
        assert_eq!(frame(&now, &now, 4, 5).buffer[..], [STAYS]);
    }

    #[test]
    fn frequent_colours_are_exact_and_others_near() {
        let white = [255; 3];
        let mut found: HashMap<[u8; 3], usize> = HashMap::from([(white, 100_000)]);
        found.extend((0..40_u8).flat_map(|r| (0..40_u8).map(move |g| ([6 * r, 6 * g, 90], 3))));
        let mut palette = Palette::new(&found);
        assert_eq!(palette.colours.len(), COLOURS);
        let k = palette.index(white);
        assert_eq!(palette.colours[usize::from(k)], white);
        for colour in found.keys() {
            let k = palette.index(*colour);
            let off = palette.colours[usize::from(k)]
                .iter()
                .zip(colour)
                .map(|(a, b)| a.abs_diff(*b))
                .max();
            // an even grid of so many colours has cells of 16; the chosen ones are not quite even
            assert!(off < Some(32), "{colour:?} {off:?}");
        }
    }
}
