//! Shared libraries of routines: loading them, and calling what they have by one of the two
//! conventions of Adams. Together with `services.rs` the only code of this program that trusts a
//! pointer.
//!
//! ```text
//! by reference   Fortran: all arguments are addresses         sfosub_(&id, &t, par, &npar, …, value)
//! by structure   C: a structure of the element, and values    Sfosub(&sforce, t, dflag, iflag, value)
//! ```
//!
//! The structures have the layout that `slv_c_utils.h` of Adams gives them, as
//! `include/cognate_routines.h` writes it down.

use cognate::internals::system::asked::{Asked, within};
use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

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
/// The same three in C.
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
}

#[derive(Clone, Copy)]
enum Entry {
    Flagged(Flagged),
    Plain(Plain),
    System(System),
    FlaggedByStructure(FlaggedByStructure),
    PlainByStructure(PlainByStructure),
    SystemByStructure(SystemByStructure),
}

/// Returns whether a name is that of a routine in C: in mixed case.
pub fn is_mixed(name: &str) -> bool {
    name != name.to_lowercase() && name != name.to_uppercase()
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
        let library = unsafe { Library::open(Some(path), RTLD_NOW | RTLD_LOCAL) };
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
            form,
            _library: library,
        })
    }

    fn by_structure(&self, name: &str, form: Form) -> Option<Entry> {
        // SAFETY: a routine of this name has the arguments of its form, as the manual says; it is
        // called while the library is there
        unsafe {
            Some(match form {
                Form::Force | Form::Motion => Entry::FlaggedByStructure(self.symbol(name)?),
                Form::Output => Entry::PlainByStructure(self.symbol(name)?),
                Form::System => Entry::SystemByStructure(self.symbol(name)?),
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

/// Facts of an element that a structure of C tells, beside its number and the numbers of USER.
#[derive(Clone, Debug)]
pub enum Structure {
    /// SFORCE: I, J, whether it has no reaction, its type
    Single([c_int; 3], &'static CStr),
    /// VFORCE and VTORQUE: I, JFLOAT, RM; GFORCE: I, RM, JFLOAT
    Vector([c_int; 3]),
    /// VARIABLE: IC
    Variable(f64),
    /// DIFF: STATIC_HOLD and IMPLICIT; IC
    Differential([c_int; 2], [f64; 2]),
    /// MOTION: the numbers of its joint and its markers
    Motion {
        joint: c_int,
        kind: &'static CStr,
        markers: [c_int; 2],
        which: [u8; 2],
        level: &'static CStr,
    },
    /// REQUEST: COMMENT and TITLE
    Request(CString, [CString; 8]),
    /// SENSOR: VALUE and ERROR; the letters of its comparison
    Sensor([f64; 2], [u8; 2]),
    /// GSE: NI, NO, U, Y, NS, X, IC, STATIC_HOLD, IMPLICIT, STATICS_ONLY, ND, XD, ICD
    System([c_int; 13]),
}

#[repr(C)]
struct Head {
    id: c_int,
    npar: c_int,
    par: *const f64,
}

/// A structure that is a head and a rest.
#[repr(C)]
struct With<T>(Head, T);

#[repr(C)]
struct SingleRest([c_int; 3], *const c_char);

#[repr(C)]
struct DifferentialRest([c_int; 2], [f64; 2]);

#[repr(C)]
struct MotionRest {
    joint: c_int,
    kind: *const c_char,
    markers: [c_int; 2],
    which: [u8; 2],
    level: *const c_char,
}

#[repr(C)]
struct RequestRest(*const c_char, [*const c_char; 8]);

#[repr(C)]
struct SensorRest([f64; 2], [u8; 2]);

#[repr(C)]
struct SystemRest([c_int; 13], f64);

impl Structure {
    /// Calls a function with the address of the structure as C has it.
    fn lend(&self, head: Head, call: impl FnOnce(*const c_void)) {
        fn lent<T>(structure: &With<T>) -> *const c_void {
            std::ptr::from_ref(structure).cast()
        }
        match self {
            Structure::Single(numbers, kind) => {
                call(lent(&With(head, SingleRest(*numbers, kind.as_ptr()))));
            }
            Structure::Vector(numbers) => call(lent(&With(head, *numbers))),
            Structure::Variable(ic) => call(lent(&With(head, *ic))),
            Structure::Differential(flags, ic) => {
                call(lent(&With(head, DifferentialRest(*flags, *ic))));
            }
            Structure::Motion {
                joint,
                kind,
                markers,
                which,
                level,
            } => {
                let rest = MotionRest {
                    joint: *joint,
                    kind: kind.as_ptr(),
                    markers: *markers,
                    which: *which,
                    level: level.as_ptr(),
                };
                call(lent(&With(head, rest)));
            }
            Structure::Request(comment, title) => {
                let title = std::array::from_fn(|k| title[k].as_ptr());
                call(lent(&With(head, RequestRest(comment.as_ptr(), title))));
            }
            Structure::Sensor(numbers, logic) => {
                call(lent(&With(head, SensorRest(*numbers, *logic))));
            }
            Structure::System(numbers) => call(lent(&With(head, SystemRest(*numbers, 0.0)))),
        }
    }
}

/// The element that a routine is called for.
#[derive(Clone, Debug)]
pub struct Asker {
    /// its number
    pub id: c_int,
    /// what a structure of C tells of it
    pub structure: Structure,
    /// states and inputs of a GSE
    pub sizes: [usize; 2],
    /// numbers that the first call finds places for; of a GSE its rates and outputs
    pub results: usize,
}

/// A routine of a library that is loaded.
#[derive(Clone)]
pub struct Routine {
    entry: Entry,
    form: Form,
    _library: Arc<Loaded>,
}

/// Numbers that a routine finds places for, whatever its element takes.
const PLACES: usize = 64;

/// One call at a time: what is compiled from Fortran keeps numbers between its calls.
static CALL: Mutex<()> = Mutex::new(());

impl Routine {
    /// Calls it for an element with the numbers of USER, and fills its results; `states`: states
    /// and inputs of a GSE, one after the other. Returns what it has asked.
    pub fn call(
        &self,
        of: &Asker,
        par: &[f64],
        states: &[f64],
        asked: Asked,
        out: &mut [f64],
    ) -> Asked {
        let (time, is_first) = (asked.time, asked.is_first);
        let _alone = CALL.lock().unwrap_or_else(PoisonError::into_inner);
        within(asked, || {
            if self.form == Form::System {
                self.call_system(of, (time, par, is_first), states, out);
                return;
            }
            // a routine that fills more than its element takes still finds places
            let mut places = [0.0; PLACES];
            if self.form == Form::Motion {
                for (order, place) in places.iter_mut().take(3).enumerate() {
                    let mut value = [0.0; PLACES];
                    self.call_once(of, (time, par, is_first), order as c_int, &mut value);
                    *place = value[0];
                }
            } else {
                self.call_once(of, (time, par, is_first), 0, &mut places);
            }
            let n = out.len().min(PLACES);
            out[..n].copy_from_slice(&places[..n]);
        })
    }

    /// Calls a routine that has one row of results; `flag`: DFLAG, or the order of a derivative.
    fn call_once(
        &self,
        of: &Asker,
        (time, par, is_first): (f64, &[f64], bool),
        flag: c_int,
        places: &mut [f64; PLACES],
    ) {
        let (id, npar, iflag) = (of.id, par.len() as c_int, c_int::from(is_first));
        let (par, out) = (par.as_ptr(), places.as_mut_ptr());
        // SAFETY: the routine has the arguments of its form, as the manual says; what they point
        // to lives longer than the call
        unsafe {
            match self.entry {
                Entry::Flagged(f) => f(&id, &time, par, &npar, &flag, &iflag, out),
                Entry::Plain(f) => f(&id, &time, par, &npar, &iflag, out),
                Entry::FlaggedByStructure(f) => {
                    let call = |element| f(element, time, flag, iflag, out);
                    of.structure.lend(Head { id, npar, par }, call);
                }
                Entry::PlainByStructure(f) => {
                    let call = |element| f(element, time, iflag, out);
                    of.structure.lend(Head { id, npar, par }, call);
                }
                Entry::System(_) | Entry::SystemByStructure(_) => (),
            }
        }
    }

    /// Calls a routine that computes rates and outputs from states and inputs.
    fn call_system(
        &self,
        of: &Asker,
        (time, par, is_first): (f64, &[f64], bool),
        states: &[f64],
        out: &mut [f64],
    ) {
        let [n_states, n_inputs] = of.sizes;
        if states.len() != n_states + n_inputs || out.len() < n_states {
            return;
        }
        let (states, inputs) = states.split_at(n_states);
        let (rates, outputs) = out.split_at_mut(n_states);
        let (id, npar, iflag) = (of.id, par.len() as c_int, c_int::from(is_first));
        let counts = [n_states, n_inputs, outputs.len()].map(|n| n as c_int);
        let (x, u, par) = (states.as_ptr(), inputs.as_ptr(), par.as_ptr());
        let (rates, y) = (rates.as_mut_ptr(), outputs.as_mut_ptr());
        let [ns, ni, no] = &counts;
        // SAFETY: as in `call_once`
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
                _ => (),
            }
        }
    }
}
