//! Sentences of the program: a count agrees with its noun, by one function.

use super::none;
use super::source::root;
use std::path::{Path, PathBuf};

/// Nouns that sentences count.
const NOUNS: &str = " rows inputs points steps warnings markers splines curves values operations equations parts columns \
    numbers arguments texts joints files simulations components entries lines corners directions modes errors triangles \
    results registers statements commands functions choices channels vertices bodies tables freedoms notes mistakes elements \
    parameters outputs words faces ";
/// What may stand between a count and its noun.
const BETWEEN: [&str; 4] = ["more", "other", "further", "redundant"];
/// Before a placeholder: it is one of several counts, of which this one is large or the second of a pair.
const AFTER: [&str; 5] = ["of ", "to ", "than ", "its ", "× "];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// Whether a line of code writes a number before a noun in the plural, whatever the number is.
fn counts_by_hand(line: &str) -> bool {
    let code = line.trim_start();
    if code.starts_with("//") || code.starts_with("assert") || !code.contains('"') {
        return false;
    }
    code.match_indices("} ").any(|(end, _)| {
        let Some(start) = code[..end].rfind('{') else {
            return false;
        };
        let is_placeholder = !code[start..end].contains([' ', '"', '(']);
        let mut words = code[end + 2..].split(|c: char| !c.is_alphabetic());
        let first = words.next().unwrap_or_default();
        let noun = match BETWEEN.contains(&first) {
            true => words.next().unwrap_or_default(),
            false => first,
        };
        let is_noun = !noun.is_empty() && NOUNS.contains(&format!(" {noun} "));
        is_placeholder && is_noun && !AFTER.iter().any(|word| code[..start].ends_with(word))
    })
}

#[test]
fn counts_agree_with_their_nouns_by_one_function() {
    assert!(counts_by_hand("format!(\"{n} inputs are given\")"));
    assert!(counts_by_hand("    \"{} more rows: --all\","));
    assert!(!counts_by_hand(
        "format!(\"{} of {n} inputs\", counted(n, \"row\"))"
    ));
    let mut files = Vec::new();
    for folder in ["src", "cli/src", "c/src", "python/src"] {
        sources(&root().join(folder), &mut files);
    }
    let mut wrong = Vec::new();
    for file in files.iter().filter(|f| !f.ends_with("tests.rs")) {
        let text = std::fs::read_to_string(file).expect("a source");
        // sentences of tests are for ourselves
        let text = text.split("#[cfg(test)]").next().unwrap_or_default();
        let lines = text.lines().enumerate();
        let by_hand = lines.filter(|(_, line)| counts_by_hand(line));
        wrong.extend(
            by_hand.map(|(k, line)| format!("{}:{}: {}", file.display(), k + 1, line.trim())),
        );
    }
    none("counts by hand, in place of diagnostic::counted", wrong);
}
