//! Steps, interpolation and root finding allocate nothing once a run has started; what is done with a file allocates as much as the
//! file is long.

use crate::problems;

use crate::counting;

use cognate::dataset;
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

/// Allocations of reading a dataset of parts that fall, placing what is doubted of each, and writing it.
fn allocations_of_a_file(n: usize) -> usize {
    let mut text = String::from("free parts\nPART/1, GROUND\nACCGRAV/KGRAV=-9.81\n");
    for k in 2..n + 2 {
        text += &format!("PART/{k}, MASS=1, CM={k}, IP=1,1,1\nMARKER/{k}, PART={k}\n");
    }
    let before = allocations_so_far();
    let reading = dataset::read_text(&text);
    let doubts = reading.model.doubts().into_iter();
    let placed: Vec<_> = doubts.map(|d| reading.dataset.locate(d)).collect();
    // one more says that there are no units
    assert_eq!((placed.len(), placed[n - 1].line), (n + 1, 2 * n + 2));
    assert!(reading.dataset.formatted().len() > text.len());
    assert!(reading.model.to_text().len() > text.len());
    allocations_so_far() - before
}

#[test]
fn what_is_done_with_a_file_allocates_as_much_as_it_is_long() {
    let [small, large] = [200, 800].map(allocations_of_a_file);
    assert!(large < 5 * small, "{small} for 200 parts, {large} for 800");
}
