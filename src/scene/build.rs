//! The last passes of compilation: what drives, what is counted; and the finished [`Scene`].

use super::compile::{Compiler, NamedTie};
use super::contacts::Shell;
use super::equations::Unsupported;
use super::external_inputs::{ExternalInput, HookKind, HookName, SceneDelay, SceneHook};
use super::left_out::LeftOut;
use super::loops::{self, Key};
use super::reads::{Allowed, offence};
use super::sweep::Freedom;
use super::{
    ConstraintElement, Counted, Entry, Formula, LinkMotion, Row, RowKind, Scene, SceneMotion,
    Source,
};
use crate::diagnostic::{Diagnostic, Severity};
use crate::expr::interpolation::Bindings;
use crate::expr::program::{Builder as Recorder, Folding, Input, Program};
use crate::model::{
    ArrayKind, Driven, ElementId, ElementKind, Formula as ModelFormula, Level, Model, RequestKind,
    Text,
};
use crate::physics::joint::{Displacements, Tie};
use crate::physics::row::Law;
use crate::space::Vec3;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::sync::Arc;

/// How a scene is made.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// make rows of all joints: the absolute-coordinate formulation, for comparison
    pub cut_all: bool,
    /// value of MODE: 1 kinematic, 3 initial conditions, 4 dynamic, 5 static
    pub mode: u32,
    /// COUPLER, SCREW, RACKPIN: the sum of displacements is zero, as in the manuals, rather than what the assembled configuration shows
    pub strict: bool,
    /// variables of joints are to be shown
    pub variables: bool,
    /// expressions to be evaluated beside those of the model: (name, text)
    pub extra: Vec<(String, Text)>,
    /// kinds of elements that are left out where they are not solved
    pub skip: BTreeSet<ElementKind>,
    /// closures for `USER(…)`
    pub hooks: Vec<HookName>,
    /// what `USER(…)` would compute is zero
    pub zero_user: bool,
    /// VARIABLEs to which numbers from outside are added: inputs of a linear system
    pub plant_inputs: Vec<u32>,
    /// VARIABLEs whose functions commands will change: where one is a number, it is supplied from outside rather than part of the equations
    pub changing: BTreeSet<u32>,
    /// what the files of GRAPHICS hold, or why they do not, by the numbers of these
    pub shells: Arc<BTreeMap<u32, Result<Shell, String>>>,
}

/// Whose function a formula is, and its name in messages.
#[derive(Clone, Debug)]
pub(super) struct Owner {
    /// `None`: it is asked for beside those of the model
    pub element: Option<ElementId>,
    /// "SFORCE/3 FUNCTION"
    pub name: String,
}

impl Owner {
    /// Returns the owner of a function of an element; `part` is its argument, or which of several equations it is.
    pub fn of(element: ElementId, part: impl fmt::Display) -> Self {
        Self {
            element: Some(element),
            name: format!("{element} {part}"),
        }
    }

    /// Returns the owner of an expression asked for beside those of the model.
    pub fn asked(name: &str) -> Self {
        Self {
            element: None,
            name: name.to_string(),
        }
    }
}

impl Scene {
    /// Makes the scene of a model; it is shared and never changes.
    ///
    /// # Errors
    /// Everything that keeps the model from being solved, all at once.
    pub fn compile(model: &Model, options: &Options) -> Result<Arc<Scene>, Vec<Diagnostic>> {
        let mut left_out = LeftOut::of(model, &options.skip, options.zero_user);
        let without = (!left_out.elements.is_empty()).then(|| {
            let mut model = model.clone();
            model.inactive.extend(left_out.elements.iter().copied());
            model
        });
        let model = without.as_ref().unwrap_or(model);
        let mut c = Compiler::new(model);
        let (bindings, unusable) = super::formula::bindings(model);
        let mut b = Builder {
            scene: Scene::default(),
            model,
            bindings,
            unusable,
            hooks: &options.hooks,
            zero_user: options.zero_user,
            shells: &options.shells,
        };
        for d in std::mem::take(&mut left_out.told) {
            match d.severity {
                Severity::Error => c.errors.push(d),
                _ => b.scene.warnings.push(d),
            }
        }
        c.frames();
        b.scene.mode = f64::from(options.mode);
        b.scene.inactive.clone_from(&model.inactive);
        b.scene.left_out = left_out;
        b.data();
        let drives = b.motions(&mut c);
        let ties = ties(model);
        let coupled: BTreeSet<u32> = coupled_joints(model);
        let driven: BTreeSet<u32> = drives.iter().filter_map(|d| d.joint).collect();
        let preferred = |t: &NamedTie| {
            t.joint
                .is_some_and(|j| coupled.contains(&j) || driven.contains(&j))
        };
        c.forest(&ties, |_| options.cut_all, &preferred);
        b.driven_rows(&mut c, &drives);
        b.links(&mut c);
        b.couplers(&mut c, options.strict);
        if options.variables {
            b.joint_variables(&mut c);
        }
        b.forces(&mut c, &options.skip);
        b.systems(&mut c, &options.changing);
        b.plant_inputs(&mut c, &options.plant_inputs);
        b.timed(&mut c);
        b.user_requests(&mut c);
        b.cams(&mut c);
        b.general(&mut c);
        for (name, text) in &options.extra {
            let f = b.compiled(&mut c, &Owner::asked(name), text);
            b.scene.extra.push(f);
        }
        b.counted();
        b.read_zero();
        if c.errors.is_empty() {
            b.loops(&mut c);
            b.natural_sizes();
        }
        if c.errors.is_empty() {
            Ok(Arc::new(b.scene))
        } else {
            Err(c.errors)
        }
    }
}

/// Largest distance of a constraint's marker from the middle of all, as the dataset places them; one when all coincide.
fn span(scene: &Scene) -> f64 {
    let ends = |c: &ConstraintElement| c.markers.map(|(i, j)| [i, j]);
    let points: Vec<Vec3<f64>> = (scene.constraints.iter().filter_map(ends).flatten())
        .map(|m| scene.drawn(m).position)
        .collect();
    let sum = points.iter().fold(Vec3::zero(), |sum, p| sum + *p);
    let middle = sum.times(1.0 / points.len().max(1) as f64);
    let distances = points.iter().map(|p| (*p - middle).norm());
    let largest = distances.filter(|d| d.is_finite()).fold(0.0, f64::max);
    if largest > 0.0 { largest } else { 1.0 }
}

/// The joints and primitives of a model that are switched on.
fn ties(model: &Model) -> Vec<NamedTie> {
    let joints = model
        .active(ElementKind::Joint, &model.joints)
        .filter(|(_, j)| !Tie::Joint(j.kind).rows().is_empty())
        .map(|(id, j)| NamedTie {
            kind: Tie::Joint(j.kind),
            i: j.i,
            j: j.j,
            id: ElementKind::Joint.id(id),
            joint: Some(id),
        });
    let primitives = model
        .active(ElementKind::Jprim, &model.primitives)
        .map(|(id, p)| NamedTie {
            kind: Tie::Primitive(p.kind),
            i: p.i,
            j: p.j,
            id: ElementKind::Jprim.id(id),
            joint: None,
        });
    joints.chain(primitives).collect()
}

/// Joints whose displacement something refers to.
fn coupled_joints(model: &Model) -> BTreeSet<u32> {
    let couplers = model
        .active(ElementKind::Coupler, &model.couplers)
        .flat_map(|(_, c)| c.joints.clone());
    let gears = model
        .active(ElementKind::Gear, &model.gears)
        .flat_map(|(_, g)| g.joints);
    couplers.chain(gears).collect()
}

/// What a motion drives, resolved.
struct Drive {
    motion: usize,
    joint: Option<u32>,
    law: Law,
    markers: (u32, u32),
    id: ElementId,
}

pub(super) struct Builder<'m> {
    pub(super) scene: Scene,
    pub(super) model: &'m Model,
    bindings: Bindings,
    /// splines that cannot be used: told when something asks for one
    unusable: Vec<Diagnostic>,
    hooks: &'m [HookName],
    pub(super) zero_user: bool,
    pub(super) shells: &'m BTreeMap<u32, Result<Shell, String>>,
}

impl<'m> Builder<'m> {
    /// Gravity and arrays of numbers.
    fn data(&mut self) {
        self.scene.gravity = Vec3(self.model.gravity);
        if let Some(units) = &self.model.units {
            self.scene.length_unit = units.length.to_ascii_lowercase();
        }
        for (&id, array) in &self.model.arrays {
            if let ArrayKind::Ic(numbers) = &array.kind {
                let numbers = numbers.iter().copied().map(Entry::Number).collect();
                self.scene.arrays.insert(id, numbers);
            }
        }
    }

    /// Compiles an expression; its index in the scene's formulas.
    pub(super) fn formula(
        &mut self,
        c: &mut Compiler,
        owner: &Owner,
        formula: &ModelFormula,
    ) -> usize {
        match formula {
            ModelFormula::Expression { text, .. } => self.compiled(c, owner, text),
            ModelFormula::User { .. } => self.user(c, owner, formula, 1, &[])[0],
        }
    }

    /// A formula that has been compiled; its index.
    fn push(&mut self, owner: &Owner, text: &str, program: Program, delayed: Vec<usize>) -> usize {
        self.scene.formulas.push(Formula {
            element: owner.element,
            name: owner.name.clone(),
            text: text.to_string(),
            program,
            gradient: None,
            delayed,
        });
        self.scene.formulas.len() - 1
    }

    fn compiled(&mut self, c: &mut Compiler, owner: &Owner, text: &Text) -> usize {
        let compiled = match super::formula::compile(text, &self.bindings) {
            Ok(compiled) => compiled,
            Err(mut d) => {
                d.element = Some(owner.name.clone());
                if d.code == "unknown_element" {
                    c.errors.append(&mut self.unusable);
                }
                c.errors.push(d);
                // never evaluated: a scene with errors is not made
                return usize::MAX;
            }
        };
        // all parts of an expression number its delayed values alike
        let first = self.scene.delays.len();
        let n = compiled.delays.len();
        let places: Vec<usize> = (0..n)
            .map(|k| self.supply(ExternalInput::Delay(first + k)))
            .collect();
        for programs in compiled.delays {
            let [expression, delay, history] =
                programs.map(|p| self.push(owner, text, p, places.clone()));
            self.scene.delays.push(SceneDelay {
                expression,
                delay,
                history,
            });
        }
        self.push(owner, text, compiled.program, places)
    }

    /// A place for a number from outside.
    pub(super) fn supply(&mut self, what: ExternalInput) -> usize {
        self.scene.external_inputs.push(what);
        self.scene.layout.n_external = self.scene.external_inputs.len();
        self.scene.external_inputs.len() - 1
    }

    /// `n` numbers that a closure of the user's computes for an element, as formulas; `reads`: what it is given beside its own
    /// inputs.
    pub(super) fn user(
        &mut self,
        c: &mut Compiler,
        owner: &Owner,
        formula: &ModelFormula,
        n: usize,
        reads: &[String],
    ) -> Vec<usize> {
        self.user_reading(c, owner, formula, n, reads, &[])
    }

    /// As [`user`](Self::user), for closures that are given values of further formulas as well.
    pub(super) fn user_reading(
        &mut self,
        c: &mut Compiler,
        owner: &Owner,
        formula: &ModelFormula,
        n: usize,
        reads: &[String],
        further: &[usize],
    ) -> Vec<usize> {
        let ModelFormula::User { constants, .. } = formula else {
            return vec![self.formula(c, owner, formula); n];
        };
        if self.zero_user {
            return vec![self.compiled(c, owner, &"0".into()); n];
        }
        let known = owner.element.and_then(|element| {
            let mut hooks = self.hooks.iter();
            let closure = hooks.position(|h| h.stands_for(element, formula));
            closure.map(|closure| (element, closure))
        });
        let Some((element, closure)) = known else {
            let message = "USER needs a routine that is not part of the dataset";
            c.errors.push(Diagnostic::error("user_routine", message).element(&owner.name).help(
                "register a closure for it through the library, switch the element off, or take what USER would compute as zero (--zero-user)",
            ));
            return vec![usize::MAX; n];
        };
        let texts = self.hooks[closure].inputs.iter().chain(reads);
        let mut inputs: Vec<usize> = texts
            .map(|text| self.compiled(c, owner, &text.as_str().into()))
            .collect();
        inputs.extend(further);
        let hook = self.scene.hooks.len();
        let places: Vec<usize> = (0..n)
            .map(|k| self.supply(ExternalInput::Hook(hook, k)))
            .collect();
        self.scene.hooks.push(SceneHook {
            kind: HookKind::User { closure, inputs },
            output_only: element.kind == ElementKind::Request,
            element,
            constants: constants.clone(),
            n,
            place: places[0],
        });
        let text = format!("USER, {}", self.hooks[closure].name);
        let outside = |place| self.supplied_formula(owner, &text, place);
        places.into_iter().map(outside).collect()
    }

    /// A number from outside as a formula.
    pub(super) fn supplied_formula(&mut self, owner: &Owner, text: &str, place: usize) -> usize {
        let mut recorder = Recorder::new(Folding::Strict);
        let value = recorder.input(Input::Delayed(0));
        self.push(owner, text, recorder.finish(&[value]), vec![place])
    }

    /// REQUEST, FUNCTION=USER: eight components, where there is a closure for it.
    fn user_requests(&mut self, c: &mut Compiler) {
        for (id, request) in self
            .model
            .active(ElementKind::Request, &self.model.requests)
        {
            let RequestKind::User(user) = &request.kind else {
                continue;
            };
            // one that nobody computes harms nobody
            let before = c.errors.len();
            let owner = Owner::of(ElementKind::Request.id(id), "FUNCTION");
            let all = self.user(c, &owner, user, 8, &[]);
            if c.errors.len() == before {
                self.scene.requests.insert(id, all);
            } else {
                c.errors.truncate(before);
            }
        }
    }

    fn motions(&mut self, c: &mut Compiler) -> Vec<Drive> {
        let mut drives = Vec::new();
        for (id, motion) in self.model.active(ElementKind::Motion, &self.model.motions) {
            let name = ElementKind::Motion.id(id);
            // a closure yields the value and its first two derivatives
            let formula = match &motion.function {
                user @ ModelFormula::User { .. } => {
                    let all = self.user(c, &Owner::of(name, "FUNCTION"), user, 3, &[]);
                    all[0]
                }
                text => self.formula(c, &Owner::of(name, "FUNCTION"), text),
            };
            let m = self.scene.motions.len();
            let places = match motion.level {
                Level::Displacement => 0,
                Level::Velocity => 1,
                Level::Acceleration => 2,
            };
            let state = (places > 0).then_some(self.scene.layout.n_x);
            self.scene.layout.n_x += places;
            self.scene.motions.push(SceneMotion {
                id,
                level: motion.level,
                formula,
                state,
                coordinate: None,
                held: false,
            });
            let (joint, turn) = match motion.driven {
                Driven::JointTranslation(j) => (j, false),
                Driven::JointRotation(j) => (j, true),
                Driven::Joint(j) => (
                    j,
                    self.model
                        .joints
                        .get(&j)
                        .is_some_and(|j| j.kind.displacements() == Displacements::Rotation),
                ),
                Driven::Markers { i, j, component } => {
                    let law = match component {
                        0..=2 => Law::Along(component),
                        _ => Law::BodyAngle(component - 3),
                    };
                    drives.push(Drive {
                        motion: m,
                        joint: None,
                        law,
                        markers: (i, j),
                        id: name,
                    });
                    continue;
                }
            };
            let Some(j) = self.model.joints.get(&joint) else {
                c.error(name, format!("JOINT/{joint} does not exist"));
                continue;
            };
            let has = j.kind.displacements();
            let allowed = if turn { has.turns() } else { has.slides() };
            if !allowed {
                let what = if turn { "rotation" } else { "translation" };
                c.error(name, format!("JOINT/{joint} has no {what} to drive: a motion needs a revolute, translational or cylindrical joint"));
                continue;
            }
            let law = if turn { Law::Angle } else { Law::Along(2) };
            if c.driven.insert((joint, turn), m).is_some() {
                c.error(name, format!("JOINT/{joint} is driven twice"));
            }
            drives.push(Drive {
                motion: m,
                joint: Some(joint),
                law,
                markers: (j.i, j.j),
                id: name,
            });
        }
        drives
    }

    /// Motions that no coordinate took: rows.
    fn driven_rows(&mut self, c: &mut Compiler, drives: &[Drive]) {
        for (k, coordinate) in c.coordinates.iter().enumerate() {
            if let Source::Driven(m) = coordinate.source {
                self.scene.motions[m].coordinate = Some(k);
            }
        }
        for drive in drives {
            let id = self.scene.motions[drive.motion].id;
            let coordinate = self.scene.motions[drive.motion].coordinate;
            let begins = self.model.motions.get(&id).and_then(|m| m.ic_displacement);
            let motion = &mut self.scene.motions[drive.motion];
            motion.held = coordinate.is_none() && motion.state.is_some() && begins.is_none();
            let first = c.rows.len();
            let (i, j) = (
                c.marker(drive.markers.0, drive.id),
                c.marker(drive.markers.1, drive.id),
            );
            if let (None, Some(i), Some(j)) = (coordinate, i, j) {
                let kind = RowKind::Markers {
                    law: drive.law,
                    i,
                    j,
                    motion: Some(drive.motion),
                };
                c.rows.push(Row {
                    element: drive.id,
                    equation: drive.law.name(),
                    kind,
                });
            }
            let rows = first..c.rows.len();
            let markers = i.zip(j);
            c.constraints.push(ConstraintElement {
                id: drive.id,
                markers,
                acts_on: markers.iter().map(|m| m.0).collect(),
                about: markers.map(|m| m.0),
                carries: None,
                rows,
                coordinate,
            });
        }
    }

    /// Motions are prescribed by time alone.
    fn timed(&mut self, c: &mut Compiler) {
        for motion in &self.scene.motions {
            // a closure tells the derivatives itself
            if self.scene.computed(motion.formula).is_some() {
                continue;
            }
            if let Some(offence) = offence(&self.scene, motion.formula, Allowed::Time) {
                let what = offence.to_string();
                c.errors.push(
                    Diagnostic::error("motion_reads", what)
                        .element(ElementKind::Motion.id(motion.id))
                        .help("a MOTION is prescribed by TIME and states that depend on nothing else; relate places to each other by a COUPLER or GCON, react to what happens by a force"),
                );
            }
        }
    }

    /// Takes over what the forest is, and the freedoms in order.
    fn links(&mut self, c: &mut Compiler) {
        let s = &mut self.scene;
        s.links = std::mem::take(&mut c.links);
        s.coordinates = std::mem::take(&mut c.coordinates);
        s.rows = std::mem::take(&mut c.rows);
        s.constraints = std::mem::take(&mut c.constraints);
        s.parts = c.parts.clone();
        s.markers = c.markers.clone();
        s.marker_of = c.marker_of.clone();
        s.span = span(s);
        s.initial_q = std::mem::take(&mut c.q);
        (s.layout.n_q, s.layout.n_v) = (c.n_q, c.n_v);
        for (k, coordinate) in s.coordinates.iter().enumerate() {
            let (axis, sign, turn, in_ball) = match s.links[coordinate.link].motion {
                LinkMotion::Slide { axis, sign, .. } => (axis, sign, false, false),
                LinkMotion::Turn { axis, sign, .. } => (axis, sign, true, false),
                LinkMotion::Ball { coordinate, .. } => (k - coordinate, 1.0, true, true),
                LinkMotion::Rigid => unreachable!("a rigid link has no coordinates"),
            };
            let v = match coordinate.source {
                Source::Free { v, .. } => Some(v),
                Source::Driven(_) => None,
            };
            s.freedoms.push(Freedom {
                link: coordinate.link,
                axis,
                turn,
                sign,
                v,
                in_ball,
            });
        }
        let mut last = vec![None; s.links.len()];
        s.carrier = vec![None; s.freedoms.len()];
        for l in 0..s.links.len() {
            let mut nearest = s.links[l].parent.and_then(|p| last[p]);
            for k in (0..s.freedoms.len()).filter(|&k| s.freedoms[k].link == l) {
                s.carrier[k] = nearest;
                nearest = Some(k);
            }
            last[l] = nearest;
        }
        s.last_freedom = last;
        let reach = s.parts.iter().map(|p| p.initial.position.norm());
        let arms = s.markers.iter().map(|m| m.frame.position.norm());
        let length = reach
            .chain(arms)
            .filter(|x| x.is_finite())
            .fold(0.0, f64::max);
        s.length = if length > 0.0 { length } else { 1.0 };
    }

    /// Unknowns that functions define through each other.
    fn loops(&mut self, c: &mut Compiler) {
        let model = self.model;
        let variables: BTreeMap<usize, u32> = self
            .scene
            .variables
            .iter()
            .map(|(&id, &f)| (f, id))
            .collect();
        let equations: Vec<[f64; 2]> = self.scene.differentials.iter().map(|d| d.initial).collect();
        let guess = |key: &Key| match key {
            Key::Formula(f) => variables
                .get(f)
                .and_then(|id| model.variables.get(id)?.ic)
                .unwrap_or(0.0),
            Key::Measure(..) => 0.0,
            Key::Rate(d) => equations[*d][1],
            Key::Value(d) => equations[*d][0],
        };
        if let Err(unsolvable) = loops::find(&mut self.scene, &guess) {
            let error =
                |u: Unsupported| Diagnostic::error("loop", u.lack.to_string()).element(u.asked_by);
            c.errors.extend(unsolvable.into_iter().map(error));
        }
    }

    /// Angles whose turns are counted, wherever they are asked for.
    fn counted(&mut self) {
        let mut found: BTreeSet<Counted> = BTreeSet::new();
        for f in &self.scene.formulas {
            for input in f.program.inputs() {
                if let Input::Measure(m, ids) = input
                    && m.needs_history()
                {
                    found.insert(Counted::Measure(*m, *ids));
                }
            }
        }
        for f in &self.scene.forces {
            let id = |m: usize| self.scene.markers[m].id;
            let ids = [id(f.i), f.j.map_or(0, id), 0, 0];
            found.extend(f.law.angles().iter().map(|&m| Counted::Measure(m, ids)));
        }
        let sums = self.scene.rows.iter().filter_map(|row| match &row.kind {
            RowKind::Displacements(sum) => Some(&sum.terms),
            _ => None,
        });
        let in_rows = sums.flatten().map(|(_, d)| d);
        let shown = self.scene.joint_variables.iter().map(|v| &v.displacement);
        for d in in_rows.chain(shown) {
            if d.gauge.is_angle() && d.coordinates.is_none() {
                let (gauge, i, j) = (d.gauge, d.i, d.j);
                found.insert(Counted::Angle { gauge, i, j });
            }
        }
        self.scene.counted = found.into_iter().collect();
        self.scene.layout.n_turns = self.scene.counted.len();
    }
}

/// The sides of a contact of curves; where there is one curve, it is called by the first.
const SIDES: [&str; 2] = ["I", "J"];

/// Places of the unknowns by name, for messages: the names of q, v and x.
pub fn unknown_names(scene: &Scene) -> Vec<String> {
    let mut all = vec![String::new(); scene.layout.n_y()];
    let names = scene.layout.state_mut(&mut all);
    for c in &scene.coordinates {
        if let Source::Free { q, v } = c.source {
            names.q[q] = c.name.clone();
            names.v[v] = format!("rate of {}", c.name);
        }
    }
    for link in &scene.links {
        if let LinkMotion::Ball {
            coordinate,
            quaternion,
        } = link.motion
        {
            for k in 0..4 {
                names.q[quaternion + k] = format!(
                    "{} (Euler parameter {k})",
                    scene.coordinates[coordinate].name
                );
            }
        }
    }
    for d in &scene.differentials {
        if let Some(state) = d.state {
            names.x[state].clone_from(&d.name);
        }
    }
    for m in &scene.motions {
        if let Some(s) = m.state {
            names.x[s] = format!("{} displacement", ElementKind::Motion.id(m.id));
        }
    }
    for cam in &scene.cams {
        for (k, curve) in cam.curves.iter().enumerate() {
            let name = format!("{} place on CURVE/{curve} of {}", cam.id, SIDES[k]);
            names.x[cam.state + k] = name;
        }
    }
    all
}
