//! Command files of Adams View: each is read, two agree with Adams' own dataset of the same model,
//! and the expressions of saved files give the numbers that View saved beside them.

use super::{corpus, errors};
use cognate::dataset::{self, Source};
use cognate::model::Model;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

fn files() -> Vec<PathBuf> {
    let all = corpus("cmd").unwrap_or_default();
    let is_kept = |p: &PathBuf| p.components().any(|c| c.as_os_str() == "cmd");
    all.into_iter().filter(is_kept).collect()
}

fn named<'a>(files: &'a [PathBuf], end: &str) -> &'a Path {
    let found = files.iter().find(|f| f.ends_with(end));
    found.unwrap_or_else(|| panic!("{end} is in the corpus"))
}

/// File and codes of the mistakes that it has; all others have none.
const MISTAKEN: &[(&str, &[&str])] = &[
    // dialogs alone
    ("dbox_flexbeam.cmd", &["view_no_model"]),
    // a tyre and its road
    ("Controls_Plant.cmd", &["view_unsolved"]),
    // HAVSIN with its arguments in another order
    ("gear_coupler.cmd", &["domain"]),
];

#[test]
fn every_view_file_is_read() {
    for path in files() {
        let name = path
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let known = MISTAKEN.iter().find(|(file, _)| *file == name);
        let known = known.map(|(_, codes)| *codes).unwrap_or_default();
        let reading = dataset::read(&path).expect("a readable file");
        let wrong = errors(&reading.diagnostics);
        let unknown = wrong.iter().find(|d| !known.contains(&d.code));
        assert!(unknown.is_none(), "{name}: {}", unknown.expect("a mistake"));
        assert!(known.is_empty() == wrong.is_empty(), "{name}: {wrong:?}");
        let is_model = !known.contains(&"view_no_model");
        assert!(
            !is_model || reading.model.parts.len() > 1,
            "{name} has parts"
        );
        if wrong.is_empty() {
            let again = dataset::read_text(&reading.model.to_text());
            assert_eq!(again.model.to_text(), reading.model.to_text(), "{name}");
        }
    }
}

/// Words and numbers of a statement, blanks and case left aside, angles in radians.
fn pieces(text: &str) -> (String, Vec<f64>) {
    let (mut words, mut numbers) = (String::new(), Vec::new());
    let mut number = String::new();
    for c in text.chars().chain([' ']) {
        let goes_on = c.is_ascii_digit()
            || c == '.'
            || !number.is_empty() && c.eq_ignore_ascii_case(&'e')
            || number.ends_with(['e', 'E']) && matches!(c, '+' | '-');
        let begins = !words.ends_with(|w: char| w.is_alphanumeric() || w == '_');
        if goes_on && (begins || !number.is_empty()) {
            number.push(c);
            continue;
        }
        let mut is_suffix = false;
        if !number.is_empty() {
            let sign = if words.ends_with('-') { -1.0 } else { 1.0 };
            match number.trim_end_matches(['e', 'E']).parse::<f64>() {
                Ok(x) => {
                    is_suffix = matches!(c, 'd' | 'D');
                    let unit = if is_suffix { 1.0_f64.to_radians() } else { 1.0 };
                    words.truncate(words.trim_end_matches('-').len());
                    numbers.push(sign * x * unit);
                }
                Err(_) => words += &number,
            }
            words.push('#');
            number.clear();
        }
        if !is_suffix {
            words.extend(c.to_lowercase().filter(|c| !c.is_whitespace()));
        }
    }
    (words, numbers)
}

/// Returns whether two statements say the same, whatever triple of angles an orientation has.
fn alike(a: &str, b: &str) -> bool {
    let parted = |text: &str| {
        let is_turn = |line: &&str| line.contains("REULER");
        let (turn, rest): (Vec<&str>, Vec<&str>) = text.lines().partition(is_turn);
        (pieces(&turn.concat()).1, pieces(&rest.join("\n")))
    };
    let rotation = |angles: &[f64]| {
        let of = |k: usize| angles.get(k).copied().unwrap_or(0.0);
        let z = |x| nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::z_axis(), x);
        let x = nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::x_axis(), of(1));
        z(of(0)) * x * z(of(2))
    };
    let ((turn, (words, numbers)), (other_turn, (others, other_numbers))) = (parted(a), parted(b));
    let size = numbers.iter().fold(1e-3_f64, |all, x| all.max(x.abs()));
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= TOLERANCE * size;
    words == others
        && numbers.len() == other_numbers.len()
        && numbers.iter().zip(&other_numbers).all(near)
        && (rotation(&turn).matrix() - rotation(&other_turn).matrix()).amax() < TOLERANCE
}

/// View writes ten digits; those of angles are of degrees.
const TOLERANCE: f64 = 1e-6;

/// Elements of a dataset of Adams that are not, or otherwise, in the model; those within tyres left
/// aside.
fn differences(adams: &Model, ours: &Model) -> (usize, Vec<String>) {
    let statements: BTreeMap<_, _> = ours.statements().into_iter().collect();
    let mut compared = 0;
    let mut wrong = Vec::new();
    for (id, text) in adams.statements() {
        let name = adams
            .element(id)
            .and_then(|e| e.place().name.clone())
            .unwrap_or_default();
        let kind = id.kind.keyword();
        // tyres; symbols of springs; arguments that a dataset leaves out where they are usual
        let is_within = name.starts_with("tire.") || name.starts_with("road.");
        let is_aside = matches!(kind, "GRAPHICS" | "SENSOR" | "STRING" | "ARRAY" | "GSE");
        let body = adams.body_of(id.number).filter(|_| kind == "MARKER");
        let body = body
            .and_then(|b| adams.body(b))
            .and_then(|b| b.place.name.clone());
        let on_tyre = body.is_some_and(|b| b.starts_with("tire.") || b.starts_with("road."));
        if is_within
            || is_aside
            || on_tyre
            || name.contains("for_suspension.") && kind == "VARIABLE"
        {
            continue;
        }
        compared += 1;
        // what a user-defined element is made of has no number in a command file
        let is_inner = name.contains('.');
        let named = ours.find_of(&[id.kind], &name).ok().filter(|_| is_inner);
        let other = statements.get(&named.unwrap_or(id));
        let headless = |text: &str| text.split_once('\n').map(|(_, rest)| rest.to_owned());
        let (own, other_text) = match is_inner {
            true => (headless(&text), other.and_then(|other| headless(other))),
            false => (Some(text.clone()), other.cloned()),
        };
        let is_alike = own.zip(other_text).is_some_and(|(a, b)| alike(&a, &b));
        if !is_alike {
            wrong.push(format!(
                "{text}\n  is {}",
                other.map_or("not there", String::as_str)
            ));
        }
    }
    (compared, wrong)
}

#[test]
fn view_files_mean_what_adams_writes_of_them() {
    let files = files();
    if files.is_empty() {
        return;
    }
    let datasets = corpus("adm").expect("datasets beside command files");
    for (command, dataset, least) in [
        (
            "analysis_with_spikes/test_analysis_with_spikes.cmd",
            "analysis_with_spikes/test_analysis_with_spikes.adm",
            20,
        ),
        (
            "adams/Controls_Plant.cmd",
            "quarter-car-adams-simulink-cosim/adams/Controls_Plant.adm",
            45,
        ),
    ] {
        let found = datasets
            .iter()
            .find(|f| f.to_string_lossy().ends_with(dataset));
        let adams = dataset::read(found.expect("Adams' dataset"))
            .expect("a readable file")
            .model;
        let ours = dataset::read(named(&files, command))
            .expect("a readable file")
            .model;
        let (compared, wrong) = differences(&adams, &ours);
        assert!(wrong.is_empty(), "{command}: {}", wrong.join("\n"));
        assert!(compared >= least, "{command}: {compared} elements compared");
    }
}

/// Names and numbers of the design variables that a file creates.
fn variables(text: &str) -> BTreeMap<String, f64> {
    let mut all = BTreeMap::new();
    for command in text.split("variable create").skip(1) {
        let command = command.split('!').next().unwrap_or_default();
        let value = |name: &str| {
            let (_, rest) = command.split_once(name)?;
            rest.trim_start_matches([' ', '='])
                .split_whitespace()
                .next()
                .map(str::to_owned)
        };
        let number = value("real_value").and_then(|x| x.parse().ok());
        if let (Some(name), Some(x)) = (value("variable_name"), number) {
            all.insert(name, x);
        }
    }
    all
}

/// Design variables set to what they are: all that depends on them is computed anew by its
/// expression, and is what View computed.
#[test]
fn expressions_of_saved_files_give_their_numbers() {
    let mut compared = 0;
    for path in files() {
        let source = dataset::open(&path).expect("a readable file");
        let own = variables(&source.text);
        if own.is_empty() || !source.text.contains("Expression definitions") {
            continue;
        }
        let text = source.text.clone();
        let plain = dataset::read_source(source);
        if plain.failed() {
            continue;
        }
        let file = path.to_string_lossy().into_owned();
        let anew = dataset::read_with(Source::from_text(Some(&file), text), &own);
        assert!(
            errors(&anew.diagnostics).is_empty(),
            "{file}: {:?}",
            errors(&anew.diagnostics)
        );
        let anew: BTreeMap<_, _> = anew.model.statements().into_iter().collect();
        for (id, statement) in plain.model.statements() {
            compared += 1;
            let other = &anew[&id];
            assert!(
                alike(&statement, other),
                "{file}: {statement}\n  is {other}"
            );
        }
    }
    let least = if files().is_empty() { 0 } else { 500 };
    assert!(compared >= least, "{compared} elements");
}
