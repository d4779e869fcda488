//! `cognate completions` and `cognate man`: the commands and their options, as shells complete them
//! and as pages of the manual of the system.

use super::{Exit, Failure, Outcome, piped, remark, say, say_bytes};
use clap_complete::Shell;
use clap_mangen::Man;
use cognate::diagnostic::{Cause, Diagnostic};
use cognate::results;
use std::path::{Path, PathBuf};

/// Print the completions of commands and options for a shell, in bash, fish and zsh of choices, too
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate completions bash > ~/.local/share/bash-completion/completions/cognate
  cognate completions zsh > ~/.zfunc/_cognate
  cognate completions fish > ~/.config/fish/completions/cognate.fish
  cognate completions powershell >> $PROFILE")]
pub struct Args {
    /// Shell that completes
    shell: Shell,
}

/// Print a page of the manual for `man`, or write the pages of all commands
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate man run | man -l -
  cognate man -o ~/.local/share/man/man1")]
pub struct ManArgs {
    /// Command whose page is printed, as run or runs compare [default: the page of all commands]
    command: Vec<String>,
    /// Folder that the pages of all commands are written to [default: none, a page is printed]
    #[arg(short = 'o', long, value_name = "DIR", conflicts_with = "command", value_parser = piped::refused(piped::SEVERAL))]
    out: Option<PathBuf>,
}

/// Prints the completions.
pub fn run(args: &Args) -> Outcome {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut super::command(), "cognate", &mut text);
    say_bytes(&text);
    Ok(Exit::Done)
}

/// Prints a page, or writes all of them.
///
/// # Errors
/// When there is no such command, or a file cannot be written.
pub fn man(args: &ManArgs) -> Outcome {
    let mut whole = super::command();
    whole.build();
    if let Some(folder) = &args.out {
        let written = write_pages(&whole, folder)?;
        remark(format!("{written} pages in {}", folder.display()));
        return Ok(Exit::Done);
    }
    let mut command = &whole;
    for word in &args.command {
        command = command.find_subcommand(word).ok_or_else(|| {
            let what = format!("there is no command `{}`", args.command.join(" "));
            let names: Vec<&str> = command.get_subcommands().map(|c| c.get_name()).collect();
            let d = Diagnostic::error("usage", what);
            Failure {
                exit: Exit::Usage,
                ..Failure::from(d.help(format!("commands: {}", names.join(", "))))
            }
        })?;
    }
    say(&page(command)?.1);
    Ok(Exit::Done)
}

/// Returns the name of the file of a page, and its text.
fn page(command: &clap::Command) -> Result<(String, String), Diagnostic> {
    let page = Man::new(command.clone());
    let mut text = Vec::new();
    let rendered = page.render(&mut text);
    rendered.map_err(|e| Diagnostic::error("bug", format!("the page has no text: {e}")))?;
    let text = String::from_utf8_lossy(&text).into_owned();
    Ok((page.get_filename(), text))
}

/// Writes the pages of a command and of those below it; returns how many.
fn write_pages(command: &clap::Command, folder: &Path) -> Result<usize, Diagnostic> {
    let (name, text) = page(command)?;
    let file = folder.join(name);
    std::fs::create_dir_all(folder).map_err(|e| {
        let what = format!("{}: no folder can be made: {e}", folder.display());
        Diagnostic::error(Cause::FileUnwritable, what)
    })?;
    let heading = format!(".TH {} ", command.get_display_name().unwrap_or("cognate"));
    let before = std::fs::read_to_string(&file).ok();
    if file.exists() && !before.is_some_and(|page| page.contains(&heading)) {
        let what = format!("{} is there and is none of our pages", file.display());
        let d = Diagnostic::error(Cause::FileUnwritable, what);
        return Err(d.help("move it, or choose another folder"));
    }
    results::write_text(&file, &text)?;
    let mut written = 1;
    for below in command.get_subcommands().filter(|c| !c.is_hide_set()) {
        written += write_pages(below, folder)?;
    }
    Ok(written)
}
