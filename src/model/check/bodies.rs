//! Parts, point masses and markers: one ground, mass with a place, inertia that a body can have,
//! axes, owners of floating markers.

use super::*;
use crate::diagnostic::Cause;
use crate::physics::joint::Tie;
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
        let first = model.called(ElementKind::Part.id(*grounds[0].0));
        let message = format!("a second ground; {first} is GROUND already");
        error(
            out,
            "several_grounds",
            (ElementKind::Part.id(id), &part.place),
            message,
        );
    }
    for &(&id, part) in &grounds {
        if part.mass != 0.0 {
            let message = "ground has a mass, which means nothing".to_owned();
            warn(
                out,
                "mass_of_ground",
                (ElementKind::Part.id(id), &part.place),
                message,
            );
        }
    }
}

/// Parts and point masses.
fn bodies(model: &Model) -> impl Iterator<Item = (ElementId, &Part)> {
    let parts = model.parts.iter();
    let points = model.point_masses.iter();
    let parts = parts.map(|(&id, p)| (ElementKind::Part.id(id), p));
    parts.chain(points.map(|(&id, p)| (ElementKind::PointMass.id(id), p)))
}

pub(super) fn mass_has_a_centre(model: &Model, out: &mut Out) {
    for (id, part) in bodies(model) {
        let who = (id, &part.place);
        if part.mass < 0.0 {
            error(
                out,
                "negative_mass",
                who,
                format!("the mass {} is negative", part.mass),
            );
            at_argument(out, "MASS");
        }
        if part.mass > 0.0 && part.cm.is_none() && !part.ground {
            error(
                out,
                "mass_without_cm",
                who,
                "it has a mass but no CM".into(),
            );
            at_argument(out, "MASS");
            advise(out, "CM names the marker at the centre of mass");
        }
        if part.ip != [0.0; 6] && part.cm.is_none() && part.im.is_none() && !part.ground {
            error(
                out,
                "inertia_without_marker",
                who,
                "it has IP but neither CM nor IM".into(),
            );
            at_argument(out, "IP");
        }
        for (name, marker) in [("CM", part.cm), ("IM", part.im)] {
            let Some(m) = marker.and_then(|m| model.markers.get(&m).map(|_| m)) else {
                continue;
            };
            let marker = || model.called(ElementKind::Marker.id(m));
            if model.body_of(m).is_some_and(|body| body != id) {
                error(
                    out,
                    "marker_of_another_part",
                    who,
                    format!("{name} = {m}: {} belongs to another part", marker()),
                );
                at_argument(out, name);
            }
            if model.markers[&m].floating {
                error(
                    out,
                    "floating_marker",
                    who,
                    format!("{name} = {m}: {} is FLOATING", marker()),
                );
                at_argument(out, name);
            }
        }
    }
}

/// The inertia tensor is that of some distribution of mass: positive, and no moment larger than the
/// two others together.
pub(super) fn inertia_is_possible(model: &Model, out: &mut Out) {
    const TOLERANCE: f64 = 1e-3;
    for (id, part) in bodies(model) {
        let who = (id, &part.place);
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
            at_argument(out, "IP");
            continue;
        }
        let j = Matrix3::new(xx, -xy, -xz, -xy, yy, -yz, -xz, -yz, zz);
        let mut moments: Vec<f64> = j.symmetric_eigenvalues().iter().copied().collect();
        moments.sort_by(f64::total_cmp);
        if moments[0] < -TOLERANCE {
            let message = "the products in IP are too large: no body has this inertia".to_owned();
            warn(out, Cause::ImpossibleInertia.code(), who, message);
            at_argument(out, "IP");
            advise(
                out,
                "IP is xx, yy, zz, xy, xz, yz; the products are the positive integrals of xy dm …",
            );
        } else if moments[2] > (moments[0] + moments[1]) * (1.0 + TOLERANCE) {
            let message = "one principal moment is larger than the two others together: no body has this inertia".to_owned();
            warn(out, Cause::ImpossibleInertia.code(), who, message);
            at_argument(out, "IP");
        }
    }
}

pub(super) fn axes_have_directions(model: &Model, out: &mut Out) {
    let mut check =
        |who: Who, origin: [f64; 3], orientation: &Orientation, names: [&'static str; 3]| {
            let Orientation::Points { z, x, .. } = orientation else {
                return;
            };
            for (point, name) in [(z, names[0]), (x, names[1])] {
                if *point == Some(origin) {
                    let message =
                        format!("{name} is the origin {}: it gives no direction", names[2]);
                    error(out, "no_direction", who, message);
                    at_argument(out, name);
                }
            }
            if z.is_some() && z == x {
                let message = format!("{} and {} are the same point", names[0], names[1]);
                error(out, "no_direction", who, message);
            }
        };
    for (id, p) in bodies(model) {
        check((id, &p.place), p.qg, &p.orientation, ["ZG", "XG", "QG"]);
    }
    for (&id, m) in &model.markers {
        check(
            (ElementKind::Marker.id(id), &m.place),
            m.qp,
            &m.orientation,
            ["ZP", "XP", "QP"],
        );
    }
}

/// A floating marker gets its frame from the one element that owns it.
pub(super) fn floating_markers_have_one_owner(model: &Model, out: &mut Out) {
    const OWNING: &[&str] = &["JFLOAT", "IFLOAT"];
    let mut owners: BTreeMap<u32, ElementId> = BTreeMap::new();
    for r in (model.each_reference()).filter(|r| OWNING.contains(&r.argument)) {
        let Some(marker) = model.markers.get(&r.target.number) else {
            continue;
        };
        let who = (r.element, r.place);
        if !marker.floating {
            let message = format!(
                "{} = {}: {} is not FLOATING",
                r.argument, r.target.number, r.target
            );
            warn(out, "not_floating", who, message);
            at_argument(out, r.argument);
            continue;
        }
        let owner = r.element;
        if let Some(first) = owners.get(&r.target.number).filter(|f| **f != owner) {
            let message = format!(
                "{} = {}: the floating {} belongs to {first} already",
                r.argument, r.target.number, r.target
            );
            error(out, "floating_marker_shared", who, message);
            at_argument(out, r.argument);
            advise(out, "each such element needs a floating marker of its own");
        }
        owners.entry(r.target.number).or_insert(owner);
    }
    for (id, element) in model.elements() {
        let Some([i, j]) = element.ends() else {
            continue;
        };
        for (name, m) in [("I", i), ("J", j)] {
            if model.markers.get(&m).is_some_and(|m| m.floating) {
                let marker = model.called(ElementKind::Marker.id(m));
                let message =
                    format!("{name} = {m}: {marker} is FLOATING and has no frame of its own");
                error(out, "floating_marker", (id, element.place()), message);
                at_argument(out, name);
            }
        }
    }
}

pub(super) fn point_masses_do_not_turn(model: &Model, out: &mut Out) {
    let is_point = |m: u32| {
        let body = model.body_of(m);
        body.is_some_and(|b| b.kind == ElementKind::PointMass)
    };
    for (&id, j) in &model.joints {
        if Tie::Joint(j.kind).holds_orientation() && (is_point(j.i) || is_point(j.j)) {
            let message = format!(
                "a {} joint holds the orientation of a point mass, which has none",
                j.kind.keyword()
            );
            error(
                out,
                "turns_point_mass",
                (ElementKind::Joint.id(id), &j.place),
                message,
            );
            advise(
                out,
                "a point mass takes SPHERICAL joints and the primitives ATPOINT, INLINE, INPLANE",
            );
        }
    }
    for (&id, j) in &model.primitives {
        let holds = Tie::Primitive(j.kind).holds_orientation();
        if holds && (is_point(j.i) || is_point(j.j)) {
            let message = "it holds the orientation of a point mass, which has none".to_owned();
            error(
                out,
                "turns_point_mass",
                (ElementKind::Jprim.id(id), &j.place),
                message,
            );
        }
    }
}
