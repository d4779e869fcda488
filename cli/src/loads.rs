//! `cognate loads`: the loads of a model, its load cases, and the set-up of its runs.

use super::arguments::{IntegrationArgs, SpanArgs};
use super::run;
use super::setup::{self, Asked, Load, Setup, edit, loads_of};
use super::table::Table;
use super::{Exit, Failure, Outcome, remark, say, width};
use clap::ValueEnum;
use cognate::analysis::session::Chosen;
use cognate::diagnostic::{Diagnostic, near_names};
use cognate::disk;
use cognate::model::Model;
use cognate::results::format::Format;
use cognate::results::json;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use toml_edit::Item;

/// List the loads of a model, make and choose load cases, and set up its runs
///
/// Loads are gravity, motions (MOTION), forces (SFORCE, VFORCE, VTORQUE, GFORCE), contacts
/// (CONTACT) and initial conditions (IC:PART/2). Load cases are named sets of them. They stand in
/// MODEL.toml beside the dataset; its comments and its order stay.
#[derive(clap::Args)]
#[command(
    args_conflicts_with_subcommands = true,
    after_help = "\
Examples:
  cognate loads crane.adm                            loads, load cases and what acts
  cognate loads create crane.adm lift gravity MOTION/1
  cognate loads choose crane.adm lift                the next runs take it; all: all loads
  cognate loads drive crane.adm MOTION/1 slow        a function gives a load (cognate group)
  cognate loads setup crane.adm --end 2 --steps 200 --equilibrium
  cognate loads remove crane.adm lift
  cognate run crane.adm --loads lift,SFORCE/3"
)]
pub struct Args {
    #[command(subcommand)]
    verb: Option<Verb>,
    /// Dataset (.adm), or command file (.acf) that names it
    #[arg(required = true)]
    model: Option<PathBuf>,
    /// Print the list as JSON
    #[arg(long)]
    json: bool,
}

#[derive(clap::Subcommand)]
enum Verb {
    /// Make a load case, or give one other loads
    Create {
        /// Dataset (.adm), or command file (.acf) that names it
        model: PathBuf,
        /// Name of the load case
        name: String,
        /// Loads, or other load cases
        #[arg(required = true)]
        loads: Vec<String>,
    },
    /// Remove load cases
    Remove {
        /// Dataset (.adm), or command file (.acf) that names it
        model: PathBuf,
        /// Names of load cases
        #[arg(required = true)]
        names: Vec<String>,
    },
    /// Choose the loads that act in the next runs
    Choose {
        /// Dataset (.adm), or command file (.acf) that names it
        model: PathBuf,
        /// Load cases and loads; `all` for all loads
        #[arg(required = true)]
        loads: Vec<String>,
    },
    /// Let a function give a load; without a function, that of the dataset
    Drive {
        /// Dataset (.adm), or command file (.acf) that names it
        model: PathBuf,
        /// The load, as MOTION/1, SFORCE/3 or VFORCE/2.FX
        load: String,
        /// Name of a function (`cognate group`)
        function: Option<String>,
    },
    Setup(SetupArgs),
}

/// Set up the runs of a dataset: what `cognate run` takes where it is not told
#[derive(clap::Args)]
struct SetupArgs {
    /// Dataset (.adm), or command file (.acf) that names it
    model: PathBuf,
    #[command(flatten)]
    span: SpanArgs,
    /// Find the static equilibrium first
    #[arg(long, conflicts_with = "no_equilibrium")]
    equilibrium: bool,
    /// Do not find the static equilibrium first
    #[arg(long)]
    no_equilibrium: bool,
    #[command(flatten)]
    integration: IntegrationArgs,
    /// Formats of the tables [default: as before]
    #[arg(long = "format", value_name = "NAME", value_delimiter = ',', value_parser = Format::names(true), ignore_case = true)]
    formats: Vec<String>,
    /// Record only this element, as JOINT/3 or by its name, or this kind, as JOINT (repeatable)
    /// [default: as before]
    #[arg(long, value_name = "ELEMENT", value_delimiter = ',')]
    only: Vec<String>,
    /// Record velocities and accelerations of the bodies' centres of mass
    #[arg(long)]
    body_motion: bool,
    /// A further column: any expression (repeatable) [default: as before]
    #[arg(long = "column", value_name = "EXPR")]
    columns: Vec<String>,
    /// Forget the set-up before, but the choice of loads
    #[arg(long)]
    clear: bool,
}

/// Lists loads, or changes load cases and the set-up.
///
/// # Errors
/// When a file has mistakes or cannot be written, or a name is no load.
pub fn run(args: &Args) -> Outcome {
    match &args.verb {
        None => list(args.model.as_deref().unwrap_or(Path::new("")), args.json),
        Some(Verb::Create { model, name, loads }) => create(model, name, loads),
        Some(Verb::Remove { model, names }) => remove(model, names),
        Some(Verb::Choose { model, loads }) => choose(model, loads),
        Some(Verb::Drive {
            model,
            load,
            function,
        }) => drive(model, load, function.as_deref()),
        Some(Verb::Setup(args)) => set_up(args),
    }
}

/// A model with all its loads, and the file beside it.
fn opened(model: &Path) -> Result<(Model, Setup), Failure> {
    let dataset = setup::dataset_of(model)?;
    let reading = run::read_with(&dataset, Asked::All)?;
    Ok((reading.model, setup::beside(&dataset)?))
}

/// Makes or changes a load case, after its loads were looked for in the model.
fn create(model: &Path, name: &str, loads: &[String]) -> Outcome {
    let (model, setup) = opened(model)?;
    let is_load = Load::is_written(name) || Load::named(&model, name).is_ok();
    if name.eq_ignore_ascii_case("all") || is_load {
        let what = format!("`{name}` is what a load is called, and no name for a load case");
        return Err(Failure::usage(what));
    }
    setup::check_loads(&setup, &model, loads)?;
    let is_new = setup.case(name).is_none();
    let setup = edit::set_case(&setup, name, loads)?;
    let done = if is_new { "is in" } else { "is changed in" };
    remark(format!("{name} {done} {}", disk::text(&setup.file)));
    Ok(Exit::Done)
}

/// Removes load cases that nothing else names.
fn remove(model: &Path, names: &[String]) -> Outcome {
    let mut setup = setup::of_model(model)?;
    for name in names {
        if setup.case(name).is_none() {
            let known = setup.cases.iter().map(|c| c.name.text.as_str());
            return Err(unknown("load case", name, known).into());
        }
        let cases = setup.cases.iter().filter(|c| !names.contains(&c.name.text));
        let within = cases.filter(|c| c.loads.iter().any(|n| n.text == *name));
        let chosen = setup.solve.loads.iter().flatten().any(|n| n.text == *name);
        let users: Vec<String> = within.map(|c| c.name.text.clone()).collect();
        if let Some(user) = users.first() {
            let what = format!("the load case {user} holds {name}: nothing was removed");
            return Err(Failure::usage(what));
        }
        if chosen {
            let what = format!("{name} is chosen for the next runs: choose other loads first");
            return Err(Failure::usage(what));
        }
    }
    for name in names {
        setup = edit::remove(&setup, "cases", name)?;
        remark(format!(
            "{name} is removed from {}",
            disk::text(&setup.file)
        ));
    }
    Ok(Exit::Done)
}

/// Says that there is nothing of a name.
fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str>) -> Diagnostic {
    let known: Vec<&str> = known.collect();
    let near = near_names(name, known.iter().copied());
    let d = Diagnostic::error("unknown_load", format!("there is no {what} `{name}`"));
    match (near.is_empty(), known.is_empty()) {
        (false, _) => d.help(format!("did you mean {}?", near.join(" or "))),
        (true, false) => d.help(format!("there are {}", known.join(", "))),
        (true, true) => d.help("there are none"),
    }
}

/// Keeps a choice of loads.
fn choose(model: &Path, loads: &[String]) -> Outcome {
    let dataset = setup::dataset_of(model)?;
    run::read_with(&dataset, Asked::New(loads)).map(|_| Exit::Done)
}

/// Lets a function give a load, or takes it away again.
fn drive(model: &Path, load: &str, function: Option<&str>) -> Outcome {
    let (opened_model, before) = opened(model)?;
    let target = setup::target_of(&opened_model, load);
    // the file may call it otherwise
    let is_it = |name: &str| match (&target, setup::target_of(&opened_model, name)) {
        (Ok(target), Ok(other)) => *target == other,
        _ => name == load,
    };
    let mut driven = before.driven.iter().map(|(target, _)| target.text.as_str());
    let known = driven.find(|name| is_it(name)).map(str::to_owned);
    let Some(function) = function else {
        let Some(known) = known else {
            let known = before.driven.iter().map(|(target, _)| target.text.as_str());
            return Err(unknown("load with a function of yours", load, known).into());
        };
        edit::remove(&before, "loads", &known)?;
        remark(format!("{load} has the function of the dataset again"));
        return Ok(Exit::Done);
    };
    if let Err(d) = target {
        return Err(Failure::at_argument("LOAD", load, d));
    }
    let load = known.as_deref().unwrap_or(load);
    let after = edit::change(&before, |document| {
        let loads = edit::table(document, "loads");
        edit::set(loads, load, function.into());
    })?;
    // the model takes it, or the file is as it was
    match opened(model) {
        Ok(_) => {
            remark(format!(
                "{load} is given by {function} in {}",
                disk::text(&after.file)
            ));
            Ok(Exit::Done)
        }
        Err(mut failure) => {
            edit::restore(&before)?;
            for d in &mut failure.diagnostics {
                (d.file, d.line, d.column, d.span) = (None, 0, 0, None);
            }
            Err(failure)
        }
    }
}

/// Changes the set-up.
fn set_up(args: &SetupArgs) -> Outcome {
    let setup = setup::of_model(&args.model)?;
    for only in &args.only {
        only.parse::<Chosen>().map_err(Failure::usage)?;
    }
    let numbers = [("end", args.span.end), ("error", args.integration.error)];
    let kind = args.span.kind.and_then(|k| k.to_possible_value());
    let words = [
        ("type", kind.map(|k| k.get_name().to_owned())),
        ("method", args.integration.method.clone()),
    ];
    let lists = [
        ("format", &args.formats),
        ("only", &args.only),
        ("columns", &args.columns),
    ];
    let switches = [
        ("initial_static_equilibrium", true, args.equilibrium),
        ("initial_static_equilibrium", false, args.no_equilibrium),
        ("body_motion", true, args.body_motion),
    ];
    let new = edit::change(&setup, |document| {
        let solve = edit::table(document, "solve");
        if args.clear
            && let Some(solve) = solve.as_table_mut()
        {
            solve.retain(|key, _| key == "loads");
        }
        for (key, value) in numbers {
            if let Some(value) = value {
                edit::set(solve, key, value.into());
            }
        }
        if let Some(steps) = args.span.steps {
            let steps = i64::try_from(steps).unwrap_or(i64::MAX);
            edit::set(solve, "steps", steps.into());
        }
        for (key, value) in words {
            if let Some(value) = value {
                edit::set(solve, key, value.into());
            }
        }
        for (key, values) in lists.into_iter().filter(|(_, values)| !values.is_empty()) {
            edit::set(solve, key, edit::list(values));
        }
        for (key, value, _) in switches.into_iter().filter(|s| s.2) {
            edit::set(solve, key, value.into());
        }
    })?;
    say(&set_up_text(&new));
    Ok(Exit::Done)
}

/// Returns the set-up as it stands in the file.
fn set_up_text(setup: &Setup) -> String {
    let document: Result<toml_edit::DocumentMut, _> = setup.text.parse();
    let table = document.ok().and_then(|d| d.get("solve").cloned());
    let table = table.as_ref().and_then(Item::as_table_like);
    let entries = table.into_iter().flat_map(|t| t.iter());
    let lines = entries.map(|(key, item)| format!("{key} = {}\n", item.to_string().trim()));
    let text: String = lines.collect();
    match text.is_empty() {
        true => "no set-up: cognate run takes its options\n".to_owned(),
        false => text,
    }
}

/// Prints the loads and the load cases.
fn list(file: &Path, as_json: bool) -> Outcome {
    let (model, setup) = opened(file)?;
    let all = loads_of(&model);
    let chosen = setup.solve.loads.as_ref();
    let names = chosen.map(|all| all.iter().map(|n| n.text.clone()).collect::<Vec<_>>());
    let acting = setup::chosen_loads(&setup, &model)?.unwrap_or_else(|| all.clone());
    let cases = |load: &Load| -> Vec<String> {
        let holds = |name: &str| {
            let name = [name.to_owned()];
            setup::check_loads(&setup, &model, &name).is_ok_and(|all| all.contains(load))
        };
        let names = setup.cases.iter().map(|c| c.name.text.clone());
        names.filter(|name| holds(name)).collect()
    };
    let function = |load: &Load| -> Vec<String> {
        let is_of = |target: &str| match (setup::target_of(&model, target), *load) {
            (Ok((id, _)), Load::Element(own)) => id == own,
            _ => false,
        };
        let own = (setup.driven.iter()).filter(|(target, _)| is_of(&target.text));
        own.map(|(_, name)| name.text.clone()).collect()
    };
    if as_json {
        let load = |l: &Load| json!({ "load": l.to_string(), "acts": acting.contains(l), "functions": function(l), "cases": cases(l) });
        let case = |c: &setup::Case| {
            let loads: Vec<&str> = c.loads.iter().map(|n| n.text.as_str()).collect();
            json!({ "name": c.name.text, "loads": loads })
        };
        say(&json::text(&json!({
            "file": setup.exists().then(|| disk::text(&setup.file)),
            "loads": all.iter().map(load).collect::<Vec<_>>(),
            "cases": setup.cases.iter().map(case).collect::<Vec<Value>>(),
            "chosen": names,
        })));
        return Ok(Exit::Done);
    }
    let mut table = Table::new(["load", "name", "acts", "function", "in load cases"]);
    for load in &all {
        let name = match load {
            Load::Element(id) | Load::Initial(id) => {
                model.element(*id).and_then(|e| e.place().name.clone())
            }
            Load::Gravity => None,
        };
        let acts = if acting.contains(load) { "yes" } else { "no" };
        table.push([
            load.to_string(),
            name.unwrap_or_default(),
            acts.to_owned(),
            function(load).join(", "),
            cases(load).join(", "),
        ]);
    }
    match all.is_empty() {
        true => {
            remark("the model has no loads: no motion, no force, no gravity, no initial velocity")
        }
        false => say(&table.text(width::columns())),
    }
    say(&match &names {
        Some(names) => format!("chosen: {}\n", names.join(", ")),
        None => "chosen: all loads\n".to_owned(),
    });
    say(&set_up_text(&setup));
    Ok(Exit::Done)
}
