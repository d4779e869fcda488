//! Elements of one kind that have one name: who calls them by it cannot say which.

use super::*;
use std::collections::HashMap;

/// The name of an element, and what must not have another of that name: its kind, and the body of a
/// marker.
type Named<'a> = (ElementKind, Option<ElementId>, &'a str);

pub(super) fn names_are_used_once(model: &Model, out: &mut Out) {
    let twice = names_twice(model);
    // most models have none
    let labels = (!twice.is_empty()).then(|| model.labels());
    let labels = labels.unwrap_or_default();
    for (first, second) in twice {
        let Some([first_of, second_of]) = pair(model, first, second) else {
            continue;
        };
        let (name, line) = (name_of(model, second).unwrap_or_default(), first_of.line);
        let at = if line > 0 {
            format!(" (line {line})")
        } else {
            String::new()
        };
        let message = format!("{first}{at} is called `{name}`, too");
        warn(out, "name_twice", (second, second_of), message);
        let label = labels.name(model, second);
        match label == name {
            true => advise(out, "each element of a kind needs a name of its own"),
            false => advise(
                out,
                format!("results call this one {label}: give it another name"),
            ),
        }
    }
}

/// Returns the elements that have the name of another of their kind, each behind the first of that
/// name.
pub(crate) fn names_twice(model: &Model) -> Vec<(ElementId, ElementId)> {
    let mut first: HashMap<Named<'_>, ElementId> = HashMap::new();
    let mut found = Vec::new();
    let is_called = |kind: &ElementKind| match kind.family() {
        Family::Body | Family::Constraint | Family::Force | Family::System => true,
        // shapes of different parts may have one name
        Family::Data | Family::Output => *kind == ElementKind::Request,
    };
    for &kind in ElementKind::ALL.iter().filter(|kind| is_called(kind)) {
        for number in model.numbers(kind) {
            let id = kind.id(number);
            let owner = model
                .markers
                .get(&number)
                .filter(|_| kind == ElementKind::Marker);
            let owner = owner.and_then(|marker| marker.owner.body());
            let Some(name) = name_of(model, id) else {
                continue;
            };
            match first.get(&(kind, owner, name)) {
                Some(first) => found.push((*first, id)),
                None => drop(first.insert((kind, owner, name), id)),
            }
        }
    }
    found
}

/// Returns the name by which users and results call an element.
fn name_of(model: &Model, id: ElementId) -> Option<&str> {
    let request = model.requests.get(&id.number);
    let request = request.filter(|_| id.kind == ElementKind::Request);
    let of_results = request.and_then(|request| request.results_name.as_deref());
    let given = || model.element(id)?.place().name.as_deref();
    of_results.or_else(given).filter(|name| !name.is_empty())
}

fn pair(model: &Model, first: ElementId, second: ElementId) -> Option<[&Place; 2]> {
    Some([
        model.element(first)?.place(),
        model.element(second)?.place(),
    ])
}
