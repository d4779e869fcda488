//! `cognate check` says last whether a run begins: what it says is what `cognate run` does.

use super::command::{cognate, path, scratch};
use super::needs;
use cognate::dataset;
use cognate::model::ElementKind;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A pendulum, to which a single thing is added.
const PENDULUM: &str = "a pendulum
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
ACCGRAV/JGRAV=-9.80665
PART/1, GROUND
MARKER/10, PART=1
MARKER/11, PART=1, FLOATING
PART/2, MASS=1, CM=20, IP=1,1,1
MARKER/20, PART=2, QP=1,0,0
MARKER/21, PART=2
MARKER/22, PART=2, QP=0.5,0,0
JOINT/1, REVOLUTE, I=21, J=10
";

/// Things that a model may hold and that are solved, or not, or only in part: a name, and statements.
const ADDED: &[(&str, &str)] = &[
    ("nothing", ""),
    (
        "a force by a routine",
        "SFORCE/1, I=20, J=10, TRANSLATION, FUNCTION=USER(1)",
    ),
    (
        "a motion by a routine",
        "MOTION/1, JOINT=1, ROTATION, FUNCTION=USER(1)",
    ),
    ("a variable by a routine", "VARIABLE/1, FUNCTION=USER(1)"),
    ("a state by a routine", "DIFF/1, IC=0, FUNCTION=USER(1)"),
    (
        "a constraint by a routine",
        "GCON/1, I=20, FUNCTION=USER(1)",
    ),
    (
        "a sensor by a routine",
        "SENSOR/1, FUNCTION=USER(1), VALUE=1, ERROR=0.1, GE, HALT",
    ),
    ("a request by a routine", "REQUEST/1, FUNCTION=USER(1)"),
    (
        "a contact of CAD solids",
        "GRAPHICS/1, EXTERNAL, RM=10, FILE=a.xmt_txt, ELEMENT=A\n\
         GRAPHICS/2, EXTERNAL, RM=20, FILE=a.xmt_txt, ELEMENT=B\n\
         CONTACT/1, IGEOM=2, JGEOM=1, IMPACT, STIFFNESS=1E5, DAMPING=10, EXPONENT=2.2, DMAX=0.1",
    ),
    (
        "a contact of shapes",
        "GRAPHICS/1, ELLIPSOID, CM=22, XSCALE=0.1, YSCALE=0.1, ZSCALE=0.1\n\
         GRAPHICS/2, ELLIPSOID, CM=10, XSCALE=0.1, YSCALE=0.1, ZSCALE=0.1\n\
         CONTACT/1, IGEOM=1, JGEOM=2, IMPACT, STIFFNESS=1E5, DAMPING=10, EXPONENT=2.2, DMAX=0.1",
    ),
    (
        "a contact by a routine",
        "GRAPHICS/1, ELLIPSOID, CM=22, XSCALE=0.1, YSCALE=0.1, ZSCALE=0.1\n\
         GRAPHICS/2, ELLIPSOID, CM=10, XSCALE=0.1, YSCALE=0.1, ZSCALE=0.1\n\
         CONTACT/1, IGEOM=1, JGEOM=2, FUNCTION=USER(1)",
    ),
    (
        "a point on a curve whose points stand elsewhere",
        "MATRIX/1, FILE=points.dat\nCURVE/1, MATRIX=1\nPTCV/1, I=20, CURVE=1, RM=10",
    ),
    (
        "a curve by a routine",
        "CURVE/1, FUNCTION=USER(1), MINPAR=0, MAXPAR=1\nPTCV/1, I=20, CURVE=1, RM=10",
    ),
    (
        "a request of an unknown system of angles",
        "REQUEST/1, F2=ORIENT(99,1,20,10)\\",
    ),
    (
        "a force of an unknown system of angles",
        "SFORCE/1, I=20, J=10, TRANSLATION, FUNCTION=ORIENT(99,1,20,10)",
    ),
    (
        "a force without a value",
        "SFORCE/1, I=20, J=10, TRANSLATION, FUNCTION=SQRT(-1-TIME)",
    ),
    ("a joint of no marker", "JOINT/2, REVOLUTE, I=99, J=10"),
    (
        "a joint that cannot close",
        "MARKER/30, PART=1, QP=5,5,0\nJOINT/2, SPHERICAL, I=20, J=30",
    ),
    (
        "a part without mass",
        "PART/3\nMARKER/31, PART=3\nJOINT/3, REVOLUTE, I=31, J=20",
    ),
];

/// Whether a run of a dataset makes its first step, and what it says.
fn run_begins(model: &Path, out: &Path) -> (bool, String) {
    let _ = std::fs::remove_dir_all(out);
    let span = ["--end", "1e-6", "--steps", "1", "--limit", "1min", "--json"];
    let run = [&["run", path(model), "--out", path(out)][..], &span].concat();
    let done = cognate(&run);
    let record: Value = serde_json::from_str(&done.out).unwrap_or_default();
    let begins = match done.code {
        0 | 7 => true,
        6 => record["steps"].as_u64().unwrap_or(0) > 0,
        _ => false,
    };
    (begins, format!("exit {}\n{}", done.code, done.err))
}

/// Complains where the last line of `check` is not what a run does.
fn complaint(name: &str, model: &Path, out: &Path) -> Option<String> {
    let check = cognate(&["check", path(model)]);
    let last = check.err.lines().last().unwrap_or_default().to_owned();
    let (begins, said) = run_begins(model, out);
    let is_right = match begins {
        true => last == "run will begin",
        false => last.starts_with("run will stop before its first step: "),
    };
    let is_clean = check.err.contains("nothing wrong");
    if is_right && (begins || !is_clean) {
        return None;
    }
    Some(format!("{name}: check says `{last}`, run says {said}"))
}

#[test]
fn the_last_line_of_check_is_what_a_run_does_whatever_single_thing_is_not_solved() {
    let kept = ElementKind::ALL.iter().filter(|kind| kind.is_unsolved());
    let kept: Vec<(String, String)> = kept.map(|k| (k.to_string(), format!("{k}/1"))).collect();
    assert!(kept.len() > 5);
    let added = ADDED
        .iter()
        .map(|(name, text)| (name.to_string(), text.to_string()));
    let mut wrong = Vec::new();
    let mut n_stop = 0;
    for (name, text) in added.chain(kept) {
        let file = format!("{}.adm", name.replace(' ', "_").to_lowercase());
        let model = scratch("foreseen", &file, &format!("{PENDULUM}{text}\nEND\n"));
        let check = cognate(&["check", path(&model)]);
        n_stop += usize::from(check.err.contains("run will stop"));
        wrong.extend(complaint(&name, &model, &model.with_extension("out")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(n_stop > 10, "{n_stop}");
}

#[test]
fn what_hides_behind_an_element_that_is_not_solved_is_found() {
    let hidden = "MARKER/30, PART=1, QP=5,5,0\nJOINT/2, SPHERICAL, I=20, J=30";
    for (name, text) in ADDED.iter().filter(|(name, _)| {
        let is_seen_without = ["routine", "CAD", "elsewhere"];
        is_seen_without.iter().any(|word| name.contains(word))
    }) {
        let text = format!("{PENDULUM}{text}\n{hidden}\nEND\n");
        let model = scratch("foreseen_hidden", "m.adm", &text);
        let check = cognate(&["check", path(&model)]);
        assert!(check.err.contains("JOINT/2"), "{name}: {}", check.err);
        assert_eq!(check.code, 4, "{name}: {}", check.err);
        let json = cognate(&["check", path(&model), "--json"]);
        let json: Value = serde_json::from_str(&json.out).expect("JSON");
        assert_eq!(json["runs"][0]["begins"], false, "{name}: {json}");
    }
}

#[test]
fn the_last_line_of_check_is_what_a_run_does_with_datasets_of_many_people() {
    let Some(root) = needs::corpus() else { return };
    let (mut folders, mut files) = (vec![root], Vec::<PathBuf>::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder").flatten() {
            let entry = entry.path();
            if entry.is_dir() {
                folders.push(entry);
            } else if entry
                .extension()
                .is_some_and(|e| e.eq_ignore_ascii_case("adm"))
            {
                files.push(entry);
            }
        }
    }
    files.sort();
    let out = scratch("foreseen_corpus", "out.txt", "").with_extension("out");
    // large ones take their time twice
    let is_small = |file: &&PathBuf| {
        let reading = dataset::read(file);
        reading.is_ok_and(|r| r.model.parts.len() < 60)
    };
    let small: Vec<&PathBuf> = files.iter().filter(is_small).collect();
    let wrong = small.iter().filter_map(|f| complaint(path(f), f, &out));
    let wrong: Vec<String> = wrong.collect();
    println!("{} of {} datasets", small.len(), files.len());
    assert!(small.len() > 30, "{} of {}", small.len(), files.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
