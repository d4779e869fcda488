//! `cognate runs`: the runs that a folder keeps. Lists, renames, deletes and compares them.

mod compare;

use super::table::Table;
use super::{Exit, Failure, Outcome, remark, say, width};
use cognate::diagnostic::Diagnostic;
use cognate::disk;
use cognate::internals::results::kept::{self, KeptRun, State};
use cognate::results::{digits_of_six, json};
use serde_json::{Value, json};
use std::path::PathBuf;

/// List the runs of a folder, rename and delete them, compare two
///
/// A run is named as its files are: results/crank stands for all files that the record
/// results/crank.json claims. `cognate run --name` names it. A file that somebody else has made or
/// changed is never touched.
#[derive(clap::Args)]
#[command(
    args_conflicts_with_subcommands = true,
    after_help = "\
Examples:
  cognate runs                                 those here and in the folders here
  cognate runs results --json
  cognate runs rename results/crank stiff
  cognate runs delete results/stiff --yes
  cognate runs compare results/crank results/stiff
  cognate runs compare old.csv new.res --tolerance 1e-6   ends with 8 where a channel differs by more"
)]
pub struct Args {
    #[command(subcommand)]
    verb: Option<Verb>,
    /// Folder whose runs are listed, and those of the folders in it
    #[arg(default_value = ".")]
    folder: PathBuf,
    /// Print the list as JSON
    #[arg(long)]
    json: bool,
}

#[derive(clap::Subcommand)]
enum Verb {
    /// Give a run another name, in its folder
    Rename {
        /// Name of the run with its folder, or one of its files
        run: PathBuf,
        /// New name, without a folder
        name: String,
    },
    /// Delete runs: the files that they wrote and that nobody has changed since
    Delete {
        /// Names of runs with their folders, or one file of each
        #[arg(required = true)]
        runs: Vec<PathBuf>,
        /// Do not ask
        #[arg(long)]
        yes: bool,
    },
    Compare(compare::Args),
}

/// Lists, renames, deletes or compares runs.
///
/// # Errors
/// When there is no such run, or its files cannot be read, renamed or removed.
pub fn run(args: &Args) -> Outcome {
    match &args.verb {
        None => list(args),
        Some(Verb::Rename { run, name }) => {
            let run = kept::find(run)?;
            told_apart(&run.rename(name)?);
            let now = run.record_file().with_file_name(name);
            let now = disk::text(now.strip_prefix(".").unwrap_or(&now));
            remark(format!("{} is now {now}", run.place()));
            Ok(Exit::Done)
        }
        Some(Verb::Delete { runs, yes }) => delete(runs, *yes),
        Some(Verb::Compare(args)) => compare::run(args),
    }
}

/// Prints the runs of a folder.
fn list(args: &Args) -> Outcome {
    let runs = kept::runs_in(&args.folder)?;
    match (args.json, runs.is_empty()) {
        (true, _) => {
            let all: Vec<Value> = runs.iter().map(as_json).collect();
            say(&json::text(&json!({ "runs": all })));
        }
        (false, true) => remark(format!("no runs in {}", disk::text(&args.folder))),
        (false, false) => say(&table(&runs)),
    }
    Ok(Exit::Done)
}

/// Returns first and last time of all simulations of a run.
fn span(run: &KeptRun) -> Option<[f64; 2]> {
    let simulations = run.record["simulations"].as_array()?;
    let times = |key: &str| -> Vec<f64> {
        let all = simulations.iter().filter_map(|s| s[key].as_f64());
        all.collect()
    };
    let start = times("start").into_iter().reduce(f64::min)?;
    Some([start, times("end").into_iter().reduce(f64::max)?])
}

/// Prints a size in bytes, in the unit that leaves three digits at most before the point.
fn size(bytes: u64) -> String {
    const UNITS: [&str; 4] = ["kB", "MB", "GB", "TB"];
    let mut size = bytes as f64 / 1e3;
    let mut unit = 0;
    while size >= 999.95 && unit + 1 < UNITS.len() {
        (size, unit) = (size / 1e3, unit + 1);
    }
    format!("{size:.1} {}", UNITS[unit])
}

/// Returns the status of a run in words.
fn status(run: &KeptRun) -> String {
    match run.state() {
        State::CutOff => "cut off".into(),
        State::BeingWritten | State::Complete => {
            let status = run.record["status"].as_str().unwrap_or_default();
            status.replace('_', " ")
        }
    }
}

/// Prints the runs, one a row.
fn table(runs: &[KeptRun]) -> String {
    let heads = [
        "run", "status", "model", "span", "rows", "method", "error", "files", "size",
    ];
    let mut table = Table::new(heads);
    for run in runs {
        let text = |key: &str| run.record[key].as_str().unwrap_or_default().to_owned();
        let number = |key: &str| run.record[key].as_f64();
        let files = run.files();
        let own = files.iter().filter(|f| f.is_own);
        let endings = own.clone().map(|f| {
            let rest = disk::text(f.path.file_name().unwrap_or_default());
            let rest = rest.strip_prefix(&run.name).map(str::to_owned);
            rest.unwrap_or_else(|| f.name.clone())
        });
        let others = files.iter().filter(|f| !f.is_own).count();
        let parts = run.parts();
        let endings = endings.chain(parts.iter().filter_map(|(path, _)| {
            let name = disk::text(path.file_name()?);
            name.strip_prefix(&run.name).map(str::to_owned)
        }));
        let others = match others {
            0 => String::new(),
            n => format!(" ({n} gone or changed)"),
        };
        table.push([
            run.place(),
            status(run),
            text("model"),
            span(run).map_or(String::new(), |[start, end]| {
                format!("{} to {}", digits_of_six(start), digits_of_six(end))
            }),
            number("outputs").map_or(String::new(), |n| format!("{n}")),
            text("method"),
            number("error").map_or(String::new(), digits_of_six),
            endings.collect::<Vec<_>>().join(" ") + &others,
            size(
                own.filter_map(|f| f.bytes)
                    .chain(parts.iter().map(|p| p.1))
                    .sum(),
            ),
        ]);
    }
    table.text(width::columns())
}

fn as_json(run: &KeptRun) -> Value {
    let file = |f: &kept::ClaimedFile| {
        let state = match (f.is_own, f.bytes) {
            (true, _) => "kept",
            (false, Some(_)) => "changed",
            (false, None) => "missing",
        };
        json!({ "name": f.name, "path": disk::text(&f.path), "bytes": f.bytes, "state": state })
    };
    let fact = |key: &str| run.record[key].clone();
    json!({
        "run": run.place(),
        "name": run.name,
        "folder": disk::text(&run.folder),
        "model": fact("model"),
        "status": match run.state() {
            State::CutOff => json!("cut_off"),
            State::BeingWritten | State::Complete => fact("status"),
        },
        "stop_reason": fact("stop_reason"),
        "span": span(run),
        "outputs": fact("outputs"),
        "method": fact("method"),
        "error": fact("error"),
        "files": run.files().iter().map(file).collect::<Vec<_>>(),
        "parts": run.parts().iter().map(|(path, bytes)| json!({ "path": disk::text(&path), "bytes": bytes })).collect::<Vec<_>>(),
    })
}

/// Deletes runs, after a question.
fn delete(names: &[PathBuf], yes: bool) -> Outcome {
    let runs = names.iter().map(|n| kept::find(n));
    let runs = runs.collect::<Result<Vec<_>, Diagnostic>>()?;
    if !yes {
        for run in &runs {
            remark(format!("{}:", disk::text(&run.record_file())));
            for file in run.files().iter().filter(|f| f.is_own) {
                remark(format!("  {}", disk::text(&file.path)));
            }
            for (part, _) in run.parts() {
                remark(format!("  {}", disk::text(&part)));
            }
        }
        remark("delete these files? [y/N]");
        let mut answer = String::new();
        // no answer is a no
        let _ = std::io::stdin().read_line(&mut answer);
        if !["y", "yes"].contains(&answer.trim().to_lowercase().as_str()) {
            let what = "nothing was deleted; --yes does not ask";
            return Err(Failure::usage(what));
        }
    }
    for run in &runs {
        told_apart(&run.delete()?);
        remark(format!("{} is deleted", run.place()));
    }
    Ok(Exit::Done)
}

/// Remarks on files that are no longer as a run has written them.
fn told_apart(files: &[PathBuf]) {
    for file in files {
        let file = disk::text(&file);
        remark(format!(
            "{file} is not as the run wrote it: it stays as it is"
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_a_unit_that_fits() {
        let all = [0, 1234, 999_949, 999_950, 2_500_000_000].map(size);
        assert_eq!(all, ["0.0 kB", "1.2 kB", "999.9 kB", "1.0 MB", "2.5 GB"]);
    }
}
