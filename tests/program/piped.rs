//! `-` in the place of files: what comes through a pipe is read as a file is, and what goes through one is what a file would have.

use crate::command::{cognate, ok, path, scratch};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const DROP: &str = "drop\nUNITS/SYSTEM=MKS\nPART/1, GROUND\nPART/2, MASS=1, CM=21, IP=1,1,1\nMARKER/21, PART=2\nMARKER/1, PART=1\n\
                    ACCGRAV/KGRAV=-9.81\nREQUEST/1, DISPLACEMENT, I=21, J=1\nEND\n";

/// Runs a command in a folder of its own with these bytes as its input.
fn piped(folder: &Path, args: &[&str], input: &[u8]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_cognate"))
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let input = input.to_vec();
    // a command that does not read its input may end before all of it is written
    let writer = std::thread::spawn(move || stdin.write_all(&input));
    let output = child.wait_with_output().unwrap();
    let _ = writer.join().unwrap();
    output
}

fn err(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The results of a run of the model, in every format, in a folder of this test's own.
fn results(test: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = std::fs::remove_dir_all(&folder);
    let model = scratch(test, "drop.adm", DROP);
    let all = "csv,parquet,res,json,req,gra";
    let times = ["--end", "1", "--steps", "5", "--format", all];
    ok(&[&["run", path(&model), "--out", path(&folder)], &times[..]].concat());
    folder
}

#[test]
fn every_format_goes_through_a_pipe_as_it_goes_into_a_file() {
    let folder = results("piped_formats");
    let whole = path(&folder.join("drop.res")).to_owned();
    for format in ["csv", "parquet", "res", "json", "req", "gra"] {
        let file = folder.join(format!("out.{format}"));
        let _ = std::fs::remove_file(&file);
        ok(&["convert", &whole, path(&file)]);
        let expected = std::fs::read(&file).unwrap();
        let out = format!("{format}:-");
        let done = piped(&folder, &["convert", &whole, &out], b"");
        assert!(done.status.success(), "{format}: {}", err(&done));
        assert!(done.stdout == expected, "{format}");
        // and back
        let table = folder.join("table.csv");
        let _ = std::fs::remove_file(&table);
        ok(&["convert", path(&file), path(&table)]);
        let done = piped(&folder, &["convert", &out, "-"], &expected);
        assert!(done.status.success(), "{format}: {}", err(&done));
        assert!(done.stdout == std::fs::read(&table).unwrap(), "{format}");
        assert!(err(&done).contains("in standard output"), "{}", err(&done));
    }
}

#[test]
fn a_dataset_through_a_pipe_is_a_dataset() {
    let folder = results("piped_models");
    let file = folder.join("drop.adm");
    for args in [
        &["check", "-"][..],
        &["fmt", "-"],
        &["verify", "-"],
        &["elements", "adm:-"],
        &["linear", "-", "--json"],
        &["explain", "code_that_is_none"],
    ] {
        let named: Vec<&str> = args
            .iter()
            .map(|a| {
                if a.ends_with('-') && !a.starts_with("--") {
                    path(&file)
                } else {
                    a
                }
            })
            .collect();
        let expected = cognate(&named);
        let done = piped(&folder, args, DROP.as_bytes());
        assert_eq!(
            done.status.code(),
            Some(expected.code),
            "{args:?}: {}",
            err(&done)
        );
        assert_eq!(
            String::from_utf8_lossy(&done.stdout).replace("stdin", "drop"),
            expected.out,
            "{args:?}"
        );
    }
    // mistakes show their lines
    let broken = DROP.replace("MASS=1", "MASS=x");
    let done = piped(&folder, &["check", "-"], broken.as_bytes());
    assert_eq!(done.status.code(), Some(3));
    assert!(
        err(&done).contains("stdin.adm:4") && err(&done).contains("MASS=x"),
        "{}",
        err(&done)
    );
}

#[test]
fn a_run_sends_its_table_alone_and_leaves_no_file() {
    let folder = results("piped_runs");
    let expected = std::fs::read(folder.join("drop.csv")).unwrap();
    let names = || {
        let mut all: Vec<_> = std::fs::read_dir(&folder)
            .unwrap()
            .map(|e| e.unwrap().file_name())
            .collect();
        all.sort();
        all
    };
    let before = names();
    let run = |more: &[&str]| {
        piped(
            &folder,
            &[&["run", "-", "--end", "1", "--steps", "5"], more].concat(),
            DROP.as_bytes(),
        )
    };
    let done = run(&["-o", "-"]);
    assert!(done.status.success(), "{}", err(&done));
    assert_eq!(
        String::from_utf8_lossy(&done.stdout),
        String::from_utf8_lossy(&expected)
    );
    for (more, begins) in [
        (["-o", "parquet:-"], "PAR1"),
        (["-o", "res:-"], "<?xml"),
        (["-o", "json:-"], "{"),
    ] {
        let done = run(&more);
        assert!(done.status.success(), "{more:?}: {}", err(&done));
        assert!(done.stdout.starts_with(begins.as_bytes()), "{more:?}");
    }
    let done = run(&["-o", "-", "--format", "json"]);
    assert!(done.stdout.starts_with(b"{"), "{}", err(&done));
    for more in [
        &["-o", "-", "--json"][..],
        &["-o", "-", "--format", "csv,res"],
        &["-o", "xyz:-"],
    ] {
        let done = run(more);
        assert_eq!(done.status.code(), Some(2), "{more:?}: {}", err(&done));
        assert!(done.stdout.is_empty(), "{more:?}");
    }
    assert_eq!(names(), before);
}

#[test]
fn what_cannot_go_through_a_pipe_says_so() {
    let folder = results("piped_refusals");
    for (args, said) in [
        (&["runs", "compare", "-", "-"][..], "named twice"),
        (&["convert", "xyz:-", "-"], "no format that is read"),
        (&["report", "-", "-o", "-"], "this is a folder"),
        (&["sweep", "-", "-o", "-"], "this is a file"),
        (&["plot", "-", "-o", "xyz:-"], ""),
    ] {
        let done = piped(&folder, args, b"");
        assert!(
            matches!(done.status.code(), Some(2 | 3)),
            "{args:?}: {}",
            err(&done)
        );
        assert!(
            err(&done).contains(said) && done.stdout.is_empty(),
            "{args:?}: {}",
            err(&done)
        );
    }
    assert!(!folder.join("-").exists());
}

#[test]
fn colours_are_where_they_are_asked_for() {
    let folder = results("colours");
    let escape = b"\x1b[";
    let has = |bytes: &[u8]| bytes.windows(2).any(|w| w == escape);
    let wrong: [&[&str]; 3] = [
        &["eval", "STPE(TIME)"],
        &["run", "--no-such-option"],
        &["check", "nothing.adm"],
    ];
    for args in wrong {
        let always = piped(&folder, &[args, &["--color", "always"]].concat(), b"");
        assert!(has(&always.stderr), "{args:?}: {}", err(&always));
        for choice in ["--color=auto", "--color=never"] {
            let done = piped(&folder, &[&[choice], args].concat(), b"");
            assert!(!has(&done.stderr), "{args:?} {choice}: {}", err(&done));
        }
    }
    let help = piped(&folder, &["run", "--help", "--color=always"], b"");
    assert!(has(&help.stdout));
    assert!(!has(&piped(&folder, &["run", "--help"], b"").stdout));
    let plot = |choice: &str| piped(&folder, &["plot", "drop.csv", "--color", choice], b"").stdout;
    assert!(has(&plot("always")) && !has(&plot("never")));
}

#[test]
fn help_fits_the_terminal() {
    let help = |columns: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_cognate"));
        let output = command
            .args(["run", "--help"])
            .env("COLUMNS", columns)
            .output()
            .unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    for columns in [60, 80, 100] {
        // examples stay as they are typed
        let text = help(&columns.to_string());
        let options = text.split("Examples:").next().unwrap();
        let widest = options.lines().map(|l| l.chars().count()).max().unwrap();
        assert!(widest <= columns, "{columns}: {widest}\n{text}");
    }
    assert!(help("60").lines().count() > help("100").lines().count());
}

#[test]
fn shells_and_man_know_every_command() {
    let folder = results("completions");
    let help = ok(&["--help"]).out;
    let verbs: Vec<&str> = help
        .lines()
        .skip_while(|l| !l.starts_with("Commands:"))
        .skip(1)
        .take_while(|l| l.starts_with("  "))
        .filter_map(|l| {
            l.strip_prefix("  ")?
                .split_whitespace()
                .next()
                .filter(|_| !l.starts_with("   "))
        })
        .collect();
    assert!(verbs.len() > 20, "{verbs:?}");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = ok(&["completions", shell]).out;
        let options = ["compare", "skip-unsupported"];
        // the others complete no choices
        let choices: &[&str] = match shell {
            "bash" | "zsh" | "fish" => &["parquet", "RADAU5"],
            _ => &[],
        };
        for word in verbs.iter().chain(&options).chain(choices) {
            assert!(text.contains(*word), "{shell}: {word}");
        }
    }
    let pages = folder.join("man1");
    let _ = std::fs::remove_dir_all(&pages);
    ok(&["man", "-o", path(&pages)]);
    // ours are replaced
    ok(&["man", "-o", path(&pages)]);
    for verb in &verbs {
        let page = std::fs::read_to_string(pages.join(format!("cognate-{verb}.1"))).unwrap();
        assert_eq!(page, ok(&["man", verb]).out);
        assert!(
            page.contains(".SH SYNOPSIS") || page.contains(".SH NAME"),
            "{page}"
        );
    }
    std::fs::write(pages.join("cognate-run.1"), "mine").unwrap();
    assert_eq!(cognate(&["man", "-o", path(&pages)]).code, 9);
    assert_eq!(
        std::fs::read_to_string(pages.join("cognate-run.1")).unwrap(),
        "mine"
    );
    let bash = scratch(
        "completions",
        "cognate.bash",
        &ok(&["completions", "bash"]).out,
    );
    if let Ok(checked) = Command::new("bash").args(["-n", path(&bash)]).status() {
        assert!(checked.success());
    }
}
