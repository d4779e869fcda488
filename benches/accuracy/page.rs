//! The page: tables of methods and requests, and the problems whose bars miss.

use crate::samples::Samples;
use crate::{AtRequest, HELD, REQUESTS};
use std::fmt::Write as _;

/// The whole page.
pub fn page(rows: &[&str], found: &[AtRequest]) -> String {
    format!(
        "# Bars of error\n\n\
         Written by `cargo bench --bench accuracy`. `--accuracy` gives every number of the results a bar: the error is to lie within it for 99 of\n\
         100 numbers, and it is to be no more than 30 times the error in the median. Here the bars are beside the errors of problems with known\n\
         solutions (`tests/data/references`), at requests from 1e-{} to 1e-{}. What motions alone move, and what rests, is integrated by no method\n\
         and has rows of its own; a request of STATIC is ERROR and IMBALANCE of EQUILIBRIUM.\n\n\
         An error smaller than the rounding of its number, or than what is known of the solution, counts as that. The cost is the time of the\n\
         further run over that of the run with its set-up: the median, and what nine runs in ten stay below.\n\n{}",
        REQUESTS[0],
        REQUESTS[1],
        tables(rows, found)
    )
}

/// The tables alone.
pub fn tables(rows: &[&str], found: &[AtRequest]) -> String {
    format!(
        "## By method\n\n{}\n## By request\n\nThe share within the bars, and the median of bar over error.\n\n{}\n\
         ## Below {HELD}\n\nProblems of which fewer numbers are within their bars, and by how much bars were too small for 99 %.\n\n{}",
        by_method(rows, found),
        by_request(rows, found),
        missed(found)
    )
}

fn of<'a>(found: &'a [AtRequest], method: &'a str) -> impl Iterator<Item = &'a AtRequest> {
    found.iter().filter(move |at| at.method == method)
}

fn by_method(rows: &[&str], found: &[AtRequest]) -> String {
    let mut text = "| method | numbers | within the bar | bar over error | 99 % need, of the bar | cost |\n|---|---:|---:|---:|---:|---:|\n".to_string();
    for method in rows {
        let mut all = Samples::default();
        of(found, method).for_each(|at| all.add(&at.all));
        if all.count() == 0 {
            continue;
        }
        let [cost, most] = all.cost();
        let _ = writeln!(
            text,
            "| {method} | {} | {:.2} % | {:.1} | {:.2} | {cost:.2} to {most:.2} |",
            all.count(),
            100.0 * all.held(),
            all.width(),
            all.needed()
        );
    }
    text
}

fn by_request(rows: &[&str], found: &[AtRequest]) -> String {
    let mut text = "| method |".to_string();
    let requests = REQUESTS[0]..=REQUESTS[1];
    requests.clone().for_each(|k| {
        let _ = write!(text, " 1e-{k} |");
    });
    text += "\n|---|";
    text += &"---:|".repeat(requests.clone().count());
    text += "\n";
    for method in rows.iter().filter(|m| of(found, m).next().is_some()) {
        let _ = write!(text, "| {method} |");
        for k in requests.clone() {
            let at = of(found, method).find(|at| at.exponent == k);
            let cell = at.filter(|at| at.all.count() > 0).map(|at| {
                let (held, width) = (100.0 * at.all.held(), at.all.width());
                format!(" {held:.1} %, {width:.0}")
            });
            let _ = write!(text, "{} |", cell.unwrap_or_default());
        }
        text += "\n";
    }
    text
}

fn missed(found: &[AtRequest]) -> String {
    let mut text = String::new();
    for at in found {
        for (problem, samples) in &at.missed {
            let _ = writeln!(
                text,
                "- {} at 1e-{}, {problem}: {:.1} % of {}, {:.1} times",
                at.method,
                at.exponent,
                100.0 * samples.held(),
                samples.count(),
                samples.needed()
            );
        }
    }
    if text.is_empty() {
        text += "None.\n";
    }
    text
}
