//! The last passes of compilation: what drives, what is counted; and the finished [`Scene`].

use super::asker::Asker;
use super::compile::{Compiler, NamedTie};
use super::configuration::{ALIGNMENT, LARGEST_ALIGNMENT};
use super::contacts::Shell;
use super::coordinate_sums::{self, Draws, Reading};
use super::equations::Unsupported;
use super::external_inputs::Hook;
use super::history::AngleId;
use super::left_out::LeftOut;
use super::loops::{self, Key};
use super::sweep::Freedom;
use super::unknown::UnknownId;
use super::{ConstraintElement, CountedAngle, Entry, LinkMotion, RowKind, Scene, Source};
use crate::diagnostic::{Diagnostic, Error, Severity};
use crate::expr::interpolation::Bindings;
use crate::expr::measures::Measure;
use crate::expr::program::{Input, Structures};
use crate::model::{ArrayKind, ElementKind, Model, Text};
use crate::physics::joint::Tie;
use crate::space::Vec3;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Choices in making a scene.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// make rows of all joints: the absolute-coordinate formulation, for comparison
    pub cut_all: bool,
    /// value of MODE: 1 kinematic, 3 initial conditions, 4 dynamic, 5 static
    pub mode: u32,
    /// COUPLER, SCREW, RACKPIN: the sum of displacements is zero, as in the manuals, rather than
    /// what the assembled configuration shows
    pub strict: bool,
    /// variables of joints are to be shown
    pub variables: bool,
    /// expressions to be evaluated beside those of the model: (name, text)
    pub extra: Vec<(String, Text)>,
    /// kinds of elements that are left out where they are not solved
    pub skip: BTreeSet<ElementKind>,
    /// closures for `USER(…)`
    pub hooks: Vec<Hook>,
    /// what `USER(…)` would compute is zero where no closure computes it
    pub zero_user: bool,
    /// VARIABLEs to which numbers from outside are added: inputs of a linear system
    pub plant_inputs: Vec<u32>,
    /// VARIABLEs whose functions commands will change: where one is a number, it is supplied from
    /// outside rather than part of the equations
    pub changing: BTreeSet<u32>,
    /// what the files of GRAPHICS hold, or why they do not, by the numbers of these
    pub shells: Arc<BTreeMap<u32, Result<Shell, String>>>,
}

impl Scene {
    /// Makes the scene of a model; it is shared and never changes.
    ///
    /// # Errors
    /// Everything that keeps the model from being solved, all at once.
    pub fn compile(model: &Model, options: &Options) -> Result<Arc<Scene>, Error> {
        let mut left_out = LeftOut::of(model, &options.skip, &options.hooks, options.zero_user);
        let without = (!left_out.elements.is_empty()).then(|| {
            let mut model = model.clone();
            model.inactive.extend(left_out.elements.iter().copied());
            model
        });
        let model = without.as_ref().unwrap_or(model);
        let mut c = Compiler::new(model);
        let (bindings, unusable) = super::formula::bindings(model, &options.hooks);
        let mut b = Builder {
            scene: Scene::default(),
            model,
            bindings,
            unusable,
            hooks: &options.hooks,
            zero_user: options.zero_user,
            shells: &options.shells,
            structures: Structures::default(),
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
            let f = b.compiled(&mut c, &Asker::Column(name.as_str().into()), text);
            b.scene.extra.push(f);
        }
        b.counted();
        b.read_zero();
        if c.errors.is_empty() {
            b.scene.memberships = b.scene.find_memberships();
            b.loops(&mut c);
            b.part_downstream();
            b.natural_sizes();
            b.check_partials(&mut c);
        }
        if c.errors.is_empty() {
            Ok(Arc::new(b.scene))
        } else {
            Err(c.errors.into())
        }
    }
}

/// Largest distance of a constraint's marker from the middle of all, as the dataset places them;
/// one when all coincide.
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

pub(super) struct Builder<'m> {
    pub(super) scene: Scene,
    pub(super) model: &'m Model,
    pub(super) bindings: Bindings,
    /// splines that cannot be used: told when something asks for one
    pub(super) unusable: Vec<Diagnostic>,
    pub(super) hooks: &'m [Hook],
    pub(super) zero_user: bool,
    pub(super) shells: &'m BTreeMap<u32, Result<Shell, String>>,
    /// expressions that differ in their numbers and in what they ask for share their code
    pub(super) structures: Structures,
}

impl<'m> Builder<'m> {
    /// Adds a state; returns its place in x.
    pub(super) fn add_state(&mut self, id: UnknownId) -> usize {
        let place = self.scene.unknowns.x.len();
        self.scene.unknowns.x.push(id);
        self.scene.layout.n_x = place + 1;
        place
    }

    /// Gravity and arrays of numbers.
    fn data(&mut self) {
        self.scene.gravity = Vec3(self.model.gravity);
        let asked = self.model.initial_conditions.numbers.get("ERROR").copied();
        self.scene.alignment = asked
            .filter(|e| *e > 0.0)
            .unwrap_or(ALIGNMENT)
            .min(LARGEST_ALIGNMENT);
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
        s.unknowns.q = std::mem::take(&mut c.positions);
        s.unknowns.v = std::mem::take(&mut c.velocities);
        (s.layout.n_q, s.layout.n_v) = (s.unknowns.q.len(), s.unknowns.v.len());
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
        let mut of_link: Vec<Vec<usize>> = vec![Vec::new(); s.links.len()];
        for (k, freedom) in s.freedoms.iter().enumerate() {
            of_link[freedom.link].push(k);
        }
        let mut last = vec![None; s.links.len()];
        s.carrier = vec![None; s.freedoms.len()];
        for l in 0..s.links.len() {
            let mut nearest = s.links[l].parent.and_then(|p| last[p]);
            for &k in &of_link[l] {
                s.carrier[k] = nearest;
                nearest = Some(k);
            }
            last[l] = nearest;
        }
        s.last_freedom = last;
        let reach = s.parts.iter().map(|p| p.initial.position.norm());
        let arms = s.markers.iter().map(|m| m.frame.position.norm());
        let reach = reach.chain(arms).filter(|x| x.is_finite());
        let reach = reach.fold(0.0, f64::max);
        let reach = if reach > 0.0 { reach } else { 1.0 };
        let [diameter, gyration] = self.extents();
        let size = if diameter > 0.0 { diameter } else { gyration };
        let s = &mut self.scene;
        s.size = if size > 0.0 { size } else { reach };
        s.length = reach;
    }

    /// Returns the diameter of what moves, as the dataset places it, and the largest radius of
    /// gyration, 0 where there is none: moving and turning the whole model does not change them.
    fn extents(&self) -> [f64; 2] {
        let s = &self.scene;
        let diameter = s.diameter(0..s.markers.len());
        let gyration = self.model.parts.values().map(|part| {
            let largest = part.ip[..3].iter().fold(0.0_f64, |m, i| m.max(*i));
            (largest / part.mass).sqrt()
        });
        let gyration = gyration.filter(|r| r.is_finite()).fold(0.0, f64::max);
        [diameter, gyration]
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
                |u: Unsupported| Diagnostic::error("loop", u.lack.to_string()).element(&u.asked_by);
            c.errors.extend(unsolvable.into_iter().map(error));
        }
    }

    /// Finds the angles whose turns are counted, wherever they are asked for, and the coordinates
    /// that know their turns.
    fn counted(&mut self) {
        let scene = &self.scene;
        let mut found: BTreeSet<AngleId> = BTreeSet::new();
        for f in &scene.formulas {
            for input in f.program.inputs() {
                if let Input::Measure(m, ids) = input
                    && m.counts_turns()
                {
                    found.insert(AngleId::Measure(*m, *ids));
                }
            }
        }
        let number = |m: usize| scene.markers[m].id;
        for f in &scene.forces {
            let ids = [number(f.i), f.j.map_or(0, number), 0, 0];
            found.extend(f.law.angles().iter().map(|&m| AngleId::Measure(m, ids)));
        }
        let sums = scene.rows.iter().filter_map(|row| match &row.kind {
            RowKind::Displacements(sum) => Some(&sum.terms),
            _ => None,
        });
        let in_rows = sums.flatten().map(|(_, d)| d);
        let shown = scene.joint_variables.iter().map(|v| &v.displacement);
        for d in in_rows.chain(shown) {
            if d.gauge.is_angle() && d.coordinates.is_none() {
                found.insert(scene.angle_id(d));
            }
        }
        let draws = Draws::default();
        let counted = found.into_iter().map(|id| counted(scene, &draws, id));
        self.scene.counted = counted.collect();
        self.scene.layout.n_turns = self.scene.counted.len();
    }
}

/// Returns a counted angle with the coordinates that know its turns: of AX, AY and AZ, which are
/// analytic functions of the coordinates, between markers of parts.
fn counted(scene: &Scene, draws: &Draws, id: AngleId) -> CountedAngle {
    let (reading, [i, j]) = match id {
        AngleId::Measure(Measure::Orient, [.., i, j]) => (None, [i, j]),
        AngleId::Measure(measure, [i, j, ..]) => (Some(Reading::Measure(measure)), [i, j]),
        AngleId::Gauge { markers, .. } => (None, markers),
    };
    let marker = |id: u32| match id {
        0 => Some(None),
        id => scene.marker_of.get(&id).map(|&m| Some(m)),
    };
    match (marker(i), marker(j)) {
        (Some(i), Some(j)) => CountedAngle {
            id,
            coordinates: reading.and_then(|reading| draws.sum(scene, reading, i, j)),
            between: coordinate_sums::turns_between(scene, i, j),
        },
        // a marker that floats along a curve
        _ => CountedAngle {
            id,
            coordinates: None,
            between: (0..scene.freedoms.len())
                .filter(|&k| scene.freedoms[k].turn)
                .collect(),
        },
    }
}
