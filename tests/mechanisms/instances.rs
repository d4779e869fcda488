//! Instances of an assembly: joints, markers and springs that comment lines of ours make on them, the
//! rigid bodies that they become by it, and curves of several pieces.

use crate::running;
use cognate::dataset::read_text;
use cognate::model::{JointKind, Model};
use running::{Analysis, GROUND, go, last, model, session, values};

/// A subassembly of two parts that nothing joins, beside a part that is not at the origin and turned.
const ARM: &str = "
! adams_view_name='base'
PART/5, MASS=4, CM=50, IP=1,1,1, QG=0.1,0.2,0, REULER=20D,10D,0D
MARKER/50, PART=5
! adams_view_name='arm.rod'
PART/2, MASS=1, CM=20, IP=0.01,0.02,0.02, QG=0.3,0,0, REULER=0D,90D,0D
MARKER/20, PART=2, QP=0.1,0,0
! adams_view_name='arm.tool.tip'
PART/3, MASS=0.5, CM=30, IP=0.001,0.001,0.001, QG=0.8,0,0
MARKER/30, PART=3
! adams_view_name='arm.tool.grip'
PART/4, MASS=0.25, CM=40, IP=0.001,0.001,0.001, QG=0.9,0,0.1
MARKER/40, PART=4
JOINT/9, FIXED, I=50, J=12
MARKER/12, PART=1, QP=0.1,0.2,0, REULER=20D,10D,0D
ACCGRAV/JGRAV=-9.81
";

fn said(text: &str) -> Vec<String> {
    let reading = read_text(&format!("{GROUND}{text}END\n"));
    reading
        .diagnostics
        .iter()
        .map(ToString::to_string)
        .collect()
}

fn moved(text: &str, columns: &[&str]) -> Vec<Vec<f64>> {
    let mut s = session(text, columns, 1e-10);
    go(&mut s, Analysis::Dynamic, 0.5, 20);
    columns.iter().map(|c| values(&s, c).to_vec()).collect()
}

fn near(a: &[Vec<f64>], b: &[Vec<f64>], tolerance: f64) {
    for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
        assert!(
            (a - b).abs() <= tolerance * (1.0 + b.abs()),
            "{a} instead of {b}"
        );
    }
}

#[test]
fn a_joint_on_two_instances_makes_them_rigid_bodies_and_moves_them_as_statements_do() {
    let columns = ["DX(40,1)", "DY(40,1)", "AZ(3,1)", "DX(40,30)", "DM(20,30)"];
    let columns = &columns.map(|c| c.replace("AZ(3,1)", "WZ(30,1)"));
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    let line =
        format!("{ARM}! cognate: JOINT/4 hinge = REVOLUTE, base, arm, AT=0.3,0,0, AXIS=0,0,1\n");
    let statements = format!(
        "{ARM}! cognate: RIGID whole = PART/2, PART/3, PART/4\n\
         MARKER/60, PART=2, REULER=0D,-90D,0D\nMARKER/61, PART=1, QP=0.3,0,0\nJOINT/4, REVOLUTE, I=60, J=61\n"
    );
    let (a, b) = (moved(&line, &columns), moved(&statements, &columns));
    near(&a, &b, 1e-7);
    assert!((a[0][20] - a[0][0]).abs() > 0.1, "it moves");
    let spread = a[3]
        .iter()
        .chain(&a[4])
        .map(|x| x.abs())
        .fold(0.0, f64::max);
    assert!(spread < 10.0 && (a[4][20] - a[4][0]).abs() < 1e-9);
    // I is on the second instance, J on the first, and both are named
    let m = model(&line);
    let hinge = &m.joints[&4];
    assert_eq!(
        (hinge.kind, hinge.place.name.as_deref()),
        (JointKind::Revolute, Some("hinge"))
    );
    let name = |id: u32| m.markers[&id].place.name.clone().unwrap_or_default();
    assert_eq!(
        (name(hinge.i), name(hinge.j)),
        ("hinge_I".into(), "hinge_J".into())
    );
}

#[test]
fn every_joint_of_two_instances_is_assembled_and_aligned_as_it_is_drawn() {
    let types = [
        "REVOLUTE",
        "TRANSLATIONAL",
        "CYLINDRICAL",
        "SPHERICAL",
        "PLANAR",
        "UNIVERSAL",
        "FIXED",
    ];
    for (kind, removed) in types.into_iter().zip([5, 5, 4, 3, 3, 4, 6]) {
        for axis in ["0,0,1", "1,2,3", "-1,0,0"] {
            let text = format!(
                "{ARM}! cognate: JOINT/4 it = {kind}, base, arm, AT=0.3,0.1,-0.2, AXIS={axis}\n"
            );
            let found = said(&text);
            assert!(found.is_empty(), "{kind} {axis}: {found:?}");
            let m = model(&text);
            assert_eq!(
                m.joints.len(),
                4,
                "the joint, the base, and two within the arm"
            );
            let mut s = session(&text, &["DM(20,30)", "DM(30,40)"], 1e-9);
            go(&mut s, Analysis::Dynamic, 0.1, 5);
            let record = &s.run.record;
            let mut warned = record.warned();
            warned.retain(|w| kind != "FIXED" || !w.starts_with("no part can move"));
            assert!(warned.is_empty(), "{kind}: {warned:?}");
            let rows: usize = m.elements().iter().filter_map(|(_, e)| e.equations()).sum();
            assert_eq!(rows, removed + 18, "{kind}");
            for c in ["DM(20,30)", "DM(30,40)"] {
                assert!((last(&s, c) - values(&s, c)[0]).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn a_spring_at_a_joint_or_at_a_place_is_one_between_two_markers_in_degrees_too() {
    let hinge = format!("{ARM}! cognate: JOINT/4 hinge = REVOLUTE, base, arm, AT=0.3,0,0\n");
    let ways = [
        "! cognate: SPRINGDAMPER back = hinge, KT=0.4/D, CT=0.01/D, ANGLE=10D, TORQUE=0.3\n",
        "! cognate: SPRINGDAMPER/7 back = base, arm, AT=0.3,0,0, ROTATION, KT=0.4/D, CT=0.01/D, ANGLE=10D, TORQUE=0.3\n",
        "MARKER/60, PART=2, REULER=0D,-90D,0D\nMARKER/61, PART=1, QP=0.3,0,0\n\
         SPRINGDAMPER/7, ROTATION, I=60, J=61, KT=22.918311805232928, CT=0.5729577951308232, ANGLE=10D, TORQUE=0.3\n",
    ];
    let columns = ["DX(40,1)", "DY(40,1)", "WZ(30,1)"];
    let [a, b, c] = ways.map(|way| moved(&format!("{hinge}{way}"), &columns));
    near(&a, &c, 1e-7);
    near(&b, &c, 1e-7);
    let free = moved(&hinge, &columns);
    assert!(
        (free[0][20] - c[0][20]).abs() > 1e-3,
        "the spring does something"
    );
    let m = model(&format!(
        "{ARM}! cognate: SPRINGDAMPER/3 s = base, arm, AT=0,0,0, TO=0.3,0,0, TRANSLATION, K=10, LENGTH=0.1\n"
    ));
    let s = &m.spring_dampers[&3];
    assert_eq!((s.rotational, s.stiffness, s.free), (false, 10.0, 0.1));
}

#[test]
fn an_instance_is_no_rigid_body_where_what_holds_it_or_lies_in_it_is_one() {
    for (lines, told) in [
        (
            "! cognate: RIGID arm.tool\n! cognate: MARKER m = arm, AT=0,0,0\n",
            "arm cannot be a rigid body: arm.tool, which lies in it, is one",
        ),
        (
            "! cognate: RIGID arm\n! cognate: MARKER m = arm.rod, AT=0,0,0\n",
            "arm.rod cannot be a rigid body: arm, in which it lies, is one",
        ),
        (
            "! cognate: MARKER a = arm.tool\n! cognate: MARKER b = arm\n",
            "arm cannot be a rigid body: arm.tool, which lies in it, is one",
        ),
        (
            "! cognate: RIGID arm\n! cognate: RIGID arm.tool\n",
            "is in the rigid body arm",
        ),
        (
            "! cognate: MARKER a = arm\n! cognate: RIGID it = PART/3, base\n",
            "PART/3 is in the rigid body it",
        ),
        ("! cognate: MARKER a = amr\n", "did you mean arm?"),
        (
            "! cognate: JOINT j = REVOLUTE, arm, arm\n",
            "both ends of j are on arm",
        ),
        (
            "! cognate: JOINT j = SCREW, base, arm\n",
            "it makes FIXED, REVOLUTE",
        ),
        (
            "! cognate: JOINT/9 j = FIXED, base, arm\n",
            "JOINT/9 is there already",
        ),
        (
            "! cognate: JOINT j = REVOLUTE, base, arm, AT=1,2\n",
            "AT is three numbers",
        ),
        (
            "! cognate: JOINT j = REVOLUTE, base, arm, AXES=1,2,3\n",
            "did you mean AXIS",
        ),
        (
            "! cognate: JOINT j = REVOLUTE, base, arm, AXIS=0,0,0\n",
            "not parallel",
        ),
        (
            "! cognate: SPRINGDAMPER s = base, arm, K=1\n",
            "ROTATION or TRANSLATION is expected",
        ),
        (
            "! cognate: SPRINGDAMPER s = hnige, KT=1\n",
            "the model has no JOINT `hnige`",
        ),
        ("! cognate: MARKER/x m = base\n", "a number from 1 on"),
        (
            "! cognate: CURVE c = MARKER/20\n",
            "MARKER/20 is no MATRIX or CURVE",
        ),
    ] {
        let found = said(&format!("{ARM}{lines}"));
        assert!(found.iter().any(|d| d.contains(told)), "{lines}: {found:?}");
    }
}

#[test]
fn what_lines_make_is_written_as_statements_that_move_alike() {
    let text = format!(
        "{ARM}! cognate: JOINT/4 hinge = REVOLUTE, base, arm, AT=0.3,0,0\n\
         ! cognate: SPRINGDAMPER/1 back = hinge, KT=0.4/D, ANGLE=10D\n! cognate: MARKER/77 tip = arm, AT=1,0,0\n"
    );
    let columns = ["DX(77,1)", "DY(77,1)"];
    let first = model(&text);
    let written = first.to_text();
    let body = written.replace("END", "");
    let again = read_text(&format!("{body}END\n")).model;
    let run = |m: Model| {
        let mut s = running::begin(m, "w", running::options(&columns, 1e-10));
        go(&mut s, Analysis::Dynamic, 0.5, 20);
        columns.map(|c| values(&s, c).to_vec())
    };
    near(&run(first), &run(again), 1e-12);
}

#[test]
fn a_chain_of_curves_is_one_spline_through_all_their_points_however_they_run() {
    let arc = |from: f64, to: f64| -> Vec<[f64; 3]> {
        let at = |k: u32| from + (to - from) * f64::from(k) / 8.0;
        (0..=8).map(|k| [at(k).cos(), at(k).sin(), 0.0]).collect()
    };
    let matrix = |id: u32, points: &[[f64; 3]]| {
        let rows: Vec<String> = points.iter().flatten().map(|x| format!("{x:?}")).collect();
        format!(
            "MATRIX/{id}, FULL=RORDER, ROWS={}, COLUMNS=3, VALUES={}\n",
            points.len(),
            rows.join("\n, ")
        )
    };
    let third = std::f64::consts::TAU / 3.0;
    let pieces = [
        arc(0.0, third),
        arc(2.0 * third, third),
        arc(2.0 * third, 3.0 * third),
    ];
    let texts: String = pieces
        .iter()
        .zip(1..)
        .map(|(p, id)| matrix(id, p))
        .collect();
    let chain = format!(
        "{texts}CURVE/3, CLOSED, CURVE_POINTS, MATRIX=9\n{}",
        matrix(9, &arc(0.0, 3.0 * third))
    );
    for order in [
        "MATRIX/1, MATRIX/2, MATRIX/3",
        "MATRIX/2, MATRIX/1, MATRIX/3",
        "MATRIX/3, MATRIX/2, MATRIX/1",
    ] {
        let m = model(&format!("{chain}! cognate: CURVE/4 cam = {order}\n"));
        let curve = &m.curves[&4];
        assert!(curve.closed && curve.through_points == Some(true));
        let points = m.matrices[&curve.matrix.unwrap()].by_rows().unwrap();
        assert_eq!(points.len(), 3 * 25, "{order}");
        let at: Vec<f64> = points.chunks(3).map(|p| p[1].atan2(p[0])).collect();
        let turns: Vec<f64> = at
            .windows(2)
            .map(|w| (w[1] - w[0] + 9.0).rem_euclid(third * 3.0) - 9.0 + third * 3.0)
            .collect();
        let one_way = turns.windows(2).all(|w| (w[0] - w[1]).abs() < 1e-9);
        assert!(one_way, "{order}: {turns:?}");
    }
    let apart = format!(
        "{}{}! cognate: CURVE c = MATRIX/1, MATRIX/2\n",
        matrix(1, &arc(0.0, 1.0)),
        matrix(2, &arc(1.5, 2.0))
    );
    let found = said(&apart);
    assert!(
        found
            .iter()
            .any(|d| d.contains("beside the end of the piece before it")),
        "{found:?}"
    );
    let corner = format!(
        "{}{}! cognate: CURVE c = MATRIX/1, MATRIX/2\n",
        matrix(1, &arc(0.0, 1.0)),
        matrix(2, &[[1.0, 0.0, 0.0], [5.0, 0.0, 0.0]])
    );
    let found = said(&corner);
    assert!(found.iter().any(|d| d.contains("a corner of")), "{found:?}");
}
