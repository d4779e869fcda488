//! Advice for constraints that fix something twice: for each element with superfluous rows the
//! weaker element that keeps the rest.
//!
//! A candidate is tried, not guessed: with its rows in place of those of the element the rank must
//! stay what it is, nothing of it may depend on the rest, and it must hold here and at a position
//! nearby.

use super::numbers_at;
use crate::analysis::start::assemble::{self, Assembly};
use crate::model::{ElementId, JointKind, PrimitiveKind};
use crate::physics::joint::Tie;
use crate::scene::configuration::{Configuration, Configured};
use crate::scene::equations::Equations;
use crate::scene::layout::Layout;
use std::collections::BTreeMap;
use std::fmt;

/// Ties that an element may be weakened to, most usual first.
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
    /// the constraint
    pub element: ElementId,
    /// what to do with it
    pub change: Change,
}

/// Advice for an element that has superfluous rows.
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

impl Advice {
    /// Returns it as a sentence; `called` names the element.
    pub fn sentence(&self, called: &dyn Fn(ElementId) -> String) -> String {
        let name = called(self.element);
        match self.change {
            Change::Remove => {
                format!("{name} is not needed: without it the motion is the same")
            }
            Change::Replace(Tie::Joint(kind)) => {
                let kind = kind.keyword();
                format!(
                    "{name} as {kind} with the same markers permits the same motion and fixes nothing twice"
                )
            }
            Change::Replace(Tie::Primitive(kind)) => {
                let kind = kind.row().keyword;
                format!(
                    "JPRIM {kind} with the markers of {name} in its place permits the same motion and fixes nothing twice"
                )
            }
            Change::Weaken { kept, of } => {
                format!("{name} could do with {kept} of its {of} equations")
            }
        }
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence(&|id| id.to_string()))
    }
}

/// Finds advice for each element with rows that depend on others wherever one looks.
pub(super) fn advice(scene: Configured<'_>, numbers: &[f64], assembly: &Assembly) -> Vec<Advice> {
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
                element: element.id,
                change,
            }
        })
        .collect()
}

/// Returns whether a tie can stand in the place of an element.
fn fits(scene: Configured<'_>, numbers: &[f64], assembly: &Assembly, c: usize, tie: Tie) -> bool {
    let element = &scene.constraints[c];
    let Some((changed, configuration)) = scene.with_tie(c, tie) else {
        return false;
    };
    let own = element.rows.start..element.rows.start + tie.rows().len();
    let target = scene.layout.n_v - assembly.freedom;
    let holds = |configuration: &Configuration, numbers: &[f64]| {
        let at = Equations::new(changed.within(configuration), numbers);
        (own.clone()).all(|r| at.row(r).value.abs() < 1e-8 * changed.row_scale(r))
    };
    let ranked = |configuration: &Configuration, numbers: &[f64]| {
        let l = changed.layout;
        let (_, gradient) = assemble::rows_at_rest(
            changed.within(configuration),
            numbers[Layout::TIME],
            &numbers[l.q()],
            &numbers[l.x()],
        );
        let (independent, dependent) = assemble::rank(&changed, &gradient, &[]);
        independent.len() == target && !dependent.iter().any(|d| own.contains(&d.row))
    };
    match &assembly.place {
        Some(place) => {
            let (there, far) = numbers_at(changed.within(&configuration), place);
            holds(&configuration, numbers) && holds(&there, &far) && ranked(&there, &far)
        }
        None => holds(&configuration, numbers) && ranked(&configuration, numbers),
    }
}
