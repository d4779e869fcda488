//! Exchange with other programs: models and commands that they run, results that they wrote, and this program in the
//! place of an external solver.

use super::command::{cognate, ok, path, scratch};
use cognate::results;
use std::path::{Path, PathBuf};
use std::process::Command;

const MODEL: &str = "\
EXCHANGE
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
PART/1, GROUND
MARKER/1, PART=1
MARKER/11, PART=1, REULER=90D,90D,0D
PART/2, MASS=1, CM=20, IP=1,1,1, VX=3
MARKER/20, PART=2
SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=8
SFORCE/2, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=1
SFORCE/3, TRANSLATION, ACTIONONLY, I=20, J=11, FUNCTION=2*SFORCE(2,0,1,0)
ACCGRAV/KGRAV=-10
REQUEST/1, VELOCITY, I=20, J=1
REQUEST/2, F2=DX(20,1)\\F3=DZ(20,1)
END
";

/// A folder of this test with the model alone.
fn model(test: &str) -> PathBuf {
    let model = scratch(test, "m.adm", MODEL);
    let folder = model.parent().unwrap().to_owned();
    for entry in std::fs::read_dir(&folder).unwrap().flatten() {
        if entry.path() != model {
            let _ = std::fs::remove_file(entry.path());
            let _ = std::fs::remove_dir_all(entry.path());
        }
    }
    model
}

/// Largest difference of the columns of two runs of one table.
fn difference(a: &Path, b: &Path) -> f64 {
    let (a, b) = (results::read(a).unwrap(), results::read(b).unwrap());
    assert_eq!(a.rows(), b.rows());
    let mut most = 0.0_f64;
    for (x, y) in a.columns.iter().zip(&b.columns) {
        assert_eq!(x.name, y.name);
        most = x
            .values
            .iter()
            .zip(&y.values)
            .fold(most, |m, (x, y)| m.max((x - y).abs()));
    }
    most
}

#[test]
fn an_exported_model_with_its_commands_runs_as_the_model_does() {
    let model = model("export_runs");
    let folder = model.parent().unwrap();
    let commands = folder.join("m.acf");
    std::fs::write(&commands, "FILE/MODEL=m\nSFORCE/1, FUNCTION=4*TIME\nSIMULATE/DYNAMIC, END=0.5, STEPS=5\nDEACTIVATE/SFORCE, ID=1\nSIMULATE/DYNAMIC, END=1, STEPS=5\nSTOP\n").unwrap();
    let exchange = folder.join("exchange");
    ok(&[
        "export",
        path(&commands),
        "--name",
        "given",
        "--out",
        path(&exchange),
    ]);
    let dataset = std::fs::read_to_string(exchange.join("given.adm")).unwrap();
    assert!(dataset.contains("FUNCTION = 4*TIME"), "{dataset}");
    let acf = std::fs::read_to_string(exchange.join("given.acf")).unwrap();
    assert!(
        acf.starts_with("FILE/MODEL=given, OUTPUT_PREFIX=given\n") && acf.ends_with("STOP\n"),
        "{acf}"
    );
    assert!(!acf.contains("FUNCTION"), "{acf}");
    let out = folder.join("out");
    ok(&[
        "run",
        path(&commands),
        "--out",
        path(&out),
        "--format",
        "csv",
        "--body-motion",
    ]);
    ok(&[
        "run",
        path(&exchange.join("given.acf")),
        "--out",
        path(&out),
        "--format",
        "csv",
        "--body-motion",
    ]);
    assert_eq!(difference(&out.join("m.csv"), &out.join("given.csv")), 0.0);
}

#[test]
fn loads_that_do_not_act_are_not_exported_or_switched_off() {
    let model = model("export_loads");
    let folder = model.parent().unwrap().join("exchange");
    let exported = |loads: &str, name: &str| {
        let out = path(&folder);
        ok(&[
            "export",
            path(&model),
            "--loads",
            loads,
            "--end",
            "1",
            "--name",
            name,
            "--out",
            out,
        ]);
        ["adm", "acf"].map(|e| std::fs::read_to_string(folder.join(format!("{name}.{e}"))).unwrap())
    };
    let [adm, acf] = exported("gravity,SFORCE/2,SFORCE/3", "a");
    assert!(
        !adm.contains("SFORCE/1") && adm.contains("SFORCE/3") && !adm.contains("VX = 3"),
        "{adm}"
    );
    assert!(
        !acf.contains("DEACTIVATE") && acf.contains("SIMULATE/TRANSIENT, END=1"),
        "{acf}"
    );
    // SFORCE/3 reads SFORCE/2, which is kept and does not act
    let [adm, acf] = exported("SFORCE/3,SFORCE/1", "b");
    assert!(
        adm.contains("SFORCE/2") && !adm.contains("KGRAV = -10"),
        "{adm}"
    );
    assert!(acf.contains("DEACTIVATE/SFORCE, ID=2\n"), "{acf}");
    // in both ways it moves as with these loads
    let out = folder.join("out");
    ok(&[
        "run",
        path(&folder.join("b.acf")),
        "--out",
        path(&out),
        "--format",
        "csv",
    ]);
    ok(&[
        "run",
        path(&model),
        "--end",
        "1",
        "--loads",
        "SFORCE/1,SFORCE/3",
        "--out",
        path(&out),
        "--format",
        "csv",
    ]);
    assert!(difference(&out.join("m.csv"), &out.join("b.csv")) < 1e-12);
}

#[test]
fn nothing_is_overwritten_by_an_export() {
    let model = model("export_overwrites");
    let folder = model.parent().unwrap();
    let to = |name: &str, more: &[&str]| {
        cognate(
            &[
                &[
                    "export",
                    path(&model),
                    "--end",
                    "1",
                    "--name",
                    name,
                    "--out",
                    path(folder),
                ],
                more,
            ]
            .concat(),
        )
    };
    assert_eq!(to("m", &["--overwrite"]).code, 2);
    assert_eq!(std::fs::read_to_string(&model).unwrap(), MODEL);
    assert_eq!(to("copy", &[]).code, 0);
    // what an export wrote the next one replaces, and keeps
    assert_eq!(to("copy", &[]).code, 0);
    assert!(folder.join("copy.adm~").exists());
    std::fs::write(folder.join("copy.adm"), "somebody's").unwrap();
    let done = to("copy", &[]);
    assert!(
        done.code == 2 && done.err.contains("is there already"),
        "{}",
        done.err
    );
    assert_eq!(to("copy", &["--overwrite"]).code, 0);
}

#[test]
fn requests_of_a_req_file_and_steps_of_a_log_are_read_as_tables() {
    let model = model("exchange_req");
    let out = model.with_file_name("out");
    ok(&[
        "run",
        path(&model),
        "--end",
        "1",
        "--steps",
        "4",
        "--error",
        "1e-9",
        "--out",
        path(&out),
        "--format",
        "csv,req",
    ]);
    let req = results::read(&out.join("m.req")).unwrap();
    assert_eq!(req.title, "EXCHANGE");
    let last = |name: &str| {
        *req.column(name)
            .unwrap_or_else(|| panic!("{name}"))
            .last()
            .unwrap()
    };
    // vx = 3 + 11 t, vz = −10 t
    assert!(
        (last("REQUEST_1.VX") - 14.0).abs() < 1e-4 && (last("REQUEST_1.VZ") + 10.0).abs() < 1e-4
    );
    assert!((last("REQUEST_1.MAG") - 14f64.hypot(10.0)).abs() < 1e-3);
    assert!((last("REQUEST_2.F3") + 5.0).abs() < 1e-4);
    let compared = ok(&[
        "runs",
        "compare",
        path(&out.join("m.req")),
        path(&out.join("m.req")),
        "--tolerance",
        "1e-9",
    ]);
    assert!(compared.err.starts_with("0 of "), "{}", compared.err);
    let log = "\
  Begin Simulation

  ****** Performing Dynamic Simulation using Gstiff I3 Integrator ******

   Simulation      Step        Function    Cumulative   Integration     CPU
      Time         Size       Evaluations  Steps Taken    Order        time
   ___________  ___________   ___________  ___________   _________    ________
   0.00000E+00  2.50000E-04            0            0       1            2.33
   5.00000E-03  2.12500E-03            5            5       2            1:02.50

  End Simulation
";
    let log = scratch("exchange_req", "other.msg", log);
    ok(&["plot", path(&log), "--y", "step size"]);
    let steps = results::read(&log).unwrap();
    assert_eq!(steps.column("processor time"), Some(&[2.33, 62.5][..]));
    // a log of ours without a table says so
    let none = cognate(&["plot", path(&out.join("m.msg"))]);
    assert!(
        none.code == 3 && none.err.contains("no table of steps"),
        "{}",
        none.err
    );
}

/// A program that wants its model solved by the installation that a variable of the environment names, as I-DEAS does.
#[cfg(unix)]
#[test]
fn a_program_that_calls_an_external_solver_gets_its_results_from_this_one() {
    let model = model("exchange_mdi");
    let folder = model.parent().unwrap();
    let solver = folder.join("solver");
    ok(&["mdi", "--install", path(&solver)]);
    ok(&[
        "export",
        path(&model),
        "--loads",
        "gravity,SFORCE/1",
        "--end",
        "1",
        "--steps",
        "4",
        "--name",
        "job",
        "--out",
        path(folder),
    ]);
    let script = "\"$SDRC_ADAMS_SOLVER/mdi\" -c ru-standard i job.acf exit || exit 1\n";
    let ran = |text: &str, name: &str| {
        let done = Command::new("sh")
            .args(["-c", text])
            .env("SDRC_ADAMS_SOLVER", &solver)
            .current_dir(folder)
            .output()
            .unwrap();
        assert!(
            done.status.success(),
            "{}",
            String::from_utf8_lossy(&done.stderr)
        );
        results::read(&folder.join(name)).unwrap()
    };
    let run = ran(script, "job.res");
    let last = |name: &str| {
        *run.column(name)
            .unwrap_or_else(|| panic!("{name}"))
            .last()
            .unwrap()
    };
    assert!(
        (last("PART_2_XFORM.X") - 4.0).abs() < 1e-3 && (last("PART_2_XFORM.Z") + 5.0).abs() < 1e-3
    );
    for name in ["job.req", "job.gra", "job.msg"] {
        assert!(folder.join(name).is_file(), "{name}");
    }
    // again, with commands from standard input
    let run = ran("\"$SDRC_ADAMS_SOLVER/mdi\" -c ru-st i < job.acf", "job.res");
    assert_eq!(
        run.rows(),
        results::read(&folder.join("job.res")).unwrap().rows()
    );
    // a script of somebody else is not replaced
    std::fs::write(solver.join("mdi"), "#!/bin/sh\necho theirs\n").unwrap();
    assert_eq!(cognate(&["mdi", "--install", path(&solver)]).code, 2);
}

#[test]
fn a_dataset_is_exported_without_saying_when_a_simulation_ends() {
    let model = model("export_without_end");
    let folder = model.with_file_name("out");
    let _ = std::fs::remove_dir_all(&folder);
    let done = ok(&["export", path(&model), "-o", path(&folder), "--name", "it"]);
    assert!(
        done.err.contains("the commands hold no simulation"),
        "{}",
        done.err
    );
    let commands = std::fs::read_to_string(folder.join("it.acf")).unwrap();
    assert!(!commands.to_uppercase().contains("SIMULATE"), "{commands}");
    ok(&[
        "check",
        path(&folder.join("it.adm")),
        path(&folder.join("it.acf")),
    ]);
}
