//! The cost of what a scene does not need: a pendulum, and the same pendulum with a thousand elements that do not matter to it.
//!
//! `cargo bench --bench pruning`, or `cargo bench --bench pruning -- 10` with another number of elements. For each kind of ballast: operations of an evaluation of the rates beside those of the bare pendulum
//! (goal: within 1 %), the time that an element of ballast adds to a whole `cognate run` (goal: 2 µs), and whether the pendulum's
//! columns are the same to the bit.

use installed::Installed;
use std::path::Path;
use std::time::Instant;

#[path = "../tests/common/installed.rs"]
mod installed;

/// Elements of ballast, where the command line says nothing else.
const ELEMENTS: usize = 1000;
/// Runs of a model, of which the fastest counts.
const RUNS: usize = 3;

/// A kind of ballast: its name, the statements of the `k`-th element, and a line of the script that goes with them.
type Ballast = (
    &'static str,
    fn(usize) -> String,
    Option<fn(usize) -> String>,
);

const KINDS: &[Ballast] = &[
    (
        "markers",
        |k| format!("MARKER/{}, PART=2, QP={k},0,0", 1000 + k),
        None,
    ),
    (
        "splines",
        |k| format!("SPLINE/{k}, X=0,1,2,3, Y=0,1,4,{k}"),
        None,
    ),
    (
        "graphics",
        |k| format!("GRAPHICS/{k}, ELLIPSOID, CM=20, XSCALE=1, YSCALE=1, ZSCALE=1"),
        None,
    ),
    (
        "variables",
        |k| format!("VARIABLE/{k}, FUNCTION=SIN({k}*TIME)"),
        None,
    ),
    (
        "chains of variables",
        |k| {
            format!(
                "VARIABLE/{k}, FUNCTION={}",
                if k == 1 {
                    "DX(20,10)".into()
                } else {
                    format!("2*VARVAL({})", k - 1)
                }
            )
        },
        None,
    ),
    (
        "arrays",
        |k| format!("ARRAY/{k}, IC, SIZE=3, NUMBERS=1,2,{k}"),
        None,
    ),
    (
        "parts on ground",
        |k| {
            format!(
                "PART/{p}, MASS=1, CM={m}, IP=1,1,1\nMARKER/{m}, PART={p}\nMARKER/{g}, PART=1\nJOINT/{p}, FIXED, I={m}, J={g}",
                p = 10 + k,
                m = 2000 + k,
                g = 4000 + k
            )
        },
        None,
    ),
    (
        "dead springs",
        |k| format!("SPRINGDAMPER/{k}, I=20, J=11, TRANSLATION, K=0, C=0, LENGTH=1"),
        None,
    ),
    (
        "zero forces",
        |k| format!("SFORCE/{k}, I=20, J=11, TRANSLATION, FUNCTION=0"),
        None,
    ),
    (
        "requests",
        |k| format!("REQUEST/{}, F2=SIN(DX(20,10))*{k}", 1 + k),
        None,
    ),
    (
        "welded parts",
        |k| {
            format!(
                "PART/{p}, QG=1,0,0\nMARKER/{m}, PART={p}\nJOINT/{p}, FIXED, I={m}, J=20",
                p = 10 + k,
                m = 2000 + k
            )
        },
        None,
    ),
    (
        "DIFFs",
        |k| format!("DIFF/{k}, IC=1, FUNCTION=-{k}*DIF({k})"),
        None,
    ),
    (
        "stiff filters",
        |k| format!("DIFF/{k}, IC=0, FUNCTION={k}E3*(ACCX(20)-DIF({k}))"),
        None,
    ),
    (
        "sensors",
        |k| {
            format!(
                "SENSOR/{k}, GE, VALUE={}, FUNCTION=TIME+{k}, HALT",
                1_000_000 + k
            )
        },
        None,
    ),
    (
        "inactive elements",
        |k| format!("SFORCE/{k}, I=20, J=11, TRANSLATION, FUNCTION=SIN({k}*TIME)"),
        Some(|k| format!("DEACTIVATE/SFORCE, ID={k}")),
    ),
];

const PENDULUM: &str = "pendulum\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\nPART/1, GROUND\nMARKER/10, PART=1\n\
    MARKER/11, PART=1, QP=0,1,0\nPART/2, MASS=1, CM=20, IP=0.1,0.1,0.1, QG=1,0,0\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=-1,0,0\n\
    JOINT/1, REVOLUTE, I=21, J=10\nREQUEST/1, F2=DX(20,10)\\F3=DY(20,10)\nACCGRAV/JGRAV=-9.81\n";

/// Measurements of a model.
struct Measured {
    operations: u64,
    seconds: f64,
    /// time and the pendulum's columns, as they are written
    columns: Vec<String>,
}

fn main() {
    let folder = std::env::temp_dir().join(format!("cognate-pruning-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for models");
    let asked = std::env::args().skip(1).find_map(|a| a.parse().ok());
    let n: usize = asked.unwrap_or(ELEMENTS);
    let program = Installed::new("pruning-program");
    let bare = measured(&program, &folder, "", "");
    println!(
        "{:24}{:>12}{:>14}{:>16}{:>12}",
        format!("{n} of each"),
        "operations",
        "of the bare",
        "µs an element",
        "same bits"
    );
    for (name, statements, command) in KINDS {
        let ballast: String = (1..=n).map(|k| statements(k) + "\n").collect();
        let commands: String =
            command.map_or(String::new(), |c| (1..=n).map(|k| c(k) + "\n").collect());
        let with = measured(&program, &folder, &ballast, &commands);
        let ratio = with.operations as f64 / bare.operations as f64;
        let each = 1e6 * (with.seconds - bare.seconds) / n as f64;
        let same = if with.columns == bare.columns {
            "yes"
        } else {
            "no"
        };
        println!(
            "{name:24}{:>12}{:>13.1}%{each:>16.2}{same:>12}",
            with.operations,
            100.0 * ratio
        );
    }
    std::fs::remove_dir_all(&folder).expect("the folder can be removed");
}

fn measured(program: &Installed, folder: &Path, ballast: &str, commands: &str) -> Measured {
    let script = folder.join("model.acf");
    std::fs::write(
        folder.join("model.adm"),
        format!("{PENDULUM}{ballast}END\n"),
    )
    .expect("the dataset is written");
    let text = format!("model.adm\nmodel\n{commands}SIMULATE/DYNAMIC, END=1, STEPS=20\nSTOP\n");
    std::fs::write(&script, text).expect("the script is written");
    let script = script.to_string_lossy();
    let outline: serde_json::Value =
        serde_json::from_slice(&cognate(program, &["explain", &script, "--json"]))
            .expect("an outline in JSON");
    let out = folder.join("out");
    let mut seconds = f64::INFINITY;
    for _ in 0..RUNS {
        let _ = std::fs::remove_dir_all(&out);
        let begin = Instant::now();
        cognate(
            program,
            &["run", &script, "--out", &out.to_string_lossy(), "--quiet"],
        );
        seconds = seconds.min(begin.elapsed().as_secs_f64());
    }
    let table = std::fs::read_to_string(out.join("model.csv")).expect("columns");
    let columns = table
        .lines()
        .map(|row| row.split(',').take(3).collect::<Vec<_>>().join(","));
    Measured {
        operations: outline["operations"]["rate"].as_u64().unwrap_or(0),
        seconds,
        columns: columns.collect(),
    }
}

/// Runs the program; returns what it prints.
fn cognate(program: &Installed, arguments: &[&str]) -> Vec<u8> {
    let done = program
        .command()
        .args(arguments)
        .output()
        .expect("cognate runs");
    assert!(
        done.status.success(),
        "{arguments:?}: {}",
        String::from_utf8_lossy(&done.stderr)
    );
    done.stdout
}
