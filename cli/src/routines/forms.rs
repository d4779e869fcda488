//! Calls that compute what one `USER(…)` stands for: how often a routine is called, with which
//! arguments, and what becomes of its results.

use super::library;
use super::python;
use super::structures::Structure;
use cognate::internals::physics::contact::{Pressing, Slipping};
use cognate::internals::scene::coupled::Partials;
use cognate::internals::space::Vec3;
use cognate::internals::system::asked::{self, Asked, within};
use std::ffi::c_int;
use std::sync::{Mutex, PoisonError};

/// The arguments that a routine has, by the kind of its element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// with DFLAG
    Force,
    /// without
    Output,
    /// with the order of the derivative in the place of DFLAG, called for each of three
    Motion,
    /// with states and inputs
    System,
    /// with displacements of joints, and its partial derivatives by routines of their own
    Coupler,
    /// with the parameter of a curve, and the order of the derivative
    Curve,
    /// with where two solids touch
    Normal,
    /// with how they slip there
    Friction,
}

/// The arguments of one call, beside the element, time and flags.
#[derive(Clone, Debug)]
pub enum Ask<'a> {
    /// a flag, where there is one
    Plain(Option<Flag>),
    /// states and inputs of a GSE
    System(&'a [f64], &'a [f64]),
    /// displacements
    Coupler(&'a [f64]),
    /// ALPHA and IORD
    Curve(f64, c_int),
    /// a touch
    Normal(Touch),
    /// a touch that slips
    Friction(Slip),
}

/// A flag between time and IFLAG.
#[derive(Clone, Copy, Debug)]
pub enum Flag {
    /// DFLAG, which is false
    Derivatives,
    /// IORD
    Order(c_int),
}

impl Flag {
    /// Returns the flag as C has it.
    pub fn number(self) -> c_int {
        match self {
            Flag::Derivatives => 0,
            Flag::Order(order) => order,
        }
    }
}

/// A touch: points and normals of both solids, each in the frame of its marker.
#[derive(Clone, Debug)]
pub struct Touch {
    on_i: [[f64; 3]; 2],
    on_j: [[f64; 3]; 2],
    /// negative: they overlap
    pub gap: f64,
    /// its rate
    pub gap_rate: f64,
}

impl Touch {
    /// Returns LOCI, NI, LOCJ, NJ.
    pub fn vectors(&self) -> [&[f64; 3]; 4] {
        let ([i, ni], [j, nj]) = (&self.on_i, &self.on_j);
        [i, ni, j, nj]
    }
}

/// A touch that slips.
#[derive(Clone, Debug)]
pub struct Slip {
    points: [[f64; 3]; 2],
    speed: [f64; 3],
    /// force along the normal
    pub normal_force: f64,
}

impl Slip {
    /// Returns LOCI, LOCJ, X, XDOT: axis 1 is along the slip, and nothing sticks.
    pub fn vectors(&self) -> [&[f64; 3]; 4] {
        let [i, j] = &self.points;
        [i, j, &[0.0; 3], &self.speed]
    }
}

/// Time, the numbers of USER, and whether it is the call that finds out what a routine reads.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    pub time: f64,
    pub par: &'a [f64],
    pub is_first: bool,
}

/// The element that a routine is called for.
#[derive(Clone, Debug)]
pub struct Asker {
    /// its number
    pub id: c_int,
    /// what a structure of C tells of it
    pub structure: Structure,
    /// numbers that it is given beside what it reads; of a GSE its states and inputs
    pub given: [usize; 2],
    /// numbers that the first call finds places for; of a GSE its rates and outputs
    pub results: usize,
}

/// A routine of a library, or of a file of Python.
#[derive(Clone)]
pub enum Routine {
    Compiled(library::Routine),
    Python(python::Routine),
}

/// A routine, and those that compute its partial derivatives.
#[derive(Clone)]
pub struct Found {
    pub form: Form,
    pub routine: Routine,
    /// COUXX and COUXX2
    pub partials: [Option<Routine>; 2],
}

/// Slip speed below which friction is taken to grow with it in proportion   [length/time]
const LEAST_SLIP: f64 = 1e-6;

/// One call at a time: what is compiled from Fortran keeps numbers between its calls.
static CALL: Mutex<()> = Mutex::new(());

/// Outcome of the calls of a routine, beside its results.
pub struct Done {
    /// what it has asked and said
    pub asked: Asked,
    /// a result that is no finite number
    pub odd: Option<f64>,
}

impl Found {
    /// Calls it for an element with the numbers of USER, and fills what its closure returns.
    /// `values`: what the closure is given beside what the routine reads.
    pub fn compute(
        &self,
        of: &Asker,
        par: &[f64],
        values: &[f64],
        asked: Asked,
        out: &mut [f64],
    ) -> Done {
        let at = Moment {
            time: asked.time,
            par,
            is_first: asked.is_first,
        };
        let mut odd = None;
        let mut call = |routine: &Routine, ask: Ask<'_>, out: &mut [f64]| {
            out.fill(0.0);
            match routine {
                Routine::Compiled(routine) => routine.call(of, at, &ask, out),
                Routine::Python(routine) => routine.call(of, at, &ask, out),
            }
            for x in out.iter_mut().filter(|x| !x.is_finite()) {
                odd.get_or_insert(*x);
                *x = 0.0;
            }
        };
        let _alone = CALL.lock().unwrap_or_else(PoisonError::into_inner);
        let asked = within(asked, || {
            self.calls(of, at.is_first, values, out, &mut call);
        });
        Done { asked, odd }
    }

    fn calls(
        &self,
        of: &Asker,
        is_first: bool,
        values: &[f64],
        out: &mut [f64],
        call: &mut dyn FnMut(&Routine, Ask<'_>, &mut [f64]),
    ) {
        let routine = &self.routine;
        match self.form {
            Form::Force => call(routine, Ask::Plain(Some(Flag::Derivatives)), out),
            Form::Output => call(routine, Ask::Plain(None), out),
            Form::Motion => {
                for (order, out) in (0..3).zip(out.chunks_mut(1)) {
                    call(routine, Ask::Plain(Some(Flag::Order(order))), out);
                }
            }
            Form::System => {
                let (states, inputs) = values.split_at(of.given[0].min(values.len()));
                call(routine, Ask::System(states, inputs), out);
            }
            Form::Coupler => {
                let n = values.len();
                let places = Partials(n);
                call(routine, Ask::Coupler(values), &mut out[..1]);
                if let Some(first) = &self.partials[0] {
                    call(first, Ask::Coupler(values), &mut out[1..=n]);
                }
                if let Some(second) = &self.partials[1] {
                    let mut all = vec![0.0; n * n];
                    call(second, Ask::Coupler(values), &mut all);
                    for k in 0..n {
                        (k..n).for_each(|l| out[places.second(k, l)] = all[k * n + l]);
                    }
                }
            }
            Form::Curve => {
                if let [alpha, order] = values {
                    call(routine, Ask::Curve(*alpha, *order as c_int), out);
                }
            }
            Form::Normal => {
                for (touch, out) in values.as_chunks().0.iter().zip(out) {
                    let touch = Pressing::from_numbers(touch);
                    if touch.gap > 0.0 && !is_first {
                        continue;
                    }
                    let mut force = [0.0; 3];
                    let ask = Ask::Normal(Touch {
                        on_i: touch.on_i.map(|v| v.0),
                        on_j: touch.on_j.map(|v| v.0),
                        gap: touch.gap,
                        gap_rate: touch.gap_rate,
                    });
                    call(routine, ask, &mut force);
                    *out = along_first(force, "its force along the normal is RESULT(1)");
                }
            }
            Form::Friction => {
                for (touch, out) in values.as_chunks().0.iter().zip(out.chunks_mut(3)) {
                    let touch = Slipping::from_numbers(touch);
                    if touch.normal_force == 0.0 && !is_first {
                        continue;
                    }
                    let speed = touch.velocity.norm().max(LEAST_SLIP);
                    let mut force = [0.0; 3];
                    let ask = Ask::Friction(Slip {
                        points: touch.points.map(|v| v.0),
                        speed: [speed, 0.0, 0.0],
                        normal_force: touch.normal_force,
                    });
                    call(routine, ask, &mut force);
                    let along = along_first(force, "its friction along the slip is RESULT(1)");
                    let Vec3(force) = touch.velocity.times(along / speed);
                    out.copy_from_slice(&force);
                }
            }
        }
    }
}

/// Returns the component of a contact's force that counts; the run ends where there are others.
fn along_first([first, others @ ..]: [f64; 3], what: &str) -> f64 {
    if others != [0.0; 2] {
        let all = format!("{what}, but RESULT(2) and RESULT(3) are {others:?}");
        asked::note(&all, true);
    }
    first
}
