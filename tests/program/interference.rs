//! Interference after a run: distances of solids known in closed form, who is looked at, how the command ends.

use super::command::{cognate, path, scratch};
use cognate::results;
use std::path::PathBuf;

/// A ball of radius 0.5 on a slider passes between a wall of ground and a post; nothing is hit by a contact.
const PASSAGE: &str = "\
PASSAGE
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
PART/1, GROUND
MARKER/1, PART=1, REULER=0,90D,0
MARKER/2, PART=1, QP=3,-2,-1
MARKER/3, PART=1, QP=-10,1.2,0, REULER=0,90D,0
PART/2, MASS=1, CM=20, IP=1,1,1
MARKER/20, PART=2
MARKER/21, PART=2, REULER=90D,90D,90D
MARKER/10, PART=1, REULER=90D,90D,90D
JOINT/1, TRANSLATIONAL, I=21, J=10
MOTION/1, JOINT=1, FUNCTION=4*TIME
GRAPHICS/1, ELLIPSOID, CM=20, XSCALE=1, YSCALE=1, ZSCALE=1
GRAPHICS/2, BOX, CORNER=2, X=1, Y=1, Z=2
GRAPHICS/3, PLANE, RM=3
GRAPHICS/4, TORUS, CM=1, MAJOR_RADIUS=5, MINOR_RADIUS=0.1
RESULTS/XRF
END
";

fn ran(test: &str) -> PathBuf {
    let model = scratch(test, "passage.adm", PASSAGE);
    let out = model.with_file_name("out");
    let done = cognate(&[
        "run",
        path(&model),
        "--end",
        "1",
        "--steps",
        "40",
        "--out",
        path(&out),
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    out.join("passage.res")
}

#[test]
fn distances_and_overlaps_over_a_run_are_those_of_geometry() {
    let results = ran("interference_run");
    let written = results.with_file_name("distances.csv");
    let done = cognate(&[
        "interference",
        path(&results),
        "--json",
        "--out",
        path(&written),
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(
        done.err.contains("GRAPHICS/4 is not looked at"),
        "{}",
        done.err
    );
    let found: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    let pairs = found["pairs"].as_array().unwrap();
    // solids of one part do not move against each other
    assert_eq!(pairs.len(), 2, "{found:#}");
    let table = results::read(&written).unwrap();
    let (time, post) = (
        table.column("time").unwrap(),
        table.column("GRAPHICS_1_TO_GRAPHICS_2.DISTANCE").unwrap(),
    );
    for (t, distance) in time.iter().zip(post) {
        // the nearest of the post's edge x 3 to 4 at y = -1 from the ball's middle at x = 4 t
        let x = 4.0 * t;
        let along = (3.0 - x).max(x - 4.0).max(0.0);
        let expected = along.hypot(1.0) - 0.5;
        assert!(
            (distance - expected).abs() < 1e-6,
            "{t}: {distance} {expected}"
        );
    }
    let nearest = &pairs[0]["nearest"];
    assert!(
        (nearest["distance"].as_f64().unwrap() - 0.5).abs() < 1e-6,
        "{found:#}"
    );
}

#[test]
fn pairs_are_chosen_and_a_clearance_is_checked() {
    let results = ran("interference_pairs");
    let ask = |more: &[&str]| {
        let mut all = vec!["interference", path(&results)];
        all.extend(more);
        cognate(&all)
    };
    let chosen = ask(&["--pair", "GRAPHICS/2,PART/2", "--json"]);
    let found: serde_json::Value = serde_json::from_str(&chosen.out).unwrap();
    assert_eq!(
        found["pairs"].as_array().unwrap().len(),
        1,
        "{}",
        chosen.out
    );
    assert_eq!(
        ask(&["--pair", "GRAPHICS/2,PART/2", "--clearance", "0.4"]).code,
        0
    );
    assert_eq!(
        ask(&["--pair", "GRAPHICS/2,PART/2", "--clearance", "0.6"]).code,
        8
    );
    let table = ask(&[]).out;
    assert!(
        table.contains("GRAPHICS/1, GRAPHICS/2") && table.contains("nearest"),
        "{table}"
    );
}

/// A ball of radius 0.2 in the notch of an L, 0.4 from both of its walls, that moves along them.
const NOTCH: &str = "\
A ball in the notch of an L
UNITS/SYSTEM=MKS
PART/1, GROUND
MARKER/10, PART=1
MARKER/11, PART=1, QP=1.6,1.6,0.5
PART/2, QG=1.6,1.6,0.5, MASS=1, CM=20, IP=.1,.1,.1
MARKER/20, PART=2
JOINT/1, TRANSLATIONAL, I=20, J=11
MOTION/1, JOINT=1, FUNCTION=0.2*SIN(TIME)
GRAPHICS/1, SHELL, RM=10, FILE=L.obj
GRAPHICS/2, ELLIPSOID, CM=20, XSCALE=0.4, YSCALE=0.4, ZSCALE=0.4
RESULTS/
END
";

/// The L: 3 by 3 by 1, with a notch of 2 by 2 from (1, 1).
const L: &str = "\
v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nv 0 0 1\nv 3 0 1\nv 3 1 1\nv 1 1 1\nv 1 3 1\nv 0 3 1
f 4 3 2 1\nf 6 5 4 1\nf 7 8 9 10\nf 7 10 11 12
f 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12
";

#[test]
fn a_concave_shell_is_as_near_as_its_surface_and_what_is_told_of_its_hull_is_said() {
    let distances = |name: &str, model: &str| {
        let model = scratch(name, "notch.adm", model);
        let out = model.with_file_name("out");
        scratch(name, "L.obj", L);
        let run = [
            "run",
            path(&model),
            "--end",
            "1",
            "--steps",
            "10",
            "--out",
            path(&out),
        ];
        let done = cognate(&run);
        assert_eq!(done.code, 0, "{}", done.err);
        let results = out.join("notch.res");
        let done = cognate(&["interference", path(&results), "--json"]);
        assert_eq!(done.code, 0, "{}", done.err);
        let found: serde_json::Value = serde_json::from_str(&done.out).unwrap();
        (
            found["pairs"][0]["nearest"]["distance"].as_f64().unwrap(),
            done.err,
        )
    };
    let (free, said) = distances("interference_notch", NOTCH);
    assert!((free - 0.4).abs() < 1e-6, "{free}");
    assert!(!said.contains("concave"), "{said}");
    // 0.1 into a wall: the depth is that of the hull, which is told
    let into = NOTCH.replace("1.6,1.6,0.5", "1.1,1.6,0.5");
    let (deep, said) = distances("interference_wall", &into);
    assert!(deep <= -0.1, "{deep}");
    assert!(said.contains("GRAPHICS/1 is concave"), "{said}");
}
