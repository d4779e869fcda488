//! Parts, point masses and markers: one ground, mass with a place, inertia that a body can have, axes, owners of floating markers.

use super::constraints::{constraint_pairs, joint_word, spring_pairs};
use super::*;
use nalgebra::Matrix3;

pub(super) fn one_ground(model: &Model, out: &mut Out) {
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

pub(super) fn mass_has_a_centre(model: &Model, out: &mut Out) {
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
pub(super) fn inertia_is_possible(model: &Model, out: &mut Out) {
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

pub(super) fn axes_have_directions(model: &Model, out: &mut Out) {
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

/// A floating marker gets its frame from the one element that owns it.
pub(super) fn floating_markers_have_one_owner(model: &Model, out: &mut Out) {
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

pub(super) fn point_masses_do_not_turn(model: &Model, out: &mut Out) {
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
