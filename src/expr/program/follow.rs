//! Following a tape: a builder that is asked what the one before it was asked takes its answers.
//!
//! A model that is recorded again with other numbers asks the same questions in the same order.
//! Most answers follow from what was asked before and from no number: they are taken from the
//! tape, and nothing is simplified or looked up for them. Questions that read a number are answered
//! anew, and what becomes of them is compared with the tape. From the first question or answer on
//! that is not the one of the tape, the builder goes on by itself. So its nodes are those that it
//! would have made alone, whatever the tape says.
//!
//! ```text
//! same questions so far, same answers so far   ⇒   nodes that differ in their constants alone
//! ```
//!
//! Programs and counts that were made at the same place of the tape are made of such nodes: they
//! differ in their constants alone, too.

use super::builder::Builder;
use super::input::Input;
use super::node::{Node, Value};
use super::operation::BinaryOp;
use super::run::Program;
use super::schedule;
use super::tape::{End, MOST_ENDS, MOST_QUESTIONS, Made, Question, Tape};

impl Builder {
    /// Goes on without the tape that is followed: finds equal nodes by itself.
    pub(super) fn leave_tape(&mut self) {
        if let Some(taped) = &mut self.taped
            && taped.next.is_some()
        {
            taped.leave();
            taped.tape.inputs.truncate(self.inputs.len());
            self.find_again();
        }
    }

    /// Returns the answer of the tape to a node that is asked for, where it is followed and asked
    /// the same. Arguments of a list node are the last of the list.
    #[inline]
    pub(super) fn node_by_tape(&mut self, node: Node) -> Option<Value> {
        let taped = self.taped.as_deref_mut()?;
        let (k, list) = taped.next?;
        let n = self.nodes.len();
        let same = |asked: Node, answer: Value| match (asked, node) {
            (Node::Constant(_), Node::Constant(bits)) if answer.index() < n => {
                self.nodes[answer.index()] == Node::Constant(bits)
            }
            (Node::Constant(_), Node::Constant(bits)) => !taped.numbers.contains_key(&bits),
            // most of them
            (Node::Binary(op, a, b), Node::Binary(o, x, y)) => (op, a, b) == (o, x, y),
            _ => asked == node,
        };
        let found = match taped.tape.questions.get(k) {
            Some(&(Question::Node(asked), answer)) if same(asked, answer) => answer,
            _ => return None,
        };
        let mut list_end = list;
        if let Some(own) = node.list() {
            list_end += own.len();
            if taped.tape.lists.get(list..list_end)? != &self.arguments[own.clone()] {
                return None;
            }
            if found.index() < n {
                self.arguments.truncate(own.start);
            }
        }
        if let (true, Node::Constant(bits)) = (found.index() == n, node) {
            taped.numbers.insert(bits, found);
        }
        taped.next = Some((k + 1, list_end));
        if found.index() == n {
            self.nodes.push(node);
        }
        Some(found)
    }

    /// Writes the operands of a node that is asked for, where the tape is written.
    pub(super) fn write_list(&mut self, node: &Node) {
        if let (Some(taped), Some(own)) = (&mut self.taped, node.list()) {
            taped.tape.lists.extend_from_slice(&self.arguments[own]);
        }
    }

    /// Writes a node that was asked for, and the answer.
    #[inline]
    pub(super) fn write_node(&mut self, node: Node, answer: Value) {
        self.write_question(Question::Node(node), answer);
    }

    /// Writes a question and its answer; forgets the tape of a recording that is too long.
    fn write_question(&mut self, question: Question, answer: Value) {
        if let Some(taped) = &mut self.taped {
            if taped.tape.questions.len() < MOST_QUESTIONS {
                taped.tape.questions.push((question, answer));
            } else {
                taped.tape = Tape::default();
                self.taped = None;
            }
        }
    }

    /// Compares an input with that of the tape, or writes it; leaves the tape where it is another.
    pub(super) fn tape_input(&mut self, input: Input) {
        let k = self.inputs.len();
        let Some(taped) = &mut self.taped else { return };
        let node = Node::Input(k as u32);
        if let Some((place, list)) = taped.next {
            let asked = taped.tape.questions.get(place);
            let answer = Value(self.nodes.len() as u32);
            let same = asked == Some(&(Question::Node(node), answer));
            if same && taped.tape.inputs.get(k) == Some(&input) {
                taped.next = Some((place + 1, list));
                return;
            }
            self.leave_tape();
        }
        let answer = Value(self.nodes.len() as u32);
        if let Some(taped) = &mut self.taped {
            taped.tape.inputs.push(input);
        }
        self.write_node(node, answer);
    }

    /// Records an operation on two values, one of which may be a number that is simplified as most
    /// are: as the tape says, where it is followed and the answer read no other number.
    #[inline]
    pub(super) fn binary_by_tape(
        &mut self,
        op: BinaryOp,
        a: Value,
        b: Value,
        numbers: [Option<f64>; 2],
    ) -> Value {
        let n = self.nodes.len();
        let Some(taped) = self.taped.as_deref_mut() else {
            return self.binary_anew(op, a, b, numbers);
        };
        if let Some((k, list)) = taped.next {
            match taped.tape.questions.get(k) {
                Some(&(Question::Binary(o, x, y, inner), answer)) if (o, x, y) == (op, a, b) => {
                    // mostly one node
                    let end = k + 1 + inner as usize;
                    let within = &taped.tape.questions[k + 1..end];
                    let mut next = n;
                    for &(question, answer) in within {
                        if let Question::Node(node) = question
                            && answer.index() == next
                        {
                            self.nodes.push(node);
                            next += 1;
                        }
                    }
                    taped.next = Some((end, list));
                    return answer;
                }
                Some(&(Question::ByNumbers(o, x, y), _)) if (o, x, y) == (op, a, b) => {
                    taped.next = Some((k + 1, list));
                    return self.binary_anew(op, a, b, numbers);
                }
                _ => self.leave_tape(),
            }
        }
        self.write_binary(op, a, b, numbers)
    }

    /// Records an operation on two values and writes it on the tape.
    fn write_binary(
        &mut self,
        op: BinaryOp,
        a: Value,
        b: Value,
        numbers: [Option<f64>; 2],
    ) -> Value {
        let tape = self.taped.as_deref();
        let before = tape.map_or((0, 0), |t| (t.tape.questions.len(), t.reads));
        self.write_question(Question::ByNumbers(op, a, b), a);
        let answer = self.binary_anew(op, a, b, numbers);
        let (place, reads) = before;
        if let Some(taped) = self.taped.as_deref_mut()
            && taped.reads == reads
        {
            let inner = taped.tape.questions.len() - place - 1;
            let question = Question::Binary(op, a, b, inner as u32);
            taped.tape.questions[place] = (question, answer);
        }
        answer
    }

    /// Tells the tape that an answer reads a number.
    #[inline]
    pub(super) fn reads_number(&mut self) {
        if let Some(taped) = &mut self.taped {
            taped.reads += 1;
        }
    }

    /// Returns what `known` makes of something that was made of the same values at the same place
    /// of the tape.
    fn end_by_tape<T>(
        &self,
        outputs: &[Value],
        mut known: impl FnMut(&mut Made) -> Option<T>,
    ) -> Option<T> {
        let taped = self.taped.as_ref()?;
        let (place, _) = taped.next?;
        let mut ends = taped.tape.ends.borrow_mut();
        let mut alike = (ends.iter_mut()).filter(|e| e.place == place && e.outputs == outputs);
        alike.find_map(|end| known(&mut end.made))
    }

    /// Returns the program that was made of the same values at the same place of the tape, with the
    /// constants of this builder.
    pub(super) fn program_by_tape(
        &self,
        outputs: &[Value],
        layout: Option<&[Input]>,
    ) -> Option<Program> {
        self.end_by_tape(outputs, |made| match made {
            Made::Program {
                layout: of,
                program,
                constants,
            } if of.as_deref() == layout => {
                let numbers = schedule::numbers(self, constants);
                // what the next one may share is likelier that of the last one than of the first
                *program = program.with_constants(numbers, &self.tables);
                Some(program.clone())
            }
            _ => None,
        })
    }

    /// Keeps the program of some values with the tape.
    pub(super) fn keep_program(
        &self,
        outputs: &[Value],
        layout: Option<&[Input]>,
        (program, constants): (&Program, Vec<Value>),
    ) {
        self.keep_end(outputs, || Made::Program {
            layout: layout.map(<[Input]>::to_vec),
            program: program.clone(),
            constants,
        });
    }

    /// Returns how many operations some values took at the same place of the tape; else what
    /// `count` says.
    pub(super) fn count_by_tape(&self, outputs: &[Value], count: impl FnOnce() -> usize) -> usize {
        let known = self.end_by_tape(outputs, |made| match made {
            Made::Count(count) => Some(*count),
            _ => None,
        });
        known.unwrap_or_else(|| {
            let count = count();
            self.keep_end(outputs, || Made::Count(count));
            count
        })
    }

    /// Returns whether nothing in some values depended on time alone at the same place of the tape.
    #[cfg(feature = "solver")]
    pub(super) fn are_untimed_by_tape(&self, outputs: &[Value]) -> bool {
        let untimed = |made: &mut Made| matches!(made, Made::Untimed).then_some(());
        self.end_by_tape(outputs, untimed).is_some()
    }

    /// Keeps with the tape that nothing in some values depends on time alone.
    #[cfg(feature = "solver")]
    pub(super) fn keep_untimed(&self, outputs: &[Value]) {
        self.keep_end(outputs, || Made::Untimed);
    }

    fn keep_end(&self, outputs: &[Value], made: impl FnOnce() -> Made) {
        if let Some(taped) = &self.taped {
            let end = End {
                place: taped.place(),
                outputs: outputs.to_vec(),
                made: made(),
            };
            let mut ends = taped.tape.ends.borrow_mut();
            if ends.len() >= MOST_ENDS {
                ends.remove(0);
            }
            ends.push(end);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::Random;
    use super::*;
    use crate::expr::functions::Function;
    use crate::expr::program::structure::Structures;
    use crate::expr::program::tape::Taped;
    use crate::expr::program::{Comparison, Folding, UnaryOp};

    /// Numbers that fold, that are equal, and that are not.
    const NUMBERS: [f64; 12] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        2.0,
        0.5,
        0.3,
        7.1,
        -0.2,
        1e-310,
        f64::INFINITY,
        f64::NAN,
    ];

    /// Records the operations that `seed` says on some inputs and numbers into a builder; returns a
    /// text of all that it made.
    fn recorded(b: &mut Builder, seed: u64, numbers: &[f64]) -> String {
        let mut random = Random(seed);
        let n_inputs = 1 + random.below(3) as u32;
        let mut values: Vec<Value> = (0..n_inputs).map(|k| b.input(Input::Slot(k))).collect();
        let mut text = String::new();
        for step in 0..60 {
            let [x, y, z, w] = [(); 4].map(|()| {
                let late = values.len().saturating_sub(12);
                values[late + random.below(values.len() - late)]
            });
            let value = match random.below(14) {
                0 => b.unary(UnaryOp::Sin, x),
                1 => b.unary(UnaryOp::Neg, x),
                2 | 3 => b.binary(BinaryOp::Sub, x, y),
                4 => b.binary(BinaryOp::Div, x, y),
                5 => {
                    let condition = b.compare(Comparison::Lt, x, y);
                    b.select(condition, z, w)
                }
                6 => b.call(Function::Step, &[x, y, z, w, x]),
                7 | 8 => b.binary(BinaryOp::Mul, x, y),
                9 => b.arithmetic_if(x, y, z, w),
                10 => b.constant(numbers[random.below(numbers.len())]),
                11 => b.input(Input::Slot(n_inputs + step)),
                _ => b.binary(BinaryOp::Add, x, y),
            };
            values.push(value);
            if step % 20 == 19 {
                let outputs = &values[values.len() - 3..];
                let program = b.finish_with_inputs(outputs, &[Input::Slot(1)]);
                text += &format!("{program} {:?} ", program.inputs());
                text += &format!("{}\n", b.count_operations(outputs));
            }
        }
        format!("{text}{:?} {:?} {:?}", b.nodes, b.arguments, b.inputs)
    }

    fn followed(b: &Builder) -> bool {
        (b.taped.as_ref()).is_some_and(|taped| taped.next.is_some())
    }

    #[test]
    fn what_a_builder_makes_is_the_same_to_the_bit_whatever_its_tape_says() {
        let (mut n_followed, mut n_left) = (0, 0);
        for seed in 0..300 {
            let structures = Structures::default();
            let mut random = Random(seed + 1000);
            for row in 0..8 {
                let numbers = [(); 3].map(|()| NUMBERS[random.below(NUMBERS.len())]);
                // tapes of other recordings, too
                let seed = if random.below(8) == 0 { seed + 1 } else { seed };
                structures.next_generation();
                let looking = structures.look();
                let mut b = Builder::again_or_new(Folding::Structural);
                let by_tape = recorded(&mut b, seed, &numbers);
                let went = followed(&b);
                drop((b, looking));
                let mut alone = Builder::new(Folding::Structural);
                assert_eq!(by_tape, recorded(&mut alone, seed, &numbers), "{seed}");
                (n_followed, n_left) = match (row, went) {
                    (0, _) => (n_followed, n_left),
                    (_, true) => (n_followed + 1, n_left),
                    (_, false) => (n_followed, n_left + 1),
                };
            }
        }
        assert!(n_followed > 100, "{n_followed}");
        assert!(n_left > 100, "{n_left}");
    }

    #[test]
    fn nothing_is_looked_up_while_numbers_fold_and_coincide_as_before() {
        let structures = Structures::default();
        let followed = |numbers: [f64; 2]| {
            structures.next_generation();
            let _looking = structures.look();
            let mut b = Builder::again_or_new(Folding::Structural);
            let [x, y] = [0, 1].map(|k| b.input(Input::Slot(k)));
            let [c, d] = numbers.map(|number| b.constant(number));
            let terms = [(x, c), (y, d)].map(|(x, c)| b.binary(BinaryOp::Mul, x, c));
            b.binary(BinaryOp::Add, terms[0], terms[1]);
            assert_eq!(followed(&b), b.known.probes == 0);
            followed(&b)
        };
        assert!(!followed([0.3, 0.7]));
        assert!(followed([0.7, -5.5]));
        // one node, then two again
        assert!(!followed([0.7, 0.7]));
        assert!(followed([0.4, 0.4]));
        assert!(!followed([0.4, 0.3]));
        // one that folds
        assert!(!followed([0.4, 0.0]));
        assert!(followed([-0.5, 0.0]));
    }

    #[test]
    fn numbers_that_meet_are_read_again() {
        let pairs = [
            [0.3, 7.1],
            [0.4, 5.0],
            [0.5, 2.0],
            [0.4, -2.5],
            [1e-200, 1e-200],
            [-0.3, 0.3],
            [f64::NAN, 2.0],
            [f64::INFINITY, 0.3],
        ];
        let recorded = |b: &mut Builder, numbers: [f64; 2]| {
            let x = b.input(Input::Slot(0));
            let [c, d] = numbers.map(|number| b.constant(number));
            for (inner, outer) in [
                (BinaryOp::Mul, BinaryOp::Mul),
                (BinaryOp::Add, BinaryOp::Add),
                (BinaryOp::Sub, BinaryOp::Add),
                (BinaryOp::Div, BinaryOp::Div),
            ] {
                let within = b.binary(inner, x, c);
                b.binary(outer, within, d);
                b.binary(outer, d, within);
            }
            format!("{:?}", b.nodes)
        };
        for first in pairs {
            for second in pairs {
                let structures = Structures::default();
                for numbers in [first, second] {
                    structures.next_generation();
                    let _looking = structures.look();
                    let by_tape =
                        recorded(&mut Builder::again_or_new(Folding::Structural), numbers);
                    let alone = recorded(&mut Builder::new(Folding::Structural), numbers);
                    assert_eq!(by_tape, alone, "{first:?} {second:?}");
                }
            }
        }
    }

    #[test]
    fn a_recording_that_is_too_long_leaves_no_tape() {
        let structures = Structures::default();
        let mut lengths = Vec::new();
        for n in [10, MOST_QUESTIONS, 10] {
            structures.next_generation();
            let _looking = structures.look();
            let mut b = Builder::again_or_new(Folding::Structural);
            let mut x = b.input(Input::Slot(0));
            for _ in 0..n {
                x = b.unary(UnaryOp::Sin, x);
            }
            let questions = |taped: &Taped| taped.tape.questions.len();
            lengths.push(b.taped.as_deref().map(questions));
            assert_eq!(b.len(), n + 1);
        }
        assert_eq!(lengths, [Some(11), None, Some(11)]);
    }

    #[test]
    fn another_folding_is_no_question_of_the_tape() {
        let structures = Structures::default();
        for _ in 0..3 {
            structures.next_generation();
            let _looking = structures.look();
            let mut b = Builder::again_or_new(Folding::Structural);
            let x = b.input(Input::Slot(0));
            let zero = b.binary(BinaryOp::Sub, x, x);
            b.set_folding(Folding::Strict);
            let difference = b.binary(BinaryOp::Sub, x, x);
            assert_eq!(b.constant_of(zero), Some(0.0));
            assert_eq!(b.constant_of(difference), None);
        }
    }
}
