//! Contacts: a law that keeps bodies apart.

use super::*;
use crate::expr::lint::{EXPONENT_ADVICE, infinitely_stiff, is_infinitely_stiff};

/// IMPACT needs STIFFNESS and EXPONENT, and DAMPING needs DMAX: without them the force does not
/// grow with the depth, or damps from the first touch on.
pub(super) fn contacts_have_their_law(model: &Model, out: &mut Out) {
    let impacts = model.contacts.iter();
    for (&id, c) in impacts.filter(|(_, c)| c.law == ContactLaw::Impact) {
        let who = (ElementKind::Contact.id(id), &c.place);
        for missing in c.missing() {
            error(out, "missing_argument", who, missing.to_string());
            advise(out, missing.advice());
        }
        if is_infinitely_stiff(c.exponent) && c.stiffness != 0.0 {
            warn(out, "unlikely_magnitude", who, infinitely_stiff(c.exponent));
            at_argument(out, "EXPONENT");
            advise(out, EXPONENT_ADVICE);
        }
    }
}
