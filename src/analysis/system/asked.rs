//! Questions of a user's routine about the model, as SYSFNC and SYSARY of Adams ask them.
//!
//! A routine says what it reads by asking: it is called once with IFLAG true before anything is
//! computed, and what it asks for then becomes the inputs of its closure. Later it is told their
//! values. What it did not ask for in the first call it cannot be told: the closure is computed
//! from its inputs alone, and so are its derivatives.
//!
//! The call that is going on belongs to its thread; those who lend the functions to C and to
//! Fortran find it here.

use crate::expr;
use crate::expr::ast::Dialect;
use std::cell::RefCell;
use std::sync::Arc;

/// A question: the function, and the numbers in its parentheses.
#[derive(Clone, Debug, PartialEq)]
struct Question {
    name: String,
    ids: Vec<i32>,
    /// which input answers it
    input: usize,
}

/// Questions of a routine in its first call, and the inputs that answer them.
#[derive(Clone, Debug, Default)]
pub struct Questions {
    asked: Vec<Question>,
    /// inputs of its closure: expressions
    pub inputs: Vec<String>,
}

impl Questions {
    /// Returns the input that answers a question; `None`: it was not asked, or in other words.
    fn find(&self, name: &str, ids: &[i32]) -> Option<usize> {
        let is_it = |q: &&Question| q.ids == ids && q.name.eq_ignore_ascii_case(name);
        self.asked.iter().find(is_it).map(|q| q.input)
    }

    fn position(&self, input: &str) -> Option<usize> {
        self.inputs.iter().position(|known| known == input)
    }

    fn add(&mut self, name: &str, ids: &[i32], input: String) {
        let found = self.position(&input);
        let input = found.unwrap_or_else(|| {
            self.inputs.push(input);
            self.inputs.len() - 1
        });
        if self.find(name, ids).is_none() {
            self.asked.push(Question {
                name: name.to_owned(),
                ids: ids.to_vec(),
                input,
            });
        }
    }
}

/// The call of a routine that is going on in this thread.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// what it may ask for; nothing in the first call
    pub questions: Arc<Questions>,
    /// what it has asked for in the first call
    pub found: Questions,
    /// values of the inputs; none in the first call
    pub values: Vec<f64>,
    /// it is the first call
    pub is_first: bool,
    /// TIME
    pub time: f64,
    /// an input that it has asked for, but not in the first call
    pub lacking: Option<String>,
    /// what it says about its work
    pub said: Vec<String>,
    /// why it wants the run to end
    pub stop: Option<String>,
}

thread_local! {
    static CALL: RefCell<Option<Asked>> = const { RefCell::new(None) };
}

/// Calls a routine that may ask; returns what it has asked.
pub fn within(call: Asked, routine: impl FnOnce()) -> Asked {
    let before = CALL.with(|c| c.replace(Some(call)));
    routine();
    CALL.with(|c| c.replace(before)).unwrap_or_default()
}

impl Asked {
    /// Returns the first call, which finds out what the routine reads.
    pub fn first() -> Self {
        Self {
            is_first: true,
            ..Self::default()
        }
    }

    fn value(&mut self, name: &str, ids: &[i32]) -> Option<f64> {
        if let Some(k) = self.questions.find(name, ids) {
            return Some(self.values.get(k).copied().unwrap_or(0.0));
        }
        let input = written(name, ids)?;
        if self.is_first {
            self.found.add(name, ids, input);
            return Some(0.0);
        }
        let Some(k) = self.questions.position(&input) else {
            self.lacking.get_or_insert(input);
            return Some(0.0);
        };
        Some(self.values.get(k).copied().unwrap_or(0.0))
    }
}

/// Functions of a name of SYSARY, and how many numbers each takes of those given.
type Components = &'static [(&'static str, usize)];

const PLACE: Components = &[("DX", 3), ("DY", 3), ("DZ", 3)];
const ANGLES: Components = &[("PSI", 2), ("THETA", 2), ("PHI", 2)];
const VELOCITY: Components = &[("VX", 4), ("VY", 4), ("VZ", 4)];
const SPIN: Components = &[("WX", 3), ("WY", 3), ("WZ", 3)];
const ACCELERATION: Components = &[("ACCX", 4), ("ACCY", 4), ("ACCZ", 4)];
const SPIN_RATE: Components = &[("WDTX", 4), ("WDTY", 4), ("WDTZ", 4)];
const FORCE: Components = &[("FX", 3), ("FY", 3), ("FZ", 3)];
const TORQUE: Components = &[("TX", 3), ("TY", 3), ("TZ", 3)];

/// Names of SYSARY, and what is asked for by each.
const ARRAYS: &[(&str, &[Components])] = &[
    ("TDISP", &[PLACE]),
    ("RDISP", &[ANGLES]),
    ("DISP", &[PLACE, ANGLES]),
    ("TVEL", &[VELOCITY]),
    ("RVEL", &[SPIN]),
    ("VEL", &[VELOCITY, SPIN]),
    ("TACC", &[ACCELERATION]),
    ("RACC", &[SPIN_RATE]),
    ("ACC", &[ACCELERATION, SPIN_RATE]),
    ("TFORCE", &[FORCE]),
    ("RFORCE", &[TORQUE]),
    ("FORCE", &[FORCE, TORQUE]),
];

/// Writes a call: `DX(1, 2)`, zeros at the end left out; `None`: the language has no such function.
fn written(name: &str, ids: &[i32]) -> Option<String> {
    let given = ids.iter().rposition(|id| *id != 0).map_or(0, |k| k + 1);
    let all: Vec<String> = ids[..given].iter().map(ToString::to_string).collect();
    let text = format!("{}({})", name.to_uppercase(), all.join(","));
    let input = expr::input_named(&text, Dialect::Function).ok()?;
    Some(input.to_string())
}

/// Returns the value of a function of the model (`DX`, `VARVAL`); `None`: there is no such
/// function, or no routine is being called.
pub fn ask(name: &str, ids: &[i32]) -> Option<f64> {
    CALL.with(|c| c.borrow_mut().as_mut()?.value(name, ids))
}

/// Returns the values of an array (`DISP`, `TVEL`): three or six.
pub fn ask_array(name: &str, ids: &[i32]) -> Option<Vec<f64>> {
    let row = ARRAYS.iter().find(|row| row.0.eq_ignore_ascii_case(name))?;
    let all = row.1.iter().copied().flatten();
    all.map(|(function, most)| ask(function, &ids[..ids.len().min(*most)]))
        .collect()
}

/// Returns TIME, if a routine is being called.
pub fn time() -> Option<f64> {
    CALL.with(|c| Some(c.borrow().as_ref()?.time))
}

/// Notes what a routine says about its work; `ends`: the run is to end for it.
pub fn note(text: &str, ends: bool) {
    CALL.with(|c| {
        if let Some(call) = c.borrow_mut().as_mut() {
            match ends {
                true => drop(call.stop.get_or_insert_with(|| text.to_owned())),
                false => call.said.push(text.to_owned()),
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_asked_first_is_told_later_and_nothing_else() {
        let first = within(Asked::first(), || {
            assert_eq!(ask("dx", &[1, 2, 0]), Some(0.0));
            assert_eq!(ask("VARVAL", &[3]), Some(0.0));
            assert_eq!(ask("NOTHING", &[3]), None);
        });
        assert_eq!(first.found.inputs, ["DX(1, 2)", "VARVAL(3)"]);
        let later = Asked {
            questions: Arc::new(first.found),
            values: vec![5.0, 7.0],
            ..Asked::default()
        };
        let later = within(later, || {
            assert_eq!(ask("VARVAL", &[3]), Some(7.0));
            // in other words
            assert_eq!(ask("DX", &[1, 2]), Some(5.0));
            assert_eq!(ask("DY", &[1, 2]), Some(0.0));
        });
        assert_eq!(later.lacking.as_deref(), Some("DY(1, 2)"));
        assert_eq!(ask("DX", &[1, 2]), None);
    }

    #[test]
    fn every_array_asks_for_functions_that_exist() {
        for (name, _) in ARRAYS {
            let all = within(Asked::first(), || {
                let values = ask_array(name, &[1, 2, 3, 4]);
                assert!(values.is_some_and(|v| v.len() % 3 == 0), "{name}");
            });
            assert!(all.found.inputs.len() >= 3);
        }
    }
}
