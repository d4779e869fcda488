//! Packages for a registry: what is compiled, and nothing that only the repository needs.

use super::source::root;
use std::process::Command;

/// The packages, the folder of each, and the folders and files that they may have beside the sources.
const PACKAGES: [(&str, &str, &[&str]); 2] = [
    (
        "cognate",
        ".",
        &[
            "grammar/",
            "examples/",
            "assets/NOTICE.md",
            "assets/viewer.js.gz",
            "assets/viewer.sha256",
            "CHANGELOG.md",
        ],
    ),
    ("cognate-cli", "cli", &["build.rs"]),
];
/// Files of every package; the first is made by cargo.
const EVERYWHERE: [&str; 6] = [
    "Cargo.toml.orig",
    "Cargo.toml",
    "Cargo.lock",
    "README.md",
    "LICENSE-APACHE",
    "LICENSE-MIT",
];
/// A registry takes 10 MB, compressed; sources shrink to a third.
const MOST_BYTES: u64 = 10_000_000;

/// Returns the files of a package, as cargo would pack them.
fn packed(package: &str) -> Vec<String> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
    let done = Command::new(cargo)
        .args([
            "package",
            "--list",
            "--allow-dirty",
            "--offline",
            "-p",
            package,
        ])
        .current_dir(root())
        .output()
        .expect("cargo");
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{package}: {said}");
    let list = String::from_utf8(done.stdout).expect("names");
    let files = list.lines().map(|file| file.replace('\\', "/"));
    // cargo's note about the commit, in a repository
    files
        .filter(|file| file != ".cargo_vcs_info.json")
        .collect()
}

#[test]
fn a_package_has_what_is_compiled_and_no_more() {
    for (package, folder, more) in PACKAGES {
        let files = packed(package);
        let is_known = |file: &String| {
            file.starts_with("src/")
                || EVERYWHERE.contains(&file.as_str())
                || more.iter().any(|place| match place.strip_suffix('/') {
                    Some(_) => file.starts_with(place),
                    None => file == place,
                })
        };
        let odd: Vec<&String> = files.iter().filter(|file| !is_known(file)).collect();
        assert!(odd.is_empty(), "{package}: {odd:?}");
        for needed in EVERYWHERE.iter().chain(more) {
            let is_there = files.iter().any(|file| file.starts_with(needed));
            assert!(is_there, "{package} lacks {needed}");
        }
        let size = |file: &String| {
            let file = root().join(folder).join(file);
            std::fs::metadata(file).map_or(0, |file| file.len())
        };
        let bytes: u64 = files.iter().map(size).sum();
        assert!(bytes < MOST_BYTES, "{package}: {bytes} bytes");
    }
}
