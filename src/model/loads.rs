//! Numbers that say how strongly a model is loaded and how it resists, but not where its parts are:
//! masses, springs and gravity.
//!
//! No rule about places and no constraint reads them beyond their signs. So models that differ in
//! these numbers alone are right or wrong together, and are assembled in the same place with the
//! same velocities.

use super::{Model, SpringDamper};

impl Model {
    /// The numbers of its loads, always in the same order.
    fn loads_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        let bodies = self
            .parts
            .values_mut()
            .chain(self.point_masses.values_mut());
        let of_spring = |s| {
            let SpringDamper {
                stiffness,
                damping,
                preload,
                free,
                ..
            }: &mut SpringDamper = s;
            [stiffness, damping, preload, free]
        };
        let springs = self.spring_dampers.values_mut().flat_map(of_spring);
        let masses = bodies.map(|body| &mut body.mass);
        masses.chain(springs).chain(&mut self.gravity)
    }

    /// Returns the numbers of its loads.
    pub(crate) fn loads(&mut self) -> Vec<f64> {
        self.loads_mut().map(|x| *x).collect()
    }

    /// Returns whether it differs from another model, whose loads are told, by nothing but numbers
    /// of loads, each of the sign that it has there.
    pub(crate) fn differs_in_loads_alone(&mut self, other: &Model, loads: &[f64]) -> bool {
        let own = self.loads();
        let mut pairs = own.iter().zip(loads);
        if own.len() != loads.len() || !pairs.all(|(&a, &b)| is_of_the_same_kind(a, b)) {
            return false;
        }
        self.loads_mut().zip(loads).for_each(|(x, &load)| *x = load);
        let same = self == other;
        self.loads_mut().zip(own).for_each(|(x, load)| *x = load);
        same
    }
}

/// Returns whether both are the same number, or plain numbers of the same sign.
fn is_of_the_same_kind(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits()
        || a.is_normal() && b.is_normal() && a.is_sign_negative() == b.is_sign_negative()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model() -> Model {
        let text = "two bodies\nPART/1, GROUND\nPART/2, MASS=2, CM=20, IP=1,1,1\nMARKER/20, PART=2\n\
            MARKER/3, PART=1, QP=0,1,0\nSPRINGDAMPER/1, TRANSLATION, I=20, J=3, K=10, C=0, L=0.5\n\
            ACCGRAV/JGRAV=-9.81\nEND\n";
        Model::from_text(text).unwrap()
    }

    #[test]
    fn loads_of_another_sign_and_all_other_numbers_make_another_model() {
        let mut given = model();
        let loads = given.loads();
        let alike = |change: &dyn Fn(&mut Model)| {
            let mut other = model();
            change(&mut other);
            let before = other.clone();
            let alike = other.differs_in_loads_alone(&given, &loads);
            assert_eq!(other, before);
            alike
        };
        assert!(alike(&|_| ()));
        assert!(alike(&|m| m.parts.entry(2).or_default().mass = 3.0));
        assert!(alike(&|m| m.gravity = [0.0, -1.0, 0.0]));
        assert!(alike(&|m| m
            .spring_dampers
            .entry(1)
            .or_default()
            .stiffness = 1e9));
        assert!(!alike(&|m| m.parts.entry(2).or_default().mass = 0.0));
        assert!(!alike(&|m| m.parts.entry(2).or_default().mass = -2.0));
        assert!(!alike(
            &|m| m.parts.entry(2).or_default().mass = f64::INFINITY
        ));
        assert!(!alike(&|m| m.parts.entry(2).or_default().ip[0] = 2.0));
        assert!(!alike(&|m| m.gravity = [0.0, 9.81, 0.0]));
        assert!(!alike(&|m| m
            .spring_dampers
            .entry(1)
            .or_default()
            .damping = 1.0));
        assert!(!alike(&|m| m.markers.entry(3).or_default().qp[0] = 1.0));
        assert!(!alike(&|m| {
            m.parts.insert(7, Default::default());
        }));
    }
}
