//! Small motions about a state: eigenvalues, mode shapes, and the matrices of the linear system
//! between plant inputs and outputs.
//!
//! The rate is differentiated as it stands, and restricted to what the rows allow:
//!
//! ```text
//! δq = T Z ξ,  δv = Y η + P ξ      H Z = 0,  Zᵀ Z = 1,  G Y = 0,  Yᵀ Y = 1,  P = −G⁺ ∂(G v + ġ₀)/∂q Z
//! ż = A z + B u,  y = C z + D u    z = (ξ, η, x)          (T: from tangents to positions)
//! ```
//!
//! with all rows in G and those that hold positions in H. Equations of velocities leave fewer
//! velocities η than positions ξ; without them Y = Z.
//!
//! Turns of free parts and of balls, whose numbers count in a frame that turns along, are written
//! in one that stands still at that instant: for a top alike all round A is that of all instants.
//! With every position free, ξ are the changes of the coordinates themselves. An input is a number
//! added to its VARIABLE, so that whatever else the VARIABLE does goes on. Motions keep moving;
//! about a state in which things move, A is that of the instant, and [`Unrest`] says so.

mod growth;
mod modes;
mod unrest;
mod write;

pub use crate::analysis::warning::{Rate, Unrest};
pub(in crate::analysis) use growth::{Growth, growth};

use crate::analysis::start::assemble;
use crate::analysis::system::{System, complaints};
use crate::diagnostic::Diagnostic;
use crate::expr::program::{Program, Work};
use crate::model::{ElementKind, Model};
use crate::scalar::hypot;
use crate::scene::Scene;
use crate::scene::equations::Equations;
use crate::scene::external_inputs::ExternalInput;
use crate::scene::layout::Layout;
use crate::scene::programs::record;
use crate::scene::slopes::{self, Direction};
use nalgebra::{DMatrix, DVector};

/// The options of LINEAR.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wanted {
    /// PINPUT and POUTPUT whose VARIABLEs are u and y; `None`: all there are, in the order of their
    /// numbers
    pub inputs: Option<u32>,
    /// see `inputs`
    pub outputs: Option<u32>,
    /// leave out all that depends on velocities
    pub no_damping: bool,
    /// first and last mode whose shape is wanted, from 1; `None`: all
    pub shapes: Option<[usize; 2]>,
}

/// The motion of a part in a mode; real and imaginary parts.
#[derive(Clone, Debug, PartialEq)]
pub struct PartShape {
    /// "PART/2"
    pub part: String,
    /// of its centre of mass, ground axes
    pub translation: [[f64; 2]; 3],
    /// small rotation about ground axes, rad
    pub rotation: [[f64; 2]; 3],
}

/// An eigenvalue with its mode; of a pair of conjugate ones, that with the positive imaginary part.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// per time
    pub re: f64,
    /// rad per time
    pub im: f64,
    /// motions of the parts; the largest translation (or, without any, rotation or state) is 1.
    /// Empty when it was not wanted.
    pub parts: Vec<PartShape>,
    /// motions of the states: name, real and imaginary part
    pub states: Vec<(String, [f64; 2])>,
}

impl Mode {
    /// Returns |λ|/2π, cycles per time.
    pub fn frequency(&self) -> f64 {
        hypot(self.re, self.im) / std::f64::consts::TAU
    }
    /// Returns −Re λ/|λ|.
    pub fn damping_ratio(&self) -> f64 {
        let size = hypot(self.re, self.im);
        if self.re == 0.0 { 0.0 } else { -self.re / size }
    }
}

/// A linear system about a state of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Linearization {
    /// time of the state
    pub time: f64,
    /// names of z
    pub states: Vec<String>,
    /// names of u: VARIABLEs
    pub inputs: Vec<String>,
    /// names of y: VARIABLEs
    pub outputs: Vec<String>,
    /// ż = A z + B u, y = C z + D u; row after row
    pub a: Vec<Vec<f64>>,
    /// see `a`
    pub b: Vec<Vec<f64>>,
    /// see `a`
    pub c: Vec<Vec<f64>>,
    /// see `a`
    pub d: Vec<Vec<f64>>,
    /// by |λ|
    pub modes: Vec<Mode>,
    /// what is farthest from rest, where the state moves or is no equilibrium and has modes
    pub unrest: Option<Unrest>,
}

/// Returns the VARIABLEs of plants, in order.
fn variables(model: &Model, output: bool, one: Option<u32>) -> Result<Vec<u32>, Diagnostic> {
    let (kind, all) = if output {
        (ElementKind::Poutput, &model.plant_outputs)
    } else {
        (ElementKind::Pinput, &model.plant_inputs)
    };
    match one {
        Some(id) => match all.get(&id) {
            Some(plant) => Ok(plant.variables.clone()),
            None => Err(Diagnostic::error(
                "model",
                format!("LINEAR names {}, which does not exist", kind.id(id)),
            )),
        },
        None => Ok(all.values().flat_map(|p| p.variables.clone()).collect()),
    }
}

/// Returns the VARIABLEs that are inputs, for the options of a scene.
///
/// # Errors
/// When a PINPUT does not exist.
pub fn inputs(model: &Model, wanted: &Wanted) -> Result<Vec<u32>, Diagnostic> {
    variables(model, false, wanted.inputs)
}

/// Returns the derivatives of a program along some directions; the unknowns of loops follow.
fn along(
    system: &mut System,
    program: &Program,
    directions: &[Direction],
) -> Result<DMatrix<f64>, usize> {
    let all = system.numbers.clone();
    let follow = |numbers: &mut [_], first| system.follow_along(numbers, first);
    slopes::along(
        program,
        &mut Work::default(),
        all.into_iter(),
        directions,
        None,
        follow,
    )
}

fn rows(m: &DMatrix<f64>) -> Vec<Vec<f64>> {
    m.row_iter().map(|r| r.iter().copied().collect()).collect()
}

/// The subspace of small motions: from z to changes of tangents, velocities and states.
struct Small {
    /// positions: Z   (n_v × n_ξ)
    z: DMatrix<f64>,
    /// velocities: Y   (n_v × n_η)
    y: DMatrix<f64>,
    /// velocities that go with positions: P   (n_v × n_ξ)
    p: DMatrix<f64>,
}

impl Small {
    /// Returns how many numbers of z are changes of positions and velocities: n_ξ + n_η.
    fn n_moving(&self) -> usize {
        self.z.ncols() + self.y.ncols()
    }

    /// Finds the subspace at the present numbers.
    fn at(system: &mut System) -> Result<Self, Vec<Diagnostic>> {
        let l = system.scene.layout;
        let n = l.n_v;
        let scene = system.configured();
        let active: Vec<usize> = scene.configuration.active_rows().collect();
        if active.is_empty() {
            let [z, y] = [DMatrix::identity(n, n), DMatrix::identity(n, n)];
            let p = DMatrix::zeros(n, n);
            return Ok(Self { z, y, p });
        }
        let at = Equations::new(scene, &system.numbers);
        let mut g = DMatrix::zeros(active.len(), n);
        for (k, &r) in active.iter().enumerate() {
            for &(v, x) in &at.row(r).gradient {
                g[(k, v)] += x;
            }
        }
        let y = assemble::null_space(&g);
        let of_positions = active.iter().enumerate();
        let of_positions = of_positions.filter(|(_, r)| !scene.rows[**r].is_of_velocities());
        let of_positions: Vec<usize> = of_positions.map(|(k, _)| k).collect();
        let z = match of_positions.len() {
            all if all == active.len() => y.clone(),
            0 => DMatrix::identity(n, n),
            _ => assemble::null_space(&g.select_rows(&of_positions)),
        };
        let velocity = record(scene, |at| {
            let rate = |r: &usize| at.row_rate(&at.row(*r));
            active.iter().map(rate).collect()
        })
        .map_err(complaints)?;
        let moves = tangents(system);
        let change = along(system, &velocity, &moves).map_err(|k| undetermined(system, k))?;
        let p = if change.amax() == 0.0 {
            DMatrix::zeros(n, z.ncols())
        } else {
            // G⁺ = Gᵀ (G Gᵀ)⁻¹
            let gram = &g * g.transpose();
            let solved = gram
                .lu()
                .solve(&(change * &z))
                .unwrap_or_else(|| DMatrix::zeros(active.len(), z.ncols()));
            -(g.transpose() * solved)
        };
        Ok(Self { z, y, p })
    }
}

/// Returns the directions along the tangents of positions.
fn tangents(system: &System) -> Vec<Vec<(usize, f64)>> {
    let l = system.scene.layout;
    let mut moves = vec![Vec::new(); l.n_v];
    for (v, place, slope) in system.mover().tangents(&system.numbers[l.q()]) {
        moves[v].push((l.q_at(place), slope));
    }
    moves
}

fn undetermined(system: &System, k: usize) -> Vec<Diagnostic> {
    let d = Diagnostic::error("loop", "nothing determines it in this state");
    vec![match system.scene.loops.get(k) {
        Some(unknown) => d.element(&unknown.asker),
        None => d,
    }]
}

/// Linearizes a system about the state in its numbers.
///
/// # Errors
/// Functions that the equations cannot supply, plants that do not exist, eigenvalues that do not
/// converge.
pub fn linearize(
    system: &mut System,
    model: &Model,
    wanted: &Wanted,
) -> Result<Linearization, Vec<Diagnostic>> {
    let output_ids = variables(model, true, wanted.outputs).map_err(|d| vec![d])?;
    let input_ids = variables(model, false, wanted.inputs).map_err(|d| vec![d])?;
    // the subspace, and the program of rates and outputs
    let small = Small::at(system)?;
    let watched = watched(&system.scene, &output_ids)?;
    let directions = directions(system, &small, &input_ids, wanted.no_damping);
    let slopes = slopes(system, &watched, &directions)?;
    // the matrices, and the modes
    let n_z = small.n_moving() + system.scene.layout.n_x;
    let state = state_rows(system, &small, &slopes, wanted.no_damping);
    let outputs = slopes.rows(system.scene.layout.n_y(), watched.len());
    let a = state.columns(0, n_z).into_owned();
    let names = system.scene.unknown_names();
    let modes = modes::modes(system, model, &small, &a, wanted)?;
    let named = |ids: &[u32]| {
        let name = |&id: &u32| ElementKind::Variable.id(id).to_string();
        ids.iter().map(name).collect()
    };
    let mut found = Linearization {
        time: system.numbers[Layout::TIME],
        states: state_names(&system.scene, &small, &names),
        inputs: named(&input_ids),
        outputs: named(&output_ids),
        b: rows(&state.columns(n_z, input_ids.len()).into_owned()),
        c: rows(&outputs.columns(0, n_z).into_owned()),
        d: rows(&outputs.columns(n_z, input_ids.len()).into_owned()),
        a: rows(&a),
        modes,
        unrest: None,
    };
    found.unrest = unrest::unrest(system, model, &small, &found)?;
    Ok(found)
}

/// Returns the derivatives of rates and formulas along directions.
///
/// # Errors
/// Functions that the equations cannot supply; those that are not finite.
fn slopes(
    system: &mut System,
    watched: &[usize],
    directions: &[Direction],
) -> Result<DMatrix<f64>, Vec<Diagnostic>> {
    let program = record(system.configured(), |at| {
        let mut out = at.rates();
        out.extend(watched.iter().map(|&f| at.formula(f)));
        out
    })
    .map_err(complaints)?;
    let slopes = along(system, &program, directions).map_err(|k| undetermined(system, k))?;
    if slopes.iter().any(|x| !x.is_finite()) {
        let what = "the equations have no finite derivatives in this state";
        return Err(vec![Diagnostic::error("linear", what)]);
    }
    Ok(slopes)
}

/// Returns the formulas of VARIABLEs.
///
/// # Errors
/// The first that the scene does not have.
fn watched(scene: &Scene, ids: &[u32]) -> Result<Vec<usize>, Vec<Diagnostic>> {
    let formula = |id: &u32| {
        scene.variables.get(id).copied().ok_or_else(|| {
            let what = "is an output but does not exist or is not active";
            vec![Diagnostic::error("model", what).element(ElementKind::Variable.id(*id))]
        })
    };
    ids.iter().map(formula).collect()
}

/// Returns the directions of z, then of u: tangents with the velocities that they bring about,
/// velocities (which count for nothing without damping), states; inputs.
fn directions(
    system: &System,
    small: &Small,
    input_ids: &[u32],
    no_damping: bool,
) -> Vec<Direction> {
    let scene = &system.scene;
    let l = scene.layout;
    let [n, n_speeds] = [small.z.ncols(), small.y.ncols()];
    let moves = tangents(system);
    let speeds = |column: &[f64]| -> Direction {
        let all = column.iter().enumerate().filter(|(_, s)| **s != 0.0);
        all.map(|(v, s)| (l.v_at(v), *s)).collect()
    };
    let mut directions: Vec<Direction> = Vec::new();
    for k in 0..n {
        let mut direction = speeds(small.p.column(k).as_slice());
        let column = small.z.column(k);
        for (v, s) in column.iter().enumerate().filter(|(_, s)| **s != 0.0) {
            direction.extend(moves[v].iter().map(|(place, slope)| (*place, slope * s)));
        }
        directions.push(direction);
    }
    for k in 0..n_speeds {
        directions.push(if no_damping {
            Vec::new()
        } else {
            speeds(small.y.column(k).as_slice())
        });
    }
    directions.extend((0..l.n_x).map(|k| vec![(l.x_at(k), 1.0)]));
    for id in input_ids {
        let own = |s: &ExternalInput| matches!(s, ExternalInput::Input(f) if scene.variables.get(id) == Some(f));
        let place = scene.external_inputs.iter().position(own);
        directions.push(place.map_or_else(Vec::new, |p| vec![(l.external_at(p), 1.0)]));
    }
    directions
}

/// Returns the rows of ż, [A B], from the derivatives of the rates.
fn state_rows(
    system: &System,
    small: &Small,
    slopes: &DMatrix<f64>,
    no_damping: bool,
) -> DMatrix<f64> {
    let l = system.scene.layout;
    let (n_x, n, n_moving) = (l.n_x, small.z.ncols(), small.n_moving());
    let [q, v] = [l.q(), l.v()].map(|places| &system.numbers[places]);
    let mover = system.mover();
    let mut a = DMatrix::zeros(n_moving + n_x, slopes.ncols());
    for k in 0..slopes.ncols() {
        let column: Vec<f64> = slopes.column(k).iter().copied().collect();
        let rates = l.state(&column);
        let mut tangent = mover.tangent(q, rates.q, l.n_v);
        let mut speed = rates.v.to_vec();
        if k < n {
            // 2 q* ∘ δq̇ has half of it, as q* turns, too
            mover.add_turning(v, small.z.column(k).as_slice(), 0.5, &mut tangent);
            mover.add_turning(v, small.p.column(k).as_slice(), 1.0, &mut speed);
        } else if k < n_moving && !no_damping {
            mover.add_turning(v, small.y.column(k - n).as_slice(), 1.0, &mut speed);
        }
        let [tangent, speed] = [tangent, speed].map(DVector::from_vec);
        a.view_mut((0, k), (n, 1))
            .copy_from(&small.z.tr_mul(&tangent));
        a.view_mut((n, k), (n_moving - n, 1))
            .copy_from(&small.y.tr_mul(&speed));
        for i in 0..n_x {
            a[(n_moving + i, k)] = rates.x[i];
        }
    }
    if no_damping {
        // δξ̇ = Zᵀ Y η still holds: η where all rows hold positions
        match small.y.ncols() == n {
            true => (0..n).for_each(|k| a[(k, n + k)] = 1.0),
            false => a
                .view_mut((0, n), (n, n_moving - n))
                .copy_from(&small.z.tr_mul(&small.y)),
        }
    }
    a
}

/// Returns the names of z: coordinates where all are free, else combinations of them.
fn state_names(scene: &Scene, small: &Small, names: &[String]) -> Vec<String> {
    let l = scene.layout;
    let [n, n_speeds] = [small.z.ncols(), small.y.ncols()];
    let mut own = vec![String::new(); l.n_v];
    for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
        if let Some(v) = f.v {
            own[v] = c.id.to_string();
        }
    }
    let named = |k: usize, n: usize| {
        if n == l.n_v {
            own[k].clone()
        } else {
            format!("combination {} of coordinates", k + 1)
        }
    };
    let mut all: Vec<String> = (0..n).map(|k| named(k, n)).collect();
    all.extend((0..n_speeds).map(|k| format!("rate of {}", named(k, n_speeds))));
    all.extend(l.state(names).x.iter().cloned());
    all
}
