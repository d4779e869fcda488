//! Objects of a command file by their full names, with the arguments that commands gave them.
//!
//! An argument keeps the expression that was given last and the numbers that a command gave. Adams
//! View saves every number twice, by `create` as a number and by `modify` as the expression that it
//! came from: in a saved file the number counts, unless a design variable has been changed.

use super::term::{Shared, Term};
use super::units::Units;
use crate::diagnostic::{Diagnostic, Span};
use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet};

/// A value of an expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Datum {
    /// in units of the file
    Number(f64),
    /// a text, or a word that names nothing
    Text(String),
    List(Vec<Datum>),
    /// an object by its place
    Object(usize),
    /// `(NONE)`
    Nothing,
}

/// Where numbers of a location or an orientation are read.
#[derive(Clone, Debug, PartialEq, Default)]
pub(super) enum Reference {
    /// in that of the part that holds the marker, or of ground
    #[default]
    Own,
    /// in that of an object, by its name
    Of(String),
}

/// A value as it was given.
#[derive(Clone, Debug)]
pub(super) struct Item {
    pub term: Shared,
    pub span: Span,
    /// a bare word, which may be the name of an object
    pub is_bare: bool,
}

/// Values of an argument as numbers, of a saved file or at the time of a command.
#[derive(Clone, Debug)]
pub(super) struct Fixed {
    pub values: Vec<Datum>,
    pub frame: Reference,
    /// they came from one expression
    pub is_whole: bool,
}

/// An argument of an object.
#[derive(Clone, Debug, Default)]
pub(super) struct Attribute {
    pub items: Vec<Item>,
    pub frame: Reference,
    /// values at the time of a command
    pub fixed: Option<Fixed>,
    pub span: Span,
}

impl Attribute {
    /// Returns whether one expression gives all values.
    pub fn is_whole(&self) -> bool {
        matches!(&self.items[..], [only] if !only.is_bare)
    }
}

/// An object that a command made.
#[derive(Clone, Debug)]
pub(super) struct Object {
    /// full name as written, with its dot
    pub name: String,
    /// words of the command that made it, without its verb
    pub kind: &'static str,
    pub attributes: BTreeMap<&'static str, Attribute>,
    /// place of the words of that command
    pub head: Span,
    /// deleted objects, and those that another of the same name replaced
    pub is_gone: bool,
    /// not part of the model, `active = off`
    pub is_idle: bool,
    pub is_ground: bool,
}

/// Position and orientation in ground.
pub(super) type Pose = crate::space::Frame<f64>;

/// The meaning of three numbers of a location.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Coordinates {
    #[default]
    Cartesian,
    /// radius, angle, height
    Cylindrical,
    /// radius, angle about z, angle from z
    Spherical,
}

/// Sequence of angles of an orientation, by axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sequence {
    pub axes: [usize; 3],
    /// about axes that turn with the body
    pub is_body: bool,
}

impl Default for Sequence {
    fn default() -> Self {
        Self {
            axes: [2, 0, 2],
            is_body: true,
        }
    }
}

/// All objects, and what commands set by default.
#[derive(Default)]
pub(super) struct Database {
    pub objects: Vec<Object>,
    places: BTreeMap<String, usize>,
    /// name of the model with its dot
    pub model: Option<String>,
    /// name of the part that was made or taken last
    pub part: Option<String>,
    pub frame: Option<String>,
    pub units: Units,
    pub sequence: Sequence,
    pub coordinates: Coordinates,
    /// from here on a saved file gives expressions of numbers that it has given before
    pub is_saved: bool,
    /// values that a user gives to design variables, by their names in lower case
    pub changed: BTreeMap<String, f64>,
    /// values of variables of loops
    pub loops: BTreeMap<String, Datum>,
    pub said: RefCell<Vec<Diagnostic>>,
    /// places of expressions whose trouble has been told
    pub told: RefCell<BTreeSet<usize>>,
    pub poses: RefCell<BTreeMap<usize, Option<Pose>>>,
    pub depth: Cell<usize>,
    /// file of solids that is imported
    pub solids_file: Option<String>,
    /// shapes that are spoken of and that no command made, in lower case
    pub imported: BTreeSet<String>,
    /// names of elements that are not read, in lower case with a dot: nothing within them is told
    pub unread: Vec<String>,
}

impl Database {
    /// Adds an object, or takes that which has its name already.
    pub fn object(&mut self, name: &str, kind: &'static str, head: Span) -> usize {
        let name = &unmarked(name);
        self.poses.borrow_mut().clear();
        let key = name.to_ascii_lowercase();
        if let Some(&k) = self.places.get(&key)
            && !self.objects[k].is_gone
        {
            return k;
        }
        let k = self.objects.len();
        self.objects.push(Object {
            name: name.to_owned(),
            kind,
            attributes: BTreeMap::new(),
            head,
            is_gone: false,
            is_idle: false,
            is_ground: false,
        });
        self.places.insert(key, k);
        k
    }

    /// Takes an object away.
    pub fn delete(&mut self, k: usize) {
        self.poses.borrow_mut().clear();
        self.objects[k].is_gone = true;
        let key = self.objects[k].name.to_ascii_lowercase();
        self.places.remove(&key);
    }

    /// Returns the full name that a name stands for where a new object is made below a parent.
    pub fn full_name(&self, name: &str, parent: Option<&str>) -> String {
        let name = &unmarked(name);
        if name.starts_with('.') {
            return name.to_owned();
        }
        let model = self.model.as_deref().unwrap_or_default();
        let first = name.split('.').next().unwrap_or_default();
        if !model.is_empty() && first.eq_ignore_ascii_case(&model[1..]) && name.contains('.') {
            return format!(".{name}");
        }
        match parent {
            Some(parent) if !name.contains('.') => format!("{parent}.{name}"),
            _ => format!("{model}.{name}"),
        }
    }

    /// Returns the object that a name stands for: in full, in the model, or in the part that was
    /// taken last.
    pub fn find(&self, name: &str) -> Option<usize> {
        let name = &unmarked(name);
        let model = self.model.as_deref().unwrap_or_default();
        let of_part = self.part.as_ref().map(|part| format!("{part}.{name}"));
        let ways = match name.starts_with('.') {
            true => [Some(name.to_owned()), None, None],
            false => [
                Some(format!("{model}.{name}")),
                of_part,
                Some(format!(".{name}")),
            ],
        };
        let mut ways = ways.into_iter().flatten();
        ways.find_map(|way| self.places.get(&way.to_ascii_lowercase()).copied())
    }

    /// Returns the name of the object that holds another: `.m.P` of `.m.P.M`.
    pub fn parent(name: &str) -> Option<&str> {
        let (parent, _) = name.rsplit_once('.')?;
        (!parent.is_empty()).then_some(parent)
    }

    /// Returns the part that holds a marker or a shape.
    pub fn owner(&self, k: usize) -> Option<usize> {
        self.find(Self::parent(&self.objects.get(k)?.name)?)
    }

    /// Returns the name below the model, as Adams View writes it into datasets.
    pub fn short_name(&self, k: usize) -> String {
        let name = &self.objects[k].name;
        name.rsplit('.').next().unwrap_or(name).to_owned()
    }

    /// Returns the name within the model: `P.M`, `JOINT_1`.
    pub fn inner_name(&self, k: usize) -> String {
        let name = &self.objects[k].name;
        let model = self.model.as_deref().unwrap_or_default();
        let inner = name.get(model.len()..).filter(|_| !model.is_empty());
        inner.unwrap_or(name).trim_start_matches('.').to_owned()
    }

    /// Returns the objects of kinds that begin so and are part of the model.
    pub fn of_kind<'a>(&'a self, kind: &'a str) -> impl Iterator<Item = usize> + 'a {
        let is = move |o: &Object| !o.is_gone && !o.is_idle && o.kind.starts_with(kind);
        (0..self.objects.len()).filter(move |&k| is(&self.objects[k]))
    }

    /// Returns names near one that is not there.
    pub fn near(&self, name: &str) -> Vec<String> {
        let known = self.objects.iter().filter(|o| !o.is_gone);
        let full = self.full_name(name, None);
        crate::diagnostic::near_names(&full, known.map(|o| o.name.as_str()))
            .into_iter()
            .map(str::to_owned)
            .collect()
    }

    /// Returns whether a name is that of something within an element that is not read.
    pub fn is_within_unread(&self, name: &str) -> bool {
        let lower = name.to_ascii_lowercase();
        self.unread.iter().any(|begin| lower.starts_with(begin))
    }

    pub fn say(&self, said: Diagnostic) {
        self.said.borrow_mut().push(said);
    }

    /// Returns whether an expression depends on a design variable that has been changed.
    pub fn is_changed(&self, term: &Term) -> bool {
        !self.changed.is_empty() && self.reads_changed(term, &mut BTreeSet::new())
    }

    fn reads_changed(&self, term: &Term, seen: &mut BTreeSet<usize>) -> bool {
        match term {
            Term::Number(_) => false,
            Term::Text(name) | Term::Name(name) => {
                if self.changed.contains_key(&name.to_ascii_lowercase()) {
                    return true;
                }
                let object = self.find(name).or_else(|| self.find(Self::parent(name)?));
                let Some(k) = object else {
                    return false;
                };
                let key = self.objects[k].name.to_ascii_lowercase();
                if self.changed.contains_key(&key) {
                    return true;
                }
                // a marker moves with its part
                let with_owner = [Some(k), self.owner(k)];
                with_owner.into_iter().flatten().any(|k| {
                    let attributes = self.objects[k].attributes.values();
                    seen.insert(k)
                        && attributes
                            .flat_map(|a| &a.items)
                            .any(|item| self.reads_changed(&item.term, seen))
                })
            }
            Term::Array(all) | Term::Call(_, all) => {
                all.iter().any(|term| self.reads_changed(term, seen))
            }
            Term::Negative(of) | Term::Not(of) | Term::InUnit(of, _) | Term::Field(of, _) => {
                self.reads_changed(of, seen)
            }
            Term::Two(_, a, b) | Term::Element(a, b) => {
                self.reads_changed(a, seen) || self.reads_changed(b, seen)
            }
        }
    }
}

/// Returns a name without the quotation marks around parts of it that hold blanks.
fn unmarked(name: &str) -> String {
    match name.contains('"') {
        true => name.replace(['"', '\\'], ""),
        false => name.to_owned(),
    }
}
