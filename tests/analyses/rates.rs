//! Rates depend on time, state and configuration alone: asked again, in another order or after other questions, they have the same
//! bits.

use cognate::internals::scene::configuration::Configuration;
use cognate::internals::scene::{Scene, build};
use cognate::internals::start::{assemble, velocities};
use cognate::internals::system::System;
use cognate::model::Model;
use cognate::numeric::Ode;
use proptest::prelude::*;

/// Mechanisms of `tests/data/references`: chains, loops, contacts, stops and bushings.
const MODELS: [&str; 10] = [
    "a01_pendulum",
    "a02_nfourbar_2",
    "a04_bricard",
    "a05_flyball",
    "bistop_slot",
    "bounce_k1e6",
    "double_pendulum",
    "heavy_top",
    "settle_sphere",
    "stiff_bushing",
];

/// A reference as an assembled system, and its state.
fn system(name: &str) -> (System, Vec<f64>) {
    let file = format!(
        "{}/tests/data/references/{name}.adm",
        env!("CARGO_MANIFEST_DIR")
    );
    let text = std::fs::read_to_string(&file).expect("it is there");
    system_of(&text)
}

/// A dataset as an assembled system, and its state.
fn system_of(text: &str) -> (System, Vec<f64>) {
    let model = Model::from_text(text).unwrap_or_else(|e| panic!("{e}"));
    let options = build::Options {
        mode: 4,
        ..build::Options::default()
    };
    let scene = Scene::compile(&model, &options).expect("a scene");
    let mut configuration = Configuration::new(&scene);
    let mut q = scene.initial_q.clone();
    assemble::positions(&scene, &mut configuration, 0.0, &mut q, &[]).expect("positions");
    let v = velocities::velocities(scene.within(&configuration), &model, 0.0, &q, &[]);
    let v = v.expect("velocities");
    let system = System::new(scene, configuration).expect("a system");
    let l = system.scene.layout;
    let mut y = system.numbers[l.y()].to_vec();
    l.state_mut(&mut y).q.copy_from_slice(&q);
    l.state_mut(&mut y).v.copy_from_slice(&v);
    (system, y)
}

/// States near the first: each number moved by its part of a pattern.
fn states(y: &[f64], pattern: &[f64]) -> Vec<(f64, Vec<f64>)> {
    let moved = |k: usize| {
        let part = |i: usize| pattern[(k + i) % pattern.len()];
        let numbers = y.iter().enumerate().map(|(i, y)| y + 1e-3 * part(i));
        (0.01 * k as f64, numbers.collect())
    };
    (0..pattern.len()).map(moved).collect()
}

/// Bits of the rates at a state, or the failure.
fn rate(system: &mut System, (t, y): &(f64, Vec<f64>)) -> Result<Vec<u64>, usize> {
    let mut rates = vec![0.0; y.len()];
    match Ode::rate(system, *t, y, &mut rates) {
        Ok(()) => Ok(rates.iter().map(|x| x.to_bits()).collect()),
        Err(failure) => Err(failure.what),
    }
}

/// Asks other questions at a state.
fn ask_otherwise(system: &mut System, (t, y): &(f64, Vec<f64>)) {
    let n = y.len();
    let mut switches = vec![0.0; system.branches().len()];
    system.switches(*t, y, &mut switches);
    system.row(*t, y);
    let (mut jacobian, mut dfdt) = (vec![0.0; n * n], vec![0.0; n]);
    let _ = Ode::jacobian(system, *t, y, &mut jacobian, &mut dfdt);
    let mut projected = y.clone();
    let _ = Ode::project(system, *t, &mut projected);
}

/// Free parts tied to their neighbours by bushings, so that most of the Jacobian is empty.
fn tied(n: u32) -> String {
    let mut text = "tied\nPART/1, GROUND\nMARKER/1, PART=1\n".to_string();
    for k in 1..=n {
        let (at, part) = (f64::from(k), 10 * k);
        text += &format!(
            "PART/{part}, QG={at},0.1,0, MASS=1.{k}, CM={part}, IP=0.1,0.2,0.3, WZ=0.4, VY=-0.2\n\
             MARKER/{part}, PART={part}\nMARKER/{}, PART={part}, QP=-1,0,0\nBUSHING/{k}, I={}, J={}, K=90,70,50, \
             KT=3,2,4, C=1,1,2, CT=0.1,0.2,0.3\n",
            part + 1,
            part + 1,
            if k == 1 { 1 } else { part - 10 },
        );
    }
    text + "ACCGRAV/JGRAV=-9.81\nEND\n"
}

/// A chain whose hinges rub: loads of each hinge are unknowns of one loop.
fn rubbing(n: u32) -> String {
    let mut text = "rubbing\nPART/1, GROUND\nMARKER/1, PART=1\n".to_string();
    for k in 1..=n {
        let (at, part) = (f64::from(k) - 1.0, 10 * k);
        text += &format!(
            "PART/{part}, QG={at},0,0, MASS=1, CM={}, IP=0.1,0.1,0.1, WZ={}\nMARKER/{part}, PART={part}\n\
             MARKER/{}, PART={part}, QP=1,0,0\nMARKER/{}, PART={part}, QP=0.5,0,0\n\
             JOINT/{k}, REVOLUTE, I={part}, J={}\n\
             FRICTION/{k}, JOINT={k}, MU_STATIC=0.3, MU_DYNAMIC=0.2, PIN_RADIUS=0.05\n",
            part + 2,
            f64::from(k) * 0.7,
            part + 1,
            part + 2,
            if k == 1 { 1 } else { part - 9 },
        );
    }
    text + "ACCGRAV/JGRAV=-9.81\nEND\n"
}

#[test]
fn derivatives_that_are_asked_for_often_keep_their_bits() {
    for (text, is_sparse) in [(tied(24), true), (rubbing(5), false)] {
        let (mut system, y) = system_of(&text);
        let n = y.len();
        let pattern = Ode::pattern(&mut system);
        assert_eq!(pattern.is_some(), is_sparse);
        for state in states(&y, &[0.3, -0.8, 0.5]) {
            let mut first: Option<Vec<f64>> = None;
            for asked in 0..9 {
                let (mut entries, mut dfdt) = (vec![0.0; n * n], vec![0.0; n]);
                match &pattern {
                    Some(pattern) => {
                        entries.truncate(pattern.n_entries());
                        Ode::jacobian_entries(&mut system, state.0, &state.1, &mut entries)
                    }
                    None => Ode::jacobian(&mut system, state.0, &state.1, &mut entries, &mut dfdt),
                }
                .expect("the rates have derivatives");
                entries.extend(dfdt);
                let first = first.get_or_insert_with(|| entries.clone());
                assert!(*first == entries, "asked {asked} times");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn rates_depend_on_time_state_and_configuration_alone(
        which in 0..MODELS.len(),
        pattern in prop::collection::vec(-1.0..1.0_f64, 5),
        order in Just((0..5).collect::<Vec<usize>>()).prop_shuffle(),
    ) {
        let name = MODELS[which];
        let (mut fresh, y) = system(name);
        let states = states(&y, &pattern);
        let expected: Vec<_> = states.iter().map(|s| rate(&mut fresh, s)).collect();
        let (mut other, _) = system(name);
        for &k in &order {
            prop_assert_eq!(&rate(&mut other, &states[k]), &expected[k], "{} in another order", name);
        }
        for &k in &order {
            ask_otherwise(&mut other, &states[(k + 1) % states.len()]);
            prop_assert_eq!(&rate(&mut other, &states[k]), &expected[k], "{} after other questions", name);
        }
    }
}
