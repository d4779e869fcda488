//! MREQUEST as the requests that it stands for: of a part at its centre of mass, of a joint,
//! primitive or force at I against J.

use super::{ElementId, ElementKind, Family, ManyRequests, Model, Quantity, RequestKind};

/// The arguments of MREQUEST that list elements.
const LISTS: [&str; 4] = ["PARTS", "JOINTS", "JPRIMS", "APPFORS"];

impl ManyRequests {
    /// Returns the requests that it stands for, with their elements.
    pub fn requests(&self, model: &Model) -> Vec<(ElementId, RequestKind)> {
        let words = LISTS.into_iter().flat_map(|list| {
            let words = self.words(list).iter();
            words.map(move |word| (list, word))
        });
        words
            .flat_map(|(list, word)| self.asked(model, list, word))
            .collect()
    }

    /// Returns those words of its lists that name nothing that can be asked, with their arguments.
    pub fn idle_words(&self, model: &Model) -> Vec<(&'static str, &str)> {
        let words = LISTS.into_iter().flat_map(|list| {
            let words = self.words(list).iter();
            words.map(move |word| (list, word.as_str()))
        });
        words
            .filter(|(list, word)| self.asked(model, list, word).is_empty())
            .collect()
    }

    fn words(&self, list: &str) -> &[String] {
        match list {
            "PARTS" => &self.parts,
            "JOINTS" => &self.joints,
            "JPRIMS" => &self.primitives,
            _ => &self.forces,
        }
    }

    /// Returns the requests that a word of a list stands for: ALL, a number or `SFORCE/3`.
    fn asked(&self, model: &Model, list: &str, word: &str) -> Vec<(ElementId, RequestKind)> {
        let kinds: Vec<ElementKind> = match list {
            "PARTS" => vec![ElementKind::Part, ElementKind::PointMass],
            "JOINTS" => vec![ElementKind::Joint],
            "JPRIMS" => vec![ElementKind::Jprim],
            _ => ElementKind::of(Family::Force).collect(),
        };
        let of_kind = |kind: ElementKind| {
            let numbers = model.numbers(kind).into_iter();
            numbers.map(move |n| kind.id(n))
        };
        let is_meant = |id: &ElementId| match word.parse::<u32>() {
            Ok(n) => id.number == n,
            Err(_) => word.eq_ignore_ascii_case("ALL") || word.parse() == Ok(*id),
        };
        let all = kinds.into_iter().flat_map(of_kind).filter(is_meant);
        all.filter_map(|id| Some((id, self.of(markers(model, id)?))))
            .collect()
    }

    /// Returns the request of its quantity at markers I and J.
    fn of(&self, (i, j): (u32, Option<u32>)) -> RequestKind {
        let rm = self.rm;
        match self.quantity {
            Quantity::Displacement => RequestKind::Displacement { i, j, rm },
            Quantity::Velocity => RequestKind::Velocity { i, j, rm },
            Quantity::Acceleration => RequestKind::Acceleration { i, j, rm },
            Quantity::Force => RequestKind::Force { i, j, rm },
        }
    }
}

/// Returns the markers at which an element is asked: I, and J where there is one.
fn markers(model: &Model, element: ElementId) -> Option<(u32, Option<u32>)> {
    let n = element.number;
    if element.kind.family() == Family::Body {
        let mut bodies = model.bodies();
        let (_, body) = bodies.find(|(id, body)| *id == element && !body.ground)?;
        return Some((body.cm?, None));
    }
    let vector = match element.kind {
        ElementKind::Vforce => model.vforces.get(&n),
        ElementKind::Vtorque => model.vtorques.get(&n),
        ElementKind::Gforce => model.gforces.get(&n),
        _ => None,
    };
    if let Some(vector) = vector {
        return Some((vector.i, vector.jfloat));
    }
    let single = (element.kind == ElementKind::Sforce).then(|| model.sforces.get(&n));
    if let Some(single) = single.flatten() {
        return Some((single.i, (!single.action_only).then_some(single.j)));
    }
    let [i, j] = model.element(element)?.ends()?;
    Some((i, Some(j)))
}
