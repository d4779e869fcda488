//! User-defined elements of Adams View that are made of others: springs, general motions, plants.
//!
//! Each becomes the objects that View writes into a dataset in its place, by names within it.

use super::Maker;
use crate::dataset::view::database::{Attribute, Datum, Item};
use crate::dataset::view::term::Term;
use crate::diagnostic::{Cause, Diagnostic};
use crate::scalar::Scalar;
use std::rc::Rc;

/// A function over the line between the markers of a spring.
struct Line {
    displacement: String,
    rate: String,
    /// displacement at which it pushes with its preload
    free: f64,
    /// factor from the file's unit of the displacement to that of the function
    unit: f64,
}

impl Maker<'_> {
    /// Makes the objects of all user-defined elements.
    pub(super) fn expand_elements(&mut self) {
        for k in self.db.of_kind("ude instance").collect::<Vec<_>>() {
            let definition = self.db.word(k, "definition_name").unwrap_or_default();
            let lower = definition.to_ascii_lowercase();
            let done = match lower.trim_start_matches('.') {
                "mdi.forces.spring" => self.spring_element(k, false),
                "mdi.forces.torsion_spring" => self.spring_element(k, true),
                "mdi.constraints.general_motion" => self.general_motion(k),
                "controls.controls_plant" => {
                    self.plant(k);
                    Ok(())
                }
                _ => {
                    let what = format!("{} of {definition}", self.db.inner_name(k));
                    let d = Diagnostic::error(
                        Cause::ViewUnsolved,
                        format!("the user-defined element {what} is not solved"),
                    );
                    let d = d.help("springs, torsion springs, general motions and controls plants are; switch it off (active = off) to solve the model without it");
                    let d = self.source.locate(d, self.db.objects[k].head);
                    self.db.say(d);
                    let begin = format!("{}.", self.db.objects[k].name);
                    self.db.unread.push(begin.to_ascii_lowercase());
                    self.make_inner_parts(k);
                    Ok(())
                }
            };
            if let Err(trouble) = done {
                self.db.trouble(Some(k), self.db.objects[k].head, &trouble);
            }
        }
    }

    /// Parts of an element that is not read are there for what refers to them.
    fn make_inner_parts(&mut self, k: usize) {
        let begin = format!("{}.", self.db.objects[k].name).to_ascii_lowercase();
        let head = self.db.objects[k].head;
        let held: Vec<String> = self
            .db
            .objects
            .iter()
            .filter(|o| o.kind.starts_with("marker") || o.kind.starts_with("floating"))
            .filter(|o| o.name.to_ascii_lowercase().starts_with(&begin))
            .filter_map(|o| crate::dataset::view::database::Database::parent(&o.name))
            .map(str::to_owned)
            .collect();
        for part in held {
            if self.db.find(&part).is_none() {
                self.db.object(&part, crate::dataset::view::PART, head);
            }
        }
    }

    /// Returns a field of an element: a variable within it.
    fn ude_field(&self, k: usize, field: &str) -> Option<Datum> {
        let name = format!("{}.{field}", self.db.objects[k].name);
        let variable = self.db.find(&name)?;
        self.db.variable(variable).ok()
    }

    fn field_number(&self, k: usize, field: &str) -> Option<f64> {
        let value = self.ude_field(k, field)?;
        self.db.as_number(&value).ok()
    }

    fn field_text(&self, k: usize, field: &str) -> String {
        let value = self.ude_field(k, field);
        value
            .and_then(|v| self.db.as_text(&v).ok())
            .unwrap_or_default()
    }

    /// Returns the full name of the object that a field names.
    fn field_object(&self, k: usize, field: &str) -> Option<String> {
        let object = match self.ude_field(k, field)? {
            Datum::Object(k) => k,
            Datum::Text(text) => self.db.find(&text)?,
            _ => return None,
        };
        Some(self.db.objects[object].name.clone())
    }

    /// Adds an object within an element.
    fn inner(
        &mut self,
        k: usize,
        name: &str,
        kind: &'static str,
        given: Vec<(&'static str, Vec<Term>)>,
    ) {
        let head = self.db.objects[k].head;
        let name = format!("{}.{name}", self.db.objects[k].name);
        let made = self.db.object(&name, kind, head);
        for (argument, terms) in given {
            let item = |term: Term| Item {
                is_bare: matches!(term, Term::Name(_)),
                term: Rc::new(term),
                span: head,
            };
            let attribute = Attribute {
                items: terms.into_iter().map(item).collect(),
                span: head,
                ..Attribute::default()
            };
            self.db.objects[made].attributes.insert(argument, attribute);
        }
    }

    /// `.MDI.Forces.spring` and `.MDI.Forces.torsion_spring`.
    fn spring_element(&mut self, k: usize, turns: bool) -> Result<(), String> {
        let side = |field| {
            self.field_object(k, field)
                .ok_or(format!("{field} names no marker"))
        };
        let (i, j) = (side("i_marker")?, side("j_marker")?);
        let line = self.line(k, &i, &j, turns)?;
        let function = self.spring_function(k, &line)?;
        let sforce = vec![
            (
                "type_of_freedom",
                vec![Term::Name(
                    if turns { "rotational" } else { "translational" }.into(),
                )],
            ),
            ("i_marker_name", vec![Term::Name(i.clone())]),
            ("j_marker_name", vec![Term::Name(j.clone())]),
            ("function", vec![Term::Text(function)]),
        ];
        let name = self.db.objects[k].name.clone();
        self.inner(k, "sforce", "force direct single_component_force", sforce);
        let deformation = match turns {
            true => format!("AZ({i},{j})"),
            false => format!("DM({i},{j}) - {}", shown(line.free)),
        };
        let rest = match turns {
            true => ("torque", format!("SFORCE({name}.sforce,0,8,{j})")),
            false => {
                let sum = ["X", "Y", "Z"].map(|a| format!("D{a}({i},{j})*F{a}({i},{j})"));
                ("force", format!("({})/DM({i},{j})", sum.join(" + ")))
            }
        };
        for (what, text) in [
            ("deformation", deformation),
            ("deformation_velocity", line.rate.to_uppercase()),
            rest,
        ] {
            let given = vec![("function", vec![Term::Text(text)])];
            self.inner(k, what, "data_element variable", given);
        }
        Ok(())
    }

    /// Returns displacement and rate of a spring between two markers.
    fn line(&self, k: usize, i: &str, j: &str, turns: bool) -> Result<Line, String> {
        let pose = |name: &str| {
            let k = self.db.find(name).ok_or(format!("there is no {name}"))?;
            self.db.pose(k)
        };
        let (at_i, at_j) = (pose(i)?, pose(j)?);
        Ok(match turns {
            true => {
                let x = at_j.inverse().compose(&at_i).rotation.column(0).0;
                let unit = self.db.units.angle();
                Line {
                    displacement: format!("az({i},{j})"),
                    rate: format!("wz({i},{j},{j})"),
                    free: self.free_displacement(k, Scalar::atan2(x[1], x[0]), unit),
                    unit,
                }
            }
            false => {
                let drawn = (at_i.position - at_j.position).norm();
                // ten digits, as View writes it
                let drawn = format!("{drawn:.9e}").parse().unwrap_or(drawn);
                Line {
                    displacement: format!("dm({i},{j})"),
                    rate: format!("vr({i},{j})"),
                    free: self.free_displacement(k, drawn, 1.0),
                    unit: 1.0,
                }
            }
        })
    }

    /// Returns the force over the line, in the words in which View writes it.
    fn spring_function(&self, k: usize, line: &Line) -> Result<String, String> {
        let mut text = String::new();
        for (what, argument) in [
            (
                "stiffness",
                format!("({}-{})", line.displacement, shown(line.free)),
            ),
            ("damping", line.rate.clone()),
        ] {
            let mode = self
                .field_text(k, &format!("{what}_mode"))
                .to_ascii_lowercase();
            match mode.as_str() {
                "none" => text += " + 0",
                "spline" => {
                    let spline = self.field_object(k, &format!("{what}_spline"));
                    let spline = spline.ok_or(format!("{what}_spline names no spline"))?;
                    text += &format!(" - akispl({argument},0,{spline})");
                }
                _ => {
                    let coefficient = self.field_number(k, &format!("{what}_coefficient"));
                    let Some(coefficient) = coefficient else {
                        return Err(format!("{what}_coefficient has no value"));
                    };
                    text += &format!(" - {}*{argument}", shown(coefficient / line.unit));
                }
            }
        }
        let preload = self.field_number(k, "preload").unwrap_or(0.0);
        Ok(text + " + " + &shown(preload))
    }

    /// Returns the displacement at which a spring pushes with its preload.
    fn free_displacement(&self, k: usize, drawn: f64, unit: f64) -> f64 {
        let design =
            self.field_text(k, "free_length_mode") + &self.field_text(k, "free_angle_mode");
        let stated = self.field_number(k, "free_length");
        let stated = stated.or_else(|| self.field_number(k, "free_angle"));
        match design.to_ascii_lowercase().starts_with("design") {
            true => drawn,
            false => stated.map_or(drawn, |x| x * unit),
        }
    }

    /// `.MDI.Constraints.general_motion`: up to six motions between two markers.
    fn general_motion(&mut self, k: usize) -> Result<(), String> {
        let side = |field| {
            self.field_object(k, field)
                .ok_or(format!("{field} names no marker"))
        };
        let (i, j) = (side("i_marker")?, side("j_marker")?);
        for (name, axis) in [
            ("t1", "x"),
            ("t2", "y"),
            ("t3", "z"),
            ("r1", "b1"),
            ("r2", "b2"),
            ("r3", "b3"),
        ] {
            let level = self.field_number(k, &format!("{name}_type")).unwrap_or(0.0);
            let level = match level {
                1.0 => "displacement",
                2.0 => "velocity",
                3.0 => "acceleration",
                _ => continue,
            };
            let function = self.field_text(k, &format!("{name}_func"));
            let mut given = vec![
                ("i_marker_name", vec![Term::Name(i.clone())]),
                ("j_marker_name", vec![Term::Name(j.clone())]),
                ("axis", vec![Term::Name(axis.into())]),
                ("time_derivative", vec![Term::Name(level.into())]),
                ("function", vec![Term::Text(function)]),
            ];
            let beginnings: &[(&'static str, &str)] = match level {
                "displacement" => &[],
                "velocity" => &[("displacement_ic", "disp")],
                _ => &[("displacement_ic", "disp"), ("velocity_ic", "velo")],
            };
            for (argument, field) in beginnings {
                if let Some(x) = self.field_number(k, &format!("{name}_ic_{field}")) {
                    given.push((*argument, vec![Term::Number(x)]));
                }
            }
            self.inner(
                k,
                &format!("motion_{name}"),
                "constraint motion_generator",
                given,
            );
        }
        Ok(())
    }

    /// `.controls.controls_plant`: inputs and outputs of a plant.
    fn plant(&mut self, k: usize) {
        for (field, name, kind) in [
            ("input_channels", "ctrl_pinput", "data_element plant input"),
            (
                "output_channels",
                "ctrl_poutput",
                "data_element plant output",
            ),
        ] {
            let values = match self.ude_field(k, field) {
                Some(Datum::List(all)) => all,
                Some(one) => vec![one],
                None => continue,
            };
            let object = |value: &Datum| match value {
                Datum::Object(k) => Some(*k),
                Datum::Text(text) => self.db.find(text),
                _ => None,
            };
            let names = values.iter().filter_map(object);
            let names: Vec<Term> = names
                .map(|k| Term::Name(self.db.objects[k].name.clone()))
                .collect();
            if !names.is_empty() {
                self.inner(k, name, kind, vec![("variable_name", names)]);
            }
        }
    }
}

/// Returns a number as View writes it into functions: always with its point.
pub(super) fn shown(x: f64) -> String {
    let plain = match x == 0.0 || (1e-3..1e5).contains(&x.abs()) {
        true => format!("{x:?}"),
        false => {
            let text = format!("{x:E}");
            match text.split_once('E') {
                Some((digits, power)) if !digits.contains('.') => format!("{digits}.0E{power}"),
                _ => text,
            }
        }
    };
    match x < 0.0 {
        true => format!("({plain})"),
        false => plain,
    }
}
