//! Interference over a run: how near the solids of GRAPHICS come to each other, or how deep they
//! stand in each other, at every output, from the record alone.
//!
//! Solids are those that a CONTACT can touch: boxes, cylinders, frustums, ellipsoids, planes (as
//! half spaces) and shells. Of a shell that is not its convex hull the surface is looked at where
//! solids are apart; how deep it overlaps is that of the hull. Between outputs nothing is looked
//! at.

use super::motion::Recorded;
use super::session::shells::shell_of;
use crate::dataset::surface::Surfaces as Read;
use crate::diagnostic::Diagnostic;
use crate::model::{ElementId, ElementKind, Model, Shape};
use crate::physics::contact::Solid;
use crate::physics::contact::query::separation::{Gap, Separation};
use crate::physics::contact::query::shell::{Shell, Surfaces};
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
    /// its surface, where its hull does not show it
    shell: Option<Shell>,
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
    /// shells of which something is known of their convex hull alone, and what
    pub hulls: Vec<(ElementId, &'static str)>,
}

/// The depth of an overlap with a concave shell.
const DEEPER: &str = "is concave: how deep it overlaps is told of its convex hull, at most so deep; \
    distances are those of its surface";
/// The same of a convex shell of many corners.
const FEWER_CORNERS: &str =
    "has more corners than its convex hull is given: how deep it overlaps is told of that hull";
/// The distance of a shell of too many triangles.
const HULL_ALONE: &str = "is concave and has too many triangles for the other shell: its convex hull is looked at, \
    so that a hollow counts as filled";

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
            let shells = [a, b].map(|placed| placed.shell.as_ref());
            let surfaces = Surfaces::new([&a.solid, &b.solid], shells);
            for (m, placed) in [(k, a), (l, b)] {
                if frames[m].is_none() {
                    frames[m] = Some(recorded.frames(placed.marker)?);
                }
            }
            let (Some(X_GI), Some(X_GJ)) = (&frames[k], &frames[l]) else {
                continue;
            };
            let gap = |i, j| {
                let of_hulls = || separation.at(i, j);
                let Some(surfaces) = &surfaces else {
                    return of_hulls();
                };
                // of what touches, a hull may be free
                let touching = |gap: Gap| Gap {
                    distance: gap.distance.min(0.0),
                    ..gap
                };
                let apart = surfaces.apart(i, j);
                apart.or_else(|| of_hulls().map(touching))
            };
            let gaps: Vec<Option<Gap>> = X_GI.iter().zip(X_GJ).map(|(i, j)| gap(i, j)).collect();
            let is_plane = |placed: &Placed| matches!(placed.solid, Solid::Plane { .. });
            for placed in [a, b] {
                // a half space touches the hull, whatever its hollows
                if placed.shell.is_none() || is_plane(a) || is_plane(b) {
                    continue;
                }
                let overlaps = gaps.iter().flatten().any(|gap| gap.distance < 0.0);
                let told = match surfaces {
                    None => Some(HULL_ALONE),
                    Some(_) if placed.shell.as_ref().is_some_and(|s| s.hollow > 0.0) => {
                        overlaps.then_some(DEEPER)
                    }
                    Some(_) => overlaps.then_some(FEWER_CORNERS),
                };
                let told = told.map(|what| (placed.graphics, what));
                found
                    .hulls
                    .extend(told.filter(|t| !found.hulls.contains(t)));
            }
            found.pairs.push(Pair {
                graphics: [a.graphics, b.graphics],
                bodies: [a.body, b.body],
                gaps,
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
    let surfaces = Read::read(model, folders);
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
            let surface = surfaces.known.get(&n);
            let shell = surface.and_then(|s| Shell::new(&s.points, &s.faces, &solid));
            Ok(Placed {
                graphics: id,
                body,
                marker,
                solid,
                shell,
            })
        });
        match placed {
            Ok(placed) => solids.push(placed),
            Err(why) => left_out.push((id, why)),
        }
    }
    solids
}
