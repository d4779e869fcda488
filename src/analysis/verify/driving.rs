//! Forces that grow with the rate which they should damp, or the displacement which they should
//! undo, seen by moving one end of each a little.
//!
//! ```text
//! c = −∂F/∂ṡ, k = −∂F/∂s     s: displacement of the body of I along the direction of F on it
//! ```
//!
//! Damping is doubted where it is negative at some sample and positive at none: an oscillator that
//! excites itself damps far from rest, a force that is switched on later does at some time.
//! Stiffness is doubted where it is the same negative number everywhere: attractions grow with
//! nearness, and are not linear.

use crate::diagnostic::Diagnostic;
use crate::expr::interpolation::Bindings;
use crate::expr::measures::{self, Measure};
use crate::expr::program::Input;
use crate::expr::walk::Host;
use crate::model::{COMPONENTS, ElementId, ElementKind, Formula, Model};
use crate::physics::kinematic::kinematic_of;
use crate::scalar::Scalar;
use crate::scene::{Scene, formula};
use crate::space::{MarkerState, Mat3, Vec3};

/// Rates at which slopes are taken, in lengths of the mechanism or radians over a unit of time.
const RATES: [f64; 4] = [-1.0, -0.01, 0.01, 1.0];
/// Displacements there, in lengths of the mechanism or radians.
const DISPLACEMENTS: [f64; 5] = [-0.3, -0.05, 0.0, 0.05, 0.3];
/// Times there.
const TIMES: [f64; 2] = [0.0, 1.0];
/// Slope, relative to the force, below which it is rounding.
const LEAST_SLOPE: f64 = 1e-9;
/// VARIABLEs that read each other are followed so far.
const DEEPEST: usize = 8;

/// A component of a force: whose, its function, and how its body of I is moved.
struct Component<'m> {
    id: ElementId,
    argument: &'static str,
    function: &'m Formula,
    /// direction in ground of the force or torque on I
    along: Vec3<f64>,
    /// displacement against it that takes I to J, where the force acts along the line between both:
    /// behind J it points the other way
    reach: f64,
    turns: bool,
    i: u32,
}

/// Returns the rotation by an angle about a unit vector.
fn about(axis: Vec3<f64>, angle: f64) -> Mat3<f64> {
    let K = Mat3::cross_matrix(axis);
    Mat3::identity() + K.times(Scalar::sin(angle)) + (K * K).times(1.0 - Scalar::cos(angle))
}

/// Finds the forces that feed energy into the motion of their I marker.
pub(in crate::analysis) fn driving(scene: &Scene, model: &Model) -> Vec<Diagnostic> {
    let (bindings, _) = formula::bindings(model, &[]);
    let components = components(scene, model);
    let found = components.iter().filter_map(|c| {
        let [rate, place, force] = if c.turns {
            ["angular velocity", "angle", "torque"]
        } else {
            ["velocity", "displacement", "force"]
        };
        let slopes = Slopes::of(scene, model, &bindings, c)?;
        if let Some(slope) = slopes.along_displacement {
            let what = format!(
                "{}: the {force} on {} grows with its {place}, by {slope:.4} for each unit: a spring that pushes away",
                c.argument,
                ElementKind::Marker.id(c.i)
            );
            let d = Diagnostic::warning("negative_stiffness", what).element(c.id);
            return Some(d.help("a spring is against the displacement: in a force on I, -K*(DM(I, J) - length)"));
        }
        let slope = slopes.along_rate?;
        let what = format!(
            "{}: the {force} on {} grows with its {rate}, by {slope:.4} for each unit: it feeds energy instead of taking it",
            c.argument,
            ElementKind::Marker.id(c.i)
        );
        let d = Diagnostic::warning("negative_damping", what).element(c.id);
        Some(d.help("damping is against the rate: in a force on I, -C*VR(I, J)"))
    });
    found.collect()
}

/// Collects the components of all forces that expressions give.
fn components<'m>(scene: &Scene, model: &'m Model) -> Vec<Component<'m>> {
    let frame = |id: u32| scene.marker_of.get(&id).map(|&m| scene.drawn(m));
    let mut all = Vec::new();
    for (id, s) in model.active(ElementKind::Sforce, &model.sforces) {
        let (Some(i), Some(j)) = (frame(s.i), frame(s.j)) else {
            continue;
        };
        let line = i.position - j.position;
        let (along, reach) = if s.rotational || s.action_only {
            (j.rotation.column(2), f64::INFINITY)
        } else if line.norm() > 0.0 {
            (line.times(1.0 / line.norm()), line.norm())
        } else {
            continue;
        };
        all.push(Component {
            id: ElementKind::Sforce.id(id),
            argument: "FUNCTION",
            function: &s.function,
            along,
            reach,
            turns: s.rotational,
            i: s.i,
        });
    }
    let vectors = [
        (ElementKind::Vforce, &model.vforces),
        (ElementKind::Vtorque, &model.vtorques),
        (ElementKind::Gforce, &model.gforces),
    ];
    for (kind, list) in vectors {
        for (id, f) in model.active(kind, list) {
            let axes =
                f.rm.and_then(frame)
                    .map_or(Mat3::identity(), |f| f.rotation);
            let given = f.force.iter().chain(&f.torque).enumerate();
            all.extend(given.filter_map(|(k, function)| {
                Some(Component {
                    id: kind.id(id),
                    argument: COMPONENTS[k],
                    function: function.as_ref()?,
                    along: axes.column(k % 3),
                    reach: f64::INFINITY,
                    turns: k >= 3,
                    i: f.i,
                })
            }));
        }
    }
    all
}

/// The slopes of a component that drive, in all samples.
struct Slopes {
    /// the largest slope along the rate, where none is negative
    along_rate: Option<f64>,
    /// the slope along the displacement at rest, where it is the same and positive everywhere
    along_displacement: Option<f64>,
}

impl Slopes {
    /// Evaluates a component at samples until none of the two can be; `None` where it has no value
    /// at one.
    fn of(scene: &Scene, model: &Model, bindings: &Bindings, c: &Component<'_>) -> Option<Self> {
        let Formula::Expression { text, .. } = c.function else {
            return None;
        };
        let expr = text.expression().ok()?;
        let one = if c.turns { 1.0 } else { scene.length };
        let inputs = expr.inputs();
        if !inputs.iter().any(|i| moves(*i)) {
            return None;
        }
        let mut rate = Rising::new(inputs.iter().any(|i| has_rate(*i)));
        let mut place = Constant::default();
        for time in TIMES {
            let mut before: Option<(f64, f64)> = None;
            let on_its_side = |d: &f64| d * one > -c.reach;
            for displacement in DISPLACEMENTS.into_iter().filter(on_its_side) {
                let at = |rate: f64| {
                    let moved = Moved {
                        scene,
                        model,
                        bindings,
                        component: c,
                        displacement: displacement * one,
                        rate: rate * one,
                        time,
                        depth: 0,
                    };
                    expr.eval_with(&moved).ok().filter(|x| x.is_finite())
                };
                let values = match rate.may_be {
                    true => RATES.into_iter().map(at).collect::<Option<Vec<f64>>>()?,
                    // without a rate the value at rest is that at any
                    false => vec![at(0.0)?; RATES.len()],
                };
                rate.see(&values, one);
                // between the two smallest rates
                let here = (displacement, 0.5 * (values[1] + values[2]));
                if let Some(before) = before.replace(here) {
                    place.see(before, here, one);
                }
                if !rate.may_be && !place.may_be() {
                    return None;
                }
            }
        }
        Some(Self {
            along_rate: rate.largest.filter(|_| rate.may_be),
            along_displacement: place.slope.filter(|_| place.may_be()),
        })
    }
}

/// Returns whether an input changes as a body moves: constants, TIME and MODE do not.
fn moves(input: Input) -> bool {
    !matches!(input, Input::Time | Input::Mode)
}

/// Returns whether an input may change with the velocity of a body.
fn has_rate(input: Input) -> bool {
    match input {
        Input::Measure(measure, _) => measure.row().family != measures::Family::Displacement,
        other => moves(other),
    }
}

/// A value that rises with the rate somewhere and falls nowhere.
struct Rising {
    may_be: bool,
    largest: Option<f64>,
}

impl Rising {
    fn new(may_be: bool) -> Self {
        Self {
            may_be,
            largest: None,
        }
    }

    /// Sees the values at all rates, which are so many units of a size.
    fn see(&mut self, values: &[f64], one: f64) {
        for (pair, rates) in values.windows(2).zip(RATES.windows(2)) {
            let change = pair[1] - pair[0];
            let least = LEAST_SLOPE * pair[0].abs().max(pair[1].abs());
            self.may_be &= change >= -least;
            if change > least {
                let slope = change / ((rates[1] - rates[0]) * one);
                self.largest = Some(self.largest.map_or(slope, |l: f64| l.max(slope)));
            }
        }
    }
}

/// A slope along the displacement that is the same wherever it was seen.
#[derive(Default)]
struct Constant {
    slope: Option<f64>,
    differs: bool,
}

impl Constant {
    fn may_be(&self) -> bool {
        !self.differs
    }

    /// Sees two displacements, in units of a size, with the values there.
    fn see(&mut self, (x0, y0): (f64, f64), (x1, y1): (f64, f64), one: f64) {
        let slope = (y1 - y0) / ((x1 - x0) * one);
        let scale = y0.abs() / one;
        let known = *self.slope.get_or_insert(slope);
        self.differs |=
            slope <= 1e-6 * scale || (slope - known).abs() > 1e-6 * (slope.abs() + scale);
    }
}

/// The model with the body of I moved along the direction of a force; everything else as drawn, at
/// rest.
struct Moved<'a> {
    scene: &'a Scene,
    model: &'a Model,
    bindings: &'a Bindings,
    component: &'a Component<'a>,
    displacement: f64,
    rate: f64,
    time: f64,
    depth: usize,
}

impl Moved<'_> {
    fn marker(&self, id: u32) -> Option<MarkerState<f64>> {
        let c = self.component;
        let &m = self.scene.marker_of.get(&id)?;
        let drawn = self.scene.drawn(m);
        let mut state = MarkerState::ground();
        (state.R_GM, state.p_GM) = (drawn.rotation, drawn.position);
        if self.model.body_of(id) == self.model.body_of(c.i) {
            if c.turns {
                let centre = self.scene.drawn(*self.scene.marker_of.get(&c.i)?).position;
                let turn = about(c.along, self.displacement);
                state.R_GM = turn * state.R_GM;
                state.p_GM = centre + turn.apply(state.p_GM - centre);
                state.w_GM = c.along.times(self.rate);
                state.v_GM = state.w_GM.cross(state.p_GM - centre);
            } else {
                state.p_GM += c.along.times(self.displacement);
                state.v_GM = c.along.times(self.rate);
            }
        }
        Some(state)
    }

    /// The value of a VARIABLE there.
    fn variable(&self, id: u32) -> Option<f64> {
        let Formula::Expression { text, .. } = &self.model.variables.get(&id)?.function else {
            return None;
        };
        if self.depth == DEEPEST {
            return None;
        }
        let deeper = Moved {
            depth: self.depth + 1,
            ..*self
        };
        text.expression().ok()?.eval_with(&deeper).ok()
    }
}

impl Host for Moved<'_> {
    fn input(&self, input: Input) -> Option<f64> {
        match input {
            Input::Time => Some(self.time),
            Input::Mode => Some(4.0),
            Input::Measure(Measure::Varval, [id, ..]) => self.variable(id),
            Input::Measure(measure, arguments) => {
                kinematic_of(measure, arguments, |id| self.marker(id))
            }
            Input::Delayed(_) | Input::Slot(_) => None,
        }
    }
    fn bindings(&self) -> Option<&Bindings> {
        Some(self.bindings)
    }
}
