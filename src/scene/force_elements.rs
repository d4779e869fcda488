//! Force elements of a model as force elements of the scene: which kinds there are, and those whose
//! laws need no more than their numbers.
//!
//! FIELD, BEAM and NFORCE are made in `compliance.rs`, contacts in `contacts.rs`, friction in
//! `frictions.rs`. A new law of two markers is a row in `forces.rs`; a new kind of element of
//! another sort is an arm here that the compiler asks for.

use super::LinkIx;
use super::asker::Asker;
use super::build::Builder;
use super::compile::Compiler;
use super::forces::{ForceElement, ForceLaw, laws_of_two_markers};
use crate::model::{ById, COMPONENTS, Element, ElementId, ElementKind, VectorForce};
use std::collections::BTreeSet;
use std::ops::Range;

macro_rules! kinds_of_forces {
    ($($kind:ident $list:ident: $law:ty;)*) => {
        impl Builder<'_> {
            /// Makes force elements of all kinds, in the order of the table.
            pub(super) fn forces(&mut self, c: &mut Compiler, skipped: &BTreeSet<ElementKind>) {
                use ElementKind as E;
                for &kind in ElementKind::ALL {
                    match kind {
                        $(E::$kind => {
                            self.laws(c, kind, &self.model.$list, |s| ForceLaw::$kind(s.into()));
                        })*
                        E::Sforce => self.single_forces(c),
                        E::Vforce => self.vectors(c, kind, &self.model.vforces, 0..3),
                        E::Vtorque => self.vectors(c, kind, &self.model.vtorques, 3..6),
                        E::Gforce => self.vectors(c, kind, &self.model.gforces, 0..6),
                        E::Field => self.fields(c),
                        E::Beam => self.beams(c),
                        E::Nforce => self.nodal_forces(c),
                        E::Contact => self.contacts(c, skipped),
                        E::Friction => self.frictions(c),
                        // other passes make these
                        E::Part | E::PointMass | E::Marker => {}
                        E::Joint | E::Jprim | E::Motion | E::Coupler => {}
                        E::Gear | E::Gcon | E::Ptcv | E::Cvcv => {}
                        E::Variable | E::Diff | E::Lse | E::Tfsiso | E::Gse => {}
                        E::Pinput | E::Poutput | E::Sensor => {}
                        E::Array | E::Curve | E::Spline | E::String | E::Matrix => {}
                        E::Request | E::Mrequest | E::Graphics => {}
                        // not solved: see `left_out.rs`
                        E::FlexBody | E::FePart | E::Ucon | E::Ptsf | E::Cvsf | E::Sfsf => {}
                        E::FeLoad | E::Mforce | E::Tire | E::Wheel | E::Material => {}
                        E::Section | E::FeNode | E::Surface | E::Femdata => {}
                    }
                }
            }
        }
    };
}
laws_of_two_markers!(kinds_of_forces);

impl Builder<'_> {
    /// Makes the elements of one kind whose law is nothing but their numbers.
    fn laws<T: Element>(
        &mut self,
        c: &mut Compiler,
        kind: ElementKind,
        list: &ById<T>,
        law: impl Fn(&T) -> ForceLaw,
    ) {
        for (id, statement) in self.model.active(kind, list) {
            if let Some([i, j]) = statement.ends() {
                self.between(c, kind.id(id), (i, j), law(statement));
            }
        }
    }

    fn single_forces(&mut self, c: &mut Compiler) {
        let model = self.model;
        for (id, f) in model.active(ElementKind::Sforce, &model.sforces) {
            let id = ElementKind::Sforce.id(id);
            let formula = self.formula(c, &Asker::argument(id, "FUNCTION"), &f.function);
            let law = ForceLaw::Single {
                rotational: f.rotational,
                action_only: f.action_only,
                formula,
                idle: self.is_zero(formula),
            };
            self.along(c, id, (f.i, f.j), !f.action_only, law);
        }
    }

    /// Returns whether a formula is the number zero, whatever the state.
    fn is_zero(&self, formula: usize) -> bool {
        // where there are errors no formula was made
        let constant = self.scene.formulas.get(formula);
        let constant = constant.and_then(|f| f.program.constant_outputs());
        constant.is_some_and(|numbers| numbers == [0.0])
    }

    /// Makes an element between I and J that reacts on J's part.
    pub(super) fn between(
        &mut self,
        c: &mut Compiler,
        id: ElementId,
        ij: (u32, u32),
        law: ForceLaw,
    ) {
        self.along(c, id, ij, true, law);
    }

    /// Makes an element between I and J; `reacts`: it reacts on J's part.
    fn along(
        &mut self,
        c: &mut Compiler,
        id: ElementId,
        ij: (u32, u32),
        reacts: bool,
        law: ForceLaw,
    ) {
        let (Some(i), Some(j)) = (c.marker(ij.0, id), c.marker(ij.1, id)) else {
            return;
        };
        let reaction = reacts.then(|| self.scene.markers[j].link);
        self.scene.forces.push(ForceElement {
            id,
            i,
            j: Some(j),
            floating: 0,
            reaction,
            law,
        });
    }

    /// Makes forces of one kind by components; `user`: the components that a closure computes.
    fn vectors(
        &mut self,
        c: &mut Compiler,
        kind: ElementKind,
        list: &ById<VectorForce>,
        user: Range<usize>,
    ) {
        for (id, f) in self.model.active(kind, list) {
            self.vector(c, kind.id(id), f, user.clone());
        }
    }

    fn vector(&mut self, c: &mut Compiler, id: ElementId, f: &VectorForce, places: Range<usize>) {
        let mut formulas = [None; 6];
        if let Some(user) = &f.user {
            let owner = Asker::argument(id, "FUNCTION");
            let all = self.user(c, &owner, user, places.len(), &[]);
            for (place, formula) in places.zip(all) {
                formulas[place] = Some(formula);
            }
        }
        for (k, part) in f.force.iter().chain(&f.torque).enumerate() {
            if let Some(part) = part {
                let owner = Asker::argument(id, COMPONENTS[k]);
                formulas[k] = Some(self.formula(c, &owner, part));
            }
        }
        let Some(i) = c.marker(f.i, id) else {
            return;
        };
        let rm = match f.rm {
            Some(rm) => match c.marker(rm, id) {
                Some(rm) => Some(rm),
                None => return,
            },
            None => None,
        };
        let reaction = f.jfloat.and_then(|j| self.owner(c, j, id));
        let floating = f.jfloat.unwrap_or(0);
        // the floating marker has the place and the axes of I at every instant, and moves as I does
        let floats = |j: &u32| self.model.markers.get(j).is_some_and(|m| m.floating);
        if let Some(j) = f.jfloat.filter(floats) {
            self.scene.marker_of.entry(j).or_insert(i);
        }
        let law = ForceLaw::Vector { rm, formulas };
        self.scene.forces.push(ForceElement {
            id,
            i,
            j: None,
            floating,
            reaction,
            law,
        });
    }

    /// Returns the link of the part that owns a marker, also a floating one.
    fn owner(&self, c: &mut Compiler, marker: u32, asked_by: ElementId) -> Option<LinkIx> {
        let Some(body) = self.model.body_of(marker) else {
            let marker = ElementKind::Marker.id(marker);
            c.error(asked_by, format!("{marker} does not exist or has no part"));
            return None;
        };
        match c.part_of.get(&body) {
            Some(part) => Some(part.and_then(|p| c.parts[p].link)),
            None => {
                c.error(asked_by, format!("{body} does not exist"));
                None
            }
        }
    }
}
