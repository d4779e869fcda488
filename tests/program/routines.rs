//! Routines of libraries, in C and in Fortran, against the same functions as expressions.

use crate::command::{cognate, ok, path, scratch};
use crate::needs;
use crate::repository::root;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Compiles a library into a folder; `None` where there is no compiler for it.
#[track_caller]
fn library(test: &str, source: &Path, name: &str) -> Option<PathBuf> {
    let is_c = source.extension().is_some_and(|e| e == "c");
    let compiler = if is_c { "cc" } else { "gfortran" };
    if !needs::runs(compiler, compiler, &["--version"]) {
        return None;
    }
    let file = scratch(test, name, "");
    let mut command = Command::new(compiler);
    command
        .args(["-shared", "-fPIC", "-o"])
        .arg(&file)
        .arg(source);
    if is_c {
        command.args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-I"]);
        command.arg(root("include"));
    }
    let done = command.output().unwrap();
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    Some(file)
}

/// The numbers of a table by their columns.
fn table(folder: &Path, name: &str) -> Vec<(String, Vec<f64>)> {
    let text = std::fs::read_to_string(folder.join(format!("{name}.csv"))).unwrap();
    let mut lines = text.lines();
    let names = lines.next().unwrap().split(',');
    let mut columns: Vec<_> = names.map(|name| (name.to_owned(), Vec::new())).collect();
    // the second line has the units
    for line in lines.skip(1) {
        let numbers = line.split(',').map(|x| x.parse::<f64>().unwrap());
        columns
            .iter_mut()
            .zip(numbers)
            .for_each(|(c, x)| c.1.push(x));
    }
    columns
}

/// Runs a model into a folder, and returns its table.
fn run(folder: &Path, name: &str, args: &[&str]) -> Vec<(String, Vec<f64>)> {
    let first = [
        "run",
        "--quiet",
        "--end",
        "5",
        "--steps",
        "200",
        "--out",
        path(folder),
        "--name",
        name,
    ];
    ok(&[&first, args].concat());
    table(folder, name)
}

/// The largest difference between columns of one name in two tables.
fn off(a: &[(String, Vec<f64>)], b: &[(String, Vec<f64>)]) -> f64 {
    let mut most: f64 = 0.0;
    for (name, values) in a {
        let Some((_, others)) = b.iter().find(|c| c.0 == *name) else {
            continue;
        };
        assert_eq!(values.len(), others.len(), "{name}");
        assert!(values.len() > 5, "{name}");
        for (x, y) in values.iter().zip(others) {
            most = most.max((x - y).abs());
        }
    }
    most
}

#[test]
fn a_pendulum_damped_by_routines_in_c_and_fortran_swings_as_by_an_expression() {
    let test = "routines_pendulum";
    let model = root("examples/routines/pendulum.adm");
    let text = std::fs::read_to_string(&model).unwrap();
    let text = text.replace("USER(0.4,21,1)", "-0.4*WZ(21,1)");
    let expression = scratch(test, "expression.adm", &text);
    let folder = expression.parent().unwrap();
    for method in ["DOP853", "RADAU5"] {
        let by = ["--method", method];
        let known = run(
            folder,
            "expression",
            &[&[path(&expression)], &by[..]].concat(),
        );
        for source in ["damper.c", "damper.f"] {
            let source = root("examples/routines").join(source);
            let Some(library) = library(test, &source, "damper.so") else {
                continue;
            };
            let routines = [path(&model), "--routines", path(&library)];
            let found = run(folder, "routine", &[&routines, &by[..]].concat());
            // the same numbers are computed from the same numbers; RADAU5 has its slopes by differences
            let most = off(&known, &found);
            assert!(most < 1e-9, "{method} {}: {most:e}", source.display());
        }
    }
}

#[test]
fn every_kind_of_routine_computes_what_an_expression_does() {
    let test = "routines_kinds";
    let data = root("tests/data/routines");
    let Some(library) = library(test, &data.join("all.c"), "all.so") else {
        return;
    };
    let folder = library.parent().unwrap();
    let known = run(folder, "known", &[path(&data.join("by_expressions.adm"))]);
    let model = data.join("by_routines.adm");
    let found = run(
        folder,
        "found",
        &[path(&model), "--routines", path(&library)],
    );
    let most = off(&known, &found);
    // a GSE is integrated with the mechanism, a DIFF beside it
    assert!(most < 1e-8, "{most:e}");
    let linear = [
        "linear",
        path(&model),
        "--routines",
        path(&library),
        "--out",
        path(folder),
    ];
    ok(&linear);
}

#[test]
fn the_library_that_routine_names_is_taken() {
    let test = "routines_named";
    let source = |c: f64| {
        let text = "#include \"cognate_routines.h\"\nadams_c_Sfosub Torque;\n\
            void Torque(const struct sAdamsSforce *f, double t, int d, int i, double *out) {\n\
            (void)t, (void)d, (void)i;\n*out = VALUE * f->PAR[0];\n}\n";
        text.replace("VALUE", &format!("{c:?}"))
    };
    let text = std::fs::read_to_string(root("examples/routines/pendulum.adm")).unwrap();
    let with = |name: &str, function: &str| {
        let text = text.replace("FUNCTION=USER(0.4,21,1)", function);
        scratch(test, name, &text)
    };
    let known = with("known.adm", "FUNCTION=0.8");
    let model = with("model.adm", "FUNCTION=USER(0.4)\\, ROUTINE=second::Torque");
    let sources = [
        scratch(test, "first.c", &source(7.0)),
        scratch(test, "second.c", &source(2.0)),
    ];
    let Some(first) = library(test, &sources[0], "first.so") else {
        return;
    };
    let Some(second) = library(test, &sources[1], "libsecond.so") else {
        return;
    };
    let folder = known.parent().unwrap();
    let known = run(folder, "a", &[path(&known)]);
    let given = ["--routines", path(&first), "--routines", path(&second)];
    let found = run(folder, "b", &[&[path(&model)], &given[..]].concat());
    assert_eq!(off(&known, &found), 0.0);
}

/// Runs the pendulum with another function and a library; returns what is told.
fn refused(test: &str, function: &str, args: &[&str]) -> (i32, String) {
    let text = std::fs::read_to_string(root("examples/routines/pendulum.adm")).unwrap();
    let model = text.replace("FUNCTION=USER(0.4,21,1)", function);
    let model = scratch(test, "model.adm", &model);
    let folder = model.parent().unwrap();
    let first = [
        "run",
        path(&model),
        "--quiet",
        "--end",
        "1",
        "--out",
        path(folder),
    ];
    let done = cognate(&[&first, args].concat());
    (done.code, done.err)
}

#[test]
fn what_a_routine_does_wrong_ends_the_run_with_its_name() {
    let test = "routines_odd";
    let Some(library) = library(test, &root("tests/data/routines/odd.f"), "odd.so") else {
        return;
    };
    for (entry, said) in [
        (
            "late",
            "its routine has asked for AZ(21, 1), but not in its first call",
        ),
        ("stops", "its routine says: half a second is enough"),
        ("nofun", "its routine says: there is no such function"),
        ("nan", "its routine has computed"),
        ("nomark", "MARKER/777"),
        ("absent", "no library has the routine odd::absent"),
    ] {
        let function = format!("FUNCTION=USER(1)\\, ROUTINE=odd::{entry}");
        let (code, err) = refused(test, &function, &["--routines", path(&library)]);
        assert_eq!(code, 4, "{entry}: {err}");
        assert!(
            err.contains(said) && err.contains("SFORCE/3"),
            "{entry}: {err}"
        );
        assert_eq!(err.contains("a message"), entry == "stops", "{err}");
    }
    let zero = ["--routines", path(&library), "--zero-user"];
    let (code, err) = refused(test, "FUNCTION=USER(1)\\, ROUTINE=odd::absent", &zero);
    assert_eq!(code, 0, "{err}");
}

#[test]
fn libraries_that_cannot_be_loaded_are_told() {
    let test = "routines_refused";
    let function = "FUNCTION=USER(1)";
    for (name, contents, said) in [
        ("routines.py", "def sfosub(): pass", "routines in Python"),
        ("text.so", "no library", "cannot be loaded"),
    ] {
        let file = scratch(test, name, contents);
        let (code, err) = refused(test, function, &["--routines", path(&file)]);
        assert_eq!(code, 3, "{err}");
        assert!(err.contains(said) && err.contains(name), "{err}");
    }
    let (code, err) = refused(test, function, &["--routines", "nowhere.so"]);
    assert!(
        code == 3 && err.contains("nowhere.so: cannot be opened"),
        "{err}"
    );
    let calls = "void akispl_(double *value);\nvoid sfosub_(double *value);\n\
        void sfosub_(double *value) { akispl_(value); }\n";
    let source = scratch(test, "calls.c", calls);
    if let Some(library) = library(test, &source, "calls.so") {
        let (code, err) = refused(test, function, &["--routines", path(&library)]);
        assert_eq!(code, 3, "{err}");
        assert!(
            err.contains("calls akispl_, which nobody has here"),
            "{err}"
        );
    }
}

#[test]
fn a_library_is_loaded_because_the_command_says_so_and_for_nothing_else() {
    let test = "routines_not_loaded";
    let mark = scratch(test, "mark", "");
    let text = "#include <stdio.h>\n__attribute__((constructor)) static void loaded(void) {\n\
        FILE *f = fopen(\"MARK\", \"w\");\nif (f) { fputs(\"loaded\", f); fclose(f); }\n}\n";
    let source = scratch(test, "forces.c", &text.replace("MARK", path(&mark)));
    let Some(library) = library(test, &source, "forces.so") else {
        return;
    };
    let function = format!("FUNCTION=USER(1)\\, ROUTINE={}::Sfosub", path(&library));
    let (code, err) = refused(test, &function, &[]);
    assert!(code == 4 && err.contains("--routines"), "{err}");
    assert_eq!(std::fs::read_to_string(&mark).unwrap(), "");
    let (code, err) = refused(test, &function, &["--routines", path(&library)]);
    assert!(
        code == 4 && err.contains("no library has the routine"),
        "{err}"
    );
    assert_eq!(std::fs::read_to_string(&mark).unwrap(), "loaded");
}

#[test]
fn routines_that_nobody_has_are_one_mistake_that_names_all_who_ask() {
    let test = "routines_many";
    let more = "FUNCTION=USER(1)\nSFORCE/4, I=21, J=1, ROTATION, FUNCTION=USER(2)\nVARIABLE/7, FUNCTION=USER(3)";
    let (code, err) = refused(test, more, &[]);
    assert_eq!(code, 4);
    assert_eq!(err.matches("error[").count(), 1, "{err}");
    for name in ["SFORCE/3", "SFORCE/4", "VARIABLE/7"] {
        assert!(err.contains(name), "{err}");
    }
}

#[test]
fn commands_about_routines_run() {
    let is_there = needs::runs("cc", "cc", &["--version"]);
    if !needs::runs("gfortran", "gfortran", &["--version"]) || !is_there {
        return;
    }
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("page_routines.md");
    let _ = std::fs::remove_dir_all(&folder);
    for of in ["examples/routines", "include"] {
        std::fs::create_dir_all(folder.join(of)).unwrap();
        for file in std::fs::read_dir(root(of)).unwrap().flatten() {
            std::fs::copy(file.path(), folder.join(of).join(file.file_name())).unwrap();
        }
    }
    crate::pages::runs_in(&folder, "routines.md");
}
