//! A program parted by what changes: where some of its inputs change often and the others seldom,
//! what depends on the others alone is computed once.
//!
//! ```text
//! y = p(x, z)        s = fixed(x),  y = rest(z, s)        to the bit
//! ```
//!
//! An iteration for unknowns z at a given state x evaluates `rest` alone.

use super::builder::{Builder, Folding};
use super::input::Input;
use super::node::{Node, Value};
use super::run::Program;
use std::ops::Range;

/// A program in two parts.
#[derive(Clone, Debug)]
pub(crate) struct Parted {
    /// reads the inputs of the whole program, and computes what `rest` needs of them   (s)
    pub(crate) fixed: Program,
    /// reads the inputs that change, then what `fixed` has computed; its outputs are the whole's
    pub(crate) rest: Program,
}

impl Program {
    /// Parts the program; `changing`: the positions of the inputs that change.
    pub(crate) fn parted(&self, changing: Range<usize>) -> Parted {
        let mut whole = Builder::new(Folding::Structural);
        let outputs = self.record(&mut whole);
        let changing = &self.inputs()[changing];
        let inputs: Vec<Value> = changing.iter().map(|&i| whole.input(i)).collect();
        let changes = whole.changes(&inputs);
        let needed = whole.read(&outputs, whole.nodes.len());

        // what is read where things change, and does not change itself
        let mut is_read = vec![false; whole.nodes.len()];
        let mut read = |v: Value| {
            let is_constant = matches!(whole.nodes[v.index()], Node::Constant(_));
            is_read[v.index()] |= !changes[v.index()] && !is_constant;
        };
        outputs.iter().for_each(|&v| read(v));
        for k in (0..whole.nodes.len()).filter(|&k| needed[k] && changes[k]) {
            whole.operands(&whole.nodes[k], &mut read);
        }
        let is_read = |k: &usize| is_read[*k];
        let fixed: Vec<Value> = (0..whole.nodes.len())
            .filter(is_read)
            .map(|k| Value(k as u32))
            .collect();

        // the rest, with these as inputs
        let layout: Vec<Input> = (0..(inputs.len() + fixed.len()) as u32)
            .map(Input::Slot)
            .collect();
        let mut part = Builder::new(Folding::Structural);
        part.tables.clone_from(&whole.tables);
        let mut places = vec![Value(u32::MAX); whole.nodes.len()];
        for (&input, v) in layout.iter().zip(inputs.iter().chain(&fixed)) {
            places[v.index()] = part.input(input);
        }
        for k in (0..whole.nodes.len()).filter(|&k| needed[k]) {
            let node = whole.nodes[k];
            let is_constant = matches!(node, Node::Constant(_));
            if !is_constant && (!changes[k] || matches!(node, Node::Input(_))) {
                continue;
            }
            let node = whole.copied(&node, &places, &mut part.arguments);
            places[k] = Value(part.nodes.len() as u32);
            part.nodes.push(node);
        }
        let outputs: Vec<Value> = outputs.iter().map(|v| places[v.index()]).collect();
        Parted {
            fixed: whole.finish_with_inputs(&fixed, self.inputs()),
            rest: part.finish_with_inputs(&outputs, &layout),
        }
    }
}

impl Builder {
    /// Returns which nodes depend on some inputs.
    pub(super) fn changes(&self, inputs: &[Value]) -> Vec<bool> {
        let mut changes = vec![false; self.nodes.len()];
        for v in inputs {
            changes[v.index()] = true;
        }
        for k in 0..self.nodes.len() {
            let mut any = changes[k];
            self.operands(&self.nodes[k], |v| any |= changes[v.index()]);
            changes[k] = any;
        }
        changes
    }
}

#[cfg(test)]
mod tests {
    use super::super::random;
    use super::*;
    use crate::expr::program::Work;

    /// Records operations that `seed` says on six inputs, of which the last two change.
    fn recorded(seed: u64) -> Program {
        let (b, mut values) = random::recorded(seed, 40);
        let outputs = values.split_off(values.len() - 5);
        b.finish_with_inputs(&outputs, &[0, 1, 2, 3, 4, 5].map(Input::Slot))
    }

    #[test]
    fn both_parts_together_are_the_whole_to_the_bit_whatever_changes() {
        let mut saved = 0;
        for seed in 0..300 {
            let program = recorded(seed);
            let Parted { fixed, rest } = program.parted(4..6);
            let (mut whole, mut once, mut again) = (vec![0.0; 5], vec![], vec![0.0; 5]);
            once.resize(fixed.n_outputs(), 0.0);
            let works: &mut [Work; 3] = &mut Default::default();
            for state in 0..3 {
                let x: Vec<f64> = (0..4).map(|k| (f64::from(state * 4 + k)).cos()).collect();
                fixed.run(&[&x[..], &[f64::NAN; 2]].concat(), &mut works[0], &mut once);
                for iteration in 0..4 {
                    let z = [f64::from(iteration) - 1.5, f64::from(iteration) * 0.7];
                    program.run(&[&x[..], &z[..]].concat(), &mut works[1], &mut whole);
                    rest.run(&[&z[..], &once[..]].concat(), &mut works[2], &mut again);
                    // engines agree that there is no number, not on its sign
                    let plain = |y: &f64| (y.is_nan(), if y.is_nan() { 0 } else { y.to_bits() });
                    let [a, b] = [&whole, &again].map(|y| y.iter().map(plain).collect::<Vec<_>>());
                    assert_eq!(a, b, "{seed}: {program}\n{fixed}\n{rest}");
                }
            }
            saved += program.n_operations() - rest.n_operations().min(program.n_operations());
        }
        assert!(saved > 300, "{saved}");
    }
}
