//! The command line: one command, one verb, one file. [`obey`] is all of it: the program `cognate`
//! (`main.rs`) and the Python package call it.
//!
//! A verb collects its messages and returns its outcome; only this file knows exit codes and
//! streams. Results go to standard output, everything about them (mistakes, warnings, progress) to
//! standard error.

#![cfg_attr(
    not(any(feature = "native", feature = "routines")),
    forbid(unsafe_code)
)]

mod anatomy;
mod animate;
mod arguments;
mod assembly;
mod attended;
mod card;
mod check;
mod completions;
mod configuration;
mod convert;
mod data;
mod doubted;
mod draw;
mod elements;
mod eval;
mod example;
mod explain;
mod export;
mod fmt;
mod foreseen;
mod formula;
mod functions;
mod group;
mod grouped;
mod inputs;
#[cfg(feature = "geometry")]
mod interference;
mod interrupt;
mod limit;
mod linear;
mod loads;
mod mdi;
mod memory;
mod missing;
mod mistake;
mod modes;
mod motion;
mod moved;
mod output;
mod piped;
mod plot;
mod progress;
mod recorded;
mod render;
mod repl;
mod report;
mod response;
#[cfg(not(all(unix, feature = "routines")))]
#[path = "no_routines.rs"]
mod routines;
#[cfg(all(unix, feature = "routines"))]
mod routines;
mod run;
mod runs;
mod setup;
mod statements;
mod summary;
mod sweep;
mod table;
mod verify;
mod width;
mod writing;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use cognate::dataset::Dataset;
use cognate::diagnostic::{Cause, Diagnostic, Error, Span};
use cognate::disk;
use cognate::internals::stack;
use render::Sources;
use std::ffi::OsString;
use std::io::Write;

/// The ADAMS function language and the multibody solver that speaks it.
#[derive(Parser)]
#[command(name = "cognate", version, arg_required_else_help = true, after_help = EXIT_CODES, max_term_width = 100)]
struct Cli {
    /// Colours in help, messages and pictures: auto has them where a person reads and NO_COLOR is
    /// not set
    #[arg(
        long,
        global = true,
        value_name = "WHEN",
        value_enum,
        default_value = "auto"
    )]
    color: clap::ColorChoice,
    #[command(subcommand)]
    verb: Verb,
}

/// The arguments of a verb are described where it is asked for: those of all of them were a
/// millisecond of every run.
#[derive(Subcommand)]
#[command(defer = true)]
enum Verb {
    Animate(animate::Args),
    Check(check::Args),
    Completions(completions::Args),
    Configuration(configuration::Args),
    Convert(convert::Args),
    Draw(draw::Args),
    Elements(elements::Args),
    Eval(eval::Args),
    Explain(explain::Args),
    Export(export::Args),
    Fmt(fmt::Args),
    Functions(functions::Args),
    Group(group::Args),
    #[cfg(feature = "geometry")]
    Interference(interference::Args),
    Linear(linear::Args),
    Loads(loads::Args),
    Man(completions::ManArgs),
    Mdi(mdi::Args),
    Motion(motion::Args),
    #[command(aliases = ["graph", "chart"])]
    Plot(plot::Args),
    Repl(repl::Args),
    Report(report::Args),
    #[command(aliases = ["solve", "simulate"])]
    Run(run::Args),
    Runs(runs::Args),
    Statements(statements::Args),
    Sweep(sweep::Args),
    Verify(verify::Args),
}

const EXIT_CODES: &str = "\
Exit codes: 0 done, 1 a mistake in cognate itself, 2 usage, 3 input (syntax, names), 4 model (freedom, contradiction, inertia), \
5 no equilibrium, 6 integration stopped early, 7 limit (time, memory, steps), 8 a check failed, \
9 results could not be written, 130 interrupted.";

/// The outcome of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// everything was done
    Done,
    /// a mistake of ours
    Bug,
    /// the command was not understood
    Usage,
    /// the input has mistakes: syntax, names, files
    Input,
    /// the model cannot work: freedom, contradiction, inertia
    Model,
    /// no equilibrium was found
    NoEquilibrium,
    /// the integration stopped early
    Stopped,
    /// a limit of time, memory or steps was reached
    Limit,
    /// a check that was asked for failed
    CheckFailed,
    /// results could not be written
    Unwritable,
    /// the user interrupted it
    Interrupted,
}

impl Exit {
    /// Returns the exit of a command that a mistake ends: one in the input, in the command, or a
    /// file that cannot be written.
    pub fn of(diagnostic: &Diagnostic) -> Self {
        match diagnostic {
            d if d.is(Cause::FileUnwritable) => Exit::Unwritable,
            d if d.is_any(&[Cause::FileExists, Cause::IsInput]) => Exit::Usage,
            _ => Exit::Input,
        }
    }
    /// Returns its number.
    pub fn code(self) -> u8 {
        match self {
            Exit::Done => 0,
            Exit::Bug => 1,
            Exit::Usage => 2,
            Exit::Input => 3,
            Exit::Model => 4,
            Exit::NoEquilibrium => 5,
            Exit::Stopped => 6,
            Exit::Limit => 7,
            Exit::CheckFailed => 8,
            Exit::Unwritable => 9,
            Exit::Interrupted => 130,
        }
    }
}

/// The reason why a command could not be done: its exit code, its messages, and the texts they
/// refer to.
pub(crate) struct Failure {
    /// the exit code
    pub exit: Exit,
    /// all mistakes
    pub diagnostics: Vec<Diagnostic>,
    /// texts that the places refer to
    pub sources: Sources,
}

impl From<Diagnostic> for Failure {
    /// A mistake in the input, or a file that cannot be written.
    fn from(diagnostic: Diagnostic) -> Self {
        Self {
            exit: Exit::of(&diagnostic),
            diagnostics: vec![diagnostic],
            sources: Sources::default(),
        }
    }
}

impl From<Error> for Failure {
    /// All mistakes of a caller of the library.
    fn from(error: Error) -> Self {
        let first = Self::from(error.first().clone());
        Self {
            diagnostics: error.into_diagnostics(),
            ..first
        }
    }
}

impl Failure {
    /// Creates a failure from mistakes in files; their texts are read again, to show the places.
    pub fn in_files(exit: Exit, diagnostics: Vec<Diagnostic>) -> Self {
        let sources = Sources::of_files(&diagnostics);
        Self {
            exit,
            diagnostics,
            sources,
        }
    }
    /// Creates a failure from mistakes in a model, each at the statement of its element. Routines
    /// that nobody has are one mistake, however many ask for them.
    pub fn in_model(dataset: &Dataset, diagnostics: impl Into<Vec<Diagnostic>>) -> Self {
        let located = diagnostics.into().into_iter().map(|d| dataset.locate(d));
        let diagnostics = with_one_lack_of_routines(located.collect());
        Self::in_files(Exit::Model, diagnostics)
    }
    /// Creates a failure from a mistake in an argument of the command line, which is shown with its
    /// place.
    pub fn at_argument(argument: &str, text: &str, mistake: Diagnostic) -> Self {
        Self::at_arguments(argument, text, vec![mistake])
    }
    /// Creates a failure from mistakes in an argument of the command line.
    pub fn at_arguments(argument: &str, text: &str, mistakes: Vec<Diagnostic>) -> Self {
        let placed = |d: Diagnostic| {
            let d = match d.span {
                Some(_) => d,
                None => d.at(text, Span::new(0, text.len())),
            };
            Diagnostic {
                file: Some(argument.to_owned()),
                ..d
            }
        };
        let mut sources = Sources::default();
        sources.add(argument, text);
        Self {
            exit: Exit::Input,
            diagnostics: mistakes.into_iter().map(placed).collect(),
            sources,
        }
    }
    /// Creates a failure for a command that contradicts itself.
    pub fn usage(message: impl Into<String>) -> Self {
        Self {
            exit: Exit::Usage,
            ..Self::from(Diagnostic::error("usage", message))
        }
    }
}

/// Returns mistakes with those in one that differ in nothing but who asks for a routine.
fn with_one_lack_of_routines(diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let what = |d: &Diagnostic| (d.message.clone(), d.severity);
    let is_lack = |d: &Diagnostic| d.is(Cause::UserRoutine) && d.element.is_some();
    let mut all: Vec<Diagnostic> = Vec::with_capacity(diagnostics.len());
    let mut others: Vec<(usize, Vec<String>)> = Vec::new();
    for d in diagnostics {
        let before = match is_lack(&d) {
            true => (all.iter()).position(|e| is_lack(e) && what(e) == what(&d)),
            false => None,
        };
        let Some(k) = before else {
            all.push(d);
            continue;
        };
        let name = d.subject().unwrap_or_default().to_string();
        let name = match d.line {
            0 => name,
            line => format!("{name} (line {line})"),
        };
        match others.iter_mut().find(|(first, _)| *first == k) {
            Some((_, names)) => names.push(name),
            None => others.push((k, vec![name])),
        }
    }
    for (k, names) in others {
        all[k].message = format!("{}; likewise {}", all[k].message, names.join(", "));
    }
    all
}

/// The result of a verb.
pub(crate) type Outcome = Result<Exit, Failure>;

/// Runs the command that the arguments name, the name of the program not among them.
///
/// `program` are the words by which a shell calls this program, for scripts that do. The process is
/// the command's own: it hears its signals, and a limit, a second Ctrl-C or a closed pipe end it.
pub fn obey(program: &[OsString], arguments: Vec<OsString>) -> Exit {
    let cli = match parsed(arguments) {
        Ok(cli) => cli,
        Err(exit) => return exit,
    };
    render::choose_colours(cli.color);
    disk::remember_inputs();
    if !matches!(cli.verb, Verb::Sweep(_)) {
        memory::serve_one_thread();
    }
    let work = || perform(&cli, program);
    let exit = std::thread::scope(|scope| {
        let worker = std::thread::Builder::new().stack_size(stack::bytes(1));
        match worker.spawn_scoped(scope, work) {
            Ok(worker) => worker.join().unwrap_or(Exit::Bug),
            // a system that has no room for the stack has room for most models
            Err(_) => work(),
        }
    });
    // a caller that is no program of Rust does not; a closed stream is no mistake
    let _ = std::io::stdout().flush();
    exit
}

/// Returns all commands and options.
fn command() -> clap::Command {
    Cli::command()
}

/// Returns the choice of colours among arguments: help and mistakes in them have it, too.
fn colours<'a>(arguments: impl Iterator<Item = &'a OsString>) -> clap::ColorChoice {
    let mut words = arguments.map(|word| word.to_string_lossy().into_owned());
    let mut chosen = None;
    while let Some(word) = words.next().filter(|word| word != "--") {
        chosen = match word.strip_prefix("--color") {
            Some("") => words.next(),
            Some(rest) => rest.strip_prefix('=').map(str::to_owned).or(chosen),
            None => chosen,
        };
    }
    let choice = chosen.and_then(|word| clap::ValueEnum::from_str(&word, false).ok());
    choice.unwrap_or_default()
}

/// Returns the arguments in their places.
///
/// # Errors
/// The exit of what was printed instead: help that they ask for, or what is not understood.
fn parsed(arguments: Vec<OsString>) -> Result<Cli, Exit> {
    let mut command = command().color(colours(arguments.iter()));
    let is_first = |verb: &clap::Command| {
        arguments
            .first()
            .is_some_and(|word| *word == *verb.get_name())
    };
    if !command.get_subcommands().any(is_first) {
        // the list of verbs says what each is for
        command.build();
    }
    let words = std::iter::once("cognate".into()).chain(arguments);
    let found = command.try_get_matches_from_mut(words);
    found
        .and_then(|found| Cli::from_arg_matches(&found))
        .map_err(|e| {
            let e = e.format(&mut command);
            // a closed stream is no mistake
            let _ = e.print();
            match e.use_stderr() {
                true => Exit::Usage,
                false => Exit::Done,
            }
        })
}

/// Runs a command.
fn perform(cli: &Cli, program: &[OsString]) -> Exit {
    let verb = std::panic::AssertUnwindSafe(|| match &cli.verb {
        Verb::Animate(args) => animate::run(args),
        Verb::Check(args) => check::run(args),
        Verb::Completions(args) => completions::run(args),
        Verb::Configuration(args) => configuration::run(args),
        Verb::Convert(args) => convert::run(args),
        Verb::Draw(args) => draw::run(args),
        Verb::Elements(args) => elements::run(args),
        Verb::Eval(args) => eval::run(args),
        Verb::Explain(args) => explain::run(args),
        Verb::Export(args) => export::run(args),
        Verb::Fmt(args) => fmt::run(args),
        Verb::Functions(args) => functions::run(args),
        Verb::Group(args) => group::run(args),
        #[cfg(feature = "geometry")]
        Verb::Interference(args) => interference::run(args),
        Verb::Linear(args) => linear::run(args),
        Verb::Loads(args) => loads::run(args),
        Verb::Man(args) => completions::man(args),
        Verb::Mdi(args) => mdi::run(args, program),
        Verb::Motion(args) => motion::run(args),
        Verb::Plot(args) => plot::run(args),
        Verb::Repl(args) => repl::run(args),
        Verb::Report(args) => report::run(args),
        Verb::Run(args) => run::run_last(args),
        Verb::Runs(args) => runs::run(args),
        Verb::Statements(args) => statements::run(args),
        Verb::Sweep(args) => sweep::run(args),
        Verb::Verify(args) => verify::run(args),
    });
    let verb = || piped::begin().and_then(|()| verb());
    let exit = match std::panic::catch_unwind(std::panic::AssertUnwindSafe(verb)) {
        Ok(Ok(exit)) => exit,
        Ok(Err(failure)) => {
            complain(&failure.diagnostics, &failure.sources);
            failure.exit
        }
        Err(_) => {
            complain(
                &[Diagnostic::error("bug", "this is a mistake in cognate")
                    .help("please report what you ran and what stands above")],
                &Sources::default(),
            );
            Exit::Bug
        }
    };
    piped::end();
    exit
}

/// Prints diagnostics on standard error.
pub(crate) fn complain(diagnostics: &[Diagnostic], sources: &Sources) {
    let text = render::render(diagnostics, sources, render::colour_on_stderr());
    let text = piped::named(text);
    // a closed stream is no mistake
    let _ = std::io::stderr().write_all(&disk::bytes(&text));
}

/// Prints diagnostics about files on standard error, with their places.
pub(crate) fn complain_in_files(diagnostics: &[Diagnostic]) {
    complain(diagnostics, &Sources::of_files(diagnostics));
}

/// Prints on standard error a remark about what was done.
pub(crate) fn remark(message: impl std::fmt::Display) {
    let line = format!("{}\n", piped::named(message.to_string()));
    // a closed stream is no mistake
    let _ = std::io::stderr().write_all(&disk::bytes(&line));
}

/// Prints results on standard output. When the reader is gone (`| head`), the program ends quietly;
/// when they cannot be written otherwise (a full disk), it says so and ends with
/// [`Exit::Unwritable`].
pub(crate) fn say(text: &str) {
    say_bytes(&disk::bytes(text));
}

/// Prints results that need not be text, as [`say`] does.
pub(crate) fn say_bytes(bytes: &[u8]) {
    let mut out = std::io::stdout().lock();
    let Err(e) = out.write_all(bytes).and_then(|()| out.flush()) else {
        return;
    };
    if e.kind() == std::io::ErrorKind::BrokenPipe {
        std::process::exit(Exit::Done.code().into());
    }
    let what = format!("results cannot be written to standard output: {e}");
    complain(
        &[Diagnostic::error(Cause::FileUnwritable, what)],
        &Sources::default(),
    );
    std::process::exit(Exit::Unwritable.code().into());
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a command and those below it, with their names.
    fn all(command: &clap::Command, found: &mut Vec<(String, clap::Command)>) {
        let name = command.get_display_name().unwrap_or("cognate").to_owned();
        found.push((name, command.clone()));
        (command.get_subcommands()).for_each(|below| all(below, found));
    }

    #[test]
    fn every_option_says_its_default_and_lists_its_choices() {
        let mut whole = command();
        whole.build();
        let (mut commands, mut closed) = (Vec::new(), Vec::new());
        all(&whole, &mut commands);
        assert!(commands.len() > 30);
        for (name, command) in commands {
            let shown = command.clone().render_long_help().to_string();
            // a choice of two words may be wrapped
            let shown = shown.split_whitespace().collect::<Vec<_>>().join(" ");
            for option in command.get_arguments() {
                let takes = option.get_num_args().is_some_and(|n| n.takes_values());
                if option.is_positional() || option.is_hide_set() || !takes {
                    continue;
                }
                let help = option.get_help().map(ToString::to_string);
                let says = help.is_some_and(|help| help.contains("[default: "));
                let is_said = says || !option.get_default_values().is_empty();
                let long = option.get_long().unwrap_or_default();
                assert!(is_said || option.is_required_set(), "{name} --{long}");
                let choices = option.get_possible_values();
                for choice in choices.iter().filter(|c| !c.is_hide_set()) {
                    let choice = choice.get_name();
                    assert!(shown.contains(choice), "{name} --{long}: {choice}");
                }
                if !choices.is_empty() {
                    closed.push(format!("{name} --{long}"));
                }
            }
        }
        for option in [
            "cognate-run --method",
            "cognate-run --format",
            "cognate-run --type",
            "cognate-run --color",
            "cognate-report --method",
            "cognate-loads-setup --format",
            "cognate-group-function --ends",
            "cognate-group-function --ordinate",
            "cognate-motion --as",
        ] {
            assert!(closed.contains(&option.to_owned()), "{option}: {closed:?}");
        }
    }

    #[test]
    fn the_last_choice_of_colours_before_the_end_of_options_counts() {
        let chosen = |words: &[&str]| {
            let words: Vec<OsString> = words.iter().map(Into::into).collect();
            colours(words.iter())
        };
        assert_eq!(chosen(&["run", "x.adm"]), clap::ColorChoice::Auto);
        let both = ["--color=always", "run", "--color", "never"];
        assert_eq!(chosen(&both), clap::ColorChoice::Never);
        let behind = ["eval", "--color=never", "--", "--color=always"];
        assert_eq!(chosen(&behind), clap::ColorChoice::Never);
        assert_eq!(chosen(&["--color", "blue"]), clap::ColorChoice::Auto);
    }
}
