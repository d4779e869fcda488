//! Rank that changes while a mechanism moves, and mechanisms that can be driven no further.

use crate::running;

use cognate::dataset::command::Script;
use cognate::model::Model;
use cognate::results::{RowChange, Status};
use running::{Analysis, Session, begin, go, obeys, options, try_to, whole};
use std::f64::consts::PI;

fn session(text: &str, columns: &[&str], error: f64) -> Session {
    begin(whole(text), "ranks", options(columns, error))
}

/// A parallelogram with cranks of 1, base 3, upright at the start; `third`: with a third crank in the middle.
fn parallelogram(third: bool, more: &str) -> String {
    let middle = if third {
        "PART/5, MASS=1, CM=50, IP=1,1,1\nMARKER/50, PART=5, QP=1.5,0.5,0\nMARKER/51, PART=5, QP=1.5,0,0\nMARKER/15, PART=1, QP=1.5,0,0\n\
         MARKER/52, PART=5, QP=1.5,1,0\nMARKER/35, PART=3, QP=1.5,1,0\nJOINT/5, REVOLUTE, I=51, J=15\nJOINT/6, REVOLUTE, I=52, J=35\n"
    } else {
        ""
    };
    format!(
        "PARALLELOGRAM\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1, WZ=5\nPART/3, MASS=1, CM=30, IP=1,1,1\nPART/4, MASS=1, CM=40, IP=1,1,1\n\
         MARKER/20, PART=2, QP=0,0.5,0\nMARKER/30, PART=3, QP=1.5,1,0\nMARKER/40, PART=4, QP=3,0.5,0\n\
         MARKER/11, PART=1\nMARKER/21, PART=2\nMARKER/22, PART=2, QP=0,1,0\nMARKER/32, PART=3, QP=0,1,0\n\
         MARKER/33, PART=3, QP=3,1,0\nMARKER/43, PART=4, QP=3,1,0\nMARKER/44, PART=4, QP=3,0,0\nMARKER/14, PART=1, QP=3,0,0\n\
         JOINT/1, REVOLUTE, I=21, J=11\nJOINT/2, REVOLUTE, I=32, J=22\nJOINT/3, REVOLUTE, I=43, J=33\nJOINT/4, REVOLUTE, I=44, J=14\n\
         {middle}{more}END\n"
    )
}

fn passes(session: &Session) -> Vec<f64> {
    let changes = session.run.record.rank_changes.iter();
    changes
        .filter(|c| c.change == RowChange::Passes)
        .map(|c| c.time)
        .collect()
}

/// Cranks of a parallelogram without gravity turn evenly: 5 rad/s from upright, folded after a quarter turn and after each half.
#[test]
fn a_parallelogram_passes_its_folded_positions_and_tells_when() {
    for third in [false, true] {
        let mut s = session(&parallelogram(third, ""), &["AZ(30,11)", "DY(22,11)"], 1e-9);
        go(&mut s, Analysis::Dynamic, 2.0, 40);
        let turned = s.run.column("AZ(30,11)").unwrap();
        assert!(
            turned.iter().all(|a| a.abs() < 1e-6),
            "the coupler does not turn: {turned:?}"
        );
        let time = s.run.column("time").unwrap();
        for (t, y) in time.iter().zip(s.run.column("DY(22,11)").unwrap()) {
            assert!((y - (5.0 * t).cos()).abs() < 1e-6, "{t} {y}");
        }
        let told = passes(&s);
        let expected: Vec<f64> = (0..4)
            .map(|k| (0.5 + f64::from(k)) * PI / 5.0)
            .filter(|t| *t < 2.0)
            .collect();
        assert_eq!(told.len(), expected.len(), "{told:?}");
        for (a, b) in told.iter().zip(&expected) {
            // located where the rank falls; the motion itself is exact to 1e-8
            assert!((a - b).abs() < 1e-5, "{told:?}");
        }
        let place = &s.run.record.rank_changes[0].place;
        assert!(
            !place.is_empty() && place[0].0.contains("angle"),
            "{place:?}"
        );
        assert!(s.run.record.energy.error() < 1e-7);
    }
}

#[test]
fn a_driven_parallelogram_stays_on_its_branch() {
    let motion = "MOTION/1, JOINT=1, ROTATION, FUNCTION=2*PI*TIME\n";
    // 37 steps never stand on a folded position, 40 do
    for steps in [37, 40] {
        let mut s = session(
            &parallelogram(false, motion),
            &["AZ(30,11)", "DX(22,11)"],
            1e-6,
        );
        go(&mut s, Analysis::Kinematic, 1.0, steps);
        let turned = s.run.column("AZ(30,11)").unwrap();
        assert!(turned.iter().all(|a| a.abs() < 1e-8), "{turned:?}");
        let told = passes(&s);
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(
            (told[0] - 0.25).abs() < 1e-5 && (told[1] - 0.75).abs() < 1e-5,
            "{told:?}"
        );
    }
}

/// A bar pinned twice to a swinging arm: of the second pin one coordinate is superfluous, and which one changes as the arm turns.
#[test]
fn the_rows_that_are_kept_change_as_a_pin_turns() {
    let model = |second: &str| {
        format!(
            "TWO PINS\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=0.1,0.1,0.1\nPART/3, MASS=2, CM=30, IP=0.3,0.3,0.3\n\
             MARKER/20, PART=2, QP=1,0,0\nMARKER/30, PART=3, QP=2,0.5,0\nMARKER/11, PART=1\nMARKER/21, PART=2\n\
             MARKER/22, PART=2, QP=1,0,0\nMARKER/32, PART=3, QP=1,0,0\nMARKER/23, PART=2, QP=2,0,0\nMARKER/33, PART=3, QP=2,0,0\n\
             JOINT/1, REVOLUTE, I=21, J=11\nJOINT/2, {second}\nACCGRAV/JGRAV=-9.81\nEND\n"
        )
    };
    let columns = ["DX(30,11)", "DY(30,11)", "FX(21,11)", "FY(21,11)"];
    let mut pinned = session(
        &model("REVOLUTE, I=32, J=22\nJOINT/3, REVOLUTE, I=33, J=23"),
        &columns,
        1e-10,
    );
    let mut welded = session(&model("FIXED, I=32, J=22"), &columns, 1e-10);
    for s in [&mut pinned, &mut welded] {
        go(s, Analysis::Dynamic, 3.0, 60);
    }
    for c in columns {
        let (a, b) = (pinned.run.column(c).unwrap(), welded.run.column(c).unwrap());
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() < 1e-6 * (1.0 + b.abs()), "{c}: {a} {b}");
        }
    }
    let changes = &pinned.run.record.rank_changes;
    assert!(
        changes.iter().any(|c| c.change == RowChange::Exchanged),
        "{changes:?}"
    );
}

/// The same bar on an arm that is driven to where it hangs, and stays there: the rows of the beginning are dependent then,
/// and whatever reads a reaction has to go with those that are kept.
#[test]
fn sensors_delays_and_closures_read_the_rows_that_are_kept() {
    let model = |second: &str| {
        format!(
            "TWO PINS\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=0.1,0.1,0.1\nPART/3, MASS=2, CM=30, IP=0.3,0.3,0.3\n\
             MARKER/20, PART=2, QP=1,0,0\nMARKER/30, PART=3, QP=2,0.5,0\nMARKER/11, PART=1\nMARKER/21, PART=2\n\
             MARKER/22, PART=2, QP=1,0,0\nMARKER/32, PART=3, QP=1,0,0\nMARKER/23, PART=2, QP=2,0,0\nMARKER/33, PART=3, QP=2,0,0\n\
             JOINT/1, REVOLUTE, I=21, J=11\nJOINT/2, {second}\nMOTION/1, JOINT=1, ROTATION, FUNCTION=STEP(TIME,0,0,1,-PI/2)\n\
             SFORCE/1, I=30, J=11, TRANSLATIONAL, FUNCTION=5\n\
             SENSOR/1, GE, VALUE=50, FUNCTION=FY(21,11)*STEP(TIME,1.5,0,2,2), EVALUATE=FY(21,11)\n\
             VARIABLE/1, FUNCTION=DELAY(FY(21,11),0.1,0)\nVARIABLE/2, FUNCTION=USER(1)\nDIFF/1, IC=0, FUNCTION=1-DIF(1)\n\
             ACCGRAV/JGRAV=-9.81\nEND\n"
        )
    };
    let columns = ["FY(21,11)", "SENVAL(1)", "VARVAL(1)", "VARVAL(2)"];
    let [pinned, welded] = [
        "REVOLUTE, I=32, J=22\nJOINT/3, REVOLUTE, I=33, J=23",
        "FIXED, I=32, J=22",
    ]
    .map(|second| {
        let mut s = session(&model(second), &columns, 1e-8);
        s.register("VARIABLE/2", &["FY(21,11)"], |call, out| {
            out[0] = call.values[0]
        });
        go(&mut s, Analysis::Transient, 3.0, 29);
        s
    });
    let changes = &pinned.run.record.rank_changes;
    assert!(
        changes.iter().any(|c| c.change == RowChange::Exchanged),
        "{changes:?}"
    );
    let time = pinned.run.column("time").unwrap();
    // the weight of both, and 5 along the line from the axis to where the load acts
    let at_rest = 3.0 * 9.81 + 5.0 * 2.0 / 4.25f64.sqrt();
    for c in columns {
        let (a, b) = (pinned.run.column(c).unwrap(), welded.run.column(c).unwrap());
        for ((t, a), b) in time.iter().zip(a).zip(b) {
            assert!((a - b).abs() < 1e-4, "{c} at {t}: {a} {b}");
        }
        assert!((a[a.len() - 1] - at_rest).abs() < 1e-6, "{c}: {a:?}");
    }
}

/// Crank 1 and rod 2: the slider reaches no further than 3.
#[test]
fn a_mechanism_driven_past_its_reach_stops_there_and_says_why() {
    let text = "REACH\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1\nPART/3, MASS=1, CM=30, IP=1,1,1\nPART/4, MASS=1, CM=40, IP=1,1,1\n\
        MARKER/20, PART=2\nMARKER/30, PART=3\nMARKER/40, PART=4, QP=2,0,0, REULER=90D,90D,0\n\
        MARKER/11, PART=1\nMARKER/22, PART=2, QP=0.25,0.968245836551854,0\nMARKER/32, PART=3, QP=0.25,0.968245836551854,0\nMARKER/33, PART=3, QP=2,0,0\n\
        MARKER/43, PART=4, QP=2,0,0\nMARKER/14, PART=1, REULER=90D,90D,0\n\
        JOINT/1, REVOLUTE, I=20, J=11\nJOINT/2, REVOLUTE, I=32, J=22\nJOINT/3, REVOLUTE, I=43, J=33\nJOINT/4, TRANSLATIONAL, I=40, J=14\n\
        MOTION/1, JOINT=4, TRANSLATION, FUNCTION=2+TIME\nEND\n";
    let mut s = session(text, &["DX(43,11)", "DY(22,11)"], 1e-6);
    let status = try_to(&mut s, Analysis::Kinematic, 2.0, 20);
    assert_eq!(status, Status::Stopped);
    let reason = &s.run.record.stop_reason;
    assert!(
        reason.contains("locked: MOTION/1 drives it past its reach") && reason.contains("JOINT/"),
        "{reason}"
    );
    let time = s.run.column("time").unwrap();
    let last = time.len() - 1;
    assert!((time[last] - 1.0).abs() < 1e-6, "{time:?}");
    // outputs on the way, and the configuration in which it stands: stretched
    assert!(time.len() > 10);
    assert!(s.run.column("DY(22,11)").unwrap()[last].abs() < 1e-3);
    assert!((s.run.column("DX(43,11)").unwrap()[last] - 3.0).abs() < 1e-6);
    assert!(s.run.record.simulations[0].worst[0].starts_with("JOINT/"));
}

/// Where coupler (4) and rocker (3, about (2, 0)) meet when the crank (1, about the origin) stands at an angle, on a side of the line between their ends.
fn rocker(angle: f64, side: f64) -> [f64; 2] {
    let a = [angle.cos(), angle.sin()];
    let d = [2.0 - a[0], -a[1]];
    let d2 = d[0] * d[0] + d[1] * d[1];
    let along = (16.0 - 9.0 + d2) / (2.0 * d2);
    let aside = side * (16.0 / d2 - along * along).max(0.0).sqrt();
    [
        a[0] + along * d[0] - aside * d[1],
        a[1] + along * d[1] + aside * d[0],
    ]
}

/// Crank 1, coupler 4, rocker 3, base 2: as 1 + 4 = 2 + 3, all hinges lie on one line when the crank points along the base, where both
/// branches meet.
fn change_point(more: &str) -> String {
    let [px, py] = rocker(0.5 * PI, 1.0);
    format!(
        "CHANGE POINT\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1\nPART/3, MASS=1, CM=30, IP=1,1,1\nPART/4, MASS=1, CM=40, IP=1,1,1\n\
         MARKER/20, PART=2\nMARKER/30, PART=3\nMARKER/40, PART=4\nMARKER/11, PART=1\nMARKER/14, PART=1, QP=2,0,0\n\
         MARKER/21, PART=2\nMARKER/22, PART=2, QP=0,1,0\nMARKER/32, PART=3, QP=0,1,0\nMARKER/33, PART=3, QP={px:.15},{py:.15},0\n\
         MARKER/43, PART=4, QP={px:.15},{py:.15},0\nMARKER/44, PART=4, QP=2,0,0\n\
         JOINT/1, REVOLUTE, I=21, J=11\nJOINT/2, REVOLUTE, I=32, J=22\nJOINT/3, REVOLUTE, I=33, J=43\nJOINT/4, REVOLUTE, I=44, J=14\n{more}END\n"
    )
}

/// Driven through its dead point, where all hinges lie on one line: it goes on smoothly, and the time and the place are told.
#[test]
fn an_unequal_four_bar_is_driven_through_its_dead_point() {
    let motion = "MOTION/1, JOINT=1, ROTATION, FUNCTION=TIME\n";
    for steps in [43, 50] {
        let mut s = session(&change_point(motion), &["DX(33,11)", "DY(33,11)"], 1e-8);
        go(&mut s, Analysis::Kinematic, 6.0, steps);
        // the crank begins at 90° and points along the base after three quarters of a turn
        let told = passes(&s);
        assert_eq!(told.len(), 1, "{told:?}");
        assert!((told[0] - 1.5 * PI).abs() < 1e-5, "{told:?}");
        assert!(!s.run.record.rank_changes[0].place.is_empty());
        // smoothly on: the rocker's end passes to the other side of the line between its neighbours
        let time = s.run.column("time").unwrap();
        for (k, t) in time.iter().enumerate() {
            let side = if *t < 1.5 * PI { 1.0 } else { -1.0 };
            let [x, y] = rocker(0.5 * PI + t, side);
            let off =
                [("DX(33,11)", x), ("DY(33,11)", y)].map(|(c, x)| s.run.column(c).unwrap()[k] - x);
            assert!(off[0].hypot(off[1]) < 1e-6, "{t}: {off:?}");
        }
    }
}

/// A problem of the references as its command file runs it.
fn reference(problem: &str) -> Session {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/references");
    let script = Script::read(folder.join(format!("{problem}.acf"))).unwrap();
    let model = Model::read(script.model_file().unwrap()).unwrap();
    let mut session = begin(model, problem, options(&[], 1e-8));
    obeys(&mut session, &script);
    session
}

/// Its six hinges are dependent wherever it stands: one row is left out for good, and its rank never changes.
#[test]
fn bricards_linkage_has_the_same_rank_all_along() {
    let s = reference("a04_bricard");
    let record = &s.run.record;
    assert!(record.rank_changes.is_empty(), "{:?}", record.rank_changes);
    assert_eq!(record.redundant.len(), 1, "{:?}", record.redundant);
    assert!(record.energy.error() < 1e-6);
}

/// Two four-bars side by side fold whenever their cranks are level: each passage is told with its time and its place, and energy stays.
#[test]
fn linked_four_bars_tell_each_folded_position() {
    let s = reference("a02_nfourbar_2");
    let changes = &s.run.record.rank_changes;
    assert!(changes.len() >= 10, "{changes:?}");
    for (k, c) in changes.iter().enumerate() {
        assert_eq!(c.change, RowChange::Passes);
        assert!(c.rows.iter().all(|r| r.starts_with("JOINT/")), "{c:?}");
        let crank = c.place.iter().find(|p| p.0 == "JOINT/1 angle");
        // level after each odd number of quarter turns, none left out; found where the rank falls
        let quarters = crank.expect("the crank").1 / (0.5 * PI);
        assert!((quarters + 2.0 * k as f64 + 1.0).abs() < 1e-4, "{k}: {c:?}");
    }
    assert!(s.run.record.energy.error() < 1e-6);
}
