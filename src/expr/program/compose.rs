//! From components to one program: the code of those that are alike is made once, and stands in the
//! straight code once for each.
//!
//! ```text
//! registers   constants of all | inputs | temporaries that all share | results of each
//! ```
//!
//! Straight code is what other numbers run over and what is made of a program. Plain numbers go
//! through the code of each kind, member by member ([`Alike`]).

use super::builder::Builder;
use super::code::{Code, Core, Instruction, Mark, Shape};
use super::components::{Kind, Member, Target};
use super::hashing::HashMap;
use super::input::Input;
use super::machine::{Alike, KindOfCode};
use super::node::{Node, Value};
use super::run::Program;
use super::schedule;
use std::sync::Arc;

/// Components of a kind from which on they are run by themselves: with fewer there is little to
/// share, and sines of one are no longer found together with those of another.
const FEWEST: usize = 4;

/// Returns the program that computes `outputs`, and the nodes that its constants are.
pub(super) fn program(
    builder: &Builder,
    outputs: &[Value],
    layout: Option<&[Input]>,
) -> (Program, Vec<Value>) {
    match builder.components(outputs, FEWEST) {
        Some(kinds) => composed(builder, outputs, layout, &kinds),
        None => schedule::program(builder, outputs, layout),
    }
}

/// A kind and the code of one of its members.
struct Made<'a> {
    kind: &'a Kind,
    core: Core,
    /// by constant of the code: its number among those of a member
    constants: Vec<u32>,
    /// by input of the code: its number among those of a member
    inputs: Vec<u32>,
    /// registers of its results, ascending
    results: Vec<u32>,
}

impl<'a> Made<'a> {
    fn new(kind: &'a Kind) -> Self {
        let (inputs, core, constants) = schedule::core(&kind.builder, &kind.results, None);
        let number = |v| kind.constants.partition_point(|c| c < v) as u32;
        let mut results = core.outputs.clone();
        results.sort_unstable();
        results.dedup();
        Self {
            kind,
            constants: constants.iter().map(number).collect(),
            inputs: (inputs.iter())
                .map(|input| match *input {
                    Input::Slot(k) => k,
                    _ => unreachable!("a component reads slots"),
                })
                .collect(),
            results,
            core,
        }
    }

    fn first_temporary(&self) -> usize {
        self.constants.len() + self.inputs.len()
    }

    /// Returns the nodes of the recording that the constants of a member are.
    fn constants_of(&self, member: &'a Member) -> impl Iterator<Item = Value> {
        let numbers = self.constants.iter();
        numbers.map(|&k| member.constants[k as usize])
    }

    fn inputs_of(&self, member: &'a Member) -> impl Iterator<Item = Value> {
        let numbers = self.inputs.iter();
        numbers.map(|&k| member.inputs[k as usize])
    }
}

/// Where everything stands in the straight code of all.
struct Composition<'a> {
    builder: &'a Builder,
    /// register of each node that others read: constants, inputs, results that the last piece reads
    registers: HashMap<Value, u32>,
    shape: Shape,
    /// first of the temporaries that all share
    first_temporary: u32,
    /// registers of the outputs, by their positions
    outputs: Vec<u32>,
}

fn composed(
    builder: &Builder,
    outputs: &[Value],
    layout: Option<&[Input]>,
    kinds: &[Kind],
) -> (Program, Vec<Value>) {
    let all: Vec<Made<'_>> = kinds.iter().map(Made::new).collect();
    let members = || {
        all.iter()
            .flat_map(|m| m.kind.members.iter().map(move |member| (m, member)))
    };
    let mut registers = HashMap::default();
    let (mut constants, mut needed) = (Vec::new(), Vec::new());
    let read = members().flat_map(|(m, member)| m.constants_of(member).chain(m.inputs_of(member)));
    for v in read.chain(outputs.iter().copied()) {
        match builder.nodes[v.index()] {
            Node::Constant(_) => {
                registers.entry(v).or_insert_with(|| {
                    constants.push(v);
                    constants.len() as u32 - 1
                });
            }
            Node::Input(input) => {
                registers.entry(v).or_insert_with(|| {
                    needed.push((input, v));
                    0
                });
            }
            _ => {}
        }
    }
    let (inputs, used) = schedule::supplied(builder, &mut needed, layout);
    for (register, &(_, v)) in (constants.len() as u32..).zip(&needed) {
        registers.insert(v, register);
    }
    let n_before = constants.len() + used.len();
    let n_shared = all
        .iter()
        .map(|m| m.core.size as usize - m.first_temporary());
    let mut composition = Composition {
        builder,
        registers,
        shape: Shape {
            size: (n_before + n_shared.max().unwrap_or(0)) as u32,
            ..Shape::default()
        },
        first_temporary: n_before as u32,
        outputs: vec![0; outputs.len()],
    };
    for (made, member) in members() {
        composition.add(made, member);
    }
    composition.outputs_without_operations(outputs);
    let core = Core {
        constants: schedule::numbers(builder, &constants),
        tables: builder.tables.clone(),
        shape: Arc::new(Shape {
            n_inputs: inputs.len(),
            used,
            outputs: std::mem::take(&mut composition.outputs),
            ..composition.shape
        }),
    };
    let alike = alike(&all, &core, &composition.registers);
    (Program::of_components(inputs, core, alike), constants)
}

impl Composition<'_> {
    /// Puts outputs where they stand that are constants or inputs.
    fn outputs_without_operations(&mut self, outputs: &[Value]) {
        for (to, v) in self.outputs.iter_mut().zip(outputs) {
            if let Node::Constant(_) | Node::Input(_) = self.builder.nodes[v.index()] {
                *to = self.registers[v];
            }
        }
    }

    /// Adds the code of a member.
    fn add(&mut self, made: &Made<'_>, member: &Member) {
        let core = &made.core;
        let mut to: Vec<u32> = made
            .constants_of(member)
            .map(|v| self.registers[&v])
            .collect();
        to.extend(made.inputs_of(member).map(|v| self.registers[&v]));
        let n_temporaries = core.size - made.first_temporary() as u32;
        to.extend(self.first_temporary..self.first_temporary + n_temporaries);
        for &r in &made.results {
            to[r as usize] = self.shape.size;
            self.shape.size += 1;
        }
        for (&r, target) in core.outputs.iter().zip(&member.targets) {
            match *target {
                Target::Output(k) => self.outputs[k as usize] = to[r as usize],
                Target::Last(v) => {
                    self.registers.insert(v, to[r as usize]);
                }
            }
        }
        let shape = &mut self.shape;
        let [n_code, n_lists] = [shape.code.len(), shape.lists.len()].map(|n| n as u32);
        shape
            .lists
            .extend(core.lists.iter().map(|&r| to[r as usize]));
        shape
            .code
            .extend(core.code.iter().map(|i| moved(i, &to, n_lists)));
        let sides = &mut shape.sides;
        let (n_groups, n_members) = (sides.groups.len(), sides.members.len());
        sides.marks.extend(core.sides.marks.iter().map(|mark| Mark {
            at: mark.at + n_code,
            group: mark.group + n_groups as u32,
            ..*mark
        }));
        let groups = core.sides.groups.iter();
        sides
            .groups
            .extend(groups.map(|g| g.start + n_members..g.end + n_members));
        sides
            .members
            .extend(core.sides.members.iter().map(|k| k + n_code));
    }
}

/// Returns an instruction with its registers moved, its arguments behind so many others.
pub(super) fn moved(instruction: &Instruction, to: &[u32], n_lists: u32) -> Instruction {
    let at = |r: u32| to[r as usize];
    let mut moved = Instruction {
        to: at(instruction.to),
        ..*instruction
    };
    let operands = [&mut moved.a, &mut moved.b, &mut moved.c, &mut moved.d];
    let n = match instruction.code {
        Code::Unary(_) | Code::Whole(_) | Code::Lookup { .. } => 1,
        Code::Binary(_) | Code::Compare(_) => 2,
        Code::HalfPower(_) | Code::Select => 3,
        Code::CompareSelect(_) | Code::If => 4,
        Code::Call(..) | Code::Partial(..) => 0,
    };
    operands.into_iter().take(n).for_each(|r| *r = at(*r));
    if n == 0 {
        moved.a += n_lists;
    }
    moved
}

/// Returns what plain numbers run through: the code of each kind, and where its members stand.
fn alike<'a>(all: &'a [Made<'a>], core: &Core, registers: &HashMap<Value, u32>) -> Alike {
    let n_constants = core.constants.len();
    let targets = all
        .iter()
        .flat_map(|m| &m.kind.members)
        .flat_map(|m| &m.targets);
    let read_last = targets.filter_map(|target| match *target {
        Target::Last(v) => Some(v),
        Target::Output(_) => None,
    });
    let between: HashMap<Value, u32> = read_last.zip(0..).collect();
    let input = |v: &Value| match between.get(v) {
        Some(k) => core.n_inputs as u32 + k,
        None => core.used[registers[v] as usize - n_constants],
    };
    let target = |target: &Target| match *target {
        Target::Output(k) => between.len() as u32 + k,
        Target::Last(v) => between[&v],
    };
    let kind = |made: &'a Made<'a>| {
        let members = || made.kind.members.iter();
        let constants = members()
            .flat_map(|m| made.constants_of(m))
            .map(|v| registers[&v]);
        KindOfCode {
            core: &made.core,
            constants: constants.collect(),
            inputs: members()
                .flat_map(|m| made.inputs_of(m))
                .map(|v| input(&v))
                .collect(),
            targets: members()
                .flat_map(|m| m.targets.iter().map(target))
                .collect(),
        }
    };
    Alike::new(all.iter().map(kind), between.len(), core)
}

#[cfg(test)]
mod tests {
    use super::super::random::Random;
    use super::super::{BinaryOp, Comparison, Engine, Folding, UnaryOp, Work};
    use super::*;
    use crate::expr::functions::Function;
    use crate::scalar::{Dual, Scalar};

    /// Records operations that `seed` says on three inputs from `first` on, the time and some
    /// constants.
    fn mechanism(b: &mut Builder, seed: u64, first: u32, constants: &[f64]) -> Vec<Value> {
        let mut random = Random(seed);
        let t = b.input(Input::Time);
        let mut values: Vec<Value> = (first..first + 3)
            .map(|k| b.input(Input::Slot(k)))
            .collect();
        values.extend(constants.iter().map(|&c| b.constant(c)));
        let [low, high] = [0.25, 0.75].map(|c| b.constant(c));
        for _ in 0..60 {
            let [x, y, z, w] = [(); 4].map(|()| values[random.below(values.len())]);
            // parameters of functions that differ make other code
            let [p, q] = [y, z].map(|v| {
                if b.constant_of(v).is_some() {
                    values[0]
                } else {
                    v
                }
            });
            let value = match random.below(12) {
                0 => b.unary(UnaryOp::Sin, x),
                1 => b.unary(UnaryOp::Cos, x),
                2 => b.binary(BinaryOp::Sub, x, y),
                3 => b.binary(BinaryOp::Div, x, y),
                4 => {
                    let condition = b.compare(Comparison::Lt, x, y);
                    b.select(condition, z, w)
                }
                5 => b.call(Function::Step, &[p, low, values[1], high, q]),
                6 => b.call(Function::Step, &[q, low, low, high, high]),
                7 => b.partial_of(Function::Step, &[p, low, values[2], high, q], 0),
                8 => b.binary(BinaryOp::Atan2, x, y),
                9 => b.binary(BinaryOp::Mul, x, y),
                // by itself it would be common to all
                10 if b.constant_of(x).is_none() => b.binary(BinaryOp::Mul, x, t),
                _ => b.binary(BinaryOp::Add, x, y),
            };
            values.push(value);
        }
        values.split_off(values.len() - 9)
    }

    /// Records several mechanisms, and the least of a number of each as the last output.
    fn scene(seed: u64, n: u32) -> (Builder, Vec<Value>, Vec<Input>) {
        let mut random = Random(seed);
        let mut b = Builder::new(Folding::Structural);
        b.n_components = n as usize;
        let inputs: Vec<Input> = (0..3 * n).map(Input::Slot).chain([Input::Time]).collect();
        inputs.iter().for_each(|&input| {
            b.input(input);
        });
        let mut least = b.constant(1.0);
        let mut all: Vec<Vec<Value>> = Vec::new();
        for k in 0..n {
            let other = random.below(6) == 0;
            let constants = [(); 3].map(|()| 0.1 + random.below(900) as f64 * 1e-3);
            let values = mechanism(&mut b, seed + u64::from(other), 3 * k, &constants);
            let is_less = b.compare(Comparison::Lt, values[0], least);
            least = b.select(is_less, values[0], least);
            all.push(values);
        }
        // one output of each after the other, as the rates of a scene are
        let mut outputs: Vec<Value> = (0..9).flat_map(|j| all.iter().map(move |v| v[j])).collect();
        outputs.extend([least, b.input(Input::Slot(1)), b.constant(7.0)]);
        (b, outputs, inputs)
    }

    fn plain(x: f64) -> u64 {
        // which number that is none it is does not matter
        if x.is_nan() { f64::NAN } else { x }.to_bits()
    }

    fn bits(program: &Program, n_inputs: usize) -> Vec<u64> {
        let (mut work, mut out) = (Work::default(), vec![0.0; program.n_outputs()]);
        let mut bits = Vec::new();
        for run in 0..70 {
            let at = |k: usize| (0.37 * (run % 7) as f64 + 0.61 * k as f64) % 1.7 - 0.4;
            let inputs: Vec<f64> = (0..n_inputs).map(at).collect();
            program.run(&inputs, &mut work, &mut out);
            bits.extend(out.iter().map(|&x| plain(x)));
        }
        bits
    }

    fn over_duals(program: &Program, n_inputs: usize) -> Vec<u64> {
        let dual = |k: usize| Dual::<1> {
            re: 0.61 * k as f64 % 1.7 - 0.4,
            eps: [1.0 + k as f64],
        };
        let inputs: Vec<_> = (0..n_inputs).map(dual).collect();
        let mut out = vec![Dual::<1>::constant(0.0); program.n_outputs()];
        program.eval(&inputs, &mut Work::default(), &mut out);
        out.iter()
            .flat_map(|x| [plain(x.re), plain(x.eps[0])])
            .collect()
    }

    #[test]
    fn components_run_one_by_one_give_the_bits_of_the_whole() {
        let mut n_composed = 0;
        for seed in 0..60 {
            let (b, outputs, inputs) = scene(1000 * seed, 4 + (seed % 9) as u32);
            let whole = schedule::program(&b, &outputs, Some(&inputs)).0;
            let Some(kinds) = b.components(&outputs, FEWEST) else {
                continue;
            };
            n_composed += 1;
            let (program, constants) = composed(&b, &outputs, Some(&inputs), &kinds);
            let n = inputs.len();
            assert_eq!(program.inputs(), whole.inputs(), "{seed}");
            assert_eq!(program.n_operations(), whole.n_operations(), "{seed}");
            let expected = bits(&whole, n);
            assert_eq!(bits(&program, n), expected, "{seed}");
            for engine in [Engine::Interpreter, Engine::Native] {
                if let Some(straight) = program.with_engine(engine) {
                    assert_eq!(bits(&straight, n), expected, "{seed} {engine:?}");
                }
            }
            #[cfg(feature = "solver")]
            {
                program.expect_runs(1000);
                assert_eq!(bits(&program, n), expected, "{seed}");
            }
            assert_eq!(over_duals(&program, n), over_duals(&whole, n), "{seed}");
            // other constants: those of the same mechanisms in another order
            let mut numbers = schedule::numbers(&b, &constants);
            numbers.reverse();
            let other = program.with_constants(numbers, &b.tables);
            let straight = other.with_engine(Engine::Interpreter).unwrap();
            assert_eq!(bits(&other, n), bits(&straight, n), "{seed}");
        }
        assert!(n_composed > 30, "{n_composed}");
    }

    #[test]
    fn mechanisms_that_share_an_operation_are_one() {
        let mut b = Builder::new(Folding::Structural);
        b.n_components = 10;
        let t = b.input(Input::Time);
        let shared = b.unary(UnaryOp::Sin, t);
        let mut outputs = Vec::new();
        for k in 0..10 {
            let [x, c] = [b.input(Input::Slot(k)), b.constant(0.1 + f64::from(k))];
            let mut y = b.binary(BinaryOp::Mul, shared, c);
            for _ in 0..40 {
                let sum = b.binary(BinaryOp::Add, x, y);
                y = b.unary(UnaryOp::Sin, sum);
            }
            outputs.push(y);
        }
        assert!(b.components(&outputs, FEWEST).is_none());
    }
}
