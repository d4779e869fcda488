//! AUTO takes the method whose steps cost less, whatever holds those of the other one short, and trials cost a small part of a run.

use crate::running;

use running::{Analysis, Session, go, off, rest, session_by};
use std::fmt::Write;

/// An arm of `n` links from rest in its equilibrium, every other one on a bushing whose vibrations are hardly damped; motors turn the joints.
fn arm(n: usize, stiffness: f64, method: &str) -> Session {
    let mut text = String::new();
    for k in 0..n {
        let (p, m) = (k + 2, 100 * (k + 2));
        let before = if k == 0 { 1 } else { m - 98 };
        write!(
            text,
            "PART/{p}, MASS=2, CM={m}, IP=0.02,0.03,0.04, QG={},0,0\n\
             MARKER/{m}, PART={p}, QP=0.15,0,0\n\
             MARKER/{}, PART={p}\n\
             MARKER/{}, PART={p}, QP=0.3,0,0\n",
            0.3 * k as f64,
            m + 1,
            m + 2
        )
        .unwrap();
        let i = m + 1;
        if k % 2 == 0 {
            write!(
                text,
                "JOINT/{p}, REVOLUTE, I={i}, J={before}\n\
                 SFORCE/{p}, ROTATIONAL, I={i}, J={before}, FUNCTION=-20*WZ({i},{before},{before})\n\
                 , -100*(AZ({i},{before})-0.3*SIN({}*TIME))\n",
                k + 1
            )
            .unwrap();
        } else {
            let (k, c, kt, ct) = (
                stiffness,
                1e-3 * (2.0 * stiffness).sqrt(),
                1e-3 * stiffness,
                1e-3 * (3e-5 * stiffness).sqrt(),
            );
            writeln!(
                text,
                "BUSHING/{p}, I={i}, J={before}, K={k},{k},{k}, KT={kt},{kt},{kt}, C={c},{c},{c}, CT={ct},{ct},{ct}"
            )
            .unwrap();
        }
    }
    text += "ACCGRAV/KGRAV=-9.81\n";
    let mut s = session_by(&text, &["DX(602,1)", "DY(602,1)"], method, 1e-6);
    rest(&mut s);
    s
}

#[test]
fn hardly_damped_vibrations_that_nothing_excites_are_left_to_the_implicit_method() {
    let run = |method: &str| {
        let mut s = arm(6, 1e10, method);
        go(&mut s, Analysis::Dynamic, 0.3, 30);
        s
    };
    let [explicit, auto] = ["DOP853", "AUTO"].map(run);
    let evaluations = |s: &Session| s.run.record.counts.evaluations;
    let (e, a) = (evaluations(&explicit), evaluations(&auto));
    println!("{e} evaluations by DOP853, {a} by AUTO");
    assert!(2 * a < e, "{a} of {e}");
    let times = running::values(&explicit, "time");
    for column in ["DX(602,1)", "DY(602,1)"] {
        let known = running::values(&explicit, column);
        let at = |t: f64| known[times.iter().position(|x| *x == t).unwrap()];
        let off = off(&auto, column, at);
        assert!(off < 1e-4, "{column}: {off:e}");
    }
}

/// Nothing holds these steps short but what is asked for.
#[test]
fn trials_in_vain_cost_a_small_part_of_a_run_and_are_not_told() {
    let text = "PART/2, MASS=1, CM=2, IP=0.1,0.1,0.1\nMARKER/2, PART=2, QP=1,0,0\nMARKER/3, PART=2\nMARKER/4, PART=1\n\
                JOINT/1, REVOLUTE, I=3, J=4\n\
                PART/3, MASS=1, CM=5, IP=0.1,0.1,0.1, QG=2,0,0\nMARKER/5, PART=3, QP=0,1,0\nMARKER/6, PART=3\nMARKER/7, PART=2, QP=2,0,0\n\
                JOINT/2, REVOLUTE, I=6, J=7\nACCGRAV/JGRAV=-9.81\n";
    let run = |method: &str| {
        let mut s = session_by(text, &["DX(5,4)"], method, 1e-7);
        go(&mut s, Analysis::Dynamic, 60.0, 60);
        s
    };
    let [explicit, auto] = ["DOP853", "AUTO"].map(run);
    let evaluations = |s: &Session| s.run.record.counts.evaluations as f64;
    let more = evaluations(&auto) / evaluations(&explicit);
    println!("{more} times the evaluations of DOP853");
    assert!(more < 1.08, "{more}");
    let told = |s: &Session| format!("{:?}", s.run.record);
    assert!(!told(&auto).contains("RADAU5"), "{}", told(&auto));
}
