//! `cognate eval`: the value of an expression at a time, or a table over a range of times.

use super::formula::{Formula, Setting, derivative_names, give, times};
use super::render::Sources;
use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, anatomy, complain, plot, say};
use cognate::diagnostic::Diagnostic;
use cognate::expr::Profile;
use cognate::expr::ast::Dialect;
use cognate::internals::report::Plot;
use cognate::results::{Kind, Run, Units, csv, digits, json};
use serde_json::{Value, json};
use std::io::Read;
use std::path::PathBuf;

/// Evaluate an expression of the function language
///
/// Prints the shortest digits that read back as the same number. Over a range of times it prints a
/// table: time, value, derivatives.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate eval 'STEP(TIME,1,0,2,1)' --time 1.5
  cognate eval 'SIN(2*PI*TIME)' --time 0:2:0.01 --derivative 2 > table.csv
  cognate eval 'IMPACT(TIME,-1,1,100,1.5,25,0.1)' --time 0:2:0.01 --plot impact.svg
  cognate eval '180*sin(360*t)' --dialect expression --time 0.1
  cognate eval 'DX(12,21)+VARVAL(3)' --markers markers.json --set 'VARVAL(3)=2.5'
  cognate eval 'STEP(TIME,1,0,2,1)' --explain
  echo 'AKISPL(TIME,0,1)' | cognate eval - --time 1.25 --splines splines.json")]
pub struct Args {
    /// The expression; - reads it from standard input
    #[arg(allow_hyphen_values = true)]
    expression: String,
    /// Values given without their option, which is told
    #[arg(hide = true)]
    further: Vec<String>,
    /// Time, or a range first:last:step [default: none, for expressions without TIME]
    #[arg(long, value_name = "T|A:B:STEP", allow_hyphen_values = true)]
    time: Option<String>,
    /// Print the derivative over time of this order; in a table, up to this order
    #[arg(long, value_name = "ORDER", value_parser = clap::value_parser!(u8).range(0..=2), default_value_t = 0)]
    derivative: u8,
    /// The language: direct-entry functions, or expression functions of t in degrees
    #[arg(long, value_enum, default_value = "function")]
    dialect: DialectName,
    /// Whose limits and names: adams, or ideas (nesting 10, 1000 symbols, 20 lines or 500
    /// characters, AKIMA)
    #[arg(long, value_enum, default_value = "adams")]
    profile: ProfileName,
    /// States of markers: {"12": {"r": [x,y,z], "v": …, "w": …, "a": …, "al": …, "e313":
    /// [psi,theta,phi]}} [default: none]
    #[arg(long, value_name = "FILE.json")]
    markers: Option<PathBuf>,
    /// Data of splines: {"1": {"x": […], "y": […]}} [default: none]
    #[arg(long, value_name = "FILE.json")]
    splines: Option<PathBuf>,
    /// Points of curves: {"1": {"points": [[x,y,z], …], "closed": false, "control": false, "order":
    /// 4}} [default: none]
    #[arg(long, value_name = "FILE.json")]
    curves: Option<PathBuf>,
    /// Give a value to a function of the model, such as 'VARVAL(3)=2.5' (repeatable) [default:
    /// none]
    #[arg(long, value_name = "CALL=VALUE")]
    set: Vec<String>,
    /// Plot value and derivatives to a file (.svg, .png or .pdf), in place of the table; with
    /// --json, both [default: no plot]
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    writing: WritingArgs,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Show the tree with values, inputs, switching functions, continuity class and breakpoints
    /// (within the range of --time)
    #[arg(long, conflicts_with_all = ["plot", "json"])]
    explain: bool,
}

/// The language, chosen by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum DialectName {
    /// radians, TIME, degree suffix D
    Function,
    /// degrees, t
    Expression,
}

impl From<DialectName> for Dialect {
    fn from(name: DialectName) -> Self {
        match name {
            DialectName::Function => Dialect::Function,
            DialectName::Expression => Dialect::Expression,
        }
    }
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum ProfileName {
    Adams,
    Ideas,
}

/// The value of `--time`.
enum Time {
    Not,
    At(f64),
    Over(Vec<f64>),
}

/// Evaluates an expression and prints its value, a table or an explanation.
///
/// # Errors
/// The first mistake in the expression or in the data; or an operation without a value.
pub fn run(args: &Args) -> Outcome {
    if let Some(further) = args.further.first() {
        return Err(without_option(further));
    }
    let text = match args.expression.as_str() {
        "-" => from_stdin()?,
        text => text.to_owned(),
    };
    let outcome = evaluate(args, &text);
    if let (true, Err(failure)) = (args.json, &outcome) {
        say(&json::text(
            &json!({ "expression": text, "errors": with_lines(failure) }),
        ));
    }
    outcome
}

/// Says which option takes a value that was given behind the expression: `TIME=3`, `DX(1,2)=3`.
fn without_option(further: &str) -> Failure {
    let what = format!("`{further}` is neither the expression nor an option");
    let advice = match further.split_once('=') {
        Some((name, value)) if ["TIME", "T"].contains(&name.trim().to_uppercase().as_str()) => {
            format!("give the time as `--time {}`", value.trim())
        }
        Some(_) => format!("give values as `--set '{further}'`, the time as `--time 1.5`"),
        None => "an expression with blanks stands in quotes; the time is `--time 1.5`".to_owned(),
    };
    Failure {
        exit: Exit::Usage,
        ..Failure::from(Diagnostic::error("usage", what).help(advice))
    }
}

/// The mistakes as JSON. `column` counts the whole expression, as the language does; `line` and
/// `column_in_line` are what an editor shows.
fn with_lines(failure: &Failure) -> Value {
    let mut all = json::findings(&failure.diagnostics);
    for (said, d) in all
        .as_array_mut()
        .into_iter()
        .flatten()
        .zip(&failure.diagnostics)
    {
        let text = failure.sources.text(d.file.as_deref());
        if let (Some(text), Some(span)) = (text, d.span) {
            let placed = d.clone().at(text, span);
            said["line"] = placed.line.into();
            said["column_in_line"] = placed.column.into();
        }
    }
    all
}

/// Evaluates an expression as the options demand.
fn evaluate(args: &Args, text: &str) -> Outcome {
    let time = time(args.time.as_deref())?;
    let setting = setting(args)?;
    let in_text = |d: Diagnostic| Failure {
        sources: Sources::of(text),
        ..Failure::from(d)
    };
    let mut formula = Formula::new(text, &setting).map_err(in_text)?;
    complain(&formula.expr.warnings(), &Sources::of(text));
    if args.explain {
        let (at, interval) = match &time {
            Time::Not => (None, anatomy::BREAKPOINT_INTERVAL),
            Time::At(t) => (Some(*t), anatomy::BREAKPOINT_INTERVAL),
            Time::Over(times) => match (times.first(), times.last()) {
                (Some(&first), Some(&last)) => (None, first..=last),
                _ => (None, anatomy::BREAKPOINT_INTERVAL),
            },
        };
        say(&anatomy::explain(&formula, at, interval, &setting.data));
        return Ok(Exit::Done);
    }
    let order = usize::from(args.derivative);
    let over = match time {
        Time::Over(times) => times,
        Time::At(_) | Time::Not if args.plot.is_some() => {
            return Err(Failure::usage(
                "a plot needs a range of times: --time first:last:step",
            ));
        }
        Time::At(t) => return one(args, text, &mut formula, Some(t), &setting).map_err(in_text),
        Time::Not => return one(args, text, &mut formula, None, &setting).map_err(in_text),
    };
    let mut run = Run::new("eval", "", Units::default());
    for name in derivative_names(text).into_iter().take(order + 1) {
        run.add_column(name, "");
    }
    run.begin(Kind::Dynamic);
    for t in over {
        let sample = formula
            .sample(Some(t), order, &setting.data)
            .map_err(in_text)?;
        run.push(&[&[t], &sample[..=order]].concat());
    }
    run.end();
    if let Some(file) = &args.plot {
        let mut picture = Plot::of_run(&run, None, &[])?;
        (picture.title, picture.x_label) = (
            String::new(),
            if args.dialect == DialectName::Function {
                "TIME"
            } else {
                "t"
            }
            .into(),
        );
        let written = plot::write_one(&picture, file, args.writing)?;
        if !args.json {
            return Ok(written);
        }
    }
    say(&if args.json {
        json::text(&json::table(&run))
    } else {
        csv::write(&run, false)
    });
    Ok(Exit::Done)
}

/// Prints the value, or the derivative, at one time.
fn one(
    args: &Args,
    text: &str,
    formula: &mut Formula,
    time: Option<f64>,
    setting: &Setting,
) -> Result<Exit, Diagnostic> {
    let order = usize::from(args.derivative);
    let sample = formula.sample(time, order, &setting.data)?;
    if args.json {
        let derivatives = &sample[1..=order];
        say(&json::text(
            &json!({ "expression": text, "time": time, "value": sample[0], "derivatives": derivatives }),
        ));
    } else {
        say(&(digits(sample[order]) + "\n"));
    }
    Ok(Exit::Done)
}

/// Collects language, profile and data from the options.
fn setting(args: &Args) -> Result<Setting, Failure> {
    let profile = match args.profile {
        ProfileName::Adams => Profile::Adams,
        ProfileName::Ideas => Profile::Ideas,
    };
    let mut setting = Setting {
        dialect: args.dialect.into(),
        profile,
        ..Setting::default()
    };
    if let Some(file) = &args.markers {
        setting.data.read_markers(file)?;
    }
    if let Some(file) = &args.splines {
        setting.data.read_splines(file)?;
    }
    if let Some(file) = &args.curves {
        setting.data.read_curves(file)?;
    }
    for assignment in &args.set {
        let usage = || {
            Failure::usage(format!(
                "`{assignment}` is not of the form CALL=VALUE, such as VARVAL(3)=2.5"
            ))
        };
        let (call, value) = assignment.split_once('=').ok_or_else(usage)?;
        let value = value.trim().parse().map_err(|_| usage())?;
        give(&mut setting, call, value).map_err(|d| Failure {
            sources: Sources::of(call),
            ..Failure::from(d)
        })?;
    }
    Ok(setting)
}

/// Reads a time, or a range of times.
fn time(text: Option<&str>) -> Result<Time, Failure> {
    let Some(text) = text else {
        return Ok(Time::Not);
    };
    let numbers: Option<Vec<f64>> = text
        .split(':')
        .map(|n| n.trim().parse().ok().filter(|n: &f64| n.is_finite()))
        .collect();
    match numbers.as_deref() {
        Some(&[t]) => Ok(Time::At(t)),
        Some(&[first, last, step]) => Ok(Time::Over(times(first, last, step).map_err(|d| {
            Failure {
                exit: Exit::Usage,
                ..Failure::from(d)
            }
        })?)),
        _ => Err(Failure::usage(format!(
            "`{text}` is neither a time nor a range first:last:step"
        ))),
    }
}

/// Reads the expression from standard input.
fn from_stdin() -> Result<String, Failure> {
    let mut text = String::new();
    let read = std::io::stdin()
        .lock()
        .take(16 << 20)
        .read_to_string(&mut text);
    read.map_err(|e| {
        Diagnostic::error(
            "file_unreadable",
            format!("standard input cannot be read: {e}"),
        )
    })?;
    Ok(text.trim_end().to_owned())
}
