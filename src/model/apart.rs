//! Models of the groups of elements that have nothing to do with each other.
//!
//! An element has to do with those that it names, by numbers or in functions. What only stands
//! there for others to read (ground and its markers, data, VARIABLEs of constants and time)
//! connects nothing: each group has what it reads of that.

use super::check::references::named;
use super::{ElementId, ElementKind, Family, Formula, Model};
use crate::numeric::connected::connected;
use std::collections::{BTreeMap, BTreeSet};

/// Elements by their places, and what each names.
struct Names {
    ids: Vec<ElementId>,
    /// places of the elements that each names
    named: Vec<Vec<usize>>,
    /// whether an element connects nothing
    is_shared: Vec<bool>,
}

impl Model {
    /// Returns a model of each group of elements that move or have states and have nothing to do
    /// with the others, without results that are asked for; `None`: there are fewer than two, or
    /// something that speaks of all, as a SENSOR does.
    pub(crate) fn apart(&self) -> Option<Vec<Model>> {
        let names = Names::of(self)?;
        let rows: Vec<_> = (0..names.ids.len())
            .filter(|&k| names.connects(self, k))
            .map(|k| {
                let others = names.named[k].iter().copied();
                let others = others.filter(|&other| !names.is_shared[other]);
                std::iter::once(k).chain(others).map(|k| (k, 1.0)).collect()
            })
            .collect();
        let groups = connected(&rows, names.ids.len());
        let moving = groups.iter().filter(|group| {
            let mut ids = group.columns.iter().map(|&k| names.ids[k]);
            ids.any(|id| self.is_active(id) && is_of_unknowns(id.kind))
        });
        let moving: Vec<_> = moving.collect();
        if moving.len() < 2 {
            return None;
        }
        let bare = self.without_elements();
        let model = |columns: &[usize]| {
            let mut model = bare.clone();
            for id in names.with_shared(columns) {
                model.take_over(id, self);
            }
            model
        };
        Some(moving.iter().map(|group| model(&group.columns)).collect())
    }

    /// Returns the model with its settings and no element.
    fn without_elements(&self) -> Model {
        Model {
            title: self.title.clone(),
            units: self.units.clone(),
            gravity: self.gravity,
            integrator: self.integrator.clone(),
            equilibrium: self.equilibrium.clone(),
            kinematics: self.kinematics.clone(),
            initial_conditions: self.initial_conditions.clone(),
            inactive: self.inactive.clone(),
            ..Model::default()
        }
    }
}

/// Returns whether elements of a kind have places, velocities or states.
fn is_of_unknowns(kind: ElementKind) -> bool {
    use ElementKind as K;
    matches!(
        kind,
        K::Part | K::PointMass | K::Diff | K::Lse | K::Tfsiso | K::Gse | K::Motion
    )
}

impl Names {
    /// Looks at all elements; `None`: some speak of all.
    fn of(model: &Model) -> Option<Self> {
        let elements = model.elements();
        let ids: Vec<ElementId> = elements.iter().map(|(id, _)| *id).collect();
        let places: BTreeMap<ElementId, usize> =
            ids.iter().enumerate().map(|(k, id)| (*id, k)).collect();
        let mut named_by = Vec::with_capacity(ids.len());
        for (id, element) in &elements {
            let active = model.is_active(*id);
            if active && (id.kind == ElementKind::Sensor || !id.kind.is_solved()) {
                return None;
            }
            let mut targets: Vec<ElementId> = element.references().iter().map(|r| r.1).collect();
            let functions = match id.kind.family() {
                Family::Output => Vec::new(),
                _ => element.formulas(),
            };
            for (_, formula) in functions {
                match formula {
                    Formula::Expression { text, .. } => {
                        let ast = text.sound_ast().ok()?;
                        targets.extend(named(ast).into_iter().map(|(_, target)| target));
                    }
                    Formula::User { .. } if active => return None,
                    Formula::User { .. } => {}
                }
            }
            let mut found: Vec<usize> = targets
                .iter()
                .filter_map(|target| places.get(target).copied())
                .collect();
            found.sort_unstable();
            found.dedup();
            named_by.push(found);
        }
        let mut names = Self {
            is_shared: Vec::new(),
            ids,
            named: named_by,
        };
        names.is_shared = names.shared(model);
        Some(names)
    }

    /// Returns which elements connect nothing: ground, data, and what reads nothing else.
    fn shared(&self, model: &Model) -> Vec<bool> {
        let mut is_shared: Vec<bool> = (self.ids.iter())
            .map(|id| match id.kind {
                ElementKind::Part => model.parts[&id.number].ground,
                ElementKind::Array => false,
                kind => kind.family() == Family::Data,
            })
            .collect();
        // what reads such elements alone, as far as that goes
        let may_be = |kind| {
            use ElementKind as K;
            matches!(kind, K::Marker | K::Variable | K::Graphics | K::Array)
        };
        loop {
            let more: Vec<usize> = (0..self.ids.len())
                .filter(|&k| !is_shared[k] && may_be(self.ids[k].kind))
                .filter(|&k| self.named[k].iter().all(|&other| is_shared[other]))
                .collect();
            if more.is_empty() {
                return is_shared;
            }
            more.into_iter().for_each(|k| is_shared[k] = true);
        }
    }

    /// Returns whether an element connects what it names.
    fn connects(&self, model: &Model, k: usize) -> bool {
        let id = self.ids[k];
        let is_asked = id.kind.family() == Family::Output && id.kind != ElementKind::Graphics;
        !is_asked && !self.is_shared[k] && model.is_active(id)
    }

    /// Returns elements with the shared ones that they read.
    fn with_shared(&self, columns: &[usize]) -> Vec<ElementId> {
        let mut all: BTreeSet<usize> = columns.iter().copied().collect();
        let mut open = columns.to_vec();
        while let Some(k) = open.pop() {
            for &other in &self.named[k] {
                if self.is_shared[other] && all.insert(other) {
                    open.push(other);
                }
            }
        }
        all.into_iter().map(|k| self.ids[k]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model(text: &str) -> Model {
        let start = "t\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\nPART/1, GROUND\n\
                     MARKER/1, PART=1\nVARIABLE/7, FUNCTION=1E3\n";
        let pendulum = |k: u32| {
            format!(
                "PART/{p}, MASS=1, CM={m}, IP=1,1,1\nMARKER/{m}, PART={p}, QP=1,0,0\n\
                 MARKER/{o}, PART={p}\nJOINT/{k}, REVOLUTE, I={o}, J=1\n\
                 SFORCE/{k}, I={m}, J=1, TRANSLATION, FUNCTION=VARVAL(7)*DM({m},1)\n",
                p = 10 + k,
                m = 100 + k,
                o = 200 + k
            )
        };
        let pendulums: String = (1..=3).map(pendulum).collect();
        let text = format!("{start}{pendulums}{text}END\n");
        Model::from_text(&text).expect("a model")
    }

    fn parts(models: &[Model]) -> Vec<Vec<u32>> {
        let moving = |m: &Model| m.parts.keys().copied().filter(|p| *p > 1).collect();
        models.iter().map(moving).collect()
    }

    #[test]
    fn ground_and_constants_connect_nothing_and_every_group_has_them() {
        let apart = model("").apart().expect("three pendulums");
        assert_eq!(parts(&apart), [[11], [12], [13]]);
        for (k, model) in (1..).zip(&apart) {
            assert!(model.parts[&1].ground && model.has(ElementKind::Marker.id(1)));
            assert!(model.has(ElementKind::Variable.id(7)));
            assert_eq!(model.numbers(ElementKind::Joint), [k]);
            assert_eq!(model.numbers(ElementKind::Sforce), [k]);
        }
    }

    #[test]
    fn whatever_reads_two_mechanisms_connects_them() {
        for text in [
            "SPRINGDAMPER/1, I=101, J=102, TRANSLATION, K=1, LENGTH=1\n",
            "COUPLER/1, JOINTS=1,2, TYPE=R:R, SCALES=1,1\n",
            "VARIABLE/8, FUNCTION=DX(101)\nSFORCE/9, I=102, J=1, TRANSLATION, FUNCTION=VARVAL(8)\n",
            "SFORCE/9, I=102, J=1, TRANSLATION, FUNCTION=IF(AZ(201,1): 0, 0, 1)\n",
            "DIFF/1, FUNCTION=DX(101)-DIF(1), IC=0\nSFORCE/9, I=102, J=1, TRANSLATION, \
             FUNCTION=DIF(1)\n",
        ] {
            let apart = model(text).apart().expect("two groups");
            assert_eq!(parts(&apart), [vec![11, 12], vec![13]], "{text}");
        }
    }

    #[test]
    fn results_that_are_asked_for_connect_nothing_and_sensors_speak_of_all() {
        let asked = "REQUEST/1, DISPLACEMENT, I=101, J=102\n";
        assert_eq!(model(asked).apart().map(|apart| apart.len()), Some(3));
        let sensor = "SENSOR/1, FUNCTION=DX(101), VALUE=2, GE, HALT, ERROR=1E-3\n";
        assert!(model(sensor).apart().is_none());
        let user = "SFORCE/9, I=101, J=1, TRANSLATION, FUNCTION=USER(1)\n";
        assert!(model(user).apart().is_none());
    }
}
