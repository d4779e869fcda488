//! The numbers that decide: every named constant of analyses, methods and scenes is listed with its reason, and there are
//! never more of them. With BLESS=1 the list is written.

use crate::source::{files, root};

/// How many there are at most. It only ever gets less.
const MOST: usize = 482;

/// Lists the constants that are numbers: place, name, value, comment.
fn listing() -> Vec<String> {
    let mut found = Vec::new();
    for folder in ["src/analysis", "src/numeric", "src/scene"] {
        for file in files(folder) {
            let place = file.path.trim_start_matches("src/");
            // two in a row share their comment
            let (mut comment, mut is_told) = (String::new(), false);
            for line in &file.lines[..file.n_lines_before_tests] {
                let line = line.trim();
                if let Some(more) = line.strip_prefix("///") {
                    if std::mem::take(&mut is_told) {
                        comment.clear();
                    }
                    comment = format!("{comment} {}", more.trim()).trim().to_owned();
                    continue;
                }
                let line = line
                    .strip_prefix("pub ")
                    .or(line.strip_prefix("pub(super) "))
                    .unwrap_or(line);
                let is_number = |kind: &str| {
                    ["f64", "usize", "u32", "u64", "i32", "Duration"]
                        .iter()
                        .any(|k| kind.contains(k))
                };
                if let Some((name, rest)) =
                    line.strip_prefix("const ").and_then(|l| l.split_once(": "))
                    && let Some((kind, value)) = rest.split_once(" = ")
                    && !kind.contains("str")
                    && is_number(kind)
                    && value.contains(|c: char| c.is_ascii_digit())
                {
                    found.push(format!(
                        "{place} {name} = {} // {comment}",
                        value.trim_end_matches(';')
                    ));
                }
                is_told = line.starts_with("const ");
                if !is_told {
                    comment.clear();
                }
            }
        }
    }
    found.sort();
    found
}

#[test]
fn every_number_that_decides_is_listed_with_its_reason_and_there_are_no_more_of_them() {
    let place = root().join("docs/constants.txt");
    let now = listing();
    let text = now.join("\n") + "\n";
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&place, &text).expect("docs can be written");
    }
    let listed = std::fs::read_to_string(&place).unwrap_or_default();
    let new: Vec<&str> = (now.iter().map(String::as_str))
        .filter(|line| !listed.contains(line))
        .collect();
    assert!(
        listed == text,
        "docs/constants.txt is not what the sources hold: BLESS=1 cargo test --test house constants:: writes it\n{}",
        new.join("\n")
    );
    let without: Vec<&String> = now.iter().filter(|line| line.ends_with("// ")).collect();
    assert!(without.is_empty(), "no reason is given: {without:#?}");
    assert!(
        now.len() <= MOST,
        "{} constants, of {MOST}: take one away for each that comes",
        now.len()
    );
}
