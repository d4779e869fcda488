//! Rules of what does not fit together in a model: a function each, all of them run, all findings
//! reported.
//!
//! A rule reads the model and says what is wrong with which element, and what to do. Rules about
//! geometry in motion (freedom, redundancy, lock-up) belong to the analyses; here stands what the
//! statements themselves contradict.

pub(crate) mod alignment;
pub(crate) mod angles;
mod beginnings;
mod between;
mod bodies;
mod constraints;
mod constraints_twice;
mod contacts;
mod couplings;
mod curves;
mod forces;
mod held;
mod ignored;
mod magnitudes;
pub(crate) mod names;
mod output;
pub(crate) mod references;
mod signs;
mod superseded;
mod systems;
mod turning;

use super::*;
use crate::arrange::Arrange;
use crate::diagnostic::{Diagnostic, Severity, near_names};

/// Where findings go.
type Out = Vec<Diagnostic>;

/// Name of a rule and the rule.
type Rule = (&'static str, fn(&Model, &mut Out));

/// Rules that find warnings at most: who wants errors alone need not run them.
const ONLY_WARN: &[&str] = &[
    "forces act where asked",
    "gravity is plausible",
    "inertia fits its part",
    "springs have their length",
    "beams have their length",
    "friction has the size of joints",
    "stiffness can be resolved",
    "names are used once",
];

/// Returns what is doubted of settings that a command changes, of which the model has nothing else.
pub(crate) fn doubted_settings(model: &Model) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    magnitudes::errors_are_small(model, &mut found);
    found
}

/// All rules, in the order in which they run.
pub const RULES: &[Rule] = &[
    ("references exist", references::references_exist),
    ("exactly one ground", bodies::one_ground),
    ("mass has a place", bodies::mass_has_a_centre),
    ("inertia is possible", bodies::inertia_is_possible),
    ("axes have directions", bodies::axes_have_directions),
    ("angles are radians", angles::angles_are_radians),
    (
        "constraints join two parts",
        constraints::constraints_join_two_parts,
    ),
    (
        "floating markers have one owner",
        bodies::floating_markers_have_one_owner,
    ),
    ("joints are complete", constraints::joints_are_complete),
    (
        "motions fit their joints",
        constraints::motions_fit_their_joints,
    ),
    (
        "couplers fit their joints",
        couplings::couplers_fit_their_joints,
    ),
    ("gears share a carrier", couplings::gears_share_a_carrier),
    ("point masses do not turn", bodies::point_masses_do_not_turn),
    ("splines are functions", systems::splines_are_functions),
    ("arrays have their size", systems::arrays_have_their_size),
    (
        "systems have their arrays",
        systems::systems_have_their_arrays,
    ),
    ("sensors watch something", systems::sensors_watch_something),
    ("curves have points", curves::curves_have_points),
    ("forces have data", forces::forces_have_data),
    ("contacts have their law", contacts::contacts_have_their_law),
    ("axes are aligned", alignment::axes_are_aligned),
    (
        "pinions lie on their side",
        alignment::pinions_lie_on_their_side,
    ),
    ("requests ask something", output::requests_ask_something),
    ("forces act where asked", between::forces_act_where_asked),
    (
        "many requests ask something",
        output::many_requests_ask_something,
    ),
    ("units are known", output::units_are_known),
    (
        "initial conditions say what is first",
        constraints::initial_conditions_say_what_is_first,
    ),
    (
        "beginnings have their elements",
        beginnings::beginnings_have_their_elements,
    ),
    ("gravity is plausible", magnitudes::gravity_is_plausible),
    ("inertia fits its part", magnitudes::inertia_fits_its_part),
    (
        "springs have their length",
        magnitudes::springs_have_their_length,
    ),
    (
        "beams have their length",
        magnitudes::beams_have_their_length,
    ),
    (
        "friction has the size of joints",
        magnitudes::friction_has_the_size_of_joints,
    ),
    ("errors are small", magnitudes::errors_are_small),
    (
        "stiffness can be resolved",
        magnitudes::stiffness_can_be_resolved,
    ),
    ("names are used once", names::names_are_used_once),
    ("laws resist", signs::laws_resist),
    ("contacts resist", signs::contacts_resist),
    ("shapes have sizes", signs::shapes_have_sizes),
    ("arguments are read", ignored::arguments_are_read),
    ("functions can be read", references::functions_can_be_read),
];

/// All doubts about the mechanism that a model without mistakes makes: joints that stand twice or
/// not at all, parts that nothing holds, forces without units.
pub const DOUBTS: &[Rule] = &[
    ("parts are held", held::parts_are_held),
    ("torques have an axis", held::torques_have_an_axis),
    ("joints are not forgotten", held::joints_are_not_forgotten),
    (
        "joints have no old friction",
        superseded::joints_have_no_old_friction,
    ),
    (
        "angles are asked where joints turn",
        turning::angles_are_asked_where_joints_turn,
    ),
    ("joints stand once", constraints_twice::joints_stand_once),
    ("units are given", magnitudes::units_are_given),
];

impl Model {
    /// Returns everything that does not fit together in a model whose numbers are finite, in the
    /// order of the elements' lines.
    pub(crate) fn contradictions(&self) -> Vec<Diagnostic> {
        let mut out = Vec::new();
        for (name, rule) in RULES {
            let before = out.len();
            rule(self, &mut out);
            let mut found = out[before..].iter();
            debug_assert!(
                !ONLY_WARN.contains(name) || found.all(|d| d.severity != Severity::Error),
                "the rule \"{name}\" finds errors"
            );
        }
        out.arrange_by_key(|d| (d.line, d.column));
        out
    }

    /// Returns the errors among what does not fit together, in the same order.
    pub(crate) fn errors(&self) -> Vec<Diagnostic> {
        let mut out = Vec::new();
        for (_, rule) in RULES.iter().filter(|(name, _)| !ONLY_WARN.contains(name)) {
            rule(self, &mut out);
        }
        out.retain(|d| d.severity == Severity::Error);
        out.arrange_by_key(|d| (d.line, d.column));
        out
    }

    /// Doubts about the mechanism as a whole, of a model without mistakes, in the order of the
    /// elements' lines.
    pub fn doubts(&self) -> Vec<Diagnostic> {
        let mut out = Vec::new();
        for (_, doubt) in DOUBTS {
            doubt(self, &mut out);
        }
        // what is about no element comes last
        out.arrange_by_key(|d| (d.line == 0, d.line, d.column));
        out
    }
}

/// The element that a finding is about, and where it stands.
type Who<'a> = (ElementId, &'a Place);

fn about(d: Diagnostic, (id, place): Who) -> Diagnostic {
    let mut d = d.element(id);
    (d.line, d.column) = (place.line, usize::from(place.line > 0));
    d
}

fn error(out: &mut Out, code: &'static str, who: Who, message: String) {
    out.push(about(Diagnostic::error(code, message), who));
}

fn warn(out: &mut Out, code: &'static str, who: Who, message: String) {
    out.push(about(Diagnostic::warning(code, message), who));
}

/// Says that the last finding is about an argument of its element.
fn at_argument(out: &mut Out, argument: &'static str) {
    if let Some(d) = out.last_mut() {
        d.argument = Some(argument);
    }
}

fn advise(out: &mut Out, advice: impl Into<String>) {
    if let Some(d) = out.last_mut() {
        d.help.push(advice.into());
    }
}

/// "did you mean …?" among the numbers in use.
fn near(number: u32, known: &[u32]) -> Option<String> {
    if number < 10 {
        return None; // every digit is near every other
    }
    let known: Vec<String> = known.iter().map(u32::to_string).collect();
    let near = near_names(&number.to_string(), known.iter().map(String::as_str));
    (!near.is_empty()).then(|| format!("did you mean {}?", near.join(" or ")))
}
