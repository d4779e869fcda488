//! Branches: the turns that orientation rows still ask for, told from their opposites.
//!
//! A row that is a sine or a cosine holds at the opposite angle too, and does not change with the
//! angle a quarter turn away from where it holds. So assembly can end on the wrong branch, or not
//! move at all. Here the same rows are read as turns, which are zero on the right branch only:
//!
//! ```text
//! z_I.x_J, z_I.y_J, x_I.y_J   the rotation vector from I to J                       (1)
//! z_I.x_J, z_I.y_J            the shortest turn of z_I to z_J                       (2)
//! a_I.b_J                     the shortest turn of a_I to where it is square to b_J (3)
//! x_I.y_J − y_I.x_J           minus the twist of I about its z axis                 (4)
//! a driven angle              the angle that is missing, the short way              (5)
//! ```
//!
//! Motions of several body angles between the same markers drive a frame or an axis, as (1) or (2).
//! [`turn`] makes these turns together, with all other rows as they are, and moves parts as little
//! as may be; from there the rows themselves are closed. It is asked for only where the rows alone
//! have failed or have led to an opposite.

use crate::analysis::start::assemble::numbers;
use crate::analysis::start::initial_conditions::Wanted;
use crate::analysis::start::nearest::{Origin, nearest};
use crate::model::ElementId;
use crate::physics::action::Action;
use crate::physics::row::{Drive, Law, about_the_middle, body_angles};
use crate::scalar::{Scalar, hypot};
use crate::scene::configuration::{Configuration, Configured};
use crate::scene::equations::Equations;
use crate::scene::{ConstraintElement, RowKind, Scene};
use crate::space::{Frame, Mat3, Vec3, rotation};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// Turn that is left where rows hold on their branch, at most, in rad.
pub(super) const ON_BRANCH: f64 = 1e-2;
/// Turn that may be left where [`turn`] ends: the rows themselves do the rest. In rad.
const NEAR_BRANCH: f64 = 0.2;
/// Sine of the angle between axes below which their common normal is not read off them: numbers
/// typed with six digits make one up.
pub(super) const NO_NORMAL: f64 = 1e-3;
/// Part of its size that a driven angle keeps next to a singular position of the body angles.
const LEAST_SHARE: f64 = 0.1;
/// Cosine of β₂ below which β₁ cannot be read off.
const NO_DIRECTION: f64 = 1e-7;
/// Normals that are tried where two axes are opposite.
pub(super) const NORMALS: usize = 4;

/// A turn of marker I against J that an element still asks for.
#[derive(Clone, Debug)]
pub struct Turn {
    /// the element
    pub element: ElementId,
    /// its size, in rad
    pub left: f64,
    /// markers I and J
    pub markers: (usize, usize),
    /// axes in ground, and the angle about each in rad
    about: Vec<(Vec3<f64>, f64)>,
}

impl Turn {
    fn new(
        element: &ConstraintElement,
        markers: (usize, usize),
        about: Vec<(Vec3<f64>, f64)>,
    ) -> Self {
        let left = about.iter().map(|a| a.1 * a.1).sum::<f64>().sqrt();
        Self {
            element: element.id,
            left,
            markers,
            about,
        }
    }

    /// Returns its equations: the angles that are left, negative, and their slopes along the
    /// velocities.
    pub(super) fn equations(&self, at: &Equations<'_, f64>) -> Vec<(f64, Vec<(usize, f64)>)> {
        let (i, j) = self.markers;
        let about = self.about.iter();
        about
            .map(|&(axis, by)| (-by, at.gradient_of(&against(i, j, axis))))
            .collect()
    }

    /// Returns the turn as a rotation vector in ground.
    pub fn vector(&self) -> Vec3<f64> {
        let about = self.about.iter();
        about.fold(Vec3::zero(), |sum, (axis, by)| sum + axis.times(*by))
    }
}

/// Returns the frame of a marker.
fn frame(at: &Equations<'_, f64>, m: usize) -> Frame<f64> {
    let state = at.marker(m);
    Frame {
        rotation: state.R_GM,
        position: state.p_GM,
    }
}

/// Returns the short way from one angle to another.
pub(super) fn short_way(by: f64) -> f64 {
    (by + PI).rem_euclid(TAU) - PI
}

/// Returns the turn that the orientation rows of a tie ask for; `None` where it has none.
/// `normal`: which of `NORMALS` is taken where axes are opposite.
pub fn of_tie(
    laws: &[Law],
    i: &Frame<f64>,
    j: &Frame<f64>,
    normal: usize,
) -> Option<Vec<(Vec3<f64>, f64)>> {
    let has = |law: Law| laws.contains(&law);
    let (I, J) = (&i.rotation, &j.rotation);
    if has(Law::Dot(2, 0)) && has(Law::Dot(2, 1)) {
        return Some(if has(Law::Dot(0, 1)) {
            whole(I, J)
        } else {
            aligned(I.column(2), J.column(2), J, normal)
        });
    }
    laws.iter().find_map(|&law| match law {
        Law::Dot(a, b) => Some(square(I.column(a), J.column(b), J, normal)),
        Law::EqualDots => {
            let [w, _, _, z] = rotation::to_quaternion(&(J.transpose() * *I));
            Some(vec![(I.column(2), -short_way(2.0 * Scalar::atan2(z, w)))])
        }
        Law::Offset(_) | Law::Along(_) | Law::Angle | Law::BodyAngle { .. } => None,
    })
}

/// Returns the turn of a frame to another (1).
pub(super) fn whole(from: &Mat3<f64>, to: &Mat3<f64>) -> Vec<(Vec3<f64>, f64)> {
    let turn = rotation::vector(&(*to * from.transpose()));
    (0..3)
        .map(|k| (to.column(k), turn.dot(to.column(k))))
        .collect()
}

/// Returns the angle between two orientations, in rad.
pub(super) fn angle_between(a: &Mat3<f64>, b: &Mat3<f64>) -> f64 {
    rotation::vector(&(*b * a.transpose())).norm()
}

/// Returns the shortest turn of an axis to another (2), and none about the normal in between.
fn aligned(u: Vec3<f64>, v: Vec3<f64>, J: &Mat3<f64>, normal: usize) -> Vec<(Vec3<f64>, f64)> {
    let across = u.cross(v);
    let (sine, cosine) = (across.norm(), u.dot(v));
    let axis = if sine < NO_NORMAL && cosine < 0.0 || sine == 0.0 {
        normal_to(v, J, normal)
    } else {
        across.times(1.0 / sine)
    };
    vec![(axis, Scalar::atan2(sine, cosine)), (axis.cross(u), 0.0)]
}

/// Returns the shortest turn of an axis that makes it square to another (3).
fn square(u: Vec3<f64>, v: Vec3<f64>, J: &Mat3<f64>, normal: usize) -> Vec<(Vec3<f64>, f64)> {
    let across = u.cross(v);
    let (sine, cosine) = (across.norm(), u.dot(v));
    let axis = if sine < NO_NORMAL {
        normal_to(v, J, normal)
    } else {
        across.times(1.0 / sine)
    };
    vec![(axis, Scalar::atan2(sine, cosine) - FRAC_PI_2)]
}

/// Returns a normal of an axis, `k` eighths of a turn from that nearest to an axis of J.
fn normal_to(v: Vec3<f64>, J: &Mat3<f64>, k: usize) -> Vec3<f64> {
    let across = |k: usize| J.column(k) - v.times(J.column(k).dot(v));
    let first = (0..3).map(across).fold(across(0), |best, next| {
        if next.norm() > best.norm() + 1e-6 {
            next
        } else {
            best
        }
    });
    let first = first.times(1.0 / first.norm());
    let (s, c) = Scalar::sin_cos(FRAC_PI_4 * (2 * k % 4 + k / 2) as f64);
    first.times(c) + v.cross(first).times(s)
}

/// Returns the turns that all orientation rows of a configuration ask for.
pub fn turns(scene: Configured<'_>, at: &Equations<'_, f64>, normal: usize) -> Vec<Turn> {
    let mut found = Vec::new();
    for element in &scene.constraints {
        let rows = element.rows.clone().filter(|&r| !scene.is_held(r));
        let rows: Vec<_> = rows
            .filter_map(|r| match scene.rows[r].kind {
                RowKind::Markers { law, i, j, motion } => Some((law, (i, j), motion)),
                RowKind::Displacements(_) | RowKind::Formula { .. } | RowKind::Cam { .. } => None,
            })
            .collect();
        let Some(&(law, markers, motion)) = rows.first() else {
            continue;
        };
        let (I, J) = (frame(at, markers.0), frame(at, markers.1));
        match (law, motion) {
            (Law::Angle, Some(m)) => {
                let drive = at.row_drive(m).map(|x| x.value);
                let missing = short_way(drive.value - law.shown(&I, &J, drive));
                let about = vec![(J.rotation.column(2), missing)];
                found.push(Turn::new(element, markers, about));
            }
            (Law::BodyAngle { angle, .. }, Some(_)) => {
                let driven = driven_angles(scene, at, markers);
                // one turn for all motions between the markers
                if driven.iter().position(Option::is_some) == Some(angle) {
                    found.push(of_body_angles(element, markers, (&I, &J), driven, normal));
                }
            }
            _ => {
                let laws: Vec<Law> = rows.iter().map(|r| r.0).collect();
                if let Some(about) = of_tie(&laws, &I, &J, normal) {
                    found.push(Turn::new(element, markers, about));
                }
            }
        }
    }
    found
}

/// The drives of the body angles between two markers.
type Driven = [Option<Drive<f64>>; 3];

fn driven_angles(scene: Configured<'_>, at: &Equations<'_, f64>, wanted: (usize, usize)) -> Driven {
    let mut driven = [None; 3];
    for (r, row) in scene.rows.iter().enumerate() {
        if let RowKind::Markers {
            law: Law::BodyAngle { angle, .. },
            i,
            j,
            motion: Some(m),
        } = row.kind
            && (i, j) == wanted
            && !scene.is_held(r)
        {
            driven[angle] = driven[angle].or(Some(at.row_drive(m).map(|x| x.value)));
        }
    }
    driven
}

/// Returns the turn that motions of body angles between two markers ask for.
fn of_body_angles(
    element: &ConstraintElement,
    markers: (usize, usize),
    (i, j): (&Frame<f64>, &Frame<f64>),
    driven: Driven,
    normal: usize,
) -> Turn {
    let (I, J) = (&i.rotation, &j.rotation);
    let about = |k: usize, f: Drive<f64>| rotation::about_axis(k, f.value);
    let turn = |about| Turn::new(element, markers, about);
    match driven {
        [Some(a), Some(b), Some(c)] => {
            turn(whole(I, &(*J * about(0, a) * about(1, b) * about(2, c))))
        }
        [Some(a), Some(b), None] => {
            let z = (*J * about(0, a) * about(1, b)).column(2);
            turn(aligned(I.column(2), z, J, normal))
        }
        [None, Some(b), Some(c)] => {
            let x = (*I * (about(1, b) * about(2, c)).transpose()).column(0);
            turn(aligned(x, J.column(0), J, normal))
        }
        [Some(a), None, Some(c)] => {
            let y = (*I * about(2, c).transpose()).column(1);
            turn(aligned(y, (*J * about(0, a)).column(1), J, normal))
        }
        [a, b, c] => {
            let only = a
                .map(|f| (0, f))
                .or(b.map(|f| (1, f)))
                .or(c.map(|f| (2, f)));
            let (axis, missing, share) = only.map_or((Vec3::axis(0), 0.0, 0.0), |(angle, f)| {
                single(angle, f, i, j)
            });
            Turn {
                left: missing.abs(),
                ..turn(vec![(axis, share * missing)])
            }
        }
    }
}

/// Returns what one driven body angle misses (5): the axis about which the others stay, the angle,
/// and the part of it by which to turn there.
fn single(
    angle: usize,
    drive: Drive<f64>,
    i: &Frame<f64>,
    j: &Frame<f64>,
) -> (Vec3<f64>, f64, f64) {
    let law = Law::BodyAngle {
        angle,
        beside: None,
    };
    let missing = short_way(drive.value - law.shown(i, j, drive));
    let z = i.rotation.column(2);
    let at = |k: usize| j.rotation.column(k).dot(z);
    let cosine = hypot(at(1), at(2));
    // β₁, on the side of the reference where β₂ is driven
    let (mut s, mut c) = Scalar::sin_cos(drive.reference);
    if cosine > NO_DIRECTION {
        let side = if angle == 1 && at(2) * c - at(1) * s < 0.0 {
            -cosine
        } else {
            cosine
        };
        (s, c) = (-at(1) / side, at(2) / side);
    }
    let y = j.rotation.column(1).times(c) + j.rotation.column(2).times(s);
    let share = cosine.max(LEAST_SHARE);
    match angle {
        0 => (y.cross(z), missing, share),
        1 => (y, missing, 1.0),
        _ => (j.rotation.column(0).cross(y), missing, share),
    }
}

/// Lets a driven β₂ be read on the side where its markers stand: where they stand as `drawn`, that
/// of the two triples of body angles which hardly turns about the other axes; else that which the
/// motion drives, as far as its row holds.
pub fn refer(
    scene: &Scene,
    configuration: &mut Configuration,
    t: f64,
    q: &[f64],
    x: &[f64],
    drawn: bool,
) {
    let law = Law::BodyAngle {
        angle: 1,
        beside: None,
    };
    let read = scene.rows.iter().filter_map(|row| match row.kind {
        RowKind::Markers {
            law: own,
            i,
            j,
            motion: Some(m),
        } if own == law => Some((m, i, j)),
        _ => None,
    });
    let read: Vec<_> = read.collect();
    if read.is_empty() {
        return;
    }
    let here = scene.within(configuration);
    let at = Equations::new(here, &numbers(here, t, q, &vec![0.0; scene.layout.n_v], x));
    let mut found = Vec::new();
    for (m, i, j) in read {
        let (i, j, drive) = (
            frame(&at, i),
            frame(&at, j),
            at.row_drive(m).map(|x| x.value),
        );
        let z = i.rotation.column(2);
        let (y, x) = (-j.rotation.column(1).dot(z), j.rotation.column(2).dot(z));
        if hypot(y, x) < NO_DIRECTION {
            continue;
        }
        let (s, c) = Scalar::sin_cos(drive.reference);
        let driven = Scalar::cos(drive.value);
        found.push((
            m,
            if let (true, Some(angles)) = (drawn, about_the_middle(&i, &j)) {
                angles[0]
            } else if !drawn && law.value(&i, &j, Some(drive)).abs() > ON_BRANCH {
                body_angles(&i, &j)[0]
            } else if (if driven.abs() > ON_BRANCH {
                driven
            } else {
                x * c + y * s
            }) < 0.0
            {
                Scalar::atan2(-y, -x)
            } else {
                Scalar::atan2(y, x)
            },
        ));
    }
    for (m, angle) in found {
        configuration.motions[m].reference = angle;
    }
}

/// Returns whether orientation rows that hold do so at an opposite; a driven β₂ is read on the side
/// of a configuration `before`.
pub fn is_opposite(
    scene: &Scene,
    configuration: &Configuration,
    before: &Configuration,
    t: f64,
    q: &[f64],
    x: &[f64],
) -> bool {
    let mut there = configuration.clone();
    for (motion, before) in there.motions.iter_mut().zip(&before.motions) {
        motion.reference = before.reference;
    }
    let there = scene.within(&there);
    let numbers = numbers(there, t, q, &vec![0.0; scene.layout.n_v], x);
    let at = Equations::new(there, &numbers);
    turns(there, &at, 0)
        .iter()
        .any(|turn| turn.left > ON_BRANCH)
}

/// Moves `q` by the turns that orientation rows ask for, and onto the other rows; returns whether
/// that led near the branch. `normal`: which normal is taken where axes are opposite.
pub fn turn(
    scene: &Scene,
    configuration: &mut Configuration,
    t: f64,
    q: &mut [f64],
    x: &[f64],
    normal: usize,
) -> bool {
    let wanted = Wanted::turns(normal);
    nearest(
        (scene, configuration),
        (None, &wanted),
        t,
        q,
        x,
        Origin::EachStep,
    );
    let here = scene.within(configuration);
    let numbers = numbers(here, t, q, &vec![0.0; scene.layout.n_v], x);
    let left = turns(here, &Equations::new(here, &numbers), normal);
    left.iter().all(|turn| turn.left < NEAR_BRANCH)
}

/// Returns the unit torque on I about an axis, and its opposite on J: its component along a
/// velocity is how fast I turns against J about that axis.
pub(super) fn against(i: usize, j: usize, axis: Vec3<f64>) -> [(usize, Action<f64>); 2] {
    let torque = |torque| Action {
        force: Vec3::zero(),
        torque,
    };
    [(i, torque(axis)), (j, torque(-axis))]
}
