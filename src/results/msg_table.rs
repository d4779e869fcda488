//! Reading `.msg` logs: the tables of steps, as a table of its own.
//!
//! Card: below a head of words and a rule of underscores stand rows of six columns: time, size of
//! the step, evaluations, steps so far, order, processor time (seconds, or minutes:seconds). A row
//! of equilibria has no table. Every simulation is announced by a line
//! `****** Performing … ******`.

use super::{Kind, Run, Units, malformed};
use crate::diagnostic::Diagnostic;

/// Names of the columns after time.
const NAMES: [&str; 5] = [
    "step size",
    "function evaluations",
    "steps taken",
    "order",
    "processor time",
];

/// Reads the steps of all simulations of a log.
///
/// # Errors
/// When there is no table of steps.
pub fn read(bytes: &[u8]) -> Result<Run, Diagnostic> {
    let text = String::from_utf8_lossy(bytes);
    // a log does not say in which units the model is
    let units = Units {
        time: String::new(),
        ..Units::default()
    };
    let mut run = Run::new("", "steps of the integration", units);
    for (name, unit) in NAMES.iter().zip(["", "", "", "", "s"]) {
        run.add_column(*name, unit);
    }
    let (mut kind, mut is_open) = (Kind::Dynamic, false);
    for line in text.lines() {
        let line = line.trim();
        if let Some(what) = line.strip_prefix("****** Performing ") {
            kind = kind_named(what);
        } else if line == "Begin Simulation" {
            is_open = false;
        } else if let Some(row) = step(line) {
            if !is_open {
                run.end();
                run.begin(kind);
                is_open = true;
            }
            run.push(&row);
        }
        run.end();
    }
    match run.rows() {
        0 => Err(malformed(0, "there is no table of steps in this log")
            .help("the results of a run are in its .res, .csv, .req or .gra")),
        _ => Ok(run),
    }
}

/// Returns the kind of a simulation that a line announces.
fn kind_named(what: &str) -> Kind {
    match what.split_whitespace().next().unwrap_or_default() {
        "Kinematic" => Kind::Kinematic,
        "Static" => Kind::Static,
        quasi if quasi.starts_with("Quasi") => Kind::QuasiStatic,
        _ => Kind::Dynamic,
    }
}

/// Reads a row of the table.
fn step(line: &str) -> Option<[f64; 6]> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let &[time, size, evaluations, steps, order, clock] = words.as_slice() else {
        return None;
    };
    let number = |text: &str| text.parse::<f64>().ok().filter(|x| x.is_finite());
    let seconds = match clock.split_once(':') {
        Some((minutes, seconds)) => 60.0 * number(minutes)? + number(seconds)?,
        None => number(clock)?,
    };
    let [time, size, evaluations, steps, order] =
        [time, size, evaluations, steps, order].map(number);
    Some([time?, size?, evaluations?, steps?, order?, seconds])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_read_by_simulation() {
        let log = "\
  Begin Simulation
  ****** Performing Dynamic Simulation using Gstiff I3 Integrator ******
   0.00000E+00  2.50000E-04            0            0       1            2.33
   5.00000E-03  2.12500E-03            5            5       2            1:02.5
  End Simulation
  Begin Simulation
  ****** Performing Kinematic Simulation ******
   5.00000E-03  2.12500E-03            6            6       2            3
";
        let run = read(log.as_bytes()).unwrap();
        let names: Vec<(&str, usize)> = run
            .sequences
            .iter()
            .map(|s| (s.name.as_str(), s.rows.len()))
            .collect();
        assert_eq!(names, [("dynamic_001", 2), ("kinematic_001", 1)]);
        assert_eq!(run.column("processor time"), Some(&[2.33, 62.5, 3.0][..]));
        assert_eq!(run.column("order"), Some(&[1.0, 2.0, 2.0][..]));
        assert_eq!(read(b"nothing").unwrap_err().code, "result_syntax");
    }
}
