//! Joints and springs of Project Chrono's test set against the tables that Adams computed for them.
//!
//! A table says 6 or 7 digits at 501 times. The bound of a quantity is relative to the largest magnitude in its table: 5e-6 where the
//! table is that good; the Adams runs with looser control have what an independent integration found between it and them.

use super::running::{Analysis, Options, begin, go};
use cognate::model::{Formula, Model};
use std::path::{Path, PathBuf};

/// Ending of a table's file name, and the expressions of its columns; F and T are components of the reaction.
const TABLES: &[(&str, &[&str])] = &[
    ("Pos", &["DX(201,101)", "DY(201,101)", "DZ(201,101)"]),
    ("Vel", &["VX(201,101)", "VY(201,101)", "VZ(201,101)"]),
    ("Acc", &["ACCX(201,101)", "ACCY(201,101)", "ACCZ(201,101)"]),
    (
        "Quat",
        &[
            "ORIENT(27,1,201,101)",
            "ORIENT(27,2,201,101)",
            "ORIENT(27,3,201,101)",
            "ORIENT(27,4,201,101)",
        ],
    ),
    ("Avel", &["WX(201,101)", "WY(201,101)", "WZ(201,101)"]),
    ("Aacc", &["WDTX(201,101)", "WDTY(201,101)", "WDTZ(201,101)"]),
    ("Rforce", &["F2", "F3", "F4"]),
    ("Rtorque", &["T6", "T7", "T8"]),
];

/// Bounds: of positions and orientations, of velocities, of accelerations and reactions.
type Bounds = [f64; 3];

/// What the rounding of a table and a tight Adams run leave.
const TIGHT: Bounds = [5e-6, 5e-6, 1e-3];
/// Spherical and universal joints, where Adams was run with looser control (README of the corpus).
const LOOSE: Bounds = [8e-4, 3e-3, 1.3e-2];

#[track_caller]
fn folder() -> Option<PathBuf> {
    let root = super::needs::corpus()?;
    Some(root.join("projectchrono__chrono/data/testing/joints"))
}

/// The element that exerts the force and the one that exerts the torque: `JOINT(1`, or two markers.
type Reaction<'a> = [&'a str; 2];

fn expression(column: &str, reaction: Reaction) -> String {
    let component = |text: &str| text.parse::<usize>().ok();
    let (element, k) = match (column.strip_prefix('F'), column.strip_prefix('T')) {
        (Some(k), _) => (reaction[0], component(k)),
        (_, Some(k)) => (reaction[1], component(k)),
        _ => return column.to_string(),
    };
    let k = k.expect("a component");
    if element.contains('(') {
        return format!("{element},0,{k},101)");
    }
    let names = ["FX", "FY", "FZ", "", "TX", "TY", "TZ"];
    format!("{}({element})", names[k - 2])
}

fn table(path: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let numbers = text.lines().skip(3).filter(|l| !l.trim().is_empty());
    numbers
        .map(|l| l.split_whitespace().map(|x| x.parse().unwrap()).collect())
        .collect()
}

/// Runs a model and compares it with the tables of a case; prints the largest difference of each quantity.
fn compare(model: Model, tables: &Path, reaction: Reaction, bounds: Bounds) {
    let mut columns: Vec<String> = Vec::new();
    for (_, names) in TABLES {
        columns.extend(names.iter().map(|n| expression(n, reaction)));
    }
    let options = Options {
        error: Some(1e-10),
        columns,
        ..Options::default()
    };
    let case = tables.file_name().unwrap().to_string_lossy().into_owned();
    let mut session = begin(model, &case, options);
    go(&mut session, Analysis::Dynamic, 5.0, 500);
    let mut line = format!("{case:24}");
    let mut wrong = Vec::new();
    for (quantity, names) in TABLES {
        let file = tables.with_file_name(format!("{case}_ADAMS_{quantity}.txt"));
        let theirs = table(&file);
        let ours: Vec<&[f64]> = names
            .iter()
            .map(|n| session.run.column(&expression(n, reaction)).unwrap())
            .collect();
        assert_eq!(theirs.len(), ours[0].len(), "{case} {quantity}: rows");
        // the sign of Euler parameters means nothing
        let flip = |row: usize| {
            let along: f64 = (0..ours.len())
                .map(|k| theirs[row][k + 1] * ours[k][row])
                .sum();
            if *quantity == "Quat" && along < 0.0 {
                -1.0
            } else {
                1.0
            }
        };
        let mut scale: f64 = theirs
            .iter()
            .flat_map(|r| &r[1..])
            .fold(0.0, |m, x| m.max(x.abs()));
        if scale < 1e-6 {
            scale = 1.0; // a table of zeros
        }
        let mut worst = (0.0_f64, 0.0);
        for (row, line) in theirs.iter().enumerate() {
            for k in 0..ours.len() {
                let off = (line[k + 1] - flip(row) * ours[k][row]).abs() / scale;
                if off.is_nan() || off > worst.0 {
                    worst = (off, line[0]);
                }
            }
        }
        line += &format!(" {quantity} {:.1e}", worst.0);
        let bound = match *quantity {
            "Pos" | "Quat" => bounds[0],
            "Vel" | "Avel" => bounds[1],
            _ => bounds[2],
        };
        if worst.0.is_nan() || worst.0 > bound {
            wrong.push(format!("{quantity} by {:.2e} at {}", worst.0, worst.1));
        }
    }
    println!("{line}");
    assert!(wrong.is_empty(), "{case} differs: {}", wrong.join(", "));
}

/// A dataset of the set against its tables.
fn joint(name: &str, tables: &str, reaction: Reaction, bounds: Bounds) {
    let Some(folder) = folder() else { return };
    let file = folder.join(format!("adams_models/test_{name}.adm"));
    let model = Model::read(&file).unwrap_or_else(|e| panic!("{e}"));
    compare(model, &folder.join(tables).join(name), reaction, bounds);
}

#[test]
fn revolute_joints_move_as_adams_moves_them() {
    joint("Revolute_Case01", "revolute_joint", ["JOINT(1"; 2], TIGHT);
    joint("Revolute_Case02", "revolute_joint", ["JOINT(1"; 2], TIGHT);
}

#[test]
fn translational_joints_move_as_adams_moves_them() {
    joint("Prismatic_Case01", "prismatic_joint", ["JOINT(1"; 2], TIGHT);
    joint("Prismatic_Case02", "prismatic_joint", ["JOINT(1"; 2], TIGHT);
}

#[test]
fn cylindrical_joints_move_as_adams_moves_them() {
    joint(
        "Cylindrical_Case01",
        "cylindrical_joint",
        ["JOINT(1"; 2],
        TIGHT,
    );
    joint(
        "Cylindrical_Case02",
        "cylindrical_joint",
        ["JOINT(1"; 2],
        TIGHT,
    );
}

#[test]
fn spherical_joints_move_as_adams_moves_them() {
    joint("Spherical_Case01", "spherical_joint", ["JOINT(1"; 2], LOOSE);
}

#[test]
fn universal_joints_move_as_adams_moves_them() {
    joint("Universal_Case01", "universal_joint", ["JOINT(1"; 2], LOOSE);
    joint("Universal_Case02", "universal_joint", ["JOINT(1"; 2], LOOSE);
}

/// The single force of a model becomes this expression.
fn with_force(model: &mut Model, text: &str) {
    let force = model.sforces.get_mut(&1).expect("a force");
    force.function = Formula::text(text);
}

#[test]
fn torsion_springs_with_the_recovered_parameters_move_as_adams_moves_them() {
    let Some(folder) = folder() else { return };
    let cases = [
        ("RotSpring_Case01", "-200*AZ(207,208)-10*WZ(207,208,208)"),
        (
            "RotSpring_Case02",
            "-(50+10*ABS(AZ(207,208)))*AZ(207,208)-10*WZ(207,208,208)",
        ),
    ];
    for (case, law) in cases {
        let mut model = Model::read(folder.join("adams_models/test_RotSpring_Case01.adm")).unwrap();
        with_force(&mut model, law);
        // here Adams' velocities are good to 1e-5; the force is that of the joint, the torque that of the spring
        let bounds = [5e-6, 1e-5, 1e-3];
        let tables = folder.join("rotspring_force").join(case);
        compare(model, &tables, ["JOINT(1", "SFORCE(1"], bounds);
    }
}

#[test]
fn translational_springs_with_the_recovered_parameters_move_as_adams_moves_them() {
    let Some(folder) = folder() else { return };
    let cases = [
        ("TranSpring_Case01", 0.0, "-10*DM(204,205)-0.5*VR(204,205)"),
        (
            "TranSpring_Case02",
            2.0,
            "-100*(DM(204,205)-2)-5*VR(204,205)",
        ),
    ];
    for (case, start, law) in cases {
        let mut model =
            Model::read(folder.join("adams_models/test_TransSpring_Case01.adm")).unwrap();
        with_force(&mut model, law);
        for marker in model.markers.values_mut() {
            if marker.qp == [0.0, 2.0, 0.0] {
                marker.qp[1] = start;
            }
        }
        compare(
            model,
            &folder.join("transpring_force").join(case),
            ["204,205"; 2],
            TIGHT,
        );
    }
}
