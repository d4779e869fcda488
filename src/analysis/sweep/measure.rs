//! Measures of a run: one number made of the values of an expression at the outputs.

use crate::analysis::session::{Session, check_column};
use crate::diagnostic::{Diagnostic, Error, Span, near_names};
use crate::results::Run;

/// A number made of values over time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Reduction {
    Max,
    Min,
    Mean,
    Rms,
    First,
    Last,
    TimeOfMax,
    TimeOfMin,
}

/// Reductions by their names.
const REDUCTIONS: [(&str, Reduction); 8] = [
    ("max", Reduction::Max),
    ("min", Reduction::Min),
    ("mean", Reduction::Mean),
    ("rms", Reduction::Rms),
    ("first", Reduction::First),
    ("last", Reduction::Last),
    ("time_of_max", Reduction::TimeOfMax),
    ("time_of_min", Reduction::TimeOfMin),
];

/// A measure of a run: `max(ABS(FX(10,20)))`, `time_of_max(slider.X)`.
///
/// The word outside is max, min, mean, rms, first, last, time_of_max or time_of_min. Inside stands
/// an expression of the function language, in which elements may have their names, or a component
/// of a set of results (`crank_bearing.FX`), also in `abs`.
///
/// Values are those at the outputs, static rows included; a peak between outputs is not seen. Means
/// are those over time of straight lines between the outputs. Values that are not finite are left
/// out.
#[derive(Clone, Debug)]
pub struct Measure {
    reduction: Reduction,
    name: String,
    /// the expression, or the name of a column
    of: String,
    /// its absolute value counts
    is_absolute: bool,
    /// the column is there without being asked for
    is_recorded: bool,
    unit: String,
}

/// Returns whether a column of a table has the name of a measure: `max(…)`.
pub fn is_measure(name: &str) -> bool {
    let word = name.strip_suffix(')').and_then(|t| t.split_once('('));
    let is_word = |word: &str| REDUCTIONS.iter().any(|(w, _)| w.eq_ignore_ascii_case(word));
    word.is_some_and(|(word, _)| is_word(word.trim()))
}

impl Measure {
    /// Reads a measure of the runs of a session, which has not begun.
    ///
    /// # Errors
    /// A text of another form, a word that is no measure, and mistakes in the expression.
    pub(super) fn new(text: &str, session: &Session) -> Result<Self, Error> {
        let name = text.trim();
        let split = name.strip_suffix(')').and_then(|t| t.split_once('('));
        let known = REDUCTIONS.map(|(word, _)| word);
        let Some((word, of)) = split else {
            let what = format!("`{name}` is no measure of a run");
            let d = Diagnostic::error("bad_sweep", what);
            let advice = format!("max({name}) is one; others: {}", known.join(", "));
            return Err(d.help(advice).into());
        };
        let (word, of) = (word.trim(), of.trim());
        let row = REDUCTIONS
            .iter()
            .find(|(w, _)| w.eq_ignore_ascii_case(word));
        let Some(&(_, reduction)) = row else {
            let what = format!("`{name}`: {word} makes no single number of a run");
            let mut d = Diagnostic::error("bad_sweep", what);
            let near = near_names(word, known);
            d = d.help(match near.is_empty() {
                true => format!("max({name}) is one"),
                false => format!("did you mean {}?", near.join(" or ")),
            });
            let all = known.join(", ");
            return Err(d.help(format!("one of these stands outside: {all}")).into());
        };
        let inside = inside_abs(of).filter(|inside| is_sound(inside, session));
        let is_absolute = inside.is_some();
        let of = inside.unwrap_or(of);
        let recorded = session.run.find(of);
        if recorded.is_none() {
            // a mistake inside of abs stands there
            let asked = inside_abs(of).unwrap_or(of);
            let mut wrong = check_column(&session.model, of);
            if !wrong.is_empty() {
                wrong = check_column(&session.model, asked);
                wrong.iter_mut().for_each(|d| shift(d, name, asked));
                return Err(wrong.into());
            }
        }
        Ok(Self {
            reduction,
            name: name.to_owned(),
            of: of.to_owned(),
            is_absolute,
            is_recorded: recorded.is_some(),
            unit: String::new(),
        })
    }

    /// The measure as it was given.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The unit; empty: a pure number or unknown.
    pub fn unit(&self) -> &str {
        &self.unit
    }

    /// Takes the unit from a session that has the column.
    pub(super) fn take_unit(&mut self, session: &Session) {
        let of_time = matches!(self.reduction, Reduction::TimeOfMax | Reduction::TimeOfMin);
        let column = if of_time {
            Some(0)
        } else {
            session.run.find(&self.of)
        };
        let column = column.and_then(|c| session.run.columns.get(c));
        self.unit = column.map(|c| c.unit.clone()).unwrap_or_default();
    }

    /// Returns the expression that runs must record for it; `None`: they do so anyway.
    pub(super) fn column(&self) -> Option<&str> {
        (!self.is_recorded).then_some(self.of.as_str())
    }

    /// Returns the measure of a run that has been completed; NaN where it has no finite value.
    pub fn of(&self, run: &Run) -> f64 {
        let (Some(values), Some(time)) = (run.column(&self.of), run.columns.first()) else {
            return f64::NAN;
        };
        let places = run.table_places(run.held());
        let points = places.filter_map(|k| Some((*time.values.get(k)?, *values.get(k)?)));
        let finite = points.filter(|p| p.1.is_finite());
        let points: Vec<(f64, f64)> = match self.is_absolute {
            true => finite.map(|(t, x)| (t, x.abs())).collect(),
            false => finite.collect(),
        };
        reduced(self.reduction, &points).unwrap_or(f64::NAN)
    }
}

/// Returns what stands in `abs(…)`.
fn inside_abs(text: &str) -> Option<&str> {
    let (word, rest) = text.split_once('(')?;
    let is_abs = word.trim().eq_ignore_ascii_case("abs");
    rest.strip_suffix(')').filter(|_| is_abs).map(str::trim)
}

/// Returns whether a text is a column of the results, or an expression without mistakes.
fn is_sound(text: &str, session: &Session) -> bool {
    session.run.find(text).is_some() || check_column(&session.model, text).is_empty()
}

/// Moves a place within the expression to that within the measure.
fn shift(d: &mut Diagnostic, name: &str, of: &str) {
    let open = name.find('(').map_or(0, |k| k + 1);
    let before = open + name[open..].find(of).unwrap_or(0);
    let spans = d
        .span
        .iter_mut()
        .chain(d.marks.iter_mut().map(|m| &mut m.0));
    for span in spans {
        *span = Span::new(span.start + before, span.end + before);
    }
    if d.line == 1 {
        d.column += name[..before].chars().count();
    }
}

/// Returns the number that a reduction makes of points (time, value) in the order of time; `None`:
/// there are none.
fn reduced(reduction: Reduction, points: &[(f64, f64)]) -> Option<f64> {
    let (first, last) = (points.first()?, points.last()?);
    let largest = |sign: f64| {
        // the first of several that are equal
        let larger = |a: (f64, f64), b: &(f64, f64)| if sign * b.1 > sign * a.1 { *b } else { a };
        points.iter().fold(*first, larger)
    };
    let over_time = |integral: fn(f64, f64) -> f64| {
        let pairs = points.windows(2).map(|p| (p[1].0 - p[0].0, p[0].1, p[1].1));
        let (mut sum, mut span) = (0.0, 0.0);
        for (h, a, b) in pairs.filter(|p| p.0 > 0.0) {
            sum += h * integral(a, b);
            span += h;
        }
        match span > 0.0 {
            true => sum / span,
            false => integral(last.1, last.1),
        }
    };
    Some(match reduction {
        Reduction::Max => largest(1.0).1,
        Reduction::Min => largest(-1.0).1,
        Reduction::TimeOfMax => largest(1.0).0,
        Reduction::TimeOfMin => largest(-1.0).0,
        Reduction::First => first.1,
        Reduction::Last => last.1,
        Reduction::Mean => over_time(|a, b| 0.5 * (a + b)),
        Reduction::Rms => over_time(|a, b| (a * a + a * b + b * b) / 3.0).sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reductions_are_those_of_the_lines_between_outputs() {
        // a ramp from -1 to 3, then a jump to 1 that stays
        let points = [(0.0, -1.0), (2.0, 3.0), (2.0, 1.0), (4.0, 1.0)];
        let of = |r| reduced(r, &points).unwrap();
        assert_eq!(of(Reduction::Max), 3.0);
        assert_eq!((of(Reduction::Min), of(Reduction::First)), (-1.0, -1.0));
        assert_eq!((of(Reduction::Last), of(Reduction::TimeOfMax)), (1.0, 2.0));
        assert_eq!(of(Reduction::TimeOfMin), 0.0);
        // ∫ = 2·1 + 2·1; ∫ of squares = ∫₋₁³ x² dx/2 + 2 = 14/3 + 2
        assert!((of(Reduction::Mean) - 1.0).abs() < 1e-15);
        assert!((of(Reduction::Rms).powi(2) - (14.0 / 3.0 + 2.0) / 4.0).abs() < 1e-15);
        assert_eq!(reduced(Reduction::Max, &[]), None);
        assert_eq!(reduced(Reduction::Rms, &[(1.0, -2.0)]), Some(2.0));
    }
}
