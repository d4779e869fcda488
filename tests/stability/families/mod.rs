//! The scenes, a file a family: each has a closed form, a law, or a reason for which it must stop.

mod angles;
mod circular;
mod friction;
mod gravity;
mod jumps;
mod large;
mod long;
mod many_outputs;
mod mass_ratio;
mod no_value;
mod redundant;
mod rest;
mod scales;
mod short_forces;
mod singular;
mod stiffness;
mod tumbling;
mod turns;

use crate::scene::Scene;

/// All scenes.
pub fn all() -> Vec<Scene> {
    [
        stiffness::stiffness(),
        mass_ratio::mass_ratio(),
        scales::scales(),
        gravity::gravity(),
        singular::singular(),
        turns::turns(),
        tumbling::tumbling(),
        friction::friction(),
        jumps::jumps(),
        short_forces::short_forces(),
        no_value::no_value(),
        redundant::redundant(),
        long::long(),
        many_outputs::many_outputs(),
        large::large(),
        circular::circular(),
        rest::rest(),
        angles::angles(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
