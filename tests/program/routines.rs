//! Routines of libraries in C and in Fortran, and of files in Python, against the same functions as expressions.

use crate::command::{cognate, ok, path, scratch};
use crate::needs;
use crate::repository::root;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Compiles a library into a folder; `None` where there is no compiler for it. What is written in Python is one as it
/// stands, where there is a Python.
#[track_caller]
fn library(test: &str, source: &Path, name: &str) -> Option<PathBuf> {
    if source.extension().is_some_and(|e| e == "py") {
        return needs::runs("python3", "python3", &["--version"]).then(|| source.to_owned());
    }
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
        for source in ["damper.c", "damper.f", "damper.py"] {
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
    let folder = scratch(test, "mark", "");
    let folder = folder.parent().unwrap();
    let known = run(folder, "known", &[path(&data.join("by_expressions.adm"))]);
    let model = data.join("by_routines.adm");
    for source in ["all.c", "all.py"] {
        let Some(library) = library(test, &data.join(source), "all.so") else {
            continue;
        };
        let routines = ["--routines", path(&library)];
        let found = run(folder, "found", &[&[path(&model)], &routines[..]].concat());
        let most = off(&known, &found);
        // a GSE is integrated with the mechanism, a DIFF beside it
        assert!(most < 1e-8, "{source} {most:e}");
        let linear = ["linear", path(&model), "--out", path(folder)];
        ok(&[&linear, &routines[..]].concat());
    }
}

/// Models of which each has a constraint or a contact by expressions, and by routines.
const BY_ROUTINES: [(&str, &str, &str); 3] = [
    (
        "PART/2, REULER=0.3,0,0, MASS=1, CM=20, IP=0.1,0.1,0.1, WZ=0.5\nMARKER/20, PART=2, QP=0,-1,0\nMARKER/21, PART=2\n\
         PART/3, QG=3,0,0, MASS=2, CM=30, IP=0.1,0.1,0.1\nMARKER/30, PART=3, QP=0,-1,0\nMARKER/31, PART=3\nMARKER/13, PART=1, QP=3,0,0\n\
         JOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=13\nREQUEST/1, F2=AZ(21,1)\\F3=AZ(31,13)\\F4=WDTZ(31,13)",
        "GCON/1, FUNCTION=AZ(31,13)+0.5*AZ(21,1)*AZ(31,13)-0.4*SIN(AZ(21,1))",
        "COUPLER/1, JOINTS=1,2, TYPE=R:R, FUNCTION=USER(0.4)",
    ),
    (
        "PART/3, MASS=0.5, CM=30, IP=1,1,1, QG=0.5,0,0, VY=2\nMARKER/30, PART=3\nMARKER/12, PART=1, FLOATING\n\
         JPRIM/1, ORIENTATION, I=30, J=1\nREQUEST/1, F2=DX(30,1)\\F3=DY(30,1)\\F4=ACCY(30)",
        "GCON/1, FUNCTION=DM(30,1)-0.5\nGCON/2, FUNCTION=DZ(30,1)",
        "CURVE/1, CLOSED, MINPAR=0, MAXPAR=6.283185307179586, FUNCTION=USER(0.5)\nPTCV/1, CURVE=1, I=30, RM=1, JFLOAT=12",
    ),
    (
        "PART/3, MASS=1, CM=30, IP=0.004,0.004,0.004, QG=0,0.4,0, VX=1, VZ=0.5, WX=3\nMARKER/30, PART=3\nMARKER/14, PART=1, REULER=0,-90D,0\n\
         GRAPHICS/1, ELLIPSOID, CM=30, XSCALE=0.2, YSCALE=0.2, ZSCALE=0.2\nGRAPHICS/2, PLANE, RM=14, XMIN=-99, XMAX=99, YMIN=-99, YMAX=99\n\
         REQUEST/1, F2=DX(30,1)\\F3=DY(30,1)\\F4=WZ(30,1)\\F6=DZ(30,1)",
        "CONTACT/1, IGEOM=1, JGEOM=2, IMPACT, STIFFNESS=1E5, EXPONENT=1.5, DAMPING=50, DMAX=0.001, COULOMB_FRICTION=ON, MU_STATIC=0.3, MU_DYNAMIC=0.2, STICTION_TRANSITION_VELOCITY=0.1, FRICTION_TRANSITION_VELOCITY=0.5",
        "CONTACT/1, IGEOM=1, JGEOM=2, FUNCTION=USER(1E5,1.5,50,0.001)\\, FRICTION_FUNCTION=USER(0.3,0.2,0.1,0.5)\\",
    ),
];

#[test]
fn constraints_and_contacts_by_routines_are_those_by_expressions() {
    let test = "routines_constraints";
    for (model, by_expressions, by_routines) in BY_ROUTINES {
        let with = |name: &str, rest: &str| {
            let head = "TEST\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\nPART/1, GROUND\nMARKER/1, PART=1\nACCGRAV/JGRAV=-9.80665";
            scratch(test, name, &format!("{head}\n{model}\n{rest}\nEND\n"))
        };
        let known = with("known.adm", by_expressions);
        let folder = known.parent().unwrap();
        let precise = ["--error", "1e-10"];
        let known = run(folder, "known", &[&[path(&known)], &precise[..]].concat());
        let model = with("model.adm", by_routines);
        for source in ["constraints.c", "constraints.f", "constraints.py"] {
            let source = root("tests/data/routines").join(source);
            let Some(library) = library(test, &source, "constraints.so") else {
                continue;
            };
            let routines = [path(&model), "--routines", path(&library)];
            let found = run(folder, "found", &[&routines, &precise[..]].concat());
            let most = off(&known, &found);
            // what hits the ground is as exact as the time of the first touch
            assert!(most < 1e-6, "{} {by_routines}: {most:e}", source.display());
        }
    }
}

#[test]
fn what_a_routine_in_python_does_wrong_is_told_with_its_line() {
    let test = "routines_odd_python";
    if !needs::runs("python3", "python3", &["--version"]) {
        return;
    }
    let text = "# a file of routines\n\
        def late(f, time, dflag, iflag):\n    return 0 if iflag else sysfnc('AZ', [21, 1])\n\
        def several(f, time, dflag, iflag):\n    return 1, 2\n\
        def nothing(f, time, dflag, iflag):\n    return sysfnc('WHATEVER', 1)\n\
        def stops(f, time, dflag, iflag):\n    print('to nobody')\n    usrmes(iflag, 'a message')\n    errmes(time > 0.5, 'half a second is enough')\n    return 0\n\
        def leaves(f, time, dflag, iflag):\n    import os\n    return 0 if iflag else os._exit(3)\n";
    let file = scratch(test, "odd.py", text);
    for (entry, said) in [
        (
            "late",
            "its routine has asked for AZ(21, 1), but not in its first call",
        ),
        ("several", "several returns 2 numbers; it needs 1"),
        (
            "nothing",
            "odd.py:7: ValueError: there is no function WHATEVER",
        ),
        ("stops", "its routine says: half a second is enough"),
        ("leaves", "Python has ended"),
        ("absent", "no library has the routine odd::absent"),
    ] {
        let function = format!("FUNCTION=USER(1)\\, ROUTINE=odd::{entry}");
        let (code, err) = refused(test, &function, &["--routines", path(&file)]);
        assert_eq!(code, 4, "{entry}: {err}");
        assert!(
            err.contains(said) && err.contains("SFORCE/3"),
            "{entry}: {err}"
        );
        assert_eq!(err.contains("a message"), entry == "stops", "{err}");
    }
    let raises = "def Sfosub(f, time, dflag, iflag):\n    return [0][int(time > 0.5)]\n";
    let file = scratch(test, "raises.py", raises);
    let (code, err) = refused(test, "FUNCTION=USER(1)", &["--routines", path(&file)]);
    let said = "raises.py:2: IndexError: ";
    assert!(code == 4 && err.contains(said), "{err}");
    // what cannot be loaded
    let file = scratch(test, "broken.py", "x = 1\ndef sfosub(:\n");
    let (code, err) = refused(test, "FUNCTION=USER(1)", &["--routines", path(&file)]);
    assert!(
        code == 3 && err.contains("broken.py:2: SyntaxError"),
        "{err}"
    );
}

#[test]
fn a_file_of_python_is_run_because_the_command_says_so_and_for_nothing_else() {
    let test = "routines_python_not_run";
    if !needs::runs("python3", "python3", &["--version"]) {
        return;
    }
    let mark = scratch(test, "mark", "");
    let text = format!("open({:?}, 'w').write('loaded')\n", path(&mark));
    let file = scratch(test, "forces.py", &text);
    let function = format!("FUNCTION=USER(1)\\, ROUTINE={}::Sfosub", path(&file));
    let (code, err) = refused(test, &function, &[]);
    assert!(code == 4 && err.contains("--routines"), "{err}");
    assert_eq!(std::fs::read_to_string(&mark).unwrap(), "");
    let (code, err) = refused(test, &function, &["--routines", path(&file)]);
    assert!(
        code == 4 && err.contains("no library has the routine"),
        "{err}"
    );
    assert_eq!(std::fs::read_to_string(&mark).unwrap(), "loaded");
    // another Python is named by a variable
    let done = std::process::Command::new(env!("CARGO_BIN_EXE_cognate"))
        .args([
            "run",
            path(&root("examples/routines/pendulum.adm")),
            "--end",
            "1",
        ])
        .args([
            "--routines",
            path(&file),
            "--out",
            path(file.parent().unwrap()),
        ])
        .env("COGNATE_PYTHON", "no_such_python")
        .output()
        .unwrap();
    let err = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(3), "{err}");
    assert!(err.contains("no_such_python cannot be started"), "{err}");
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

#[test]
fn sweeps_and_pictures_call_routines_as_runs_do() {
    let test = "routines_elsewhere";
    let model = root("examples/routines/pendulum.adm");
    let text = std::fs::read_to_string(&model).unwrap();
    let text = text.replace("USER(0.4,21,1)", "-0.4*WZ(21,1)");
    let expression = scratch(test, "expression.adm", &text);
    let folder = expression.parent().unwrap();
    let sweep = |model: &Path, name: &str, args: &[&str]| {
        let out = folder.join(name);
        let _ = std::fs::remove_file(&out);
        let first = [
            "sweep",
            path(model),
            "--quiet",
            "--end",
            "2",
            "--out",
            path(&out),
        ];
        let of = ["--set", "PART/2.MASS=1,2", "--measure", "last(AZ(21))"];
        ok(&[&first, &of[..], args].concat());
        let text = std::fs::read_to_string(&out).unwrap();
        let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let names = lines.next().unwrap();
        let column = names.iter().position(|n| n.contains("last(AZ(21))"));
        let column = column.unwrap_or_else(|| panic!("{text}"));
        let values = lines.filter_map(|line| line[column].parse().ok());
        values.collect::<Vec<f64>>()
    };
    let known = sweep(&expression, "known.csv", &[]);
    for source in ["damper.c", "damper.py"] {
        let source = root("examples/routines").join(source);
        let Some(library) = library(test, &source, "damper.so") else {
            continue;
        };
        let routines = ["--routines", path(&library)];
        let found = sweep(&model, "found.csv", &routines);
        assert_eq!((known.len(), found.len()), (2, 2), "{known:?} {found:?}");
        for (a, b) in known.iter().zip(&found) {
            assert!((a - b).abs() < 1e-9, "{known:?} {found:?}");
        }
        let page = folder.join("page.html");
        let animate = [
            "animate",
            path(&model),
            "--end",
            "1",
            "--out",
            path(&page),
            "--overwrite",
        ];
        ok(&[&animate, &routines[..]].concat());
        assert!(page.metadata().unwrap().len() > 10_000);
    }
}

#[test]
fn a_turbine_of_fast_spins_up_in_the_wind_of_a_routine() {
    let test = "routines_turbine";
    let Some(corpus) = needs::corpus() else {
        return;
    };
    let source = root("examples/routines/turbine.c");
    let Some(library) = library(test, &source, "turbine.so") else {
        return;
    };
    let folder = corpus.join("old-NWTC__FAST/CertTest/Old_Adams_files");
    let dataset = folder.join("Test13_ADAMS.adm");
    // the commands that come with it let go of all motions and joints that hold it; begun at half of its speed
    let commands = std::fs::read_to_string(folder.join("Test13_ADAMS.acf")).unwrap();
    let held = commands
        .lines()
        .filter(|line| line.starts_with("DEACTIVATE"));
    let held: Vec<&str> = held.collect();
    assert!(held.len() > 5, "{commands}");
    let commands = format!(
        "{}\nturbine\nMOTION/3150, VELOCITY, FUNCTION=1\nSIMULATE/DYNAMICS, END=0.005, DTOUT=0.005\n{}\n\
         SIMULATE/DYNAMICS, END=1, DTOUT=0.05\nSTOP\n",
        path(&dataset),
        held.join("\n")
    );
    let commands = scratch(test, "turbine.acf", &commands);
    let folder = commands.parent().unwrap();
    let speed = |args: &[&str]| {
        let first = [
            "run",
            path(&commands),
            "--quiet",
            "--no-accuracy",
            "--zero-user",
        ];
        let of = [
            "--column",
            "WZ(3150,2050,2050)",
            "--out",
            path(folder),
            "--name",
            "speed",
        ];
        ok(&[&first, &of[..], args].concat());
        let columns = table(folder, "speed");
        let (_, speed) = columns.iter().find(|c| c.0.contains("WZ")).unwrap();
        (speed[0], speed[speed.len() - 1])
    };
    let (begins, ends) = speed(&["--routines", path(&library)]);
    assert!((begins - 1.0).abs() < 1e-6, "{begins}");
    assert!(ends > 1.05 && ends < 1.5, "{ends}");
    let (_, without_wind) = speed(&[]);
    assert!(without_wind < ends - 0.04, "{without_wind} {ends}");
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

/// A script must not take a run that a routine has ended for one that is done.
#[test]
fn a_routine_that_ends_the_program_is_told_and_no_success() {
    let test = "routines_ending";
    let ends = "#include <stdlib.h>\nvoid sfosub_(void);\nvoid sfosub_(void) { exit(0); }\n";
    let source = scratch(test, "ends.c", ends);
    if let Some(library) = library(test, &source, "ends.so") {
        let (code, err) = refused(test, "FUNCTION=USER(1)", &["--routines", path(&library)]);
        assert_eq!(code, 6, "{err}");
        assert!(err.contains("has ended the program"), "{err}");
    }
}

#[test]
fn libraries_that_cannot_be_loaded_are_told() {
    let test = "routines_refused";
    let function = "FUNCTION=USER(1)";
    let file = scratch(test, "text.so", "no library");
    let (code, err) = refused(test, function, &["--routines", path(&file)]);
    assert_eq!(code, 3, "{err}");
    assert!(
        err.contains("cannot be loaded") && err.contains("text.so"),
        "{err}"
    );
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
    let all = ["cc", "gfortran", "python3"];
    if all
        .map(|p| needs::runs(p, p, &["--version"]))
        .contains(&false)
    {
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
