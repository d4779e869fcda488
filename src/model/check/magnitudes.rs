//! Magnitudes that cannot be meant: numbers of one system of units among those of another. A
//! warning says the number and what it means.

use super::*;
use crate::model::geometry::marker_frame;
use crate::scalar::Scalar;
use crate::space::Vec3;
use std::cell::LazyCell;

/// Acceleration of gravity at the surface of the earth, in m/s².
const EARTH: f64 = 9.80665;
/// Accelerations of gravity, relative to that of the earth, that are not doubted: asteroids have
/// less, centrifuges more.
const GRAVITY_IN_DOUBT: [f64; 2] = [1e-4, 30.0];
/// Difference of two accelerations, relative to one of them, below which they are the same number
/// rounded differently: 9.8 and 9.81.
const SAME_GRAVITY: f64 = 0.02;
/// Radius of gyration that is doubted, at least, relative to the size of the mechanism.
const WIDE_GYRATION: f64 = 20.0;
/// Radius of a pin or a ball that is doubted, at least, relative to the size of the mechanism.
const WIDE_PIN: f64 = 3.0;
/// Radius of gyration that is doubted, at most, relative to the distance of the part's markers from
/// its centre of mass: moments in kg m² among millimetres are a thousandth too small.
const NARROW_GYRATION: f64 = 1.5e-3;
/// Mass relative to that of the heaviest body, at most, of one that only turns.
const WEIGHTLESS: f64 = 1e-3;
/// Period in s of an oscillation that no simulation resolves.
const SHORTEST_PERIOD: f64 = 1e-7;
/// Time in s in which a damper stops a mass that no simulation resolves.
const SHORTEST_STOP: f64 = 1e-14;

pub(super) fn gravity_is_plausible(model: &Model, out: &mut Out) {
    let Some(u) = &model.units else { return };
    let g = Vec3(model.gravity).norm();
    let (Some(length), Some(time)) = (units::length(&u.length), units::time(&u.time)) else {
        return;
    };
    let relative = g * length / (time * time) / EARTH;
    let near = |x: f64, y: f64| (x / y - 1.0).abs() < SAME_GRAVITY;
    if g == 0.0 || near(relative, 1.0) {
        return;
    }
    let unit = |u: &&&str| units::length(u).is_some_and(|other| near(g, EARTH / other));
    let typed = (["METER", "MILLIMETER", "CENTIMETER", "FOOT", "INCH"].iter()).find(unit);
    let [least, most] = GRAVITY_IN_DOUBT;
    let in_doubt = !(least..=most).contains(&relative);
    let per = |length: &str| format!("{length}/SECOND**2");
    let means = format!("a gravity of {} m/s²", short(relative * EARTH));
    let message = match typed {
        Some(typed) => format!(
            "{means}: {} is that of the earth in {}, but LENGTH is {} and TIME {}",
            short(g),
            per(typed),
            u.length,
            u.time
        ),
        None if in_doubt => format!("{means}, {} times that of the earth", short(relative)),
        None => return,
    };
    let earth = EARTH * time * time / length;
    out.push(
        Diagnostic::warning("unlikely_magnitude", message)
            .element("ACCGRAV")
            .help(format!(
                "in these units the gravity of the earth is {}",
                (earth * 1e6).round() / 1e6
            )),
    );
}

/// Free length of a spring that is doubted, at least, relative to its length as drawn.
const LONG_SPRING: f64 = 50.0;

pub(super) fn springs_have_their_length(model: &Model, out: &mut Out) {
    let unit = model.units.as_ref().map_or("", |u| u.length.as_str());
    let springs = model.spring_dampers.iter();
    for (&id, s) in springs.filter(|(_, s)| !s.rotational && s.stiffness != 0.0) {
        let (Some(i), Some(j)) = (marker_frame(model, s.i), marker_frame(model, s.j)) else {
            continue;
        };
        let drawn = (i.position - j.position).norm();
        if drawn > 0.0 && s.free > LONG_SPRING * drawn {
            let message = format!(
                "its free LENGTH is {} {unit}, but its markers are {} apart",
                short(s.free),
                short(drawn)
            );
            let who = (ElementKind::SpringDamper.id(id), &s.place);
            warn(out, "unlikely_magnitude", who, message);
            at_argument(out, "LENGTH");
        }
    }
}

/// Length of a beam relative to the distance of its markers as drawn, and the reciprocal, that is
/// doubted, at least.
const STRAINED_BEAM: f64 = 2.0;
/// Distance of the markers of a bushing that is doubted, at least, relative to the mechanism.
const WIDE_BUSHING: f64 = 0.2;
/// INTEGRATOR/ERROR, relative to the size of each unknown, that lets anything pass.
const ANY_ERROR: f64 = 1.0;

pub(super) fn beams_have_their_length(model: &Model, out: &mut Out) {
    let apart = |i, j| {
        let between = marker_frame(model, i)?.position - marker_frame(model, j)?.position;
        Some(between.norm())
    };
    for (&id, b) in &model.beams {
        let Some(drawn) = apart(b.i, b.j) else {
            continue;
        };
        let strained = b.length > STRAINED_BEAM * drawn || drawn > STRAINED_BEAM * b.length;
        if b.length > 0.0 && strained {
            let message = format!(
                "its LENGTH is {}, but its markers are {} apart",
                short(b.length),
                short(drawn)
            );
            let who = (ElementKind::Beam.id(id), &b.place);
            warn(out, "unlikely_magnitude", who, message);
            at_argument(out, "LENGTH");
        }
    }
    let all = LazyCell::new(|| extent(model));
    for (&id, b) in &model.bushings {
        let stiffness = b.stiffness[..3].iter().fold(0.0_f64, |k, x| k.max(x.abs()));
        let far = apart(b.i, b.j).filter(|d| *d > WIDE_BUSHING * *all);
        let Some(far) = far.filter(|_| stiffness > 0.0 && b.preload[..3] == [0.0; 3]) else {
            continue;
        };
        if let (Some(i), Some(j)) = (marker_frame(model, b.i), marker_frame(model, b.j)) {
            let along = j.rotation.apply_transposed(i.position - j.position);
            let force = Vec3([0, 1, 2].map(|k| b.stiffness[k] * along.0[k])).norm();
            let makes = if force > 1e-9 * far * stiffness {
                format!("so that it begins with a force of {}", short(force))
            } else {
                "along what it leaves free".to_owned()
            };
            let message = format!("its markers are {} apart, {makes}", short(far));
            let who = (ElementKind::Bushing.id(id), &b.place);
            warn(out, "unlikely_magnitude", who, message);
            advise(
                out,
                "the markers of a BUSHING lie on each other where it has no load",
            );
        }
    }
}

pub(super) fn errors_are_small(model: &Model, out: &mut Out) {
    if let Some(error) = model.integrator.error.filter(|e| *e >= ANY_ERROR) {
        let message = format!(
            "ERROR = {error} is relative to the size of each unknown: no digit of the results is then right"
        );
        let d = Diagnostic::warning("unlikely_magnitude", message).element("INTEGRATOR");
        out.push(d.help("1E-3 is three digits"));
    }
}

/// The largest distance between two corners of the box that holds all markers as they are drawn.
fn extent(model: &Model) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for &id in model.markers.keys() {
        for (k, x) in
            (marker_frame(model, id).into_iter()).flat_map(|f| f.position.0.into_iter().enumerate())
        {
            (low[k], high[k]) = (low[k].min(x), high[k].max(x));
        }
    }
    let size = Vec3(high) - Vec3(low);
    Some(size.norm()).filter(|s| s.is_finite()).unwrap_or(0.0)
}

pub(super) fn inertia_fits_its_part(model: &Model, out: &mut Out) {
    let all = LazyCell::new(|| extent(model));
    let heaviest = model.bodies().fold(0.0, |m: f64, (_, b)| m.max(b.mass));
    let unit = model.units.as_ref().map_or("", |u| u.length.as_str());
    let mut markers_of: BTreeMap<ElementId, Vec<&Marker>> = BTreeMap::new();
    for marker in model.markers.values() {
        if let Some(body) = marker.owner.body() {
            markers_of.entry(body).or_default().push(marker);
        }
    }
    for (id, part) in model.bodies() {
        let moment = part.ip[..3].iter().fold(0.0_f64, |m, x| m.max(*x));
        let radius = (moment / part.mass).sqrt();
        let cm = part.cm.and_then(|cm| model.markers.get(&cm));
        let (Some(cm), true) = (cm, radius.is_finite() && radius > 0.0 && !part.ground) else {
            continue;
        };
        let own = markers_of.get(&id).into_iter().flatten();
        let reach = own.map(|m| (Vec3(m.qp) - Vec3(cm.qp)).norm());
        let reach = reach.fold(0.0, f64::max);
        // what is not wide beside its own part is not beside the mechanism
        let is_wide = radius > WIDE_GYRATION * reach;
        let size = if is_wide { all.max(reach) } else { reach };
        let (wide, narrow) = (WIDE_GYRATION * size, NARROW_GYRATION * reach);
        // a body without weight may stand for the inertia of a drive train
        let weighs = part.mass > WEIGHTLESS * heaviest;
        let message = if size > 0.0 && radius > wide && weighs {
            format!(
                "IP makes a radius of gyration of {} {unit}, in a mechanism of {}",
                short(radius),
                short(size)
            )
        } else if radius < narrow {
            format!(
                "IP makes a radius of gyration of {} {unit}, but its markers are {} from its centre of mass",
                short(radius),
                short(reach)
            )
        } else {
            continue;
        };
        warn(out, "unlikely_magnitude", (id, &part.place), message);
        at_argument(out, "IP");
        advise(
            out,
            "IP is in the units of MASS times the square of LENGTH: 1 kg m² is 1E6 kg mm²",
        );
    }
}

/// A linear spring with a damper: its element, the argument of its stiffness, stiffness and damping
/// for translations, the bodies at its ends.
type Stiff<'m> = (ElementId, &'m Place, &'static str, [f64; 2], Vec<ElementId>);

fn stiff(model: &Model) -> Vec<Stiff<'_>> {
    let mut all: Vec<Stiff<'_>> = Vec::new();
    let bodies = |markers: [u32; 2]| {
        markers
            .into_iter()
            .filter_map(|m| model.body_of(m))
            .collect()
    };
    for (&id, s) in model.spring_dampers.iter().filter(|(_, s)| !s.rotational) {
        let id = ElementKind::SpringDamper.id(id);
        let law = [s.stiffness, s.damping];
        all.push((id, &s.place, "K", law, bodies([s.i, s.j])));
    }
    for (&id, b) in &model.bushings {
        let largest = |of: &[f64]| of.iter().fold(0.0_f64, |m, x| m.max(*x));
        let law = [largest(&b.stiffness[..3]), largest(&b.damping[..3])];
        let id = ElementKind::Bushing.id(id);
        all.push((id, &b.place, "K", law, bodies([b.i, b.j])));
    }
    for (&id, c) in &model.contacts {
        let geometries = c.i_geometry.iter().chain(&c.j_geometry);
        let marker = |g: &u32| {
            let named = model.graphics.get(g)?.references();
            named
                .into_iter()
                .find(|(_, id)| id.kind == ElementKind::Marker)
        };
        let owners = geometries.filter_map(marker);
        let owners = owners
            .filter_map(|(_, m)| model.body_of(m.number))
            .collect();
        let id = ElementKind::Contact.id(id);
        // the slope of the force at the depth where its damping is fully there
        let depth = if c.dmax > 0.0 { c.dmax } else { 1.0 };
        let slope =
            c.stiffness * c.exponent.max(1.0) * Scalar::powf(depth, c.exponent.max(1.0) - 1.0);
        let (name, k) = match c.law {
            ContactLaw::Impact => ("STIFFNESS", slope),
            ContactLaw::Poisson => ("PENALTY", c.penalty),
            ContactLaw::User => continue,
        };
        all.push((id, &c.place, name, [k, c.damping], owners));
    }
    all
}

pub(super) fn stiffness_can_be_resolved(model: &Model, out: &mut Out) {
    let (ucf, time) = model
        .units
        .as_ref()
        .map_or((1.0, 1.0), |u| (u.ucf, units::time(&u.time).unwrap_or(1.0)));
    for (id, place, argument, [stiffness, damping], bodies) in stiff(model) {
        let masses = bodies.into_iter().filter_map(|b| model.body(b));
        let masses = masses.filter(|b| !b.ground && b.mass > 0.0);
        let Some(mass) = masses.map(|b| b.mass).min_by(f64::total_cmp) else {
            continue;
        };
        let period = std::f64::consts::TAU * (mass / (stiffness * ucf)).sqrt() * time;
        if period < SHORTEST_PERIOD {
            let message = format!(
                "{argument} is so large that a mass of {} oscillates on it with a period of {} s, which no step resolves",
                short(mass),
                short(period)
            );
            warn(out, "unlikely_magnitude", (id, place), message);
            at_argument(out, argument);
            advise(
                out,
                "a joint holds without deformation; a contact is stiff enough where its depth is small against the parts",
            );
        }
        let stop = mass / (damping * ucf) * time;
        if damping > 0.0 && stop < SHORTEST_STOP {
            let message = format!(
                "its damping is so large that it stops a mass of {} within {} s, which no step resolves",
                short(mass),
                short(stop)
            );
            warn(out, "unlikely_magnitude", (id, place), message);
            at_argument(out, "DAMPING");
        }
    }
}

/// Writes a number with three to four digits, as people write it.
pub(super) fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    if !(1e-4..1e6).contains(&x.abs()) {
        return format!("{x:.2e}");
    }
    let digits = 3 - Scalar::log10(x.abs()).floor() as i32;
    let text = format!("{x:.0$}", digits.max(0) as usize);
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// Pins and balls of FRICTION are not far larger than the mechanism.
pub(super) fn friction_has_the_size_of_joints(model: &Model, out: &mut Out) {
    let frictions: Vec<_> = model
        .active(ElementKind::Friction, &model.frictions)
        .collect();
    if frictions.is_empty() {
        return;
    }
    let size = extent(model);
    let unit = model.units.as_ref().map_or("", |u| u.length.as_str());
    for (id, friction) in frictions {
        let radii = [
            ("PIN_RADIUS", friction.pin_radius),
            ("BALL_RADIUS", friction.ball_radius),
        ];
        for (argument, radius) in radii {
            let Some(radius) = radius.filter(|r| size > 0.0 && *r > WIDE_PIN * size) else {
                continue;
            };
            let message = format!(
                "{argument} is {} {unit}, in a mechanism of {}",
                short(radius),
                short(size)
            );
            let who = (ElementKind::Friction.id(id), &friction.place);
            warn(out, "unlikely_magnitude", who, message);
            at_argument(out, argument);
        }
    }
}

/// A model with weights or forces names its units.
pub(super) fn units_are_given(model: &Model, out: &mut Out) {
    let mut forces = ElementKind::of(Family::Force);
    let is_pushed = forces.any(|kind| !model.numbers(kind).is_empty());
    if model.units.is_some() || !(is_pushed || model.gravity != [0.0; 3]) {
        return;
    }
    let what =
        "there is no UNITS: a force is a mass times an acceleration, in whatever units these are";
    let d = Diagnostic::warning("no_units", what).element("UNITS");
    out.push(d.help("UNITS/SYSTEM=MKS says that they go together; in UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND they do not"));
}
