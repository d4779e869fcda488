//! `cognate repl`: expressions and their values, one after another.
//!
//! `session.rs` executes a line, whatever its origin; `commands.rs` is the TABLE of commands;
//! `names.rs` holds the names that a session defines, `model.rs` its model; `editor.rs` helps while
//! typing. At a terminal lines come from the editor; piped in, they are read as they are, only
//! results are printed, and the exit code tells whether all went well.

mod commands;
mod editor;
mod model;
mod names;
mod session;

use super::render::{self, Sources};
use super::{Exit, Outcome, complain, interrupt, say};
use editor::Helper;
use rustyline::error::ReadlineError;
use rustyline::history::DefaultHistory;
use rustyline::{CompletionType, Config, Editor};
use session::{Reply, Session};
use std::io::{BufRead, IsTerminal};
use std::path::PathBuf;

/// Evaluate expressions at a prompt
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate repl
  echo 'STEP(0.5,0,0,1,2)' | cognate repl
  cognate repl < session.txt")]
pub struct Args {
    /// The language: direct-entry functions, or expression functions of t in degrees
    #[arg(long, value_enum, default_value = "function")]
    dialect: super::eval::DialectName,
}

/// Evaluates expressions at a prompt, or from standard input.
///
/// # Errors
/// When the terminal fails.
pub fn run(args: &Args) -> Outcome {
    let mut session = Session::new(args.dialect.into());
    if std::io::stdin().is_terminal() {
        at_terminal(&mut session)
    } else {
        Ok(from_pipe(&mut session, std::io::stdin().lock()))
    }
}

/// Executes statements until the end; returns the exit code.
fn from_pipe(session: &mut Session, input: impl BufRead) -> Exit {
    let mut exit = Exit::Done;
    let mut statement = String::new();
    for line in input.split(b'\n') {
        let Ok(line) = line else { return Exit::Input };
        let line = String::from_utf8_lossy(&line);
        let line = line.trim_end_matches('\r');
        statement = if statement.is_empty() {
            line.to_owned()
        } else {
            statement + "\n" + line
        };
        if session.is_incomplete(&statement) {
            continue;
        }
        let reply = session.execute(&std::mem::take(&mut statement));
        if answer(reply, &mut exit) {
            return exit;
        }
    }
    if !statement.trim().is_empty() {
        answer(session.execute(&statement), &mut exit);
    }
    exit
}

/// Prints a reply; returns whether the session ends.
fn answer(reply: Reply, exit: &mut Exit) -> bool {
    match reply {
        Reply::Text(text) => say(&text),
        Reply::Doubtful(doubts, expression, text) => {
            complain(&doubts, &Sources::of(expression));
            say(&text);
        }
        Reply::Mistake(diagnostic, text) => {
            complain(&[*diagnostic], &Sources::of(text));
            *exit = Exit::Input;
        }
        Reply::Failed(failure) => {
            complain(&failure.diagnostics, &failure.sources);
            *exit = failure.exit;
        }
        Reply::Quit => return true,
    }
    false
}

/// Reads lines from the editor of a terminal until the end.
fn at_terminal(session: &mut Session) -> Outcome {
    let trouble = |e: ReadlineError| {
        cognate::diagnostic::Diagnostic::error(
            "terminal",
            format!("the terminal cannot be used: {e}"),
        )
    };
    // Ctrl-C ends what is being solved, not the session
    interrupt::install();
    let config = Config::builder()
        .completion_type(CompletionType::List)
        .build();
    let mut editor: Editor<Helper, DefaultHistory> =
        Editor::with_config(config).map_err(trouble)?;
    let history = history_file();
    if let Some(file) = &history {
        // the first session has no history
        let _ = editor.load_history(file);
    }
    say(&format!(
        "cognate {}: type an expression, or :help; :quit ends.\n",
        env!("CARGO_PKG_VERSION")
    ));
    loop {
        editor.set_helper(Some(Helper::new(session, render::colour_on_stdout())));
        match editor.readline("> ") {
            Ok(line) => {
                // a history that cannot grow is no reason to stop
                let _ = editor.add_history_entry(line.as_str());
                interrupt::forget();
                if answer(session.execute(&line), &mut Exit::Done) {
                    break;
                }
            }
            Err(ReadlineError::Interrupted) => {}
            Err(ReadlineError::Eof) => break,
            Err(e) => return Err(trouble(e).into()),
        }
    }
    if let Some(file) = &history {
        let _ = editor.save_history(file);
    }
    Ok(Exit::Done)
}

/// Returns the file of the lines typed so far: COGNATE_HISTORY, or a file in the home folder.
fn history_file() -> Option<PathBuf> {
    let named = std::env::var_os("COGNATE_HISTORY").map(PathBuf::from);
    let home = || std::env::var_os("HOME").or_else(|| std::env::var_os("USERPROFILE"));
    named.or_else(|| Some(PathBuf::from(home()?).join(".cognate_history")))
}
