//! Elements that cost nothing while a model moves: those that no body, constraint, force, equation
//! or sensor reads, directly or through others.

use crate::model::check::references;
use crate::model::{ElementId, ElementKind, Family, Formula, Model};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// The reason why elements take no part in the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Idleness {
    /// no other element reads them
    Unread,
    /// requests and outputs of the plant read them, at outputs
    ReadByResults,
    /// they are drawn, and no contact touches them
    Drawn,
}

impl fmt::Display for Idleness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Idleness::Unread => "nothing reads them",
            Idleness::ReadByResults => "only results read them",
            Idleness::Drawn => "they are only drawn",
        })
    }
}

/// The elements of a kind that take no part in the motion for the same reason.
#[derive(Clone, Debug, PartialEq)]
pub struct Idle {
    /// which statement they are
    pub kind: ElementKind,
    /// why they take no part
    pub why: Idleness,
    /// the elements, ascending
    pub elements: Vec<ElementId>,
}

/// Elements that are named in an [`Idle`] when it is printed.
const MOST_NAMED: usize = 4;

/// Writes "1000 SPLINE: nothing reads them (SPLINE/1, SPLINE/2, …)".
impl fmt::Display for Idle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = self.elements.iter().take(MOST_NAMED);
        let named: Vec<String> = named.map(ElementId::to_string).collect();
        let more = if self.elements.len() > MOST_NAMED {
            ", …"
        } else {
            ""
        };
        let (n, kind) = (self.elements.len(), self.kind);
        let named = named.join(", ");
        write!(f, "{n} {kind}: {} ({named}{more})", self.why)
    }
}

/// Returns the elements of a model that take no part in its motion, by kinds; those that are
/// switched off are not among them.
pub fn idle(model: &Model) -> Vec<Idle> {
    let all = model.elements();
    let mut reads: BTreeMap<ElementId, Vec<ElementId>> = BTreeMap::new();
    for (id, element) in &all {
        let own = reads.entry(*id).or_default();
        own.extend(element.references().into_iter().map(|named| named.1));
        for (_, formula) in element.formulas() {
            own.extend(read_by(formula));
        }
    }
    let on = || all.iter().map(|e| e.0).filter(|&id| model.is_active(id));
    let reached = |from: fn(ElementKind) -> bool| {
        let mut found: BTreeSet<ElementId> = on().filter(|id| from(id.kind)).collect();
        let mut open: Vec<ElementId> = found.iter().copied().collect();
        while let Some(id) = open.pop() {
            let next = reads.get(&id).into_iter().flatten();
            open.extend(next.copied().filter(|&id| found.insert(id)));
        }
        found
    };
    let (moving, shown) = (reached(acts), reached(shows));
    let mut idle: BTreeMap<(ElementKind, Idleness), Vec<ElementId>> = BTreeMap::new();
    for id in on().filter(|id| !moving.contains(id) && !shows(id.kind)) {
        let why = match id.kind {
            ElementKind::Graphics => Idleness::Drawn,
            _ if shown.contains(&id) => Idleness::ReadByResults,
            _ => Idleness::Unread,
        };
        idle.entry((id.kind, why)).or_default().push(id);
    }
    let idle = idle.into_iter();
    idle.map(|((kind, why), elements)| Idle {
        kind,
        why,
        elements,
    })
    .collect()
}

/// Returns the elements that a function names.
fn read_by(formula: &Formula) -> Vec<ElementId> {
    match formula {
        Formula::Expression { text, .. } => match text.sound_ast() {
            Ok(ast) => {
                let named = references::named(ast).into_iter();
                named.map(|(_, id)| id).collect()
            }
            Err(_) => Vec::new(),
        },
        Formula::User { .. } => Vec::new(),
    }
}

/// Returns whether an element of a kind moves others or changes by itself.
fn acts(kind: ElementKind) -> bool {
    match kind.family() {
        Family::Body => kind != ElementKind::Marker,
        Family::Constraint | Family::Force => true,
        Family::System => kind != ElementKind::Variable && !shows(kind),
        Family::Data | Family::Output => false,
    }
}

/// Returns whether an element of a kind asks for results.
fn shows(kind: ElementKind) -> bool {
    matches!(
        kind,
        ElementKind::Request
            | ElementKind::Mrequest
            | ElementKind::Pinput
            | ElementKind::Poutput
            | ElementKind::Femdata
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nothing_reads_is_told_by_kinds() {
        let text = "title\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/10, PART=1\n\
            MARKER/11, PART=1\nMARKER/20, PART=2\nJOINT/1, REVOLUTE, I=20, J=10\n\
            VARIABLE/1, FUNCTION=VARVAL(2)\nVARIABLE/2, FUNCTION=TIME\nVARIABLE/3, FUNCTION=TIME\n\
            SPLINE/7, X=0,1,2,3, Y=0,1,4,9\nREQUEST/1, FUNCTION=VARVAL(3)\\\n\
            SFORCE/1, I=20, J=10, ROTATION, FUNCTION=VARVAL(1)\nEND\n";
        let model = Model::from_text(text).unwrap();
        let told: Vec<String> = idle(&model).iter().map(Idle::to_string).collect();
        assert_eq!(
            told,
            [
                "1 MARKER: nothing reads them (MARKER/11)",
                "1 VARIABLE: only results read them (VARIABLE/3)",
                "1 SPLINE: nothing reads them (SPLINE/7)",
            ]
        );
    }
}
