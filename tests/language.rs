//! Laws of the function language on random expressions and hostile texts.

#[path = "common/expressions.rs"]
mod expressions;

use cognate::expr::ast::Dialect;
use cognate::expr::{Expr, Profile, parse};
use expressions::{Anything, bindings, laws_of_texts, laws_of_trees, run};
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
        assert_eq!(Expr::parse(&nested(257)).unwrap_err().code, "limit_nesting");
    }
    for chain in ["-", "2**", "2**-", "+"] {
        let error = Expr::parse(&format!("{}1", chain.repeat(5000))).unwrap_err();
        assert_eq!(error.code, "limit_nesting", "{chain}");
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
    assert_eq!((error.code, error.column), ("limit_length", 1_000_001));
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
