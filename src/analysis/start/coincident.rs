//! Forces along the line from J to I where the two coincide: there is no line.
//!
//! ```text
//! F = f(d) (p_I − p_J)/d,   d = |p_I − p_J|         d = 0: no direction
//! ```
//!
//! Where f(0) = 0 the force goes through zero whatever the direction is, and the model can move
//! from there. Where it is not, nothing says which way the force points: the model has to.

use crate::analysis::warning::AssemblyWarning;
use crate::diagnostic::Diagnostic;
use crate::model::ElementKind;
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::scene::forces::{ForceElement, ForceLaw};

/// Part of the mechanism's size below which two markers coincide: typed numbers have ten digits,
/// and rounding makes up a direction.
const COINCIDENT: f64 = 1e-12;

/// Warnings of forces that are zero where their markers coincide.
///
/// # Errors
/// For forces that are not.
pub fn lines(
    scene: Configured<'_>,
    numbers: &[f64],
) -> Result<Vec<AssemblyWarning>, Vec<Diagnostic>> {
    let at = Equations::new(scene, numbers);
    let (mut told, mut wrong) = (Vec::new(), Vec::new());
    for force in &scene.forces {
        let Some((j, magnitude)) = along_a_line(force, &at) else {
            continue;
        };
        let between = at.marker(force.i).p_GM - at.marker(j).p_GM;
        if between.norm() > COINCIDENT * scene.length || !magnitude.is_finite() {
            continue;
        }
        let [i, j] = [force.i, j].map(|m| scene.markers[m].id);
        if magnitude == 0.0 {
            told.push(AssemblyWarning::Coincident {
                element: force.id,
                markers: [i, j],
            });
            continue;
        }
        let problem = Diagnostic::error(
            "coincident",
            format!(
                "its markers {} and {} coincide: the line between them has no direction, \
                 and its force of {magnitude:.6} there none either",
                ElementKind::Marker.id(i),
                ElementKind::Marker.id(j)
            ),
        );
        wrong.push(problem.element(force.id).help(
            "place one of them where the force should pull from, or use VFORCE, BUSHING or SFORCE with ACTIONONLY",
        ));
    }
    if wrong.is_empty() {
        Ok(told)
    } else {
        Err(wrong)
    }
}

/// J, and the force at no distance and rate, of an element that acts along the line between its
/// markers.
fn along_a_line(force: &ForceElement, at: &Equations<'_, f64>) -> Option<(usize, f64)> {
    let magnitude = match &force.law {
        ForceLaw::Single {
            rotational: false,
            action_only: false,
            formula,
            ..
        } => at.formula(*formula),
        ForceLaw::SpringDamper(law) if !law.rotational => law.preload + law.stiffness * law.free,
        _ => return None,
    };
    Some((force.j?, magnitude))
}
