//! The order in which freedoms and rows are eliminated: chosen from the pattern of the rows, before
//! anything is recorded.
//!
//! Two orders keep what is recorded short where loops share parts. Rows may be eliminated
//! [where their loops close](super::loop_factor) instead of all at the end, and where masses do not
//! matter rows may stand in an order of least degree. Either is taken only where the usual order
//! fills in: below `LEAST_FILL` products, or for less than `GAIN` times fewer, nothing changes.

use super::configuration::{Configured, Elimination, Way};
use super::equations::{Equations, KINEMATIC, STATIC};
use super::{Scene, loop_factor};
use std::collections::{BTreeMap, BTreeSet};

/// Products of the usual order from which another one is considered.
const LEAST_FILL: f64 = 1e4;
/// Products of the usual order over those of another one that takes its place.
const GAIN: f64 = 2.0;
/// Products beyond which an order of rows is not worth its search.
const MOST_PRODUCTS: f64 = 2e6;
/// Products for the articulated inertia of a link, about.
const PER_LINK: f64 = 100.0;
/// Products for one row through a link, about.
const PER_OPEN_ROW: f64 = 30.0;

/// Chooses how rows that take part are eliminated, from where they have entries at the given row of
/// numbers. Leaves open whether the mass matrix or articulated inertia is shorter.
pub fn choose(scene: Configured<'_>, numbers: &[f64], elimination: &mut Elimination) {
    elimination.order.clear();
    if elimination.way == Way::RowsWhereLoopsClose {
        elimination.way = Way::default();
    }
    let active: Vec<usize> = scene.configuration.active_rows().collect();
    if active.is_empty() {
        return;
    }
    let at = Equations::new(scene, numbers);
    let places: Vec<Vec<usize>> = (active.iter())
        .map(|&r| {
            let gradient = &at.row(r).gradient;
            gradient
                .iter()
                .filter(|e| e.1 != 0.0)
                .map(|e| e.0)
                .collect()
        })
        .collect();
    if scene.mode != KINEMATIC && scene.mode != STATIC {
        let usual = products_on_trees(&scene, &places);
        let fills = elimination.lent_inertia.is_empty() && usual > LEAST_FILL;
        if !fills || usual <= GAIN * products_where_loops_close(&scene, &places) {
            return;
        }
        elimination.way = Way::RowsWhereLoopsClose;
    }
    if let Some(order) = order_of_rows(&places) {
        elimination.order = order.into_iter().map(|k| active[k]).collect();
    }
}

/// Counts the products of `G M⁻¹ Gᵀ` and its factors, which couple all rows on one tree.
fn products_on_trees(scene: &Scene, places: &[Vec<usize>]) -> f64 {
    let n = scene.freedoms.len();
    let mut root = vec![0; n];
    let mut depth = vec![1.0; n];
    for k in 0..n {
        root[k] = scene.carrier[k].map_or(k, |c| root[c]);
        depth[k] += scene.carrier[k].map_or(0.0, |c| depth[c]);
    }
    let free = (0..n).filter(|&k| scene.freedoms[k].v.is_some());
    let free: Vec<usize> = free.collect();
    // rows and their entries, by the tree of their first freedom
    let (mut rows, mut entries) = (vec![0.0; n], vec![0.0; n]);
    for row in places {
        let deepest = row.iter().map(|&v| depth[free[v]]).fold(0.0, f64::max);
        if let Some(&v) = row.first() {
            rows[root[free[v]]] += 1.0;
            entries[root[free[v]]] += deepest;
        }
    }
    let products = rows.iter().zip(&entries);
    products
        .map(|(m, entries): (&f64, &f64)| m * entries / 2.0 + m.powi(3) / 6.0)
        .sum()
}

/// Counts the products where each row is eliminated as soon as its loop closes.
fn products_where_loops_close(scene: &Scene, places: &[Vec<usize>]) -> f64 {
    let n = scene.links.len();
    let mut link_of = vec![0; scene.layout.n_v];
    for f in &scene.freedoms {
        f.v.into_iter().for_each(|v| link_of[v] = f.link);
    }
    let closing = loop_factor::closing(scene, places);
    let mut open = vec![0.0; n];
    for (at, rows) in closing.iter().enumerate() {
        let end = Some(at).filter(|&at| at < n);
        for &r in rows {
            let mut through = BTreeSet::new();
            for &v in &places[r] {
                let mut next = Some(link_of[v]);
                while let Some(l) = next.filter(|&l| next != end && through.insert(l)) {
                    next = scene.links[l].parent;
                }
            }
            through.into_iter().for_each(|l| open[l] += 1.0);
        }
    }
    // rows that are open beside one that closes come through the links that stand there
    let mut beside = vec![0.0; n + 1];
    for (link, m) in scene.links.iter().zip(&open) {
        beside[link.parent.unwrap_or(n)] += m;
    }
    let of_link = |m: &f64| PER_LINK + PER_OPEN_ROW * m + 2.0 * m * m;
    let of_rows = |(rows, m): (&Vec<usize>, &f64)| rows.len() as f64 * m * m / 2.0;
    open.iter().map(of_link).sum::<f64>() + closing.iter().zip(&beside).map(of_rows).sum::<f64>()
}

/// Returns an order of rows in which their products fill in much less than in the order given;
/// `None`: there is none. Rows that share a place are neighbours.
fn order_of_rows(places: &[Vec<usize>]) -> Option<Vec<usize>> {
    let mut rows_at: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (r, row) in places.iter().enumerate() {
        row.iter()
            .for_each(|&v| rows_at.entry(v).or_default().push(r));
    }
    let mut neighbours = vec![BTreeSet::new(); places.len()];
    for rows in rows_at.values() {
        for &r in rows {
            neighbours[r].extend(rows.iter().copied().filter(|&s| s != r));
        }
    }
    let pairs: usize = neighbours.iter().map(BTreeSet::len).sum();
    if (pairs * places.len()) as f64 <= LEAST_FILL {
        return None;
    }
    let (order, least) = eliminated(neighbours.clone(), true, MOST_PRODUCTS)?;
    let limit = (GAIN * least).max(LEAST_FILL);
    match eliminated(neighbours, false, limit) {
        Some(_) => None,
        None => Some(order),
    }
}

/// Returns an order of elimination in which little fills in: what has the fewest neighbours goes
/// first.
pub(super) fn fewest_neighbours_first(neighbours: Vec<BTreeSet<usize>>) -> Vec<usize> {
    let found = eliminated(neighbours, true, f64::INFINITY);
    found.map(|(order, _)| order).unwrap_or_default()
}

/// Returns the order in which rows are eliminated, those with the fewest neighbours first or in the
/// order given, and the products that it takes; `None`: more than the limit.
fn eliminated(
    mut neighbours: Vec<BTreeSet<usize>>,
    fewest_first: bool,
    limit: f64,
) -> Option<(Vec<usize>, f64)> {
    let degree = |n: &BTreeSet<usize>| if fewest_first { n.len() } else { 0 };
    let mut open: BTreeSet<(usize, usize)> = (neighbours.iter().enumerate())
        .map(|(r, n)| (degree(n), r))
        .collect();
    let (mut order, mut products) = (Vec::with_capacity(neighbours.len()), 0.0);
    while let Some((_, r)) = open.pop_first() {
        order.push(r);
        let near = std::mem::take(&mut neighbours[r]);
        products += (near.len() * near.len()) as f64 / 2.0;
        if products > limit {
            return None;
        }
        for &s in &near {
            open.remove(&(degree(&neighbours[s]), s));
            neighbours[s].extend(near.iter().copied().filter(|&t| t != s));
            neighbours[s].remove(&r);
            open.insert((degree(&neighbours[s]), s));
        }
    }
    Some((order, products))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_that_meets_all_others_is_eliminated_after_most_of_them() {
        // the first row shares a place with each of the others, which share none with each other
        let mut places: Vec<Vec<usize>> = vec![(0..300).collect()];
        places.extend((0..300).map(|v| vec![v]));
        let order = order_of_rows(&places).expect("the given order fills in");
        let mut all = order.clone();
        all.sort_unstable();
        assert_eq!(all, (0..places.len()).collect::<Vec<_>>());
        assert!(order.iter().position(|&r| r == 0) >= Some(299));
        // in the contrary order nothing is to be gained
        places.rotate_left(1);
        assert_eq!(order_of_rows(&places), None);
    }
}
