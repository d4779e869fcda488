//! SAVE and RELOAD: where a session stands, as a text that reads back exactly.
//!
//! The text is JSON: the model as the commands have left it (a dataset), what is switched off, and
//! the state of the last simulation. Numbers stand in quotes, as the shortest decimals that name
//! them, so that each comes back with every bit whatever program has passed the file on.

use super::Session;
use super::carried::Carried;
use crate::analysis::system::past::Past;
use crate::analysis::system::samples::Held;
use crate::analysis::trajectory::Left;
use crate::dataset;
use crate::diagnostic::{Diagnostic, Error, Severity};
use crate::model::{ElementId, ElementKind, Model};
use crate::numeric::Memory;
use crate::scene::history::{AngleId, DelayId};
use crate::scene::layout::Layout;
use crate::scene::unknown::{CoordinateId, MotionState, UnknownId};
use crate::space::{MarkerState, Mat3, Vec3};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::str::FromStr;
use std::sync::Arc;

/// The mark of these files, with the number of their form.
const MARK: &str = "cognate_state";
const VERSION: u64 = 1;

/// Returns the name of the file for a name that SAVE or RELOAD gives, without the folder that it
/// may have on another machine: its own ending, or `.state.json`.
pub fn file_name(name: &str) -> String {
    let name = name.trim().trim_matches('"');
    let file = match name.rsplit(['/', '\\']).next().unwrap_or_default() {
        "" | "." | ".." => "saved".to_owned(),
        file => file.to_owned(),
    };
    if std::path::Path::new(&file).extension().is_some() {
        file
    } else {
        format!("{file}.state.json")
    }
}

/// A state: the model, and where its session stands.
#[derive(Clone, Debug)]
pub struct Saved {
    pub(super) model: Model,
    pub(super) carried: Option<Carried>,
}

impl Saved {
    /// Reads the bytes of a file.
    ///
    /// # Errors
    /// Bytes that are no state: also the binary files that Adams saves.
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        let text = std::str::from_utf8(bytes).ok();
        let value: Option<Value> = text.and_then(|t| serde_json::from_str(t).ok());
        let Some(value) = value.filter(|v| v.get(MARK).is_some()) else {
            let d = Diagnostic::error("not_a_state", "the text is no state that cognate has saved");
            return Err(d.help("what Adams saves is an image of its memory, whose layout is nowhere described: obey the commands that led there, and SAVE here")
                .into());
        };
        let wrong =
            |what: &str| Diagnostic::error("not_a_state", format!("its {what} cannot be read"));
        if value[MARK].as_u64() != Some(VERSION) {
            let what = format!(
                "is a state of form {}, this program reads form {VERSION}",
                value[MARK]
            );
            return Err(Diagnostic::error("not_a_state", what).into());
        }
        let text = value["model"].as_str().ok_or_else(|| wrong("model"))?;
        let reading = dataset::read_text(text);
        if let Some(d) = reading
            .diagnostics
            .into_iter()
            .find(|d| d.severity == Severity::Error)
        {
            return Err(d.into());
        }
        let mut model = reading.model;
        for pair in value["inactive"].as_array().into_iter().flatten() {
            let number = pair[1].as_u64().and_then(|id| u32::try_from(id).ok());
            let kind = pair[0].as_str().and_then(|k| ElementKind::from_str(k).ok());
            let (Some(kind), Some(number)) = (kind, number) else {
                return Err(wrong("inactive elements").into());
            };
            model.inactive.insert(kind.id(number));
        }
        let mut carried = match &value["state"] {
            Value::Null => None,
            state => Some(carried(state).ok_or_else(|| wrong("state"))?),
        };
        if let (Some(carried), Some(left)) = (&mut carried, left(&value["left"])) {
            carried.left = Some((Arc::new(model.clone()), left));
        }
        Ok(Self { model, carried })
    }

    /// Returns the model.
    pub fn model(&self) -> &Model {
        &self.model
    }
}

impl Session {
    /// Writes the state of the session as a text.
    pub fn save(&self) -> String {
        let inactive: Vec<Value> = (self.model.inactive.iter())
            .map(|id| json!([id.kind.keyword(), id.number]))
            .collect();
        let value = json!({
            MARK: VERSION,
            "title": self.model.title,
            "model": self.model.to_text(),
            "inactive": inactive,
            "state": self.carried.as_ref().map(state),
            "left": self.left_to_save().map(left_as_text),
        });
        format!("{value:#}\n")
    }

    /// Goes on from a state.
    ///
    /// # Errors
    /// When the model of the state asks for other results than those that this run already has.
    pub fn reload(&mut self, saved: Saved) -> Result<(), Error> {
        let Saved { model, carried } = saved;
        // as written, without the places they were read from
        let asked = |model: &Model| {
            let only = Model {
                requests: model.requests.clone(),
                many_requests: model.many_requests.clone(),
                ..Model::default()
            };
            only.to_text()
        };
        let same = asked(&model) == asked(&self.model);
        if self.run.rows() > 0 && !same {
            let d = Diagnostic::error(
                "not_a_state",
                "its model has other requests than the results so far",
            );
            return Err(d.help("a run has one table: reload before the first simulation, or in a command file of its own")
                .into());
        }
        let fresh = self.run.rows() == 0 && !same;
        self.model = model;
        self.carried = carried;
        (self.kept, self.columns_program, self.companion) = (None, None, None);
        (self.halted, self.at_rest_first, self.is_checked) = (false, false, false);
        if fresh {
            self.choose_columns();
        }
        Ok(())
    }
}

// -------------------------------------------------------------------------------------------------------
// numbers in text

fn number(x: f64) -> Value {
    Value::String(format!("{x:?}"))
}

fn numbers(all: &[f64]) -> Value {
    all.iter().map(|&x| number(x)).collect()
}

fn as_number(v: &Value) -> Option<f64> {
    v.as_str()?.parse().ok()
}

fn as_numbers(v: &Value) -> Option<Vec<f64>> {
    v.as_array()?.iter().map(as_number).collect()
}

/// Writes down the method that has left something, and all numbers of its memory.
fn left_as_text((method, memory): &Left) -> Value {
    let lists: Value = memory.numbers().iter().map(|n| numbers(n)).collect();
    json!({ "method": method, "memory": lists })
}

/// Reads it; files without it begin with HINIT.
fn left(v: &Value) -> Option<Left> {
    let lists = v["memory"].as_array()?.iter().map(as_numbers);
    let memory = Memory::of_numbers(lists.collect::<Option<_>>()?)?;
    Some((v["method"].as_str()?.to_string(), Arc::new(memory)))
}

fn state(c: &Carried) -> Value {
    let parts: Vec<Value> = (c.parts.iter())
        .map(|(id, s)| {
            let axes: Vec<f64> = s.R_GM.0.iter().flatten().copied().collect();
            let vectors = [s.p_GM, s.w_GM, s.v_GM, s.alpha_GM, s.a_GM];
            let vectors: Vec<f64> = vectors.iter().flat_map(|v| v.0).collect();
            json!({ "point_mass": id.kind == ElementKind::PointMass, "id": id.number, "axes": numbers(&axes), "vectors": numbers(&vectors) })
        })
        .collect();
    let turns: Map<String, Value> = (c.turns.iter())
        .map(|(id, x)| (id.to_string(), number(*x)))
        .collect();
    let by_number = |values: &BTreeMap<u32, f64>| -> Map<String, Value> {
        let all = values.iter();
        all.map(|(id, x)| (id.to_string(), number(*x))).collect()
    };
    let samples: Map<String, Value> = (c.samples.iter())
        .map(|(id, h)| {
            let held = json!({ "states": numbers(&h.states), "next": numbers(&h.next), "due": number(h.due) });
            (id.to_string(), held)
        })
        .collect();
    let past: Vec<Value> = c
        .past
        .iter()
        .map(|(id, p)| {
            let lists: Value = p.numbers().iter().map(|n| numbers(n)).collect();
            json!({ "owner": id.owner, "expression": id.expression, "past": lists })
        })
        .collect();
    json!({
        "time": number(c.t),
        "names": c.unknowns.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "numbers": numbers(&c.numbers),
        "at_rest": c.at_rest,
        "parts": parts,
        "turns": turns,
        "sensors": by_number(&c.sensors),
        "held": by_number(&c.held),
        "samples": samples,
        "past": past,
    })
}

fn carried(v: &Value) -> Option<Carried> {
    let unknowns = unknowns(&v["names"])?;
    let all = as_numbers(&v["numbers"])?;
    // the row begins with time and the unknowns
    if all.len() <= unknowns.len() {
        return None;
    }
    let parts = v["parts"]
        .as_array()?
        .iter()
        .map(part)
        .collect::<Option<_>>()?;
    let ids = |key: &str| -> Option<Vec<(u32, Value)>> {
        let one = |(id, value): (&String, &Value)| Some((id.parse().ok()?, value.clone()));
        v[key].as_object()?.iter().map(one).collect()
    };
    let by_number = |key: &str| -> Option<BTreeMap<u32, f64>> {
        let all = ids(key)?.into_iter();
        all.map(|(id, x)| Some((id, as_number(&x)?))).collect()
    };
    let samples: Option<BTreeMap<u32, Held>> = (ids("samples")?.iter())
        .map(|(id, h)| {
            let held = Held {
                states: as_numbers(&h["states"])?,
                next: as_numbers(&h["next"])?,
                due: as_number(&h["due"])?,
            };
            Some((*id, held))
        })
        .collect();
    let past = v["past"].as_array()?.iter().map(past);
    Some(Carried {
        t: as_number(&v["time"])?,
        coordinates: free_coordinates(&unknowns, &all),
        numbers: all,
        unknowns,
        at_rest: v["at_rest"].as_bool()?,
        parts,
        turns: turns(&v["turns"])?,
        sensors: by_number("sensors")?,
        // older files say nothing of it
        held: by_number("held").unwrap_or_default(),
        samples: samples?,
        past: past.collect::<Option<_>>()?,
        guesses: BTreeMap::new(),
        left: None,
    })
}

/// Returns value and rate of the coordinates that are unknowns. `numbers`: the time, then theirs.
fn free_coordinates(unknowns: &[UnknownId], numbers: &[f64]) -> BTreeMap<CoordinateId, [f64; 2]> {
    let mut all: BTreeMap<CoordinateId, [f64; 2]> = BTreeMap::new();
    for (unknown, &value) in unknowns.iter().zip(numbers.iter().skip(Layout::STATE)) {
        match *unknown {
            UnknownId::Position(id) => all.entry(id).or_default()[0] = value,
            UnknownId::Velocity(id) => {
                all.entry(id).and_modify(|both| both[1] = value);
            }
            UnknownId::EulerParameter { .. }
            | UnknownId::Motion { .. }
            | UnknownId::Differential(_)
            | UnknownId::ContactPlace { .. } => {}
        }
    }
    all
}

/// Reads the angles with their turns. They once were a list without names, which is of use only
/// where it is empty.
fn turns(v: &Value) -> Option<BTreeMap<AngleId, f64>> {
    match v {
        Value::Array(list) => list.is_empty().then(BTreeMap::new),
        _ => {
            let all = v.as_object()?.iter();
            all.map(|(id, x)| Some((id.parse().ok()?, as_number(x)?)))
                .collect()
        }
    }
}

/// Reads the past of a delayed value.
fn past(v: &Value) -> Option<(DelayId, Past)> {
    let text = |key: &str| v[key].as_str().map(str::to_owned);
    let id = DelayId {
        owner: text("owner")?,
        expression: text("expression")?,
    };
    let lists: Option<Vec<Vec<f64>>> = v["past"].as_array()?.iter().map(as_numbers).collect();
    Some((id, Past::of_numbers(&lists?)?))
}

/// Reads the names of the unknowns. A velocity of a MOTION once had none: it stands after the
/// displacement.
fn unknowns(v: &Value) -> Option<Vec<UnknownId>> {
    let mut all: Vec<UnknownId> = Vec::new();
    for name in v.as_array()? {
        let unknown = match (name.as_str()?, all.last()) {
            (
                "",
                Some(&UnknownId::Motion {
                    motion,
                    state: MotionState::Displacement,
                }),
            ) => UnknownId::Motion {
                motion,
                state: MotionState::Velocity,
            },
            (name, _) => name.parse().ok()?,
        };
        all.push(unknown);
    }
    Some(all)
}

fn part(v: &Value) -> Option<(ElementId, MarkerState<f64>)> {
    let axes: [f64; 9] = as_numbers(&v["axes"])?.try_into().ok()?;
    let vectors: [f64; 15] = as_numbers(&v["vectors"])?.try_into().ok()?;
    let vector = |k: usize| Vec3([vectors[3 * k], vectors[3 * k + 1], vectors[3 * k + 2]]);
    let row = |k: usize| [axes[3 * k], axes[3 * k + 1], axes[3 * k + 2]];
    let state = MarkerState {
        R_GM: Mat3([row(0), row(1), row(2)]),
        p_GM: vector(0),
        w_GM: vector(1),
        v_GM: vector(2),
        alpha_GM: vector(3),
        a_GM: vector(4),
    };
    let kind = if v["point_mass"].as_bool()? {
        ElementKind::PointMass
    } else {
        ElementKind::Part
    };
    Some((kind.id(u32::try_from(v["id"].as_u64()?).ok()?), state))
}
