//! Random datasets and command files made of bytes, by the table of statements; and the laws that every text of them keeps.

use cognate::dataset::Source;
use cognate::dataset::command::{Command, Script};
use cognate::dataset::{Reading, read_source, read_text};
use cognate::diagnostic::Severity;
use cognate::internals::dataset::row::Argument;
use cognate::internals::dataset::statement::STATEMENTS;
use cognate::internals::dataset::value::Kind;
use meaning::{difference, meaning};
use std::collections::BTreeSet;
use std::fmt::Write;

use super::meaning;

/// Bytes as choices; zeros when they are used up.
struct Choices<'a>(&'a [u8]);

impl Choices<'_> {
    fn pick(&mut self, n: usize) -> usize {
        let Some((&first, rest)) = self.0.split_first() else {
            return 0;
        };
        self.0 = rest;
        usize::from(first) % n.max(1)
    }

    fn number(&mut self) -> f64 {
        const NICE: [f64; 10] = [0.0, 1.0, -1.0, 0.5, 9806.65, 1e-3, -2.5e8, 0.1, 1e20, 3.0];
        match self.pick(14) {
            k @ 0..10 => NICE[k],
            10 | 11 => self.pick(256) as f64 / 16.0,
            _ => {
                let bits = [(); 8].map(|()| self.pick(256) as u8);
                let x = f64::from_bits(u64::from_le_bytes(bits));
                if x.is_finite() { x } else { 7.0 }
            }
        }
    }

    fn numbers(&mut self, min: usize, max: usize, angle: bool) -> String {
        let count = min.saturating_add(self.pick(4)).min(max).min(200);
        let all: Vec<String> = (0..count.max(1))
            .map(|_| {
                let suffix = if angle && self.pick(3) == 0 { "D" } else { "" };
                format!("{:E}{suffix}", self.number())
            })
            .collect();
        all.join(", ")
    }

    fn value(&mut self, kind: Kind) -> String {
        let word = |choices: &mut Self, words: &[&str]| match words.len() {
            0 => ["ALPHA", "B_2", "x"][choices.pick(3)].to_string(),
            n => words[choices.pick(n)].to_string(),
        };
        match kind {
            Kind::Flag => String::new(),
            Kind::Id => (self.pick(5) + 1).to_string(),
            Kind::Ids { min, max } => {
                let count = min.saturating_add(self.pick(3)).min(max).clamp(1, 200);
                let all: Vec<String> = (0..count).map(|_| (self.pick(9) + 1).to_string()).collect();
                all.join(", ")
            }
            Kind::Real { angle } => self.numbers(1, 1, angle),
            Kind::Reals { min, max, angle } => self.numbers(min, max, angle),
            Kind::Word(words) => word(self, words),
            Kind::Words(words) => {
                let count = 1 + self.pick(3);
                let all: Vec<String> = (0..count).map(|_| word(self, words)).collect();
                all.join(":")
            }
            Kind::Text => ["a text", "x.dat", "A-B c"][self.pick(3)].to_string(),
            Kind::Texts => ["\"one\"", "\"a!b\", \"two, three\""][self.pick(2)].to_string(),
            Kind::Formula => match self.pick(4) {
                0 => "USER(1, 2.5, -3E8)".to_string(),
                1 => format!(
                    "{:E}*TIME + STEP(TIME, 0, 0, 1, VX(21, 11))",
                    self.number().abs()
                ),
                2 => "-25*(DM(21, 11) - 10) - 2*VR(21, 11)".to_string(),
                // longer than a line
                _ => (1..20)
                    .map(|k| format!("SIN({k}*TIME)"))
                    .collect::<Vec<_>>()
                    .join(" + "),
            },
            Kind::Raw => ["raw", "12"][self.pick(2)].to_string(),
        }
    }

    /// A statement of the table with some of its arguments, most of the required ones among them.
    fn statement(&mut self, out: &mut String) {
        let row = STATEMENTS[self.pick(STATEMENTS.len())];
        let keyword = row
            .keyword()
            .split('|')
            .next()
            .unwrap_or_default()
            .to_ascii_uppercase();
        out.push_str(&keyword);
        if row.numbered() {
            let _ = write!(out, "/{}", self.pick(4) + 1);
        }
        let mut groups: Vec<&str> = Vec::new();
        for argument in row.arguments() {
            let Argument {
                name,
                kind,
                required,
                group,
                ..
            } = argument;
            let wanted = if required {
                self.pick(16) > 0
            } else {
                self.pick(3) == 0
            };
            // one of a group, mostly
            if !wanted || group.is_some_and(|g| groups.contains(&g)) && self.pick(8) > 0 {
                continue;
            }
            groups.extend(group);
            let name = name
                .split('|')
                .next()
                .unwrap_or_default()
                .to_ascii_uppercase();
            let value = self.value(kind);
            out.push_str(if self.pick(4) == 0 { ", " } else { "\n, " });
            out.push_str(&name);
            if !matches!(kind, Kind::Flag) {
                let _ = write!(out, " = {value}");
            }
            if matches!(kind, Kind::Formula) {
                out.push('\\');
            }
        }
        out.push('\n');
    }
}

/// What every random dataset begins with.
const BEGINNING: &str =
    "a title\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n";

/// The dataset that these bytes stand for: any statements, with arguments of the right kinds, good or bad.
pub fn dataset(bytes: &[u8]) -> String {
    let mut choices = Choices(bytes);
    let mut out = BEGINNING.to_string();
    while !choices.0.is_empty() && out.len() < 100_000 {
        choices.statement(&mut out);
    }
    out + "END\n"
}

/// The same with those statements only in which nothing is wrong by itself, each element once. What they refer to need not be
/// there.
pub fn sound_dataset(bytes: &[u8]) -> String {
    let mut choices = Choices(bytes);
    let mut out = BEGINNING.to_string();
    let mut heads = BTreeSet::from(["PART/1", "MARKER/1", "PART/2", "MARKER/2"].map(String::from));
    while !choices.0.is_empty() && out.len() < 100_000 {
        let mut statement = String::new();
        choices.statement(&mut statement);
        let head = statement
            .split(['\n', ','])
            .next()
            .unwrap_or_default()
            .trim()
            .to_string();
        let reading = read_text(&format!("{BEGINNING}{statement}END\n"));
        // what the model as a whole lacks is no mistake of the statement
        let of_the_model = reading.model.check();
        let wrong = reading
            .diagnostics
            .iter()
            .filter(|d| d.severity == Severity::Error)
            .any(|d| {
                !of_the_model
                    .iter()
                    .any(|m| m.code == d.code && m.message == d.message)
            });
        if !wrong && heads.insert(head) {
            out += &statement;
        }
    }
    out + "END\n"
}

/// The command file that these bytes stand for.
pub fn commands(bytes: &[u8]) -> String {
    let mut choices = Choices(bytes);
    let mut out = "a_model\nresults\n".to_string();
    while !choices.0.is_empty() && out.len() < 100_000 {
        match choices.pick(8) {
            0 => {
                let kind =
                    ["DYNAMIC", "STATICS", "KINEMATIC", "TRANSIENT", "IC", "D"][choices.pick(6)];
                let _ = writeln!(
                    out,
                    "SIMULATE/{kind}, END={}, STEPS={}",
                    choices.pick(20),
                    choices.pick(50)
                );
            }
            1 => {
                let word = ["ACTIVATE", "DEACTIVATE"][choices.pick(2)];
                let kind = ["JOINT", "MOTION", "SFORCE", "NOTHING"][choices.pick(4)];
                let _ = writeln!(out, "{word}/{kind}, ID={}", choices.pick(4));
            }
            2 => {
                let text = [
                    "LINEAR/EIGENSOL",
                    "SAVE/SYSTEM=a",
                    "RELOAD/SYSTEM=a",
                    "TIME/",
                    "SHOW/MODEL",
                    "FILE/COMMAND=b",
                ][choices.pick(6)];
                let _ = writeln!(out, "{text}");
            }
            _ => choices.statement(&mut out),
        }
    }
    out + "STOP\n"
}

/// Every place that is told lies in the text, and what is read can be written as it was read.
fn laws_of_readings(reading: &Reading, lines: usize) {
    for d in &reading.diagnostics {
        assert!(d.line <= lines + 1, "{d}");
    }
    assert_eq!(reading.dataset.to_text(), reading.dataset.source.text);
}

/// Whatever is read, written and read again is the same model; formatting changes no meaning.
pub fn laws_of_datasets(text: &str) {
    let reading = read_text(text);
    laws_of_readings(&reading, text.lines().count());
    let model = reading.model;
    let written = model.to_text();
    let again = read_text(&written).model;
    let (a, b) = (meaning(&model), meaning(&again));
    assert!(
        a == b,
        "{}\n--- read\n{text}\n--- written\n{written}",
        difference(&a, &b)
    );
    let formatted = reading.dataset.formatted();
    let (a, b) = (meaning(&model), meaning(&read_text(&formatted).model));
    assert!(
        a == b,
        "formatted: {}\n--- read\n{text}\n--- formatted\n{formatted}",
        difference(&a, &b)
    );
}

/// A command file is read or refused; what is read can be applied to a model, or refused.
pub fn laws_of_commands(text: &str) {
    let Ok(script) = Script::from_text(text) else {
        return;
    };
    let mut model = read_text(&dataset(&[])).model;
    for step in &script.steps {
        if matches!(step.command, Command::Change(_)) {
            let _ = model.apply(&step.command);
        }
    }
    let _ = read_text(&model.to_text());
}

/// A claim about any bytes.
pub type Law = fn(&[u8]);

/// What fuzzing calls, by the name of the target.
pub const TARGETS: [(&str, Law); 4] = [
    ("dataset", fuzz_dataset),
    ("command", fuzz_command),
    ("model", fuzz_model),
    ("view", fuzz_view),
];

/// Any bytes as a command file of Adams View: read without harm, every place inside the file, and
/// what has no mistake is written as a dataset that means the same.
pub fn fuzz_view(bytes: &[u8]) {
    let source = Source::from_bytes(Some("fuzz.cmd"), bytes);
    let reading = read_source(source);
    let text = &reading.dataset.source.text;
    for d in &reading.diagnostics {
        let inside = d
            .span
            .is_none_or(|s| s.start <= s.end && s.end <= text.len());
        assert!(inside, "{d}");
        assert!(!d.message.is_empty(), "a message");
    }
    let written = reading.model.to_text();
    let again = read_text(&written);
    if !reading.failed() && !again.failed() {
        assert_eq!(again.model.to_text(), written);
    }
}

/// Any bytes as a dataset: read without harm, and written as they were read.
pub fn fuzz_dataset(bytes: &[u8]) {
    let reading = read_source(Source::from_bytes(None, bytes));
    let lines = bytes.iter().filter(|&&b| b == b'\n' || b == b'\r').count() + 1;
    laws_of_readings(&reading, lines);
    let _ = read_text(&reading.model.to_text());
    let _ = read_text(&reading.dataset.formatted());
}

/// Any bytes as a command file, and as commands by the table.
pub fn fuzz_command(bytes: &[u8]) {
    if let Ok(text) = std::str::from_utf8(bytes) {
        let _ = Script::from_text(text);
        let _ = Script::from_message_log_text(text);
    }
    laws_of_commands(&commands(bytes));
}

/// Bytes as statements by the table, all of them good.
pub fn fuzz_model(bytes: &[u8]) {
    laws_of_datasets(&sound_dataset(bytes));
}
