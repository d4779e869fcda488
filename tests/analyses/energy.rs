//! The account of energy closes: what is put in is stored, moves, or is lost, by every method that keeps the request.

use crate::running;

use cognate::results::Energy;
use running::{Analysis, go, session_by};

const METHODS: [&str; 2] = ["DOP853", "RADAU5"];

/// The account of a dynamic run.
fn account(text: &str, method: &str, (end, steps): (f64, usize), error: f64) -> Energy {
    let mut s = session_by(text, &[], method, error);
    go(&mut s, Analysis::Dynamic, end, steps);
    let energy = s.run.record.energy;
    println!("{method}: {energy:?}");
    energy
}

/// The balance of the account at the end, written out by its definition.
fn balance(e: &Energy) -> f64 {
    let change = e.kinetic[1] - e.kinetic[0] + e.potential[1] - e.potential[0];
    change + e.stored + e.dissipated - e.by_motions - e.by_functions
}

fn closes(e: &Energy, tolerance: f64) {
    assert!(e.scale > 0.0);
    assert!(e.error() < tolerance, "{e:?}");
    assert!(balance(e).abs() <= e.imbalance + 1e-12 * e.scale, "{e:?}");
}

fn near(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() < tolerance, "{a} instead of {b}");
}

/// A mass of 2 at x = 0.5 on a spring (k = 50) and damper along x to the origin, and what else acts.
fn mass_on_a_spring(damping: f64, more: &str) -> String {
    format!(
        "PART/2, MASS=2, CM=2, IP=1,1,1, QG=1.5,0,0\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=3, J=4\n\
         MARKER/3, PART=2, REULER=90D,90D,0\nMARKER/4, PART=1, REULER=90D,90D,0\n\
         SPRINGDAMPER/1, TRANSLATION, I=2, J=1, K=50, C={damping:?}, LENGTH=1\n{more}"
    )
}

#[test]
fn without_damping_the_spring_gives_back_what_it_took() {
    for method in METHODS {
        // half a period: k = 50, m = 2
        let e = account(
            &mass_on_a_spring(0.0, ""),
            method,
            (0.5 * std::f64::consts::PI / 5.0, 7),
            1e-9,
        );
        closes(&e, 1e-7);
        near(e.kinetic[1], 0.5 * 50.0 * 0.25, 1e-6);
        near(e.stored, -0.5 * 50.0 * 0.25, 1e-6);
        near(e.dissipated + e.by_functions + e.by_motions, 0.0, 1e-12);
    }
}

#[test]
fn a_damper_dissipates_all_of_it_in_the_end() {
    for method in METHODS {
        let e = account(&mass_on_a_spring(8.0, ""), method, (20.0, 3), 1e-9);
        closes(&e, 1e-6);
        near(e.dissipated, 0.5 * 50.0 * 0.25, 1e-5);
        near(e.kinetic[1], 0.0, 1e-8);
    }
}

#[test]
fn a_force_in_time_puts_in_its_work() {
    // v = 3 t²/2 … on m = 2: F = 6 t, T = ½ 2 (1.5 t²)² at t = 2
    let text = "PART/2, MASS=2, CM=2, IP=1,1,1\nMARKER/2, PART=2, REULER=90D,90D,0\nMARKER/4, PART=1, REULER=90D,90D,0\n\
         JOINT/1, TRANSLATIONAL, I=2, J=4\nSFORCE/1, TRANSLATION, I=2, J=4, ACTIONONLY, FUNCTION=6*TIME\n";
    for method in METHODS {
        let e = account(text, method, (2.0, 1), 1e-9);
        closes(&e, 1e-7);
        near(e.by_functions, 36.0, 1e-5);
    }
}

#[test]
fn a_motion_puts_in_what_its_mechanism_takes() {
    // a driven crank with a pendulum on its end
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2, QP=0.5,0,0\nMARKER/3, PART=2\nMARKER/5, PART=2, QP=1,0,0\n\
         PART/3, MASS=2, CM=6, IP=1,1,1\nMARKER/6, PART=3, QP=1,-1,0\nMARKER/7, PART=3, QP=1,0,0\n\
         JOINT/1, REVOLUTE, I=3, J=1\nJOINT/2, REVOLUTE, I=7, J=5\nMOTION/1, JOINT=1, ROTATION, FUNCTION=3*TIME**2\n\
         ACCGRAV/JGRAV=-9.81\n";
    for method in METHODS {
        let e = account(text, method, (2.0, 5), 1e-9);
        closes(&e, 2e-6);
        assert!(e.by_motions.abs() > 1.0, "{e:?}");
        near(e.stored + e.dissipated + e.by_functions, 0.0, 1e-12);
    }
}

#[test]
fn a_contact_stores_and_dissipates_however_few_outputs_there_are() {
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1, QG=0,0,0.3\nMARKER/2, PART=2\nGRAPHICS/1, PLANE, RM=1\n\
         GRAPHICS/2, ELLIPSOID, CM=2, XSCALE=0.2, YSCALE=0.2, ZSCALE=0.2\nACCGRAV/KGRAV=-9.81\n\
         CONTACT/1, IGEOM=2, JGEOM=1, IMPACT, STIFFNESS=1E5, EXPONENT=1.5, DAMPING=50, DMAX=1E-3\n";
    for method in ["AUTO", "DOP853", "RADAU5"] {
        let e = account(text, method, (2.0, 3), 1e-8);
        closes(&e, 1e-5);
        assert!(e.dissipated > 0.1, "{e:?}");
        near(e.by_functions, 0.0, 1e-12);
    }
}

#[test]
fn friction_in_a_joint_takes_the_energy_of_a_block() {
    let text = "PART/2, MASS=2, CM=3, IP=1,1,1, VX=3\nMARKER/2, PART=2, REULER=90D,90D,0\nMARKER/3, PART=2\n\
         MARKER/4, PART=1, REULER=90D,90D,0\nJOINT/1, TRANSLATIONAL, I=2, J=4\nACCGRAV/KGRAV=-9.81\n\
         FRICTION/1, JOINT=1, MU_STATIC=0.3, MU_DYNAMIC=0.2, STICTION_TRANSITION_VELOCITY=0.01\n";
    let e = account(text, "AUTO", (0.5, 2), 1e-8);
    closes(&e, 1e-6);
    let v = 3.0 - 0.2 * 9.81 * 0.5;
    near(e.dissipated, 9.0 - v * v, 1e-5);
}

/// The account of a kinematic run with a number of outputs.
fn driven(text: &str, end: f64, outputs: usize) -> Energy {
    let mut s = running::session(text, &[], 1e-6);
    go(&mut s, Analysis::Kinematic, end, outputs);
    s.run.record.energy
}

#[test]
fn a_driven_mechanism_without_freedom_has_an_account_too() {
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2, QP=0.5,0,0\nMARKER/3, PART=2\n\
         JOINT/1, REVOLUTE, I=3, J=1\nMOTION/1, JOINT=1, ROTATION, FUNCTION=3*TIME**2\n\
         SPRINGDAMPER/1, ROTATION, I=3, J=1, KT=0, CT=2\n";
    for outputs in [1, 5, 2000] {
        let e = driven(text, 2.0, outputs);
        // ω = 6 t: ½ J ω², and ∫ 2 ω² dt
        near(e.kinetic[1], 0.5 * 1.25 * 144.0, 1e-9);
        near(e.dissipated, 2.0 * 36.0 * 8.0 / 3.0, 1e-8);
        near(balance(&e), 0.0, 1e-9 * e.scale);
    }
}

#[test]
fn the_number_of_outputs_changes_nothing_in_the_account_of_a_driven_mechanism() {
    // a crank, rod and slider with a spring and damper on the slider, and a force that acts for a while
    let loop_of_slider = "PART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=1,0,0\n\
         PART/3, MASS=1, CM=30, IP=1,1,1, QG=1,0,0\nMARKER/30, PART=3\nMARKER/31, PART=3, QP=3,0,0\n\
         PART/4, MASS=1, CM=40, IP=1,1,1, QG=4,0,0\nMARKER/40, PART=4\nMARKER/41, PART=4, REULER=90D,90D,0\n\
         MARKER/11, PART=1, REULER=90D,90D,0\nMARKER/12, PART=1, QP=-3,0,0\nJOINT/1, REVOLUTE, I=20, J=1\n\
         JOINT/2, REVOLUTE, I=30, J=21\nJOINT/3, REVOLUTE, I=31, J=40\nJOINT/4, TRANSLATIONAL, I=41, J=11\n\
         MOTION/1, JOINT=1, ROTATION, FUNCTION=2*TIME\nSPRINGDAMPER/1, TRANSLATION, I=40, J=12, K=5, C=3, LENGTH=2\n\
         SFORCE/1, TRANSLATION, I=40, J=12, FUNCTION=STEP(TIME,1,0,1.2,4)-STEP(TIME,2,0,2.1,4)\n";
    let turning = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2, QP=0.5,0,0\nMARKER/3, PART=2\n\
         JOINT/1, REVOLUTE, I=3, J=1\nMOTION/1, JOINT=1, ROTATION, FUNCTION=40*TIME\n\
         SFORCE/1, ROTATION, I=3, J=1, ACTIONONLY, FUNCTION=SIN(AZ(3,1))**2\n";
    for text in [loop_of_slider, turning] {
        let many = driven(text, 5.0, 4001);
        for outputs in [1, 2, 7, 200] {
            assert_eq!(driven(text, 5.0, outputs), many, "{outputs}");
        }
        assert!(many.error() < 1e-6, "{many:?}");
    }
    // ∫ sin²(40 t) 40 dt
    let work = 0.5 * 200.0 - 0.25 * 400.0_f64.sin();
    near(driven(turning, 5.0, 3).by_functions, work, 1e-6 * work);
}

const ALL_METHODS: [&str; 3] = ["AUTO", "DOP853", "RADAU5"];

/// Where forces balance, rounding and permitted errors move what is at rest: a balance of nothing else has no error.
#[test]
fn what_stands_still_has_hardly_any_error_of_energy() {
    let slider = |place: f64, force: &str| {
        format!(
            "PART/2, MASS=2, CM=2, IP=1,1,1, QG={place:?},0,0\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=3, J=4\n\
             MARKER/3, PART=2, REULER=90D,90D,0\nMARKER/4, PART=1, REULER=90D,90D,0\n\
             SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=3, J=4, FUNCTION={force}\n"
        )
    };
    let ball = "PART/2, MASS=2, CM=2, IP=1,1,1, QG=0,0,0.0999\nMARKER/2, PART=2\n\
                GRAPHICS/1, ELLIPSOID, CM=2, XSCALE=0.2, YSCALE=0.2, ZSCALE=0.2\n\
                GRAPHICS/2, PLANE, RM=1, XMIN=-1, XMAX=1, YMIN=-1, YMAX=1\n\
                CONTACT/1, IGEOM=1, JGEOM=2, IMPACT, STIFFNESS=196200, EXPONENT=1, DAMPING=10, DMAX=1e-6\n\
                ACCGRAV/KGRAV=-9.81\n";
    let at_rest = [
        // held by dry friction
        slider(0.0, "5*SIN(3*TIME)-10*SIGN(1,VX(2,1))"),
        // on a stiff spring, and on a stiff plane
        slider(0.300000001, "-1e9*(DX(2,1)-0.3)+1"),
        ball.to_string(),
    ];
    for text in at_rest {
        for method in ALL_METHODS {
            for error in [1e-2, 1e-5] {
                let e = account(&text, method, (1.0, 10), error);
                assert!(e.error() < 0.02, "{method} {error:e}: {e:?}");
            }
        }
    }
}

/// Small motions have an account as large ones do, wherever gravity counts from.
#[test]
fn small_motions_have_an_account_wherever_they_are() {
    for method in ALL_METHODS {
        for width in [1e-3, 1.0, 1e3] {
            let text = format!("{}ACCGRAV/IGRAV=-9.81\n", mass_on_a_spring(0.0, ""));
            let text = text.replace(
                "QG=1.5,0,0",
                &format!("QG={:?},0,0", 1.0 - 2.0 * 9.81 / 50.0 + width),
            );
            let e = account(&text, method, (3.0, 10), 1e-4);
            assert!(
                e.scale > 0.0 && e.error() < 0.02,
                "{method} {width:e}: {e:?}"
            );
        }
        // a mass of a ton that hums a millimetre wide, a million metres up: its weight is stored to a joule
        let text = "PART/2, MASS=1000, CM=2, IP=1,1,1, QG=1e6,0,0\nMARKER/2, PART=2\nMARKER/5, PART=1, QP=1e6,0,0\n\
                    JOINT/1, TRANSLATIONAL, I=3, J=4\nMARKER/3, PART=2, REULER=90D,90D,0\n\
                    MARKER/4, PART=1, REULER=90D,90D,0\nACCGRAV/IGRAV=-9.81\n\
                    SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=3, J=4, FUNCTION=9810-100*(DX(2,5)-1e-3)\n";
        let e = account(text, method, (100.0, 10), 1e-4);
        assert!(e.error() < 0.02, "{method}: {e:?}");
    }
}

/// Where a motion stays at the place at which a function changes branch, the mean of its branches does the work; where it passes such a
/// place, the branch on which the step lies.
#[test]
fn work_of_forces_that_jump_closes_the_account() {
    let slider = |force: &str| {
        format!(
            "PART/2, MASS=1.3, CM=2, IP=1,1,1, QG=0.3,0,0, VX=-0.4\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=3, J=4\n\
             MARKER/3, PART=2, REULER=90D,90D,0\nMARKER/4, PART=1, REULER=90D,90D,0\n\
             SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=3, J=4, FUNCTION={force}\n"
        )
    };
    let forces = [
        // a relay, which slides along DX + 0.5 VX = 0
        "-1.6*SIGN(1,DX(2,1)+0.49385*VX(2,1))",
        "-3*SIGN(1,DX(2,1)+0.1*VX(2,1))-2*DX(2,1)",
        // springs with a step where they meet
        "IF(DX(2,1)-0.13:-250*DX(2,1),0,-414*DX(2,1)-1.8)-0.12*VX(2,1)",
        "IF(DX(2,1):3,0,-5)-20*DX(2,1)",
    ];
    for force in forces {
        for method in ALL_METHODS {
            for error in [1e-3, 1e-6] {
                let e = account(&slider(force), method, (3.0, 10), error);
                let permitted = if error < 1e-5 { 1e-3 } else { 0.05 };
                assert!(
                    e.error() < permitted,
                    "{force} {method} {error:e}: {}",
                    e.error()
                );
            }
        }
    }
}

/// What a force just overcomes and then holds again moves by a ten-thousandth of a millimetre: the friction of the side on
/// which each step was taken counts, not that of the state at which it ends.
#[test]
fn works_are_those_of_the_branches_on_which_steps_are_taken() {
    let text = "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nJOINT/1, TRANSLATIONAL, I=2, J=1\n\
         SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=2, J=1, FUNCTION=5.0005*SIN(TIME)-5*SIGN(1,VZ(2,1))\n";
    for method in METHODS {
        for error in [1e-4, 1e-6, 1e-9] {
            let e = account(text, method, (10.0, 50), error);
            closes(&e, 1e-3);
        }
    }
}
