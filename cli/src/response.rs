//! Responses of a sweep: measures over a parameter, with a curve for each choice of the other
//! parameters, or points where each choice has but one run.

use cognate::analysis::sweep::is_measure;
use cognate::diagnostic::Diagnostic;
use cognate::internals::report::Curve;
use cognate::internals::report::channels::{Channels, Shown, Source, channels};
use cognate::results::{Run, digits_of_six};

/// Most choices of the other parameters that have a curve each; more are shown as points.
const MOST_CHOICES: usize = 8;

/// Returns the measures of a sweep over one of its parameters, the first where `x` is left out;
/// without names all measures. `None`: the table is not one of a sweep, or `x` is no parameter.
///
/// # Errors
/// When the table has no such column.
pub fn responses(
    source: &Source,
    x: Option<&str>,
    names: &[String],
) -> Result<Option<Channels>, Diagnostic> {
    let run = &source.run;
    let parameters = parameters(run);
    let place = |name: &str| run.find(name).filter(|c| parameters.contains(c));
    let Some(x) = x.map_or(parameters.first().copied(), place) else {
        return Ok(None);
    };
    let others: Vec<usize> = parameters.iter().copied().filter(|&c| c != x).collect();
    let measured: Vec<String> = match names {
        [] => (run.columns.iter())
            .filter(|c| is_measure(&c.name))
            .map(|c| c.name.clone())
            .collect(),
        names => names.to_vec(),
    };
    let x_name = run.columns[x].name.clone();
    let sources = std::slice::from_ref(source);
    let mut found = channels(sources, Some(&x_name), &measured, Shown::Values)?;
    let choices = choices(run, &others);
    let is_alone = found.curves.len() == 1;
    if is_alone && choices.len() > 1 && have_curves(&choices) {
        found.title = format!("{}: {}", found.title, found.curves[0].name);
    }
    let curves = std::mem::take(&mut found.curves);
    for curve in curves {
        found.curves.extend(parted(curve, &choices, is_alone));
    }
    Ok(Some(found))
}

/// Returns the columns of the parameters of a sweep; none: the table is one of something else.
fn parameters(run: &Run) -> Vec<usize> {
    let names: Vec<&str> = run.columns.iter().map(|c| c.name.as_str()).collect();
    let is_sweep = names.first() == Some(&"run") && run.find("status").is_some();
    let end = names.iter().position(|n| is_measure(n) || *n == "status");
    match end {
        Some(end) if is_sweep => (1..end).collect(),
        _ => Vec::new(),
    }
}

/// Runs in which some parameters have the same values.
struct Choice {
    /// the parameters and their values, as a legend has them
    name: String,
    rows: Vec<usize>,
}

/// Returns the runs by the values of some parameters, in the order of the table.
fn choices(run: &Run, parameters: &[usize]) -> Vec<Choice> {
    let mut all: Vec<(Vec<u64>, Choice)> = Vec::new();
    for row in 0..run.rows() {
        let values = parameters.iter().map(|&c| run.columns[c].values[row]);
        let key: Vec<u64> = values.clone().map(f64::to_bits).collect();
        if let Some((_, choice)) = all.iter_mut().find(|(known, _)| *known == key) {
            choice.rows.push(row);
            continue;
        }
        let named = parameters.iter().zip(values);
        let named = named.map(|(&c, x)| format!("{} = {}", run.columns[c].name, digits_of_six(x)));
        let name = named.collect::<Vec<_>>().join(", ");
        let rows = vec![row];
        all.push((key, Choice { name, rows }));
    }
    all.into_iter().map(|(_, choice)| choice).collect()
}

/// Returns whether each choice has a curve; else runs are points.
fn have_curves(choices: &[Choice]) -> bool {
    choices.len() <= MOST_CHOICES && choices.iter().all(|c| c.rows.len() > 1)
}

/// Parts a measure into a curve for each choice, from the least x on, or into points. `is_alone`:
/// no other measure is shown.
fn parted(curve: Curve, choices: &[Choice], is_alone: bool) -> Vec<Curve> {
    let in_order = |rows: &[usize]| {
        let mut points: Vec<(f64, f64)> = rows.iter().map(|&row| curve.points[row]).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    if !have_curves(choices) {
        let all: Vec<usize> = (0..curve.points.len()).collect();
        let gap = |(x, y)| [(x, y), (x, f64::NAN)];
        let points = in_order(&all).into_iter().flat_map(gap).collect();
        return vec![Curve { points, ..curve }];
    }
    let of = |choice: &Choice| Curve {
        name: match (choice.name.as_str(), is_alone) {
            ("", _) => curve.name.clone(),
            (name, true) => name.to_owned(),
            (name, false) => format!("{}, {name}", curve.name),
        },
        unit: curve.unit.clone(),
        points: in_order(&choice.rows),
        ..Curve::default()
    };
    choices.iter().map(of).collect()
}
