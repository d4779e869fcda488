//! Displacements that are sums of coordinates, and therefore know their turns.
//!
//! Most displacements are sums of coordinates in every configuration: the variable of a joint of
//! the forest, the angle between two links of a planar mechanism, the travel of a pinion's centre.
//! Such a displacement has a constant gradient, and an angle needs no counted turns. Whether a
//! displacement is one is asked of the scene itself: its gradient along the freedoms of the forest
//! is the same at several configurations drawn at random only if it is the same everywhere, for an
//! analytic function of the coordinates. An angle is one where its axis keeps its inclination to
//! the plane in which the angle is read; elsewhere it leaps by half a turn as the axis passes the
//! normal, as AZ does across the second pin of a universal joint.
//!
//! An angle is the same after a turn of any coordinate, so its factors of angular coordinates are
//! whole numbers: they are rounded to these, and no turn is lost however many there are.

use super::sweep::{self, Coordinates, LinkState};
use super::{CoordinateSum, Displacement, LinkMotion, MarkerOnLink, Scene, Source};
use crate::expr::measures::Measure;
use crate::physics::coupler::Gauge;
use crate::physics::kinematic::kinematic;
use crate::random::Random;
use crate::scalar::{Dual, Jet, Scalar};
use crate::space::{Frame, MarkerState};
use std::cell::OnceCell;
use std::f64::consts::TAU;

/// Gradients that differ by less, as parts of their size, are the same but for rounding.
const SAME_GRADIENT: f64 = 1e-11;
/// Configurations drawn at random beside the one where all coordinates are zero.
const RANDOM_DRAWS: u64 = 3;

/// The quantity that is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Reading {
    /// displacement of a joint or a coupler
    Gauge(Gauge),
    /// AX, AY or AZ
    Measure(Measure),
}

impl Reading {
    fn value<S: Scalar>(self, i: &Frame<S>, j: &Frame<S>) -> S {
        match self {
            Reading::Gauge(gauge) => gauge.value(i, j),
            Reading::Measure(measure) => {
                let (i, j) = (MarkerState::at_rest(*i), MarkerState::at_rest(*j));
                let ground = MarkerState::ground();
                kinematic(measure, &i, &j, &ground, &ground)
                    .unwrap_or_else(|| S::constant(f64::NAN))
            }
        }
    }

    /// Returns the part of the axis whose angle is read that stands square to the plane in which it
    /// is read; 0 for distances.
    fn out_of_plane(self, i: &Frame<f64>, j: &Frame<f64>) -> f64 {
        let dot = |of_i: usize, of_j: usize| i.rotation.column(of_i).dot(j.rotation.column(of_j));
        match self {
            Reading::Gauge(gauge) => gauge.out_of_plane(i, j),
            Reading::Measure(Measure::Ax) => dot(2, 0),
            Reading::Measure(Measure::Ay) => dot(2, 1),
            Reading::Measure(_) => dot(0, 2),
        }
    }

    fn is_angle(self) -> bool {
        match self {
            Reading::Gauge(gauge) => gauge.is_angle(),
            Reading::Measure(_) => true,
        }
    }
}

/// Returns a distance or an angle between two markers, as a sum of coordinates where it is one.
pub(super) fn displacement(
    scene: &Scene,
    draws: &Draws,
    gauge: Gauge,
    i: usize,
    j: usize,
) -> Displacement {
    Displacement {
        gauge,
        i,
        j,
        coordinates: draws.sum(scene, Reading::Gauge(gauge), Some(i), Some(j)),
    }
}

/// Configurations at which gradients are compared, the same on every run. They are drawn when the
/// first sum is asked for: of one scene, whose links, coordinates and motions are complete.
#[derive(Default)]
pub(super) struct Draws {
    /// all coordinates zero, then at random
    all: OnceCell<Vec<Draw>>,
}

impl Draws {
    fn all(&self, scene: &Scene) -> &[Draw] {
        let draw = |seed| Draw::new(scene, seed);
        self.all
            .get_or_init(|| (0..=RANDOM_DRAWS).map(draw).collect())
    }

    /// Returns the sum of coordinates that a reading between two markers is in every configuration;
    /// `None`: it is none. Without a marker there is ground.
    pub(super) fn sum(
        &self,
        scene: &Scene,
        reading: Reading,
        i: Option<usize>,
        j: Option<usize>,
    ) -> Option<CoordinateSum> {
        let (first, others) = self.all(scene).split_first()?;
        let moving = Moving::between(scene, i, j);
        let start = first.value_of(scene, reading, i, j);
        let inclination = first.out_of_plane(scene, reading, i, j);
        let gradient = first.gradient(scene, reading, (i, j), &moving);
        // a third of a ball has no coordinate whose value could be summed
        let in_ball = |&(k, g): &(usize, f64)| g.abs() > SAME_GRADIENT && scene.freedoms[k].in_ball;
        if gradient.iter().any(in_ball) {
            return None;
        }
        for other in others {
            let leans = other.out_of_plane(scene, reading, i, j) - inclination;
            if leans.abs() > 100.0 * SAME_GRADIENT || leans.is_nan() {
                return None;
            }
            let value = other.value_of(scene, reading, i, j);
            let there = other.gradient(scene, reading, (i, j), &moving);
            let mut rest = value - start;
            for (&(k, g), (_, h)) in gradient.iter().zip(&there) {
                let scale = if scene.freedoms[k].turn && !reading.is_angle() {
                    scene.length
                } else {
                    1.0
                };
                let differs = (g - h).abs();
                if differs > SAME_GRADIENT * scale || differs.is_nan() {
                    return None;
                }
                rest -= g * other.coordinate(scene, k);
            }
            if reading.is_angle() {
                rest -= TAU * (rest / TAU).round();
            }
            if rest.is_nan() || rest.abs() > 100.0 * SAME_GRADIENT * (1.0 + scene.length) {
                return None;
            }
        }
        let factor = |(k, g): (usize, f64)| {
            let whole = reading.is_angle() && scene.freedoms[k].turn;
            (k, if whole { g.round() } else { clean(g) })
        };
        let terms = gradient.into_iter().map(factor);
        Some(CoordinateSum {
            terms: terms.filter(|t| t.1.abs() > 1e-13).collect(),
            constant: clean(start),
        })
    }
}

/// Returns a number without the rounding beside a whole one.
fn clean(x: f64) -> f64 {
    let whole = x.round();
    if (x - whole).abs() < 1e-14 { whole } else { x }
}

/// The freedoms that move one of two markers but not the other, ascending.
struct Moving {
    /// freedoms, and whether they move I rather than J
    freedoms: Vec<(usize, bool)>,
}

impl Moving {
    fn between(scene: &Scene, i: Option<usize>, j: Option<usize>) -> Self {
        let carriers = |m: Option<usize>| m.map_or_else(Vec::new, |m| carriers(scene, m));
        let (mut of_i, mut of_j) = (carriers(i), carriers(j));
        // both chains end at the ground: what they share stands at their ends
        while of_i.last().is_some() && of_i.last() == of_j.last() {
            of_i.pop();
            of_j.pop();
        }
        let of_i = of_i.into_iter().map(|k| (k, true));
        let mut freedoms: Vec<(usize, bool)> =
            of_i.chain(of_j.into_iter().map(|k| (k, false))).collect();
        freedoms.sort_unstable();
        Self { freedoms }
    }
}

/// Returns the angular coordinates that turn two markers against each other. Without a marker
/// there is ground.
pub(super) fn turns_between(scene: &Scene, i: Option<usize>, j: Option<usize>) -> Vec<usize> {
    let Moving { freedoms } = Moving::between(scene, i, j);
    let freedoms = freedoms.into_iter().map(|(k, _)| k);
    freedoms.filter(|&k| scene.freedoms[k].turn).collect()
}

/// Returns all freedoms that move a marker, from the nearest on.
fn carriers(scene: &Scene, marker: usize) -> Vec<usize> {
    let MarkerOnLink { link, .. } = scene.markers[marker];
    let nearest = link.and_then(|l| scene.last_freedom[l]);
    std::iter::successors(nearest, |&k| scene.carrier[k]).collect()
}

/// Coordinates drawn at random, with the poses of the links there.
struct Draw {
    q: Vec<f64>,
    driven: Vec<Jet<f64>>,
    links: Vec<LinkState<f64>>,
}

impl Draw {
    /// Draws the coordinates of a seed; of `seed` 0 all are zero.
    fn new(scene: &Scene, seed: u64) -> Self {
        let mut random = Random(seed);
        let mut draw = || {
            if seed == 0 {
                return 0.0;
            }
            random.between_ones()
        };
        let mut q: Vec<f64> = (0..scene.layout.n_q).map(|_| draw()).collect();
        for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
            if let (Source::Free { q: place, .. }, false) = (c.source, f.turn) {
                q[place] *= scene.length;
            }
        }
        for link in &scene.links {
            if let LinkMotion::Ball { quaternion, .. } = link.motion {
                let part = &mut q[quaternion..quaternion + 4];
                part[0] += 1.0;
                let n = part.iter().map(|x| x * x).sum::<f64>().sqrt();
                part.iter_mut().for_each(|x| *x /= n);
            }
        }
        let driven: Vec<Jet<f64>> = scene
            .motions
            .iter()
            .map(|_| Jet::new(draw(), 0.0, 0.0))
            .collect();
        let v = vec![0.0; scene.layout.n_v];
        let links = sweep::outward(
            scene,
            &Coordinates {
                q: &q,
                v: &v,
                vdot: &[],
                driven: &driven,
            },
        );
        Self { q, driven, links }
    }

    /// Returns the value of a coordinate.
    fn coordinate(&self, scene: &Scene, c: usize) -> f64 {
        match scene.coordinates[c].source {
            Source::Free { q, .. } if !scene.freedoms[c].in_ball => self.q[q],
            Source::Free { .. } => 0.0,
            Source::Driven(m) => self.driven[m].value,
        }
    }

    fn frame(&self, scene: &Scene, marker: Option<usize>) -> Frame<f64> {
        marker.map_or_else(Frame::identity, |m| {
            sweep::marker_frame(&scene.markers[m], &self.links)
        })
    }

    fn value_of(&self, scene: &Scene, reading: Reading, i: Option<usize>, j: Option<usize>) -> f64 {
        reading.value(&self.frame(scene, i), &self.frame(scene, j))
    }

    fn out_of_plane(
        &self,
        scene: &Scene,
        reading: Reading,
        i: Option<usize>,
        j: Option<usize>,
    ) -> f64 {
        reading.out_of_plane(&self.frame(scene, i), &self.frame(scene, j))
    }

    /// Returns the derivative of a reading along every freedom that moves I against J.
    fn gradient(
        &self,
        scene: &Scene,
        reading: Reading,
        (i, j): (Option<usize>, Option<usize>),
        moving: &Moving,
    ) -> Vec<(usize, f64)> {
        let (i, j) = (self.frame(scene, i), self.frame(scene, j));
        let along = |&(k, moves_i): &(usize, bool)| {
            let value = if moves_i {
                reading.value(&self.displaced(scene, &i, k), &Frame::constant(j))
            } else {
                reading.value(&Frame::constant(i), &self.displaced(scene, &j, k))
            };
            (k, value.eps[0])
        };
        moving.freedoms.iter().map(along).collect()
    }

    /// Returns a frame as it moves along freedom `k`.
    fn displaced(&self, scene: &Scene, frame: &Frame<f64>, k: usize) -> Frame<Dual<1>> {
        let f = &scene.freedoms[k];
        let X = &self.links[f.link].X_GL;
        let e = X.rotation.column(f.axis).times(f.sign);
        let mut moved = Frame::<Dual<1>>::constant(*frame);
        let shift = if f.turn {
            for column in 0..3 {
                let rate = e.cross(frame.rotation.column(column));
                for row in 0..3 {
                    moved.rotation.0[row][column].eps[0] = rate.0[row];
                }
            }
            e.cross(frame.position - X.position)
        } else {
            e
        };
        for row in 0..3 {
            moved.position.0[row].eps[0] = shift.0[row];
        }
        moved
    }
}
