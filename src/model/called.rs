//! Elements by what a user calls them: keyword and number, or the name that the dataset gives.

use super::{Element, ElementId, ElementKind, Model};
use crate::diagnostic::{Cause, Diagnostic, Subject, near_names};

/// Numbers, or names, of which none is left out of advice.
const MOST: usize = 12;

impl Model {
    /// Returns the element that a user calls so: `JOINT/3`, its name in the dataset, `1-CONTACT1`,
    /// or `JOINT_3`, as results call an element without a name. Case does not matter in names.
    ///
    /// # Errors
    /// When there is none, with those that are near; when several have the name.
    pub fn find_element(&self, text: &str) -> Result<ElementId, Diagnostic> {
        let text = text.trim();
        let written = text.parse::<ElementId>().ok();
        if let Some(id) = written.filter(|id| self.has(*id)) {
            return Ok(id);
        }
        let elements = self.elements();
        let names = || {
            let name = |(id, element): &(ElementId, _)| name_of(*element).map(|name| (*id, name));
            elements.iter().filter_map(name)
        };
        let called = names().filter(|(_, name)| name.eq_ignore_ascii_case(text));
        let called: Vec<ElementId> = called.map(|(id, _)| id).collect();
        let [] = called[..] else {
            return the_one(text, &called);
        };
        let default = text.rsplit_once('_').and_then(|(keyword, number)| {
            let kind: ElementKind = keyword.parse().ok()?;
            Some(kind.id(number.parse().ok()?))
        });
        if let Some(id) = default.filter(|id| self.has(*id)) {
            return Ok(id);
        }
        if let Some(id) = written.or(default) {
            return Err(self.no_element(id));
        }
        let near = near_names(text, names().map(|(_, name)| name));
        let what = format!("the model has no element `{text}`");
        let d = Diagnostic::error(Cause::UnknownElement, what);
        Err(match near.is_empty() {
            true => d.help("name it as JOINT/3, or by the name that the dataset gives it"),
            false => d.help(format!("did you mean {}?", near.join(" or "))),
        })
    }

    /// Returns the name that the dataset gives to the element that a message is about.
    pub(crate) fn name_of(&self, subject: &Subject) -> Option<&str> {
        let id = subject.element.parse().ok()?;
        self.element(id)?.place().name.as_deref()
    }

    /// Returns the mistake about an element that does not exist, with those that do.
    pub fn no_element(&self, id: ElementId) -> Diagnostic {
        let d = Diagnostic::error(Cause::UnknownElement, format!("{id} does not exist"));
        let numbers: Vec<String> = self
            .numbers(id.kind)
            .iter()
            .map(ToString::to_string)
            .collect();
        if numbers.is_empty() {
            let there = ElementKind::ALL.iter();
            let there = there.filter(|kind| !self.numbers(**kind).is_empty());
            let there: Vec<&str> = there.map(|kind| kind.keyword()).collect();
            return d.help(format!("the model has {}", there.join(", ")));
        }
        let written: Vec<&str> = numbers.iter().map(String::as_str).collect();
        let near = near_names(&id.number.to_string(), written.iter().copied());
        match near.is_empty() || numbers.len() <= MOST {
            true => {
                let first = written[..written.len().min(MOST)].join(", ");
                let more = if numbers.len() > MOST { ", …" } else { "" };
                d.help(format!("{} has {first}{more}", id.kind))
            }
            false => {
                let near = near[0];
                d.help(format!("did you mean {}/{near}?", id.kind))
            }
        }
    }
}

fn name_of(element: &dyn Element) -> Option<&str> {
    element.place().name.as_deref()
}

/// Returns the only one of the elements that have a name.
fn the_one(name: &str, called: &[ElementId]) -> Result<ElementId, Diagnostic> {
    if let [only] = called {
        return Ok(*only);
    }
    let several: Vec<String> = called.iter().take(MOST).map(ToString::to_string).collect();
    let more = if called.len() > MOST { ", …" } else { "" };
    let what = format!("several elements are called `{name}`");
    let advice = format!("say which: {}{more}", several.join(", "));
    Err(Diagnostic::error(Cause::UnknownElement, what).help(advice))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_element_is_found_by_each_of_its_names_and_never_by_that_of_another() {
        let text = "names\nPART/1, GROUND\nMARKER/1, PART=1\n\
            !  adams_view_name='arm'\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\n\
            !  adams_view_name='JOINT_2'\nJOINT/1, REVOLUTE, I=20, J=1\n\
            JOINT/2, FIXED, I=20, J=1\nJOINT/3, FIXED, I=20, J=1\n\
            !  adams_view_name='twice'\nMARKER/30, PART=2\n\
            !  adams_view_name='twice'\nMARKER/31, PART=2\nEND\n";
        let model = Model::from_text(text).unwrap();
        let found = |name: &str| model.find_element(name).map(|id| id.to_string());
        for (name, element) in [
            ("PART/2", "PART/2"),
            ("arm", "PART/2"),
            (" ARM ", "PART/2"),
            ("1-JOINT1", "JOINT/1"),
            ("joint/3", "JOINT/3"),
            // a name comes before what results call the others
            ("JOINT_2", "JOINT/1"),
            ("JOINT_3", "JOINT/3"),
        ] {
            assert_eq!(found(name).as_deref(), Ok(element), "{name}");
        }
        let advice = |name: &str| model.find_element(name).unwrap_err().help.concat();
        assert!(advice("amr").contains("arm"));
        assert!(advice("JOINT/7").contains("1, 2, 3"));
        assert!(advice("JOINT_7").contains("1, 2, 3"));
        assert!(advice("twice").contains("MARKER/30, MARKER/31"));
    }
}
