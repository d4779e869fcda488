//! Reactions that redundant equations leave open, and that functions or friction read: the motion
//! then depends on which of all possible reactions are taken, which are the smallest.

use crate::analysis::start::assemble::Redundant;
use crate::analysis::warning::AssemblyWarning;
use crate::physics::action::Action;
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::space::Vec3;

/// Part of the largest force or torque of a state of stress below which an element bears none.
const UNSTRESSED: f64 = 1e-9;

/// Returns a warning for each constraint of whose reaction loads read what redundant rows leave
/// open.
pub(in crate::analysis) fn read_by_loads(
    scene: Configured<'_>,
    numbers: &[f64],
    redundant: &[Redundant],
) -> Vec<AssemblyWarning> {
    let at = Equations::<f64>::new(scene, numbers);
    let mut open: Vec<usize> = Vec::new();
    for one in redundant.iter().filter(|_| !scene.loops.is_empty()) {
        let mut lambda = vec![0.0; scene.rows.len()];
        lambda[one.row] = 1.0;
        for &(row, factor) in &one.combination {
            lambda[row] = -factor;
        }
        let stress = at.stress(&lambda);
        let largest = |of: &dyn Fn(&Action<f64>) -> Vec3<f64>| {
            let all = stress.iter().flat_map(|action| of(action).0);
            all.fold(0.0, |m: f64, x| m.max(x.abs()))
        };
        let most = [largest(&|a| a.force), largest(&|a| a.torque)];
        for (c, value, is_torque) in at.read_in_loops(&stress) {
            if value.abs() > UNSTRESSED * most[usize::from(is_torque)] {
                open.push(c);
            }
        }
    }
    open.sort_unstable();
    open.dedup();
    let told = open.into_iter().map(|c| AssemblyWarning::OpenReaction {
        element: scene.constraints[c].id,
    });
    told.collect()
}
