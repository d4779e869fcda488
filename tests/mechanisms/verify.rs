//! What is said about freedoms: in which words, about which elements, and where a position is special.

use crate::running;

use cognate::analysis::verify::{Verification, verify};
use cognate::model::ElementKind;
use running::{Analysis, Options, begin, go, whole};

fn verified(text: &str) -> Verification {
    verify(&whole(text)).unwrap_or_else(|e| panic!("{e:?}\n{text}"))
}

/// Four points in the plane z = 0, hinged about z.
fn four_bar(points: [[f64; 2]; 4], more: &str) -> String {
    let [a, b, c, d] = points.map(|p| format!("{},{},0", p[0], p[1]));
    format!(
        "FOUR-BAR\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1\nPART/3, MASS=1, CM=30, IP=1,1,1\nPART/4, MASS=1, CM=40, IP=1,1,1\n\
         MARKER/20, PART=2\nMARKER/30, PART=3\nMARKER/40, PART=4\n\
         MARKER/11, PART=1, QP={a}\nMARKER/21, PART=2, QP={a}\nMARKER/22, PART=2, QP={b}\nMARKER/32, PART=3, QP={b}\n\
         MARKER/33, PART=3, QP={c}\nMARKER/43, PART=4, QP={c}\nMARKER/44, PART=4, QP={d}\nMARKER/14, PART=1, QP={d}\n\
         JOINT/1, REVOLUTE, I=21, J=11\nJOINT/2, REVOLUTE, I=32, J=22\nJOINT/3, REVOLUTE, I=43, J=33\nJOINT/4, REVOLUTE, I=44, J=14\n\
         {more}END\n"
    )
}

#[test]
fn a_dependent_row_names_the_loop_and_the_direction() {
    let v = verified(&four_bar(
        [[0.0, 0.0], [0.0, 1.0], [3.0, 2.0], [3.0, 0.0]],
        "",
    ));
    assert_eq!((v.gruebler, v.freedom, v.dependent.len()), (-2, Some(1), 3));
    let words: Vec<String> = v.dependent.iter().map(|d| d.sentence()).collect();
    // the joint that closes the loop is named, the other three fix the same
    for direction in [
        "translation along ground Z",
        "rotation about ground X",
        "rotation about ground Y",
    ] {
        assert!(
            words
                .iter()
                .any(|w| w.contains(&format!("fixes {direction}, already fixed by JOINT/"))),
            "{direction}: {words:?}"
        );
    }
    for d in &v.dependent {
        let mut all = d.fixed_by.clone();
        all.push(d.element);
        all.sort();
        assert_eq!(all, [1, 2, 3, 4].map(|n| ElementKind::Joint.id(n)));
    }
    // four joints, each with a force along z and torques about x and y that nothing determines
    assert_eq!(v.undetermined.len(), 4);
    for u in &v.undetermined {
        assert_eq!(u.components, ["FZ", "TX", "TY"], "{}", u.element);
    }
    assert!(v.advice[0].to_string().contains("INLINE"), "{:?}", v.advice);
}

/// The advice is true: with it nothing is redundant and the freedom is the same.
#[test]
fn advice_removes_what_is_redundant() {
    let text = four_bar([[0.0, 0.0], [0.0, 1.0], [3.0, 2.0], [3.0, 0.0]], "");
    let v = verified(&text);
    let closing = &v.dependent[0].element;
    let line = text
        .lines()
        .find(|l| l.starts_with(&format!("{closing},")))
        .unwrap();
    let better = line.replace(&format!("{closing}, REVOLUTE"), "JPRIM/1, INLINE");
    let after = verified(&text.replace(line, &better));
    assert_eq!(
        (after.gruebler, after.freedom, after.dependent.len()),
        (1, Some(1), 0)
    );
}

#[test]
fn a_folded_parallelogram_has_a_second_freedom_there_and_only_there() {
    let v = verified(&four_bar(
        [[0.0, 0.0], [1.0, 0.0], [4.0, 0.0], [3.0, 0.0]],
        "",
    ));
    assert_eq!((v.freedom, v.freedom_nearby), (Some(2), Some(1)));
    assert_eq!(v.dependent.len(), 4);
    let here: Vec<_> = v.dependent.iter().filter(|d| d.only_here).collect();
    assert_eq!(here.len(), 1);
    assert!(
        here[0].sentence().contains("at this position only"),
        "{}",
        here[0].sentence()
    );
    assert_eq!(v.free.len(), 2);
}

#[test]
fn a_driven_slider_at_its_dead_point_is_free_to_first_order() {
    // crank 1 and rod 2 in line; the slider is driven
    let text = "DEAD POINT\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1\nPART/3, MASS=1, CM=30, IP=1,1,1\nPART/4, MASS=1, CM=40, IP=1,1,1\n\
        MARKER/20, PART=2\nMARKER/30, PART=3\nMARKER/40, PART=4, QP=3,0,0, REULER=90D,90D,0\n\
        MARKER/11, PART=1\nMARKER/22, PART=2, QP=1,0,0\nMARKER/32, PART=3, QP=1,0,0\nMARKER/33, PART=3, QP=3,0,0\n\
        MARKER/43, PART=4, QP=3,0,0\nMARKER/14, PART=1, REULER=90D,90D,0\n\
        JOINT/1, REVOLUTE, I=20, J=11\nJOINT/2, REVOLUTE, I=32, J=22\nJOINT/3, REVOLUTE, I=43, J=33\nJOINT/4, TRANSLATIONAL, I=40, J=14\n\
        MOTION/1, JOINT=4, TRANSLATION, FUNCTION=3-TIME\nEND\n";
    let v = verified(text);
    assert_eq!((v.freedom, v.freedom_nearby), (Some(1), Some(0)));
    let here: Vec<_> = v.dependent.iter().filter(|d| d.only_here).collect();
    assert_eq!(here.len(), 1, "{:?}", v.dependent);
}

#[test]
fn free_directions_are_told_as_motions() {
    let text = "FREE\nPART/1, GROUND\nPART/3, MASS=1, CM=30, IP=1,1,1, QG=1,2,3, REULER=30D,40D,0\nMARKER/30, PART=3\n\
        MARKER/10, PART=1, QP=1,2,3, REULER=30D,40D,0\nJOINT/1, TRANSLATIONAL, I=30, J=10\nEND\n";
    let v = verified(text);
    assert_eq!(v.free[0].words, "PART/3 slides along its Z");
    let hinge = verified(&text.replace("TRANSLATIONAL", "REVOLUTE"));
    assert_eq!(
        hinge.free[0].words,
        "PART/3 turns about its Z through (1, 2, 3)"
    );
    let both = verified(&text.replace("TRANSLATIONAL", "CYLINDRICAL"));
    let words: Vec<&str> = both.free.iter().map(|f| f.words.as_str()).collect();
    assert_eq!(
        words,
        [
            "PART/3 slides along its Z",
            "PART/3 turns about its Z through (1, 2, 3)"
        ]
    );
}

/// A rod between two balls turns about its own axis, beside what the mechanism does.
#[test]
fn a_rod_between_two_balls_spins_alone() {
    let text = "SPIN\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=3,4,0\n\
        MARKER/10, PART=1\nMARKER/11, PART=1, QP=3,4,0\nJOINT/1, SPHERICAL, I=20, J=10\nJOINT/2, SPHERICAL, I=21, J=11\nEND\n";
    let v = verified(text);
    // the distance of the two balls is fixed twice
    assert_eq!((v.gruebler, v.freedom, v.dependent.len()), (0, Some(1), 1));
    assert_eq!(
        v.free[0].words,
        "PART/2 turns about (0.6, 0.8, 0) through (0, 0, 0)"
    );
    assert_eq!(v.dependent[0].fixed_by, [ElementKind::Joint.id(1)]);
}

#[test]
fn contradiction_is_not_redundancy() {
    // a rod of length 5 between balls 4 apart
    let text = "TOO LONG\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=5,0,0\n\
        MARKER/10, PART=1\nMARKER/11, PART=1, QP=4,0,0\nJOINT/1, SPHERICAL, I=20, J=10\nJOINT/2, SPHERICAL, I=21, J=11\nUNITS/SYSTEM=MKS\nEND\n";
    let v = verified(text);
    assert_eq!(v.freedom, None);
    assert!(v.dependent.is_empty());
    let said = v.inconsistent[0].to_string();
    assert!(
        said.contains("JOINT/2") && said.contains("along ground X"),
        "{said}"
    );
    assert!(said.contains(" meter"), "{said}");
}

/// Two motions that ask the same of both cranks of a parallelogram, and two that do not.
#[test]
fn motions_can_be_redundant_or_contradict() {
    let cranks = |second: &str| {
        four_bar(
            [[0.0, 0.0], [0.0, 1.0], [3.0, 1.0], [3.0, 0.0]],
            &format!(
                "MOTION/1, JOINT=1, ROTATION, FUNCTION=TIME\nMOTION/2, JOINT=4, ROTATION, FUNCTION={second}\n"
            ),
        )
    };
    let same = verified(&cranks("TIME"));
    assert_eq!(
        (same.gruebler, same.freedom, same.dependent.len()),
        (-4, Some(0), 4)
    );
    assert!(same.inconsistent.is_empty());
    assert!(
        same.undetermined
            .iter()
            .any(|u| u.element == ElementKind::Motion.id(1))
            && same
                .undetermined
                .iter()
                .any(|u| u.element == ElementKind::Motion.id(2))
    );
    let faster = verified(&cranks("2*TIME"));
    // the end of the second crank, 1 above its hinge, is driven away from the coupler at 2 − 1
    let [said] = &faster.inconsistent[..] else {
        panic!("{:?}", faster.inconsistent);
    };
    let said = said.to_string();
    assert!(
        said.contains("by 1 per unit of time along ground X")
            && said.contains("MOTION/1, MOTION/2"),
        "{said}"
    );
    assert!(same.warnings.is_empty(), "{:?}", same.warnings);
}

/// A POINT_MASS counts three, is kept apart from the PART of its number, and does not turn.
#[test]
fn a_point_mass_has_three_freedoms_and_its_own_name() {
    let text = "TEST\nPART/1, GROUND\nMARKER/10, PART=1\nPART/3, MASS=1, CM=30, IP=1,1,1\nMARKER/30, PART=3\n\
        POINT_MASS/3, QG=1,2,0, MASS=2, CM=31\nMARKER/31, POINT_MASS=3\n\
        JOINT/1, REVOLUTE, I=30, J=10\nJPRIM/1, INPLANE, I=31, J=10\nEND\n";
    let v = verified(text);
    assert_eq!((v.parts, v.point_masses), (1, 1));
    assert_eq!(
        (v.gruebler, v.freedom, v.dependent.len()),
        (6 + 3 - 5 - 1, Some(3), 0)
    );
    assert!(v.warnings.is_empty(), "{:?}", v.warnings);
    let mut slides = Vec::new();
    for free in &v.free {
        let [moving] = &free.parts[..] else {
            panic!("{}", free.words);
        };
        if moving.part == ElementKind::Part.id(3) {
            assert_eq!(free.words, "PART/3 turns about its Z through (0, 0, 0)");
            continue;
        }
        assert_eq!(moving.part, ElementKind::PointMass.id(3));
        assert!(
            free.words.starts_with("POINT_MASS/3 slides along "),
            "{}",
            free.words
        );
        assert_eq!((moving.angular, moving.at), ([0.0; 3], [1.0, 2.0, 0.0]));
        slides.push(moving.linear);
    }
    // two directions of the plane z = 0
    assert_eq!(slides.len(), 2);
    let [a, b] = [slides[0], slides[1]];
    assert!(
        a[2] == 0.0 && b[2] == 0.0 && (a[0] * b[1] - a[1] * b[0]).abs() > 0.1,
        "{slides:?}"
    );
    // what is switched off is not counted
    let mut off = whole(text);
    off.inactive.insert(ElementKind::PointMass.id(3));
    off.inactive.insert(ElementKind::Jprim.id(1));
    let v = verify(&off).unwrap_or_else(|e| panic!("{e:?}"));
    assert_eq!((v.parts, v.point_masses, v.gruebler), (1, 0, 1));
    // without mass it lacks MASS, whatever the part of its number has
    let v = verified(&text.replace("MASS=2, CM=31", "CM=31"));
    let all = v.warned();
    let told = all.iter().find(|w| w.starts_with("POINT_MASS/3: "));
    let told = told.unwrap_or_else(|| panic!("{all:?}"));
    assert!(told.contains("MASS") && !told.contains("IP"), "{told}");
}

#[test]
fn a_misaligned_joint_says_by_how_much_and_where() {
    // the hinge of the rocker is 0.01 aside and 2 degrees askew
    let text = four_bar(
        [[0.0, 0.0], [0.0, 1.0], [3.0, 2.0], [3.0, 0.0]],
        "UNITS/SYSTEM=MKS\n",
    )
    .replace(
        "MARKER/21, PART=2, QP=0,0,0",
        "MARKER/21, PART=2, QP=0,0,0.01, REULER=0,2D,0",
    );
    let v = verified(&text);
    let warned = v.warned();
    let said = warned
        .iter()
        .find(|w| w.starts_with("JOINT/1"))
        .unwrap_or_else(|| panic!("{:?}", v.warned()));
    assert!(said.contains("0.01 meter along ground Z"), "{said}");
    assert!(said.contains("2 deg about ground X"), "{said}");
}

#[test]
fn a_part_that_had_to_be_turned_round_is_reported() {
    let text = "FLIPPED\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1, REULER=0,180D,0\nMARKER/20, PART=2\nMARKER/10, PART=1\n\
        JOINT/1, REVOLUTE, I=20, J=10\nEND\n";
    let v = verified(text);
    assert!(
        v.warned()
            .iter()
            .any(|w| w.starts_with("PART/2") && w.contains("180")),
        "{:?}",
        v.warned()
    );
}

/// A door on two hinges at z = ±h, its centre of mass a off the axis. The weight is shared evenly; the moment m g a is carried by a couple of forces and by
/// torques in the ratio that makes the sum of squares least: F/T = h/L².
#[test]
fn reactions_that_are_not_unique_are_the_smallest_set() {
    let door = |order: [&str; 2]| {
        format!(
            "DOOR\nPART/1, GROUND\nPART/2, MASS=10, CM=20, IP=1,1,1\nMARKER/20, PART=2, QP=0.5,0,0\n\
             MARKER/21, PART=2, QP=0,0,1\nMARKER/22, PART=2, QP=0,0,-1\nMARKER/11, PART=1, QP=0,0,1\nMARKER/12, PART=1, QP=0,0,-1\n\
             JOINT/{}, REVOLUTE, I=21, J=11\nJOINT/{}, REVOLUTE, I=12, J=22\nACCGRAV/KGRAV=-10\nEND\n",
            order[0], order[1]
        )
    };
    for order in [["1", "2"], ["2", "1"]] {
        let columns: Vec<String> = order
            .iter()
            .flat_map(|j| [2, 4, 7].map(|c| format!("JOINT({j},0,{c},0)")))
            .collect();
        let options = Options {
            columns: columns.clone(),
            ..Options::default()
        };
        let mut session = begin(whole(&door(order)), "door", options);
        go(&mut session, Analysis::InitialConditions, 0.0, 0);
        let value = |k: usize| session.run.column(&columns[k]).unwrap()[0];
        // the second joint is written the other way round: its I is on ground
        let expected_z = [50.0, -50.0];
        for k in [0, 1] {
            approx::assert_relative_eq!(value(3 * k + 1), expected_z[k], max_relative = 1e-10);
        }
        // L = 1 here: λ (h² + L²) = m g a with F = λ h/2, T = λ L²/2
        let lambda: f64 = 10.0 * 10.0 * 0.5 / 2.0;
        approx::assert_relative_eq!(value(0).abs(), lambda / 2.0, max_relative = 1e-10);
        approx::assert_relative_eq!(value(3), value(0), max_relative = 1e-10);
        approx::assert_relative_eq!(value(2).abs(), lambda / 2.0, max_relative = 1e-10);
        approx::assert_relative_eq!(value(5), -value(2), max_relative = 1e-10);
    }
}

/// Two sliders on one line whose distance is drawn as 3 and asked to be 2.
fn sliders(first: &str, joint: &str) -> String {
    format!(
        "SLIDERS\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1{first}\nPART/3, MASS=1, CM=30, IP=1,1,1, QG=3,0,0\n\
         MARKER/20, PART=2, REULER=90D,90D,0\nMARKER/30, PART=3, REULER=90D,90D,0\nMARKER/10, PART=1, REULER=90D,90D,0\n\
         MARKER/21, PART=2, QP=1,0,0, REULER=90D,90D,0\nMARKER/31, PART=3, QP=-1,0,0, REULER=90D,90D,0\n\
         JOINT/1, TRANSLATIONAL, I=20, J=10{joint}\nJOINT/2, TRANSLATIONAL, I=30, J=10\nJPRIM/1, INPLANE, I=21, J=31\nEND\n"
    )
}

/// Where the two sliders are when they are assembled.
fn assembled(text: &str) -> [f64; 2] {
    let columns = ["DX(20,10)", "DX(30,10)"].map(str::to_string);
    let options = Options {
        columns: columns.to_vec(),
        ..Options::default()
    };
    let mut session = begin(whole(text), "sliders", options);
    go(&mut session, Analysis::InitialConditions, 0.0, 0);
    columns.map(|c| session.run.column(&c).unwrap()[0])
}

/// Parts move as little as may be; those that EXACT holds, and joints that say where they begin, do not move for others.
#[test]
fn assembly_moves_what_may_move() {
    let close = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() < 1e-6 && (a[1] - b[1]).abs() < 1e-6;
    let free = assembled(&sliders("", ""));
    assert!(close(free, [0.5, 2.5]), "{free:?}");
    let exact = assembled(&sliders(", EXACT=X", ""));
    assert!(close(exact, [0.0, 2.0]), "{exact:?}");
    let joint = assembled(&sliders("", ", IC=0.2,0"));
    assert!(close(joint, [0.2, 2.2]), "{joint:?}");
}

/// The joint that closes the loop may say where it begins, as well as one that carries a part.
#[test]
fn any_joint_of_a_loop_may_say_where_it_begins() {
    let points = [[0.0, 0.0], [0.0, 1.0], [3.0, 1.0], [3.0, 0.0]];
    for joint in 1..=4 {
        let text = four_bar(points, "");
        let line = text
            .lines()
            .find(|l| l.starts_with(&format!("JOINT/{joint},")))
            .unwrap()
            .to_string();
        let text = text.replace(&line, &format!("{line}, IC=0.1,0"));
        let (i, j) = match joint {
            1 => (21, 11),
            2 => (32, 22),
            3 => (43, 33),
            _ => (44, 14),
        };
        let column = format!("AZ({i},{j})");
        let options = Options {
            columns: vec![column.clone()],
            ..Options::default()
        };
        let mut session = begin(whole(&text), "ic", options);
        go(&mut session, Analysis::InitialConditions, 0.0, 0);
        let angle = session.run.column(&column).unwrap()[0];
        // held with weight 10¹⁰ against parts that would rather stay
        assert!((angle - 0.1).abs() < 1e-6, "JOINT/{joint}: {angle}");
    }
}

#[test]
fn what_routines_compute_is_taken_to_stand_still() {
    let text = four_bar(
        [[0.0, 0.0], [0.0, 1.0], [3.0, 1.0], [3.0, 0.0]],
        "VARIABLE/7, FUNCTION=USER(1)\nMOTION/1, JOINT=1, ROTATION, FUNCTION=2*VARVAL(7)\nSFORCE/1, ROTATIONAL, I=21, J=11, FUNCTION=USER(3)\n",
    );
    let v = verified(&text);
    assert_eq!((v.gruebler, v.freedom), (-3, Some(0)));
    assert!(
        v.warned()
            .iter()
            .any(|w| w.starts_with("MOTION/1") && w.contains("stand still")),
        "{:?}",
        v.warned()
    );
}

/// Each message names the element, how much, in which direction, and what to do.
#[test]
fn what_does_not_fit_says_how_much_where_and_what_to_do() {
    // the last hinge is 0.01 aside: nothing can give way out of the plane
    let bars = four_bar(
        [[0.0, 0.0], [0.0, 1.0], [3.0, 2.0], [3.0, 0.0]],
        "UNITS/SYSTEM=MKS\n",
    );
    let moved = bars.replace(
        "MARKER/14, PART=1, QP=3,0,0",
        "MARKER/14, PART=1, QP=3,0,0.01",
    );
    assert_ne!(bars, moved);
    let v = verified(&moved);
    assert_eq!(v.freedom, None);
    let said = &v.inconsistent[0];
    assert!(
        said.element.as_deref() == Some("JOINT/4")
            && said.message.contains("off by 0.01 meter along ground Z"),
        "{said:?}"
    );
    assert!(!said.help.is_empty());
    // two cranks that are driven at rates that do not go together
    let v = verified(&bars.replace(
        "END\n",
        "MOTION/1, JOINT=1, ROTATION, FUNCTION=TIME\nMOTION/2, JOINT=4, ROTATION, FUNCTION=TIME\nEND\n",
    ));
    let said = &v.inconsistent[0];
    assert!(
        said.element.as_deref() == Some("MOTION/2") && said.message.contains("MOTION/1"),
        "{said:?}"
    );
    let asked = "give way by 0.5 meter per unit of time along ground X";
    assert!(said.help.iter().any(|h| h.contains(asked)), "{said:?}");
    assert!(
        (said.help.iter()).any(|h| h.contains("MOTION/1, MOTION/2")),
        "{said:?}"
    );
}

/// What a routine computes, or what stands in another file: such constraints are counted, and left out of the rank.
#[test]
fn constraints_that_nobody_knows_are_counted_and_told() {
    let contact = |curve: &str| format!("PTCV/1, CURVE=1, I=20, RM=1\nCURVE/1, OPEN, {curve}\n");
    let hinge = "JOINT/1, REVOLUTE, I=20, J=1\n";
    for (text, gruebler, freedom, element, why) in [
        (
            contact("FUNCTION=USER(1)"),
            4,
            6,
            "PTCV/1",
            "CURVE/1 is computed by a routine",
        ),
        (
            contact("MATRIX=1, CURVE_POINTS\nMATRIX/1, FILE=points.mtx"),
            4,
            6,
            "PTCV/1",
            "stand in the file points.mtx",
        ),
        (
            "GCON/1, I=20, FUNCTION=USER(1)\n".to_string(),
            5,
            6,
            "GCON/1",
            "by a routine",
        ),
        (
            format!(
                "{hinge}PART/3, MASS=1, CM=30, IP=1,1,1\nMARKER/30, PART=3\nJOINT/2, REVOLUTE, I=30, J=1\n\
                 COUPLER/1, JOINTS=1,2, TYPE=R:R, FUNCTION=USER(1)\n"
            ),
            1,
            2,
            "COUPLER/1",
            "by a routine",
        ),
    ] {
        let text = format!(
            "USER\nPART/1, GROUND\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/1, PART=1\n{text}END\n"
        );
        let v = verified(&text);
        assert_eq!((v.gruebler, v.freedom), (gruebler, Some(freedom)), "{text}");
        let warned = v.warned();
        let told = warned.iter().find(|w| w.starts_with(element));
        assert!(
            told.is_some_and(|w| w.contains(why) && w.contains("is counted with")),
            "{:?}",
            v.warned()
        );
    }
}
