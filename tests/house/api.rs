//! The public face of the library as a text: `docs/api.txt` lists what a caller can name, each with its signature, so that a change of
//! it shows in a diff. With BLESS=1 the list is written.
//!
//! It is read off the sources: what is `pub` in a module that a caller reaches, by `pub mod` or by `pub use`. The hidden module
//! `internals`, which promises nothing, is left out.

use super::source::{File, files, root};
use std::collections::{BTreeMap, BTreeSet};

/// A module by its segments, without the crate.
type Path = Vec<String>;

/// An item of a module: a type, function, constant, trait, shown item.
#[derive(Debug)]
struct Item {
    is_public: bool,
    signature: String,
    /// fields, variants, methods of a trait
    members: Vec<String>,
}

/// What the sources say of one module.
#[derive(Debug, Default)]
struct Module {
    items: BTreeMap<String, Item>,
    /// names from elsewhere: where they stand, and whether they are shown
    imports: BTreeMap<String, (Path, bool)>,
    /// modules that are shown as a whole, by `pub use …::*`
    globs: Vec<Path>,
    /// types by their names here, and what is public in their blocks
    methods: Vec<(String, String)>,
}

/// Joins the lines of an item up to the end of its signature; returns it, and the line behind it.
fn signature(lines: &[String], from: usize) -> (String, usize) {
    let mut text = String::new();
    for (k, line) in lines.iter().enumerate().skip(from) {
        let line = line.trim();
        text = format!("{text} {line}");
        let depth =
            |c: [char; 2]| text.matches(c[0]).count() as i64 - text.matches(c[1]).count() as i64;
        let is_open = depth(['(', ')']) > 0 || depth(['[', ']']) > 0;
        let is_use = text.trim_start().contains("use ") && !text.contains(" fn ");
        if line.ends_with(';')
            || line.ends_with('}')
            || !is_open && !is_use && (line.ends_with('{') || line.ends_with(','))
        {
            return (text.trim().to_owned(), k + 1);
        }
    }
    (text.trim().to_owned(), lines.len())
}

/// A signature on one line: without its body, its value, and the blanks of its layout.
fn tidied(signature: &str) -> String {
    let mut depth = 0;
    let is_end = |c: char| {
        depth += i32::from(c == '[') - i32::from(c == ']');
        c == '{' || c == ';' && depth == 0
    };
    let end = signature.find(is_end).unwrap_or(signature.len());
    let kept = signature[..end].trim().trim_end_matches(',');
    let is_valued = ["const ", "static "].iter().any(|w| kept.contains(w)) && !kept.contains("fn ");
    let kept = if is_valued {
        kept.split(" = ").next().unwrap_or(kept)
    } else {
        kept
    };
    let words: Vec<&str> = kept.split_whitespace().collect();
    words
        .join(" ")
        .replace("( ", "(")
        .replace(", )", ")")
        .replace("< ", "<")
        .replace(", >", ">")
}

/// The signature of a tuple struct without fields that nobody else sees.
fn without_private_fields(signature: &str) -> &str {
    match signature.split_once('(') {
        Some((head, fields)) if head.contains("struct ") && !fields.contains("pub ") => head,
        _ => signature,
    }
}

/// The keyword and the name of an item behind its visibility.
fn named(rest: &str) -> Option<(&str, &str)> {
    let mut rest = rest;
    for word in ["unsafe ", "async ", "extern \"C\" "] {
        rest = rest.strip_prefix(word).unwrap_or(rest);
    }
    let rest = if rest.starts_with("const fn ") {
        &rest[6..]
    } else {
        rest
    };
    let (keyword, rest) = rest.split_once(' ')?;
    let known = [
        "struct", "enum", "trait", "fn", "type", "const", "static", "mod", "union",
    ];
    let name = rest
        .split(|c: char| !c.is_alphanumeric() && c != '_')
        .next()?;
    known.contains(&keyword).then_some((keyword, name))
}

/// Unfolds the tree of a `use`: pairs of a name here and the path there.
fn unfolded(tree: &str, before: &[String], found: &mut Vec<(String, Path)>) {
    let tree = tree.trim();
    // behind a last comma
    if tree.is_empty() {
        return;
    }
    let (head, group) = match tree.split_once('{') {
        Some((head, group)) => (head, Some(group.trim_end().trim_end_matches('}'))),
        None => (tree, None),
    };
    let mut path = before.to_vec();
    let (head, alias) = head.split_once(" as ").unwrap_or((head, ""));
    path.extend(
        head.split("::")
            .map(str::trim)
            .filter(|s| !s.is_empty())
            .map(String::from),
    );
    let Some(group) = group else {
        let Some(last) = path.last().cloned() else {
            return;
        };
        if last == "self" {
            path.pop();
        }
        let name = if alias.is_empty() {
            path.last().cloned().unwrap_or_default()
        } else {
            alias.to_owned()
        };
        found.push((name, path));
        return;
    };
    let (mut depth, mut start) = (0, 0);
    for (k, c) in group.char_indices().chain([(group.len(), ',')]) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                unfolded(&group[start..k], &path, found);
                start = k + 1;
            }
            _ => {}
        }
    }
}

/// The path of a `use` from the crate's root; `None`: another crate.
fn from_root(path: &[String], module: &[String], modules: &BTreeSet<Path>) -> Option<Path> {
    let (first, mut rest) = path.split_first()?;
    let mut base = match first.as_str() {
        "crate" => Vec::new(),
        "self" => module.to_vec(),
        "super" => module[..module.len().saturating_sub(1)].to_vec(),
        _ => {
            let below = [module, std::slice::from_ref(first)].concat();
            return modules.contains(&below).then(|| [module, path].concat());
        }
    };
    while rest.first().is_some_and(|s| s == "super") {
        base.pop();
        rest = &rest[1..];
    }
    base.extend(rest.iter().cloned());
    Some(base)
}

/// Reads one source file.
fn read(file: &File, modules: &BTreeSet<Path>) -> (Module, BTreeSet<String>) {
    let code: Vec<String> = file.code().lines().map(String::from).collect();
    let (mut found, mut public_modules) = (Module::default(), BTreeSet::new());
    let (mut k, mut owner): (usize, Option<(String, bool)>) = (0, None);
    while k < code.len() {
        let line = &code[k];
        let depth = line.len() - line.trim_start().len();
        let text = line.trim();
        if depth > 4 || text.is_empty() || text.starts_with('#') {
            k += 1;
            continue;
        }
        if depth == 0 && text == "}" {
            owner = None;
        }
        let (whole, next) = signature(&code, k);
        let shown = whole.strip_prefix("pub ");
        if depth == 0 {
            let bare = whole.split_once(") ").filter(|_| whole.starts_with("pub("));
            let rest = shown.or(bare.map(|b| b.1)).unwrap_or(&whole);
            if let Some(tree) = rest.strip_prefix("use ") {
                let mut names = Vec::new();
                unfolded(tree.trim_end_matches(';'), &[], &mut names);
                for (name, path) in names {
                    if let Some(mut path) = from_root(&path, &file.module, modules) {
                        if name == "*" {
                            path.pop();
                            found.globs.extend(shown.map(|_| path));
                            continue;
                        }
                        found.imports.insert(name, (path, shown.is_some()));
                    }
                }
                k = next;
                continue;
            } else if let Some(head) = text.strip_prefix("impl") {
                let generics = head
                    .starts_with('<')
                    .then(|| head.find('>'))
                    .flatten()
                    .map_or(0, |e| e + 1);
                let of = head[generics..].trim_start();
                let name = of
                    .split(|c: char| !c.is_alphanumeric() && c != '_')
                    .next()
                    .unwrap_or_default();
                owner = (!whole.contains(" for ")).then(|| (name.to_owned(), false));
            } else if let Some((keyword, name)) = named(rest) {
                if keyword == "mod" {
                    if shown.is_some() {
                        public_modules.insert(name.to_owned());
                    }
                } else {
                    let item = Item {
                        is_public: shown.is_some(),
                        signature: tidied(&whole),
                        members: Vec::new(),
                    };
                    found.items.insert(name.to_owned(), item);
                    let is_closed = whole.ends_with(';') || whole.ends_with('}');
                    owner = ["struct", "enum", "trait"]
                        .contains(&keyword)
                        .then(|| (name.to_owned(), true))
                        .filter(|_| !is_closed);
                    k = if is_closed {
                        next
                    } else {
                        k + whole.matches('\n').count() + 1
                    };
                    continue;
                }
            }
        } else if let Some((name, is_own)) = &owner {
            let item = found.items.get_mut(name).filter(|_| *is_own);
            let is_member = depth == 4 && text != "}" && text != "{";
            match item {
                Some(item) if is_member => {
                    let open =
                        item.signature.contains("enum ") || item.signature.contains("trait ");
                    let is_part = shown.is_some() || open && !text.starts_with(['}', ')', ']']);
                    if is_part {
                        item.members.push(tidied(&whole));
                    }
                    k = next.max(k + 1);
                    continue;
                }
                None if shown.is_some() && is_member => {
                    found.methods.push((name.clone(), tidied(&whole)));
                }
                _ => {}
            }
        }
        k += 1;
    }
    (found, public_modules)
}

/// What the sources say of all modules, and which of them each declares as public.
struct Sources {
    modules: BTreeMap<Path, Module>,
    declared: BTreeMap<Path, BTreeSet<String>>,
}

impl Sources {
    fn read() -> Self {
        let sources = files("src");
        let paths: BTreeSet<Path> = sources.iter().map(|f| f.module.clone()).collect();
        let (mut modules, mut declared) = (BTreeMap::new(), BTreeMap::new());
        for file in &sources {
            let (module, below) = read(file, &paths);
            modules.insert(file.module.clone(), module);
            declared.insert(file.module.clone(), below);
        }
        Self { modules, declared }
    }

    /// Returns where a name of a module is defined: through imports.
    fn defined(&self, at: &Path, name: &str) -> Option<(Path, String)> {
        let (mut at, mut name) = (at.clone(), name.to_owned());
        for _ in 0..10 {
            let module = self.modules.get(&at)?;
            if module.items.contains_key(&name) {
                return Some((at, name));
            }
            let Some((path, _)) = module.imports.get(&name) else {
                let is_here = |p: &&Path| self.modules[*p].items.contains_key(&name);
                return Some((module.globs.iter().find(is_here)?.clone(), name));
            };
            let (last, before) = path.split_last()?;
            (at, name) = (before.to_vec(), last.clone());
        }
        None
    }

    /// Returns the modules that a caller reaches, by the paths that the caller writes.
    fn reached(&self) -> BTreeMap<Path, Path> {
        let (mut found, mut next) = (BTreeMap::new(), vec![(Path::new(), Path::new())]);
        while let Some((shown, home)) = next.pop() {
            let below = |path: &Path, name: &str| [path.as_slice(), &[name.to_owned()]].concat();
            for name in self.declared[&home].iter().filter(|n| *n != "internals") {
                next.push((below(&shown, name), below(&home, name)));
            }
            for (name, (path, is_shown)) in &self.modules[&home].imports {
                if *is_shown && self.modules.contains_key(path) {
                    next.push((below(&shown, name), path.clone()));
                }
            }
            found.insert(shown, home);
        }
        found
    }

    /// Returns what a module shows: names, and where they are defined.
    fn shown(&self, home: &Path) -> BTreeMap<String, (Path, String)> {
        let module = &self.modules[home];
        let own = |path: &Path| -> Vec<(String, (Path, String))> {
            let items = self.modules[path].items.iter().filter(|i| i.1.is_public);
            items
                .map(|(name, _)| (name.clone(), (path.clone(), name.clone())))
                .collect()
        };
        let mut entries: BTreeMap<_, _> = own(home).into_iter().collect();
        entries.extend(module.globs.iter().flat_map(own));
        for (name, (_, is_shown)) in &module.imports {
            if let Some(of) = self.defined(home, name).filter(|_| *is_shown) {
                entries.insert(name.clone(), of);
            }
        }
        entries
    }
}

/// The list: modules, and below each what a caller can name there.
fn listing() -> String {
    let sources = Sources::read();
    // blocks of methods, by where their type is defined
    let mut methods: BTreeMap<(Path, String), Vec<String>> = BTreeMap::new();
    for (path, module) in &sources.modules {
        for (name, method) in &module.methods {
            if let Some(of) = sources.defined(path, name) {
                methods.entry(of).or_default().push(method.clone());
            }
        }
    }
    let reached = sources.reached();
    // an item is written where a caller finds it first: in its own module, if that is reached
    let mut written: BTreeMap<(Path, String), Path> = BTreeMap::new();
    for (shown, home) in reached.iter().filter(|(_, home)| !home.is_empty()) {
        for (name, of) in sources.shown(home) {
            let place = [shown.as_slice(), &[name]].concat();
            if of.0 == *home || !written.contains_key(&of) {
                written.insert(of, place);
            }
        }
    }
    let mut text = String::new();
    for (shown, home) in &reached {
        let entries = sources.shown(home);
        if entries.is_empty() {
            continue;
        }
        let path: String = shown.iter().map(|s| format!("::{s}")).collect();
        text += &format!("\ncognate{path}\n");
        for (name, of) in entries {
            let here = [shown.as_slice(), &[name]].concat();
            if let Some(place) = written.get(&of).filter(|place| **place != here) {
                text += &format!("  use {}\n", place.join("::"));
                continue;
            }
            let item = &sources.modules[&of.0].items[&of.1];
            text += &format!("  {}\n", without_private_fields(&item.signature));
            let mut own_methods = methods.get(&of).cloned().unwrap_or_default();
            own_methods.sort();
            for member in item.members.iter().chain(&own_methods) {
                text += &format!("    {member}\n");
            }
        }
    }
    text.trim_start().to_owned()
}

#[test]
fn the_public_face_is_as_listed() {
    let place = root().join("docs/api.txt");
    let now = listing();
    assert!(
        now.contains("pub fn parse(text: &str) -> Result<Self, Error>"),
        "it is read at all"
    );
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&place, &now).expect("docs can be written");
    }
    let listed = std::fs::read_to_string(&place).unwrap_or_default();
    let lines = |text: &str| text.lines().map(String::from).collect::<BTreeSet<_>>();
    let (old, new) = (lines(&listed), lines(&now));
    let gone = old.difference(&new).map(|l| format!("- {l}"));
    let come = new.difference(&old).map(|l| format!("+ {l}"));
    let changes: Vec<String> = gone.chain(come).collect();
    assert!(
        listed == now,
        "the public face is not that of docs/api.txt: BLESS=1 cargo test --test house api:: writes it\n{}",
        changes.join("\n")
    );
}
