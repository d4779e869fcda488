//! Angles and angular velocities that are asked along an axis about which the joint between the two
//! parts does not turn.

use super::*;
use crate::arrange::Arrange;
use crate::expr::measures::Measure;
use crate::model::geometry::marker_frame;
use crate::physics::joint::JointKind;
use crate::space::{Frame, Vec3};
use std::cell::LazyCell;
use std::collections::BTreeSet;

/// Component of a unit vector that is not there, but for rounding.
const NOT_THERE: f64 = 1e-9;

/// Names of axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Two markers between which angles are asked, and the marker about whose axes: 0 is ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Between {
    is_speed: bool,
    i: u32,
    j: u32,
    about: u32,
}

/// An axis about which a function asks for an angle.
struct Asked<'m> {
    by: reference::Owned<'m>,
    measure: Measure,
    between: Between,
    axis: usize,
}

/// Returns the axis of an angle of projection or of an angular velocity, and whether it is the
/// velocity.
fn axis_of(measure: Measure) -> Option<(usize, bool)> {
    match measure {
        Measure::Ax => Some((0, false)),
        Measure::Ay => Some((1, false)),
        Measure::Az => Some((2, false)),
        Measure::Wx => Some((0, true)),
        Measure::Wy => Some((1, true)),
        Measure::Wz => Some((2, true)),
        _ => None,
    }
}

/// Returns the measure of another axis.
fn along(measure: Measure, axis: usize) -> Option<Measure> {
    let is_speed = axis_of(measure)?.1;
    let of_angle = [Measure::Ax, Measure::Ay, Measure::Az];
    let of_speed = [Measure::Wx, Measure::Wy, Measure::Wz];
    let all = if is_speed { of_speed } else { of_angle };
    all.get(axis).copied()
}

/// Returns the axes about which functions ask for angles.
fn asked(model: &Model) -> Vec<Asked<'_>> {
    let calls = model.measure_calls().into_iter();
    let asked = calls.filter_map(|(by, measure, [i, j, k])| {
        let (axis, is_speed) = axis_of(measure)?;
        let about = if is_speed { k } else { j };
        let between = Between {
            is_speed,
            i,
            j,
            about,
        };
        Some(Asked {
            by,
            measure,
            between,
            axis,
        })
    });
    asked.collect()
}

/// The joints that turn about one axis, by the two parts that they join.
struct Turning<'m> {
    model: &'m Model,
    ground: Option<ElementId>,
    joints: BTreeMap<[Option<ElementId>; 2], (u32, &'m Joint)>,
}

impl<'m> Turning<'m> {
    fn new(model: &'m Model) -> Self {
        let mut joints = BTreeMap::new();
        for (id, joint) in model.active(ElementKind::Joint, &model.joints) {
            if matches!(joint.kind, JointKind::Revolute | JointKind::Cylindrical) {
                let mut bodies = [joint.i, joint.j].map(|m| model.body_of(m));
                bodies.arrange();
                joints.entry(bodies).or_insert((id, joint));
            }
        }
        let ground = model.bodies().find(|(_, part)| part.ground);
        Self {
            model,
            ground: ground.map(|(id, _)| id),
            joints,
        }
    }

    /// Returns the body of a marker; that of none is ground.
    fn body_of(&self, marker: u32) -> Option<ElementId> {
        match marker {
            0 => self.ground,
            _ => self.model.body_of(marker),
        }
    }

    /// Returns the joint between two markers and its axis in the axes about which is asked; `None`
    /// where there is none, or these axes are no more fixed to it than it turns.
    fn axis(&self, between: Between) -> Option<(u32, Vec3<f64>)> {
        let mut bodies = [self.body_of(between.i), self.body_of(between.j)];
        bodies.arrange();
        let &(id, joint) = self.joints.get(&bodies)?;
        let about = self.body_of(between.about)?;
        let [i, j] = [joint.i, joint.j].map(|m| self.model.body_of(m));
        let fixed_there = match Some(about) {
            body if body == j => joint.j,
            body if body == i => joint.i,
            _ => return None,
        };
        let axis = marker_frame(self.model, fixed_there)?.rotation.column(2);
        let frame = match between.about {
            0 => Frame::identity(),
            marker => marker_frame(self.model, marker)?,
        };
        Some((
            id,
            Vec3([0, 1, 2].map(|k| frame.rotation.column(k).dot(axis))),
        ))
    }
}

pub(super) fn angles_are_asked_where_joints_turn(model: &Model, out: &mut Out) {
    let turning = LazyCell::new(|| Turning::new(model));
    let all = asked(model);
    let all = all
        .iter()
        .filter_map(|a| Some((a, turning.axis(a.between)?)));
    let all: Vec<_> = all.collect();
    // whoever asks for all three components knows that some are zero
    let known: BTreeSet<Between> = (all.iter())
        .filter(|(asked, (_, axis))| axis.0[asked.axis].abs() > NOT_THERE)
        .map(|(asked, _)| asked.between)
        .collect();
    for (asked, (joint, axis)) in all {
        let between = asked.between;
        if known.contains(&between) {
            continue;
        }
        let joint = model.called(ElementKind::Joint.id(joint));
        let of = match between.about {
            0 => "ground".to_owned(),
            marker => model.called(ElementKind::Marker.id(marker)),
        };
        let whole = (0..3).find(|&k| (axis.0[k].abs() - 1.0).abs() < NOT_THERE);
        let turns = match whole {
            Some(k) => format!("{joint} turns about {} of {of}", AXES[k]),
            None => format!(
                "{joint} turns about an axis square to {} of {of}",
                AXES[asked.axis]
            ),
        };
        let written = |measure: Measure| {
            let markers = match between {
                Between { j: 0, about: 0, .. } => vec![between.i],
                Between {
                    is_speed: true,
                    about,
                    ..
                } if about != 0 => {
                    vec![between.i, between.j, about]
                }
                _ => vec![between.i, between.j],
            };
            let markers: Vec<String> = markers.iter().map(u32::to_string).collect();
            format!("{}({})", measure.name(), markers.join(","))
        };
        let is = match between.is_speed {
            true => "is zero for ever",
            false => "does not turn",
        };
        let (call, argument) = (written(asked.measure), asked.by.argument);
        let who = (asked.by.element, asked.by.place);
        warn(
            out,
            "nothing_turns",
            who,
            format!("{argument}: {call} {is}: {turns}"),
        );
        let other = whole.and_then(|k| along(asked.measure, k));
        other
            .into_iter()
            .for_each(|m| advise(out, format!("it turns by {}", written(m))));
    }
}
