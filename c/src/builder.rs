//! Models that a program makes: the builder of the library, its statements as handles.

use crate::door::{door, given, quiet, row, seen, text, usage};
use crate::error::CognateError;
use crate::model::CognateModel;
use engine::Error;
use engine::ModelBuilder;
use engine::build::{End, Key, Setting, Word};
use engine::dataset;
use engine::dataset::Source;
use engine::diagnostic::Diagnostic;
use engine::setup::Setup;
use std::cell::RefCell;
use std::ffi::c_char;

/// A model that a program makes, a statement after the other in any order.
pub struct CognateBuilder {
    model: ModelBuilder,
    /// handles that were given out; each has a place of its own
    #[allow(clippy::vec_box, reason = "callers hold their places")]
    elements: RefCell<Vec<Box<CognateElement>>>,
    /// mistakes in calls, told with those of the model
    wrong: RefCell<Vec<Diagnostic>>,
}

/// A statement of a model that is being built. It belongs to its builder, and goes with it.
pub struct CognateElement {
    /// the builder, which outlives its handles
    builder: *const CognateBuilder,
    /// `None`: it was not understood, which is told when the model is built
    key: Option<Key>,
}

impl CognateBuilder {
    fn refuse(&self, wrong: impl Into<Error>) {
        let wrong: Error = wrong.into();
        self.wrong.borrow_mut().extend(wrong);
    }

    /// Returns the handle of a statement; `None`: of one that was not understood.
    fn handle(&self, key: Option<Key>) -> *mut CognateElement {
        let element = Box::new(CognateElement { builder: self, key });
        let mut elements = self.elements.borrow_mut();
        elements.push(element);
        let last = elements.last_mut();
        last.map_or(std::ptr::null_mut(), |element| &raw mut **element)
    }

    /// Returns an end of a joint or force; `Ok(None)`: it was not understood, which has been told.
    unsafe fn end(&self, element: *const CognateElement, name: &str) -> Result<Option<End>, Error> {
        // SAFETY: NULL or a handle of the caller
        let Some(element) = (unsafe { element.as_ref() }) else {
            let what = format!("an end of `{name}` is NULL");
            return Err(usage(what, "give a marker or a body"));
        };
        let Some(key) = element.key else {
            return Ok(None);
        };
        let found = self.model.end(key).ok_or_else(|| {
            let what = format!("an end of `{name}` is neither a marker nor a body of this builder");
            usage(what, "cognate_element_marker makes a marker on a body")
        });
        found.map(Some)
    }
}

/// Makes a statement of a builder; `Ok(None)`: it was not understood, which has been told. NULL for
/// NULL.
unsafe fn made(
    builder: *const CognateBuilder,
    make: impl FnOnce(&CognateBuilder) -> Result<Option<Key>, Error>,
) -> *mut CognateElement {
    // SAFETY: NULL or a handle
    let Some(builder) = (unsafe { builder.as_ref() }) else {
        return std::ptr::null_mut();
    };
    quiet(std::ptr::null_mut(), || {
        let key = make(builder).unwrap_or_else(|wrong| {
            builder.refuse(wrong);
            None
        });
        builder.handle(key)
    })
}

/// Gives an argument of an element a value; what is wrong is told when the model is built.
unsafe fn give(
    element: *mut CognateElement,
    keyword: *const c_char,
    value: impl FnOnce(&CognateBuilder) -> Result<Option<Setting>, Error>,
) {
    // SAFETY: NULL or a handle
    let Some(element) = (unsafe { element.as_ref() }) else {
        return;
    };
    quiet((), || {
        // SAFETY: a builder outlives its handles (header)
        let builder = unsafe { &*element.builder };
        let Some(statement) = element.key.and_then(|key| builder.model.statement(key)) else {
            return;
        };
        // SAFETY: a text of the caller
        let keyword = unsafe { text(keyword, "keyword") };
        match keyword.and_then(|keyword| Ok((keyword, value(builder)?))) {
            Ok((keyword, Some(value))) => {
                statement.set(keyword, value);
            }
            Ok((_, None)) => {}
            Err(wrong) => builder.refuse(wrong.map(|d| match statement.kind() {
                Some(kind) => d.element(kind.id(statement.number())),
                None => d,
            })),
        }
    });
}

/// Returns the value that stands for an element.
unsafe fn setting(value: *const CognateElement) -> Result<Option<(Key, u32)>, Error> {
    // SAFETY: NULL or a handle
    let value = unsafe { seen(value, "value") }?;
    // SAFETY: a builder outlives its handles (header)
    let builder = unsafe { &*value.builder };
    let found = value.key.and_then(|key| builder.model.statement(key));
    Ok(found.map(|element| (element.key(), element.number())))
}

/// Begins a model of ground alone. `title`: the first line of its dataset.
///
/// Elements get numbers as they are made and keep their names in written datasets. Lengths, masses,
/// forces and times are in one system of units, which cognate_builder_settings "UNITS" tells; angles
/// are radians. Places are in ground coordinates, in the position in which the model is drawn.
/// Mistakes are collected, and told all at once by cognate_builder_build.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_builder_new(
    title: *const c_char,
    error: *mut *mut CognateError,
) -> *mut CognateBuilder {
    let work = || {
        // SAFETY: a text of the caller
        let title = unsafe { text(title, "title") }?;
        Ok(Box::into_raw(Box::new(CognateBuilder {
            model: ModelBuilder::new(title),
            elements: RefCell::default(),
            wrong: RefCell::default(),
        })))
    };
    // SAFETY: a place of the caller
    unsafe { door(error, std::ptr::null_mut(), work) }
}

/// Returns the part that does not move, PART/1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_builder_ground(
    builder: *mut CognateBuilder,
) -> *mut CognateElement {
    // SAFETY: NULL or a handle
    unsafe { made(builder, |builder| Ok(Some(builder.model.ground().key()))) }
}

/// Adds an element by a word: a statement ("PART", "BUSHING"), or a type of JOINT, JPRIM or GRAPHICS
/// ("REVOLUTE", "INLINE", "BOX"; "GRAPHICS_CURVE", as CURVE is a statement). It gets the next number
/// of its kind. `name` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_builder_element(
    builder: *mut CognateBuilder,
    word: *const c_char,
    name: *const c_char,
) -> *mut CognateElement {
    let add = |builder: &CognateBuilder| {
        // SAFETY: texts of the caller
        let (word, name) = unsafe { (text(word, "word")?, name_of(name)?) };
        Ok(Some(builder.model.add(&Word::find(word)?, name).key()))
    };
    // SAFETY: NULL or a handle
    unsafe { made(builder, add) }
}

/// Adds an element between two ends, I and J, by a word as for cognate_builder_element. Each end is a
/// marker or a body; a body gets a marker where the other end is. The axis of a joint is z of its
/// markers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_builder_between(
    builder: *mut CognateBuilder,
    word: *const c_char,
    name: *const c_char,
    i: *const CognateElement,
    j: *const CognateElement,
) -> *mut CognateElement {
    let add = |builder: &CognateBuilder| {
        // SAFETY: texts of the caller
        let (word, name) = unsafe { (text(word, "word")?, name_of(name)?) };
        let word = Word::find(word)?;
        // SAFETY: NULL or handles of the caller
        let ends = unsafe { (builder.end(i, name)?, builder.end(j, name)?) };
        let (Some(i), Some(j)) = ends else {
            return Ok(None);
        };
        Ok(Some(builder.model.add_between(&word, name, i, j).key()))
    };
    // SAFETY: NULL or a handle
    unsafe { made(builder, add) }
}

/// Returns the statement without a number that has this keyword: "UNITS", "ACCGRAV", "INTEGRATOR".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_builder_settings(
    builder: *mut CognateBuilder,
    keyword: *const c_char,
) -> *mut CognateElement {
    let find = |builder: &CognateBuilder| {
        // SAFETY: a text of the caller
        let keyword = unsafe { text(keyword, "keyword") }?;
        Ok(Some(builder.model.settings(keyword).key()))
    };
    // SAFETY: NULL or a handle
    unsafe { made(builder, find) }
}

/// Makes a marker fixed in a body, at a place in ground, with the axes of ground. `name` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_element_marker(
    body: *mut CognateElement,
    name: *const c_char,
    x: f64,
    y: f64,
    z: f64,
) -> *mut CognateElement {
    // SAFETY: NULL or a handle
    let Some(body) = (unsafe { body.as_ref() }) else {
        return std::ptr::null_mut();
    };
    let at = |builder: &CognateBuilder| {
        // SAFETY: a text of the caller
        let name = unsafe { name_of(name) }?;
        let found = body.key.and_then(|key| builder.model.body(key));
        let found = found.ok_or_else(|| {
            let what = format!("`{name}` is to be a marker on something that is no body");
            usage(what, "markers are fixed in PART and POINT_MASS")
        });
        let marker = found?.at([x, y, z]);
        let marker = if name.is_empty() {
            marker
        } else {
            marker.named(name)
        };
        Ok(Some(marker.key()))
    };
    // SAFETY: a builder outlives its handles (header)
    unsafe { made(body.builder, at) }
}

/// Turns a marker that cognate_element_marker made: the direction of its z axis in ground (the axis of
/// a joint), and one in the half plane of its positive x axis. Both have three numbers; `x` may be
/// NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_element_axes(
    marker: *mut CognateElement,
    z: *const f64,
    x: *const f64,
) {
    // SAFETY: NULL or a handle
    let Some(marker) = (unsafe { marker.as_ref() }) else {
        return;
    };
    quiet((), || {
        // SAFETY: a builder outlives its handles (header)
        let builder = unsafe { &*marker.builder };
        let Some(key) = marker.key else {
            return;
        };
        let turn = || {
            let what = "axes are given to something that is no marker";
            let none = || usage(what, "cognate_element_marker makes markers");
            let frame = builder.model.frame(key).ok_or_else(none)?;
            // SAFETY: the caller gives three numbers, and three or none
            let z = unsafe { three(z, "z") }?;
            match x.is_null() {
                true => frame.z(z),
                // SAFETY: as before
                false => frame.axes(z, unsafe { three(x, "x") }?),
            };
            Ok::<(), Error>(())
        };
        turn().unwrap_or_else(|wrong| builder.refuse(wrong));
    });
}

/// Returns the number that stands for an element in expressions: DX(number). 0: it is a statement of
/// settings, or none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_element_number(element: *const CognateElement) -> u32 {
    // SAFETY: NULL or a handle
    quiet(0, || match unsafe { setting(element) } {
        Ok(Some((_, number))) => number,
        Ok(None) | Err(_) => 0,
    })
}

/// Gives an argument a number, by its keyword: "MASS". Whole numbers are taken as such where a count
/// or the number of an element is wanted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_element_set_number(
    element: *mut CognateElement,
    keyword: *const c_char,
    value: f64,
) {
    // SAFETY: NULL or a handle, a text of the caller
    unsafe { give(element, keyword, |_| Ok(Some(number(value)))) }
}

/// Gives an argument `n` numbers: "IP".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_element_set_numbers(
    element: *mut CognateElement,
    keyword: *const c_char,
    values: *const f64,
    n: usize,
) {
    // SAFETY: NULL or a handle, a text and numbers of the caller
    unsafe {
        give(element, keyword, |_| {
            Ok(Some(numbers(row(values, n, "values")?)))
        })
    }
}

/// Gives an argument a text: a word, a name of a file, or an expression ("FUNCTION"; numbers of
/// elements in it are those of cognate_element_number).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_element_set_text(
    element: *mut CognateElement,
    keyword: *const c_char,
    value: *const c_char,
) {
    // SAFETY: NULL or a handle, texts of the caller
    unsafe {
        give(element, keyword, |_| {
            Ok(Some(Setting::from(text(value, "value")?)))
        })
    }
}

/// Gives an argument an element of the same builder: "CM" a marker, "JOINT" a joint.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_element_set_element(
    element: *mut CognateElement,
    keyword: *const c_char,
    value: *const CognateElement,
) {
    // SAFETY: NULL or handles, a text of the caller
    unsafe {
        give(element, keyword, |_| {
            let found = setting(value)?;
            Ok(found.map(|(key, number)| Setting::Handle(key, number)))
        })
    }
}

/// Gives an argument `n` elements of the same builder: "JOINTS" of a COUPLER.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_element_set_elements(
    element: *mut CognateElement,
    keyword: *const c_char,
    values: *const *const CognateElement,
    n: usize,
) {
    // SAFETY: NULL or handles, a text of the caller
    unsafe {
        give(element, keyword, |_| {
            let values = row(values, n, "values")?.iter();
            let found: Vec<_> = values.map(|v| setting(*v)).collect::<Result<_, _>>()?;
            let all: Option<Vec<_>> = found.into_iter().collect();
            Ok(all.map(Setting::Handles))
        })
    }
}

/// Gives an argument that stands alone: "ROTATIONAL".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_element_set_flag(
    element: *mut CognateElement,
    keyword: *const c_char,
) {
    // SAFETY: NULL or a handle, a text of the caller
    unsafe { give(element, keyword, |_| Ok(Some(Setting::Flag))) }
}

/// Makes the model. NULL: there are mistakes, in calls or in the model, by the names of elements. The
/// builder stays, and may go on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_builder_build(
    builder: *const CognateBuilder,
    error: *mut *mut CognateError,
) -> *mut CognateModel {
    let work = || {
        // SAFETY: a handle of the caller
        let builder = unsafe { seen(builder, "builder") }?;
        let mut wrong = builder.wrong.borrow().clone();
        let text = match builder.model.build() {
            Ok(model) => model.to_text(),
            Err(more) => {
                wrong.extend(more);
                String::new()
            }
        };
        if !wrong.is_empty() {
            return Err(wrong.into());
        }
        let reading = dataset::read_source(Source::from_text(None, &text));
        CognateModel::of(reading, Setup::default())
    };
    // SAFETY: a place of the caller
    unsafe { door(error, std::ptr::null_mut(), work) }
}

/// Returns the words that cognate_builder_element takes, one a line, to be given back by
/// cognate_string_free: the word, and a sentence about it behind a tabulator.
#[unsafe(no_mangle)]
pub extern "C" fn cognate_builder_words() -> *mut c_char {
    quiet(std::ptr::null_mut(), || {
        let all = Word::all();
        let lines = all.iter().map(|w| format!("{}\t{}\n", w.word, w.summary()));
        given(lines.collect::<String>())
    })
}

/// Gives a builder back, and its elements with it; models that it made go on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_builder_free(builder: *mut CognateBuilder) {
    if !builder.is_null() {
        // SAFETY: made by `cognate_builder_new`, given back once
        quiet((), || drop(unsafe { Box::from_raw(builder) }));
    }
}

/// Returns a name; NULL: none.
unsafe fn name_of<'a>(name: *const c_char) -> Result<&'a str, Error> {
    match name.is_null() {
        true => Ok(""),
        // SAFETY: a text of the caller
        false => unsafe { text(name, "name") },
    }
}

/// Returns three numbers.
unsafe fn three(values: *const f64, name: &str) -> Result<[f64; 3], Error> {
    // SAFETY: the caller says that three stand there
    let all = unsafe { row(values, 3, name) }?;
    Ok([all[0], all[1], all[2]])
}

/// Returns a number as the whole number that it is, else as it is.
fn number(x: f64) -> Setting {
    let whole = x as i64;
    match (whole as f64).to_bits() == x.to_bits() {
        true => Setting::Whole(whole),
        false => Setting::Real(x),
    }
}

/// The same for several.
fn numbers(all: &[f64]) -> Setting {
    let whole = all.iter().map(|&x| match number(x) {
        Setting::Whole(n) => Some(n),
        _ => None,
    });
    match whole.collect() {
        Some(whole) => Setting::Wholes(whole),
        None => Setting::Reals(all.to_vec()),
    }
}
