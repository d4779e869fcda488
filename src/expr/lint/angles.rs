//! Warnings about angles: degrees where radians are read, angles about several axes in one
//! expression.

use super::{Doubt, number, place, rounded, said};
use crate::diagnostic::Diagnostic;
use crate::expr::ast::{Ast, BinaryOp, Callee, Constant, Node, NodeIx};
use crate::expr::functions::Function;
use crate::expr::measures::Measure;
use std::f64::consts::{PI, TAU};

const CODE: &str = "degrees_or_radians";
const RADIANS_PER_DEGREE: f64 = PI / 180.0;

/// Returns the doubt about one node, if there is one.
pub(super) fn of_node(ast: &Ast, ix: NodeIx) -> Option<Doubt> {
    match *ast.node(ix) {
        Node::Call {
            callee: Callee::Function(f),
            ref args,
        } => argument(ast, ix, f, args),
        Node::Binary(op @ (BinaryOp::Add | BinaryOp::Sub), a, b) => difference(ast, ix, op, a, b),
        _ => None,
    }
}

/// Warns of degrees for radians: SIN(30), SIN(360*TIME); in expression functions sin(radians(x)).
fn argument(ast: &Ast, ix: NodeIx, function: Function, args: &[NodeIx]) -> Option<Doubt> {
    use Function as F;
    let &[x] = args else { return None };
    let name = function.name();
    let span = place(ast, ix);
    match function {
        F::Sin | F::Cos | F::Tan => {
            if let Some((_, n)) = times_time(ast, x) {
                let message = format!("{name} takes radians: {}", speeds(n));
                let help = format!("the suffix D makes degrees of a literal: {n}D*TIME");
                return Some(Doubt::new(span, CODE, message, help));
            }
            let n = number(ast, x).filter(|&n| looks_like_degrees(n))?;
            let (as_is, as_degrees) = (
                function.eval(&[n]),
                function.eval(&[n * RADIANS_PER_DEGREE]),
            );
            let message = format!(
                "{name} takes radians: {name}({n}) is {}, {name}({n}D) is {}",
                rounded(as_is),
                rounded(as_degrees)
            );
            let help = format!("the suffix D makes degrees of a literal: {n}D");
            Some(Doubt::new(span, CODE, message, help))
        }
        F::SinDegrees | F::CosDegrees | F::TanDegrees => {
            let turned = matches!(
                ast.node(x),
                Node::Call {
                    callee: Callee::Function(F::Radians),
                    ..
                }
            );
            let message = format!("{name} takes degrees here, and this gives it radians");
            turned.then(|| Doubt::new(span, CODE, message, "leave radians(...) out"))
        }
        _ => None,
    }
}

/// Returns the factor n of n*TIME, with its node, where it looks like degrees.
fn times_time(ast: &Ast, ix: NodeIx) -> Option<(NodeIx, f64)> {
    let Node::Binary(BinaryOp::Mul, a, b) = *ast.node(ix) else {
        return None;
    };
    let factor = match (ast.node(a), ast.node(b)) {
        (_, Node::Constant(Constant::Time)) => a,
        (Node::Constant(Constant::Time), _) => b,
        _ => return None,
    };
    // 0 is not degree-sized
    let n = number(ast, factor).unwrap_or(0.0);
    (degree_sized(n) && n % 45.0 == 0.0).then_some((factor, n))
}

/// Returns `45*TIME is 7.16 turns in a unit of time, 45D*TIME is 0.125`.
fn speeds(n: f64) -> String {
    format!(
        "{n}*TIME is {} turns in a unit of time, {n}D*TIME is {}",
        rounded(n / TAU),
        rounded(n / 360.0)
    )
}

/// Warns of degrees for the radians of an angle: AZ(1,2)-25.
fn difference(ast: &Ast, ix: NodeIx, op: BinaryOp, a: NodeIx, b: NodeIx) -> Option<Doubt> {
    use Measure as M;
    let angle = |ix| match *ast.node(ix) {
        Node::Call {
            callee: Callee::Measure(m),
            ..
        } => matches!(
            m,
            M::Ax
                | M::Ay
                | M::Az
                | M::Psi
                | M::Theta
                | M::Phi
                | M::Yaw
                | M::Pitch
                | M::Roll
                | M::Incang
        )
        .then_some(m),
        _ => None,
    };
    let (measure, n) = match (angle(a), angle(b)) {
        (Some(m), None) => (m, number(ast, b)?),
        (None, Some(m)) => (m, number(ast, a)?),
        _ => return None,
    };
    let message = format!(
        "{} is in radians: {n} is {} turns, {n}D is {}",
        measure.name(),
        rounded(n / TAU),
        rounded(n / 360.0)
    );
    let help = format!("the suffix D makes degrees of a literal: {n}D");
    debug_assert!(matches!(op, BinaryOp::Add | BinaryOp::Sub));
    looks_like_degrees(n).then(|| Doubt::new(place(ast, ix), CODE, message, help))
}

/// Warns of AX(1,2) and AY(1,2) in one expression: once for a pair of markers, at the second axis.
pub(super) fn of_several_axes(ast: &Ast) -> Vec<Doubt> {
    let mut first: Vec<([u32; 4], Measure, bool)> = Vec::new();
    let mut doubts = Vec::new();
    for ix in 0..ast.nodes.len() as NodeIx {
        let Node::Call {
            callee: Callee::Measure(m @ (Measure::Ax | Measure::Ay | Measure::Az)),
            ..
        } = *ast.node(ix)
        else {
            continue;
        };
        let Some(crate::expr::program::Input::Measure(_, markers)) = ast.input(ix) else {
            continue;
        };
        match first.iter_mut().find(|(of, ..)| *of == markers) {
            None => first.push((markers, m, false)),
            Some((_, other, told)) if *other != m && !*told => {
                *told = true;
                let message = format!(
                    "{} and {} of the same markers are projections, not angles of one sequence: \
                     together they hold only while both are small",
                    other.name(),
                    m.name()
                );
                let help =
                    "YAW, PITCH and ROLL, or PSI, THETA and PHI, are the angles of one sequence";
                doubts.push(Doubt::new(
                    place(ast, ix),
                    "angles_of_several_axes",
                    message,
                    help,
                ));
            }
            Some(_) => {}
        }
    }
    doubts
}

/// Returns the warnings about an expression whose value is an angle in radians, as the FUNCTION of
/// a MOTION that turns: 90, 360*TIME, STEP(TIME, 0, 0, 1, 90), 40*SIN(TIME).
pub fn degrees_in_angle(ast: &Ast, text: &str) -> Vec<Diagnostic> {
    let mut doubts = Vec::new();
    for (sign, term) in terms(ast) {
        let term = amplitude(ast, term);
        let speed = times_time(ast, term);
        let angle = number(ast, term).filter(|&n| looks_like_degrees(n));
        let (span, message, n) = if let Some((factor, n)) = speed {
            (
                place(ast, factor),
                format!("the angle is in radians: {}", speeds(n)),
                format!("{n}D*TIME"),
            )
        } else if let Some(n) = angle {
            (place(ast, term), turns(sign * n), format!("{n}D"))
        } else if let Some((at, n)) = step_height(ast, term) {
            (place(ast, at), turns(n), format!("{n}D"))
        } else {
            continue;
        };
        let help = format!("the suffix D makes degrees of a literal: {n}");
        doubts.push(Doubt::new(span, CODE, message, help));
    }
    said(doubts, text)
}

/// Returns the warnings about an expression whose value is an angular velocity in radians per unit
/// of time: 360 for one turn.
pub fn degrees_in_speed(ast: &Ast, text: &str) -> Vec<Diagnostic> {
    let fits = |n: f64| n % 90.0 == 0.0 && degree_sized(n);
    let mut doubts = Vec::new();
    for (_, term) in terms(ast) {
        if let Some(n) = number(ast, term).filter(|&n| fits(n)) {
            let message = format!(
                "the speed is in radians: {n} is {} turns in a unit of time, {n}D is {}",
                rounded(n / TAU),
                rounded(n / 360.0)
            );
            let help = format!("the suffix D makes degrees of a literal: {n}D");
            doubts.push(Doubt::new(place(ast, term), CODE, message, help));
        }
    }
    said(doubts, text)
}

/// Returns `the angle is in radians: 90 is 14.3 turns, 90D is 0.25`.
fn turns(n: f64) -> String {
    format!(
        "the angle is in radians: {n} is {} turns, {n}D is {}",
        rounded(n / TAU),
        rounded(n / 360.0)
    )
}

/// Returns the terms of a sum with their signs.
fn terms(ast: &Ast) -> Vec<(f64, NodeIx)> {
    let mut found = Vec::new();
    let mut rest = vec![(1.0, ast.root)];
    while let Some((sign, ix)) = rest.pop() {
        match *ast.node(ix) {
            Node::Binary(BinaryOp::Add, a, b) => rest.extend([(sign, b), (sign, a)]),
            Node::Binary(BinaryOp::Sub, a, b) => rest.extend([(-sign, b), (sign, a)]),
            Node::Plus(x) => rest.push((sign, x)),
            Node::Negate(x) => rest.push((-sign, x)),
            _ => found.push((sign, ix)),
        }
    }
    found
}

/// Returns the factor of a product whose other factors lie between −1 and 1, and the amplitude of
/// SHF; what is neither stays as it is.
fn amplitude(ast: &Ast, term: NodeIx) -> NodeIx {
    if let Node::Call {
        callee: Callee::Function(Function::Shf),
        args,
    } = ast.node(term)
    {
        return args.get(2).copied().unwrap_or(term);
    }
    let (mut large, mut rest) = (None, vec![term]);
    while let Some(ix) = rest.pop() {
        match *ast.node(ix) {
            Node::Binary(BinaryOp::Mul, a, b) => rest.extend([a, b]),
            _ if is_bounded(ast, ix) => {}
            _ if large.is_some() => return term,
            _ => large = Some(ix),
        }
    }
    large.unwrap_or(term)
}

/// Returns whether the values of a call lie between −1 and 1.
fn is_bounded(ast: &Ast, ix: NodeIx) -> bool {
    let Node::Call {
        callee: Callee::Function(function),
        ref args,
    } = *ast.node(ix)
    else {
        return false;
    };
    let small = |ix: NodeIx| number(ast, ix).is_some_and(|h| h.abs() <= 1.0);
    match (function, args.as_slice()) {
        (Function::Sin | Function::Cos | Function::Tanh, _) => true,
        (Function::Step | Function::Step5 | Function::Havsin, &[_, _, h0, _, h1]) => {
            small(h0) && small(h1)
        }
        _ => false,
    }
}

/// Returns the larger height of a step, if it looks like degrees.
fn step_height(ast: &Ast, ix: NodeIx) -> Option<(NodeIx, f64)> {
    let Node::Call {
        callee: Callee::Function(Function::Step | Function::Step5 | Function::Havsin),
        ref args,
    } = *ast.node(ix)
    else {
        return None;
    };
    let &[_, _, h0, _, h1] = args.as_slice() else {
        return None;
    };
    let height = |ix: NodeIx| number(ast, ix).map(|n| (ix, n));
    let (a, b) = (height(h0)?, height(h1)?);
    let larger = if b.1.abs() >= a.1.abs() { b } else { a };
    Some(larger).filter(|h| looks_like_degrees(h.1))
}

/// Returns the message for an angle in radians, given as one number, that looks like degrees.
///
/// Angles of orientations and initial angles are hardly ever more than a turn, and then no whole
/// multiple of five.
pub fn reads_as_degrees(angle: f64) -> Option<String> {
    (degree_sized(angle) && angle % 5.0 == 0.0).then(|| turns(angle))
}

/// Returns whether a number is more than one turn in radians and at most ten turns in degrees.
fn degree_sized(n: f64) -> bool {
    n.abs() > TAU && n.abs() <= 3600.0
}

/// Returns whether a number is degree-sized, a multiple of five, and not round in every unit.
fn looks_like_degrees(n: f64) -> bool {
    degree_sized(n) && n % 5.0 == 0.0 && ![10.0, 20.0, 50.0, 100.0, 1000.0].contains(&n.abs())
}
