//! Laws of the function language on random expressions and hostile texts.

use crate::expressions;

use cognate::expr::ast::Dialect;
use cognate::expr::program::Work;
use cognate::expr::walk::Host;
use cognate::expr::{Evaluator, Expr, Profile, parse};
use cognate::scalar::{Dual, Lanes, Scalar};
use expressions::{
    Anything, EXTREMES, bindings, engines_agree, extreme, laws_of_texts, laws_of_trees,
    prepared_call, program_is_the_walker, run,
};
use proptest::prelude::*;
use std::time::{Duration, Instant};

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 1000,
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn trees_print_and_read_back_and_every_engine_gives_the_walkers_bits(
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        time in -3.0..3.0,
    ) {
        for dialect in [Dialect::Function, Dialect::Expression] {
            laws_of_trees(&bytes, dialect, time);
        }
    }

    #[test]
    fn calls_with_constant_parameters_give_the_walkers_bits(
        bytes in prop::collection::vec(any::<u8>(), 0..60),
        time in -3.0..3.0,
    ) {
        program_is_the_walker(&prepared_call(&bytes), time);
    }

    #[test]
    fn operations_on_extreme_numbers_give_the_walkers_bits(
        bytes in prop::collection::vec(any::<u8>(), 0..16),
        time in prop::sample::select(EXTREMES.to_vec()),
    ) {
        for dialect in [Dialect::Function, Dialect::Expression] {
            let ast = extreme(&bytes, dialect);
            program_is_the_walker(&ast, time);
            engines_agree(&ast, time);
        }
    }

    #[test]
    fn any_text_is_read_or_refused_with_a_place(text in hostile()) {
        laws_of_texts(&text);
    }
}

/// Texts of words of the language in any order, and some that are not of it.
fn hostile() -> impl Strategy<Value = String> {
    let word = prop::sample::select(vec![
        "1", "2.5E-3", "30D", ".5", "7.", "1D3", "1E", "TIME", "PI", "t", "X", "SIN", "STEP",
        "MAX", "DX", "IF", "AKISPL", "JOINT", "(", "(", "(", ")", ")", ")", ",", ",", ":", "+",
        "-", "*", "/", "**", "* *", "&", "&\n", "!", "! c\n", "\n", " ", "^", ".", "_", "é", "−",
        "0", "12",
    ]);
    prop::collection::vec(word, 0..40).prop_map(|words| words.concat())
}

/// The shortest of some runs, which is what the machine needs when nobody else uses it.
fn shortest(mut run: impl FnMut()) -> Duration {
    let once = |()| {
        let start = Instant::now();
        run();
        start.elapsed()
    };
    [(); 10].map(once).into_iter().min().unwrap_or_default()
}

#[test]
fn zero_over_a_number_is_zero_and_a_number_over_itself_is_one_however_small_it_is() {
    for x in EXTREMES.into_iter().skip(1).flat_map(|x| [x, -x]) {
        for (text, expected) in [
            (format!("0/({x:e})"), 0.0_f64.to_bits()),
            (format!("({x:e})/({x:e})"), 1.0_f64.to_bits()),
            ("0/TIME".to_string(), 0.0_f64.to_bits()),
            ("TIME/TIME".to_string(), 1.0_f64.to_bits()),
        ] {
            let mut evaluator = Evaluator::parse(&text).unwrap_or_else(|e| panic!("{text}: {e}"));
            let inputs = vec![x; evaluator.inputs().len()];
            let got = evaluator.eval(&inputs).map(|value| value.abs().to_bits());
            assert_eq!(got.ok(), Some(expected), "{text} at {x:e}");
        }
    }
}

#[test]
fn unclosed_nestings_are_refused_at_once() {
    for opening in [
        "(",
        "SIN(",
        "IF(",
        "IF(1:",
        "IF(1:2,",
        "MAX(1,",
        "-(",
        "2**(",
        "POLY(TIME,0,",
    ] {
        for n in [30, 255, 5000] {
            let text = opening.repeat(n);
            let taken = shortest(|| assert!(Expr::parse(&text).is_err()));
            assert!(
                taken < Duration::from_millis(10),
                "{n} times {opening}: {taken:?}"
            );
        }
    }
}

#[test]
fn what_is_as_deep_as_allowed_goes_all_the_way() {
    for (open, close) in [
        ("(", ")"),
        ("SIN(", ")"),
        ("IF(1:1,2,", ")"),
        ("1+1*2**-(", ")"),
        ("ABS(-", ")"),
    ] {
        let nested = |n: usize| format!("{}1{}", open.repeat(n), close.repeat(n));
        // signs and powers are levels too
        let levels = if open.contains('-') { 170 } else { 256 };
        let host = Anything {
            time: 1.0,
            bindings: bindings(),
        };
        let deep = Expr::parse(&nested(levels)).unwrap_or_else(|e| panic!("{open}: {e}"));
        let value = deep
            .eval_with(&host)
            .unwrap_or_else(|e| panic!("{open}: {e}"));
        assert_eq!(run(&deep.compile(&host.bindings).unwrap(), &host), value);
        assert_eq!(
            parse(&deep.to_string(), Dialect::Function, Profile::Adams).unwrap(),
            *deep.ast()
        );
        assert_eq!(
            Expr::parse(&nested(257)).unwrap_err().code(),
            "limit_nesting"
        );
    }
    for chain in ["-", "2**", "2**-", "+"] {
        let error = Expr::parse(&format!("{}1", chain.repeat(5000))).unwrap_err();
        assert_eq!(error.code(), "limit_nesting", "{chain}");
    }
}

#[test]
fn a_million_characters_are_read_and_one_more_is_refused() {
    let text = format!("1{}", "+1".repeat(499_999));
    assert_eq!(
        Expr::parse(&format!("{text} ")).unwrap().eval(&[]).unwrap(),
        500_000.0
    );
    let error = Expr::parse(&format!("{text}+1")).unwrap_err();
    let said = error.first();
    assert_eq!((said.code, said.column), ("limit_length", 1_000_001));
}

#[test]
fn reading_takes_time_in_proportion_to_the_text() {
    // were it quadratic, ten times the text would take a hundred times as long
    let line = "+SIN(TIME)*2.5E3-DX(1,2)/7**2*IF(TIME: 1, 2, 3)\n";
    let time = |lines: usize| {
        let text = format!("1{}", line.repeat(lines));
        shortest(|| assert!(Expr::parse(&text).is_ok()))
    };
    let (hundred, thousand) = (time(100), time(1000));
    assert!(
        thousand < 50 * hundred,
        "100 lines {hundred:?}, 1000 lines {thousand:?}"
    );
}

#[test]
fn inputs_that_once_failed_keep_the_laws() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/fuzz");
    for (target, law) in expressions::TARGETS {
        for entry in std::fs::read_dir(format!("{folder}/{target}"))
            .into_iter()
            .flatten()
            .flatten()
        {
            println!("{}", entry.path().display());
            law(&std::fs::read(entry.path()).unwrap());
        }
    }
}

// ------------------------------------------------------------------------------------- numbers that are none

/// An expression with poles, made of bytes: operations that lose infinities and NaN, and parts that have no value at some of
/// the times 0, 0.25, 0.5, 1. Nothing else is too large for a number.
fn with_poles(bytes: &mut std::slice::Iter<u8>, depth: usize) -> String {
    let mut pick = |n: u8| bytes.next().map_or(0, |b| b % n);
    if depth == 0 {
        let place = ["0", "0.25", "0.5", "1"][usize::from(pick(4))];
        return match pick(8) {
            0 => format!("1/(TIME-{place})"),
            1 => format!("LOG(TIME-{place})"),
            2 => format!("SQRT(TIME-{place})"),
            3 => format!("(TIME-{place})**-1"),
            4 => format!("ATAN2(TIME-{place},TIME-{place})"),
            5 => "DX(1,2)".into(),
            6 => place.into(),
            _ => "TIME".into(),
        };
    }
    let form = pick(24);
    let [begin, end] = std::array::from_fn(|_| ["0", "1", "0.25", "30D"][usize::from(pick(4))]);
    let mut x = || format!("({})", with_poles(bytes, depth - 1));
    match form {
        0 => format!("MIN({},{})", x(), x()),
        1 => format!("MAX({},{},{})", x(), x(), x()),
        2 => format!("ATAN2({},{})", x(), x()),
        3 => format!("{}/{}", x(), x()),
        4 => format!("ATAN({})", x()),
        5 => format!("TANH({})", x()),
        6 => format!("SIGN({},{})", x(), x()),
        7 => format!("DIM({},{})", x(), x()),
        8 => format!("MOD({},{})", x(), x()),
        9 => format!("IF({}: {}, {}, {})", x(), x(), x(), x()),
        10 => format!("POLY({},0,7)", x()),
        11 => format!("STEP({},{begin},1,{end},2)", x()),
        12 => format!("IMPACT({},{},1,100,1.5,25,0.1)", x(), x()),
        13 => format!("EXP(-ABS({}))", x()),
        14 => format!("{}**0", x()),
        15 => format!("{}**-2", x()),
        16 => format!("0*{}", x()),
        17 => format!("CHEBY({},{},3)", x(), x()),
        18 => format!("FORCOS({},0,1,2)", x()),
        19 => format!("HAVSIN({},{begin},1,{end},2)", x()),
        20 => format!("BISTOP({},{},{begin},{end},100,1.5,20,0.1)", x(), x()),
        21 => format!("AKISPL({},0,1)", x()),
        22 => format!("{}-{}", x(), x()),
        _ => format!("{}*{}", x(), x()),
    }
}

/// Whether each engine has a value where the walker has one, and none where it has none.
fn engines_agree_about_values(text: &str) -> Result<(), String> {
    let expr = Expr::parse(text).map_err(|e| e.to_string());
    let Ok(expr) = expr else {
        return Ok(()); // a mistake whatever the inputs are
    };
    let times = [0.0, 0.25, 0.5, 1.0];
    let hosts = times.map(|time| Anything {
        time,
        bindings: bindings(),
    });
    let program = match expr.compile(&bindings()) {
        Ok(program) => program,
        // a mistake of constants that curves yield
        Err(_) if hosts.iter().all(|host| expr.eval_with(host).is_err()) => return Ok(()),
        Err(e) => return Err(format!("{text}: {e}")),
    };
    let of = |host: &Anything, input| host.input(input).unwrap_or(f64::NAN);
    let lanes: Vec<Lanes<4>> = (program.inputs().iter())
        .map(|&i| Lanes(std::array::from_fn(|k| of(&hosts[k], i))))
        .collect();
    let mut wide = [Lanes([0.0; 4])];
    program.eval(&lanes, &mut Work::default(), &mut wide);
    for (k, host) in hosts.iter().enumerate() {
        let walked = expr.eval_with(host);
        let duals: Vec<Dual<1>> = (program.inputs().iter())
            .map(|&i| Dual::variable(of(host, i), 0))
            .collect();
        let mut dual = [Dual::constant(0.0)];
        program.eval(&duals, &mut Work::default(), &mut dual);
        let engines = [
            ("program", run(&program, host)),
            ("lanes", wide[0].0[k]),
            ("duals", dual[0].re),
        ];
        for (engine, value) in engines {
            let agree = match &walked {
                Ok(walked) => walked.to_bits() == value.to_bits(),
                Err(_) => !value.is_finite(),
            };
            if !agree {
                let time = times[k];
                return Err(format!(
                    "{text} at {time}: {engine} {value}, walker {walked:?}"
                ));
            }
        }
    }
    Ok(())
}

#[test]
fn infinities_and_nan_are_never_made_numbers() {
    for text in [
        "ATAN2(1/TIME,1/TIME)",
        "MIN(5,1/TIME)",
        "1/(1/TIME)",
        "SQRT(TIME-5)**0",
        "POLY(LOG(TIME-5),0,7)",
        "0/TIME",
        "0*(1/TIME)",
        "ATAN(1/TIME)",
        "EXP(-1/TIME**2)",
        "IF(1/TIME: 1, 2, 3)",
        "IF(TIME: 1, 2, MIN(3,1/TIME))",
        "STEP(1/TIME,0,1,1,2)",
        "IMPACT(1/TIME,1,1,100,1.5,25,0.1)",
        "IMPACT(SQRT(TIME-5),1,1,100,1.5,25,0.1)",
        "MOD(3,1/TIME)",
        // mistakes of constants in a branch that need not be reached
        "IF(TIME-0.25: 7, POLY(MOD(TIME,0),0,7), 7)",
        "IF(TIME-0.25: 7, POLY(STEP(TIME,2,0,1,2),0,7), 7)",
        "IF(TIME-0.25: 7, POLY(HAVSIN(TIME,90D,0,1,2),0,7), 7)",
        "IF(TIME-0.25: 7, POLY(SWEEP(TIME,1,2,1,1,1,1),0,7), 7)",
    ] {
        engines_agree_about_values(text).unwrap();
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..config() })]

    #[test]
    fn every_engine_has_a_value_where_the_walker_has_one(
        bytes in prop::collection::vec(any::<u8>(), 1..60),
        depth in 1_usize..4,
    ) {
        let text = with_poles(&mut bytes.iter(), depth);
        prop_assert_eq!(engines_agree_about_values(&text), Ok(()));
    }
}
