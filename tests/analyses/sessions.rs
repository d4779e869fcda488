//! Sessions as programs use them: results do not depend on when a column is named, whether rows are streamed or kept, or on which thread and how often a session has run before.

use crate::running::{Analysis, Options, Session, begin, whole};

use cognate::Error;
use cognate::diagnostic::Severity;
use cognate::internals::dataset::manual::example;
use cognate::model::Formula;
use cognate::results::Status;
use std::sync::mpsc::channel;

const COLUMNS: [&str; 3] = ["AZ(21,1)", "WZ(21,1)", "FX(21,1)"];

/// A pendulum in three dimensions with a number that a program changes, switches and a motion that ends.
const PENDULUM: &str = pendulum!(
    "VARIABLE/3, FUNCTION=0.2
SFORCE/3, ROTATION, I=21, J=1, FUNCTION=-VARVAL(3)*WZ(21,1)-IF(AZ(21,1)+1:5*AZ(21,1)+5,0,0)
SENSOR/1, FUNCTION=AZ(21,1)\\, VALUE=-0.5, LE, EVALUATE=TIME
END
"
);

fn session(options: Options) -> Session {
    begin(whole(PENDULUM), "pendulum", options)
}

fn with_columns() -> Options {
    Options {
        columns: COLUMNS.map(String::from).to_vec(),
        ..Options::default()
    }
}

fn go(s: &mut Session, end: f64) {
    let done = s.run_to(Analysis::Dynamic, end, 20);
    assert_eq!(done, Ok(Status::Completed));
}

/// All values of the columns, by their bits.
fn bits(s: &Session) -> Vec<Vec<u64>> {
    let column = |name: &str| s.run.column(name).expect("a column").iter();
    COLUMNS
        .map(|name| column(name).map(|x| x.to_bits()).collect())
        .to_vec()
}

fn expected(end: f64) -> Vec<Vec<u64>> {
    let mut s = session(with_columns());
    go(&mut s, end);
    bits(&s)
}

#[test]
fn columns_named_before_or_after_hold_the_same_bits() {
    let mut before = session(Options::default());
    for column in COLUMNS {
        before.add_column(column).expect("an expression");
    }
    let mut after = session(Options {
        keep_states: true,
        ..Options::default()
    });
    for s in [&mut before, &mut after] {
        assert_eq!(s.run_to(Analysis::Static, 0.0, 1), Ok(Status::Completed));
        go(s, 1.0);
        go(s, 1.5);
    }
    for column in COLUMNS {
        after.add_column(column).expect("an expression");
        after.add_column(column).expect("it is there already");
    }
    for s in [&mut before, &mut after] {
        go(s, 2.0);
    }
    assert_eq!(bits(&after), bits(&before));
    assert_eq!(after.run.table, before.run.table);
}

fn refused(outcome: Result<(), Error>) -> &'static str {
    outcome.expect_err("a mistake").code()
}

#[test]
fn a_late_column_that_cannot_be_computed_is_refused_and_changes_nothing() {
    let mut s = session(with_columns());
    go(&mut s, 0.5);
    assert_eq!(refused(s.add_column("DX(20)")), "late_column");
    let keep_states = true;
    let mut s = session(Options {
        keep_states,
        ..with_columns()
    });
    go(&mut s, 0.5);
    let n = s.run.columns.len();
    assert_eq!(
        refused(s.add_column("DELAY(DX(20), 0.1, 0)")),
        "late_column"
    );
    assert_eq!(refused(s.add_column("DX(99)")), "unsupported");
    assert_eq!(refused(s.add_column("DX(")), "unexpected_end");
    s.model.gravity = [0.0; 3];
    assert_eq!(refused(s.add_column("DX(20)")), "late_column");
    assert_eq!(s.run.columns.len(), n);
    go(&mut s, 1.0);
}

#[test]
fn streamed_rows_are_the_rows_of_a_run() {
    let mut kept = session(with_columns());
    let mut streamed = session(with_columns());
    let (sender, rows) = channel();
    streamed.stream(move |row| drop(sender.send(row.to_vec())));
    for s in [&mut kept, &mut streamed] {
        go(s, 1.0);
        go(s, 1.5);
    }
    let rows: Vec<Vec<f64>> = rows.try_iter().collect();
    assert_eq!(rows.len(), kept.run.rows());
    assert!(streamed.run.held().is_empty());
    for (k, column) in kept.run.columns.iter().enumerate() {
        let of_rows: Vec<f64> = rows.iter().map(|row| row[k]).collect();
        assert_eq!(of_rows, column.values, "{}", column.name);
    }
}

#[test]
fn a_session_that_is_reset_runs_again_to_the_last_bit() {
    let first = expected(1.5);
    for keep_start in [false, true] {
        let mut s = session(Options {
            keep_start,
            ..with_columns()
        });
        for _ in 0..3 {
            go(&mut s, 1.5);
            assert_eq!(bits(&s), first);
            s.reset();
            assert_eq!((s.time(), s.run.rows()), (0.0, 0));
        }
    }
}

fn number(s: &mut Session, x: f64) {
    let variable = s.model.variables.get_mut(&3).expect("the variable");
    variable.function = Formula::text(x.to_string());
}

#[test]
fn a_number_that_is_changed_between_runs_does_what_a_new_session_would() {
    let keep_start = true;
    let mut again = session(Options {
        keep_start,
        ..with_columns()
    });
    again.will_change([3]);
    for x in [0.1, 3.0, 0.2] {
        let mut new = session(with_columns());
        new.will_change([3]);
        again.reset();
        for s in [&mut again, &mut new] {
            number(s, x);
            go(s, 1.5);
        }
        assert_eq!(bits(&again), bits(&new), "{x}");
        let compiled = again.run.record.seconds.compile;
        assert_eq!(compiled > 0.0, x == 0.1, "the first run alone is compiled");
    }
    // another model is compiled anew
    again.reset();
    again.model.gravity = [0.0; 3];
    go(&mut again, 1.5);
    assert!(again.run.record.seconds.compile > 0.0);
}

#[test]
fn models_of_the_manual_run_again_to_the_last_bit() {
    for name in ["slider_crank", "control", "gears", "contact"] {
        let text = example(name).expect("a model").dataset;
        let options = || Options {
            full: true,
            keep_start: true,
            ..Options::default()
        };
        let mut s = begin(whole(text), name, options());
        let mut runs = Vec::new();
        for _ in 0..2 {
            s.reset();
            let done = s.run_to(Analysis::Transient, 0.05, 10);
            assert_eq!(done, Ok(Status::Completed), "{name}");
            let all = s
                .run
                .columns
                .iter()
                .map(|c| c.values.iter().map(|x| x.to_bits()));
            runs.push(all.map(Iterator::collect).collect::<Vec<Vec<u64>>>());
        }
        assert_eq!(runs[0], runs[1], "{name}");
    }
}

#[test]
fn a_state_is_taken_changed_and_gone_on_from() {
    let mut s = session(with_columns());
    assert_eq!(s.state().values().count(), 0);
    go(&mut s, 1.0);
    let there = s.state();
    go(&mut s, 1.5);
    let on = bits(&s).map_last();
    assert_eq!(there.time(), 1.0);
    s.set_state(&there).expect("the same model");
    go(&mut s, 1.5);
    assert_eq!(bits(&s).map_last(), on);
    // another speed
    let mut other = there.clone();
    let (name, speed) = other.values().last().expect("unknowns");
    other.set(&name, speed + 1.0).expect("a known name");
    assert_eq!(other.value(&name), Some(speed + 1.0));
    s.set_state(&other).expect("the same model");
    go(&mut s, 1.5);
    assert_ne!(bits(&s).map_last(), on);
    assert_eq!(refused(other.set("nobody", 1.0)), "unknown_name");
    assert_eq!(refused(other.set(&name, f64::NAN)), "unfit_value");
    let part = there.part(2).expect("the part");
    assert!((part.p_GM.norm()) < 1e-9 && part.w_GM.norm() > 0.0);
    assert!(there.part(3).is_none());
}

/// A mass on a guide; spring, damping and force are numbers that a program changes.
const GUIDED: &str = "
PART/1, GROUND
MARKER/1, PART=1
PART/2, MASS=1, CM=20, IP=1,1,1
MARKER/20, PART=2
JOINT/1, TRANSLATIONAL, I=20, J=1
VARIABLE/1, FUNCTION=0
VARIABLE/2, FUNCTION=0
VARIABLE/3, FUNCTION=0
SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=20, J=1
, FUNCTION=VARVAL(3)-VARVAL(1)*DZ(20,1)-VARVAL(2)*VZ(20,1)
INTEGRATOR/GSTIFF, HINIT=1E-6
END
";

/// Duration of a piece of a simulation of [`GUIDED`].
const PIECE: f64 = 0.05;

/// Goes on by pieces with other numbers each; returns place and velocity behind each piece.
fn in_pieces(method: &str, pieces: &[[f64; 3]]) -> (Session, Vec<[f64; 2]>) {
    let options = Options {
        method: Some(method.into()),
        error: Some(1e-6),
        columns: vec!["DZ(20,1)".into(), "VZ(20,1)".into()],
        ..Options::default()
    };
    let mut s = begin(whole(&format!("\n{GUIDED}")), "guided", options);
    s.will_change([1, 2, 3]);
    let mut ends = Vec::new();
    for (k, numbers) in (1..).zip(pieces) {
        for (id, x) in (1..).zip(numbers) {
            let variable = s.model.variables.get_mut(&id).expect("the variable");
            variable.function = Formula::text(x.to_string());
        }
        let done = s.run_to(Analysis::Dynamic, PIECE * f64::from(k), 1);
        assert_eq!(done, Ok(Status::Completed));
        let last = |name: &str| *(s.run.column(name).expect("a column").last()).expect("a row");
        ends.push([last("DZ(20,1)"), last("VZ(20,1)")]);
    }
    (s, ends)
}

/// Returns place and velocity of the mass a piece later: powers of the solution over a short time.
fn exact([x, v]: [f64; 2], [spring, damping, force]: [f64; 3]) -> [f64; 2] {
    let halvings = 40;
    let h = PIECE / f64::powi(2.0, halvings);
    let product = |a: [[f64; 3]; 3], b: [[f64; 3]; 3]| {
        let entry = |i: usize, j: usize| (0..3).map(|k| a[i][k] * b[k][j]).sum::<f64>();
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
    };
    // what is left when the identity is taken away, so that nothing is rounded off
    let rate = [
        [0.0, h, 0.0],
        [-spring * h, -damping * h, force * h],
        [0.0; 3],
    ];
    let square = product(rate, rate);
    let mut change = [0, 1, 2].map(|i| [0, 1, 2].map(|j| rate[i][j] + 0.5 * square[i][j]));
    for _ in 0..halvings {
        let square = product(change, change);
        change = [0, 1, 2].map(|i| [0, 1, 2].map(|j| 2.0 * change[i][j] + square[i][j]));
    }
    let moved = |i: usize| change[i][0] * x + change[i][1] * v + change[i][2];
    [x + moved(0), v + moved(1)]
}

#[test]
fn pieces_whose_stiffness_jumps_are_as_exact_as_asked_for() {
    let kinds = [
        [0.0, 0.0, 3.0],
        [1e8, 1e5, 3.0],
        [0.0, 0.0, -2.0],
        [100.0, 0.5, 5.0],
        [0.0, 1e5, 1.0],
        [0.0, 0.0, 1.0],
        [1e4, 300.0, 0.0],
    ];
    // each behind each other
    let n = kinds.len();
    let pieces: Vec<[f64; 3]> = (0..n * n)
        .map(|k| kinds[(k % n) * (k / n + 1) % n])
        .collect();
    for method in ["RADAU5", "DOP853", "AUTO"] {
        let (_, ends) = in_pieces(method, &pieces);
        let (mut state, mut largest) = ([0.0; 2], [1e-3_f64; 2]);
        for (numbers, end) in pieces.iter().zip(&ends) {
            let expected = exact(state, *numbers);
            for k in 0..2 {
                largest[k] = largest[k].max(expected[k].abs());
                let off = (end[k] - expected[k]).abs();
                assert!(
                    off < 1e-4 * largest[k],
                    "{method} {numbers:?}: {off} of {largest:?}"
                );
            }
            // from where it is, so that errors do not add up
            state = *end;
        }
    }
}

#[test]
fn a_simulation_that_goes_on_does_so_with_the_step_of_the_one_before() {
    let pieces: Vec<[f64; 3]> = (0..40)
        .map(|k| [0.5, 0.1, 1.0 + 0.1 * f64::from(k % 5)])
        .collect();
    for method in ["RADAU5", "DOP853"] {
        let (s, _) = in_pieces(method, &pieces);
        let counts = s.run.record.counts;
        assert!(counts.steps < 100, "{method}: {}", counts.steps);
        if method == "RADAU5" {
            assert!(counts.jacobians < 10, "{}", counts.jacobians);
        }
    }
}

/// The last value of each column.
trait Last {
    fn map_last(self) -> Vec<u64>;
}

impl Last for Vec<Vec<u64>> {
    fn map_last(self) -> Vec<u64> {
        self.iter().map(|c| *c.last().expect("rows")).collect()
    }
}

#[test]
fn a_session_goes_to_another_thread_and_back() {
    let mut s = session(with_columns());
    go(&mut s, 0.7);
    let mut s = std::thread::spawn(move || {
        go(&mut s, 1.0);
        s
    })
    .join()
    .expect("the thread");
    go(&mut s, 1.5);
    let mut alone = session(with_columns());
    for end in [0.7, 1.0, 1.5] {
        go(&mut alone, end);
    }
    assert_eq!(bits(&s), bits(&alone));
}

/// Each simulation is too short to be worth a change of the method: together they are not.
#[test]
fn a_replay_of_short_simulations_takes_the_method_of_a_long_one() {
    let text = include_str!("../data/references/stiff_bushing.adm");
    let run = |simulations: u32| {
        let options = Options {
            columns: vec!["DX(2,1)".to_string()],
            error: Some(1e-4),
            ..Options::default()
        };
        let mut s = begin(whole(text), "stiff", options);
        for k in 1..=simulations {
            let end = 0.4 * f64::from(k) / f64::from(simulations);
            assert_eq!(s.run_to(Analysis::Dynamic, end, 1), Ok(Status::Completed));
        }
        s
    };
    let (short, long) = (run(200), run(1));
    let last = |s: &Session| s.run.column("DX(2,1)").and_then(|x| x.last().copied());
    let [a, b] = [&short, &long].map(|s| last(s).expect("a place"));
    assert!((a - b).abs() < 1e-6, "{a} {b}");
    assert_eq!(long.run.record.simulations[0].method, "RADAU5");
    let simulations = &short.run.record.simulations;
    assert_eq!(simulations[0].method, "DOP853");
    assert_eq!(simulations[199].method, "RADAU5");
}

/// Names of methods of other programs are those of ours that do their work, to the bit.
#[test]
fn names_of_other_programs_are_done_by_our_methods() {
    let by = |method: &str| {
        let mut s = session(Options {
            method: Some(method.into()),
            ..with_columns()
        });
        go(&mut s, 2.0);
        assert!(s.run.record.warnings.is_empty(), "{method}");
        bits(&s)
    };
    let implicit = by("RADAU5");
    for name in [
        "GSTIFF",
        "WSTIFF",
        "HASTIFF",
        "CONSTANT_BDF",
        "HHT",
        "newmark",
        "BDF",
    ] {
        assert_eq!(by(name), implicit, "{name}");
    }
    let explicit = by("DOP853");
    assert_ne!(explicit, implicit);
    for name in ["ABAM", "RKF45"] {
        assert_eq!(by(name), explicit, "{name}");
    }
}

/// Where a method of another order is named, a note says who does its work.
#[test]
fn a_method_of_order_two_is_said_to_be_done_by_ours() {
    let noted = |settings: &str| {
        let text = PENDULUM.replace("END\n", &format!("{settings}\nEND\n"));
        let found = whole(&text).check();
        found
            .iter()
            .map(|d| (d.severity, d.message.clone()))
            .collect::<Vec<_>>()
    };
    for (settings, word) in [
        ("INTEGRATOR/HHT", "HHT is done by RADAU5"),
        ("INTEGRATOR/NEWMARK", "NEWMARK is done by RADAU5"),
        ("INTEGRATOR/GSTIFF, KMAX=3", "KMAX = 3 changes nothing"),
    ] {
        let notes = noted(settings);
        assert!(
            matches!(&notes[..], [(Severity::Note, what)] if what.contains(word)),
            "{settings}: {notes:?}"
        );
    }
    assert_eq!(noted("INTEGRATOR/GSTIFF, SI2"), []);
}
