//! `cognate explain CODE` knows every code that a diagnostic of the program can carry.

use super::source::sources;
use cognate::diagnostic::codes::all;
use std::collections::{BTreeMap, BTreeSet};

/// Functions and methods whose first text is a code.
const GIVERS: [&str; 10] = [
    "Diagnostic::error(",
    "Diagnostic::warning(",
    "Fault::new(",
    "Problem::new(",
    "error(",
    "warning(",
    "warn(",
    "fail(",
    "refuse(",
    "trouble(",
];

/// The codes that a source text names, each with what stands before it.
fn codes_in(source: &str) -> Vec<String> {
    // the tests at the end of a file name codes that they make up
    let source = source
        .split("#[cfg(test)]\nmod tests")
        .next()
        .unwrap_or(source);
    let mut found = Vec::new();
    for (at, _) in source.match_indices("code: \"") {
        found.extend(word(&source[at + 6..]));
    }
    // families of reasons and warnings give theirs in a method
    for (at, _) in source.match_indices("fn code(") {
        let body = source[at..].split("\n    }").next().unwrap_or_default();
        for arm in body.split("=> ").skip(1) {
            found.extend(word(arm));
        }
    }
    for giver in GIVERS {
        for (at, _) in source.match_indices(giver) {
            let mut rest = source[at + giver.len()..].trim_start();
            // arguments before the code: names of variables
            while let Some((first, more)) = rest.split_once(',')
                && !first.is_empty()
                && first
                    .chars()
                    .all(|c| c.is_ascii_lowercase() || "_.&".contains(c))
            {
                rest = more.trim_start();
            }
            found.extend(word(rest));
        }
    }
    found
}

/// A text in quotes that looks like a code.
fn word(rest: &str) -> Option<String> {
    let (word, _) = rest.strip_prefix('"')?.split_once('"')?;
    let looks_so = !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c == '_');
    looks_so.then(|| word.to_owned())
}

#[test]
fn every_code_in_the_sources_is_explained() {
    let explained: BTreeSet<&str> = all().map(|c| c.name).collect();
    let mut missing: BTreeMap<String, String> = BTreeMap::new();
    let mut named = BTreeSet::new();
    for file in sources() {
        for code in codes_in(&file.lines.join("\n")) {
            if !explained.contains(code.as_str()) {
                missing.insert(code.clone(), file.path.clone());
            }
            named.insert(code);
        }
    }
    assert!(
        missing.is_empty(),
        "give these a text in src/diagnostic/codes: {missing:#?}"
    );
    // the search itself works: it meets most of the table
    assert!(
        2 * named.len() > explained.len(),
        "only {} codes found",
        named.len()
    );
}

#[test]
fn codes_are_explained_once_with_reason_and_example() {
    let mut names = BTreeSet::new();
    for code in all() {
        assert!(names.insert(code.name), "{} stands twice", code.name);
        assert!(
            !code.summary.is_empty() && !code.explanation.is_empty(),
            "{}",
            code.name
        );
        let example = code.explanation.lines().any(|l| l.starts_with("    "));
        assert!(example, "{}: an example, indented, is missing", code.name);
        assert!(
            code.explanation.lines().all(|l| l.chars().count() <= 160),
            "{}",
            code.name
        );
    }
}

/// What decides something is a value of a type (`Cause`, `FaultKind`), not a text that is compared.
#[test]
fn no_code_is_compared_as_text() {
    let mut compared = Vec::new();
    for file in sources() {
        // instructions have codes, too
        if file.module.iter().any(|name| name == "program") {
            continue;
        }
        let source = file.lines.join("\n");
        let source = source
            .split("#[cfg(test)]\nmod tests")
            .next()
            .unwrap_or_default();
        for line in source.lines().filter(|l| !l.trim_start().starts_with("//")) {
            let compares = [".code == \"", ".code != \"", ".contains(&d.code)"];
            let matches = line.contains("match ") && line.trim_end().ends_with(".code {");
            if matches || compares.iter().any(|c| line.contains(c)) {
                compared.push(format!("{}: {}", file.path, line.trim()));
            }
        }
    }
    assert!(compared.is_empty(), "{compared:#?}");
}
