//! Scenes: the equations of small mechanisms against closed forms, and every formulation against the other.
#![cfg(feature = "solver")]

use cognate::analysis::start::{assemble, velocities};
use cognate::analysis::system::System;
use cognate::model::*;
use cognate::numeric::{self, Method, Ode};
use cognate::scene::configuration::Configuration;
use cognate::scene::{Scene, build::Options};

fn marker(part: u32, qp: [f64; 3]) -> Marker {
    Marker {
        place: Place::default(),
        owner: MarkerOwner::Part(part),
        qp,
        orientation: Orientation::Aligned,
        floating: false,
    }
}

fn pendulum() -> Model {
    let mut m = Model {
        gravity: [0.0, -9.81, 0.0],
        ..Model::default()
    };
    m.parts.insert(
        1,
        Part {
            ground: true,
            ..Part::default()
        },
    );
    m.parts.insert(
        2,
        Part {
            mass: 1.0,
            cm: Some(2),
            ip: [1e-3, 1e-3, 1e-3, 0.0, 0.0, 0.0],
            ..Part::default()
        },
    );
    m.markers.insert(2, marker(2, [-1.0, 0.0, 0.0]));
    m.markers.insert(3, marker(2, [0.0; 3]));
    m.markers.insert(4, marker(1, [0.0; 3]));
    m.joints.insert(
        1,
        Joint {
            place: Place::default(),
            kind: JointKind::Revolute,
            i: 3,
            j: 4,
            ic_translation: [None; 2],
            ic_rotation: [None; 2],
            pitch: None,
            pd: None,
        },
    );
    m
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
        println!("operations {}", system.operations());
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
        println!("{:?} {:?}", method.y(), method.stats());
    }
}
