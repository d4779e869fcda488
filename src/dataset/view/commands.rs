//! The commands that make a model, with their arguments; and those that only show it.

use std::sync::LazyLock;

/// A command that makes or changes something: its words, `create` standing for `modify` as well,
/// and its arguments, of which the first names what is made.
#[derive(Debug)]
pub(super) struct Row {
    pub words: Vec<&'static str>,
    /// words without the verb
    pub kind: String,
    pub arguments: Vec<&'static str>,
}

/// The commands, a line each: words, a bar, arguments.
const TEXT: &str = include_str!("commands.txt");

pub(super) static COMMANDS: LazyLock<Vec<Row>> = LazyLock::new(|| {
    let lines = TEXT.lines().filter_map(|line| line.split_once(" | "));
    let rows = lines.map(|(words, arguments)| {
        let words: Vec<&str> = words.split(' ').collect();
        let without = words.iter().copied().filter(|word| *word != "create");
        Row {
            kind: without.collect::<Vec<_>>().join(" "),
            words,
            arguments: arguments.split(' ').collect(),
        }
    });
    rows.collect()
});

/// First words of commands that show, ask or set up the program, and make nothing of the model.
const SHOWING: &[&str] = &[
    "analysis",
    "animation",
    "clearance",
    "color",
    "database",
    "entity",
    "fft",
    "filter",
    "graphics",
    "group",
    "hardcopy",
    "help",
    "info",
    "interface",
    "language",
    "library",
    "lights",
    "list_info",
    "numeric_results",
    "optimize",
    "plugin",
    "postprocess",
    "read",
    "results",
    "stop",
    "system",
    "toolbar",
    "undo",
    "view",
    "write",
    "xy_plots",
];

/// First words of commands that may change a model, none of which is read.
const UNREAD: &[&str] = &["acar", "aggregate", "macro", "mdi", "move", "parameter"];

/// Verbs that stand where `create` stands.
const VERBS: &[&str] = &[
    "create",
    "modify",
    "set",
    "delete",
    "attributes",
    "copy",
    "rename",
];

/// The meaning of the words of a command.
#[derive(Debug)]
pub(super) enum Meaning {
    /// a row of the table, and the verb
    Row(&'static Row, &'static str),
    /// it shows something, or sets up the program
    Showing,
    /// attributes or deletion of objects of a kind
    Objects(&'static str),
    /// known to begin a command that makes something, which is not read
    Unread,
    /// no command; words that may be meant
    Unknown(Vec<&'static str>),
}

/// Returns whether a word of a file abbreviates a word of a command.
fn abbreviates(typed: &str, word: &str) -> bool {
    typed.len() <= word.len()
        && word.as_bytes()[..typed.len()].eq_ignore_ascii_case(typed.as_bytes())
}

/// Returns the meaning of the words of a command.
pub(super) fn meaning(typed: &[&str]) -> Meaning {
    let Some(first) = typed.first() else {
        return Meaning::Unknown(Vec::new());
    };
    let heads = COMMANDS.iter().map(|row| row.words[0]);
    let mut heads: Vec<&str> = heads.filter(|word| abbreviates(first, word)).collect();
    heads.dedup();
    if let Some(exact) = heads
        .iter()
        .copied()
        .find(|w| w.eq_ignore_ascii_case(first))
    {
        heads = vec![exact];
    }
    let shows = SHOWING.iter().any(|word| abbreviates(first, word));
    if heads.is_empty() {
        let unread = UNREAD.iter().any(|word| abbreviates(first, word));
        return match shows {
            true => Meaning::Showing,
            false if unread => Meaning::Unread,
            false => {
                let all = COMMANDS.iter().map(|row| row.words[0]);
                let mut near = crate::diagnostic::near_names(first, all);
                near.dedup();
                Meaning::Unknown(near)
            }
        };
    }
    let verb = typed[1..].iter().find_map(|word| {
        let mut verbs = VERBS.iter().copied();
        verbs.find(|verb| abbreviates(word, verb) && word.len() >= 3)
    });
    match verb {
        Some("attributes" | "delete" | "copy" | "rename") => {
            return Meaning::Objects(verb.unwrap_or_default());
        }
        Some("set") if heads[0] == "variable" => {
            return COMMANDS
                .iter()
                .find(|row| row.words[0] == "variable")
                .map_or(Meaning::Unread, |row| Meaning::Row(row, "create"));
        }
        _ => {}
    }
    let of_head = COMMANDS.iter().filter(|row| heads.contains(&row.words[0]));
    let mut left: Vec<&'static Row> = of_head.collect();
    for (k, word) in typed.iter().enumerate().skip(1) {
        let is_verb = |row: &&Row| {
            let there = row.words.get(k).copied();
            let modifies = there == Some("create") && abbreviates(word, "modify");
            modifies || there.is_some_and(|there| abbreviates(word, there))
        };
        let exact = |row: &&'static Row| {
            let there = row.words.get(k);
            there.is_some_and(|there| there.eq_ignore_ascii_case(word))
        };
        left.retain(is_verb);
        if left.iter().any(exact) {
            left.retain(exact);
        }
    }
    left.retain(|row| row.words.len() == typed.len());
    match left.first() {
        Some(row) => {
            let modifies = row
                .words
                .iter()
                .zip(typed)
                .any(|(word, typed)| *word == "create" && abbreviates(typed, "modify"));
            Meaning::Row(row, if modifies { "modify" } else { "create" })
        }
        None if shows || matches!(heads[0], "defaults" | "model" | "file" | "ude") => {
            Meaning::Showing
        }
        None => Meaning::Unread,
    }
}

/// Returns the argument of a command that a name stands for: in full, or its beginning.
///
/// # Errors
/// The arguments that it may be, or those that are near.
pub(super) fn argument(row: &Row, typed: &str) -> Result<&'static str, Vec<&'static str>> {
    let mut all = row.arguments.iter().copied();
    if let Some(exact) = all.clone().find(|a| a.eq_ignore_ascii_case(typed)) {
        return Ok(exact);
    }
    let begun: Vec<&str> = all.clone().filter(|a| abbreviates(typed, a)).collect();
    match begun[..] {
        [one] => Ok(one),
        [] => {
            // a product of inertia in its other order
            let other = [("ixz", "izx"), ("iyx", "ixy"), ("izy", "iyz")];
            let other = other
                .iter()
                .find(|(name, _)| name.eq_ignore_ascii_case(typed));
            if let Some((_, name)) = other.filter(|(_, name)| row.arguments.contains(name)) {
                return Ok(name);
            }
            // plural and singular, and names that older versions had
            let alike = all.find(|a| {
                let short = |x: &str| x.trim_end_matches('s').replace("_name", "");
                short(a).eq_ignore_ascii_case(&short(typed))
            });
            alike.ok_or_else(|| crate::diagnostic::near_names(typed, row.arguments.iter().copied()))
        }
        _ => {
            // `j_marker` of j_marker_name and j_marker_id
            let named = format!("{typed}_name");
            let mut named = begun.iter().filter(|a| a.eq_ignore_ascii_case(&named));
            named.next().copied().ok_or(begun.clone())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kind(words: &str) -> (&'static str, &'static str) {
        let typed: Vec<&str> = words.split(' ').collect();
        match meaning(&typed) {
            Meaning::Row(row, verb) => (row.kind.as_str(), verb),
            other => panic!("{words}: {other:?}"),
        }
    }

    #[test]
    fn words_are_abbreviated_down_the_tree() {
        let mass = "part rigid_body mass_properties";
        assert_eq!(
            kind("part mod rigid_body mass_properties"),
            (mass, "modify")
        );
        assert_eq!(kind("Part cre rigid mass"), (mass, "create"));
        assert_eq!(
            kind("constraint create joint rev"),
            ("constraint joint revolute", "create")
        );
        assert_eq!(kind("geom create shape cyl").0, "geometry shape cylinder");
        assert_eq!(kind("default units").0, "defaults units");
        assert_eq!(kind("variable set"), ("variable", "create"));
        assert_eq!(kind("model create").0, "model");
        assert!(matches!(meaning(&["view", "erase"]), Meaning::Showing));
        assert!(matches!(
            meaning(&["part", "attributes"]),
            Meaning::Objects("attributes")
        ));
        assert!(matches!(
            meaning(&["motion", "create"]),
            Meaning::Unknown(_)
        ));
        assert!(matches!(
            meaning(&["geometry", "create", "shape", "sphere"]),
            Meaning::Unread
        ));
    }

    #[test]
    fn arguments_are_abbreviated_where_one_is_meant() {
        let typed: Vec<&str> = "marker create".split(' ').collect();
        let Meaning::Row(row, _) = meaning(&typed) else {
            panic!("a command");
        };
        assert_eq!(argument(row, "marker"), Ok("marker_name"));
        assert_eq!(argument(row, "LOC"), Ok("location"));
        assert!(argument(row, "place").is_err());
    }
}
