//! A set-up applied to a model: functions give loads, and loads that were not chosen are taken
//! away.

use super::function::{Fitted, Ordinate, Shape, UserFunction};
use super::load::{Load, loads_of};
use super::{Named, Setup};
use crate::diagnostic::{Diagnostic, Error, Span, near_names};
use crate::expr::Expr;
use crate::expr::ast::Dialect;
use crate::model::{COMPONENTS, Driven, ElementId, ElementKind, Formula, Level, Model, SplineData};
use crate::results::Loads;
use std::collections::BTreeSet;
use std::path::Path;

/// The loads that a command asks for.
#[derive(Clone, Copy, Debug)]
pub enum Asked<'a> {
    /// all, whatever was chosen
    All,
    /// those of the last choice
    Kept,
    /// these, which the shell keeps as the choice; `all` alone: all loads
    New(&'a [String]),
    /// those that acted in a run whose record names them
    Recorded(&'a [String]),
}

/// A model's set-up, and the loads that were chosen.
#[derive(Clone, Debug, Default)]
pub struct Prepared {
    /// the file beside the model
    pub setup: Setup,
    /// the loads that were chosen; `None`: all loads act
    pub loads: Option<Loads>,
}

/// Prepares a model for a run: reads the file beside its dataset, gives loads their functions, and
/// leaves out the loads that are not chosen. The file stays as it is.
///
/// # Errors
/// All mistakes in that file, at their lines and columns, and names that are no loads.
pub fn prepare(dataset: &Path, model: &mut Model, asked: Asked<'_>) -> Result<Prepared, Error> {
    apply(Setup::beside(dataset)?, model, asked)
}

/// Prepares a model for a run by a set-up, as [`prepare`] does by the file beside its dataset.
///
/// # Errors
/// As [`prepare`].
pub fn apply(setup: Setup, model: &mut Model, asked: Asked<'_>) -> Result<Prepared, Error> {
    drive(&setup, model)?;
    let (names, is_kept) = match asked {
        Asked::All => (None, false),
        Asked::New(names) if is_all(names) => (None, false),
        Asked::New(names) | Asked::Recorded(names) => (Some(given(names)), false),
        Asked::Kept => (setup.solve.loads.clone(), true),
    };
    let loads = match &names {
        None => None,
        Some(names) => Some(choose(&setup, model, names, is_kept)?),
    };
    Ok(Prepared { setup, loads })
}

/// Returns whether names ask for all loads.
fn is_all(names: &[String]) -> bool {
    matches!(names, [name] if name.eq_ignore_ascii_case("all"))
}

/// Returns names that stand in no file.
fn given(names: &[String]) -> Vec<Named> {
    let named = |text: &String| Named {
        text: text.clone(),
        span: Span::default(),
    };
    names.iter().map(named).collect()
}

/// Returns the loads that names of loads and load cases mean.
///
/// # Errors
/// All names that mean none.
pub fn check_loads(setup: &Setup, model: &Model, names: &[String]) -> Result<Vec<Load>, Error> {
    meant(setup, model, &given(names), false)
}

/// Returns the loads of the choice that is kept; `None`: all loads.
///
/// # Errors
/// All names that mean none, at their places.
pub fn chosen_loads(setup: &Setup, model: &Model) -> Result<Option<Vec<Load>>, Error> {
    let names = setup.solve.loads.as_ref();
    names
        .map(|names| meant(setup, model, names, true))
        .transpose()
}

fn meant(setup: &Setup, model: &Model, names: &[Named], in_file: bool) -> Result<Vec<Load>, Error> {
    let mut found = Vec::new();
    let loads = resolve(setup, model, names, in_file, &mut found);
    match found.is_empty() {
        true => Ok(loads),
        false => Err(found.into()),
    }
}

/// Leaves out the loads that are not chosen.
fn choose(
    setup: &Setup,
    model: &mut Model,
    names: &[Named],
    in_file: bool,
) -> Result<Loads, Vec<Diagnostic>> {
    let mut found = Vec::new();
    let all = loads_of(model);
    let chosen = resolve(setup, model, names, in_file, &mut found);
    if !found.is_empty() {
        return Err(found);
    }
    let (acting, left_out): (Vec<Load>, Vec<Load>) =
        all.into_iter().partition(|load| chosen.contains(load));
    if acting.is_empty() {
        let what = "no load is chosen: at least one must act";
        let d = match names.first().filter(|_| in_file) {
            Some(first) => setup.mistake(first.span, "no_load", what),
            None => Diagnostic::error("no_load", what),
        };
        let advice = format!("loads of the model: {}", listed(&left_out));
        return Err(vec![d.help(advice)]);
    }
    left_out.iter().for_each(|load| load.leave_out(model));
    let words = |loads: &[Load]| loads.iter().map(ToString::to_string).collect();
    Ok(Loads {
        chosen: names.iter().map(|n| n.text.clone()).collect(),
        acting: words(&acting),
        left_out: words(&left_out),
    })
}

fn listed(loads: &[Load]) -> String {
    let names: Vec<String> = loads.iter().map(ToString::to_string).collect();
    match names.is_empty() {
        true => "none".to_owned(),
        false => names.join(", "),
    }
}

/// Returns the loads that names of loads and of load cases mean; notes names that mean none.
fn resolve(
    setup: &Setup,
    model: &Model,
    names: &[Named],
    in_file: bool,
    found: &mut Vec<Diagnostic>,
) -> Vec<Load> {
    let mut chosen = Vec::new();
    let mut seen: Vec<&str> = Vec::new();
    let mut open: Vec<(&Named, bool)> = names.iter().rev().map(|n| (n, in_file)).collect();
    while let Some((name, is_in_file)) = open.pop() {
        if let Some(case) = setup.case(&name.text) {
            // a case that holds itself adds nothing more
            if !seen.contains(&case.name.text.as_str()) {
                seen.push(&case.name.text);
                open.extend(case.loads.iter().rev().map(|n| (n, true)));
            }
            continue;
        }
        match Load::named(model, &name.text) {
            Ok(load) => chosen.push(load),
            Err(said) => {
                let d = unknown_load(setup, model, &name.text, said);
                found.push(match is_in_file {
                    true => setup.placed(name.span, d),
                    false => d,
                });
            }
        }
    }
    chosen
}

/// Says that a name is neither a load nor a load case, with those that are near.
fn unknown_load(setup: &Setup, model: &Model, name: &str, said: Diagnostic) -> Diagnostic {
    if !said.help.is_empty() {
        return said;
    }
    let cases = setup.cases.iter().map(|c| c.name.text.clone());
    let all = loads_of(model);
    let names = all.iter().filter_map(|load| match load {
        Load::Element(id) => model.element(*id)?.place().name.clone(),
        Load::Gravity | Load::Initial(_) => None,
    });
    let loads = all.iter().map(ToString::to_string);
    let known: Vec<String> = cases.chain(loads).collect();
    let named: Vec<String> = names.collect();
    let everything = known.iter().chain(&named).map(String::as_str);
    let near = near_names(name, everything);
    said.help(match near.is_empty() {
        true => format!("there are {}", known.join(", ")),
        false => format!("did you mean {}?", near.join(" or ")),
    })
}

/// Gives the loads of a model their functions.
fn drive(setup: &Setup, model: &mut Model) -> Result<(), Vec<Diagnostic>> {
    let (mut found, mut targets) = (Vec::new(), BTreeSet::new());
    for (target, name) in &setup.driven {
        let Some(function) = setup.function(&name.text) else {
            let what = format!("there is no function `{}` in [functions]", name.text);
            let d = setup.mistake(name.span, "unknown_function", what);
            let known = setup.functions.iter().map(|f| f.name.text.as_str());
            let near = near_names(&name.text, known);
            found.push(match near.is_empty() {
                true => d.help(format!("[functions.{}] makes one", name.text)),
                false => d.help(format!("did you mean {}?", near.join(" or "))),
            });
            continue;
        };
        let given = target_of(model, &target.text)
            .map_err(|d| setup.placed(target.span, d))
            .and_then(|(id, component)| {
                if !targets.insert((id, component)) {
                    let what = format!("{} has a function already", target.text);
                    return Err(setup.mistake(target.span, "given_twice", what));
                }
                let wanted = quantity(model, id, component);
                let told = function.ordinate;
                if told != Ordinate::Unsaid && wanted != Ordinate::Unsaid && told != wanted {
                    let what = format!(
                        "{} takes a function of {}, and {} is one of {}",
                        target.text,
                        wanted.word(),
                        name.text,
                        told.word()
                    );
                    return Err(setup.mistake(name.span, "unfit_value", what));
                }
                let text = text_for(setup, model, function, is_angle(wanted))?;
                Ok((id, component, text))
            });
        match given {
            Ok((id, component, text)) => give(model, id, component, text),
            Err(d) => found.push(d),
        }
    }
    match found.is_empty() {
        true => Ok(()),
        false => Err(found),
    }
}

/// Kinds of loads that a function can give.
const DRIVEN: [ElementKind; 5] = [
    ElementKind::Motion,
    ElementKind::Sforce,
    ElementKind::Vforce,
    ElementKind::Vtorque,
    ElementKind::Gforce,
];

/// Returns the element and the component of a load that a function can give: `MOTION/1`, `motor`,
/// `VFORCE/2.FX`, `push.FX`.
///
/// # Errors
/// When there is no such load, or several; a component that it does not have, or lacks.
pub fn target_of(model: &Model, text: &str) -> Result<(ElementId, Option<usize>), Diagnostic> {
    let wrong = |what: String| Diagnostic::error("unknown_load", what);
    let told = |d: Diagnostic| Diagnostic {
        code: "unknown_load",
        ..d
    };
    let (id, component) = match (model.find_of(&DRIVEN, text), text.rsplit_once('.')) {
        (Ok(id), _) => (id, None),
        (Err(_), Some((element, component))) => {
            let id = model.find_of(&DRIVEN, element).map_err(told)?;
            (id, Some(component))
        }
        (Err(d), None) => return Err(told(d)),
    };
    let allowed = match id.kind {
        ElementKind::Vforce => 0..3,
        ElementKind::Vtorque => 3..6,
        ElementKind::Gforce => 0..6,
        _ => 0..0,
    };
    let place = component.and_then(|c| {
        let is = |name: &&str| name.eq_ignore_ascii_case(c.trim());
        COMPONENTS.iter().position(is)
    });
    match (allowed.is_empty(), component, place) {
        (true, None, _) => Ok((id, None)),
        (false, Some(_), Some(k)) if allowed.contains(&k) => Ok((id, Some(k))),
        (true, Some(_), _) => Err(wrong(format!("{id} has one function: name it {id}"))),
        (false, ..) => {
            let names = COMPONENTS[allowed].join(", ");
            let what = format!("{id} has components: {id}.FX and so on, of {names}");
            Err(wrong(what))
        }
    }
}

/// Returns the quantity that a load's function yields.
fn quantity(model: &Model, id: ElementId, component: Option<usize>) -> Ordinate {
    if id.kind == ElementKind::Motion {
        let Some(motion) = model.motions.get(&id.number) else {
            return Ordinate::Unsaid;
        };
        let turns = match motion.driven {
            Driven::JointRotation(_) => true,
            Driven::JointTranslation(_) => false,
            Driven::Joint(n) => {
                (model.joints.get(&n)).is_some_and(|j| j.kind.displacements().turns())
            }
            Driven::Markers { component, .. } => component > 2,
        };
        return match (motion.level, turns) {
            (Level::Displacement, false) => Ordinate::Position,
            (Level::Displacement, true) => Ordinate::Angle,
            (Level::Velocity, false) => Ordinate::Velocity,
            (Level::Velocity, true) => Ordinate::AngularVelocity,
            (Level::Acceleration, false) => Ordinate::Acceleration,
            (Level::Acceleration, true) => Ordinate::AngularAcceleration,
        };
    }
    let is_torque = match component {
        Some(k) => k > 2,
        None => (model.sforces.get(&id.number)).is_some_and(|f| f.rotational),
    };
    match is_torque {
        true => Ordinate::Torque,
        false => Ordinate::Force,
    }
}

fn is_angle(ordinate: Ordinate) -> bool {
    match ordinate {
        Ordinate::Angle | Ordinate::AngularVelocity | Ordinate::AngularAcceleration => true,
        Ordinate::Unsaid
        | Ordinate::Position
        | Ordinate::Velocity
        | Ordinate::Acceleration
        | Ordinate::Force
        | Ordinate::Torque => false,
    }
}

/// Returns a function in the language of direct entry, for a load; `angle`: the load takes an
/// angle, in radians. Points become a SPLINE of the model.
///
/// # Errors
/// A mistake in the function, at its place in the file.
fn text_for(
    setup: &Setup,
    model: &mut Model,
    function: &UserFunction,
    angle: bool,
) -> Result<String, Diagnostic> {
    let text = match &function.shape {
        Shape::Direct(text) => {
            let mut wrong = model.check_expression(&text.text);
            if !wrong.is_empty() {
                return Err(within(setup, text, wrong.swap_remove(0)));
            }
            // a model calls elements by their numbers
            let numbered = model.numbered(&text.text);
            return Ok(numbered.map_or_else(|_| text.text.clone(), |n| n.text));
        }
        Shape::Expression(text) => Expr::parse_dialect(&text.text, Dialect::Expression)
            .map_err(|e| e.into_first())
            .and_then(|expr| expr.ast().in_direct_entry())
            .map_err(|d| within(setup, text, d))?
            .to_string(),
        Shape::Points { points, ends, span } => {
            let fitted = Fitted::through(points, *ends)
                .map_err(|d| setup.mistake(*span, d.code, d.message))?;
            let last = model.splines.keys().next_back().copied().unwrap_or(0);
            let id = last.saturating_add(1);
            let text = fitted.text(id);
            let spline = SplineData {
                x: fitted.x,
                y: vec![fitted.y],
                ..SplineData::default()
            };
            model.splines.insert(id, spline);
            text
        }
    };
    Ok(match angle {
        true => format!("({text})*DTOR"),
        false => text,
    })
}

/// Gives a mistake in the text of a function its place in the file.
fn within(setup: &Setup, text: &Named, d: Diagnostic) -> Diagnostic {
    let raw = setup.text.get(text.span.start..text.span.end);
    // a text without escapes stands in the file as it is, after its quotation mark
    let is_plain = raw.is_some_and(|raw| raw.get(1..raw.len() - 1) == Some(&text.text));
    let span = match d.span.filter(|_| is_plain) {
        Some(inner) => {
            let at = |byte: usize| text.span.start + 1 + byte;
            Span::new(at(inner.start), at(inner.end))
        }
        None => text.span,
    };
    Diagnostic {
        help: d.help,
        ..setup.mistake(span, d.code, d.message)
    }
}

/// Puts a function into a load.
fn give(model: &mut Model, id: ElementId, component: Option<usize>, text: String) {
    let formula = Formula::text(text);
    let n = id.number;
    let vectors = match id.kind {
        ElementKind::Vforce => &mut model.vforces,
        ElementKind::Vtorque => &mut model.vtorques,
        ElementKind::Gforce => &mut model.gforces,
        _ => {
            if let (ElementKind::Motion, Some(motion)) = (id.kind, model.motions.get_mut(&n)) {
                motion.function = formula;
            } else if let Some(force) = model.sforces.get_mut(&n) {
                force.function = formula;
            }
            return;
        }
    };
    if let (Some(force), Some(k)) = (vectors.get_mut(&n), component) {
        match k {
            0..3 => force.force[k] = Some(formula),
            _ => force.torque[k - 3] = Some(formula),
        }
    }
}
