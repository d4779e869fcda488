//! Whole processes of ours that obey the logs of other people's Adams runs, beside the processor time that those logs tell.
//!
//! `COGNATE_CORPUS=folder cargo bench --bench logs`; without the folder nothing is run. Adams ran on other machines: read the ratio as an order of
//! magnitude. A log is obeyed with the dataset beside it; what Adams knows and we do not (USER routines, elements that are not solved) is left out
//! and counted as such.

use installed::Installed;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[path = "../tests/common/installed.rs"]
mod installed;

/// Runs of each log, of which the fastest counts.
const ROUNDS: usize = 3;
/// Processor time that one of them may take.
const LIMIT: &str = "120s";

/// All files with an ending below a folder.
fn below(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    let Ok(files) = std::fs::read_dir(folder) else {
        return;
    };
    for path in files.filter_map(|f| Some(f.ok()?.path())) {
        if path.is_dir() {
            below(&path, ending, found);
        } else if path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case(ending))
        {
            found.push(path);
        }
    }
}

/// The processor time of the last run that a log tells of, in s.
fn adams_seconds(log: &Path) -> Option<f64> {
    let bytes = std::fs::read(log).ok()?;
    let text = String::from_utf8_lossy(&bytes);
    let line = text.lines().rev().find(|l| l.contains("CPU time"))?;
    let (_, after) = line.split_once("CPU time =")?;
    after.trim().split('s').next()?.trim().parse().ok()
}

/// Processor time of all processes that this one has waited for, in s, where the system tells it (in hundredths).
fn children_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    // after the name, which may have any characters
    let (_, fields) = text.rsplit_once(')')?;
    let ticks = fields.split_whitespace().skip(13).take(2);
    let ticks: f64 = ticks.map(|t| t.parse::<f64>().unwrap_or(0.0)).sum();
    Some(ticks / 100.0)
}

fn main() {
    let Some(corpus) = std::env::var_os("COGNATE_CORPUS") else {
        println!("skipped: COGNATE_CORPUS names no folder of Adams files");
        return;
    };
    let mut logs = Vec::new();
    below(Path::new(&corpus), "msg", &mut logs);
    logs.sort();
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("logs");
    let program = Installed::new("logs-program");
    println!(
        "{:<52} {:>9} {:>9} {:>7}  how it ended",
        "log", "Adams, s", "ours, s", "ratio"
    );
    for log in logs {
        let Some(adams) = adams_seconds(&log) else {
            continue;
        };
        let name = log
            .strip_prefix(&corpus)
            .unwrap_or(&log)
            .display()
            .to_string();
        let name: String = name
            .chars()
            .rev()
            .take(50)
            .collect::<Vec<_>>()
            .into_iter()
            .rev()
            .collect();
        let (mut least, mut ended) = (f64::INFINITY, String::new());
        for _ in 0..ROUNDS {
            let (clock, before) = (Instant::now(), children_seconds());
            let run = program
                .command()
                .args([
                    "run",
                    "--quiet",
                    "--piecewise",
                    "--zero-user",
                    "--limit",
                    LIMIT,
                    "--out",
                ])
                .arg(&out)
                .arg(&log)
                .output()
                .expect("the binary runs");
            let used = children_seconds()
                .zip(before)
                .map(|(now, before)| now - before);
            least = least.min(used.unwrap_or(clock.elapsed().as_secs_f64()));
            let said = String::from_utf8_lossy(&run.stderr);
            let first = said.lines().find(|l| !l.trim().is_empty()).unwrap_or("");
            ended = match run.status.code() {
                Some(0) => "done".into(),
                Some(code) => format!("exit {code}: {first}"),
                None => "ended by a signal".into(),
            };
            // what fails or takes long once does so again
            if ended != "done" || least > 10.0 {
                break;
            }
        }
        println!(
            "{name:<52} {adams:>9.2} {least:>9.3} {:>7.2}  {ended}",
            least / adams.max(1e-2)
        );
    }
}
