//! Steps, interpolation and root finding allocate nothing once a run has started.
#![cfg(feature = "solver")]

mod problems;

use std::alloc::{GlobalAlloc, Layout, System as Heap};
use std::cell::Cell;

use cognate::numeric::event::Locator;
use cognate::numeric::{Form, METHODS, Method, Options, dae_method, ode_method};
use problems::*;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, counting per thread.
struct Counting;

// SAFETY: hands everything on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
        unsafe { Heap.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { Heap.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Allocations of a run with events after its first steps.
fn allocations<P>(method: &mut dyn Method<P>, problem: &mut P, y: &[f64], settle: usize) -> usize {
    method.start(problem, 0.0, y).unwrap();
    let mut locator = Locator::new(1);
    locator.begin(&[y[0]]);
    let mut out = y.to_vec();
    for _ in 0..settle {
        method.step(problem, 10.0).unwrap();
    }
    let before = COUNT.with(Cell::get);
    let (mut events, mut undone) = (0, false);
    while method.t() < 10.0 {
        let step = method.step(problem, 10.0).unwrap();
        let found = locator.scan(step.t0, step.t1, |t, values| {
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
    COUNT.with(Cell::get) - before
}

#[test]
fn steps_allocate_nothing() {
    let options = Options {
        tolerance: 1e-5,
        ..Options::default()
    };
    for row in METHODS {
        let count = match row.form {
            Form::Ode => {
                let mut problem = System::new(Pendulum);
                let mut method = ode_method(row.name, 2, &options).unwrap();
                allocations(&mut *method, &mut problem, &Pendulum::START, 3)
            }
            Form::Dae => {
                let mut problem = Implicit::new(Written(Pendulum));
                let mut method = dae_method(row.name, 2, &options).unwrap();
                allocations(&mut *method, &mut problem, &Pendulum::START, 3)
            }
        };
        assert_eq!(count, 0, "{} allocates", row.name);
    }
}
