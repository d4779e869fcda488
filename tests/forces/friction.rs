//! FRICTION in joints: Coulomb's closed forms for each joint, what is read of the reaction, and where it is approximate.

use crate::running;

use cognate::model::Model;
use running::{Analysis, Session, first, go, last, session_by, values};

fn run(text: &str, columns: &[&str], end: f64) -> Session {
    running::run(text, columns, Analysis::Dynamic, (end, 10), 1e-9)
}

const G: f64 = 9.81;

/// All values of a column are one number.
fn constant(s: &Session, column: &str, expected: f64) {
    for x in values(s, column) {
        assert!(
            (x - expected).abs() < 1e-8 * expected.abs().max(1.0),
            "{column} = {x} instead of {expected}"
        );
    }
}

/// A block of mass 2 on a horizontal guide along x (z of its joint), its weight `arm` beside the guide.
fn block(arm: f64, friction: &str) -> String {
    format!(
        "PART/2, MASS=2, CM=3, IP=1,1,1, VX=3\nMARKER/2, PART=2, REULER=90D,90D,0\nMARKER/3, PART=2, QP=0,{arm:?},0\n\
         MARKER/4, PART=1, REULER=90D,90D,0\nJOINT/1, TRANSLATIONAL, I=2, J=4\nACCGRAV/KGRAV=-{G}\n\
         FRICTION/1, JOINT=1, {friction}\n"
    )
}

#[test]
fn a_block_on_a_guide_slows_down_by_mu_g() {
    let s = run(
        &block(
            0.0,
            "MU_STATIC=0.3, MU_DYNAMIC=0.2, STICTION_TRANSITION_VELOCITY=0.01",
        ),
        &["ACCX(2,1)", "VX(2,1)", "FRICTION(1,3)", "FRICTION(1,16)"],
        0.5,
    );
    constant(&s, "ACCX(2,1)", -0.2 * G);
    constant(&s, "FRICTION(1,3)", -0.2 * 2.0 * G);
    assert!((last(&s, "VX(2,1)") - (3.0 - 0.1 * G)).abs() < 1e-8);
    assert!((last(&s, "FRICTION(1,16)") - last(&s, "VX(2,1)")).abs() < 1e-12);
}

#[test]
fn friction_reads_what_it_is_told_to_read() {
    let mu = 0.2;
    let law = "MU_STATIC=0.2, MU_DYNAMIC=0.2, REACTION_ARM=0.25, FRICTION_FORCE_PRELOAD=1.5";
    // the weight beside the guide twists it: M_t = m g · 0.1
    let (n, twist, preload) = (2.0 * G, 2.0 * G * 0.1 / 0.25, 1.5);
    for (inputs, force) in [
        ("ALL", mu * (n + twist) + preload),
        ("NONE", 0.0),
        ("PRELOAD", preload),
        ("REACTION_FORCE", mu * n),
        ("TORSIONAL_MOMENT", mu * twist),
        ("REACTION_FORCE:TORSIONAL_MOMENT", mu * (n + twist)),
    ] {
        let s = run(
            &block(0.1, &format!("{law}, INPUTS={inputs}")),
            &["FX(2,4)"],
            0.1,
        );
        // M_b is that of the deceleration beside the guide, over an overlap of 1000
        let bending = if inputs == "ALL" { 1e-3 } else { 1e-8 };
        assert!(
            (last(&s, "FX(2,4)") + force).abs() < bending,
            "{inputs}: {} {force}",
            last(&s, "FX(2,4)")
        );
    }
}

#[test]
fn bending_presses_by_its_overlap() {
    // the weight hangs 0.4 before the guide's marker: M_b = m g 0.4
    let text = |more: &str| {
        block(
            0.0,
            &format!(
                "MU_STATIC=0.2, MU_DYNAMIC=0.2, INPUTS=BENDING_MOMENT, INITIAL_OVERLAP=0.5{more}"
            ),
        )
        .replace("QP=0,0.0,0", "QP=0.4,0,0")
    };
    let force = |more: &str, displacement: f64, overlap: f64| {
        let s = run(&text(more), &["FRICTION(1,3)", "DX(2,4)"], 0.1);
        let expected = -0.2 * 2.0 * G * 0.4 / (overlap + displacement * last(&s, "DX(2,4)"));
        assert!(
            (last(&s, "FRICTION(1,3)") - expected).abs() < 1e-7,
            "{more}"
        );
    };
    force("", 0.0, 0.5);
    force(", OVERLAP_DELTA=INCREASE", 1.0, 0.5);
    force(", OVERLAP_DELTA=DECREASE", -1.0, 0.5);
}

#[test]
fn a_wheel_on_a_pin_runs_down_by_the_radius_of_the_pin() {
    let wheel = |more: &str| {
        format!(
            "PART/2, MASS=5, CM=3, IP=0.3,0.3,0.3, WX=40\nMARKER/2, PART=2, REULER=90D,90D,0\nMARKER/3, PART=2\nMARKER/4, PART=1, REULER=90D,90D,0\n\
             JOINT/1, REVOLUTE, I=2, J=4\nACCGRAV/KGRAV=-{G}\nFRICTION/1, JOINT=1, MU_STATIC=0.3, MU_DYNAMIC=0.2{more}\n"
        )
    };
    let s = run(
        &wheel(", PIN_RADIUS=0.02"),
        &["WDTX(2,1)", "FRICTION(1,6)", "FRICTION(1,19)"],
        0.5,
    );
    constant(&s, "WDTX(2,1)", -0.2 * 0.02 * 5.0 * G / 0.3);
    constant(&s, "FRICTION(1,6)", -0.2 * 0.02 * 5.0 * G);
    assert!((values(&s, "FRICTION(1,19)")[0] - 40.0).abs() < 1e-12);
    let s = run(
        &wheel(", PIN_RADIUS=0.02, FRICTION_TORQUE_PRELOAD=0.1"),
        &["WDTX(2,1)"],
        0.5,
    );
    constant(&s, "WDTX(2,1)", -(0.2 * 0.02 * 5.0 * G + 0.1) / 0.3);
    // along the pin its arm counts: the same wheel pushed along the axis without weight
    let pushed =
        wheel(", FRICTION_ARM=0.05").replace(&format!("ACCGRAV/KGRAV=-{G}"), "ACCGRAV/IGRAV=-2");
    let s = run(&pushed, &["WDTX(2,1)"], 0.5);
    constant(&s, "WDTX(2,1)", -0.2 * 0.05 * 10.0 / 0.3);
    // overhung by 0.3: the bending moment presses the bearing at an arm of 0.1
    let overhung = wheel(", PIN_RADIUS=0.02, BENDING_REACTION_ARM=0.1")
        .replace("MARKER/3, PART=2", "MARKER/3, PART=2, QP=0.3,0,0");
    let s = run(&overhung, &["WDTX(2,1)"], 0.5);
    constant(
        &s,
        "WDTX(2,1)",
        -0.2 * 0.02 * 5.0 * G * (1.0 + 0.3 / 0.1) / 0.3,
    );
}

#[test]
fn a_ball_in_its_socket_and_a_cylinder_in_its_sleeve_slip_as_they_should() {
    let text = format!(
        "PART/2, MASS=5, CM=2, IP=0.3,0.3,0.3, WX=30, WY=40\nMARKER/2, PART=2\nJOINT/1, SPHERICAL, I=2, J=1\nACCGRAV/KGRAV=-{G}\n\
         FRICTION/1, JOINT=1, MU_STATIC=0.3, MU_DYNAMIC=0.2, BALL_RADIUS=0.02\n"
    );
    let s = run(&text, &["WDTX(2,1)", "WDTY(2,1)"], 0.5);
    let rate = 0.2 * 0.02 * 5.0 * G / 0.3;
    constant(&s, "WDTX(2,1)", -0.6 * rate);
    constant(&s, "WDTY(2,1)", -0.8 * rate);
    // the slip of a sleeve has the direction (ż, R_p ω) = (3, 4): with I = m R_p² it keeps it
    let r = 0.5;
    let text = format!(
        "PART/2, MASS=2, CM=3, IP={0:?},1,1, VX=3, WX={1:?}\nMARKER/2, PART=2, REULER=90D,90D,0\nMARKER/3, PART=2\nMARKER/4, PART=1, REULER=90D,90D,0\n\
         JOINT/1, CYLINDRICAL, I=2, J=4\nACCGRAV/KGRAV=-{G}\nFRICTION/1, JOINT=1, MU_STATIC=0.3, MU_DYNAMIC=0.2, PIN_RADIUS={r:?}\n",
        2.0 * r * r,
        4.0 / r
    );
    let s = run(&text, &["ACCX(2,1)", "WDTX(2,1)"], 0.5);
    constant(&s, "ACCX(2,1)", -0.2 * G * 0.6);
    constant(&s, "WDTX(2,1)", -0.2 * G * 0.8 / r);
}

#[test]
fn a_universal_joint_rubs_about_its_pins() {
    // a body that hangs in a cross and turns about the pin of J alone
    for (joint, markers, pin) in [
        ("HOOKE", "MARKER/2, PART=2\nMARKER/4, PART=1\n", "WY"),
        (
            "UNIVERSAL",
            "MARKER/2, PART=2, REULER=0,90D,0\nMARKER/4, PART=1\n",
            "WZ",
        ),
    ] {
        // weight across this pin, through the centre: only friction turns the body
        let gravity = if pin == "WY" { "KGRAV" } else { "IGRAV" };
        let text = format!(
            "PART/2, MASS=5, CM=3, IP=0.3,0.3,0.3, {pin}=30\nMARKER/3, PART=2\n{markers}JOINT/1, {joint}, I=2, J=4\nACCGRAV/{gravity}=-{G}\n\
             FRICTION/1, JOINT=1, MU_STATIC=0.3, MU_DYNAMIC=0.2, PIN_RADIUS=0.02\n"
        );
        let column = format!("{}DT{}(2,1)", &pin[..1], &pin[1..]);
        let s = run(&text, &[&column], 0.1);
        let found = values(&s, &column)[0];
        assert!(
            (found + 0.2 * 0.02 * 5.0 * G / 0.3).abs() < 1e-8,
            "{joint} {found}"
        );
    }
}

/// A body whose centre a cross holds, spinning about one pin or both: each rubs under the force across and along it.
#[test]
fn each_pin_of_a_cross_rubs_under_the_force_across_and_along_it() {
    let pulls = [
        [3.0, -4.0, 12.0],
        // along one of the pins: nothing lies across it
        [5.0, 0.0, 0.0],
        [0.0, 5.0, 0.0],
        [0.0, 0.0, 5.0],
        [0.0; 3],
    ];
    for (joint, turned, pins) in [
        ("HOOKE", "", [0, 1]),
        ("UNIVERSAL", ", REULER=0,-90D,0", [1, 2]),
    ] {
        for rates in [[30.0, 0.0], [0.0, -40.0], [30.0, -40.0]] {
            for pull in pulls {
                let mut spin = [0.0; 3];
                for (pin, rate) in pins.into_iter().zip(rates) {
                    spin[pin] = rate;
                }
                let text = format!(
                    "PART/2, MASS=5, CM=3, IP=0.3,0.3,0.3, WX={:?}, WY={:?}, WZ={:?}\nMARKER/3, PART=2\nMARKER/2, PART=2{turned}\nMARKER/4, PART=1\n\
                     JOINT/1, {joint}, I=2, J=4\nACCGRAV/IGRAV={:?}, JGRAV={:?}, KGRAV={:?}\n\
                     FRICTION/1, JOINT=1, MU_STATIC=0.3, MU_DYNAMIC=0.2, PIN_RADIUS=0.02, FRICTION_ARM=0.05, FRICTION_TORQUE_PRELOAD=0.1\n",
                    spin[0], spin[1], spin[2], pull[0], pull[1], pull[2]
                );
                let force: f64 = pull.map(|g| (5.0 * g) * (5.0 * g)).iter().sum();
                for method in ["DOP853", "RADAU5"] {
                    let mut s = session_by(
                        &text,
                        &[
                            "FRICTION(1,4)",
                            "FRICTION(1,5)",
                            "FRICTION(1,6)",
                            "WDTX(2,1)",
                            "WDTY(2,1)",
                            "WDTZ(2,1)",
                        ],
                        method,
                        1e-8,
                    );
                    go(&mut s, Analysis::Dynamic, 0.01, 2);
                    for (pin, rate) in pins.into_iter().zip(rates) {
                        let along = 5.0 * pull[pin];
                        let across = (force - along * along).sqrt();
                        let resists = 0.2 * (0.05 * along.abs() + 0.02 * across) + 0.1;
                        let expected = if rate == 0.0 {
                            0.0
                        } else {
                            -resists * f64::signum(rate)
                        };
                        let axis = ["X", "Y", "Z"][pin];
                        let torque = first(&s, &format!("FRICTION(1,{})", 4 + pin));
                        let rate = first(&s, &format!("WDT{axis}(2,1)"));
                        assert!(
                            (torque - expected).abs() < 1e-9
                                && (rate - expected / 0.3).abs() < 1e-8,
                            "{joint} {rates:?} {pull:?} {method}, about {axis}: {torque} and {rate}, not {expected}"
                        );
                    }
                }
            }
        }
    }
}

/// Out of its guide, or all but out of it, a slide is held by a thousandth of the overlap that it had.
#[test]
fn an_overlap_that_is_used_up_presses_like_a_thousandth_of_it() {
    for (joint, change, place) in [
        ("TRANSLATIONAL", "DECREASE", 0.6),
        ("TRANSLATIONAL", "INCREASE", -0.6),
        ("CYLINDRICAL", "DECREASE", 0.4999),
    ] {
        let law = format!(
            "MU_STATIC=0.2, MU_DYNAMIC=0.2, INPUTS=BENDING_MOMENT, INITIAL_OVERLAP=0.5, OVERLAP_DELTA={change}"
        );
        let text = block(0.0, &law)
            .replace("QP=0,0.0,0", "QP=0.4,0,0")
            .replace("VX=3", &format!("VX=3, QG={place},0,0"))
            .replace("TRANSLATIONAL", joint);
        let s = run(&text, &["FRICTION(1,3)"], 1e-6);
        let expected = -0.2 * 2.0 * G * 0.4 / (1e-3 * 0.5);
        let found = first(&s, "FRICTION(1,3)");
        assert!(
            (found - expected).abs() < 1e-6 * expected.abs(),
            "{joint} {change}: {found}, not {expected}"
        );
    }
}

/// A block on a plane of slope `tangent`, with its friction.
fn on_slope(tangent: f64, friction: &str) -> String {
    let theta = tangent.atan();
    format!(
        "PART/2, MASS=2, CM=2, IP=1,1,1\nMARKER/2, PART=2, REULER=90D,90D,0\nMARKER/4, PART=1, REULER=90D,90D,0\n\
         JOINT/1, TRANSLATIONAL, I=2, J=4\nACCGRAV/IGRAV={:?}, KGRAV={:?}\n\
         FRICTION/1, JOINT=1, MU_STATIC=0.3, MU_DYNAMIC=0.2{friction}\n",
        G * theta.sin(),
        -G * theta.cos()
    )
}

const METHODS: [&str; 3] = ["AUTO", "DOP853", "RADAU5"];

#[test]
fn below_the_angle_of_friction_a_block_is_held_within_the_stiction_deformation() {
    for (tangent, velocity, deformation) in [
        (0.05, 1e-2, 1e-4),
        (0.15, 1e-2, 1e-4),
        (0.25, 1e-3, 1e-5),
        (0.29, 1e-2, 1e-3),
    ] {
        let text = on_slope(
            tangent,
            &format!(
                ", STICTION_TRANSITION_VELOCITY={velocity:?}, MAX_STICTION_DEFORMATION={deformation:?}"
            ),
        );
        for method in METHODS {
            let what = format!("slope {tangent} by {method}");
            let mut s = session_by(
                &text,
                &["DX(2,1)", "VX(2,1)", "FRICTION(1,3)"],
                method,
                1e-7,
            );
            go(&mut s, Analysis::Dynamic, 20.0, 10);
            // S(x/Δ) = tan θ/µ_s
            let moved = last(&s, "DX(2,1)") / deformation;
            let held = (15.0 * moved - 10.0 * moved.powi(3) + 3.0 * moved.powi(5)) / 8.0;
            assert!(
                (held - tangent / 0.3).abs() < 1e-3,
                "{what}: {moved} of the deformation"
            );
            assert!(
                last(&s, "VX(2,1)").abs() < 1e-6 * velocity,
                "{what}: {}",
                last(&s, "VX(2,1)")
            );
            let load = 2.0 * G * tangent.atan().sin();
            let force = last(&s, "FRICTION(1,3)");
            assert!(
                (force + load).abs() < 1e-4 * load,
                "{what}: {force} holds {load}"
            );
        }
    }
}

#[test]
fn above_the_angle_of_friction_a_block_breaks_away_and_slides_under_dynamic_friction() {
    let tangent: f64 = 0.31;
    let law = ", STICTION_TRANSITION_VELOCITY=0.01, MAX_STICTION_DEFORMATION=1E-4";
    for method in METHODS {
        let mut s = session_by(&on_slope(tangent, law), &["ACCX(2,1)"], method, 1e-7);
        go(&mut s, Analysis::Dynamic, 2.0, 10);
        let theta = tangent.atan();
        let expected = G * (theta.sin() - 0.2 * theta.cos());
        assert!(
            (last(&s, "ACCX(2,1)") - expected).abs() < 1e-6,
            "{method}: {}",
            last(&s, "ACCX(2,1)")
        );
    }
}

#[test]
fn a_load_that_vibrates_within_the_cone_moves_nothing_on() {
    let law = ", STICTION_TRANSITION_VELOCITY=0.01, MAX_STICTION_DEFORMATION=1E-4";
    // tan θ = 0.15, shaken by a third of the static limit
    let shake = "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=4, FUNCTION=1.9*SIN(60*TIME)\n";
    let text = on_slope(0.15, law) + shake;
    let mut s = session_by(&text, &["DX(2,1)"], "AUTO", 1e-7);
    go(&mut s, Analysis::Dynamic, 20.0, 200);
    let all = values(&s, "DX(2,1)");
    assert!(all.iter().all(|x| x.abs() < 1e-4), "{all:?}");
    // the same range in the first cycles as in the last
    let largest = |part: &[f64]| part.iter().fold(0.0_f64, |m, x| m.max(*x));
    let (early, late) = (largest(&all[20..100]), largest(&all[120..]));
    assert!((late - early).abs() < 2e-6, "{early} {late}");
}

/// The only law here is that of sticking and sliding; a dataset that asks for another one is told so.
#[test]
fn the_law_of_bristles_is_told_to_be_solved_by_that_of_sticking() {
    let ran = |formulation: &str| {
        let text = on_slope(0.15, "").replace("JOINT=1, MU", &format!("JOINT=1{formulation}, MU"));
        let s = run(&text, &["DX(2,1)"], 0.1);
        let told = (s.run.record.warned().iter()).any(|w| w.contains("FORMULATION=LUGRE"));
        (told, last(&s, "DX(2,1)"))
    };
    let (plain, original, lugre) = (
        ran(""),
        ran(", FORMULATION=ORIGINAL"),
        ran(", FORMULATION=LUGRE"),
    );
    assert_eq!((plain.0, original.0, lugre.0), (false, false, true));
    assert_eq!((plain.1, plain.1), (original.1, lugre.1));
}

#[test]
fn statics_tell_that_friction_holds_nothing_there() {
    let spring = "SPRINGDAMPER/1, TRANSLATION, I=2, J=4, K=1000, C=10, LENGTH=0\n";
    let text = on_slope(0.15, "").replace("PART/2, ", "PART/2, QG=0.01,0,0, ") + spring;
    let told = |text: &str| {
        let mut s = session_by(text, &["DX(2,1)"], "AUTO", 1e-7);
        go(&mut s, Analysis::Static, 0.0, 0);
        s.run
            .record
            .warned()
            .iter()
            .any(|w| w.contains("FRICTION/1"))
    };
    assert!(told(&text));
    assert!(!told(
        &text.replace("JOINT=1, MU", "JOINT=1, INACTIVE=STATIC, MU")
    ));
}

#[test]
fn energy_goes_into_friction_and_nowhere_else() {
    let text = format!(
        "PART/2, MASS=1, CM=3, IP=0.01,0.01,0.01\nMARKER/2, PART=2, REULER=0,90D,0\nMARKER/3, PART=2, QP=0.5,0,0\nMARKER/4, PART=1, REULER=0,90D,0\n\
         JOINT/1, REVOLUTE, I=2, J=4\nACCGRAV/KGRAV=-{G}\n\
         FRICTION/1, JOINT=1, MU_STATIC=0.2, MU_DYNAMIC=0.2, PIN_RADIUS=0.05, STICTION_TRANSITION_VELOCITY=0.01\n\
         DIFF/1, FUNCTION=FRICTION(1,6)*FRICTION(1,19)\n"
    );
    let energy = format!("0.5*VM(3)**2+0.005*WM(2)**2+{G}*DZ(3)");
    let s = run(&text, &[&energy, "DIF(1)"], 3.0);
    for (e, w) in values(&s, &energy).iter().zip(values(&s, "DIF(1)")) {
        assert!((e - w).abs() < 1e-6, "{e} {w}");
    }
    assert!(last(&s, "DIF(1)") < -0.5);
}

#[test]
fn a_joint_without_a_friction_law_is_refused() {
    let text = "TEST\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n\
                JOINT/1, PLANAR, I=2, J=1\nFRICTION/3, JOINT=1, MU_STATIC=0.1, MU_DYNAMIC=0.1\nEND\n";
    let told = Model::from_text(text).expect_err("none").to_string();
    assert!(
        told.contains("FRICTION/3") && told.contains("wrong_joint"),
        "{told}"
    );
}
