//! Sound models with one fault each: the first thing that is said names the fault.
//!
//! `check`, then `verify`, then `run` are asked as a user would ask them, until one of them speaks.
//! `cargo test --test program broken:: -- --nocapture` prints the score, a line a fault.

use crate::repository::root;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The sound models, in tests/data/broken.
const SOUND: [&str; 5] = [
    "four_bar",
    "slider_crank",
    "quarter_car",
    "ball_and_pendulum",
    "gear_train",
];

/// How many of the faults are named first today: more is better, fewer is a mistake.
const NAMED_FIRST: usize = 93;
/// How many of them by `run` alone.
const NAMED_FIRST_BY_RUN: usize = 91;

/// Model, text, what stands there instead, and elements of which the first message names one.
const FAULTS: &[(&str, &str, &str, &[&str])] = &[
    (
        "four_bar",
        "MARKER/31, PART=3, QP=300,200,0",
        "MARKER/31, PART=3, QP=300,200,0, REULER=0,5D,0",
        &["JOINT/3", "MARKER/31"],
    ),
    (
        "four_bar",
        "MARKER/41, PART=4, QP=0,200,0",
        "MARKER/41, PART=4, QP=0,200,15",
        &["JOINT/3", "MARKER/41"],
    ),
    (
        "four_bar",
        "JOINT/4, REVOLUTE, I=40, J=13\n",
        "",
        &["PART/4", "freedom"],
    ),
    (
        "four_bar",
        "JOINT/2, REVOLUTE, I=30, J=21",
        "JOINT/2, REVOLUTE, I=30, J=30",
        &["JOINT/2"],
    ),
    (
        "four_bar",
        "MARKER/32, PART=3",
        "MARKER/32, PART=7",
        &["MARKER/32"],
    ),
    (
        "four_bar",
        "JOINT/3, REVOLUTE, I=31, J=41",
        "JOINT/3, REVOLUTE, I=31, J=44",
        &["JOINT/3"],
    ),
    ("four_bar", "PART/3, MASS=2", "PART/3, MASS=-2", &["PART/3"]),
    (
        "four_bar",
        "PART/3, MASS=2, CM=32",
        "PART/3, MASS=2",
        &["PART/3"],
    ),
    (
        "four_bar",
        "IP=5000,5000,5000",
        "IP=5000,5000,50000",
        &["PART/4"],
    ),
    (
        "four_bar",
        "FUNCTION=360D*TIME",
        "FUNCTION=360D*TIME+DX(40,13)",
        &["MOTION/1"],
    ),
    (
        "four_bar",
        "FUNCTION=360D*TIME",
        "FUNCTION=360*TIME",
        &["MOTION/1"],
    ),
    (
        "four_bar",
        "FUNCTION=360D*TIME",
        "FUNCTION=IF(TIME-0.5: 0, 0, 1)",
        &["MOTION/1"],
    ),
    (
        "four_bar",
        "MOTION/1, JOINT=1, ROTATION, FUNCTION=360D*TIME",
        "MOTION/1, JOINT=1, ROTATION, FUNCTION=360D*TIME\nMOTION/2, JOINT=4, ROTATION, FUNCTION=10D*TIME",
        &["MOTION/2", "MOTION/1"],
    ),
    ("four_bar", "JGRAV=-9806.65", "JGRAV=-9.80665", &["ACCGRAV"]),
    (
        "four_bar",
        "UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND\n",
        "",
        &["UNITS"],
    ),
    ("four_bar", "360D*TIME", "360D*TMIE", &["MOTION/1"]),
    (
        "four_bar",
        "JOINT/3, REVOLUTE",
        "JOINT/3, REVOLTE",
        &["JOINT/3"],
    ),
    (
        "four_bar",
        "JOINT/4, REVOLUTE",
        "JOINT/3, REVOLUTE",
        &["JOINT/3"],
    ),
    (
        "four_bar",
        "MOTION/1, JOINT=1, ROTATION",
        "MOTION/1, JOINT=1, TRANSLATION",
        &["MOTION/1"],
    ),
    (
        "four_bar",
        "IP=1000,1000,1000",
        "IP=1E9,1E9,1E9",
        &["PART/2"],
    ),
    ("slider_crank", "C=5", "C=-5", &["SPRINGDAMPER/1"]),
    ("slider_crank", "K=100", "K=-100", &["SPRINGDAMPER/1"]),
    (
        "slider_crank",
        "SPRINGDAMPER/1, TRANSLATION, I=40, J=12",
        "SPRINGDAMPER/1, TRANSLATION, I=40, J=40",
        &["SPRINGDAMPER/1"],
    ),
    (
        "slider_crank",
        "MARKER/11, PART=1, REULER=90D,90D,0",
        "MARKER/11, PART=1",
        &["JOINT/4", "MARKER/11"],
    ),
    (
        "slider_crank",
        "-0.2*WZ(20,10)",
        "-0.2*WZ(20,10",
        &["SFORCE/1"],
    ),
    (
        "slider_crank",
        "STEP(TIME,0,0,0.1,2)",
        "STEP(TIME,0.1,0,0,2)",
        &["SFORCE/1"],
    ),
    (
        "slider_crank",
        "STEP(TIME,0,0,0.1,2)",
        "STEP(TIME,0,0 0.1,2)",
        &["SFORCE/1"],
    ),
    (
        "slider_crank",
        "SFORCE/1, ROTATION",
        "SFORCE/1, ROTATION, TRANSLATION",
        &["SFORCE/1"],
    ),
    (
        "slider_crank",
        "JGRAV=-9.80665",
        "JGRAV=-9806.65",
        &["ACCGRAV"],
    ),
    (
        "slider_crank",
        "F2=DX(40,10)",
        "F2=DX(40,99)",
        &["REQUEST/1"],
    ),
    ("slider_crank", "WZ(20,10)", "WZ(20,99)", &["SFORCE/1"]),
    (
        "slider_crank",
        "REULER=90D,90D,0\nJOINT/1",
        "REULER=90,90,0\nJOINT/1",
        &["MARKER/41", "JOINT/4"],
    ),
    (
        "quarter_car",
        "VARIABLE/1, FUNCTION=DZ(30,20)-0.6",
        "VARIABLE/1, FUNCTION=DZ(30,20)-0.6+VARVAL(1)",
        &["VARIABLE/1"],
    ),
    (
        "quarter_car",
        "X=-0.3,-0.1,0,0.1,0.3",
        "X=-0.3,-0.1,0,0.1,0.05",
        &["SPLINE/1"],
    ),
    (
        "quarter_car",
        "X=-0.3,-0.1,0,0.1,0.3, Y=-9000,-2000,0,2000,9000",
        "X=-0.3, Y=-9000",
        &["SPLINE/1"],
    ),
    (
        "quarter_car",
        "AKISPL(VARVAL(1),0,1,0)",
        "AKISPL(VARVAL(1),0,2,0)",
        &["SFORCE/1"],
    ),
    (
        "quarter_car",
        "AKISPL(VARVAL(1),0,1,0)",
        "AKISPL(VARVAL(2),0,1,0)",
        &["SFORCE/1"],
    ),
    ("quarter_car", ",500,0.01)", ",500)", &["SFORCE/2"]),
    (
        "quarter_car",
        "DIFF/1, IC=0, FUNCTION=VARVAL(1)",
        "DIFF/1, IC=0, FUNCTION=SQRT(VARVAL(1))",
        &["DIFF/1"],
    ),
    (
        "quarter_car",
        "X=-0.3,-0.1,0,0.1,0.3, Y=-9000,-2000,0,2000,9000",
        "X=-0.003,-0.001,0,0.001,0.003, Y=-90,-20,0,20,90",
        &["SPLINE/1"],
    ),
    ("ball_and_pendulum", ", EXPONENT=1.5", "", &["CONTACT/1"]),
    ("ball_and_pendulum", "IGEOM=2", "IGEOM=3", &["CONTACT/1"]),
    (
        "ball_and_pendulum",
        "XSCALE=0.2",
        "XSCALE=-0.2",
        &["GRAPHICS/2"],
    ),
    (
        "ball_and_pendulum",
        "FRICTION/1, JOINT=1",
        "FRICTION/1, JOINT=9",
        &["FRICTION/1"],
    ),
    (
        "ball_and_pendulum",
        "STIFFNESS=100000",
        "STIFFNESS=1E20",
        &["CONTACT/1"],
    ),
    ("ball_and_pendulum", "KT=0,0,1", "KT=0,0,-1", &["BUSHING/1"]),
    (
        "ball_and_pendulum",
        "PART/3, MASS=2, CM=30, IP=0.1,0.1,0.1, QG=1,0,1",
        "PART/3, QG=1,0,1",
        &["PART/3"],
    ),
    (
        "ball_and_pendulum",
        "JOINT/1, REVOLUTE, I=31, J=11\n",
        "",
        &["PART/3", "FRICTION/1"],
    ),
    (
        "four_bar",
        "QG=400,0,0",
        "QG=400,10,0",
        &["PART/4", "JOINT/4", "JOINT/3"],
    ),
    (
        "four_bar",
        "MARKER/13, PART=1, QP=400,0,0",
        "MARKER/13, PART=1, QP=4000,0,0",
        &["JOINT/4", "MARKER/13"],
    ),
    (
        "four_bar",
        "JOINT/2, REVOLUTE, I=30, J=21\n",
        "",
        &["PART/3", "JOINT/2"],
    ),
    (
        "slider_crank",
        "-0.2*WZ(20,10)",
        "+0.2*WZ(20,10)",
        &["SFORCE/1"],
    ),
    ("slider_crank", "CM=32, IP", "CM=21, IP", &["PART/3"]),
    (
        "slider_crank",
        "MARKER/21, PART=2, QP=0.2,0,0",
        "MARKER/21, PART=2, QP=200,0,0",
        &["JOINT/2", "MARKER/21"],
    ),
    (
        "slider_crank",
        "MARKER/21, PART=2, QP=0.2,0,0",
        "MARKER/21, PART=2, QP=0.2,0,0.01",
        &["JOINT/2", "MARKER/21"],
    ),
    (
        "slider_crank",
        "IP=0.1,0.1,0.1",
        "IP=1E5,1E5,1E5",
        &["PART/2"],
    ),
    ("slider_crank", "K=100", "K=1E20", &["SPRINGDAMPER/1"]),
    (
        "slider_crank",
        "LENGTH=METER",
        "LENGTH=MILLIMETER",
        &["ACCGRAV", "UNITS"],
    ),
    (
        "quarter_car",
        "-1500*VZ(30,20)",
        "+1500*VZ(30,20)",
        &["SFORCE/1"],
    ),
    (
        "quarter_car",
        "KGRAV=-9.80665",
        "KGRAV=-9806.65",
        &["ACCGRAV"],
    ),
    (
        "quarter_car",
        "JOINT/1, TRANSLATIONAL",
        "JOINT/1, REVOLUTE",
        &["JOINT/1"],
    ),
    (
        "quarter_car",
        "AKISPL(VARVAL(1),0,1,0)",
        "AKISPL(1000*VARVAL(1),0,1,0)",
        &["SFORCE/1", "SPLINE/1"],
    ),
    (
        "quarter_car",
        "VARVAL(1),0,1,0",
        "1/(DZ(30,20)-DZ(30,20)),0,1,0",
        &["SFORCE/1"],
    ),
    (
        "ball_and_pendulum",
        "CONTACT/1, IGEOM=2, JGEOM=1, IMPACT, STIFFNESS=100000, DAMPING=100, DMAX=0.001, EXPONENT=1.5\n",
        "",
        &["PART/2"],
    ),
    (
        "ball_and_pendulum",
        "PART/2, MASS=1, CM=20, IP=0.004,0.004,0.004",
        "PART/2",
        &["PART/2"],
    ),
    (
        "ball_and_pendulum",
        "DAMPING=100",
        "DAMPING=-100",
        &["CONTACT/1"],
    ),
    (
        "ball_and_pendulum",
        "CT=0,0,0.1",
        "CT=0,0,-0.1",
        &["BUSHING/1"],
    ),
    (
        "ball_and_pendulum",
        "MU_DYNAMIC=0.08",
        "MU_DYNAMIC=-0.08",
        &["FRICTION/1"],
    ),
    (
        "gear_train",
        "QP=30,0,0, REULER=0,-90D,0",
        "QP=30,0,0",
        &["GEAR/1", "MARKER/13"],
    ),
    ("gear_train", "SCALES=60,1", "SCALES=0,0", &["COUPLER/1"]),
    ("gear_train", "SCALES=60,1", "SCALES=60,0", &["COUPLER/1"]),
    (
        "gear_train",
        "PART/1, GROUND",
        "PART/1, GROUND, VX=3",
        &["PART/1"],
    ),
    (
        "gear_train",
        "SFORCE/1, ROTATION, I=20, J=10",
        "MARKER/21, PART=2, QP=5,0,0\nSFORCE/1, ROTATION, I=20, J=21",
        &["SFORCE/1"],
    ),
    (
        "gear_train",
        "PART/3, MASS=2",
        "PART/3, VX=100, MASS=2",
        &["PART/3"],
    ),
    (
        "gear_train",
        "IP=150,150,300",
        "IP=150,150,300, WX=2",
        &["PART/2"],
    ),
    (
        "gear_train",
        "JOINT/1, REVOLUTE, I=20, J=10",
        "JOINT/1, REVOLUTE, I=20, J=10, PITCH=3",
        &["JOINT/1"],
    ),
    (
        "ball_and_pendulum",
        "XSCALE=0.2, YSCALE=0.2",
        "XSCALE=0.2",
        &["GRAPHICS/2"],
    ),
    (
        "ball_and_pendulum",
        "MU_DYNAMIC=0.08",
        "MU_DYNAMIC=0.8",
        &["FRICTION/1"],
    ),
    (
        "ball_and_pendulum",
        "QG=0,0,0.5",
        "QG=0,0,-0.5",
        &["CONTACT/1"],
    ),
    (
        "ball_and_pendulum",
        "SENSOR/1, FUNCTION=VARVAL(1)",
        "SENSOR/1, FUNCTION=1",
        &["SENSOR/1"],
    ),
    (
        "ball_and_pendulum",
        "DMAX=0.001, EXPONENT",
        "DMAX=0.001, MU_STATIC=0.3, EXPONENT",
        &["CONTACT/1"],
    ),
    (
        "ball_and_pendulum",
        "BUSHING/1, I=32, J=11, KT=0,0,1",
        "BUSHING/1, I=30, J=11, K=1000,0,0, KT=0,0,1",
        &["BUSHING/1"],
    ),
    (
        "quarter_car",
        "ACCGRAV",
        "INTEGRATOR/GSTIFF, ERROR=10\nACCGRAV",
        &["INTEGRATOR"],
    ),
    (
        "four_bar",
        "FUNCTION=360D*TIME",
        "ICVEL=3, FUNCTION=360D*TIME",
        &["MOTION/1"],
    ),
    ("gear_train", "TYPE=R:T", "TYPE=R:R", &["COUPLER/1"]),
    ("gear_train", "CT=20", "CT=-20", &["SPRINGDAMPER/1"]),
    ("gear_train", "-5*WZ(20,10)", "+5*WZ(20,10)", &["SFORCE/1"]),
    (
        "gear_train",
        "MASS=2, CM=30, IP=2000,2000,4000",
        "MASS=2, CM=30, IP=2000,2000,40000",
        &["PART/3"],
    ),
    (
        "gear_train",
        "JGRAV=-9806.65",
        "JGRAV=-386.09",
        &["ACCGRAV"],
    ),
    (
        "gear_train",
        "JOINT/3, TRANSLATIONAL, I=40, J=14",
        "JOINT/3, CYLINDRICAL, I=40, J=10",
        &["JOINT/3"],
    ),
    (
        "quarter_car",
        "VZ(20,10),0.3",
        "VZ(30,10),0.3",
        &["SFORCE/2"],
    ),
    (
        "quarter_car",
        "DZ(30,20)-0.6",
        "DZ(20,30)-0.6",
        &["SFORCE/1", "VARIABLE/1"],
    ),
    (
        "ball_and_pendulum",
        "PIN_RADIUS=0.01",
        "PIN_RADIUS=10",
        &["FRICTION/1"],
    ),
];

/// A folder of its own for what a test writes.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("broken_{name}"));
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// The exit code of a command, and all that it printed.
fn command(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let done = Command::new(env!("CARGO_BIN_EXE_cognate"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program runs");
    let text = [done.stdout, done.stderr].concat();
    let text = String::from_utf8_lossy(&text).into_owned();
    (done.status.code().unwrap_or(-1), text)
}

/// What a user asks of a model.
const CHECK: &[&str] = &["check"];
const VERIFY: &[&str] = &["verify"];
const RUN: &[&str] = &["run", "--end", "1", "--steps", "20", "--out", "results"];

/// The first line with an error or a warning that some commands come up with; none says anything
/// twice.
fn first_message(folder: &Path, model: &str, commands: &[&[&str]]) -> Option<String> {
    for command_line in commands {
        let arguments = [command_line, &[model][..]].concat();
        let (code, text) = command(folder, &arguments);
        assert!(!matches!(code, -1 | 1), "{arguments:?}: {text}");
        let speaks = |line: &&str| line.starts_with("error") || line.starts_with("warning");
        let said: Vec<&str> = text.lines().filter(speaks).collect();
        // a finding has its place behind it: two elements may lack the same
        let placed = text.lines().zip(text.lines().skip(1));
        let mut placed: Vec<_> = placed.filter(|(line, _)| speaks(line)).collect();
        placed.sort_unstable();
        let twice = placed.windows(2).find(|w| w[0] == w[1]);
        assert_eq!(twice, None, "{arguments:?}: {text}");
        if let Some(line) = said.first() {
            return Some((*line).to_owned());
        }
    }
    None
}

#[test]
fn nothing_is_wrong_with_the_sound_models() {
    for name in SOUND {
        let folder = folder(name);
        let model = format!("{name}.adm");
        let from = root("tests/data/broken").join(&model);
        std::fs::copy(from, folder.join(&model)).expect("a copy");
        let (code, text) = command(&folder, &["check", &model]);
        assert_eq!((code, text.contains("warning")), (0, false), "{text}");
    }
}

/// Asks commands for each fault; returns how many their first message names, and prints each.
fn named_first(name: &str, commands: &[&[&str]]) -> usize {
    let folder = folder(name);
    let mut named = 0;
    for (k, (model, from, to, elements)) in FAULTS.iter().enumerate() {
        let sound = root(&format!("tests/data/broken/{model}.adm"));
        let text = std::fs::read_to_string(sound).expect("a model");
        assert!(text.contains(from), "{model} has no {from:?}");
        let file = format!("fault_{k}.adm");
        std::fs::write(folder.join(&file), text.replace(from, to)).expect("written");
        let said = first_message(&folder, &file, commands).unwrap_or_default();
        let right = elements.iter().any(|e| said.contains(e));
        named += usize::from(right);
        println!(
            "{} {model}: {to:?}: {said}",
            if right { "named " } else { "MISSED" }
        );
    }
    println!("{named} of {} faults are named first", FAULTS.len());
    named
}

#[test]
fn the_first_message_names_the_fault() {
    let named = named_first("faults", &[CHECK, VERIFY, RUN]);
    assert!(
        named >= NAMED_FIRST,
        "{named} of {}, {NAMED_FIRST} before",
        FAULTS.len()
    );
}

#[test]
fn a_run_alone_names_the_fault_first_too() {
    let named = named_first("faults_run", &[RUN]);
    assert!(
        named >= NAMED_FIRST_BY_RUN,
        "{named} of {}, {NAMED_FIRST_BY_RUN} before",
        FAULTS.len()
    );
}
