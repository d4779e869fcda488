//! `cognate animate`: the page that moves and the `.glb` file, read by a browser and by the validator of glTF where these are
//! there; without them the tests are left out.

use super::command::{cognate, path, scratch};
use super::needs;
use crate::repository::root;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Returns whether node and the packages of the viewer are here.
#[track_caller]
fn has_node() -> bool {
    let packages = root("assets/viewer/node_modules").is_dir();
    needs::has("npm ci in assets/viewer", packages) && needs::runs("node", "node", &["--version"])
}

/// Runs a script of the viewer; `None`: what it needs is not here.
#[track_caller]
fn script(name: &str, arguments: &[&str]) -> Option<Value> {
    if !has_node() {
        return None;
    }
    let done = Command::new("node")
        .arg(root("assets/viewer").join(name))
        .args(arguments)
        .output()
        .unwrap();
    let text = String::from_utf8(done.stdout).unwrap();
    assert!(
        done.status.success(),
        "{text}{}",
        String::from_utf8_lossy(&done.stderr)
    );
    let found: Value = serde_json::from_str(&text).unwrap();
    needs::has("Chromium", found["skipped"].is_null()).then_some(found)
}

/// A pendulum that starts level: no GRAPHICS, one joint.
const PENDULUM: &str = "A pendulum
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
ACCGRAV/JGRAV=-9.80665
PART/1, GROUND
MARKER/10, PART=1
PART/2, QG=1,0,0, MASS=2, CM=21, IP=0.01,0.01,0.01
MARKER/20, PART=2, QP=-1,0,0
MARKER/21, PART=2
JOINT/1, REVOLUTE, I=20, J=10
REQUEST/1, DISPLACEMENT, I=21, J=10, COMMENT=tip
END
";

fn animated(test: &str, model: &str, ending: &str) -> PathBuf {
    let model = scratch(test, "m.adm", model);
    let file = model.with_extension(ending);
    let done = cognate(&[
        "animate",
        path(&model),
        "--end",
        "1",
        "--steps",
        "50",
        "-o",
        path(&file),
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    file
}

/// The description of a `.glb` file, and the numbers of one of its accessors.
struct Glb {
    json: Value,
    binary: Vec<u8>,
}

impl Glb {
    fn read(file: &Path) -> Self {
        let bytes = std::fs::read(file).unwrap();
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!(
            (&bytes[..4], word(4), word(8)),
            (&b"glTF"[..], 2, bytes.len())
        );
        let json = serde_json::from_slice(&bytes[20..20 + word(12)]).unwrap();
        let binary = bytes[28 + word(12)..].to_vec();
        Self { json, binary }
    }
    fn numbers(&self, accessor: &Value) -> Vec<f32> {
        let accessor = &self.json["accessors"][accessor.as_u64().unwrap() as usize];
        let view = &self.json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let at = view["byteOffset"].as_u64().unwrap() as usize;
        let length = view["byteLength"].as_u64().unwrap() as usize;
        let words = self.binary[at..at + length].chunks_exact(4);
        words
            .map(|w| f32::from_le_bytes(w.try_into().unwrap()))
            .collect()
    }
    /// Times and values of the channel of a node.
    fn channel(&self, node: &str, path: &str) -> (Vec<f32>, Vec<f32>) {
        let nodes = self.json["nodes"].as_array().unwrap();
        let node = nodes.iter().position(|n| n["name"] == node).unwrap();
        let animation = &self.json["animations"][0];
        let mut all = animation["channels"].as_array().unwrap().iter();
        let wanted = |c: &&Value| c["target"]["node"] == node && c["target"]["path"] == path;
        let sampler =
            &animation["samplers"][all.find(wanted).unwrap()["sampler"].as_u64().unwrap() as usize];
        (
            self.numbers(&sampler["input"]),
            self.numbers(&sampler["output"]),
        )
    }
}

#[test]
fn the_body_of_a_glb_stays_on_its_circle_and_turns_with_it() {
    let glb = Glb::read(&animated("animate_glb", PENDULUM, "glb"));
    let (times, places) = glb.channel("PART_2", "translation");
    assert_eq!((times[0], *times.last().unwrap()), (0.0, 1.0));
    for p in places.chunks_exact(3) {
        assert!(
            (p[0].hypot(p[1]) - 1.0).abs() < 1e-4 && p[2].abs() < 1e-6,
            "{p:?}"
        );
    }
    assert!(
        places.chunks_exact(3).any(|p| p[1] < -0.99),
        "it falls to the lowest place"
    );
    let (_, turns) = glb.channel("PART_2", "rotation");
    for q in turns.chunks_exact(4) {
        assert!(
            (q.iter().map(|x| x * x).sum::<f32>() - 1.0).abs() < 1e-5,
            "{q:?}"
        );
    }
}

#[test]
fn the_validator_of_gltf_finds_nothing() {
    for (name, model) in [
        ("pendulum", PENDULUM.to_owned()),
        (
            "stewart",
            std::fs::read_to_string(root("tests/scenes/stewart.adm")).unwrap(),
        ),
    ] {
        let file = animated(&format!("animate_valid_{name}"), &model, "glb");
        let Some(found) = script("validate.mjs", &[path(&file)]) else {
            return;
        };
        assert_eq!(
            (&found["errors"], &found["warnings"]),
            (&0.into(), &0.into()),
            "{found}"
        );
        assert_eq!(found["animations"], 1);
    }
}

#[test]
fn rows_at_one_time_and_at_negative_times_make_a_valid_file() {
    // a static row and dynamic rows share the time of the start, and there are two simulations
    let model = scratch("animate_times", "m.adm", PENDULUM);
    let commands = scratch(
        "animate_times",
        "m.acf",
        "FILE/MODEL=m\nSIMULATE/STATICS\nSIMULATE/DYNAMICS, END=0.5, STEPS=10\nSIMULATE/DYNAMICS, END=1, STEPS=10\nSTOP\n",
    );
    let file = model.with_extension("glb");
    let done = cognate(&["animate", path(&commands), "-o", path(&file)]);
    assert_eq!(done.code, 0, "{}", done.err);
    let glb = Glb::read(&file);
    for animation in glb.json["animations"].as_array().into_iter().flatten() {
        for sampler in animation["samplers"].as_array().unwrap() {
            let times = glb.numbers(&sampler["input"]);
            assert!(
                times[0] >= 0.0 && times.windows(2).all(|t| t[0] < t[1]),
                "{times:?}"
            );
        }
    }
}

#[test]
fn the_page_asks_nobody_and_shows_the_numbers_of_the_table() {
    let acf = root("examples/slider_crank.acf");
    let folder = scratch("animate_page", "x", "").with_file_name("run");
    let done = cognate(&[
        "run",
        path(&acf),
        "--animate",
        "--out",
        path(&folder),
        "--format",
        "csv",
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    let page = folder.join("slider_crank.html");
    let text = std::fs::read_to_string(&page).unwrap();
    for outside in ["src=", "<link", "@import", "type=\"module\""] {
        let head = text.split("<script>").next().unwrap();
        assert!(!head.contains(outside), "{outside}");
    }
    assert!(
        text.contains("Three.js Authors") && text.contains("Leon Sorokin"),
        "licences are kept"
    );
    let Some(found) = script(
        "check.mjs",
        &[
            path(&page),
            "--rows",
            "0,37,100",
            "--columns",
            "slider.X,crank.WZ,slider.FX",
        ],
    ) else {
        return;
    };
    assert_eq!(found["requests"], Value::Array(Vec::new()));
    assert_eq!(found["errors"], Value::Array(Vec::new()));
    assert!(
        found["colours"].as_u64() > Some(3),
        "bodies have colours: {found}"
    );
    assert!(
        found["changed"].as_u64() > Some(300),
        "the picture changes: {found}"
    );
    assert_eq!(found["played"], true);
    // rows of the table below names and units
    let table = std::fs::read_to_string(folder.join("slider_crank.csv")).unwrap();
    let mut lines = table
        .lines()
        .map(|line| line.split(',').collect::<Vec<_>>());
    let names = lines.next().unwrap();
    let rows: Vec<_> = lines.skip(1).collect();
    assert_eq!(found["rows"], rows.len());
    for (name, values) in found["values"].as_object().unwrap() {
        let column = names.iter().position(|n| n == name).unwrap();
        let largest = rows
            .iter()
            .map(|r| r[column].parse::<f64>().unwrap().abs())
            .fold(0.0, f64::max);
        for (row, value) in [0, 37, 100].into_iter().zip(values.as_array().unwrap()) {
            let expected: f64 = rows[row][column].parse().unwrap();
            let off = (value.as_f64().unwrap() - expected).abs();
            assert!(
                off <= 1e-7 * largest,
                "{name} in row {row}: {value}, not {expected}"
            );
        }
    }
}

#[test]
fn a_run_that_was_read_from_a_file_is_shown_with_its_model() {
    let model = scratch("animate_read", "m.adm", PENDULUM);
    let folder = model.with_file_name("out");
    let formats = "res,json,parquet";
    let done = cognate(&[
        "run",
        path(&model),
        "--end",
        "1",
        "--steps",
        "20",
        "--format",
        formats,
        "--out",
        path(&folder),
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    let direct = model.with_extension("glb");
    let options = ["--end", "1", "--steps", "20", "-o", path(&direct)];
    assert_eq!(
        cognate(&[&["animate", path(&model)], &options[..]].concat()).code,
        0
    );
    let (times, places) = Glb::read(&direct).channel("PART_2", "translation");
    for ending in ["res", "parquet"] {
        let file = folder.join("m").with_extension(ending);
        let glb = file.with_extension(format!("{ending}.glb"));
        let done = cognate(&[
            "animate",
            path(&file),
            "--model",
            path(&model),
            "-o",
            path(&glb),
        ]);
        assert_eq!(done.code, 0, "{ending}: {}", done.err);
        let (also, read) = Glb::read(&glb).channel("PART_2", "translation");
        assert_eq!(times.len(), also.len(), "{ending}");
        let off = places
            .iter()
            .zip(&read)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f32::max);
        assert!(off < 1e-5, "{ending}: {off}");
    }
    // a table of requests does not say where bodies are
    let table = scratch("animate_read", "t.csv", "time,x\nsec,m\n0,1\n1,2\n");
    let done = cognate(&["animate", path(&table), "--model", path(&model)]);
    assert_eq!(done.code, 3);
    assert!(
        done.err.contains("no_positions") && done.err.contains("--format res"),
        "{}",
        done.err
    );
}

#[test]
fn the_viewer_is_what_its_sources_make() {
    if !has_node() {
        return;
    }
    let done = Command::new("node")
        .arg(root("assets/viewer/build.mjs"))
        .arg("--check")
        .output()
        .unwrap();
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
}

#[test]
fn two_runs_are_shown_over_each_other() {
    let model = scratch("animate_over", "m.adm", PENDULUM);
    let folder = model.with_file_name("out");
    let done = cognate(&[
        "run",
        path(&model),
        "--end",
        "1",
        "--steps",
        "20",
        "--format",
        "res",
        "--out",
        path(&folder),
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    let (other, page) = (folder.join("m.res"), model.with_extension("html"));
    let options = [
        "--end",
        "2",
        "--steps",
        "50",
        "--over",
        path(&other),
        "-o",
        path(&page),
    ];
    let done = cognate(&[&["animate", path(&model)], &options[..]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let Some(found) = script("check.mjs", &[path(&page)]) else {
        return;
    };
    assert_eq!(found["errors"], Value::Array(Vec::new()));
    assert!(found["changed"].as_u64() > Some(300), "{found}");
}

/// A ball of radius 0.5 that is driven along x at 4 m/s, and a post that it grazes from x = 3 to 4, 0.3 deep.
const GRAZE: &str = "\
graze
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
PART/1, GROUND
MARKER/2, PART=1, QP=3,-2,-1
MARKER/10, PART=1, REULER=90D,90D,90D
PART/2, MASS=1, CM=20, IP=1,1,1
MARKER/20, PART=2
MARKER/21, PART=2, REULER=90D,90D,90D
JOINT/1, TRANSLATIONAL, I=21, J=10
MOTION/1, JOINT=1, FUNCTION=4*TIME
GRAPHICS/1, ELLIPSOID, CM=20, XSCALE=1, YSCALE=1, ZSCALE=1
GRAPHICS/2, BOX, CORNER=2, X=1, Y=1.8, Z=2
END
";

#[cfg(feature = "geometry")]
#[test]
fn overlaps_are_marked_where_and_when_geometry_says() {
    let model = scratch("animate_overlaps", "graze.adm", GRAZE);
    let page = model.with_extension("html");
    let animate = |end: &str| {
        let all = [
            "animate",
            path(&model),
            "--end",
            end,
            "--steps",
            "40",
            "--interference",
            "-o",
            path(&page),
        ];
        let done = cognate(&all);
        assert_eq!(done.code, 0, "{}", done.err);
        done.err
    };
    assert!(animate("0.5").contains("no solids overlap"));
    assert!(!animate("1").contains("no solids overlap"));
    let Some(found) = script("check.mjs", &[path(&page)]) else {
        return;
    };
    assert_eq!(found["errors"], Value::Array(Vec::new()));
    let overlap = &found["overlaps"][0];
    assert_eq!(
        overlap["elements"],
        serde_json::json!(["GRAPHICS/1", "GRAPHICS/2"])
    );
    assert!(
        (overlap["depth"].as_f64().unwrap() - 0.3).abs() < 1e-3,
        "{overlap}"
    );
    let place: Vec<f64> = overlap["place"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(Value::as_f64)
        .collect();
    // at the middle of the overlap, while the ball is beside the post
    assert!(
        place[0] > 2.9 && place[0] < 4.1 && (place[1] + 0.35).abs() < 0.16 && place[2].abs() < 1e-3,
        "{overlap}"
    );
    assert_eq!(overlap["before"], serde_json::json!([false, false, false]));
}

#[test]
fn a_dimension_on_the_page_changes_as_the_distance_of_its_markers_does() {
    let below = PENDULUM.replace("PART/2,", "MARKER/11, PART=1, QP=0,-1,0\nPART/2,");
    let model = scratch("animate_dimension", "m.adm", &below);
    let page = model.with_extension("html");
    let animate = |dimension: &str| {
        let arguments = ["--end", "1", "--steps", "50", "-o", path(&page)];
        let mut all = vec!["animate", path(&model), "--dimension", dimension];
        all.extend(arguments);
        cognate(&all)
    };
    let unknown = animate("21,77");
    assert_eq!(unknown.code, 3, "{}", unknown.err);
    assert!(unknown.err.contains("MARKER/77"), "{}", unknown.err);
    let done = animate("21,11");
    assert_eq!(done.code, 0, "{}", done.err);
    let wanted = [
        "--dimensions",
        "0,25,50",
        "--rows",
        "0,25,50",
        "--columns",
        "REQUEST_1.DX,REQUEST_1.DY",
    ];
    let Some(found) = script("check.mjs", &[&[path(&page)], &wanted[..]].concat()) else {
        return;
    };
    assert_eq!(found["errors"], Value::Array(Vec::new()));
    for (k, shown) in found["dimensions"].as_array().unwrap().iter().enumerate() {
        let [x, y] =
            ["REQUEST_1.DX", "REQUEST_1.DY"].map(|name| found["values"][name][k].as_f64().unwrap());
        let expected = x.hypot(y + 1.0);
        assert!(
            (shown[0].as_f64().unwrap() - expected).abs() < 1e-4,
            "{k}: {shown}"
        );
    }
    // symbols of joints make room for those of markers, and come back
    let shown = serde_json::json!([[true, false], [false, true], [true, false]]);
    assert_eq!(found["symbols"], shown);
}

#[test]
fn results_without_a_record_find_the_dataset_of_their_name() {
    let model = scratch("namesake", "m.adm", PENDULUM);
    let out = model.with_file_name("out");
    let run = [
        "run",
        path(&model),
        "--end",
        "1",
        "--steps",
        "10",
        "--format",
        "res",
    ];
    let done = cognate(&[&run[..], &["--out", path(&out), "--quiet"]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    // as another program leaves them: the dataset and the results, no record
    let alone = model.with_file_name("alone");
    std::fs::create_dir_all(&alone).unwrap();
    std::fs::copy(out.join("m.res"), alone.join("m.res")).unwrap();
    let results = alone.join("m.res");
    let page = alone.join("m.html");
    let motion = [
        "motion",
        path(&results),
        "--of",
        "MARKER/21",
        "--relative-to",
        "10",
    ];
    let animate = ["animate", path(&results), "-o", path(&page)];
    let _ = std::fs::remove_file(alone.join("m.adm"));
    for asked in [&motion[..], &animate] {
        let done = cognate(asked);
        assert!(
            done.code == 3 && done.err.contains("no_model"),
            "{}",
            done.err
        );
    }
    std::fs::copy(&model, alone.join("m.adm")).unwrap();
    for asked in [&motion[..], &animate] {
        let done = cognate(asked);
        assert_eq!(done.code, 0, "{}", done.err);
    }
}

#[test]
fn a_dataset_is_drawn_whatever_forces_it_has() {
    let contact = "GRAPHICS/1, EXTERNAL, FILE=body.xmt_txt, RM=21\nGRAPHICS/2, EXTERNAL, FILE=body.xmt_txt, RM=10\n\
        CONTACT/1, IGEOM=1, JGEOM=2, STIFFNESS=1E5, EXPONENT=1.5, DAMPING=10, DMAX=0.01\nREQUEST/1";
    let model = scratch(
        "drawn_unsolved",
        "m.adm",
        &PENDULUM.replacen("REQUEST/1", contact, 1),
    );
    let picture = model.with_extension("svg");
    let run = cognate(&[
        "run",
        path(&model),
        "--end",
        "1",
        "--out",
        path(&picture.with_extension("d")),
    ]);
    assert_eq!(run.code, 4, "{}", run.err);
    let check = cognate(&["check", path(&model)]);
    assert!(
        check.err.contains("no mistake, ") && check.err.contains(" note"),
        "{}",
        check.err
    );
    for asked in [
        ["draw", path(&model), "-o", path(&picture)],
        ["verify", path(&model), "--draw", path(&picture)],
    ] {
        let _ = std::fs::remove_file(&picture);
        let done = cognate(&asked);
        assert_eq!(done.code, 0, "{}", done.err);
        assert!(picture.is_file());
    }
}

#[test]
fn a_dataset_without_an_end_stands_still_and_is_told_how_it_moves() {
    let model = scratch("animate_still", "m.adm", PENDULUM);
    let page = model.with_extension("html");
    let said = |options: &[&str]| {
        let done = cognate(&[&["animate", path(&model), "-o", path(&page)], options].concat());
        assert_eq!(done.code, 0, "{}", done.err);
        done.err
    };
    let still = said(&[]);
    assert!(
        still.contains("nothing moves") && still.contains("--end 2"),
        "{still}"
    );
    assert!(!said(&["--end", "0.1", "--steps", "4"]).contains("nothing moves"));
}

#[cfg(feature = "gif")]
#[test]
fn a_film_repeats_takes_the_time_of_its_run_and_shows_the_motion() {
    let model = scratch("animate_gif", "m.adm", PENDULUM);
    let film = model.with_extension("gif");
    let run = ["animate", path(&model), "--end", "2", "--steps", "100"];
    let done = cognate(&[&run[..], &["-o", path(&film), "--width", "300"]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let bytes = std::fs::read(&film).unwrap();
    assert!(bytes.len() < 400_000, "{}", bytes.len());
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::Indexed);
    let mut decoder = options.read_info(&bytes[..]).unwrap();
    assert_eq!(decoder.width(), 300);
    assert!(matches!(decoder.repeat(), gif::Repeat::Infinite));
    let size = usize::from(decoder.width()) * usize::from(decoder.height());
    let (mut hundredths, mut changed, mut n) = (0, 0, 0);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        let stays = frame.transparent.unwrap();
        let own = frame.buffer.iter().filter(|c| **c != stays).count();
        // the first is whole, later ones are what has changed
        assert!(
            if n == 0 { own == size } else { own < size / 2 },
            "{n}: {own}"
        );
        changed += usize::from(n > 0 && own > 50);
        hundredths += usize::from(frame.delay);
        n += 1;
    }
    assert!((hundredths as f64 - 200.0).abs() < 10.0, "{hundredths}");
    assert!(n > 30 && changed > n / 2, "{changed} of {n}");
    // what is for films says so where there is none
    let page = model.with_extension("html");
    let done = cognate(&[&run[..], &["-o", path(&page), "--width", "300"]].concat());
    assert!(done.code == 2 && done.err.contains(".gif"), "{}", done.err);
    let other = model.with_extension("avi");
    let done = cognate(&[&run[..], &["-o", path(&other)]].concat());
    assert!(
        done.code == 2 && done.err.contains(".html, .gif and .glb"),
        "{}",
        done.err
    );
}
