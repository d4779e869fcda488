//! A model whose clock begins at another time: every TIME of its functions is counted from there.
//!
//! A dataset has no statement that says when it begins: every program starts it at zero. So a model
//! that is to go on from a time reads it in its functions:
//!
//! ```text
//! SIN(2*TIME)   begun at 0.3:   SIN(2*(TIME+0.3))
//! ```

use super::row::Record;
use super::statement::STATEMENTS;
use super::value::Value;
use crate::expr::ast::{Constant, Node};
use crate::model::{ElementId, Formula, Model};

/// Name of time in functions.
const TIME: &str = "TIME";

impl Model {
    /// Counts the TIME of all functions from `start`, which is when the model then begins; returns
    /// the elements whose routines read the clock by themselves, if they do.
    ///
    /// # Examples
    /// ```
    /// use cognate::model::Model;
    /// let text = "t\nPART/1, GROUND\nVARIABLE/1, FUNCTION=SIN(TIME)\nEND\n";
    /// let mut model = Model::from_text(text)?;
    /// model.begin_at(0.5);
    /// assert!(model.to_text().contains("SIN((TIME+0.5))"));
    /// # Ok::<(), cognate::Error>(())
    /// ```
    pub fn begin_at(&mut self, start: f64) -> Vec<ElementId> {
        let mut users = Vec::new();
        if start == 0.0 {
            return users;
        }
        for row in STATEMENTS {
            for mut record in row.records(self) {
                let element = row.kind().zip(record.id).map(|(kind, id)| kind.id(id));
                let mut is_changed = false;
                for given in &mut record.given {
                    let Value::Formula(formula) = &mut given.value else {
                        continue;
                    };
                    match formula {
                        Formula::User { .. } => users.extend(element),
                        Formula::Expression { .. } => is_changed |= count_from(formula, start),
                    }
                }
                if is_changed {
                    // what a model has told of itself it takes back
                    let refused = row.enter(self, &record, true);
                    debug_assert!(refused.is_empty(), "{}", record.element());
                }
            }
        }
        users
    }
}

impl Record {
    /// Returns whether one of its functions reads TIME.
    pub fn reads_time(&self) -> bool {
        let reads = |value: &Value| match value {
            Value::Formula(Formula::Expression { text, .. }) => {
                text.ast().is_ok_and(|ast| ast.nodes.iter().any(is_time))
            }
            _ => false,
        };
        self.given.iter().any(|given| reads(&given.value))
    }
}

/// Returns whether a node is TIME.
fn is_time(node: &Node) -> bool {
    matches!(node, Node::Constant(Constant::Time))
}

/// Counts the TIME of an expression from `start`; returns whether it reads any.
fn count_from(formula: &mut Formula, start: f64) -> bool {
    let Formula::Expression { text, .. } = formula else {
        return false;
    };
    let Ok(ast) = text.ast() else {
        return false;
    };
    let mut places: Vec<usize> = (ast.nodes.iter().zip(&ast.spans))
        .filter(|(node, _)| is_time(node))
        .map(|(_, span)| span.start)
        .collect();
    if places.is_empty() {
        return false;
    }
    places.sort_unstable();
    let sign = if start < 0.0 { "-" } else { "+" };
    let counted = format!("({TIME}{sign}{:?})", start.abs());
    let mut new = String::new();
    let mut from = 0;
    for place in places {
        new += &text[from..place];
        new += &counted;
        from = place + TIME.len();
    }
    new += &text[from..];
    *formula = Formula::Expression {
        text: new.into(),
        line: 0,
        column: 0,
        breaks: Vec::new(),
    };
    true
}
