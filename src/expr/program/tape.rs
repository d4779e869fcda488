//! Tapes: what a builder was asked, and what it answered, for another that is asked the same
//! (`follow.rs`).

use super::hashing::HashMap;
use super::input::Input;
use super::node::{Node, Value};
use super::operation::BinaryOp;
use super::run::Program;
use std::cell::RefCell;
use std::sync::{Arc, Mutex, PoisonError};

/// Programs and counts that a tape keeps, at most.
pub(super) const MOST_ENDS: usize = 256;
/// Questions that a tape keeps, at most; a recording that asks more is made anew.
pub(super) const MOST_QUESTIONS: usize = 1 << 20;

/// A question of a builder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Question {
    /// a node, new or one that is there
    Node(Node),
    /// an operation on values, at most one of them a number that is simplified as most are, whose
    /// answer read no other number, and took so many questions after this one
    Binary(BinaryOp, Value, Value, u32),
    /// one whose answer read other numbers
    ByNumbers(BinaryOp, Value, Value),
}

/// Something that was made of some values when so many questions had been asked.
#[derive(Debug)]
pub(super) struct End {
    pub place: usize,
    pub outputs: Vec<Value>,
    pub made: Made,
}

#[derive(Debug)]
pub(super) enum Made {
    /// a program for a layout, and the nodes that are its constants, in their order
    Program {
        layout: Option<Vec<Input>>,
        program: Program,
        constants: Vec<Value>,
    },
    /// the number of operations
    Count(usize),
    /// nothing in them depends on time alone
    #[cfg(feature = "solver")]
    Untimed,
}

/// Questions of a builder and their answers, and its ends.
#[derive(Debug, Default)]
pub(super) struct Tape {
    pub questions: Vec<(Question, Value)>,
    /// operands of the nodes asked for that have a list, one after the other
    pub lists: Vec<Value>,
    pub inputs: Vec<Input>,
    pub ends: RefCell<Vec<End>>,
}

/// Tapes of the builders of a recording, in the order in which these are made; `None`: it is in a
/// builder. Copies share them.
#[derive(Clone, Debug, Default)]
pub(super) struct Shelf(Arc<Mutex<Vec<Option<Tape>>>>);

impl Shelf {
    /// Takes the tape of a place, to be followed; one to be written where there is none.
    pub fn take(&self, place: usize) -> Taped {
        let mut tapes = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if tapes.len() <= place {
            tapes.resize_with(place + 1, || None);
        }
        let tape = tapes[place].take();
        drop(tapes);
        Taped {
            next: tape.is_some().then_some((0, 0)),
            tape: tape.unwrap_or_default(),
            numbers: HashMap::default(),
            reads: 0,
            shelf: self.clone(),
            place,
        }
    }
}

/// A tape in a builder, which follows it or writes it.
#[derive(Debug)]
pub(super) struct Taped {
    pub tape: Tape,
    /// the next question and operand of a list, where it is followed; `None`: it is written
    pub next: Option<(usize, usize)>,
    /// numbers that are recorded, while the tape is followed
    pub numbers: HashMap<u64, Value>,
    /// how often numbers were read
    pub reads: u64,
    shelf: Shelf,
    place: usize,
}

impl Drop for Taped {
    fn drop(&mut self) {
        let tape = std::mem::take(&mut self.tape);
        let mut tapes = self.shelf.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(home) = tapes.get_mut(self.place) {
            *home = Some(tape);
        }
    }
}

impl Taped {
    /// Writes from the present place on.
    pub fn leave(&mut self) {
        let Some((question, list)) = self.next.take() else {
            return;
        };
        self.tape.questions.truncate(question);
        self.tape.lists.truncate(list);
        let ends = self.tape.ends.get_mut();
        ends.retain(|end| end.place <= question);
        self.numbers = HashMap::default();
    }

    /// Returns how many questions have been asked.
    pub fn place(&self) -> usize {
        self.next.map_or(self.tape.questions.len(), |(k, _)| k)
    }
}
