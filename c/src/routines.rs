//! USER as C callbacks: those of Adams by its argument lists, and one with data of the caller's.
//!
//! Arguments are pointers, as Fortran passes them, so that routines in C and in Fortran have the
//! same form:
//!
//! ```text
//! SFOSUB VARSUB DIFSUB GFOSUB VFOSUB VTOSUB   (id, time, par, npar, dflag, iflag, results)
//! REQSUB SENSUB                               (id, time, par, npar, iflag, results)
//! MOTSUB                                      (id, time, par, npar, iord, iflag, value)
//! ```

use crate::door::{Data, door, row, text, usage};
use crate::error::CognateError;
use crate::session::{CognateSession, Failure, Inner};
use engine::Error;
use engine::diagnostic::Diagnostic;
use engine::internals::system::asked::{Asked, within};
use engine::internals::system::closures::Call;
use engine::model::ElementKind as K;
use engine::model::{ElementId, ElementKind, Formula, Model};
use std::ffi::{c_char, c_int, c_void};
use std::sync::Arc;

/// A routine of the form SFOSUB: fills `results`, which are zero, with 1 number for SFORCE,
/// VARIABLE and DIFF, 6 for GFORCE (FX, FY, FZ, TX, TY, TZ), 3 for VFORCE and VTORQUE.
///
/// `par`: the `*npar` numbers of USER. `*iflag` is 1 in the first call, which tells by
/// cognate_sysfnc and cognate_sysary what the routine reads, else 0. `*dflag` is always 0:
/// derivatives are found by differences, with the same calls.
pub type CognateForceRoutine = Option<
    extern "C" fn(
        id: *const c_int,
        time: *const f64,
        par: *const f64,
        npar: *const c_int,
        dflag: *const c_int,
        iflag: *const c_int,
        results: *mut f64,
    ),
>;

/// A routine of the form REQSUB: fills `results`, which are zero, with 8 numbers for REQUEST, 1 for
/// SENSOR.
pub type CognateOutputRoutine = Option<
    extern "C" fn(
        id: *const c_int,
        time: *const f64,
        par: *const f64,
        npar: *const c_int,
        iflag: *const c_int,
        results: *mut f64,
    ),
>;

/// MOTSUB: fills `value` with the value of the motion (`*iord` = 0) or its first or second
/// derivative in time.
pub type CognateMotionRoutine = Option<
    extern "C" fn(
        id: *const c_int,
        time: *const f64,
        par: *const f64,
        npar: *const c_int,
        iord: *const c_int,
        iflag: *const c_int,
        value: *mut f64,
    ),
>;

/// A routine with data of the caller's: fills `results`, which are zero.
///
/// `constants`: the numbers of USER. `values`: those of the expressions that it was registered
/// with. Returns false where it cannot; the simulation then ends with a mistake.
pub type CognateRoutine = Option<
    extern "C" fn(
        data: *mut c_void,
        time: f64,
        constants: *const f64,
        n_constants: usize,
        values: *const f64,
        n_values: usize,
        results: *mut f64,
        n_results: usize,
    ) -> bool,
>;

/// A routine by the form of its arguments.
#[derive(Clone, Copy)]
pub enum Routine {
    /// SFOSUB and its like
    Force(
        extern "C" fn(
            *const c_int,
            *const f64,
            *const f64,
            *const c_int,
            *const c_int,
            *const c_int,
            *mut f64,
        ),
    ),
    /// REQSUB, SENSUB
    Output(
        extern "C" fn(*const c_int, *const f64, *const f64, *const c_int, *const c_int, *mut f64),
    ),
    /// MOTSUB
    Motion(
        extern "C" fn(
            *const c_int,
            *const f64,
            *const f64,
            *const c_int,
            *const c_int,
            *const c_int,
            *mut f64,
        ),
    ),
}

use Routine::{Force, Motion, Output};

/// Numbers that any routine fills, at most.
const MOST_RESULTS: usize = 8;

impl Routine {
    /// Calls the routine of an element.
    fn call(self, id: c_int, time: f64, par: &[f64], first: bool, results: &mut [f64]) {
        let (npar, dflag, iflag) = (par.len() as c_int, 0, c_int::from(first));
        // a routine that fills more than its element takes still finds places
        let mut out = [0.0; MOST_RESULTS];
        match self {
            Routine::Force(f) => {
                f(
                    &id,
                    &time,
                    par.as_ptr(),
                    &npar,
                    &dflag,
                    &iflag,
                    out.as_mut_ptr(),
                );
            }
            Routine::Output(f) => {
                f(&id, &time, par.as_ptr(), &npar, &iflag, out.as_mut_ptr());
            }
            Routine::Motion(f) => {
                for (place, iord) in out.iter_mut().zip(0..3) {
                    f(&id, &time, par.as_ptr(), &npar, &iord, &iflag, place);
                }
            }
        }
        let n = results.len().min(MOST_RESULTS);
        results[..n].copy_from_slice(&out[..n]);
    }
}

/// Returns the numbers of the USER of an element, and its ROUTINE.
pub fn user(model: &Model, element: ElementId) -> Option<(&[f64], Option<&str>)> {
    let formulas = model.element(element)?.formulas();
    formulas.into_iter().find_map(|(_, formula)| match formula {
        Formula::User { constants, routine } => Some((&constants[..], routine.as_deref())),
        Formula::Expression { .. } => None,
    })
}

/// Registers the routine of one element: calls it once, to find out what it reads.
pub fn register(inner: &mut Inner, element: ElementId, routine: Routine) -> Result<(), Error> {
    let Some((constants, _)) = user(&inner.session.model, element) else {
        let what = format!("{element} has no USER that a routine could compute");
        return Err(usage(
            what,
            "FUNCTION=USER(…) in the dataset asks for a routine",
        ));
    };
    let id = c_int::try_from(element.number).unwrap_or(c_int::MAX);
    let mut nothing = [0.0; MOST_RESULTS];
    let first = within(Asked::first(), || {
        routine.call(id, 0.0, constants, true, &mut nothing)
    });
    let known = Arc::new(first.found);
    let inputs = known.inputs.clone();
    let names: Vec<&str> = inputs.iter().map(String::as_str).collect();
    let failure = inner.failure.clone();
    inner
        .session
        .register(&element.to_string(), &names, move |call, results| {
            let asked = Asked {
                questions: Arc::clone(&known),
                values: call.values.to_vec(),
                time: call.time,
                ..Asked::default()
            };
            let asked = within(asked, || {
                routine.call(id, call.time, call.constants, false, results)
            });
            if let Some(input) = asked.lacking {
                let what = format!("its routine has asked for {input}, but not in its first call");
                let d = Diagnostic::error("user_routine", what).element(element);
                failure.keep(d.help("with iflag = 1 it must ask for everything that it reads"));
            }
            see(&failure, call, results);
        });
    Ok(())
}

/// Keeps the complaint about a result that is no finite number.
fn see(failure: &Failure, call: &Call<'_>, results: &mut [f64]) {
    if let Some(x) = results.iter_mut().find(|x| !x.is_finite()) {
        let what = format!("its routine has computed {x} at time {}", call.time);
        failure.keep(Diagnostic::error("user_routine", what).element(call.element));
        *x = 0.0;
    }
}

/// Registers a routine for an element, or, with number 0, for all of its kind that have a USER.
unsafe fn register_for(
    session: *mut CognateSession,
    kind: ElementKind,
    id: u32,
    routine: Option<Routine>,
    error: *mut *mut CognateError,
) -> bool {
    let work = || {
        // SAFETY: a handle of the caller
        let mut inner = unsafe { CognateSession::of(session) }?;
        let routine =
            routine.ok_or_else(|| usage("routine is NULL", "give the address of a function"))?;
        if id > 0 {
            register(&mut inner, kind.id(id), routine)?;
            return Ok(true);
        }
        let model = &inner.session.model;
        let mut all: Vec<u32> = model.numbers(kind);
        all.retain(|id| user(model, kind.id(*id)).is_some());
        if all.is_empty() {
            let what = format!("no {kind} has a USER");
            return Err(usage(
                what,
                "FUNCTION=USER(…) in the dataset asks for a routine",
            ));
        }
        for id in all {
            register(&mut inner, kind.id(id), routine)?;
        }
        Ok(true)
    };
    // SAFETY: a place of the caller
    unsafe { door(error, false, work) }
}

/// Computes SFORCE/id, or with id 0 all SFORCEs that have a USER, by SFOSUB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_sfosub(
    session: *mut CognateSession,
    id: u32,
    routine: CognateForceRoutine,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: the caller keeps the promises of the header
    unsafe { register_for(session, K::Sforce, id, routine.map(Force), error) }
}

/// Computes VARIABLE/id, or with id 0 all VARIABLEs that have a USER, by VARSUB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_varsub(
    session: *mut CognateSession,
    id: u32,
    routine: CognateForceRoutine,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: the caller keeps the promises of the header
    unsafe { register_for(session, K::Variable, id, routine.map(Force), error) }
}

/// Computes DIFF/id, or with id 0 all DIFFs that have a USER, by DIFSUB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_difsub(
    session: *mut CognateSession,
    id: u32,
    routine: CognateForceRoutine,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: the caller keeps the promises of the header
    unsafe { register_for(session, K::Diff, id, routine.map(Force), error) }
}

/// Computes GFORCE/id, or with id 0 all GFORCEs that have a USER, by GFOSUB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_gfosub(
    session: *mut CognateSession,
    id: u32,
    routine: CognateForceRoutine,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: the caller keeps the promises of the header
    unsafe { register_for(session, K::Gforce, id, routine.map(Force), error) }
}

/// Computes VFORCE/id, or with id 0 all VFORCEs that have a USER, by VFOSUB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_vfosub(
    session: *mut CognateSession,
    id: u32,
    routine: CognateForceRoutine,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: the caller keeps the promises of the header
    unsafe { register_for(session, K::Vforce, id, routine.map(Force), error) }
}

/// Computes VTORQUE/id, or with id 0 all VTORQUEs that have a USER, by VTOSUB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_vtosub(
    session: *mut CognateSession,
    id: u32,
    routine: CognateForceRoutine,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: the caller keeps the promises of the header
    unsafe { register_for(session, K::Vtorque, id, routine.map(Force), error) }
}

/// Computes REQUEST/id, or with id 0 all REQUESTs that have a USER, by REQSUB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_reqsub(
    session: *mut CognateSession,
    id: u32,
    routine: CognateOutputRoutine,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: the caller keeps the promises of the header
    unsafe { register_for(session, K::Request, id, routine.map(Output), error) }
}

/// Computes SENSOR/id, or with id 0 all SENSORs that have a USER, by SENSUB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_sensub(
    session: *mut CognateSession,
    id: u32,
    routine: CognateOutputRoutine,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: the caller keeps the promises of the header
    unsafe { register_for(session, K::Sensor, id, routine.map(Output), error) }
}

/// Computes MOTION/id, or with id 0 all MOTIONs that have a USER, by MOTSUB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_motsub(
    session: *mut CognateSession,
    id: u32,
    routine: CognateMotionRoutine,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: the caller keeps the promises of the header
    unsafe { register_for(session, K::Motion, id, routine.map(Motion), error) }
}

/// Computes what USER stands for by a routine with data of the caller's.
///
/// `name`: an element ("SFORCE/3"), the text of its ROUTINE, or the first number of USER.
/// `inputs`: `n_inputs` expressions whose values the routine is given, in this order.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_user(
    session: *mut CognateSession,
    name: *const c_char,
    inputs: *const *const c_char,
    n_inputs: usize,
    routine: CognateRoutine,
    data: *mut c_void,
    error: *mut *mut CognateError,
) -> bool {
    let work = || {
        // SAFETY: a handle, and texts of the caller
        let (mut inner, name) = unsafe { (CognateSession::of(session)?, text(name, "name")?) };
        // SAFETY: as before
        let inputs = unsafe { row(inputs, n_inputs, "inputs") }?.iter();
        // SAFETY: as before
        let inputs = inputs.map(|input| unsafe { text(*input, "an input") });
        let inputs = inputs.collect::<Result<Vec<_>, _>>()?;
        let routine =
            routine.ok_or_else(|| usage("routine is NULL", "give the address of a function"))?;
        let wrong: Vec<_> = (inputs.iter())
            .flat_map(|input| inner.session.model.check_expression(input))
            .collect();
        if !wrong.is_empty() {
            return Err(wrong.into());
        }
        let (failure, data) = (inner.failure.clone(), Data(data));
        inner.session.register(name, &inputs, move |call, results| {
            let Call {
                constants, values, ..
            } = call;
            let went = routine(
                data.pointer(),
                call.time,
                constants.as_ptr(),
                constants.len(),
                values.as_ptr(),
                values.len(),
                results.as_mut_ptr(),
                results.len(),
            );
            if !went {
                let what = format!("its routine has failed at time {}", call.time);
                failure.keep(Diagnostic::error("user_routine", what).element(call.element));
            }
            see(&failure, call, results);
        });
        Ok(true)
    };
    // SAFETY: a place of the caller
    unsafe { door(error, false, work) }
}
