//! All that can be computed at one instant, generic over the number, each thing when it is first asked for.
//!
//! ```text
//! t, q, v, x → links, markers → formulas → loads ┐
//!                              mass matrix, rows ┴→ v̇, λ → accelerations, reactions → measures
//! ```
//!
//! Run over `f64` this is the reference; run over a recording number it becomes the program that the solver runs.

use super::articulated::ArticulatedFactor;
use super::layout::Layout;
use super::loops::Key;
use super::solve::{Factor, MassFactor, Solution, accelerations, solve_symmetric};
use super::sweep::{self, Coordinates, LinkState, Wrench};
use super::{Counted, Displacement, Row, RowKind, Scene, Source, Sum};
use crate::expr::measures::{Family, Measure};
use crate::expr::program::{Input, Work};
use crate::model::Level;
use crate::physics::action::Action;
use crate::physics::coupler::Gauge;
use crate::scalar::{Dual, Jet, Scalar};
use crate::space::{Frame, MarkerState, Mat3, Vec3, kinematic};
use std::cell::{Cell, OnceCell, RefCell};

/// Value of MODE in a kinematic analysis.
const KINEMATIC: f64 = 1.0;
/// Value of MODE in a static analysis: nothing moves, motions stand still where they are.
pub const STATIC: f64 = 5.0;

/// One instant of a scene.
pub struct Equations<'s, S: Scalar> {
    scene: &'s Scene,
    t: S,
    q: Vec<S>,
    v: Vec<S>,
    x: Vec<S>,
    turns: Vec<S>,
    driven: Vec<Jet<S>>,
    /// with the accelerations of driven coordinates only
    links: Vec<LinkState<S>>,
    markers: RefCell<Vec<Option<MarkerState<S>>>>,
    formulas: RefCell<Vec<Option<S>>>,
    /// formulas being evaluated: a formula that asks for itself is a loop
    open: RefCell<Vec<usize>>,
    solved: OnceCell<Solved<S>>,
    solving: Cell<bool>,
    /// values of the unknowns of algebraic loops
    loops: Vec<S>,
    /// notes what is asked for too early instead of complaining
    discovering: bool,
    discovered: RefCell<Vec<Key>>,
    /// what went wrong, for the compiler to report
    complaints: RefCell<Vec<String>>,
}

/// Accelerations and multipliers, and what follows from them.
pub struct Solved<S> {
    /// accelerations   (n_v)
    pub vdot: Vec<S>,
    /// multipliers of the rows; 0 for rows that do not take part   (n_rows)
    pub lambda: Vec<S>,
    /// how many pivots of the rows were weak: near a position where rows become dependent
    pub weak: S,
    /// diagonal of `G M⁻¹ Gᵀ` over the rows that take part
    pub diagonal: Vec<S>,
    /// links with all accelerations
    pub links: Vec<LinkState<S>>,
    /// what the carrier exerts on each link, in the link's axes about its origin
    pub carried: Vec<Wrench<S>>,
    /// actions of the force elements on their I markers
    pub actions: Vec<Action<S>>,
}

/// A row of G with its right sides.
pub struct RowValue<S> {
    /// g
    pub value: S,
    /// gradient along the velocities of free coordinates: (place in v, ∂ġ/∂v)
    pub gradient: Vec<(usize, S)>,
    /// ġ = gradient · v + this (driven coordinates and functions of time)
    pub drift: S,
    /// g̈ = gradient · v̇ − gamma
    pub gamma: S,
    /// force and torque of a unit multiplier on markers about their origins, ground axes
    pub actions: Vec<(usize, Action<S>)>,
}

impl<'s, S: Scalar> Equations<'s, S> {
    /// From the flat row of numbers that [`Layout`] describes.
    pub fn new(scene: &'s Scene, numbers: &[S]) -> Self {
        let loops = numbers[scene.layout.loops()].to_vec();
        Self::with_unknowns(scene, numbers, loops, false)
    }

    /// As [`Equations::new`], with values for the unknowns of algebraic loops; or to find out which these are.
    pub(super) fn with_unknowns(
        scene: &'s Scene,
        numbers: &[S],
        loops: Vec<S>,
        discovering: bool,
    ) -> Self {
        let l = &scene.layout;
        let mut this = Self {
            scene,
            t: numbers[Layout::TIME],
            q: numbers[l.q()].to_vec(),
            v: numbers[l.v()].to_vec(),
            x: numbers[l.x()].to_vec(),
            turns: numbers[l.turns()].to_vec(),
            driven: Vec::new(),
            links: Vec::new(),
            markers: RefCell::new(vec![None; scene.markers.len()]),
            formulas: RefCell::new(vec![None; scene.formulas.len()]),
            open: RefCell::new(Vec::new()),
            solved: OnceCell::new(),
            solving: Cell::new(false),
            loops,
            discovering,
            discovered: RefCell::new(Vec::new()),
            complaints: RefCell::new(Vec::new()),
        };
        this.driven = (0..scene.motions.len()).map(|m| this.drive(m)).collect();
        this.links = sweep::outward(scene, &this.coordinates(&[]));
        this
    }

    /// What could not be computed, in words; empty when all is well.
    pub fn complaints(&self) -> Vec<String> {
        self.complaints.borrow().clone()
    }

    fn complain(&self, what: String) -> S {
        let mut complaints = self.complaints.borrow_mut();
        if !complaints.contains(&what) {
            complaints.push(what);
        }
        S::constant(f64::NAN)
    }

    // ---- algebraic loops --------------------------------------------------------------------------------------------

    /// What was asked for too early.
    pub(super) fn discovered(self) -> Vec<Key> {
        self.discovered.into_inner()
    }

    /// Value of an unknown of the loops; `None`: it is none.
    fn unknown(&self, key: Key) -> Option<S> {
        if self.scene.loops.is_empty() {
            return None;
        }
        let k = self.scene.loops.iter().position(|u| u.key == key)?;
        match self.loops.get(k) {
            Some(&value) => Some(value),
            None => Some(self.complain(format!(
                "{} is known only where its loop is solved",
                self.scene.loops[k].name
            ))),
        }
    }

    /// The first `count` unknowns of the loops.
    pub(super) fn unknowns(&self, count: usize) -> Vec<S> {
        self.loops[..count].to_vec()
    }

    /// Something is asked for that depends on who asks.
    fn too_early(&self, key: Key, why: impl FnOnce() -> String) -> S {
        if !self.discovering {
            return self.complain(why());
        }
        let mut found = self.discovered.borrow_mut();
        if !found.contains(&key) {
            found.push(key);
        }
        S::zero()
    }

    /// Asks for all that loads, rates and functions ask for, without solving anything.
    pub(super) fn discover(&self) {
        self.solving.set(true);
        self.loads();
        self.solving.set(false);
        self.state_rates();
        for f in 0..self.scene.formulas.len() {
            self.formula(f);
        }
        for unknown in &self.scene.loops {
            if let Key::Formula(f) = unknown.key {
                self.evaluate(f);
            }
        }
    }

    /// ρ of the loops: zero at their solution.
    pub(super) fn loop_residuals(&self) -> Vec<S> {
        let keys = self.scene.loops.iter().zip(&self.loops);
        keys.map(|(unknown, &z)| match unknown.key {
            Key::Formula(f) => self.evaluate(f) - z,
            Key::Measure(m, ids) => self.measure_itself(m, ids, &unknown.name) - z,
            Key::Rate(d) | Key::Value(d) => self.formula(self.scene.differentials[d].formula),
        })
        .collect()
    }

    /// Values of the formulas that close loops, where they change branch.
    pub(super) fn loop_formulas(&self) -> Vec<S> {
        let formulas = self.scene.loops.iter().filter_map(|u| match u.key {
            Key::Formula(f) => Some(self.evaluate(f)),
            Key::Rate(d) | Key::Value(d) => Some(self.formula(self.scene.differentials[d].formula)),
            Key::Measure(..) => None,
        });
        formulas.collect()
    }

    fn coordinates<'a>(&'a self, vdot: &'a [S]) -> Coordinates<'a, S> {
        Coordinates {
            q: &self.q,
            v: &self.v,
            vdot,
            driven: &self.driven,
        }
    }

    /// Time.
    pub fn time(&self) -> S {
        self.t
    }

    /// Velocities of the free coordinates   (n_v)
    pub fn velocities(&self) -> &[S] {
        &self.v
    }

    /// Value, rate and acceleration that a motion prescribes.
    fn drive(&self, m: usize) -> Jet<S> {
        let moving = self.drive_in_time(m);
        if self.scene.mode == STATIC {
            Jet::new(moving.value, S::zero(), S::zero())
        } else {
            moving
        }
    }

    fn drive_in_time(&self, m: usize) -> Jet<S> {
        let motion = &self.scene.motions[m];
        let f = self.in_time(motion.formula, &mut Vec::new());
        let state = |k: usize| motion.state.map_or_else(S::zero, |s| self.x[s + k]);
        match motion.level {
            Level::Displacement => f,
            Level::Velocity => Jet::new(state(0), f.value, f.first),
            Level::Acceleration => Jet::new(state(0), state(1), f.value),
        }
    }

    /// A formula of time alone, with its rates.
    fn in_time(&self, formula: usize, open: &mut Vec<usize>) -> Jet<S> {
        let f = &self.scene.formulas[formula];
        if open.contains(&formula) {
            return Jet::constant(f64::NAN);
        }
        open.push(formula);
        let inputs: Vec<Jet<S>> = f
            .program
            .inputs()
            .iter()
            .map(|input| match input {
                Input::Time => Jet::variable(self.t),
                Input::Mode => Jet::constant(self.scene.mode),
                Input::Measure(Measure::Varval, [id, ..]) => match self.scene.variables.get(id) {
                    Some(&v) => self.in_time(v, open),
                    None => Jet::constant(f64::NAN),
                },
                Input::Measure(Measure::Aryval, [id, k, ..]) => {
                    Jet::constant(self.array(*id, *k).unwrap_or(f64::NAN))
                }
                _ => Jet::constant(f64::NAN),
            })
            .collect();
        open.pop();
        let mut out = [Jet::zero()];
        f.program.eval(&inputs, &mut Work::default(), &mut out);
        out[0]
    }

    fn array(&self, id: u32, k: u32) -> Option<f64> {
        self.scene
            .arrays
            .get(&id)?
            .get((k as usize).checked_sub(1)?)
            .copied()
    }

    /// Pose and velocity of a marker; its accelerations are those of driven coordinates only.
    pub fn marker(&self, m: usize) -> MarkerState<S> {
        if let Some(state) = self.markers.borrow()[m] {
            return state;
        }
        let state = sweep::marker_state(&self.scene.markers[m], &self.links);
        self.markers.borrow_mut()[m] = Some(state);
        state
    }

    /// A part's frame, with its accelerations when asked for.
    pub fn part(&self, part: usize, accelerated: bool) -> MarkerState<S> {
        let p = &self.scene.parts[part];
        let marker = super::MarkerOnLink {
            id: 0,
            link: p.link,
            frame: p.frame,
            part: Some(part),
        };
        sweep::marker_state(
            &marker,
            if accelerated {
                &self.solved().links
            } else {
                &self.links
            },
        )
    }

    /// Action of an element on its I marker; `None` when there is no such active element.
    pub fn action_of(&self, keyword: &str, id: u32) -> Option<Action<S>> {
        self.element(keyword, id).map(|found| found.0)
    }

    /// A marker with all its accelerations.
    fn accelerated_marker(&self, m: usize) -> MarkerState<S> {
        sweep::marker_state(&self.scene.markers[m], &self.solved().links)
    }

    /// Value of a formula.
    pub fn formula(&self, f: usize) -> S {
        if let Some(value) = self.unknown(Key::Formula(f)) {
            return value;
        }
        if let Some(value) = self.formulas.borrow()[f] {
            return value;
        }
        if self.open.borrow().contains(&f) {
            let why = || format!("{} depends on itself", self.scene.formulas[f].name);
            return self.too_early(Key::Formula(f), why);
        }
        let value = self.evaluate(f);
        self.formulas.borrow_mut()[f] = Some(value);
        value
    }

    /// What a formula turns out to be, also where it closes a loop.
    fn evaluate(&self, f: usize) -> S {
        let formula = &self.scene.formulas[f];
        self.open.borrow_mut().push(f);
        let inputs: Vec<S> = formula
            .program
            .inputs()
            .iter()
            .map(|&i| self.input(i, &formula.name))
            .collect();
        self.open.borrow_mut().pop();
        let mut out = [S::zero()];
        formula
            .program
            .eval(&inputs, &mut Work::default(), &mut out);
        out[0]
    }

    /// What a formula asks for: the one door between the language and the scene.
    pub fn input(&self, input: Input, asked_by: &str) -> S {
        match input {
            Input::Time => self.t,
            Input::Mode => S::constant(self.scene.mode),
            Input::Measure(measure, ids) => self.measure(measure, ids, asked_by),
            Input::Delayed(_) => self.complain(format!("{asked_by}: DELAY is not solved yet")),
            Input::Slot(_) => {
                unreachable!("slots are inputs of recorded programs, not of formulas")
            }
        }
    }

    /// Value of a measure.
    pub fn measure(&self, measure: Measure, ids: [u32; 4], asked_by: &str) -> S {
        self.unknown(Key::Measure(measure, ids))
            .unwrap_or_else(|| self.measure_itself(measure, ids, asked_by))
    }

    /// What a measure turns out to be, also where a load reads it.
    fn measure_itself(&self, measure: Measure, ids: [u32; 4], asked_by: &str) -> S {
        let row = measure.row();
        match row.family {
            Family::Displacement | Family::Velocity => {
                let state = |id: u32| self.scene.marker_of.get(&id).map(|&m| self.marker(m));
                match kinematic::kinematic_of(measure, ids, state) {
                    Some(value) if measure.needs_history() => {
                        self.turned(Counted::Measure(measure, ids), value)
                    }
                    Some(value) => value,
                    None => self.complain(format!(
                        "{asked_by}: {} has no value for these arguments",
                        row.name
                    )),
                }
            }
            Family::Acceleration => {
                if self.solving.get() {
                    return self.too_early(Key::Measure(measure, ids), || {
                        format!(
                            "{asked_by}: {} reads an acceleration that depends on this very function",
                            row.name
                        )
                    });
                }
                if self.discovering {
                    return S::zero();
                }
                let state = |id: u32| {
                    self.scene
                        .marker_of
                        .get(&id)
                        .map(|&m| self.accelerated_marker(m))
                };
                kinematic::kinematic_of(measure, ids, state).unwrap_or_else(|| {
                    self.complain(format!(
                        "{asked_by}: {} names a marker that does not exist",
                        row.name
                    ))
                })
            }
            Family::GenericForce => self.generic_force(measure, ids, asked_by),
            Family::ElementForce => self.element_force(measure, ids, asked_by),
            Family::System => self.system(measure, ids, asked_by),
        }
    }

    /// An angle with its turns: the value nearest to the one last accepted.
    fn turned(&self, angle: Counted, principal: S) -> S {
        let Some(k) = self.scene.counted.iter().position(|c| *c == angle) else {
            return principal;
        };
        let turn = std::f64::consts::TAU;
        let turns = (self.turns[k] - principal).scale(1.0 / turn).round();
        principal + turns.scale(turn)
    }

    /// Value of an angle whose turns are counted.
    pub fn counted(&self, angle: Counted) -> S {
        match angle {
            Counted::Measure(measure, ids) => self.measure(measure, ids, measure.name()),
            Counted::Angle { about, i, j } => {
                let frame = |m: usize| sweep::marker_frame(&self.scene.markers[m], &self.links);
                self.turned(angle, Gauge::Angle(about).value(&frame(i), &frame(j)))
            }
        }
    }

    /// AX, AY or AZ of one marker against another, with its turns.
    pub fn angle_between(&self, measure: Measure, i: usize, j: Option<usize>) -> S {
        let id = |m: usize| self.scene.markers[m].id;
        self.measure(measure, [id(i), j.map_or(0, id), 0, 0], measure.name())
    }

    fn system(&self, measure: Measure, [id, k, ..]: [u32; 4], asked_by: &str) -> S {
        let scene = self.scene;
        match measure {
            Measure::Varval => match scene.variables.get(&id) {
                Some(&f) => self.formula(f),
                None => self.complain(format!("{asked_by}: VARIABLE/{id} does not exist")),
            },
            Measure::Aryval => match self.array(id, k) {
                Some(x) => S::constant(x),
                None => self.complain(format!("{asked_by}: ARRAY/{id} has no entry {k}")),
            },
            Measure::Dif | Measure::Dif1 => {
                match scene.differentials.iter().position(|d| d.id == id) {
                    Some(d) if measure == Measure::Dif => self.state_of(d),
                    Some(d) => self.rate_of(d),
                    None => self.complain(format!("{asked_by}: DIFF/{id} does not exist")),
                }
            }
            _ => self.complain(format!("{asked_by}: {} is not solved yet", measure.name())),
        }
    }

    /// Value of a differential equation.
    fn state_of(&self, d: usize) -> S {
        let unknown = || self.unknown(Key::Value(d)).unwrap_or_else(S::zero);
        self.scene.differentials[d]
            .state
            .map_or_else(unknown, |s| self.x[s])
    }

    /// Rate of a differential equation.
    fn rate_of(&self, d: usize) -> S {
        let equation = &self.scene.differentials[d];
        match (equation.implicit, equation.state) {
            (false, _) => self.formula(equation.formula),
            (true, None) => self.complain(format!(
                "DIF1({0}): DIFF/{0} is an equation without a rate",
                equation.id
            )),
            // at rest there is no rate
            (true, Some(_)) => self.unknown(Key::Rate(d)).unwrap_or_else(S::zero),
        }
    }

    // ---- dynamics -------------------------------------------------------------------------------------------------

    /// Whether a row takes part (it does not where it depends on earlier ones).
    pub fn is_active(&self, r: usize) -> bool {
        self.scene.active.get(r).copied().unwrap_or(true)
    }

    /// Accelerations, multipliers and reactions.
    pub fn solved(&self) -> &Solved<S> {
        self.solved.get_or_init(|| {
            self.solving.set(true);
            let solved = self.solve();
            self.solving.set(false);
            solved
        })
    }

    fn loads(&self) -> (Vec<Wrench<S>>, Vec<Action<S>>) {
        let mut wrenches = vec![Wrench::zero(); self.scene.links.len()];
        let mut actions = Vec::with_capacity(self.scene.forces.len());
        for force in &self.scene.forces {
            let action = force.action(self);
            let i = &self.scene.markers[force.i];
            let point = self.marker(force.i).p_GM;
            sweep::apply(
                &mut wrenches,
                &self.links,
                i.link,
                point,
                action.force,
                action.torque,
            );
            if let Some(link) = force.reaction {
                sweep::apply(
                    &mut wrenches,
                    &self.links,
                    link,
                    point,
                    -action.force,
                    -action.torque,
                );
            }
            actions.push(action);
        }
        (wrenches, actions)
    }

    fn gravity(&self) -> Vec3<S> {
        Vec3::constant(self.scene.gravity)
    }

    /// The mass matrix over free coordinates, as rows for [`MassFactor`].
    pub fn mass_rows(&self) -> Vec<Vec<(usize, S)>> {
        let place = |f: usize| self.scene.freedoms[f].v;
        sweep::mass_matrix(self.scene, &self.links)
            .into_iter()
            .enumerate()
            .filter(|(f, _)| place(*f).is_some())
            .map(|(_, row)| {
                row.into_iter()
                    .filter_map(|(f, m)| place(f).map(|v| (v, m)))
                    .collect()
            })
            .collect()
    }

    fn solve(&self) -> Solved<S> {
        let scene = self.scene;
        let (mut wrenches, actions) = self.loads();
        let bias = sweep::inward(scene, &self.links, self.gravity(), &wrenches);
        let mut f: Vec<S> = scene
            .freedoms
            .iter()
            .filter(|f| f.v.is_some())
            .map(|f| -f.component(&bias[f.link]))
            .collect();
        let rows: Vec<(usize, RowValue<S>)> = (0..scene.rows.len())
            .filter(|&r| self.is_active(r))
            .map(|r| (r, self.row(r)))
            .collect();
        let g: Vec<Vec<(usize, S)>> = rows.iter().map(|(_, row)| row.gradient.clone()).collect();
        let gamma: Vec<S> = rows.iter().map(|(_, row)| row.gamma).collect();
        let multipliers = if scene.mode == STATIC {
            self.supporting(&g, &mut f)
        } else {
            match self.mass_factor() {
                Some(factor) => accelerations(&factor, &g, &gamma, &mut f, &scene.usual),
                None => self.determined(&wrenches, &g, &gamma, &mut f),
            }
        };
        let mut lambda = vec![S::zero(); scene.rows.len()];
        for ((r, row), &l) in rows.iter().zip(&multipliers.x) {
            lambda[*r] = l;
            for (m, action) in &row.actions {
                let point = self.marker(*m).p_GM;
                let link = scene.markers[*m].link;
                sweep::apply(
                    &mut wrenches,
                    &self.links,
                    link,
                    point,
                    action.force.times(l),
                    action.torque.times(l),
                );
            }
        }
        let links = sweep::outward(scene, &self.coordinates(&f));
        let carried = sweep::inward(scene, &links, self.gravity(), &wrenches);
        Solved {
            vdot: f,
            lambda,
            weak: multipliers.weak,
            diagonal: multipliers.diagonal,
            links,
            carried,
            actions,
        }
    }

    /// The factored mass matrix; `None` in kinematics, where masses may be zero and do not matter.
    pub fn mass_factor(&self) -> Option<Factor<'_, S>> {
        if self.scene.mode == KINEMATIC || self.scene.mode == STATIC {
            return None;
        }
        Some(if self.scene.articulated {
            Factor::Articulated(ArticulatedFactor::new(self.scene, &self.links))
        } else {
            Factor::Matrix(MassFactor::new(self.mass_rows()))
        })
    }

    /// Accelerations (into `f`) and multipliers where the rows leave no freedom, so that masses may be zero.
    ///
    /// ```text
    /// v̇ = Gᵀ (G Gᵀ)⁻¹ γ        λ = (G Gᵀ)⁻¹ G (M v̇ − f)
    /// ```
    fn determined(
        &self,
        wrenches: &[Wrench<S>],
        g: &[Vec<(usize, S)>],
        gamma: &[S],
        f: &mut [S],
    ) -> Solution<S> {
        let dot = |a: &[(usize, S)], b: &[(usize, S)]| {
            let mut sum = S::zero();
            for &(i, x) in a {
                for &(j, y) in b {
                    if i == j {
                        sum += x * y;
                    }
                }
            }
            sum
        };
        let gram: Vec<Vec<S>> = (0..g.len())
            .map(|r| (0..=r).map(|c| dot(&g[r], &g[c])).collect())
            .collect();
        let z = solve_symmetric(gram.clone(), gamma.to_vec(), &[]).x;
        f.fill(S::zero());
        for (row, &z) in g.iter().zip(&z) {
            for &(v, x) in row {
                f[v] += x * z;
            }
        }
        let links = sweep::outward(self.scene, &self.coordinates(f));
        let carried = sweep::inward(self.scene, &links, self.gravity(), wrenches);
        let missing: Vec<S> = self
            .scene
            .freedoms
            .iter()
            .filter(|f| f.v.is_some())
            .map(|f| f.component(&carried[f.link]))
            .collect();
        let rhs = g
            .iter()
            .map(|row| row.iter().fold(S::zero(), |s, &(v, x)| s + x * missing[v]))
            .collect();
        solve_symmetric(gram, rhs, &[])
    }

    /// Multipliers that balance the loads `f` as well as rows can; accelerations (into `f`) are zero.
    ///
    /// ```text
    /// λ = −(G W Gᵀ)⁻¹ G W f
    /// ```
    fn supporting(&self, g: &[Vec<(usize, S)>], f: &mut [S]) -> Solution<S> {
        let w = super::programs::weights(self.scene);
        let gram: Vec<Vec<S>> = (0..g.len())
            .map(|r| {
                (0..=r)
                    .map(|c| {
                        let mut sum = S::zero();
                        for &(i, x) in &g[r] {
                            for &(j, y) in &g[c] {
                                if i == j {
                                    sum += (x * y).scale(w[i]);
                                }
                            }
                        }
                        sum
                    })
                    .collect()
            })
            .collect();
        let rhs = g
            .iter()
            .map(|row| {
                row.iter()
                    .fold(S::zero(), |s, &(v, x)| s - (x * f[v]).scale(w[v]))
            })
            .collect();
        f.fill(S::zero());
        solve_symmetric(gram, rhs, &[])
    }

    /// Loads along the free coordinates, gravity included, with the forces of the active rows at the given multipliers: all
    /// zero in equilibrium   (n_v)
    pub fn balance(&self, multipliers: &[S]) -> Vec<S> {
        self.solving.set(true);
        let (wrenches, _) = self.loads();
        self.solving.set(false);
        let carried = sweep::inward(self.scene, &self.links, self.gravity(), &wrenches);
        let free = self.scene.freedoms.iter().filter(|f| f.v.is_some());
        let mut f: Vec<S> = free.map(|f| -f.component(&carried[f.link])).collect();
        let active = (0..self.scene.rows.len()).filter(|&r| self.is_active(r));
        for (r, &l) in active.zip(multipliers) {
            for (v, g) in self.row(r).gradient {
                f[v] += g * l;
            }
        }
        f
    }

    /// The axis of a freedom, ground axes.
    pub fn freedom_axis(&self, f: &sweep::Freedom) -> Vec3<S> {
        let rotation = &self.links[f.link].X_GL.rotation;
        rotation.column(f.axis).times(S::constant(f.sign))
    }

    /// How large the loads are, whatever cancels: Σ |force| + Σ |torque| / length + weight.
    pub fn load_scale(&self) -> S {
        self.solving.set(true);
        let (_, actions) = self.loads();
        self.solving.set(false);
        let mass: f64 = self.scene.links.iter().map(|l| l.mass).sum();
        let weight = S::constant(mass * self.scene.gravity.norm());
        actions.iter().fold(weight, |sum, a| {
            let torque = a.torque.norm2().sqrt().scale(1.0 / self.scene.length);
            sum + a.force.norm2().sqrt() + torque
        })
    }

    /// `q̇, v̇, ẋ`
    pub fn rates(&self) -> Vec<S> {
        let mut out = self.position_rates();
        out.extend(&self.solved().vdot);
        out.extend(self.state_rates());
        out
    }

    /// `q̇`
    pub fn position_rates(&self) -> Vec<S> {
        let mut out = vec![S::zero(); self.q.len()];
        for link in &self.scene.links {
            if let super::LinkMotion::Ball {
                coordinate,
                quaternion,
            } = link.motion
            {
                let w = Vec3([0, 1, 2].map(|k| self.coordinate(coordinate + k).first));
                let q = [0, 1, 2, 3].map(|k| self.q[quaternion + k]);
                out[quaternion..quaternion + 4]
                    .copy_from_slice(&crate::space::rotation::quaternion_rate(q, w));
            }
        }
        for (c, f) in self.scene.coordinates.iter().zip(&self.scene.freedoms) {
            if let (Source::Free { q, v }, false) = (c.source, f.in_ball) {
                out[q] = self.v[v];
            }
        }
        out
    }

    fn coordinate(&self, c: usize) -> Jet<S> {
        self.coordinates(&[]).of(self.scene.coordinates[c].source)
    }

    /// `ẋ`
    pub fn state_rates(&self) -> Vec<S> {
        let mut out = vec![S::zero(); self.x.len()];
        for (m, motion) in self.scene.motions.iter().enumerate() {
            if let Some(s) = motion.state {
                out[s] = self.driven[m].first;
                if motion.level == Level::Acceleration {
                    out[s + 1] = self.driven[m].second;
                }
            }
        }
        for (k, d) in self.scene.differentials.iter().enumerate() {
            let Some(state) = d.state else { continue };
            // at rest the residual of an implicit equation stands for its rate
            out[state] = if d.implicit && self.scene.mode == STATIC {
                self.formula(d.formula)
            } else {
                self.rate_of(k)
            };
        }
        out
    }

    // ---- rows -----------------------------------------------------------------------------------------------------

    /// A row with its gradient and right sides.
    pub fn row(&self, r: usize) -> RowValue<S> {
        match &self.scene.rows[r].kind {
            RowKind::Markers { law, i, j, motion } => {
                let drive = motion.map(|m| self.driven[m]);
                let (I, J) = (self.marker(*i), self.marker(*j));
                // gradient: duals along the twists of I (0–5: rotation, translation) and J (6–11)
                let seeded = law.value(
                    &seed::<S>(&I, 0),
                    &seed::<S>(&J, 6),
                    drive.map(|d| Dual {
                        re: d.value,
                        eps: [S::zero(); 12],
                    }),
                );
                let actions = vec![(*i, twist(&seeded, 0)), (*j, twist(&seeded, 6))];
                // rates: jets in time along the motion with v̇ = 0
                let rates = law.value(&moving(&I), &moving(&J), drive);
                let gradient = self.gradient_of(&actions);
                RowValue {
                    value: seeded.re,
                    drift: rates.first - self.along(&gradient),
                    gradient,
                    gamma: -rates.second,
                    actions,
                }
            }
            RowKind::Displacements(sum) => self.sum_row(sum),
        }
    }

    /// The gradient of what acts with a unit multiplier, by places.
    fn gradient_of(&self, actions: &[(usize, Action<S>)]) -> Vec<(usize, S)> {
        let mut gradient: Vec<(usize, S)> = Vec::new();
        for (m, action) in actions {
            self.gradient(*m, action, &mut gradient);
        }
        gradient.sort_by_key(|g| g.0);
        gradient
    }

    /// `gradient · v`
    fn along(&self, gradient: &[(usize, S)]) -> S {
        gradient
            .iter()
            .fold(S::zero(), |s, &(v, g)| s + g * self.v[v])
    }

    /// A sum of displacements: each a sum of coordinates where it can be, else by duals along twists and jets in time.
    fn sum_row(&self, sum: &Sum) -> RowValue<S> {
        let mut value = S::constant(-sum.constant);
        let (mut drift, mut second) = (S::zero(), S::zero());
        let mut gradient: Vec<(usize, S)> = Vec::new();
        let mut actions = Vec::with_capacity(2 * sum.terms.len());
        let add = |gradient: &mut Vec<(usize, S)>, v: usize, g: S| match gradient
            .iter_mut()
            .find(|e| e.0 == v)
        {
            Some(entry) => entry.1 += g,
            None => gradient.push((v, g)),
        };
        let mut linear = true;
        for (factor, d) in &sum.terms {
            let own = self.displacement(d);
            value += own.value.scale(*factor);
            for (m, a) in &own.actions {
                let factor = S::constant(*factor);
                actions.push((
                    *m,
                    Action {
                        force: a.force.times(factor),
                        torque: a.torque.times(factor),
                    },
                ));
            }
            linear &= d.coordinates.is_some();
            drift += own.drift.scale(*factor);
            second -= own.gamma.scale(*factor);
            for &(v, g) in &own.gradient {
                add(&mut gradient, v, g.scale(*factor));
            }
        }
        if let Some(contact) = sum.contact {
            actions = self.contact(contact);
            if !linear {
                // the same rate on all motions that the joints permit, by forces that act where the bodies touch
                let rate = self.contact_rate(contact);
                gradient = self.gradient_of(&actions);
                drift = rate.value - self.along(&gradient);
                second = rate.first;
            }
        }
        gradient.sort_by_key(|g| g.0);
        gradient.retain(|g| !g.1.is_known_zero());
        RowValue {
            value,
            gradient,
            drift,
            gamma: -second,
            actions,
        }
    }

    /// A distance or an angle with its gradient and rates.
    fn displacement(&self, d: &Displacement) -> RowValue<S> {
        let (I, J) = (self.marker(d.i), self.marker(d.j));
        let seeded = d.gauge.value(&seed::<S>(&I, 0), &seed::<S>(&J, 6));
        let actions = vec![(d.i, twist(&seeded, 0)), (d.j, twist(&seeded, 6))];
        if let Some((terms, constant)) = &d.coordinates {
            let mut value = S::constant(*constant);
            let (mut drift, mut second) = (S::zero(), S::zero());
            let mut gradient = Vec::new();
            for &(c, factor) in terms {
                let x = self.coordinate(c);
                value += x.value.scale(factor);
                match self.scene.coordinates[c].source {
                    Source::Free { v, .. } => gradient.push((v, S::constant(factor))),
                    Source::Driven(_) => {
                        drift += x.first.scale(factor);
                        second += x.second.scale(factor);
                    }
                }
            }
            return RowValue {
                value,
                gradient,
                drift,
                gamma: -second,
                actions,
            };
        }
        let rates = d.gauge.value(&moving(&I), &moving(&J));
        let gradient = self.gradient_of(&actions);
        let value = match d.gauge {
            Gauge::Distance => seeded.re,
            Gauge::Angle(about) => {
                let angle = Counted::Angle {
                    about,
                    i: d.i,
                    j: d.j,
                };
                self.turned(angle, seeded.re)
            }
        };
        RowValue {
            value,
            drift: rates.first - self.along(&gradient),
            gradient,
            gamma: -rates.second,
            actions,
        }
    }

    /// A unit force along z of CV on the first body at the origin of CV, and its opposite on the second.
    fn contact(&self, (cv, bodies): (usize, [usize; 2])) -> Vec<(usize, Action<S>)> {
        let cv = self.marker(cv);
        let line = cv.R_GM.column(2);
        bodies
            .iter()
            .zip([line, -line])
            .map(|(&m, force)| {
                let torque = (cv.p_GM - self.marker(m).p_GM).cross(force);
                (m, Action { force, torque })
            })
            .collect()
    }

    /// How fast the second body recedes from the first at CV along its z axis, and the rate of that with v̇ = 0.
    fn contact_rate(&self, (cv, bodies): (usize, [usize; 2])) -> Jet<S> {
        let rate = |x: S, first: S| Jet::new(x, first, S::zero());
        let pair =
            |x: Vec3<S>, first: Vec3<S>| Vec3(std::array::from_fn(|k| rate(x.0[k], first.0[k])));
        let cv = self.marker(cv);
        let (point, line) = (pair(cv.p_GM, cv.v_GM), cv.R_GM.column(2));
        let line = pair(line, cv.w_GM.cross(line));
        let [first, second] = bodies.map(|m| {
            let m = self.marker(m);
            let arm = point - pair(m.p_GM, m.v_GM);
            pair(m.v_GM, m.a_GM) + pair(m.w_GM, m.alpha_GM).cross(arm)
        });
        (first - second).dot(line)
    }

    /// Adds the components of an action on a marker along all free coordinates that move it.
    fn gradient(&self, m: usize, action: &Action<S>, sum: &mut Vec<(usize, S)>) {
        let scene = self.scene;
        let point = self.marker(m).p_GM;
        let mut next = scene.markers[m].link.and_then(|l| scene.last_freedom[l]);
        while let Some(k) = next {
            let f = &scene.freedoms[k];
            next = scene.carrier[k];
            let Some(v) = f.v else { continue };
            let X = &self.links[f.link].X_GL;
            let e = X.rotation.column(f.axis).times(S::constant(f.sign));
            let component = if f.turn {
                e.dot(action.torque + (point - X.position).cross(action.force))
            } else {
                e.dot(action.force)
            };
            if component.is_known_zero() {
                continue;
            }
            match sum.iter_mut().find(|s| s.0 == v) {
                Some(entry) => entry.1 += component,
                None => sum.push((v, component)),
            }
        }
    }

    // ---- reactions and forces as measures ---------------------------------------------------------------------------

    /// Action of a force element on its I marker.
    fn force_action(&self, f: usize) -> Action<S> {
        if self.solving.get() || self.discovering {
            self.scene.forces[f].action(self)
        } else {
            self.solved().actions[f]
        }
    }

    /// Action of an element on its I marker, with the points of I and J; `None` when there is no such element.
    fn element(&self, keyword: &str, id: u32) -> Option<(Action<S>, Vec3<S>, Vec3<S>)> {
        let scene = self.scene;
        if let Some(f) = scene
            .forces
            .iter()
            .position(|f| f.keyword == keyword && f.id == id)
        {
            let force = &scene.forces[f];
            let action = self.force_action(f);
            let p_I = self.marker(force.i).p_GM;
            let p_J = force.j.map_or(p_I, |j| self.marker(j).p_GM);
            return Some((action, p_I, p_J));
        }
        let c = scene
            .constraints
            .iter()
            .position(|c| c.keyword == keyword && c.id == id)?;
        let about = scene.constraints[c].about?;
        let j = scene.constraints[c].markers.map_or(about, |(_, j)| j);
        let action = if self.discovering {
            Action::zero()
        } else {
            self.reaction(c)
        };
        let point = |m: usize| self.marker(m).p_GM;
        Some((action, point(about), point(j)))
    }

    /// The reaction of a constraint on its I marker.
    pub fn reaction(&self, c: usize) -> Action<S> {
        let scene = self.scene;
        let element = &scene.constraints[c];
        let solved = self.solved();
        let mut sum = Action::zero();
        let Some(about) = element.about else {
            return sum;
        };
        let p_I = self.marker(about).p_GM;
        for r in element.rows.clone().filter(|&r| self.is_active(r)) {
            let l = solved.lambda[r];
            for (m, a) in self.row(r).actions {
                if element.acts_on.contains(&m) {
                    let force = a.force.times(l);
                    let arm = self.marker(m).p_GM - p_I;
                    let torque = if m == about {
                        a.torque.times(l)
                    } else {
                        a.torque.times(l) + arm.cross(force)
                    };
                    sum = sum.plus(&Action { force, torque });
                }
            }
        }
        // on the carried link about p_I, ground axes
        let at_i = |link: usize, w: &Wrench<S>| {
            let X = &self.links[link].X_GL;
            let force = X.rotation.apply(w.force);
            Action {
                force,
                torque: X.rotation.apply(w.torque) + (X.position - p_I).cross(force),
            }
        };
        let drive = |coordinate: usize| {
            let f = &scene.freedoms[coordinate];
            let magnitude = f.component(&solved.carried[f.link]);
            let mut w = Wrench::zero();
            let part = if f.turn { &mut w.torque } else { &mut w.force };
            part.0[f.axis] = magnitude.scale(f.sign);
            at_i(f.link, &w)
        };
        if let Some(coordinate) = element.coordinate {
            let on_carried = drive(coordinate);
            let backward = scene.freedoms[coordinate].sign < 0.0;
            return if backward {
                negative(&on_carried)
            } else {
                on_carried
            };
        }
        if let Some((link, backward)) = element.carries {
            let mut on_carried = at_i(link, &solved.carried[link]);
            // the part along a driven coordinate belongs to its MOTION
            for (k, coordinate) in scene.coordinates.iter().enumerate() {
                if coordinate.joint == Some(element.id)
                    && element.keyword == "JOINT"
                    && matches!(coordinate.source, Source::Driven(_))
                {
                    on_carried = on_carried.plus(&negative(&drive(k)));
                }
            }
            sum = sum.plus(&if backward {
                negative(&on_carried)
            } else {
                on_carried
            });
        }
        sum
    }

    fn element_force(
        &self,
        measure: Measure,
        [id, jflag, comp, rm]: [u32; 4],
        asked_by: &str,
    ) -> S {
        let Some(keyword) = keyword_of(measure) else {
            return self.complain(format!("{asked_by}: {} is not solved yet", measure.name()));
        };
        if self.solving.get()
            && self
                .scene
                .constraints
                .iter()
                .any(|c| c.keyword == keyword && c.id == id)
        {
            return self.too_early(Key::Measure(measure, [id, jflag, comp, rm]), || {
                format!(
                    "{asked_by}: {} reads a reaction that depends on this very function",
                    measure.name()
                )
            });
        }
        let Some((action, p_I, p_J)) = self.element(keyword, id) else {
            return self.complain(format!(
                "{asked_by}: {keyword}/{id} does not exist or is not active"
            ));
        };
        let action = if jflag == 1 {
            action.reaction(p_I, p_J)
        } else {
            action
        };
        self.component(&action, comp, rm, asked_by)
    }

    /// Component 1–8 of an action, resolved in marker `rm`.
    fn component(&self, action: &Action<S>, comp: u32, rm: u32, asked_by: &str) -> S {
        let axes = if rm == 0 {
            Mat3::identity()
        } else {
            match self.scene.marker_of.get(&rm) {
                Some(&m) => self.marker(m).R_GM,
                None => return self.complain(format!("{asked_by}: MARKER/{rm} does not exist")),
            }
        };
        let length = |v: Vec3<S>| {
            let n2 = v.norm2();
            let zero = n2.le(S::zero());
            S::select(zero, S::zero(), S::select(zero, S::one(), n2).sqrt())
        };
        match comp {
            1 => length(action.force),
            2..=4 => axes.column(comp as usize - 2).dot(action.force),
            5 => length(action.torque),
            6..=8 => axes.column(comp as usize - 6).dot(action.torque),
            _ => self.complain(format!("{asked_by}: component {comp} does not exist")),
        }
    }

    /// FM … TZ: all that acts between two markers.
    fn generic_force(&self, measure: Measure, ids: [u32; 4], asked_by: &str) -> S {
        use Measure as M;
        let [i, j, k, _] = ids;
        if self.solving.get() && self.carries_reaction(i, j) {
            return self.too_early(Key::Measure(measure, ids), || {
                format!(
                    "{asked_by}: {} reads a reaction that depends on this very function",
                    measure.name()
                )
            });
        }
        let comp = match measure {
            M::Fm => 1,
            M::Fx => 2,
            M::Fy => 3,
            M::Fz => 4,
            M::Tm => 5,
            M::Tx => 6,
            M::Ty => 7,
            _ => 8,
        };
        let total = self.between(i, j);
        self.component(&total, comp, k, asked_by)
    }

    /// Whether a constraint acts between two markers, given by their numbers.
    fn carries_reaction(&self, i: u32, j: u32) -> bool {
        let id = |m: usize| self.scene.markers[m].id;
        let mut markers = self.scene.constraints.iter().filter_map(|c| c.markers);
        markers.any(|(a, b)| [(i, j), (j, i)].contains(&(id(a), id(b))))
    }

    /// Sum of what acts on marker `i` from elements between `i` and `j`; `j` = 0: from action-only forces.
    fn between(&self, i: u32, j: u32) -> Action<S> {
        let scene = self.scene;
        let mut sum = Action::zero();
        let id = |m: usize| scene.markers[m].id;
        let mut add = |markers: (u32, u32), action: Action<S>, p_I: Vec3<S>, p_J: Vec3<S>| {
            if markers == (i, j) {
                sum = sum.plus(&action);
            } else if markers == (j, i) {
                sum = sum.plus(&action.reaction(p_I, p_J));
            }
        };
        for (f, force) in scene.forces.iter().enumerate() {
            let other = match (force.reaction, force.j) {
                (None, _) => 0,
                (Some(_), Some(m)) => id(m),
                (Some(_), None) => force.floating,
            };
            let markers = (id(force.i), other);
            if markers != (i, j) && markers != (j, i) {
                continue;
            }
            let action = self.force_action(f);
            let p_I = self.marker(force.i).p_GM;
            let p_J = force.j.map_or(p_I, |m| self.marker(m).p_GM);
            add(markers, action, p_I, p_J);
        }
        for (c, element) in scene.constraints.iter().enumerate() {
            let Some((a, b)) = element.markers else {
                continue;
            };
            let markers = (id(a), id(b));
            if markers != (i, j) && markers != (j, i) {
                continue;
            }
            if self.discovering {
                continue;
            }
            add(
                markers,
                self.reaction(c),
                self.marker(a).p_GM,
                self.marker(b).p_GM,
            );
        }
        sum
    }

    // ---- for tests and reports --------------------------------------------------------------------------------------

    /// Kinetic energy, and potential energy in gravity.
    pub fn energy(&self) -> [S; 2] {
        let (mut kinetic, mut potential) = (S::zero(), S::zero());
        for (link, s) in self.scene.links.iter().zip(&self.links) {
            if link.mass == 0.0 && link.inertia == Mat3::zero() {
                continue;
            }
            let mc = Vec3::constant(link.moment);
            let momentum = s.v.times(S::constant(link.mass)) + s.w.cross(mc);
            let spin = Mat3::constant(link.inertia).apply(s.w) + mc.cross(s.v);
            kinetic += (momentum.dot(s.v) + spin.dot(s.w)).scale(0.5);
            let weight = s.X_GL.position.times(S::constant(link.mass)) + s.X_GL.rotation.apply(mc);
            potential -= self.gravity().dot(weight);
        }
        [kinetic, potential]
    }
}

fn negative<S: Scalar>(a: &Action<S>) -> Action<S> {
    Action {
        force: -a.force,
        torque: -a.torque,
    }
}

/// Keyword of the statement whose force a measure returns.
fn keyword_of(measure: Measure) -> Option<&'static str> {
    use Measure as M;
    Some(match measure {
        M::Joint => "JOINT",
        M::Jprim => "JPRIM",
        M::Motion => "MOTION",
        M::Sforce => "SFORCE",
        M::Vforce => "VFORCE",
        M::Vtorq => "VTORQUE",
        M::Gforce => "GFORCE",
        M::Spdp => "SPRINGDAMPER",
        M::Bush => "BUSHING",
        M::Beam => "BEAM",
        M::Field => "FIELD",
        M::Ptcv => "PTCV",
        M::Cvcv => "CVCV",
        M::Contact => "CONTACT",
        _ => return None,
    })
}

/// What a dual along twists says about the one whose directions begin at `k`: the action of a unit multiplier.
fn twist<S: Scalar>(x: &Dual<12, S>, k: usize) -> Action<S> {
    Action {
        torque: Vec3([x.eps[k], x.eps[k + 1], x.eps[k + 2]]),
        force: Vec3([x.eps[k + 3], x.eps[k + 4], x.eps[k + 5]]),
    }
}

/// A marker's frame as it turns and moves along six directions, the first of which is direction `first`.
fn seed<S: Scalar>(m: &MarkerState<S>, first: usize) -> Frame<Dual<12, S>> {
    let lift = |x: S| Dual {
        re: x,
        eps: [S::zero(); 12],
    };
    let mut frame = Frame {
        rotation: Mat3(m.R_GM.0.map(|r| r.map(lift))),
        position: Vec3(m.p_GM.0.map(lift)),
    };
    for k in 0..3 {
        let e = Vec3::axis(k);
        for column in 0..3 {
            let moved = e.cross(m.R_GM.column(column));
            for row in 0..3 {
                frame.rotation.0[row][column].eps[first + k] = moved.0[row];
            }
        }
        frame.position.0[k].eps[first + 3 + k] = S::one();
    }
    frame
}

/// A marker's frame as it moves in time.
fn moving<S: Scalar>(m: &MarkerState<S>) -> Frame<Jet<S>> {
    let mut rotation = Mat3::<Jet<S>>::zero();
    for column in 0..3 {
        let axis = m.R_GM.column(column);
        let first = m.w_GM.cross(axis);
        let second = m.alpha_GM.cross(axis) + m.w_GM.cross(first);
        for row in 0..3 {
            rotation.0[row][column] = Jet::new(axis.0[row], first.0[row], second.0[row]);
        }
    }
    let position = Vec3(std::array::from_fn(|k| {
        Jet::new(m.p_GM.0[k], m.v_GM.0[k], m.a_GM.0[k])
    }));
    Frame { rotation, position }
}

/// The name of a row: "JOINT/7 Zi.Xj".
pub fn row_name(row: &Row) -> String {
    format!("{} {}", row.element, row.equation)
}
