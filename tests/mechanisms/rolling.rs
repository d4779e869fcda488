//! Equations of velocities: discs, wheels, knife edges and bicycles against closed forms, published eigenvalues and reduced
//! equations; what is said of those that cannot be satisfied, or have no place in an analysis.

use crate::running;

use cognate::analysis::linear::{Linearization, Wanted};
use cognate::analysis::verify::verify;
use cognate::dataset::command::Script;
use cognate::internals::space::{Mat3, Vec3, rotation};
use running::{
    Analysis, Options, Session, begin, go, last, mistakes, model, off, options_by, values, whole,
};
use std::f64::consts::FRAC_PI_2;

const DISC: &str = include_str!("../data/rolling/disc.adm");
const BICYCLE: &str = include_str!("../data/rolling/bicycle.adm");
const SLEIGH: &str = include_str!("../data/rolling/sleigh.adm");
const SNAKEBOARD: &str = include_str!("../data/rolling/snakeboard.adm");
const WHEELSET: &str = include_str!("../data/rolling/wheelset.adm");
const CREEPING: &str = include_str!("../data/rolling/creeping_wheelset.adm");

/// A run of a whole dataset.
fn moved(
    text: &str,
    columns: &[&str],
    (method, error): (&str, f64),
    (end, steps): (f64, usize),
) -> Session {
    let options = options_by(columns, method, error);
    let mut s = begin(whole(text), "rolling", options);
    go(&mut s, Analysis::Dynamic, end, steps);
    s
}

fn linearized(text: &str) -> Linearization {
    let mut s = begin(whole(text), "rolling", Options::default());
    s.linearize(&Wanted::default())
        .unwrap_or_else(|e| panic!("{e:?}"))
}

/// Replaces the line of a dataset that begins so.
fn with_line(text: &str, line: &str) -> String {
    let head = |line: &str| line.split([',', ' ', '=']).next().map(str::to_string);
    let lines = text.lines().map(|l| match head(l) == head(line) {
        true => line,
        false => l,
    });
    lines.flat_map(|l| [l, "\n"]).collect()
}

/// The disc of `disc.adm`, and how it moves: its axle at an angle to the vertical, turning about the vertical, spinning.
#[derive(Clone, Copy)]
struct Disc {
    axle: f64,
    precession: f64,
    spin: f64,
}

const MASS: f64 = 2.0;
const RADIUS: f64 = 0.3;
const G: f64 = 9.81;
/// moment of inertia about a diameter
const A: f64 = MASS * RADIUS * RADIUS / 4.0;
/// moment of inertia about the axle
const C: f64 = MASS * RADIUS * RADIUS / 2.0;

/// Where the plane of a disc is and how it is turned, and the factor of lengths.
#[derive(Clone, Copy)]
struct Plane {
    place: [f64; 3],
    euler: [f64; 3],
    length: f64,
}

const LEVEL: Plane = Plane {
    place: [0.0; 3],
    euler: [0.0; 3],
    length: 1.0,
};

impl Disc {
    /// The disc that rolls on a circle: with e₁ horizontal along the disc, e₃ along its axle and e₂ = e₃ × e₁ up along the
    /// disc, ω = Ω sin α e₂ + ω₃ e₃, and what turns it about e₁ is
    ///
    ///     (C + m r²) Ω ω₃ sin α − A Ω² sin α cos α + m g r cos α = 0
    fn steady(axle: f64, precession: f64) -> Self {
        let (s, c) = axle.sin_cos();
        let torque = A * precession * precession * s * c - MASS * G * RADIUS * c;
        let spin = torque / ((C + MASS * RADIUS * RADIUS) * precession * s);
        Self {
            axle,
            precession,
            spin,
        }
    }

    /// Its centre at a time of the motion on a circle.
    fn centre(&self, t: f64) -> [f64; 3] {
        let (s, c) = self.axle.sin_cos();
        if self.precession == 0.0 {
            return [-self.spin * RADIUS * t, RADIUS * c, RADIUS * s];
        }
        // p(0) = r e₂, v(0) = −ω₃ r e₁; the middle of the circle is at p + z × v / Ω
        let (y, radius) = (RADIUS * c, -self.spin * RADIUS / self.precession);
        let turned = self.precession * t;
        [
            radius * turned.sin(),
            y + radius - radius * turned.cos(),
            RADIUS * s,
        ]
    }

    fn text(&self, at: &Plane) -> String {
        let Plane {
            place,
            euler,
            length,
        } = *at;
        let turn: Mat3<f64> = rotation::from_313(euler[0], euler[1], euler[2]);
        let put = |p: [f64; 3]| {
            let [x, y, z] = (Vec3(place) + turn.apply(Vec3(p))).0.map(|x| x * length);
            format!("{x:?},{y:?},{z:?}")
        };
        let tilt: Mat3<f64> = rotation::from_313(0.0, FRAC_PI_2 + self.axle, 0.0);
        let along = |k: usize| {
            let axis = tilt.column(k).0;
            put([0, 1, 2].map(|n| self.centre(0.0)[n] + axis[n]))
        };
        let v = turn
            .apply(Vec3([-self.spin * RADIUS, 0.0, 0.0]))
            .0
            .map(|x| x * length);
        let g = turn.apply(Vec3([0.0, 0.0, -G])).0.map(|x| x * length);
        let [diameter, about_axle] = [A, C].map(|i| i * length * length);
        let part = format!(
            "PART/2, MASS={MASS}, CM=20, IP={diameter:?},{about_axle:?},{diameter:?}, QG={}, \
             ZG={}, XG={}, VX={:?}, VY={:?}, VZ={:?}, WX=0, WY={:?}, WZ={:?}",
            put(self.centre(0.0)),
            along(2),
            along(0),
            v[0],
            v[1],
            v[2],
            self.spin,
            -self.precession * self.axle.sin()
        );
        let lines = [
            format!(
                "ACCGRAV/IGRAV={:?}, JGRAV={:?}, KGRAV={:?}",
                g[0], g[1], g[2]
            ),
            format!(
                "MARKER/9, PART=1, QP={}, REULER={:?},{:?},{:?}",
                put([0.0; 3]),
                euler[0],
                euler[1],
                euler[2]
            ),
            part,
            format!("MARKER/21, PART=2, QP=0,{:?},0", RADIUS * length),
            format!("VARIABLE/1, FUNCTION={:?}", RADIUS * length),
        ];
        lines
            .iter()
            .fold(DISC.into(), |text: String, line| with_line(&text, line))
    }
}

/// Largest distance of the centre from where it is on its circle, over the radius of the disc, and the columns of `text`.
fn off_circle(disc: Disc, at: &Plane, (method, error): (&str, f64)) -> (f64, Session) {
    let columns = ["DX(20,9,9)", "DY(20,9,9)", "DZ(20,9,9)"];
    let s = moved(&disc.text(at), &columns, (method, error), (3.0, 60));
    let largest = (0..3).map(|k| off(&s, columns[k], |t| disc.centre(t)[k] * at.length));
    (largest.fold(0.0, f64::max) / (RADIUS * at.length), s)
}

#[test]
fn a_disc_rolls_on_its_circle_as_exactly_as_asked_for() {
    for (axle, precession) in [(70.0_f64, -4.0), (80.0, 2.0), (40.0, 9.0), (100.0, 3.0)] {
        let disc = Disc::steady(axle.to_radians(), precession);
        for method in ["AUTO", "DOP853", "RADAU5"] {
            for error in [1e-6, 1e-9] {
                let (off, s) = off_circle(disc, &LEVEL, (method, error));
                println!(
                    "{axle} {precession} {method} {error:e}: {off:e} {:?}",
                    s.run.record.counts
                );
                assert!(
                    off < 30.0 * error,
                    "{axle} {precession} {method} {error:e}: {off:e}"
                );
            }
        }
    }
}

#[test]
fn the_plane_and_the_unit_of_length_change_no_answer_of_a_disc() {
    let disc = Disc::steady(65.0_f64.to_radians(), 3.0);
    let places = [[0.0; 3], [3.0, -2.0, 5.0]];
    let turns = [[0.0; 3], [0.3, 0.7, -1.1], [2.0, 3.0, 1.0]];
    for (place, euler) in places.into_iter().zip(turns).chain([(places[1], turns[2])]) {
        for length in [1e-6, 1.0, 1e3] {
            let plane = Plane {
                place,
                euler,
                length,
            };
            for method in ["AUTO", "RADAU5"] {
                let (off, _) = off_circle(disc, &plane, (method, 1e-8));
                println!("{place:?} {euler:?} {length} {method}: {off:e}");
                assert!(off < 1e-6, "{place:?} {euler:?} {length} {method}: {off:e}");
            }
        }
    }
}

/// The plane carries the weight and turns the disc's centre about the middle of its circle.
#[test]
fn what_holds_a_rolling_disc_is_its_weight_and_what_turns_it() {
    let disc = Disc::steady(75.0_f64.to_radians(), 2.5);
    let columns = [
        "FX(20,9,9)",
        "FY(20,9,9)",
        "FZ(20,9,9)",
        "ACCX(20,9,9)",
        "ACCY(20,9,9)",
    ];
    let s = moved(&disc.text(&LEVEL), &columns, ("AUTO", 1e-10), (2.0, 20));
    let square = disc.precession * disc.precession;
    let inwards = |k: usize| {
        let middle = disc.centre(0.0)[1] - disc.spin * RADIUS / disc.precession;
        move |t: f64| -MASS * square * (disc.centre(t)[k] - [0.0, middle][k])
    };
    let found = [
        off(&s, "FX(20,9,9)", inwards(0)),
        off(&s, "FY(20,9,9)", inwards(1)),
    ];
    println!("{found:?} {:e}", off(&s, "FZ(20,9,9)", |_| MASS * G));
    assert!(found.iter().all(|x| *x < 1e-7), "{found:?}");
    assert!(off(&s, "FZ(20,9,9)", |_| MASS * G) < 1e-7);
}

/// Upright and straight, λ² = (A m g r − C (C + m r²) ω²) / (A (A + m r²)): a coin stands above ω² = A m g r / (C (C + m r²)).
#[test]
fn a_coin_that_rolls_straight_stands_above_its_speed() {
    let critical = (A * MASS * G * RADIUS / (C * (C + MASS * RADIUS * RADIUS))).sqrt();
    for share in [0.0, 0.5, 0.99, 1.01, 2.0, 10.0] {
        let spin = share * critical;
        let disc = Disc {
            axle: FRAC_PI_2,
            precession: 0.0,
            spin,
        };
        let upright = Disc::steady(FRAC_PI_2, 1.0);
        assert!(upright.spin.abs() < 1e-12);
        let whole = C + MASS * RADIUS * RADIUS;
        let square =
            (A * MASS * G * RADIUS - C * whole * spin * spin) / (A * (A + MASS * RADIUS * RADIUS));
        let found = linearized(&disc.text(&LEVEL));
        let largest = found.modes.last().expect("modes");
        let (re, im) = (largest.re, largest.im);
        println!("{share}: {re} {im} of {square}");
        let exact = if square > 0.0 {
            (square.sqrt(), 0.0)
        } else {
            (0.0, (-square).sqrt())
        };
        let off = (re.abs() - exact.0).abs() + (im - exact.1).abs();
        assert!(
            off < 1e-9 * square.abs().sqrt(),
            "{share}: {re} {im} of {exact:?}"
        );
        // all others are free: positions on the plane, headings, turns of the disc
        let rest = found.modes.iter().filter(|m| m.re.abs() + m.im > 1e-6);
        assert_eq!(rest.count(), if square > 0.0 { 2 } else { 1 }, "{share}");
    }
}

/// v and θ̇ of the edge: v̇ = a θ̇², (I + m a²) θ̈ = −m a v θ̇, so that v² + k² θ̇² = E² with k² = a² + I/m, and
/// v = E tanh(a E t/k² + c); the edge is held by m (a θ̈ + v θ̇).
#[test]
fn a_sleigh_turns_until_it_runs_straight() {
    let (a, inertia, mass, v0, w0) = (0.4, 0.3, 2.0, 1.0, 0.7);
    let square: f64 = a * a + inertia / mass;
    let energy = f64::sqrt(v0 * v0 + square * w0 * w0);
    let begun = f64::atanh(v0 / energy);
    let argument = move |t: f64| a * energy * t / square + begun;
    let v = move |t: f64| energy * argument(t).tanh();
    let w = move |t: f64| energy / square.sqrt() / argument(t).cosh();
    let held = move |t: f64| mass * (-a * mass * a * v(t) * w(t) / (mass * square) + v(t) * w(t));
    let gudermann = |x: f64| 2.0 * (x / 2.0).tanh().atan();
    let heading = move |t: f64| square.sqrt() / a * (gudermann(argument(t)) - gudermann(begun));
    let columns = ["VX(21,1,21)", "WZ(20,1)", "AZ(20,1)", "FY(21,1,21)"];
    for method in ["AUTO", "RADAU5"] {
        for error in [1e-6, 1e-10] {
            let s = moved(SLEIGH, &columns, (method, error), (8.0, 80));
            let all = [
                off(&s, columns[0], v),
                off(&s, columns[1], w),
                off(&s, columns[2], heading),
                off(&s, columns[3], held),
            ];
            println!("{method} {error:e}: {all:?} {:?}", s.run.record.counts);
            assert!(
                all.iter().all(|x| *x < 30.0 * error),
                "{method} {error:e}: {all:?}"
            );
        }
    }
}

/// The board's speed v along itself and its turn θ̇ = v tan φ / l remain; with J all that turns with the board,
///
///     (m + J tan²φ/l²) v̇ = −tan φ/l · (J v φ̇ / (l cos²φ) + Jᵣ ψ̈)
#[test]
fn a_snakeboard_goes_as_its_reduced_equation_says() {
    let (mass, l, all, rotor) = (
        6.0,
        0.25,
        0.12 + 0.08 + 2.0 * (0.01 + 0.5 * 0.25 * 0.25),
        0.08,
    );
    let steer = |t: f64| (0.3 * (2.0 * t).sin(), 0.6 * (2.0 * t).cos());
    let slope = |t: f64, v: f64| {
        let (angle, rate) = steer(t);
        let tan = angle.tan();
        let turn = all * v * rate / (l * angle.cos().powi(2)) + rotor * -2.8 * (2.0 * t).sin();
        -tan / l * turn / (mass + all * tan * tan / (l * l))
    };
    // x, y, heading, v by steps of Runge and Kutta
    let rates = |t: f64, y: [f64; 4]| {
        let [_, _, heading, v] = y;
        let turn = v * steer(t).0.tan() / l;
        [v * heading.cos(), v * heading.sin(), turn, slope(t, v)]
    };
    let (steps, end) = (40_000, 10.0);
    let h = end / f64::from(steps);
    let mut y = [0.0; 4];
    for k in 0..steps {
        let t = f64::from(k) * h;
        let plus = |d: [f64; 4], part: f64| [0, 1, 2, 3].map(|n| y[n] + part * h * d[n]);
        let first = rates(t, y);
        let second = rates(t + h / 2.0, plus(first, 0.5));
        let third = rates(t + h / 2.0, plus(second, 0.5));
        let fourth = rates(t + h, plus(third, 1.0));
        y = [0, 1, 2, 3]
            .map(|n| y[n] + h / 6.0 * (first[n] + 2.0 * (second[n] + third[n]) + fourth[n]));
    }
    let columns = ["DX(20,1)", "DY(20,1)", "AZ(20,1)", "VX(20,1,20)"];
    for method in ["AUTO", "RADAU5"] {
        let s = moved(SNAKEBOARD, &columns, (method, 1e-9), (end, 100));
        let found = columns.map(|c| last(&s, c));
        println!("{method}: {found:?} of {y:?}");
        for (found, exact) in found.iter().zip(y) {
            assert!((found - exact).abs() < 1e-7, "{method}: {found} of {exact}");
        }
        assert!(y[0].abs() > 0.1, "it goes forward: {y:?}");
    }
}

/// Table 2 of Meijaard et al.: weave (real part, imaginary part or the two real ones), capsize, castering.
const PUBLISHED: [[f64; 4]; 11] = [
    [
        3.13164324790656,
        5.53094371765393,
        -3.13164324790656,
        -5.53094371765393,
    ],
    [
        3.52696170990070,
        0.80774027519930,
        -3.13423125066578,
        -7.11008014637442,
    ],
    [
        2.68234517512745,
        1.68066296590675,
        -3.07158645641514,
        -8.67387984831735,
    ],
    [
        1.70675605663975,
        2.31582447384325,
        -2.63366137253667,
        -10.3510146724592,
    ],
    [
        0.41325331521125,
        3.07910818603206,
        -1.42944427361326,
        -12.15861426576447,
    ],
    [
        -0.77534188219585,
        4.46486771378823,
        -0.32286642900409,
        -14.07838969279822,
    ],
    [
        -1.52644486584142,
        5.87673060598709,
        -0.00406690076970,
        -16.08537123098026,
    ],
    [
        -2.13875644258362,
        7.19525913329805,
        0.10268170574766,
        -18.15788466125262,
    ],
    [
        -2.69348683581097,
        8.46037971396931,
        0.14327879765713,
        -20.27940894394569,
    ],
    [
        -3.21675402252485,
        9.69377351531791,
        0.15790184030917,
        -22.43788559040858,
    ],
    [
        -3.72016840437287,
        10.90681139476287,
        0.16105338653172,
        -24.62459635017404,
    ],
];

#[test]
fn a_bicycle_has_the_published_eigenvalues_at_every_speed() {
    let mut worst = 0.0_f64;
    for (speed, published) in PUBLISHED.iter().enumerate() {
        let [re, im, capsize, castering] = *published;
        let found = linearized(&BICYCLE.replace("VX=5", &format!("VX={speed}")));
        let pair = match speed {
            0 => vec![(re, 0.0), (im, 0.0)],
            _ => vec![(re, im)],
        };
        let expected = pair.into_iter().chain([(capsize, 0.0), (castering, 0.0)]);
        for (re, im) in expected {
            let off = found.modes.iter().map(|m| (m.re - re).hypot(m.im - im));
            let off = off.fold(f64::INFINITY, f64::min);
            worst = worst.max(off);
            // half of the last digit, and rounding of a matrix of that size
            assert!(
                off < 3e-12 * f64::hypot(re, im).max(1.0),
                "{speed}: {re} {im} off by {off:e}"
            );
        }
        let free = found.modes.iter().filter(|m| (m.re, m.im) == (0.0, 0.0));
        assert_eq!((free.count(), found.states.len()), (6, 10), "{speed}");
    }
    println!("off by {worst:e} at most");
}

/// What a push does to a bicycle is what its eigenvalues say, and its energy stays.
#[test]
fn a_bicycle_between_weave_and_capsize_speed_rights_itself() {
    let pushed = BICYCLE.replace("VX=5", "VX=5, WX=1E-4");
    let columns = ["ROLL(20,1)", "AZ(42,22)", "DZ(30)", "WX(20,1)"];
    let s = moved(&pushed, &columns, ("AUTO", 1e-10), (6.0, 600));
    // lean and steer are sums of four exponentials: the characteristic polynomial of the recurrence of their samples
    let roots = [
        (-0.77534188219585_f64, 4.46486771378823_f64),
        (-0.32286642900409, 0.0),
        (-14.07838969279822, 0.0),
    ];
    let h = 0.01;
    let mut polynomial = vec![1.0];
    for (re, im) in roots {
        let size = f64::exp(re * h);
        let factor = match im == 0.0 {
            true => vec![1.0, -size],
            false => vec![1.0, -2.0 * size * f64::cos(im * h), size * size],
        };
        let mut product = vec![0.0; polynomial.len() + factor.len() - 1];
        for (i, a) in polynomial.iter().enumerate() {
            for (j, b) in factor.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        polynomial = product;
    }
    for column in ["AZ(42,22)", "WX(20,1)"] {
        let x = values(&s, column);
        let largest = x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let left = x.windows(5).map(|w| {
            let terms = w.iter().rev().zip(&polynomial).map(|(x, p)| x * p);
            terms.sum::<f64>().abs()
        });
        let left = left.fold(0.0, f64::max);
        println!("{column}: {left:e} of {largest:e}");
        assert!(left < 1e-6 * largest, "{column}: {left:e} of {largest:e}");
    }
    assert!(values(&s, "WX(20,1)").last().expect("rows").abs() < 2e-5);
}

/// A wheelset of cones sways on its rails with v √(s / (r e)), whatever its mass (Klingel).
#[test]
fn a_wheelset_that_rolls_sways_as_klingel_says() {
    let found = linearized(WHEELSET);
    let sway = found.modes.iter().find(|m| m.im > 0.0).expect("it sways");
    let exact = 20.0 * f64::sqrt(0.05 / (0.45 * 0.75));
    println!("{} {} of {exact}", sway.re, sway.im);
    assert!((sway.im - exact).abs() < 1e-12 * exact && sway.re.abs() < 1e-12 * exact);
    // x, y and the heading may be chosen, and one velocity
    assert_eq!(found.states.len(), 4);
}

/// With creep it sways and dies away up to a speed, of which the criterion of Hurwitz says
///
///     A₁ ((m κ + I k + P/v²) A₃ − A₁ m I) = A₃² a₀      A₁/v, A₃/v, a₀: of λ, λ³ and 1
#[test]
fn a_wheelset_that_creeps_has_its_critical_speed() {
    let (m, i, f, e, k, q) = (1200.0, 700.0, 6e6, 0.75, 2e5, 1e6);
    let (c, d) = (2.0 * f, 2.0 * f * e * e);
    let coupling = 4.0 * f * f * e * 0.05 / 0.45;
    let (a1, a3, a0) = (c * q + d * k, m * d + c * i, k * q + coupling);
    let over_square: f64 = ((a3 * a3 * a0 / a1 + a1 * m * i) / a3 - (m * q + i * k)) / (c * d);
    let critical: f64 = over_square.sqrt().recip();
    let growth = |speed: f64| {
        let text = CREEPING.replace(
            "VARIABLE/1, FUNCTION=20",
            &format!("VARIABLE/1, FUNCTION={speed:?}"),
        );
        let found = linearized(&text);
        let all = found.modes.iter().map(|m| m.re);
        all.fold(f64::NEG_INFINITY, f64::max)
    };
    println!(
        "{critical} {:e} {:e}",
        growth(critical * (1.0 - 1e-9)),
        growth(critical * (1.0 + 1e-9))
    );
    assert!(growth(critical * (1.0 - 1e-9)) < 0.0 && growth(critical * (1.0 + 1e-9)) > 0.0);
}

/// At constant speed c the path of a mass turns by φ̇ = −g cos φ/c under gravity; the force along the velocity is m g sin φ.
#[test]
fn an_equation_that_is_not_linear_in_velocities_holds_a_speed() {
    let mass = 3.0;
    for function in ["VM(20,1)-2", "VX(20,1)**2+VY(20,1)**2-4"] {
        let text = format!(
            "A mass of constant speed\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS={mass}, CM=20, IP=1,1,1, VX=1, VY=1\n\
             MARKER/20, PART=2\nJOINT/1, PLANAR, I=20, J=1\nACCGRAV/JGRAV=-9.81\nGCON/1, I=20, FUNCTION={function}\nEND\n"
        );
        let begun: f64 = (3.0 * FRAC_PI_2 / 4.0).tan();
        let angle = move |t: f64| 2.0 * (begun * (-G / 2.0 * t).exp()).atan() - FRAC_PI_2;
        for (method, error) in [("AUTO", 1e-6), ("AUTO", 1e-10), ("RADAU5", 1e-8)] {
            let columns = ["VX(20)", "VY(20)", "FX(20,1)", "FY(20,1)"];
            let s = moved(&text, &columns, (method, error), (2.0, 40));
            let off = [
                off(&s, "VX(20)", |t| 2.0 * angle(t).cos()),
                off(&s, "VY(20)", |t| 2.0 * angle(t).sin()),
                off(&s, "FX(20,1)", |t| {
                    mass * G * angle(t).sin() * angle(t).cos()
                }) / 10.0,
                off(&s, "FY(20,1)", |t| mass * G * angle(t).sin().powi(2)) / 10.0,
            ];
            println!("{function} {method} {error:e}: {off:?}");
            assert!(
                off.iter().all(|x| *x < 30.0 * error),
                "{function} {method} {error:e}: {off:?}"
            );
            let speed = values(&s, "VX(20)").iter().zip(values(&s, "VY(20)"));
            let off = speed
                .map(|(x, y)| (x.hypot(*y) - 2.0).abs())
                .fold(0.0, f64::max);
            assert!(off < 1e-12, "{function}: {off:e}");
        }
    }
}

#[test]
fn freedoms_of_position_and_of_velocity_are_told_apart() {
    for (text, position, velocity) in [
        (DISC, 5, 3),
        (BICYCLE, 7, 3),
        (SLEIGH, 3, 2),
        (SNAKEBOARD, 3, 1),
    ] {
        let v = verify(&whole(text)).unwrap_or_else(|e| panic!("{e:?}"));
        assert_eq!(
            (v.freedom_of_position, v.freedom),
            (Some(position), Some(velocity))
        );
        assert_eq!(v.gruebler, velocity as i64);
        assert!(
            v.dependent.is_empty() && v.free.len() == velocity,
            "{:?}",
            v.free
        );
    }
}

#[test]
fn an_equation_of_velocities_that_follows_from_others_is_told_and_changes_nothing() {
    let twice = SLEIGH.replace(
        "END\n",
        "GCON/2, I=21, FUNCTION=3*VY(21,1,21)\nGCON/3, FUNCTION=VZ(20)\nEND\n",
    );
    let v = verify(&whole(&twice)).unwrap_or_else(|e| panic!("{e:?}"));
    assert_eq!(v.redundant(), ["GCON/2 FUNCTION", "GCON/3 FUNCTION"]);
    assert_eq!(
        (v.freedom_of_position, v.freedom, v.gruebler),
        (Some(3), Some(2), 0)
    );
    let columns = ["DX(20,1)", "DY(20,1)", "AZ(20,1)"];
    let [one, two] = [SLEIGH, &twice].map(|text| moved(text, &columns, ("AUTO", 1e-9), (3.0, 10)));
    for c in columns {
        let off = values(&one, c)
            .iter()
            .zip(values(&two, c))
            .map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-9);
    }
    assert_eq!(
        two.run.record.redundant,
        ["GCON/2 FUNCTION", "GCON/3 FUNCTION"]
    );
}

#[test]
fn velocities_that_cannot_be_are_refused_by_name() {
    let both = "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nGCON/1, FUNCTION=VX(20)-1\nGCON/2, FUNCTION=VX(20)-2\n";
    for text in [both.into(), both.replace("VX(20)-1", "VX(20)**2+1")] {
        let mut s = begin(model(&text), "test", Options::default());
        let told = mistakes(&mut s, Analysis::Dynamic).remove(0);
        let element = told.element.unwrap_or_default().to_string();
        assert!(element.starts_with("GCON/"), "{element}: {}", told.message);
    }
}

#[test]
fn what_rolls_may_rest_and_what_drives_may_not() {
    let hung = |more: &str| {
        format!(
            "PART/2, MASS=2, CM=20, IP=1,1,1, QG=0.1,0,0\nMARKER/20, PART=2\nJOINT/1, PLANAR, I=20, J=1\n\
             SFORCE/1, TRANSLATION, ACTIONONLY, I=20, J=2, FUNCTION=-50*DX(20,1)-3*VX(20,1)\n\
             SFORCE/2, TRANSLATION, ACTIONONLY, I=20, J=3, FUNCTION=-50*DY(20,1)-3*VY(20,1)\n\
             SFORCE/3, ROTATION, ACTIONONLY, I=20, J=1, FUNCTION=-9*AZ(20,1)-WZ(20,1)\n\
             MARKER/2, PART=1, REULER=90D,90D,0\nMARKER/3, PART=1, REULER=180D,90D,0\n{more}"
        )
    };
    let rolls = hung("GCON/1, I=20, FUNCTION=VX(20)-0.3*WZ(20)\n");
    let mut s = begin(
        model(&rolls),
        "test",
        options_by(&["DX(20,1)", "FX(20,1)"], "AUTO", 1e-9),
    );
    running::rest(&mut s);
    // statics goes where springs pull, though the equation would not let it go there
    let found = [last(&s, "DX(20,1)"), last(&s, "FX(20,1)")];
    assert!(found.iter().all(|x| x.abs() < 1e-9), "{found:?}");
    go(&mut s, Analysis::Dynamic, 1.0, 5);
    assert!(last(&s, "DX(20,1)").abs() < 1e-9);
    let told = s
        .run
        .record
        .warnings
        .iter()
        .filter(|w| w.code == "gcon_at_rest");
    assert_eq!(told.count(), 1);
    let drives = hung("GCON/1, I=20, FUNCTION=VX(20)-2\n");
    let mut s = begin(model(&drives), "test", Options::default());
    let told = mistakes(&mut s, Analysis::Static).remove(0);
    assert_eq!(told.code, "gcon_at_rest");
    assert!(told.message.contains("-2"), "{}", told.message);
    let told = mistakes(
        &mut begin(model(&rolls), "test", Options::default()),
        Analysis::Kinematic,
    )
    .remove(0);
    assert_eq!(told.code, "freedom");
    assert!(told.message.contains("velocities"), "{}", told.message);
}

/// A part whose velocities equations determine, all of them: it is followed in time, from position to position by its rates.
#[test]
fn velocities_alone_may_drive_a_part() {
    let text = "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nJOINT/1, PLANAR, I=20, J=1\n\
                GCON/1, FUNCTION=VX(20,1,20)-2\nGCON/2, FUNCTION=VY(20,1,20)\nGCON/3, FUNCTION=WZ(20)-0.5*TIME\n";
    let columns = ["VX(20)", "VY(20)", "AZ(20,1)"];
    let s = running::run(text, &columns, Analysis::Transient, (3.0, 30), 1e-10);
    let heading = |t: f64| 0.25 * t * t;
    let off = [
        off(&s, columns[0], |t| 2.0 * heading(t).cos()),
        off(&s, columns[1], |t| 2.0 * heading(t).sin()),
        off(&s, columns[2], heading),
    ];
    println!("{off:?}");
    assert!(off.iter().all(|x| *x < 1e-8), "{off:?}");
}

/// A disc that goes on from where a simulation left it goes as one that is not interrupted.
#[test]
fn a_disc_goes_on_from_one_simulation_to_the_next() {
    let disc = Disc::steady(1.2, 3.0);
    let text = disc.text(&LEVEL);
    let columns = ["DX(20,9,9)", "DY(20,9,9)", "DZ(20,9,9)"];
    let mut s = moved(&text, &columns, ("AUTO", 1e-10), (1.0, 5));
    go(&mut s, Analysis::Dynamic, 2.0, 5);
    let far = (0..3).map(|k| (last(&s, columns[k]) - disc.centre(2.0)[k]).abs());
    assert!(far.fold(0.0, f64::max) < 1e-8);
}

/// A car that steers and pulls trailers, each hinged to the middle of the axle before it: where the car goes with v the next
/// axle follows with v cos δ and turns by v sin δ / l. All velocities go with v, which their energy says.
#[test]
fn a_train_of_trailers_follows_axle_by_axle_by_every_method() {
    for (n, end) in [(3, 10.0), (40, 10.0)] {
        let mut text = String::from(
            "PART/2, MASS=3, CM=20, IP=1,1,0.4, VX=2\nMARKER/20, PART=2\nJOINT/1, PLANAR, I=20, J=1\n\
             GCON/1, I=20, FUNCTION=VY(20,1,20)\nGCON/2, I=20, FUNCTION=WZ(20)-0.2*VX(20,1,20)*SIN(0.7*TIME)\n",
        );
        for p in 3..n + 3 {
            let before = p - 1;
            text += &format!(
                "PART/{p}, MASS=1, CM={p}0, IP=1,1,0.3, QG=-{},0,0\nMARKER/{p}0, PART={p}\n\
                 MARKER/{p}1, PART={p}, QP=1,0,0\nJOINT/{p}, REVOLUTE, I={p}1, J={before}0\n\
                 GCON/{p}, I={p}0, FUNCTION=VY({p}0,1,{p}0)\n",
                p - 2
            );
        }
        // rates of x, y and headings, and the inertia that goes with v
        let rates = |t: f64, y: &[f64]| {
            let curvature = 0.2 * f64::sin(0.7 * t);
            let mut all = vec![y[2].cos(), y[2].sin(), curvature];
            let (mut v, mut inertia) = (1.0, 3.0 + 0.4 * curvature * curvature);
            for k in 3..n + 3 {
                let angle = y[k - 1] - y[k];
                let turn = v * angle.sin();
                v *= angle.cos();
                inertia += v * v + 0.3 * turn * turn;
                all.push(turn);
            }
            (all, inertia)
        };
        let mut y = vec![0.0; n + 3];
        let twice = rates(0.0, &y).1 * 4.0;
        let speeds = |t: f64, y: &[f64]| {
            let (all, inertia) = rates(t, y);
            let v = f64::sqrt(twice / inertia);
            all.into_iter().map(|x| x * v).collect::<Vec<f64>>()
        };
        let (steps, mut t) = (20_000, 0.0);
        let h = end / f64::from(steps);
        for k in 1..=steps {
            let plus = |d: &[f64], part: f64| -> Vec<f64> {
                y.iter().zip(d).map(|(y, d)| y + part * h * d).collect()
            };
            let first = speeds(t, &y);
            let second = speeds(t + h / 2.0, &plus(&first, 0.5));
            let third = speeds(t + h / 2.0, &plus(&second, 0.5));
            let fourth = speeds(t + h, &plus(&third, 1.0));
            for n in 0..y.len() {
                y[n] += h / 6.0 * (first[n] + 2.0 * (second[n] + third[n]) + fourth[n]);
            }
            t = f64::from(k) * h;
        }
        let v = f64::sqrt(twice / rates(end, &y).1);
        let rear = format!("AZ({}0,1)", n + 2);
        let columns = ["DX(20)", "DY(20)", "AZ(20,1)", &rear, "VX(20,1,20)"];
        let exact = [y[0], y[1], y[2], y[n + 2], v];
        for method in ["AUTO", "RADAU5"] {
            let mut s = running::session_by(&text, &columns, method, 1e-9);
            go(&mut s, Analysis::Dynamic, end, 2);
            let off = columns
                .iter()
                .zip(exact)
                .map(|(c, exact)| (last(&s, c) - exact).abs());
            let off: Vec<f64> = off.collect();
            println!("{n} {method}: {off:?}");
            assert!(
                off.iter().all(|x| *x < 1e-8),
                "{n} {method}: {off:?} of {exact:?}"
            );
        }
    }
}

/// An edge that is set down while a body moves takes away what is across it by a blow: the least in energy.
#[test]
fn an_edge_that_is_set_down_strikes() {
    let columns = ["VX(20,1,20)", "VY(20,1,20)", "WZ(20)"];
    let text = SLEIGH.replace("VY=0.28", "VY=0.5");
    let script = Script::from_text(
        "FILE/MODEL=sleigh\nDEACTIVATE/GCON, ID=1\nSIMULATE/DYNAMIC, END=1, STEPS=2\n\
         ACTIVATE/GCON, ID=1\nSIMULATE/INITIAL\nSTOP\n",
    )
    .expect("commands");
    let mut s = begin(whole(&text), "sleigh", options_by(&columns, "AUTO", 1e-10));
    running::obeys(&mut s, &script);
    let [before, after] = [1, 0].map(|back| {
        let row = |c: &str| {
            let all = values(&s, c);
            all[all.len() - 1 - back]
        };
        columns.map(row)
    });
    // across the edge v − a ω, which a blow at −a brings to zero
    let (mass, inertia, a) = (2.0, 0.3, 0.4);
    let blow = -(before[1] - a * before[2]) / (1.0 / mass + a * a / inertia);
    let exact = [
        before[0],
        before[1] + blow / mass,
        before[2] - a * blow / inertia,
    ];
    println!("{before:?} {after:?} {exact:?}");
    for (found, exact) in after.iter().zip(exact) {
        assert!(
            (found - exact).abs() < 1e-12,
            "{after:?} instead of {exact:?}"
        );
    }
}

/// A disc that sways as it rolls, and slows down nowhere: what holds it does no work.
#[test]
fn a_disc_that_sways_keeps_its_energy_and_does_not_slip() {
    let disc = Disc {
        axle: 1.2,
        precession: 1.5,
        spin: 7.0,
    };
    let energy = format!(
        "{}*VM(20)**2+{}*(WX(20,1,20)**2+WZ(20,1,20)**2)+{}*WY(20,1,20)**2+{}*DZ(20)",
        MASS / 2.0,
        A / 2.0,
        C / 2.0,
        MASS * G
    );
    let slip = [
        "VX(20)+WY(20)*VARVAL(13)-WZ(20)*VARVAL(12)",
        "DZ(20)+VARVAL(13)",
        "DZ(20)",
    ];
    for (method, error) in [("AUTO", 1e-9), ("RADAU5", 1e-8)] {
        let columns = [&energy[..], slip[0], slip[1], slip[2]];
        let s = moved(&disc.text(&LEVEL), &columns, (method, error), (20.0, 200));
        let whole = values(&s, &energy)[0];
        let drift = off(&s, &energy, |_| whole) / whole;
        let slips = [off(&s, slip[0], |_| 0.0), off(&s, slip[1], |_| 0.0)];
        let heights = values(&s, "DZ(20)");
        let [low, high] =
            [f64::min, f64::max].map(|f| heights.iter().copied().reduce(f).expect("rows"));
        println!("{method}: {drift:e} {slips:?} {low} {high}");
        assert!(drift < 30.0 * error, "{method}: {drift:e}");
        assert!(slips.iter().all(|x| *x < 1e-10), "{method}: {slips:?}");
        assert!(high - low > 0.01, "it sways: {low} {high}");
    }
}

/// A ball on a turntable goes in circles, at 2/7 of the table's rate: v̇ = 2/7 Ω z × v. What moves below it is given as a
/// number, or as a part that a motion turns, in whose frame velocities are read.
#[test]
fn a_ball_on_a_turntable_circles_at_two_sevenths_of_its_rate() {
    let ball = "PART/2, MASS=2, CM=20, IP=0.072,0.072,0.072, QG=1,0,0.3, VX=0.3, VY=0.2\nMARKER/20, PART=2\n\
                ACCGRAV/KGRAV=-9.81\nGCON/1, I=20, FUNCTION=DZ(20)-0.3\n";
    let table = "PART/5, MASS=1, CM=50, IP=1,1,1\nMARKER/50, PART=5\nJOINT/5, REVOLUTE, I=50, J=1\n\
                 MOTION/5, JOINT=5, ROTATIONAL, FUNCTION=3*TIME\n";
    let fixed = "GCON/2, I=20, FUNCTION=VX(20)-0.3*WY(20)+3*DY(20)\nGCON/3, I=20, FUNCTION=VY(20)+0.3*WX(20)-3*DX(20)\n";
    let turning = "GCON/2, I=20, FUNCTION=VX(20,50,1,50)-0.3*WY(20,50,1)\n\
                   GCON/3, I=20, FUNCTION=VY(20,50,1,50)+0.3*WX(20,50,1)\n";
    let in_table = "GCON/2, I=20, FUNCTION=VX(20,50,50,50)-0.3*WY(20,50,50)\n\
                    GCON/3, I=20, FUNCTION=VY(20,50,50,50)+0.3*WX(20,50,50)\n";
    let rate = 2.0 / 7.0 * 3.0;
    let x = |t: f64| 1.0 + (0.3 * (rate * t).sin() + 0.2 * ((rate * t).cos() - 1.0)) / rate;
    let y = |t: f64| (0.2 * (rate * t).sin() - 0.3 * ((rate * t).cos() - 1.0)) / rate;
    for rows in [
        fixed.to_string(),
        format!("{table}{turning}"),
        format!("{table}{in_table}"),
    ] {
        for (method, error) in [("AUTO", 1e-9), ("RADAU5", 1e-9)] {
            let columns = ["DX(20)", "DY(20)", "WZ(20)"];
            let mut s = running::session_by(&format!("{ball}{rows}"), &columns, method, error);
            go(&mut s, Analysis::Dynamic, 10.0, 50);
            let off = [
                off(&s, "DX(20)", x),
                off(&s, "DY(20)", y),
                off(&s, "WZ(20)", |_| 0.0),
            ];
            println!("{method}: {off:?}");
            assert!(off.iter().all(|x| *x < 1e-8), "{method} {rows}: {off:?}");
        }
    }
}
