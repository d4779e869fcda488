//! Continuity of an expression: the places where it is not smooth, and the derivative that jumps
//! there.
//!
//! Every operation that can break has a switching value and levels: comparisons their difference
//! and zero, roundings their argument and the integers, tables their argument and the knots. Those
//! that depend on one variable alone (usually TIME) have fixed roots, which are found on an
//! interval. At each root the expression is evaluated over [`Germ`] on either side, and the
//! one-sided derivatives are compared. So `ABS(TIME)**3` is C2 at 0, and
//! `STEP(TIME,1,0,2,1) - STEP(TIME,1,0,2,1)` smooth.
//!
//! Values that depend on other inputs vanish on surfaces in the space of inputs. Points on them are
//! sought from several starting points, and the expression is compared along the normal there.

use super::Expr;
use super::functions::Continuity;
use super::interpolation::Bindings;
use super::program::{Break, Builder, Folding, Input, Levels, Program, Value, Work};
use crate::arrange::Arrange;
use crate::diagnostic::Error;
use crate::scalar::{Germ, Interval, ORDERS, Scalar};
use std::fmt;
use std::ops::RangeInclusive;

/// The smoothness of an expression.
///
/// ```
/// use cognate::expr::{Expr, functions::Continuity, interpolation::Bindings};
/// let f = Expr::parse("STEP(TIME,1,0,2,1)")?;
/// let found = f.smoothness(&Bindings::default(), 0.0..=10.0)?;
/// assert_eq!(found.class, Continuity::C1);
/// let times: Vec<f64> = found.breakpoints.iter().map(|b| b.at).collect();
/// assert_eq!(times, [1.0, 2.0]);
/// assert_eq!(found.breakpoints[0].order, 2);
/// assert_eq!(found.breakpoints[0].jump(2), 6.0);
/// # Ok::<(), cognate::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothness {
    /// worst class of all breaks below; [`Continuity::Jump`] too where the past is read (DELAY)
    pub class: Continuity,
    /// breaks in the interior of the interval, increasing
    pub breakpoints: Vec<Breakpoint>,
    /// breaks in the space of its other inputs
    pub surfaces: Vec<Surface>,
    /// all switching functions with their levels, whether they break or not
    pub switches: Vec<String>,
    /// whether all breakpoints are listed
    pub complete: bool,
}

/// A point where an expression is not smooth in its variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Breakpoint {
    /// value of the variable
    pub at: f64,
    /// the lowest derivative that jumps, becomes infinite or ends there: 0 the value, 1 the slope,
    /// 2 the curvature
    pub order: usize,
    /// limits of the derivatives from below (index = order): NaN where there is none, infinite
    /// where it grows without bound
    pub before: [f64; ORDERS],
    /// limits of the derivatives from above
    pub after: [f64; ORDERS],
}

impl Breakpoint {
    /// Returns the class of an expression that has this break and no worse one.
    pub fn class(&self) -> Continuity {
        class(self.order)
    }
    /// Returns the jump of the `k`-th derivative (0: the value); 0 where it does not jump or `k` is
    /// too high to be known.
    pub fn jump(&self, k: usize) -> f64 {
        match (self.before.get(k), self.after.get(k)) {
            (Some(before), Some(after)) if k >= self.order => after - before,
            _ => 0.0,
        }
    }
}

/// A surface in the space of inputs on which an expression is not smooth: where a switching
/// function has a level.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// the switching function
    pub switch: String,
    /// levels in words (` at whole numbers`); empty for zero
    pub levels: String,
    /// inputs that the switching function reads
    pub inputs: Vec<Input>,
    /// the lowest derivative across the surface that jumps
    pub order: usize,
}

/// Names the derivative of an order: `value`, `slope`, `curvature`, `third derivative`, …
pub fn derivative_name(order: usize) -> &'static str {
    const NAMES: [&str; ORDERS] = [
        "value",
        "slope",
        "curvature",
        "third derivative",
        "fourth derivative",
        "fifth derivative",
    ];
    NAMES.get(order).unwrap_or(&"a higher derivative")
}

/// Prints, for example, `slope jumps from -1 to 1`.
impl fmt::Display for Breakpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = derivative_name(self.order);
        match (self.before.get(self.order), self.after.get(self.order)) {
            (Some(before), Some(after)) if before == after || before.is_nan() && after.is_nan() => {
                write!(f, "{name} has no value")
            }
            (Some(before), Some(after)) => {
                let side = |x: &f64| match x {
                    x if x.is_nan() => "no value".to_string(),
                    // a zero has no sign here
                    x => format!("{}", x + 0.0).replace("inf", "infinity"),
                };
                write!(f, "{name} jumps from {} to {}", side(before), side(after))
            }
            _ => write!(f, "{name} jumps"),
        }
    }
}

/// Prints, for example, `DX(1, 2) - 0.5 = 0: slope jumps`.
impl fmt::Display for Surface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let levels = match self.levels.as_str() {
            "" => " = 0",
            levels => levels,
        };
        let name = derivative_name(self.order);
        write!(f, "{}{levels}: {name} jumps", self.switch)
    }
}

/// Returns the class of an expression whose derivative of this order is the first to jump.
pub fn class(order: usize) -> Continuity {
    match order {
        0 => Continuity::Jump,
        1 => Continuity::C0,
        2 => Continuity::C1,
        3..ORDERS => Continuity::C2,
        _ => Continuity::Smooth,
    }
}

impl Expr {
    /// Finds the smoothness for TIME in an interval, and for any values of its other inputs. Breaks
    /// at the ends do not count.
    ///
    /// # Errors
    /// A spline or curve that is not bound.
    pub fn smoothness(
        &self,
        bindings: &Bindings,
        interval: RangeInclusive<f64>,
    ) -> Result<Smoothness, Error> {
        Ok(smoothness(
            &self.compile(bindings)?,
            0,
            Input::Time,
            interval,
        ))
    }
}

/// Most breakpoints that are listed.
pub const MOST_BREAKPOINTS: usize = 1000;
/// Number of cells of the interval in which a single crossing is found; more crossings show by the
/// slopes at the ends of a cell.
const CELLS: usize = 1024;
/// Number of starting points for surfaces, and of draws of other inputs at a breakpoint.
const DRAWS: usize = 12;
/// Distance of the two ends of a touch, and part of their jumps that may remain when they cancel.
const TOUCH_TOLERANCE: f64 = 1e-6;
/// Jump of a value or a slope from one side of a point to the other, where rounding hides what is
/// between, over their size, up to which there is none.
const BESIDE_TOLERANCE: f64 = 1e-3;
/// Jump, as a part of the derivative that jumps, below which it is rounding.
const NEGLIGIBLE_JUMP: f64 = 1e-9;

/// Finds the smoothness of an output of a program in one of its inputs within an interval, and
/// across the surfaces of the others.
///
/// Roots that lie closer together than a thousandth of the interval are found if the switching
/// function turns between them once.
pub fn smoothness(
    program: &Program,
    output: usize,
    variable: Input,
    interval: RangeInclusive<f64>,
) -> Smoothness {
    let mut builder = Builder::new(Folding::Strict);
    let written = program.record(&mut builder)[output];
    let (value, breaks) = builder.breaks(written);
    let mut inputs = builder.inputs_of(&[value]);
    inputs.retain(|&i| i != variable);
    inputs.insert(0, variable);
    let whole = Whole {
        program: builder.finish_with_inputs(&[value], &inputs),
        inputs,
    };
    let switches = breaks
        .iter()
        .map(|b| format!("{}{}", builder.text(b.value), b.levels))
        .collect();
    let (timed, others): (Vec<Break>, Vec<Break>) = breaks
        .into_iter()
        .partition(|b| builder.inputs_of(&[b.value]) == [variable]);
    let mut candidates = Candidates::new(interval);
    for b in &timed {
        candidates.search(&mut builder, b, variable);
    }
    let mut breakpoints: Vec<Breakpoint> = candidates
        .times()
        .into_iter()
        .filter_map(|t| whole.at(t))
        .collect();
    without_touches(&mut breakpoints);
    let complete = candidates.complete && breakpoints.len() <= MOST_BREAKPOINTS;
    breakpoints.truncate(MOST_BREAKPOINTS);
    let surfaces: Vec<Surface> = others
        .iter()
        .filter_map(|b| whole.surface(&mut builder, b))
        .collect();
    let history = whole.inputs.iter().any(|i| matches!(i, Input::Delayed(_)));
    let worst = breakpoints
        .iter()
        .map(|b| b.order)
        .chain(surfaces.iter().map(|s| s.order))
        .chain(history.then_some(0))
        .min();
    Smoothness {
        class: worst.map_or(Continuity::Smooth, class),
        breakpoints,
        surfaces,
        switches,
        complete,
    }
}

/// Removes jumps that the next one reverses at once. Where a value only touches a level, as SIN
/// does at 1, rounding keeps it there for about the square root of the machine precision; nothing
/// crosses.
fn without_touches(breakpoints: &mut Vec<Breakpoint>) {
    let mut kept: Vec<Breakpoint> = Vec::with_capacity(breakpoints.len());
    let mut rest = breakpoints.drain(..).peekable();
    while let Some(first) = rest.next() {
        let mut group = vec![first];
        while let Some(next) = rest.next_if(|b| {
            let last = &group[group.len() - 1];
            b.order == last.order
                && b.order <= 1
                && b.at - last.at <= TOUCH_TOLERANCE * b.at.abs().max(1.0)
        }) {
            group.push(next);
        }
        let k = group[0].order;
        let (before, after) = (group[0].before[k], group[group.len() - 1].after[k]);
        let cancel = (before - after).abs() <= TOUCH_TOLERANCE * before.abs();
        if group.len() >= 2 && !cancel && group[0].order > 0 {
            // one kink, which rounding hides; the shortest digits are the likelier ones
            group.arrange_by_key(|b| b.at.to_string().len());
            group.truncate(1);
        }
        if group.len() < 2 || !cancel {
            kept.append(&mut group);
        }
    }
    drop(rest);
    *breakpoints = kept;
}

/// Candidate roots of switching functions of one variable.
struct Candidates {
    from: f64,
    to: f64,
    /// roots found so far
    found: Vec<f64>,
    /// whether there was room for all
    complete: bool,
}

impl Candidates {
    fn new(interval: RangeInclusive<f64>) -> Self {
        let (from, to) = interval.into_inner();
        Self {
            from,
            to,
            found: Vec::new(),
            complete: true,
        }
    }

    /// Returns the roots inside the interval, each once.
    fn times(&mut self) -> Vec<f64> {
        let (from, to) = (self.from, self.to);
        self.found.retain(|&t| from < t && t < to);
        self.found.sort_unstable_by(f64::total_cmp);
        // the same root by another formula differs by rounding; the shortest digits are the
        // likelier ones
        let width = (to - from) * 1e-14;
        let mut times: Vec<f64> = Vec::new();
        for &t in &self.found {
            match times.last_mut() {
                Some(last) if t - *last <= width.max(8.0 * f64::EPSILON * t.abs()) => {
                    if t.to_string().len() < last.to_string().len() {
                        *last = t;
                    }
                }
                _ => times.push(t),
            }
        }
        times
    }

    /// Looks for the roots of a break: the places where its value reaches a level.
    fn search(&mut self, builder: &mut Builder, b: &Break, variable: Input) {
        if self.from >= self.to || self.from.is_nan() || self.to.is_nan() {
            return;
        }
        let time = builder.input(variable);
        let slope = builder.gradient(b.value, &[time])[0];
        let program = builder.finish_with_inputs(&[b.value, slope], &[variable]);
        let mut work = Work::default();
        let mut function = |t: f64| {
            let mut out = [0.0; 2];
            program.run(&[t], &mut work, &mut out);
            (out[0], out[1])
        };
        let span = self.to - self.from;
        // whether bounds of the value just beside some times, which rounding is part of, reach a
        // level
        let touches = |from: f64, to: f64| {
            let room = 4.0 * f64::EPSILON * from.abs().max(to.abs()).max(span);
            let beside = [Interval::between(from - room, to + room)];
            let mut bound = [beside[0]; 2];
            program.eval(&beside, &mut Work::default(), &mut bound);
            let [lo, hi] = [bound[0].lo, bound[0].hi].map(|x| b.levels.place(x));
            lo != hi && !(lo.is_nan() && hi.is_nan())
        };
        let touches = &touches;
        let mut left = (self.from, function(self.from));
        for k in 1..=CELLS {
            let part = k as f64 / CELLS as f64;
            let t = self.from + (self.to - self.from) * part;
            let right = (t, function(t));
            self.cell(&mut function, &b.levels, touches, left, right, 0);
            left = right;
        }
    }

    /// Finds the roots inside a cell.
    fn cell(
        &mut self,
        function: &mut impl FnMut(f64) -> (f64, f64),
        levels: &Levels,
        touches: &impl Fn(f64, f64) -> bool,
        left: (f64, (f64, f64)),
        right: (f64, (f64, f64)),
        depth: usize,
    ) {
        let (place_left, place_right) = (levels.place(left.1.0), levels.place(right.1.0));
        let same = place_left == place_right || place_left.is_nan() && place_right.is_nan();
        // the same side at both ends: the function may have crossed twice, or touch, if it turns
        let turns = left.1.1 * right.1.1 < 0.0;
        if same && !turns {
            return;
        }
        if self.found.len() > 8 * MOST_BREAKPOINTS {
            self.complete = false;
            return;
        }
        let middle = left.0 + (right.0 - left.0) / 2.0;
        if middle <= left.0 || right.0 <= middle || depth > 1100 {
            if !same || touches(left.0, right.0) {
                let off = |x: f64| {
                    let distance = (x - levels.nearest(x)).abs();
                    if distance.is_nan() {
                        f64::INFINITY
                    } else {
                        distance
                    }
                };
                let nearer = off(right.1.0) < off(left.1.0);
                self.found.push(if nearer { right.0 } else { left.0 });
            }
            return;
        }
        let middle = (middle, function(middle));
        // a turn just in the middle
        if same && middle.1.1 == 0.0 && touches(middle.0, middle.0) {
            self.found.push(middle.0);
            return;
        }
        self.cell(function, levels, touches, left, middle, depth + 1);
        self.cell(function, levels, touches, middle, right, depth + 1);
    }
}

/// The expression with calls expanded; its first input is the variable.
struct Whole {
    program: Program,
    inputs: Vec<Input>,
}

/// One-sided derivatives along a line.
struct Sides {
    /// derivatives before, with rounding errors
    before: [(f64, f64); ORDERS],
    /// derivatives after, with rounding errors
    after: [(f64, f64); ORDERS],
}

impl Whole {
    /// Returns the one-sided derivatives at a place along a direction, or `None` where there is no
    /// value on either side.
    fn sides(&self, place: &[f64], direction: &[f64]) -> Option<Sides> {
        let mut work = Work::default();
        let mut side = |sign: f64| {
            let inputs: Vec<Germ> = place
                .iter()
                .zip(direction)
                .map(|(&at, &d)| Germ::line(at, sign * d))
                .collect();
            let mut out = [Germ::line(f64::NAN, 0.0)];
            self.program.eval(&inputs, &mut work, &mut out);
            out[0]
        };
        let (before, after) = (side(-1.0), side(1.0));
        if before.limit().is_nan() && after.limit().is_nan() {
            return None;
        }
        let of = |germ: Germ, sign: f64| {
            std::array::from_fn(|k| {
                let (d, noise) = germ.derivative_at(k);
                (if k % 2 == 1 { sign * d } else { d }, noise)
            })
        };
        Some(Sides {
            before: of(before, -1.0),
            after: of(after, 1.0),
        })
    }

    /// Returns the break at a value of the variable, for any values of the other inputs.
    fn at(&self, t: f64) -> Option<Breakpoint> {
        let n = self.inputs.len();
        let mut direction = vec![0.0; n];
        direction[0] = 1.0;
        let mut worst: Option<Breakpoint> = None;
        for draw in 0..if n == 1 { 1 } else { DRAWS } {
            let mut place = drawn(n, draw);
            place[0] = t;
            let Some(sides) = self.sides(&place, &direction) else {
                if n == 1 && self.ends_at(t) {
                    return Some(Breakpoint {
                        at: t,
                        order: 0,
                        before: [f64::NAN; ORDERS],
                        after: [f64::NAN; ORDERS],
                    });
                }
                continue;
            };
            if n == 1 && sides.lack_a_value() && self.has_values_beside(t) {
                return self.beside(t);
            }
            let mut order = sides.order();
            if n == 1 && order != Some(0) && self.is_isolated(t, &sides) {
                order = Some(0);
            }
            if let Some(order) = order
                && worst.as_ref().is_none_or(|w| order < w.order)
            {
                worst = Some(Breakpoint {
                    at: t,
                    order,
                    before: sides.before.map(|d| d.0),
                    after: sides.after.map(|d| d.0),
                });
            }
        }
        worst
    }

    /// Returns the break between two places on either side of a point, as what holds at them says:
    /// rounding alone takes the value at the point out of a domain (`ACOS(COS(TIME))` at 0).
    fn beside(&self, t: f64) -> Option<Breakpoint> {
        let room = TOUCH_TOLERANCE * t.abs().max(1.0);
        let side = |at: f64, sign: f64| -> [f64; ORDERS] {
            let sides = self.sides(&[at], &[1.0]);
            let there = sides.map_or([f64::NAN; ORDERS], |s| s.after.map(|d| d.0));
            // continued to the point by its derivatives
            std::array::from_fn(|k| {
                let mut term = 1.0;
                (k..ORDERS).fold(0.0, |sum, j| {
                    let sum = sum + term * there[j];
                    term *= sign * room / (j - k + 1) as f64;
                    sum
                })
            })
        };
        let (before, after) = (side(t - room, 1.0), side(t + room, -1.0));
        let size = |x: f64| x.abs().max(1.0);
        let order = (0..=1).find(|&k| {
            let jump = (after[k] - before[k]).abs();
            jump > BESIDE_TOLERANCE * size(before[k]).max(size(after[k]))
        })?;
        Some(Breakpoint {
            at: t,
            order,
            before,
            after,
        })
    }

    /// Returns whether there are values on both sides of a point.
    fn has_values_beside(&self, t: f64) -> bool {
        let room = TOUCH_TOLERANCE * t.abs().max(1.0);
        [t - room, t + room].into_iter().all(|t| {
            let mut out = [0.0];
            self.program.run(&[t], &mut Work::default(), &mut out);
            out[0].is_finite()
        })
    }

    /// Returns whether there is a value beside a point, but not on all sides of it: a logarithm
    /// there has no limit that derivatives tell.
    fn ends_at(&self, t: f64) -> bool {
        let beside = TOUCH_TOLERANCE * t.abs().max(1.0);
        let mut work = Work::default();
        let mut has_value = |t: f64| {
            let mut out = [0.0];
            self.program.run(&[t], &mut work, &mut out);
            out[0].is_finite()
        };
        let found = [t - beside, t, t + beside].map(&mut has_value);
        (found[0] || found[2]) && !found.iter().all(|&is| is)
    }

    /// Returns whether the value at a point differs from its limit.
    fn is_isolated(&self, t: f64, sides: &Sides) -> bool {
        let mut out = [0.0];
        self.program.run(&[t], &mut Work::default(), &mut out);
        let limit = sides.before[0].0;
        let noise = 1e3 * (sides.before[0].1 + sides.after[0].1);
        let off = (out[0] - limit).abs();
        off.is_nan() || off > noise.max(1e-6 * limit.abs()).max(1e-9)
    }

    /// Returns the break of the expression where a switching function has a level.
    fn surface(&self, builder: &mut Builder, b: &Break) -> Option<Surface> {
        let own = builder.inputs_of(&[b.value]);
        let variables: Vec<Value> = self.inputs.iter().map(|&i| builder.input(i)).collect();
        let gradient = builder.gradient(b.value, &variables);
        let outputs: Vec<Value> = [b.value].into_iter().chain(gradient).collect();
        let program = builder.finish_with_inputs(&outputs, &self.inputs);
        let mut order = None;
        for draw in 0..DRAWS {
            if let Some((place, normal)) = met(&program, &b.levels, drawn(self.inputs.len(), draw))
                && let Some(found) = self.sides(&place, &normal).and_then(|s| s.order())
            {
                order = Some(order.map_or(found, |o: usize| o.min(found)));
            }
        }
        Some(Surface {
            switch: builder.text(b.value),
            levels: b.levels.to_string(),
            inputs: own,
            order: order?,
        })
    }
}

impl Sides {
    /// Returns whether the value has no limit on one side.
    fn lack_a_value(&self) -> bool {
        self.before[0].0.is_nan() || self.after[0].0.is_nan()
    }

    /// Returns the lowest derivative that jumps, or `None` if none does as far as known.
    fn order(&self) -> Option<usize> {
        (0..ORDERS).find(|&k| {
            let ((before, n), (after, m)) = (self.before[k], self.after[k]);
            if before.is_nan() && after.is_nan() && k > 0 {
                return false;
            }
            let size = before.abs().max(after.abs());
            let jump = (after - before).abs();
            // an infinite derivative breaks, even if it is the same on both sides
            !size.is_finite() || jump > (NEGLIGIBLE_JUMP * size).max(1e3 * (n + m))
        })
    }
}

/// Returns some values of inputs: of several sizes and both signs, the same each time.
fn drawn(n: usize, draw: usize) -> Vec<f64> {
    (0..n)
        .map(|k| {
            // Weyl sequences of different irrational steps
            let step = (2.0 + k as f64).sqrt() + Scalar::powf(3.0 + 2.0 * k as f64, 1.0 / 3.0);
            let u = (step * (draw as f64 + 1.0)).fract();
            let size = [1.0, 1.0, 0.1, 10.0, 1.0, 100.0][draw % 6];
            let sign = if draw.is_multiple_of(2) || u < 0.25 {
                1.0
            } else {
                -1.0
            };
            sign * size * (0.3 + u)
        })
        .collect()
}

/// Finds a place near a given one where a function has a level, and the unit normal there.
/// `program`: the function and its gradient.
fn met(program: &Program, levels: &Levels, mut place: Vec<f64>) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = place.len();
    let mut out = vec![0.0; n + 1];
    let mut work = Work::default();
    let mut level = None;
    for _ in 0..60 {
        program.run(&place, &mut work, &mut out);
        let level = *level.get_or_insert_with(|| levels.nearest(out[0]));
        let off = out[0] - level;
        let gradient = &out[1..];
        let square: f64 = gradient.iter().map(|g| g * g).sum();
        if square == 0.0 || !square.is_finite() || !off.is_finite() {
            return None;
        }
        let size: f64 = place.iter().zip(gradient).map(|(x, g)| (x * g).abs()).sum();
        if off.abs() <= 4.0 * f64::EPSILON * size.max(level.abs()) {
            let norm = square.sqrt();
            return Some((place.clone(), gradient.iter().map(|g| g / norm).collect()));
        }
        for (x, g) in place.iter_mut().zip(&out[1..]) {
            *x -= off * g / square;
        }
    }
    None
}
