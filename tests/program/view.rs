//! Command files of Adams View at the command line: run, converted, checked, swept, left alone.

use super::command::{cognate, path, scratch};

/// A pendulum whose length is a design variable, driven by gravity alone.
const PENDULUM: &str = "\
model create model_name = pendulum
defaults units length = meter angle = deg force = newton mass = kg time = sec
variable create variable_name = .pendulum.l real_value = 1.0
force create body gravitational gravity_field_name = gravity z_component_gravity = -9.81
marker create marker_name = .pendulum.ground.pivot location = 0, 0, 0 orientation = 0, 90, 0
part create rigid_body name_and_position part_name = .pendulum.bob location = (.pendulum.l), 0, 0
marker create marker_name = .pendulum.bob.cm location = 0, 0, 0
marker create marker_name = .pendulum.bob.hook location = (-.pendulum.l), 0, 0 orientation = 0, 90, 0
part create rigid_body mass_properties part_name = .pendulum.bob mass = 2.0 &
  ixx = 0.001 iyy = 0.001 izz = 0.001 center_of_mass_marker = .pendulum.bob.cm
constraint create joint revolute joint_name = .pendulum.hinge &
  i_marker_name = .pendulum.bob.hook j_marker_name = .pendulum.ground.pivot
measure create object measure_name = .pendulum.height object = .pendulum.bob &
  characteristic = cm_position component = z_component
simulation single_run transient type = dynamic end_time = 0.5 number_of_steps = 50
";

fn last_height(folder: &std::path::Path) -> f64 {
    let table = std::fs::read_to_string(folder.join("pendulum.csv")).expect("a table");
    let head: Vec<&str> = table.lines().next().expect("a head").split(',').collect();
    let k = head
        .iter()
        .position(|name| name.contains("DZ"))
        .expect("a column");
    let last = table.lines().last().expect("a row");
    last.split(',')
        .nth(k)
        .expect("a number")
        .parse()
        .expect("a number")
}

#[test]
fn a_command_file_runs_what_it_asks_for_and_with_other_variables() {
    let model = scratch("view_run", "pendulum.cmd", PENDULUM);
    let folder = model.with_file_name("out");
    let run = |more: &[&str]| {
        let column = ["--column", "DZ(.pendulum.bob.cm)", "--overwrite", "--quiet"];
        let arguments = [
            &["run", path(&model), "-o", path(&folder)],
            &column[..],
            more,
        ]
        .concat();
        let done = cognate(&arguments);
        assert_eq!(done.code, 0, "{}", done.err);
        last_height(&folder)
    };
    let (short, long) = (run(&[]), run(&["--set", ".pendulum.l=4"]));
    // a pendulum four times as long is twice as slow: it is where a short one is in half the time
    let half = run(&["--end", "0.25", "--steps", "50"]);
    assert!(short < half && half < 0.0);
    assert!((long / 4.0 - half).abs() < 2e-3, "{long} {half}");
    let unknown = cognate(&["run", path(&model), "--set", ".pendulum.length=4"]);
    assert_eq!(unknown.code, 3);
    assert!(
        unknown.err.contains("there is no design variable"),
        "{}",
        unknown.err
    );
}

#[test]
fn a_command_file_becomes_the_dataset_that_means_the_same() {
    let model = scratch("view_convert", "pendulum.cmd", PENDULUM);
    let dataset = model.with_extension("adm");
    let done = cognate(&["convert", path(&model), path(&dataset)]);
    assert_eq!(done.code, 0, "{}", done.err);
    let text = std::fs::read_to_string(&dataset).expect("a dataset");
    for part in [
        "adams_view_name='hook'",
        ", REVOLUTE",
        "FUNCTION = DZ(2,0,0)",
        ", KGRAV = -9.81",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let check = cognate(&["check", path(&dataset)]);
    assert_eq!(check.code, 0, "{}", check.err);
    // what cannot be solved is left out, which the exit code and the dataset say
    let tyre = "ude create instance instance_name = .pendulum.tyre definition_name = .MDI.Forces.vpg_tire\n";
    let model = scratch("view_tyre", "pendulum.cmd", &(PENDULUM.to_owned() + tyre));
    let dataset = model.with_extension("adm");
    let done = cognate(&["convert", path(&model), path(&dataset)]);
    assert_eq!(done.code, 4, "{}", done.err);
    assert!(
        done.err.contains("view_unsolved") && done.err.contains(":16:"),
        "{}",
        done.err
    );
    let text = std::fs::read_to_string(&dataset).expect("a dataset");
    assert!(text.contains("! not in this dataset") && text.contains("vpg_tire"));
    assert_eq!(cognate(&["run", path(&model), "--quiet"]).code, 3);
}

#[test]
fn a_sweep_sets_design_variables() {
    let model = scratch("view_sweep", "pendulum.cmd", PENDULUM);
    let out = model.with_file_name("table.csv");
    let done = cognate(&[
        "sweep",
        path(&model),
        "--set",
        ".pendulum.l=1,4",
        "--measure",
        "last(DZ(.pendulum.bob.cm))",
        "-o",
        path(&out),
        "--quiet",
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    let table = std::fs::read_to_string(&out).expect("a table");
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!(rows.len(), 4, "{table}");
    assert!(rows[0].contains(".pendulum.l"), "{table}");
    let last = |row: &str| row.split(',').nth(2).and_then(|x| x.parse::<f64>().ok());
    let (short, long) = (last(rows[2]), last(rows[3]));
    // half a second: the short one has fallen 0.92 of its length, the long one hardly a third
    assert!(short.is_some_and(|z| (z + 0.92).abs() < 0.01), "{table}");
    assert!(
        long.is_some_and(|z| (z / 4.0 + 0.30).abs() < 0.01),
        "{table}"
    );
}

#[test]
fn a_command_file_stays_as_it_is() {
    let model = scratch("view_left", "pendulum.cmd", PENDULUM);
    let out = model.with_file_name("out.adm");
    for arguments in [
        vec!["fmt", path(&model)],
        vec![
            "elements",
            path(&model),
            "--rename",
            "JOINT/1=pin",
            "-o",
            path(&out),
        ],
    ] {
        let done = cognate(&arguments);
        assert_eq!(done.code, 2, "{}", done.err);
        assert!(done.err.contains("view_is_left"), "{}", done.err);
    }
    let shown = cognate(&["elements", path(&model), "--show", "JOINT/1"]);
    assert_eq!(shown.code, 0, "{}", shown.err);
    assert!(shown.out.contains("REVOLUTE"), "{}", shown.out);
    assert_eq!(
        std::fs::read_to_string(&model).expect("the model"),
        PENDULUM
    );
}

#[test]
fn a_command_file_is_drawn_moved_linearized_and_explained_as_a_dataset_is() {
    let model = scratch("view_doors", "pendulum.cmd", PENDULUM);
    let picture = model.with_file_name("pendulum.svg");
    let page = model.with_file_name("pendulum.html");
    for arguments in [
        vec!["draw", path(&model), "-o", path(&picture)],
        vec!["animate", path(&model), "--end", "0.5", "-o", path(&page)],
        vec!["verify", path(&model)],
        vec!["explain", path(&model)],
        vec![
            "linear",
            path(&model),
            "--out",
            path(model.parent().expect("a folder")),
        ],
        vec!["check", path(&model)],
    ] {
        let done = cognate(&arguments);
        assert_eq!(done.code, 0, "{arguments:?}: {}", done.err);
    }
    assert!(picture.is_file() && page.is_file());
    // what is run without --end is said
    let done = cognate(&[
        "run",
        path(&model),
        "-o",
        path(&model.with_file_name("out")),
    ]);
    assert!(
        done.err.contains("SIMULATE/DYNAMIC, END=0.5, STEPS=50"),
        "{}",
        done.err
    );
}
