//! Equilibria that stiffness holds and a push leaves all the same: loads that follow the motion, negative damping, states
//! that act back. Closed forms of flutter, and random models beside their own eigenvalues.

use crate::running;

use cognate::analysis::linear::Wanted;
use proptest::prelude::*;
use running::{GROUND, Options, Session, begin, rest, whole};
use std::fmt::Write;

/// A model at rest.
fn at_rest(text: &str) -> Session {
    let mut s = begin(whole(text), "test", Options::default());
    rest(&mut s);
    s
}

/// Whether it is told that a push off the equilibrium grows; it is said in the summary as in the warning.
fn grows(s: &Session) -> bool {
    let method = &s.run.record.method;
    let told = s
        .run
        .record
        .warnings
        .iter()
        .any(|w| w.rest.contains("grows by e in"));
    let said = method.contains("a push grows");
    assert_eq!(told, said, "{method} {:?}", s.run.record.warnings);
    assert!(
        said || method.starts_with("EQUILIBRIUM, stable"),
        "{method}"
    );
    said
}

/// The fastest growth of the modes about the present state, over the largest eigenvalue.
fn fastest(s: &mut Session) -> f64 {
    let modes = s.linearize(&Wanted::default()).unwrap().modes;
    let largest = modes.iter().fold(0.0_f64, |m, x| m.max(x.re.hypot(x.im)));
    modes.iter().fold(f64::NEG_INFINITY, |m, x| m.max(x.re)) / largest
}

/// Two rods of length 1 with a hinge of stiffness 1 at the foot of each, masses of 2 and 1 at their ends; the load follows the second.
fn ziegler(load: f64, damping: f64) -> String {
    format!(
        "{GROUND}PART/2, MASS=2, CM=22, IP=1E-9,1E-9,1E-9\nMARKER/21, PART=2\nMARKER/22, PART=2, QP=1,0,0\n\
         PART/3, MASS=1, CM=32, IP=1E-9,1E-9,1E-9, QG=1,0,0\nMARKER/31, PART=3\nMARKER/32, PART=3, QP=1,0,0, REULER=90D,90D,0\n\
         JOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=22\n\
         SPRINGDAMPER/1, ROTATION, I=21, J=1, KT=1, CT={damping}\nSPRINGDAMPER/2, ROTATION, I=31, J=22, KT=1, CT={damping}\n\
         SFORCE/1, TRANSLATION, ACTIONONLY, I=32, J=32, FUNCTION=-{load}\nEND\n"
    )
}

#[test]
fn a_double_pendulum_under_a_load_that_follows_it_flutters_from_the_known_load_on() {
    // Ziegler's column: 7/2 − √2 without damping, 41/28 + c²/2 with equal dampers c
    let critical = |c: f64| {
        if c == 0.0 {
            3.5 - 2_f64.sqrt()
        } else {
            41.0 / 28.0 + c * c / 2.0
        }
    };
    for damping in [0.0, 0.01, 0.1, 0.5] {
        for (part, unstable) in [(0.5, false), (0.99, false), (1.01, true), (1.3, true)] {
            let s = at_rest(&ziegler(part * critical(damping), damping));
            assert_eq!(grows(&s), unstable, "{damping} {part}");
        }
    }
}

#[test]
fn a_rotor_whirls_from_the_known_speed_on() {
    // damping that turns with the rotor acts as a force across: stable up to ω (1 + outer/inner)
    let (k, outer, inner) = (400.0_f64, 0.5, 0.25);
    let critical = (k / 4.0).sqrt() * (1.0 + outer / inner);
    for (part, unstable) in [(0.5, false), (0.999, false), (1.001, true), (2.0, true)] {
        let speed = part * critical;
        let c = outer + inner;
        let across = inner * speed;
        let s = at_rest(&format!(
            "{GROUND}PART/2, MASS=4, CM=2\nMARKER/2, PART=2\nJPRIM/1, INPLANE, I=2, J=1\n\
             VFORCE/1, I=2, JFLOAT=9, RM=1, FX=-{k}*DX(2,1)-{c}*VX(2,1)-{across}*DY(2,1)\\\
             FY=-{k}*DY(2,1)-{c}*VY(2,1)+{across}*DX(2,1)\\FZ=0\nMARKER/9, PART=1, FLOATING\nEND\n"
        ));
        assert_eq!(grows(&s), unstable, "{part}");
    }
}

#[test]
fn the_first_equilibrium_of_a_row_that_grows_is_told_with_its_time_and_rate() {
    let text = ziegler(0.0, 0.01).replace("FUNCTION=-0", "FUNCTION=-TIME");
    let mut s = begin(whole(&text), "test", Options::default());
    running::go(&mut s, running::Analysis::Static, 2.0, 20);
    assert!(grows(&s));
    let told: Vec<&str> = s
        .run
        .record
        .warnings
        .iter()
        .map(|w| w.rest.as_str())
        .collect();
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].contains("at time 1.5"), "{told:?}");
}

/// Masses on rails of their own, and what acts on them: stiffness (symmetric, and across), damping.
#[derive(Clone, Debug)]
struct Masses {
    mass: Vec<f64>,
    /// stiffness = AᵀA + 1 + s (B − Bᵀ)
    potential: Vec<f64>,
    across: Vec<f64>,
    damping: Vec<f64>,
    shares: [f64; 2],
    /// a filter of the first place that pushes the last mass: rate and gain
    state: Option<[f64; 2]>,
}

impl Masses {
    fn text(&self) -> String {
        let n = self.mass.len();
        let at = |m: &[f64], i: usize, j: usize| m[4 * i + j];
        let mut text = GROUND.to_string();
        for (i, mass) in self.mass.iter().enumerate() {
            let mut force = "0".to_string();
            for j in 0..n {
                let own = (0..n)
                    .map(|k| at(&self.potential, k, i) * at(&self.potential, k, j))
                    .sum::<f64>();
                let across = self.shares[0] * (at(&self.across, i, j) - at(&self.across, j, i));
                let k = own + across + if i == j { 1.0 } else { 0.0 };
                let both = at(&self.damping, i, j) + at(&self.damping, j, i);
                let c = self.shares[1] * both + if i == j { 0.05 } else { 0.0 };
                let (mark, ground) = (j + 2, j + 102);
                let _ = write!(
                    force,
                    "-({k:?})*DZ({mark},{ground},{ground})-({c:?})*VZ({mark},{ground},{ground})"
                );
            }
            if let Some([_, gain]) = self.state.filter(|_| i + 1 == n) {
                let _ = write!(force, "+({gain:?})*DIF(1)");
            }
            let id = i + 2;
            let _ = write!(
                text,
                "PART/{id}, MASS={mass:?}, CM={id}, QG={id},0,0\nMARKER/{id}, PART={id}, REULER=90D,90D,0\n\
                 MARKER/{g}, PART=1, QP={id},0,0, REULER=90D,90D,0\nJOINT/{id}, TRANSLATIONAL, I={id}, J={g}\n\
                 SFORCE/{id}, TRANSLATION, ACTIONONLY, I={id}, J={g}, FUNCTION={force}\n",
                g = id + 100
            );
        }
        if let Some([rate, _]) = self.state {
            let _ = writeln!(
                text,
                "DIFF/1, IC=0, FUNCTION={rate:?}*(DZ(2,102,102)-DIF(1))"
            );
        }
        text + "END\n"
    }
}

fn masses() -> impl Strategy<Value = Masses> {
    let entries = || prop::collection::vec(-1.0..1.0_f64, 16);
    let shares = [
        prop_oneof![Just(0.0), 0.0..1.0_f64],
        prop_oneof![Just(0.0), 0.0..0.2_f64],
    ];
    let state = prop::option::of([0.1..5.0_f64, -0.9..0.9_f64]);
    (
        prop::collection::vec(0.3..3.0_f64, 1..=4),
        entries(),
        entries(),
        entries(),
        shares,
        state,
    )
        .prop_map(|(mass, potential, across, damping, shares, state)| Masses {
            mass,
            potential,
            across,
            damping,
            shares,
            state,
        })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn what_is_told_of_an_equilibrium_agrees_with_its_eigenvalues(masses in masses()) {
        let mut s = at_rest(&masses.text());
        let unstable = s.run.record.method.contains("unstable");
        let told = unstable || grows(&s);
        let growth = fastest(&mut s);
        if growth.abs() > 1e-5 {
            prop_assert_eq!(told, growth > 0.0, "{} {}", growth, s.run.record.method);
        }
    }

    #[test]
    fn nothing_is_judged_where_loads_have_a_potential_and_dampers_take_energy(masses in masses(), damps in any::<bool>()) {
        let mut damping = masses.damping.clone();
        damping.fill(0.0);
        let shares = [0.0, 0.0];
        let passive = Masses { damping, shares, state: None, ..masses };
        let text = passive.text();
        let text = if damps { text } else { text.replace("-(0.05)", "-(0.0)") };
        let s = at_rest(&text);
        prop_assert_eq!(s.run.record.method.as_str(), "EQUILIBRIUM, stable");
        prop_assert!(s.run.record.warnings.is_empty());
    }
}
