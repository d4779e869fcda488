//! Scenes: the equations of small mechanisms against closed forms, and every formulation against the other.

use cognate::internals::scene::configuration::Configuration;
use cognate::internals::scene::unknown::UnknownId;
use cognate::internals::scene::{Scene, Source, build::Options};
use cognate::internals::start::{assemble, velocities};
use cognate::internals::system::System;
use cognate::model::Model;
use cognate::numeric::{self, Method, Ode};
use std::collections::BTreeSet;

fn pendulum() -> Model {
    let text = "a pendulum\nPART/1, GROUND\nPART/2, MASS=1, CM=2, IP=1E-3,1E-3,1E-3\nMARKER/2, PART=2, QP=-1,0,0\n\
                MARKER/3, PART=2\nMARKER/4, PART=1\nJOINT/1, REVOLUTE, I=3, J=4\nACCGRAV/JGRAV=-9.81\nEND\n";
    Model::from_text(text).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn a_pendulum_is_a_handful_of_operations_and_swings_as_it_should() {
    for cut_all in [false, true] {
        let model = pendulum();
        let scene = Scene::compile(
            &model,
            &Options {
                cut_all,
                mode: 4,
                ..Options::default()
            },
        )
        .unwrap();
        let mut q = scene.initial_q.clone();
        let mut configuration = Configuration::new(&scene);
        let found = assemble::positions(&scene, &mut configuration, 0.0, &mut q, &[]).unwrap();
        println!("{found:?}");
        assert_eq!(found.freedom, 1);
        let v = velocities::velocities(scene.within(&configuration), &model, 0.0, &q, &[]).unwrap();
        let mut system = System::new(scene, configuration).unwrap();
        if !cut_all {
            // the cosine of the angle, scaled; the rest is reading and writing
            assert!(system.operations() <= 4, "{}", system.operations());
        }
        let mut y = q;
        y.extend(v);
        let options = numeric::Options {
            tolerance: 1e-9,
            ..numeric::Options::default()
        };
        let mut method: Box<dyn Method<System>> =
            numeric::ode_method("DOP853", system.size(), &options).unwrap();
        method.start(&mut system, 0.0, &y).unwrap();
        while method.t() < 10.0 {
            method.step(&mut system, 10.0).unwrap();
        }
        // as a coordinate: angle and its rate; as a free part: where it is, its turn, its velocity and angular velocity about z
        let y = method.y();
        let [angle, rate] = swing(10.0);
        assert_eq!(y.len(), if cut_all { 13 } else { 2 });
        assert!((y[y.len() - 1] - rate).abs() < 1e-6, "{y:?}, not {rate}");
        if !cut_all {
            assert!((y[0] - angle).abs() < 1e-6, "{y:?}, not {angle}");
        }
    }
}

/// Angle and rate of the pendulum by many small steps of the classical method: (m l² + I) φ̈ = m g l cos φ.
fn swing(end: f64) -> [f64; 2] {
    let acceleration = |angle: f64| 9.81 / 1.001 * angle.cos();
    let n = 20_000;
    let h = end / f64::from(n);
    let (mut p, mut v) = (0.0, 0.0);
    for _ in 0..n {
        let (a1, v1) = (acceleration(p), v);
        let (a2, v2) = (acceleration(p + 0.5 * h * v1), v + 0.5 * h * a1);
        let (a3, v3) = (acceleration(p + 0.5 * h * v2), v + 0.5 * h * a2);
        let (a4, v4) = (acceleration(p + h * v3), v + h * a3);
        p += h / 6.0 * (v1 + 2.0 * (v2 + v3) + v4);
        v += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
    }
    [p, v]
}

#[test]
fn every_unknown_has_an_identity_of_its_own_that_reads_back() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes");
    let mut balls = 0;
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.extension().is_none_or(|e| e != "adm") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let model = Model::from_text(&text).unwrap_or_else(|e| panic!("{e}"));
        for cut_all in [false, true] {
            let options = Options {
                cut_all,
                mode: 4,
                ..Options::default()
            };
            let scene = Scene::compile(&model, &options).unwrap();
            let names = scene.unknown_names();
            let file = path.display();
            assert_eq!(names.len(), scene.layout.n_y(), "{file}");
            let read: BTreeSet<UnknownId> = names.iter().map(|n| n.parse().unwrap()).collect();
            assert_eq!(read.len(), names.len(), "{file}: {names:?}");
            // each where its coordinate says
            for c in &scene.coordinates {
                let Source::Free { q, v } = c.source else {
                    continue;
                };
                assert_eq!(scene.unknowns.v[v], UnknownId::Velocity(c.id), "{file}");
                match scene.unknowns.q[q] {
                    UnknownId::Position(id) => assert_eq!(id, c.id, "{file}"),
                    UnknownId::EulerParameter { ball, number } => {
                        assert_eq!((ball.element, number), (c.id.element, 0), "{file}");
                        balls += 1;
                    }
                    other => panic!("{file}: {other} is no position"),
                }
            }
        }
    }
    assert!(balls > 0);
}
