//! Programs over any number: duals, jets, intervals, values that are recorded.

use super::code::Core;
use super::expand::Expand;
use super::run::{Program, Work};
use crate::scalar::Scalar;

impl Program {
    /// Runs over any number, unchecked as [`Program::run`].
    pub fn eval<S: Scalar>(&self, inputs: &[S], work: &mut Work<S>, out: &mut [S]) {
        let core = match S::CALLS_FUNCTIONS {
            true => self.core(),
            false => self
                .machine
                .core_without_calls(|core| core.expanded(Expand::Calls)),
        };
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
