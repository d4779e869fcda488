//! Models made by a program: what a builder makes is what a dataset would have said, and mistakes are told by names.

use crate::running::MAX_STEPS;

use cognate::analysis::session::{Analysis, Options, Session};
use cognate::build::Setting;
use cognate::internals::dataset::row::canonical;
use cognate::internals::dataset::statement::STATEMENTS;
use cognate::model::{ElementKind, Model};
use cognate::results::Status;
use cognate::{Error, ModelBuilder};

fn options() -> Options {
    Options {
        max_steps: Some(MAX_STEPS),
        error: Some(1e-8),
        ..Options::default()
    }
}

/// Places of the joints of a four-bar.
const PLACES: [[f64; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [3.0, 2.0, 0.0],
    [3.0, 0.0, 0.0],
];

/// A four-bar that a torque turns; `law`: by a closure, else by the same law as text.
fn four_bar(law: bool) -> ModelBuilder {
    let model = ModelBuilder::new("four-bar");
    model.units("MKS").gravity([0.0, -9.81, 0.0]);
    let ground = model.ground();
    let bars = ["crank", "coupler", "rocker"].map(|name| model.part(name));
    for (k, bar) in bars.iter().enumerate() {
        let [a, b] = [PLACES[k], PLACES[k + 1]];
        let middle = [0, 1, 2].map(|c| 0.5 * (a[c] + b[c]));
        bar.mass(1.0).inertia([0.1, 0.1, 0.1]).center(middle);
    }
    let [crank, coupler, rocker] = bars;
    let pivot = crank.at(PLACES[0]);
    model.revolute("a", &pivot, &ground);
    model.revolute("b", &crank.at(PLACES[1]), &coupler);
    model.revolute("c", &coupler.at(PLACES[2]), &rocker);
    model.revolute("d", &rocker.at(PLACES[3]), &ground);
    let motor = model.torque("motor", &pivot, &ground);
    let (angle, speed) = (format!("AZ({pivot})"), format!("WZ({pivot})"));
    if law {
        motor.law([angle, speed], |t, [angle, speed]| {
            20.0 * (t - angle) - 2.0 * speed
        });
    } else {
        motor.function(&format!("20*(TIME-{angle})-2*{speed}"));
    }
    model
}

const COLUMN: &str = "AZ(4)";

fn angles(mut session: Session) -> Vec<f64> {
    session.add_column(COLUMN).expect("an expression");
    let status = session.run_to(Analysis::Dynamic, 1.0, 20);
    assert_eq!(status, Ok(Status::Completed));
    session.run.column(COLUMN).expect("the column").to_vec()
}

#[test]
fn a_closure_turns_a_four_bar_as_the_same_law_in_text_does() {
    let [by_closure, by_text] = [true, false].map(|law| {
        let session = four_bar(law)
            .session(options())
            .unwrap_or_else(|e| panic!("{e}"));
        angles(session)
    });
    assert!(by_text.last().is_some_and(|x| x.abs() > 0.1), "{by_text:?}");
    for (x, y) in by_closure.iter().zip(&by_text) {
        assert!((x - y).abs() < 1e-6, "{x} {y}");
    }
}

#[test]
fn a_written_dataset_keeps_names_and_is_the_same_model() {
    let built = four_bar(false).build().unwrap_or_else(|e| panic!("{e}"));
    let text = built.to_text();
    for name in ["ground", "crank", "coupler", "rocker", "motor"] {
        assert!(
            text.contains(&format!("adams_view_name='{name}'")),
            "{text}"
        );
    }
    let read = Model::from_text(&text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert_eq!(read.to_text(), text);
    let [a, b] = [built, read].map(|model| angles(Session::new(model, "run", options())));
    assert_eq!(a, b);
}

#[test]
fn numbers_are_handed_out_and_readable() {
    let model = ModelBuilder::new("numbers");
    let (first, second) = (model.part("first"), model.part("second"));
    assert_eq!(
        (model.ground().number(), first.number(), second.number()),
        (1, 2, 3)
    );
    assert_eq!(format!("{first} {second:?}"), "2 PART/3 'second'");
    let marker = second.at([0.0; 3]).named("tip");
    assert_eq!((marker.number(), marker.name().as_str()), (1, "tip"));
}

/// Text of a model of one pendulum whose frame is moved before or after its places are named.
fn placed(first: bool) -> String {
    let model = ModelBuilder::new("places");
    let ground = model.ground();
    let rod = model.part("rod");
    let place = || {
        rod.origin([1.0, 2.0, 3.0]).set("REULER", [0.3, 0.4, 0.5]);
    };
    if first {
        place();
    }
    rod.mass(1.0).inertia([1.0; 3]).center([2.0, 2.0, 3.0]);
    let pivot = rod.at([1.0, 2.0, 3.0]).z([1.0, 1.0, 0.0]);
    if !first {
        place();
    }
    model.revolute("hinge", &ground, &pivot);
    // arguments are written in the order of the table
    model.build().unwrap_or_else(|e| panic!("{e}")).to_text()
}

#[test]
fn places_in_ground_stay_whenever_the_part_is_placed() {
    assert_eq!(placed(true), placed(false));
    let model = Model::from_text(&placed(true)).expect("a model");
    let mut session = Session::new(model, "run", options());
    for column in [
        "DX(2)", "DY(2)", "DZ(2)", "DM(2,3)", "AZ(2,3)", "DX(1)", "DY(1)",
    ] {
        session.add_column(column).expect("an expression");
    }
    let status = session.run_to(Analysis::InitialConditions, 0.0, 1);
    assert_eq!(status, Ok(Status::Completed));
    let first = |name: &str| session.run.column(name).expect("a column")[0];
    let found = [
        "DX(2)", "DY(2)", "DZ(2)", "DM(2,3)", "AZ(2,3)", "DX(1)", "DY(1)",
    ]
    .map(first);
    for (found, expected) in found.into_iter().zip([1.0, 2.0, 3.0, 0.0, 0.0, 2.0, 2.0]) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}

/// What is said of each mistake: element, name and message.
fn said(model: &ModelBuilder) -> Vec<String> {
    let error: Error = model.build().expect_err("mistakes");
    let all = error.diagnostics().iter();
    all.map(|d| format!("{} {}", d.named().unwrap_or_default(), d.message))
        .collect()
}

#[test]
fn mistakes_are_told_at_once_by_the_names_of_their_elements() {
    let model = ModelBuilder::new("mistakes");
    let ground = model.ground();
    let rod = model
        .part("rod")
        .mass(f64::NAN)
        .set("MAS", 2)
        .set("COLOUR", "red");
    let pivot = rod.at([0.0; 3]);
    model.revolute("free", &rod, &ground);
    model
        .revolute("hinge", &pivot, &ground)
        .set("IC", [1.0, 2.0, 3.0])
        .flag("FIXED");
    model.force("push", &pivot, &ground);
    model
        .torque("turn", &pivot, &ground)
        .law(["TIME"], |_, [_]| [1.0, 2.0]);
    model.spring("spring", &pivot, &ground).set("K", "stiff");
    model.settings("INTEGRATER").set("ERROR", 1e-9);
    rod.at([f64::INFINITY, 0.0, 0.0]);
    rod.at([0.0; 3]).z([0.0; 3]);
    let all = said(&model).join("\n");
    for part in [
        "PART/2 'rod' MASS is NaN",
        "PART/2 'rod' PART has no argument COLOUR",
        "`free` stands between two bodies",
        "JOINT/2 'hinge' IC takes 1 to 2 numbers, not 3",
        "JOINT/2 'hinge' REVOLUTE and FIXED are both given as the type",
        "SFORCE/1 'push' needs FUNCTION = an expression",
        "SFORCE/2 'turn' its closure returns 2 numbers; it needs 1: the force or torque",
        "SPRINGDAMPER/1 'spring' K takes a number, not `stiff`",
        "`INTEGRATER` is no statement of settings",
        "its place is at inf",
        "its z axis has no direction",
    ] {
        assert!(all.contains(part), "{part}:\n{all}");
    }
}

#[test]
fn elements_of_another_builder_are_told_wherever_they_are_given() {
    let (other, model) = (ModelBuilder::new("other"), ModelBuilder::new("model"));
    for k in 0..5 {
        other
            .part("far")
            .mass(1.0)
            .inertia([1.0; 3])
            .center([f64::from(k); 3]);
    }
    let far = other.part("far");
    let (there, joint) = (
        far.at([0.0; 3]),
        other.revolute("o", &far.at([0.0; 3]), &other.ground()),
    );
    let near = model
        .part("near")
        .mass(1.0)
        .inertia([1.0; 3])
        .center([0.0; 3]);
    let here = near.at([0.0; 3]);
    model.revolute("markers", &there, &here);
    model.spherical("a body", &here, &far);
    model.spring("two bodies", &far, &near);
    model.motion("turn", &joint, "TIME");
    model.marker("on it", &far);
    near.set("IM", &there);
    let found = said(&model);
    let foreign = found
        .iter()
        .filter(|text| text.contains("of another builder"));
    assert_eq!(foreign.count(), 6, "{found:?}");
}

#[test]
fn every_statement_of_the_table_is_reachable() {
    for row in STATEMENTS {
        let model = ModelBuilder::new("reach");
        let element = match row.kind() {
            Some(kind) => model.element(kind, "it"),
            None => model.settings(&canonical(row.keyword())),
        };
        assert_eq!(element.kind(), row.kind());
        // its flags, each alone
        for argument in row.arguments() {
            let model = ModelBuilder::new("reach");
            let element = match row.kind() {
                Some(kind) => model.element(kind, "it"),
                None => model.settings(&canonical(row.keyword())),
            };
            let keyword = argument.keyword();
            element.set(&keyword, Setting::Flag);
            let unknown = format!("no argument {keyword}");
            let all = model
                .build()
                .map_or_else(|e| e.to_string(), |_| String::new());
            assert!(!all.contains(&unknown), "{all}");
        }
    }
}

#[test]
fn values_of_all_kinds_reach_their_arguments() {
    let model = ModelBuilder::new("values");
    let ground = model.ground();
    let (a, b) = (model.part("a"), model.part("b"));
    for part in [a, b] {
        part.mass(1.0)
            .inertia([1.0, 1.0, 1.0, 0.0, 0.0, 0.1])
            .center([0.0; 3]);
    }
    a.set("EXACT", "X:Y").set("VX", 2);
    let (i, j) = (a.at([0.0; 3]), b.at([0.0; 3]));
    let joints = [
        model.revolute("one", &i, &ground),
        model.revolute("two", &j, &ground),
    ];
    let coupler = model.element(ElementKind::Coupler, "gears");
    coupler
        .set("JOINTS", [&joints[0], &joints[1]])
        .set("SCALES", [1, -2])
        .set("TYPE", "R:R");
    model.variable("v", "TIME");
    let bushing = model.between(ElementKind::Bushing, "mount", &i, &j);
    bushing.set("K", [1e3; 3]).set("KT", [10, 10, 10]);
    model
        .settings("INTEGRATOR")
        .flag("GSTIFF")
        .set("ERROR", 1e-7);
    model.settings("RESULTS").flag("XRF");
    let model = model.build().unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(model.couplers[&1].joints, [1, 2]);
    assert_eq!(model.couplers[&1].scales, [1.0, -2.0]);
    assert_eq!(model.parts[&2].exact[..3], [true, true, false]);
    assert_eq!(model.parts[&2].velocity[0], Some(2.0));
    assert_eq!(model.integrator.error, Some(1e-7));
    assert_eq!(model.bushings.len(), 1);
}
