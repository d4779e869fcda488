//! Arguments of commands have an effect, or it is said that they have none.

use crate::running;
use cognate::analysis::session::Session;
use cognate::analysis::session::script::obey;
use cognate::analysis::watch::Unwatched;
use cognate::dataset::command::Script;
use cognate::diagnostic::Diagnostic;
use cognate::internals::dataset::manual;
use std::fmt::Write;

/// A body on a damped spring that is pushed ever more, with two sets of plant inputs and outputs.
const MODEL: &str = "PART/2, MASS=2, CM=20, IP=.1,.2,.3, VX=1\nMARKER/20, PART=2, QP=1,0,0\nMARKER/12, PART=1, REULER=90D,90D,0\n\
    MARKER/22, PART=2, REULER=90D,90D,0\nJOINT/1, TRANSLATIONAL, I=22, J=12\nJOINT/2, TRANSLATIONAL, I=22, J=12\n\
    SPRINGDAMPER/1, TRANSLATIONAL, I=20, J=1, K=10, C=1, LENGTH=1\nVARIABLE/1, FUNCTION=TIME\nVARIABLE/2, FUNCTION=DX(20,1)\n\
    SFORCE/1, TRANSLATIONAL, I=20, J=1, FUNCTION=VARVAL(1)\nSFORCE/2, TRANSLATIONAL, I=20, J=1, FUNCTION=1\nDIFF/1, IC=1, FUNCTION=-DIF(1)\n\
    PINPUT/1, VARIABLES=1\nPINPUT/2, VARIABLES=2\nPOUTPUT/1, VARIABLES=1\nPOUTPUT/2, VARIABLES=2\n";

fn note(said: &mut String, all: &[Diagnostic]) {
    for d in all {
        let _ = writeln!(said, "{} {}", d.code, d.message);
    }
}

/// What comes out of a command, and all that is said about it.
fn outcome(command: &str) -> String {
    let mut said = String::new();
    let text = format!(
        "\nSIMULATE/DYNAMIC, END=0.1, STEPS=1\n{command}\nSIMULATE/DYNAMIC, DURATION=0.1, STEPS=1\n"
    );
    let script = match Script::from_text(&text) {
        Ok(script) => script,
        Err(errors) => {
            note(&mut said, errors.diagnostics());
            return said;
        }
    };
    note(&mut said, &script.diagnostics);
    let mut s: Session = running::session(MODEL, &["DX(20,1)", "VX(20,1)"], 1e-6);
    match obey(&mut s, &script.steps, |_, _| (), &mut Unwatched) {
        Err(errors) => note(&mut said, errors.diagnostics()),
        Ok(status) => {
            let _ = writeln!(said, "{status:?}");
        }
    }
    for w in &s.run.record.warnings {
        let _ = writeln!(said, "{} {}", w.code, w.sentence());
    }
    for column in &s.run.columns {
        let _ = writeln!(said, "{} {:?}", column.name, column.values);
    }
    for (file, matrices, found) in &s.linear {
        let _ = writeln!(said, "{file:?} {matrices} {found:?}");
    }
    let _ = writeln!(said, "{:?}", s.saved.keys());
    said
}

/// A value that an argument may have; `None`: it is a word alone.
fn value(argument: &str) -> Option<&'static str> {
    Some(match argument {
        "END" => "0.7",
        "DURATION" => "0.6",
        "STEPS" => "3",
        "DTOUT" => "0.05",
        "COORDS" => "1,1",
        "RM" | "PINPUT" | "POUTPUT" | "ID" => "1",
        "RANGE" => "1,2",
        "FILE" | "FORMAT" | "SYSTEM" | "MODEL" | "OUTPUT_PREFIX" | "COMMAND" => "other",
        _ => return None,
    })
}

/// Commands to which each further argument of theirs is added.
const COMMANDS: &[&str] = &[
    "SIMULATE/DYNAMIC, DURATION=1",
    "SIMULATE/DYNAMIC, END=1",
    "SIMULATE/TRANSIENT, END=1, STEPS=2",
    "SIMULATE/STATIC",
    "SIMULATE/STATIC, END=0.2",
    "SIMULATE/STATIC, DURATION=0.2",
    "SIMULATE/INITIAL_CONDITIONS",
    "DEACTIVATE/SFORCE, RANGE=1,2\nACTIVATE/SFORCE, ID=2",
    "DEACTIVATE/SFORCE, ID=2",
    "DEACTIVATE/SFORCE, RANGE=2,2",
    "LINEAR/EIGENSOL",
    "LINEAR/STATEMAT",
    "SAVE/SYSTEM=here",
    "RELOAD/SYSTEM=here",
    "FILE/COMMAND=here",
];

#[test]
fn each_argument_of_a_command_has_an_effect_or_is_told() {
    let mut silent = Vec::new();
    for command in COMMANDS {
        let without = outcome(command);
        let (keyword, given) = command.lines().last().unwrap().split_once('/').unwrap();
        let page = manual::page(keyword).expect("a page of the manual");
        for argument in page.notes.iter().map(|note| note.name) {
            if given.contains(argument) {
                continue;
            }
            let with = match value(argument) {
                Some(value) => format!("{command}, {argument}={value}"),
                None => format!("{command}, {argument}"),
            };
            if outcome(&with) == without {
                silent.push(with);
            }
        }
    }
    assert_eq!(silent, [""; 0]);
}

#[test]
fn a_static_simulation_does_not_end_before_it_begins() {
    let said = outcome("SIMULATE/STATIC, END=0.05");
    assert!(said.starts_with("no_end"), "{said}");
}

#[test]
fn words_after_the_kind_of_element_are_told() {
    for command in [
        "DEACTIVATE/SFORCE, MOTION, ID=2",
        "DEACTIVATE/SFORCE, ID=2, WHEN=3",
    ] {
        let said = outcome(command);
        assert!(said.contains("no_effect"), "{said}");
    }
}

#[test]
fn commands_that_ask_for_a_print_are_told_by_name() {
    for keyword in ["INFO", "SHOW", "TIME", "LIST", "HELP", "MENU"] {
        let script = Script::from_text(&format!("\n{keyword}\nSTOP\n")).unwrap();
        let told = script
            .diagnostics
            .iter()
            .any(|d| d.code == "ignored" && d.to_string().contains(keyword));
        assert!(told, "{keyword}: {:?}", script.diagnostics);
    }
}
