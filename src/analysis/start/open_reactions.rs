//! Reactions that redundant equations leave open, and that functions or friction read: the motion
//! then depends on which of all possible reactions are taken, which are the smallest.

use crate::analysis::start::assemble::Redundant;
use crate::analysis::warning::AssemblyWarning;
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::space::Vec3;

/// Part of the largest force or torque of a state of stress below which an element bears none.
const UNSTRESSED: f64 = 1e-9;

/// Returns a warning for each constraint whose reaction loads read and redundant rows leave open.
pub(in crate::analysis) fn read_by_loads(
    scene: Configured<'_>,
    numbers: &[f64],
    redundant: &[Redundant],
) -> Vec<AssemblyWarning> {
    let at = Equations::<f64>::new(scene, numbers);
    let read = at.reactions_in_loops();
    if read.is_empty() {
        return Vec::new();
    }
    let mut open = vec![false; scene.constraints.len()];
    for one in redundant {
        let mut lambda = vec![0.0; scene.rows.len()];
        lambda[one.row] = 1.0;
        for &(row, factor) in &one.combination {
            lambda[row] = -factor;
        }
        let stress = at.stress(&lambda);
        let size = |v: Vec3<f64>| v.0.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let largest = |of: &dyn Fn(usize) -> f64| (0..stress.len()).map(of).fold(0.0, f64::max);
        let (force, torque) = (
            |c: usize| size(stress[c].force),
            |c: usize| size(stress[c].torque),
        );
        let most = [largest(&force), largest(&torque)].map(|size| UNSTRESSED * size);
        for (c, is_open) in open.iter_mut().enumerate() {
            *is_open |= force(c) > most[0] || torque(c) > most[1];
        }
    }
    let told = read.into_iter().filter(|&c| open[c]);
    told.map(|c| AssemblyWarning::OpenReaction {
        element: scene.constraints[c].id,
    })
    .collect()
}
