//! COUPLER, GEAR, SCREW and RACKPIN as rows between displacements, over coordinates wherever that
//! is the same.
//!
//! Most displacements are sums of coordinates in every configuration: the variable of a joint of
//! the forest, the angle between two links of a planar mechanism, the travel of a pinion's centre.
//! Such a row has a constant gradient and needs no counted turns. Whether a displacement is one is
//! asked of the scene itself: its gradient along the freedoms of the forest is the same at several
//! configurations drawn at random only if it is the same everywhere, for an analytic function of
//! the coordinates.

use super::build::Builder;
use super::compile::Compiler;
use super::sweep::{self, Coordinates, LinkState};
use super::{
    ConstraintElement, Displacement, JointVariable, LinkMotion, MarkerOnLink, Row, RowKind, Scene,
    Source, Sum,
};
use crate::diagnostic::Diagnostic;
use crate::model::{ElementId, ElementKind, Joint, MarkerOwner};
use crate::physics::coupler::{Gauge, GearedJoint, gear_factors};
use crate::physics::joint::{Displacements, Relation, Tie, Unclear};
use crate::scalar::{Dual, Jet};
use crate::space::{Frame, Mat3, Vec3};
use std::f64::consts::TAU;

/// Gradients that differ by less, as parts of their size, are the same but for rounding.
const SAME_GRADIENT: f64 = 1e-11;

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
        for (id, joint) in model.active(ElementKind::Joint, &model.joints) {
            if let Some(relation) = Tie::Joint(joint.kind).relation() {
                self.single(c, id, joint, relation, strict);
            }
        }
        for (id, coupler) in model.active(ElementKind::Coupler, &model.couplers) {
            let name = ElementKind::Coupler.id(id);
            if coupler.user.is_some() {
                c.error(name, "FUNCTION=USER needs a routine that is not part of the dataset: give SCALES, or write the relation as a GCON");
                continue;
            }
            let joints = coupler.joints.iter().zip(&coupler.rotational);
            let displacements: Option<Vec<Displacement>> = joints
                .map(|(&joint, &turn)| self.joint_displacement(c, name, joint, turn))
                .collect();
            let Some(displacements) = displacements else {
                continue;
            };
            let receiver = displacements.first().map(|d| d.i);
            let sum = Sum {
                terms: coupler.scales.iter().copied().zip(displacements).collect(),
                constant: 0.0,
                held: !strict,
                contact: None,
            };
            self.relation(name, None, receiver, receiver, sum);
        }
        for (id, gear) in model.active(ElementKind::Gear, &model.gears) {
            self.gear(c, id, gear.joints, gear.cv);
        }
    }

    /// Adds the variables of joints, for those who ask to see them.
    pub(super) fn joint_variables(&mut self, c: &mut Compiler) {
        let model = self.model;
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
                let displacement = displacement(&self.scene, gauge, i, j);
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
        c: &mut Compiler,
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
        let distance = displacement(&self.scene, Gauge::Distance, i, j);
        let angle = displacement(&self.scene, Gauge::Angle(relation.axis()), i, j);
        let sum = Sum {
            terms: vec![(1.0, distance), (-per_radian, angle)],
            constant: 0.0,
            held: !strict,
            contact: None,
        };
        self.relation(name, Some((i, j)), Some(i), Some(i), sum);
    }

    /// The displacement of a joint that something refers to; `turn`: its angle or its distance,
    /// where it must be said.
    fn joint_displacement(
        &self,
        c: &mut Compiler,
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
        Some(displacement(&self.scene, gauge, i, j))
    }

    /// Adds the row of a GEAR, with factors from where CV stands in the carrier.
    fn gear(&mut self, c: &mut Compiler, id: u32, joints: [u32; 2], cv: u32) {
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
                    let shown = displacement(&self.scene, gauge, body.i, body.j);
                    terms.push((sign * factor, shown));
                }
            }
        }
        let sum = Sum {
            terms,
            constant: 0.0,
            held: true,
            contact: Some((cv_marker, [first.i, second.i])),
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
        let geared = ElementKind::Joint.id(joint_id);
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
                body.map_or_else(|| "no part".into(), String::from)
            };
            let advice = if owner(joint.i) == carrier {
                format!("exchange I and J of {geared}")
            } else {
                "both joints of a gear must share one carrier, on which CV is fixed".into()
            };
            let what = format!(
                "J of {geared} is on {}, but CV ({}) is on {}: the carrier must own both J markers and CV",
                on(owner(joint.j)),
                ElementKind::Marker.id(cv),
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
                ElementKind::Marker.id(cv)
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
        let rotation = super::compile::orientation(&m.orientation, m.qp);
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
            about,
            carries: None,
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

/// A distance or an angle between two markers, as a sum of coordinates where it is one.
pub(super) fn displacement(scene: &Scene, gauge: Gauge, i: usize, j: usize) -> Displacement {
    Displacement {
        gauge,
        i,
        j,
        coordinates: as_coordinates(scene, gauge, i, j),
    }
}

fn as_coordinates(
    scene: &Scene,
    gauge: Gauge,
    i: usize,
    j: usize,
) -> Option<(Vec<(usize, f64)>, f64)> {
    let zero = Configuration::drawn(scene, 0);
    let (start, terms) = zero.gradient(scene, gauge, i, j);
    // a third of a ball has no coordinate whose value could be summed
    if terms
        .iter()
        .any(|&(k, g)| g.abs() > SAME_GRADIENT && scene.freedoms[k].in_ball)
    {
        return None;
    }
    for seed in 1..4 {
        let other = Configuration::drawn(scene, seed);
        let (value, gradient) = other.gradient(scene, gauge, i, j);
        let mut rest = value - start;
        for (&(k, g), (_, h)) in terms.iter().zip(&gradient) {
            let scale = if scene.freedoms[k].turn && !gauge.is_angle() {
                scene.length
            } else {
                1.0
            };
            let differs = (g - h).abs();
            if differs > SAME_GRADIENT * scale || differs.is_nan() {
                return None;
            }
            rest -= g * other.value(scene, k);
        }
        if gauge.is_angle() {
            rest -= std::f64::consts::TAU * (rest / std::f64::consts::TAU).round();
        }
        if rest.is_nan() || rest.abs() > 100.0 * SAME_GRADIENT * (1.0 + scene.length) {
            return None;
        }
    }
    let clean = |x: f64| {
        let whole = x.round();
        if (x - whole).abs() < 1e-14 { whole } else { x }
    };
    let terms = terms
        .into_iter()
        .map(|(k, g)| (k, clean(g)))
        .filter(|t| t.1.abs() > 1e-13)
        .collect();
    Some((terms, clean(start)))
}

/// Coordinates drawn at random (the same on every run), with the poses of the links there.
struct Configuration {
    q: Vec<f64>,
    driven: Vec<Jet<f64>>,
    links: Vec<LinkState<f64>>,
}

impl Configuration {
    /// `seed` 0: all coordinates zero.
    fn drawn(scene: &Scene, seed: u64) -> Self {
        let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mut draw = || {
            if seed == 0 {
                return 0.0;
            }
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let mut q: Vec<f64> = (0..scene.layout.n_q).map(|_| draw()).collect();
        for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
            if let (Source::Free { q: place, .. }, false) = (c.source, f.turn) {
                q[place] *= scene.length;
            }
        }
        for link in &scene.links {
            if let LinkMotion::Ball { quaternion, .. } = link.motion {
                let part = &mut q[quaternion..quaternion + 4];
                part[0] += 1.0;
                let n = part.iter().map(|x| x * x).sum::<f64>().sqrt();
                part.iter_mut().for_each(|x| *x /= n);
            }
        }
        let driven: Vec<Jet<f64>> = scene
            .motions
            .iter()
            .map(|_| Jet::new(draw(), 0.0, 0.0))
            .collect();
        let v = vec![0.0; scene.layout.n_v];
        let links = sweep::outward(
            scene,
            &Coordinates {
                q: &q,
                v: &v,
                vdot: &[],
                driven: &driven,
            },
        );
        Self { q, driven, links }
    }

    /// Value of a coordinate.
    fn value(&self, scene: &Scene, c: usize) -> f64 {
        match scene.coordinates[c].source {
            Source::Free { q, .. } if !scene.freedoms[c].in_ball => self.q[q],
            Source::Free { .. } => 0.0,
            Source::Driven(m) => self.driven[m].value,
        }
    }

    /// A displacement, and its derivative along every freedom that moves I or J, in a fixed order.
    fn gradient(
        &self,
        scene: &Scene,
        gauge: Gauge,
        i: usize,
        j: usize,
    ) -> (f64, Vec<(usize, f64)>) {
        let of = |m: usize| sweep::marker_frame(&scene.markers[m], &self.links);
        let value = gauge.value(&of(i), &of(j));
        let (moves_i, moves_j) = (
            carriers(scene, &scene.markers[i]),
            carriers(scene, &scene.markers[j]),
        );
        let mut all: Vec<usize> = moves_i.iter().chain(&moves_j).copied().collect();
        all.sort_unstable();
        all.dedup();
        let gradient = all
            .into_iter()
            .filter(|k| moves_i.contains(k) != moves_j.contains(k))
            .map(|k| {
                let moved = |m: usize, moves: &[usize]| {
                    if moves.contains(&k) {
                        self.displaced(scene, &of(m), k)
                    } else {
                        Frame::constant(of(m))
                    }
                };
                (
                    k,
                    gauge.value(&moved(i, &moves_i), &moved(j, &moves_j)).eps[0],
                )
            })
            .collect();
        (value, gradient)
    }

    /// A frame as it moves along freedom `k`.
    fn displaced(&self, scene: &Scene, frame: &Frame<f64>, k: usize) -> Frame<Dual<1>> {
        let f = &scene.freedoms[k];
        let X = &self.links[f.link].X_GL;
        let e = X.rotation.column(f.axis).times(f.sign);
        let mut moved = Frame::<Dual<1>>::constant(*frame);
        let shift = if f.turn {
            for column in 0..3 {
                let rate = e.cross(frame.rotation.column(column));
                for row in 0..3 {
                    moved.rotation.0[row][column].eps[0] = rate.0[row];
                }
            }
            e.cross(frame.position - X.position)
        } else {
            e
        };
        for row in 0..3 {
            moved.position.0[row].eps[0] = shift.0[row];
        }
        moved
    }
}

/// All freedoms that move a marker.
fn carriers(scene: &Scene, marker: &MarkerOnLink) -> Vec<usize> {
    let mut all = Vec::new();
    let mut next = marker.link.and_then(|l| scene.last_freedom[l]);
    while let Some(k) = next {
        all.push(k);
        next = scene.carrier[k];
    }
    all
}
