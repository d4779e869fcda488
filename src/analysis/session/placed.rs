//! A place that is kept: where a model was assembled, for models that differ from it in their loads
//! alone.
//!
//! Masses, springs and gravity have no say in where parts are put: constraints read places and time
//! alone. So what a dataset with other loads would be assembled to is known, to the last bit; what
//! forces say about the place is asked anew. How fast parts move at first is known, too, where
//! masses have no say in it or are the same.

use super::Session;
use super::state_at_start::Start;
use crate::analysis::start::assemble::Assembly;
use crate::analysis::start::velocities::Beginning;
use crate::analysis::warning::Warning;
use crate::model::Model;
use crate::scene::Scene;
use crate::scene::configuration::Configuration;
use crate::space::Frame;
use std::sync::Arc;

/// The scene and the numbers that assembly begins with.
#[derive(Clone, Debug)]
pub(super) struct Drawn {
    scene: Arc<Scene>,
    configuration: Configuration,
    t: f64,
    q: Vec<f64>,
    x: Vec<f64>,
}

/// The outcome of assembly, before it is asked what forces do there.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub configuration: Configuration,
    pub q: Vec<f64>,
    pub assembly: Assembly,
}

/// Velocities to start with, and the warnings of those that are not met.
pub(super) type Velocities = (Beginning, Vec<Warning>);

/// A model that was assembled, and its place.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    /// without the constants that are external inputs
    model: Arc<Model>,
    loads: Vec<f64>,
    drawn: Drawn,
    found: Found,
    velocities: Velocities,
}

/// An assembly, and what it began and ended with where it has been done anew.
pub(super) type Assembled = (Assembly, Option<(Drawn, Found)>);

impl Drawn {
    /// Copies what assembly begins with.
    pub fn of(start: &Start) -> Self {
        Self {
            scene: Arc::clone(&start.scene),
            configuration: start.configuration.clone(),
            t: start.t,
            q: start.q.clone(),
            x: start.x.clone(),
        }
    }

    /// Returns whether a start begins with the same, to the last bit.
    fn is(&self, start: &Start) -> bool {
        let scene = [&self.scene, &start.scene];
        self.t.to_bits() == start.t.to_bits()
            && self.configuration == start.configuration
            && are_same(&self.q, &start.q)
            && are_same(&self.x, &start.x)
            && scene[0].layout == scene[1].layout
            && scene[0].length.to_bits() == scene[1].length.to_bits()
            && are_placed_alike(scene[0], scene[1])
    }
}

fn are_same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

/// Returns whether parts, markers and links sit where they do in another scene.
fn are_placed_alike(a: &Scene, b: &Scene) -> bool {
    let counts = |s: &Scene| [s.links.len(), s.parts.len(), s.markers.len()];
    let same = |(a, b): (&Frame<f64>, &Frame<f64>)| {
        are_same(&a.position.0, &b.position.0)
            && are_same(a.rotation.0.as_flattened(), b.rotation.0.as_flattened())
    };
    counts(a) == counts(b) && frames(a).zip(frames(b)).all(same)
}

/// Returns whether links have the masses and inertias that they have in another scene.
fn are_as_heavy(a: &Scene, b: &Scene) -> bool {
    a.links.iter().zip(&b.links).all(|(a, b)| {
        a.mass.to_bits() == b.mass.to_bits()
            && are_same(&a.moment.0, &b.moment.0)
            && are_same(a.inertia.0.as_flattened(), b.inertia.0.as_flattened())
    })
}

fn frames(scene: &Scene) -> impl Iterator<Item = &Frame<f64>> {
    let links = scene.links.iter().map(|l| &l.placement);
    let parts = scene.parts.iter().flat_map(|p| [&p.frame, &p.initial]);
    links
        .chain(parts)
        .chain(scene.markers.iter().map(|m| &m.frame))
}

impl Placed {
    /// Puts a start where its model was assembled, where it begins with the same; returns what was
    /// found there.
    pub fn put(&self, start: &mut Start) -> Option<Assembly> {
        if !self.drawn.is(start) {
            return None;
        }
        start.configuration.clone_from(&self.found.configuration);
        start.q.clone_from(&self.found.q);
        Some(self.found.assembly.clone())
    }

    /// Returns the velocities of that place; `None`: they depend on masses, and those of `scene`
    /// are others.
    pub fn velocities(&self, scene: &Scene) -> Option<Velocities> {
        let is_known = !self.velocities.0.is_weighed || are_as_heavy(&self.drawn.scene, scene);
        is_known.then(|| self.velocities.clone())
    }
}

impl Session {
    /// Returns whether the place of the present model is kept: at the start of sessions that go
    /// back to it.
    pub(super) fn keeps_place(&self, inputs: &[u32]) -> bool {
        let begins = self.carried.is_none() && inputs.is_empty() && self.hooks.is_empty();
        begins && self.options.keep_start
    }

    /// Keeps where the present model was assembled, with which velocities.
    pub(super) fn keep_place(&mut self, mode: u32, found: (Drawn, Found), velocities: Velocities) {
        let (drawn, found) = found;
        let model = self.made_of(&drawn.scene);
        self.kept_model = Some(Arc::clone(&model));
        let placed = Placed {
            loads: self.model.loads(),
            model,
            drawn,
            found,
            velocities,
        };
        self.starts.placed.insert(mode, Arc::new(placed));
    }

    /// Returns the place of a start whose model differs from the present one in its loads alone.
    pub(super) fn placed_before(&mut self, mode: u32, inputs: &[u32]) -> Option<Arc<Placed>> {
        let placed = Arc::clone(self.starts.placed.get(&mode)?);
        let alike = self.keeps_place(inputs)
            && super::kept::without_constants(&mut self.model, &placed.drawn.scene, |model| {
                model.differs_in_loads_alone(&placed.model, &placed.loads)
            });
        alike.then_some(placed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::session::{Analysis, DYNAMIC, Options};

    const PENDULUM: &str = "pendulum\nPART/1, GROUND\nMARKER/1, PART=1\n\
        PART/2, MASS=2, CM=20, IP=0.1,0.1,0.1, WZ=0.3\nMARKER/20, PART=2, QP=1,0,0\nMARKER/21, PART=2\n\
        JOINT/1, REVOLUTE, I=21, J=1\nMARKER/3, PART=1, QP=0,1,0\n\
        SPRINGDAMPER/1, TRANSLATION, I=20, J=3, K=10, C=0.1, L=0.5\nACCGRAV/JGRAV=-9.81\nEND\n";

    #[test]
    fn other_loads_keep_the_place_and_all_else_makes_another() {
        let options = Options {
            keep_start: true,
            ..Options::default()
        };
        let model = Model::from_text(PENDULUM).unwrap();
        let mut session = Session::new(model, "kept", options);
        let mut stays = |change: &dyn Fn(&mut Model)| {
            let before = session.starts.placed.get(&DYNAMIC).cloned();
            session.reset();
            change(&mut session.model);
            let done = session.run_to(Analysis::Dynamic, 0.01, 1);
            let after = session.starts.placed.get(&DYNAMIC).cloned();
            let stays = before.zip(after).is_some_and(|(a, b)| Arc::ptr_eq(&a, &b));
            stays && done.is_ok()
        };
        assert!(!stays(&|_| ()));
        assert!(stays(&|m| m.parts.entry(2).or_default().mass = 3.0));
        assert!(stays(&|m| m.gravity = [0.0, -1.6, 0.0]));
        assert!(stays(&|m| m
            .spring_dampers
            .entry(1)
            .or_default()
            .stiffness = 7.0));
        assert!(!stays(&|m| m.markers.entry(20).or_default().qp[1] = 0.1));
        assert!(stays(&|m| m.parts.entry(2).or_default().mass = 1.0));
        assert!(!stays(&|m| m
            .parts
            .entry(2)
            .or_default()
            .angular_velocity = [None; 3]));
        assert!(!stays(&|m| m.parts.entry(2).or_default().mass = 0.0));
    }

    #[test]
    fn a_zero_of_the_other_sign_is_another_place() {
        assert!(are_same(&[0.0, 1.0], &[0.0, 1.0]));
        assert!(!are_same(&[0.0, 1.0], &[-0.0, 1.0]));
        assert!(!are_same(&[0.0], &[0.0, 1.0]));
    }
}
