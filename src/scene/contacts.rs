//! CONTACT statements: which solids, which formula for each pair, which law.

use super::build::{Builder, active};
use super::compile::Compiler;
use super::forces::{ForceLaw, Touching};
use super::outside::{HookKind, SceneHook, Supplied};
use crate::diagnostic::Diagnostic;
use crate::model::{Contact, ContactLaw, CoulombFriction, Shape};
use crate::physics::contact::law::{Coulomb, Law, Normal};
use crate::physics::contact::{Pair, Solid, TOUCH_NUMBERS, TOUCHES};
use std::collections::BTreeSet;

/// Small speed that makes POISSON smooth, as a part of the speed of a fall through the mechanism's own size.
const SMOOTHING: f64 = 1e-3;

/// A solid and the marker in whose frame it stands.
struct Placed {
    marker: u32,
    solid: Solid,
}

fn ascending(a: f64, b: f64) -> [f64; 2] {
    [a.min(b), a.max(b)]
}

/// What a GRAPHICS is in a contact.
fn solid(shape: &Shape) -> Result<Placed, String> {
    let placed = |marker: u32, solid: Solid| Ok(Placed { marker, solid });
    match *shape {
        Shape::Box { corner, size } => {
            let ranges = size.map(|x| ascending(0.0, x));
            let (low, high) = (ranges.map(|r| r[0]), ranges.map(|r| r[1]));
            placed(corner, Solid::Box { low, high })
        }
        Shape::Cylinder { cm, length, radius } => {
            let radius = [radius.abs(); 2];
            placed(
                cm,
                Solid::Frustum {
                    z: ascending(0.0, length),
                    radius,
                },
            )
        }
        Shape::Frustum {
            cm,
            length,
            top,
            bottom,
        } => {
            let mut radius = [bottom.abs(), top.abs()];
            if length < 0.0 {
                radius.reverse();
            }
            placed(
                cm,
                Solid::Frustum {
                    z: ascending(0.0, length),
                    radius,
                },
            )
        }
        Shape::Ellipsoid { cm, diameters } => {
            let semi = diameters.map(|d| d.abs() / 2.0);
            if semi[0] == semi[1] && semi[1] == semi[2] {
                placed(cm, Solid::Ball { radius: semi[0] })
            } else {
                placed(cm, Solid::Ellipsoid { semi })
            }
        }
        Shape::Torus { cm, ring, tube } => placed(cm, Solid::Torus { ring, tube }),
        Shape::Plane { rm, x, y } => placed(rm, Solid::Plane { x, y }),
        Shape::Point { rm } => placed(rm, Solid::Ball { radius: 0.0 }),
        Shape::External { ref file, .. } => Err(format!(
            "is the solid of a CAD kernel in {file:?}, which cannot be read"
        )),
        Shape::Circle { .. } => Err("is a circle: contacts of curves are not solved".into()),
        Shape::Curve { .. } => Err("is a curve: contacts of curves are not solved".into()),
        Shape::Other(ref kind) => Err(format!("is {kind}, for which there is no contact")),
        Shape::Nothing => Err("has no shape".into()),
    }
}

/// Whether a solid has a size.
fn is_degenerate(solid: &Solid) -> bool {
    let bad = |x: f64| x.is_nan() || x <= 0.0 || x == f64::INFINITY;
    match solid {
        Solid::Ball { radius } => *radius != 0.0 && bad(*radius),
        Solid::Plane { .. } => false,
        Solid::Box { low, high } => (0..3).any(|k| bad(high[k] - low[k])),
        Solid::Frustum { z, radius } => bad(z[1] - z[0]) || bad(radius[0] + radius[1]),
        Solid::Ellipsoid { semi } => semi.iter().any(|&a| bad(a)),
        Solid::Torus { ring, tube } => bad(*ring) || bad(*tube),
        Solid::Hull(points) => points.is_empty(),
    }
}

impl Builder<'_> {
    /// CONTACT: a force element for each pair of its solids.
    pub(super) fn contacts(&mut self, c: &mut Compiler, skipped: &BTreeSet<String>) {
        let model = self.model;
        for (id, contact) in active(model, "CONTACT", &model.contacts) {
            let name = format!("CONTACT/{id}");
            if let (ContactLaw::User, Some(_)) = (contact.law, &contact.function) {
                // a routine of contacts is called for incidents that only its own solver finds
                if !self.zero_user {
                    let d = Diagnostic::error("user_routine", "a CONTACT by USER is not solved");
                    c.errors.push(d.element(name).help(
                        "give it an IMPACT or POISSON law, or take what USER would compute as zero (--zero-user)",
                    ));
                }
                continue;
            }
            let law = match self.law(&name, contact) {
                Ok(law) => law,
                Err(why) => {
                    c.error(&name, why);
                    continue;
                }
            };
            match self.pairs(contact) {
                Ok(pairs) => {
                    for (i, j, solids) in pairs {
                        let Some(touching) = self.touching(c, &name, (i, j), solids) else {
                            continue;
                        };
                        let law = ForceLaw::Contact(Box::new((touching, law)));
                        self.between(c, "CONTACT", id, (i, j), law);
                    }
                }
                Err(why) if skipped.contains("CONTACT") => {
                    let what = format!("is left out: {why}");
                    let warning = Diagnostic::warning("skipped", what).element(name);
                    self.scene.warnings.push(warning);
                }
                Err(why) => {
                    let help = "--skip-unsupported CONTACT leaves out the contacts that cannot be solved; the results are then those of another model";
                    let error = Diagnostic::error("unsupported", why).element(name);
                    c.errors.push(error.help(help));
                }
            }
        }
    }

    /// How the touches of a pair are found: by a formula, else by a query; `None`: a marker is missing, which has been said.
    fn touching(
        &mut self,
        c: &mut Compiler,
        name: &str,
        markers: (u32, u32),
        solids: [Solid; 2],
    ) -> Option<Touching> {
        if let Some(pair) = Pair::of(&solids[0], &solids[1]) {
            return Some(Touching::Formula(pair));
        }
        let markers = [c.marker(markers.0, name)?, c.marker(markers.1, name)?];
        let (hook, n) = (self.scene.hooks.len(), TOUCHES * TOUCH_NUMBERS);
        let places: Vec<usize> = (0..n)
            .map(|k| self.supply(Supplied::Hook(hook, k)))
            .collect();
        self.scene.hooks.push(SceneHook {
            kind: HookKind::Touches {
                solids: Box::new(solids),
                markers,
            },
            element: name.to_string(),
            constants: Vec::new(),
            n,
            place: places[0],
            output_only: false,
        });
        Some(Touching::Query(places[0]))
    }

    /// The pairs of a contact with the markers of their solids.
    fn pairs(&self, contact: &Contact) -> Result<Vec<(u32, u32, [Solid; 2])>, String> {
        if contact.flip != [false; 2] {
            return Err("IFLIP and JFLIP, which turn a solid inside out, are not solved".into());
        }
        let find = |ids: &[u32]| -> Result<Vec<(u32, Placed)>, String> {
            let one = |&id: &u32| {
                let graphics = self.model.graphics.get(&id);
                let graphics = graphics.ok_or(format!("GRAPHICS/{id} does not exist"))?;
                let placed =
                    solid(&graphics.shape).map_err(|why| format!("GRAPHICS/{id} {why}"))?;
                if is_degenerate(&placed.solid) {
                    return Err(format!("GRAPHICS/{id} has no size"));
                }
                Ok((id, placed))
            };
            ids.iter().map(one).collect()
        };
        let (all_i, all_j) = (find(&contact.i_geometry)?, find(&contact.j_geometry)?);
        let mut out = Vec::new();
        for (gi, i) in &all_i {
            for (gj, j) in &all_j {
                let queried = i.solid.can_be_queried() && j.solid.can_be_queried();
                let solved = Pair::of(&i.solid, &j.solid).is_some()
                    || (queried && cfg!(feature = "geometry"));
                if !solved {
                    let why = if queried {
                        " in this program: it was built without the feature geometry"
                    } else {
                        ""
                    };
                    return Err(format!(
                        "there is no contact between a {} (GRAPHICS/{gi}) and a {} (GRAPHICS/{gj}){why}",
                        i.solid.name(),
                        j.solid.name()
                    ));
                }
                out.push((i.marker, j.marker, [i.solid.clone(), j.solid.clone()]));
            }
        }
        Ok(out)
    }

    /// The law of a contact.
    fn law(&mut self, name: &str, contact: &Contact) -> Result<Law, String> {
        let fit = |what: &str, x: f64| {
            if x.is_finite() && x >= 0.0 {
                Ok(x)
            } else {
                Err(format!("{what} must not be negative"))
            }
        };
        let mut approximate = Vec::new();
        let normal = match contact.law {
            ContactLaw::Poisson => {
                let weight = self.scene.gravity.norm() * self.scene.length;
                let fall = if weight > 0.0 {
                    weight.sqrt()
                } else {
                    self.scene.length
                };
                approximate.push("POISSON: forces within an impact are those of a spring that is softer on the way back");
                Normal::Poisson {
                    penalty: fit("PENALTY", contact.penalty)?,
                    restitution: fit("RESTITUTION_COEFFICIENT", contact.restitution)?,
                    smoothing: SMOOTHING * fall,
                }
            }
            ContactLaw::Impact | ContactLaw::User => Normal::Impact {
                stiffness: fit("STIFFNESS", contact.stiffness)?,
                exponent: fit("EXPONENT", contact.exponent)?,
                damping: fit("DAMPING", contact.damping)?,
                full_damping_depth: fit("DMAX", contact.dmax)?,
            },
        };
        let friction = if contact.friction == CoulombFriction::Off {
            None
        } else {
            let coulomb = Coulomb {
                mu_static: fit("MU_STATIC", contact.mu_static)?,
                mu_dynamic: fit("MU_DYNAMIC", contact.mu_dynamic)?,
                stiction_velocity: contact.stiction_transition_velocity,
                friction_velocity: contact.friction_transition_velocity,
            };
            if !(coulomb.stiction_velocity > 0.0 && coulomb.stiction_velocity.is_finite()) {
                return Err("friction needs a positive STICTION_TRANSITION_VELOCITY".into());
            }
            if coulomb.friction_velocity.is_nan()
                || coulomb.friction_velocity <= coulomb.stiction_velocity
            {
                return Err(
                    "FRICTION_TRANSITION_VELOCITY must be larger than STICTION_TRANSITION_VELOCITY"
                        .into(),
                );
            }
            if contact.stiction {
                approximate.push("STICTION: what should stick creeps, as without it");
            }
            Some(coulomb)
        };
        if contact.augmented_lagrangian {
            approximate.push("AUGMENTED_LAGRANGIAN_FORMULATION: the plain law is used, bodies overlap as the stiffness permits");
        }
        for what in approximate {
            let warning = Diagnostic::warning("approximate", what).element(name);
            self.scene.warnings.push(warning);
        }
        Ok(Law { normal, friction })
    }
}
