//! `cognate mdi`: this program in the place of an external solver.
//!
//! Card: a program that writes a dataset and a command file and wants them solved by an
//! installation of Adams starts the script `mdi` of a folder that an environment variable names
//! (`SDRC_ADAMS_SOLVER` in I-DEAS), with words such as `-c ru-standard i run.acf exit`, and then
//! reads the file of results. `--install FOLDER` makes such a folder. The words that matter are
//! `ru-standard` (or its beginning, `ru-st`) and the command file after `i` (interactive) or `b`
//! (batch); without a file the commands come from standard input.

use super::run::has_commands;
use super::writing::WritingArgs;
use super::{Cli, Exit, Failure, Outcome, Verb, remark};
use clap::Parser;
use cognate::diagnostic::{Cause, Diagnostic};
use cognate::disk;
use cognate::results::Writing;
use std::ffi::OsString;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Solve as the external solver of another program: mdi -c ru-standard i run.acf exit
///
/// A program that calls an installation of Adams by its script `mdi` gets this program instead: the
/// command file is obeyed, and .res, .req, .gra and .msg are written to the current folder.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate mdi --install /usr/local/cognate         writes the scripts mdi and common/mdi.bat
  export SDRC_ADAMS_SOLVER=/usr/local/cognate      and the other program starts this one
  cognate mdi -c ru-standard i run.acf exit        what it calls")]
pub struct Args {
    /// Write the script `mdi` (and `common/mdi.bat`) that calls this program to a folder [default:
    /// none, the words are obeyed]
    #[arg(long, value_name = "FOLDER", conflicts_with = "words")]
    install: Option<PathBuf>,
    /// The words of the other program: -c ru-standard i FILE.acf exit
    #[arg(
        trailing_var_arg = true,
        allow_hyphen_values = true,
        value_name = "WORDS"
    )]
    words: Vec<String>,
}

/// Formats that the other program may read back.
const FORMATS: &str = "res,req,gra";
/// Line by which a script of ours is known.
const MARK: &str = "cognate mdi";

/// Runs a command file as a solver would, or writes the scripts.
///
/// # Errors
/// When the words name no solver and no file, or as `cognate run`.
pub fn run(args: &Args, program: &[OsString]) -> Outcome {
    if let Some(folder) = &args.install {
        return install(folder, program);
    }
    let commands = match called(&args.words).map_err(Failure::usage)? {
        Some(file) => file,
        None => from_input()?,
    };
    // names lead where the other program wants them, and its files are its own to replace
    let words = [
        "cognate",
        "run",
        "--format",
        FORMATS,
        "--trust-paths",
        "--overwrite",
    ];
    let file = commands.as_os_str();
    let words = words.map(std::ffi::OsStr::new).into_iter().chain([file]);
    match Cli::try_parse_from(words).map(|cli| cli.verb) {
        Ok(Verb::Run(args)) => super::run::run(&args),
        Ok(_) | Err(_) => Err(Failure::usage("the file of commands cannot be run")),
    }
}

/// Returns the command file that words name; `None`: commands come from standard input.
///
/// # Errors
/// When the words ask for something else than the standard solver.
fn called(words: &[String]) -> Result<Option<PathBuf>, String> {
    let usage = "the words are -c ru-standard i FILE.acf exit";
    let mut words = words
        .iter()
        .map(String::as_str)
        .filter(|w| !w.starts_with('-'));
    let solver = words.next().unwrap_or_default().to_lowercase();
    if solver.starts_with("ru-u") {
        return Err(format!(
            "{solver} runs a solver with routines of yours, which this one has not"
        ));
    }
    if !(solver.len() >= 4 && "ru-standard".starts_with(&solver)) {
        return Err(format!("`{solver}` is no solver of this program: {usage}"));
    }
    // how it is run says nothing here: the commands end by themselves
    let is_mode =
        |w: &&str| ["i", "b", "n", "y", "exit", "quit"].contains(&w.to_lowercase().as_str());
    let mut files = words.filter(|w| !is_mode(w));
    let Some(name) = files.next() else {
        return Ok(None);
    };
    let named = PathBuf::from(name);
    let whole = match has_commands(&named) {
        true => named,
        false => PathBuf::from(format!("{name}.acf")),
    };
    match (whole.is_file(), files.next()) {
        (false, _) => Err(format!(
            "there is no command file {}: {usage}",
            disk::text(&whole)
        )),
        (true, Some(more)) => Err(format!("`{more}` is not understood: {usage}")),
        (true, None) => Ok(Some(whole)),
    }
}

/// Writes the commands of standard input to a file beside the results.
fn from_input() -> Result<PathBuf, Failure> {
    let mut text = String::new();
    let read = std::io::stdin().read_to_string(&mut text);
    if read.is_err() || text.trim().is_empty() {
        let what = "there are no commands: name a command file, or give them on standard input";
        return Err(Failure::usage(what));
    }
    let file = PathBuf::from("mdi_input.acf");
    if std::fs::read_to_string(&file).ok().as_ref() != Some(&text) {
        WritingArgs::default().text(&file, &text)?;
    }
    Ok(file)
}

/// Writes the scripts that other programs call; they call this program by these words.
fn install(folder: &Path, program: &[OsString]) -> Outcome {
    let program: Vec<String> = program.iter().map(disk::text).collect();
    let scripts = [
        (folder.join("mdi"), shell(&program)),
        (folder.join("common").join("mdi.bat"), batch(&program)),
    ];
    for (file, _) in &scripts {
        let is_ours = |text: String| text.contains(MARK);
        if file.exists() && !std::fs::read_to_string(file).is_ok_and(is_ours) {
            let what = format!("{} is there already, and not ours", disk::text(&file));
            return Err(Failure::usage(what));
        }
    }
    for (file, text) in &scripts {
        let parent = file.parent().unwrap_or(folder);
        std::fs::create_dir_all(parent).map_err(|e| unwritable(parent, &e))?;
        Writing::new(true).bytes(file, &disk::bytes(text))?;
        make_executable(file).map_err(|e| unwritable(file, &e))?;
    }
    remark(format!(
        "{}: export SDRC_ADAMS_SOLVER={}",
        disk::text(&scripts[0].0),
        disk::text(&folder)
    ));
    Ok(Exit::Done)
}

fn unwritable(file: &Path, e: &std::io::Error) -> Diagnostic {
    let what = format!("{}: {e}", disk::text(&file));
    Diagnostic::error(Cause::FileUnwritable, what)
}

/// Lets everybody run a script, where the system asks for that.
fn make_executable(file: &Path) -> std::io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        std::fs::set_permissions(file, std::fs::Permissions::from_mode(0o755))?;
    }
    #[cfg(not(unix))]
    let _ = file;
    Ok(())
}

/// Returns the text of `mdi`, which hands all words on to the program.
fn shell(program: &[String]) -> String {
    let quoted = |word: &String| format!("'{}'", word.replace('\'', r"'\''"));
    let program: Vec<String> = program.iter().map(quoted).collect();
    let program = program.join(" ");
    format!("#!/bin/sh\n# {MARK}: made by `cognate mdi --install`\nexec {program} mdi \"$@\"\n")
}

/// Returns the text of `mdi.bat`, which hands all words on and ends with the code of the program.
fn batch(program: &[String]) -> String {
    // within quotes a batch file still replaces what stands between two percent signs
    let quoted = |word: &String| format!("\"{}\"", word.replace('%', "%%"));
    let program: Vec<String> = program.iter().map(quoted).collect();
    let program = program.join(" ");
    format!("@rem {MARK}: made by `cognate mdi --install`\r\n@{program} mdi %*\r\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(words: &str) -> String {
        let words: Vec<String> = words.split_whitespace().map(str::to_owned).collect();
        match called(&words) {
            Ok(file) => format!("{file:?}"),
            Err(why) => why,
        }
    }

    #[test]
    fn words_name_the_standard_solver_and_a_command_file() {
        assert_eq!(said("-c ru-standard i"), "None");
        assert_eq!(said("ru-st b exit"), "None");
        assert!(said("-c ru-standard i no_such_file exit").contains("no_such_file.acf"));
        assert!(said("-c ru-user i lib.so x.acf").contains("routines"));
        assert!(said("aview").contains("no solver") && said("").contains("no solver"));
    }

    #[test]
    fn a_batch_file_quotes_the_program_and_hands_all_words_on() {
        let text = batch(&[r"C:\Program Files (x86)\100% ours\cognate.exe".into()]);
        let lines: Vec<&str> = text.split("\r\n").collect();
        assert!(lines[0].starts_with("@rem ") && lines[0].contains(MARK));
        let call = r#"@"C:\Program Files (x86)\100%% ours\cognate.exe" mdi %*"#;
        assert_eq!(lines[1..], [call, ""]);
    }

    #[test]
    fn a_script_calls_the_program_by_all_its_words() {
        let words = ["/it's/python", "-m", "pycognate"].map(str::to_owned);
        let text = shell(&words);
        let call = r#"exec '/it'\''s/python' '-m' 'pycognate' mdi "$@""#;
        assert_eq!(text.lines().nth(2), Some(call));
        assert!(batch(&words).ends_with("@\"/it's/python\" \"-m\" \"pycognate\" mdi %*\r\n"));
    }
}
