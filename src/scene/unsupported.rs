//! What a model may hold that is read and written, but not solved. A kind that becomes solved loses its line here.

use crate::diagnostic::Diagnostic;
use crate::model::Model;
use std::collections::BTreeSet;

/// Elements of a model that are not solved, by keyword and number; inactive ones do not count.
fn unsolved(model: &Model) -> Vec<(&'static str, u32)> {
    let mut found: Vec<(&'static str, u32)> = Vec::new();
    const FLEXIBLE: [&str; 9] = [
        "FLEX_BODY",
        "FE_PART",
        "FE_LOAD",
        "MFORCE",
        "UCON",
        "TIRE",
        "WHEEL",
        "PTSF",
        "CVSF",
    ];
    for (keyword, id) in model.others.keys() {
        found.extend(FLEXIBLE.iter().filter(|k| *k == keyword).map(|k| (*k, *id)));
    }
    found.retain(|(keyword, id)| !model.inactive.contains(&((*keyword).to_string(), *id)));
    found
}

/// Errors for what is not solved, warnings where its keyword is among those to be skipped.
pub fn report(model: &Model, skipped: &BTreeSet<String>) -> Vec<Diagnostic> {
    unsolved(model)
        .into_iter()
        .map(|(keyword, id)| {
            let element = format!("{keyword}/{id}");
            if skipped.contains(keyword) {
                return Diagnostic::warning("skipped", "is left out: it is not solved").element(element);
            }
            Diagnostic::error("unsupported", "is read, but not solved yet")
                .element(element)
                .help(format!("--skip-unsupported {keyword} leaves all of its kind out; the results are then those of another model"))
        })
        .collect()
}
