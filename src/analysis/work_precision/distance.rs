//! Differences between tables of results, and the choice of the reference among runs.

use super::{Error, Reference};
use crate::results::Run;

/// Least scale of a channel, as a part of the largest swing of channels of its unit: a channel that
/// does not move is compared with those that do.
const LEAST_SWING: f64 = 1e-6;
/// Two outputs are at one time if they differ by less than this part of the time covered.
const SAME_TIME: f64 = 1e-9;
/// Part of the outputs of the reference that a table must have to be compared with it.
const LEAST_SHARED: f64 = 0.5;

/// The table of a run as it is compared: times, and channels with their names and units.
#[derive(Clone, Debug, Default)]
pub(super) struct Table {
    pub times: Vec<f64>,
    pub names: Vec<String>,
    pub units: Vec<String>,
    /// values of each channel, one per time
    pub values: Vec<Vec<f64>>,
}

impl Table {
    /// Returns the table that a run shows.
    pub fn of(run: &Run) -> Self {
        let rows: Vec<usize> = run.table_rows().collect();
        let pick = |values: &[f64]| -> Vec<f64> { rows.iter().map(|&row| values[row]).collect() };
        let columns = run.table_columns();
        let columns = columns.iter().filter_map(|&c| run.columns.get(c));
        let mut table = Table::default();
        for (k, column) in columns.enumerate() {
            if k == 0 {
                table.times = pick(&column.values);
                continue;
            }
            table.names.push(column.name.clone());
            table.units.push(column.unit.clone());
            table.values.push(pick(&column.values));
        }
        table
    }

    /// Returns this table with the channels of another, in their order; `None` if it lacks one.
    pub fn with_channels_of(&self, other: &Table) -> Option<Table> {
        let places = other.names.iter().map(|name| {
            let plain = |text: &str| text.replace(' ', "").to_lowercase();
            self.names.iter().position(|n| plain(n) == plain(name))
        });
        let places: Vec<usize> = places.collect::<Option<_>>()?;
        Some(Table {
            times: self.times.clone(),
            names: other.names.clone(),
            units: other.units.clone(),
            values: places.iter().map(|&k| self.values[k].clone()).collect(),
        })
    }

    /// Returns the scale of each channel: its swing, and no less than a part of that of its kin.
    fn scales(&self) -> Vec<f64> {
        let swing = |values: &Vec<f64>| {
            let finite = || values.iter().filter(|x| x.is_finite());
            let high = finite().fold(f64::NEG_INFINITY, |m, x| m.max(*x));
            let low = finite().fold(f64::INFINITY, |m, x| m.min(*x));
            (high - low).max(0.0)
        };
        let swings: Vec<f64> = self.values.iter().map(swing).collect();
        let scale = |k: usize| {
            let kin = self.units.iter().zip(&swings);
            let kin = kin.filter(|(unit, _)| **unit == self.units[k]);
            let largest = kin.fold(0.0, |m: f64, (_, s)| m.max(*s));
            let size = self.values[k].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let scale = swings[k].max(LEAST_SWING * largest);
            // nothing of its kind moves: its size, else one
            [scale, size, 1.0].into_iter().find(|x| *x > 0.0)
        };
        (0..swings.len()).map(|k| scale(k).unwrap_or(1.0)).collect()
    }
}

/// Returns the error of a table against a reference with the same channels; `None` if they have too
/// few outputs in common.
pub(super) fn error(table: &Table, reference: &Table) -> Option<Error> {
    let scales = reference.scales();
    let pairs = shared(&table.times, &reference.times);
    if (pairs.len() as f64) < LEAST_SHARED * reference.times.len() as f64 || pairs.is_empty() {
        return None;
    }
    let (mut sum, mut count, mut found) = (0.0, 0, Error::default());
    for (k, scale) in scales.iter().enumerate() {
        for &(i, j) in &pairs {
            let (a, b) = (table.values[k][i], reference.values[k][j]);
            // a gap in both is no difference
            if !a.is_finite() && !b.is_finite() {
                continue;
            }
            let off = ((a - b) / scale).abs();
            let off = if off.is_finite() { off } else { f64::INFINITY };
            sum += off * off;
            count += 1;
            if off > found.largest {
                (found.largest, found.worst) = (off, k);
            }
        }
    }
    found.rms = (sum / f64::from(count.max(1))).sqrt();
    Some(found)
}

/// Returns the places of outputs at the same time in two rising lists.
fn shared(a: &[f64], b: &[f64]) -> Vec<(usize, usize)> {
    let span = |t: &[f64]| t.last().copied().unwrap_or(0.0) - t.first().copied().unwrap_or(0.0);
    let same = SAME_TIME * span(b).abs().max(f64::MIN_POSITIVE);
    let (mut i, mut j, mut pairs) = (0, 0, Vec::new());
    while i < a.len() && j < b.len() {
        let off = a[i] - b[j];
        if off.abs() <= same {
            pairs.push((i, j));
            (i, j) = (i + 1, j + 1);
        } else if off < 0.0 {
            i += 1;
        } else {
            j += 1;
        }
    }
    pairs
}

/// A run that may be the reference.
pub(super) struct Candidate<'a> {
    pub method: &'a str,
    /// the methods that worked in fact, as the record names them
    pub worked: &'a str,
    pub request: f64,
    pub table: &'a Table,
}

/// Chooses the reference among runs that came to their end: of the two best runs by different
/// methods that agree best, the one nearer to the next run of its own method; its place.
pub(super) fn choose(candidates: &[Candidate<'_>]) -> Option<(usize, Reference)> {
    // the finest of each method, and the one before
    let mut finest: Vec<[usize; 2]> = Vec::new();
    for (k, candidate) in candidates.iter().enumerate() {
        let known = finest.iter_mut().find(|[best, _]| {
            let best = &candidates[*best];
            best.method == candidate.method || best.worked == candidate.worked
        });
        match known {
            Some(pair) if candidate.request < candidates[pair[0]].request => {
                *pair = [k, pair[0]];
            }
            Some(pair) if pair[0] == pair[1] && candidate.request > candidates[pair[0]].request => {
                pair[1] = k;
            }
            Some(_) => {}
            None => finest.push([k, k]),
        }
    }
    let apart = |a: usize, b: usize| {
        error(candidates[a].table, candidates[b].table).map_or(f64::INFINITY, |e| e.largest)
    };
    let name = |k: usize| (candidates[k].method.to_string(), candidates[k].request);
    let mut closest: Option<(f64, [usize; 2], [usize; 2])> = None;
    for (k, a) in finest.iter().enumerate() {
        for b in &finest[k + 1..] {
            let difference = apart(a[0], b[0]);
            if closest.is_none_or(|(least, ..)| difference < least) {
                closest = Some((difference, *a, *b));
            }
        }
    }
    let Some((difference, a, b)) = closest else {
        let [only, _] = *finest.first()?;
        let (best, other) = (name(only), None);
        return Some((only, Reference::Run { best, other }));
    };
    let moved = |pair: [usize; 2]| match pair {
        [finest, before] if finest == before => f64::INFINITY,
        [finest, before] => apart(finest, before),
    };
    let (best, other) = if moved(b) < moved(a) { (b, a) } else { (a, b) };
    let reference = Reference::Run {
        best: name(best[0]),
        other: Some((name(other[0]), difference)),
    };
    Some((best[0], reference))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(off: f64) -> Table {
        let times: Vec<f64> = (0..=10).map(|k| 0.1 * f64::from(k)).collect();
        let sine = times.iter().map(|t| 2.0 * (6.0 * t).sin() + off).collect();
        let still = times.iter().map(|_| 1e-17 * off).collect();
        Table {
            names: vec!["x".into(), "y".into()],
            units: vec!["mm".into(), "mm".into()],
            values: vec![sine, still],
            times,
        }
    }

    #[test]
    fn errors_are_parts_of_the_swing_and_rest_is_compared_with_what_moves() {
        let found = error(&table(0.004), &table(0.0)).unwrap();
        assert!((found.largest - 1e-3).abs() < 1e-4, "{found:?}");
        assert_eq!(found.worst, 0);
        assert!((found.rms - found.largest / 2f64.sqrt()).abs() < 1e-9);
        assert_eq!(error(&table(0.0), &table(0.0)).unwrap().largest, 0.0);
    }

    #[test]
    fn outputs_at_other_times_are_not_compared() {
        let mut more = table(0.0);
        more.times.insert(1, 0.05);
        more.values.iter_mut().for_each(|v| v.insert(1, 100.0));
        assert_eq!(error(&more, &table(0.0)).unwrap().largest, 0.0);
        let mut none = table(0.0);
        none.times.iter_mut().for_each(|t| *t += 0.03);
        assert!(error(&none, &table(0.0)).is_none());
        let mut lost = table(0.0);
        lost.values[0][3] = f64::NAN;
        assert_eq!(error(&lost, &table(0.0)).unwrap().largest, f64::INFINITY);
    }

    #[test]
    fn the_reference_is_confirmed_by_another_method() {
        let tables = [table(1e-2), table(1e-6), table(-1e-5), table(3e-3)];
        let runs = [("A", 1e-2), ("A", 1e-6), ("B", 1e-6), ("C", 1e-6)];
        let candidates = runs.iter().zip(&tables);
        let candidates: Vec<Candidate<'_>> = candidates
            .map(|((method, request), table)| Candidate {
                method,
                worked: method,
                request: *request,
                table,
            })
            .collect();
        let (k, reference) = choose(&candidates).unwrap();
        assert_eq!(k, 1);
        let trust = reference.trust();
        assert!(trust > 2e-6 && trust < 4e-6, "{reference:?}");
        // one method alone confirms nothing, and another name for it neither
        let (_, alone) = choose(&candidates[..2]).unwrap();
        assert_eq!(alone.trust(), 0.0);
        assert!(matches!(alone, Reference::Run { other: None, .. }));
        assert!(choose(&[]).is_none());
    }
}
