//! Steps, interpolation and root finding allocate nothing once a run has started.

use crate::problems;

use crate::counting;

use cognate::internals::numeric::event::Locator;
use cognate::numeric::{METHODS, Method, Options, ode_method};
use counting::allocations_so_far;
use problems::*;

/// Allocations of a run with events after its first steps.
fn allocations<P>(method: &mut dyn Method<P>, problem: &mut P, y: &[f64], settle: usize) -> usize {
    method.start(problem, 0.0, y).unwrap();
    let mut locator = Locator::new(1);
    locator.begin(&[y[0]]);
    let mut out = y.to_vec();
    for _ in 0..settle {
        method.step(problem, 10.0).unwrap();
    }
    let before = allocations_so_far();
    let (mut events, mut undone) = (0, false);
    while method.t() < 10.0 {
        let step = method.step(problem, 10.0).unwrap();
        let found = locator.scan((step.t0, step.t1), &[], |t, values| {
            method.interpolate(problem, t, &mut out)?;
            values[0] = out[0];
            Ok::<(), cognate::numeric::Failure>(())
        });
        if let Some(t) = found.unwrap() {
            method.interpolate(problem, t, &mut out).unwrap();
            method.reinitialize(problem, t, &out).unwrap();
            events += 1;
        }
        if events == 1 && !undone {
            method.undo();
            undone = true;
        }
        method
            .interpolate_rate(problem, method.t(), &mut out)
            .unwrap();
    }
    assert!(events >= 5, "{events} events");
    allocations_so_far() - before
}

#[test]
fn steps_allocate_nothing() {
    let options = Options {
        tolerance: 1e-5,
        ..Options::default()
    };
    for row in METHODS {
        let mut problem = System::new(Pendulum);
        let mut method = ode_method(row.name, 2, &options).unwrap();
        let count = allocations(&mut *method, &mut problem, &Pendulum::START, 3);
        assert_eq!(count, 0, "{} allocates", row.name);
    }
}
