//! Mechanisms whose loops have more than 60 rows between them: every method moves them as it moves one loop, or stops.

use crate::running;

use cognate::model::Model;
use cognate::results::Status;
use running::{Analysis, GROUND, begin, options_by, try_to, values, whole};
use std::fmt::Write;

/// A row of `n` four-bars under their weight: crank of length 1, coupler and rocker of other lengths, by four REVOLUTEs
/// each, and springs between the couplers of neighbours that feel only their difference.
fn four_bars(n: usize) -> String {
    let mut text = format!("{GROUND}ACCGRAV/JGRAV=-9.81\n");
    for k in 0..n {
        let (p, m, x) = (10 * (k + 1), 100 * (k + 1), 5.0 * k as f64);
        let corners = [[0.0, 0.0], [0.0, 1.0], [2.0, 2.0], [3.0, 0.0]];
        for i in 0..3 {
            let ([ax, ay], [bx, by]) = (corners[i], corners[i + 1]);
            let (part, marker) = (p + i, m + 3 * i);
            writeln!(
                text,
                "PART/{part}, MASS=1, CM={marker}, IP=0.1,0.1,0.1\n\
                 MARKER/{marker}, PART={part}, QP={:?},{:?},0\n\
                 MARKER/{}, PART={part}, QP={:?},{ay:?},0\nMARKER/{}, PART={part}, QP={:?},{by:?},0",
                x + (ax + bx) / 2.0,
                (ay + by) / 2.0,
                marker + 1,
                x + ax,
                marker + 2,
                x + bx,
            )
            .unwrap();
        }
        writeln!(
            text,
            "MARKER/{}, PART=1, QP={x:?},0,0\nMARKER/{}, PART=1, QP={:?},0,0",
            m + 20,
            m + 21,
            x + 3.0
        )
        .unwrap();
        let joints = [[1, 20], [2, 4], [5, 7], [8, 21]];
        for (i, [a, b]) in joints.into_iter().enumerate() {
            writeln!(text, "JOINT/{}, REVOLUTE, I={}, J={}", p + i, m + a, m + b).unwrap();
        }
        if k > 0 {
            let (here, before) = (m + 3, m - 97);
            writeln!(
                text,
                "SFORCE/{p}, TRANSLATIONAL, I={here}, J={before}, FUNCTION=-100*(DM({here},{before})-5)"
            )
            .unwrap();
        }
    }
    text + "END\n"
}

#[test]
fn rows_of_four_bars_move_as_one_does() {
    let (end, steps) = (0.6, 12);
    let place = |n: usize, (method, error): (&str, f64)| {
        // the first coupler, one in the middle, the last
        let columns = [1, n.div_ceil(2), n].map(|k| format!("DY({},1)", 100 * k + 3));
        let names = columns.each_ref().map(String::as_str);
        let mut s = begin(
            whole(&four_bars(n)),
            "row",
            options_by(&names, method, error),
        );
        let status = try_to(&mut s, Analysis::Dynamic, end, steps);
        (columns.map(|c| values(&s, &c).to_vec()), status)
    };
    let ([exact, ..], _) = place(1, ("AUTO", 1e-11));
    let largest = exact.iter().fold(0.0, |m: f64, y| m.max(y.abs()));
    let mut completed = 0;
    for (method, requests) in [("AUTO", &[1e-2, 1e-4, 1e-8][..]), ("RADAU5", &[1e-2, 1e-5])] {
        for &request in requests {
            let (found, status) = place(12, (method, request));
            if status != Status::Completed {
                continue;
            }
            completed += 1;
            for column in found {
                let off = column.iter().zip(&exact).map(|(a, b)| (a - b).abs());
                let off = off.fold(0.0, f64::max) / largest;
                assert!(off < 20.0 * request, "{method} {request:e}: {off:e}");
            }
        }
    }
    assert_eq!(completed, 5);
}

#[test]
fn many_loops_that_turn_at_one_instant_are_passed_at_every_request() {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/data/references/a02_nfourbar_10.adm"
    );
    let model = Model::read(file).expect("a model");
    let reached = |request: f64| {
        let mut s = begin(model.clone(), "row", options_by(&[], "AUTO", request));
        let status = try_to(&mut s, Analysis::Dynamic, 10.0, 10);
        (status, s.run.record.stop_reason.clone())
    };
    // the one at the end stopped at its eighth passage, 1e-7 s beside the instant
    for request in [1e-4, 1e-6, 1e-8, 3e-10, 1.0206e-11] {
        let (status, why) = reached(request);
        assert_eq!(status, Status::Completed, "{request:e}: {why}");
    }
}
