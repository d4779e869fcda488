//! The tables of the language reference (tests/data/conformance): every row through every engine.
//!
//! When `COGNATE_CONFORMANCE` names a folder with files of these names, its rows are run instead: all failing rows are
//! printed with what came out and what was expected, and any of them fails the test.

use cognate::expr::interpolation::{Bindings, Spline};
use cognate::expr::program::Input;
use cognate::expr::spline::{Ends, Extrapolation};
use cognate::expr::walk::{Host, check_constants, value, values};
use cognate::expr::{Profile, ast::Ast, ast::Dialect, parse};
use cognate::space::{MarkerState, Mat3, Vec3, kinematic::kinematic_of, rotation::from_313};
use serde_json::Value as Json;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The rows of a table, each a map from the header's words to the row's cells; `None` when the folder lacks the file.
fn rows(file: &str) -> Option<Vec<BTreeMap<String, String>>> {
    let own = format!("{}/tests/data/conformance", env!("CARGO_MANIFEST_DIR"));
    let folder = std::env::var("COGNATE_CONFORMANCE").unwrap_or(own);
    let text = match std::fs::read_to_string(format!("{folder}/{file}.tsv")) {
        Ok(text) => text,
        Err(e) => {
            println!("{folder}/{file}.tsv: skipped, {e}");
            return None;
        }
    };
    let mut lines = text.lines().map(|l| l.split('\t'));
    let header: Vec<&str> = lines.next()?.collect();
    let row = |cells: std::str::Split<'_, char>| {
        header
            .iter()
            .zip(cells)
            .map(|(h, c)| (h.to_string(), c.to_string()))
            .collect()
    };
    Some(lines.map(row).collect())
}

/// Runs a check on every row of a table and prints what fails.
fn all_rows(file: &str, check: impl Fn(&BTreeMap<String, String>) -> Result<(), String>) {
    let Some(rows) = rows(file) else { return };
    let mut failures = 0;
    for row in &rows {
        if let Err(what) = check(row) {
            failures += 1;
            println!("{file}: {}\n    {what}", row["expression"]);
        }
    }
    println!("{file}: {} rows, {failures} failed", rows.len());
    assert_eq!(failures, 0, "rows of {file} failed");
}

fn text_of(row: &BTreeMap<String, String>) -> String {
    row["expression"].replace("\\n", "\n")
}

fn tree(text: &str, dialect: Dialect) -> Result<Ast, String> {
    parse(text, dialect, Profile::Adams).map_err(|e| e.to_string())
}

fn number(row: &BTreeMap<String, String>, column: &str) -> Result<f64, String> {
    row[column].parse().map_err(|e| format!("{column}: {e}"))
}

/// Compares to 1e-13 of the expected value; where operands cancel, to a rounding error or two of the largest of them.
fn compare(got: f64, expected: f64, largest: f64) -> Result<(), String> {
    let allowed = 1e-13 * expected.abs() + 2.0 * f64::EPSILON * largest;
    if (got - expected).abs() <= allowed {
        return Ok(());
    }
    Err(format!(
        "got {got:?}, expected {expected:?}, off by {:e} of it",
        ((got - expected) / expected).abs()
    ))
}

/// A host made of a time, marker states and splines.
#[derive(Default)]
struct World {
    time: f64,
    markers: BTreeMap<u32, MarkerState<f64>>,
    bindings: Bindings,
}

impl Host for World {
    fn input(&self, input: Input) -> Option<f64> {
        match input {
            Input::Time => Some(self.time),
            Input::Measure(m, arguments) => {
                kinematic_of(m, arguments, |id| self.markers.get(&id).copied())
            }
            _ => None,
        }
    }
    fn bindings(&self) -> Option<&Bindings> {
        Some(&self.bindings)
    }
}

fn json(text: &str) -> Result<serde_json::Map<String, Json>, String> {
    match serde_json::from_str(text) {
        Ok(Json::Object(map)) => Ok(map),
        other => Err(format!("not an object: {other:?}")),
    }
}

fn numbers(json: Option<&Json>) -> Vec<f64> {
    json.and_then(Json::as_array)
        .map_or(vec![], |a| a.iter().filter_map(Json::as_f64).collect())
}

fn markers(text: &str) -> Result<BTreeMap<u32, MarkerState<f64>>, String> {
    let mut markers = BTreeMap::new();
    for (id, m) in json(text)? {
        let vector = |key: &str| match numbers(m.get(key))[..] {
            [x, y, z] => Vec3([x, y, z]),
            _ => Vec3::zero(),
        };
        let mut state = MarkerState::ground();
        state.p_GM = vector("r");
        state.v_GM = vector("v");
        state.w_GM = vector("w");
        state.a_GM = vector("a");
        state.alpha_GM = vector("al");
        if let [psi, theta, phi] = numbers(m.get("e313"))[..] {
            state.R_GM = from_313(psi, theta, phi);
        }
        let rows = m
            .get("A")
            .and_then(Json::as_array)
            .map(|rows| rows.iter().map(|r| numbers(Some(r))).collect::<Vec<_>>());
        if let Some(rows) = rows {
            state.R_GM = Mat3(std::array::from_fn(|i| std::array::from_fn(|j| rows[i][j])));
        }
        markers.insert(id.parse().map_err(|e| format!("{id}: {e}"))?, state);
    }
    Ok(markers)
}

fn splines(text: &str) -> Result<Bindings, String> {
    let mut bindings = Bindings::default();
    for (id, s) in json(text)? {
        let z = numbers(s.get("z"));
        let y = match z.is_empty() {
            true => vec![numbers(s.get("y"))],
            false => s
                .get("y")
                .and_then(Json::as_array)
                .map_or(vec![], |a| a.iter().map(|c| numbers(Some(c))).collect()),
        };
        let word = |key: &str| {
            s.get(key)
                .and_then(Json::as_str)
                .unwrap_or_default()
                .to_string()
        };
        let ends = if word("end") == "not-a-knot" {
            Ends::NotAKnot
        } else {
            Ends::Natural
        };
        let extrapolation = if word("extrap") == "linear" {
            Extrapolation::Linear
        } else {
            Extrapolation::Parabolic
        };
        let spline = Spline::new(numbers(s.get("x")), z, y, ends, extrapolation)
            .map_err(|e| e.to_string())?;
        bindings.splines.insert(
            id.parse().map_err(|e| format!("{id}: {e}"))?,
            Arc::new(spline),
        );
    }
    Ok(bindings)
}

fn run(row: &BTreeMap<String, String>, dialect: Dialect, world: World) -> Result<(), String> {
    let text = text_of(row);
    let ast = tree(&text, dialect)?;
    check_constants(&ast).map_err(|e| e.diagnostic(&text).to_string())?;
    let values = values(&ast, &world).map_err(|e| e.diagnostic(&text).to_string())?;
    let largest = values
        .iter()
        .flatten()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    let got = values[ast.root as usize].unwrap_or(f64::NAN);
    compare(got, number(row, "expected")?, largest)
}

#[test]
fn functions_have_the_stated_values() {
    all_rows("functions", |row| {
        run(
            row,
            Dialect::Function,
            World {
                time: number(row, "time")?,
                ..World::default()
            },
        )
    });
}

#[test]
fn expression_functions_have_the_stated_values() {
    all_rows("ideas", |row| {
        run(
            row,
            Dialect::Expression,
            World {
                time: number(row, "t")?,
                ..World::default()
            },
        )
    });
}

#[test]
fn measures_of_markers_have_the_stated_values() {
    all_rows("markers", |row| {
        run(
            row,
            Dialect::Function,
            World {
                markers: markers(&row["markers"])?,
                ..World::default()
            },
        )
    });
}

#[test]
fn splines_have_the_stated_values() {
    all_rows("splines", |row| {
        run(
            row,
            Dialect::Function,
            World {
                bindings: splines(&row["splines"])?,
                ..World::default()
            },
        )
    });
}

#[test]
fn malformed_texts_give_the_stated_kind_and_column() {
    all_rows("errors", |row| {
        let text = text_of(row);
        let profile = if row["note"].starts_with("compat limits on") {
            Profile::Ideas
        } else {
            Profile::Adams
        };
        let world = World {
            time: 0.5,
            ..World::default()
        };
        let said = parse(&text, Dialect::Function, profile)
            .and_then(|ast| value(&ast, &world).map_err(|e| e.diagnostic(&text)))
            .map_or_else(
                |e| format!("{} at {}", e.code, e.column),
                |v| format!("the value {v}"),
            );
        let expected = format!("{} at {}", row["kind"], row["column"]);
        if said == expected {
            Ok(())
        } else {
            Err(format!("got {said}, expected {expected}"))
        }
    });
}
