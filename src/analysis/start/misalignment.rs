//! Misalignments of a dataset, before and after assembly: by how much joints are off, and which
//! parts had to be turned round.

use crate::analysis::direction::Axis;
use crate::analysis::start::{branch, driven_start, initial_conditions};
use crate::analysis::warning::{AssemblyWarning, ConditionWarning};
use crate::arrange::Arrange;
use crate::model::check::alignment::{self, Needed};
use crate::model::check::angles;
use crate::model::{ElementId, ElementKind, Model};
use crate::physics::joint::Tie;
use crate::physics::row::Law;
use crate::scene::Scene;
use crate::scene::configuration::{Configuration, Configured};
use crate::scene::equations::Equations;
use crate::space::{Mat3, Vec3};
use std::f64::consts::{PI, TAU};

/// Offsets relative to the size of the mechanism, and angles in rad, that are worth telling: typed
/// numbers with five digits are not.
const WORTH_TELLING: f64 = 1e-5;
/// Turn of a part against the dataset that is told, in rad: a degree.
const TURNED: f64 = PI / 180.0;

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
    let mut found = ties_apart(scene, model);
    let axes = alignment::misaligned(model).into_iter();
    // pins of joints are ties
    let others = axes.filter(|m| !matches!(m.needed, Needed::UniversalPins | Needed::HookePins));
    found.extend(others.map(AssemblyWarning::Axes));
    found
}

/// Finds joints and primitives whose markers are apart or turned against each other.
fn ties_apart(scene: &Scene, model: &Model) -> Vec<AssemblyWarning> {
    let frame = |id: u32| scene.marker_of.get(&id).map(|&m| scene.drawn(m));
    let mut found = Vec::new();
    for (element, tie, i, j) in ties(model) {
        let (Some(I), Some(J)) = (frame(i), frame(j)) else {
            continue;
        };
        let mut offset = Vec3::zero();
        for &law in tie.rows() {
            let value = law.value(&I, &J, None);
            match law {
                Law::Offset(k) => offset += Vec3::axis(k).times(value),
                Law::Along(k) => offset += J.rotation.column(k).times(value),
                Law::Dot(..) | Law::EqualDots | Law::Angle | Law::BodyAngle { .. } => {}
            }
        }
        let missing = branch::of_tie(tie.rows(), &I, &J, 0).unwrap_or_default();
        let turn = (missing.iter()).fold(Vec3::zero(), |sum, (axis, by)| sum - axis.times(*by));
        let axes = [(j, J.rotation), (i, I.rotation)];
        let offset = (offset.norm() > WORTH_TELLING * scene.size)
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

/// Returns warnings of the order of the numbers of initial conditions.
///
/// `IC = displacement, velocity` is how the statement is documented. Adams View writes, and Adams
/// Solver (C++) reads, velocity and displacement: the one model that we have in all three forms has
/// `translational_ic = -146.99, velocity_ic = -0.1815` in its View commands, `IC = -0.1815,
/// -146.99` in the dataset that View wrote of them, and stands at -146.992, moving by -0.2, in the
/// results.
/// A statement that View wrote carries the name it has there: it is read in View's order, which is
/// told once. Others are read as documented, and told where their parts stand at the second number.
pub fn orders(scene: &Scene, model: &Model) -> Vec<ConditionWarning> {
    let (mut of_view, mut doubtful) = (Vec::new(), Vec::new());
    for (id, joint) in model.active(ElementKind::Joint, &model.joints) {
        let element = ElementKind::Joint.id(id);
        let frame = |id: u32| scene.marker_of.get(&id).map(|&m| scene.drawn(m));
        let kinds = [
            (Law::Along(2), joint.ic_translation, scene.size),
            (Law::Angle, joint.ic_rotation, 1.0),
        ];
        for (law, given, size) in kinds {
            let [Some(displacement), Some(velocity)] = given else {
                continue;
            };
            if joint.place.name.is_some() || joint.has_named_ic {
                if displacement != 0.0 && velocity != 0.0 && !joint.has_named_ic {
                    of_view.push((element, [velocity, displacement]));
                }
                continue;
            }
            let (Some(I), Some(J)) = (frame(joint.i), frame(joint.j)) else {
                continue;
            };
            let stands = law.value(&I, &J, None);
            let off = |x: f64| (x - stands).abs();
            let exchanged = off(velocity) < 0.2 * off(displacement);
            if velocity != 0.0 && off(displacement) > 0.01 * size && exchanged {
                doubtful.push(ConditionWarning::Exchanged {
                    element,
                    given: [displacement, velocity],
                    stands,
                });
            }
        }
    }
    let of_view = (!of_view.is_empty()).then_some(ConditionWarning::ViewOrder { joints: of_view });
    let turns = whole_turns(model);
    of_view.into_iter().chain(doubtful).chain(turns).collect()
}

/// Returns warnings of initial angles beyond half a turn, as angles begin within it.
fn whole_turns(model: &Model) -> Vec<ConditionWarning> {
    let joints = model.active(ElementKind::Joint, &model.joints);
    let joints = joints.map(|(id, j)| (ElementKind::Joint.id(id), "IC", j.ic_rotation[0]));
    let motions = model.active(ElementKind::Motion, &model.motions);
    let turning = motions.filter(|(_, m)| angles::turns(model, m));
    let turning = turning.map(|(id, m)| (ElementKind::Motion.id(id), "ICDISP", m.ic_displacement));
    let beyond = |x: f64| x.is_finite() && x.abs() > PI * (1.0 + 1e-6);
    joints
        .chain(turning)
        .filter_map(|(element, argument, angle)| {
            let given = angle.filter(|&x| beyond(x))?;
            Some(ConditionWarning::WholeTurns {
                element,
                argument,
                given,
                begins: given - TAU * (given / TAU).round(),
            })
        })
        .collect()
}

/// Returns what assembly has turned: parts by more than a degree, unless initial conditions of
/// joints or comment lines ask for it (`joints`), and ties and motions that hold at an opposite.
pub fn turned(
    scene: Configured<'_>,
    model: &Model,
    numbers: &[f64],
    joints: bool,
) -> Vec<AssemblyWarning> {
    let at = Equations::new(scene, numbers);
    let drawn = (0..scene.motions.len()).map(|m| scene.initial_displacement(m).unwrap_or(f64::NAN));
    let undriven = scene
        .configuration
        .with_motions_at(&drawn.collect::<Vec<_>>());
    let undriven = scene.scene.within(&undriven);
    let mut before = numbers.to_vec();
    before[scene.layout.q()].copy_from_slice(&scene.initial_q);
    let mut asked = before.clone();
    if joints {
        initial_conditions::initial_joints(&scene, model, &mut asked[scene.layout.q()]);
    }
    let [before, asked] = [before, asked].map(|numbers| Equations::new(undriven, &numbers));
    let mut parts: Vec<(ElementId, f64)> = Vec::new();
    for (k, part) in scene.parts.iter().enumerate() {
        let now = at.part(k, false).R_GM;
        let drawn = part.initial.rotation;
        let from = |then: &Mat3<f64>| branch::angle_between(then, &now);
        let angle = from(&drawn);
        if angle <= TURNED || part.is_point_mass() {
            continue;
        }
        let condition = asked.part(k, false).R_GM * before.part(k, false).R_GM.transpose();
        let angle = angle.min(from(&(condition * drawn)));
        if angle > TURNED {
            parts.push((part.id, angle));
        }
    }
    parts.arrange_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    // what lines ask for and do not get is told by itself
    let mut lines = model.beginnings.values().flat_map(|values| values.keys());
    let is_asked = joints && lines.any(|quantity| !quantity.is_rate());
    let is_told = !parts.is_empty() && !is_asked;
    let turned = is_told.then_some(AssemblyWarning::Turned { parts });
    turned
        .into_iter()
        .chain(opposites(scene, model, &at))
        .collect()
}

/// Returns motions that begin elsewhere than where their joints are drawn, by more than a degree or
/// as much of the size of the mechanism.
pub(in crate::analysis) fn driven(
    scene: &Scene,
    configuration: &Configuration,
    drawn: (f64, &[f64], &[f64]),
) -> Vec<AssemblyWarning> {
    let ways = driven_start::ways(scene, configuration, drawn).into_iter();
    let told = ways.filter_map(|way| {
        let is_angle = scene.drives_an_angle(way.motion);
        let one = if is_angle { 1.0 } else { scene.size };
        (way.by.abs() > TURNED * one).then(|| AssemblyWarning::DrivenStart {
            element: ElementKind::Motion.id(scene.motions[way.motion].id),
            by: way.by,
            is_angle,
            unit: scene.length_unit.clone(),
        })
    });
    told.collect()
}

/// Returns ties whose axes point against each other, and motions of angles that hold at an
/// opposite.
fn opposites(
    scene: Configured<'_>,
    model: &Model,
    at: &Equations<'_, f64>,
) -> Vec<AssemblyWarning> {
    let mut found = Vec::new();
    for (element, tie, i, j) in ties(model).into_iter().filter(|t| t.1.keeps_z()) {
        let frame = |id: u32| scene.marker_of.get(&id).map(|&m| at.marker(m).R_GM);
        let (Some(I), Some(J)) = (frame(i), frame(j)) else {
            continue;
        };
        let kept: &[usize] = if tie.keeps_x() { &[2, 0] } else { &[2] };
        let against = |&&axis: &&usize| I.column(axis).dot(J.column(axis)) < -0.5;
        if let Some(&axis) = kept.iter().find(against) {
            found.push(AssemblyWarning::WrongWayRound {
                element,
                markers: [i, j],
                axis,
            });
        }
    }
    let turns = branch::turns(scene, at, 0).into_iter();
    let motions = turns.filter(|t| t.element.kind == ElementKind::Motion);
    found.extend(motions.filter(|t| t.left > branch::ON_BRANCH).map(|t| {
        AssemblyWarning::OppositeAngle {
            element: t.element,
            angle: t.left,
        }
    }));
    found
}
