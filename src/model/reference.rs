//! Who names whom: every number by which one element refers to another, and every FUNCTION, with
//! its owner.

use super::check::references::named;
use super::{ById, ElementId, ElementKind, Family, Formula, Model, Part, Place};
use crate::expr::ast::{Callee, Node};
use crate::expr::measures::Measure;
use std::collections::{BTreeMap, BTreeSet};

/// One element names another.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference<'a> {
    /// the one that names
    pub element: ElementId,
    /// where it stands
    pub place: &'a Place,
    /// the argument
    pub argument: &'static str,
    /// the one that is named
    pub target: ElementId,
}

/// A FUNCTION and its owner.
#[derive(Clone, Debug)]
pub struct Owned<'a> {
    /// the element that holds it
    pub element: ElementId,
    /// where that stands
    pub place: &'a Place,
    /// the argument
    pub argument: &'static str,
    /// the function
    pub formula: &'a Formula,
}

impl Model {
    /// Returns every reference from one element to another. Numbers that were not given (0) are
    /// left out.
    pub fn references(&self) -> Vec<Reference<'_>> {
        self.each_reference().collect()
    }

    /// Goes through the same, one by one.
    pub(crate) fn each_reference(&self) -> impl Iterator<Item = Reference<'_>> {
        self.elements().into_iter().flat_map(|(element, e)| {
            let place = e.place();
            let given = e.references().into_iter().filter(|r| r.1.number != 0);
            given.map(move |(argument, target)| Reference {
                element,
                place,
                argument,
                target,
            })
        })
    }

    /// Returns elements of which a mistake is known, as messages name them, and those that name
    /// data among them: what is found in these may follow from it.
    pub(crate) fn with_readers_of_data(&self, mut mistaken: BTreeSet<String>) -> BTreeSet<String> {
        if mistaken.is_empty() {
            return mistaken;
        }
        let named = |r: &Reference<'_>| {
            r.target.kind.family() == Family::Data && mistaken.contains(&r.target.to_string())
        };
        let all = self.each_reference().filter(named);
        let readers: Vec<String> = all.map(|r| r.element.to_string()).collect();
        mistaken.extend(readers);
        mistaken
    }

    /// Returns every FUNCTION of the model with its owner.
    pub fn formulas(&self) -> Vec<Owned<'_>> {
        let mut all = Vec::new();
        for (element, e) in self.elements() {
            let place = e.place();
            all.extend(e.formulas().into_iter().map(|(argument, formula)| Owned {
                element,
                place,
                argument,
                formula,
            }));
        }
        all
    }

    /// Returns every call of a measure in functions whose first three arguments are numbers: its
    /// function, and these numbers, 0 for those that are left out.
    pub(crate) fn measure_calls(&self) -> Vec<(Owned<'_>, Measure, [u32; 3])> {
        let mut all = Vec::new();
        for owned in self.formulas() {
            let Formula::Expression { text, .. } = owned.formula else {
                continue;
            };
            let Ok(ast) = text.ast() else {
                continue;
            };
            for node in &ast.nodes {
                let Node::Call {
                    callee: Callee::Measure(measure),
                    args,
                } = node
                else {
                    continue;
                };
                // a marker that is not a number is none to be looked for
                let number = |k: usize| match args.get(k).map(|&a| ast.node(a)) {
                    None => Some(0),
                    Some(Node::Number { literal, .. }) => Some(*literal as u32),
                    Some(_) => None,
                };
                if let (Some(i), Some(j), Some(k)) = (number(0), number(1), number(2)) {
                    all.push((owned.clone(), *measure, [i, j, k]));
                }
            }
        }
        all
    }

    /// Returns the elements that name an element, by a number of theirs or in a function, each
    /// once.
    pub fn named_by(&self, id: ElementId) -> Vec<ElementId> {
        self.each_named_by().remove(&id).unwrap_or_default()
    }

    /// Returns of each element that is named the elements that name it, each once.
    pub fn each_named_by(&self) -> BTreeMap<ElementId, Vec<ElementId>> {
        let mut all: BTreeMap<ElementId, Vec<ElementId>> = BTreeMap::new();
        for reference in self.each_reference() {
            all.entry(reference.target)
                .or_default()
                .push(reference.element);
        }
        for owned in self.formulas() {
            let Formula::Expression { text, .. } = owned.formula else {
                continue;
            };
            for (_, target) in text.sound_ast().map(|ast| named(ast)).unwrap_or_default() {
                all.entry(target).or_default().push(owned.element);
            }
        }
        for by in all.values_mut() {
            by.sort_unstable();
            by.dedup();
        }
        all
    }

    /// Returns the data of a part or point mass; `None` when there is none, or the element is no
    /// body.
    pub fn body(&self, id: ElementId) -> Option<&Part> {
        self.bodies_of(id.kind)?.get(&id.number)
    }

    /// Returns all parts, then all point masses, by their numbers.
    pub fn bodies(&self) -> impl Iterator<Item = (ElementId, &Part)> {
        let of = |kind: ElementKind| {
            let list = self.bodies_of(kind).into_iter().flatten();
            list.map(move |(&n, part)| (kind.id(n), part))
        };
        ElementKind::of(Family::Body).flat_map(of)
    }

    fn bodies_of(&self, kind: ElementKind) -> Option<&ById<Part>> {
        let points = (kind == ElementKind::PointMass).then_some(&self.point_masses);
        (kind == ElementKind::Part)
            .then_some(&self.parts)
            .or(points)
    }

    /// Returns the part or point mass a marker is fixed in; `None` for owners that are not solved.
    pub fn body_of(&self, marker: u32) -> Option<ElementId> {
        self.markers.get(&marker)?.owner.body()
    }
}
