//! Functions that read what depends on them: VARIABLEs through each other, forces from accelerations, reactions and themselves,
//! implicit differential equations; and what is said when there is no solution.

use crate::running;

use cognate::results::Status;
use running::{Analysis, Session, go, last, mistakes, session_by, try_to, values};

fn run(text: &str, columns: &[&str], method: &str, end: f64) -> Session {
    let mut s = session_by(text, columns, method, 1e-10);
    go(&mut s, Analysis::Dynamic, end, 4);
    s
}

fn fails(text: &str) -> String {
    let mut s = session_by(text, &["VARVAL(1)"], "AUTO", 1e-6);
    let errors = mistakes(&mut s, Analysis::Dynamic);
    format!(
        "{} {}",
        errors[0].element.clone().unwrap_or_default(),
        errors[0].message
    )
}

/// A mass that may move along x.
const BODY: &str = "PART/2, MASS=1, CM=2\nMARKER/2, PART=2, REULER=90D,90D,0\nMARKER/3, PART=1, REULER=90D,90D,0\n\
                    JOINT/1, TRANSLATIONAL, I=2, J=3\n";

#[test]
fn variables_that_read_themselves_are_solved() {
    let text = format!(
        "{BODY}VARIABLE/1, FUNCTION=0.5*VARVAL(1)+1\n\
         VARIABLE/2, FUNCTION=VARVAL(3)+1+TIME\nVARIABLE/3, FUNCTION=VARVAL(2)/2\n\
         VARIABLE/4, IC=0.5, FUNCTION=COS(VARVAL(4))\n\
         VARIABLE/5, IC=3, FUNCTION=VARVAL(5)**2-2\nVARIABLE/6, IC=-3, FUNCTION=VARVAL(6)**2-2\n"
    );
    let columns = [
        "VARVAL(1)",
        "VARVAL(2)",
        "VARVAL(3)",
        "VARVAL(4)",
        "VARVAL(5)",
        "VARVAL(6)",
    ];
    let s = run(&text, &columns, "AUTO", 1.0);
    for (row, &t) in values(&s, "time").iter().enumerate() {
        let expected = [
            2.0,
            2.0 + 2.0 * t,
            1.0 + t,
            0.739_085_133_215_160_6,
            2.0,
            -1.0,
        ];
        for (column, e) in columns.iter().zip(expected) {
            let x = values(&s, column)[row];
            assert!((x - e).abs() < 1e-12, "{column} = {x} at {t}");
        }
    }
}

#[test]
fn loops_without_a_solution_are_named() {
    let always = fails("VARIABLE/1, FUNCTION=VARVAL(1)+1\n");
    assert!(always.contains("VARIABLE/1"), "{always}");
    let together = fails("VARIABLE/1, FUNCTION=VARVAL(2)+1\nVARIABLE/2, FUNCTION=VARVAL(1)\n");
    assert!(together.contains("VARIABLE/1"), "{together}");
    let nowhere = fails("VARIABLE/1, FUNCTION=VARVAL(1)**2+1\n");
    assert!(nowhere.contains("VARIABLE/1"), "{nowhere}");
}

#[test]
fn a_force_against_its_acceleration_is_added_mass() {
    let text =
        format!("{BODY}SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=3-0.5*ACCX(2,1)\n");
    for method in ["DOP853", "RADAU5"] {
        let s = run(
            &text,
            &["ACCX(2,1)", "DX(2,1)", "SFORCE(1,0,2,0)"],
            method,
            1.0,
        );
        let t = values(&s, "time").to_vec();
        for (row, t) in t.iter().enumerate() {
            assert!((values(&s, "ACCX(2,1)")[row] - 2.0).abs() < 1e-13);
            assert!((values(&s, "DX(2,1)")[row] - t * t).abs() < 1e-9);
            assert!((values(&s, "SFORCE(1,0,2,0)")[row] - 2.0).abs() < 1e-13);
        }
    }
}

#[test]
fn a_force_that_is_not_linear_in_its_acceleration_is_solved_by_iteration() {
    // a = 2 − v − a³, so at rest a + a³ = 2
    let text = format!(
        "{BODY}SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=2-VX(2,1)-ACCX(2,1)**3\n"
    );
    let mut ends = Vec::new();
    for method in ["DOP853", "RADAU5"] {
        let s = run(&text, &["ACCX(2,1)", "VX(2,1)"], method, 2.0);
        let (a, v) = (values(&s, "ACCX(2,1)"), values(&s, "VX(2,1)"));
        assert!((a[0] - 1.0).abs() < 1e-13);
        // dv/dt = a, v = 2 − a − a³: t = ∫ −(1 + 3a²)/a da = −ln a − 1.5 (a² − 1)
        for ((a, v), t) in a.iter().zip(v).zip(values(&s, "time")) {
            assert!((a + a.powi(3) + v - 2.0).abs() < 1e-12);
            assert!(
                (-a.ln() - 1.5 * (a * a - 1.0) - t).abs() < 1e-8,
                "{method}: {a} at {t}"
            );
        }
        ends.push(v[v.len() - 1]);
    }
    assert!((ends[0] - ends[1]).abs() < 1e-8);
}

#[test]
fn friction_in_proportion_to_the_reaction_slides_as_coulomb_says() {
    // an incline of 30 degrees; z of the joint points downhill
    let text = "PART/2, MASS=2, CM=2, IP=1,1,1\nMARKER/2, PART=2, REULER=90D,120D,0\nMARKER/3, PART=1, REULER=90D,120D,0\n\
                JOINT/1, TRANSLATIONAL, I=2, J=3\nACCGRAV/KGRAV=-9.81\n\
                SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=-0.2*JOINT(1,0,1,0)\n\
                VARIABLE/1, FUNCTION=SQRT(JOINT(1,0,2,0)**2+JOINT(1,0,3,0)**2+JOINT(1,0,4,0)**2)\n";
    let s = run(
        text,
        &["ACCM(2,1)", "JOINT(1,0,1,0)", "VARVAL(1)"],
        "AUTO",
        0.1,
    );
    let (sin, cos) = (0.5, 0.75_f64.sqrt());
    for row in 0..values(&s, "time").len() {
        assert!((values(&s, "JOINT(1,0,1,0)")[row] - 2.0 * 9.81 * cos).abs() < 1e-9);
        assert!((values(&s, "VARVAL(1)")[row] - 2.0 * 9.81 * cos).abs() < 1e-9);
        assert!((values(&s, "ACCM(2,1)")[row] - 9.81 * (sin - 0.2 * cos)).abs() < 1e-9);
    }
}

#[test]
fn forces_that_read_themselves_and_each_other_are_solved() {
    let text = format!(
        "{BODY}SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=1+0.5*SFORCE(2,0,2,0)\n\
         SFORCE/2, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=SFORCE(1,0,2,0)-0.5*SFORCE(2,0,2,0)\n"
    );
    // f = 1 + g/2, 1.5 g = f: f = 1.5, g = 1
    let s = run(
        &text,
        &["SFORCE(1,0,2,0)", "SFORCE(2,0,2,0)", "ACCX(2,1)"],
        "AUTO",
        1.0,
    );
    for (column, e) in [
        ("SFORCE(1,0,2,0)", 1.5),
        ("SFORCE(2,0,2,0)", 1.0),
        ("ACCX(2,1)", 2.5),
    ] {
        assert!(
            values(&s, column).iter().all(|x| (x - e).abs() < 1e-12),
            "{column}"
        );
    }
}

#[test]
fn implicit_differential_equations_are_solved() {
    let text = format!(
        "{BODY}DIFF/1, IC=1, IMPLICIT, FUNCTION=2*DIF1(1)+DIF(1)\n\
         DIFF/2, IC=-2,1, IMPLICIT, FUNCTION=DIF1(2)**3+DIF1(2)+DIF(2)\n\
         DIFF/3, IC=1, IMPLICIT, FUNCTION=DIF(3)**2-1-TIME\n\
         DIFF/4, IC=0, FUNCTION=DIF(3)\n"
    );
    let columns = ["DIF(1)", "DIF1(1)", "DIF(2)", "DIF1(2)", "DIF(3)", "DIF(4)"];
    for method in ["DOP853", "RADAU5"] {
        let s = run(&text, &columns, method, 2.0);
        for (row, &t) in values(&s, "time").iter().enumerate() {
            let at = |c: &str| values(&s, c)[row];
            let y = (-t / 2.0).exp();
            assert!((at("DIF(1)") - y).abs() < 1e-9 && (at("DIF1(1)") + y / 2.0).abs() < 1e-9);
            let p = at("DIF1(2)");
            assert!((p.powi(3) + p + at("DIF(2)")).abs() < 1e-12);
            assert!(
                (-p.ln() - 1.5 * (p * p - 1.0) - t).abs() < 1e-8,
                "{p} at {t}"
            );
            assert!((at("DIF(3)") - (1.0 + t).sqrt()).abs() < 1e-12);
            assert!((at("DIF(4)") - 2.0 / 3.0 * ((1.0 + t).powf(1.5) - 1.0)).abs() < 1e-8);
        }
    }
}

#[test]
fn a_loop_that_changes_branch_is_located() {
    // v = |t − 1| + v/2: twice |t − 1|, whose integral is exact only when the kink is met
    let text = format!(
        "{BODY}VARIABLE/1, FUNCTION=ABS(TIME-1)+VARVAL(1)/2\nDIFF/1, IC=0, FUNCTION=VARVAL(1)\n"
    );
    let s = run(&text, &["DIF(1)"], "AUTO", 2.0);
    assert!((values(&s, "DIF(1)").last().unwrap() - 2.0).abs() < 1e-12);
}

#[test]
fn a_loop_that_ends_stops_the_run_and_is_named() {
    // v = v² + t has a solution until t = 1/4
    let text =
        format!("{BODY}VARIABLE/1, FUNCTION=VARVAL(1)**2+TIME\nDIFF/1, IC=0, FUNCTION=VARVAL(1)\n");
    let mut s = session_by(&text, &["DIF(1)", "VARVAL(1)"], "AUTO", 1e-6);
    let status = try_to(&mut s, Analysis::Dynamic, 1.0, 100);
    assert_eq!(status, Status::Stopped);
    let why = &s.run.record.stop_reason;
    assert!(why.contains("VARIABLE/1"), "{why}");
    let reached = *values(&s, "time").last().unwrap();
    // at 1/4 the two solutions meet: a little beyond, v = 1/2 still leaves no more than rounding
    assert!((0.2..0.25 + 1e-14).contains(&reached), "{reached}: {why}");
}

#[test]
fn statics_solves_loops_too() {
    let text = format!(
        "{BODY}SPRINGDAMPER/1, TRANSLATION, I=2, J=9, K=10, LENGTH=1\nMARKER/9, PART=1, QP=-1,0,0\n\
         VARIABLE/1, IC=0, FUNCTION=0.1*VARVAL(1)**2+1-DX(2,1)\n\
         SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=VARVAL(1)\n"
    );
    let mut s = session_by(&text, &["DX(2,1)", "VARVAL(1)"], "AUTO", 1e-6);
    go(&mut s, Analysis::Static, 0.0, 1);
    let (x, v) = (
        *values(&s, "DX(2,1)").last().unwrap(),
        *values(&s, "VARVAL(1)").last().unwrap(),
    );
    assert!(
        (v - 10.0 * x).abs() < 1e-11 && (0.1 * v * v + 1.0 - x - v).abs() < 1e-11,
        "{x} {v}"
    );
}

/// A body in space with mass 2 and inertia 3, 4, 5, and a force of every form against its own acceleration.
const SPACE: &str = "PART/2, MASS=2, CM=2, IP=3,4,5\nMARKER/2, PART=2\nMARKER/7, PART=1, FLOATING\nMARKER/8, PART=1, FLOATING\nMARKER/9, PART=1, FLOATING\n";

#[test]
fn every_form_of_force_may_read_the_accelerations_it_makes() {
    // added mass 0.5, 1, 2 along the axes, added inertia 1, 1, 1 about them
    let vector = "FX=3-0.5*ACCX(2)\\ FY=2-ACCY(2)\\ FZ=1-2*ACCZ(2)";
    let torque = "TX=4-WDTX(2)\\ TY=3-WDTY(2)\\ TZ=2-WDTZ(2)";
    let exact = [
        ("ACCX(2)", 3.0 / 2.5),
        ("ACCY(2)", 2.0 / 3.0),
        ("ACCZ(2)", 1.0 / 4.0),
        ("WDTX(2)", 4.0 / 4.0),
        ("WDTY(2)", 3.0 / 5.0),
        ("WDTZ(2)", 2.0 / 6.0),
    ];
    let separate = format!(
        "VFORCE/1, I=2, JFLOAT=9, RM=1, {vector}\nVTORQUE/1, I=2, JFLOAT=8, RM=1, {torque}\n"
    );
    let together = format!("GFORCE/1, I=2, JFLOAT=9, RM=1, {vector}\\ {torque}\n");
    // SFORCE along and about z of a marker, for the z axes alone
    let single = "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=1, FUNCTION=1-2*ACCZ(2)\n\
                  SFORCE/2, ROTATION, I=2, J=1, FUNCTION=2-WDTZ(2)\n";
    for (text, checked) in [
        (separate.as_str(), &exact[..]),
        (together.as_str(), &exact[..]),
        (single, &[exact[2], exact[5]][..]),
    ] {
        let columns: Vec<&str> = checked.iter().map(|c| c.0).collect();
        let s = run(&format!("{SPACE}{text}"), &columns, "AUTO", 0.1);
        for (column, e) in checked {
            // at the start nothing turns yet
            let x = values(&s, column)[0];
            assert!((x - e).abs() < 1e-12, "{column} = {x}: {text}");
        }
    }
}

#[test]
fn circles_through_all_forms_of_force_are_solved() {
    // f = 1 + g/2, g = f − g/2: f = 1.5, g = 1, round forces and round torques
    let text = format!(
        "{SPACE}VFORCE/1, I=2, JFLOAT=9, RM=1, FX=1+0.5*GFORCE(1,0,2,0)\\ FY=0\\ FZ=0\n\
         GFORCE/1, I=2, JFLOAT=8, RM=1, FX=VFORCE(1,0,2,0)-0.5*GFORCE(1,0,2,0)\\ TZ=VTORQ(1,0,8,0)-0.5*GFORCE(1,0,8,0)\n\
         VTORQUE/1, I=2, JFLOAT=7, RM=1, TX=0\\ TY=0\\ TZ=1+0.5*SFORCE(2,0,8,0)\n\
         SFORCE/2, ROTATION, ACTIONONLY, I=2, J=1, FUNCTION=GFORCE(1,0,8,0)\n"
    );
    let exact = [
        ("VFORCE(1,0,2,0)", 1.5),
        ("GFORCE(1,0,2,0)", 1.0),
        ("VTORQ(1,0,8,0)", 1.5),
        ("GFORCE(1,0,8,0)", 1.0),
        ("SFORCE(2,0,8,0)", 1.0),
        ("ACCX(2)", 1.25),
        ("WDTZ(2)", 3.5 / 5.0),
    ];
    let columns: Vec<&str> = exact.iter().map(|c| c.0).collect();
    let s = run(&text, &columns, "AUTO", 0.1);
    for (column, e) in exact {
        let x = values(&s, column)[0];
        assert!((x - e).abs() < 1e-12, "{column} = {x}");
    }
}

#[test]
fn every_form_of_force_may_read_reactions() {
    // a block on a guide along x under its weight: each form of friction takes 0.2 of what presses, 0.2 m g
    let guide = "PART/2, MASS=2, CM=2, IP=1,1,1, VX=5\nMARKER/2, PART=2, REULER=90D,90D,0\nMARKER/3, PART=1, REULER=90D,90D,0\n\
                 MARKER/9, PART=1, FLOATING\nJOINT/1, TRANSLATIONAL, I=2, J=3\nACCGRAV/KGRAV=-10\n";
    for force in [
        "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=-0.2*JOINT(1,0,4,0)",
        "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=-0.2*FZ(2,3)",
        "SFORCE/1, TRANSLATION, ACTIONONLY, I=2, J=3, FUNCTION=0.2*FZ(3,2)",
        "VFORCE/1, I=2, JFLOAT=9, RM=1, FX=-0.2*JOINT(1,0,4,0)\\ FY=0\\ FZ=0",
        "VFORCE/1, I=2, JFLOAT=9, RM=3, FX=0\\ FY=0\\ FZ=0.2*JOINT(1,1,4,0)",
        "GFORCE/1, I=2, JFLOAT=9, RM=1, FX=-0.2*JOINT(1,0,1,0)\\ TX=JOINT(1,0,6,0)*0.5",
    ] {
        let s = run(
            &format!("{guide}{force}\n"),
            &["ACCX(2)", "JOINT(1,0,4,0)"],
            "AUTO",
            0.1,
        );
        assert!(
            values(&s, "ACCX(2)")
                .iter()
                .all(|a| (a + 2.0).abs() < 1e-11),
            "{force}"
        );
        assert!(
            values(&s, "JOINT(1,0,4,0)")
                .iter()
                .all(|f| (f - 20.0).abs() < 1e-10),
            "{force}"
        );
    }
    // a wheel driven by a motion: a torque that doubles half of what the motion must give
    let wheel = "PART/2, MASS=2, CM=2, IP=3,3,3\nMARKER/2, PART=2\nMARKER/9, PART=1, FLOATING\nJOINT/1, REVOLUTE, I=2, J=1\n\
                 MOTION/1, JOINT=1, FUNCTION=TIME**2\nVTORQUE/1, I=2, JFLOAT=9, RM=1, TX=0\\ TY=0\\ TZ=0.5*MOTION(1,0,8,0)\n";
    let s = run(wheel, &["MOTION(1,0,8,0)", "VTORQ(1,0,8,0)"], "AUTO", 0.1);
    assert!(
        values(&s, "MOTION(1,0,8,0)")
            .iter()
            .all(|t| (t - 4.0).abs() < 1e-12)
    );
    assert!(
        values(&s, "VTORQ(1,0,8,0)")
            .iter()
            .all(|t| (t - 2.0).abs() < 1e-12)
    );
}

/// Friction as people write it, of the length of a reaction: the root has no slope where the iteration begins.
#[test]
fn friction_of_the_length_of_a_reaction_begins_at_a_root_of_zero() {
    let run = |function: &str| {
        let text = format!(
            "PART/2, MASS=10, CM=4, IP=1,1,1, WZ=5\nMARKER/2, PART=2\nMARKER/4, PART=2, QP=0.4,0,0\n\
             JOINT/1, REVOLUTE, I=2, J=1\nSFORCE/1, ROTATIONAL, ACTIONONLY, I=2, J=1, FUNCTION={function}\n"
        );
        last(&run(&text, &["WZ(2,1)"], "DOP853", 1.0), "WZ(2,1)")
    };
    let by_root = run("-0.004*SQRT(JOINT(1,0,2,0)**2+JOINT(1,0,3,0)**2)");
    let by_magnitude = run("-0.004*FM(2,1)");
    // 10 kg at 0.4 m: a torque of -0.004 * 4 |(w^2, w')| on 2.6 kg m2
    let k: f64 = 0.004 * 4.0 / 2.6;
    let exact = 1.0 / (0.2 + k / (1.0 - k * k).sqrt());
    assert!(
        (by_root - exact).abs() < 1e-7 && (by_magnitude - exact).abs() < 1e-7,
        "{by_root} {by_magnitude}"
    );
}

/// A hinge that is left out as redundant bears its share, which functions and friction may read: the motion is that of a
/// hinge with twice the radius, and it is said that it depends on the share.
#[test]
fn reactions_of_joints_that_are_left_out_may_be_read() {
    let pair = "PART/2, MASS=10, CM=4, IP=1,1,1, WZ=5\nMARKER/2, PART=2\nMARKER/3, PART=2, QP=0,0,1\n\
                MARKER/10, PART=1, QP=0,0,1\nMARKER/4, PART=2, QP=0.4,0,0.5\n\
                JOINT/1, REVOLUTE, I=2, J=1\nJOINT/2, REVOLUTE, I=3, J=10\n";
    let columns = ["WZ(2,1)", "JOINT(2,0,2,0)"];
    let friction = |joint: u32| {
        format!(
            "FRICTION/1, JOINT={joint}, MU_STATIC=0.2, MU_DYNAMIC=0.2, PIN_RADIUS=0.02, FRICTION_ARM=0.05, \
             STICTION_TRANSITION_VELOCITY=1E-3, MAX_STICTION_DEFORMATION=1E-5, INPUTS=REACTION_FORCE\n"
        )
    };
    let read = |joint: u32| {
        format!(
            "SFORCE/1, ROTATIONAL, ACTIONONLY, I=2, J=1, FUNCTION=-0.008*SQRT(1+JOINT({joint},0,2,0)**2)\n"
        )
    };
    let ends = |extra: &str| {
        let s = run(&format!("{pair}{extra}"), &columns, "DOP853", 1.0);
        let told = s
            .run
            .record
            .warnings
            .iter()
            .filter(|w| w.code == "open_reaction");
        assert_eq!(
            told.count(),
            usize::from(!extra.is_empty()),
            "{:?}",
            s.run.record.warned()
        );
        columns.map(|c| last(&s, c))
    };
    // both hinges are alike about the middle, so that it is the same which of them is read
    for of in [&friction as &dyn Fn(u32) -> String, &read] {
        let [first, second] = [1, 2].map(|joint| ends(&of(joint)));
        for (a, b) in first.into_iter().zip(second) {
            assert!((a - b).abs() < 1e-7 * b.abs(), "{first:?} {second:?}");
        }
    }
    // two hinges leave open how forces and torques are shared, but not the torque about their axis, which neither bears
    let along = "SFORCE/1, ROTATIONAL, ACTIONONLY, I=2, J=1, FUNCTION=-0.008*SQRT(1+(JOINT(1,0,8,0)+TZ(3,10,10))**2)\n";
    let s = run(&format!("{pair}{along}"), &columns, "DOP853", 0.1);
    assert!(
        s.run
            .record
            .warnings
            .iter()
            .all(|w| w.code != "open_reaction"),
        "{:?}",
        s.run.record.warned()
    );
    assert!((ends(&friction(2))[0] - 4.924242071).abs() < 1e-7);
    assert!((ends("")[0] - 5.0).abs() < 1e-12);
}
