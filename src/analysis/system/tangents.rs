//! Derivatives of programs along many directions, recorded once they have been asked for often.

use crate::expr::program::{Program, Tangent};

/// Calls for derivatives by duals after which recording them pays.
const OFTEN: usize = 6;
/// Operations of a program whose derivatives are recorded, at most.
const MOST_OPERATIONS: usize = 1_000_000;

/// The derivatives of one program along directions.
#[derive(Clone, Debug, Default)]
pub(super) struct Tangents {
    /// how often they were asked for
    asked: usize,
    /// inside: none, where they are not linear code
    recorded: Option<Option<Box<Tangent>>>,
}

impl Tangents {
    /// Returns the recorded derivatives of a program with respect to the inputs that vary, at some
    /// numbers; `None`: duals serve better. It is asked once a state, always of the same program.
    pub fn at(
        &mut self,
        numbers: &[f64],
        program: &Program,
        varies: impl Fn(usize) -> bool,
    ) -> Option<&mut Tangent> {
        self.asked += 1;
        if self.asked <= OFTEN || program.n_operations() > MOST_OPERATIONS {
            return None;
        }
        let record = || Tangent::of(program, varies).map(Box::new);
        let tangent = self.recorded.get_or_insert_with(record).as_deref_mut()?;
        tangent.see(numbers);
        Some(tangent)
    }

    /// Returns the derivatives at the numbers that were seen last.
    pub fn here(&mut self) -> Option<&mut Tangent> {
        let is_used = self.asked > OFTEN;
        let tangent = self.recorded.as_mut()?.as_deref_mut();
        tangent.filter(|_| is_used)
    }
}
