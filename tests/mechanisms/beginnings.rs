//! Comment lines of ours: initial values of joints and markers, and parts that are one rigid body.

use crate::running;
use cognate::analysis::verify::verify;
use cognate::dataset::read_text;
use running::{Analysis, GROUND, first, go, last, model, session, values};

/// The values of columns at the beginning of a dynamic simulation, and the warnings.
fn start(text: &str, columns: &[&str]) -> (Vec<f64>, Vec<String>) {
    let mut s = session(text, columns, 1e-9);
    go(&mut s, Analysis::Dynamic, 0.001, 1);
    let values = columns.iter().map(|c| first(&s, c));
    (values.collect(), s.run.record.warned())
}

fn near(found: &[f64], expected: &[f64]) {
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 1e-9, "{found:?} instead of {expected:?}");
    }
}

/// Codes of what is said about a dataset.
fn said(text: &str) -> Vec<(&'static str, String)> {
    let reading = read_text(&format!("{GROUND}{text}END\n"));
    let all = reading.diagnostics.into_iter();
    all.map(|d| (d.code, d.to_string())).collect()
}

const PLANAR: &str =
    "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nJOINT/1, PLANAR, I=2, J=1\n";

#[test]
fn every_variable_of_a_joint_begins_with_its_value_and_its_rate() {
    let text = format!(
        "{PLANAR}! cognate: IC JOINT/1, X=0.3, X_RATE=2, Y=-0.4, Y_RATE=0.5, ANGLE=30D, ANGLE_RATE=-1.5\n"
    );
    let columns = [
        "DX(2,1)", "DY(2,1)", "AZ(2,1)", "VX(2,1)", "VY(2,1)", "WZ(2,1)",
    ];
    let (found, warnings) = start(&text, &columns);
    near(&found, &[0.3, -0.4, 30f64.to_radians(), 2.0, 0.5, -1.5]);
    assert!(warnings.is_empty(), "{warnings:?}");
}

#[test]
fn a_universal_joint_begins_with_the_angles_of_its_pins() {
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nMARKER/3, PART=2, REULER=0D,90D,0D\nJOINT/1, UNIVERSAL, I=3, J=1\n\
                ! cognate: IC JOINT/1, ANGLE_1=20D, ANGLE_2=-15D, ANGLE_1_RATE=1, ANGLE_2_RATE=0.5\n";
    let mut s = session(text, &["TIME"], 1e-10);
    go(&mut s, Analysis::Dynamic, 0.001, 1);
    assert!(
        s.run.record.warned().is_empty(),
        "{:?}",
        s.run.record.warned()
    );
    // the same asked of the joint's variables, which are results in degrees
    let mut options = running::options(&[], 1e-10);
    options.full = true;
    let mut s = running::begin(model(text), "full", options);
    go(&mut s, Analysis::Dynamic, 0.001, 1);
    let angles = [1, 2].map(|k| first(&s, &format!("JOINT_1_VARIABLES.ANGLE_{k}")));
    near(&angles, &[20.0, -15.0]);
}

#[test]
fn a_marker_begins_where_and_as_fast_as_its_line_says() {
    let text = "PART/2, MASS=1, CM=2, IP=1,2,3\nMARKER/2, PART=2\nMARKER/3, PART=2, QP=1,0,0, REULER=0D,90D,0D\n\
                ! cognate: IC MARKER/3, X=2, Y=1, Z=-1, PSI=0, THETA=90D, PHI=0, VX=1, VY=2, VZ=3, WX=0.1, WY=0.2, WZ=0.3\n";
    let columns = [
        "DX(3,1)",
        "DY(3,1)",
        "DZ(3,1)",
        "THETA(3,1)",
        "VX(3,1)",
        "VY(3,1)",
        "VZ(3,1)",
        "WX(3,1)",
        "WY(3,1)",
        "WZ(3,1)",
    ];
    let (found, warnings) = start(text, &columns);
    near(
        &found,
        &[
            2.0,
            1.0,
            -1.0,
            90f64.to_radians(),
            1.0,
            2.0,
            3.0,
            0.1,
            0.2,
            0.3,
        ],
    );
    assert!(warnings.is_empty(), "{warnings:?}");
}

/// Angles that have no slope where the marker is drawn (θ = 0) are met as any others are, and half a turn is.
#[test]
fn a_marker_begins_with_angles_that_have_no_slope_where_it_is_drawn() {
    let columns = ["RTOD*PSI(2,1)", "RTOD*THETA(2,1)", "RTOD*PHI(2,1)"];
    for [psi, theta, phi] in [
        [10.0, 20.0, 30.0],
        [170.0, 130.0, -100.0],
        [-40.0, 179.0, 80.0],
        [90.0, 90.0, 90.0],
        [45.0, 180.0, 0.0],
    ] {
        let text = format!(
            "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n\
             ! cognate: IC MARKER/2, PSI={psi}D, THETA={theta}D, PHI={phi}D\n"
        );
        let (found, warnings) = start(&text, &columns);
        assert!(warnings.is_empty(), "{psi} {theta} {phi}: {warnings:?}");
        let between = |a: f64, b: f64| ((a - b + 180.0).rem_euclid(360.0) - 180.0).abs();
        assert!((found[1] - theta).abs() < 1e-5, "{found:?}");
        // the other two have no values of their own at half a turn
        let has_others = theta < 180.0;
        let off = between(found[0], psi).max(between(found[2], phi));
        assert!(!has_others || off < 1e-5, "{found:?} {psi} {phi}");
    }
    // one alone, where parts are drawn without any
    let text =
        "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n! cognate: IC MARKER/2, THETA=50D\n";
    let (found, warnings) = start(text, &columns);
    near(&found, &[0.0, 50.0, 0.0]);
    assert!(warnings.is_empty(), "{warnings:?}");
    // half a turn of a hinge
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nJOINT/1, REVOLUTE, I=2, J=1\n\
                ! cognate: IC MARKER/2, PSI=180D\n";
    let (found, warnings) = start(text, &columns);
    assert!(
        (found[0].abs() - 180.0).abs() < 1e-9 && warnings.is_empty(),
        "{found:?} {warnings:?}"
    );
}

/// The angles between the axes of a ball's markers, which results show, are initial values too.
#[test]
fn a_ball_begins_with_the_angles_that_its_results_show() {
    let ball = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2, REULER=0D,40D,0D\nJOINT/1, SPHERICAL, I=2, J=1\n";
    // of turns by 60 deg about x and about (1, 1, 1), half a turn about z, and none
    let third = f64::acos(2.0 / 3.0).to_degrees();
    for angles in [[0.0, 60.0, 60.0], [third; 3], [180.0, 180.0, 0.0], [0.0; 3]] {
        let [x, y, z] = angles;
        let text = format!("{ball}! cognate: IC JOINT/1, X={x}D, Y={y}D, Z={z}D\n");
        let mut options = running::options(&[], 1e-10);
        options.full = true;
        let mut s = running::begin(model(&text), "ball", options);
        go(&mut s, Analysis::Dynamic, 0.001, 1);
        let warned = s.run.record.warned();
        assert!(warned.is_empty(), "{angles:?}: {warned:?}");
        for (name, wanted) in ["X", "Y", "Z"].into_iter().zip(angles) {
            let found = first(&s, &format!("JOINT_1_VARIABLES.{name}"));
            assert!(
                (found - wanted).abs() < 1e-5,
                "{name}: {found} instead of {wanted}"
            );
        }
    }
    let refused = |line: &str| {
        let text = format!("UNITS/SYSTEM=MKS\n{GROUND}{ball}{line}END\n");
        let model = cognate::model::Model::from_text(&text);
        let said = model
            .and_then(|m| m.checked().map(|_| m.title.clone()))
            .unwrap_err();
        format!("{said:?}")
    };
    assert!(refused("! cognate: IC JOINT/1, X=0D, Y=60D\n").contains("are given or none"));
    assert!(refused("! cognate: IC JOINT/1, X=0D, Y=60D, Z=90D\n").contains("no turn has these"));
}

#[test]
fn a_marker_moves_its_mechanism_as_a_joint_would() {
    // a crank of length 1, drawn at 20°: the tip at 60°, moving up by 1: ω = 1/cos 60°
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1, REULER=20D,0D,0D\nMARKER/2, PART=2\nMARKER/3, PART=2, QP=1,0,0\nJOINT/1, REVOLUTE, I=2, J=1\n\
                ! cognate: IC MARKER/3, X=0.5, VY=1\n";
    let (found, warnings) = start(text, &["DX(3,1)", "WZ(2,1)", "DM(3,1)"]);
    assert!(
        (found[0] - 0.5).abs() < 1e-9
            && (found[1].abs() - 2.0).abs() < 1e-8
            && (found[2] - 1.0).abs() < 1e-9,
        "{found:?}"
    );
    assert!(warnings.is_empty(), "{warnings:?}");
}

#[test]
fn constraints_win_over_initial_values_with_a_warning() {
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nMARKER/3, PART=2, QP=1,0,0\nJOINT/1, REVOLUTE, I=2, J=1\n\
                ! cognate: IC MARKER/3, X=3, VZ=1\n";
    let (found, warnings) = start(text, &["DM(3,1)", "VZ(3,1)"]);
    near(&found, &[1.0, 0.0]);
    for of in ["MARKER/3 X cannot be met", "MARKER/3 VZ cannot be met"] {
        assert!(warnings.iter().any(|w| w.starts_with(of)), "{warnings:?}");
    }
}

/// Of values that contradict each other both are told, and no constraint is blamed that there is not.
#[test]
fn initial_values_that_contradict_each_other_are_both_told() {
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nMARKER/3, PART=2, QP=1,0,0\n\
                ! cognate: IC MARKER/2, X=1\n! cognate: IC MARKER/3, X=5\n";
    let (found, warnings) = start(text, &["DX(2,1)"]);
    near(&found, &[2.5]);
    for (marker, rest) in [(2, "leave 2.5 instead of 1"), (3, "leave 3.5 instead of 5")] {
        let begins =
            format!("MARKER/{marker} X cannot be met: constraints and other initial values {rest}");
        assert!(warnings.contains(&begins), "{begins}: {warnings:?}");
    }
}

#[test]
fn statics_do_not_ask_for_initial_places() {
    let text = "ACCGRAV/KGRAV=-10\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=2, J=1\n\
                SPRINGDAMPER/1, TRANSLATIONAL, I=2, J=9, K=100, LENGTH=1\nMARKER/9, PART=1, QP=0,0,1\n\
                ! cognate: IC JOINT/1, DISTANCE=0.4\n";
    let mut s = session(text, &["DZ(2,1)"], 1e-9);
    running::rest(&mut s);
    assert!((last(&s, "DZ(2,1)") + 0.1).abs() < 1e-6);
}

#[test]
fn a_model_writes_its_lines_and_reads_them_back() {
    let text = format!(
        "{PLANAR}! cognate: IC JOINT/1, X=0.3, ANGLE_RATE=-1.5\n! cognate: IC MARKER/2, VZ=1e-7\n"
    );
    let first = model(&text);
    assert_eq!(first.beginnings.len(), 2);
    let again = running::whole(&first.to_text());
    assert_eq!(again.beginnings, first.beginnings);
    assert_eq!(again.to_text(), first.to_text());
}

#[test]
fn lines_that_mean_nothing_are_told_with_what_there_is() {
    for (line, code, answer) in [
        ("IC JOINT/1, Z=1", "bad_extension", "it has X, X_RATE, Y"),
        (
            "IC JOINT/7, X=1",
            "unknown_element",
            "JOINT/7 does not exist",
        ),
        ("IC JOINT/1, X=1, X=2", "given_twice", "X of JOINT/1"),
        ("IC JOINT/1, X=a", "bad_extension", "a number is expected"),
        ("IC PART/2, X=1", "bad_extension", "joints and markers"),
        ("IC JOINT/1", "bad_extension", "no initial values"),
        ("RIGGID a = PART/2", "bad_extension", "is no line of ours"),
        ("RIGID a", "bad_extension", "a rigid body is"),
        ("RIGID a = PART/2", "rigid_body", "at least two parts"),
        (
            "RIGID a = PART/2, PART/9",
            "unknown_element",
            "PART/9 does not exist",
        ),
        ("RIGID a = PART/2, MARKER/2", "rigid_body", "is no PART"),
    ] {
        let found = said(&format!("{PLANAR}! cognate: {line}\n"));
        let told = found
            .iter()
            .any(|(c, text)| *c == code && text.contains(answer) && text.contains("7:"));
        assert!(told, "{line}: {found:?}");
    }
}

/// Two bars of a double pendulum, free at the pin between them.
const BARS: &str = "\
PART/2, MASS=2, CM=20, IP=0.1,0.1,0.1, REULER=0D,90D,0D
MARKER/20, PART=2, QP=0,0,-0.5
MARKER/21, PART=2, REULER=0D,-90D,0D
MARKER/22, PART=2, QP=0,0,-1, REULER=0D,-90D,0D
PART/3, MASS=1, CM=30, IP=0.05,0.05,0.05, QG=0,1,0, REULER=30D,90D,0D
MARKER/30, PART=3, QP=0,0,-0.3
MARKER/31, PART=3
JOINT/1, REVOLUTE, I=21, J=1
JOINT/2, SPHERICAL, I=31, J=22
ACCGRAV/IGRAV=-9.81
";

#[test]
fn parts_of_a_rigid_body_move_as_one_part_does() {
    let rigid = format!("{BARS}! cognate: RIGID arm = PART/2, PART/3\n");
    let columns = [
        "DX(20,1)",
        "DY(20,1)",
        "DX(30,1)",
        "DY(30,1)",
        "DZ(30,20,20)",
        "DX(30,20,20)",
    ];
    let moved = |text: &str| {
        let mut s = session(text, &columns, 1e-10);
        go(&mut s, Analysis::Dynamic, 1.0, 20);
        s
    };
    let a = moved(&rigid);
    for c in ["DZ(30,20,20)", "DX(30,20,20)"] {
        let along = values(&a, c);
        assert!(
            along.iter().all(|x| (x - along[0]).abs() < 1e-12),
            "{along:?}"
        );
    }
    let energy = a.run.record.energy;
    assert!(energy.error() < 1e-8 && last(&a, "DX(20,1)") != first(&a, "DX(20,1)"));
    // the joint within is told, and does nothing
    let told = said(&rigid);
    assert!(
        told.iter()
            .any(|(c, text)| *c == "rigid_body" && text.contains("JOINT/2")),
        "{told:?}"
    );
    assert!(
        told.iter().all(|(_, text)| !text.contains("error[")),
        "{told:?}"
    );
}

#[test]
fn a_rigid_body_with_ground_stands_and_one_is_written_as_joints() {
    let text = format!("{BARS}! cognate: RIGID base = PART/1, PART/2\n");
    let mut s = session(&text, &["DX(20,1)"], 1e-9);
    go(&mut s, Analysis::Dynamic, 0.5, 5);
    assert_eq!(last(&s, "DX(20,1)"), first(&s, "DX(20,1)"));
    let written = model(&text).to_text();
    assert!(
        written.contains("adams_view_name='base_2'") && written.contains(", FIXED"),
        "{written}"
    );
}

/// A model with rigid bodies is written with their lines: reading it again gives the same model, whatever else is in it,
/// and nothing is fixed twice.
#[test]
fn rigid_bodies_are_read_again_as_they_were_written() {
    let third = "PART/4, MASS=1, CM=40, IP=1,1,1, QG=3,0,0\nMARKER/40, PART=4\nMARKER/41, PART=4\nMARKER/32, PART=3, QP=0,0,-1\n\
                 JOINT/3, FIXED, I=32, J=22\nJPRIM/1, INLINE, I=31, J=22\nJOINT/7, SPHERICAL, I=40, J=32\n";
    for lines in [
        "! cognate: RIGID arm = PART/2, PART/3\n",
        "! cognate: RIGID base = PART/1, PART/2\n",
        "! cognate: RIGID b a = PART/3, PART/2\n! cognate: IC MARKER/20, VX=1\n",
        "! cognate: RIGID a = PART/2, PART/3\n! cognate: RIGID b = PART/4, PART/1\n",
        "! cognate: RIGID a = PART/2, PART/3, PART/4, PART/1\n",
    ] {
        let once = model(&format!("{BARS}{third}{lines}"));
        let text = once.to_text();
        let again = running::whole(&text);
        assert_eq!(again.to_text(), text, "{lines}");
        assert_eq!(again.inactive, once.inactive, "{lines}");
        assert_eq!(again.rigid_bodies, once.rigid_bodies, "{lines}");
        let counted =
            |model: &cognate::model::Model| verify(model).map(|v| (v.freedom, v.dependent.len()));
        let (a, b) = (counted(&once).unwrap(), counted(&again).unwrap());
        assert_eq!(a, b, "{lines}");
        let reading = read_text(&text);
        let formatted = running::whole(&reading.dataset.formatted());
        assert_eq!(formatted.to_text(), text, "{lines}");
    }
}

/// At its dead point the slider of a slider-crank does not yield to first order: what a line asks of it is told by name.
#[test]
fn what_a_line_asks_for_in_vain_at_a_singular_start_is_told_by_name() {
    let crank = "MARKER/11, PART=1, REULER=90D,90D,0D\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2, QP=0.5,0,0\n\
                 MARKER/21, PART=2\nMARKER/22, PART=2, QP=1,0,0\nPART/3, MASS=1, CM=30, IP=1,1,1\nMARKER/30, PART=3, QP=2,0,0\n\
                 MARKER/31, PART=3, QP=1,0,0\nMARKER/32, PART=3, QP=3,0,0\nPART/4, MASS=1, CM=40, IP=1,1,1\n\
                 MARKER/40, PART=4, QP=3,0,0\nMARKER/41, PART=4, QP=3,0,0, REULER=90D,90D,0D\nJOINT/1, REVOLUTE, I=21, J=1\n\
                 JOINT/2, REVOLUTE, I=31, J=22\nJOINT/3, REVOLUTE, I=40, J=32\nJOINT/4, TRANSLATIONAL, I=41, J=11\n";
    for line in [
        "JOINT/4, DISTANCE=2.8",
        "JOINT/4, DISTANCE_RATE=1",
        "MARKER/40, X=2.9",
        "MARKER/40, VX=1",
    ] {
        let (_, warned) = start(&format!("{crank}! cognate: IC {line}\n"), &["DX(40,1)"]);
        let (element, quantity) = line.split_once(", ").unwrap();
        let quantity = quantity.split('=').next().unwrap();
        let begins = format!("{element} {quantity} cannot be met");
        assert!(
            warned.iter().any(|w| w.starts_with(&begins)),
            "{line}: {warned:?}"
        );
    }
}

/// A four-bar whose bars all lie along x: crank `a`, coupler `d`, rocker `a`, ground `d`.
fn flat_parallelogram([a, d]: [f64; 2], of_crank: &str, of_coupler: &str, line: &str) -> String {
    format!(
        "MARKER/11, PART=1, QP={d},0,0\nPART/2, MASS=1, CM=20, IP=1,1,1{of_crank}\nMARKER/20, PART=2\n\
         MARKER/21, PART=2, QP={a},0,0\nPART/3, MASS=1, CM=30, QG={a},0,0, IP=1,1,1{of_coupler}\nMARKER/30, PART=3\n\
         MARKER/31, PART=3, QP={d},0,0\nPART/4, MASS=1, CM=40, QG={d},0,0, IP=1,1,1\nMARKER/40, PART=4\n\
         MARKER/41, PART=4, QP={a},0,0\nJOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, REVOLUTE, I=30, J=21\n\
         JOINT/3, REVOLUTE, I=41, J=31\nJOINT/4, REVOLUTE, I=40, J=11\n{line}"
    )
}

/// Where branches meet, rows of first order permit more than any motion can have: what is given is met along a branch.
#[test]
fn a_speed_that_is_given_where_branches_meet_is_met_along_one_of_them() {
    let mut seed: u64 = 12;
    let columns = ["WZ(20)", "WZ(30)", "WZ(40)"];
    for k in 0..12 {
        let mut between = |low: f64, high: f64| {
            seed = (seed.wrapping_mul(6364136223846793005)).wrapping_add(1442695040888963407);
            low + (high - low) * (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        let ([a, d], w) = ([between(0.3, 2.0), between(0.3, 2.0)], between(0.5, 5.0));
        // the crossed branch: second order of the rows, ω = 2 w/(1 − d/a)
        let crossed = 2.0 * w / (1.0 - d / a);
        let line = format!("! cognate: IC JOINT/1, ANGLE_RATE={w}\n");
        let (given, twin) = (format!(", WZ={w}"), format!(", WZ={crossed}"));
        for (text, coupler) in [
            (flat_parallelogram([a, d], "", "", &line), 0.0),
            (flat_parallelogram([a, d], &given, "", ""), 0.0),
            (flat_parallelogram([a, d], &given, &twin, ""), crossed),
        ] {
            let mut s = session(&text, &columns, 1e-8);
            go(&mut s, Analysis::Dynamic, 0.2 / w, 4);
            let found: Vec<f64> = columns.iter().map(|c| first(&s, c)).collect();
            let expected = [w, coupler, w + d * coupler / a];
            for (found, expected) in found.iter().zip(expected) {
                let off = (found - expected).abs();
                assert!(
                    off < 1e-7 * (w + crossed.abs()),
                    "{k}: {found} for {expected} of {text}"
                );
            }
            let cannot = |w: &String| w.contains("cannot be met");
            assert!(!s.run.record.warned().iter().any(cannot), "{text}");
        }
    }
}

#[test]
fn a_rigid_body_is_not_in_another_and_a_part_in_one_alone() {
    for (lines, answer) in [
        (
            "! cognate: RIGID hand = PART/2, PART/3\n! cognate: RIGID arm = PART/1, hand\n",
            "hand, which is in it, is rigid already",
        ),
        (
            "! cognate: RIGID a = PART/1, PART/2\n! cognate: RIGID b = PART/2, PART/3\n",
            "PART/2 is in the rigid body a",
        ),
        ("! cognate: RIGID a = PART/2, PART/2\n", "is named twice"),
        (
            "! cognate: RIGID a = PART/1, PART/2\nMOTION/1, JOINT=1, ROTATION, FUNCTION=TIME\n",
            "it moves parts of the rigid body a",
        ),
    ] {
        let found = said(&format!("{BARS}{lines}"));
        let told = found
            .iter()
            .any(|(c, text)| *c == "rigid_body" && text.contains(answer));
        assert!(told, "{lines}: {found:?}");
    }
}
