//! A linear system as text: the table of its modes, JSON, and a script that Matlab and Octave read.

use super::Linearization;
use serde_json::json;
use std::fmt::Write;

impl Linearization {
    /// Writes the eigenvalues as a table.
    pub fn table(&self) -> String {
        let mut text = format!(
            "Modes at time {}\n{:>6} {:>22} {:>22} {:>22} {:>14}\n",
            self.time, "mode", "real", "imaginary", "frequency", "damping"
        );
        for (k, m) in self.modes.iter().enumerate() {
            // writing to a string cannot fail
            let _ = writeln!(
                text,
                "{:>6} {:>22.14e} {:>22.14e} {:>22.14e} {:>14.6e}",
                k + 1,
                m.re,
                m.im,
                m.frequency(),
                m.damping_ratio()
            );
        }
        text
    }

    /// Everything, for programs.
    pub fn json(&self) -> serde_json::Value {
        let shape = |p: &super::PartShape| json!({ "part": p.part, "translation": p.translation, "rotation": p.rotation });
        let mode = |m: &super::Mode| {
            let states = m
                .states
                .iter()
                .map(|(name, value)| json!({ "state": name, "value": value }));
            json!({
                "real": m.re,
                "imaginary": m.im,
                "frequency": m.frequency(),
                "damping_ratio": m.damping_ratio(),
                "parts": m.parts.iter().map(shape).collect::<Vec<_>>(),
                "states": states.collect::<Vec<_>>(),
            })
        };
        let unrest = |u: &super::Unrest| json!({ "element": u.subject.to_string(), "rate": u.rate.word(), "value": u.value });
        json!({
            "time": self.time,
            "states": self.states,
            "inputs": self.inputs,
            "outputs": self.outputs,
            "A": self.a,
            "B": self.b,
            "C": self.c,
            "D": self.d,
            "modes": self.modes.iter().map(mode).collect::<Vec<_>>(),
            "not_at_rest": self.unrest.as_ref().map(unrest),
        })
    }

    /// The matrices as a script that Matlab and Octave read.
    pub fn matlab(&self) -> String {
        let mut text = format!("% dz/dt = A z + B u, y = C z + D u at time {}\n", self.time);
        for (what, names) in [
            ("z", &self.states),
            ("u", &self.inputs),
            ("y", &self.outputs),
        ] {
            for (k, name) in names.iter().enumerate() {
                let _ = writeln!(text, "% {what}({}): {name}", k + 1);
            }
        }
        let (z, u, y) = (self.states.len(), self.inputs.len(), self.outputs.len());
        for (name, m, shape) in [
            ("A", &self.a, (z, z)),
            ("B", &self.b, (z, u)),
            ("C", &self.c, (y, z)),
            ("D", &self.d, (y, u)),
        ] {
            if shape.0 == 0 || shape.1 == 0 {
                let _ = writeln!(text, "{name} = zeros({},{});", shape.0, shape.1);
                continue;
            }
            let _ = writeln!(text, "{name} = [");
            for row in m {
                let row: Vec<String> = row.iter().map(|x| format!("{x:e}")).collect();
                let _ = writeln!(text, "{}", row.join(" "));
            }
            let _ = writeln!(text, "];");
        }
        text
    }
}
