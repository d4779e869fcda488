//! The last of the test targets: says how many tests were left out, and for want of what (`tests/common/needs.rs`).

#[path = "../common/needs.rs"]
#[allow(dead_code, reason = "this target only reads")]
mod needs;

use std::collections::BTreeMap;

fn main() {
    if std::env::args().any(|argument| argument == "--list") {
        return;
    }
    let mut left_out: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let files = std::fs::read_dir(needs::folder()).into_iter().flatten();
    for file in files.flatten() {
        let text = std::fs::read_to_string(file.path()).unwrap_or_default();
        if let Some((what, test)) = text.trim_end().split_once('\t') {
            left_out.entry(what.into()).or_default().push(test.into());
        }
    }
    let count = |n: usize| match n {
        0 => "no test was left out".to_owned(),
        1 => "1 test was left out".to_owned(),
        n => format!("{n} tests were left out"),
    };
    println!("\n{}", count(left_out.values().map(Vec::len).sum()));
    for (what, mut tests) in left_out {
        tests.sort();
        println!("  without {what}: {}", tests.len());
        for test in tests {
            println!("    {test}");
        }
    }
    println!();
}
