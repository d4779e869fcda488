//! Signs: stiffness and damping that drive instead of resisting, sizes of shapes below zero.

use super::*;

/// Names of the six components of a BUSHING or FIELD.
const AXES: [&str; 6] = ["x", "y", "z", "about x", "about y", "about z"];

pub(super) fn laws_resist(model: &Model, out: &mut Out) {
    for (&id, s) in &model.spring_dampers {
        let who = (ElementKind::SpringDamper.id(id), &s.place);
        let [k, c] = if s.rotational {
            ["KT", "CT"]
        } else {
            ["K", "C"]
        };
        stiffness(out, who, (k, ""), s.stiffness);
        damping(out, who, (c, ""), s.damping);
    }
    for (&id, b) in &model.bushings {
        let who = (ElementKind::Bushing.id(id), &b.place);
        for (n, axis) in AXES.into_iter().enumerate() {
            let [k, c] = if n < 3 { ["K", "C"] } else { ["KT", "CT"] };
            stiffness(out, who, (k, axis), b.stiffness[n]);
            damping(out, who, (c, axis), b.damping[n]);
        }
    }
    for (&id, f) in &model.fields {
        let who = (ElementKind::Field.id(id), &f.place);
        for (n, axis) in AXES.into_iter().enumerate() {
            let own = |matrix: &[f64]| matrix.get(7 * n).copied().unwrap_or(0.0);
            stiffness(out, who, ("KMATRIX", axis), own(&f.stiffness));
            damping(out, who, ("CMATRIX", axis), own(&f.damping));
        }
        damping(out, who, ("CRATIO", ""), f.damping_ratio.unwrap_or(0.0));
    }
    for (&id, b) in &model.beams {
        let who = (ElementKind::Beam.id(id), &b.place);
        damping(out, who, ("CRATIO", ""), b.damping_ratio.unwrap_or(0.0));
        // the lower triangle by rows: its diagonal
        for (n, axis) in AXES.into_iter().enumerate() {
            let own = b.damping.get(n * (n + 3) / 2).copied();
            damping(out, who, ("CMATRIX", axis), own.unwrap_or(0.0));
        }
    }
    for (&id, n) in &model.nodal_forces {
        let who = (ElementKind::Nforce.id(id), &n.place);
        damping(out, who, ("CRATIO", ""), n.damping_ratio.unwrap_or(0.0));
    }
}

pub(super) fn contacts_resist(model: &Model, out: &mut Out) {
    for (&id, c) in &model.contacts {
        let who = (ElementKind::Contact.id(id), &c.place);
        stiffness(out, who, ("STIFFNESS", ""), c.stiffness);
        stiffness(out, who, ("PENALTY", ""), c.penalty);
        damping(out, who, ("DAMPING", ""), c.damping);
        friction(out, who, [c.mu_static, c.mu_dynamic]);
        if c.friction != CoulombFriction::Off {
            friction_falls(out, who, [c.mu_static, c.mu_dynamic]);
        }
    }
    for (&id, f) in &model.frictions {
        let who = (ElementKind::Friction.id(id), &f.place);
        friction(out, who, [f.mu_static, f.mu_dynamic]);
        friction_falls(out, who, [f.mu_static, f.mu_dynamic]);
    }
}

/// Friction is not larger when surfaces slide than when they stick.
fn friction_falls(out: &mut Out, who: Who, [fixed, sliding]: [f64; 2]) {
    if sliding > fixed && fixed >= 0.0 {
        let message = format!(
            "MU_DYNAMIC = {sliding} is larger than MU_STATIC = {fixed}: friction grows where it begins to slide"
        );
        warn(out, "unlikely_magnitude", who, message);
        at_argument(out, "MU_DYNAMIC");
    }
}

/// An argument of a statement, and which of its values: an axis, or nothing.
type Of = (&'static str, &'static str);

fn stiffness(out: &mut Out, who: Who, (argument, axis): Of, value: f64) {
    if value < 0.0 {
        let name = format!("{argument} {axis}");
        let name = name.trim_end();
        let message = format!(
            "{name} = {value}: it pushes away from its free position, the more the farther"
        );
        warn(out, "negative_stiffness", who, message);
        at_argument(out, argument);
        advise(out, "a stiffness is positive, whatever the direction");
    }
}

fn damping(out: &mut Out, who: Who, (argument, axis): Of, value: f64) {
    if value < 0.0 {
        let name = format!("{argument} {axis}");
        let name = name.trim_end();
        let message = format!("{name} = {value}: it feeds energy instead of taking it");
        warn(out, "negative_damping", who, message);
        at_argument(out, argument);
        advise(out, "damping is positive, whatever the direction");
    }
}

fn friction(out: &mut Out, who: Who, coefficients: [f64; 2]) {
    for (name, mu) in ["MU_STATIC", "MU_DYNAMIC"].into_iter().zip(coefficients) {
        if mu < 0.0 {
            let message = format!("{name} = {mu}: friction below zero feeds energy");
            warn(out, "negative_damping", who, message);
            at_argument(out, name);
        }
    }
}

pub(super) fn shapes_have_sizes(model: &Model, out: &mut Out) {
    let contacts = model.contacts.values();
    let touching: BTreeSet<u32> = contacts
        .flat_map(|c| c.i_geometry.iter().chain(&c.j_geometry).copied())
        .collect();
    for (&id, g) in &model.graphics {
        let sizes: Vec<(&str, f64)> = match g.shape {
            Shape::Cylinder { radius, .. }
            | Shape::Circle { radius, .. }
            | Shape::Arc { radius, .. } => vec![("RADIUS", radius)],
            Shape::Frustum { top, bottom, .. } => vec![("TOP", top), ("BOTTOM", bottom)],
            Shape::Ellipsoid { diameters, .. } => {
                let names = ["XSCALE", "YSCALE", "ZSCALE"].into_iter();
                names.zip(diameters).collect()
            }
            Shape::Torus { ring, tube, .. } => vec![
                ("the radius of the ring", ring),
                ("the radius of the tube", tube),
            ],
            // extents of a box and lengths along z have signs
            Shape::Box { .. }
            | Shape::Plane { .. }
            | Shape::Point { .. }
            | Shape::Curve { .. }
            | Shape::External { .. }
            | Shape::Shell { .. }
            | Shape::Other(_)
            | Shape::Nothing => Vec::new(),
        };
        for (name, size) in sizes.into_iter().filter(|s| s.1 < 0.0) {
            let message = format!("{name} = {size}: a size is positive");
            let who = (ElementKind::Graphics.id(id), &g.place);
            warn(out, "unfit_value", who, message);
        }
        if touching.contains(&id) {
            let missing = extents(&g.shape).into_iter().filter(|e| e.1 == 0.0);
            let missing: Vec<&str> = missing.map(|e| e.0).collect();
            if !missing.is_empty() {
                let message = format!(
                    "{} = 0: a CONTACT names this solid, which has no extent",
                    missing.join(", ")
                );
                let who = (ElementKind::Graphics.id(id), &g.place);
                warn(out, "unfit_value", who, message);
            }
        }
    }
}

/// Returns the extents without which a solid is none, by their arguments.
fn extents(shape: &Shape) -> Vec<(&'static str, f64)> {
    match *shape {
        Shape::Cylinder { length, radius, .. } => vec![("LENGTH", length), ("RADIUS", radius)],
        Shape::Circle { radius, .. } | Shape::Arc { radius, .. } => vec![("RADIUS", radius)],
        Shape::Frustum {
            length,
            top,
            bottom,
            ..
        } => vec![
            ("LENGTH", length),
            ("TOP and BOTTOM", top.abs() + bottom.abs()),
        ],
        Shape::Ellipsoid {
            diameters: [x, y, z],
            ..
        } => {
            vec![("XSCALE", x), ("YSCALE", y), ("ZSCALE", z)]
        }
        Shape::Box {
            size: [x, y, z], ..
        } => vec![("X", x), ("Y", y), ("Z", z)],
        Shape::Torus { tube, .. } => vec![("MINOR_RADIUS", tube)],
        Shape::Plane { .. }
        | Shape::Point { .. }
        | Shape::Curve { .. }
        | Shape::External { .. }
        | Shape::Shell { .. }
        | Shape::Other(_)
        | Shape::Nothing => Vec::new(),
    }
}
