//! Programs over any number: duals, jets, intervals, values that are recorded.

use super::code::Core;
use super::expand::Expand;
use super::run::{Program, Work};
#[cfg(feature = "solver")]
use super::{code::Instruction, compose::moved};
use crate::scalar::Scalar;

/// Some outputs of a program, evaluated again and again: only what reads something that has changed
/// since is done again.
///
/// Each instruction has a register of its own, so that results last.
#[cfg(feature = "solver")]
#[derive(Clone, Debug)]
pub(crate) struct Share<S> {
    instructions: Vec<Instruction>,
    registers: Vec<S>,
    outputs: Vec<u32>,
    /// inputs that it reads: register and place
    inputs: Vec<(u32, u32)>,
    /// which of them changed the last time   (inputs)
    changed: Vec<bool>,
    /// the instructions that this concerns
    stale: Vec<u32>,
    /// whether what is in a register is among that   (registers)
    is_stale: Vec<bool>,
}

#[cfg(feature = "solver")]
impl<S: Scalar + PartialEq> Share<S> {
    /// Takes what some outputs need of a program.
    pub fn of(program: &Program, outputs: &[usize]) -> Self {
        debug_assert!(
            !S::CALLS_FUNCTIONS,
            "arguments of calls stay where they are"
        );
        let core = program.core_over::<S>();
        let outputs: Vec<u32> = outputs.iter().map(|&k| core.outputs[k]).collect();
        let mut needed = vec![false; core.size as usize];
        outputs.iter().for_each(|&r| needed[r as usize] = true);
        let mut instructions = Vec::new();
        // registers of a program hold several values, one after the other
        for instruction in core.code.iter().rev() {
            if std::mem::take(&mut needed[instruction.to as usize]) {
                core.operands(instruction, |r| needed[r as usize] = true);
                instructions.push(*instruction);
            }
        }
        instructions.reverse();
        // what is needed still is there at the beginning: constants, then inputs
        let first = core.constants.len();
        let mut places = vec![0; core.size as usize];
        let (mut registers, mut inputs) = (Vec::new(), Vec::new());
        for at in (0..places.len()).filter(|&at| needed[at]) {
            places[at] = registers.len() as u32;
            let constant = core.constants.get(at);
            registers.push(S::constant(constant.copied().unwrap_or(f64::NAN)));
            if constant.is_none() {
                inputs.push((places[at], core.used[at - first]));
            }
        }
        for instruction in &mut instructions {
            let (to, alone) = (instruction.to as usize, registers.len() as u32);
            *instruction = Instruction {
                to: alone,
                ..moved(instruction, &places, 0)
            };
            places[to] = alone;
            registers.push(S::constant(f64::NAN));
        }
        Self {
            outputs: outputs.iter().map(|&r| places[r as usize]).collect(),
            changed: vec![true; inputs.len()],
            stale: (0..instructions.len() as u32).collect(),
            is_stale: vec![false; registers.len()],
            instructions,
            registers,
            inputs,
        }
    }

    /// Returns the places of the inputs that it reads.
    pub fn places(&self) -> impl Iterator<Item = usize> {
        self.inputs.iter().map(|&(_, place)| place as usize)
    }

    /// Evaluates its outputs as [`Program::eval`] of its program does. All inputs are given.
    pub fn run(&mut self, program: &Program, inputs: &[S], out: &mut [S]) {
        let core = program.core_over::<S>();
        let mut as_before = true;
        for (&(register, place), changed) in self.inputs.iter().zip(&mut self.changed) {
            let new = inputs[place as usize];
            let old = std::mem::replace(&mut self.registers[register as usize], new);
            // no number is the same as another that is none
            let changes = old != new;
            as_before &= changes == *changed;
            *changed = changes;
        }
        if !as_before {
            self.find_stale(core);
        }
        for &at in &self.stale {
            core.perform(&self.instructions[at as usize], &mut self.registers);
        }
        for (out, &r) in out.iter_mut().zip(&self.outputs) {
            *out = self.registers[r as usize];
        }
    }

    /// Finds the instructions that read what has changed.
    fn find_stale(&mut self, core: &Core) {
        for (&(register, _), &changed) in self.inputs.iter().zip(&self.changed) {
            self.is_stale[register as usize] = changed;
        }
        self.stale.clear();
        for (at, instruction) in self.instructions.iter().enumerate() {
            let mut is_stale = false;
            core.operands(instruction, |r| is_stale |= self.is_stale[r as usize]);
            self.is_stale[instruction.to as usize] = is_stale;
            if is_stale {
                self.stale.push(at as u32);
            }
        }
    }
}

impl Program {
    /// Runs over any number, unchecked as [`Program::run`].
    pub fn eval<S: Scalar>(&self, inputs: &[S], work: &mut Work<S>, out: &mut [S]) {
        let core = self.core_over::<S>();
        let registers = self.registers(core, inputs, work);
        for instruction in &core.code {
            core.perform(instruction, registers);
        }
        for (out, &r) in out.iter_mut().zip(&core.outputs) {
            *out = registers[r as usize];
        }
        if out.len() > core.outputs.len() {
            out[core.outputs.len()..].fill(S::constant(f64::NAN));
        }
    }

    /// Returns the code that runs over a number.
    fn core_over<S: Scalar>(&self) -> &Core {
        match S::CALLS_FUNCTIONS {
            true => self.core(),
            false => self
                .machine
                .core_without_calls(|core| core.expanded(Expand::Calls)),
        }
    }

    /// Returns the registers with constants and inputs in their places.
    fn registers<'a, S: Scalar>(
        &self,
        core: &Core,
        inputs: &[S],
        work: &'a mut Work<S>,
    ) -> &'a mut [S] {
        let padded;
        let inputs = if inputs.len() < self.inputs.len() {
            padded = self.padded(inputs, S::constant(f64::NAN));
            &padded
        } else {
            inputs
        };
        if work.owner != self.id {
            self.prepare(core, work);
        }
        let registers = &mut work.registers[..];
        for (register, &k) in registers[core.constants.len()..].iter_mut().zip(&core.used) {
            *register = inputs[k as usize];
        }
        registers
    }

    /// Lays out the registers for this program.
    #[cold]
    fn prepare<S: Scalar>(&self, core: &Core, work: &mut Work<S>) {
        // whatever happens here, these registers belong to nobody until they are complete
        work.owner = 0;
        work.registers.clear();
        work.registers
            .extend(core.constants.iter().map(|&c| S::constant(c)));
        work.registers
            .resize(core.size as usize, S::constant(f64::NAN));
        work.owner = self.id;
    }
}

#[cfg(all(test, feature = "solver"))]
mod tests {
    use super::*;
    use crate::expr::program::{BinaryOp, Builder, Folding, Input, UnaryOp};
    use crate::scalar::{Dual, Interval};

    #[test]
    fn outputs_of_which_only_some_inputs_have_changed_are_those_of_the_whole_program() {
        let mut builder = Builder::new(Folding::Strict);
        let [x, y, z] = [0, 1, 2].map(|k| builder.input(Input::Slot(k)));
        let sine = builder.unary(UnaryOp::Sin, x);
        let product = builder.binary(BinaryOp::Mul, sine, y);
        let root = builder.unary(UnaryOp::Sqrt, z);
        let sum = builder.binary(BinaryOp::Add, product, root);
        let two = builder.constant(2.0);
        let program = builder.finish(&[product, sum, z, two]);
        let (mut all, mut one) = (
            Share::of(&program, &[0, 1, 2, 3]),
            Share::of(&program, &[1]),
        );
        assert_eq!(one.places().collect::<Vec<_>>(), [0, 1, 2]);
        assert_eq!(Share::<Dual<1>>::of(&program, &[0]).places().count(), 2);
        let bounds = |of: f64| Dual {
            re: Interval::between(of, of + 0.5),
            eps: [Interval::between(-of, 1.0)],
        };
        let (mut inputs, mut work) = ([1.0, 2.0, 3.0].map(bounds), Work::default());
        for k in 0..64u32 {
            // all sets of inputs after each other
            for (i, input) in inputs.iter_mut().enumerate() {
                if ((k ^ (k / 8)) >> i) & 1 == 1 {
                    *input = bounds(0.1 * f64::from(k));
                }
            }
            let [mut whole, mut again] = [[Dual::constant(f64::NAN); 4]; 2];
            program.eval(&inputs, &mut work, &mut whole);
            all.run(&program, &inputs, &mut again);
            assert_eq!(whole, again, "{k}");
            one.run(&program, &inputs, &mut again);
            assert_eq!(whole[1], again[0], "{k}");
        }
    }
}
