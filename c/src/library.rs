//! A user's library, loaded at run time, whose routines compute the USERs of a model.

use crate::door::{door, text, usage};
use crate::error::CognateError;
use crate::routines::{Routine, register, user};
use crate::session::{CognateSession, Inner};
use engine::Error;
use engine::diagnostic::Diagnostic;
use engine::model::{ElementId, ElementKind};
use libloading::Library;
use std::ffi::c_char;

/// A form of arguments.
#[derive(Clone, Copy)]
enum Form {
    Force,
    Output,
    Motion,
}

/// Kinds of elements whose USER a library can compute: the name of the routine where the dataset
/// gives none, and the form of its arguments.
const KINDS: &[(ElementKind, &str, Form)] = &[
    (ElementKind::Sforce, "sfosub", Form::Force),
    (ElementKind::Variable, "varsub", Form::Force),
    (ElementKind::Diff, "difsub", Form::Force),
    (ElementKind::Gforce, "gfosub", Form::Force),
    (ElementKind::Vforce, "vfosub", Form::Force),
    (ElementKind::Vtorque, "vtosub", Form::Force),
    (ElementKind::Request, "reqsub", Form::Output),
    (ElementKind::Sensor, "sensub", Form::Output),
    (ElementKind::Motion, "motsub", Form::Motion),
];

impl Form {
    /// Looks for a routine by the names that compilers of C and of Fortran give it.
    fn find(self, library: &Library, name: &str) -> Option<Routine> {
        let lower = name.to_lowercase();
        let names = [
            name.to_owned(),
            lower.clone(),
            format!("{lower}_"),
            name.to_uppercase(),
        ];
        names.iter().find_map(|name| {
            // SAFETY: a routine of this name has the arguments of its kind (documented); it is
            // called while the library is loaded, as the session goes before it
            unsafe {
                match self {
                    Form::Force => library
                        .get(name.as_bytes())
                        .ok()
                        .map(|f| Routine::Force(*f)),
                    Form::Output => library
                        .get(name.as_bytes())
                        .ok()
                        .map(|f| Routine::Output(*f)),
                    Form::Motion => library
                        .get(name.as_bytes())
                        .ok()
                        .map(|f| Routine::Motion(*f)),
                }
            }
        })
    }
}

/// Registers routines of a library for all elements that have a USER.
fn load(inner: &mut Inner, library: Library, path: &str) -> Result<(), Error> {
    let model = &inner.session.model;
    let mut all: Vec<(ElementId, Option<Routine>, String)> = Vec::new();
    for &(kind, default, form) in KINDS {
        for id in model.numbers(kind).into_iter().map(|id| kind.id(id)) {
            let Some((_, routine)) = user(model, id) else {
                continue;
            };
            // ROUTINE=library::entry
            let entry = routine.map(|r| r.rsplit("::").next().unwrap_or(r));
            let entry = entry
                .map(str::trim)
                .filter(|e| !e.is_empty())
                .unwrap_or(default);
            all.push((id, form.find(&library, entry), entry.to_owned()));
        }
    }
    if all.is_empty() {
        let what = "no element of the model has a USER";
        return Err(usage(
            what,
            "FUNCTION=USER(…) in the dataset asks for a routine",
        ));
    }
    let missing: Vec<Diagnostic> = (all.iter())
        .filter(|(_, routine, _)| routine.is_none())
        .map(|(element, _, entry)| {
            let what = format!("{path} has no routine {entry}");
            let d = Diagnostic::error("user_routine", what).element(*element);
            d.help(format!(
                "it would be called {entry} or {}_",
                entry.to_lowercase()
            ))
        })
        .collect();
    if !missing.is_empty() {
        return Err(missing.into());
    }
    // kept before anything can call it
    inner.libraries.push(library);
    for (element, routine, _) in all {
        if let Some(routine) = routine {
            register(inner, element, routine)?;
        }
    }
    Ok(())
}

/// Loads a shared library and computes every USER of the model by its routines: those that ROUTINE
/// names, else sfosub, varsub, difsub, gfosub, vfosub, vtosub, reqsub, sensub, motsub.
///
/// Their names are looked for as written, in small letters, with an underscore behind (as Fortran
/// compilers write them), and in capitals. The library stays loaded until the session is given
/// back. It may call cognate_sysfnc, cognate_sysary, c_sysfnc and c_sysary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_load(
    session: *mut CognateSession,
    path: *const c_char,
    error: *mut *mut CognateError,
) -> bool {
    let work = || {
        // SAFETY: a handle and a text of the caller
        let (mut inner, path) = unsafe { (CognateSession::of(session)?, text(path, "path")?) };
        // SAFETY: the caller answers for what the library does when it is loaded
        let library = unsafe { Library::new(path) }.map_err(|e| {
            let mut d = Diagnostic::error("cannot_open", format!("cannot be loaded: {e}"));
            d.file = Some(path.to_owned());
            Error::from(d)
        })?;
        load(&mut inner, library, path)?;
        Ok(true)
    };
    // SAFETY: a place of the caller
    unsafe { door(error, false, work) }
}
