//! Textbook mechanisms: each dataset in `tests/scenes` says what its counts are and one number known in closed form.
//!
//! ```text
//! ! expect: gruebler G, freedom F, redundant R          with its motions switched off; each motion takes one freedom
//! ! expect: rational                                    its geometry is: the rank is repeated in exact arithmetic
//! ! expect: until T: LEFT = RIGHT +- TOLERANCE          in a kinematic run, at 21 times
//! ! expect: at T: LEFT = RIGHT +- TOLERANCE
//! ```

use crate::running;

use cognate::analysis::verify::{Verification, verify};
use cognate::internals::scene::configuration::Configuration;
use cognate::internals::scene::{Scene, build};
use cognate::internals::start::assemble;
use cognate::model::{ElementKind, Model};
use running::{Analysis, Options, begin, go, whole};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

struct Mechanism {
    name: String,
    model: Model,
    /// what stands behind `! expect:`
    expectations: Vec<String>,
}

fn mechanisms() -> Vec<Mechanism> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/scenes");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("the folder of scenes")
        .map(|e| e.expect("an entry").path())
        .filter(|p| p.extension().is_some_and(|e| e == "adm"))
        .collect();
    files.sort();
    files
        .into_iter()
        .map(|path| {
            let text = std::fs::read_to_string(&path).expect("a readable scene");
            let expectations = text
                .lines()
                .filter_map(|l| l.strip_prefix("! expect: ").map(str::to_string))
                .collect();
            Mechanism {
                name: path.file_stem().unwrap().to_string_lossy().into_owned(),
                model: whole(&text),
                expectations,
            }
        })
        .collect()
}

impl Mechanism {
    /// Gruebler count, freedom, redundant rows, without motions.
    fn counts(&self) -> (i64, usize, usize) {
        let line = self
            .expectations
            .iter()
            .find(|e| e.starts_with("gruebler"))
            .unwrap_or_else(|| panic!("{} has counts", self.name));
        let n: Vec<i64> = line
            .split([' ', ','])
            .filter_map(|w| w.parse().ok())
            .collect();
        (n[0], n[1] as usize, n[2] as usize)
    }

    /// The model without its motions.
    fn idle(&self) -> Model {
        let mut model = self.model.clone();
        for id in model.motions.keys() {
            model.inactive.insert(ElementKind::Motion.id(*id));
        }
        model
    }
}

fn found(model: &Model, name: &str) -> Verification {
    let v = verify(model).unwrap_or_else(|e| panic!("{name}: {e:?}"));
    assert!(v.inconsistent.is_empty(), "{name}: {:?}", v.inconsistent);
    v
}

#[test]
fn there_are_more_than_thirty() {
    assert!(mechanisms().len() >= 30);
}

#[test]
fn freedom_and_redundancy_are_those_of_the_textbook() {
    for m in mechanisms() {
        let (gruebler, freedom, redundant) = m.counts();
        let v = found(&m.idle(), &m.name);
        assert_eq!(
            (v.gruebler, v.freedom, v.dependent.len()),
            (gruebler, Some(freedom), redundant),
            "{}: {:?}",
            m.name,
            v.redundant()
        );
        assert_eq!(v.free.len(), freedom, "{}", m.name);
        // none of these stands in a special position
        assert_eq!(v.freedom_nearby, Some(freedom), "{}", m.name);
        assert!(v.dependent.iter().all(|d| !d.only_here), "{}", m.name);
    }
}

#[test]
fn every_motion_takes_a_freedom() {
    for m in mechanisms() {
        let (gruebler, freedom, redundant) = m.counts();
        let n = m.model.motions.len();
        let v = found(&m.model, &m.name);
        assert_eq!(
            (v.gruebler, v.freedom, v.dependent.len()),
            (gruebler - n as i64, Some(freedom - n), redundant),
            "{}",
            m.name
        );
    }
}

/// Removing the rows that are said to be redundant leaves the same freedom and none that is redundant: the count is then the freedom.
#[test]
fn the_counts_differ_by_the_redundant_rows() {
    for m in mechanisms() {
        let v = found(&m.idle(), &m.name);
        let freedom = v.freedom.unwrap() as i64;
        assert_eq!(freedom - v.dependent.len() as i64, v.gruebler, "{}", m.name);
    }
}

#[test]
fn numbers_known_in_closed_form_come_out() {
    let mut compared = BTreeSet::new();
    for m in mechanisms() {
        for e in &m.expectations {
            let Some((when, rest)) = e.split_once(": ") else {
                let known = e.starts_with("gruebler ") || e == "rational";
                assert!(known, "{}: {e:?} expects nothing", m.name);
                continue;
            };
            let (kind, t) = when.split_once(' ').expect("at or until, and a time");
            assert!(["at", "until"].contains(&kind), "{}: {e:?}", m.name);
            let t: f64 = t.parse().expect("a time");
            let (equation, tolerance) = rest.rsplit_once(" +- ").expect("a tolerance");
            let tolerance: f64 = tolerance.parse().expect("a number");
            let (left, right) = equation.split_once(" = ").expect("two sides");
            let difference = format!("({left})-({right})");
            let options = Options {
                columns: vec![difference.clone()],
                ..Options::default()
            };
            let mut session = begin(m.model.clone(), &m.name, options);
            let end = if t > 0.0 { t } else { 0.01 };
            go(&mut session, Analysis::Kinematic, end, 20);
            let column = session.run.column(&difference).expect("the column");
            let worst = match (kind, t > 0.0) {
                ("until", _) => column.iter().fold(0.0, |w: f64, x| w.max(x.abs())),
                (_, true) => column[column.len() - 1].abs(),
                (_, false) => column[0].abs(),
            };
            assert!(
                worst <= tolerance,
                "{}: {equation} is off by {worst:e}",
                m.name
            );
            compared.insert(m.name.clone());
        }
    }
    let silent = mechanisms()
        .into_iter()
        .filter(|m| !compared.contains(&m.name));
    let silent: Vec<String> = silent.map(|m| m.name).collect();
    assert!(silent.is_empty(), "nothing is compared of {silent:?}");
}

/// A fraction in lowest terms.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Fraction(i128, i128);

fn gcd(a: i128, b: i128) -> i128 {
    if b == 0 { a.abs() } else { gcd(b, a % b) }
}

impl Fraction {
    fn new(n: i128, d: i128) -> Self {
        let g = gcd(n, d).max(1) * d.signum();
        Fraction(n / g, d / g)
    }
    /// The fraction that a float of an exact calculation stands for; `None` when there is none with a small denominator.
    fn of(x: f64) -> Option<Self> {
        let (mut a, mut h, mut k) = (x, (1i128, 0i128), (0i128, 1i128));
        for _ in 0..20 {
            let whole = a.floor();
            let n = whole as i128;
            (h, k) = ((n * h.0 + h.1, h.0), (n * k.0 + k.1, k.0));
            if k.0 > 20_000 {
                return None;
            }
            if (x - h.0 as f64 / k.0 as f64).abs() < 1e-13 * (1.0 + x.abs()) {
                return Some(Self::new(h.0, k.0));
            }
            a = 1.0 / (a - whole);
        }
        None
    }
    fn times(self, o: Self) -> Self {
        let (a, b) = (Self::new(self.0, o.1), Self::new(o.0, self.1));
        Fraction(
            a.0.checked_mul(b.0).expect("small numbers"),
            a.1.checked_mul(b.1).expect("small numbers"),
        )
    }
    fn minus(self, o: Self) -> Self {
        let n = (self.0.checked_mul(o.1))
            .zip(o.0.checked_mul(self.1))
            .and_then(|(a, b)| a.checked_sub(b));
        let d = self.1.checked_mul(o.1);
        Self::new(n.expect("small numbers"), d.expect("small numbers"))
    }
}

/// Rank by elimination in fractions.
fn exact_rank(mut rows: Vec<BTreeMap<usize, Fraction>>) -> usize {
    let mut rank = 0;
    loop {
        rows.retain(|r| !r.is_empty());
        let Some(at) = (0..rows.len()).min_by_key(|&k| rows[k].len()) else {
            return rank;
        };
        let pivot = rows.swap_remove(at);
        rank += 1;
        let (&column, &p) = pivot.iter().next().expect("not empty");
        for row in &mut rows {
            let Some(&x) = row.get(&column) else { continue };
            let factor = x.times(Fraction::new(p.1, p.0));
            for (&c, &y) in &pivot {
                let old = row.get(&c).copied().unwrap_or(Fraction(0, 1));
                let new = old.minus(factor.times(y));
                if new.0 == 0 {
                    row.remove(&c);
                } else {
                    row.insert(c, new);
                }
            }
        }
    }
}

#[test]
fn fractions_know_their_ranks() {
    let row = |x: &[i128]| -> BTreeMap<usize, Fraction> {
        let entries = x.iter().enumerate().filter(|e| *e.1 != 0);
        entries.map(|(k, &x)| (k, Fraction::new(x, 3))).collect()
    };
    assert_eq!(
        exact_rank(vec![row(&[1, 2, 0]), row(&[2, 4, 0]), row(&[0, 1, 1])]),
        2
    );
    assert_eq!(Fraction::of(-1.4), Some(Fraction(-7, 5)));
    assert_eq!(Fraction::of(2.0_f64.sqrt()), None);
}

/// All joints as rows between free parts, whose gradients at a rational position are rational.
#[test]
fn rank_agrees_with_exact_arithmetic_where_geometry_is_rational() {
    let mut checked = 0;
    for m in mechanisms() {
        if !m.expectations.iter().any(|e| e == "rational") {
            continue;
        }
        let options = build::Options {
            cut_all: true,
            mode: 4,
            ..build::Options::default()
        };
        let scene = Scene::compile(&m.idle(), &options).expect("a scene");
        let configuration = Configuration::new(&scene);
        let configured = scene.within(&configuration);
        let still = vec![0.0; scene.layout.n_v];
        let (_, gradient, _) = assemble::rows_at(configured, 0.0, (&scene.initial_q, &still, &[]));
        let exact = |(r, entries): (usize, Vec<(usize, f64)>)| {
            let row = &scene.rows[r].element;
            let entries = entries.into_iter().map(|(c, x)| {
                let exact = Fraction::of(x);
                (c, exact.unwrap_or_else(|| panic!("{}: {row}: {x}", m.name)))
            });
            entries.filter(|e| e.1.0 != 0).collect()
        };
        let rows: Vec<BTreeMap<usize, Fraction>> =
            gradient.into_iter().enumerate().map(exact).collect();
        let (_, freedom, redundant) = m.counts();
        let (n_rows, n) = (rows.len(), scene.layout.n_v);
        let rank = exact_rank(rows);
        assert_eq!(
            (n - rank, n_rows - rank),
            (freedom, redundant),
            "{}",
            m.name
        );
        checked += 1;
    }
    println!("{checked} mechanisms in exact arithmetic");
    assert!(checked >= 15, "{checked}");
}
