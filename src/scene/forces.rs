//! The force elements of a scene: which law, between which markers, reacting on what.

use super::LinkIx;
use super::equations::Equations;
use crate::expr::measures::Measure;
use crate::model::ElementId;
use crate::physics::action::{self, ALL_ANGLES, Action, Law};
use crate::physics::bushing::{self, Bushing};
use crate::physics::contact::{self, Outside, Pressing, Slipping, Touch};
use crate::physics::field::Field;
use crate::physics::friction::{Friction, Slip};
use crate::physics::nodal_force::NodalForce;
use crate::physics::spring_damper::SpringDamper;
use crate::scalar::Scalar;
use crate::scene::asker::Asker;
use crate::space::{MarkerState, Vec3};
use std::ops::Range;
use std::sync::Arc;

/// A force between markers.
#[derive(Clone, Debug)]
pub struct ForceElement {
    /// which element it is
    pub id: ElementId,
    /// marker acted on
    pub i: usize,
    /// J marker; `None` where the element has a floating one, which moves with I
    pub j: Option<usize>,
    /// number of the floating J marker, 0 where there is none
    pub floating: u32,
    /// what feels the reaction, at the origin of I; `None`: nothing does
    pub reaction: Option<LinkIx>,
    /// its law
    pub law: ForceLaw,
}

/// The way in which the touches of two solids are found.
#[derive(Clone, Debug)]
pub enum Touching {
    /// by a formula of the two frames
    Formula(contact::Pair),
    /// by a query: places of its numbers among those from outside
    Query(Range<usize>),
}

/// The force between two solids of a CONTACT.
#[derive(Clone, Debug)]
pub struct ContactForce {
    /// where they touch
    pub touching: Touching,
    /// what the solids do there, as far as no routine says it
    pub law: contact::Law,
    /// places of the forces along the normal among the numbers from outside; none: the law has them
    pub normal: Range<usize>,
    /// the same of the forces across it
    pub friction: Range<usize>,
}

impl ContactForce {
    fn action<S: Scalar>(
        &self,
        at: &Equations<'_, S>,
        i: &MarkerState<S>,
        j: &MarkerState<S>,
    ) -> Action<S> {
        let outside = Outside {
            normal: at.external(self.normal.clone()),
            friction: at.external(self.friction.clone()),
        };
        let touches = self.touching.touches(at, i, j);
        contact::action(&touches, &self.law, outside, i, j)
    }

    /// Returns whether the law says what the contact stores: no routine computes the force along
    /// the normal.
    fn stores(&self) -> bool {
        self.normal.is_empty()
    }
}

/// A question to a closure of the user's: forces of a CONTACT at its touches.
#[derive(Clone, Debug)]
pub struct Touched {
    /// which: index in [`Options::hooks`](super::build::Options::hooks)
    pub closure: usize,
    /// what it reads beside the touches: indices in the formulas
    pub inputs: Vec<usize>,
    /// I and J marker
    pub markers: [usize; 2],
    /// where the solids touch, and the forces that are known before
    pub force: ContactForce,
    /// friction is asked for, rather than the force along the normal
    pub slips: bool,
}

impl Touched {
    /// Returns the numbers that the closure is given.
    pub fn numbers<S: Scalar>(&self, at: &Equations<'_, S>) -> Vec<S> {
        let [i, j] = self.markers.map(|m| at.marker(m));
        let mut all: Vec<S> = self.inputs.iter().map(|&f| at.formula(f)).collect();
        let known = at.external(self.force.normal.clone());
        for (k, touch) in self.force.touching.touches(at, &i, &j).iter().enumerate() {
            let pressing = Pressing::of(touch, &i, &j);
            if !self.slips {
                all.extend(pressing.numbers());
                continue;
            }
            let law = || self.force.law.normal.force(touch.depth, -pressing.gap_rate);
            let normal_force = known.get(k).copied().unwrap_or_else(law);
            all.extend(Slipping::of(touch, normal_force, &i, &j).numbers());
        }
        all
    }
}

/// Hands the table of laws that are nothing but their numbers, between two markers, to the macro
/// `$then`. A law is made of its statement by `From`, beside the statement in `model/force.rs`.
///
/// ```text
/// kind  list of its statements in the model: its law
/// ```
macro_rules! laws_of_two_markers {
    ($then:ident) => {
        $then! {
            SpringDamper spring_dampers: SpringDamper;
            Bushing bushings: Bushing;
        }
    };
}
pub(super) use laws_of_two_markers;

macro_rules! force_laws {
    ($($kind:ident $list:ident: $law:ty;)*) => {
        /// The laws.
        #[derive(Clone, Debug)]
        pub enum ForceLaw {
            /// SFORCE
            Single {
                /// ROTATION
                rotational: bool,
                /// ACTIONONLY
                action_only: bool,
                /// index in the formulas
                formula: usize,
                /// whether the formula is the number zero
                idle: bool,
            },
            /// VFORCE, VTORQUE, GFORCE
            Vector {
                /// marker whose axes the components have; `None` = ground
                rm: Option<usize>,
                /// indices in the formulas: FX FY FZ TX TY TZ
                formulas: [Option<usize>; 6],
            },
            $(
                #[doc = concat!("the law of ", stringify!($kind))]
                $kind($law),
            )*
            /// FIELD, BEAM
            Field(Box<Field>),
            /// two solids of a CONTACT, and what they do where they touch
            Contact(Box<ContactForce>),
            /// FRICTION in a joint
            Friction {
                /// its numbers
                law: Box<Friction>,
                /// the joint's number
                joint: u32,
                /// places in x of the creep
                creep: Range<usize>,
            },
            /// one marker of an NFORCE
            Nodal {
                /// its numbers, shared by all its markers
                law: Arc<NodalForce>,
                /// all its I markers
                markers: Arc<[usize]>,
                /// which of them this is
                place: usize,
            },
        }

        impl ForceLaw {
            /// Returns the angles of I in J that the law reads.
            pub fn angles(&self) -> &'static [Measure] {
                match self {
                    $(ForceLaw::$kind(law) => law.angles(),)*
                    ForceLaw::Field(law) => law.angles(),
                    ForceLaw::Nodal { .. } => &ALL_ANGLES,
                    ForceLaw::Single { .. }
                    | ForceLaw::Vector { .. }
                    | ForceLaw::Contact(_)
                    | ForceLaw::Friction { .. } => &[],
                }
            }
        }

        impl ForceElement {
            /// Returns the action on I, in ground axes.
            pub fn action<S: Scalar>(&self, at: &Equations<'_, S>) -> Action<S> {
                let i = at.marker(self.i);
                let j = self.j.map_or_else(MarkerState::ground, |j| at.marker(j));
                let angle = |measure: Measure| at.angle_between(measure, self.i, self.j);
                match &self.law {
                    ForceLaw::Single { idle: true, .. } => Action::zero(),
                    ForceLaw::Single {
                        rotational,
                        action_only,
                        formula,
                        idle: false,
                    } => {
                        let magnitude = at.formula(*formula);
                        action::single_force(*rotational, *action_only, &i, &j, magnitude)
                    }
                    ForceLaw::Vector { rm, formulas } => {
                        let axes = rm.map_or_else(MarkerState::ground, |m| at.marker(m));
                        let c = formulas.map(|f| f.map_or_else(S::zero, |f| at.formula(f)));
                        action::vector_force(&axes, [c[0], c[1], c[2]], [c[3], c[4], c[5]])
                    }
                    $(ForceLaw::$kind(law) => law.action(&i, &j, angle),)*
                    ForceLaw::Field(law) => law.action(&i, &j, angle),
                    ForceLaw::Contact(contact) => {
                        contact.action(at, &i, &j)
                    }
                    ForceLaw::Friction { law, joint, creep } => {
                        let pressing = self.pressing(at, law, *joint);
                        law.slip(&i, &j, &pressing, at.further_states(creep)).action
                    }
                    ForceLaw::Nodal {
                        law,
                        markers,
                        place,
                    } => self.nodal(at, law, markers, *place, false),
                }
            }

            /// Returns the action on I if its markers stood still, in ground axes; `None` where
            /// the law does not say what it stores: functions and friction.
            pub fn action_at_rest<S: Scalar>(&self, at: &Equations<'_, S>) -> Option<Action<S>> {
                let i = at.marker(self.i).stopped();
                let j = self.j.map_or_else(MarkerState::ground, |j| at.marker(j)).stopped();
                let angle = |measure: Measure| at.angle_between(measure, self.i, self.j);
                match &self.law {
                    ForceLaw::Single { .. }
                    | ForceLaw::Vector { .. }
                    | ForceLaw::Friction { .. } => None,
                    $(ForceLaw::$kind(law) => Some(law.action(&i, &j, angle)),)*
                    ForceLaw::Field(law) => Some(law.action(&i, &j, angle)),
                    ForceLaw::Contact(contact) => {
                        contact.stores().then(|| contact.action(at, &i, &j))
                    }
                    ForceLaw::Nodal {
                        law,
                        markers,
                        place,
                    } => Some(self.nodal(at, law, markers, *place, true)),
                }
            }
        }
    };
}
laws_of_two_markers!(force_laws);

impl ForceElement {
    /// Returns how deep the solids of a CONTACT stand in each other; `None`: it is another force,
    /// or they do not touch.
    pub fn depth(&self, at: &Equations<'_, f64>) -> Option<f64> {
        let touches = self.touches(at).into_iter();
        let deepest = touches.map(|touch| touch.depth).max_by(f64::total_cmp);
        deepest.filter(|depth| *depth > 0.0)
    }

    /// Returns the touches of the solids of a CONTACT, those included that do not touch now; none
    /// of another force.
    pub fn touches<S: Scalar>(&self, at: &Equations<'_, S>) -> Vec<Touch<S>> {
        let ForceLaw::Contact(contact) = &self.law else {
            return Vec::new();
        };
        let i = at.marker(self.i);
        let j = self.j.map_or_else(MarkerState::ground, |j| at.marker(j));
        contact.touching.touches(at, &i, &j)
    }
}

impl Touching {
    /// Returns the touches of the solids of I and J.
    pub(super) fn touches<S: Scalar>(
        &self,
        at: &Equations<'_, S>,
        i: &MarkerState<S>,
        j: &MarkerState<S>,
    ) -> Vec<Touch<S>> {
        match self {
            Touching::Formula(pair) => pair.touches(i, j),
            Touching::Query(numbers) => contact::found(at.external(numbers.clone()), i, j),
        }
    }
}

impl ForceElement {
    /// Returns true if it is FRICTION in a joint.
    pub fn is_friction(&self) -> bool {
        matches!(self.law, ForceLaw::Friction { .. })
    }

    /// Returns the action of an NFORCE on one of its markers; `still`: as if none moved.
    fn nodal<S: Scalar>(
        &self,
        at: &Equations<'_, S>,
        law: &NodalForce,
        markers: &[usize],
        place: usize,
        still: bool,
    ) -> Action<S> {
        let seen = |m: MarkerState<S>| if still { m.stopped() } else { m };
        let j = &seen(self.j.map_or_else(MarkerState::ground, |j| at.marker(j)));
        let (mut x, mut rate) = (Vec::new(), Vec::new());
        for &m in markers {
            let angles = ALL_ANGLES.map(|measure| at.angle_between(measure, m, self.j));
            let (displacement, velocity) = bushing::deformation(&seen(at.marker(m)), j, angles);
            x.extend(displacement);
            rate.extend(velocity);
        }
        law.action(place, j, &x, &rate)
    }

    /// The joint's reaction on I as far as friction in it depends on it: unknowns, as it depends on
    /// the friction in turn.
    fn pressing<S: Scalar>(&self, at: &Equations<'_, S>, law: &Friction, joint: u32) -> Action<S> {
        let asker = Asker::Element(self.id);
        let part = |first: u32, needed: bool| {
            Vec3([0, 1, 2].map(|k| {
                if needed {
                    at.measure(Measure::Joint, [joint, 0, first + k, 0], &asker)
                } else {
                    S::zero()
                }
            }))
        };
        let [force, moment] = law.reads();
        Action {
            force: part(2, force),
            torque: part(6, moment),
        }
    }

    /// Returns the slip in the joint, for FRICTION; `None` for other elements.
    pub fn slip<S: Scalar>(&self, at: &Equations<'_, S>) -> Option<Slip<S>> {
        let (ForceLaw::Friction { law, joint, creep }, Some(j)) = (&self.law, self.j) else {
            return None;
        };
        let (i, j) = (at.marker(self.i), at.marker(j));
        let pressing = self.pressing(at, law, *joint);
        Some(law.slip(&i, &j, &pressing, at.further_states(creep)))
    }

    /// Returns the places in x of the states of the element, and their rates.
    pub fn state_rates<S: Scalar>(&self, at: &Equations<'_, S>) -> (Range<usize>, Vec<S>) {
        let (ForceLaw::Friction { law, creep, .. }, Some(j)) = (&self.law, self.j) else {
            return (0..0, Vec::new());
        };
        let (i, j) = (at.marker(self.i), at.marker(j));
        let rates = law.creep_rates(&i, &j, at.further_states(creep));
        (creep.clone(), rates)
    }
}
