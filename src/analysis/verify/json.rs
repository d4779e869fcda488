//! The findings of a verification as JSON, for programs.

use super::Verification;
use crate::diagnostic::Diagnostic;
use serde_json::{Value, json};

fn finding(d: &Diagnostic) -> Value {
    json!({ "row": d.subject().map(|s| s.to_string()), "message": d.message, "advice": d.help })
}

impl Verification {
    /// Returns everything, for programs.
    pub fn json(&self) -> Value {
        let dependent: Vec<Value> = (self.dependent.iter())
            .map(|d| {
                let combination: Vec<Value> = (d.combination.iter())
                    .map(|(row, factor)| json!({ "row": row, "factor": factor }))
                    .collect();
                let fixed_by: Vec<String> = d.fixed_by.iter().map(ToString::to_string).collect();
                json!({
                    "row": d.row, "element": d.element.to_string(),
                    "direction": d.direction.to_string(), "fixed_by": fixed_by,
                    "combination": combination, "only_here": d.only_here, "words": d.sentence(),
                })
            })
            .collect();
        let free: Vec<Value> = (self.free.iter())
            .map(|f| {
                let parts: Vec<Value> = (f.parts.iter())
                    .map(|p| {
                        json!({ "part": p.part.to_string(), "words": p.words, "angular": p.angular, "linear": p.linear, "at": p.at })
                    })
                    .collect();
                json!({ "unknown": f.unknown.to_string(), "words": f.words, "parts": parts })
            })
            .collect();
        let counted: Vec<Value> = (self.counted.iter())
            .map(|(what, n, equations)| json!({ "what": what, "elements": n, "equations": equations }))
            .collect();
        let undetermined: Vec<Value> = (self.undetermined.iter())
            .map(|u| json!({ "element": u.element.to_string(), "components": u.components, "axes": u.axes.to_string() }))
            .collect();
        json!({
            "parts": self.parts,
            "point_masses": self.point_masses,
            "constraints": counted,
            "gruebler": self.gruebler,
            "freedom": self.freedom,
            "freedom_nearby": self.freedom_nearby,
            "freedom_of_position": self.freedom_of_position,
            "consistent": self.inconsistent.is_empty(),
            "inconsistent": self.inconsistent.iter().map(finding).collect::<Vec<_>>(),
            "redundant": self.redundant(),
            "dependent": dependent,
            "reactions_not_unique": undetermined,
            "advice": self.advice.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "free": free,
            "assembly": { "iterations": self.assembly.0, "moved": self.assembly.1 },
            "warnings": self.warned(),
        })
    }
}
