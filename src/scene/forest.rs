//! Which joint carries which part; everything else becomes a row.
//!
//! The forest grows from ground: of all joints between a carried and an uncarried part, the one
//! with the fewest coordinates goes first, and among equals the one whose carrier is nearest to
//! ground. A part that nothing reaches starts a tree of its own, free in ground. The choice depends
//! on the model alone, not on the order of its statements beyond ties, which the smaller number
//! wins.
//!
//! Where many loops pass through the same parts (a scissor lift grown from ground has two branches,
//! and each loop goes down one and up the other), the carrier farthest from ground goes first
//! instead: then loops close over few parts, and each part stands in few of them.

use crate::physics::joint::Tie;
use std::collections::BTreeSet;

/// A joint or primitive between two bodies (indices of parts; `None` = ground).
#[derive(Clone, Debug)]
pub struct Candidate {
    /// position in the list of ties
    pub tie: usize,
    /// what it is
    pub kind: Tie,
    /// part of the I marker
    pub i: Option<usize>,
    /// part of the J marker
    pub j: Option<usize>,
    /// must not carry a part
    pub cut: bool,
    /// better carries a part: something refers to its displacement
    pub preferred: bool,
}

/// The way in which a part is carried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    /// by a tie, from J to I
    Forward(usize),
    /// by a tie, from I to J
    Backward(usize),
    /// by nothing
    Free,
}

/// One part in the order in which links are made: carriers first.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// the part
    pub part: usize,
    /// what carries it
    pub carrier: Option<usize>,
    /// by which tie
    pub by: Carried,
}

/// Loops through parts, squared and added up, from which a deep forest is considered.
const MANY_LOOPS: f64 = 1e3;
/// That of the forest nearest to ground over that of a deep one which takes its place.
const GAIN: f64 = 8.0;

/// Grows the forest over `n_parts` parts.
pub fn grow(n_parts: usize, candidates: &[Candidate]) -> Vec<Placed> {
    let near = spread(n_parts, candidates, |depth| depth);
    let usual = loops_through_parts(n_parts, candidates, &near);
    if usual <= MANY_LOOPS {
        return near;
    }
    let deep = spread(n_parts, candidates, |depth| n_parts - depth);
    if usual > GAIN * loops_through_parts(n_parts, candidates, &deep) {
        deep
    } else {
        near
    }
}

/// Returns the sum over all parts of the squared number of loops that pass through the part and its
/// carrier.
fn loops_through_parts(n_parts: usize, candidates: &[Candidate], placed: &[Placed]) -> f64 {
    let mut carrier = vec![None; n_parts];
    let mut depth = vec![0; n_parts];
    let mut carries = BTreeSet::new();
    for p in placed {
        carrier[p.part] = p.carrier;
        depth[p.part] = 1 + p.carrier.map_or(0, |c| depth[c]);
        if let Carried::Forward(tie) | Carried::Backward(tie) = p.by {
            carries.insert(tie);
        }
    }
    let depth_of = |p: Option<usize>| p.map_or(0, |k| depth[k]);
    let mut through = vec![0.0; n_parts];
    for c in candidates.iter().filter(|c| !carries.contains(&c.tie)) {
        let (mut a, mut b) = (c.i, c.j);
        while a != b {
            let deeper = if depth_of(a) > depth_of(b) {
                &mut a
            } else {
                &mut b
            };
            let Some(part) = *deeper else { break };
            through[part] += 1.0;
            *deeper = carrier[part];
        }
    }
    through.iter().map(|n: &f64| n * n).sum()
}

/// Grows the forest; of joints with equally many coordinates the one whose carrier has the least
/// `rank` goes first, a function of its distance from ground.
fn spread(n_parts: usize, candidates: &[Candidate], rank: impl Fn(usize) -> usize) -> Vec<Placed> {
    let mut depth: Vec<Option<usize>> = vec![None; n_parts];
    let mut order = Vec::with_capacity(n_parts);
    let mut edges_of: Vec<Vec<usize>> = vec![Vec::new(); n_parts + 1];
    let slot = |p: Option<usize>| p.map_or(n_parts, |k| k);
    for (e, c) in candidates.iter().enumerate() {
        if !c.cut && c.i != c.j && c.kind.motions().is_some() {
            edges_of[slot(c.i)].push(e);
            edges_of[slot(c.j)].push(e);
        }
    }
    // the frontier, cheapest first: (coordinates, not preferred, rank of the carrier, candidate)
    let mut frontier: BTreeSet<(usize, bool, usize, usize)> = BTreeSet::new();
    let reach = |from: Option<usize>, at: usize, frontier: &mut BTreeSet<_>| {
        for &e in &edges_of[slot(from)] {
            let c = &candidates[e];
            let cost = c
                .kind
                .motions()
                .map_or(0, |m| m.iter().map(|x| x.freedoms()).sum());
            frontier.insert((cost, !c.preferred, rank(at), e));
        }
    };
    reach(None, 0, &mut frontier);
    let mut next_free = 0;
    loop {
        while let Some((_, _, _, e)) = frontier.pop_first() {
            let c = &candidates[e];
            let known = |p: Option<usize>| p.is_none_or(|k| depth[k].is_some());
            let (part, carrier, by) = match (known(c.j), known(c.i)) {
                (true, false) => (c.i, c.j, Carried::Forward(c.tie)),
                (false, true) => (c.j, c.i, Carried::Backward(c.tie)),
                _ => continue,
            };
            let Some(part) = part else { continue };
            let deeper = 1 + carrier.and_then(|c| depth[c]).unwrap_or(0);
            depth[part] = Some(deeper);
            order.push(Placed { part, carrier, by });
            reach(Some(part), deeper, &mut frontier);
        }
        while next_free < n_parts && depth[next_free].is_some() {
            next_free += 1;
        }
        if next_free == n_parts {
            return order;
        }
        depth[next_free] = Some(1);
        order.push(Placed {
            part: next_free,
            carrier: None,
            by: Carried::Free,
        });
        reach(Some(next_free), 1, &mut frontier);
    }
}
