//! `.msg` logs: what happened, in the lines that users' scripts look for.
//!
//! Scripts find `command:` echoes, the table of steps (time, step, evaluations, steps, order, CPU
//! time), the list of redundant equations, boxes `---- START: WARNING ----`, and `Finished -----`
//! with the times below it. Those lines keep their form here; the rest is ours.

use super::{Event, Kind, Run};
use std::fmt::Write;

/// The frame of the title.
const RULE: &str =
    "-------------------------------------------------------------------------------";

/// The head of the table of steps.
const TABLE_HEAD: &str = "
   Simulation      Step        Function    Cumulative   Integration     CPU
      Time         Size       Evaluations  Steps Taken    Order        time
   ___________  ___________   ___________  ___________   _________    ________
";

/// Writes the log of a run.
pub fn write(run: &Run) -> String {
    let mut text = format!("\n cognate {}\n\n", env!("CARGO_PKG_VERSION"));
    let mut in_table = false;
    for event in &run.log {
        let is_row = matches!(event, Event::Progress { .. });
        if is_row && !in_table {
            text.push_str(TABLE_HEAD);
        }
        in_table = is_row;
        // writing to a String cannot fail
        let _ = write_event(&mut text, event);
    }
    text
}

fn write_event(text: &mut String, event: &Event) -> std::fmt::Result {
    match event {
        Event::Command(command) => {
            let mut lines = command.lines();
            lines.try_for_each(|line| writeln!(text, " command: {line}"))
        }
        Event::Title(title) => write_title(text, title),
        Event::Redundant { time, equations } => write_redundant(text, *time, equations),
        Event::Info(message) => writeln!(text, "\n  {message}"),
        Event::Warning(message) => boxed(text, "WARNING", message),
        Event::Error(message) => boxed(text, "ERROR", message),
        Event::InitialConditions { time, iterations } => writeln!(
            text,
            "\n\n  Begin Displacement Initial Conditions\n\n  Time T={}.\n  \
             Converged in {iterations} iterations\n\n  End Displacement Initial Conditions",
            fortran(*time, 9)
        ),
        Event::Static {
            time,
            iterations,
            imbalance,
        } => writeln!(
            text,
            "\n\n  Begin Static Solution\n\n  Time T={}.\n  \
             Static Solution converged in {iterations} iterations\n  \
             Residual imbalance is less than {}\n\n  End Static Solution",
            fortran(*time, 9),
            fortran(*imbalance, 5)
        ),
        Event::Begin {
            kind,
            integrator,
            formulation,
            error,
        } => write_begin(text, *kind, integrator, formulation, *error),
        Event::Progress {
            time,
            step,
            evaluations,
            steps,
            order,
            seconds,
        } => {
            let (time, step) = (fortran(*time, 5), fortran(*step, 5));
            let clock = clock(*seconds);
            writeln!(
                text,
                "   {time}  {step}{evaluations:13}{steps:13}{order:8}{clock:>16} "
            )
        }
        Event::End => writeln!(text, "\n  End Simulation"),
        Event::Finished { elapsed, cpu } => {
            let used = *elapsed > 0.0;
            let share = if used { 100.0 * cpu / elapsed } else { 100.0 };
            writeln!(
                text,
                "\n\nFinished -----\n\
                 Elapsed time = {elapsed:.2}s,  CPU time = {cpu:.2}s,  {share:.2}%\n"
            )
        }
    }
}

fn write_title(text: &mut String, title: &str) -> std::fmt::Result {
    let (heading, double, empty) = ("Model Title", "=".repeat(77), "");
    writeln!(
        text,
        "\n{RULE}\n|{heading:^77}|\n|{double}|\n|{empty:77}|\n|{title:^77}|\n|{empty:77}|\n{RULE}\n"
    )
}

fn write_redundant(
    text: &mut String,
    time: f64,
    equations: &[(String, String)],
) -> std::fmt::Result {
    let heading = "Degree-of-freedom analysis identified redundant constraints in the model:";
    let (time, rule) = (fortran(time, 9), "-".repeat(heading.len()));
    writeln!(text, "  Time T={time}.\n  {heading}\n  {rule}")?;
    for (equation, element) in equations {
        writeln!(
            text,
            "   -  deactivating constraint equation  {equation} in model.{element}"
        )?;
    }
    writeln!(
        text,
        "  The motion is the same without them; reactions of these joints are not unique."
    )?;
    writeln!(text)
}

fn write_begin(
    text: &mut String,
    kind: Kind,
    integrator: &str,
    formulation: &str,
    error: f64,
) -> std::fmt::Result {
    let kind = if kind == Kind::Kinematic {
        "Kinematic"
    } else {
        "Dynamic"
    };
    let method = format!("{integrator} {formulation}");
    let method = method.trim_end();
    writeln!(
        text,
        "\n\n  Begin Simulation\n\n  \
         ****** Performing {kind} Simulation using {method} Integrator ******"
    )?;
    let error = fortran(error, 6);
    writeln!(
        text,
        "   The integrator is {integrator}\n   Integration error = {error:>15}"
    )
}

fn boxed(text: &mut String, grade: &str, message: &str) -> std::fmt::Result {
    writeln!(
        text,
        "\n---- START: {grade} ----\n{}\n---- END: {grade} ----\n",
        message.trim_end()
    )
}

/// Writes a number as FORTRAN's `E` format does: `-1.50000E-02`.
fn fortran(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$E}");
    // Rust writes exponents without leading zero and plus
    let Some((mantissa, exponent)) = text.split_once('E') else {
        return text;
    };
    let negative = exponent.strip_prefix('-');
    let (sign, digits) = negative.map_or(('+', exponent), |digits| ('-', digits));
    format!("{mantissa}E{sign}{digits:0>2}")
}

/// Writes seconds as the table shows them: `20.06`, `8:40`, `1:30:52`.
fn clock(seconds: f64) -> String {
    let seconds = if seconds.is_finite() {
        seconds.clamp(0.0, 1e9)
    } else {
        0.0
    };
    if seconds < 59.995 {
        return format!("{seconds:.2}");
    }
    let whole = seconds.round() as u64;
    let (hours, minutes, seconds) = (whole / 3600, whole / 60 % 60, whole % 60);
    if hours > 0 {
        format!("{hours}:{minutes:02}:{seconds:02}")
    } else {
        format!("{minutes}:{seconds:02}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::Units;

    #[test]
    fn rows_of_the_table_stand_in_the_columns_scripts_expect() {
        let mut run = Run::new("r", "t", Units::default());
        let row = |time, step, evaluations, steps, seconds| Event::Progress {
            time,
            step,
            evaluations,
            steps,
            order: 1,
            seconds,
        };
        run.log = vec![
            row(0.0, 5e-4, 0, 0, 0.0),
            row(0.5, 0.01, 55, 55, 5452.0),
            Event::End,
        ];
        let text = write(&run);
        let lines: Vec<&str> = text.lines().filter(|l| l.contains("E-0")).collect();
        assert_eq!(
            lines[0],
            "   0.00000E+00  5.00000E-04            0            0       1            0.00 "
        );
        assert_eq!(
            lines[1],
            "   5.00000E-01  1.00000E-02           55           55       1         1:30:52 "
        );
        assert_eq!(text.matches("Evaluations").count(), 1, "one head per table");
    }

    #[test]
    fn the_title_is_boxed_and_redundant_equations_are_named() {
        let mut run = Run::new("r", "t", Units::default());
        run.log = vec![
            Event::Title("Adams View model name: x".into()),
            Event::Redundant {
                time: 0.0,
                equations: vec![("Zi.Xj".into(), "JOINT_2".into())],
            },
            Event::Finished {
                elapsed: 0.19,
                cpu: 0.16,
            },
        ];
        let text = write(&run);
        assert!(
            text.contains(
                "|                          Adams View model name: x                           |\n"
            ),
            "{text}"
        );
        assert!(text.contains("   -  deactivating constraint equation  Zi.Xj in model.JOINT_2\n"));
        assert!(
            text.contains("\nFinished -----\nElapsed time = 0.19s,  CPU time = 0.16s,  84.21%\n")
        );
    }

    #[test]
    fn numbers_have_signed_exponents_of_two_digits() {
        assert_eq!(
            [0.0, -0.015, 1e10, 1e-100].map(|x| fortran(x, 5)),
            ["0.00000E+00", "-1.50000E-02", "1.00000E+10", "1.00000E-100"]
        );
    }
}
