//! Velocities that a dataset gives, as equations of the velocities of coordinates, and what is to
//! hold where it gives none.

use super::assemble::numbers;
use super::initial_conditions::of_joints;
use super::kinetic::Squares;
use super::velocities::{components, joint_rates, line_rates, link_of};
use crate::model::{ElementKind, InitialQuantity, Model};
use crate::numeric::connected::{SparseRow, connected};
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::scene::{LinkIx, Scene, Source};
use crate::space::Vec3;
use nalgebra::DVector;

/// Part of the speeds that a velocity is a difference of below which it is rounding.
const ROUNDING: f64 = 1e-12;

/// Linear equations that velocities should satisfy.
#[derive(Default)]
pub(super) struct Given {
    pub rows: Vec<SparseRow>,
    pub right: Vec<f64>,
}

/// Velocities that the dataset gives: those of constraints (IC of joints, VEL of contacts), which
/// go before those of parts, and zero for all others.
pub(super) struct GivenVelocities {
    of: [Given; Level::ALL],
    /// all of them are those that the rows permit
    pub are_met: bool,
}

/// The origin of a velocity; those before go first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Level {
    Constraint,
    Part,
    /// times √m or √I: what has energy is at rest
    Energy,
    /// what has none is at rest, too
    Rest,
}

impl Level {
    /// Number of levels.
    pub const ALL: usize = 4;
}

impl GivenVelocities {
    /// Collects them at an instant `(t, q, x)`. Trees whose velocities in `v`, which the rows
    /// permit, are those given already need no coefficients: a stored zero stands for them.
    ///
    /// `sizes`: of the mechanisms of the links.
    pub fn collect(
        (scene, sizes): (Configured<'_>, &[f64]),
        model: &Model,
        (t, q, x): (f64, &[f64], &[f64]),
        (gradient, v): (&[SparseRow], &DVector<f64>),
    ) -> Self {
        let n = scene.layout.n_v;
        // velocities are linear in v: an evaluation for motions, and one for a coordinate of each
        // tree
        let (tree_of, coordinates) = trees(&scene, model);
        let squares: Vec<Squares> = scene.links.iter().map(Squares::of).collect();
        let evaluate = |v: &[f64]| {
            let at = Equations::new(scene, &numbers(scene, t, q, v, x));
            part_velocities((&scene, &squares, sizes), model, &at)
        };
        let (still, targets) = evaluate(&vec![0.0; n]);
        let zero: Vec<f64> = still.iter().map(|found| found.value).collect();
        let tree = |target: &Target| target.link.map(|link| tree_of[link]);
        let mut open = vec![false; coordinates.len()];
        let mut are_met = true;
        for (target, zero) in targets.iter().zip(&zero) {
            if target.value != *zero {
                are_met = false;
                tree(target).into_iter().for_each(|tree| open[tree] = true);
            }
        }
        open_beside(&mut open, &coordinates, gradient, v);
        are_met &= !open.contains(&true);
        let lengths = coordinates.iter().zip(&open).filter(|(_, open)| **open);
        let most = lengths.map(|(tree, _)| tree.len()).max().unwrap_or(0);
        let mut rows: Vec<SparseRow> = vec![Vec::new(); zero.len()];
        for (row, target) in rows.iter_mut().zip(&targets) {
            if let Some(tree) = tree(target).filter(|&tree| !open[tree]) {
                row.extend(coordinates[tree].first().map(|&place| (place, 0.0)));
            }
        }
        for k in 0..most {
            let mut v = vec![0.0; n];
            for (tree, _) in coordinates.iter().zip(&open).filter(|(_, open)| **open) {
                if let Some(&place) = tree.get(k) {
                    v[place] = 1.0;
                }
            }
            let (values, _) = evaluate(&v);
            for (r, target) in targets.iter().enumerate() {
                let own = tree(target).filter(|&tree| open[tree]);
                let place = own.and_then(|tree| coordinates[tree].get(k));
                let change = values[r].change_from(still[r]);
                if let (Some(&place), true) = (place, change != 0.0) {
                    rows[r].push((place, change));
                }
            }
        }
        let of = Default::default();
        let mut found = Self { of, are_met };
        for ((row, target), zero) in rows.into_iter().zip(targets).zip(zero) {
            let level = &mut found.of[target.level as usize];
            level.rows.push(row);
            level.right.push(target.value - zero);
        }
        found
    }

    pub fn levels(&self) -> [&Given; Level::ALL] {
        self.of.each_ref()
    }
}

/// Opens the trees that move in `v`, and those that rows connect to open ones: what is given of one
/// can change the velocities of the other.
fn open_beside(
    open: &mut [bool],
    coordinates: &[Vec<usize>],
    gradient: &[SparseRow],
    v: &DVector<f64>,
) {
    let tied = |tree: &Vec<usize>| tree.iter().map(|&place| (place, 1.0)).collect();
    let mut ties: Vec<SparseRow> = coordinates.iter().map(tied).collect();
    ties.extend(gradient.iter().cloned());
    let n_trees = coordinates.len();
    for block in connected(&ties, v.len()) {
        let trees = || block.rows.iter().filter(|&&r| r < n_trees);
        let moves = block.columns.iter().any(|&k| v[k] != 0.0);
        if moves || trees().any(|&tree| open[tree]) {
            trees().for_each(|&tree| open[tree] = true);
        }
    }
}

/// Finds what moves together: trees of links, those joined whose velocities are given against each
/// other. Returns the tree of each link, and the places in v of the coordinates of each tree.
fn trees(scene: &Scene, model: &Model) -> (Vec<usize>, Vec<Vec<usize>>) {
    let n = scene.links.len();
    let join = |a: usize, b: usize| vec![(a, 1.0), (b, 1.0)];
    let mut ties: Vec<SparseRow> = (0..n)
        .map(|k| join(k, scene.links[k].parent.unwrap_or(k)))
        .collect();
    if !scene.cams.is_empty() {
        ties.extend((1..n).map(|k| join(k - 1, k)));
    }
    for (id, ..) in of_joints(model) {
        let joint = &model.joints[&id];
        let link = |m: u32| scene.markers[*scene.marker_of.get(&m)?].link;
        if let (Some(i), Some(j)) = (link(joint.i), link(joint.j)) {
            ties.push(join(i, j));
        }
    }
    for (&id, values) in &model.beginnings {
        let has_rate = values
            .keys()
            .any(|q| matches!(q, InitialQuantity::VariableRate(_)));
        let joint = model.joints.get(&id.number);
        if let Some(joint) = joint.filter(|_| has_rate && id.kind == ElementKind::Joint)
            && let [Some(i), Some(j)] = [joint.i, joint.j].map(|m| link_of(scene, m))
        {
            ties.push(join(i, j));
        }
    }
    let mut tree_of = vec![0; n];
    let trees = connected(&ties, n);
    for (tree, links) in trees.iter().enumerate() {
        links.columns.iter().for_each(|&link| tree_of[link] = tree);
    }
    let mut coordinates = vec![Vec::new(); trees.len()];
    for c in &scene.coordinates {
        if let Source::Free { v, .. } = c.source {
            coordinates[tree_of[c.link]].push(v);
        }
    }
    (tree_of, coordinates)
}

/// A velocity that was evaluated, and how large the velocities are that it is a difference of.
#[derive(Clone, Copy, Debug)]
struct Found {
    value: f64,
    size: f64,
}

impl Found {
    /// A component of a velocity of that size.
    fn of(value: f64, size: f64) -> Self {
        Self { value, size }
    }

    fn times(self, unit: f64) -> Self {
        Self::of(self.value * unit, self.size * unit)
    }

    /// Returns the change from another evaluation; zero where that is rounding.
    fn change_from(self, other: Self) -> f64 {
        let change = self.value - other.value;
        let is_rounding = change.abs() <= ROUNDING * (self.size + other.size);
        if is_rounding { 0.0 } else { change }
    }
}

/// A velocity component of a part, or against another one: where its value comes from.
struct Target {
    level: Level,
    value: f64,
    /// a link of the tree that it depends on; `None`: it depends on none
    link: LinkIx,
}

impl Target {
    fn of_part(given: Option<f64>, link: LinkIx) -> Self {
        let level = given.map_or(Level::Rest, |_| Level::Part);
        let value = given.unwrap_or(0.0);
        Self { level, value, link }
    }

    fn of_energy(link: usize) -> Self {
        let (level, link) = (Level::Energy, Some(link));
        Self {
            level,
            value: 0.0,
            link,
        }
    }

    fn of_constraint(value: f64, link: LinkIx) -> Self {
        let level = Level::Constraint;
        Self { level, value, link }
    }
}

/// Evaluates the velocity components of all parts as the dataset would give them, with origin and
/// value of those that it gives; then joint rates. Ways count in sizes of the mechanism.
fn part_velocities(
    (scene, squares, sizes): (&Scene, &[Squares], &[f64]),
    model: &Model,
    at: &Equations<'_, f64>,
) -> (Vec<Found>, Vec<Target>) {
    let mut values = Vec::new();
    let mut targets = Vec::new();
    let way_of = |link: LinkIx| 1.0 / link.map_or(1.0, |l| sizes[l]);
    for (k, (own, state)) in squares.iter().zip(at.links()).enumerate() {
        for (value, size) in own.at(state, sizes[k]) {
            targets.push(Target::of_energy(k));
            values.push(Found::of(value, size));
        }
    }
    for part in &scene.parts {
        let Some(data) = model.body(part.id) else {
            continue;
        };
        let Some([v, w]) = components(scene, data, at) else {
            continue;
        };
        let way = way_of(part.link);
        let [fast, turning] = [v, w].map(|x| Vec3(x).norm());
        let found = (v
            .map(|x| Found::of(x * way, fast * way + turning))
            .into_iter())
        .chain(w.map(|x| Found::of(x, turning)));
        let given = (data.velocity.iter().map(|v| v.map(|v| v * way)))
            .chain(data.angular_velocity.iter().copied());
        let rests = part.link.is_some_and(|link| squares[link].is_definite());
        for (found, given) in found.zip(given) {
            if given.is_some() || !rests {
                values.push(found);
                targets.push(Target::of_part(given, part.link));
            }
        }
    }
    for (c, cam) in scene.cams.iter().enumerate() {
        let [i, j] = [cam.i, cam.j].map(|m| scene.markers[m].link);
        let way = way_of(i.or(j));
        for (k, along) in at.cam_speeds(c).into_iter().enumerate() {
            if let Some(given) = cam.velocity[k] {
                values.push(Found::of(along, along.abs()).times(way));
                // with contacts all links are one tree
                let link = (!scene.links.is_empty()).then_some(0);
                targets.push(Target::of_constraint(given * way, link));
            }
        }
    }
    let unit = |is_angle: bool, link: LinkIx| if is_angle { 1.0 } else { way_of(link) };
    for rate in joint_rates(scene, model, at) {
        let joint = &model.joints[&rate.id];
        let link = |m: u32| scene.markers[*scene.marker_of.get(&m)?].link;
        let link = link(joint.i).or_else(|| link(joint.j));
        let unit = unit(rate.is_angle, link);
        values.push(Found::of(rate.found, rate.size).times(unit));
        targets.push(Target::of_constraint(rate.wanted * unit, link));
    }
    for rate in line_rates(scene, model, at) {
        let unit = unit(rate.is_angle, rate.link);
        values.push(Found::of(rate.found, rate.size).times(unit));
        targets.push(Target::of_constraint(rate.wanted * unit, rate.link));
    }
    (values, targets)
}
