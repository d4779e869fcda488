//! `cognate group`: functions of the user's, and groups of functions.

use super::setup::{self, Members, Ordinate, Setup, USER_DEFINED, edit};
use super::{Exit, Failure, Outcome, remark, say};
use cognate::diagnostic::{Diagnostic, near_names};
use cognate::disk;
use cognate::results::json;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use toml_edit::{Array, Item, Table};

/// Make functions of time, and put functions into groups
///
/// Functions are for loads (`cognate loads drive`) and for plots. Expressions are of t in degrees,
/// direct entry is the language of datasets in radians. Every function is in a group: USER_DEFINED
/// holds those that no other group names, and each run is a group of its columns. All stands in
/// MODEL.toml beside the dataset; its comments and its order stay.
#[derive(clap::Args)]
#[command(
    args_conflicts_with_subcommands = true,
    after_help = "\
Examples:
  cognate group crane.adm                            groups and what is in them
  cognate group function crane.adm swing --expression '30*sin(90*t)' --ordinate angle
  cognate group function crane.adm push --direct 'STEP(TIME, 0, 0, 1, 50)'
  cognate group function crane.adm lift --points '0,0 1,2 2,2.5 3,2' --ends not-a-knot
  cognate group function crane.adm road --points road.csv --slopes 0,0
  cognate group create crane.adm Drives swing lift slider.X
  cognate group create crane.adm All --groups Drives USER_DEFINED
  cognate plot results/crane.csv --group Drives"
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
    /// Make a group of functions or of groups, or give one other members
    Create {
        /// Dataset (.adm), or command file (.acf) that names it
        model: PathBuf,
        /// Name of the group
        name: String,
        /// Functions, or columns of results
        members: Vec<String>,
        /// Groups: the group is one of groups [default: it is one of functions]
        #[arg(long, value_name = "GROUP", num_args = 1.., conflicts_with = "members")]
        groups: Vec<String>,
    },
    /// Remove a group; its functions stay
    Remove {
        /// Dataset (.adm), or command file (.acf) that names it
        model: PathBuf,
        /// Name of the group
        name: String,
    },
    Function(Box<FunctionArgs>),
    /// Delete a function
    Delete {
        /// Dataset (.adm), or command file (.acf) that names it
        model: PathBuf,
        /// Name of the function
        name: String,
    },
}

/// Make a function of time, or change one
#[derive(clap::Args)]
struct FunctionArgs {
    /// Dataset (.adm), or command file (.acf) that names it
    model: PathBuf,
    /// Name of the function
    name: String,
    #[command(flatten)]
    shape: ShapeArgs,
    /// Its quantity. Angles of expressions and points are in degrees [default: not said]
    #[arg(long, value_name = "QUANTITY", value_parser = Ordinate::words(), ignore_case = true)]
    ordinate: Option<String>,
    /// Ends of the spline [default: natural]
    #[arg(
        long,
        value_name = "ENDS",
        value_parser = ["natural", "not-a-knot", "periodic"],
        requires = "points",
        conflicts_with = "slopes"
    )]
    ends: Option<String>,
    /// Slopes of the spline at its first and its last point [default: none, --ends says how it
    /// ends]
    #[arg(
        long,
        value_name = "A,B",
        requires = "points",
        value_delimiter = ',',
        allow_negative_numbers = true
    )]
    slopes: Vec<f64>,
    /// Group to put it into [default: USER_DEFINED]
    #[arg(long = "in", value_name = "GROUP")]
    group: Option<String>,
}

/// The form of a function.
#[derive(clap::Args)]
#[group(required = true, multiple = false)]
struct ShapeArgs {
    /// Expression of t, angles in degrees: sin cos … log ln int frac sign [default: none, one of
    /// the four is needed]
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true)]
    expression: Option<String>,
    /// In the language of datasets, angles in radians; may read markers [default: none]
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true)]
    direct: Option<String>,
    /// File with a function in the language of datasets [default: none]
    #[arg(long, value_name = "FILE")]
    file: Option<String>,
    /// Points of a cubic spline: `0,0 1,2.5 2,3`, or a file of two columns [default: none]
    #[arg(long, value_name = "POINTS", allow_hyphen_values = true)]
    points: Option<String>,
}

/// Lists or changes functions and groups.
///
/// # Errors
/// When a file has mistakes or cannot be written, or there is nothing of a name.
pub fn run(args: &Args) -> Outcome {
    match &args.verb {
        None => list(args.model.as_deref().unwrap_or(Path::new("")), args.json),
        Some(Verb::Create {
            model,
            name,
            members,
            groups,
        }) => create(model, name, members, groups),
        Some(Verb::Remove { model, name }) => remove(model, name),
        Some(Verb::Function(args)) => function(args),
        Some(Verb::Delete { model, name }) => delete(model, name),
    }
}

/// Makes or changes a group.
fn create(model: &Path, name: &str, members: &[String], groups: &[String]) -> Outcome {
    let setup = setup::of_model(model)?;
    let (key, names) = match groups.is_empty() {
        true => ("functions", members),
        false => ("groups", groups),
    };
    let mut table = Table::new();
    table.insert(key, Item::Value(edit::list(names)));
    let setup = edit::change(&setup, |document| put(document, "groups", name, table))?;
    let file = disk::text(&setup.file);
    remark(format!("the group {name} is in {file}"));
    Ok(Exit::Done)
}

/// Puts a table into a table of tables; the entries of one that is there are replaced.
fn put(document: &mut toml_edit::DocumentMut, of: &str, name: &str, new: Table) {
    let all = edit::table(document, of);
    if let Some(all) = all.as_table_mut() {
        all.set_implicit(true);
    }
    let Some(all) = all.as_table_like_mut() else {
        return;
    };
    let old = all.get_mut(name).and_then(Item::as_table_like_mut);
    let Some(old) = old else {
        all.insert(name, Item::Table(new));
        return;
    };
    let gone: Vec<String> = (old.iter().map(|(key, _)| key.to_owned()))
        .filter(|key| !new.contains_key(key))
        .collect();
    for key in gone {
        old.remove(&key);
    }
    for (key, item) in new {
        match old.get_mut(&key) {
            Some(place) => *place = item,
            None => {
                old.insert(&key, item);
            }
        }
    }
}

/// Removes a group that no other holds.
fn remove(model: &Path, name: &str) -> Outcome {
    let setup = setup::of_model(model)?;
    if setup.group(name).is_none() {
        return Err(unknown(&setup, name).into());
    }
    let holds = |members: &Members| match members {
        Members::Groups(all) => all.iter().any(|n| n.text == name),
        Members::Functions(_) => false,
    };
    if let Some(user) = setup.groups.iter().find(|g| holds(&g.members)) {
        let what = format!("the group {} holds {name}", user.name.text);
        return Err(Failure::usage(what));
    }
    edit::remove(&setup, "groups", name)?;
    remark(format!("the group {name} is removed"));
    Ok(Exit::Done)
}

/// Says that there is no group of a name.
pub(super) fn unknown(setup: &Setup, name: &str) -> Diagnostic {
    let known = setup.group_names();
    let d = Diagnostic::error("unknown_group", format!("there is no group `{name}`"));
    let near = near_names(name, known.iter().copied());
    match near.is_empty() {
        true => d.help(format!("groups: {}", known.join(", "))),
        false => d.help(format!("did you mean {}?", near.join(" or "))),
    }
}

/// Makes or changes a function.
fn function(args: &FunctionArgs) -> Outcome {
    let setup = setup::of_model(&args.model)?;
    let mut table = Table::new();
    let ShapeArgs {
        expression,
        direct,
        file,
        points,
    } = &args.shape;
    for (key, text) in [
        ("expression", expression),
        ("direct", direct),
        ("file", file),
    ] {
        if let Some(text) = text {
            table.insert(key, toml_edit::value(text));
        }
    }
    if let Some(points) = points {
        table.insert("points", points_of(points)?);
    }
    if let Some(ends) = &args.ends {
        table.insert("ends", toml_edit::value(ends));
    }
    if !args.slopes.is_empty() {
        let slopes: Array = args.slopes.iter().copied().collect();
        table.insert("slopes", toml_edit::value(slopes));
    }
    if let Some(ordinate) = &args.ordinate {
        let known = Ordinate::of(ordinate).map_err(Failure::usage)?;
        table.insert("ordinate", toml_edit::value(known.word()));
    }
    let mut new = edit::change(&setup, |document| {
        put(document, "functions", &args.name, table);
    })?;
    // a function that cannot be read is told at once
    let made = new.function(&args.name);
    if let Some(Err(d)) = made.map(|f| f.values(&[])) {
        edit::restore(&setup)?;
        return Err(d.into());
    }
    if let Some(group) = args.group.as_deref().filter(|g| *g != USER_DEFINED) {
        new = join(&new, group, &args.name)?;
    }
    let file = disk::text(&new.file);
    remark(format!("the function {} is in {file}", args.name));
    Ok(Exit::Done)
}

/// Puts a function into a group, which is made where it is not there.
fn join(setup: &Setup, group: &str, function: &str) -> Result<Setup, Failure> {
    let mut names: Vec<String> = match setup.group(group).map(|g| &g.members) {
        Some(Members::Groups(_)) => {
            return Err(Failure::usage(format!("{group} is a group of groups")));
        }
        Some(Members::Functions(all)) => all.iter().map(|n| n.text.clone()).collect(),
        None => Vec::new(),
    };
    if !names.iter().any(|n| n == function) {
        names.push(function.to_owned());
    }
    let mut table = Table::new();
    table.insert("functions", Item::Value(edit::list(&names)));
    Ok(edit::change(setup, |document| {
        put(document, "groups", group, table)
    })?)
}

/// Reads points from the command line: pairs, or the name of a file.
fn points_of(text: &str) -> Result<Item, Failure> {
    if !text.starts_with(|c: char| c.is_ascii_digit() || "+-. ".contains(c)) {
        return Ok(toml_edit::value(text));
    }
    let pair = |pair: &str| {
        let (x, y) = pair.split_once(',')?;
        let number = |text: &str| text.trim().parse::<f64>().ok();
        Some([number(x)?, number(y)?].into_iter().collect::<Array>())
    };
    let pairs: Option<Array> = text.split_whitespace().map(pair).collect();
    pairs.map(toml_edit::value).ok_or_else(|| {
        Failure::usage(format!(
            "`{text}`: points are pairs of time and value, `0,0 1,2.5`"
        ))
    })
}

/// Deletes a function that no load needs.
fn delete(model: &Path, name: &str) -> Outcome {
    let setup = setup::of_model(model)?;
    if setup.function(name).is_none() {
        let known = setup.functions.iter().map(|f| f.name.text.as_str());
        let near = near_names(name, known);
        let d = Diagnostic::error("unknown_function", format!("there is no function `{name}`"));
        return Err(match near.is_empty() {
            true => d.help("`cognate group MODEL` lists all").into(),
            false => d
                .help(format!("did you mean {}?", near.join(" or ")))
                .into(),
        });
    }
    if let Some((load, _)) = setup.driven.iter().find(|(_, f)| f.text == name) {
        let what = format!(
            "{name} gives {}: `cognate loads drive` takes another",
            load.text
        );
        return Err(Failure::usage(what));
    }
    edit::change(&setup, |document| {
        let functions = document
            .get_mut("functions")
            .and_then(Item::as_table_like_mut);
        functions.and_then(|t| t.remove(name));
        let groups = document.get_mut("groups").and_then(Item::as_table_like_mut);
        for (_, group) in groups.into_iter().flat_map(|g| g.iter_mut()) {
            let members = group.get_mut("functions").and_then(Item::as_array_mut);
            if let Some(members) = members {
                members.retain(|member| member.as_str() != Some(name));
            }
        }
    })?;
    remark(format!("the function {name} is deleted"));
    Ok(Exit::Done)
}

/// Prints groups, and the functions in them.
fn list(model: &Path, as_json: bool) -> Outcome {
    let setup = setup::of_model(model)?;
    let groups = setup.group_names();
    if as_json {
        let group = |name: &&str| {
            let groups: Vec<&str> = match setup.group(name).map(|g| &g.members) {
                Some(Members::Groups(all)) => all.iter().map(|n| n.text.as_str()).collect(),
                Some(Members::Functions(_)) | None => Vec::new(),
            };
            json!({ "group": name, "groups": groups, "functions": setup.functions_of(name) })
        };
        let function = |f: &super::setup::UserFunction| json!({ "function": f.name.text, "given": f.described(), "ordinate": f.ordinate.word() });
        say(&json::text(&json!({
            "groups": groups.iter().map(group).collect::<Vec<Value>>(),
            "functions": setup.functions.iter().map(function).collect::<Vec<Value>>(),
        })));
        return Ok(Exit::Done);
    }
    let mut text = String::new();
    for name in groups {
        text += &format!("{name}\n");
        if let Some(Members::Groups(all)) = setup.group(name).map(|g| &g.members) {
            for group in all {
                text += &format!("  group {}\n", group.text);
            }
            continue;
        }
        for function in setup.functions_of(name).unwrap_or_default() {
            let described = setup.function(&function).map(|f| {
                let ordinate = f.ordinate.word();
                let gap = if ordinate.is_empty() { "" } else { ", " };
                format!("{}{gap}{ordinate}", f.described())
            });
            let described = described.unwrap_or_else(|| "result of a run".to_owned());
            text += &format!("  {function}: {described}\n");
        }
    }
    say(&text);
    Ok(Exit::Done)
}
