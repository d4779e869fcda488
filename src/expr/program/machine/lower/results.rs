//! The flow of results through straight code: by which instructions each is read, and where it
//! goes.

use super::super::super::code::Core;
use crate::expr::program::hashing::HashMap;

/// Where each instruction puts its result, and by whom that is read.
pub(super) struct Results {
    /// registers, or those of the selections that alone read them
    pub(super) to: Vec<u32>,
    /// by instruction: how often its result is an operand or an output
    pub(super) n_reads: Vec<u32>,
    /// by member of a group: the instructions that yield what it chooses from
    pub(super) chosen: Vec<[Option<u32>; 3]>,
    /// whether an instruction is done by jumps
    pub(super) is_jumped: Vec<bool>,
}

impl Results {
    pub(super) fn of(core: &Core) -> Self {
        let n = core.code.len();
        let mut results = Results {
            to: core.code.iter().map(|instruction| instruction.to).collect(),
            n_reads: vec![0; n],
            chosen: vec![[None; 3]; core.sides.members.len()],
            is_jumped: vec![false; n],
        };
        let mut members: HashMap<u32, usize> = HashMap::default();
        for (k, &member) in core.sides.members.iter().enumerate() {
            members.insert(member, k);
            results.is_jumped[member as usize] = true;
        }
        // by register: the instruction that wrote it last
        let mut writer: Vec<Option<u32>> = vec![None; core.size as usize];
        for (k, instruction) in (0u32..).zip(&core.code) {
            core.operands(instruction, |register| {
                if let Some(writer) = writer[register as usize] {
                    results.n_reads[writer as usize] += 1;
                }
            });
            if let Some(&member) = members.get(&k) {
                for side in 0..instruction.n_sides() {
                    let register = instruction.chosen(side) as usize;
                    results.chosen[member][side as usize] = writer[register];
                }
            }
            writer[instruction.to as usize] = Some(k);
        }
        for &register in &core.outputs {
            if let Some(writer) = writer[register as usize] {
                results.n_reads[writer as usize] += 1;
            }
        }
        results
    }
}
