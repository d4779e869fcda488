//! The limits of I-DEAS (profile ideas): what is just within passes, one more is refused with its kind and its column.

use cognate::expr::ast::Dialect;
use cognate::expr::{Limits, Profile, parse, parse_with_limits};

/// `code at column`, or nothing.
fn ideas(text: &str) -> Option<String> {
    parse(text, Dialect::Function, Profile::Ideas)
        .err()
        .map(|d| format!("{} at {}", d.code, d.column))
}

/// Refused by I-DEAS with this code at this column (from 1), but legal where its limits do not hold.
fn refused(text: &str, code: &str, column: usize) {
    assert_eq!(ideas(text), Some(format!("{code} at {column}")), "{text}");
    parse(text, Dialect::Function, Profile::Adams).unwrap_or_else(|e| panic!("{text}: {e}"));
}

fn accepted(text: &str) {
    assert_eq!(ideas(text), None, "{text}");
}

#[test]
fn ten_levels_of_groups_functions_and_ifs_pass_and_the_eleventh_does_not() {
    let groups = |n: usize| "(".repeat(n) + "1" + &")".repeat(n);
    accepted(&groups(10));
    refused(&groups(11), "limit_nesting", 11);
    let calls = |n: usize| "ABS(".repeat(n) + "1" + &")".repeat(n);
    accepted(&calls(10));
    refused(&calls(11), "limit_nesting", 41);
    let ifs = |n: usize| "IF(".repeat(n) + "1" + &":1,1,1)".repeat(n);
    accepted(&ifs(10));
    refused(&ifs(11), "limit_nesting", 31);
    // levels are counted, whatever they are: five of each kind
    let mixed = |inner: &str| "ABS((".repeat(5) + inner + &"))".repeat(5);
    accepted(&mixed("1"));
    refused(&mixed("SIN(1)"), "limit_nesting", 26);
    refused(&mixed("2+(1)"), "limit_nesting", 28);
}

#[test]
fn columns_count_characters_of_however_many_bytes() {
    let column = |text: &str| {
        let said = parse(text, Dialect::Function, Profile::Adams).expect_err("a mistake");
        said.column
    };
    assert_eq!(column("1 ! é\n+ *2"), 9);
    assert_eq!(column("1 ! e\n+ *2"), 9);
    assert_eq!(column("1 + é + ü"), 5);
}

#[test]
fn levels_are_counted_in_depth_and_not_in_number() {
    let ten = "(".repeat(10) + "1" + &")".repeat(10);
    accepted(&[ten.as_str(); 20].join("+"));
    // signs and powers nest nothing
    accepted(&("-".repeat(50) + "1"));
    accepted(&["1"; 40].join("**"));
}

#[test]
fn the_twenty_sixth_element_of_a_kind_is_refused_where_it_is_named() {
    let markers = |n: usize| (1..=n).map(|k| format!("DM({k})")).collect::<Vec<_>>();
    accepted(&markers(25).join("+"));
    let text = markers(26).join("+");
    refused(&text, "limit_elements", text.len() - 2);
    // the same marker again is none more; 0 is ground and no element
    accepted(&(markers(25).join("+") + "+DX(3,0,25)"));
    // kinds are counted apart
    let both = (1..=20)
        .map(|k| format!("DM({k})*DIF({k})"))
        .collect::<Vec<_>>();
    accepted(&both.join("+"));
    // several in one call: the second argument is the 26th
    let text = markers(24).join("+") + "+DM(25,26)";
    refused(&text, "limit_elements", text.len() - 2);
}

#[test]
fn twenty_lines_pass_and_the_first_column_of_the_next_is_refused() {
    let lines = |n: usize| ["1"; 50][..n].join("\n+");
    accepted(&lines(20));
    // 1 and its line break, then nineteen lines of three characters
    refused(&lines(21), "limit_lines", 2 + 19 * 3 + 1);
    // comments and continued lines are lines too
    refused(&("! a comment\n".repeat(20) + "1"), "limit_lines", 241);
    refused(&("& \n".repeat(20) + "1"), "limit_lines", 61);
}

#[test]
fn five_hundred_characters_pass_and_the_next_is_refused() {
    let long = |n: usize| "1".to_owned() + &" ".repeat(n - 3) + "+1";
    accepted(&long(500));
    refused(&long(501), "limit_length", 501);
    refused(&long(700), "limit_length", 501);
    // characters, not bytes
    let comment = |n: usize| "1!".to_owned() + &"é".repeat(n - 2);
    accepted(&comment(500));
    refused(&comment(501), "limit_length", 501);
}

/// A thousand symbols have at least a thousand characters, so that the length must be free for this limit to be met.
#[test]
fn a_thousand_symbols_pass_and_the_next_is_refused_where_it_begins() {
    let limits = Limits {
        lines: usize::MAX,
        characters: 1_000_000,
        ..Limits::IDEAS
    };
    let of = |text: &str| parse_with_limits(text, Dialect::Function, Profile::Ideas, limits);
    // operators, brackets, names and numbers count one each: 498·2 + 4
    let text = "PI + ".repeat(498) + "SIN(1)";
    assert!(of(&text).is_ok());
    let fault = of(&(text.clone() + "*7")).unwrap_err();
    assert_eq!(
        (fault.code, fault.column),
        ("limit_symbols", text.chars().count() + 1)
    );
    refused(&text, "limit_length", 501);
}

#[test]
fn the_limits_hold_for_expression_functions_as_well() {
    let text = "sin(".repeat(11) + "t" + &")".repeat(11);
    let fault = parse(&text, Dialect::Expression, Profile::Ideas).unwrap_err();
    assert_eq!((fault.code, fault.column), ("limit_nesting", 41));
    assert!(parse(&text, Dialect::Expression, Profile::Adams).is_ok());
}
