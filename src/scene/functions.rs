//! Functions of the model as formulas of the scene: expressions, and numbers that closures of the
//! user's compute.

use super::Formula;
use super::asker::Asker;
use super::build::Builder;
use super::compile::Compiler;
use super::external_inputs::{ExternalInput, HookKind, SceneDelay, SceneHook, closure_for};
use super::history::DelayId;
use crate::diagnostic::{Cause, Diagnostic};
use crate::expr::program::{Builder as Recorder, Folding, Input, Program};
use crate::model::{Element, ElementId, ElementKind, Formula as ModelFormula, RequestKind, Text};
use std::ops::Range;

impl Builder<'_> {
    /// Compiles an expression; its index in the scene's formulas.
    pub(super) fn formula(
        &mut self,
        c: &mut Compiler,
        owner: &Asker,
        formula: &ModelFormula,
    ) -> usize {
        match formula {
            ModelFormula::Expression { text, .. } => self.compiled(c, owner, text),
            ModelFormula::User { .. } => self.user(c, owner, formula, 1, &[])[0],
        }
    }

    /// A formula that has been compiled; its index.
    fn push(&mut self, owner: &Asker, text: &str, program: Program, delayed: Vec<usize>) -> usize {
        self.scene.formulas.push(Formula {
            owner: owner.clone(),
            text: text.to_string(),
            program,
            gradient: None,
            delayed,
        });
        self.scene.formulas.len() - 1
    }

    pub(super) fn compiled(&mut self, c: &mut Compiler, owner: &Asker, text: &Text) -> usize {
        let looking = self.structures.look_too();
        let compiled = super::formula::compile(text, &self.bindings);
        drop(looking);
        let compiled = match compiled {
            Ok(compiled) => compiled,
            Err(mut d) => {
                d = d.element(owner);
                if d.is(Cause::UnknownElement) {
                    c.errors.append(&mut self.unusable);
                }
                c.errors.push(d);
                // never evaluated: a scene with errors is not made
                return usize::MAX;
            }
        };
        // all parts of an expression number its delayed values alike
        let first = self.scene.delays.len();
        let n = compiled.delays.len();
        let places: Vec<usize> = (0..n)
            .map(|k| self.supply(ExternalInput::Delay(first + k)))
            .collect();
        for programs in compiled.delays {
            let id = DelayId {
                owner: owner.to_string(),
                expression: programs[0].to_string(),
            };
            let [expression, delay, history] =
                programs.map(|p| self.push(owner, text, p, places.clone()));
            self.scene.delays.push(SceneDelay {
                id,
                expression,
                delay,
                history,
            });
        }
        self.push(owner, text, compiled.program, places)
    }

    /// A place for a number from outside.
    pub(super) fn supply(&mut self, what: ExternalInput) -> usize {
        let place = self.scene.external_inputs.len();
        if let ExternalInput::Input(formula) = what {
            self.scene.plant_inputs.insert(formula, place);
        }
        self.scene.external_inputs.push(what);
        self.scene.layout.n_external = self.scene.external_inputs.len();
        place
    }

    /// `n` numbers that a closure of the user's computes for an element, as formulas; `reads`: what
    /// it is given beside its own inputs.
    pub(super) fn user(
        &mut self,
        c: &mut Compiler,
        owner: &Asker,
        formula: &ModelFormula,
        n: usize,
        reads: &[String],
    ) -> Vec<usize> {
        self.user_reading(c, owner, formula, n, reads, &[])
    }

    /// As [`user`](Self::user), for closures that are given values of further formulas as well.
    pub(super) fn user_reading(
        &mut self,
        c: &mut Compiler,
        owner: &Asker,
        formula: &ModelFormula,
        n: usize,
        reads: &[String],
        further: &[usize],
    ) -> Vec<usize> {
        let ModelFormula::User { constants, .. } = formula else {
            return vec![self.formula(c, owner, formula); n];
        };
        let known = owner.owner().and_then(|element| {
            let closure = closure_for(self.hooks, element, formula);
            closure.map(|closure| (element, closure))
        });
        let Some((element, closure)) = known else {
            if self.zero_user {
                return vec![self.compiled(c, owner, &"0".into()); n];
            }
            let message = "USER needs a routine that is not part of the dataset";
            c.errors.push(Diagnostic::error(Cause::UserRoutine, message).element(owner).help(
                "load the library that has it (--routines), register a closure for it in a program, switch the element off, or take what USER would compute as zero (--zero-user)",
            ));
            return vec![usize::MAX; n];
        };
        let mut inputs = self.inputs_of(c, owner, closure);
        let reads = reads.iter();
        inputs.extend(reads.map(|text| self.compiled(c, owner, &text.as_str().into())));
        inputs.extend(further);
        let kind = HookKind::User { closure, inputs };
        let places = self.asked_of(kind, element, constants, n);
        let text = format!("USER, {}", self.hooks[closure].name);
        let outside = |place| self.supplied_formula(owner, &text, place);
        places.map(outside).collect()
    }

    /// The expressions that a closure was registered with, as formulas.
    pub(super) fn inputs_of(
        &mut self,
        c: &mut Compiler,
        owner: &Asker,
        closure: usize,
    ) -> Vec<usize> {
        let texts = self.hooks[closure].inputs.iter();
        texts
            .map(|text| self.compiled(c, owner, &text.as_str().into()))
            .collect()
    }

    /// Places for `n` numbers, at least one, that a closure computes for an element.
    pub(super) fn asked_of(
        &mut self,
        kind: HookKind,
        element: ElementId,
        constants: &[f64],
        n: usize,
    ) -> Range<usize> {
        let hook = self.scene.hooks.len();
        let place = self.scene.external_inputs.len();
        for k in 0..n {
            self.supply(ExternalInput::Hook(hook, k));
        }
        self.scene.hooks.push(SceneHook {
            kind,
            output_only: element.kind == ElementKind::Request,
            element,
            constants: constants.to_vec(),
            n,
            place,
        });
        place..place + n
    }

    /// A number from outside as a formula.
    pub(super) fn supplied_formula(&mut self, owner: &Asker, text: &str, place: usize) -> usize {
        let mut recorder = Recorder::new(Folding::Strict);
        let value = recorder.input(Input::Delayed(0));
        self.push(owner, text, recorder.finish(&[value]), vec![place])
    }

    /// REQUEST, FUNCTION=USER: eight components, where there is a closure for it. One that nobody
    /// computes harms nobody, and is told.
    pub(super) fn user_requests(&mut self, c: &mut Compiler) {
        let model = self.model;
        for (n, request) in model.active(ElementKind::Request, &model.requests) {
            let id = ElementKind::Request.id(n);
            let takes_user = matches!(request.kind, RequestKind::User(_));
            for (argument, formula) in request.formulas() {
                let asker = Asker::argument(id, argument);
                let by_user = matches!(formula, ModelFormula::User { .. });
                let told = match (takes_user, by_user) {
                    (true, true) if closure_for(self.hooks, id, formula).is_some() => {
                        let all = self.user(c, &asker, formula, 8, &[]);
                        self.scene.requests.insert(n, all);
                        continue;
                    }
                    (false, false) => continue,
                    (_, true) => Diagnostic::warning(
                        Cause::UserRoutine,
                        "USER needs a routine that is not part of the dataset: no column has it",
                    )
                    .help("FUNCTION=USER(…), and a closure for it through the library"),
                    (true, false) => Diagnostic::warning(
                        Cause::UserRoutine,
                        "FUNCTION takes USER(…): no column has this expression",
                    )
                    .help("expressions stand in F1 to F8: F2=…\\"),
                };
                self.scene.warnings.push(told.element(&asker));
            }
        }
    }
}
