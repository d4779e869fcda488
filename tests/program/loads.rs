//! Load cases, functions of the user's and set-ups: what acts in a run, and the file that keeps them.

use super::command::{Done, cognate, ok, path, scratch};
use cognate::results::{self, Run};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A bar on a hinge whose axis is z, and a mass that is thrown along x: loads that do not touch each other.
const MODEL: &str = "\
LOADS
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
PART/1, GROUND
MARKER/1, PART=1
MARKER/10, PART=1
PART/2, MASS=1, CM=20, IP=1,1,1
MARKER/20, PART=2
MARKER/21, PART=2
JOINT/1, REVOLUTE, I=21, J=10
! adams_view_name='drive'
MOTION/1, JOINT=1, ROTATION, FUNCTION=TIME
PART/3, MASS=2, CM=30, IP=1,1,1, VX=3
MARKER/30, PART=3
SFORCE/1, TRANSLATION, ACTIONONLY, I=30, J=11, FUNCTION=8
MARKER/11, PART=1, REULER=90D,90D,0D
VFORCE/1, I=30, JFLOAT=12, RM=1, FX=0\\FY=6\\FZ=0
MARKER/12, PART=1, FLOATING
ACCGRAV/KGRAV=-10
REQUEST/1, F2=AZ(21,10)\\F3=DX(30,1)\\F4=DY(30,1)\\F6=DZ(30,1)
END
";

/// The model in a folder of this test, without a file beside it.
fn model(test: &str) -> PathBuf {
    let model = scratch(test, "m.adm", MODEL);
    let _ = std::fs::remove_file(model.with_extension("toml"));
    let _ = std::fs::remove_dir_all(out(&model));
    model
}

fn out(model: &Path) -> PathBuf {
    model.with_file_name("out")
}

fn toml(model: &Path) -> String {
    std::fs::read_to_string(model.with_extension("toml")).unwrap_or_default()
}

fn write_toml(model: &Path, text: &str) {
    std::fs::write(model.with_extension("toml"), text).unwrap();
}

/// Runs to one second, with further words; returns the results.
fn ran(model: &Path, more: &[&str]) -> (Run, Done) {
    let folder = out(model);
    let args = [
        "run",
        path(model),
        "--end",
        "1",
        "--steps",
        "10",
        "--error",
        "1e-9",
        "--out",
        path(&folder),
    ];
    let done = ok(&[&args, more].concat());
    (results::read(&folder.join("m.csv")).unwrap(), done)
}

/// Last values of the four components of the request: angle, x, y, z.
fn last(run: &Run) -> [f64; 4] {
    let columns = run.table_columns();
    [1, 2, 3, 4].map(|k| *run.columns[columns[k]].values.last().unwrap())
}

fn near(found: [f64; 4], expected: [f64; 4]) {
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 1e-6, "{found:?}, expected {expected:?}");
    }
}

/// All loads: angle t; x = 3t + 8/2 t²/2; y = 6/2 t²/2; z = −10 t²/2. The force along z of MARKER/11, which is x.
const ALL: [f64; 4] = [1.0, 5.0, 1.5, -5.0];

#[test]
fn without_a_choice_all_loads_act_and_no_file_is_written() {
    let model = model("loads_all");
    let (run, _) = ran(&model, &[]);
    near(last(&run), ALL);
    assert!(toml(&model).is_empty());
    let record = std::fs::read_to_string(out(&model).join("m.json")).unwrap();
    let record: Value = serde_json::from_str(&record).unwrap();
    assert!(record["loads"].is_null());
}

#[test]
fn loads_that_are_chosen_act_alone_and_stay_chosen_until_others_are() {
    let model = model("loads_chosen");
    let (run, done) = ran(&model, &["--loads", "gravity,SFORCE/1"]);
    near(last(&run), [0.0, 2.0, 0.0, -5.0]);
    assert!(
        done.err.contains("left out: MOTION/1, VFORCE/1, IC:PART/3"),
        "{}",
        done.err
    );
    assert!(
        toml(&model).contains("\"9999 Last_Used_Loadcase\" = [\"gravity\", \"SFORCE/1\"]"),
        "{}",
        toml(&model)
    );
    assert!(toml(&model).starts_with("# Load cases"));
    // the next run is not told anything
    let (run, _) = ran(&model, &[]);
    near(last(&run), [0.0, 2.0, 0.0, -5.0]);
    let record = std::fs::read_to_string(out(&model).join("m.json")).unwrap();
    let record: Value = serde_json::from_str(&record).unwrap();
    assert_eq!(
        record["loads"]["acting"],
        serde_json::json!(["gravity", "SFORCE/1"])
    );
    assert_eq!(
        record["loads"]["left_out"],
        serde_json::json!(["MOTION/1", "VFORCE/1", "IC:PART/3"])
    );
    // other commands solve the same
    let told = ok(&["explain", path(&model)]).out;
    assert!(told.contains("left out: MOTION/1, VFORCE/1"), "{told}");
    let (run, _) = ran(&model, &["--loads", "all"]);
    near(last(&run), ALL);
    let (run, _) = ran(&model, &[]);
    near(last(&run), ALL);
}

#[test]
fn every_load_alone_does_what_it_does_among_all() {
    // the loads act on different freedoms: their effects add
    let model = model("loads_each");
    let mut sum = [0.0; 4];
    for load in ["MOTION/1", "SFORCE/1", "VFORCE/1", "gravity", "IC:PART/3"] {
        let (run, _) = ran(&model, &["--loads", load]);
        let own = last(&run);
        (0..4).for_each(|k| sum[k] += own[k]);
    }
    near(sum, ALL);
}

#[test]
fn load_cases_are_made_chosen_and_removed_and_the_file_keeps_its_comments() {
    let model = model("loads_cases");
    write_toml(
        &model,
        "# mine\n[cases]\nfirst = [\"gravity\"] # down\n\n[solve]   # here\nend = 1\n",
    );
    ok(&["loads", "create", path(&model), "both", "first", "SFORCE/1"]);
    ok(&["loads", "choose", path(&model), "both"]);
    let text = toml(&model);
    for part in [
        "# mine\n",
        "first = [\"gravity\"] # down\n",
        "both = [\"first\", \"SFORCE/1\"]\n",
        "[solve]   # here\nend = 1\n",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let (run, done) = ran(&model, &[]);
    near(last(&run), [0.0, 2.0, 0.0, -5.0]);
    assert!(
        done.err.contains("loads: both (gravity, SFORCE/1)"),
        "{}",
        done.err
    );
    let listed: Value = serde_json::from_str(&ok(&["loads", path(&model), "--json"]).out).unwrap();
    let sforce = listed["loads"]
        .as_array()
        .unwrap()
        .iter()
        .find(|l| l["load"] == "SFORCE/1")
        .unwrap();
    assert_eq!(
        (sforce["acts"].as_bool(), &sforce["cases"]),
        (Some(true), &serde_json::json!(["both"]))
    );
    // what is used is not removed
    assert_eq!(cognate(&["loads", "remove", path(&model), "first"]).code, 2);
    assert_eq!(cognate(&["loads", "remove", path(&model), "both"]).code, 2);
    ok(&["loads", "choose", path(&model), "all"]);
    ok(&["loads", "remove", path(&model), "both", "first"]);
    let text = toml(&model);
    assert!(
        !text.contains("first") && text.contains("# mine") && text.contains("# here"),
        "{text}"
    );
}

#[test]
fn a_load_is_named_as_the_dataset_names_it_and_names_that_mean_nothing_are_answered() {
    let model = model("loads_names");
    let (run, _) = ran(&model, &["--loads", "drive"]);
    near(last(&run), [1.0, 0.0, 0.0, 0.0]);
    let before = toml(&model);
    for (names, answer) in [
        ("SFORCE/2", "the model has no load SFORCE/2"),
        ("JOINT/1", "JOINT is no load"),
        ("gravitty", "did you mean gravity"),
    ] {
        let done = cognate(&["run", path(&model), "--end", "1", "--loads", names]);
        assert!(
            done.code == 3 && done.err.contains(answer),
            "{names}: {}",
            done.err
        );
    }
    assert_eq!(toml(&model), before);
}

#[test]
fn mistakes_in_the_file_are_told_all_at_once_with_line_and_column() {
    let model = model("loads_mistakes");
    write_toml(
        &model,
        "[cases]\nlift = [\"gravity\", 3]\n[solve]\nendd = 2\nsteps = 1.5\n",
    );
    let done = cognate(&["run", path(&model), "--end", "1"]);
    assert_eq!(done.code, 3);
    for part in [
        "m.toml:2:20",
        "m.toml:4:1",
        "did you mean end",
        "m.toml:5:9",
    ] {
        assert!(done.err.contains(part), "{part}: {}", done.err);
    }
    // a load that went away since
    write_toml(
        &model,
        "[cases]\nlift = [\"gravity\",\n  \"SFORCE/9\"]\n[solve]\nloads = [\"lift\"]\n",
    );
    let done = cognate(&["run", path(&model), "--end", "1"]);
    assert!(
        done.code == 3 && done.err.contains("m.toml:3:3"),
        "{}",
        done.err
    );
    write_toml(&model, "[cases]\nnone = []\n[solve]\nloads = [\"none\"]\n");
    let done = cognate(&["run", path(&model), "--end", "1"]);
    assert!(
        done.code == 3 && done.err.contains("at least one must act"),
        "{}",
        done.err
    );
    write_toml(&model, "[cases\n");
    let done = cognate(&["run", path(&model), "--end", "1"]);
    assert!(
        done.code == 3 && done.err.contains("m.toml:1:"),
        "{}",
        done.err
    );
    // `check` looks at it, too
    let done = cognate(&["check", path(&model)]);
    assert!(
        done.code == 3 && done.err.contains("m.toml:1:"),
        "{}",
        done.err
    );
}

#[test]
fn a_model_without_any_load_is_told_so_and_runs() {
    let still = scratch(
        "loads_none",
        "still.adm",
        "T\nPART/1, GROUND\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nEND\n",
    );
    let folder = still.with_file_name("out");
    let done = ok(&["run", path(&still), "--end", "1", "--out", path(&folder)]);
    assert!(done.err.contains("no load acts"), "{}", done.err);
}

#[test]
fn the_set_up_is_taken_where_the_command_line_says_nothing() {
    let model = model("loads_setup");
    ok(&[
        "loads",
        "setup",
        path(&model),
        "--end",
        "0.5",
        "--steps",
        "5",
        "--error",
        "1e-10",
        "--format",
        "csv,res",
        "--column",
        "DZ(30,1)*2",
    ]);
    let folder = out(&model);
    ok(&["run", path(&model), "--out", path(&folder)]);
    let run = results::read(&folder.join("m.csv")).unwrap();
    assert_eq!((run.rows(), run.columns[0].values[5]), (6, 0.5));
    assert!(folder.join("m.res").is_file() && run.find("DZ(30,1)*2").is_some());
    ok(&["run", path(&model), "--steps", "2", "--out", path(&folder)]);
    assert_eq!(results::read(&folder.join("m.csv")).unwrap().rows(), 3);
    let told = ok(&["loads", "setup", path(&model), "--clear"]).out;
    assert!(told.contains("no set-up"), "{told}");
}

#[test]
fn a_set_up_can_ask_for_equilibrium_first() {
    let text = "T\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\nPART/1, GROUND\nMARKER/1, PART=1, REULER=0D,0D,0D\n\
                PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=2, J=1\n\
                SPRINGDAMPER/1, TRANSLATIONAL, I=2, J=3, K=100, C=0, LENGTH=1\nMARKER/3, PART=1, QP=0,0,1\nACCGRAV/KGRAV=-10\n\
                REQUEST/1, F2=DZ(2,1)\nEND\n";
    let hung = scratch("loads_rest", "hung.adm", text);
    let folder = hung.with_file_name("out");
    std::fs::write(
        hung.with_extension("toml"),
        "[solve]\nend = 1\nsteps = 4\ninitial_static_equilibrium = true\n",
    )
    .unwrap();
    ok(&["run", path(&hung), "--out", path(&folder)]);
    let run = results::read(&folder.join("hung.csv")).unwrap();
    let z = &run.columns[1].values;
    // after the row of the beginning it hangs at m g / k, and stays there
    assert!(
        z.len() == 6 && z[1..].iter().all(|z| (z + 0.1).abs() < 1e-6),
        "{z:?}"
    );
}

#[test]
fn a_function_in_degrees_drives_a_rotation_and_one_of_direct_entry_is_in_radians() {
    let model = model("loads_functions");
    ok(&[
        "group",
        "function",
        path(&model),
        "swing",
        "--expression",
        "30*sin(90*t)",
        "--ordinate",
        "angle",
    ]);
    ok(&[
        "group",
        "function",
        path(&model),
        "turn",
        "--direct",
        "2*TIME",
    ]);
    ok(&[
        "group",
        "function",
        path(&model),
        "push",
        "--expression",
        "4*t",
        "--ordinate",
        "force",
    ]);
    ok(&["loads", "drive", path(&model), "MOTION/1", "swing"]);
    ok(&["loads", "drive", path(&model), "VFORCE/1.FX", "push"]);
    let (run, _) = ran(&model, &[]);
    // 30°; the force 4t on 2 kg along x adds t³/3
    near(
        last(&run),
        [30f64.to_radians(), ALL[1] + 1.0 / 3.0, ALL[2], ALL[3]],
    );
    ok(&["loads", "drive", path(&model), "MOTION/1", "turn"]);
    let (run, _) = ran(&model, &[]);
    assert!((last(&run)[0] - 2.0).abs() < 1e-9);
    // a force is no angle, and nothing is written
    let before = toml(&model);
    let done = cognate(&["loads", "drive", path(&model), "SFORCE/1", "swing"]);
    assert!(
        done.code == 3 && done.err.contains("takes a function of force"),
        "{}",
        done.err
    );
    assert_eq!(toml(&model), before);
    ok(&["loads", "drive", path(&model), "MOTION/1"]);
    let (run, _) = ran(&model, &[]);
    assert!((last(&run)[0] - 1.0).abs() < 1e-9);
}

#[test]
fn a_spline_goes_through_its_points_with_the_ends_that_are_asked_for() {
    let model = model("loads_splines");
    let points = "0,0 0.3,1 0.6,-1 1,2";
    for (name, more) in [
        ("natural", &[][..]),
        ("knot", &["--ends", "not-a-knot"][..]),
        ("slopes", &["--slopes", "0,0"][..]),
    ] {
        let args = ["group", "function", path(&model), name, "--points", points];
        ok(&[&args, more].concat());
        ok(&["loads", "drive", path(&model), "MOTION/1", name]);
        let (run, _) = ran(&model, &[]);
        let angle = &run.columns[run.table_columns()[1]].values;
        for (row, degrees) in [(0, 0.0), (3, 1.0), (6, -1.0), (10, 2.0_f64)] {
            assert!(
                (angle[row].to_degrees() - degrees).abs() < 1e-9,
                "{name}: {angle:?}"
            );
        }
        if name == "slopes" {
            // close to its end it is nearly level
            let slope = (angle[10] - angle[9]).to_degrees() / 0.1;
            let natural = 20.0;
            assert!(slope < natural, "{slope}");
        }
        // the plot of the function has the values of the run
        let table = ok(&[
            "plot",
            path(&out(&model).join("m.csv")),
            "--y",
            name,
            "--statistics",
            "--json",
            "--model",
            path(&model),
        ]);
        let told: Value = serde_json::from_str(&table.out).unwrap();
        let last = told[0]["last"]
            .as_f64()
            .or(told[0]["last"]["value"].as_f64())
            .unwrap();
        assert!((last - 2.0).abs() < 1e-9, "{told}");
    }
}

#[test]
fn functions_come_from_files_and_their_mistakes_are_placed() {
    let model = model("loads_files");
    std::fs::write(
        model.with_file_name("pull.txt"),
        "! a function\nFUNCTION = STEP(TIME, 0, 0\n, , 1, 5)\\\n",
    )
    .unwrap();
    std::fs::write(
        model.with_file_name("road.csv"),
        "time, height\n0, 0\n1, 3\n2, 1\n",
    )
    .unwrap();
    write_toml(
        &model,
        "[functions.pull]\nfile = \"pull.txt\"\n[functions.road]\npoints = \"road.csv\"\n[loads]\n\"SFORCE/1\" = \"pull\"\n\"MOTION/1\" = \"road\"\n",
    );
    let (run, _) = ran(&model, &[]);
    assert!((last(&run)[0].to_degrees() - 3.0).abs() < 1e-9);
    write_toml(
        &model,
        "[functions.bad]\ndirect = \"3*SIN(TIME))\"\n[loads]\n\"SFORCE/1\" = \"bad\"\n",
    );
    let done = cognate(&["run", path(&model), "--end", "1"]);
    assert!(
        done.code == 3 && done.err.contains("m.toml:2:22"),
        "{}",
        done.err
    );
    write_toml(
        &model,
        "[functions.bad]\ndirect = \"DX(99,1)\"\n[loads]\n\"SFORCE/1\" = \"bad\"\n",
    );
    let done = cognate(&["run", path(&model), "--end", "1"]);
    assert!(
        done.code == 3 && done.err.contains("MARKER/99 does not exist"),
        "{}",
        done.err
    );
}

#[test]
fn a_configuration_of_a_run_has_the_loads_of_that_run() {
    let model = model("loads_configuration");
    let (_, _) = ran(&model, &["--loads", "gravity"]);
    ok(&["loads", "choose", path(&model), "MOTION/1"]);
    let later = model.with_file_name("later.adm");
    let results = out(&model).join("m.csv");
    ok(&[
        "configuration",
        path(&results),
        "--at",
        "0.5",
        "-o",
        path(&later),
        "--model",
        path(&model),
    ]);
    let text = std::fs::read_to_string(later).unwrap();
    // fallen for half a second, and not turned
    assert!(
        text.contains("KGRAV = -10") && text.contains("VZ = -4.99999999"),
        "{text}"
    );
}

#[test]
fn a_contact_is_known_by_the_name_that_preprocessors_give_it() {
    let text = "\
CONTACT
UNITS/SYSTEM=MKS
PART/1, GROUND
MARKER/1, PART=1
PART/2, MASS=1, CM=20, IP=1,1,1, QG=0,0,1
MARKER/20, PART=2
GRAPHICS/1, ELLIPSOID, CM=20, XSCALE=0.2, YSCALE=0.2, ZSCALE=0.2
GRAPHICS/2, PLANE, RM=1, XMIN=-9, XMAX=9, YMIN=-9, YMAX=9
CONTACT/1, IGEOM=1, JGEOM=2, IMPACT, STIFFNESS=1e5, DAMPING=10, EXPONENT=1.5, DMAX=0.01
ACCGRAV/KGRAV=-10
REQUEST/1, F4=DZ(20,1)
END
";
    let model = scratch("loads_contact", "ball.adm", text);
    let out = out(&model);
    let fell = |loads: &str| {
        let args = [
            "run",
            path(&model),
            "--end",
            "1",
            "--steps",
            "10",
            "--loads",
            loads,
            "--out",
            path(&out),
        ];
        ok(&args);
        let run = results::read(&out.join("ball.csv")).unwrap();
        run.column("REQUEST_1.Z")
            .or(run.column("REQUEST_1.F4"))
            .unwrap()[10]
    };
    assert!(fell("gravity") < -3.9);
    assert!(fell("gravity,1-CONTACT1") > 0.0);
    let wrong = cognate(&[
        "run",
        path(&model),
        "--end",
        "1",
        "--loads",
        "2-CONTACT1",
        "--out",
        path(&out),
    ]);
    assert_ne!(wrong.code, 0);
}
