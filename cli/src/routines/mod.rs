//! `--routines`: shared libraries and files of Python whose routines compute what `USER(…)` stands
//! for.
//!
//! They are loaded because the option says so, and never because a file does: opening somebody
//! else's dataset runs no code. ROUTINE=library::entry chooses among the libraries that were given.
//!
//! Each routine is called once with IFLAG true, before anything is computed: what it asks for then
//! becomes the inputs of the closure that calls it from then on.

mod elements;
mod forms;
mod library;
mod python;
mod services;
mod structures;

use super::mistake::Mistake;
use super::{Failure, remark};
use cognate::analysis::session::Session;
use cognate::analysis::sweep::Sweep;
use cognate::dataset::{Dataset, Reading};
use cognate::diagnostic::{Cause, Diagnostic, Severity, counted};
use cognate::disk;
use cognate::internals::system::asked::Asked;
use cognate::internals::system::closures::{Call, Hook};
use cognate::model::{ElementId, ElementKind as K, Formula, Model};
use cognate::results::Event;
use elements::asker;
use forms::{Asker, Form, Found, Routine};
use library::is_mixed;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The libraries of routines.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct RoutineArgs {
    /// Shared library, or file of Python (.py), of routines that compute what USER(…) stands for
    /// (repeatable). Its code is run, with your rights: give what you trust [default: none]
    #[arg(long = "routines", value_name = "LIBRARY")]
    libraries: Vec<PathBuf>,
}

/// Kinds of elements whose USER a library can compute: the routine where the dataset names none,
/// and its arguments.
const KINDS: [(K, &str, &str, Form); 14] = [
    (K::Sforce, FUNCTION, "Sfosub", Form::Force),
    (K::Vforce, FUNCTION, "Vfosub", Form::Force),
    (K::Vtorque, FUNCTION, "Vtosub", Form::Force),
    (K::Gforce, FUNCTION, "Gfosub", Form::Force),
    (K::Variable, FUNCTION, "Varsub", Form::Force),
    (K::Diff, FUNCTION, "Difsub", Form::Force),
    (K::Motion, FUNCTION, "Motsub", Form::Motion),
    (K::Request, FUNCTION, "Reqsub", Form::Output),
    (K::Sensor, FUNCTION, "Sensub", Form::Output),
    (K::Gse, FUNCTION, "Gsesub", Form::System),
    (K::Coupler, FUNCTION, COUSUB, Form::Coupler),
    (K::Curve, FUNCTION, "Cursub", Form::Curve),
    (K::Contact, FUNCTION, "Cnfsub", Form::Normal),
    (K::Contact, FRICTION_FUNCTION, "Cffsub", Form::Friction),
];

/// Size of what a routine is told from which on its results may overflow.
const FARTHEST: f64 = 1e100;

const FUNCTION: &str = "FUNCTION";
const FRICTION_FUNCTION: &str = "FRICTION_FUNCTION";
const COUSUB: &str = "Cousub";
/// Routines of the partial derivatives of what COUSUB computes.
const PARTIALS: [&str; 2] = ["Couxx", "Couxx2"];

/// A library, or a file of Python.
#[derive(Clone)]
enum Library {
    Compiled(Arc<library::Loaded>),
    Python(Arc<python::Loaded>),
}

impl Library {
    fn find(&self, name: &str, form: Form) -> Option<Routine> {
        match self {
            Library::Compiled(loaded) => loaded.find(name, form).map(Routine::Compiled),
            Library::Python(loaded) => loaded.find(name).map(Routine::Python),
        }
    }
}

/// A `USER(…)` that a routine is to compute.
struct Wanted<'m> {
    element: ElementId,
    /// the argument where it stands
    argument: &'static str,
    constants: &'m [f64],
    /// library and entry that the dataset names
    library: Option<&'m str>,
    entry: &'m str,
    form: Form,
}

impl RoutineArgs {
    /// Loads the libraries and has their routines compute the USERs of a session; `zero_user`: what
    /// no library has is zero.
    ///
    /// # Errors
    /// Libraries that cannot be loaded, routines that none of them has, kinds of elements whose
    /// routines are not called.
    pub fn compute(
        &self,
        session: &mut Session,
        dataset: &Dataset,
        zero_user: bool,
    ) -> Result<Mistake, Failure> {
        let mistake = Mistake::default();
        let hooks = self.hooks(&session.model, dataset, zero_user, &mistake)?;
        hooks
            .into_iter()
            .for_each(|hook| session.register_hook(hook));
        let names = self.libraries.iter().map(disk::text);
        let event = |name| Event::Info(format!("routines: {name}"));
        session.run.log.extend(names.map(event));
        Ok(mistake)
    }

    /// Has the routines compute the USERs of all runs of a sweep.
    ///
    /// # Errors
    /// Those of [`compute`](Self::compute).
    pub fn compute_in(
        &self,
        sweep: &mut Sweep,
        reading: &Reading,
        zero_user: bool,
    ) -> Result<Mistake, Failure> {
        let mistake = Mistake::default();
        for library in &self.libraries {
            sweep.depends_on(&disk::read(library).unwrap_or_default());
        }
        let Reading { model, dataset, .. } = reading;
        for Hook { name, inputs, law } in self.hooks(model, dataset, zero_user, &mistake)? {
            let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
            sweep.register(&name, &inputs, move |call, out| law(call, out));
        }
        Ok(mistake)
    }

    /// Loads the libraries; returns closures that call their routines.
    fn hooks(
        &self,
        model: &Model,
        dataset: &Dataset,
        zero_user: bool,
        mistake: &Mistake,
    ) -> Result<Vec<Hook>, Failure> {
        if self.libraries.is_empty() {
            return Ok(Vec::new());
        }
        let libraries = self
            .libraries
            .iter()
            .map(|path| Ok((stem(path), load(path)?)));
        let libraries: Vec<_> = libraries.collect::<Result<_, Failure>>()?;
        let (found, wrong) = found(model, &libraries, zero_user);
        if !wrong.is_empty() {
            return Err(Failure::in_model(dataset, wrong));
        }
        let mut hooks = Vec::with_capacity(found.len());
        let mut wrong = Vec::new();
        for (wanted, routine) in found {
            let asker = asker(model, wanted.element, wanted.form);
            let hook = hook(&wanted, asker, routine, mistake);
            if model.is_active(wanted.element) {
                wrong.extend(wrong_questions(model, wanted.element, &hook));
            }
            hooks.push(hook);
        }
        if !wrong.is_empty() {
            return Err(Failure::in_model(dataset, wrong));
        }
        Ok(hooks)
    }
}

/// Returns the name by which ROUTINE knows a library: that of its file without ending, in small
/// letters, without `lib` before it.
fn stem(path: &Path) -> String {
    let stem = path.file_stem().map(disk::text).unwrap_or_default();
    let stem = stem.to_lowercase();
    stem.strip_prefix("lib").unwrap_or(&stem).to_owned()
}

/// Loads a library.
fn load(path: &Path) -> Result<Library, Failure> {
    let name = disk::text(path);
    let refused = |what: String| Diagnostic::error("cannot_open", format!("{name}: {what}"));
    // a name without a folder would be looked for where the system keeps its libraries
    let file = path.canonicalize();
    let file = file.map_err(|e| refused(format!("cannot be opened: {e}")))?;
    disk::note_input(&file);
    if path.extension().is_some_and(|e| e == "py") {
        let loaded = python::Loaded::open(&file);
        return match loaded {
            Ok(loaded) => Ok(Library::Python(Arc::new(loaded))),
            Err((what, Some(advice))) => Err(refused(what).help(advice).into()),
            Err((what, None)) => Err(refused(what).into()),
        };
    }
    let loaded = library::Loaded::open(&file).map_err(|said| {
        let Some((_, symbol)) = said.split_once("undefined symbol: ") else {
            return refused(format!("cannot be loaded: {said}"));
        };
        let symbol = symbol.split(&[' ', ','][..]).next().unwrap_or(symbol);
        refused(format!("calls {symbol}, which nobody has here")).help(
            "SYSFNC, SYSARY, SYSPAR, ERRMES, USRMES and TIMGET are here, by the names of Fortran (sysfnc_) and of C (c_sysfnc)",
        )
    })?;
    Ok(Library::Compiled(Arc::new(loaded)))
}

/// Returns the routines that compute the USERs of a model, and what is wrong with the others.
fn found<'m>(
    model: &'m Model,
    libraries: &[(String, Library)],
    zero_user: bool,
) -> (Vec<(Wanted<'m>, Found)>, Vec<Diagnostic>) {
    let (mut found, mut wrong) = (Vec::new(), Vec::new());
    let mut missing: BTreeMap<String, Vec<ElementId>> = BTreeMap::new();
    let mut fields = Vec::new();
    for owned in model.formulas() {
        let Formula::User { constants, routine } = owned.formula else {
            continue;
        };
        let element = owned.element;
        let is_active = model.is_active(element);
        if is_active && owned.argument == "EVALUATE" && !zero_user {
            let what = "EVALUATE=USER: SEVSUB is not called";
            let d = Diagnostic::error(Cause::UserRoutine, what).element(element);
            wrong.push(d.help("write what it computes as an expression"));
        }
        let mut rows = KINDS.iter();
        let row = rows.find(|row| (row.0, row.1) == (element.kind, owned.argument));
        let Some(&(_, argument, default, form)) = row else {
            if is_active && !zero_user && element.kind == K::Field {
                fields.push(element);
            }
            continue;
        };
        let named = routine.as_deref().map(str::trim).filter(|r| !r.is_empty());
        let (library, entry) = match named.map(|r| r.rsplit_once("::").unwrap_or(("", r))) {
            Some((library, entry)) => (Some(library).filter(|l| !l.is_empty()), entry),
            None => (None, default),
        };
        let wanted = Wanted {
            element,
            argument,
            constants,
            library,
            entry,
            form,
        };
        let samples = model.general_systems.get(&element.number);
        if element.kind == K::Gse && samples.is_some_and(|g| g.nd > 0) {
            if is_active && !zero_user {
                let what = "GSE with discrete states: GSESUB has no place for them";
                let d = Diagnostic::error(Cause::UserRoutine, what).element(element);
                wrong.push(d.help("register a closure for it in a program"));
            }
        } else if let Some(routine) = wanted.find(libraries) {
            found.push((wanted, routine));
        } else if is_active && !zero_user {
            let all = missing.entry(wanted.to_string()).or_default();
            all.push(element);
        }
    }
    wrong.extend(missing.iter().filter_map(|(entry, all)| absent(entry, all)));
    wrong.extend(fields.first().map(|first| {
        let what = format!(
            "routines of a FIELD (FIESUB) are not called{}",
            listed(&fields)
        );
        let d = Diagnostic::error(Cause::UserRoutine, what).element(*first);
        d.help("a GFORCE by expressions or by GFOSUB exerts the same")
    }));
    (found, wrong)
}

impl Wanted<'_> {
    /// Finds its routine: in the libraries of the name that the dataset gives, else in any.
    fn find(&self, libraries: &[(String, Library)]) -> Option<Found> {
        let named = self.library.map(|name| stem(Path::new(name)));
        let is_meant = |stem: &str| named.as_deref() == Some(stem);
        let (meant, others): (Vec<_>, Vec<_>) = libraries.iter().partition(|l| is_meant(&l.0));
        let mut all = meant.into_iter().chain(others);
        let (name, form) = (self.entry.trim(), self.form);
        let found = |library: &Library| Some((library.find(name, form)?, library.clone()));
        let (routine, library) = all.find_map(|(_, library)| found(library))?;
        let has_partials = form == Form::Coupler && name.eq_ignore_ascii_case(COUSUB);
        let partial = |name: &str| has_partials.then(|| library.find(name, form)).flatten();
        Some(Found {
            form,
            routine,
            partials: PARTIALS.map(partial),
        })
    }
}

impl std::fmt::Display for Wanted<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.library {
            Some(library) => write!(f, "{library}::{}", self.entry),
            None => f.write_str(self.entry),
        }
    }
}

/// Says who wants a routine that no library has; nobody is told of requests alone, which the run
/// tells.
fn absent(entry: &str, all: &[ElementId]) -> Option<Diagnostic> {
    let first = all.iter().find(|id| id.kind != K::Request)?;
    let name = entry.rsplit("::").next().unwrap_or(entry);
    let (small, large) = (name.to_lowercase(), name.to_uppercase());
    let what = format!("no library has the routine {entry}{}", listed(all));
    let d = Diagnostic::error(Cause::UserRoutine, what).element(*first);
    let in_c = match is_mixed(name) {
        true => format!("as {name} in C and "),
        false => String::new(),
    };
    Some(d.help(format!(
        "it is looked for {in_c}as {small}_, {small} or {large} in Fortran; give the library that has it (--routines), or take what it would compute as zero (--zero-user)"
    )))
}

/// Lists elements that ask for one thing; nothing where one asks, whose name stands before.
fn listed(all: &[ElementId]) -> String {
    if all.len() == 1 {
        return String::new();
    }
    let names: Vec<String> = all.iter().map(ToString::to_string).collect();
    let many = counted(names.len(), "element");
    format!(": {many} ask for it, {}", names.join(", "))
}

/// Returns what is wrong with the questions of a routine: they name what the model does not have.
fn wrong_questions(model: &Model, element: ElementId, hook: &Hook) -> Vec<Diagnostic> {
    let wrong = |input: &String| {
        let what = |d: Diagnostic| format!("its routine asks for {input}: {}", d.message);
        let all = model.check_expression(input).into_iter();
        let all = all.filter(|d| d.severity == Severity::Error);
        all.map(|d| Diagnostic::error(Cause::UserRoutine, what(d)).element(element))
            .collect::<Vec<_>>()
    };
    hook.inputs.iter().flat_map(wrong).collect()
}

/// Returns the closure that calls a routine, after the first call that finds out what it reads.
fn hook(wanted: &Wanted<'_>, asker: Asker, found: Found, mistake: &Mistake) -> Hook {
    let element = wanted.element;
    let told = Told {
        element,
        mistake: mistake.clone(),
        said: Arc::default(),
    };
    let mut nothing = vec![0.0; asker.results];
    let given = vec![0.0; asker.given.iter().sum()];
    let asked = Asked::first();
    let first = found.compute(&asker, wanted.constants, &given, asked, &mut nothing);
    told.hear(&first.asked);
    let questions = Arc::new(first.asked.found);
    let n = questions.inputs.len();
    let name = match wanted.argument {
        FUNCTION => element.to_string(),
        argument => format!("{element} {argument}"),
    };
    Hook {
        name,
        inputs: questions.inputs.clone(),
        law: Arc::new(move |call: &Call<'_>, results: &mut [f64]| {
            if told.mistake.is_there() {
                results.fill(0.0);
                return;
            }
            let (values, given) = call.values.split_at(n.min(call.values.len()));
            let asked = Asked {
                questions: Arc::clone(&questions),
                values: values.to_vec(),
                time: call.time,
                ..Asked::default()
            };
            let done = found.compute(&asker, call.constants, given, asked, results);
            told.hear(&done.asked);
            // a step that has gone astray is not the routine's mistake, and is not kept
            if done.odd.is_some() && call.values.iter().any(|x| x.is_nan() || x.abs() > FARTHEST) {
                results.fill(f64::NAN);
                return;
            }
            told.check(call.time, done.odd);
        }),
    }
}

/// Messages and mistakes of a routine.
struct Told {
    element: ElementId,
    mistake: Mistake,
    /// what was said already
    said: Arc<Mutex<Vec<String>>>,
}

impl Told {
    /// Prints what the routine has said, once; keeps why it wants the run to end.
    fn hear(&self, asked: &Asked) {
        let error =
            |what: String| Diagnostic::error(Cause::UserRoutine, what).element(self.element);
        if let Some(input) = &asked.lacking {
            let what = format!("its routine has asked for {input}, but not in its first call");
            let help = "where IFLAG is true it must ask for everything that it reads later";
            self.mistake.keep(error(what).help(help));
        }
        if let Some(message) = &asked.stop {
            self.mistake
                .keep(error(format!("its routine says: {message}")));
        }
        if asked.said.is_empty() {
            return;
        }
        let mut said = self.said.lock().unwrap_or_else(PoisonError::into_inner);
        for message in &asked.said {
            if !said.contains(message) {
                remark(format!("{}: {message}", self.element));
                said.push(message.clone());
            }
        }
    }

    /// Keeps the complaint about a result that is no finite number.
    fn check(&self, time: f64, odd: Option<f64>) {
        if let Some(x) = odd {
            let what = format!("its routine has computed {x} at time {time}");
            let d = Diagnostic::error(Cause::UserRoutine, what).element(self.element);
            self.mistake.keep(d);
        }
    }
}
