//! CONTACT statements: which solids, which formula for each pair, which law.

use super::asker::Asker;
use super::build::Builder;
use super::compile::Compiler;
use super::external_inputs::{HookKind, closure_of};
use super::forces::{ContactForce, ForceLaw, Touched, Touching};
use super::left_out::Reason;
use super::tunnelling::ThicknessBound;
use super::untouchable::{NoPair, Untouchable};
use crate::diagnostic::{Cause, Diagnostic, counted};
use crate::model::{Contact, ContactLaw, CoulombFriction, Element, ElementId, ElementKind, Shape};
use crate::physics::contact::extent::Extent;
use crate::physics::contact::law::{Coulomb, Law, Normal};
use crate::physics::contact::outline::{Outline, Rim};
use crate::physics::contact::{Pair, Question, Solid, TOUCH_NUMBERS};
use crate::scalar::Scalar;
use crate::space::MarkerState;
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Planes of curves count as one below this sine of the angle between them.
const COPLANAR_SINE: f64 = 1e-6;
/// Small speed that makes POISSON smooth, as a part of the speed of a fall through the mechanism's
/// own size.
const POISSON_SMOOTHING_SPEED: f64 = 1e-3;

/// The convex hull of the points of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Shell {
    /// as the dataset names it
    pub file: String,
    /// how many points it holds
    pub points: usize,
    /// those that make the hull
    pub corners: Vec<[f64; 3]>,
    /// how far points lie outside the hull of the corners, where these would be too many
    pub outside: f64,
}

/// A solid and the marker in whose frame it stands.
struct Placed {
    marker: u32,
    solid: Solid,
}

/// The shape that a GRAPHICS of a contact has.
enum Body {
    Solid(Placed),
    /// a plane curve in the frame of a marker
    Outline(u32, Arc<Outline>),
}

/// Two bodies of a contact with their markers, and how their touches are found.
struct Couple {
    markers: [u32; 2],
    /// none of a plane
    extents: [Option<Extent>; 2],
    how: How,
}

enum How {
    Formula(Pair),
    Question(Question),
}

fn ascending(a: f64, b: f64) -> [f64; 2] {
    [a.min(b), a.max(b)]
}

/// The part that a GRAPHICS plays in a contact.
fn solid(graphics: ElementId, shape: &Shape) -> Result<Placed, Untouchable> {
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
        Shape::External { .. } | Shape::Shell { .. } => {
            unreachable!("it is the hull of what its file holds")
        }
        Shape::Circle { .. } | Shape::Arc { .. } | Shape::Curve { .. } => {
            unreachable!("it is an outline")
        }
        Shape::Other(ref kind) => Err(Untouchable::Drawn {
            graphics,
            shape: kind.clone(),
        }),
        Shape::Nothing => Err(Untouchable::NoShape(graphics)),
    }
}

/// Returns the solid of a GRAPHICS and the marker in whose frame it stands; `None`: it is a curve,
/// a drawing, or stands in a file.
pub fn solid_of(graphics: ElementId, shape: &Shape) -> Option<(u32, Solid)> {
    match shape {
        Shape::Box { .. }
        | Shape::Cylinder { .. }
        | Shape::Frustum { .. }
        | Shape::Ellipsoid { .. }
        | Shape::Torus { .. }
        | Shape::Plane { .. }
        | Shape::Point { .. } => {
            let placed = solid(graphics, shape).ok()?;
            (!is_degenerate(&placed.solid)).then_some((placed.marker, placed.solid))
        }
        Shape::Circle { .. }
        | Shape::Arc { .. }
        | Shape::Curve { .. }
        | Shape::External { .. }
        | Shape::Shell { .. }
        | Shape::Other(_)
        | Shape::Nothing => None,
    }
}

/// Returns true if a solid has no size.
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

/// A curve as the rim of a solid; `None`: it has no length.
fn outline(marker: u32, rim: Rim, flipped: bool) -> Option<Body> {
    Outline::new(rim, flipped).map(|o| Body::Outline(marker, Arc::new(o)))
}

impl Body {
    fn marker(&self) -> u32 {
        match self {
            Body::Solid(placed) => placed.marker,
            Body::Outline(marker, _) => *marker,
        }
    }
    fn name(&self) -> &'static str {
        match self {
            Body::Solid(placed) => placed.solid.name(),
            Body::Outline(..) => "curve",
        }
    }
    fn extent(&self) -> Option<Extent> {
        match self {
            Body::Solid(placed) => Extent::of(&placed.solid),
            Body::Outline(_, outline) => Some(Extent::of_outline(outline)),
        }
    }
    /// As a curve, or the point that can touch one.
    fn as_outline(&self) -> Option<Arc<Outline>> {
        match self {
            Body::Outline(_, outline) => Some(outline.clone()),
            Body::Solid(Placed {
                solid: Solid::Ball { radius: 0.0 },
                ..
            }) => Outline::new(Rim::Point, false).map(Arc::new),
            Body::Solid(_) => None,
        }
    }
}

/// Chooses the way in which the touches of two bodies are found.
///
/// # Errors
/// Why they are not.
fn how(i: &Body, j: &Body) -> Result<How, NoPair> {
    let [a, b] = match (i, j) {
        (Body::Solid(a), Body::Solid(b)) => [&a.solid, &b.solid],
        _ => {
            if let (Some(i), Some(j)) = (i.as_outline(), j.as_outline()) {
                return Ok(How::Question(Question::Outlines([i, j])));
            }
            let question = match (i, j) {
                (Body::Outline(_, outline), Body::Solid(s)) => {
                    Question::curve(outline, &s.solid, false)
                }
                (Body::Solid(s), Body::Outline(_, outline)) => {
                    Question::curve(outline, &s.solid, true)
                }
                _ => None,
            };
            return question.map(How::Question).ok_or(NoPair::NoGeometry);
        }
    };
    match (a, b) {
        (Solid::Plane { .. }, Solid::Plane { .. }) => {
            return Err(NoPair::Planes);
        }
        (Solid::Ball { radius: 0.0 }, Solid::Ball { radius: 0.0 }) => {
            return Err(NoPair::Points);
        }
        _ => {}
    }
    if let Some(pair) = Pair::of(a, b) {
        return Ok(How::Formula(pair));
    }
    if cfg!(feature = "geometry") && a.can_be_queried() && b.can_be_queried() {
        let solids = Box::new([a.clone(), b.clone()]);
        return Ok(How::Question(Question::Solids(solids)));
    }
    Question::wire(a, b)
        .map(How::Question)
        .ok_or(NoPair::NoGeometry)
}

impl Builder<'_> {
    /// CONTACT: a force element for each pair of its solids.
    pub(super) fn contacts(&mut self, c: &mut Compiler, skipped: &BTreeSet<ElementKind>) {
        let model = self.model;
        for (id, contact) in model.active(ElementKind::Contact, &model.contacts) {
            let name = ElementKind::Contact.id(id);
            let Ok(closures) = self.closures(c, name, contact) else {
                continue;
            };
            match self.couples(c, contact) {
                Ok(couples) => {
                    let law = match self.law(name, contact) {
                        Ok(law) => law,
                        Err(why) => {
                            c.error(name, why);
                            continue;
                        }
                    };
                    for Couple {
                        markers,
                        extents,
                        how,
                    } in couples
                    {
                        let [i, j] = markers.map(|m| c.marker(m, name));
                        if let ([Some(a), Some(b)], Some(i), Some(j)) = (extents, i, j) {
                            let outlines = matches!(how, How::Question(Question::Outlines(_)));
                            let reach = ThicknessBound::new([i, j], [a, b], outlines);
                            self.scene.thickness_bounds.push(reach);
                        }
                        let touching = match how {
                            How::Formula(pair) => Touching::Formula(pair),
                            How::Question(q) => match self.asked(c, name, markers, q) {
                                Some(touching) => touching,
                                None => continue,
                            },
                        };
                        let (Some(i), Some(j)) = (i, j) else {
                            continue;
                        };
                        let both = (touching, law);
                        let force = self.pressed(c, (name, contact), [i, j], both, closures);
                        let law = ForceLaw::Contact(Box::new(force));
                        self.between(c, name, (markers[0], markers[1]), law);
                    }
                }
                Err(why) if skipped.contains(&ElementKind::Contact) => {
                    self.leave_out(name, &Reason::Contact(why));
                }
                Err(why) => {
                    let help = "--skip-unsupported CONTACT leaves out the contacts that cannot be solved; the results are then those of another model";
                    let error =
                        Diagnostic::error(Cause::Unsupported, why.to_string()).element(name);
                    c.errors.push(error.help(help));
                }
            }
        }
    }

    /// Touches that are found by a question; `None`: a marker is missing, which has been said, or
    /// the planes of two curves do not lie in each other.
    fn asked(
        &mut self,
        c: &mut Compiler,
        name: ElementId,
        ids: [u32; 2],
        question: Question,
    ) -> Option<Touching> {
        let markers = [c.marker(ids[0], name)?, c.marker(ids[1], name)?];
        if let Question::Outlines(_) = question {
            let [i, j] = markers.map(|m| self.scene.drawn(m).rotation.column(2));
            let sine = i.cross(j).norm();
            if sine > COPLANAR_SINE {
                let what = format!(
                    "the planes of its curves are inclined to each other by {:.4} deg: the x-y planes of {} and {}",
                    Scalar::asin(sine.min(1.0)).to_degrees(),
                    ElementKind::Marker.id(ids[0]),
                    ElementKind::Marker.id(ids[1])
                );
                let error = Diagnostic::error("curves_not_coplanar", what).element(name);
                c.errors.push(error.help(
                    "curves touch in one plane: turn one of these markers, and let joints hold their x-y planes together",
                ));
                return None;
            }
        }
        let n = question.touches() * TOUCH_NUMBERS;
        let kind = HookKind::Touches { question, markers };
        Some(Touching::Query(self.asked_of(kind, name, &[], n)))
    }

    /// Closures that compute forces of a contact: along the normal, and across it.
    ///
    /// # Errors
    /// That there is none for a USER; it has been said, or the contact is left out.
    fn closures(
        &mut self,
        c: &mut Compiler,
        name: ElementId,
        contact: &Contact,
    ) -> Result<[Option<usize>; 2], ()> {
        let users = contact.formulas();
        let mut found = [None; 2];
        for (argument, user) in users {
            let Some(closure) = closure_of(self.hooks, name, argument, user) else {
                if self.zero_user {
                    self.leave_out(name, &Reason::Routine);
                    return Err(());
                }
                let what =
                    format!("{argument}=USER needs a routine that is not part of the dataset");
                let d = Diagnostic::error(Cause::UserRoutine, what);
                c.errors.push(d.element(name).help(
                    "load the library that has it (--routines), give it an IMPACT or POISSON law, or leave it out with whatever else USER would compute (--zero-user)",
                ));
                return Err(());
            };
            found[usize::from(argument != "FUNCTION")] = Some(closure);
        }
        Ok(found)
    }

    /// The force of a couple of bodies: its law, and the numbers that closures compute instead.
    fn pressed(
        &mut self,
        c: &mut Compiler,
        (name, contact): (ElementId, &Contact),
        markers: [usize; 2],
        (touching, law): (Touching, Law),
        closures: [Option<usize>; 2],
    ) -> ContactForce {
        let touches = match &touching {
            Touching::Query(places) => places.len() / TOUCH_NUMBERS,
            Touching::Formula(pair) => {
                let [i, j] = markers.map(|m| MarkerState::at_rest(self.scene.drawn(m)));
                pair.touches(&i, &j).len()
            }
        };
        let mut force = ContactForce {
            touching,
            law,
            normal: 0..0,
            friction: 0..0,
        };
        let users = [&contact.function, &contact.friction_function];
        for (slips, closure) in [false, true].into_iter().zip(closures) {
            let (Some(closure), Some(user)) = (closure, users[usize::from(slips)]) else {
                continue;
            };
            let argument = if slips {
                "FRICTION_FUNCTION"
            } else {
                "FUNCTION"
            };
            let inputs = self.inputs_of(c, &Asker::argument(name, argument), closure);
            let kind = HookKind::Touched(Box::new(Touched {
                closure,
                inputs,
                markers,
                force: force.clone(),
                slips,
            }));
            let n = if slips { 3 * touches } else { touches };
            let places = self.asked_of(kind, name, user.user_numbers(), n);
            match slips {
                true => force.friction = places,
                false => force.normal = places,
            }
        }
        force
    }

    /// Tells what of a shell is not as it is drawn.
    fn told_of_hull(&mut self, id: u32, shell: &Shell) {
        let Shell {
            file,
            points,
            corners,
            outside,
        } = shell;
        let mut what = format!(
            "the convex hull of {file:?} touches, {} of {points} points: hollows are filled",
            counted(corners.len(), "corner")
        );
        if *outside > 0.0 {
            what += &format!("; the shell stands out of it by {outside:.3e} at most");
        }
        let warning =
            Diagnostic::warning("convex_hull", what).element(ElementKind::Graphics.id(id));
        if !self.scene.warnings.contains(&warning) {
            self.scene.warnings.push(warning);
        }
    }

    /// The bodies of one side of a contact, with the numbers of their GRAPHICS.
    fn bodies(
        &mut self,
        c: &mut Compiler,
        ids: &[u32],
        flipped: bool,
    ) -> Result<Vec<(ElementId, Body)>, Untouchable> {
        let shells = self.shells;
        let mut out = Vec::new();
        for &id in ids {
            let (name, graphics) = (ElementKind::Graphics.id(id), self.model.graphics.get(&id));
            let shape = &graphics.ok_or(Untouchable::Missing(name))?.shape;
            let body = match *shape {
                Shape::Circle { cm, radius } => {
                    outline(cm, Rim::Circle(radius.abs(), TAU), flipped)
                }
                Shape::Arc { cm, radius, angle } => {
                    // against the turn is the way back
                    let rim = Rim::Circle(radius.abs(), angle.abs().min(TAU));
                    (angle >= 0.0).then(|| outline(cm, rim, flipped)).flatten()
                }
                Shape::Curve { curve, rm } => {
                    let path = self.path(c, curve);
                    let path = path.ok_or(Untouchable::NoCurve(name))?;
                    if path.height > 1e-9 * path.length {
                        return Err(Untouchable::NotPlane {
                            curve: ElementKind::Curve.id(curve),
                            graphics: name,
                            height: path.height,
                        });
                    }
                    outline(rm, Rim::Path(Box::new(path)), flipped)
                }
                Shape::External { rm, ref file, .. } | Shape::Shell { rm, ref file } => {
                    let shell = match shells.get(&id) {
                        Some(Ok(shell)) => shell,
                        Some(Err(why)) => {
                            return Err(Untouchable::NotRead {
                                graphics: name,
                                why: why.clone(),
                            });
                        }
                        None => {
                            return Err(Untouchable::NotAsked {
                                graphics: name,
                                file: file.clone(),
                            });
                        }
                    };
                    self.told_of_hull(id, shell);
                    let solid = Solid::Hull(shell.corners.clone());
                    Some(Body::Solid(Placed { marker: rm, solid }))
                }
                _ => {
                    let placed = solid(name, shape)?;
                    let sized = !is_degenerate(&placed.solid);
                    sized.then_some(Body::Solid(placed))
                }
            };
            let body = body.ok_or(Untouchable::NoSize(name))?;
            if flipped && !matches!(body, Body::Outline(..)) {
                return Err(Untouchable::FlippedSolid(name));
            }
            out.push((name, body));
        }
        Ok(out)
    }

    /// The pairs of a contact.
    fn couples(&mut self, c: &mut Compiler, contact: &Contact) -> Result<Vec<Couple>, Untouchable> {
        let all_i = self.bodies(c, &contact.i_geometry, contact.flip[0])?;
        let all_j = self.bodies(c, &contact.j_geometry, contact.flip[1])?;
        let mut out = Vec::new();
        for (gi, i) in &all_i {
            for (gj, j) in &all_j {
                let how = how(i, j).map_err(|why| Untouchable::NoPair {
                    i: (i.name(), *gi),
                    j: (j.name(), *gj),
                    why,
                })?;
                out.push(Couple {
                    markers: [i.marker(), j.marker()],
                    extents: [i.extent(), j.extent()],
                    how,
                });
            }
        }
        Ok(out)
    }

    /// The law of a contact.
    fn law(&mut self, name: ElementId, contact: &Contact) -> Result<Law, String> {
        let fit = |what: &str, x: f64| {
            if x.is_finite() && x >= 0.0 {
                Ok(x)
            } else {
                Err(format!("{what} must not be negative"))
            }
        };
        let mut approximate = Vec::new();
        let (stiffness, what) = match contact.law {
            ContactLaw::Poisson => (contact.penalty, "PENALTY"),
            ContactLaw::Impact | ContactLaw::User => (contact.stiffness, "STIFFNESS"),
        };
        let missing = (contact.law == ContactLaw::Impact).then(|| contact.missing());
        if let Some(missing) = missing.unwrap_or_default().first() {
            return Err(missing.to_string());
        }
        if stiffness == 0.0 && contact.law != ContactLaw::User {
            return Err(format!(
                "without a {what} larger than 0 nothing keeps its bodies apart"
            ));
        }
        let normal = match contact.law {
            ContactLaw::Poisson => {
                let weight = self.scene.gravity.norm() * self.scene.size;
                let fall = if weight > 0.0 {
                    weight.sqrt()
                } else {
                    self.scene.size
                };
                approximate.push("POISSON: forces within an impact are those of a spring that is softer on the way back");
                Normal::Poisson {
                    penalty: fit("PENALTY", contact.penalty)?,
                    restitution: fit("RESTITUTION_COEFFICIENT", contact.restitution)?,
                    smoothing: POISSON_SMOOTHING_SPEED * fall,
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
            let warning = Diagnostic::warning(Cause::Approximate, what).element(name);
            self.scene.warnings.push(warning);
        }
        Ok(Law { normal, friction })
    }
}
