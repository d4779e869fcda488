//! The mechanisms of a scene, which nothing but forces couples: each is assembled by itself, so
//! that what else is in a model changes no bit of it.

use crate::numeric::connected::{SparseRow, connected};
use crate::scene::Scene;

/// Links that hang together, and what acts on them: indices in the scene, ascending.
#[derive(Clone, Debug, Default)]
pub(super) struct Mechanism {
    pub links: Vec<usize>,
    pub velocities: Vec<usize>,
    pub parts: Vec<usize>,
    pub rows: Vec<usize>,
    /// its rows, and those of other equations behind all rows
    pub equations: Vec<usize>,
    /// its size as it is drawn
    pub size: f64,
    /// how far it reaches from the origin, at least its size: against it lengths are rounded
    pub reach: f64,
    /// what counts as one of each velocity
    units: Vec<f64>,
}

impl Mechanism {
    /// Returns what counts as one of a velocity of it: rad, or the size of the mechanism.
    pub fn unit(&self, v: usize) -> f64 {
        let own = self.velocities.binary_search(&v);
        own.map_or(1.0, |k| self.units[k])
    }
}

/// Finds the mechanisms of a scene whose rows, and then other equations, have these gradients.
pub(super) fn mechanisms<'g>(
    scene: &Scene,
    gradients: impl Iterator<Item = &'g SparseRow>,
) -> Vec<Mechanism> {
    let mut link_of = vec![0; scene.layout.n_v];
    let mut turns = vec![false; scene.layout.n_v];
    for freedom in &scene.freedoms {
        if let Some(v) = freedom.v {
            (link_of[v], turns[v]) = (freedom.link, freedom.turn);
        }
    }
    let one = |l: usize| (l, 1.0);
    let mut ties = scene.joined_by_constraints();
    let of_row = |row: &SparseRow| row.iter().map(|&(v, _)| one(link_of[v])).collect();
    let first = ties.len();
    ties.extend(gradients.map(of_row));
    // a slope that is zero here need not stay so
    for element in &scene.constraints {
        for r in element.rows.clone() {
            ties[first + r].extend(scene.joined_by(element));
        }
    }
    let n_links = scene.links.len();
    let mut all: Vec<Mechanism> = Vec::new();
    let mut own = vec![None; n_links];
    for block in connected(&ties, n_links) {
        if block.columns.is_empty() {
            continue;
        }
        block.columns.iter().for_each(|&l| own[l] = Some(all.len()));
        let equations = block.rows.iter().filter_map(|r| r.checked_sub(first));
        let equations: Vec<usize> = equations.collect();
        let rows = equations.iter().copied().filter(|&r| r < scene.rows.len());
        all.push(Mechanism {
            rows: rows.collect(),
            equations,
            links: block.columns,
            ..Mechanism::default()
        });
    }
    for (v, &link) in link_of.iter().enumerate() {
        if let Some(k) = own[link] {
            all[k].velocities.push(v);
        }
    }
    for (k, part) in scene.parts.iter().enumerate() {
        if let Some(m) = part.link.and_then(|l| own[l]) {
            all[m].parts.push(k);
        }
    }
    let mut markers = vec![Vec::new(); all.len()];
    for (k, marker) in scene.markers.iter().enumerate() {
        if let Some(m) = marker.link.and_then(|l| own[l]) {
            markers[m].push(k);
        }
    }
    for (mechanism, markers) in all.iter_mut().zip(markers) {
        let [size, reach] = scene.size_and_reach(&mechanism.parts, &markers);
        (mechanism.size, mechanism.reach) = (size, reach);
        let unit = |&v: &usize| if turns[v] { 1.0 } else { size };
        mechanism.units = mechanism.velocities.iter().map(unit).collect();
    }
    all
}

/// Returns the metric of the velocities in which the size of a mechanism is like a radian: squares
/// of what counts as one   (n_v)
pub(super) fn weights(all: &[Mechanism], n_v: usize) -> Vec<f64> {
    let mut w = vec![1.0; n_v];
    for mechanism in all {
        for (&v, unit) in mechanism.velocities.iter().zip(&mechanism.units) {
            w[v] = unit * unit;
        }
    }
    w
}

/// Returns the size of the mechanism of each link   (n_links)
pub(super) fn sizes_by_links(all: &[Mechanism], n_links: usize) -> Vec<f64> {
    let mut sizes = vec![1.0; n_links];
    for mechanism in all {
        mechanism
            .links
            .iter()
            .for_each(|&l| sizes[l] = mechanism.size);
    }
    sizes
}
