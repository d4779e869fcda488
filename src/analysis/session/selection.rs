//! The choice of what is recorded: RESULTS and OUTPUT of the dataset, and the wishes of the user.

use super::Options;
use super::sets::{SETS, why_without};
use crate::diagnostic::{Cause, Diagnostic};
use crate::model::{ElementId, ElementKind, Model, SettingsStatement};

/// A word of RESULTS that leaves results out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Omission {
    /// positions and angles of parts, variables of joints
    Displacements,
    /// velocities of parts
    Velocities,
    /// accelerations of parts
    Accelerations,
    /// what constraints exert
    ReactionForces,
    /// what forces exert
    AppliedForces,
    /// variables, equations and their inputs and outputs
    SystemElements,
    /// where curves touch
    FloatingMarkers,
    /// the components of requests
    Requests,
    /// what solids exert where they touch
    Contacts,
}

impl Omission {
    /// Returns the word, in capitals.
    pub(super) const fn keyword(self) -> &'static str {
        match self {
            Self::Displacements => "NODISPLACEMENTS",
            Self::Velocities => "NOVELOCITIES",
            Self::Accelerations => "NOACCELERATIONS",
            Self::ReactionForces => "NOREACTIONFORCES",
            Self::AppliedForces => "NOAPPLIEDFORCES",
            Self::SystemElements => "NOSYSTEMELEMENTS",
            Self::FloatingMarkers => "NOFLOATINGMARKERS",
            Self::Requests => "NOREQUESTS",
            Self::Contacts => "NOCONTACTS",
        }
    }
}

/// Elements that a user chooses for the record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Chosen {
    /// one element, as `JOINT/3`
    Element(ElementId),
    /// all elements of a kind, as `JOINT`
    Kind(ElementKind),
    /// one element by another name, as the dataset gives it: see [`Chosen::in_model`]
    Called(String),
}

impl std::str::FromStr for Chosen {
    type Err = String;

    /// Reads `JOINT/3`, `JOINT`, or a name; refuses kinds without results of their own.
    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let element = text
            .parse()
            .map(|id: ElementId| (Self::Element(id), id.kind));
        let kind = || text.parse().map(|kind| (Self::Kind(kind), kind));
        let Ok((chosen, kind)) = element.or_else(|_| kind()) else {
            return Ok(Self::Called(text.to_owned()));
        };
        has_results(kind).map(|()| chosen)
    }
}

/// # Errors
/// For kinds of elements without results of their own, with the reason.
fn has_results(kind: ElementKind) -> Result<(), String> {
    match why_without(kind) {
        Some(why) => Err(format!("{kind} has no results of its own: {why}")),
        None => Ok(()),
    }
}

fn kinds_with_results() -> Vec<ElementKind> {
    let sets = SETS.iter().map(|set| set.kind);
    sets.filter(|kind| why_without(*kind).is_none()).collect()
}

impl Chosen {
    /// Returns the choice with the element of a model in the place of its name.
    ///
    /// # Errors
    /// When the model has no such element, with those that are near, or it has no results of its
    /// own.
    pub fn in_model(&self, model: &Model) -> Result<Self, Diagnostic> {
        let id = match self {
            Self::Kind(_) => return Ok(self.clone()),
            Self::Element(id) if model.has(*id) => *id,
            Self::Element(id) => return Err(model.no_element(*id)),
            // of several elements of a name those count that have results
            Self::Called(name) => match model.find_of(&kinds_with_results(), name) {
                Ok(id) => id,
                Err(d) => model.find_element(name).map_err(|_| d)?,
            },
        };
        match has_results(id.kind) {
            Ok(()) => Ok(Self::Element(id)),
            Err(why) => Err(Diagnostic::error(Cause::UnknownElement, why)),
        }
    }

    fn has(&self, id: ElementId) -> bool {
        match *self {
            Chosen::Element(element) => element == id,
            Chosen::Kind(kind) => kind == id.kind,
            Chosen::Called(_) => false,
        }
    }
}

/// The sets of results that are recorded beside requests.
#[derive(Clone, Copy, Debug)]
pub(super) struct Selection<'a> {
    /// every element has its set, but those that RESULTS leaves out
    pub full: bool,
    /// positions and angles of parts are recorded whatever else is
    pub frames: bool,
    /// bodies have sets of eight velocities and eight accelerations of their centres of mass
    pub body_rates: bool,
    /// only these elements have sets; none: all have
    pub only: &'a [Chosen],
    /// every element has its set where nothing is asked for
    pub by_default: bool,
}

/// Elements with sets up to which a run that is asked for nothing records all of them.
const MOST_BY_DEFAULT: usize = 400;

impl Selection<'_> {
    /// Returns the selection of a run that is asked for nothing: everything, as RESULTS has it; of
    /// a model of very many elements, whose results would fill the memory, where its bodies are.
    pub(super) fn of_everything(self, model: &Model) -> Self {
        let kinds = SETS.iter().filter(|set| why_without(set.kind).is_none());
        let n_sets: usize = kinds.map(|set| model.numbers(set.kind).len()).sum();
        match n_sets <= MOST_BY_DEFAULT {
            true => Self { full: true, ..self },
            false => Self {
                frames: true,
                ..self
            },
        }
    }

    /// Returns whether the user has chosen an element by name or kind: tables then show its sets.
    pub(super) fn names(&self, id: ElementId) -> bool {
        self.only.iter().any(|chosen| chosen.has(id))
    }

    /// Returns whether an element has a set, whatever RESULTS leaves out of it.
    pub(super) fn has(&self, id: ElementId) -> bool {
        self.full && (self.only.is_empty() || self.only.iter().any(|chosen| chosen.has(id)))
    }
}

impl Options {
    /// Puts elements of a model in the place of their names; names that it does not have stay.
    pub(super) fn choose_in(&mut self, model: &Model) {
        for chosen in &mut self.only {
            if let Ok(found) = chosen.in_model(model) {
                *chosen = found;
            }
        }
    }

    /// Returns the sets of results that the options ask for.
    pub(super) fn selection(&self) -> Selection<'_> {
        Selection {
            full: self.full,
            frames: self.frames,
            body_rates: self.body_rates,
            only: &self.only,
            by_default: !self.named_only,
        }
    }
}

/// Returns whether RESULTS leaves something out.
pub(super) fn omits(model: &Model, omission: Omission) -> bool {
    let results = model.settings.get(&SettingsStatement::Results);
    results.is_some_and(|r| r.words.contains_key(omission.keyword()))
}

/// Returns whether OUTPUT has a word, given in capitals.
pub(super) fn output_says(model: &Model, word: &str) -> bool {
    let output = model.settings.get(&SettingsStatement::Output);
    output.is_some_and(|output| output.words.contains_key(word))
}
