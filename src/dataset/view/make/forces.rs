//! Forces, bushings, beams, springs, friction, contacts.

use super::{Draft, Maker, Want};
use crate::diagnostic::{Diagnostic, Severity};
use crate::model::ElementId;

impl Maker<'_> {
    pub(super) fn make_forces(&mut self) {
        let forces = self.db.of_kind("force").chain(self.db.of_kind("contact"));
        for k in forces.collect::<Vec<_>>() {
            let kind = self.db.objects[k].kind;
            if kind == "force body gravitational" {
                self.gravity(k);
                continue;
            }
            let Some(mut draft) = self.draft(k) else {
                continue;
            };
            let last = kind.rsplit(' ').next().unwrap_or_default();
            match last {
                "single_component_force" => self.single_force(&mut draft, k),
                "force_vector" | "torque_vector" | "general_force" => {
                    self.vector_force(&mut draft, k, last);
                }
                "multi_point_force" => {
                    self.elements(&mut draft, "i_marker_name", "IMARKERS");
                    self.element(&mut draft, "j_marker_name", "J");
                    self.element(&mut draft, "stiffness_matrix_name", "KMATRIX");
                    self.element(&mut draft, "damping_matrix_name", "CMATRIX");
                    self.element(&mut draft, "length_matrix_name", "LENGTH");
                    self.element(&mut draft, "force_matrix_name", "FORCE");
                    self.numbers(&mut draft, &[("damping_ratio", "CRATIO")], true);
                }
                "bushing" => self.bushing(&mut draft, k),
                "beam" => self.beam(&mut draft, k),
                "field" => self.field(&mut draft, k),
                "friction" => self.friction(&mut draft, k),
                "contact" => self.contact(&mut draft, k),
                _ => self.spring(&mut draft, k, last.starts_with("rotational")),
            }
            self.push(draft);
        }
    }

    fn gravity(&mut self, k: usize) {
        let Some(mut draft) = self.setting("ACCGRAV", self.db.objects[k].head) else {
            return;
        };
        draft.object = Some(k);
        let pairs = [
            ("x_component_gravity", "IGRAV"),
            ("y_component_gravity", "JGRAV"),
            ("z_component_gravity", "KGRAV"),
        ];
        self.numbers(&mut draft, &pairs, false);
        self.push(draft);
    }

    fn single_force(&self, draft: &mut Draft, k: usize) {
        let freedom = self.db.choice(k, "type_of_freedom").unwrap_or_default();
        draft.flag(match freedom.starts_with('r') {
            true => "ROTATIONAL",
            false => "TRANSLATIONAL",
        });
        self.markers(draft);
        self.flags(draft, &[("action_only", "ACTIONONLY")]);
        self.must_have_function(draft, k, "function", "FUNCTION");
    }

    fn vector_force(&self, draft: &mut Draft, k: usize, kind: &str) {
        self.element(draft, "i_marker_name", "I");
        self.element(draft, "j_floating_marker_name", "JFLOAT");
        self.element(draft, "ref_marker_name", "RM");
        let mut has = self.user(draft, "user_function", "routine", "FUNCTION");
        for (argument, keyword, is_force) in [
            ("x_force_function", "FX", true),
            ("y_force_function", "FY", true),
            ("z_force_function", "FZ", true),
            ("x_torque_function", "TX", false),
            ("y_torque_function", "TY", false),
            ("z_torque_function", "TZ", false),
        ] {
            let takes = match kind {
                "force_vector" => is_force,
                "torque_vector" => !is_force,
                _ => true,
            };
            has |= takes && self.function(draft, argument, keyword);
        }
        if !has {
            draft.record.mistaken = true;
            let name = self.db.inner_name(k);
            let d = Diagnostic::error("missing_argument", format!("{name} has no function"));
            self.say(k, "", d);
        }
    }

    /// Returns numbers per angle of the file as numbers per radian.
    fn per_radian(&self, numbers: Vec<f64>) -> Vec<f64> {
        let angle = self.db.units.angle();
        numbers.into_iter().map(|x| x / angle).collect()
    }

    fn bushing(&self, draft: &mut Draft, k: usize) {
        self.markers(draft);
        let pairs = [
            ("damping", "C"),
            ("stiffness", "K"),
            ("force_preload", "FORCE"),
            ("torque_preload", "TORQUE"),
        ];
        self.numbers(draft, &pairs, false);
        for (argument, keyword) in [("tdamping", "CT"), ("tstiffness", "KT")] {
            let numbers = self.db.numbers(k, argument).unwrap_or_default();
            if numbers.iter().any(|x| *x != 0.0) {
                let numbers = Want::Numbers(self.per_radian(numbers));
                draft.give(keyword, numbers, self.db.span(k, argument));
            }
        }
    }

    fn beam(&self, draft: &mut Draft, k: usize) {
        self.markers(draft);
        let pairs = [
            ("length", "LENGTH"),
            ("ixx", "IXX"),
            ("iyy", "IYY"),
            ("izz", "IZZ"),
            ("area_of_cross_section", "AREA"),
            ("youngs_modulus", "EMODULUS"),
            ("shear_modulus", "GMODULUS"),
            ("damping_ratio", "CRATIO"),
            ("matrix_of_damping_terms", "CMATRIX"),
        ];
        self.numbers(draft, &pairs, true);
        let shear = [("y_shear_area_ratio", "ASY"), ("z_shear_area_ratio", "ASZ")];
        self.numbers(draft, &shear, false);
        if let Some(word) = self.db.choice(k, "formulation") {
            let words = ["linear", "string", "nonlinear"];
            if let Some(full) = words.iter().find(|w| w.starts_with(&word)) {
                let span = self.db.span(k, "formulation");
                draft.give("FORMULATION", Want::Word((*full).into()), span);
            }
        }
    }

    fn field(&self, draft: &mut Draft, k: usize) {
        self.markers(draft);
        let matrices = [
            ("stiffness_matrix", "KMATRIX"),
            ("matrix_of_damping_terms", "CMATRIX"),
            ("damping_ratio", "CRATIO"),
        ];
        self.numbers(draft, &matrices, true);
        if self.db.units.in_degrees() && self.db.given(k, "stiffness_matrix").is_some() {
            let what = "a matrix of a FIELD is taken as it stands, with angles in radians";
            let d = Diagnostic {
                severity: Severity::Note,
                ..Diagnostic::warning("view_units", what)
            };
            self.say(k, "stiffness_matrix", d);
        }
        let six = |a: &str, b: &str| {
            let three = |name: &str| self.db.numbers(k, name).unwrap_or(vec![0.0; 3]);
            [three(a), three(b)].concat()
        };
        let loads = six("force_preload", "torque_preload");
        if loads.iter().any(|x| *x != 0.0) {
            draft.give(
                "FORCE",
                Want::Numbers(loads),
                self.db.span(k, "force_preload"),
            );
        }
        let mut free = six("translation_at_preload", "rotation_at_preload");
        if free.iter().any(|x| *x != 0.0) {
            let angle = self.db.units.angle();
            free.iter_mut().skip(3).for_each(|x| *x *= angle);
            let span = self.db.span(k, "translation_at_preload");
            draft.give("LENGTH", Want::Numbers(free), span);
        }
        self.user(draft, "user_function", "routine", "FUNCTION");
    }

    fn spring(&self, draft: &mut Draft, k: usize, turns: bool) {
        draft.flag(if turns { "ROTATIONAL" } else { "TRANSLATIONAL" });
        self.markers(draft);
        if !turns {
            let pairs = [
                ("stiffness", "K"),
                ("damping", "C"),
                ("preload", "FORCE"),
                ("displacement_at_preload", "LENGTH"),
            ];
            return self.numbers(draft, &pairs, true);
        }
        for (argument, keyword) in [("stiffness", "KT"), ("damping", "CT")] {
            if let Some(numbers) = self.db.numbers(k, argument) {
                let numbers = Want::Numbers(self.per_radian(numbers));
                draft.give(keyword, numbers, self.db.span(k, argument));
            }
        }
        self.numbers(draft, &[("preload", "TORQUE")], true);
        if let Some(angle) = self.db.numbers(k, "displacement_at_preload") {
            let span = self.db.span(k, "displacement_at_preload");
            draft.give("ANGLE", Want::Angles(angle), span);
        }
    }

    fn friction(&self, draft: &mut Draft, k: usize) {
        self.element(draft, "joint_name", "JOINT");
        let pairs = [
            ("mu_static", "MU_STATIC"),
            ("mu_dynamic", "MU_DYNAMIC"),
            (
                "stiction_transition_velocity",
                "STICTION_TRANSITION_VELOCITY",
            ),
            ("max_stiction_deformation", "MAX_STICTION_DEFORMATION"),
            ("friction_arm", "FRICTION_ARM"),
            ("bending_reaction_arm", "BENDING_REACTION_ARM"),
            ("pin_radius", "PIN_RADIUS"),
            ("ball_radius", "BALL_RADIUS"),
            ("reaction_arm", "REACTION_ARM"),
            ("initial_overlap", "INITIAL_OVERLAP"),
            ("friction_force_preload", "FRICTION_FORCE_PRELOAD"),
            ("friction_torque_preload", "FRICTION_TORQUE_PRELOAD"),
        ];
        self.numbers(draft, &pairs, true);
        let inputs = [
            ("preload", "PRELOAD"),
            ("reaction_force", "REACTION_FORCE"),
            ("bending_moment", "BENDING_MOMENT"),
            ("torsional_moment", "TORSIONAL_MOMENT"),
        ];
        let given: Vec<(&str, bool)> = inputs
            .iter()
            .filter_map(|(argument, word)| Some((*word, self.db.is_on(k, argument)?)))
            .collect();
        if given.iter().any(|(_, on)| !on) {
            let on = inputs
                .iter()
                .filter(|(argument, _)| self.db.is_on(k, argument) != Some(false));
            let on: Vec<String> = on.map(|(_, word)| (*word).to_owned()).collect();
            let words = if on.is_empty() {
                vec!["NONE".to_owned()]
            } else {
                on
            };
            draft.give("INPUTS", Want::Words(words), self.db.span(k, "preload"));
        }
        for (argument, keyword, words) in [
            ("effect", "EFFECT", &["ALL", "STICTION", "SLIDING"][..]),
            (
                "overlap_delta",
                "OVERLAP_DELTA",
                &["CONSTANT", "INCREASE", "DECREASE"],
            ),
            ("formulation", "FORMULATION", &["ORIGINAL", "LUGRE"]),
        ] {
            let typed = self.db.word(k, argument).unwrap_or_default().to_uppercase();
            let full = words
                .iter()
                .find(|w| !typed.is_empty() && w.starts_with(&typed));
            if let Some(full) = full {
                draft.give(
                    keyword,
                    Want::Word((*full).into()),
                    self.db.span(k, argument),
                );
            }
        }
        if self.db.is_on(k, "inactive_during_static") == Some(true) {
            let span = self.db.span(k, "inactive_during_static");
            draft.give("INACTIVE", Want::Word("STATIC".into()), span);
        }
    }

    fn contact(&mut self, draft: &mut Draft, k: usize) {
        for (argument, keyword) in [("i_geometry_name", "IGEOM"), ("j_geometry_name", "JGEOM")] {
            let mut all: Vec<ElementId> = Vec::new();
            for name in self.db.texts(k, argument) {
                let ids = match self.db.find(&name) {
                    Some(shape) => self.shapes_of(k, shape),
                    None => self.imported(k, argument, &name),
                };
                draft.record.mistaken |= ids.is_empty();
                all.extend(ids);
            }
            if !all.is_empty() {
                draft.give(keyword, Want::Ids(all), self.db.span(k, argument));
            }
        }
        let pairs = [
            ("stiffness", "STIFFNESS"),
            ("damping", "DAMPING"),
            ("dmax", "DMAX"),
            ("exponent", "EXPONENT"),
            ("penalty", "PENALTY"),
            ("restitution_coefficient", "RESTITUTION_COEFFICIENT"),
            ("mu_static", "MU_STATIC"),
            ("mu_dynamic", "MU_DYNAMIC"),
            (
                "stiction_transition_velocity",
                "STICTION_TRANSITION_VELOCITY",
            ),
            (
                "friction_transition_velocity",
                "FRICTION_TRANSITION_VELOCITY",
            ),
            ("max_stiction_deformation", "MAX_STICTION_DEFORMATION"),
        ];
        let friction = self.db.choice(k, "coulomb_friction").unwrap_or_default();
        let slides = matches!(friction.as_str(), "on" | "dynamics_only");
        let used = pairs.into_iter().filter(|(_, keyword)| {
            let of_friction = keyword.contains("MU_")
                || keyword.contains("TRANSITION")
                || keyword.contains("DEFORMATION");
            slides || !of_friction
        });
        let used: Vec<(&str, &str)> = used.collect();
        if let Some(kind) = self.db.word(k, "type").filter(|w| !w.is_empty()) {
            draft.give("TYPE", Want::Word(kind), self.db.span(k, "type"));
        }
        draft.flag(match self.db.given(k, "restitution_coefficient") {
            Some(_) => "POISSON",
            None => "IMPACT",
        });
        self.numbers(draft, &used, true);
        if slides {
            let span = self.db.span(k, "coulomb_friction");
            draft.give("COULOMB_FRICTION", Want::Word(friction), span);
        }
        self.flags(
            draft,
            &[(
                "augmented_lagrangian_formulation",
                "AUGMENTED_LAGRANGIAN_FORMULATION",
            )],
        );
        if self
            .db
            .given(k, "normal_function")
            .is_some_and(|_| !self.db.texts(k, "normal_function").concat().is_empty())
        {
            self.refuse(k, "a contact by a routine");
        }
    }
}
