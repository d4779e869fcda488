//! Elementary functions of plain numbers and of lanes: how near they are to the correctly rounded ones of `pxfm`, that several
//! numbers at once have the bits of one, and what becomes of numbers that are not usual.

use cognate::scalar::{Dual, Lanes, Scalar, hypot};

/// A function of two numbers; most do not read the second.
type Function = fn(f64, f64) -> f64;

/// Random numbers that are the same in every run.
struct Random(u64);

impl Random {
    fn uniform(&mut self, least: f64, most: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        least + (most - least) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    /// A number of either sign whose magnitude is between two powers of two, all of them as likely.
    fn magnitude(&mut self, least: f64, most: f64) -> f64 {
        let size = self.uniform(least, most).exp2() * self.uniform(1.0, 2.0);
        if self.uniform(0.0, 1.0) < 0.5 {
            -size
        } else {
            size
        }
    }
    /// A number near a whole number of quarter turns.
    fn beside_quarter_turns(&mut self) -> f64 {
        let quarters = self.magnitude(0.0, 40.0).round();
        quarters * std::f64::consts::FRAC_PI_2 * (1.0 + self.magnitude(-54.0, -30.0))
    }
}

/// A function: ours over any number, the correctly rounded one, pairs of arguments.
struct Row {
    name: &'static str,
    ours: Function,
    lanes: fn(Lanes<8>, Lanes<8>) -> Lanes<8>,
    value_of_dual: Function,
    rounded: Function,
    arguments: fn(&mut Random) -> [f64; 2],
}

macro_rules! row {
    ($name:literal, |$x:ident, $y:ident| $ours:expr, $rounded:expr, |$random:ident| $arguments:expr) => {{
        fn ours<S: Scalar>($x: S, $y: S) -> S {
            let _ = $y;
            $ours
        }
        Row {
            name: $name,
            ours: ours::<f64>,
            lanes: ours::<Lanes<8>>,
            value_of_dual: |x, y| ours(Dual::<2>::variable(x, 0), Dual::variable(y, 1)).re,
            rounded: $rounded,
            arguments: |$random| $arguments,
        }
    }};
}

/// All functions, on the ranges where they are met and on all magnitudes.
fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    macro_rules! of_one {
        ($name:literal, $method:ident, $rounded:path, $(|$random:ident| $argument:expr),+) => {
            $(rows.push(row!($name, |x, _y| x.$method(), |x, _| $rounded(x), |$random| [$argument, 0.0]));)+
            rows.push(row!($name, |x, _y| x.$method(), |x, _| $rounded(x), |r| [r.magnitude(-1074.0, 1024.0), 0.0]));
        };
    }
    of_one!("exp", exp, pxfm::f_exp, |r| r.uniform(-1.0, 1.0), |r| r
        .uniform(-760.0, 720.0));
    of_one!(
        "ln",
        ln,
        pxfm::f_log,
        |r| r.uniform(0.5, 2.0),
        |r| 1.0 + r.magnitude(-40.0, -2.0),
        |r| r.magnitude(-1074.0, 1024.0).abs()
    );
    of_one!(
        "log10",
        log10,
        pxfm::f_log10,
        |r| r.uniform(0.5, 2.0),
        |r| 1.0 + r.magnitude(-40.0, -2.0),
        |r| r.magnitude(-1074.0, 1024.0).abs()
    );
    // where it is plain how many quarter turns there are, where that is counted in doubles or in whole numbers, and beside
    // zeros and poles
    macro_rules! of_angle {
        ($name:literal, $method:ident, $rounded:path) => {
            of_one!(
                $name,
                $method,
                $rounded,
                |r| r.uniform(-4.0, 4.0),
                |r| r.magnitude(-1074.0, 12.5),
                |r| r.magnitude(12.5, 40.0),
                |r| r.beside_quarter_turns()
            );
        };
    }
    of_angle!("sin", sin, pxfm::f_sin);
    of_angle!("cos", cos, pxfm::f_cos);
    of_angle!("tan", tan, pxfm::f_tan);
    of_one!("atan", atan, pxfm::f_atan, |r| r.uniform(-3.0, 3.0), |r| r
        .magnitude(-4.0, 4.0));
    of_one!(
        "asin",
        asin,
        pxfm::f_asin,
        |r| r.uniform(-1.0, 1.0),
        |r| 1.0 - r.magnitude(-54.0, -1.0).abs()
    );
    of_one!(
        "acos",
        acos,
        pxfm::f_acos,
        |r| r.uniform(-1.0, 1.0),
        |r| 1.0 - r.magnitude(-54.0, -1.0).abs()
    );
    of_one!("sinh", sinh, pxfm::f_sinh, |r| r.uniform(-3.0, 3.0), |r| r
        .uniform(-712.0, 712.0));
    of_one!("cosh", cosh, pxfm::f_cosh, |r| r.uniform(-3.0, 3.0), |r| r
        .uniform(-712.0, 712.0));
    of_one!("tanh", tanh, pxfm::f_tanh, |r| r.uniform(-3.0, 3.0), |r| r
        .uniform(-25.0, 25.0));
    macro_rules! of_two {
        ($name:literal, |$x:ident, $y:ident| $ours:expr, $rounded:path, $(|$random:ident| $arguments:expr),+) => {
            $(rows.push(row!($name, |$x, $y| $ours, $rounded, |$random| $arguments));)+
        };
    }
    of_two!(
        "atan2",
        |y, x| y.atan2(x),
        pxfm::f_atan2,
        |r| [r.uniform(-2.0, 2.0), r.uniform(-2.0, 2.0)],
        |r| [r.magnitude(-30.0, 30.0), r.magnitude(-30.0, 30.0)],
        |r| [r.magnitude(-1074.0, 1024.0), r.magnitude(-1074.0, 1024.0)]
    );
    // exponents whose power has a shorter way, of a few roundings more, are left out
    of_two!(
        "power",
        |x, y| x.powf(y),
        pxfm::f_pow,
        |r| [r.uniform(0.0, 10.0), r.uniform(-10.0, 10.0)],
        |r| [r.magnitude(-1074.0, 1024.0).abs(), r.uniform(-10.0, 10.0)],
        |r| [r.magnitude(-10.0, 10.0).abs(), r.magnitude(-1074.0, 1024.0)],
        |r| [1.0 + r.magnitude(-50.0, -3.0), r.magnitude(5.0, 60.0)],
        |r| [
            r.magnitude(-20.0, 20.0),
            r.uniform(-60.0, 60.0).round() + 33.0
        ]
    );
    rows
}

/// Counts numbers between two numbers; zero where both are nothing, or the same infinity.
fn distance(a: f64, b: f64) -> i64 {
    let place = |x: f64| {
        let bits = x.to_bits() as i64;
        if bits < 0 { i64::MIN - bits } else { bits }
    };
    match (a.is_nan(), b.is_nan()) {
        (true, true) => 0,
        (false, false) => place(a).saturating_sub(place(b)).saturating_abs(),
        _ => i64::MAX,
    }
}

/// Arguments of a row per run: a release build can afford more.
const SAMPLES: usize = if cfg!(debug_assertions) {
    20_000
} else {
    1_000_000
};

#[test]
fn functions_are_the_correctly_rounded_ones_or_their_neighbours() {
    for row in rows() {
        let mut random = Random(0x9E37_79B9_7F4A_7C15);
        let mut n_others = 0;
        for _ in 0..SAMPLES {
            let [x, y] = (row.arguments)(&mut random);
            let is_product = (y.fract() == 0.0 || y.fract().abs() == 0.5) && y.abs() <= 32.0;
            if row.name == "power" && is_product {
                continue;
            }
            let (got, want) = ((row.ours)(x, y), (row.rounded)(x, y));
            let apart = distance(got, want);
            assert!(
                apart <= 1,
                "{}({x:e}, {y:e}): {got:e}, rounded {want:e}",
                row.name
            );
            n_others += usize::from(apart == 1);
        }
        // what comes before the last rounding adds less than a third of a unit, mostly a twentieth
        assert!(
            n_others * 20 < SAMPLES,
            "{}: {n_others} of {SAMPLES} are neighbours",
            row.name
        );
    }
}

#[test]
fn logarithms_and_general_powers_are_nearly_always_the_correctly_rounded_ones() {
    for row in rows() {
        let most_others = match row.name {
            "ln" | "log10" => 1e-4,
            "exp" | "power" => 0.01,
            _ => continue,
        };
        let mut random = Random(77);
        let mut n_others = 0;
        for _ in 0..SAMPLES {
            let [x, y] = (row.arguments)(&mut random);
            let is_product = (y.fract() == 0.0 || y.fract().abs() == 0.5) && y.abs() <= 32.0;
            let is_other = (row.ours)(x, y).to_bits() != (row.rounded)(x, y).to_bits();
            n_others += usize::from(is_other && !is_product_power(&row, is_product, x));
        }
        assert!(
            n_others as f64 <= most_others * SAMPLES as f64 + 2.0,
            "{}: {n_others} of {SAMPLES} are neighbours",
            row.name
        );
    }
}

/// Whether a sample is a power that has a shorter way, or no number, whose bits are not told.
fn is_product_power(row: &Row, is_product: bool, x: f64) -> bool {
    row.name == "power" && is_product || x < 0.0
}

/// Numbers at the edges of what is usual, and beyond.
const EDGES: [f64; 40] = [
    0.0,
    -0.0,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    5e-324,
    -5e-324,
    1e-310,
    f64::MIN_POSITIVE,
    -f64::MIN_POSITIVE,
    f64::MAX,
    f64::MIN,
    1.0,
    -1.0,
    0.999_999_999_999_999_9,
    1.000_000_000_000_000_2,
    -1.000_000_000_000_000_2,
    0.5,
    -0.5,
    2.0,
    10.0,
    1e-9,
    -1e-9,
    22.0,
    -22.5,
    33.0,
    33.5,
    -35.0,
    708.0,
    -708.5,
    709.782_712_893_384,
    710.475_860_073_943_9,
    -745.133_219_101_941_1,
    -746.0,
    711.0,
    1e18,
    1e150,
    -1e-130,
    9_007_199_254_740_993.0,
    1e300,
];

#[test]
fn several_numbers_have_the_bits_of_one() {
    for row in rows() {
        let mut random = Random(5);
        let agree = |x: [f64; 8], y: [f64; 8]| {
            let lanes = (row.lanes)(Lanes(x), Lanes(y));
            for k in 0..8 {
                let one = (row.ours)(x[k], y[k]);
                let same =
                    lanes.0[k].to_bits() == one.to_bits() || lanes.0[k].is_nan() && one.is_nan();
                assert!(
                    same,
                    "{}({:e}, {:e}): {:e} in a lane, {one:e} alone",
                    row.name, x[k], y[k], lanes.0[k]
                );
            }
        };
        for _ in 0..SAMPLES / 16 {
            let pairs: [[f64; 2]; 8] = std::array::from_fn(|_| (row.arguments)(&mut random));
            agree(pairs.map(|p| p[0]), pairs.map(|p| p[1]));
            // one exponent for all
            agree(pairs.map(|p| p[0]), [pairs[0][1]; 8]);
        }
        for x in EDGES.chunks(8) {
            for y in EDGES {
                let x: [f64; 8] = std::array::from_fn(|k| x[k]);
                agree(x, [y; 8]);
                agree([y; 8], x);
            }
        }
    }
}

#[test]
fn the_value_of_a_dual_number_has_the_bits_of_the_value() {
    for row in rows() {
        let mut random = Random(11);
        for _ in 0..SAMPLES / 16 {
            let [x, y] = (row.arguments)(&mut random);
            let (dual, plain) = ((row.value_of_dual)(x, y), (row.ours)(x, y));
            let same = dual.to_bits() == plain.to_bits() || dual.is_nan() && plain.is_nan();
            assert!(same, "{}({x:e}, {y:e}): {dual:e}, {plain:e}", row.name);
        }
    }
}

#[test]
fn numbers_at_the_edges_become_what_the_standard_says() {
    for row in rows() {
        for x in EDGES {
            for y in EDGES {
                // the library of the system knows the edges, not always the last digit
                let want = match row.name {
                    "exp" => x.exp(),
                    "ln" => x.ln(),
                    "log10" => x.log10(),
                    "sin" => x.sin(),
                    "cos" => x.cos(),
                    "tan" => x.tan(),
                    "atan" => x.atan(),
                    "asin" => x.asin(),
                    "acos" => x.acos(),
                    "sinh" => x.sinh(),
                    "cosh" => x.cosh(),
                    "tanh" => x.tanh(),
                    "atan2" => f64::atan2(x, y),
                    _ => f64::powf(x, y),
                };
                let got = (row.ours)(x, y);
                // small powers are products of up to 32 factors, and roots, which leave -0 as it is and
                // do not know of -inf
                let is_product = row.name == "power" && y.abs() <= 32.0;
                if is_product && x <= 0.0 && y.fract() != 0.0 {
                    continue;
                }
                let room = if is_product { 20 } else { 2 };
                let same_sign = got.is_sign_negative() == want.is_sign_negative();
                assert!(
                    distance(got, want) <= room && (got.is_nan() || same_sign),
                    "{}({x:e}, {y:e}): {got:e}, the standard says {want:e}",
                    row.name
                );
            }
        }
    }
}

#[test]
fn results_that_are_short_numbers_are_exact() {
    for k in -300..=300 {
        let text = format!("1e{k}");
        let x: f64 = text.parse().unwrap();
        assert_eq!(Scalar::log10(x), f64::from(k), "log10 {text}");
    }
    for n in 1..200 {
        let x = f64::from(n);
        assert_eq!(Scalar::powf(x.powi(4), 0.25), x, "{n}**4**0.25");
    }
    assert_eq!(
        Scalar::powf(2.0, -1000.5),
        2f64.powi(-1001) * std::f64::consts::SQRT_2
    );
    assert_eq!(Scalar::powf(3.0, 33.0), 5_559_060_566_555_523.0);
    assert_eq!(Scalar::exp(0.0), 1.0);
    assert_eq!(Scalar::ln(1.0), 0.0);
    assert_eq!(Scalar::acos(1.0), 0.0);
    assert_eq!(Scalar::cosh(0.0), 1.0);
}

#[test]
fn a_hypotenuse_of_any_size_is_off_by_two_units_at_most() {
    let mut random = Random(4);
    for _ in 0..SAMPLES {
        let [a, size] = [(); 2].map(|()| random.magnitude(-1000.0, 1000.0));
        let b = a * random.magnitude(-30.0, 30.0);
        for (a, b) in [(a, b), (a, size), (a, 0.0), (0.0, b)] {
            let (got, want) = (hypot(a, b), f64::hypot(a, b));
            assert!(distance(got, want) <= 2, "{a:e}, {b:e}: {got:e}, {want:e}");
        }
    }
    assert_eq!(hypot(0.0, -0.0), 0.0);
    assert_eq!(hypot(f64::NEG_INFINITY, 1.0), f64::INFINITY);
    assert!(hypot(f64::NAN, 0.0).is_nan() && hypot(1.0, f64::NAN).is_nan());
}
