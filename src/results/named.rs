//! Columns of a run by what a user calls them.
//!
//! | name | is |
//! |---|---|
//! | `rod_XFORM.X`, `dx( 12,21 )` | the column; with other case and blanks if it is the only one |
//! | `crank_bearing.FX`, `'front axle'.FX` | the component of an element, by its name in results |
//! | `JOINT/1.FX`, `1-CONTACT1.FX`, `PART/2_XFORM.X` | the same by keyword and number |
//! | `slider.*`, `*.FX` | all columns of this pattern, or all components of its elements |

use super::{Entity, Run, word_of};
use crate::diagnostic::{Diagnostic, near_names};
use crate::model::{ElementId, ElementKind};
use std::collections::BTreeSet;

/// Names of which none is left out of advice.
const MOST: usize = 12;

impl Run {
    /// Returns the index of the column that a user calls so.
    ///
    /// # Errors
    /// When there is none, with near names; when there are several, which are listed.
    pub fn resolve(&self, name: &str) -> Result<usize, Diagnostic> {
        if let Some(exact) = self.columns.iter().position(|c| c.name == name) {
            return Ok(exact);
        }
        let wanted = plain(name);
        let alike = (0..self.columns.len()).filter(|&c| plain(&self.columns[c].name) == wanted);
        let mut found: Vec<usize> = alike.collect();
        if found.is_empty() {
            found = self.components_called(name);
        }
        match found[..] {
            [] => Err(self.unknown_column(name)),
            [only] => Ok(only),
            _ => Err(self.several(name, &found)),
        }
    }

    /// Returns the index of the column that a user calls so, see [`Run::resolve`]; `None`: there is
    /// none, or there are several.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.resolve(name).ok()
    }

    /// Returns the values of the column with this name.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.find(name).map(|i| self.columns[i].values.as_slice())
    }

    /// Returns the indices of the columns that a user calls so, in their order: one, or with `*`
    /// (any characters) and `?` (any one) all of a pattern but time and bars of error.
    ///
    /// # Errors
    /// As [`Run::resolve`]; a pattern that no column has.
    pub fn resolve_all(&self, name: &str) -> Result<Vec<usize>, Diagnostic> {
        let one = self.resolve(name);
        if one.is_ok() || !name.contains(['*', '?']) {
            return one.map(|column| vec![column]);
        }
        let pattern: Vec<char> = plain(name).chars().collect();
        let is_like = |name: &str| matches(&pattern, &plain(name).chars().collect::<Vec<_>>());
        let shown = |&c: &usize| self.columns[c].bar_of.is_none();
        let columns = (1..self.columns.len()).filter(shown);
        let named: Vec<usize> = columns
            .filter(|&c| is_like(&self.columns[c].name))
            .collect();
        if !named.is_empty() {
            return Ok(named);
        }
        let mut found = BTreeSet::new();
        for set in &self.entities {
            let components = set.components.iter();
            let like = components.filter(|c| is_like(&format!("{}.{}", set.entity, c.name)));
            found.extend(like.map(|c| c.column));
        }
        match found.is_empty() {
            false => Ok(found.into_iter().collect()),
            true => Err(self.unknown_column(name)),
        }
    }

    /// Returns the columns of the components that a text names with their elements.
    fn components_called(&self, text: &str) -> Vec<usize> {
        let mut found = BTreeSet::new();
        for (at, _) in text.rmatch_indices('.').take(MOST) {
            let (element, component) = (unquoted(&text[..at]), plain(&text[at + 1..]));
            for set in self.sets_of(element) {
                let components = set.components.iter();
                let called = components.filter(|c| plain(&c.name) == component);
                found.extend(called.map(|c| c.column));
            }
            if !found.is_empty() {
                return found.into_iter().collect();
            }
        }
        // a table without sets has columns of the same names
        let written = text.rsplit_once('.').and_then(|(element, component)| {
            let (id, ending) = written(unquoted(element))?;
            Some(plain(&format!(
                "{}_{}{ending}.{component}",
                id.kind, id.number
            )))
        });
        let is_it = |c: &usize| Some(plain(&self.columns[*c].name)) == written;
        let columns = 0..self.columns.len();
        columns.filter(|c| written.is_some() && is_it(c)).collect()
    }

    /// Returns the sets of an element: by its name in results, or by keyword and number, with what
    /// follows in the name of one of its sets or without.
    fn sets_of(&self, element: &str) -> Vec<&Entity> {
        let wanted = plain(element);
        let variables = format!("{wanted}_variables");
        let called = |e: &&Entity| {
            let of_joint = e.kind == "Joint_Variables" && plain(&e.name) == variables;
            of_joint || plain(&e.entity) == wanted || plain(&e.name) == wanted
        };
        let called: Vec<&Entity> = self.entities.iter().filter(called).collect();
        if !called.is_empty() {
            return called;
        }
        let Some((id, ending)) = written(element) else {
            return Vec::new();
        };
        let own = format!("{}_{}", id.kind, id.number);
        let of_it = |e: &&Entity| e.id == u64::from(id.number) && is_of_kind(e, id.kind);
        let is_set = |e: &&Entity| {
            let name = e.name.strip_prefix(e.entity.as_str());
            ending.is_empty() || name.is_some_and(|more| plain(more) == plain(ending))
        };
        let all: Vec<&Entity> = self.entities.iter().filter(of_it).filter(is_set).collect();
        // parts and point masses share a word in files
        let default: Vec<&Entity> = all.iter().copied().filter(|e| e.entity == own).collect();
        if default.is_empty() { all } else { default }
    }

    /// Says that a run has no column of a name; the advice lists near names, or all.
    pub fn unknown_column(&self, name: &str) -> Diagnostic {
        let names: Vec<&str> = self.columns.iter().map(|c| c.name.as_str()).collect();
        let component = |column: &&str| {
            let last = column.rsplit_once('.').map(|(_, last)| last);
            let wanted = name.rsplit_once('.').map_or(name, |(_, last)| last);
            last.is_some_and(|last| last.eq_ignore_ascii_case(wanted.trim()))
        };
        let by_element = self.entities.iter().flat_map(|set| {
            let components = set.components.iter();
            components.map(|c| format!("{}.{}", set.entity, c.name))
        });
        let by_element: Vec<String> = by_element.collect();
        let known = names.iter().copied();
        let mut near = near_names(name, known.chain(by_element.iter().map(String::as_str)));
        if near.is_empty() {
            // another element, or none, but this component
            near.extend(names.iter().copied().filter(component).take(3));
        }
        let first = names[..names.len().min(MOST)].join("  ");
        let advice = match (near.is_empty(), names.len()) {
            (false, _) => format!("did you mean {}?", near.join(" or ")),
            (true, n) if n > MOST => format!("columns: {first}  … ({n} in all)"),
            (true, _) => format!("columns: {first}"),
        };
        Diagnostic::error("unknown_column", format!("there is no column `{name}`")).help(advice)
    }

    /// Says that several columns are called so.
    fn several(&self, name: &str, found: &[usize]) -> Diagnostic {
        let names = found
            .iter()
            .take(MOST)
            .map(|&c| self.columns[c].name.as_str());
        let names: Vec<&str> = names.collect();
        let more = if found.len() > MOST { ", …" } else { "" };
        let what = format!("several columns are called `{name}`");
        let advice = format!("say which: {}{more}", names.join(", "));
        Diagnostic::error("unknown_column", what).help(advice)
    }
}

/// Returns whether a set is of an element of a kind.
fn is_of_kind(set: &Entity, kind: ElementKind) -> bool {
    let is = |word: &str| set.kind.eq_ignore_ascii_case(word);
    let further = match kind {
        ElementKind::Part | ElementKind::PointMass => "Body_Motion",
        ElementKind::Joint => "Joint_Variables",
        _ => "",
    };
    is(kind.keyword()) || is(word_of(kind)) || is(further)
}

/// Reads keyword and number of an element, and what follows in the name of one of its sets.
fn written(text: &str) -> Option<(ElementId, &str)> {
    let ends = text.match_indices('_').map(|(at, _)| at);
    let ends = ends.chain([text.len()]).take(MOST);
    let found = ends.filter_map(|end| Some((text.get(..end)?.parse().ok()?, &text[end..])));
    found.last()
}

/// Returns a name without blanks, and without regard to case.
fn plain(name: &str) -> String {
    let kept = name.chars().filter(|c| !c.is_whitespace());
    kept.flat_map(char::to_lowercase).collect()
}

/// Returns a name without quotation marks around it.
fn unquoted(text: &str) -> &str {
    let text = text.trim();
    let within = |mark: char| text.strip_prefix(mark)?.strip_suffix(mark);
    within('\'').or_else(|| within('"')).unwrap_or(text)
}

/// Returns whether a text has a pattern, in which `*` is any characters and `?` any one.
fn matches(pattern: &[char], text: &[char]) -> bool {
    let (mut p, mut t) = (0, 0);
    // behind the last star, and how much of the text it has taken
    let mut star: Option<(usize, usize)> = None;
    while t < text.len() {
        match pattern.get(p) {
            Some('*') => {
                star = Some((p + 1, t));
                p += 1;
            }
            Some(c) if *c == '?' || *c == text[t] => (p, t) = (p + 1, t + 1),
            _ => match &mut star {
                Some((behind, taken)) => {
                    *taken += 1;
                    (p, t) = (*behind, *taken);
                }
                None => return false,
            },
        }
    }
    pattern[p..].iter().all(|c| *c == '*')
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Component, Units};

    /// A run with sets of these names, elements, kinds, numbers and components.
    fn run(sets: &[(&str, &str, &str, u64, &[&str])]) -> Run {
        let mut run = Run::new("r", "", Units::default());
        run.add_column("time", "sec");
        for (name, entity, kind, id, components) in sets {
            let components = components.iter().map(|component| Component {
                name: (*component).to_owned(),
                column: run.add_column(format!("{name}.{component}"), ""),
            });
            let components = components.collect();
            run.entities.push(Entity {
                name: (*name).to_owned(),
                entity: (*entity).to_owned(),
                kind: (*kind).to_owned(),
                id: *id,
                components,
            });
        }
        run
    }

    #[test]
    fn a_column_has_the_names_of_its_element_and_no_other() {
        let mut run = run(&[
            ("rod_XFORM", "rod", "Part", 2, &["X", "VX"]),
            ("rod_DISPLACEMENT", "rod", "Body_Motion", 2, &["X"]),
            ("pin", "pin", "Joint", 4, &["FX"]),
            ("pin_VARIABLES", "pin", "Joint_Variables", 4, &["ANGLE"]),
            ("load", "load", "Single_Component_Force", 3, &["FX"]),
            ("CONTACT_1", "CONTACT_1", "Contact", 1, &["FX"]),
        ]);
        run.add_column("DX(12,21)", "mm");
        let found = |name: &str| run.find(name).map(|c| run.columns[c].name.as_str());
        for (name, column) in [
            ("ROD_xform.X", "rod_XFORM.X"),
            ("rod.VX", "rod_XFORM.VX"),
            ("PART/2.VX", "rod_XFORM.VX"),
            ("PART/2_XFORM.X", "rod_XFORM.X"),
            ("'pin'.fx", "pin.FX"),
            ("JOINT/4.FX", "pin.FX"),
            ("joint/4.angle", "pin_VARIABLES.ANGLE"),
            ("SFORCE/3.FX", "load.FX"),
            ("1-CONTACT1.FX", "CONTACT_1.FX"),
            ("dx( 12, 21 )", "DX(12,21)"),
        ] {
            assert_eq!(found(name), Some(column), "{name}");
        }
        let said = |name: &str| run.resolve(name).unwrap_err().help.concat();
        assert_eq!(said("rod.X"), "say which: rod_XFORM.X, rod_DISPLACEMENT.X");
        assert!(said("pni.FX").contains("pin.FX"));
        assert!(said("DX(12,22)").contains("DX(12,21)"));
        let all = |name: &str| run.resolve_all(name).map(|all| all.len());
        assert_eq!(all("rod.*"), Ok(3));
        assert_eq!(all("*.fx"), Ok(3));
        assert_eq!(all("pin*.?*"), Ok(2));
        assert!(all("q*").is_err());
    }

    #[test]
    fn a_pattern_of_many_stars_ends() {
        let pattern: Vec<char> = "*a".repeat(60).chars().collect();
        let text: Vec<char> = "a".repeat(2000).chars().chain(['b']).collect();
        assert!(!matches(&pattern, &text));
        assert!(matches(&pattern, &text[..2000]));
    }
}
