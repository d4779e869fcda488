//! Expressions on the command line: every option of `eval`, sessions of `repl`, `functions` and `explain`, as users meet them.

use crate::command;

use command::{cognate, cognate_with, path, scratch, session};
use serde_json::{Value, json};

/// Standard output of `cognate eval` that must succeed in silence.
fn eval(args: &[&str]) -> String {
    let done = cognate(&[&["eval"], args].concat());
    assert_eq!((done.code, done.err.as_str()), (0, ""), "{args:?}");
    done.out
}

/// Exit code and standard error of `cognate eval` that must fail and print no result.
fn fails(args: &[&str]) -> (i32, String) {
    let done = cognate(&[&["eval"], args].concat());
    assert_eq!(done.out, "", "{args:?}");
    (done.code, done.err)
}

fn json_of(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

// ----------------------------------------------------------------------------------------------------------------- time

#[test]
fn a_range_goes_up_or_down_and_ends_where_its_steps_end() {
    assert_eq!(
        eval(&["TIME", "--time", "0:1:0.4"]),
        "time,TIME\n0,0\n0.4,0.4\n0.8,0.8\n"
    );
    assert_eq!(
        eval(&["TIME", "--time", "1:0:-0.5"]),
        "time,TIME\n1,1\n0.5,0.5\n0,0\n"
    );
    assert_eq!(eval(&["TIME", "--time", "2:2:1"]), "time,TIME\n2,2\n");
    // multiples of the step, not sums of it
    let table = eval(&["TIME", "--time", "0:1:0.1"]);
    assert!(table.ends_with("\n0.9,0.9\n1,1\n"), "{table}");
}

#[test]
fn a_value_without_its_option_is_told_which_one_takes_it() {
    for (value, said) in [
        ("TIME=3", "`--time 3`"),
        ("t=0:1:0.1", "`--time 0:1:0.1`"),
        ("DX(1,2)=3", "`--set 'DX(1,2)=3'`"),
        ("3", "stands in quotes"),
    ] {
        let (code, err) = fails(&["TIME+DX(1,2)", value]);
        assert!(code == 2 && err.contains(said), "{value}: {code} {err}");
    }
}

#[test]
fn what_is_no_time_or_leads_nowhere_is_a_mistake_of_usage() {
    for (time, said) in [
        ("abc", "neither a time nor a range"),
        ("1:2", "neither a time nor a range"),
        ("1:2:3:4", "neither a time nor a range"),
        ("inf", "neither a time nor a range"),
        ("0:1:0", "no steps of 0 lead from 0 to 1"),
        ("0:1:-0.1", "no steps of -0.1 lead from 0 to 1"),
        ("0:1E9:1E-3", "samples are more than"),
    ] {
        let (code, err) = fails(&["TIME", "--time", time]);
        assert!(code == 2 && err.contains(said), "{time}: {code} {err}");
    }
}

#[test]
fn a_time_that_is_needed_and_missing_is_asked_for() {
    let (code, err) = fails(&["2*TIME"]);
    assert_eq!(code, 3);
    assert!(
        err.contains("error[missing_value]: TIME has no value here"),
        "{err}"
    );
    assert!(err.contains("--time 1.5"), "{err}");
    assert_eq!(eval(&["2*PI-PI*2"]), "0\n");
}

#[test]
fn a_table_stops_where_the_expression_has_no_value_and_says_when() {
    let (code, err) = fails(&["LOG(1-TIME)", "--time", "0:2:0.5"]);
    assert_eq!(code, 3);
    assert!(err.contains("LOG of 0 has no value at TIME = 1"), "{err}");
    assert!(err.contains("1 | LOG(1-TIME)\n  | ^^^"), "{err}");
}

// ---------------------------------------------------------------------------------------------------------- derivatives

#[test]
fn derivatives_come_alone_at_a_time_and_in_columns_over_a_range() {
    assert_eq!(
        eval(&["TIME**3", "--time", "2", "--derivative", "0"]),
        "8\n"
    );
    assert_eq!(
        eval(&["TIME**3", "--time", "2", "--derivative", "1"]),
        "12\n"
    );
    assert_eq!(
        eval(&["TIME**3", "--time", "2", "--derivative", "2"]),
        "12\n"
    );
    assert_eq!(
        eval(&["TIME**3", "--time", "0:1:0.5", "--derivative", "2"]),
        "time,TIME**3,d/dt TIME**3,d2/dt2 TIME**3\n0,0,0,0\n0.5,0.125,0.75,3\n1,1,3,6\n"
    );
    let (code, err) = fails(&["TIME", "--time", "1", "--derivative", "3"]);
    assert!(code == 2 && err.contains("--derivative"), "{code} {err}");
}

#[test]
fn a_derivative_that_does_not_exist_is_told_apart_from_a_value_that_does_not() {
    assert_eq!(eval(&["SQRT(TIME)", "--time", "0"]), "0\n");
    let (code, err) = fails(&["SQRT(TIME)", "--time", "0", "--derivative", "1"]);
    assert_eq!(code, 3);
    assert!(
        err.contains("the first derivative has no finite value at time 0"),
        "{err}"
    );
    // b aᵇ⁻¹ is finite at 0 for b ≥ 1
    assert_eq!(
        eval(&["TIME**2.5", "--time", "0", "--derivative", "1"]),
        "0\n"
    );
}

#[test]
fn infinities_are_never_made_numbers() {
    for text in [
        "ATAN2(1/TIME,1/TIME)",
        "MIN(5,1/TIME)",
        "1/(1/TIME)",
        "0/TIME",
        "EXP(-1/TIME)",
        "IF(1/TIME: 1, 2, 3)",
        "SQRT(TIME-5)**0",
        "POLY(LOG(TIME-5),0,7)",
        "IMPACT(1/TIME,0,1,100,1.5,25,0.1)",
    ] {
        let (code, err) = fails(&[text, "--time", "0"]);
        assert!(code == 3 && err.contains("error[domain]"), "{text}: {err}");
        let (code, err) = fails(&[text, "--time", "0", "--derivative", "1"]);
        assert!(code == 3 && err.contains("error[domain]"), "{text}: {err}");
    }
    // on the taken path only
    assert_eq!(eval(&["IF(TIME: 1, 2, 1/(1/TIME))", "--time", "0"]), "2\n");
    assert_eq!(eval(&["1/(1/TIME)", "--time", "4"]), "4\n");
}

// ------------------------------------------------------------------------------------------------- dialects and profiles

#[test]
fn each_dialect_has_its_own_time_its_own_angles_and_advice_about_the_other() {
    assert_eq!(
        eval(&[
            "180*sin(360*t)",
            "--dialect",
            "expression",
            "--time",
            "0.25"
        ]),
        "180\n"
    );
    let table = eval(&["ent(t)", "--dialect", "expression", "--time", "0:1:0.75"]);
    assert_eq!(table, "time,ent(t)\n0,0\n0.75,0\n");
    // d/dt sin(t) is π/180 cos(t)
    let slope = eval(&[
        "sin(t)",
        "--dialect",
        "expression",
        "--time",
        "0",
        "--derivative",
        "1",
    ]);
    assert_eq!(slope.trim().parse(), Ok(std::f64::consts::PI / 180.0));
    let (code, err) = fails(&["sin(TIME)", "--dialect", "expression", "--time", "1"]);
    assert!(code == 3 && err.contains("time is t here"), "{err}");
    let (code, err) = fails(&["SIN(t)", "--time", "1"]);
    assert!(code == 3 && err.contains("time is TIME here"), "{err}");
    let (code, err) = fails(&["sin(30D)", "--dialect", "expression"]);
    assert!(code == 3 && err.contains("error[bad_number]"), "{err}");
}

#[test]
fn the_profile_ideas_has_limits_and_akima() {
    let nested = "ABS(".repeat(11) + "1" + &")".repeat(11);
    assert_eq!(eval(&[&nested]), "1\n");
    let (code, err) = fails(&[&nested, "--profile", "ideas"]);
    assert!(code == 3 && err.contains("error[limit_nesting]"), "{err}");
    let caret = err.lines().find(|l| l.contains('^')).unwrap();
    assert_eq!(caret.find('^'), Some("1 | ".len() + 40), "{err}");

    let data = scratch(
        "profile",
        "s.json",
        r#"{"1": {"x": [1, 2, 3, 4], "y": [0, 2, 1, 3]}}"#,
    );
    let splines = ["--splines", path(&data)];
    let akima = [&["AKIMA(1.5,0,1)"][..], &splines].concat();
    assert_eq!(
        eval(&[&akima[..], &["--profile", "ideas"]].concat()),
        "1.375\n"
    );
    let (code, err) = fails(&akima);
    assert!(code == 3 && err.contains("error[unknown_name]"), "{err}");
}

// ------------------------------------------------------------------------------------------------ markers, splines, values

#[test]
fn markers_move_and_what_is_not_known_of_them_is_named() {
    let file = scratch(
        "eval_markers",
        "m.json",
        r#"{"1": {"r": [3, 4, 12], "v": [1, 2, -1]}, "2": {"w": [0, 0, 1]}, "3": {"A": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]}}"#,
    );
    let of = |expression: &str| eval(&[expression, "--markers", path(&file)]);
    assert_eq!(of("DM(1,2)"), "13\n");
    assert_eq!(of("DX(1,2,3)"), "4\n");
    assert_eq!(of("AZ(3)*RTOD"), "90\n");
    assert_eq!(of("VX(1,2,2,2)"), "5\n");
    // d/dt DM = VR
    let rate = eval(&["DM(1,2)", "--markers", path(&file), "--derivative", "1"]);
    assert_eq!(rate, of("VR(1,2)"));
    let (code, err) = fails(&["DM(1,7)", "--markers", path(&file)]);
    assert_eq!(code, 3);
    assert!(
        err.contains("DM(1, 7) has no value here") && err.contains("nothing is known of marker 7"),
        "{err}"
    );
    let (code, err) = fails(&["JOINT(3,0,1,0)", "--markers", path(&file)]);
    assert!(
        code == 3 && err.contains("--set 'JOINT(3,0,1,0)=2.5'"),
        "{err}"
    );
    let (code, err) = fails(&["DM(1)", "--markers", "no_such_file.json"]);
    assert!(
        code == 3 && err.contains("no_such_file.json: cannot be read"),
        "{err}"
    );
}

#[test]
fn values_are_given_to_functions_of_the_model() {
    let values = ["--set", "VARVAL(3)=2.5", "--set", "JOINT( 1,0, 2,0 ) = -4"];
    assert_eq!(
        eval(&[&["VARVAL(3)*JOINT(1,0,2,0)"][..], &values].concat()),
        "-10\n"
    );
    for (set, code, said) in [
        ("VARVAL(3)", 2, "CALL=VALUE"),
        ("VARVAL(3)=x", 2, "CALL=VALUE"),
        ("VAR(3)=1", 3, "did you mean"),
        ("TIME=1", 3, "--time"),
    ] {
        let (exit, err) = fails(&["VARVAL(3)", "--set", set]);
        assert!(exit == code && err.contains(said), "{set}: {exit} {err}");
    }
}

#[test]
fn splines_are_curves_and_families_with_their_extrapolation() {
    let file = scratch(
        "eval_splines",
        "s.json",
        r#"{"1": {"x": [1, 2, 3, 4], "y": [0, 2, 1, 3]}, "2": {"x": [0, 1, 2, 3], "y": [0, 1, 4, 9], "extrap": "linear"},
            "3": {"x": [0, 1, 2, 3], "z": [0, 1], "y": [[0, 1, 2, 3], [0, 2, 4, 6]]}}"#,
    );
    let of = |expression: &str| eval(&[expression, "--splines", path(&file)]);
    assert_eq!(of("AKISPL(1.5,0,1)"), "1.375\n");
    assert_eq!(of("CUBSPL(4,0,1,1)"), "3\n");
    assert_eq!(of("CUBSPL(5,0,2)"), "19\n");
    assert_eq!(of("AKISPL(2,0.5,3)"), "3\n");
    let slope = eval(&[
        "AKISPL(TIME,0,1)",
        "--splines",
        path(&file),
        "--time",
        "2",
        "--derivative",
        "1",
    ]);
    assert_eq!(slope, "0.5\n");
    let (code, err) = fails(&["AKISPL(1,0.5,3,1)", "--splines", path(&file)]);
    assert!(code == 3 && err.contains("family"), "{err}");
    let (code, err) = fails(&["AKISPL(1,0,9)", "--splines", path(&file)]);
    assert!(
        code == 3 && err.contains("error[unknown_element]") && err.contains("there are: 1, 2, 3"),
        "{err}"
    );
    let (_, err) = fails(&["AKISPL(1,0,9)"]);
    assert!(
        err.contains("no spline is given") && err.contains("--splines FILE"),
        "{err}"
    );
}

// -------------------------------------------------------------------------------------------------------- plots and JSON

#[test]
fn json_tells_value_derivatives_and_tables() {
    let one = json_of(&eval(&[
        "TIME**3",
        "--time",
        "2",
        "--derivative",
        "2",
        "--json",
    ]));
    assert_eq!(
        one,
        json!({ "expression": "TIME**3", "time": 2.0, "value": 8.0, "derivatives": [12.0, 12.0] })
    );
    let untimed = json_of(&eval(&["1/4", "--json"]));
    assert_eq!(
        (&untimed["time"], &untimed["value"]),
        (&Value::Null, &json!(0.25))
    );
    let table = json_of(&eval(&[
        "TIME**2",
        "--time",
        "0:1:0.5",
        "--derivative",
        "1",
        "--json",
    ]));
    let names: Vec<&Value> = table["columns"]
        .as_array()
        .unwrap()
        .iter()
        .map(|c| &c["name"])
        .collect();
    assert_eq!(names, ["time", "TIME**2", "d/dt TIME**2"]);
    assert_eq!(table["columns"][2]["values"], json!([0.0, 1.0, 2.0]));
    let done = cognate(&["eval", "2*FOO(1)", "--json"]);
    let said = json_of(&done.out);
    assert_eq!(
        (
            done.code,
            &said["errors"][0]["code"],
            &said["errors"][0]["column"]
        ),
        (3, &json!("unknown_name"), &json!(3))
    );
}

#[test]
fn mistakes_in_json_have_the_line_that_an_editor_shows() {
    let done = cognate_with(&["eval", "-", "--json"], "1 +\n  2 *\n  FOO(3)\n");
    let said = &json_of(&done.out)["errors"][0];
    assert_eq!(
        (&said["line"], &said["column_in_line"], &said["column"]),
        (&json!(3), &json!(3), &json!(13))
    );
    let done = cognate(&["eval", "2*(3+SIN(4", "--json"]);
    let said = &json_of(&done.out)["errors"][0];
    assert_eq!((&said["line"], &said["column"]), (&json!(1), &json!(11)));
    assert_eq!(said["marks"][0]["start"], json!(8));
}

#[test]
fn numbers_of_files_are_read_to_the_last_bit() {
    // numbers that a reader which multiplies by a power of ten misses by one bit
    let list = [
        0.12345678901234568,
        9007199254740993e-25,
        1.7976931348623157e300,
        4.35e-17,
        8.98846567431158e307,
        2.225_073_858_507_201e-300,
        123456.78901234567,
    ];
    let mut random = 88172645463325252_u64;
    let mut next = || {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        f64::from_bits(random >> 2 | 1 << 60)
    };
    let all: Vec<f64> = list.into_iter().chain((0..93).map(|_| next())).collect();
    let points = (all.iter().enumerate())
        .map(|(k, x)| format!("\"{}\": {{\"r\": [{x:e}, 0, 0]}}", k + 1))
        .collect::<Vec<_>>();
    let file = scratch("last_bit", "m.json", &format!("{{{}}}", points.join(", ")));
    for (k, x) in all
        .iter()
        .enumerate()
        .step_by(9)
        .chain(all.iter().enumerate().take(7))
    {
        let call = format!("DX({})", k + 1);
        let said = eval(&[&call, "--markers", path(&file), "--json"]);
        let value = json_of(&said)["value"].as_f64().unwrap();
        assert_eq!(value.to_bits(), x.to_bits(), "{x:e} is read as {value:e}");
    }
}

#[test]
fn curves_are_read_from_a_file_and_missing_ones_say_where_from() {
    let file = scratch(
        "eval_curves",
        "c.json",
        r#"{"1": {"points": [[0,0,0], [1,0,0], [2,0,0], [3,0,0]]},
            "2": {"points": [[0,0,0], [1,2,0], [2,0,1], [0,0,0]], "closed": true, "order": 2}}"#,
    );
    let curves = ["--curves", path(&file)];
    let of = |text: &str| eval(&[&[text][..], &curves].concat());
    assert_eq!(of("CURVE(0,0,1,1)"), "1.5\n");
    assert_eq!(of("CURVE(-1,0,1,2)"), "0\n");
    let (code, err) = fails(&[&["CURVE(0,0,1,9)"][..], &curves].concat());
    assert!(code == 3 && err.contains("there are: 1, 2"), "{err}");
    let (_, err) = fails(&["CURVE(0,0,1,1)"]);
    assert!(
        err.contains("--curves FILE") && !err.contains("--splines"),
        "{err}"
    );
    let (_, err) = fails(&["AKISPL(0,0,1)"]);
    assert!(
        err.contains("--splines FILE") && !err.contains("--curves"),
        "{err}"
    );
    for (text, said) in [
        (r#"{"1": {"points": [[0,0]]}}"#, "each three numbers"),
        (r#"{"1": {}}"#, "\"points\" is missing"),
        (r#"{"1": {"points": [[0,0,0],[1,0,0]]}}"#, "at least 4"),
        (
            r#"{"1": {"points": [[0,0,0],[1,0,0],[2,0,0],[3,0,0]], "closed": 1}}"#,
            "true or false",
        ),
    ] {
        let file = scratch("eval_curves", "bad.json", text);
        let (code, err) = fails(&["CURVE(0,0,1,1)", "--curves", path(&file)]);
        assert!(code == 3 && err.contains(said), "{text}: {err}");
    }
    let (said, code) = session(
        &format!(":curves {}\nCURVE(0,0,1,1)\n", path(&file)),
        "curves.txt",
    );
    assert_eq!((said.as_str(), code), ("2 curves\n1.5\n", 0));
}

#[test]
fn a_plot_takes_the_place_of_the_table_and_json_stays() {
    let file = scratch("eval_plot", "p.svg", "");
    let range = [
        "SIN(TIME)",
        "--time",
        "0:1:0.5",
        "--derivative",
        "2",
        "--plot",
        path(&file),
    ];
    let done = cognate(&[&["eval"][..], &range].concat());
    assert_eq!((done.code, done.out.as_str()), (0, ""));
    assert!(done.err.contains("p.svg"), "{}", done.err);
    let svg = std::fs::read_to_string(&file).unwrap();
    for curve in ["SIN(TIME)", "d/dt SIN(TIME)", "d2/dt2 SIN(TIME)"] {
        assert!(svg.contains(curve), "{curve}");
    }
    std::fs::remove_file(&file).unwrap();
    let done = cognate(&[&["eval"][..], &range, &["--json"]].concat());
    assert_eq!(json_of(&done.out)["columns"].as_array().unwrap().len(), 4);
    assert!(file.is_file());
    let (code, err) = fails(&["TIME", "--time", "1", "--plot", path(&file)]);
    assert!(code == 2 && err.contains("first:last:step"), "{err}");
}

// -------------------------------------------------------------------------------------------------------------- explain

#[test]
fn an_explanation_shows_tree_values_inputs_switches_class_breaks_and_program() {
    let said = eval(&[
        "STEP(TIME,1,0,2,1)+IF(TIME-1: 2, 3, 4)",
        "--explain",
        "--time",
        "1.5",
    ]);
    for line in [
        "STEP(TIME, 1, 0, 2, 1) + IF(TIME - 1: 2, 3, 4)",
        "+                4.5",
        "  STEP           0.5",
        "    x: TIME      1.5",
        "    x0: 1",
        "    selector: -  0.5",
        "reads      TIME",
        "switches   TIME - 1",
        "class      none: the value jumps",
        "breaks     TIME = 1: value jumps from 2 to 4",
        "           TIME = 2: curvature jumps from -6 to 0",
    ] {
        assert!(said.lines().any(|l| l == line), "{line}\n{said}");
    }
    assert!(said.contains("program    4 operations"), "{said}");
    assert!(eval(&["TIME**3", "--explain"]).contains("program    1 operation,"));
    assert!(
        eval(&["2*PI", "--explain"])
            .contains("program    folded to the constant 6.283185307179586\n")
    );
    // without a time there are no values, and breaks are sought in the range that is given
    assert!(eval(&["MAX(TIME,2)", "--explain"]).contains("switches   TIME - 2\nclass"));
    let early = eval(&["STEP(TIME,1,0,2,1)", "--explain", "--time", "0:1.5:0.5"]);
    assert!(
        early.contains("TIME = 1: ") && !early.contains("TIME = 2: "),
        "{early}"
    );
    let t = eval(&["abs(t-1)", "--dialect", "expression", "--explain"]);
    assert!(
        t.contains("t = 1: slope jumps from -1 to 1") && t.contains("reads      t"),
        "{t}"
    );
    assert_eq!(fails(&["TIME", "--explain", "--json"]).0, 2);
    assert_eq!(fails(&["TIME+", "--explain"]).0, 3);
}

// ---------------------------------------------------------------------------------------------------------------- input

#[test]
fn expressions_come_from_standard_input_and_may_begin_with_a_minus() {
    let done = cognate_with(
        &["eval", "-", "--time", "3"],
        "2 * & \n TIME ! and a comment\n",
    );
    assert_eq!((done.code, done.out.as_str()), (0, "6\n"));
    assert_eq!(eval(&["-TIME**2", "--time", "2"]), "-4\n");
    assert_eq!(eval(&["-TIME", "--time", "-2"]), "2\n");
    let done = cognate_with(&["eval", "-"], "1 +\n  2 *\n  FOO(3)\n");
    assert_eq!(done.code, 3);
    assert!(done.err.contains("3 |   FOO(3)\n  |   ^^^"), "{}", done.err);
    let (code, err) = fails(&[""]);
    assert!(code == 3 && err.contains("there is no expression"), "{err}");
}

// ------------------------------------------------------------------------------------------------------------- sessions

/// The session that the page of the prompt shows, typed again: lines behind `> ` and what continues them go in, the others come out.
#[test]
fn the_session_of_the_prompts_page_is_what_really_comes_out() {
    let page = include_str!("../../docs/prompt.md");
    let (_, from) = page.split_once("```text\n").unwrap();
    let (shown, _) = from.split_once("\n```").unwrap();
    let (mut typed, mut printed, mut open) = (String::new(), String::new(), false);
    for line in shown.lines() {
        let input = line
            .strip_prefix("> ")
            .or(if open { line.strip_prefix("  ") } else { None });
        // on the page a line that goes on ends with an operator
        open = input.is_some_and(|i| i.ends_with(['*', '+', '-', '/', ',', '(']));
        match input {
            Some(input) => typed += &format!("{input}\n"),
            None => printed += &format!("{line}\n"),
        }
    }
    assert!(typed.lines().count() > 10 && printed.lines().count() > 20);
    let (said, code) = session(&typed, "page.txt");
    let trimmed = |text: &str| {
        text.lines()
            .map(str::trim_end)
            .collect::<Vec<_>>()
            .join("\n")
    };
    assert_eq!(trimmed(&said), trimmed(&printed));
    // mistakes were made
    assert_eq!(code, 3);
}

#[test]
fn a_session_without_mistakes_ends_well_and_quit_ends_it() {
    let (said, code) = session(":let k = 3\nk*2\n:quit\n1+1\n", "quit.txt");
    assert_eq!((said.as_str(), code), ("6\n", 0));
    // the last line needs no end, an unfinished one is a mistake
    assert_eq!(session("1+\n1", "open.txt"), ("2\n".into(), 0));
    let (said, code) = session("(1+\n1", "unfinished.txt");
    assert!(
        code == 3 && said.contains("error[unexpected_end]"),
        "{said}"
    );
}

#[test]
fn mistakes_at_the_prompt_point_into_what_they_are_about() {
    let (said, code) = session(
        ":time 2*FOO\n:plot BAR 0 1\n:explain\n:let x = LOG(\n:derivtive 1\n:time\n",
        "places.txt",
    );
    assert_eq!(code, 3);
    for text in [
        "1 | 2*FOO\n  |   ^^^",
        "1 | BAR\n  | ^^^",
        ":explain is used like this: :explain EXPRESSION",
        "1 | LOG(\n",
        "did you mean :derivative?",
    ] {
        assert!(said.contains(text), "{text}\n{said}");
    }
    // the time is what it was
    assert!(said.ends_with("\n0\n"), "{said}");
}

#[test]
fn mistakes_at_the_prompt_show_the_text_as_it_was_typed() {
    let typed = ":let root = SQRT(TIME-1)\n:let w = 2*PI\nw*FOO\n1+root\n2*(w+SIN(w\n\n";
    let (said, code) = session(typed, "typed.txt");
    assert_eq!(code, 3);
    for text in [
        "1 | w*FOO\n  |   ^^^",
        "1 | 1+root\n  |   ^^^^",
        "root stands for SQRT(TIME-1)",
        "1 | 2*(w+SIN(w\n  |         - ^",
        "this parenthesis is not closed",
    ] {
        assert!(said.contains(text), "{text}\n{said}");
    }
    assert!(!said.contains("(2*PI)*FOO"), "{said}");
    // a warning too
    let (said, _) = session(":let w = 2\nw*SIN(30)\n", "typed_warning.txt");
    assert!(said.contains("1 | w*SIN(30)\n  |   ^^^"), "{said}");
}

#[test]
fn one_blank_line_ends_what_is_not_complete() {
    let (said, code) = session("(1+\n\n2+3\n", "blank.txt");
    assert_eq!(code, 3);
    assert!(
        said.contains("error[unexpected_end]") && said.ends_with("\n5\n"),
        "{said}"
    );
    assert_eq!(session("help STEP5\nquit\n1+1\n", "bare.txt").1, 0);
}

#[test]
fn an_open_call_has_its_parenthesis_underlined() {
    let (_, err) = fails(&["2*(SIN(TIME)+MAX(1,2"]);
    let shown = [
        "error[unexpected_end]: the text ends inside MAX",
        "1 | 2*(SIN(TIME)+MAX(1,2",
        "  |                 -   ^",
        "  |                 |",
        "  |                 this parenthesis is not closed",
        "  = help: it is written MAX(a, b[, …])",
    ];
    for line in shown {
        assert!(err.lines().any(|l| l.trim_end() == line), "{line}\n{err}");
    }
}

#[test]
fn the_prompt_changes_language_order_and_markers() {
    let typed = ":dialect expression\nsin(90)\n:dialect function\nSIN(90D)\n:marker 1 3 4 12\n:marker 2 {\"r\": [0,0,12]}\n\
        DM(1,2)\n:marker\n:let VARVAL(7) = 2**3\nVARVAL(7)\n:derivative 1\n:time 2\nTIME**2\n:derivative\n";
    let (said, code) = session(typed, "language.txt");
    assert_eq!(
        (said.as_str(), code),
        (
            "1\n1\n5\n1: 3 4 12\n2: 0 0 12\n8\nvalue   4\nd/dt    4\n1\n",
            0
        )
    );
}

#[test]
fn help_at_the_prompt_is_the_card_of_functions() {
    let (said, code) = session(":help STEP5\n", "help.txt");
    assert_eq!((said, code), (cognate(&["functions", "STEP5"]).out, 0));
    let (said, _) = session(":help\n", "commands.txt");
    for command in [
        ":help",
        ":let",
        ":time",
        ":marker",
        ":plot",
        ":derivative",
        ":explain",
        ":quit",
    ] {
        assert!(said.contains(command), "{command}");
    }
}

// ----------------------------------------------------------------------------------------------- functions, explanations

#[test]
fn a_card_has_signature_equation_continuity_and_examples_in_text_and_json() {
    let card = cognate(&["functions", "step5"]).out;
    for text in [
        "STEP5(x, x0, h0, x1, h1)",
        "h0 + (h1 - h0) u^3",
        "continuity",
        "STEP5(1.25,1,0,2,1) = 0.103515625",
    ] {
        assert!(card.contains(text), "{text}\n{card}");
    }
    let cards = json_of(&cognate(&["functions", "STEP5", "--json"]).out);
    assert_eq!(cards.as_array().map(Vec::len), Some(1));
    assert_eq!(
        (&cards[0]["continuity"], &cards[0]["arguments"][4]["name"]),
        (&json!("c2"), &json!("h1"))
    );
    // a name of both languages has both cards
    assert_eq!(
        json_of(&cognate(&["functions", "sin", "--json"]).out)
            .as_array()
            .map(Vec::len),
        Some(2)
    );
    let all = json_of(&cognate(&["functions", "--json"]).out);
    assert!(all.as_array().unwrap().len() > 120);
    let done = cognate(&["functions", "FOO"]);
    assert!(
        done.code == 3 && done.out.is_empty() && done.err.contains("the language has no `FOO`")
    );
}

#[test]
fn a_card_says_what_each_argument_is_and_its_example_is_what_comes_out() {
    let card = cognate(&["functions", "POLY"]).out;
    for text in [
        "\n  x0          shift: value of x where the polynomial is a0\n",
        "\n  a0, …       coefficients, the constant first\n",
    ] {
        assert!(card.contains(text), "{text}\n{card}");
    }
    let card = cognate(&["explain", "JOINT"]).out;
    for text in [
        "number of a JOINT: element that is asked",
        "whole number, 0 to 1: 0 on the I marker, 1 on the J marker",
        "JOINT(7, 0, 2, 0) = x of the force of JOINT/7 on its I marker, in the axes of ground",
    ] {
        assert!(card.contains(text), "{text}\n{card}");
    }
    // the markers of the examples are a file for --markers
    let card = cognate(&["functions", "VX"]).out;
    let (before, markers) = card.split_once("for these --markers:\n").unwrap();
    let example = before
        .lines()
        .find(|l| l.contains("VX(1, 2, 3, 4) = "))
        .unwrap();
    let (call, value) = example.trim().split_once(" = ").unwrap();
    let file = scratch("card", "m.json", markers);
    assert_eq!(eval(&[call, "--markers", path(&file)]).trim(), value);
}

#[test]
fn codes_and_functions_are_explained_by_name() {
    let done = cognate(&["explain", "arity"]);
    assert!(
        done.code == 0 && done.out.starts_with("arity: ") && done.out.lines().count() > 3,
        "{}",
        done.out
    );
    let done = cognate(&["explain", "no_such_code"]);
    assert!(
        done.code == 3 && done.err.contains("cognate explain"),
        "{}",
        done.err
    );
    assert!(cognate(&["explain"]).out.lines().count() > 50);
}

#[test]
fn what_is_hardly_meant_is_said_beside_the_value() {
    let done = cognate(&["eval", "10*SIN(30)"]);
    assert_eq!((done.code, done.out.as_str()), (0, "-9.880316240928618\n"));
    assert!(done.err.contains("degrees_or_radians"), "{}", done.err);
    assert_eq!(eval(&["10*SIN(30D)"]), "4.999999999999999\n");
}
