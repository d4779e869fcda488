//! Between coordinates and physics: outward, coordinates become poses, twists and accelerations of
//! links; inward, wrenches and inertia become one equation per coordinate, and composite inertia
//! becomes the mass matrix.
//!
//! Quantities of a link are expressed in the link's own axes, where its inertia is constant; only
//! poses are in ground. With `R` the rotation link → parent, `p` the link's origin in the parent,
//! `e` the axis of its motion:
//!
//! ```text
//! ω  = Rᵀ ω_P + e q̇                                         turn
//! v  = Rᵀ (v_P + ω_P × p) + e q̇                             slide
//! α  = Rᵀ α_P + ω × e q̇ + e q̈                               turn
//! a  = Rᵀ (a_P + α_P × p + ω_P × (ω_P × p)) + 2 ω × e q̇ + e q̈   slide
//! ```
//!
//! Source: Featherstone, *Rigid Body Dynamics Algorithms*, chapters 5 and 6, written in
//! three-vectors.

use super::{LinkIx, LinkMotion, MarkerOnLink, Scene, Source};
use crate::scalar::{Jet, Scalar};
use crate::space::{Frame, MarkerState, Mat3, Vec3, rotation};

/// Force and torque on a link about its origin, in its axes.
#[derive(Clone, Copy, Debug)]
pub struct Wrench<S> {
    /// force
    pub force: Vec3<S>,
    /// torque about the origin
    pub torque: Vec3<S>,
}

impl<S: Scalar> Wrench<S> {
    /// No load.
    pub fn zero() -> Self {
        Self {
            force: Vec3::zero(),
            torque: Vec3::zero(),
        }
    }

    fn is_known_zero(&self) -> bool {
        let mut all = self.force.0.iter().chain(&self.torque.0);
        all.all(Scalar::is_known_zero)
    }
}

/// Pose, velocity and acceleration of a link.
#[derive(Clone, Copy, Debug)]
pub struct LinkState<S> {
    /// pose in the parent
    pub X_PL: Frame<S>,
    /// pose in ground
    pub X_GL: Frame<S>,
    /// angular velocity, link axes
    pub w: Vec3<S>,
    /// velocity of the origin, link axes
    pub v: Vec3<S>,
    /// angular acceleration, link axes
    pub alpha: Vec3<S>,
    /// acceleration of the origin, link axes
    pub a: Vec3<S>,
}

impl<S: Scalar> LinkState<S> {
    /// Ground, which stands still.
    fn ground() -> Self {
        Self {
            X_PL: Frame::identity(),
            X_GL: Frame::identity(),
            w: Vec3::zero(),
            v: Vec3::zero(),
            alpha: Vec3::zero(),
            a: Vec3::zero(),
        }
    }
}

/// Values, rates and accelerations of the coordinates   (per coordinate; a ball's value is unused)
pub struct Coordinates<'a, S> {
    /// positions   (n_q)
    pub q: &'a [S],
    /// velocities   (n_v)
    pub v: &'a [S],
    /// accelerations   (n_v); empty = zero
    pub vdot: &'a [S],
    /// prescribed coordinates, by motion
    pub driven: &'a [Jet<S>],
}

impl<S: Scalar> Coordinates<'_, S> {
    /// Value, rate and acceleration of one coordinate.
    pub fn of(&self, source: Source) -> Jet<S> {
        match source {
            Source::Driven(m) => self.driven[m],
            Source::Free { q, v } => Jet::new(
                self.q.get(q).copied().unwrap_or_else(S::zero),
                self.v[v],
                self.vdot.get(v).copied().unwrap_or_else(S::zero),
            ),
        }
    }
}

/// Poses, twists and accelerations of all links, carriers first.
pub fn outward<S: Scalar>(scene: &Scene, at: &Coordinates<'_, S>) -> Vec<LinkState<S>> {
    let mut states: Vec<LinkState<S>> = Vec::with_capacity(scene.links.len());
    for link in &scene.links {
        let mut X_PL = Frame::constant(link.placement);
        if matches!(link.motion, LinkMotion::Rigid) {
            let parent = link.parent.map(|p| &states[p]);
            states.push(carried_rigidly(parent, X_PL));
            continue;
        }
        let parent = link.parent.map_or_else(LinkState::ground, |p| states[p]);
        let jet = |c: usize| at.of(scene.coordinates[c].source);
        let along = |axis: usize, x: S| {
            let mut e = Vec3::zero();
            e.0[axis] = x;
            e
        };
        let (mut w_own, mut v_own) = (Vec3::zero(), Vec3::zero());
        let (mut alpha_own, mut a_own) = (Vec3::zero(), Vec3::zero());
        match link.motion {
            LinkMotion::Rigid => unreachable!("a rigid link has no motion of its own"),
            LinkMotion::Slide {
                axis,
                sign,
                coordinate,
            } => {
                let x = jet(coordinate);
                X_PL.position += X_PL.rotation.apply(along(axis, x.value.scale(sign)));
                v_own = along(axis, x.first.scale(sign));
                a_own = along(axis, x.second.scale(sign));
            }
            LinkMotion::Turn {
                axis,
                sign,
                coordinate,
            } => {
                let x = jet(coordinate);
                X_PL.rotation = X_PL.rotation * rotation::about_axis(axis, x.value.scale(sign));
                w_own = along(axis, x.first.scale(sign));
                alpha_own = along(axis, x.second.scale(sign));
            }
            LinkMotion::Ball {
                coordinate,
                quaternion,
            } => {
                let q = [0, 1, 2, 3].map(|k| at.q[quaternion + k]);
                X_PL.rotation = X_PL.rotation * rotation::from_quaternion(q);
                let x = [jet(coordinate), jet(coordinate + 1), jet(coordinate + 2)];
                w_own = Vec3(x.map(|j| j.first));
                alpha_own = Vec3(x.map(|j| j.second));
            }
        }
        let p = X_PL.position;
        let w = X_PL.rotation.apply_transposed(parent.w) + w_own;
        let v = X_PL.rotation.apply_transposed(parent.v + parent.w.cross(p)) + v_own;
        let alpha = X_PL.rotation.apply_transposed(parent.alpha) + w.cross(w_own) + alpha_own;
        let carried = parent.a + parent.alpha.cross(p) + parent.w.cross(parent.w.cross(p));
        let coriolis = w.cross(v_own).times(S::constant(2.0));
        let a = X_PL.rotation.apply_transposed(carried) + coriolis + a_own;
        states.push(LinkState {
            X_PL,
            X_GL: parent.X_GL.compose(&X_PL),
            w,
            v,
            alpha,
            a,
        });
    }
    states
}

/// The state of a link that its parent carries at a place for ever; `None`: that is ground.
fn carried_rigidly<S: Scalar>(parent: Option<&LinkState<S>>, X_PL: Frame<S>) -> LinkState<S> {
    let Some(parent) = parent else {
        let ground = LinkState::ground();
        return LinkState {
            X_PL,
            X_GL: ground.X_GL.compose(&X_PL),
            ..ground
        };
    };
    let (R, p) = (X_PL.rotation, X_PL.position);
    let nothing = Vec3::zero();
    let carried = parent.a + parent.alpha.cross(p) + parent.w.cross(parent.w.cross(p));
    LinkState {
        X_PL,
        X_GL: parent.X_GL.compose(&X_PL),
        w: R.apply_transposed(parent.w) + nothing,
        v: R.apply_transposed(parent.v + parent.w.cross(p)) + nothing,
        alpha: R.apply_transposed(parent.alpha) + nothing,
        a: R.apply_transposed(carried) + nothing,
    }
}

/// Pose of a marker in ground.
pub fn marker_frame<S: Scalar>(marker: &MarkerOnLink, states: &[LinkState<S>]) -> Frame<S> {
    let frame = Frame::constant(marker.frame);
    marker
        .link
        .map_or(frame, |l| states[l].X_GL.compose(&frame))
}

/// Pose, velocity and acceleration of a marker in ground axes.
pub fn marker_state<S: Scalar>(marker: &MarkerOnLink, states: &[LinkState<S>]) -> MarkerState<S> {
    let frame = Frame::constant(marker.frame);
    let Some(l) = marker.link else {
        return MarkerState {
            R_GM: frame.rotation,
            p_GM: frame.position,
            ..MarkerState::ground()
        };
    };
    let s = &states[l];
    let p = frame.position;
    let X_GM = s.X_GL.compose(&frame);
    let turn = |x: Vec3<S>| s.X_GL.rotation.apply(x);
    MarkerState {
        R_GM: X_GM.rotation,
        p_GM: X_GM.position,
        w_GM: turn(s.w),
        v_GM: turn(s.v + s.w.cross(p)),
        alpha_GM: turn(s.alpha),
        a_GM: turn(s.a + s.alpha.cross(p) + s.w.cross(s.w.cross(p))),
    }
}

/// Adds a force at a point and a torque, both in ground axes, to the wrench of a link.
pub fn apply<S: Scalar>(
    wrenches: &mut [Wrench<S>],
    states: &[LinkState<S>],
    link: LinkIx,
    point: Vec3<S>,
    force: Vec3<S>,
    torque: Vec3<S>,
) {
    let Some(l) = link else { return };
    let X = &states[l].X_GL;
    wrenches[l].force += X.rotation.apply_transposed(force);
    wrenches[l].torque += X
        .rotation
        .apply_transposed(torque + (point - X.position).cross(force));
}

/// Returns the wrench that each link's carrier must exert on it: inertia force − gravity − applied
/// wrench, summed inward.
///
/// `gravity` in ground axes. The component along a free coordinate is the left side of its equation
/// of motion; the rest is the reaction of the joint, about the link's origin, in the link's axes.
pub fn inward<S: Scalar>(
    scene: &Scene,
    states: &[LinkState<S>],
    gravity: Vec3<S>,
    applied: &[Wrench<S>],
) -> Vec<Wrench<S>> {
    let mut carried: Vec<Wrench<S>> = scene
        .links
        .iter()
        .zip(states)
        .zip(applied)
        .map(|((link, s), load)| {
            if link.is_massless() {
                return Wrench {
                    force: Vec3::zero() - load.force,
                    torque: Vec3::zero() - load.torque,
                };
            }
            let m = S::constant(link.mass);
            let mc = Vec3::constant(link.moment);
            let inertia = Mat3::constant(link.inertia);
            let a = s.a - s.X_GL.rotation.apply_transposed(gravity);
            let force = a.times(m) + s.alpha.cross(mc) + s.w.cross(s.w.cross(mc));
            let torque = inertia.apply(s.alpha) + s.w.cross(inertia.apply(s.w)) + mc.cross(a);
            Wrench {
                force: force - load.force,
                torque: torque - load.torque,
            }
        })
        .collect();
    gather(scene, states, &mut carried);
    carried
}

/// Adds to the wrench of each link those of all that it carries.
pub fn gather<S: Scalar>(scene: &Scene, states: &[LinkState<S>], wrenches: &mut [Wrench<S>]) {
    for l in (0..scene.links.len()).rev() {
        if let Some(p) = scene.links[l].parent
            && !wrenches[l].is_known_zero()
        {
            let up = to_parent(&states[l].X_PL, wrenches[l]);
            wrenches[p].force += up.force;
            wrenches[p].torque += up.torque;
        }
    }
}

/// The same wrench, about the parent's origin in the parent's axes.
pub fn to_parent<S: Scalar>(X_PL: &Frame<S>, w: Wrench<S>) -> Wrench<S> {
    let force = X_PL.rotation.apply(w.force);
    Wrench {
        force,
        torque: X_PL.rotation.apply(w.torque) + X_PL.position.cross(force),
    }
}

/// One scalar freedom of the forest: a free coordinate, or a third of a ball.
#[derive(Clone, Copy, Debug)]
pub struct Freedom {
    /// link it moves
    pub link: usize,
    /// axis in the link's frame
    pub axis: usize,
    /// rotation rather than translation
    pub turn: bool,
    /// 1 or −1
    pub sign: f64,
    /// place in v; `None` when a motion drives it
    pub v: Option<usize>,
    /// a third of a ball
    pub in_ball: bool,
}

impl Freedom {
    /// `S · wrench`: the component of a wrench (of the link) along this freedom.
    pub fn component<S: Scalar>(&self, w: &Wrench<S>) -> S {
        let v = if self.turn { w.torque } else { w.force };
        v.0[self.axis].scale(self.sign)
    }
}

/// Composite inertia of each link with all it carries, and from it the mass matrix.
///
/// Returned by rows of freedoms: `rows[i]` = (j, M_ij) for every freedom j that is i or carries i,
/// nearest first.
pub fn mass_matrix<S: Scalar>(scene: &Scene, states: &[LinkState<S>]) -> Vec<Vec<(usize, S)>> {
    let n = scene.links.len();
    let mut mass: Vec<S> = scene.links.iter().map(|l| S::constant(l.mass)).collect();
    let mut moment: Vec<Vec3<S>> = scene
        .links
        .iter()
        .map(|l| Vec3::constant(l.moment))
        .collect();
    let mut inertia: Vec<Mat3<S>> = scene
        .links
        .iter()
        .map(|l| Mat3::constant(l.inertia))
        .collect();
    let idle = scene.idle_links();
    for l in (0..n).rev() {
        let Some(parent) = scene.links[l].parent.filter(|_| !idle[l]) else {
            continue;
        };
        let X = &states[l].X_PL;
        let (R, p) = (X.rotation, X.position);
        let c = R.apply(moment[l]);
        let turned = R * inertia[l] * R.transpose();
        let pp = p.norm2() * mass[l] + c.dot(p).scale(2.0);
        let shift = Mat3(std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let off = p.0[i] * p.0[j] * mass[l] + c.0[i] * p.0[j] + p.0[i] * c.0[j];
                if i == j { pp - off } else { -off }
            })
        }));
        inertia[parent] = inertia[parent] + turned + shift;
        moment[parent] += c + p.times(mass[l]);
        let m = mass[l];
        mass[parent] += m;
    }
    let mut rows = Vec::with_capacity(scene.freedoms.len());
    for (i, f) in scene.freedoms.iter().enumerate() {
        let e = Vec3::axis(f.axis).times(S::constant(f.sign));
        let l = f.link;
        let mut w = if f.turn {
            Wrench {
                force: e.cross(moment[l]),
                torque: inertia[l].apply(e),
            }
        } else {
            Wrench {
                force: e.times(mass[l]),
                torque: moment[l].cross(e),
            }
        };
        let mut row = Vec::new();
        let mut link = l;
        let mut j = Some(i);
        while let Some(k) = j {
            let g = &scene.freedoms[k];
            while link != g.link {
                w = to_parent(&states[link].X_PL, w);
                match scene.links[link].parent {
                    Some(p) => link = p,
                    None => unreachable!("a carrying freedom is on a carrying link"),
                }
            }
            row.push((k, g.component(&w)));
            j = scene.carrier[k];
        }
        rows.push(row);
    }
    rows
}
