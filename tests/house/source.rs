//! The sources as a graph: which file names which module.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A source file.
pub struct File {
    /// its path from the root of the repository: "src/analysis/time/dynamics.rs"
    pub path: String,
    /// the module it holds, without the crate: ["analysis", "time", "dynamics"]
    pub module: Vec<String>,
    /// its lines
    pub lines: Vec<String>,
    /// the number of lines before its tests
    pub n_lines_before_tests: usize,
}

impl File {
    /// The lines before the tests of the file, comments and texts left out.
    pub fn code(&self) -> String {
        let lines = self.lines.iter().take(self.n_lines_before_tests);
        lines
            .map(|line| without_comment_and_texts(line))
            .collect::<Vec<_>>()
            .join("\n")
    }

    /// Whether the file is the head of a module: `mod.rs`, or a file beside a folder of its name.
    pub fn is_above(&self, other: &File) -> bool {
        other.module.len() > self.module.len() && other.module.starts_with(&self.module)
    }
}

/// All sources: the library's and the command line's.
pub fn sources() -> Vec<File> {
    let mut all = files("src");
    all.extend(files("cli/src"));
    all
}

/// All Rust files below a folder of the repository.
pub fn files(folder: &str) -> Vec<File> {
    let root = root();
    let mut found = Vec::new();
    collect(&root.join(folder), &mut found);
    found.sort();
    found.iter().map(|path| read(&root, path)).collect()
}

/// The root of the repository.
pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder of the repository") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

fn read(root: &Path, path: &Path) -> File {
    let text = std::fs::read_to_string(path).expect("a source file");
    let lines: Vec<String> = text.lines().map(str::to_owned).collect();
    // what is beside the code for tests alone, a module or a field, does not end it
    let begins = |pair: &[String]| pair[0] == "#[cfg(test)]" && pair[1].ends_with('{');
    let tests = lines.windows(2).position(begins);
    let path = path.strip_prefix(root).expect("below the root");
    let mut module: Vec<String> = path
        .with_extension("")
        .components()
        .skip(1)
        .map(|c| c.as_os_str().to_string_lossy().into_owned())
        .collect();
    if matches!(
        module.last().map(String::as_str),
        Some("mod" | "lib" | "main")
    ) {
        module.pop();
    }
    File {
        path: path.to_string_lossy().into_owned(),
        module,
        n_lines_before_tests: tests.unwrap_or(lines.len()),
        lines,
    }
}

/// A line without its comment, and with its texts emptied.
fn without_comment_and_texts(line: &str) -> String {
    let (mut kept, mut inside, mut chars) = (String::new(), false, line.chars().peekable());
    while let Some(c) = chars.next() {
        match c {
            '\\' if inside => {
                chars.next();
            }
            '"' => {
                inside = !inside;
                kept.push(c);
            }
            '/' if !inside && chars.peek() == Some(&'/') => break,
            _ if inside => {}
            _ => kept.push(c),
        }
    }
    kept
}

/// Every path that a file names from the crate's root, as segments.
pub fn paths_named(file: &File) -> BTreeSet<Vec<String>> {
    let code = file.code();
    let mut found = BTreeSet::new();
    for start in ["crate", "super", "self"] {
        for (at, _) in code.match_indices(&format!("{start}::")) {
            let before = code[..at].chars().next_back();
            if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':') {
                continue;
            }
            let mut base = if start == "crate" {
                Vec::new()
            } else {
                file.module.clone()
            };
            if start == "super" {
                base.pop();
            }
            tree(
                &mut code[at + start.len() + 2..].chars().peekable(),
                base,
                &mut found,
            );
        }
    }
    found
}

/// Follows a tree of a `use` or a path in code: `a::b`, `a::{b, c::d}`, `super::a`.
fn tree(
    chars: &mut std::iter::Peekable<std::str::Chars<'_>>,
    mut path: Vec<String>,
    found: &mut BTreeSet<Vec<String>>,
) {
    loop {
        let mut word = String::new();
        while let Some(&c) = chars.peek().filter(|c| c.is_alphanumeric() || **c == '_') {
            word.push(c);
            chars.next();
        }
        match word.as_str() {
            "" => {}
            "super" => {
                path.pop();
            }
            "self" => {}
            _ => path.push(word),
        }
        if chars.peek() == Some(&'{') {
            chars.next();
            group(chars, &path, found);
            return;
        }
        // `::` goes on
        let mut ahead = chars.clone();
        if ahead.next() == Some(':') && ahead.next() == Some(':') {
            chars.nth(1);
        } else {
            found.insert(path);
            return;
        }
    }
}

/// Follows the branches of `{a, b::c}` up to its closing brace.
fn group(
    chars: &mut std::iter::Peekable<std::str::Chars<'_>>,
    path: &[String],
    found: &mut BTreeSet<Vec<String>>,
) {
    while let Some(&c) = chars.peek() {
        match c {
            '}' => {
                chars.next();
                return;
            }
            c if c.is_alphanumeric() || c == '_' => tree(chars, path.to_vec(), found),
            _ => {
                chars.next();
            }
        }
    }
}

/// Which file names which: edges between indices of `files`.
pub fn edges(files: &[File]) -> BTreeMap<usize, BTreeSet<usize>> {
    let by_module: BTreeMap<&[String], usize> = files
        .iter()
        .enumerate()
        .map(|(k, f)| (f.module.as_slice(), k))
        .collect();
    let holder = |path: &[String]| {
        (1..=path.len())
            .rev()
            .find_map(|n| by_module.get(&path[..n]).copied())
    };
    let named = |(k, f): (usize, &File)| {
        let to = paths_named(f).into_iter().filter_map(|p| holder(&p));
        (k, to.filter(|&to| to != k).collect())
    };
    files.iter().enumerate().map(named).collect()
}

/// Groups of nodes that reach each other, each of two or more.
pub fn circles<N: Ord + Copy>(edges: &BTreeMap<N, BTreeSet<N>>) -> Vec<BTreeSet<N>> {
    let reach = |from: N| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
        while let Some(n) = open.pop() {
            for &to in edges.get(&n).into_iter().flatten() {
                if seen.insert(to) {
                    open.push(to);
                }
            }
        }
        seen
    };
    let reached: BTreeMap<N, BTreeSet<N>> = edges.keys().map(|&n| (n, reach(n))).collect();
    let mut found: Vec<BTreeSet<N>> = Vec::new();
    for (&n, to) in &reached {
        if !to.contains(&n) || found.iter().any(|c| c.contains(&n)) {
            continue;
        }
        let both = to.iter().copied();
        found.push(
            both.filter(|m| reached.get(m).is_some_and(|r| r.contains(&n)))
                .collect(),
        );
    }
    found
}
