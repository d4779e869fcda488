//! The content of a plot: names, units, points, ranges. `svg.rs` and `terminal.rs` draw it.
//!
//! Values that are not finite leave a gap. Curves with more points than a picture has columns are
//! thinned to the smallest and largest value of each column, so that no peak is lost and files stay
//! small.

use crate::diagnostic::Diagnostic;
use crate::results::Run;

/// A range from its smallest to its largest value.
pub type Range = (f64, f64);

/// Curves over a common x.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    /// title above the picture; may be empty
    pub title: String,
    /// name of x, with its unit
    pub x_label: String,
    /// name of y, with its unit; when empty, taken from the curves
    pub y_label: String,
    /// the curves, in the order of the legend
    pub curves: Vec<Curve>,
    /// curves with the axis at the right, of another unit
    pub right: Vec<Curve>,
}

/// A curve of a plot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// name in the legend
    pub name: String,
    /// unit of y; empty when unknown or none
    pub unit: String,
    /// (x, y) in the order they are joined
    pub points: Vec<(f64, f64)>,
    /// drawn with dashes: of another run, so that a curve below it is seen
    pub is_dashed: bool,
    /// bar of error of each point, drawn as a band; empty: none are known
    pub bars: Vec<f64>,
}

/// Most curves of a plot when none are chosen.
const MOST_CURVES: usize = 8;

impl Plot {
    /// Plots the named columns of a run over its first column, or over `x`; without names the first
    /// few.
    ///
    /// # Errors
    /// When the run has no such column; the advice lists near names.
    pub fn of_run(run: &Run, x: Option<&str>, names: &[String]) -> Result<Plot, Diagnostic> {
        let x = x.map_or(Ok(0), |name| run.resolve(name))?;
        let x_column = run
            .columns
            .get(x)
            .ok_or_else(|| run.unknown_column("time"))?;
        let chosen = match names {
            [] => run
                .table_columns()
                .into_iter()
                .filter(|&c| c != x && run.columns[c].bar_of.is_none())
                .take(MOST_CURVES)
                .collect(),
            names => names
                .iter()
                .map(|n| run.resolve(n))
                .collect::<Result<Vec<_>, _>>()?,
        };
        let rows: Vec<usize> = run.table_rows().collect();
        let curves = chosen.into_iter().map(|c| {
            let column = &run.columns[c];
            let points = rows
                .iter()
                .map(|&row| (x_column.at(row), column.at(row)))
                .collect();
            let bars = run.bars(c).map(|bars| &run.columns[bars].values);
            let bars = bars.map(|bars| rows.iter().map(|&row| bars[row]).collect());
            Curve {
                name: column.name.clone(),
                unit: column.unit.clone(),
                points,
                bars: bars.unwrap_or_default(),
                ..Curve::default()
            }
        });
        let title = if run.title.is_empty() {
            run.name.clone()
        } else {
            run.title.clone()
        };
        let x_label = with_unit(&x_column.name, &x_column.unit);
        Ok(Plot {
            title,
            x_label,
            curves: curves.collect(),
            ..Plot::default()
        })
    }

    /// Plots the columns of a run's table in panels: those of one unit together, those without one
    /// by themselves; at most `most`.
    pub fn by_unit(run: &Run, most: usize) -> Vec<Plot> {
        let mut panels: Vec<Plot> = Vec::new();
        let is_bar = |c: &usize| run.columns.get(*c).is_some_and(|c| c.bar_of.is_some());
        let columns = run.table_columns().into_iter().skip(1);
        for column in columns.filter(|c| !is_bar(c)) {
            let unit = run.columns.get(column).map_or("", |c| c.unit.as_str());
            let fits = |p: &Plot| {
                !unit.is_empty() && p.common_unit() == Some(unit) && p.curves.len() < MOST_CURVES
            };
            let place = panels.iter().position(fits);
            if place.is_none() && panels.len() >= most {
                continue;
            }
            let Some(Ok(plot)) = run
                .columns
                .get(column)
                .map(|c| Plot::of_run(run, None, std::slice::from_ref(&c.name)))
            else {
                continue;
            };
            if plot.points().next().is_none() {
                continue;
            }
            match place {
                Some(same) => panels[same].curves.extend(plot.curves),
                None => panels.push(plot),
            }
        }
        panels
    }

    /// Returns the same without a second axis: its curves in a picture of their own, below.
    pub fn split(self) -> Vec<Plot> {
        let Plot { right, .. } = &self;
        if right.is_empty() {
            return vec![self];
        }
        let below = Plot {
            title: String::new(),
            curves: self.right.clone(),
            right: Vec::new(),
            ..self.clone()
        };
        let above = Plot {
            right: Vec::new(),
            ..self
        };
        vec![above, below]
    }

    /// Returns the curves of the axis at the right as a plot of their own, with the same x; `None`
    /// without them.
    pub fn at_right(&self) -> Option<Plot> {
        (!self.right.is_empty()).then(|| Plot {
            curves: self.right.clone(),
            x_label: self.x_label.clone(),
            ..Plot::default()
        })
    }

    /// Returns the common unit of the curves, if they have one.
    fn common_unit(&self) -> Option<&str> {
        let first = self.curves.first()?.unit.as_str();
        self.curves.iter().all(|c| c.unit == first).then_some(first)
    }

    /// Returns the label of the y axis.
    pub fn y_axis(&self) -> String {
        match (
            self.y_label.as_str(),
            self.curves.as_slice(),
            self.common_unit(),
        ) {
            ("", [only], _) => with_unit(&only.name, &only.unit),
            ("", _, Some(unit)) if !unit.is_empty() => format!("[{unit}]"),
            (given, ..) => given.to_owned(),
        }
    }

    /// Returns the labels of the legend: names, with units where they differ. A single curve is
    /// named by the axis.
    pub fn legend(&self) -> Vec<String> {
        let units = self.common_unit().is_none();
        let right = self.right.iter().map(|c| format!("{} (right)", c.name));
        match self.curves.as_slice() {
            [_] if self.y_label.is_empty() && self.right.is_empty() => Vec::new(),
            curves => curves
                .iter()
                .map(|c| {
                    if units {
                        with_unit(&c.name, &c.unit)
                    } else {
                        c.name.clone()
                    }
                })
                .chain(right)
                .collect(),
        }
    }

    /// Returns the ranges of x and y of the finite points, widened where they are empty.
    ///
    /// # Errors
    /// When there is no finite point.
    pub fn ranges(&self) -> Result<(Range, Range), Diagnostic> {
        let mut points = self.points();
        let first = points.next().ok_or_else(nothing_to_show)?;
        let (mut low, mut high) = (*first, *first);
        for p in points {
            low = (low.0.min(p.0), low.1.min(p.1));
            high = (high.0.max(p.0), high.1.max(p.1));
        }
        Ok((widened(low.0, high.0), widened(low.1, high.1)))
    }

    /// Returns the finite points of its curves.
    fn points(&self) -> impl Iterator<Item = &(f64, f64)> {
        let all = self.curves.iter().flat_map(|c| &c.points);
        all.filter(|p| is_finite(p))
    }
}

/// Returns the range itself, or one around it where its ends are the same number up to rounding.
fn widened(low: f64, high: f64) -> (f64, f64) {
    // numbers beyond these leave no room for ticks between neighbours
    const LARGEST: f64 = 1e300;
    const SMALLEST: f64 = 1e-290;
    let (low, high) = (low.clamp(-LARGEST, LARGEST), high.clamp(-LARGEST, LARGEST));
    let scale = low.abs().max(high.abs());
    let by = if scale > SMALLEST { 0.1 * scale } else { 1.0 };
    if high - low <= (1e-12 * scale).max(SMALLEST) {
        (low - by, high + by)
    } else {
        (low, high)
    }
}

fn is_finite(p: &(f64, f64)) -> bool {
    p.0.is_finite() && p.1.is_finite()
}

/// Prints `name [unit]`.
pub fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_owned()
    } else {
        format!("{name} [{unit}]")
    }
}

/// Returns the error for a plot without a finite value.
pub(super) fn nothing_to_show() -> Diagnostic {
    Diagnostic::error("empty_plot", "there is no finite value to show")
}

/// Splits a curve into pieces without gaps, thinned to the resolution of a picture with this many
/// columns over the range of x.
pub fn pieces(points: &[(f64, f64)], x: (f64, f64), columns: u32) -> Vec<Vec<(f64, f64)>> {
    let parts = points
        .split(|p| !is_finite(p))
        .filter(|piece| !piece.is_empty());
    parts.map(|piece| thinned(piece, x, columns)).collect()
}

/// Returns, of each column of the picture, the first, smallest, largest and last point, in their
/// order.
fn thinned(points: &[(f64, f64)], x: (f64, f64), columns: u32) -> Vec<(f64, f64)> {
    if points.len() <= 4 * columns as usize {
        return points.to_vec();
    }
    let column = |p: &(f64, f64)| ((p.0 - x.0) / (x.1 - x.0) * f64::from(columns)) as i64;
    let mut kept: Vec<(f64, f64)> = Vec::new();
    for group in points.chunk_by(|a, b| column(a) == column(b)) {
        let least = (0..group.len())
            .min_by(|&a, &b| group[a].1.total_cmp(&group[b].1))
            .unwrap_or(0);
        let greatest = (0..group.len())
            .max_by(|&a, &b| group[a].1.total_cmp(&group[b].1))
            .unwrap_or(0);
        let mut chosen = [0, least, greatest, group.len() - 1];
        chosen.sort_unstable();
        for (k, &i) in chosen.iter().enumerate() {
            if k == 0 || chosen[k - 1] != i {
                kept.push(group[i]);
            }
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Kind, Units};

    #[test]
    fn thinning_keeps_every_peak_and_the_ends() {
        let mut points: Vec<(f64, f64)> = (0..100_000)
            .map(|i| (f64::from(i), (f64::from(i) * 1e-3).sin()))
            .collect();
        points[54_321].1 = 9.0;
        points[12_345].1 = -9.0;
        let kept = thinned(&points, (0.0, 99_999.0), 500);
        assert!(kept.len() <= 2004, "{}", kept.len());
        assert!(kept.contains(&(54_321.0, 9.0)) && kept.contains(&(12_345.0, -9.0)));
        assert_eq!((kept.first(), kept.last()), (points.first(), points.last()));
        assert!(kept.windows(2).all(|w| w[0].0 < w[1].0));
    }

    #[test]
    fn values_that_are_not_finite_cut_the_curve() {
        let points = [
            (0.0, 1.0),
            (1.0, f64::NAN),
            (2.0, 3.0),
            (3.0, 4.0),
            (f64::INFINITY, 5.0),
        ];
        assert_eq!(
            pieces(&points, (0.0, 3.0), 100),
            [vec![(0.0, 1.0)], vec![(2.0, 3.0), (3.0, 4.0)]]
        );
    }

    #[test]
    fn a_constant_has_a_range_around_it() {
        let plot = |y: f64| Plot {
            curves: vec![Curve {
                points: vec![(0.0, y), (1.0, y)],
                ..Curve::default()
            }],
            ..Plot::default()
        };
        assert_eq!(plot(5.0).ranges().unwrap().1, (4.5, 5.5));
        assert_eq!(plot(0.0).ranges().unwrap().1, (-1.0, 1.0));
        assert!(plot(f64::NAN).ranges().is_err());
    }

    #[test]
    fn a_column_that_is_not_there_is_answered_with_a_near_one() {
        let mut run = Run::new("r", "", Units::default());
        run.add_column("DX(12,21)", "mm");
        run.begin(Kind::Dynamic);
        run.push(&[0.0, 1.0]);
        run.end();
        let d = Plot::of_run(&run, None, &["DX(12,22)".into()]).unwrap_err();
        assert_eq!(
            (d.code, d.help[0].as_str()),
            ("unknown_column", "did you mean DX(12,21)?")
        );
        assert_eq!(
            Plot::of_run(&run, None, &[]).unwrap().y_axis(),
            "DX(12,21) [mm]"
        );
    }
}
