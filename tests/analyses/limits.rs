//! Limits of work: a run always ends, with what it has so far, and says where it was.

use crate::running::{Analysis, Options, Session, begin, model, values};
use cognate::analysis::session::Accuracy;
use cognate::analysis::watch::{Unwatched, Watch};
use cognate::results::Status;
use std::time::{Duration, Instant};

/// A limit that is short beside what these models would take, in s.
const LIMIT: f64 = 0.3;
/// Time in which a run of that limit must have ended on a machine that does much else.
const PATIENCE: Duration = Duration::from_secs(60);

/// A pendulum that swings for ever.
const PENDULUM: &str = "ACCGRAV/JGRAV=-9.81\nPART/2, MASS=1, CM=2, IP=1,1,1\n\
    MARKER/2, PART=2, QP=1,0,0\nMARKER/3, PART=2\nJOINT/1, REVOLUTE, I=3, J=1\n";

fn limited(text: &str, method: &str, limit: f64) -> Session {
    let options = Options {
        method: Some(method.to_string()),
        error: Some(1e-6),
        columns: vec!["TIME".into()],
        limit: Some(limit),
        max_steps: Some(usize::MAX),
        ..Options::default()
    };
    begin(model(text), "limited", options)
}

#[test]
fn every_method_ends_at_its_limit_with_the_rows_so_far() {
    for method in ["AUTO", "DOP853", "RADAU5"] {
        let clock = Instant::now();
        let mut session = limited(PENDULUM, method, LIMIT);
        let status = session.simulate(Analysis::Dynamic, 1e7, 1_000_000_000, &mut Unwatched);
        assert!(status.is_err(), "so many outputs are refused");
        let status = session.simulate(Analysis::Dynamic, 1e7, 1_000_000, &mut Unwatched);
        assert_eq!(status.expect("a run"), Status::Limit, "{method}");
        assert!(clock.elapsed() < PATIENCE, "{method}");
        let record = &session.run.record;
        assert_eq!(record.stop_code, "work_limit");
        let simulation = record.simulations.last().expect("a simulation");
        assert!(simulation.end > 0.0, "{method}: {}", record.stop_reason);
        assert!(values(&session, "time").len() > 1, "{method}");
        let says = [
            "0.3 s of processor time",
            "at time ",
            "of 10000000",
            "steps",
        ];
        for word in says {
            assert!(
                record.stop_reason.contains(word),
                "{method}: {}",
                record.stop_reason
            );
        }
    }
}

/// A caller who ends a run at its so many-th look.
struct Impatient {
    looks: u64,
    most: u64,
}

impl Watch for Impatient {
    fn interrupted(&mut self) -> bool {
        self.looks += 1;
        self.looks >= self.most
    }
}

#[test]
fn every_method_lets_its_caller_look_after_a_few_evaluations_of_a_large_model() {
    const LINKS: usize = 40;
    // some twenty of them while it is set up
    const LOOKS: u64 = 45;
    const MOST_EVALUATIONS_PER_LOOK: u64 = 60;
    let mut chain = String::from("ACCGRAV/JGRAV=-9.81\n");
    for k in 2..2 + LINKS {
        let (own, end, x) = (10 * k, 10 * k + 1, k - 2);
        let before = if k == 2 { 1 } else { own - 9 };
        chain += &format!(
            "PART/{k}, MASS=1, CM={own}, IP=0.1,0.1,0.1, QG={x},0,0\nMARKER/{own}, PART={k}\n\
             MARKER/{end}, PART={k}, QP=1,0,0\nJOINT/{k}, REVOLUTE, I={own}, J={before}\n"
        );
    }
    for method in ["AUTO", "DOP853", "RADAU5"] {
        for (error, accuracy) in [
            (1e-3, Accuracy::Unknown),
            (1e-9, Accuracy::Digits),
            (1e-6, Accuracy::Bars),
        ] {
            let options = Options {
                method: Some(method.to_string()),
                error: Some(error),
                accuracy,
                ..Options::default()
            };
            let mut session = begin(model(&chain), "chain", options);
            let mut watch = Impatient {
                looks: 0,
                most: LOOKS,
            };
            let status = session.simulate(Analysis::Dynamic, 10.0, 10, &mut watch);
            assert_eq!(status.expect("a run"), Status::Interrupted, "{method}");
            let counts = session.run.record.counts;
            let evaluations = counts.evaluations + counts.jacobians + counts.factorizations;
            assert!(
                evaluations < MOST_EVALUATIONS_PER_LOOK * watch.looks,
                "{method}: {counts:?}"
            );
        }
    }
}

#[test]
fn a_limit_names_stiffness_where_it_makes_steps_short() {
    let stiff = "DIFF/1, IC=1, FUNCTION=-1E7*(DIF(1)-COS(TIME))\n";
    let mut session = limited(stiff, "DOP853", LIMIT);
    let status = session.simulate(Analysis::Dynamic, 1e6, 10, &mut Unwatched);
    assert_eq!(status.expect("a run"), Status::Limit);
    let reason = &session.run.record.stop_reason;
    for word in ["stability limited", "RADAU5", "DIFF/1"] {
        assert!(reason.contains(word), "{reason}");
    }
}

#[test]
fn a_limit_holds_while_setting_up_in_kinematics_and_at_rest() {
    let driven = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nMARKER/3, PART=2\n\
        JOINT/1, REVOLUTE, I=3, J=1\nMOTION/1, JOINT=1, ROTATION, FUNCTION=SIN(1000*TIME)\n";
    let cases = [
        (driven, Analysis::Kinematic, 1e6, 0.01, "KINEMATIC"),
        (PENDULUM, Analysis::Static, 1e6, LIMIT, "equilibrium"),
        (PENDULUM, Analysis::Dynamic, 1.0, 1e-12, "had not begun"),
        (PENDULUM, Analysis::Static, 0.0, 1e-12, "had not begun"),
    ];
    for (text, analysis, end, limit, word) in cases {
        let clock = Instant::now();
        let mut session = limited(text, "AUTO", limit);
        let status = session.simulate(analysis, end, 1_000_000, &mut Unwatched);
        assert_eq!(status.expect("a run"), Status::Limit, "{analysis:?}");
        assert!(clock.elapsed() < PATIENCE, "{analysis:?}");
        let reason = &session.run.record.stop_reason;
        assert!(reason.contains(word), "{analysis:?}: {reason}");
    }
}

#[test]
fn a_limit_that_is_not_reached_changes_no_bit() {
    let run = |limit| {
        let options = Options {
            columns: vec!["DX(2,1)".into()],
            limit,
            ..Options::default()
        };
        let mut session = begin(model(PENDULUM), "limited", options);
        let status = session.simulate(Analysis::Dynamic, 1.0, 10, &mut Unwatched);
        assert_eq!(status.expect("a run"), Status::Completed);
        values(&session, "DX(2,1)").to_vec()
    };
    assert_eq!(run(None), run(Some(3600.0)));
}

#[test]
fn a_set_up_that_is_interrupted_keeps_the_rows_of_the_simulation_before() {
    const PENDULUM: &str = "PART/2, MASS=2, CM=20, IP=1,1,1\nMARKER/20, PART=2, QP=1,0,0\nMARKER/21, PART=2\n\
                            JOINT/1, REVOLUTE, I=21, J=1\nACCGRAV/JGRAV=-9.81\nVARIABLE/1, FUNCTION=0\n";
    let mut session = begin(model(PENDULUM), "pendulum", Options::default());
    let mut watch = Impatient {
        looks: 0,
        most: u64::MAX,
    };
    let first = session.simulate(Analysis::Dynamic, 1.0, 10, &mut watch);
    assert_eq!(first.expect("a run"), Status::Completed);
    let (rows, looks) = (session.run.rows(), watch.looks);
    // another model, which is compiled, assembled and recorded: the caller is asked on the way
    session.model.parts.get_mut(&2).expect("a part").mass = 3.0;
    watch.most = looks + 2;
    let second = session.simulate(Analysis::Dynamic, 2.0, 10, &mut watch);
    assert_eq!(second.expect("a run"), Status::Interrupted);
    assert_eq!(session.run.rows(), rows);
    assert_eq!(session.time(), 1.0);
    // and the session goes on
    watch.most = u64::MAX;
    let third = session.simulate(Analysis::Dynamic, 2.0, 10, &mut watch);
    assert_eq!(third.expect("a run"), Status::Completed);
    assert_eq!(session.time(), 2.0);
}

/// Between any two looks of a set-up lies one program, or one pass over the model: a caller need not wait for the whole.
#[test]
fn a_set_up_is_interrupted_between_any_two_of_its_programs() {
    let text = format!(
        "{PENDULUM}VARIABLE/1, FUNCTION=DELAY(AZ(3,1),0.1,0)\nSENSOR/1, FUNCTION=AZ(3,1), VALUE=9\n"
    );
    let begun = |most: u64| {
        let mut session = begin(model(&text), "pendulum", Options::default());
        let mut watch = Impatient { looks: 0, most };
        let status = session.simulate(Analysis::Dynamic, 0.01, 1, &mut watch);
        (session, status.expect("a run"), watch.looks)
    };
    let (_, status, all) = begun(u64::MAX);
    assert_eq!(status, Status::Completed);
    let mut in_set_up = 0;
    for n in 1..=all {
        let (mut session, status, looks) = begun(n);
        assert_eq!((status, looks), (Status::Interrupted, n));
        if session.run.rows() > 0 {
            break;
        }
        in_set_up += 1;
        // and the session begins anew
        let mut patient = Impatient {
            looks: 0,
            most: u64::MAX,
        };
        let again = session.simulate(Analysis::Dynamic, 0.01, 1, &mut patient);
        assert_eq!(again.expect("a run"), Status::Completed, "{n}");
    }
    // the model, the scene, positions, velocities, some fifteen programs, columns
    assert!(in_set_up >= 18, "{in_set_up}");
}

/// Loops whose rows depend on each other are closed, weighed and looked at from nearby: a caller need not wait for all of it.
#[test]
fn assembly_is_interrupted_between_any_two_of_its_steps() {
    // a four-bar of revolutes, drawn with a gap
    let text = "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=0,1,0\n\
                PART/3, MASS=1, CM=30, IP=1,1,1, QG=0,1.001,0\nMARKER/30, PART=3\nMARKER/31, PART=3, QP=1,0,0\n\
                PART/4, MASS=1, CM=40, IP=1,1,1, QG=1,0,0\nMARKER/40, PART=4\nMARKER/41, PART=4, QP=0,1.1,0\n\
                MARKER/11, PART=1, QP=1,0,0\nJOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, REVOLUTE, I=30, J=21\n\
                JOINT/3, REVOLUTE, I=31, J=41\nJOINT/4, REVOLUTE, I=40, J=11\nACCGRAV/JGRAV=-9.81\n";
    let options = || Options {
        columns: vec!["AZ(20,1)".into()],
        ..Options::default()
    };
    let mut while_assembled = 0;
    let untouched = {
        let mut session = begin(model(text), "loop", options());
        let status = session.simulate(Analysis::Dynamic, 0.01, 1, &mut Unwatched);
        assert_eq!(status.expect("a run"), Status::Completed);
        values(&session, "AZ(20,1)").to_vec()
    };
    for most in 1.. {
        let mut session = begin(model(text), "loop", options());
        let mut watch = Impatient { looks: 0, most };
        let status = session.simulate(Analysis::Dynamic, 0.01, 1, &mut watch);
        // the first answer is obeyed, whatever assembly would have tried next
        assert_eq!(
            (status.expect("a run"), watch.looks),
            (Status::Interrupted, most)
        );
        if session.run.record.seconds.assemble > 0.0 {
            break;
        }
        while_assembled += 1;
        let again = session.simulate(Analysis::Dynamic, 0.01, 1, &mut Unwatched);
        assert_eq!(again.expect("a run"), Status::Completed, "{most}");
        assert_eq!(values(&session, "AZ(20,1)"), untouched, "{most}");
    }
    // three of them before and after
    assert!(while_assembled >= 15, "{while_assembled}");
}

/// Parts on springs between each other and ground, in a row: at rest under their weight after a few steps of statics.
fn row_on_springs(n: usize) -> String {
    let mut text = String::from("ACCGRAV/JGRAV=-9.81\n");
    for k in 2..2 + n {
        let (own, before, x) = (10 * k, if k == 2 { 1 } else { 10 * (k - 1) }, k - 1);
        text += &format!(
            "PART/{k}, MASS=1, CM={own}, IP=1,1,1, QG={x},0,0\nMARKER/{own}, PART={k}\n\
             BUSHING/{k}, I={own}, J={before}, K=1E3,1E3,1E3, C=1,1,1, KT=1E3,1E3,1E3, CT=1,1,1\n\
             BUSHING/{}, I={own}, J=1, K=1E3,1E3,1E3, C=1,1,1, KT=1E3,1E3,1E3, CT=1,1,1\n",
            k + 1000
        );
    }
    text
}

/// Statics solve with full matrices, whose cost grows with the cube of the model: a caller is asked on the way through
/// each, not only between them.
#[test]
fn statics_are_interrupted_between_any_few_columns_of_a_matrix() {
    const LEAST_LOOKS_PER_MATRIX: u64 = 12;
    let text = row_on_springs(12);
    let begun = |most: u64| {
        let mut session = begin(model(&text), "row", Options::default());
        let mut watch = Impatient { looks: 0, most };
        let status = session.simulate(Analysis::Static, 0.0, 1, &mut watch);
        (session, status.expect("a run"), watch.looks)
    };
    let (session, status, all) = begun(u64::MAX);
    assert_eq!(status, Status::Completed);
    let matrices = session.run.record.counts.factorizations;
    assert!(
        matrices > 0 && all > LEAST_LOOKS_PER_MATRIX * matrices,
        "{all} looks, {matrices} matrices"
    );
    for n in 1..all {
        let (mut session, status, looks) = begun(n);
        // the first answer is obeyed, whatever the search would have tried next
        assert_eq!((status, looks), (Status::Interrupted, n));
        if n % 16 == 0 {
            let again = session.simulate(Analysis::Static, 0.0, 1, &mut Unwatched);
            assert_eq!(again.expect("a run"), Status::Completed, "{n}");
        }
    }
}

/// The first velocities of a closed chain with a given one are found by ranks over all its rows.
#[test]
fn first_velocities_are_interrupted_between_any_two_of_their_ranks() {
    // a five-bar that one bar turns: the others must be found
    let points = [[0.0, 0.0], [0.0, 1.0], [0.7, 1.6], [1.5, 1.2], [1.4, 0.0]];
    let mut text = String::from("ACCGRAV/JGRAV=-9.81\n");
    for k in 0..4 {
        let ([x, y], [u, v], part) = (points[k], points[k + 1], k + 2);
        let spin = if k == 0 { ", WZ=1" } else { "" };
        text += &format!(
            "PART/{part}, MASS=1, CM={part}0, IP=1,1,1, QG={x:?},{y:?},0{spin}\nMARKER/{part}0, PART={part}\n\
             MARKER/{part}1, PART={part}, QP={:?},{:?},0\nJOINT/{part}, REVOLUTE, I={part}0, J={}\n",
            u - x,
            v - y,
            if k == 0 {
                "1".into()
            } else {
                format!("{}1", part - 1)
            }
        );
    }
    text += "MARKER/2, PART=1, QP=1.4,0,0\nJOINT/9, REVOLUTE, I=51, J=2\n";
    let begun = |most: u64| {
        let mut session = begin(model(&text), "five bars", Options::default());
        let mut watch = Impatient { looks: 0, most };
        let status = session.simulate(Analysis::Dynamic, 0.01, 1, &mut watch);
        (session, status.expect("a run"), watch.looks)
    };
    let (_, status, _) = begun(u64::MAX);
    assert_eq!(status, Status::Completed);
    let mut in_velocities = 0;
    for n in 1.. {
        let (session, status, looks) = begun(n);
        assert_eq!((status, looks), (Status::Interrupted, n));
        if session.run.rows() > 0 {
            break;
        }
        let reason = &session.run.record.stop_reason;
        in_velocities += u64::from(session.run.record.seconds.assemble == 0.0);
        assert!(!reason.contains("contradict"), "{reason}");
    }
    assert!(in_velocities >= 24, "{in_velocities}");
}
