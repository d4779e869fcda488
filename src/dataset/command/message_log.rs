//! Message logs: the commands and the simulations that a run has written down.

use super::*;

/// The meaning of a line of a log.
enum Note {
    Begin,
    /// the table of steps shows this time
    Time(f64),
    Kind(SimulationKind),
    End,
}

pub(super) fn of_message_log(log: &Source) -> Result<Script, Error> {
    // Commands stay where they are, everything else is blanked: all places stay.
    let mut text = String::with_capacity(log.text.len());
    let mut notes = Vec::new();
    for (k, line) in log.text.split_inclusive('\n').enumerate() {
        let bare = line.trim_end_matches(['\n', '\r']);
        let command = bare.trim_start().strip_prefix("command:");
        let nested = |c: &str| {
            c.trim_start()
                .get(..5)
                .is_some_and(|s| s.eq_ignore_ascii_case("FILE/"))
        };
        match command.filter(|c| !nested(c)) {
            Some(command) => {
                text.push_str(&" ".repeat(bare.len() - command.len()));
                text.push_str(command);
            }
            None => {
                text.push_str(&" ".repeat(bare.len()));
                notes.extend(note(bare).map(|n| (k + 1, n)));
            }
        }
        text.push_str(&line[bare.len()..]);
    }
    let body = Source::from_text(log.file.as_deref(), text);
    let mut script = Script::default();
    let mut out = Vec::new();
    let syntax = syntax::script(&body, &mut out);
    take_steps(&body, &syntax, &mut script, &mut out);
    script.steps = merged(std::mem::take(&mut script.steps), simulations(&notes));
    finish(script, out)
}

/// Commands and simulations by line; the first simulation after a SIMULATE command is what that
/// command asked for.
fn merged(commands: Vec<Step>, simulations: Vec<(usize, Simulate)>) -> Vec<Step> {
    let mut all: Vec<Step> = Vec::with_capacity(commands.len() + simulations.len());
    let mut commands = commands.into_iter().peekable();
    let mut asked = false;
    for (line, simulate) in simulations {
        while let Some(step) = commands.next_if(|s| s.line < line) {
            asked |= matches!(&step.command, Command::Simulate(s) if s.kind == simulate.kind);
            all.push(step);
        }
        if !std::mem::take(&mut asked) {
            let command = Command::Simulate(simulate);
            all.push(Step {
                command,
                text: String::new(),
                line,
            });
        }
    }
    all.extend(commands);
    all
}

fn note(line: &str) -> Option<Note> {
    let line = line.trim();
    if line == "Begin Simulation" {
        return Some(Note::Begin);
    }
    if line == "End Simulation" {
        return Some(Note::End);
    }
    if let Some(what) = line.strip_prefix("****** Performing ") {
        let kinds = [
            ("Dynamic", SimulationKind::Dynamic),
            ("Kinematic", SimulationKind::Kinematic),
            ("Quasi", SimulationKind::Static),
            ("Static", SimulationKind::Static),
        ];
        return kinds
            .into_iter()
            .find(|(w, _)| what.starts_with(w))
            .map(|(_, k)| Note::Kind(k));
    }
    // time, step, evaluations, steps, order, CPU time (which may be 3:09)
    let words: Vec<&str> = line.split_whitespace().collect();
    let numbers: Option<Vec<f64>> = words.iter().take(5).map(|w| w.parse().ok()).collect();
    numbers
        .filter(|n| n.len() == 5 && words.len() == 6)
        .map(|n| Note::Time(n[0]))
}

/// The simulations a log shows: the line they begin in and what they ran.
fn simulations(notes: &[(usize, Note)]) -> Vec<(usize, Simulate)> {
    let mut all = Vec::new();
    let mut begun = None;
    let (mut kind, mut first, mut last) = (SimulationKind::Dynamic, None, None);
    for (line, note) in notes {
        match note {
            Note::Begin => {
                begun = Some(*line);
                (kind, first, last) = (SimulationKind::Dynamic, None, None);
            }
            Note::Kind(k) => kind = *k,
            Note::Time(t) => {
                first = first.or(Some(*t));
                last = Some(*t);
            }
            Note::End => {
                let moved = first.zip(last).is_some_and(|(a, b): (f64, f64)| b > a);
                if let (Some(line), true) = (begun.take(), moved) {
                    let simulate = Simulate {
                        kind,
                        end: last,
                        duration: None,
                        steps: Some(1),
                        dtout: None,
                    };
                    all.push((line, simulate));
                }
            }
        }
    }
    all
}
