//! What the requests of a model ask for.

use cognate::model::{Formula, Model, RequestKind};

/// The expressions of the requests of a model.
pub fn expressions(model: &Model) -> Vec<String> {
    let mut all = Vec::new();
    for request in model.requests.values() {
        if let RequestKind::Functions(functions) = &request.kind {
            for f in functions.iter().flatten() {
                if let Formula::Expression { text, .. } = f {
                    all.push(text.to_string());
                }
            }
        }
    }
    all
}
