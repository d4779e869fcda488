//! Joints, primitives, motions, couplers, gears, curves.

use super::{Draft, Maker, Want};
use crate::dataset::view::database::Reference;
use crate::diagnostic::{Cause, Diagnostic};
use crate::scalar::Scalar;
use crate::space::Vec3;

impl Maker<'_> {
    pub(super) fn make_constraints(&mut self) {
        for k in self.db.of_kind("constraint").collect::<Vec<_>>() {
            let Some(mut draft) = self.draft(k) else {
                continue;
            };
            let kind = self.db.objects[k].kind;
            let words: Vec<&str> = kind.split(' ').collect();
            match words[1..] {
                ["joint", word] => self.joint(&mut draft, k, word),
                ["primitive_joint", word] => {
                    let word = match word {
                        "parallel_axis" => "PARALLEL_AXES",
                        "at_point" => "ATPOINT",
                        "point_point" => {
                            self.refuse(k, "a distance between points (point_point)");
                            continue;
                        }
                        other => other,
                    };
                    draft.flag(word);
                    self.markers(&mut draft);
                }
                ["motion_generator"] => self.motion(&mut draft, k),
                ["complex_joint", "coupler"] => self.coupler(&mut draft, k),
                ["complex_joint", "gear"] => {
                    self.elements(&mut draft, "joint_name", "JOINTS");
                    self.element(&mut draft, "common_velocity_marker", "CV");
                }
                ["general_constraint"] => {
                    self.element(&mut draft, "i_marker_name", "I");
                    self.must_have_function(&mut draft, k, "function", "FUNCTION");
                }
                ["higher_pair_contact", "point_curve"] => {
                    self.element(&mut draft, "i_marker_name", "I");
                    self.element(&mut draft, "j_floating_marker_name", "JFLOAT");
                    self.element(&mut draft, "ref_marker_name", "RM");
                    self.element(&mut draft, "curve_name", "CURVE");
                    self.element(&mut draft, "ic_ref_marker_name", "ICM");
                    let starts = [("displacement_ic", "DISP"), ("velocity_ic", "VEL")];
                    self.numbers(&mut draft, &starts, true);
                }
                ["higher_pair_contact", _] => self.curve_pair(&mut draft),
                _ => {
                    self.refuse(k, "a constraint by a routine");
                    continue;
                }
            }
            self.push(draft);
        }
    }

    /// Says that an object is not read, which makes the model another one.
    pub(super) fn refuse(&self, k: usize, what: &str) {
        let name = self.db.inner_name(k);
        let d = Diagnostic::error(Cause::ViewUnsolved, format!("{name}: {what} is not solved"));
        let d = d.help("switch it off (active = off) or delete it to solve the model without it");
        self.say(k, "", d);
    }

    /// Gives I and J; one that is not given is a mistake.
    pub(super) fn markers(&self, draft: &mut Draft) {
        for (argument, keyword) in [("i_marker_name", "I"), ("j_marker_name", "J")] {
            self.element(draft, argument, keyword);
            let missing = |k: &usize| self.db.given(*k, argument).is_none();
            if let Some(k) = draft.object.filter(missing) {
                draft.record.mistaken = true;
                let what = format!("{} has no {argument}", self.db.inner_name(k));
                let d = Diagnostic::error("missing_argument", what);
                self.say(
                    k,
                    argument,
                    d.help("an argument on a further line needs & before it"),
                );
            }
        }
    }

    /// Gives a function, or USER with its routine; one that is not there is a mistake.
    pub(super) fn must_have_function(
        &self,
        draft: &mut Draft,
        k: usize,
        argument: &str,
        keyword: &str,
    ) {
        let has = self.user(draft, "user_function", "routine", keyword)
            || self.function(draft, argument, keyword);
        if !has {
            draft.record.mistaken = true;
            let name = self.db.inner_name(k);
            let d = Diagnostic::error("missing_argument", format!("{name} has no {argument}"));
            self.say(k, argument, d);
        }
    }

    /// Doubts markers that are read in their parts where joints would meet if they were read in
    /// ground.
    pub(super) fn doubt_frames(&self) {
        /// Share of the size of the mechanism within which two markers are one place.
        const MEETS: f64 = 1e-6;
        let mut gaps = [0.0_f64; 2];
        let mut size = 0.0_f64;
        let mut worst = None;
        for k in self.db.of_kind("constraint joint") {
            let word = self.db.objects[k]
                .kind
                .rsplit(' ')
                .next()
                .unwrap_or_default();
            if matches!(
                word,
                "translational" | "cylindrical" | "planar" | "rackpin" | "screw"
            ) {
                continue;
            }
            let side = |name: &str| {
                let marker = self.db.reference_of(k, name)?;
                let now = self.db.pose(marker).ok()?.position;
                Some((now, self.as_if_in_ground(marker).unwrap_or(now)))
            };
            let (Some(i), Some(j)) = (side("i_marker_name"), side("j_marker_name")) else {
                continue;
            };
            let (now, in_ground) = ((i.0 - j.0).norm(), (i.1 - j.1).norm());
            size = size.max(i.1.norm()).max(j.1.norm());
            if now > gaps[0] {
                worst = Some(k);
            }
            gaps = [gaps[0].max(now), gaps[1].max(in_ground)];
        }
        let Some(k) = worst.filter(|_| gaps[0] > MEETS * size && gaps[1] <= MEETS * size) else {
            return;
        };
        let what = format!(
            "its markers are {:.3e} apart where each is read in its part; read in ground, those of all such joints meet",
            gaps[0]
        );
        let model = self.db.model.clone().unwrap_or_default();
        let help = format!(
            "`defaults coordinate_system default_coordinate_system = {model}.ground` above the markers says that they are in ground"
        );
        self.say(k, "", Diagnostic::warning("view_frames", what).help(help));
    }

    /// Returns where a marker would stand if the numbers of its location were in ground; `None`
    /// where a frame was said.
    fn as_if_in_ground(&self, marker: usize) -> Option<Vec3<f64>> {
        let location = self.db.given(marker, "location")?;
        let is_said = *self.db.frame_of(location) != Reference::Own;
        let numbers = self.db.numbers(marker, "location").filter(|_| !is_said)?;
        <[f64; 3]>::try_from(numbers).ok().map(Vec3)
    }

    fn joint(&self, draft: &mut Draft, k: usize, word: &str) {
        let word = match word {
            "rigid" => "fixed",
            other => other,
        };
        draft.flag(word);
        self.markers(draft);
        let pairs = [("diameter_of_pitch", "PD"), ("pitch", "PITCH")];
        self.numbers(draft, &pairs, true);
        self.beginning(
            draft,
            k,
            ["translational_ic", "velocity_ic"],
            "ICTRAN",
            word,
        );
        self.beginning(
            draft,
            k,
            ["rotational_ic", "angular_velocity_ic"],
            "ICROT",
            word,
        );
        if self.db.is_on(k, "friction_enabled") == Some(true)
            || self
                .db
                .choice(k, "friction_enabled")
                .is_some_and(|w| w.starts_with("preload"))
        {
            draft.give(
                "FRICTION",
                Want::Word("ON".into()),
                self.db.span(k, "friction_enabled"),
            );
            let coefficients = [
                ("mu_dyn_rot", "MU_DYN_ROT"),
                ("mu_stat_rot", "MU_STAT_ROT"),
                ("max_fric_rot", "MAX_FRIC_ROT"),
                ("mu_dyn_trans", "MU_DYN_TRANS"),
                ("mu_stat_trans", "MU_STAT_TRANS"),
                ("max_fric_trans", "MAX_FRIC_TRANS"),
            ];
            self.numbers(draft, &coefficients, true);
        }
    }

    /// Gives displacement and velocity at the beginning: in a dataset of Adams View the velocity
    /// stands first.
    fn beginning(&self, draft: &mut Draft, k: usize, names: [&str; 2], keyword: &str, word: &str) {
        let is_angle = keyword == "ICROT";
        let [displacement, velocity] = names.map(|name| self.db.number(k, name));
        let both = match (displacement, velocity) {
            (Some(x), Some(v)) => vec![v, x],
            (Some(x), None) => vec![x],
            // a velocity alone goes with the displacement as drawn
            (None, Some(v)) => {
                let drawn = self.drawn(k, is_angle).unwrap_or(0.0);
                vec![v, drawn]
            }
            (None, None) => return,
        };
        let keyword = match (word, is_angle) {
            ("revolute", true) | ("translational", false) => "IC",
            _ => keyword,
        };
        let want = match is_angle {
            true => Want::Angles(both),
            false => Want::Numbers(both),
        };
        draft.give(keyword, want, self.db.span(k, names[0]));
    }

    /// Returns the displacement of a joint as it is drawn, in units of the file.
    fn drawn(&self, k: usize, is_angle: bool) -> Option<f64> {
        let i = self
            .db
            .pose(self.db.reference_of(k, "i_marker_name")?)
            .ok()?;
        let j = self
            .db
            .pose(self.db.reference_of(k, "j_marker_name")?)
            .ok()?;
        let local = j.inverse().compose(&i);
        let x = local.rotation.column(0).0;
        Some(match is_angle {
            true => Scalar::atan2(x[1], x[0]) / self.db.units.angle(),
            false => local.position.0[2],
        })
    }

    fn motion(&self, draft: &mut Draft, k: usize) {
        let freedom = self.db.choice(k, "type_of_freedom").unwrap_or_default();
        let is_turn = freedom.starts_with('r');
        let axis = self.db.choice(k, "axis");
        if self.db.given(k, "joint_name").is_some() {
            self.element(draft, "joint_name", "JOINT");
            if !freedom.is_empty() {
                draft.flag(if is_turn {
                    "ROTATIONAL"
                } else {
                    "TRANSLATIONAL"
                });
            }
        } else {
            self.markers(draft);
            let axis = axis.clone().unwrap_or_else(|| "z".into());
            if ["x", "y", "z", "b1", "b2", "b3"].contains(&axis.as_str()) {
                draft.flag(&axis);
            }
        }
        match self.db.choice(k, "time_derivative").unwrap_or_default() {
            word if word.starts_with('v') => draft.flag("VELOCITY"),
            word if word.starts_with('a') => draft.flag("ACCELERATION"),
            _ => {}
        }
        let turns = is_turn || axis.is_some_and(|axis| axis.starts_with('b'));
        for (argument, keyword, is_angle) in [
            ("displacement_ic", "ICDISP", turns),
            ("velocity_ic", "ICVEL", turns),
            ("rotational_displacement_ic", "ICDISP", true),
            ("rotational_velocity_ic", "ICVEL", true),
        ] {
            if let Some(numbers) = self.db.numbers(k, argument) {
                let want = match is_angle {
                    true => Want::Angles(numbers),
                    false => Want::Numbers(numbers),
                };
                draft.give(keyword, want, self.db.span(k, argument));
            }
        }
        self.must_have_function(draft, k, "function", "FUNCTION");
    }

    fn coupler(&self, draft: &mut Draft, k: usize) {
        self.elements(draft, "joint_name", "JOINTS");
        let freedom = match self.db.choice(k, "type_of_freedom") {
            Some(words) => Some(words),
            None => self.db.choice(k, "freedom_type"),
        };
        if let Some(words) = freedom {
            let letter = |word: &str| if word.starts_with('r') { "R" } else { "T" };
            let letters: Vec<String> = words.split('_').map(|w| letter(w).to_owned()).collect();
            draft.give(
                "TYPE",
                Want::Words(letters),
                self.db.span(k, "type_of_freedom"),
            );
        }
        if self.user(draft, "user_function", "routine", "FUNCTION") {
            return;
        }
        if let Some(scales) = self.db.numbers(k, "motion_multipliers") {
            draft.give(
                "SCALES",
                Want::Numbers(scales),
                self.db.span(k, "motion_multipliers"),
            );
            return;
        }
        let names = [
            ["first_scale_factor", "first_angular_scale_factor"],
            ["second_scale_factor", "second_angular_scale_factor"],
            ["third_scale_factor", "third_angular_scale_factor"],
        ];
        let scale = |pair: &[&str; 2]| pair.iter().find_map(|name| self.db.number(k, name));
        let scales: Vec<f64> = names.iter().map_while(scale).collect();
        if !scales.is_empty() {
            draft.give(
                "SCALES",
                Want::Numbers(scales),
                self.db.span(k, "joint_name"),
            );
        }
    }

    fn curve_pair(&self, draft: &mut Draft) {
        for (argument, keyword) in [
            ("i_curve_name", "ICURVE"),
            ("i_ref_marker_name", "IRM"),
            ("i_floating_marker_name", "IFLOAT"),
            ("j_curve_name", "JCURVE"),
            ("j_ref_marker_name", "JRM"),
            ("j_floating_marker_name", "JFLOAT"),
            ("i_ic_ref_marker_name", "IICM"),
            ("j_ic_ref_marker_name", "JICM"),
        ] {
            self.element(draft, argument, keyword);
        }
        let starts = [
            ("i_displacement_ic", "IDISP"),
            ("i_velocity_ic", "IVEL"),
            ("j_displacement_ic", "JDISP"),
            ("j_velocity_ic", "JVEL"),
        ];
        self.numbers(draft, &starts, true);
    }
}
