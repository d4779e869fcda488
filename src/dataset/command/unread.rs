//! Arguments of a command that nothing reads, as its others stand: END of INITIAL_CONDITIONS.

use super::{Command, Record, Simulate, SimulationKind};
use crate::diagnostic::Diagnostic;

/// Returns the words of ACTIVATE and DEACTIVATE that follow the kind of element.
pub(super) fn words(record: &Record) -> Vec<String> {
    if !record.row.reads_others() {
        return Vec::new();
    }
    // the first without a value is the kind
    let kind = record.kept.iter().position(|(_, value)| value.is_empty());
    let others = record.kept.iter().enumerate();
    others
        .filter(|(k, _)| Some(*k) != kind)
        .map(|(_, (word, _))| word.to_ascii_uppercase())
        .collect()
}

/// Returns a warning that names the arguments of a command that change nothing; `others`: those
/// that are none of its own.
pub(super) fn arguments(command: &Command, others: &[String]) -> Option<Diagnostic> {
    let (keyword, words, why) = match command {
        Command::Simulate(s) => {
            let (words, why) = of_simulate(s);
            ("SIMULATE", words, why)
        }
        Command::Activate { on, .. } => {
            let keyword = if *on { "ACTIVATE" } else { "DEACTIVATE" };
            let words = others.iter().map(String::as_str).collect();
            (keyword, words, "one kind of element is named at a time")
        }
        Command::File {
            command: Some(_),
            model,
            output_prefix,
        } => {
            let all = [
                (model.is_some(), "MODEL"),
                (output_prefix.is_some(), "OUTPUT_PREFIX"),
            ];
            let why = "those of the command file that COMMAND names are taken";
            ("FILE", given(&all), why)
        }
        Command::Save(Some(name)) if name.contains(['/', '\\']) => {
            let why = "states are kept beside the results";
            ("SAVE", vec!["the folder of SYSTEM"], why)
        }
        Command::File { .. }
        | Command::Change(_)
        | Command::Linear(_)
        | Command::Save(_)
        | Command::Reload(_)
        | Command::Show(_)
        | Command::Stop => return None,
    };
    if words.is_empty() {
        return None;
    }
    let what = format!("{} changes nothing here: {why}", words.join(", "));
    Some(Diagnostic::warning("no_effect", what).element(keyword))
}

/// Returns the names of the arguments that are given.
fn given(all: &[(bool, &'static str)]) -> Vec<&'static str> {
    all.iter().filter(|a| a.0).map(|a| a.1).collect()
}

/// Returns the arguments of a SIMULATE that its kind does not read, and why.
fn of_simulate(s: &Simulate) -> (Vec<&'static str>, &'static str) {
    let ends = [(s.end.is_some(), "END"), (s.duration.is_some(), "DURATION")];
    let outputs = [(s.steps.is_some(), "STEPS"), (s.dtout.is_some(), "DTOUT")];
    match s.kind {
        SimulationKind::InitialConditions => {
            let all = [ends, outputs].concat();
            (
                given(&all),
                "INITIAL_CONDITIONS assembles, and no time passes",
            )
        }
        SimulationKind::Static if s.end.is_none() && s.duration.is_none() => (
            given(&outputs),
            "STATIC without END or DURATION finds one equilibrium",
        ),
        SimulationKind::Static
        | SimulationKind::Kinematic
        | SimulationKind::Dynamic
        | SimulationKind::Transient => (Vec::new(), ""),
    }
}
