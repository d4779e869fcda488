//! Simulations of a command file as commands of the solver.
//!
//! The last that the file asks for counts: commands at its end, else the script `Last_Sim`
//! that View keeps of what ran last, else the last script.

use super::commands::{self, Meaning};
use super::database::Database;
use super::interpret::Simulation;
use super::make::DECIMALS;
use super::syntax;
use crate::dataset::syntax::Source;
use crate::diagnostic::{Diagnostic, Severity};

/// Steps of a simulation whose number is not said.
const USUAL_STEPS: &str = "10";

/// Returns the commands, and what is said about them.
pub(super) fn commands(
    source: &Source,
    db: &Database,
    bare: &[Simulation],
) -> (Option<String>, Vec<Diagnostic>) {
    let mut out = Vec::new();
    let mut lines = Vec::new();
    for simulation in bare {
        lines.extend(one(source, db, simulation, &mut out, 0));
    }
    if lines.is_empty() {
        let scripts: Vec<usize> = db.of_kind("simulation script").collect();
        let last = scripts
            .iter()
            .find(|k| db.short_name(**k).eq_ignore_ascii_case("Last_Sim"));
        if let Some(k) = last.or(scripts.last()) {
            lines.extend(of_script(source, db, *k, &mut out, 0));
        }
    }
    let all = (!lines.is_empty()).then(|| lines.join("\n") + "\n");
    (all, out)
}

/// Returns the commands of a script: those of the solver, of View, or a simulation by arguments.
fn of_script(
    source: &Source,
    db: &Database,
    k: usize,
    out: &mut Vec<Diagnostic>,
    depth: usize,
) -> Vec<String> {
    let solver = db.texts(k, "solver_commands");
    if !solver.is_empty() {
        let text = solver.join("\n");
        // a trailing `&` goes on as it does in a command file
        return text
            .lines()
            .map(|line| line.trim_end().to_owned())
            .collect();
    }
    let view = db.texts(k, "commands");
    if !view.is_empty() {
        let inner = Source::from_text(None, view.join("\n"));
        let mut wrong = Vec::new();
        let all = syntax::commands(&inner, &mut wrong);
        let simulations = all.iter().filter_map(|command| {
            let words: Vec<&str> = command.words.iter().map(|w| inner.slice(*w)).collect();
            let Meaning::Row(row, _) = commands::meaning(&words) else {
                return None;
            };
            let arguments = command.arguments.iter().filter_map(|a| {
                let name = commands::argument(row, inner.slice(a.name)).ok()?;
                let texts = a.values.iter();
                let texts = texts.map(|value| inner.slice(value.span).trim_matches('"'));
                Some((name, texts.collect::<Vec<&str>>().join(",")))
            });
            row.kind
                .starts_with("simulation single_run")
                .then(|| Simulation {
                    kind: row.kind.as_str(),
                    arguments: arguments.collect(),
                    span: db.span(k, "commands"),
                })
        });
        let simulations: Vec<Simulation> = simulations.collect();
        return simulations
            .iter()
            .flat_map(|simulation| one(source, db, simulation, out, depth))
            .collect();
    }
    let names = [
        "type",
        "initial_static",
        "number_of_steps",
        "step_size",
        "end_time",
        "duration",
    ];
    let arguments = names
        .iter()
        .filter_map(|name| Some((*name, db.word(k, name)?)));
    let simulation = Simulation {
        kind: "simulation single_run transient",
        arguments: arguments.collect(),
        span: db.objects[k].head,
    };
    one(source, db, &simulation, out, depth)
}

/// Returns what is wrong with an argument of a simulation that is a number.
fn mistaken(name: &str, text: &str) -> Option<String> {
    let is_count = name == "number_of_steps";
    let is_time = matches!(name, "end_time" | "duration" | "step_size");
    if !is_count && !is_time {
        return None;
    }
    let number: Option<f64> = text.trim().parse().ok().filter(|x: &f64| x.is_finite());
    let is_meant = number.is_some_and(|x| match is_count {
        true => x >= 0.0 && x.fract() == 0.0,
        false => x > 0.0 || name == "end_time" && x == 0.0,
    });
    let meant = match is_count {
        true => "a whole number",
        false => "a time",
    };
    (!is_meant).then(|| format!("{name} = {text}: {meant} is meant"))
}

/// Returns the commands of one simulation.
fn one(
    source: &Source,
    db: &Database,
    simulation: &Simulation,
    out: &mut Vec<Diagnostic>,
    depth: usize,
) -> Vec<String> {
    let of = |name: &str| {
        let mut all = simulation.arguments.iter();
        all.find(|(n, _)| *n == name)
            .map(|(_, value)| value.as_str())
    };
    let is = |name: &str| {
        of(name)
            .is_some_and(|word| word.eq_ignore_ascii_case("yes") || word.eq_ignore_ascii_case("on"))
    };
    let mut lines = Vec::new();
    match simulation.kind.rsplit(' ').next().unwrap_or_default() {
        "equilibrium" => lines.push("SIMULATE/STATIC".to_owned()),
        "assemble" => lines.push("SIMULATE/INITIAL_CONDITIONS".to_owned()),
        "eigensolution" => lines.push("LINEAR/EIGENSOL".to_owned()),
        "scripted" => {
            let script = of("sim_script_name").and_then(|name| db.find(name));
            match script.filter(|_| depth < 4) {
                Some(k) => lines.extend(of_script(source, db, k, out, depth + 1)),
                None => {
                    let d = Diagnostic::warning(
                        "view_left_out",
                        "the script that is to be run is not in this file",
                    );
                    out.push(source.locate(d, simulation.span));
                }
            }
        }
        "transient" => {
            let wrong = simulation.arguments.iter();
            for what in wrong.filter_map(|(name, text)| mistaken(name, text)) {
                let d = Diagnostic::error("view_expression", what);
                out.push(source.locate(d.help(DECIMALS), simulation.span));
            }
            if is("initial_static") {
                lines.push("SIMULATE/STATIC".to_owned());
            }
            let kind = match of("type").unwrap_or_default().to_ascii_lowercase() {
                word if word.starts_with("dyn") => "DYNAMIC",
                word if word.starts_with("kin") => "KINEMATIC",
                word if word.starts_with("sta") => "STATIC",
                _ => "TRANSIENT",
            };
            let span = match (of("end_time"), of("duration")) {
                (None, Some(duration)) => format!("DURATION={duration}"),
                (end, _) => format!("END={}", end.unwrap_or("1")),
            };
            let rows = match (of("number_of_steps"), of("step_size")) {
                (None, Some(step)) => format!("DTOUT={step}"),
                (steps, _) => format!("STEPS={}", steps.unwrap_or(USUAL_STEPS)),
            };
            if is("forever") {
                let what = "a simulation without an end is run to its end_time";
                let d = Diagnostic {
                    severity: Severity::Note,
                    ..Diagnostic::warning("view_left_out", what)
                };
                out.push(source.locate(d, simulation.span));
            }
            lines.push(["SIMULATE/", kind, ", ", &span, ", ", &rows].concat());
        }
        _ => {}
    }
    lines
}
