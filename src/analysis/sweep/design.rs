//! Designs of a sweep: the points at which a model is run.
//!
//! A design knows nothing of the model: it makes rows of numbers from lists and ranges.

use crate::dataset::value::Number;
use crate::diagnostic::{Diagnostic, Error, counted};
use crate::random::Random;

/// Runs that one design may ask for.
pub const MOST_RUNS: usize = 1_000_000;

/// Values that one parameter takes, as they are given.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// these
    List(Vec<f64>),
    /// from one to the other; with their number, where it is given
    Range(f64, f64, Option<usize>),
}

/// Returns whether a sweep may have so many runs.
fn is_count(n: &usize) -> bool {
    (1..=MOST_RUNS).contains(n)
}

fn wrong(what: String) -> Error {
    let d = Diagnostic::error("bad_sweep", what);
    d.help("0.1:0.5:9 is nine values from 0.1 to 0.5, both included; 1,2,5 is these three")
        .into()
}

impl std::str::FromStr for Values {
    type Err = Error;

    /// Reads `A:B:N`, `A:B` or numbers between commas; numbers are written as in datasets, so
    /// that `90D` is an angle of 90 degrees.
    fn from_str(text: &str) -> Result<Self, Error> {
        let number = |word: &str| {
            let found = Number::parse(word.trim()).map(Number::value);
            found.ok_or_else(|| {
                wrong(match word.trim() {
                    "" => format!("a number is missing in `{text}`"),
                    word if word == text => format!("`{word}` is no number"),
                    word => format!("`{word}` in `{text}` is no number"),
                })
            })
        };
        let words: Vec<&str> = text.split(':').collect();
        match words[..] {
            [_] => {
                let all = text.split(',').map(number);
                Ok(Self::List(all.collect::<Result<_, _>>()?))
            }
            [a, b] => Ok(Self::Range(number(a)?, number(b)?, None)),
            [a, b, n] => {
                let count = n.trim().parse().ok().filter(is_count);
                let count = count.ok_or_else(|| {
                    let n = n.trim();
                    wrong(format!(
                        "`{n}` in `{text}` is no count from 1 to {MOST_RUNS}"
                    ))
                })?;
                Ok(Self::Range(number(a)?, number(b)?, Some(count)))
            }
            _ => Err(wrong(format!("`{text}` is neither A:B:N nor a list"))),
        }
    }
}

impl Values {
    /// Returns all values, for a grid.
    ///
    /// # Errors
    /// A range without a number of values, or with one that no sweep can have.
    pub fn all(&self) -> Result<Vec<f64>, Error> {
        match *self {
            Self::List(ref all) => Ok(all.clone()),
            Self::Range(_, _, Some(n)) if !is_count(&n) => {
                Err(wrong(format!("{n} is no count from 1 to {MOST_RUNS}")))
            }
            Self::Range(a, _, Some(1)) => Ok(vec![a]),
            Self::Range(a, b, Some(n)) => {
                let last = (n - 1) as f64;
                let at = |k: usize| {
                    // the ends are exact
                    if k + 1 == n {
                        return b;
                    }
                    let x = (a * (last - k as f64) + b * k as f64) / last;
                    // products of the largest numbers are none
                    let x = match x.is_finite() {
                        true => x,
                        false => a * (1.0 - k as f64 / last) + b * (k as f64 / last),
                    };
                    // fifteen digits, so that round numbers come out round
                    format!("{x:.14e}").parse().unwrap_or(x)
                };
                Ok((0..n).map(at).collect())
            }
            Self::Range(a, b, None) => {
                Err(wrong(format!("the range {a}:{b} has no number of values")))
            }
        }
    }

    /// Returns the value at a part of the way, 0 ≤ `part` < 1: of a range between its ends, of a
    /// list one of its values, of which there are some.
    fn at(&self, part: f64) -> f64 {
        match *self {
            Self::List(ref all) => {
                let place = (part * all.len() as f64) as usize;
                all[place.min(all.len() - 1)]
            }
            Self::Range(a, b, _) => a * (1.0 - part) + b * part,
        }
    }
}

/// Returns all combinations of values, the last parameter changing fastest   (runs × parameters)
///
/// # Errors
/// More combinations than [`MOST_RUNS`].
pub fn grid(values: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, Error> {
    let runs = values.iter().map(Vec::len);
    let runs = runs.fold(1, usize::saturating_mul);
    if runs > MOST_RUNS {
        let what = format!(
            "the grid has {}; a sweep has at most {MOST_RUNS}",
            counted(runs, "run")
        );
        let d = Diagnostic::error("bad_sweep", what);
        return Err(d
            .help("--design latin --runs N spreads N runs over all")
            .into());
    }
    let mut points = vec![Vec::new()];
    for list in values {
        let longer = |point: &Vec<f64>| {
            let with = |&x: &f64| point.iter().copied().chain([x]).collect();
            list.iter().map(with).collect::<Vec<Vec<f64>>>()
        };
        points = points.iter().flat_map(longer).collect();
    }
    Ok(points)
}

/// Returns a latin hypercube: of `runs` equal parts of each parameter's range every one holds one
/// point, at a random place in it   (runs × parameters)
///
/// The same seed gives the same points.
///
/// # Errors
/// More runs than [`MOST_RUNS`], or none; a list without values.
pub fn latin(values: &[Values], runs: usize, seed: u64) -> Result<Vec<Vec<f64>>, Error> {
    if !is_count(&runs) {
        let what = format!("a latin hypercube of {runs} runs; it has 1 to {MOST_RUNS}");
        return Err(Diagnostic::error("bad_sweep", what).into());
    }
    if let Some(k) = values.iter().position(|v| *v == Values::List(Vec::new())) {
        let what = format!("parameter {k} has no values");
        return Err(Diagnostic::error("bad_sweep", what).into());
    }
    let mut random = Random(seed);
    let mut points = vec![Vec::with_capacity(values.len()); runs];
    for of in values {
        let mut parts: Vec<usize> = (0..runs).collect();
        for k in (1..runs).rev() {
            parts.swap(k, random.below(k + 1));
        }
        for (point, part) in points.iter_mut().zip(parts) {
            point.push(of.at((part as f64 + random.unit()) / runs as f64));
        }
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_have_exact_ends_and_lists_are_kept() {
        let of = |text: &str| text.parse::<Values>().unwrap().all().unwrap();
        assert_eq!(of("0.1:0.5:9")[..3], [0.1, 0.15, 0.2]);
        assert_eq!(of("0.1:0.5:9")[8], 0.5);
        assert_eq!(of("-1, 2e3,5"), [-1.0, 2000.0, 5.0]);
        assert_eq!(of("180D"), [std::f64::consts::PI]);
        assert_eq!(of("3:9:1"), [3.0]);
        for text in [
            "",
            "1:2:0",
            "1:2:3:4",
            "1,,2",
            "1:x:2",
            "nan",
            "1:2:9999999999",
        ] {
            assert!(text.parse::<Values>().is_err(), "{text}");
        }
        assert!("1:2".parse::<Values>().unwrap().all().is_err());
        assert_eq!(of("-1e308:1e308:5"), [-1e308, -5e307, 0.0, 5e307, 1e308]);
        for n in [0, MOST_RUNS + 1, usize::MAX] {
            assert!(Values::Range(0.0, 1.0, Some(n)).all().is_err());
        }
        assert!(latin(&[Values::List(Vec::new())], 3, 0).is_err());
    }

    #[test]
    fn a_grid_has_every_combination_once_the_last_fastest() {
        let points = grid(&[vec![1.0, 2.0], vec![3.0, 4.0]]).unwrap();
        assert_eq!(points, [[1.0, 3.0], [1.0, 4.0], [2.0, 3.0], [2.0, 4.0]]);
        assert!(grid(&vec![vec![0.0; 1000]; 9]).is_err());
    }

    #[test]
    fn a_latin_hypercube_holds_one_point_in_each_part_of_each_range() {
        let values = [
            Values::Range(-3.0, 5.0, None),
            Values::Range(1.0, 0.0, Some(4)),
        ];
        for runs in [1, 2, 17, 100] {
            let points = latin(&values, runs, 7).unwrap();
            for (k, (a, b)) in [(-3.0, 5.0), (1.0, 0.0)].into_iter().enumerate() {
                let part = |p: &Vec<f64>| ((p[k] - a) / (b - a) * runs as f64) as usize;
                let mut parts: Vec<usize> = points.iter().map(part).collect();
                parts.sort_unstable();
                assert_eq!(parts, (0..runs).collect::<Vec<_>>());
            }
            assert_eq!(points, latin(&values, runs, 7).unwrap());
        }
        assert_ne!(latin(&values, 9, 1).unwrap(), latin(&values, 9, 2).unwrap());
        let list = latin(&[Values::List(vec![1.0, 2.0, 5.0])], 6, 3).unwrap();
        let of = |x: f64| list.iter().filter(|p| p[0] == x).count();
        assert_eq!([of(1.0), of(2.0), of(5.0)], [2, 2, 2]);
    }
}
