//! The configuration: everything that is decided about a scene after it has been compiled.
//!
//! A [`Scene`] never changes. Assembly finds which rows take part, where contacts begin and which
//! constants hold what is shown; a session supplies what earlier simulations left; a system chooses
//! how accelerations are eliminated. All of that stands here, beside the scene, and the equations
//! read both.

use super::{Row, RowKind, Scene};
use crate::physics::joint::Tie;
use crate::physics::row::Law;
use std::ops::Deref;
use std::sync::Arc;

/// IC/ERROR where a dataset has none: twenty times the rounding of six digits, as the errors of
/// several markers add up in a loop; rad, and parts of the size of a loop.
pub const ALIGNMENT: f64 = 1e-4;
/// The largest IC/ERROR that is obeyed: what is off by more is no misalignment.
pub const LARGEST_ALIGNMENT: f64 = 0.01;

/// Decisions about a scene, made by assembly, by sessions and by systems.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Configuration {
    /// True of each row that takes part; a row that depends on others does not. Assembly chooses,
    /// and systems choose again where the rank changes.   (n_rows)
    pub active: Vec<bool>,
    /// Rows that depend on others but for a misalignment within tolerance; none of them takes
    /// part. Chosen before assembly.   (ascending)
    pub loose: Vec<LooseRow>,
    /// The value that each sum of displacements keeps; zero for rows that are no sums. Assembly
    /// adds what the configuration shows where the sum is held.   (n_rows)   [rad, length]
    pub sums: Vec<f64>,
    /// Where motions begin. Assembly fills it.   (n_motions)
    pub motions: Vec<MotionStart>,
    /// Where contacts on curves begin. Assembly follows them.   (n_cams)
    pub contacts: Vec<ContactStart>,
    /// Where counted angles begin. A session carries them on.   (n_turns)
    pub turns: Vec<TurnStart>,
    /// External inputs before the first step. A session supplies them.   (n_external)
    pub external: Vec<f64>,
    /// The way in which accelerations and multipliers are found. A system chooses.
    pub elimination: Elimination,
}

/// A row of a joint that is left out because it would follow from others if axes were aligned
/// exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LooseRow {
    /// its index
    pub row: usize,
    /// Deviation from what follows from the others.   [rad, length]
    pub off: f64,
    /// Largest deviation that is permitted.   [rad, length]
    pub limit: f64,
}

impl LooseRow {
    /// Returns a row of which nothing is measured yet.
    pub fn new(row: usize) -> Self {
        Self {
            row,
            ..Self::default()
        }
    }
}

/// The beginning of a MOTION.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionStart {
    /// Displacement where its state is zero.   [rad, length]
    pub offset: f64,
    /// The state says where it is; assembly has no say any more.
    pub begun: bool,
    /// The displacement at which it stands still in place of following its function.
    pub stands_at: Option<f64>,
    /// The first body angle where it is a body angle between markers.   \[rad\]
    pub reference: f64,
}

/// The beginning of a contact on curves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactStart {
    /// Parameters on its curves where its states are zero; −1 … 1 is a whole curve.
    pub offset: [f64; 2],
    /// States and offset say where it touches; before that the whole curve is searched.
    pub begun: bool,
}

/// The beginning of an angle whose turns are counted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TurnStart {
    /// The angle before the first step.   \[rad\]
    pub angle: f64,
    /// Whole turns between the angle and the sum of coordinates that it is; `None`: the angle is
    /// the value nearest to the one last accepted.   \[rad\]
    pub offset: Option<f64>,
}

/// The order in which freedoms and rows are eliminated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Way {
    /// Freedoms from the entries of the mass matrix, then rows (short chains).
    #[default]
    MassMatrix,
    /// Freedoms link by link, then rows (long chains).
    ArticulatedBodies,
    /// Freedoms link by link, and each row where its loop closes (chains of loops).
    RowsWhereLoopsClose,
}

/// The way in which accelerations and multipliers are found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Elimination {
    /// The order of freedoms and rows.
    pub way: Way,
    /// The order of the active rows among each other; empty: ascending.   (n_active or 0)
    pub order: Vec<usize>,
    /// The usual diagonal of `G M⁻¹ Gᵀ`, by active rows in their order; empty: not known.
    /// (n_active)
    pub usual_pivots: Vec<f64>,
    /// Inertia lent to freedoms that have none, and taken back by
    /// [`accelerations`](super::solve::accelerations); empty: none is lent.
    /// (n_v)   [mass, inertia]
    pub lent_inertia: Vec<f64>,
}

impl Configuration {
    /// Returns the configuration of a scene of which nothing is decided yet: all rows take part,
    /// sums have the constants of the model, nothing has begun.
    pub fn new(scene: &Scene) -> Self {
        let constant = |row: &Row| match &row.kind {
            RowKind::Displacements(sum) => sum.constant,
            RowKind::Markers { .. } | RowKind::Formula { .. } | RowKind::Cam { .. } => 0.0,
        };
        Self {
            active: vec![true; scene.rows.len()],
            loose: Vec::new(),
            sums: scene.rows.iter().map(constant).collect(),
            motions: vec![MotionStart::default(); scene.motions.len()],
            contacts: vec![ContactStart::default(); scene.cams.len()],
            turns: vec![TurnStart::default(); scene.layout.n_turns],
            external: vec![0.0; scene.layout.n_external],
            elimination: Elimination::default(),
        }
    }

    /// Returns the same configuration with motions that stand still at these displacements; a
    /// displacement that is not finite leaves its motion as it is.
    #[must_use]
    pub fn with_motions_at(&self, displacements: &[f64]) -> Self {
        let mut there = self.clone();
        for (motion, &value) in there.motions.iter_mut().zip(displacements) {
            if value.is_finite() {
                motion.stands_at = Some(value);
            }
        }
        there
    }

    /// Returns whether a row is left out as one that depends on others within tolerance.
    pub fn is_loose(&self, row: usize) -> bool {
        self.loose.binary_search_by_key(&row, |l| l.row).is_ok()
    }

    /// Returns the rows that take part, in their order.
    pub fn active_rows(&self) -> impl Iterator<Item = usize> {
        let rows = self.active.iter().enumerate();
        rows.filter(|(_, active)| **active).map(|(r, _)| r)
    }

    /// Returns the rows that take part, in the order of their elimination.
    pub fn rows_in_order(&self) -> Vec<usize> {
        match self.elimination.order.is_empty() {
            true => self.active_rows().collect(),
            false => self.elimination.order.clone(),
        }
    }

    /// Returns the counted angles before the first step   (n_turns)   \[rad\]
    pub fn angles(&self) -> impl Iterator<Item = f64> {
        self.turns.iter().map(|start| start.angle)
    }

    /// Hands what assembly has found for contacts, and for motions that begin where they are, over
    /// to their states `x`.
    pub fn begin_states(&mut self, scene: &Scene, x: &mut [f64]) {
        for (cam, contact) in scene.cams.iter().zip(&mut self.contacts) {
            for k in 0..cam.contact.n_parameters() {
                x[cam.state + k] += contact.offset[k];
            }
            contact.offset = [0.0; 2];
        }
        for (motion, start) in scene.motions.iter().zip(&mut self.motions) {
            if let Some(s) = motion.state {
                x[s] += start.offset;
                start.offset = 0.0;
                start.begun = true;
            }
        }
    }
}

/// A scene in a configuration: everything that equations are written for.
#[derive(Clone, Copy, Debug)]
pub struct Configured<'s> {
    /// the constant part
    pub scene: &'s Scene,
    /// the decided part
    pub configuration: &'s Configuration,
}

impl Deref for Configured<'_> {
    type Target = Scene;

    fn deref(&self) -> &Scene {
        self.scene
    }
}

impl Scene {
    /// Returns the scene in a configuration.
    pub fn within<'s>(&'s self, configuration: &'s Configuration) -> Configured<'s> {
        Configured {
            scene: self,
            configuration,
        }
    }
}

impl Configured<'_> {
    /// Returns a scene in which the rows of constraint element `c` are those of a tie between its
    /// markers, with its configuration, in which all rows take part. `None`: the element has no
    /// markers. Only the rows are those of the other tie: what carries the parts stays as it is.
    pub fn with_tie(&self, c: usize, tie: Tie) -> Option<(Arc<Scene>, Configuration)> {
        let element = &self.scene.constraints[c];
        let (i, j) = element.markers?;
        let (mut scene, mut configuration) = (self.scene.clone(), self.configuration.clone());
        let row = |law: Law| Row {
            element: element.id,
            equation: law.name(),
            kind: RowKind::Markers {
                law,
                i,
                j,
                motion: None,
            },
        };
        let rows: Vec<Row> = tie.rows().iter().copied().map(row).collect();
        let constants = vec![0.0; rows.len()];
        configuration.sums.splice(element.rows.clone(), constants);
        scene.rows.splice(element.rows.clone(), rows);
        configuration.active = vec![true; scene.rows.len()];
        configuration.loose.clear();
        Some((Arc::new(scene), configuration))
    }

    /// Returns whether a motion begins where the configuration is, and has not begun.
    pub fn waits(&self, motion: usize) -> bool {
        self.scene.motions[motion].held && !self.configuration.motions[motion].begun
    }

    /// Returns whether a row takes what the configuration shows rather than asking anything of it,
    /// as equations of velocities do.
    pub fn is_held(&self, r: usize) -> bool {
        match &self.scene.rows[r].kind {
            RowKind::Displacements(sum) => sum.held,
            RowKind::Markers {
                motion: Some(m), ..
            } => self.waits(*m),
            RowKind::Formula { of_velocities, .. } => *of_velocities,
            RowKind::Markers { motion: None, .. } | RowKind::Cam { .. } => false,
        }
    }
}
