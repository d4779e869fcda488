//! Rows of a configuration: those that take part are kept by projection, those that are left out
//! are watched.
//!
//! Rows that close loops hold at acceleration level within a step. What is left of them in position
//! and velocity is taken away after each accepted step, by the least changes.

use super::recording::Recording;
use crate::expr::program::{Program, Sym};
use crate::numeric::control::worst;
use crate::scalar::Scalar;
use crate::scene::Scene;
use crate::scene::cams::Cam;
use crate::scene::configuration::Configured;
use crate::scene::equations::{STATIC, Unsupported};
use crate::scene::programs;
use crate::scene::recorder::Recorder;

/// Violation of a row, relative to what counts as one, that is rounding.
pub(super) const ROUNDING: f64 = 1e-14;

/// The rows of a configuration.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    /// least changes onto the rows: Δq as a tangent, Δv, those of contacts on curves
    /// (2 n_v + n_contacts); `None`: no row takes part
    pub projection: Option<Recording>,
    /// violation of each row and its rate, relative to what counts as one   (2 n_active)
    violation: Option<Recording>,
    /// rows that are left out and may not follow from the others wherever the mechanism goes, and
    /// their values   (n_left_out)
    left_out: Option<(Vec<usize>, Recording)>,
    /// values of all rows   (n_rows)
    pub(super) values: Program,
    /// gradients of the rows that take part
    pub(super) gradients: RowGradients,
    /// what multiplies each velocity where velocities are compared   (n_v)
    pub(super) scales: Vec<f64>,
    /// places in x of contacts on curves   (n_contacts)
    pub contacts: Vec<usize>,
    /// some rows that take part are equations of velocities, which may not be linear: a projection
    /// has converged when velocities have, too
    pub of_velocities: bool,
    /// the last state that was to be projected was on the rows
    pub clean: bool,
    /// largest change of a position in the last iteration of a projection, made after velocities
    /// were corrected
    pub last_change: f64,
    /// rows have nearly been dependent since they were chosen
    pub were_weak: bool,
}

impl Rows {
    /// Records what keeps and watches the rows of a scene.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub fn new(recorder: &Recorder<'_, '_>) -> Result<Self, Vec<Unsupported>> {
        let scene = recorder.scene();
        let weights = programs::weights(&scene);
        let left_out = left_out_program(recorder)?;
        Ok(Self {
            projection: projection_program(recorder)?.map(Recording::new),
            violation: violation_program(recorder)?.map(Recording::new),
            left_out: left_out.map(|(rows, program)| (rows, Recording::new(program))),
            values: values_program(recorder)?,
            gradients: RowGradients::new(recorder)?,
            scales: weights.iter().map(|w| w.sqrt().recip()).collect(),
            contacts: contact_states(&scene),
            of_velocities: (scene.configuration.active_rows())
                .any(|r| scene.rows[r].is_of_velocities()),
            clean: false,
            last_change: 0.0,
            were_weak: false,
        })
    }

    /// Tells that so many states are brought onto the rows, those that are left out too.
    pub fn expect_projections(&self, n: usize) {
        let left_out = self.left_out.iter().map(|(_, recording)| recording);
        for recording in self.projection.iter().chain(left_out) {
            recording.program.expect_runs(n);
        }
    }

    /// Returns the largest violation of a row at some numbers with velocities `v`, in position or
    /// velocity, relative to what counts as one and to how fast the mechanism moves.
    pub fn worst_violation(&mut self, numbers: &[f64], v: &[f64]) -> f64 {
        let Some(violation) = &mut self.violation else {
            return 0.0;
        };
        let violations = violation.run(numbers);
        let speeds = v.iter().zip(&self.scales).map(|(v, s)| v.abs() * s);
        let slow = 1.0 / speeds.fold(1.0, f64::max);
        let pairs = violations.chunks_exact(2);
        worst(pairs.flat_map(|p| [p[0], p[1] * slow]))
    }

    /// Returns the largest violation of a row in position at some numbers, relative to what counts
    /// as one.
    pub fn worst_gap(&mut self, numbers: &[f64]) -> f64 {
        let Some(violation) = &mut self.violation else {
            return 0.0;
        };
        worst(violation.run(numbers).chunks_exact(2).map(|p| p[0]))
    }

    /// Returns the row among those that take part that is violated most in position at some
    /// numbers, and by how much, relative to what counts as one.
    pub fn worst_kept(&mut self, scene: Configured<'_>, numbers: &[f64]) -> Option<(usize, f64)> {
        let gaps = self.violation.as_mut()?.run(numbers).chunks_exact(2);
        let gaps = gaps.map(|p| p[0].abs());
        let rows = scene.configuration.active_rows().zip(gaps);
        rows.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Returns whether rows that are left out say something that changes.
    pub fn has_left_out(&self) -> bool {
        self.left_out.is_some()
    }

    /// Returns the row among those left out that is violated most at some numbers, and by how much,
    /// relative to what counts as one; but for those that are left out within tolerance.
    pub fn worst_left_out(
        &mut self,
        scene: Configured<'_>,
        numbers: &[f64],
    ) -> Option<(usize, f64)> {
        let (rows, recording) = self.left_out.as_mut()?;
        let values = recording.run(numbers);
        rows.iter()
            .zip(values)
            .filter(|(r, _)| !scene.configuration.is_loose(**r))
            .map(|(&r, &value)| (r, (value / scene.row_scale(r)).abs()))
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Returns the row among those left out within tolerance that is farthest beyond its limit at
    /// some numbers, and its value; `None`: none is.
    pub fn worst_loose(&mut self, scene: Configured<'_>, numbers: &[f64]) -> Option<(usize, f64)> {
        let loose = &scene.configuration.loose;
        if loose.is_empty() {
            return None;
        }
        let (rows, recording) = self.left_out.as_mut()?;
        let values = recording.run(numbers);
        let off = |(&r, &value): (&usize, &f64)| {
            let k = loose.binary_search_by_key(&r, |l| l.row).ok()?;
            Some((r, value, (value / loose[k].limit).abs()))
        };
        let all = rows.iter().zip(values).filter_map(off);
        let worst = all.max_by(|a, b| a.2.total_cmp(&b.2))?;
        (worst.2 > 1.0 || worst.2.is_nan()).then_some((worst.0, worst.1))
    }
}

/// The gradients of the rows that take part, along the velocities of free coordinates.
#[derive(Clone, Debug)]
pub(in crate::analysis) struct RowGradients {
    /// row and place in v of each entry
    pub entries: Vec<(usize, usize)>,
    /// the entries   (n_entries)
    pub program: Program,
}

impl RowGradients {
    /// Records the gradients.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub fn new(recorder: &Recorder<'_, '_>) -> Result<Self, Vec<Unsupported>> {
        let (mut entries, mut values) = (Vec::new(), Vec::new());
        for r in recorder.scene().configuration.active_rows() {
            for &(v, x) in &recorder.at().row(r).gradient {
                entries.push((r, v));
                values.push(x);
            }
        }
        let program = recorder.program(&values)?;
        Ok(Self { entries, program })
    }
}

/// Returns the places in x of the contacts on curves, in their order.
fn contact_states(scene: &Scene) -> Vec<usize> {
    let states = |cam: &Cam| cam.state..cam.state + cam.contact.n_parameters();
    scene.cams.iter().flat_map(states).collect()
}

/// Records the least changes onto the rows; `None` when none takes part.
fn projection_program(recorder: &Recorder<'_, '_>) -> Result<Option<Program>, Vec<Unsupported>> {
    let (scene, at) = (recorder.scene(), recorder.at());
    if scene.configuration.active_rows().next().is_none() {
        return Ok(None);
    }
    let changes = programs::projection(&scene, at, at.velocities());
    recorder.program(&changes).map(Some)
}

/// Records the violation of each row that takes part, and its rate; `None` when none does.
fn violation_program(recorder: &Recorder<'_, '_>) -> Result<Option<Program>, Vec<Unsupported>> {
    let (scene, at) = (recorder.scene(), recorder.at());
    let both = |r: usize| {
        let row = at.row(r);
        let rate = at.row_rate(&row);
        let one = 1.0 / scene.row_scale(r);
        [row.value.scale(one), rate.scale(one)]
    };
    let all: Vec<Sym<'_>> = (scene.configuration.active_rows()).flat_map(both).collect();
    match all.is_empty() {
        true => Ok(None),
        false => recorder.program(&all).map(Some),
    }
}

/// Records the rows that are left out without being zero whatever happens, of equations of
/// velocities their rates; `None`: there are none.
fn left_out_program(
    recorder: &Recorder<'_, '_>,
) -> Result<Option<(Vec<usize>, Program)>, Vec<Unsupported>> {
    let (scene, at) = (recorder.scene(), recorder.at());
    let idle = (0..scene.rows.len()).filter(|&r| !scene.configuration.active[r]);
    let value = |r: usize| {
        let row = at.row(r);
        match scene.rows[r].is_of_velocities() && scene.mode != STATIC {
            true => at.row_rate(&row),
            false => row.value,
        }
    };
    let values = idle.map(|r| (r, value(r)));
    let (rows, values): (Vec<usize>, Vec<Sym<'_>>) =
        values.filter(|(_, x)| x.known().is_none()).unzip();
    let program = recorder.program(&values)?;
    Ok((!rows.is_empty()).then_some((rows, program)))
}

/// Records the values of all rows.
fn values_program(recorder: &Recorder<'_, '_>) -> Result<Program, Vec<Unsupported>> {
    let rows = 0..recorder.scene().rows.len();
    let values: Vec<Sym<'_>> = rows.map(|r| recorder.at().row(r).value).collect();
    recorder.program(&values)
}
