//! Joints that are redundant but for a misalignment: within IC/ERROR they are left out and told, beyond it refused by name.

use crate::running;

use cognate::analysis::verify;
use cognate::analysis::watch::Unwatched;
use cognate::results::Status;
use proptest::prelude::*;
use running::{Analysis, begin, options, whole};

/// Misalignment of a marker: tilts about its x and y axes in rad, shifts in parts of the unit length.
type Misfit = [f64; 5];

const ALIGNED: Misfit = [0.0; 5];

/// A marker whose axis is parallel to ground z but for a misalignment; `s` is one unit length.
fn marker(id: u32, part: u32, p: [f64; 2], m: Misfit, s: f64) -> String {
    // z tilted by (a, b): turned about z by ψ, then about x by θ
    let (theta, psi) = (m[0].hypot(m[1]), m[0].atan2(m[1]));
    format!(
        "MARKER/{id}, PART={part}, QP={:?},{:?},{:?}, REULER={psi:?},{theta:?},{:?}",
        s * (p[0] + m[2]),
        s * (p[1] + m[3]),
        s * m[4],
        -psi
    )
}

/// A planar four-bar of revolutes with a crank of 1, coupler and rocker longer, and a base of 4; a misalignment at each
/// of its eight markers. Statements in the order that `order` gives.
fn four_bar(misfits: &[Misfit; 8], s: f64, order: &[u32], more: &str) -> String {
    let (a, b, c, d) = ([0.0, 0.0], [0.0, 1.0], [4.0, 3.0], [4.0, 0.0]);
    let i = s * s;
    let mut all: Vec<String> = vec![
        format!("PART/2, MASS=1, CM=20, IP={i:?},{i:?},{i:?}"),
        format!("PART/3, MASS=1, CM=30, IP={i:?},{i:?},{i:?}"),
        format!("PART/4, MASS=1, CM=40, IP={i:?},{i:?},{i:?}"),
        marker(20, 2, [0.0, 0.5], ALIGNED, s),
        marker(30, 3, [2.0, 2.0], ALIGNED, s),
        marker(40, 4, [4.0, 1.5], ALIGNED, s),
        format!("ACCGRAV/JGRAV={:?}", -9.81 * s),
    ];
    let places = [
        (11, 1, a),
        (21, 2, a),
        (22, 2, b),
        (32, 3, b),
        (33, 3, c),
        (43, 4, c),
        (44, 4, d),
        (14, 1, d),
    ];
    for ((id, part, p), m) in places.into_iter().zip(misfits) {
        all.push(marker(id, part, p, *m, s));
    }
    for (j, i_marker, j_marker) in [(1, 21, 11), (2, 32, 22), (3, 43, 33), (4, 44, 14)] {
        all.push(format!("JOINT/{j}, REVOLUTE, I={i_marker}, J={j_marker}"));
    }
    let mut keyed: Vec<(u32, String)> = order.iter().copied().cycle().zip(all).collect();
    keyed.sort();
    let all: Vec<String> = keyed.into_iter().map(|k| k.1).collect();
    format!(
        "FOUR BAR\nPART/1, GROUND\nMARKER/1, PART=1\n{}\n{more}END\n",
        all.join("\n")
    )
}

/// Runs it for a quarter of a second: its freedom, whether it went, what was said.
fn outcome(text: &str, analysis: Analysis) -> (Option<usize>, bool, Vec<String>) {
    let freedom = verify::verify(&whole(text))
        .unwrap_or_else(|e| panic!("{e:?}\n{text}"))
        .freedom;
    let mut session = begin(whole(text), "misaligned", options(&["AZ(44,14)"], 1e-6));
    match session.simulate(analysis, 0.25, 5, &mut Unwatched) {
        Ok(status) => (
            freedom,
            status == Status::Completed,
            session.run.record.warned(),
        ),
        Err(errors) => (
            freedom,
            false,
            (errors.diagnostics().iter())
                .flat_map(|d| std::iter::once(d.to_string()).chain(d.help.iter().cloned()))
                .collect(),
        ),
    }
}

/// A door on two hinges whose axes are parallel, and `apart` from each other.
fn door(apart: f64, more: &str) -> String {
    format!(
        "DOOR\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2, QP=1,0,0.5\n\
         MARKER/11, PART=1\nMARKER/44, PART=2\nMARKER/14, PART=1, QP={apart:?},0,1\nMARKER/22, PART=2, QP={apart:?},0,1\n\
         JOINT/1, REVOLUTE, I=44, J=11\nJOINT/2, REVOLUTE, I=22, J=14\n{more}END\n"
    )
}

fn misfit(size: f64) -> impl Strategy<Value = Misfit> {
    let part = -size..size;
    [part.clone(), part.clone(), part.clone(), part.clone(), part]
}

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 24,
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config())]

    /// Rounded to six digits, in any order of statements and any unit, a four-bar has its one freedom, moves, and its
    /// rocker is where that of the aligned one is.
    #[test]
    fn a_four_bar_rounded_to_six_digits_moves(
        misfits in [misfit(5e-6), misfit(5e-6), misfit(5e-6), misfit(5e-6), misfit(5e-6), misfit(5e-6), misfit(5e-6), misfit(5e-6)],
        order in proptest::collection::vec(0u32..100, 19),
        unit in prop_oneof![Just(1e-3), Just(1.0), Just(1e3)],
    ) {
        let (freedom, went, said) = outcome(&four_bar(&misfits, unit, &order, ""), Analysis::Dynamic);
        prop_assert_eq!(freedom, Some(1), "{:?}", said);
        prop_assert!(went, "{:?}", said);
        prop_assert!(said.iter().any(|s| s.contains("redundant but for a misalignment")), "{:?}", said);
    }

    /// Off by a thousandth to a hundredth at one marker, it is refused: by one of its joints, with the amount.
    #[test]
    fn a_four_bar_that_is_off_by_more_is_refused(
        which in 0usize..8, tilt in 0.002f64..0.01, way in 0.0f64..6.2,
        order in proptest::collection::vec(0u32..100, 19),
        unit in prop_oneof![Just(1e-3), Just(1.0), Just(1e3)],
    ) {
        let mut misfits = [ALIGNED; 8];
        misfits[which] = [tilt * way.cos(), tilt * way.sin(), 0.0, 0.0, 0.0];
        let (freedom, went, said) = outcome(&four_bar(&misfits, unit, &order, ""), Analysis::Dynamic);
        prop_assert_eq!(freedom, None);
        prop_assert!(!went);
        prop_assert!(said.iter().any(|s| s.contains("JOINT/") && s.contains("is off by")), "{:?}", said);
    }
}

proptest! {
    #![proptest_config(config())]

    /// A loop whose axis is tilted as a whole fits as it is drawn; it is a structure all the same, and refused with the amount, but
    /// where the dataset says that every equation is meant.
    #[test]
    fn a_loop_that_fits_as_it_is_drawn_is_refused_or_meant(
        joint in 0usize..4, tilt in 0.001f64..0.01, way in 0.0f64..6.2,
        order in proptest::collection::vec(0u32..100, 19),
        unit in prop_oneof![Just(1e-3), Just(1.0), Just(1e3)],
    ) {
        let mut misfits = [ALIGNED; 8];
        let tilted = [tilt * way.cos(), tilt * way.sin(), 0.0, 0.0, 0.0];
        (misfits[2 * joint], misfits[2 * joint + 1]) = (tilted, tilted);
        let (freedom, went, said) = outcome(&four_bar(&misfits, unit, &order, ""), Analysis::Dynamic);
        prop_assert_eq!(freedom, None);
        prop_assert!(!went);
        prop_assert!(said.iter().any(|s| s.contains("JOINT/") && s.contains("is off by")), "{:?}", said);
        prop_assert!(said.iter().any(|s| s.contains("IC/ERROR=1E-12")), "{:?}", said);
        let (freedom, went, said) = outcome(&four_bar(&misfits, unit, &order, "IC/ERROR=1E-12\n"), Analysis::Dynamic);
        prop_assert_eq!(freedom, Some(0), "{:?}", said);
        prop_assert!(went && said.iter().any(|s| s.contains("no part can move")), "{:?}", said);
    }
}

/// Tilts of one axis from 1e-12 to 1e-2 rad: what runs has one freedom, and nothing runs that is tilted more than what is
/// refused; likewise where the crank is driven and at rest.
#[test]
fn what_is_refused_stays_refused_when_it_is_tilted_more() {
    let drive = "MOTION/1, JOINT=1, ROTATION, FUNCTION=0.5*TIME\n";
    for (more, analysis, freedom) in [
        ("", Analysis::Dynamic, 1),
        (drive, Analysis::Kinematic, 0),
        ("", Analysis::Static, 1),
    ] {
        for both in [false, true] {
            let mut refused = false;
            for exponent in (2..=12).rev() {
                let mut misfits = [ALIGNED; 8];
                let tilt = [10f64.powi(-exponent), 0.0, 0.0, 0.0, 0.0];
                (misfits[6], misfits[7]) = (if both { tilt } else { ALIGNED }, tilt);
                let (found, went, said) = outcome(&four_bar(&misfits, 1.0, &[0], more), analysis);
                assert!(
                    !(went && refused),
                    "1e-{exponent} runs, though less does not: {said:?}"
                );
                assert!(
                    !went || found == Some(freedom),
                    "1e-{exponent}: {found:?} {said:?}"
                );
                assert!(went || exponent < 4, "1e-{exponent}: {said:?}");
                refused |= !went;
            }
            assert!(refused || both && freedom == 0, "{analysis:?}, both {both}");
        }
    }
}

/// A loop that fits as it is drawn, but is a structure, is not moved by its drive: beyond tolerance it is refused or
/// stopped, also where the drive begins at rest, with the amount and the name of a joint; within it the joint is told.
#[test]
fn a_drive_does_not_move_what_is_locked() {
    let tilted = |joint: usize, size: f64| {
        let mut misfits = [ALIGNED; 8];
        let tilt = [size, 0.0, 0.0, 0.0, 0.0];
        (misfits[2 * joint], misfits[2 * joint + 1]) = (tilt, tilt);
        misfits
    };
    for function in ["0.5*TIME", "STEP(TIME,0,0,0.2,1)", "0.5*TIME**2"] {
        let drive = format!("MOTION/1, JOINT=1, ROTATION, FUNCTION={function}\n");
        for exponent in 2..=12 {
            let size = 0.7 * 10f64.powi(-exponent);
            let mut models: Vec<String> = (0..4)
                .map(|joint| four_bar(&tilted(joint, size), 1.0, &[0], &drive))
                .collect();
            models.push(door(size, &drive));
            for (k, text) in models.iter().enumerate() {
                let free = "PART/9, MASS=1, CM=90, IP=1,1,1\nMARKER/90, PART=9, QP=9,9,9\nEND\n";
                let beside = text.replace("END\n", free);
                for (text, analysis) in [(text, Analysis::Kinematic), (&beside, Analysis::Dynamic)]
                {
                    let (_, went, said) = outcome(text, analysis);
                    let case = format!("{function}, 1e-{exponent}, {k}, {analysis:?}: {said:?}");
                    let is_told = said
                        .iter()
                        .any(|s| s.contains("JOINT/") && s.contains("misalignment"));
                    let is_refused = said
                        .iter()
                        .any(|s| s.contains("JOINT/") && s.contains("is off by"));
                    assert_eq!(went, exponent > 3, "{case}");
                    assert!(
                        if went {
                            exponent > 8 || is_told
                        } else {
                            is_refused
                        },
                        "{case}"
                    );
                }
            }
        }
    }
}

/// IC/ERROR is obeyed, in both directions.
#[test]
fn the_tolerance_of_the_dataset_is_obeyed() {
    let mut misfits = [ALIGNED; 8];
    misfits[7][0] = 1e-6;
    let with = |error: &str| outcome(&four_bar(&misfits, 1.0, &[0], error), Analysis::Dynamic);
    assert!(with("").1);
    let (_, went, said) = with("IC/ERROR=1E-7\n");
    assert!(!went && said[0].contains("IC/ERROR"), "{said:?}");
    misfits[7][0] = 1e-3;
    let with = |error: &str| outcome(&four_bar(&misfits, 1.0, &[0], error), Analysis::Dynamic);
    assert!(!with("").1);
    assert!(with("IC/ERROR=5E-3\n").1);
}

/// A folded parallelogram depends on nothing but its position: it is no misaligned mechanism.
#[test]
fn a_position_that_is_singular_in_passing_is_no_misalignment() {
    for near in [0.0, 1e-6, 1e-3] {
        let (c, s) = (f64::cos(near), f64::sin(near));
        let text = format!(
            "PART/2, MASS=1, CM=20, IP=1,1,1, WZ=1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP={c:?},{s:?},0\n\
             PART/3, MASS=1, CM=30, IP=1,1,1\nMARKER/30, PART=3, QP={c:?},{s:?},0\nMARKER/31, PART=3, QP={:?},{s:?},0\n\
             PART/4, MASS=1, CM=40, IP=1,1,1\nMARKER/40, PART=4, QP=3,0,0\nMARKER/41, PART=4, QP={:?},{s:?},0\nMARKER/12, PART=1, QP=3,0,0\n\
             JOINT/1, REVOLUTE, I=20, J=1\nJOINT/2, REVOLUTE, I=30, J=21\nJOINT/3, REVOLUTE, I=31, J=41\nJOINT/4, REVOLUTE, I=40, J=12\n",
            3.0 + c,
            3.0 + c,
        );
        let text = format!("{}{text}END\n", running::GROUND);
        let (_, _, said) = outcome(&text, Analysis::Dynamic);
        assert!(
            !said
                .iter()
                .any(|s| s.contains("misalign") || s.contains("aligned")),
            "{said:?}"
        );
    }
}

/// A model without parts says nothing of freedom; one whose parts are held says that they are.
#[test]
fn what_cannot_move_is_told_truly() {
    let said = |text: &str| {
        let text = format!("{}{text}END\n", running::GROUND);
        let mut session = begin(whole(&text), "held", options(&["TIME"], 1e-6));
        session
            .simulate(Analysis::Dynamic, 1.0, 2, &mut Unwatched)
            .expect("it runs");
        session.run.record.warned()
    };
    let decay = said("DIFF/1, IC=1, FUNCTION=-DIF(1)\n");
    assert!(
        !decay
            .iter()
            .any(|s| s.contains("freedom") || s.contains("move")),
        "{decay:?}"
    );
    let fixed =
        said("PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nJOINT/1, FIXED, I=20, J=1\n");
    assert!(
        !fixed.iter().any(|s| s.contains("motions alone")),
        "{fixed:?}"
    );
    assert!(
        fixed.iter().any(|s| s.contains("no part can move")),
        "{fixed:?}"
    );
}

/// A motion elsewhere in the model changes nothing of what is said of a loop that it does not drive.
#[test]
fn a_drive_elsewhere_does_not_hide_what_is_locked() {
    let elsewhere = "PART/9, MASS=1, CM=90, IP=1,1,1, QG=9,0,0\nMARKER/90, PART=9\nMARKER/91, PART=1, QP=9,0,0\n\
                     JOINT/9, REVOLUTE, I=90, J=91\nMOTION/9, JOINT=9, ROTATION, FUNCTION=TIME\n";
    for exponent in 2..=12 {
        let mut misfits = [ALIGNED; 8];
        let tilt = [0.7 * 10f64.powi(-exponent), 0.0, 0.0, 0.0, 0.0];
        (misfits[6], misfits[7]) = (tilt, tilt);
        for more in ["", elsewhere] {
            for text in [four_bar(&misfits, 1.0, &[0], more), door(tilt[0], more)] {
                let (freedom, went, said) = outcome(&text, Analysis::Dynamic);
                assert_eq!(went, exponent > 3, "1e-{exponent}: {said:?}");
                assert_eq!(freedom, went.then_some(1), "1e-{exponent}: {said:?}");
            }
        }
    }
}
