//! The instructions of AVX2 that programs over columns consist of, as bytes: four doubles at once.
//!
//! A function is given the frame (rdi), the addresses of its columns (rsi) and their length in
//! bytes (rdx). It goes through the columns four numbers at a time; rax is how far it is. A slot of
//! the frame is four numbers wide.

/// A vector register, 0 … 15.
pub(super) type Ymm = u8;

/// Where an instruction finds its last operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    Ymm(Ymm),
    /// four numbers of the frame
    Slot(u32),
}

/// Instructions on two operands, by their codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operation {
    Add = 0x58,
    Multiply = 0x59,
    Subtract = 0x5C,
    Divide = 0x5E,
    And = 0x54,
    /// the contrary of the first, and the second
    AndNot = 0x55,
    Or = 0x56,
    Xor = 0x57,
}

/// The relation by which a mask is set; false where a number is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Relation {
    Equal = 0,
    Less = 1,
    LessOrEqual = 2,
}

const ROOT: u8 = 0x51;
const COMPARE: u8 = 0xC2;
const BLEND: u8 = 0x4B;
const LOAD: u8 = 0x10;
const STORE: u8 = 0x11;

/// Which table of codes an instruction belongs to.
#[derive(Clone, Copy)]
enum Map {
    Usual = 1,
    ThreeAndMore = 3,
}

/// The operand that may stand in memory.
#[derive(Clone, Copy)]
enum Last {
    Source(Source),
    /// the column whose address is in rcx
    Column,
}

/// Code in the making.
#[derive(Debug)]
pub(super) struct Packed {
    code: Vec<u8>,
    /// where the loop begins
    top: usize,
}

impl Packed {
    pub(super) fn new() -> Self {
        // rax = 0
        let code = vec![0x31, 0xC0];
        let top = code.len();
        Self { code, top }
    }

    /// Begins the loop; what stands before it is done once.
    pub(super) fn begin_loop(&mut self) {
        self.top = self.code.len();
    }

    /// Ends the loop and the function.
    pub(super) fn finish(mut self) -> Vec<u8> {
        // rax += 32; on while rax < rdx
        self.code.extend([0x48, 0x83, 0xC0, 0x20]);
        self.code.extend([0x48, 0x39, 0xD0, 0x0F, 0x82]);
        let back = (self.top as i64 - (self.code.len() as i64 + 4)) as i32;
        self.code.extend(back.to_le_bytes());
        // vzeroupper, so that what follows need not keep the upper halves; ret
        self.code.extend([0xC5, 0xF8, 0x77, 0xC3]);
        self.code
    }

    /// Emits `to ← a op b`.
    pub(super) fn operate(&mut self, op: Operation, to: Ymm, a: Ymm, b: Source) {
        self.instruction(Map::Usual, op as u8, to, a, Last::Source(b));
    }

    /// Emits `to ← √a`.
    pub(super) fn root(&mut self, to: Ymm, a: Source) {
        self.instruction(Map::Usual, ROOT, to, 0, Last::Source(a));
    }

    /// Sets all bits of `to` where `a` stands so to `b`, else none.
    pub(super) fn compare(&mut self, relation: Relation, to: Ymm, a: Ymm, b: Source) {
        self.instruction(Map::Usual, COMPARE, to, a, Last::Source(b));
        self.code.push(relation as u8);
    }

    /// Emits `to ← yes` where the bits of the mask are set, `no` elsewhere.
    pub(super) fn blend(&mut self, to: Ymm, mask: Ymm, yes: Source, no: Ymm) {
        self.instruction(Map::ThreeAndMore, BLEND, to, no, Last::Source(yes));
        self.code.push(mask << 4);
    }

    pub(super) fn load(&mut self, to: Ymm, from: Source) {
        if from != Source::Ymm(to) {
            self.instruction(Map::Usual, LOAD, to, 0, Last::Source(from));
        }
    }

    pub(super) fn store(&mut self, from: Ymm, slot: u32) {
        let to = Last::Source(Source::Slot(slot));
        self.instruction(Map::Usual, STORE, from, 0, to);
    }

    pub(super) fn load_column(&mut self, to: Ymm, column: u32) {
        self.column(column);
        self.instruction(Map::Usual, LOAD, to, 0, Last::Column);
    }

    pub(super) fn store_column(&mut self, from: Ymm, column: u32) {
        self.column(column);
        self.instruction(Map::Usual, STORE, from, 0, Last::Column);
    }

    /// Emits `rcx ← address of the column`.
    fn column(&mut self, column: u32) {
        self.code.extend([0x48, 0x8B, 0x8E]);
        self.code.extend((8 * column).to_le_bytes());
    }

    /// Emits an instruction on all four numbers; `second` is zero where there is no such operand.
    fn instruction(&mut self, map: Map, code: u8, first: Ymm, second: Ymm, last: Last) {
        let high = |x: Ymm| x >> 3 & 1;
        let last_high = match last {
            Last::Source(Source::Ymm(y)) => high(y),
            _ => 0,
        };
        // the bits of register numbers stand inverted
        self.code.extend([
            0xC4,
            (high(first) ^ 1) << 7 | 1 << 6 | (last_high ^ 1) << 5 | map as u8,
            (!second & 15) << 3 | 0b101,
            code,
        ]);
        let low = (first & 7) << 3;
        match last {
            Last::Source(Source::Ymm(y)) => self.code.push(0xC0 | low | y & 7),
            Last::Source(Source::Slot(slot)) => {
                self.code.push(0x80 | low | 7);
                self.code.extend((32 * slot).to_le_bytes());
            }
            // rcx + rax
            Last::Column => self.code.extend([0x04 | low, 0x01]),
        }
    }
}
