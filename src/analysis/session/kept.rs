//! Systems and starts that are kept: what the next simulation may go on with, and what a session
//! that has gone back to its start begins with, where the model differs by nothing but constants
//! that commands change. Nothing is compiled, assembled or recorded for those.

use super::Session;
use super::placed::Placed;
use crate::analysis::start::assemble::Assembly;
use crate::analysis::system::System;
use crate::analysis::trajectory::Left;
use crate::expr::program::Program;
use crate::model::Model;
use crate::scene::Scene;
use crate::scene::equations::Unsupported;
use crate::scene::external_inputs::ExternalInput;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A system that has done its simulation, and the model it was made of.
#[derive(Debug)]
pub(super) struct Kept {
    /// without the constants that are external inputs of the scene; `None`: nothing comes after
    model: Option<Arc<Model>>,
    mode: u32,
    system: System,
    assembly: Assembly,
    /// the program of the columns at the start, and the numbers that it lacks
    columns: Option<(Program, Vec<Unsupported>)>,
}

impl Kept {
    /// Keeps a system with what [`Session::made_of`] says.
    pub(super) fn new(
        model: Option<Arc<Model>>,
        mode: u32,
        system: System,
        assembly: Assembly,
    ) -> Self {
        Self {
            model,
            mode,
            system,
            assembly,
            columns: None,
        }
    }

    /// Keeps the program of the columns, which belongs to the configuration at the start.
    pub(super) fn keep_columns(&mut self, program: &Program, complaints: &[Unsupported]) {
        self.columns = Some((program.clone(), complaints.to_vec()));
    }

    /// Keeps what a simulation that began here has recorded on its way.
    pub(super) fn take_derivatives(&mut self, system: &System) {
        self.system.take_derivatives(system);
    }

    /// Returns the system, to be looked at.
    pub(super) fn system_mut(&mut self) -> &mut System {
        &mut self.system
    }

    /// Returns whether a model differs from the one of this system by nothing but the constants
    /// that are external inputs.
    fn is_of(&self, model: &mut Model) -> bool {
        self.model.as_deref().is_some_and(|kept| {
            without_constants(model, &self.system.scene, |model| *model == *kept)
        })
    }
}

/// A mechanism without freedom: what was assembled to find that out. Nothing was recorded for it.
#[derive(Clone, Debug)]
struct Still {
    /// without the constants that are external inputs of the scene
    model: Arc<Model>,
    scene: Arc<Scene>,
    assembly: Assembly,
}

impl Still {
    /// Returns whether a model differs by nothing but constants that are external inputs.
    fn is_of(&self, model: &mut Model) -> bool {
        without_constants(model, &self.scene, |model| *model == *self.model)
    }
}

/// Assembled starts that are kept.
#[derive(Debug, Default)]
pub(super) struct Starts {
    /// by their MODE
    pub systems: BTreeMap<u32, Kept>,
    /// of dynamics, where there is no freedom
    still: Option<Still>,
    /// where models were assembled, by their MODE
    pub placed: BTreeMap<u32, Arc<Placed>>,
}

/// A model that has been brought into its state for dynamics.
pub(super) enum Prepared {
    Moves(Box<System>, Assembly),
    Still(Arc<Scene>, Assembly),
}

/// Looks at a model while it lacks the numbers that are external inputs of its scene.
pub(super) fn without_constants<T>(
    model: &mut Model,
    scene: &Scene,
    look: impl FnOnce(&mut Model) -> T,
) -> T {
    let mut taken = Vec::new();
    for what in &scene.external_inputs {
        if let ExternalInput::Constant(id) = what
            && let Some(variable) = model.variables.get_mut(id)
            && variable.function.constant().is_some()
        {
            let function = std::mem::take(&mut variable.function);
            taken.push((*id, function, std::mem::take(&mut variable.place)));
        }
    }
    let seen = look(model);
    for (id, function, place) in taken {
        if let Some(variable) = model.variables.get_mut(&id) {
            (variable.function, variable.place) = (function, place);
        }
    }
    seen
}

/// Returns whether a model differs from one that was kept by nothing but constants that are
/// external inputs.
fn are_same(model: &mut Model, kept: &Model, scene: &Scene) -> bool {
    without_constants(model, scene, |model| {
        *model == *kept || {
            // a state that was read has its constants
            let mut kept = kept.clone();
            without_constants(&mut kept, scene, |kept| *model == *kept)
        }
    })
}

impl Session {
    /// Returns the present model as the system of a simulation keeps it: that of the system which
    /// the simulation began with, where this is such a one.
    pub(super) fn made_of(&mut self, scene: &Scene) -> Arc<Model> {
        let copied = || without_constants(&mut self.model, scene, |model| Arc::new(model.clone()));
        self.kept_model.take().unwrap_or_else(copied)
    }

    /// Returns what the method has left that led to the present state, where the model differs from
    /// that of its system by nothing but constants that are external inputs.
    pub(super) fn left_before(&mut self, scene: &Scene) -> Option<Left> {
        let (model, left) = self.carried.as_ref()?.left.as_ref()?;
        let is_same = self.goes_on || are_same(&mut self.model, model, scene);
        is_same.then(|| left.clone())
    }

    /// Returns the same for a state that is saved, without changing the session.
    pub(super) fn left_to_save(&self) -> Option<&Left> {
        let (model, left) = self.carried.as_ref()?.left.as_ref()?;
        let is_same = match &self.kept {
            Some(kept) => are_same(&mut self.model.clone(), model, &kept.system.scene),
            None => self.model == **model,
        };
        is_same.then_some(left)
    }

    /// Keeps what a method leaves with the state to which it has led.
    pub(super) fn keep_left(&mut self, left: Option<Left>, scene: &Scene) {
        // closures may answer otherwise
        let is_kept = self.hooks.is_empty() && !self.is_last;
        let Some(left) = left.filter(|_| is_kept) else {
            return;
        };
        let model = self.made_of(scene);
        self.kept_model = Some(Arc::clone(&model));
        if let Some(carried) = &mut self.carried {
            carried.left = Some((model, left));
        }
    }

    /// Returns the system of the simulation before, at the state that it left, where nothing is
    /// different but constants that commands change. No constraint reads these: it still holds.
    fn again(&mut self, mode: u32, inputs: &[u32]) -> Option<(System, Assembly)> {
        let kept = *self.kept.take()?;
        let carried = self.carried.as_ref()?;
        let same = kept.mode == mode
            && inputs.is_empty()
            && self.hooks.is_empty()
            && kept.system.scene.samplers.is_empty()
            && !carried.at_rest
            && carried.numbers.len() == kept.system.numbers.len()
            && kept.is_of(&mut self.model);
        if !same {
            return None;
        }
        let mut system = kept.system;
        system.numbers.copy_from_slice(&carried.numbers);
        self.set_constants(&system.scene, &mut system.numbers);
        system
            .recorded
            .external
            .delays
            .begin(carried.t, &carried.past);
        system.resolve().ok()?;
        system.follow_sensors(&carried.held);
        system.begin_sensing();
        self.kept_model = kept.model;
        self.goes_on = true;
        Some((system, kept.assembly))
    }

    /// Returns the system as it was assembled at the start, where a session has gone back to it and
    /// nothing is different but constants that commands change.
    fn rewound(&mut self, mode: u32, inputs: &[u32]) -> Option<(System, Assembly)> {
        let kept = self.starts.systems.get(&mode)?;
        let same = inputs.is_empty() && self.carried.is_none() && kept.is_of(&mut self.model);
        if !same {
            return None;
        }
        let (mut system, assembly) = (kept.system.clone(), kept.assembly.clone());
        let model = kept.model.clone();
        let before = system.numbers.clone();
        self.set_constants(&system.scene, &mut system.numbers);
        if system.numbers != before {
            // formulas that read themselves are solved from the guesses of the model alone
            if !(system.scene.samplers.is_empty() && system.scene.loops.is_empty()) {
                return None;
            }
            let l = system.scene.layout;
            system.configuration.external = system.numbers[l.external()].to_vec();
            let y = system.numbers[l.states()].to_vec();
            self.put(&mut system, (self.time(), &y), mode).ok()?;
        }
        self.kept_model = model;
        Some((system, assembly))
    }

    /// Returns the system of the simulation before, or of the start, where it can be gone on with.
    pub(super) fn before(&mut self, mode: u32, inputs: &[u32]) -> Option<(System, Assembly)> {
        (self.kept_model, self.columns_at_start) = (None, None);
        self.goes_on = false;
        if let Some(again) = self.again(mode, inputs) {
            return Some(again);
        }
        let (system, assembly) = self.rewound(mode, inputs)?;
        let kept = self.starts.systems.get(&mode);
        self.columns_at_start = kept.and_then(|kept| kept.columns.clone());
        self.begin_companion_at(mode, inputs, &system, &assembly);
        Some((system, assembly))
    }

    /// Returns what was assembled for dynamics at the start, where there was no freedom.
    pub(super) fn still_before(&mut self) -> Option<(Arc<Scene>, Assembly)> {
        let begins = self.carried.is_none();
        let still = self.starts.still.as_ref().filter(|_| begins)?;
        if !still.is_of(&mut self.model) {
            return None;
        }
        if let Some(companion) = &mut self.companion {
            companion.starts.still = Some(still.clone());
        }
        Some((Arc::clone(&still.scene), still.assembly.clone()))
    }

    /// Keeps what was assembled for dynamics at the start, where there is no freedom.
    pub(super) fn keep_still(&mut self, scene: &Arc<Scene>, assembly: &Assembly) {
        let is_read = self.options.keep_start || self.companion.is_some();
        if self.carried.is_some() || !is_read {
            return;
        }
        let still = Still {
            model: self.made_of(scene),
            scene: Arc::clone(scene),
            assembly: assembly.clone(),
        };
        if let Some(companion) = &mut self.companion {
            companion.starts.still = Some(still.clone());
        }
        self.starts.still = Some(still).filter(|_| self.options.keep_start);
    }

    /// Lets the companion begin where this session does, with the programs that are there.
    pub(super) fn begin_companion_at(
        &mut self,
        mode: u32,
        inputs: &[u32],
        system: &System,
        assembly: &Assembly,
    ) {
        if self.companion.is_none() || self.carried.is_some() || !inputs.is_empty() {
            return;
        }
        let start = self.kept_start(mode, system, assembly);
        if let Some(companion) = &mut self.companion {
            companion.starts.systems.insert(mode, start);
        }
    }

    /// Returns a copy of a system that has been assembled, to be gone back to.
    pub(super) fn kept_start(&mut self, mode: u32, system: &System, assembly: &Assembly) -> Kept {
        let model = self.made_of(&system.scene);
        self.kept_model = Some(Arc::clone(&model));
        Kept::new(Some(model), mode, system.clone(), assembly.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::super::script::obey;
    use super::super::{Options, Session};
    use crate::analysis::watch::Unwatched;
    use crate::dataset::command::Script;
    use crate::model::Model;

    const PENDULUM: &str = "pendulum\nPART/1, GROUND\nMARKER/10, PART=1\n\
        PART/2, MASS=1, CM=20, IP=0.1,0.1,0.1, QG=1,0,0\nMARKER/20, PART=2\n\
        MARKER/21, PART=2, QP=-1,0,0\nJOINT/1, REVOLUTE, I=21, J=10\n\
        REQUEST/1, F2=DX(20,10)\\F3=VY(20,10)\nACCGRAV/JGRAV=-9.81\nEND\n";
    const COMMANDS: &str = "FILE/MODEL=m\nSIMULATE/DYNAMIC, END=0.5, STEPS=10\n\
        SIMULATE/DYNAMIC, END=1, STEPS=10\nSTOP\n";

    /// Returns the bits of all rows, and whether a model is kept to go on with.
    fn obeyed(ends: bool) -> (Vec<u64>, bool) {
        let model = Model::from_text(PENDULUM).expect("a model");
        let mut session = Session::new(model, "pendulum", Options::default());
        if ends {
            session.end_with_commands();
        }
        let steps = Script::from_text(COMMANDS).expect("commands").steps;
        let obeyed = obey(&mut session, &steps, |_, _| {}, &mut Unwatched);
        obeyed.expect("simulations");
        let values = session.run.columns.iter().flat_map(|c| &c.values);
        let kept = session.kept.as_ref().expect("a system");
        (values.map(|x| x.to_bits()).collect(), kept.model.is_some())
    }

    #[test]
    fn the_last_simulation_of_a_run_keeps_no_model_and_changes_no_bit() {
        let (rows, goes_on) = obeyed(false);
        let (last, keeps) = obeyed(true);
        assert!(goes_on && !keeps);
        assert!(rows.len() > 60, "{}", rows.len());
        assert_eq!(rows, last);
    }
}
