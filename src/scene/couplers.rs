//! COUPLER, GEAR, SCREW and RACKPIN as rows between displacements, over coordinates wherever
//! `coordinate_sums.rs` finds that to be the same.

use super::build::Builder;
use super::compile::Compiler;
use super::configuration::Configuration;
use super::coordinate_sums::{Draws, displacement};
use super::coupled::Coupled;
use super::equations::Equations;
use super::external_inputs::{HookKind, closure_for};
use super::{ConstraintElement, Displacement, JointVariable, Row, RowKind, Sum};
use crate::diagnostic::{Cause, Diagnostic};
use crate::model::{ElementId, ElementKind, Formula, Joint, MarkerOwner};
use crate::physics::coupler::{Gauge, GearedJoint, gear_factors};
use crate::physics::joint::{Displacements, Relation, Tie, Unclear};
use crate::space::{Frame, Mat3, Vec3};
use std::f64::consts::TAU;

/// One of the two bodies of a GEAR.
struct GearBody {
    /// markers of its joint
    i: usize,
    j: usize,
    /// velocity along z of CV per rate of each of [`GearBody::GAUGES`]
    factors: [f64; 2],
}

impl GearBody {
    /// The variables of a joint that carries a gear.
    const GAUGES: [Gauge; 2] = [Gauge::Angle(2), Gauge::Distance];
}

impl Builder<'_> {
    /// Rows for all equations between displacements.
    pub(super) fn couplers(&mut self, c: &mut Compiler, strict: bool) {
        let model = self.model;
        let draws = &Draws::default();
        for (id, joint) in model.active(ElementKind::Joint, &model.joints) {
            if let Some(relation) = Tie::Joint(joint.kind).relation() {
                self.single((c, draws), id, joint, relation, strict);
            }
        }
        for (id, coupler) in model.active(ElementKind::Coupler, &model.couplers) {
            let name = ElementKind::Coupler.id(id);
            let joints = coupler.joints.iter().zip(&coupler.rotational);
            let displacements: Option<Vec<Displacement>> = joints
                .map(|(&joint, &turn)| self.joint_displacement((c, draws), name, joint, turn))
                .collect();
            let Some(displacements) = displacements else {
                continue;
            };
            let receiver = displacements.first().map(|d| d.i);
            let sum = match &coupler.user {
                None => Sum {
                    terms: coupler.scales.iter().copied().zip(displacements).collect(),
                    constant: 0.0,
                    held: !strict,
                    contact: None,
                    coupled: None,
                },
                Some(user) => match self.coupled(c, name, user, displacements) {
                    Some(sum) => sum,
                    None => continue,
                },
            };
            self.relation(name, None, receiver, receiver, sum);
        }
        for (id, gear) in model.active(ElementKind::Gear, &model.gears) {
            self.gear((c, draws), id, gear.joints, gear.cv);
        }
    }

    /// The constraint of a COUPLER that a closure computes; `None`: nothing does, which is said.
    fn coupled(
        &mut self,
        c: &mut Compiler,
        name: ElementId,
        user: &Formula,
        displacements: Vec<Displacement>,
    ) -> Option<Sum> {
        let Some(closure) = closure_for(self.hooks, name, user) else {
            c.error(name, "FUNCTION=USER needs a routine that is not part of the dataset: load the library that has it (--routines), give SCALES, or write the relation as a GCON");
            return None;
        };
        let hook = &self.hooks[closure];
        if let Some(input) = hook.inputs.first() {
            let what = format!("its routine reads {input}: it depends on its displacements alone");
            c.errors
                .push(Diagnostic::error(Cause::UserRoutine, what).element(name));
            return None;
        }
        let one = |d: &Displacement| match d.gauge.is_angle() {
            true => 1.0,
            false => self.scene.length.max(f64::MIN_POSITIVE),
        };
        let mut coupled = Coupled {
            element: name,
            constants: user.user_numbers().to_vec(),
            units: displacements.iter().map(one).collect(),
            displacements: displacements.clone(),
            places: 0..0,
            scale: 1.0,
            law: hook.law.clone(),
        };
        let kind = HookKind::Coupled(Box::new(coupled.clone()));
        coupled.places = self.asked_of(kind, name, &coupled.constants, coupled.numbers());
        Some(Sum {
            terms: displacements.into_iter().map(|d| (1.0, d)).collect(),
            constant: 0.0,
            held: false,
            contact: None,
            coupled: Some(Box::new(coupled)),
        })
    }

    /// Compares the partial derivatives that routines of COUPLERs give with differences, where the
    /// dataset has the parts.
    pub(super) fn check_partials(&self, c: &mut Compiler) {
        let scene = &self.scene;
        let all = scene.rows.iter().filter_map(|row| match &row.kind {
            RowKind::Displacements(sum) => sum.coupled.as_deref(),
            _ => None,
        });
        let all: Vec<&Coupled> = all.collect();
        if all.is_empty() {
            return;
        }
        let mut numbers = vec![0.0; scene.layout.len()];
        numbers[scene.layout.q()].copy_from_slice(&scene.initial_q);
        let undecided = Configuration::new(scene);
        let at = Equations::<f64>::new(scene.within(&undecided), &numbers);
        for coupled in all {
            let x = coupled.displacements.iter();
            let x: Vec<f64> = x.map(|d| at.displacement(d).value).chain([0.0]).collect();
            let Some((along, [told, found])) = coupled.contradicted(&x) else {
                continue;
            };
            let along: Vec<String> = along.iter().map(|k| (k + 1).to_string()).collect();
            let what = format!(
                "its routine gives {told:.6} as the partial derivative along displacement {}, differences of its value give {found:.6}",
                along.join(" and ")
            );
            let error = Diagnostic::error(Cause::UserRoutine, what).element(coupled.element);
            c.errors.push(error.help("COUXX has the first and COUXX2 the second partial derivatives of what COUSUB computes; without them they are found by differences"));
        }
    }

    /// Adds the variables of joints, for those who ask to see them.
    pub(super) fn joint_variables(&mut self, c: &mut Compiler) {
        let model = self.model;
        let draws = &Draws::default();
        for (id, joint) in model.active(ElementKind::Joint, &model.joints) {
            let name = ElementKind::Joint.id(id);
            let variables = joint.kind.row().variables;
            if variables.is_empty() {
                continue;
            }
            let (Some(i), Some(j)) = (c.marker(joint.i, name), c.marker(joint.j, name)) else {
                continue;
            };
            for &(name, gauge) in variables {
                let displacement = displacement(&self.scene, draws, gauge, i, j);
                self.scene.joint_variables.push(JointVariable {
                    joint: id,
                    name,
                    displacement,
                });
            }
        }
    }

    /// SCREW and RACKPIN: one equation between the two markers.
    fn single(
        &mut self,
        (c, draws): (&mut Compiler, &Draws),
        id: u32,
        joint: &Joint,
        relation: Relation,
        strict: bool,
    ) {
        let name = ElementKind::Joint.id(id);
        let (Some(i), Some(j)) = (c.marker(joint.i, name), c.marker(joint.j, name)) else {
            return;
        };
        let (argument, per_radian) = match relation {
            Relation::Screw => ("PITCH", joint.pitch.map(|pitch| pitch / TAU)),
            Relation::Rack => ("PD", joint.pd.map(|pd| pd / 2.0)),
        };
        let Some(per_radian) = per_radian else {
            c.error(name, format!("needs {argument}"));
            return;
        };
        let distance = displacement(&self.scene, draws, Gauge::Distance, i, j);
        let angle = displacement(&self.scene, draws, Gauge::Angle(relation.axis()), i, j);
        let sum = Sum {
            terms: vec![(1.0, distance), (-per_radian, angle)],
            constant: 0.0,
            held: !strict,
            contact: None,
            coupled: None,
        };
        self.relation(name, Some((i, j)), Some(i), Some(i), sum);
    }

    /// The displacement of a joint that something refers to; `turn`: its angle or its distance,
    /// where it must be said.
    fn joint_displacement(
        &self,
        (c, draws): (&mut Compiler, &Draws),
        name: ElementId,
        id: u32,
        turn: Option<bool>,
    ) -> Option<Displacement> {
        let joint = active_joint(c, name, id)?;
        let turn = match joint.kind.displacements().chosen(turn) {
            Ok(turn) => turn,
            Err(why) => {
                let joint = ElementKind::Joint.id(id);
                let message = match why {
                    Unclear::Several => format!(
                        "{joint} is cylindrical: TYPE must say whether its rotation (R) or its translation (T) is meant"
                    ),
                    Unclear::Other { turns: true } => {
                        format!("TYPE R does not fit: {joint} has only a translation")
                    }
                    Unclear::Other { turns: false } => {
                        format!("TYPE T does not fit: {joint} has only a rotation")
                    }
                    Unclear::None => format!(
                        "{joint} has no displacement to couple: it must be revolute, translational or cylindrical"
                    ),
                };
                c.error(name, message);
                return None;
            }
        };
        let (i, j) = (c.marker(joint.i, name)?, c.marker(joint.j, name)?);
        let gauge = if turn {
            Gauge::Angle(2)
        } else {
            Gauge::Distance
        };
        Some(displacement(&self.scene, draws, gauge, i, j))
    }

    /// Adds the row of a GEAR, with factors from where CV stands in the carrier.
    fn gear(&mut self, (c, draws): (&mut Compiler, &Draws), id: u32, joints: [u32; 2], cv: u32) {
        let name = ElementKind::Gear.id(id);
        let Some(cv_marker) = c.marker(cv, name) else {
            return;
        };
        let [first, second] = joints;
        let Some(first) = self.gear_body(c, name, first, cv) else {
            return;
        };
        let Some(second) = self.gear_body(c, name, second, cv) else {
            return;
        };
        let mut terms = Vec::new();
        for (body, sign) in [(&first, 1.0), (&second, -1.0)] {
            for (factor, gauge) in body.factors.into_iter().zip(GearBody::GAUGES) {
                if factor != 0.0 {
                    let shown = displacement(&self.scene, draws, gauge, body.i, body.j);
                    terms.push((sign * factor, shown));
                }
            }
        }
        let sum = Sum {
            terms,
            constant: 0.0,
            held: true,
            contact: Some((cv_marker, [first.i, second.i])),
            coupled: None,
        };
        self.relation(name, None, Some(first.i), Some(first.j), sum);
    }

    /// Resolves a geared body by its joint; an error is told where that cannot carry a gear.
    fn gear_body(
        &self,
        c: &mut Compiler,
        name: ElementId,
        joint_id: u32,
        cv: u32,
    ) -> Option<GearBody> {
        let joint = active_joint(c, name, joint_id)?;
        let geared = self.model.called(ElementKind::Joint.id(joint_id));
        let displacements = joint.kind.displacements();
        if displacements == Displacements::None {
            c.error(name, format!("{geared} cannot carry a gear: it must be revolute, translational or cylindrical"));
            return None;
        }
        let (turns, slides) = (displacements.turns(), displacements.slides());
        // the carrier owns CV and the J markers of both joints
        let owner = |m: u32| self.model.markers.get(&m).map(|m| m.owner);
        let carrier = owner(cv);
        if owner(joint.j) != carrier {
            let on = |o: Option<MarkerOwner>| {
                let body = o.and_then(MarkerOwner::body);
                body.map_or_else(|| "no part".into(), |body| self.model.called(body))
            };
            let advice = if owner(joint.i) == carrier {
                format!("exchange I and J of {geared}")
            } else {
                "both joints of a gear must share one carrier, on which CV is fixed".into()
            };
            let what = format!(
                "J of {geared} is on {}, but CV ({}) is on {}: the carrier must own both J markers and CV",
                on(owner(joint.j)),
                self.model.called(ElementKind::Marker.id(cv)),
                on(carrier)
            );
            c.errors.push(
                Diagnostic::error("gear_carrier", what)
                    .element(name)
                    .help(advice),
            );
            return None;
        }
        let (i, j) = (c.marker(joint.i, name)?, c.marker(joint.j, name)?);
        let gear = GearedJoint {
            j: self.in_part(joint.j),
            turns,
            slides,
        };
        let Some(factors) = gear_factors(&gear, &self.in_part(cv)) else {
            let why = if slides {
                "z of CV is square to the direction of translation"
            } else {
                "z of CV is parallel to the axis of rotation or points at it: it must be tangent to the pitch circle"
            };
            let what = format!(
                "{geared} gives CV ({}) no velocity along its z axis: {why}",
                self.model.called(ElementKind::Marker.id(cv))
            );
            c.errors.push(
                Diagnostic::error("gear_line_of_action", what)
                    .element(name)
                    .help(
                        "place CV where the pitch circles touch, with z along the common tangent",
                    ),
            );
            return None;
        };
        Some(GearBody { i, j, factors })
    }

    /// Frame of a marker in its part, as the dataset has it; the reader has checked that there is
    /// one.
    fn in_part(&self, marker: u32) -> Frame<f64> {
        let Some(m) = self.model.markers.get(&marker) else {
            return Frame::identity();
        };
        let rotation = crate::model::geometry::orientation(&m.orientation, m.qp);
        Frame {
            rotation: rotation.unwrap_or_else(|_| Mat3::identity()),
            position: Vec3(m.qp),
        }
    }

    fn relation(
        &mut self,
        id: ElementId,
        markers: Option<(usize, usize)>,
        receiver: Option<usize>,
        about: Option<usize>,
        sum: Sum,
    ) {
        let first = self.scene.rows.len();
        self.scene.rows.push(Row {
            element: id,
            equation: "displacements".into(),
            kind: RowKind::Displacements(sum),
        });
        self.scene.constraints.push(ConstraintElement {
            id,
            markers,
            acts_on: receiver.into_iter().collect(),
            joins: Vec::new(),
            about,
            carries: None,
            laws: &[],
            rows: first..first + 1,
            coordinate: None,
        });
    }
}

/// A joint that is there and switched on; says so when it is not.
fn active_joint<'m>(c: &mut Compiler<'m>, name: ElementId, id: u32) -> Option<&'m Joint> {
    let (joint, coupled) = (c.model.joints.get(&id), ElementKind::Joint.id(id));
    match joint {
        None => c.error(name, format!("{coupled} does not exist")),
        Some(_) if !c.model.is_active(coupled) => {
            c.error(name, format!("{coupled} is switched off"));
            return None;
        }
        _ => {}
    }
    joint
}
