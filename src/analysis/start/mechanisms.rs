//! The mechanisms of a scene, which nothing but forces couples: each is assembled by itself, so that
//! what else is in a model changes no bit of it.

use crate::numeric::connected::{SparseRow, connected};
use crate::scene::Scene;

/// Links that hang together, and what acts on them: indices in the scene, ascending.
#[derive(Clone, Debug, Default)]
pub(super) struct Mechanism {
    pub links: Vec<usize>,
    pub velocities: Vec<usize>,
    pub parts: Vec<usize>,
    pub rows: Vec<usize>,
    /// its size as it is drawn
    pub size: f64,
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
    let carried = scene.links.iter().enumerate().map(|(l, link)| {
        let both = [Some(l), link.parent].into_iter().flatten();
        both.map(one).collect::<SparseRow>()
    });
    let mut ties: Vec<SparseRow> = carried.collect();
    let of_row = |row: &SparseRow| row.iter().map(|&(v, _)| one(link_of[v])).collect();
    ties.extend(gradients.map(of_row));
    // a slope that is zero here need not stay so
    ties.extend(scene.constraints.iter().map(|element| {
        let pair = element.markers.into_iter().flat_map(|(i, j)| [i, j]);
        let markers = pair.chain(element.acts_on.iter().copied());
        markers
            .filter_map(|m| scene.markers[m].link)
            .map(one)
            .collect()
    }));
    let n_links = scene.links.len();
    let rows = n_links..n_links + scene.rows.len();
    let mut all: Vec<Mechanism> = Vec::new();
    let mut own = vec![None; n_links];
    for block in connected(&ties, n_links) {
        if block.columns.is_empty() {
            continue;
        }
        block.columns.iter().for_each(|&l| own[l] = Some(all.len()));
        let of_block = block.rows.iter().filter(|r| rows.contains(r));
        all.push(Mechanism {
            rows: of_block.map(|r| r - n_links).collect(),
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
        let size = scene.size_of(&mechanism.parts, &markers);
        mechanism.size = size;
        let unit = |&v: &usize| if turns[v] { 1.0 } else { size };
        mechanism.units = mechanism.velocities.iter().map(unit).collect();
    }
    all
}
