//! The tables of the language reference (tests/data/conformance): every row through every engine. Beside them those of
//! tests/data/edges: break points, ends of domains, ties, omitted arguments, curves beyond their data and the like, computed
//! with fifty digits by an evaluator that was written from the text of the reference alone.
//!
//! When `COGNATE_CONFORMANCE` names a folder with files of these names, its rows are run instead: all failing rows are
//! printed with what came out and what was expected, and any of them fails the test. A note that says `tolerance 1e-9` is
//! obeyed.

use cognate::expr::ast::{Ast, Dialect, Node};
use cognate::expr::compile::compile;
use cognate::expr::interpolation::{Bindings, Spline};
use cognate::expr::program::{Input, Program, Work};
use cognate::expr::spline::{Ends, Extrapolation};
use cognate::expr::walk::{Host, check_constants, value, values};
use cognate::expr::{Profile, parse};
use cognate::internals::physics::kinematic::kinematic_of;
use cognate::internals::space::{MarkerState, Mat3, Vec3, rotation::from_313};
use cognate::scalar::{Dual, Jet, Lanes, Scalar};
use serde_json::Value as Json;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A row of a table: the header's words and the row's cells, and where it stands.
struct Row {
    cells: BTreeMap<String, String>,
    place: String,
}

impl std::ops::Index<&str> for Row {
    type Output = str;
    /// The cell below this word; empty where the row is too short.
    fn index(&self, column: &str) -> &str {
        self.cells.get(column).map_or("", String::as_str)
    }
}

/// The rows of this table in a folder; `None` when the folder lacks the file.
fn rows(folder: &str, file: &str) -> Option<Vec<Row>> {
    let text = match std::fs::read_to_string(format!("{folder}/{file}.tsv")) {
        Ok(text) => text,
        Err(e) => {
            println!("{folder}/{file}.tsv: skipped, {e}");
            return None;
        }
    };
    let mut lines = text.lines().enumerate();
    let header: Vec<&str> = lines.next()?.1.split('\t').collect();
    let row = |(k, line): (usize, &str)| Row {
        cells: header
            .iter()
            .zip(line.split('\t'))
            .map(|(h, c)| (h.to_string(), c.to_string()))
            .collect(),
        place: format!("{folder}/{file}.tsv:{}", k + 1),
    };
    Some(lines.filter(|(_, l)| !l.is_empty()).map(row).collect())
}

/// The tables there are.
const FILES: [&str; 6] = [
    "functions",
    "ideas",
    "markers",
    "splines",
    "derivatives",
    "errors",
];

/// Runs a check on every row of a table and prints what fails.
fn all_rows(file: &str, check: impl Fn(&Row) -> Result<(), String>) {
    let folders = match std::env::var("COGNATE_CONFORMANCE") {
        Ok(folder) => {
            let there = |f: &&str| std::path::Path::new(&format!("{folder}/{f}.tsv")).is_file();
            assert!(
                FILES.iter().any(there),
                "{folder} has none of these: {FILES:?}"
            );
            vec![folder]
        }
        Err(_) => ["conformance", "edges"]
            .map(|f| format!("{}/tests/data/{f}", env!("CARGO_MANIFEST_DIR")))
            .to_vec(),
    };
    let mut failures = 0;
    let all: Vec<Row> = folders
        .iter()
        .filter_map(|f| rows(f, file))
        .flatten()
        .collect();
    for row in &all {
        if let Err(what) = check(row) {
            failures += 1;
            let where_at = ["time", "t", "order", "note"]
                .iter()
                .filter(|c| !row[c].is_empty())
                .map(|c| format!("  {c}: {}", &row[c]))
                .collect::<String>();
            println!(
                "{}: {}{where_at}\n    {what}",
                row.place, &row["expression"]
            );
        }
    }
    println!("{file}: {} rows, {failures} failed", all.len());
    assert_eq!(failures, 0, "rows of {file} failed");
}

fn text_of(row: &Row) -> String {
    row["expression"].replace("\\n", "\n")
}

fn tree(text: &str, dialect: Dialect) -> Result<Ast, String> {
    parse(text, dialect, Profile::Adams).map_err(|e| e.to_string())
}

fn number(row: &Row, column: &str) -> Result<f64, String> {
    row[column].parse().map_err(|e| format!("{column}: {e}"))
}

/// What the note of a row says about accuracy: `tolerance 1e-9`.
fn tolerance(row: &Row) -> Option<f64> {
    let mut words = row["note"].split([' ', ':', '=', ',', ';']);
    words.find(|w| w.to_lowercase().starts_with("tol"))?;
    words.find_map(|w| w.parse().ok())
}

/// Compares to 1e-13 of the expected value, or to what the note says; where operands cancel, to a rounding error or two of the
/// largest of them.
fn compare(row: &Row, got: f64, expected: f64, largest: f64) -> Result<(), String> {
    let allowed = match tolerance(row) {
        Some(tolerance) => tolerance * expected.abs().max(1.0),
        None => 1e-13 * expected.abs() + 2.0 * f64::EPSILON * largest,
    };
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
    /// of each spline the largest value and the shortest interval
    sizes: Vec<(f64, f64)>,
}

impl World {
    /// The size of what cancels inside the measures of these markers, and inside the curve that an expression consists of.
    fn size(&self, ast: &Ast) -> f64 {
        let most = |part: fn(&MarkerState<f64>) -> Vec3<f64>| {
            self.markers
                .values()
                .map(|m| part(m).norm())
                .fold(0.0, f64::max)
        };
        let (r, v, a) = (most(|m| m.p_GM), most(|m| m.v_GM), most(|m| m.a_GM));
        let (w, alpha) = (most(|m| m.w_GM), most(|m| m.alpha_GM));
        r.max(v + w * r)
            .max(a + alpha * r + 2.0 * w * v + w * w * r)
            .max(self.curve_size(ast))
    }

    /// Values of a curve over the shortest interval, to the power of the order that is asked for; the equations for its
    /// coefficients round a few times.
    fn curve_size(&self, ast: &Ast) -> f64 {
        let Node::Call { args, .. } = ast.node(ast.root) else {
            return 0.0;
        };
        let order = match args.get(3).map(|&a| ast.node(a)) {
            Some(Node::Number { literal, .. }) => *literal as i32,
            _ => 0,
        };
        self.sizes
            .iter()
            .fold(0.0, |most: f64, (values, interval)| {
                most.max(4.0 * values / interval.powi(order))
            })
    }
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
            let at = |i: usize, j: usize| rows.get(i).and_then(|r| r.get(j)).copied();
            let entry = |i, j| at(i, j).unwrap_or(f64::NAN);
            state.R_GM = Mat3(std::array::from_fn(|i| {
                std::array::from_fn(|j| entry(i, j))
            }));
        }
        markers.insert(id.parse().map_err(|e| format!("{id}: {e}"))?, state);
    }
    Ok(markers)
}

fn splines(text: &str) -> Result<World, String> {
    let (mut bindings, mut sizes) = (Bindings::default(), Vec::new());
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
        let x = numbers(s.get("x"));
        sizes.push((
            y.iter()
                .flatten()
                .fold(0.0, |most: f64, y| most.max(y.abs())),
            x.windows(2)
                .fold(f64::INFINITY, |least, w| least.min(w[1] - w[0])),
        ));
        let spline = Spline::new(x, z, y, ends, extrapolation).map_err(|e| e.to_string())?;
        bindings.splines.insert(
            id.parse().map_err(|e| format!("{id}: {e}"))?,
            Arc::new(spline),
        );
    }
    Ok(World {
        bindings,
        sizes,
        ..World::default()
    })
}

/// A marker state of plain numbers in another kind of number.
fn lifted<S: Scalar>(m: &MarkerState<f64>) -> MarkerState<S> {
    MarkerState {
        R_GM: Mat3::constant(m.R_GM),
        p_GM: Vec3::constant(m.p_GM),
        w_GM: Vec3::constant(m.w_GM),
        v_GM: Vec3::constant(m.v_GM),
        alpha_GM: Vec3::constant(m.alpha_GM),
        a_GM: Vec3::constant(m.a_GM),
    }
}

/// What the program gives at this time, over any kind of number; measures are computed in that kind too.
fn over<S: Scalar>(program: &Program, world: &World, time: S) -> Result<S, String> {
    let input = |&input: &Input| match input {
        Input::Time => Some(time),
        Input::Measure(m, arguments) => {
            kinematic_of(m, arguments, |id| world.markers.get(&id).map(lifted))
        }
        _ => None,
    };
    let inputs: Option<Vec<S>> = program.inputs().iter().map(input).collect();
    let inputs = inputs.ok_or_else(|| format!("no value for one of {:?}", program.inputs()))?;
    let mut out = [S::zero()];
    program.eval(&inputs, &mut Work::default(), &mut out);
    Ok(out[0])
}

/// The value through walker, program over numbers, duals and lanes.
fn run(row: &Row, dialect: Dialect, world: World) -> Result<(), String> {
    let text = text_of(row);
    let ast = tree(&text, dialect)?;
    check_constants(&ast).map_err(|e| e.diagnostic(&text).to_string())?;
    let values = values(&ast, &world).map_err(|e| e.diagnostic(&text).to_string())?;
    let largest = values
        .iter()
        .flatten()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    let walked = values[ast.root as usize].unwrap_or(f64::NAN);
    compare(
        row,
        walked,
        number(row, "expected")?,
        world.size(&ast).max(largest),
    )?;

    let program = compile(&[&ast], &world.bindings).map_err(|e| e.to_string())?;
    let same = |what: &str, got: f64, expected: f64| match got == expected
        || got.is_nan() && expected.is_nan()
    {
        true => Ok(()),
        false => Err(format!("{what} gives {got:?}, not {expected:?}")),
    };
    same("the program", over(&program, &world, world.time)?, walked)?;
    same(
        "the program over duals",
        over(&program, &world, Dual::<1>::variable(world.time, 0))?.re,
        walked,
    )?;
    same(
        "the program over jets",
        over(&program, &world, Jet::variable(world.time))?.value,
        walked,
    )?;
    let times = [world.time, world.time + 0.3, 0.0, 7.7];
    let lanes = over(&program, &world, Lanes(times))?;
    for (lane, time) in times.into_iter().enumerate() {
        same("a lane", lanes.0[lane], over(&program, &world, time)?)?;
    }
    Ok(())
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
        run(row, Dialect::Function, splines(&row["splines"])?)
    });
}

#[test]
fn derivatives_have_the_stated_values() {
    all_rows("derivatives", |row| {
        let (time, expected) = (number(row, "time")?, number(row, "expected")?);
        let ast = tree(&text_of(row), Dialect::Function)?;
        let program = compile(&[&ast], &Bindings::default()).map_err(|e| e.to_string())?;
        let world = World::default();
        let jet = over(&program, &world, Jet::variable(time))?;
        let order = number(row, "order")?;
        let of_order = |jet: Jet| if order == 1.0 { jet.first } else { jet.second };
        // a derivative that is small here is as accurate as value and derivatives are large nearby
        let mut nearby: f64 = 0.0;
        for t in [time - 0.1, time, time + 0.1] {
            let jet = over(&program, &world, Jet::variable(t))?;
            let sizes = [jet.value, jet.first, of_order(jet)].map(f64::abs);
            nearby = sizes
                .into_iter()
                .filter(|x| x.is_finite())
                .fold(nearby, f64::max);
        }
        let dual = over(&program, &world, Dual::<1>::variable(time, 0))?;
        let twice = over(
            &program,
            &world,
            Dual::<1, Dual<1>>::variable(Dual::variable(time, 0), 0),
        )?;
        let others = if order == 1.0 {
            [dual.eps[0], twice.eps[0].re]
        } else {
            [twice.eps[0].eps[0]; 2]
        };
        let mut got = others.into_iter().chain([of_order(jet)]);
        got.try_for_each(|got| compare(row, got, expected, nearby))
    });
}

#[test]
fn malformed_texts_give_the_stated_kind_and_column() {
    all_rows("errors", |row| {
        let text = text_of(row);
        let profile = if row["note"].contains("compat limits on") {
            Profile::Ideas
        } else {
            Profile::Adams
        };
        let said = |time: f64| {
            let world = World {
                time,
                ..World::default()
            };
            parse(&text, Dialect::Function, profile)
                .and_then(|ast| value(&ast, &world).map_err(|e| e.diagnostic(&text)))
                .map_or_else(
                    |e| format!("{} at {}", e.code, e.column),
                    |v| format!("the value {v}"),
                )
        };
        let expected = format!("{} at {}", &row["kind"], &row["column"]);
        // what has no value need not have none at every time
        let times = [0.5, 0.0, 1.0, -1.0, 2.0, 10.0];
        let times = &times[..if &row["kind"] == "domain" { 6 } else { 1 }];
        if times.iter().any(|&time| said(time) == expected) {
            Ok(())
        } else {
            Err(format!("got {}, expected {expected}", said(0.5)))
        }
    });
}

#[test]
fn orient_gives_back_the_rotation_that_its_angles_make() {
    use cognate::expr::measures::Measure;
    use std::f64::consts::PI;
    let about = |axis: usize, angle: f64| {
        let (s, c) = angle.sin_cos();
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut m = [[0.0; 3]; 3];
        (m[axis][axis], m[j][j], m[k][k]) = (1.0, c, c);
        (m[j][k], m[k][j]) = (-s, s);
        Mat3(m)
    };
    // systems 1 and 13 first
    let sequences = [
        [0, 1, 2],
        [1, 2, 0],
        [2, 0, 1],
        [0, 2, 1],
        [1, 0, 2],
        [2, 1, 0],
        [0, 1, 0],
        [0, 2, 0],
        [1, 0, 1],
        [1, 2, 1],
        [2, 0, 2],
        [2, 1, 2],
    ];
    for angles in [[0.3, 0.7, -0.9], [2.5, -0.4, 1.1], [-1.9, 1.2, PI - 0.1]] {
        let r = from_313(angles[0], angles[1], angles[2]);
        let state = MarkerState {
            R_GM: r,
            ..MarkerState::ground()
        };
        let orient = |system: u32, component: u32| {
            let arguments = [system, component, 1, 0];
            kinematic_of(Measure::Orient, arguments, |_| Some(state)).unwrap()
        };
        let near = |what: &str, found: Mat3<f64>| {
            for (a, b) in found.0.iter().flatten().zip(r.0.iter().flatten()) {
                // a few roundings
                assert!((a - b).abs() < 1e-13, "{what}: {found:?} {r:?}");
            }
        };
        for (k, [a, b, c]) in sequences.into_iter().enumerate() {
            let system = k as u32 + 1;
            let t = [1, 2, 3].map(|n| orient(system, n));
            near(
                "moving axes",
                about(a, t[0]) * about(b, t[1]) * about(c, t[2]),
            );
            let t = [1, 2, 3].map(|n| orient(system + 12, n));
            near(
                "fixed axes",
                about(c, t[2]) * about(b, t[1]) * about(a, t[0]),
            );
        }
        let cosine = |row: usize, column: usize| orient(29, (3 * column + row + 1) as u32);
        near(
            "cosines",
            Mat3(std::array::from_fn(|r| {
                std::array::from_fn(|c| cosine(r, c))
            })),
        );
        for n in 1..=3 {
            let rodrigues = orient(27, n + 1) / orient(27, 1);
            assert!((orient(28, n) - rodrigues).abs() < 1e-13 * (1.0 + rodrigues.abs()));
        }
        assert_eq!(
            kinematic_of(Measure::Orient, [25, 1, 1, 0], |_| Some(state)),
            None
        );
        assert_eq!(
            kinematic_of(Measure::Orient, [28, 4, 1, 0], |_| Some(state)),
            None
        );
    }
}
