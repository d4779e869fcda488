//! REQUEST and MREQUEST as columns.
//!
//! A MREQUEST stands for a REQUEST of each of its elements.

use super::selection::output_says;
use crate::model::{ElementId, ElementKind, Formula, Labels, Model, RequestKind, Text};
use std::borrow::Cow;

/// A component of a REQUEST.
pub(super) struct RequestComponent {
    /// 1 to 8
    pub place: usize,
    pub name: String,
    /// its expression; empty when a closure computes it
    pub text: Text,
}

/// Components of one name, of a REQUEST or of one element of a MREQUEST.
pub(super) struct RequestSet<'m> {
    /// the REQUEST or MREQUEST
    pub id: ElementId,
    pub name: String,
    pub kind: Cow<'m, RequestKind>,
    /// names of the components, where they are given
    pub cnames: &'m [String],
}

/// Returns the sets of all requests that are switched on.
pub(super) fn request_sets<'m>(model: &'m Model, labels: &Labels) -> Vec<RequestSet<'m>> {
    let single = model.active(ElementKind::Request, &model.requests);
    let mut all: Vec<RequestSet<'_>> = single
        .map(|(n, request)| {
            let id = ElementKind::Request.id(n);
            RequestSet {
                id,
                name: labels.name(model, id),
                kind: Cow::Borrowed(&request.kind),
                cnames: &request.cnames,
            }
        })
        .collect();
    for (n, many) in model.active(ElementKind::Mrequest, &model.many_requests) {
        let id = ElementKind::Mrequest.id(n);
        let own = labels.name(model, id);
        for (element, kind) in many.requests(model) {
            let name = labels.name(model, element);
            all.push(RequestSet {
                id,
                name: format!("{own}.{name}"),
                kind: Cow::Owned(kind),
                cnames: &[],
            });
        }
    }
    all
}

/// Returns the components of a REQUEST as expressions, or those that a closure computes.
pub(super) fn components(
    model: &Model,
    set: &RequestSet<'_>,
    computed: &dyn Fn(u32, &Formula) -> bool,
) -> Vec<RequestComponent> {
    match &*set.kind {
        RequestKind::Displacement { i, j, rm } => {
            let mut all = measured(1, "MAG", "DM", ["DX", "DY", "DZ"], (*i, *j, *rm));
            let angles = match output_says(model, "YPR") {
                true => ["YAW", "PITCH", "ROLL"],
                false => ["PSI", "THETA", "PHI"],
            };
            all.extend(
                angles
                    .iter()
                    .zip(6..)
                    .map(|(name, place)| RequestComponent {
                        place,
                        name: name.to_string(),
                        text: format!("{name}({i},{})", j.unwrap_or(0)).into(),
                    }),
            );
            all
        }
        RequestKind::Velocity { i, j, rm } => {
            let translation = ("VM", ["VX", "VY", "VZ"]);
            both(translation, ("WM", ["WX", "WY", "WZ"]), (*i, *j, *rm))
        }
        RequestKind::Acceleration { i, j, rm } => {
            let translation = ("ACCM", ["ACCX", "ACCY", "ACCZ"]);
            let rotation = ("WDTM", ["WDTX", "WDTY", "WDTZ"]);
            both(translation, rotation, (*i, *j, *rm))
        }
        RequestKind::Force { i, j, rm } => {
            let translation = ("FM", ["FX", "FY", "FZ"]);
            both(translation, ("TM", ["TX", "TY", "TZ"]), (*i, *j, *rm))
        }
        RequestKind::Functions(all) => (all.iter().enumerate())
            .filter_map(|(k, f)| match f {
                Some(Formula::Expression { text, .. }) => Some(function(k + 1, text.clone())),
                _ => None,
            })
            .collect(),
        RequestKind::User(user) if computed(set.id.number, user) => {
            (1..=8).map(|k| function(k, Text::default())).collect()
        }
        RequestKind::User(_) => Vec::new(),
    }
}

fn function(place: usize, text: Text) -> RequestComponent {
    RequestComponent {
        place,
        name: format!("F{place}"),
        text,
    }
}

/// Returns a magnitude and three components that measures between markers I and J yield, those of
/// RM resolving the components.
fn measured(
    first: usize,
    magnitude: &str,
    of_magnitude: &str,
    measures: [&str; 3],
    (i, j, rm): (u32, Option<u32>, Option<u32>),
) -> Vec<RequestComponent> {
    let (j, rm) = (j.unwrap_or(0), rm.unwrap_or(0));
    let mut all = vec![RequestComponent {
        place: first,
        name: magnitude.into(),
        text: format!("{of_magnitude}({i},{j})").into(),
    }];
    all.extend(measures.iter().zip(first + 1..).map(|(name, place)| {
        let text = format!("{name}({i},{j},{rm})").into();
        let name = name.to_string();
        RequestComponent { place, name, text }
    }));
    all
}

/// Returns the eight components of a quantity that has a part of translation and one of rotation.
fn both(
    translation: (&str, [&str; 3]),
    rotation: (&str, [&str; 3]),
    markers: (u32, Option<u32>, Option<u32>),
) -> Vec<RequestComponent> {
    let mut all = measured(1, "MAG", translation.0, translation.1, markers);
    all.extend(measured(5, "AMAG", rotation.0, rotation.1, markers));
    all
}
