//! Derivatives of recorded programs along directions, several directions at a time.

use crate::expr::program::{Builder, Folding, Input, Program, Work};
use crate::numeric::pattern::Pattern;
use crate::scalar::{Dual, Scalar};
use nalgebra::DMatrix;

/// Directions of a dual number in one sweep.
pub const WIDTH: usize = 8;

/// Operations of a recorded gradient, at most.
const MAX_OPERATIONS: usize = 60_000;
/// Operations of a program times its outputs, over that, beyond which it is not looked at.
const LOOKED_AT: usize = 16;

/// Records the derivatives of the first `n` outputs of a program: output by output, with respect to
/// the numbers at `places`; `None` where that program would take longer than duals.
pub fn recorded(
    program: &Program,
    n: usize,
    places: impl Iterator<Item = usize>,
) -> Option<Program> {
    if n * program.n_operations() > MAX_OPERATIONS * LOOKED_AT {
        return None;
    }
    let mut builder = Builder::new(Folding::Structural);
    let outputs = program.record(&mut builder);
    // each operation that an output needs has an adjoint of its own for it
    let mut adjoints = outputs[..n].iter().map(|&output| builder.cost(output));
    let few = |sum: usize, more| (sum <= MAX_OPERATIONS).then_some(sum + more);
    if adjoints.try_fold(0, few)? > MAX_OPERATIONS {
        return None;
    }
    let places: Vec<_> = places
        .map(|k| builder.input(Input::Slot(k as u32)))
        .collect();
    let mut entries = Vec::with_capacity(n * places.len());
    for &output in &outputs[..n] {
        entries.extend(builder.gradient(output, &places));
    }
    let gradient = builder.finish_with_inputs(&entries, program.inputs());
    (gradient.n_operations() <= MAX_OPERATIONS).then_some(gradient)
}

/// A direction: places in the row of numbers, each with the slope of its number.
pub type Direction = Vec<(usize, f64)>;

/// Returns ∂out/∂direction of a program at `numbers`   (outputs × directions).
///
/// `pattern` tells which outputs change along which directions; the directions of a group are
/// followed together. `follow` puts the derivatives of numbers that depend on others without being
/// part of a direction into their places; its second argument says that the numbers are new.
///
/// # Errors
/// Those of `follow`.
pub fn along<E>(
    program: &Program,
    work: &mut Work<Dual<WIDTH>>,
    numbers: impl Iterator<Item = f64>,
    directions: &[Direction],
    pattern: Option<&Pattern>,
    mut follow: impl FnMut(&mut [Dual<WIDTH>], bool) -> Result<(), E>,
) -> Result<DMatrix<f64>, E> {
    let mut numbers: Vec<Dual<WIDTH>> = numbers.map(Dual::constant).collect();
    let mut out = vec![Dual::constant(0.0); program.n_outputs()];
    let mut slopes = DMatrix::zeros(program.n_outputs(), directions.len());
    let alone: Vec<Vec<usize>>;
    let groups = match pattern {
        Some(pattern) => pattern.groups(),
        None => {
            alone = (0..directions.len()).map(|d| vec![d]).collect();
            &alone
        }
    };
    for (chunk, some) in groups.chunks(WIDTH).enumerate() {
        for (k, group) in some.iter().enumerate() {
            for &(place, slope) in group.iter().flat_map(|&d| &directions[d]) {
                numbers[place].eps[k] += slope;
            }
        }
        follow(&mut numbers, chunk == 0)?;
        program.eval(&numbers, work, &mut out);
        for (k, group) in some.iter().enumerate() {
            for &d in group {
                match pattern {
                    Some(pattern) => {
                        (pattern.column(d)).for_each(|(_, i)| slopes[(i, d)] = out[i].eps[k]);
                    }
                    None => (out.iter().enumerate()).for_each(|(i, x)| slopes[(i, d)] = x.eps[k]),
                }
            }
        }
        for x in &mut numbers {
            x.eps = [0.0; WIDTH];
        }
    }
    Ok(slopes)
}
