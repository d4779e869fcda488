//! Initial conditions of joints and parts: where and how fast a dynamic simulation begins; kinematics and statics do not ask for them.

use crate::running;
use running::{Analysis, Options, first, go, last, session};

/// The values of columns at the beginning, and the warnings.
fn start(text: &str, columns: &[&str], analysis: Analysis) -> (Vec<f64>, Vec<String>) {
    let mut s = session(text, columns, 1e-6);
    go(&mut s, analysis, 0.001, 1);
    let values = columns.iter().map(|c| first(&s, c));
    (values.collect(), s.run.record.warned())
}

fn near(found: &[f64], expected: &[f64]) {
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 1e-9, "{found:?} instead of {expected:?}");
    }
}

#[test]
fn an_initial_condition_that_fits_with_its_numbers_exchanged_is_told() {
    let slide = |ic: &str| {
        let text = format!(
            "PART/2, MASS=1, CM=2, IP=1,1,1, QG=0,0,1.5\nMARKER/2, PART=2\nJOINT/7, TRANSLATIONAL, I=2, J=1, IC={ic}\n"
        );
        start(&text, &["DZ(2,1)", "VZ(2,1)"], Analysis::Dynamic)
    };
    let (found, warnings) = slide("-0.2, 1.4");
    near(&found, &[-0.2, 1.4]);
    assert!(
        warnings
            .iter()
            .any(|w| w.starts_with("JOINT/7: ") && w.contains("stand at 1.5")),
        "{warnings:?}"
    );
    for ic in ["1.4, -0.2", "0.7, 0", "1.4"] {
        let (_, warnings) = slide(ic);
        assert!(warnings.is_empty(), "{ic}: {warnings:?}");
    }
}

#[test]
fn an_initial_condition_that_view_wrote_has_its_velocity_first_wherever_the_parts_stand() {
    let slide = |name: &str, ic: &str| {
        let text = format!(
            "PART/2, MASS=1, CM=2, IP=1,1,1, QG=0,0,1.5\nMARKER/2, PART=2\n{name}JOINT/7, TRANSLATIONAL, I=2, J=1, IC={ic}\n"
        );
        start(&text, &["DZ(2,1)", "VZ(2,1)"], Analysis::Dynamic)
    };
    let named = "!                adams_view_name='slide'\n";
    for (ic, found) in [
        ("-0.2, 1.4", [1.4, -0.2]),
        ("1.4, -0.2", [-0.2, 1.4]),
        ("0.7, 0.1", [0.1, 0.7]),
    ] {
        let (values, warnings) = slide(named, ic);
        near(&values, &found);
        let told = warnings
            .iter()
            .filter(|w| w.contains("as Adams View writes it"));
        assert_eq!(told.count(), 1, "{warnings:?}");
    }
    // a number alone is the displacement, and a zero leaves nothing to be told
    near(&slide(named, "0.7").0, &[0.7, 0.0]);
    let (values, warnings) = slide(named, "0, 0.7");
    near(&values, &[0.7, 0.0]);
    assert!(warnings.is_empty(), "{warnings:?}");
    // written by hand, the displacement is first
    near(&slide("", "-0.2, 1.4").0, &[-0.2, 1.4]);
}

#[test]
fn a_dataset_of_view_is_written_in_the_order_in_which_it_is_read() {
    let model = running::whole(
        "TEST\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n\
         ! adams_view_name='hinge'\nJOINT/1, REVOLUTE, I=2, J=1, IC=2, 30D\n\
         ! adams_view_name='slide'\nJOINT/2, CYLINDRICAL, I=2, J=1, ICTRAN=0.1,0.2, ICROT=3,4\n\
         JOINT/3, REVOLUTE, I=2, J=1, IC=2, 3\nEND\n",
    );
    let (hinge, slide, own) = (&model.joints[&1], &model.joints[&2], &model.joints[&3]);
    assert_eq!(hinge.ic_rotation, [Some(30f64.to_radians()), Some(2.0)]);
    assert_eq!(slide.ic_translation, [Some(0.2), Some(0.1)]);
    assert_eq!(slide.ic_rotation, [Some(4.0), Some(3.0)]);
    assert_eq!(own.ic_rotation, [Some(2.0), Some(3.0)]);
    let again = running::whole(&model.to_text());
    for (id, joint) in &model.joints {
        let back = &again.joints[id];
        assert_eq!(
            (back.ic_translation, back.ic_rotation),
            (joint.ic_translation, joint.ic_rotation)
        );
    }
}

#[test]
fn a_motion_against_an_initial_condition_is_told() {
    let text = |ic: &str| {
        format!(
            "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nJOINT/1, REVOLUTE, I=2, J=1, IC={ic}\n\
             MOTION/1, JOINT=1, ROTATION, FUNCTION=0.5+2*TIME\n"
        )
    };
    for (ic, words) in [
        (
            "0.3, 2",
            "JOINT/1 IC cannot be met: constraints and other initial values leave 0.5 instead of 0.3",
        ),
        (
            "0.5, 3",
            "JOINT/1 IC cannot be met: the constraints leave a velocity of 2",
        ),
    ] {
        let (_, warnings) = start(&text(ic), &["AZ(2,1)"], Analysis::Dynamic);
        assert!(
            warnings.iter().any(|w| w.contains(words)),
            "{ic}: {warnings:?}"
        );
    }
    let (_, warnings) = start(&text("0.5, 2"), &["AZ(2,1)"], Analysis::Dynamic);
    assert!(warnings.iter().all(|w| !w.contains("IC")), "{warnings:?}");
}

#[test]
fn velocities_that_are_rounding_beside_those_of_the_mechanism_are_not_told() {
    // a part held to ground has no velocity; programs write some all the same
    for size in [1e-3, 1.0, 1e3] {
        for speed in [0.0, 1.0, 1e4_f64] {
            for (share, told) in [(2e-16, false), (1e-14, false), (1e-6, true), (1.0, true)] {
                let (v, w) = (share * size * speed.max(1.0), share * speed.max(1.0));
                let text = format!(
                    "PART/2, MASS=1, CM=2, IP=1,1,1, VX={v:e}, VY=-{v:e}, WZ={w:e}\nMARKER/2, PART=2\nJOINT/1, FIXED, I=2, J=1\n\
                     MARKER/3, PART=1, QP={size},0,0\nPART/3, MASS=1, CM=4, IP=1,1,1, QG={size},0,0, WZ={speed}\nMARKER/4, PART=3\n\
                     JOINT/2, REVOLUTE, I=4, J=3\n"
                );
                let (_, warnings) = start(&text, &["AZ(2,1)"], Analysis::Dynamic);
                let number = warnings
                    .iter()
                    .filter(|w| w.contains("cannot be met"))
                    .count();
                assert_eq!(
                    number,
                    if told { 3 } else { 0 },
                    "{size} {speed} {share}: {warnings:?}"
                );
            }
        }
    }
}

#[test]
fn a_turn_that_an_initial_condition_asks_for_is_none_of_assembly() {
    let text =
        "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nJOINT/1, REVOLUTE, I=2, J=1, IC=170D\n";
    let (found, warnings) = start(text, &["AZ(2,1)"], Analysis::Dynamic);
    near(&found, &[170f64.to_radians()]);
    assert!(warnings.is_empty(), "{warnings:?}");
}

/// The angle of a joint begins within half a turn; a spring that was to be wound up is not, and that is told.
#[test]
fn whole_turns_of_initial_angles_are_told() {
    let tau = std::f64::consts::TAU;
    for angle in [3.1, -3.1, 3.2, 7.0, -30.0] {
        for (joint, who) in [
            (
                format!("JOINT/1, REVOLUTE, I=2, J=1, IC={angle}\n"),
                "JOINT/1: IC",
            ),
            (
                format!("JOINT/1, CYLINDRICAL, I=2, J=1, ICROT={angle}\n"),
                "JOINT/1: IC",
            ),
            (
                format!(
                    "JOINT/1, REVOLUTE, I=2, J=1\nMOTION/1, JOINT=1, VELOCITY, ICDISP={angle}, FUNCTION=1\n"
                ),
                "MOTION/1: ICDISP",
            ),
        ] {
            let text = format!("PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n{joint}");
            let (found, warnings) = start(&text, &["AZ(2,1)"], Analysis::Dynamic);
            near(&found, &[angle - tau * (angle / tau).round()]);
            let told = format!("{who} is {}", cognate::results::digits_of_six(angle));
            let is_told = warnings.iter().any(|w| w.contains(&told));
            assert_eq!(is_told, angle.abs() > 3.15, "{joint}: {warnings:?}");
        }
    }
}

/// A four-bar of links 1, 2, 2 on a base of 2, drawn as a square with the crank up; JOINT/4 closes the loop.
fn four_bar(ic: &str) -> String {
    format!(
        "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2, QP=0,0.5,0\nMARKER/21, PART=2\nMARKER/22, PART=2, QP=0,1,0\n\
         PART/3, MASS=1, CM=3, IP=1,1,1, QG=0,1,0\nMARKER/3, PART=3, QP=1,0,0\nMARKER/31, PART=3\nMARKER/32, PART=3, QP=2,0,0\n\
         PART/4, MASS=1, CM=4, IP=1,1,1, QG=2,1,0\nMARKER/4, PART=4, QP=0,-0.5,0\nMARKER/41, PART=4\nMARKER/42, PART=4, QP=0,-1,0\n\
         MARKER/11, PART=1, QP=2,0,0\n\
         JOINT/1, REVOLUTE, I=21, J=1{ic}\nJOINT/2, REVOLUTE, I=31, J=22\nJOINT/3, REVOLUTE, I=41, J=32\n\
         JOINT/4, REVOLUTE, I=42, J=11"
    )
}

#[test]
fn a_pendulum_begins_at_the_angle_and_rate_of_its_joint() {
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2, QP=0,-1,0\nMARKER/3, PART=2\n\
                JOINT/1, REVOLUTE, I=3, J=1, IC=30D,2\nACCGRAV/JGRAV=-9.81\n";
    let columns = ["AZ(3,1)", "WZ(3,1,1)", "DX(2,1)"];
    let (found, warnings) = start(text, &columns, Analysis::Dynamic);
    near(&found, &[30f64.to_radians(), 2.0, 0.5]);
    assert!(warnings.is_empty(), "{warnings:?}");
    let (found, _) = start(text, &columns, Analysis::Static);
    near(&found, &[0.0, 0.0, 0.0]);
}

#[test]
fn a_cylindrical_joint_begins_where_both_its_conditions_say() {
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nJOINT/1, CYLINDRICAL, I=2, J=1, ICTRAN=0.3,-1, ICROT=-20D,4\n";
    let columns = ["DZ(2,1)", "VZ(2,1)", "AZ(2,1)", "WZ(2,1)"];
    let (found, _) = start(text, &columns, Analysis::Dynamic);
    near(&found, &[0.3, -1.0, -20f64.to_radians(), 4.0]);
}

#[test]
fn a_joint_that_closes_a_loop_is_brought_to_its_angle_as_well() {
    for (ic, joint4) in [(", IC=10D,3", ""), ("", ", IC=10D,3")] {
        let text = format!("{}{joint4}\n", four_bar(ic));
        let columns = [
            "AZ(21,1)",
            "WZ(21,1,1)",
            "AZ(42,11)",
            "WZ(42,11,11)",
            "DM(42,11)",
            "DM(22,1)",
        ];
        let (found, warnings) = start(&text, &columns, Analysis::Dynamic);
        // a parallelogram: both cranks turn alike
        let angle = 10f64.to_radians();
        near(&found, &[angle, 3.0, angle, 3.0, 0.0, 1.0]);
        assert!(warnings.iter().all(|w| !w.contains("IC")), "{warnings:?}");
    }
}

#[test]
fn wishes_that_contradict_the_constraints_are_told() {
    let text = format!("{}, IC=25D,0\n", four_bar(", IC=10D,0"));
    let columns = ["AZ(21,1)", "AZ(42,11)"];
    let (found, warnings) = start(&text, &columns, Analysis::Dynamic);
    assert!((found[0] - found[1]).abs() < 1e-9);
    assert!(
        warnings
            .iter()
            .any(|w| w.contains("JOINT/1 IC") || w.contains("JOINT/4 IC")),
        "{warnings:?}"
    );
}

#[test]
fn exact_coordinates_stay_while_the_others_give_way() {
    // a rod of length 1 drawn with its end 0.2 away from the hinge: usually all of it moves
    let rod = |exact: &str| {
        format!(
            "PART/2, MASS=1, CM=2, IP=1,1,1, QG=0.2,0,0{exact}\nMARKER/2, PART=2, QP=1,0,0\nMARKER/3, PART=2\n\
             JPRIM/1, ATPOINT, I=3, J=1\nJPRIM/2, INPLANE, I=2, J=5\nMARKER/5, PART=1, QP=0,0.5,0, REULER=0,90D,0\n"
        )
    };
    // the free end is to lie in the plane y = 0.5, its hinge at the origin: X must give way, unless something else may
    let columns = ["DX(3,1)", "DY(2,1)", "PHI(3,1)+PSI(3,1)"];
    let (found, _) = start(&rod(""), &columns, Analysis::Dynamic);
    near(&found, &[0.0, 0.5, 30f64.to_radians()]);
    let (_, warnings) = start(&rod(", EXACT=X"), &columns, Analysis::Dynamic);
    assert!(
        warnings.iter().any(|w| w.contains("PART/2 EXACT X")),
        "{warnings:?}"
    );
    // two parts tied together: the exact one stays
    let two = |exact: [&str; 2]| {
        format!(
            "PART/2, MASS=1, CM=2, IP=1,1,1, QG=1,0,0{}\nMARKER/2, PART=2\nPART/3, MASS=1, CM=3, IP=1,1,1, QG=2,0,0{}\n\
             MARKER/3, PART=3\nJPRIM/1, ATPOINT, I=2, J=3\n",
            exact[0], exact[1]
        )
    };
    let all = ", EXACT=X:Y:Z:PSI:THETA:PHI";
    for (exact, x) in [([all, ""], 1.0), (["", all], 2.0)] {
        let (found, warnings) = start(&two(exact), &["DX(2,1)", "DX(3,1)"], Analysis::Dynamic);
        near(&found, &[x, x]);
        assert!(
            warnings.iter().all(|w| !w.contains("EXACT")),
            "{warnings:?}"
        );
    }
}

#[test]
fn parts_begin_with_their_velocities_along_the_axes_of_their_markers() {
    let part = "PART/2, MASS=1, CM=2, IP=1,1,1, REULER=90D,0,0, VX=1, VY=2, WZ=3";
    let text = format!("{part}\nMARKER/2, PART=2, REULER=0,90D,0\n");
    let columns = ["VX(2,1)", "VY(2,1)", "WX(2,1)", "WY(2,1)", "WZ(2,1)"];
    let (found, _) = start(&text, &columns, Analysis::Dynamic);
    // the axes of CM are turned by 90° about z, then about its x: its z is ground's x
    near(&found, &[1.0, 2.0, 3.0, 0.0, 0.0]);
    let text = format!(
        "{part}, VM=7, WM=8\nMARKER/2, PART=2\nMARKER/7, PART=1, REULER=90D,0,0\nMARKER/8, PART=1, REULER=0,90D,0\n"
    );
    let (found, _) = start(&text, &columns, Analysis::Dynamic);
    near(&found, &[-2.0, 1.0, 0.0, -3.0, 0.0]);
}

#[test]
fn velocities_of_the_dataset_are_zero_in_statics_and_come_back_afterwards() {
    let text = "PART/2, MASS=1, CM=2, VX=2\nMARKER/2, PART=2, REULER=90D,90D,0\nMARKER/3, PART=1, REULER=90D,90D,0\n\
         JOINT/1, TRANSLATIONAL, I=2, J=3\nSPRINGDAMPER/1, TRANSLATION, I=2, J=4, K=10, LENGTH=1\nMARKER/4, PART=1, QP=-3,0,0\n";
    let mut s = session(text, &["VX(2,1)", "DX(2,1)"], 1e-6);
    go(&mut s, Analysis::Static, 0.0, 1);
    assert_eq!(last(&s, "VX(2,1)"), 0.0);
    go(&mut s, Analysis::Dynamic, 1.0, 1);
    let x = last(&s, "DX(2,1)");
    let omega = 10f64.sqrt();
    assert!((x - (-2.0 + 2.0 / omega * omega.sin())).abs() < 1e-5, "{x}");
}

#[test]
fn a_motion_by_acceleration_begins_as_the_mechanism_does_where_that_is_close_to_a_structure() {
    // two hinges whose axes are 3 cm apart make a structure, whether something is driven elsewhere or not
    let door = "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2, QP=1,0,0.5\nMARKER/11, PART=1\nMARKER/44, PART=2\n\
                MARKER/14, PART=1, QP=3E-2,0,1\nMARKER/22, PART=2, QP=3E-2,0,1\n\
                JOINT/1, REVOLUTE, I=44, J=11\nJOINT/2, REVOLUTE, I=22, J=14\n";
    let crank = "PART/9, MASS=1, CM=90, IP=1,1,1, QG=5,0,0, WZ=2\nMARKER/90, PART=9\nMARKER/91, PART=1, QP=5,0,0\n\
                 JOINT/9, REVOLUTE, I=90, J=91\nMOTION/9, JOINT=9, ROTATION, ACCELERATION, FUNCTION=1\n";
    for text in [crank.to_string(), format!("{door}{crank}")] {
        let (found, _) = start(&text, &["WZ(90,91)"], Analysis::Dynamic);
        near(&found, &[2.0]);
    }
}

/// Two rods in a row, the first begins to turn at 3 rad/s; `unit`: how many units of length a metre is, `at`: where the first hinge
/// is, in metres; `begins`: what makes it turn.
fn rods(unit: f64, at: [f64; 2], second: &str, begins: &str) -> String {
    let [x, y] = at.map(|x| x * unit);
    let (long, half, inertia) = (unit, 0.5 * unit, 0.1 * unit * unit);
    format!(
        "PART/2, MASS=1, CM=20, IP={inertia},{inertia},{inertia}, QG={x},{y},0\nMARKER/20, PART=2, QP={half},0,0\nMARKER/21, PART=2\n\
         MARKER/22, PART=2, QP={long},0,0\nMARKER/11, PART=1, QP={x},{y},0\n\
         PART/3, {}, QG={},{y},0\nMARKER/30, PART=3, QP={half},0,0\nMARKER/31, PART=3\n\
         JOINT/1, REVOLUTE, I=21, J=11{begins}\nJOINT/2, REVOLUTE, I=31, J=22\n",
        second.replace("INERTIA", &format!("{inertia},{inertia},{inertia}")),
        x + long
    )
}

#[test]
fn what_nobody_gives_a_velocity_begins_as_if_the_rest_were_struck_whatever_the_units_and_the_place()
{
    // the second rod turns as its blow at the end demands: m c (ω L + c w) + I w = 0
    let (m, c, inertia) = (2.0, 0.5, 0.1);
    let struck = -3.0 * m * c / (m * c * c + inertia);
    let motion = "\nMOTION/1, JOINT=1, ROTATION, FUNCTION=3*TIME";
    for begins in [", IC=0,3", motion] {
        for (unit, at) in [
            (1.0, [0.0, 0.0]),
            (1000.0, [0.0, 0.0]),
            (0.01, [0.0, 0.0]),
            (1.0, [1000.0, -300.0]),
        ] {
            let text = rods(unit, at, "MASS=2, CM=30, IP=INERTIA", begins);
            let columns = ["WZ(20)", "WZ(30)"];
            let (found, warnings) = start(&text, &columns, Analysis::Dynamic);
            near(&found, &[3.0, struck]);
            assert!(warnings.is_empty(), "{warnings:?}");
        }
    }
}

#[test]
fn velocities_that_contradict_are_met_as_far_as_may_be_in_any_units() {
    // a hinge does not let the mass move along its rod: 3 rad/s would be 1.5 across, not 1
    let mut all = Vec::new();
    for unit in [1.0, 1000.0, 0.01] {
        let text = rods(unit, [0.0; 2], "MASS=2, CM=30, IP=INERTIA", "").replace(
            "PART/2, MASS=1",
            &format!("PART/2, VY={unit}, WZ=3, MASS=1"),
        );
        let (found, warnings) = start(&text, &["WZ(20)", "WZ(30)"], Analysis::Dynamic);
        assert_eq!(warnings.len(), 2, "{warnings:?}");
        all.push(found);
    }
    near(&all[1], &all[0]);
    near(&all[2], &all[0]);
    assert!(all[0][0] > 2.0 && all[0][0] < 3.0, "{all:?}");
}

#[test]
fn a_session_begins_anew_with_the_velocities_of_its_masses() {
    let text = |m: f64| {
        rods(
            1.0,
            [0.0; 2],
            &format!("MASS={m}, CM=30, IP=INERTIA"),
            ", IC=0,3",
        )
    };
    let struck = |m: f64| -3.0 * m * 0.5 / (m * 0.25 + 0.1);
    let options = Options {
        keep_start: true,
        ..running::options(&["WZ(30)"], 1e-6)
    };
    let mut session = running::begin(running::model(&text(2.0)), "rods", options);
    for m in [2.0, 3.0, 2.0, 5.0] {
        session.reset();
        session.model.parts.entry(3).or_default().mass = m;
        go(&mut session, Analysis::Dynamic, 0.01, 1);
        near(&[first(&session, "WZ(30)")], &[struck(m)]);
    }
}

/// A slider-crank drawn at any angle, with a motion that begins at another: the mechanism is driven there along its branch,
/// and the motion is named.
#[test]
fn a_motion_that_begins_elsewhere_drives_the_mechanism_along_its_branch() {
    for side in [1.0_f64, -1.0] {
        for k in -8..=8 {
            let drawn = 0.35 * f64::from(k);
            let (x, y) = (drawn.cos(), drawn.sin());
            let rod = -(0.5 * y).asin();
            let rod = if side > 0.0 {
                rod
            } else {
                std::f64::consts::PI - rod
            };
            let slider = x + 2.0 * rod.cos();
            for begins in [0.0_f64, 0.9, -2.5] {
                let text = format!(
                    "MARKER/14, PART=1, REULER=90D,90D,0\nPART/2, MASS=1, CM=21, IP=1,1,1, REULER={drawn:?},0,0\n\
                     MARKER/21, PART=2\nMARKER/22, PART=2, QP=1,0,0\n\
                     PART/3, MASS=1, CM=31, IP=1,1,1, QG={x:?},{y:?},0, REULER={rod:?},0,0\n\
                     MARKER/31, PART=3\nMARKER/32, PART=3, QP=2,0,0\n\
                     PART/4, MASS=1, CM=40, IP=1,1,1, QG={slider:?},0,0\nMARKER/40, PART=4\n\
                     MARKER/41, PART=4, REULER=90D,90D,0\nJOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=22\n\
                     JOINT/3, REVOLUTE, I=32, J=40\nJOINT/4, TRANSLATIONAL, I=41, J=14\n\
                     MOTION/1, JOINT=1, ROTATION, FUNCTION={begins:?}+TIME\n"
                );
                let expected = begins.cos() + side * (4.0 - begins.sin().powi(2)).sqrt();
                for analysis in [Analysis::Kinematic, Analysis::Dynamic] {
                    let (found, said) = start(&text, &["DX(40,1)"], analysis);
                    assert!(
                        (found[0] - expected).abs() < 1e-9,
                        "{drawn} {begins}: {found:?} {expected}"
                    );
                    let named = said.iter().any(|s| s.starts_with("MOTION/1 begins"));
                    let by = (begins - drawn + 3.0 * std::f64::consts::PI)
                        .rem_euclid(std::f64::consts::TAU);
                    let far = (by - std::f64::consts::PI).abs() > 0.0175;
                    assert_eq!(named, far, "{drawn} {begins}: {said:?}");
                }
            }
        }
    }
}
