//! Structures of programs: what was made of some nodes serves all nodes that differ from them in
//! their constants alone.
//!
//! The order of a program, its registers, its steps and its code for the processor follow from the
//! kinds of its nodes and from their operands; no decision reads a constant. So a model that is
//! recorded again with other numbers gets programs that are compared instead of made: node by node
//! with those of before, whose shape they take. They are the programs that would have been made, to
//! the last instruction.

use super::builder::{Builder, Folding};
use super::compose;
use super::hashing::HashMap;
use super::input::Input;
use super::node::{self, Node, Value};
use super::run::Program;
use super::schedule;
use super::tape::{Shelf, Taped};
use std::cell::RefCell;
use std::sync::{Arc, Mutex, PoisonError};

/// Structures whose operands are numbered alike, at most: what differs more is made anew.
const MOST_ALIKE: usize = 64;
/// Generations that a structure is kept without being asked for.
const KEPT: u32 = 2;

thread_local! {
    /// where this thread looks for structures
    static PRESENT: RefCell<Option<Structures>> = const { RefCell::new(None) };
}

/// Structures that have been met. Copies share them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Structures(Arc<Mutex<Met>>);

#[derive(Debug, Default)]
struct Met {
    by_hash: HashMap<u64, Vec<Structure>>,
    generation: u32,
    /// tapes of the builders of a generation
    tapes: Shelf,
    /// number of builders that were made in this generation
    n_builders: usize,
}

/// Nodes, what is asked of them, and what was made of them.
#[derive(Debug)]
struct Structure {
    nodes: Vec<Node>,
    arguments: Vec<Value>,
    inputs: Vec<Input>,
    outputs: Vec<Value>,
    layout: Option<Vec<Input>>,
    program: Program,
    /// the nodes that are the constants of the program, in its order
    constants: Vec<Value>,
    /// when it was last asked for
    generation: u32,
}

/// A stretch of time in which a thread looks for structures; its end restores what was before.
pub(crate) struct Looking(Option<Structures>);

impl Drop for Looking {
    fn drop(&mut self) {
        let before = self.0.take();
        PRESENT.with(|present| present.replace(before));
    }
}

impl Structures {
    /// Lets this thread take programs from here, and leave new ones, while the result lives.
    #[must_use]
    pub(crate) fn look(&self) -> Looking {
        Looking(PRESENT.with(|present| present.replace(Some(self.clone()))))
    }

    /// Lets this thread do so unless it looks somewhere else already.
    #[must_use]
    pub(crate) fn look_too(&self) -> Looking {
        let present = PRESENT.with(|present| present.borrow().clone());
        present.unwrap_or_else(|| self.clone()).look()
    }

    /// Begins another generation: what none of the last ones has asked for is forgotten.
    pub(crate) fn next_generation(&self) {
        let mut met = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        met.generation += 1;
        met.n_builders = 0;
        let now = met.generation;
        met.by_hash.retain(|_, alike| {
            alike.retain(|s| s.generation + KEPT >= now);
            !alike.is_empty()
        });
    }
}

/// Returns a tape for the next builder, where this thread looks for structures.
fn tape() -> Option<Taped> {
    let structures = PRESENT.with(|present| present.borrow().clone())?;
    let mut met = structures.0.lock().unwrap_or_else(PoisonError::into_inner);
    let place = met.n_builders;
    met.n_builders += 1;
    Some(met.tapes.take(place))
}

impl Builder {
    /// Makes an empty builder that follows the tape of the one before at its place, where this
    /// thread looks for structures.
    pub(crate) fn again_or_new(folding: Folding) -> Self {
        let mut builder = Self::new(folding);
        builder.taped = tape().map(Box::new);
        builder
    }

    /// Returns the program that computes these values, and nothing else.
    ///
    /// Its inputs are those it needs, in the order in which the builder was asked for them.
    pub fn finish(&self, outputs: &[Value]) -> Program {
        self.finished(outputs, None)
    }

    /// Returns the program as [`Builder::finish`] does, for inputs that the host lays out itself;
    /// what is not needed is not read.
    ///
    /// An input that is needed and missing in `layout` is appended to it: compare
    /// `program.inputs()`.
    pub fn finish_with_inputs(&self, outputs: &[Value], layout: &[Input]) -> Program {
        self.finished(outputs, Some(layout))
    }

    fn finished(&self, outputs: &[Value], layout: Option<&[Input]>) -> Program {
        if let Some(program) = self.program_by_tape(outputs, layout) {
            return program;
        }
        let (program, constants) = match self.reduced(outputs) {
            Some(part) => {
                let (program, constants) = program(&part.builder, &part.values, layout);
                let origin = |v: Value| part.origins[v.index()];
                (program, constants.into_iter().map(origin).collect())
            }
            None => program(self, outputs, layout),
        };
        self.keep_program(outputs, layout, (&program, constants));
        program
    }
}

/// Returns the program that computes `outputs`, with the shape of one that was made before, where
/// there is one; and the nodes that are its constants, in its order.
fn program(
    builder: &Builder,
    outputs: &[Value],
    layout: Option<&[Input]>,
) -> (Program, Vec<Value>) {
    let Some(structures) = PRESENT.with(|present| present.borrow().clone()) else {
        return compose::program(builder, outputs, layout);
    };
    let mut met = structures.0.lock().unwrap_or_else(PoisonError::into_inner);
    let now = met.generation;
    let alike = met
        .by_hash
        .entry(node::hash(&builder.nodes, outputs))
        .or_default();
    if let Some(found) = alike.iter_mut().find(|s| s.is_of(builder, outputs, layout)) {
        found.generation = now;
        let constants = schedule::numbers(builder, &found.constants);
        let mut program = found.program.with_constants(constants, &builder.tables);
        if found.inputs != builder.inputs {
            program = program.with_inputs(found.inputs_of(builder));
            found.inputs.clone_from(&builder.inputs);
        }
        // what the next one may share is likelier that of the last one than of the first
        found.program = program.clone();
        return (program, found.constants.clone());
    }
    let (program, constants) = compose::program(builder, outputs, layout);
    if alike.len() == MOST_ALIKE {
        return (program, constants);
    }
    alike.push(Structure {
        nodes: builder.nodes.clone(),
        arguments: builder.arguments.clone(),
        inputs: builder.inputs.clone(),
        outputs: outputs.to_vec(),
        layout: layout.map(<[Input]>::to_vec),
        program: program.clone(),
        constants: constants.clone(),
        generation: now,
    });
    (program, constants)
}

impl Structure {
    /// Returns whether it was made of nodes that differ in their constants alone; without a layout,
    /// in what their inputs are as well.
    fn is_of(&self, builder: &Builder, outputs: &[Value], layout: Option<&[Input]>) -> bool {
        self.outputs == outputs
            && self.layout.as_deref() == layout
            && (self.inputs == builder.inputs
                || layout.is_none() && self.inputs.len() == builder.inputs.len())
            && self.arguments == builder.arguments
            && self.nodes.len() == builder.nodes.len()
            && self.nodes.iter().zip(&builder.nodes).all(node::is_alike)
    }

    /// Returns the inputs of its program when its nodes read those of `builder`: without a layout
    /// they are the needed ones, in the order in which they were asked for.
    fn inputs_of(&self, builder: &Builder) -> Vec<Input> {
        let mut needed = self.program.inputs().iter().peekable();
        let pairs = self.inputs.iter().zip(&builder.inputs);
        let is_needed = |(of, now): (&Input, &Input)| needed.next_if_eq(&of).map(|_| *now);
        pairs.filter_map(is_needed).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::Random;
    use super::*;
    use crate::expr::functions::Function;
    use crate::expr::program::{BinaryOp, Comparison, Engine, UnaryOp, Work};

    /// Records operations that `seed` says on two inputs and some constants.
    fn recorded(seed: u64, constants: &[f64]) -> (Builder, Vec<Value>) {
        let mut random = Random(seed);
        let mut b = Builder::new(Folding::Structural);
        let mut values: Vec<Value> = (0..2).map(|k| b.input(Input::Slot(k))).collect();
        values.extend(constants.iter().map(|&c| b.constant(c)));
        for _ in 0..30 {
            let [x, y, z, w] = [(); 4].map(|()| values[random.below(values.len())]);
            let value = match random.below(8) {
                0 => b.unary(UnaryOp::Sin, x),
                1 => b.unary(UnaryOp::Neg, x),
                2 => b.binary(BinaryOp::Sub, x, y),
                3 => b.binary(BinaryOp::Div, x, y),
                4 => {
                    let condition = b.compare(Comparison::Lt, x, y);
                    b.select(condition, z, w)
                }
                5 => b.call(Function::Step, &[x, y, z, w, values[0]]),
                6 => b.binary(BinaryOp::Mul, x, y),
                _ => b.binary(BinaryOp::Add, x, y),
            };
            values.push(value);
        }
        let outputs = values.split_off(values.len() - 3);
        (b, outputs)
    }

    fn bits(program: &Program, engine: Option<Engine>) -> Vec<u64> {
        let program = engine.map_or(Some(program.clone()), |e| program.with_engine(e));
        let program = program.expect("an engine that is there");
        let mut out = vec![0.0; program.n_outputs()];
        let mut bits = Vec::new();
        let mut work = Work::default();
        for k in 0..7 {
            let x = f64::from(k) * 0.37 - 1.0;
            program.run(&[x, 1.0 - x * x], &mut work, &mut out);
            // engines agree that there is no number, not on its sign
            let plain = |x: &f64| if x.is_nan() { f64::NAN } else { *x };
            bits.extend(out.iter().map(|x| plain(x).to_bits()));
        }
        bits
    }

    #[test]
    fn a_program_with_a_shape_of_before_is_the_one_made_anew_to_the_bit() {
        let choices = [
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
            f64::NAN,
        ];
        let inputs = [0, 1].map(Input::Slot);
        let mut shared = 0;
        for seed in 0..150 {
            let mut random = Random(seed + 1000);
            let structures = Structures::default();
            for _ in 0..6 {
                let constants = [(); 4].map(|()| choices[random.below(choices.len())]);
                let (builder, outputs) = recorded(seed, &constants);
                let looking = structures.look();
                let program = builder.finish_with_inputs(&outputs, &inputs);
                // twice, so that what is made of it is there for the next one
                let mut here = bits(&program, None);
                for _ in 0..60 {
                    here = bits(&program, None);
                }
                drop(looking);
                let (alone, _) = schedule::program(&builder, &outputs, Some(&inputs));
                let reduced = builder.finish_with_inputs(&outputs, &inputs);
                let text = |p: &Program| format!("{p} {:?}", p.inputs());
                assert_eq!(text(&program), text(&reduced), "{seed}");
                assert_eq!(here, bits(&reduced, Some(Engine::Interpreter)), "{seed}");
                assert_eq!(here, bits(&alone, None), "{seed}");
            }
            let met = structures.0.lock().unwrap();
            shared += 6 - met.by_hash.values().map(Vec::len).sum::<usize>();
        }
        assert!(shared > 50, "{shared} of 900");
    }

    #[test]
    fn a_program_with_other_inputs_is_the_one_made_anew_to_the_bit() {
        for seed in 0..100 {
            let structures = Structures::default();
            for first in [0, 7, 2, 7] {
                let (mut builder, outputs) = recorded(seed, &[2.0, 3.0, 0.3, 0.7]);
                builder.inputs = vec![Input::Slot(first), Input::Slot(first + 1)];
                // some programs read one of the two
                for outputs in [&outputs[..], &outputs[..1]] {
                    let looking = structures.look_too();
                    let program = builder.finish(outputs);
                    drop(looking);
                    let (alone, _) = schedule::program(&builder, outputs, None);
                    assert_eq!(program.inputs(), builder.finish(outputs).inputs(), "{seed}");
                    assert_eq!(program.inputs(), alone.inputs(), "{seed}");
                    assert_eq!(bits(&program, None), bits(&alone, None), "{seed}");
                }
            }
        }
    }

    #[test]
    fn structures_nobody_asks_for_are_forgotten() {
        let structures = Structures::default();
        let (builder, outputs) = recorded(1, &[2.0, 3.0, 0.3, 0.7]);
        let met = || structures.0.lock().unwrap().by_hash.len();
        let looking = structures.look();
        builder.finish(&outputs);
        drop(looking);
        builder.finish(&[outputs[0]]);
        assert_eq!(met(), 1);
        for _ in 0..KEPT {
            structures.next_generation();
            assert_eq!(met(), 1);
        }
        structures.next_generation();
        assert_eq!(met(), 0);
    }
}
