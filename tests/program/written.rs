//! Tables of a run: written while it goes on, in every format with the same numbers, and there
//! whatever ends it.

use crate::command::{cognate, ok, path, scratch};

use cognate::results::{self, Run};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const PENDULUM: &str = "a pendulum\nPART/1, GROUND\nMARKER/1, PART=1\n\
    PART/2, MASS=1, CM=20, IP=1,1,1, QG=1,0,0\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=-1,0,0\n\
    JOINT/1, REVOLUTE, I=21, J=1\nACCGRAV/JGRAV=-9.81\nREQUEST/1, DISPLACEMENT, I=20, J=1\n\
    RESULTS/\nEND\n";

/// An empty folder with the dataset of a pendulum: the folder, the dataset.
fn pendulum(name: &str) -> (PathBuf, PathBuf) {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    let file = scratch(name, "p.adm", PENDULUM);
    (folder, file)
}

fn run(file: &Path, end: &str, steps: &str, more: &[&str]) {
    let folder = file.parent().unwrap();
    let mut args = vec![
        "run",
        path(file),
        "--end",
        end,
        "--steps",
        steps,
        "--out",
        path(folder),
    ];
    args.extend(more);
    let done = cognate(&args);
    assert_eq!(done.code, 0, "{}", done.err);
}

fn read(file: &Path) -> Run {
    results::read(file).unwrap_or_else(|d| panic!("{d}"))
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|x| x.to_bits()).collect()
}

#[test]
fn every_format_has_the_same_numbers_however_many_rows_there_are() {
    // the second run is longer than what is held in memory
    for (name, steps) in [("formats_short", "50"), ("formats_long", "62000")] {
        let (folder, file) = pendulum(name);
        run(
            &file,
            "5",
            steps,
            &["--format", "csv,parquet,res", "--quiet"],
        );
        let res = read(&folder.join("p.res"));
        let rows: usize = steps.parse().unwrap();
        assert_eq!((res.rows(), res.columns.len()), (rows + 1, 46));
        let others = ["csv", "parquet"].map(|e| read(&folder.join(format!("p.{e}"))));
        for table in others {
            assert_eq!(table.rows(), res.rows());
            for column in &table.columns {
                let in_res = res.columns.iter().find(|c| c.name == column.name);
                let in_res = in_res.unwrap_or_else(|| panic!("{}", column.name));
                assert!(
                    bits(&column.values) == bits(&in_res.values),
                    "{}",
                    column.name
                );
                assert_eq!(column.unit, in_res.unit, "{}", column.name);
            }
        }
        let parquet = read(&folder.join("p.parquet"));
        assert_eq!(parquet.sequences, res.sequences);
        assert_eq!(parquet.columns.len(), res.columns.len());
    }
}

#[test]
fn tables_for_other_tools_have_no_units_or_decimal_commas() {
    let (folder, file) = pendulum("styles");
    let text = |more: &[&str]| {
        run(&file, "1", "4", more);
        std::fs::read_to_string(folder.join("p.csv")).unwrap()
    };
    let usual = text(&[]);
    let lines: Vec<&str> = usual.lines().collect();
    assert_eq!((lines.len(), lines[1].split(',').next()), (7, Some("sec")));
    let bare = text(&["--no-units"]);
    let without: Vec<&str> = lines
        .iter()
        .enumerate()
        .filter(|l| l.0 != 1)
        .map(|l| *l.1)
        .collect();
    assert_eq!(bare.lines().collect::<Vec<_>>(), without);
    let comma = text(&["--decimal-comma"]);
    assert_eq!(comma.replace(',', ".").replace(';', ","), usual);
    let back = read(&folder.join("p.csv"));
    assert_eq!(back.columns[0].values, [0.0, 0.25, 0.5, 0.75, 1.0]);
    let done = cognate(&["run", path(&file), "--end", "1", "--format", "hdf5"]);
    assert_eq!(done.code, 2);
    assert!(done.err.contains("csv, parquet, res, json"), "{}", done.err);
}

/// A run that goes on for minutes, once some of its rows are on the disk.
fn long_run(file: &Path, part: &Path) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cognate"));
    command.args([
        "run",
        path(file),
        "--end",
        "1e5",
        "--steps",
        "5000000",
        "--quiet",
    ]);
    command.args([
        "--format",
        "csv,parquet,res",
        "--out",
        path(file.parent().unwrap()),
    ]);
    let mut run = command.stderr(Stdio::null()).spawn().unwrap();
    let begun = Instant::now();
    while !part.exists() {
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "no rows are on the disk"
        );
        assert!(run.try_wait().unwrap().is_none(), "the run has ended");
        std::thread::sleep(Duration::from_millis(50));
    }
    run
}

/// Checks that a table holds outputs from the first one on, without a gap.
fn assert_is_a_beginning(table: &Run) {
    assert!(table.rows() > 100, "{} rows", table.rows());
    let time = table.column("time").unwrap();
    let expected = (0..table.rows()).map(|k| 1e5 * k as f64 / 5e6);
    assert!(time.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9));
    assert!(table.columns.iter().all(|c| c.values.len() == table.rows()));
}

#[test]
fn rows_of_rest_and_of_motion_at_one_time_are_told_apart() {
    let (folder, _) = pendulum("phases");
    let commands = |name: &str, text: &str| {
        let file = scratch("phases", name, &format!("FILE/MODEL=p\n{text}STOP\n"));
        let done = cognate(&["run", path(&file), "--quiet", "--out", path(&folder)]);
        assert_eq!(done.code, 0, "{}", done.err);
        std::fs::read_to_string(folder.join(name).with_extension("csv")).unwrap()
    };
    let both = "SIMULATE/STATIC\nSIMULATE/DYNAMIC, END=1, STEPS=4\n";
    let table = commands("both.acf", both);
    let lines: Vec<&str> = table.lines().collect();
    assert!(
        lines[0].ends_with(",phase") && lines[1].ends_with(",-"),
        "{table}"
    );
    // assembled, then at rest, at one time
    assert!(
        lines[2].starts_with("0,") && lines[2].ends_with(",initialConditions"),
        "{table}"
    );
    assert!(
        lines[3].starts_with("0,") && lines[3].ends_with(",static"),
        "{table}"
    );
    let dynamic: Vec<&&str> = lines.iter().filter(|l| l.ends_with(",dynamic")).collect();
    assert!(
        dynamic.len() >= 4 && dynamic.last() == lines.iter().last().as_ref(),
        "{table}"
    );
    // a column of words is none of numbers
    assert_eq!(read(&folder.join("both.csv")).find("phase"), None);
    let alone = commands("alone.acf", "SIMULATE/DYNAMIC, END=1, STEPS=4\n");
    assert!(!alone.contains("phase"), "{alone}");
}

#[test]
fn the_rows_of_a_run_that_is_killed_are_on_the_disk_and_stay_there() {
    let (folder, file) = pendulum("killed");
    let parts = ["csv", "res", "parquet"].map(|e| folder.join(format!("p.{e}.part1")));
    let mut killed = long_run(&file, &parts[2].join("0001.parquet"));
    let runs = || cognate(&["runs", path(&folder)]).out;
    let delete = || cognate(&["runs", "delete", path(&folder.join("p")), "--yes"]);
    assert!(runs().contains("being written"), "{}", runs());
    let refused = delete();
    assert!(refused.err.contains("run_in_use"), "{}", refused.err);
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert!(
        runs().contains("cut off") && runs().contains(".csv.part1"),
        "{}",
        runs()
    );
    for part in &parts {
        assert_is_a_beginning(&read(part));
    }
    let table = folder.join("saved.csv");
    let done = cognate(&["convert", path(&parts[2]), path(&table)]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert_is_a_beginning(&read(&table));
    let record = std::fs::read_to_string(folder.join("p.json")).unwrap();
    assert!(record.contains("being written"), "{record}");
    // the next run writes beside it
    let size = |part: &Path| std::fs::metadata(part).unwrap().len();
    let sizes = [size(&parts[0]), size(&parts[1])];
    let done = cognate(&["run", path(&file), "--end", "1", "--out", path(&folder)]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(
        done.err.contains("p.csv.part1 holds rows of a run"),
        "{}",
        done.err
    );
    assert_eq!([size(&parts[0]), size(&parts[1])], sizes);
    assert_eq!(read(&folder.join("p.csv")).rows(), 51);
    // parts go with the run that was cut off
    std::fs::write(folder.join("p.json"), record).unwrap();
    let done = delete();
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(!parts.iter().any(|part| part.exists()), "{}", runs());
}

/// Returns whether this process, and so its children, ignore SIGHUP.
#[cfg(unix)]
fn hangups_are_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|l| l.strip_prefix("SigIgn:"));
    ignored.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).is_ok_and(|m| m & 1 == 1))
}

#[cfg(unix)]
#[test]
fn a_run_that_is_asked_to_end_keeps_its_results_and_says_so() {
    for signal in ["TERM", "HUP", "INT"] {
        if signal == "HUP" && hangups_are_ignored() {
            eprintln!("SIGHUP is ignored here, as under nohup: left out");
            continue;
        }
        let (folder, file) = pendulum(&format!("asked_by_{signal}"));
        let mut asked = long_run(&file, &folder.join("p.csv.part1"));
        let kill = Command::new("kill")
            .args([format!("-{signal}"), asked.id().to_string()])
            .status();
        assert!(kill.unwrap().success());
        assert_eq!(asked.wait().unwrap().code(), Some(130), "{signal}");
        let record = std::fs::read_to_string(folder.join("p.json")).unwrap();
        let record: serde_json::Value = serde_json::from_str(&record).unwrap();
        assert_eq!(record["status"], "interrupted", "{signal}");
        for ending in ["csv", "res", "parquet"] {
            assert_is_a_beginning(&read(&folder.join(format!("p.{ending}"))));
            assert!(
                !folder.join(format!("p.{ending}.part1")).exists(),
                "{ending}"
            );
        }
    }
}

#[test]
fn other_programs_read_parquet_files() {
    let script = "import sys, pandas, pyarrow.parquet\n\
        table = pandas.read_parquet(sys.argv[1])\n\
        units = pyarrow.parquet.read_metadata(sys.argv[1]).metadata[b'cognate.units']\n\
        print(table.shape, repr(float(table['REQUEST_1.DY'].iloc[-1])), units.decode())\n";
    let (folder, file) = pendulum("pandas");
    let script = scratch("pandas", "read.py", script);
    let python = std::env::var("COGNATE_PYTHON").unwrap_or_else(|_| "python3".into());
    if !crate::needs::runs("pandas", &python, &["-c", "import pandas, pyarrow"]) {
        return;
    }
    run(&file, "2", "20000", &["--format", "parquet", "--quiet"]);
    let table = folder.join("p.parquet");
    let output = Command::new(python)
        .args([&script, &table])
        .output()
        .unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    let ours = read(&table);
    let (rows, columns) = (ours.rows(), ours.columns.len());
    let last = *ours.column("REQUEST_1.DY").unwrap().last().unwrap();
    assert!(rows == 20001 && columns > 30, "{rows} {columns}");
    assert!(
        said.starts_with(&format!("({rows}, {columns}) {last:?} ")),
        "{said}"
    );
    assert!(said.contains("\"REQUEST_1.DY\":\"meter\""), "{said}");
}

#[test]
fn a_damaged_parquet_file_is_an_error_or_a_table_and_never_a_panic() {
    let (folder, file) = pendulum("damaged");
    run(&file, "1", "20", &["--format", "parquet", "--quiet"]);
    let good = std::fs::read(folder.join("p.parquet")).unwrap();
    let attempt = |bytes: &[u8]| {
        let _ = results::parquet::read(bytes);
    };
    (0..good.len())
        .step_by(7)
        .for_each(|cut| attempt(&good[..cut]));
    let mut state = 1_u64;
    for _ in 0..3000 {
        let mut bad = good.clone();
        for _ in 0..3 {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            let place = (state >> 33) as usize % bad.len();
            bad[place] = (state >> 20) as u8;
        }
        attempt(&bad);
    }
}

/// Everything else of a run is written where one of its files cannot be: its folder is a file.
#[test]
fn a_file_that_cannot_be_written_takes_no_other_with_it() {
    let (folder, _) = pendulum("written_elsewhere");
    scratch("written_elsewhere", "taken", "no folder");
    let commands =
        "FILE/MODEL=p\nSIMULATE/DYNAMIC, END=1, STEPS=4\nLINEAR/EIGENSOL, FILE=taken/x\nSTOP\n";
    let file = scratch("written_elsewhere", "p.acf", commands);
    let done = cognate(&["run", path(&file), "--out", path(&folder)]);
    assert_eq!(done.code, 9, "{}", done.err);
    assert!(
        done.err.contains("taken/x.json") && done.err.contains("other files"),
        "{}",
        done.err
    );
    for (name, holds) in [
        ("p.csv", "time,"),
        ("p.msg", "End Simulation"),
        ("p.json", "\"completed\""),
    ] {
        let text = std::fs::read_to_string(folder.join(name)).expect(name);
        assert!(text.contains(holds), "{name}: {text}");
    }
    assert_eq!(
        std::fs::read_to_string(folder.join("taken")).unwrap(),
        "no folder"
    );
}

#[test]
fn commands_that_do_nothing_are_told_by_a_run() {
    let (folder, _) = pendulum("written_nothing");
    let run = |commands: &str| {
        let file = scratch("written_nothing", "p.acf", commands);
        cognate(&["run", path(&file), "--out", path(&folder)])
    };
    let done = run("FILE/MODEL=p\nSTOP\nSIMULATE/DYNAMIC, END=1\n");
    assert!(
        done.err.contains("SIMULATE/ stands after STOP"),
        "{}",
        done.err
    );
    assert!(done.err.contains("nothing is solved"), "{}", done.err);
    let twice =
        "FILE/MODEL=p\nSIMULATE/DYNAMIC, END=1, STEPS=2\nSAVE/SYSTEM=a/x\nSAVE/SYSTEM=b/x\n";
    let done = run(twice);
    assert_eq!(done.code, 4, "{}", done.err);
    assert!(
        done.err.contains("x.state.json is to hold two states"),
        "{}",
        done.err
    );
    let kinematic = run("FILE/MODEL=p\n\nSIMULATE/KINEMATIC, END=1\n");
    assert!(kinematic.err.contains("p.acf:3:1"), "{}", kinematic.err);
}

#[test]
fn results_in_any_encoding_of_text_are_the_same_results() {
    let text = "time,H\u{f6}he.DX,H\u{fc}he.DX\nsec,mm,mm\n0,1,2\n0.5,3,4\n";
    let wide = |text: &str| text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let encoded: [(&str, Vec<u8>); 5] = [
        ("plain", text.into()),
        ("marked", format!("\u{feff}{text}").into()),
        ("latin", text.chars().map(|c| c as u8).collect()),
        ("wide", wide(&format!("\u{feff}{text}"))),
        ("ends", text.replace('\n', "\r\n").into()),
    ];
    let file = scratch("encodings", "plain.csv", "");
    for (name, bytes) in &encoded {
        std::fs::write(file.with_file_name(format!("{name}.csv")), bytes).unwrap();
    }
    let plain = ["csv", "res", "json"].map(|format| {
        let made = file.with_file_name(format!("made.{format}"));
        // of an earlier run of this test, which changed it
        let _ = std::fs::remove_file(&made);
        ok(&["convert", path(&file), path(&made)]);
        (made.clone(), std::fs::read_to_string(made).unwrap())
    });
    for (name, _) in &encoded {
        let table = file.with_file_name(format!("{name}.csv"));
        let again = file.with_file_name("again.csv");
        ok(&["convert", path(&table), path(&again)]);
        assert_eq!(
            std::fs::read_to_string(&again).unwrap(),
            plain[0].1,
            "{name}"
        );
    }
    for (made, text) in &plain {
        let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
        for (name, bytes) in [
            ("latin", latin),
            ("marked", format!("\u{feff}{text}").into()),
        ] {
            std::fs::write(made, bytes).unwrap();
            let run = read(made);
            let names: Vec<&str> = run.columns.iter().map(|c| c.name.as_str()).collect();
            assert_eq!(
                names[1..],
                ["H\u{f6}he.DX", "H\u{fc}he.DX"],
                "{name} {}",
                path(made)
            );
        }
    }
}

#[test]
fn modes_of_an_earlier_run_go_with_it_and_other_files_of_it_stay_ours() {
    let (folder, model) = pendulum("modes_stale");
    let out = folder.join("out");
    let commands = model.with_extension("acf");
    let text = "FILE/MODEL=p\nSIMULATE/DYNAMIC, END=0.1, STEPS=2\nLINEAR/EIGENSOL\n\
                LINEAR/STATEMAT, FILE=plant\nSAVE/SYSTEM=kept\nSTOP\n";
    std::fs::write(&commands, text).unwrap();
    let solve = |file: &Path, more: &[&str]| {
        let args = [
            "run",
            path(file),
            "--out",
            path(&out),
            "--name",
            "p",
            "--quiet",
        ];
        let done = ok(&[&args, more].concat());
        assert!(!done.err.contains("kept as"), "{}", done.err);
    };
    for _ in 0..2 {
        solve(&commands, &[]);
        assert!(out.join("p_linear.json").exists());
        solve(&model, &["--end", "0.1", "--steps", "2"]);
        assert!(!out.join("p_linear.json").exists());
        assert!(out.join("plant.json").exists() && out.join("kept.state.json").exists());
    }
}

#[test]
fn an_end_beside_commands_or_results_is_refused_and_not_passed_over() {
    let (folder, model) = pendulum("no_end_beside");
    let out = folder.join("out");
    let commands = model.with_extension("acf");
    std::fs::write(
        &commands,
        "FILE/MODEL=p\nSIMULATE/DYNAMIC, END=0.1, STEPS=2\n",
    )
    .unwrap();
    let results = out.join("p.res");
    ok(&[
        "run",
        path(&commands),
        "--out",
        path(&out),
        "--name",
        "p",
        "--format",
        "res",
        "--quiet",
    ]);
    let (c, r) = (path(&commands), path(&results));
    let page = out.join("page.html");
    let dataset = path(&model);
    for file in [
        &["run", c, "--out", path(&out)][..],
        &[
            "sweep",
            c,
            "--set",
            "PART/2.MASS=1,2",
            "--measure",
            "max(DX(20,1))",
        ],
        &["report", c, "--out", path(&out)],
        &["export", c, "--out", path(&out)],
        &["animate", c, "--out", path(&page)],
        &["animate", r, "--model", dataset, "--out", path(&page)],
        &["draw", r, "--model", dataset, "--out", path(&page)],
    ] {
        for given in [["--end", "5"], ["--steps", "7"], ["--type", "static"]] {
            let done = cognate(&[file, &given[..]].concat());
            assert_eq!(done.code, 2, "{file:?} {given:?}: {}", done.err);
            assert!(done.err.contains(given[0]), "{}", done.err);
        }
    }
    assert!(!page.exists());
    let none = cognate(&[
        "run",
        dataset,
        "--end",
        "1",
        "--steps",
        "0",
        "--out",
        path(&out),
    ]);
    assert_eq!(none.code, 2, "{}", none.err);
}

#[test]
fn a_time_beyond_the_run_is_refused_and_the_start_is_a_configuration() {
    let (folder, model) = pendulum("time_beyond");
    let (m, out) = (path(&model), folder.join("at.svg"));
    let draw = |more: &[&str]| cognate(&[&["draw", m, "--out", path(&out)], more].concat());
    assert_eq!(draw(&["--at", "0"]).code, 0);
    assert_eq!(draw(&["--end", "1", "--at", "1"]).code, 0);
    for more in [
        &["--at", "0.5"][..],
        &["--end", "1", "--at", "1.1"],
        &["--at", "-1"],
    ] {
        let done = draw(more);
        assert_eq!(done.code, 2, "{more:?}: {}", done.err);
    }
    let begun = folder.join("begun.adm");
    ok(&["configuration", m, "--at", "0", "--out", path(&begun)]);
    let at = |file: &Path| {
        run(file, "1", "4", &["--name", "it", "--format", "csv"]);
        read(&folder.join("it.csv"))
    };
    let (a, b) = (at(&model), at(&begun));
    for (a, b) in a.columns.iter().zip(&b.columns) {
        let close = |(x, y): (&f64, &f64)| (x - y).abs() <= 1e-9 * (1.0 + y.abs());
        assert!(a.values.iter().zip(&b.values).all(close), "{}", a.name);
    }
}
