//! Velocities to start with: those of the dataset as far as the rows permit them, and otherwise
//! those of least kinetic energy: those of a mechanism at rest that is struck where velocities are
//! given.

use super::assemble::{
    DEPENDENT, EMPTY, clear_rows_of_velocities, directions, least_change, numbers, rank_while,
    rows_at, strengths,
};
use super::given_velocities::{Given, GivenVelocities, Level};
use super::initial_conditions::of_joints;
use super::mechanisms::{self, mechanisms};
use super::nearest::MAX_ITERATIONS;
use super::tangents::Tangents;
use crate::analysis::direction::Direction;
use crate::analysis::look::Look;
use crate::analysis::quantity::{length, short};
use crate::analysis::warning::ConditionWarning;
use crate::diagnostic::{Cause, Diagnostic};
use crate::model::{self, ElementId, ElementKind, InitialQuantity, Model};
use crate::numeric::connected::{Block, SparseRow};
use crate::scalar::Jet;
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::scene::programs::weights;
use crate::scene::{LinkIx, Row, Scene};
use crate::space::{Frame, MarkerState, Mat3, Vec3};
use nalgebra::{DMatrix, DVector};

/// Part of a rate by which it may be off and is met.
const MET_TOLERANCE: f64 = 1e-6;
/// Part of a part's velocity by which it may be off and is met: it was typed with few digits.
const TYPED_DIGITS: f64 = 1e-3;
/// Part of the speeds of a mechanism below which a difference is rounding of what was written.
const ROUNDING: f64 = 1e-12;

/// Returns the error of motions that ask for a rate which a row forbids: by how much it would have
/// to give way, and which motions there are.
fn prescribed_too_much(
    (scene, model): (Configured<'_>, &Model),
    numbers: &[f64],
    r: usize,
    rate: f64,
) -> Diagnostic {
    let at = Equations::new(scene, numbers);
    let row = &scene.rows[r];
    let direction = Direction::of_row(&scene, &at, r);
    let way = direction.way();
    let rate = if direction.is_rotation() {
        format!("{} deg", short(rate.abs().to_degrees()))
    } else {
        length(rate, &scene.length_unit)
    };
    let motions: Vec<String> = (scene.motions.iter())
        .map(|m| model.called(ElementKind::Motion.id(m.id)))
        .collect();
    Diagnostic::error(
        Cause::Assembly,
        format!(
            "the prescribed velocities contradict it: {} would have to give way by {rate} per unit of time {way}",
            row.equation
        ),
    )
    .element(row.element)
    .help(format!(
        "prescribe less, or rates that go together: there are {}",
        motions.join(", ")
    ))
}

/// Velocities to start with.
#[derive(Clone, Debug)]
pub(in crate::analysis) struct Beginning {
    /// (n_v)
    pub v: Vec<f64>,
    /// with other masses they would be others: rows and given velocities leave some of them free
    pub is_weighed: bool,
}

impl Beginning {
    /// Returns velocities in which masses have no say.
    pub fn fixed(v: Vec<f64>) -> Self {
        let is_weighed = false;
        Self { v, is_weighed }
    }
}

/// Returns the velocities that satisfy the rows: those that the dataset gives come first, those of
/// constraints before those of parts; the rest has the least kinetic energy   (n_v)
///
/// # Errors
/// When the motions ask for velocities that the rows forbid.
pub fn velocities(
    scene: Configured<'_>,
    model: &Model,
    t: f64,
    q: &[f64],
    x: &[f64],
) -> Result<Vec<f64>, Vec<Diagnostic>> {
    velocities_while(scene, model, (t, q, x), &mut || Ok(())).map(|begun| begun.v)
}

/// The same, asking `look` on the way whether to go on.
///
/// # Errors
/// Those of [`velocities`], and what `look` answers.
pub(in crate::analysis) fn velocities_while(
    scene: Configured<'_>,
    model: &Model,
    (t, q, x): (f64, &[f64], &[f64]),
    look: Look<'_>,
) -> Result<Beginning, Vec<Diagnostic>> {
    // equations of velocities by their tangents, first at the velocities that the others permit
    let mut begun = velocities_about(scene, model, (t, q, x), None, look)?;
    if !scene.has_rows_of_velocities() {
        return Ok(begun);
    }
    let mut about = match have_tangents(scene, t, (q, &begun.v, x)) {
        true => begun.v.clone(),
        false => scene.velocities_of_rows(),
    };
    for _ in 0..MAX_ITERATIONS {
        begun = velocities_about(scene, model, (t, q, x), Some(&about), look)?;
        if is_same(&begun.v, &about) {
            break;
        }
        about.copy_from_slice(&begun.v);
    }
    let numbers = numbers(scene, t, q, &begun.v, x);
    let at = Equations::new(scene, &numbers);
    for (r, row) in scene
        .rows
        .iter()
        .enumerate()
        .filter(|r| r.1.is_of_velocities())
    {
        let left = at.row_rate(&at.row(r));
        let fastest = (begun.v.iter().zip(weights(&scene))).map(|(v, w)| v.abs() / w.sqrt());
        let met = MET_TOLERANCE * scene.row_scale(r) * fastest.fold(1.0, f64::max);
        if left.is_nan() || left.abs() > met {
            return Err(vec![no_velocities(row, left)]);
        }
    }
    Ok(begun)
}

/// Returns whether velocities are others but for rounding.
fn is_same(v: &[f64], others: &[f64]) -> bool {
    let off = (v.iter().zip(others)).map(|(a, b)| (a - b).abs());
    let largest = v.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    off.fold(0.0, f64::max) <= ROUNDING * largest
}

/// Returns whether all equations of velocities have tangents at a state, by which they are solved.
fn have_tangents(scene: Configured<'_>, t: f64, (q, v, x): (&[f64], &[f64], &[f64])) -> bool {
    let (_, gradient, drift) = rows_at(scene, t, (q, v, x));
    let strengths = strengths(&scene, &gradient);
    let rows = scene.rows.iter().enumerate();
    let mut rows = rows.filter(|(_, row)| row.is_of_velocities());
    rows.all(|(r, _)| drift[r].is_finite() && strengths[r] > EMPTY)
}

/// Returns the error of an equation of velocities that the other rows keep from being satisfied.
fn no_velocities(row: &Row, left: f64) -> Diagnostic {
    let what = format!(
        "no velocities satisfy it with the other constraints: its {} is {} at the nearest ones",
        row.equation,
        short(left)
    );
    Diagnostic::error(Cause::Assembly, what)
        .element(row.element)
        .help("ask for velocities that the mechanism can have, or remove what forbids them")
}

/// Returns gradients and drifts of the rows, those of equations of velocities `about` some
/// velocities; `None`: zero.
fn rows_about(
    scene: Configured<'_>,
    (t, q, x): (f64, &[f64], &[f64]),
    about: Option<&[f64]>,
) -> (Vec<SparseRow>, DVector<f64>) {
    let still = vec![0.0; scene.layout.n_v];
    let (_, mut gradient, mut drift) = rows_at(scene, t, (q, about.unwrap_or(&still), x));
    if about.is_none() {
        clear_rows_of_velocities(&scene, &mut gradient);
        let rows = scene.rows.iter().enumerate();
        let of_velocities = rows.filter(|(_, row)| row.is_of_velocities());
        of_velocities.for_each(|(r, _)| drift[r] = 0.0);
    }
    (gradient, drift)
}

/// Returns the first row that velocities do not satisfy, and its rate.
fn unsatisfied(
    (gradient, drift): (&[SparseRow], &DVector<f64>),
    v: &DVector<f64>,
) -> Option<(usize, f64)> {
    let entries = gradient.iter().flatten();
    let largest = entries.fold(0.0, |m: f64, e| m.max(e.1.abs()));
    let scale = 1.0 + drift.amax().max(largest);
    let rates = gradient.iter().enumerate();
    let mut rates = rates.map(|(r, row)| (r, along(row, v) + drift[r]));
    rates.find(|(_, left)| left.abs() > 1e-8 * scale)
}

/// Returns the velocities that satisfy the rows, equations of velocities by their tangents `about`
/// some velocities; `None`: without these.
fn velocities_about(
    scene: Configured<'_>,
    model: &Model,
    (t, q, x): (f64, &[f64], &[f64]),
    about: Option<&[f64]>,
    look: Look<'_>,
) -> Result<Beginning, Vec<Diagnostic>> {
    let n = scene.layout.n_v;
    let (gradient, drift) = rows_about(scene, (t, q, x), about);
    look()?;
    // v = v₀ + N z, with N the null space of the rows
    let firm = without_empty(scene, &gradient);
    let own = mechanisms(&scene, gradient.iter());
    let w = mechanisms::weights(&own, n);
    let mut v = least_change(&firm, &w, &(-&drift));
    look()?;
    if let Some((r, left)) = unsatisfied((&gradient, &drift), &v) {
        let still = numbers(scene, t, q, &vec![0.0; n], x);
        return Err(vec![match scene.rows[r].is_of_velocities() {
            true => no_velocities(&scene.rows[r], left),
            false => prescribed_too_much((scene, model), &still, r, left),
        }]);
    }
    let sizes = mechanisms::sizes_by_links(&own, scene.links.len());
    let given = GivenVelocities::collect((scene, &sizes), model, (t, q, x), (&gradient, &v));
    if given.are_met {
        return Ok(Beginning::fixed(v.iter().copied().collect()));
    }
    let levels = given.levels();
    // what shares no velocity is looked at apart
    let all = levels.iter().flat_map(|level| &level.rows);
    let all: Vec<SparseRow> = gradient.iter().chain(all).cloned().collect();
    let (mut changed, mut is_weighed) = (false, false);
    for mechanism in mechanisms(&scene, all.iter()) {
        let part = Block {
            rows: mechanism.equations,
            columns: mechanism.velocities,
        };
        look()?;
        let own = Part::new(&part, &firm, levels, &w);
        let here = own.of(&v);
        if own.holds(&here) {
            continue;
        }
        changed = true;
        let (nearest, left) = own.nearest(here, look)?;
        is_weighed |= left.ncols() > 0;
        // without rounding dust where the dataset says zero
        let dust = 1e-14 * nearest.amax();
        for ((&k, x), one) in part.columns.iter().zip(nearest.iter()).zip(&own.units) {
            v[k] = if x.abs() < dust { 0.0 } else { x * one };
        }
        // where branches meet, along one of them
        let kept = |r: usize| about.is_some() || !scene.rows[r].is_of_velocities();
        let dependences = own.dependences(&part, scene, kept, look)?;
        if dependences.is_empty() {
            continue;
        }
        look()?;
        let tangents = Tangents::new(scene, (t, q, x), dependences);
        let whole = |s: nalgebra::DVectorView<'_, f64>| {
            let mut all = DVector::zeros(n);
            let entries = part.columns.iter().zip(s.iter()).zip(&own.units);
            entries.for_each(|((&k, x), one)| all[k] = x * one);
            all
        };
        let free: Vec<DVector<f64>> = left.column_iter().map(whole).collect();
        if let Some(along) = tangents.nearest(&v, &free, |v| own.off(&own.of(v))) {
            v = along;
        }
    }
    if !changed {
        return Ok(Beginning::fixed(v.iter().copied().collect()));
    }
    let v = v.iter().copied().collect();
    Ok(Beginning { v, is_weighed })
}

/// Returns warnings of the joints whose initial rate is not that of their IC, and of the parts
/// whose velocity is not the one that they are given.
pub fn unmet(
    scene: Configured<'_>,
    model: &Model,
    t: f64,
    (q, v, x): (&[f64], &[f64], &[f64]),
) -> Vec<ConditionWarning> {
    let numbers = numbers(scene, t, q, v, x);
    let at = Equations::new(scene, &numbers);
    let speeds = Speeds::of(&scene, model, &at);
    let is_off = |found: f64, wanted: f64, is_angle: bool| {
        let off = (found - wanted).abs();
        off > MET_TOLERANCE * found.abs().max(wanted.abs()) && off > speeds.rounding(is_angle)
    };
    let told = joint_rates(&scene, model, &at);
    let told = told.into_iter().filter_map(|rate| {
        let JointRate {
            id, found, wanted, ..
        } = rate;
        is_off(found, wanted, rate.is_angle).then_some(ConditionWarning::UnmetRate {
            element: ElementKind::Joint.id(id),
            found,
            wanted,
        })
    });
    let of_lines = line_rates(&scene, model, &at).into_iter();
    let of_lines = of_lines.filter(|r| is_off(r.found, r.wanted, r.is_angle));
    let of_lines = of_lines.map(|r| ConditionWarning::Unmet {
        element: r.element,
        argument: r.argument,
        found: r.found,
        wanted: r.wanted,
    });
    told.chain(of_lines)
        .chain(unmet_of_parts(&scene, model, &at, &speeds))
        .collect()
}

/// Returns warnings of the parts whose velocity at the start is not the one that they are given.
fn unmet_of_parts(
    scene: &Scene,
    model: &Model,
    at: &Equations<'_, f64>,
    speeds: &Speeds,
) -> Vec<ConditionWarning> {
    const NAMES: [&str; 6] = ["VX", "VY", "VZ", "WX", "WY", "WZ"];
    let mut told = Vec::new();
    for part in &scene.parts {
        let Some((data, [v, w])) = model.body(part.id).and_then(|data| {
            let own = components(scene, data, at)?;
            Some((data, own))
        }) else {
            continue;
        };
        let given = data.velocity.iter().chain(&data.angular_velocity);
        let found = v.into_iter().chain(w);
        for (k, (given, found)) in given.zip(found).enumerate() {
            let argument = NAMES[k];
            let rounding = speeds.rounding(k >= 3);
            let unmet = given.filter(|wanted| {
                (found - wanted).abs() > (TYPED_DIGITS * wanted.abs()).max(rounding)
            });
            if let Some(wanted) = unmet.filter(|wanted| *wanted != 0.0) {
                told.push(ConditionWarning::Unmet {
                    element: part.id,
                    argument,
                    found,
                    wanted,
                });
            }
        }
    }
    told
}

/// The largest speeds of a mechanism, found or asked for: against them rounding is told from a
/// difference.
struct Speeds {
    /// of a point
    way: f64,
    /// of a rotation
    turn: f64,
}

impl Speeds {
    fn of(scene: &Scene, model: &Model, at: &Equations<'_, f64>) -> Self {
        // what takes more than 1e12 units of time to go through the mechanism is not seen in a run
        let mut speeds = Self {
            way: scene.size,
            turn: 1.0,
        };
        for part in &scene.parts {
            let Some(data) = model.body(part.id) else {
                continue;
            };
            let [v, w] = components(scene, data, at).unwrap_or_default();
            let given = data.velocity.iter().flatten();
            let all = given.chain(v.iter());
            speeds.way = all.fold(speeds.way, |most, x| most.max(x.abs()));
            let given = data.angular_velocity.iter().flatten();
            let all = given.chain(w.iter());
            speeds.turn = all.fold(speeds.turn, |most, x| most.max(x.abs()));
        }
        speeds.way = speeds.way.max(speeds.turn * scene.size);
        speeds
    }

    /// Returns what is rounding.
    fn rounding(&self, is_angle: bool) -> f64 {
        ROUNDING * if is_angle { self.turn } else { self.way }
    }
}

/// Returns the velocity of a part's centre of mass in the axes of VM, and its angular velocity in
/// those of WM; `None`: it has no CM.
pub(super) fn components(
    scene: &Scene,
    data: &model::Part,
    at: &Equations<'_, f64>,
) -> Option<[[f64; 3]; 2]> {
    let frame = |m: Option<u32>| {
        let &marker = scene.marker_of.get(&m?)?;
        Some(at.marker(marker))
    };
    let cm = frame(data.cm)?;
    let axes_v = frame(data.vm).map_or_else(Mat3::identity, |m| m.R_GM);
    let axes_w = frame(data.wm).map_or(cm.R_GM, |m| m.R_GM);
    let along = |axes: &Mat3<f64>, x: Vec3<f64>| [0, 1, 2].map(|k| axes.column(k).dot(x));
    Some([along(&axes_v, cm.v_GM), along(&axes_w, cm.w_GM)])
}

/// Returns `row · v`.
fn along(row: &[(usize, f64)], v: &DVector<f64>) -> f64 {
    row.iter().fold(0.0, |sum, &(k, x)| sum + x * v[k])
}

/// The rows and the given velocities of parts that share no velocity with any others, whose
/// velocities count in what is one of each.
struct Part {
    /// places of its velocities in v   (n)
    columns: Vec<usize>,
    /// what counts as one of each   (n)
    units: Vec<f64>,
    /// the rows   (m × n)
    g: DMatrix<f64>,
    /// what is given, the first first: matrix, right side
    levels: [(DMatrix<f64>, DVector<f64>); Level::ALL],
}

impl Part {
    /// Collects them: rows of `part` count through the rows of G, then through those of each level.
    /// `w`: squares of what counts as one of each velocity.
    fn new(part: &Block, gradient: &[SparseRow], levels: [&Given; Level::ALL], w: &[f64]) -> Self {
        let n = part.columns.len();
        let units: Vec<f64> = part.columns.iter().map(|&v| w[v].sqrt()).collect();
        let dense = |rows: &[&SparseRow]| {
            let rows: Vec<Vec<f64>> = rows.iter().map(|row| part.dense(row)).collect();
            DMatrix::from_fn(rows.len(), n, |i, j| rows[i][j] * units[j])
        };
        let mut from = gradient.len();
        let of_rows: Vec<&SparseRow> = (part.rows.iter())
            .filter_map(|&r| gradient.get(r))
            .collect();
        let g = dense(&of_rows);
        let levels = levels.map(|level| {
            let range = from..from + level.rows.len();
            let own: Vec<usize> = (part.rows.iter().filter(|r| range.contains(*r)))
                .map(|r| r - from)
                .collect();
            from = range.end;
            let rows: Vec<&SparseRow> = own.iter().map(|&k| &level.rows[k]).collect();
            let right = own.iter().map(|&k| level.right[k]);
            (dense(&rows), DVector::from_iterator(own.len(), right))
        });
        let columns = part.columns.clone();
        Self {
            columns,
            units,
            g,
            levels,
        }
    }

    /// Returns its velocities among all.
    fn of(&self, v: &DVector<f64>) -> DVector<f64> {
        let own = self.columns.iter().zip(&self.units);
        DVector::from_iterator(self.units.len(), own.map(|(&k, one)| v[k] / one))
    }

    /// Returns whether velocities are those that are given.
    fn holds(&self, v: &DVector<f64>) -> bool {
        (self.levels.iter()).all(|(a, b)| (b - a * v).amax() == 0.0)
    }

    /// Returns the combinations of rows of `scene` that are zero in first order, of those that are
    /// `kept`.
    fn dependences(
        &self,
        part: &Block,
        scene: Configured<'_>,
        kept: impl Fn(usize) -> bool,
        look: Look<'_>,
    ) -> Result<Vec<SparseRow>, Vec<Diagnostic>> {
        let own = |r: usize| part.rows.get(r).copied();
        let kept = |r: &usize| !scene.configuration.is_loose(*r) && kept(*r);
        let all = rank_while(&self.g, look)?.dependent().into_iter();
        let combination = all.map(|d| {
            let others = d.combination.iter().map(|&(r, x)| (r, -x));
            let terms = std::iter::once((d.row, 1.0)).chain(others);
            let terms = terms.filter_map(|(r, x)| Some((own(r).filter(kept)?, x)));
            terms.collect::<SparseRow>()
        });
        Ok(combination.filter(|terms| !terms.is_empty()).collect())
    }

    /// Returns how far velocities are from rest, by their energy; without masses by their size.
    fn off(&self, v: &DVector<f64>) -> f64 {
        let [.., energy, rest] = &self.levels;
        let (a, b) = if energy.0.nrows() > 0 { energy } else { rest };
        (b - a * v).norm()
    }

    /// Returns the velocities nearest to the given ones that the rows permit, from some that they
    /// do, and the directions that rows and given ones leave free, by columns.
    fn nearest(
        &self,
        mut v: DVector<f64>,
        look: Look<'_>,
    ) -> Result<(DVector<f64>, DMatrix<f64>), Vec<Diagnostic>> {
        let mut space = directions(&rank_while(&self.g, look)?, self.g.ncols());
        let mut left = space.clone();
        // each level as well as may be within the freedom that the levels before leave
        for (level, (a, b)) in self.levels.iter().enumerate() {
            if level == Level::Energy as usize {
                left = space.clone();
            }
            if space.ncols() == 0 || a.nrows() == 0 {
                continue;
            }
            let mut reduced = a * &space;
            // a velocity square to all that is free is not to be had: what is left is rounding
            for r in 0..reduced.nrows() {
                if reduced.row(r).norm() <= EMPTY * a.row(r).norm() {
                    reduced.row_mut(r).fill(0.0);
                }
            }
            let rank = rank_while(&reduced, look)?;
            look()?;
            let mut z = vec![0.0; space.ncols()];
            rank.least_squares((b - a * &v).as_slice(), &mut z);
            v += &space * DVector::from_vec(z);
            look()?;
            space = &space * directions(&rank, space.ncols());
        }
        Ok((v, left))
    }
}

/// Returns the rows of a matrix, zeros for those that move nothing: the direction of such a row is
/// rounding.
fn without_empty(scene: Configured<'_>, gradient: &[SparseRow]) -> Vec<SparseRow> {
    let strengths = strengths(&scene, gradient);
    let filled = |(r, row): (usize, &SparseRow)| {
        let empty = strengths[r] <= DEPENDENT;
        let entry = |&(v, x): &(usize, f64)| (v, if empty { 0.0 } else { x });
        row.iter().map(entry).collect()
    };
    gradient.iter().enumerate().map(filled).collect()
}

/// Returns the velocities nearest to the given ones that all rows permit   (n_v)
pub(in crate::analysis) fn nearest_velocities(
    scene: Configured<'_>,
    t: f64,
    q: &[f64],
    x: &[f64],
    v: &[f64],
) -> Vec<f64> {
    let nearest = |given: &[f64], about: &[f64]| -> Vec<f64> {
        let (_, gradient, drift) = rows_at(scene, t, (q, about, x));
        let given = DVector::from_column_slice(given);
        let mut missing = -drift;
        for (r, row) in gradient.iter().enumerate() {
            missing[r] -= along(row, &given);
        }
        let change = least_change(&without_empty(scene, &gradient), &weights(&scene), &missing);
        (given + change).iter().copied().collect()
    };
    if !scene.has_rows_of_velocities() {
        return nearest(v, &vec![0.0; scene.layout.n_v]);
    }
    let mut found = v.to_vec();
    for _ in 0..MAX_ITERATIONS {
        let next = nearest(&found, &found);
        let is_there = is_same(&next, &found);
        found = next;
        if is_there {
            break;
        }
    }
    found
}

/// Returns the link that carries a marker; `None`: ground does, or it is not there.
pub(super) fn link_of(scene: &Scene, marker: u32) -> LinkIx {
    scene.markers[*scene.marker_of.get(&marker)?].link
}

/// A rate that a comment line of ours gives.
pub(super) struct LineRate {
    pub element: ElementId,
    pub argument: &'static str,
    /// a link that it depends on
    pub link: LinkIx,
    pub found: f64,
    /// of the velocities that it is a difference of
    pub size: f64,
    pub wanted: f64,
    pub is_angle: bool,
}

/// Returns the rates that comment lines of ours give joints and markers.
pub(super) fn line_rates(scene: &Scene, model: &Model, at: &Equations<'_, f64>) -> Vec<LineRate> {
    let mut all = Vec::new();
    for (&id, values) in model
        .beginnings
        .iter()
        .filter(|(id, _)| model.is_active(**id))
    {
        for (&quantity, &wanted) in values {
            let found = match quantity {
                InitialQuantity::VariableRate(k) => {
                    model.joints.get(&id.number).and_then(|joint| {
                        let &(_, gauge) = joint.kind.row().variables.get(k)?;
                        let state = |m: u32| Some(at.marker(*scene.marker_of.get(&m)?));
                        let (i, j) = (state(joint.i)?, state(joint.j)?);
                        let link = link_of(scene, joint.i).or_else(|| link_of(scene, joint.j));
                        let size = size_between(&i, &j, gauge.is_angle());
                        let rate = gauge.value(&moving(&i), &moving(&j)).first;
                        Some(((rate, size), link, gauge.is_angle()))
                    })
                }
                InitialQuantity::Rate(k) => scene.marker_of.get(&id.number).map(|&m| {
                    let state = at.marker(m);
                    let turning = state.w_GM.norm();
                    let rate = match k {
                        0..3 => (state.v_GM.0[k], state.v_GM.norm() + turning * scene.size),
                        _ => (state.w_GM.0[k - 3], turning),
                    };
                    (rate, scene.markers[m].link, k >= 3)
                }),
                InitialQuantity::Variable(_) | InitialQuantity::Place(_) => None,
            };
            all.extend(found.map(|((found, size), link, is_angle)| LineRate {
                element: id,
                argument: model.initial_quantity_name(id, quantity),
                link,
                found,
                size,
                wanted,
                is_angle,
            }));
        }
    }
    all
}

/// Returns the frame of a marker with its rates: Ṙ = ω × R, column by column.
pub(in crate::analysis) fn moving(m: &MarkerState<f64>) -> Frame<Jet> {
    let jets = |value: Vec3<f64>, rate: Vec3<f64>| {
        Vec3([0, 1, 2].map(|k| Jet::new(value.0[k], rate.0[k], 0.0)))
    };
    let columns = [0, 1, 2].map(|k| {
        let axis = m.R_GM.column(k);
        jets(axis, m.w_GM.cross(axis))
    });
    Frame {
        rotation: Mat3::from_columns(columns[0], columns[1], columns[2]),
        position: jets(m.p_GM, m.v_GM),
    }
}

/// Returns how large the velocities are of which the rate between two markers is a difference.
fn size_between(i: &MarkerState<f64>, j: &MarkerState<f64>, is_angle: bool) -> f64 {
    let turning = i.w_GM.norm() + j.w_GM.norm();
    if is_angle {
        turning
    } else {
        i.v_GM.norm() + j.v_GM.norm() + (i.p_GM - j.p_GM).norm() * turning
    }
}

/// The rate of a joint, and the one that it is asked to begin with.
pub(super) struct JointRate {
    pub id: u32,
    pub found: f64,
    /// of the velocities that it is a difference of
    pub size: f64,
    pub wanted: f64,
    pub is_angle: bool,
}

/// Returns the rates of the joints of which an initial rate is asked.
pub(super) fn joint_rates(scene: &Scene, model: &Model, at: &Equations<'_, f64>) -> Vec<JointRate> {
    let mut found = Vec::new();
    for (id, gauge, [_, rate]) in of_joints(model) {
        let joint = &model.joints[&id];
        let markers = [joint.i, joint.j].map(|m| scene.marker_of.get(&m));
        let ([Some(&i), Some(&j)], Some(rate)) = (markers, rate) else {
            continue;
        };
        let (i, j) = (at.marker(i), at.marker(j));
        let z = j.R_GM.column(2);
        let own = if gauge.is_angle() {
            (i.w_GM - j.w_GM).dot(z)
        } else {
            (i.v_GM - j.v_GM).dot(z) + (i.p_GM - j.p_GM).dot(j.w_GM.cross(z))
        };
        found.push(JointRate {
            id,
            found: own,
            size: size_between(&i, &j, gauge.is_angle()),
            wanted: rate,
            is_angle: gauge.is_angle(),
        });
    }
    found
}
