//! Values of expressions, and of arguments.

use super::database::{Attribute, Database, Datum, Fixed, Item, Reference};
use super::frames::Reading;
use super::term::{Binary, Shared, Term};
use crate::diagnostic::{Diagnostic, Span, counted};
use crate::scalar::Scalar;
use std::rc::Rc;

/// Expressions that read one another, one within the other.
const DEEPEST_CHAIN: usize = 100;

/// A reason why an expression has no value.
pub(super) type Trouble = String;

impl Database {
    /// Returns the value of an expression; locations and orientations are those of a frame.
    pub fn evaluate(&self, term: &Term, within: &Reading) -> Result<Datum, Trouble> {
        if self.depth.get() > DEEPEST_CHAIN {
            return Err("it depends on itself, or on too many others".into());
        }
        self.depth.set(self.depth.get() + 1);
        let value = self.evaluated(term, within);
        self.depth.set(self.depth.get() - 1);
        value
    }

    fn evaluated(&self, term: &Term, within: &Reading) -> Result<Datum, Trouble> {
        let of = |term: &Term| self.evaluate(term, within);
        let number = |term: &Term| of(term).and_then(|d| self.as_number(&d));
        Ok(match term {
            Term::Number(x) => Datum::Number(*x),
            Term::Text(text) => Datum::Text(text.clone()),
            Term::Name(name) => return self.named(name),
            Term::Array(all) => Datum::List(all.iter().map(of).collect::<Result<_, _>>()?),
            Term::Call(name, arguments) => return self.call(name, arguments, within),
            Term::Negative(inner) => self.each(&of(inner)?, |x| -x)?,
            Term::Not(inner) => Datum::Number(f64::from(u8::from(number(inner)? == 0.0))),
            Term::Two(operator, a, b) => self.combined(*operator, &of(a)?, &of(b)?)?,
            Term::Element(list, index) => {
                let index = number(index)?;
                match of(list)? {
                    Datum::List(all) if index >= 1.0 => {
                        let found = all.get(index as usize - 1).cloned();
                        found.ok_or_else(|| format!("it has {}", counted(all.len(), "element")))?
                    }
                    only if index == 1.0 => only,
                    _ => return Err("it has no such element".into()),
                }
            }
            Term::Field(inner, field) => match of(inner)? {
                Datum::Object(k) => return self.field(k, field),
                Datum::Text(name) if self.find(&name).is_some() => {
                    return self.field(self.find(&name).unwrap_or_default(), field);
                }
                _ => return Err("only an object has fields".into()),
            },
            Term::InUnit(inner, unit) => {
                let factor = self.units.factor(*unit);
                self.each(&of(inner)?, |x| x * factor)?
            }
        })
    }

    /// Returns the value of a name: a variable of a loop, an object, a field of one, or a word.
    fn named(&self, name: &str) -> Result<Datum, Trouble> {
        if let Some(value) = self.loops.get(&name.to_ascii_lowercase()) {
            return Ok(value.clone());
        }
        if let Some(k) = self.find(name) {
            return Ok(Datum::Object(k));
        }
        if let Some((object, field)) = name.rsplit_once('.')
            && let Some(k) = self
                .find(object)
                .filter(|k| self.objects[*k].kind != "model")
        {
            return self.field(k, field);
        }
        match name.to_ascii_lowercase().as_str() {
            "pi" => Ok(Datum::Number(std::f64::consts::PI)),
            "none" => Ok(Datum::Nothing),
            "true" | "yes" | "on" => Ok(Datum::Number(1.0)),
            "false" | "no" | "off" => Ok(Datum::Number(0.0)),
            _ if self.is_within_unread(name) => Err(String::new()),
            _ => {
                let near = self.near(name);
                Err(match near.is_empty() {
                    true => format!("there is no `{name}`"),
                    false => format!("there is no `{name}`; did you mean {}?", near.join(" or ")),
                })
            }
        }
    }

    /// Returns a field of an object, `.m.SFORCE_1.i`, `.m.P.mass`.
    fn field(&self, k: usize, field: &str) -> Result<Datum, Trouble> {
        let object = &self.objects[k];
        let lower = field.to_ascii_lowercase();
        let argument = match lower.as_str() {
            "i" | "i_marker" => "i_marker_name",
            "j" | "j_marker" => "j_marker_name",
            "ref_marker" => "ref_marker_name",
            "id" => "adams_id",
            "cm" => "center_of_mass_marker",
            "loc" => "location",
            "ori" => "orientation",
            other => other,
        };
        let axes = ["_x", "_y", "_z"];
        let axis = axes.iter().position(|end| lower.ends_with(end));
        match (argument, axis) {
            ("location", _) => return Ok(self.location_of(k)?.into()),
            ("orientation", _) => return Ok(self.angles_of(k)?.into()),
            ("loc_x" | "loc_y" | "loc_z", Some(axis)) => {
                return Ok(Datum::Number(self.location_of(k)?[axis]));
            }
            ("mass", _) if !object.attributes.contains_key("mass") => {
                let mass = self.mass_of(k).map(|m| Datum::Number(m.mass));
                return mass.ok_or_else(|| format!("the mass of {} is not known", object.name));
            }
            _ => {}
        }
        let known = object
            .attributes
            .iter()
            .find(|(name, _)| **name == argument);
        match known {
            Some((_, attribute)) => {
                let values = self.evaluated_values(attribute, k)?;
                Ok(match <[Datum; 1]>::try_from(values) {
                    Ok([one]) => one,
                    Err(all) => Datum::List(all),
                })
            }
            None if self.is_within_unread(&format!("{}.", object.name)) => Err(String::new()),
            None => Err(format!("{} has no field `{field}`", object.name)),
        }
    }

    /// Returns the numbers that count instead of the expressions of an argument: those of a saved
    /// file, unless a design variable has been changed.
    pub fn counted<'a>(&self, attribute: &'a Attribute) -> Option<&'a Fixed> {
        let changed = |item: &Item| self.is_changed(&item.term);
        let fixed = attribute.fixed.as_ref().filter(|_| self.is_saved)?;
        (!attribute.items.iter().any(changed)).then_some(fixed)
    }

    /// Returns the values of an argument: as numbers of a saved file, or by their expressions.
    pub fn values(&self, attribute: &Attribute, within: &Reading) -> Result<Vec<Datum>, Trouble> {
        if let Some(fixed) = self.counted(attribute) {
            return Ok(fixed.values.clone());
        }
        match self.by_expressions(attribute, within) {
            Ok(values) => Ok(values),
            Err(trouble) => match &attribute.fixed {
                Some(fixed) => Ok(fixed.values.clone()),
                None => Err(trouble),
            },
        }
    }

    /// Returns where the values of an argument are read.
    pub fn frame_of<'a>(&self, attribute: &'a Attribute) -> &'a Reference {
        let fixed = self.counted(attribute).map(|fixed| &fixed.frame);
        fixed.unwrap_or(&attribute.frame)
    }

    /// Returns the values of the expressions of an argument; a list stands for its elements.
    pub fn by_expressions(
        &self,
        attribute: &Attribute,
        within: &Reading,
    ) -> Result<Vec<Datum>, Trouble> {
        let mut all = Vec::new();
        for item in &attribute.items {
            let value = match (&*item.term, item.is_bare) {
                (Term::Name(word), true) => self
                    .named(word)
                    .ok()
                    .filter(|value| matches!(value, Datum::Object(_)) || word.contains('.'))
                    .unwrap_or_else(|| Datum::Text(word.clone())),
                (term, _) => self.evaluate(term, within)?,
            };
            match value {
                Datum::List(inner) => all.extend(inner),
                one => all.push(one),
            }
        }
        Ok(all)
    }

    /// Returns a number, also of a design variable.
    pub fn as_number(&self, value: &Datum) -> Result<f64, Trouble> {
        match value {
            Datum::Number(x) => Ok(*x),
            Datum::List(all) if all.len() == 1 => self.as_number(&all[0]),
            Datum::Object(k) => match self.variable(*k)? {
                Datum::Object(other) => Err(format!("{} is no number", self.objects[other].name)),
                value => self.as_number(&value),
            },
            Datum::Text(text) => {
                let number = text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
                number.ok_or_else(|| format!("`{text}` is no number"))
            }
            Datum::List(all) => Err(format!(
                "{} stand where one is wanted",
                counted(all.len(), "number")
            )),
            Datum::Nothing => Err("(NONE) is no number".into()),
        }
    }

    /// Returns the value of a design variable; of another object itself.
    pub fn variable(&self, k: usize) -> Result<Datum, Trouble> {
        let object = &self.objects[k];
        if object.kind != super::VARIABLE {
            return Ok(Datum::Object(k));
        }
        if let Some(value) = self.changed.get(&object.name.to_ascii_lowercase()) {
            return Ok(Datum::Number(*value));
        }
        let fields = [
            "real_value",
            "integer_value",
            "string_value",
            "object_value",
        ];
        let given = fields.iter().find_map(|f| object.attributes.get(f));
        let Some(attribute) = given else {
            return Err(format!("{} has no value", object.name));
        };
        let values = self.evaluated_values(attribute, k)?;
        Ok(match <[Datum; 1]>::try_from(values) {
            Ok([one]) => one,
            Err(all) => Datum::List(all),
        })
    }

    /// Returns all design variables that are numbers, by their full names; fields of user-defined
    /// elements are none.
    pub fn design_variables(&self) -> std::collections::BTreeMap<String, f64> {
        let is_inner = |k: &usize| {
            let parent = Self::parent(&self.objects[*k].name).and_then(|p| self.find(p));
            parent.is_some_and(|p| self.objects[p].kind == "ude instance")
        };
        let all = self.of_kind(super::VARIABLE).filter(|k| !is_inner(k));
        let numbers = all.filter_map(|k| {
            let Ok(Datum::Number(x)) = self.variable(k) else {
                return None;
            };
            Some((self.objects[k].name.clone(), x))
        });
        numbers.collect()
    }

    fn evaluated_values(&self, attribute: &Attribute, k: usize) -> Result<Vec<Datum>, Trouble> {
        if self.depth.get() > DEEPEST_CHAIN {
            return Err("it depends on itself, or on too many others".into());
        }
        self.depth.set(self.depth.get() + 1);
        let values = self.values(attribute, &Reading::of(k));
        self.depth.set(self.depth.get() - 1);
        values
    }

    /// Returns a list of numbers, of a variable or a place as well.
    pub fn as_numbers(&self, value: &Datum) -> Result<Vec<f64>, Trouble> {
        match value {
            Datum::List(all) => {
                let each = all.iter().map(|one| self.as_numbers(one));
                Ok(each.collect::<Result<Vec<_>, _>>()?.concat())
            }
            Datum::Object(k) => match self.variable(*k)? {
                Datum::Object(k) => Ok(self.location_of(k)?.to_vec()),
                value => self.as_numbers(&value),
            },
            one => Ok(vec![self.as_number(one)?]),
        }
    }

    fn each(&self, value: &Datum, f: impl Fn(f64) -> f64 + Copy) -> Result<Datum, Trouble> {
        match value {
            Datum::List(all) => {
                let all = all.iter().map(|one| self.each(one, f));
                Ok(Datum::List(all.collect::<Result<_, _>>()?))
            }
            Datum::Object(k) if self.objects[*k].kind == super::VARIABLE => {
                self.each(&self.variable(*k)?, f)
            }
            one => Ok(Datum::Number(f(self.as_number(one)?))),
        }
    }

    fn combined(&self, operator: Binary, a: &Datum, b: &Datum) -> Result<Datum, Trouble> {
        let [a, b] = [self.plain(a)?, self.plain(b)?];
        if operator == Binary::Join {
            return Ok(Datum::Text(self.as_text(&a)? + &self.as_text(&b)?));
        }
        if let (Binary::Equal | Binary::Unequal, Datum::Text(a), Datum::Text(b)) =
            (operator, &a, &b)
        {
            let same = a.eq_ignore_ascii_case(b) == (operator == Binary::Equal);
            return Ok(Datum::Number(f64::from(u8::from(same))));
        }
        match (&a, &b) {
            (Datum::List(all), Datum::List(others)) => {
                if all.len() != others.len() {
                    let (one, other) = (counted(all.len(), "element"), others.len());
                    return Err(format!("arrays of {one} and of {other} do not go together"));
                }
                let each = all.iter().zip(others);
                let each = each.map(|(a, b)| self.combined(operator, a, b));
                Ok(Datum::List(each.collect::<Result<_, _>>()?))
            }
            (Datum::List(all), one) => {
                let each = all.iter().map(|a| self.combined(operator, a, one));
                Ok(Datum::List(each.collect::<Result<_, _>>()?))
            }
            (one, Datum::List(all)) => {
                let each = all.iter().map(|b| self.combined(operator, one, b));
                Ok(Datum::List(each.collect::<Result<_, _>>()?))
            }
            _ => {
                let (a, b) = (self.as_number(&a)?, self.as_number(&b)?);
                computed(operator, a, b).map(Datum::Number)
            }
        }
    }

    /// Returns the value of a variable, the place of a point or marker in sums.
    fn plain(&self, value: &Datum) -> Result<Datum, Trouble> {
        match value {
            Datum::Object(k) => match self.variable(*k)? {
                Datum::Object(k) => Ok(self.location_of(k)?.into()),
                value => Ok(value),
            },
            other => Ok(other.clone()),
        }
    }

    /// Returns a text, also of a number.
    pub fn as_text(&self, value: &Datum) -> Result<String, Trouble> {
        Ok(match value {
            Datum::Text(text) => text.clone(),
            Datum::Number(x) => x.to_string(),
            Datum::Object(k) => match self.variable(*k)? {
                Datum::Object(k) => self.objects[k].name.clone(),
                value => return self.as_text(&value),
            },
            Datum::Nothing => String::new(),
            Datum::List(all) => {
                let each = all.iter().map(|one| self.as_text(one));
                each.collect::<Result<Vec<_>, _>>()?.concat()
            }
        })
    }

    /// Returns an expression in which `eval(…)` and variables of loops are their values now.
    pub fn settled(&self, term: &Shared, within: &Reading) -> Result<Shared, Trouble> {
        if self.loops.is_empty() && !has_eval(term) {
            return Ok(Rc::clone(term));
        }
        self.settle(term, within).map(Rc::new)
    }

    fn settle(&self, term: &Term, within: &Reading) -> Result<Term, Trouble> {
        let all = |terms: &[Term]| -> Result<Vec<Term>, Trouble> {
            terms.iter().map(|term| self.settle(term, within)).collect()
        };
        let boxed = |term: &Term| self.settle(term, within).map(Box::new);
        Ok(match term {
            Term::Call(name, arguments) if name == "eval" => {
                let [inner] = &arguments[..] else {
                    return Err("eval takes one expression".into());
                };
                self.constant(self.evaluate(inner, within)?)?
            }
            Term::Name(name) => match self.loops.get(&name.to_ascii_lowercase()) {
                Some(value) => self.constant(value.clone())?,
                None => term.clone(),
            },
            Term::Array(terms) => Term::Array(all(terms)?),
            Term::Call(name, terms) => Term::Call(name.clone(), all(terms)?),
            Term::Negative(of) => Term::Negative(boxed(of)?),
            Term::Not(of) => Term::Not(boxed(of)?),
            Term::InUnit(of, unit) => Term::InUnit(boxed(of)?, *unit),
            Term::Field(of, field) => Term::Field(boxed(of)?, field.clone()),
            Term::Two(operator, a, b) => Term::Two(*operator, boxed(a)?, boxed(b)?),
            Term::Element(a, b) => Term::Element(boxed(a)?, boxed(b)?),
            Term::Number(_) | Term::Text(_) => term.clone(),
        })
    }

    fn constant(&self, value: Datum) -> Result<Term, Trouble> {
        Ok(match value {
            Datum::Number(x) => Term::Number(x),
            Datum::Text(text) => Term::Text(text),
            Datum::Nothing => Term::Name("NONE".into()),
            Datum::Object(k) => match self.variable(k)? {
                Datum::Object(k) => Term::Name(self.objects[k].name.clone()),
                value => self.constant(value)?,
            },
            Datum::List(all) => {
                let each = all.into_iter().map(|one| self.constant(one));
                Term::Array(each.collect::<Result<_, _>>()?)
            }
        })
    }

    /// Says once that an expression has no value.
    pub fn trouble(&self, k: Option<usize>, span: Span, trouble: &str) {
        if trouble.is_empty() || !self.told.borrow_mut().insert(span.start) {
            return;
        }
        let mut d = Diagnostic::error("view_expression", trouble.to_owned());
        d.span = Some(span);
        if let Some(k) = k {
            d.name = Some(self.inner_name(k));
        }
        self.say(d);
    }
}

fn has_eval(term: &Term) -> bool {
    match term {
        Term::Call(name, all) => name == "eval" || all.iter().any(has_eval),
        Term::Array(all) => all.iter().any(has_eval),
        Term::Negative(of) | Term::Not(of) | Term::InUnit(of, _) | Term::Field(of, _) => {
            has_eval(of)
        }
        Term::Two(_, a, b) | Term::Element(a, b) => has_eval(a) || has_eval(b),
        Term::Number(_) | Term::Text(_) | Term::Name(_) => false,
    }
}

fn computed(operator: Binary, a: f64, b: f64) -> Result<f64, Trouble> {
    let truth = |is: bool| f64::from(u8::from(is));
    let value = match operator {
        Binary::Or => truth(a != 0.0 || b != 0.0),
        Binary::And => truth(a != 0.0 && b != 0.0),
        Binary::Equal => truth(a == b),
        Binary::Unequal => truth(a != b),
        Binary::Less => truth(a < b),
        Binary::Greater => truth(a > b),
        Binary::LessOrEqual => truth(a <= b),
        Binary::GreaterOrEqual => truth(a >= b),
        Binary::Add => a + b,
        Binary::Subtract => a - b,
        Binary::Multiply => a * b,
        Binary::Divide => a / b,
        Binary::Power => Scalar::powf(a, b),
        Binary::Join => f64::NAN,
    };
    match value.is_finite() {
        true => Ok(value),
        false => Err(format!("it has no value: {a} and {b} give {value}")),
    }
}

impl From<[f64; 3]> for Datum {
    fn from(all: [f64; 3]) -> Self {
        Datum::List(all.map(Datum::Number).to_vec())
    }
}
