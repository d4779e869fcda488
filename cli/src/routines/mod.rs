//! `--routines`: shared libraries whose routines compute what `USER(…)` stands for.
//!
//! They are loaded because the option says so, and never because a file does: opening somebody
//! else's dataset runs no code. ROUTINE=library::entry chooses among the libraries that were given.
//!
//! Each routine is called once with IFLAG true, before anything is computed: what it asks for then
//! becomes the inputs of the closure that calls it from then on.

mod library;
mod services;

use super::mistake::Mistake;
use super::{Failure, remark};
use cognate::analysis::session::Session;
use cognate::dataset::Dataset;
use cognate::diagnostic::{Cause, Diagnostic, Severity, counted};
use cognate::disk;
use cognate::internals::system::asked::Asked;
use cognate::internals::system::closures::{Call, Hook};
use cognate::model::{
    ArrayKind, Comparison, Driven, ElementId, ElementKind as K, Formula, Level, Model,
};
use cognate::results::Event;
use library::{Asker, Form, Loaded, Routine, Structure, is_mixed};
use std::collections::BTreeMap;
use std::ffi::{CString, c_int};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The libraries of routines.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct RoutineArgs {
    /// Shared library of routines that compute what USER(…) stands for (repeatable). Its code is
    /// run, with your rights: give libraries that you trust [default: none]
    #[arg(long = "routines", value_name = "LIBRARY")]
    libraries: Vec<PathBuf>,
}

/// Kinds of elements whose USER a library can compute: the routine where the dataset names none,
/// and its arguments.
const KINDS: [(K, &str, Form); 10] = [
    (K::Sforce, "Sfosub", Form::Force),
    (K::Vforce, "Vfosub", Form::Force),
    (K::Vtorque, "Vtosub", Form::Force),
    (K::Gforce, "Gfosub", Form::Force),
    (K::Variable, "Varsub", Form::Force),
    (K::Diff, "Difsub", Form::Force),
    (K::Motion, "Motsub", Form::Motion),
    (K::Request, "Reqsub", Form::Output),
    (K::Sensor, "Sensub", Form::Output),
    (K::Gse, "Gsesub", Form::System),
];

/// Kinds whose routines are not called, what these are called, and the way on.
const NOT_CALLED: [(K, &str, &str); 4] = [
    (
        K::Field,
        "FIESUB",
        "a GFORCE by expressions or by GFOSUB exerts the same",
    ),
    (
        K::Coupler,
        "COUSUB",
        "give SCALES, or write the relation as a GCON",
    ),
    (
        K::Curve,
        "CURSUB",
        "give a MATRIX with a row x, y, z for each point",
    ),
    (
        K::Contact,
        "CNFSUB and CFFSUB",
        "give the contact an IMPACT or POISSON law",
    ),
];

/// A `USER(…)` that a routine is to compute.
struct Wanted<'m> {
    element: ElementId,
    constants: &'m [f64],
    /// library and entry that the dataset names
    library: Option<&'m str>,
    entry: &'m str,
    form: Form,
}

impl RoutineArgs {
    /// Loads the libraries and has their routines compute the USERs of a model; `zero_user`: what
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
        if self.libraries.is_empty() {
            return Ok(mistake);
        }
        let libraries = self
            .libraries
            .iter()
            .map(|path| Ok((stem(path), load(path)?)));
        let libraries: Vec<_> = libraries.collect::<Result<_, Failure>>()?;
        let (found, wrong) = found(&session.model, &libraries, zero_user);
        if !wrong.is_empty() {
            return Err(Failure::in_model(dataset, wrong));
        }
        let mut hooks = Vec::with_capacity(found.len());
        let mut wrong = Vec::new();
        for (wanted, routine) in found {
            let asker = asker(&session.model, wanted.element);
            let hook = hook(&wanted, asker, routine, &mistake);
            if session.model.is_active(wanted.element) {
                wrong.extend(wrong_questions(&session.model, wanted.element, &hook));
            }
            hooks.push(hook);
        }
        if !wrong.is_empty() {
            return Err(Failure::in_model(dataset, wrong));
        }
        hooks
            .into_iter()
            .for_each(|hook| session.register_hook(hook));
        let names = self.libraries.iter().map(disk::text);
        let event = |name| Event::Info(format!("routines: {name}"));
        session.run.log.extend(names.map(event));
        Ok(mistake)
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
fn load(path: &Path) -> Result<Arc<Loaded>, Failure> {
    let name = disk::text(path);
    let refused = |what: String| Diagnostic::error("cannot_open", format!("{name}: {what}"));
    if path.extension().is_some_and(|e| e == "py") {
        let what = "routines in Python are given to a session from Python, not to this command";
        let help = "with pycognate: @model.user(\"SFORCE/3\", inputs=[\"DX(1,2)\"]) before a function (docs/python.md)";
        return Err(refused(what.into()).help(help).into());
    }
    // a name without a folder would be looked for where the system keeps its libraries
    let file = path.canonicalize();
    let file = file.map_err(|e| refused(format!("cannot be opened: {e}")))?;
    disk::note_input(&file);
    let loaded = Loaded::open(&file).map_err(|said| {
        let Some((_, symbol)) = said.split_once("undefined symbol: ") else {
            return refused(format!("cannot be loaded: {said}"));
        };
        let symbol = symbol.split(&[' ', ','][..]).next().unwrap_or(symbol);
        refused(format!("calls {symbol}, which nobody has here")).help(
            "SYSFNC, SYSARY, SYSPAR, ERRMES, USRMES and TIMGET are here, by the names of Fortran (sysfnc_) and of C (c_sysfnc)",
        )
    })?;
    Ok(Arc::new(loaded))
}

/// Returns the routines that compute the USERs of a model, and what is wrong with the others.
fn found<'m>(
    model: &'m Model,
    libraries: &[(String, Arc<Loaded>)],
    zero_user: bool,
) -> (Vec<(Wanted<'m>, Routine)>, Vec<Diagnostic>) {
    let (mut found, mut wrong) = (Vec::new(), Vec::new());
    let mut missing: BTreeMap<String, Vec<ElementId>> = BTreeMap::new();
    let mut not_called: BTreeMap<K, Vec<ElementId>> = BTreeMap::new();
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
        if owned.argument != "FUNCTION" {
            continue;
        }
        let Some(&(_, default, form)) = KINDS.iter().find(|row| row.0 == element.kind) else {
            if is_active && !zero_user {
                not_called.entry(element.kind).or_default().push(element);
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
    wrong.extend(
        not_called
            .iter()
            .filter_map(|(kind, all)| refused(*kind, all)),
    );
    (found, wrong)
}

impl Wanted<'_> {
    /// Finds its routine: in the libraries of the name that the dataset gives, else in any.
    fn find(&self, libraries: &[(String, Arc<Loaded>)]) -> Option<Routine> {
        let named = self.library.map(|name| stem(Path::new(name)));
        let is_meant = |stem: &str| named.as_deref() == Some(stem);
        let (meant, others): (Vec<_>, Vec<_>) = libraries.iter().partition(|l| is_meant(&l.0));
        let mut all = meant.into_iter().chain(others);
        all.find_map(|(_, library)| library.find(self.entry.trim(), self.form))
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

/// Says which elements want routines that are not called.
fn refused(kind: K, all: &[ElementId]) -> Option<Diagnostic> {
    let (_, routine, advice) = NOT_CALLED.iter().find(|row| row.0 == kind)?;
    let what = format!(
        "routines of a {kind} ({routine}) are not called{}",
        listed(all)
    );
    let d = Diagnostic::error(Cause::UserRoutine, what).element(*all.first()?);
    Some(d.help(*advice))
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
fn hook(wanted: &Wanted<'_>, asker: Asker, routine: Routine, mistake: &Mistake) -> Hook {
    let element = wanted.element;
    let told = Told {
        element,
        mistake: mistake.clone(),
        said: Arc::default(),
    };
    let mut nothing = vec![0.0; asker.results];
    let states = vec![0.0; asker.sizes.iter().sum()];
    let first = routine.call(
        &asker,
        wanted.constants,
        &states,
        Asked::first(),
        &mut nothing,
    );
    told.hear(&first);
    let questions = Arc::new(first.found);
    let n = questions.inputs.len();
    Hook {
        name: element.to_string(),
        inputs: questions.inputs.clone(),
        law: Arc::new(move |call: &Call<'_>, results: &mut [f64]| {
            if told.mistake.is_there() {
                return;
            }
            let (values, states) = call.values.split_at(n.min(call.values.len()));
            let asked = Asked {
                questions: Arc::clone(&questions),
                values: values.to_vec(),
                time: call.time,
                ..Asked::default()
            };
            let asked = routine.call(&asker, call.constants, states, asked, results);
            told.hear(&asked);
            told.check(call.time, results);
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
    fn check(&self, time: f64, results: &mut [f64]) {
        if let Some(x) = results.iter_mut().find(|x| !x.is_finite()) {
            let what = format!("its routine has computed {x} at time {time}");
            let d = Diagnostic::error(Cause::UserRoutine, what).element(self.element);
            self.mistake.keep(d);
            *x = 0.0;
        }
    }
}

/// Returns a number of an element as C has it.
fn number(id: Option<u32>) -> c_int {
    id.and_then(|id| c_int::try_from(id).ok()).unwrap_or(0)
}

/// Returns what a routine is told of its element.
fn asker(model: &Model, element: ElementId) -> Asker {
    let n = element.number;
    let vector = |f: &cognate::model::VectorForce, order: [usize; 3]| {
        let all = [Some(f.i), f.jfloat, f.rm].map(number);
        Structure::Vector(order.map(|k| all[k]))
    };
    let mut sizes = [0, 0];
    let mut results = 1;
    let found = match element.kind {
        K::Vforce => model.vforces.get(&n).map(|f| vector(f, [0, 1, 2])),
        K::Vtorque => model.vtorques.get(&n).map(|f| vector(f, [0, 1, 2])),
        K::Gforce => model.gforces.get(&n).map(|f| vector(f, [0, 2, 1])),
        K::Sforce => model.sforces.get(&n).map(|f| {
            let numbers = [number(Some(f.i)), number(Some(f.j)), f.action_only.into()];
            let kind = if f.rotational {
                c"ROTATION"
            } else {
                c"TRANSLATION"
            };
            Structure::Single(numbers, kind)
        }),
        K::Diff => model.differentials.get(&n).map(|d| {
            let ic = d.ic.map(Option::unwrap_or_default);
            Structure::Differential([d.static_hold.into(), d.implicit.into()], ic)
        }),
        K::Motion => model.motions.get(&n).map(motion),
        K::Request => model.requests.get(&n).map(request),
        K::Sensor => model.sensors.get(&n).map(|s| {
            let logic = match s.comparison {
                Comparison::Equal => *b"EQ",
                Comparison::GreaterOrEqual => *b"GE",
                Comparison::LessOrEqual => *b"LE",
            };
            Structure::Sensor([s.value, s.error.unwrap_or(1e-3)], logic)
        }),
        K::Gse => model.general_systems.get(&n).map(|g| {
            let inputs = g.u.and_then(|u| model.arrays.get(&u)).map(|a| &a.kind);
            let n_inputs = match inputs {
                Some(ArrayKind::Inputs(variables)) => variables.len(),
                _ => 0,
            };
            sizes = [g.ns, n_inputs];
            results = g.ns + g.no;
            let count = |n: usize| c_int::try_from(n).unwrap_or(c_int::MAX);
            let [u, y, x, ic, xd, icd] = [g.u, g.y, g.x, g.ic, g.xd, g.icd].map(number);
            let (ni, no, ns, nd) = (count(n_inputs), count(g.no), count(g.ns), count(g.nd));
            let hold = g.static_hold.into();
            Structure::System([ni, no, u, y, ns, x, ic, hold, 0, 0, nd, xd, icd])
        }),
        _ => model
            .variables
            .get(&n)
            .map(|v| Structure::Variable(v.ic.unwrap_or(0.0))),
    };
    Asker {
        id: number(Some(n)),
        structure: found.unwrap_or(Structure::Variable(0.0)),
        sizes,
        results,
    }
}

/// Describes a MOTION.
fn motion(m: &cognate::model::Motion) -> Structure {
    let (joint, markers, which) = match m.driven {
        Driven::Joint(joint) => (Some(joint), [0, 0], [0, 0]),
        Driven::JointTranslation(joint) => (Some(joint), [0, 0], *b"T\0"),
        Driven::JointRotation(joint) => (Some(joint), [0, 0], *b"R\0"),
        Driven::Markers { i, j, component } => {
            let names = [*b"X\0", *b"Y\0", *b"Z\0", *b"B1", *b"B2", *b"B3"];
            let which = names.get(component).copied().unwrap_or_default();
            (None, [i, j].map(|id| number(Some(id))), which)
        }
    };
    let is_turn = matches!(m.driven, Driven::JointRotation(_)) || which[0] == b'B';
    Structure::Motion {
        joint: number(joint),
        kind: if is_turn { c"ROTATION" } else { c"TRANSLATION" },
        markers,
        which,
        level: match m.level {
            Level::Displacement => c"DISPLACEMENT",
            Level::Velocity => c"VELOCITY",
            Level::Acceleration => c"ACCELERATION",
        },
    }
}

/// Describes a REQUEST.
fn request(r: &cognate::model::Request) -> Structure {
    let text = |s: &str| CString::new(s.replace('\0', " ")).unwrap_or_default();
    let title = std::array::from_fn(|k| text(r.title.get(k).map_or("", String::as_str)));
    Structure::Request(text(r.comment.as_deref().unwrap_or_default()), title)
}
