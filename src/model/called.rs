//! The one resolver of names: elements by what a user calls them, at every door.
//!
//! | name | is |
//! |---|---|
//! | `JOINT/3`, `1-CONTACT1` | keyword and number |
//! | `3` | the number, where one kind of element is wanted |
//! | `hinge`, `'front axle'` | the name that the dataset gives; in another case if it is the only one |
//! | `JOINT_3`, `rod_2` | the name in results: without a name, or of a further one of a name |
//! | `slider.tip`, `slider.MARKER_41` | a marker by its body and its own name |
//! | `slider.cm` | the marker at the centre of mass, unless another is called so |
//! | `.crank.slider` | a name as Adams View writes it, with or without the name of the model |
//!
//! Names of several elements are mistakes that list them; unknown ones are told with near names.

use super::{ElementId, ElementKind, Labels, Model};
use crate::diagnostic::{Cause, Diagnostic, Subject, near_names};
use std::cell::OnceCell;
use std::collections::BTreeSet;

/// Numbers, or names, of which none is left out of advice.
const MOST: usize = 12;

/// The names of a model, gathered to look several up.
struct Names<'m> {
    model: &'m Model,
    /// kinds that are wanted; none: all
    kinds: &'m [ElementKind],
    labels: OnceCell<Labels>,
}

impl Model {
    /// Returns the element that a user calls so, of whatever kind.
    ///
    /// # Errors
    /// When there is none, with those that are near; when several have the name.
    pub fn find_element(&self, text: &str) -> Result<ElementId, Diagnostic> {
        self.find_of(&[], text)
    }

    /// Returns the element of some kinds that a user calls so; without kinds of any. Where one kind
    /// is wanted its number alone will do.
    ///
    /// # Errors
    /// When there is none, with those that are near; when several have the name; when it is the
    /// name of another kind of element.
    pub fn find_of(&self, kinds: &[ElementKind], text: &str) -> Result<ElementId, Diagnostic> {
        let text = unquoted(text);
        let is_wanted = |id: &ElementId| kinds.is_empty() || kinds.contains(&id.kind);
        let written = text.parse::<ElementId>().ok();
        if let Some(id) = written.filter(|id| self.has(*id)) {
            return match is_wanted(&id) {
                true => Ok(id),
                false => Err(self.other_kind(kinds, text, id)),
            };
        }
        let number = match (kinds, text.parse::<u32>()) {
            ([kind], Ok(number)) => Some(kind.id(number)),
            _ => None,
        };
        if let Some(id) = number.filter(|id| self.has(*id)) {
            return Ok(id);
        }
        let names = self.names_of(kinds);
        let called = names.called(text);
        if let [first, ..] = called[..] {
            return match called.len() {
                1 => Ok(first),
                _ => Err(names.several(text, &called)),
            };
        }
        if let Some(id) = written.or(number).or_else(|| default_name(text)) {
            return Err(self.no_element(id));
        }
        Err(names.unknown(text))
    }

    /// Returns whether an element of some kinds, or several, have a name.
    pub(crate) fn has_name(&self, kinds: &[ElementKind], text: &str) -> bool {
        !self.names_of(kinds).called(unquoted(text)).is_empty()
    }

    fn names_of<'m>(&'m self, kinds: &'m [ElementKind]) -> Names<'m> {
        Names {
            model: self,
            kinds,
            labels: OnceCell::new(),
        }
    }

    /// Says that an element is of another kind than is wanted.
    fn other_kind(&self, kinds: &[ElementKind], text: &str, id: ElementId) -> Diagnostic {
        let what = match text.parse::<ElementId>() {
            Ok(_) => format!("{} is no {}", self.called(id), either(kinds)),
            Err(_) => format!("`{text}` is {id}, no {}", either(kinds)),
        };
        let d = Diagnostic::error(Cause::UnknownElement, what);
        if !kinds.contains(&ElementKind::Marker) {
            return d;
        }
        let own = self.markers_of(id);
        let own: Vec<String> = own
            .iter()
            .take(MOST)
            .map(|n| self.marker_name(*n))
            .collect();
        match own.is_empty() {
            true => d,
            false => d.help(format!("its markers are {}", own.join(", "))),
        }
    }

    /// Returns the numbers of the markers of a body.
    fn markers_of(&self, body: ElementId) -> Vec<u32> {
        let of_body = self
            .markers
            .iter()
            .filter(|(_, m)| m.owner.body() == Some(body));
        of_body.map(|(&n, _)| n).collect()
    }

    /// Returns the name of a marker with that of its body: `slider.tip`.
    fn marker_name(&self, number: u32) -> String {
        let labels = Labels::default();
        let id = ElementKind::Marker.id(number);
        let own = labels.name(self, id);
        let body = self.markers.get(&number).and_then(|m| m.owner.body());
        body.map_or(own.clone(), |body| {
            format!("{}.{own}", labels.name(self, body))
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

impl Names<'_> {
    /// Returns the elements that a text names. A name of Adams View begins with a dot, then with
    /// the name of its model.
    fn called(&self, text: &str) -> Vec<ElementId> {
        let inner = text.strip_prefix('.');
        let within = inner.and_then(|inner| inner.split_once('.'));
        let ways = [Some(text), inner, within.map(|(_, within)| within)];
        let mut found = ways.into_iter().flatten().map(|way| self.as_written(way));
        found.find(|found| !found.is_empty()).unwrap_or_default()
    }

    /// Returns the elements that a text names: the first way of naming that finds any decides.
    fn as_written(&self, text: &str) -> Vec<ElementId> {
        let found = self.by_name(text, &self.wanted());
        if !found.is_empty() {
            return found;
        }
        let is_wanted = |id: &ElementId| self.kinds.is_empty() || self.kinds.contains(&id.kind);
        let of_results = self.labels().element(text);
        let of_results = of_results.or_else(|| default_name(text).filter(|id| self.model.has(*id)));
        match of_results.filter(is_wanted) {
            Some(id) => vec![id],
            None if is_wanted(&ElementKind::Marker.id(0)) => self.markers(text),
            None => Vec::new(),
        }
    }

    /// Returns the names in results, which are gathered when they are first asked for.
    fn labels(&self) -> &Labels {
        self.labels.get_or_init(|| self.model.labels())
    }

    /// Returns the kinds that are wanted.
    fn wanted(&self) -> Vec<ElementKind> {
        match self.kinds.is_empty() {
            true => ElementKind::ALL.to_vec(),
            false => self.kinds.to_vec(),
        }
    }

    /// Returns the elements of some kinds to which the dataset gives a name: those written so, else
    /// those that differ in case.
    fn by_name(&self, text: &str, kinds: &[ElementKind]) -> Vec<ElementId> {
        let folded = text.to_lowercase();
        let (mut exact, mut alike) = (Vec::new(), Vec::new());
        for (id, name) in self.named(kinds) {
            if name == text {
                exact.push(id);
            } else if name.to_lowercase() == folded {
                alike.push(id);
            }
        }
        if exact.is_empty() { alike } else { exact }
    }

    /// Returns the elements of some kinds that have names in the dataset.
    fn named(&self, kinds: &[ElementKind]) -> impl Iterator<Item = (ElementId, &str)> {
        let all = kinds.iter().flat_map(|&kind| {
            let numbers = self.model.numbers(kind).into_iter();
            numbers.map(move |number| kind.id(number))
        });
        let name = |id| self.model.element(id)?.place().name.as_deref();
        let all: Vec<ElementId> = all.collect();
        let all = all.into_iter().filter_map(move |id| Some((id, name(id)?)));
        all.filter(|(_, name)| !name.is_empty())
    }

    /// Returns the markers that a text names by a body and their own names: the body ends at any of
    /// its dots.
    fn markers(&self, text: &str) -> Vec<ElementId> {
        let mut found = BTreeSet::new();
        let bodies: Vec<ElementKind> = ElementKind::of(super::Family::Body)
            .filter(|kind| *kind != ElementKind::Marker)
            .collect();
        let dots = text.match_indices('.').map(|(at, _)| at);
        for at in dots.filter(|at| *at > 0).take(MOST) {
            let (owner, own) = (unquoted(&text[..at]), unquoted(&text[at + 1..]));
            let mut owners = self.by_name(owner, &bodies);
            if owners.is_empty() {
                let id = self.labels().element(owner).or_else(|| default_name(owner));
                let id = id.or_else(|| owner.parse().ok());
                owners.extend(id.filter(|id| bodies.contains(&id.kind) && self.model.has(*id)));
            }
            for body in owners {
                found.extend(self.markers_called(body, own));
            }
        }
        found.into_iter().collect()
    }

    /// Returns the markers of a body that have a name of their own; `cm` is that at the centre of
    /// mass where none has it.
    fn markers_called(&self, body: ElementId, own: &str) -> Vec<ElementId> {
        let id = |n: u32| ElementKind::Marker.id(n);
        let markers = self.model.markers_of(body);
        let name = |n: u32| self.model.markers.get(&n)?.place.name.as_deref();
        let by = |is: &dyn Fn(&str) -> bool| -> Vec<ElementId> {
            let called = markers.iter().filter(|n| name(**n).is_some_and(is));
            called.map(|&n| id(n)).collect()
        };
        let folded = own.to_lowercase();
        let exact = by(&|name| name == own);
        let alike = || by(&|name| name.to_lowercase() == folded);
        let found = if exact.is_empty() { alike() } else { exact };
        if !found.is_empty() {
            return found;
        }
        let written = own.parse().ok().or_else(|| default_name(own));
        let is_own =
            |id: &ElementId| id.kind == ElementKind::Marker && markers.contains(&id.number);
        if let Some(id) = written.filter(is_own) {
            return vec![id];
        }
        let centre = self.model.body(body).and_then(|part| part.cm);
        let centre = centre.filter(|n| folded == "cm" && self.model.markers.contains_key(n));
        centre.map(id).into_iter().collect()
    }

    /// Says that several elements have a name, and how each is told apart.
    fn several(&self, text: &str, called: &[ElementId]) -> Diagnostic {
        let apart = |id: &ElementId| match id.kind {
            ElementKind::Marker => format!("{id} ({})", self.model.marker_name(id.number)),
            _ => match self.labels().name(self.model, *id) {
                label if label == text => id.to_string(),
                label => format!("{id} ({label})"),
            },
        };
        let several: Vec<String> = called.iter().take(MOST).map(apart).collect();
        let more = if called.len() > MOST { ", …" } else { "" };
        let what = format!("several elements are called `{text}`");
        let advice = format!("say which: {}{more}", several.join(", "));
        Diagnostic::error(Cause::UnknownElement, what).help(advice)
    }

    /// Says that no element has a name, with those that are near.
    fn unknown(&self, text: &str) -> Diagnostic {
        let everywhere = self.by_name(text, ElementKind::ALL);
        if let ([id], false) = (&everywhere[..], self.kinds.is_empty()) {
            return self.model.other_kind(self.kinds, text, *id);
        }
        let what = format!("the model has no {} `{text}`", either(self.kinds));
        let d = Diagnostic::error(Cause::UnknownElement, what);
        let wanted = self.wanted();
        let mut known: Vec<String> = self
            .named(&wanted)
            .map(|(_, name)| name.to_owned())
            .collect();
        if wanted.contains(&ElementKind::Marker) && text.contains('.') {
            let with_centre = || self.model.bodies().filter(|(_, part)| part.cm.is_some());
            let centres: BTreeSet<u32> = with_centre().filter_map(|(_, p)| p.cm).collect();
            let others = self.model.markers.keys().filter(|n| !centres.contains(n));
            known.extend(others.map(|&n| self.model.marker_name(n)));
            let body = |id| self.labels().name(self.model, id);
            known.extend(with_centre().map(|(id, _)| format!("{}.cm", body(id))));
        }
        let mut near = near_names(text, known.iter().map(String::as_str));
        let all: Vec<&str> = self.named(ElementKind::ALL).map(|(_, name)| name).collect();
        if near.is_empty() {
            near = near_names(text, all.iter().copied());
        }
        match (near.is_empty(), self.kinds) {
            (false, _) => d.help(format!("did you mean {}?", near.join(" or "))),
            (true, []) => d.help("name it as JOINT/3, or by the name that the dataset gives it"),
            (true, [kind, ..]) => {
                let first = self.model.numbers(*kind).first().copied().unwrap_or(3);
                d.help(format!(
                    "name it as {}, or by the name that the dataset gives it",
                    kind.id(first)
                ))
            }
        }
    }
}

/// Returns the words for one of some kinds: `MARKER`, `PART or JOINT`; `element` for any.
fn either(kinds: &[ElementKind]) -> String {
    match kinds {
        [] => "element".to_owned(),
        kinds if kinds.len() > 4 => "element of these kinds".to_owned(),
        kinds => {
            let words: Vec<&str> = kinds.iter().map(|kind| kind.keyword()).collect();
            words.join(" or ")
        }
    }
}

/// Returns the element of a name that results give where the dataset has none: `JOINT_3`.
fn default_name(text: &str) -> Option<ElementId> {
    let (keyword, number) = text.rsplit_once('_')?;
    let kind: ElementKind = keyword.parse().ok()?;
    Some(kind.id(number.parse().ok()?))
}

/// Returns a name without blanks around it and without its quotation marks.
fn unquoted(text: &str) -> &str {
    let text = text.trim();
    let inner = ['\'', '"'].iter().find_map(|&mark| {
        let inner = text.strip_prefix(mark)?.strip_suffix(mark)?;
        (!inner.contains(mark)).then_some(inner)
    });
    inner.map_or(text, str::trim)
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
            !  adams_view_name='twice'\nMARKER/31, PART=2\n\
            !  adams_view_name='Ärmel'\nMARKER/32, PART=2\nEND\n";
        let model = Model::from_text(text).unwrap();
        let found = |name: &str| model.find_element(name).map(|id| id.to_string());
        for (name, element) in [
            ("PART/2", "PART/2"),
            ("arm", "PART/2"),
            (" ARM ", "PART/2"),
            ("'arm'", "PART/2"),
            (".names.arm", "PART/2"),
            ("1-JOINT1", "JOINT/1"),
            ("joint/3", "JOINT/3"),
            // a name comes before what results call the others
            ("JOINT_2", "JOINT/1"),
            ("JOINT_3", "JOINT/3"),
            ("arm.cm", "MARKER/20"),
            ("PART_2.MARKER_20", "MARKER/20"),
            ("Arm.ärmel", "MARKER/32"),
            ("ÄRMEL", "MARKER/32"),
        ] {
            assert_eq!(found(name).as_deref(), Ok(element), "{name}");
        }
        let advice = |name: &str| model.find_element(name).unwrap_err().help.concat();
        assert!(advice("amr").contains("arm"));
        assert!(advice("JOINT/7").contains("1, 2, 3"));
        assert!(advice("JOINT_7").contains("1, 2, 3"));
        assert!(advice("twice").contains("MARKER/30 (arm.twice), MARKER/31"));
        let marker = |name: &str| model.find_of(&[ElementKind::Marker], name);
        assert_eq!(marker("20").map(|id| id.number), Ok(20));
        let said = marker("arm").unwrap_err().to_string();
        assert!(said.contains("`arm` is PART/2, no MARKER"), "{said}");
        assert!(said.contains("arm.twice"), "{said}");
    }
}
