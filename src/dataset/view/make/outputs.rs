//! Sensors, requests, and settings of the solver and of results.

use super::{Draft, Maker, Want};
use crate::diagnostic::Span;

impl Maker<'_> {
    pub(super) fn make_outputs(&mut self) {
        for k in self
            .db
            .of_kind("executive_control sensor")
            .collect::<Vec<_>>()
        {
            let Some(mut draft) = self.draft(k) else {
                continue;
            };
            self.sensor(&mut draft, k);
            self.push(draft);
        }
        for k in self
            .db
            .of_kind("output_control request")
            .collect::<Vec<_>>()
        {
            let Some(mut draft) = self.draft(k) else {
                continue;
            };
            self.request(&mut draft, k);
            self.push(draft);
        }
    }

    fn sensor(&self, draft: &mut Draft, k: usize) {
        let compare = self.db.choice(k, "compare").unwrap_or_else(|| "eq".into());
        if ["eq", "ge", "le"].contains(&compare.as_str()) {
            draft.flag(&compare);
        }
        for (argument, keyword) in [("value", "VALUE"), ("error", "ERROR")] {
            if let Some(x) = self.db.numbers(k, argument) {
                draft.give(keyword, Want::Numbers(x), self.db.span(k, argument));
            }
        }
        for (argument, keyword) in [("angular_value", "VALUE"), ("angular_error", "ERROR")] {
            if let Some(x) = self.db.numbers(k, argument) {
                draft.give(keyword, Want::Angles(x), self.db.span(k, argument));
                if keyword == "VALUE" {
                    draft.flag("ANGULAR");
                }
            }
        }
        self.numbers(draft, &[("dt", "DT"), ("stepsize", "STEPSIZE")], true);
        let switches = [
            ("halt", "HALT"),
            ("print", "PRINT"),
            ("restart", "RESTART"),
            ("return", "RETURN"),
            ("codgen", "CODGEN"),
            ("yydump", "YYDUMP"),
            ("bisection", "BISECTION"),
        ];
        self.flags(draft, &switches);
        self.must_have_function(draft, k, "function", "FUNCTION");
        self.function(draft, "evaluate", "EVALUATE");
    }

    fn request(&self, draft: &mut Draft, k: usize) {
        let has_user = self.user(draft, "user_function", "routine", "FUNCTION");
        if let Some(kind) = self.db.choice(k, "output_type").filter(|_| !has_user) {
            let words = ["displacement", "velocity", "acceleration", "force"];
            if let Some(word) = words.iter().find(|w| w.starts_with(&kind)) {
                draft.flag(word);
            }
            self.element(draft, "i_marker_name", "I");
            self.element(draft, "j_marker_name", "J");
            self.element(draft, "r_marker_name", "RM");
        } else if !has_user {
            for n in 1..=8 {
                self.function(draft, &format!("f{n}"), &format!("F{n}"));
            }
        }
        let comment = self.db.texts(k, "comment").concat();
        if !comment.is_empty() {
            draft.give("COMMENT", Want::Text(comment), self.db.span(k, "comment"));
        }
        let name = self.db.texts(k, "results_name").concat();
        if !name.is_empty() {
            draft.give(
                "RESULTS_NAME",
                Want::Text(name),
                self.db.span(k, "results_name"),
            );
        }
        for (argument, keyword) in [
            ("component_names", "CNAMES"),
            ("component_units", "CUNITS"),
            ("component_labels", "CLABELS"),
        ] {
            let texts = self.db.texts(k, argument);
            if texts.iter().any(|t| !t.is_empty()) {
                draft.give(keyword, Want::Texts(texts), self.db.span(k, argument));
            }
        }
    }

    /// Units, and what the solver and the files of results are told.
    pub(super) fn make_settings(&mut self) {
        if let Some(mut draft) = self.setting("UNITS", Span::default()) {
            let [length, mass, force, time] = self.db.units.names();
            let pairs = [
                ("FORCE", force),
                ("MASS", mass),
                ("LENGTH", length),
                ("TIME", time),
            ];
            for (keyword, word) in pairs {
                draft.give(keyword, Want::Word(word.into()), Span::default());
            }
            self.push(draft);
        }
        for k in self.db.of_kind("executive_control set").collect::<Vec<_>>() {
            self.solver_settings(k);
        }
        for keyword in ["OUTPUT", "RESULTS"] {
            self.result_settings(keyword);
        }
    }

    fn solver_settings(&mut self, k: usize) {
        let kind = self.db.objects[k].kind;
        let head = self.db.objects[k].head;
        let (keyword, pairs): (&str, &[(&str, &str)]) = match kind {
            "executive_control set numerical_integration_parameters"
            | "executive_control set integrator_parameters gstiff"
            | "executive_control set integrator_parameters wstiff"
            | "executive_control set integrator_parameters dstiff" => (
                "INTEGRATOR",
                &[
                    ("error_tolerance", "ERROR"),
                    ("hinit_time_step", "HINIT"),
                    ("hmin_time_step", "HMIN"),
                    ("hmax_time_step", "HMAX"),
                    ("kmax_integrator_order", "KMAX"),
                    ("maxit_corrector_iterations", "MAXIT"),
                ],
            ),
            "executive_control set equilibrium_parameters" => (
                "EQUILIBRIUM",
                &[
                    ("tlimit", "TLIMIT"),
                    ("error", "ERROR"),
                    ("imbalance", "IMBALANCE"),
                    ("maxit", "MAXIT"),
                    ("stability", "STABILITY"),
                ],
            ),
            "executive_control set kinematics_parameters" => ("KINEMATICS", &[("hmax", "HMAX")]),
            "executive_control set preferences" => (
                "PREFERENCES",
                &[
                    ("contact_faceting_tolerance", "CONTACT_FACETING_TOLERANCE"),
                    ("thread_count", "NTHREADS"),
                ],
            ),
            _ => return,
        };
        let Some(mut draft) = self.setting(keyword, head) else {
            return;
        };
        draft.object = Some(k);
        if keyword == "INTEGRATOR" {
            self.method(&mut draft, k, kind);
            let pattern = self.db.texts(k, "pattern_for_jacobian");
            let letter = |w: &String| match w.to_ascii_lowercase().starts_with('y') {
                true => "T".to_owned(),
                false => "F".to_owned(),
            };
            let letters: Vec<String> = pattern.iter().map(letter).collect();
            if letters.iter().any(|letter| letter == "T") {
                let span = self.db.span(k, "pattern_for_jacobian");
                draft.give("PATTERN", Want::Words(letters), span);
            }
        }
        self.numbers(&mut draft, pairs, true);
        if keyword == "EQUILIBRIUM"
            && let Some(limit) = self.db.numbers(k, "alimit")
        {
            draft.give("ALIMIT", Want::Angles(limit), self.db.span(k, "alimit"));
        }
        if !draft.record.given.is_empty() {
            self.push(draft);
        }
    }

    fn method(&self, draft: &mut Draft, k: usize, kind: &str) {
        let known = [
            "gstiff",
            "wstiff",
            "hastiff",
            "hht",
            "newmark",
            "abam",
            "rkf45",
            "dstiff",
            "constant_bdf",
        ];
        let last = kind.rsplit(' ').next().unwrap_or_default();
        let word = self.db.choice(k, "integrator_type");
        let word = word.or_else(|| known.contains(&last).then(|| last.to_owned()));
        if let Some(word) = word.filter(|w| known.contains(&w.as_str())) {
            draft.flag(&word);
        }
        let formulation = self.db.choice(k, "formulation").unwrap_or_default();
        if ["i3", "si1", "si2"].contains(&formulation.as_str()) {
            draft.flag(&formulation);
        }
    }

    /// Makes what View writes into every dataset, with what the file adds or takes away.
    fn result_settings(&mut self, keyword: &str) {
        type Words = &'static [&'static str];
        type Pairs = &'static [(&'static str, &'static str)];
        let (kind, usual, on, off): (&str, Words, Pairs, Pairs) = match keyword {
            "RESULTS" => (
                "output_control set results",
                &["XRF"],
                &[("formatted", "FORMATTED")],
                &[
                    ("displacements", "NODISPLACEMENTS"),
                    ("velocities", "NOVELOCITIES"),
                    ("accelerations", "NOACCELERATIONS"),
                    ("reaction_forces", "NOREACTIONFORCES"),
                    ("applied_forces", "NOAPPLIEDFORCES"),
                    ("system_elements", "NOSYSTEMELEMENTS"),
                    ("floating_markers", "NOFLOATINGMARKERS"),
                    ("request", "NOREQUESTS"),
                ],
            ),
            _ => (
                "output_control set output",
                &["REQSAVE", "GRSAVE"],
                &[("ypr", "YPR")],
                &[("separator", "NOSEPARATOR")],
            ),
        };
        let object = self.db.of_kind(kind).next();
        let head = object.map_or(Span::default(), |k| self.db.objects[k].head);
        let Some(mut draft) = self.setting(keyword, head) else {
            return;
        };
        draft.object = object;
        let is_off = |argument: &str| {
            object.is_some_and(|k| self.db.is_on(k, &argument.to_ascii_lowercase()) == Some(false))
        };
        for word in usual {
            if !is_off(word) {
                draft.flag(word);
            }
        }
        self.flags(&mut draft, on);
        for (argument, keyword) in off {
            if is_off(argument) {
                draft.flag(keyword);
            }
        }
        if !draft.record.given.is_empty() {
            self.push(draft);
        }
    }
}
