//! Words of a file among the names of a table: abbreviations, and near numbers.

use crate::diagnostic::near_names;

/// "did you mean 12 or 121" for a number that is not among those known.
pub fn near_ids(id: u32, known: impl Iterator<Item = u32>) -> Option<String> {
    near_numbers(id, &mut { known })
}

fn near_numbers(id: u32, known: &mut dyn Iterator<Item = u32>) -> Option<String> {
    let known: Vec<String> = known.map(|k| k.to_string()).collect();
    let near = near_names(&id.to_string(), known.iter().map(String::as_str));
    (!near.is_empty()).then(|| format!("did you mean {}?", near.join(" or ")))
}

/// The first spelling of a name of the table, in capitals.
pub fn canonical(name: &str) -> String {
    name.split('|').next().unwrap_or(name).to_ascii_uppercase()
}

/// The meaning of a word of a file among the names of the table.
#[derive(Clone, Debug, PartialEq)]
pub enum Meaning {
    /// this one
    One(usize),
    /// an abbreviation of several
    Several(Vec<usize>),
    /// none
    Unknown,
}

/// Which of the names a word means: itself, else the only one it begins, else the first whose
/// shortest form it has.
pub fn meaning<'a>(word: &str, names: impl Iterator<Item = &'a str> + Clone) -> Meaning {
    meaning_among(word, names.enumerate())
}

/// As [`meaning`], of some of the names with their places.
pub(in crate::dataset) fn meaning_among<'a>(
    word: &str,
    names: impl Iterator<Item = (usize, &'a str)> + Clone,
) -> Meaning {
    let word = word.as_bytes();
    let Some(first) = word.first() else {
        return Meaning::Unknown;
    };
    // most words are written in full, and no two names of a table share a spelling
    let is_word = |(_, name): &(usize, &str)| name.as_bytes().eq_ignore_ascii_case(word);
    let whole = (!word.contains(&b'|')).then(|| names.clone().find(is_word));
    if let Some((k, _)) = whole.flatten() {
        return Meaning::One(k);
    }
    let mut begins = Vec::new();
    let mut wins = None;
    for (k, name) in names {
        let mut rest = Some(name.as_bytes());
        while let Some(here) = rest {
            let end = here.iter().position(|&b| b == b'|');
            rest = end.map(|end| &here[end + 1..]);
            // nearly all names begin otherwise
            if !here.first().is_some_and(|b| b.eq_ignore_ascii_case(first)) {
                continue;
            }
            let spelling = &here[..end.unwrap_or(here.len())];
            if spelling.eq_ignore_ascii_case(word) {
                return Meaning::One(k);
            }
            let Some(beginning) = spelling.get(..word.len()) else {
                continue;
            };
            if beginning.eq_ignore_ascii_case(word) {
                if begins.last() != Some(&k) {
                    begins.push(k);
                }
                let capitals = spelling
                    .iter()
                    .take_while(|b| !b.is_ascii_lowercase())
                    .count();
                if capitals < spelling.len() && word.len() >= capitals {
                    wins = wins.or(Some(k));
                }
            }
        }
    }
    match (begins.as_slice(), wins) {
        ([one], _) => Meaning::One(*one),
        ([], _) => Meaning::Unknown,
        (_, Some(k)) => Meaning::One(k),
        _ => Meaning::Several(begins),
    }
}
