//! What could be changed so that nothing is fixed twice: for each element with superfluous rows the weaker element that keeps the rest.
//!
//! A candidate is tried, not guessed: with its rows in place of those of the element the rank must stay what it is, nothing of it may depend on the
//! rest, and it must hold here and at a position nearby.

use super::numbers_at;
use crate::analysis::start::assemble::{self, Assembly};
use crate::model::{JointKind, PrimitiveKind};
use crate::physics::joint::Tie;
use crate::scene::equations::Equations;
use crate::scene::{Row, RowKind, Scene};
use std::collections::BTreeMap;
use std::fmt;

/// What an element may be weakened to, most usual first.
const CANDIDATES: [Tie; 12] = [
    Tie::Joint(JointKind::Spherical),
    Tie::Joint(JointKind::Cylindrical),
    Tie::Joint(JointKind::Revolute),
    Tie::Joint(JointKind::Planar),
    Tie::Joint(JointKind::Universal),
    Tie::Joint(JointKind::Hooke),
    Tie::Joint(JointKind::Translational),
    Tie::Primitive(PrimitiveKind::Inline),
    Tie::Primitive(PrimitiveKind::Inplane),
    Tie::Primitive(PrimitiveKind::ParallelAxes),
    Tie::Primitive(PrimitiveKind::Perpendicular),
    Tie::Primitive(PrimitiveKind::Orientation),
];

/// A change of an element after which it fixes nothing twice, and the motion is the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    /// "JOINT/4"
    pub element: String,
    /// what to do with it
    pub change: Change,
}

/// What to do with an element that has superfluous rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// all of its rows follow from others
    Remove,
    /// this weaker tie between the same markers keeps what is needed
    Replace(Tie),
    /// no tie has just the equations that are needed
    Weaken {
        /// equations that are needed
        kept: usize,
        /// equations that it has
        of: usize,
    },
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = &self.element;
        match self.change {
            Change::Remove => {
                write!(f, "{name} is not needed: without it the motion is the same")
            }
            Change::Replace(Tie::Joint(kind)) => {
                let kind = format!("{kind:?}").to_uppercase();
                write!(
                    f,
                    "{name} as {kind} with the same markers permits the same motion and fixes nothing twice"
                )
            }
            Change::Replace(Tie::Primitive(kind)) => {
                let kind = super::words::primitive(kind);
                write!(
                    f,
                    "JPRIM {kind} with the markers of {name} in its place permits the same motion and fixes nothing twice"
                )
            }
            Change::Weaken { kept, of } => {
                write!(f, "{name} could do with {kept} of its {of} equations")
            }
        }
    }
}

/// Finds advice for each element with rows that depend on others wherever one looks.
pub(super) fn advice(scene: &Scene, numbers: &[f64], assembly: &Assembly) -> Vec<Advice> {
    let mut of: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for r in assembly.redundant.iter().map(|r| r.row) {
        if let Some(c) = scene.constraints.iter().position(|c| c.rows.contains(&r)) {
            of.entry(c).or_default().push(r);
        }
    }
    of.into_iter()
        .map(|(c, superfluous)| {
            let element = &scene.constraints[c];
            let kept = element.rows.len() - superfluous.len();
            let better = CANDIDATES
                .into_iter()
                .filter(|tie| kept > 0 && tie.rows().len() == kept)
                .find(|tie| fits(scene, numbers, assembly, c, *tie));
            let change = match better {
                _ if kept == 0 => Change::Remove,
                Some(tie) => Change::Replace(tie),
                None => Change::Weaken {
                    kept,
                    of: element.rows.len(),
                },
            };
            Advice {
                element: format!("{}/{}", element.keyword, element.id),
                change,
            }
        })
        .collect()
}

/// Whether a tie can stand in the place of an element.
fn fits(scene: &Scene, numbers: &[f64], assembly: &Assembly, c: usize, tie: Tie) -> bool {
    let element = &scene.constraints[c];
    let Some((i, j)) = element.markers else {
        return false;
    };
    let mut changed = scene.clone();
    let rows: Vec<Row> = tie
        .rows()
        .into_iter()
        .map(|law| Row {
            element: String::new(),
            equation: law.name(),
            kind: RowKind::Markers {
                law,
                i,
                j,
                motion: None,
            },
        })
        .collect();
    let own = element.rows.start..element.rows.start + rows.len();
    changed.rows.splice(element.rows.clone(), rows);
    changed.active.clear();
    let target = scene.layout.n_v - assembly.freedom;
    let holds = |scene: &Scene, numbers: &[f64]| {
        let at = Equations::new(scene, numbers);
        own.clone().all(|r| {
            let one = match &scene.rows[r].kind {
                RowKind::Markers { law, .. } if law.is_length() => scene.length,
                _ => 1.0,
            };
            at.row(r).value.abs() < 1e-8 * one
        })
    };
    let ranked = |scene: &Scene, numbers: &[f64]| {
        let l = scene.layout;
        let (_, gradient, _) =
            assemble::rows_at(scene, numbers[0], &numbers[l.q()], &numbers[l.x()]);
        let (independent, dependent) = assemble::rank(scene, &gradient, &[]);
        independent.len() == target && !dependent.iter().any(|d| own.contains(&d.row))
    };
    match &assembly.place {
        Some(place) => {
            let (there, far) = numbers_at(&changed, place);
            holds(&changed, numbers) && holds(&there, &far) && ranked(&there, &far)
        }
        None => holds(&changed, numbers) && ranked(&changed, numbers),
    }
}
