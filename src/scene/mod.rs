//! The scene: what must be computed, dense and constant; made once from a
//! [`Model`](crate::model::Model).
//!
//! Parts hang on a forest of links, one primitive motion each; what closes loops is a row. Numbers
//! are indices here, names live in one list, and everything a run does not need has been left out
//! before it starts.

pub mod articulated;
pub mod asker;
pub mod broken;
pub mod build;
pub mod cams;
pub mod compile;
mod compliance;
pub mod configuration;
pub mod contacts;
mod coordinate_sums;
pub mod coupled;
mod couplers;
mod downstream;
pub mod elimination;
pub mod equations;
pub mod external_inputs;
mod force_elements;
pub mod forces;
pub mod forest;
pub(crate) mod formula;
mod frictions;
mod functions;
mod general;
pub mod history;
pub mod layout;
pub mod left_out;
pub mod loop_factor;
pub mod loops;
pub mod mechanisms;
mod motions;
pub mod mover;
pub mod programs;
mod reads;
pub mod recorder;
mod row_scale;
pub mod slopes;
pub mod solve;
pub mod sweep;
mod systems;
pub mod tunnelling;
pub mod unknown;
pub mod untouchable;

use crate::expr::measures::Measure;
use crate::expr::program::Program;
use crate::model::{ElementId, ElementKind, Level};
use crate::physics::coupler::Gauge;
use crate::physics::row::Law;
use crate::scene::asker::Asker;
use crate::space::{Frame, Mat3, Vec3};
use forces::ForceElement;
use history::AngleId;
use layout::{Layout, State};
use std::collections::{BTreeMap, BTreeSet};
use sweep::Freedom;
use unknown::{CoordinateId, DifferentialId, UnknownId};

/// Index of a link in [`Scene::links`]; `None` is ground.
pub type LinkIx = Option<usize>;

/// A rigid body or a massless step of a joint, moved by at most one primitive against its parent.
#[derive(Clone, Debug)]
pub struct Link {
    /// what carries it; parents come before children
    pub parent: LinkIx,
    /// where the primitive starts, in the parent's frame
    pub placement: Frame<f64>,
    /// how it moves from there
    pub motion: LinkMotion,
    /// mass, in units in which force = mass · acceleration
    pub mass: f64,
    /// mass times position of the centre of mass, in the link's frame
    pub moment: Vec3<f64>,
    /// inertia about the link's origin, in the link's axes
    pub inertia: Mat3<f64>,
}

/// The one motion of a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LinkMotion {
    /// none
    Rigid,
    /// along `axis` by `sign` × coordinate
    Slide {
        /// 0 x, 1 y, 2 z
        axis: usize,
        /// 1, or −1 when the joint is passed from I to J
        sign: f64,
        /// index in [`Scene::coordinates`]
        coordinate: usize,
    },
    /// about `axis` by `sign` × coordinate
    Turn {
        /// 0 x, 1 y, 2 z
        axis: usize,
        /// 1, or −1 when the joint is passed from I to J
        sign: f64,
        /// index in [`Scene::coordinates`]
        coordinate: usize,
    },
    /// by a unit quaternion
    Ball {
        /// first of three consecutive coordinates (angular velocity in the link's axes)
        coordinate: usize,
        /// index of the quaternion's first number in q
        quaternion: usize,
    },
}

/// A velocity coordinate of the forest.
#[derive(Clone, Debug)]
pub struct Coordinate {
    /// the element it belongs to, with what it measures
    pub id: CoordinateId,
    /// the joint it is a variable of; `None` for free parts
    pub joint: Option<u32>,
    /// whether it is an angle (else a length)
    pub angular: bool,
    /// who says what it does
    pub source: Source,
    /// its value in the configuration of the dataset; `None` for a ball
    pub initial: Option<f64>,
    /// the link it moves
    pub link: usize,
}

/// Who says what a coordinate does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// the equations of motion: places of its position in q and of its velocity in v; three of a
    /// ball share a quaternion, and their `q` is that of the quaternion
    Free {
        /// place in q
        q: usize,
        /// place in v
        v: usize,
    },
    /// a MOTION: index in [`Scene::motions`]
    Driven(usize),
}

/// A part: where it sits on its link.
#[derive(Clone, Debug)]
pub struct PartOnLink {
    /// which PART or POINT_MASS it is
    pub id: ElementId,
    /// what carries it
    pub link: LinkIx,
    /// part frame in the link's frame
    pub frame: Frame<f64>,
    /// part frame in ground as the dataset has it
    pub initial: Frame<f64>,
}

impl PartOnLink {
    /// Returns whether it is a POINT_MASS, which does not turn.
    pub fn is_point_mass(&self) -> bool {
        self.id.kind == ElementKind::PointMass
    }
}

/// A marker: where it sits on its link.
#[derive(Clone, Debug)]
pub struct MarkerOnLink {
    /// user's number
    pub id: u32,
    /// what carries it
    pub link: LinkIx,
    /// marker frame in the link's frame
    pub frame: Frame<f64>,
    /// index in [`Scene::parts`]; `None` on ground
    pub part: Option<usize>,
}

/// One scalar constraint equation.
#[derive(Clone, Debug)]
pub struct Row {
    /// the element it comes from
    pub element: ElementId,
    /// Adams' name of the equation: "Zi.Xj"
    pub equation: String,
    /// what it says
    pub kind: RowKind,
}

impl Row {
    /// Returns whether it is an equation of velocities, which no position has to satisfy.
    pub fn is_of_velocities(&self) -> bool {
        matches!(
            self.kind,
            RowKind::Formula {
                of_velocities: true,
                ..
            }
        )
    }
}

/// The equation that a row is.
#[derive(Clone, Debug)]
pub enum RowKind {
    /// a law between two markers (indices in [`Scene::markers`]), possibly driven by a motion
    Markers {
        /// the equation
        law: Law,
        /// I marker
        i: usize,
        /// J marker
        j: usize,
        /// index in [`Scene::motions`]
        motion: Option<usize>,
    },
    /// Σ factor · displacement = constant
    Displacements(Sum),
    /// an expression of places and time, or of velocities too, is zero
    Formula {
        /// index in [`Scene::formulas`]
        formula: usize,
        /// what counts as one
        scale: f64,
        /// it reads velocities: it holds these, and no position
        of_velocities: bool,
    },
    /// a point on a curve, or a curve on a curve
    Cam {
        /// index in [`Scene::cams`]
        cam: usize,
        /// which of its two rows
        component: usize,
    },
}

/// A weighted sum of displacements that keeps its value.
#[derive(Clone, Debug)]
pub struct Sum {
    /// factors and displacements
    pub terms: Vec<(f64, Displacement)>,
    /// what the sum is in the model; what it is in a mechanism says
    /// [`Configuration::sums`](configuration::Configuration::sums)
    pub constant: f64,
    /// assembly adds what the configuration shows
    pub held: bool,
    /// GEAR: the CV marker, and the I markers of the two geared bodies, on which the force of the
    /// row acts there along its z axis
    pub contact: Option<(usize, [usize; 2])>,
    /// COUPLER by a routine: what is zero instead of the sum
    pub coupled: Option<Box<coupled::Coupled>>,
}

impl Sum {
    /// Returns what counts as one, in a mechanism of the given size.
    pub fn scale(&self, length: f64) -> f64 {
        if let Some(coupled) = &self.coupled {
            return coupled.scale;
        }
        let one = |d: &Displacement| if d.gauge.is_angle() { 1.0 } else { length };
        self.terms.iter().map(|(f, d)| f.abs() * one(d)).sum()
    }
}

/// A distance or an angle between two markers.
#[derive(Clone, Debug)]
pub struct Displacement {
    /// what it measures
    pub gauge: Gauge,
    /// I marker
    pub i: usize,
    /// J marker
    pub j: usize,
    /// the same as a sum of coordinates, where it is one in every configuration
    pub coordinates: Option<CoordinateSum>,
}

/// `Σ factor · coordinate + constant`: a displacement that is this in every configuration; an angle
/// up to whole turns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CoordinateSum {
    /// indices in [`Scene::coordinates`], and factors
    pub terms: Vec<(usize, f64)>,
    /// the displacement where all coordinates are zero   [rad, length]
    pub constant: f64,
}

/// A variable of a joint that is shown among the results.
#[derive(Clone, Debug)]
pub struct JointVariable {
    /// user's number of the JOINT
    pub joint: u32,
    /// ANGLE, DISTANCE …
    pub name: &'static str,
    /// what it is
    pub displacement: Displacement,
}

/// An angle whose turns are counted.
#[derive(Clone, Debug, PartialEq)]
pub struct CountedAngle {
    /// which angle it is
    pub id: AngleId,
    /// the coordinates that know its turns; `None`: these are counted from step to step
    pub coordinates: Option<CoordinateSum>,
    /// angular coordinates that turn its markers against each other: indices in
    /// [`Scene::coordinates`]
    pub between: Vec<usize>,
}

/// An expression of the model, compiled.
#[derive(Clone, Debug)]
pub struct Formula {
    /// whose it is
    pub owner: Asker,
    /// its text, for messages
    pub text: String,
    /// its code; asks for its inputs by [`Input`](crate::expr::program::Input)
    pub program: Program,
    /// its value and its partial derivatives by its inputs, where a constraint needs them
    pub gradient: Option<Program>,
    /// where its delayed values stand among the numbers from outside
    pub delayed: Vec<usize>,
}

/// An entry of an ARRAY.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Entry {
    /// it stands in the dataset
    Number(f64),
    /// a state: index in [`Scene::differentials`]
    State(usize),
    /// an input or output: index in [`Scene::formulas`]
    Formula(usize),
}

/// A MOTION.
#[derive(Clone, Debug)]
pub struct SceneMotion {
    /// user's number
    pub id: u32,
    /// what its function is: displacement, velocity or acceleration
    pub level: Level,
    /// index in [`Scene::formulas`]
    pub formula: usize,
    /// place in x of the displacement (velocity and acceleration level), and of the velocity after
    /// it (acceleration level)
    pub state: Option<usize>,
    /// the coordinate it drives; `None`: it is a row
    pub coordinate: Option<usize>,
    /// a row given by its rate, without ICDISP: it begins where the assembled configuration is
    pub held: bool,
    /// the motion of another body angle between the same markers, with which its angle is read off
    pub beside: Option<usize>,
}

/// A differential equation `ẋ = function`: of a DIFF, or a state of another element.
#[derive(Clone, Debug)]
pub struct SceneDifferential {
    /// whose equation it is
    pub id: DifferentialId,
    /// place in x; `None`: implicit without DIF1, an algebraic equation
    pub state: Option<usize>,
    /// index in [`Scene::formulas`]: the rate, or what is zero
    pub formula: usize,
    /// value and rate at the start
    pub initial: [f64; 2],
    /// frozen in statics
    pub static_hold: bool,
    /// IMPLICIT: the formula is zero
    pub implicit: bool,
}

/// A constraint element: whose reaction can be asked for.
#[derive(Clone, Debug)]
pub struct ConstraintElement {
    /// which element it is
    pub id: ElementId,
    /// I and J markers, where it has them
    pub markers: Option<(usize, usize)>,
    /// the markers at which its rows act on what I stands for
    pub acts_on: Vec<usize>,
    /// the markers that an equation of velocities reads, whose parts it joins
    pub joins: Vec<usize>,
    /// the marker about whose origin its reaction is given
    pub about: Option<usize>,
    /// it carries a link: the last link of its chain, and whether it is passed from I to J
    pub carries: Option<(usize, bool)>,
    /// the equations between its markers that a joint is, whether it carries a link or not
    pub laws: &'static [Law],
    /// its rows, indices in [`Scene::rows`]
    pub rows: std::ops::Range<usize>,
    /// MOTION on a coordinate: which
    pub coordinate: Option<usize>,
}

/// A compiled model, dense and flat. It never changes: decisions about it stand in its
/// [`Configuration`](configuration::Configuration).
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// rigid bodies and massless steps, carriers first
    pub links: Vec<Link>,
    /// velocity coordinates of the forest
    pub coordinates: Vec<Coordinate>,
    /// one scalar freedom per coordinate, in the same order
    pub freedoms: Vec<Freedom>,
    /// per freedom: the nearest freedom that carries it
    pub carrier: Vec<Option<usize>>,
    /// per link: the last freedom that moves it
    pub last_freedom: Vec<Option<usize>>,
    /// parts and where they sit
    pub parts: Vec<PartOnLink>,
    /// markers and where they sit
    pub markers: Vec<MarkerOnLink>,
    /// user's marker number → index
    pub marker_of: BTreeMap<u32, usize>,
    /// constraint equations, those that depend on others included
    pub rows: Vec<Row>,
    /// constraint elements
    pub constraints: Vec<ConstraintElement>,
    /// forces
    pub forces: Vec<ForceElement>,
    /// motions
    pub motions: Vec<SceneMotion>,
    /// points on curves and curves on curves
    pub cams: Vec<cams::Cam>,
    /// user's number of a floating marker of these → (which, side of its contact)
    pub floating: BTreeMap<u32, (usize, usize)>,
    /// differential equations
    pub differentials: Vec<SceneDifferential>,
    /// user's VARIABLE number → formula
    pub variables: BTreeMap<u32, usize>,
    /// user's ARRAY number → entries
    pub arrays: BTreeMap<u32, Vec<Entry>>,
    /// PINPUT or POUTPUT → formulas
    pub plants: BTreeMap<ElementId, Vec<usize>>,
    /// sensors
    pub sensors: Vec<external_inputs::SceneSensor>,
    /// bodies that could pass through each other within a step
    pub thickness_bounds: Vec<tunnelling::ThicknessBound>,
    /// discrete states
    pub samplers: Vec<external_inputs::SceneSampler>,
    /// values of the past
    pub delays: Vec<external_inputs::SceneDelay>,
    /// calls of the user's closures
    pub hooks: Vec<external_inputs::SceneHook>,
    /// user's REQUEST number → formulas, of those that a closure computes
    pub requests: BTreeMap<u32, Vec<usize>>,
    /// numbers from outside, in the order of their places
    pub external_inputs: Vec<external_inputs::ExternalInput>,
    /// all expressions
    pub formulas: Vec<Formula>,
    /// of these, the ones asked for beside those of the model
    pub extra: Vec<usize>,
    /// elements that are switched off: they exert nothing
    pub inactive: BTreeSet<ElementId>,
    /// elements that are left out because they are not solved
    pub left_out: left_out::LeftOut,
    /// angles whose turns are counted, in the order of their places in the layout
    pub counted: Vec<CountedAngle>,
    /// variables of joints, where somebody wants to see them
    pub joint_variables: Vec<JointVariable>,
    /// what functions read too early: unknowns of their own
    pub loops: Vec<loops::Unknown>,
    /// the place of each of them
    pub loop_of: BTreeMap<loops::Key, usize>,
    /// their equations are linear, so that programs eliminate them
    pub loops_linear: bool,
    /// in ground axes
    pub gravity: Vec3<f64>,
    /// value of MODE
    pub mode: f64,
    /// places of unknowns
    pub layout: Layout,
    /// formula → place among the numbers from outside of what is added to it
    pub(crate) plant_inputs: BTreeMap<usize, usize>,
    /// user's DIFF number → its differential equation
    pub(crate) diffs: BTreeMap<u32, usize>,
    /// identities of the states, with those downstream of the mechanism
    pub unknowns: State<Vec<UnknownId>>,
    /// formulas that the states downstream read and nothing of the mechanism does   (n_formulas;
    /// empty: none)
    pub read_downstream: Vec<bool>,
    /// positions from the dataset, before assembly   (n_q)
    pub initial_q: Vec<f64>,
    /// what was left out
    pub warnings: Vec<crate::diagnostic::Diagnostic>,
    /// a typical length of the coordinates, for tolerances and scales that may not be rounding: how
    /// far the mechanism is from the origin
    pub length: f64,
    /// how large the mechanism is, wherever the origin is: what is told and what moves at assembly
    /// depends on this alone
    pub(crate) size: f64,
    /// which mechanism each link belongs to   (n_links)
    pub(crate) memberships: Vec<mechanisms::Membership>,
    /// distance over which constraints are spread: an arm for comparing torques with forces
    pub span: f64,
    /// misalignment up to which rows that depend on others are left out: IC/ERROR, in rad, and as
    /// a part of the size of a loop
    pub alignment: f64,
    /// the unit of lengths, for messages: "meter"; empty when the model says none
    pub length_unit: String,
}

impl Link {
    /// Returns whether it has neither mass nor inertia of its own.
    pub(in crate::scene) fn is_massless(&self) -> bool {
        let none = |row: &[f64; 3]| *row == [0.0; 3];
        self.mass == 0.0 && none(&self.moment.0) && self.inertia.0.iter().all(none)
    }
}

impl Scene {
    /// Returns which links show no inertia to what carries them, whatever moves: rigid ones without
    /// mass that carry nothing else   (n_links)
    pub(in crate::scene) fn idle_links(&self) -> Vec<bool> {
        let mut idle: Vec<bool> = (self.links.iter())
            .map(|l| matches!(l.motion, LinkMotion::Rigid) && l.is_massless())
            .collect();
        for l in (0..idle.len()).rev() {
            if let (Some(parent), false) = (self.links[l].parent, idle[l]) {
                idle[parent] = false;
            }
        }
        idle
    }

    /// Most freedoms on a way from ground to a leaf.
    pub fn depth(&self) -> usize {
        let mut depth = vec![0; self.freedoms.len()];
        for k in 0..depth.len() {
            depth[k] = 1 + self.carrier[k].map_or(0, |c| depth[c]);
        }
        depth.into_iter().max().unwrap_or(0)
    }

    /// Returns the last freedom that carries two freedoms or is one of them; `None`: ground alone
    /// carries both.
    pub fn common_carrier(&self, [mut a, mut b]: [Option<usize>; 2]) -> Option<usize> {
        // carriers come first, so the later of two freedoms does not carry the other
        while a != b {
            let later = if a > b { &mut a } else { &mut b };
            *later = later.and_then(|k| self.carrier[k]);
        }
        a
    }

    /// Returns the last link that carries two links or is one of them; `None`: ground alone carries
    /// both.
    pub fn common_link(&self, [mut a, mut b]: [LinkIx; 2]) -> LinkIx {
        // carriers come first, so the later of two links does not carry the other
        while a != b {
            let later = if a > b { &mut a } else { &mut b };
            *later = later.and_then(|l| self.links[l].parent);
        }
        a
    }

    /// Pose of a marker in ground as the dataset places its part.
    pub fn drawn(&self, marker: usize) -> Frame<f64> {
        let m = &self.markers[marker];
        m.part.map_or(m.frame, |p| {
            let p = &self.parts[p];
            p.initial.compose(&p.frame.inverse().compose(&m.frame))
        })
    }

    /// Returns the identity of a displacement that is an angle.
    pub(in crate::scene) fn angle_id(&self, d: &Displacement) -> AngleId {
        AngleId::Gauge {
            gauge: d.gauge,
            markers: [d.i, d.j].map(|m| self.markers[m].id),
        }
    }

    /// Returns the differential equation of a DIFF by the user's number: its index.
    pub fn differential(&self, diff: u32) -> Option<usize> {
        self.diffs.get(&diff).copied()
    }

    /// Returns the names of the integrator's unknowns in their order, for messages and results.
    pub fn unknown_names(&self) -> Vec<String> {
        let State { q, v, x } = &self.unknowns;
        let all = q.iter().chain(v).chain(&x[..self.layout.n_upstream()]);
        all.map(ToString::to_string).collect()
    }

    /// Returns the identities of the states downstream of the mechanism.
    pub fn downstream(&self) -> &[UnknownId] {
        &self.unknowns.x[self.layout.n_upstream()..]
    }

    /// Returns true if a motion drives an angle rather than a length.
    pub fn drives_an_angle(&self, motion: usize) -> bool {
        if let Some(c) = self.motions[motion].coordinate {
            return self.coordinates[c].angular;
        }
        self.rows.iter().any(|row| match &row.kind {
            RowKind::Markers { law, motion: m, .. } => *m == Some(motion) && !law.is_length(),
            _ => false,
        })
    }

    /// Where the results of a closure of the user's stand among the numbers from outside, when a
    /// formula is one of them: for a MOTION the value and its two derivatives in time.
    pub fn computed(&self, formula: usize) -> Option<usize> {
        let place = *self.formulas.get(formula)?.delayed.first()?;
        matches!(
            self.external_inputs.get(place),
            Some(external_inputs::ExternalInput::Hook(..))
        )
        .then_some(place)
    }

    /// Returns the formula of an entry of PINPUT or POUTPUT, which PINVAL or POUVAL reads; entries
    /// count from 1.
    pub(in crate::scene) fn plant_formula(
        &self,
        measure: Measure,
        id: u32,
        k: u32,
    ) -> Option<usize> {
        let kind = match measure {
            Measure::Pouval => ElementKind::Poutput,
            _ => ElementKind::Pinput,
        };
        let entries = self.plants.get(&kind.id(id))?;
        entries.get((k as usize).checked_sub(1)?).copied()
    }

    /// Where SENVAL of a sensor stands among the numbers from outside.
    pub fn sensor_place(&self, id: u32) -> Option<usize> {
        self.external_inputs
            .iter()
            .position(|s| self.sensor_of(*s) == Some(id))
    }

    /// The user's number of the sensor that a number from outside belongs to.
    pub fn sensor_of(&self, supplied: external_inputs::ExternalInput) -> Option<u32> {
        match supplied {
            external_inputs::ExternalInput::Sensor(k) => Some(self.sensors[k].id),
            external_inputs::ExternalInput::Kept(id) => Some(id),
            _ => None,
        }
    }

    /// Returns a motion's displacement in the configuration of the dataset, where it drives a
    /// coordinate of the forest.
    pub fn initial_displacement(&self, motion: usize) -> Option<f64> {
        self.motions[motion]
            .coordinate
            .and_then(|c| self.coordinates[c].initial)
    }
}
