//! What the operations of the machine do.
//!
//! A handler reads its operands, stores its result in the register it names, and goes on with the next operation. Names of
//! operands: `a`, `b`, `c`, `d` what is read, `to` where the result goes. Handlers are made for each way in which their
//! first operand comes: from a register, or as the result of the operation before (`acc`).

use super::{Handler, Op, Stop, pointer};
use crate::expr::functions::prepared;
use crate::expr::program::Core;
use crate::expr::program::operation::{Comparison, UnaryOp};
use crate::scalar::{Dual, Exponent, Scalar};

/// Arithmetic: code of an operation, so that handlers can be made for each.
pub(super) const ADD: u8 = 0;
pub(super) const SUB: u8 = 1;
/// b − a
pub(super) const BUS: u8 = 2;
pub(super) const MUL: u8 = 3;
pub(super) const DIV: u8 = 4;
/// b/a
pub(super) const VID: u8 = 5;
/// square root of a
pub(super) const SQRT: u8 = 6;
/// magnitude of a
pub(super) const ABS: u8 = 7;

/// −a, 0 or a by the sign of b
pub(super) const ALONG: u8 = 8;

/// Where the first operand, or the last, comes from.
pub(super) const REGISTERS: u8 = 0;
pub(super) const FIRST: u8 = 1;
pub(super) const LAST: u8 = 2;
/// The operand comes from a register; `acc` is added to the result.
pub(super) const ADDED: u8 = 3;

/// No operation (of a selector).
pub(super) const PLAIN: u8 = 9;

#[inline(always)]
fn arithmetic<const OP: u8>(a: f64, b: f64) -> f64 {
    match OP {
        ADD => a + b,
        SUB => a - b,
        BUS => b - a,
        MUL => a * b,
        DIV => a / b,
        VID => b / a,
        SQRT => a.sqrt(),
        ALONG => along(a, b),
        _ => a.abs(),
    }
}

/// −a, 0 or a by the sign of b, without a branch; NaN where b is.
#[inline(always)]
fn along(a: f64, b: f64) -> f64 {
    let signed = f64::from_bits(a.to_bits() ^ (b.to_bits() & (1 << 63)));
    let here = if b == 0.0 { 0.0 } else { signed };
    if b.is_nan() { f64::NAN } else { here }
}

/// Defines handlers: the body sees `o` (operands), `r!(k)` (register k), `frame` (all
/// registers), `inputs`, `acc`, and yields the register of the result and the result.
macro_rules! handlers {
    ($($(#[$meta:meta])* fn $name:ident $(<$(const $p:ident: $t:ty),+>)? ($o:ident, $r:ident, $frame:ident, $inputs:ident, $acc:ident) $body:block)+) => { $(
        $(#[$meta])*
        #[allow(unused_variables)]
        pub(super) unsafe extern "C" fn $name $(<$(const $p: $t),+>)? (
            op: *const Op,
            $frame: *mut f64,
            $inputs: *const f64,
            $acc: f64,
        ) -> Stop {
            // SAFETY: the machine has checked all operands; see the head of its file
            unsafe {
                let $o = &(*op).operands;
                #[allow(unused_macros)]
                macro_rules! $r {
                    ($k:expr) => {
                        *$frame.add($k as usize)
                    };
                }
                let (to, value): (u32, f64) = $body;
                *$frame.add(to as usize) = value;
                let next = op.add(1);
                ((*next).run)(next, $frame, $inputs, value)
            }
        }
    )+ };
}

handlers! {
    /// a op b → to
    fn one<const OP: u8, const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        (o[2], arithmetic::<OP>(a, r!(o[1])))
    }
    /// (a op b) op c → to
    fn two<const P: u8, const Q: u8, const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        let c = if SOURCE == LAST { acc } else { r!(o[2]) };
        (o[3], arithmetic::<Q>(arithmetic::<P>(a, r!(o[1])), c))
    }
    /// ((a op b) op c) op d → to
    fn chain<const P: u8, const Q: u8, const R: u8, const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        let d = if SOURCE == LAST { acc } else { r!(o[3]) };
        (o[4], arithmetic::<R>(arithmetic::<Q>(arithmetic::<P>(a, r!(o[1])), r!(o[2])), d))
    }
    /// (a op b) op (c op d) → to
    fn balanced<const P: u8, const Q: u8, const R: u8, const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        let d = if SOURCE == LAST { acc } else { r!(o[3]) };
        (o[4], arithmetic::<Q>(arithmetic::<P>(a, r!(o[1])), arithmetic::<R>(r!(o[2]), d)))
    }
    /// ((a·b) op e) op (c·d) → to
    fn dot<const P: u8, const Q: u8, const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        let e = if SOURCE == LAST { acc } else { r!(o[4]) };
        (o[5], arithmetic::<Q>(arithmetic::<P>(a * r!(o[1]), e), r!(o[2]) * r!(o[3])))
    }
    /// inputs o[1] … → o[0] …
    fn load<const N: usize>(o, r, frame, inputs, acc) {
        // all are read before any is written: nobody knows that the registers are not the operands
        let (first, numbers): (usize, [usize; N]) = (o[0] as usize, std::array::from_fn(|k| o[1 + k] as usize));
        let values: [f64; N] = numbers.map(|k| *inputs.add(k));
        for (k, &value) in values[..N - 1].iter().enumerate() {
            r!(first + k) = value;
        }
        (o[0] + N as u32 - 1, values[N - 1])
    }
    /// a → to
    fn copy(o, r, frame, inputs, acc) {
        (o[1], r!(o[0]))
    }
    /// the result before → o[1]
    fn keep(o, r, frame, inputs, acc) {
        (o[1], acc)
    }
    /// op(a) → to
    fn unary<const OP: u8, const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        (o[1], unary_op(OP).apply(a))
    }
    /// sin(a) → to, cos(a) → to of the partner
    fn sine_and_cosine<const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        let (sine, cosine) = Scalar::sin_cos(a);
        r!(o[1]) = sine;
        (o[2], cosine)
    }
    /// a < b, a <= b, a = b ? c : d → to
    fn select<const OP: u8>(o, r, frame, inputs, acc) {
        let (yes, no) = (r!(o[2]), r!(o[3]));
        (o[4], if compare::<OP>(r!(o[0]), r!(o[1])) { yes } else { no })
    }
    /// IF(a: b, c, d) → to
    fn arithmetic_if(o, r, frame, inputs, acc) {
        let selector = r!(o[0]);
        let (negative, zero, positive) = (r!(o[1]), r!(o[2]), r!(o[3]));
        let value = if selector < 0.0 {
            negative
        } else if selector > 0.0 {
            positive
        } else if selector == 0.0 {
            zero
        } else {
            f64::NAN
        };
        (o[4], value)
    }
    /// max(a, b) → to; NaN if either is
    fn larger(o, r, frame, inputs, acc) {
        let (a, b) = (r!(o[0]), r!(o[1]));
        (o[2], if a < b { b } else if b <= a { a } else { a + b })
    }
    /// min(a, b) → to; NaN if either is
    fn smaller(o, r, frame, inputs, acc) {
        let (a, b) = (r!(o[0]), r!(o[1]));
        (o[2], if b < a { b } else if a <= b { a } else { a + b })
    }
    /// any instruction of the core
    fn instruction(o, r, frame, inputs, acc) {
        let core: &Core = &*pointer([o[1], o[2]]);
        let instruction = &core.code[o[0] as usize];
        let frame = std::slice::from_raw_parts_mut(frame, core.size as usize);
        core.step(instruction, frame);
        (instruction.to, r!(instruction.to))
    }

    /// STEP of a → o[1]; o[2] and o[3] are place and number of the parameters in all prepared functions of one variable
    fn step<const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        let value = prepared::step3(a, &*frame.add(o[2] as usize).cast());
        (o[1], if SOURCE == ADDED { acc + value } else { value })
    }
    fn step5<const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        let value = prepared::step5(a, &*frame.add(o[2] as usize).cast());
        (o[1], if SOURCE == ADDED { acc + value } else { value })
    }
    fn havsin<const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        let value = prepared::havsin(a, &*frame.add(o[2] as usize).cast());
        (o[1], if SOURCE == ADDED { acc + value } else { value })
    }
    fn poly<const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        let parameters = std::slice::from_raw_parts(frame.add(o[2] as usize), o[3] as usize);
        let value = prepared::poly(a, parameters);
        (o[1], if SOURCE == ADDED { acc + value } else { value })
    }
    fn cheby<const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        let parameters = std::slice::from_raw_parts(frame.add(o[2] as usize), o[3] as usize);
        let value = prepared::cheby(a, parameters);
        (o[1], if SOURCE == ADDED { acc + value } else { value })
    }
    fn forcos<const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        let parameters = std::slice::from_raw_parts(frame.add(o[2] as usize), o[3] as usize);
        let value = prepared::forcos(a, parameters);
        (o[1], if SOURCE == ADDED { acc + value } else { value })
    }
    fn forsin<const SOURCE: u8>(o, r, frame, inputs, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        let parameters = std::slice::from_raw_parts(frame.add(o[2] as usize), o[3] as usize);
        let value = prepared::forsin(a, parameters);
        (o[1], if SOURCE == ADDED { acc + value } else { value })
    }
    /// IMPACT of a, b → to
    fn impact<const EXPONENT: u8>(o, r, frame, inputs, acc) {
        let p: &[f64; 6] = &*frame.add(o[3] as usize).cast();
        (o[2], prepared::impact(r!(o[0]), r!(o[1]), p, exponent::<EXPONENT>(p[5])))
    }
    /// BISTOP of a, b → to
    fn bistop<const EXPONENT: u8>(o, r, frame, inputs, acc) {
        let p: &[f64; 7] = &*frame.add(o[3] as usize).cast();
        (o[2], prepared::bistop(r!(o[0]), r!(o[1]), p, exponent::<EXPONENT>(p[6])))
    }

    /// STEP of a → o[1], its slope → to; o[3] and o[4] are place and number of the parameters
    fn step_slope(o, r, frame, inputs, acc) {
        let v = prepared::step3(variable(r!(o[0])), &*frame.add(o[3] as usize).cast());
        r!(o[1]) = v.re;
        (o[2], v.eps[0])
    }
    fn step5_slope(o, r, frame, inputs, acc) {
        let v = prepared::step5(variable(r!(o[0])), &*frame.add(o[3] as usize).cast());
        r!(o[1]) = v.re;
        (o[2], v.eps[0])
    }
    fn havsin_slope(o, r, frame, inputs, acc) {
        let v = prepared::havsin(variable(r!(o[0])), &*frame.add(o[3] as usize).cast());
        r!(o[1]) = v.re;
        (o[2], v.eps[0])
    }
    fn poly_slope(o, r, frame, inputs, acc) {
        let p = std::slice::from_raw_parts(frame.add(o[3] as usize), o[4] as usize);
        let v = prepared::poly(variable(r!(o[0])), p);
        r!(o[1]) = v.re;
        (o[2], v.eps[0])
    }
    fn cheby_slope(o, r, frame, inputs, acc) {
        let p = std::slice::from_raw_parts(frame.add(o[3] as usize), o[4] as usize);
        let v = prepared::cheby(variable(r!(o[0])), p);
        r!(o[1]) = v.re;
        (o[2], v.eps[0])
    }
    fn forcos_slope(o, r, frame, inputs, acc) {
        let p = std::slice::from_raw_parts(frame.add(o[3] as usize), o[4] as usize);
        let v = prepared::forcos(variable(r!(o[0])), p);
        r!(o[1]) = v.re;
        (o[2], v.eps[0])
    }
    fn forsin_slope(o, r, frame, inputs, acc) {
        let p = std::slice::from_raw_parts(frame.add(o[3] as usize), o[4] as usize);
        let v = prepared::forsin(variable(r!(o[0])), p);
        r!(o[1]) = v.re;
        (o[2], v.eps[0])
    }
    /// IMPACT of a, b → o[2], its slopes → o[3], to
    fn impact_slope<const EXPONENT: u8>(o, r, frame, inputs, acc) {
        let p: &[f64; 6] = &*frame.add(o[5] as usize).cast();
        let (x, x_dot) = (Dual::<2>::variable(r!(o[0]), 0), Dual::variable(r!(o[1]), 1));
        let v = prepared::impact(x, x_dot, p, exponent::<EXPONENT>(p[5]));
        r!(o[2]) = v.re;
        r!(o[3]) = v.eps[0];
        (o[4], v.eps[1])
    }
    /// BISTOP of a, b → o[2], its slopes → o[3], to
    fn bistop_slope<const EXPONENT: u8>(o, r, frame, inputs, acc) {
        let p: &[f64; 7] = &*frame.add(o[5] as usize).cast();
        let (x, x_dot) = (Dual::<2>::variable(r!(o[0]), 0), Dual::variable(r!(o[1]), 1));
        let v = prepared::bistop(x, x_dot, p, exponent::<EXPONENT>(p[6]));
        r!(o[2]) = v.re;
        r!(o[3]) = v.eps[0];
        (o[4], v.eps[1])
    }
}

/// Defines handlers that choose where to go on: the body yields how many operations further that is, and `acc` there.
macro_rules! jumps {
    ($($(#[$meta:meta])* fn $name:ident $(<$(const $p:ident: $t:ty),+>)? ($o:ident, $r:ident, $acc:ident) $body:block)+) => { $(
        $(#[$meta])*
        pub(super) unsafe extern "C" fn $name $(<$(const $p: $t),+>)? (
            op: *const Op,
            frame: *mut f64,
            inputs: *const f64,
            $acc: f64,
        ) -> Stop {
            // SAFETY: the machine has checked all operands; see the head of its file
            unsafe {
                let $o = &(*op).operands;
                #[allow(unused_macros)]
                macro_rules! $r {
                    ($k:expr) => {
                        *frame.add($k as usize)
                    };
                }
                let (distance, acc): (u32, f64) = $body;
                let next = op.add(distance as usize);
                ((*next).run)(next, frame, inputs, acc)
            }
        }
    )+ };
}

jumps! {
    /// the result before → o[1], go to o[2]
    fn leave(o, r, acc) {
        r!(o[1]) = acc;
        (o[2], acc)
    }
    /// go to o[0]
    fn go(o, r, acc) {
        (o[0], acc)
    }
    /// a → o[1], go to o[2]
    fn fetch(o, r, _acc) {
        let value = r!(o[0]);
        r!(o[1]) = value;
        (o[2], value)
    }
    /// on where a < b, a <= b, a = b, else to o[2]
    fn unless<const OP: u8>(o, r, acc) {
        (if compare::<OP>(r!(o[0]), r!(o[1])) { 1 } else { o[2] }, acc)
    }
    /// by the sign of a op b (a where there is no operation): to o[2] where negative, o[3] where zero, o[4] where positive, on
    /// where it is none of them
    fn branch<const OP: u8, const SOURCE: u8>(o, r, acc) {
        let a = if SOURCE == FIRST { acc } else { r!(o[0]) };
        let selector = if OP == PLAIN { a } else { arithmetic::<OP>(a, r!(o[1])) };
        let distance = if selector < 0.0 {
            o[2]
        } else if selector > 0.0 {
            o[4]
        } else if selector == 0.0 {
            o[3]
        } else {
            1
        };
        (distance, acc)
    }
}

/// Ends the code.
pub(super) unsafe extern "C" fn halt(_: *const Op, _: *mut f64, _: *const f64, acc: f64) -> Stop {
    Stop {
        next: std::ptr::null(),
        acc,
    }
}

/// Returns to the loop, which goes on behind it.
pub(super) unsafe extern "C" fn pause(op: *const Op, _: *mut f64, _: *const f64, acc: f64) -> Stop {
    // SAFETY: `halt` stands behind
    Stop {
        next: unsafe { op.add(1) },
        acc,
    }
}

#[inline(always)]
fn variable(x: f64) -> Dual<1> {
    Dual::variable(x, 0)
}

/// Kinds of exponents that have their own handlers.
pub(super) const ONE: u8 = 0;
pub(super) const THREE_HALVES: u8 = 1;
pub(super) const TWO: u8 = 2;
pub(super) const WHOLE_OR_HALF: u8 = 3;
pub(super) const OTHER: u8 = 4;

#[inline(always)]
fn exponent<const KIND: u8>(e: f64) -> Exponent {
    match KIND {
        ONE => Exponent::Whole(1),
        THREE_HALVES => Exponent::Half(1),
        TWO => Exponent::Whole(2),
        WHOLE_OR_HALF => Exponent::of(e),
        _ => Exponent::Other,
    }
}

/// The code of a comparison; 3 asks whether b is a true condition.
pub(super) fn comparison_code(op: Comparison) -> u8 {
    match op {
        Comparison::Lt => 0,
        Comparison::Le => 1,
        Comparison::Eq => 2,
    }
}

#[inline(always)]
fn compare<const OP: u8>(a: f64, b: f64) -> bool {
    match OP {
        0 => a < b,
        1 => a <= b,
        _ => a == b,
    }
}

const UNARY: [UnaryOp; 19] = [
    UnaryOp::Neg,
    UnaryOp::Abs,
    UnaryOp::Sqrt,
    UnaryOp::Sin,
    UnaryOp::Cos,
    UnaryOp::Tan,
    UnaryOp::Asin,
    UnaryOp::Acos,
    UnaryOp::Atan,
    UnaryOp::Sinh,
    UnaryOp::Cosh,
    UnaryOp::Tanh,
    UnaryOp::Exp,
    UnaryOp::Ln,
    UnaryOp::Log10,
    UnaryOp::Trunc,
    UnaryOp::Round,
    UnaryOp::Floor,
    UnaryOp::Not,
];

#[inline(always)]
const fn unary_op(code: u8) -> UnaryOp {
    UNARY[code as usize]
}

/// A table of handlers over one or more codes.
macro_rules! table {
    ($f:ident $s:tt; $($p:literal)+) => { [$(table!(@sources $f $s [$p])),+] };
    ($f:ident $s:tt; $($p:literal)+; $q:tt) => { [$(table!(@two $f $s $p $q)),+] };
    ($f:ident $s:tt; $($p:literal)+; $q:tt; $r:tt) => { [$(table!(@three $f $s $p $q $r)),+] };
    (@two $f:ident $s:tt $p:literal [$($q:literal)+]) => { [$(table!(@sources $f $s [$p $q])),+] };
    (@three $f:ident $s:tt $p:literal [$($q:literal)+] $r:tt) => { [$(table!(@last $f $s $p $q $r)),+] };
    (@last $f:ident $s:tt $p:literal $q:literal [$($r:literal)+]) => { [$(table!(@sources $f $s [$p $q $r])),+] };
    (@sources $f:ident [$($s:ident)+] $codes:tt) => { [$(table!(@source $f $s $codes)),+] };
    (@source $f:ident $s:ident [$p:literal]) => { $f::<$p, $s> };
    (@source $f:ident $s:ident [$p:literal $q:literal]) => { $f::<$p, $q, $s> };
    (@source $f:ident $s:ident [$p:literal $q:literal $r:literal]) => { $f::<$p, $q, $r, $s> };
}

/// By operation and source of the first operand.
pub(super) static ONES: [[Handler; 2]; 9] = table!(one [REGISTERS FIRST]; 0 1 2 3 4 5 6 7 8);
/// By both operations and source.
pub(super) static TWOS: [[[Handler; 3]; 9]; 9] =
    table!(two [REGISTERS FIRST LAST]; 0 1 2 3 4 5 6 7 8; [0 1 2 3 4 5 6 7 8]);
/// By three operations (the quotients left out) and source.
pub(super) static CHAINS: [[[[Handler; 3]; 7]; 7]; 7] =
    table!(chain [REGISTERS FIRST LAST]; 0 1 2 3 6 7 8; [0 1 2 3 6 7 8]; [0 1 2 3 6 7 8]);
/// By three operations (sums, differences, products) and source.
pub(super) static BALANCED: [[[[Handler; 3]; 4]; 4]; 4] =
    table!(balanced [REGISTERS FIRST LAST]; 0 1 2 3; [0 1 2 3]; [0 1 2 3]);
/// By the two sums and source.
pub(super) static DOTS: [[[Handler; 3]; 3]; 3] = table!(dot [REGISTERS FIRST LAST]; 0 1 2; [0 1 2]);
/// By operation of the selector (the last: none) and source.
pub(super) static BRANCHES: [[Handler; 2]; 7] = table!(branch [REGISTERS FIRST]; 0 1 2 3 4 5 9);
/// By number of inputs less one.
pub(super) static LOADS: [Handler; 5] = [load::<1>, load::<2>, load::<3>, load::<4>, load::<5>];
/// By operation and source.
static UNARIES: [[Handler; 2]; 19] =
    table!(unary [REGISTERS FIRST]; 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18);

/// The handler of an operation on one number.
pub(super) fn unary_handler(op: UnaryOp, source: u8) -> Handler {
    let code = UNARY.iter().position(|&u| u == op).unwrap_or(0);
    UNARIES[code][source as usize]
}
