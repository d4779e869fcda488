//! Names of elements in results: the name that the dataset gives, or `JOINT_3` where it gives none.
//!
//! Two elements may have one name. The further ones have a number behind it there (`rod`, `rod_2`),
//! so that no set of results has the name of another. Numbers depend on the model alone, not on
//! what is recorded.

use super::{ElementId, ElementKind, Family, Model};
use std::collections::{BTreeMap, HashMap, HashSet};

/// The names of all elements that have sets of results, each once.
#[derive(Clone, Debug, Default)]
pub struct Labels(BTreeMap<ElementId, String>);

impl Labels {
    /// Returns the name of an element: in results, if it has any there; else that of the dataset,
    /// or `MARKER_3`.
    pub fn name(&self, model: &Model, id: ElementId) -> String {
        let known = self.0.get(&id).cloned();
        known.unwrap_or_else(|| model.own_name(id))
    }

    /// Returns the element of a name in results.
    pub(super) fn element(&self, name: &str) -> Option<ElementId> {
        let mut all = self.0.iter();
        let found = all.find(|(_, label)| label.as_str() == name);
        found.map(|(id, _)| *id)
    }
}

impl Model {
    /// Returns the names that elements have in results.
    pub fn labels(&self) -> Labels {
        let (mut labels, mut taken) = (Labels::default(), HashSet::new());
        let mut further = Vec::new();
        for kind in kinds_with_sets() {
            for number in self.numbers(kind) {
                let id = kind.id(number);
                let own = self.own_name(id);
                match take(&own, kind, &mut taken) {
                    true => drop(labels.0.insert(id, own)),
                    false => further.push((id, own)),
                }
            }
        }
        // a name that the dataset gives stays that of its element: numbers come last
        let mut last: HashMap<String, u32> = HashMap::new();
        for (id, own) in further {
            let n = last.entry(own.clone()).or_insert(1);
            let name = loop {
                *n += 1;
                let name = format!("{own}_{n}");
                if take(&name, id.kind, &mut taken) {
                    break name;
                }
            };
            labels.0.insert(id, name);
        }
        labels
    }

    /// Returns the name that the dataset gives to an element, or `KEYWORD_number`; the results of a
    /// REQUEST may have one of their own.
    fn own_name(&self, id: ElementId) -> String {
        let request = self.requests.get(&id.number);
        let request = request.filter(|_| id.kind == ElementKind::Request);
        let of_results = request.and_then(|request| request.results_name.clone());
        let given = || self.element(id)?.place().name.clone();
        let name = of_results.or_else(given).filter(|name| !name.is_empty());
        name.unwrap_or_else(|| format!("{}_{}", id.kind, id.number))
    }
}

/// Returns the kinds of elements that have sets of results. Requests come first: their names are
/// asked for.
fn kinds_with_sets() -> impl Iterator<Item = ElementKind> {
    let asked = [ElementKind::Request, ElementKind::Mrequest];
    let others = ElementKind::ALL.iter().copied().filter(|kind| {
        let has = match kind.family() {
            Family::Body | Family::Constraint | Family::Force | Family::System => true,
            Family::Data | Family::Output => false,
        };
        has && *kind != ElementKind::Marker
    });
    asked.into_iter().chain(others)
}

/// Returns what follows the name of an element in the names of its sets.
fn endings(kind: ElementKind) -> &'static [&'static str] {
    match kind {
        ElementKind::Part | ElementKind::PointMass => {
            &["_XFORM", "_DISPLACEMENT", "_VELOCITY", "_ACCELERATION"]
        }
        ElementKind::Joint => &["", "_VARIABLES"],
        _ => &[""],
    }
}

/// Takes the sets of a name, unless one of them is taken.
fn take(name: &str, kind: ElementKind, taken: &mut HashSet<String>) -> bool {
    let sets: Vec<String> = (endings(kind).iter())
        .map(|ending| format!("{name}{ending}"))
        .collect();
    let is_free = !sets.iter().any(|set| taken.contains(set));
    if is_free {
        taken.extend(sets);
    }
    is_free
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Joint, Motion, Part, Place};

    #[test]
    fn a_further_element_of_one_name_has_a_number_that_no_other_has() {
        let place = |name: &str| Place {
            name: Some(name.to_owned()),
            ..Place::default()
        };
        let mut model = Model::default();
        model.parts.insert(1, Part::default());
        for (number, name) in (2..).zip(["rod", "rod", "rod_2", "Rod"]) {
            let place = place(name);
            let part = Part {
                place,
                ..Part::default()
            };
            model.parts.insert(number, part);
        }
        let joint = Joint {
            place: place("rod"),
            ..Joint::default()
        };
        model.joints.insert(1, joint);
        let motion = Motion {
            place: place("rod"),
            ..Motion::default()
        };
        model.motions.insert(1, motion);
        let labels = model.labels();
        let name = |id: &str| labels.name(&model, id.parse().unwrap());
        let names = [
            "PART/2", "PART/3", "PART/4", "PART/5", "JOINT/1", "MOTION/1",
        ]
        .map(name);
        assert_eq!(names, ["rod", "rod_3", "rod_2", "Rod", "rod", "rod_4"]);
        assert_eq!(labels.name(&model, ElementKind::Part.id(1)), "PART_1");
    }
}
