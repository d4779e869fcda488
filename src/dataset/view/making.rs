//! Objects made and changed by a command, with their names, frames and values.

use super::commands::Row;
use super::database::{Attribute, Database, Fixed, Reference};
use super::frames::Reading;
use super::interpret::Interpreter;
use super::syntax::{Argument, Command, Form};
use crate::diagnostic::Diagnostic;

impl Interpreter<'_> {
    pub(super) fn make_object(
        &mut self,
        row: &'static Row,
        verb: &str,
        given: &[(&'static str, &Argument)],
        command: &Command,
    ) {
        let kind = kind_of(row);
        let own = row.arguments[0];
        let named = given.iter().find(|(name, _)| *name == own);
        let name = named.and_then(|(_, argument)| argument.values.first());
        let name = match name.map(|value| self.name(*value)) {
            Some(Ok(name)) => name,
            Some(Err(d)) => return self.db.say(d),
            None => String::new(),
        };
        let Some(name) = self.object_name(row, kind, name, verb, command) else {
            return;
        };
        let head = command.head();
        let is_set = row.words.contains(&"set") || kind == super::VARIABLE || kind == "model";
        if verb == "create" && !is_set && ![super::PART, super::POINT_MASS].contains(&kind) {
            let full = self.db.find(&name).map(|k| &self.db.objects[k]);
            if let Some(before) = full.filter(|before| before.name.eq_ignore_ascii_case(&name)) {
                let (line, _) = self.source.place(before.head.start);
                let what = format!("{name} is made twice");
                let d = Diagnostic::error("name_twice", what);
                let d = d.help(format!(
                    "it has been made in line {line}; `modify` changes it"
                ));
                return self.say(d, head);
            }
        }
        let there = self
            .db
            .find(&name)
            .filter(|k| self.db.objects[*k].kind == kind);
        let k = match there {
            Some(k) => k,
            None => self.db.object(&name, kind, head),
        };
        if kind == super::PART {
            self.db.part = Some(self.db.objects[k].name.clone());
        }
        let relative = given.iter().find(|(name, _)| *name == "relative_to");
        let relative = relative.and_then(|(_, a)| a.values.first().copied());
        let frame = match relative.map(|value| self.name(value)) {
            Some(Ok(name)) => Reference::Of(name),
            Some(Err(d)) => {
                self.db.say(d);
                Reference::Own
            }
            None => self.db.frame.clone().map_or(Reference::Own, Reference::Of),
        };
        for (name, argument) in given {
            if *name != own || row.words.contains(&"set") {
                self.give(k, name, argument, &frame, verb == "modify");
            }
        }
    }

    /// Returns the full name of what a command makes; `None` when it is refused or left aside.
    fn object_name(
        &mut self,
        row: &'static Row,
        kind: &'static str,
        name: String,
        verb: &str,
        command: &Command,
    ) -> Option<String> {
        if kind == "model" {
            return self.begin_model(&name, verb, command);
        }
        if row.words.contains(&"set") {
            let model = self.db.model.as_deref().unwrap_or_default();
            return Some(format!("{model}.{}", kind.replace(' ', "_")));
        }
        if name.trim().is_empty() {
            let what = format!(
                "`{}` does not say its {}",
                row.words.join(" "),
                row.arguments[0]
            );
            let d = Diagnostic::error("missing_argument", what);
            self.say(d, command.head());
            return None;
        }
        if verb == "modify"
            && let Some(k) = self.db.find(&name)
        {
            return Some(self.db.objects[k].name.clone());
        }
        let part = self.db.part.clone();
        let model = self.db.model.clone();
        let ground = model.map(|model| format!("{model}.ground"));
        let held = ["marker", "floating_marker", "point", "geometry"];
        let parent = match held.contains(&row.words[0]) {
            true => part.or(ground),
            false => None,
        };
        let full = self.db.full_name(&name, parent.as_deref());
        let is_known = self.db.find(&full).is_some();
        let parent = Database::parent(&full).and_then(|parent| self.db.find(parent));
        let of_element = parent.is_some_and(|p| self.db.objects[p].kind == "ude instance");
        if verb == "modify" && !is_known && of_element && row.words[0] != "variable" {
            // the element makes it, or is told not to be read
            return None;
        }
        // fields and inner parts of user-defined elements are made by the element itself
        let is_inner =
            row.words[0] == "variable" || full.matches('.').count() > 3 || row.words[0] == "part";
        if verb == "modify" && !is_known && !is_inner {
            let near = self.db.near(&name);
            let what = format!("there is no `{name}` that could be changed");
            let d = Diagnostic::error("unknown_element", what);
            let d = match near.is_empty() {
                true => d,
                false => d.help(format!("did you mean {}?", near.join(" or "))),
            };
            self.say(d, command.head());
            return None;
        }
        Some(full)
    }

    fn begin_model(&mut self, name: &str, verb: &str, command: &Command) -> Option<String> {
        let name = format!(".{}", name.trim_start_matches('.').replace('"', ""));
        let Some(first) = &self.db.model else {
            let ground = format!("{name}.ground");
            self.db.model = Some(name.clone());
            let k = self.db.object(&ground, super::PART, command.head());
            self.db.objects[k].is_ground = true;
            self.db.part = Some(ground);
            return Some(name);
        };
        let begun = format!("{first}.").to_ascii_lowercase();
        let lower = name.to_ascii_lowercase();
        let is_inner = lower.starts_with(&begun);
        if !is_inner && !lower.eq_ignore_ascii_case(first) && verb == "create" {
            let what = format!("a second model, {name}, stands in this file beside {first}");
            let d = Diagnostic::error("view_left_out", what).help("one file holds one model here");
            self.say(d, command.head());
        }
        (!is_inner).then_some(first.clone())
    }

    /// Returns whether an argument says yes.
    fn is_true(&self, argument: &Argument) -> bool {
        let word = argument.values.first().map(|value| self.slice(value.span));
        let yes = ["yes", "on", "true"];
        word.is_some_and(|word| yes.iter().any(|y| y.eq_ignore_ascii_case(word)))
    }

    /// Gives an argument of an object its values.
    fn give(
        &mut self,
        k: usize,
        name: &'static str,
        argument: &Argument,
        frame: &Reference,
        changes: bool,
    ) {
        let mut items = Vec::new();
        for piece in &argument.values {
            match self.item(*piece) {
                Ok(item) => items.push(item),
                // nothing follows from what has not been understood
                Err(d) => return self.db.say(d),
            }
        }
        let frame = match name {
            "location" | "orientation" | "along_axis_orientation" | "in_plane_orientation" => {
                frame.clone()
            }
            _ => Reference::Own,
        };
        let before = self.db.objects[k].attributes.get(name);
        let before = before.and_then(|attribute| attribute.fixed.clone());
        let are_expressions = argument.values.iter().any(|p| p.form == Form::Group);
        let mut now = Attribute {
            items,
            frame: frame.clone(),
            fixed: None,
            span: argument.span(),
        };
        let repeats = changes && self.db.is_saved && are_expressions && before.is_some();
        now.fixed = match repeats {
            true => before,
            false => {
                let within = Reading {
                    object: Some(k),
                    frame: frame.clone(),
                };
                let values = self.db.by_expressions(&now, &within).ok();
                values.map(|values| Fixed {
                    values,
                    frame,
                    is_whole: now.is_whole(),
                })
            }
        };
        self.db.poses.borrow_mut().clear();
        if name == "ground_part" {
            self.db.objects[k].is_ground |= self.is_true(argument);
        }
        // `no_vx = true` takes away what has been given
        if let Some(other) = name.strip_prefix("no_")
            && self.is_true(argument)
        {
            self.db.objects[k].attributes.remove(other);
        }
        // of one value in several forms the last counts
        if name.ends_with("_value") {
            let all = &mut self.db.objects[k].attributes;
            all.retain(|other, _| !other.ends_with("_value") || *other == name);
        }
        self.db.objects[k].attributes.insert(name, now);
    }
}

/// Returns the kind of object that a command makes: the three commands of a part make one.
fn kind_of(row: &'static Row) -> &'static str {
    match row.kind.as_str() {
        kind if kind.starts_with(super::PART) => super::PART,
        kind if kind.starts_with(super::POINT_MASS) => super::POINT_MASS,
        kind => kind,
    }
}
