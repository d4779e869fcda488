//! Numbers that come from outside the equations: last values of sensors, values of the past,
//! results of the user's closures, constants that commands change from one simulation to the next.
//!
//! They have places of their own at the end of the row that programs read. Whoever fills the row
//! computes them from what stands before them, so that the programs need not know where they come
//! from.

use super::coupled::Coupled;
use super::forces::Touched;
use super::history::DelayId;
use crate::model::{Comparison, ElementId, Formula};
use crate::physics::contact::Question;
use std::fmt;
use std::sync::Arc;

/// One number from outside, in the order of the places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExternalInput {
    /// what a sensor evaluated last: index in [`Scene::sensors`](super::Scene::sensors)
    Sensor(usize),
    /// what a sensor that is switched off evaluated last: the user's number
    Kept(u32),
    /// a value of the past: index in [`Scene::delays`](super::Scene::delays)
    Delay(usize),
    /// what is added to a VARIABLE that is a plant input: index in the formulas
    Input(usize),
    /// a discrete state, as it is until the next sample: index in
    /// [`Scene::samplers`](super::Scene::samplers), and which
    Sample(usize, usize),
    /// the value of a VARIABLE whose function is a number that commands will change: its number
    Constant(u32),
    /// a result of a closure: index in [`Scene::hooks`](super::Scene::hooks), and which
    Hook(usize, usize),
}

/// A SENSOR.
#[derive(Clone, Debug)]
pub struct SceneSensor {
    /// user's number
    pub id: u32,
    /// what is watched: index in the formulas
    pub formula: usize,
    /// how it is compared
    pub comparison: Comparison,
    /// with what
    pub value: f64,
    /// how near counts as equal
    pub error: f64,
    /// modulo 2π
    pub angular: bool,
    /// what SENVAL yields after it was triggered: index in the formulas
    pub evaluate: Option<usize>,
    /// ends the run
    pub halt: bool,
    /// ends the simulation
    pub end_simulation: bool,
    /// shows the state
    pub print: bool,
    /// distance of outputs afterwards
    pub dt: Option<f64>,
    /// length of the next integration step
    pub stepsize: Option<f64>,
    /// the integration begins anew
    pub restart: bool,
}

/// The discrete states of a GSE.
#[derive(Clone, Debug)]
pub struct SceneSampler {
    /// which GSE it belongs to
    pub id: ElementId,
    /// time between samples: index in the formulas
    pub period: usize,
    /// how many states
    pub n: usize,
    /// place of the first among the numbers from outside
    pub states: usize,
    /// place of what computes the first
    pub results: usize,
    /// what they are at the start
    pub initial: Vec<f64>,
}

/// A value of the past: `DELAY(expression, delay, history)`; indices in the formulas.
#[derive(Clone, Debug)]
pub struct SceneDelay {
    /// which value it is
    pub id: DelayId,
    /// what is remembered
    pub expression: usize,
    /// how long ago
    pub delay: usize,
    /// what it was before the start
    pub history: usize,
}

/// The arguments of a closure.
#[derive(Clone, Copy, Debug)]
pub struct Call<'a> {
    /// TIME
    pub time: f64,
    /// the element that asks
    pub element: ElementId,
    /// the numbers of `USER(…)`
    pub constants: &'a [f64],
    /// values of the expressions that the closure was registered with; for a GSE followed by its
    /// states, inputs and discrete states, for a COUPLER by its displacements, for a CURVE by its
    /// parameter and the order of the derivative, for a CONTACT by
    /// [`Pressing`](crate::physics::contact::Pressing) or
    /// [`Slipping`](crate::physics::contact::Slipping) of each touch
    pub values: &'a [f64],
}

/// A closure: fills in the results, which are zero when it is called.
///
/// One number for SFORCE, VARIABLE, DIFF or SENSOR; FX, FY, FZ, TX, TY, TZ for GFORCE, three for
/// VFORCE and VTORQUE; the value and its first two derivatives in time for MOTION; eight components
/// for REQUEST; rates of the states, then outputs, then what the discrete states are from the next
/// sample on, for GSE; x, y, z or a derivative of these for CURVE; for COUPLER
/// [`Partials`](super::coupled::Partials), which are NaN when it is called; for CONTACT the force
/// along the normal of each touch, for its FRICTION_FUNCTION x, y, z of each force on I's solid
/// across the normal.
pub type Law = dyn Fn(&Call<'_>, &mut [f64]) + Send + Sync;

/// A closure under its name.
#[derive(Clone)]
pub struct Hook {
    /// an element ("SFORCE/3"), also with the argument that is meant ("CONTACT/1
    /// FRICTION_FUNCTION"), the text of ROUTINE, or the first number of USER
    pub name: String,
    /// expressions whose values it is given
    pub inputs: Vec<String>,
    /// the closure
    pub law: Arc<Law>,
}

impl Hook {
    /// Returns true if it computes this USER of this element; `argument`: where it stands.
    pub fn stands_for(&self, element: ElementId, argument: &str, user: &Formula) -> bool {
        let Formula::User { constants, routine } = user else {
            return false;
        };
        let is_first =
            argument != FRICTION_FUNCTION && self.name.eq_ignore_ascii_case(&element.to_string());
        is_first
            || (self.name).eq_ignore_ascii_case(&format!("{element} {argument}"))
            || (routine.as_ref()).is_some_and(|r| r.trim().eq_ignore_ascii_case(&self.name))
            || constants
                .first()
                .is_some_and(|c| c.to_string() == self.name)
    }
}

impl fmt::Debug for Hook {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Hook({} of {:?})", self.name, self.inputs)
    }
}

/// The argument that no closure computes under the name of its element alone: FUNCTION beside it
/// has that.
const FRICTION_FUNCTION: &str = "FRICTION_FUNCTION";

/// Returns the closure that computes FUNCTION=USER of an element: of several the last.
pub fn closure_for(hooks: &[Hook], element: ElementId, user: &Formula) -> Option<usize> {
    closure_of(hooks, element, "FUNCTION", user)
}

/// Returns the closure that computes a USER of an argument of an element: of several the last.
pub fn closure_of(
    hooks: &[Hook],
    element: ElementId,
    argument: &str,
    user: &Formula,
) -> Option<usize> {
    hooks
        .iter()
        .rposition(|h| h.stands_for(element, argument, user))
}

/// A closure that computes external inputs, and the formulas it is given.
#[derive(Clone, Debug)]
pub enum HookKind {
    /// a closure of the user's
    User {
        /// which: index in [`Options::hooks`](super::build::Options::hooks)
        closure: usize,
        /// what it reads: indices in the formulas
        inputs: Vec<usize>,
    },
    /// the constraint of a COUPLER and its partial derivatives, in the order of
    /// [`Partials`](super::coupled::Partials)
    Coupled(Box<Coupled>),
    /// forces of a CONTACT where its solids touch
    Touched(Box<Touched>),
    /// where two solids touch: [`TOUCHES`](crate::physics::contact::TOUCHES) times
    /// [`TOUCH_NUMBERS`](crate::physics::contact::TOUCH_NUMBERS)
    Touches {
        /// of I and J
        question: Question,
        /// in whose frames they stand: indices in [`Scene::markers`](super::Scene::markers)
        markers: [usize; 2],
    },
}

/// A call of a closure, for one element.
#[derive(Clone, Debug)]
pub struct SceneHook {
    /// what is called
    pub kind: HookKind,
    /// the element that asks
    pub element: ElementId,
    /// the numbers of USER
    pub constants: Vec<f64>,
    /// how many numbers it yields
    pub n: usize,
    /// place of the first
    pub place: usize,
    /// nothing that moves depends on it
    pub output_only: bool,
}
