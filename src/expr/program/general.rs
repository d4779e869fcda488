//! Programs over any number: duals, jets, intervals, values that are recorded.

use super::code::Core;
use super::expand::Expand;
use super::run::{Program, Work};
use crate::scalar::Scalar;

/// The instructions of a program that one of its outputs needs.
#[cfg(feature = "solver")]
#[derive(Clone, Debug)]
pub(crate) struct Share {
    instructions: Vec<u32>,
    register: u32,
    /// inputs that it reads: register and place
    inputs: Vec<(u32, u32)>,
}

#[cfg(feature = "solver")]
impl Share {
    /// Returns the places of the inputs that it reads.
    pub fn places(&self) -> impl Iterator<Item = usize> {
        self.inputs.iter().map(|&(_, place)| place as usize)
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

    /// Returns what an output needs of the program as it runs over a number.
    #[cfg(feature = "solver")]
    pub(crate) fn share<S: Scalar>(&self, output: usize) -> Share {
        let core = self.core_over::<S>();
        let register = core.outputs[output];
        let mut needed = vec![false; core.size as usize];
        needed[register as usize] = true;
        let mut instructions = Vec::new();
        // registers hold several values, one after the other
        for (at, instruction) in core.code.iter().enumerate().rev() {
            if std::mem::take(&mut needed[instruction.to as usize]) {
                core.operands(instruction, |r| needed[r as usize] = true);
                instructions.push(at as u32);
            }
        }
        instructions.reverse();
        let first = core.constants.len();
        let all = core.used.iter().enumerate();
        let read = all.filter(|&(k, _)| needed[first + k]);
        Share {
            instructions,
            register,
            inputs: read
                .map(|(k, &place)| ((first + k) as u32, place))
                .collect(),
        }
    }

    /// Evaluates one output as [`Program::eval`] does all. All inputs are given.
    #[cfg(feature = "solver")]
    pub(crate) fn eval_share<S: Scalar>(
        &self,
        share: &Share,
        inputs: &[S],
        work: &mut Work<S>,
    ) -> S {
        let core = self.core_over::<S>();
        if work.owner != self.id {
            self.prepare(core, work);
        }
        let registers = &mut work.registers[..];
        for &(register, place) in &share.inputs {
            registers[register as usize] = inputs[place as usize];
        }
        for &at in &share.instructions {
            core.perform(&core.code[at as usize], registers);
        }
        registers[share.register as usize]
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
