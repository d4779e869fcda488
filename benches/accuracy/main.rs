//! Bars of error against reference solutions: how many errors lie within their bar, how much wider bars are, and what
//! they cost. It writes the page `docs/accuracy.md`.
//!
//! `cargo bench --bench accuracy`, or `cargo bench --bench accuracy -- RADAU5 bounce`: only methods and problems that
//! contain a word, which writes no page but tells every problem at every request. LIMIT=seconds of processor time
//! after which a run is left out (4), and those of the problem at smaller requests with it.
//!
//! SENTENCES=1: not bars, but what a run says of itself by default is compared, with the error that 19 of 20 numbers of a column have;
//! such samples are columns, and the cost is over that of solving.
//!
//! Every problem of `tests/data/references` is run at requests 1e-3 … 1e-10 by every method, with `accuracy`:
//! integrations by all methods, what motions alone move and what rests by their own.

mod page;
mod problems;
#[path = "../../tests/common/requests.rs"]
mod requests;
mod samples;

use cognate::analysis::work_limit::ProcessorClock;
use cognate::numeric::METHODS;
use problems::{Kind, Problem};
use samples::Samples;
use std::collections::BTreeSet;

/// Exponents of the largest and the smallest request.
const REQUESTS: [i32; 2] = [3, 10];
/// Processor time of a run with its bars, in s, when LIMIT does not say.
const LIMIT: f64 = 4.0;
/// Share of errors that are to lie within their bars.
const HELD: f64 = 0.99;

/// The samples of a method at one request.
struct AtRequest {
    method: String,
    exponent: i32,
    all: Samples,
    /// problems of which fewer errors than [`HELD`] lie within their bars, with their samples
    missed: Vec<(String, Samples)>,
}

/// The methods of a kind of analysis, as their rows are named.
fn methods_of(kind: Kind) -> Vec<&'static str> {
    match kind {
        Kind::Integrated => std::iter::once("AUTO")
            .chain(METHODS.iter().map(|m| m.name))
            .collect(),
        Kind::Kinematic => vec!["KINEMATIC"],
        Kind::Static => vec!["STATIC"],
    }
}

fn main() {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with('-'))
        .collect();
    let limit = std::env::var("LIMIT").ok().and_then(|l| l.parse().ok());
    let limit = limit.unwrap_or(LIMIT);
    let problems = problems::all();
    let rows = Kind::ALL.into_iter().flat_map(methods_of);
    let rows: Vec<&str> = rows.collect();
    let asked = |row: &str| {
        let named = |w: &String| rows.contains(&w.as_str());
        !words.iter().any(named) || words.iter().any(|w| w == row)
    };
    let chosen: Vec<&str> = words
        .iter()
        .map(String::as_str)
        .filter(|w| !rows.contains(w))
        .collect();
    let mut found = Vec::new();
    for kind in Kind::ALL {
        let of_kind: Vec<&Problem> = problems
            .iter()
            .filter(|p| p.kind == kind)
            .filter(|p| chosen.is_empty() || chosen.iter().any(|w| p.name.contains(w)))
            .collect();
        for method in methods_of(kind).into_iter().filter(|m| asked(m)) {
            found.extend(surveyed(&of_kind, method, limit, !words.is_empty()));
        }
    }
    println!("{}", page::tables(&rows, &found));
    if words.is_empty() && std::env::var_os("SENTENCES").is_none() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/accuracy.md");
        std::fs::write(file, page::page(&rows, &found)).expect("the page is written");
        println!("docs/accuracy.md");
    }
}

/// Runs problems by a method at all requests; `told`: each of them is told.
fn surveyed(problems: &[&Problem], method: &str, limit: f64, told: bool) -> Vec<AtRequest> {
    let mut given_up = BTreeSet::new();
    let mut all = Vec::new();
    for exponent in REQUESTS[0]..=REQUESTS[1] {
        let mut at = AtRequest {
            method: method.to_string(),
            exponent,
            all: Samples::default(),
            missed: Vec::new(),
        };
        for problem in problems {
            if given_up.contains(&problem.name) {
                continue;
            }
            let clock = ProcessorClock::start();
            let request = 10_f64.powi(-exponent);
            let samples = match std::env::var_os("SENTENCES") {
                Some(_) => problem.sentences(method, request, limit),
                None => problem.samples(method, request, limit),
            };
            let Some(samples) = samples else {
                println!("{method:8} {:18} given up at 1e-{exponent}", problem.name);
                given_up.insert(&problem.name);
                continue;
            };
            if told {
                let name = format!("{} 1e-{exponent}", problem.name);
                println!("{method:8} {name:22} {}", samples.line());
            }
            if clock.seconds() > limit {
                given_up.insert(&problem.name);
            }
            at.all.add(&samples);
            if samples.held() < HELD {
                at.missed.push((problem.name.clone(), samples));
            }
        }
        println!(
            "{method:8} {:22} {}",
            format!("all at 1e-{exponent}"),
            at.all.line()
        );
        all.push(at);
    }
    all
}
