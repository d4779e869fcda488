//! `cognate report`, and `--limit` of `cognate run`.

use crate::command::{cognate, path, scratch};
use serde_json::Value;
use std::path::PathBuf;

const PENDULUM: &str = "a pendulum\nPART/1, GROUND\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/1, PART=1\n\
    MARKER/2, PART=2, QP=1,0,0\nMARKER/3, PART=2\nJOINT/1, REVOLUTE, I=3, J=1\nACCGRAV/JGRAV=-9.81\nEND\n";

/// The pendulum in a folder of its own, which is empty otherwise.
fn pendulum(test: &str) -> (PathBuf, PathBuf) {
    let adm = scratch(test, "pendulum.adm", PENDULUM);
    let out = adm.with_file_name("out");
    let _ = std::fs::remove_dir_all(&out);
    (adm, out)
}

#[test]
fn a_report_recommends_a_run_and_writes_its_files() {
    let (adm, out) = pendulum("report");
    let args = [
        "report",
        path(&adm),
        "--end",
        "1",
        "--steps",
        "10",
        "--method",
        "DOP853",
        "--method",
        "RADAU5",
        "--error",
        "1e-3",
        "--error",
        "1e-6",
        "--error",
        "1e-9",
        "--want",
        "1e-4",
        "--out",
        path(&out),
    ];
    let done = cognate(&args);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(
        done.out.contains("for an error of 1e-4: --method"),
        "{}",
        done.out
    );
    let read = |ending: &str| {
        let file = out.join(format!("pendulum_report.{ending}"));
        std::fs::read_to_string(file).expect("a file of the report")
    };
    let json: Value = serde_json::from_str(&read("json")).expect("JSON");
    assert_eq!(json["runs"].as_array().map(Vec::len), Some(6));
    assert_eq!(read("csv").lines().count(), 7);
    assert!(read("html").contains("<svg"));
    // what it recommends holds what it says
    let method = json["recommended"][0]["run"]["method"]
        .as_str()
        .expect("a method");
    assert!(["DOP853", "RADAU5"].contains(&method));
    // what was the user's stays
    std::fs::write(out.join("pendulum_report.html"), "mine").expect("a file");
    assert_eq!(cognate(&args).code, 2);
    assert_eq!(
        std::fs::read_to_string(out.join("pendulum_report.html")).expect("mine"),
        "mine"
    );
    let overwriting = [&args[..], &["--overwrite"]].concat();
    assert_eq!(cognate(&overwriting).code, 0);
    let kept = std::fs::read_to_string(out.join("pendulum_report.html~")).expect("kept");
    assert_eq!(kept, "mine");
}

#[test]
fn a_report_of_a_model_that_cannot_run_is_refused_with_its_place() {
    let adm = scratch(
        "report",
        "wrong.adm",
        &PENDULUM.replace("I=3, J=1", "I=33, J=1"),
    );
    let done = cognate(&["report", path(&adm), "--end", "1"]);
    assert!(done.code == 3 || done.code == 4, "{}", done.err);
    assert!(done.err.contains("33"), "{}", done.err);
    let bare = cognate(&["report", path(&adm)]);
    assert_ne!(bare.code, 0);
}

#[test]
fn a_run_ends_at_its_limit_with_exit_7_and_its_rows() {
    let (adm, out) = pendulum("limit");
    let done = cognate(&[
        "run",
        path(&adm),
        "--end",
        "1e7",
        "--steps",
        "1000000",
        "--limit",
        "500ms",
        "--out",
        path(&out),
        "--json",
        "--column",
        "DX(2,1)",
    ]);
    assert_eq!(done.code, 7, "{}", done.err);
    let record: Value = serde_json::from_str(&done.out).expect("a record");
    assert_eq!(
        (&record["status"], &record["stop_code"]),
        (&"limit".into(), &"work_limit".into())
    );
    let table = std::fs::read_to_string(out.join("pendulum.csv")).expect("a table");
    assert!(table.lines().count() > 3);
    let wrong = cognate(&["run", path(&adm), "--end", "1", "--limit", "soon"]);
    assert_eq!(wrong.code, 2, "{}", wrong.err);
}

#[test]
fn a_limit_ends_a_run_that_does_not_look() {
    // a chain is long in setting up
    let mut text = String::from("a chain\nPART/1, GROUND\nMARKER/1, PART=1\nACCGRAV/JGRAV=-9.81\n");
    for k in 2..400 {
        let before = if k == 2 { 1 } else { 10 * (k - 1) + 1 };
        text += &format!(
            "PART/{k}, MASS=1, CM={k}2, IP=1,1,1\nMARKER/{k}0, PART={k}\nMARKER/{k}1, PART={k}, QP=1,0,0\n\
             MARKER/{k}2, PART={k}, QP=0.5,0,0\nJOINT/{k}, SPHERICAL, I={k}0, J={before}\n"
        );
    }
    text += "END\n";
    let adm = scratch("limit_of_chain", "chain.adm", &text);
    let out = adm.with_file_name("out");
    let done = cognate(&[
        "run",
        path(&adm),
        "--end",
        "1",
        "--limit",
        "10ms",
        "--out",
        path(&out),
        "--quiet",
    ]);
    assert_eq!(done.code, 7, "{}", done.err);
    assert!(out.join("chain.json").exists());
}
