//! Free directions as motions: which parts move in each, and how.
//!
//! Directions satisfy all rows to first order, and are combined so that each has an unknown of its
//! own: as few parts as can be had cheaply move in each.

use crate::analysis::direction::Axis;
use crate::analysis::quantity::point;
use crate::analysis::start::assemble;
use crate::arrange::Arrange;
use crate::diagnostic::Subject;
use crate::model::{ElementId, Model};
use crate::numeric::rank::Rank;
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::scene::programs::weights;
use crate::scene::{Scene, Source};
use crate::space::{MarkerState, Vec3};
use std::cell::OnceCell;

/// Motion of a part in a free direction, relative to the largest, below which it does not move.
const LEAST_MOTION: f64 = 1e-7;
/// Parts that a sentence names, at most.
const MAX_NAMED: usize = 8;

/// The motion of a part in a free direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Moving {
    /// the PART or POINT_MASS
    pub part: ElementId,
    /// "slides along its Z"
    pub words: String,
    /// angular velocity, ground axes
    pub angular: [f64; 3],
    /// velocity of the centre of mass (of the part's origin when it has none), ground axes
    pub linear: [f64; 3],
    /// the place of that point
    pub at: [f64; 3],
}

/// A free direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Free {
    /// the unknown whose rate is one: "JOINT/1 angle"
    pub unknown: Subject,
    /// parts that move, the one that has the unknown first
    pub parts: Vec<Moving>,
    /// "PART/3 slides along its Z; PART/4 goes with it"
    pub words: String,
    /// rates of all unknowns   (n_v)
    pub rates: Vec<f64>,
}

/// A part's centre, and its state.
type Placed = (Vec3<f64>, MarkerState<f64>);

/// The free directions at a position; each is put in words when that is asked for.
pub(super) struct Directions<'a> {
    scene: Configured<'a>,
    model: &'a Model,
    t: f64,
    q: &'a [f64],
    x: &'a [f64],
    /// coordinate of the unknown of each direction   (n_directions)
    own: Vec<usize>,
    /// rates of all unknowns, that of its own one   (n_directions)
    pub rates: Vec<Vec<f64>>,
    /// where all parts are when nothing moves but by itself
    still: OnceCell<Vec<Placed>>,
}

impl<'a> Directions<'a> {
    /// Finds all of them.
    pub fn of(scene: Configured<'a>, model: &'a Model, t: f64, q: &'a [f64], x: &'a [f64]) -> Self {
        let w = weights(&scene);
        let (_, gradient) = assemble::rows_at_rest(scene, t, q, x);
        let rows = assemble::scaled_rows(&gradient, &w);
        let rank = Rank::of(rows.iter().map(Vec::as_slice), w.len(), assemble::DEPENDENT);
        let mut owner = vec![0; w.len()];
        for (c, coordinate) in scene.coordinates.iter().enumerate() {
            if let Source::Free { v, .. } = coordinate.source {
                owner[v] = c;
            }
        }
        let of_direction = |(own, direction): (usize, Vec<f64>)| {
            let one = w[own].sqrt();
            let rates = direction.iter().zip(&w).map(|(d, w)| d * w.sqrt() / one);
            (owner[own], rates.collect())
        };
        let (own, rates) = rank.free_motions().into_iter().map(of_direction).unzip();
        Self {
            scene,
            model,
            t,
            q,
            x,
            own,
            rates,
            still: OnceCell::new(),
        }
    }

    /// Returns the unknown whose rate is one in a direction.
    pub fn unknown(&self, k: usize) -> Subject {
        self.scene.coordinates[self.own[k]].id.into()
    }

    /// Places all parts at rates of the unknowns.
    fn placed(&self, v: &[f64]) -> Vec<Placed> {
        let numbers = assemble::numbers(self.scene, self.t, self.q, v, self.x);
        let at = Equations::new(self.scene, &numbers);
        let place = |k: usize| {
            let state = at.part(k, false);
            (centre(&self.scene, self.model, k, &state), state)
        };
        (0..self.scene.parts.len()).map(place).collect()
    }

    /// Puts a direction in words.
    pub fn described(&self, k: usize) -> Free {
        let rates = &self.rates[k];
        let still = (self.still).get_or_init(|| self.placed(&vec![0.0; rates.len()]));
        let coordinate = &self.scene.coordinates[self.own[k]];
        let moving = self.placed(rates);
        let parts = moving_parts(&self.scene, coordinate.link, moving, still);
        let words = match parts.split_first() {
            None => format!("{} changes and moves no part", coordinate.id),
            Some((first, rest)) => sentence(self.model, first, rest),
        };
        Free {
            unknown: coordinate.id.into(),
            parts,
            words,
            rates: rates.clone(),
        }
    }
}

/// Finds all free directions at a position.
pub(super) fn motions(
    scene: Configured<'_>,
    model: &Model,
    t: f64,
    q: &[f64],
    x: &[f64],
) -> Vec<Free> {
    let all = Directions::of(scene, model, t, q, x);
    (0..all.rates.len()).map(|k| all.described(k)).collect()
}

/// Returns the parts that move against how they are at rest, those on link `first` first.
fn moving_parts(scene: &Scene, first: usize, moving: Vec<Placed>, still: &[Placed]) -> Vec<Moving> {
    let mut parts = Vec::new();
    let mut largest = 0.0_f64;
    for (k, ((p, state), (_, rest))) in moving.into_iter().zip(still).enumerate() {
        let angular = state.w_GM - rest.w_GM;
        let arm = p - state.p_GM;
        let linear = (state.v_GM - rest.v_GM) + angular.cross(arm);
        let size = linear.norm().max(angular.norm() * scene.length);
        largest = largest.max(size);
        parts.push((k, p, state, angular, linear, size));
    }
    parts.retain(|part| part.5 > LEAST_MOTION * largest);
    parts.arrange_by_key(|part| (scene.parts[part.0].link != Some(first), part.0));
    parts
        .into_iter()
        .map(|(k, p, state, angular, linear, _)| Moving {
            part: scene.parts[k].id,
            words: how(scene, p, &state, angular, linear),
            angular: angular.0,
            linear: linear.0,
            at: p.0,
        })
        .collect()
}

/// Writes how a part moves, and which go with it.
fn sentence(model: &Model, first: &Moving, rest: &[Moving]) -> String {
    let mut text = format!("{} {}", model.called(first.part), first.words);
    if !rest.is_empty() {
        let some = rest.iter().take(MAX_NAMED);
        let names: Vec<String> = some.map(|p| model.called(p.part)).collect();
        text += &format!("; with it {}", names.join(", "));
        if rest.len() > MAX_NAMED {
            text += &format!(" and {} more", rest.len() - MAX_NAMED);
        }
    }
    text
}

/// Returns the centre of mass of a part, else its origin, in ground.
fn centre(scene: &Scene, model: &Model, part: usize, state: &MarkerState<f64>) -> Vec3<f64> {
    let p = &scene.parts[part];
    let cm = model
        .body(p.id)
        .and_then(|d| d.cm)
        .and_then(|m| scene.marker_of.get(&m))
        .map_or(Vec3::zero(), |&m| match scene.markers[m].part {
            Some(k) if k == part => p.frame.inverse().point(scene.markers[m].frame.position),
            _ => Vec3::zero(),
        });
    state.p_GM + state.R_GM.apply(cm)
}

/// Writes a twist: slides, turns or both.
fn how(
    scene: &Scene,
    p: Vec3<f64>,
    state: &MarkerState<f64>,
    w: Vec3<f64>,
    v: Vec3<f64>,
) -> String {
    let along = |direction: Vec3<f64>| {
        let unit = direction.times(1.0 / direction.norm());
        let own = (0..3).find(|&k| state.R_GM.column(k).dot(unit).abs() > 1.0 - 1e-9);
        match own {
            Some(k) => format!("its {}", ["X", "Y", "Z"][k]),
            None => Axis::along(direction, &[]).to_string(),
        }
    };
    let turning = w.norm() * scene.length;
    if turning <= 1e-7 * v.norm() {
        return format!("slides along {}", along(v));
    }
    // p + w × v / w² is on the axis; v along w is the pitch
    let w2 = w.norm2();
    let foot = p + w.cross(v).times(1.0 / w2);
    let pitch = v.dot(w) / w2;
    if v.norm() <= 1e-7 * turning {
        return format!("turns about {} through {}", along(w), point(p));
    }
    if pitch.abs() <= 1e-7 * scene.length {
        return format!("turns about {} through {}", along(w), point(foot));
    }
    format!(
        "turns about {} through {} and slides along it by {:.4} per radian",
        along(w),
        point(foot),
        pitch
    )
}
