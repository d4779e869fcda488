//! The first configuration: that of the dataset, moved to initial conditions and onto the rows.
//!
//! Where motions begin elsewhere than where their joints are drawn, the mechanism is driven there.
//! Parts are placed near where they are drawn, then the rows are closed. Where that fails, or ends
//! at an opposite of what orientation rows ask for, the turns that they ask for are made first
//! (`branch.rs`), and the rest again from there. The first outcome stands where none of these is
//! better.

use crate::analysis::look::Look;
use crate::analysis::start::alignment;
use crate::analysis::start::assemble::{self, Assembly};
use crate::analysis::start::branch;
use crate::analysis::start::driven_start;
use crate::analysis::start::initial_conditions::{self, InitialCondition, Wanted};
use crate::analysis::start::nearest::{Origin, nearest};
use crate::diagnostic::Diagnostic;
use crate::model::Model;
use crate::scene::Scene;
use crate::scene::cams;
use crate::scene::configuration::Configuration;

/// A dataset that is to be assembled.
pub struct Dataset<'a> {
    /// the scene
    pub scene: &'a Scene,
    /// the model that it was made of
    pub model: &'a Model,
    /// time
    pub t: f64,
    /// states   (n_x)
    pub x: &'a [f64],
    /// initial conditions
    pub conditions: Vec<InitialCondition>,
}

/// An assembled dataset, and where contacts on curves were asked to begin.
type Assembled = Result<(Assembly, Vec<cams::Start>), Vec<Diagnostic>>;

impl<'a> Dataset<'a> {
    /// Returns the dataset as it is drawn, at time 0, with its initial conditions.
    ///
    /// `x`: states   (n_x)
    pub fn drawn(scene: &'a Scene, model: &'a Model, x: &'a [f64]) -> Self {
        Self {
            scene,
            model,
            t: 0.0,
            x,
            conditions: initial_conditions::collect(scene, model),
        }
    }

    /// Moves `q` from where it is drawn to where the dataset is assembled.
    ///
    /// # Errors
    /// Rows that contradict each other.
    pub fn assemble(&self, configuration: &mut Configuration, q: &mut [f64]) -> Assembled {
        self.assemble_while(configuration, q, &mut || Ok(()))
    }

    /// The same, asking `look` on the way whether to go on.
    ///
    /// # Errors
    /// Rows that contradict each other, and what `look` answers.
    pub(in crate::analysis) fn assemble_while(
        &self,
        configuration: &mut Configuration,
        q: &mut [f64],
        look: Look<'_>,
    ) -> Assembled {
        let (scene, t, x) = (self.scene, self.t, self.x);
        branch::refer(scene, configuration, t, q, x, true);
        let drawn = (configuration.clone(), q.to_vec());
        let right = |configuration: &Configuration, q: &[f64]| {
            !branch::is_opposite(scene, configuration, &drawn.0, t, q, x)
        };
        let (mut driven, mut there) = drawn.clone();
        let asked = (self.model, &self.conditions[..]);
        let is_driven =
            driven_start::drive((scene, &mut driven), asked, t, &mut there, x, &mut *look);
        look()?;
        if is_driven {
            let outcome = self.near(&mut driven, &mut there, Origin::Beginning, look);
            look()?;
            if outcome.is_ok() && right(&driven, &there) {
                *configuration = driven;
                q.copy_from_slice(&there);
                return outcome;
            }
        }
        let first = self.near(configuration, q, Origin::Drawn, look);
        look()?;
        if first.is_ok() && right(configuration, q) {
            return first;
        }
        for normal in 0..branch::NORMALS {
            let (mut turned, mut there) = drawn.clone();
            if !branch::turn(scene, &mut turned, t, &mut there, x, normal) {
                continue;
            }
            // placed near the drawing, or else where the turns have led
            for origin in [Origin::Drawn, Origin::Beginning] {
                let (mut other, mut p) = (turned.clone(), there.clone());
                let second = self.near(&mut other, &mut p, origin, look);
                look()?;
                if second.is_ok() && right(&other, &p) {
                    *configuration = other;
                    q.copy_from_slice(&p);
                    return second;
                }
            }
        }
        first
    }

    /// Moves `q` onto the rows, from where it is, or from the place nearest to the drawing.
    fn near(
        &self,
        configuration: &mut Configuration,
        q: &mut [f64],
        origin: Origin,
        look: Look<'_>,
    ) -> Assembled {
        let Self {
            scene, model, t, x, ..
        } = *self;
        alignment::leave_out(scene, configuration, t, q, x, look)?;
        look()?;
        let here = scene.within(configuration);
        let numbers = assemble::numbers(here, t, q, &vec![0.0; scene.layout.n_v], x);
        let wanted = Wanted::new(here, &self.conditions, &numbers);
        let place = (scene, &mut *configuration);
        nearest(place, (Some(model), &wanted), t, q, x, origin);
        look()?;
        let assembly = assemble::positions_while(scene, configuration, t, q, x, look)?;
        Ok((assembly, wanted.starts))
    }
}

/// Moves `q` from where a simulation left it onto rows that may have changed, and chooses those
/// that take part.
///
/// # Errors
/// Rows that contradict each other, and what `look` answers, which is asked on the way.
pub(in crate::analysis) fn go_on(
    scene: &Scene,
    configuration: &mut Configuration,
    t: f64,
    q: &mut [f64],
    x: &[f64],
    look: Look<'_>,
) -> Result<Assembly, Vec<Diagnostic>> {
    branch::refer(scene, configuration, t, q, x, false);
    alignment::leave_out(scene, configuration, t, q, x, look)?;
    let left = (configuration.clone(), q.to_vec());
    let first = assemble::positions_while(scene, configuration, t, q, x, look);
    look()?;
    // rows that held where it was left have been followed to there
    let followed = matches!(&first, Ok(assembly) if assembly.iterations == 0);
    if followed || first.is_ok() && !branch::is_opposite(scene, configuration, &left.0, t, q, x) {
        return first;
    }
    for normal in 0..branch::NORMALS {
        let (mut other, mut p) = left.clone();
        if !branch::turn(scene, &mut other, t, &mut p, x, normal) {
            continue;
        }
        let second = assemble::positions_while(scene, &mut other, t, &mut p, x, look);
        look()?;
        if second.is_ok() && !branch::is_opposite(scene, &other, &left.0, t, &p, x) {
            *configuration = other;
            q.copy_from_slice(&p);
            return second;
        }
    }
    first
}
