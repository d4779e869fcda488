//! MOTIONs: which coordinate of the forest each drives, or which row it is, and what their
//! functions may read.

use super::asker::Asker;
use super::build::Builder;
use super::compile::Compiler;
use super::reads::{Allowed, offence};
use super::unknown::{MotionState, UnknownId};
use super::{ConstraintElement, Row, RowKind, SceneMotion, Source};
use crate::diagnostic::Diagnostic;
use crate::model::{Driven, ElementId, ElementKind, Formula as ModelFormula, Joint, Level};
use crate::physics::joint::Displacements;
use crate::physics::row::Law;

/// The joint, or the law between markers, that a motion drives.
pub(super) struct Drive {
    motion: usize,
    pub(super) joint: Option<u32>,
    law: Law,
    markers: (u32, u32),
    id: ElementId,
}

impl Builder<'_> {
    /// Adds all MOTIONs with their states; returns those that drive something, resolved.
    pub(super) fn motions(&mut self, c: &mut Compiler) -> Vec<Drive> {
        let model = self.model;
        let mut drives = Vec::new();
        for (id, motion) in model.active(ElementKind::Motion, &model.motions) {
            let element = ElementKind::Motion.id(id);
            let owner = Asker::argument(element, "FUNCTION");
            // a closure yields the value and its first two derivatives
            let formula = match &motion.function {
                user @ ModelFormula::User { .. } => self.user(c, &owner, user, 3, &[])[0],
                text @ ModelFormula::Expression { .. } => self.formula(c, &owner, text),
            };
            let m = self.scene.motions.len();
            let states: &[MotionState] = match motion.level {
                Level::Displacement => &[],
                Level::Velocity => &[MotionState::Displacement],
                Level::Acceleration => &[MotionState::Displacement, MotionState::Velocity],
            };
            let add = |&state| {
                self.add_state(UnknownId::Motion {
                    motion: element,
                    state,
                })
            };
            let places: Vec<usize> = states.iter().map(add).collect();
            self.scene.motions.push(SceneMotion {
                id,
                level: motion.level,
                formula,
                state: places.first().copied(),
                coordinate: None,
                held: false,
                beside: None,
            });
            drives.extend(self.drive(c, element, m, motion.driven));
        }
        drives
    }

    /// Resolves what motion `m` drives; an error is told where it can drive nothing there.
    fn drive(&self, c: &mut Compiler, id: ElementId, m: usize, driven: Driven) -> Option<Drive> {
        let joints = &self.model.joints;
        let (joint, turn) = match driven {
            Driven::JointTranslation(j) => (j, false),
            Driven::JointRotation(j) => (j, true),
            Driven::Joint(j) => {
                let turns = |j: &Joint| j.kind.displacements() == Displacements::Rotation;
                (j, joints.get(&j).is_some_and(turns))
            }
            Driven::Markers { i, j, component } => {
                let law = match component {
                    0..=2 => Law::Along(component),
                    _ => Law::BodyAngle {
                        angle: component - 3,
                        beside: None,
                    },
                };
                return Some(Drive {
                    motion: m,
                    joint: None,
                    law,
                    markers: (i, j),
                    id,
                });
            }
        };
        let name = ElementKind::Joint.id(joint);
        let Some(found) = joints.get(&joint) else {
            c.error(id, format!("{name} does not exist"));
            return None;
        };
        let has = found.kind.displacements();
        let allowed = if turn { has.turns() } else { has.slides() };
        if !allowed {
            let what = if turn { "rotation" } else { "translation" };
            c.error(id, format!("{name} has no {what} to drive: a motion needs a revolute, translational or cylindrical joint"));
            return None;
        }
        if c.driven.insert((joint, turn), m).is_some() {
            c.error(id, format!("{name} is driven twice"));
        }
        Some(Drive {
            motion: m,
            joint: Some(joint),
            law: if turn { Law::Angle } else { Law::Along(2) },
            markers: (found.i, found.j),
            id,
        })
    }

    /// Adds a row for each motion that no coordinate took.
    pub(super) fn driven_rows(&mut self, c: &mut Compiler, drives: &[Drive]) {
        for (k, coordinate) in c.coordinates.iter().enumerate() {
            if let Source::Driven(m) = coordinate.source {
                self.scene.motions[m].coordinate = Some(k);
            }
        }
        for drive in drives {
            let law = self.read_off(drives, drive);
            let id = self.scene.motions[drive.motion].id;
            let coordinate = self.scene.motions[drive.motion].coordinate;
            let begins = self.model.motions.get(&id).and_then(|m| m.ic_displacement);
            let motion = &mut self.scene.motions[drive.motion];
            motion.held = coordinate.is_none() && motion.state.is_some() && begins.is_none();
            let first = c.rows.len();
            let (i, j) = (
                c.marker(drive.markers.0, drive.id),
                c.marker(drive.markers.1, drive.id),
            );
            if let (None, Some(i), Some(j)) = (coordinate, i, j) {
                let kind = RowKind::Markers {
                    law,
                    i,
                    j,
                    motion: Some(drive.motion),
                };
                c.rows.push(Row {
                    element: drive.id,
                    equation: law.name(),
                    kind,
                });
            }
            let rows = first..c.rows.len();
            let markers = i.zip(j);
            c.constraints.push(ConstraintElement {
                id: drive.id,
                markers,
                acts_on: markers.iter().map(|m| m.0).collect(),
                joins: Vec::new(),
                about: markers.map(|m| m.0),
                carries: None,
                laws: &[],
                rows,
                coordinate,
            });
        }
    }

    /// Returns the law of a motion; a body angle is read off with another one between the same
    /// markers that is driven too, where that is less singular.
    fn read_off(&mut self, drives: &[Drive], drive: &Drive) -> Law {
        let Law::BodyAngle { angle, .. } = drive.law else {
            return drive.law;
        };
        let driven = |wanted: usize| {
            let mut all = drives.iter().filter(|d| d.markers == drive.markers);
            let found =
                all.find(|d| matches!(d.law, Law::BodyAngle { angle, .. } if angle == wanted));
            found.map(|d| (wanted, d.motion))
        };
        let beside = match angle {
            0 if driven(1).is_none() => driven(2),
            1 => driven(0).or_else(|| driven(2)),
            2 => driven(0).filter(|_| driven(1).is_some()),
            _ => None,
        };
        self.scene.motions[drive.motion].beside = beside.map(|(_, motion)| motion);
        Law::BodyAngle {
            angle,
            beside: beside.map(|(angle, _)| angle),
        }
    }

    /// Refuses motions whose functions read more than time and what depends on time alone.
    pub(super) fn timed(&mut self, c: &mut Compiler) {
        for motion in &self.scene.motions {
            // a closure tells the derivatives itself
            if self.scene.computed(motion.formula).is_some() {
                continue;
            }
            if let Some(offence) = offence(&self.scene, motion.formula, Allowed::Time) {
                let what = offence.rest(self.model);
                c.errors.push(
                    Diagnostic::error("motion_reads", what)
                        .element(ElementKind::Motion.id(motion.id))
                        .help("a MOTION is prescribed by TIME and states that depend on nothing else; relate places to each other by a COUPLER or GCON, react to what happens by a force"),
                );
            }
        }
    }
}
