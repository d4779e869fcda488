//! Interference over a run: how near the solids of GRAPHICS come to each other, or how deep they
//! stand in each other, at every output, from the record alone.
//!
//! Solids are those that a CONTACT can touch: boxes, cylinders, frustums, ellipsoids, planes (as
//! half spaces) and the convex hulls of shells. Between outputs nothing is looked at.

use super::motion::Recorded;
use super::session::shells::shell_of;
use crate::diagnostic::Diagnostic;
use crate::model::{ElementId, ElementKind, Model, Shape};
use crate::physics::contact::Solid;
use crate::physics::contact::query::separation::{Gap, Separation};
use crate::scene::contacts::solid_of;
use crate::space::Frame;
use std::path::PathBuf;

/// A solid of the model: its GRAPHICS, the body that carries it, its marker.
#[derive(Clone, Debug)]
struct Placed {
    graphics: ElementId,
    body: ElementId,
    marker: u32,
    solid: Solid,
}

/// Two solids over a run.
#[derive(Clone, Debug)]
pub struct Pair {
    /// their GRAPHICS
    pub graphics: [ElementId; 2],
    /// the bodies that carry them
    pub bodies: [ElementId; 2],
    /// per row of the record; `None`: the record has no place there
    pub gaps: Vec<Option<Gap>>,
}

impl Pair {
    /// Returns the row at which they come nearest or overlap most, with the distance.
    pub fn nearest(&self) -> Option<(usize, Gap)> {
        let found = self.gaps.iter().enumerate();
        let found = found.filter_map(|(row, gap)| Some((row, (*gap)?)));
        found.min_by(|a, b| a.1.distance.total_cmp(&b.1.distance))
    }

    /// Returns the spans of rows, first and last, in which they are nearer than a distance.
    pub fn spans_nearer_than(&self, distance: f64) -> Vec<[usize; 2]> {
        let mut spans: Vec<[usize; 2]> = Vec::new();
        for (row, gap) in self.gaps.iter().enumerate() {
            if !gap.is_some_and(|gap| gap.distance < distance) {
                continue;
            }
            match spans.last_mut() {
                Some(last) if last[1] + 1 == row => last[1] = row,
                _ => spans.push([row, row]),
            }
        }
        spans
    }
}

/// The interference of a run.
#[derive(Clone, Debug, Default)]
pub struct Interference {
    /// the pairs that were looked at
    pub pairs: Vec<Pair>,
    /// GRAPHICS that were not, with the reason
    pub left_out: Vec<(ElementId, String)>,
}

/// Finds the distances of solids on different bodies at every row of a record: of all, or of those
/// `chosen` pairs of GRAPHICS or bodies. Files of shells are looked for in `folders`.
///
/// # Errors
/// A marker that does not move with a part, or a part whose motion the record lacks.
pub fn interference(
    recorded: &Recorded<'_>,
    model: &Model,
    chosen: &[[ElementId; 2]],
    folders: &[PathBuf],
) -> Result<Interference, Diagnostic> {
    let mut found = Interference::default();
    let solids = solids(model, folders, &mut found.left_out);
    let is_chosen = |a: &Placed, b: &Placed| {
        let is = |placed: &Placed, id: ElementId| placed.graphics == id || placed.body == id;
        let mut pairs = chosen.iter();
        chosen.is_empty() || pairs.any(|&[p, q]| is(a, p) && is(b, q) || is(a, q) && is(b, p))
    };
    let mut frames: Vec<Option<Vec<Frame<f64>>>> = vec![None; solids.len()];
    for (k, a) in solids.iter().enumerate() {
        for (l, b) in solids.iter().enumerate().skip(k + 1) {
            if a.body == b.body || !is_chosen(a, b) {
                continue;
            }
            let Some(separation) = Separation::new(&a.solid, &b.solid) else {
                continue;
            };
            for (m, placed) in [(k, a), (l, b)] {
                if frames[m].is_none() {
                    frames[m] = Some(recorded.frames(placed.marker)?);
                }
            }
            let (Some(X_GI), Some(X_GJ)) = (&frames[k], &frames[l]) else {
                continue;
            };
            let gaps = X_GI.iter().zip(X_GJ).map(|(i, j)| separation.at(i, j));
            found.pairs.push(Pair {
                graphics: [a.graphics, b.graphics],
                bodies: [a.body, b.body],
                gaps: gaps.collect(),
            });
        }
    }
    Ok(found)
}

/// Returns the solids of a model; tells which GRAPHICS are none.
fn solids(
    model: &Model,
    folders: &[PathBuf],
    left_out: &mut Vec<(ElementId, String)>,
) -> Vec<Placed> {
    let mut solids = Vec::new();
    for (&n, graphics) in &model.graphics {
        let id = ElementKind::Graphics.id(n);
        let found = match &graphics.shape {
            Shape::External { rm, file, .. } | Shape::Shell { rm, file } => {
                shell_of(file, folders).map(|shell| (*rm, Solid::Hull(shell.corners)))
            }
            shape => solid_of(id, shape).ok_or_else(|| "is no solid".to_owned()),
        };
        let placed = found.and_then(|(marker, solid)| {
            let body = model.body_of(marker);
            let body = body.ok_or_else(|| "stands on no part".to_owned())?;
            let is_plane = matches!(solid, Solid::Plane { .. });
            if !is_plane && !solid.can_be_queried() {
                return Err(format!("a {} has no distance here", solid.name()));
            }
            Ok(Placed {
                graphics: id,
                body,
                marker,
                solid,
            })
        });
        match placed {
            Ok(placed) => solids.push(placed),
            Err(why) => left_out.push((id, why)),
        }
    }
    solids
}
