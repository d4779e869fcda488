//! Contacts that begin deep within each other: their force is that of a collision which nothing
//! brought about, and throws the parts apart.

use crate::analysis::warning::AssemblyWarning;
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;

/// Depth at the start that is doubted, at least, relative to the size of the mechanism.
const DEEP: f64 = 0.02;

/// Returns warnings of contacts whose solids begin deep within each other.
pub fn contacts(scene: Configured<'_>, numbers: &[f64]) -> Vec<AssemblyWarning> {
    let at = Equations::new(scene, numbers);
    let deep = scene.forces.iter().filter_map(|force| {
        let depth = force.depth(&at).filter(|d| *d > DEEP * scene.size)?;
        Some(AssemblyWarning::Embedded {
            element: force.id,
            depth,
            unit: scene.length_unit.clone(),
        })
    });
    deep.collect()
}
