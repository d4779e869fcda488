//! Channels: columns of one or several runs as curves, as they are or transformed, and their
//! arrangement in pictures: one axis a unit.

use super::plot::{Curve, Plot, with_unit};
use super::transform;
use crate::diagnostic::Diagnostic;
use crate::results::Run;

/// A run, with the name that it has in a legend.
pub struct Source {
    /// its name
    pub label: String,
    /// its results
    pub run: Run,
}

/// The change of a curve before it is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// as it is
    Values,
    /// slope over x
    Derivative,
    /// integral over x
    Integral,
    /// amplitudes over frequency
    Spectrum,
}

/// Channels of runs over one x.
pub struct Channels {
    /// title of the first run
    pub title: String,
    /// name of x, with its unit
    pub x_label: String,
    /// the channels, run by run
    pub curves: Vec<Curve>,
}

/// Most curves when none are chosen.
const MOST_CURVES: usize = 8;

/// Returns the named columns of all runs over `x`, or over their first column; without names the
/// first few of the first run. A column must be in the first run; other runs may lack it.
///
/// # Errors
/// When the first run has no such column; the advice lists near names.
pub fn channels(
    sources: &[Source],
    x: Option<&str>,
    names: &[String],
    shown: Shown,
) -> Result<Channels, Diagnostic> {
    let names = &expanded(sources, names)?;
    let mut all = Channels {
        title: String::new(),
        x_label: String::new(),
        curves: Vec::new(),
    };
    for (k, Source { label, run }) in sources.iter().enumerate() {
        let mut names = names.to_vec();
        if k > 0 {
            names.retain(|name| run.find(name).is_some());
        }
        if names.is_empty() && k > 0 {
            continue;
        }
        let plot = Plot::of_run(run, x, &names)?;
        if k == 0 {
            all.title = plot.title.clone();
            all.x_label = label_of_x(run, x, &plot.x_label, shown);
        }
        let unit_of_x = unit_of_x(run, x)?;
        let d_x = d_of_x(run, x);
        let curves = plot.curves.into_iter().take(if names.is_empty() {
            MOST_CURVES
        } else {
            names.len()
        });
        let made = curves.map(|curve| changed(curve, shown, (&d_x, &unit_of_x)));
        all.curves.extend(made.map(|mut curve| {
            if sources.len() > 1 {
                curve.name = format!("{} ({label})", curve.name);
            }
            curve.is_dashed = k > 0;
            curve
        }));
    }
    Ok(all)
}

/// Returns names with all columns of the first run in the place of a pattern.
fn expanded(sources: &[Source], names: &[String]) -> Result<Vec<String>, Diagnostic> {
    let mut all = Vec::new();
    for name in names {
        let Some(Source { run, .. }) = sources.first().filter(|_| name.contains(['*', '?'])) else {
            all.push(name.clone());
            continue;
        };
        let columns = run.resolve_all(name)?.into_iter();
        all.extend(columns.map(|c| run.columns[c].name.clone()));
    }
    Ok(all)
}

/// Returns the unit of x.
fn unit_of_x(run: &Run, x: Option<&str>) -> Result<String, Diagnostic> {
    let column = match x {
        None => 0,
        Some(name) => run.resolve(name)?,
    };
    Ok(run
        .columns
        .get(column)
        .map(|c| c.unit.clone())
        .unwrap_or_default())
}

/// Returns the differential of x as it is written: `dt` of time.
fn d_of_x(run: &Run, x: Option<&str>) -> String {
    match x {
        Some(name) if run.find(name) != Some(0) => format!("d({name})"),
        _ => "dt".to_owned(),
    }
}

/// Returns the name of the x axis.
fn label_of_x(run: &Run, x: Option<&str>, label: &str, shown: Shown) -> String {
    match shown {
        Shown::Spectrum => {
            let unit = unit_of_x(run, x).unwrap_or_default();
            let unit = if unit == "sec" {
                "Hz".to_owned()
            } else {
                divided("", &unit)
            };
            with_unit("frequency", &unit)
        }
        Shown::Values | Shown::Derivative | Shown::Integral => label.to_owned(),
    }
}

/// Returns a curve as it is to be shown, with its name and its unit.
fn changed(curve: Curve, shown: Shown, (d_x, unit_of_x): (&str, &str)) -> Curve {
    let Curve {
        name,
        unit,
        points,
        bars,
        ..
    } = curve;
    match shown {
        Shown::Values => Curve {
            name,
            unit,
            points,
            bars,
            ..Curve::default()
        },
        Shown::Derivative => Curve {
            name: format!("d({name})/{d_x}"),
            unit: divided(&unit, unit_of_x),
            points: transform::derivative(&points),
            ..Curve::default()
        },
        Shown::Integral => Curve {
            name: format!("∫{name} {d_x}"),
            unit: multiplied(&unit, unit_of_x),
            points: transform::integral(&points),
            ..Curve::default()
        },
        Shown::Spectrum => Curve {
            name: format!("amplitude of {name}"),
            unit,
            points: transform::spectrum(&points),
            ..Curve::default()
        },
    }
}

/// Returns a unit with its power of `by` in the denominator: `mm/sec**2` has 2.
fn with_power<'a>(unit: &'a str, by: &str) -> (&'a str, u32) {
    let Some((first, rest)) = unit.rsplit_once('/') else {
        return (unit, 0);
    };
    match rest.strip_prefix(by) {
        Some("") => (first, 1),
        Some(power) => match power.strip_prefix("**").and_then(|p| p.parse().ok()) {
            Some(power) => (first, power),
            None => (unit, 0),
        },
        None => (unit, 0),
    }
}

/// Writes a unit over a power of another.
fn over(unit: &str, by: &str, power: u32) -> String {
    let unit = if unit.is_empty() { "1" } else { unit };
    let by = match by.contains('/') {
        true => format!("({by})"),
        false => by.to_owned(),
    };
    match power {
        0 if unit == "1" => String::new(),
        0 => unit.to_owned(),
        1 => format!("{unit}/{by}"),
        power => format!("{unit}/{by}**{power}"),
    }
}

/// Returns the unit of a quotient.
fn divided(unit: &str, by: &str) -> String {
    if by.is_empty() {
        return unit.to_owned();
    }
    let (first, power) = with_power(unit, by);
    over(first, by, power + 1)
}

/// Returns the unit of a product.
fn multiplied(unit: &str, by: &str) -> String {
    if by.is_empty() {
        return unit.to_owned();
    }
    match with_power(unit, by) {
        ("", 0) => by.to_owned(),
        (first, 0) => format!("{first}*{by}"),
        (first, power) => over(first, by, power - 1),
    }
}

impl Channels {
    /// Arranges the channels in pictures: those of one unit have one axis. With two units the
    /// second has the axis at the right; with more, or where `panels` is asked for, each unit has
    /// a picture of its own.
    pub fn arranged(self, panels: bool) -> Vec<Plot> {
        let mut units: Vec<String> = Vec::new();
        for curve in &self.curves {
            if !units.contains(&curve.unit) {
                units.push(curve.unit.clone());
            }
        }
        let of_unit = |unit: &String| -> Vec<Curve> {
            let mine = self.curves.iter().filter(|c| c.unit == *unit);
            mine.cloned().collect()
        };
        let plot = |left: Vec<Curve>, right: Vec<Curve>| Plot {
            title: self.title.clone(),
            x_label: self.x_label.clone(),
            curves: left,
            right,
            ..Plot::default()
        };
        match units.as_slice() {
            [left, right] if !panels => vec![plot(of_unit(left), of_unit(right))],
            units => (units.iter().enumerate())
                .map(|(k, unit)| Plot {
                    // a panel is too low for a name along its axis; the legend has it
                    y_label: if units.len() > 1 && !unit.is_empty() {
                        format!("[{unit}]")
                    } else {
                        String::new()
                    },
                    title: if k == 0 {
                        self.title.clone()
                    } else {
                        String::new()
                    },
                    ..plot(of_unit(unit), Vec::new())
                })
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Kind, Units};

    fn source(label: &str, columns: &[(&str, &str)]) -> Source {
        let mut run = Run::new(label, "", Units::default());
        columns.iter().for_each(|(name, unit)| {
            run.add_column(*name, *unit);
        });
        run.begin(Kind::Dynamic);
        for k in 0..5 {
            let mut row = vec![f64::from(k)];
            row.extend((1..=columns.len()).map(|c| f64::from(k) * c as f64));
            run.push(&row);
        }
        run.end();
        let label = label.into();
        Source { label, run }
    }

    #[test]
    fn units_of_rates_and_integrals() {
        assert_eq!(divided("mm", "sec"), "mm/sec");
        assert_eq!(divided("mm/sec", "sec"), "mm/sec**2");
        assert_eq!(divided("", "sec"), "1/sec");
        assert_eq!(multiplied("mm/sec**2", "sec"), "mm/sec");
        assert_eq!(multiplied("mm/sec", "sec"), "mm");
        assert_eq!(multiplied("newton", "sec"), "newton*sec");
        assert_eq!(multiplied("1/sec", "sec"), "");
    }

    #[test]
    fn each_unit_has_one_axis() {
        let run = source(
            "a",
            &[("x", "mm"), ("y", "mm"), ("v", "mm/sec"), ("f", "newton")],
        );
        let sources = [run];
        let arranged = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|n| n.to_string()).collect();
            let found = channels(&sources, None, &names, Shown::Values).unwrap();
            let plots = found.arranged(false);
            plots
                .iter()
                .map(|p| (p.curves.len(), p.right.len()))
                .collect::<Vec<_>>()
        };
        assert_eq!(arranged(&["x", "y"]), [(2, 0)]);
        assert_eq!(arranged(&["x", "v", "y"]), [(2, 1)]);
        assert_eq!(arranged(&["x", "v", "f"]), [(1, 0), (1, 0), (1, 0)]);
    }

    #[test]
    fn runs_are_told_apart_and_may_lack_a_column() {
        let sources = [
            source("a", &[("x", "mm"), ("y", "mm")]),
            source("b", &[("x", "mm")]),
        ];
        let names = ["x".to_owned(), "y".to_owned()];
        let found = channels(&sources, None, &names, Shown::Derivative).unwrap();
        let names: Vec<&str> = found.curves.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["d(x)/dt (a)", "d(y)/dt (a)", "d(x)/dt (b)"]);
        assert_eq!(found.curves[1].points[2], (2.0, 2.0));
        let missing = channels(&sources, None, &["z".to_owned()], Shown::Values);
        assert!(missing.is_err_and(|d| d.code == "unknown_column"));
    }
}
