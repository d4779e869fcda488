//! The house is as its map says: what `ARCHITECTURE.md` claims about files, floors, rooms and sizes is checked here.

#[path = "house/api.rs"]
mod api;
#[path = "house/codes.rs"]
mod codes;
#[path = "house/constants.rs"]
mod constants;
#[path = "house/packages.rs"]
mod packages;
#[path = "house/pages.rs"]
mod pages;
#[path = "house/sentences.rs"]
mod sentences;
#[path = "house/source.rs"]
mod source;

use source::{File, circles, edges, files, root, sources};
use std::collections::{BTreeMap, BTreeSet};

/// Tables: files whose length is a row per thing they list.
const TABLES: [&str; 1] = ["src/dataset/statement.rs"];
const MOST_LINES_OF_A_FILE: usize = 800;
const MOST_LINES_OF_A_FUNCTION: usize = 80;
const MOST_COLUMNS_OF_A_COMMENT: usize = 100;

fn map() -> String {
    std::fs::read_to_string(root().join("ARCHITECTURE.md")).expect("the map")
}

/// Fails with everything that is wrong, a line each.
fn none(what: &str, wrong: Vec<String>) {
    assert!(
        wrong.is_empty(),
        "{} {what}:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

/// Names in backticks of a page that look like files or folders of the repository.
fn places_named(page: &str) -> Vec<String> {
    let text = std::fs::read_to_string(root().join(page)).expect("a page");
    let inside = text
        .split("```")
        .step_by(2)
        .flat_map(|text| text.split('`').skip(1).step_by(2));
    let is_place = |name: &&str| {
        !name.contains([' ', '(', '*', '<'])
            && (name.ends_with('/')
                || [".rs", ".pest", ".md", ".toml", ".acf"]
                    .iter()
                    .any(|e| name.ends_with(e)))
    };
    inside.filter(is_place).map(str::to_owned).collect()
}

#[test]
fn every_place_that_the_pages_name_exists() {
    let mut missing = Vec::new();
    for page in [
        "ARCHITECTURE.md",
        "docs/decisions.md",
        "tests/README.md",
        "fuzz/README.md",
        "README.md",
    ] {
        let beside = page.rsplit_once('/').map_or("", |(folder, _)| folder);
        for name in places_named(page) {
            // a name alone may be that of any folder; capitals stand for a name
            if !name.contains('/') || name.contains("TARGET") {
                continue;
            }
            let bases = ["", "src", beside];
            if !bases
                .iter()
                .any(|base| root().join(base).join(&name).exists())
            {
                missing.push(format!("{page}: {name}"));
            }
        }
    }
    none("places that do not exist", missing);
}

/// The folders of the tree of rooms, by the indentation of their lines.
fn folders_drawn() -> BTreeSet<String> {
    let map = map();
    let tree = map.split("```").find(|b| b.contains("\nsrc/\n"));
    let mut way: Vec<&str> = Vec::new();
    let mut found = BTreeSet::new();
    for line in tree.expect("a tree of rooms in the map").lines() {
        let name = line.split_whitespace().next().unwrap_or_default();
        if let Some(name) = name.strip_suffix('/') {
            way.truncate((line.len() - line.trim_start().len()) / 2);
            way.push(name);
            found.insert(way.join("/"));
        }
    }
    found
}

#[test]
fn the_map_draws_the_folders_of_the_sources() {
    let mut there = BTreeSet::new();
    for file in sources() {
        let folder = file.path.rsplit_once('/').map_or("", |(folder, _)| folder);
        there.insert(folder.to_owned());
    }
    let drawn = folders_drawn();
    none(
        "folders that are not drawn",
        there.difference(&drawn).cloned().collect(),
    );
    let gone = drawn.into_iter().filter(|f| !root().join(f).is_dir());
    none("folders that are drawn and do not exist", gone.collect());
}

/// The floors of the map: module → floor.
fn floors() -> BTreeMap<String, usize> {
    let map = map();
    let block = map
        .split("```")
        .find(|b| b.starts_with("floors"))
        .expect("a block of floors in the map");
    let mut found = BTreeMap::new();
    let is_module = |name: &&str| {
        let place = root().join("src").join(name);
        place.is_dir() || place.with_extension("rs").is_file()
    };
    for line in block.lines().skip(1) {
        let mut words = line.split_whitespace();
        let Some(floor) = words.next().and_then(|w| w.parse().ok()) else {
            continue;
        };
        found.extend(words.take_while(is_module).map(|m| (m.to_owned(), floor)));
    }
    found
}

#[test]
fn a_module_uses_lower_floors_only() {
    let (floors, files) = (floors(), files("src"));
    let mut wrong = BTreeSet::new();
    for (from, to) in edges(&files) {
        let Some(mine) = files[from].module.first() else {
            continue;
        };
        let Some(floor) = floors.get(mine) else {
            wrong.insert(format!("{mine} stands on no floor"));
            continue;
        };
        for other in to.iter().filter_map(|&t| files[t].module.first()) {
            if other != mine && floors.get(other).is_none_or(|f| f >= floor) {
                wrong.insert(format!("{} uses {other}", files[from].path));
            }
        }
    }
    none(
        "uses of a neighbour or a higher floor",
        wrong.into_iter().collect(),
    );
}

#[test]
fn rooms_of_analysis_form_no_circle() {
    let files = files("src");
    let room = |f: &File| (f.module.first()? == "analysis").then(|| f.module.get(1).cloned())?;
    let mut between: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    let rooms: Vec<Option<String>> = files.iter().map(room).collect();
    for (from, to) in edges(&files) {
        let Some(mine) = &rooms[from] else { continue };
        let others = to.iter().filter_map(|&t| rooms[t].as_deref());
        between
            .entry(mine)
            .or_default()
            .extend(others.filter(|o| o != mine));
    }
    let found = circles(&between);
    none(
        "circles between rooms of analysis",
        found.iter().map(|c| format!("{c:?}")).collect(),
    );
}

/// A module and the files below it count as a data type and its implementation: what a child takes from the files above it is left out.
#[test]
fn files_of_programs_form_no_circle() {
    let files = files("src/expr");
    let mut between = edges(&files);
    for (&from, to) in &mut between {
        to.retain(|&t| !files[t].is_above(&files[from]) && files[t].path.contains("expr/program"));
    }
    between.retain(|&from, _| files[from].path.contains("expr/program"));
    let names = |c: &BTreeSet<usize>| {
        c.iter()
            .map(|&k| files[k].path.as_str())
            .collect::<Vec<_>>()
            .join(" ")
    };
    none(
        "circles between files of expr/program",
        circles(&between).iter().map(names).collect(),
    );
}

#[test]
fn no_file_is_longer_than_800_lines_but_tables() {
    let long =
        |f: &File| f.lines.len() > MOST_LINES_OF_A_FILE && !TABLES.contains(&f.path.as_str());
    let wrong = sources()
        .iter()
        .filter(|f| long(f))
        .map(|f| format!("{}: {}", f.path, f.lines.len()))
        .collect();
    none("files that are too long", wrong);
}

/// The functions of a file: name, first line, number of lines.
fn functions(file: &File) -> Vec<(String, usize, usize)> {
    let lines = &file.lines[..file.n_lines_before_tests];
    let mut found = Vec::new();
    for (k, line) in lines.iter().enumerate() {
        let text = line.trim_start();
        let indent = &line[..line.len() - text.len()];
        let after = ["fn ", "pub fn ", "const fn ", "pub const fn ", "unsafe fn "]
            .iter()
            .find_map(|p| text.strip_prefix(p));
        let after = after.or_else(|| {
            text.strip_prefix("pub(")?
                .split_once(") fn ")
                .map(|(_, a)| a)
        });
        let Some(name) = after.map(|a| a.split(['(', '<']).next().unwrap_or_default()) else {
            continue;
        };
        if text.ends_with(';') || text.ends_with('}') {
            continue;
        }
        let end = lines[k..].iter().position(|l| {
            *l == format!("{indent}}}")
                || (l.starts_with(indent) && l.ends_with(';') && l[indent.len()..].starts_with(')'))
        });
        found.push((name.to_owned(), k + 1, end.unwrap_or(0) + 1));
    }
    found
}

#[test]
fn no_function_is_longer_than_80_lines() {
    let mut wrong = Vec::new();
    for file in sources() {
        for (name, line, n) in functions(&file) {
            if n > MOST_LINES_OF_A_FUNCTION {
                wrong.push(format!("{}:{line} {name}: {n}", file.path));
            }
        }
    }
    none("functions that are too long", wrong);
}

#[test]
fn comments_fit_100_columns() {
    let mut wrong = Vec::new();
    for file in sources() {
        let mut fenced = false;
        for (k, line) in file.lines.iter().enumerate() {
            let text = line.trim_start();
            let fence = text.starts_with("//") && text.contains("```");
            fenced ^= fence;
            // equations, tables and rulers are as wide as they are
            let prose =
                text.starts_with("// ") || text.starts_with("/// ") || text.starts_with("//! ");
            let free = fenced
                || fence
                || text.contains("/ |")
                || text.contains("! |")
                || text.starts_with("// ---");
            if prose && !free && line.chars().count() > MOST_COLUMNS_OF_A_COMMENT {
                wrong.push(format!("{}:{}", file.path, k + 1));
            }
        }
    }
    none("comments that are too wide", wrong);
}

#[test]
fn every_file_opens_by_saying_which_idea_it_is() {
    let silent = |f: &File| !f.lines.first().is_some_and(|l| l.starts_with("//!"));
    none(
        "files without an opening",
        sources()
            .iter()
            .filter(|f| silent(f))
            .map(|f| f.path.clone())
            .collect(),
    );
}

#[test]
fn nothing_public_is_left_without_a_word() {
    let mut wrong = Vec::new();
    for file in sources() {
        let allowed = file
            .lines
            .iter()
            .enumerate()
            .filter(|(_, l)| l.contains("allow(missing_docs"));
        wrong.extend(allowed.map(|(k, _)| format!("{}:{}", file.path, k + 1)));
    }
    none("places that allow missing documentation", wrong);
}

#[test]
fn nothing_outside_tests_panics_by_choice() {
    let mut wrong = Vec::new();
    for file in sources() {
        if file.path.ends_with("/tests.rs") {
            continue;
        }
        for (k, line) in file.code().lines().enumerate() {
            if [
                ".unwrap()",
                ".expect(",
                "panic!(",
                "todo!(",
                "unimplemented!(",
            ]
            .iter()
            .any(|w| line.contains(w))
            {
                wrong.push(format!("{}:{}", file.path, k + 1));
            }
        }
    }
    none("places that could panic", wrong);
}

#[test]
fn the_clock_is_read_in_one_place() {
    // the command line may ask what time it is
    let wrong = files("src").into_iter().filter(|file| {
        let code = file.code();
        file.path != "src/clock.rs"
            && (code.contains("Instant::now") || code.contains("SystemTime"))
    });
    let wrong: Vec<String> = wrong.map(|file| file.path).collect();
    none("files that read a clock of their own", wrong);
}

#[test]
fn files_and_the_environment_are_reached_in_one_place() {
    // the command line is where a user names files
    let doors = ["std::fs", ".exists()", "std::env", "env::var"];
    let wrong = files("src").into_iter().filter(|file| {
        let code = file.code();
        file.path != "src/disk.rs" && doors.iter().any(|door| code.contains(door))
    });
    let wrong: Vec<String> = wrong.map(|file| file.path).collect();
    none(
        "files that reach for files or the environment by themselves",
        wrong,
    );
}

/// Returns whether a line assigns to a field of something named `scene`.
fn assigns_to_scene(line: &str) -> bool {
    line.match_indices("scene.").any(|(at, found)| {
        let path = |c: char| c.is_alphanumeric() || "_.[]()*".contains(c);
        let rest = line[at + found.len()..].trim_start_matches(path);
        let rest = rest.trim_start();
        let rest = rest.trim_start_matches(['+', '-', '*', '/', '|', '&']);
        rest.starts_with('=') && !rest.starts_with("==") && !rest.starts_with("=>")
    })
}

/// Ways to a scene that could be changed: it is shared as `Arc<Scene>`, and decisions about it
/// stand in its `Configuration`.
const CHANGEABLE: [&str; 8] = [
    "&mut Scene",
    "&mut scene.",
    "mut scene: Scene",
    "Scene::default()",
    "(*scene).clone()",
    "Scene::clone(",
    "Arc::make_mut(",
    "Arc::get_mut(",
];

#[test]
fn a_scene_is_changed_nowhere_but_where_it_is_compiled() {
    assert!(assigns_to_scene("        self.scene.rows[r].scale = 1.0;"));
    assert!(assigns_to_scene("scene.layout.n_x += 2;"));
    assert!(!assigns_to_scene("if scene.mode == STATIC {"));
    let mut offences = Vec::new();
    for file in sources() {
        if file.path.starts_with("src/scene/") {
            continue;
        }
        for (k, line) in file.lines.iter().enumerate() {
            let way = CHANGEABLE.iter().any(|way| {
                let after = line.split(way).nth(1).and_then(|rest| rest.chars().next());
                // `&mut SceneSensor` is another type
                line.contains(way)
                    && !after.is_some_and(|c| way.ends_with("Scene") && c.is_alphanumeric())
            });
            if way || assigns_to_scene(line) {
                offences.push(format!("{}:{}: {}", file.path, k + 1, line.trim()));
            }
        }
    }
    none("places that could change a scene", offences);
}

/// Index arithmetic over the row of numbers that programs read, or over the integrator's unknowns.
const INDEX_ARITHMETIC: [&str; 13] = [
    "l.n_q +",
    "layout.n_q +",
    "l.n_q..",
    "layout.n_q..",
    "..l.n_q]",
    "..layout.n_q]",
    ".q().start +",
    ".v().start +",
    ".x().start +",
    ".y().start +",
    ".external().start +",
    "numbers[0]",
    "numbers[1..",
];

#[test]
fn places_of_numbers_are_known_to_the_layout_alone() {
    let mut offences = Vec::new();
    for folder in ["src/scene", "src/analysis", "src/results", "cli/src"] {
        for file in files(folder) {
            if file.path == "src/scene/layout.rs" {
                continue;
            }
            for (k, line) in file.lines.iter().enumerate() {
                if INDEX_ARITHMETIC.iter().any(|way| line.contains(way)) {
                    offences.push(format!("{}:{}: {}", file.path, k + 1, line.trim()));
                }
            }
        }
    }
    none("places of numbers outside the layout", offences);
}

/// Keywords of elements stand in the tables; everywhere else an element is an `ElementId`, which
/// prints itself: no text is compared to find out which element is meant.
#[cfg(feature = "solver")]
#[test]
fn keywords_of_elements_are_compared_nowhere() {
    use cognate::model::ElementKind;
    let compared = |line: &str, keyword: &str| {
        // most lines name none
        if !line.contains(keyword) {
            return false;
        }
        let word = format!("\"{keyword}\"");
        let begins = ["", "/"].map(|end| format!("starts_with(\"{keyword}{end}\")"));
        let begins = begins.iter().any(|begins| line.contains(begins));
        let pairs = ["== ", "!= ", "| "]
            .iter()
            .any(|before| line.contains(&format!("{before}{word}")));
        pairs || line.contains(&format!("{word} =>")) || begins
    };
    assert!(compared("if force.keyword == \"NFORCE\" {", "NFORCE"));
    assert!(compared("\"VFORCE\" => 0..3,", "VFORCE"));
    assert!(!compared(
        "names(ElementKind::Joint, [(\"JOINT\", n)])",
        "JOINT"
    ));
    let tables = ["src/model/element.rs", "src/dataset/statement.rs"];
    let mut offences = Vec::new();
    for file in sources() {
        if tables.contains(&file.path.as_str()) {
            continue;
        }
        for (k, line) in file.lines.iter().enumerate() {
            let compares = ElementKind::ALL
                .iter()
                .any(|kind| compared(line, kind.keyword()));
            if compares || line.contains("(String, u32)") {
                offences.push(format!("{}:{}: {}", file.path, k + 1, line.trim()));
            }
        }
    }
    none("comparisons of keywords", offences);
}

/// Words that ask rather than say: the first of no sentence that documents something.
const QUESTIONS: [&str; 3] = ["What ", "How ", "Whether "];

#[test]
fn docs_begin_with_a_verb_or_with_the_thing() {
    let mut wrong = Vec::new();
    for file in sources() {
        for (k, line) in file.lines.iter().enumerate() {
            let text = line.trim_start();
            let said = ["/// ", "//! "].iter().find_map(|s| text.strip_prefix(s));
            let asks = |said: &str| QUESTIONS.iter().any(|word| said.starts_with(word));
            if said.is_some_and(asks) {
                wrong.push(format!("{}:{}: {text}", file.path, k + 1));
            }
        }
    }
    none("docs that begin with a question", wrong);
}

/// Returns true if a line writes the name of an element by its keyword, as in `"JOINT/{id}"`.
fn names_by_keyword(line: &str) -> bool {
    line.match_indices("/{").any(|(at, _)| {
        let word = line[..at].rsplit(|c: char| !(c.is_ascii_uppercase() || c == '_'));
        word.into_iter().next().is_some_and(|word| word.len() > 2)
    })
}

/// Ways to look into a sentence that the program itself has made.
const READS_SENTENCE: [&str; 12] = [
    ".message.contains(",
    ".message.starts_with(",
    ".message.ends_with(",
    ".message.split",
    ".message.strip_",
    ".message.find(",
    ".message ==",
    ".message !=",
    ".sentence.contains(",
    ".sentence.starts_with(",
    ".to_string().starts_with(",
    ".to_string().contains(",
];

#[test]
fn no_text_is_data() {
    assert!(names_by_keyword("format!(\"JOINT/{id} is driven\")"));
    assert!(names_by_keyword("write!(f, \"of MARKER/{}\")"));
    assert!(!names_by_keyword("format!(\"{a}/{b} mm/{c}\")"));
    let mut wrong = Vec::new();
    for file in sources() {
        if file.path.ends_with("/tests.rs") {
            continue;
        }
        let lines = &file.lines[..file.n_lines_before_tests];
        for (k, line) in lines.iter().enumerate() {
            let reads = READS_SENTENCE.iter().any(|way| line.contains(way));
            let comment = line.trim_start().starts_with("//");
            if !comment && (reads || names_by_keyword(line)) {
                wrong.push(format!("{}:{}: {}", file.path, k + 1, line.trim()));
            }
        }
    }
    none(
        "names written by keyword, or sentences that are read",
        wrong,
    );
}
