//! The scenes of known answer at every request by every method, and long runs: the page `docs/stability.md`.
//!
//! `cargo bench --bench stability`, or `cargo bench --bench stability -- turns`: only scenes whose family or name contains a word, which writes no
//! page. The scenes are those of `tests/stability`; a run that comes out wrong without a word is a finding.

#[path = "../../tests/stability/families/mod.rs"]
mod families;
#[path = "../../tests/stability/laws.rs"]
mod laws;
mod long_runs;
#[path = "../../tests/common/running.rs"]
mod running;
#[path = "../../tests/stability/scene.rs"]
mod scene;

use cognate::analysis::work_limit::ProcessorClock;
use scene::{Claim, Found, Outcome, Scene};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;

const METHODS: [&str; 3] = ["AUTO", "DOP853", "RADAU5"];
/// Exponents of the largest and the smallest request.
const REQUESTS: [i32; 2] = [1, 13];
/// Processor time of one run, in s.
const LIMIT: f64 = 0.1;
/// The request at which costs are told, as an exponent.
const TOLD: i32 = 6;

/// One run of a scene.
struct Cell {
    method: &'static str,
    exponent: i32,
    /// `None`: the run at a larger request has reached its limit
    found: Option<Found>,
    seconds: f64,
}

/// All runs of a scene.
struct Surveyed {
    family: &'static str,
    name: String,
    cells: Vec<Cell>,
}

fn letter(found: Option<&Found>) -> char {
    match found.map(|f| f.outcome) {
        Some(Outcome::Right) => '=',
        Some(Outcome::Stopped) => 's',
        Some(Outcome::Told) => 'p',
        Some(Outcome::Limited) => 't',
        Some(Outcome::Wrong) => 'X',
        None => '.',
    }
}

/// The name of a scene without that of its method.
fn plain(scene: &Scene) -> String {
    let name = scene.name.as_str();
    let method = scene.method.unwrap_or_default();
    name.strip_suffix(method).unwrap_or(name).trim().to_string()
}

fn surveyed(scene: &Scene) -> Surveyed {
    // without integration a method changes nothing
    let integrated = scene.analysis == running::Analysis::Dynamic;
    let is_told = |c: &Claim| matches!(c, Claim::Tells(_));
    // what is told of a method is told of no other
    let own = (scene.method).filter(|_| scene.claims.iter().any(is_told));
    let methods: Vec<&'static str> = match (integrated, own) {
        (_, Some(own)) => vec![own],
        (true, None) => METHODS.to_vec(),
        (false, None) => METHODS[..1].to_vec(),
    };
    let mut cells = Vec::new();
    for method in methods {
        let mut limited = false;
        for exponent in REQUESTS[0]..=REQUESTS[1] {
            let clock = ProcessorClock::start();
            let run = || scene.run_at(10f64.powi(-exponent), Some(method), Some(LIMIT));
            let found = (!limited).then(run);
            limited |= found
                .as_ref()
                .is_some_and(|f| f.outcome == Outcome::Limited);
            cells.push(Cell {
                method,
                exponent,
                found,
                seconds: clock.seconds(),
            });
        }
    }
    Surveyed {
        family: scene.family,
        name: plain(scene),
        cells,
    }
}

impl Surveyed {
    fn of<'a>(&'a self, method: &'a str) -> impl Iterator<Item = &'a Cell> + 'a {
        self.cells.iter().filter(move |c| c.method == method)
    }

    fn letters(&self, method: &str) -> String {
        self.of(method).map(|c| letter(c.found.as_ref())).collect()
    }

    fn wrong(&self) -> impl Iterator<Item = &Cell> {
        let is_wrong = |c: &&Cell| {
            c.found
                .as_ref()
                .is_some_and(|f| f.outcome == Outcome::Wrong)
        };
        self.cells.iter().filter(is_wrong)
    }
}

/// The table of how often what came out, by method.
fn counts(all: &[Surveyed]) -> String {
    let mut text = "| method | right | stopped with a reason | not sure, and told | at its limit | not run | wrong |\n|---|---:|---:|---:|---:|---:|---:|\n".to_string();
    for method in METHODS {
        let mut counts: BTreeMap<char, usize> = BTreeMap::new();
        for cell in all.iter().flat_map(|s| s.of(method)) {
            *counts.entry(letter(cell.found.as_ref())).or_default() += 1;
        }
        let of = |letter| counts.get(&letter).copied().unwrap_or(0);
        let _ = writeln!(
            text,
            "| {method} | {} | {} | {} | {} | {} | {} |",
            of('='),
            of('s'),
            of('p'),
            of('t'),
            of('.'),
            of('X')
        );
    }
    text
}

/// The table of scenes.
fn table(all: &[Surveyed]) -> String {
    let mut text = format!(
        "| family | scene | {} | cost |\n|---|---|{}---|\n",
        METHODS.join(" | "),
        "---|".repeat(METHODS.len())
    );
    for one in all {
        let letters = METHODS.map(|m| match one.letters(m).as_str() {
            "" => String::new(),
            letters => format!("`{letters}`"),
        });
        let told = one.of(METHODS[0]).find(|c| c.exponent == TOLD);
        let cost = told.map_or_else(String::new, |c| {
            let steps = c.found.as_ref().map_or(0, |f| f.steps);
            format!("{steps} steps, {:.0} ms", 1e3 * c.seconds)
        });
        let name = one.name.replace('|', "\\|");
        let _ = writeln!(
            text,
            "| {} | {name} | {} | {cost} |",
            one.family,
            letters.join(" | ")
        );
    }
    text
}

/// The runs that came out wrong, and the reasons for which others stopped.
fn findings(all: &[Surveyed]) -> String {
    let mut text = String::new();
    for one in all {
        let mut methods: BTreeMap<&str, Vec<&Cell>> = BTreeMap::new();
        one.wrong()
            .for_each(|c| methods.entry(c.method).or_default().push(c));
        for (method, cells) in methods {
            let requests: Vec<String> =
                cells.iter().map(|c| format!("1e-{}", c.exponent)).collect();
            // the finest is the worst
            let sentence = cells
                .last()
                .and_then(|c| c.found.as_ref())
                .map_or("", |f| &f.sentence);
            let _ = writeln!(
                text,
                "- {}, *{}*, {method} at {}: {}",
                one.family,
                one.name,
                requests.join(", "),
                shortened(sentence)
            );
        }
    }
    if text.is_empty() {
        text = "None.\n".into();
    }
    text
}

/// The reasons for which runs stopped, with the number of scenes that had each.
fn reasons(all: &[Surveyed]) -> String {
    let mut scenes: BTreeMap<(&str, &str, String), BTreeSet<&str>> = BTreeMap::new();
    for one in all {
        for cell in &one.cells {
            if let Some(found) = cell
                .found
                .as_ref()
                .filter(|f| f.outcome == Outcome::Stopped)
            {
                // numbers differ from run to run
                let said: String = found
                    .sentence
                    .chars()
                    .filter(|c| !c.is_ascii_digit())
                    .collect();
                let key = (one.family, one.name.as_str(), shortened(&said));
                scenes.entry(key).or_default().insert(cell.method);
            }
        }
    }
    let mut text = String::new();
    for ((family, name, said), methods) in scenes {
        let methods: Vec<&str> = methods.into_iter().collect();
        let _ = writeln!(text, "- {family}, *{name}*, {}: {said}", methods.join(", "));
    }
    text
}

fn shortened(sentence: &str) -> String {
    const LONGEST: usize = 160;
    let one_line = sentence.replace('\n', " ").replace('|', "\\|");
    match one_line.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &one_line[..end]),
        None => one_line,
    }
}

fn page(all: &[Surveyed], long: &str) -> String {
    format!(
        "# Stability\n\n\
         Written by `cargo bench --bench stability`. Scenes of known answer (`tests/stability/families`), each run at every request from 1e-{} to 1e-{} by\n\
         every method, with a limit of {LIMIT} s of processor time and 100 000 steps. A run is\n\n\
         - `=` right: as the scene claims; the permitted error of a claim grows in proportion to the request, at least to the request itself, up to the whole\n\
         \x20 swing of the motion,\n\
         - `p` off by more, and warned of: the phase of the swings is not sure, or the energy,\n\
         - `s` stopped or refused with a reason, `t` ended at its limit (finer requests are then not run: `.`),\n\
         - `X` wrong: off by more than that without a word. Each of these is a finding.\n\n\
         The letters of a cell are the requests in falling order. The cost is that of AUTO at 1e-{TOLD}.\n\n{}\n\
         ## Wrong\n\n{}\n## Scenes\n\n{}\n## Long runs\n\n{long}\n## Why runs stopped\n\n\
         Digits are left out, so that runs at different requests stand together.\n\n{}",
        REQUESTS[0],
        REQUESTS[1],
        counts(all),
        findings(all),
        table(all),
        reasons(all)
    )
}

fn main() {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with('-'))
        .collect();
    let chosen = |scene: &Scene| {
        let has = |w: &String| scene.family.contains(w.as_str()) || scene.name.contains(w.as_str());
        words.is_empty() || words.iter().any(has)
    };
    let mut all: Vec<Surveyed> = Vec::new();
    for scene in families::all().iter().filter(|s| chosen(s)) {
        // a scene that is there for several methods is run by all of them anyway
        let name = plain(scene);
        if all
            .iter()
            .any(|s| s.family == scene.family && s.name == name)
        {
            continue;
        }
        let one = surveyed(scene);
        let letters = METHODS.map(|m| one.letters(m));
        println!("{:<14} {:<46} {}", one.family, one.name, letters.join(" "));
        all.push(one);
    }
    println!("{}\n{}", counts(&all), findings(&all));
    if words.is_empty() || words.iter().any(|w| w == "long") {
        let long = long_runs::table();
        println!("{long}");
        if words.is_empty() {
            let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/stability.md");
            std::fs::write(file, page(&all, &long)).expect("the page is written");
        }
    }
}
