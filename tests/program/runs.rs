//! Runs that a folder keeps: their names, what belongs to them, and how two compare.

use super::command::{Done, cognate, cognate_with, ok, path, scratch};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A mass that falls, with a request.
const FALL: &str = "\
FALL
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
PART/1, GROUND
MARKER/1, PART=1
PART/2, MASS=1, CM=20, IP=1,1,1, QG=0,0,10
MARKER/20, PART=2
ACCGRAV/KGRAV=-10
REQUEST/1, F2=DZ(20,1)\\F3=VZ(20,1)
END
";

/// An empty folder of this test, with the model beside it.
fn folder(test: &str) -> (PathBuf, PathBuf) {
    let model = scratch(test, "fall.adm", FALL);
    let folder = model.with_file_name("out");
    let _ = std::fs::remove_dir_all(&folder);
    (model, folder)
}

fn ran(model: &Path, folder: &Path, more: &[&str]) {
    let args = ["run", path(model), "--end", "1", "--out", path(folder)];
    let done = cognate(&[&args, more].concat());
    assert_eq!(done.code, 0, "{}", done.err);
}

/// Names of the files in a folder, in order.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn json(done: &Done) -> Value {
    serde_json::from_str(&done.out).unwrap()
}

#[test]
fn runs_of_one_model_are_kept_under_their_names_and_listed() {
    let (model, out) = folder("runs_listed");
    ran(&model, &out, &["--steps", "4"]);
    ran(
        &model,
        &out,
        &["--steps", "8", "--name", "fine", "--error", "1e-9"],
    );
    let listed = json(&ok(&["runs", path(&out), "--json"]));
    let runs = listed["runs"].as_array().unwrap();
    let facts = |k: usize| {
        let run = &runs[k];
        (
            run["name"].as_str().unwrap(),
            run["status"].as_str().unwrap(),
            run["outputs"].as_u64().unwrap(),
        )
    };
    assert_eq!(
        (runs.len(), facts(0), facts(1)),
        (2, ("fall", "completed", 5), ("fine", "completed", 9))
    );
    assert_eq!(runs[1]["error"].as_f64(), Some(1e-9));
    assert_eq!(
        (runs[0]["span"][0].as_f64(), runs[0]["span"][1].as_f64()),
        (Some(0.0), Some(1.0))
    );
    // runs in the folders of a folder are listed, too
    let above = ok(&["runs", path(out.parent().unwrap())]);
    assert!(
        above.out.contains("fine") && above.out.contains(".csv .msg"),
        "{}",
        above.out
    );
}

#[test]
fn a_run_is_renamed_with_all_its_files_and_goes_on_claiming_them() {
    let (model, out) = folder("runs_renamed");
    ran(&model, &out, &["--format", "csv,res"]);
    let before = names(&out);
    ok(&["runs", "rename", path(&out.join("fall")), "drop"]);
    let renamed: Vec<String> = before.iter().map(|n| n.replace("fall", "drop")).collect();
    assert_eq!(names(&out), renamed);
    // the files are those of the run again: deleting it leaves nothing
    ok(&["runs", "delete", path(&out.join("drop.res")), "--yes"]);
    assert!(names(&out).is_empty(), "{:?}", names(&out));
}

#[test]
fn a_run_is_not_renamed_onto_files_that_are_there() {
    let (model, out) = folder("runs_not_renamed");
    ran(&model, &out, &[]);
    std::fs::write(out.join("drop.csv"), "mine").unwrap();
    let before = names(&out);
    let done = cognate(&["runs", "rename", path(&out.join("fall")), "drop"]);
    assert!(
        done.code == 3 && done.err.contains("drop.csv is there already"),
        "{}",
        done.err
    );
    assert_eq!(names(&out), before);
    for name in ["../drop", "", "..", "a/b"] {
        let done = cognate(&["runs", "rename", path(&out.join("fall")), name]);
        assert!(
            done.code == 3 && names(&out) == before,
            "{name}: {}",
            done.err
        );
    }
}

#[test]
fn deleting_asks_and_leaves_what_others_wrote_or_changed() {
    let (model, out) = folder("runs_deleted");
    ran(&model, &out, &["--format", "csv,res"]);
    std::fs::write(out.join("fall.res"), "changed since").unwrap();
    std::fs::write(out.join("fall.txt"), "notes of mine").unwrap();
    let run = out.join("fall");
    let before = names(&out);
    let asked = cognate_with(&["runs", "delete", path(&run)], "n\n");
    assert!(
        asked.code == 2 && asked.err.contains("fall.csv"),
        "{}",
        asked.err
    );
    assert_eq!(names(&out), before);
    let done = cognate_with(&["runs", "delete", path(&run)], "y\n");
    assert!(
        done.code == 0 && done.err.contains("fall.res is not as the run wrote it"),
        "{}",
        done.err
    );
    assert_eq!(names(&out), ["fall.res", "fall.txt"]);
}

#[test]
fn a_record_cannot_claim_files_outside_of_its_folder() {
    let victim = scratch("runs_outside", "victim.txt", "12345");
    let out = victim.with_file_name("out");
    std::fs::create_dir_all(&out).unwrap();
    let claims = format!(r#"{{"../victim.txt": 5, {:?}: 5}}"#, path(&victim));
    let record = format!(r#"{{"versions": {{"cognate": "0"}}, "files": {claims}}}"#);
    std::fs::write(out.join("evil.json"), record).unwrap();
    ok(&["runs", "delete", path(&out.join("evil")), "--yes"]);
    assert!(victim.is_file());
}

#[test]
fn a_name_that_is_nearly_that_of_a_run_is_answered_with_it() {
    let (model, out) = folder("runs_near");
    ran(&model, &out, &[]);
    let done = cognate(&["runs", "delete", path(&out.join("fal")), "--yes"]);
    assert!(
        done.code == 3 && done.err.contains("did you mean") && done.err.contains("fall"),
        "{}",
        done.err
    );
    // a name with a point is not another run without it
    let done = cognate(&["runs", "delete", path(&out.join("fall.2")), "--yes"]);
    assert!(
        done.code == 3 && out.join("fall.csv").is_file(),
        "{}",
        done.err
    );
}

#[test]
fn a_run_compares_with_itself_without_difference_in_all_formats() {
    let (model, out) = folder("runs_same");
    ran(&model, &out, &["--format", "csv,res,parquet,json"]);
    let run = out.join("fall");
    for ending in ["csv", "res", "parquet", "table.json"] {
        let file = run.with_extension(ending);
        let args = [
            "runs",
            "compare",
            path(&file),
            path(&file),
            "--json",
            "--tolerance",
            "0",
        ];
        let found = json(&ok(&args));
        let channels = found["channels"].as_array().unwrap();
        assert!(channels.len() >= 2, "{ending}: {found}");
        let largest = channels.iter().map(|c| c["largest"].as_f64().unwrap());
        assert_eq!(largest.fold(0.0, f64::max), 0.0, "{ending}");
    }
}

#[test]
fn a_change_of_gravity_is_found_with_its_size_and_time() {
    let (model, out) = folder("runs_compared");
    ran(&model, &out, &["--steps", "4"]);
    let other = model.with_file_name("moon.adm");
    std::fs::write(&other, FALL.replace("KGRAV=-10", "KGRAV=-2")).unwrap();
    ran(&other, &out, &["--steps", "8"]);
    let [fall, moon] = ["fall", "moon"].map(|n| out.join(n));
    // DZ = 10 - g t²/2 and VZ = -g t differ most at the end, by 4 and 8
    let args = ["runs", "compare", path(&fall), path(&moon), "--json"];
    let found = json(&ok(&args));
    assert_eq!(
        (found["outputs"].as_u64(), found["left_out"][1].as_u64()),
        (Some(5), Some(4))
    );
    for (channel, size) in [("F2", 4.0), ("F3", 8.0)] {
        let all = found["channels"].as_array().unwrap();
        let is_it = |c: &&Value| c["channel"].as_str().unwrap().contains(channel);
        let difference = all.iter().find(is_it).unwrap();
        let largest = difference["largest"].as_f64().unwrap();
        assert!((largest - size).abs() < 1e-6, "{channel}: {largest}");
        assert_eq!(difference["time"].as_f64(), Some(1.0));
    }
    let done = cognate(&[&args[..4], &["--tolerance", "0.1"]].concat());
    assert!(
        done.code == 8 && done.err.contains("4 outputs of"),
        "{}",
        done.err
    );
}

#[test]
fn bars_of_error_stand_beside_the_differences() {
    let (model, out) = folder("runs_bars");
    ran(&model, &out, &["--accuracy"]);
    ran(&model, &out, &["--accuracy", "--name", "again"]);
    let [a, b] = ["fall", "again"].map(|n| out.join(n));
    let found = json(&ok(&["runs", "compare", path(&a), path(&b), "--json"]));
    for channel in found["channels"].as_array().unwrap() {
        assert!(!channel["channel"].as_str().unwrap().ends_with('±'));
        assert!(
            channel["bars"].is_number() && channel["beyond_bars"] == 0,
            "{channel}"
        );
    }
}
