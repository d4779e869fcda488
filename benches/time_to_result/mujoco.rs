//! The peer: models in MuJoCo's language, and the time that MuJoCo takes to load one and to step it through the span that `cognate` runs.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

/// Loads a model and steps it for 0.01 s (five of MuJoCo's own steps); prints the seconds, without those in which Python starts.
const LOAD_AND_STEP: &str = "\
import sys, time, mujoco
begin = time.perf_counter()
model = mujoco.MjModel.from_xml_path(sys.argv[1])
data = mujoco.MjData(model)
while data.time < 0.01 - 1e-9:
    mujoco.mj_step(model, data)
print(time.perf_counter() - begin)
";

/// MuJoCo, if the Python of this machine has it (`pip install mujoco`).
pub struct Peer {
    version: Option<String>,
}

impl Peer {
    pub fn found() -> Self {
        let version = python(&["-c", "import mujoco; print(mujoco.__version__)"]);
        Self { version }
    }

    /// A line on whom the times are compared with.
    pub fn told(&self) -> String {
        match &self.version {
            Some(version) => format!(
                "MuJoCo {version}: loading and stepping alone, in a Python that runs already; steps of 0.002 s, errors not controlled"
            ),
            None => "MuJoCo is left out: `python3 -c \"import mujoco\"` fails (pip install mujoco)"
                .into(),
        }
    }

    /// The seconds it takes to load a model and to step it; none without MuJoCo.
    pub fn run(&self, file: &Path) -> Option<f64> {
        self.version.as_ref()?;
        let printed = python(&["-c", LOAD_AND_STEP, &file.to_string_lossy()]);
        let printed = printed.expect("MuJoCo runs the model");
        Some(printed.parse().expect("MuJoCo's seconds"))
    }
}

/// What `python3` prints; none where there is none or it fails.
fn python(arguments: &[&str]) -> Option<String> {
    let done = Command::new("python3").args(arguments).output().ok()?;
    let printed = String::from_utf8_lossy(&done.stdout).trim().to_string();
    done.status.success().then_some(printed)
}

/// A model: its bodies, and what stands beside them.
fn model(bodies: &str, beside: &str) -> String {
    format!(
        "<mujoco><option gravity=\"0 -9.81 0\"/>\n<worldbody>\n{bodies}</worldbody>\n{beside}</mujoco>\n"
    )
}

/// What makes a body of unit mass, its centre where its frame is.
const INERTIA: &str = "<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"0.1 0.1 0.1\"/>";
const HINGE: &str = "<joint type=\"hinge\" axis=\"0 0 1\"/>";

pub fn four_bars(n: usize) -> String {
    let (mut bodies, mut ties) = (String::new(), String::new());
    for k in 0..n {
        let angle = 1.0 + 0.001 * (k % 7) as f64;
        let (crank, coupler, rocker, base) = (0.3, 1.0, 0.8, 0.9);
        let a = [crank * f64::cos(angle), crank * f64::sin(angle)];
        let (dx, dy) = (base - a[0], -a[1]);
        let r = f64::hypot(dx, dy);
        let along = (coupler * coupler - rocker * rocker + r * r) / (2.0 * r);
        let across = f64::sqrt(coupler * coupler - along * along);
        // the end of the coupler, in its frame, which is that of ground
        let b = [
            (along * dx - across * dy) / r,
            (along * dy + across * dx) / r,
        ];
        let (ax, ay, bx, by) = (a[0], a[1], b[0], b[1]);
        let _ = writeln!(
            bodies,
            "<body pos=\"0 0 {k}\">{HINGE}{INERTIA}<body name=\"q{k}\" pos=\"{ax:?} {ay:?} 0\">{HINGE}{INERTIA}</body></body>\n\
             <body name=\"s{k}\" pos=\"{base} 0 {k}\">{HINGE}{INERTIA}</body>"
        );
        let _ = writeln!(
            ties,
            "<connect body1=\"q{k}\" body2=\"s{k}\" anchor=\"{bx:?} {by:?} 0\"/>"
        );
    }
    model(&bodies, &format!("<equality>\n{ties}</equality>\n"))
}

pub fn chain(n: usize) -> String {
    let mut bodies = String::new();
    for k in 0..n {
        let x = usize::from(k > 0);
        let _ = writeln!(bodies, "<body pos=\"{x} 0 0\">{HINGE}{INERTIA}");
    }
    bodies.push_str(&"</body>\n".repeat(n));
    model(&bodies, "")
}

pub fn free_parts(n: usize) -> String {
    let (mut bodies, mut speeds) = (String::new(), String::new());
    for k in 0..n {
        let (x, y) = (k % 10, k / 10);
        let _ = writeln!(
            bodies,
            "<body pos=\"{x} {y} 0\"><freejoint/>{INERTIA}</body>"
        );
        speeds.push_str("0 0 0 1 0.1 0 ");
    }
    let start = format!("<keyframe><key qvel=\"{speeds}\"/></keyframe>\n");
    model(&bodies, &start)
}

pub fn contacts(n: usize) -> String {
    let mut bodies = String::from("<geom type=\"plane\" size=\"1000 1000 1\"/>\n");
    for k in 0..n {
        let (x, y) = (3 * (k % 30), 3 * (k / 30));
        let _ = writeln!(
            bodies,
            "<body pos=\"{x} {y} 1.1\"><freejoint/>{INERTIA}<geom type=\"sphere\" size=\"1\"/></body>"
        );
    }
    model(&bodies, "")
}
