//! Initial values that no statement of a dataset has: of all variables of a joint, and of the place
//! and the motion of a marker. In datasets a comment line gives them (`dataset/extension.rs`).

use super::{ElementId, ElementKind, JointKind, Model};
use std::collections::BTreeMap;

/// A quantity that has an initial value. Lengths in model units, angles in rad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum InitialQuantity {
    /// a variable of a joint, by its place in the row of the table of joints; of a ball the angle
    /// between the axes x, y or z of its markers
    Variable(usize),
    /// the rate of a variable of a joint
    VariableRate(usize),
    /// of a marker in ground: 0 x, 1 y, 2 z, 3 ψ, 4 θ, 5 φ
    Place(usize),
    /// of a marker, along the axes of ground: velocity of its origin 0 x, 1 y, 2 z, angular
    /// velocity 3 x, 4 y, 5 z
    Rate(usize),
}

impl InitialQuantity {
    /// Returns whether it is a velocity, and no place.
    pub fn is_rate(self) -> bool {
        match self {
            Self::VariableRate(_) | Self::Rate(_) => true,
            Self::Variable(_) | Self::Place(_) => false,
        }
    }
}

/// Initial values of an element, each quantity once.
pub type Beginning = BTreeMap<InitialQuantity, f64>;

/// Names of the place of a marker.
const PLACES: [&str; 6] = ["X", "Y", "Z", "PSI", "THETA", "PHI"];
/// Names of the motion of a marker.
const RATES: [&str; 6] = ["VX", "VY", "VZ", "WX", "WY", "WZ"];
/// Names of the variables of joints, and of their rates.
const VARIABLE_RATES: [(&str, &str); 6] = [
    ("DISTANCE", "DISTANCE_RATE"),
    ("X", "X_RATE"),
    ("Y", "Y_RATE"),
    ("ANGLE", "ANGLE_RATE"),
    ("ANGLE_1", "ANGLE_1_RATE"),
    ("ANGLE_2", "ANGLE_2_RATE"),
];

/// Names of the angles between the axes of a ball's markers.
pub const BALL: [&str; 3] = ["X", "Y", "Z"];

/// Returns the quantities of a kind of element with their names; `joint`: the kind of the joint.
fn quantities(kind: ElementKind, joint: Option<JointKind>) -> Vec<(&'static str, InitialQuantity)> {
    if kind == ElementKind::Marker {
        let places = PLACES.into_iter().zip((0..).map(InitialQuantity::Place));
        let rates = RATES.into_iter().zip((0..).map(InitialQuantity::Rate));
        return places.chain(rates).collect();
    }
    if joint.is_some_and(JointKind::is_ball) {
        let angles = BALL.into_iter().zip((0..).map(InitialQuantity::Variable));
        return angles.collect();
    }
    let variables = joint.map_or(&[][..], |kind| kind.row().variables);
    let named = variables.iter().enumerate().flat_map(|(k, (name, _))| {
        let rate = VARIABLE_RATES.iter().find(|(of, _)| of == name);
        let rate = rate.map(|(_, rate)| (*rate, InitialQuantity::VariableRate(k)));
        [Some((*name, InitialQuantity::Variable(k))), rate]
    });
    named.flatten().collect()
}

impl Model {
    /// Returns the quantities of an element that can have initial values, with their names; none of
    /// elements other than joints and markers.
    pub fn initial_quantities(&self, id: ElementId) -> Vec<(&'static str, InitialQuantity)> {
        match id.kind {
            ElementKind::Joint => {
                let joint = self.joints.get(&id.number).map(|j| j.kind);
                quantities(id.kind, joint)
            }
            ElementKind::Marker => quantities(id.kind, None),
            _ => Vec::new(),
        }
    }

    /// Returns the name of a quantity of an element; empty where it has none.
    pub fn initial_quantity_name(&self, id: ElementId, quantity: InitialQuantity) -> &'static str {
        let all = self.initial_quantities(id);
        let found = all.iter().find(|(_, q)| *q == quantity);
        found.map_or("", |(name, _)| name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_variable_of_every_joint_but_a_ball_has_a_rate() {
        for kind in JointKind::ALL {
            let all = quantities(ElementKind::Joint, Some(kind));
            let n_variables = kind.row().variables.len();
            let expected = if kind.is_ball() { 3 } else { 2 * n_variables };
            assert_eq!(all.len(), expected, "{kind:?}");
        }
    }
}
