//! When two models say the same.

use cognate::model::Model;

/// What a model says, without the places it was read from and without blanks in expressions.
pub fn meaning(model: &Model) -> String {
    let mut out = String::new();
    let mut inside_breaks = false;
    for line in format!("{model:#?}").lines().map(str::trim) {
        match line {
            "breaks: [" => inside_breaks = true,
            "]," if inside_breaks => inside_breaks = false,
            _ if inside_breaks => {}
            _ if line.starts_with("line: ")
                || line.starts_with("column: ")
                || line == "breaks: []," => {}
            _ if line.starts_with("text: ") => {
                out.extend(line.chars().filter(|c| *c != ' ').chain(['\n']))
            }
            _ => out.extend(line.chars().chain(['\n'])),
        }
    }
    out
}

/// The first line in which two texts differ.
pub fn difference(a: &str, b: &str) -> String {
    let differ = a
        .lines()
        .zip(b.lines())
        .enumerate()
        .find(|(_, (a, b))| a != b);
    differ.map_or_else(
        || format!("{} and {} lines", a.lines().count(), b.lines().count()),
        |(k, (a, b))| format!("line {}: {a:?} and {b:?}", k + 1),
    )
}
