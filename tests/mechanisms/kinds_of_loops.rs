//! Loops of many kinds, by every method: what arrives is right by a law that knows nothing of loops, what does not says why.
//!
//! Scissor lifts and slider-cranks have one freedom, whose energy gives their motion by quadrature; a truss whose bars share pins is
//! two rigid bodies; loops in space keep their length, their energy and their symmetry.

use crate::running;

use cognate::results::Status;
use running::{Analysis, GROUND, begin, options_by, try_to, values, whole};
use std::fmt::Write;

const GRAVITY: f64 = 9.81;
/// Outputs of the runs that are compared with; a tenth of a percent of them is seen by every second run only.
const FINE: usize = 1000;
const COARSE: usize = 10;

/// Statements of a mechanism whose parts are drawn where they begin, in coordinates of ground.
struct Drawn {
    text: String,
    parts: usize,
    markers: usize,
    joints: usize,
}

impl Drawn {
    fn new() -> Self {
        Drawn {
            text: GROUND.into(),
            parts: 1,
            markers: 1,
            joints: 0,
        }
    }

    /// A marker of a part, with further arguments.
    fn marker(&mut self, part: usize, [x, y, z]: [f64; 3], more: &str) -> usize {
        self.markers += 1;
        let m = self.markers;
        writeln!(
            self.text,
            "MARKER/{m}, PART={part}, QP={x:?},{y:?},{z:?}{more}"
        )
        .unwrap();
        m
    }

    /// A part with its centre between its points: its number, its centre, a marker at each point.
    fn bar(
        &mut self,
        points: &[[f64; 3]],
        [mass, inertia]: [f64; 2],
        more: &str,
    ) -> (usize, usize, Vec<usize>) {
        self.parts += 1;
        let part = self.parts;
        let centre =
            [0, 1, 2].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64);
        let cm = self.marker(part, centre, "");
        writeln!(
            self.text,
            "PART/{part}, MASS={mass:?}, CM={cm}, IP={inertia:?},{inertia:?},{inertia:?}{more}"
        )
        .unwrap();
        let at = points.iter().map(|p| self.marker(part, *p, "")).collect();
        (part, cm, at)
    }

    fn joint(&mut self, kind: &str, i: usize, j: usize) {
        self.joints += 1;
        writeln!(self.text, "JOINT/{}, {kind}, I={i}, J={j}", self.joints).unwrap();
    }

    /// A point on the x axis of ground along which a part slides.
    fn slide(&mut self, part: usize, at: [f64; 3]) {
        let along = ", REULER=90D,90D,0";
        let (i, j) = (self.marker(part, at, along), self.marker(1, at, along));
        self.joint("TRANSLATIONAL", i, j);
    }

    fn spring(&mut self, i: usize, j: usize, [stiffness, length]: [f64; 2]) {
        writeln!(
            self.text,
            "SPRINGDAMPER/{i}, TRANSLATION, I={i}, J={j}, K={stiffness:?}, L={length:?}, C=0"
        )
        .unwrap();
    }

    fn falls(mut self) -> String {
        writeln!(self.text, "ACCGRAV/JGRAV={:?}\nEND", -GRAVITY).unwrap();
        self.text
    }
}

/// Values of columns at all outputs of one run, and how it ended.
fn moved(
    text: &str,
    columns: &[String],
    (method, request): (&str, f64),
    (end, outputs): (f64, usize),
) -> (Vec<Vec<f64>>, Result<(), String>, f64) {
    let names: Vec<_> = columns.iter().map(String::as_str).collect();
    let options = options_by(&names, method, request);
    let mut s = begin(whole(text), "loops", options);
    let status = try_to(&mut s, Analysis::Dynamic, end, outputs);
    let found = columns.iter().map(|c| values(&s, c).to_vec()).collect();
    let record = &s.run.record;
    let ended = match status {
        Status::Completed => Ok(()),
        _ => Err(record.stop_reason.clone()),
    };
    (found, ended, record.energy.error())
}

/// Runs a mechanism by every method: its columns are those of `exact`, at a thousand outputs, and its energy stays; or the run says
/// which element ended it. Most arrive.
fn right_or_told(name: &str, text: &str, columns: &[String], exact: &[Vec<f64>], end: f64) {
    let (mut wrong, mut arrived, mut runs) = (Vec::new(), 0, 0);
    for (method, requests) in [
        ("AUTO", &[1e-2, 1e-4, 1e-6, 1e-8][..]),
        ("DOP853", &[1e-3, 1e-7]),
        ("RADAU5", &[1e-2, 1e-5]),
    ] {
        for &request in requests {
            let outputs = if runs % 2 == 0 { COARSE } else { FINE };
            runs += 1;
            let (found, ended, drift) = moved(text, columns, (method, request), (end, outputs));
            arrived += usize::from(ended.is_ok());
            let told = ended
                .as_ref()
                .err()
                .is_none_or(|why| why.contains("JOINT/"));
            let mut off = 0.0_f64;
            for (found, exact) in found.iter().zip(exact) {
                let width = exact
                    .iter()
                    .fold(0.0, |m: f64, x| m.max((x - exact[0]).abs()));
                let rows = found.len() - usize::from(ended.is_err());
                let exact = exact.iter().step_by(FINE / outputs);
                let pairs = found[..rows].iter().zip(exact);
                off = pairs.fold(off, |m, (a, b)| m.max((a - b).abs() / width));
            }
            if off > 30.0 * request || drift > 30.0 * request || !told {
                wrong.push(format!(
                    "{name} {method} {request:e}: off {off:e}, {drift:e}, {ended:?}"
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(2 * arrived > runs, "{name}: {arrived} of {runs}");
}

/// A coordinate at a thousand outputs whose rate is a function of its state: Runge-Kutta of order four, in steps that leave no error
/// beside those that are judged.
fn integrated<const N: usize>(
    rate: impl Fn([f64; N]) -> [f64; N],
    mut y: [f64; N],
    end: f64,
) -> Vec<[f64; N]> {
    const BETWEEN: usize = 40;
    let h = end / (FINE * BETWEEN) as f64;
    let plus = |y: [f64; N], k: [f64; N], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
    let mut all = vec![y];
    for n in 1..=FINE * BETWEEN {
        let a = rate(y);
        let b = rate(plus(y, a, h / 2.0));
        let c = rate(plus(y, b, h / 2.0));
        let d = rate(plus(y, c, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        if n % BETWEEN == 0 {
            all.push(y);
        }
    }
    all
}

/// Bars of a scissor lift: length, mass and inertia about their centres; the mass of its sliding foot.
const BAR: [f64; 3] = [2.0, 1.0, 0.1];
const FOOT: f64 = 0.5;

/// A scissor lift of so many cells at the angle θ of its bars, on a spring between its feet: text and the marker of the foot.
fn scissor_lift(cells: usize, angle: f64, spring: [f64; 2]) -> (String, usize) {
    let [length, mass, inertia] = BAR;
    let (x, y) = (length * angle.cos(), length * angle.sin());
    let mut m = Drawn::new();
    let foot = m.bar(&[[x, 0.0, 0.0]], [FOOT, 0.1], "");
    m.slide(foot.0, [x, 0.0, 0.0]);
    let fixed = m.marker(1, [0.0; 3], "");
    let (mut left, mut right) = (fixed, foot.2[0]);
    for k in 0..cells {
        let (low, high) = (k as f64 * y, (k + 1) as f64 * y);
        let middle = [x / 2.0, (low + high) / 2.0, 0.0];
        let up = [[0.0, low, 0.0], middle, [x, high, 0.0]];
        let down = [[x, low, 0.0], middle, [0.0, high, 0.0]];
        let (_, _, up) = m.bar(&up, [mass, inertia], "");
        let (_, _, down) = m.bar(&down, [mass, inertia], "");
        m.joint("REVOLUTE", up[0], left);
        m.joint("REVOLUTE", down[0], right);
        m.joint("REVOLUTE", up[1], down[1]);
        (left, right) = (down[2], up[2]);
    }
    m.spring(foot.1, fixed, spring);
    (m.falls(), foot.1)
}

#[test]
fn scissor_lifts_move_as_the_angle_of_their_bars() {
    let (start, end) = (0.9_f64, 1.0);
    for cells in [1, 12] {
        let [length, mass, inertia] = BAR;
        let n = cells as f64;
        let (stiffness, rest) = (40.0 * n * n, 0.7 * length * start.cos());
        // M = a + b sin² θ + c cos² θ of 2 n bars and the foot; Σ (k + ½)² = n³/3 − n/12
        let a = 2.0 * n * inertia;
        let b = length * length * (2.0 * n * mass / 4.0 + FOOT);
        let c = 2.0 * mass * length * length * (n.powi(3) / 3.0 - n / 12.0);
        let rate = |[angle, turning]: [f64; 2]| {
            let (s, k) = angle.sin_cos();
            let pull = mass * GRAVITY * length * n * n * k
                - stiffness * (length * k - rest) * length * s
                + (b - c) * s * k * turning * turning;
            [turning, -pull / (a + b * s * s + c * k * k)]
        };
        let angles = integrated(rate, [start, 0.0], end);
        let exact = angles
            .iter()
            .map(|[angle, _]| length * angle.cos())
            .collect();
        let (text, foot) = scissor_lift(cells, start, [stiffness, rest]);
        let columns = [format!("DX({foot},1)")];
        right_or_told(&format!("{cells} cells"), &text, &columns, &[exact], end);
    }
}

/// Slider-cranks in a row, each with the angle θ of its crank and its speed; springs between their sliders feel only differences.
fn slider_cranks(n: usize, [crank, rod]: [f64; 2], angle: f64, speed: f64) -> (String, [usize; 2]) {
    let mut m = Drawn::new();
    let mut sliders = Vec::new();
    let up = crank * angle.sin();
    let along = crank * angle.cos();
    let reach = along + (rod * rod - up * up).sqrt();
    for k in 0..n {
        let x = 6.0 * k as f64;
        let (a, b, c) = ([x, 0.0, 0.0], [x + along, up, 0.0], [x + reach, 0.0, 0.0]);
        let spin = format!(", WZ={speed:?}");
        let first = m.bar(&[a, b], [1.0, 0.1], &spin);
        let second = m.bar(&[b, c], [1.0, 0.1], "");
        let third = m.bar(&[c], [2.0, 0.1], "");
        let fixed = m.marker(1, a, "");
        m.joint("REVOLUTE", first.2[0], fixed);
        m.joint("REVOLUTE", first.2[1], second.2[0]);
        m.joint("REVOLUTE", second.2[1], third.2[0]);
        m.slide(third.0, c);
        sliders.push(third.1);
    }
    for pair in sliders.windows(2) {
        m.spring(pair[1], pair[0], [100.0, 6.0]);
    }
    (m.text + "END\n", [sliders[0], sliders[n - 1]])
}

#[test]
fn slider_cranks_in_a_row_turn_past_their_dead_points_with_the_energy_they_have() {
    let ([crank, rod], start, speed, end) = ([0.7_f64, 1.6_f64], 0.4_f64, 5.0, 2.0);
    // M(θ) of the energy M θ̇²/2, which stays
    let inertia = |angle: f64| {
        let (s, c) = angle.sin_cos();
        let far = (rod * rod - crank * crank * s * s).sqrt();
        let swing = crank * c / far;
        let slides = -crank * s - crank * s * swing;
        let middle = [(slides - crank * s) / 2.0, crank * c / 2.0];
        let of_rod = middle[0] * middle[0] + middle[1] * middle[1] + 0.1 * swing * swing;
        crank * crank / 4.0 + 0.1 + of_rod + 2.0 * slides * slides
    };
    let energy = inertia(start) * speed * speed;
    let angles = integrated(|[angle]| [(energy / inertia(angle)).sqrt()], [start], end);
    let reach = |angle: f64, at: f64| {
        let far = (rod * rod - (crank * angle.sin()).powi(2)).sqrt();
        at + crank * angle.cos() + far
    };
    for n in [1, 8] {
        let (text, sliders) = slider_cranks(n, [crank, rod], start, speed);
        let columns = sliders.map(|s| format!("DX({s},1)"));
        let at = [0.0, 6.0 * (n - 1) as f64];
        let exact = at.map(|at| angles.iter().map(|[angle]| reach(*angle, at)).collect());
        right_or_told(&format!("{n} sliders"), &text, &columns, &exact, end);
    }
}

/// A cantilever of `cells` triangles whose bars share pins; the lower chord of one cell is a spring. Also the same as one body that
/// hangs by that spring from a pin: text and the marker of its tip, each.
fn truss(cells: usize, sprung: usize, stiffness: f64) -> [(String, usize); 2] {
    let low = |k: usize| [k as f64, 0.0, 0.0];
    let high = |k: usize| [k as f64 + 0.4, 0.8, 0.0];
    let mut m = Drawn::new();
    // a marker at each node that is there; further bars are pinned to it
    let mut nodes = std::collections::BTreeMap::new();
    nodes.insert((0, 0), m.marker(1, low(0), ""));
    nodes.insert((2, 0), m.marker(1, [-0.6, 0.8, 0.0], ""));
    let mut bars = vec![((2, 0), (1, 0))];
    for k in 0..cells {
        bars.extend([((0, k), (1, k)), ((1, k), (0, k + 1)), ((0, k), (0, k + 1))]);
        if k > 0 {
            bars.push(((1, k - 1), (1, k)));
        }
    }
    let place = |(row, k): (i32, usize)| match row {
        0 => low(k),
        1 => high(k),
        _ => [-0.6, 0.8, 0.0],
    };
    let is_spring = |bar: &((i32, usize), (i32, usize))| *bar == ((0, sprung), (0, sprung + 1));
    for (a, b) in bars.iter().filter(|bar| !is_spring(bar)) {
        let (_, _, ends) = m.bar(&[place(*a), place(*b)], [1.0, 0.1], "");
        for (node, end) in [a, b].into_iter().zip(ends) {
            match nodes.get(node) {
                Some(&shared) => m.joint("REVOLUTE", end, shared),
                None => _ = nodes.insert(*node, end),
            }
        }
    }
    m.spring(
        nodes[&(0, sprung)],
        nodes[&(0, sprung + 1)],
        [stiffness, 1.0],
    );
    let tip = nodes[&(0, cells)];

    // all bars beyond the pin above the spring are one body
    let beyond = |(row, k): &(i32, usize)| *row == 0 && *k > sprung || *row == 1 && *k >= sprung;
    let moving: Vec<_> = bars
        .iter()
        .filter(|(a, b)| !is_spring(&(*a, *b)) && beyond(a) && beyond(b))
        .map(|(a, b)| [0, 1].map(|k| (place(*a)[k] + place(*b)[k]) / 2.0))
        .collect();
    let mass = moving.len() as f64;
    let centre = [0, 1].map(|k| moving.iter().map(|p| p[k]).sum::<f64>() / mass);
    let about = |p: &[f64; 2]| 0.1 + (p[0] - centre[0]).powi(2) + (p[1] - centre[1]).powi(2);
    let inertia = moving.iter().map(about).sum();
    let mut one = Drawn::new();
    let (part, ..) = one.bar(&[[centre[0], centre[1], 0.0]], [mass, inertia], "");
    let [hinge, held, at_tip] =
        [high(sprung), low(sprung + 1), low(cells)].map(|p| one.marker(part, p, ""));
    let [pin, wall] = [high(sprung), low(sprung)].map(|p| one.marker(1, p, ""));
    one.joint("REVOLUTE", hinge, pin);
    one.spring(wall, held, [stiffness, 1.0]);
    [(m.falls(), tip), (one.falls(), at_tip)]
}

#[test]
fn trusses_whose_bars_share_pins_move_as_one_body_on_a_spring() {
    for (cells, sprung, stiffness) in [(1, 0, 1e3), (5, 2, 3e4)] {
        let [(text, tip), (one, at_tip)] = truss(cells, sprung, stiffness);
        let columns = |tip: usize| [format!("DX({tip},1)"), format!("DY({tip},1)")];
        let span = (1.0, FINE);
        let (exact, ended, _) = moved(&one, &columns(at_tip), ("DOP853", 1e-11), span);
        ended.expect("a body on a spring");
        let name = format!("{cells} cells");
        right_or_told(&name, &text, &columns(tip), &exact, span.0);
    }
}

/// Bennett's loop: four pins whose axes are twisted by α, β, α, β against each other at distances with a/sin α = b/sin β; text and
/// the angles at two opposite pins.
fn bennett() -> (String, [String; 2]) {
    let (twists, lengths) = ([0.5_f64, 1.1_f64], [1.0, 1.1_f64.sin() / 0.5_f64.sin()]);
    let first = 1.2_f64;
    let between = ((twists[1] + twists[0]) / 2.0).sin() / ((twists[1] - twists[0]) / 2.0).sin();
    let second = 2.0 * (between / (first / 2.0).tan()).atan();
    // frames at the pins, one after the other: turn about z, go along x, twist about x
    let mut frames = vec![(
        [0.0; 3],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    )];
    for (k, turn) in [first, second, -first, -second].into_iter().enumerate() {
        let (at, [x, y, z]) = frames[k];
        let ((s, c), (st, ct)) = (turn.sin_cos(), twists[k % 2].sin_cos());
        let along: [f64; 3] = std::array::from_fn(|i| c * x[i] + s * y[i]);
        let across: [f64; 3] = std::array::from_fn(|i| c * y[i] - s * x[i]);
        let axis = std::array::from_fn(|i| ct * z[i] - st * across[i]);
        let side = std::array::from_fn(|i| ct * across[i] + st * z[i]);
        let next = std::array::from_fn(|i| at[i] + lengths[k % 2] * along[i]);
        frames.push((next, [along, side, axis]));
    }
    let off = |k: usize| (frames[4].0[k] - frames[0].0[k]).abs();
    assert!(off(0) + off(1) + off(2) < 1e-12, "{frames:?}");
    // the last frame is the first, up to a turn about its axis
    let oriented = |(at, [x, _, z]): ([f64; 3], [[f64; 3]; 3])| {
        let [p, q]: [[f64; 3]; 2] = [z, x].map(|a| std::array::from_fn(|i| at[i] + a[i]));
        format!(
            ", ZP={:?},{:?},{:?}, XP={:?},{:?},{:?}",
            p[0], p[1], p[2], q[0], q[1], q[2]
        )
    };
    let mut m = Drawn::new();
    let mut at_pins = vec![(m.marker(1, frames[1].0, &oriented(frames[1])), 0)];
    for link in 1..4 {
        let (a, b) = (frames[link], frames[(link + 1) % 4]);
        let (part, centre, _) = m.bar(&[a.0, b.0], [1.0, 0.1], "");
        at_pins.last_mut().expect("a pin").1 = m.marker(part, a.0, &oriented(a));
        at_pins.push((m.marker(part, b.0, &oriented(b)), 0));
        if link == 2 {
            let post = m.marker(1, [1.0, 2.0, 1.0], "");
            m.spring(centre, post, [20.0, 0.5]);
        }
    }
    at_pins.last_mut().expect("a pin").1 = m.marker(1, frames[0].0, &oriented(frames[0]));
    for (j, i) in &at_pins {
        m.joint("REVOLUTE", *i, *j);
    }
    let opposite = [0, 2].map(|k| format!("AZ({},{})", at_pins[k].1, at_pins[k].0));
    (m.falls(), opposite)
}

#[test]
fn bennetts_loop_turns_by_opposite_angles_and_keeps_its_energy() {
    let (text, columns) = bennett();
    let span = (0.7, FINE);
    let (exact, ended, _) = moved(&text, &columns, ("RADAU5", 1e-11), span);
    ended.expect("a loop that moves");
    let since = |k: usize, n: usize| exact[k][n] - exact[k][0];
    for n in 0..=FINE {
        assert!((since(0, n).abs() - since(1, n).abs()).abs() < 1e-8, "{n}");
    }
    assert!(since(0, FINE).abs() > 0.3, "{}", since(0, FINE));
    right_or_told("Bennett", &text, &columns, &exact, span.0);
}

/// A crank about z and a rocker about y with a rod on two balls between them; the rod is a part, or a row that holds its length.
fn rod_on_two_balls(is_part: bool) -> (String, usize) {
    let (crank, rocker, base) = ([0.3, 0.4, 0.0], [2.0, 0.3, 1.5], [2.0, 0.3, 0.0]);
    let mut m = Drawn::new();
    let first = m.bar(&[[0.0; 3], crank], [2.0, 0.1], ", WZ=9");
    let second = m.bar(&[base, rocker], [1.0, 0.1], "");
    let fixed = m.marker(1, [0.0; 3], "");
    m.joint("REVOLUTE", first.2[0], fixed);
    let about_y = ", REULER=0,-90D,0";
    let pins = [second.0, 1].map(|part| m.marker(part, base, about_y));
    m.joint("REVOLUTE", pins[0], pins[1]);
    let (tip, top) = (first.2[1], second.2[1]);
    if is_part {
        let rod = m.bar(&[crank, rocker], [1e-9, 1e-10], "");
        m.joint("SPHERICAL", rod.2[0], tip);
        m.joint("SPHERICAL", rod.2[1], top);
    } else {
        let apart = |k: usize| crank[k] - rocker[k];
        let length = (0..3).map(|k| apart(k).powi(2)).sum::<f64>().sqrt();
        writeln!(m.text, "GCON/1, FUNCTION=DM({tip},{top})-{length:?}").unwrap();
    }
    (m.falls(), second.1)
}

#[test]
fn a_rod_on_two_balls_moves_as_a_row_that_holds_its_length() {
    let ((text, top), (row, same)) = (rod_on_two_balls(true), rod_on_two_balls(false));
    let columns = |m: usize| [format!("DX({m},1)"), format!("DZ({m},1)")];
    let span = (1.0, FINE);
    let (exact, ended, _) = moved(&row, &columns(same), ("DOP853", 1e-11), span);
    ended.expect("a crank and a rocker");
    right_or_told("RSSR", &text, &columns(top), &exact, span.0);
}
