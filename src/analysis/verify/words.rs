//! Directions, axes and elements in words.

use crate::model::PrimitiveKind;
use crate::scene::equations::Equations;
use crate::scene::{RowKind, Scene};
use crate::space::{Mat3, Vec3};

/// Two directions are the same when their cosine differs from one by less than this.
const SAME: f64 = 1e-9;

/// The keyword of a JPRIM type.
pub(super) fn primitive(kind: PrimitiveKind) -> &'static str {
    use PrimitiveKind as P;
    match kind {
        P::Atpoint => "ATPOINT",
        P::Inline => "INLINE",
        P::Inplane => "INPLANE",
        P::Orientation => "ORIENTATION",
        P::ParallelAxes => "PARALLEL_AXES",
        P::Perpendicular => "PERPENDICULAR",
    }
}

/// A direction in words: an axis of ground, of one of the named frames, or three numbers.
pub fn axis(direction: Vec3<f64>, frames: &[(String, Mat3<f64>)]) -> String {
    let length = direction.norm();
    let unit = direction.times(1.0 / length);
    let name = |frame: &Mat3<f64>| {
        (0..3)
            .find(|&k| frame.column(k).dot(unit).abs() > 1.0 - SAME)
            .map(|k| ["X", "Y", "Z"][k])
    };
    if let Some(axis) = name(&Mat3::identity()) {
        return format!("ground {axis}");
    }
    for (owner, frame) in frames {
        if let Some(axis) = name(frame) {
            return format!("{axis} of {owner}");
        }
    }
    point(unit)
}

/// Three numbers, four digits each.
pub(super) fn point(p: Vec3<f64>) -> String {
    let largest = p.0.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let number = |x: f64| {
        let x = if x.abs() < 1e-6 * largest { 0.0 } else { x };
        let text = format!("{x:.4}");
        if text.trim_start_matches(['-', '0', '.']).is_empty() && x != 0.0 {
            return format!("{x:.3e}");
        }
        text.trim_end_matches('0').trim_end_matches('.').to_string()
    };
    format!(
        "({}, {}, {})",
        number(p.0[0]),
        number(p.0[1]),
        number(p.0[2])
    )
}

/// The axes in which an element's reaction is told: those of its J marker, ground's when they are parallel to these.
pub(super) fn axes(at: &Equations<'_, f64>, marker: Option<usize>) -> (String, Mat3<f64>) {
    let ground = ("ground".to_string(), Mat3::identity());
    let Some(m) = marker else { return ground };
    let R = at.marker(m).R_GM;
    let parallel = (0..3).all(|k| R.column(k).0[k].abs() > 1.0 - SAME);
    if parallel {
        ground
    } else {
        (format!("MARKER/{}", at.marker_id(m)), R)
    }
}

/// What a row fixes: "translation along ground Z", "rotation about X of MARKER/4".
pub(in crate::analysis) fn direction(scene: &Scene, at: &Equations<'_, f64>, row: usize) -> String {
    let value = at.row(row);
    if let RowKind::Displacements(sum) = &scene.rows[row].kind {
        let n = sum.terms.len();
        return format!("a sum of {n} displacements");
    }
    let Some((_, action)) = value.actions.first() else {
        return "a combination of coordinates".into();
    };
    let mut frames = Vec::new();
    for (m, _) in value.actions.iter().rev() {
        let name = format!("MARKER/{}", scene.markers[*m].id);
        frames.push((name, at.marker(*m).R_GM));
    }
    let (force, torque) = (action.force, action.torque);
    if force.norm() > 1e-9 {
        format!("translation along {}", axis(force, &frames))
    } else if torque.norm() > 1e-9 {
        format!("rotation about {}", axis(torque, &frames))
    } else {
        "nothing at this position".into()
    }
}

/// "JOINT/4 fixes rotation about ground X, already fixed by JOINT/1, JOINT/2"
pub(super) fn sentence(
    element: &str,
    direction: &str,
    fixed_by: &[String],
    only_here: bool,
) -> String {
    let fixes = if element.starts_with("MOTION") {
        "drives"
    } else {
        "fixes"
    };
    let mut text = format!("{element} {fixes} {direction}");
    if fixed_by.is_empty() {
        text += ", though the parts it ties cannot move against each other";
    } else {
        text += &format!(", already fixed by {}", fixed_by.join(", "));
    }
    if only_here {
        text += " (at this position only)";
    }
    text
}
