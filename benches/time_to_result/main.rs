//! The time from a file to files, and how it grows with the model: whole `cognate run` processes at sizes N and 2N, beside the part of
//! it that solves, and beside MuJoCo where `python3` has it. Before them small models of the references, and the start of the program
//! (goals: 5 ms, 2 ms).
//!
//! `cargo bench --bench time_to_result`, or with a word behind `--`: `small` for the small models alone, `files` for files that are
//! checked and formatted, `chain` for the families whose names contain it; `-- chain 4`: four sizes, each twice the one before. The slope is that of log time over log size between the last
//! two sizes: 1 is linear.

mod mujoco;

use installed::Installed;
use mujoco::Peer;
use repository::root;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[path = "../../tests/common/installed.rs"]
mod installed;
#[path = "../../tests/common/repository.rs"]
mod repository;

/// A family of models: its name, its first size, the dataset of a size, and the same in MuJoCo's language where it can say it.
type Family = (
    &'static str,
    usize,
    fn(usize) -> Dataset,
    Option<fn(usize) -> String>,
);

const FAMILIES: &[Family] = &[
    (
        "independent four-bars",
        125,
        four_bars,
        Some(mujoco::four_bars),
    ),
    ("chain", 160, chain, Some(mujoco::chain)),
    ("free parts", 250, free_parts, Some(mujoco::free_parts)),
    ("scissor lift", 10, scissor_lift, None),
    ("truss", 5, truss, None),
    ("contacts", 100, contacts, Some(mujoco::contacts)),
    ("balls that bounce for a second", 50, balls, None),
    ("frictions", 100, frictions, None),
    ("chain with frictions", 20, chain_with_frictions, None),
    ("pairs of coupled wheels", 100, coupled_wheels, None),
    ("chain of variables under a motion", 1000, variables, None),
];

/// Parts of the smaller file that is checked and formatted.
const FIRST_FILE: usize = 10_000;
/// Runs of a size, of which the fastest counts.
const RUNS: usize = 3;

/// Models of tests/data/references whose whole runs should take at most 5 ms.
const SMALL: &[&str] = &[
    "a01_pendulum",
    "bounce_k1e6",
    "a04_bricard",
    "slider_crank_kin",
    "a03_andrews",
];
/// Runs of a small model, taken in turns, of which the median counts.
const SMALL_RUNS: usize = 25;

fn main() {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with('-'))
        .collect();
    let sizes = words
        .iter()
        .find_map(|w| w.parse().ok())
        .unwrap_or(2)
        .max(2);
    let word = words.iter().find(|w| w.parse::<u32>().is_err());
    let folder =
        std::env::temp_dir().join(format!("cognate-time-to-result-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for models");
    let program = Installed::new("time-to-result-program");
    if word.is_none_or(|w| "small".contains(w.as_str())) {
        small(&program, &folder);
    }
    let peer = Peer::found();
    println!("{}", peer.told());
    println!(
        "{:36}{:>8}{:>14}{:>14}{:>8}{:>14}",
        "", "N", "file to files", "solving", "slope", "MuJoCo"
    );
    if word.is_none_or(|w| "files".contains(w.as_str())) {
        files(&program, &folder, sizes);
    }
    for (name, first, dataset, other) in FAMILIES {
        if word.is_some_and(|w| !name.contains(w.as_str())) {
            continue;
        }
        let mut before: Option<f64> = None;
        for n in (0..sizes).map(|k| first << k) {
            write_model(&folder, dataset(n));
            let other = other.map(|xml| write_other(&folder, xml(n)));
            let mut theirs = f64::INFINITY;
            let mut best = (f64::INFINITY, 0.0);
            for _ in 0..RUNS {
                let (whole, solving) = run(&program, &folder);
                if whole < best.0 {
                    best = (whole, solving);
                }
                if let Some(seconds) = other.as_deref().and_then(|file| peer.run(file)) {
                    theirs = theirs.min(seconds);
                }
            }
            let slope = before.map_or(String::new(), |b| format!("{:.2}", (best.0 / b).log2()));
            let (whole, solving) = (milliseconds(best.0), milliseconds(best.1));
            let theirs = if theirs.is_finite() {
                milliseconds(theirs)
            } else {
                "–".into()
            };
            println!("{name:36}{n:>8}{whole:>14}{solving:>14}{slope:>8}{theirs:>14}");
            before = Some(best.0);
        }
    }
    std::fs::remove_dir_all(&folder).expect("the folder can be removed");
}

/// Prints the time that files of free parts take that are checked and formatted, and how it grows.
fn files(program: &Installed, folder: &Path, sizes: usize) {
    let file = folder.join("model.adm");
    let file = file.to_string_lossy();
    for command in ["check", "fmt"] {
        let mut before: Option<f64> = None;
        for n in (0..sizes).map(|k| FIRST_FILE << k) {
            write_model(folder, free_parts(n));
            let times = (0..RUNS).map(|_| seconds(program, &[command, &file]));
            let best = times.fold(f64::INFINITY, f64::min);
            let slope = before.map_or(String::new(), |b| format!("{:.2}", (best / b).log2()));
            let name = format!("{command} of free parts");
            println!(
                "{name:36}{n:>8}{:>14}{:>14}{slope:>8}",
                milliseconds(best),
                ""
            );
            before = Some(best);
        }
    }
}

/// Prints the medians of the start of the program and of small models, taken in turns.
fn small(program: &Installed, folder: &Path) {
    let references = root("tests/data/references");
    let out = folder.join("small");
    let mut times = vec![Vec::new(); SMALL.len() + 1];
    for _ in 0..SMALL_RUNS {
        let (start, models) = times.split_first_mut().expect("the start");
        start.push(seconds(program, &["--version"]));
        for (name, times) in SMALL.iter().zip(models) {
            let script = references.join(name).with_extension("acf");
            let [script, out] = [&script, &out].map(|path| path.to_string_lossy());
            times.push(seconds(
                program,
                &["run", &script, "--out", &out, "--quiet"],
            ));
            std::fs::remove_dir_all(folder.join("small")).expect("results");
        }
    }
    println!("{:36}{:>8}{:>14}", "", "", "file to files");
    for (name, mut times) in std::iter::once(&"start").chain(SMALL).zip(times) {
        times.sort_by(f64::total_cmp);
        println!("{name:44}{:>14}", milliseconds(times[SMALL_RUNS / 2]));
    }
}

/// Returns the seconds that the program takes with these arguments.
fn seconds(program: &Installed, arguments: &[&str]) -> f64 {
    let begin = Instant::now();
    let done = program
        .command()
        .args(arguments)
        .output()
        .expect("cognate runs");
    let seconds = begin.elapsed().as_secs_f64();
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    seconds
}

fn milliseconds(seconds: f64) -> String {
    format!("{:.1} ms", 1e3 * seconds)
}

fn write_model(folder: &Path, dataset: Dataset) {
    let script = format!(
        "model.adm\nmodel\nSIMULATE/DYNAMIC, END={}, STEPS=1\nSTOP\n",
        dataset.duration
    );
    std::fs::write(folder.join("model.adm"), dataset.end()).expect("the dataset is written");
    std::fs::write(folder.join("model.acf"), script).expect("the script is written");
}

/// Writes a model in MuJoCo's language; returns its file.
fn write_other(folder: &Path, xml: String) -> PathBuf {
    let file = folder.join("model.xml");
    std::fs::write(&file, xml).expect("the model is written");
    file
}

/// Runs the model in a process of its own; returns the seconds it took, and those of it that it solved.
fn run(program: &Installed, folder: &Path) -> (f64, f64) {
    let out = folder.join("out");
    let _ = std::fs::remove_dir_all(&out);
    let script = folder.join("model.acf");
    let [script, to] = [&script, &out].map(|path| path.to_string_lossy());
    let seconds = seconds(program, &["run", &script, "--out", &to, "--quiet"]);
    let record = std::fs::read_to_string(out.join("model.json")).expect("a record");
    let record: serde_json::Value = serde_json::from_str(&record).expect("a record in JSON");
    (
        seconds,
        record["solve_seconds"].as_f64().unwrap_or(f64::NAN),
    )
}

/// A dataset that grows statement by statement.
struct Dataset {
    text: String,
    parts: usize,
    markers: usize,
    joints: usize,
    /// time that is simulated, s
    duration: f64,
}

/// A part, where its frame stands.
#[derive(Clone, Copy)]
struct Body {
    number: usize,
    at: [f64; 3],
}

const GROUND: Body = Body {
    number: 1,
    at: [0.0; 3],
};

impl Dataset {
    fn new() -> Self {
        let text = "model\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\nPART/1, GROUND\nACCGRAV/JGRAV=-9.81\n";
        Self {
            text: text.to_string(),
            parts: 1,
            markers: 0,
            joints: 0,
            duration: 0.01,
        }
    }

    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn end(mut self) -> String {
        self.line("END");
        self.text
    }

    /// Adds a part of unit mass whose centre is at its origin; `more`: further arguments. Returns it and its CM marker.
    fn part(&mut self, at: [f64; 3], more: &str) -> (Body, usize) {
        self.parts += 1;
        self.markers += 1;
        let (number, cm, [x, y, z]) = (self.parts, self.markers, at);
        let part = format!(
            "PART/{number}, MASS=1, CM={cm}, IP=0.1,0.1,0.1, QG={x:?},{y:?},{z:?}{more}\nMARKER/{cm}, PART={number}"
        );
        self.line(&part);
        (Body { number, at }, cm)
    }

    fn marker(&mut self, body: Body, at: [f64; 3], more: &str) -> usize {
        self.markers += 1;
        let [x, y, z] = [0, 1, 2].map(|k| at[k] - body.at[k]);
        let marker = format!(
            "MARKER/{}, PART={}, QP={x:?},{y:?},{z:?}{more}",
            self.markers, body.number
        );
        self.line(&marker);
        self.markers
    }

    /// Adds a revolute joint at a point of ground; returns its number.
    fn hinge(&mut self, i: Body, j: Body, at: [f64; 3]) -> usize {
        let (i, j) = (self.marker(i, at, ""), self.marker(j, at, ""));
        self.joints += 1;
        let joint = format!("JOINT/{}, REVOLUTE, I={i}, J={j}", self.joints);
        self.line(&joint);
        self.joints
    }
}

fn four_bars(n: usize) -> Dataset {
    let mut d = Dataset::new();
    for k in 0..n {
        let (z, angle) = (k as f64, 1.0 + 0.001 * (k % 7) as f64);
        let (crank, coupler, rocker, base) = (0.3, 1.0, 0.8, 0.9);
        let a = [crank * angle.cos(), crank * angle.sin(), z];
        let (dx, dy) = (base - a[0], -a[1]);
        let r = f64::hypot(dx, dy);
        let along = (coupler * coupler - rocker * rocker + r * r) / (2.0 * r);
        let across = (coupler * coupler - along * along).sqrt();
        let b = [
            a[0] + (along * dx - across * dy) / r,
            a[1] + (along * dy + across * dx) / r,
            z,
        ];
        let [first, second] = [[0.0, 0.0, z], [base, 0.0, z]];
        let [p, q, s] = [first, a, second].map(|at| d.part(at, "").0);
        d.hinge(p, GROUND, first);
        d.hinge(q, p, a);
        d.hinge(q, s, b);
        d.hinge(s, GROUND, second);
    }
    d
}

fn chain(n: usize) -> Dataset {
    let mut d = Dataset::new();
    let mut carrier = GROUND;
    for k in 0..n {
        let at = [k as f64, 0.0, 0.0];
        let (link, _) = d.part(at, "");
        d.hinge(link, carrier, at);
        carrier = link;
    }
    d
}

fn free_parts(n: usize) -> Dataset {
    let mut d = Dataset::new();
    for k in 0..n {
        d.part([(k % 10) as f64, (k / 10) as f64, 0.0], ", WX=1, WY=0.1");
    }
    d
}

fn scissor_lift(n: usize) -> Dataset {
    let mut d = Dataset::new();
    let mut below: Option<(Body, Body)> = None;
    for k in 0..n {
        let y = k as f64;
        let (a, _) = d.part([0.0, y, 0.0], "");
        let (b, _) = d.part([1.0, y, 0.0], "");
        d.hinge(a, b, [0.5, y + 0.5, 0.0]);
        match below {
            None => {
                d.hinge(a, GROUND, [0.0; 3]);
                let i = d.marker(b, [1.0, 0.0, 0.0], "");
                let j = d.marker(GROUND, [1.0, 0.0, 0.0], ", REULER=0,90D,0");
                d.line(&format!("JPRIM/1, INPLANE, I={i}, J={j}"));
            }
            Some((left, right)) => {
                d.hinge(a, right, [0.0, y, 0.0]);
                d.hinge(b, left, [1.0, y, 0.0]);
            }
        }
        below = Some((a, b));
    }
    d
}

fn truss(n: usize) -> Dataset {
    let mut d = Dataset::new();
    let node = |i: usize, j: usize| (i, j);
    let mut ends: std::collections::BTreeMap<(usize, usize), Vec<Body>> = Default::default();
    ends.insert(node(0, 0), vec![GROUND]);
    ends.insert(node(0, 1), vec![GROUND]);
    for i in 0..n {
        let rods = [
            (node(i, 0), node(i + 1, 0)),
            (node(i, 1), node(i + 1, 1)),
            (node(i + 1, 0), node(i + 1, 1)),
            (node(i, 0), node(i + 1, 1)),
        ];
        for (from, to) in rods {
            let (rod, _) = d.part([from.0 as f64, from.1 as f64, 0.0], "");
            ends.entry(from).or_default().push(rod);
            ends.entry(to).or_default().push(rod);
        }
    }
    for ((i, j), rods) in ends {
        for pair in rods.windows(2) {
            d.hinge(pair[1], pair[0], [i as f64, j as f64, 0.0]);
        }
    }
    d
}

fn contacts(n: usize) -> Dataset {
    let mut d = Dataset::new();
    let floor = d.marker(GROUND, [0.0; 3], "");
    d.line(&format!(
        "GRAPHICS/1, PLANE, RM={floor}, XMIN=-1000, XMAX=1000, YMIN=-1000, YMAX=1000"
    ));
    for k in 0..n {
        let (_, cm) = d.part([3.0 * (k % 30) as f64, 3.0 * (k / 30) as f64, 1.1], "");
        let ball = k + 2;
        let contact = k + 1;
        let mut lines = String::new();
        let _ = writeln!(
            lines,
            "GRAPHICS/{ball}, ELLIPSOID, CM={cm}, XSCALE=2, YSCALE=2, ZSCALE=2"
        );
        let _ = write!(
            lines,
            "CONTACT/{contact}, IGEOM={ball}, JGEOM=1, IMPACT, STIFFNESS=1e5, DAMPING=10, DMAX=0.01, EXPONENT=2.2"
        );
        d.line(&lines);
    }
    d
}

/// Balls that each have a plate of their own and fall from another height, so that no two bounce at once.
fn balls(n: usize) -> Dataset {
    let mut d = Dataset::new();
    d.duration = 1.0;
    for k in 0..n {
        let (x, height) = (k as f64, 0.2 + 0.3 * (0.618 * k as f64).fract());
        let (_, cm) = d.part([x, height, 0.0], "");
        let plate = d.marker(GROUND, [x, 0.0, 0.0], ", REULER=180D,90D,180D");
        d.line(&format!(
            "SFORCE/{}, TRANSLATION, ACTIONONLY, I={cm}, J={plate}, \
             FUNCTION=IMPACT(DY({cm},{plate}),VY({cm},{plate}),0.1,1e5,1.5,20,1e-4)",
            k + 1
        ));
    }
    d
}

fn frictions(n: usize) -> Dataset {
    let mut d = Dataset::new();
    for k in 0..n {
        let x = k as f64;
        let (body, _) = d.part([x, 0.0, 0.0], "");
        let joint = d.hinge(body, GROUND, [x, 0.5, 0.0]);
        d.line(&format!("FRICTION/{joint}, JOINT={joint}, MU_STATIC=0.3, MU_DYNAMIC=0.2, PIN_RADIUS=0.05, STICTION_TRANSITION_VELOCITY=0.1"));
    }
    d
}

fn chain_with_frictions(n: usize) -> Dataset {
    let mut d = Dataset::new();
    let mut carrier = GROUND;
    for k in 0..n {
        let at = [k as f64, 0.0, 0.0];
        let (link, _) = d.part(at, "");
        let joint = d.hinge(link, carrier, at);
        d.line(&format!(
            "FRICTION/{joint}, JOINT={joint}, MU_STATIC=0.3, MU_DYNAMIC=0.2, PIN_RADIUS=0.02"
        ));
        carrier = link;
    }
    d
}

fn coupled_wheels(n: usize) -> Dataset {
    let mut d = Dataset::new();
    for k in 0..n {
        let wheels = [0.0, 1.0].map(|y| {
            let at = [k as f64, y, 0.0];
            let (wheel, _) = d.part(at, "");
            d.hinge(wheel, GROUND, at)
        });
        d.line(&format!(
            "COUPLER/{}, JOINTS={},{}, SCALES=1.0,-2.0",
            k + 1,
            wheels[0],
            wheels[1]
        ));
    }
    d
}

fn variables(n: usize) -> Dataset {
    let mut d = Dataset::new();
    let (body, _) = d.part([0.0; 3], "");
    let joint = d.hinge(body, GROUND, [0.0; 3]);
    d.line("VARIABLE/1, FUNCTION=SIN(TIME)");
    for k in 2..=n {
        d.line(&format!(
            "VARIABLE/{k}, FUNCTION=VARVAL({})+0.0001*COS({k}*TIME)",
            k - 1
        ));
    }
    d.line(&format!(
        "MOTION/1, ROTATION, JOINT={joint}, FUNCTION=VARVAL({n})"
    ));
    d
}
