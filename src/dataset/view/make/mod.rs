//! From objects to records of the table of statements, as Adams View writes datasets.
//!
//! ```text
//! bodies        parts, markers, graphics
//! constraints   joints, primitives, motions, couplers, gears, curves
//! forces        forces, bushings, beams, friction, contacts
//! solids        solids of contacts
//! data          variables, splines, matrices, arrays, equations, plants
//! outputs       sensors, requests, settings
//! measures      measures, which become variables
//! elements      springs and general motions, which Adams View calls user-defined elements
//! function      names of objects in functions
//! ```

mod bodies;
mod constraints;
mod data;
mod elements;
mod forces;
mod function;
mod measures;
mod outputs;
mod solids;

use super::database::Database;
use crate::arrange::Arrange;
use crate::dataset::row::{Given, Record, Statement};
use crate::dataset::statement::STATEMENTS;
use crate::dataset::syntax::Source;
use crate::dataset::value::{Kind, Number, Value};
use crate::diagnostic::{Diagnostic, Span};
use crate::model::{ElementId, ElementKind, Formula, Place};
use std::collections::{BTreeMap, BTreeSet};

/// Kinds of objects, by the beginning of the words that make them, and the elements they become.
const KINDS: &[(&str, ElementKind)] = &[
    ("part rigid_body", ElementKind::Part),
    ("part point_mass", ElementKind::PointMass),
    ("part equation differential_equation", ElementKind::Diff),
    ("part equation linear_state_equation", ElementKind::Lse),
    ("part equation general_state_equation", ElementKind::Gse),
    ("part equation transfer_function", ElementKind::Tfsiso),
    ("marker", ElementKind::Marker),
    ("floating_marker", ElementKind::Marker),
    ("constraint joint", ElementKind::Joint),
    ("constraint primitive_joint", ElementKind::Jprim),
    ("constraint motion_generator", ElementKind::Motion),
    ("constraint complex_joint coupler", ElementKind::Coupler),
    ("constraint complex_joint gear", ElementKind::Gear),
    ("constraint general_constraint", ElementKind::Gcon),
    ("constraint user_defined", ElementKind::Ucon),
    (
        "constraint higher_pair_contact point_curve",
        ElementKind::Ptcv,
    ),
    (
        "constraint higher_pair_contact curve_curve",
        ElementKind::Cvcv,
    ),
    ("force direct single_component_force", ElementKind::Sforce),
    ("force direct force_vector", ElementKind::Vforce),
    ("force direct torque_vector", ElementKind::Vtorque),
    ("force direct general_force", ElementKind::Gforce),
    ("force direct multi_point_force", ElementKind::Nforce),
    ("force element_like bushing", ElementKind::Bushing),
    ("force element_like beam", ElementKind::Beam),
    ("force element_like field", ElementKind::Field),
    ("force element_like friction", ElementKind::Friction),
    (
        "force element_like rotational_spring",
        ElementKind::SpringDamper,
    ),
    (
        "force element_like translational_spring",
        ElementKind::SpringDamper,
    ),
    ("contact", ElementKind::Contact),
    ("data_element variable", ElementKind::Variable),
    ("data_element plant input", ElementKind::Pinput),
    ("data_element plant output", ElementKind::Poutput),
    ("data_element spline", ElementKind::Spline),
    ("data_element matrix", ElementKind::Matrix),
    ("data_element array", ElementKind::Array),
    ("data_element curve", ElementKind::Curve),
    ("data_element string", ElementKind::String),
    ("executive_control sensor", ElementKind::Sensor),
    ("output_control request", ElementKind::Request),
    ("geometry shape block", ElementKind::Graphics),
    ("geometry shape cylinder", ElementKind::Graphics),
    ("geometry shape ellipsoid", ElementKind::Graphics),
    ("geometry shape frustum", ElementKind::Graphics),
    ("geometry shape torus", ElementKind::Graphics),
    ("geometry shape plane", ElementKind::Graphics),
    ("geometry shape force", ElementKind::Graphics),
    ("geometry shape spring_damper", ElementKind::Graphics),
    ("geometry curve circle", ElementKind::Graphics),
    ("geometry curve arc", ElementKind::Graphics),
    ("measure", ElementKind::Variable),
];

/// Returns the kind of element that an object of a kind becomes.
fn element_kind(kind: &str) -> Option<ElementKind> {
    let is = |row: &&(&str, ElementKind)| {
        let rest = kind.strip_prefix(row.0);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' ') || rest.starts_with('_'))
    };
    KINDS.iter().find(is).map(|row| row.1)
}

/// The maker of records.
pub(super) struct Maker<'a> {
    pub source: &'a Source,
    pub db: Database,
    pub ids: BTreeMap<usize, ElementId>,
    taken: BTreeSet<ElementId>,
    /// numbers of a kind below this one are taken
    free_from: BTreeMap<ElementKind, u32>,
    pub records: Vec<Record>,
    has_told_rates: bool,
    /// parts without a known mass, and why
    massless: Vec<(usize, String)>,
}

/// The advice where a number has a decimal comma.
pub(super) const DECIMALS: &str =
    "decimals are written with a point (1.5); a comma begins another value";

/// A value on its way into a record.
pub(super) enum Want {
    Flag,
    Object(ElementId),
    Count(usize),
    Ids(Vec<ElementId>),
    Numbers(Vec<f64>),
    /// degrees
    Degrees(Vec<f64>),
    /// angles in the unit of the file
    Angles(Vec<f64>),
    Word(String),
    Words(Vec<String>),
    Text(String),
    Texts(Vec<String>),
    Formula(Formula),
}

/// A record that is being made.
pub(super) struct Draft {
    pub record: Record,
    /// the object whose element it is
    pub object: Option<usize>,
    in_degrees: bool,
    /// lists of the wrong length
    wrong: Vec<(Span, String)>,
}

impl Draft {
    /// Gives an argument a value.
    pub fn give(&mut self, keyword: &str, want: Want, span: Span) {
        let arguments = self.record.row.arguments();
        let is = |name: &str| name.split('|').any(|n| n.eq_ignore_ascii_case(keyword));
        let Some(k) = arguments.iter().position(|a| is(a.name)) else {
            debug_assert!(self.record.row.open(), "{keyword} is an argument");
            let text = match want {
                Want::Word(text) | Want::Text(text) => text,
                Want::Numbers(all) => {
                    Value::Reals(all.into_iter().map(Number::plain).collect()).to_string()
                }
                _ => String::new(),
            };
            self.record.kept.push((keyword.to_uppercase(), text));
            return;
        };
        if let Some(wrong) = wrong_length(arguments[k].kind, &want) {
            self.record.mistaken = true;
            self.wrong.push((span, wrong));
            return;
        }
        let list = matches!(arguments[k].kind, Kind::Reals { .. });
        let ids = matches!(arguments[k].kind, Kind::Ids { .. });
        let numbers = |all: Vec<Number>| match (list, all.first()) {
            (false, Some(first)) => Value::Real(*first),
            _ => Value::Reals(all),
        };
        let degrees = |all: Vec<f64>| {
            let each = all.into_iter().map(|literal| Number {
                literal,
                degrees: true,
            });
            numbers(each.collect())
        };
        let is_whole = matches!(arguments[k].kind, Kind::Id);
        let is_formula = matches!(arguments[k].kind, Kind::Formula);
        let plain = |all: Vec<f64>| match all[..] {
            [one] if is_whole => Value::Id(one as u32),
            [one] if is_formula => Value::Formula(Formula::text(one.to_string())),
            _ => numbers(all.into_iter().map(Number::plain).collect()),
        };
        let value = match want {
            Want::Flag => Value::Flag,
            Want::Object(id) if ids => Value::Ids(vec![id.number]),
            Want::Object(id) => Value::Id(id.number),
            Want::Count(n) => Value::Id(u32::try_from(n).unwrap_or(u32::MAX)),
            Want::Ids(all) => Value::Ids(all.iter().map(|id| id.number).collect()),
            Want::Numbers(all) => plain(all),
            Want::Degrees(all) => degrees(all),
            Want::Angles(all) if self.in_degrees => degrees(all),
            Want::Angles(all) => plain(all),
            Want::Word(word) => Value::Word(word.to_uppercase()),
            Want::Words(words) => Value::Words(words),
            Want::Text(text) => Value::Text(text),
            Want::Texts(texts) => Value::Texts(texts),
            Want::Formula(formula) => Value::Formula(formula),
        };
        self.record.given.push(Given {
            argument: k,
            value,
            span,
        });
    }

    /// Gives a bare keyword.
    pub fn flag(&mut self, keyword: &str) {
        self.give(keyword, Want::Flag, self.record.head);
    }
}

/// Returns what is wrong with the number of values that an argument gets.
fn wrong_length(kind: Kind, want: &Want) -> Option<String> {
    let (Want::Numbers(all) | Want::Degrees(all) | Want::Angles(all)) = want else {
        return None;
    };
    let (least, most) = match kind {
        Kind::Reals { min, max, .. } => (min, max),
        _ => (1, 1),
    };
    let n = all.len();
    let one = if most == 1 { "one number" } else { "" };
    let meant = match one {
        "" => kind.describe(),
        one => one.to_owned(),
    };
    (!(least..=most).contains(&n)).then(|| format!("{meant} is meant here, not {n}"))
}

impl<'a> Maker<'a> {
    pub fn new(source: &'a Source, db: Database) -> Self {
        Self {
            source,
            db,
            ids: BTreeMap::new(),
            taken: BTreeSet::new(),
            free_from: BTreeMap::new(),
            records: Vec::new(),
            has_told_rates: false,
            massless: Vec::new(),
        }
    }

    /// Makes all records.
    pub fn make(&mut self) {
        self.expand_elements();
        self.leave_out_with_owners();
        self.make_markers();
        self.number();
        self.make_settings();
        self.make_bodies();
        self.make_constraints();
        self.doubt_frames();
        self.make_forces();
        self.make_data();
        self.make_outputs();
        self.make_measures();
        self.tell_of_variables();
    }

    /// Says of design variables that have no value why, whether or not anything reads them.
    fn tell_of_variables(&self) {
        for k in self.db.of_kind(crate::dataset::view::VARIABLE) {
            let object = &self.db.objects[k];
            let fields = ["real_value", "integer_value"];
            let given = fields.iter().find_map(|field| object.attributes.get(field));
            if let (Some(attribute), Err(trouble)) = (given, self.db.variable(k)) {
                self.db.trouble(Some(k), attribute.span, &trouble);
            }
        }
    }

    /// Leaves out what stands on parts that are not part of the model.
    fn leave_out_with_owners(&mut self) {
        for k in 0..self.db.objects.len() {
            let owner = self.db.owner(k);
            if owner.is_some_and(|owner| self.db.objects[owner].is_idle) {
                self.db.objects[k].is_idle = true;
            }
        }
    }

    /// Gives every element its number: that of the file, else one behind all others. Measures and
    /// what user-defined elements are made of have none in any file: they take the first that are
    /// free, as they were made between the others.
    fn number(&mut self) {
        let mut without = Vec::new();
        for k in 0..self.db.objects.len() {
            let object = &self.db.objects[k];
            let Some(kind) = element_kind(object.kind).filter(|_| !object.is_gone) else {
                continue;
            };
            let stated = self.db.number(k, "adams_id");
            let stated = stated.filter(|n| *n >= 1.0 && *n <= f64::from(u32::MAX));
            let stated = stated.map(|n| kind.id(n as u32));
            match stated {
                // what is switched off keeps its number
                Some(id) if self.taken.insert(id) => {
                    if !self.db.objects[k].is_idle {
                        self.ids.insert(k, id);
                    }
                }
                _ if self.db.objects[k].is_idle => {}
                _ => {
                    // what loops make has one place; elements stand where they were begun
                    let is_inner = self.is_inner(k);
                    let at = if is_inner { object.head.start } else { 0 };
                    without.push((is_inner, at, k, kind));
                }
            }
        }
        let grounds = without.iter().filter(|of| self.db.objects[of.2].is_ground);
        for (_, _, k, kind) in grounds.copied().collect::<Vec<_>>() {
            let id = kind.id(1);
            let id = if self.taken.insert(id) {
                id
            } else {
                self.behind(kind)
            };
            self.ids.insert(k, id);
        }
        without.arrange_by_key(|(is_inner, at, ..)| (*is_inner, *at));
        for (is_inner, _, k, kind) in without {
            if !self.ids.contains_key(&k) {
                let id = if is_inner {
                    self.free(kind)
                } else {
                    self.behind(kind)
                };
                self.ids.insert(k, id);
            }
        }
    }

    /// Returns whether an object never has a number in a file.
    fn is_inner(&self, k: usize) -> bool {
        let object = &self.db.objects[k];
        let parent = Database::parent(&object.name).and_then(|parent| self.db.find(parent));
        let in_element = parent.is_some_and(|p| self.db.objects[p].kind == "ude instance");
        in_element || object.kind.starts_with("measure")
    }

    /// Returns the number behind all others of a kind.
    pub fn behind(&mut self, kind: ElementKind) -> ElementId {
        let last = self.taken.range(kind.id(1)..=kind.id(u32::MAX)).next_back();
        let id = kind.id(last.map_or(1, |id| id.number.saturating_add(1)));
        self.taken.insert(id);
        id
    }

    /// Returns the first free number of a kind.
    fn free(&mut self, kind: ElementKind) -> ElementId {
        let mut number = self.free_from.get(&kind).copied().unwrap_or(1);
        while self.taken.contains(&kind.id(number)) && number < u32::MAX {
            number += 1;
        }
        self.free_from.insert(kind, number);
        let id = kind.id(number);
        self.taken.insert(id);
        id
    }

    /// Begins the record of an object's element.
    pub fn draft(&self, k: usize) -> Option<Draft> {
        let id = *self.ids.get(&k)?;
        let mut draft = self.made(id, &self.view_name(k), self.db.objects[k].head)?;
        draft.object = Some(k);
        Some(draft)
    }

    /// Returns the name that Adams View writes above a statement: within a user-defined element
    /// that of the element before it.
    fn view_name(&self, k: usize) -> String {
        let inner = self.db.inner_name(k);
        let mut parts: Vec<&str> = inner.split('.').collect();
        let first = parts.first().copied().unwrap_or_default();
        let is_element = self.db.find(first);
        let is_element = is_element.is_some_and(|e| self.db.objects[e].kind == "ude instance");
        let is_held = ["marker", "floating", "geometry"];
        let is_held = is_held
            .iter()
            .any(|h| self.db.objects[k].kind.starts_with(h));
        if is_held || !is_element {
            parts = parts.split_off(parts.len().saturating_sub(1));
        }
        parts.join(".")
    }

    /// Begins the record of an element that stands for no object.
    pub fn made(&self, id: ElementId, name: &str, head: Span) -> Option<Draft> {
        let row = STATEMENTS.iter().find(|row| row.kind() == Some(id.kind))?;
        Some(self.begun(*row, Some(id.number), Some(name.to_owned()), head))
    }

    /// Begins the record of a statement without a number.
    pub fn setting(&self, keyword: &str, head: Span) -> Option<Draft> {
        let row = STATEMENTS.iter().find(|row| row.keyword() == keyword)?;
        Some(self.begun(*row, None, None, head))
    }

    fn begun(
        &self,
        row: &'static dyn Statement,
        id: Option<u32>,
        name: Option<String>,
        head: Span,
    ) -> Draft {
        let place = Place {
            line: self.source.place(head.start).0,
            name,
            extra: Vec::new(),
        };
        Draft {
            record: Record {
                row,
                id,
                given: Vec::new(),
                kept: Vec::new(),
                place,
                head,
                mistaken: false,
            },
            object: None,
            in_degrees: self.db.units.in_degrees(),
            wrong: Vec::new(),
        }
    }

    pub fn push(&mut self, draft: Draft) {
        for (span, what) in draft.wrong {
            let d = Diagnostic::error("view_expression", what);
            let mut d = self.source.locate(d, span);
            d.name = draft.object.map(|k| self.db.inner_name(k));
            self.db.say(d.help(DECIMALS));
        }
        self.records.push(draft.record);
    }

    /// Returns the number of an object's element; what is none is told.
    pub fn id(&self, of: usize, argument: &str, object: usize) -> Option<ElementId> {
        let found = self.ids.get(&object).copied();
        if found.is_none() {
            let other = &self.db.objects[object];
            let why = match other.is_idle {
                true => "is switched off (active = off)",
                false => "is not part of the model",
            };
            let what = format!("{} {why}", self.db.inner_name(object));
            self.db.trouble(Some(of), self.db.span(of, argument), &what);
        }
        found
    }

    /// Gives an argument the element that an argument of the object names.
    pub fn element(&self, draft: &mut Draft, argument: &str, keyword: &str) {
        let Some(k) = draft.object else {
            return;
        };
        let Some(other) = self.db.reference_of(k, argument) else {
            // what it names is not there, which has been told
            draft.record.mistaken |= self.db.given(k, argument).is_some();
            return;
        };
        if let Some(id) = self.id(k, argument, other) {
            draft.give(keyword, Want::Object(id), self.db.span(k, argument));
        } else {
            draft.record.mistaken = true;
        }
    }

    /// Gives an argument all elements that an argument of the object names.
    pub fn elements(&self, draft: &mut Draft, argument: &str, keyword: &str) {
        let Some(k) = draft.object else {
            return;
        };
        let others = self.db.references_of(k, argument);
        let all: Option<Vec<ElementId>> = others.iter().map(|o| self.id(k, argument, *o)).collect();
        match all {
            Some(all) if !all.is_empty() => {
                draft.give(keyword, Want::Ids(all), self.db.span(k, argument));
            }
            Some(_) => draft.record.mistaken |= self.db.given(k, argument).is_some(),
            None => draft.record.mistaken = true,
        }
    }

    /// Gives arguments the numbers that arguments of the object have; those that are not given, or
    /// all zero where `zeros` is false, are left out.
    pub fn numbers(&self, draft: &mut Draft, pairs: &[(&str, &str)], zeros: bool) {
        let Some(k) = draft.object else {
            return;
        };
        for (argument, keyword) in pairs {
            let Some(numbers) = self.db.numbers(k, argument) else {
                continue;
            };
            if zeros || numbers.iter().any(|x| *x != 0.0) {
                draft.give(keyword, Want::Numbers(numbers), self.db.span(k, argument));
            }
        }
    }

    /// Gives bare keywords for arguments that are on.
    pub fn flags(&self, draft: &mut Draft, pairs: &[(&str, &str)]) {
        let Some(k) = draft.object else {
            return;
        };
        for (argument, keyword) in pairs {
            if self.db.is_on(k, argument) == Some(true) {
                draft.give(keyword, Want::Flag, self.db.span(k, argument));
            }
        }
    }

    /// Says something about an object, at one of its arguments or its command.
    pub fn say(&self, k: usize, argument: &str, said: Diagnostic) {
        let mut said = self.source.locate(said, self.db.span(k, argument));
        said.element = self.ids.get(&k).map(ToString::to_string);
        said.name = Some(self.db.inner_name(k));
        self.db.say(said);
    }
}
