//! Leaps of parts between two simulations: where a command switches a constraint on, or gives a
//! motion another function, it holds at once, as if parts had been put there by hand and struck.

use super::branch::angle_between;
use crate::analysis::warning::AssemblyWarning;
use crate::model::ElementId;
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::space::MarkerState;
use std::collections::BTreeMap;

/// Distance over the size of the mechanism, and turn in rad, that are told.
const TOLD_PLACE: f64 = 1e-4;
/// Change of a velocity over the largest there is that is told.
const TOLD_RATE: f64 = 1e-3;
/// Way, over the size of the mechanism or in rad, that a change of velocity makes in the time since
/// the beginning and that is told: what is at rest moves by rounding.
const TOLD_WAY: f64 = 1e-9;

/// Finds the part that is farthest from where a simulation left it; where none is, the one whose
/// velocity has changed most, if velocities go on, for so long (`lasted`) since the beginning.
pub fn of_parts(
    scene: Configured<'_>,
    left: &[(ElementId, MarkerState<f64>)],
    numbers: &[f64],
    lasted: Option<f64>,
) -> Option<AssemblyWarning> {
    let at = Equations::new(scene, numbers);
    let left: BTreeMap<ElementId, &MarkerState<f64>> =
        left.iter().map(|(id, s)| (*id, s)).collect();
    let length = scene.size.max(f64::MIN_POSITIVE);
    let (mut place, mut rate) = ((TOLD_PLACE, None), (0.0, None));
    let mut fastest: f64 = 0.0;
    for (k, part) in scene.parts.iter().enumerate() {
        let Some(before) = left.get(&part.id) else {
            continue;
        };
        let now = at.part(k, false);
        let offset = (now.p_GM - before.p_GM).norm();
        let turn = angle_between(&before.R_GM, &now.R_GM);
        let by = turn.max(offset / length);
        if by > place.0 {
            let (element, unit) = (part.id, scene.length_unit.clone());
            let moved = AssemblyWarning::Moved {
                element,
                offset: worth(offset, TOLD_PLACE * length),
                turn: worth(turn, TOLD_PLACE),
                unit,
            };
            place = (by, Some(moved));
        }
        let speed = (now.v_GM - before.v_GM).norm();
        let spin = (now.w_GM - before.w_GM).norm();
        for state in [&now, *before] {
            fastest = fastest.max(state.v_GM.norm() / length + state.w_GM.norm());
        }
        let by = spin + speed / length;
        if by > rate.0 {
            let (element, unit) = (part.id, scene.length_unit.clone());
            let struck = AssemblyWarning::Struck {
                element,
                speed: worth(speed, TOLD_PLACE * by * length),
                spin: worth(spin, TOLD_PLACE * by),
                unit,
            };
            rate = (by, Some(struck));
        }
    }
    let is_told = |t: f64| rate.0 > TOLD_RATE * fastest && rate.0 * t > TOLD_WAY;
    let struck = rate.1.filter(|_| lasted.is_some_and(is_told));
    place.1.or(struck)
}

/// Returns a size, or zero where it is too small to be told.
fn worth(size: f64, least: f64) -> f64 {
    if size > least { size } else { 0.0 }
}
