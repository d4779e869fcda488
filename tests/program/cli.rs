//! The binary as its users meet it: what is printed where, and how it ends.

use crate::command;
use crate::repository::root;

use command::{cognate, cognate_with, path, scratch};
use std::path::{Path, PathBuf};

#[test]
fn a_value_is_printed_alone_with_its_shortest_digits() {
    for (args, value) in [
        (&["STEP(TIME,1,0,2,1)", "--time", "1.5"][..], "0.5\n"),
        (&["-(2**2)"][..], "-4\n"),
        (&["0.1+0.2"][..], "0.30000000000000004\n"),
        (&["TIME**3", "--time", "2", "--derivative", "1"][..], "12\n"),
        (
            &["TIME**3", "--time", "-2", "--derivative", "2"][..],
            "-12\n",
        ),
        (&["alog(3)", "--dialect", "expression"][..], "1000\n"),
        (&["2*VARVAL(3)", "--set", "VARVAL(3)=2.5"][..], "5\n"),
    ] {
        let done = cognate(&[&["eval"], args].concat());
        assert_eq!(
            (done.code, done.out.as_str(), done.err.as_str()),
            (0, value, ""),
            "{args:?}"
        );
    }
}

#[test]
fn a_range_of_times_gives_a_table() {
    let done = cognate(&["eval", "TIME**2", "--time", "0:1:0.5", "--derivative", "1"]);
    assert_eq!(
        done.out,
        "time,TIME**2,d/dt TIME**2\n0,0,0\n0.5,0.25,1\n1,1,2\n"
    );
    let json = cognate(&["eval", "MAX(TIME,1)", "--time", "0:2:1", "--json"]).out;
    let table: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(table["columns"][1]["name"], "MAX(TIME,1)");
    assert_eq!(
        table["columns"][1]["values"],
        serde_json::json!([1.0, 1.0, 2.0])
    );
}

#[test]
fn markers_and_splines_come_from_files() {
    let markers = scratch(
        "markers",
        "m.json",
        r#"{"1": {"r": [3, 4, 12], "v": [1, 0, 0]}, "2": {"e313": [0.5, 0, 0]}}"#,
    );
    let splines = scratch(
        "markers",
        "s.json",
        r#"{"1": {"x": [1, 2, 3, 4], "y": [0, 2, 1, 3]}}"#,
    );
    let value = |expression: &str| {
        cognate(&[
            "eval",
            expression,
            "--markers",
            path(&markers),
            "--splines",
            path(&splines),
        ])
        .out
    };
    assert_eq!(value("DM(1,2)+AKISPL(1.5,0,1)"), "14.375\n");
    assert_eq!(value("PSI(2)"), "0.5\n");
    let broken = scratch("markers", "b.json", "{\"1\": {\"r\": [1, 2]}}");
    let done = cognate(&["eval", "DM(1)", "--markers", path(&broken)]);
    assert_eq!(done.code, 3);
    assert!(
        done.err.contains("\"1\": \"r\" should be three numbers"),
        "{}",
        done.err
    );
}

#[test]
fn a_plot_is_written_as_svg_and_named() {
    let file = scratch("plot", "p.svg", "");
    let done = cognate(&[
        "eval",
        "SIN(TIME)",
        "--time",
        "0:6:0.1",
        "--derivative",
        "1",
        "--plot",
        path(&file),
    ]);
    assert_eq!((done.code, done.out.as_str()), (0, ""));
    let svg = std::fs::read_to_string(&file).unwrap();
    assert!(
        svg.starts_with("<svg")
            && svg.contains("d/dt SIN(TIME)")
            && svg.trim_end().ends_with("</svg>")
    );
    assert_eq!(cognate(&["eval", "1", "--plot", path(&file)]).code, 2);
}

#[test]
fn mistakes_end_with_their_code_and_a_caret_below_the_place() {
    let done = cognate(&["eval", "2*LOG(TIME-1)", "--time", "0.5"]);
    assert_eq!((done.code, done.out.as_str()), (3, ""));
    let lines: Vec<&str> = done.err.lines().collect();
    assert!(
        lines[0].starts_with("error[domain]: LOG of -0.5 has no value at TIME = 0.5"),
        "{}",
        done.err
    );
    let text = lines.iter().position(|l| l.contains("2*LOG")).unwrap();
    assert_eq!(lines[text].find("LOG"), lines[text + 1].find("^^^"));
    assert_eq!(cognate(&["eval", "STEP(1,2"]).code, 3);
    assert_eq!(cognate(&["eval", "TIME", "--time", "a"]).code, 2);
    assert_eq!(cognate(&["eval", "TIME", "--time", "0:1:-1"]).code, 2);
    assert_eq!(cognate(&["frobnicate"]).code, 2);
    assert_eq!(cognate(&["convert", "no.res", "such.csv"]).code, 3);
}

#[test]
fn mistakes_are_told_to_programs_too() {
    let done = cognate(&["eval", "1+", "--json"]);
    assert_eq!(done.code, 3);
    let said: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    assert_eq!(
        (&said["errors"][0]["code"], &said["errors"][0]["column"]),
        (&"unexpected_end".into(), &3.into())
    );
}

#[test]
fn a_piped_session_remembers_goes_on_after_mistakes_and_tells_of_them() {
    let session = "\
! a comment
:time 0.25
STEP5(TIME, 0, 0, 1, 10) *
  SIN(2*PI*TIME)
:let w = 2*PI
:derivative 1
SIN(w*TIME)
:derivative 0
:marker 7 3 4 12
2^3
DM(7)
";
    let done = cognate_with(&["repl"], session);
    assert_eq!(
        done.out,
        "1.03515625\nvalue   1\nd/dt    3.8473413874435795e-16\n13\n"
    );
    assert_eq!(done.code, 3, "one line was wrong");
    assert!(done.err.starts_with("error[bad_char]"), "{}", done.err);
    let fine = cognate_with(
        &["repl", "--dialect", "expression"],
        "alog(3)\n:quit\n2^3\n",
    );
    assert_eq!(
        (fine.code, fine.out.as_str(), fine.err.as_str()),
        (0, "1000\n", "")
    );
    assert_eq!(
        cognate_with(&["repl"], "1 +").code,
        3,
        "the end of the input ends a statement"
    );
}

#[test]
fn every_name_of_the_language_can_be_looked_up() {
    let list = cognate(&["functions", "--json"]).out;
    let list: serde_json::Value = serde_json::from_str(&list).unwrap();
    let names: Vec<&str> = list
        .as_array()
        .unwrap()
        .iter()
        .map(|c| c["name"].as_str().unwrap())
        .collect();
    // one of each family of the reference
    for name in "TIME IF ABS STEP5 BISTOP AKISPL CURVE DM AZ PITCH INCANG VR WZ ACCM WDTX FX TM JOINT SPDP VARVAL DIF1 SENVAL ent".split(' ') {
        assert!(names.contains(&name), "{name}");
        assert!(cognate(&["functions", name]).out.to_uppercase().contains(&name.to_uppercase()));
    }
    let unknown = cognate(&["functions", "STPE5"]);
    assert_eq!(unknown.code, 3);
    assert!(
        unknown.err.contains("did you mean STEP5?"),
        "{}",
        unknown.err
    );
}

#[test]
fn results_are_converted_and_plotted_and_inputs_are_kept() {
    let table = scratch(
        "convert",
        "run.csv",
        "time,\"DX(1,2)\"\nsec,mm\n0,1\n0.5,2\n1,4\n",
    );
    let res = table.with_extension("res");
    assert_eq!(cognate(&["convert", path(&table), path(&res)]).code, 0);
    let back = table.with_file_name("back.csv");
    assert_eq!(cognate(&["convert", path(&res), path(&back)]).code, 0);
    assert_eq!(
        std::fs::read_to_string(&back).unwrap(),
        std::fs::read_to_string(&table).unwrap()
    );
    let plot = cognate(&["plot", path(&table), "--y", "dx(1,2)"]);
    assert!(
        plot.out.contains("DX(1,2) [mm]") && plot.out.contains("time [sec]"),
        "{}",
        plot.out
    );
    let missing = cognate(&["plot", path(&table), "--y", "DX(1,3)"]);
    assert!(
        missing.code == 3 && missing.err.contains("did you mean DX(1,2)?"),
        "{}",
        missing.err
    );
    assert_eq!(cognate(&["convert", path(&table), path(&table)]).code, 2);
}

#[test]
fn every_command_has_help_with_an_example() {
    let help = cognate(&["--help"]);
    assert_eq!(help.code, 0);
    let commands = help
        .out
        .split("Commands:")
        .nth(1)
        .unwrap()
        .split("Options:")
        .next()
        .unwrap();
    let verbs: Vec<&str> = commands
        .lines()
        // what stands further in goes on with a line
        .filter(|l| !l.starts_with("   "))
        .filter_map(|l| l.split_whitespace().next())
        // which prints the help of the others
        .filter(|verb| *verb != "help")
        .collect();
    assert!(verbs.len() >= 5, "{verbs:?}");
    for verb in verbs {
        let help = cognate(&[verb, "--help"]);
        assert!(
            help.code == 0 && help.out.contains(&format!("cognate {verb}")),
            "{verb}: {}",
            help.out
        );
        assert!(help.out.contains("Example"), "{verb} shows no example");
    }
}

#[test]
fn every_code_that_is_printed_can_be_explained() {
    for line in cognate(&["explain"]).out.lines() {
        let code = line.split_whitespace().next().unwrap();
        let explained = cognate(&["explain", code]);
        assert!(
            explained.code == 0 && explained.out.starts_with(&format!("{code}: ")),
            "{code}"
        );
    }
    let wrong = cognate(&["eval", "2^3"]).err;
    let code = wrong.split(['[', ']']).nth(1).unwrap();
    assert!(cognate(&["explain", code]).out.contains("2**3"), "{wrong}");
    assert!(
        cognate(&["explain", "STEP"])
            .out
            .starts_with("STEP(x, x0, h0, x1, h1)")
    );
    let unknown = cognate(&["explain", "bad_chr"]);
    assert!(
        unknown.code == 3 && unknown.err.contains("did you mean bad_char?"),
        "{}",
        unknown.err
    );
}

#[test]
fn the_example_runs_from_its_files_to_table_record_log_and_picture() {
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("run");
    let example = "examples/slider_crank.acf";
    let done = cognate(&[
        "run",
        example,
        "--out",
        path(&dir),
        "--column",
        "DX(41, 22) + 1",
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(
        done.out.lines().count() <= 14 && done.out.contains("slider.X"),
        "{}",
        done.out
    );
    let read = |ending: &str| {
        let file = dir.join(format!("slider_crank.{ending}"));
        assert!(
            done.err.contains(path(&file)),
            "{} is named",
            file.display()
        );
        std::fs::read_to_string(file).unwrap()
    };
    let table = read("csv");
    assert!(
        table.starts_with("time,DX(41, 22) + 1,slider.X")
            || table.starts_with("time,\"DX(41, 22) + 1\",slider.X"),
        "{}",
        &table[..60]
    );
    let run = cognate::results::csv::read(table.as_bytes()).unwrap();
    assert_eq!((run.rows(), run.column("time").unwrap()[400]), (401, 2.0));
    // at rest in line, the slider is as far from the crank pin as the rod is long
    assert!((run.column("DX(41,22)+1").unwrap()[0] - 151.0).abs() < 1e-9);
    // the motor that has been taken away exerts nothing
    let torque = run.column("crank.TORQUE").unwrap();
    assert!(torque[100].abs() > 1.0 && torque[400] == 0.0, "{torque:?}");
    assert!(!done.err.contains("warning"), "{}", done.err);
    let unit = |name: &str| run.columns[run.find(name).unwrap()].unit.as_str();
    assert_eq!(
        [unit("slider.ACCX"), unit("slider.FX"), unit("crank.TORQUE")],
        ["mm/sec**2", "newton", "newton-mm"]
    );
    let record: serde_json::Value = serde_json::from_str(&read("json")).unwrap();
    assert_eq!(
        (
            &record["status"],
            &record["simulations"][0]["kind"],
            &record["simulations"][1]["kind"]
        ),
        (&"completed".into(), &"kinematic".into(), &"dynamic".into())
    );
    assert!(read("svg").contains("slider.X [mm]"));
    let log = read("msg");
    assert!(
        log.contains(" command: simulate/kinematic")
            && log.contains("\nFinished -----\nElapsed time = "),
        "{log}"
    );
    let res = cognate::results::read(&dir.join("slider_crank.res")).unwrap();
    assert!(res.entities.iter().any(|e| e.kind == "Part") && res.column("slider.X").is_some());
    let quiet = cognate(&["run", example, "--out", path(&dir), "--quiet"]);
    assert_eq!(
        (quiet.code, quiet.out.as_str(), quiet.err.as_str()),
        (0, "", "")
    );
}

#[test]
fn results_of_others_stay_and_those_of_an_earlier_run_are_kept_once() {
    let example = "examples/slider_crank.acf";
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("keeps");
    let _ = std::fs::remove_dir_all(&dir);
    std::fs::create_dir_all(&dir).unwrap();
    std::fs::write(dir.join("slider_crank.res"), "somebody's").unwrap();
    let run = |more: &[&str]| cognate(&[&["run", example, "--out", path(&dir)], more].concat());
    // nothing is solved where it could not be written
    let refused = run(&[]);
    assert_eq!(refused.code, 2, "{}", refused.err);
    assert!(refused.err.contains("file_exists") && refused.err.contains("slider_crank.res"));
    assert_eq!(contents(&dir).len(), 1);
    let first = run(&["--overwrite"]);
    assert!(first.err.contains("kept as") && first.err.contains("slider_crank.res~"));
    let kept = std::fs::read_to_string(dir.join("slider_crank.res~")).unwrap();
    assert_eq!(kept, "somebody's");
    let names = || {
        let files = std::fs::read_dir(&dir).unwrap();
        let mut names: Vec<_> = files.map(|f| f.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let before = names();
    assert_eq!(before.len(), 8);
    for _ in 0..2 {
        let again = run(&[]);
        assert!(
            again.code == 0 && !again.err.contains("kept as"),
            "{}",
            again.err
        );
        // somebody's file has the name with one ~ already
        let kept = before
            .iter()
            .filter(|name| !name.to_string_lossy().contains('~'));
        let all: Vec<_> = names()
            .into_iter()
            .filter(|name| !before.contains(name))
            .collect();
        assert_eq!(all.len(), kept.count(), "{all:?}");
    }
    let kept = std::fs::read_to_string(dir.join("slider_crank.res~")).unwrap();
    assert_eq!(kept, "somebody's");
    // what somebody has changed is somebody's
    let csv = dir.join("slider_crank.csv");
    let mut text = std::fs::read_to_string(&csv).unwrap();
    text += "a note\n";
    std::fs::write(&csv, &text).unwrap();
    let refused = run(&[]);
    assert!(
        refused.code == 2 && refused.err.contains("slider_crank.csv"),
        "{}",
        refused.err
    );
    assert_eq!(std::fs::read_to_string(&csv).unwrap(), text);
}

/// Names and contents of the files of a folder.
fn contents(dir: &Path) -> Vec<(std::ffi::OsString, Vec<u8>)> {
    let files = std::fs::read_dir(dir).unwrap().map(|f| f.unwrap());
    let mut all: Vec<_> = files
        .map(|f| (f.file_name(), std::fs::read(f.path()).unwrap()))
        .collect();
    all.sort();
    all
}

#[test]
fn a_mistake_on_the_command_line_costs_no_results() {
    let example = "examples/slider_crank.acf";
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("refused");
    let _ = std::fs::remove_dir_all(&dir);
    let run = |more: &[&str]| {
        let mut all = vec!["run", example, "--out", path(&dir)];
        all.extend(more);
        cognate(&all)
    };
    assert_eq!(run(&[]).code, 0);
    let before = contents(&dir);
    assert!(before.len() == 7, "{}", before.len());
    for (more, code, said) in [
        (["--column", "DX(41,2x2)"], 3, "--column:1:7"),
        (["--column", "DX(41,99)"], 3, "MARKER/99 does not exist"),
        (["--method", "RADAU7"], 2, "RADAU5"),
        (["--error", "0"], 4, "--error: the permitted error"),
    ] {
        let done = run(&more);
        assert_eq!(done.code, code, "{more:?}: {}", done.err);
        assert!(done.err.contains(said), "{more:?}: {}", done.err);
        assert!(contents(&dir) == before, "{more:?} touched the results");
    }
}

#[test]
fn a_run_leaves_no_picture_of_an_earlier_one_and_knows_its_own_files() {
    let example = "examples/slider_crank.acf";
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("stale");
    let _ = std::fs::remove_dir_all(&dir);
    let run = |more: &[&str]| {
        let mut all = vec!["run", example, "--out", path(&dir)];
        all.extend(more);
        let done = cognate(&all);
        assert_eq!(done.code, 0, "{}", done.err);
        assert!(!done.err.contains("kept as"), "{}", done.err);
    };
    let picture = dir.join("slider_crank.svg");
    run(&[]);
    assert!(picture.exists());
    run(&["--quiet"]);
    assert!(!picture.exists());
    run(&[]);
    assert!(picture.exists());
    // killed while it wrote: some files are of this run, the others of the one before, and the
    // record says which sizes they may have
    let size = |ending: &str| {
        let file = dir.join(format!("slider_crank.{ending}"));
        std::fs::metadata(file).unwrap().len()
    };
    let sizes = |endings: &[&str]| -> serde_json::Value {
        let named = endings
            .iter()
            .map(|e| (format!("slider_crank.{e}"), size(e).into()));
        serde_json::Value::Object(named.collect())
    };
    let record = serde_json::json!({
        "status": "being written",
        "versions": {"cognate": env!("CARGO_PKG_VERSION")},
        "files": sizes(&["csv"]),
        "replaced": sizes(&["res", "req", "gra", "msg", "svg"]),
    });
    std::fs::write(dir.join("slider_crank.json"), record.to_string()).unwrap();
    run(&[]);
    // a file of somebody beside ours is nobody's to touch
    let part = dir.join("slider_crank.csv.part1");
    std::fs::write(&part, "mine").unwrap();
    run(&[]);
    assert_eq!(std::fs::read_to_string(&part).unwrap(), "mine");
}

#[test]
fn results_that_cannot_be_written_have_an_exit_code_and_are_found_before_solving() {
    let example = "examples/slider_crank.acf";
    let file = scratch("unwritable", "a_file", "somebody's");
    let done = cognate(&["run", example, "--out", path(&file.join("below"))]);
    assert_eq!(done.code, 9, "{}", done.err);
    assert!(done.err.contains("file_unwritable") && done.out.is_empty());
    let full = Path::new("/dev/full");
    if full.exists() {
        let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("full");
        let status = std::process::Command::new(env!("CARGO_BIN_EXE_cognate"))
            .current_dir(root(""))
            .args(["run", example, "--json", "--out", path(&dir)])
            .stdout(std::fs::OpenOptions::new().write(true).open(full).unwrap())
            .stderr(std::process::Stdio::null())
            .status()
            .unwrap();
        assert_eq!(status.code(), Some(9));
    }
}

#[test]
fn variables_that_read_each_other_a_thousand_times_need_no_stack() {
    const N: usize = 3000;
    let chain: String = (2..=N)
        .map(|k| {
            format!(
                "VARIABLE/{k}, FUNCTION=0.5*VARVAL({})+0.5*VARVAL({})\n",
                k - 1,
                k.max(3) - 2
            )
        })
        .collect();
    let head = "t\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\n\
                JOINT/1, TRANSLATIONAL, I=20, J=1\nVARIABLE/1, FUNCTION=TIME\n";
    for last in [
        format!("SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=1, FUNCTION=VARVAL({N})"),
        format!("MOTION/1, JOINT=1, TRANSLATION, FUNCTION=VARVAL({N})"),
        format!("GCON/1, FUNCTION=DZ(20,1)-VARVAL({N})"),
    ] {
        let text = format!("{head}{chain}{last}\nREQUEST/1, F2=DZ(20,1)\nEND\n");
        let file = scratch("deep", "deep.adm", &text);
        for command in ["check", "verify", "explain"] {
            let done = cognate(&[command, path(&file)]);
            assert_eq!(done.code, 0, "{command} {last}: {}", done.err);
        }
        let out = file.parent().unwrap();
        let done = cognate(&[
            "run",
            path(&file),
            "--end",
            "1",
            "--steps",
            "2",
            "--out",
            path(out),
        ]);
        assert_eq!(done.code, 0, "{last}: {}", done.err);
    }
}

#[test]
fn the_commands_that_a_log_echoes_are_obeyed_again() {
    let example = "examples/slider_crank.acf";
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("replays");
    let _ = std::fs::remove_dir_all(&dir);
    cognate(&["run", example, "--out", path(&dir), "--quiet"]);
    let model = root("examples/slider_crank.adm");
    std::fs::copy(model, dir.join("slider_crank.adm")).unwrap();
    let log = dir.join("slider_crank.msg");
    let again = cognate(&["run", path(&log), "--out", path(&dir), "--quiet"]);
    assert_eq!(again.code, 0, "{}", again.err);
    let read = |name: &str| std::fs::read_to_string(dir.join(name)).unwrap();
    assert_eq!(read("slider_crank.csv"), read("slider_crank_replay.csv"));
}

#[test]
fn a_method_that_does_not_exist_is_a_mistake_and_the_others_are_named() {
    let example = "examples/slider_crank.acf";
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("no_method");
    let done = cognate(&["run", example, "--method", "RUNGE", "--out", path(&dir)]);
    assert_eq!(done.code, 2, "{}", done.err);
    assert!(
        done.err.contains("RUNGE") && done.err.contains("RADAU5"),
        "{}",
        done.err
    );
}

#[test]
fn what_cannot_be_run_says_so_with_its_code() {
    let no_model = scratch("run_badly", "empty.acf", "\n! nothing\nstop\n");
    let done = cognate(&["run", path(&no_model)]);
    assert!(
        done.code == 3 && done.err.contains("error[no_model]"),
        "{}: {}",
        done.code,
        done.err
    );
    let adm = scratch(
        "run_badly",
        "m.adm",
        "a title\nPART/1, GROUND\nPART/2, MASS=1, CM=2\nMARKER/2, PART=2\nSFORCE/1, TRANSLATIONAL, I=2, J=9\n, FUNCTION=STEPP(TIME,0,0,1,1)\nEND\n",
    );
    let done = cognate(&["run", path(&adm), "--end", "1"]);
    assert!(
        done.code == 3 && done.err.contains("m.adm:6") && done.err.contains("SFORCE/1"),
        "{}: {}",
        done.code,
        done.err
    );
    let fine = scratch(
        "run_badly",
        "f.adm",
        "a title\nPART/1, GROUND\nPART/2, MASS=1, CM=2\nMARKER/2, PART=2\nEND\n",
    );
    assert_eq!(
        cognate(&["run", path(&fine)]).code,
        2,
        "a dataset alone needs an end"
    );
    assert_eq!(
        cognate(&["run", path(&fine.with_file_name("no.adm")), "--end", "1"]).code,
        3
    );
}

#[test]
fn verify_tells_both_counts_and_exits_by_consistency() {
    let scene = |name: &str| format!("tests/scenes/{name}.adm");
    let out = cognate(&["verify", &scene("four_bar"), "--json"]);
    assert_eq!(out.code, 0, "{}", out.err);
    let found: serde_json::Value = serde_json::from_str(&out.out).expect("JSON");
    // with its motion: three parts, four hinges, one motion
    assert_eq!(
        (&found["gruebler"], &found["freedom"]),
        (&(-3).into(), &0.into())
    );
    assert_eq!(found["redundant"].as_array().map(Vec::len), Some(3));
    assert!(
        found["redundant"][0]
            .as_str()
            .unwrap()
            .starts_with("JOINT/")
    );
    let text = cognate(&["verify", &scene("four_bar")]).out;
    assert!(
        text.contains("Gruebler count: -3") && text.contains("already fixed by JOINT/"),
        "{text}"
    );
    let outline = cognate(&["explain", &scene("four_bar"), "--json"]);
    let outline: serde_json::Value = serde_json::from_str(&outline.out).expect("JSON");
    assert_eq!(outline["forest"].as_array().map(Vec::len), Some(3));
    assert_eq!(outline["prescribed"].as_array().map(Vec::len), Some(1));
    let apart = scratch(
        "verify",
        "apart.adm",
        "APART\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=5,0,0\n\
         MARKER/10, PART=1\nMARKER/11, PART=1, QP=4,0,0\nJOINT/1, SPHERICAL, I=20, J=10\nJOINT/2, SPHERICAL, I=21, J=11\nEND\n",
    );
    let out = cognate(&["verify", path(&apart), "--json"]);
    assert_eq!(out.code, 4, "{}", out.err);
    let found: serde_json::Value = serde_json::from_str(&out.out).expect("JSON");
    assert_eq!(
        (&found["consistent"], &found["freedom"]),
        (&false.into(), &serde_json::Value::Null)
    );
    assert!(out.err.contains("JOINT/2"), "{}", out.err);
}

/// A slider that is driven beyond the reach of crank and rod.
const REACH: &str = "REACH\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1\nPART/3, MASS=1, CM=30, IP=1,1,1\nPART/4, MASS=1, CM=40, IP=1,1,1\n\
    MARKER/20, PART=2\nMARKER/30, PART=3\nMARKER/40, PART=4, QP=2,0,0, REULER=90D,90D,0\nMARKER/11, PART=1\n\
    MARKER/22, PART=2, QP=0.25,0.968245836551854,0\nMARKER/32, PART=3, QP=0.25,0.968245836551854,0\n\
    MARKER/33, PART=3, QP=2,0,0\nMARKER/43, PART=4, QP=2,0,0\nMARKER/14, PART=1, REULER=90D,90D,0\n\
    JOINT/1, REVOLUTE, I=20, J=11\nJOINT/2, REVOLUTE, I=32, J=22\nJOINT/3, REVOLUTE, I=33, J=43\n\
    JOINT/4, TRANSLATIONAL, I=40, J=14\nMOTION/1, JOINT=4, TRANSLATION, FUNCTION=2+TIME\nEND\n";

#[test]
fn a_lock_up_ends_with_its_code_its_joint_and_its_last_configuration() {
    let adm = scratch("lock_up", "reach.adm", REACH);
    let dir = adm.with_file_name("out");
    let done = cognate(&[
        "run",
        path(&adm),
        "--end",
        "2",
        "--steps",
        "20",
        "--column",
        "DX(43,11)",
        "--out",
        path(&dir),
    ]);
    assert_eq!(done.code, 6, "{}", done.err);
    assert!(
        done.err.contains("is locked: MOTION/1")
            && done.err.contains("JOINT/3")
            && done.err.contains("time 0.99999"),
        "{}",
        done.err
    );
    // outputs up to there, and the stretched configuration as the last row
    let table = std::fs::read_to_string(dir.join("reach.csv")).unwrap();
    let last: Vec<f64> = (table.lines().last().unwrap().split(','))
        .map(|x| x.parse().unwrap())
        .collect();
    assert!(
        (last[0] - 1.0).abs() < 1e-6 && (last[1] - 3.0).abs() < 1e-6,
        "{last:?}"
    );
    let record: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(dir.join("reach.json")).unwrap()).unwrap();
    assert!(record.to_string().contains("is locked"), "{record}");
}

#[test]
fn a_limit_of_steps_ends_with_its_code_and_keeps_what_there_is() {
    let adm = scratch(
        "limit",
        "swing.adm",
        "a pendulum\nPART/1, GROUND\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/1, PART=1\nMARKER/2, PART=2, QP=1,0,0\nMARKER/3, PART=2\n\
         JOINT/1, REVOLUTE, I=3, J=1\nACCGRAV/JGRAV=-9.81\nEND\n",
    );
    let dir = adm.with_file_name("out");
    for method in ["DOP853", "RADAU5", "AUTO"] {
        let ran = |limit: &str| {
            let args = [
                "run",
                path(&adm),
                "--end",
                "100",
                "--steps",
                "100",
                "--json",
            ];
            let more = [
                "--method",
                method,
                "--max-steps",
                limit,
                "--out",
                path(&dir),
            ];
            let done = cognate(&[&args[..], &more[..]].concat());
            let record: serde_json::Value = serde_json::from_str(&done.out).unwrap_or_default();
            (done, record)
        };
        let (done, record) = ran("20");
        assert_eq!(done.code, 7, "{method}: {}", done.err);
        let count = |name: &str| record[name].as_u64().unwrap();
        let tried = count("steps") + count("rejected_steps");
        assert_eq!(tried, 20, "{method}: {record}");
        assert_eq!(record["status"], "limit");
        let reason = record["stop_reason"].as_str().unwrap();
        assert!(
            reason.contains("as many steps were tried as are permitted"),
            "{reason}"
        );
        assert_eq!(ran("1000000").0.code, 0, "{method}");
    }
}

#[test]
fn a_motion_that_jumps_is_refused_and_runs_piecewise_on_demand() {
    let adm = scratch(
        "piecewise",
        "jump.adm",
        "JUMP\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/1, PART=1\n\
         JOINT/1, REVOLUTE, I=20, J=1\nMOTION/1, JOINT=1, ROTATION, FUNCTION=IF(TIME-0.5: 0, 0, TIME-0.3)\nEND\n",
    );
    let dir = adm.with_file_name("out");
    let run = |more: &[&str]| {
        let mut args = vec![
            "run",
            path(&adm),
            "--end",
            "1",
            "--steps",
            "10",
            "--column",
            "AZ(20,1)",
            "--out",
            path(&dir),
        ];
        args.extend(more);
        cognate(&args)
    };
    let done = run(&[]);
    assert_eq!(done.code, 4, "{}", done.err);
    assert!(
        done.err.contains("MOTION/1")
            && done.err.contains("jumps at time 0.5")
            && done.err.contains("--piecewise"),
        "{}",
        done.err
    );
    let done = run(&["--piecewise"]);
    assert_eq!(done.code, 0, "{}", done.err);
    let record: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(dir.join("jump.json")).unwrap()).unwrap();
    let jumps = record["piecewise"].as_array().unwrap();
    assert_eq!(jumps.len(), 1, "{record}");
    assert!(
        jumps[0].to_string().contains("MOTION/1") && jumps[0].to_string().contains("0.5"),
        "{}",
        jumps[0]
    );
    let table = std::fs::read_to_string(dir.join("jump.csv")).unwrap();
    let last: f64 = table
        .lines()
        .last()
        .unwrap()
        .split(',')
        .nth(1)
        .unwrap()
        .parse()
        .unwrap();
    assert!((last - 0.7).abs() < 1e-9, "{last}");
}

/// Wrong models, one mistake each: what `verify`, `explain` and `run` say names the element, how much, and what to do.
#[test]
fn wrong_models_are_told_alike_by_verify_explain_and_run() {
    let head = "WRONG\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\nPART/1, GROUND\nMARKER/1, PART=1\n\
                PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\n";
    let line = "MATRIX/1, FULL=RORDER, ROWS=4, COLUMNS=3, VALUES=-1,0,0,-0.5,0,0,0.5,0,0,1,0,0\nCURVE/1, OPEN, MATRIX=1, CURVE_POINTS\n";
    let gear = "PART/3, MASS=1, CM=30, IP=1,1,1, QG=3,0,0\nMARKER/30, PART=3\nMARKER/13, PART=1, QP=3,0,0\nMARKER/9, PART=1, QP=1,0,0\n\
                JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, REVOLUTE, I=30, J=13\nGEAR/1, JOINTS=1,2, CV=9\n";
    let planes = format!(
        "MARKER/21, PART=2, REULER=0,10D,0\nJOINT/1, PLANAR, I=20, J=1\nCVCV/1, ICURVE=1, IRM=21, JCURVE=1, JRM=1\n{line}"
    );
    let beside = format!(
        "JPRIM/1, ORIENTATION, I=20, J=1\nMARKER/21, PART=2, QP=4,0,0\nJPRIM/2, ATPOINT, I=20, J=1\nPTCV/1, CURVE=1, I=21, RM=1\n{line}"
    );
    for (name, text, words) in [
        (
            "gear",
            gear,
            ["GEAR/1", "z of CV is parallel", "common tangent"],
        ),
        (
            "planes",
            planes.as_str(),
            [
                "CVCV/1",
                "inclined to each other by 10",
                "MARKER/21 and MARKER/1",
            ],
        ),
        (
            "beside",
            beside.as_str(),
            [
                "PTCV/1",
                "leaves the open CURVE/1 at its last point (1.0",
                "by more than 3.0",
            ],
        ),
    ] {
        let adm = scratch(
            "wrong_models",
            &format!("{name}.adm"),
            &format!("{head}{text}END\n"),
        );
        let out = adm.with_file_name("out");
        for command in [
            vec!["verify", path(&adm)],
            vec!["explain", path(&adm)],
            vec!["run", path(&adm), "--end", "1", "--out", path(&out)],
        ] {
            let done = cognate(&command);
            assert_eq!(done.code, 4, "{command:?}: {}", done.err);
            for w in words {
                assert!(done.err.contains(w), "{command:?}, {w}: {}", done.err);
            }
        }
    }
    // a part that stands the wrong way round is no mistake, but told
    let flipped = format!(
        "{}JOINT/1, REVOLUTE, I=20, J=1\nEND\n",
        head.replace("IP=1,1,1", "IP=1,1,1, REULER=0,180D,0")
    );
    let adm = scratch("wrong_models", "flipped.adm", &flipped);
    for command in ["verify", "explain"] {
        let done = cognate(&[command, path(&adm)]);
        assert!(
            done.code == 0
                && done
                    .out
                    .contains("PART/2 is turned by 180 deg against the dataset"),
            "{command}: {}",
            done.out
        );
    }
}

#[test]
fn what_a_model_cannot_do_is_shown_at_its_statement() {
    let text = "TEST\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n\
                ARRAY/12, Y\nARRAY/14, X\n\
                GSE/1, NO=1, ND=1, Y=12, XD=14, SAMPLE_PERIOD=0.1, FUNCTION=USER(9)\n\
                SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=1, FUNCTION=USER(7)\nEND\n";
    let file = scratch("places", "refused.adm", text);
    let out = scratch("places", "out", "");
    let folder = out.parent().expect("it is a file");
    for command in [
        vec![
            "run",
            path(&file),
            "--end",
            "1",
            "--quiet",
            "--out",
            path(folder),
        ],
        vec!["linear", path(&file), "--out", path(folder)],
    ] {
        let done = cognate(&command);
        assert_eq!(done.code, 4, "{command:?}: {}", done.err);
        // one sentence with all places that want a routine
        for place in [
            "refused.adm:9:1",
            "9 | SFORCE/1",
            "likewise GSE/1 FUNCTION (line 8)",
        ] {
            assert!(
                done.err.contains(place),
                "{command:?} {place}: {}",
                done.err
            );
        }
    }
}

#[test]
fn a_first_line_that_says_model_is_told_what_it_lacks() {
    let acf = scratch(
        "answered",
        "m.acf",
        "model=nomass.adm\nsimulate/dynamic, end=1\n",
    );
    let done = cognate(&["run", path(&acf)]);
    assert_eq!(done.code, 3);
    assert!(
        done.err.contains("FILE/MODEL=nomass.adm is meant?"),
        "{}",
        done.err
    );
    assert!(done.err.contains("m.acf:1:1"), "{}", done.err);
    let acf = scratch(
        "answered",
        "n.acf",
        "\nfile/model=nowhere\nsimulate/dynamic, end=1\n",
    );
    let done = cognate(&["run", path(&acf)]);
    assert_eq!(done.code, 3);
    assert!(done.err.contains("nowhere.adm"), "{}", done.err);
    assert!(!done.err.contains("first line"), "{}", done.err);
}

#[test]
fn a_system_of_orient_without_meaning_names_its_element_and_says_what_serves() {
    let adm = scratch(
        "orient",
        "o.adm",
        "t\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=2\nMARKER/2, PART=2\nVARIABLE/7, FUNCTION=ORIENT(25,1,2,1)\nEND\n",
    );
    let out = path(adm.parent().unwrap());
    let done = cognate(&["run", path(&adm), "--end", "1", "--out", out]);
    assert_eq!(done.code, 4);
    assert!(done.err.contains("VARIABLE/7"), "{}", done.err);
    assert!(done.err.contains("o.adm:6:1"), "{}", done.err);
    assert!(done.err.contains("YAW"), "{}", done.err);
}
