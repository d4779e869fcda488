//! Methods against exact solutions: order, error for a requested tolerance, and cost.

use crate::problems;

use cognate::numeric::{
    Dop853, Failure, METHODS, Method, MethodRow, Ode, Options, Reason, Relation, ode_method,
};
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

#[test]
fn the_middle_of_a_step_is_known_to_order_six_without_an_evaluation() {
    // how far it is from the exact one in the first step of a planet
    let off = |h: f64| {
        let options = Options {
            tolerance: 1e6,
            h_initial: Some(h),
            h_max: h,
            ..Options::default()
        };
        let mut problem = System::new(Kepler);
        let mut method = ode_method::<System<Kepler>>("DOP853", 4, &options).expect("a method");
        (method.start(&mut problem, 0.0, &Kepler::start())).expect("it can start");
        let mut y = [0.0; 4];
        assert!(!method.middle(&mut y), "no step has been taken");
        let step = method.step(&mut problem, 2.0).expect("it can go on");
        let evaluations = method.stats().evaluations;
        assert!(method.middle(&mut y));
        assert_eq!(method.stats().evaluations, evaluations);
        let exact = Kepler::exact(step.t0 + 0.5 * step.h);
        let distances = y.iter().zip(exact).map(|(a, b)| (a - b).abs());
        distances.fold(0.0, f64::max)
    };
    let order = (off(0.04) / off(0.02)).log2() - 1.0;
    assert!((order - 6.0).abs() < 0.5, "order {order}");
}

/// (true error, evaluations) of a run.
type Trial = fn(&str, f64) -> (f64, usize);

/// A run of an ODE method to an end where the solution is known; `seen` picks what is compared.
fn ode_trial<F: Field>(
    (name, tolerance): (&str, f64),
    field: F,
    (end, start): (f64, &[f64]),
    judge: &mut Judge,
    exact: &[f64],
    seen: impl Fn(&[f64]) -> Vec<f64>,
) -> (f64, usize) {
    let mut problem = System::new(field);
    let mut method = ode_method(name, start.len(), &options(tolerance)).expect("the table has it");
    run(&mut *method, &mut problem, (0.0, end), start, 1, |_, y| {
        judge.see(&seen(y), exact)
    })
    .expect("it arrives");
    (judge.verdict(), method.stats().evaluations)
}

/// The same where all unknowns are compared.
fn plain_trial<F: Field>(
    trial: (&str, f64),
    field: F,
    from: (f64, &[f64]),
    exact: &[f64],
) -> (f64, usize) {
    let judge = &mut Judge::new(exact.len());
    ode_trial(trial, field, from, judge, exact, <[f64]>::to_vec)
}

fn pendulum(name: &str, tolerance: f64) -> (f64, usize) {
    let (judge, exact) = (&mut Judge::new(4), &Pendulum::AFTER_10);
    let seen = |y: &[f64]| Pendulum::point(y).to_vec();
    let from = (10.0, &Pendulum::START[..]);
    ode_trial((name, tolerance), Pendulum, from, judge, exact, seen)
}

fn cartesian_pendulum(name: &str, tolerance: f64) -> (f64, usize) {
    let from = (10.0, &[-1.0, 0.0, 0.0, 0.0][..]);
    plain_trial(
        (name, tolerance),
        CartesianPendulum,
        from,
        &Pendulum::AFTER_10,
    )
}

fn double_pendulum(name: &str, tolerance: f64) -> (f64, usize) {
    let (judge, exact) = (&mut Judge::new(6), &DoublePendulum::AFTER_5);
    let seen = |y: &[f64]| DoublePendulum::points(y).to_vec();
    let from = (5.0, &DoublePendulum::START[..]);
    ode_trial((name, tolerance), DoublePendulum, from, judge, exact, seen)
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
    let from = (10.0, &EulerTop::START[..]);
    plain_trial((name, tolerance), EulerTop, from, &EulerTop::AFTER_10)
}

fn van_der_pol(name: &str, tolerance: f64) -> (f64, usize) {
    let from = (2.0, &VanDerPol::START[..]);
    plain_trial((name, tolerance), VanDerPol, from, &VanDerPol::AFTER_2)
}

fn robertson(name: &str, tolerance: f64) -> (f64, usize) {
    let from = (40.0, &Robertson::START[..]);
    plain_trial((name, tolerance), Robertson, from, &Robertson::AFTER_40)
}

fn hires(name: &str, tolerance: f64) -> (f64, usize) {
    let from = (Hires::END, &Hires::START[..]);
    plain_trial((name, tolerance), Hires, from, &Hires::AT_END)
}

fn stiff_bushing(name: &str, tolerance: f64) -> (f64, usize) {
    let (judge, exact) = (&mut Judge::new(4), &StiffBushing::AFTER_2);
    // the scale of each column is that of the motion after the first transient
    judge.see(&StiffBushing::AFTER_20_MS, &StiffBushing::AFTER_20_MS);
    let seen = |y: &[f64]| vec![y[0], y[1], y[2], y[5]];
    let from = (2.0, &StiffBushing::START[..]);
    ode_trial((name, tolerance), StiffBushing, from, judge, exact, seen)
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
    let name = "RADAU5";
    proportional(name, "pendulum", pendulum, &requests, 10.0);
    proportional(name, "Kepler", kepler, &requests, 40.0);
    proportional(name, "van der Pol", van_der_pol, &requests, 20.0);
    proportional(name, "Robertson", robertson, &requests, 10.0);
    proportional(name, "HIRES", hires, &requests, 10.0);
    // the first millisecond has rates 300 times those that are judged
    proportional(name, "stiff bushing", stiff_bushing, &requests, 300.0);
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

/// An oscillator that counts calls and goes wrong as told.
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

/// Where a run over a faulty problem stops, why, and after how many calls.
fn stop_of(
    row: &MethodRow,
    fault: fn(f64, &mut [f64]) -> Result<(), Failure>,
) -> (f64, Reason, usize) {
    let mut problem = Faulty { fault, calls: 0 };
    let options = options(1e-5);
    let mut method = ode_method::<Faulty>(row.name, 2, &options).unwrap();
    let stop = match method.start(&mut problem, 0.0, &[0.0, 1.0]) {
        Err(stop) => stop,
        Ok(()) => loop {
            match method.step(&mut problem, 10.0) {
                Ok(_) => assert!(method.t() < 10.0, "{} ran through a fault", row.name),
                Err(stop) => break stop,
            }
        },
    };
    (stop.t, stop.reason, problem.calls)
}

#[test]
fn a_fault_is_approached_and_then_named() {
    for row in METHODS {
        let (t, reason, calls) = stop_of(row, |t, ydot| {
            if t > 3.0 {
                ydot[1] = f64::NAN;
            }
            Ok(())
        });
        assert!(t <= 3.0 && t > 2.999, "{} stops at {t}", row.name);
        assert_eq!(reason, Reason::NotFinite(1), "{}", row.name);
        assert!(calls < 20_000, "{}: {calls} calls", row.name);

        let failure = |what, recoverable| Failure { what, recoverable };
        let (t, reason, calls) = stop_of(row, |t, _| {
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
        assert_eq!(reason, Reason::Evaluation(failure(7, true)), "{}", row.name);
        assert!(calls < 20_000, "{}: {calls} calls", row.name);

        let (t, reason, _) = stop_of(row, |t, _| {
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
            Reason::Evaluation(failure(8, false)),
            "{}",
            row.name
        );

        let (t, reason, calls) = stop_of(row, |_, ydot| {
            ydot[0] = f64::INFINITY;
            Ok(())
        });
        assert_eq!((t, reason), (0.0, Reason::NotFinite(0)), "{}", row.name);
        assert!(calls < 20_000, "{}: {calls} calls", row.name);
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
    for row in METHODS {
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
fn a_guess_of_the_first_step_that_is_too_short_is_no_reason_to_stop() {
    struct Relaxation;
    impl Field for Relaxation {
        fn size(&self) -> usize {
            1
        }
        fn rate<S: cognate::scalar::Scalar>(&self, t: S, y: &[S], ydot: &mut [S]) {
            ydot[0] = (t.cos() - y[0]).scale(1e18);
        }
    }
    struct Pole;
    impl Field for Pole {
        fn size(&self) -> usize {
            1
        }
        fn rate<S: cognate::scalar::Scalar>(&self, _t: S, y: &[S], ydot: &mut [S]) {
            ydot[0] = y[0].square();
        }
    }
    let options = Options {
        h_min: 1e-12,
        ..options(1e-4)
    };
    // a million time constants lie in the shortest step, which an implicit method takes
    let mut problem = System::new(Relaxation);
    let mut method = ode_method("RADAU5", 1, &options).unwrap();
    method.start(&mut problem, 0.0, &[0.0]).unwrap();
    while method.t() < 1.0 {
        method.step(&mut problem, 1.0).unwrap();
    }
    assert!((method.y()[0] - 1.0_f64.cos()).abs() < 1e-4);
    // the whole way to the pole at 1e-15 lies in it
    for row in METHODS {
        let mut problem = System::new(Pole);
        let mut method = ode_method(row.name, 1, &options).unwrap();
        method.start(&mut problem, 0.0, &[1e15]).unwrap();
        let stop = method.step(&mut problem, 1.0).unwrap_err();
        assert_eq!(stop.t, 0.0, "{}: {:?}", row.name, stop.reason);
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

/// An oscillator x, v told in x and v + K x: its rate is a small difference of large numbers, rounded in proportion to K.
struct Skewed(f64);

impl Ode for Skewed {
    fn size(&self) -> usize {
        2
    }
    fn rate(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let v = y[1] - self.0 * y[0];
        ydot[0] = v;
        ydot[1] = -y[0] + self.0 * v;
        Ok(())
    }
    fn jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _jacobian: &mut [f64],
        _dfdt: &mut [f64],
    ) -> Result<(), Failure> {
        unreachable!("explicit methods never ask for it")
    }
    fn typical(&self, typical: &mut [f64]) {
        typical.copy_from_slice(&[1.0, self.0]);
    }
}

#[test]
fn a_request_below_rounding_takes_the_steps_of_one_that_is_not() {
    let run = |tolerance: f64| {
        let mut problem = Skewed(1e6);
        let mut method = ode_method::<Skewed>("DOP853", 2, &options(tolerance)).expect("there");
        method
            .start(&mut problem, 0.0, &[1.0, 1e6])
            .expect("it can start");
        while method.t() < 10.0 {
            method.step(&mut problem, 10.0).expect("it can go on");
        }
        let off = (method.y()[0] - 10f64.cos()).abs();
        (off, *method.stats())
    };
    // a rate of size one is off by 1e-10, K times the last place
    let (off, within) = run(1e-8);
    assert!(
        off < 1e-6 && within.below_rounding == 0,
        "{off:e} {within:?}"
    );
    for tolerance in [1e-11, 1e-12, 1e-13] {
        let (off, below) = run(tolerance);
        println!("{tolerance:e}: {off:e} {below:?}");
        // steps shorter in proportion to the request would be a thousand times more
        assert!(below.steps < 8 * within.steps, "{below:?} {within:?}");
        assert!(below.below_rounding > below.steps / 4, "{below:?}");
        // roundings of some hundred evaluations
        assert!(off < 3e-9, "{off:e}");
    }
}

/// An oscillator whose force is a curve through data: its third derivative jumps every [`Curve::KNOT`].
struct Curve;

impl Curve {
    const KNOT: f64 = 0.01;
    const ROUGHNESS: f64 = 2e-3;

    /// Returns the force at a place, and its potential: x and x²/2 beside a Bernoulli polynomial and its integral.
    fn at(x: f64) -> [f64; 2] {
        let s = (x / Self::KNOT).rem_euclid(1.0);
        let fourth = s * s * (1.0 - s) * (1.0 - s) - 1.0 / 30.0;
        let fifth = s * (s * s * (s * (s - 2.5) + 5.0 / 3.0) - 1.0 / 6.0);
        [
            x + Self::ROUGHNESS * fourth,
            0.5 * x * x + Self::ROUGHNESS * Self::KNOT * fifth / 5.0,
        ]
    }
}

impl Ode for Curve {
    fn size(&self) -> usize {
        2
    }
    fn rate(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.copy_from_slice(&[y[1], -Curve::at(y[0])[0]]);
        Ok(())
    }
    fn jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _jacobian: &mut [f64],
        _dfdt: &mut [f64],
    ) -> Result<(), Failure> {
        unreachable!("explicit methods never ask for it")
    }
    fn typical(&self, typical: &mut [f64]) {
        typical.fill(1.0);
    }
}

#[test]
fn a_curve_through_data_is_no_rounding_however_many_steps_it_takes() {
    for tolerance in [1e-8, 1e-12] {
        let mut method = ode_method::<Curve>("DOP853", 2, &options(tolerance)).expect("there");
        method
            .start(&mut Curve, 0.0, &[1.0, 0.0])
            .expect("it can start");
        while method.t() < 200.0 {
            method.step(&mut Curve, 200.0).expect("it can go on");
        }
        let (y, stats) = (method.y(), method.stats());
        let off = 0.5 * y[1] * y[1] + Curve::at(y[0])[1] - Curve::at(1.0)[1];
        println!("{tolerance:e}: {off:e} {stats:?}");
        // some are taken for rounding, more than the proof of it waits for
        assert!(stats.below_rounding > 500);
        assert!(off.abs() < stats.steps as f64 * tolerance, "{off:e}");
    }
}

/// A slow oscillator beside a fast one that hardly moves: q, Q, v, V.
struct Humming {
    told: bool,
}

const FAST: f64 = 1e6;

impl Ode for Humming {
    fn size(&self) -> usize {
        4
    }
    fn rate(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.copy_from_slice(&[y[2], y[3], -y[0], -FAST * FAST * y[1]]);
        Ok(())
    }
    fn jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        jacobian: &mut [f64],
        dfdt: &mut [f64],
    ) -> Result<(), Failure> {
        dfdt.fill(0.0);
        jacobian.fill(0.0);
        for (i, j, x) in [(0, 2, 1.0), (1, 3, 1.0), (2, 0, -1.0), (3, 1, -FAST * FAST)] {
            jacobian[i + 4 * j] = x;
        }
        Ok(())
    }
    fn typical(&self, typical: &mut [f64]) {
        typical.fill(1.0);
    }
    fn relations(&self, relations: &mut [Relation]) {
        for (k, relation) in relations.iter_mut().enumerate() {
            (relation.group, relation.share) = (Some(u32::from(k > 1)), 0.1);
            relation.rate_of = k.checked_sub(2).filter(|_| self.told);
        }
    }
}

#[test]
fn a_vibration_that_no_position_shows_is_not_followed() {
    let run = |told: bool, most: usize| {
        let mut problem = Humming { told };
        let allowed = Options {
            max_steps: most,
            ..options(1e-4)
        };
        let mut method = ode_method::<Humming>("RADAU5", 4, &allowed).expect("there");
        // a tenth of the slow speed, and an amplitude of 1e-7
        let start = [1.0, 0.0, 0.0, 0.1];
        method
            .start(&mut problem, 0.0, &start)
            .expect("it can start");
        while method.t() < 10.0 {
            if method.step(&mut problem, 10.0).is_err() {
                return (method.t(), f64::NAN, *method.stats());
            }
        }
        (10.0, (method.y()[0] - 10f64.cos()).abs(), *method.stats())
    };
    let (_, off, stats) = run(true, 20_000);
    println!("{off:e} {stats:?}");
    assert!(off < 1e-4, "{off:e} {stats:?}");
    assert!(stats.steps < 3000, "{stats:?}");
    // it would take a million periods
    let (reached, _, _) = run(false, 20_000);
    assert!(reached < 0.1, "{reached}");
}
