//! Groups of functions: what is in them, groups of groups, and plots of a group at once.

use super::command::{cognate, ok, path, scratch};
use serde_json::Value;
use std::path::PathBuf;

const FALL: &str = "\
FALL
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
PART/1, GROUND
MARKER/1, PART=1
PART/2, MASS=1, CM=20, IP=1,1,1, QG=0,0,10
MARKER/20, PART=2
ACCGRAV/KGRAV=-10
REQUEST/1, F2=DZ(20,1)\\F3=VZ(20,1), CNAMES=\"\",\"Z\",\"VZ\",\"\",\"\",\"\",\"\",\"\", RESULTS_NAME=fall
END
";

fn model(test: &str) -> PathBuf {
    let model = scratch(test, "fall.adm", FALL);
    let _ = std::fs::remove_file(model.with_extension("toml"));
    model
}

fn listed(model: &str) -> Value {
    serde_json::from_str(&ok(&["group", model, "--json"]).out).unwrap()
}

/// Functions of a group in a list.
fn functions(listed: &Value, group: &str) -> Vec<String> {
    let groups = listed["groups"].as_array().unwrap();
    let found = groups.iter().find(|g| g["group"] == group).unwrap();
    let all = found["functions"].as_array().unwrap().iter();
    all.map(|f| f.as_str().unwrap().to_owned()).collect()
}

/// Names of the columns that a plot shows.
fn shown(args: &[&str]) -> Vec<String> {
    let out = ok(&[&["plot"], args, &["--statistics", "--json"]].concat()).out;
    let told: Value = serde_json::from_str(&out).unwrap();
    let all = told.as_array().unwrap().iter();
    all.map(|c| c["name"].as_str().unwrap().to_owned())
        .collect()
}

#[test]
fn every_function_is_in_a_group_and_groups_hold_groups() {
    let model = model("groups_held");
    let m = path(&model);
    ok(&["group", "function", m, "a", "--expression", "sin(t)"]);
    ok(&[
        "group",
        "function",
        m,
        "b",
        "--direct",
        "SIN(TIME)",
        "--in",
        "Drives",
    ]);
    assert_eq!(functions(&listed(m), "USER_DEFINED"), ["a"]);
    assert_eq!(functions(&listed(m), "Drives"), ["b"]);
    ok(&["group", "create", m, "Drives", "b", "fall.Z"]);
    ok(&[
        "group",
        "create",
        m,
        "All",
        "--groups",
        "Drives",
        "USER_DEFINED",
    ]);
    assert_eq!(functions(&listed(m), "All"), ["b", "fall.Z", "a"]);
    // a group that holds itself, one that is not there, results in USER_DEFINED: nothing is written
    let toml = std::fs::read_to_string(model.with_extension("toml")).unwrap();
    for (args, answer) in [
        (
            &["group", "create", m, "Drives", "--groups", "All"][..],
            "holds itself",
        ),
        (
            &["group", "create", m, "More", "--groups", "Drivess"][..],
            "did you mean Drives",
        ),
        (
            &["group", "create", m, "USER_DEFINED", "fall.Z"][..],
            "no results of a run",
        ),
    ] {
        let done = cognate(args);
        assert!(
            done.code != 0 && done.err.contains(answer),
            "{args:?}: {}",
            done.err
        );
    }
    assert_eq!(
        std::fs::read_to_string(model.with_extension("toml")).unwrap(),
        toml
    );
    // what is used is not removed; a function leaves its groups when it is deleted
    assert_eq!(cognate(&["group", "remove", m, "Drives"]).code, 2);
    ok(&["group", "delete", m, "b"]);
    assert_eq!(functions(&listed(m), "Drives"), ["fall.Z"]);
    ok(&["group", "remove", m, "All"]);
    ok(&["group", "remove", m, "Drives"]);
}

#[test]
fn a_group_is_plotted_at_once_results_and_functions_together() {
    let model = model("groups_plotted");
    let m = path(&model);
    ok(&[
        "group",
        "function",
        m,
        "a",
        "--expression",
        "90*t",
        "--ordinate",
        "angle",
    ]);
    ok(&["group", "create", m, "Both", "fall.Z", "a"]);
    let out = model.with_file_name("out");
    ok(&["run", m, "--end", "1", "--steps", "4", "--out", path(&out)]);
    let run = out.join("fall.csv");
    let named = ["--model", m];
    assert_eq!(
        shown(&[&[path(&run), "--group", "Both"], &named[..]].concat()),
        ["fall.Z", "a"]
    );
    // the run is a group, by its name
    assert_eq!(
        shown(&[&[path(&run), "--group", "fall"], &named[..]].concat()),
        ["fall.Z", "fall.VZ"]
    );
    let done = cognate(&["plot", path(&run), "--group", "Bothh", "--model", m]);
    assert!(
        done.code == 3 && done.err.contains("did you mean Both"),
        "{}",
        done.err
    );
    // functions without a run
    assert_eq!(shown(&[m, "--end", "2"]), ["a"]);
    let told = ok(&["plot", m, "--end", "2", "--statistics", "--json"]).out;
    let told: Value = serde_json::from_str(&told).unwrap();
    assert_eq!(
        (
            told[0]["unit"].as_str(),
            told[0]["largest"]["value"].as_f64()
        ),
        (Some("deg"), Some(180.0))
    );
}

#[test]
fn a_function_that_reads_more_than_time_is_no_curve_without_a_run() {
    let model = model("groups_reads");
    let m = path(&model);
    ok(&["group", "function", m, "gap", "--direct", "DZ(20,1)"]);
    let done = cognate(&["plot", m]);
    assert!(
        done.code == 3 && done.err.contains("reads more than time"),
        "{}",
        done.err
    );
    // one that cannot be read is not kept
    let done = cognate(&["group", "function", m, "wrong", "--expression", "sin(t"]);
    assert_eq!(done.code, 3, "{}", done.err);
    assert!(
        !std::fs::read_to_string(model.with_extension("toml"))
            .unwrap()
            .contains("wrong")
    );
}
