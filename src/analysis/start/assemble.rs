//! Assembly: positions that satisfy all rows, and the rows that depend on others.
//!
//! Positions move from those of the dataset by the least change that closes the loops. Rank is
//! found there by reflections (`numeric/rank.rs`), translations first; a row that depends on
//! earlier ones is left out, and is no contradiction as long as it holds.

use crate::analysis::direction::{Axis, Direction};
use crate::analysis::look::Look;
use crate::analysis::quantity::{length, short};
use crate::analysis::start::mechanisms::{self, Mechanism, mechanisms};
use crate::analysis::start::nearest::{LONGEST_STEP, MAX_ITERATIONS};
use crate::analysis::start::{alignment, branch, nearby};
use crate::analysis::warning::{AssemblyWarning, Warning};
use crate::arrange::Arrange;
use crate::diagnostic::{Cause, Diagnostic};
use crate::numeric::connected::{Block, SparseRow, connected};
use crate::numeric::rank::Rank;
use crate::physics::row::{Law, body_angles};
use crate::scalar::Scalar;
use crate::scene::broken;
use crate::scene::cams;
use crate::scene::configuration::{Configuration, Configured};
use crate::scene::equations::{Equations, STATIC, row_name};
use crate::scene::mover::Mover;
use crate::scene::programs::weights;
use crate::scene::{RowKind, Scene};
use crate::space::Frame;
use nalgebra::{DMatrix, DVector};
use std::convert::Infallible;

/// Part of a row orthogonal to earlier rows, relative to its length, below which it depends on
/// them.
pub const DEPENDENT: f64 = 1e-8;
/// Strength of a row below which it moves nothing: see [`strengths`].
pub(super) const EMPTY: f64 = 1e-9;
/// Residual of a row that holds, at most, as a part of its scale.
pub const CLOSED: f64 = 1e-10;

/// Residual of a row, as a part of its scale, that is rounding.
const ROUNDING: f64 = 1e-13;
/// Smallest part of a step that is tried.
const SHORTEST_PART: f64 = 1e-6;

/// Residual, relative to its scale and to the worst of all, below which a row is not told.
const LEAST_GAP: f64 = 1e-4;

/// A dependent row, and those that it depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct Redundant {
    /// index of the row
    pub row: usize,
    /// its name: "JOINT/7 Zi.Xj"
    pub name: String,
    /// rows it is a combination of, with factors, largest first
    pub combination: Vec<(usize, f64)>,
}

/// The result of assembly.
#[derive(Clone, Debug, Default)]
pub struct Assembly {
    /// rows that depend on others wherever the mechanism can go near here
    pub redundant: Vec<Redundant>,
    /// freedoms of the assembled mechanism, from the rank near here: velocities that may be chosen
    pub freedom: usize,
    /// rows near here that hold velocities and no position: there are so many more positions that
    /// may be chosen than velocities
    pub of_velocities: usize,
    /// rows that depend on others at the assembled position, be it only there
    pub dependent: Vec<Redundant>,
    /// freedoms to first order, from the rank at the assembled position
    pub freedom_here: usize,
    /// another position near here, when one was looked for and found
    pub place: Option<nearby::Place>,
    /// iterations it took
    pub iterations: usize,
    /// largest change of a coordinate
    pub moved: f64,
    /// warnings for the user
    pub warnings: Vec<Warning>,
}

/// Returns the numbers that programs read, with these positions, velocities and states.
pub(in crate::analysis) fn numbers(
    scene: Configured<'_>,
    t: f64,
    q: &[f64],
    v: &[f64],
    x: &[f64],
) -> Vec<f64> {
    let mut n = Vec::with_capacity(scene.layout.len());
    n.push(t);
    n.extend_from_slice(q);
    n.extend_from_slice(v);
    n.extend_from_slice(x);
    n.extend(scene.configuration.angles());
    n.resize(scene.layout.external().start, 0.0);
    n.extend_from_slice(&scene.configuration.external);
    n.resize(scene.layout.len(), 0.0);
    n
}

/// Lets sums of displacements hold the values of the configuration; returns warnings of those that
/// are not zero.
fn hold(
    scene: &Scene,
    configuration: &mut Configuration,
    t: f64,
    q: &[f64],
    x: &[f64],
) -> Vec<Warning> {
    let (shown, _) = rows_at_rest(scene.within(configuration), t, q, x);
    let mut told = Vec::new();
    begin_motions(scene, configuration, t, q, x);
    let constants = configuration.sums.iter_mut();
    for ((row, constant), &shown) in scene.rows.iter().zip(constants).zip(&shown) {
        let RowKind::Displacements(sum) = &row.kind else {
            continue;
        };
        if !sum.held {
            continue;
        }
        *constant += shown;
        // rounding of what should be zero
        if constant.abs() < 1e-13 * sum.scale(scene.length) {
            *constant = 0.0;
        }
        if *constant != 0.0 && sum.contact.is_none() {
            let held = AssemblyWarning::HeldSum {
                element: row.element,
                sum: *constant,
            };
            told.push(held.into());
        }
    }
    told
}

/// Lets motions given by their rate, without ICDISP, begin where they are.
fn begin_motions(scene: &Scene, configuration: &mut Configuration, t: f64, q: &[f64], x: &[f64]) {
    let here = scene.within(configuration);
    let at = Equations::new(here, &numbers(here, t, q, &vec![0.0; scene.layout.n_v], x));
    let frame = |m: usize| {
        let state = at.marker(m);
        Frame {
            rotation: state.R_GM,
            position: state.p_GM,
        }
    };
    let mut found = Vec::new();
    for (r, row) in scene.rows.iter().enumerate() {
        if let RowKind::Markers {
            law,
            i,
            j,
            motion: Some(m),
        } = row.kind
            && here.is_held(r)
        {
            let begun = scene.motions[m].state.map_or(0.0, |s| x[s]);
            let (i, j) = (frame(i), frame(j));
            let beside = scene.motions[m].beside;
            let shown = match law {
                // the angle beside it begins where it is, too
                Law::BodyAngle { angle, .. } if beside.is_some_and(|b| here.waits(b)) => {
                    body_angles(&i, &j)[angle]
                }
                _ => law.shown(&i, &j, at.row_drive(m).map(|x| x.value)),
            };
            found.push((m, shown - begun));
        }
    }
    for (m, offset) in found {
        configuration.motions[m].offset = offset;
    }
}

/// Evaluates values and gradients of all rows at an instant: g (m), rows of G (m × n_v); zero for
/// those that are left out within tolerance. Equations of velocities have no value, and their
/// gradients are those at [`Scene::velocities_of_rows`].
pub(in crate::analysis) fn rows_at_rest(
    scene: Configured<'_>,
    t: f64,
    q: &[f64],
    x: &[f64],
) -> (DVector<f64>, Vec<SparseRow>) {
    let at = Equations::new(scene, &numbers(scene, t, q, &scene.velocities_of_rows(), x));
    let m = scene.rows.len();
    let (mut g, mut gradient) = (DVector::zeros(m), vec![Vec::new(); m]);
    for r in (0..m).filter(|&r| !scene.configuration.is_loose(r)) {
        let (value, row) = at.row_at_rest(r);
        g[r] = value;
        gradient[r] = merged(row);
    }
    (g, gradient)
}

/// The same about velocities `v`, with the drifts ġ₀ (m): ġ = G v + ġ₀. What they are about matters
/// to equations of velocities that are not linear alone.
pub fn rows_at(
    scene: Configured<'_>,
    t: f64,
    (q, v, x): (&[f64], &[f64], &[f64]),
) -> (DVector<f64>, Vec<SparseRow>, DVector<f64>) {
    let at = Equations::new(scene, &numbers(scene, t, q, v, x));
    let m = scene.rows.len();
    let (mut g, mut gradient, mut drift) =
        (DVector::zeros(m), vec![Vec::new(); m], DVector::zeros(m));
    for r in (0..m).filter(|&r| !scene.configuration.is_loose(r)) {
        let row = at.row(r);
        g[r] = row.value;
        drift[r] = row.drift;
        gradient[r] = merged(row.gradient.clone());
    }
    (g, gradient, drift)
}

/// Adds up what stands in a row for the same velocity.
pub(super) fn merged(mut row: SparseRow) -> SparseRow {
    row.dedup_by(|next, last| {
        let is_same = next.0 == last.0;
        if is_same {
            last.1 += next.1;
        }
        is_same
    });
    row
}

/// Returns a row's residual as a part of its scale, to be compared with [`CLOSED`].
fn relative(scene: &Scene, r: usize, value: f64) -> f64 {
    (value / scene.row_scale(r)).abs()
}

/// Returns how much rows change with the velocities, in what counts as one of each, lengths in
/// sizes of the mechanism   (n_rows)
pub(super) fn strengths(scene: &Scene, gradient: &[SparseRow]) -> Vec<f64> {
    let mut units = vec![1.0; scene.layout.n_v];
    for freedom in scene.freedoms.iter().filter(|f| !f.turn) {
        if let Some(v) = freedom.v {
            units[v] = scene.size;
        }
    }
    let strength = |(r, row): (usize, &SparseRow)| {
        let squares = row.iter().map(|&(v, x)| (x * units[v]).powi(2));
        squares.sum::<f64>().sqrt() / scene.row_scale_at(r, scene.size)
    };
    gradient.iter().enumerate().map(strength).collect()
}

/// Clears the rows that no position has to satisfy.
pub(super) fn clear_rows_of_velocities(scene: &Scene, gradient: &mut [SparseRow]) {
    let of_velocities = (gradient.iter_mut().zip(&scene.rows)).filter(|r| r.1.is_of_velocities());
    of_velocities.for_each(|(row, _)| row.clear());
}

/// Clears the rows that hold and move nothing, as a GCON between markers of one body: the direction
/// of such a row is rounding, and no step along it closes what rounding leaves.
pub(super) fn clear_idle(scene: &Scene, g: &[f64], gradient: &mut [SparseRow]) {
    let strengths = strengths(scene, gradient);
    for (r, row) in gradient.iter_mut().enumerate() {
        if strengths[r] <= EMPTY && relative(scene, r, g[r]) <= CLOSED {
            row.clear();
        }
    }
}

/// Returns the rows of a matrix, columns scaled by √w.
pub(in crate::analysis) fn scaled_rows(a: &[SparseRow], w: &[f64]) -> Vec<Vec<f64>> {
    let row = |row: &SparseRow| {
        let mut dense = vec![0.0; w.len()];
        for &(v, x) in row {
            dense[v] = x * w[v].sqrt();
        }
        dense
    };
    a.iter().map(row).collect()
}

/// Returns the rows of a part of a matrix, columns scaled by √w.
pub(super) fn scaled_part(part: &Block, a: &[SparseRow], w: &[f64]) -> Vec<Vec<f64>> {
    let scale: Vec<f64> = part.columns.iter().map(|&v| w[v].sqrt()).collect();
    let row = |&r: &usize| {
        let mut dense = part.dense(&a[r]);
        dense.iter_mut().zip(&scale).for_each(|(x, s)| *x *= s);
        dense
    };
    part.rows.iter().map(row).collect()
}

/// Decides which rows depend on others.
pub(super) fn rank_of(a: &DMatrix<f64>) -> Rank {
    let go_on = &mut || Ok::<(), Infallible>(());
    let Ok(rank) = rank_while(a, go_on);
    rank
}

/// The same, asking `look` on the way whether to go on.
///
/// # Errors
/// The answer of `look`.
pub(super) fn rank_while<E>(
    a: &DMatrix<f64>,
    look: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Rank, E> {
    let rows = a.row_iter().map(|r| r.iter().copied().collect());
    let rows: Vec<Vec<f64>> = rows.collect();
    Rank::of_while(rows.iter().map(Vec::as_slice), a.ncols(), 1e-9, look)
}

/// Returns the shortest solution of `A x = b` in the metric W, rows counting by their direction;
/// where they contradict, the best. Parts that share no velocity are solved apart.
pub(in crate::analysis) fn least_change(
    a: &[SparseRow],
    w: &[f64],
    b: &DVector<f64>,
) -> DVector<f64> {
    let mut change = DVector::zeros(w.len());
    for part in connected(a, w.len()) {
        let rows = scaled_part(&part, a, w);
        let n = part.columns.len();
        let rank = Rank::of_rows(rows, n, 1e-9);
        let right: Vec<f64> = part.rows.iter().map(|&r| b[r]).collect();
        let mut x = vec![0.0; n];
        rank.least_norm(&right, &mut x);
        for (&v, x) in part.columns.iter().zip(x) {
            change[v] = x * w[v].sqrt();
        }
    }
    change
}

/// The result of [`close`].
pub(in crate::analysis) struct Closed {
    /// iterations it took
    pub iterations: usize,
    /// largest residual, as a part of its row's scale
    pub size: f64,
    /// residuals   (n_rows)
    pub g: DVector<f64>,
}

/// Moves `q` by the least changes that satisfy the rows, but for those that `ignored` names.
pub(in crate::analysis) fn close(
    scene: &Scene,
    configuration: &mut Configuration,
    t: f64,
    q: &mut [f64],
    x: &[f64],
    ignored: impl Fn(Configured<'_>, usize) -> bool,
) -> Closed {
    let go_on = &mut || Ok::<(), Infallible>(());
    let Ok(closed) = close_while((scene, configuration), t, q, x, ignored, go_on);
    closed
}

/// The same, asking `look` between iterations whether to go on.
///
/// # Errors
/// The answer of `look`.
pub(super) fn close_while<E>(
    (scene, configuration): (&Scene, &mut Configuration),
    t: f64,
    q: &mut [f64],
    x: &[f64],
    ignored: impl Fn(Configured<'_>, usize) -> bool,
    look: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Closed, E> {
    let mover = Mover::new(scene);
    // contacts on curves go along
    let rows_at = |configuration: &mut Configuration, q: &[f64]| {
        let still = vec![0.0; scene.layout.n_v];
        let here = numbers(scene.within(configuration), t, q, &still, x);
        cams::track(scene, configuration, &here);
        let configured = scene.within(configuration);
        let (mut g, mut gradient) = rows_at_rest(configured, t, q, x);
        for r in (0..g.len()).filter(|&r| ignored(configured, r)) {
            g[r] = 0.0;
            gradient[r].clear();
        }
        clear_rows_of_velocities(scene, &mut gradient);
        clear_idle(scene, g.as_slice(), &mut gradient);
        (g, gradient)
    };
    let (mut g, mut gradient) = rows_at(configuration, q);
    let worst = |g: &DVector<f64>| {
        (0..g.len())
            .map(|r| relative(scene, r, g[r]))
            .fold(0.0, f64::max)
    };
    let mut iterations = 0;
    let all = mechanisms(scene, gradient.iter());
    let mut closing: Vec<Closing> = all.iter().map(Closing::new).collect();
    let w = mechanisms::weights(&all, scene.layout.n_v);
    while iterations < MAX_ITERATIONS {
        look()?;
        // each mechanism by itself
        let mut asked = gradient.clone();
        for one in &mut closing {
            one.begin(scene, &g);
            if one.is_done {
                one.mechanism.rows.iter().for_each(|&r| asked[r].clear());
            }
        }
        if closing.iter().all(|one| one.is_done) {
            break;
        }
        let step = least_change(&asked, &w, &(-&g));
        closing.iter_mut().for_each(|one| one.shorten(&step, &w));
        loop {
            let mut change = vec![0.0; w.len()];
            closing
                .iter()
                .for_each(|one| one.change(&step, &mut change));
            let (mut moved, mut trial) = (q.to_vec(), q.to_vec());
            mover.displace(&mut moved, &change);
            mover.take_over(&mut trial, &moved, &change);
            let contacts = configuration.contacts.clone();
            let (g1, gradient1) = rows_at(configuration, &trial);
            let mut leads_nearer = true;
            for one in closing.iter_mut().filter(|one| one.is_trying()) {
                leads_nearer &= one.see(&g1);
            }
            if leads_nearer {
                q.copy_from_slice(&trial);
                (g, gradient) = (g1, gradient1);
                break;
            }
            configuration.contacts = contacts;
        }
        iterations += 1;
    }
    let size = worst(&g);
    Ok(Closed {
        iterations,
        size,
        g,
    })
}

/// The state of closing a mechanism.
struct Closing<'m> {
    mechanism: &'m Mechanism,
    /// residuals before the step
    size: f64,
    /// the part of the step that is tried, 0 for none
    part: f64,
    /// its step is one that leads nearer
    is_nearer: bool,
    /// it is closed, or no step leads nearer
    is_done: bool,
}

impl<'m> Closing<'m> {
    fn new(mechanism: &'m Mechanism) -> Self {
        Self {
            mechanism,
            size: 0.0,
            part: 0.0,
            is_nearer: false,
            is_done: false,
        }
    }

    /// Begins an iteration at these residuals.
    fn begin(&mut self, scene: &Scene, g: &DVector<f64>) {
        let mut rows = self.mechanism.rows.iter();
        let one = |r: usize| scene.row_scale_at(r, self.mechanism.reach);
        self.is_done |= rows.all(|&r| (g[r] / one(r)).abs() <= ROUNDING);
        self.size = self.norm(g);
        self.is_nearer = false;
    }

    fn norm(&self, g: &DVector<f64>) -> f64 {
        let rows = self.mechanism.rows.iter();
        rows.map(|&r| g[r] * g[r]).sum::<f64>().sqrt()
    }

    /// Tries so much of a step as may be made at once.
    fn shorten(&mut self, step: &DVector<f64>, w: &[f64]) {
        let sizes = self.mechanism.velocities.iter();
        let longest = sizes
            .map(|&v| step[v].abs() / w[v].sqrt())
            .fold(0.0, f64::max);
        self.part = if self.is_done {
            0.0
        } else {
            (LONGEST_STEP / longest).min(1.0)
        };
    }

    /// Returns whether a part of the step is still sought that leads nearer.
    fn is_trying(&self) -> bool {
        !self.is_done && !self.is_nearer
    }

    /// Puts the part of the step that is tried into a change of all velocities.
    fn change(&self, step: &DVector<f64>, change: &mut [f64]) {
        if !self.is_done {
            for &v in &self.mechanism.velocities {
                change[v] = self.part * step[v];
            }
        }
    }

    /// Sees the residuals where the step leads; returns whether they are smaller.
    fn see(&mut self, g: &DVector<f64>) -> bool {
        self.is_nearer = self.norm(g) < self.size;
        if !self.is_nearer {
            self.part *= 0.5;
            self.is_done = self.part.is_nan() || self.part <= SHORTEST_PART;
        }
        self.is_nearer
    }
}

/// Moves `q` to positions that satisfy all rows at time `t`, and finds which rows depend on others.
///
/// # Errors
/// When the rows contradict each other: which, and by how much.
pub fn positions(
    scene: &Scene,
    configuration: &mut Configuration,
    t: f64,
    q: &mut [f64],
    x: &[f64],
) -> Result<Assembly, Vec<Diagnostic>> {
    positions_while(scene, configuration, t, q, x, &mut || Ok(()))
}

/// The same, asking `look` on the way whether to go on.
///
/// # Errors
/// Those of [`positions`], and what `look` answers.
pub(super) fn positions_while(
    scene: &Scene,
    configuration: &mut Configuration,
    t: f64,
    q: &mut [f64],
    x: &[f64],
    look: Look<'_>,
) -> Result<Assembly, Vec<Diagnostic>> {
    let mut found = Assembly::default();
    let start = q.to_vec();
    // all but the rows that will hold what the others leave
    let held = |scene: Configured<'_>, r: usize| scene.is_held(r);
    let closed = close_while((scene, configuration), t, q, x, held, look)?;
    look()?;
    found.iterations = closed.iterations;
    let here = scene.within(configuration);
    let reached = numbers(here, t, q, &vec![0.0; scene.layout.n_v], x);
    if let Some(broken) = broken::broken(here, &reached, None) {
        return Err(vec![
            Diagnostic::error(broken.code(), broken.reason.to_string())
                .element(broken.element)
                .help(broken.advice()),
        ]);
    }
    if !closed.size.is_finite() || closed.size > CLOSED {
        return Err(contradictions(here, &closed.g, &reached));
    }
    found.moved = q
        .iter()
        .zip(&start)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    found.warnings = hold(scene, configuration, t, q, x);
    branch::refer(scene, configuration, t, q, x, false);
    let here = scene.within(configuration);
    let aligned = alignment::told(here);
    found
        .warnings
        .extend(aligned.into_iter().map(Warning::from));
    look()?;
    let (_, gradient) = rows_at_rest(here, t, q, x);
    let n = scene.layout.n_v;
    look()?;
    let (independent, dependent) = rank_of_rows(scene, &gradient, &[], look)?;
    look()?;
    found.freedom_here = n - independent.len();
    (found.freedom, found.redundant) = (found.freedom_here, dependent.clone());
    let mut active = independent;
    if !dependent.is_empty()
        && let Some(around) = nearby::look(here, t, q, x, &active, look)?
    {
        // rows that depend on others here and nowhere else take part
        found.freedom = n - around.independent.len();
        found.redundant = around.redundant;
        active = around.independent;
        found.place = Some(around.q);
    }
    found.dependent = dependent;
    for rows in [&mut found.redundant, &mut found.dependent] {
        alignment::explain(here, &reached, &active, rows);
    }
    let of_velocities = active.iter().filter(|&&r| scene.rows[r].is_of_velocities());
    found.of_velocities = of_velocities.count();
    configuration.active = vec![false; scene.rows.len()];
    active.iter().for_each(|&r| configuration.active[r] = true);
    Ok(found)
}

/// Returns errors of the rows that do not hold, worst first: by how much, and in which direction.
fn contradictions(scene: Configured<'_>, g: &DVector<f64>, numbers: &[f64]) -> Vec<Diagnostic> {
    let mut bad: Vec<usize> = (0..g.len())
        .filter(|&r| relative(&scene, r, g[r]) > CLOSED || !g[r].is_finite())
        .collect();
    bad.arrange_by(|&a, &b| relative(&scene, b, g[b]).total_cmp(&relative(&scene, a, g[a])));
    // beside the worst, what rounding leaves open is no contradiction
    let worst = bad.first().map_or(0.0, |&r| relative(&scene, r, g[r]));
    bad.retain(|&r| {
        let size = relative(&scene, r, g[r]);
        size >= LEAST_GAP * worst || !size.is_finite()
    });
    let at = Equations::new(scene, numbers);
    bad.into_iter()
        .take(20)
        .map(|r| {
            let row = &scene.rows[r];
            Diagnostic::error(Cause::Assembly, format!("cannot be satisfied: {}", gap(&scene, &at, r, g[r])))
                .element(row.element)
                .help("move the parts nearer to where the joints want them, or remove a constraint that contradicts")
        })
        .collect()
}

/// Writes how far a row is from being satisfied: "Zi.Xj is off by 3 deg about ground X".
fn gap(scene: &Scene, at: &Equations<'_, f64>, r: usize, g: f64) -> String {
    let row = &scene.rows[r];
    let direction = Direction::of_row(scene, at, r);
    let along = || format!("{} {}", length(g, &scene.length_unit), direction.way());
    let by = match row.kind {
        // no motion turns two parallel axes away from each other to first order
        RowKind::Markers {
            law: Law::Dot(a, b),
            i,
            j,
            ..
        } if direction == Direction::Nothing => {
            let axis = |k: usize, m: usize| Axis::Marker(scene.markers[m].id, k).to_string();
            return format!(
                "the axes {} and {} are parallel; {} needs 90 deg between them",
                axis(a, i),
                axis(b, j),
                row.equation
            );
        }
        RowKind::Markers { law, .. } if law.is_length() => along(),
        RowKind::Cam { .. } => along(),
        RowKind::Markers { .. } => {
            let angle = Scalar::asin(g.clamp(-1.0, 1.0)).to_degrees();
            format!("{} deg {}", short(angle.abs()), direction.way())
        }
        RowKind::Displacements(_) | RowKind::Formula { .. } => short(g.abs()),
    };
    format!("{} is off by {by}", row.equation)
}

/// Finds independent rows, and for each other row the rows that it is a combination of:
/// translations before rotations before sums. Rows in `first` come before all others, but for
/// equations of velocities, which come last and take no part at rest.
pub fn rank(
    scene: &Scene,
    gradient: &[SparseRow],
    first: &[usize],
) -> (Vec<usize>, Vec<Redundant>) {
    let go_on = &mut || Ok::<(), Infallible>(());
    let Ok(found) = rank_of_rows(scene, gradient, first, go_on);
    found
}

/// The same, asking `look` on the way whether to go on.
///
/// # Errors
/// The answer of `look`.
pub(super) fn rank_of_rows<E>(
    scene: &Scene,
    gradient: &[SparseRow],
    first: &[usize],
    look: &mut dyn FnMut() -> Result<(), E>,
) -> Result<(Vec<usize>, Vec<Redundant>), E> {
    let w = &weights(scene)[..];
    let mut preferred = vec![false; scene.rows.len()];
    first.iter().for_each(|&r| preferred[r] = true);
    let kind = |r: usize| match &scene.rows[r].kind {
        RowKind::Markers { law, .. } => u8::from(!law.is_length()),
        RowKind::Displacements(_) | RowKind::Formula { .. } | RowKind::Cam { .. } => 2,
    };
    let order = |&r: &usize| {
        let of_velocities = scene.rows[r].is_of_velocities();
        (of_velocities, !preferred[r], kind(r), r)
    };
    let strengths = strengths(scene, gradient);
    let rests = |r: usize| scene.mode == STATIC && scene.rows[r].is_of_velocities();
    let (mut independent, mut redundant) = (Vec::new(), Vec::new());
    for mut part in connected(gradient, w.len()) {
        part.rows.retain(|&r| !rests(r));
        part.rows.arrange_by_key(order);
        let mut rows = scaled_part(&part, gradient, w);
        for (row, &r) in rows.iter_mut().zip(&part.rows) {
            // a row that moves nothing there says nothing about what its direction is
            if strengths[r] <= EMPTY {
                row.fill(0.0);
            }
        }
        let n = part.columns.len();
        let rank = Rank::of_rows_while(rows, n, DEPENDENT, look)?;
        independent.extend(rank.independent().into_iter().map(|k| part.rows[k]));
        redundant.extend(rank.dependent().into_iter().map(|d| {
            let mut combination: Vec<(usize, f64)> = d
                .combination
                .into_iter()
                .map(|(k, f)| (part.rows[k], f))
                .filter(|c| c.1.abs() > 1e-6)
                .collect();
            combination.arrange_by(|a, b| b.1.abs().total_cmp(&a.1.abs()).then(a.0.cmp(&b.0)));
            let row = part.rows[d.row];
            let name = row_name(&scene.rows[row]);
            Redundant {
                row,
                name,
                combination,
            }
        }));
    }
    independent.sort_unstable();
    redundant.arrange_by_key(|d: &Redundant| order(&d.row));
    Ok((independent, redundant))
}

/// Returns an orthonormal basis of the vectors that a matrix maps to zero, by columns.
pub fn null_space(a: &DMatrix<f64>) -> DMatrix<f64> {
    directions(&rank_of(a), a.ncols())
}

/// Returns the directions that rows leave free, by columns.
pub(super) fn directions(rank: &Rank, n: usize) -> DMatrix<f64> {
    let free = rank.free_directions();
    DMatrix::from_fn(n, free.len(), |i, j| free[j][i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::manual;
    use crate::model::Model;
    use crate::scene::build::Options;

    #[test]
    fn rows_without_drifts_are_those_with_drifts_to_the_bit() {
        let mut n_compared = 0;
        // every joint as rows
        let options = Options {
            cut_all: true,
            ..Options::default()
        };
        for example in manual::examples() {
            let Ok(model) = Model::from_text(example.dataset) else {
                continue;
            };
            let Ok(scene) = Scene::compile(&model, &options) else {
                continue;
            };
            let (configuration, x) = (Configuration::new(&scene), vec![0.0; scene.layout.n_x]);
            let here = scene.within(&configuration);
            for k in 0..4 {
                let moved = |(j, q): (usize, &f64)| q + 0.01 * f64::from(k) * (j as f64).cos();
                let q: Vec<f64> = scene.initial_q.iter().enumerate().map(moved).collect();
                let (g, gradient) = rows_at_rest(here, 0.1, &q, &x);
                let v = scene.velocities_of_rows();
                let (same_g, same_gradient, _) = rows_at(here, 0.1, (&q, &v, &x));
                let bits = |g: &DVector<f64>, gradient: &[SparseRow]| -> Vec<(usize, u64)> {
                    let values = g.iter().copied().enumerate();
                    let all = values.chain(gradient.iter().flatten().copied());
                    // numbers that are none have no sign
                    let plain = |x: f64| if x.is_nan() { f64::NAN } else { x };
                    all.map(|(place, x)| (place, plain(x).to_bits())).collect()
                };
                let (own, same) = (bits(&g, &gradient), bits(&same_g, &same_gradient));
                assert_eq!(own, same, "{} {k}", example.name);
                n_compared += gradient.iter().flatten().count();
            }
        }
        assert!(n_compared > 100, "{n_compared}");
    }
}
