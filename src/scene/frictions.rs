//! FRICTION statements: a force element in the joint, which reads the joint's own reaction.
//!
//! The reaction depends on the friction and the friction on the reaction: an algebraic loop like
//! any other (`loops.rs`), whose unknowns are the components of `JOINT(id, 0, …)` that the law
//! reads. What the surfaces have crept is a state, over the largest deformation that is possible.

use super::build::Builder;
use super::compile::Compiler;
use super::equations::{KINEMATIC, STATIC};
use super::forces::ForceLaw;
use super::unknown::{DifferentialId, UnknownId};
use crate::diagnostic::{Cause, Diagnostic};
use crate::model::{self, ElementKind};
use crate::physics::friction::{Friction, Grip, Kind, Overlap};

impl Builder<'_> {
    pub(super) fn frictions(&mut self, c: &mut Compiler) {
        let model = self.model;
        for (id, f) in model.active(ElementKind::Friction, &model.frictions) {
            let name = ElementKind::Friction.id(id);
            let braked = ElementKind::Joint.id(f.joint);
            let Some(joint) = model.joints.get(&f.joint) else {
                c.error(name, format!("{braked} does not exist"));
                continue;
            };
            if !model.is_active(braked) {
                continue;
            }
            let Some(kind) = joint.kind.row().friction else {
                c.error(
                    name,
                    format!("{braked}: there is no friction law for its kind"),
                );
                continue;
            };
            if f.lugre {
                let what = "FORMULATION=LUGRE is solved by the law of sticking and sliding: friction does not lag behind the velocity, and what sticks creeps by its own law";
                let warning = Diagnostic::warning(Cause::Approximate, what).element(name);
                self.scene.warnings.push(warning);
            }
            match friction(f, kind) {
                Ok(law) => {
                    let at_rest = self.scene.mode == STATIC;
                    if at_rest && !f.inactive_in_statics {
                        let what = "at rest nothing has crept, and there is no friction: what friction would hold is moved by its load";
                        let warning =
                            Diagnostic::warning("frictionless_statics", what).element(name);
                        self.scene.warnings.push(warning);
                    }
                    let moves = !at_rest && self.scene.mode != KINEMATIC;
                    let n_creeps = if moves { law.n_creeps() } else { 0 };
                    let creep = self.scene.layout.n_x;
                    for k in 1..=n_creeps {
                        self.add_state(UnknownId::Differential(DifferentialId {
                            element: name,
                            number: Some(k),
                        }));
                    }
                    let law = ForceLaw::Friction {
                        law: Box::new(law),
                        joint: f.joint,
                        creep: creep..creep + n_creeps,
                    };
                    self.between(c, name, (joint.i, joint.j), law);
                }
                Err(why) => c.error(name, why),
            }
        }
    }
}

/// The numbers of a statement, with the documented defaults.
fn friction(f: &model::Friction, kind: Kind) -> Result<Friction, String> {
    let positive = |what: &str, x: Option<f64>, default: f64| {
        let x = x.unwrap_or(default);
        if x > 0.0 && x.is_finite() {
            Ok(x)
        } else {
            Err(format!("{what} must be positive"))
        }
    };
    let not_negative = |what: &str, x: f64| {
        if x >= 0.0 && x.is_finite() {
            Ok(x)
        } else {
            Err(format!("{what} must not be negative"))
        }
    };
    let vs = positive(
        "STICTION_TRANSITION_VELOCITY",
        f.stiction_transition_velocity,
        0.1,
    )?;
    let deformation = positive("MAX_STICTION_DEFORMATION", f.max_stiction_deformation, 0.01)?;
    let mut grip = Grip {
        mu_static: not_negative("MU_STATIC", f.mu_static)?,
        mu_dynamic: not_negative("MU_DYNAMIC", f.mu_dynamic)?,
        stiction_velocity: vs,
        deformation: Some(deformation),
    };
    match f.effect.as_deref() {
        // only what acts below the stiction velocity, only what acts beyond it
        Some("STICTION") => grip.mu_dynamic = 0.0,
        Some("SLIDING") => {
            grip.mu_static = grip.mu_dynamic;
            grip.deformation = None;
        }
        _ => {}
    }
    let all = f.inputs.is_empty() || f.inputs.iter().any(|i| i == "ALL");
    let takes = |what: &str| all || f.inputs.iter().any(|i| i == what);
    let preload = |what: &str, x: Option<f64>| {
        let x = if takes("PRELOAD") {
            x.unwrap_or(0.0)
        } else {
            0.0
        };
        not_negative(what, x)
    };
    let radius = if kind == Kind::Spherical {
        positive("BALL_RADIUS", f.ball_radius, 1.0)?
    } else {
        positive("PIN_RADIUS", f.pin_radius, 1.0)?
    };
    Ok(Friction {
        kind,
        grip,
        takes: ["REACTION_FORCE", "BENDING_MOMENT", "TORSIONAL_MOMENT"].map(takes),
        force_preload: preload("FRICTION_FORCE_PRELOAD", f.force_preload)?,
        torque_preload: preload("FRICTION_TORQUE_PRELOAD", f.torque_preload)?,
        friction_arm: not_negative("FRICTION_ARM", f.friction_arm.unwrap_or(1.0))?,
        bending_arm: positive("BENDING_REACTION_ARM", f.bending_reaction_arm, 1.0)?,
        radius,
        reaction_arm: positive("REACTION_ARM", f.reaction_arm, 1.0)?,
        overlap: positive("INITIAL_OVERLAP", f.initial_overlap, 1000.0)?,
        overlap_change: match f.overlap_delta.as_deref() {
            Some("INCREASE") => Overlap::Increases,
            Some("DECREASE") => Overlap::Decreases,
            _ => Overlap::Constant,
        },
    })
}
