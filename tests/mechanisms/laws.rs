//! Laws: the answer does not depend on the order of parts, on where ground is, on units, on which marker is called I, nor on what is a coordinate and
//! what a row; energy and momentum are kept.
#![allow(non_snake_case)]

use crate::running;

use cognate::analysis::session::columns;
use cognate::analysis::watch::Unwatched;
use cognate::internals::scene::configuration::Configuration;
use cognate::internals::scene::{Scene, build};
use cognate::internals::space::{Mat3, Vec3, rotation};
use cognate::internals::start::{assemble, velocities};
use cognate::internals::system::System;
use cognate::internals::time::{dynamics, options};
use cognate::model::{Driven, MarkerOwner, Model, Orientation, Units};
use cognate::results::Run;
use running::{Analysis, Options, begin, go, whole};

/// Mechanisms of `tests/scenes`, moved by gravity instead of motions; chains open and closed, in the plane and in space.
const SCENES: [&str; 11] = [
    "four_bar",
    "slider_crank",
    "watt_one",
    "sarrus",
    "bennett",
    "cardan_joint",
    "rssr",
    "gimbal",
    "three_rpr",
    "wobble_plate",
    "double_wishbone",
];
/// A bead on a curve, which is drawn beside it.
const BEAD: &str = "BEAD\nPART/1, GROUND\nMARKER/1, PART=1\nMARKER/9, PART=1, FLOATING\n\
        PART/2, QG=0.82,0.69,-0.19, MASS=1, CM=20, IP=0.1,0.2,0.3\nMARKER/20, PART=2\nMARKER/21, PART=2, QP=0.2,-0.1,0.3\n\
        MATRIX/1, FULL=RORDER, ROWS=5, COLUMNS=3, VALUES=0,0,0, 0.5,0.2,0.1, 1,0.6,0.1, 1.5,0.7,0.4, 2,1.2,0.5\n\
        CURVE/1, OPEN, CURVE_POINTS, MATRIX=1\nPTCV/1, CURVE=1, I=21, RM=1, JFLOAT=9\nACCGRAV/JGRAV=-1\nEND\n";
const END: f64 = 0.25;
/// Tolerance of the local error; results agree to this, magnified by the motion.
const ERROR: f64 = 1e-10;
const AGREE: f64 = 1e-7;

fn scene(name: &str) -> Model {
    let path = format!("{}/tests/scenes/{name}.adm", env!("CARGO_MANIFEST_DIR"));
    let mut model = Model::read(&path).unwrap_or_else(|e| panic!("{e}"));
    model.motions.clear();
    model.gravity = [0.7, -1.9, -1.3];
    // what the joints permit of this
    for part in model.parts.values_mut().filter(|p| !p.ground) {
        part.angular_velocity = [Some(0.4), Some(-0.3), Some(0.8)];
    }
    model
}

/// Draws parts where they do not fit, by gaps of this size and more.
fn draw_apart(model: &mut Model, gap: f64) {
    let parts = model.parts.values_mut().filter(|p| !p.ground);
    for (k, part) in parts.enumerate() {
        part.qg[k % 3] += gap * (1.0 + k as f64);
        part.qg[(k + 1) % 3] -= 2.0 * gap;
    }
}

/// Places of all centres of mass against a marker of ground, in its axes.
fn measured(model: &Model) -> Vec<String> {
    let ground = model.parts.iter().find(|p| p.1.ground).map(|p| *p.0);
    let on_ground = model
        .markers
        .iter()
        .find(|(_, m)| Some(m.owner) == ground.map(MarkerOwner::Part))
        .map(|m| *m.0)
        .expect("a marker on ground");
    let mut all = Vec::new();
    let mut centres: Vec<u32> = model.parts.values().filter_map(|p| p.cm).collect();
    centres.sort_unstable();
    for cm in centres {
        for axis in ["DX", "DY", "DZ", "WM"] {
            let more = if axis == "WM" {
                String::new()
            } else {
                format!(",{on_ground}")
            };
            all.push(format!("{axis}({cm},{on_ground}{more})"));
        }
    }
    all
}

fn solved(model: &Model, columns: &[String]) -> Run {
    let options = Options {
        columns: columns.to_vec(),
        error: Some(ERROR),
        ..Options::default()
    };
    let mut session = begin(model.clone(), "law", options);
    go(&mut session, Analysis::Dynamic, END, 5);
    session.run
}

fn agree(name: &str, law: &str, columns: &[String], a: &Run, b: &Run, scale: impl Fn(&str) -> f64) {
    for c in columns {
        let (x, y) = (
            a.column(c).expect("a column"),
            b.column(c).expect("a column"),
        );
        assert_eq!(x.len(), y.len());
        for (x, y) in x.iter().zip(y) {
            let y = y / scale(c);
            assert!(
                (x - y).abs() < AGREE * (1.0 + x.abs()),
                "{name}, {law}: {c} {x} {y}"
            );
        }
    }
}

/// Everything numbered the other way round; ground keeps its number.
fn reordered(model: &Model) -> Model {
    let mut other = model.clone();
    let new = |id: u32| 9000 - id;
    let ground = model.parts.iter().find(|p| p.1.ground).map_or(0, |p| *p.0);
    let part = |id: u32| if id == ground { id } else { new(id) };
    other.parts = model
        .parts
        .iter()
        .map(|(id, p)| (part(*id), p.clone()))
        .collect();
    for marker in other.markers.values_mut() {
        if let MarkerOwner::Part(p) = marker.owner {
            marker.owner = MarkerOwner::Part(part(p));
        }
    }
    other.joints = model
        .joints
        .iter()
        .map(|(id, j)| (new(*id), j.clone()))
        .collect();
    other.primitives = model
        .primitives
        .iter()
        .map(|(id, j)| (new(*id), j.clone()))
        .collect();
    for motion in other.motions.values_mut() {
        if let Driven::Joint(j) | Driven::JointRotation(j) | Driven::JointTranslation(j) =
            &mut motion.driven
        {
            *j = new(*j);
        }
    }
    other
}

#[test]
fn the_order_of_parts_and_joints_does_not_matter() {
    for name in SCENES {
        let model = scene(name);
        let columns = measured(&model);
        let (a, b) = (
            solved(&model, &columns),
            solved(&reordered(&model), &columns),
        );
        agree(name, "order", &columns, &a, &b, |_| 1.0);
    }
}

#[test]
fn exchanging_i_and_j_does_not_matter() {
    for name in SCENES {
        let model = scene(name);
        let columns = measured(&model);
        let mut other = model.clone();
        for joint in other.joints.values_mut() {
            // the cross of a HOOKE joint is x of I and y of J
            if format!("{:?}", joint.kind) != "Hooke" {
                std::mem::swap(&mut joint.i, &mut joint.j);
            }
        }
        let (a, b) = (solved(&model, &columns), solved(&other, &columns));
        agree(name, "exchange", &columns, &a, &b, |_| 1.0);
    }
}

/// Everything, gravity too, turned and shifted in ground.
fn moved(model: &Model) -> Model {
    let (R, p) = (rotation::from_313(0.4, 0.9, -1.3), Vec3([2.0, -3.0, 1.5]));
    let turn = |o: &Orientation, origin: [f64; 3]| {
        let old = match o {
            Orientation::Aligned => Mat3::identity(),
            Orientation::Euler([a, b, c]) => rotation::from_313(*a, *b, *c),
            Orientation::Points { z, x, .. } => {
                let z = z.map_or(Vec3([0.0, 0.0, 1.0]), |z| Vec3(z) - Vec3(origin));
                let x = x.map_or(Vec3([1.0, 0.0, 0.0]), |x| Vec3(x) - Vec3(origin));
                rotation::from_z_and_x(z, x).expect("axes")
            }
        };
        let new = R * old;
        let at = R.apply(Vec3(origin)) + p;
        let tip = |k: usize| Some((at + new.column(k)).0);
        (
            at.0,
            Orientation::Points {
                z: tip(2),
                x: tip(0),
                use_x: false,
            },
        )
    };
    let mut other = model.clone();
    let mut ground = 0;
    for (id, part) in &mut other.parts {
        if part.ground {
            ground = *id;
            continue;
        }
        (part.qg, part.orientation) = turn(&part.orientation, part.qg);
    }
    for marker in other.markers.values_mut() {
        if marker.owner == MarkerOwner::Part(ground) {
            // the x-direction that a missing XP stands for is that of ground before it was turned
            let aligned = matches!(marker.orientation, Orientation::Points { x: None, .. });
            assert!(!aligned || R.0[0][0] < 1.0);
            (marker.qp, marker.orientation) = turn(&marker.orientation, marker.qp);
        }
    }
    other.gravity = R.apply(Vec3(model.gravity)).0;
    other
}

#[test]
fn where_ground_is_does_not_matter() {
    for name in SCENES {
        let model = scene(name);
        let columns = measured(&model);
        let (a, b) = (solved(&model, &columns), solved(&moved(&model), &columns));
        agree(name, "ground", &columns, &a, &b, |_| 1.0);
    }
}

/// Parts that do not fit go the same ways, wherever the model is and however it is turned: those that are placed, and those on
/// curves, whose coordinates change least.
#[test]
fn where_ground_is_does_not_matter_to_parts_that_do_not_fit() {
    for name in [
        "four_bar",
        "slider_crank",
        "cardan_joint",
        "rssr",
        "gimbal",
        "wobble_plate",
    ] {
        for gap in [1e-3, 1e-2] {
            let mut model = scene(name);
            draw_apart(&mut model, gap);
            let columns = measured(&model);
            let (a, b) = (solved(&model, &columns), solved(&moved(&model), &columns));
            agree(name, "gaps", &columns, &a, &b, |_| 1.0);
        }
    }
    let model = whole(BEAD);
    let columns = measured(&model);
    let (a, b) = (solved(&model, &columns), solved(&moved(&model), &columns));
    agree("bead", "gaps", &columns, &a, &b, |_| 1.0);
}

/// The same in millimetres, with forces in newtons.
fn in_millimetres(model: &Model) -> Model {
    let mut other = in_lengths(model, 1000.0);
    other.units = Some(Units {
        force: "NEWTON".into(),
        mass: "KILOGRAM".into(),
        length: "MILLIMETER".into(),
        time: "SECOND".into(),
        ucf: 1000.0,
    });
    other
}

/// The same with lengths that are larger by a factor, and forces in units that go with them.
fn in_lengths(model: &Model, factor: f64) -> Model {
    let mut other = model.clone();
    let long = |x: &mut [f64; 3]| x.iter_mut().for_each(|x| *x *= factor);
    let longer = |o: &mut Orientation| {
        if let Orientation::Points { z, x, .. } = o {
            z.iter_mut().for_each(long);
            x.iter_mut().for_each(long);
        }
    };
    for part in other.parts.values_mut() {
        long(&mut part.qg);
        longer(&mut part.orientation);
        part.ip.iter_mut().for_each(|i| *i *= factor * factor);
    }
    for marker in other.markers.values_mut() {
        long(&mut marker.qp);
        longer(&mut marker.orientation);
    }
    long(&mut other.gravity);
    other.units = None;
    other
}

/// No number of ours is a length: mechanisms of any size, drawn with gaps or without, go the same ways.
#[test]
fn lengths_of_any_size_do_not_matter() {
    for name in SCENES {
        for gap in [0.0, 1e-2] {
            let mut model = scene(name);
            draw_apart(&mut model, gap);
            model.units = None;
            let columns = measured(&model);
            let a = solved(&model, &columns);
            for factor in [1e-9, 1e-6, 1e-3, 1e6, 1e9] {
                let b = solved(&in_lengths(&model, factor), &columns);
                agree(name, &format!("{factor:e}"), &columns, &a, &b, |c| {
                    if c.starts_with('D') { factor } else { 1.0 }
                });
            }
        }
    }
}

#[test]
fn units_do_not_matter() {
    for name in SCENES {
        let model = scene(name);
        let columns = measured(&model);
        let (a, b) = (
            solved(&model, &columns),
            solved(&in_millimetres(&model), &columns),
        );
        agree(name, "units", &columns, &a, &b, |c| {
            if c.starts_with('D') { 1000.0 } else { 1.0 }
        });
    }
}

/// Positions at the end with all joints as rows between free parts.
fn without_forest(model: &Model, names: &[String]) -> Run {
    let mut run = Run::new("cut", "", cognate::results::Units::default());
    let wanted = columns::Columns::new(model, &mut run, names, false, &|_, _| false);
    let options = build::Options {
        cut_all: true,
        mode: 4,
        extra: wanted.extra.clone(),
        ..build::Options::default()
    };
    let scene = Scene::compile(model, &options).expect("a scene");
    let mut configuration = Configuration::new(&scene);
    let mut q = scene.initial_q.clone();
    assemble::positions(&scene, &mut configuration, 0.0, &mut q, &[]).expect("positions");
    let here = scene.within(&configuration);
    let v = velocities::velocities(here, model, 0.0, &q, &[]).expect("velocities");
    let l = scene.layout;
    let mut system = System::new(scene, configuration).expect("a system");
    system.numbers[l.q()].copy_from_slice(&q);
    system.numbers[l.v()].copy_from_slice(&v);
    let outputs: Vec<f64> = (1..=5).map(|k| END * f64::from(k) / 5.0).collect();
    let (program, complaints) = wanted.program(system.configured());
    assert!(complaints.is_empty(), "{complaints:?}");
    let mut rows = vec![system.numbers.clone()];
    let how = options::Options {
        error: ERROR,
        ..options::Options::default()
    };
    let out = dynamics::integrate(&mut system, &outputs, &how, &mut Unwatched);
    assert!(out.ended.is_none(), "{:?}", out.ended);
    rows.extend(out.rows);
    run.begin(cognate::results::Kind::Dynamic);
    columns::append(&mut run, &program, &rows);
    run.end();
    run
}

/// The forest is a choice of coordinates: absolute coordinates with every joint as rows give the same motion.
#[test]
fn what_is_a_coordinate_and_what_a_row_does_not_matter() {
    for name in SCENES {
        let model = scene(name);
        let columns = measured(&model);
        let (a, b) = (solved(&model, &columns), without_forest(&model, &columns));
        for c in &columns {
            let (x, y) = (
                a.column(c).expect("a column"),
                b.column(c).expect("a column"),
            );
            // the run repeats its start as the result of the initial conditions
            let (x, y) = (&x[x.len() - 5..], &y[y.len() - 5..]);
            for (x, y) in x.iter().zip(y) {
                assert!(
                    (x - y).abs() < AGREE * (1.0 + x.abs()),
                    "{name}: {c} {x} {y}"
                );
            }
        }
    }
}

/// Reactions too, also where they are not unique: the smallest set knows nothing of the forest, of I and J, of order.
#[test]
fn the_smallest_set_of_reactions_does_not_depend_on_the_forest_or_the_order() {
    for name in ["four_bar", "sarrus", "bennett", "cardan_joint", "watt_one"] {
        let model = scene(name);
        let of = |ids: &mut dyn Iterator<Item = u32>| -> Vec<String> {
            ids.flat_map(|id| [2, 3, 4, 6, 7, 8].map(|c| format!("JOINT({id},0,{c},0)")))
                .collect()
        };
        let ids: Vec<u32> = model.joints.keys().copied().collect();
        let columns = of(&mut ids.iter().copied());
        let a = solved(&model, &columns);
        let b = without_forest(&model, &columns);
        let turned = of(&mut ids.iter().map(|id| 9000 - id));
        let c = solved(&reordered(&model), &turned);
        for (k, name_of) in columns.iter().enumerate() {
            let end = |run: &Run, c: &str| *run.column(c).expect("a column").last().expect("a row");
            let (x, y, z) = (end(&a, name_of), end(&b, name_of), end(&c, &turned[k]));
            let tolerance = 1e-6 * (1.0 + x.abs());
            assert!(
                (x - y).abs() < tolerance && (x - z).abs() < tolerance,
                "{name}: {name_of} {x} {y} {z}"
            );
        }
    }
}

#[test]
fn energy_is_kept() {
    for name in SCENES {
        let run = solved(&scene(name), &[]);
        let drift = run.record.energy.error();
        assert!(drift < 1e-8, "{name}: {drift}");
    }
}

/// Two bodies on a hinge and a third on a ball, spinning in empty space: momentum and moment of momentum about ground keep their values.
#[test]
fn momentum_is_kept_by_what_nothing_holds() {
    let text = "FREE\nPART/1, GROUND\nMARKER/1, PART=1\n\
        PART/2, MASS=2, CM=20, IP=0.4,0.4,0.4, VX=0.3, VY=-0.2, WX=1, WY=2, WZ=-1\nPART/3, MASS=1, CM=30, IP=0.2,0.2,0.2, WZ=3\n\
        PART/4, MASS=3, CM=40, IP=0.5,0.5,0.5, WY=-2\nMARKER/20, PART=2\nMARKER/30, PART=3, QP=1,0.2,0\nMARKER/40, PART=4, QP=-1,0.3,0.4\n\
        MARKER/21, PART=2, QP=0.5,0,0\nMARKER/31, PART=3, QP=0.5,0,0\nMARKER/22, PART=2, QP=-0.5,0,0\nMARKER/42, PART=4, QP=-0.5,0,0\n\
        JOINT/1, REVOLUTE, I=31, J=21\nJOINT/2, SPHERICAL, I=42, J=22\nEND\n";
    let model = whole(text);
    let bodies = [(20, 2.0, 0.4), (30, 1.0, 0.2), (40, 3.0, 0.5)];
    let sum =
        |f: &dyn Fn(u32, f64, f64) -> String| bodies.map(|(m, mass, i)| f(m, mass, i)).join("+");
    let mut columns = Vec::new();
    for (a, b, c) in [("X", "Y", "Z"), ("Y", "Z", "X"), ("Z", "X", "Y")] {
        columns.push(sum(&|m, mass, _| format!("{mass}*V{a}({m})")));
        columns.push(sum(&|m, mass, i| {
            format!("{mass}*(D{a}({m})*V{b}({m})-D{b}({m})*V{a}({m}))+{i}*W{c}({m})")
        }));
    }
    let run = solved(&model, &columns);
    for c in &columns {
        let x = run.column(c).expect("a column");
        assert!(x.iter().all(|y| (y - x[0]).abs() < 1e-9), "{c}: {x:?}");
    }
}

/// A four-bar of pins in the plane with all its places moved by `by`; one pin has a gap, and a spring pulls.
fn four_bar_at(by: [f64; 3], gap: f64) -> String {
    let [x, y, z] = by;
    let on_ground = |a: f64, b: f64| format!("QP={:?},{:?},{z:?}", x + a, y + b);
    let bar = |part: usize, [a, b]: [[f64; 2]; 2], gap: f64| {
        format!(
            "PART/{part}, MASS=1, CM={part}0, IP=0.1,0.1,0.1, QG={x:?},{y:?},{z:?}\nMARKER/{part}0, PART={part}, QP={:?},{:?},0\n\
             MARKER/{part}1, PART={part}, QP={:?},{:?},0\nMARKER/{part}2, PART={part}, QP={:?},{:?},0\n",
            (a[0] + b[0]) / 2.0,
            (a[1] + b[1]) / 2.0,
            a[0],
            a[1],
            b[0] + gap,
            b[1] - gap / 2.0,
        )
    };
    let corners = [[0.0, 0.0], [0.3, 1.1], [2.2, 1.9], [3.0, 0.0]];
    let bars = bar(2, [corners[0], corners[1]], 0.0)
        + &bar(3, [corners[1], corners[2]], gap)
        + &bar(4, [corners[2], corners[3]], 0.0);
    format!(
        "MOVED\nPART/1, GROUND\nMARKER/1, PART=1, {}\nMARKER/5, PART=1, {}\nMARKER/6, PART=1, {}\n{bars}\
         JOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=22\nJOINT/3, REVOLUTE, I=41, J=32\nJOINT/4, REVOLUTE, I=42, J=5\n\
         SPRINGDAMPER/1, TRANSLATION, I=30, J=6, K=20, L=1\nACCGRAV/JGRAV=-9.81\nEND\n",
        on_ground(0.0, 0.0),
        on_ground(3.0, 0.0),
        on_ground(1.0, 4.0),
    )
}

/// How far the mechanism is from the origin says nothing about it: neither what assembly does, nor what is told of it.
#[test]
fn moving_a_whole_model_changes_neither_its_assembly_nor_what_is_told() {
    let columns = ["DX(30,1)", "DY(30,1)", "AZ(30,1)"];
    for gap in [0.0, 1e-6, 1e-4, 1e-3, 2e-2] {
        let go_at = |by: [f64; 3]| {
            let options = running::options(&columns, 1e-8);
            let mut s = begin(whole(&four_bar_at(by, gap)), "moved", options);
            go(&mut s, Analysis::Dynamic, 0.5, 10);
            let told = s.run.record.warned();
            (columns.map(|c| running::values(&s, c).to_vec()), told)
        };
        let (here, told) = go_at([0.0; 3]);
        assert_eq!(told.is_empty(), gap < 1e-5, "{gap}: {told:?}");
        for by in [[1.0, -2.0, 0.0], [1e3, 0.0, -2e3], [-1e6, 1e6, 3e5]] {
            let (there, told_there) = go_at(by);
            assert_eq!(told, told_there, "{gap} {by:?}");
            // rows are closed to 1e-10 of the distance from the origin
            let closed = 1e-6 + 1e-10 * by.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            for (a, b) in here.iter().flatten().zip(there.iter().flatten()) {
                assert!((a - b).abs() < closed, "{gap} {by:?}: {a:?} {b:?}");
            }
        }
    }
}

/// What nothing couples to a mechanism: free bodies, a bead on a curve, a pendulum with a gap of its own, balls on a plate.
fn beside(which: usize) -> String {
    match which {
        0 => (0..60).fold(String::new(), |text, k| {
            format!(
                "{text}PART/{p}, QG={x},{y},-7, MASS=1, CM={m}, IP=1,1,1\nMARKER/{m}, PART={p}\n",
                p = 200 + k,
                m = 2000 + k,
                x = 40 + k,
                y = 3 * k % 7
            )
        }),
        1 => "MARKER/2009, PART=1, FLOATING\nPART/200, QG=0.82,0.69,-0.19, MASS=1, CM=2000, IP=0.1,0.2,0.3\n\
              MARKER/2000, PART=200\nMARKER/2001, PART=200, QP=0.2,-0.1,0.3\nMARKER/2002, PART=1\n\
              MATRIX/201, FULL=RORDER, ROWS=5, COLUMNS=3, VALUES=0,0,0, 0.5,0.2,0.1, 1,0.6,0.1, 1.5,0.7,0.4, 2,1.2,0.5\n\
              CURVE/201, OPEN, CURVE_POINTS, MATRIX=201\nPTCV/201, CURVE=201, I=2001, RM=2002, JFLOAT=2009\n"
            .to_owned(),
        2 => "MARKER/2002, PART=1, QP=-900,20,3\nPART/200, QG=-900.5,20.2,3.1, MASS=1, CM=2000, IP=1,1,1\n\
              MARKER/2000, PART=200, QP=1,0,0\nMARKER/2001, PART=200\nJOINT/201, REVOLUTE, I=2001, J=2002\n"
            .to_owned(),
        _ => "MARKER/2002, PART=1, QP=0,0,-30\nPART/200, QG=0,0,-20, MASS=1, CM=2000, IP=1,1,1\nMARKER/2000, PART=200\n\
              GRAPHICS/201, BOX, CORNER=2002, X=5, Y=5, Z=1\nGRAPHICS/202, ELLIPSOID, CM=2000, XSCALE=1, YSCALE=1, ZSCALE=1\n\
              CONTACT/201, IGEOM=202, JGEOM=201, IMPACT, STIFFNESS=1E5, DAMPING=10, EXPONENT=2, DMAX=0.1\n"
            .to_owned(),
    }
}

/// A mechanism that does not fit as it is drawn is assembled where it is alone, to the last bit, whatever else is in the model,
/// and however much.
#[test]
fn what_nothing_couples_to_a_mechanism_changes_no_bit_of_its_assembly() {
    let mut n_moved = 0;
    for name in SCENES {
        for gap in [0.0, 1e-6, 1e-2, 0.1] {
            let mut model = scene(name);
            draw_apart(&mut model, gap);
            let columns = measured(&model);
            let places = |model: &Model| {
                let options = Options {
                    columns: columns.clone(),
                    ..Options::default()
                };
                let mut s = begin(model.clone(), "law", options);
                s.simulate(Analysis::InitialConditions, 0.0, 1, &mut Unwatched)
                    .ok()?;
                Some(
                    columns
                        .iter()
                        .map(|c| running::first(&s, c))
                        .collect::<Vec<f64>>(),
                )
            };
            let Some(alone) = places(&model) else {
                continue;
            };
            n_moved += usize::from(gap > 0.0);
            for which in 0..4 {
                let text = model
                    .to_text()
                    .replace("\nEND", &format!("\n{}END", beside(which)));
                let other = Model::from_text(&text).unwrap_or_else(|e| panic!("{e:?}\n{text}"));
                let found = places(&other).unwrap_or_else(|| panic!("{name} {gap} {which}"));
                for ((column, a), b) in columns.iter().zip(&alone).zip(&found) {
                    assert!(
                        a.to_bits() == b.to_bits(),
                        "{name} {gap} {which} {column}: {a} {b}"
                    );
                }
            }
        }
    }
    assert!(n_moved > 20, "{n_moved}");
}

/// Something that does not move, farther away than anything else.
fn far_away(place: f64) -> String {
    format!(
        "MARKER/2002, PART=1, QP={place:?},0,0\nPART/200, QG={place:?},0,0, MASS=1, CM=2000, IP=1,1,1\n\
         MARKER/2000, PART=200\nJOINT/201, FIXED, I=2000, J=2002\n"
    )
}

/// What stands somewhere else changes no bit of a motion: errors are measured, and rows closed,
/// against the mechanism that makes them.
#[test]
fn what_stands_far_away_changes_no_bit_of_a_motion() {
    let all = SCENES.map(|name| (name, scene(name))).into_iter();
    for (name, model) in all.chain([("bead", whole(BEAD))]) {
        let columns = measured(&model);
        let alone = solved(&model, &columns);
        for place in [1e3, 7e6] {
            let text = model.to_text();
            let text = text.replace("\nEND", &format!("\n{}END", far_away(place)));
            let other = Model::from_text(&text).unwrap_or_else(|e| panic!("{e:?}\n{text}"));
            let found = solved(&other, &columns);
            for c in &columns {
                assert_eq!(alone.column(c), found.column(c), "{name} {place} {c}");
            }
        }
    }
}

/// A motion of a nanometre is as exact as one of a metre: z'' = −z from z = 0, beside its own size
/// and beside what is far away.
#[test]
fn motions_of_any_size_are_as_exact_as_asked_for() {
    const REQUEST: f64 = 1e-6;
    for amplitude in [1e3, 1.0, 1e-3, 1e-6, 1e-9] {
        for far in [None, Some(7e6)] {
            let text = format!(
                "SPRING\nPART/1, GROUND\nMARKER/1, PART=1\nMARKER/3, PART=1, QP=0,0,1\n\
                 PART/2, MASS=1, CM=2, IP=.01,.01,.01, QG=0,0,1, VZ={amplitude:e}\nMARKER/2, PART=2\n\
                 JOINT/1, TRANSLATIONAL, I=2, J=3\n\
                 SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=2, J=3, FUNCTION=-DZ(2,3)\n{}END\n",
                far.map_or_else(String::new, far_away)
            );
            for method in ["AUTO", "RADAU5"] {
                let options = Options {
                    columns: vec!["DZ(2,3)".to_owned()],
                    error: Some(REQUEST),
                    method: (method != "AUTO").then(|| method.to_owned()),
                    ..Options::default()
                };
                let mut session = begin(whole(&text), "law", options);
                go(&mut session, Analysis::Dynamic, 10.0, 5);
                let found = session.run.column("DZ(2,3)").expect("a column");
                let off = (found[found.len() - 1] / amplitude - 10.0_f64.sin()).abs();
                assert!(
                    off < 50.0 * REQUEST,
                    "{amplitude} {far:?} {method}: {off:e}"
                );
            }
        }
    }
}
