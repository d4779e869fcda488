//! The gallery: every model in `examples/gallery` runs, is drawn, and does what is known of it.
//!
//! ```text
//! ! expect: until T: LEFT = RIGHT +- TOLERANCE          at every output up to T
//! ! expect: at T: LEFT = RIGHT +- TOLERANCE             at the last output of that time
//! ```

use super::command::{cognate, path, scratch};
use crate::repository::root;
use std::path::PathBuf;

/// Names and texts of the datasets.
fn datasets() -> Vec<(String, String)> {
    let folder = std::fs::read_dir(root("examples/gallery")).unwrap();
    let mut all: Vec<_> = folder
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "adm"))
        .map(|p| {
            (
                p.file_stem().unwrap().to_string_lossy().into_owned(),
                std::fs::read_to_string(&p).unwrap(),
            )
        })
        .collect();
    all.sort();
    all
}

/// What is expected: whether at one time only, the time, the difference, its tolerance.
struct Expectation {
    at_once: bool,
    time: f64,
    difference: String,
    tolerance: f64,
}

fn expectations(text: &str) -> Vec<Expectation> {
    let lines = text
        .lines()
        .filter_map(|line| line.strip_prefix("! expect: "));
    lines
        .map(|line| {
            let (when, rest) = line.split_once(": ").unwrap();
            let (kind, time) = when.split_once(' ').unwrap();
            let (equation, tolerance) = rest.rsplit_once(" +- ").unwrap();
            let (left, right) = equation.split_once(" = ").unwrap();
            Expectation {
                at_once: match kind {
                    "at" => true,
                    "until" => false,
                    _ => panic!("{line}"),
                },
                time: time.parse().unwrap(),
                difference: format!("({left})-({right})"),
                tolerance: tolerance.parse().unwrap(),
            }
        })
        .collect()
}

#[test]
fn mechanisms_do_what_is_known_of_them() {
    for (name, text) in datasets() {
        let expected = expectations(&text);
        assert!(!expected.is_empty(), "{name}: nothing is known of it");
        let model = root("examples/gallery").join(format!("{name}.acf"));
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
            .join("gallery")
            .join(&name);
        let mut arguments = vec![
            "run",
            path(&model),
            "--quiet",
            "--max-steps",
            "200000",
            "--out",
            path(&folder),
        ];
        for e in &expected {
            arguments.extend(["--column", e.difference.as_str()]);
        }
        let done = cognate(&arguments);
        assert_eq!(done.code, 0, "{name}: {}", done.err);
        let table = std::fs::read_to_string(folder.join(format!("{name}.csv"))).unwrap();
        let numbers = |line: &str| {
            line.split(',')
                .map(|x| x.parse().unwrap_or(f64::NAN))
                .collect::<Vec<f64>>()
        };
        let rows: Vec<Vec<f64>> = table.lines().skip(2).map(numbers).collect();
        // a column that is asked for twice is there once
        let mut columns: Vec<&str> = Vec::new();
        for e in &expected {
            let known = columns.iter().position(|c| *c == e.difference);
            let k = known.unwrap_or_else(|| {
                columns.push(&e.difference);
                columns.len() - 1
            });
            let off = |row: &Vec<f64>| row[k + 1].abs();
            let found = if e.at_once {
                let same = rows
                    .iter()
                    .rfind(|row| (row[0] - e.time).abs() < 1e-9 * (1.0 + e.time));
                off(same.unwrap_or_else(|| panic!("{name}: there is no output at {}", e.time)))
            } else {
                let all = rows.iter().filter(|row| row[0] <= e.time * (1.0 + 1e-12));
                let worst = all
                    .map(off)
                    .fold(0.0, |a: f64, b| if b <= a { a } else { b });
                assert!(rows.len() > 20, "{name}: {} outputs", rows.len());
                worst
            };
            assert!(
                found <= e.tolerance,
                "{name}: {} is {found} off",
                e.difference
            );
        }
    }
}

#[test]
fn the_gallery_shows_at_least_sixteen_and_each_has_its_picture_and_its_paragraph() {
    let all = datasets();
    assert!(all.len() >= 16, "{}", all.len());
    let page = std::fs::read_to_string(root("docs/gallery.md")).unwrap();
    for (name, text) in all {
        let picture = root("docs/gallery").join(format!("{name}.svg"));
        assert!(
            picture.is_file(),
            "{name}: cargo run --example gallery draws it"
        );
        let look = text.lines().filter_map(|l| l.strip_prefix("! look: "));
        let look = look.map(str::trim).collect::<Vec<_>>().join(" ");
        assert!(look.len() > 60, "{name}: what is to be looked at?");
        for part in [
            &format!("(gallery/{name}.svg)"),
            &look,
            text.lines().next().unwrap(),
        ] {
            assert!(
                page.contains(part),
                "{name}: cargo run --example gallery writes the page anew: {part}"
            );
        }
    }
}

#[test]
fn drawings_are_the_same_every_time_and_name_the_bodies() {
    let model = root("examples/gallery/slider_crank.acf");
    let draw = |name: &str| {
        let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
        let done = cognate(&[
            "draw",
            path(&model),
            "--at",
            "0.1",
            "--names",
            "all",
            "-o",
            path(&file),
        ]);
        assert_eq!(done.code, 0, "{}", done.err);
        std::fs::read_to_string(&file).unwrap()
    };
    let (first, second) = (draw("drawn_a.svg"), draw("drawn_b.svg"));
    assert!(first == second);
    for name in [">crank<", ">rod<", ">slider<", ">JOINT/1<", " mm<"] {
        assert!(first.contains(name), "{name}");
    }
    let unknown = cognate(&["draw", path(&model), "--highlight", "JOINT/77"]);
    assert_eq!(unknown.code, 3);
    assert!(unknown.err.contains("JOINT/77"), "{}", unknown.err);
}

#[test]
fn axes_of_markers_take_the_place_of_joints_and_dimensions_have_their_values() {
    let model = root("examples/gallery/slider_crank.acf");
    let draw = |options: &[&str]| {
        let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("drawn_axes.svg");
        let always = ["draw", path(&model), "--at", "0.1", "--names", "all"];
        let done = cognate(&[&always, options, &["-o", path(&file)]].concat());
        assert_eq!(done.code, 0, "{}", done.err);
        std::fs::read_to_string(&file).unwrap()
    };
    let axes = ["#cc3e34", "#349448", "#3662c4"];
    let joints = draw(&[]);
    assert!(joints.contains(">JOINT/1<") && !axes.iter().any(|a| joints.contains(a)));
    let markers = draw(&["--symbols", "markers"]);
    assert!(!markers.contains("JOINT/") && markers.contains(">MARKER/"));
    assert!(
        axes[..2].iter().all(|a| markers.contains(a)),
        "x and y lie in the plane"
    );
    let actions = draw(&["--symbols", "actions"]);
    assert!(actions.contains(">JOINT/1<") && actions.contains("#186080"));
    let none = draw(&["--symbols", "none"]);
    assert!(!none.contains("JOINT/") && !none.contains("MARKER/"));
    // the length of the crank is that of the dataset
    let dimension = draw(&["--dimension", "22,11"]);
    assert!(dimension.contains(">50 mm<"));
    for wrong in ["20", "20,10,30", "PART/2,10"] {
        let done = cognate(&["draw", path(&model), "--dimension", wrong]);
        assert_eq!(done.code, 3, "{wrong}: {}", done.err);
    }
    let unknown = cognate(&["draw", path(&model), "--dimension", "22,7777"]);
    assert_eq!(unknown.code, 3, "{}", unknown.err);
    assert!(unknown.err.contains("MARKER/7777"), "{}", unknown.err);
}

#[test]
fn what_is_fixed_twice_stands_out() {
    let model = root("tests/scenes/four_bar.adm");
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("fixed_twice.svg");
    let done = cognate(&["verify", path(&model), "--draw", path(&file)]);
    assert_eq!(done.code, 0, "{}", done.err);
    let text = std::fs::read_to_string(&file).unwrap();
    // bodies are pale, the joints that fix the same are red
    let (pale, clear) = text.split_once("</g>").unwrap();
    assert!(pale.contains("<g opacity=\"0.3\">"));
    assert!(clear.contains("#d0342c") && clear.contains(">JOINT/4<"));
}

#[test]
fn shells_of_files_are_drawn_and_those_that_are_not_there_are_told() {
    let text = |shells: &str| {
        format!(
            "shells\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\n\
             MARKER/21, PART=2, QP=2,1,1\n{shells}END\n"
        )
    };
    let wedge = "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    scratch("draw_shells", "wedge.obj", wedge);
    let draw = |name: &str, shells: &str| {
        let model = scratch("draw_shells", name, &text(shells));
        let picture = model.with_extension("svg");
        let done = cognate(&["draw", path(&model), "--from", "side", "-o", path(&picture)]);
        assert_eq!(done.code, 0, "{}", done.err);
        (
            std::fs::read_to_string(picture)
                .unwrap()
                .matches("<path")
                .count(),
            done.err,
        )
    };
    let (without, _) = draw("without.adm", "");
    let (with, said) = draw("with.adm", "GRAPHICS/1, SHELL, RM=20, FILE=wedge.obj\n");
    assert!(
        with > without && !said.contains("not drawn"),
        "{with} {without} {said}"
    );
    let (absent, said) = draw("absent.adm", "GRAPHICS/1, SHELL, RM=20, FILE=absent.stl\n");
    assert_eq!(absent, without);
    assert!(
        said.contains("GRAPHICS/1 is not drawn") && said.contains("no such file"),
        "{said}"
    );
}
