//! Redundancy within a tolerance: rows that would follow from others if the axes of a model were
//! aligned exactly.
//!
//! ```text
//! kept     rows of joints, chosen until none adds more than NEARLY_DEPENDENT                 (1)
//! off      of a row that was not: the largest of its gap |g|, of what it determines beyond the
//!          kept rows, here and nearby, and of Δ|g| over the way between                      (2)
//! loose    off ≤ tolerance: left out, and told                                               (3)
//! refused  tolerance < off ≤ NEARLY_DEPENDENT, and it takes the last freedom of its loops,
//!          or its gap cannot be closed without; where it fits as it is drawn, off ≤ SHAKY    (4)
//! sound    everything else: the row takes part as any other does                             (5)
//! ```
//!
//! Four parallel axes make a planar four-bar, which moves; tilted by any angle, however small, they
//! make a structure. Files have axes of six or seven digits. So lengths are compared with the size
//! of a row's own loop, angles with one radian, and the tolerance is IC/ERROR. Its default here,
//! `TOLERANCE`, is twenty times the rounding of six digits, as the errors of several markers add
//! up in a loop; Adams finds redundant rows by pivots and needs no such number.
//!
//! A structure that fits as it is drawn may be close to one that moves, and not be meant to move:
//! of random ones, one in four hundred has a row that is off by less than NEARLY_DEPENDENT, one
//! in a thousand by less than SHAKY. It is known by the latter, and where IC/ERROR is so small that
//! only rounding is left over: then every row counts as it is.
//!
//! A position where rows depend on each other in passing (a folded parallelogram) is no
//! misalignment: (2) is measured nearby, too.

use crate::analysis::direction::Direction;
use crate::analysis::look::Look;
use crate::analysis::quantity::amount;
use crate::analysis::start::assemble::{self, CLOSED, DEPENDENT, Redundant};
use crate::analysis::start::nearby::Surroundings;
use crate::analysis::start::nearest::{LONGEST_STEP, MAX_ITERATIONS};
use crate::analysis::warning::AssemblyWarning;
use crate::arrange::Arrange;
use crate::diagnostic::{Cause, Diagnostic};
use crate::model::ElementKind;
use crate::numeric::connected::{Block, SparseRow, connected};
use crate::numeric::rank::Rank;
use crate::scene::cams;
use crate::scene::configuration::{Configuration, Configured, LooseRow};
use crate::scene::equations::Equations;
use crate::scene::mover::Mover;
use crate::scene::programs::weights;
use crate::scene::{LinkMotion, RowKind, Scene, Source};
use crate::space::Vec3;

/// Part that a row determines beyond others, in rad or parts of the size of its loop, above which
/// it is no misalignment.
pub const NEARLY_DEPENDENT: f64 = 0.05;
/// The same where a row fits as it is drawn, and the others leave no freedom: twice the largest
/// misalignment that is told.
const SHAKY: f64 = 0.02;
/// IC/ERROR up to which every row counts as it is.
const AS_DRAWN: f64 = 1e-12;
/// Value of an entry, scaled, below which it is rounding.
const ROUNDING: f64 = 1e-13;
/// Largest deviation (2) of a row that follows exactly: rounding, as rows are closed to 1e-13.
const EXACT: f64 = 1e-11;
/// Change of a coordinate at which these have arrived, rad or parts of a loop.
const ARRIVED: f64 = 1e-10;
/// Way by which motions are moved to look nearby, in rad or parts of the length of the scene.
const DRIVEN: f64 = 0.05;
/// Places nearby at which rows are measured, and the steps that lead there, the first first.
const PLACES: usize = 2;
const STEPS: [(f64, bool); 5] = [
    (0.05, true),
    (0.05, true),
    (0.05, false),
    (0.02, true),
    (0.02, false),
];

/// Finds the rows that depend on others within tolerance near positions `q`, and lets the
/// configuration leave them out. Positions stay as they are.
///
/// # Errors
/// Rows that are off by more, and lock what the others leave free: which, and by how much; and what
/// `look` answers, which is asked on the way.
pub(in crate::analysis) fn leave_out(
    scene: &Scene,
    configuration: &mut Configuration,
    t: f64,
    q: &[f64],
    x: &[f64],
    look: Look<'_>,
) -> Result<(), Vec<Diagnostic>> {
    configuration.loose.clear();
    if scene.alignment <= AS_DRAWN {
        return Ok(());
    }
    let Some(search) = Search::new(scene, configuration, t, q, x) else {
        return Ok(());
    };
    let mut q = q.to_vec();
    look()?;
    if !search.approach(configuration, &mut q) {
        return Ok(());
    }
    look()?;
    let mut nearly = search.nearly_dependent(configuration, &q);
    while !nearly.is_empty() {
        look()?;
        // the kept rows, exactly
        let mut trial = configuration.clone();
        trial.loose = nearly.iter().map(|&row| LooseRow::new(row)).collect();
        let held = |scene: Configured<'_>, r: usize| scene.is_held(r);
        let closed = assemble::close(scene, &mut trial, t, &mut q, x, held);
        if closed.size.is_nan() || closed.size > CLOSED {
            return Ok(());
        }
        let found = search.measure(&trial, &q, &nearly);
        // rows that are dependent here in passing are sound
        let sound = |m: &Misfit| m.off.is_nan() || m.off > NEARLY_DEPENDENT;
        if found.iter().any(sound) {
            nearly = found.iter().filter(|m| !sound(m)).map(|m| m.row).collect();
            continue;
        }
        let (loose, beyond): (Vec<Misfit>, Vec<Misfit>) =
            found.into_iter().partition(|m| m.off <= scene.alignment);
        let refused = search.refused(&trial, &q, &beyond);
        if !refused.is_empty() {
            return Err(refused);
        }
        configuration.loose = search.inexact(&loose);
        break;
    }
    Ok(())
}

/// Returns warnings of the rows that a configuration leaves out within tolerance: of each element
/// the one that is off most.
pub(super) fn told(scene: Configured<'_>) -> Vec<AssemblyWarning> {
    let mut worst: Vec<&LooseRow> = Vec::new();
    let exact = CLOSED / scene.alignment;
    let inexact = |l: &&LooseRow| l.off > exact * l.limit;
    for row in scene.configuration.loose.iter().filter(inexact) {
        let element = |l: &LooseRow| scene.rows[l.row].element;
        match worst.iter_mut().find(|w| element(w) == element(row)) {
            Some(w) if row.off / row.limit > w.off / w.limit => *w = row,
            Some(_) => {}
            None => worst.push(row),
        }
    }
    let tell = |l: &&LooseRow| AssemblyWarning::LeftOut {
        element: scene.rows[l.row].element,
        equation: scene.rows[l.row].equation.clone(),
        off: l.off,
        limit: l.limit,
        is_length: is_length(&scene, l.row),
        unit: scene.length_unit.clone(),
    };
    worst.iter().map(tell).collect()
}

/// Finds for each row that a configuration leaves out within tolerance the rows that take part of
/// which it is, but for that, a combination.
pub(super) fn explain(
    scene: Configured<'_>,
    numbers: &[f64],
    independent: &[usize],
    found: &mut [Redundant],
) {
    let loose = &scene.configuration.loose;
    if loose.is_empty() {
        return;
    }
    let at = Equations::new(scene, numbers);
    let w = weights(&scene);
    let order: Vec<usize> = independent
        .iter()
        .copied()
        .chain(loose.iter().map(|l| l.row))
        .collect();
    let dense = |&r: &usize| {
        let mut row = vec![0.0; w.len()];
        for (v, x) in at.row_at_rest(r).1 {
            row[v] += x * w[v].sqrt() / scene.row_scale(r);
        }
        row
    };
    let all = order.iter().map(dense).collect();
    let rank = Rank::scaled(all, independent.len(), w.len(), DEPENDENT);
    for d in rank.dependent() {
        let row = order[d.row];
        let Some(one) = found.iter_mut().find(|one| one.row == row) else {
            continue;
        };
        let mut combination: Vec<(usize, f64)> = (d.combination.iter())
            .filter(|c| c.1.abs() > scene.alignment)
            .map(|&(k, f)| {
                let scale = scene.row_scale(row) / scene.row_scale(order[k]);
                (order[k], f * scale)
            })
            .collect();
        combination.arrange_by(|a, b| b.1.abs().total_cmp(&a.1.abs()).then(a.0.cmp(&b.0)));
        one.combination = combination;
    }
}

/// Returns whether the value of a row of markers is a length.
pub(in crate::analysis) fn is_length(scene: &Scene, row: usize) -> bool {
    matches!(&scene.rows[row].kind, RowKind::Markers { law, .. } if law.is_length())
}

/// By how much a row does not follow from the kept ones.
#[derive(Clone, Copy, Debug)]
struct Misfit {
    row: usize,
    /// |g| where the kept rows are closed, against what counts as one
    gap: f64,
    /// the largest deviation (2), against what counts as one
    off: f64,
}

/// Values and gradients of all rows at one place, scaled.
struct Rows {
    values: Vec<f64>,
    gradients: Vec<SparseRow>,
}

/// The search for rows that are dependent within tolerance.
struct Search<'s> {
    scene: &'s Scene,
    t: f64,
    x: &'s [f64],
    /// rows that may be left out: those of JOINTs and JPRIMs   (n_rows)
    geometric: Vec<bool>,
    /// what counts as one in each row: rad, or the size of its loop   (n_rows)
    one: Vec<f64>,
    /// what counts as one in each velocity: rad, or the size of the largest loop it is in   (n_v)
    unit: Vec<f64>,
    /// rows that hang together, and their velocities
    loops: Vec<Block>,
}

impl<'s> Search<'s> {
    /// Measures the loops of a scene; `None` where no joint closes one.
    fn new(
        scene: &'s Scene,
        configuration: &Configuration,
        t: f64,
        q: &[f64],
        x: &'s [f64],
    ) -> Option<Self> {
        let geometric: Vec<bool> = scene
            .rows
            .iter()
            .map(|row| {
                matches!(row.kind, RowKind::Markers { motion: None, .. })
                    && matches!(row.element.kind, ElementKind::Joint | ElementKind::Jprim)
            })
            .collect();
        if !geometric.contains(&true) {
            return None;
        }
        let here = scene.within(configuration);
        let numbers = assemble::numbers(here, t, q, &vec![0.0; scene.layout.n_v], x);
        let at = Equations::new(here, &numbers);
        let mut one: Vec<f64> = (0..scene.rows.len()).map(|r| scene.row_scale(r)).collect();
        let mut unit = vec![0.0_f64; scene.layout.n_v];
        let mut structure: Vec<SparseRow> = vec![Vec::new(); scene.rows.len()];
        for r in 0..scene.rows.len() {
            if let RowKind::Markers { i, j, .. } = scene.rows[r].kind {
                let size = loop_size(&at, scene, i, j);
                if is_length(scene, r) {
                    one[r] = size;
                }
                structure[r] = at.row_at_rest(r).1;
                for (v, _) in &structure[r] {
                    unit[*v] = unit[*v].max(size);
                }
            }
        }
        for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
            if let Some(v) = f.v {
                if c.angular {
                    unit[v] = 1.0;
                } else if unit[v] == 0.0 {
                    unit[v] = scene.length;
                }
            }
        }
        Some(Self {
            scene,
            t,
            x,
            geometric,
            one,
            loops: connected(&structure, unit.len()),
            unit,
        })
    }

    /// Evaluates all rows, left out or not.
    fn rows(&self, configuration: &Configuration, q: &[f64]) -> Rows {
        let scene = self.scene.within(configuration);
        let numbers = assemble::numbers(scene, self.t, q, &vec![0.0; self.unit.len()], self.x);
        let at = Equations::new(scene, &numbers);
        let mut found = Rows {
            values: Vec::new(),
            gradients: Vec::new(),
        };
        for (r, &one) in self.one.iter().enumerate() {
            if scene.is_held(r) {
                found.values.push(0.0);
                found.gradients.push(Vec::new());
                continue;
            }
            let (value, row) = at.row_at_rest(r);
            let mut entries = assemble::merged(row);
            entries
                .iter_mut()
                .for_each(|(v, x)| *x *= self.unit[*v] / one);
            entries.retain(|e| e.1.abs() > ROUNDING);
            found.values.push(value / one);
            found.gradients.push(entries);
        }
        found
    }

    /// Moves `q` towards the rows that are clearly independent; returns whether it arrived.
    fn approach(&self, configuration: &Configuration, q: &mut [f64]) -> bool {
        let mover = Mover::new(self.scene);
        let mut own = configuration.clone();
        let n = self.unit.len();
        for _ in 0..MAX_ITERATIONS {
            let here = self.scene.within(&own);
            let numbers = assemble::numbers(here, self.t, q, &vec![0.0; n], self.x);
            cams::track(self.scene, &mut own, &numbers);
            let rows = self.rows(&own, q);
            let mut step = vec![0.0; n];
            for block in connected(&rows.gradients, n) {
                let width = block.columns.len();
                let all: Vec<_> = block.rows.iter().map(|&r| &rows.gradients[r]).collect();
                let dense = all.iter().map(|row| block.dense(row)).collect();
                let rank = Rank::scaled(dense, all.len(), width, NEARLY_DEPENDENT);
                let missing: Vec<f64> = block.rows.iter().map(|&r| -rows.values[r]).collect();
                let mut x = vec![0.0; width];
                rank.least_norm(&missing, &mut x);
                for (&v, x) in block.columns.iter().zip(x) {
                    step[v] = x;
                }
            }
            let longest = step.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
            if !longest.is_finite() {
                return false;
            }
            let damping = (LONGEST_STEP / longest).min(1.0);
            for (s, unit) in step.iter_mut().zip(&self.unit) {
                *s *= damping * unit;
            }
            mover.displace(q, &step);
            if longest < ARRIVED {
                return true;
            }
        }
        false
    }

    /// Returns the rows of a block that may be left out: translations first.
    fn candidates(&self, block: &Block) -> Vec<usize> {
        let rows = block.rows.iter().copied();
        let mut rows: Vec<usize> = rows.filter(|&r| self.geometric[r]).collect();
        rows.arrange_by_key(|&r| (!is_length(self.scene, r), r));
        rows
    }

    /// Finds the rows that determine next to nothing beyond others.
    fn nearly_dependent(&self, configuration: &Configuration, q: &[f64]) -> Vec<usize> {
        let rows = self.rows(configuration, q);
        let mut found = Vec::new();
        for block in connected(&rows.gradients, self.unit.len()) {
            let order = self.candidates(&block);
            let dense = order.iter().map(|&r| block.dense(&rows.gradients[r]));
            let rank = Rank::scaled(
                dense.collect(),
                order.len(),
                block.columns.len(),
                NEARLY_DEPENDENT,
            );
            found.extend(rank.dependent().iter().map(|d| order[d.row]));
        }
        found.sort_unstable();
        found
    }

    /// Measures how far each of some rows is from following from the others, here and nearby.
    fn measure(&self, configuration: &Configuration, q: &[f64], nearly: &[usize]) -> Vec<Misfit> {
        let mut found = self.misfits(configuration, q, nearly);
        self.measure_driven(configuration, q, nearly, &mut found);
        let here = self.scene.within(configuration);
        let Some(mut around) = Surroundings::new(here, self.t, q, self.x) else {
            return found;
        };
        let mut seen = 0;
        for step in STEPS {
            let Some((place, there)) = around.step(step) else {
                continue;
            };
            let nearby = self.misfits(&there, &place.q, nearly);
            for (here, nearby) in found.iter_mut().zip(nearby) {
                let growth = (nearby.gap - here.gap).abs() / step.0;
                here.off = here.off.max(nearby.off - nearby.gap).max(growth);
            }
            seen += 1;
            if seen == PLACES {
                break;
            }
        }
        found
    }

    /// Measures rows where the motions stand a little further or less far, if that can be reached:
    /// a driven loop near its dead point is no misalignment.
    fn measure_driven(
        &self,
        configuration: &Configuration,
        q: &[f64],
        nearly: &[usize],
        found: &mut [Misfit],
    ) {
        let here = self.scene.within(configuration);
        let numbers = assemble::numbers(here, self.t, q, &vec![0.0; self.unit.len()], self.x);
        let at = Equations::new(here, &numbers);
        let prescribed: Vec<f64> = (0..self.scene.motions.len())
            .map(|m| at.prescribed(m).value)
            .collect();
        if prescribed.is_empty() {
            return;
        }
        for way in [DRIVEN, -DRIVEN] {
            let mut there = configuration.clone();
            for (m, motion) in there.motions.iter_mut().enumerate() {
                motion.stands_at = Some(prescribed[m] + way * self.scene.unit_of_motion(m));
            }
            let mut q = q.to_vec();
            let held = |scene: Configured<'_>, r: usize| scene.is_held(r);
            let closed = assemble::close(self.scene, &mut there, self.t, &mut q, self.x, held);
            if closed.size.is_nan() || closed.size > CLOSED {
                continue;
            }
            let nearby = self.misfits(&there, &q, nearly);
            for (here, nearby) in found.iter_mut().zip(nearby) {
                let growth = (nearby.gap - here.gap).abs() / DRIVEN;
                here.off = here.off.max(nearby.off - nearby.gap).max(growth);
            }
            return;
        }
    }

    /// Measures gaps of some rows, and what they determine beyond the others, at one place.
    fn misfits(&self, configuration: &Configuration, q: &[f64], nearly: &[usize]) -> Vec<Misfit> {
        let rows = self.rows(configuration, q);
        let mut found: Vec<Misfit> = nearly
            .iter()
            .map(|&row| {
                let gap = rows.values[row].abs();
                Misfit { row, gap, off: gap }
            })
            .collect();
        for block in connected(&rows.gradients, self.unit.len()) {
            let order = self.candidates(&block);
            let (mut order, last): (Vec<usize>, Vec<usize>) =
                order.iter().partition(|r| nearly.binary_search(r).is_err());
            if last.is_empty() {
                continue;
            }
            let kept = order.len();
            order.extend(last);
            let dense = order.iter().map(|&r| block.dense(&rows.gradients[r]));
            let rank = Rank::scaled(dense.collect(), kept, block.columns.len(), DEPENDENT);
            for d in rank.dependent() {
                if let Ok(k) = nearly.binary_search(&order[d.row]) {
                    found[k].off = found[k].off.max(d.remainder);
                }
            }
        }
        found
    }

    /// Returns errors of the rows beyond tolerance that lock their loops, or that have gaps which
    /// only a motion along what the others leave free could close.
    fn refused(
        &self,
        configuration: &Configuration,
        q: &[f64],
        beyond: &[Misfit],
    ) -> Vec<Diagnostic> {
        if beyond.is_empty() {
            return Vec::new();
        }
        let rows = self.rows(configuration, q);
        let is_beyond = |r: &usize| beyond.iter().any(|m| m.row == *r);
        let left_out = |r: &usize| configuration.is_loose(*r);
        let mut found: Vec<Misfit> = Vec::new();
        for block in connected(&rows.gradients, self.unit.len()) {
            let order = self.candidates(&block);
            let is_meant = |m: &Misfit| m.gap <= EXACT && m.off > SHAKY;
            let own: Vec<Misfit> = (beyond.iter().copied())
                .filter(|m| order.contains(&m.row) && !is_meant(m))
                .collect();
            // a driven loop near its dead point has such rows, too: assembly and the run find those
            // that cannot be satisfied
            if own.is_empty() || self.is_driven(&block) {
                continue;
            }
            let width = block.columns.len();
            let rank = |chosen: Vec<&usize>| {
                let dense: Vec<Vec<f64>> = (chosen.iter())
                    .map(|&&r| block.dense(&rows.gradients[r]))
                    .collect();
                let all = dense.len();
                Rank::scaled(dense, all, width, DEPENDENT).rank()
            };
            let kept = rank(order.iter().filter(|r| !left_out(r)).collect());
            let all = rank(
                (order.iter())
                    .filter(|r| !left_out(r) || is_beyond(r))
                    .collect(),
            );
            let gap = own.iter().any(|m| m.gap > self.scene.alignment);
            if all > kept && (all == width || gap) {
                found.extend(own);
            }
        }
        self.errors(configuration, q, found)
    }

    /// Returns whether motions may have a say in a block: by a row of their own, by a coordinate on
    /// the way around one of its loops, or by what ties displacements to theirs.
    fn is_driven(&self, block: &Block) -> bool {
        let scene = self.scene;
        if scene.motions.is_empty() {
            return false;
        }
        let driven: Vec<usize> = (scene.coordinates.iter())
            .filter(|c| matches!(c.source, Source::Driven(_)))
            .map(|c| c.link)
            .collect();
        block.rows.iter().any(|&r| match scene.rows[r].kind {
            RowKind::Markers {
                i, j, motion: None, ..
            } => ways(scene, i, j).iter().any(|link| driven.contains(link)),
            _ => true,
        })
    }

    /// Writes an error of each element: its row that is off most.
    fn errors(
        &self,
        configuration: &Configuration,
        q: &[f64],
        mut found: Vec<Misfit>,
    ) -> Vec<Diagnostic> {
        let scene = self.scene.within(configuration);
        let numbers = assemble::numbers(scene, self.t, q, &vec![0.0; self.unit.len()], self.x);
        let at = Equations::new(scene, &numbers);
        found.arrange_by(|a, b| b.off.total_cmp(&a.off).then(a.row.cmp(&b.row)));
        let mut named = Vec::new();
        let mut errors = Vec::new();
        for m in found {
            let row = &scene.rows[m.row];
            if named.contains(&row.element) {
                continue;
            }
            named.push(row.element);
            let length = is_length(&scene, m.row);
            let write = |x: f64| amount(x * self.one[m.row], length, &scene.length_unit);
            let way = match Direction::of_row(&scene, &at, m.row) {
                Direction::Nothing => String::new(),
                direction => format!(" {}", direction.way()),
            };
            let (off, limit) = (write(m.off), write(scene.alignment));
            let message = format!(
                "it locks what the other joints leave free, as its axes are not aligned with theirs: \
                 {} is off by {off}{way}; up to {limit} it would be redundant and left out",
                row.equation
            );
            errors.push(Diagnostic::error(Cause::Assembly, message).element(row.element).help(
                "align its markers with those of the other joints, or say by IC/ERROR what may be left over; \
                 where it is meant to lock them, IC/ERROR=1E-12 takes every equation as it is",
            ));
        }
        errors
    }

    /// Returns the rows that are left out: all of those loops in which one does not follow exactly.
    fn inexact(&self, loose: &[Misfit]) -> Vec<LooseRow> {
        let mut found = Vec::new();
        for one in &self.loops {
            let own = || {
                let rows = loose.iter();
                rows.filter(|m| one.rows.binary_search(&m.row).is_ok())
            };
            if own().all(|m| m.off <= EXACT) {
                continue;
            }
            found.extend(own().map(|m| LooseRow {
                row: m.row,
                off: m.off * self.one[m.row],
                limit: self.scene.alignment * self.one[m.row],
            }));
        }
        found.arrange_by_key(|l| l.row);
        found
    }
}

/// Returns the size of the loop that a tie between markers I and J closes: the diagonal of the box
/// about the two and the turning joints on the ways to what carries both; that of the mechanism
/// where they all coincide.
fn loop_size(at: &Equations<'_, f64>, scene: &Scene, i: usize, j: usize) -> f64 {
    let turns = |k: &usize| {
        matches!(
            scene.links[*k].motion,
            LinkMotion::Turn { .. } | LinkMotion::Ball { .. }
        )
    };
    let between = ways(scene, i, j);
    let links = between.iter().filter(|k| turns(k));
    let origins = links.map(|&k| at.links()[k].X_GL.position);
    let points = origins.chain([i, j].map(|m| at.marker(m).p_GM));
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for point in points {
        for k in 0..3 {
            low[k] = low[k].min(point.0[k]);
            high[k] = high[k].max(point.0[k]);
        }
    }
    let size = Vec3([0, 1, 2].map(|k| high[k] - low[k])).norm();
    if size.is_finite() && size > DEPENDENT * scene.length {
        size
    } else {
        scene.length
    }
}

/// Returns the links on the ways from markers I and J to what carries both.
fn ways(scene: &Scene, i: usize, j: usize) -> Vec<usize> {
    // links stand behind those that carry them: the ways meet where both are the same
    let (mut ends, mut between) = ([i, j].map(|m| scene.markers[m].link), Vec::new());
    while ends[0] != ends[1] {
        let outer = usize::from(ends[0] < ends[1]);
        let Some(link) = ends[outer] else { break };
        between.push(link);
        ends[outer] = scene.links[link].parent;
    }
    between
}
