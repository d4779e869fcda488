//! Requests and units.

use super::*;
use crate::diagnostic::counted;

/// Components of a REQUEST.
const COMPONENTS: usize = 8;

pub(super) fn requests_ask_something(model: &Model, out: &mut Out) {
    for (&id, r) in &model.requests {
        let who = (ElementKind::Request.id(id), &r.place);
        let texts = [
            ("CNAMES", &r.cnames),
            ("CUNITS", &r.cunits),
            ("CLABELS", &r.clabels),
        ];
        let is_beyond = |all: &[String]| all.iter().skip(COMPONENTS).any(|t| !t.is_empty());
        for (name, all) in texts.into_iter().filter(|t| is_beyond(t.1)) {
            let what = format!(
                "{name} has {}, but a REQUEST has {COMPONENTS}",
                counted(all.len(), "text")
            );
            warn(out, "wrong_count", who, what);
            at_argument(out, name);
        }
        match &r.kind {
            RequestKind::Functions(f) if f.iter().all(Option::is_none) => {
                warn(out, "no_effect", who, "it asks nothing".into());
                advise(
                    out,
                    "DISPLACEMENT, VELOCITY, ACCELERATION or FORCE with I, or F1 to F8",
                );
            }
            RequestKind::Displacement { i: 0, .. }
            | RequestKind::Velocity { i: 0, .. }
            | RequestKind::Acceleration { i: 0, .. }
            | RequestKind::Force { i: 0, .. } => {
                error(out, "missing_argument", who, "I is needed".into())
            }
            _ => {}
        }
    }
}

pub(super) fn many_requests_ask_something(model: &Model, out: &mut Out) {
    for (&id, many) in &model.many_requests {
        let who = (ElementKind::Mrequest.id(id), &many.place);
        for (list, word) in many.idle_words(model) {
            let what = format!("{list} = {word} names nothing that can be asked");
            warn(out, "no_effect", who, what);
            advise(
                out,
                "ALL, or numbers of elements between colons; a part needs CM, a force I and J",
            );
        }
    }
}

pub(super) fn units_are_known(model: &Model, out: &mut Out) {
    let Some(u) = &model.units else {
        return;
    };
    let four = [
        ("FORCE", &u.force, units::force(&u.force), units::FORCES),
        ("MASS", &u.mass, units::mass(&u.mass), units::MASSES),
        (
            "LENGTH",
            &u.length,
            units::length(&u.length),
            units::LENGTHS,
        ),
        ("TIME", &u.time, units::time(&u.time), units::TIMES),
    ];
    for (name, word, factor, known) in four {
        if factor.is_none() && !word.is_empty() {
            let mut d = Diagnostic::error("unknown_word", format!("{name} = {word}: unknown unit"))
                .element("UNITS");
            let near = near_names(word, known.iter().copied());
            if !near.is_empty() {
                d = d.help(format!("did you mean {}?", near.join(" or ")));
            }
            out.push(d);
        }
    }
    if !(u.ucf.is_finite() && u.ucf > 0.0) {
        out.push(Diagnostic::error("unfit_value", "UCF must be positive").element("UNITS"));
    }
}
