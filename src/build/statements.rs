//! Words of the builder for the usual statements; [`ModelBuilder::element`] and
//! [`ModelBuilder::settings`] reach all others.

use super::{Body, Element, End, Frame, ModelBuilder};
use crate::model::{ElementKind, JointKind};

/// Joints by their names: a method each.
macro_rules! joints {
    ($($(#[$doc:meta])* $name:ident $kind:ident;)+) => { $(
        $(#[$doc])*
        ///
        /// See [`joint`](Self::joint).
        pub fn $name(
            &self,
            name: &str,
            i: impl Into<End>,
            j: impl Into<End>,
        ) -> Element<'_> {
            self.joint(JointKind::$kind, name, i, j)
        }
    )+ };
}

impl ModelBuilder {
    /// Tells the units of all numbers: `MKS`, `MMKS`, `CGS`, `FPS`, `IPS`. Results name them.
    pub fn units(&self, system: &str) -> &Self {
        self.settings("UNITS").set("SYSTEM", system);
        self
    }

    /// Sets the acceleration of gravity along ground x, y, z.
    pub fn gravity(&self, g: [f64; 3]) -> &Self {
        let settings = self.settings("ACCGRAV");
        let [x, y, z] = g;
        settings.set("IGRAV", x).set("JGRAV", y).set("KGRAV", z);
        self
    }

    /// Returns the part that does not move, PART/1.
    pub fn ground(&self) -> Element<'_, Body> {
        Element::new(self, 0)
    }

    /// Adds a rigid body, whose frame is that of ground until [`origin`](Element::origin) moves it.
    pub fn part(&self, name: &str) -> Element<'_, Body> {
        let part = self.element(ElementKind::Part, name);
        Element::new(self, part.draft)
    }

    /// Adds a body without extent, which does not turn.
    pub fn point_mass(&self, name: &str) -> Element<'_, Body> {
        let body = self.element(ElementKind::PointMass, name);
        Element::new(self, body.draft)
    }

    /// Adds a marker whose arguments (QP, REULER, …) are given in the frame of its part;
    /// [`at`](Element::at) makes one at a place in ground.
    pub fn marker(&self, name: &str, part: &Element<'_, Body>) -> Element<'_, Frame> {
        let marker = self.element(ElementKind::Marker, name);
        let owner = part.kind().unwrap_or(ElementKind::Part);
        marker.set(owner.keyword(), part);
        Element::new(self, marker.draft)
    }

    /// Adds a joint between two markers, I and J; where one end is a body, it gets a marker where
    /// the other end is. The axis of rotation or translation is z of the markers.
    pub fn joint(
        &self,
        kind: JointKind,
        name: &str,
        i: impl Into<End>,
        j: impl Into<End>,
    ) -> Element<'_> {
        let joint = self.between(ElementKind::Joint, name, i, j);
        joint.flag(kind.row().word)
    }

    joints! {
        /// Adds a hinge: rotation about z.
        revolute Revolute;
        /// Adds a slider: translation along z.
        translational Translational;
        /// Adds a joint that turns about z and slides along it.
        cylindrical Cylindrical;
        /// Adds a ball joint: all rotations.
        spherical Spherical;
        /// Adds a joint without freedom.
        fixed Fixed;
    }

    /// Adds a motion of a joint, as an expression of time: an angle in radians of a joint that
    /// turns, else a length. Its arguments say otherwise: `flag("VELOCITY")`.
    pub fn motion(&self, name: &str, joint: &Element<'_>, expression: &str) -> Element<'_> {
        let motion = self.element(ElementKind::Motion, name).set("JOINT", joint);
        motion.function(expression)
    }

    /// Adds a force along the line between two markers (SFORCE), to be given a
    /// [`function`](Element::function) or a [`law`](Element::law): positive pushes them apart.
    pub fn force(&self, name: &str, i: impl Into<End>, j: impl Into<End>) -> Element<'_> {
        let force = self.between(ElementKind::Sforce, name, i, j);
        force.flag("TRANSLATIONAL")
    }

    /// Adds a torque about the z axis of J (SFORCE), to be given a [`function`](Element::function)
    /// or a [`law`](Element::law): positive turns I forward.
    pub fn torque(&self, name: &str, i: impl Into<End>, j: impl Into<End>) -> Element<'_> {
        let torque = self.between(ElementKind::Sforce, name, i, j);
        torque.flag("ROTATIONAL")
    }

    /// Adds a spring with a damper along the line between two markers, to be given `K`, `C` and
    /// `LENGTH`.
    pub fn spring(&self, name: &str, i: impl Into<End>, j: impl Into<End>) -> Element<'_> {
        let spring = self.between(ElementKind::SpringDamper, name, i, j);
        spring.flag("TRANSLATIONAL")
    }

    /// Adds an algebraic variable: `VARVAL` of it in other expressions.
    pub fn variable(&self, name: &str, expression: &str) -> Element<'_> {
        let variable = self.element(ElementKind::Variable, name);
        variable.function(expression)
    }

    /// Adds any element with arguments I and J: joints, primitives, forces, bushings, beams.
    pub fn between(
        &self,
        kind: ElementKind,
        name: &str,
        i: impl Into<End>,
        j: impl Into<End>,
    ) -> Element<'_> {
        let [i, j] = self.markers(name, i.into(), j.into());
        self.element(kind, name).set("I", i).set("J", j)
    }
}
