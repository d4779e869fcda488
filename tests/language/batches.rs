//! Batches over random programs of plain arithmetic, whose loops keep values in registers of the processor: every point has the bits
//! of a single run, whatever the numbers are and however many values are needed at a time.

use cognate::expr::program::{
    BinaryOp, Builder, Comparison, Folding, Input, Program, UnaryOp, Value, Work,
};

/// Random numbers that are the same in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 33) as usize % n
    }
    /// Mostly usual numbers; zeros, infinities and nothing among them.
    fn number(&mut self) -> f64 {
        const SPECIAL: [f64; 8] = [
            0.0,
            -0.0,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
            1.0,
            5e-324,
            -1e308,
        ];
        match self.below(6) {
            0 => SPECIAL[self.below(SPECIAL.len())],
            _ => self.below(4001) as f64 / 500.0 - 4.0,
        }
    }
}

const N_INPUTS: usize = 5;

/// A program of `n` operations on what came before them; recent values and old ones alike, so that many are alive at a time.
/// With `calls`, some operations are functions, which end a loop.
fn program(random: &mut Random, n: usize, calls: bool) -> Program {
    let mut b = Builder::new(Folding::Strict);
    let mut values: Vec<Value> = (0..N_INPUTS)
        .map(|k| b.input(Input::Slot(k as u32)))
        .collect();
    values.push(b.constant(1.5));
    values.push(b.constant(-0.25));
    for _ in 0..n {
        let [x, y, z, w] = std::array::from_fn(|_| values[random.below(values.len())]);
        let comparison = [Comparison::Lt, Comparison::Le, Comparison::Eq][random.below(3)];
        values.push(match random.below(if calls { 20 } else { 18 }) {
            0 | 1 => b.binary(BinaryOp::Add, x, y),
            2 | 3 => b.binary(BinaryOp::Sub, x, y),
            4 | 5 => b.binary(BinaryOp::Mul, x, y),
            6 => b.binary(BinaryOp::Div, x, y),
            7 => b.binary(BinaryOp::Along, x, y),
            8 => b.binary(BinaryOp::Kept, x, y),
            9 => b.unary(UnaryOp::Neg, x),
            10 => b.unary(UnaryOp::Abs, x),
            11 => b.unary(UnaryOp::Sqrt, x),
            12 => {
                let condition = b.compare(comparison, x, y);
                b.select(condition, z, w)
            }
            13 => {
                let (one, other) = (b.compare(comparison, x, y), b.compare(Comparison::Lt, z, w));
                let both = b.and(one, other);
                b.not(both)
            }
            14 => {
                let (one, other) = (b.compare(comparison, x, y), b.compare(Comparison::Le, z, w));
                let either = b.or(one, other);
                b.select(either, y, x)
            }
            15 => b.arithmetic_if(x, y, z, w),
            16 => b.powi(x, [-3, -1, 2, 3, 4, 5, 7, 11][random.below(8)]),
            17 => b.compare(comparison, x, y),
            18 => b.unary(UnaryOp::Atan, x),
            _ => b.binary(BinaryOp::Atan2, x, y),
        });
    }
    // the last values, some in between, an input and a constant
    let last = values.len() - 1;
    let outputs = [
        values[last],
        values[last - 1],
        values[last / 2],
        values[last],
        values[0],
        values[N_INPUTS],
    ];
    b.finish(&outputs)
}

/// Compares a batch with single runs.
fn agree(program: &Program, random: &mut Random, n: usize, n_outputs: usize) {
    let n_inputs = program.inputs().len();
    let columns: Vec<Vec<f64>> = (0..n_inputs)
        .map(|_| (0..n).map(|_| random.number()).collect())
        .collect();
    let views: Vec<&[f64]> = columns.iter().map(|c| &c[..]).collect();
    let mut out = vec![vec![f64::NAN; n]; n_outputs];
    let mut places: Vec<&mut [f64]> = out.iter_mut().map(|o| &mut o[..]).collect();
    program.batch().run(&views, &mut places).unwrap();
    let (mut work, mut single) = (Work::default(), vec![0.0; n_outputs]);
    for k in 0..n {
        let point: Vec<f64> = columns.iter().map(|c| c[k]).collect();
        program.run(&point, &mut work, &mut single);
        for (which, (column, want)) in out.iter().zip(&single).enumerate() {
            let same = column[k].to_bits() == want.to_bits() || column[k].is_nan() && want.is_nan();
            assert!(
                same,
                "output {which} of point {k} of {n} at {point:?}: {:e} in the batch, {want:e} alone\n{program}",
                column[k]
            );
        }
    }
}

#[test]
fn loops_over_columns_have_the_bits_of_single_runs() {
    let mut random = Random(0x5DEE_CE66_D1CE_CAFE);
    for round in 0..300 {
        let n_operations = 1 + random.below(if round % 10 == 0 { 400 } else { 40 });
        let program = program(&mut random, n_operations, round % 3 == 0);
        let n = [0, 1, 3, 4, 5, 8, 127, 128, 131][random.below(9)];
        let all = program.n_outputs();
        agree(&program, &mut random, n, all);
        // fewer outputs than there are
        agree(&program, &mut random, n, 1);
    }
}

#[test]
fn outputs_of_different_lengths_are_filled_each() {
    let mut random = Random(9);
    let program = program(&mut random, 30, false);
    let columns: Vec<Vec<f64>> = (0..program.inputs().len())
        .map(|k| {
            (0..200)
                .map(|j| (k * 31 + j * 7 % 13) as f64 / 5.0)
                .collect()
        })
        .collect();
    let views: Vec<&[f64]> = columns.iter().map(|c| &c[..]).collect();
    let (mut long, mut short) = ([0.0; 200], [0.0; 37]);
    program
        .batch()
        .run(&views, &mut [&mut long, &mut short])
        .unwrap();
    let (mut work, mut single) = (Work::default(), [0.0; 2]);
    for k in 0..200 {
        let point: Vec<f64> = columns.iter().map(|c| c[k]).collect();
        program.run(&point, &mut work, &mut single);
        let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
        assert!(same(long[k], single[0]), "{k}");
        assert!(k >= 37 || same(short[k], single[1]), "{k}");
    }
}
