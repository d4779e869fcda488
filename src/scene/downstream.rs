//! States downstream of the mechanism: filters, integrals and controllers that read it and that
//! nothing of it reads. Only outputs do.
//!
//! ```text
//! mechanism  ẏ = f(t, y)   →   downstream  ẋ = g(t, y, x)   →   outputs
//! ```
//!
//! Nothing comes back, so that the mechanism moves as if they were not there. They stand last among
//! the further states, are no unknowns of its method, and are integrated beside it in steps of
//! their own. In statics, linear systems and kinematics they are states like all others.
//!
//! A state is downstream if no force, motion, constraint, sensor, sampler, delay or closure reads
//! it, directly or through VARIABLEs, ARRAYs and other states, and if its equation is explicit and
//! calm: without a branch, a narrow peak, an angle that counts turns or a number from outside. What
//! is not calm needs events, which are the mechanism's.

use super::asker::Asker;
use super::build::Builder;
use super::external_inputs::{ExternalInput, HookKind};
use super::forces::ForceLaw;
use super::loops::Key;
use super::{Entry, Formula, Scene};
use crate::arrange::Arrange;
use crate::expr::measures::Measure;
use crate::expr::program::{Builder as Recorder, Folding, Input};
use crate::model::ElementKind;
use std::collections::BTreeMap;

/// Value of MODE in a dynamic analysis.
const DYNAMIC: f64 = 4.0;

/// The source of an input: a formula, or the index of a differential equation whose state is read,
/// or its rate.
enum Read {
    Formula(usize),
    State(usize),
    Rate(usize),
}

/// A search for what is read.
struct Search<'s> {
    scene: &'s Scene,
    /// DIFF number → index in the differential equations
    equation_of: BTreeMap<u32, usize>,
    /// formulas that were reached   (n_formulas)
    formulas: Vec<bool>,
    /// differential equations whose states were reached   (n_differentials)
    states: Vec<bool>,
    open: Vec<usize>,
}

impl<'s> Search<'s> {
    fn new(scene: &'s Scene) -> Self {
        let all = scene.differentials.iter().enumerate();
        let diffs = all.filter(|(_, d)| d.id.element.kind == ElementKind::Diff);
        Self {
            scene,
            equation_of: diffs.map(|(k, d)| (d.id.element.number, k)).collect(),
            formulas: vec![false; scene.formulas.len()],
            states: vec![false; scene.differentials.len()],
            open: Vec::new(),
        }
    }

    /// Returns what an input leads to; `None`: neither a formula nor a state.
    fn read(&self, input: &Input) -> Option<Read> {
        let &Input::Measure(measure, [id, k, ..]) = input else {
            return None;
        };
        let entry = |entries: &[Entry]| match entries.get((k as usize).checked_sub(1)?)? {
            Entry::Number(_) => None,
            Entry::State(d) => Some(Read::State(*d)),
            Entry::Formula(f) => Some(Read::Formula(*f)),
        };
        match measure {
            Measure::Varval => self.scene.variables.get(&id).map(|&f| Read::Formula(f)),
            Measure::Aryval => entry(self.scene.arrays.get(&id)?),
            Measure::Dif => self.equation_of.get(&id).map(|&d| Read::State(d)),
            Measure::Dif1 => self.equation_of.get(&id).map(|&d| Read::Rate(d)),
            Measure::Pinval | Measure::Pouval => {
                self.scene.plant_formula(measure, id, k).map(Read::Formula)
            }
            _ => None,
        }
    }

    /// Reaches the state of an equation.
    fn reach_state(&mut self, d: usize) {
        self.states[d] = true;
        self.reach(self.scene.differentials[d].formula);
    }

    /// Reaches a formula.
    fn reach(&mut self, f: usize) {
        if !std::mem::replace(&mut self.formulas[f], true) {
            self.open.push(f);
        }
    }

    /// Reaches all that is read by what was reached.
    fn follow(&mut self) {
        let scene = self.scene;
        while let Some(f) = self.open.pop() {
            for input in scene.formulas[f].program.inputs() {
                match self.read(input) {
                    Some(Read::Formula(f)) => self.reach(f),
                    Some(Read::State(d) | Read::Rate(d)) => self.reach_state(d),
                    None => {}
                }
            }
        }
    }

    /// Returns whether each formula is calm with all formulas that it is made of   (n_formulas).
    fn calm(&self) -> Vec<bool> {
        let n = self.scene.formulas.len();
        let mut readers = vec![Vec::new(); n];
        let mut open = Vec::new();
        for (f, formula) in self.scene.formulas.iter().enumerate() {
            for input in formula.program.inputs() {
                match self.read(input) {
                    Some(Read::Formula(read)) => readers[read].push(f),
                    Some(Read::Rate(d)) => readers[self.scene.differentials[d].formula].push(f),
                    Some(Read::State(_)) | None => {}
                }
            }
            if !is_calm(self.scene, formula) {
                open.push(f);
            }
        }
        let mut calm = vec![true; n];
        while let Some(f) = open.pop() {
            if std::mem::replace(&mut calm[f], false) {
                open.extend(&readers[f]);
            }
        }
        calm
    }
}

/// Returns whether a formula needs no events, and nothing that steps of the mechanism leave behind.
fn is_calm(scene: &Scene, formula: &Formula) -> bool {
    let is_known = |input: &Input| match *input {
        Input::Time | Input::Mode => true,
        Input::Measure(measure, _) => !measure.needs_history() && measure != Measure::Senval,
        Input::Delayed(k) => {
            let place = formula.delayed.get(k as usize);
            let input = place.and_then(|&place| scene.external_inputs.get(place));
            matches!(input, Some(ExternalInput::Constant(_)))
        }
        Input::Slot(_) => false,
    };
    if !formula.program.inputs().iter().all(is_known) {
        return false;
    }
    let mut recorder = Recorder::new(Folding::Strict);
    let outputs = formula.program.record(&mut recorder);
    let may_peak = formula.program.may_peak();
    recorder.switching(&outputs).is_empty()
        && recorder.timed(&outputs, Input::Time).breaks.is_empty()
        && (!may_peak || recorder.peaks(&outputs).is_empty())
}

/// Returns whether a formula is read by whoever asks for it, and not only by those who read its
/// value: all but those of VARIABLEs, of states and of outputs.
fn is_read_by_itself(formula: &Formula) -> bool {
    let Asker::Function(element, _) = &formula.owner else {
        return !matches!(formula.owner, Asker::Column(_));
    };
    !matches!(
        element.kind,
        ElementKind::Variable
            | ElementKind::Diff
            | ElementKind::Lse
            | ElementKind::Tfsiso
            | ElementKind::Request
            | ElementKind::Mrequest
    )
}

/// Finds what the mechanism reads: formulas, and states by their equations.
fn upstream(scene: &Scene) -> Search<'_> {
    let mut search = Search::new(scene);
    for (f, formula) in scene.formulas.iter().enumerate() {
        if is_read_by_itself(formula) {
            search.reach(f);
        }
    }
    for delay in &scene.delays {
        let read = [delay.expression, delay.delay, delay.history];
        read.into_iter().for_each(|f| search.reach(f));
    }
    for hook in scene.hooks.iter().filter(|hook| !hook.output_only) {
        let inputs = match &hook.kind {
            HookKind::User { inputs, .. } => inputs,
            HookKind::Touched(touched) => &touched.inputs,
            HookKind::Coupled(_) | HookKind::Touches { .. } => continue,
        };
        inputs.iter().for_each(|&f| search.reach(f));
    }
    for unknown in &scene.loops {
        match unknown.key {
            Key::Formula(f) => search.reach(f),
            Key::Rate(d) | Key::Value(d) => search.reach_state(d),
            Key::Measure(..) => {}
        }
    }
    let calm = search.calm();
    for (d, equation) in scene.differentials.iter().enumerate() {
        if equation.implicit || equation.state.is_none() || !calm[equation.formula] {
            search.reach_state(d);
        }
    }
    search.follow();
    search
}

impl Builder<'_> {
    /// Parts the states downstream of the mechanism from the others: they become the last.
    pub(super) fn part_downstream(&mut self) {
        let scene = &self.scene;
        if scene.mode != DYNAMIC || scene.differentials.is_empty() {
            return;
        }
        let upstream = upstream(scene);
        let mut is_downstream = vec![false; scene.layout.n_x];
        let mut search = Search::new(scene);
        for (d, equation) in scene.differentials.iter().enumerate() {
            if let (Some(state), false) = (equation.state, upstream.states[d]) {
                is_downstream[state] = true;
                search.reach_state(d);
            }
        }
        let n = is_downstream.iter().filter(|&&is| is).count();
        // equations without a mechanism are all that there is
        if n == 0 || n == scene.layout.n_y() {
            return;
        }
        search.follow();
        let read = search.formulas.iter().zip(&upstream.formulas);
        let read_downstream = read.map(|(&below, &above)| below && !above).collect();
        self.scene.read_downstream = read_downstream;
        self.move_to_the_end(&is_downstream);
        self.scene.layout.n_downstream = n;
    }

    /// Gives the states in question the last places of x; the order stays otherwise.
    fn move_to_the_end(&mut self, moved: &[bool]) {
        let mut order: Vec<usize> = (0..moved.len()).collect();
        order.arrange_by_key(|&place| moved[place]);
        let mut place_of = vec![0; moved.len()];
        for (place, &before) in order.iter().enumerate() {
            place_of[before] = place;
        }
        let scene = &mut self.scene;
        scene.unknowns.x = order.iter().map(|&k| scene.unknowns.x[k]).collect();
        let of_equations = scene.differentials.iter_mut().map(|d| &mut d.state);
        let of_motions = scene.motions.iter_mut().map(|m| &mut m.state);
        for state in of_equations.chain(of_motions).flatten() {
            *state = place_of[*state];
        }
        for cam in &mut scene.cams {
            cam.state = place_of[cam.state];
        }
        for force in &mut scene.forces {
            // places one after the other, none of which is moved alone
            if let ForceLaw::Friction { creep, .. } = &mut force.law
                && let Some(&first) = place_of
                    .get(creep.start)
                    .filter(|_| creep.start < creep.end)
            {
                *creep = first..first + creep.len();
            }
        }
    }
}
