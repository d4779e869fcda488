//! Methods against exact solutions: order, error for a requested tolerance, and cost.
#![cfg(feature = "solver")]

mod problems;

use cognate::numeric::{Dop853, Failure, METHODS, Method, Ode, Options, Reason, ode_method};
use problems::*;

fn options(tolerance: f64) -> Options {
    Options {
        tolerance,
        ..Options::default()
    }
}

/// Largest error of a run with one step length, at step ends and inside steps.
fn error_with_step(name: &str, h: f64) -> (f64, f64) {
    let mut problem = System::new(Oscillator);
    // a tolerance that accepts everything, so that the step stays
    let options = Options {
        tolerance: 1e6,
        h_initial: Some(h),
        h_max: h,
        ..Options::default()
    };
    let mut method = ode_method::<System<Oscillator>>(name, 2, &options).expect("the table has it");
    method
        .start(&mut problem, 0.0, &[0.0, 1.0])
        .expect("it can start");
    let (mut at_ends, mut inside) = (0.0f64, 0.0f64);
    let mut y = [0.0; 2];
    while method.t() < 2.0 {
        let step = method.step(&mut problem, 2.0).expect("it can go on");
        at_ends = at_ends.max((method.y()[0] - step.t1.sin()).abs());
        for part in [0.21, 0.5, 0.83] {
            let t = step.t0 + part * step.h;
            method
                .interpolate(&mut problem, t, &mut y)
                .expect("it interpolates");
            inside = inside
                .max((y[0] - t.sin()).abs())
                .max((y[1] - t.cos()).abs());
        }
    }
    (at_ends, inside)
}

#[test]
fn methods_show_their_order_and_that_of_their_interpolant() {
    let rows = [("DOP853", 8.0, 7.0, 0.5), ("RADAU5", 5.0, 3.0, 0.2)];
    for (name, order, interpolant, h) in rows.iter().copied() {
        let (coarse, fine) = (error_with_step(name, h), error_with_step(name, h / 2.0));
        let slope = (coarse.0 / fine.0).log2();
        assert!(
            (slope - order).abs() < 0.6,
            "{name}: order {slope} at step ends"
        );
        let slope = (coarse.1 / fine.1).log2();
        assert!(
            slope > interpolant - 0.4 && slope < order + 1.6,
            "{name}: order {slope} inside steps"
        );
    }
}

/// (true error, evaluations) of a run.
type Trial = fn(&str, f64) -> (f64, usize);

fn pendulum(name: &str, tolerance: f64) -> (f64, usize) {
    let (mut problem, mut judge) = (System::new(Pendulum), Judge::new(4));
    let mut method = ode_method(name, 2, &options(tolerance)).expect("the table has it");
    run(
        &mut *method,
        &mut problem,
        (0.0, 10.0),
        &Pendulum::START,
        1,
        |_, y| judge.see(&Pendulum::point(y), &Pendulum::AFTER_10),
    )
    .expect("it arrives");
    (judge.verdict(), method.stats().evaluations)
}

fn cartesian_pendulum(name: &str, tolerance: f64) -> (f64, usize) {
    let (mut problem, mut judge) = (System::new(CartesianPendulum), Judge::new(4));
    let mut method = ode_method(name, 4, &options(tolerance)).expect("the table has it");
    run(
        &mut *method,
        &mut problem,
        (0.0, 10.0),
        &[-1.0, 0.0, 0.0, 0.0],
        1,
        |_, y| judge.see(y, &Pendulum::AFTER_10),
    )
    .expect("it arrives");
    (judge.verdict(), method.stats().evaluations)
}

fn double_pendulum(name: &str, tolerance: f64) -> (f64, usize) {
    let (mut problem, mut judge) = (System::new(DoublePendulum), Judge::new(6));
    let mut method = ode_method(name, 4, &options(tolerance)).expect("the table has it");
    run(
        &mut *method,
        &mut problem,
        (0.0, 5.0),
        &DoublePendulum::START,
        1,
        |_, y| judge.see(&DoublePendulum::points(y), &DoublePendulum::AFTER_5),
    )
    .expect("it arrives");
    (judge.verdict(), method.stats().evaluations)
}

fn kepler(name: &str, tolerance: f64) -> (f64, usize) {
    let (mut problem, mut judge) = (System::new(Kepler), Judge::new(4));
    let mut method = ode_method(name, 4, &options(tolerance)).expect("the table has it");
    run(
        &mut *method,
        &mut problem,
        (0.0, 20.0),
        &Kepler::start(),
        200,
        |t, y| judge.see(y, &Kepler::exact(t)),
    )
    .expect("it arrives");
    (judge.verdict(), method.stats().evaluations)
}

fn euler_top(name: &str, tolerance: f64) -> (f64, usize) {
    let (mut problem, mut judge) = (System::new(EulerTop), Judge::new(3));
    let mut method = ode_method(name, 3, &options(tolerance)).expect("the table has it");
    run(
        &mut *method,
        &mut problem,
        (0.0, 10.0),
        &EulerTop::START,
        1,
        |_, w| judge.see(w, &EulerTop::AFTER_10),
    )
    .expect("it arrives");
    (judge.verdict(), method.stats().evaluations)
}

fn van_der_pol(name: &str, tolerance: f64) -> (f64, usize) {
    let (mut problem, mut judge) = (System::new(VanDerPol), Judge::new(2));
    let mut method = ode_method(name, 2, &options(tolerance)).expect("the table has it");
    run(
        &mut *method,
        &mut problem,
        (0.0, 2.0),
        &VanDerPol::START,
        1,
        |_, y| judge.see(y, &VanDerPol::AFTER_2),
    )
    .expect("it arrives");
    (judge.verdict(), method.stats().evaluations)
}

fn robertson(name: &str, tolerance: f64) -> (f64, usize) {
    let (mut problem, mut judge) = (System::new(Robertson), Judge::new(3));
    let mut method = ode_method(name, 3, &options(tolerance)).expect("the table has it");
    run(
        &mut *method,
        &mut problem,
        (0.0, 40.0),
        &Robertson::START,
        1,
        |_, y| judge.see(y, &Robertson::AFTER_40),
    )
    .expect("it arrives");
    (judge.verdict(), method.stats().evaluations)
}

fn hires(name: &str, tolerance: f64) -> (f64, usize) {
    let (mut problem, mut judge) = (System::new(Hires), Judge::new(8));
    let mut method = ode_method(name, 8, &options(tolerance)).expect("the table has it");
    run(
        &mut *method,
        &mut problem,
        (0.0, Hires::END),
        &Hires::START,
        1,
        |_, y| judge.see(y, &Hires::AT_END),
    )
    .expect("it arrives");
    (judge.verdict(), method.stats().evaluations)
}

fn stiff_bushing(name: &str, tolerance: f64) -> (f64, usize) {
    let (mut problem, mut judge) = (System::new(StiffBushing), Judge::new(4));
    let mut method = ode_method(name, 6, &options(tolerance)).expect("the table has it");
    // the scale of each column is that of the motion after the first transient
    judge.see(&StiffBushing::AFTER_20_MS, &StiffBushing::AFTER_20_MS);
    run(
        &mut *method,
        &mut problem,
        (0.0, 2.0),
        &StiffBushing::START,
        1,
        |_, y| judge.see(&[y[0], y[1], y[2], y[5]], &StiffBushing::AFTER_2),
    )
    .expect("it arrives");
    (judge.verdict(), method.stats().evaluations)
}

/// Work and true error over the range of requests.
fn proportional(name: &str, what: &str, trial: Trial, requests: &[i32], allowed: f64) {
    let mut table = String::new();
    let mut good = true;
    for k in requests {
        let request = 10f64.powi(-k);
        let (error, evaluations) = trial(name, request);
        good &= error < allowed * request;
        table += &format!(
            "{request:.0e}: {error:.2e} = {:.2} E, {evaluations} evaluations\n",
            error / request
        );
    }
    println!("{what} by {name}\n{table}");
    assert!(
        good,
        "{what} by {name}: error beyond {allowed} times the request\n{table}"
    );
}

#[test]
fn error_follows_the_request_on_what_is_not_stiff() {
    let requests = [3, 4, 5, 6, 7, 8, 9, 10, 11];
    for row in METHODS.iter().filter(|row| row.name == "DOP853") {
        proportional(row.name, "pendulum", pendulum, &requests, 10.0);
        proportional(
            row.name,
            "Cartesian pendulum",
            cartesian_pendulum,
            &requests,
            10.0,
        );
        proportional(row.name, "Kepler", kepler, &requests, 20.0);
        proportional(row.name, "Euler top", euler_top, &requests, 20.0);
        proportional(
            row.name,
            "double pendulum",
            double_pendulum,
            &requests,
            100.0,
        );
    }
}

#[test]
fn error_follows_the_request_on_what_is_stiff() {
    let requests = [3, 4, 5, 6, 7, 8, 9, 10, 11];
    for name in ["RADAU5"] {
        proportional(name, "pendulum", pendulum, &requests, 10.0);
        proportional(name, "Kepler", kepler, &requests, 40.0);
        proportional(name, "van der Pol", van_der_pol, &requests, 20.0);
        proportional(name, "Robertson", robertson, &requests, 10.0);
        proportional(name, "HIRES", hires, &requests, 10.0);
        // the first millisecond has rates 300 times those that are judged
        proportional(name, "stiff bushing", stiff_bushing, &requests, 300.0);
    }
}

#[test]
fn projection_keeps_invariants_and_costs_no_evaluation() {
    let mut problem = System::new(CartesianPendulum);
    let mut method = Dop853::new(4, &options(1e-6));
    let method: &mut dyn Method<System<CartesianPendulum>> = &mut method;
    method
        .start(&mut problem, 0.0, &[-1.0, 0.0, 0.0, 0.0])
        .unwrap();
    while method.t() < 10.0 {
        method.step(&mut problem, 10.0).unwrap();
        let y = method.y();
        assert!((y[0].hypot(y[1]) - 1.0).abs() < 1e-15);
        assert!((y[0] * y[2] + y[1] * y[3]).abs() < 1e-14);
    }
    let stats = method.stats();
    assert_eq!(
        stats.evaluations,
        2 + 12 * stats.steps + 11 * stats.rejected
    );
}

/// Counts calls and fails as told after a time.
struct Faulty {
    fault: fn(f64, &mut [f64]) -> Result<(), Failure>,
    calls: usize,
}

impl Ode for Faulty {
    fn size(&self) -> usize {
        2
    }
    fn rate(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.calls += 1;
        (ydot[0], ydot[1]) = (y[1], -y[0]);
        (self.fault)(t, ydot)
    }
    fn jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        jacobian: &mut [f64],
        dfdt: &mut [f64],
    ) -> Result<(), Failure> {
        jacobian.copy_from_slice(&[0.0, -1.0, 1.0, 0.0]);
        dfdt.fill(0.0);
        Ok(())
    }
    fn typical(&self, typical: &mut [f64]) {
        typical.fill(1.0);
    }
}

/// Where a run of `name` over a faulty problem stops, why, and after how many calls.
fn stop_of(name: &str, fault: fn(f64, &mut [f64]) -> Result<(), Failure>) -> (f64, Reason, usize) {
    let mut problem = Faulty { fault, calls: 0 };
    let mut method = ode_method(name, 2, &options(1e-6)).unwrap();
    let stop = match method.start(&mut problem, 0.0, &[0.0, 1.0]) {
        Err(stop) => stop,
        Ok(()) => loop {
            match method.step(&mut problem, 10.0) {
                Ok(_) => assert!(method.t() < 10.0, "{name} ran through a fault"),
                Err(stop) => break stop,
            }
        },
    };
    (stop.t, stop.reason, problem.calls)
}

#[test]
fn a_fault_is_approached_and_then_named() {
    for row in METHODS
        .iter()
        .filter(|row| row.form == cognate::numeric::Form::Ode)
    {
        let (t, reason, calls) = stop_of(row.name, |t, ydot| {
            if t > 3.0 {
                ydot[1] = f64::NAN;
            }
            Ok(())
        });
        assert!(t <= 3.0 && t > 2.999, "{} stops at {t}", row.name);
        assert_eq!(reason, Reason::NotFinite(1), "{}", row.name);
        assert!(calls < 20_000, "{}: {calls} calls", row.name);

        let failure = Failure {
            what: 7,
            recoverable: true,
        };
        let (t, reason, calls) = stop_of(row.name, |t, _| {
            if t > 3.0 {
                Err(Failure {
                    what: 7,
                    recoverable: true,
                })
            } else {
                Ok(())
            }
        });
        assert!(t <= 3.0 && t > 2.999, "{} stops at {t}", row.name);
        assert_eq!(reason, Reason::Evaluation(failure), "{}", row.name);
        assert!(calls < 20_000, "{}: {calls} calls", row.name);

        let (t, reason, _) = stop_of(row.name, |t, _| {
            if t > 3.0 {
                Err(Failure {
                    what: 8,
                    recoverable: false,
                })
            } else {
                Ok(())
            }
        });
        assert!(t <= 3.0, "{} stops at {t}", row.name);
        assert_eq!(
            reason,
            Reason::Evaluation(Failure {
                what: 8,
                recoverable: false
            }),
            "{}",
            row.name
        );
    }
}

#[test]
fn a_pole_stops_with_an_underflow_of_the_step() {
    struct Pole;
    impl Field for Pole {
        fn size(&self) -> usize {
            1
        }
        fn rate<S: cognate::scalar::Scalar>(&self, _t: S, y: &[S], ydot: &mut [S]) {
            ydot[0] = y[0].square();
        }
    }
    for row in METHODS
        .iter()
        .filter(|row| row.form == cognate::numeric::Form::Ode)
    {
        let mut problem = System::new(Pole);
        let mut method = ode_method(row.name, 1, &options(1e-6)).unwrap();
        method.start(&mut problem, 0.0, &[1.0]).unwrap();
        let stop = loop {
            if let Err(stop) = method.step(&mut problem, 2.0) {
                break stop;
            }
        };
        assert!(
            (stop.t - 1.0).abs() < 1e-4,
            "{}: y = 1/(1 − t) stops at {}",
            row.name,
            stop.t
        );
        assert!(method.stats().steps < 5_000);
    }
}

#[test]
fn undo_goes_back_and_a_limit_is_met_exactly() {
    let mut problem = System::new(Pendulum);
    let mut method = ode_method(METHODS[0].name, 2, &options(1e-8)).unwrap();
    method.start(&mut problem, 0.0, &Pendulum::START).unwrap();
    for _ in 0..5 {
        method.step(&mut problem, 10.0).unwrap();
    }
    let before = (method.t(), method.y().to_vec());
    let step = method.step(&mut problem, 10.0).unwrap();
    method.undo();
    assert_eq!((method.t(), method.y().to_vec()), before);
    let middle = 0.5 * (step.t0 + step.t1);
    let again = method.step(&mut problem, middle).unwrap();
    assert_eq!((again.t1, method.t()), (middle, middle));
}

#[test]
fn stiffness_is_noticed_by_the_explicit_method() {
    let mut problem = System::new(Prothero(-1e4));
    let mut method = ode_method("DOP853", 1, &options(1e-4)).unwrap();
    method.start(&mut problem, 0.0, &[0.0]).unwrap();
    while !method.stiff() {
        method.step(&mut problem, 10.0).unwrap();
        assert!(method.stats().steps < 100, "not noticed");
    }
    let mut problem = System::new(Pendulum);
    let mut method = ode_method("DOP853", 2, &options(1e-4)).unwrap();
    method.start(&mut problem, 0.0, &Pendulum::START).unwrap();
    while method.t() < 10.0 {
        method.step(&mut problem, 10.0).unwrap();
        assert!(!method.stiff());
    }
}
