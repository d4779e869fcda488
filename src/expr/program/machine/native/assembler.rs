//! The instructions of x86-64 that translated programs consist of, as bytes.
//!
//! Numbers are doubles in the low halves of the sixteen vector registers, or stand in the frame;
//! the arithmetic is that of SSE2, which every processor of this kind has and which the compiler
//! uses for the same operations: the bits are the same. AVX has the same instructions with a place
//! of its own for the result, which saves copies.

/// A vector register, 0 … 15.
pub(super) type Xmm = u8;

/// Where an instruction finds its second operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Xmm(Xmm),
    /// a register of the frame
    Slot(u32),
    /// a number among the inputs, which are lost with the first call
    Input(u32),
    /// an output
    Output(u32),
}

/// Instructions on doubles: prefix and code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Instruction(u8, u8);

pub(super) const LOAD: Instruction = Instruction(0xF2, 0x10);
pub(super) const ADD: Instruction = Instruction(0xF2, 0x58);
pub(super) const MULTIPLY: Instruction = Instruction(0xF2, 0x59);
pub(super) const SUBTRACT: Instruction = Instruction(0xF2, 0x5C);
pub(super) const DIVIDE: Instruction = Instruction(0xF2, 0x5E);
pub(super) const ROOT: Instruction = Instruction(0xF2, 0x51);
/// flags: carry where below, zero where equal, all where not ordered
pub(super) const COMPARE: Instruction = Instruction(0x66, 0x2E);
const STORE: Instruction = Instruction(0xF2, 0x11);
const MASK: Instruction = Instruction(0xF2, 0xC2);
const ONES: Instruction = Instruction(0x66, 0x76);
const SHIFT: Instruction = Instruction(0x66, 0x73);

/// Bitwise, between registers only: operands in memory would have to be aligned.
pub(super) const AND: Instruction = Instruction(0x66, 0x54);
/// the contrary of the first, and the second
pub(super) const AND_NOT: Instruction = Instruction(0x66, 0x55);
pub(super) const OR: Instruction = Instruction(0x66, 0x56);
pub(super) const XOR: Instruction = Instruction(0x66, 0x57);

/// The relation by which a mask is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Relation {
    Equal = 0,
    Less = 1,
    LessOrEqual = 2,
    Unordered = 3,
    NotEqual = 4,
}

/// When a jump is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum When {
    Always,
    Below,
    BelowOrEqual,
    Above,
    NotEqual,
    Unordered,
}

/// The registers for addresses: inputs; frame and outputs in a function without calls and in one
/// with calls.
const RSI: u8 = 6;
const RDI: u8 = 7;
const RDX: u8 = 2;
const RBX: u8 = 3;
const RBP: u8 = 5;

/// Length of the code of a step, about.
const BYTES_PER_STEP: usize = 20;

/// A jump whose distance is not known yet: the place of the distance in the code.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jump(usize);

/// Code in the making.
#[derive(Debug)]
pub(super) struct Assembler {
    code: Vec<u8>,
    calls: bool,
}

impl Assembler {
    /// Begins a function of so many steps that is given the frame, the inputs and a place for the
    /// outputs.
    pub(super) fn new(calls: bool, n_steps: usize) -> Self {
        let mut code = Vec::with_capacity(BYTES_PER_STEP * n_steps);
        if calls {
            // push rbx, rbp, rax (that aligns the stack); rbx = rdi; rbp = rdx
            code.extend([0x53, 0x55, 0x50, 0x48, 0x89, 0xFB, 0x48, 0x89, 0xD5]);
        }
        Self { code, calls }
    }

    /// Ends it; returns the code of the function, whose result is in the vector register 0.
    pub(super) fn finish(mut self) -> Vec<u8> {
        if self.calls {
            // pop rcx, rbp, rbx
            self.code.extend([0x59, 0x5D, 0x5B]);
        }
        self.code.push(0xC3);
        self.code
    }

    /// Emits `x ← x op place`.
    pub(super) fn operate(&mut self, op: Instruction, x: Xmm, place: Place) {
        self.code.push(op.0);
        self.operands(op.1, x, place);
    }

    /// Emits `x ← a op place`, by AVX.
    pub(super) fn operate_on(&mut self, op: Instruction, x: Xmm, a: Xmm, place: Place) {
        // the bits of register numbers stand inverted; 3 is the prefix F2
        let high = (x >> 3 ^ 1) << 7;
        let rest = (!a & 15) << 3 | 3;
        match place {
            Place::Xmm(y) if y >= 8 => self.code.extend([0xC4, high | 1 << 6 | 1, rest]),
            _ => self.code.extend([0xC5, high | rest]),
        }
        self.code.push(op.1);
        self.address(x & 7, place);
    }

    /// Sets all bits of `x` where `a` stands so to `place`, else none; by AVX.
    pub(super) fn mask_on(&mut self, x: Xmm, relation: Relation, a: Xmm, place: Place) {
        self.operate_on(MASK, x, a, place);
        self.code.push(relation as u8);
    }

    /// Emits `x ← yes` where the bits of the mask are set, `no` elsewhere; by AVX.
    pub(super) fn blend(&mut self, x: Xmm, mask: Xmm, yes: Xmm, no: Xmm) {
        // the bits of register numbers stand inverted; 3 is the table of codes, 1 the prefix 66
        let high = (x >> 3 ^ 1) << 7 | 1 << 6 | (yes >> 3 ^ 1) << 5;
        let rest = (!no & 15) << 3 | 1;
        self.code.extend([0xC4, high | 3, rest, 0x4B]);
        self.address(x & 7, Place::Xmm(yes));
        self.code.push(mask << 4);
    }

    /// Emits `x ← y`, all of it.
    pub(super) fn copy(&mut self, x: Xmm, y: Xmm) {
        self.operands(0x28, x, Place::Xmm(y));
    }

    pub(super) fn load(&mut self, x: Xmm, place: Place) {
        match place {
            Place::Xmm(y) if y == x => {}
            Place::Xmm(y) => self.copy(x, y),
            _ => self.operate(LOAD, x, place),
        }
    }

    /// Stores a number in memory.
    pub(super) fn store(&mut self, x: Xmm, place: Place) {
        self.operate(STORE, x, place);
    }

    /// Sets all bits of `x` where it stands so to `place`, else none.
    pub(super) fn mask(&mut self, x: Xmm, relation: Relation, place: Place) {
        self.operate(MASK, x, place);
        self.code.push(relation as u8);
    }

    /// Sets the bit of the sign alone.
    pub(super) fn sign_bit(&mut self, x: Xmm) {
        self.operate(ONES, x, Place::Xmm(x));
        self.operate(SHIFT, 6, Place::Xmm(x));
        self.code.push(63);
    }

    /// Sets all bits but that of the sign.
    pub(super) fn all_but_sign_bit(&mut self, x: Xmm) {
        self.operate(ONES, x, Place::Xmm(x));
        self.operate(SHIFT, 2, Place::Xmm(x));
        self.code.push(1);
    }

    /// Jumps somewhere; [`Assembler::lands`] says where.
    pub(super) fn jump(&mut self, when: When) -> Jump {
        match when {
            When::Always => self.code.push(0xE9),
            When::Below => self.code.extend([0x0F, 0x82]),
            When::BelowOrEqual => self.code.extend([0x0F, 0x86]),
            When::Above => self.code.extend([0x0F, 0x87]),
            When::NotEqual => self.code.extend([0x0F, 0x85]),
            When::Unordered => self.code.extend([0x0F, 0x8A]),
        }
        self.code.extend([0; 4]);
        Jump(self.code.len())
    }

    /// Lets a jump lead here.
    pub(super) fn lands(&mut self, jump: Jump) {
        let distance = (self.code.len() - jump.0) as u32;
        self.code[jump.0 - 4..jump.0].copy_from_slice(&distance.to_le_bytes());
    }

    /// Calls a function of numbers, which are in the first vector registers. All vector registers
    /// are lost, but for results.
    pub(super) fn call(&mut self, function: usize) {
        debug_assert!(self.calls, "the frame must survive the call");
        // rax = function; call rax
        self.code.extend([0x48, 0xB8]);
        self.code.extend((function as u64).to_le_bytes());
        self.code.extend([0xFF, 0xD0]);
    }

    /// Calls a function with an address and the frame. All vector registers are lost.
    pub(super) fn call_with_frame(&mut self, function: usize, argument: usize) {
        // rdi = argument; rsi = rbx
        self.code.extend([0x48, 0xBF]);
        self.code.extend((argument as u64).to_le_bytes());
        self.code.extend([0x48, 0x89, 0xDE]);
        self.call(function);
    }

    /// Emits the rest of an instruction: extension of register numbers, code, operands.
    fn operands(&mut self, code: u8, x: Xmm, place: Place) {
        let last_high = match place {
            Place::Xmm(y) => y >> 3,
            _ => 0,
        };
        let extension = x >> 3 << 2 | last_high;
        if extension != 0 {
            self.code.push(0x40 | extension);
        }
        self.code.extend([0x0F, code]);
        self.address(x & 7, place);
    }

    /// Emits the low bits of a register number, and a place.
    fn address(&mut self, low: u8, place: Place) {
        let (base, number) = match place {
            Place::Xmm(y) => {
                self.code.push(0xC0 | low << 3 | (y & 7));
                return;
            }
            Place::Slot(k) if self.calls => (RBX, k),
            Place::Slot(k) => (RDI, k),
            Place::Input(k) => (RSI, k),
            Place::Output(k) if self.calls => (RBP, k),
            Place::Output(k) => (RDX, k),
        };
        let distance = 8 * number;
        if distance < 128 {
            self.code.extend([0x40 | low << 3 | base, distance as u8]);
        } else {
            self.code.push(0x80 | low << 3 | base);
            self.code.extend(distance.to_le_bytes());
        }
    }
}
