//! Shared libraries of routines: loading them, and calling what they have by one of the two
//! conventions of Adams. Together with `services.rs` the only code of this program that trusts a
//! pointer.
//!
//! ```text
//! by reference   Fortran: all arguments are addresses         sfosub_(&id, &t, par, &npar, …, value)
//! by structure   C: a structure of the element, and values    Sfosub(&sforce, t, dflag, iflag, value)
//! ```

use super::forms::{Ask, Asker, Form, Moment};
use super::structures::Head;
use crate::{Exit, remark};
use cognate::diagnostic::{Cause, Diagnostic};
use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};
use std::ffi::{c_int, c_void};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Once};

/// SFOSUB and its like, and MOTSUB: id, time, par, npar, dflag or iord, iflag, results.
type Flagged = unsafe extern "C" fn(
    *const c_int,
    *const f64,
    *const f64,
    *const c_int,
    *const c_int,
    *const c_int,
    *mut f64,
);
/// REQSUB, SENSUB: id, time, par, npar, iflag, results.
type Plain = unsafe extern "C" fn(
    *const c_int,
    *const f64,
    *const f64,
    *const c_int,
    *const c_int,
    *mut f64,
);
/// GSESUB: id, time, par, npar, dflag, iflag, states, inputs, rates and outputs with their numbers.
type System = unsafe extern "C" fn(
    *const c_int,
    *const f64,
    *const f64,
    *const c_int,
    *const c_int,
    *const c_int,
    *const c_int,
    *const f64,
    *const c_int,
    *const f64,
    *const c_int,
    *mut f64,
    *mut f64,
);
/// COUSUB, COUXX, COUXX2: id, time, par, npar, displacements with their number, iflag, results.
type Coupler = unsafe extern "C" fn(
    *const c_int,
    *const f64,
    *const f64,
    *const c_int,
    *const f64,
    *const c_int,
    *const c_int,
    *mut f64,
);
/// CURSUB: id, par, npar, alpha, iord, iflag, results.
type Curve = unsafe extern "C" fn(
    *const c_int,
    *const f64,
    *const c_int,
    *const f64,
    *const c_int,
    *const c_int,
    *mut f64,
);
/// CNFSUB: id, time, par, npar, loci, ni, locj, nj, gap, gapdot, gapdotdot, area, dflag, iflag,
/// results.
type Normal = unsafe extern "C" fn(
    *const c_int,
    *const f64,
    *const f64,
    *const c_int,
    *const f64,
    *const f64,
    *const f64,
    *const f64,
    *const f64,
    *const f64,
    *const f64,
    *const f64,
    *const c_int,
    *const c_int,
    *mut f64,
);
/// CFFSUB: id, time, par, npar, loci, locj, x, xdot, nforce, area, dflag, iflag, results.
type Friction = unsafe extern "C" fn(
    *const c_int,
    *const f64,
    *const f64,
    *const c_int,
    *const f64,
    *const f64,
    *const f64,
    *const f64,
    *const f64,
    *const f64,
    *const c_int,
    *const c_int,
    *mut f64,
);
/// The same in C; the first is also CURSUB's, with alpha and iord.
type FlaggedByStructure = unsafe extern "C" fn(*const c_void, f64, c_int, c_int, *mut f64);
type PlainByStructure = unsafe extern "C" fn(*const c_void, f64, c_int, *mut f64);
type SystemByStructure = unsafe extern "C" fn(
    *const c_void,
    f64,
    c_int,
    c_int,
    c_int,
    *const f64,
    c_int,
    *const f64,
    c_int,
    *mut f64,
    *mut f64,
);

type CouplerByStructure = unsafe extern "C" fn(*const c_void, f64, *const f64, c_int, *mut f64);
type NormalByStructure = unsafe extern "C" fn(
    *const c_void,
    f64,
    *const f64,
    *const f64,
    *const f64,
    *const f64,
    f64,
    f64,
    f64,
    f64,
    c_int,
    c_int,
    *mut f64,
);
type FrictionByStructure = unsafe extern "C" fn(
    *const c_void,
    f64,
    *const f64,
    *const f64,
    *const f64,
    *const f64,
    f64,
    f64,
    c_int,
    c_int,
    *mut f64,
);

#[derive(Clone, Copy)]
enum Entry {
    Flagged(Flagged),
    Plain(Plain),
    System(System),
    Coupler(Coupler),
    Curve(Curve),
    Normal(Normal),
    Friction(Friction),
    FlaggedByStructure(FlaggedByStructure),
    PlainByStructure(PlainByStructure),
    SystemByStructure(SystemByStructure),
    CouplerByStructure(CouplerByStructure),
    NormalByStructure(NormalByStructure),
    FrictionByStructure(FrictionByStructure),
}

/// Returns whether a name is that of a routine in C: in mixed case.
pub fn is_mixed(name: &str) -> bool {
    name != name.to_lowercase() && name != name.to_uppercase()
}

/// Calls of routines that have not returned.
static WITHIN: AtomicUsize = AtomicUsize::new(0);

/// A call of what a library has, while it lasts.
struct Within;

impl Within {
    fn enter() -> Self {
        static WATCHED: Once = Once::new();
        // SAFETY: the handler reads one number and writes a line
        WATCHED.call_once(|| unsafe {
            atexit(ended);
        });
        WITHIN.fetch_add(1, Ordering::Relaxed);
        Within
    }
}

impl Drop for Within {
    fn drop(&mut self) {
        WITHIN.fetch_sub(1, Ordering::Relaxed);
    }
}

unsafe extern "C" {
    fn atexit(handler: extern "C" fn()) -> c_int;
    fn _exit(code: c_int) -> !;
}

/// Says, when the process ends, that a routine has ended it: a script must not take that for
/// success.
extern "C" fn ended() {
    if WITHIN.load(Ordering::Relaxed) > 0 {
        let what = "a routine of --routines has ended the program (exit); there are no results";
        let d = Diagnostic::error(Cause::UserRoutine, what);
        remark(d.to_string());
        // SAFETY: nothing of this process is needed any more
        unsafe { _exit(Exit::Stopped as c_int) }
    }
}

/// A library that was loaded. It stays so while a routine of it is there.
pub struct Loaded(Library);

impl Loaded {
    /// Loads a library, which runs its code.
    ///
    /// # Errors
    /// The words of the loader of the system.
    pub fn open(path: &Path) -> Result<Self, String> {
        super::services::keep();
        // SAFETY: the user has named this library so that its code runs. All of its symbols are
        // bound now: what is missing is told here, and does not end the process in a call.
        let within = Within::enter();
        let library = unsafe { Library::open(Some(path), RTLD_NOW | RTLD_LOCAL) };
        drop(within);
        library.map(Self).map_err(|e| e.to_string())
    }

    /// Looks for a routine of some form: by the name as it is written, where it is in mixed case
    /// by the convention of C, else by that of Fortran under the names that compilers give.
    pub fn find(self: &Arc<Self>, name: &str, form: Form) -> Option<Routine> {
        let lower = name.to_lowercase();
        let by_structure = is_mixed(name)
            .then(|| self.by_structure(name, form))
            .flatten();
        let entry = by_structure.or_else(|| {
            let names = [format!("{lower}_"), lower.clone(), name.to_uppercase()];
            names.iter().find_map(|name| self.by_reference(name, form))
        })?;
        let library = Arc::clone(self);
        Some(Routine {
            entry,
            _library: library,
        })
    }

    fn by_structure(&self, name: &str, form: Form) -> Option<Entry> {
        // SAFETY: a routine of this name has the arguments of its form, as the manual says; it is
        // called while the library is there
        unsafe {
            Some(match form {
                Form::Force | Form::Motion | Form::Curve => {
                    Entry::FlaggedByStructure(self.symbol(name)?)
                }
                Form::Output => Entry::PlainByStructure(self.symbol(name)?),
                Form::System => Entry::SystemByStructure(self.symbol(name)?),
                Form::Coupler => Entry::CouplerByStructure(self.symbol(name)?),
                Form::Normal => Entry::NormalByStructure(self.symbol(name)?),
                Form::Friction => Entry::FrictionByStructure(self.symbol(name)?),
            })
        }
    }

    fn by_reference(&self, name: &str, form: Form) -> Option<Entry> {
        // SAFETY: as in `by_structure`
        unsafe {
            Some(match form {
                Form::Force | Form::Motion => Entry::Flagged(self.symbol(name)?),
                Form::Output => Entry::Plain(self.symbol(name)?),
                Form::System => Entry::System(self.symbol(name)?),
                Form::Coupler => Entry::Coupler(self.symbol(name)?),
                Form::Curve => Entry::Curve(self.symbol(name)?),
                Form::Normal => Entry::Normal(self.symbol(name)?),
                Form::Friction => Entry::Friction(self.symbol(name)?),
            })
        }
    }

    /// Returns what stands at a name.
    ///
    /// # Safety
    /// It is of this type.
    unsafe fn symbol<T: Copy>(&self, name: &str) -> Option<T> {
        // SAFETY: the caller says so
        unsafe { self.0.get::<T>(name.as_bytes()) }
            .ok()
            .map(|symbol| *symbol)
    }
}

/// A routine of a library that is loaded.
#[derive(Clone)]
pub struct Routine {
    entry: Entry,
    _library: Arc<Loaded>,
}

/// Numbers that a routine finds places for, whatever its element takes.
const PLACES: usize = 64;
/// Contact areas and second rates of gaps, which nothing here knows.
const UNKNOWN: f64 = 0.0;

impl Routine {
    /// Calls it once, and fills its results.
    pub fn call(&self, of: &Asker, at: Moment<'_>, ask: &Ask<'_>, out: &mut [f64]) {
        let _within = Within::enter();
        if let Ask::System(states, inputs) = ask {
            self.call_system(of, at, (states, inputs), out);
            return;
        }
        // a routine that fills more than its element takes still finds places
        let mut places = [0.0; PLACES];
        self.call_with(of, at, ask, &mut places);
        let n = out.len().min(PLACES);
        out[..n].copy_from_slice(&places[..n]);
    }

    /// Calls a routine that has one row of results.
    fn call_with(&self, of: &Asker, at: Moment<'_>, ask: &Ask<'_>, places: &mut [f64; PLACES]) {
        let Moment { time, par, .. } = at;
        let (id, npar, iflag) = (of.id, par.len() as c_int, c_int::from(at.is_first));
        let (par, out) = (par.as_ptr(), places.as_mut_ptr());
        let lend = |call: &dyn Fn(*const c_void)| of.structure.lend(Head { id, npar, par }, call);
        // SAFETY: the routine has the arguments of its form, as the manual says; what they point
        // to lives longer than the call
        unsafe {
            match (self.entry, ask) {
                (Entry::Flagged(f), Ask::Plain(Some(flag))) => {
                    let flag = flag.number();
                    f(&id, &time, par, &npar, &flag, &iflag, out);
                }
                (Entry::Plain(f), Ask::Plain(_)) => f(&id, &time, par, &npar, &iflag, out),
                (Entry::Coupler(f), Ask::Coupler(disp)) => {
                    let n = disp.len() as c_int;
                    f(&id, &time, par, &npar, disp.as_ptr(), &n, &iflag, out);
                }
                (Entry::Curve(f), Ask::Curve(alpha, iord)) => {
                    f(&id, par, &npar, alpha, iord, &iflag, out);
                }
                (Entry::Normal(f), Ask::Normal(touch)) => {
                    let [i, ni, j, nj] = touch.vectors().map(|v| v.as_ptr());
                    let (gap, rate) = (&touch.gap, &touch.gap_rate);
                    f(
                        &id, &time, par, &npar, i, ni, j, nj, gap, rate, &UNKNOWN, &UNKNOWN, &0,
                        &iflag, out,
                    );
                }
                (Entry::Friction(f), Ask::Friction(slip)) => {
                    let [i, j, x, v] = slip.vectors().map(|v| v.as_ptr());
                    let n = &slip.normal_force;
                    f(
                        &id, &time, par, &npar, i, j, x, v, n, &UNKNOWN, &0, &iflag, out,
                    );
                }
                (Entry::FlaggedByStructure(f), Ask::Plain(Some(flag))) => {
                    lend(&|element| f(element, time, flag.number(), iflag, out));
                }
                (Entry::FlaggedByStructure(f), Ask::Curve(alpha, iord)) => {
                    lend(&|element| f(element, *alpha, *iord, iflag, out));
                }
                (Entry::PlainByStructure(f), Ask::Plain(_)) => {
                    lend(&|element| f(element, time, iflag, out));
                }
                (Entry::CouplerByStructure(f), Ask::Coupler(disp)) => {
                    lend(&|element| f(element, time, disp.as_ptr(), iflag, out));
                }
                (Entry::NormalByStructure(f), Ask::Normal(t)) => {
                    let [i, ni, j, nj] = t.vectors().map(|v| v.as_ptr());
                    let (gap, rate, no) = (t.gap, t.gap_rate, UNKNOWN);
                    lend(&|element| {
                        f(
                            element, time, i, ni, j, nj, gap, rate, no, no, 0, iflag, out,
                        );
                    });
                }
                (Entry::FrictionByStructure(f), Ask::Friction(s)) => {
                    let [i, j, x, v] = s.vectors().map(|v| v.as_ptr());
                    let (n, no) = (s.normal_force, UNKNOWN);
                    lend(&|element| f(element, time, i, j, x, v, n, no, 0, iflag, out));
                }
                _ => unreachable!("a routine is found by the form in which it is called"),
            }
        }
    }

    /// Calls a routine that computes rates and outputs from states and inputs.
    fn call_system(
        &self,
        of: &Asker,
        at: Moment<'_>,
        (states, inputs): (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        let Moment { time, par, .. } = at;
        let (rates, outputs) = out.split_at_mut(states.len().min(out.len()));
        let (id, npar, iflag) = (of.id, par.len() as c_int, c_int::from(at.is_first));
        let counts = [states.len(), inputs.len(), outputs.len()].map(|n| n as c_int);
        let (x, u, par) = (states.as_ptr(), inputs.as_ptr(), par.as_ptr());
        let (rates, y) = (rates.as_mut_ptr(), outputs.as_mut_ptr());
        let [ns, ni, no] = &counts;
        // SAFETY: as in `call_with`
        unsafe {
            match self.entry {
                Entry::System(f) => {
                    f(
                        &id, &time, par, &npar, &0, &iflag, ns, x, ni, u, no, rates, y,
                    );
                }
                Entry::SystemByStructure(f) => {
                    let call = |gse| f(gse, time, 0, iflag, *ns, x, *ni, u, *no, rates, y);
                    of.structure.lend(Head { id, npar, par }, call);
                }
                _ => unreachable!("a routine is found by the form in which it is called"),
            }
        }
    }
}
