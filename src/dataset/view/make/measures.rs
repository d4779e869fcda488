//! Measures, which become variables that functions may read.
//!
//! ```text
//! of a joint with markers I, J: from_first = yes → f(J, I), no → f(I, J)
//! angles and angular rates carry RTOD in a file of degrees
//! ```

use super::{Maker, Want};
use crate::diagnostic::{Diagnostic, Severity};
use crate::model::ElementKind;

impl Maker<'_> {
    pub(super) fn make_measures(&mut self) {
        let mut unread = Vec::new();
        for k in self.db.of_kind("measure").collect::<Vec<_>>() {
            let Some(mut draft) = self.draft(k) else {
                continue;
            };
            let given = match self.db.objects[k].kind {
                "measure function" => {
                    self.must_have_function(&mut draft, k, "function", "FUNCTION");
                    true
                }
                kind => match self.measured(k, kind) {
                    Ok(Some(text)) => {
                        let head = self.db.objects[k].head;
                        let formula = self.formula(text, &[(0, head.start)]);
                        draft.give("FUNCTION", Want::Formula(formula), head);
                        true
                    }
                    Ok(None) => false,
                    Err(trouble) => {
                        self.db.trouble(Some(k), self.db.objects[k].head, &trouble);
                        false
                    }
                },
            };
            match given {
                true => self.push(draft),
                false => unread.push(k),
            }
        }
        if let Some(&first) = unread.first() {
            let names: Vec<String> = unread.iter().map(|k| self.db.inner_name(*k)).collect();
            let what = format!(
                "measures that are computed behind the run are not read: {}",
                names.join(", ")
            );
            let d = Diagnostic {
                severity: Severity::Note,
                ..Diagnostic::warning("view_left_out", what)
            };
            self.say(first, "", d);
        }
    }

    /// Returns the function of a measure; `None` for kinds that only View computes.
    fn measured(&self, k: usize, kind: &str) -> Result<Option<String>, String> {
        let characteristic = self.db.choice(k, "characteristic").unwrap_or_default();
        let component = self.component(k);
        let frame = match self.db.given(k, "coordinate_rframe") {
            Some(_) => self.marker(k, "coordinate_rframe")?,
            None => 0,
        };
        Ok(match kind {
            "measure pt2pt" => {
                let from = self.marker(k, "from_point")?;
                let to = self.marker(k, "to_point")?;
                vector(&characteristic, component, &format!("{to},{from}"), frame)
            }
            "measure point" => {
                let at = self.marker(k, "point")?;
                vector(&characteristic, component, &format!("{at},0"), frame)
            }
            "measure angle" => {
                let points = ["first_point", "middle_point", "last_point"];
                let [first, middle, last] = points.map(|point| self.marker(k, point));
                Some(self.degrees(format!("INCANG({},{},{})", first?, middle?, last?)))
            }
            "measure orient" => self.orientation(k, &characteristic, component)?,
            "measure object" => self.of_object(k, &characteristic, component, frame)?,
            _ => None,
        })
    }

    /// Returns the component as 0 (magnitude), 1, 2, 3.
    fn component(&self, k: usize) -> usize {
        let word = self.db.choice(k, "component").unwrap_or_default();
        match word.as_str() {
            w if w.starts_with('x') || w.starts_with("angle_1") => 1,
            w if w.starts_with('y') || w.starts_with("angle_2") => 2,
            w if w.starts_with('z') || w.starts_with("angle_3") => 3,
            _ => 0,
        }
    }

    fn marker(&self, k: usize, argument: &str) -> Result<u32, String> {
        let object = self.db.reference_of(k, argument);
        let object = object.ok_or_else(|| format!("{argument} names no marker"))?;
        let id = self
            .ids
            .get(&object)
            .filter(|id| id.kind == ElementKind::Marker);
        let name = self.db.inner_name(object);
        id.map(|id| id.number)
            .ok_or_else(|| format!("{name} is no marker of the model"))
    }

    /// Returns a factor for angles in a file of degrees.
    fn degrees(&self, text: String) -> String {
        match self.db.units.in_degrees() {
            true => format!("RTOD*{text}"),
            false => text,
        }
    }

    fn orientation(&self, k: usize, of: &str, component: usize) -> Result<Option<String>, String> {
        let to = self.marker(k, "to_frame")?;
        let from = match self.db.given(k, "from_frame") {
            Some(_) => self.marker(k, "from_frame")?,
            None => 0,
        };
        let names = match of {
            _ if of.starts_with("yaw") => ["YAW", "PITCH", "ROLL"],
            _ if of.starts_with("ax_ay_az") => ["AX", "AY", "AZ"],
            "body313" | "psi_theta_phi" | "euler_angles" => ["PSI", "THETA", "PHI"],
            _ => return Ok(None),
        };
        let name = component.checked_sub(1).and_then(|k| names.get(k));
        Ok(name.map(|name| self.degrees(format!("{name}({to},{from})"))))
    }

    fn of_object(
        &self,
        k: usize,
        of: &str,
        component: usize,
        frame: u32,
    ) -> Result<Option<String>, String> {
        let object = self
            .db
            .reference_of(k, "object")
            .ok_or("it names no object")?;
        let id = *self
            .ids
            .get(&object)
            .ok_or("its object is not part of the model")?;
        let first = self.db.is_on(k, "from_first").unwrap_or(true);
        if matches!(id.kind, ElementKind::Part | ElementKind::PointMass) {
            let cm = self.db.reference_of(object, "center_of_mass_marker");
            let cm = cm.and_then(|cm| self.ids.get(&cm)).map(|id| id.number);
            let Some(cm) = cm else {
                return Err("its part has no marker at the centre of mass".into());
            };
            let Some(of) = of.strip_prefix("cm_") else {
                return Ok(None);
            };
            let text = vector(of, component, &format!("{cm},0"), frame);
            return Ok(text.map(|text| match of.starts_with("angular") {
                true => self.degrees(text),
                false => text,
            }));
        }
        if let Some(load) = of.strip_prefix("element_") {
            let name = match id.kind {
                ElementKind::SpringDamper => "SPDP",
                kind => kind.keyword(),
            };
            let place = match (load, component) {
                ("force", 0) => 1,
                ("force", c) => 1 + c,
                ("torque", 0) => 5,
                ("torque", c) => 5 + c,
                _ => return Ok(None),
            };
            let side = u32::from(!first);
            return Ok(Some(format!(
                "{name}({},{side},{place},{frame})",
                id.number
            )));
        }
        let side = |argument: &str| {
            let marker = self.db.reference_of(object, argument)?;
            self.ids.get(&marker).map(|id| id.number)
        };
        let (Some(i), Some(j)) = (side("i_marker_name"), side("j_marker_name")) else {
            return Ok(None);
        };
        let (to, from) = if first { (j, i) } else { (i, j) };
        if of.starts_with("ax_ay_az") {
            let name = component
                .checked_sub(1)
                .and_then(|c| ["AX", "AY", "AZ"].get(c));
            return Ok(name.map(|name| self.degrees(format!("{name}({to},{from})"))));
        }
        let text = vector(of, component, &format!("{to},{from}"), frame);
        Ok(text.map(|text| match of.starts_with("angular") {
            true => self.degrees(text),
            false => text,
        }))
    }
}

/// Returns the function of a vector between two markers, resolved in a frame.
fn vector(of: &str, component: usize, between: &str, frame: u32) -> Option<String> {
    let name = match of {
        "translational_displacement" | "position" | "displacement" => "D",
        "translational_velocity" | "velocity" => "V",
        "translational_acceleration" | "acceleration" => "ACC",
        "angular_velocity" => "W",
        "angular_acceleration" => "WDT",
        _ => return None,
    };
    let letter = ["M", "X", "Y", "Z"].get(component)?;
    Some(match component {
        0 => format!("{name}{letter}({between})"),
        _ => format!("{name}{letter}({between},{frame})"),
    })
}
