//! What the user had is never lost, and nothing lands where it was not sent: all commands that write
//! beside all that can stand in their way; names in command files; results that are cut off; little
//! memory, no threads, no end of input.

use crate::command::{Done, cognate, cognate_with, ok, path, scratch};
use cognate::results::{self, Run};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const MODEL: &str = "a pendulum
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
PART/1, GROUND
MARKER/1, PART=1
PART/2, MASS=1, CM=4, IP=0.1,0.1,0.1, QG=1,0,0
MARKER/3, PART=2, QP=-1,0,0
MARKER/4, PART=2
JOINT/1, REVOLUTE, I=3, J=1
GRAPHICS/1, CYLINDER, CM=3, LENGTH=1, RADIUS=0.1
ACCGRAV/JGRAV=-9.81
REQUEST/1, DISPLACEMENT, I=4, J=1
RESULTS/
END
";
const COMMANDS: &str =
    "FILE/MODEL=m, OUTPUT_PREFIX=m\nSIMULATE/DYNAMIC, END=0.1, STEPS=4\nLINEAR/EIGENSOL\nSTOP\n";

/// A folder with inputs: a model, its commands, results of it in `in/`.
fn inputs(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = std::fs::remove_dir_all(&folder);
    let model = scratch(test, "m.adm", MODEL);
    scratch(test, "m.acf", COMMANDS);
    let results = folder.join("in");
    let formats = "csv,res";
    ok(&[
        "run",
        path(&folder.join("m.acf")),
        "--out",
        path(&results),
        "--format",
        formats,
        "--quiet",
    ]);
    assert!(model.exists());
    folder
}

/// A command that writes: its words, `@` for the place of its file; the name that it gives the file;
/// an input of it with the ending of that file, where there is one.
struct Writer {
    words: &'static str,
    file: &'static str,
    input: Option<&'static str>,
    said: &'static str,
}

const fn writer(words: &'static str, file: &'static str, input: Option<&'static str>) -> Writer {
    Writer {
        words,
        file,
        input,
        said: "",
    }
}

const WRITERS: [Writer; 18] = [
    writer("run m.acf --quiet --out @", "m.csv", None),
    writer("run m.acf --quiet --out @", "m_linear.json", None),
    writer("convert in/m.csv @", "t.csv", Some("in/m.csv")),
    writer("convert in/m.csv @", "t.json", None),
    writer("draw m.adm -o @", "t.svg", None),
    writer("draw m.adm -o @", "t.pdf", None),
    writer("plot in/m.csv --y REQUEST_1.DX --out @", "t.png", None),
    writer("animate m.adm --end 0.1 --steps 2 -o @", "t.html", None),
    writer("animate m.adm --end 0.1 --steps 2 -o @", "t.glb", None),
    writer("configuration m.acf --at 0.05 -o @", "t.adm", Some("m.adm")),
    writer("export m.acf --name t -o @", "t.adm", None),
    writer("linear m.adm -o @", "m_linear.json", None),
    writer(
        "sweep m.acf --set PART/2.MASS=1,2 --measure max(REQUEST_1.DX) --out @ --quiet",
        "t.csv",
        None,
    ),
    writer("fmt m.adm -o @", "t.adm", Some("m.adm")),
    writer(
        "elements m.adm --rename PART/2=rod -o @",
        "t.adm",
        Some("m.adm"),
    ),
    writer(
        "motion in/m.res --of MARKER/4 --relative-to MARKER/1 --out @",
        "t.csv",
        Some("in/m.res"),
    ),
    writer("eval TIME --time 0:1:0.5 --plot @", "t.svg", None),
    writer("statements --model cam --out @", "cam.adm", None),
];

/// Runs a writer in a folder of inputs; its file goes to `place`.
fn write(folder: &Path, writer: &Writer, place: &Path, more: &[&str]) -> Done {
    let takes_folder = writer.words.contains("--out @") && writer.words.starts_with("run")
        || ["export", "linear", "statements"]
            .iter()
            .any(|verb| writer.words.starts_with(verb));
    let target = if takes_folder {
        place.parent().unwrap()
    } else {
        place
    };
    let inside = |word: &str| match word {
        "@" => path(target).to_owned(),
        word if word.starts_with("m.") || word.starts_with("in/") => {
            path(&folder.join(word)).to_owned()
        }
        word => word.to_owned(),
    };
    let words: Vec<String> = writer.words.split(' ').map(inside).collect();
    let mut words: Vec<&str> = words.iter().map(String::as_str).collect();
    words.extend(more);
    cognate(&words)
}

/// Returns all files below a folder with their bytes.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let file = entry.unwrap().path();
        match file.is_dir() {
            true => found.extend(contents(&file)),
            false => drop(found.insert(file.clone(), std::fs::read(&file).unwrap())),
        }
    }
    found
}

/// Asserts that everything that was there is there, byte by byte.
fn assert_kept(before: &BTreeMap<PathBuf, Vec<u8>>, folder: &Path, what: &str) {
    let after = contents(folder);
    for (file, bytes) in before {
        assert_eq!(after.get(file), Some(bytes), "{what}: {}", file.display());
    }
}

fn named(file: &Path, more: &str) -> PathBuf {
    PathBuf::from(format!("{}{more}", path(file)))
}

#[test]
fn no_command_changes_a_byte_of_what_somebody_else_wrote() {
    let folder = inputs("disk_others");
    for (k, writer) in WRITERS.iter().enumerate() {
        let out = folder.join(format!("out{k}"));
        std::fs::create_dir(&out).unwrap();
        let place = out.join(writer.file);
        let what = writer.words;
        // somebody's
        std::fs::write(&place, "somebody's").unwrap();
        let before = contents(&folder);
        let done = write(&folder, writer, &place, &[]);
        assert_eq!(done.code, 2, "{what}: {}", done.err);
        assert!(
            done.err.contains("--overwrite") && done.err.contains(writer.said),
            "{}",
            done.err
        );
        assert_kept(&before, &folder, what);
        // with leave it is kept beside
        let done = write(&folder, writer, &place, &["--overwrite"]);
        assert_eq!(done.code, 0, "{what}: {}", done.err);
        assert_eq!(
            std::fs::read(named(&place, "~")).unwrap(),
            b"somebody's",
            "{what}"
        );
        assert_ne!(std::fs::read(&place).unwrap(), b"somebody's", "{what}");
        // what was changed is somebody's; a sweep goes on with its table
        if what.starts_with("sweep") {
            continue;
        }
        let ours = std::fs::read(&place).unwrap();
        std::fs::write(&place, [&ours[..], b" "].concat()).unwrap();
        let before = contents(&folder);
        let done = write(&folder, writer, &place, &[]);
        assert_eq!(done.code, 2, "{what}, changed: {}", done.err);
        assert_kept(&before, &folder, what);
    }
}

#[test]
fn what_a_command_wrote_it_replaces_and_keeps_once() {
    let folder = inputs("disk_ours");
    for (k, writer) in WRITERS.iter().enumerate() {
        let what = writer.words;
        let out = folder.join(format!("out{k}"));
        std::fs::create_dir(&out).unwrap();
        let place = out.join(writer.file);
        for _ in 0..3 {
            let done = write(&folder, writer, &place, &[]);
            assert_eq!(done.code, 0, "{what}: {}", done.err);
        }
        // a sweep that is complete has nothing to write
        if !what.starts_with("sweep") {
            assert!(named(&place, "~").exists(), "{what}");
        }
        assert!(!named(&place, "~2").exists(), "{what}");
        let parts = contents(&out)
            .into_keys()
            .filter(|file| path(file).contains(".part"));
        assert_eq!(parts.count(), 0, "{what}");
    }
}

#[cfg(unix)]
#[test]
fn an_input_is_never_replaced_through_whatever_link() {
    let folder = inputs("disk_inputs");
    for (k, writer) in WRITERS.iter().enumerate() {
        let Some(input) = writer.input else {
            continue;
        };
        let input = folder.join(input);
        let out = folder.join(format!("out{k}"));
        std::fs::create_dir(&out).unwrap();
        let ending = input.extension().unwrap().to_str().unwrap();
        let place = |name: &str| out.join(format!("{name}.{ending}"));
        std::os::unix::fs::symlink(&input, place("soft")).unwrap();
        std::fs::hard_link(&input, place("hard")).unwrap();
        let before = contents(&folder);
        for place in [input.clone(), place("soft"), place("hard")] {
            for more in [&[][..], &["--overwrite"]] {
                let done = write(&folder, writer, &place, more);
                assert_eq!(
                    done.code,
                    2,
                    "{} {}: {}",
                    writer.words,
                    place.display(),
                    done.err
                );
                assert!(done.err.contains("never overwritten"), "{}", done.err);
                assert_kept(&before, &folder, writer.words);
            }
        }
    }
}

#[test]
fn an_input_that_another_file_names_is_never_replaced() {
    let folder = inputs("disk_named");
    let before = contents(&folder);
    // the dataset that the commands name, and the commands that a command file calls
    scratch(
        "disk_named",
        "calls.acf",
        "FILE/MODEL=m\nFILE/COMMAND=called.acf\nSTOP\n",
    );
    scratch(
        "disk_named",
        "called.acf",
        "SIMULATE/DYNAMIC, END=0.1, STEPS=2\n",
    );
    let [calls, called, model] = ["calls.acf", "called.acf", "m.adm"].map(|name| folder.join(name));
    for (out, more) in [(&model, None), (&folder.join("later.adm"), Some(&called))] {
        let mut words = vec![
            "configuration",
            path(&calls),
            "--at",
            "0.05",
            "--overwrite",
            "-o",
            path(out),
        ];
        if let Some(commands) = more {
            words.extend(["--commands", path(commands)]);
        }
        let done = cognate(&words);
        assert_eq!(done.code, 2, "{}", done.err);
        assert!(done.err.contains("never overwritten"), "{}", done.err);
    }
    assert_kept(&before, &folder, "configuration");
}

#[test]
fn a_folder_in_the_way_stays() {
    let folder = inputs("disk_folder");
    for (k, writer) in WRITERS.iter().enumerate() {
        let place = folder.join(format!("out{k}")).join(writer.file);
        std::fs::create_dir_all(&place).unwrap();
        std::fs::write(place.join("note"), "somebody's").unwrap();
        let before = contents(&folder);
        let done = write(&folder, writer, &place, &["--overwrite"]);
        assert_ne!(done.code, 0, "{}: {}", writer.words, done.err);
        assert!(!done.err.contains("[bug]"), "{}", done.err);
        assert_kept(&before, &folder, writer.words);
    }
}

#[test]
fn names_in_command_files_stay_in_the_folder_of_the_results() {
    let folder = inputs("disk_inside");
    let deep = folder.join("home/work/results");
    std::fs::create_dir_all(&deep).unwrap();
    let absolute = folder.join("home/elsewhere");
    for (k, prefix) in ["../../settings", path(&absolute), r"C:\work\settings", ".."]
        .iter()
        .enumerate()
    {
        for argument in ["prefix", "linear"] {
            let commands = match argument {
                "prefix" => format!(
                    "FILE/MODEL=m, OUTPUT_PREFIX={prefix}\nSIMULATE/DYNAMIC, END=0.1, STEPS=4\nSTOP\n"
                ),
                _ => {
                    format!("FILE/MODEL=m\nSIMULATE/STATIC\nLINEAR/STATEMAT, FILE={prefix}\nSTOP\n")
                }
            };
            let file = scratch("disk_inside", &format!("{argument}{k}.acf"), &commands);
            std::fs::write(folder.join("home/settings.json"), "somebody's").unwrap();
            let before = contents(&folder);
            let done = cognate(&["run", path(&file), "--out", path(&deep)]);
            assert_eq!(done.code, 0, "{prefix}: {}", done.err);
            assert!(
                done.err.contains("leads out of the folder") && done.err.contains("--trust-paths"),
                "{prefix}: {}",
                done.err
            );
            assert!(
                done.err.contains(&format!("{argument}{k}.acf")),
                "the place: {}",
                done.err
            );
            assert_kept(&before, &folder, prefix);
            let new = contents(&folder)
                .into_keys()
                .filter(|file| !before.contains_key(file));
            for file in new {
                assert!(file.starts_with(&deep), "{prefix}: {}", file.display());
            }
            std::fs::remove_dir_all(&deep).unwrap();
            std::fs::create_dir_all(&deep).unwrap();
        }
    }
    // who trusts the file gets what it says
    let commands = "FILE/MODEL=m, OUTPUT_PREFIX=../beside\nSIMULATE/STATIC\nSTOP\n";
    let file = scratch("disk_inside", "trusted.acf", commands);
    ok(&["run", path(&file), "--out", path(&deep), "--trust-paths"]);
    assert!(folder.join("home/work/beside.csv").exists());
}

/// Reads a file of results; `None` where it says that it has no row.
fn rows_of(file: &Path) -> Option<Run> {
    match results::read(file) {
        Ok(run) => Some(run),
        Err(d) => {
            let said = d.to_string();
            assert!(
                said.contains("ends before its first row"),
                "{}: {said}",
                file.display()
            );
            None
        }
    }
}

#[test]
fn a_file_of_results_that_is_cut_at_any_byte_is_a_beginning_of_its_rows() {
    let folder = inputs("disk_cut");
    let whole = folder.join("whole");
    let model = scratch("disk_cut", "é.adm", MODEL);
    let formats = "csv,res,json,gra,req,parquet";
    ok(&[
        "run",
        path(&model),
        "--end",
        "1",
        "--steps",
        "6",
        "--format",
        formats,
        "--out",
        path(&whole),
        "--name",
        "w",
        "--quiet",
    ]);
    for name in [
        "w.csv",
        "w.res",
        "w.table.json",
        "w.gra",
        "w.req",
        "w.parquet",
    ] {
        let bytes = std::fs::read(whole.join(name)).unwrap();
        let all = results::read(&whole.join(name)).unwrap();
        assert!(all.rows() >= 6, "{name}");
        assert!(
            all.record.doubts.is_empty(),
            "{name}: {:?}",
            all.record.doubts
        );
        let cut = folder.join(name);
        let mut most = 0;
        let step = (bytes.len() / 1500).max(1);
        let ends = (0..bytes.len())
            .step_by(step)
            .chain(bytes.len().saturating_sub(200)..bytes.len());
        for end in ends {
            std::fs::write(&cut, &bytes[..end]).unwrap();
            let Some(run) = rows_of(&cut) else {
                continue;
            };
            most = most.max(run.rows());
            assert!(run.rows() <= all.rows(), "{name} {end}");
            if run.rows() > 0 {
                assert_eq!(run.columns.len(), all.columns.len(), "{name} cut at {end}");
            }
            for (column, of) in run
                .columns
                .iter()
                .zip(&all.columns)
                .filter(|_| run.rows() > 0)
            {
                let bits = |x: &f64| x.to_bits();
                assert!(
                    column
                        .values
                        .iter()
                        .map(bits)
                        .eq(of.values.iter().take(run.rows()).map(bits)),
                    "{name} cut at {end}, {}",
                    of.name
                );
            }
        }
        if name != "w.parquet" {
            assert!(most + 1 >= all.rows(), "{name}: {most} of {}", all.rows());
        }
    }
}

#[test]
fn that_a_file_was_cut_off_is_said() {
    let folder = inputs("disk_cut_said");
    let table = std::fs::read(folder.join("in/m.csv")).unwrap();
    let cut = folder.join("cut.csv");
    std::fs::write(&cut, &table[..table.len() - 3]).unwrap();
    let done = ok(&["convert", path(&cut), path(&folder.join("rows.csv"))]);
    assert!(
        done.err.contains("cut_off") && done.err.contains("cut.csv"),
        "{}",
        done.err
    );
    assert!(done.err.contains("whole rows"), "{}", done.err);
    let done = ok(&["plot", path(&cut), "--list"]);
    assert!(done.err.contains("cut_off"), "{}", done.err);
}

#[test]
fn names_that_look_like_formulas_come_back_and_are_none_for_a_spreadsheet() {
    let names = [
        "=1+1", "+x", "-DX(1,2)", "@SUM(A1)", "'=x", "\tt", "\rr", "'plain", "-", "''-1",
    ];
    let folder = inputs("disk_formulas");
    let mut run = Run::new("r", "t", results::Units::default());
    for name in names {
        run.add_column(name, "");
    }
    run.begin(results::Kind::Dynamic);
    run.push(&[0.5; 11]);
    run.end();
    for decimal_comma in [false, true] {
        let file = folder.join("formulas.csv");
        let style = results::format::Style {
            decimal_comma,
            ..Default::default()
        };
        results::write(&run, &file, style).unwrap();
        let text = std::fs::read_to_string(&file).unwrap();
        let ends = ['\n', '"', char::from(style.separator())];
        for cell in text.split(ends).filter(|cell| *cell != "-") {
            assert!(
                !cell.starts_with(['=', '+', '-', '@', '\t', '\r']),
                "{cell:?}"
            );
        }
        let back = results::read(&file).unwrap();
        let read: Vec<&str> = back.columns[1..].iter().map(|c| c.name.as_str()).collect();
        assert_eq!(read, names);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_input_without_an_end_is_refused() {
    let done = cognate(&["check", "/dev/zero"]);
    assert_eq!(done.code, 3, "{}", done.err);
    assert!(
        done.err.contains("more than") && done.err.contains("MB"),
        "{}",
        done.err
    );
}

#[test]
fn an_expression_that_is_too_long_is_refused_at_the_prompt() {
    let text = format!("{}1\n", "1+".repeat(1_000_000));
    let done = cognate_with(&["repl"], &text);
    assert!(
        done.err.contains("VARIABLEs"),
        "{}",
        &done.err[done.err.len().saturating_sub(500)..]
    );
}

/// Runs the program under limits of a shell; `None` where there is no such shell.
#[cfg(target_os = "linux")]
fn limited(limit: &str, words: &[&str]) -> Done {
    let script = format!("{limit}; exec \"$@\"");
    let output = std::process::Command::new("sh")
        .args(["-c", &script, "sh", env!("CARGO_BIN_EXE_cognate")])
        .args(words)
        .output()
        .unwrap();
    Done {
        code: output.status.code().unwrap_or(-1),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_run_that_fits_into_little_memory_fits_into_more() {
    let folder = inputs("disk_memory");
    let out = folder.join("out");
    let words = [
        "run",
        path(&folder.join("m.acf")).to_owned().leak(),
        "--out",
        path(&out).to_owned().leak(),
        "--quiet",
    ];
    let mut fits = false;
    for megabytes in [80, 120, 160, 200, 240, 280, 290, 295, 300, 305, 320, 400] {
        let done = limited(&format!("ulimit -v {}", megabytes * 1000), &words);
        assert!(
            done.code == 0 || !fits,
            "{megabytes} MB: {} {}",
            done.code,
            done.err
        );
        assert!(
            !done.err.contains("panicked"),
            "{megabytes} MB: {}",
            done.err
        );
        fits |= done.code == 0;
    }
    assert!(fits);
}

/// Where a user has no process left, no thread can be had either. A user of this system is taken
/// whom nobody else needs; without leave to become one this says nothing.
#[cfg(target_os = "linux")]
#[test]
fn a_run_without_threads_runs_and_says_so() {
    use std::os::unix::fs::PermissionsExt;
    let folder = inputs("disk_threads");
    std::fs::set_permissions(&folder, PermissionsExt::from_mode(0o777)).unwrap();
    let out = folder.join("out");
    let words = [
        "--reuid",
        "54321",
        "--clear-groups",
        "prlimit",
        "--nproc=1",
        env!("CARGO_BIN_EXE_cognate"),
        "run",
        path(&folder.join("m.acf")),
        "--out",
        path(&out),
    ]
    .map(str::to_owned);
    let Ok(output) = std::process::Command::new("setpriv").args(words).output() else {
        println!("skipped: there is no setpriv");
        return;
    };
    let err = String::from_utf8_lossy(&output.stderr);
    if err.contains("setpriv") || err.contains("prlimit") || err.contains("Permission denied") {
        println!("skipped: {err}");
        return;
    }
    assert_eq!(output.status.code(), Some(0), "{err}");
    assert!(err.contains("no thread can be had"), "{err}");
    assert!(out.join("m.csv").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn names_that_are_no_utf8_come_back_as_they_were() {
    use std::os::unix::ffi::OsStrExt;
    let folder = inputs("disk_bytes");
    let name = |bytes: &[u8]| folder.join(std::ffi::OsStr::from_bytes(bytes));
    let model = name(b"caf\xe9.adm");
    std::fs::write(&model, MODEL).unwrap();
    let out = folder.join("out");
    let run = |words: &[&std::ffi::OsStr]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_cognate"));
        command.args(words).output().unwrap()
    };
    let os = std::ffi::OsStr::new;
    let words = ["--end", "0.1", "--steps", "2", "--out"].map(os);
    let done = run(&[
        &[os("run"), model.as_os_str()],
        &words[..],
        &[out.as_os_str()],
    ]
    .concat());
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    let table = out.join(std::ffi::OsStr::from_bytes(b"caf\xe9.csv"));
    assert!(
        table.exists()
            && out
                .join(std::ffi::OsStr::from_bytes(b"caf\xe9.json"))
                .exists()
    );
    let has = |text: &[u8], part: &[u8]| text.windows(part.len()).any(|w| w == part);
    assert!(
        has(&done.stderr, b"caf\xe9.csv"),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    // by its record the model is found again, and the run is known as ours
    let done = run(&[os("motion"), table.with_extension("csv").as_os_str()]);
    assert!(!has(&done.stderr, "\u{fffd}".as_bytes()));
    let done = run(&[
        &[os("run"), model.as_os_str()],
        &words[..],
        &[out.as_os_str()],
    ]
    .concat());
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    let gone = folder
        .join("out")
        .join(std::ffi::OsStr::from_bytes(b"caf\xe9"));
    let done = run(&[os("runs"), os("delete"), gone.as_os_str(), os("--yes")]);
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    assert!(
        contents(&out).is_empty(),
        "{:?}",
        contents(&out).into_keys()
    );
    // a mistake is shown with its line
    let bad = name(b"b\xe4d.adm");
    std::fs::write(&bad, MODEL.replace("PART=2", "PRT=2")).unwrap();
    let done = run(&[os("check"), bad.as_os_str()]);
    assert!(
        has(&done.stderr, b"b\xe4d.adm:") && has(&done.stderr, b"PRT"),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
}
