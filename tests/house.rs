//! The house rules that the compiler cannot see, checked on the text of the sources.

use std::fs;
use std::path::{Path, PathBuf};

/// Returns all Rust files below a folder, sorted by path.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a readable folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
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
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut offences = Vec::new();
    for path in sources(&src) {
        if path.starts_with(src.join("scene")) {
            continue;
        }
        let text = fs::read_to_string(&path).expect("a readable source");
        for (k, line) in text.lines().enumerate() {
            let way = CHANGEABLE.iter().any(|way| {
                let after = line.split(way).nth(1).and_then(|rest| rest.chars().next());
                // `&mut SceneSensor` is another type
                line.contains(way)
                    && !after.is_some_and(|c| way.ends_with("Scene") && c.is_alphanumeric())
            });
            if way || assigns_to_scene(line) {
                offences.push(format!("{}:{}: {}", path.display(), k + 1, line.trim()));
            }
        }
    }
    assert!(offences.is_empty(), "{}", offences.join("\n"));
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
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut offences = Vec::new();
    for folder in ["scene", "analysis", "results", "cli"] {
        for path in sources(&src.join(folder)) {
            if path == src.join("scene").join("layout.rs") {
                continue;
            }
            let text = fs::read_to_string(&path).expect("a readable source");
            for (k, line) in text.lines().enumerate() {
                if INDEX_ARITHMETIC.iter().any(|way| line.contains(way)) {
                    offences.push(format!("{}:{}: {}", path.display(), k + 1, line.trim()));
                }
            }
        }
    }
    assert!(offences.is_empty(), "{}", offences.join("\n"));
}

/// Keywords of elements stand in the tables; everywhere else an element is an `ElementId`, which
/// prints itself: no text is compared to find out which element is meant.
#[cfg(feature = "solver")]
#[test]
fn keywords_of_elements_are_compared_nowhere() {
    use cognate::model::ElementKind;
    let compared = |line: &str, keyword: &str| {
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
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let tables = ["model/element.rs", "dataset/statement.rs"].map(|table| src.join(table));
    let mut offences = Vec::new();
    for path in sources(&src).iter().filter(|path| !tables.contains(path)) {
        let text = fs::read_to_string(path).expect("a readable source");
        for (k, line) in text.lines().enumerate() {
            let compares = ElementKind::ALL
                .iter()
                .any(|kind| compared(line, kind.keyword()));
            if compares || line.contains("(String, u32)") {
                offences.push(format!("{}:{}: {}", path.display(), k + 1, line.trim()));
            }
        }
    }
    assert!(offences.is_empty(), "{}", offences.join("\n"));
}
