//! What does not fit together in a model: one function per rule, all of them run, all findings reported.
//!
//! A rule reads the model and says what is wrong with which element, and what to do. Rules about geometry in motion
//! (freedom, redundancy, lock-up) belong to the analyses; here stands what the statements themselves contradict.

use super::reference::Target;
use super::*;
use crate::diagnostic::{Diagnostic, near_names};
use crate::expr::Expr;
use crate::expr::ast::Node;
use crate::expr::signature;
use nalgebra::Matrix3;
use std::collections::BTreeMap;

/// Where findings go.
type Out = Vec<Diagnostic>;

/// Name of a rule and the rule.
type Rule = (&'static str, fn(&Model, &mut Out));

/// All rules, in the order in which they run.
pub const RULES: &[Rule] = &[
    ("references exist", references_exist),
    ("exactly one ground", one_ground),
    ("mass has a place", mass_has_a_centre),
    ("inertia is possible", inertia_is_possible),
    ("axes have directions", axes_have_directions),
    ("constraints join two parts", constraints_join_two_parts),
    (
        "floating markers have one owner",
        floating_markers_have_one_owner,
    ),
    ("joints are complete", joints_are_complete),
    ("motions fit their joints", motions_fit_their_joints),
    ("couplers fit their joints", couplers_fit_their_joints),
    ("gears share a carrier", gears_share_a_carrier),
    ("point masses do not turn", point_masses_do_not_turn),
    ("splines are functions", splines_are_functions),
    ("arrays have their size", arrays_have_their_size),
    ("systems have their arrays", systems_have_their_arrays),
    ("curves have points", curves_have_points),
    ("forces have data", forces_have_data),
    ("requests ask something", requests_ask_something),
    ("units are known", units_are_known),
    ("functions can be read", functions_can_be_read),
];

impl Model {
    /// Everything that does not fit together, in the order of the elements' lines.
    ///
    /// # Examples
    /// ```
    /// use cognate::model::{Joint, Model};
    /// let mut model = Model::default();
    /// model.joints.insert(3, Joint { i: 12, j: 21, ..Joint::default() });
    /// let found = model.check();
    /// assert!(found.iter().any(|d| d.message == "I = 12: MARKER/12 does not exist"));
    /// ```
    pub fn check(&self) -> Vec<Diagnostic> {
        let mut out = Vec::new();
        for (_, rule) in RULES {
            rule(self, &mut out);
        }
        out.sort_by_key(|d| (d.line, d.column));
        out
    }
}

fn about(d: Diagnostic, keyword: &str, id: u32, place: &Place) -> Diagnostic {
    let mut d = d.element(format!("{keyword}/{id}"));
    (d.line, d.column) = (place.line, usize::from(place.line > 0));
    d
}

fn error(
    out: &mut Out,
    code: &'static str,
    (keyword, id, place): (&str, u32, &Place),
    message: String,
) {
    out.push(about(Diagnostic::error(code, message), keyword, id, place));
}

fn warn(
    out: &mut Out,
    code: &'static str,
    (keyword, id, place): (&str, u32, &Place),
    message: String,
) {
    out.push(about(
        Diagnostic::warning(code, message),
        keyword,
        id,
        place,
    ));
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

fn references_exist(model: &Model, out: &mut Out) {
    for r in model.references() {
        if model.has(r.target, r.number) {
            continue;
        }
        let what = r.target.keyword();
        let message = format!("{} = {1}: {what}/{1} does not exist", r.argument, r.number);
        error(out, "unknown_element", (r.keyword, r.id, r.place), message);
        if let Some(advice) = near(r.number, &model.numbers(r.target)) {
            advise(out, advice);
        }
    }
}

fn one_ground(model: &Model, out: &mut Out) {
    let grounds: Vec<_> = model.parts.iter().filter(|(_, p)| p.ground).collect();
    if grounds.is_empty() {
        out.push(
            Diagnostic::error("no_ground", "no part is GROUND")
                .help("one part must be it, as in PART/1, GROUND"),
        );
    }
    for &(&id, part) in grounds.iter().skip(1) {
        let message = format!("a second ground; PART/{} is GROUND already", grounds[0].0);
        error(out, "several_grounds", ("PART", id, &part.place), message);
    }
    for &(&id, part) in &grounds {
        if part.mass != 0.0 {
            let message = "ground has a mass, which means nothing".to_owned();
            warn(out, "mass_of_ground", ("PART", id, &part.place), message);
        }
    }
}

/// Parts and point masses with their statement.
fn bodies(model: &Model) -> impl Iterator<Item = (&'static str, u32, &Part)> {
    let parts = model.parts.iter().map(|(&id, p)| ("PART", id, p));
    parts.chain(
        model
            .point_masses
            .iter()
            .map(|(&id, p)| ("POINT_MASS", id, p)),
    )
}

fn mass_has_a_centre(model: &Model, out: &mut Out) {
    for (keyword, id, part) in bodies(model) {
        let who = (keyword, id, &part.place);
        if part.mass < 0.0 {
            error(
                out,
                "negative_mass",
                who,
                format!("the mass {} is negative", part.mass),
            );
        }
        if part.mass > 0.0 && part.cm.is_none() && !part.ground {
            error(
                out,
                "mass_without_cm",
                who,
                "it has a mass but no CM".into(),
            );
            advise(out, "CM names the marker at the centre of mass");
        }
        if part.ip != [0.0; 6] && part.cm.is_none() && part.im.is_none() && !part.ground {
            error(
                out,
                "inertia_without_marker",
                who,
                "it has IP but neither CM nor IM".into(),
            );
        }
        for (name, marker) in [("CM", part.cm), ("IM", part.im)] {
            let Some(m) = marker.and_then(|m| model.markers.get(&m).map(|_| m)) else {
                continue;
            };
            let own = (keyword == "POINT_MASS", id);
            if model.body_of(m).is_some_and(|b| b != own) {
                error(
                    out,
                    "marker_of_another_part",
                    who,
                    format!("{name} = {m}: MARKER/{m} belongs to another part"),
                );
            }
            if model.markers[&m].floating {
                error(
                    out,
                    "floating_marker",
                    who,
                    format!("{name} = {m}: MARKER/{m} is FLOATING"),
                );
            }
        }
    }
}

/// The inertia tensor is that of some distribution of mass: positive, and no moment larger than the two others together.
fn inertia_is_possible(model: &Model, out: &mut Out) {
    const TOLERANCE: f64 = 1e-3;
    for (keyword, id, part) in bodies(model) {
        let who = (keyword, id, &part.place);
        let scale = part.ip.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        if scale == 0.0 || !scale.is_finite() {
            continue;
        }
        let [xx, yy, zz, xy, xz, yz] = part.ip.map(|x| x / scale);
        if xx < 0.0 || yy < 0.0 || zz < 0.0 {
            error(
                out,
                "negative_inertia",
                who,
                "a moment of inertia in IP is negative".into(),
            );
            continue;
        }
        let j = Matrix3::new(xx, -xy, -xz, -xy, yy, -yz, -xz, -yz, zz);
        let mut moments: Vec<f64> = j.symmetric_eigenvalues().iter().copied().collect();
        moments.sort_by(f64::total_cmp);
        if moments[0] < -TOLERANCE {
            let message = "the products in IP are too large: no body has this inertia".to_owned();
            warn(out, "impossible_inertia", who, message);
            advise(
                out,
                "IP is xx, yy, zz, xy, xz, yz; the products are the positive integrals of xy dm …",
            );
        } else if moments[2] > (moments[0] + moments[1]) * (1.0 + TOLERANCE) {
            let message = "one principal moment is larger than the two others together: no body has this inertia".to_owned();
            warn(out, "impossible_inertia", who, message);
        }
    }
}

fn axes_have_directions(model: &Model, out: &mut Out) {
    let mut check = |who: (&str, u32, &Place),
                     origin: [f64; 3],
                     orientation: &Orientation,
                     names: [&str; 3]| {
        let Orientation::Points { z, x, .. } = orientation else {
            return;
        };
        for (point, name) in [(z, names[0]), (x, names[1])] {
            if *point == Some(origin) {
                let message = format!("{name} is the origin {}: it gives no direction", names[2]);
                error(out, "no_direction", who, message);
            }
        }
        if z.is_some() && z == x {
            let message = format!("{} and {} are the same point", names[0], names[1]);
            error(out, "no_direction", who, message);
        }
    };
    for (keyword, id, p) in bodies(model) {
        check(
            (keyword, id, &p.place),
            p.qg,
            &p.orientation,
            ["ZG", "XG", "QG"],
        );
    }
    for (&id, m) in &model.markers {
        check(
            ("MARKER", id, &m.place),
            m.qp,
            &m.orientation,
            ["ZP", "XP", "QP"],
        );
    }
}

/// The two markers of an element with their owner.
type Pair<'a> = (&'static str, u32, &'a Place, u32, u32);

fn constraint_pairs(model: &Model) -> Vec<Pair<'_>> {
    let joints = model
        .joints
        .iter()
        .map(|(&id, j)| ("JOINT", id, &j.place, j.i, j.j));
    let primitives = model
        .primitives
        .iter()
        .map(|(&id, j)| ("JPRIM", id, &j.place, j.i, j.j));
    let motions = model.motions.iter().filter_map(|(&id, m)| match m.driven {
        Driven::Markers { i, j, .. } => Some(("MOTION", id, &m.place, i, j)),
        _ => None,
    });
    let cams = model
        .points_on_curves
        .iter()
        .map(|(&id, p)| ("PTCV", id, &p.place, p.i, p.rm));
    let rolls = model
        .curves_on_curves
        .iter()
        .map(|(&id, c)| ("CVCV", id, &c.place, c.i.rm, c.j.rm));
    joints
        .chain(primitives)
        .chain(motions)
        .chain(cams)
        .chain(rolls)
        .collect()
}

fn spring_pairs(model: &Model) -> Vec<Pair<'_>> {
    let springs = model
        .spring_dampers
        .iter()
        .map(|(&id, f)| ("SPRINGDAMPER", id, &f.place, f.i, f.j));
    let bushings = model
        .bushings
        .iter()
        .map(|(&id, f)| ("BUSHING", id, &f.place, f.i, f.j));
    let fields = model
        .fields
        .iter()
        .map(|(&id, f)| ("FIELD", id, &f.place, f.i, f.j));
    let beams = model
        .beams
        .iter()
        .map(|(&id, f)| ("BEAM", id, &f.place, f.i, f.j));
    springs.chain(bushings).chain(fields).chain(beams).collect()
}

fn constraints_join_two_parts(model: &Model, out: &mut Out) {
    let same = |i, j| {
        model
            .body_of(i)
            .is_some_and(|b| model.body_of(j) == Some(b))
    };
    let body = |i| match model.body_of(i) {
        Some((false, n)) => format!("PART/{n}"),
        Some((true, n)) => format!("POINT_MASS/{n}"),
        None => "the same body".into(),
    };
    for (keyword, id, place, i, j) in constraint_pairs(model) {
        if same(i, j) {
            let message = format!(
                "both its markers belong to {}: it constrains nothing",
                body(i)
            );
            error(out, "same_part", (keyword, id, place), message);
        }
    }
    for (keyword, id, place, i, j) in spring_pairs(model) {
        if same(i, j) {
            let message = format!("both its markers belong to {}: it never acts", body(i));
            warn(out, "same_part", (keyword, id, place), message);
        }
    }
}

/// A floating marker gets its frame from the one element that owns it.
fn floating_markers_have_one_owner(model: &Model, out: &mut Out) {
    const OWNING: &[&str] = &["JFLOAT", "IFLOAT"];
    let mut owners: BTreeMap<u32, String> = BTreeMap::new();
    for r in model
        .references()
        .iter()
        .filter(|r| OWNING.contains(&r.argument))
    {
        let Some(marker) = model.markers.get(&r.number) else {
            continue;
        };
        let who = (r.keyword, r.id, r.place);
        if !marker.floating {
            let message = format!("{} = {1}: MARKER/{1} is not FLOATING", r.argument, r.number);
            warn(out, "not_floating", who, message);
            continue;
        }
        let owner = format!("{}/{}", r.keyword, r.id);
        if let Some(first) = owners.get(&r.number).filter(|f| **f != owner) {
            let message = format!(
                "{} = {1}: the floating MARKER/{1} belongs to {first} already",
                r.argument, r.number
            );
            error(out, "floating_marker_shared", who, message);
            advise(out, "each such element needs a floating marker of its own");
        }
        owners.entry(r.number).or_insert(owner);
    }
    for (keyword, id, place, i, j) in constraint_pairs(model)
        .into_iter()
        .chain(spring_pairs(model))
    {
        for (name, m) in [("I", i), ("J", j)] {
            if model.markers.get(&m).is_some_and(|m| m.floating) {
                let message =
                    format!("{name} = {m}: MARKER/{m} is FLOATING and has no frame of its own");
                error(out, "floating_marker", (keyword, id, place), message);
            }
        }
    }
}

fn joints_are_complete(model: &Model, out: &mut Out) {
    for (&id, j) in &model.joints {
        let who = ("JOINT", id, &j.place);
        match j.kind {
            JointKind::Screw if j.pitch.is_none() => {
                error(
                    out,
                    "missing_argument",
                    who,
                    "a SCREW needs PITCH = translation per turn".into(),
                );
            }
            JointKind::Rackpin if j.pd.is_none() => {
                error(
                    out,
                    "missing_argument",
                    who,
                    "a RACKPIN needs PD = pitch diameter".into(),
                );
            }
            JointKind::Rackpin if j.pd == Some(0.0) => {
                error(
                    out,
                    "unfit_value",
                    who,
                    "the pitch diameter PD is zero".into(),
                );
            }
            _ => {}
        }
        let turns = matches!(j.kind, JointKind::Revolute | JointKind::Cylindrical);
        let slides = matches!(j.kind, JointKind::Translational | JointKind::Cylindrical);
        if !turns && j.ic_rotation != [None; 2] || !slides && j.ic_translation != [None; 2] {
            let message = format!(
                "{} has no such freedom: its initial condition is not used",
                joint_word(j.kind)
            );
            warn(out, "unused_initial_condition", who, message);
        }
    }
}

fn joint_word(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Fixed => "FIXED",
        JointKind::Revolute => "REVOLUTE",
        JointKind::Translational => "TRANSLATIONAL",
        JointKind::Cylindrical => "CYLINDRICAL",
        JointKind::Spherical => "SPHERICAL",
        JointKind::Planar => "PLANAR",
        JointKind::Universal => "UNIVERSAL",
        JointKind::Hooke => "HOOKE",
        JointKind::Convel => "CONVEL",
        JointKind::Rackpin => "RACKPIN",
        JointKind::Screw => "SCREW",
    }
}

fn motions_fit_their_joints(model: &Model, out: &mut Out) {
    let mut driven: BTreeMap<(u32, bool), u32> = BTreeMap::new();
    for (&id, m) in &model.motions {
        let who = ("MOTION", id, &m.place);
        let (joint, rotation) = match m.driven {
            Driven::Joint(n) => (n, None),
            Driven::JointRotation(n) => (n, Some(true)),
            Driven::JointTranslation(n) => (n, Some(false)),
            Driven::Markers { component, .. } => {
                // The reader has said so already.
                if component > 5 && m.place.line == 0 {
                    error(
                        out,
                        "missing_argument",
                        who,
                        "one of X, Y, Z, B1, B2, B3 is needed".into(),
                    );
                }
                continue;
            }
        };
        let Some(kind) = model.joints.get(&joint).map(|j| j.kind) else {
            continue;
        };
        let word = joint_word(kind);
        let turns = match (kind, rotation) {
            (JointKind::Revolute, None | Some(true)) => true,
            (JointKind::Translational, None | Some(false)) => false,
            (JointKind::Cylindrical, Some(turns)) => turns,
            (JointKind::Cylindrical, None) => {
                let message =
                    format!("JOINT/{joint} is CYLINDRICAL: ROTATION or TRANSLATION is needed");
                error(out, "missing_argument", who, message);
                continue;
            }
            (JointKind::Revolute | JointKind::Translational, Some(turns)) => {
                let what = if turns { "rotation" } else { "translation" };
                error(
                    out,
                    "motion_on_wrong_joint",
                    who,
                    format!("JOINT/{joint} is {word} and has no {what}"),
                );
                continue;
            }
            _ => {
                error(
                    out,
                    "motion_on_wrong_joint",
                    who,
                    format!("JOINT/{joint} is {word}: no motion can drive it"),
                );
                advise(
                    out,
                    "a motion drives a REVOLUTE, TRANSLATIONAL or CYLINDRICAL joint, or one component between two markers (I, J)",
                );
                continue;
            }
        };
        let inactive = |n: u32| model.inactive.contains(&("MOTION".to_owned(), n));
        if let Some(&first) = driven
            .get(&(joint, turns))
            .filter(|&&f| !inactive(f) && !inactive(id))
        {
            error(
                out,
                "driven_twice",
                who,
                format!("MOTION/{first} drives JOINT/{joint} already"),
            );
        }
        driven.entry((joint, turns)).or_insert(id);
    }
}

fn couplers_fit_their_joints(model: &Model, out: &mut Out) {
    for (&id, c) in &model.couplers {
        let who = ("COUPLER", id, &c.place);
        for (k, joint) in c.joints.iter().enumerate() {
            if c.joints[..k].contains(joint) {
                error(
                    out,
                    "contradiction",
                    who,
                    format!("JOINT/{joint} stands twice in JOINTS"),
                );
            }
            let Some(kind) = model.joints.get(joint).map(|j| j.kind) else {
                continue;
            };
            let word = joint_word(kind);
            match (kind, c.rotational.get(k).copied().flatten()) {
                (JointKind::Revolute, Some(false)) => {
                    error(
                        out,
                        "contradiction",
                        who,
                        format!("TYPE says T for JOINT/{joint}, which is REVOLUTE"),
                    );
                }
                (JointKind::Translational, Some(true)) => {
                    error(
                        out,
                        "contradiction",
                        who,
                        format!("TYPE says R for JOINT/{joint}, which is TRANSLATIONAL"),
                    );
                }
                (JointKind::Cylindrical, None) => {
                    error(
                        out,
                        "missing_argument",
                        who,
                        format!("JOINT/{joint} is CYLINDRICAL: TYPE must say R or T"),
                    );
                }
                (JointKind::Revolute | JointKind::Translational | JointKind::Cylindrical, _) => {}
                _ => error(
                    out,
                    "wrong_joint",
                    who,
                    format!("JOINT/{joint} is {word}: it cannot be coupled"),
                ),
            }
        }
        if c.user.is_none() && !c.scales.is_empty() && c.scales.iter().all(|&s| s == 0.0) {
            error(out, "unfit_value", who, "all SCALES are zero".into());
        }
    }
}

fn gears_share_a_carrier(model: &Model, out: &mut Out) {
    for (&id, g) in &model.gears {
        let who = ("GEAR", id, &g.place);
        if g.joints[0] == g.joints[1] {
            error(
                out,
                "contradiction",
                who,
                format!("JOINT/{} stands twice in JOINTS", g.joints[0]),
            );
        }
        let carrier = model.body_of(g.cv);
        for n in g.joints {
            let Some(joint) = model.joints.get(&n) else {
                continue;
            };
            let geared = matches!(
                joint.kind,
                JointKind::Revolute | JointKind::Translational | JointKind::Cylindrical
            );
            if !geared {
                let message = format!(
                    "JOINT/{n} is {}: it cannot be geared",
                    joint_word(joint.kind)
                );
                error(out, "wrong_joint", who, message);
            }
            let of_j = model.body_of(joint.j);
            if carrier.is_some() && of_j.is_some() && carrier != of_j {
                let message = format!(
                    "the J marker of JOINT/{n} and the CV marker {} belong to different parts",
                    g.cv
                );
                error(out, "no_common_carrier", who, message);
                advise(
                    out,
                    "the J markers of both joints and CV must belong to the part that carries the gears",
                );
            }
        }
    }
}

fn point_masses_do_not_turn(model: &Model, out: &mut Out) {
    let is_point = |m: u32| matches!(model.body_of(m), Some((true, _)));
    for (&id, j) in &model.joints {
        if !matches!(j.kind, JointKind::Spherical) && (is_point(j.i) || is_point(j.j)) {
            let message = format!(
                "a {} joint holds the orientation of a point mass, which has none",
                joint_word(j.kind)
            );
            error(out, "turns_point_mass", ("JOINT", id, &j.place), message);
            advise(
                out,
                "a point mass takes SPHERICAL joints and the primitives ATPOINT, INLINE, INPLANE",
            );
        }
    }
    for (&id, j) in &model.primitives {
        let holds = matches!(
            j.kind,
            PrimitiveKind::Orientation | PrimitiveKind::ParallelAxes | PrimitiveKind::Perpendicular
        );
        if holds && (is_point(j.i) || is_point(j.j)) {
            let message = "it holds the orientation of a point mass, which has none".to_owned();
            error(out, "turns_point_mass", ("JPRIM", id, &j.place), message);
        }
    }
}

fn splines_are_functions(model: &Model, out: &mut Out) {
    for (&id, s) in &model.splines {
        let who = ("SPLINE", id, &s.place);
        if s.file.is_some() {
            continue;
        }
        let n = s.x.len();
        if n == 0 || s.y.is_empty() {
            error(
                out,
                "missing_argument",
                who,
                "a SPLINE needs X and Y, or FILE".into(),
            );
            continue;
        }
        for (k, y) in s.y.iter().enumerate().filter(|(_, y)| y.len() != n) {
            let which = if s.y.len() > 1 {
                format!(" {}", k + 1)
            } else {
                String::new()
            };
            error(
                out,
                "wrong_count",
                who,
                format!("X has {n} numbers, Y{which} has {}", y.len()),
            );
        }
        for (name, list) in [("X", &s.x), ("Z (the first numbers of each Y)", &s.z)] {
            if let Some(w) = list.windows(2).find(|w| w[0].total_cmp(&w[1]).is_ge()) {
                let message = format!("{name} must increase: {} comes after {}", w[1], w[0]);
                error(out, "not_increasing", who, message);
            }
        }
        if n < 4 {
            warn(
                out,
                "few_points",
                who,
                format!("{n} points: a cubic spline needs four or more"),
            );
        }
    }
}

fn arrays_have_their_size(model: &Model, out: &mut Out) {
    for (&id, a) in &model.arrays {
        let (n, name) = match &a.kind {
            ArrayKind::Ic(x) => (x.len(), "NUMBERS"),
            ArrayKind::Inputs(x) => (x.len(), "VARIABLES"),
            ArrayKind::States | ArrayKind::Outputs => continue,
        };
        let who = ("ARRAY", id, &a.place);
        if n == 0 {
            error(out, "missing_argument", who, format!("{name} is needed"));
        }
        if let Some(size) = a.size.filter(|&s| s != n && n > 0) {
            error(
                out,
                "wrong_count",
                who,
                format!("SIZE = {size}, but {name} holds {n}"),
            );
        }
    }
    for (&id, m) in &model.matrices {
        let who = ("MATRIX", id, &m.place);
        if m.file.is_some() {
            continue;
        }
        if m.rows == 0 || m.columns == 0 {
            error(
                out,
                "missing_argument",
                who,
                "ROWS and COLUMNS are needed".into(),
            );
        } else if m.by_rows().is_none() {
            let message = match &m.layout {
                MatrixLayout::Sparse { rows, columns } => format!(
                    "SPARSE with {} I, {} J and {} VALUES in {} rows and {} columns",
                    rows.len(),
                    columns.len(),
                    m.values.len(),
                    m.rows,
                    m.columns
                ),
                _ => format!(
                    "{} rows of {} make {}, but VALUES holds {}",
                    m.rows,
                    m.columns,
                    m.rows.saturating_mul(m.columns),
                    m.values.len()
                ),
            };
            error(out, "wrong_count", who, message);
        }
    }
}

fn systems_have_their_arrays(model: &Model, out: &mut Out) {
    let fits = |array: u32, argument: &str| {
        model.arrays.get(&array).is_none_or(|a| match argument {
            "X" | "XD" => a.kind == ArrayKind::States,
            "Y" => a.kind == ArrayKind::Outputs,
            "U" => matches!(a.kind, ArrayKind::Inputs(_)),
            _ => matches!(a.kind, ArrayKind::Ic(_)),
        })
    };
    for r in model.references() {
        if r.target == Target::Array && !fits(r.number, r.argument) {
            let kind = match r.argument {
                "XD" => "X",
                "ICD" => "IC",
                other => other,
            };
            let message = format!(
                "{} = {1}: ARRAY/{1} is not of the kind {kind}",
                r.argument, r.number
            );
            error(out, "wrong_array", (r.keyword, r.id, r.place), message);
        }
    }
    for (&id, t) in &model.transfer_functions {
        let who = ("TFSISO", id, &t.place);
        if t.numerator.len() > t.denominator.len() {
            let message = "the degree of NUMERATOR is higher than that of DENOMINATOR".to_owned();
            error(out, "improper_transfer_function", who, message);
        }
        if t.denominator.last().is_some_and(|&a| a == 0.0) {
            error(
                out,
                "unfit_value",
                who,
                "the last number of DENOMINATOR, its highest power, is zero".into(),
            );
        }
    }
}

fn curves_have_points(model: &Model, out: &mut Out) {
    for (&id, c) in &model.curves {
        let who = ("CURVE", id, &c.place);
        if c.matrix.is_none() && c.function.is_none() {
            error(
                out,
                "missing_argument",
                who,
                "a CURVE needs MATRIX, or FUNCTION = USER(…)".into(),
            );
        }
        let Some(points) = c.matrix.and_then(|m| model.matrices.get(&m)) else {
            continue;
        };
        if points.file.is_some() {
            continue;
        }
        if points.columns != 3 {
            let message = format!(
                "its MATRIX has {} columns; a point has three",
                points.columns
            );
            error(out, "wrong_count", who, message);
            continue;
        }
        if points.rows < 4 {
            error(
                out,
                "few_points",
                who,
                format!("{} points; a curve needs four or more", points.rows),
            );
        }
        let all = points.by_rows().unwrap_or_default();
        if c.closed && c.through_points && all.len() >= 6 && all[..3] != all[all.len() - 3..] {
            error(
                out,
                "open_ends",
                who,
                "CLOSED, but the first and last point differ".into(),
            );
        }
    }
}

fn forces_have_data(model: &Model, out: &mut Out) {
    for (&id, f) in &model.fields {
        if f.stiffness.is_empty() && f.function.is_none() {
            error(
                out,
                "missing_argument",
                ("FIELD", id, &f.place),
                "KMATRIX is needed".into(),
            );
        }
    }
    for (&id, b) in &model.beams {
        let who = ("BEAM", id, &b.place);
        if b.length <= 0.0 {
            error(out, "unfit_value", who, "LENGTH must be positive".into());
        }
        for (name, x) in [
            ("AREA", b.area),
            ("EMODULUS", b.youngs_modulus),
            ("GMODULUS", b.shear_modulus),
        ] {
            if x <= 0.0 {
                warn(out, "unfit_value", who, format!("{name} is not positive"));
            }
        }
    }
    for (keyword, list) in [
        ("VFORCE", &model.vforces),
        ("VTORQUE", &model.vtorques),
        ("GFORCE", &model.gforces),
    ] {
        for (&id, f) in list {
            let none = f.force.iter().chain(&f.torque).all(Option::is_none);
            if none && f.user.is_none() {
                warn(
                    out,
                    "no_effect",
                    (keyword, id, &f.place),
                    "no component is given: it does nothing".into(),
                );
            }
        }
    }
    for (&id, f) in &model.frictions {
        let kind = model.joints.get(&f.joint).map(|j| j.kind);
        let takes = |k| {
            use JointKind as J;
            matches!(
                k,
                J::Translational
                    | J::Revolute
                    | J::Cylindrical
                    | J::Hooke
                    | J::Universal
                    | J::Spherical
            )
        };
        if let Some(kind) = kind.filter(|&k| !takes(k)) {
            let message = format!(
                "JOINT/{} is {}: there is no friction law for it",
                f.joint,
                joint_word(kind)
            );
            error(out, "wrong_joint", ("FRICTION", id, &f.place), message);
        }
    }
}

fn requests_ask_something(model: &Model, out: &mut Out) {
    for (&id, r) in &model.requests {
        let who = ("REQUEST", id, &r.place);
        match &r.kind {
            RequestKind::Functions(f) if f.iter().all(Option::is_none) => {
                warn(out, "no_effect", who, "it asks nothing".into());
                advise(
                    out,
                    "DISPLACEMENT, VELOCITY, ACCELERATION or FORCE with I, or F1 to F8",
                );
            }
            RequestKind::Displacement { i: 0, .. }
            | RequestKind::Velocity { i: 0, .. }
            | RequestKind::Acceleration { i: 0, .. }
            | RequestKind::Force { i: 0, .. } => {
                error(out, "missing_argument", who, "I is needed".into())
            }
            _ => {}
        }
    }
}

fn units_are_known(model: &Model, out: &mut Out) {
    let Some(u) = &model.units else {
        return;
    };
    let four = [
        ("FORCE", &u.force, units::force(&u.force), units::FORCES),
        ("MASS", &u.mass, units::mass(&u.mass), units::MASSES),
        (
            "LENGTH",
            &u.length,
            units::length(&u.length),
            units::LENGTHS,
        ),
        ("TIME", &u.time, units::time(&u.time), units::TIMES),
    ];
    for (name, word, factor, known) in four {
        if factor.is_none() && !word.is_empty() {
            let mut d = Diagnostic::error("unknown_word", format!("{name} = {word}: unknown unit"))
                .element("UNITS");
            let near = near_names(word, known.iter().copied());
            if !near.is_empty() {
                d = d.help(format!("did you mean {}?", near.join(" or ")));
            }
            out.push(d);
        }
    }
    if !(u.ucf.is_finite() && u.ucf > 0.0) {
        out.push(Diagnostic::error("unfit_value", "UCF must be positive").element("UNITS"));
    }
}

// --------------------------------------------------------------------------------------------------------- functions

fn functions_can_be_read(model: &Model, out: &mut Out) {
    let mut known = Known::default();
    for owned in model.formulas() {
        let Formula::Expression { text, .. } = owned.formula else {
            continue;
        };
        let who = |d: Diagnostic| {
            let d = about(d, owned.keyword, owned.id, owned.place);
            Diagnostic {
                message: format!("{}: {}", owned.argument, d.message),
                ..d
            }
        };
        if text.is_empty() && owned.place.line > 0 {
            continue; // the reader has said so already
        }
        if text.is_empty() {
            out.push(who(Diagnostic::error(
                "missing_argument",
                "an expression is needed",
            )));
            continue;
        }
        match Expr::parse(text) {
            Err(d) => {
                let at = d.span.map_or(0, |s| s.start);
                out.push(placed(who(strip(d)), owned.formula, at));
                continued_by_comma(owned.formula, at, out);
            }
            Ok(expr) => {
                for d in expr.warnings() {
                    let at = d.span.map_or(0, |s| s.start);
                    out.push(placed(who(strip(d)), owned.formula, at));
                }
                for (at, target, number) in named(&expr) {
                    if known.has(model, target, number) {
                        continue;
                    }
                    let message = format!("{}/{number} does not exist", target.keyword());
                    let mut d = who(Diagnostic::error("unknown_element", message));
                    d.help.extend(near(number, &model.numbers(target)));
                    out.push(placed(d, owned.formula, at));
                }
            }
        }
    }
}

/// A place in an expression is not yet one in a file.
fn strip(d: Diagnostic) -> Diagnostic {
    Diagnostic {
        span: None,
        line: 0,
        column: 0,
        ..d
    }
}

/// The place in the file of a byte of the expression; the place of the statement stays where there is none.
fn placed(mut d: Diagnostic, formula: &Formula, offset: usize) -> Diagnostic {
    if let Some((line, column)) = formula.file_place(offset) {
        (d.line, d.column) = (line, column);
    }
    d
}

/// A comma at the beginning of a line does not separate arguments: say so where that may be the mistake.
fn continued_by_comma(formula: &Formula, offset: usize, out: &mut Out) {
    let Formula::Expression { text, breaks, .. } = formula else {
        return;
    };
    let at_break = breaks.iter().any(|b| b.offset == offset);
    let open = text
        .get(..offset)
        .is_some_and(|t| !t.trim_end().ends_with([',', '+', '-', '*', '/', '(']));
    if at_break && open {
        advise(
            out,
            "a comma that begins a line only continues the statement; one that separates arguments ends the line above",
        );
    }
}

/// Numbers in use, looked up once per kind.
#[derive(Default)]
struct Known(BTreeMap<Target, Vec<u32>>);

impl Known {
    fn has(&mut self, model: &Model, target: Target, number: u32) -> bool {
        let list = self
            .0
            .entry(target)
            .or_insert_with(|| model.numbers(target));
        list.binary_search(&number).is_ok()
    }
}

/// The elements an expression names: byte, kind, number. Zeros that stand for ground are left out.
fn named(expr: &Expr) -> Vec<(usize, Target, u32)> {
    let ast = expr.ast();
    let mut all = Vec::new();
    for node in &ast.nodes {
        let Node::Call { callee, args } = node else {
            continue;
        };
        for (k, &arg) in args.iter().enumerate() {
            let signature::Kind::Identifier { element, .. } = callee.argument(k) else {
                continue;
            };
            if let Node::Number { literal, .. } = ast.node(arg)
                && *literal >= 1.0
                && *literal <= f64::from(u32::MAX)
            {
                let at = ast.spans.get(arg as usize).map_or(0, |s| s.start);
                all.push((at, Target::Named(element), *literal as u32));
            }
        }
    }
    all
}
