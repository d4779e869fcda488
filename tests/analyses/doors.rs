//! Odd arguments at the doors of the library: whatever a caller passes, there is an answer or an error that names what is wrong; nothing panics.

use cognate::analysis::session::{Analysis, Options, Session};
use cognate::analysis::verify::verify;
use cognate::analysis::watch::Unwatched;
use cognate::expr::Expr;
use cognate::expr::interpolation::Bindings;
use cognate::expr::program::{Program, Work};
use cognate::internals::dataset::manual::examples;
use cognate::internals::dataset::row::Record;
use cognate::internals::dataset::statement::STATEMENTS;
use cognate::internals::dataset::value::{Number, Value};
use cognate::internals::time::output::Output;
use cognate::internals::verify::outline::outline;
use cognate::model::{Formula, Model};
use cognate::{Error, results::Status};

const ODD: [f64; 9] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    -1.0,
    -0.0,
    0.0,
    1e-300,
    1e308,
    5e-324,
];

const PENDULUM: &str = pendulum!(
    "SFORCE/3, ROTATION, I=21, J=1, FUNCTION=USER(7)
END
"
);

fn pendulum() -> Model {
    Model::from_text(PENDULUM).expect("a model")
}

fn few_steps() -> Options {
    Options {
        max_steps: Some(40),
        zero_user: true,
        ..Options::default()
    }
}

fn simulated(
    model: Model,
    options: Options,
    analysis: Analysis,
    end: f64,
) -> Result<Status, Error> {
    Session::new(model, "odd", options).simulate(analysis, end, 2, &mut Unwatched)
}

/// The code and the element of the first mistake.
fn about<T: std::fmt::Debug>(outcome: Result<T, Error>) -> (&'static str, String) {
    let error = outcome.expect_err("a mistake");
    let first = error.first();
    (first.code, first.element.clone().unwrap_or_default())
}

#[test]
fn times_that_are_none_are_refused() {
    let wrong = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0];
    let over_time = [
        Analysis::Kinematic,
        Analysis::Dynamic,
        Analysis::Static,
        Analysis::Transient,
    ];
    for analysis in over_time {
        for end in wrong {
            let found = about(simulated(pendulum(), few_steps(), analysis, end));
            assert_eq!(found.0, "no_end", "{analysis:?} to {end}");
        }
    }
    for distance in wrong.into_iter().chain([0.0]) {
        let mut s = Session::new(pendulum(), "odd", few_steps());
        let output = Output::Every(distance);
        let found = s.simulate_with(Analysis::Dynamic, 1.0, output, &mut Unwatched);
        assert_eq!(about(found).0, "unfit_value", "{distance}");
    }
    let mut s = Session::new(pendulum(), "odd", few_steps());
    let found = s.simulate(Analysis::Dynamic, 1.0, usize::MAX, &mut Unwatched);
    assert_eq!(about(found).0, "unfit_value");
    assert_eq!(s.run.rows(), 0);
}

#[test]
fn a_clock_does_not_go_back() {
    let mut s = Session::new(pendulum(), "odd", few_steps());
    let mut go = |end| s.simulate(Analysis::Dynamic, end, 1, &mut Unwatched);
    assert_eq!(go(0.01), Ok(Status::Completed));
    let error = go(0.005).expect_err("the past");
    let message = "the simulation should end at 0.005, but the clock shows 0.01";
    assert_eq!(error.first().message, message);
    assert_eq!(go(0.02), Ok(Status::Completed));
}

#[test]
fn a_model_of_nothing_is_refused_by_every_door() {
    for analysis in [
        Analysis::Dynamic,
        Analysis::Static,
        Analysis::InitialConditions,
    ] {
        let found = about(simulated(Model::default(), few_steps(), analysis, 1.0));
        assert_eq!(found.0, "no_ground");
    }
    assert_eq!(about(verify(&Model::default())).0, "no_ground");
    assert_eq!(about(outline(&Model::default()).map(|_| ())).0, "no_ground");
}

#[test]
fn a_mass_that_is_no_number_is_named() {
    for mass in [f64::NAN, f64::INFINITY] {
        let mut model = pendulum();
        model.parts.get_mut(&2).expect("a part").mass = mass;
        let found = simulated(model, few_steps(), Analysis::Dynamic, 1.0).expect_err("no number");
        let message = format!("PART/2: error[unfit_value]: MASS is {mass}");
        assert_eq!(found.to_string(), message);
    }
}

/// The same value with its first number replaced; `None`: it has no number.
fn with(value: &Value, x: f64) -> Option<Value> {
    match value {
        Value::Real(_) => Some(Value::Real(Number::plain(x))),
        Value::Reals(all) if !all.is_empty() => {
            let mut all = all.clone();
            all[0] = Number::plain(x);
            Some(Value::Reals(all))
        }
        Value::Formula(Formula::User { routine, .. }) => Some(Value::Formula(Formula::User {
            constants: vec![x],
            routine: routine.clone(),
        })),
        _ => None,
    }
}

/// Every number of the statements of the manual's models, one at a time replaced by `x`: the model,
/// the element and the keyword.
fn models_with(x: f64, mut look: impl FnMut(&Model, &Record, &str)) {
    for example in examples() {
        let model = Model::from_text(example.dataset).expect("a model of the manual");
        for record in STATEMENTS.iter().flat_map(|row| row.records(&model)) {
            for given in &record.given {
                let Some(value) = with(&given.value, x) else {
                    continue;
                };
                let mut changed = given.clone();
                changed.value = value;
                let change = Record {
                    given: vec![changed],
                    ..record.clone()
                };
                let mut other = model.clone();
                if record.row.enter(&mut other, &change, true).is_empty() {
                    let keyword = record.row.arguments()[given.argument].keyword();
                    look(&other, &record, &keyword);
                }
            }
        }
    }
}

#[test]
fn every_number_of_every_statement_must_be_finite() {
    let mut count = 0;
    for x in [f64::NAN, f64::INFINITY] {
        models_with(x, |model, record, keyword| {
            let found = model.check();
            let names = |d: &cognate::diagnostic::Diagnostic| {
                d.element.as_deref() == Some(&record.element()) && d.message.starts_with(keyword)
            };
            let element = record.element();
            assert!(
                found.iter().any(names),
                "{element} {keyword} = {x}: {found:?}"
            );
            count += 1;
        });
    }
    assert!(count > 300, "{count} numbers");
}

#[test]
fn numbers_that_no_body_has_end_in_a_status_or_an_error() {
    let numbers = |model: &Model, change: &dyn Fn(&mut Model)| {
        let mut model = model.clone();
        change(&mut model);
        // panics fail the test; what comes out is another test's matter
        drop(simulated(model, few_steps(), Analysis::Dynamic, 0.01));
    };
    let model = pendulum();
    for x in ODD {
        numbers(&model, &|m| m.parts.entry(2).or_default().mass = x);
        numbers(&model, &|m| m.parts.entry(2).or_default().ip = [x; 6]);
        numbers(&model, &|m| m.parts.entry(2).or_default().qg = [x; 3]);
        numbers(&model, &|m| m.markers.entry(21).or_default().qp = [x; 3]);
        numbers(&model, &|m| m.gravity = [x; 3]);
    }
    for number in [0, 1, 99, u32::MAX] {
        numbers(&model, &|m| m.parts.entry(2).or_default().cm = Some(number));
        numbers(&model, &|m| m.joints.entry(1).or_default().i = number);
        numbers(&model, &|m| m.joints.entry(number).or_default().j = number);
        numbers(&model, &|m| {
            m.markers.entry(number).or_default().floating = true
        });
    }
}

#[test]
fn options_that_cannot_be_kept_are_named() {
    let go = |options: Options| about(simulated(pendulum(), options, Analysis::Dynamic, 0.01));
    for error in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        let options = Options {
            error: Some(error),
            ..few_steps()
        };
        assert_eq!(go(options).0, "unfit_value", "{error}");
    }
    let limit = Some(f64::NAN);
    assert_eq!(
        go(Options {
            limit,
            ..few_steps()
        })
        .0,
        "unfit_value"
    );
    let method = Some("EULER".to_string());
    assert_eq!(
        go(Options {
            method,
            ..few_steps()
        })
        .0,
        "method"
    );
    for column in ["", "DX(", "DX(99,1)", "NOPE(1)", "TIME TIME"] {
        let columns = vec![column.to_string()];
        let found = go(Options {
            columns,
            ..few_steps()
        });
        assert!(!found.0.is_empty(), "{column}");
    }
}

#[test]
fn all_that_is_wrong_with_a_call_is_told_at_once() {
    let options = Options {
        error: Some(f64::NAN),
        method: Some("EULER".into()),
        ..few_steps()
    };
    let error =
        simulated(pendulum(), options, Analysis::Dynamic, -1.0).expect_err("three mistakes");
    let codes: Vec<_> = error.diagnostics().iter().map(|d| d.code).collect();
    assert_eq!(codes, ["method", "unfit_value", "no_end"]);
}

#[test]
fn a_closure_under_a_misspelt_name_is_refused_with_the_name_that_is_near() {
    let go = |name: &str| {
        let mut s = Session::new(pendulum(), "odd", Options::default());
        s.register(name, &[], |_, out| out[0] = -1.0);
        s.simulate(Analysis::Dynamic, 0.01, 1, &mut Unwatched)
    };
    for name in ["SFORCE/3", "sforce/3", "7"] {
        assert_eq!(go(name), Ok(Status::Completed), "{name}");
    }
    let error = go("SFORSE/3").expect_err("no such element");
    assert!(error.to_string().contains("SFORSE/3"), "{error}");
    assert_eq!(error.first().help, ["did you mean SFORCE/3?"]);
    for name in ["", "JOINT/1", "8", "NaN"] {
        assert_eq!(about(go(name)).0, "user_routine", "{name}");
    }
}

#[test]
fn of_several_closures_for_a_user_the_last_counts() {
    let go = |names: &[&str]| {
        let mut s = Session::new(pendulum(), "odd", Options::default());
        s.add_column("SFORCE(3, 0, 8, 1)").expect("a column");
        for (k, name) in names.iter().enumerate() {
            let force = -(k as f64) - 1.0;
            s.register(name, &[], move |_, out| out[0] = force);
        }
        let done = s.simulate(Analysis::Dynamic, 0.01, 1, &mut Unwatched);
        assert_eq!(done, Ok(Status::Completed), "{names:?}");
        let force = s.run.column("SFORCE(3, 0, 8, 1)");
        force.and_then(|f| f.last().copied()).expect("a row").abs()
    };
    for last in ["SFORCE/3", "sforce/3", "7"] {
        assert_eq!(go(&[last]), 1.0);
        assert_eq!(go(&["SFORCE/3", last]), 2.0, "{last}");
        assert_eq!(go(&["7", "sforce/3", last]), 3.0, "{last}");
    }
    // also where the one before was sound
    let mut s = Session::new(pendulum(), "odd", Options::default());
    s.register("SFORCE/3", &[], |_, out| out[0] = -1.0);
    s.register("SFORCE/3", &["WZZ(1,2)"], |_, out| out[0] = -1.0);
    let found = s.simulate(Analysis::Dynamic, 0.01, 1, &mut Unwatched);
    assert_eq!(about(found).0, "unknown_name");
}

fn program() -> Program {
    let expr = Expr::parse("TIME*DX(1, 2)").expect("an expression");
    expr.compile(&Bindings::default()).expect("a program")
}

#[test]
fn too_few_numbers_are_counted_and_never_read() {
    let (program, mut work) = (program(), Work::default());
    let all = [2.0, 3.0];
    // some of these runs are code of the processor
    for k in 0..3000 {
        let (given, mut out) = (&all[..k % 3], [0.0; 2]);
        program.run(given, &mut work, &mut out);
        assert_eq!(out[0].is_nan(), given.len() < 2, "{out:?}");
        assert!(out[1].is_nan(), "the program has one output");
        assert_eq!(program.value(given, &mut work).is_nan(), given.len() < 2);
        let checked = program.run_checked(given, &mut work, &mut out[..1]);
        assert_eq!(checked.is_err(), given.len() < 2);
    }
    let found = program
        .run_checked(&[], &mut work, &mut [0.0; 3])
        .expect_err("two mistakes");
    assert_eq!(found.diagnostics().len(), 2);
    let infinite = program.run_checked(&[1e300, 1e300], &mut work, &mut [0.0]);
    assert_eq!(about(infinite).0, "domain");
}

#[test]
fn columns_that_are_too_short_are_refused() {
    let mut batch = program().batch();
    let (long, short) = ([1.0; 9], [1.0; 8]);
    let mut out = [0.0; 9];
    assert_eq!(batch.run(&[&long, &long], &mut [&mut out]), Ok(()));
    for columns in [&[&long[..], &short[..]][..], &[&long[..]], &[]] {
        let found = about(batch.run(columns, &mut [&mut out]));
        assert_eq!(found.0, "missing_value");
    }
    let (mut one, mut two) = ([0.0; 2], [0.0; 2]);
    let found = batch.run(&[&long, &long], &mut [&mut one, &mut two]);
    assert_eq!(about(found).0, "unfit_value");
}

#[test]
fn inputs_under_odd_names_are_refused() {
    let f = Expr::parse("TIME + DX(1, 2)").expect("an expression");
    for name in [
        "",
        "TIME TIME",
        "DX(",
        "DX(1,2)+1",
        "STEP",
        "\u{1F980}",
        "DX(0x1)",
    ] {
        assert!(f.eval(&[(name, 1.0)]).is_err(), "{name}");
    }
    assert_eq!(about(f.eval(&[("TIME", 1.0)])).0, "missing_value");
    for x in [f64::NAN, f64::INFINITY] {
        assert_eq!(about(f.eval(&[("TIME", x), ("DX(1,2)", 0.0)])).0, "domain");
    }
}

#[test]
fn a_session_and_what_it_is_made_of_go_to_other_threads() {
    fn goes<T: Send>() {}
    fn is_shared<T: Send + Sync>() {}
    goes::<Session>();
    is_shared::<Model>();
    is_shared::<Expr>();
    is_shared::<Program>();
    is_shared::<Error>();
}

#[test]
fn results_of_which_a_caller_has_taken_something_are_told_and_written_without_a_panic() {
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("taken");
    std::fs::create_dir_all(&folder).expect("a folder");
    type Take = fn(&mut cognate::results::Run);
    let takes: [(&str, Take); 5] = [
        ("all columns", |run| run.columns.clear()),
        ("a column", |run| drop(run.columns.pop())),
        ("values", |run| run.columns[1].values.clear()),
        ("times", |run| run.columns[0].values.clear()),
        ("the last value", |run| {
            let all = run.columns[1].values.len();
            run.columns[1].values.truncate(all - 1);
        }),
    ];
    for (what, take) in takes {
        let options = Options {
            columns: vec!["AZ(21,1)".into()],
            ..few_steps()
        };
        let mut session = Session::new(pendulum(), "taken", options);
        let done = session.simulate(Analysis::Dynamic, 0.1, 4, &mut Unwatched);
        assert_eq!(done, Ok(Status::Completed));
        take(&mut session.run);
        for row in cognate::results::format::FORMATS {
            let path = folder.join(format!("taken.{}", row.name));
            // written with gaps, or refused
            let _ = cognate::results::write(&session.run, &path, Default::default());
        }
        let goes_on = session.simulate(Analysis::Dynamic, 0.2, 4, &mut Unwatched);
        // with one column less there is a table still
        if what != "a column" {
            assert_eq!(about(goes_on).0, "unfit_value", "{what}");
        }
    }
}
