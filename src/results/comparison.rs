//! The comparison of two runs: the largest difference of every channel, when, and how large it is
//! beside the channel's range and its bars of error.

use super::{Kind, Run};
use crate::arrange::Arrange;
use crate::diagnostic::Diagnostic;

/// Difference of two times that are the same, as a part of the span of the runs: times are printed
/// and read back by other programs.
const SAME_TIME: f64 = 1e-9;

/// The comparison of two runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// channels of both, the largest difference relative to its range first
    pub channels: Vec<Difference>,
    /// names of channels that one run alone has: the first, the second
    pub alone: [Vec<String>; 2],
    /// channels that are in different units: name, units
    pub other_units: Vec<(String, [String; 2])>,
    /// outputs that were compared
    pub outputs: usize,
    /// outputs of each run that were not compared
    pub left_out: [usize; 2],
    /// whether the second run was interpolated between its outputs
    pub interpolated: bool,
}

/// The largest difference of a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// name of the channel
    pub channel: String,
    /// its unit
    pub unit: String,
    /// size of the largest difference, in that unit
    pub largest: f64,
    /// when
    pub time: f64,
    /// the two values there
    pub values: [f64; 2],
    /// largest minus smallest value of both runs, or the largest size of a constant channel
    pub range: f64,
    /// bars of error of both there, added; `None`: neither run has any
    pub bars: Option<f64>,
    /// outputs at which the difference is larger than the bars; `None` as above
    pub beyond_bars: Option<usize>,
    /// outputs at which one run alone has a value
    pub missing: usize,
}

impl Difference {
    /// Returns the largest difference as a part of the range; 0 where there is none.
    pub fn relative(&self) -> f64 {
        if self.largest == 0.0 {
            0.0
        } else {
            self.largest / self.range
        }
    }
}

/// An output of the first run and the place of its time in the second: a row, and a part of the way
/// to the next row.
struct Pair {
    row: usize,
    other: usize,
    part: f64,
}

/// Compares the channels of two runs at the output times that they share; with `interpolate` at all
/// times of the first that lie in the second, which is taken as straight between its outputs.
///
/// # Errors
/// When there is no time to compare at.
pub fn compare(a: &Run, b: &Run, interpolate: bool) -> Result<Comparison, Diagnostic> {
    let rows = [compared_rows(a, b), compared_rows(b, a)];
    let times = |run: &Run, rows: &[usize]| -> Vec<f64> {
        let time = run.columns.first().map_or(&[][..], |c| &c.values);
        rows.iter().map(|&row| time[row]).collect()
    };
    let (ta, tb) = (times(a, &rows[0]), times(b, &rows[1]));
    let pairs = match interpolate {
        true => between(&ta, &tb),
        false => shared(&ta, &tb),
    };
    if pairs.is_empty() {
        let said = Diagnostic::error("no_shared_time", "the runs share no output time");
        return Err(match interpolate {
            true => said.help("their spans do not overlap"),
            false => said.help("--interpolate compares at the times of the first run"),
        });
    }
    let mut found = Comparison {
        outputs: pairs.len(),
        left_out: [ta.len() - pairs.len(), {
            let mut used: Vec<usize> = pairs.iter().map(|p| p.other).collect();
            used.dedup();
            tb.len().saturating_sub(used.len())
        }],
        interpolated: interpolate,
        ..Comparison::default()
    };
    let is_channel = |run: &Run, c: &usize| *c > 0 && run.columns[*c].bar_of.is_none();
    for column in a.table_columns().into_iter().filter(|c| is_channel(a, c)) {
        let name = &a.columns[column].name;
        let Some(other) = b.find(name) else {
            found.alone[0].push(name.clone());
            continue;
        };
        let units = [&a.columns[column].unit, &b.columns[other].unit];
        if units[0] != units[1] && units.iter().all(|u| !u.is_empty()) {
            let units = units.map(String::clone);
            found.other_units.push((name.clone(), units));
            continue;
        }
        let values = Values {
            a: [Some(column), a.bars(column)].map(|c| of_rows(a, &rows[0], c)),
            b: [Some(other), b.bars(other)].map(|c| of_rows(b, &rows[1], c)),
        };
        let mut difference = values.difference(&pairs, &ta);
        difference.channel.clone_from(name);
        difference.unit.clone_from(units[0]);
        found.channels.push(difference);
    }
    let only = b.table_columns().into_iter().filter(|c| is_channel(b, c));
    let only = only.map(|c| &b.columns[c].name);
    found.alone[1] = only.filter(|n| a.find(n).is_none()).cloned().collect();
    found
        .channels
        .arrange_by(|x, y| y.relative().total_cmp(&x.relative()));
    Ok(found)
}

/// Returns the rows of a run that are compared: those of its tables, without those of assembly
/// where the other run has none, as those of other programs, and another row stands for their time.
fn compared_rows(run: &Run, other: &Run) -> Vec<usize> {
    let is_assembly = |kind: Option<Kind>| kind == Some(Kind::InitialConditions);
    let has_sequences = !other.sequences.is_empty();
    let has_assembly = other.sequences.iter().any(|s| is_assembly(Some(s.kind)));
    let keeps_all = has_assembly || !has_sequences;
    let rows: Vec<usize> = run.table_rows().collect();
    let time = run.columns.first().map_or(&[][..], |c| &c.values);
    let follows = |k: usize| {
        rows.get(k + 1)
            .is_some_and(|&next| time[next] == time[rows[k]])
    };
    let counts =
        |&(k, &row): &(usize, &usize)| keeps_all || !is_assembly(run.kind_of(row)) || !follows(k);
    let kept = rows.iter().enumerate().filter(counts);
    kept.map(|(_, &row)| row).collect()
}

/// Returns the values of a column in some rows.
fn of_rows(run: &Run, rows: &[usize], column: Option<usize>) -> Option<Vec<f64>> {
    let values = &run.columns.get(column?)?.values;
    Some(rows.iter().map(|&row| values[row]).collect())
}

/// Pairs outputs of the same time. Where a run has several at one time, as a static simulation and
/// the dynamic one after it, the last is paired with the last.
fn shared(a: &[f64], b: &[f64]) -> Vec<Pair> {
    let span = |t: &[f64]| t.last().unwrap_or(&0.0) - t.first().unwrap_or(&0.0);
    let tolerance = SAME_TIME * span(a).abs().max(span(b).abs());
    let mut pairs = Vec::new();
    let (mut i, mut j) = (a.len(), b.len());
    while i > 0 && j > 0 {
        let difference = a[i - 1] - b[j - 1];
        if difference.abs() <= tolerance {
            (i, j) = (i - 1, j - 1);
            let (row, other, part) = (i, j, 0.0);
            pairs.push(Pair { row, other, part });
        } else if difference > 0.0 {
            i -= 1;
        } else {
            j -= 1;
        }
    }
    pairs.reverse();
    pairs
}

/// Pairs every output of the first run with its place between two of the second; outside of the
/// second there is none.
fn between(a: &[f64], b: &[f64]) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for (row, &t) in a.iter().enumerate() {
        let after = b.partition_point(|&tb| tb <= t);
        let Some(other) = after.checked_sub(1) else {
            continue;
        };
        let part = match b.get(after) {
            Some(next) => (t - b[other]) / (next - b[other]),
            None if t == b[other] => 0.0,
            None => continue,
        };
        pairs.push(Pair { row, other, part });
    }
    pairs
}

/// The values of a channel and its bars in both runs.
struct Values {
    a: [Option<Vec<f64>>; 2],
    b: [Option<Vec<f64>>; 2],
}

impl Values {
    /// Returns a value of the second run at a place between its rows.
    fn at(&self, which: usize, pair: &Pair) -> Option<f64> {
        let values = self.b[which].as_ref()?;
        let x = *values.get(pair.other)?;
        let next = values.get(pair.other + 1);
        let next = next.filter(|_| pair.part > 0.0);
        Some(next.map_or(x, |next| x + pair.part * (next - x)))
    }

    /// Returns the largest difference over all pairs, without name and unit.
    fn difference(&self, pairs: &[Pair], times: &[f64]) -> Difference {
        let value = |which: usize, row: usize| self.a[which].as_ref().map(|v| v[row]);
        let has_bars = self.a[1].is_some() || self.b[1].is_some();
        let mut found = Difference {
            channel: String::new(),
            unit: String::new(),
            largest: 0.0,
            time: pairs.first().map_or(0.0, |p| times[p.row]),
            values: [f64::NAN; 2],
            range: 0.0,
            bars: None,
            beyond_bars: has_bars.then_some(0),
            missing: 0,
        };
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for pair in pairs {
            let both = [value(0, pair.row), self.at(0, pair)].map(|x| x.unwrap_or(f64::NAN));
            if both.iter().any(|x| x.is_nan()) {
                found.missing += usize::from(both.iter().any(|x| !x.is_nan()));
                continue;
            }
            (least, most) = (
                least.min(both[0]).min(both[1]),
                most.max(both[0]).max(both[1]),
            );
            let bars = [value(1, pair.row), self.at(1, pair)];
            let bars: f64 = bars.into_iter().flatten().filter(|b| !b.is_nan()).sum();
            let size = match both[0] == both[1] {
                true => 0.0,
                false => (both[0] - both[1]).abs(),
            };
            if let Some(beyond) = &mut found.beyond_bars {
                *beyond += usize::from(size > bars);
            }
            if size > found.largest || found.values[0].is_nan() {
                (found.largest, found.time, found.values) = (size, times[pair.row], both);
                found.bars = has_bars.then_some(bars);
            }
        }
        let size = least.abs().max(most.abs());
        found.range = match most > least && most - least > f64::EPSILON * size {
            true => most - least,
            false => size,
        };
        if found.values[0].is_nan() {
            found.range = 0.0;
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Kind, Units};

    /// A channel: its name, and its value as a function of time.
    type Channel<'a> = (&'a str, fn(f64) -> f64);

    fn run(times: &[f64], channels: &[Channel]) -> Run {
        let mut run = Run::new("r", "t", Units::default());
        for (name, _) in channels {
            run.add_column(*name, "mm");
        }
        run.begin(Kind::Dynamic);
        for &t in times {
            let values = channels.iter().map(|(_, f)| f(t));
            run.push(&[t].into_iter().chain(values).collect::<Vec<f64>>());
        }
        run.end();
        run
    }

    #[test]
    fn the_largest_difference_is_found_with_its_time_and_range() {
        let times = [0.0, 1.0, 2.0, 3.0];
        let a = run(&times, &[("x", |t| t), ("y", |_| 1.0)]);
        let b = run(
            &times,
            &[("x", |t| if t == 2.0 { 2.3 } else { t }), ("z", |_| 1.0)],
        );
        let found = compare(&a, &b, false).unwrap();
        let x = &found.channels[0];
        assert_eq!((x.time, x.values, x.range), (2.0, [2.0, 2.3], 3.0));
        assert!((x.largest - 0.3).abs() < 1e-15 && (x.relative() - 0.1).abs() < 1e-15);
        assert_eq!(found.alone, [vec!["y".to_owned()], vec!["z".to_owned()]]);
    }

    #[test]
    fn outputs_of_one_time_are_paired_from_the_last() {
        let a = run(&[0.0, 0.0, 1.0], &[("x", |t| t)]);
        let b = run(&[0.0, 0.5, 1.0], &[("x", |t| t)]);
        let found = compare(&a, &b, false).unwrap();
        assert_eq!((found.outputs, found.left_out), (2, [1, 1]));
    }

    #[test]
    fn a_straight_line_is_interpolated_without_difference() {
        let a = run(&[0.0, 0.3, 0.9, 1.5], &[("x", |t| 2.0 * t)]);
        let b = run(&[0.0, 0.5, 1.0], &[("x", |t| 2.0 * t)]);
        let found = compare(&a, &b, true).unwrap();
        assert_eq!((found.outputs, found.left_out[0]), (3, 1));
        assert!(found.channels[0].largest < 1e-15);
        let b = run(&[0.1, 0.2], &[("x", |t| t)]);
        let refused = compare(&a, &b, false).unwrap_err();
        assert_eq!(refused.code, "no_shared_time");
    }

    #[test]
    fn the_row_of_assembly_is_no_row_of_rest() {
        let [mut ours, mut other] = [(); 2].map(|()| Run::new("r", "t", Units::default()));
        let rows = |run: &mut Run, all: &[(Kind, f64)]| {
            run.add_column("x", "");
            for &(kind, x) in all {
                run.begin(kind);
                run.push(&[0.0, x]);
                run.end();
            }
        };
        use Kind::{Dynamic, InitialConditions, Static};
        rows(&mut ours, &[(InitialConditions, 0.0), (Static, 5.0)]);
        rows(&mut other, &[(Static, 5.0), (Dynamic, 5.0)]);
        for [a, b] in [[&ours, &other], [&other, &ours]] {
            assert_eq!(compare(a, b, false).unwrap().channels[0].largest, 0.0);
        }
        assert_eq!(compare(&ours, &ours, false).unwrap().outputs, 2);
    }

    #[test]
    fn the_row_of_assembly_counts_where_no_other_stands_for_its_time() {
        let [mut ours, mut table] = [(); 2].map(|()| Run::new("r", "t", Units::default()));
        for (run, first) in [
            (&mut ours, Kind::InitialConditions),
            (&mut table, Kind::Dynamic),
        ] {
            run.add_column("x", "");
            for (kind, t) in [(first, 0.0), (Kind::Dynamic, 1.0), (Kind::Dynamic, 2.0)] {
                run.begin(kind);
                run.push(&[t, 3.0 * t]);
                run.end();
            }
        }
        for [a, b] in [[&ours, &table], [&table, &ours]] {
            let found = compare(a, b, false).unwrap();
            assert_eq!((found.outputs, found.left_out), (3, [0, 0]));
        }
    }

    #[test]
    fn bars_of_both_runs_are_added_where_the_difference_is_largest() {
        let mut a = run(&[0.0, 1.0], &[("x", |t| t), ("x±", |_| 0.1)]);
        let mut b = run(&[0.0, 1.0], &[("x", |t| 1.5 * t), ("x±", |_| 0.2)]);
        a.find_bars();
        b.find_bars();
        let found = compare(&a, &b, false).unwrap();
        let x = &found.channels[0];
        assert!((x.bars.unwrap() - 0.3).abs() < 1e-15);
        assert_eq!((found.channels.len(), x.beyond_bars), (1, Some(1)));
    }
}
