//! Misalignments of a dataset, before and after assembly: by how much joints are off, and which
//! parts had to be turned round.

use crate::analysis::direction::Axis;
use crate::analysis::warning::{AssemblyWarning, ConditionWarning};
use crate::model::{ElementId, ElementKind, Model};
use crate::physics::joint::Tie;
use crate::physics::row::Law;
use crate::scene::Scene;
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::space::Vec3;

/// Offsets relative to the size of the mechanism, and angles in rad, that are worth telling: typed
/// numbers with five digits are not.
const WORTH_TELLING: f64 = 1e-5;
/// A part turned by more than this against its dataset, in rad, sits on another branch than was
/// drawn.
const TURNED: f64 = 2.0;

/// All ties of a model that are switched on: name, kind, I and J.
fn ties(model: &Model) -> Vec<(ElementId, Tie, u32, u32)> {
    use ElementKind::{Joint, Jprim};
    let joints = model.active(Joint, &model.joints);
    let joints = joints.map(|(id, j)| (Joint.id(id), Tie::Joint(j.kind), j.i, j.j));
    let primitives = model.active(Jprim, &model.primitives);
    let primitives = primitives.map(|(id, p)| (Jprim.id(id), Tie::Primitive(p.kind), p.i, p.j));
    joints.chain(primitives).collect()
}

/// Joints that do not fit as the dataset places the parts: by how much, and in which direction.
pub fn misaligned(scene: &Scene, model: &Model) -> Vec<AssemblyWarning> {
    let frame = |id: u32| scene.marker_of.get(&id).map(|&m| scene.drawn(m));
    let mut found = Vec::new();
    for (element, tie, i, j) in ties(model) {
        let (Some(I), Some(J)) = (frame(i), frame(j)) else {
            continue;
        };
        let (mut offset, mut turn) = (Vec3::zero(), Vec3::zero());
        for &law in tie.rows() {
            let value = law.value(&I, &J, None);
            match law {
                Law::Offset(k) => offset += Vec3::axis(k).times(value),
                Law::Along(k) => offset += J.rotation.column(k).times(value),
                Law::Dot(a, b) => {
                    let across = I.rotation.column(a).cross(J.rotation.column(b));
                    let sine = across.norm();
                    if sine > 0.0 {
                        turn += across.times(value.clamp(-1.0, 1.0).asin() / sine);
                    }
                }
                _ => {}
            }
        }
        let axes = [(j, J.rotation), (i, I.rotation)];
        let offset = (offset.norm() > WORTH_TELLING * scene.length)
            .then(|| (offset.norm(), Axis::along(offset, &axes)));
        let turn = (turn.norm() > WORTH_TELLING).then(|| (turn.norm(), Axis::along(turn, &axes)));
        if offset.is_some() || turn.is_some() {
            found.push(AssemblyWarning::Misaligned {
                element,
                offset,
                unit: scene.length_unit.clone(),
                turn,
            });
        }
    }
    found
}

/// A joint whose initial condition fits the dataset better with its numbers exchanged.
#[derive(Clone, Debug, PartialEq)]
pub struct Exchanged {
    /// its number
    pub joint: u32,
    /// whether it is the condition of its rotation
    pub turns: bool,
    /// its numbers as they stand
    pub given: [f64; 2],
    /// where the parts stand
    pub stands: f64,
    /// whether it is read so
    pub believed: bool,
}

impl Exchanged {
    /// Makes a warning of it.
    pub fn warning(&self) -> ConditionWarning {
        ConditionWarning::Exchanged {
            element: ElementKind::Joint.id(self.joint),
            given: self.given,
            stands: self.stands,
            believed: self.believed,
        }
    }
}

/// Joints whose initial condition fits the dataset better with its numbers exchanged.
///
/// `IC = displacement, velocity` is how the statement is documented, and how it is read. Adams View
/// writes, and Adams Solver (C++) reads, velocity and displacement: the one model that we have in
/// all three forms has `translational_ic = -146.99, velocity_ic = -0.1815` in its View commands,
/// `IC = -0.1815, -146.99` in the dataset that View wrote of them, and stands at -146.992, moving
/// by -0.2, in the results. Nobody can tell by the numbers alone. But a statement that View wrote
/// carries the name it has there, and its parts stand where View has drawn them: where both speak
/// for it, the numbers are exchanged and that is told; where only the parts do, it is told.
pub fn exchanged(scene: &Scene, model: &Model) -> Vec<Exchanged> {
    let mut found = Vec::new();
    for (&id, joint) in &model.joints {
        let frame = |id: u32| scene.marker_of.get(&id).map(|&m| scene.drawn(m));
        let (Some(I), Some(J)) = (frame(joint.i), frame(joint.j)) else {
            continue;
        };
        let kinds = [
            (Law::Along(2), joint.ic_translation, scene.length, false),
            (Law::Angle, joint.ic_rotation, 1.0, true),
        ];
        for (law, given, size, turns) in kinds {
            let [Some(first), Some(second)] = given else {
                continue;
            };
            let stands = law.value(&I, &J, None);
            let off = |x: f64| (x - stands).abs();
            if second != 0.0 && off(first) > 0.01 * size && off(second) < 0.2 * off(first) {
                found.push(Exchanged {
                    joint: id,
                    turns,
                    given: [first, second],
                    stands,
                    believed: joint.place.name.is_some(),
                });
            }
        }
    }
    found
}

/// Finds what assembly has turned round: parts that stand the other way than in the dataset, joints
/// whose axes point against each other.
pub fn turned(scene: Configured<'_>, model: &Model, numbers: &[f64]) -> Vec<AssemblyWarning> {
    let at = Equations::new(scene, numbers);
    let mut found = Vec::new();
    for (k, part) in scene
        .parts
        .iter()
        .enumerate()
        .filter(|p| !p.1.is_point_mass())
    {
        let now = at.part(k, false).R_GM;
        let between = part.initial.rotation.transpose() * now;
        let trace: f64 = (0..3).map(|k| between.0[k][k]).sum();
        let angle = (0.5 * (trace - 1.0)).clamp(-1.0, 1.0).acos();
        if angle > TURNED {
            found.push(AssemblyWarning::OtherBranch {
                element: part.id,
                angle,
            });
        }
    }
    for (element, _, i, j) in ties(model).into_iter().filter(|t| t.1.keeps_z()) {
        let frame = |id: u32| scene.marker_of.get(&id).map(|&m| at.marker(m).R_GM);
        if let (Some(I), Some(J)) = (frame(i), frame(j))
            && I.column(2).dot(J.column(2)) < -0.5
        {
            found.push(AssemblyWarning::WrongWayRound {
                element,
                markers: [i, j],
            });
        }
    }
    found
}
